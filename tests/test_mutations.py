"""One number wrong on purpose: the suite notices, where the same without the fault passes."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from mutated import FAULTS

from fe_drivetrain.commands.terminal import FAILED
from fe_drivetrain.report.results import read_results

#: The case that shall catch each fault, and the check of it that must.
CASES = {
    "modulus": ("verification/thick_cylinder", "displacement"),
    "poisson_ratio": ("verification/pure_bending", "sideways"),
    "weight_upward": ("verification/self_weight", "sag"),
    "lever_arm": ("verification/overhung", "deflection"),
}

#: The tests that shall, where no short case has the number in it.
TESTS = {
    "spring": "tests/test_joints.py::test_a_spring_carries_what_stretches_it",
    "unit": "tests/test_hub_loads.py",
}


def run_with(fault: str, *arguments: str) -> subprocess.CompletedProcess[str]:
    root = Path(__file__).parents[1]
    return subprocess.run(
        [sys.executable, "tests/mutated.py", fault, *arguments],
        cwd=root,
        env=os.environ | {"PYTHONSAFEPATH": ""},
        capture_output=True,
        text=True,
    )


def test_each_fault_has_somebody_who_shall_catch_it() -> None:
    assert CASES.keys() | TESTS.keys() == FAULTS.keys()


@pytest.mark.parametrize("fault", CASES)
def test_a_case_catches_a_wrong_number(tmp_path: Path, fault: str) -> None:
    name, check = CASES[fault]
    out, junit = tmp_path / "out", tmp_path / "verdicts.xml"
    arguments = ["run", name, "--quick", "--out", str(out), "--junit", str(junit)]
    done = run_with(fault, "fe-drivetrain", *arguments)
    assert done.returncode == FAILED, done.stderr
    failed = [v.quantity for v in read_results(out / "results.json").verdicts if not v.passed]
    assert any(check in quantity for quantity in failed), failed
    assert "FAIL" in done.stdout
    assert "<failure" in junit.read_text()


@pytest.mark.parametrize("fault", TESTS)
def test_a_test_catches_a_wrong_number(fault: str) -> None:
    done = run_with(fault, "pytest", "-q", "-x", "-p", "no:cacheprovider", TESTS[fault])
    assert done.returncode == pytest.ExitCode.TESTS_FAILED, done.stdout
