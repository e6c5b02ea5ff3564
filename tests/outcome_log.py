"""A plugin of pytest that writes what became of each test; the mutation case reads it.

``pytest -p outcome_log --outcome-log FILE [--until-assertion] ...``
"""

import json
from collections.abc import Generator
from pathlib import Path

import pytest


def pytest_addoption(parser: pytest.Parser) -> None:
    """Declare where the outcomes go, and whether the first failed assertion ends the run."""
    parser.addoption("--outcome-log", type=Path)
    parser.addoption("--until-assertion", action="store_true")


def is_assertion(error: BaseException) -> bool:
    """Whether a check said no: an assertion, ``pytest.fail``, or a group that holds one."""
    if isinstance(error, BaseExceptionGroup):
        return any(is_assertion(one) for one in error.exceptions)
    return isinstance(error, (AssertionError, pytest.fail.Exception))


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(
    item: pytest.Item, call: pytest.CallInfo[None]
) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Add a line for each phase of each test: passed, skipped, assertion, or another error."""
    report = yield
    outcome = str(report.outcome)
    if report.failed:
        assert call.excinfo is not None
        check = report.when == "call" and is_assertion(call.excinfo.value)
        outcome = "assertion" if check else call.excinfo.typename
    line = {"test": item.nodeid, "when": report.when, "outcome": outcome}
    with item.config.getoption("--outcome-log").open("a", encoding="utf-8") as stream:
        stream.write(json.dumps(line) + "\n")
    if outcome == "assertion" and item.config.getoption("--until-assertion"):
        item.session.shouldstop = "a check has failed"
    return report
