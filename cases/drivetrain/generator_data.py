"""What printed data of four generators determine: speeds, currents, the spring to the grid."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import published_drivetrains as published
from fe_drivetrain.comparison import as_printed
from fe_drivetrain.dynamics.torsion import GearTable, gear_masses, natural_modes
from fe_drivetrain.report import chart, mark_events, trace
from fe_drivetrain.report.number_text import percent_text, value_text
from fe_drivetrain.report.suite import Page, Record, Run

VOLTS, HERTZ = 690.0, 60.0
"""Voltage and frequency of all four (Table 4.6)."""
PRINTED = 28_100.0
"""Spring of D's generator, from Mandic et al. 2012 (section 4.1) [N m/rad]."""
MODES = "First mode of drivetrain D by the stiffness of its generator to the grid"
SMALL = 0.03
"""Slip above which a machine whose rotor is short-circuited wastes more than it usually does."""


class Printed(NamedTuple):
    """A generator of Table 4.6; inductances as printed, without a unit.

    Attributes
    ----------
    letter, kind : str
        Drivetrain, PMG or DFIG.
    per_minute : float
        Rated speed [1/min].
    poles : int
        Number of poles.
    mutual, leakage, line : float
        Mutual inductance, stator leakage "reactance", line inductance.
    """

    letter: str
    kind: str
    per_minute: float
    poles: int
    mutual: float
    leakage: float
    line: float

    @property
    def power(self) -> float:
        """Rated power [W] (Table 4.1)."""
        return float(published.RATED[self.letter][1])

    @property
    def table(self) -> GearTable:
        """The drivetrain."""
        return published.table(published.RATED[self.letter][0])

    @property
    def synchronous(self) -> float:
        """Speed of the field at the grid's frequency [1/min]."""
        return 120.0 * HERTZ / self.poles

    @property
    def slip(self) -> float:
        """Rated speed over synchronous speed, less 1."""
        return self.per_minute / self.synchronous - 1.0

    @property
    def current(self) -> float:
        """Current of a phase at rated power and a power factor of 1 [A]."""
        return float(self.power / (np.sqrt(3.0) * VOLTS))

    @property
    def torque(self) -> float:
        """Torque of rated power at the field's speed [N m]."""
        return self.power / (self.synchronous * np.pi / 30.0)

    def guesses(self) -> dict[str, float]:
        """Reactance between the generator's field and the grid by guess, over rated impedance."""
        return {
            "leakage and line": self.leakage + self.line,
            "twice the leakage (a rotor like the stator) and line": 2 * self.leakage + self.line,
            "mutual, leakage and line": self.mutual + self.leakage + self.line,
        }

    def stiffness(self, reactance: float) -> float:
        """Spring to a stiff grid at small load angles, E = V: p T / x [N m/rad]."""
        return 0.5 * self.poles * self.torque / reactance


GENERATORS = (
    Printed("A", "PMG", 515.0, 10, 0.32, 0.64, 0.09),
    Printed("B", "DFIG", 1836.0, 4, 3.0, 0.1, 0.09),
    Printed("C", "DFIG", 1680.0, 4, 3.0, 0.1, 0.1),
    Printed("D", "DFIG", 1809.0, 4, 2.56, 0.016, 0.06),
)


@case(
    "Generators at 690 V: what their printed data determine",
    source="Al-Hamadani 2018, section 4.3.3, Tables 4.1 and 4.6",
)
def run(run: Run, page: Page) -> None:
    """Speeds, currents and springs from Table 4.6, and what guesses of the rest move."""
    del run
    d = GENERATORS[-1]
    with page.of(published.drivetrain("nrel_750kw"), "nrel_750kw"):
        check_springs(page, d)
    springs = {name: d.stiffness(x) for name, x in d.guesses().items()}
    modes = {name: first_modes(d.table, value) for name, value in springs.items()}
    answer(page, d, springs, modes)
    page.section("From the table")
    rows = [row_of(one) for one in GENERATORS]
    page.table("What follows without a guess", rows)
    page.data("generators", rows)
    page.text(
        "Inductances are over rated impedance, which the table does not say: in henry, "
        f"{d.leakage:g} H of D would be {in_henry(d):.0f} times its rated impedance."
    )
    show_springs(page, d)
    page.section("Printed, ours, verdict")
    page.table("Statements on generators", verdicts(d, springs, modes))
    page.assume("base of inductances", "rated power, 690 V, 60 Hz", "", "no unit is printed")
    page.assume("induced voltage", "that of the grid", "", "excitation is not printed")


def first_modes(table: GearTable, stiffness: float) -> tuple[float, float]:
    """Two lowest frequencies with the generator on a spring [Hz]."""
    held = published.with_values(table, {"generator.stiffness": stiffness})
    first, second = natural_modes(gear_masses(held, "fixed")).frequencies[:2]
    return float(first), float(second)


def check_springs(page: Page, d: Printed) -> None:
    """The printed spring gives the printed frequencies; the limit of a stiff one is a held end."""
    first, _ = first_modes(d.table, PRINTED)
    page.equals(
        "drivetrain D: first mode with the printed spring [Hz]",
        first,
        **as_printed(published.ELEVEN["fixed"][0]),
        source=published.TABLE_6_1,
    )
    held, _ = first_modes(d.table, 1e9 * PRINTED)
    free = natural_modes(
        gear_masses(published.with_values(d.table, {"generator.inertia": 1e9}), "free")
    ).frequencies[1]
    page.equals(
        "drivetrain D: first mode with a stiff spring [Hz]",
        held,
        float(free),
        within=1e-6,
        why="seen from the rotor, spring and inertia are millions of times those of the drivetrain",
        source="the generator held by its inertia",
    )


def row_of(one: Printed) -> Record:
    """Speeds, slip, current and torque of a generator."""
    ratio = float(one.table.speeds[-1])
    return {
        "drivetrain": one.letter,
        "kind": one.kind,
        "synchronous speed at 60 Hz [1/min]": one.synchronous,
        "rated speed [1/min]": one.per_minute,
        "slip at rated speed [%]": 100.0 * one.slip,
        "frequency at rated speed [Hz]": one.per_minute * one.poles / 120.0,
        "rotor at rated speed [1/min]": one.per_minute / ratio,
        "rated rotor, Table 4.1 [1/min]": float(published.RATED[one.letter][2]),
        "current at 690 V [A]": one.current,
        "torque at rated speed [N m]": one.power / (one.per_minute * np.pi / 30.0),
    }


def in_henry(one: Printed) -> float:
    """Leakage over rated impedance if it were in henry."""
    return 2.0 * np.pi * HERTZ * one.leakage / (VOLTS**2 / one.power)


def answer(
    page: Page,
    d: Printed,
    springs: dict[str, float],
    modes: dict[str, tuple[float, float]],
) -> None:
    """State what the data leave open of D's spring, and what does not fit."""
    soft, stiff = (pick(springs, key=lambda name: springs[name]) for pick in (min, max))
    a, c = GENERATORS[0], GENERATORS[2]
    own = a.per_minute * a.poles / 120.0
    fits = abs(own - HERTZ) < 1.0
    apart = "" if fits else f", not {HERTZ:g}\u00a0Hz"
    implied = 0.5 * d.poles * d.torque / PRINTED
    page.answer(
        "Which grid spring and which frequency follow from printed data of the 690 V generators?",
        f"Printed data allow drivetrain D a grid spring of {value_text(springs[soft] / 1e3)} to "
        f"{value_text(springs[stiff] / 1e3, 'kN m/rad')}, first mode "
        f"{modes[soft][0]:.2f} to {modes[stiff][0]:.2f}\u00a0Hz; generator A runs at "
        f"{value_text(own, 'Hz')}{apart}.",
        [
            page.value(
                "grid spring of D, from leakage and line [kN m/rad]",
                springs[stiff] / 1e3,
                beside=PRINTED / 1e3,
                by="thesis",
            ),
            page.value(
                "grid spring of D, with the mutual inductance too [kN m/rad]",
                springs[soft] / 1e3,
                beside=PRINTED / 1e3,
                by="thesis",
            ),
            page.value("reactance that the printed spring needs, over rated impedance", implied),
            page.judged(
                "drivetrain D: first mode with the printed spring",
                "first mode of D with the printed spring",
                "thesis",
                printed=published.ELEVEN["fixed"][0],
            ),
            page.value(
                "frequency of A's generator at rated speed [Hz]", own, beside=HERTZ, by="thesis"
            ),
            page.value("slip of C's generator at rated speed [%]", 100.0 * c.slip),
        ],
        MODES,
        [
            "Resistances, excitation, converters and their controls are not printed: the torque "
            "over time cannot be computed from the table."
        ],
        claim="holds" if fits else "holds in part",
    )


def show_springs(page: Page, d: Printed) -> None:
    """Springs by guess for all four, and the first mode of D over the spring."""
    page.section("The spring to the grid")
    rows: list[Record] = []
    for one in GENERATORS:
        for name, reactance in one.guesses().items():
            spring = one.stiffness(reactance)
            first, second = first_modes(one.table, spring)
            rows.append(
                {
                    "drivetrain": one.letter,
                    "reactance": name,
                    "over rated impedance": reactance,
                    "spring [N m/rad]": spring,
                    "first mode [Hz]": first,
                    "second mode [Hz]": second,
                    "largest torque over rated": 1.0 / reactance,
                }
            )
    page.table("Springs of a stiff grid by guess of the reactance, and modes with them", rows)
    page.data("springs", rows)
    stiffness = np.geomspace(1e3, 1e6, 60)
    found = np.array([first_modes(d.table, value) for value in stiffness.tolist()])
    drawn = chart(
        MODES,
        [trace("first mode", stiffness, found[:, 0]), trace("second mode", stiffness, found[:, 1])],
        "stiffness [N m/rad]",
        "frequency [Hz]",
        ("x", "y"),
    )
    lines = {name: d.stiffness(x) for name, x in d.guesses().items() if "twice" not in name}
    page.add(mark_events(drawn, {**lines, "printed": PRINTED}))
    page.text(
        "A generator behind a converter, as A's and as the rotor circuits of B, C and D, has no "
        "such spring: its torque is what its control asks for. The spring of the thesis stands for "
        "a machine on the grid itself."
    )


def verdicts(
    d: Printed, springs: dict[str, float], modes: dict[str, tuple[float, float]]
) -> list[Record]:
    """Printed statements, ours, verdicts, what is missing."""
    a, b, c, _ = GENERATORS
    ranges = ", ".join(f"{value / 1e3:.1f}" for value in springs.values())
    firsts = ", ".join(f"{pair[0]:.3f}" for pair in modes.values())
    within = min(springs.values()) < PRINTED < max(springs.values())
    off = {
        one.letter: one.per_minute / one.table.speeds[-1] / published.RATED[one.letter][2] - 1.0
        for one in GENERATORS
    }
    far = [letter for letter, value in off.items() if abs(value) > 0.05]
    return [
        {
            "statement": "K_gen of D is 28 100 N m/rad",
            "ours": f"{ranges} kN m/rad by guess of the reactance; first mode {firsts} Hz",
            "verdict": "not testable: within what the data allow"
            if within
            else "outside of what the data allow",
            "missing": "reactance that holds the rotor's field: excitation, rotor leakage",
        },
        {
            "statement": "K_gen of A, B and C is not available",
            "ours": "the same guesses give a range for each, see the table of springs",
            "verdict": "holds: the data do not decide it",
            "missing": "the same; none where a converter stands between",
        },
        {
            "statement": f"A: 10 poles, {HERTZ:g} Hz, 515 rpm",
            "ours": f"10 poles at 515 rpm are {a.per_minute * a.poles / 120.0:.1f} Hz; {HERTZ:g} "
            f"Hz are {a.synchronous:.0f} rpm",
            "verdict": "do not hold together" if abs(a.slip) > SMALL else "hold together",
            "missing": "the converter's frequencies",
        },
        {
            "statement": "B, C and D turn at 1836, 1680 and 1809 rpm with 4 poles",
            "ours": ", ".join(f"{one.letter} {100.0 * one.slip:+.1f} %" for one in (b, c, d))
            + " of slip",
            "verdict": "C is below the speed of its field: only with power fed to its rotor"
            if c.slip < 0.0
            else "hold",
            "missing": "voltage and frequency of the rotors",
        },
        {
            "statement": "rated speeds of rotors (Table 4.1) and generators (Table 4.6)",
            "ours": ", ".join(f"{k} {percent_text(value)}" for k, value in off.items())
            + " apart by the gear ratio",
            "verdict": f"do not hold together for {' and '.join(far)}" if far else "hold together",
            "missing": "nothing",
        },
    ]
