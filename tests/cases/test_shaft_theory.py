"""Exact answers for shafts that the verification cases rest on: each fulfils its own equations."""

import numpy as np
import pytest

from fe_drivetrain.cases.references.shaft_theory import (
    Tube,
    chain_frequencies,
    evenly_loaded_shear,
    extra_curvature,
    flexure_field,
    flexure_stress,
    michell_torque,
    missed_at_held_edge,
    parabola_shortfall,
    pure_bending_field,
    rod_frequency,
    two_mass_frequencies,
    within_arcs,
)
from fe_drivetrain.cases.references.solid_shafts import (
    on_springs,
    sectional_compliance,
    solid,
    straight,
)
from fe_drivetrain.cases.references.sprung_beams import Spring, macaulay
from fe_drivetrain.cases.references.torsion_meridian import torsion_bounds
from fe_drivetrain.drivetrain_file.materials import MATERIALS
from fe_drivetrain.geometry import Section, Shaft
from fe_drivetrain.shafts.beam.beam import Beam, Support
from fe_drivetrain.shafts.beam.sections import BeamSection
from fe_drivetrain.shafts.beam.shaft import unit_load_response

STEEL = MATERIALS["steel"]
TUBES = [Tube(0.4, bore, 1.5, STEEL) for bore in (0.0, 0.2, 0.36)]


def section_points(tube, n_radii=8, n_angles=32, x=0.4):
    """Points (r, t, 3) and weights (r, t) [m^2] over a section."""
    t, w = np.polynomial.legendre.leggauss(n_radii)
    a, b = tube.outer / 2, tube.inner / 2
    r = 0.5 * (a - b) * (t + 1) + b
    angle = 2 * np.pi * np.arange(n_angles) / n_angles
    y, z = r[:, None] * np.sin(angle), r[:, None] * np.cos(angle)
    points = np.stack([np.full_like(y, x), y, z], axis=-1)
    return points, np.outer(w * 0.5 * (a - b) * r, np.full(n_angles, 2 * np.pi / n_angles))


def stress_of(field, points, step=1e-4):
    """Stress by central differences of a displacement field."""
    gradient = np.empty((len(points), 3, 3))
    for j in range(3):
        ahead, behind = points.copy(), points.copy()
        ahead[:, j] += step
        behind[:, j] -= step
        gradient[:, :, j] = (field(ahead) - field(behind)) / (2 * step)
    strain = 0.5 * (gradient + np.swapaxes(gradient, 1, 2))
    lam, mu = STEEL.lame
    trace = np.trace(strain, axis1=1, axis2=2)
    return 2 * mu * strain + lam * trace[:, None, None] * np.eye(3)


def components(stress):
    return np.stack([stress[:, i, j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0))])


@pytest.mark.parametrize("tube", TUBES)
def test_flexure_stress_is_that_of_its_displacements(tube):
    points = section_points(tube)[0].reshape(-1, 3)
    given = flexure_stress(points, 1e6, tube).T
    found = components(stress_of(lambda p: flexure_field(p, 1e6, tube), points))
    np.testing.assert_allclose(found, given, atol=1e-5 * np.abs(given).max())


@pytest.mark.parametrize("tube", TUBES)
def test_flexure_leaves_surfaces_free_and_carries_the_force(tube):
    points, weights = section_points(tube)
    s = flexure_stress(points.reshape(-1, 3), 1e6, tube).reshape(*weights.shape, 6)
    assert (weights * s[..., 5]).sum() == pytest.approx(1e6, rel=1e-12)
    moment = (weights * points[..., 2] * s[..., 0]).sum()
    assert moment == pytest.approx(-1e6 * (tube.length - 0.4), rel=1e-12)
    angle = np.linspace(0, 2 * np.pi, 13)
    for r in {tube.outer / 2, tube.inner / 2} - {0.0}:
        y, z = r * np.sin(angle), r * np.cos(angle)
        s = flexure_stress(np.column_stack([0 * y, y, z]), 1e6, tube)
        radial = (s[:, 3] * y + s[:, 5] * z) / r
        np.testing.assert_allclose(radial, 0.0, atol=1e-9 * np.abs(s).max())


@pytest.mark.parametrize("tube", TUBES)
def test_flexure_is_in_equilibrium(tube):
    points = section_points(tube)[0][2:6].reshape(-1, 3)
    step = 1e-5

    def along(axis):
        ahead, behind = points.copy(), points.copy()
        ahead[:, axis] += step
        behind[:, axis] -= step
        difference = flexure_stress(ahead, 1.0, tube) - flexure_stress(behind, 1.0, tube)
        return difference / (2 * step)

    balance = along(0)[:, 0] + along(1)[:, 3] + along(2)[:, 5]
    assert np.abs(balance).max() < 1e-6 * np.abs(along(0)[:, 0]).max()


@pytest.mark.parametrize("tube", TUBES)
def test_means_of_flexure_have_cowpers_shear(tube):
    def means(x):
        points, w = section_points(tube, x=x)
        u = flexure_field(points.reshape(-1, 3), 1.0, tube).reshape(*w.shape, 3)
        z = points[..., 2]
        return (w * u[..., 2]).sum() / tube.area, -(w * z * u[..., 0]).sum() / tube.inertia

    (w0, slope), (w1, _) = means(0.0), means(tube.length)
    tip = w1 - w0 - slope * tube.length
    L = tube.length
    assert tip == pytest.approx(L**3 / (3 * tube.EI) + L / tube.kGA, rel=1e-12)


def test_pure_bending_has_one_stress():
    points = section_points(TUBES[1])[0].reshape(-1, 3)
    stress = stress_of(lambda p: pure_bending_field(p, 1e-3, 0.3), points)
    expected = np.zeros_like(stress)
    expected[:, 0, 0] = -STEEL.youngs_modulus * 1e-3 * points[:, 2]
    np.testing.assert_allclose(stress, expected, atol=1e-6 * np.abs(expected).max())


def test_extra_curvature_of_a_solid_circle():
    nu, a = STEEL.poisson_ratio, 0.2
    # the moments of Saint-Venant's shear over a circle, by hand
    expected = nu * (1 + 2 * nu) * a**2 / (12 * (1 + nu)) / TUBES[0].EI
    assert extra_curvature(TUBES[0]) == pytest.approx(expected, rel=1e-12)


def test_evenly_loaded_circle_has_hutchinsons_coefficient():
    nu, tube = STEEL.poisson_ratio, TUBES[0]
    k = evenly_loaded_shear(tube) / (STEEL.shear_modulus * tube.area)
    assert k == pytest.approx(6 * (1 + nu) ** 2 / (7 + 12 * nu + 4 * nu**2), rel=1e-12)


def test_michell_torque_of_a_slender_cone_is_the_elementary_one():
    angle = 1e-2
    elementary = 1.5 * np.pi * np.tan(angle) ** 4
    assert michell_torque(angle, 1.0) / elementary == pytest.approx(1 - 5 / 3 * angle**2, rel=1e-6)


def test_macaulay_against_closed_forms():
    L, EI, kGA = 3.0, 2e8, 4e9
    ends = [Spring(0.0, np.inf), Spring(L, np.inf)]
    found = macaulay(L, EI, kGA, ends, [(L / 2, 1e5, 0.0)], [L / 2])
    expected = 1e5 * (L**3 / (48 * EI) + L / (4 * kGA))
    np.testing.assert_allclose(found.deflection, expected, rtol=1e-12)
    np.testing.assert_allclose(found.forces, -5e4, rtol=1e-12)
    clamp = [Spring(0.0, np.inf, np.inf)]
    found = macaulay(L, EI, kGA, clamp, [(L, 0.0, 1e5)], [L], load_per_length=2e4)
    weight = 2e4 * (L**4 / (8 * EI) + L**2 / (2 * kGA))
    np.testing.assert_allclose(found.deflection, weight + 1e5 * L**2 / (2 * EI), rtol=1e-12)
    np.testing.assert_allclose(found.moments, -1e5 - 2e4 * L**2 / 2, rtol=1e-12)


def test_three_rigid_supports_share_a_load_as_the_three_moment_equation_says():
    # two equal spans under q, no shear: the middle support carries 10/8 of a span's load
    ends = [Spring(x, np.inf) for x in (0.0, 2.0, 4.0)]
    found = macaulay(4.0, 1e7, np.inf, ends, [], [0.0], load_per_length=-1e3)
    np.testing.assert_allclose(found.forces, [750.0, 2500.0, 750.0], rtol=1e-10)


@pytest.mark.parametrize("bore", [0.0, 0.2])
def test_torsion_bounds_hold_the_exact_stiffness(bore):
    tube = Tube(0.4, bore, 0.5, STEEL)
    bounds = torsion_bounds(straight((0.0, 0.5), 0.4, bore), STEEL.shear_modulus, 0.1)
    exact = tube.GJ / tube.length
    assert bounds.upper == pytest.approx(exact, rel=1e-10)
    # phi = (r^4 - b^4) / (a^4 - b^4) is one of the functions of fourth order
    assert bounds.lower == pytest.approx(exact, rel=1e-10)


@pytest.mark.parametrize("bore", [0.0, 0.1])
def test_torsion_bounds_close_in_on_a_stepped_shaft(bore):
    shaft = Shaft(
        front=0.0,
        sections=[Section(length=0.3, outer_diameter=D, inner_diameter=bore) for D in (0.4, 0.25)],
    )
    coarse, fine = (torsion_bounds(shaft, 1.0, 0.1, halvings) for halvings in (0, 6))
    assert coarse.lower < fine.lower < fine.upper < coarse.upper
    assert fine.half_width < 1e-4 * fine.middle


def test_a_circle_of_parabolas_falls_short_as_the_formula_says():
    mesh = solid(straight((0.0, 0.3), 0.4), 3)
    facets = mesh.section_facets(0.0)
    from fe_drivetrain.elasticity.mesh.facets import face_weights

    area = face_weights(mesh.points, facets, len(mesh.points)).sum() / (np.pi * 0.04)
    assert 1 - area == pytest.approx(2 * parabola_shortfall(12), rel=0.02)


def test_a_field_that_elements_do_not_hold_may_miss_half_as_much_again():
    within, why = within_arcs(12, "J", 4)
    more, _ = within_arcs(12, "J", 4, held=False)
    assert within == pytest.approx(8 * parabola_shortfall(12))
    assert more == pytest.approx(1.5 * within)
    assert why.startswith("12 parabolic arcs round a turn: J is ")


def test_half_as_long_elements_at_a_held_edge_miss_2_6_times_less():
    coarse, fine = (missed_at_held_edge(edge)[0] for edge in (0.1, 0.05))
    assert coarse / fine == pytest.approx(2 ** (2 * 0.7))


def test_sectional_compliance_is_symmetric_and_a_cantilevers():
    stations = (0.0, 1.2, 2.4)
    C = sectional_compliance(solid(straight(stations, 0.4), 2), STEEL, stations)
    flat = C.matrix.reshape(6, 6)
    np.testing.assert_allclose(flat, flat.T, atol=1e-9 * np.abs(flat).max())
    beam = Beam([BeamSection(2.4, 0.4)], [Support("root", 0.0, [np.inf] * 6)], material=STEEL)
    unit = unit_load_response(beam, stations, stations)
    expected = unit.displacement[:, [2, 4]][:, :, :, [2, 4]]
    # the mesh's section, 8 parabolas, is 0.2 % too soft; loads enter evenly over their sections
    np.testing.assert_allclose(C.matrix, expected, rtol=5e-3, atol=1e-14)
    expected_sag = unit.gravity_displacement[:, [2, 4], 2]
    np.testing.assert_allclose(C.weight, expected_sag, rtol=5e-3, atol=1e-12)


def test_solid_on_rigid_supports_balances_its_loads():
    stations = (0.0, 1.2, 2.4)
    C = sectional_compliance(solid(straight(stations, 0.4), 1), STEEL, stations)
    stiffness = [(0.0, 0.0), (np.inf, 0.0), (2e8, 1e6)]
    found = on_springs(C, stiffness, [(1e5, 2e4), (0.0, 0.0), (0.0, 0.0)], -9.81)
    weight = -9.81 * C.weight_resultant[0]
    assert found.reactions[:, 0].sum() == pytest.approx(-1e5 - weight, rel=1e-8)
    assert abs(found.motions[1, 0]) < 1e-12
    np.testing.assert_allclose(
        found.reactions[2], -np.array([2e8, 1e6]) * found.motions[2], rtol=1e-8
    )


def test_frequencies():
    free, fixed = two_mass_frequencies(2e9, 1e8, 3e6)
    np.testing.assert_allclose(chain_frequencies([1e8, 3e6], [2e9]), [0.0, free], atol=1e-6)
    np.testing.assert_allclose(chain_frequencies([1e8], [], 2e9), [fixed], rtol=1e-12)
    # a shaft of hardly any inertia, and one cut into many pieces
    assert rod_frequency(2e9, 1.0, 1e8, 3e6) == pytest.approx(free, rel=1e-6)
    n = 400
    pieces = np.full(n + 1, 1e6 / n)
    pieces[[0, -1]] = 0.5e6 / n + np.array([1e8, 3e6])
    cut = chain_frequencies(pieces, np.full(n, 2e9 * n))[1]
    assert rod_frequency(2e9, 1e6, 1e8, 3e6) == pytest.approx(cut, rel=1e-5)
