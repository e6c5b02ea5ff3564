"""The ladder of verification cases: it holds, it says what it should, and it catches a fault."""

from collections.abc import Mapping
from pathlib import Path

import pytest
from typer.testing import CliRunner

from fe_drivetrain.commands.app import app
from fe_drivetrain.commands.terminal import FAILED, PASSED
from fe_drivetrain.report.results import Results, read_results
from fe_drivetrain.solve import solid
from fe_drivetrain.suite.case import find_cases
from fe_drivetrain.suite.suite import result_folder, run_cases

CASES = find_cases("verification")


@pytest.fixture(scope="module")
def found(tmp_path_factory: pytest.TempPathFactory) -> Mapping[str, Results | str]:
    """Results of every case by its name, or why there are none."""
    folder = tmp_path_factory.mktemp("verification")
    problems = run_cases(CASES, folder, quick=True)
    wrong = {name: p.message for name, p in problems.items() if not p.is_missing_tool}
    assert not wrong
    return {
        case.name: problems[case.name].message
        if case.name in problems
        else read_results(result_folder(folder, case) / "results.json")
        for case in CASES
    }


def test_the_ladder_has_its_rungs() -> None:
    assert len(CASES) >= 30


@pytest.mark.parametrize("name", [case.name for case in CASES])
def test_case_passes_and_says_what_it_should(found: Mapping[str, Results | str], name: str) -> None:
    results = found[name]
    if isinstance(results, str):
        pytest.skip(results)
    failed = [(v.quantity, v.computed, v.reference) for v in results.verdicts if not v.passed]
    assert not failed
    assert results.verdicts
    for verdict in results.verdicts:
        assert verdict.source.strip(), verdict.quantity
        assert verdict.reason.strip(), verdict.quantity
        assert verdict.band is None or verdict.band >= 0.0


def test_a_modulus_that_is_five_per_cent_wrong_is_caught(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The solids get another modulus than the closed forms: the run says so, and exits with 1."""
    right = solid.solve_solid.__defaults__
    assert right is not None

    def wrong(points, cells, lame, *rest):  # type: ignore[no-untyped-def]
        return solid.assemble(points, cells, tuple(1.05 * constant for constant in lame), *rest)

    changed = tuple(wrong if value is solid.assemble else value for value in right)
    assert changed != right
    monkeypatch.setattr(solid.solve_solid, "__defaults__", changed)
    arguments = ["run", "verification/thick_cylinder", "--quick", "--out", str(tmp_path / "out")]
    outcome = CliRunner().invoke(app, [*arguments, "--junit", str(tmp_path / "out.xml")])
    assert outcome.exit_code == FAILED
    assert "FAIL" in outcome.stdout
    assert "<failure" in (tmp_path / "out.xml").read_text()
    monkeypatch.undo()
    assert CliRunner().invoke(app, arguments).exit_code == PASSED
