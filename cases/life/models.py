"""Models of a main bearing on its way to a life, cheap to expensive, on the same housing."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from fe_drivetrain.bearing import (
    Bearing,
    Races,
    equilibrium,
    laminae_of_contacts,
    roller_motions,
    three_degrees,
)
from fe_drivetrain.bearing_life.coupled import (
    LinearBody,
    body_on_races,
    coupled_equilibrium,
    factors_of,
    in_housings,
)
from fe_drivetrain.bearing_life.rings import RollerAssembly, assembly_equilibrium
from fe_drivetrain.cases.references.studied_lives import (
    HOUSING,
    Setup,
    by_chunks,
    on_rigid_rings,
    roller_rows,
)
from fe_drivetrain.cases.references.thesis_beam import BEAM, HOUSING_RADIAL
from fe_drivetrain.common import Floats
from fe_drivetrain.shafts.beam import pinned_model, torsional_spring_model

#: A bearing's five of the six motions of a point.
FIVE = np.array([0, 1, 2, 4, 5])

CATALOGUE = "catalogue load, pinned beam"
PINNED = "pinned beam"
SPRING = "torsional springs, K_R of the housing"
SERIES = "torsional springs, K_R of housing and rollers"
THREE = "the same K_R, bearing in three degrees"
RIGID = "five degrees, rigid housing"
STRAIGHT = "five degrees, housing in series, straight rollers"
FIVE_DEGREES = "five degrees, housing in series"
FLEXIBLE = "beam on flexible rings"
SOFTEST = "shaft and housing as solids, softest shapes"
SOLIDS = "shaft and housing as solids"

SOFT = "soft ground"

#: What the ground below the foot of the housing gives [m/N, rad/(N m)]; the soft one has the
#: thesis's K_R of 145 and 392 MN m/rad.
GROUNDS = {
    "fixed foot": np.zeros((5, 5)),
    SOFT: np.diag(1.0 / np.array([*[HOUSING_RADIAL] * 3, *HOUSING])),
}


@dataclass(frozen=True)
class World:
    """A bearing in its housing on a ground, with all that models of it take.

    Attributes
    ----------
    setup : Setup
        The bearing, with the beam in a rigid housing.
    races : Races
        What the housing gives at the rollers, on a fixed foot.
    solids : RollerAssembly or None
        Shaft and housing as solids, on a fixed foot.
    ground : Floats
        (5, 5) compliance below the foot, about the bearing's centre.
    """

    setup: Setup
    races: Races
    solids: RollerAssembly | None
    ground: Floats

    @property
    def housing(self) -> Floats:
        """(5, 5) compliance of the housing as rigid rings feel it, and of the ground.

        Races that move by A q as a rigid body take loads of A^T C^-1 A q: what is left of their
        softness when their shapes are held.
        """
        A, C = np.vstack(roller_motions(self.setup.bearing)), self.races.compliance
        return np.asarray(np.linalg.inv(A.T @ np.linalg.solve(C, A)) + self.ground)

    def body(self, compliance: Floats) -> LinearBody:
        """The beam with a compliance (5, 5) between the outer ring and what is rigid."""
        if not compliance.any():
            return self.setup.body
        K = np.diag(np.full(6, 1e12))
        K[np.ix_(FIVE, FIVE)] = np.linalg.inv(compliance)
        return in_housings(self.setup.body, {self.setup.body.bearings[0]: 0.5 * (K + K.T)})


def factors(hub: Floats) -> Floats:
    """Factors of hub loads (n, 6)."""
    return factors_of(hub, BEAM.gearbox_weight)


Laminae = Callable[[slice], list[Floats]]
Model = Callable[[World, Floats], Laminae]


def of_loads(bearing: Bearing, loads: Floats) -> Laminae:
    """Rollers in equilibrium with loads (n, 6) of a closed form."""
    found = equilibrium(bearing, loads[:, FIVE])
    return on_rigid_rings(bearing, found.displacements)


def pinned(world: World, hub: Floats) -> Laminae:
    """No moment at the bearing."""
    return of_loads(world.setup.bearing, pinned_model(hub, BEAM))


def spring_loads(stiffness: Floats, hub: Floats) -> Floats:
    """Bearing loads of the beam on K_R about y and z [N m/rad]."""
    beam = replace(BEAM, tilt_stiffness=float(stiffness[0]), yaw_stiffness=float(stiffness[1]))
    return torsional_spring_model(hub, beam)


def on_spring(world: World, hub: Floats) -> Laminae:
    """K_R of housing and ground."""
    K = 1.0 / np.diag(world.housing)[3:]
    return of_loads(world.setup.bearing, spring_loads(K, hub))


def fitted(world: World, hub: Floats) -> Floats:
    """K_R about y and z [N m/rad] of rollers and housing: slopes of moments over tilts of loads."""
    some = hub[:: max(1, len(hub) // 200)]
    compliance = world.housing
    deflections, forces = in_beam(world.setup.bearing, world.body(compliance), some)
    tilt, moment = (deflections + forces @ compliance)[:, 3:], forces[:, 3:]
    tilt, moment = tilt - tilt.mean(axis=0), moment - moment.mean(axis=0)
    slope = (moment * tilt).sum(axis=0) / (tilt**2).sum(axis=0)
    return np.asarray(np.maximum(slope, 0.0))


def on_both(world: World, hub: Floats) -> Laminae:
    """K_R of rollers and housing."""
    return of_loads(world.setup.bearing, spring_loads(fitted(world, hub), hub))


def in_three(world: World, hub: Floats) -> Laminae:
    """The thesis's reduction of the bearing."""
    bearing = world.setup.bearing
    loads = spring_loads(fitted(world, hub), hub)[:, FIVE]
    return on_rigid_rings(bearing, three_degrees(bearing, loads).displacements)


def in_beam(bearing: Bearing, body: LinearBody, hub: Floats) -> tuple[Floats, Floats]:
    """Deflections (n, 5) of the bearing in the beam, and loads on it."""
    found = coupled_equilibrium(body, {body.bearings[0]: bearing}, factors(hub))
    if not found.converged.all():
        raise RuntimeError("a load case of the beam has no equilibrium")
    return found.deflections[:, 0], found.forces[:, 0]


def rigid_housing(world: World, hub: Floats) -> Laminae:
    """Bearing and beam in equilibrium."""
    bearing = world.setup.bearing
    return on_rigid_rings(bearing, in_beam(bearing, world.body(np.zeros((5, 5))), hub)[0])


def housing_in_series(world: World, hub: Floats) -> Laminae:
    """The same, the outer ring moving as a rigid body."""
    bearing = world.setup.bearing
    return on_rigid_rings(bearing, in_beam(bearing, world.body(world.housing), hub)[0])


def straight_rollers(world: World, hub: Floats) -> Laminae:
    """The same without the rollers' profile."""
    bearing = world.setup.bearing.with_rows(crown=0.0)
    return on_rigid_rings(bearing, in_beam(bearing, world.body(world.housing), hub)[0])


def of_contacts(bearing: Bearing, deflections: Floats) -> Laminae:
    """Laminae of rollers at deflections (n, 2 total): approach of each, then its lean."""
    total = sum(bearing.counts)
    ends = np.cumsum([0, *bearing.counts])

    def laminae(part: slice) -> list[Floats]:
        z = deflections[part]
        return [
            laminae_of_contacts(row, z[:, a:b], z[:, total + a : total + b])
            for row, a, b in zip(roller_rows(bearing), ends[:-1], ends[1:], strict=True)
        ]

    return laminae


def on_contacts(
    bearing: Bearing, assembly: RollerAssembly, hub: Floats, shapes: int | None = None
) -> Laminae:
    """Rollers of an assembly, with its softest shapes or so many."""
    found = assembly_equilibrium(assembly, factors(hub), shapes=shapes)
    if not found.converged.all():
        raise RuntimeError("a load case of the assembly has no equilibrium")
    return of_contacts(bearing, found.deflections)


def flexible_rings(world: World, hub: Floats) -> Laminae:
    """Beam, and races that the housing's solid gives way to."""
    assembly = body_on_races(world.body(world.ground), world.races)
    return on_contacts(world.setup.bearing, assembly, hub)


def softest_shapes(world: World, hub: Floats) -> Laminae:
    """Solids of shaft, inner ring and housing, of whose shapes the stiffest are left out."""
    assert world.solids is not None
    return on_contacts(world.setup.bearing, on_ground(world.solids, world.ground), hub)


def solids(world: World, hub: Floats) -> Laminae:
    """Solids of shaft, inner ring and housing, with all shapes that the contacts feel."""
    assert world.solids is not None
    assembly = on_ground(world.solids, world.ground)
    return on_contacts(world.setup.bearing, assembly, hub, len(assembly.stiffness))


def on_ground(assembly: RollerAssembly, ground: Floats) -> RollerAssembly:
    """The same assembly with a compliance (5, 5) below its housing.

    Contact loads p move the housing as a rigid body by H A^T p, which widens each contact by
    A H A^T p: with D of these, S becomes S (I + D S)^-1, and G becomes (I + S D)^-1 G.
    """
    A = np.vstack(roller_motions(assembly.together))
    S, D = assembly.stiffness, A @ ground @ A.T
    whole = np.eye(len(S)) + S @ D
    series = np.linalg.solve(whole, S)
    return replace(
        assembly,
        stiffness=0.5 * (series + series.T),
        loads=np.asarray(np.linalg.solve(whole, assembly.loads)),
    )


#: Cheap to expensive; the catalogue load has no rollers.
MODELS: dict[str, Model] = {
    PINNED: pinned,
    SPRING: on_spring,
    SERIES: on_both,
    THREE: in_three,
    RIGID: rigid_housing,
    STRAIGHT: straight_rollers,
    FIVE_DEGREES: housing_in_series,
    FLEXIBLE: flexible_rings,
    SOFTEST: softest_shapes,
    SOLIDS: solids,
}


def lives(setup: Setup, count: int, laminae: Laminae) -> Floats:
    """L10r (count,) [million revolutions]."""
    return by_chunks(count, laminae, lambda q: {"L": setup.lives(q)})["L"]


def catalogue_lives(setup: Setup, hub: Floats) -> Floats:
    """L10 (n,) of the forces of a pinned beam, by X, Y and e."""
    P = setup.rated.equivalent_load(pinned_model(hub, BEAM)[:, FIVE])
    return np.asarray((setup.capacity / P) ** (10.0 / 3.0))
