"""Involute gears against published gearboxes, and against what the geometry must keep."""

from dataclasses import replace
from math import cos, degrees, pi, radians, sin, tan

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.gear.involute import (
    Gear,
    Pair,
    Rack,
    inverse_involute,
    involute_of,
    meshing_without_backlash,
)
from fe_drivetrain.gear.planets import (
    assembly_positions,
    equally_spaced,
    ring_phases,
    sequence,
    sun_phases,
)


def nrel_5mw() -> dict[str, Pair]:
    """Gearbox of Nejad, Guo, Gao and Moan 2016, tip diameters as its KISSsoft reports print."""
    m = 1e-3
    sun = Gear(19, 45 * m, 491 * m, shift=0.617, tip_diameter=978.808 * m)
    planet = Gear(17, 45 * m, 491 * m, shift=0.8021, tip_diameter=905.470 * m)
    ring = Gear(-56, 45 * m, 491 * m, shift=-0.5013, tip_diameter=2475.118 * m)
    sun_2 = Gear(18, 21 * m, 550 * m, shift=0.389, tip_diameter=432.838 * m)
    planet_2 = Gear(36, 21 * m, 550 * m, shift=0.5039, tip_diameter=815.668 * m)
    ring_2 = Gear(-93, 21 * m, 550 * m, shift=0.1171, tip_diameter=1906.086 * m)
    ten = radians(10.0)
    pinion = Gear(24, 14 * m, 360 * m, ten, 0.480, tip_diameter=380.747 * m)
    wheel = Gear(95, 14 * m, 360 * m, -ten, 0.6691, tip_diameter=1395.376 * m)
    return {
        "sun 1": Pair(sun, planet, 0.863),
        "ring 1": Pair(planet, ring, 0.863),
        "sun 2": Pair(sun_2, planet_2, 0.584),
        "ring 2": Pair(planet_2, ring_2, 0.584),
        "stage 3": Pair(pinion, wheel, 0.861),
    }


PAIRS = nrel_5mw()


@pytest.mark.parametrize(
    ("name", "ratio"),
    [("sun 1", 1.115), ("ring 1", 1.278), ("sun 2", 1.370), ("ring 2", 1.618), ("stage 3", 1.463)],
)
def test_contact_ratios_of_a_gearbox_are_those_printed(name: str, ratio: float) -> None:
    assert round(PAIRS[name].transverse_ratio, 3) == ratio


def test_overlap_and_printed_forces_and_shifts() -> None:
    assert round(PAIRS["stage 3"].overlap_ratio, 3) == 1.421
    # torques are printed to 0.1 N m
    for name, torque, force in (
        ("sun 1", 999650.9 / 3.0, 779454.877),
        ("sun 2", 162105.5 / 3.0, 285900.438),
        ("stage 3", 40953.0, 240064.4),
    ):
        assert PAIRS[name].tangential_force(torque) == pytest.approx(force, rel=1.3e-6)
    for pair in PAIRS.values():  # shifts are printed to four digits
        assert pair.shift_sum == pytest.approx(pair.first.shift + pair.second.shift, abs=1e-4)


def test_tips_without_a_given_diameter() -> None:
    # the rings are not shortened; the others are, by the distance that the shifts do not gain
    for name, printed in (("ring 1", 2475.118), ("ring 2", 1906.086)):
        ring = replace(PAIRS[name].second, tip_diameter=None)
        assert 2e3 * ring.tip_radius == pytest.approx(printed, abs=0.01)
    for name in ("sun 1", "sun 2", "stage 3"):
        pair = PAIRS[name]
        one, two = pair.first, pair.second
        short = pair.centre_distance - pair.reference_centre_distance
        short -= (one.shift + two.shift) * one.normal_module
        for gear in (one, two):
            full = replace(gear, tip_diameter=None).tip_radius
            assert full + short == pytest.approx(gear.tip_radius, abs=1e-5)


def test_example_1_of_iso_tr_6336_30() -> None:
    rack = Rack(dedendum=1.4, fillet=0.39)
    helix = radians(15.8)
    pinion = Gear(17, 8e-3, 0.1, helix, 0.145, rack=rack)
    wheel = Gear(103, 8e-3, 0.1, -helix, 0.0, rack=rack)
    assert round(pinion.virtual_teeth, 3) == 18.905
    assert round(wheel.virtual_teeth, 3) == 114.543
    pair = Pair(pinion, wheel, 0.5)
    assert pair.tangential_force(9000.0) == pytest.approx(127352, abs=0.6)
    # Z_epsilon .803 = sqrt(1 / epsilon_alpha), epsilon_beta being above 1
    assert pair.overlap_ratio > 1.0
    assert pair.transverse_ratio**-0.5 == pytest.approx(0.803, abs=5e-4)
    zone = 2.0 * cos(pinion.base_helix) * cos(pair.working_angle) / sin(pair.working_angle)
    assert np.sqrt(zone / cos(pinion.transverse_angle) ** 2) == pytest.approx(2.39533, abs=1e-5)


@pytest.mark.parametrize(
    ("gears", "module", "helix", "centre", "shifts", "angle", "bases", "ratio"),
    [
        # teeth, shift, tip radius [mm]
        (((21, 0.176, 118), (39, 0.399, 211)), 10, 7.5, 308, 0.575, 22.74, (99.42, 184.63), 1.57),
        (
            ((39, 0.399, 211), (-99, -0.974, 498)),
            10,
            7.5,
            308,
            -0.575,
            22.74,
            (184.63, 468.69),
            1.78,
        ),
        (
            ((23, 0.154, 107.7), (82, 0.296, 359.7)),
            8.25,
            14,
            450,
            0.4505,
            21.76,
            (91.55, 326.40),
            1.64,
        ),
        (((22, 0.166, 63), (88, 0.156, 233)), 5, 14, 285, 0.3224, 21.39, (53.07, 212.29), 1.72),
    ],
)
def test_gearbox_of_the_nrel_750_kw_machine(
    gears: tuple[tuple[int, float, float], ...],
    module: float,
    helix: float,
    centre: float,
    shifts: float,
    angle: float,
    bases: tuple[float, float],
    ratio: float,
) -> None:
    # tips are assumed at a clearance of 0.4 modules from the other's published root circles
    rack = Rack(dedendum=1.467)
    hands = (1, 1 if gears[1][0] < 0 else -1)
    made = [
        Gear(z, module * 1e-3, 0.1, hand * radians(helix), x, rack=rack, tip_diameter=2e-3 * tip)
        for hand, (z, x, tip) in zip(hands, gears, strict=True)
    ]
    pair = Pair(made[0], made[1], centre * 1e-3)
    assert pair.shift_sum == pytest.approx(shifts, abs=6e-4)
    assert degrees(pair.working_angle) == pytest.approx(angle, abs=0.005)
    for gear, base in zip(made, bases, strict=True):
        assert 1e3 * gear.base_radius == pytest.approx(base, abs=0.005)
    assert round(pair.transverse_ratio, 2) == ratio


def test_without_backlash_both_ways() -> None:
    for pair in PAIRS.values():
        same = meshing_without_backlash(
            replace(pair.first, shift=pair.shift_sum - pair.second.shift), pair.second
        )
        assert same.centre_distance == pytest.approx(pair.centre_distance, rel=1e-12)
        assert abs(same.backlash) < 1e-15


def test_thicknesses_fill_the_pitch_circle_without_backlash() -> None:
    for pair in PAIRS.values():
        exact = meshing_without_backlash(pair.first, pair.second)
        one, two = exact.working_radii
        pitch = 2.0 * pi * one / exact.first.teeth
        arcs = exact.first.thickness_at(one) + exact.second.thickness_at(two)
        assert arcs == pytest.approx(pitch, rel=1e-12)
        # a longer distance adds play between external gears, and takes it from internal ones
        nearer = -1 if exact.internal else 1
        moved = 1e-4 * nearer * exact.centre_distance
        looser = Pair(exact.first, exact.second, exact.centre_distance + moved)
        grown = 2.0 * abs(moved) * sin(exact.working_angle)
        assert looser.backlash == pytest.approx(grown, rel=0.01)


def test_path_of_contact() -> None:
    for pair in PAIRS.values():
        path = pair.path
        pitch = pair.first.base_pitch
        assert path.end - path.start == pytest.approx(pair.transverse_ratio * pitch)
        assert path.start < path.single_start < path.single_end < path.end
        # the tips are at the ends of the path; both flanks touch at the pitch circles between
        assert float(pair.radii(path.end)[0]) == pytest.approx(pair.first.tip_radius)
        assert float(pair.radii(path.start)[1]) == pytest.approx(pair.second.tip_radius)
        for found, there in zip(pair.radii(path.pitch), pair.working_radii, strict=True):
            assert float(found) == pytest.approx(there)
        rho = pair.curvatures(path.pitch)
        # rolling without sliding: curvature over radius is the sine of the working angle
        assert float(rho[0]) == pytest.approx(pair.working_radii[0] * sin(pair.working_angle))
        assert abs(float(rho[1])) == pytest.approx(pair.working_radii[1] * sin(pair.working_angle))


def test_involute_function_and_its_inverse() -> None:
    for angle in (0.0, 1e-3, radians(20.0), 0.9, 1.4):
        assert inverse_involute(float(involute_of(angle))) == pytest.approx(angle, rel=1e-9)
    assert float(involute_of(radians(20.0))) == pytest.approx(0.0149043839, abs=1e-10)


def test_undercut_begins_at_seventeen_teeth() -> None:
    sharp = Rack(dedendum=1.0, fillet=0.0)  # 2 / sin^2(20 degrees) = 17.097
    Gear(18, 1e-3, 0.01, rack=sharp)
    with pytest.raises(InputError, match=r"undercut by its rack: give a shift of 0\.005689"):
        Gear(17, 1e-3, 0.01, rack=sharp)
    assert Gear(17, 1e-3, 0.01, shift=0.00569, rack=sharp).height_of_form >= 0.0


def test_base_helix() -> None:
    gear = PAIRS["stage 3"].first
    assert tan(gear.base_helix) == pytest.approx(
        tan(gear.helix) * gear.base_radius / gear.reference_radius
    )
    assert gear.base_pitch * cos(gear.base_helix) == pytest.approx(
        pi * gear.normal_module * cos(gear.pressure_angle)
    )


GOOD = PAIRS["sun 2"]


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Gear(3, 1e-3, 0.01), "3 teeth: give 5 or more"),
        (lambda: Gear(30, 0.0, 0.01), "normal module of a gear is 0 m: it must be positive"),
        (lambda: Gear(30, 1e-3, 0.01, helix=7.5), "helix angle of a gear is 429"),
        (lambda: Gear(30, 1e-3, 0.01, pressure_angle=20.0), "pressure angle of a gear is 1145"),
        (lambda: Gear(30, 1e-3, 0.01, shift=2.5, rack=Rack(addendum=1.0)), "are pointed"),
        (lambda: Gear(-30, 1e-3, 0.01), "on or within its base circle"),
        (lambda: Gear(30, 1e-3, 0.01, tip_diameter=0.02), "is not beyond its root circle"),
        (lambda: Pair(GOOD.first, GOOD.second, 0.5), "where the base circles touch"),
        (lambda: Pair(GOOD.first, GOOD.second, 0.57), "enter the root circle"),
        (lambda: Pair(GOOD.first, GOOD.second, 0.63), "do not reach each other"),
        (lambda: Pair(PAIRS["ring 1"].second, GOOD.first, 0.6), "give the external gear first"),
        (lambda: Pair(GOOD.first, PAIRS["sun 1"].second, 0.6), "normal module of the first gear"),
        (
            lambda: Pair(PAIRS["stage 3"].first, PAIRS["stage 3"].first, 0.861),
            "gears of this pair have opposite hands",
        ),
        (
            lambda: meshing_without_backlash(Gear(45, 1e-3, 0.01), Gear(-50, 1e-3, 0.01)),
            "cut those of an internal gear|shorten the tips",
        ),
    ],
)
def test_impossible_gears_are_refused_in_a_sentence(make: object, message: str) -> None:
    assert callable(make)
    with pytest.raises(InputError, match=message):
        make()


def test_planets_that_fit() -> None:
    assert equally_spaced(21, 99, 3)
    assert equally_spaced(19, 56, 3)
    assert not equally_spaced(24, 122, 3)  # Al-Hamadani 2018, stage 1 of turbine A
    places = assembly_positions(24, 122, 3)
    assert np.abs(np.degrees(places) - [0, 120, 240]).max() < 180 / 146
    assert np.allclose(sun_phases(24, 122, places), ring_phases(24, 122, places))
    with pytest.raises(InputError, match="planet 2 at 120 degrees cannot be assembled"):
        sun_phases(24, 122, np.radians([0.0, 120.0, 240.0]))
    with pytest.raises(InputError, match="their sum, 146, must be a multiple of 3"):
        sequence(24, 122, 3)


@pytest.mark.parametrize(
    ("sun", "ring", "planets", "kind"),
    [
        (21, 99, 3, "in phase"),
        (29, 145, 3, "sequential"),
        (19, 56, 3, "sequential"),
        (18, 93, 3, "in phase"),
        (22, 70, 4, "counter-phased"),
        (26, 94, 6, "mixed"),
    ],
)
def test_phases_of_planets(sun: int, ring: int, planets: int, kind: str) -> None:
    assert sequence(sun, ring, planets) == kind
    places = 2 * np.pi * np.arange(planets) / planets
    phases = sun_phases(sun, ring, places)
    assert np.allclose(phases, ring_phases(sun, ring, places))
    assert np.allclose(phases, (sun % planets) * np.arange(planets) / planets % 1.0)
