"""Gears and transients at levels with what is condensed, and on mounts that are uncertain."""

from typing import Any

import numpy as np
import pytest
from coarse_scenes import coarse_drivetrain

from fe_drivetrain.common import InputError
from fe_drivetrain.drivetrain_file import Scene, read_drivetrain
from fe_drivetrain.drivetrain_file.reading import change_scene
from fe_drivetrain.dynamics import Flexible, Level, Rung, Rungs, plain_rungs
from fe_drivetrain.dynamics.bodies.condensed_rungs import ON_ROLLERS, SOFT_SEATS, STIFF_SEATS
from fe_drivetrain.studies import GearsResult, TransientResult, gears, transient, turning_model
from fe_drivetrain.studies.gear_machine import gear_train
from fe_drivetrain.studies.gear_options import GearOptions
from fe_drivetrain.studies.machine_description import housings_in_words
from fe_drivetrain.studies.transient_ladder import finest_band
from fe_drivetrain.studies.transient_runs import LevelRun
from fe_drivetrain.studies.turning_advice import finest_modes
from fe_drivetrain.studies.turning_quantities import TurningModel, turning_quantity
from fe_drivetrain.studies.turning_uncertainty import values_at

pytestmark = pytest.mark.usefixtures("kept_between_runs")

FINEST = "main shaft in its meridian"
NAMES = ["torsional", "rigid bodies", "flexible shafts", SOFT_SEATS, STIFF_SEATS, FINEST]
TILTED = {"Fz": -2.0e5, "My": 6.0e5}


@pytest.fixture(scope="module")
def scene() -> Scene:
    operation = {"rated_power": 1.5e6, "rotor_speed": [1.0, 1.8]}
    return change_scene(coarse_drivetrain(), {"operation": operation})


def rated(scene: Scene, **options: Any) -> GearsResult:
    asked = GearOptions(azimuths=4, slices=3, condensed=True, **options)
    return gears(scene, options=asked, hub=TILTED)


@pytest.fixture(scope="module")
def found(scene: Scene) -> GearsResult:
    return rated(scene)


def test_gears_go_on_with_what_is_condensed(found: GearsResult) -> None:
    assert [one.name for one in found.levels] == NAMES
    assert found.level == FINEST
    levels = {one.name: one.factors for one in found.levels}
    moved = 0.0
    for row in found.tables["bounds"]:
        name = str(row["mesh"])
        soft, stiff = (levels[one][name] for one in (SOFT_SEATS, STIFF_SEATS))
        assert (row["K_gamma, seats averaged"], row["K_Hbeta, seats averaged"]) == soft
        assert (row["K_gamma, seats rigid"], row["K_Hbeta, seats rigid"]) == stiff
        # the band has what both bounds differ by, beside azimuths and slices
        assert found.meshes[name].face_band >= abs(soft[1] - stiff[1])
        moved = max(moved, abs(soft[1] - stiff[1]))
    assert moved > 0.0
    assert any("housings of main bearings give way" in note for note in found.notes)
    assert not any("housings of main bearings" in row.name for row in found.assumptions)
    assert {row["level or part"] for row in found.tables["levels left out"]} >= {"carriers"}


def test_a_condensed_level_rates_by_its_name(scene: Scene) -> None:
    rungs = Rungs((*plain_rungs(scene), Rung(Level.FLEXIBLE, Flexible(), SOFT_SEATS)), {})
    for level, name in ((SOFT_SEATS, SOFT_SEATS), ("rigid", "rigid bodies"), (None, SOFT_SEATS)):
        asked = GearOptions(condensed=True, level=level)
        assert gear_train(scene, asked, None, rungs).rung.name == name
    with pytest.raises(InputError, match=f"use one of torsional, rigid, flexible, {SOFT_SEATS}"):
        gear_train(scene, GearOptions(condensed=True, level="solid"), None, rungs)


def test_the_rollers_are_the_last_level_where_asked() -> None:
    pins = {f"gearbox.stages.0.pins.{k}.catalogue": "planet_nj2232" for k in (0, 1)}
    rolling = read_drivetrain("synthetic_2mw", pins)
    train = gear_train(rolling, GearOptions(rollers=True), 1e6)
    assert train.rung.name == train.rungs[-1].name == ON_ROLLERS
    assert "are on their rollers" in housings_in_words(train.rung, train.machine)
    assert "rollers" not in housings_in_words(train.rungs[-2], train.machine)
    named = GearOptions(rollers=True, level=ON_ROLLERS)
    assert gear_train(rolling, named, 1e6).rung.rollers
    assert not gear_train(rolling, GearOptions(rollers=True, level="rigid"), 1e6).rung.rollers


def test_levels_without_the_mount_say_so(scene: Scene) -> None:
    asked = GearOptions(azimuths=4, slices=3, level="torsional")
    torsional = gears(scene, options=asked)
    assert any("neither mount nor housings act" in note for note in torsional.notes)
    lumped = gears(read_drivetrain("synthetic_2mw"), 1e6, options=GearOptions(azimuths=4, slices=3))
    assert any("stands on the ground" in note for note in lumped.notes)


@pytest.fixture(scope="module")
def lost(scene: Scene) -> TransientResult:
    values = {"off": 0.02, "delay": 0.05}
    return transient(scene, "grid_loss", values, condensed=True, duration=0.15, step=1e-3)


def test_transients_go_on_with_what_is_condensed(lost: TransientResult) -> None:
    assert [run.rung.name for run in lost.runs] == NAMES
    assert lost.imbalance < 1e-8
    runs = {run.rung.name: run for run in lost.runs}
    for row in lost.tables["bounds"]:
        name, size = str(row["channel"]), {"kN m": 1e3, "kN": 1e3, "rpm": np.pi / 30.0}
        for words, level in (("averaged", SOFT_SEATS), ("rigid", STIFF_SEATS)):
            shown = float(row[f"largest, seats {words}"]) * size[str(row["unit"])]
            assert shown == pytest.approx(runs[level].extremes[name].largest)
    assert finest_band(lost.runs, "bearing") > finest_band(lost.runs[-1:], "bearing")
    # the main shaft is condensed at the finest level, and has its torque all the same
    first = next(iter(lost.extremes))
    assert first.startswith("torque of")
    by_beam, condensed = (runs[name].extremes[first].rated for name in ("flexible shafts", FINEST))
    assert condensed == pytest.approx(by_beam, rel=1e-9)
    assert "force of gearbox mount" in lost.runs[1].extremes
    assert "force of gearbox mount" not in lost.runs[0].extremes


def test_a_level_runs_alone_by_its_name(scene: Scene) -> None:
    asked: dict[str, Any] = {"condensed": True, "duration": 0.01, "step": 1e-3}
    alone = transient(scene, "grid_loss", {"off": 0.002}, level=STIFF_SEATS, **asked)
    assert alone.level == STIFF_SEATS
    assert len(alone.runs) == 1
    assert alone.chosen is alone.runs[0]


def test_a_peak_is_that_of_the_event_at_its_level(
    scene: Scene, lost: TransientResult, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[Rung] = []

    def event_at(_drivetrain: Scene, _event: str, rung: Rung) -> LevelRun:
        asked.append(rung)
        return lost.runs[-1]

    monkeypatch.setattr(turning_model, "event_at", event_at)
    rung, channel = lost.runs[-1].rung, "force of gearbox mount"
    peak = TurningModel(scene, rung).peak("grid_loss", channel)
    assert asked == [rung]
    assert peak is lost.runs[-1].extremes[channel]


def test_a_sample_has_a_mount_of_its_own() -> None:
    """A mount that is softer about x lowers the first torsional mode of a sample."""
    mounts: list[list[float]] = [[2e6, 4e7, 4e7, k, 0, 0] for k in (1e6, 4e6)]
    first, second = (read_drivetrain("grc_750kw", {"gearbox.stiffness": k}) for k in mounts)
    asked = [turning_quantity(first, "modes.torsional.1")]
    reference = finest_modes(first, plain_rungs(first)[:2])
    soft, stiff = (values_at(one, asked, 1, reference) for one in (first, second))
    assert soft["modes.torsional.1"] < 0.99 * stiff["modes.torsional.1"]
