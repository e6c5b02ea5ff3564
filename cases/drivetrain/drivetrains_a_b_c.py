"""Two drivetrains of 3 MW and one of 2 MW with every gear a mass, against their table."""

from typing import Any, NamedTuple

import numpy as np
from scipy.optimize import brentq

from fe_drivetrain.cases import case
from fe_drivetrain.cases.drivetrain.printed import check_count, check_printed, show_shapes
from fe_drivetrain.cases.references import published_drivetrains as published
from fe_drivetrain.cases.references.independent_torsion import certified
from fe_drivetrain.common import Floats, Ints
from fe_drivetrain.dynamics.torsion import (
    GearTable,
    Modes,
    Torsional,
    changed,
    gear_masses,
    gear_speeds,
    natural_modes,
    stage_masses,
)
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import percent_text
from fe_drivetrain.report.suite import Page, Record, Run

#: What each table of inputs needs in place of one entry, and the number in Table 6.4 (from 1) that
#: it is solved for.
RESTORED = {
    "B": ("stages.1.carrier", "carrier of stage 2", 3),
    "C": ("stages.1.pinion", "pinion of the first parallel stage", 9),
}
#: Relative difference that is no rounding of inputs.
APART = 0.1
TABLE = "Table 6.4"
OVERVIEW = "Frequencies of drivetrains A, B and C by the inputs as printed, and those of Table 6.4"
#: Number of Table 6.4 that neither the inputs nor those explain; shown.
ASTRAY = {"B": 2, "C": 2}
#: Parts that the first frequency above zero rests on, either of which could restore it.
BEHIND_IT = {"B": ("HSS", "generator"), "C": ("LSS", "generator")}


class ByTables(NamedTuple):
    """A drivetrain by Tables 4.3 and 4.7.

    Attributes
    ----------
    letter, name : str
        Of the drivetrain, and of its table.
    table, system, modes : Drivetrain, Torsional, Modes
        As printed; a mass for each gear, generator free.
    seen : Ints
        Numbers of the modes that are in Table 6.4.
    f, band : Floats
        Their frequencies and what rounding of the inputs leaves [Hz].
    """

    letter: str
    name: str
    table: GearTable
    system: Torsional
    modes: Modes
    seen: Ints
    f: Floats
    band: Floats

    @property
    def printed(self) -> tuple[str, ...]:
        """Table 6.4 [Hz]."""
        return published.OTHERS[self.letter]

    @property
    def targets(self) -> Floats:
        """Table 6.4 as numbers [Hz]."""
        return np.array([float(v) for v in self.printed])


class Restored(NamedTuple):
    """A drivetrain with one entry changed: the entry [kg m^2], the table, frequencies [Hz]."""

    value: float
    table: GearTable
    f: Floats


@case(
    "Drivetrains A and B of 3 MW and C of 2 MW: natural frequencies",
    source="Al-Hamadani 2018, Tables 4.3, 4.7 and 6.4",
)
def run(run: Run, page: Page) -> None:
    """Frequencies against Table 6.4, and what restores it where it is not of its inputs."""
    found, others = {}, {}
    for letter in published.OTHERS:
        with run.step(f"drivetrain {letter}"):
            found[letter] = by_tables(letter)
            page.about(published.drivetrain(f"drivetrain_{letter.lower()}"), f"drivetrain {letter}")
            check_tables(page, found[letter])
            if letter in RESTORED:
                others[letter] = restored(found[letter])
                with page.of(None):
                    check_restored(page, found[letter], others[letter])
    answer(page, found)
    show_all(page, found)
    for letter, one in found.items():
        page.section(f"Drivetrain {letter}")
        if letter in others:
            other = others[letter]
            show_restored(page, one, other)
            page.data(f"{letter}_restored", other.f)
            page.data(f"{letter}_restored_value", other.value)
        else:
            page.table(caption(one), frequency_rows(one))
        show_shapes(
            page,
            f"Mode shapes of drivetrain {letter}, seen from the rotor's shaft",
            one.modes,
            gear_speeds(one.table),
            one.seen[1:7],
        )
        page.data(letter, one.f)
    page.assume(
        "axes of mesh stiffnesses",
        "the planet's and the gear's",
        "",
        "not given; found with the eleven masses of drivetrain D, kept here",
    )
    page.assume(
        "ring gears",
        "held",
        "",
        "Table 4.3 gives them inertias; Table 6.4 has no modes of theirs",
    )


def answer(page: Page, found: dict[str, ByTables]) -> None:
    """State which frequencies of Table 6.4 follow from the tables of inputs."""
    apart = {
        letter: [i for i in range(1, len(one.f)) if abs(one.f[i] / one.targets[i] - 1) > APART]
        for letter, one in found.items()
    }
    astray = [(letter, i) for letter, some in apart.items() for i in some]
    count = sum(len(one.f) - 1 for one in found.values())
    a = found["A"]
    worst = float(np.abs(a.f[1:] / a.targets[1:] - 1).max())
    printed = " and ".join(f"{found[letter].printed[i]}\u00a0Hz ({letter})" for letter, i in astray)
    held = f"{count - len(astray)} of {count}" if astray else f"All {count}"
    ends = f"; {printed} {'do' if len(astray) > 1 else 'does'} not" if astray else ""
    shown = [*astray, *((letter, number - 1) for letter, number in ASTRAY.items())]
    page.answer(
        "Do the printed frequencies of drivetrains A, B and C follow from their printed inputs?",
        f"{held} frequencies of Table 6.4 follow from the inputs in Table 4.3 within "
        f"{percent_text(APART)}{ends}.",
        [
            page.judged(
                "drivetrain A: frequency 2",
                "drivetrain A, first frequency above 0",
                TABLE,
                a.printed[1],
            ),
            page.judged(
                "drivetrain A: frequency 3",
                "drivetrain A, second frequency above 0",
                TABLE,
                a.printed[2],
            ),
            *(
                page.value(
                    f"drivetrain {letter}, frequency {i + 1} [Hz]",
                    float(found[letter].f[i]),
                    float(found[letter].band[i]),
                    beside=float(found[letter].targets[i]),
                    by=TABLE,
                    printed=found[letter].printed[i],
                )
                for letter, i in shown[:4]
            ),
        ],
        OVERVIEW,
        claim="holds in part" if astray else "holds",
    )
    page.say(
        f"All frequencies of drivetrain A follow from its inputs within {percent_text(worst)}."
    )


def free(table: GearTable) -> Torsional:
    """A mass for each gear, generator free."""
    return gear_masses(table, "free")


def by_tables(letter: str) -> ByTables:
    """A drivetrain as its tables have it."""
    name = f"drivetrain_{letter.lower()}"
    table = published.table(name)
    system = free(table)
    modes = natural_modes(system)
    seen = published.observable(modes)
    band = published.rounding_band(name, free)[seen]
    return ByTables(letter, name, table, system, modes, seen, modes.frequencies[seen], band)


def check_tables(page: Page, one: ByTables) -> None:
    """Exact counting, and Table 6.4 where it follows from the inputs."""
    label = f"drivetrain {one.letter}"
    check_count(
        page,
        f"{label}, {len(one.system.inertias)} masses",
        certified(one.system, one.modes.frequencies),
    )
    if one.letter not in RESTORED:
        check_printed(page, label, one.f, one.printed, one.band, published.TABLE_6_4)


def restored(one: ByTables) -> Restored:
    """One entry changed so that one number of Table 6.4 follows."""
    key, _, number = RESTORED[one.letter]
    target = one.targets[number - 1]
    tabled = float(dict(published.printed_inputs(one.name))[key])

    def seen(value: float) -> Floats:
        modes = natural_modes(free(published.with_values(one.table, {key: value})))
        return modes.frequencies[published.observable(modes)]

    value = float(brentq(lambda x: float(seen(x)[number - 1] - target), 0.5 * tabled, 5 * tabled))
    return Restored(value, published.with_values(one.table, {key: value}), seen(value))


def check_restored(page: Page, one: ByTables, other: Restored) -> None:
    """All numbers that nothing was solved for, but the one that stays apart."""
    key, what, number = RESTORED[one.letter]
    chosen = published.observable(natural_modes(free(other.table)))
    band = published.rounding_band(one.name, free, other.table, frozenset({key}))[chosen]
    check_printed(
        page,
        f"drivetrain {one.letter}, {what} {other.value:.4g} kg m^2",
        other.f,
        one.printed,
        band,
        published.TABLE_6_4,
        leave_out={ASTRAY[one.letter], number},
    )


def frequency_rows(one: ByTables) -> list[Record]:
    """By the tables, beside Table 6.4."""
    return [
        {
            "number": i + 1,
            "Table 6.4 [Hz]": one.printed[i],
            "by Tables 4.3 and 4.7 [Hz]": float(one.f[i]),
            "half width by rounding of the inputs [Hz]": float(one.band[i]),
            "difference [%]": percent(one.f[i], one.targets[i]),
        }
        for i in range(len(one.f))
    ]


def show_all(page: Page, found: dict[str, ByTables]) -> None:
    """The three beside each other."""
    page.section("All three")
    traces: list[Any] = []
    peaks: list[Record] = []
    for letter, one in found.items():
        numbers = np.arange(2, len(one.f) + 1)
        traces += [
            trace(f"{letter}, computed", numbers, one.f[1:]),
            trace(f"{letter}, Table 6.4", numbers, one.targets[1:], points=True),
        ]
        stages = natural_modes(stage_masses(one.table, "free")).frequencies
        page.data(f"{letter}_stage_masses", stages)
        peaks.append(
            {
                "drivetrain": letter,
                "Table 6.4": one.targets[1],
                "every gear a mass": one.f[1],
                "a mass for each stage, meshes rigid": stages[1],
                "peak in the thesis's simulated shutdown (section 6.2.3)": published.SHUTDOWN[
                    letter
                ],
            }
        )
    page.chart(
        OVERVIEW,
        traces,
        "number in Table 6.4",
        "frequency [Hz]",
        "y",
    )
    page.table("The first frequency above zero [Hz]", peaks)


def show_restored(page: Page, one: ByTables, other: Restored) -> None:
    """A drivetrain whose table needs another entry: the answer, the table and what it means."""
    letter, f, targets = one.letter, one.f, one.targets
    key, what, number = RESTORED[letter]
    tabled = dict(published.printed_inputs(one.name))
    off = [i for i in range(1, len(f)) if abs(f[i] / targets[i] - 1) > APART]
    page.say(
        f"Drivetrain {letter}: {hertz(targets[off])} of Table 6.4 "
        f"{'is' if len(off) == 1 else 'are'} not of Table 4.3, which gives "
        f"{hertz(f[off])}; with a {what} of {other.value:.4g} kg m^2 instead of {tabled[key]} "
        + what_is_left(other.f, targets, number, ASTRAY[letter])
    )
    page.table(
        caption(one),
        [
            row
            | {
                f"{what} {other.value:.4g} kg m^2 [Hz]": value,
                "difference of these [%]": percent(value, target),
            }
            for row, value, target in zip(frequency_rows(one), other.f, targets, strict=True)
        ],
    )
    if letter == "B":
        page.text(
            f"The carrier of the first stage has {float(tabled['stages.0.carrier']):g} kg m^2: it "
            "seems to have stood for the second one, too. The last two numbers swing the sun of "
            "stage 2 and the pinion, which are given as 0.4 and 0.3 kg m^2: one digit leaves "
            f"{100 * one.band[-2] / f[-2]:.0f} and {100 * one.band[-1] / f[-1]:.0f} %."
        )
    values = {p.name: p.inertia for p in one.system.inertias}
    values |= {e.name: e.stiffness for e in one.system.elements}
    shaft, generator = BEHIND_IT[letter]
    needs = {part: needed(other, part, values[part], targets[1]) for part in BEHIND_IT[letter]}
    page.text(
        f"The printed {one.printed[1]} Hz stays apart: it would need {shaft} of "
        f"{needs[shaft]:.3g} N m/rad instead of {values[shaft]:.3g}, or a generator of "
        f"{needs[generator]:.3g} kg m^2 instead of {values[generator]:g}. In the thesis's own "
        f"simulated shutdown the torque swings at {published.SHUTDOWN[letter]:g} Hz (section "
        f"6.2.3); by Table 4.3 the drivetrain does at {f[1]:.3f}."
    )


def needed(other: Restored, part: str, tabled: float, target: float) -> float:
    """What a part needs for the first frequency above zero [Hz], in the unit of its table."""
    whole = free(other.table)
    return float(
        brentq(
            lambda x: float(natural_modes(changed(whole, {part: x})).frequencies[1] - target),
            0.5 * tabled,
            2 * tabled,
        )
    )


def caption(one: ByTables) -> str:
    """Caption of a drivetrain's table of frequencies."""
    return f"Drivetrain {one.letter}: {one.table.title.partition(', ')[2]}; generator free"


def percent(value: float, reference: float) -> float | None:
    """Difference, relative; of zero none."""
    return float(100 * (value / reference - 1)) if reference else None


def hertz(values: Floats) -> str:
    """Frequencies in a sentence."""
    return " and ".join(f"{v:.5g}" for v in values) + " Hz"


def what_is_left(found: Floats, targets: Floats, solved: int, astray: int) -> str:
    """How close a restored drivetrain is, in words."""
    others = [i for i in range(1, len(targets)) if i + 1 not in (solved, astray)]
    worst = max(abs(float(found[i] / targets[i] - 1)) for i in others)
    return (
        f"all others follow within {100 * worst:.1f} %, which is the rounding of the inputs, but "
        f"for {targets[astray - 1]:g} Hz, where these give {found[astray - 1]:.4g}."
    )
