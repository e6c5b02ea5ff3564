"""Ties between faces whose meshes do not match: the mortar method, as constraints.

Two bodies are tied where the weighted mean of the jump between them vanishes on the slave face,
for one weight function (multiplier) phi_i a slave node (Bernardi, Maday and Patera 1994):

    int phi_i (u_slave - u_master) dA = 0,    D u_slave = M u_master.

The sum of the phi_i is one, so a uniform traction passes exactly from mesh to mesh; tied point by
point (`node_tie`) it does not. The integrals are taken over the pieces that slave and master
facets have in common (Puso 2004).

The multipliers are the slave's own shape functions ("standard"), or functions biorthogonal to them
("dual", Wohlmuth 2000), with shape functions whose integral is not positive changed first (Popp,
Wohlmuth, Gee and Wall 2012). With standard ones D is a mass matrix, and a slave node follows all
master nodes, though the far ones hardly; tractions that vary pass as accurately as the elements
hold them. With dual ones D is diagonal and a slave node follows the few master nodes opposite to
it, but only constant tractions pass exactly. Measured on quadratic triangles, 16 by 16 on 15 by 15
squares of two: 893 entries a row and 40; pressure through a cylinder of 32 elements round arrives
with errors of 2e-6 and 2e-3. Small entries cannot be dropped instead: without those below 1e-15 of
a row's largest 893 of 962 are left, without those below 1e-12 756, and linear displacements no
longer pass to round-off.

The finer face is to be the slave. A coarse slave couples all nodes of a fine master with one
another: one element on 20 by 20, with 1681 nodes, leaves a full block of 25 million entries in the
stiffness. With dual multipliers, or node by node, stress beside it is wrong as well, by a tenth and
more. A tie whose slave is much the coarser warns.

Sources: C. Bernardi, Y. Maday, A. T. Patera, College de France Seminar XI (1994) 13-51; B. I.
Wohlmuth, SIAM J. Numer. Anal. 38 (2000) 989-1012; M. A. Puso, Int. J. Numer. Meth. Engng 59 (2004)
315-336; A. Popp et al., SIAM J. Sci. Comput. 34 (2012) B421-B446.
"""

import warnings
from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.elasticity.interfaces.constraints import Constraint
from fe_drivetrain.elasticity.interfaces.overlap import (
    OPPOSED,
    REACH,
    Pieces,
    circles,
    common_pieces,
    curvature,
    facet_normals,
    left_by_rims,
    near_pairs,
    nodal_normals,
    opposite_points,
)
from fe_drivetrain.elasticity.mesh.facets import facet_kind, facet_points

Multipliers = Literal["dual", "standard"]

_COVERED = 1e-6  # share of a plane slave face that may be left uncovered
_FAR = 4.0  # of a facet's size: faces this far apart may have been meant to touch
_OUTSIDE = 0.05  # of a facet: a node this far outside of it still belongs to it
_FINER = 2.0  # nodes to an area of the master, over the slave's: more is warned of
_APART = 0.01  # of the slave's radius: faces that lie further apart are warned of
_BLOCK = 256  # columns that are dense at a time
_DROP = 1e-15  # of a row's largest: smaller entries are round-off

# What each corner gets of the shape function of a mid-side beside it. Popp et al. 2012 take 1/5 for
# both (as quoted by others, not re-read); on the cylinder above 1/12 has a sixth of the error.
_SHARE = {6: 1.0 / 12.0, 8: 0.2}
_SIDES = {
    6: ((3, 0, 1), (4, 1, 2), (5, 2, 0)),
    8: ((4, 0, 1), (5, 1, 2), (6, 2, 3), (7, 3, 0)),
}


def mortar_tie(
    name: str,
    points: Floats,
    slave: Ints,
    master: Ints,
    n_dofs: int,
    multipliers: Multipliers = "standard",
) -> Constraint:
    """Tie two faces that lie on one another, whatever their meshes.

    The finer face, or that of the softer body, is best the slave: it gets as many conditions as it
    has nodes. The other way round it holds as well, but fine nodes between coarse ones move
    freely, and all of them are coupled with one another.

    On plane faces every linear displacement passes, and every constant stress. On curved ones
    both pass as well as the facets meet the surface; see `settled`.

    Parameters
    ----------
    name : str
        Name of the tie, for messages.
    points : Floats
        Node coordinates (n, 3) [m].
    slave, master : Ints
        Facets (nf, k) in VTK's order, turned outward: triangles of 3 or 6, quadrilaterals of 4, 8
        or 9 nodes. The master face covers all of the slave face; it may be larger.
    n_dofs : int
        Degrees of freedom of the whole model, three a node first.
    multipliers : Multipliers
        "standard" is the more accurate one, "dual" keeps the stiffness sparse on large faces (of
        more than about a thousand nodes); see above.

    Returns
    -------
    constraint
        u_slave - D^-1 M u_master = 0, a row and a pivot for each degree of freedom of the slave's
        nodes. Its multipliers are the nodal forces on the slave.

    Raises
    ------
    InputError
        The faces share nodes, or the master does not cover the slave.

    Warns
    -----
    UserWarning
        The master has more than twice as many nodes to an area as the slave, or the faces lie apart
        by more than a hundredth of the slave's radius: reactions are then out of balance by as
        much, unless the points are `settled`.
    """
    nodes, rows, columns = _numbered(name, slave, master)
    _warn_of_coarse_slave(name, points, slave, master)
    pieces = common_pieces(points, slave, master)
    _check_coverage(name, points, slave, master, pieces)

    n_slave, size = len(nodes.slave), (len(nodes.slave), len(nodes.master))
    mass = np.zeros((len(slave), slave.shape[1], slave.shape[1]))
    np.add.at(mass, pieces.slave, pieces.own)
    if multipliers == "standard":
        D = _summed(mass, rows, rows, (n_slave, n_slave))
        M = _summed(pieces.across, rows[pieces.slave], columns[pieces.master], size)
        return _warned_of_gap(_following(name, nodes, _solved(D, M), n_dofs), points)
    # phi = diag(d) B^-T mass^-1 N is biorthogonal to the positive shape functions B N, facet by
    # facet: u~ = diag(1/d) M u_master are the coefficients of these, and u = B^T u~.
    positive = _positive(slave.shape[1])
    integrals = np.einsum("ij,fjk->fi", positive, mass)
    weights = integrals[:, :, None] * (np.linalg.inv(positive).T @ np.linalg.inv(mass))
    M = _summed(
        weights[pieces.slave] @ pieces.across, rows[pieces.slave], columns[pieces.master], size
    )
    d = np.bincount(rows.ravel(), integrals.ravel())
    count = np.bincount(rows.ravel())
    same = np.broadcast_to(positive.T, mass.shape)  # on every facet that has the node
    spread = _summed(same, rows, rows, (n_slave, n_slave))
    P = sparse.diags_array(1.0 / count) @ spread @ sparse.diags_array(1.0 / d) @ M
    return _warned_of_gap(_following(name, nodes, P.tocsr(), n_dofs), points)


def node_tie(name: str, points: Floats, slave: Ints, master: Ints, n_dofs: int) -> Constraint:
    """Tie each slave node to the point of the master face opposite to it.

    What many programs call a tie. Every linear displacement passes on plane faces, but forces
    arrive at the nodes that happen to lie there, and a constant stress does not pass, unless the
    meshes match.

    Parameters
    ----------
    name, points, slave, master, n_dofs : str, Floats, Ints, Ints, int
        Arguments of `mortar_tie`.

    Raises
    ------
    InputError
        The faces share nodes, or a slave node lies outside the master face.

    Warns
    -----
    UserWarning
        The slave is coarser than the master, or the faces lie apart; see `mortar_tie`.
    """
    nodes, rows, columns = _numbered(name, slave, master)
    _warn_of_coarse_slave(name, points, slave, master)
    kind = facet_kind(master.shape[1])
    normals = nodal_normals(points, slave, rows)
    outline = points[master]
    centres, radii = circles(outline)
    node, facet = near_pairs(points[nodes.slave], np.zeros(len(nodes.slave)), centres, radii)
    facing = np.einsum("pi,pi->p", normals[node], facet_normals(points, master)[facet]) < OPPOSED
    node, facet = node[facing], facet[facing]
    at = opposite_points(kind, outline[facet], points[nodes.slave][node], normals[node])
    outside = np.maximum(-at.coordinates.min(axis=0), 0.0)
    beyond = at.coordinates.sum(axis=0) if master.shape[1] in (3, 6) else at.coordinates.max(axis=0)
    outside = np.maximum(outside, beyond - 1.0)
    outside[~(np.abs(at.distance) < REACH * radii[facet])] = np.inf
    # the facet about a node that it lies in, or is nearest to
    order = np.lexsort((outside, node))
    found, first = np.unique(node[order], return_index=True)
    best = order[first]
    if len(found) < len(nodes.slave) or not (outside[best] < _OUTSIDE).all():
        raise InputError(
            f"tie {name!r}: a node of the slave face lies outside of the master face: take the "
            "smaller face as the slave, or cut it to what both have in common"
        )
    size = (len(nodes.slave), len(nodes.master))
    P = _summed(at.values[best][:, None, :], node[best][:, None], columns[facet[best]], size)
    return _warned_of_gap(_following(name, nodes, P, n_dofs), points)


def settled(points: Floats, *ties: Constraint) -> Floats:
    """Move slave nodes to where the ties see the master face, and return all points.

    Facets of two meshes of a curved surface lie a little apart, and a tie across that gap resists
    rotation. Moved by it (of curved quadratic facets the cube of their size), the nodes fulfil the
    tie by their positions, and with that by every rigid motion and every linear displacement
    (Puso 2004). On plane faces nothing moves.

    Parameters
    ----------
    points : Floats
        Node coordinates (n, 3) [m], as the ties were made with.
    *ties : Constraint
        Ties from `mortar_tie` or `node_tie`.

    Returns
    -------
    points
        Points (n, 3) [m]. The ties hold for them as they are.
    """
    moved = points.astype(float).ravel()
    for tie in ties:
        moved[tie.pivots] -= tie.rows[:, : moved.size] @ moved
    return moved.reshape(points.shape)


@dataclass(frozen=True)
class _Nodes:
    slave: Ints
    master: Ints


def _numbered(name: str, slave: Ints, master: Ints) -> tuple[_Nodes, Ints, Ints]:
    """Nodes of both faces, and the facets in numbers of their own."""
    own, rows = np.unique(slave, return_inverse=True)
    others, columns = np.unique(master, return_inverse=True)
    if np.isin(own, others).any():
        raise InputError(
            f"tie {name!r}: slave and master face share nodes: give faces of two separate meshes"
        )
    return _Nodes(own, others), rows.reshape(slave.shape), columns.reshape(master.shape)


def _warn_of_coarse_slave(name: str, points: Floats, slave: Ints, master: Ints) -> None:
    own, others = (
        len(np.unique(facets)) / facet_points(points, facets).areas.sum()
        for facets in (slave, master)
    )
    if others > _FINER * own:
        warnings.warn(
            f"tie {name!r}: the master face has {others / own:.3g} times as many nodes to an area "
            f"as the slave, but must have at most {_FINER:g} times: take the finer face as the "
            "slave, else stress beside the tie may be wrong and all nodes of the master are "
            "coupled with one another",
            stacklevel=3,
        )


def _warned_of_gap(tie: Constraint, points: Floats) -> Constraint:
    """The tie, with a warning where slave nodes lie far from where it sees the master face."""
    own = points[tie.pivots[::3] // 3]
    gap = np.abs(tie.rows[:, : points.size] @ points.ravel()).reshape(-1, 3)
    apart = float(np.linalg.norm(gap, axis=1).max())
    radius = float(np.linalg.norm(own - own.mean(axis=0), axis=1).max())
    if apart > _APART * radius:
        warnings.warn(
            f"tie {tie.name!r}: slave and master face lie up to {apart:.3g} m apart, "
            f"{100.0 * apart / radius:.2g} % of the face's radius, by which moments fail to "
            "balance: move the nodes with `settled`, or mesh the curved face finer",
            stacklevel=3,
        )
    return tie


def _positive(n_nodes: int) -> Floats:
    """(k, k) B: shape functions B N of positive integral, from the N of a facet with k nodes.

    The corner functions of the six-node triangle have integral zero, those of the eight-node
    quadrilateral a negative one. Each gets a share of the mid-side functions beside it; the sum
    stays one.
    """
    B = np.eye(n_nodes)
    for mid, *corners in _SIDES.get(n_nodes, ()):
        B[corners, mid] = _SHARE[n_nodes]
        B[mid, mid] = 1.0 - 2.0 * _SHARE[n_nodes]
    return B


def _summed(blocks: Floats, rows: Ints, columns: Ints, shape: tuple[int, int]) -> sparse.csr_array:
    """Element matrices (n, i, j) added at rows (n, i) and columns (n, j)."""
    i = np.broadcast_to(rows[:, :, None], blocks.shape).ravel()
    j = np.broadcast_to(columns[:, None, :], blocks.shape).ravel()
    matrix = sparse.csr_array((np.ravel(blocks), (i, j)), shape=shape)
    matrix.eliminate_zeros()
    return matrix


def _solved(D: sparse.csr_array, M: sparse.csr_array) -> sparse.csr_array:
    """D^-1 M without entries that are round-off."""
    factor, right = splu(D.tocsc()), M.tocsc()
    blocks = np.array_split(np.arange(M.shape[1]), M.shape[1] // _BLOCK + 1)
    solved = [sparse.csc_array(factor.solve(right[:, some].toarray())) for some in blocks]
    P = sparse.hstack(solved, format="csr")
    largest = abs(P).max(axis=1).toarray().ravel()
    P.data[np.abs(P.data) < _DROP * np.repeat(largest, np.diff(P.indptr))] = 0.0
    P.eliminate_zeros()
    return P


def _following(name: str, nodes: _Nodes, P: sparse.csr_array, n_dofs: int) -> Constraint:
    """u_slave - P u_master = 0 for each of the three displacements."""
    own = sparse.csr_array(
        (np.ones(len(nodes.slave)), (np.arange(len(nodes.slave)), nodes.slave)),
        shape=(len(nodes.slave), n_dofs // 3),
    )
    entries = P.tocoo()
    i, j = entries.coords
    others = sparse.csr_array((entries.data, (i, nodes.master[j])), shape=own.shape)
    rows = sparse.kron(own - others, sparse.eye_array(3), format="csr")
    rows.resize(rows.shape[0], n_dofs)
    return Constraint(name, rows, np.asarray(3 * nodes.slave[:, None] + np.arange(3)).ravel())


def _check_coverage(name: str, points: Floats, slave: Ints, master: Ints, pieces: Pieces) -> None:
    areas = facet_points(points, slave).areas.sum(axis=1)
    covered = np.bincount(pieces.slave, pieces.area, len(slave))
    share = float(covered.sum() / areas.sum())
    # Where curved facets end in a curved edge, the pieces end in its chords: by so much the areas
    # of curved facets and of their windows differ.
    allowed = _COVERED + sum(curvature(points, facets) for facets in (slave, master))
    missing = 1.0 - share
    if missing > allowed:
        rims = np.clip(areas - covered, 0.0, left_by_rims(points, slave, master))
        missing -= float(rims.sum() / areas.sum())
    if max(share - 1.0, missing) > allowed or (covered < 0.5 * areas).any():
        far = common_pieces(points, slave, master, _FAR)
        if share < 1.0 and far.area.sum() > 1.01 * covered.sum():
            fix = (
                "which must be all of it; in part they face one another but lie further apart than "
                f"{REACH:g} of a master facet: take the finer face as the slave, mesh curved "
                "faces finer or with curved elements, or bring the faces together"
            )
        else:
            fix = (
                "which must be all of it, once: take the smaller face as the slave, or cut the "
                "slave face to what both have in common"
            )
        raise InputError(
            f"tie {name!r}: the master face covers {100.0 * share:.6g} % of the slave face, {fix}"
        )
