"""Main-bearing cases on stepped shafts and several bearings: FE against the general beam."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from coarse_scenes import COARSE, coarse_scene
from test_own_drivetrain import write_loads

from fe_drivetrain.cases.main_bearing import general, rmse, study
from fe_drivetrain.cases.main_bearing.secants import Cases, hub_loads
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.report.results import Chart, Table
from fe_drivetrain.response.entering import entering
from fe_drivetrain.scene.reading import change_scene
from fe_drivetrain.scene.scene import Scene
from fe_drivetrain.suite.page import Page
from fe_drivetrain.suite.run import Run

pytestmark = pytest.mark.usefixtures("kept_between_runs")

SIZES = {"mesh.elements_per_turn": 8, "mesh.housing": 0.15, "mesh.bearing": 0.12}
#: The library's main bearing on a shaft of two diameters.
STEPS = {
    "shaft.sections": [
        {"length": 1.4, "outer_diameter": 0.4, "inner_diameter": 0.2},
        {"length": 0.8, "outer_diameter": 0.34, "inner_diameter": 0.2},
    ]
}


def stepped() -> Scene:
    return change_scene(coarse_scene("bonded", **SIZES), STEPS)


#: Where loads enter beside the hub, with a weight.
BRAKE = {"name": "brake", "x": 0.8, "width": 0.1, "weight": 2e4}


def two_bearings() -> Scene:
    """A bonded one in front, and one that slides on a sphere behind."""
    front, rear = (
        coarse_scene(kind, **SIZES).model_dump(mode="json") for kind in ("bonded", "spherical")
    )
    units = [scene["bearing_units"][0] for scene in (front, rear)]
    for unit, name, x in zip(units, ("front", "rear"), (-0.4, 0.7), strict=True):
        unit["bearing"] |= {"name": name, "x": x}
    return Scene.model_validate(front | {"bearing_units": units})


def rows_of(page: Page, start: str) -> list[dict[str, Any]]:
    """Of the table whose caption begins so."""
    (table,) = [
        item
        for section in page.sections
        for item in section.items
        if isinstance(item, Table) and item.caption.startswith(start)
    ]
    return [dict(zip(table.columns, row, strict=True)) for row in table.rows]


def run_in(folder: Path, **settings: Any) -> Run:
    return Run(settings, False, folder)


def test_a_scene_that_a_closed_form_stands_for_keeps_it(tmp_path: Path) -> None:
    page = Page()
    assert general.general_scene(run_in(tmp_path), page, "bonded", exchange=True) is None
    assert page.notes == []
    assert page.subject == ""


def test_why_no_closed_form_stands_for_a_scene_is_the_first_that_is_said(tmp_path: Path) -> None:
    own = Run(COARSE | {"shaft.sections.0.length": 1.4} | STEPS, False, tmp_path)
    page = Page()
    scene = general.general_scene(own, page, "bonded", exchange=True)
    assert scene is not None
    assert page.subject == scene.title
    (note,) = page.notes
    assert "a shaft of several diameters where the closed forms have one" in note
    # a secant needs one bearing and no uniform shaft
    assert general.general_scene(own, Page(), "bonded", uniform=False) is None
    elsewhere = Run(COARSE | {"load_points": [BRAKE]}, False, tmp_path)
    page = Page()
    assert general.general_scene(elsewhere, page, "bonded", uniform=False) is not None
    assert "loads enter at brake, too" in page.notes[0]
    # a stiffness of the unit alone knows no loads
    page = Page()
    assert study.scene_of(elsewhere, page, "bonded").load_points == ()
    assert page.notes[0].startswith("Without the loads and weights at brake")


@pytest.mark.parametrize(
    ("kind", "interface", "changed"),
    [("bonded", "bonded", "rear (sliding)"), ("spherical", "sliding", "front (bonded)")],
)
def test_no_bearing_of_several_is_exchanged_in_silence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, kind: str, interface: str, changed: str
) -> None:
    monkeypatch.setattr(general.study, "any_scene", lambda run, kind: two_bearings())
    page = Page()
    scene = general.general_scene(run_in(tmp_path), page, kind, exchange=True)
    assert scene is not None
    assert [unit.interface for unit in scene.bearing_units] == 2 * [interface]
    first, second = page.notes
    assert "the scene has 2 bearing units and not one" in first
    assert f"{changed} of the scene made {interface}" in second


def test_unit_loads_on_a_stepped_shaft(tmp_path: Path) -> None:
    page = Page()
    scene = change_scene(stepped(), {"load_points": [BRAKE]})
    general.unit_load_page(run_in(tmp_path), page, scene)
    assert all(verdict.passed for verdict in page.verdicts)
    rows = {row["reaction"]: row for row in rows_of(page, "Reactions in bending")}
    for label in ("FE", general.RIGID, general.STIFF, general.SOFT):
        for at in ("the hub", "brake"):
            shares = [rows[f"{n} Fz per Fz at {at}"][label] for n in ("main_bearing", "gearbox")]
            assert sum(shares) == pytest.approx(1.0, abs=1e-6)
        # behind the bearing, the gearbox takes more of it than of a load in front
        assert shares[1] > abs(rows["gearbox Fz per Fz at the hub"][label])
    hub = {row["quantity"].split(" per")[0]: row for row in rows_of(page, "Motion of the hub")}
    for row in hub.values():
        # a housing that gives makes any hub softer
        assert row[general.RIGID] < row[general.STIFF] < row[general.SOFT]
    assert 0.7 < hub["deflection uz"][general.STIFF] / hub["deflection uz"]["FE"] < 1.3


def test_walls_of_a_stepped_shaft(tmp_path: Path) -> None:
    scene = stepped()
    bored = {f"shaft.sections.{k}.inner_diameter": bore for k in range(2) for bore in (0.34 * 0.5,)}
    solid = {f"shaft.sections.{k}.inner_diameter": 0.0 for k in range(2)}
    page = Page()
    weighed = change_scene(scene, {"load_points": [BRAKE]})
    scenes = {100: change_scene(weighed, solid), 50: change_scene(weighed, bored)}
    general.wall_page(run_in(tmp_path), page, scenes)
    assert all(verdict.passed for verdict in page.verdicts)
    whole, half = rows_of(page, "Radial force on each bearing")
    assert [whole["wall [%]"], half["wall [%]"]] == [100, 50]
    assert whole["mean change, FE [%]"] == 0.0 < half["mean change, FE [%]"] < 20.0
    assert half["hub deflection per Fz [nm/N]"] > whole["hub deflection per Fz [nm/N]"]


def test_secants_of_two_bearings(tmp_path: Path, rng: np.random.Generator) -> None:
    page = Page()
    size = np.array([2e5, 5e4, 3e5, 1e6, 5e5, 5e5])
    hub = size * (1.0 + 0.5 * rng.standard_normal((80, 6)))
    scene = change_scene(two_bearings(), {"load_points": [BRAKE | {"x": 1.0}]})
    at_brake = np.zeros((80, 6))
    at_brake[:, 2] = -2e4
    loads = entering(scene, np.hstack([hub, at_brake]))
    cases = Cases(loads, np.full(80, 1 / 80), "made loads")
    general.secant_page(run_in(tmp_path), page, scene, cases)
    assert all(verdict.passed for verdict in page.verdicts)
    rows = rows_of(page, "K_R of each bearing")
    assert {row["bearing"] for row in rows} == {"front"}  # the rear one slides on a sphere
    text = page.sections[0].model_dump_json()
    assert "rear carries no moment in bending" in text
    assert any(isinstance(item, Chart) for item in page.sections[0].items)
    for row in rows:
        assert row["unit alone, soft [MN m/rad]"] < row["unit alone, stiff [MN m/rad]"]
        assert 0.3 < row["secant [MN m/rad]"] / row["unit alone, stiff [MN m/rad]"] < 1.5


def test_histories_of_different_lengths_are_studied_on_the_general_beam(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_loads(tmp_path / "a.csv", 1)
    write_loads(tmp_path / "b.csv", 2, count=60, step=0.05)
    studied = []
    monkeypatch.setattr(rmse, "studied", lambda run, page, scene, own: studied.append(own))
    page = Page()
    rmse.run(run_in(tmp_path, loads=str(tmp_path)), page)
    (own,) = studied
    assert [len(history) for history in own.histories] == [40, 60]
    assert "the histories differ in length" in page.notes[0]
    with pytest.raises(InputError, match="self_weight is a setting of the comparison with closed"):
        rmse.run(run_in(tmp_path, loads=str(tmp_path), self_weight=False), Page())


def test_load_cases_of_histories_of_unlike_length_and_step_count_by_their_time(
    tmp_path: Path,
) -> None:
    head = "time [s],Fx [N],Fy [N],Fz [N],Mx [N m],My [N m],Mz [N m]"
    for name, step, count in (("fine", 0.1, 40), ("coarse", 0.5, 20)):
        rows = [f"{step * k:g},{1e5 + k},2,3,4,{5e4 - k},6" for k in range(count)]
        (tmp_path / f"{name}.csv").write_text("\n".join([head, *rows]))
    found = hub_loads(run_in(tmp_path, loads=str(tmp_path)), 1, stepped())
    assert found.hub.values.shape == (60, 6)
    assert found.weights is not None
    # coarse comes first; a step of it stands for five times the time of a fine one
    assert found.weights[0] == pytest.approx(5 * found.weights[-1])
    assert found.weights.sum() == pytest.approx(1.0)
    assert "2 files of your own" in found.statement
    alone = hub_loads(run_in(tmp_path, loads=str(tmp_path / "fine.csv")), 1, stepped())
    assert alone.weights is None
