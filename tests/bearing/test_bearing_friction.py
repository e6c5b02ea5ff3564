"""Friction moments of bearings: limits, continuity, published coefficients, contact kinematics."""

from math import cos, pi, sin

import numpy as np
import pytest

from fe_drivetrain.bearing import (
    Bearing,
    catalogue_entry,
    cylindrical,
    ratings,
    read_bearing_catalogue,
    roller_loads,
    spherical_roller,
)
from fe_drivetrain.bearing.friction import (
    FrictionBearing,
    equivalent_friction_load,
    friction_bearing,
    palmgren_friction,
)
from fe_drivetrain.bearing.roller_friction import (
    LOST,
    _slid,
    pressure_coefficient,
    roller_friction,
)
from fe_drivetrain.bearing.skf_friction import (
    BOUNDARY,
    MINERAL_FILM,
    SERIES,
    STARTING,
    skf_friction,
    sliding_coefficient,
)
from fe_drivetrain.common.errors import InputError

OIL = 100e-6
NAMES = sorted(name for name, entry in read_bearing_catalogue().items() if entry.kind != "ball")


@pytest.mark.parametrize("name", NAMES)
def test_friction_is_finite_from_standstill_on_and_grows_with_the_load(name: str) -> None:
    bearing = friction_bearing(name, catalogue_entry(name))
    radial = np.array([0.0, 1e3, 1e4, 1e5, 1e6])
    for speed in (0.0, 1e-9, 1.0, 1e3, 1e6):
        for model in (palmgren_friction, skf_friction):
            found = model(bearing, radial, 0.1 * radial, speed, OIL)
            assert np.isfinite(found.total).all()
            assert (np.diff(found.total) > 0.0).all()
            assert (found.low <= found.total).all()
            assert (found.total <= found.high).all()


def test_only_the_size_of_speed_counts() -> None:
    bearing = friction_bearing("cylindrical_nu2220", catalogue_entry("cylindrical_nu2220"))
    for model in (palmgren_friction, skf_friction):
        forward, back = (model(bearing, 1e4, 0.0, w, OIL).total for w in (7.0, -7.0))
        assert forward == pytest.approx(back)


@pytest.mark.parametrize("kind", ["spherical_roller", "single_row_tapered", "ball"])
def test_the_equivalent_load_is_continuous_and_at_least_the_radial_force(kind: str) -> None:
    bearing = FrictionBearing("b", kind, 0.1, 0.2, 0.2)  # type: ignore[arg-type]
    axial = np.linspace(0.0, 3e4, 3001)
    found = equivalent_friction_load(bearing, 1e4, axial)
    assert np.abs(np.diff(found)).max() < 100.0
    assert (found >= 1e4).all()


def test_the_lubricants_moment_is_two_thirds_of_a_power_of_the_speed() -> None:
    bearing = FrictionBearing("b", "cylindrical", 0.1, 0.2)
    fast = [float(palmgren_friction(bearing, 0.0, 0.0, w, OIL).viscous) for w in (10.0, 80.0)]
    assert fast[1] / fast[0] == pytest.approx(8.0 ** (2.0 / 3.0))
    slow = [float(palmgren_friction(bearing, 0.0, 0.0, w, OIL).viscous) for w in (0.0, 1e-3)]
    assert slow[0] == slow[1] > 0.0


def test_sliding_goes_from_starting_to_a_full_film() -> None:
    bearing = FrictionBearing("b", "spherical_roller", 0.3, 0.5, 0.15, "231")
    at = sliding_coefficient(bearing, [0.0, 1e-6, 1e4], OIL)
    assert at == pytest.approx([STARTING, BOUNDARY, MINERAL_FILM])
    assert (np.diff(sliding_coefficient(bearing, np.geomspace(1e-3, 1e3, 50), OIL)) <= 0.0).all()


# SKF, Rolling bearings, p. 100: M = 0.5 mu P d at a tenth of the dynamic rating, normal operation
CONSTANT = {"NU22": 0.0011, "NCF": 0.0020, "329": 0.0018, "320X": 0.0018, "231": 0.0018}


@pytest.mark.parametrize(
    "name", ["cylindrical_nu2220", "cylindrical_sl181880", "tapered_pair_32948", "spherical_23180"]
)
def test_skfs_model_is_near_skfs_constant_coefficients(name: str) -> None:
    """Both are SKF's own: within a factor of two over speeds of normal operation."""
    entry = catalogue_entry(name)
    bearing, rating = friction_bearing(name, entry), ratings(entry.bearing(name))
    load, speed = 0.1 * rating.dynamic, 5.0 / bearing.mean_diameter
    moment = float(skf_friction(bearing, load, 0.0, speed, 30e-6).total)
    assert 0.5 < moment / (0.5 * CONSTANT[str(entry.series)] * load * bearing.bore) < 2.0


def test_a_roller_rolls_at_both_contacts_as_aihara_sums_them() -> None:
    """M = (Z / D) (R_o M_i + R_i M_o) of a bearing whose rollers carry the same (1987, eq. 8).

    With the ring preloaded evenly and nothing lost in steel, the film alone is left.
    """
    bearing = cylindrical("even", 20, 0.03, 0.03, 0.2, clearance=-10e-6)
    found = roller_friction(bearing, 0.0, 0.0, 20.0, OIL, 0.0)
    row = bearing.rows[0]
    stiff, alpha, eta = 206e9 / 0.91, pressure_coefficient(OIL), 870.0 * OIL
    inner, outer = row.radius - 0.015, row.radius + 0.015
    gamma = 0.03 / 0.2
    entrained = 0.015 * row.radius / 0.03 * (1.0 - gamma**2) * 20.0
    load = _even_load(bearing)
    moments = []
    for R in (1 / (1 / 0.015 + 1 / inner), 1 / (1 / 0.015 - 1 / outer)):
        U, W = eta * entrained / (stiff * R), load / 0.03 / (stiff * R)
        film = (alpha * stiff * U) ** 0.648 * W**0.246
        moments.append(58.4 * R**2 / alpha * film * 0.03)
    whole = 20 / 0.03 * (outer * moments[0] + inner * moments[1])
    assert float(found.viscous[0]) == pytest.approx(whole, rel=1e-6)


def _even_load(bearing: Bearing) -> float:
    return float(roller_loads(bearing, np.zeros((1, 5)))[0, 0])


def test_what_steel_loses_is_linear_in_its_share() -> None:
    entry = catalogue_entry("cylindrical_nu2220")
    found = roller_friction(entry.bearing("b"), 5e4, 0.0, 10.0, OIL, 0.05)
    low, taken, high = LOST
    slope = (found.high - found.total) / (high - taken)
    assert (found.total - found.low) / (taken - low) == pytest.approx(slope)


def test_spherical_rollers_slide_and_cylindrical_ones_do_not() -> None:
    for name, slides in (("spherical_23180", True), ("cylindrical_nu2220", False)):
        bearing = catalogue_entry(name).bearing(name)
        rolling, sliding = (roller_friction(bearing, 1e5, 0.0, 5.0, OIL, mu) for mu in (0.0, 0.1))
        assert (float(sliding.total[0]) > float(rolling.total[0]) * (1 + 1e-9)) == slides


def test_a_slip_that_is_even_is_no_slip() -> None:
    """A contact rolls with the median of its speeds: a pure spin gives mu Q L / 4 times it."""
    row = spherical_roller("b", 20, 0.05, 0.001, 0.4, 20.0, laminae=1000).rows[0]
    loads = np.full((1, 1, 1000), 1.0 / 1000)
    # so short a roller does not curve: both contacts spin, in sum at the rings' relative speed
    assert float(_slid(row, loads)[0]) == pytest.approx(abs(sin(row.angle)) * 0.001 / 4.0, rel=1e-2)


def test_wrong_bearings_are_refused() -> None:
    with pytest.raises(InputError, match="has no constants"):
        skf_friction(FrictionBearing("b", "cylindrical", 0.1, 0.2, 0.0, "240"), 1e3, 0, 1, OIL)
    with pytest.raises(InputError, match="has a contact angle above 0"):
        FrictionBearing("b", "spherical_roller", 0.1, 0.2)
    with pytest.raises(InputError, match="it has balls"):
        roller_friction(catalogue_entry("masta_ball").bearing("b"), 1e3, 0.0, 1.0, OIL, 0.1)
    with pytest.raises(InputError, match="static rating C0"):
        skf_friction(FrictionBearing("b", "ball", 0.1, 0.2), 1e3, 1e2, 1.0, OIL)


def test_a_seal_adds_its_moment_at_any_speed() -> None:
    opened = FrictionBearing("b", "spherical_roller", 0.3, 0.5, 0.15, "231")
    closed = FrictionBearing("b", "spherical_roller", 0.3, 0.5, 0.15, "231", 0.35)
    for speed in (0.0, 3.0):
        more = skf_friction(closed, 1e5, 1e4, speed, OIL).total
        assert more - skf_friction(opened, 1e5, 1e4, speed, OIL).total == pytest.approx(
            (0.057 * 350.0**2 + 50.0) / 1e3
        )


def test_every_series_of_a_kind_is_between_the_least_and_the_largest() -> None:
    unknown = FrictionBearing("b", "spherical_roller", 0.3, 0.5, 0.15)
    bounds = skf_friction(unknown, 2e5, 3e4, 2.0, OIL)
    for series in SERIES["spherical_roller"]:
        one = FrictionBearing("b", "spherical_roller", 0.3, 0.5, 0.15, series)
        assert bounds.low <= skf_friction(one, 2e5, 3e4, 2.0, OIL).total <= bounds.high


def test_sizes_come_of_the_outline() -> None:
    sizes = friction_bearing("b", catalogue_entry("cylindrical_nu2220"))
    assert (sizes.bore, sizes.outside) == pytest.approx((0.100, 0.180))
    assert sizes.mean_diameter == pytest.approx(0.140)
    assert cos(pi * sizes.contact_angle) == 1.0
