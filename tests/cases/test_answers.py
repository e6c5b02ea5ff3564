"""What every case answers, in its quick form: a verdict and figures that keep the rules."""

import pytest
from answer_rules import broken_rules
from conftest import QuickRun

from fe_drivetrain.report.suite.case import all_cases


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.quick(name)) for name in all_cases()]
)
def test_an_answer_keeps_the_rules(every_quick_run: QuickRun, name: str) -> None:
    assert broken_rules(every_quick_run(name)) == []
