"""What every case answers, in its quick form: a verdict and figures that keep the rules."""

import pytest
from answer_rules import broken_rules
from conftest import QUICK_VARIABLE, QuickRun
from test_cases import CASES
from test_consumer_cases import NEEDS
from test_waiting_cases import MEASURING

from fe_drivetrain.report.suite.case import all_cases

#: Cases that other tests run whole, too; all others only where their results are given.
RUN_BY_TESTS = {*CASES, *MEASURING, *NEEDS}


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.quick(name)) for name in all_cases()]
)
def test_an_answer_keeps_the_rules(quick_run: QuickRun, name: str) -> None:
    if not quick_run.given and name not in RUN_BY_TESTS:
        pytest.skip(f"it takes long, and {QUICK_VARIABLE} names no folder of results")
    results = quick_run(name)
    assert broken_rules(results) == []
