"""Rows of faults do not rot, and only a failed check of a test that passes otherwise is a catch."""

import os
import shutil
import sys
from pathlib import Path

import pytest

from fe_drivetrain.cases.verification import mutation_rows
from fe_drivetrain.cases.verification.mutation_rows import (
    Fault,
    clone,
    copy_of,
    faults_of,
    is_there_once,
    with_fault,
)
from fe_drivetrain.cases.verification.mutation_runs import (
    CAUGHT,
    HANGS,
    RAISES,
    SURVIVES,
    Bench,
    controlled,
)
from fe_drivetrain.common.errors import InputError, MissingToolError
from fe_drivetrain.common.progress import silent

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "docs"))

import house  # noqa: E402

#: Folders that have no module of their own.
WITHOUT_CODE = {"bearing_life", "elasticity", "shafts", "turbine_loads"}
FAULTS = faults_of(ROOT)


from_clone = pytest.mark.skipif(
    Path(mutation_rows.__file__).parents[2] != ROOT, reason="the program is not this clone's"
)


@from_clone
def test_this_clone_is_found() -> None:
    assert clone() == ROOT


@pytest.mark.parametrize("fault", FAULTS, ids=lambda fault: f"{fault.file}: {fault.what}")
def test_a_row_can_be_put_in_and_its_tests_are_there(fault: Fault) -> None:
    assert is_there_once(ROOT, fault)
    assert fault.tests
    for test in fault.tests:
        file, _, name = test.partition("::")
        text = (ROOT / "tests" / file).read_text(encoding="utf-8")
        assert not name or f"def {name.partition('[')[0]}(" in text


def test_faults_are_many_and_of_all_rooms() -> None:
    assert len(FAULTS) >= 120
    assert len({(fault.file, fault.line, fault.fault) for fault in FAULTS}) == len(FAULTS)
    folders = {name for name in house.rooms(house.folder_of) if not name.startswith("cases")}
    assert {house.folder_of(fault.module) for fault in FAULTS} >= folders - WITHOUT_CODE
    assert sum(fault.quick for fault in FAULTS) in range(3, 9)


LOOP = "from numba import njit\nfrom fe_drivetrain.room.part import SIZE\n"
CHECKS = """import time

import pytest

from fe_drivetrain.room.part import double

def test_sound(): assert double(2) == 4
def test_blind(): assert double(0) == 0
def test_never(): assert double(2) == 5
def test_raises(): assert {4: 1}[double(2)]
def test_skips(): pytest.skip("nothing to test with")
def test_hangs(): time.sleep(0 if double(2) == 4 else 600)

@pytest.fixture
def four(): assert double(2) == 4
def test_set_up(four): pass
"""
AT_IMPORT = """from fe_drivetrain.room.part import double

assert double(2) == 4
def test(): pass
"""


@pytest.fixture
def tiny(tmp_path: Path) -> Path:
    """A clone with one function, a loop that takes a constant from beside it, and some tests."""
    root = tmp_path / "clone"
    room, tests = root / "fe_drivetrain" / "room", root / "tests"
    for folder in (room, tests, root / "geometry", root / "cases"):
        folder.mkdir(parents=True)
    for folder in (room.parent, room):
        (folder / "__init__.py").touch()
    (room / "part.py").write_text("SIZE = 3\n\ndef double(x):\n    return 2 * x\n")
    (room / "loop.py").write_text(LOOP)
    (room / "other.py").write_text("from numba import njit\n")
    (root / "pyproject.toml").write_text("[tool.pytest.ini_options]\n")
    shutil.copy(ROOT / "tests" / "outcome_log.py", tests)
    (tests / "test_part.py").write_text(CHECKS)
    (tests / "test_import.py").write_text(AT_IMPORT)
    return root


def tripled(*tests: str) -> Fault:
    return Fault("three times", "room/part.py", "return 2 * x", "return 3 * x", tests)


def bench(root: Path, folder: Path, limit: float) -> Bench:
    folder.mkdir()
    return Bench(root, folder, limit)


def test_only_a_failed_check_is_a_catch(tiny: Path, tmp_path: Path) -> None:
    names = ("sound", "blind", "never", "raises", "skips", "set_up")
    at = {name: f"test_part.py::test_{name}" for name in names}
    full = {name: f"tests/{test}" for name, test in at.items()}
    patient = bench(tiny, tmp_path / "copies", limit=60.0)
    passing, others = controlled(patient, [tripled(*at.values(), "test_import.py")], 2, silent)
    sound = {full[name] for name in ("sound", "blind", "raises", "set_up")}
    assert passing == sound | {"tests/test_import.py::test"}
    assert others == {full["never"]: "assertion", full["skips"]: "skipped"}
    expected = {
        (at["sound"], at["raises"]): CAUGHT,
        (at["blind"], at["never"], at["skips"]): SURVIVES,
        (at["raises"],): RAISES,
        (at["set_up"],): RAISES,
        ("test_import.py",): RAISES,
    }
    found = {tests: patient.tried(tripled(*tests), passing) for tests in expected}
    assert {tests: tried.outcome for tests, tried in found.items()} == expected
    assert next(iter(found.values())).by == full["sound"]
    assert "2 * x" in (tiny / "fe_drivetrain" / "room" / "part.py").read_text()


def test_tests_that_do_not_end_are_no_catch(tiny: Path, tmp_path: Path) -> None:
    hanging = tripled("test_part.py::test_hangs")
    tried = bench(tiny, tmp_path / "copies", limit=2.0).tried(hanging, {"tests/test_part.py"})
    assert tried.outcome == HANGS
    assert not tried.caught


def test_loops_that_hold_a_fault_are_compiled_again(tiny: Path, tmp_path: Path) -> None:
    kept = tiny / "fe_drivetrain" / "room" / "__pycache__"
    kept.mkdir()
    for module in ("part", "loop", "other"):
        (kept / f"{module}.cpython-311.pyc").touch()
        (kept / f"{module}.f-1.py311.nbi").touch()
    base, folder = tmp_path / "base", tmp_path / "copy"
    base.mkdir()
    copy_of(tiny, base)
    with_fault(base, folder, Fault("size", "room/part.py", "SIZE = 3", "SIZE = 4", ()))
    left = {path.name for path in (folder / "fe_drivetrain" / "room" / "__pycache__").iterdir()}
    assert "part.cpython-311.pyc" not in left
    assert "loop.f-1.py311.nbi" not in left  # it has the constant in it
    assert {"loop.cpython-311.pyc", "other.f-1.py311.nbi"} <= left
    # the copy that it was linked from is as it was
    assert "SIZE = 3" in (base / "fe_drivetrain" / "room" / "part.py").read_text()
    assert (base / "fe_drivetrain" / "room" / "__pycache__" / "loop.f-1.py311.nbi").exists()
    assert os.stat(kept / "part.cpython-311.pyc").st_nlink == 1


def test_a_row_with_another_key_is_refused(tmp_path: Path) -> None:
    rows = tmp_path / "tests" / "mutations"
    rows.mkdir(parents=True)
    (rows / "a.yaml").write_text("- {what: w, file: f, line: l, fault: g, test: t}\n")
    with pytest.raises(InputError, match="no fault"):
        faults_of(tmp_path)


def test_an_installed_wheel_has_no_tests(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    elsewhere = tmp_path / "site" / "cases" / "verification" / "mutation_rows.py"
    monkeypatch.setattr(mutation_rows, "__file__", str(elsewhere))
    with pytest.raises(MissingToolError, match="installed wheel"):
        clone()


@from_clone
def test_a_clone_without_what_its_tests_need_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(mutation_rows, "NEEDED", ("pytest", "no_such_package"))
    with pytest.raises(MissingToolError, match=r"need no_such_package: .*\[test\]"):
        clone()
