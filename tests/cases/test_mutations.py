"""One number wrong on purpose: the suite notices, where the same without the fault passes."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from mutated import FAULTS

from fe_drivetrain.command_line.terminal import FAILED
from fe_drivetrain.report.results import read_results

#: The case that shall catch each fault, and the check of it that must.
CASES = {
    "modulus": ("verification/thick_cylinder", "displacement"),
    "poisson_ratio": ("verification/pure_bending", "sideways"),
    "weight_upward": ("verification/self_weight", "sag"),
    "lever_arm": ("verification/overhung", "deflection"),
}


def run_with(fault: str, *arguments: str) -> subprocess.CompletedProcess[str]:
    root = Path(__file__).parents[2]
    return subprocess.run(
        [sys.executable, "tests/mutated.py", fault, "fe-drivetrain", "run", *arguments],
        cwd=root,
        env=os.environ | {"PYTHONSAFEPATH": ""},
        capture_output=True,
        text=True,
    )


def test_each_fault_has_a_case_that_shall_catch_it() -> None:
    assert CASES.keys() | {"none"} == FAULTS.keys()


def test_the_same_cases_pass_without_a_fault(tmp_path: Path) -> None:
    names = [name for name, _ in CASES.values()]
    done = run_with("none", *names, "--quick", "--out", str(tmp_path / "out"))
    assert done.returncode == 0, done.stdout + done.stderr
    assert "FAIL" not in done.stdout


@pytest.mark.parametrize("fault", CASES)
def test_a_case_catches_a_wrong_number(tmp_path: Path, fault: str) -> None:
    name, check = CASES[fault]
    out, junit = tmp_path / "out", tmp_path / "verdicts.xml"
    done = run_with(fault, name, "--quick", "--out", str(out), "--junit", str(junit))
    assert done.returncode == FAILED, done.stderr
    failed = [v.quantity for v in read_results(out / "results.json").verdicts if not v.passed]
    assert any(check in quantity for quantity in failed), failed
    assert "FAIL" in done.stdout
    assert "<failure" in junit.read_text()
