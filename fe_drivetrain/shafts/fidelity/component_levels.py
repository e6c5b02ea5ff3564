"""The fidelity ladder of a component: rigid body, frame of beams, solid.

Each level answers as the levels of a drivetrain do (`fe_drivetrain.shafts.fidelity.LevelModel`), to
the loads of `loads_of`: forces and moments at the points that loads come in by, then gravity.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import FORCES, MOTIONS
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.scaling import scaled_to_unit_diagonal
from fe_drivetrain.common.spatial import point_motions, wrench_transport
from fe_drivetrain.drivetrain_file.component import (
    CarrierComponent,
    Component,
    HousingComponent,
    check_component_standing,
    material_of,
)
from fe_drivetrain.elasticity.solve.condensation import Condensed, on_supports, supported
from fe_drivetrain.shafts.fidelity.component_frames import carrier_frame, housing_frame
from fe_drivetrain.shafts.fidelity.component_solid import SolidComponent, solid_component
from fe_drivetrain.shafts.fidelity.ladder import Cost, LevelModel

#: Couplings of a spring matrix below this share of its diagonal are not worth a name.
NAMED_FROM = 1e-3


def loads_of(component: Component) -> tuple[str, ...]:
    """Names of the unit loads: "ring.Fx" and so on [N, N m], then gravity along x, y, z [m/s^2]."""
    at_points = [f"{name}.{c}" for name in component.loaded for c in FORCES]
    return (*at_points, "gravity.x", "gravity.y", "gravity.z")


def rigid_level(component: Component) -> LevelModel:
    """Level 0: a rigid body. On bushings, statics and their springs; on a flange, statics alone."""
    check_component_standing(component)
    start = time.perf_counter()
    names = [a.name for a in component.attachments]
    positions = np.array([a.position for a in component.attachments])
    motions = point_motions(positions, positions[0])
    volume, centre = component.body.volume_and_centre()
    mass = material_of(component).density * volume
    weight = mass * wrench_transport(np.array(centre) - positions[0])[:, :3]
    loaded = [names.index(name) for name in component.loaded]
    carry = np.hstack([motions[6 * k : 6 * k + 6].T for k in loaded])
    resultants = np.hstack([carry, weight])  # about the first point
    if isinstance(component, CarrierComponent):
        cost = Cost(time.perf_counter() - start, 6)
        return LevelModel(0, "rigid body", ("every stiffness",), cost, {"hub": resultants})
    parts = {name: motions[6 * k : 6 * k + 6] for k, name in enumerate(names)}
    springs = component.supports
    K = np.asarray(sum(parts[name].T @ k @ parts[name] for name, k in springs.items()))
    reactions = {
        name: k @ parts[name] @ np.linalg.solve(K, resultants) for name, k in springs.items()
    }
    compliance = motions @ np.linalg.solve(K, motions.T)
    cost = Cost(time.perf_counter() - start, 6)
    neglects = ("housing and arms that give: all of it is rigid",)
    return LevelModel(
        0, "rigid body on its bushings", neglects, cost, reactions, tuple(names), compliance
    )


def frame_level(component: Component, ring_gives: bool = True) -> LevelModel:
    """Level 1: beams between rigid bodies.

    Parameters
    ----------
    component : Component
        The component.
    ring_gives : bool
        Whether the ring of a housing is of beams, too.
    """
    check_component_standing(component)
    start = time.perf_counter()
    if isinstance(component, CarrierComponent):
        body = carrier_frame(component)
        title = "hub, webs and pins as beams between rigid cheeks"
        neglects: tuple[str, ...] = ("cheeks that bend where hub, webs and pins stand on them",)
    else:
        body = housing_frame(component, ring_gives)
        title = "arms and ring as beams" if ring_gives else "arms as beams, rigid ring"
        neglects = (
            "what arms and ring do to each other's sections where they meet",
            "eyes that are wider than the arms",
        )
        if not ring_gives:
            neglects = ("a ring that gives", "eyes that are wider than the arms")
    return _on_supports(component, 1, title, neglects, body, start, len(body.stiffness))


def solid_level(component: Component, solid: SolidComponent | None = None) -> LevelModel:
    """Level 3: the solid.

    Parameters
    ----------
    component : Component
        The component.
    solid : SolidComponent or None
        It, where it is solved already.
    """
    check_component_standing(component)
    start = time.perf_counter()
    found = solid_component(component) if solid is None else solid
    return _on_supports(component, 3, "solid", (), found.body, start, found.unknowns)


def _on_supports(
    component: Component,
    level: int,
    title: str,
    neglects: tuple[str, ...],
    body: Condensed,
    start: float,
    unknowns: int,
) -> LevelModel:
    found = supported(body, component.supports)
    n = len(body.names)
    columns = np.concatenate(
        [*(np.r_[body.rows(name)] for name in component.loaded), 6 * n + np.arange(3)]
    )
    reactions = {name: R[:, columns] for name, R in found.reactions.items()}
    cost = Cost(time.perf_counter() - start, unknowns)
    motions = found.motions[:, : 6 * n]
    return LevelModel(level, title, neglects, cost, reactions, body.names, motions)


def stiffness_on_supports(
    body: Condensed, supports: Mapping[str, Floats], at: Sequence[str]
) -> Floats:
    """(6 k, 6 k) stiffness of a condensed body on its supports at k points, the others free.

    Unlike the inverse of the compliance it is there, too, where the supports leave a motion free.

    Raises
    ------
    InputError
        A point is unknown, or held rigidly.
    """
    K, free = on_supports(body.names, body.stiffness, supports)
    follow = motions_on_supports(body, supports, at)[free]
    found = follow.T @ K @ follow
    return np.asarray(0.5 * (found + found.T))


def motions_on_supports(
    body: Condensed, supports: Mapping[str, Floats], at: Sequence[str]
) -> Floats:
    """Motions of all points of a condensed body on its supports where some move, the others free.

    Parameters
    ----------
    body : Condensed
        The body.
    supports : Mapping[str, Floats]
        (6, 6) stiffness to ground of points by name, inf on the diagonal where held rigidly.
    at : Sequence[str]
        The k points that are moved.

    Returns
    -------
    Floats
        (6 n, 6 k) for a unit motion of each.

    Raises
    ------
    InputError
        A point is unknown, or held rigidly.
    """
    K, free = on_supports(body.names, body.stiffness, supports)
    for name in at:
        if name not in body.names:
            raise InputError(f"point {name!r} is unknown: use {', '.join(body.names)}")
        if not np.isin(np.r_[body.rows(name)], free).all():
            raise InputError(f"point {name!r} is held rigidly: leave it out")
    wanted = np.concatenate([np.r_[body.rows(name)] for name in at])
    kept = np.searchsorted(free, wanted)
    left = np.setdiff1d(np.arange(len(free)), kept)
    motions = np.zeros((6 * len(body.names), len(kept)))
    motions[wanted] = np.eye(len(kept))
    if len(left):
        motions[free[left]] = -np.linalg.solve(K[np.ix_(left, left)], K[np.ix_(left, kept)])
    return motions


class GearboxSprings(NamedTuple):
    """What a suspended housing is to a shaft behind it: stiffness of the gearbox of a scene.

    Attributes
    ----------
    stiffness : tuple[float, ...]
        Six values along and about x, y, z at the ring's middle, each with the other motions held
        [N/m, N m/rad].
    left_out : dict[str, float]
        Couplings that six springs cannot have, as in "ux-rz", each over the root of the product of
        the two stiffnesses that it couples; those below `NAMED_FROM` are not named.
    """

    stiffness: tuple[float, ...]
    left_out: dict[str, float]


def gearbox_springs(ring: Floats) -> GearboxSprings:
    """Springs of a scene's gearbox from the stiffness at the ring's middle.

    Parameters
    ----------
    ring : Floats
        (6, 6), of `LevelModel.stiffness` at "ring" or of `stiffness_on_supports`.
    """
    share = scaled_to_unit_diagonal(ring)
    left_out = {
        f"{MOTIONS[i]}-{MOTIONS[j]}": float(share[i, j])
        for i in range(6)
        for j in range(i + 1, 6)
        if abs(share[i, j]) >= NAMED_FROM
    }
    return GearboxSprings(tuple(float(k) for k in np.diag(ring)), left_out)


@dataclass(frozen=True)
class PinMotions:
    """What the pins of a carrier do under a torque that all planets share equally.

    Attributes
    ----------
    wind_up : float
        Torque over the turn of the pins' middles about the axis, their way along the circle over
        its radius [N m/rad].
    tilt : float
        Turn of a pin about the radius through it, for 1 N m of torque [rad/(N m)]: what takes the
        planet's teeth out of line.
    """

    wind_up: float
    tilt: float


def pin_motions(component: CarrierComponent, model: LevelModel) -> PinMotions:
    """Wind-up and tilt of a carrier's pins at a level with stiffness, the mean of all pins."""
    carrier = component.planet_carrier
    radius, n = carrier.pin_circle_diameter / 2, carrier.planets
    at = [k for name in component.loaded for k in range(*_rows(model, name))]
    C = model.compliance[np.ix_(at, at)]
    along, about = torque_share(component) * n * radius, np.zeros(6 * n)
    for k, (_, y, z) in enumerate(carrier.pin_centres()):
        about[6 * k + 4 : 6 * k + 6] = np.array([y, z]) / radius
    moved = C @ torque_share(component)
    return PinMotions(float(1.0 / (along @ moved / (n * radius))), float(np.abs(about @ moved) / n))


def torque_share(component: CarrierComponent) -> Floats:
    """(6 n,) forces at the n pins, along their circle, that make a torque of 1 N m about x."""
    carrier = component.planet_carrier
    radius = carrier.pin_circle_diameter / 2
    forces = np.zeros((carrier.planets, 6))
    for k, (_, y, z) in enumerate(carrier.pin_centres()):
        forces[k, 1:3] = np.array([-z, y]) / (radius**2 * carrier.planets)
    return forces.ravel()


def _rows(model: LevelModel, name: str) -> tuple[int, int]:
    first = 6 * model.points.index(name)
    return first, first + 6


def frame_levels(component: Component) -> list[Callable[[], LevelModel]]:
    """What makes each level below the solid, from cheap to expensive."""
    levels = [lambda: rigid_level(component)]
    if isinstance(component, HousingComponent):
        levels.append(lambda: frame_level(component, ring_gives=False))
    levels.append(lambda: frame_level(component))
    return levels
