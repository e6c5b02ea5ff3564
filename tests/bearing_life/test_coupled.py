"""Nonlinear bearings in a beam: closed forms, linear beams, balance and mechanisms."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from fe_drivetrain.bearing.arrangements import (
    double_row_tapered,
    spherical_roller,
    tapered_row,
    toroidal,
)
from fe_drivetrain.bearing.catalogue import catalogue_bearing
from fe_drivetrain.bearing.contact import linear
from fe_drivetrain.bearing.contact_forces import forces, turn
from fe_drivetrain.bearing.geometry import Bearing
from fe_drivetrain.bearing.rolling import equilibrium
from fe_drivetrain.bearing_life.coupled.body import (
    FIVE,
    LinearBody,
    factors_of,
    in_housings,
    linear_body,
)
from fe_drivetrain.bearing_life.coupled.newton import contact_stiffness, coupled_equilibrium
from fe_drivetrain.bearing_life.coupled.of_scene import scene_body
from fe_drivetrain.bearing_life.coupled.springs import (
    on_springs,
    stiffness_loop,
    tilt_springs,
    tilting_stiffness,
)
from fe_drivetrain.cases.bearing.tilt_scenarios import best_fit, displacement_scenarios, tilt_curve
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.reading import change_scene, library_scene
from fe_drivetrain.shafts.beam.beam import Beam, Support
from fe_drivetrain.shafts.beam.closed_forms import (
    MainBearingBeam,
    main_bearing_frame,
    pinned_reaction,
    torsional_spring_reaction,
)
from fe_drivetrain.shafts.beam.condensed import condensed_beam
from fe_drivetrain.shafts.beam.sections import BeamSection
from fe_drivetrain.shafts.beam.shaft import solve
from fe_drivetrain.shafts.fidelity.ladder import shaft_level

PARAMETERS = MainBearingBeam(shaft_diameter=0.635, yaw_stiffness=145e6)
GEARBOX = (
    PARAMETERS.axial_stiffness,
    PARAMETERS.radial_stiffness,
    PARAMETERS.radial_stiffness,
    np.inf,
    0.0,
    0.0,
)
HUB = 1e3 * np.array(
    [
        [200, 10, -400, 500, 300, -200],
        [100, -20, -350, 700, -800, 400],
        [300, 0, -420, 900, 1500, 0],
        [50, 5, -380, 100, 20, 10],
    ]
)
FACTORS = factors_of(HUB, PARAMETERS.gearbox_weight)
BEARING_S = catalogue_bearing("bearing_s", laminae=0)


def beam_body(shear: bool = False) -> LinearBody:
    beam = main_bearing_frame(PARAMETERS, shear=shear)
    stations = np.array([-PARAMETERS.overhang, 0.0, PARAMETERS.span])
    body = condensed_beam(beam, ["hub", "bearing", "gearbox"], stations)
    return linear_body(body, ["bearing"], {"gearbox": GEARBOX})


BODY = beam_body()


def preloaded(stiffness: float, preload: float = 6e-4) -> Bearing:
    """All contacts stay closed, so that a linear law makes a linear bearing."""
    return double_row_tapered(
        "preloaded",
        36,
        0.065,
        0.095,
        0.7874,
        38.0,
        0.192,
        "X",
        law=linear(stiffness),
        clearance=-preload,
        laminae=0,
    )


def reference(bearing: np.ndarray) -> np.ndarray:
    """Loads on the bearing of the beam room's own solution, over its 6x6 support."""
    frame = main_bearing_frame(PARAMETERS, bearing, shear=False)
    loads = np.zeros((len(HUB), 2, 6))
    loads[:, 0] = HUB
    loads[:, 1, 2] = -PARAMETERS.gearbox_weight
    return solve(frame, [-PARAMETERS.overhang, PARAMETERS.span], loads).reaction("bearing")


def closed_form(K: float) -> tuple[np.ndarray, np.ndarray]:
    """Eq 3.18 and 3.19 in both planes: loads (n, 2) along y, z and moments (n, 2) about y, z."""
    shaft = (
        PARAMETERS.overhang,
        PARAMETERS.span,
        PARAMETERS.bending_stiffness,
        PARAMETERS.radial_stiffness,
        K,
    )
    Fy, minus_Mz = torsional_spring_reaction(HUB[:, 1], -HUB[:, 5], *shaft)
    Fz, My = torsional_spring_reaction(HUB[:, 2], HUB[:, 4], *shaft, -PARAMETERS.gearbox_weight)
    return np.column_stack([Fy, Fz]), np.column_stack([My, -minus_Mz])


def test_a_linear_preloaded_bearing_is_the_beam_on_its_6x6_support() -> None:
    bearing = preloaded(2e9)
    K = np.zeros((6, 6))
    K[np.ix_(FIVE, FIVE)] = contact_stiffness(bearing)
    found = coupled_equilibrium(BODY, {"bearing": bearing}, FACTORS)
    assert found.converged.all()
    # forces balance to 1e-8 of the load, and moments of 1 kN m beside those of 1 MN m
    size = np.abs(found.of("bearing")).max()
    assert_allclose(found.of("bearing"), reference(K)[:, FIVE], rtol=0, atol=1e-8 * size)


def test_a_ring_that_slides_is_its_stiffness_without_that_along_the_axis() -> None:
    bearing = preloaded(2e9)
    K = np.zeros((6, 6))
    K[np.ix_(FIVE, FIVE)] = contact_stiffness(bearing)
    K -= np.outer(K[:, 0], K[0]) / K[0, 0]
    body = replace(BODY, sliding=("bearing",))
    found = coupled_equilibrium(body, {"bearing": bearing}, FACTORS)
    assert found.converged.all()
    loads = found.of("bearing")
    assert_allclose(loads, reference(K)[:, FIVE], rtol=0, atol=1e-8 * np.abs(loads).max())
    assert np.abs(found.slides).min() > 1e-6
    assert np.abs(found.imbalance()).max() < 1e-8 * np.abs(HUB).max()


def test_rings_that_slide_leave_the_thrust_to_the_bearing_that_locates() -> None:
    free = {
        "bearing_units.rear.interface": "spring",
        "bearing_units.rear.stiffness": [0, "rigid", "rigid", 0, 0, 0],
    }
    scene = library_scene("two_bearings")
    bearings = {
        "front": catalogue_bearing("bearing_s_o20"),
        "rear": catalogue_bearing("spherical_230_500"),
    }
    held, slid = (
        coupled_equilibrium(scene_body(one, 1), bearings, FACTORS)
        for one in (scene, change_scene(scene, free))
    )
    assert held.converged.all()
    assert slid.converged.all()
    assert not held.slides.any()
    thrust = HUB[:, 0]
    assert_allclose(held.of("front")[:, 0] + held.of("rear")[:, 0], thrust, rtol=1e-6)
    assert np.abs(held.of("rear")[:, 0]).max() > 1e4
    assert_allclose(slid.of("front")[:, 0], thrust, rtol=1e-6)
    assert np.abs(slid.of("rear")[:, 0]).max() < 1e-7 * thrust.max()
    # each ring is in equilibrium under its load alone
    moved = equilibrium(bearings["rear"], slid.of("rear")).displacements
    assert_allclose(moved[:, 1:3], slid.deflections[:, 1, 1:3], rtol=1e-5, atol=1e-9)


def test_a_ring_without_rollers_that_press_along_the_axis_may_as_well_slide() -> None:
    bearing = toroidal("toroidal", 20, 0.05, 0.06, 0.5)
    held, slid = (
        coupled_equilibrium(body, {"bearing": bearing}, FACTORS)
        for body in (BODY, replace(BODY, sliding=("bearing",)))
    )
    assert held.converged.all()
    assert_allclose(slid.forces, held.forces, rtol=1e-9, atol=1e-3)


def test_a_stiff_linear_bearing_with_one_tilting_stiffness_is_eq_3_18() -> None:
    # arms so short that a bearing rigid along the axes still has a finite K_R
    stiff = 1e14
    row = tapered_row(36, 0.01, 2e-3, 0.8, 20.0, law=linear(stiff), clearance=-5e-5, laminae=0)
    place = row.radius * np.tan(row.angle)
    rows = (
        replace(row, place=-place, angle=-row.angle),
        replace(row, place=place),
    )
    bearing = Bearing("short arms", rows)
    K_R = contact_stiffness(bearing)[3, 3]
    assert 1e8 < K_R < 2e9
    found = coupled_equilibrium(BODY, {"bearing": bearing}, FACTORS).of("bearing")
    forces, moments = closed_form(K_R)
    assert_allclose(found[:, 1:3], forces, rtol=1e-6, atol=1e-6 * np.abs(forces).max())
    assert_allclose(found[:, 3:], moments, rtol=1e-6, atol=1e-6 * np.abs(moments).max())


def test_springs_in_place_of_the_bearing_are_eq_3_18_exactly() -> None:
    for K_R in (0.0, 145e6, 1272e6, np.inf):
        springs = tilt_springs(BEARING_S, K_R)
        found = on_springs(BODY, FACTORS, springs).forces[:, 0]
        forces, moments = closed_form(K_R)
        size = max(np.abs(forces).max(), np.abs(moments).max())
        assert_allclose(found[:, 1:3], forces, rtol=0, atol=1e-10 * size)
        assert_allclose(found[:, 3:], moments, rtol=0, atol=1e-10 * size)


def test_a_rigid_bearing_is_the_beam_with_infinite_k_r() -> None:
    moments = closed_form(np.inf)[1]
    errors = []
    for stiffness in (1e14, 1e16):
        bearing = preloaded(stiffness)
        found = coupled_equilibrium(BODY, {"bearing": bearing}, FACTORS).of("bearing")
        errors.append(np.abs(found[:, 3:] - moments).max() / np.abs(moments).max())
    assert errors[0] < 1e-3
    assert errors[1] < 1e-5


def test_a_bearing_without_tilting_stiffness_is_the_pinned_beam() -> None:
    bearing = spherical_roller("spherical", 28, 0.06, 0.06, 0.75, 10.0)
    found = coupled_equilibrium(BODY, {"bearing": bearing}, FACTORS).of("bearing")
    L1, L2 = PARAMETERS.overhang, PARAMETERS.span
    size = np.abs(HUB).max()
    assert_allclose(found[:, 3:], 0.0, atol=1e-8 * size)
    assert_allclose(found[:, 2], pinned_reaction(HUB[:, 2], HUB[:, 4], L1, L2), rtol=1e-7)
    assert_allclose(found[:, 1], pinned_reaction(HUB[:, 1], -HUB[:, 5], L1, L2), atol=1e-7 * size)


def test_loads_supports_and_bearings_balance() -> None:
    body = in_housings(BODY, {"bearing": np.diag([3e9, 4e9, 5e9, 1e9, 145e6, 392e6])})
    for one in (BODY, body):
        found = coupled_equilibrium(one, {"bearing": BEARING_S}, FACTORS)
        assert found.converged.all()
        assert (found.residuals <= 1e-8).all()
        assert np.abs(found.imbalance()).max() < 1e-7 * np.abs(HUB).max()
        # the gearbox takes the torque and its own weight besides
        assert_allclose(found.reactions()["gearbox"][:, 3], HUB[:, 3], rtol=1e-9)


def test_newton_s_loads_are_those_that_the_bearing_by_itself_balances() -> None:
    found = coupled_equilibrium(BODY, {"bearing": BEARING_S}, FACTORS)
    alone = equilibrium(BEARING_S, found.of("bearing"))
    assert_allclose(
        found.rollers("bearing"), alone.rollers, rtol=0, atol=1e-5 * alone.rollers.max()
    )


def test_the_loop_and_newton_agree_for_a_linear_law() -> None:
    bearing = preloaded(2e9)
    K = contact_stiffness(bearing)
    loop = stiffness_loop(BODY, {"bearing": bearing}, FACTORS, translations=np.diag(K)[:3])
    found = coupled_equilibrium(BODY, {"bearing": bearing}, FACTORS)
    assert loop.converged.all()
    assert_allclose(loop.stiffness[:, 0], K[3, 3], rtol=1e-9)
    size = np.abs(found.of("bearing")).max()
    assert_allclose(loop.forces[:, 0], found.of("bearing"), rtol=0, atol=1e-7 * size)


def test_the_loop_stops_where_k_r_changes_by_one_percent() -> None:
    loop = stiffness_loop(BODY, {"bearing": BEARING_S}, FACTORS)
    assert loop.converged.all()
    assert (loop.rounds > 1).any()
    again = tilting_stiffness(BEARING_S, loop.displacements[:, 0])
    assert (np.abs(again / loop.stiffness[:, 0] - 1.0) <= 0.01).all()
    secant = tilting_stiffness(BEARING_S, loop.displacements[:, 0], "secant")
    assert np.abs(secant / again - 1.0).max() > 0.01


def test_a_housing_in_series_adds_its_compliance() -> None:
    bearing, housing = preloaded(2e9), np.diag([3e9, 4e9, 5e9, 1e9, 145e6, 392e6])
    body = in_housings(BODY, {"bearing": housing})
    found = coupled_equilibrium(body, {"bearing": bearing}, FACTORS).of("bearing")
    compliance = np.linalg.inv(contact_stiffness(bearing)) + np.diag(1.0 / np.diag(housing)[FIVE])
    K = np.zeros((6, 6))
    K[np.ix_(FIVE, FIVE)] = np.linalg.inv(compliance)
    assert_allclose(found, reference(K)[:, FIVE], rtol=0, atol=1e-8 * np.abs(found).max())
    # and springs: 145 and 1272 MN m/rad in series are 130
    one = on_springs(body, FACTORS, tilt_springs(BEARING_S, 1272e6)).forces[:, 0, 3]
    rigid = np.diag([1e30, 1e30, 1e30, 1e30, 145e6, 145e6])
    other = on_springs(
        in_housings(BODY, {"bearing": rigid}), FACTORS, tilt_springs(BEARING_S, 1272e6)
    ).forces[:, 0, 3]
    K_R = 1.0 / (1.0 / 145e6 + 1.0 / 1272e6)
    assert_allclose(other, closed_form(K_R)[1][:, 0], rtol=1e-9)
    assert np.abs(one - other).max() > 0.0


def two_bearings(axial: float = 0.0) -> LinearBody:
    beam = Beam([BeamSection(4.0, 0.6)], [Support("anything", 0.0, np.full(6, np.inf))], shear=True)
    names = ["hub", "front", "rear", "gearbox"]
    body = condensed_beam(beam, names, np.array([0.0, 1.0, 3.0, 4.0]))
    return linear_body(body, ["front", "rear"], {"gearbox": (axial, 0.0, 0.0, np.inf, 0.0, 0.0)})


CARB = toroidal("CARB", 30, 0.06, 0.1, 0.7)
LOCATING = spherical_roller("spherical", 28, 0.06, 0.06, 0.75, 10.0)


def test_a_floating_bearing_leaves_the_axial_force_to_its_neighbour() -> None:
    body = two_bearings()
    for bearings in (
        {"front": LOCATING, "rear": CARB},
        {"front": CARB, "rear": BEARING_S},
        {"front": CARB, "rear": LOCATING},
    ):
        found = coupled_equilibrium(body, bearings, factors_of(HUB))
        assert found.converged.all()
        floating, located = sorted(body.bearings, key=lambda name: bearings[name] is not CARB)
        assert_allclose(found.of(floating)[:, 0], 0.0, atol=1e-6)
        assert_allclose(found.of(located)[:, 0], HUB[:, 0], rtol=1e-6)
        assert np.abs(found.imbalance()).max() < 1e-7 * np.abs(HUB).max()


def test_a_shaft_on_two_pinned_bearings_is_determined_by_statics() -> None:
    found = coupled_equilibrium(two_bearings(), {"front": LOCATING, "rear": CARB}, factors_of(HUB))
    # moments about the front bearing: hub 1 m before, rear 2 m behind
    rear = -(HUB[:, 4] + 1.0 * HUB[:, 2]) / 2.0
    assert_allclose(found.of("rear")[:, 2], rear, rtol=1e-7)


def test_two_bearings_that_carry_moments_share_them_by_stiffness() -> None:
    body, bearings = two_bearings(), {"front": preloaded(2e9), "rear": preloaded(4e9)}
    K = {}
    for name, bearing in bearings.items():
        K[name] = np.zeros((6, 6))
        K[name][np.ix_(FIVE, FIVE)] = contact_stiffness(bearing)
    beam = Beam(
        [BeamSection(4.0, 0.6)],
        [
            Support("front", 1.0, K["front"]),
            Support("rear", 3.0, K["rear"]),
            Support("gearbox", 4.0, (0, 0, 0, np.inf, 0, 0)),
        ],
    )
    found = coupled_equilibrium(body, bearings, factors_of(HUB))
    for name in bearings:
        expected = solve(beam, 0.0, HUB).reaction(name)[:, FIVE]
        assert_allclose(found.of(name), expected, rtol=0, atol=1e-8 * np.abs(HUB).max())


def test_a_scene_s_shaft_on_linear_bearings_is_its_level_1() -> None:
    brake = {"name": "brake", "x": 0.7, "width": 0.1}
    scene = change_scene(library_scene("two_bearings"), {"load_points": [brake]})
    names = [unit.bearing.name for unit in scene.bearing_units]
    bearings = {name: preloaded(2e9) for name in names}
    K = np.zeros((6, 6))
    K[np.ix_(FIVE, FIVE)] = contact_stiffness(bearings[names[0]])
    level = shaft_level(scene, 1, dict.fromkeys(names, K))
    body = scene_body(scene, 1)
    at_brake = HUB[::-1] * [1.0, 1.0, 1.0, 0.0, 1.0, 1.0]
    found = coupled_equilibrium(body, bearings, factors_of(np.hstack([HUB, at_brake]), 1e5))
    assert np.abs(found.imbalance()).max() < 1e-6 * np.abs(HUB).max()
    with pytest.raises(InputError, match=r"shape \(n, 16\).*at hub, brake"):
        coupled_equilibrium(body, bearings, factors_of(HUB))
    expected = level.reactions(found.factors)
    for name in names:
        assert_allclose(
            found.of(name), expected[name][:, FIVE], rtol=0, atol=1e-7 * np.abs(HUB).max()
        )
    torque = found.reactions()["gearbox"][:, 3]
    assert_allclose(torque, expected["gearbox"][:, 3], rtol=1e-8)


@pytest.mark.parametrize("level", [1, 2])
def test_the_rear_bearing_of_a_scene_may_float(level: int) -> None:
    scene = library_scene("two_bearings")
    front, rear = (unit.bearing.name for unit in scene.bearing_units)
    housing = np.diag([2e10, 2e10, 2e10, 1e10, 1e9, 1e9])
    body = scene_body(scene, level, {front: housing, rear: housing})
    found = coupled_equilibrium(body, {front: BEARING_S, rear: CARB}, factors_of(HUB, 1e5, 9.81))
    assert found.converged.all()
    assert np.abs(found.of(rear)[:, 0]).max() == 0.0
    axial = found.reactions()["gearbox"][:, 0]
    assert_allclose(found.of(front)[:, 0] + axial, HUB[:, 0], rtol=1e-7)


def test_a_bearing_resists_tilting_about_any_axis_as_it_does_about_y() -> None:
    """Turned by whole pitches of its rollers, a tilt and its moment are the same."""
    bearing = double_row_tapered("S", 36, 0.065, 0.095, 0.7874, 38.0, 0.152, "X")
    u = np.array([2e-5, 1e-5, -3e-5, 4e-4, 1e-4])
    turned = turn(np.tile(u, (6, 1)), 2.0 * np.pi * np.array([0, 3, 9, 16, 18, 31]) / 36)
    for kind in ("tangent", "secant"):
        K = tilting_stiffness(bearing, turned, kind)
        np.testing.assert_allclose(K, K[0], rtol=1e-9)
    axis = turned[:, 3:] / np.hypot(4e-4, 1e-4)
    steps = [forces(bearing, turned + s * np.pad(axis, ((0, 0), (3, 0))))[0] for s in (-1e-9, 1e-9)]
    slope = np.einsum("ni,ni->n", steps[1][:, 3:] - steps[0][:, 3:], axis) / 2e-9
    np.testing.assert_allclose(tilting_stiffness(bearing, turned), slope, rtol=1e-4)


def test_mechanisms_are_refused_in_one_sentence() -> None:
    with pytest.raises(InputError, match=r"resists axial displacement.*bearing that locates"):
        coupled_equilibrium(two_bearings(), {"front": CARB, "rear": CARB}, factors_of(HUB))
    # without axial load the same shaft has its equilibrium
    still = HUB * [0, 1, 1, 1, 1, 1]
    found = coupled_equilibrium(two_bearings(), {"front": CARB, "rear": CARB}, factors_of(still))
    assert found.converged.all()
    one_row = Bearing(
        "one row", (tapered_row(36, 0.065, 0.095, 0.7874, 20.0, thrust=-1, laminae=0),)
    )
    bearings = {"front": one_row, "rear": CARB}
    with pytest.raises(InputError, match="lifts the inner ring of 'front'"):
        coupled_equilibrium(two_bearings(), bearings, factors_of(HUB[:1]))
    beam = condensed_beam(
        main_bearing_frame(PARAMETERS), ["hub", "gearbox"], np.array([-2.145, 2.615])
    )
    with pytest.raises(InputError, match="turns freely about its axis"):
        linear_body(beam, ["hub"], {"gearbox": (1e6, 1e6, 1e6, 0.0, 0.0, 0.0)})


def test_bad_input_is_refused() -> None:
    with pytest.raises(InputError, match="load case 1 is nan"):
        factors_of([[0.0] * 6, [0.0, 0.0, np.nan, 0.0, 0.0, 0.0]])
    with pytest.raises(InputError, match="give one for each of these"):
        coupled_equilibrium(BODY, {"front": BEARING_S}, FACTORS)
    with pytest.raises(InputError, match="'rear' is unknown"):
        coupled_equilibrium(BODY, {"bearing": BEARING_S}, FACTORS).of("rear")
    with pytest.raises(InputError, match="must have a finite 6x6 stiffness"):
        in_housings(BODY, {"bearing": np.diag([1e9, 1e9, 1e9, 1e9, 0.0, 1e9])})
    with pytest.raises(InputError, match="0 or more"):
        on_springs(BODY, FACTORS, np.full(5, -1.0))


def test_loads_in_a_clearance_converge() -> None:
    bearing = BEARING_S.with_rows(clearance=1e-4)
    factors = np.vstack([s * FACTORS for s in (1.0, 1e-2, 1e-4)])
    found = coupled_equilibrium(BODY, {"bearing": bearing}, factors)
    assert found.converged.all()
    assert (found.residuals <= 1e-8).all()
    # forces of a newton, followed down from larger ones
    small = coupled_equilibrium(BODY, {"bearing": bearing}, 1e-6 * FACTORS)
    assert small.converged.all()
    assert small.iterations.max() > 20
    assert (small.residuals <= 1e-6).all()


def test_scenarios_have_the_tangent_of_their_moments() -> None:
    table = displacement_scenarios([-2e-5, 6e-5], [1e-5, 4e-5])
    assert_allclose(table[7], [2e-5, 2.5e-5])
    tilts = np.linspace(2e-5, 3e-4, 31)  # at 0 the tangent of delta^1.1 is 0
    curves = [tilt_curve(BEARING_S, axial, radial, tilts) for axial, radial in table]
    for curve in curves:
        middle = 0.5 * (curve.stiffness[1:] + curve.stiffness[:-1])
        slope = np.diff(curve.moments) / np.diff(tilts)
        assert_allclose(slope, middle, rtol=0.02, atol=0.02 * curve.stiffness.max())
    assert tilt_curve(BEARING_S, 0.0, 0.0, [0.0]).moments[0] == 0.0
    low = min(curve.stiffness[1:].min() for curve in curves)
    high = max(curve.stiffness.max() for curve in curves)
    assert low < best_fit(curves) < high
