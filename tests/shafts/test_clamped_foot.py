"""Feet that preloaded bolts clamp: closed forms of rigid feet, balances, limits, and solids."""

import math
from dataclasses import replace

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.spatial import point_motions, wrench_transport
from fe_drivetrain.drivetrain_file.reading import parse_scene
from fe_drivetrain.elasticity.solve.cost_model import Cost
from fe_drivetrain.foreign.assembly import bolt_stiffness
from fe_drivetrain.foreign.foot import ClampedFoot
from fe_drivetrain.geometry import (
    Bearing,
    Housing,
    Thread,
    assembly_preload,
    coarse_thread,
    gmsh_session,
    yield_strength,
)
from fe_drivetrain.geometry.foreign_housing import Bolts
from fe_drivetrain.geometry.step_files import write_step
from fe_drivetrain.shafts.fidelity.bearing_units import unit_stiffness
from fe_drivetrain.shafts.fidelity.foot_opening import foot_warnings
from fe_drivetrain.shafts.response import foot_contact
from fe_drivetrain.shafts.response.foot_contact import clamped_foot
from fe_drivetrain.shafts.response.model import build_model, mesh_scene
from fe_drivetrain.shafts.response.unit_loads import unit_load_response

BEARING = Bearing(kind="ring")
SCENE = """
title: clamped
shaft: {{front: -1.0, sections: [{{length: 2.2, outer_diameter: 0.4}}]}}
bearing_units:
  - bearing: {{name: main_bearing, kind: ring}}
    housing:
      step: {file}
      seat: {{radius: 300}}
      held: [{{point: [0, 0, -420], normal: [0, 0, 1]}}]
      bolts: {{hole_radius: 26, washer_diameter: 140, hold: clamped, diameter: 48, preload: 4.0e5}}
    interface: bonded
gearbox: {{stiffness: [0, 0, 0, 0, 0, 0]}}
mesh: {{shaft: 0.3, bearing: 0.2, housing: 0.25, bearing_edge: 0.2, elements_per_turn: 8}}
"""

LENGTH, WIDTH, HEIGHT = 0.8, 0.4, 0.5  # of the foot along y and x, and of the seat over it [m]
FOUNDATION = 1e11  # N/m^3
HEADS = np.array([(a, b, 0.1 - HEIGHT) for a in (-0.15, 0.15) for b in (-0.3, 0.3)])
SHANK = bolt_stiffness(0.03, np.array([0.0, 0.0, 0.1]), np.zeros(3))
SOFT = 1e-3 * SHANK  # its force stays nearly as it is
PULL, TILT = np.eye(6)[2], np.eye(6)[3]
ALONG = SHANK[2, 2]
UNDER = FOUNDATION * LENGTH * WIDTH  # stiffness of the whole foundation [N/m]


def rigid_foot(count=(4, 20), bolts=SHANK, preload=1e5, ground=FOUNDATION):
    """A rigid block on an elastic foundation, on four bolts; its seat is above the middle."""
    x = ((np.arange(count[0]) + 0.5) / count[0] - 0.5) * WIDTH
    y = ((np.arange(count[1]) + 0.5) / count[1] - 0.5) * LENGTH
    places = np.array([(a, b, -HEIGHT) for a in x for b in y])
    directions = np.broadcast_to(np.eye(3)[[2, 0, 1]], (len(places), 3, 3))
    on_patches = point_motions(places).reshape(-1, 6, 6)[:, :3]
    rigid = np.concatenate(
        [
            np.einsum("pij,pjk->pik", directions, on_patches).reshape(-1, 6),
            point_motions(HEADS),
        ]
    )
    area = LENGTH * WIDTH / len(places)
    return ClampedFoot(
        1e-5 / (FOUNDATION * area) * np.eye(len(rigid)),
        rigid,
        np.full(len(places), area),
        places,
        directions,
        np.array([bolts] * 4),
        np.tile([0.0, 0.0, 1.0], (4, 1)),
        np.full(4, preload),
        ground,
    )


def test_a_bolt_has_the_stress_area_of_the_standard_and_the_preload_of_its_equivalent_stress():
    # ISO 898-1, in three digits [mm^2]
    for nominal, area in ((8, 36.6), (24, 353), (36, 817), (48, 1470)):
        assert float(f"{1e6 * coarse_thread(nominal / 1e3).area:.3g}") == area
    assert yield_strength("10.9") == pytest.approx(900e6)
    thread = Thread(0.024, 0.003)
    pulled = assembly_preload(thread, 940e6, 0.9, 0.12)
    torque = (
        pulled
        * thread.flank
        / 2
        * (0.003 / (math.pi * thread.flank) + 0.12 / math.cos(math.pi / 6))
    )
    tension, shear = pulled / thread.area, 12 * torque / (math.pi * thread.stressed**3)
    assert math.hypot(tension, math.sqrt(3) * shear) == pytest.approx(0.9 * 940e6, rel=1e-12)
    assert assembly_preload(thread, 940e6, 0.9, 0.0) > pulled


def test_a_pull_is_shared_as_in_the_force_diagram_of_bolt_and_clamped_parts():
    foot = rigid_foot()
    phi = 4 * ALONG / (4 * ALONG + UNDER)
    # the block gives by 1e-5 of the foundation
    assert foot.slopes()[1] @ PULL == pytest.approx(np.full(4, phi / 4), rel=1e-4)
    gap = 4e5 / (1 - phi)
    assert foot.opening(PULL)[0] == pytest.approx(gap, rel=1e-4)
    before, after = foot.state(0.9 * gap * PULL), foot.state(1.5 * gap * PULL)
    assert before.closed.all()
    assert before.tension == pytest.approx(np.full(4, 1e5 + phi * 0.9 * gap / 4), rel=1e-4)
    assert not after.closed.any()
    assert after.tension == pytest.approx(np.full(4, 1.5 * gap / 4), rel=1e-9)


@pytest.mark.parametrize("count", [10, 40])
def test_a_rigid_foot_gaps_at_the_moment_of_its_kern(count):
    foot = rigid_foot((2, count), SOFT)
    kern = 4e5 * LENGTH / 6
    # patches: the outer one has its centre inside of the edge, by which it opens later
    assert foot.opening(TILT)[0] == pytest.approx(kern * (1 + 1 / count), rel=2e-3)
    stiff = rigid_foot((2, count))
    # bolts take their share of the moment, and it turns the block by less
    assert stiff.opening(TILT)[0] > 1.02 * foot.opening(TILT)[0]


def test_beyond_the_kern_the_pressure_is_a_triangle():
    force = 4e5
    foot = rigid_foot((1, 120), SOFT, preload=0.0)
    for share in (0.2, 0.35):
        off = share * LENGTH
        state = foot.state(-force * PULL + off * force * TILT)
        length = 3 * (LENGTH / 2 - off)
        largest = 2 * force / (length * WIDTH)
        assert state.closed.mean() == pytest.approx(length / LENGTH, abs=1 / 120)
        assert state.motion[3] == pytest.approx(largest / FOUNDATION / length, rel=5e-3)
        assert state.forces[:, 0].max() / foot.areas[0] == pytest.approx(largest, rel=0.03)


def test_without_preload_a_pressed_foot_is_the_foundation_alone():
    foot = rigid_foot(preload=0.0)
    state = foot.state(-1e5 * PULL)
    assert state.motion[2] == pytest.approx(-1e5 / (UNDER + 4 * ALONG), rel=1e-4)
    assert foot.state(1e5 * PULL).motion[2] == pytest.approx(1e5 / (4 * ALONG), rel=1e-4)


def test_a_large_preload_keeps_the_foot_tied():
    foot, tied = rigid_foot(preload=1e5), rigid_foot(preload=1e8)
    load = np.array([1e4, 2e4, 3e5, 1e5, 2e4, 1e4])
    assert not foot.state(load).closed.all()
    assert np.allclose(tied.state(load).motion, np.linalg.solve(tied.stiffness, load), rtol=1e-9)
    offsets = foot.places[:, 1]
    exact = FOUNDATION * foot.areas @ offsets**2 + 4 * (ALONG * 0.3**2)
    C = np.linalg.inv(foot.stiffness)
    # the heads turn with the block, by which the bolts bend, too
    assert 1 / C[3, 3] == pytest.approx(exact, rel=1e-2)
    assert 1 / C[3, 3] > exact


@pytest.mark.parametrize("load", [[1e4, 2e4, 3e5, 1e5, 2e4, 1e4], [0, 0, -2e5, 0, 9e4, 3e4]])
def test_ground_and_bolts_balance_the_load_and_nothing_is_pulled(load):
    foot = rigid_foot()
    state = foot.state(np.array(load))
    total = np.array(load, dtype=float)
    for place, axes, force in zip(foot.places, foot.directions, state.forces, strict=True):
        total += wrench_transport(place)[:, :3] @ (axes.T @ force)
    for head, wrench in zip(HEADS, state.bolts, strict=True):
        total += wrench_transport(head) @ wrench
    assert np.abs(total).max() < 1e-8 * np.abs(load).max()
    assert (~state.closed).any()
    assert state.forces[:, 0].min() > -1e-6 * state.forces[:, 0].max()
    assert state.lifts[~state.closed].min() > 0
    assert np.all(state.forces[~state.closed] == 0)


def test_opposite_moments_are_mirror_images():
    foot = rigid_foot()
    one, other = foot.state(9e4 * TILT), foot.state(-9e4 * TILT)
    assert one.motion[3] == pytest.approx(-other.motion[3], rel=1e-9)
    assert one.tension[[1, 0, 3, 2]] == pytest.approx(other.tension, rel=1e-9)
    assert one.motion[3] > foot.linear(9e4 * TILT).motion[3]


def test_the_work_of_a_load_that_opens_the_foot_is_stored_in_ground_and_bolts():
    foot = rigid_foot(ground=FOUNDATION)
    flexibility = np.linalg.inv(SHANK)

    def stored(state):
        ground = (state.forces**2).sum(axis=1) / (2 * FOUNDATION * foot.areas)
        bolts = 0.5 * np.einsum("bi,ij,bj->b", state.bolts, flexibility, state.bolts)
        block = (
            1e-5
            / (2 * FOUNDATION * foot.areas[0])
            * ((state.forces**2).sum() + (state.bolts**2).sum())
        )
        return ground.sum() + bolts.sum() + block

    load = np.array([0.0, 0.0, 1e5, 1e5, 0.0, 0.0])
    factors = np.linspace(0, 1, 101)
    states = foot.path(load, factors)
    moved = np.array([state.motion @ load for state in states])
    work = ((factors[1:] + factors[:-1]) / 2 * np.diff(moved)).sum()
    assert not states[-1].closed.all()
    assert stored(states[-1]) - stored(states[0]) == pytest.approx(work, rel=1e-3)


def test_loads_that_open_the_foot_are_found_among_many():
    foot = rigid_foot()
    gap, patch = foot.opening(TILT)
    assert foot.places[patch][1] == foot.places[:, 1].max()
    loads = np.array([0.99, 1.01])[:, None] * gap * TILT
    assert foot.opened_by(loads).tolist() == [False, True]


@pytest.fixture(scope="module")
def clamped(tmp_path_factory):
    """The bolted block from STEP, clamped by four bolts, on a coarse mesh."""
    folder = tmp_path_factory.mktemp("clamped")
    with gmsh_session():
        solid = Housing(base="bolted").build(BEARING)
        write_step(folder / "block.step", [solid.volume])
    return parse_scene(SCENE.format(file=folder / "block.step"))


@pytest.fixture(scope="module")
def foot(clamped):
    return clamped_foot(clamped, "main_bearing", "superlu")


@pytest.fixture(scope="module")
def solved(clamped):
    return unit_load_response(build_model(clamped, mesh_scene(clamped)), "superlu")


def test_levels_stand_on_the_foot_as_the_bolts_leave_it(clamped, foot, solved):
    K = unit_stiffness(clamped, "main_bearing", "rigid", "superlu", ring=False)
    assert np.abs(foot.stiffness - K).max() < 1e-8 * np.abs(K).max()
    assert solved.equilibrium_error < 1e-8


def test_hub_loads_that_open_a_foot_are_named_in_one_sentence(clamped, solved):
    loads = np.zeros((4, 6))
    loads[:, 2] = [-1e5, -1e5, 1.0e6, 2.0e6]
    weights = np.full(4, 0.25)
    (sentence,) = foot_warnings(clamped, solved, loads, weights, 9.81)
    assert sentence.startswith("main_bearing: hub loads open its foot for ")
    assert sentence.count(". ") == 0
    assert foot_warnings(clamped, solved, 1e-4 * loads, weights, 0.0) == ()


@pytest.mark.parametrize(
    ("seconds", "fits", "method"),
    [(4.9, True, "superlu"), (5.1, True, "multigrid"), (4.9, False, "multigrid")],
)
def test_a_rigid_seat_costs_multigrid_five_times_its_iterations(monkeypatch, seconds, fits, method):
    costs = [Cost("multigrid", 1.0, 1e6, True), Cost("superlu", seconds, 1e9, fits)]
    monkeypatch.setattr(foot_contact, "predict", lambda system, n_loads, tolerance: costs)
    assert foot_contact._chosen(None, 100) == method


def test_a_tightened_foot_presses_as_its_bolts_pull(foot):
    state = foot.tightened
    assert state.tension == pytest.approx(np.full(4, 4e5), rel=1e-9)
    assert state.forces[:, 0].sum() == pytest.approx(1.6e6, rel=1e-6)
    assert foot.areas.sum() == pytest.approx(0.36 * 1.25 - 4 * math.pi * 0.026**2, rel=2e-3)
    # the foot slides while it is tightened
    assert np.abs(state.forces[:, 1:]).max() < 1e-6 * state.forces[:, 0].max()
    # and the same under any preload
    other = replace(foot, preload=2 * foot.preload).tightened
    assert np.array_equal(state.closed, other.closed)
    assert other.forces == pytest.approx(2 * state.forces, abs=1e-6 * 1.6e6)


def test_bolts_take_over_where_the_foot_of_a_solid_opens(foot):
    load = 4e5 * np.eye(6)[3]
    state, linear = foot.state(load), foot.linear(load)
    assert state.motion[3] > 1.05 * linear.motion[3]
    assert state.tension.max() > linear.tension.max()
    total = load + foot.rigid.T @ np.concatenate([state.forces.ravel(), state.bolts.ravel()])
    assert np.abs(total).max() < 1e-7 * 4e5


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"preload": None}, "hold is 'clamped' and there is no preload"),
        ({"property_class": "8.8"}, "preload and property_class"),
        ({"hold": "beams"}, "make hold 'clamped', or leave it out"),
        ({"of_yield": 0.7}, "of_yield belongs to a property_class"),
        ({"diameter": None}, "there is no diameter"),
    ],
)
def test_bolts_that_do_not_fit_together_are_refused(changes, words):
    bolts = {"hole_radius": 26, "washer_diameter": 92, "hold": "clamped", "diameter": 48}
    with pytest.raises(InputError, match=words):
        Bolts(**(bolts | {"preload": 5e5} | changes))


def test_a_property_class_needs_a_thread_of_the_table():
    bolts = Bolts(
        hole_radius=26, washer_diameter=92, hold="clamped", diameter=47, property_class="8.8"
    )
    with pytest.raises(InputError, match=r"no coarse metric thread has a diameter of 47 mm"):
        bolts.tightened(1e-3)
    thread = bolts.model_copy(update={"diameter": 48})
    assert thread.tightened(1e-3) == pytest.approx(
        assembly_preload(coarse_thread(0.048), 640e6, 0.9, 0.12)
    )
