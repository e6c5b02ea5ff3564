"""Histories that say less than they seem to: too slow, too short, with spikes, gaps, constants."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats, InputError, scratch_folder
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.turbine_loads.histories import (
    RESIDUES,
    alias,
    damage_equivalent_load,
    lone_samples,
    multiples,
    rainflow_cycles,
    spectrum,
)
from fe_drivetrain.turbine_loads.hub_loads import LoadHistory, read_recorded, write_hub_loads

HERTZ = 0.2  # of the rotor
SIX = 6.0 * HERTZ
STEP = 0.01
LINES = {3: 1.0, 6: 0.3}  # amplitudes at multiples
KEPT = 0.01
SIZE, SPOILT, STEEP = "spike over standard deviation", "DEL over the clean one", "m = 10"
FOLDED = "A line of 6P at 1.2 Hz, sampled ever more slowly"
LITTLE = 0.02


@case(
    "Load histories that are sampled too slowly, too short, with gaps, constants, spikes",
    source="Shannon 1949 (sampling); ASTM E1049-85 (residue); closed forms",
)
def run(run: Run, page: Page) -> None:
    """Drive histories into each fault, and show what the program does."""
    with run.step("sampling"):
        sampled = slow(page)
    with run.step("length"):
        change = short(run, page)
    with run.step("spikes"):
        spoilt = spikes(page)
    with run.step("gaps and constants"):
        refused(page)
    answer(page, sampled, spoilt, change)
    page.say(
        "'loads' states where a line appears that is sampled too slowly, the rule for the residue "
        "of every figure, the share of half cycles, and file, channel and time of a spike; it "
        "takes nothing out."
    )


def answer(page: Page, sampled: list[Record], spoilt: list[Record], change: float) -> None:
    """State what the slowest sampling, the largest spike and the residue do to loads."""
    slowest = min(sampled, key=lambda row: float(row["samples per 6P"]))
    samples, seen = (
        float(slowest[key]) for key in ("samples per 6P", "line of 6P appears at [Hz]")
    )
    largest = max(float(row[SIZE]) for row in spoilt)
    shallow, steep = (float(row[SPOILT]) for row in spoilt if row[SIZE] == largest)
    page.answer(
        "What do slow sampling and a spike in the data do to counted loads?",
        f"A {SIX:.2g}\u00a0Hz line sampled {samples:.3g} times a period appears at "
        f"{seen:.2g}\u00a0Hz; one spike of {largest:.3g} standard deviations makes an equivalent "
        f"load {steep:.2g} times too large.",
        [
            page.value(
                "frequency at which the line of 6P appears [Hz]", seen, beside=SIX, by="true"
            ),
            page.value(f"equivalent load with a spike over that without, {STEEP}", steep),
            page.value("the same, m = 3", shallow),
            page.value("change by closing cycles open at the end, 600 s, m = 10 [%]", change),
        ],
        hero=FOLDED,
        cautions=[
            "Missing numbers and time that runs backwards are reported as errors with their place, "
            "and gaps where reactions are asked for; all else is counted as it stands."
        ],
    )


def wave(time: Floats) -> Floats:
    """3P and 6P of a rotor."""
    return np.asarray(sum(a * np.sin(2 * np.pi * n * HERTZ * time) for n, a in LINES.items()))


def slow(page: Page) -> list[Record]:
    """One load at ever larger steps: the line of 6P, and where it stands."""
    rows: list[Record] = []
    for rate in (100.0, 20.0, 10.0, 5.0, 3.0, 2.6, 2.2, 1.8, 1.5):
        signal = wave(np.arange(0.0, 1200.0, 1.0 / rate))
        found = spectrum(signal, 1.0 / rate)
        six = multiples(found, 2 * np.pi * HERTZ, [6])[0]
        at = alias(SIX, 1.0 / rate)
        rows.append(
            {
                "samples per 6P": rate / SIX,
                "line of 6P appears at [Hz]": six.appears_at,
                "amplitude there over the true one": found.amplitude(at, near=0.0) / LINES[6],
                "named as 6P": "yes" if six.amplitude is not None else "no: stated on the page",
            }
        )
        if abs(at - 3.0 * HERTZ) < 1e-9:
            page.equals(
                f"{rate:g} Hz: amplitude of 3P, on which 6P falls with the opposite sign",
                found.amplitude(at, near=0.0),
                LINES[3] - LINES[6],
                within=0.02,
                why="two lines of one frequency cannot be distinguished; no other line leaks in",
                source="sin(2 pi 1.2 n / 1.8) = -sin(2 pi 0.6 n / 1.8)",
                basis="self-consistency",
            )
            continue
        page.equals(
            f"6P at {rate:g} Hz: amplitude of the line at {at:.3g} Hz",
            rows[-1]["amplitude there over the true one"],
            1.0,
            within=0.02,
            why="the line has its power wherever sampling puts it; other lines leak in a little",
            source="sampling theorem",
            basis="self-consistency",
        )
    page.section("Sampling too slow for 6P")
    page.sweep(
        FOLDED,
        rows,
        "samples per 6P",
        "line of 6P appears at [Hz]",
        log="x",
        reference={"6P": SIX},
        points=True,
    )
    page.limit(
        "multiples of the rotor's speed from samples",
        "samples per period of the multiple",
        low=2.0,
        high=None,
        criterion="the line stands at its own frequency",
        beyond="it appears folded below half the sampling rate, as a load that is not there",
        program="'loads' leaves the amplitude empty and states where the line appears",
        remedy="write the output more often",
    )
    return rows


def short(run: Run, page: Page) -> float:
    """Equivalent loads by the three rules, against length; what they differ by in 600 s [%]."""
    generator = np.random.default_rng(1)
    steps = int(600 / 0.1)
    noise = generator.standard_normal((4 if run.quick else 16, steps)).cumsum(axis=1) * 0.02
    load = noise + wave(np.arange(steps, dtype=np.float64) * 0.1)
    rows = by_residue(load)
    page.section("Short histories")
    page.sweep(
        "Equivalent load of m = 10 at 1 Hz by the rule for the residue: 3P, 6P and a drift, which "
        "closes few cycles",
        rows,
        "length [s]",
        "DEL of m = 10 [-]",
        by="residue",
        log="x",
    )
    by = {(row["length [s]"], row["residue"]): row["DEL of m = 10 [-]"] for row in rows}
    for seconds in (10, 600):
        low, high = by[seconds, "half"], by[seconds, "closed"]
        page.between(
            f"{seconds} s: closed residue over half cycles, equivalent load of m = 10",
            high / low,
            1.0,
            2.0**0.1,
            why="counting halves as wholes at most doubles the damage",
            source="Miner's rule: 2^(1/m)",
        )
    apart = {s: _apart([row[: s * 10] for row in load], float(s)) for s in (10, 30, 60, 120, 300)}
    enough = [s for s, more in apart.items() if more <= LITTLE]
    page.limit(
        "equivalent load of m = 3 of a short history",
        "length [s]",
        low=float(min(enough, default=600)),
        high=None,
        criterion=f"the rule for the residue changes it by less than {LITTLE:.0%}",
        beyond="half cycles of the end, whose other half is not known, are much of the damage; at "
        "m = 10 at every length, since the largest range is always one of them",
        program="every figure names the rule; 'loads' names the share of damage of half cycles, "
        "and files shorter than ten minutes",
        remedy="count longer histories, or several together; compare --residue closed",
    )
    return 100.0 * float(by[600, "closed"] / by[600, "half"] - 1.0)


def by_residue(load: Floats) -> list[Record]:
    """Equivalent load of m = 10 of histories (n, steps), by length and rule for the residue."""
    rows: list[Record] = []
    for seconds in (10, 30, 60, 120, 300, 600):
        part = load[:, : seconds * 10]
        for residue in RESIDUES:
            found = [
                damage_equivalent_load(
                    [rainflow_cycles(row, residue)],  # type: ignore[arg-type]
                    float(seconds),
                    10.0,
                )
                for row in part
            ]
            rows.append(
                {
                    "length [s]": seconds,
                    "residue": residue,
                    "DEL of m = 10 [-]": float(np.mean(found)),
                }
            )
    return rows


def _apart(histories: list[Floats], seconds: float) -> float:
    """By how much the rule for the residue changes an equivalent load of m = 3, relative."""
    closed, half = (
        damage_equivalent_load(
            [rainflow_cycles(one, rule) for one in histories],  # type: ignore[arg-type]
            seconds * len(histories),
            3.0,
        )
        for rule in ("closed", "half")
    )
    return closed / half - 1.0


def spikes(page: Page) -> list[Record]:
    """One wrong sample in ten minutes."""
    load = wave(np.arange(0.0, 600.0, 0.05))
    clean = {m: damage_equivalent_load([rainflow_cycles(load)], 600.0, m) for m in (3.0, 10.0)}
    rows: list[Record] = []
    for size in (1.0, 2.0, 5.0, 10.0):
        spoilt = load.copy()
        spoilt[6000] += size * load.std()
        places = lone_samples(spoilt).tolist()
        for slope, before in clean.items():
            found = damage_equivalent_load([rainflow_cycles(spoilt)], 600.0, slope)
            row = {SIZE: size, "slope": f"m = {slope:g}"}
            row |= {
                SPOILT: found / before,
                "named by 'loads'": "yes" if places else "no",
            }
            rows.append(row)
    page.holds(
        "a spike of ten standard deviations is found where it is, and none in the clean load",
        places == [6000] and not len(lone_samples(load)),
        why="a load lies near the middle of its neighbours, a spike does not",
        source="where it was put",
        basis="self-consistency",
    )
    page.section("Spikes")
    page.sweep(
        "One spike in 12 000 samples",
        rows,
        SIZE,
        SPOILT,
        by="slope",
    )
    safe = [r for r in rows if r["slope"] == STEEP and r[SPOILT] <= 1 + KEPT]
    page.limit(
        "damage-equivalent load of m = 10 with one wrong sample",
        SIZE,
        low=None,
        high=max((r[SIZE] for r in safe), default=1.0),
        criterion=f"changed by less than {KEPT:.0%}",
        beyond="one range decides the damage of a steep S-N curve",
        program="names file, channel and time of samples that stand alone, shows the largest range "
        "beside the equivalent loads, and removes nothing",
        remedy="look at the sample, and correct it",
    )
    return rows


def refused(page: Page) -> None:
    """Gaps and values that are no numbers are refused with their place; constants are counted."""
    time = np.arange(0.0, 20.0, STEP * 10)
    loads = np.column_stack([wave(time)] * 6)
    number = np.arange(len(time))[:, None]
    gap = slice(50, 60)
    faults = {
        "a gap of ten samples": (np.delete(time, gap), np.delete(loads, gap, 0)),
        "a value that is no number": (time, np.where(number == 7, np.nan, loads)),
        "time that steps back": (np.concatenate([time[:50], time[40:90]]), loads[:100]),
    }
    for name, (at, values) in faults.items():
        page.holds(
            f"{name} is refused with its place",
            _message(at, values).count("sample") > 0,
            why="rainflow over a gap counts a range that never was",
            source="the reader of histories",
        )
    flat = rainflow_cycles(np.full(100, 3.0))
    page.vanishes(
        "equivalent load of a constant channel",
        damage_equivalent_load([flat], 10.0, 4.0),
        within=0.0,
        why="it has no cycle",
        source="definition",
    )
    with scratch_folder() as folder:
        file = folder / "constant.csv"
        write_hub_loads(LoadHistory("constant", time, np.full((len(time), 6), 3.0)), file)
        read = read_recorded(file).history
    page.holds(
        "a file of constant loads is read, and counts nothing",
        len(rainflow_cycles(read.loads[:, 0]).ranges) == 0,
        why="idling turbines have such channels",
        source="definition",
    )


def _message(time: Floats, loads: Floats) -> str:
    try:
        LoadHistory("faulty", time, loads)
    except InputError as error:
        return str(error)
    return ""
