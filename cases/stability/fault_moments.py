"""A small case that is killed, starved and run twice at once; a program of its own.

It is a process of its own, so that it may fork: the faults happen to its children.
"""

import gc
import json
import os
import resource
import shutil
import signal
import sys
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import ParseError

import gmsh
import meshio
import numpy as np
import rich.progress  # noqa: F401 - once here, not in each of the forked children

from fe_drivetrain.command_line import main_of_case
from fe_drivetrain.common import CACHE_VARIABLE, MANIFEST, Cache, rigid_motions, until_stopped
from fe_drivetrain.drivetrain_file import MATERIALS
from fe_drivetrain.elasticity.interfaces import dofs
from fe_drivetrain.elasticity.mesh import cached_mesh, mesh_content, write
from fe_drivetrain.elasticity.operator.kernels import invert
from fe_drivetrain.elasticity.solve import solve_solid
from fe_drivetrain.geometry import NO_BANDS, MeshSizes, Shaft
from fe_drivetrain.geometry import Section as ShaftSection
from fe_drivetrain.report import Results, read_results
from fe_drivetrain.report.environment import environment
from fe_drivetrain.report.page import render
from fe_drivetrain.report.suite import Case, Page, Run, run_case, run_cases, run_into

OLD, NEW, BROKEN = "old", "new", "broken"
FILES = ("report.html", "results.json", "shaft.vtu")
HISTORY = "history.sqlite"  # written when the results are in place
SHAFT = Shaft(front=0.0, sections=(ShaftSection(length=0.6, outer_diameter=0.4),))
SIZES = MeshSizes(shaft=0.4, elements_per_turn=6)


def small(run: Run, page: Page) -> None:
    """Torsional stiffness of a short shaft: mesh, solve, write. Its answer is the run's mark."""
    with run.step("mesh"):
        mesh = cached_mesh(SHAFT, [], {}, SIZES, frozenset())
    with run.step("solve"):
        steel = MATERIALS["steel"]
        ends = [mesh.face_nodes(f"shaft.{end}") for end in ("front", "rear")]
        turned = rigid_motions(mesh.points)[:, 3].reshape(-1, 3)
        turned[ends[0]] = 0.0
        held = np.concatenate([dofs(nodes).ravel() for nodes in ends])
        loads = np.zeros(mesh.points.size)
        prescribed = (held, turned.ravel()[held])
        found = solve_solid(mesh.points, mesh.cells, steel.lame, [], loads, prescribed, "superlu")
        stiffness = 2.0 * float(found.energy[0])
    with run.step("write"):
        mark = str(run.settings["mark"])
        write(mesh, run.folder / "shaft.vtu", {mark: found.u.reshape(-1, 3)})
    page.say(mark)
    page.answer("Which run wrote this?", "It has 1 mark.", [])
    page.data("stiffness", stiffness)


MESH_CONTENT = mesh_content(SHAFT, [], {}, SIZES, frozenset(), NO_BANDS)
CASE_KILLED = Case("faults/small", "Small case", "Saint-Venant", small, settings=("mark",))


@dataclass(frozen=True)
class Killed:
    """What a kill left.

    Attributes
    ----------
    moment : float
        Of the kill [s] after the start.
    step : str
        During which step of the run.
    found : str
        Whose results are there: `OLD`, `NEW`, or `BROKEN`.
    hidden : int
        Unfinished files and folders beside the results.
    """

    moment: float
    step: str
    found: str
    hidden: int


@dataclass(frozen=True)
class Fault:
    """Another fault: what it is, the program's message and exit status, and what was left."""

    fault: str
    message: str
    status: int
    found: str
    hidden: int


@dataclass(frozen=True)
class Found:
    """The whole experiment.

    Attributes
    ----------
    seconds : float
        One run without faults [s].
    stiffness : float
        Its result [N m/rad].
    killed, killed_in_place : list of Killed
        As the program writes, and writing straight into the result folder.
    left : int
        Hidden files and folders after one more run.
    faults : list of Fault
        The others.
    damaged : tuple of int
        Damages of the cache tried, and for how many of them the stiffness was another.
    """

    seconds: float
    stiffness: float
    killed: list[Killed]
    killed_in_place: list[Killed]
    left: int
    faults: list[Fault]
    damaged: tuple[int, int]


def state(out: Path) -> str:
    """Whose results stand in a folder, every file of it read."""
    try:
        (mark,) = read_results(out / "results.json").details
        names = sorted(p.name for p in out.iterdir() if not p.name.startswith(HISTORY))
        whole = names == sorted([*FILES, MANIFEST])
        whole = whole and mark in (out / "report.html").read_text("utf-8")
        whole = whole and meshio.read(out / "shaft.vtu").point_data.keys() == {mark}
    except (OSError, ValueError, ParseError, meshio.ReadError):
        return BROKEN
    return mark if whole else BROKEN


def hidden(*folders: Path) -> int:
    """Unfinished files and folders."""
    return sum(1 for folder in folders for _ in folder.glob("**/.*"))


def child(work: Callable[[], int]) -> tuple[int, int]:
    """Start it in a child process: its number, and a pipe from its error output."""
    read, write_end = os.pipe()
    pid = os.fork()
    if pid == 0:
        status = 99
        try:
            os.dup2(write_end, 2)
            os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
            status = work()
        finally:
            os._exit(status)
    os.close(write_end)
    return pid, read


def ended(pid: int, read: int) -> tuple[int, str]:
    """Wait for a child: its status, and what it wrote."""
    written = b""
    while part := os.read(read, 65536):
        written += part
    os.close(read)
    return os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1]), written.decode(errors="replace")


def run_new(out: Path) -> int:
    """Run the case as a user's script does; its exit status."""
    sys.argv = ["small.py", "--out", str(out), "--set", f"mark={NEW}"]
    try:
        main_of_case(CASE_KILLED)
    except SystemExit as end:
        return int(end.code or 0)
    raise AssertionError("a script ends with its exit status")


def run_in_place(out: Path) -> int:
    """Run a case as a program without protection would: empty the folder and write into it."""
    shutil.rmtree(out)
    out.mkdir()
    run_into(CASE_KILLED, out, {"mark": NEW}, False, _say)
    return 0


def _say(step: str, lane: int = 0) -> None:
    """Write a step as it begins, as the command line does."""
    sys.stderr.write(f"{step} ...\n")
    sys.stderr.flush()


@dataclass(frozen=True)
class Bench:
    """Folders of the experiment.

    Attributes
    ----------
    folder : Path
        Where it is.
    caches, kept, out : Path
        Meshes that are kept, the old results, and the results that are at risk.
    """

    folder: Path

    @property
    def caches(self) -> Path:
        return self.folder / "cache"

    @property
    def kept(self) -> Path:
        return self.folder / "kept"

    @property
    def out(self) -> Path:
        return self.folder / "reports" / "small"

    def reset(self) -> None:
        """Put the old results back, and empty the cache of meshes."""
        for path in self.out.parent.glob("*"):
            shutil.rmtree(path)
        shutil.copytree(self.kept, self.out)
        shutil.rmtree(self.caches, ignore_errors=True)

    def hidden(self) -> int:
        """Unfinished files and folders beside results and meshes."""
        return hidden(self.out.parent, self.caches)

    def kill(self, work: Callable[[Path], int], at: float) -> tuple[Killed, bool]:
        """Kill a run `at` seconds after its start; return what it leaves, and if it was over."""
        self.reset()
        start = time.perf_counter()
        pid, read = child(lambda: work(self.out))
        time.sleep(at)
        moment = time.perf_counter() - start
        os.kill(pid, signal.SIGKILL)
        status, written = ended(pid, read)
        steps = [line.split(" ...")[0] for line in written.splitlines() if " ..." in line]
        during = "over" if status == 0 else steps[-1] if steps else "start"
        return Killed(moment, during, state(self.out), self.hidden()), status == 0

    def sweep(self, work: Callable[[Path], int], seconds: float, moments: int) -> list[Killed]:
        """Kill later and later, until a run ends before; in half steps again if that was soon."""
        found: list[Killed] = []
        step = seconds / moments
        at = 0.5 * step
        while len(found) < 4 * moments:
            killed, over = self.kill(work, at)
            found.append(killed)
            at += step
            if over:
                if len(found) > moments:
                    break
                step /= 2
                at = 0.5 * step
        return found

    def suffer(self, name: str, work: Callable[[], int], at: Path | None = None) -> Fault:
        """Run with a fault; return its message, its exit status and what it leaves in a folder."""
        self.reset()
        status, written = ended(*child(work))
        (line,) = written.strip().splitlines()[-1:] or [""]
        return Fault(name, line, status, state(at or self.out), self.hidden())


def experiment(folder: Path, moments: int) -> Found:
    """Make every fault happen in a folder of its own."""
    bench = Bench(folder)
    caches, out, kept = bench.caches, bench.out, bench.kept
    os.environ[CACHE_VARIABLE] = str(caches)
    pid, read = child(lambda: int(run_case(CASE_KILLED, kept, {"mark": OLD}) is None))
    status, said = ended(pid, read)
    if status != 0:
        raise RuntimeError(f"the case that is to be killed ended with status {status}: {said}")
    stiffness = float(read_results(kept / "results.json").figures["stiffness"])
    out.parent.mkdir()
    bench.reset()
    start = time.perf_counter()
    ended(*child(lambda: run_new(out)))
    seconds = time.perf_counter() - start
    in_place = bench.sweep(run_in_place, seconds, moments // 2)
    killed = bench.sweep(run_new, seconds, moments)
    ended(*child(lambda: run_new(out)))
    # keeping anything in the cache tidies it
    Cache(caches).keep("meshes", {}, {"a": np.zeros(1)})
    left = bench.hidden()
    faults = other_faults(bench)
    damaged = _damaged(caches, out, stiffness)
    return Found(seconds, stiffness, killed, in_place, left, faults, damaged)


def other_faults(bench: Bench) -> list[Fault]:
    """Signals, a full disk, a cache in the way, two runs at once, a mesher that fails."""
    out = bench.out
    faults = [
        bench.suffer(f"{sent.name} while it solves", partial(_signalled, sent, out))
        for sent in (signal.SIGINT, signal.SIGTERM)
    ]
    faults.append(bench.suffer("disk full from 5 kB a file on", lambda: _starved(5000, out)))
    blocked = bench.folder / "file"
    blocked.write_text("in the way")
    work = partial(_without_cache, blocked, out)
    faults.append(bench.suffer("cache that cannot be written", work))
    return [*faults, two_runs(bench), one_of_three(bench)]


def two_runs(bench: Bench) -> Fault:
    """Two runs into one folder at once."""
    bench.reset()
    pids = [child(lambda: run_new(bench.out)) for _ in range(2)]
    both = [ended(*p) for p in pids]
    said, status = both[0][1].strip().splitlines()[-1], max(status for status, _ in both)
    return Fault(
        "two runs into one folder", said, status, state(bench.out), hidden(bench.out.parent)
    )


def one_of_three(bench: Bench) -> Fault:
    """Let the mesher fail in one case of three: old results stay there, the others finish."""
    many = bench.folder / "many"
    failing = many / "faults" / "fails"
    shutil.copytree(bench.kept, failing)
    fault = bench.suffer("gmsh fails in one case of three", lambda: _one_of_three(many), failing)
    others = [state(many / "faults" / name) for name in ("first", "last")]
    return fault if others == [NEW, NEW] else replace(fault, found=BROKEN)


def _signalled(sent: signal.Signals, out: Path) -> int:
    # a shell, or a worker process, that ignores Ctrl-C hands that on to its children
    signal.signal(signal.SIGINT, signal.default_int_handler)

    def stop(*arguments: Any, **more: Any) -> Any:
        os.kill(os.getpid(), sent)
        time.sleep(10)

    globals()["solve_solid"] = stop
    return run_new(out)


def _starved(size: int, out: Path) -> int:
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, resource.RLIM_INFINITY))
    return run_new(out)


def _without_cache(file: Path, out: Path) -> int:
    os.environ[CACHE_VARIABLE] = str(file)
    return run_new(out)


def _one_of_three(out: Path) -> int:
    def failing(run: Run, page: Page) -> None:
        def refuse(dimension: int) -> None:
            raise Exception("PLC Error: A segment and a facet intersect at point")

        shutil.rmtree(os.environ[CACHE_VARIABLE], ignore_errors=True)
        generate, gmsh.model.mesh.generate = gmsh.model.mesh.generate, refuse
        try:
            small(run, page)
        finally:
            gmsh.model.mesh.generate = generate

    names = {"first": small, "fails": failing, "last": small}
    takes = ("mark",)
    cases = [Case(f"faults/{n}", "t", "s", work, settings=takes) for n, work in names.items()]
    problems = run_cases(cases, out, {"mark": NEW})
    sys.stderr.write("".join(f"{name}: {p.message}\n" for name, p in problems.items()))
    return 2 if problems else 0


def _damaged(caches: Path, out: Path, stiffness: float) -> tuple[int, int]:
    """Damages of a kept mesh, and how many of them changed the mesh."""
    shutil.rmtree(caches, ignore_errors=True)
    ended(*child(lambda: run_new(out)))
    (file,) = caches.rglob("*.arrays")
    content = file.read_bytes()
    cache = Cache(caches)
    sound = cache.load("meshes", MESH_CONTENT)
    assert sound is not None
    rng = np.random.default_rng(0)
    wrong = count = 0
    for place in rng.integers(0, len(content), 60).tolist():
        for damage in ("flip", "cut", "zero"):
            changed = bytearray(content)
            if damage == "flip":
                changed[place] ^= 1 << int(rng.integers(0, 8))
            elif damage == "cut":
                del changed[place:]
            else:
                changed[place : place + 256] = bytes(len(changed[place : place + 256]))
            file.write_bytes(changed)
            loaded = cache.load("meshes", MESH_CONTENT)
            count += 1
            wrong += loaded is not None and not _same(loaded, sound)
    file.write_bytes(content[: len(content) // 2])
    ended(*child(lambda: run_new(out)))
    again = float(read_results(out / "results.json").figures["stiffness"])
    return count + 1, wrong + (again != stiffness)


def _same(found: dict[str, Any], kept: dict[str, Any]) -> bool:
    return list(found) == list(kept) and all(
        found[name].tobytes() == array.tobytes() for name, array in kept.items()
    )


def main() -> None:
    """The experiment, in the folder and with the number of moments of the command line, as JSON."""
    # what a run loads first, once for all children: a compiled kernel (one that starts no threads,
    # for these do not survive a fork), what the program is, and the template of the page
    invert(np.eye(3)[None], np.empty((1, 3, 3)))
    empty = Results(
        case="faults/small",
        title="Small case",
        source="Saint-Venant",
        details=[OLD],
        verdicts=[],
        sections=[],
        environment=environment({}),
    )
    folder = Path(sys.argv[1])
    render(empty, folder, folder)
    gc.freeze()  # or the collector of each child would copy all that is shared
    found = experiment(folder, int(sys.argv[2]))
    print(json.dumps(asdict(found)))


if __name__ == "__main__":
    sys.exit(until_stopped(main))
