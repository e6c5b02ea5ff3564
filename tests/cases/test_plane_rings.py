"""Exact plane solutions: they balance, they fit together, and they carry what they are said to."""

import numpy as np
import pytest

from fe_drivetrain.cases.references.plane_rings import (
    CurvedBar,
    Lame,
    Plane,
    Rotating,
    even_amplitudes,
    harmonics,
    inextensible_ring,
    interference_pressure,
    plane_strain,
)

PLANE = Plane(3.0, 0.3)
R = np.linspace(1.05, 1.95, 7)
STEP = 1e-5


def slope(field, r):
    return (field(r + STEP) - field(r - STEP)) / (2.0 * STEP)


def test_plane_strain_keeps_the_shear_modulus():
    assert pytest.approx(3.0 / 2.6, rel=1e-14) == plane_strain(3.0, 0.3).G


def test_lame_balances_and_strains_fit_the_displacement():
    ring = Lame(1.0, 2.0, inside=5.0, outside=2.0)
    assert ring.radial(np.array([1.0, 2.0])) == pytest.approx([-5.0, -2.0])
    balance = slope(ring.radial, R) + (ring.radial(R) - ring.hoop(R)) / R
    np.testing.assert_allclose(balance, 0.0, atol=1e-8)
    strain = (ring.radial(R) - PLANE.nu * ring.hoop(R)) / PLANE.E
    np.testing.assert_allclose(slope(lambda r: ring.displacement(r, PLANE), R), strain, rtol=1e-7)


def test_interference_closes_the_misfit():
    shaft, ring, soft = Lame(0.5, 1.0), Lame(1.0, 1.3), Plane(1.0, 0.2)
    p = interference_pressure(1e-3, shaft, ring, on=PLANE, of=soft)
    at = np.array(1.0)
    grows = Lame(1.0, 1.3, inside=p).displacement(at, soft)
    shrinks = Lame(0.5, 1.0, outside=p).displacement(at, PLANE)
    assert grows > 0.0 > shrinks
    assert grows - shrinks == pytest.approx(1e-3, rel=1e-12)


@pytest.mark.parametrize("plane", [PLANE, plane_strain(3.0, 0.3)])
def test_rotating_ring_balances_and_is_compatible(plane):
    ring = Rotating(1.0, 2.0, 0.7, plane)
    np.testing.assert_allclose(ring.radial(np.array([1.0, 2.0])), 0.0, atol=1e-14)
    balance = slope(ring.radial, R) + (ring.radial(R) - ring.hoop(R)) / R + 0.7 * R
    np.testing.assert_allclose(balance, 0.0, atol=1e-8)
    # u / r is the hoop strain, du / dr the radial one
    radial = ring.radial(R) - plane.nu * ring.hoop(R)
    stretch = slope(lambda r: r * (ring.hoop(r) - plane.nu * ring.radial(r)), R)
    np.testing.assert_allclose(stretch, radial, atol=1e-8)


def test_harmonics_balance_and_strains_fit_the_displacements():
    orders = np.array([2, 3, 7, 40])
    ring = harmonics(orders, 1.0, 2.0, np.array([1.0, 0.0, 2.0, 0.5]), np.array([0.3, 1.0, 0.0, 1]))
    for r, pressure in ((1.0, [1.0, 0.0, 2.0, 0.5]), (2.0, [0.3, 1.0, 0.0, 1.0])):
        radial, _, shear = ring.stress_amplitudes(r)
        np.testing.assert_allclose(radial, -np.array(pressure), atol=1e-12)
        np.testing.assert_allclose(shear, 0.0, atol=1e-12)
    for r in (1.1, 1.5, 1.9):
        stress = ring.stress_amplitudes(r)
        radial, hoop, shear = stress
        change = slope(ring.stress_amplitudes, r)
        size = 1e-6 * orders**3
        # equilibrium along the radius and round it
        along = change[0] + orders * shear / r + (radial - hoop) / r
        across = change[2] - orders * hoop / r + 2.0 * shear / r
        assert (np.abs(along) < size).all()
        assert (np.abs(across) < size).all()
        u, v = ring.displacement_amplitudes(r, PLANE)
        du, dv = slope(lambda x: ring.displacement_amplitudes(x, PLANE), r)
        np.testing.assert_allclose(du, (radial - PLANE.nu * hoop) / PLANE.E, atol=1e-6)
        hoop_strain = (u + orders * v) / r
        np.testing.assert_allclose(hoop_strain, (hoop - PLANE.nu * radial) / PLANE.E, atol=1e-9)
        np.testing.assert_allclose((-orders * u - v) / r + dv, shear / PLANE.G, atol=1e-6)


def test_fourier_amplitudes_give_the_load_back():
    def load(t):
        return np.where(np.abs(t) < 0.4, 1.0 + np.cos(np.pi * t / 0.4), 0.0)

    amplitude = even_amplitudes(load, 0.4, 300)
    t = np.array([0.0, 0.1, 0.3, 0.5, 1.5, np.pi - 0.2])
    found = np.cos(2.0 * np.arange(300) * t[:, None]) @ amplitude
    expected = load(np.minimum(t, np.pi - t))
    np.testing.assert_allclose(found, expected, atol=1e-4)


def integral(field, low=1.0, high=2.0):
    x, w = np.polynomial.legendre.leggauss(40)
    r = low + 0.5 * (high - low) * (1.0 + x)
    return 0.5 * (high - low) * float(w @ field(r))


def test_bending_of_a_curved_bar_is_compatible():
    # without body force the sum of the normal stresses is harmonic: a + b log r
    r = np.array([1.0, 1.25, 1.6, 2.0])
    trace = sum(CurvedBar(1.0, 2.0).bending(r, 5.0))
    slopes = np.diff(trace) / np.diff(np.log(r))
    np.testing.assert_allclose(slopes, slopes[0], rtol=1e-12)
    assert abs(slopes[0]) > 5.0


def test_bending_of_a_curved_bar_is_a_pure_moment_and_its_work_is_the_energy():
    bar = CurvedBar(1.0, 2.0)
    assert integral(lambda r: bar.bending(r, 5.0)[1]) == pytest.approx(0.0, abs=1e-12)
    moment = integral(lambda r: bar.bending(r, 5.0)[1] * r)
    # stretched inside
    assert moment == pytest.approx(-5.0, rel=1e-12)
    np.testing.assert_allclose(bar.bending(np.array([1.0, 2.0]), 5.0)[0], 0.0, atol=1e-12)
    balance = slope(lambda r: bar.bending(r, 5.0)[0], R)
    radial, hoop = bar.bending(R, 5.0)
    np.testing.assert_allclose(balance + (radial - hoop) / R, 0.0, atol=1e-7)

    def energy(r):
        radial, hoop = bar.bending(r, 5.0)
        return r * (radial**2 + hoop**2 - 2.0 * PLANE.nu * radial * hoop) / (2.0 * PLANE.E)

    rotation = bar.bending_rotation(5.0, PLANE)
    assert 0.5 * 5.0 * rotation == pytest.approx(integral(energy), rel=1e-12)


def test_a_flat_curved_bar_is_a_straight_one():
    bar = CurvedBar(1000.0, 1001.0)
    outside = float(bar.bending(np.array(1001.0), 1.0)[1])
    assert outside == pytest.approx(-6.0, rel=2e-3)
    assert float(bar.winkler(np.array(1001.0), 1.0)) == pytest.approx(-6.0, rel=2e-3)


def test_end_force_of_a_curved_bar_balances_is_compatible_and_has_its_resultant():
    bar = CurvedBar(1.0, 2.0)
    t, turn = 0.6, 1e-5
    radial, hoop, shear = bar.end_force(R, t, 5.0)
    along = slope(lambda r: np.array(bar.end_force(r, t, 5.0)), R)
    ahead, behind = (np.array(bar.end_force(R, t + s, 5.0)) for s in (turn, -turn))
    around = (ahead - behind) / (2.0 * turn)
    np.testing.assert_allclose(along[0] + around[2] / R + (radial - hoop) / R, 0.0, atol=1e-6)
    np.testing.assert_allclose(along[2] + around[1] / R + 2.0 * shear / R, 0.0, atol=1e-6)

    # without body force the sum of the normal stresses is harmonic; it varies as sin t
    def trace(r):
        return sum(bar.end_force(r, t, 5.0)[:2])

    step = 1e-3
    second = (trace(R + step) - 2.0 * trace(R) + trace(R - step)) / step**2
    first = (trace(R + step) - trace(R - step)) / (2.0 * step)
    np.testing.assert_allclose(second + first / R - trace(R) / R**2, 0.0, atol=1e-3)
    for r in (1.0, 2.0):
        radial, _, shear = bar.end_force(np.array(r), t, 5.0)
        assert (float(radial), float(shear)) == pytest.approx((0.0, 0.0), abs=1e-12)
    # towards the centre on the end at t = 0, whose outward normal is against t
    assert integral(lambda r: bar.end_force(r, 0.0, 5.0)[2]) == pytest.approx(5.0, rel=1e-12)


def test_a_thin_ring_hardly_stretches_under_waves_of_pressure():
    """The thinner the ring, the less is left out: as the wall over the radius, or faster."""
    n = np.array([2, 3])
    errors = []
    for wall in (0.02, 0.01):
        inner, outer = 1.0 - 0.5 * wall, 1.0 + 0.5 * wall
        exact = harmonics(n, inner, outer, np.zeros(2), np.ones(2))
        thin = inextensible_ring(n, inner, outer, 1.0, PLANE)
        errors.append(np.abs(exact.displacement_amplitudes(1.0, PLANE)[0] / thin - 1.0))
    assert np.all(errors[0] < 0.03)
    assert np.all(errors[1] < 0.6 * errors[0])
