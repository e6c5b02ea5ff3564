"""Every main-bearing case runs end to end on a small scene, and its physics checks pass."""

import html
import json
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import COARSE

from fe_drivetrain.case import all_cases, find_case, run_case
from fe_drivetrain.errors import InputError
from fe_drivetrain.export import read_stiffness_json
from fe_drivetrain.results import read_results

ROOT = Path(__file__).parents[1]
CASES = (
    "bonded",
    "mesh_convergence",
    "rmse",
    "shaft_thickness",
    "spherical",
    "torsional_stiffness",
)

#: Checks whose tolerance is for the real mesh and proportions, not for the coarse stub of a shaft.
NEEDS_REAL_SCENE = (
    "torsional-spring beam",
    "change between the two finest",
    "between the bare beam",
)


@pytest.fixture(scope="module")
def hub_load_file(tmp_path_factory):
    """Two seconds of hub loads as a user would bring them."""
    path = tmp_path_factory.mktemp("loads") / "loads.csv"
    rows = ["time [s], Fx [kN], Fy [kN], Fz [kN], Mx [kN m], My [kN m], Mz [kN m]"]
    for k in range(40):
        wave = (k % 7 - 3) / 3
        rows.append(
            f"{0.05 * k:.2f}, {200 + wave}, {5 * wave}, -370, 1100, {600 + 90 * wave}, {40 * wave}"
        )
    path.write_text("\n".join(rows))
    return path


@pytest.fixture(scope="module")
def reports(tmp_path_factory, hub_load_file):
    """Result folder of each case."""
    folder = tmp_path_factory.mktemp("reports")
    for name in CASES:
        settings = dict(COARSE)
        if name == "rmse":
            settings["loads"] = str(hub_load_file)
        run_case(find_case(name), folder / name, settings, quick=True)
    return folder


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
    assert results.title in html.unescape(page)


@pytest.mark.parametrize("name", ["bonded", "spherical", "rmse"])
def test_stiffness_file_is_valid(reports, name):
    content = read_stiffness_json(reports / name / "stiffness.json")
    assert content.matrices
    assert content.matrices[0].reference_point == (0.0, 0.0, 0.0)


def test_meshes_are_written(reports):
    import meshio

    mesh = meshio.read(reports / "bonded" / "mesh.vtu")
    assert "tetra10" in mesh.cells_dict
    assert "displacement hub.Fz" in mesh.point_data


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"scene": "nowhere.yaml"}, "cannot read scene file"),
        ({"solver": "magic"}, "use one of auto, superlu, pardiso"),
        ({"shaft.sections.0.outer_diameter": -1}, "outer_diameter"),
        ({"gearbox.stiffness": [0, 0, 0, "rigid", 0, 0]}, "mechanism"),
        ({"bearing_units.0.housing.bore_diameter": 0.9}, "main_bearing"),
        ({"loads": "nowhere/*.csv"}, "nowhere"),
    ],
)
def test_wrong_settings_leave_nothing_behind(tmp_path, settings, message):
    name = "rmse" if "loads" in settings else "spherical"
    with pytest.raises(InputError, match=message):
        run_case(find_case(name), tmp_path / "out", COARSE | settings, quick=True)
    assert list(tmp_path.iterdir()) == []


def test_a_case_is_a_script(tmp_path):
    """`python cases/main_bearing/spherical.py` runs that case, with the options of `run`."""
    options = [f"--set={key}={json.dumps(value)}" for key, value in COARSE.items()]
    done = subprocess.run(
        [
            sys.executable,
            str(ROOT / "cases" / "main_bearing" / "torsional_stiffness.py"),
            f"--out={tmp_path / 'out'}",
            "--quick",
            *options,
        ],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode in (0, 1), done.stderr
    assert (tmp_path / "out" / "report.html").exists()


def test_bad_input_exits_2_with_one_sentence(tmp_path):
    done = subprocess.run(
        [
            sys.executable,
            "-c",
            "from fe_drivetrain.cli import main; main()",
            "run",
            "bonded",
            "--set",
            "bearing_units.main_bearing.housing.wall=-1",
            f"--out={tmp_path / 'out'}",
        ],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 2
    assert "wall" in done.stderr
    assert "Traceback" not in done.stderr
    assert not (tmp_path / "out").exists()
