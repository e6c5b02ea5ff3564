"""A drivetrain of one's own: from a file to start from to a study of its reactions."""

import json
import math
import re
import shlex
from collections.abc import Callable
from dataclasses import replace
from importlib.resources import files
from pathlib import Path

import jsonschema
import numpy as np
import pytest
from test_hub_loads import rotating_columns, write_outb
from tiny_case import Result

from fe_drivetrain.command_line.app import main
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.reading import parse_mapping
from fe_drivetrain.drivetrain_file.arrangements import (
    ARRANGEMENTS,
    SCHEMA_FILE,
    drivetrain_schema,
    starting_scene,
)
from fe_drivetrain.drivetrain_file.reading import (
    change_scene,
    is_component,
    library_scene,
    parse_scene,
)
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.export.formats.stiffness_file import read_stiffness_json
from fe_drivetrain.export.formats.summary import read_summary
from fe_drivetrain.export.from_scene import unit_superelement
from fe_drivetrain.report.pictures import can_draw
from fe_drivetrain.report.results import Table, read_results
from fe_drivetrain.shafts.fidelity.adviser import advise
from fe_drivetrain.shafts.fidelity.ladder import shaft_level, statics_level
from fe_drivetrain.shafts.fidelity.level_costs import forecast
from fe_drivetrain.shafts.fidelity.over_loads import imbalance, relative_errors
from fe_drivetrain.shafts.fidelity.quantity import Quantity
from fe_drivetrain.shafts.response.model import Model
from fe_drivetrain.shafts.response.unit_loads import Response
from fe_drivetrain.studies import study_loads
from fe_drivetrain.studies.named_bearings import named_bearings
from fe_drivetrain.studies.scene_description import description
from fe_drivetrain.studies.study_loads import own_loads
from fe_drivetrain.turbine_loads.histories.cycles import rainflow_cycles
from fe_drivetrain.turbine_loads.histories.damage import damage_equivalent_load
from fe_drivetrain.turbine_loads.hub_loads.surrogate import Condition

pytestmark = pytest.mark.usefixtures("kept_between_runs")

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text("utf-8")
SCHEMA = json.loads(drivetrain_schema())
LIBRARY = {
    path.name.removesuffix(".yaml"): path.read_text("utf-8")
    for path in sorted((files("fe_drivetrain.geometry") / "library").iterdir(), key=str)
}


def faults(text: str) -> list[str]:
    """What an editor underlines in a scene file."""
    validator = jsonschema.Draft202012Validator(SCHEMA)
    return [error.message for error in validator.iter_errors(parse_mapping(text, "scene"))]


def without(scene: Scene, *keys: str) -> dict[str, object]:
    return scene.model_dump(exclude=set(keys))


@pytest.mark.parametrize("name", ARRANGEMENTS)
def test_a_scene_to_start_from_is_the_one_of_the_library(name: str) -> None:
    text = starting_scene(name)
    assert parse_scene(text) == library_scene(ARRANGEMENTS[name].library)
    assert text.startswith(f"# yaml-language-server: $schema={SCHEMA_FILE}\n")
    assert faults(text) == []


@pytest.mark.parametrize("name", ARRANGEMENTS)
def test_what_else_a_scene_may_have_is_valid_once_its_comment_sign_is_gone(name: str) -> None:
    text, mark, rest = starting_scene(name).partition("# What else a scene may have")
    assert mark
    more = re.sub("^# ?", "", rest.partition("\n")[2], flags=re.MULTILINE)
    scene = parse_scene(text + more)
    assert faults(text + more) == []
    turning = ("rotor", "generator", "operation")
    shown = ("load_points", "materials", "mesh", "uncertainty", *turning)
    assert without(scene, *shown) == without(parse_scene(text), *shown)
    assert [point.name for point in scene.load_points] == ["brake"]
    assert scene.uncertainty["shaft.sections.0.outer_diameter"].uniform == 0.001
    assert scene.hub.coupling == "averaged"
    if "mesh" in more:
        assert scene.mesh == parse_scene(text).mesh  # what is shown are the defaults


def test_published_schema_of_scenes_is_that_of_the_program() -> None:
    assert (ROOT / "docs" / SCHEMA_FILE).read_text("utf-8") == drivetrain_schema()


@pytest.mark.parametrize("name", [name for name in LIBRARY if not is_component(LIBRARY[name])])
def test_scenes_of_the_library_follow_the_schema(name: str) -> None:
    assert faults(LIBRARY[name]) == []


def test_documented_scene_follows_the_schema_and_faults_in_it_do_not() -> None:
    text = re.search(r"```yaml\n(.*?)```", (ROOT / "docs/scene.md").read_text("utf-8"), re.DOTALL)
    assert text
    assert faults(text.group(1)) == []
    for right, wrong, reason in (
        ("interface: sliding", "interface: slidng", "slidng"),
        ("  front:", "  frnt:", "frnt"),
        ("outer_diameter: 0.5", "outer_diameter: -0.5", "-0.5"),
        ("title: Example drivetrain\n", "", "title"),
    ):
        assert right in text.group(1)
        found = faults(text.group(1).replace(right, wrong))
        assert any(reason in message for message in found), wrong


def test_new_writes_a_scene_with_its_schema_and_never_over_another(
    invoke: Callable[..., Result], tmp_path: Path
) -> None:
    status, out, _ = invoke("new", "my.yaml", "--arrangement", "two-bearings")
    assert status == 0
    assert "fe-drivetrain check my.yaml" in out
    file = tmp_path / "my.yaml"
    assert parse_scene(file.read_text("utf-8")) == library_scene("two_bearings")
    assert json.loads((tmp_path / SCHEMA_FILE).read_text("utf-8")) == SCHEMA

    mine = file.read_text("utf-8").replace("0.5", "0.52")
    file.write_text(mine, "utf-8")
    status, _, err = invoke("new", "my.yaml")
    assert status == 2
    assert "my.yaml exists: give another file, or add --overwrite" in err
    assert file.read_text("utf-8") == mine
    # a second scene in the same folder shares the schema
    assert invoke("new", "other.yml")[0] == 0
    assert invoke("new", "my.yaml", "--overwrite")[0] == 0
    assert parse_scene(file.read_text("utf-8")) == library_scene("three_point_suspension")


def test_what_is_to_be_typed_next_can_be_typed(invoke: Callable[..., Result]) -> None:
    status, out, _ = invoke("new", "Mühle Größe.yaml")
    assert status == 0
    (line,) = [line for line in out.splitlines() if line.startswith("Edit it, then: ")]
    typed = shlex.split(line.removeprefix("Edit it, then: "))
    assert typed == ["fe-drivetrain", "check", "Mühle Größe.yaml"]


def test_new_does_not_replace_a_schema_of_another_kind(
    invoke: Callable[..., Result], tmp_path: Path
) -> None:
    (tmp_path / SCHEMA_FILE).write_text("{}", "utf-8")
    status, _, err = invoke("new", "my.yaml")
    assert status == 2
    assert SCHEMA_FILE in err
    assert not (tmp_path / "my.yaml").exists()


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("my.txt",), "my.txt must end in .yaml or .yml"),
        (("no/my.yaml",), "there is no folder no: create it"),
        (("my.yaml", "--arrangement", "five-point"), "use one of three-point, spherical,"),
        ((), "Missing FILE"),
    ],
)
def test_new_refuses_in_one_sentence(
    invoke: Callable[..., Result], words: tuple[str, ...], sentence: str
) -> None:
    status, _, err = invoke("new", *words)
    assert status == 2
    assert sentence in err


def test_new_lists_its_arrangements(invoke: Callable[..., Result]) -> None:
    status, out, _ = invoke("new", "--list")
    assert status == 0
    assert [line.split()[0] for line in out.splitlines()] == list(ARRANGEMENTS)


COARSE = ("mesh.shaft=0.3", "mesh.bearing=0.12", "mesh.housing=0.12", "mesh.bearing_edge=0.12")
QUICK = [word for change in (*COARSE, "mesh.elements_per_turn=8") for word in ("--set", change)]

#: Short, and without the fillet that asks for many small elements.
SHORT = [
    word
    for change in (
        "shaft.front=-1.0",
        "shaft.flange.fillet=0",
        "shaft.sections.0.length=1.4",
        "shaft.sections.1.length=1.0",
        "mesh.bearing=0.2",
        "mesh.housing=0.2",
        "mesh.bearing_edge=0.2",
    )
    for word in ("--set", change)
]


@pytest.fixture
def documented(tmp_path: Path) -> Path:
    """The complete example of docs/scene.md as a file in the folder where commands run."""
    text = re.search(r"```yaml\n(.*?)```", (ROOT / "docs/scene.md").read_text("utf-8"), re.DOTALL)
    assert text
    path = tmp_path / "mine.yaml"
    path.write_text(text.group(1), "utf-8")
    return path


def tables(folder: Path) -> dict[str, list[dict[str, object]]]:
    """Rows of each table of a result folder, by the first words of its caption."""
    results = read_results(folder / "results.json")
    found = [item for s in results.sections for item in s.items if isinstance(item, Table)]
    return {
        re.split("[;:,]", table.caption)[0]: [
            dict(zip(table.columns, row, strict=True)) for row in table.rows
        ]
        for table in found
    }


def test_check_says_what_a_scene_is(
    invoke: Callable[..., Result], documented: Path, tmp_path: Path
) -> None:
    status, out, _ = invoke("check", "mine.yaml", "--out", "page", *QUICK)
    assert status == 0
    assert out.startswith("It can be solved: its supports hold ")
    folder = tmp_path / "page"
    page = (folder / "results.json").read_text("utf-8")
    assert "a shaft of 4.55 m on 1 bearing" in page
    assert "uy 80 MN/m" in page
    assert "rx rigid" in page
    assert (folder / "model.png").is_file() == can_draw()
    found = tables(folder)
    shaft, bearing, housing = found["Parts"]
    assert [row["part"] for row in (shaft, bearing, housing)] == [
        "shaft",
        "main_bearing",
        "main_bearing.housing",
    ]
    # tubes of 0.9, 0.5 and 0.4 m round a bore of 0.2 m, and a fillet of radius r at r1 = 0.25 m:
    # (1 - pi/4) r^2 times the way round of its centroid
    r, r1 = 0.03, 0.25
    tubes = [(0.15, 0.9), (2.4, 0.5), (2.0, 0.4)]
    volume = sum(math.pi / 4 * length * (d**2 - 0.2**2) for length, d in tubes)
    centroid = r1 + r * (5 / 6 - math.pi / 4) / (1 - math.pi / 4)
    volume += (1 - math.pi / 4) * r**2 * 2 * math.pi * centroid
    assert shaft["mass [kg]"] == pytest.approx(7850 * volume, rel=1e-3)
    assert housing["density [kg/m³]"] == 7800
    assert found["Bearings"][0]["carries moments"] == "no: spherical joint"
    assert "against turning" not in page


def test_check_says_that_a_bonded_bearing_takes_torque(
    invoke: Callable[..., Result], tmp_path: Path
) -> None:
    status, *_ = invoke("check", "main_bearing_bonded", "--out", "page", *QUICK)
    assert status == 0
    page = (tmp_path / "page" / "results.json").read_text("utf-8")
    assert "main_bearing: bonded, so held against turning, too" in page


def test_check_shows_the_point_that_hub_loads_are_about(bonded_model: Model) -> None:
    scene = bonded_model.scene
    for x, shown in ((None, []), (scene.shaft.front - 0.5, [scene.shaft.front - 0.5])):
        changed = replace(bonded_model, scene=change_scene(scene, {"hub.loads_at": x}))
        points = description(changed)["Where loads enter the shaft"]
        assert [row["x [m]"] for row in points if "hub.loads_at" in row["point"]] == shown


@pytest.mark.parametrize(
    ("entry", "refused", "words"),
    [
        ("nosuch", True, "catalogue entry 'nosuch' of bearing 'main_bearing' is in no catalogue"),
        ("planet_nj2232", True, "planet_nj2232 is 160 mm, the shaft at its seat 600 mm"),
        ("bearing_s", False, "bearing_s is 635 mm, the shaft at its seat 600 mm"),
        ("three_point_main", False, None),
    ],
)
def test_check_and_life_say_the_same_of_catalogue_entries(
    invoke: Callable[..., Result],
    entry: str,
    refused: bool,
    words: str | None,
    tmp_path: Path,
) -> None:
    key = f"bearing_units.main_bearing.catalogue={entry}"
    scene = change_scene(library_scene("three_point_suspension"), dict([key.split("=")]))
    if not refused:
        (found,) = named_bearings(scene, (), {}).values()
        assert words in str(found.misfit) if words else found.misfit is None
        return
    said = set()
    (tmp_path / "any.csv").write_text("not read before the bearings are known")
    for command in (["check"], ["life", "--loads", str(tmp_path / "any.csv")]):
        arguments = [command[0], "three_point_suspension", *command[1:], "--set", key]
        status, _, err = invoke(*arguments, "--out", str(tmp_path / "page"))
        assert status == 2
        said.add(err.splitlines()[-1])
    (sentence,) = said
    assert words is not None
    assert words in sentence


def test_forecast_is_of_the_systems_that_are_solved(
    bonded_model: Model, bonded_response: Response
) -> None:
    found = forecast(bonded_model)
    assert [level.level for level in found] == [0, 1, 1, 2, 3, 4]
    top = found[-1]
    assert top.unknowns == bonded_response.diagnostics.n_unknowns
    # a bonded unit is one body, held at its base: what is left of its nodes
    mesh = bonded_model.mesh
    parts = ("main_bearing", "main_bearing.housing")
    nodes = np.unique(np.concatenate([mesh.cells[mesh.part_cells(p)].ravel() for p in parts]))
    free = np.setdiff1d(nodes, mesh.face_nodes("main_bearing.housing.base"))
    assert found[2].unknowns == found[3].unknowns == 3 * len(free)
    assert all(level.fits and level.seconds > 0 for level in found)
    # the matrix alone has 9 numbers for each node's block with itself and its neighbours
    assert top.bytes is not None
    assert top.bytes > 8 * bonded_model.stiffness.nnz


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ("gearbox.stiffness=[0, 0, 0, 0, 0, 0]", "can"),
        ("gearbox.weight=heavy", "gearbox.weight"),
        ("bearing_units.main_bearing.interface=bondd", "interface"),
        ("bearing_units.main_bearing.bearing.x=9", "main_bearing"),
    ],
)
def test_check_refuses_a_bad_scene_in_one_sentence(
    invoke: Callable[..., Result], documented: Path, tmp_path: Path, change: str, words: str
) -> None:
    status, out, err = invoke("check", "mine.yaml", *QUICK, "--set", change)
    assert (status, out) == (2, "")
    (sentence,) = [line for line in err.splitlines() if line.startswith("fe-drivetrain: ")]
    assert words in sentence
    assert not (tmp_path / "reports" / "check" / "mine").exists()


def test_check_of_a_file_that_is_not_there(invoke: Callable[..., Result]) -> None:
    status, _, err = invoke("check", "mine.yaml")
    assert status == 2
    assert "mine.yaml" in err


#: Two bearings on a stepped shaft: short, and solid, for elements are as small as the bore asks.
TWO_BEARINGS = [
    word
    for change in (
        "shaft.front=-0.6",
        "shaft.sections.0.length=1.4",
        "shaft.sections.1.length=1.1",
        "shaft.sections.0.inner_diameter=0",
        "shaft.sections.1.inner_diameter=0",
        "bearing_units.rear.bearing.x=1.2",
        "mesh.shaft=0.4",
        "mesh.bearing=0.12",
        "mesh.housing=0.15",
        "mesh.bearing_edge=0.12",
        "mesh.elements_per_turn=8",
    )
    for word in ("--set", change)
]


def write_loads(
    path: Path, seed: int, start: float = 0.0, count: int = 40, step: float = 0.1
) -> Floats:
    """A short history of hub loads with weight and thrust; its loads [kN, kN m]."""
    generator = np.random.default_rng(seed)
    time = start + step * np.arange(count)
    mean = np.array([200.0, 5.0, -370.0, 900.0, 300.0, -50.0])
    loads = mean + np.abs(mean) * 0.3 * generator.standard_normal((count, 6))
    header = "time [s],Fx [kN],Fy [kN],Fz [kN],Mx [kN m],My [kN m],Mz [kN m]"
    np.savetxt(path, np.column_stack([time, loads]), "%.6f", ",", header=header, comments="")
    return loads


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, Floats]]:
    """The result folder of a study of two bearings over two unlike files, and their loads."""
    folder = tmp_path_factory.mktemp("study")
    (folder / "loads").mkdir()
    loads = {
        "calm": write_loads(folder / "loads" / "calm.csv", 1),
        "storm": write_loads(folder / "loads" / "storm.csv", 2, start=60.0, count=101, step=0.05),
    }
    words = ["study", "two_bearings", *TWO_BEARINGS]
    for name in loads:
        words += ["--loads", str(folder / "loads" / f"{name}.csv")]
    words += ["--slope", "4", "--slope", "8"]
    with pytest.raises(SystemExit) as end:
        main([*words, "--out", str(folder / "out")])
    assert end.value.code == 0
    return folder / "out", loads


def table_of(path: Path) -> tuple[list[str], Floats, str]:
    """Columns, values and the lines before them of a CSV file of a study."""
    lines = path.read_text("utf-8").splitlines()
    head = [line for line in lines if line.startswith("#")]
    return (
        lines[len(head)].split(","),
        np.loadtxt(lines[len(head) + 1 :], delimiter=","),
        "\n".join(head),
    )


def test_reactions_of_a_study_balance_loads_and_weights(
    study: tuple[Path, dict[str, Floats]],
) -> None:
    folder, loads = study
    mass = sum(float(str(row["mass [kg]"])) for row in tables(folder)["Parts"])
    weight = 9.80665 * mass + 200_000.0  # of the parts, and of the gearbox
    for name, start in (("calm", 0.0), ("storm", 60.0)):
        columns, values, head = table_of(folder / f"reactions_{name}.csv")
        assert values[0, 0] == start
        for word in (
            "frame = x downwind",
            "origin of moments",
            "weight = included along -z",
            "the weight of its own ring and housing, which its rollers do not feel",
        ):
            assert word in head
        for component, column in zip(("Fx", "Fy", "Fz"), range(3), strict=True):
            total = sum(
                values[:, columns.index(f"{support} {component} [N]")]
                for support in ("front", "rear", "gearbox")
            )
            applied = 1e3 * loads[name][:, column] - (weight if component == "Fz" else 0.0)
            np.testing.assert_allclose(total, applied, rtol=0, atol=1e-5 * weight)
        # the gearbox alone carries torque: bearings of bodies of revolution turn freely, but for
        # the bonded one in front, which is fixed to its housing
        torque = values[:, columns.index("front Mx [N m]")]
        torque = torque + values[:, columns.index("gearbox Mx [N m]")]
        rear = values[:, columns.index("rear Mx [N m]")]
        assert np.abs(rear).max() < 1e-6 * np.abs(torque).max()


def test_statistics_of_a_study_are_those_of_its_histories(
    study: tuple[Path, dict[str, Floats]],
) -> None:
    folder, _ = study
    found = {name: table_of(folder / f"reactions_{name}.csv") for name in ("calm", "storm")}
    columns = found["calm"][0]
    parts = [values[:, columns.index("rear Fz [N]")] / 1e3 for _, values, _ in found.values()]
    sample = np.concatenate(parts)
    # 40 steps of 0.1 s, and 101 of 0.05 s
    weights = np.repeat([0.1, 0.05], [40, 101])
    mean = np.average(sample, weights=weights)
    deviation = np.sqrt(np.average((sample - mean) ** 2, weights=weights))
    (row,) = [
        row
        for row in tables(folder)["Reactions of the assembly over all load steps"]
        if (row["reaction"], row["component"]) == ("rear", "Fz [kN]")
    ]
    assert row["min"] == pytest.approx(sample.min(), rel=1e-6)
    assert row["max"] == pytest.approx(sample.max(), rel=1e-6)
    assert row["mean"] == pytest.approx(mean, rel=1e-6)
    assert row["standard deviation"] == pytest.approx(deviation, rel=1e-6)
    cycles = [rainflow_cycles(part) for part in parts]
    for slope in (4.0, 8.0):
        equivalent = damage_equivalent_load(cycles, 39 * 0.1 + 100 * 0.05, slope)
        assert row[f"DEL, m = {slope:g}"] == pytest.approx(equivalent, rel=1e-5)
    assert 0.0 < float(str(row["± mesh"])) < 0.5 * sample.std()
    text = (folder / "reaction_statistics.csv").read_text("utf-8")
    assert text.count("\nstorm,rear,Fz,N,") == text.count("\nall,rear,Fz,N,") == 1
    assert "# channels of storm = " in text
    times = {row["history"]: row for row in tables(folder)["Histories"]}
    assert times["storm"]["from [s]"] == 60.0
    assert times["storm"]["step [s]"] == pytest.approx(0.05)


def test_a_study_says_which_level_each_reaction_needs(
    study: tuple[Path, dict[str, Floats]],
) -> None:
    (caption,) = [c for c in tables(study[0]) if c.startswith("The cheapest level")]
    rows = {str(row["reaction"]): row for row in tables(study[0])[caption]}
    shares = {
        str(row["reaction"]): row
        for found in tables(study[0]).values()
        for row in found
        if "beam, soft housings" in row and "rms of FE" not in row
    }
    assert rows.keys() == shares.keys()
    for reaction, row in rows.items():
        level = str(row["level that it needs"])
        assert level[0] in "124n"
        bounds = [shares[reaction][f"beam, {bound} housings"] for bound in ("stiff", "soft")]
        within = max(float(str(b)) for b in bounds) + float(str(row["± mesh of the assembly [%]"]))
        if level.startswith("1 beam, housings"):
            assert within <= 5.0
        if level.startswith(("2", "4")):
            assert within > 5.0


def test_a_study_exports_what_other_programs_read(study: tuple[Path, dict[str, Floats]]) -> None:
    folder, _ = study
    assert set(read_summary(folder / "summary.json").bearing_units) == {"front", "rear"}
    assert (folder / "mesh.vtu").stat().st_size > 0
    for row in tables(folder)["Files of this study"]:
        assert list(folder.glob(str(row["file"]))), row


def test_bounds_of_a_study_hold_each_other_and_are_exported(
    study: tuple[Path, dict[str, Floats]],
) -> None:
    folder, _ = study
    rows = [
        row for found in tables(folder).values() for row in found if "face in shape (stiff)" in row
    ]
    assert {row["bearing"] for row in rows} == {"front", "rear"}
    for row in rows:
        assert float(str(row["face on average (soft)"])) <= float(str(row["face in shape (stiff)"]))
    # a spherical joint has no K_R
    assert {row["bearing"] for row in rows if "K_R" in str(row["quantity"])} == {"front"}
    matrices = {
        m.name: np.array(m.matrix) for m in read_stiffness_json(folder / "stiffness.json").matrices
    }
    assert set(matrices) == {"front, stiff", "front, soft", "rear, stiff", "rear, soft"}
    for unit in ("front", "rear"):
        more = matrices[f"{unit}, stiff"] - matrices[f"{unit}, soft"]
        scale = np.sqrt(np.maximum(matrices[f"{unit}, stiff"].diagonal(), 1.0))
        # a face held in shape is a constraint more: stiffer in every direction
        assert np.linalg.eigvalsh(more / np.outer(scale, scale))[0] > -1e-6


def test_beams_of_a_study_are_compared_over_the_loads(
    study: tuple[Path, dict[str, Floats]],
) -> None:
    folder, _ = study
    rows = {
        str(row["reaction"]): row
        for found in tables(folder).values()
        for row in found
        if "beam, soft housings" in row and "rms of FE" not in row
    }
    assert {"front, force", "front, moment", "rear, force", "gearbox, force"} <= set(rows)
    assert "rear, moment" not in rows  # a spherical joint
    # two bearings share the load by their stiffness, which rigid housings miss
    shares = rows["rear, force"]
    errors = {label: float(str(shares[label])) for label in shares if label != "reaction"}
    assert errors["beam, rigid housings"] > errors["beam, soft housings"] > 0.0


def test_a_level_out_of_balance_is_noticed() -> None:
    scene = library_scene("two_bearings")
    sound = shaft_level(scene, 1)
    assert imbalance(scene, sound) < 1e-9
    worse = dict(sound.reaction_matrices)
    worse["front"] = worse["front"] * 1.01
    assert imbalance(scene, replace(sound, reaction_matrices=worse)) > 1e-3


def test_errors_are_relative_to_the_vector(rng: np.random.Generator) -> None:
    reference = rng.standard_normal((50, 6)) * np.array([1e-4, 1.0, 1.0, 0.0, 0.0, 0.0])
    found = reference * np.array([2.0, 1.1, 1.1, 1.0, 1.0, 1.0])
    force, moment = relative_errors(reference, found, 2.0)
    # a component as small as this does not count, whatever its own error
    assert force == pytest.approx(0.1, rel=1e-6)
    assert np.isnan(moment)


@pytest.mark.parametrize(
    ("words", "sentence"),
    [
        (("--skip", "5"), "--skip 5 leaves out the beginning of your own files"),
        (("--loads", "none/*.outb"), "file is there"),
        (("--set", "gearbox.stiffness=[0, 0, 0, 0, 0, 0]", "--loads", "a.csv"), "can"),
        (("--loads", "gap.csv"), "0.6 s where the others are 0.1 s"),
        (("--loads", "zero.csv"), "zero"),
        (("--loads", "thrust.csv"), "Fy"),
    ],
)
def test_study_refuses_in_one_sentence(
    invoke: Callable[..., Result], tmp_path: Path, words: tuple[str, ...], sentence: str
) -> None:
    write_loads(tmp_path / "a.csv", 3)
    head = "time [s],Fx [kN],Fy [kN],Fz [kN],Mx [kN m],My [kN m],Mz [kN m]"
    gap = [f"{t},1,{t},1,1,1,1" for t in (0, 0.1, 0.2, 0.3, 0.9, 1.0)]
    zero = [f"{t},0,0,0,0,0,0" for t in (0, 0.2, 0.4)]
    for name, rows in (("gap", [head, *gap]), ("zero", [head, *zero])):
        (tmp_path / f"{name}.csv").write_text("\n".join(rows))
    (tmp_path / "thrust.csv").write_text("time [s],Fx [kN]\n0,1\n1,1\n2,1\n")
    status, out, err = invoke("study", "main_bearing_spherical", *QUICK, *words)
    assert (status, out) == (2, "")
    lines = [line for line in err.splitlines() if line.startswith("fe-drivetrain: ")]
    assert len(lines) == 1
    assert sentence in lines[0]


def test_a_study_without_loads_says_that_they_are_a_surrogate(
    invoke: Callable[..., Result], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    one = [Condition(12.0, "medium", 0.2, 1)]
    monkeypatch.setattr(study_loads, "surrogate_grid", lambda: one)
    status, out, _ = invoke("study", "main_bearing_spherical", "--quick", "--out", "s", *QUICK)
    assert status == 0
    assert "Hub loads are a surrogate, not those of your turbine" in out
    results = read_results(tmp_path / "s" / "results.json")
    assert any(sentence.startswith("Quick: on a coarser mesh") for sentence in results.details)
    assert results.assumptions  # of the rotor
    assert not list((tmp_path / "s").glob("reactions_*.csv"))
    # one spherical bearing in front of a gearbox that holds no bending: statics decides
    assert "beam, rigid housings is enough: every reaction that counts is within 5 %" in " ".join(
        results.details
    )


def commands_of(text: str) -> list[list[str]]:
    """The words of each command that shell blocks show."""
    blocks = re.findall(r"```sh\n(.*?)```", text, re.DOTALL)
    lines = [line.partition("   #")[0] for block in blocks for line in block.splitlines()]
    return [shlex.split(line)[1:] for line in lines if "fe-drivetrain " in line]


def test_the_readme_begins_with_a_drivetrain_of_ones_own(
    invoke: Callable[..., Result], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    section = README.partition("## Your own turbine\n")[2].partition("\n## ")[0]
    commands = commands_of(section)
    assert [words[0] for words in commands] == ["new", "check", "study", "life", "report"]
    (tmp_path / "outputs").mkdir()
    columns = rotating_columns()
    turning = ("(rpm)", np.full_like(columns["Time"][1], 12.0))
    write_outb(tmp_path / "outputs" / "run.outb", columns | {"RotSpeed": turning})
    for words in (words for words in commands if words[0] not in ("study", "report")):
        status, out, err = invoke(*words)
        assert status == 0, (words, err)
        assert out


def test_the_commands_of_the_docs_work_word_for_word(
    invoke: Callable[..., Result], documented: Path, tmp_path: Path
) -> None:
    """On the complete example of docs/scene.md; coarser and shorter, for the sake of time.

    Elements as small as the bore of 0.1 m asks for stand along all of the shaft.
    """
    example = documented.read_text("utf-8")
    documented.unlink()
    (tmp_path / "outputs").mkdir()
    write_outb(tmp_path / "outputs" / "run.outb", rotating_columns())
    shown = commands_of((ROOT / "docs" / "commands.md").read_text("utf-8"))
    commands = [
        words
        for words in shown
        if words[0] != "report" and ("mine.yaml" in words or words[0] == "loads")
    ]
    assert [words[0] for words in commands] == [
        *("new", "check", "study", "advise", "loads", "compare"),
        *3 * ["export"],
    ]
    for words in commands:
        coarse = [] if words[0] in ("new", "loads") else [*QUICK, *SHORT]
        status, out, err = invoke(*words, *coarse)
        # the bands of so coarse a mesh may be wider than what is compared
        assert status in ((0, 1) if words[0] == "compare" else (0,)), (words, err)
        assert out
        if words[0] == "new":
            assert parse_scene(documented.read_text("utf-8"))
            documented.write_text(example, "utf-8")
    for made in (
        "reports/check/mine/report.html",
        "reports/loads/report.html",
        "reports/study/mine/reactions_run.csv",
        "reports/advise/mine/report.html",
        "reports/compare/mine/report.html",
        "mine.inp",
        "shaft.bdf",
    ):
        assert (tmp_path / made).stat().st_size > 0, made


def test_loads_about_another_point_are_the_same_loads(
    tmp_path: Path, rng: np.random.Generator
) -> None:
    """About any third point of the axis, force and moment are what they were in the file."""
    write_loads(tmp_path / "gauge.csv", 3)
    scene = library_scene("two_bearings")
    here = own_loads(str(tmp_path / "gauge.csv"), 0.0, scene)
    gauge = change_scene(scene, {"hub.loads_at": 0.7})
    (moved,) = own_loads(str(tmp_path / "gauge.csv"), 0.0, gauge).histories
    (plain,) = here.histories
    third = rng.normal()
    about = [
        history.loads[:, 3:] + np.cross([x - third, 0.0, 0.0], history.loads[:, :3])
        for history, x in ((plain, 0.7), (moved, scene.shaft.front))
    ]
    np.testing.assert_allclose(about[1], about[0], rtol=0, atol=1e-9 * np.abs(about[0]).max())
    np.testing.assert_array_equal(moved.loads[:, :3], plain.loads[:, :3])
    assert "about x = 0.7 m moved to x = -1.2 m" in str(moved.attributes["channels"])
    assert "moved" in own_loads(str(tmp_path / "gauge.csv"), 0.0, gauge).statement
    assert "moved" not in here.statement


def test_a_bearing_free_along_x_leaves_the_axial_force_to_its_neighbour() -> None:
    scene = change_scene(
        library_scene("two_bearings"),
        {
            "bearing_units.rear.interface": "spring",
            "bearing_units.rear.stiffness": [0, "rigid", "rigid", 0, 0, 0],
            "shaft.sections.0.inner_diameter": 0,
            "shaft.sections.1.inner_diameter": 0,
            "mesh.shaft": 0.4,
            "mesh.bearing": 0.2,
            "mesh.bearing_edge": 0.2,
            "mesh.housing": 0.2,
            "mesh.elements_per_turn": 8,
        },
    )
    for model in (statics_level(scene), *(shaft_level(scene, level) for level in (1, 2, 3))):
        axial = {name: matrix[0] for name, matrix in model.reaction_matrices.items()}
        np.testing.assert_allclose(axial["rear"][:6], 0.0, atol=1e-9)
        np.testing.assert_allclose(axial["front"][0], 1.0, rtol=1e-9)
    with pytest.raises(InputError, match="zero at level 0, and by statics at every other"):
        advise(scene, Quantity("rear.Fx"), 0.01)
    located = advise(scene, Quantity("front.Fx"), 0.01)
    assert [result.model.level for result in located.results] == [0]
    exported = unit_superelement(scene, "rear").stiffness
    assert np.abs(exported[0]).max() < 1e-9 * exported[1, 1]
    with pytest.raises(InputError, match=r"shaft.* can move freely along x"):
        change_scene(
            scene,
            {
                "bearing_units.front.interface": "spring",
                "bearing_units.front.stiffness": [0, "rigid", "rigid", 0, "rigid", "rigid"],
            },
        )
