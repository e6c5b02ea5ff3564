"""Rainflow counting and equivalent loads against printed examples and closed forms."""

from collections.abc import Sequence

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.turbine_loads.histories import (
    RESIDUES,
    SNCurve,
    damage_equivalent_load,
    exceedance,
    miner_damage,
    rainflow_cycles,
    streamed_cycles,
)

ASTM = (-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0)
COUNTS = {3.0: 0.5, 4.0: 1.5, 6.0: 0.5, 8.0: 1.0, 9.0: 0.5}
STANDARD = "ASTM E1049-85 (2017), 5.4.4, Fig. 6"
WETB = "wetb's tests in openfast_toolbox @d34b283, tools/tests/test_fatigue.py"
PUBLISHED = {(1, 3): 10.348414, (1, 4): 9.635653, (1, 6): 9.122399}
PUBLISHED |= {(17, 3): 4.024613, (17, 4): 4.745358, (17, 6): 5.688978}
SINE = {(10, 100): 9.4714702, (4, 10): 9.420937}
FEW = 20.0
"""Samples a period of which the answer states the error."""
LOST = "What too few samples a period lose of a sine's equivalent load, m = 4"
HAIBACH = "Haibach, Betriebsfestigkeit, 3rd ed. 2006, p. 271, as quoted in the tests of pylife"


@case(
    "Rainflow counting: the standard's example, published equivalent loads, lives, a sine",
    source="ASTM E1049-85; wetb; Haibach 2006; closed forms",
)
def run(run: Run, page: Page) -> None:
    """Count printed series and sines; count a long history in pieces."""
    with run.step("printed examples"):
        standard(page)
        published(page)
        life(page)
    with run.step("sines"):
        errors = sines(run, page)
    with run.step("in pieces"):
        pieces(page, 20_000 if run.quick else 400_000)
    answer(page, errors)


def answer(page: Page, errors: Sequence[Record]) -> None:
    """State how far counts and equivalent loads are from printed ones, and what samples cost."""
    apart = [
        100.0 * abs(check.computed / check.reference - 1.0)
        for check in page.checks
        if check.source == WETB and check.reference
    ]
    coarse = next(row for row in errors if row["samples a period"] == FEW)
    cost = float(coarse["error, worst phase [%]"])
    page.answer(
        "How well do counted cycles and equivalent loads agree with published ones?",
        "Cycle counts are those of ASTM E1049; equivalent loads agree with "
        f"{len(apart)} published ones within {value_text(max(apart), '%')}; a sine sampled {FEW:g} "
        f"times a period loses {value_text(cost, '%')}.",
        [
            page.value("largest difference from a published equivalent load [%]", max(apart)),
            page.judged(
                "the same series, equivalent load of 1 cycles, m = 3",
                "equivalent load of ASTM's series, 1 cycle, m = 3",
                "wetb",
            ),
            page.judged(
                "life of a spectrum of six levels by Miner's elementary rule",
                "life of a spectrum of six levels",
                "Haibach",
            ),
            page.value(
                f"loss of a sine's equivalent load, {FEW:g} samples a period [%]",
                cost,
                beside=float(coarse["bound [%]"]),
                by="closed form",
            ),
        ],
        hero=LOST,
        cautions=[
            "Published equivalent loads were counted in classes of ranges, which alone explains "
            "such differences."
        ],
    )


def standard(page: Page) -> None:
    """The example of the standard, by each rule for what the end leaves open."""
    ranges, above = exceedance(rainflow_cycles(ASTM))
    counts = np.diff(above, prepend=0.0)
    for size, count in zip(ranges.tolist(), counts.tolist(), strict=True):
        page.equals(
            f"cycles of range {size:g} in the standard's example",
            count,
            COUNTS.get(size, 0.0),
            within=0.0,
            why="counts are halves and wholes",
            source=STANDARD,
            measure="identity",
        )
    rows: list[Record] = []
    for residue, words in RESIDUES.items():
        sizes, more = exceedance(rainflow_cycles(ASTM, residue))  # type: ignore[arg-type]
        found = dict(zip(sizes.tolist(), np.diff(more, prepend=0.0).tolist(), strict=True))
        row = {f"range {size:g}": found.get(size, 0.0) for size in (3.0, 4.0, 6.0, 7.0, 8.0, 9.0)}
        rows.append({"residue": f"{residue}: {words}", **row})
    page.table("Cycles of the standard's example by what is done with the residue", rows)


def published(page: Page) -> None:
    """Equivalent loads that were counted in classes: the difference is theirs."""
    cycles = rainflow_cycles(ASTM)
    for (number, slope), value in PUBLISHED.items():
        # by Minkowski's inequality: ranges that move by half a class each
        allowed = 0.5 * 9.0 / 50 * (cycles.counts.sum() / number) ** (1.0 / slope)
        page.equals(
            f"the same series, equivalent load of {number} cycles, m = {slope}",
            damage_equivalent_load([cycles], number, slope),
            value,
            within=allowed,
            relative=False,
            why="published from 50 classes: each range may be displaced by half of one",
            source=WETB,
        )
    wave = rainflow_cycles(5.0 * np.sin(2.0 * np.pi * 0.1 * np.arange(100)))
    for (slope, classes), value in SINE.items():
        half = 0.5 * wave.ranges.max() * (1.0 / classes + 1.0 / 255)
        page.equals(
            f"ten periods of a sine of amplitude 5, ten samples each, m = {slope}",
            damage_equivalent_load([wave], 10.0, slope),
            value,
            within=half * (wave.counts.sum() / 10.0) ** (1.0 / slope),
            relative=False,
            why=f"published from {classes} classes and 255 levels: half of each",
            source=WETB,
        )


def life(page: Page) -> None:
    """Miner's elementary rule on a spectrum of six levels."""
    loads = np.array([100.0, 150.0, 200.0, 250.0, 300.0, 350.0])
    counts = -np.diff([1e6, 1e5, 1e4, 1e3, 100.0, 10.0, 0.0])
    damage = miner_damage(loads, counts, SNCurve(125.0, 2e6, 7.0))
    page.equals(
        "life of a spectrum of six levels by Miner's elementary rule",
        float(counts.sum()) / damage,
        2_167_330.0,
        within=5e-6,
        why="printed with six digits",
        source=HAIBACH,
        unit="cycles",
        basis="second-hand",
    )


def sines(run: Run, page: Page) -> list[Record]:
    """Peaks fall between samples: what that costs, worst phase, against 1 - cos(pi / n)."""
    rows: list[Record] = []
    turns = np.linspace(0.0, 2.0 * np.pi, 8 if run.quick else 48, endpoint=False)
    for samples in (4.0, 6.0, 8.0, 12.0, 20.0, 40.0, 100.0):
        number = np.arange(200 * samples) * 2.0 * np.pi / samples
        # the worst phase has its peak half a sample away, which a few even turns may all miss
        phases = np.concatenate([turns, turns + np.pi / samples])
        found = [_equivalent(np.cos(number + phase)) for phase in phases]
        rows.append(
            {
                "samples a period": samples,
                "error, worst phase [%]": 100.0 * (1.0 - min(found) / 2.0),
                "bound [%]": 100.0 * (1.0 - np.cos(np.pi / samples)),
            }
        )
    worst = max(row["error, worst phase [%]"] - row["bound [%]"] for row in rows)
    page.at_most(
        "equivalent load of a sine: error beyond 1 - cos(pi / samples a period)",
        worst,
        0.1,
        why="a peak is at most half a sample away; 200 periods have one half cycle open",
        source="closed form",
        unit="%",
    )
    page.section("Sampling")
    page.sweep(
        LOST,
        rows,
        "samples a period",
        {"error, worst phase [%]": "worst phase", "bound [%]": "1 - cos(pi / samples)"},
        log="xy",
        axis="lost of the equivalent load [%]",
    )
    return rows


def _equivalent(wave: Floats) -> float:
    return damage_equivalent_load([rainflow_cycles(wave)], 200.0, 4.0)


def pieces(page: Page, samples: int) -> None:
    """A random walk, whole and in pieces of a thousand."""
    walk = np.random.default_rng(0).standard_normal(samples).cumsum()
    whole = rainflow_cycles(walk)
    parts = list(streamed_cycles(walk[k : k + 1000] for k in range(0, samples, 1000)))
    ranges = np.concatenate([part.ranges for part in parts])
    page.holds(
        f"{samples:,} samples in pieces of 1000 have the cycles of the whole, to the last digit",
        np.array_equal(whole.ranges, ranges),
        why="the open cycles are kept from piece to piece",
        source="the whole",
    )
