"""What Linux has and Windows or macOS do not: each is guarded, and something holds without it."""

import ast
import os
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from fe_drivetrain.cases.performance.peers import launching
from fe_drivetrain.cases.stability.faults import experiment
from fe_drivetrain.common import files, folders, memory, processes, threads
from fe_drivetrain.common.errors import MissingToolError
from fe_drivetrain.common.memory import peak_memory
from fe_drivetrain.elasticity.solve.cost_model import available_memory

ROOT = Path(__file__).parents[2]
POSIX = {"fcntl", "grp", "pty", "pwd", "resource", "termios", "tty"}
#: Runs in processes of its own, started only where there are forks.
APART = {"cases/stability/fault_moments.py"}
NOT_HERE = SimpleNamespace(name="nt", environ=os.environ)


def test_no_module_needs_what_windows_does_not_have() -> None:
    found = set()
    for folder in ("fe_drivetrain", "geometry", "cases"):
        for path in (ROOT / folder).rglob("*.py"):
            for node in ast.parse(path.read_text("utf-8")).body:  # not what is inside of an if
                names = {alias.name for alias in node.names} if isinstance(node, ast.Import) else ()
                module = {node.module} if isinstance(node, ast.ImportFrom) else set()
                if POSIX & {*names, *module}:
                    found.add(path.relative_to(ROOT).as_posix())
    assert found == APART


def test_memory_is_known_where_the_system_says(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    own = peak_memory()
    assert own is not None
    assert 10e6 < own < 1e12
    monkeypatch.setattr(memory, "STATUS", tmp_path / "none")
    if "linux" in sys.platform:
        other = peak_memory()
        assert other is not None
        assert other > 0.5 * own
    monkeypatch.setitem(sys.modules, "resource", None)
    assert peak_memory() is None


def test_cores_are_counted_without_affinity(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(threads.CORES_VARIABLE)
    monkeypatch.delattr(os, "sched_getaffinity", raising=False)
    monkeypatch.setattr(os, "cpu_count", lambda: 7)
    assert threads.cores() == 7


def test_free_memory_is_unbounded_where_the_system_does_not_say(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.delattr(os, "sysconf", raising=False)
    assert available_memory() == float("inf")


def here(report: object, value: int) -> tuple[int, int]:
    return os.getpid(), value


def test_jobs_are_done_in_this_process_where_none_can_start(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv(threads.CORES_VARIABLE, "2")
    monkeypatch.setattr(processes, "os", NOT_HERE)
    with processes.Processes(2, always=True) as several:
        assert several.count == 0
        jobs = [several.start(here, k) for k in range(2)]
        assert [job.result() for job in several.finished(jobs)] == [
            (os.getpid(), 0),
            (os.getpid(), 1),
        ]


def test_files_and_folders_appear_whole_without_locks_and_exchange(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setattr(files, "fcntl", None)
    monkeypatch.setattr(folders, "sys", SimpleNamespace(platform="win32"))
    with files.atomic_path(tmp_path / "file") as unfinished:
        unfinished.write_text("new")
    assert (tmp_path / "file").read_text() == "new"
    for content in ("first", "second"):
        folder = folders.HiddenFolder(tmp_path / "out")
        (folder.path / "a").write_text(content)
        folder.put_in_place()
        folder.discard()
        assert (tmp_path / "out/a").read_text() == content
    assert sorted(os.listdir(tmp_path)) == ["file", "out"]
    beside = folders.HiddenFolder(tmp_path / "out")  # which another may be writing still
    folders.HiddenFolder(tmp_path / "out").discard()
    assert beside.path.exists()


def test_what_needs_linux_is_missing_elsewhere(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(launching, "os", NOT_HERE)
    variant = launching.Variant("scikit_fem", "k")
    none = Path("none.npz")
    found = launching.launch(variant, none, none, launching.Limits(1.0, 1.0, 1), sys.executable)
    assert found.status == "missing"
    monkeypatch.delattr(os, "fork")
    with pytest.raises(MissingToolError, match="fork"):
        experiment(1)
