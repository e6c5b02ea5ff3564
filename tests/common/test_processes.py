"""Jobs in processes: right answers, held threads, and nothing left behind however they end."""

import os
import pickle
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from jobs import (
    MODULES,
    end,
    fault,
    large,
    leave_a_child,
    meet,
    mistake,
    nested,
    odd,
    places,
    sleep_for_ever,
    square,
    steps,
    talk,
    threads,
    until,
)

import fe_drivetrain
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.interpreter import run_python
from fe_drivetrain.common.processes import Processes
from fe_drivetrain.common.progress import Progress
from fe_drivetrain.common.threads import CORES_VARIABLE, cores, hold_threads
from fe_drivetrain.report.suite.run import Run

pytestmark = pytest.mark.skipif(os.name != "posix", reason="looks at processes by their number")


@pytest.fixture(autouse=True)
def two_cores(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(CORES_VARIABLE, "2")


def is_running(pid: int) -> bool:
    try:
        os.kill(pid, 0)
    except ProcessLookupError:
        return False
    status = Path(f"/proc/{pid}/stat")
    return not (status.exists() and status.read_text().rpartition(")")[2].split()[0] == "Z")


# --- results -------------------------------------------------------------------------------------


def test_idle_threads_of_compiled_loops_sleep_unless_the_user_says_otherwise(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.delenv(CORES_VARIABLE)
    monkeypatch.setenv("OPENBLAS_THREAD_TIMEOUT", "4")
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "1")
    monkeypatch.setenv("GOMP_SPINCOUNT", "")  # so that it is put back
    monkeypatch.delenv("GOMP_SPINCOUNT")
    hold_threads()
    # of the 3e5 turns that GNU's OpenMP waits by default, milliseconds, next to nothing is left
    assert int(os.environ["GOMP_SPINCOUNT"]) <= 3e4  # a millisecond or so
    monkeypatch.setenv("GOMP_SPINCOUNT", "300000")
    hold_threads()
    assert os.environ["GOMP_SPINCOUNT"] == "300000"


def test_small_matrices_get_one_thread_unless_the_user_says_otherwise(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.delenv(CORES_VARIABLE)
    for name in ("OPENBLAS_THREAD_TIMEOUT", "GOMP_SPINCOUNT"):
        monkeypatch.setenv(name, "4")
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "")  # so that it is put back
    monkeypatch.delenv("OPENBLAS_NUM_THREADS")
    hold_threads()
    assert os.environ["OPENBLAS_NUM_THREADS"] == "1"
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "8")
    hold_threads()
    assert os.environ["OPENBLAS_NUM_THREADS"] == "8"


def test_results_come_back_from_other_processes() -> None:
    with Processes(5) as processes:
        jobs = [processes.start(square, x) for x in range(5)]
        results = [job.result() for job in jobs]
    assert [value for _, value in results] == [0, 1, 4, 9, 16]
    pids = {pid for pid, _ in results}
    assert os.getpid() not in pids
    assert len(pids) <= 2
    until(lambda: not any(map(is_running, pids)))


def test_jobs_run_at_the_same_time(tmp_path: Path) -> None:
    with Processes(2) as processes:
        jobs = [
            processes.start(meet, tmp_path, "a", "b"),
            processes.start(meet, tmp_path, "b", "a"),
        ]
        assert all(job.result() for job in jobs)


def test_arrays_travel_whole() -> None:
    array = np.random.default_rng(0).standard_normal((3, 10**6))
    with Processes(1, always=True) as processes:
        back = processes.start(large, array).result()
    assert back.tobytes() == array[::-1].tobytes()


def test_jobs_come_as_they_are_finished(tmp_path: Path) -> None:
    with Processes(2) as processes:
        slow = processes.start(meet, tmp_path, "a", "go")
        fast = processes.start(square, 2.0)
        order = []
        for job in processes.finished([slow, fast]):
            order.append(job)
            (tmp_path / "go").touch()
    assert order == [fast, slow]


def test_one_core_or_one_job_needs_no_process(monkeypatch: pytest.MonkeyPatch) -> None:
    with Processes(1) as processes:
        assert processes.count == 0
        assert processes.start(square, 3.0).result() == (os.getpid(), 9.0)
    monkeypatch.setenv(CORES_VARIABLE, "1")
    with Processes(3) as processes:
        jobs = [processes.start(square, x) for x in (1.0, 2.0, 3.0)]
        assert [job.result() for job in processes.finished(jobs)] == [
            (os.getpid(), x) for x in (1.0, 4.0, 9.0)
        ]
    with Processes(1, always=True) as processes:
        assert processes.start(square, 3.0).result()[0] != os.getpid()


def test_jobs_nobody_asks_for_are_done_all_the_same(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for number in ("1", "2"):
        monkeypatch.setenv(CORES_VARIABLE, number)
        folder = tmp_path / number
        folder.mkdir()
        (folder / "b").touch()
        with Processes(2) as processes:
            processes.start(meet, folder, "a", "b")
        assert (folder / "a").exists()


def test_a_process_starts_no_others() -> None:
    with Processes(2) as processes:
        outer, inner = processes.start(nested).result()
    assert outer == inner != os.getpid()


def test_the_users_folder_hides_no_module(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in MODULES:
        (tmp_path / f"{name}.py").write_text("raise SystemExit('mine')")
    monkeypatch.chdir(tmp_path)
    with Processes(2) as processes:
        assert not [at for at in processes.start(places).result() if str(tmp_path) in at]


def test_a_script_is_not_run_again_in_other_processes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As users write them: without a guard, and with heavy imports that take all the cores.

    They may even run where modules have the names of standard ones.
    """
    (tmp_path / "here").mkdir()
    for name in MODULES:
        (tmp_path / "here" / f"{name}.py").write_text("raise SystemExit('mine')")
    (tmp_path / "jobs_of_script.py").write_text(
        "import sys\ndef has_numpy(report):\n    return 'numpy' in sys.modules\n"
    )
    (tmp_path / "script.py").write_text(
        "import numpy\n"
        "import jobs_of_script\n"
        "from fe_drivetrain.common.processes import Processes\n"
        "import os; os.chdir(os.environ['FOLDER'])\n"
        "print('once')\n"
        "with Processes(2) as processes:\n"
        "    print(processes.start(jobs_of_script.has_numpy).result())\n"
    )
    monkeypatch.syspath_prepend(str(tmp_path))
    done = run_python(str(tmp_path / "script.py"), environment={"FOLDER": str(tmp_path / "here")})
    assert (done.stdout.split(), done.stderr) == (["once", "False"], "")


# --- child interpreters --------------------------------------------------------------------------


def test_a_child_interpreter_imports_what_this_one_does(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    here, there = tmp_path / "here", tmp_path / "there"
    here.mkdir()
    there.mkdir()
    (here / "random.py").write_text("raise SystemExit('mine')")
    (there / "only_there.py").touch()
    monkeypatch.chdir(here)
    monkeypatch.syspath_prepend(str(there))
    program = "import random, only_there, fe_drivetrain; print(fe_drivetrain.__file__)"
    done = run_python("-c", program)
    assert done.stdout.strip() == fe_drivetrain.__file__, done.stderr


# --- threads -------------------------------------------------------------------------------------


@pytest.mark.parametrize(("available", "jobs", "share"), [(2, 2, 1), (4, 2, 2), (4, 3, 1)])
def test_all_processes_together_have_no_more_threads_than_cores(
    monkeypatch: pytest.MonkeyPatch, available: int, jobs: int, share: int
) -> None:
    monkeypatch.setenv(CORES_VARIABLE, str(available))
    monkeypatch.delenv("OMP_NUM_THREADS", raising=False)
    monkeypatch.setenv("MKL_NUM_THREADS", "1")
    monkeypatch.setenv("NUMBA_NUM_THREADS", "64")
    with Processes(jobs) as processes:
        number, told = processes.start(threads).result()
    assert told == {
        "OMP_NUM_THREADS": str(share),
        "MKL_NUM_THREADS": "1",  # fewer, as the user said
        "NUMBA_NUM_THREADS": str(share),
    }
    assert number <= share
    assert processes.count * share <= available


def test_this_process_keeps_to_one_thread_meanwhile() -> None:
    from threadpoolctl import threadpool_info

    before = [library["num_threads"] for library in threadpool_info()]
    with Processes(2):
        assert {library["num_threads"] for library in threadpool_info()} <= {1}
    assert [library["num_threads"] for library in threadpool_info()] == before


def test_the_command_line_holds_itself_to_the_cores_that_the_user_gives() -> None:
    program = (
        "import sys; sys.argv[:] = ['fe-drivetrain', 'run', 'unknown']\n"
        "from fe_drivetrain.command_line import main\n"
        "try:\n"
        "    main()\n"
        "except SystemExit:\n"
        "    pass\n"
        "import numpy, scipy.linalg\n"
        "from threadpoolctl import threadpool_info\n"
        "print(max(library['num_threads'] for library in threadpool_info()))\n"
    )
    environment = {k: v for k, v in os.environ.items() if not k.endswith("_NUM_THREADS")}
    done = subprocess.run(
        [sys.executable, "-P", "-c", program],
        env={**environment, CORES_VARIABLE: "1"},
        capture_output=True,
        text=True,
        check=True,
    )
    assert done.stdout == "1\n"


@pytest.mark.parametrize("number", ["0", "-1", "two", "1.5"])
def test_a_wrong_number_of_cores_is_told(monkeypatch: pytest.MonkeyPatch, number: str) -> None:
    monkeypatch.setenv(CORES_VARIABLE, number)
    with pytest.raises(InputError, match=rf"{CORES_VARIABLE} is '{number}'"):
        cores()


def test_left_alone_it_takes_the_cores_it_may_use(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(CORES_VARIABLE)
    assert cores() == len(os.sched_getaffinity(0))


# --- steps ---------------------------------------------------------------------------------------


def test_steps_of_all_processes_are_told() -> None:
    told: list[tuple[str, int]] = []
    with Processes(2, lambda step, lane=0: told.append((step, lane))) as processes:
        jobs = [processes.start(steps, name) for name in ("a", "b")]
        for job in jobs:
            job.result()
    for name in ("a", "b"):
        (lane,) = {lane for step, lane in told if step.endswith(name)}
        assert lane in (1, 2)
        assert [step for step, at in told if step.endswith(name)] == [
            f"first of {name}",
            f"second of {name}",
        ]
    ends = [lane for step, lane in told if step == ""]
    assert set(ends) == {lane for _, lane in told}


def timed(run: Run, name: str) -> str:
    with run.step(name):
        (run.folder / name).write_text(str(run.settings["k"]))
        time.sleep(0.2)
    return name


def test_times_of_a_run_add_up_to_the_time_that_passed(tmp_path: Path) -> None:
    run = Run({"k": 7}, False, tmp_path)
    start = time.perf_counter()
    with run.side_by_side(2) as jobs:
        assert [job.result() for job in [jobs.start(timed, n) for n in ("a", "b")]] == ["a", "b"]
    passed = time.perf_counter() - start
    assert {"a", "b"} < set(run.times)
    assert sum(run.times.values()) == pytest.approx(passed, rel=0.1, abs=0.05)
    assert (tmp_path / "b").read_text() == "7"


# --- failures ------------------------------------------------------------------------------------


def test_a_users_mistake_arrives_as_it_was_raised() -> None:
    with pytest.raises(InputError) as caught, Processes(2) as processes:
        processes.start(mistake).result()
    assert str(caught.value) == "shaft: length is -1 but must be greater than 0: give a length"


def test_a_fault_says_where_it_was_raised() -> None:
    with pytest.raises(ZeroDivisionError) as caught, Processes(2) as processes:
        processes.start(fault).result()
    assert "in fault" in str(caught.value.__cause__)
    with pytest.raises(RuntimeError, match="1 and 2") as caught, Processes(2) as processes:
        processes.start(odd).result()
    assert "in odd" in str(caught.value.__cause__)


def test_a_failure_ends_all_others_at_once(tmp_path: Path) -> None:
    def failing() -> None:
        with Processes(2) as processes:
            waiting = processes.start(sleep_for_ever, tmp_path)
            until(lambda: any(tmp_path.iterdir()))
            processes.start(mistake)
            waiting.result()

    with pytest.raises(InputError, match="length"):
        failing()
    (pid,) = (int(file.name) for file in tmp_path.iterdir())
    assert not is_running(pid)


def test_an_error_in_this_process_ends_all_others(tmp_path: Path) -> None:
    def stopped() -> None:
        with Processes(2) as processes:
            processes.start(sleep_for_ever, tmp_path)
            processes.start(sleep_for_ever, tmp_path)
            until(lambda: len(list(tmp_path.iterdir())) == 2)
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        stopped()
    assert not any(is_running(int(file.name)) for file in tmp_path.iterdir())


def test_a_process_takes_with_it_what_it_has_started(tmp_path: Path) -> None:
    def stopped() -> None:
        with Processes(2) as processes:
            processes.start(leave_a_child, tmp_path)
            until(lambda: any(tmp_path.iterdir()))
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        stopped()
    (pid,) = (int(file.name) for file in tmp_path.iterdir())
    until(lambda: not is_running(pid))


def test_what_cannot_be_pickled_is_refused() -> None:
    with pytest.raises((AttributeError, pickle.PicklingError)), Processes(2) as processes:
        processes.start(square, lambda: 2.0).result()


def test_a_killed_process_is_explained() -> None:
    with pytest.raises(InputError, match=rf"memory.*{CORES_VARIABLE}=1"), Processes(2) as processes:
        processes.start(end, -signal.SIGKILL).result()
    with pytest.raises(RuntimeError, match=r"status 3.*last words"), Processes(2) as processes:
        processes.start(end, 3).result()


def test_what_a_job_prints_is_no_answer(capfd: pytest.CaptureFixture[str]) -> None:
    with Processes(2) as processes:
        assert processes.start(talk).result() == "done"
    said = capfd.readouterr()
    assert said.out == ""
    assert "raw out" in said.err


def test_locks_of_an_ended_process_are_freed_without_a_word() -> None:
    program = """
from jobs import hold_a_lock
from fe_drivetrain.common.processes import Processes
with Processes(2) as processes:
    processes.start(hold_a_lock)
"""
    done = run_python("-c", program)
    assert (done.returncode, done.stderr) == (0, "")


# --- from outside, as typed on the command line --------------------------------------------------

JOBS = """
import os, time
def work(run, name):
    with run.step(name):
        (run.folder / name).write_text(str(os.getpid()))
        time.sleep(600)
"""
SCRIPT = """
from fe_drivetrain.command_line import main_of_case
from fe_drivetrain.report.suite import Case
import jobs_of_script

def work(run, page):
    with run.side_by_side(2) as jobs:
        for job in [jobs.start(jobs_of_script.work, name) for name in ("one", "two")]:
            job.result()

if __name__ == "__main__":
    main_of_case(Case("group/tiny", "Title", "s", work))
"""


@pytest.mark.parametrize(
    ("sent", "status"),
    [(signal.SIGINT, 130), (signal.SIGTERM, 143), (signal.SIGKILL, -signal.SIGKILL)],
)
def test_a_signal_ends_every_process_and_leaves_nothing_half_written(
    tmp_path: Path, sent: signal.Signals, status: int
) -> None:
    (tmp_path / "jobs_of_script.py").write_text(JOBS)
    (tmp_path / "script.py").write_text(SCRIPT)
    out = tmp_path / "out"
    command = [sys.executable, str(tmp_path / "script.py"), "--out", str(out / "x")]
    with subprocess.Popen(
        command, cwd=tmp_path, stderr=subprocess.PIPE, text=True, start_new_session=True
    ) as process:
        assert process.stderr is not None

        def pids() -> list[int]:
            files = [*out.glob(".x-*/one"), *out.glob(".x-*/two")]
            return [int(file.read_text() or 0) for file in files]

        until(lambda: len(pids()) == 2 and 0 not in pids())
        children = pids()
        assert all(map(is_running, children))
        # as a terminal sends it: to the whole group of the command
        os.killpg(process.pid, sent) if sent == signal.SIGINT else process.send_signal(sent)
        assert process.wait(60) == status
        until(lambda: not any(map(is_running, children)))
        err = process.stderr.read()
    assert "Traceback" not in err
    if sent != signal.SIGKILL:  # which nothing can clean up after
        assert list(out.iterdir()) == []


def test_a_mistake_in_a_process_is_one_sentence_on_the_command_line(tmp_path: Path) -> None:
    (tmp_path / "jobs_of_script.py").write_text(
        "from fe_drivetrain.common.errors import InputError\n"
        "def work(run, name):\n"
        "    raise InputError(f'{name}: too long: make it shorter')\n"
    )
    (tmp_path / "script.py").write_text(SCRIPT)
    command = [sys.executable, str(tmp_path / "script.py"), "--out", str(tmp_path / "out" / "x")]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    (told,) = (line for line in done.stderr.splitlines() if line.startswith("fe-drivetrain:"))
    assert told.endswith(": too long: make it shorter")
    assert "Traceback" not in done.stderr
    assert list((tmp_path / "out").iterdir()) == []


def test_a_job_of_the_script_itself_is_refused() -> None:
    def local(report: Progress) -> Any:
        return None

    local.__module__ = "__main__"
    with pytest.raises(ValueError, match="must stand in a module"), Processes(2) as processes:
        processes.start(local)
