"""Cost of each solver, in seconds and bytes, before it is set up.

Nested dissection of a solid whose cross-section has w nodes, n unknowns in all, fills a factor with
about n w^(1/2) entries at n w^(3/2) operations (George 1973 for squares and cubes; a slender solid
is a row of cubes). The width comes from the levels of one breadth-first search, so that slender
and chunky solids of one size are distinguished. The constants were fitted to the grid of
``cases/performance/solvers.py`` on two cores; on other machines their ratios are what counts.
"""

import math
import os
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy import sparse

from fe_drivetrain.common.arrays import Ints
from fe_drivetrain.common.threads import one_blas_thread
from fe_drivetrain.elasticity.mesh.facets import local_facets
from fe_drivetrain.elasticity.mesh.shapes import element_kind
from fe_drivetrain.elasticity.mesh.shared_facets import facet_keys
from fe_drivetrain.elasticity.operator import graph
from fe_drivetrain.elasticity.solve import direct_solvers
from fe_drivetrain.elasticity.solve.reduction import Elements, System
from fe_drivetrain.elasticity.solve.stopping import TOLERANCE


class Direct(NamedTuple):
    """Cost of a direct solver: seconds at once, per entry of K, per operation; bytes per entry of
    the factor; seconds of a solve per byte, at once and for each right-hand side.
    """

    start: float
    per_entry: float
    per_operation: float
    bytes: float
    solve: float
    each: float


# SuperLU, which the grid leaves out where it is slow, is fitted in logarithms to 67 systems of 3 to
# 40 thousand unknowns that cases solve, too: from a third to four times what was measured.
DIRECT = {
    "superlu": Direct(0.0, 7.8e-8, 2.2e-9, 346.0, 1.3e-10, 7.1e-11),
    "cholmod": Direct(0.0, 7.1e-7, 1.9e-9, 99.0, 3.9e-10, 4.0e-10),
    "pardiso": Direct(0.0, 1.4e-7, 2.1e-10, 172.0, 2.6e-10, 1.8e-10),
}


class Multigrid(NamedTuple):
    """Cost of multigrid: seconds at once, per entry of K, per entry and iteration at once and for
    each right-hand side; bytes per entry.
    """

    start: float
    per_entry: float
    once: float
    each: float
    bytes: float


MULTIGRID = Multigrid(0.0, 0.0, 1.28e-9, 3.75e-10, 9.4)


class Schwarz(NamedTuple):
    """Cost of patches with a spectral coarse space: seconds at once, per unknown; iterations, which
    the threshold of the coarse space bounds; per entry that an iteration reads, at once and for
    each right-hand side; bytes per unknown, and entries of the factors per unknown, twice.
    """

    start: float
    per_unknown: float
    iterations: float
    once: float
    each: float
    bytes: float
    entries: float


SCHWARZ = Schwarz(0.3, 6e-5, 40.0, 7e-10, 5e-10, 1600.0, 300.0)

#: Iterations of multigrid to `TOLERANCE` on bodies that are not thin, by the nodes of an element:
#: medians of what cases take. Elements that are not known count as those of ten nodes.
ORDINARY = {4: 21.0, 8: 20.0, 10: 32.0, 20: 45.0, 27: 66.0}

# Iterations for each unit of `thinness`, of tetrahedra and of hexahedra, and how many times as many
# a joint takes that is kept out of the hierarchy: medians of the same.
_THIN, _THIN_HEXAHEDRA, _JOINED = 7.0, 3.0, 1.3


@dataclass(frozen=True)
class Cost:
    """Predicted cost of one solver.

    Attributes
    ----------
    method : str
        Name of the solver.
    seconds : float
        Time for set-up and solve [s].
    bytes : float
        Memory of the factor or hierarchy.
    fits : bool
        Whether there is the memory for it now.
    """

    method: str
    seconds: float
    bytes: float
    fits: bool

    def __str__(self) -> str:
        memory = f"{self.bytes / 2**20:.3g} MiB"
        if self.bytes >= 2**30:
            memory = f"{self.bytes / 2**30:.3g} GiB"
        return f"{self.method} about {self.seconds:.2g} s, {memory}" + (
            "" if self.fits else ", more memory than is free"
        )


def predict(system: System, n_rhs: int, tolerance: float = TOLERANCE) -> list[Cost]:
    """Costs of every solver that is installed, cheapest first among those that fit in memory.

    Parameters
    ----------
    system : System
        System from `reduction.reduce`.
    n_rhs : int
        Number of right-hand sides there will be.
    tolerance : float
        Tolerance at which iterations will stop.

    Returns
    -------
    list of Cost
    """
    with one_blas_thread():
        expected = iterations(system, tolerance)
    n, nnz = system.K.shape[0], system.K.nnz
    w = width(system.K)
    memory = available_memory()
    fill, work = n * w**0.5, n * w**1.5
    costs = []
    for method, d in DIRECT.items():
        if direct_solvers.is_installed(method):
            held = d.bytes * fill
            seconds = d.start + d.per_entry * nnz + d.per_operation * work
            costs.append((method, seconds + held * (d.solve + d.each * n_rhs), held))
    m = MULTIGRID
    seconds = m.start + nnz * (m.per_entry + expected * (m.once + m.each * n_rhs))
    costs.append(("multigrid", seconds, m.bytes * nnz))
    if system.elements is not None:
        s = SCHWARZ
        read = 3 * nnz + s.entries * n
        seconds = s.start + s.per_unknown * n + s.iterations * read * (s.once + s.each * n_rhs)
        costs.append(("schwarz", seconds, s.bytes * n))
    found = [Cost(m, s, b, b < memory) for m, s, b in costs]
    return sorted(found, key=lambda cost: (not cost.fits, cost.seconds))


def iterations(system: System, tolerance: float = TOLERANCE) -> float:
    """Iterations of multigrid to be expected, from elements and from how thin the solid is.

    Each takes off about as much of the error. Half to twice as many were seen in the cases; see
    `thinness` for thin tubes and slender shafts.

    Parameters
    ----------
    system : System
        System from `reduction.reduce`.
    tolerance : float
        Tolerance at which iterations will stop.
    """
    found = ORDINARY[10]
    if system.elements is not None:
        n_nodes = system.elements.cells.shape[1]
        thin = _THIN_HEXAHEDRA if element_kind(n_nodes).n_corners == 8 else _THIN
        found = max(ORDINARY[n_nodes], thin * thinness(system.elements))
    if system.joints is not None:
        found *= _JOINED
    return found * math.log10(tolerance) / math.log10(TOLERANCE)


def thinness(elements: Elements) -> float:
    """Length of an element over the wall, times the root of half the solid's extent over the wall.

    Multigrid took three to five times as many iterations on tubes of a wall of 1/5 to 1/20 of the
    radius and on shafts of 5 to 100 diameters, ``cases/stability``: soft motions of a wall or a
    rod are bending, and of that aggregates that move as rigid bodies know less, the longer the
    elements are. The wall is twice the volume over the surface: half the diameter of a solid shaft.
    """
    kind = element_kind(elements.cells.shape[1])
    corners = elements.cells[:, : kind.n_corners]
    local = local_facets(kind.n_corners)
    facets = corners[:, local].reshape(-1, local.shape[1])
    outer = elements.points[facets[_alone(facets, len(elements.points))]]
    diagonal = outer[:, 2] - outer[:, 0]
    # of a triangle half the product of two sides, of a quadrilateral that of its diagonals
    beside = outer[:, 1] - outer[:, 0] if outer.shape[1] == 3 else outer[:, 3] - outer[:, 1]
    normals = 0.5 * np.cross(diagonal, beside)  # all outwards, or all inwards
    volume = abs(float(np.einsum("fci,fi->", outer, normals))) / (3 * outer.shape[1])
    wall = 2.0 * volume / float(np.linalg.norm(normals, axis=1).sum())
    each = [elements.points[column] for column in corners.T]
    spans = np.maximum.reduce(each) - np.minimum.reduce(each)
    longest = float(np.median(spans.max(axis=1)))
    extent = float(np.linalg.norm(np.ptp(outer.reshape(-1, 3), axis=0)))
    return float(longest / wall * math.sqrt(extent / (2.0 * wall)))


def _alone(facets: Ints, n_nodes: int) -> Ints:
    """Which facets no other one has the nodes of."""
    key = facet_keys(facets, n_nodes)
    order = np.argsort(key)
    same = np.diff(key[order]) == 0
    return np.asarray(order[~(np.append(same, False) | np.append(False, same))])


def width(K: sparse.bsr_array) -> float:
    """Mean number of nodes in a cross-section, of the levels of a breadth-first search."""
    start = int(np.argmax(np.diff(K.indptr)))  # not one that stands alone
    far = int(np.argmax(graph.distances(K.indptr, K.indices, start)))
    level = graph.distances(K.indptr, K.indices, far)
    size = np.bincount(level[level >= 0]).astype(float)
    return float((size**2).sum() / size.sum())


def available_memory() -> float:
    """Bytes that can be had without swapping; infinite where the system does not say."""
    try:
        return float(os.sysconf("SC_AVPHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"))
    except (AttributeError, ValueError, OSError):
        return float("inf")
