"""Loops are compiled once, whichever processes need them at a time, and as numba would."""

import os
import re
import subprocess
import sys
import time
from importlib import import_module
from pathlib import Path

import pytest
from numba.core.dispatcher import Dispatcher

import fe_drivetrain
from fe_drivetrain.common.compiled import njit

#: What a loop that does not state it takes from whichever other one has it compiled first.
PASSED_ON = ("fastmath", "error_model")

LOOP = """
import sys, time
from pathlib import Path
import numpy as np
from fe_drivetrain.common.compiled import njit

@njit(cache=True)
def inner(x):
    total = 0.0
    for value in np.sort(x):
        total += value
    return total

@njit(cache=True)
def outer(x):
    return inner(x) + inner(x[::-1].copy())

def compile_at_once():
    here = Path(__file__).parent
    (here / f"ready {sys.argv[1]}").touch()
    while len(list(here.glob("ready *"))) < 2:
        time.sleep(0.001)
    assert outer(np.array([2.0, 1.0])) == 6.0
    print(sum(outer.stats.cache_misses.values()) + sum(inner.stats.cache_misses.values()))

if __name__ == "__main__":
    compile_at_once()
"""


def environment(folder):
    return {**os.environ, "NUMBA_CACHE_DIR": str(folder / "kept")}


def test_two_processes_compile_a_loop_once_between_them(tmp_path):
    script = tmp_path / "loop.py"
    script.write_text(LOOP)
    running = [
        subprocess.Popen(
            [sys.executable, str(script), name],
            stdout=subprocess.PIPE,
            text=True,
            env=environment(tmp_path),
        )
        for name in ("one", "other")
    ]
    made = sorted(int(process.communicate()[0]) for process in running)
    assert made == [0, 2]  # both loops by the first, none by the other


@pytest.mark.skipif(sys.platform == "win32", reason="there are no such locks")
def test_a_process_that_died_is_not_waited_for(tmp_path):
    import fcntl

    script = tmp_path / "loop.py"
    script.write_text(LOOP)
    (tmp_path / "ready none").touch()

    def run():
        started = time.monotonic()
        done = subprocess.run(
            [sys.executable, str(script), "one"],
            capture_output=True,
            text=True,
            env=environment(tmp_path),
            check=True,
        )
        return int(done.stdout), time.monotonic() - started

    assert run()[0] == 2
    (lock,) = tmp_path.glob("kept/*/loop.outer-*.lock")
    for kept in tmp_path.glob("kept/*/*.nb?"):
        kept.unlink()
    with lock.open("r+") as held:  # as by a process that has ended
        fcntl.flock(held, fcntl.LOCK_EX)
    assert run()[0] == 2


def test_a_loop_that_cannot_be_compiled_says_so_and_another_form_is_compiled():
    @njit()
    def doubled(x):
        return 2.0 * x.real

    with pytest.raises(Exception, match=r"(?i)typing|unknown attribute"):
        doubled("word")
    assert doubled(1.5) == 3.0


def called(loop):
    """Loops that a loop names."""
    scope = loop.py_func.__globals__
    named = (scope.get(name) for name in loop.py_func.__code__.co_names)
    return [one for one in named if isinstance(one, Dispatcher)]


def not_stated(loops):
    """What loops would pass on to those that they call, which do not state it."""
    return {
        (loop.py_func.__name__, one.py_func.__name__, option)
        for loop in loops
        for one in called(loop)
        for option in PASSED_ON
        if loop.targetoptions.get(option) and option not in one.targetoptions
        if one.targetoptions.get("inline") != "always"
    }


@njit(fastmath=True)
def quick(x):
    return silent(x)


@njit()
def silent(x):
    return 2.0 * x


def test_results_do_not_depend_on_which_loop_is_compiled_first():
    package = Path(fe_drivetrain.__file__).parent
    taken = re.compile(r"^from .*\.compiled import .*\b(njit|inner_loop)\b", re.MULTILINE)
    files = [f for f in package.rglob("*.py") if taken.search(f.read_text("utf-8"))]
    names = [".".join(f.relative_to(package).with_suffix("").parts) for f in files]
    loops = {
        id(one): one
        for name in names
        for one in vars(import_module(f"fe_drivetrain.{name}")).values()
        if isinstance(one, Dispatcher)
    }
    assert len(loops) > 100
    assert not_stated(loops.values()) == set()
    assert not_stated([quick]) == {("quick", "silent", "fastmath")}
