"""What the command line prints and returns, with cases that only count."""

import errno
import io
import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from fe_drivetrain.commands import app
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.report.results import Environment, Results, judge, read_results
from fe_drivetrain.suite import case as case_module
from fe_drivetrain.suite.case import OldCase as Case
from fe_drivetrain.suite.case import Run

# a script of a case, as under cases/, that counts to one or does what --set work says
SCRIPT = """
import sys, time
from fe_drivetrain.case import Case
from fe_drivetrain.cli import main_of_case
from fe_drivetrain.results import Environment, Results, judge

def run(run):
    with run.step("work"):
        (run.folder / "half.txt").write_text("half")
        if run.settings.get("work") == "forever":
            time.sleep(600)
    return Results(
        case="group/tiny", title="T\u00eft\u2082e", source="s", summary=["\u2208 one"],
        verdicts=[judge("one", 1.0, 1.0, tolerance=0.1, reason="r", source="s")], sections=[],
        environment=Environment(date="", python="", platform="", versions={}, settings={}),
    )

if __name__ == "__main__":
    main_of_case(Case("group/tiny", "Title", "s", run))
"""


def count(run: Run, computed: float = 1.01) -> Results:
    with run.step("count to one"):
        pass
    return Results(
        case="group/tiny",
        title="A tiny case",
        source="nobody",
        summary=["The answer is one.", "Second.", "Third.", "Fourth."],
        verdicts=[
            judge("one", computed, 1.0, tolerance=0.05, reason="r", source="s", unit="N m/rad"),
            judge("ratio", 2.0, 2.0, tolerance=0.0, reason="r", source="s", relative=False),
        ],
        sections=[],
        environment=Environment(
            date="", python="", platform="", versions={}, settings=dict(run.settings)
        ),
    )


Result = tuple[int, str, str]


@pytest.fixture
def invoke(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Callable[..., Result]:
    """Run the command in an empty folder, with one case that does the given work."""
    monkeypatch.chdir(tmp_path)

    def run(*arguments: str, work: Any = count, main: Callable[[], None] = app.main) -> Result:
        cases = {
            "group/tiny": Case("group/tiny", "A tiny case", "nobody", work),
            "group/other": Case("group/other", "Another [bold] case", "nobody", work),
            "next/third": Case("next/third", "A third", "nobody", work),
        }
        monkeypatch.setattr(case_module, "all_cases", lambda: dict(sorted(cases.items())))
        monkeypatch.setattr(sys, "argv", ["fe-drivetrain", *arguments])
        with pytest.raises(SystemExit) as end:
            main()
        printed = capsys.readouterr()
        assert "Traceback" not in printed.out + printed.err
        code = end.value.code
        return (0 if code is None else int(code)), printed.out, printed.err

    return run


def test_a_passing_case_exits_0_and_says_where_to_read(
    invoke: Callable[..., Result], tmp_path: Path
) -> None:
    status, out, err = invoke("run", "tiny")
    assert status == 0
    lines = out.splitlines()
    assert lines[0].startswith("pass  one: computed 1.01 N m/rad, reference 1 N m/rad")
    assert "tolerance 5 %" in lines[0]
    assert lines[1].startswith("pass  ratio: computed 2, reference 2, tolerance 0")
    assert "The answer is one." in lines
    assert "Fourth." not in lines
    assert lines[-1] == "2 of 2 checks pass: reports/group/tiny/report.html"
    assert (tmp_path / "reports/group/tiny/report.html").is_file()
    assert err.startswith("count to one ... ")
    assert [line.split(" ... ")[0] for line in err.splitlines()] == ["count to one", "report"]
    assert all(line.endswith(" s") for line in err.splitlines())


def test_a_failing_check_exits_1(invoke: Callable[..., Result], tmp_path: Path) -> None:
    status, out, _ = invoke("run", "group/tiny", work=lambda run: count(run, 1.2))
    assert status == 1
    assert out.startswith("FAIL  one: computed 1.2")
    assert "1 of 2 checks pass" in out
    # a failed check is a result, and is kept
    assert not read_results(tmp_path / "reports/group/tiny/results.json").passed


def test_a_nan_fails(invoke: Callable[..., Result]) -> None:
    status, out, _ = invoke("run", "tiny", work=lambda run: count(run, float("nan")))
    assert status == 1
    assert "FAIL  one: computed nan" in out


def test_options_reach_the_case(invoke: Callable[..., Result], tmp_path: Path) -> None:
    got: list[Run] = []

    def work(run: Run) -> Results:
        got.append(run)
        return count(run)

    settings = ["--set", "gearbox.weight=1e6", "--set", "a=[1, x]"]
    assert invoke("run", "tiny", "--quick", "--out", "here/there", *settings, work=work)[0] == 0
    assert got[0].quick
    assert got[0].settings == {"gearbox.weight": 1e6, "a": [1, "x"]}
    stored = json.loads((tmp_path / "here/there/results.json").read_text())
    assert stored["environment"]["settings"] == got[0].settings


def test_a_link_stays_and_the_folder_that_it_leads_to_is_replaced(
    invoke: Callable[..., Result], tmp_path: Path
) -> None:
    assert invoke("run", "tiny", "--out", "real")[0] == 0
    (tmp_path / "link").symlink_to("real")
    assert invoke("run", "tiny", "--out", "link", "--set", "k=2")[0] == 0
    assert (tmp_path / "link").is_symlink()
    assert read_results(tmp_path / "real/results.json").environment.settings == {"k": 2}


def test_the_current_folder_can_be_the_result_folder(
    invoke: Callable[..., Result], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    assert invoke("run", "tiny", "--out", ".")[0] == 0
    assert (tmp_path / "here/report.html").is_file()


def test_a_script_of_a_case_has_the_same_options(
    invoke: Callable[..., Result], tmp_path: Path
) -> None:
    case = Case("group/tiny", "A tiny case", "nobody", count)
    status, out, _ = invoke("--out", "x", "--set", "k=1", main=lambda: app.main_of_case(case))
    assert status == 0
    assert out.endswith("x/report.html\n")
    assert (tmp_path / "x/report.html").is_file()
    assert invoke("--set", "k", main=lambda: app.main_of_case(case))[0] == 2
    assert "A tiny case" in invoke("--help", main=lambda: app.main_of_case(case))[1]


@pytest.mark.parametrize(
    ("arguments", "hint"),
    [
        (("run", "nothing"), "group/tiny"),
        (("run", "tiny", "--set", "novalue"), "KEY=VALUE"),
        (("run", "tiny", "--set", "=1"), "KEY=VALUE"),
        (("run", "tiny", "--set", "k=[1"), "YAML"),
        (("run", "tiny", "--set", "k={a: 1}"), "one by one"),
        (("run", "tiny", "--set", "k=!!python/name:os.system ''"), "YAML"),
        (("run", "tiny", "--set", "k=&a [*a]"), "YAML"),
        (("run", "tiny", "--out", "file"), "folder"),
        (("run", "tiny", "--out", "file/below"), "folder"),
        (("run", "tiny", "--out", "full"), "not results"),
        (("run", "tiny", "--out", "x" * 300), "folder"),
        (("run", "tiny", "--out", "loop/x"), "folder"),
        (("run",), "Missing"),
        (("run", "tiny", "--all"), "leave out either"),
        (("run", "tiny", "nothing"), "group/tiny"),
        (("run", "tiny", "other", "--out", "file"), "folder"),
        (("walk",), "No such command"),
        (("run", "tiny", "--fast"), "No such option"),
    ],
)
def test_mistakes_exit_2_with_a_hint(
    invoke: Callable[..., Result], tmp_path: Path, arguments: tuple[str, ...], hint: str
) -> None:
    (tmp_path / "file").write_text("x")
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "thesis.tex").write_text("x")
    (tmp_path / "loop").symlink_to("loop")
    before = sorted(tmp_path.rglob("*"))
    status, out, err = invoke(*arguments)
    assert status == 2
    assert hint in err
    assert out == ""
    assert sorted(tmp_path.rglob("*")) == before


def test_a_mistake_is_told_in_one_line(invoke: Callable[..., Result], tmp_path: Path) -> None:
    def work(run: Run) -> Results:
        with run.step("read"):
            raise InputError("shaft: length is -1 but must be greater than 0: give a length")

    status, _, err = invoke("run", "tiny", work=work)
    assert status == 2
    assert err.splitlines()[-1] == (
        "fe-drivetrain: shaft: length is -1 but must be greater than 0: give a length"
    )
    assert not any((tmp_path / "reports").rglob("*.json"))


def test_a_full_disk_exits_2(invoke: Callable[..., Result]) -> None:
    def work(run: Run) -> Results:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), "big.vtu")

    status, _, err = invoke("run", "tiny", work=work)
    assert status == 2
    assert "big.vtu: No space left" in err


def test_a_missing_system_library_is_named(invoke: Callable[..., Result]) -> None:
    def work(run: Run) -> Results:
        raise OSError("libGLU.so.1: cannot open shared object file: No such file or directory")

    status, _, err = invoke("run", "tiny", work=work)
    assert status == 2
    assert "libGLU.so.1" in err
    assert "libglu1-mesa" in err


def test_our_own_faults_are_not_blamed_on_the_user(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def work(run: Run) -> Results:
        raise FileNotFoundError(errno.ENOENT, "no such file", "template")

    case = Case("group/tiny", "t", "s", work)
    monkeypatch.setattr(sys, "argv", ["tiny.py", "--out", str(tmp_path / "out")])
    with pytest.raises(FileNotFoundError):
        app.main_of_case(case)


def test_ctrl_c_exits_130_and_keeps_the_earlier_results(
    invoke: Callable[..., Result], tmp_path: Path
) -> None:
    def work(run: Run) -> Results:
        with run.step("long"):
            raise KeyboardInterrupt

    assert invoke("run", "tiny")[0] == 0
    before = (tmp_path / "reports/group/tiny/results.json").read_bytes()
    status, out, err = invoke("run", "tiny", work=work)
    assert (status, out) == (130, "")
    assert "stopped" in err
    assert (tmp_path / "reports/group/tiny/results.json").read_bytes() == before
    assert os.listdir(tmp_path / "reports/group") == ["tiny"]


@pytest.fixture
def script(tmp_path: Path) -> Path:
    path = tmp_path / "tiny.py"
    path.write_text(SCRIPT, "utf-8")
    return path


@pytest.mark.parametrize(("sent", "status"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_signal_leaves_nothing_behind(
    script: Path, tmp_path: Path, sent: signal.Signals, status: int
) -> None:
    command = [sys.executable, str(script), "--out", "out/x", "--set", "work=forever"]
    with subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        assert process.stderr.read(len("work ... ")) == "work ... "
        (hidden,) = (tmp_path / "out").iterdir()
        assert hidden.name.startswith(".x-")
        process.send_signal(sent)
        err = process.stderr.read()
        assert process.wait(60) == status
    assert "Traceback" not in err
    assert list((tmp_path / "out").iterdir()) == []


@pytest.mark.parametrize("arguments", [["--out", "x"], ["--help"]])
def test_a_reader_that_goes_away_is_no_error(
    script: Path, tmp_path: Path, arguments: list[str]
) -> None:
    command = [sys.executable, str(script), *arguments]
    read, write = os.pipe()
    os.close(read)
    try:
        done = subprocess.run(
            command, cwd=tmp_path, stdout=write, stderr=subprocess.PIPE, text=True, check=False
        )
    finally:
        os.close(write)
    assert "Traceback" not in done.stderr
    assert "BrokenPipe" not in done.stderr
    if arguments != ["--help"]:
        assert done.returncode == 0
        assert (tmp_path / "x" / "report.html").is_file()


def test_progress_nobody_reads_does_not_stop_a_run(script: Path, tmp_path: Path) -> None:
    read, write = os.pipe()
    os.close(read)
    try:
        done = subprocess.run(
            [sys.executable, str(script), "--out", "x"],
            cwd=tmp_path,
            stdout=subprocess.PIPE,
            stderr=write,
            text=True,
            check=False,
        )
    finally:
        os.close(write)
    assert done.returncode == 0
    assert "1 of 1 checks pass" in done.stdout


def test_a_narrow_encoding_is_no_error(script: Path, tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, str(script), "--out", "x"],
        cwd=tmp_path,
        env={**os.environ, "PYTHONIOENCODING": "ascii"},
        capture_output=True,
        check=False,
    )
    assert done.returncode == 0
    assert b"? one" in done.stdout


@pytest.mark.parametrize(
    ("arguments", "names"),
    [
        (("tiny", "next/third", "tiny"), ["group/tiny", "next/third"]),
        (("--all",), ["group/other", "group/tiny", "next/third"]),
    ],
)
def test_several_cases_have_a_page_that_lists_them(
    invoke: Callable[..., Result], tmp_path: Path, arguments: tuple[str, ...], names: list[str]
) -> None:
    status, out, err = invoke("run", *arguments, "--set", "k=2", "--quick")
    assert status == 0
    lines = out.splitlines()
    assert [line.split()[:2] for line in lines[:-2]] == [["pass", f"{name}:"] for name in names]
    assert lines[-1] == f"{len(names)} of {len(names)} cases pass: reports/index.html"
    page = (tmp_path / "reports/index.html").read_text()
    for name in names:
        assert f"{name}/report.html" in page
        assert read_results(tmp_path / "reports" / name / "results.json").environment.settings
        assert f"{name}: count to one ... " in err


def test_several_cases_exit_1_where_a_check_fails_and_2_where_one_cannot_run(
    invoke: Callable[..., Result], tmp_path: Path
) -> None:
    status, out, _ = invoke("run", "--all", "--out", "x", work=lambda run: count(run, 1.2))
    assert status == 1
    assert out.splitlines()[0].startswith("FAIL  group/other: 1 of 2 checks pass")
    assert "      FAIL  one: computed 1.2" in out
    assert out.endswith("0 of 3 cases pass: x/index.html\n")

    def work(run: Run) -> Results:
        raise InputError("loads: no file is there: give one")

    status, out, _ = invoke("run", "tiny", "other", "--out", "y", work=work)
    assert status == 2
    assert out.splitlines()[0] == "none  group/tiny: loads: no file is there: give one"
    assert [path.name for path in (tmp_path / "y/group").iterdir()] == []
    assert "loads: no file is there" in (tmp_path / "y/index.html").read_text()


def test_list_groups_the_cases(invoke: Callable[..., Result]) -> None:
    status, out, _ = invoke("list")
    assert status == 0
    assert [line.split() for line in out.splitlines()] == [
        ["group"],
        ["group/other", "Another", "[bold]", "case"],
        ["group/tiny", "A", "tiny", "case"],
        [],
        ["next"],
        ["next/third", "A", "third"],
    ]


def test_version_is_the_installed_one(invoke: Callable[..., Result]) -> None:
    from importlib.metadata import version

    status, out, _ = invoke("--version")
    assert (status, out) == (0, f"fe-drivetrain {version('fe-drivetrain')}\n")


@pytest.mark.parametrize("argument", ["--help", "--version", "list"])
def test_help_and_list_import_nothing_heavy(argument: str) -> None:
    heavy = ["numpy", "scipy", "gmsh", "skfem", "numba", "pyvista", "plotly", "jinja2", "PIL"]
    heavy += [
        "fe_drivetrain.report.results",
        "fe_drivetrain.scene.scene",
        "fe_drivetrain.mesh.mesh",
    ]
    if argument != "list":
        heavy.append("pydantic")  # which typer uses itself to run a command
    program = (
        "import sys\n"
        f"sys.argv = ['fe-drivetrain', {argument!r}]\n"
        "from fe_drivetrain.commands.app import main\n"
        "try:\n"
        "    main()\n"
        "finally:\n"
        f"    print([m for m in {heavy} if m in sys.modules], file=sys.stderr)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=True
    )
    assert done.stderr.strip() == "[]"


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1e6", 1e6),
        ("-2.5E-3", -2.5e-3),
        ("4", 4),
        (".5", 0.5),
        ("010", 10.0),
        ("true", True),
        ("null", None),
        ("", None),
        ("rigid", "rigid"),
        ("'1e6'", "1e6"),
        ("a=b", "a=b"),
        ("12:30", "12:30"),
        ("2026-01-31", "2026-01-31"),
        ("runs/*.outb", "runs/*.outb"),
        ("[4e6, 8e7, rigid, [0]]", [4e6, 8e7, "rigid", [0]]),
    ],
)
def test_settings_are_numbers_words_and_lists(text: str, value: object) -> None:
    parsed = app.parse_settings([f"key.0.name={text}"])
    assert parsed == {"key.0.name": value}
    assert isinstance(parsed["key.0.name"], type(value))


def test_a_step_that_counts_is_one_line(capsys: pytest.CaptureFixture[str]) -> None:
    with app._plain_steps() as report:
        report("part")
        report("loads (1 of 2)")
        report("loads (2 of 2)")
        report("last")
    lines = capsys.readouterr().err.splitlines()
    assert [line.split(" ... ")[0] for line in lines] == ["part", "loads", "last"]


def test_steps_side_by_side_are_whole_lines(capsys: pytest.CaptureFixture[str]) -> None:
    with app._plain_steps() as report:
        report("before")
        report("")
        report("one (1 of 2)", 1)
        report("two", 2)
        report("here")
        report("one (2 of 2)", 1)
        report("three", 1)
        report("", 2)
        report("", 1)
        report("after")
    lines = capsys.readouterr().err.splitlines()
    assert [line.split(" ... ")[0] for line in lines] == [
        "before",
        "one",
        "two",
        "three",
        "here",
        "after",
    ]
    assert all(line.endswith(" s") for line in lines)


def test_a_line_that_is_open_is_not_written_into(capsys: pytest.CaptureFixture[str]) -> None:
    def stopped() -> None:
        with app._plain_steps() as report:
            report("here")
            report("there", 1)
            report("", 1)
            report("there again", 1)
            raise InputError("x")

    with pytest.raises(InputError):
        stopped()
    lines = capsys.readouterr().err.splitlines()
    assert lines[0] == "here ... "
    assert lines[1].startswith("there ... ")
    assert lines[1].endswith(" s")
    assert sorted(lines[2:]) == ["here ... not finished", "there again ... not finished"]


def test_on_a_terminal_steps_end_as_lines(monkeypatch: pytest.MonkeyPatch) -> None:
    class Terminal(io.StringIO):
        def isatty(self) -> bool:
            return True

    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    monkeypatch.setenv("TERM", "xterm")
    with app._progress() as report:
        report("part [bold]")
        report("loads (1 of 2)")
        report("loads (2 of 2)")
        report("beside", 1)
        report("", 1)
    shown = terminal.getvalue()
    assert shown.count("beside ... ") == 1
    assert "part [bold] ... " in shown
    assert shown.count("loads ... ") == 1


def test_a_file_pattern_is_a_word() -> None:
    """To YAML a leading asterisk is an alias; to a user it is all files."""
    assert app.parse_settings(["loads=*.csv", "mesh.shaft=1e-1"]) == {
        "loads": "*.csv",
        "mesh.shaft": 0.1,
    }


def exported(monkeypatch: pytest.MonkeyPatch, *arguments: str) -> int:
    monkeypatch.setattr("sys.argv", ["fe-drivetrain", "export", *arguments])
    with pytest.raises(SystemExit) as end:
        app.main()
    return int(end.value.code or 0)


CONDENSED = ("main_bearing_bonded", "--out", "a", "--format", "csv")


def test_export_lists_every_format(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from fe_drivetrain.export.files import FORMATS

    assert exported(monkeypatch, "--list") == 0
    head, *lines = capsys.readouterr().out.splitlines()
    assert head.split() == ["format", "ending", "read", "by", "needs"]
    assert [line.split()[0] for line in lines] == list(FORMATS)
    for line, form in zip(lines, FORMATS.values(), strict=True):
        assert form.suffix in line
        assert form.reader in line
        assert (f"fe-drivetrain[{form.extra}]" in line) == bool(form.extra)


def test_export_condenses_and_writes(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    """The free shaft and a bearing, as Python gives them."""
    import numpy as np
    import yaml
    from conftest import coarse_scene

    from fe_drivetrain import export
    from fe_drivetrain.export.scene_export import superelement_of

    scene = coarse_scene("bonded")
    file = tmp_path / "mine.yaml"
    file.write_text(yaml.safe_dump(scene.model_dump(mode="json")), "utf-8")
    out = tmp_path / "out.csv"
    common = (str(file), "--format", "csv", "--out", str(out))
    for arguments, element in (
        (("--at", "hub,gearbox", "--level", "auto"), superelement_of(scene, at=["hub", "gearbox"])),
        (("--what", "main_bearing"), superelement_of(scene, "main_bearing")),
    ):
        assert exported(monkeypatch, *common, *arguments, "--overwrite") == 0
        said = capsys.readouterr().out
        assert f"{element.name} at {', '.join(element.points)}, " in said
        found = export.read(out, "csv")
        assert found.points == element.points
        assert found.supported == element.supported
        assert found.band == element.band
        assert found.origin == element.origin
        np.testing.assert_array_equal(found.stiffness, element.stiffness)
        assert (found.mass is None) == (element.mass is None)
    assert [path.name for path in tmp_path.iterdir() if path.name.startswith(".")] == []


def test_the_exported_drivetrain_stands_on_springs_within_its_band() -> None:
    import numpy as np
    from conftest import coarse_scene

    from fe_drivetrain.export.scene_export import superelement_of
    from fe_drivetrain.fidelity.ladder import housing_springs, shaft_level

    scene = coarse_scene("bonded")
    element = superelement_of(scene, "drivetrain", level=1)
    assert element.points == ("hub",)
    assert element.supported
    assert element.origin.level.startswith("1 ")
    soft = shaft_level(scene, 1, housing_springs(scene)[0]).stiffness(["hub"])
    size = np.sqrt(np.outer(element.stiffness.diagonal(), element.stiffness.diagonal()))
    assert element.band == pytest.approx(np.abs((element.stiffness - soft) / size).max())
    # faces that keep their shape are never softer
    assert np.linalg.eigvalsh((element.stiffness - soft) / size)[0] > -1e-9


def test_export_overwrites_only_when_told(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    for name, more in (("a.json", ("--format", "json")), ("a.vtu", ())):
        out = tmp_path / name
        out.write_text("mine")
        arguments = ("main_bearing_bonded", "--out", str(out), *more)
        assert exported(monkeypatch, *arguments) == 2
        assert "add --overwrite" in capsys.readouterr().err
        assert out.read_text() == "mine"
    # what fails leaves the file as it was, and nothing beside it
    assert exported(monkeypatch, *arguments, "--overwrite", "--set", "shaft.front=7") == 2
    assert out.read_text() == "mine"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.json", "a.vtu"]


@pytest.mark.parametrize(
    ("arguments", "hint"),
    [
        ((), "Missing SCENE"),
        (("main_bearing_bonded",), "Missing --out FILE"),
        (("main_bearing_bonded", "--out", "a.inp", "--at", "hub"), "--at needs --format"),
        (("main_bearing_bonded", "--out", "a.inp", "--level", "2"), "--level needs --format"),
        (("main_bearing_bonded", "--out", "a.csv"), "or give --format"),
        (("main_bearing_bonded", "--out", "a", "--format", "xyz"), "use json, csv"),
        (("main_bearing_bonded", "--out", "no/a", "--format", "csv"), "folder that exists"),
        (
            (*CONDENSED, "--what", "tower"),
            "use one of shaft, drivetrain, seats, main_bearing",
        ),
        (
            (*CONDENSED, "--level", "9"),
            "level 9 of shaft is unknown: use auto or one of 1, 2, 3",
        ),
        (
            (*CONDENSED, "--level", "two"),
            "level 'two'",
        ),
        ((*CONDENSED, "--at", ","), "none must be"),
        (
            (*CONDENSED, "--at", "hub,hub"),
            "each once",
        ),
        (
            (*CONDENSED, "--what", "main_bearing", "--at", "hub"),
            "its only point is 'main_bearing'",
        ),
        (
            (*CONDENSED, "--level", "1", "--at", "nose"),
            "point 'nose' is unknown",
        ),
    ],
)
def test_export_says_what_is_wrong(
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    arguments: tuple[str, ...],
    hint: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    assert exported(monkeypatch, *arguments) == 2
    said = capsys.readouterr().err
    assert hint in said
    assert "Traceback" not in said
    assert not list(tmp_path.iterdir())
