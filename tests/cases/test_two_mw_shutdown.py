"""Verdicts of the 2 MW machine's shutdown, its counts of damage, its wind and its bearings."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from fe_drivetrain.bearing.catalogue import read_bearing_catalogue
from fe_drivetrain.cases.dynamics import two_mw_guesses
from fe_drivetrain.cases.dynamics.two_mw_damage import Share, cycle_damage
from fe_drivetrain.cases.dynamics.two_mw_guesses import spread
from fe_drivetrain.cases.dynamics.two_mw_loads import contact_of, rolling
from fe_drivetrain.cases.dynamics.two_mw_machine import (
    PLANET,
    SCALE,
    scaled_bearings,
    thesis_machine,
)
from fe_drivetrain.cases.dynamics.two_mw_rolling_words import whole_share
from fe_drivetrain.cases.gear.turbine_years import mesh_of
from fe_drivetrain.cases.histories import computed_stop
from fe_drivetrain.cases.references import operated_machines
from fe_drivetrain.cases.references.operated_machines import (
    EVENT_STEP,
    SIZED,
    SPEED,
    rig_of,
    scaled_to,
    stop_values,
    turbine_in_wind,
)
from fe_drivetrain.cases.references.printed_values import against
from fe_drivetrain.comparison.in_time import peak_between
from fe_drivetrain.dynamics import Level, machine_of
from fe_drivetrain.report.suite import Run
from fe_drivetrain.report.suite.case import all_cases
from fe_drivetrain.studies.part_bearings import counted_parts
from fe_drivetrain.studies.transient_runs import Samples


@pytest.mark.parametrize(
    ("ours", "span", "stands"),
    [
        (1.30, (1.2, 1.4), "holds"),
        (1.45, (1.2, 1.5), "not testable"),
        (1.45, (1.4, 1.5), "does not hold"),
        (1.05, (0.9, 1.2), "does not hold"),
    ],
)
def test_a_statement_falls_where_no_guess_comes_to_it(
    ours: float, span: tuple[float, float], stands: str
) -> None:
    assert against(ours, 1.27, span) == stands


def test_spread_of_a_result_over_another() -> None:
    rows = [{"a": 2.0, "b": 1.0}, {"a": 3.0, "b": 2.0}]
    assert spread(rows, "a") == (2.0, 3.0)
    assert spread(rows, "a", "b") == (1.5, 2.0)


def test_cycles_of_a_steady_stress_do_nothing_and_those_of_a_wave_their_range() -> None:
    wave = 1e9 + 2e8 * np.cos(np.linspace(0.0, 20.0 * np.pi, 2001))
    assert cycle_damage(np.full(100, 1.4e9), 13.22, 1.45e9, 5e7) == 0.0
    found = cycle_damage(wave, 13.22, 4e8, 5e7)
    assert found == pytest.approx(10.0 / 5e7, rel=1e-6)


def test_share_of_shutdowns_in_the_damage_of_all_parts() -> None:
    parts = {"a": Share(0.0, 0.1), "b": Share(0.9, 0.0)}
    assert parts["a"].share == 1.0
    assert whole_share(parts) == pytest.approx(0.1)
    assert Share(0.0, 0.0).share == 0.0


@pytest.mark.parametrize(
    ("tooth", "mesh"),
    [
        ("stage 1 planet, flank to ring", "stage 1 ring-planet"),
        ("stage 2 planet, flank to sun", "stage 2 sun-planet"),
        ("stage 2 sun", "stage 2 sun-planet"),
        ("stage 3 pinion", "stage 3 mesh"),
    ],
)
def test_mesh_of_a_flank(tooth: str, mesh: str) -> None:
    assert mesh_of(tooth) == mesh


def test_brake_brings_the_fast_shaft_to_its_peak() -> None:
    drivetrain = thesis_machine()
    rig = rig_of(drivetrain, Level.TORSIONAL)
    run = rig.stop(stop_values(drivetrain, rig, 1.2), 2.0 * EVENT_STEP, SIZED)
    after = run.samples.times >= run.marks["brake on"]
    peak = peak_between(run.samples.of("torque of HSS")[after])
    assert peak / run.extremes["torque of HSS"].rated == pytest.approx(1.2, abs=2e-3)


def test_a_history_goes_with_power_and_torque_of_another_turbine() -> None:
    made = turbine_in_wind()
    same, other = scaled_to(made, 2.0e6, SPEED), scaled_to(made, 8.0e6, 0.5 * SPEED)
    assert np.array_equal(same.history.loads, made.history.loads)
    over = other.history.loads / made.history.loads
    assert over[:, :3] == pytest.approx(4.0)
    assert over[:, 3:] == pytest.approx(8.0)
    power = other.rotor_speed * other.generator_torque
    assert power == pytest.approx(4.0 * made.rotor_speed * made.generator_torque)


def test_bearings_are_those_of_the_public_gearbox_in_another_size(tmp_path: Path) -> None:
    drivetrain = thesis_machine()
    lives = scaled_bearings(tmp_path)
    counted, unnamed = counted_parts(drivetrain, machine_of(drivetrain), lives, False)
    assert unnamed == ("main bearing",)
    planet = next(one for one in counted.bearings if one.entry_name == PLANET)
    own = read_bearing_catalogue()["planet_nj2232"]
    assert planet.entry.element_length == pytest.approx(SCALE * float(own.element_length or 0.0))
    load = np.full(5, 2e5)
    load[2] = 1.0
    samples = Samples(np.arange(5.0), load[:, None], (f"force of {PLANET}",), ("N",))
    rolls = rolling(planet, samples, PLANET)
    assert rolls.loaded[0] in (5, 6, 7)
    assert rolls.loaded[2] < rolls.loaded[0]
    contact = contact_of(planet, float(rolls.pressure[0]))
    assert contact.pressure == pytest.approx(float(rolls.pressure[0]))


@pytest.mark.parametrize(
    ("name", "words"),
    [("dynamics/two_mw_shutdown", "times as much"), ("histories/events", "ranges")],
)
def test_a_case_answers_for_a_users_drivetrain(
    name: str, words: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(operated_machines, "LASTING", 4.0)
    monkeypatch.setattr(computed_stop, "LASTING", 6.0)
    monkeypatch.setattr(computed_stop, "WINDS", computed_stop.WINDS[:1])
    monkeypatch.setattr(computed_stop, "LATER", ())
    monkeypatch.setattr(two_mw_guesses, "QUICK", ())
    results = all_cases()[name].results(Run({"drivetrain": "nrel_750kw"}, True, tmp_path))
    assert results.passed
    assert results.answer is not None
    assert words in results.answer.verdict
    assert "thesis" not in results.answer.model_dump_json()
    assert any("printed numbers" in note for note in results.notes)
