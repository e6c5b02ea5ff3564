import numpy as np
import pytest
from scipy.integrate import quad

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.materials import Material
from fe_drivetrain.shafts.beam.sections import (
    BeamSection,
    RigiditySection,
    cowper_shear_coefficient,
    element_integrals,
)

STEEL = Material(youngs_modulus=210e9, poisson_ratio=0.28, density=7850.0)


def test_cowper_solid_hollow_and_thin_wall_limits():
    # Cowper 1966, table 1: circle 6(1+nu)/(7+6nu), thin-walled round tube 2(1+nu)/(4+3nu).
    nu = 0.3
    assert cowper_shear_coefficient(nu) == pytest.approx(6 * 1.3 / 8.8, rel=1e-15)
    assert cowper_shear_coefficient(nu, 1.0) == pytest.approx(2 * 1.3 / 4.9, rel=1e-15)
    values = cowper_shear_coefficient(nu, np.linspace(0.0, 1.0, 20))
    assert np.all(np.diff(values) < 0.0)


@pytest.mark.parametrize(("nu", "ratio"), [(0.6, 0.0), (-1.0, 0.0), (0.3, 1.1)])
def test_cowper_refuses_what_is_no_section(nu, ratio):
    with pytest.raises(InputError):
        cowper_shear_coefficient(nu, ratio)


@pytest.mark.parametrize("ratio", [0.05, 0.5, 0.999, 1.001, 3.0, 20.0])
def test_solid_cone_against_closed_forms(ratio):
    # d(s) from the clamp; integrals of 1/d^2, 1/d^4 and (L-s)^2/d^4 in closed form.
    L, d0 = 2.3, 0.5
    d1 = ratio * d0
    E, G = STEEL.youngs_modulus, STEEL.shear_modulus
    result = element_integrals(
        BeamSection(L, d0, outer_diameter_end=d1), STEEL, False, 0.0, L
    ).flexibility
    assert result[0, 0] == pytest.approx(4 * L / (np.pi * E * d0 * d1), rel=1e-12)
    # (1/d0^3 - 1/d1^3)/(d1 - d0) without the cancellation.
    sums = (d0**2 + d0 * d1 + d1**2) / (d0 * d1) ** 3
    assert result[3, 3] == pytest.approx(32 * L / (3 * np.pi * G) * sums, rel=1e-12)
    tip = 64 * L**3 / (3 * np.pi * E * d1 * d0**3)
    assert result[2, 2] == pytest.approx(tip, rel=1e-12)
    assert result[1, 1] == pytest.approx(tip, rel=1e-12)
    assert result[5, 5] == pytest.approx(64 * L / (3 * np.pi * E) * sums, rel=1e-12)


def test_bored_taper_with_shear_and_weight_against_adaptive_quadrature():
    section = BeamSection(1.7, 0.9, 0.2, 0.5, 0.45)
    L, E, G, nu = 1.7, STEEL.youngs_modulus, STEEL.shear_modulus, STEEL.poisson_ratio

    def outer(s):
        return 0.9 - 0.4 * s / L

    def inner(s):
        return 0.2 + 0.25 * s / L

    def area(s):
        return np.pi / 4 * (outer(s) ** 2 - inner(s) ** 2)

    def inertia(s):
        return np.pi / 64 * (outer(s) ** 4 - inner(s) ** 4)

    def shear_area(s):
        return float(cowper_shear_coefficient(nu, inner(s) / outer(s))) * area(s)

    def along(f, a=0.0):
        return quad(f, a, L, epsabs=0.0, epsrel=1e-12)[0]

    result = element_integrals(section, STEEL, True, 0.0, L)
    f = result.flexibility
    tip = along(lambda s: (L - s) ** 2 / (E * inertia(s)) + 1 / (G * shear_area(s)))
    assert f[2, 2] == pytest.approx(tip, rel=1e-11)
    assert f[4, 2] == pytest.approx(-along(lambda s: (L - s) / (E * inertia(s))), rel=1e-11)
    rho = STEEL.density
    assert result.weight[0, 0] == pytest.approx(rho * along(area), rel=1e-12)
    moment = rho * along(lambda s: s * area(s))
    assert result.weight[5, 1] == pytest.approx(moment, rel=1e-12)
    assert result.weight[4, 2] == pytest.approx(-moment, rel=1e-12)

    def weight_moment(s):
        return along(lambda t: rho * (t - s) * area(t), s)

    def weight_beyond(s):
        return along(lambda t: rho * area(t), s)

    sag = along(
        lambda s: (
            (L - s) * weight_moment(s) / (E * inertia(s)) + weight_beyond(s) / (G * shear_area(s))
        )
    )
    assert result.sag[2, 2] == pytest.approx(sag, rel=1e-9)
    stretch = along(lambda s: weight_beyond(s) / (E * area(s)))
    assert result.sag[0, 0] == pytest.approx(stretch, rel=1e-9)


def test_rigid_section_does_not_yield_but_weighs():
    inf = np.inf
    result = element_integrals(
        RigiditySection(2.0, inf, inf, inf, inf, 30.0), STEEL, True, 0.0, 2.0
    )
    assert not result.flexibility.any()
    assert not result.sag.any()
    assert result.weight[2, 2] == pytest.approx(60.0)


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: BeamSection(0.0, 0.4), "length 0 m"),
        (lambda: BeamSection(np.nan, 0.4), "length nan m"),
        (lambda: BeamSection(1.0, -0.4), "diameter -0.4 m"),
        (lambda: BeamSection(1.0, 0.4, 0.4), "inner diameter 0.4 m"),
        (lambda: BeamSection(1.0, 0.4, 0.2, 0.1), "inner diameter 0.2 m"),
        (lambda: RigiditySection(1.0, 0.0, 1.0, 1.0, 1.0), "axial rigidity 0"),
        (lambda: RigiditySection(1.0, 1.0, 1.0, 1.0, 1.0, -1.0), "mass per length -1"),
    ],
)
def test_bad_sections_are_named(make, says):
    with pytest.raises(InputError, match=says):
        make()


def test_vanishing_wall_is_refused():
    section = BeamSection(1.0, 0.4, 0.1, 0.4, 0.4 * (1 - 1e-9))
    with pytest.raises(InputError, match="tapers too sharply"):
        element_integrals(section, STEEL, True, 0.0, 1.0)
