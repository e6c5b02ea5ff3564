"""Loads that enter the shaft elsewhere than at the hub: against closed forms, level by level."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.drivetrain_file.without_weight import weightless
from fe_drivetrain.export.calculix_plan import plan_deck
from fe_drivetrain.shafts.beam.sections import cowper_shear_coefficient
from fe_drivetrain.shafts.fidelity.ladder import (
    LevelModel,
    level_of_response,
    shaft_level,
    statics_level,
)
from fe_drivetrain.shafts.fidelity.over_loads import imbalance, reaction_history
from fe_drivetrain.shafts.response.cached import solved_content
from fe_drivetrain.shafts.response.entering import entering
from fe_drivetrain.shafts.response.model import Model, build_model, mesh_scene, scene_loads
from fe_drivetrain.shafts.response.unit_loads import Response, unit_load_response
from fe_drivetrain.studies.load_reactions import scene_reactions
from fe_drivetrain.studies.study_loads import own_loads
from fe_drivetrain.turbine_loads.hub_loads.channel_map import ChannelMap
from fe_drivetrain.turbine_loads.hub_loads.csv_table import read_csv, write_hub_loads
from fe_drivetrain.turbine_loads.hub_loads.files import require_points
from fe_drivetrain.turbine_loads.hub_loads.histories import LoadHistory
from fe_drivetrain.turbine_loads.hub_loads.recorded import OWN_NAMES, read_recorded

pytestmark = pytest.mark.usefixtures("kept_between_runs")

SPAN, AT, OUTER, BORE = 2.0, 0.8, 0.4, 0.1
WEIGHT = 7000.0


def scene_of(**changes: Any) -> Scene:
    """A uniform shaft that is simply supported at both ends, with a brake between."""
    unit = {"housing": {"centre_height": 0.4}, "interface": "averaged"}
    bearing = {"width": 0.1, "raceway_diameter": 0.6, "material": "ductile_iron"}
    data: dict[str, Any] = {
        "title": "simply supported",
        "shaft": {
            "front": -0.2,
            "sections": [{"length": SPAN + 0.4, "outer_diameter": OUTER, "inner_diameter": BORE}],
        },
        "bearing_units": [
            {"bearing": {"name": name, "x": x, **bearing}, **unit}
            for name, x in (("front", 0.0), ("rear", SPAN))
        ],
        "gearbox": {"stiffness": [0, 0, 0, 1e8, 0, 0]},
        "load_points": [{"name": "brake", "x": AT, "width": 0.2, "weight": WEIGHT}],
        "mesh": {
            "shaft": 0.4,
            "bearing": 0.25,
            "bearing_edge": 0.2,
            "housing": 0.3,
            "elements_per_turn": 6,
        },
    }
    return Scene.model_validate(data | changes)


@pytest.fixture(scope="module")
def solved() -> tuple[Model, Response]:
    scene = scene_of()
    model = build_model(scene, mesh_scene(scene))
    return model, unit_load_response(model)


@pytest.fixture(scope="module")
def levels(solved: tuple[Model, Response]) -> list[LevelModel]:
    scene = scene_of()
    top = level_of_response(scene, solved[1], 0.0)
    return [statics_level(scene), shaft_level(scene, 1), shaft_level(scene, 2), top]


def column(load: str) -> int:
    return scene_loads(scene_of()).index(load)


def test_every_level_follows_the_lever_rule(levels: list[LevelModel]) -> None:
    share = AT / SPAN
    for model in levels:
        front, rear = (model.reaction_matrices[name] for name in ("front", "rear"))
        force, moment = column("brake.Fz"), column("brake.My")
        np.testing.assert_allclose(front[2, force], 1.0 - share, rtol=1e-6)
        np.testing.assert_allclose(rear[2, force], share, rtol=1e-6)
        # a moment about y lifts in front and presses behind
        np.testing.assert_allclose(front[2, moment], 1.0 / SPAN, rtol=1e-6)
        np.testing.assert_allclose(rear[2, moment], -1.0 / SPAN, rtol=1e-6)
        np.testing.assert_allclose(front[1, column("brake.Fy")], 1.0 - share, rtol=1e-6)
        gearbox = model.reaction_matrices["gearbox"][3]
        np.testing.assert_allclose(gearbox[column("brake.Mx")], 1.0, rtol=1e-6)


def test_every_level_is_in_equilibrium(
    levels: list[LevelModel], solved: tuple[Model, Response]
) -> None:
    for model in levels[1:]:
        assert imbalance(scene_of(), model) < 1e-8
    assert solved[1].equilibrium_error < 1e-8
    assert solved[1].superposition_error < 1e-8


def test_the_deflection_under_the_load_is_that_of_a_simply_supported_beam(
    levels: list[LevelModel], solved: tuple[Model, Response]
) -> None:
    steel = scene_of().material_of("shaft")
    inertia = np.pi / 64 * (OUTER**4 - BORE**4)
    area = np.pi / 4 * (OUTER**2 - BORE**2)
    shear = float(cowper_shear_coefficient(steel.poisson_ratio, BORE / OUTER)) * area
    shear *= steel.youngs_modulus / (2 * (1 + steel.poisson_ratio))
    a, b = AT, SPAN - AT
    exact = a**2 * b**2 / (3 * steel.youngs_modulus * inertia * SPAN) + a * b / (shear * SPAN)
    beam, meridian = (
        m.compliance[6 * m.points.index("brake") + 2, 6 * m.points.index("brake") + 2]
        for m in levels[1:3]
    )
    np.testing.assert_allclose(beam, exact, rtol=1e-9)
    # seats of a width take the load nearer to the span's middle, and rings are not there
    np.testing.assert_allclose(meridian, exact, rtol=0.03)
    top = solved[1].motions["brake"][2, column("brake.Fz")]
    assert top > meridian  # housings give


def test_what_the_brake_does_to_the_hub_the_hub_does_to_the_brake(
    solved: tuple[Model, Response],
) -> None:
    motions = solved[1].motions
    first = column("brake.Fx")
    there = motions["hub"][:, first : first + 6]
    back = motions["brake"][:, :6]
    np.testing.assert_allclose(there, back.T, atol=1e-8 * np.abs(back).max())


def test_histories_load_it_and_its_weight_is_always_there(levels: list[LevelModel]) -> None:
    time = np.arange(5.0)
    force = np.linspace(1e4, 5e4, 5)
    at = np.zeros((5, 6))
    at[:, 2] = force
    history = LoadHistory("h", time, np.zeros((5, 6)) + np.arange(5)[:, None], {}, {"brake": at})
    hub_alone = LoadHistory("h", time, history.loads)
    for model in levels:
        found, weighed = (
            reaction_history(model, "rear", entering(scene_of(), one), 0.0, 0.0)[:, 2]
            for one in (history, hub_alone)
        )
        np.testing.assert_allclose(found - weighed, force * AT / SPAN, rtol=1e-6)
        bare = reaction_history(model, "rear", history.loads, 0.0, 0.0)[:, 2]
        np.testing.assert_allclose(weighed - bare, -WEIGHT * AT / SPAN, rtol=1e-6)


def test_without_weights_nothing_is_left_but_the_loads(levels: list[LevelModel]) -> None:
    light = weightless(scene_of(gearbox={"stiffness": [0, 0, 0, 1e8, 0, 0], "weight": 1e5}))
    assert light.gearbox.weight == 0.0
    history = LoadHistory("h", np.arange(3.0), np.zeros((3, 6)))
    for model in levels[1:]:  # statics does not tell the axial shares
        for name in ("front", "rear", "gearbox"):
            found = reaction_history(model, name, entering(light, history), 0.0, 0.0)
            np.testing.assert_array_equal(found, 0.0)


def test_a_solution_does_not_depend_on_the_weights() -> None:
    light = scene_of(load_points=[{"name": "brake", "x": AT, "width": 0.2}])
    assert solved_content(light) == solved_content(scene_of())
    moved = scene_of(load_points=[{"name": "brake", "x": AT + 0.1, "width": 0.2}])
    assert solved_content(moved) != solved_content(light)


def test_a_deck_has_its_unit_loads(solved: tuple[Model, Response]) -> None:
    plan = plan_deck(solved[0], ["brake.Fy", "hub.Fy"])
    node = plan.references["brake"][0]
    assert plan.loads[3 * node + 1].tolist() == [1.0, 0.0]


def table_with(folder: Path, column: str) -> Path:
    """Hub loads that vary, with one column more of -50 in all rows."""
    head = f"time [s],Fx [N],Fy [N],Fz [N],Mx [N m],My [N m],Mz [N m],{column}"
    rows = [f"{t},1,2,3,4,5,{t},-50" for t in range(4)]
    file = folder / "loads.csv"
    file.write_text("\n".join([head, *rows]))
    return file


def test_a_file_has_columns_for_it(tmp_path: Path) -> None:
    head = "time [s],Fx [N],Fy [N],Fz [N],Mx [N m],My [N m],Mz [N m],brake.Fz [kN],Brake.My [N m]"
    rows = [f"{t},1,2,3,4,5,{t},{2 * t},{3 * t}" for t in range(4)]
    file = tmp_path / "loads.csv"
    file.write_text("\n".join([head, *rows]))
    history = read_csv(file)
    assert list(history.at) == ["brake", "Brake"]
    np.testing.assert_array_equal(history.at["brake"][:, 2], 2e3 * np.arange(4))
    assert "brake.Fz [kN]" in str(history.attributes["channels"])
    with pytest.raises(InputError, match=r"Brake.*no load point of the scene \(brake;"):
        require_points([history], ["brake"])
    write_hub_loads(history, file)
    again = read_csv(file)
    np.testing.assert_array_equal(again.at["Brake"], history.at["Brake"])
    np.testing.assert_array_equal(again.between(1.0).at["brake"], history.at["brake"][1:])
    file.write_text("\n".join([head.replace("brake.Fz [kN]", "brake.Fz [rpm]"), *rows]))
    with pytest.raises(InputError, match="rpm"):
        read_csv(file)
    file.write_text("\n".join([head, *rows]).replace(",6,9", ",x,9"))
    with pytest.raises(InputError, match=r"brake\.Fz"):
        read_csv(file)


@pytest.mark.parametrize("mapping", [OWN_NAMES, ChannelMap(channels={"Fy": "Fy"})])
@pytest.mark.parametrize(
    ("column", "message"),
    [
        ("barke.Fz [kN]", r"barke.Fz.*\(brake; components Fx, Fy, Fz, Mx, My, Mz\).*as of 'brake'"),
        ("tower.Fz [kN]", "'tower'.*no load point.*or add it under load_points"),
        ("brake_Fz [kN]", r"'brake_Fz \[kN\]'.*: brake; comp.*write it like 'brake\.Fz \[N\]'"),
        ("brake.Fq [kN]", r"'brake\.Fq \[kN\]'.*write it like 'brake\.Fz \[N\]'"),
        ("brake.Fq", r"write it like 'brake\.Fz"),
        ("brakeMx [lbf ft]", r"write it like 'brake\.Mx \[N m\]'"),
        ("Brake force (kN)", r"write it like 'brake\.Fz"),
        ("barke_My [kN m]", r"write it like 'brake\.My \[N m\]'"),
    ],
)
def test_a_misspelt_column_of_a_load_point_is_refused_by_every_command(
    tmp_path: Path, column: str, message: str, mapping: ChannelMap
) -> None:
    file = table_with(tmp_path, column)
    scene = scene_of()
    with pytest.raises(InputError, match=message):
        own_loads(str(file), 0.0, scene, mapping)
    with pytest.raises(InputError, match=message):
        scene_reactions(scene, 1).of(read_recorded(file, mapping).history)


@pytest.mark.parametrize(
    "column",
    [
        "brake pressure [bar]",
        "brake.on",
        "RotSpeed [rpm]",
        "RotTorq [kN-m]",
        "TwrBsFxt [kN]",
        "RootFxb1 [kN]",
        "Wind1VelX [m/s]",
        "Fx2 [kN]",
        "",
    ],
)
def test_columns_that_are_plainly_something_else_are_left_alone(
    tmp_path: Path, column: str
) -> None:
    file = table_with(tmp_path, column)
    (history,) = own_loads(str(file), 0.0, scene_of()).histories
    assert not history.at
    assert scene_reactions(scene_of(), 1).of(history)


def test_a_misspelt_column_that_was_asked_for_as_another_channel_is_no_load(
    tmp_path: Path,
) -> None:
    file = table_with(tmp_path, "brake_Fz [kN]")
    found = read_recorded(file, OWN_NAMES, 0.0, ["brake_Fz"])
    require_points([found.history], ["brake"])
    assert found.others["brake_Fz [kN]"][0] == -50.0


@pytest.mark.parametrize(
    ("point", "message"),
    [
        ({"name": "brake", "x": 0.1, "width": 0.2}, "touches bearing 'front'"),
        ({"name": "brake", "x": 9.0, "width": 0.2}, "its seat on the shaft is x = 8.9 to 9.1 m"),
        ({"name": "rear", "x": AT, "width": 0.2}, "has the name of another point"),
        ({"name": "hub", "x": AT, "width": 0.2}, "has the name of another point"),
        ({"name": "brake", "x": AT}, "width"),
        ({"name": "brake", "x": AT, "width": 0.2, "weight": -1.0}, "weight"),
    ],
)
def test_what_is_no_place_for_a_load_is_refused(point: dict[str, Any], message: str) -> None:
    with pytest.raises((InputError, ValueError), match=message):
        scene_of(load_points=[point])


def test_two_of_them_must_be_apart() -> None:
    twins = [{"name": n, "x": x, "width": 0.2} for n, x in (("one", 0.5), ("two", 0.6))]
    with pytest.raises((InputError, ValueError), match=r"'two' .* touches load point 'one'"):
        scene_of(load_points=twins)
