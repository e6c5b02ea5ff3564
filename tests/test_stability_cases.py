"""The stability atlas: every sweep runs, reaches a failure, and says what protects the user."""

from collections.abc import Mapping
from pathlib import Path

import pytest

from fe_drivetrain.report.results import Chart, Results, read_results
from fe_drivetrain.suite.case import find_cases
from fe_drivetrain.suite.suite import result_folder, run_cases

CASES = find_cases("stability")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("stability")


@pytest.fixture(scope="module")
def found(folder: Path) -> Mapping[str, Results | str]:
    """Results of every case by its name, or why there are none."""
    problems = run_cases(CASES, folder, quick=True)
    wrong = {name: p.message for name, p in problems.items() if not p.is_missing_tool}
    assert not wrong
    return {
        case.name: problems[case.name].message
        if case.name in problems
        else read_results(result_folder(folder, case) / "results.json")
        for case in CASES
    }


@pytest.mark.parametrize("name", [case.name for case in CASES])
def test_sweep_passes_and_says_where_its_method_fails(
    found: Mapping[str, Results | str], name: str
) -> None:
    results = found[name]
    if isinstance(results, str):
        pytest.skip(results)
    failed = [(v.quantity, v.computed, v.reference) for v in results.verdicts if not v.passed]
    assert not failed
    assert results.verdicts
    assert results.limits
    for limit in results.limits:
        assert limit.low is None or limit.high is None or limit.low <= limit.high, limit
    items = [item for section in results.sections for item in section.items]
    assert any(isinstance(item, Chart) for item in items)


def test_the_atlas_lists_every_limit(found: Mapping[str, Results | str], folder: Path) -> None:
    atlas = (folder / "atlas.html").read_text()
    for name, results in found.items():
        if not isinstance(results, str):
            assert f'href="{name}/report.html"' in atlas
    assert 'href="atlas.html"' in (folder / "index.html").read_text()
