"""Made hub loads: physics of the histories, repeatability, and a cache that cannot do harm."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from kept_entries import rewrite
from scipy.signal import welch

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.turbine_loads.hub_loads import surrogate
from fe_drivetrain.turbine_loads.hub_loads.aero_rotor import Rotor, operating_point
from fe_drivetrain.turbine_loads.hub_loads.surrogate import (
    Condition,
    HubLoadSet,
    hub_load_set,
    hub_loads,
    operating_grid,
    surrogate_grid,
)
from fe_drivetrain.turbine_loads.hub_loads.wind import turbulence_sigma

FX, FY, FZ, MX, MY, MZ = range(6)
LEVEL = Rotor(shaft_tilt=0.0)
SHORT = {"duration": 30.0, "rate": 10.0}


@pytest.fixture(scope="module")
def gusty() -> HubLoadSet:
    """Twelve seeds of one condition, long enough for spectra."""
    grid = [Condition(12.0, "medium", 0.2, seed) for seed in range(12)]
    return hub_load_set(grid, duration=200.0, cache=False)


# --- the grid ------------------------------------------------------------------------------------


def test_grid_is_that_of_the_thesis() -> None:
    grid = surrogate_grid()
    assert len(grid) == len(set(grid)) == 144
    groups = Counter((c.wind_speed, c.turbulence, c.shear) for c in grid)
    assert len(groups) == 4 * 3 * 2
    assert set(groups.values()) == {6}
    assert len({c.name for c in grid}) == 144


def test_grid_of_the_operating_range_is_that_of_the_thesis() -> None:
    grid = operating_grid()
    assert len(grid) == len(set(grid)) == 330
    assert {c.wind_speed for c in grid} == set(range(4, 25, 2))
    groups = Counter((c.turbulence, c.shear) for c in grid)
    assert set(groups.values()) == {66}
    assert sorted(groups) == [
        ("high", 0.2),
        ("low", 0.2),
        ("medium", 0.1),
        ("medium", 0.2),
        ("medium", 0.4),
    ]
    speeds = [c.wind_speed for c in grid]
    assert speeds == sorted(speeds)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ((50.0, "low", 0.2, 1), "wind_speed is 50"),
        ((10.0, "wild", 0.2, 1), "turbulence is 'wild'; choose one of none, low, medium, high"),
        ((10.0, "low", -0.1, 1), "shear exponent is -0.1; choose 0 to 1"),
        ((10.0, "low", 0.2, -1), "seed is -1"),
    ],
)
def test_conditions_out_of_range_are_refused(
    values: tuple[float, str, float, int], message: str
) -> None:
    with pytest.raises(InputError, match=message):
        Condition(*values)


@pytest.mark.parametrize(("duration", "rate"), [(0.0, 20.0), (600.0, -1.0), (np.nan, 20.0)])
def test_no_duration_is_refused(duration: float, rate: float) -> None:
    with pytest.raises(InputError, match="is no history"):
        hub_loads(Condition(10.0, "low", 0.2, 1), duration, rate)


# --- wind without turbulence: what is exact ------------------------------------------------------


def test_even_steady_wind_on_a_level_shaft_gives_thrust_torque_and_weight_alone() -> None:
    history = hub_loads(Condition(12.0, "none", 0.0, 1), **SHORT, rotor=LEVEL)
    point = operating_point(LEVEL, 12.0)
    weight = LEVEL.rotor_mass * LEVEL.gravity
    expected = [point.thrust, 0.0, -weight, point.torque, 0.0, 0.0]
    np.testing.assert_allclose(history.loads, np.tile(expected, (300, 1)), rtol=1e-9, atol=1e-2)


def test_more_mass_adds_its_weight_and_nothing_else() -> None:
    condition = Condition(16.0, "high", 0.6, 2)
    light, heavy = (
        hub_loads(condition, **SHORT, rotor=Rotor(rotor_mass=mass)) for mass in (30e3, 40e3)
    )
    tilt, weight = Rotor().shaft_tilt, 10e3 * Rotor().gravity
    expected = [weight * np.sin(tilt), 0.0, -weight * np.cos(tilt), 0.0, 0.0, 0.0]
    np.testing.assert_allclose(
        heavy.loads - light.loads, np.tile(expected, (300, 1)), rtol=1e-9, atol=1e-6
    )


def test_tilt_moment_grows_with_shear_and_wind() -> None:
    def mean_tilt_moment(speed: float, shear: float) -> float:
        history = hub_loads(Condition(speed, "none", shear, 1), **SHORT, rotor=LEVEL)
        return float(history.component("My").mean())

    assert mean_tilt_moment(12.0, 0.0) == pytest.approx(0.0, abs=1.0)
    moments = [mean_tilt_moment(12.0, shear) for shear in (0.1, 0.2, 0.4, 0.6)]
    assert moments[0] > 0.0
    assert np.all(np.diff(moments) > 0.0)
    # A gradient that is alpha V / z: near enough in proportion for small exponents.
    assert moments[1] / moments[0] == pytest.approx(2.0, rel=0.05)
    assert mean_tilt_moment(20.0, 0.2) > moments[1]


def test_shear_shakes_three_alike_blades_at_multiples_of_3p_only() -> None:
    history = hub_loads(Condition(12.0, "none", 0.6, 1), 60.0, 20.0)
    speed = operating_point(Rotor(), 12.0).rotor_speed
    orders = np.arange(1, 10)
    waves = [np.ones_like(history.time)]
    for order in orders:
        waves += [np.cos(order * speed * history.time), np.sin(order * speed * history.time)]
    fit, *_ = np.linalg.lstsq(np.stack(waves, axis=1), history.loads, rcond=None)
    amplitude = np.hypot(fit[1::2], fit[2::2])
    passing = orders % 3 == 0
    for component in range(6):
        others = amplitude[~passing, component].max()
        assert amplitude[2, component] > 1e3 * others  # 3P against 1P, 2P, 4P, ...


# --- turbulence ----------------------------------------------------------------------------------


def test_moments_peak_at_blade_passing_and_not_at_the_rotor_frequency(gusty: HubLoadSet) -> None:
    turn = operating_point(Rotor(), 12.0).rotor_speed / (2 * np.pi)
    frequency, power = welch(gusty.loads, 20.0, nperseg=1000, axis=1)
    power = power.mean(axis=0)

    def level(order: float, component: int) -> float:
        near = np.abs(frequency / turn - order) < 0.15
        return float(power[near, component].mean())

    for component in (MY, MZ):
        assert level(3.0, component) > 10.0 * level(2.2, component)
        assert level(3.0, component) > 10.0 * level(4.0, component)
        assert level(6.0, component) > 2.0 * level(5.0, component)
        # At 1P the spectrum falls on as between its neighbours: no peak above a straight line.
        between = np.sqrt(level(0.7, component) * level(1.3, component))
        assert level(1.0, component) < 1.2 * between


def test_mean_thrust_and_torque_stay_near_the_steady_state(gusty: HubLoadSet) -> None:
    point = operating_point(Rotor(), 12.0)
    weight = Rotor().weight()[FX]
    calm = hub_loads(Condition(12.0, "none", 0.2, 1), **SHORT).loads.mean(axis=0)
    assert calm[FX] - weight == pytest.approx(point.thrust, rel=0.02)
    assert calm[MX] == pytest.approx(point.torque, rel=0.02)
    # Stall takes from gusts what lulls do not give back: less thrust, by a few per cent.
    thrust = gusty.loads[..., FX].mean() - weight
    assert 0.94 * point.thrust < thrust < point.thrust


def test_loads_vary_as_the_turbulence_does() -> None:
    """Small variations are linear in the wind: standard deviations go with its sigma."""
    rate = 10.0
    spread = {}
    for turbulence in ("low", "medium", "high"):
        grid = [Condition(16.0, turbulence, 0.2, seed) for seed in range(20)]
        loads = hub_load_set(grid, duration=100.0, rate=rate, cache=False).loads
        # Changes within half a second: the slowest gusts are too few to measure a sigma by.
        change = loads[:, round(0.5 * rate) :] - loads[:, : -round(0.5 * rate)]
        spread[turbulence] = np.sqrt(change.var(axis=(0, 1)))
    for component in (FX, MX, MY, MZ):
        low, medium, high = (spread[t][component] for t in ("low", "medium", "high"))
        assert low < medium < high
        ratio = turbulence_sigma(16.0, "high") / turbulence_sigma(16.0, "low")
        assert high / low == pytest.approx(ratio, rel=0.1)


def test_shear_lifts_the_rotor_off_the_main_bearing() -> None:
    """Stirling 2023, Fig 3.16a: the mean radial force is lower under high shear, at all speeds."""
    front, rear = 2.145, 2.615  # Table 3.1: L1, L2

    def mean_force(speed: float, shear: float) -> float:
        grid = [Condition(speed, "medium", shear, seed) for seed in range(3)]
        loads = hub_load_set(grid, duration=100.0, rate=10.0, cache=False).loads
        # Moments about the gearbox, both planes (Eq 3.1).
        vertical = (loads[..., MY] + (front + rear) * loads[..., FZ]) / rear
        horizontal = (loads[..., MZ] - (front + rear) * loads[..., FY]) / rear
        return float(np.hypot(vertical, horizontal).mean())

    for speed in (10.0, 20.0):
        assert mean_force(speed, 0.6) < mean_force(speed, 0.2) - 50e3


# --- repeatability -------------------------------------------------------------------------------


def test_a_history_does_not_depend_on_its_company() -> None:
    grid = [
        Condition(10.0, "high", 0.2, 1),
        Condition(12.0, "low", 0.6, 1),
        Condition(10.0, "low", 0.6, 2),
    ]
    forward = hub_load_set(grid, **SHORT, cache=False)
    backward = hub_load_set(grid[::-1], **SHORT, cache=False)
    for i, condition in enumerate(grid):
        np.testing.assert_array_equal(forward.loads[i], backward.loads[len(grid) - 1 - i])
        np.testing.assert_array_equal(forward.loads[i], hub_loads(condition, **SHORT).loads)


def test_equal_conditions_are_one_condition_however_written() -> None:
    plain, numpy = Condition(12, "low", 0, 1), Condition(np.float64(12.0), "low", 0.0, np.int64(1))
    assert plain == numpy
    np.testing.assert_array_equal(hub_loads(plain, **SHORT).loads, hub_loads(numpy, **SHORT).loads)


def test_no_two_histories_share_their_wind() -> None:
    """Different seeds, and equal seeds under different conditions, are uncorrelated."""
    grid = [
        Condition(speed, turbulence, shear, seed)
        for speed in (10.0, 12.0)
        for turbulence in ("low", "high")
        for shear in (0.2, 0.6)
        for seed in (1, 2, 3)
    ]
    loads = hub_load_set(grid, duration=300.0, rate=5.0, cache=False).loads
    for component in (MY, MZ):
        # Slow gusts leave few independent samples, so differences in time are compared.
        correlation = np.corrcoef(np.diff(loads[..., component], axis=1))
        np.fill_diagonal(correlation, 0.0)
        assert np.abs(correlation).max() < 0.35
        assert abs(correlation.mean()) < 0.02


# --- the set -------------------------------------------------------------------------------------


def test_set_is_a_sequence_of_histories_and_one_array() -> None:
    grid = [Condition(12.0, "low", 0.2, seed) for seed in (4, 5, 6)]
    made = hub_load_set(grid, **SHORT, cache=False)
    assert made.loads.shape == (3, 300, 6)
    assert len(made) == 3
    assert made[1].name == "12 m/s, low turbulence, shear 0.2, seed 5"
    assert made[-1].attributes["seed"] == 6
    assert made[0].attributes["source"] == "surrogate"
    assert [h.attributes["seed"] for h in made[1:]] == [5, 6]
    for history, loads in zip(made, made.loads, strict=True):
        np.testing.assert_array_equal(history.loads, loads)
        np.testing.assert_allclose(np.diff(history.time), 0.1)
    with pytest.raises(IndexError):
        made[3]
    with pytest.raises(ValueError, match="read-only"):
        made.loads[0, 0, 0] = 0.0


# --- the cache -----------------------------------------------------------------------------------

PAIR = [Condition(10.0, "low", 0.2, 1), Condition(10.0, "low", 0.2, 2)]


@pytest.fixture
def count_made(monkeypatch: pytest.MonkeyPatch) -> list[Condition]:
    made: list[Condition] = []
    make = surrogate._make

    def counted(rotor, condition, *rest):  # type: ignore[no-untyped-def]
        made.append(condition)
        return make(rotor, condition, *rest)

    monkeypatch.setattr(surrogate, "_make", counted)
    return made


def test_kept_histories_are_used_again_and_equal(
    tmp_path: Path, count_made: list[Condition]
) -> None:
    fresh = hub_load_set(PAIR, **SHORT, cache=False)
    first = hub_load_set(PAIR[:1], **SHORT, cache=tmp_path)
    count_made.clear()
    second = hub_load_set(PAIR, **SHORT, cache=tmp_path)
    assert count_made == PAIR[1:]
    np.testing.assert_array_equal(first.loads[0], fresh.loads[0])
    np.testing.assert_array_equal(second.loads, fresh.loads)
    assert all(file.suffix == ".arrays" for file in (tmp_path / "hub-loads").iterdir())


@pytest.mark.parametrize("damage", ["cut", "flip", "empty", "other", "short"])
def test_damaged_files_are_made_anew(
    tmp_path: Path, count_made: list[Condition], damage: str
) -> None:
    fresh = hub_load_set(PAIR, **SHORT, cache=tmp_path).loads
    for file in (tmp_path / "hub-loads").iterdir():
        content = bytearray(file.read_bytes())
        if damage == "cut":
            content = content[: len(content) // 2]
        elif damage == "flip":
            content[len(content) // 2] ^= 0x01
        elif damage == "empty":
            content = bytearray()
        elif damage == "other":
            content = bytearray(b"not an archive")
        else:
            rewrite(file, {"loads": fresh[0, :5]})
            continue
        file.write_bytes(content)
    count_made.clear()
    np.testing.assert_array_equal(hub_load_set(PAIR, **SHORT, cache=tmp_path).loads, fresh)
    assert count_made == PAIR
    count_made.clear()
    np.testing.assert_array_equal(hub_load_set(PAIR, **SHORT, cache=tmp_path).loads, fresh)
    assert count_made == []


def test_a_cache_that_cannot_be_written_changes_nothing(tmp_path: Path) -> None:
    blocked = tmp_path / "file"
    blocked.write_text("in the way")
    made = hub_load_set(PAIR, **SHORT, cache=blocked / "below")
    np.testing.assert_array_equal(made.loads, hub_load_set(PAIR, **SHORT, cache=False).loads)


def test_another_rotor_duration_or_rate_is_another_history(
    tmp_path: Path, count_made: list[Condition]
) -> None:
    hub_load_set(PAIR, **SHORT, cache=tmp_path)
    count_made.clear()
    hub_load_set(PAIR, **SHORT, rotor=Rotor(hub_height=67.0), cache=tmp_path)
    hub_load_set(PAIR, duration=30.0, rate=20.0, cache=tmp_path)
    hub_load_set(PAIR, duration=60.0, rate=10.0, cache=tmp_path)
    assert len(count_made) == 6


def test_stopping_keeps_what_is_done(tmp_path: Path, count_made: list[Condition]) -> None:
    def stop(done: int, of_all: int) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        hub_load_set(PAIR, **SHORT, cache=tmp_path, progress=stop)
    count_made.clear()
    hub_load_set(PAIR, **SHORT, cache=tmp_path)
    assert count_made == PAIR[1:]


def test_progress_counts_every_history_once(tmp_path: Path) -> None:
    for _ in range(2):  # made, then kept
        seen: list[tuple[int, int]] = []
        hub_load_set(PAIR, **SHORT, cache=tmp_path, progress=lambda *n, s=seen: s.append(n))
        assert seen == [(1, 2), (2, 2)]
