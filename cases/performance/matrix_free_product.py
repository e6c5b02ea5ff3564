"""The product with the stiffness of ten-node tetrahedra without the matrix, element by element.

An element's displacements are gathered, their gradients taken at the points of the rule, turned
into stresses, and scattered back (Kronbichler and Kormann 2012, Computers and Fluids 63, 135-147:
for hexahedra, whose sums come apart by directions; those of tetrahedra do not). Eight elements go
side by side through a processor's vectors. What is read of an element is its nodes and its inverse
Jacobians: one of a straight element, one a point of a curved one.
"""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial

import numpy as np
from numba import get_num_threads, njit
from numpy.typing import NDArray

from fe_drivetrain.common import Floats, Ints
from fe_drivetrain.elasticity.mesh.shapes import element_kind
from fe_drivetrain.elasticity.operator import element_loops
from fe_drivetrain.elasticity.operator.slabs import slabs
from fe_drivetrain.elasticity.operator.vectors import LANES, load, plus, plus_each, store, zeros

#: Numbers of an element at a point: inverse Jacobian, and both of Lame's constants times volume.
_NUMBERS = 11


@dataclass(frozen=True)
class Packed:
    """Elements of one rule in packs of eight, which lie in parts that share no node.

    Attributes
    ----------
    rounds : tuple[Ints, ...]
        For each round, in which packs each part begins, and the last one ends.
    nodes : NDArray[np.int32]
        Nodes (n_packs, 10, 8).
    geometry : Floats
        Inverse Jacobians and constants (n_packs, 1 or n_q, 11, 8) [1/m, N m].
    gradients : Floats
        Reference gradients (n_q, 3, 10).
    """

    rounds: tuple[Ints, ...]
    nodes: NDArray[np.int32]
    geometry: Floats
    gradients: Floats

    @property
    def bytes(self) -> int:
        """Memory that a product reads, vectors aside."""
        return self.nodes.nbytes + self.geometry.nbytes


@dataclass(frozen=True)
class MatrixFree:
    """The stiffness of all elements, before any constraint."""

    packed: tuple[Packed, ...]

    @property
    def bytes(self) -> int:
        """Memory that a product reads, vectors aside."""
        return sum(some.bytes for some in self.packed)

    def product(self, x: Floats) -> Floats:
        """Forces (n,) of displacements (n,) [N]."""
        out = np.zeros_like(x)
        with ThreadPoolExecutor(get_num_threads()) as pool:
            for some in self.packed:
                for ends in some.rounds:
                    rooms = np.empty((len(ends) - 1, (2 * 30 + 9) * LANES))
                    parts = zip(ends[:-1].tolist(), ends[1:].tolist(), rooms, strict=True)
                    add = partial(
                        _add_product,
                        nodes=some.nodes,
                        geometry=some.geometry,
                        gradients=some.gradients,
                        x=x,
                        out=out,
                    )
                    for part in [pool.submit(add, *part) for part in parts]:
                        part.result()
        return out


def matrix_free(points: Floats, cells: Ints, lame: Floats) -> MatrixFree:
    """Pack the elements of a mesh.

    Parameters
    ----------
    points : Floats
        Node coordinates (n_nodes, 3) [m].
    cells : Ints
        Node numbers (n_cells, 10) in VTK's order.
    lame : Floats
        Lame's constants (n_cells, 2) of each element [Pa].
    """
    kind = element_kind(10)
    straight = element_loops.is_straight(points, cells)
    parts = slabs(points, cells[:, :4])
    packed = []
    for chosen, degree in ((straight, 2), (~straight, kind.degree)):
        if chosen.any():
            mine = [[part[chosen[part]] for part in some] for some in parts]
            packed.append(_packed(points, cells, lame, mine, kind.table(degree)))
    return MatrixFree(tuple(packed))


def _packed(
    points: Floats,
    cells: Ints,
    lame: Floats,
    parts: list[list[Ints]],
    rule: tuple[Floats, Floats],
) -> Packed:
    gradients, weights = rule
    filled, missing, rounds, packs = [], [], [], 0
    for some in parts:
        ends = [packs]
        for part in some:
            if len(part):
                rest = -len(part) % LANES
                filled.append(np.append(part, np.repeat(part[-1:], rest)))
                missing.append(np.repeat([1.0, 0.0], [len(part), rest]))
                packs += len(filled[-1]) // LANES
                ends.append(packs)
        rounds.append(np.array(ends))
    order, there = np.concatenate(filled), np.concatenate(missing)
    # a straight element is the same at every point of a rule with equal weights
    at = gradients[:1] if np.ptp(weights) < 1e-15 else gradients
    mine = cells[order]
    J = np.einsum("eni,qpn->eqip", points[mine], at)
    inverse = np.linalg.inv(J).swapaxes(2, 3)
    size = np.abs(np.linalg.det(J)) * weights[: len(at)] * there[:, None]
    constants = size[..., None] * lame[order][:, None]
    numbers = np.concatenate([inverse.reshape(len(order), len(at), 9), constants], axis=2)
    return Packed(
        tuple(rounds),
        np.ascontiguousarray(mine.reshape(packs, LANES, 10).swapaxes(1, 2), dtype=np.int32),
        np.ascontiguousarray(numbers.reshape(packs, LANES, -1, _NUMBERS).transpose(0, 2, 3, 1)),
        gradients,
    )


@njit(cache=True, nogil=True, fastmath=True)
def _add_product(
    first: int,
    end: int,
    room: Floats,
    nodes: NDArray[np.int32],
    geometry: Floats,
    gradients: Floats,
    x: Floats,
    out: Floats,
) -> None:
    """Add what the packs of one part do."""
    n_q, _, k = gradients.shape
    n_at = geometry.shape[1]
    numbers = geometry.reshape(-1)
    U, F, H = room[: 30 * LANES], room[30 * LANES : 60 * LANES], room[60 * LANES :]
    for pack in range(first, end):
        for a in range(k):
            for lane in range(LANES):
                node = 3 * np.int64(nodes[pack, a, lane])
                for i in range(3):
                    U[(3 * a + i) * LANES + lane] = x[node + i]
                    F[(3 * a + i) * LANES + lane] = 0.0
        for q in range(n_q):
            at = (pack * n_at + min(q, n_at - 1)) * _NUMBERS * LANES
            _put_gradients(gradients[q], U, numbers, at, H)
            _add_forces(gradients[q], H, numbers, at, F)
        for a in range(k):
            for lane in range(LANES):
                node = 3 * np.int64(nodes[pack, a, lane])
                for i in range(3):
                    out[node + i] += F[(3 * a + i) * LANES + lane]


@njit(inline="always")
def _put_gradients(gradients: Floats, U: Floats, numbers: Floats, at: int, H: Floats) -> None:
    """Gradients of the displacements at a point, component by component, into H."""
    for i in range(3):
        f = g = h = zeros()
        for a in range(gradients.shape[1]):
            u = load(U, (3 * a + i) * LANES)
            f = plus(f, gradients[0, a], u)
            g = plus(g, gradients[1, a], u)
            h = plus(h, gradients[2, a], u)
        for j in range(3):
            row = at + 3 * j * LANES
            value = plus_each(zeros(), load(numbers, row), f)
            value = plus_each(value, load(numbers, row + LANES), g)
            value = plus_each(value, load(numbers, row + 2 * LANES), h)
            store(value, H, (3 * i + j) * LANES)


@njit(inline="always")
def _add_forces(gradients: Floats, H: Floats, numbers: Floats, at: int, F: Floats) -> None:
    """Add to F what the stresses at a point do to the nodes."""
    lam, mu = load(numbers, at + 9 * LANES), load(numbers, at + 10 * LANES)
    trace = plus(plus(load(H, 0), 1.0, load(H, 4 * LANES)), 1.0, load(H, 8 * LANES))
    pressure = plus_each(zeros(), lam, trace)
    for i in range(3):
        f = g = h = zeros()
        for j in range(3):
            both = plus(load(H, (3 * i + j) * LANES), 1.0, load(H, (3 * j + i) * LANES))
            stress = plus_each(zeros(), mu, both)
            if i == j:
                stress = plus(stress, 1.0, pressure)
            row = at + 3 * j * LANES
            f = plus_each(f, load(numbers, row), stress)
            g = plus_each(g, load(numbers, row + LANES), stress)
            h = plus_each(h, load(numbers, row + 2 * LANES), stress)
        for a in range(gradients.shape[1]):
            r = load(F, (3 * a + i) * LANES)
            r = plus(r, gradients[0, a], f)
            r = plus(r, gradients[1, a], g)
            r = plus(r, gradients[2, a], h)
            store(r, F, (3 * a + i) * LANES)
