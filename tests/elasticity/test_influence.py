"""Influence functions: exact plane rings, reciprocity, equal pushes, balance, rollers."""

import numpy as np
import pytest

from fe_drivetrain.cases.fidelity.rollers_on_rings import RollerRing
from fe_drivetrain.cases.references.plane_rings import Lame, harmonics, plane_strain
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.materials import MATERIALS, Material
from fe_drivetrain.elasticity.revolution.harmonics import dofs
from fe_drivetrain.elasticity.revolution.influence import (
    Strip,
    carried,
    influence_functions,
    roller_forces,
)
from fe_drivetrain.elasticity.revolution.meridian_mesh import meridian
from fe_drivetrain.geometry import Section, Shaft

STEEL = MATERIALS["steel"]
INNER, OUTER, WIDTH = 0.3, 0.36, 0.1
RING = Shaft(
    front=0.0,
    sections=[Section(length=WIDTH, outer_diameter=2 * OUTER, inner_diameter=2 * INNER)],
)
OUTSIDE = Strip(OUTER, 0.0, WIDTH)
LAMINAE = [Strip(INNER, 0.01, 0.03), Strip(INNER, 0.03, 0.07), Strip(INNER, 0.07, 0.085)]
N = 24


@pytest.fixture(scope="module")
def mesh():
    return meridian(RING, 0.03, order=5, layers=1)


@pytest.fixture(scope="module")
def free(mesh):
    """The ring relative to its outside."""
    return influence_functions(mesh, STEEL, [*LAMINAE, OUTSIDE], N, 0.15, anchor=OUTSIDE)


def test_compliances_of_a_long_ring_are_michells():
    """In plane strain: u_x held everywhere. Sixth order is exact to 1e-8 for 3 waves an element."""
    mesh = meridian(RING, 0.02, layers=0)
    still = dofs(np.arange(len(mesh.nodes)), 0)
    bore = Strip(INNER, 0.0, WIDTH)
    # a strip may end inside an element: in plane strain all strips move as one
    strips = [bore, Strip(OUTER, 0.013, 0.055)]
    found = influence_functions(mesh, STEEL, strips, 12, 0.1, held=still, anchor=OUTSIDE)
    plane = plane_strain(STEEL.youngs_modulus, STEEL.poisson_ratio)
    n = np.arange(2, 13)
    pressure = 1.0 / (np.pi * INNER * WIDTH)
    exact = harmonics(n, INNER, OUTER, np.full(len(n), pressure), np.zeros(len(n)))
    for k, radius in enumerate((INNER, OUTER)):
        amplitude = exact.displacement_amplitudes(radius, plane)[0]
        np.testing.assert_allclose(found.harmonic_compliances[2:, k, 0], amplitude, rtol=1e-8)
        uniform = Lame(INNER, OUTER, inside=pressure / 2).displacement(np.array(radius), plane)
        assert found.harmonic_compliances[0, k, 0] == pytest.approx(float(uniform), rel=1e-10)


def test_pushes_are_reciprocal_and_do_work(free):
    angles = np.array([0.1, 0.5, 2.0, 4.4])
    matrix = free.matrix(angles)
    np.testing.assert_allclose(matrix, matrix.T, rtol=0, atol=1e-12 * np.abs(matrix).max())
    values = np.linalg.eigvalsh(matrix)
    assert values.min() > 1e-6 * values.max()


def test_equal_pushes_all_round_leave_harmonics_of_their_number(free):
    Z, m = 8, len(free.strips)
    matrix = free.matrix(2 * np.pi * np.arange(Z) / Z)
    moved = matrix.reshape(Z, m, Z, m).sum(axis=2)
    n = np.arange(0, N + 1, Z)
    expected = Z * np.tensordot(free.shares[n] ** 2, free.harmonic_compliances[n], axes=1)
    for each in moved:
        np.testing.assert_allclose(each, expected, rtol=1e-10)


def test_a_strip_is_the_mean_of_its_parts(mesh):
    """Its compliance is that of its two halves, pressed equally."""
    low, middle, high = 0.02, 0.037, 0.06
    parts = [Strip(INNER, low, middle), Strip(INNER, middle, high)]
    found = influence_functions(
        mesh, STEEL, [Strip(INNER, low, high), *parts], 6, 0.2, anchor=OUTSIDE
    ).harmonic_compliances
    share = np.array([middle - low, high - middle]) / (high - low)
    np.testing.assert_allclose(found[:, 0, 0], share @ found[:, 1:, 1:] @ share, rtol=1e-9)
    np.testing.assert_allclose(found[:, 0, 1:], share @ found[:, 1:, 1:], rtol=1e-9)


def test_a_strip_may_end_inside_an_element(mesh):
    """Elsewhere as on a mesh whose elements end with it; itself it moves a little less.

    The jump of the pressure is then smoothed by the element, which is stiffer.
    """
    strip = Strip(INNER, 0.021, 0.037)
    cut = meridian(RING.cut([strip.low, strip.high]), 0.03, order=5, layers=1)
    one, two = (
        influence_functions(m, STEEL, [strip, LAMINAE[2]], 20, 0.2, anchor=OUTSIDE)
        for m in (mesh, cut)
    )
    a, b = one.harmonic_compliances, two.harmonic_compliances
    np.testing.assert_allclose(a[:, 0, 1], b[:, 0, 1], rtol=1e-3)
    assert np.all(a[:, 0, 0] < b[:, 0, 0])


def test_a_profile_averages_to_the_patch(free):
    a = free.half_angle
    s, w = np.polynomial.legendre.leggauss(60)
    along = free.profile(0.7 + a * s, [0.2]).reshape(len(s), len(free.strips), -1)
    patch = free.matrix([0.7, 0.2])[: len(free.strips), len(free.strips) :]
    np.testing.assert_allclose(np.tensordot(w / 2, along, axes=1), patch, rtol=1e-9)


def test_the_tail_is_what_more_harmonics_add(mesh):
    """To the patch's own compliance, within a tenth: orders fall as 1 / n by then."""
    strips, few, many = LAMINAE[1:2], 40, 120
    fine = meridian(RING, 0.01, order=5, layers=0)
    one, two = (
        influence_functions(fine, STEEL, strips, k, 0.1, anchor=OUTSIDE) for k in (few, many)
    )
    added = (two.matrix([0.0]) - one.matrix([0.0]))[0, 0]
    assert added > 0
    assert one.tail[0] - two.tail[0] == pytest.approx(added, rel=0.1)


def test_forces_in_balance_do_not_feel_the_anchor(mesh):
    """Two feet and a push between them: the same deformation, whatever the anchor."""
    angles = np.array([0.0, 2.2, -2.0])
    rigid = np.column_stack([np.cos(angles), np.sin(angles)])
    found = [
        carried(
            influence_functions(mesh, STEEL, [LAMINAE[1]], 6, 0.2, anchor=anchor).matrix(angles),
            rigid,
            [1, 2],
        )[0, 0]
        for anchor in (OUTSIDE, Strip(INNER, 0.0, WIDTH))
    ]
    assert found[0] == pytest.approx(found[1], rel=1e-9)
    # twice the energy of the push with what the feet answer, by equilibrium
    forces = np.append(1.0, np.linalg.solve(rigid[1:].T, -rigid[0]))
    matrix = influence_functions(mesh, STEEL, [LAMINAE[1]], 6, 0.2, anchor=OUTSIDE).matrix(angles)
    assert found[0] == pytest.approx(forces @ matrix @ forces, rel=1e-9)


def test_a_rigid_housing_stiffens(mesh, free):
    outside = np.flatnonzero(np.abs(mesh.nodes[:, 1] - OUTER) < 1e-9)
    held = np.concatenate([dofs(outside, c) for c in range(3)])
    housed = influence_functions(mesh, STEEL, LAMINAE, N, 0.15, held=held)
    m = len(LAMINAE)
    softer = free.harmonic_compliances[2:, :m, :m] - housed.harmonic_compliances[2:]
    assert np.linalg.eigvalsh(softer).min() > 0


@pytest.mark.parametrize("exponent", [1.0, 10 / 9, 1.5])
def test_rollers_press_only_where_they_touch(free, exponent):
    angles = 2 * np.pi * np.arange(10) / 10
    m = len(free.strips)
    compliance = free.matrix(angles)[1::m, 1::m]
    approach = 1e-4 * np.cos(angles) - 1e-5
    k = 1e9 * (1e-4) ** (1 - exponent)
    forces = roller_forces(compliance, approach, k, exponent)
    gap = approach - compliance @ forces
    pressed = forces > 0
    assert 0 < pressed.sum() < len(angles)
    np.testing.assert_allclose(forces[pressed], k * gap[pressed] ** exponent, rtol=1e-9)
    assert gap[~pressed].max() <= 0
    rigid = roller_forces(0 * compliance, approach, k, exponent)
    np.testing.assert_allclose(rigid, k * np.maximum(approach, 0) ** exponent)
    assert forces.sum() < rigid.sum()


def test_a_shaft_bends_under_a_push_as_a_cantilever():
    """A solid one, slender: harmonic 1 is a force of 1 N. What is local is some 3e-4 of it.

    Without Poisson's ratio, for a clamp that hinders it stiffens the rod by a part of its diameter.
    """
    cork = Material(youngs_modulus=1e10, poisson_ratio=0.0, density=1000.0)
    length, diameter, width = 3.0, 0.3, 0.1
    rod = Shaft(front=0.0, sections=[Section(length=length, outer_diameter=diameter)])
    mesh = meridian(rod.cut([length - width]), 0.15, order=5, layers=2)
    front = mesh.where(lambda x, r: x < 1e-9)
    held = np.concatenate([dofs(front, c) for c in range(3)])
    strip = Strip(diameter / 2, length - width, length)
    found = influence_functions(mesh, cork, [strip], 3, 0.1, held=held).harmonic_compliances
    arm = length - width / 2
    area, inertia = np.pi * diameter**2 / 4, np.pi * diameter**4 / 64
    bends = arm**3 / (3 * cork.youngs_modulus * inertia)
    shears = arm * 7 / 6 / (cork.shear_modulus * area)
    assert found[1, 0, 0] == pytest.approx(bends + shears, rel=1e-3)
    assert 0 < found[2, 0, 0] < 1e-2 * found[1, 0, 0]


def test_what_cannot_be_is_refused(mesh):
    with pytest.raises(InputError, match="free to move sideways"):
        influence_functions(mesh, STEEL, LAMINAE, 2, 0.1)
    with pytest.raises(InputError, match=r"strip of radius 0\.3 m .* move or shorten"):
        influence_functions(mesh, STEEL, [Strip(INNER, 0.05, 0.2)], 2, 0.1, anchor=OUTSIDE)
    with pytest.raises(InputError, match="harmonics is 0"):
        influence_functions(mesh, STEEL, LAMINAE, 0, 0.1, anchor=OUTSIDE)
    with pytest.raises(InputError, match="half_angle is 0"):
        influence_functions(mesh, STEEL, LAMINAE, 2, 0.0, anchor=OUTSIDE)
    with pytest.raises(InputError, match="anchor of radius"):
        influence_functions(mesh, STEEL, LAMINAE, 2, 0.1, anchor=Strip(0.9, 0.0, WIDTH))
    with pytest.raises(InputError, match="leave the body free to move"):
        carried(np.eye(3), np.ones((3, 2)), [0, 1])
    with pytest.raises(InputError, match=r"exponent 0\.5"):
        roller_forces(np.eye(1), np.ones(1), 1.0, 0.5)


def test_rollers_on_a_rigid_ring_carry_as_stribeck_has_it() -> None:
    """Linear springs on half of the raceway: the most loaded roller carries 4 times the mean."""
    ring = RollerRing(0.35, 0.4, 0.16, 0.12, 24, MATERIALS["steel"])
    found = ring.press(np.zeros((24, 24)), 1e6, 2e9, 1.0)
    assert found.factor == pytest.approx(4.0, rel=1e-9)
    assert found.forces @ np.sin(ring.angles) == pytest.approx(0.0, abs=1e-6)
    assert found.down == pytest.approx(found.forces.max() / 2e9)
