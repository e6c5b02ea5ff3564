"""Studies on a cluster of Dask, one scheduler and two workers on this machine, one being killed."""

import gc
import json
import os
import signal
import sqlite3
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import cluster_jobs
import numpy as np
import pytest
import yaml
from cluster_jobs import WAIT
from coarse_scenes import coarse_scene
from small_drivetrain import two_mass_file
from test_commands_life import write_history
from test_docs_blocks import blocks
from test_docs_pages import DOCS
from test_drivetrain_transient import write_torque
from tiny_case import Result

from fe_drivetrain.common import jobs as jobs_module
from fe_drivetrain.common.array_records import as_arrays
from fe_drivetrain.common.cache import CACHE_VARIABLE
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.jobs import AT_ONCE, mapped, pool, scheduled_by
from fe_drivetrain.common.progress import silent
from fe_drivetrain.common.threads import CORES_VARIABLE
from fe_drivetrain.drivetrain_file.reading import scene_text
from fe_drivetrain.report.results import read_results
from fe_drivetrain.report.suite.case import Case
from fe_drivetrain.report.suite.suite import _run, run_cases
from fe_drivetrain.shafts.fidelity.designs import compare_designs
from fe_drivetrain.shafts.fidelity.quantity import Quantity
from fe_drivetrain.shafts.uncertainty.input_study import study
from fe_drivetrain.shafts.uncertainty.sampling import sample
from fe_drivetrain.studies import transient_digest
from fe_drivetrain.studies.load_digest import LoadOptions
from fe_drivetrain.studies.load_reactions import FileDigest
from fe_drivetrain.turbine_loads.histories.farm import Counting, counted_histories, piece

pytestmark = pytest.mark.needs("distributed")

OPTIONS = LoadOptions(slopes=(4.0,))


def in_bytes(found: FileDigest) -> dict[str, bytes]:
    return {name: array.tobytes() for name, array in as_arrays(found).items()}


def _python(*words: str) -> subprocess.Popen[bytes]:
    folders = [str(Path(__file__).parents[1]), *(folder for folder in sys.path if folder)]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(folders)}
    return subprocess.Popen(
        [sys.executable, "-P", "-m", *words],
        env=environment,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )


class Cluster:
    """A scheduler and its workers, each a process."""

    def __init__(self, folder: Path) -> None:
        self._file, self._folder = folder / "scheduler.json", folder
        address = ("--host", "127.0.0.1", "--port", "0", "--no-dashboard")
        file = ("--scheduler-file", str(self._file))
        self._processes = [_python("distributed.cli.dask_scheduler", *address, *file)]
        self.add_worker()
        self.add_worker()
        until(self._file.exists)
        self.address = str(json.loads(self._file.read_text())["address"])

    def add_worker(self) -> None:
        until(self._file.exists)
        one = ("--no-nanny", "--nthreads", "1", "--no-dashboard", "--host", "127.0.0.1")
        file = ("--scheduler-file", str(self._file), "--local-directory", str(self._folder))
        self._processes.append(_python("distributed.cli.dask_worker", *one, *file))

    @property
    def pids(self) -> set[int]:
        return {process.pid for process in self._processes[1:]}

    def end(self) -> None:
        for process in self._processes:
            process.kill()
            process.wait()


def until(condition: Callable[[], bool]) -> None:
    end = time.monotonic() + WAIT
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.02)


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Cluster]:
    found = Cluster(tmp_path_factory.mktemp("cluster"))
    yield found
    found.end()


@pytest.fixture(autouse=True)
def one_core(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """As a process that uses a cluster sets it, to be set back here."""
    monkeypatch.setenv(CORES_VARIABLE, "1")
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path / "cache"))


@pytest.fixture
def killed(tmp_path: Path) -> Iterator[Path]:
    """The process that writes its number into this file is killed."""
    mark = tmp_path / "mark"

    def kill() -> None:
        until(lambda: mark.exists() and bool(mark.read_text()))
        os.kill(int(mark.read_text()), signal.SIGKILL)

    thread = threading.Thread(target=kill, daemon=True)
    thread.start()
    yield mark
    thread.join(WAIT)
    assert not thread.is_alive()


@pytest.fixture
def histories(tmp_path: Path) -> list[Path]:
    folder = tmp_path / "own"
    folder.mkdir()
    files = [folder / f"{number}.csv" for number in range(12)]
    for number, file in enumerate(files):
        write_history(file, (8.0, 14.0)[number % 2])
        # contents differ: kept digests are known by them
        file.write_text(f"# run = {number}\n{file.read_text('utf-8')}", "utf-8")
    return files


def test_a_stopped_study_goes_on_where_it_was(
    cluster: Cluster, histories: list[Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """At most so many files are handed in as may be at once, and those that are done stay done."""
    monkeypatch.setattr(jobs_module, "AT_ONCE", 4)
    items = [(file, OPTIONS, tmp_path, False) for file in histories]
    with scheduled_by(cluster.address):
        stopped = mapped(cluster_jobs.digest_with_death, items, 1)
        first = [next(stopped) for _ in range(3)]
        stopped.close()
        assert len((tmp_path / "log").read_text().split()) <= 3 + 4
        done = len(list((tmp_path / "cache" / "load-digests").glob("*.arrays")))
        assert done >= 3
        again = list(mapped(cluster_jobs.digest_with_death, items, 1))
    for one, other in zip(first, again, strict=False):
        assert in_bytes(one) == in_bytes(other)
    assert len(again) == len(histories)


def test_uncertain_values_have_the_same_bands_to_the_last_digit(
    cluster: Cluster, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    keys = ("gearbox.stiffness.2", "shaft.front")
    scene = coarse_scene("bonded", uncertainty={key: {"uniform": 0.01} for key in keys})
    here = study(scene, level=1, count=40)
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path / "other"))
    with scheduled_by(cluster.address):
        there = study(scene, level=1, count=40)
    assert here.slopes == there.slopes
    assert np.ptp(here.samples["hub.stiffness.uz"].values) > 0.0
    assert here.samples.keys() == there.samples.keys()
    for name, samples in here.samples.items():
        assert samples.values.tobytes() == there.samples[name].values.tobytes()


def test_designs_have_the_same_differences_to_the_last_digit(
    cluster: Cluster, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    designs = {
        f"{front:g}": coarse_scene("bonded", **{"shaft.front": front}) for front in (-1.2, -1.0)
    }
    asked = [Quantity("hub.stiffness.uz"), Quantity("main_bearing.Fz")]
    here = compare_designs(designs, asked, tolerance=0.9)
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path / "other"))
    with scheduled_by(cluster.address):
        there = compare_designs(designs, asked, tolerance=0.9)
    for one, other in zip(here, there, strict=True):
        assert one.quantity.name == other.quantity.name
        assert one.changes.tobytes() == other.changes.tobytes()
        assert one.bands.tobytes() == other.bands.tobytes()


def test_the_commands_write_the_same_tables(
    cluster: Cluster, invoke: Callable[..., Result], histories: list[Path], tmp_path: Path
) -> None:
    # named from here: workers started elsewhere
    files = [str(file.relative_to(tmp_path)) for file in histories[:2]]
    loads = ("loads", *files)
    life = ("life", "main_bearing_bonded", "--bearing", "main_bearing=bearing_s_o20")
    life += ("--loads", files[0], "--loads", files[1])
    for name, words in (("loads", loads), ("life", life)):
        for where in ((), ("--scheduler", cluster.address)):
            out = tmp_path / name / ("there" if where else "here")
            status, printed, error = invoke(*words, "--out", str(out), *where)
            assert status == 0, printed + error
        tables = sorted(file.name for file in (tmp_path / name / "here").glob("*.csv"))
        assert len(tables) >= 4
        for table in tables:
            one, other = (tmp_path / name / where / table for where in ("here", "there"))
            assert one.read_bytes() == other.read_bytes(), table


def test_mistakes_come_back_in_their_own_words(cluster: Cluster) -> None:
    with scheduled_by(cluster.address):
        with pytest.raises(InputError, match="length is -1"), pool(1) as workers:
            workers.start(cluster_jobs.mistake)
        with pool(1, each_for_itself=True) as workers:
            job = workers.start(cluster_jobs.mistake)
        with pytest.raises(InputError, match="length is -1"):
            job.result()
        with pytest.raises(InputError, match="does not find nowhere: start"), pool(1) as workers:
            workers.start(cluster_jobs.read, Path("nowhere"))


def test_a_scheduler_that_is_not_there_is_a_mistake(monkeypatch: pytest.MonkeyPatch) -> None:
    from distributed import Client

    from fe_drivetrain.common import cluster as cluster_module

    monkeypatch.setattr(cluster_module, "_CONNECT", 0.2)
    monkeypatch.setenv(CORES_VARIABLE, "3")
    for address in ("tcp://127.0.0.1:1", "nowhere"):
        with pytest.raises(InputError, match="dask scheduler"), scheduled_by(address):
            pass
        assert os.environ[CORES_VARIABLE] == "3"
        # the collector would close it, maybe in the middle of the next one's start
        clients = [one for one in gc.get_objects() if isinstance(one, Client)]
        assert {client.status for client in clients} <= {"closed"}


def test_cases_run_on_workers_but_those_that_measure(cluster: Cluster, tmp_path: Path) -> None:
    cases = [
        Case("group/one", "T", "s", cluster_jobs.pid),
        Case("group/other", "T", "s", cluster_jobs.pid),
        Case("group/measures", "T", "s", cluster_jobs.pid, alone=True),
    ]
    out = tmp_path / "reports"
    with scheduled_by(cluster.address):
        assert run_cases(cases, out) == {}
    pids = [read_results(out / case.name / "results.json").figures["pid"] for case in cases]
    assert set(pids[:2]) <= cluster.pids
    assert pids[2] not in cluster.pids


def test_a_case_of_a_worker_that_died_half_way_begins_in_an_empty_folder(tmp_path: Path) -> None:
    (tmp_path / "sub").mkdir()
    for left in ("half.txt", "sub/half.txt"):
        (tmp_path / left).write_text("half")
    case = Case("group/one", "T", "s", cluster_jobs.pid)
    assert _run(silent, case, tmp_path, {}, True, tmp_path) is None
    assert "sub" not in {entry.name for entry in tmp_path.iterdir()}
    assert not (tmp_path / "half.txt").exists()
    problem = _run(silent, case, tmp_path / "elsewhere", {}, True, tmp_path)
    assert problem is not None
    assert "all workers share" in problem.message


def test_no_file_is_lost_or_counted_twice_when_a_worker_is_killed(
    cluster: Cluster, killed: Path, histories: list[Path], tmp_path: Path
) -> None:
    steps: list[tuple[str, int]] = []
    items = [(file, OPTIONS, tmp_path, file.stem == "5") for file in histories]
    with scheduled_by(cluster.address):
        shown = lambda step, lane=0: steps.append((step, lane))  # noqa: E731
        found = list(mapped(cluster_jobs.digest_with_death, items, 1, shown))
    log = (tmp_path / "log").read_text().split()
    assert set(log) == {file.stem for file in histories}
    assert log.count("5") == 2
    assert {lane for step, lane in steps if step} == {1, 2}
    kept = list((tmp_path / "cache" / "load-digests").glob("*.arrays"))
    assert len(kept) == len(histories)
    for path in kept:
        path.unlink()
    here = list(mapped(cluster_jobs.digest_with_death, items, 1))
    assert len(found) == len(here) == len(histories)
    for one, other in zip(found, here, strict=True):
        assert in_bytes(one) == in_bytes(other)


def test_a_farm_is_counted_the_same_when_a_worker_is_killed(
    cluster: Cluster, killed: Path, tmp_path: Path
) -> None:
    """In runs of one piece and of two, of which a worker that counts one dies."""
    cluster.add_worker()
    counting = Counting(-3)
    names = ("a", "b")

    def pieces() -> Iterator[tuple[str, tuple[Path, int]]]:
        return ((name, (tmp_path, k)) for name in names for k in range(AT_ONCE))

    with scheduled_by(cluster.address):
        found = dict(counted_histories(cluster_jobs.samples_with_death, pieces(), counting))
    assert (tmp_path / "mark").exists()
    here = dict(counted_histories(cluster_jobs.samples_with_death, pieces(), counting))
    whole = piece(
        np.concatenate([cluster_jobs.samples_with_death(tmp_path, k) for k in range(AT_ONCE)]),
        counting,
    ).whole()
    for name in names:
        for other in (here[name], whole):
            assert found[name].samples == other.samples
            assert found[name].damage == other.damage
            assert found[name].cycles.amount.tobytes() == other.cycles.amount.tobytes()
            assert found[name].levels.amount.tobytes() == other.levels.amount.tobytes()


def test_samples_are_the_same_when_a_worker_is_killed(
    cluster: Cluster, killed: Path, tmp_path: Path
) -> None:
    """In chunks of eight, in the middle of one of which a worker dies: none is lost or doubled."""
    cluster.add_worker()
    key = "shaft.sections.0.outer_diameter"
    scene = coarse_scene("bonded", uncertainty={key: {"uniform": 0.01}})
    widest = scene.shaft.pieces[0].outer_diameter
    evaluate = partial(cluster_jobs.shaft_with_death, tmp_path, widest)
    steps: list[str] = []
    with scheduled_by(cluster.address):
        found = sample(scene, evaluate, 40, report=steps.append)
    assert killed.exists()
    assert steps == [f"samples ({number} of 40)" for number in range(1, 41)]
    log = (tmp_path / "log").read_text().split()
    deadly = next(line for line in log if float.fromhex(line) > widest)
    # begun by the worker that died and by another; the nominal scene stands once beside the samples
    assert log.count(deadly) == 2
    assert len(set(log)) == 41
    here = sample(scene, evaluate, 40)
    assert found.keys() == here.keys()
    for name, samples in here.items():
        assert np.ptp(samples.values) > 0.0
        assert samples.values.tobytes() == found[name].values.tobytes()
        assert samples.inputs.tobytes() == found[name].inputs.tobytes()


@pytest.mark.usefixtures("killed")
def test_a_drivetrain_in_time_is_the_same_when_a_worker_is_killed_and_goes_on_where_it_was(
    cluster: Cluster, invoke: Callable[..., Result], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    cluster.add_worker()
    (tmp_path / "mine.yaml").write_text(yaml.safe_dump(two_mass_file()))
    for number in range(6):
        write_torque(tmp_path / f"{number}.csv", 1e5 + 1e4 * number, 4.0)
    words = ("transient", "mine.yaml", "operation", "--loads", "?.csv", "--step", "0.05")
    jobs = partial(cluster_jobs.driven_with_death, tmp_path)
    monkeypatch.setattr(transient_digest, "kept_digest", jobs)
    kept = tmp_path / "cache" / "load-digests"
    tables, inodes = {}, {}
    for where in ("there", "again", "here"):
        more = () if where == "here" else ("--scheduler", cluster.address)
        if where == "again":  # the command was ended when it had some of them
            for path in sorted(kept.glob("*.arrays"))[:2]:
                path.unlink()
            inodes = {path: path.stat().st_ino for path in kept.glob("*.arrays")}
            more += ("--resume",)
        status, printed, error = invoke(*words, *more, "--out", where)
        assert status == 0, printed + error
        tables[where] = read_results(tmp_path / where / "results.json").figures
        if where == "again":
            assert len(inodes) == 3
            assert all(path.stat().st_ino == inode for path, inode in inodes.items())
            assert len(list(kept.glob("*.arrays"))) == 5
    log = [line.split() for line in (tmp_path / "log").read_text().splitlines()]
    assert [stem for stem, _ in log].count("3") == 4
    assert {stem for stem, _ in log} == {"1", "2", "3", "4", "5"}  # the first is the command's own
    assert {int(pid) for _, pid in log[:6]} <= cluster.pids
    for name in ("extremes", "files", "equivalent_loads", "duration_spectra"):
        assert tables["here"][name] == tables["there"][name] == tables["again"][name], name


def test_cases_are_the_same_when_a_worker_is_killed(
    cluster: Cluster, killed: Path, tmp_path: Path
) -> None:
    """One of two cases begins again, in an empty folder; each counts once."""
    cluster.add_worker()
    cases = [
        Case("group/one", "T", "s", cluster_jobs.case_with_death, settings=("mark",)),
        Case("group/other", "T", "s", cluster_jobs.numbers),
    ]
    there, here = tmp_path / "there", tmp_path / "here"
    with scheduled_by(cluster.address):
        assert run_cases(cases, there, {"mark": str(killed)}) == {}
    assert killed.exists()
    assert (tmp_path / "log").read_text().split() == ["begun"] * 2
    assert run_cases(cases, here, {"mark": str(killed)}) == {}
    for case in cases:
        one, other = (
            read_results(out / case.name / "results.json").figures["values"]
            for out in (there, here)
        )
        assert one == other
    with sqlite3.connect(there / "history.sqlite") as history:
        assert history.execute("select count(*) from runs").fetchone() == (2,)


def test_a_study_has_the_same_results_to_the_last_digit(
    cluster: Cluster,
    invoke: Callable[..., Result],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    keys = ("gearbox.stiffness.2", "shaft.front")
    scene = coarse_scene("bonded", uncertainty={key: {"uniform": 0.01} for key in keys})
    file = tmp_path / "own.yaml"
    file.write_text(scene_text(scene))
    found = []
    for where in ((), ("--scheduler", cluster.address)):
        monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path / f"cache{len(where)}"))
        out = tmp_path / f"out{len(where)}"
        status, printed, error = invoke("study", str(file), "--quick", "--out", str(out), *where)
        assert status == 0, printed + error
        found.append(read_results(out / "results.json"))
    assert found[0].figures == found[1].figures
    assert len(found[0].figures) > 2


@pytest.mark.needs("submitit")
def test_workers_that_submitit_starts_do_the_jobs(tmp_path: Path) -> None:
    """The block of the page, on this machine in place of Slurm: four workers of two jobs."""
    from distributed import Client

    (block,) = (b for b in blocks(DOCS / "clusters.md", "python") if "import submitit" in b)
    (tmp_path / "workers.py").write_text(block)
    file = tmp_path / "scheduler.json"
    address = ("--host", "127.0.0.1", "--port", "0", "--no-dashboard")
    scheduler = _python("distributed.cli.dask_scheduler", *address, "--scheduler-file", str(file))
    pids: list[int] = []
    try:
        until(file.exists)
        folders = [str(Path(__file__).parents[1]), *(folder for folder in sys.path if folder)]
        # into files: workers hold what they inherit, and go on when this has ended
        with (tmp_path / "pids").open("w") as pids_file, (tmp_path / "errors").open("w") as errors:
            found = subprocess.run(
                [sys.executable, "workers.py", "local"],
                cwd=tmp_path,
                env={
                    **os.environ,
                    "PATH": os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]]),
                    "PYTHONPATH": os.pathsep.join(folders),
                },
                stdout=pids_file,
                stderr=errors,
                timeout=WAIT,
            )
        pids = [int(word) for word in (tmp_path / "pids").read_text().split()]
        assert found.returncode == 0, (tmp_path / "errors").read_text()
        assert len(pids) == 2
        items = [(k,) for k in range(8)]
        with Client(scheduler_file=str(file)) as client:
            client.wait_for_workers(4, timeout=WAIT)
            with scheduled_by(client.scheduler.address):
                there = list(mapped(cluster_jobs.seeded, items, 1))
            client.shutdown()
        here = list(mapped(cluster_jobs.seeded, items, 1))
        assert [one.tobytes() for one in there] == [one.tobytes() for one in here]
        until(lambda: not any(is_running(pid) for pid in pids))
    finally:
        for pid in pids:
            if is_running(pid):
                os.kill(pid, signal.SIGTERM)
        scheduler.kill()
        scheduler.wait()


def is_running(pid: int) -> bool:
    """Whether there is such a process, other than one that has ended."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z"
    except OSError:
        return False


def test_the_end_of_the_scheduler_is_said_at_once(cluster: Cluster, tmp_path: Path) -> None:
    """The last test: nothing is left of the cluster."""

    def end() -> None:
        until((tmp_path / "begun").exists)
        cluster.end()

    thread = threading.Thread(target=end, daemon=True)
    thread.start()
    with pytest.raises(InputError, match="has ended"), scheduled_by(cluster.address):
        list(mapped(cluster_jobs.wait, [(tmp_path / "begun",)], 1))
    thread.join(WAIT)
