"""Natural modes of a drivetrain: frequencies, shapes, energy, and which excitations meet them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.progress import Progress, silent
from fe_drivetrain.common.steps import Steps
from fe_drivetrain.dynamics import Machine, machine_system, system_modes
from fe_drivetrain.procedure import Excitation, drivetrain_excitations
from fe_drivetrain.report.results import Chart
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.studies.mode_charts import campbell_chart, frequency_chart
from fe_drivetrain.studies.mode_findings import state_modes
from fe_drivetrain.studies.mode_levels import compared_levels, frequency_bands, named_level
from fe_drivetrain.studies.mode_parts import described
from fe_drivetrain.studies.mode_record import Modes
from fe_drivetrain.studies.mode_speeds import in_operation
from fe_drivetrain.studies.result import Result

SHOWN = 16
"""Number of modes that are described, and whose shapes are kept."""
PASSINGS = 3
"""Multiples of blade passing that excite: 3P, 6P and 9P of three blades."""


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class ModesResult(Modes, Result):
    """Natural modes of a drivetrain at one level, and how they stand to its excitations.

    Beside what `Result` has: ``frequencies``, ``bands``, ``kinds`` and ``words`` of all modes,
    ``kinetic`` and ``strain`` energy by part, ``shapes`` by body, ``running`` frequencies and
    ``damping``, ``campbell``, ``meetings`` of excitations with modes, ``ladder`` of levels.

    Attributes
    ----------
    drivetrain : Machine
        The drivetrain.
    """

    STUDY: ClassVar[str] = "modes"
    SCHEMA_VERSION: ClassVar[int] = 1

    drivetrain: Machine

    def chart(self) -> Chart:
        """Campbell diagram; the frequencies by kind where no speeds are known."""
        return frequency_chart(self) if self.speeds is None else campbell_chart(self)


def modes(
    drivetrain: Machine,
    *,
    level: str | None = None,
    generator: str = "free",
    speeds: tuple[float, float] | None = None,
    speed: float | None = None,
    blades: int = 3,
    excitations: Sequence[Excitation] = (),
    tolerance: float = 0.05,
    report: Progress = silent,
) -> ModesResult:
    """Compute natural modes of a drivetrain, and which excitations meet them in operation.

    Parameters
    ----------
    drivetrain : Machine
        The drivetrain.
    level : str or None
        "torsional", "rigid" (bodies with six degrees of freedom) or "flexible" (shafts that bend);
        None for the finest that the data allow.
    generator : str
        "free" to turn, or "held".
    speeds : tuple of float or None
        Least and largest speed of the rotor in operation [rad/s]; without, nothing is known of
        excitations.
    speed : float or None
        Speed of the rotor of the frequencies in operation [rad/s]; None for the largest.
    blades : int
        Number of blades of the rotor.
    excitations : sequence of Excitation
        Others beside those that follow from blades, planets, teeth and shafts, as a controller's.
    tolerance : float
        Relative error of a frequency that a simpler level may have.
    report : Progress
        Called with the name of each step as it begins.

    Raises
    ------
    InputError
        An option is out of its range, or the level needs data that are missing.
    """
    _check(generator, speeds, speed, blades, tolerance)
    found, steps = Findings(), Steps(report)
    found.seed = None
    found.about(drivetrain)
    chosen, held = named_level(level, drivetrain), generator == "held"
    with steps.step("modes at rest"):
        system = machine_system(drivetrain, chosen, held_generator=held)
        solved = system_modes(system)
    own = described(drivetrain, system, solved, SHOWN)
    with steps.step("levels"):
        answers, enough = compared_levels(drivetrain, held, tolerance)
    with steps.step("bands"):
        bands = frequency_bands(drivetrain, chosen, held, len(own.frequencies))
    acting = (*drivetrain_excitations(drivetrain.stages, blades, PASSINGS), *excitations)
    with steps.step("modes in operation"):
        running = in_operation(system, solved, acting, speeds, speed)
    record = Modes(
        level=chosen,
        bands=bands,
        speeds=speeds,
        excitations=acting,
        ladder=tuple(answers),
        enough=enough,
        tolerance=tolerance,
        **vars(own),
        **vars(running),
    )
    state_modes(found, drivetrain, record, SHOWN)
    asked = {"level": level, "generator": generator, "speeds": speeds, "speed": speed}
    others = [one.name for one in excitations]
    return ModesResult(
        drivetrain=drivetrain,
        **vars(record),
        **found.frozen(
            steps.times, **asked, blades=blades, excitations=others, tolerance=tolerance
        ),
    )


def _check(
    generator: str,
    speeds: tuple[float, float] | None,
    speed: float | None,
    blades: int,
    tolerance: float,
) -> None:
    """Refuse options that are out of their range."""
    if generator not in ("free", "held"):
        raise InputError(f"generator is {generator!r} but must be free or held: change it")
    if speeds is not None and not 0.0 <= speeds[0] < speeds[1] < math.inf:
        raise InputError(
            f"speeds of the rotor are {speeds[0]:g} to {speeds[1]:g} rad/s but the least must be "
            "from 0 and the largest above it: change them"
        )
    if speed is not None and not 0.0 < speed < math.inf:
        raise InputError(f"speed of the rotor is {speed:g} rad/s but must be above 0: change it")
    if blades < 1:
        raise InputError(f"the rotor has {blades} blades but must have 1 at least: change it")
    if not 0.0 < tolerance < 1.0:
        raise InputError(f"tolerance is {tolerance:g} but must be between 0 and 1: change it")
