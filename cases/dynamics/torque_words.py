"""What Al-Hamadani 2018, chapter 6, states of torque histories, beside what is found."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np

from fe_drivetrain.cases.dynamics.drivetrains import Rated, first_held
from fe_drivetrain.cases.dynamics.torque_digests import (
    DOMINANT,
    ERROR,
    HIGH_SWING,
    LEAST,
    LOW_SWING,
    MESH,
    POWER,
    POWER_SWING,
    SWING_RATIO,
    TORQUE,
    ByWind,
    Cycled,
    Operated,
    Wave,
    first_wave,
    free_mode,
)
from fe_drivetrain.cases.references import published_drivetrains as published
from fe_drivetrain.dynamics import library_machine
from fe_drivetrain.report.number_text import certain_value, percent_text, value_text
from fe_drivetrain.report.suite import Page, Record

LOW, HIGH = 22.44, 1809.0
"""Mean speeds of drivetrain D (section 6.1.1) [1/min]."""
LOW_SWUNG, HIGH_SWUNG = 0.8, 5.0
"""Oscillation of the slow shaft, and what the fast one goes up and down by [1/min]."""
PEAK = 0.84
"""Dominant frequency of the high-speed shaft's torque of D in normal operation [Hz]."""
MOST = 1.26
"""Largest torque of B over rated in normal operation."""
NORMAL, SHUTDOWN, NEGATIVE = 88e3, 440e3, -100e3
"""Ranges of the sun-planet force of C, and its negative mean in the shutdown [N]."""
HSS_NORMAL, HSS_SHUTDOWN = 3.8e3, 19e3
"""Largest ranges of the measured torque of the high-speed shaft (chapter 3) [N m]."""
MODULES = (0.014, 0.018)
"""Modules of the planetary stage that its torque allows [m]; the library's guess is between."""
GUESS = f"module of the sun, {1e3 * MODULES[0]:g} to {1e3 * MODULES[1]:g} mm: "
NEAR = 0.1
"""Share of a natural frequency within which a dominant frequency is near it."""


class Chapter(NamedTuple):
    """What was run for the chapter.

    Attributes
    ----------
    d, c : Operated
        Drivetrains D and C in operation.
    others : list of Operated
        A and B under the torque of C over its rated one.
    stops : dict
        Mesh cycles of the shutdowns of A, B and C.
    guesses : dict
        Those of C by what is not printed.
    winds : dict
        What winds do that are not those of the case.
    spring, slip, usual : str
        Names of the generators: on a spring, on the printed slip, and as in other cases.
    """

    d: Operated
    c: Operated
    others: list[Operated]
    stops: dict[str, Cycled]
    guesses: dict[str, Cycled]
    winds: dict[str, ByWind]
    spring: str
    slip: str
    usual: str

    @property
    def wave(self) -> Wave:
        """The first mode of D on its spring."""
        return first_wave(self.d.one)

    @property
    def swung(self) -> float:
        """Swing of D's torque over rated that half of the printed oscillation asks for."""
        return 0.5 * LOW_SWUNG * self.wave.torque

    def ratios(self) -> dict[str, float]:
        """Range of mesh forces in the shutdown over that in operation, of A, B and C."""
        of = {"A": self.others[0], "B": self.others[1], "C": self.c}
        return {k: self.stops[k].range / one.spread(self.usual)[MESH].mean for k, one in of.items()}


def mesh_force(one: Rated, module: float | None = None) -> float:
    """Force of C along the line of action of a sun-planet mesh at rated torque [N] (Eq 4.39).

    Parameters
    ----------
    one : Rated
        Drivetrain C.
    module : float, optional
        Normal module [m]; the library's where left out.
    """
    return one.torque / (sun_turns() * base_radius(module))


def sun_turns() -> float:
    """Torque of C's rotor over that of one sun mesh: ratio of the stage times its planets."""
    stage = first_stage()
    return float((1.0 + stage.teeth.ring / stage.teeth.sun) * stage.planets)


def first_stage() -> Any:
    """The planetary stage of the library's machine that is made after drivetrain C."""
    return library_machine("synthetic_2mw").stages[0]


def base_radius(module: float | None = None) -> float:
    """Base radius of the sun of C [m]: module and helix of the library, which are assumed there."""
    stage = first_stage()
    helix, angle = np.radians(stage.helix), np.radians(stage.pressure_angle)
    across = np.arctan(np.tan(angle) / np.cos(helix))
    return float(0.5 * (module or stage.module) * stage.teeth.sun / np.cos(helix) * np.cos(across))


def answer(page: Page, found: Chapter, hero: str) -> None:
    """State what the chapter's way of driving a model does to its results."""
    twice = found.d.errors(found.slip)[SWING_RATIO]
    spring, slip = (found.d.spread(name)[DOMINANT] for name in (found.spring, found.slip))
    by = {found.spring: spring, found.slip: slip}
    near = [name for name, one in by.items() if abs(one.mean / PEAK - 1.0) < NEAR / 2.0]
    ratios = found.ratios()
    swing = page.value(
        "swing of the torque of D's fast shaft over the true one, slip of 0.5 %",
        twice.mean,
        0.5 * (twice.largest - twice.least),
    )
    page.answer(
        "Does the thesis's chapter 6 hold when torque histories drive its models in operation?",
        "In part: with a shaft's torque record put on the rotor, drivetrain D's shaft torque "
        f"swings {certain_value(swing)} times as much as it should.",
        [
            swing,
            page.value(
                "dominant frequency of D, generator on a spring [Hz]",
                spring.mean,
                beside=PEAK,
                by="thesis",
            ),
            page.value(
                "dominant frequency of D, generator with slip of 0.5 % [Hz]",
                slip.mean,
                beside=PEAK,
                by="thesis",
            ),
            page.value(
                "swing of D's speeds, generator over rotor, generator on a spring",
                found.wave.ratio,
                beside=2.0 * HIGH_SWUNG / LOW_SWUNG,
                by="thesis",
            ),
            page.value("torque swing over rated that the printed speed swing needs", found.swung),
            page.value(
                "range of C's mesh force, shutdown over operation",
                ratios["C"],
                beside=SHUTDOWN / NORMAL,
                by="thesis",
            ),
        ],
        hero,
        [
            "The measured torque is not public: histories are those of a similar turbine in "
            "turbulent wind; ± is half of their scatter by seed.",
            f"The thesis's dominant frequency of {PEAK:g}\u00a0Hz is {of_generators(near)}; its "
            "controls of the generators and instants of the brake are not printed.",
        ],
        claim="holds in part",
    )


def of_generators(near: Sequence[str]) -> str:
    """Whose a frequency is that these generators have, in words."""
    if len(near) == 1:
        return f"found only with a generator on the assumed {near[0].partition(' ')[0]}"
    return "found with any assumed generator" if near else "found with no assumed generator"


def own_answer(page: Page, found: Operated, stop: Cycled, hero: str) -> None:
    """State how a user's drivetrain swings in operation, and how much more in a shutdown."""
    read, usual = found.spread(""), found.spread("slip of 1 %")
    over = stop.range / read[MESH].mean
    page.answer(
        "How do torque, speed and mesh forces swing in normal operation, and in a stop?",
        f"The fast shaft's torque swings by {percent_text(read[TORQUE].mean)} of rated (standard "
        f"deviation), mostly at {value_text(read[DOMINANT].mean, 'Hz')}; a stop moves mesh forces "
        f"{over:.1f} times as far.",
        [
            page.value(
                "torque of the fast shaft, standard deviation over rated", read[TORQUE].mean
            ),
            page.value(
                "dominant frequency [Hz]",
                read[DOMINANT].mean,
                beside=free_mode(found.one),
                by="first mode, free",
            ),
            page.value("range of the mesh force in 20 s over rated", read[MESH].mean),
            page.value("range in a stop over that", over),
            page.value("least force of the mesh in operation over rated", read[LEAST].least),
            page.value(
                "swing with the shaft's torque on the rotor, over the true one",
                found.errors("slip of 1 %")[SWING_RATIO].mean,
            ),
        ],
        hero,
        ["Wind and turbine are those of a similar rotor, not the user's own."],
    )
    page.say(
        "On a line of slip of 1 % the generator's speed swings by "
        f"{usual[HIGH_SWING].mean:.3g} rpm and the rotor's by {usual[LOW_SWING].mean:.3g} rpm."
    )


def show_verdicts(page: Page, found: Chapter) -> None:
    """Show each printed statement beside ours, with what is missing and what guesses move."""
    page.section("Printed, ours, verdict")
    rows = [*speeds(found), *spectra(found), *history(found), largest(found), *meshes(found)]
    page.table("Statements of chapter 6 on normal operation", rows)
    page.data("statements of chapter 6", rows)


def row(figure: str, statement: str, ours: str, verdict: str, moves: str) -> Record:
    """A statement, ours, the verdict, and which input is missing and what guesses of it move."""
    return {
        "figure": figure,
        "statement": statement,
        "ours": ours,
        "verdict": verdict,
        "missing, and what a guess moves": moves,
    }


def speeds(found: Chapter) -> Sequence[Record]:
    """Speeds and power of D."""
    fast = LOW * ratio_of_table(found.d.one)
    apart = abs(fast / HIGH - 1.0)
    by = {name: found.d.spread(name) for name in found.d.runs}
    swings = ", ".join(
        f"{name}: {each[LOW_SWING].mean:.2g} and {each[HIGH_SWING].mean:.2g} rpm"
        for name, each in by.items()
    )
    powers = ", ".join(
        f"{name}: {each[POWER].mean:.3f} with a deviation of {each[POWER_SWING].mean:.2g}"
        for name, each in by.items()
    )
    wave = found.wave
    fits = abs(wave.ratio / (2.0 * HIGH_SWUNG / LOW_SWUNG) - 1.0) < 0.01
    return [
        row(
            "6.2",
            f"slow shaft at {LOW:g} rpm in the mean, fast shaft about {HIGH:g} rpm",
            f"{LOW:g} rpm times the gear ratio is {fast:.0f} rpm",
            "do not hold together" if apart > 0.003 else "hold together",
            f"nothing: gears turn in one ratio; {percent_text(apart)} apart",
        ),
        row(
            "6.2",
            f"slow shaft swings by {LOW_SWUNG:g} rpm, fast shaft up and down by {HIGH_SWUNG:g} rpm",
            swings,
            f"hold together in the first mode on the spring alone, as a range of {LOW_SWUNG:g} rpm:"
            f" it has {wave.ratio:.2f} of the fast shaft for 1 of the slow one"
            if fits
            else "do not hold together",
            f"the shaft's torque then swings by {found.swung:.2f} of rated each way",
        ),
        row(
            "6.2",
            "power levels out at 750 kW",
            f"over rated: {powers}",
            "holds in the mean, which is that of the torque put in; not level with such a swing",
            "measured torque and controls of the generator",
        ),
    ]


def ratio_of_table(one: Rated) -> float:
    """Gear ratio, positive."""
    return float(one.table.speeds[-1])


def spectra(found: Chapter) -> Sequence[Record]:
    """Dominant frequencies of D, and of A to C."""
    by = {name: found.d.spread(name)[DOMINANT] for name in found.d.runs}
    ours = ", ".join(f"{name}: {one.mean:.3f} Hz" for name, one in by.items())
    near = [name for name, one in by.items() if abs(one.mean / PEAK - 1.0) < NEAR / 2.0]
    close, words = [], []
    for one in (*found.others, found.c):
        peak = one.spread(found.usual)[DOMINANT].mean
        held, free = first_held(one.one), free_mode(one.one)
        words.append(f"{one.one.letter}: {peak:.2f} Hz (modes {held:.2f} held, {free:.2f} free)")
        if min(abs(peak / held - 1.0), abs(peak / free - 1.0)) < NEAR:
            close.append(one.one.letter)
    return [
        row(
            "6.10",
            f"{PEAK:g} Hz dominates the torque of D's fast shaft, which may bring resonance",
            f"{ours}; its first mode on the spring is at {found.wave.frequency:.3f} Hz",
            f"holds with {' and '.join(near)} alone" if near else "does not hold",
            "controls of the generator: the guess decides the frequency; a line of slip has no "
            f"mode there but at {first_held(found.d.one):.2f} Hz, held",
        ),
        row(
            "6.19, 6.2.3",
            "no peaks near natural frequencies in normal operation of A, B and C",
            "; ".join(words),
            f"does not hold for {', '.join(close)}" if close else "holds",
            f"measured torque; 3P of C's rotor is at {found.c.one.per_minute / 20.0:.3f} Hz",
        ),
    ]


def history(found: Chapter) -> Sequence[Record]:
    """The simulated history of C against the measured one."""
    by = {name: found.c.errors(name) for name in found.c.runs}
    ours = ", ".join(
        f"{name}: swing {one[SWING_RATIO].mean:.2f} of the true one, error {one[ERROR].mean:.2f} "
        "of it"
        for name, one in by.items()
    )
    worst = max(one[ERROR].mean for one in by.values())
    return [
        row(
            "6.12",
            "simulated and measured torque of C's fast shaft agree, which validates the model",
            f"a model without any error, {ours}",
            "not testable: measured histories are not public; the comparison cannot validate "
            f"better than an error of {worst:.1f} of the swing, since the shaft's torque is put on "
            "the rotor",
            "measured torque of both shafts, and the generator's control",
        )
    ]


def largest(found: Chapter) -> Record:
    """The largest torque of B in normal operation."""
    b = found.others[1]
    most = max(float(run.torque(run.one.fast)[run.late].max()) for run in b.runs[found.usual])
    scaled = most * published.scaled_mean("B")
    # torque goes with the cube of the diameter
    asked = published.DIAMETERS[1] * (MOST / scaled) ** (1.0 / 3.0)
    return row(
        "6.17",
        f"largest torque of B over rated is {MOST:g} in normal operation, the history of C scaled "
        "by D^3",
        f"{most:.2f} about rated torque; scaled to the V90's {published.DIAMETERS[1]:g} m "
        f"{scaled:.2f}",
        "not reached with that diameter in such a wind"
        if scaled < (1.0 - NEAR) * MOST
        else "holds",
        f"diameter of B, for which {asked:.0f} m would be needed, and the measured torque",
    )


def meshes(found: Chapter) -> Sequence[Record]:
    """Mesh forces of C in operation and in the shutdown, and ranges of A, B and C."""
    rated = mesh_force(found.c.one)
    return [*in_normal(found, rated), *in_shutdown(found, rated), *ranges(found, rated)]


def in_normal(found: Chapter, rated: float) -> Sequence[Record]:
    """Mesh force of C in normal operation; `rated` is that at rated torque [N]."""
    low, high = (mesh_force(found.c.one, module) for module in reversed(MODULES))
    normal = found.c.spread(found.usual)
    by_slip = [found.c.spread(name)[LEAST].least for name in found.c.runs]
    winds = [each for one in found.winds.values() for each in (one.converter, one.direct)]
    return [
        row(
            "6.15",
            "no reversal of the sun-planet force of C in normal operation",
            f"least force {normal[LEAST].least:.2f} of that at rated torque",
            "holds" if normal[LEAST].least > 0.0 else "does not hold",
            f"measured torque; by slip {min(by_slip):.2f} to {max(by_slip):.2f}",
        ),
        row(
            "6.16",
            f"range about {NORMAL / 1e3:g} kN in normal operation",
            f"{normal[MESH].mean * rated / 1e3:.0f} kN ({normal[MESH].least * rated / 1e3:.0f} to "
            f"{normal[MESH].largest * rated / 1e3:.0f} by seed)",
            "not testable: neither torque nor module is printed",
            f"{GUESS}{normal[MESH].mean * low / 1e3:.0f} to "
            f"{normal[MESH].mean * high / 1e3:.0f} kN; wind and the turbine's generator: "
            f"{min(winds) * rated / 1e3:.0f} to {max(winds) * rated / 1e3:.0f} kN",
        ),
    ]


def in_shutdown(found: Chapter, rated: float) -> Sequence[Record]:
    """Mesh force of C in the shutdown; `rated` as for `in_normal`."""
    low, high = (mesh_force(found.c.one, module) for module in reversed(MODULES))
    stop = found.stops["C"]
    least = {name: one.least_mean() for name, one in found.guesses.items()}
    lows = {name: float(one.force.min()) for name, one in found.guesses.items()}
    first = next(iter(found.guesses))
    return [
        row(
            "6.16",
            f"range above {SHUTDOWN / 1e3:g} kN in the shutdown",
            f"{stop.range * rated / 1e3:.0f} kN",
            "holds" if stop.range * rated > SHUTDOWN else "does not hold",
            f"{GUESS}{stop.range * low / 1e3:.0f} to {stop.range * high / 1e3:.0f} kN; by instant "
            "of the brake and damping "
            f"{min(one.range for one in found.guesses.values()) * rated / 1e3:.0f} to "
            f"{max(one.range for one in found.guesses.values()) * rated / 1e3:.0f} kN",
        ),
        row(
            "6.16",
            f"mean of about {NEGATIVE / 1e3:g} kN in the shutdown",
            f"least mean of cycles {least[first] * rated / 1e3:.0f} kN, least force "
            f"{lows[first] * rated / 1e3:.0f} kN",
            mean_words(min(lows.values()), min(least.values()), NEGATIVE / rated),
            "instant of the brake and damping: "
            f"{min(least.values()) * rated / 1e3:.0f} to "
            f"{max(least.values()) * rated / 1e3:.0f} kN",
        ),
    ]


def ranges(found: Chapter, rated: float) -> Sequence[Record]:
    """Ranges in the shutdown over those in operation, and where the printed ones come from."""
    ratios, stop = found.ratios(), found.stops["C"]
    # forces that the printed ranges of the high-speed shaft give, one planet's sun mesh
    radii = [
        torque * ratio_of_table(found.c.one) / (sun_turns() * force)
        for torque, force in ((HSS_NORMAL, NORMAL), (HSS_SHUTDOWN, SHUTDOWN))
    ]
    return [
        row(
            "6.15, 6.3",
            "ranges of mesh forces of A, B and C are 5 to 6 times as large in the shutdown",
            ", ".join(f"{k} {value:.1f}" for k, value in ratios.items()),
            "holds" if all(4.5 <= v <= 6.5 for v in ratios.values()) else "larger here",
            "the torque in normal operation: with the printed range of the high-speed shaft "
            f"({HSS_NORMAL / 1e3:g} kN m) ours is "
            f"{stop.range / (NORMAL / rated):.1f} for C",
        ),
        row(
            "6.16, 3.6",
            f"{NORMAL / 1e3:g} and {SHUTDOWN / 1e3:g} kN are results of the model",
            f"the measured ranges of the high-speed shaft, {HSS_NORMAL / 1e3:g} and "
            f"{HSS_SHUTDOWN / 1e3:g} kN m, give both with a base radius of {radii[0]:.4f} and "
            f"{radii[1]:.4f} m of the sun; a module of "
            f"{1e3 * first_stage().module:g} mm has {base_radius():.4f} m",
            "they are the measured torque by statics: no swing of the model is in them"
            if abs(radii[0] / radii[1] - 1.0) < 0.01
            else "they are not the measured torque by statics",
            "module of the sun",
        ),
    ]


def mean_words(low: float, mean: float, printed: float) -> str:
    """Verdict on a negative mean of cycles: least force, least and printed mean, over rated."""
    if low >= 0.0:
        return "does not hold: forces are not reversed"
    if mean <= 0.5 * printed:
        return "holds"
    return (
        "reversal holds; such a mean is that of small cycles which ride on a reversed swing, and "
        "these histories have none"
    )
