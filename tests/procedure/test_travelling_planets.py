"""Planets at their azimuth in an event: their bearings feel weights once a turn."""

import numpy as np
import pytest

from fe_drivetrain.common.components import GRAVITY
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file import read_drivetrain
from fe_drivetrain.dynamics import Level, azimuths, machine_of, machine_system, over_a_turn
from fe_drivetrain.dynamics.bodies.advice import RUNGS
from fe_drivetrain.procedure.drivetrain_events import event_of
from fe_drivetrain.procedure.travelling_planets import travels, with_travelling_planets
from fe_drivetrain.studies.drivetrain_transient import transient
from fe_drivetrain.studies.transient_events import rated_of
from fe_drivetrain.studies.transient_runs import Prepared

NAME, PIN, COUNT = "nrel_750kw", "stage 1 pin 1 upwind", 12
DOWN = np.array([0.0, 0.0, -GRAVITY])


def test_a_planets_bearing_feels_weights_as_statics_at_each_azimuth_do() -> None:
    """Steady turning under weights and rated torque, against the frozen solution turned along."""
    drivetrain = read_drivetrain(NAME)
    machine, rated = machine_of(drivetrain), rated_of(drivetrain)
    of = Prepared(machine, RUNGS[1], rated)
    turn = 2.0 * np.pi / rated.rotor_speed
    calm = event_of("dip", {"depth": 0.0}).plan(of.of, turn, rated.slip)
    run = of.event(with_travelling_planets(of.of, calm), turn / (60 * COUNT))
    assert run.planets_travel
    assert run.imbalance < 1e-6

    still = over_a_turn(
        lambda azimuth: machine_system(machine, Level.RIGID, azimuth, held_generator=True),
        lambda system: system.gravity(DOWN) + system.load_on("rotor", rated.torque * np.eye(6)[3]),
        azimuths(COUNT),
    ).resultant(PIN)
    moving = run.samples.of(f"force of {PIN}")[:-1:60]
    np.testing.assert_allclose(moving, still, rtol=2e-3)
    lines = np.abs(np.fft.rfft(moving)) / COUNT
    assert 2.0 * lines[1] > 0.04 * lines[0]
    assert lines[2:].max() < 0.1 * lines[1]
    standing = of.event(calm, turn / (60 * COUNT)).samples.of(f"force of {PIN}")
    np.testing.assert_allclose(standing, still[0], rtol=1e-3)


def test_the_study_states_which_planets_it_has() -> None:
    drivetrain = read_drivetrain(NAME)
    said = {}
    for planets in ("stand", "travel"):
        found = transient(
            drivetrain, "dip", level="rigid", planets=planets, duration=1.2, step=4e-3
        )
        assert found.options["planets"] == planets
        assert found.passed
        said[planets] = found.answer.cautions, found.chart().caption
    assert any("Planets stand at one azimuth" in one for one in said["stand"][0])
    assert any("Planets travel with their carrier" in one for one in said["travel"][0])
    assert "planets travel" in said["travel"][1]
    assert "planets" not in said["stand"][1]


def test_a_drivetrain_without_planets_has_no_word_of_them() -> None:
    found = transient(
        read_drivetrain("iea_15mw_main_shaft"), "dip", level="rigid", duration=1.2, step=1e-2
    )
    said = (*found.answer.cautions, *found.notes)
    assert not any("planet" in one.lower() for one in said)


def test_planets_travel_at_about_a_steady_speed_only() -> None:
    geared = machine_of(read_drivetrain(NAME))
    direct = machine_of(read_drivetrain("iea_15mw_main_shaft"))
    assert travels("base", "travel", geared, Level.RIGID)
    assert not travels("stop", "stand", direct)
    with pytest.raises(InputError, match="but the speed changes in stop: let `planets` stand"):
        travels("stop", "travel", geared)
    with pytest.raises(InputError, match="planets"):
        travels("dip", "fly", geared)
    with pytest.raises(InputError, match="beside its steady azimuth but planets travel up to"):
        transient(
            read_drivetrain(NAME),
            "dip",
            {"depth": 3.0, "length": 20.0},
            level="rigid",
            planets="travel",
            duration=9.0,
            step=0.02,
        )
    for machine, level in ((direct, None), (geared, Level.TORSIONAL)):
        with pytest.raises(InputError, match="has no planets that could travel"):
            travels("dip", "travel", machine, level)
