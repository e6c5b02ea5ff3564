"""Loads and the scene that they act on meet in one function, whatever point they are about."""

import contextlib
import csv
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tiny_case import Result

from fe_drivetrain.bearing.catalogue import catalogue_bearing
from fe_drivetrain.bearing_life.coupled.body import factors_of
from fe_drivetrain.bearing_life.coupled.load_paths import LoadPath, damage_of_hub_loads
from fe_drivetrain.bearing_life.coupled.newton import coupled_equilibrium
from fe_drivetrain.bearing_life.coupled.of_scene import scene_body
from fe_drivetrain.bearing_life.coupled.springs import on_springs, stiffness_loop
from fe_drivetrain.bearing_life.life.life_rules import LifeRules
from fe_drivetrain.bearing_life.rings.assembly import RollerAssembly, assembly_equilibrium
from fe_drivetrain.common.components import FORCES
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.reading import change_scene, library_scene, scene_text
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.elasticity.solve.solvers import Diagnostics
from fe_drivetrain.procedure.levels import level_loads
from fe_drivetrain.report.results import Text, read_results
from fe_drivetrain.shafts.fidelity.ladder import LevelModel, shaft_level
from fe_drivetrain.shafts.fidelity.over_loads import reaction_history
from fe_drivetrain.shafts.fidelity.quantities import numbers
from fe_drivetrain.shafts.fidelity.quantity import Quantity
from fe_drivetrain.shafts.response.entering import Factors, entering, joined
from fe_drivetrain.shafts.response.unit_loads import Response
from fe_drivetrain.studies.load_reactions import scene_reactions
from fe_drivetrain.turbine_loads.hub_loads.csv_table import read_csv, write_hub_loads
from fe_drivetrain.turbine_loads.hub_loads.histories import About, LoadHistory
from fe_drivetrain.turbine_loads.hub_loads.point_loads import PointLoads

DOCS = Path(__file__).parents[2] / "docs"
NAME = "main_bearing"
AT = 0.7
LOADS = np.array([[2e5, 1e4, -4e5, 5e5, 6e5, -1e5], [1e5, -3e4, -3e5, 4e5, -2e5, 2e5]])
DIRECT = Diagnostics(0.0, 0.0, 0.0, 0, "superlu", "small", 0.0, 0.0, 0, 0)


def gauged(name: str) -> Scene:
    """A scene of the library whose hub loads are about a point behind the front face."""
    return change_scene(library_scene(name), {"hub.loads_at": AT})


SCENE = gauged("main_bearing_bonded")
FRONT = SCENE.shaft.front
MODEL = shaft_level(SCENE, 1)
BODY = scene_body(SCENE, 1)
BEARINGS = {NAME: catalogue_bearing("bearing_s_o20", laminae=0)}


def history_of(loads: np.ndarray, about: About = None) -> LoadHistory:
    return LoadHistory("own", np.arange(3.0), np.tile(loads[:1], (3, 1)), about=about)


def by_statics(loads: np.ndarray, start: float) -> np.ndarray:
    """Moments about the front face by the cross product with the arm."""
    moved = loads.copy()
    moved[:, 3:] += np.cross([start - FRONT, 0.0, 0.0], loads[:, :3])
    return moved


@pytest.mark.parametrize(
    ("about", "start"), [(None, AT), ("front face", FRONT), (0.2, 0.2), (FRONT, FRONT)]
)
def test_a_history_enters_about_the_point_that_it_or_the_scene_states(
    about: About, start: float
) -> None:
    found = entering(SCENE, history_of(LOADS, about))
    assert found.x == FRONT
    assert np.allclose(found.values, by_statics(np.tile(LOADS[:1], (3, 1)), start), rtol=1e-14)
    again = entering(MODEL, found)
    np.testing.assert_array_equal(again.values, found.values)


def test_an_array_is_about_the_front_face_or_names_its_point() -> None:
    plain = library_scene("main_bearing_bonded")
    np.testing.assert_array_equal(entering(plain, LOADS).values, LOADS)
    named = entering(SCENE, PointLoads(LOADS, AT))
    assert np.allclose(named.values, by_statics(LOADS, AT), rtol=1e-14)
    both = joined([named, named[:1]])
    assert len(both) == 3
    assert both.x == FRONT


def test_weights_of_load_points_come_with_a_history_and_never_twice() -> None:
    brake = {"name": "brake", "x": 1.0, "width": 0.1, "weight": 5e3}
    scene = change_scene(SCENE, {"load_points": [brake]})
    once = entering(scene, history_of(LOADS))
    assert once.values.shape == (3, 12)
    assert (once.values[:, 8] == -5e3).all()
    np.testing.assert_array_equal(entering(scene, once).values, once.values)


ROLLERS = RollerAssembly(BEARINGS, np.eye(2), np.zeros((2, 10)), {}, np.zeros(2), SCENE.entrance)
SOLVED = Response(
    {NAME: np.ones((6, 10))},
    {},
    {},
    {},
    np.zeros((0, 3, 10)),
    0.0,
    0.0,
    DIRECT,
    entrance=SCENE.entrance,
)
PATH = LoadPath(BODY, BEARINGS, NAME)
FACTORS = factors_of(LOADS)


@pytest.mark.parametrize(
    "act",
    [
        lambda: SOLVED.history(NAME, LOADS),
        lambda: SOLVED.plot(LOADS[0]),
        lambda: reaction_history(MODEL, NAME, LOADS, 0.0, 0.0),
        lambda: MODEL.reactions(FACTORS),
        lambda: level_loads(SCENE, MODEL, np.arange(2.0), LOADS),
        lambda: PATH.bearing_loads(LOADS),
        lambda: next(PATH.steps(LOADS, 12.0, 1.0)),
        lambda: damage_of_hub_loads(PATH, LOADS, 12.0, 1.0, None, LifeRules()),  # type: ignore[arg-type]
        lambda: coupled_equilibrium(BODY, BEARINGS, FACTORS),
        lambda: on_springs(BODY, FACTORS, np.ones(5)),
        lambda: stiffness_loop(BODY, BEARINGS, FACTORS),
        lambda: assembly_equilibrium(ROLLERS, FACTORS),
        lambda: Quantity(f"{NAME}.Fz", FACTORS[0]).check(SCENE),
        lambda: numbers(SCENE, [f"{NAME}.Fz"], FACTORS[0]),
    ],
)
def test_an_array_is_refused_where_the_scene_states_another_point(act: Callable[[], Any]) -> None:
    with pytest.raises(InputError, match=r"not say which point .* hub\.loads_at .* x = 0\.7 m"):
        act()


def test_named_loads_are_taken_by_all_of_them() -> None:
    history = history_of(LOADS)
    at_front = entering(SCENE, history)
    factors = factors_of(at_front)
    assert isinstance(factors, Factors)
    plain = by_statics(history.loads, AT)
    exact = plain @ MODEL.reaction_matrices[NAME][:, :6].T
    assert np.allclose(reaction_history(MODEL, NAME, history, 0.0, 0.0), exact, rtol=1e-12)
    assert np.allclose(MODEL.reactions(factors)[NAME], exact, rtol=1e-12)
    table = level_loads(SCENE, MODEL, history.time, history)
    assert np.allclose(table.interfaces[1].loads, exact, rtol=1e-12)
    forces = coupled_equilibrium(BODY, BEARINGS, factors).of(NAME)
    assert np.allclose(PATH.bearing_loads(history)[0], forces, rtol=1e-9)
    with pytest.raises(InputError, match=r"give entering\(scene, history\)"):
        factors_of(history)  # type: ignore[call-overload]


@pytest.mark.parametrize("about", [None, "front face", 0.7])
def test_a_table_keeps_the_point_that_its_loads_are_about(about: About, tmp_path: Path) -> None:
    write_hub_loads(history_of(LOADS, about), tmp_path / "a.csv")
    read = read_csv(tmp_path / "a.csv")
    assert read.about == about
    assert "moments about" not in read.attributes


def test_a_shape_and_a_point_of_no_number_are_refused() -> None:
    with pytest.raises(InputError, match=r"the shape \(2, 5\): give \(n, 6\)"):
        PointLoads(LOADS[:, :5], 0.0)
    with pytest.raises(InputError, match="about x = nan m"):
        PointLoads(LOADS, np.nan)


def recipe(page: str, monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """What the Python of a page makes where scenes of the library are `gauged`."""
    monkeypatch.setattr("fe_drivetrain.drivetrain_file.library_scene", gauged)
    names: dict[str, Any] = {}
    text = (DOCS / page).read_text(encoding="utf-8")
    with contextlib.redirect_stdout(None):
        for block in re.findall(r"```python\n(.*?)```", text, re.DOTALL):
            exec(compile(block, page, "exec"), names)
    assert names["scene"].loads_at == AT
    return names


def rows_of(file: Path) -> list[dict[str, str]]:
    lines = [line for line in file.read_text().splitlines() if not line.startswith("#")]
    return list(csv.DictReader(lines))


def test_reactions_of_the_page_are_those_of_the_command(
    invoke: Callable[..., Result], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    reaction = recipe("how-to/own-loads.md", monkeypatch)["reaction"]
    Path("scene.yaml").write_text(scene_text(gauged("three_point_suspension")))
    status, _, error = invoke(
        *("loads", "mine.csv", "--rotor-speed", "12", "--scene", "scene.yaml", "--out", "out")
    )
    assert status == 0, error
    rows = {row["reaction"]: row for row in rows_of(Path("out/reactions.csv"))}
    for component, unit, values in zip(FORCES, 3 * ["kN"] + 3 * ["kN m"], reaction.T, strict=True):
        row = rows.get(f"main_bearing, {component} [{unit}]", {"mean": "0", "max": "0"})
        assert float(row["mean"]) == pytest.approx(values.mean() / 1e3, rel=1e-8, abs=1e-6)
        assert float(row["max"]) == pytest.approx(values.max() / 1e3, rel=1e-8, abs=1e-6)


def test_the_study_of_lives_on_the_page_is_that_of_the_command(
    invoke: Callable[..., Result], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    found = recipe("life.md", monkeypatch)["found"]
    Path("scene.yaml").write_text(scene_text(gauged("main_bearing_spherical")))
    words = ("--loads", "w12.csv", "--rotor-speed", "12", "--temperature", "60", "--out", "out")
    status, _, error = invoke("life", "scene.yaml", *words)
    assert status == 0, error
    (lives,) = rows_of(Path("out/lives.csv"))
    years = found.bearings["main_bearing"].years
    for kind in ("L10", "L10r", "L10mr"):
        assert float(lives[f"{kind} [years]"]) == pytest.approx(years[kind], rel=1e-8)


def test_lives_of_the_page_are_those_of_the_command(
    invoke: Callable[..., Result], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.chdir(tmp_path)
    names = recipe("how-to/bearing-life.md", monkeypatch)
    Path("scene.yaml").write_text(scene_text(SCENE))
    units = 3 * ["N"] + 3 * ["N m"]
    columns = [f"{name} [{unit}]" for name, unit in zip(FORCES, units, strict=True)]
    header = ",".join(["time [s]", *columns, "wind speed [m/s]", "rotor speed [rpm]"])
    winds = ((8.0, names["light"], 12.0), (14.0, names["heavy"], 18.0))
    for wind, loads, rpm in winds:
        time = np.arange(0.0, 10.0, 0.5)
        table = np.tile([*loads.values[0], wind, rpm], (len(time), 1))
        np.savetxt(
            f"v{wind:g}.csv",
            np.column_stack([time, table]),
            "%.9g",
            ",",
            header=header,
            comments="",
        )
    status, _, error = invoke(
        *("life", "scene.yaml", "--loads", "v*.csv", "--bearing", f"{NAME}=bearing_s_o20"),
        *("--site", "8.5", "--out", "out"),
    )
    assert status == 0, error
    for (_, damage), row in zip(names["damage"], rows_of(Path("out/winds.csv")), strict=True):
        assert float(row["L10r [years]"]) == pytest.approx(damage.lives("years")["L10r"], rel=1e-6)
    (lives,) = rows_of(Path("out/lives.csv"))
    years = names["life"].years
    for kind in ("L10", "L10r"):
        assert float(lives[f"{kind} [years]"]) == pytest.approx(years[kind], rel=1e-6)


def test_the_point_of_a_scene_is_asked_for_where_loads_enter_and_nowhere_else() -> None:
    root = DOCS.parent
    asking = {
        str(file.relative_to(root))
        for folder in ("fe_drivetrain", "cases")
        for file in (root / folder).rglob("*.py")
        if re.search(r"(scene|entrance|self)\.loads_at\b", file.read_text(encoding="utf-8"))
    }
    says = {"studies/scene_description.py", "studies/study_loads.py"}  # in words alone
    assert asking == {
        *(f"fe_drivetrain/{name}" for name in says),
        *(f"fe_drivetrain/drivetrain_file/{name}.py" for name in ("entrance", "gate", "scene")),
        *(f"fe_drivetrain/shafts/response/{name}.py" for name in ("entering", "stated")),
    }


def test_every_level_knows_where_loads_enter() -> None:
    levels: list[LevelModel] = [MODEL, shaft_level(SCENE, 2)]
    assert all(model.entrance == SCENE.entrance for model in levels)
    assert BODY.entrance == SCENE.entrance


def head_of(file: Path) -> dict[str, str]:
    lines = [line for line in file.read_text(encoding="utf-8").splitlines() if line[:1] == "#"]
    return dict(line.removeprefix("# ").split(" = ", 1) for line in lines)


def test_headers_say_what_each_table_of_loads_is_as_page_and_data_do(
    invoke: Callable[..., Result], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    loads = history_of(LOADS)
    time = 0.1 * np.arange(600.0)
    turning = np.outer(np.sin(3.8 * time), [0, 0, 1e5, 0, 3e5, 0])
    turning += np.outer(np.cos(3.8 * time), [0, 1e5, 0, 0, 0, 3e5])
    many = LoadHistory("own", time, loads.loads[:1] + turning)
    write_hub_loads(many, "own.csv", {"oil temperature [degC]": 40.0 + np.sin(time)})
    Path("scene.yaml").write_text(scene_text(SCENE))
    status, _, error = invoke(
        *("loads", "own.csv", "--rotor-speed", "12", "--scene", "scene.yaml", "--out", "out"),
        *("--also", "oil temperature"),
    )
    assert status == 0, error
    found = {file.stem: head_of(file) for file in Path("out").glob("*.csv")}
    results = read_results(Path("out/results.json"))
    stated = scene_reactions(SCENE, 1).stated
    R = sum(matrix[2, 8] for matrix in MODEL.reaction_matrices.values())
    own = f"{9.80665e-3 * R:.4g} kN"
    for name in ("reactions", "reaction_loops"):
        head = found[name]
        assert {key: head[key] for key in stated.facts()} == stated.facts()
        assert f"{NAME} at x = 0 m" in head["origin of moments"]
        assert "about the hub" not in head["origin of moments"]
        assert "its own ring and housing" in head["weight"]
        assert f"shaft, rings and housings {own}" in head["weight"]
    assert results.figures["reactions_stated"] == stated.facts()
    texts = [item.text for s in results.sections for item in s.items if isinstance(item, Text)]
    assert any(stated.sentences() in text for text in texts)
    for name in ("windows", "equivalent_loads"):
        assert found[name]["load"] == "the rotor's on the shaft"
        assert "about x = 0.7 m" in found[name]["origin of moments"]
    assert "frame" not in found["other_channels"]
    # Fz over all: what the statement says is in it, and no more
    rows = {row["reaction"]: row for row in rows_of(Path("out/reactions.csv"))}
    sums = sum(float(rows[f"{n}, Fz [kN]"]["mean"]) for n in (NAME, "gearbox"))
    whole = many.loads[:, 2].mean() - SCENE.gearbox.weight - 9.80665 * R
    assert sums == pytest.approx(whole / 1e3, rel=1e-6)
