"""Bodies of revolution by harmonics: closed forms, rigid motions, and solids in space."""

import numpy as np
import pytest
from skfem import Basis, BilinearForm, ElementQuad2, ElementVector, MeshQuad

from fe_drivetrain.common.components import CYLINDRICAL_STRESSES
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.spatial import rigid_motions as solid_motions
from fe_drivetrain.drivetrain_file.materials import MATERIALS, Material
from fe_drivetrain.elasticity.mesh.hexahedra import shaft_hexahedra
from fe_drivetrain.elasticity.revolution.harmonics import (
    along_sides,
    dofs,
    element_matrices,
    harmonic_response,
    harmonic_solver,
    rigid_motions,
    stress_at,
    stresses,
    surface_loads,
    turn,
)
from fe_drivetrain.elasticity.revolution.meridian_mesh import meridian
from fe_drivetrain.elasticity.revolution.rigid_seats import (
    end_stiffness,
    seat_stiffness,
    stiffness_between_ends,
)
from fe_drivetrain.elasticity.solve.solid import solve_solid
from fe_drivetrain.geometry import Flange, Section, Shaft
from fe_drivetrain.geometry.meridian import outline

pytestmark = pytest.mark.usefixtures("kept_between_runs")

STEEL = MATERIALS["steel"]
CORK = Material(youngs_modulus=1e10, poisson_ratio=0.0, density=1000.0)

TUBE = Shaft(front=-2.0, sections=[Section(length=2.0, outer_diameter=0.7, inner_diameter=0.3)])
RING = Shaft(front=0.0, sections=[Section(length=0.1, outer_diameter=0.7, inner_diameter=0.3)])
ROD = Shaft(front=-2.0, sections=[Section(length=2.0, outer_diameter=0.7)])
STEPPED = Shaft(
    front=-2.0,
    sections=[
        Section(length=1.0, outer_diameter=0.7, inner_diameter=0.3),
        Section(length=1.0, outer_diameter=0.5, inner_diameter=0.3),
    ],
)
CONE = Shaft(front=0.0, sections=[Section(length=1.0, outer_diameter=0.8, outer_diameter_end=0.4)])
FILLETED = Shaft(
    front=0.0,
    sections=[
        Section(length=0.8, outer_diameter=0.6, fillet=0.05),
        Section(length=0.8, outer_diameter=0.4),
    ],
)
WILD = Shaft(
    front=-0.5,
    flange=Flange(outer_diameter=1.0, thickness=0.1),
    sections=[
        Section(length=1.0, outer_diameter=0.7, inner_diameter=0.3, outer_diameter_end=0.6),
        Section(length=0.5, outer_diameter=0.5, inner_diameter=0.2),
        Section(length=0.7, outer_diameter=0.8, outer_diameter_end=0.4),
    ],
)
SHAFTS = {"tube": TUBE, "rod": ROD, "stepped": STEPPED, "cone": CONE, "wild": WILD}
SHAFTS["filleted"] = FILLETED


def inertia(shaft):
    (piece,) = shaft.pieces
    return np.pi / 64 * (piece.outer_diameter**4 - piece.inner_diameter**4)


def area(shaft):
    (piece,) = shaft.pieces
    return np.pi / 4 * (piece.outer_diameter**2 - piece.inner_diameter**2)


def volume(mesh):
    """Of the body: integral of 2 pi r over the meridian."""
    nodes = mesh.nodes[mesh.cells]
    J = np.einsum("qkm,emi->eqik", mesh.element.gradients, nodes)
    r = nodes[..., 1] @ mesh.element.values.T
    return 2 * np.pi * float((np.linalg.det(J) * r * mesh.element.weights).sum())


def exact_volume(shaft):
    """Pappus, piece by piece of the outline: a cone's ring, and under an arc by quadrature."""
    total = 0.0
    for segment in outline(shaft):
        (x0, r0), (x1, r1) = segment.start, segment.end
        if segment.centre is None:
            total -= np.pi * (x1 - x0) * (r0 * r0 + r0 * r1 + r1 * r1) / 3
        else:
            cx, cr = segment.centre
            radius = np.hypot(x0 - cx, r0 - cr)
            a, b = np.arctan2(r0 - cr, x0 - cx), np.arctan2(r1 - cr, x1 - cx)
            b += 2 * np.pi * round((a - b) / (2 * np.pi))
            s, w = np.polynomial.legendre.leggauss(30)
            angle = a + (b - a) * (s + 1) / 2
            dx = -radius * np.sin(angle) * (b - a) / 2
            total -= np.pi * float((w * dx * (cr + radius * np.sin(angle)) ** 2).sum())
    return total


@pytest.mark.parametrize("name", SHAFTS)
def test_meridian_has_the_volume_of_the_shaft(name):
    mesh = meridian(SHAFTS[name])
    assert volume(mesh) == pytest.approx(exact_volume(SHAFTS[name]), rel=1e-8)


@pytest.mark.parametrize("name", ["stepped", "wild", "filleted"])
def test_neighbours_share_their_nodes(name):
    """Every side is the outline's or joins two cells, and the outline is closed and whole."""
    mesh = meridian(SHAFTS[name])
    assert len(np.unique(mesh.cells)) == len(mesh.nodes)
    assert len(np.unique(np.round(mesh.nodes, 10), axis=0)) == len(mesh.nodes)
    s, w = np.polynomial.legendre.leggauss(12)
    length = 0.0
    for cell, side in mesh.boundary:
        _, _, tangents = along_sides(mesh, side, np.array([cell]), (s + 1) / 2)
        length += float(np.linalg.norm(tangents[0], axis=1) @ w) / 2
    exact = 0.0
    for segment in outline(SHAFTS[name]):
        chord = np.hypot(*np.subtract(segment.end, segment.start))
        if segment.centre is None:
            exact += chord
        else:
            radius = np.hypot(*np.subtract(segment.start, segment.centre))
            exact += 2 * radius * np.arcsin(chord / (2 * radius))
    assert length == pytest.approx(exact, rel=1e-7)


@pytest.mark.parametrize("n", [0, 1, 2])
def test_element_matrices_are_those_of_scikit_fem(n):
    """Energy of a smooth field, against the generic assembly of the same strains."""
    mesh = meridian(STEPPED, 0.1, order=2, layers=0)
    corners = np.unique(mesh.cells[:, :4], return_inverse=True)
    quads = MeshQuad(mesh.nodes[corners[0]].T.copy(), corners[1].reshape(-1, 4).T.copy())
    basis = Basis(quads, ElementVector(ElementQuad2(), 3), intorder=12)
    lam, mu = STEEL.lame

    def field(x, r):
        return np.array([x * r - r**2, 1 + x**2 + r * x, 0.3 * x - r**2])

    @BilinearForm
    def stiffness(u, v, w):
        r = w.x[1]

        def strains(a):
            (x_x, x_r), (r_x, r_r), (t_x, t_r) = a.grad[0], a.grad[1], a.grad[2]
            x, ra, t = a
            normal = (x_x, r_r, (ra + n * t) / r)
            return normal, (x_r + r_x, t_x - n * x / r, t_r - t / r - n * ra / r)

        (e, g), (d, h) = strains(u), strains(v)
        energy = lam * sum(e) * sum(d) + 2 * mu * sum(a * b for a, b in zip(e, d, strict=True))
        return r * (energy + mu * sum(a * b for a, b in zip(g, h, strict=True)))

    component = np.empty(basis.N, dtype=int)
    for rows in (basis.nodal_dofs, basis.facet_dofs, basis.interior_dofs):
        component[rows] = (np.arange(len(rows)) % 3)[:, None]
    values = field(*basis.doflocs)[component, np.arange(basis.N)]
    reference = turn(n) * values @ (stiffness.assemble(basis) @ values)

    at = field(*mesh.nodes.T)[:, mesh.cells].transpose(1, 0, 2).reshape(len(mesh.cells), -1)
    energy = np.einsum("ea,eab,eb->", at, element_matrices(mesh, STEEL.lame, n), at)
    # 1 / r is integrated by other rules
    assert energy == pytest.approx(reference, rel=1e-7)


@pytest.mark.parametrize("name", ["stepped", "wild", "filleted"])
@pytest.mark.parametrize("n", [0, 1])
def test_rigid_motions_store_no_energy_and_give_no_stress(name, n):
    mesh = meridian(SHAFTS[name], layers=1)  # rounding grows as elements shrink
    strain = 1e-3
    for motion in rigid_motions(mesh, n).T:
        s = stresses(mesh, STEEL, n, strain * motion.reshape(-1, 3), mesh.element.points)
        assert np.abs(s).max() < 1e-9 * strain * STEEL.youngs_modulus
    held = mesh.where(lambda x, r: x < SHAFTS[name].front + 1e-9)
    which = np.concatenate([dofs(held, c) for c in range(3)])
    motions = rigid_motions(mesh, n)
    response = harmonic_response(mesh, STEEL, n, held=(which, motions[which]))
    np.testing.assert_allclose(response.u.reshape(-1, motions.shape[1]), motions, atol=1e-8)
    assert np.abs(response.energy).max() < 1e-12 * STEEL.youngs_modulus


@pytest.mark.parametrize("shaft", [TUBE, ROD])
def test_uniform_shaft_between_rigid_ends_is_gj_over_l(shaft):
    K = end_stiffness(shaft, STEEL)
    assert K[3, 3] == pytest.approx(STEEL.shear_modulus * 2 * inertia(shaft) / 2.0, rel=1e-10)
    cork = end_stiffness(shaft, CORK)
    assert cork[0, 0] == pytest.approx(1e10 * area(shaft) / 2.0, rel=1e-10)
    # pure bending: without contraction, plane ends stay plane
    flexibility = np.linalg.inv(cork[:6, :6])
    assert flexibility[5, 5] == pytest.approx(2.0 / (1e10 * inertia(shaft)), rel=1e-9)


@pytest.mark.parametrize("shaft", [TUBE, ROD])
def test_bending_by_its_exact_tractions_is_saint_venants(shaft):
    """sigma_xx = M r / I on both ends and nothing else: energy M^2 L / (2 E I), to rounding."""
    mesh = meridian(shaft, layers=1)
    moment = 1e6
    ends = [mesh.sides(lambda x, r, end=end: np.abs(x - end) < 1e-9) for end in (-2.0, 0.0)]
    loads = surface_loads(
        mesh,
        1,
        np.vstack(ends),
        lambda at, normal: np.column_stack(
            [moment / inertia(shaft) * at[:, 1] * normal[:, 0], 0 * at]
        ),
    )
    rear = mesh.where(lambda x, r: np.abs(x) < 1e-9)
    outer = rear[mesh.nodes[rear, 1].argmax()]
    held = np.array([dofs(outer, 0), dofs(outer, 1)])
    response = harmonic_response(mesh, STEEL, 1, loads, (held, np.zeros(2)))
    exact = moment**2 * 2.0 / (2 * STEEL.youngs_modulus * inertia(shaft))
    assert response.energy[0] == pytest.approx(exact, rel=1e-10)
    assert np.abs(response.reactions).max() < 1e-8 * moment
    s = stresses(mesh, STEEL, 1, response.u[..., 0], mesh.element.points)
    r = mesh.nodes[mesh.cells, 1] @ mesh.element.values.T
    # front and rear carry opposite moments, so that sigma_xx is one field
    largest = moment / inertia(shaft) * r.max()
    np.testing.assert_allclose(s[..., 0], moment / inertia(shaft) * r, atol=1e-8 * largest)
    assert np.abs(s[..., 1:]).max() < 1e-8 * largest


def test_thick_cylinder_under_pressure_is_lames():
    """Plane strain: sigma_rr, sigma_tt = A -+ B / r^2 (Lame 1852)."""
    a, b, inside = 0.15, 0.35, 1e8
    mesh = meridian(RING, 0.05, order=12, layers=0)
    bore = mesh.sides(lambda x, r: np.abs(r - a) < 1e-9)
    loads = surface_loads(
        mesh, 0, bore, lambda at, normal: -inside * np.insert(normal, 2, 0.0, axis=1)
    )
    ends = mesh.where(lambda x, r: (x < 1e-9) | (x > 0.1 - 1e-9))
    held = np.concatenate([dofs(ends, 0), dofs(ends[:1], 2)])
    response = harmonic_response(mesh, STEEL, 0, loads, (held, np.zeros(len(held))))
    A = inside * a**2 / (b**2 - a**2)
    B = A * b**2
    r = np.linspace(a, b, 7)
    s = stress_at(mesh, STEEL, 0, response.u[..., 0], np.column_stack([np.full(7, 0.03), r]))
    nu = STEEL.poisson_ratio
    exact = np.zeros((7, 6))
    exact[:, 1], exact[:, 2], exact[:, 0] = A - B / r**2, A + B / r**2, 2 * nu * A
    np.testing.assert_allclose(s, exact, atol=1e-7 * inside)
    bore_node = mesh.where(lambda x, r: np.abs(r - a) < 1e-9)
    E = STEEL.youngs_modulus
    moved = (1 + nu) / E * ((1 - 2 * nu) * A * a + B / a)
    np.testing.assert_allclose(response.u[bore_node, 1, 0], moved, rtol=1e-8)


def test_oval_ring_is_michells():
    """cos 2t pressure outside a thick ring in plane strain.

    Stress and displacement of r^2, r^4, r^-2 and 1 times cos 2t (Michell 1899; Barber 2010,
    Elasticity, tables 8.1 and 9.1).
    """
    a, b, outside = 0.15, 0.35, 1e7
    mu, kappa = STEEL.shear_modulus, 3 - 4 * STEEL.poisson_ratio

    def stress(r):  # rr, tt as cos 2t, rt as sin 2t, of each function
        r = np.asarray(r)
        rr = np.stack([-2 + 0 * r, 0 * r, -6 * r**-4, -4 * r**-2], -1)
        tt = np.stack([2 + 0 * r, 12 * r**2, 6 * r**-4, 0 * r], -1)
        rt = np.stack([2 + 0 * r, 6 * r**2, -6 * r**-4, -2 * r**-2], -1)
        return rr, tt, rt

    def displacement(r):
        ur = np.array([-2 * r, (kappa - 3) * r**3, 2 * r**-3, (kappa + 1) / r])
        ut = np.array([2 * r, (kappa + 3) * r**3, 2 * r**-3, -(kappa - 1) / r])
        return ur / (2 * mu), ut / (2 * mu)

    rows = np.array([stress(b)[0], stress(b)[2], stress(a)[0], stress(a)[2]])
    c = np.linalg.solve(rows, [-outside, 0.0, 0.0, 0.0])

    mesh = meridian(RING, 0.05, order=12, layers=0)
    rim = mesh.sides(lambda x, r: np.abs(r - b) < 1e-9)
    loads = surface_loads(
        mesh, 2, rim, lambda at, normal: -outside * np.insert(normal, 2, 0.0, axis=1)
    )
    ends = dofs(mesh.where(lambda x, r: (x < 1e-9) | (x > 0.1 - 1e-9)), 0)
    response = harmonic_response(mesh, STEEL, 2, loads, (ends, np.zeros(len(ends))))
    for radius in (a, 0.25, b):
        s = stress_at(mesh, STEEL, 2, response.u[..., 0], np.array([[0.05, radius]]))[0]
        found = [s[CYLINDRICAL_STRESSES.index(name)] for name in ("rr", "tt", "rt")]
        np.testing.assert_allclose(found, [f @ c for f in stress(radius)], atol=1e-7 * outside)
    for radius in (a, b):
        node = mesh.where(lambda x, r, at=radius: (np.abs(r - at) < 1e-9) & (x < 1e-9))[0]
        np.testing.assert_allclose(
            response.u[node, 1:, 0], [f @ c for f in displacement(radius)], rtol=1e-8
        )
    # and all the work of the pressure is stored
    work = 0.5 * float(loads @ response.u.reshape(-1))
    assert response.energy[0] == pytest.approx(work, rel=1e-10)


def test_twisted_cone_is_exact():
    """u_t = r / R^3, R the distance from the apex, is without stress on the cone's surface."""
    apex = 2.0  # radius 0.4 at x = 0, 0.2 at x = 1
    mesh = meridian(CONE, order=8, layers=0)
    x, r = mesh.nodes.T
    exact = r / np.hypot(x - apex, r) ** 3
    ends = mesh.where(lambda x, r: (x < 1e-9) | (x > 1 - 1e-9))
    held = np.concatenate([dofs(ends, 2), dofs(ends[:1], 0)])
    values = np.concatenate([exact[ends], [0.0]])
    response = harmonic_response(mesh, STEEL, 0, held=(held, values))
    np.testing.assert_allclose(response.u[:, 2, 0], exact, atol=1e-8 * exact.max())


@pytest.mark.parametrize("name", SHAFTS)
def test_end_stiffness_is_symmetric_with_six_rigid_motions(name):
    shaft = SHAFTS[name]
    K = end_stiffness(shaft, STEEL)
    scale = np.sqrt(np.diag(K))
    unit = K / np.outer(scale, scale)
    np.testing.assert_allclose(unit, unit.T, atol=1e-12)
    values = np.linalg.eigvalsh(unit)
    assert np.abs(values[:6]).max() < 1e-8
    assert values[6:].min() > 1e-4
    rigid = np.zeros((12, 6))
    for k, x in enumerate((shaft.front, shaft.rear)):
        rigid[6 * k : 6 * k + 6] = np.eye(6)
        rigid[6 * k + 1, 5], rigid[6 * k + 2, 4] = x, -x
    assert np.abs((K @ rigid) / scale[:, None]).max() < 1e-7 * scale.max()


def solid_stiffness(shaft, cut):
    """The same by hexahedra: energies of unit motions of the two faces."""
    solid = shaft_hexahedra(shaft, 0.4, 27, elements_per_turn=16 // cut, refinement=cut)
    ends = np.concatenate([solid.front, solid.rear])
    values = np.zeros((3 * len(ends), 12))
    first = 3 * len(solid.front)
    for rows, k, nodes, x in (
        (slice(0, first), 0, solid.front, shaft.front),
        (slice(first, None), 6, solid.rear, shaft.rear),
    ):
        values[rows, k : k + 6] = solid_motions(solid.points[nodes], np.array([x, 0.0, 0.0]))
    which = (3 * ends[:, None] + np.arange(3)).ravel()
    no_load = np.zeros(solid.points.size)
    found = solve_solid(solid.points, solid.cells, STEEL.lame, [], no_load, (which, values))
    return found.u.T @ (found.K @ found.u)


@pytest.mark.parametrize("name", ["stepped", "cone"])
def test_end_stiffness_is_that_of_hexahedra(name):
    """Halving the solid's elements takes away at least half of what it is too stiff by.

    But for what 16 parabolas round the axis leave of a cylinder, some 1e-4.
    """
    rough, fine = (solid_stiffness(SHAFTS[name], cut) for cut in (1, 2))
    found = end_stiffness(SHAFTS[name], STEEL)
    scale = np.sqrt(found.diagonal())
    unit = np.outer(scale, scale)
    changed, left = (rough - fine) / unit, (fine - found) / unit
    outline_left = 2e-4
    assert np.all(left.diagonal() <= changed.diagonal() + outline_left)
    assert np.abs(left).max() <= np.abs(changed).max()
    assert np.abs(changed).max() > 10 * outline_left
    # stiffer against every motion
    assert np.linalg.eigvalsh(left).min() > -outline_left


def test_stiffness_falls_as_elements_gain_freedom_and_settles():
    """The default is within 1e-5 of what two more orders and layers give."""
    rough, default, fine = (
        end_stiffness(STEPPED, STEEL, **settings).diagonal()
        for settings in ({"order": 3, "layers": 2}, {}, {"order": 8, "layers": 6})
    )
    assert np.all(default < rough)
    assert np.all(fine < default * (1 + 1e-12))
    np.testing.assert_allclose(default, fine, rtol=1e-5)


def test_curved_triangles_and_quadrilaterals_agree():
    """A fillet of a hair's breadth on the step: the stiffness is that of the sharp step.

    Fourth order leaves up to 1e-4 at such sizes. Triangles, and quadrilaterals with a curved side.
    """
    hair = 1e-4
    shaft = Shaft(
        front=-2.0,
        sections=[
            Section(length=1.0, outer_diameter=0.7, inner_diameter=0.3, fillet=hair),
            Section(length=1.0, outer_diameter=0.5, inner_diameter=0.3),
        ],
    )
    sharp = end_stiffness(STEPPED, STEEL)
    for per_fillet, corners in ((3, 3), (2, 4)):
        assert meridian(shaft, per_fillet=per_fillet).element.corners == corners
        filleted = end_stiffness(shaft, STEEL, per_fillet=per_fillet)
        np.testing.assert_allclose(filleted.diagonal(), sharp.diagonal(), rtol=1e-4)


#: Up and down, at a flange and at a taper; on a thick and on a thin wall.
ROUNDED = {
    "down": Shaft(
        front=0.0,
        sections=[
            Section(length=0.8, outer_diameter=0.7, inner_diameter=0.3, fillet=0.05),
            Section(length=0.7, outer_diameter=0.5, inner_diameter=0.3),
        ],
    ),
    "up, solid": Shaft(
        front=-1.0,
        sections=[
            Section(length=0.8, outer_diameter=0.4, fillet=0.06),
            Section(length=0.6, outer_diameter=0.7),
        ],
    ),
    "flange and taper": Shaft(
        front=0.0,
        flange=Flange(outer_diameter=1.0, thickness=0.1, fillet=0.08),
        sections=[
            Section(length=1.0, outer_diameter=0.7, inner_diameter=0.4, outer_diameter_end=0.6)
        ],
    ),
}


@pytest.mark.parametrize("name", ROUNDED)
def test_filleted_quadrilaterals_are_the_body_of_the_triangles(name):
    """Volume, and stiffness to what fourth-order triangles leave, 1e-6; the quadrilaterals 1e-5."""
    shaft = ROUNDED[name]
    mesh = meridian(shaft, per_fillet=2)
    assert mesh.element.corners == 4
    assert volume(mesh) == pytest.approx(exact_volume(shaft), rel=1e-9)
    few, many = (end_stiffness(shaft, STEEL, per_fillet=n) for n in (2, 6))
    scale = np.sqrt(many.diagonal())
    np.testing.assert_allclose(
        few / np.outer(scale, scale), many / np.outer(scale, scale), atol=1e-5
    )


def test_a_fillet_beside_a_thin_layer_gets_quadrilaterals():
    """The steps at both ends of the collar are 10 mm from each other in radius."""
    shaft = Shaft(
        front=0.0,
        sections=[
            Section(length=0.5, outer_diameter=0.2),
            Section(length=0.3, outer_diameter=0.5, fillet=0.02),
            Section(length=0.9, outer_diameter=0.22),
        ],
    )
    mesh = meridian(shaft, per_fillet=2)
    assert mesh.element.corners == 4
    assert volume(mesh) == pytest.approx(exact_volume(shaft), rel=1e-9)
    few, many = (
        end_stiffness(shaft, STEEL, size, order=order, per_fillet=n).diagonal()
        for size, order, n in ((0.06, 8, 2), (None, 5, 6))
    )
    np.testing.assert_allclose(few, many, rtol=1e-4)


def test_a_fillet_that_fills_its_step_gets_triangles():
    """Nothing of the step's face is left for a quadrilateral beside it."""
    shaft = Shaft(
        front=0.0,
        sections=[
            Section(length=0.5, outer_diameter=0.6, fillet=0.1),
            Section(length=0.5, outer_diameter=0.4),
        ],
    )
    assert meridian(shaft, per_fillet=2).element.corners == 3


def test_stress_on_the_axis_is_the_limit_towards_it():
    mesh = meridian(FILLETED)
    rear = mesh.where(lambda x, r: x > FILLETED.rear - 1e-9)
    front = mesh.where(lambda x, r: x < 1e-9)
    for n in (0, 1):
        which = np.concatenate([dofs(end, c) for end in (front, rear) for c in range(3)])
        values = np.zeros(len(which))
        values[-3 * len(rear) :] = 1e-3 * rigid_motions(mesh, n)[which[-3 * len(rear) :]].sum(
            axis=1
        )
        u = harmonic_response(mesh, STEEL, n, held=(which, values)).u[..., 0]
        on, beside = stress_at(mesh, STEEL, n, u, np.array([[0.81, 0.0], [0.81, 1e-7]]))
        np.testing.assert_allclose(on, beside, atol=1e-5 * np.abs(on).max())


@pytest.mark.parametrize("n", [0, 1, 2])
def test_a_factor_solves_what_a_response_does(n):
    """On a solid body, whose axis ties degrees of freedom, with what is held moved and not."""
    mesh = meridian(FILLETED, 0.3, order=3, layers=1, per_fillet=3)
    front = mesh.where(lambda x, r: x < 1e-9)
    held = np.concatenate([dofs(front, c) for c in range(3)])
    loads = np.random.default_rng(n).standard_normal((3 * len(mesh.nodes), 2))
    found = harmonic_solver(mesh, STEEL, n, held)(loads)
    response = harmonic_response(mesh, STEEL, n, loads, (held, np.zeros(len(held))))
    np.testing.assert_allclose(
        found, response.u.reshape(found.shape), atol=1e-12 * np.abs(found).max()
    )
    # work of the loads is twice the energy, and the two loads are reciprocal
    np.testing.assert_allclose(np.einsum("ik,ik->k", loads, found), 2 * response.energy, rtol=1e-9)
    work = loads.T @ found
    assert work[0, 1] == pytest.approx(work[1, 0], abs=1e-9 * np.abs(work).max())


def test_what_is_free_is_refused():
    mesh = meridian(TUBE)
    with pytest.raises(InputError, match="free to move along x and about x"):
        harmonic_response(mesh, STEEL, 0, held=(dofs(np.array([0]), 0), np.zeros(1)))
    with pytest.raises(InputError, match="free to move sideways"):
        harmonic_response(mesh, STEEL, 1)
    with pytest.raises(InputError, match="harmonic is -1"):
        harmonic_response(mesh, STEEL, -1)
    with pytest.raises(InputError, match="outside the meridian"):
        stress_at(mesh, STEEL, 0, np.zeros((len(mesh.nodes), 3)), np.array([[-1.0, 0.1]]))


@pytest.mark.parametrize(
    ("settings", "message"),
    [({"size": 0.0}, "size is 0"), ({"order": 1}, "order is 1"), ({"layers": -1}, "layers is -1")],
)
def test_wrong_settings_are_refused(settings, message):
    with pytest.raises(InputError, match=message):
        meridian(TUBE, **settings)
    with pytest.raises(InputError, match=r"order is 7 but must be between 2 and 6"):
        meridian(FILLETED, order=7)


def test_stiffness_of_a_mesh_is_that_of_its_response():
    """The condensed matrix against the whole problem solved with prescribed end motions."""
    mesh = meridian(WILD, order=4, layers=2)
    K = stiffness_between_ends(mesh, STEEL)
    front, rear = (
        mesh.where(lambda x, r, end=end: np.abs(x - end) < 1e-9) for end in (WILD.front, WILD.rear)
    )
    which = np.concatenate([dofs(end, c) for end in (front, rear) for c in range(3)])
    for n, rows in ((0, (0, 3)), (1, (1, 5))):
        motions = rigid_motions(mesh, n)
        values = np.zeros((len(which), 2))
        moved = which[: 3 * len(front)]
        values[: 3 * len(front)] = motions[moved]
        if n:  # about the face's own middle
            values[: 3 * len(front), 1] -= WILD.front * motions[moved, 0]
        energy = harmonic_response(mesh, STEEL, n, held=(which, values)).energy
        np.testing.assert_allclose(2 * energy, K[rows, rows], rtol=1e-9)


@pytest.mark.parametrize("name", ["stepped", "wild", "filleted"])
def test_end_faces_are_seats_like_any(name):
    shaft = SHAFTS[name]
    ends = [(shaft.front, shaft.front), (shaft.rear, shaft.rear)]
    K = end_stiffness(shaft, STEEL, layers=2)
    np.testing.assert_allclose(
        seat_stiffness(shaft, STEEL, ends, layers=2), K, atol=1e-12 * np.abs(K).max()
    )


def test_seats_are_held_together_by_the_shaft_alone():
    """Symmetric, with six motions without force; each seat stiffer where it is wider."""
    rows = []
    for wide in (0.1, 0.3):
        seats = [(-2.0, -2.0), (-1.7, -1.7 + wide), (-0.4, -0.4 + wide)]
        K = seat_stiffness(STEPPED, STEEL, seats)
        scale = np.sqrt(K.diagonal())
        unit = K / np.outer(scale, scale)
        np.testing.assert_allclose(unit, unit.T, atol=1e-12)
        rigid = np.vstack(
            [solid_motions(np.array([[(a + b) / 2, 0, 0]]), np.zeros(3)) for a, b in seats]
        )
        full = np.zeros((18, 6))
        for k, (a, b) in enumerate(seats):
            full[6 * k : 6 * k + 3] = rigid[3 * k : 3 * k + 3]
            full[6 * k + 3 : 6 * k + 6] = np.eye(3, 6, 3)
            assert full[6 * k + 2, 4] == -(a + b) / 2
        assert np.abs((K @ full) / scale[:, None]).max() < 1e-7 * scale.max()
        values = np.linalg.eigvalsh(unit)
        assert np.abs(values[:6]).max() < 1e-8
        assert values[6] > 1e-5
        rows.append(K[[9, 15], [9, 15]])
    assert np.all(rows[1] > rows[0])


@pytest.mark.parametrize("name", ["stepped", "filleted"])
def test_stiffness_of_a_seat_is_that_of_its_response(name):
    """The outer surface between two stations, moved as a rigid body, and the front face held."""
    shaft = SHAFTS[name]
    low, high = shaft.rear - 0.6, shaft.rear - 0.35
    outer = shaft.pieces[-1].outer_diameter / 2
    K = seat_stiffness(shaft, STEEL, [(shaft.front, shaft.front), (low, high)], order=4, layers=1)
    cut = Shaft(
        front=shaft.front,
        sections=[
            shaft.sections[0],
            *(
                shaft.sections[1].model_copy(update={"length": length})
                for length in (shaft.sections[1].length - 0.6, 0.25, 0.35)
            ),
        ],
    )
    corners = [(low, outer), (high, outer)]
    mesh = meridian(cut, order=4, layers=1, corners=corners)
    front = mesh.where(lambda x, r: np.abs(x - shaft.front) < 1e-9)
    seat = mesh.where(
        lambda x, r: (x > low - 1e-9) & (x < high + 1e-9) & (np.abs(r - outer) < 1e-9)
    )
    which = np.concatenate([dofs(nodes, c) for nodes in (front, seat) for c in range(3)])
    for n, numbers in ((0, (6, 9)), (1, (7, 11))):
        motions = rigid_motions(mesh, n)
        if n:  # about the seat's own middle
            motions[:, 1] -= (low + high) / 2 * motions[:, 0]
        values = np.zeros((len(which), 2))
        values[3 * len(front) :] = motions[which[3 * len(front) :]]
        energy = harmonic_response(mesh, STEEL, n, held=(which, values)).energy
        np.testing.assert_allclose(2 * energy, K[numbers, numbers], rtol=1e-9)


@pytest.mark.parametrize(
    ("seats", "message"),
    [
        ([(-1.2, -0.8), (0.0, 0.0)], "not on one section of the shaft"),
        ([(-3.0, -1.8), (0.0, 0.0)], "not on one section of the shaft"),
        ([(-1.5, -1.5), (0.0, 0.0)], "has no width"),
        ([(-1.2, -1.5), (0.0, 0.0)], "has no width"),
        ([(-1.8, -1.5), (-1.5, -1.3)], "two seats meet"),
        ([(-2.0, -2.0), (-2.0, -1.8)], "two seats meet"),
    ],
)
def test_wrong_seats_are_refused(seats, message):
    with pytest.raises(InputError, match=message):
        seat_stiffness(STEPPED, STEEL, seats, order=3, layers=0)
