"""Every case in its quick form, from a run of them all: its checks pass, and it says why."""

import pytest
from conftest import QuickRun

from fe_drivetrain.report.index import write_index
from fe_drivetrain.report.results import Chart
from fe_drivetrain.report.suite.case import all_cases

#: Cases that other tests run: on a scene of their own, or with another program beside them.
ELSEWHERE = (
    "bearing/flexible_rings_calculix",
    "export/",
    "performance/",
    "verification/calculix_",
)

#: Cases of main_bearing that need the whole scene; the others are tested on a short shaft.
WHOLE = ("main_bearing/calibrate_housing", "main_bearing/secant_stiffness")

CASES = [
    name
    for name in all_cases()
    if not name.startswith((*ELSEWHERE, "main_bearing/")) or name in WHOLE
]


@pytest.mark.parametrize("name", [pytest.param(n, marks=pytest.mark.quick(n)) for n in CASES])
def test_its_checks_pass_and_say_why(every_quick_run: QuickRun, name: str) -> None:
    results = every_quick_run(name)
    failed = [(v.quantity, v.computed, v.reference) for v in results.verdicts if not v.passed]
    assert not failed
    assert results.verdicts
    for verdict in results.verdicts:
        assert verdict.source.strip(), verdict.quantity
        assert verdict.reason.strip(), verdict.quantity
        assert verdict.band is None or verdict.band >= 0.0


STABILITY = [name for name in CASES if name.startswith("stability/")]


@pytest.mark.parametrize("name", [pytest.param(n, marks=pytest.mark.quick(n)) for n in STABILITY])
def test_a_sweep_says_where_its_method_fails(every_quick_run: QuickRun, name: str) -> None:
    results = every_quick_run(name)
    assert results.limits
    for limit in results.limits:
        assert limit.low is None or limit.high is None or limit.low <= limit.high, limit
    items = [item for section in results.sections for item in section.items]
    assert any(isinstance(item, Chart) for item in items)


@pytest.mark.quick(*STABILITY)
def test_the_atlas_lists_every_limit(every_quick_run: QuickRun) -> None:
    for name in STABILITY:
        every_quick_run(name)
    write_index(every_quick_run.folder)
    atlas = (every_quick_run.folder / "atlas.html").read_text()
    for name in STABILITY:
        assert f'href="{name}/report.html"' in atlas
    assert 'href="atlas.html"' in (every_quick_run.folder / "index.html").read_text()


LADDERS = ("fidelity/main_bearing_spherical", "fidelity/housing_on_bedplate")


@pytest.mark.parametrize("name", [pytest.param(n, marks=pytest.mark.quick(n)) for n in LADDERS])
def test_a_level_is_found_that_is_enough(every_quick_run: QuickRun, name: str) -> None:
    levels = every_quick_run(name).figures["levels"]
    assert [level["level"] for level in levels] == [0, 1, 1, 2, 3, 4]
    assert levels[-1]["error against the last level [-]"] == 0.0
    assert levels[1]["time [s]"] < levels[-1]["time [s]"]
