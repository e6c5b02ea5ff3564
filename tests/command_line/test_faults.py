"""Kills, full disks, two runs at once, broken caches: what is on disk is old or new, never half.

Faults are put exactly where they can do harm: before each operation of the file system that a run
makes, in a child process of its own.
"""

import ctypes
import errno
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import rich.progress  # noqa: F401 - once here, not in each of hundreds of forked children
from coarse_scenes import coarse_scene
from faulty_cases import NEW, crash, fill, gmsh_fails, mesh_a_scene
from hypothesis import given
from hypothesis import strategies as st

from fe_drivetrain.command_line import terminal
from fe_drivetrain.command_line.run import run_and_print
from fe_drivetrain.common import folders
from fe_drivetrain.common.cache import CACHE_VARIABLE, Cache
from fe_drivetrain.common.files import atomic_path
from fe_drivetrain.common.folders import HiddenFolder
from fe_drivetrain.common.manifest import MANIFEST
from fe_drivetrain.common.stopped import STOPPED, TERMINATED
from fe_drivetrain.common.threads import CORES_VARIABLE as CORES
from fe_drivetrain.elasticity.mesh import cached
from fe_drivetrain.geometry import gmsh_session
from fe_drivetrain.report.history import FILE
from fe_drivetrain.report.results import read_results
from fe_drivetrain.report.suite.case import Case
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.result_folders import new_folder, run_case
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.report.suite.suite import run_cases
from fe_drivetrain.shafts.response.model import mesh_scene

pytestmark = [
    pytest.mark.skipif(not hasattr(os, "fork"), reason="children are forked"),
    # since Python 3.12; they are idle threads of BLAS and pytest-xdist, which no child needs
    pytest.mark.filterwarnings("ignore:.*multi-threaded, use of fork:DeprecationWarning"),
]

OLD, MISSING = "old", "missing"
UNHARMED = 50
#: What the interpreter announces before it touches the disk.
OPERATIONS = ("open", "os.", "shutil.", "tempfile.", "ctypes.dlsym")


def marked(mark: str) -> Case:
    """A case whose mark stands in several of its files."""

    def work(run: Run, page: Page) -> None:
        with run.step("work"):
            fill(run, page, mark)

    return Case("a/b", "t", "s", work)


def state(out: Path, *others: str) -> str:
    """Whose results stand there; an assertion fails where they are not all of one run."""
    if not out.exists():
        return MISSING
    (mark,) = read_results(out / "results.json").details
    assert mark in (out / "report.html").read_text()
    assert (out / "one.txt").read_text() == mark
    assert (out / "two" / "three.txt").read_text() == mark * 1000
    # runs of several cases have one history above their folders
    there = {p.name for p in out.iterdir()} - {FILE, MANIFEST}
    assert there == {"one.txt", "report.html", "results.json", "two", *others}
    return mark


def in_child(work: Callable[[], int]) -> int:
    """Do it in a child process; its status, negative where a signal ended it."""
    pid = os.fork()
    if pid == 0:
        status = 99
        try:
            status = work()
        finally:
            os._exit(status)
    _, status = os.waitpid(pid, 0)
    return os.waitstatus_to_exitcode(status)


def at_operation(number: int, folder: Path, fault: Callable[[], None]) -> Callable[[], bool]:
    """Let a fault happen before that operation of this process in the folder; tells if it has."""
    count = -1

    def hook(event: str, arguments: tuple[Any, ...]) -> None:
        nonlocal count
        if not event.startswith(OPERATIONS):
            return
        if event == "ctypes.dlsym" or any(str(folder) in str(a) for a in arguments):
            count += 1
            if count == number:
                fault()

    sys.addaudithook(hook)  # cannot be taken away again: for children only
    return lambda: count >= number


def kill() -> None:
    os.kill(os.getpid(), signal.SIGKILL)


def fill_the_disk() -> None:
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), "results.json")


def interrupt() -> None:
    raise KeyboardInterrupt


def run_quietly(case: Case, out: Path) -> int:
    """What the command line does, without a word."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.dup2(nowhere, 2)
    return run_and_print(lambda: [case], out)


def hidden(folder: Path) -> list[str]:
    return [p.name for p in folder.rglob(".*")]


# --- every moment of a run -----------------------------------------------------------------------


@pytest.mark.parametrize("exchange", [True, False])
@pytest.mark.parametrize(
    ("fault", "status"), [(kill, -signal.SIGKILL), (fill_the_disk, 2), (interrupt, 130)]
)
def test_at_no_moment_does_a_fault_leave_half_of_anything(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    fault: Callable[[], None],
    status: int,
    exchange: bool,
) -> None:
    if not exchange:
        monkeypatch.setattr(folders, "_exchange", lambda first, second: False)
    out = tmp_path / "b"
    found: list[str] = []
    for number in range(1000):
        if found[-1:] != [OLD] or hidden(tmp_path):
            run_case(marked(OLD), out)
        assert [p.name for p in tmp_path.iterdir()] == ["b"]

        def work(number: int = number) -> int:
            happened = at_operation(number, tmp_path, fault)
            ended = run_quietly(marked(NEW), out)
            return ended if happened() else UNHARMED

        ended = in_child(work)
        found.append(state(out))
        if ended == UNHARMED:
            break
        # what only tidies goes on without it
        assert ended == status or (fault is fill_the_disk and ended == 0)
        assert len(hidden(tmp_path)) <= (1 if exchange else 2)
        if found[-1] == MISSING:
            # between two renames, where the system has no exchange, and only by a kill
            assert not exchange
            assert fault is kill
            new_folder(out).discard()
            assert state(out) == OLD
    assert len(found) > 15
    assert found[-1] == NEW
    if fault is not fill_the_disk:
        assert found == sorted(found, key=[OLD, MISSING, NEW].index)
    assert found.count(MISSING) == (1 if fault is kill and not exchange else 0)


@pytest.mark.parametrize("size", [0, 1, 100, 1000, 5000])
def test_a_disk_that_is_full_at_any_size_of_file_is_told(tmp_path: Path, size: int) -> None:
    import resource

    out = tmp_path / "b"
    run_case(marked(OLD), out)

    def work() -> int:
        resource.setrlimit(
            resource.RLIMIT_FSIZE, (size, resource.getrlimit(resource.RLIMIT_FSIZE)[1])
        )
        # what pytest catches this process's words in is a file, too
        read, write = os.pipe()
        os.set_blocking(read, False)
        sys.stdout = sys.stderr = open(write, "w")  # noqa: SIM115
        status = run_and_print(lambda: [marked(NEW)], out)
        sys.stderr.flush()
        said = os.read(read, 10_000).decode()
        full = "File too large" in said or "see whether its disk is full" in said
        return status if "Traceback" not in said and full else 98

    assert in_child(work) == 2
    assert state(out) == OLD
    assert [p.name for p in tmp_path.iterdir()] == ["b"]


def test_a_disk_that_is_full_is_told_for_one_case_of_several(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    def full(run: Run, page: Page) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), "big.vtu")

    cases = [Case("a/full", "t", "s", full), Case("a/b", "t", "s", marked(NEW).run)]
    problems = run_cases(cases, tmp_path)
    assert "big.vtu: No space left" in problems["a/full"].message
    assert state(tmp_path / "a" / "b") == NEW
    assert "Traceback" not in capfd.readouterr().err


# --- two runs at the same time -------------------------------------------------------------------


@pytest.mark.parametrize("exchange", [True, False])
@pytest.mark.parametrize("there", [True, False])
def test_two_runs_into_one_folder_leave_the_whole_of_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, exchange: bool, there: bool
) -> None:
    if not exchange:
        monkeypatch.setattr(folders, "_exchange", lambda first, second: False)
    for k in range(4):
        out = tmp_path / f"{k}" / "b"
        if there:
            run_case(marked("before"), out)
        start = time.time() + 0.02

        def work(mark: str, out: Path = out, start: float = start) -> int:
            while time.time() < start:
                pass
            return run_quietly(marked(mark), out)

        pids = []
        for mark in ("one", "two", "three"):
            pid = os.fork()
            if pid == 0:
                status = 99
                try:
                    status = work(mark)
                finally:
                    os._exit(status)
            pids.append(pid)
        ended = [os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]) for pid in pids]
        assert ended == [0, 0, 0]
        assert state(out) in ("one", "two", "three")
        assert [p.name for p in out.parent.iterdir()] == ["b"]


def test_what_a_live_run_fills_is_not_taken_for_abandoned(tmp_path: Path) -> None:
    live = HiddenFolder(tmp_path / "b")
    (live.path / "half.txt").write_text("half")
    run_case(marked(NEW), tmp_path / "b")
    assert (live.path / "half.txt").exists()
    live.put_in_place()
    live.discard()
    assert (tmp_path / "b" / "half.txt").exists()
    assert [p.name for p in tmp_path.iterdir()] == ["b"]


def test_only_what_this_program_named_is_ever_removed(tmp_path: Path) -> None:
    names = [".b-thesis", ".b-unfinished", ".b-unfinished-thesis!", "b-unfinished-abcdefgh"]
    for name in [*names, ".c-unfinished-abcdefgh"]:
        (tmp_path / name).mkdir()
        (tmp_path / name / "chapter.tex").write_text("years of work")
    (tmp_path / ".b-unfinished-abcdefgh").symlink_to(tmp_path / names[0])
    run_case(marked(NEW), tmp_path / "b")
    assert {p.name for p in tmp_path.iterdir()} >= {*names, ".c-unfinished-abcdefgh"}
    assert all((tmp_path / name / "chapter.tex").exists() for name in names)


def test_a_file_that_a_kill_left_half_written_is_removed_by_the_next(tmp_path: Path) -> None:
    target = tmp_path / "model.inp"
    target.write_text("old")

    def work() -> int:
        with atomic_path(target) as unfinished:
            unfinished.write_text("half")
            kill()
        return 0

    with atomic_path(target) as live:
        live.write_text("new")
        assert in_child(work) == -signal.SIGKILL
        assert target.read_text() == "old"
        assert len(hidden(tmp_path)) == 2
        with atomic_path(target) as other:
            other.write_text("newer")
        assert hidden(tmp_path) == [live.name]
    assert target.read_text() == "new"
    assert hidden(tmp_path) == []


# --- the cache -----------------------------------------------------------------------------------

CONTENT = {"a": 0.1}
ARRAYS = {f"face {k}": np.arange(k * 5.0, k * 5 + 4) for k in range(4)}


@pytest.fixture(scope="module")
def entry(tmp_path_factory: pytest.TempPathFactory) -> tuple[Cache, Path, bytes]:
    folder = tmp_path_factory.mktemp("entry")
    Cache(folder).keep("meshes", CONTENT, ARRAYS)
    (file,) = folder.rglob("*.arrays")
    return Cache(folder), file, file.read_bytes()


@given(st.integers(0, 10**6), st.integers(1, 255), st.sampled_from(["flip", "cut", "zero", "add"]))
def test_a_cache_damaged_anywhere_gives_no_other_numbers(
    entry: tuple[Cache, Path, bytes], place: int, flip: int, damage: str
) -> None:
    cache, file, content = entry
    place %= len(content)
    changed = bytearray(content)
    if damage == "flip":
        changed[place] ^= flip
    elif damage == "cut":
        del changed[place:]
    elif damage == "zero":
        changed[place : place + 64] = bytes(len(changed[place : place + 64]))
    else:
        changed[place:place] = bytes([flip]) * 7
    file.write_bytes(changed)
    assert (cache.load("meshes", CONTENT) is not None) == (bytes(changed) == content)


def test_a_kill_at_any_moment_of_keeping_leaves_a_sound_cache(tmp_path: Path) -> None:
    cache = Cache(tmp_path)
    for number in range(100):

        def work(number: int = number) -> int:
            at_operation(number, tmp_path, kill)
            cache.keep("meshes", {"k": number}, ARRAYS)
            return 0

        ended = in_child(work)
        loaded = cache.load("meshes", {"k": number})
        assert loaded is None or list(loaded) == list(ARRAYS)
        if ended == 0:
            break
    assert number > 5
    cache.keep("meshes", CONTENT, ARRAYS)
    assert hidden(tmp_path) == []


def test_a_cache_that_can_only_be_read_gives_what_it_has(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """To root nothing is read-only, so the system's answer is put in its place."""
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))
    scene = coarse_scene("bonded")
    made = mesh_scene(scene)

    def refuse(*arguments: Any, **more: Any) -> None:
        raise OSError(errno.EROFS, os.strerror(errno.EROFS))

    monkeypatch.setattr(os, "utime", refuse)
    monkeypatch.setattr(Path, "touch", refuse)
    kept = mesh_scene(scene)
    assert kept.kept
    np.testing.assert_array_equal(kept.points, made.points)
    before = sorted(tmp_path.rglob("*"))
    monkeypatch.setattr(cached, "generate", lambda *arguments, **named: made)
    other = mesh_scene(coarse_scene("bonded", **{"mesh.shaft": 0.29}))
    assert not other.kept
    assert sorted(tmp_path.rglob("*")) == before


# --- one case of many ----------------------------------------------------------------------------


@pytest.mark.parametrize("cores", ["1", "2"])
def test_one_case_that_fails_in_gmsh_keeps_no_other_from_finishing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, cores: str
) -> None:
    monkeypatch.setenv(CORES, cores)
    names = {"a/first": mesh_a_scene, "a/fails": gmsh_fails, "a/last": mesh_a_scene}
    out = tmp_path / "out"
    old = out / "a" / "fails"
    run_case(Case("a/fails", "t", "s", marked(OLD).run), old)
    problems = run_cases([Case(name, "t", "s", work) for name, work in names.items()], out)
    assert list(problems) == ["a/fails"]
    assert "gmsh could not build or mesh" in problems["a/fails"].message
    assert "A segment and a facet intersect" in problems["a/fails"].message
    assert [state(out / name) for name in names] == [NEW, OLD, NEW]
    assert "A segment and a facet intersect" in (out / "index.html").read_text()
    assert hidden(out) == []


def test_one_case_whose_process_dies_keeps_no_other_from_finishing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A segmentation fault in a library, say: it ended all the others."""
    monkeypatch.setenv(CORES, "2")
    names = [f"a/{k}" for k in range(5)]
    cases = [Case(n, "t", "s", crash if n in ("a/0", "a/2") else fill) for n in names]
    cases.append(Case("a/alone", "t", "s", crash, alone=True))
    problems = run_cases(cases, tmp_path)
    assert sorted(problems) == ["a/0", "a/2", "a/alone"]
    assert all(f"status -{signal.SIGSEGV:d}" in p.message for p in problems.values())
    assert [state(tmp_path / "a" / k) for k in "134"] == [NEW] * 3
    assert hidden(tmp_path) == []


def test_a_mesh_leaves_the_terminate_signal_to_python() -> None:
    """gmsh.initialize gives it back to the system, so that it ended a run without a word."""
    got = []
    before = signal.signal(signal.SIGTERM, lambda *arguments: got.append(arguments))
    try:
        with gmsh_session():
            os.kill(os.getpid(), signal.SIGTERM)
        os.kill(os.getpid(), signal.SIGTERM)
    finally:
        signal.signal(signal.SIGTERM, before)
    assert len(got) == 2


def test_after_a_mesh_a_pipe_that_nobody_reads_is_an_error_and_no_sudden_end() -> None:
    def write() -> int:
        with gmsh_session():
            pass
        read, write_end = os.pipe()
        os.close(read)
        with pytest.raises(BrokenPipeError):
            os.write(write_end, b"1")
        return 0

    assert in_child(write) == 0


# --- a real scene, killed from outside ------------------------------------------------------------

SCRIPT = """
from fe_drivetrain.command_line import main_of_case
from fe_drivetrain.report.suite import Case

def work(run, page):
    from coarse_scenes import coarse_scene
    from fe_drivetrain.elasticity.mesh import write
    from fe_drivetrain.shafts.response import build_model, mesh_scene, unit_load_response
    with run.step("mesh"):
        mesh = mesh_scene(coarse_scene("bonded"))
    with run.step("solve"):
        unit_load_response(build_model(coarse_scene("bonded"), mesh))
    with run.step("write"):
        write(mesh, run.folder / "mesh.vtu")
    page.say("new")

if __name__ == "__main__":
    main_of_case(Case("a/b", "t", "s", work))
"""


@pytest.mark.parametrize(
    ("step", "sent", "status"),
    [
        ("mesh", signal.SIGKILL, -signal.SIGKILL),
        ("mesh", signal.SIGINT, 130),
        ("solve", signal.SIGTERM, 143),
        ("write", signal.SIGINT, 130),
    ],
)
def test_a_signal_while_it_meshes_solves_or_writes_leaves_the_old_results(
    tmp_path: Path, step: str, sent: signal.Signals, status: int
) -> None:
    (tmp_path / "script.py").write_text(SCRIPT)
    out = tmp_path / "out" / "b"
    run_case(marked(OLD), out)
    environment = {
        **os.environ,
        CACHE_VARIABLE: str(tmp_path / "cache"),
        "PYTHONPATH": os.pathsep.join([str(Path(__file__).parents[1]), *sys.path]),
    }
    with subprocess.Popen(
        [sys.executable, str(tmp_path / "script.py"), "--out", str(out)],
        env=environment,
        stderr=subprocess.PIPE,
        text=True,
    ) as process:
        assert process.stderr is not None
        said = ""
        while not said.endswith(f"{step} ...\n"):
            character = process.stderr.read(1)
            assert character, said
            said += character
        process.send_signal(sent)
        said += process.stderr.read()
        assert process.wait(60) == status
    assert "Traceback" not in said
    assert state(out) == OLD
    left = [p.name for p in out.parent.iterdir() if p.name != "b"]
    assert len(left) == (1 if sent == signal.SIGKILL else 0)
    cache = Cache(tmp_path / "cache")
    cache.keep("meshes", CONTENT, ARRAYS)
    assert hidden(tmp_path / "cache") == []
    run_case(marked(NEW), out)
    assert [p.name for p in out.parent.iterdir()] == ["b"]


@pytest.mark.parametrize(
    ("sent", "status"), [(signal.SIGTERM, TERMINATED), (signal.SIGINT, STOPPED)]
)
def test_a_stop_that_a_librarys_callback_drops_is_raised_again(
    capsys: pytest.CaptureFixture[str], sent: signal.Signals, status: int
) -> None:
    """As a signal while compiled code is loaded; and not in the midst of what it unwinds."""

    @ctypes.CFUNCTYPE(None)
    def callback() -> None:
        os.kill(os.getpid(), sent)
        time.sleep(0.01)

    cleaned: list[str] = []

    def work() -> int:
        callback()
        cleaned.append("dropped")
        try:
            time.sleep(10.0)
        finally:
            time.sleep(0.5)
            cleaned.append("wholly")
        return 0

    begin = time.perf_counter()
    try:
        ended = terminal.guarded(work)
    except SystemExit as end:
        ended = int(end.code or 0)
    assert ended == status
    assert time.perf_counter() - begin < 5.0
    assert cleaned == ["dropped", "wholly"]
    assert "ignored" not in capsys.readouterr().err
    assert signal.getitimer(signal.ITIMER_REAL) == (0.0, 0.0)


@pytest.mark.parametrize("cause", [KeyboardInterrupt, ValueError])
def test_ctrl_c_in_compiled_code_stops_as_any_other(
    cause: type[BaseException], capsys: pytest.CaptureFixture[str]
) -> None:
    """Python says so of a function in C that came back with an exception, and of nothing else."""

    def work() -> int:
        raise SystemError("returned a result with an exception set") from cause()

    if cause is not KeyboardInterrupt:
        with pytest.raises(SystemError):
            terminal.guarded(work)
        return
    assert terminal.guarded(work) == STOPPED
    assert capsys.readouterr().err.startswith("fe-drivetrain: stopped; ")
