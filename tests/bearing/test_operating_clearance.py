"""From initial to operating clearance: closed forms, invariances, and what bands cover."""

from dataclasses import replace
from itertools import pairwise
from math import cos, inf, pi, radians, sin

import numpy as np
import pytest
from pydantic import ValidationError

from fe_drivetrain.bearing import catalogue_entry, forces
from fe_drivetrain.bearing.catalogue import fitted_entry
from fe_drivetrain.bearing.catalogue_page import CataloguePage
from fe_drivetrain.bearing.entry_clearance import entry_clearance, normal_of
from fe_drivetrain.bearing.mounting import Fit, Mounting, Temperatures
from fe_drivetrain.bearing.operating_clearance import (
    FitState,
    Seats,
    Warm,
    fitted_clearance,
    operating_clearance,
)
from fe_drivetrain.bearing.press_fits import Ring, RingMaterial, fit_pressure
from fe_drivetrain.bearing.tolerances import Limits
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.studies.clearance_tables import state_clearance

STEEL = RingMaterial(206e9, 0.3, 7850.0, 12e-6)
SEATS = Seats(
    bore=0.5,
    outside=0.72,
    inner_raceway=0.56,
    outer_raceway=0.66,
    element_diameter=0.05,
    contact_angle=0.0,
    spread=0.0,
    shaft=Ring(0.05, 0.25, STEEL),
    housing=Ring(0.36, 0.5, STEEL),
    rings=STEEL,
)
TIGHT = FitState(2e-4, shaft=60e-6, housing=-40e-6)


def test_pressure_is_that_of_a_printed_fit() -> None:
    """VM292: radii 1.25, 1.516 and 1.75 m, misfit 0.02 m on the radius: 221.638 MPa."""
    metal = RingMaterial(206e9, 0.0, 0.0, 1e-6)
    p = fit_pressure(Ring(1.25, 1.516, metal), Ring(1.516, 1.75, metal), 2 * 0.02)
    assert p == pytest.approx(221.638e6, rel=5e-6)


@pytest.mark.parametrize("hollow", [0.0, 0.1, 0.4])
def test_raceways_of_one_material_move_as_catalogues_print(hollow: float) -> None:
    """k (1 - k0^2) / (1 - k^2 k0^2) of the interference, k = d/F, k0 = d0/d (NSK's form)."""
    seats = replace(SEATS, shaft=Ring(0.5 * hollow, 0.25, STEEL), housing=Ring(0.36, 0.45, STEEL))
    inner = fitted_clearance(seats, FitState(0.0, shaft=60e-6), Warm())[0]
    k, k0 = 0.5 / 0.56, hollow / 0.5
    assert -inner == pytest.approx(60e-6 * k * (1 - k0**2) / (1 - (k * k0) ** 2), rel=1e-12)
    outer = fitted_clearance(seats, FitState(0.0, housing=-60e-6), Warm())[0]
    h, h0 = 0.66 / 0.72, 0.72 / 0.9
    assert -outer == pytest.approx(60e-6 * h * (1 - h0**2) / (1 - (h * h0) ** 2), rel=1e-12)


def test_displacements_close_the_interference() -> None:
    inner, shaft = SEATS.inner_ring, SEATS.shaft
    p = fit_pressure(shaft, inner, 60e-6)
    assert 2 * (shaft.outer_shrink(p) + inner.bore_growth(p)) == pytest.approx(60e-6, rel=1e-12)


def test_a_loose_ring_has_no_pressure_and_does_not_move() -> None:
    loose = FitState(2e-4, shaft=-30e-6, housing=50e-6)
    clearance, pressures = fitted_clearance(SEATS, loose, Warm())
    assert clearance == 2e-4
    assert pressures == (0.0, 0.0)
    assert fit_pressure(SEATS.shaft, SEATS.inner_ring, -1e-3) == 0.0


@pytest.mark.parametrize("angle", [0.0, 20.0, 40.0])
@pytest.mark.parametrize("spread", [-0.3, 0.0, 0.3])
def test_equal_heat_changes_nothing(angle: float, spread: float) -> None:
    """All of one material and one temperature grows in proportion: gaps grow by a share of them."""
    tilt = radians(angle)
    across = 0.05 * cos(tilt)
    seats = replace(
        SEATS,
        contact_angle=tilt,
        spread=spread,
        inner_raceway=0.61 - across,
        outer_raceway=0.61 + across,
    )
    cold, p = fitted_clearance(seats, TIGHT, Warm())
    warm, q = fitted_clearance(seats, TIGHT, Warm(40.0, 40.0, 40.0, 40.0, 40.0))
    assert warm == pytest.approx(cold, abs=1e-15)
    assert q == pytest.approx(p, rel=1e-9)


def test_rows_back_to_back_whose_cones_meet_in_one_point_stand_heat() -> None:
    """Heat of the inner part moves its raceway along the cone about the common apex."""
    tilt = radians(25.0)
    across = 0.05 * cos(tilt)
    inner = 0.61 - across
    # the inner contact at radius inner / 2: its raceway's cone meets the axis in the middle
    reach = 0.5 * inner * cos(tilt) / sin(tilt)
    spread = -2.0 * (reach - 0.5 * 0.05 * sin(tilt))
    seats = replace(
        SEATS, contact_angle=tilt, spread=spread, inner_raceway=inner, outer_raceway=0.61 + across
    )
    hot = Warm(shaft=30.0, inner_ring=30.0)
    assert fitted_clearance(seats, FitState(0.0), hot)[0] == pytest.approx(0.0, abs=1e-15)
    facing = replace(seats, spread=-spread)
    assert fitted_clearance(facing, FitState(0.0), hot)[0] < -1e-4


def test_a_thin_ring_grows_as_a_hoop_and_a_disc_as_a_disc() -> None:
    """rho w^2 r^3 / E of a hoop; (1 - nu) rho w^2 r^3 / (4 E) at the rim of a solid disc."""
    w = 300.0
    hoop = Ring(0.4995, 0.5005, STEEL)
    assert hoop.turning_growth(0.5, w) == pytest.approx(7850 * w**2 * 0.5**3 / 206e9, rel=1e-3)
    disc = Ring(0.0, 0.5, STEEL)
    exact = (1 - 0.3) * 7850 * w**2 * 0.5**3 / (4 * 206e9)
    assert disc.turning_growth(0.5, w) == pytest.approx(exact, rel=1e-12)


def test_a_band_covers_all_that_tolerances_allow() -> None:
    """No draw of deviations leaves it, and its ends are reached; columns add up."""
    mounting = Mounting(
        internal_clearance=(2e-4, 3e-4),
        fit=Fit(shaft="n6", housing="H7"),
        temperatures=Temperatures(shaft=60, inner_ring=65, outer_ring=50, housing=40),
        speed=100.0,
    )
    found = operating_clearance(mounting, SEATS, Limits(2e-4, 3e-4))
    radial = found.radial
    assert radial.least < radial.mean < radial.most
    for name in ("least", "mean", "most"):
        parts = [getattr(one, name) for one in found.parts.values()]
        assert sum(parts) == pytest.approx(getattr(radial, name), rel=1e-12)
    rng = np.random.default_rng(1)
    warm = Warm(40.0, 45.0, 37.5, 30.0, 20.0, 100.0)
    kept = (0.5 / 0.502, 0.72 / 0.722)
    values = []
    for _ in range(3000):
        u = rng.uniform(size=5)
        # n6 at 500 mm, bore and outside of class Normal, H7 at 720 mm
        state = FitState(
            2e-4 + 1e-4 * u[0], 40e-6 + 40e-6 * u[1], -45e-6 * u[2], 80e-6 * u[3], -75e-6 * u[4]
        )
        values.append(fitted_clearance(SEATS, state, warm, kept)[0])
    assert radial.least <= min(values) < max(values) <= radial.most
    inside = np.mean([found.probable.low <= one <= found.probable.high for one in values])
    # sqrt(3) standard deviations of a sum of even spreads: 92 % of a normal one
    assert 0.90 < inside < 0.96


def test_a_preload_is_the_axial_force_of_the_mounted_bearing() -> None:
    entry = catalogue_entry("bearing_s_o20")
    force = 40e3
    found = entry_clearance(entry, Mounting(preload=(force, force)))
    tight = entry.bearing("b").with_rows(clearance=found.along_normal.mean)
    # one row alone, as the other balances it
    row = replace(tight, rows=tight.rows[:1])
    assert abs(forces(row, np.zeros(5))[0][0, 0]) == pytest.approx(force, rel=1e-9)
    assert found.radial.least == found.radial.most


def test_heat_tightens_what_is_mounted_alone() -> None:
    """Fits are in a clearance that was measured when mounted: without heat it stays."""
    entry = catalogue_entry("spherical_23180")
    fit = Fit(shaft="n6", housing="H7")
    cold = entry_clearance(entry, Mounting(mounted_clearance=(1e-4, 2e-4), fit=fit))
    assert (cold.radial.least, cold.radial.most) == pytest.approx((1e-4, 2e-4))
    warm = Mounting(
        mounted_clearance=(1e-4, 2e-4),
        fit=fit,
        temperatures=Temperatures(inner_ring=60, outer_ring=40),
    )
    assert entry_clearance(entry, warm).radial.most < 2e-4 - 5e-5


def test_clearance_along_the_normal_closes_the_radial_one() -> None:
    """An inner ring moved by half of the radial clearance just touches its rollers."""
    entry = catalogue_entry("cylindrical_nu2220", clearance=0.5 * 80e-6)
    bearing = entry.bearing("b")
    for moved, carries in ((39.9e-6, False), (40.2e-6, True)):
        loads = forces(bearing, np.array([0.0, 0.0, -moved, 0.0, 0.0]))[0]
        assert bool(np.abs(loads).max() > 0.0) is carries
    assert normal_of(entry) == 0.5
    assert normal_of(catalogue_entry("bearing_s")) == pytest.approx(0.5 * cos(38 * pi / 180))


def test_more_of_the_ladder_brings_more_contributions() -> None:
    entry = catalogue_entry("spherical_23180")
    steps = [
        {},
        {"fit": Fit(shaft="m6", housing="H7")},
        {
            "fit": Fit(shaft="m6", housing="H7"),
            "temperatures": Temperatures(inner_ring=60, outer_ring=50),
            "speed": 2.0,
        },
    ]
    found = [entry_clearance(entry, Mounting(clearance_class="C3", **more)) for more in steps]
    assert found[0].radial.mean == pytest.approx(0.5 * (340e-6 + 450e-6))
    assert all(a.radial.mean > b.radial.mean for a, b in pairwise(found))


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({}, "needs one of"),
        ({"clearance_class": "CN", "preload": (0.0, 1.0)}, "needs one of"),
        ({"internal_clearance": (3e-4, 2e-4)}, "least and the most"),
        ({"internal_clearance": (20.0, 30.0)}, "give it in m"),
        ({"preload": (-1.0, 2.0)}, "from 0 to"),
    ],
)
def test_a_mounting_that_cannot_be_is_refused(given: dict, message: str) -> None:  # type: ignore[type-arg]
    with pytest.raises(ValidationError, match=message):
        Mounting(**given)


def test_what_a_bearing_cannot_have_is_refused() -> None:
    with pytest.raises(InputError, match="no contact angle"):
        entry_clearance(catalogue_entry("cylindrical_nu2220"), Mounting(preload=(1.0, 2.0)))
    with pytest.raises(InputError, match="no bore"):
        entry_clearance(catalogue_entry("masta_ball"), Mounting(clearance_class="CN"))
    with pytest.raises(InputError, match="has no wall"):
        Ring(0.2, 0.1, STEEL)
    assert Ring(0.1, inf, STEEL).bore_growth(1e6) == pytest.approx(1e6 * 0.1 / 206e9 * 1.3)


@pytest.mark.parametrize(
    ("name", "shaft", "growth"),
    [
        ("single_row_tapered", 70.0, 12.5e-6 * (50.0 - 30.0)),
        ("single_row_tapered", 50.0, 0.0),
        ("cylindrical", 70.0, 0.0),  # carries no axial force, so that it is none of a pair
    ],
)
def test_growth_between_a_pair_is_named_where_it_is_left_out(
    name: str, shaft: float, growth: float
) -> None:
    """alpha (dT of the shaft - dT of the housing) for each metre between both bearings."""
    designation = {"single_row_tapered": "32222", "cylindrical": "NU 2220"}[name]
    more = {"C": 4.02e5, "C0": 5.7e5, "Y": 1.4} if designation == "32222" else {}
    page = CataloguePage.read({"designation": designation, "C": 3.8e5, "C0": 4.5e5, **more}, "page")
    temperatures = Temperatures(inner_ring=65, outer_ring=50, shaft=shaft, housing=50)
    mounting = Mounting(mounted_clearance=(1e-5, 3e-5), temperatures=temperatures)
    found = entry_clearance(fitted_entry(page), mounting)
    assert found.left_out == pytest.approx(growth, abs=1e-15)
    said = Findings()
    state_clearance(said, "front", found)
    notes = [note for note in said.notes if "as one of a pair" in note]
    assert len(notes) == bool(growth)
    if notes:
        assert "grows 250 µm more than its housing for each metre" in notes[0]
        assert "less axial clearance of both together face to face (X)" in notes[0]
