"""Involute gears against published gearboxes, and against what the geometry must keep."""

import re
from dataclasses import replace
from math import cos, degrees, pi, radians, sin, tan
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fe_drivetrain.cases.references.published_gears import (
    NREL_5MW_PRINTED,
    iso_example_1,
    nrel_5mw,
    nrel_750kw,
)
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.gear.functions import inverse_involute, involute_of
from fe_drivetrain.gear.involute import (
    Gear,
    Pair,
    Rack,
    meshing_without_backlash,
)
from fe_drivetrain.gear.planets import (
    assembly_positions,
    equally_spaced,
    ring_phases,
    sequence,
    sun_phases,
)

PAIRS = nrel_5mw()


@pytest.mark.parametrize("name", PAIRS)
def test_contact_ratios_of_a_gearbox_are_those_printed(name: str) -> None:
    assert round(PAIRS[name].transverse_ratio, 3) == NREL_5MW_PRINTED[name].transverse_ratio
    assert round(PAIRS[name].overlap_ratio, 3) == NREL_5MW_PRINTED[name].overlap_ratio


def test_printed_forces_and_shifts() -> None:
    for name, printed in NREL_5MW_PRINTED.items():
        if printed.torque is not None:  # torques are printed to 0.1 N m
            force = PAIRS[name].tangential_force(printed.torque)
            assert force == pytest.approx(printed.force, rel=1.3e-6)
    for pair in PAIRS.values():  # shifts are printed to four digits
        assert pair.shift_sum == pytest.approx(pair.first.shift + pair.second.shift, abs=1e-4)


def test_tips_without_a_given_diameter() -> None:
    # the rings are not shortened; the others are, by the distance that the shifts do not gain
    for name, printed in (("ring 1", 2475.118), ("ring 2", 1906.081)):
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
    pair = iso_example_1()
    pinion, wheel = pair.first, pair.second
    assert round(pinion.virtual_teeth, 3) == 18.905
    assert round(wheel.virtual_teeth, 3) == 114.543
    assert pair.tangential_force(9000.0) == pytest.approx(127352, abs=0.6)
    # Z_epsilon .803 = sqrt(1 / epsilon_alpha), epsilon_beta being above 1
    assert pair.overlap_ratio > 1.0
    assert pair.transverse_ratio**-0.5 == pytest.approx(0.803, abs=5e-4)
    zone = 2.0 * cos(pinion.base_helix) * cos(pair.working_angle) / sin(pair.working_angle)
    assert np.sqrt(zone / cos(pinion.transverse_angle) ** 2) == pytest.approx(2.39533, abs=1e-5)


@pytest.mark.parametrize(
    ("name", "shifts", "angle", "bases", "ratio", "overlap"),
    [
        ("sun", 0.575, 22.74, (99.42, 184.63), 1.57, 0.914),
        ("ring", -0.575, 22.74, (184.63, 468.69), 1.78, 0.945),
        ("intermediate", 0.4505, 21.76, (91.55, 326.40), 1.64, 1.587),
        ("high speed", 0.3224, 21.39, (53.07, 212.29), 1.72, 1.694),
    ],
)
def test_gearbox_of_the_nrel_750_kw_machine(
    name: str,
    shifts: float,
    angle: float,
    bases: tuple[float, float],
    ratio: float,
    overlap: float,
) -> None:
    pair = nrel_750kw()[name]
    assert pair.shift_sum == pytest.approx(shifts, abs=6e-4)
    assert degrees(pair.working_angle) == pytest.approx(angle, abs=0.005)
    for gear, base in zip((pair.first, pair.second), bases, strict=True):
        assert 1e3 * gear.base_radius == pytest.approx(base, abs=0.005)
    assert round(pair.transverse_ratio, 2) == ratio
    assert round(pair.overlap_ratio, 3) == overlap
    roots = {21: 186, 39: 372, -99: 1047, 23: 174, 82: 678, 22: 100, 88: 440}
    for gear in (pair.first, pair.second):  # published as whole millimetres
        assert 2e3 * gear.root_radius == pytest.approx(roots[gear.teeth], abs=0.6)


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


def test_example_of_the_docs() -> None:
    text = (Path(__file__).parents[2] / "docs" / "gears.md").read_text(encoding="utf-8")
    found = re.search(r"```python\n(.*?)```", text, re.DOTALL)
    assert found is not None
    names: dict[str, Any] = {}
    exec(found.group(1), names)
    assert round(names["pair"].transverse_ratio, 3) == 1.463
    assert round(names["iso"].mesh / 1e9, 2) == 18.63
    assert float(names["series"].at(0.3)) > 0.0


@pytest.mark.parametrize("name", PAIRS)
def test_force_along_the_normal_is_that_of_reference_circle_and_normal_section(name: str) -> None:
    """F_n = F_t / (cos(alpha_n) cos(beta)), from both angles at the reference circle."""
    pair = PAIRS[name]
    gear = pair.first
    expected = pair.tangential_force(1e4) / cos(gear.pressure_angle) / cos(gear.helix)
    assert pair.normal_force(1e4) == pytest.approx(expected, rel=1e-12)
