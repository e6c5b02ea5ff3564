"""Error of a stiffness, estimated on one mesh: energy of the error by recovery.

A displacement model under given forces stores too little energy, by exactly the energy of its
error: for one load F with its displacement or rotation d, the compliance d / F is too low and the
stiffness F / d too high by that share. The error's energy is estimated by comparing the stresses of
the elements with smoother ones that are recovered from them (Zienkiewicz and Zhu 1987, Int. J.
Numer. Meth. Eng. 24, 337-357): round each corner a polynomial is fitted to the elements' stresses
at the points where these are best (1992, ibid. 33, 1331-1364), and inside an element those of its
corners are blended by the linear shape functions. The polynomials are constant for linear elements,
linear for tetrahedra of ten nodes, quadratic for hexahedra of twenty and more: what the
elements' own stresses are good for. One degree more, as is usual, comes nearer where all is smooth,
and measured on shafts finds only a quarter of the error where stress is singular at a held edge.

Parts are recovered each for itself, since stresses jump where materials meet. The estimate knows
the mesh alone, not the shape that was meshed: what curved surfaces lose to the mesh is none of it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy import sparse
from skfem.quadrature import get_quadrature

from fe_drivetrain.common.arrays import CHUNK, Floats, Ints, chunks
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.elasticity.mesh.mapping import jacobian
from fe_drivetrain.elasticity.mesh.numbering import check_nodes
from fe_drivetrain.elasticity.mesh.shapes import ElementKind, element_kind
from fe_drivetrain.elasticity.operator.stress import stresses_of_fields

Lame = tuple[float, float]

#: Factor on the estimate for a band: measured on exact cases, it is above a third of the error.
SAFETY = 3.0
#: Degree of the polynomials, by the number of nodes of the elements.
_DEGREE = {4: 0, 8: 0, 10: 1, 20: 2, 27: 2}
# Weights, relative to the number of points, that hold the terms of degree 2 near zero where a patch
# has too few points for them, and far below what others decide. Mixed terms count half, so that it
# is the sum of squares of a symmetric matrix that is held: the same in any frame.
_HELD = np.repeat([0.0, 0.0, 1e-7, 0.5e-7], (1, 3, 3, 3))


@dataclass(frozen=True)
class ErrorEstimate:
    """Energy of the error of a finite-element solution, estimated from this alone.

    Attributes
    ----------
    energy : float
        Strain energy of the solution [J].
    indicators : Floats
        (n_cells,) estimated energy of the error in each cell, in the order of the parts' cells [J].
    """

    energy: float
    indicators: Floats

    __repr__ = short_repr

    @property
    def error_energy(self) -> float:
        """Estimated energy of the error, that is, of what the solution is short of [J]."""
        return float(self.indicators.sum())

    @property
    def relative(self) -> float:
        """Estimated relative error of the stiffness, which is too high."""
        return self.error_energy / self.energy

    def improved(self, stiffness: float) -> float:
        """The stiffness with the estimated error taken out."""
        return stiffness / (1.0 + self.relative)

    def band(self, stiffness: float, safety: float = SAFETY) -> float:
        """Half width of the band of a computed stiffness, in its unit."""
        return safety * self.relative * abs(stiffness)


def recovery_estimate(
    points: Floats, parts: Sequence[tuple[Ints, Lame]], u: Floats
) -> ErrorEstimate:
    """Estimate the error of a solution from the jumps that its stresses make.

    Parameters
    ----------
    points : Floats
        Node coordinates (n, 3) [m].
    parts : Sequence[tuple[Ints, Lame]]
        Cells (n_cells, k) of each part in VTK's order, and its Lame's constants [Pa].
    u : Floats
        Displacements (3 n,) or longer [m]: under given forces, or with given displacements, where
        the energy is too high by that of the error; not with both.
    """
    energy, indicators = 0.0, []
    for cells, lame in parts:
        for stored, error in _energies(points, np.asarray(cells), lame, u):
            energy += float(stored.sum())
            indicators.append(error)
    return ErrorEstimate(energy, np.concatenate(indicators))


def error_energies(points: Floats, parts: Sequence[tuple[Ints, Lame]], fields: Floats) -> Floats:
    """Estimated energies of the errors of several solutions on one mesh, recovered together.

    Parameters
    ----------
    points, parts : Floats, Sequence[tuple[Ints, Lame]]
        See `recovery_estimate`.
    fields : Floats
        Displacements (3 n, m) or longer [m].

    Returns
    -------
    Floats
        Error energy (m,) of each field, see `ErrorEstimate.error_energy` [J].
    """
    total = np.zeros(fields.shape[1])
    for cells, lame in parts:
        for volumes, _, error in _errors(points, np.asarray(cells), lame, fields[: points.size]):
            total += np.einsum("eq,eqm->m", volumes, energy_density(error, lame))
    return total


@dataclass(frozen=True)
class RecoveredWork:
    """Work of the errors of solutions on each other, estimated cell by cell.

    Attributes
    ----------
    by_part : Floats
        Sums over the cells of each part (n_parts, a, b): works of either sign cancel [J].
    scatter : Floats
        Standard deviation (a, b) of the sums in a mesh that has no order [J].
    sizes : Floats
        Sums of the sizes (a, b): no works cancel [J].
    """

    by_part: Floats
    scatter: Floats
    sizes: Floats

    @property
    def signed(self) -> Floats:
        """Sums over all cells (a, b) [J]."""
        return np.asarray(self.by_part.sum(axis=0))

    @property
    def estimate(self) -> Floats:
        """Sums of the parts by their sizes, and the scatter, with the sign of the whole sum [J].

        At most the sums of the sizes of all works. The share of the error that is found differs
        from part to part, with their elements and edges: sums of parts are not relied upon to
        cancel.
        """
        size = np.minimum(np.abs(self.by_part).sum(axis=0) + self.scatter, self.sizes)
        return np.asarray(np.copysign(size, self.signed))


def recovered_work(
    points: Floats, parts: Sequence[tuple[Ints, Lame]], first: Floats, second: Floats
) -> RecoveredWork:
    """Estimate the work of the errors of solutions on each other, cell by cell with its sign.

    What a linear functional of a solution is short of is the work of the stresses of its error on
    the strains of the error of the functional's own solution, its influence function (Becker and
    Rannacher 2001, Acta Numerica 10, 1-102). Works of either sign cancel from cell to cell, by
    symmetry for instance, as far as the mesh has it, too. What remains where it has not is their
    scatter. Errors of cells that share a corner are correlated, since their stresses are recovered
    from the same patches; the variance of the sum is estimated from products of their works,
    weighted by the share of the corners that they have in common (Conley 1999, J. Econometrics 92,
    1-45). That is the squared sum of the works round each corner, over the number of corners of a
    cell. Of fields without any order it finds 0.7 of the spread; `SAFETY` has more room than that.

    Parameters
    ----------
    points, parts : Floats, Sequence[tuple[Ints, Lame]]
        See `recovery_estimate`.
    first, second : Floats
        Displacements of solutions, (3 n, a) and (3 n, b) or longer [m].

    Returns
    -------
    RecoveredWork
        Works (a, b) [J].
    """
    fields = [first[: points.size]]
    if second is not first:
        fields.append(second[: points.size])
    columns, shape = np.hstack(fields), (first.shape[1], second.shape[1])
    by_part, (squares, sizes) = np.zeros((len(parts), *shape)), np.zeros((2, *shape))
    for signed, (cells, lame) in zip(by_part, parts, strict=True):
        corners = cells[:, : element_kind(cells.shape[1]).n_corners]
        nodes, patch = np.unique(corners, return_inverse=True)
        patch, done = patch.reshape(corners.shape), 0
        round_corners = np.zeros((len(nodes), shape[0] * shape[1]))
        for volumes, _, d in _errors(points, cells, lame, columns):
            works = _works(volumes, d[:, :, : shape[0]], d[:, :, -shape[1] :], lame)
            signed += works.sum(axis=0)
            sizes += np.abs(works).sum(axis=0)
            _gather(round_corners, patch[done : done + len(works)], works)
            done += len(works)
        squares += (round_corners**2).sum(axis=0).reshape(shape) / corners.shape[1]
    return RecoveredWork(by_part, np.sqrt(squares), sizes)


def _works(volumes: Floats, acting: Floats, moved: Floats, lame: Lame) -> Floats:
    """Works (n_cells, a, b) of stresses (n_cells, n_q, a, 6) on the strains of others, b."""
    lam, mu = lame
    strains = moved * np.repeat([1.0, 2.0], 3)
    shrunk = lam / (3.0 * lam + 2.0 * mu) * moved[..., :3].sum(axis=-1)
    strains[..., :3] -= shrunk[..., None]
    strains *= volumes[..., None, None] / (2.0 * mu)
    n, n_q = volumes.shape
    left = np.moveaxis(acting, 2, 1).reshape(n, -1, n_q * 6)
    right = np.swapaxes(strains, 2, 3).reshape(n, n_q * 6, -1)
    return np.asarray(left @ right)


def _gather(total: Floats, patch: Ints, works: Floats) -> None:
    """Add works (n_cells, a, b) to those (n_patches, a b) round each of the cells' corners."""
    met, number = np.unique(patch, return_inverse=True)
    cell = np.repeat(np.arange(len(patch)), patch.shape[1])
    onto = sparse.csr_array(
        (np.ones(patch.size), (number.ravel(), cell)), shape=(len(met), len(patch))
    )
    total[met] += onto @ works.reshape(len(works), -1)


def _energies(
    points: Floats, cells: Ints, lame: Lame, u: Floats
) -> Iterator[tuple[Floats, Floats]]:
    """Energies (n_cells,) of stresses and of their difference from recovered ones, in chunks."""
    for volumes, s, error in _errors(points, cells, lame, u[: points.size, None]):
        yield (
            np.einsum("eq,eq->e", volumes, energy_density(s[:, :, 0], lame)),
            np.einsum("eq,eq->e", volumes, energy_density(error[:, :, 0], lame)),
        )


def _errors(
    points: Floats, cells: Ints, lame: Lame, fields: Floats
) -> Iterator[tuple[Floats, Floats, Floats]]:
    """Volumes (n_cells, n_q), stresses (n_cells, n_q, m, 6), and these less recovered ones.

    Fields u are m columns (3 n, m); values come in chunks of cells.
    """
    check_nodes(cells, len(points))
    kind = element_kind(cells.shape[1])
    patches = _Patches(points, cells, kind)
    columns = np.ascontiguousarray(fields.reshape(-1, 3, fields.shape[1]).swapaxes(1, 2))
    m = columns.shape[1]
    coefficients = patches.fit(points, cells, lame, columns)
    at, weights = get_quadrature(kind.element.refdom, 4 if kind.n_corners == 4 else 5)
    blend, _ = element_kind(kind.n_corners).shape(at)
    values, gradients = kind.shape(at)
    for rows in chunks(len(cells), max(CHUNK // (2 * m), 1)):
        physical, determinant = jacobian(points, cells[rows], gradients)
        s = stresses_of_fields(physical, columns[cells[rows]], lame)
        # (n_cells, n_q, corners and terms) onto (n_cells, corners and terms, fields and stresses)
        terms = patches.terms(rows, values @ points[cells[rows]]) * blend.T[:, :, None]
        n, corners, n_q, n_terms = terms.shape
        onto = np.moveaxis(terms, 1, 2).reshape(n, n_q, corners * n_terms)
        of = coefficients[patches.local[rows]].reshape(n, corners * n_terms, -1)
        yield np.abs(determinant) * weights, s, s - (onto @ of).reshape(s.shape)


def energy_density(s: Floats, lame: Lame) -> Floats:
    """Strain energy per volume of stresses (..., 6), ordered as `components.STRESSES` [J/m^3]."""
    lam, mu = lame
    squares = (s[..., :3] ** 2).sum(axis=-1) + 2.0 * (s[..., 3:] ** 2).sum(axis=-1)
    trace = s[..., :3].sum(axis=-1)
    return np.asarray((squares - lam / (3.0 * lam + 2.0 * mu) * trace**2) / (4.0 * mu))


class _Patches:
    """The cells round each corner, and polynomials in coordinates about it.

    Attributes
    ----------
    local : Ints
        (n_cells, n_corners) number of each corner's patch.
    """

    def __init__(self, points: Floats, cells: Ints, kind: ElementKind) -> None:
        corners = cells[:, : kind.n_corners]
        nodes, local = np.unique(corners, return_inverse=True)
        self.local: Ints = local.reshape(corners.shape)
        self._centre = points[nodes]
        self._kind = kind
        self._degree = _DEGREE[cells.shape[1]]
        place = points[corners]
        across = np.linalg.norm(place - place.mean(axis=1, keepdims=True), axis=2).max(axis=1)
        self._reach = np.zeros(len(nodes))
        np.maximum.at(self._reach, self.local, 2.0 * across[:, None])

    def terms(self, rows: slice, positions: Floats) -> Floats:
        """Monomials (n_cells, n_corners, n_q, n_terms) of positions (n_cells, n_q, 3)."""
        patch = self.local[rows]
        d = positions[:, None] - self._centre[patch][:, :, None]
        x, y, z = np.moveaxis(d / self._reach[patch][:, :, None, None], -1, 0)
        found = [np.ones_like(x)]
        if self._degree > 0:
            found += [x, y, z]
        if self._degree > 1:
            found += [x * x, y * y, z * z, x * y, y * z, z * x]
        return np.stack(found, axis=-1)

    def fit(self, points: Floats, cells: Ints, lame: Lame, fields: Floats) -> Floats:
        """(n_patches, n_terms, 6 m) coefficients that fit stresses at the elements' best points.

        These are the Gauss points of one degree less (Barlow 1976). Of m fields (n, m, 3).
        """
        at, _ = get_quadrature(self._kind.element.refdom, self._degree + 1)
        values, gradients = self._kind.shape(at)
        n, n_terms = len(self._centre), (1, 4, 10)[self._degree]
        left = np.zeros((n, n_terms * n_terms))
        width = 6 * fields.shape[1]
        right = np.zeros((n, n_terms * width))
        for rows in chunks(len(cells), max(CHUNK // (2 * fields.shape[1]), 1)):
            physical = jacobian(points, cells[rows], gradients)[0]
            found = stresses_of_fields(physical, fields[cells[rows]], lame)
            s = found.reshape(*found.shape[:2], width)
            terms = self.terms(rows, values @ points[cells[rows]])
            patch = self.local[rows].ravel()
            gather = sparse.csr_array(
                (np.ones(patch.size), (patch, np.arange(patch.size))), shape=(n, patch.size)
            )
            products = np.swapaxes(terms, 2, 3) @ terms
            left += gather @ products.reshape(patch.size, -1)
            loads = np.swapaxes(terms, 2, 3) @ s[:, None]
            right += gather @ loads.reshape(patch.size, -1)
        matrix = left.reshape(n, n_terms, n_terms)
        matrix += matrix[:, 0, 0, None, None] * np.diag(_HELD[:n_terms])
        return np.asarray(np.linalg.solve(matrix, right.reshape(n, n_terms, width)))
