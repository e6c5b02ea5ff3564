"""Every main-bearing case runs end to end on a small scene, and its physics checks pass."""

import html
import json
import re
import subprocess
import sys
from pathlib import Path

import pytest
from coarse_scenes import COARSE, FINER

from fe_drivetrain.cases.main_bearing import surrogate
from fe_drivetrain.command_line.app import main
from fe_drivetrain.common.typeset import typeset
from fe_drivetrain.export.formats.stiffness_file import read_stiffness_json
from fe_drivetrain.report.pictures.drawing_process import can_draw
from fe_drivetrain.report.results import read_results
from fe_drivetrain.report.suite.case import all_cases, find_cases
from fe_drivetrain.report.suite.findings import OF_NONE
from fe_drivetrain.report.suite.suite import run_cases
from fe_drivetrain.turbine_loads.hub_loads.surrogate import Condition

pytestmark = pytest.mark.usefixtures("kept_between_runs")

ROOT = Path(__file__).parents[2]
CASES = (
    "bonded",
    "levels",
    "mesh_convergence",
    "rmse",
    "shaft_thickness",
    "spherical",
    "torsional_stiffness",
)

#: Checks whose tolerance is for the real mesh and proportions, not for the coarse stub of a shaft.
NEEDS_REAL_SCENE = (
    "torsional-spring beam",
    "DTRB, 50 % wall: mean change",
    "between the bare beam",
)


@pytest.fixture(scope="module")
def reports(request, tmp_path_factory):
    """Result folder of each case; all draw by the same function, so that one of them does."""
    folder = tmp_path_factory.mktemp("reports")
    (bonded,) = find_cases("main_bearing/bonded")
    others = [find_cases(f"main_bearing/{name}")[0] for name in CASES]
    (rmse,) = find_cases("main_bearing/rmse")
    others = [case for case in others if case not in (bonded, rmse)]
    # at eight elements a turn, which is the least, coarser meshes are hardly coarser
    scene = COARSE | FINER
    problems = run_cases([bonded], folder, scene, quick=True)
    for picture in ("model.png", "deformed.png"):
        assert (folder / "main_bearing" / "bonded" / picture).is_file() == can_draw()
    request.getfixturevalue("without_pictures")
    problems |= run_cases(others, folder, scene, quick=True)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(
            surrogate, "grid", lambda run: [Condition(12.0, "medium", 0.2, k) for k in (1, 2)]
        )
        problems |= run_cases([rmse], folder, scene, quick=True)
    assert not problems
    return folder / "main_bearing"


def test_all_cases_are_found():
    assert set(all_cases()) >= {f"main_bearing/{name}" for name in CASES}


@pytest.mark.parametrize("name", CASES)
def test_results_are_valid_and_physics_holds(reports, name):
    results = read_results(reports / name / "results.json")
    assert results.case == f"main_bearing/{name}"
    assert len(results.verdicts) >= 4
    assert results.source
    assert results.assumptions
    failed = [v.quantity for v in results.verdicts if not v.passed]
    assert [q for q in failed if not any(text in q for text in NEEDS_REAL_SCENE)] == []
    page = (reports / name / "report.html").read_text()
    assert typeset(results.title) in html.unescape(page)


@pytest.mark.parametrize("name", ["rmse", "shaft_thickness"])
def test_checks_of_two_bearings_are_each_of_their_own_scene(reports, name):
    results = read_results(reports / name / "results.json")
    titles = {record.hash: record.title for record in results.drivetrains}
    kinds = set()
    for verdict in (v for v in results.verdicts if v.of != OF_NONE):
        spherical = "spherical" in verdict.quantity or "DSRB" in verdict.quantity
        kinds.add(spherical)
        assert ("spherical" in titles[verdict.of]) == spherical, verdict.quantity
    assert kinds == {True, False}


@pytest.mark.parametrize("name", ["bonded", "spherical", "rmse"])
def test_stiffness_file_is_valid(reports, name):
    content = read_stiffness_json(reports / name / "stiffness.json")
    assert content.matrices
    assert content.matrices[0].reference_point == (0.0, 0.0, 0.0)


def test_statics_is_right_in_every_measure_of_design(reports):
    """A spherical bearing is determinate: means, extremes, time at level and damage are FE's."""
    results = read_results(reports / "rmse" / "results.json")
    rows = results.figures["design_measures"]
    assert len(rows) == 4
    for name, value in rows[0].items():
        if name.endswith("[%]"):
            assert abs(value) < 1e-5, name
    assert rows[0]["damage over it, m = 10"] == pytest.approx(1.0)
    assert any(s.startswith("Good enough within 5 %") for s in results.details)


def test_meshes_are_written(reports):
    import meshio

    mesh = meshio.read(reports / "bonded" / "mesh.vtu")
    assert "tetra10" in mesh.cells_dict
    assert "displacement hub.Fz" in mesh.point_data


@pytest.mark.parametrize(
    ("case", "settings", "message"),
    [
        ("spherical", {"shaft.sections.0.outer_diameter": -0.4}, "outer_diameter is -0.4"),
        ("spherical", {"shaft.sections.0.length": 0}, "length is 0"),
        ("spherical", {"shaft.sections.0.inner_diameter": 0.4}, "inner_diameter"),
        ("spherical", {"shaft.sections.0.colour": "red"}, "'colour'"),
        ("spherical", {"shaft.material": "cheese"}, "'cheese'"),
        ("spherical", {"bearing_units.0.housing.bore_diameter": 0.9}, "do not touch"),
        ("spherical", {"gearbox.stiffness": [0, 8e7, 8e7, 0, 0, 0]}, "can turn freely about x"),
        ("spherical", {"scene": "nowhere.yaml"}, "is studied by fe-drivetrain study FILE"),
        ("rmse", {"gearbox.stiffness": [1e6, 1e7, 2e7, "rigid", 0, 0]}, "fe-drivetrain study"),
        ("spherical", {"solver": "magic"}, "use one of auto, superlu, .*multigrid"),
    ],
)
def test_bad_input_is_one_sentence_and_status_2(
    tmp_path, monkeypatch, capsys, case, settings, message
):
    """As typed at the command line: refused with one sentence, and no result half-written."""
    out = tmp_path / "reports" / "out"
    options = [f"--set={k}={v if isinstance(v, str) else json.dumps(v)}" for k, v in COARSE.items()]
    options += [
        f"--set={k}={v if isinstance(v, str) else json.dumps(v)}" for k, v in settings.items()
    ]
    monkeypatch.setattr(
        sys, "argv", ["fe-drivetrain", "run", case, "--quick", f"--out={out}", *options]
    )
    with pytest.raises(SystemExit) as end:
        main()
    assert end.value.code == 2
    told = [line for line in capsys.readouterr().err.splitlines() if "fe-drivetrain:" in line]
    assert len(told) == 1
    assert re.search(message, told[0])
    assert "Traceback" not in told[0]
    assert not out.exists()
    assert list(tmp_path.glob("reports/.*")) == []


def test_a_case_is_a_script(tmp_path):
    """`python cases/main_bearing/spherical.py` runs that case, with the options of `run`."""
    table = tmp_path / "mine.yaml"
    table.write_text(
        "{title: direct drive, rotor: {inertia: 5.0}, shaft: {name: s, torsion: 80.0}, "
        "generator: {inertia: 3.0}}",
        "utf-8",
    )
    done = subprocess.run(
        [
            sys.executable,
            str(ROOT / "cases" / "drivetrain" / "from_table.py"),  # which takes no time
            f"--out={tmp_path / 'out'}",
            "--quick",
            f"--set=drivetrain={table}",
        ],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "out" / "report.html").exists()
    results = read_results(tmp_path / "out" / "results.json")
    assert results.case == "drivetrain/from_table"
    assert results.environment.quick
    assert results.environment.settings == {"drivetrain": str(table)}
