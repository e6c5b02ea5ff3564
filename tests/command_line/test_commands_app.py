"""The program itself: version, help without heavy imports, and the script of a case."""

from collections.abc import Callable
from pathlib import Path

import pytest
from tiny_case import Result, count

from fe_drivetrain.command_line.app import main_of_case
from fe_drivetrain.common.interpreter import run_python
from fe_drivetrain.report.results import read_results
from fe_drivetrain.report.suite.case import Case


def test_version_is_the_installed_one(invoke: Callable[..., Result]) -> None:
    from importlib.metadata import version

    status, out, _ = invoke("--version")
    assert (status, out) == (0, f"fe-drivetrain {version('fe-drivetrain')}\n")


@pytest.mark.parametrize("argument", ["--help", "--version", "list"])
def test_help_and_list_import_nothing_heavy(argument: str) -> None:
    heavy = ["numpy", "scipy", "gmsh", "skfem", "numba", "pyvista", "plotly", "jinja2", "PIL"]
    heavy += [
        "fe_drivetrain.report.results",
        "fe_drivetrain.drivetrain_file.scene",
        "fe_drivetrain.elasticity.mesh.mesh",
    ]
    if argument != "list":
        heavy.append("pydantic")  # which typer uses itself to run a command
    program = (
        "import sys\n"
        f"sys.argv = ['fe-drivetrain', {argument!r}]\n"
        "from fe_drivetrain.command_line.app import main\n"
        "try:\n"
        "    main()\n"
        "finally:\n"
        f"    print([m for m in {heavy} if m in sys.modules], file=sys.stderr)\n"
    )
    done = run_python("-c", program)
    assert done.returncode == 0
    assert done.stderr.strip() == "[]"


def test_a_script_of_a_case_has_the_same_options(
    invoke: Callable[..., Result], tmp_path: Path
) -> None:
    case = Case("group/tiny", "A tiny case", "nobody", count, settings=("k",))
    status, out, _ = invoke("--out", "x", "--set", "k=1", main=lambda: main_of_case(case))
    assert status == 0
    assert out.endswith("x/report.html\n")
    command = read_results(tmp_path / "x/results.json").environment.command
    assert command.startswith("python ")
    assert command.endswith(" --out x --set k=1")
    assert invoke("--set", "k", main=lambda: main_of_case(case))[0] == 2
    helped = invoke("--help", main=lambda: main_of_case(case))[1]
    assert "A tiny case" in helped
    assert "--set changes: k" in helped
    # brackets are no style of text
    case = Case("group/tiny", "Depth [mm]", "Lee [3]", count, settings={"p": "[a, b] (or one)"})
    helped = invoke("--help", main=lambda: main_of_case(case))[1]
    for words in ("Depth [mm]", "Lee [3]", "--set changes: p=[a, b] (or one)"):
        assert words in helped


def test_files_of_a_pattern_without_quotes_are_explained(
    invoke: Callable[..., Result], tmp_path: Path
) -> None:
    for name in ("one.csv", "two.csv"):
        (tmp_path / name).write_text("time\n", "utf-8")
    status, _, err = invoke("life", "two_bearings", "--loads", "one.csv", "two.csv")
    assert status == 2
    assert "put a pattern in quotes" in " ".join(err.replace("│", "").split())
