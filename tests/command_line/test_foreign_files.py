"""Files that a run did not write: none is lost, in whatever folder and at whatever moment."""

import hashlib
import json
import os
import signal
import stat
from pathlib import Path
from typing import Any

import pytest
from faulty_cases import NEW, fill
from test_faults import at_operation, hidden, in_child, kill, state
from test_faults import marked as marked_case

from fe_drivetrain.command_line import app
from fe_drivetrain.common import carrying, folders
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.manifest import MANIFEST, Manifest, manifest_of, read_manifest
from fe_drivetrain.report.history import FILE
from fe_drivetrain.report.suite.case import Case
from fe_drivetrain.report.suite.ownership import check_result_folder
from fe_drivetrain.report.suite.result_folders import new_folder, run_case
from fe_drivetrain.report.suite.suite import run_cases

OLD = "old"

needs_fork = pytest.mark.skipif(not hasattr(os, "fork"), reason="children are forked")
no_fork_warning = pytest.mark.filterwarnings(
    "ignore:.*multi-threaded, use of fork:DeprecationWarning"
)


def add_foreign(folder: Path) -> None:
    """Everything that somebody may keep in a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "notes.txt").write_text("years of work")
    (folder / "notes.txt").chmod(0o640)
    below = folder / "data" / "deep"
    below.mkdir(parents=True)
    (below / "a.csv").write_text("1,2\n")
    (below / "empty").mkdir()
    below.chmod(0o750)
    (folder / "link").symlink_to("../elsewhere.txt")
    (below / "up").symlink_to("../..", target_is_directory=True)
    os.mkfifo(folder / "pipe")


def everything(folder: Path) -> dict[str, tuple[Any, ...]]:
    """What is in a folder: kind and mode of each entry, and content, or where it leads."""
    found: dict[str, tuple[Any, ...]] = {}
    for path in sorted(folder.rglob("*")):
        status = path.lstat()
        content = (
            os.readlink(path)
            if path.is_symlink()
            else hashlib.sha256(path.read_bytes()).hexdigest()
            if stat.S_ISREG(status.st_mode)
            else ""
        )
        found[str(path.relative_to(folder))] = (status.st_mode, content)
    return found


def foreign_of(folder: Path) -> dict[str, tuple[Any, ...]]:
    """As `everything`, of what no manifest lists and no run of these tests writes."""
    own = read_manifest(folder)
    listed = {MANIFEST, FILE} | ({*own.files, *own.folders} if own else set())
    return {name: of for name, of in everything(folder).items() if name not in listed}


@pytest.fixture
def mine(tmp_path: Path) -> tuple[Path, dict[str, tuple[Any, ...]]]:
    """A result folder with files of somebody else in it, and these."""
    out = tmp_path / "b"
    run_case(marked_case(OLD), out)
    before = set(everything(out))
    add_foreign(out)
    return out, {name: of for name, of in everything(out).items() if name not in before}


# --- a folder that is not ours --------------------------------------------------------------------


def test_a_folder_of_somebody_else_is_refused_before_any_work(tmp_path: Path) -> None:
    worked: list[int] = []
    case = Case("g/c", "t", "s", lambda run, page: worked.append(1))
    add_foreign(tmp_path / "home")
    others = {
        "named": {"results.json": '{"loss": 0.1}'},
        "manifest": {"results.json": "{}", MANIFEST: "{}"},
        "readme": {"README": "x", "index.html": "<p>my site"},
    }
    for name, files in others.items():
        (tmp_path / name).mkdir()
        for file, text in files.items():
            (tmp_path / name / file).write_text(text)
    before = everything(tmp_path)
    for name in ("home", *others):
        with pytest.raises(InputError, match="give a") as refused:
            run_case(case, tmp_path / name)
        assert str(tmp_path / name) in str(refused.value)
        with pytest.raises(InputError, match="give a"):
            run_cases([case], tmp_path / name)
    assert worked == []
    assert everything(tmp_path) == before


def test_a_check_into_the_folder_of_the_scene_loses_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    add_foreign(tmp_path)
    with pytest.raises(SystemExit) as ended:
        app.main(["new", "my.yaml"])
    assert ended.value.code in (0, None)
    before = everything(tmp_path)
    (tmp_path / "loads.csv").write_text("time [s],Fx [N]\n")
    for command in (
        ["check", "my.yaml"],
        ["study", "my.yaml"],
        ["advise", "my.yaml"],
        ["uncertainty", "my.yaml"],
        ["compare", "my.yaml", "two_bearings"],
        ["loads", "loads.csv"],
        ["life", "my.yaml", "--loads", "loads.csv"],
        ["run", "nafems_le10", "--quick"],
        ["run", "nafems_le10", "vm18_curved_bar", "--quick"],
    ):
        with pytest.raises(SystemExit) as ended:
            app.main([*command, "--out", "."])
        assert ended.value.code == 2, command
        assert "drivetrain.schema.json" in capsys.readouterr().err, command
    (tmp_path / "loads.csv").unlink()
    assert everything(tmp_path) == before


def test_a_folder_of_somebody_else_above_results_gets_no_pages(tmp_path: Path) -> None:
    add_foreign(tmp_path)
    (tmp_path / "index.html").write_text("<p>my site")
    before = everything(tmp_path)
    run_case(marked_case(NEW), tmp_path / "a" / "b")
    assert state(tmp_path / "a" / "b") == NEW
    now = everything(tmp_path)
    assert {name: of for name, of in now.items() if not name.startswith("a/") and name != "a"} == (
        before
    )


# --- a folder that is ours, with files of others in it --------------------------------------------


@pytest.mark.parametrize("exchange", [True, False])
@pytest.mark.parametrize("links", [True, False])
def test_a_run_replaces_its_own_files_alone(
    mine: tuple[Path, dict[str, tuple[Any, ...]]],
    monkeypatch: pytest.MonkeyPatch,
    exchange: bool,
    links: bool,
) -> None:
    if not exchange:
        monkeypatch.setattr(folders, "_exchange", lambda first, second: False)
    out, foreign = mine
    if not links:
        (out / "pipe").unlink()  # which only a link can carry
        foreign.pop("pipe")

        def refuse(*arguments: Any, **named: Any) -> None:
            raise PermissionError(1, "no links here")

        monkeypatch.setattr(os, "link", refuse)
    inode = (out / "notes.txt").stat().st_ino
    times = (out / "data" / "deep" / "a.csv").stat().st_mtime_ns
    for _ in range(2):
        run_case(Case("a/b", "t", "s", lambda run, page: fill(run, page, NEW)), out)
        assert foreign_of(out) == foreign
        assert read_mark(out) == NEW
    assert (out / "data" / "deep" / "a.csv").stat().st_mtime_ns == times
    assert not links or (out / "notes.txt").stat().st_ino == inode
    assert hidden(out.parent) == []


def test_what_an_earlier_run_wrote_and_this_one_does_not_goes(tmp_path: Path) -> None:
    out = tmp_path / "b"
    run_case(marked_case(OLD), out)
    (out / "two" / "mine.txt").write_text("mine")
    run_case(Case("a/b", "t", "s", lambda run, page: page.answer("What?", "None.", [])), out)
    names = {str(p.relative_to(out)) for p in out.rglob("*")}
    assert names == {MANIFEST, FILE, "report.html", "results.json", "two", "two/mine.txt"}


def test_a_file_that_was_changed_since_the_run_is_kept_and_said_so(tmp_path: Path) -> None:
    out = tmp_path / "b"
    run_case(marked_case(OLD), out)
    (out / "one.txt").write_text("edited")  # which this run writes, too
    (out / "two" / "three.txt").unlink()
    (out / "two" / "three.txt").symlink_to("/etc/hostname")
    with pytest.warns(UserWarning, match=r"kept as one\.txt\.kept, two/three\.txt\.kept"):
        run_case(marked_case(NEW), out)
    assert (out / "one.txt").read_text() == NEW
    assert (out / "one.txt.kept").read_text() == "edited"
    assert os.readlink(out / "two" / "three.txt.kept") == "/etc/hostname"
    (out / "one.txt").write_text("edited again")
    with pytest.warns(UserWarning, match=r"kept as one\.txt\.kept-2"):
        run_case(marked_case("third"), out)
    kept = ("one.txt", "one.txt.kept", "one.txt.kept-2")
    assert [(out / name).read_text() for name in kept] == ["third", "edited", "edited again"]


def test_a_folder_in_the_way_of_a_file_and_a_file_in_that_of_a_folder_are_kept(
    tmp_path: Path,
) -> None:
    out = tmp_path / "b"
    run_case(Case("a/b", "t", "s", lambda run, page: page.answer("What?", "None.", [])), out)
    (out / "one.txt").mkdir()
    (out / "one.txt" / "inner").write_text("inner")
    (out / "two").write_text("two")
    with pytest.warns(UserWarning, match="kept as"):
        run_case(marked_case(NEW), out)
    assert state(out, "one.txt.kept", "two.kept") == NEW
    assert (out / "one.txt.kept" / "inner").read_text() == "inner"
    assert (out / "two.kept").read_text() == "two"


# --- kills, and others at the same time -----------------------------------------------------------


@needs_fork
@no_fork_warning
@pytest.mark.parametrize("exchange", [True, False])
def test_a_kill_at_any_moment_loses_no_file_of_others(
    mine: tuple[Path, dict[str, tuple[Any, ...]]],
    monkeypatch: pytest.MonkeyPatch,
    exchange: bool,
) -> None:
    if not exchange:
        monkeypatch.setattr(folders, "_exchange", lambda first, second: False)
    out, foreign = mine
    (out / "one.txt").write_text("edited")
    edited = hashlib.sha256(b"edited").hexdigest()
    results = (out / "results.json").read_text().replace(OLD, NEW)

    def replace() -> int:
        """What a run does when its results are there: of hundreds of runs one is enough."""
        folder = new_folder(out)
        (folder.path / "two").mkdir()
        (folder.path / "two" / "three.txt").write_text(NEW * 1000)
        (folder.path / "one.txt").write_text(NEW)
        (folder.path / "results.json").write_text(results)
        folder.put_in_place()
        folder.discard()
        return 0

    found = []
    for number in range(int(exchange), 2000, 2):

        def work(number: int = number) -> int:
            at_operation(number, out.parent, kill)
            return replace()

        ended = in_child(work)
        if not out.exists():
            assert not exchange
            new_folder(out).discard()
        now = everything(out)
        assert {name: of for name, of in now.items() if name in foreign} == foreign
        assert edited in {of[1] for of in now.values()}
        found.append(read_mark(out))
        if ended == 0:
            break
        assert ended == -signal.SIGKILL
    assert len(found) > 30
    assert {OLD, NEW} == set(found)
    new_folder(out).discard()
    assert hidden(out.parent) == []
    kept = {name for name in everything(out) if ".kept" in name}
    assert kept == {"one.txt.kept"}


def read_mark(out: Path) -> str:
    """Whose results there are; those of the old run with one file changed."""
    mark = (out / "two" / "three.txt").read_text()[:3]
    assert json.loads((out / "results.json").read_text())["details"] == [mark]
    return mark


def test_what_somebody_saves_while_folders_are_exchanged_goes_into_the_new_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "b"
    run_case(marked_case(OLD), out)
    (out / "notes.txt").write_text("first")

    def late(old: Path, *arguments: Any) -> list[str]:
        renamed = carrying.carry_over(old, *arguments)
        (old / "new.txt").write_text("second")  # as an editor saves: another file of that name
        (old / "new.txt").replace(old / "notes.txt")
        (old / "late").mkdir()
        (old / "late" / "x").write_text("third")
        return renamed

    monkeypatch.setattr(folders, "carry_over", late)
    run_case(marked_case(NEW), out)
    texts = {p.name: p.read_text() for p in out.glob("notes*")}
    assert texts == {"notes.txt": "first", "notes.txt.kept": "second"}
    assert (out / "late" / "x").read_text() == "third"
    assert hidden(tmp_path) == []


def test_a_run_that_comes_between_is_replaced_with_what_it_carried(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Both find the old folder; one is in place when the other has carried all over."""
    out = tmp_path / "b"
    run_case(marked_case(OLD), out)
    add_foreign(out)
    foreign = foreign_of(out)
    came: list[int] = []

    def late(*arguments: Any) -> list[str]:
        if not came:
            came.append(1)
            run_case(marked_case("between"), out)
        return carrying.carry_over(*arguments)

    monkeypatch.setattr(folders, "carry_over", late)
    run_case(marked_case(NEW), out)
    assert foreign_of(out) == foreign
    assert read_mark(out) == NEW
    assert hidden(tmp_path) == []


def test_no_moment_of_another_run_is_taken_for_a_folder_of_somebody_else(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where folders are renamed twice, a run that began between the two was refused."""
    monkeypatch.setattr(folders, "_exchange", lambda first, second: False)
    out = tmp_path / "b"
    run_case(marked_case(OLD), out)
    rename = os.rename
    begun: list[str] = []

    def between(source: Any, target: Any) -> None:
        rename(source, target)
        if Path(source) == out and not begun:
            begun.append("begun")
            check_result_folder(out)
            other = new_folder(out)  # puts back what it takes for left by a kill
            (other.path / "x").write_text("x")
            other.discard()

    monkeypatch.setattr(os, "rename", between)
    run_case(marked_case(NEW), out)
    assert begun == ["begun"]
    assert state(out) == NEW
    assert hidden(tmp_path) == []


def test_a_check_of_a_folder_that_is_replaced_meanwhile_looks_again(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It listed the old folder, and asked for results.json when that had been taken away."""
    out = tmp_path / "b"
    run_case(marked_case(OLD), out)
    listed, away = os.listdir, tmp_path / "away"
    seen: list[int] = []

    def list_and_take_away(path: Any = ".") -> list[str]:
        names = listed(path)
        if Path(path) == out and not seen:
            seen.append(1)
            out.rename(away)
        return names

    monkeypatch.setattr(os, "listdir", list_and_take_away)
    check_result_folder(out)
    assert seen == [1]


# --- folders that go, or cannot be replaced -------------------------------------------------------


def test_a_folder_that_is_removed_while_a_run_writes_is_one_sentence(tmp_path: Path) -> None:
    import shutil

    def remove(run: Any, page: Any) -> None:
        shutil.rmtree(tmp_path / "gone")
        fill(run, page)

    with pytest.raises(InputError, match="was removed"):
        run_case(Case("a/b", "t", "s", remove), tmp_path / "gone" / "b")
    with pytest.raises(InputError, match="No such file"):
        run_cases([Case("a/b", "t", "s", remove)], tmp_path / "gone" / "many")


def test_a_disk_that_is_mounted_in_the_folder_stays(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "b"
    run_case(marked_case(OLD), out)
    (out / "disk").mkdir()
    (out / "disk" / "x").write_text("x")
    lstat = os.lstat

    def mounted(path: Any, **named: Any) -> Any:
        status = lstat(path, **named)
        if Path(path) != out / "disk":
            return status
        return os.stat_result((*status[:2], status.st_dev + 1, *status[3:]))

    monkeypatch.setattr(os, "lstat", mounted)
    with pytest.raises(InputError, match="on another disk"):
        run_case(marked_case(NEW), out)
    assert state(out, "disk") == OLD
    assert (out / "disk" / "x").exists()
    assert hidden(tmp_path) == []


def test_a_folder_that_a_run_replaces_is_still_the_one_where_the_program_works(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "b"
    run_case(marked_case(OLD), out)
    monkeypatch.chdir(out)
    with pytest.warns(UserWarning, match=r"type cd \. to see"):
        run_case(marked_case(NEW), out)
    assert Path("one.txt").read_text() == NEW


def test_a_hidden_folder_of_a_kill_gives_back_what_is_in_it_alone(tmp_path: Path) -> None:
    """After the exchange and before the old files went: what was saved in between is there only."""
    out = tmp_path / "b"
    run_case(marked_case(NEW), out)
    left = tmp_path / ".b-unfinished-abcd_123"
    left.mkdir()
    (left / "one.txt").write_text("1")
    (left / MANIFEST).write_text(manifest_of(left, "results").text())
    (left / "saved.txt").write_text("saved")
    (left / "results.json").write_text("edited")
    half = tmp_path / ".b-unfinished-efgh_456"
    half.mkdir()
    (half / "half.txt").write_text("half")
    new_folder(out).discard()
    assert state(out, "saved.txt", "results.json.kept") == NEW
    assert hidden(tmp_path) == []
    assert Manifest("results").has("saved.txt", out / "saved.txt") is False
