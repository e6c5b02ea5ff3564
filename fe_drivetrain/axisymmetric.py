"""Bodies of revolution by Fourier harmonics: exact elasticity of a shaft in its meridian alone.

Displacements along x, the radius and the circumference are u_x(x, r) cos(n t), u_r cos(n t) and
u_t sin(n t), t the angle round the axis: harmonic 0 is tension, and with u_t alone torsion (where
the sine is replaced by 1), harmonic 1 is bending with shear, harmonic 2 makes rings oval
(Zienkiewicz and Taylor 2000, The Finite Element Method, vol 2, chapter 9). Harmonics don't mix, so
each is a problem in the plane. All integrals run over the whole turn: forces are in N, energies
in J.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from fe_drivetrain.elasticity import Floats, Ints
from fe_drivetrain.errors import InputError
from fe_drivetrain.geometry import Shaft
from fe_drivetrain.hexahedra import SAME_LENGTH
from fe_drivetrain.materials import Material
from fe_drivetrain.meridian import Meridian, meridian

COMPONENTS = ("xx", "rr", "tt", "xr", "xt", "rt")
"""Of stress: the first four go round as cos(n t), the last two as sin(n t)."""

Traction = Callable[[Floats, Floats], Floats]
"""Of (k, 2) positions [m] and outward normals, each x and radius: (k, 3) amplitudes [Pa]."""


Motion = tuple[Ints, int, tuple[float | Floats | None, ...]]
"""Nodes, the number of their rigid motion, and its components, None where it has none."""


@dataclass(frozen=True)
class HarmonicResponse:
    """Displacements of a body of revolution in one harmonic.

    Attributes
    ----------
    n
        The harmonic.
    u
        (n_nodes, 3, m) amplitudes of u_x, u_r, u_t [m].
    reactions
        (n_nodes, 3, m) nodal forces that hold what is held [N], over the whole turn.
    energy
        (m,) strain energy [J].
    """

    n: int
    u: Floats
    reactions: Floats
    energy: Floats


def freedoms(nodes: Ints, component: int) -> Ints:
    """Freedoms of nodes along x (0), the radius (1) or the circumference (2)."""
    return np.asarray(3 * np.asarray(nodes) + component)


def harmonic_response(
    mesh: Meridian,
    material: Material,
    n: int,
    loads: Floats | None = None,
    held: tuple[Ints, Floats] | None = None,
) -> HarmonicResponse:
    """Solve one harmonic for given forces and displacements.

    Parameters
    ----------
    mesh
        The meridian.
    material
        Of the body.
    n
        The harmonic, 0 or more.
    loads
        (3 n_nodes,) or (3 n_nodes, m) nodal forces over the whole turn [N], as `surface_loads`
        gives them; none where not given.
    held
        Freedoms (k,) and their displacements (k,) or (k, m) [m].

    Raises
    ------
    InputError
        The body is free to move as a rigid one.
    """
    if n < 0:
        raise InputError(f"harmonic is {n} but must be 0 or more: give its order round the axis")
    size = 3 * len(mesh.nodes)
    which = np.empty(0, dtype=np.int64) if held is None else np.asarray(held[0])
    values = np.zeros((0, 1)) if held is None else np.reshape(held[1], (len(which), -1))
    F = np.zeros((size, 1)) if loads is None else np.reshape(loads, (size, -1))
    m = max(F.shape[1], values.shape[1])
    F, values = np.broadcast_to(F, (size, m)), np.broadcast_to(values, (len(which), m))

    target, coefficient = _on_axis(mesh, n)
    _check_held(mesh, n, which)
    matrices = element_matrices(mesh, material.lame, n)
    component = np.repeat(np.arange(3), mesh.cells.shape[1])
    local = 3 * np.tile(mesh.cells, 3) + component
    K = _assembled(matrices, target[local], coefficient[local], size)
    F = sparse.csr_array((coefficient, (target, np.arange(size))), shape=(size, size)) @ F

    q = np.zeros((size, m))
    kept = coefficient[which] != 0
    given = target[which[kept]]
    q[given] = coefficient[which[kept], None] * values[kept]
    free = np.zeros(size, dtype=bool)
    free[target[coefficient != 0]] = True
    free[given] = False
    if free.any():
        q[free] = _factor(K[free][:, free]).solve((F - K @ q)[free])
    Kq = K @ q
    reactions = np.zeros((size, m))
    reactions[given] = (Kq - F)[given]
    u = coefficient[:, None] * q[target]
    return HarmonicResponse(
        n,
        u.reshape(-1, 3, m),
        reactions.reshape(-1, 3, m),
        0.5 * np.einsum("im,im->m", q, Kq),
    )


def surface_loads(mesh: Meridian, n: int, sides: Ints, traction: Traction) -> Floats:
    """Nodal forces (3 n_nodes,) of a traction on sides of the boundary, over the whole turn [N].

    Parameters
    ----------
    mesh
        The meridian.
    n
        The harmonic.
    sides
        (k, 2) cell and side, as `Meridian.sides` gives them.
    traction
        Amplitudes along x, the radius and the circumference.
    """
    F = np.zeros((len(mesh.nodes), 3))
    abscissa, weight = np.polynomial.legendre.leggauss(mesh.element.order + 3)
    for side, of in _by_side(mesh, sides):
        values, at, tangents = along_sides(mesh, side, of, (abscissa + 1.0) / 2.0)
        lengths = np.hypot(tangents[..., 0], tangents[..., 1])
        normals = np.stack([tangents[..., 1], -tangents[..., 0]], axis=-1) / lengths[..., None]
        t = traction(at.reshape(-1, 2), normals.reshape(-1, 2)).reshape(*lengths.shape, 3)
        area = turn(n) * at[..., 1] * lengths * weight / 2.0
        np.add.at(F, mesh.cells[of], np.einsum("qm,eq,eqi->emi", values, area, t))
    return F.ravel()


def along_sides(
    mesh: Meridian, side: int, cells: Ints, along: Floats
) -> tuple[Floats, Floats, Floats]:
    """Shape functions (q, m), positions (k, q, 2) [m] and tangents (k, q, 2) on a side of cells.

    Parameters
    ----------
    mesh, side, cells
        The meridian, the number of the side, and (k,) cells.
    along
        (q,) from the side's first end, 0, to its second, 1; tangents are per unit of it.
    """
    places = mesh.element.side_places(side, along)
    values, gradients = mesh.element.at(places)
    step = np.diff(mesh.element.side_places(side, np.array([0.0, 1.0])), axis=0)[0]
    nodes = mesh.nodes[mesh.cells[cells]]
    at = np.einsum("qm,emi->eqi", values, nodes)
    tangents = np.einsum("qkm,k,emi->eqi", gradients, step, nodes)
    return values, at, tangents


def stresses(
    mesh: Meridian, material: Material, n: int, u: Floats, at: Floats, cells: Ints | None = None
) -> Floats:
    """Amplitudes of stress inside the elements.

    Parameters
    ----------
    mesh, material, n
        As for `harmonic_response`.
    u
        (n_nodes, 3) amplitudes [m].
    at
        (q, 2) reference places in each element, or (k, q, 2), own ones of each.
    cells
        (k,) which; all where not given.

    Returns
    -------
    (k, q, 6) in the order of `COMPONENTS` [Pa]; on the axis the limits.
    """
    chosen = mesh.cells if cells is None else mesh.cells[cells]
    places = np.broadcast_to(at, (len(chosen), *np.shape(at)[-2:]))
    shared = np.ndim(at) == 2
    values, gradients = mesh.element.at(at if shared else places.reshape(-1, 2))
    q = places.shape[1]
    values = np.broadcast_to(values, (len(chosen), *values.shape)) if shared else values
    values = values.reshape(len(chosen), q, -1)
    gradients = np.broadcast_to(gradients, (len(chosen), *gradients.shape)) if shared else gradients
    physical, _ = _physical(mesh.nodes[chosen], gradients.reshape(len(chosen), q, 2, -1))
    amplitudes = u[chosen]
    r = np.einsum("eqm,em->eq", values, mesh.nodes[chosen, 1])
    ux, ur, ut = np.moveaxis(values @ amplitudes, -1, 0)
    (ux_x, ur_x, ut_x), (ux_r, ur_r, ut_r) = np.moveaxis(
        physical @ amplitudes[:, None], (2, 3), (0, 1)
    )

    def over_radius(f: Floats, slope: Floats) -> Floats:
        on_axis = r < SAME_LENGTH
        return np.where(on_axis, slope, f / np.where(on_axis, 1.0, r))

    e_tt = over_radius(ur + n * ut, ur_r + n * ut_r)
    g_xt = ut_x - over_radius(n * ux, n * ux_r)
    g_rt = ut_r - over_radius(ut + n * ur, ut_r + n * ur_r)
    lam, mu = material.lame
    dilatation = lam * (ux_x + ur_r + e_tt)
    normal = [dilatation + 2.0 * mu * e for e in (ux_x, ur_r, e_tt)]
    shear = [mu * g for g in (ux_r + ur_x, g_xt, g_rt)]
    return np.stack([*normal, *shear], axis=-1)


def stress_at(mesh: Meridian, material: Material, n: int, u: Floats, places: Floats) -> Floats:
    """Amplitudes of stress (k, 6) [Pa] at positions (k, 2), x and radius [m].

    Raises
    ------
    InputError
        A position lies outside the meridian.
    """
    found = [_located(mesh, place) for place in np.reshape(places, (-1, 2))]
    cells = np.array([cell for cell, _ in found])
    at = np.array([[reference] for _, reference in found])
    return stresses(mesh, material, n, u, at, cells)[:, 0]


def end_stiffness(
    shaft: Shaft,
    material: Material,
    size: float | None = None,
    *,
    order: int | None = None,
    layers: int = 4,
    per_fillet: int = 6,
) -> Floats:
    """Stiffness of a shaft between its two end faces, each rigid.

    Parameters
    ----------
    shaft, size, order, layers, per_fillet
        As for `fe_drivetrain.meridian.meridian`.
    material
        Of the shaft.

    Returns
    -------
    (12, 12) from displacements [m] and rotations [rad] along and about x, y, z at the middle of the
    front face, then of the rear face, to the forces [N] and moments [N m] there.
    """
    mesh = meridian(shaft, size, order=order, layers=layers, per_fillet=per_fillet)
    return stiffness_between_ends(mesh, material)


def stiffness_between_ends(mesh: Meridian, material: Material) -> Floats:
    """The same of a meridian, whose ends are its nodes of least and of greatest x."""
    x, r = mesh.nodes.T
    faces = [np.flatnonzero(np.abs(x - end) < SAME_LENGTH) for end in (x.min(), x.max())]
    products = _products(mesh)
    K = np.zeros((12, 12))

    stretched, twisted = _stretched(products, material.lame), _twisted(products, material.lame)
    axial: list[Motion] = [(face, k, (1.0, None)) for k, face in enumerate(faces)]
    K[np.ix_([0, 6], [0, 6])] = turn(0) * _between(mesh, stretched, 0, 2, axial)
    twist: list[Motion] = [(face, k, (r[face],)) for k, face in enumerate(faces)]
    K[np.ix_([3, 9], [3, 9])] = turn(0) * _between(mesh, twisted, 0, 1, twist)

    one = _element_matrices(products, material.lame, 1)
    # along y, and about z
    bent: list[Motion] = [
        motion
        for k, face in enumerate(faces)
        for motion in ((face, 2 * k, (None, 1.0, -1.0)), (face, 2 * k + 1, (-r[face], None, None)))
    ]
    flexural = turn(1) * _between(mesh, one, 1, 3, bent)
    K[np.ix_([1, 5, 7, 11], [1, 5, 7, 11])] = flexural
    # along z, and about y: a rotation about y lifts z's side the other way
    signs = np.array([1.0, -1.0, 1.0, -1.0])
    K[np.ix_([2, 4, 8, 10], [2, 4, 8, 10])] = flexural * np.outer(signs, signs)
    return K


def turn(n: int) -> float:
    """Integral of cos^2(n t) round the axis: that of 1 where n is 0."""
    return 2.0 * math.pi if n == 0 else math.pi


def element_matrices(mesh: Meridian, lame: tuple[float, float], n: int) -> Floats:
    """Stiffness (ne, 3 m, 3 m) of each element over the whole turn [N/m].

    Freedoms u_x of all its m nodes, then u_r, then u_t. On the axis entries are large that cancel
    once its conditions hold.
    """
    return turn(n) * _element_matrices(_products(mesh), lame, n)


def rigid_motions(mesh: Meridian, n: int) -> Floats:
    """(3 n_nodes, k) motions without strain: n = 0 along x, about x; n = 1 along y, about z."""
    x, r = mesh.nodes.T
    one, zero = np.ones_like(x), np.zeros_like(x)
    motions = {
        0: [(one, zero, zero), (zero, zero, r)],
        1: [(zero, one, -one), (-r, x, -x)],
    }.get(n, [])
    return np.array([np.column_stack(m).ravel() for m in motions]).reshape(-1, 3 * len(x)).T


def _products(mesh: Meridian) -> tuple[Floats, ...]:
    """Integrals (ne, m, m) of products of a = N,x, b = N,r and c = N / r: aa, bb, cc, ab, ac, bc.

    They are all that any harmonic and any material needs.
    """
    element = mesh.element
    nodes = mesh.nodes[mesh.cells]
    shared = np.broadcast_to(element.gradients, (len(nodes), *element.gradients.shape))
    physical, determinant = _physical(nodes, shared)
    r = nodes[..., 1] @ element.values.T
    weight = np.sqrt(determinant * element.weights * r)[..., None]
    a, b = physical[:, :, 0] * weight, physical[:, :, 1] * weight
    c = element.values * (weight / r[..., None])
    at, bt, ct = (v.transpose(0, 2, 1) for v in (a, b, c))
    return at @ a, bt @ b, ct @ c, at @ b, at @ c, bt @ c


def _physical(nodes: Floats, gradients: Floats) -> tuple[Floats, Floats]:
    """Gradients (ne, q, 2, m) by x and radius, and determinants (ne, q)."""
    J = gradients @ nodes[:, None]
    (a, b), (c, d) = np.moveaxis(J, (2, 3), (0, 1))
    determinant = a * d - b * c
    inverse = np.stack([np.stack([d, -b], -1), np.stack([-c, a], -1)], -2)
    return (inverse / determinant[..., None, None]) @ gradients, determinant


def _element_matrices(products: tuple[Floats, ...], lame: tuple[float, float], n: int) -> Floats:
    """From strains a u_x, b u_r, c (u_r + n u_t), b u_x + a u_r, a u_t - n c u_x and
    (b - c) u_t - n c u_r, per radian."""
    aa, _, cc, _, ac, bc = products
    lam, mu = lame
    m = aa.shape[1]
    K = np.zeros((len(aa), 3 * m, 3 * m))
    x, r, t = (slice(k * m, (k + 1) * m) for k in range(3))
    K[:, : 2 * m, : 2 * m] = _stretched(products, lame)
    K[:, t, t] = _twisted(products, lame)
    if n:
        ca, cb = (p.transpose(0, 2, 1) for p in (ac, bc))
        K[:, x, x] += (mu * n * n) * cc
        K[:, r, r] += (mu * n * n) * cc
        K[:, t, t] += ((lam + 2.0 * mu) * n * n) * cc
        K[:, x, t] = n * (lam * ac - mu * ca)
        K[:, r, t] = n * ((lam + 2.0 * mu) * cc + lam * bc - mu * (cb - cc))
        K[:, t, x] = K[:, x, t].transpose(0, 2, 1)
        K[:, t, r] = K[:, r, t].transpose(0, 2, 1)
    return K


def _stretched(products: tuple[Floats, ...], lame: tuple[float, float]) -> Floats:
    """(ne, 2 m, 2 m) of u_x and u_r in harmonic 0, per radian."""
    aa, bb, cc, ab, ac, bc = products
    lam, mu = lame
    m = aa.shape[1]
    K = np.empty((len(aa), 2 * m, 2 * m))
    K[:, :m, :m] = (lam + 2.0 * mu) * aa + mu * bb
    K[:, :m, m:] = lam * (ab + ac) + mu * ab.transpose(0, 2, 1)
    K[:, m:, :m] = K[:, :m, m:].transpose(0, 2, 1)
    K[:, m:, m:] = (lam + 2.0 * mu) * (bb + cc) + lam * (bc + bc.transpose(0, 2, 1)) + mu * aa
    return K


def _twisted(products: tuple[Floats, ...], lame: tuple[float, float]) -> Floats:
    """(ne, m, m) of u_t in harmonic 0, per radian."""
    aa, bb, cc, _, _, bc = products
    return np.asarray(lame[1] * (aa + bb - bc - bc.transpose(0, 2, 1) + cc))


def _on_axis(mesh: Meridian, n: int) -> tuple[Ints, Floats]:
    """Freedom (3 n_nodes,) that each one follows, and its share: what the axis allows.

    A solid body stays whole: for n = 0 its axis moves along itself, for n = 1 sideways, u_t = -u_r,
    for all others not at all.
    """
    target = np.arange(3 * len(mesh.nodes))
    coefficient = np.ones(len(target))
    axis = np.flatnonzero(mesh.nodes[:, 1] == 0.0)
    if n == 1:
        target[freedoms(axis, 2)] = freedoms(axis, 1)
        coefficient[freedoms(axis, 2)] = -1.0
    for component in {0: (1, 2), 1: (0,)}.get(n, (0, 1, 2)):
        coefficient[freedoms(axis, component)] = 0.0
    return target, coefficient


def _check_held(mesh: Meridian, n: int, which: Ints) -> None:
    motions = rigid_motions(mesh, n)
    if not motions.size:
        return
    scaled = motions / np.abs(motions).max(axis=0)
    grip = np.linalg.svd(scaled[which], compute_uv=False) if len(which) else np.zeros(1)
    if len(grip) < motions.shape[1] or grip.min() < 1e-9:
        names = ("along x and about x", "sideways and about its diameter")[n]
        raise InputError(
            f"the body of revolution is free to move {names} in harmonic {n}: hold at least "
            f"{motions.shape[1]} freedoms that stop this"
        )


def _assembled(matrices: Floats, rows: Ints, shares: Floats, size: int) -> sparse.csc_array:
    """Sum of element matrices (ne, k, k) whose freedoms are shares (ne, k) of rows (ne, k)."""
    scaled = (
        matrices if (shares == 1.0).all() else matrices * (shares[:, :, None] * shares[:, None])
    )
    i = np.broadcast_to(rows[:, :, None], matrices.shape).ravel()
    j = np.broadcast_to(rows[:, None, :], matrices.shape).ravel()
    values = scaled.ravel()
    if (shares == 0.0).any():
        kept = (shares != 0.0)[:, :, None] & (shares != 0.0)[:, None, :]
        i, j, values = i[kept.ravel()], j[kept.ravel()], values[kept.ravel()]
    return sparse.coo_array((values, (i, j)), shape=(size, size)).tocsc()


def _factor(K: sparse.csc_array) -> Any:
    return splu(
        K.tocsc(),
        permc_spec="MMD_AT_PLUS_A",
        diag_pivot_thresh=0.0,
        options={"SymmetricMode": True},
    )


def _between(
    mesh: Meridian,
    matrices: Floats,
    n: int,
    components: int,
    motions: Sequence[Motion],
) -> Floats:
    """Stiffness between motions of rigid faces; nodes inside elements are eliminated in each."""
    m, edge = mesh.cells.shape[1], mesh.element.corners * mesh.element.order
    matrices = _without_inside(matrices, components, m, edge)
    cells = mesh.cells[:, :edge]
    total = len(mesh.nodes)
    first = 3 - components if components == 1 else 0
    target, share = np.full((components, total), -1), np.ones((components, total))
    free = np.zeros((components, total), dtype=bool)
    free[:, cells] = True
    axis = np.flatnonzero(mesh.nodes[:, 1] == 0.0)
    _, coefficient = _on_axis(mesh, n)
    allowed = coefficient.reshape(-1, 3).T[first : first + components]
    free[allowed != 1.0] = False
    for nodes, _, _ in motions:
        free[:, nodes] = False
    count = int(free.sum())
    target[free] = np.arange(count)
    if n == 1:
        target[2, axis], share[2, axis] = target[1, axis], -1.0
    share[target < 0] = 0.0
    for nodes, number, amounts in motions:
        for component, amount in enumerate(amounts):
            if amount is not None:
                target[component, nodes], share[component, nodes] = count + number, amount
    local = (np.arange(components)[:, None] * total + cells[:, None]).reshape(len(cells), -1)
    size = count + 1 + max(number for _, number, _ in motions)
    K = _assembled(matrices, target.ravel()[local], share.ravel()[local], size)
    coupling = K[:count, count:].toarray()
    inside = _factor(K[:count, :count]).solve(coupling)
    condensed = K[count:, count:].toarray() - coupling.T @ inside
    return np.asarray(0.5 * (condensed + condensed.T))


def _without_inside(matrices: Floats, components: int, m: int, edge: int) -> Floats:
    """Element matrices (ne, k, k) without the nodes inside, from the edge-th of m on."""
    if edge == m:
        return matrices
    ne = len(matrices)
    blocks = matrices.reshape(ne, components, m, components, m)
    outer, inner = components * edge, components * (m - edge)
    inside = blocks[:, :, edge:, :, edge:].reshape(ne, inner, inner)
    between = blocks[:, :, edge:, :, :edge].reshape(ne, inner, outer)
    kept = blocks[:, :, :edge, :, :edge].reshape(ne, outer, outer)
    return kept - between.transpose(0, 2, 1) @ np.linalg.solve(inside, between)


def _by_side(mesh: Meridian, sides: Ints) -> list[tuple[int, Ints]]:
    numbers = range(mesh.element.corners)
    return [
        (side, sides[sides[:, 1] == side, 0]) for side in numbers if (sides[:, 1] == side).any()
    ]


def _located(mesh: Meridian, place: Floats) -> tuple[int, Floats]:
    """Cell and reference place of a position, by Newton's method in the cells near it."""
    nodes = mesh.nodes[mesh.cells]
    low, high = nodes.min(axis=1), nodes.max(axis=1)
    room = 0.2 * (high - low)
    near = np.flatnonzero(((place > low - room) & (place < high + room)).all(axis=1))
    best, least = (-1, np.zeros(2)), math.inf
    for cell in near:
        at = mesh.element.places[: mesh.element.corners].mean(axis=0)
        for _ in range(30):
            values, gradients = mesh.element.at(at[None])
            gap = place - values[0] @ nodes[cell]
            step = np.linalg.solve((gradients[0] @ nodes[cell]).T, gap)
            at = at + np.clip(step, -0.5, 0.5)
            if np.abs(step).max() < 1e-13:
                break
        bounds = [-at.min(), at.max() - 1.0 if mesh.element.corners == 4 else at.sum() - 1.0]
        if np.abs(gap).max() <= 1e-9 * np.ptp(nodes[cell], axis=0).max() and max(bounds) < least:
            best, least = (int(cell), at), max(bounds)
    if least > 1e-6:
        x, r = place
        raise InputError(f"x = {x:g} m, radius = {r:g} m is outside the meridian: move it inside")
    return best
