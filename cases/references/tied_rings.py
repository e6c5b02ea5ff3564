"""Two rings, one in the other, tied on the cylinder between them at any ratio of elements round."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace

import numpy as np
from scipy import sparse
from scipy.spatial import cKDTree
from skfem.quadrature import get_quadrature

from fe_drivetrain.cases.references import two_bodies
from fe_drivetrain.common import Floats, InputError, rigid_motions
from fe_drivetrain.elasticity.interfaces import (
    Constraint,
    dofs,
    held_dofs,
    mortar_tie,
    node_tie,
    settled,
)
from fe_drivetrain.elasticity.mesh import Block, brick, element_kind, joined, shape_functions
from fe_drivetrain.elasticity.operator import stresses, tensor

BORE, TIED, OUTSIDE = 0.5, 1.0, 1.5  # m: radii
WIDTH = 0.2  # m
E, NU = 210e9, 0.3
G = E / (2.0 * (1.0 + NU))
LAME = (E * NU / ((1.0 + NU) * (1.0 - 2.0 * NU)), G)
TIES = ("standard", "dual", "node by node")


@dataclass(frozen=True)
class Twisted:
    """Both rings under torsion: the bore held, the outside turned.

    Attributes
    ----------
    stiffness : float
        By energy, over the exact one.
    unbalanced : float
        Torque at the bore less that at the outside, over the exact one: what the tie loses.
    stress : float
        Root mean square error of the stress in the outer ring, over the exact shear stress on the
        tied cylinder.
    """

    stiffness: float
    unbalanced: float
    stress: float


@dataclass(frozen=True)
class Tie:
    """Two rings and their tie, or why there is none.

    Attributes
    ----------
    bodies : two_bodies.Bodies
        Inner ring, the slave, and outer ring.
    tie : Constraint or None
        The constraint; None where it was refused.
    messages : tuple[str, ...]
        Warnings, or the refusal.
    """

    bodies: two_bodies.Bodies
    tie: Constraint | None
    messages: tuple[str, ...]

    def settled(self) -> Tie:
        """The same with slave nodes moved to where the tie sees the master."""
        assert self.tie is not None
        points = settled(self.bodies.points, self.tie)
        return Tie(replace(self.bodies, points=points), self.tie, self.messages)


def stiffness(width: float = WIDTH) -> float:
    """Exact: tau = T / (2 pi r^2 b), so T / theta = 4 pi G b / (1/r0^2 - 1/r2^2) [N m/rad].

    Parameters
    ----------
    width : float
        b, along the axis [m].
    """
    return float(4.0 * np.pi * G * width / (1.0 / BORE**2 - 1.0 / OUTSIDE**2))


def ring(
    inner: float,
    outer: float,
    turn: int,
    nodes: int,
    twist: float = 0.0,
    layers: tuple[int, int] = (1, 1),
    width: float = WIDTH,
) -> Block:
    """A closed ring, its axis on x.

    Parameters
    ----------
    inner, outer : float
        Radii [m].
    turn : int
        Elements round.
    nodes : int
        Number of nodes of an element.
    twist : float
        Share of a turn that the mesh is turned by.
    layers : tuple of int
        Elements across and along.
    width : float
        Along the axis [m].
    """

    def shape(x: Floats) -> Floats:
        r = inner + x[:, 0] * (outer - inner)
        angle = 2.0 * np.pi * (x[:, 1] + twist)
        return np.column_stack([width * x[:, 2], r * np.cos(angle), r * np.sin(angle)])

    across, along = layers
    return joined(brick((across, turn, along), nodes, shape))


def tied(own: int, other: int, kind: str, nodes: int = 10) -> Tie:
    """Tie rings of so many elements round; the inner one is the slave."""
    bodies = two_bodies.together(
        ring(BORE, TIED, own, nodes), ring(TIED, OUTSIDE, other, nodes, 0.3 / other)
    )
    faces = bodies.faces[0]["x1"], bodies.faces[1]["x0"]
    n = bodies.points.size
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            if kind == "node by node":
                tie = node_tie("tie", bodies.points, *faces, n)
            else:
                tie = mortar_tie(
                    "tie", bodies.points, *faces, n, "dual" if kind == "dual" else "standard"
                )
        except InputError as refusal:
            return Tie(bodies, None, (str(refusal),))
    return Tie(bodies, tie, tuple(str(w.message) for w in caught))


def shared(turn: int, nodes: int = 10) -> Twisted:
    """Rings that share their nodes, which is what a tie is compared with."""
    rings = two_bodies.together(ring(BORE, TIED, turn, nodes), ring(TIED, OUTSIDE, turn, nodes))
    match = cKDTree(rings.points).query_pairs(1e-9, output_type="ndarray")
    low, high = match.T
    rows = np.concatenate([dofs(low), dofs(high)], axis=0).reshape(2, -1)
    k = np.arange(rows.shape[1])
    C = sparse.csr_array(
        (np.repeat([1.0, -1.0], len(k)), (np.tile(k, 2), rows.ravel())),
        shape=(len(k), rings.points.size),
    )
    return twist(Tie(rings, Constraint("tie", C, rows[0]), ()))


def twist(tied: Tie) -> Twisted:
    """Turn the outside by one radian, the bore held."""
    assert tied.tie is not None
    bodies, points, n = tied.bodies, tied.bodies.points, tied.bodies.points.size
    bore, outside = np.unique(bodies.faces[0]["x0"]), np.unique(bodies.faces[1]["x1"])
    supports = [
        held_dofs("bore", dofs(bore).ravel(), n),
        held_dofs("outside", dofs(outside).ravel(), n),
    ]
    turned = rigid_motions(points[outside])[:, [3]]
    K = bodies.stiffness(LAME)
    solved = two_bodies.solve(K, [tied.tie, *supports], np.zeros((n, 1)), {"outside": turned})
    about_x = rigid_motions(points)[:, 3]
    torques = [float(about_x @ solved.carried(name)[:, 0]) for name in ("bore", "outside")]
    u = solved.u[:, 0]
    exact = stiffness()
    return Twisted(
        float(u @ (K @ u)) / exact, abs(sum(torques)) / exact, _stress_error(bodies, u, exact)
    )


def _stress_error(bodies: two_bodies.Bodies, u: Floats, torque: float) -> float:
    cells = bodies.cells[1]
    kind = element_kind(cells.shape[1])
    at = get_quadrature(kind.element.refdom, 3)[0]
    values, _ = shape_functions(kind.element, at)
    found = tensor(stresses(bodies.points, cells, u, LAME, at))
    x = np.einsum("qn,eni->eqi", values, bodies.points[cells])
    r = np.hypot(x[..., 1], x[..., 2])
    radial = np.stack([0.0 * r, x[..., 1] / r, x[..., 2] / r], axis=-1)
    round_ = np.stack([0.0 * r, -x[..., 2] / r, x[..., 1] / r], axis=-1)
    tau = torque / (2.0 * np.pi * r**2 * WIDTH)
    pairs = radial[..., :, None] * round_[..., None, :]
    exact = tau[..., None, None] * (pairs + np.swapaxes(pairs, -1, -2))
    scale = torque / (2.0 * np.pi * TIED**2 * WIDTH)
    return float(np.sqrt(np.mean((found - exact) ** 2) * 9.0) / scale)
