"""Loads of the laminae of one bearing of a gearbox, whose load is linear in the hub's loads."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from hashlib import sha256
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.bearing.distribution import effective_centre
from fe_drivetrain.bearing.geometry import Bearing
from fe_drivetrain.bearing.rolling import free_motions
from fe_drivetrain.bearing_life.life.life_rules import LifeRules
from fe_drivetrain.bearing_life.life.rated import RatedBearing, of_geometry
from fe_drivetrain.bearing_life.life.roller_damage import Damage, damage_of_history
from fe_drivetrain.bearing_life.life.roller_models import (
    CHUNK,
    RollerModel,
    balanced,
    rigid_rings,
    steps_of,
)
from fe_drivetrain.bearing_life.life.steps import Steps
from fe_drivetrain.common.arrays import Floats, chunks
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.turbine_loads.hub_loads.point_loads import PointLoads


class Carried(NamedTuple):
    """Loads on the inner ring of a bearing.

    Attributes
    ----------
    loads : ndarray, (n, 5)
        What rolling elements carry [N, N m].
    flanges : ndarray, (n,)
        Axial force that they do not, and that flanges or other bearings have to [N].
    """

    loads: Floats
    flanges: Floats


@dataclass(frozen=True, eq=False)
class ReactionPath:
    """Path of hub loads to the rollers of a bearing by a matrix of reactions.

    Attributes
    ----------
    name : str
        Name of the bearing.
    rated : RatedBearing
        The bearing with its ratings.
    by_hub : Floats
        Load (a, 6, 6) on the inner ring under each unit load on the hub [N, N m], at a azimuths
        over a turn of a carrier, which come equally often; one matrix where the load stands still.
    by_weight : Floats
        Load (a, 6) under gravity; zero where nothing has its weight.
    speed_ratio : float
        Speed of one ring against the other over that of the rotor.
    rollers : callable or None
        How the load is shared by the laminae; rigid rings where not given.
    """

    name: str
    rated: RatedBearing
    by_hub: Floats
    by_weight: Floats
    speed_ratio: float
    rollers: RollerModel | None = None
    _model: RollerModel = field(init=False, repr=False)

    __repr__ = short_repr

    def __post_init__(self) -> None:
        object.__setattr__(self, "_model", self.rollers or rigid_rings(self.rated.bearing))

    @property
    def bearings(self) -> Mapping[str, Bearing]:
        """The bearing by its name."""
        return {self.name: self.rated.bearing}

    @property
    def repeats(self) -> int:
        """Number of load steps for each of the hub: one for each azimuth."""
        return len(self.by_hub)

    @property
    def key(self) -> str:
        """Fingerprint of the matrices."""
        found = sha256(np.ascontiguousarray(self.by_hub).tobytes())
        found.update(np.ascontiguousarray(self.by_weight).tobytes())
        return f"{found.hexdigest()} {self.speed_ratio!r}"

    def with_bearing(self, bearing: Bearing, rollers: RollerModel) -> ReactionPath:
        """The path with another clearance or profile of the bearing.

        Parameters
        ----------
        bearing : Bearing
            In its place.
        rollers : callable
            How it shares its load.
        """
        return replace(self, rated=replace(self.rated, bearing=bearing), rollers=rollers)

    def carried(self, hub_loads: PointLoads | ArrayLike) -> Carried:
        """Loads of the bearing, those of the azimuths of a step one after the other.

        Motions that rolling elements do not resist get no load: axial ones of cylindrical rollers,
        tilt of aligning ones. A row that carries one axial direction alone is taken to stand with
        its pressure centre where its machine has the bearing, so that its axial load presses it,
        and against another one: its axial load is at least that which its radial load makes,
        F_r / (2 Y).

        Parameters
        ----------
        hub_loads : PointLoads or array_like, (n, 6) or more
            Forces and moments on the hub, where the machine begins [N, N m].
        """
        hub = _hub_loads(hub_loads)
        whole = np.einsum("aij,nj->nai", self.by_hub, hub) + self.by_weight
        return carried_loads(self.rated, whole.reshape(-1, 6))

    def steps(
        self,
        hub_loads: PointLoads | ArrayLike,
        speed_rpm: ArrayLike,
        seconds: ArrayLike,
        chunk: int = CHUNK,
    ) -> Iterator[Steps]:
        """Load steps of the bearing, some hundred of the hub at a time.

        Parameters
        ----------
        hub_loads : PointLoads or array_like, (n, 6) or more
            Loads on the hub [N, N m], see `carried`.
        speed_rpm, seconds : array_like
            Speed of the rotor [1/min], (n,) or one for all, and duration of each step [s], which
            its azimuths share.
        chunk : int
            Steps of the hub at a time.

        Yields
        ------
        steps : Steps
            Load steps, `repeats` for each of the hub, with the speed of the bearing.
        """
        hub, a = _hub_loads(hub_loads), self.repeats
        turns, lasting = (
            np.broadcast_to(np.asarray(v, dtype=float), (len(hub),)) for v in (speed_rpm, seconds)
        )
        for part in chunks(len(hub), chunk):
            loads = self.carried(hub[part]).loads
            laminae, converged = self._model(loads)
            yield Steps(
                loads,
                balanced(laminae, converged),
                np.repeat(self.speed_ratio * turns[part], a),
                np.repeat(lasting[part] / a, a),
                converged,
            )


def carried_loads(rated: RatedBearing, loads: ArrayLike) -> Carried:
    """What rolling elements carry of loads on the inner ring; see `ReactionPath.carried`.

    Parameters
    ----------
    rated : RatedBearing
        The bearing.
    loads : array_like, (n, 6)
        Fx, Fy, Fz, Mx, My, Mz [N, N m].
    """
    given = np.atleast_2d(np.asarray(loads, dtype=float))
    bearing, found = rated.bearing, given[:, [0, 1, 2, 4, 5]]
    if one_sided(bearing):
        return Carried(_pressed(rated, found), np.zeros(len(found)))
    motions, kept = free_motions(bearing)
    if kept.all():
        return Carried(found, np.zeros(len(found)))
    scale = np.array([1.0, 1.0, 1.0, bearing.arm, bearing.arm])
    unit = motions * scale[:, None]  # orthonormal columns
    resisted = found / scale @ unit @ unit.T * scale
    return Carried(resisted, np.abs(found[:, 0] - resisted[:, 0]))


def _pressed(rated: RatedBearing, loads: Floats) -> Floats:
    """Loads (n, 5) of a row that carries one axial direction, from those at its pressure centre."""
    row, found = rated.bearing.rows[0], loads.copy()
    side = np.sign(row.angle)
    # seen from the other side, axial force and moments have other signs
    found[:, [0, 3, 4]] *= np.where(side * found[:, :1] < 0.0, -1.0, 1.0)
    Y = (rated.factors or of_geometry(rated.bearing)).above[1]
    least = np.hypot(found[:, 1], found[:, 2]) / (2.0 * Y)
    found[:, 0] = side * np.maximum(np.abs(found[:, 0]), least)
    centre = effective_centre(row)
    found[:, 3] -= centre * found[:, 2]
    found[:, 4] += centre * found[:, 1]
    return found


def damage_of_forces(
    rated: RatedBearing,
    forces: ArrayLike,
    speed_rpm: ArrayLike,
    seconds: ArrayLike,
    rules: LifeRules,
) -> Damage:
    """Damage by forces of a bearing over time, such as those of a transient.

    Parameters
    ----------
    rated : RatedBearing
        The bearing with its ratings.
    forces : array_like, (n, 6)
        Load on the inner ring, Fx, Fy, Fz [N], Mx, My, Mz [N m], of which rolling elements carry
        what `carried_loads` says.
    speed_rpm, seconds : array_like
        Speed of one ring against the other [1/min], (n,) or one for all, and duration of each step
        [s].
    rules : LifeRules
        Choices of the rating; of a planet with its outer ring turning.

    Returns
    -------
    damage : Damage
        1 is the end of the life with a reliability of 90 %.
    """
    loads = carried_loads(rated, forces).loads
    steps = steps_of(rigid_rings(rated.bearing), loads, speed_rpm, seconds)
    return damage_of_history(steps, rated, rules)


def one_sided(bearing: Bearing) -> bool:
    """Whether a bearing is one row with a contact angle, which carries one axial direction."""
    return len(bearing.rows) == 1 and bearing.rows[0].angle != 0.0


def _hub_loads(loads: PointLoads | ArrayLike) -> Floats:
    """(n, 6) loads on the hub."""
    values = loads.values if isinstance(loads, PointLoads) else np.asarray(loads, dtype=float)
    hub = np.atleast_2d(values)
    if hub.ndim != 2 or hub.shape[1] < 6:
        raise InputError(
            f"hub loads of shape {np.shape(values)}: give Fx, Fy, Fz, Mx, My, Mz in (n, 6)"
        )
    return np.asarray(hub[:, :6])
