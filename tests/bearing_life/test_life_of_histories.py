"""Life over load histories: sums that close, Miner's rule step by step, limits, levels."""

import pickle
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from fe_drivetrain.bearing.answers import pressures, race_pressures
from fe_drivetrain.bearing.arrangements import (
    ball_row,
    cylindrical,
    double_row_tapered,
    tapered_row,
)
from fe_drivetrain.bearing.geometry import Bearing
from fe_drivetrain.bearing.races import rigid_races
from fe_drivetrain.bearing.rolling import equilibrium
from fe_drivetrain.bearing_life.coupled.load_paths import PINNED, LoadPath, damage_of_hub_loads
from fe_drivetrain.bearing_life.coupled.of_scene import scene_body
from fe_drivetrain.bearing_life.life.at_site import site_lives
from fe_drivetrain.bearing_life.life.life_rules import LifeRules
from fe_drivetrain.bearing_life.life.limits import centrifugal_load, check_speed, static_use
from fe_drivetrain.bearing_life.life.load_series import equivalent_life
from fe_drivetrain.bearing_life.life.lubricants import SUPPLIES, Lubricant, contamination_factor
from fe_drivetrain.bearing_life.life.modified_life import (
    equivalent_loads,
    life_factor,
    modified_lamina_life,
)
from fe_drivetrain.bearing_life.life.rated import (
    Factors,
    of_geometry,
    rated_bearing,
    rated_from_catalogue,
)
from fe_drivetrain.bearing_life.life.reference_life import (
    ball_life,
    basic_life,
    lamina_life,
    reference_load,
    rows_of,
)
from fe_drivetrain.bearing_life.life.roller_damage import (
    Damage,
    damage_of_history,
    damage_of_steps,
    step_lives,
)
from fe_drivetrain.bearing_life.life.roller_models import (
    flexible_rings,
    rigid_rings,
    steps_of,
    three_degree_rings,
)
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.reading import change_scene, library_scene
from fe_drivetrain.shafts.beam.of_scene import beam_of_scene
from fe_drivetrain.shafts.beam.shaft import solve
from fe_drivetrain.shafts.fidelity.shafts import ringed_shaft
from fe_drivetrain.turbine_loads.histories.sites import Site, site_life

LAMINAE = 10
BEARING = double_row_tapered("S", 36, 0.065, 0.095, 0.7874, 20.0, 0.152, "O", laminae=LAMINAE)
RATED = rated_bearing(BEARING, 6.71e6, 1.66e7, 1.1e6)
GREASE = Lubricant(460.0, 30.5, 40.0, cleanliness="slight to typical")
RULES = LifeRules(GREASE)


@pytest.fixture(scope="module")
def history() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Loads on a bearing, speeds [1/min] and durations [s]."""
    rng = np.random.default_rng(4)
    means, spreads = [2e5, 0, -4e5, 3e5, 0], [5e4, 5e4, 1e5, 3e5, 3e5]
    loads = rng.normal(means, spreads, (40, 5))
    return loads, rng.uniform(8, 20, 40), rng.uniform(0.5, 2, 40)


def max_of_all(of_rows) -> np.ndarray:
    """(n,) of pressures by row, ring and roller."""
    return np.max([p.max(axis=1) for row in of_rows for p in row], axis=0)


@pytest.fixture(scope="module")
def damage(history) -> Damage:
    return damage_of_history(steps_of(rigid_rings(BEARING), *history), RATED, RULES)


def test_damage_is_miners_sum_over_lives_of_steps(history, damage: Damage) -> None:
    loads, speed, seconds = history
    found = equilibrium(BEARING, loads)
    rows = rows_of(BEARING, found.displacements, RATED.dynamic)
    turns = speed * seconds / 60
    assert_allclose(damage.turns, turns.sum(), rtol=1e-13)
    assert_allclose(damage.totals["L10r"], 1e-6 * (turns / lamina_life(rows)).sum(), rtol=1e-10)
    kappa = GREASE.kappa(speed, 0.7874)
    e_C = GREASE.contamination(kappa, 0.7874)
    limit = (0.5 * 1.1e6 * e_C)[:, None]
    factors = [life_factor(limit / equivalent_loads(row), kappa[:, None]) for row in rows]
    modified = modified_lamina_life(rows, factors)
    assert_allclose(damage.totals["L10mr"], 1e-6 * (turns / modified).sum(), rtol=1e-10)
    assert_allclose(
        damage.lives("Mrev")["L10r"], equivalent_life(lamina_life(rows), turns), rtol=1e-10
    )
    P = RATED.equivalent_load(loads)
    assert_allclose(damage.totals["L10"], 1e-6 * (turns / basic_life(6.71e6, P)).sum(), rtol=1e-12)
    a = life_factor(1.1e6 * e_C / P, kappa)
    L10m = a * basic_life(6.71e6, P)
    assert_allclose(damage.totals["L10m"], 1e-6 * (turns / L10m).sum(), rtol=1e-12)
    assert_allclose(damage.lives("years")["L10"] * 8760, damage.lives()["L10"], rtol=1e-14)


def test_parts_of_the_damage_sum_to_the_whole(damage: Damage) -> None:
    for modified, kind in ((False, "L10r"), (True, "L10mr")):
        whole = damage.totals[kind]
        assert_allclose(damage.of_rows(modified).sum(), whole, rtol=1e-13)
        for of in (damage.of_positions, damage.of_laminae):
            assert_allclose(sum(of(r, modified).sum() for r in (0, 1)), whole, rtol=1e-13)
    # a ring alone would use up more than its part, and no more than all
    parts = damage.of_rows()
    assert (damage.alone[0] > parts).all()
    assert (damage.alone[0] < damage.totals["L10r"]).all()


def test_chunks_order_and_repetition_do_not_matter(history, damage: Damage) -> None:
    loads, speed, seconds = history
    turned = (loads[::-1], speed[::-1], seconds[::-1])
    again = damage_of_history(steps_of(rigid_rings(BEARING), *turned, chunk=7), RATED, RULES)
    for mine, its in zip(damage.basic + damage.modified, again.basic + again.modified, strict=True):
        assert_allclose(mine, its, rtol=1e-9, atol=1e-14 * damage.totals["L10r"])
    twice = damage + damage
    assert_allclose(twice.lives()["L10mr"], damage.lives()["L10mr"], rtol=1e-14)
    assert_allclose(damage.times(2.0).totals["L10m"], twice.totals["L10m"], rtol=1e-14)
    assert twice.limits.max_load == damage.limits.max_load


def test_life_goes_with_the_fourth_power_of_all_loads(history, damage: Damage) -> None:
    loads, speed, seconds = history
    steps = steps_of(rigid_rings(BEARING), 2.0 * loads, speed, seconds)
    doubled = damage_of_history(steps, RATED, RULES)
    assert_allclose(doubled.totals["L10r"], 16.0 * damage.totals["L10r"], rtol=1e-6)
    assert_allclose(doubled.totals["L10"], 2 ** (10 / 3) * damage.totals["L10"], rtol=1e-12)
    assert_allclose(doubled.limits.max_roller_load, 2 * damage.limits.max_roller_load, rtol=1e-6)


def test_damage_stands_where_the_load_is() -> None:
    load = [0, 0, -4e5, 0, 0]
    steps = next(steps_of(rigid_rings(BEARING), load, 18.0, 1.0))
    for turning, standing in (("inner", 1), ("outer", 0)):
        one = damage_of_steps(steps, RATED, LifeRules(turning=turning))
        q = steps.laminae[0].sum(axis=2)[0]
        places = one.of_positions(0)
        # a straight roller loaded evenly: the ring that stands by powers of 4.5, the other of 4
        for ring, power in ((standing, 4.5), (1 - standing, 4.0)):
            share = places[ring] / places[ring].sum()
            assert_allclose(share, q**power / (q**power).sum(), atol=1e-9)
        assert np.argmax(places[1]) == 27  # 270 degrees: below


def test_a_bearing_that_stands_or_is_out_of_balance_is_counted_not_computed(history) -> None:
    loads, speed, seconds = history
    speed = speed.copy()
    speed[:4], speed[4:8] = 0.01, -speed[4:8]
    steps = next(steps_of(rigid_rings(BEARING), loads, speed, seconds))
    found = damage_of_steps(steps, RATED, RULES)
    assert_allclose(found.limits.standing, seconds[:4].sum(), rtol=1e-14)
    assert found.limits.reversals == 1.0
    rest = [part[4:] for part in (loads, np.abs(speed), seconds)]
    moving = damage_of_history(steps_of(rigid_rings(BEARING), *rest), RATED, RULES)
    assert_allclose(found.totals["L10mr"], moving.totals["L10mr"], rtol=1e-8)
    assert found.seconds > moving.seconds
    steps.converged[:] = False
    lost = damage_of_steps(steps, RATED, RULES)
    assert lost.limits.lost == pytest.approx(seconds.sum())
    assert not any(lost.totals.values())


def test_limits_of_the_methods_are_timed(history) -> None:
    loads, _, _ = history
    steps = next(steps_of(rigid_rings(BEARING), 30 * loads, 18.0, 1.0))
    found = damage_of_steps(steps, RATED, LifeRules(Lubricant(460, 30.5, 100.0)))
    P, P0 = RATED.equivalent_load(steps.loads), RATED.static_load(steps.loads)
    of_rollers = 6.71e6 / step_lives(RATED, steps.laminae, RULES) ** 0.25
    assert 0 < found.limits.heavy == (np.maximum(P, of_rollers) > 0.5 * 6.71e6).sum()
    assert_allclose(found.limits.max_reference, of_rollers.max(), rtol=1e-12)
    p = max_of_all(pressures(BEARING, equilibrium(BEARING, steps.loads).displacements))
    assert (P0 > 1.66e7).sum() < found.limits.weak == ((P0 > 1.66e7) | (p > 4e9)).sum()
    assert_allclose(found.limits.max_pressure, p.max(), rtol=1e-6)
    assert found.limits.thin == found.limits.thick == 0.0
    slow = damage_of_steps(
        next(steps_of(rigid_rings(BEARING), loads, 1.0, 1.0)),
        RATED,
        LifeRules(Lubricant(80.0, 8.6, 90.0)),
    )
    assert slow.limits.thin == len(loads)
    assert_allclose(slow.totals["L10mr"], 10 * slow.totals["L10r"], rtol=1e-12)


def test_a_moment_alone_brings_the_static_safety_of_the_rollers_below_1() -> None:
    """P0 of a moment is 0, and so is P; pressure in line contact goes with the root of the load."""
    model = rigid_rings(BEARING)
    one = damage_of_steps(next(steps_of(model, [0, 0, 0, 2e6, 0], 18.0, 1.0)), RATED, RULES).limits
    M = 2e6 * (4.8e9 / one.max_pressure) ** 2
    found = damage_of_steps(next(steps_of(model, [0, 0, 0, M, 0], 18.0, 1.0)), RATED, RULES).limits
    assert found.max_pressure == pytest.approx(4.8e9, rel=1e-6)
    assert found.static_safety == pytest.approx((4.0 / 4.8) ** 2, rel=1e-6)
    assert found.max_load == found.max_static == 0.0
    assert found.weak == found.heavy == 1.0


def test_ratings_stand_for_the_pressures_of_iso_76() -> None:
    """Q = 5 F / (i Z cos alpha) under C_0 has 4,000 MPa on rollers, and 4,200 MPa on balls."""
    rollers = rated_bearing(cylindrical("c", 20, 0.03, 0.05, 0.3, laminae=1), 1e6)
    most = max(race_pressures(rollers.bearing.rows[0], 5.0 * rollers.static / 20.0))
    assert most == pytest.approx(rollers.static_pressure, rel=0.005)
    balls = rated_bearing(Bearing("b", (ball_row(8, 0.01, 0.05),)), 1e4)
    most = max(race_pressures(balls.bearing.rows[0], 5.0 * balls.static / 8.0))
    assert most == pytest.approx(balls.static_pressure, rel=0.005)
    # the load of a ball goes with the cube of its pressure
    doubled = [0.0, 0.0, 0.0, 0.0, 0.0], 2.0 * balls.static_pressure
    assert static_use(balls, *doubled) == pytest.approx(8.0)


def test_speeds_that_no_bearing_has_are_refused() -> None:
    step = next(steps_of(rigid_rings(BEARING), [0, 0, -4e5, 0, 0], -1.2e7, 1.0))
    with pytest.raises(InputError, match=r"1\.2e\+07 1/min: .* 787\.4 mm .* 3\.81e\+03 1/min"):
        damage_of_steps(step, RATED, RULES)
    with pytest.raises(InputError, match="nan 1/min"):
        check_speed(RATED, [18.0, np.nan])
    check_speed(RATED, [-3800.0, 3800.0])
    slow = replace(RATED, limiting_speed_rpm=17.0)
    seconds = np.array([1.0, 2.0, 4.0])
    steps = next(
        steps_of(rigid_rings(BEARING), np.tile([0, 0, -4e5, 0, 0], (3, 1)), [16, -18, 18], seconds)
    )
    assert damage_of_steps(steps, slow, RULES).limits.fast == 6.0
    assert damage_of_steps(steps, RATED, RULES).limits.fast == 0.0


def test_a_roller_is_pressed_out_by_its_weight_as_the_cage_turns() -> None:
    """m r omega^2 of 2.475 kg on 393.7 mm, the cage at 0.4612 of the ring's speed."""
    mass = 7850.0 * np.pi / 4 * 0.065**2 * 0.095
    gamma = 65 * np.cos(np.radians(20)) / 787.4
    cage = 0.5 * (1 - gamma) * 2 * np.pi * 1000 / 60
    assert centrifugal_load(BEARING, 1000.0) == pytest.approx(mass * 0.3937 * cage**2, rel=1e-12)
    ball = Bearing("b", (ball_row(8, 0.01, 0.05),))
    mass = 7850.0 * np.pi / 6 * 0.01**3
    assert centrifugal_load(ball, 60.0) == pytest.approx(mass * 0.025 * (0.8 * np.pi) ** 2)


def test_reliability_scales_modified_life_alone(history) -> None:
    loads, speed, seconds = history
    steps = next(steps_of(rigid_rings(BEARING), loads, speed, seconds))
    half = damage_of_steps(steps, RATED, LifeRules(GREASE, reliability=0.5)).lives()
    whole = damage_of_steps(steps, RATED, RULES).lives()
    for kind, factor in (("L10", 1.0), ("L10r", 1.0), ("L10m", 0.5), ("L10mr", 0.5)):
        assert_allclose(half[kind], factor * whole[kind], rtol=1e-12)


@pytest.mark.parametrize(("axial", "force", "life"), [(0.0, 1e3, 13163.019), (1e3, 0.0, 2222.7318)])
def test_balls_have_mastas_lives_and_their_own_factor(axial, force, life: float) -> None:
    row = ball_row(7, 0.0115, 0.0435, youngs_modulus=210e9)
    rated = rated_bearing(Bearing("ball", (row,)), 23400.0)
    oil = Lubricant(100.0, 11.0, 50.0, "oil bath", "-/15/12")
    rules = LifeRules(oil)
    steps = next(steps_of(rigid_rings(rated.bearing), [axial, -force, 0, 0, 0], 1500.0, 60.0))
    found = damage_of_steps(steps, rated, rules)
    assert_allclose(found.lives("Mrev")["L10r"], life, rtol=1e-4)
    assert_allclose(step_lives(rated, steps.laminae, rules), life, rtol=1e-4)
    kappa = oil.kappa(1500.0, 0.0435)
    P_ref = reference_load(23400.0, found.lives("Mrev")["L10r"], 3.0)
    ratio = oil.contamination(kappa, 0.0435) * rated.fatigue / P_ref
    a = life_factor(ratio, kappa, "point")
    assert_allclose(found.lives()["L10mr"], a * found.lives()["L10r"], rtol=1e-10)


def test_levels_of_the_bearing_agree_where_they_have_to(history) -> None:
    loads = history[0][:6]
    closed = rigid_rings(BEARING.with_rows(laminae=0))(loads)[0]
    races = flexible_rings(rigid_races(BEARING.with_rows(laminae=0)))(loads)[0]
    for mine, its in zip(closed, races, strict=True):
        # the closed form's equilibrium against that of 30 laminae: second order in 1/30
        assert_allclose(mine.sum(axis=2), its.sum(axis=2), atol=2e-3 * mine.sum(axis=2).max())
        assert_allclose(mine, its, atol=2e-2 * mine.max())
    plane = np.array([[2e5, 0, -4e5, 8e5, 0]])
    five, three = (model(BEARING)(plane)[0] for model in (rigid_rings, three_degree_rings))
    for mine, its in zip(five, three, strict=True):
        assert_allclose(mine, its, atol=1e-5 * mine.max())


@pytest.mark.parametrize(
    "model",
    [
        rigid_rings(BEARING),
        three_degree_rings(BEARING),
        flexible_rings(rigid_races(BEARING.with_rows(laminae=0))),
    ],
    ids=["rigid", "three-degree", "flexible"],
)
def test_models_of_rollers_go_to_other_processes(model) -> None:
    """Many files are shared out to processes, and with them each bearing's model."""
    load = np.array([[2e5, 0, -4e5, 8e5, 0]])
    sent = pickle.loads(pickle.dumps(model))
    for mine, its in zip(model(load)[0], sent(load)[0], strict=True):
        assert_allclose(its, mine, rtol=1e-12)


def test_hub_loads_reach_the_rollers_by_the_path_that_is_named() -> None:
    scene = library_scene("two_bearings")
    bearings = {
        "front": rated_from_catalogue("bearing_s_o20", laminae=LAMINAE).bearing,
        "rear": rated_from_catalogue("main_bearing_spherical", laminae=LAMINAE).bearing,
    }
    hub = [[2e5, 0, -4e5, 1e6, 8e5, 2e5], [1e5, 3e4, -3e5, 1e6, -3e5, 0]]
    body = scene_body(scene, 1)
    paths = {K: LoadPath(body, bearings, "front", tilt_stiffness=K) for K in (None, PINNED, 5e8)}
    loads = {K: path.bearing_loads(hub)[0] for K, path in paths.items()}
    assert_allclose(loads[PINNED][:, 3:], 0.0, atol=1e-6)
    assert (np.abs(loads[5e8][:, 3]) > 1e4).all()
    rated = rated_bearing(bearings["front"], 6.71e6, 1.66e7, 1.1e6)
    lives = {
        K: damage_of_hub_loads(path, hub, 18.0, 1.0, rated, LifeRules()).lives()["L10r"]
        for K, path in paths.items()
    }
    assert lives[PINNED] > lives[5e8]  # a pinned support knows no moment
    alone = damage_of_history(
        steps_of(rigid_rings(bearings["front"]), loads[None], 18.0, 1.0), rated, LifeRules()
    )
    assert_allclose(alone.lives()["L10r"], lives[None], rtol=1e-6)
    with pytest.raises(InputError, match="front, rear"):
        LoadPath(body, bearings, "middle")
    # a load between the two follows the lever rule, but for what the gearbox's springs take
    brake = {"name": "brake", "x": 0.7, "width": 0.1}
    body = scene_body(change_scene(scene, {"load_points": [brake]}), 1)
    half = LoadPath(body, bearings, "front", tilt_stiffness=PINNED)
    (found,) = half.bearing_loads([[0.0] * 6 + [0, 0, 1e5, 0, 0, 0]])[0]
    assert_allclose(found[2], 1e5 * (1.6 - 0.7) / 1.6, rtol=0.05)


@pytest.mark.parametrize("rear", ["bearing_s_o20", "main_bearing_spherical"])
@pytest.mark.parametrize("K", [PINNED, 5e8])
def test_the_named_bearing_alone_has_the_tilting_stiffness(rear: str, K: float) -> None:
    """As a beam on rigid supports, of which the one resists tilting, and the other does not."""
    scene = library_scene("two_bearings")
    bearings = {
        "front": rated_from_catalogue("bearing_s_o20", laminae=LAMINAE).bearing,
        "rear": rated_from_catalogue(rear, laminae=LAMINAE).bearing,
    }
    hub = np.array([[2e5, 0, -4e5, 1e6, 8e5, 2e5], [1e5, 3e4, -3e5, 1e6, -3e5, 0]])
    weights = {"gearbox_weight": 4e5, "gravity": 9.81}
    path = LoadPath(scene_body(scene, 1), bearings, "front", tilt_stiffness=K, **weights)
    ringed = scene.model_copy(update={"shaft": ringed_shaft(scene)[0]})
    rigid = [np.inf, np.inf, np.inf, 0.0]
    beam = beam_of_scene(ringed, {"front": [*rigid, K, K], "rear": [*rigid, 0.0, 0.0]})
    loads = np.stack([hub, np.tile([0, 0, -4e5, 0, 0, 0], (2, 1))], axis=1)
    ends = [scene.shaft.front, scene.shaft.rear]
    solution = solve(beam, ends, loads, gravity=(0.0, 0.0, -9.81))
    expected = solution.reaction("front")[:, [0, 1, 2, 4, 5]]
    size = np.abs(hub).max()
    assert_allclose(path.bearing_loads(hub)[0], expected, rtol=0, atol=1e-8 * size)


def test_a_site_weights_winds_by_their_time(damage: Damage) -> None:
    site = Site(10.0)
    other = damage.times(3.0) + damage.times(1.0)  # as long four times
    life = site_lives([(8.0, damage), (12.0, other), (12.0, damage), (16.0, damage.times(5))], site)
    years = damage.lives("years")
    for kind in years:  # all winds are the same: life over the share of time
        assert_allclose(life.years[kind], years[kind] / life.shares.sum(), rtol=1e-12)
        assert_allclose(life.years[kind], site_life([years[kind]] * 3, life.shares), rtol=1e-12)
        assert_allclose(life.of_winds(kind), life.shares / life.shares.sum(), rtol=1e-12)
    with pytest.raises(InputError, match="limits"):
        site_lives([(8.0, damage)], site, np.array([1.0, 2.0, 3.0]))


def test_equivalent_loads_are_those_of_the_standards_tables() -> None:
    tapered = rated_from_catalogue("masta_single").bearing
    found = of_geometry(tapered)
    # a published MASTA model prints both
    assert_allclose([found.e, found.above[1]], [0.5165, 1.1617], atol=5e-5)
    P = RATED.equivalent_load([[0, 3e5, 4e5, 9e9, 0], [1e6, 0, 5e5, 0, 0]])
    cot = 1 / np.tan(np.radians(20))
    assert_allclose(P, [5e5, 0.67 * 5e5 + 0.67 * cot * 1e6], rtol=1e-12)
    assert_allclose(RATED.static_load([1e6, 0, 5e5, 0, 0]), 5e5 + 0.44 * cot * 1e6)
    planet = rated_from_catalogue("planet_nj2232")
    assert_allclose(planet.equivalent_load([0, 3.0, 4.0, 0, 0]), 5.0)
    deep = rated_bearing(Bearing("deep", (ball_row(8, 0.01, 0.06),)), 3e4, 14e3)
    # f_0 F_a / C_0 = 0.689 of the table: e 0.26, Y 1.71
    axial = 0.689 * 14e3 / 14.0
    assert_allclose(deep.equivalent_load([axial, 1e3, 0, 0, 0]), 560 + 1.71 * axial, rtol=1e-12)
    assert_allclose(deep.equivalent_load([axial, 1e4, 0, 0, 0]), 1e4, rtol=1e-12)
    own = Factors(0.3, (1.0, 2.0), (0.7, 3.0), (1.0, 1.0))
    given = rated_bearing(BEARING, factors=own)
    assert_allclose(
        given.equivalent_load([[100, 1000, 0, 0, 0], [400, 1000, 0, 0, 0]]), [1200, 1900]
    )
    assert "ISO 281" in given.sources[0]


def test_oil_has_the_contamination_factor_of_masta() -> None:
    """Oil bath, kappa 3.413 and D_pw 51.56 mm: 0.8174, from public code that quotes MASTA."""
    assert_allclose(contamination_factor(3.413, 0.05156, "oil bath", "-/13/10"), 0.8174, atol=5e-5)


@pytest.mark.parametrize("supply", SUPPLIES)
def test_a_cleaner_lubricant_has_the_larger_factor(supply) -> None:
    kappa = np.array([0.2, 1.0, 4.0])
    factors = [contamination_factor(kappa, 0.5, supply, name) for name in SUPPLIES[supply]]
    assert (np.diff(factors, axis=0) < 0.0).all()
    assert (np.diff(factors, axis=1) >= 0.0).all()


def test_life_factors_of_balls_meet_between_branches() -> None:
    for kappa in (0.4, 1.0):
        below = life_factor(0.5, np.nextafter(kappa, 0), "point")
        assert_allclose(life_factor(0.5, kappa, "point"), below, rtol=1e-3)


def damage_of_nothing() -> Damage:
    steps = next(steps_of(rigid_rings(BEARING), np.zeros((1, 5)), 18.0, 1.0))
    return damage_of_steps(steps, RATED, RULES)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: LifeRules(riser="both"), "'standard' or 'none'"),
        (lambda: life_factor(1.0, 1.0, "ball"), "'ball': choose 'line' or 'point'"),
        (
            lambda: ball_life(ball_row(7, 0.01, 0.04), np.ones((1, 7)), 1e4, turning="both"),
            "'inner' or 'outer'",
        ),
        (lambda: damage_of_nothing().lives("days"), "'Mrev', 'hours' or 'years'"),
        (
            lambda: site_lives(
                [(8.0, damage_of_nothing())], Site(8.0), np.array([6.0, 9.0])
            ).of_winds("L20"),
            "'L10r' or 'L10mr'",
        ),
        (lambda: contamination_factor(1.0, 0.7, "water", "high"), "'grease', 'filtered oil'"),
        (lambda: tapered_row(36, 0.065, 0.095, 0.7874, 20.0, thrust=3), "choose 1 or -1"),
        (lambda: LifeRules(turning="both"), "inner"),
        (lambda: LifeRules(reliability=0.0), "a_1"),
        (lambda: Lubricant(10.0, 30.0), "fall"),
        (lambda: Lubricant(460.0, 30.0, 50.0, "water"), "oil bath"),
        (lambda: Lubricant(460.0, 30.0, 50.0, "oil bath", "normal"), "-/13/10"),
        (lambda: Lubricant(460.0, 30.0, 500.0), "temperature"),
        (lambda: rated_bearing(Bearing("b", (ball_row(3, 0.03, 0.07),))), "from 0.01 to 0.4"),
        (lambda: rated_bearing(BEARING, -1.0, 1.0, 1.0), "more than 0"),
        (lambda: rated_from_catalogue("nothing"), "bearing_s"),
        (lambda: damage_of_history([], RATED, RULES), "no load step"),
        (lambda: next(steps_of(rigid_rings(BEARING), np.zeros((4, 5)), [1, 2], 1)), "one for each"),
        (lambda: of_geometry(Bearing("b", (ball_row(7, 0.01, 0.04, 12.0),))), "20 to 45"),
        (
            lambda: three_degree_rings(rated_from_catalogue("planet_nj2232").bearing),
            "does not resist",
        ),
    ],
)
def test_mistakes_are_named(call, words: str) -> None:
    with pytest.raises(InputError, match=words):
        call()
