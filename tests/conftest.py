"""What several test modules use: coarse scenes, built once a session, and commands in a folder."""

from __future__ import annotations

import gc
import os
import shutil
import signal
import sys
from collections.abc import Callable, Generator, Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import filelock
import hypothesis
import pytest
from xdist.scheduler import LoadScopeScheduling

from fe_drivetrain.common import cache, threads
from fe_drivetrain.common.errors import MissingToolError
from fe_drivetrain.common.progress import silent
from fe_drivetrain.report.suite import case as case_module

# Solvers are imported where they are used: the process that starts the others needs none of them.
if TYPE_CHECKING:
    import numpy as np
    from tiny_case import Result
    from xdist.remote import Producer

    from fe_drivetrain.elasticity.mesh.mesh import Mesh
    from fe_drivetrain.report.results import Results
    from fe_drivetrain.report.suite.case import Case
    from fe_drivetrain.shafts.response.model import Model
    from fe_drivetrain.shafts.response.unit_loads import Response

# Tests of one room take helpers of others.
sys.path[1:1] = sorted(str(folder) for folder in Path(__file__).parent.iterdir() if folder.is_dir())

# The same few examples each time, or many new ones: HYPOTHESIS_PROFILE=thorough. How long an
# example takes depends on who else works on the machine, so there is no deadline.
hypothesis.settings.register_profile(
    "default", derandomize=True, max_examples=30, deadline=None, database=None
)
hypothesis.settings.register_profile("thorough", max_examples=1000, deadline=None)
hypothesis.settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "default"))

#: Programs that tests start; all else that they need is a Python package.
PROGRAMS = ("ccx", "chromium", "mpiexec")

#: Where this is set, a test that is skipped has failed: everything that tests need is installed.
NO_SKIP_VARIABLE = "FE_DRIVETRAIN_NO_SKIP"


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item: pytest.Item) -> None:
    """Skip a test where a program or package that its mark ``needs`` names is not installed."""
    for name in (name for mark in item.iter_markers("needs") for name in mark.args):
        if name not in PROGRAMS:
            pytest.importorskip(name, exc_type=ImportError)
        elif shutil.which(name) is None:
            pytest.skip(f"there is no program {name}")


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport() -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Let no test be skipped where none may be."""
    report = yield
    if report.skipped and os.environ.get(NO_SKIP_VARIABLE):
        report.outcome = "failed"
    return report


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_auto_num_workers() -> int:
    """As many processes of tests as there are cores, those of a second thread counted, too."""
    return threads.cores()


@pytest.fixture(scope="session")
def shared_folder(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder that all processes of these tests share."""
    base = tmp_path_factory.getbasetemp()
    return base.parent if hasattr(request.config, "workerinput") else base


@pytest.fixture(scope="session", autouse=True)
def apart_from_the_user(shared_folder: Path) -> Iterator[None]:
    """A cache for the tests alone, and one process with one thread; tests of these set their own.

    Other tests take the other cores meanwhile: two threads would wait for each other in every loop.
    """
    import numba  # noqa: F401 - libraries that are loaded are held
    import scipy.linalg  # noqa: F401

    with pytest.MonkeyPatch.context() as patch, threads.held_to_one_thread():
        patch.setenv(cache.CACHE_VARIABLE, str(shared_folder / "cache"))
        patch.setenv(threads.CORES_VARIABLE, "1")
        yield


@pytest.fixture(autouse=True)
def left_with_one_thread() -> Iterator[None]:
    """Fail where a test leaves compiled loops more threads than it found.

    They would wait for each other in all tests after it, which then take five times as long.
    """
    yield
    import numba

    assert numba.get_num_threads() == 1


#: A folder of quick runs to take results from, and to put them in, in place of the kept one.
QUICK_VARIABLE = "FE_DRIVETRAIN_QUICK_RUNS"


@dataclass(frozen=True)
class QuickRun:
    """Results of quick cases, each run once for all tests, and again where the program has changed.

    Attributes
    ----------
    folder : Path
        Where they are put.
    made : Path
        The cache that they take meshes and solutions from, see `kept_folder`.
    given : bool
        Whether the folder is of one run, whose failed checks stand. Those of the kept one may be of
        a machine that had something else to do.
    """

    folder: Path
    made: Path
    given: bool

    def __call__(self, name: str) -> Results:
        """Results of a case; the test is skipped where a program is missing that it needs."""
        case = case_module.all_cases()[name]
        with filelock.FileLock(self.folder / f"{name.replace('/', '-')}.lock"):
            results = self._standing(case)
            if results is None:
                with pytest.MonkeyPatch.context() as patch:
                    patch.setenv(cache.CACHE_VARIABLE, str(self.made))
                    self._run(case)
                results = self._results(case)
        return results

    def _results(self, case: Case) -> Results:
        from fe_drivetrain.report.results import read_results
        from fe_drivetrain.report.suite.result_folders import result_folder

        return read_results(result_folder(self.folder, case) / "results.json")

    def _standing(self, case: Case) -> Results | None:
        """Results that the same program has made, with the same packages."""
        from fe_drivetrain.report.suite.resuming import finished_cases

        if not finished_cases([case], self.folder, quick=True):
            return None
        results = self._results(case)
        return results if self.given or all(v.passed for v in results.verdicts) else None

    def _run(self, case: Case) -> None:
        from fe_drivetrain.report.suite import result_folders
        from fe_drivetrain.report.suite.suite import run_cases

        if case.runs_alone(quick=True):
            problem = run_cases([case], self.folder, quick=True).get(case.name)
            if problem is not None and problem.state == "skipped":
                pytest.skip(problem.message)
            assert problem is None, problem
            return
        target = result_folders.result_folder(self.folder, case)
        folder = result_folders.new_folder(target)
        try:  # as `run_case`, without the pages of all cases, which take longer than many a case
            result_folders.run_into(case, folder.path, {}, True, silent, self.folder)
            result_folders.put_in_place(folder, target)
        except MissingToolError as error:
            pytest.skip(str(error))
        finally:
            folder.discard()


#: Files that take longest: they begin first, so that at the end no process waits for another. The
#: first one forks, which is quick while a process has little in memory. It compiles nothing, so
#: that it does not wait for loops of the second.
LONG = (
    "test_faults.py",
    "test_docs_pages.py",
    "test_foreign_files.py",
    "test_uncertainty_study.py",
    "test_own_drivetrain.py",
    "test_main_bearing_cases.py",
    "test_own_drivetrains.py",
    "test_design_search.py",
    "test_face.py",
    "test_axisymmetric.py",
    "test_own_scenes.py",
    "test_planet_carrier.py",
    "test_processes.py",
    "test_mutations.py",
    "test_nose.py",
    "test_suite.py",
    "test_work_precision.py",
    "test_foreign_parts.py",
    "test_petsc.py",
    "test_performance_peers.py",
    "test_bands.py",
    "test_mesh.py",
    "test_bearing_catalogue.py",
    "test_foreign.py",
    "test_calculix.py",
    "test_moving_turbine.py",
    "test_general_scenes.py",
)


#: Files whose tests are whole cases, each of which runs by itself.
WHOLE_CASES = (
    "test_answers.py",
    "test_cases.py",
    "test_consumer_cases.py",
    "test_waiting_cases.py",
)


class ByFile(LoadScopeScheduling):
    """Tests of a file in one process, which builds its fixtures once; whole cases one by one.

    Marks cannot say so: of ``xdist_group`` pytest-xdist 3.8 makes nothing with pytest 9.2.
    """

    def _split_scope(self, nodeid: str) -> str:
        file = nodeid.partition("::")[0]
        return nodeid if Path(file).name in WHOLE_CASES else file


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Producer) -> ByFile:
    """Take the tests in the order of `pytest_collection_modifyitems`."""
    config.option.loadscopereorder = False
    return ByFile(config, log)


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, object, object]:
    """Let the collector of garbage pass by what stays to the end: all modules and tests.

    It went through all of them again and again, and in a child that is forked it copied each of
    their pages. Where one process collects and others run the tests, each does so for itself.
    """
    gc.disable()
    try:
        return (yield)
    finally:
        gc.freeze()
        gc.enable()


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Begin with the files that take longest, and end with whole cases."""
    order = {name: place for place, name in enumerate(LONG)}
    order |= dict.fromkeys(WHOLE_CASES, len(LONG) + 1)
    items.sort(key=lambda item: order.get(item.path.name, len(LONG)))


@pytest.fixture(scope="module", autouse=True)
def one_process_a_file(request: pytest.FixtureRequest, shared_folder: Path) -> None:
    """Fail where two processes share a file: each would build what the other has."""
    if request.path.name not in WHOLE_CASES:
        folder = shared_folder / "processes"
        folder.mkdir(exist_ok=True)
        mark = folder / f"{request.path.stem}.txt"
        with suppress(FileExistsError), mark.open("x") as stream:
            stream.write(str(os.getpid()))
        assert mark.read_text() == str(os.getpid())


@pytest.fixture(scope="session")
def kept_folder(request: pytest.FixtureRequest, shared_folder: Path) -> Path:
    """A cache that stays for the next run of the tests; ``pytest --cache-clear`` empties it.

    Its keys hold the sources of all that makes what is in it. What a test patches they do not, so
    only what is not patched may be kept here.
    """
    kept = getattr(request.config, "cache", None)  # none with ``-p no:cacheprovider``
    folder = Path(kept.mkdir("fe-drivetrain")) if kept else shared_folder / "cache"
    folder.mkdir(exist_ok=True)
    return folder


@pytest.fixture(scope="module")
def kept_between_runs(kept_folder: Path) -> Iterator[None]:
    """Keep meshes and solutions of a file whose tests patch nothing for the next run of them."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(cache.CACHE_VARIABLE, str(kept_folder))
        yield


@pytest.fixture(scope="module")
def without_pictures() -> Iterator[None]:
    """Draw nothing, as on a machine that cannot; of quick cases a third of the time is drawing."""
    from fe_drivetrain.report.pictures import drawing_process

    def refuse() -> None:
        raise drawing_process.NoPictureError("no picture is asked for")

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(drawing_process, "_running", refuse)
        yield


@pytest.fixture(scope="session")
def quick_run(kept_folder: Path) -> QuickRun:
    """Results of the cases that the mark ``quick`` of a test names."""
    given = os.environ.get(QUICK_VARIABLE)
    folder = Path(given or kept_folder / "quick")
    folder.mkdir(exist_ok=True)
    return QuickRun(folder, kept_folder, bool(given))


@pytest.fixture(scope="session")
def every_quick_run(quick_run: QuickRun) -> QuickRun:
    """Results of all cases, from a run of them all; only what that lacks is run."""
    if not quick_run.given:
        pytest.skip(f"{QUICK_VARIABLE} names no folder of results, as `make cases` does")
    return quick_run


@pytest.fixture(scope="session", autouse=True)
def interruptible() -> None:
    """A shell that runs this in the background ignores Ctrl-C, and so would all its children."""
    if signal.getsignal(signal.SIGINT) == signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.fixture(scope="session")
def spherical_mesh() -> Mesh:
    from coarse_scenes import coarse_scene

    from fe_drivetrain.shafts.response.model import mesh_scene

    return mesh_scene(coarse_scene("spherical"))


@pytest.fixture(scope="session")
def bonded_model() -> Model:
    from coarse_scenes import coarse_scene

    from fe_drivetrain.shafts.response.model import build_model, mesh_scene

    scene = coarse_scene("bonded")
    return build_model(scene, mesh_scene(scene))


@pytest.fixture(scope="session")
def bonded_response(bonded_model: Model) -> Response:
    from fe_drivetrain.shafts.response.unit_loads import unit_load_response

    return unit_load_response(bonded_model)


@pytest.fixture(scope="session")
def spherical_responses(spherical_mesh: Mesh) -> dict[str, tuple[Model, Response]]:
    """Model and response for each form of the spherical joint."""
    from coarse_scenes import coarse_scene

    from fe_drivetrain.drivetrain_file.reading import change_scene
    from fe_drivetrain.shafts.response.model import build_model
    from fe_drivetrain.shafts.response.unit_loads import unit_load_response

    found = {}
    for form in ("sliding", "averaged", "rigid"):
        scene = change_scene(coarse_scene("spherical"), {"bearing_units.0.interface": form})
        model = build_model(scene, spherical_mesh)
        found[form] = model, unit_load_response(model)
    return found


@pytest.fixture
def rng() -> np.random.Generator:
    import numpy as np

    return np.random.default_rng(1)


@pytest.fixture
def invoke(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Callable[..., Result]:
    """Run the command in an empty folder, with one case that does the given work."""
    from tiny_case import count

    from fe_drivetrain.command_line import app
    from fe_drivetrain.report.suite.case import Case

    monkeypatch.chdir(tmp_path)

    def run(*arguments: str, work: Any = count, main: Callable[[], None] = app.main) -> Result:
        takes: dict[str, Any] = {"settings": ("a", "k"), "changes": "scene"}
        cases = {
            "group/tiny": Case("group/tiny", "A tiny case", "nobody", work, **takes),
            "group/other": Case("group/other", "Another [bold] case", "nobody", work, **takes),
            "next/third": Case("next/third", "A third", "nobody", work, **takes),
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


@pytest.fixture
def script(tmp_path: Path) -> Path:
    """A user's own script of a case."""
    from tiny_case import SCRIPT

    path = tmp_path / "tiny.py"
    path.write_text(SCRIPT, "utf-8")
    return path
