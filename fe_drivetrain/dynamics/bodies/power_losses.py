"""Power lost in a drivetrain: friction of bearings and teeth, part by part, and what arrives.

Torque goes from the rotor through shafts and stages; each part on its way takes a torque from it
that is stated at the rotor: a friction moment times the ratio of its speed, or a share of the
torque that passes. So power is balanced part by part, at any speed, and at standstill no power
flows. Bearings carry what the statics without losses give them (`bearing_reactions`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from fe_drivetrain.bearing.catalogue import Entry
from fe_drivetrain.bearing.friction import (
    FrictionBearing,
    FrictionMoment,
    Supply,
    friction_bearing,
    palmgren_friction,
)
from fe_drivetrain.bearing.roller_friction import DENSITY, pressure_coefficient, roller_friction
from fe_drivetrain.bearing.skf_friction import skf_friction, sliding_coefficient
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.dynamics.bodies.bearing_reactions import Reactions
from fe_drivetrain.gear.involute import Pair
from fe_drivetrain.gear.losses import (
    film_friction,
    mean_friction,
    shaft_seal_moment,
    tooth_loss_factor,
)

FrictionModel = Literal["palmgren", "skf", "rollers"]
"""Model of friction: factors f0 and f1 of bearings, SKF's published model, or the sum over rollers;
of teeth Schlenk's coefficient with the first two, that of a film with the last."""


@dataclass(frozen=True)
class Film:
    """A lubricant in operation, as far as it counts for friction.

    Attributes
    ----------
    viscosity : float
        Kinematic viscosity of the oil, or base oil, in operation [m^2/s].
    supply : {"grease", "oil bath", "oil jet"}
        How it comes to what it lubricates.
    """

    viscosity: float
    supply: Supply = "oil jet"


@dataclass(frozen=True)
class LossyBearing:
    """A bearing whose friction counts.

    Attributes
    ----------
    name : str
        Its name; of planets "stage 1 pin upwind".
    place : float
        Where it is on the way of the torque: the number of its shaft from 0, k - 0.5 in stage k.
    entry : Entry
        Its entry of the catalogue.
    film : Film
        Its lubricant.
    """

    name: str
    place: float
    entry: Entry
    film: Film

    @property
    def sizes(self) -> FrictionBearing:
        """What models of friction need of it."""
        return friction_bearing(self.name, self.entry)


@dataclass(frozen=True)
class LossyMesh:
    """A mesh whose sliding counts.

    Attributes
    ----------
    name : str
        Its name.
    stage : int
        Number of its stage, from 1.
    pair : Pair
        Both gears.
    planets : int
        Number of planets that share the torque; 1 of a pair.
    torque_ratio, speed_ratio : float
        Torque on the first gear in one mesh, and its speed against the carrier, over the rotor's.
    roughness : float
        Arithmetic mean roughness Ra of the flanks [m].
    """

    name: str
    stage: int
    pair: Pair
    planets: int
    torque_ratio: float
    speed_ratio: float
    roughness: float

    @property
    def rolling(self) -> float:
        """Power that rolls through the mesh, against the carrier, over that of the stage."""
        return self.planets * self.torque_ratio * self.speed_ratio


@dataclass(frozen=True)
class LossySeal:
    """A seal that rubs on a shaft.

    Attributes
    ----------
    name : str
        Its name.
    shaft : int
        Number of its shaft from 0.
    diameter : float
        Diameter on which it rubs [m].
    speed_ratio : float
        Speed of the shaft over that of the rotor, without a sign.
    """

    name: str
    shaft: int
    diameter: float
    speed_ratio: float


@dataclass(frozen=True, eq=False)
class Losses:
    """Torques that parts take from a drivetrain at n operating points, and what arrives.

    Attributes
    ----------
    names : tuple of str
        Parts (p), in the order of the way of the torque.
    places : tuple of float
        Where each is: the number of its shaft from 0, k - 0.5 in stage k.
    torque, speed : Floats
        Torque (n,) on the rotor [N m], and its speed [rad/s].
    taken : Floats
        Torque (p, n) that each part takes, at the rotor, without a sign [N m].
    low, high : Floats
        Its least and largest value (p, n) by what its model leaves open [N m].
    ratio : float
        Speed of the generator over that of the rotor.
    """

    names: tuple[str, ...]
    places: tuple[float, ...]
    torque: Floats
    speed: Floats
    taken: Floats
    low: Floats
    high: Floats
    ratio: float

    __repr__ = short_repr

    @property
    def heat(self) -> Floats:
        """Power (p, n) that becomes heat in each part [W]."""
        return np.asarray(self.taken * np.abs(self.speed))

    @property
    def entering(self) -> Floats:
        """Power (n,) that the rotor gives [W]."""
        return self.torque * self.speed

    @property
    def generator_torque(self) -> Floats:
        """Torque (n,) that arrives at the generator, positive as the rotor's [N m].

        At standstill friction has no direction: it is that without losses, give or take `held`.
        """
        left = self.torque - np.sign(self.speed) * self.taken.sum(axis=0)
        return np.asarray(left / abs(self.ratio))

    @property
    def leaving(self) -> Floats:
        """Power (n,) that the generator takes [W]."""
        return self.generator_torque * abs(self.ratio) * self.speed

    @property
    def held(self) -> Floats:
        """Torque (n,) at the rotor that friction can hold, without a sign [N m]."""
        return np.asarray(self.taken.sum(axis=0))

    @property
    def efficiency(self) -> Floats:
        """Power that leaves over that which enters (n,), by the way it flows; NaN of none."""
        driven = self.entering > 0.0
        over = np.where(driven, self.entering, np.minimum(self.leaving, 0.0))
        under = np.where(driven, self.leaving, self.entering)
        found = np.full(len(over), np.nan)
        np.divide(under, over, out=found, where=over != 0.0)
        return found

    def along(self, places: Sequence[float]) -> Floats:
        """Torque (k, n) at the rotor's speed that is left behind the parts up to each place [N m].

        Parameters
        ----------
        places : sequence of float
            Places, as `places` counts them.
        """
        sign, own = np.sign(self.speed), np.array(self.places)
        left = [self.torque - sign * self.taken[own <= place].sum(axis=0) for place in places]
        return np.array(left)


class LossModel:
    """A machine whose losses are asked for, at any number of operating points.

    Parameters
    ----------
    reactions : mapping of str to Reactions
        Loads of its bearings.
    bearings : sequence of LossyBearing
        Those whose friction counts.
    meshes : sequence of LossyMesh
        Those whose sliding counts.
    film : Film
        Oil of the teeth.
    ratio : float
        Speed of the generator over that of the rotor.
    seals : sequence of LossySeal
        Those that rub.
    """

    def __init__(
        self,
        reactions: Mapping[str, Reactions],
        bearings: Sequence[LossyBearing],
        meshes: Sequence[LossyMesh],
        film: Film,
        ratio: float,
        seals: Sequence[LossySeal] = (),
    ) -> None:
        self.reactions, self.film, self.ratio = reactions, film, ratio
        self.bearings, self.meshes, self.seals = tuple(bearings), tuple(meshes), tuple(seals)

    def losses(
        self, hub: Floats, speed: Floats, model: FrictionModel, carried: Floats | None = None
    ) -> Losses:
        """Losses at operating points.

        Parameters
        ----------
        hub : ndarray, (n, 6)
            Loads of the rotor on its shaft, Mx the torque [N, N m].
        speed : ndarray, (n,)
            Speed of the rotor [rad/s].
        model : {"palmgren", "skf", "rollers"}
            Model of the friction of bearings; balls have SKF's where rollers are asked for.
        carried : ndarray, (n, 6), optional
            Loads of the hub by which bearings are loaded, where they differ.

        Returns
        -------
        losses : Losses
            Part by part; each mesh has the torque that is left where it is.
        """
        torque = hub[:, 3]
        loads = hub if carried is None else carried
        made: list[tuple[float, str, Callable[[Floats], tuple[Floats, Floats, Floats]]]] = []
        for one in self.bearings:
            of = self._bearing(one, loads, speed, model)
            made.append((one.place, one.name, lambda left, of=of: of))  # type: ignore[misc]
        for mesh in self.meshes:

            def teeth(left: Floats, mesh: LossyMesh = mesh) -> tuple[Floats, Floats, Floats]:
                return self._mesh(mesh, left, speed, model)

            made.append((mesh.stage - 0.5, mesh.name, teeth))
        for seal in self.seals:
            rubbed = np.full(len(torque), seal.speed_ratio * shaft_seal_moment(seal.diameter))
            of = rubbed, rubbed, rubbed
            made.append((float(seal.shaft), seal.name, lambda left, of=of: of))  # type: ignore[misc]
        made.sort(key=lambda one: one[0])
        rows: list[tuple[Floats, Floats, Floats]] = []
        left, sign = torque.astype(float), np.sign(speed)
        for place in sorted({one[0] for one in made}):
            # all parts of one place have the torque that arrives there
            here = [of(left) for at, _, of in made if at == place]
            left = left - sign * sum(taken for taken, _, _ in here)
            rows += here
        values = np.array(rows).reshape(len(made), 3, len(torque))
        names, places = tuple(one[1] for one in made), tuple(one[0] for one in made)
        return Losses(
            names, places, torque, speed, values[:, 0], values[:, 1], values[:, 2], self.ratio
        )

    def _bearing(
        self, one: LossyBearing, hub: Floats, speed: Floats, model: FrictionModel
    ) -> tuple[Floats, Floats, Floats]:
        """Torque (n,) at the rotor that a bearing takes, its least and its largest value [N m]."""
        reaction = self.reactions[one.name]
        loads = reaction.under(hub)
        count, azimuths = loads.shape[:2]
        flat = loads.reshape(-1, 6)
        turning = np.repeat(speed * reaction.speed_ratio, azimuths)
        moment = _friction(one, flat, turning, model)
        factor = reaction.speed_ratio * max(reaction.planets, 1)
        mean = [
            factor * value.reshape(count, azimuths).mean(axis=1)
            for value in (moment.total, moment.low, moment.high)
        ]
        return mean[0], mean[1], mean[2]

    def _mesh(
        self, mesh: LossyMesh, left: Floats, speed: Floats, model: FrictionModel
    ) -> tuple[Floats, Floats, Floats]:
        """Torque (n,) at the rotor that all meshes of a kind in a stage take [N m]."""
        turning, nu = speed * mesh.speed_ratio, self.film.viscosity
        on_teeth = (mesh.pair, left * mesh.torque_ratio, turning, DENSITY * nu, mesh.roughness)
        if model == "rollers":
            mu = film_friction(*on_teeth, pressure_coefficient(nu))
        else:
            mu = mean_friction(*on_teeth)
        factors = tooth_loss_factor(mesh.pair), tooth_loss_factor(mesh.pair, even=True)
        share = np.abs(left) * mesh.rolling * mu
        if mesh.pair.overlap_ratio == 0.0:
            return (share * factors[0],) * 3
        return share * factors[0], share * min(factors), share * max(factors)


def _friction(
    one: LossyBearing, loads: Floats, turning: Floats, model: FrictionModel
) -> FrictionMoment:
    """Friction moment (n,) of a bearing under loads (n, 6) of its inner ring."""
    sizes, film = one.sizes, one.film
    radial, axial = np.hypot(loads[:, 1], loads[:, 2]), np.abs(loads[:, 0])
    forces = (radial, axial, turning, film.viscosity)
    if model == "palmgren":
        return palmgren_friction(sizes, *forces, film.supply)
    if model == "rollers" and one.entry.kind != "ball":
        sliding = sliding_coefficient(sizes, turning, film.viscosity)
        return roller_friction(one.entry.bearing(one.name), *forces, sliding)
    rating = None if one.entry.ratings is None else one.entry.ratings.C0
    return skf_friction(sizes, *forces, film.supply, rating)
