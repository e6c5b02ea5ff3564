"""Memory of a process: new arrays take that of freed ones, unless the user says otherwise."""

import os
import sys

import pytest

from fe_drivetrain.common.interpreter import run_python

#: Pages that three arrays of 64 MB ask the system for, each after the one before is freed.
ASKED_FOR = """
import resource
{first}

def asked():
    before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
    bytearray(64_000_000)[::4096]
    return resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before

print([asked() for _ in range(3)][-1])
"""


@pytest.mark.skipif(sys.platform != "linux", reason="an option of GNU's C library")
@pytest.mark.parametrize(
    ("first", "user", "again"),
    [
        ("", {}, False),
        ("import fe_drivetrain.elasticity.operator.kernels", {}, True),
        (
            "import fe_drivetrain.elasticity.operator.kernels",
            {"MALLOC_MMAP_THRESHOLD_": "100000", "MALLOC_TRIM_THRESHOLD_": "100000"},
            False,
        ),
    ],
)
def test_freed_memory_is_taken_again(
    first: str, user: dict[str, str], again: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in [name for name in os.environ if name.startswith(("MALLOC_", "GLIBC_"))]:
        monkeypatch.delenv(name)
    done = run_python("-c", ASKED_FOR.format(first=first), environment=user)
    assert done.returncode == 0, done.stderr
    assert (int(done.stdout) < 100) == again


#: Pages that an array of another thread asks the system for, after one as large was freed here.
ASKED_FOR_ELSEWHERE = """
import resource
import threading
import fe_drivetrain.elasticity.operator.kernels

def fill():
    bytearray(24_000_000)[::4096]

fill()
before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
thread = threading.Thread(target=fill)
thread.start()
thread.join()
print(resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="an option of GNU's C library")
@pytest.mark.parametrize(("user", "again"), [({}, True), ({"MALLOC_ARENA_MAX": "8"}, False)])
def test_memory_that_one_thread_freed_is_taken_by_another(
    user: dict[str, str], again: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in [name for name in os.environ if name.startswith(("MALLOC_", "GLIBC_"))]:
        monkeypatch.delenv(name)
    done = run_python("-c", ASKED_FOR_ELSEWHERE, environment=user)
    assert done.returncode == 0, done.stderr
    assert (int(done.stdout) < 200) == again


#: How often all was gone through while objects that last were made, whether a cycle that was
#: made among them is gone, and how many objects the last collection found.
COLLECTED = """
import gc
import sys
import weakref
from fe_drivetrain.common.memory import collect_lasting_seldom
{first}

class Cycle:
    def __init__(self):
        self.itself = self

before = gc.get_stats()[2]["collections"]
cycle = weakref.ref(Cycle())
lasting = [[k] for k in range(1_500_000)]
print(gc.get_stats()[2]["collections"] - before, cycle() is None)
last = Cycle()
del last
gc.callbacks.append(lambda phase, info: phase == "stop" and print(info["collected"]))
"""


@pytest.mark.parametrize(("first", "seldom"), [("", False), ("collect_lasting_seldom()", True)])
def test_a_program_seldom_looks_for_garbage_among_what_lasts(first: str, seldom: bool) -> None:
    done = run_python("-c", COLLECTED.format(first=first))
    assert done.returncode == 0, done.stderr
    whole, young_is_gone, *found = done.stdout.split()
    assert young_is_gone == "True"
    assert (int(whole) <= 1) == seldom
    assert (int(found[0]) == 0) == seldom
