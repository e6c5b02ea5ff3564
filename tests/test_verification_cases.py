"""The ladder of verification cases: it holds, it says what it should, and it catches a fault."""

from collections.abc import Mapping

import pytest

from fe_drivetrain.report.results import Results, read_results
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
