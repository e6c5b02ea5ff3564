"""A ring held outside whose bore is tilted on a band of it, coupled in three ways.

The band is the loaded patch of a bearing's seat. Coupled rigidly it moves as a rigid body; sliding,
only its displacement along the normal is that of one; averaged, only its mean rotation is given,
and the traction is what the average prescribes: w x r over its own second moment.

Displacements that fulfil the rigid coupling fulfil both others too, so it gives the largest tilt
stiffness of the three. Of all fields of one mean rotation the averaged coupling has the least
energy. Sliding and averaged are not nested: neither bounds the other.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import sparse

from fe_drivetrain.common import Floats, Ints
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.elasticity.interfaces import constraints
from fe_drivetrain.elasticity.mesh import (
    MEANS,
    Hexahedra,
    face_weights,
    local_facets,
    shaft_hexahedra,
)
from fe_drivetrain.elasticity.revolution import (
    dofs,
    harmonic_response,
    meridian,
    surface_loads,
    turn,
)
from fe_drivetrain.elasticity.solve import solve_solid
from fe_drivetrain.geometry import Section, Shaft

BORE, OUTSIDE, LENGTH = 0.3, 0.45, 0.3  # m: radii, and length along the axis
IRON = Material(youngs_modulus=169e9, poisson_ratio=0.275, density=7100.0)
COUPLINGS = ("rigid", "averaged", "sliding")

_SAME = 1e-9  # m


@dataclass(frozen=True)
class Tilted:
    """Strain energy and mean rotation of the band under its load.

    Attributes
    ----------
    moment : float
        On the band [N m].
    mean : float
        Its mean rotation, int m . u dA / int m . m dA with m = w x r of unit rotation w [rad].
    energy : float
        Strain energy [J].
    """

    moment: float
    mean: float
    energy: float

    @property
    def stiffness(self) -> float:
        """M^2 / 2U: moment over the rotation that it does work on [N m/rad]."""
        return self.moment**2 / (2.0 * self.energy)

    @property
    def of_mean(self) -> float:
        """2U / theta^2 with the mean rotation [N m/rad]: at least that of the averaged coupling."""
        return 2.0 * self.energy / self.mean**2


def ring_of(width: float, length: float = LENGTH) -> Shaft:
    """The ring with edges of elements at both ends of the band, which is in its middle."""
    side = 0.5 * (length - width)
    pieces = [width] if side < _SAME else [side, width, side]
    sections = tuple(
        Section(length=piece, outer_diameter=2 * OUTSIDE, inner_diameter=2 * BORE)
        for piece in pieces
    )
    return Shaft(front=-0.5 * length, sections=sections)


def tilted(width: float, size: float, order: int = 6, length: float = LENGTH) -> dict[str, Tilted]:
    """The three couplings in the first harmonic: exact round the turn.

    Parameters
    ----------
    width : float
        Of the band [m].
    size : float
        Largest edge of an element [m].
    order : int
        Of the elements.
    length : float
        Of the ring [m].
    """
    mesh = meridian(ring_of(width, length), size, order=order, layers=0)

    def on_band(x: Floats, r: Floats) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
        return np.asarray((np.abs(r - BORE) < _SAME) & (np.abs(x) < 0.5 * width + _SAME))

    band = mesh.where(on_band)
    outer = mesh.where(lambda x, r: np.abs(r - OUTSIDE) < _SAME)
    clamp = np.concatenate([dofs(outer, k) for k in range(3)])
    still = np.zeros(len(clamp))
    x = mesh.nodes[band, 0]
    # Rotation about z: u_x = -r cos, u_y = x.
    rigid = np.column_stack([np.full(len(band), -BORE), x, -x])
    second = turn(1) * BORE * (BORE**2 * width + 2.0 * width**3 / 12.0)

    def traction(at: Floats, _: Floats) -> Floats:
        return np.column_stack([-at[:, 1], at[:, 0], -at[:, 0]]) / second

    load = surface_loads(mesh, 1, mesh.sides(on_band), traction)
    found = {}
    averaged = harmonic_response(mesh, IRON, 1, load, (clamp, still))
    energy = float(averaged.energy[0])
    found["averaged"] = Tilted(1.0, 2.0 * energy, energy)
    for name, components in (("rigid", (0, 1, 2)), ("sliding", (1,))):
        which = np.concatenate([dofs(band, k) for k in components])
        values = np.concatenate([rigid[:, k] for k in components])
        response = harmonic_response(
            mesh,
            IRON,
            1,
            held=(np.concatenate([clamp, which]), np.concatenate([still, values])),
        )
        energy = float(response.energy[0])
        mean = float(load @ response.u[..., 0].ravel())
        found[name] = Tilted(2.0 * energy, mean, energy)
    return found


def tilted_solid(width: float, size: float, turn_elements: int) -> dict[str, Tilted]:
    """The same with the couplings of the library, in hexahedra of 27 nodes.

    Parameters
    ----------
    width, size : float
        As for `tilted`.
    turn_elements : int
        Elements round the axis.
    """
    mesh = shaft_hexahedra(ring_of(width), size, 27, elements_per_turn=turn_elements)
    facets, nodes, outer = _band(mesh, width)
    n = len(mesh.points)
    centre = np.zeros(3)
    found = {}
    for name in COUPLINGS:
        total = 3 * n + 6 * (name != "averaged")
        held = [constraints.fixed("outside", outer, total)]
        weights = face_weights(mesh.points, facets, n, MEANS)[nodes]
        mean = constraints.averaged_point("mean", nodes, weights, mesh.points, centre, total)
        if name == "averaged":
            point = mean
        else:
            point = constraints.rigid_point("band", centre, 3 * n, total)
            held.append(
                constraints.rigid_face("band", nodes, mesh.points, point)
                if name == "rigid"
                else sliding_face("band", nodes, mesh.points, point)
            )
            # tilt alone: what else the point can do is held
            held.append(constraints.held("other motions", point, (0, 1, 2, 3, 4)))
        load = np.asarray(point.motion[[5]].toarray())[0]
        static = solve_solid(mesh.points, mesh.cells, IRON.lame, held, load)
        energy = float(static.energy[0])
        found[name] = Tilted(1.0, float((mean.motion @ static.u)[5, 0]), energy)
    return found


def sliding_face(
    name: str, nodes: Ints, points: Floats, point: constraints.ReferencePoint
) -> constraints.Constraint:
    """The nodes of a cylinder about x move along its normal as a rigid body does."""
    normal = points[nodes] * [0.0, 1.0, 1.0]
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    rigid = constraints.rigid_face(name, nodes, points, point)
    along = sparse.csr_array(
        (
            normal.ravel(),
            (np.repeat(np.arange(len(nodes)), 3), np.arange(3 * len(nodes))),
        )
    )
    largest = np.argmax(np.abs(normal), axis=1)
    return constraints.Constraint(name, (along @ rigid.rows).tocsr(), 3 * nodes + largest)


def _band(mesh: Hexahedra, width: float) -> tuple[Ints, Ints, Ints]:
    """Facets and nodes of the band, and nodes of the outside."""
    facets = np.asarray(mesh.cells[:, local_facets(27)]).reshape(-1, 9)
    at = mesh.points[facets]
    r = np.hypot(at[..., 1], at[..., 2])
    inside = (np.abs(r - BORE) < _SAME) & (np.abs(at[..., 0]) < 0.5 * width + _SAME)
    chosen = facets[inside.all(axis=1)]
    outer = np.flatnonzero(np.abs(np.hypot(mesh.points[:, 1], mesh.points[:, 2]) - OUTSIDE) < _SAME)
    return chosen, np.unique(chosen), outer


def smooth_strip(width: float) -> float:
    """Tilt stiffness of a narrow sliding band as a smooth rigid strip on a half plane [N m/rad].

    The strip of half width b rocks with pi E b^2 / (4 (1 - nu^2)) a length (Johnson 1985, Contact
    Mechanics, section 2.8); round the bore a tilt rocks it with the cosine of the angle.
    """
    plane = IRON.youngs_modulus / (1.0 - IRON.poisson_ratio**2)
    return float(np.pi * BORE * np.pi * plane * (0.5 * width) ** 2 / 4.0)
