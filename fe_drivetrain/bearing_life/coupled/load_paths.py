"""Loads of the laminae of one bearing in a shaft from hub loads, at any level of the model."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.bearing.geometry import Bearing
from fe_drivetrain.bearing_life.coupled.body import LinearBody, factors_of
from fe_drivetrain.bearing_life.coupled.newton import coupled_equilibrium
from fe_drivetrain.bearing_life.coupled.springs import on_springs, tilt_springs
from fe_drivetrain.bearing_life.life.life_rules import LifeRules
from fe_drivetrain.bearing_life.life.rated import RatedBearing
from fe_drivetrain.bearing_life.life.roller_damage import Damage, damage_of_history
from fe_drivetrain.bearing_life.life.roller_models import CHUNK, RollerModel, balanced, rigid_rings
from fe_drivetrain.bearing_life.life.steps import Steps
from fe_drivetrain.common.arrays import Bools, Floats, chunks
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.progress import Progress, silent
from fe_drivetrain.shafts.response.entering import Loads, entering
from fe_drivetrain.turbine_loads.hub_loads.point_loads import PointLoads

PINNED = 0.0
"""Tilting stiffness of a support that carries no moment [N m/rad]."""


@dataclass(frozen=True, eq=False)
class LoadPath:
    """Path of hub loads to the rollers of a bearing.

    Attributes
    ----------
    body : LinearBody
        The shaft, with or without housings in series.
    bearings : Mapping
        All bearings of the body by name.
    name : str
        The one whose life is asked for.
    rollers : callable
        Function that shares its load between its laminae: `rigid_rings`, `three_degree_rings` or
        `flexible_rings` of `fe_drivetrain.bearing_life.life`; rigid rings where not given.
    tilt_stiffness : float or None
        None: all bearings are in equilibrium with the shaft, rollers and all. A number: they are
        springs, rigid along the axes, with this K_R [N m/rad] at the named bearing and none at the
        others; `PINNED` leaves out its moment, too.
    gearbox_weight, gravity : float
        Weight [N] and acceleration [m/s^2], along -z.
    """

    body: LinearBody
    bearings: Mapping[str, Bearing]
    name: str
    rollers: RollerModel | None = None
    tilt_stiffness: float | None = None
    gearbox_weight: float = 0.0
    gravity: float = 0.0
    _model: RollerModel = field(init=False, repr=False)

    def __post_init__(self) -> None:
        if self.name not in self.bearings or set(self.bearings) != set(self.body.bearings):
            raise InputError(
                f"bearing {self.name!r}: give one rolling bearing for each of "
                f"{', '.join(self.body.bearings)}, and name one of these"
            )
        object.__setattr__(self, "_model", self.rollers or rigid_rings(self.bearings[self.name]))

    @property
    def repeats(self) -> int:
        """Number of load steps for each of the hub."""
        return 1

    @property
    def speed_ratio(self) -> float:
        """Speed of the bearing over that of the rotor."""
        return 1.0

    def with_bearing(self, bearing: Bearing, rollers: RollerModel) -> LoadPath:
        """The path with another clearance or profile of the named bearing.

        Parameters
        ----------
        bearing : Bearing
            In place of the named one.
        rollers : callable
            How it shares its load.
        """
        return replace(self, bearings={**self.bearings, self.name: bearing}, rollers=rollers)

    def bearing_loads(self, hub_loads: Loads) -> tuple[Floats, Bools]:
        """Loads on the inner ring of the named bearing.

        Parameters
        ----------
        hub_loads : LoadHistory, PointLoads or array_like
            Loads as `shafts.response.entering` takes them; an array is (n, 6) Fx, Fy, Fz [N], Mx,
            My, Mz [N m] of the rotor on the shaft at the hub; six columns more for each load point
            of the body.

        Returns
        -------
        loads : Floats
            Loads (n, 5) Fx, Fy, Fz [N], My, Mz [N m] at its centre.
        converged : Bools
            Flags (n,): whether there is equilibrium.

        Raises
        ------
        InputError
            `shafts.response.entering` refuses the loads.
        """
        factors = factors_of(entering(self.body, hub_loads), self.gearbox_weight, self.gravity)
        place = self.body.bearings.index(self.name)
        if self.tilt_stiffness is None:
            found = coupled_equilibrium(self.body, self.bearings, factors)
            return found.forces[:, place], found.converged
        springs = [
            tilt_springs(
                self.bearings[name],
                self.tilt_stiffness if name == self.name else PINNED,
                (0.0 if name in self.body.sliding else np.inf, np.inf, np.inf),
            )
            for name in self.body.bearings
        ]
        forces = on_springs(self.body, factors, np.stack(springs)).forces[:, place]
        return forces, np.ones(len(forces), dtype=bool)

    def steps(
        self, hub_loads: Loads, speed_rpm: ArrayLike, seconds: ArrayLike, chunk: int = CHUNK
    ) -> Iterator[Steps]:
        """Load steps of the bearing, some hundred at a time.

        Parameters
        ----------
        hub_loads : LoadHistory, PointLoads or array_like
            Loads (n, 6) [N, N m], see `bearing_loads`.
        speed_rpm, seconds : array_like
            Speed of the shaft [1/min], (n,) or one for all, and duration of each step [s].
        chunk : int
            Steps at a time.

        Yields
        ------
        steps : Steps
            Load steps, in order.
        """
        hub = _steps(self.body, hub_loads)
        turns, lasting = (
            np.broadcast_to(np.asarray(v, dtype=float), (len(hub),)) for v in (speed_rpm, seconds)
        )
        for part in chunks(len(hub), chunk):
            loads, found = self.bearing_loads(hub[part])
            laminae, converged = self._model(loads)
            both = found & converged
            yield Steps(loads, balanced(laminae, both), turns[part], lasting[part], both)


def damage_of_hub_loads(
    path: LoadPath,
    hub_loads: Loads,
    speed_rpm: ArrayLike,
    seconds: ArrayLike,
    rated: RatedBearing,
    rules: LifeRules,
    report: Progress = silent,
) -> Damage:
    """Damage by a history of hub loads to a bearing.

    Parameters
    ----------
    path : LoadPath
        Load path from the hub to the bearing's laminae.
    hub_loads : LoadHistory, PointLoads or array_like
        Loads (n, 6) [N, N m], see `LoadPath.bearing_loads`.
    speed_rpm, seconds : array_like
        Speed of the shaft [1/min], (n,) or one for all, and duration of each step [s].
    rated : RatedBearing
        Named bearing with its ratings.
    rules : LifeRules
        Choices of the rating.
    report : Progress
        Function that is told how many steps are complete.

    Returns
    -------
    damage : Damage
        Damage of the whole history, in memory that does not grow with it.

    Raises
    ------
    InputError
        `shafts.response.entering` refuses the loads.
    """
    hub = _steps(path.body, hub_loads)
    count = len(hub)

    def counted() -> Iterator[Steps]:
        done = 0
        for steps in path.steps(hub, speed_rpm, seconds):
            yield steps
            done += len(steps.loads)
            report(f"load steps ({done} of {count})")

    return damage_of_history(counted(), rated, rules)


def _steps(body: LinearBody, hub_loads: Loads) -> PointLoads:
    """Load steps (n, 6 or more) as they enter the body; a single one as one of one."""
    found = entering(body, hub_loads)
    return replace(found, values=np.atleast_2d(found.values))
