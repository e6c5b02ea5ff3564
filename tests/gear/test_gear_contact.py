"""Line contact of teeth: Hertz, the constants below the surface, published gearboxes."""

from math import asin, atan, cos, radians, sin, sqrt, tan

import numpy as np
import pytest
from scipy.integrate import quad, trapezoid

from fe_drivetrain.bearing.contact import line_pressure
from fe_drivetrain.cases.references.published_gears import nrel_750kw
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.gear.flank_stress import (
    LineContact,
    reduced_modulus,
    shear_stress,
    tooth_contact,
    von_mises,
)
from fe_drivetrain.gear.involute import Pair

STEEL = reduced_modulus()
CONTACT = LineContact(8e5, 0.03, STEEL)


def test_pressure_over_the_strip_is_the_load() -> None:
    a = CONTACT.half_width
    total = quad(lambda x: float(CONTACT.pressure_at(x)), -a, a)[0]
    assert total == pytest.approx(CONTACT.load, rel=1e-6)
    assert CONTACT.pressure == pytest.approx(2.0 * CONTACT.load / (np.pi * a))
    assert CONTACT.pressure == pytest.approx(a * STEEL / (2.0 * CONTACT.radius))
    # the same formula stands in the room of bearings
    assert line_pressure(np.array(8e5), 1.0 / 0.03) == pytest.approx(CONTACT.pressure)


def test_mean_curvature_in_place_of_the_radius_has_another_unit() -> None:
    # Eq 5.13 of Al-Hamadani 2018 in millimetres and in metres gives two pressures
    one, two = 0.04, 0.12
    as_printed = [
        sqrt(4.0 * 8e5 * 0.5 * (1.0 / (u * one) + 1.0 / (u * two)) / np.pi / STEEL) * u
        for u in (1.0, 1e3)
    ]
    assert as_printed[0] / as_printed[1] == pytest.approx(1e3**-0.5)
    right = [
        LineContact(8e5 / u, u / (1.0 / one + 1.0 / two), STEEL / u**2).half_width / u
        for u in (1.0, 1e3)
    ]
    assert right[0] == pytest.approx(right[1])


def test_constants_below_the_surface() -> None:
    shear, depth = CONTACT.max_shear
    assert shear / CONTACT.pressure == pytest.approx(0.3003, abs=5e-5)
    assert depth / CONTACT.half_width == pytest.approx(0.7862, abs=5e-5)
    mises, depth = CONTACT.max_von_mises()
    assert mises / CONTACT.pressure == pytest.approx(0.5575, abs=5e-5)
    assert depth / CONTACT.half_width == pytest.approx(0.704, abs=5e-4)
    # 0.57 as Al-Hamadani 2018 prints it belongs to a Poisson ratio below 0.3
    assert CONTACT.max_von_mises(0.28)[0] / CONTACT.pressure == pytest.approx(0.5657, abs=5e-5)


def test_stress_on_the_axis_is_that_of_the_printed_formulas() -> None:
    a, p = CONTACT.half_width, CONTACT.pressure
    z = np.array([1e-12, 0.3, 0.7862, 2.0]) * a
    xx, yy, zz, xz = CONTACT.stresses(0.0, z).T
    r = np.sqrt(1.0 + (z / a) ** 2)
    assert xx == pytest.approx(-p * ((1.0 + 2.0 * (z / a) ** 2) / r - 2.0 * z / a))
    assert yy == pytest.approx(-0.6 * p * (r - z / a))
    assert zz == pytest.approx(-p / r)
    assert not xz.any()
    assert [xx[0], zz[0]] == pytest.approx([-p, -p])


def test_stresses_off_the_axis_are_in_balance_and_meet_the_pressure() -> None:
    a, p, h = CONTACT.half_width, CONTACT.pressure, 1e-4 * CONTACT.half_width
    x, z = np.meshgrid(a * np.array([-1.5, -0.6, 0.2, 0.9]), a * np.array([0.3, 0.8, 1.7]))
    d_x = (CONTACT.stresses(x + h, z) - CONTACT.stresses(x - h, z)) / (2.0 * h)
    d_z = (CONTACT.stresses(x, z + h) - CONTACT.stresses(x, z - h)) / (2.0 * h)
    assert np.abs(d_x[..., 0] + d_z[..., 3]).max() < 1e-6 * p / a
    assert np.abs(d_x[..., 3] + d_z[..., 2]).max() < 1e-6 * p / a
    across = np.linspace(-0.95, 0.95, 7) * a
    assert -CONTACT.stresses(across, 1e-9 * a)[:, 2] == pytest.approx(
        CONTACT.pressure_at(across), rel=1e-6
    )
    # every depth carries the load
    deep = np.linspace(-400.0, 400.0, 400_001) * a
    carried = -trapezoid(CONTACT.stresses(deep, 0.7 * a)[:, 2], deep)
    assert carried == pytest.approx(CONTACT.load, rel=1e-4)


def test_the_shear_that_alternates_is_a_quarter_of_the_pressure() -> None:
    a, p = CONTACT.half_width, CONTACT.pressure
    x, z = np.meshgrid(np.linspace(0.7, 1.0, 61) * a, np.linspace(0.3, 0.7, 81) * a)
    alternating = np.abs(CONTACT.stresses(x, z)[..., 3])
    assert alternating.max() == pytest.approx(0.25 * p, rel=1e-4)
    where = np.unravel_index(alternating.argmax(), alternating.shape)
    assert x[where] / a == pytest.approx(sqrt(3.0) / 2.0, abs=0.006)
    assert z[where] / a == pytest.approx(0.5, abs=0.006)
    # no point off the axis is worse than the worst on it
    field = CONTACT.stresses(
        *np.meshgrid(np.linspace(-1.5, 1.5, 61) * a, np.linspace(0.2, 2, 61) * a)
    )
    assert shear_stress(field).max() <= CONTACT.max_shear[0] * (1.0 + 1e-9)
    assert von_mises(field).max() <= CONTACT.max_von_mises()[0] * (1.0 + 1e-9)


def grc() -> dict[str, tuple[Pair, float, float]]:
    """NREL 750 kW gearbox at 325 kN m: pair, force on the line of action, face width."""
    pairs, torque = nrel_750kw(), 325e3
    shaft = torque / (1.0 + 99.0 / 21.0)
    high = shaft * 23.0 / 82.0
    forces = {
        "sun": torque / 6.0 / 0.308 / cos(pairs["sun"].working_angle),
        "ring": torque / 6.0 / 0.308 / cos(pairs["ring"].working_angle),
        "intermediate": shaft / pairs["intermediate"].second.base_radius,
        "high speed": high / pairs["high speed"].second.base_radius,
    }
    return {name: (pairs[name], force, pairs[name].face_width) for name, force in forces.items()}


@pytest.mark.parametrize(
    ("name", "pressure", "depth"),
    [
        ("ring", 484, 0.87),
        ("sun", 1070, 0.41),
        ("intermediate", 1123, 0.46),
        ("high speed", 1200, 0.28),
    ],
)
def test_contact_stresses_of_the_750_kw_gearbox(name: str, pressure: float, depth: float) -> None:
    pair, force, width = grc()[name]
    found = tooth_contact(pair, pair.path.pitch, force / width, STEEL)
    assert round(found.pressure / 1e6) == pytest.approx(pressure, abs=0.6)
    assert round(found.max_shear[1] * 1e3, 2) == depth


def test_sun_over_ring_is_exact_for_equal_forces_and_widths() -> None:
    # tooth numbers of the thesis's drivetrain C: exactly the root of five; it prints 1.757
    angle = atan(tan(radians(20.0)) / cos(radians(8.0)))
    base = asin(sin(radians(8.0)) * cos(radians(20.0)))
    radii = [29, 58, -145]
    curvature = [1.0 / radii[0] + 1.0 / radii[1], 1.0 / radii[1] + 1.0 / radii[2]]
    found = [LineContact(1e6, tan(angle) / (c * cos(base)), STEEL).pressure for c in curvature]
    assert found[0] / found[1] == pytest.approx(sqrt(5.0))


def test_pressure_grows_with_the_root_of_the_load_and_a_plane_is_the_limit() -> None:
    assert LineContact(4.0 * 8e5, 0.03, STEEL).pressure == pytest.approx(2.0 * CONTACT.pressure)
    flat = LineContact(8e5, 1.0 / (1.0 / 0.03 + 1e-9), STEEL).pressure
    assert flat == pytest.approx(CONTACT.pressure, rel=1e-9)
    with pytest.raises(InputError, match="hollow"):
        LineContact(8e5, 1.0 / (1.0 / 0.03 - 1.0 / 0.02), STEEL)
