"""The study of a shaft's strength: what does not depend on how loads come, and the command."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fe_drivetrain.common.components import FORCES
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.reading import change_scene, library_scene, scene_text
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.studies.shaft_strength import StrengthResult, strength
from fe_drivetrain.studies.strength_options import StrengthOptions

STATED = {
    "steel": "quenched and tempered",
    "tensile_strength": 7.5e8,
    "yield_strength": 5.5e8,
    "reference_diameter": 0.5,
    "flange": {"count": 48, "circle": 1.05, "preload": 4e5},
    "press_fits": [
        {"name": "shrink_disc", "x": 1.45, "length": 0.4, "hub_diameter": 0.8, "interference": 5e-4}
    ],
}
HUB = {"Fx": 2e5, "Fz": -4e5, "Mx": 4e5, "My": 5e5}
HEAD = "time [s],Fx [kN],Fy [kN],Fz [kN],Mx [kN m],My [kN m],Mz [kN m],rotor speed [rpm]"
RIGID = StrengthOptions(housings=False, rotor_speed_rpm=15.0, elastic=False)


@pytest.fixture(scope="module")
def scene() -> Scene:
    changes: dict[str, Any] = {"strength": STATED}
    changes |= {"shaft.sections.0.fillet": 0.03, "shaft.sections.1.fillet": 0.02}
    return change_scene(library_scene("three_point_suspension"), changes)


@pytest.fixture(scope="module")
def still(scene: Scene) -> StrengthResult:
    return strength(scene, options=RIGID, hub=HUB)


def write(path: Path, seconds: float = 60.0, size: float = 1.0, wave: float = 0.0) -> Path:
    """A history of loads that stay, but for a wave of the torque that is over 10 s."""
    time = np.arange(0.0, seconds, 0.05)
    still = [size * HUB.get(name, 0.0) for name in FORCES]
    loads = np.tile(still, (len(time), 1))
    loads[:, 3] += wave * np.sin(0.2 * np.pi * time)
    table = np.column_stack([time, loads / 1e3, np.full(len(time), 15.0)])
    np.savetxt(path, table, "%.9g", ",", header=HEAD, comments="")
    return path


def test_loads_that_stay_in_a_file_are_those_that_are_given(
    scene: Scene, still: StrengthResult, tmp_path: Path
) -> None:
    """The largest range of a turning shaft is twice the bending of the hub's load."""
    found = strength(scene, [write(tmp_path / "a.csv")], options=RIGID)
    for name, one in still.sections.items():
        other = found.sections[name]
        assert other.static.value == pytest.approx(one.static.value, rel=1e-5)
        assert other.endurance.value == pytest.approx(one.endurance.value, rel=5e-3)
    for name, joint in still.joints.items():
        assert found.joints[name].slip.value == pytest.approx(joint.slip.value, rel=1e-5)


def test_a_history_that_comes_twice_is_one_of_twice_the_length(
    scene: Scene, tmp_path: Path
) -> None:
    """Whole turns of the shaft, whole waves of the torque: cycles add up, their ends aside."""
    short = strength(scene, [write(tmp_path / "a.csv", 100.0, wave=2e5)], options=RIGID)
    long = strength(scene, [write(tmp_path / "b.csv", 400.0, wave=2e5)], options=RIGID)
    for name, one in short.sections.items():
        assert long.sections[name].fatigue.value == pytest.approx(one.fatigue.value, rel=0.01)


def test_all_loads_twice_as_large_are_half_as_safe(scene: Scene, still: StrengthResult) -> None:
    """Case 2 of DIN 743, without weights; in case 1 the mean stress grows beside."""
    light = StrengthOptions(**{**vars(RIGID), "weight": False})
    one, two = (
        strength(scene, options=light, hub={k: s * v for k, v in HUB.items()}) for s in (1.0, 2.0)
    )
    for name, single in one.sections.items():
        double = two.sections[name]
        assert double.fatigue.value == pytest.approx(0.5 * single.fatigue.value, rel=1e-9)
        assert double.static.value == pytest.approx(0.5 * single.static.value, rel=1e-9)


def test_a_stronger_steel_and_a_smoother_surface_are_safer(
    scene: Scene, still: StrengthResult
) -> None:
    smooth = change_scene(scene, {"strength.roughness": 2e-6})
    weak = change_scene(scene, {"strength.tensile_strength": 6e8})
    better, worse = (strength(one, options=RIGID, hub=HUB) for one in (smooth, weak))
    for name, one in still.sections.items():
        assert worse.sections[name].fatigue.value <= one.fatigue.value
        assert better.sections[name].fatigue.value >= one.fatigue.value
        # a plain section yields first under a mean torque, whatever its surface
        if one.rated.section.kind == "shoulder":
            assert worse.sections[name].fatigue.value < one.fatigue.value
            assert better.sections[name].fatigue.value > one.fatigue.value


def test_elasticity_has_a_band_and_formulas_none(scene: Scene, still: StrengthResult) -> None:
    options = StrengthOptions(**{**vars(RIGID), "elastic": True})
    solved = strength(scene, options=options, hub=HUB)
    for name, one in solved.sections.items():
        formula = still.sections[name]
        assert (one.rated.section.kind == "shoulder") == one.rated.by_elasticity
        assert (one.local.band > 0.0) == one.rated.by_elasticity
        assert formula.local.band == 0.0
        assert one.fatigue.value == pytest.approx(formula.fatigue.value, rel=0.25)
        assert np.isnan(one.local_safety) != one.rated.by_elasticity
    shoulders = sum(one.rated.by_elasticity for one in solved.sections.values())
    assert any(f"Stress at notches: {shoulders} by elasticity" in text for text in solved.details)
    assert any(
        f"Stress at notches: {shoulders} by formulas of DIN 743-2" in text for text in still.details
    )


def test_bounds_of_housings_are_within_the_band(scene: Scene) -> None:
    """Both bounds of a scene whose gearbox springs share the moment."""
    coarse = change_scene(
        scene,
        {"mesh.housing": 0.25, "mesh.bearing": 0.25, "mesh.bearing_edge": 0.25},
    )
    options = StrengthOptions(**{**vars(RIGID), "housings": True})
    found = strength(coarse, options=options, hub=HUB)
    assert "two bounds" in " ".join(found.details)
    for one in found.sections.values():
        assert one.static.band >= 0.0
        assert one.static.band < 0.05 * one.static.value


def test_a_spectrum_of_one_class_is_the_load_that_stays(
    scene: Scene, still: StrengthResult
) -> None:
    """So many hours that all turns are the knee of the S-N curve."""
    hours = 1e6 / (15.0 * 60.0)
    others = {name: value for name, value in HUB.items() if name != "Mx"}
    rows = [(HUB["Mx"], hours, 15.0 * np.pi / 30.0)]
    found = strength(scene, options=RIGID, hub=others, spectrum=rows)
    for name, one in still.sections.items():
        assert found.sections[name].fatigue.value == pytest.approx(one.fatigue.value, rel=3e-3)


def test_a_class_without_a_turn_takes_nothing_from_the_life(scene: Scene) -> None:
    """A parked shaft may carry a mean that no cycle endures: that is for its static safety."""
    others = {name: value for name, value in HUB.items() if name != "Mx"}
    turning = (HUB["Mx"], 1e4, 1.5)
    alone = strength(scene, options=RIGID, hub=others, spectrum=[turning])
    parked = strength(scene, options=RIGID, hub=others, spectrum=[turning, (4e6, 1e3, 0.0)])
    for name, one in alone.sections.items():
        assert parked.sections[name].damage == pytest.approx(one.damage, rel=1e-12)
        assert parked.sections[name].fatigue.value == pytest.approx(one.fatigue.value, rel=1e-12)
    worst = min(one.static.value for one in parked.sections.values())
    assert worst < 0.5 * min(one.static.value for one in alone.sections.values())


def test_what_is_missing_is_named(scene: Scene, tmp_path: Path) -> None:
    plain = library_scene("three_point_suspension")
    with pytest.raises(InputError, match="states no strength of its main shaft"):
        strength(plain, hub=HUB)
    with pytest.raises(InputError, match="nothing loads the shaft"):
        strength(scene)
    with pytest.raises(InputError, match="another torque Mx"):
        strength(scene, hub=HUB, spectrum=[(1e6, 1.0, 1.0)])
    sharp = strength(change_scene(plain, {"strength": STATED}), options=RIGID, hub=HUB)
    assert list(sharp.left_out) == ["step at x = -0.15 m", "step at x = 0.15 m"]
    assert "Not rated" in sharp.notes[0]
    file = write(tmp_path / "a.csv")
    with pytest.raises(InputError, match="hold the loads of the hub"):
        strength(scene, [file], hub=HUB)
    text = file.read_text("utf-8").replace("rotor speed [rpm]", "other [rpm]")
    file.write_text(text, "utf-8")
    with pytest.raises(InputError, match="there is no rotor speed"):
        strength(scene, [file], options=StrengthOptions(housings=False))


def test_the_command_answers_writes_tables_and_refuses(
    scene: Scene, tmp_path: Path, invoke: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("mine.yaml").write_text(scene_text(scene), "utf-8")
    write(tmp_path / "a.csv", wave=1e5)
    status, out, err = invoke("strength", "mine.yaml", "--loads", "a.csv", "--rigid", "--out", "r")
    assert status == 0, err
    assert "decides" in out or "too weak" in out
    results = json.loads(Path("r/results.json").read_text("utf-8"))
    named = [row["section"] for row in results["figures"]["sections"]]
    lines = Path("r/sections.csv").read_text("utf-8")
    assert all(name in lines for name in named)
    status, _, err = invoke("strength", "mine.yaml")
    assert status == 2
    assert "--loads" in err
    for option in (("--skip", "5"), ("--channel", "Fx=a"), ("--resume",)):
        status, _, err = invoke("strength", "mine.yaml", "--load", "hub.My=1e6", *option)
        assert status == 2
        assert "is about files of hub loads: give --loads" in err
    status, _, err = invoke("strength", "mine.yaml", "--load", "hub.Fz=1e15")
    assert status == 2
    assert "--load hub.Fz: 1e+15 N must be above -1e+12 and below 1e+12 N" in err
    status, _, err = invoke("strength", "two_bearings", "--load", "hub.My=1e6")
    assert status == 2
    assert "strength in the file" in err
