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
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy import sparse

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.materials import Material
from fe_drivetrain.elasticity.revolution import frontal
from fe_drivetrain.elasticity.revolution.element_order import dissection
from fe_drivetrain.elasticity.revolution.meridian_mesh import Meridian
from fe_drivetrain.geometry import LENGTH_TOLERANCE

Traction = Callable[[Floats, Floats], Floats]
"""Function from positions (k, 2) [m] and outward normals, each x and radius, to amplitudes (k, 3)
[Pa]."""


@dataclass(frozen=True)
class HarmonicResponse:
    """Displacements of a body of revolution in one harmonic.

    Attributes
    ----------
    n : int
        The harmonic.
    u : Floats
        (n_nodes, 3, m) amplitudes of u_x, u_r, u_t [m].
    reactions : Floats
        (n_nodes, 3, m) nodal forces that hold what is held [N], over the whole turn.
    energy : Floats
        Strain energy (m,) [J].
    """

    n: int
    u: Floats
    reactions: Floats
    energy: Floats


def dofs(nodes: Ints, component: int) -> Ints:
    """Degrees of freedom of nodes along x (0), the radius (1) or the circumference (2)."""
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
    mesh : Meridian
        The meridian.
    material : Material
        Material of the body.
    n : int
        Order of the harmonic, 0 or more.
    loads : Floats or None
        Nodal forces (3 n_nodes,) or (3 n_nodes, m) over the whole turn [N], as `surface_loads`
        gives them; none where not given.
    held : tuple[Ints, Floats] or None
        Degrees of freedom (k,) and their displacements (k,) or (k, m) [m].

    Raises
    ------
    InputError
        The body is free to move as a rigid one.
    """
    _check_order(n)
    size = 3 * len(mesh.nodes)
    which = np.empty(0, dtype=np.int64) if held is None else np.asarray(held[0])
    values = np.zeros((0, 1)) if held is None else np.reshape(held[1], (len(which), -1))
    F = np.zeros((size, 1)) if loads is None else np.reshape(loads, (size, -1))
    m = max(F.shape[1], values.shape[1])
    F, values = np.broadcast_to(F, (size, m)), np.broadcast_to(values, (len(which), m))

    target, coefficient = on_axis(mesh, n)
    F = _onto(target, coefficient) @ F
    q = np.zeros((size, m))
    kept = coefficient[which] != 0
    given = target[which[kept]]
    q[given] = coefficient[which[kept], None] * values[kept]
    # forces of what is held: of the elements that it belongs to alone
    moved = np.zeros(size, dtype=bool)
    moved[given] = True
    local = _local(mesh)
    near = np.flatnonzero(moved[target[local]].any(axis=1))
    matrices = element_matrices(mesh, material.lame, n, near)
    local = local[near]

    def forces(q: Floats) -> Floats:
        found = np.zeros((size, m))
        u = coefficient[local][..., None] * q[target[local]]
        np.add.at(found, target[local], coefficient[local][..., None] * (matrices @ u))
        return found

    free = _factored(mesh, material, n, which)(F - forces(q))
    q[~moved] = free[~moved]
    held_by = forces(q)[given]
    reactions = np.zeros((size, m))
    reactions[given] = held_by - F[given]
    F[given] = held_by
    u = coefficient[:, None] * q[target]
    return HarmonicResponse(
        n,
        u.reshape(-1, 3, m),
        reactions.reshape(-1, 3, m),
        0.5 * np.einsum("im,im->m", q, F),
    )


def harmonic_solver(
    mesh: Meridian, material: Material, n: int, held: Ints
) -> Callable[[Floats], Floats]:
    """One harmonic factored once, to be solved for any loads.

    Parameters
    ----------
    mesh, material, n : Meridian, Material, int
        Meridian, material and harmonic, see `harmonic_response`.
    held : Ints
        Degrees of freedom (k,) that don't move.

    Returns
    -------
    Function from nodal forces (3 n_nodes, m) over the whole turn [N] to amplitudes (3 n_nodes, m)
    [m].

    Raises
    ------
    InputError
        The body is free to move as a rigid one.
    """
    target, coefficient = on_axis(mesh, n)
    onto = _onto(target, coefficient)
    solve = _factored(mesh, material, n, held)
    return lambda F: np.asarray(coefficient[:, None] * solve(onto @ F)[target])


def surface_loads(mesh: Meridian, n: int, sides: Ints, traction: Traction) -> Floats:
    """Nodal forces (3 n_nodes,) of a traction on sides of the boundary, over the whole turn [N].

    Parameters
    ----------
    mesh : Meridian
        The meridian.
    n : int
        The harmonic.
    sides : Ints
        Cell and side (k, 2), as `Meridian.sides` gives them.
    traction : Traction
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
    mesh, side, cells : Meridian, int, Ints
        The meridian, the number of the side, and (k,) cells.
    along : Floats
        Places (q,) from the side's first end, 0, to its second, 1; tangents are per unit of it.
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
    mesh, material, n : Meridian, Material, int
        Meridian, material and harmonic, see `harmonic_response`.
    u : Floats
        Amplitudes (n_nodes, 3) of the displacements [m].
    at : Floats
        Reference places (q, 2) in each element, or (k, q, 2), own ones of each.
    cells : Ints or None
        Numbers (k,) of the elements; all where not given.

    Returns
    -------
    (k, q, 6) in the order of `CYLINDRICAL_STRESSES` [Pa]; on the axis the limits.
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
        on_axis = r < LENGTH_TOLERANCE
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


def turn(n: int) -> float:
    """Integral of cos^2(n t) round the axis: that of 1 where n is 0."""
    return 2.0 * math.pi if n == 0 else math.pi


def element_matrices(
    mesh: Meridian, lame: tuple[float, float], n: int, cells: Ints | None = None
) -> Floats:
    """Stiffness (ne, 3 m, 3 m) of each element over the whole turn [N/m], or of those cells.

    Degrees of freedom u_x of all its m nodes, then u_r, then u_t. On the axis entries are large
    that cancel once its conditions hold.
    """
    grams = mesh.grams if cells is None else mesh.grams[cells]
    return np.asarray(turn(n) * frontal.element_matrices(grams, material_law(lame, n)))


def rigid_motions(mesh: Meridian, n: int, x: float = 0.0) -> Floats:
    """(3 n_nodes, k) motions without strain: n = 0 along x, about x; n = 1 along y, about z.

    The rotation about z is about the line along z through ``x`` [m] on the axis.
    """
    return rigid_motions_at(mesh.nodes - [x, 0.0], n).reshape(3 * len(mesh.nodes), -1)


def rigid_motions_at(places: Floats, n: int) -> Floats:
    """(p, 3, k) of `rigid_motions` at places (p, 2), x and radius [m]."""
    x, r = places.T
    one, zero = np.ones_like(x), np.zeros_like(x)
    motions = {
        0: [(one, zero, zero), (zero, zero, r)],
        1: [(zero, one, -one), (-r, x, -x)],
    }.get(n, [])
    return np.array(motions).reshape(len(motions), 3, len(x)).transpose(2, 1, 0)


def _physical(nodes: Floats, gradients: Floats) -> tuple[Floats, Floats]:
    """Gradients (ne, q, 2, m) by x and radius, and determinants (ne, q)."""
    J = gradients @ nodes[:, None]
    (a, b), (c, d) = np.moveaxis(J, (2, 3), (0, 1))
    determinant = a * d - b * c
    inverse = np.stack([np.stack([d, -b], -1), np.stack([-c, a], -1)], -2)
    return (inverse / determinant[..., None, None]) @ gradients, determinant


def material_law(lame: tuple[float, float], n: int) -> Floats:
    """(3, 3, 3, 3): of components p and q and derivatives s and t, per product of the latter.

    From strains a u_x, b u_r, c (u_r + n u_t), b u_x + a u_r, a u_t - n c u_x and
    (b - c) u_t - n c u_r.
    """
    strains = np.zeros((6, 3, 3))
    strains[0, 0, 0] = strains[1, 1, 1] = strains[2, 1, 2] = 1.0
    strains[3, 0, 1] = strains[3, 1, 0] = strains[4, 2, 0] = strains[5, 2, 1] = 1.0
    strains[2, 2, 2] = n
    strains[4, 0, 2] = strains[5, 1, 2] = -n
    strains[5, 2, 2] = -1.0
    lam, mu = lame
    elastic = np.diag([2.0 * mu] * 3 + [mu] * 3)
    elastic[:3, :3] += lam
    return np.asarray(np.einsum("aps,ab,bqt->pqst", strains, elastic, strains))


def on_axis(mesh: Meridian, n: int) -> tuple[Ints, Floats]:
    """Degree of freedom (3 n_nodes,) that each one follows, and its share: what the axis allows.

    A solid body stays whole: for n = 0 its axis moves along itself, for n = 1 sideways, u_t = -u_r,
    for all others not at all.
    """
    target = np.arange(3 * len(mesh.nodes))
    coefficient = np.ones(len(target))
    axis = np.flatnonzero(mesh.nodes[:, 1] == 0.0)
    if n == 1:
        target[dofs(axis, 2)] = dofs(axis, 1)
        coefficient[dofs(axis, 2)] = -1.0
    for component in {0: (1, 2), 1: (0,)}.get(n, (0, 1, 2)):
        coefficient[dofs(axis, component)] = 0.0
    return target, coefficient


def _check_order(n: int) -> None:
    if n < 0:
        raise InputError(f"harmonic is {n} but must be 0 or more: give its order round the axis")


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
            f"{motions.shape[1]} degrees of freedom that prevent this"
        )


def assembled(matrices: Floats, rows: Ints, shares: Floats, size: int) -> sparse.csc_array:
    """Sum of element matrices (ne, k, k), degrees of freedom shares (ne, k) of rows (ne, k)."""
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


def _onto(target: Ints, coefficient: Floats) -> sparse.csr_array:
    """Takes forces on all degrees of freedom to those that they follow."""
    size = len(target)
    return sparse.csr_array((coefficient, (target, np.arange(size))), shape=(size, size))


def _local(mesh: Meridian) -> Ints:
    """(ne, 3 m) degrees of freedom of each element, in the order of `element_matrices`."""
    return np.asarray(
        3 * np.tile(mesh.cells, 3) + np.repeat(np.arange(3), mesh.cells.shape[1]), dtype=np.int64
    )


def _factored(mesh: Meridian, material: Material, n: int, held: Ints) -> Callable[[Floats], Floats]:
    """Solver like `harmonic_solver`, in the degrees of freedom that others follow."""
    _check_order(n)
    _check_held(mesh, n, held)
    target, coefficient = on_axis(mesh, n)
    alive = coefficient != 0.0
    alive[np.isin(target, target[held])] = False
    local = _local(mesh).reshape(len(mesh.cells), 3, -1)
    ids, shares = np.where(alive, target, -1)[local], coefficient[local]
    order = dissection(mesh.nodes[mesh.cells].mean(axis=1))
    law = turn(n) * material_law(material.lame, n)

    def factor(components: slice) -> frontal.Factor:
        of = ids[:, components].reshape(len(ids), -1)
        by = shares[:, components].reshape(len(ids), -1)
        return frontal.factored(mesh.grams, law[components, components], of, by, order)

    # torsion has nothing to do with tension
    factors = [factor(c) for c in ((slice(0, 2), slice(2, 3)) if n == 0 else (slice(0, 3),))]
    return lambda F: np.asarray(sum(one.solve(F) for one in factors))


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
        # from its own corner: a cell far smaller than its place would be lost in round-off
        corner = nodes[cell, 0]
        for _ in range(30):
            values, gradients = mesh.element.at(at[None])
            gap = place - corner - values[0] @ (nodes[cell] - corner)
            step = np.linalg.solve((gradients[0] @ (nodes[cell] - corner)).T, gap)
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
