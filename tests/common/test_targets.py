"""What may be written where: files alone, in folders that are there; and cells of tables."""

import csv
import io
import os
import socket
import stat
import subprocess
import sys
from collections.abc import Callable
from concurrent.futures import Future
from pathlib import Path

import pytest
from tiny_case import Result

from fe_drivetrain.common import files
from fe_drivetrain.common.cache import Cache
from fe_drivetrain.common.csv_cells import (
    SafeWriter,
    cell_as_given,
    comment_as_given,
    comment_line,
    safe_cell,
    table_row,
)
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.files import atomic_path, check_writable, scratch_folder
from fe_drivetrain.report.pictures import Picture
from fe_drivetrain.turbine_loads.hub_loads.csv_table import read_csv, write_hub_loads
from fe_drivetrain.turbine_loads.hub_loads.histories import LoadHistory

Invoke = Callable[..., Result]
TETRAHEDRON = """*NODE
1, 0, 0, 0
2, 1, 0, 0
3, 0, 1, 0
4, 0, 0, 1
*ELEMENT, TYPE=C3D4, ELSET=BLOCK
1, 1, 2, 3, 4
"""
KINDS = ("folder", "pipe", "socket", "device", "null", "link", "loop")


@pytest.fixture
def odd(tmp_path: Path) -> dict[str, Path]:
    """What is no regular file, by its kind."""
    found = {kind: tmp_path / f"{kind}.vtu" for kind in KINDS}
    found["folder"].mkdir()
    os.mkfifo(found["pipe"])
    with socket.socket(socket.AF_UNIX) as one:
        one.bind(str(found["socket"])[-100:] if len(str(found["socket"])) < 100 else "s")
    # a device of this test alone, where it may make one: nobody's /dev/null is at risk
    for kind, of in (("device", stat.S_IFBLK), ("null", stat.S_IFCHR)):
        try:
            os.mknod(found[kind], of | 0o600, os.makedev(1, 3) if kind == "null" else 0)
        except PermissionError:
            found.pop(kind)
    found["link"].symlink_to(found["pipe"])
    found["loop"].symlink_to(found["loop"])
    return found


def kinds(odd: dict[str, Path]) -> dict[str, tuple[int, int]]:
    return {kind: (path.lstat().st_mode, path.lstat().st_ino) for kind, path in odd.items()}


def test_what_is_no_file_is_never_replaced(odd: dict[str, Path]) -> None:
    before = kinds(odd)
    for path in odd.values():
        for write in (atomic_path, _checked):
            with pytest.raises(InputError, match=r"is (a|no) |cannot write"), write(path) as one:
                one.write_text("x")
    assert kinds(odd) == before
    assert len(list(odd["pipe"].parent.iterdir())) == len(odd)


def _checked(path: Path) -> object:
    check_writable(path)
    return atomic_path(path)


def test_no_command_replaces_what_is_no_file(odd: dict[str, Path], invoke: Invoke) -> None:
    before = kinds(odd)
    for kind, path in odd.items():
        scene = path.with_suffix(".yaml")
        scene.symlink_to(path)
        for arguments in (
            ["export", "main_bearing_bonded", "--out", str(path), "--overwrite"],
            [
                "export",
                "main_bearing_bonded",
                "--format",
                "json",
                "--out",
                str(path),
                "--overwrite",
            ],
            ["run", "nafems_le10", "--quick", "--junit", str(path)],
            ["new", str(scene), "--overwrite"],
            ["validate", str(scene), "--new", "--overwrite"],
        ):
            code, _, error = invoke(*arguments)
            assert code == 2, (kind, arguments)
            assert "Traceback" not in error
            assert len(error.splitlines()) == 1, error
    assert kinds(odd) == before


def test_an_export_never_replaces_the_scene_that_it_is_of(tmp_path: Path, invoke: Invoke) -> None:
    scene, link = tmp_path / "mine.yaml", tmp_path / "link.json"
    assert invoke("new", str(scene))[0] == 0
    link.symlink_to(scene)
    before = scene.read_bytes()
    for out in (scene, link):
        words = ["export", str(scene), "--format", "json", "--out", str(out), "--overwrite"]
        code, _, error = invoke(*words)
        assert (code, len(error.splitlines())) == (2, 1)
        assert "is the scene itself" in error
    assert scene.read_bytes() == before


def test_a_picture_of_a_part_replaces_no_file_unasked(
    tmp_path: Path, invoke: Invoke, monkeypatch: pytest.MonkeyPatch
) -> None:
    part, picture = tmp_path / "tetrahedron.inp", tmp_path / "photo.png"
    part.write_text(TETRAHEDRON)
    picture.write_bytes(b"a photo")
    os.mkfifo(tmp_path / "pipe.png")

    def drawn(points: object, triangles: object, marks: object, path: Path) -> Picture:
        path.write_bytes(b"a drawing")
        done: Future[None] = Future()
        done.set_result(None)
        return Picture(done)

    monkeypatch.setattr("fe_drivetrain.report.pictures.part.picture_of_part", drawn)
    code, _, error = invoke("part", str(part), "--picture", str(picture))
    assert (code, len(error.splitlines())) == (2, 1)
    assert "add --overwrite" in error
    code, _, error = invoke(
        "part", str(part), "--picture", str(tmp_path / "pipe.png"), "--overwrite"
    )
    assert (code, len(error.splitlines())) == (2, 1)
    assert "is a named pipe" in error
    assert picture.read_bytes() == b"a photo"
    code, text, _ = invoke("part", str(part), "--picture", str(picture), "--overwrite")
    assert (code, picture.read_bytes()) == (0, b"a drawing")
    assert f"picture: {picture}" in text


@pytest.mark.skipif(not Path("/proc/self").exists(), reason="there is no /proc")
def test_a_folder_that_takes_no_file_is_one_sentence(tmp_path: Path, invoke: Invoke) -> None:
    for out in ("/proc/x.json", str(tmp_path / "none" / "x.json"), "/proc/self/x.json"):
        code, _, error = invoke("export", "main_bearing_bonded", "--format", "json", "--out", out)
        assert code == 2
        assert len(error.splitlines()) == 1
        assert out in error
    code, _, error = invoke("check", "main_bearing_bonded", "--out", "/proc/x")
    assert code == 2
    assert "cannot write to /proc" in error
    code, _, error = invoke("run", "nafems_le10", "--quick", "--junit", "/proc/x.xml")
    assert (code, len(error.splitlines())) == (2, 1)


def test_a_folder_that_goes_between_check_and_write_is_one_sentence(tmp_path: Path) -> None:
    folder = tmp_path / "gone"
    for moment in ("before", "while", "after"):
        folder.mkdir()
        check_writable(folder / "x.json")
        if moment == "before":
            folder.rmdir()
        with pytest.raises(InputError, match=r"cannot write .*x\.json.*No such file"):
            _written(folder / "x.json", moment)
    assert list(tmp_path.iterdir()) == []


def _written(path: Path, moment: str) -> None:
    with atomic_path(path) as unfinished:
        if moment == "after":
            unfinished.write_text("x")
        unfinished.unlink()
        path.parent.rmdir()
        if moment == "while":
            unfinished.write_text("x")


def test_a_link_to_a_file_stays_and_the_file_keeps_its_mode(tmp_path: Path) -> None:
    file, link = tmp_path / "file", tmp_path / "link"
    file.write_text("old")
    file.chmod(0o600)
    link.symlink_to(file)
    with atomic_path(link) as unfinished:
        unfinished.write_text("new")
    assert link.is_symlink()
    assert file.read_text() == "new"
    assert stat.S_IMODE(file.stat().st_mode) == 0o600
    assert sorted(os.listdir(tmp_path)) == ["file", "link"]


def test_a_cache_goes_on_where_something_else_is_in_the_way(tmp_path: Path) -> None:
    cache = Cache(tmp_path)
    cache.keep("meshes", {"a": 1}, {})
    (file,) = tmp_path.rglob("*.arrays")
    file.unlink()
    file.mkdir()
    cache.keep("meshes", {"a": 1}, {})
    assert cache.load("meshes", {"a": 1}) is None
    assert file.is_dir()


def test_junit_replaces_a_file_of_its_own_alone(tmp_path: Path, invoke: Invoke) -> None:
    thesis, own, empty = tmp_path / "thesis.txt", tmp_path / "own.xml", tmp_path / "empty.xml"
    thesis.write_text("years of work")
    own.write_text("<?xml version='1.0' encoding='utf-8'?>\n<testsuites name=\"fe-drivetrain\" />")
    empty.touch()
    code, _, error = invoke("run", "nowhere", "--junit", str(thesis))
    assert code == 2
    assert "no JUnit file of fe-drivetrain" in error
    assert thesis.read_text() == "years of work"
    for path in (own, empty):
        code, _, error = invoke("run", "nowhere", "--junit", str(path))
        assert "is unknown" in error


# --- scratch folders ------------------------------------------------------------------------------

KILLED = """
import os, sys
from pathlib import Path
from fe_drivetrain.common.files import scratch_folder
with scratch_folder(Path(sys.argv[1])) as folder:
    (folder / "x").write_text("x")
    os.kill(os.getpid(), 9)
"""


@pytest.mark.skipif(files.fcntl is None, reason="nothing can be locked here")
def test_scratch_folders_of_killed_runs_go_and_nothing_else_does(tmp_path: Path) -> None:
    names = ["fe-drivetrain-scratch-mine", "fe-drivetrain-scratch-abcd_12", "tmpabcd1234"]
    for name in names:
        (tmp_path / name).mkdir()
    (tmp_path / "fe-drivetrain-scratch-abcd1234").symlink_to(names[2], target_is_directory=True)
    for _ in range(2):
        done = subprocess.run([sys.executable, "-c", KILLED, str(tmp_path)], check=False)
        assert done.returncode == -9
        # each removes what the one before has left
        assert len(os.listdir(tmp_path)) == 5
    with scratch_folder(tmp_path) as live:
        assert len(os.listdir(tmp_path)) == 5
        with scratch_folder(tmp_path) as other:
            assert live.is_dir()
            assert other != live
    assert sorted(os.listdir(tmp_path)) == sorted([*names, "fe-drivetrain-scratch-abcd1234"])


# --- cells of tables ------------------------------------------------------------------------------

FORMULAS = ["=1+1", "+cmd", "-cmd", "@SUM(A1)", "\t=1", "\r=1", " =1+1", "-", "--1", '="a"']
PLAIN = [
    "Fx [kN]",
    "a\r\n=b",
    "a=b",
    "it's",
    "'",
    "",
    "-1.5",
    "+2e-3",
    "-inf",
    "nan",
    "a,b",
    'say "x"',
]


def test_a_cell_that_begins_as_a_formula_is_text_and_numbers_stay_numbers() -> None:
    file = io.StringIO()
    SafeWriter(file).writerows([FORMULAS, PLAIN, [-1.5, None, True, 3]])
    formulas, plain, others = csv.reader(io.StringIO(file.getvalue(), newline=""))
    for given, written in zip(FORMULAS, formulas, strict=True):
        assert written == f"'{given}"
        assert cell_as_given(written) == given
    assert plain == PLAIN
    assert others == ["-1.5", "", "True", "3"]
    assert [cell_as_given(cell) for cell in plain] == PLAIN
    assert table_row(["-a", "b,c"]) == '\'-a,"b,c"'


def test_statements_above_a_table_begin_no_formula() -> None:
    line = comment_line("file = a,=1+1\n=2,-3.5,@x")
    assert line == "# file = a,'=1+1 =2,-3.5,'@x"
    assert comment_as_given(line[1:]).strip() == "file = a,=1+1 =2,-3.5,@x"
    assert all(not cell.lstrip().startswith(("=", "@")) for cell in line.split(","))


def test_loads_of_evil_names_are_read_back(tmp_path: Path) -> None:
    import numpy as np

    time = np.arange(4) * 0.5
    history = LoadHistory("x", time, np.full((4, 6), -2.5), {"file": "=cmd,+b", "n": "-1.5"})
    path = tmp_path / "x.csv"
    write_hub_loads(history, path, {"=HYPERLINK(1) [m]": time})
    text = path.read_text()
    for line in text.splitlines():
        for cell in next(csv.reader([line])):
            assert not cell.startswith(("=", "@", "+"))
            assert not cell.startswith("-") or float(cell) < 0
    again = read_csv(path)
    assert again.attributes["file"] == "=cmd,+b"
    np.testing.assert_array_equal(again.loads, history.loads)
    assert "=HYPERLINK(1) [m]" in again.unread


def test_every_writer_of_tables_is_this_one() -> None:
    """Where a module writes CSV otherwise, its cells are not looked at."""
    root = Path(files.__file__).parents[1]
    found = [
        path.name
        for folder in (root, root.parent / "cases", root.parent / "geometry")
        for path in folder.rglob("*.py")
        if "csv.writer(" in path.read_text("utf-8") or "csv.DictWriter(" in path.read_text("utf-8")
    ]
    assert found == []


def test_a_safe_cell_is_safe_again() -> None:
    for cell in FORMULAS + PLAIN:
        assert safe_cell(safe_cell(cell)) == safe_cell(cell)
