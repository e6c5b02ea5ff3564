"""A bent and twisted tube assembled and solved in numbers of any length: 32, 64 and 80 bits."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse
from scipy.sparse.linalg import splu

from fe_drivetrain.common import InputError, Ints
from fe_drivetrain.drivetrain_file import MATERIALS
from fe_drivetrain.elasticity.mesh import element_kind, shaft_hexahedra
from fe_drivetrain.elasticity.solve import System, factorise, in_blocks
from fe_drivetrain.geometry import Section, Shaft

Real = NDArray[Any]

DIAMETER, BORE = 0.6, 0.3

_CHUNK = 64


@dataclass(frozen=True)
class Tube:
    """A tube fixed at one end, in hexahedra of 27 nodes.

    Attributes
    ----------
    points : NDArray[np.float32]
        (n, 3) [m], each coordinate a 32-bit number: the same solid in each precision.
    cells : Ints
        (n_cells, 27).
    free : Ints
        Degrees of freedom that are left.
    load : NDArray[np.float32]
        (n_free, 2) a force across and a moment about the axis, spread over the nodes of the end.
    """

    points: NDArray[np.float32]
    cells: Ints
    free: Ints
    load: NDArray[np.float32]


def tube(slenderness: float, turn: int = 8, along: int = 16) -> Tube:
    """A tube of a length over its diameter, and elements round and along it."""
    length = slenderness * DIAMETER
    shaft = Shaft(
        front=0.0,
        sections=(Section(length=length, outer_diameter=DIAMETER, inner_diameter=BORE),),
    )
    mesh = shaft_hexahedra(shaft, 1.001 * length / along, 27, elements_per_turn=turn)
    points = mesh.points.astype(np.float32)
    n = points.size
    fixed = (3 * mesh.front[:, None] + np.arange(3)).ravel()
    free = np.setdiff1d(np.arange(n), fixed)
    end = mesh.rear
    load = np.zeros((n, 2), dtype=np.float32)
    load[3 * end + 2, 0] = 1.0
    load[3 * end + 1, 1], load[3 * end + 2, 1] = -points[end, 2], points[end, 1]
    return Tube(points, mesh.cells, free, load[free])


def stiffness(solid: Tube, kind: type) -> tuple[NDArray[np.int64], NDArray[np.int64], Real]:
    """Rows, columns and values (not yet summed) of the stiffness, all of it in one precision.

    Parameters
    ----------
    solid : Tube
        The tube.
    kind : type
        ``numpy.float32``, ``numpy.float64`` or ``numpy.longdouble``.
    """
    lame = [kind(value) for value in MATERIALS["steel"].lame]
    table, weights = element_kind(27).table(4)
    gradients: Real = table.astype(kind)
    weights = weights.astype(kind)
    # The sum of the shape functions is one: to the last digit of this precision, too.
    gradients[:, :, -1] -= gradients.sum(axis=2)
    rows, columns, values = [], [], []
    identity: Real = np.eye(3, dtype=kind)
    for start in range(0, len(solid.cells), _CHUNK):
        cells = solid.cells[start : start + _CHUNK]
        x: Real = solid.points[cells].astype(kind)
        J = np.einsum("qkn,eni->eqik", gradients, x)
        a, b, c = J[..., 0], J[..., 1], J[..., 2]
        cofactors = np.stack([np.cross(b, c), np.cross(c, a), np.cross(a, b)], axis=-1)
        determinant = np.einsum("eqi,eqi->eq", a, cofactors[..., 0])
        physical = np.einsum("eqik,qkn->eqin", cofactors, gradients) / determinant[..., None, None]
        e, q, _, n = physical.shape
        flat = physical.transpose(0, 1, 3, 2).reshape(e, q, 3 * n)
        weighted = flat * (determinant * weights)[..., None]
        G = np.matmul(weighted.transpose(0, 2, 1), flat).reshape(e, n, 3, n, 3)
        trace = np.einsum("eambm->eab", G)
        K = lame[0] * G + lame[1] * G.transpose(0, 1, 4, 3, 2)
        K += lame[1] * trace[:, :, None, :, None] * identity[None, None, :, None, :]
        dofs = (3 * cells[:, :, None] + np.arange(3)).reshape(e, -1)
        rows.append(np.repeat(dofs, 3 * n, axis=1).ravel())
        columns.append(np.tile(dofs, (1, 3 * n)).ravel())
        values.append(K.reshape(e, -1).ravel())
    return np.concatenate(rows), np.concatenate(columns), np.concatenate(values)


def summed(solid: Tube, kind: type) -> sparse.csr_array:
    """Stiffness of the degrees of freedom that are left, in one precision."""
    rows, columns, values = stiffness(solid, kind)
    n = solid.points.size
    order = np.argsort(rows * n + columns, kind="stable")
    keys = (rows * n + columns)[order]
    first = np.flatnonzero(np.concatenate([[True], np.diff(keys) > 0]))
    sums = np.add.reduceat(values[order], first)
    i, j = np.divmod(keys[first], n)
    place = np.full(n, -1)
    place[solid.free] = np.arange(len(solid.free))
    kept = (place[i] >= 0) & (place[j] >= 0)
    size = len(solid.free)
    entries = (sums[kept], (place[i[kept]], place[j[kept]]))
    return sparse.csr_array(entries, shape=(size, size))


def compliances(solid: Tube, u: Real) -> Real:
    """(2,) work of each load on its own displacements."""
    return np.asarray((solid.load.astype(u.dtype) * u).sum(axis=0))


def solved(K: sparse.csr_array, F: Real) -> Real:
    """A direct solution in the precision of K and F, without refinement; NaN where it breaks."""
    try:
        factor = _factor(K)
        return np.asarray(factor.solve(F.astype(K.dtype)))
    except RuntimeError:
        return np.full(F.shape, np.nan, dtype=K.dtype)


def refined(K: sparse.csr_array, factored: sparse.csr_array, F: Real, steps: int) -> Real:
    """Solve K u = F in the precision of K by the factor of a rounder matrix, with refinement.

    Parameters
    ----------
    K : sparse.csr_array
        Residuals are taken with it.
    factored : sparse.csr_array
        Factorised, in its own precision.
    steps : int
        Of refinement.
    """
    try:
        factor = _factor(factored)
    except RuntimeError:
        return np.full(F.shape, np.nan, dtype=K.dtype)
    right = F.astype(K.dtype)
    u = np.zeros(F.shape, dtype=K.dtype)
    for _ in range(steps):
        residual = right - _product(K, u)
        # so small a residual would be none in a short number
        size = np.abs(residual).max()
        if size == 0.0:
            break
        scaled = (residual / size).astype(factored.dtype)
        u = u + factor.solve(scaled).astype(K.dtype) * size
    return u


def _product(K: sparse.csr_array, u: Real) -> Real:
    """K u for each column, summed in the precision of K."""
    out = np.empty_like(u)
    for column in range(u.shape[1]):
        out[:, column] = np.add.reduceat(K.data * u[K.indices, column], K.indptr[:-1])
    return out


def _factor(K: sparse.csr_array) -> Any:
    return splu(
        sparse.csc_array(K),
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )


def by_the_program(K: sparse.csr_array, F: Real) -> tuple[Real, float]:
    """The program's own direct solution of each column and its largest residual; NaN if refused."""
    n = K.shape[0]
    nowhere = np.zeros(n // 3, dtype=np.int64)
    solver = factorise(System(in_blocks(K), None, np.zeros((n, 6)), nowhere, n), "superlu")
    columns, residuals = [], []
    for column in F.T:
        try:
            found = solver.solve(column[:, None].astype(float))
        except InputError:
            columns.append(np.full(n, np.nan))
            continue
        columns.append(found.x[:, 0])
        residuals.append(found.diagnostics.residual)
    return np.column_stack(columns), max(residuals, default=float("nan"))
