"""What changed between two runs, and what cannot be compared."""

import json
from collections.abc import Callable
from pathlib import Path

import pytest
from tiny_case import Result, count

from fe_drivetrain.report.suite.case import Case
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.report.suite.run_comparison import compare_runs
from fe_drivetrain.report.suite.suite import run_cases

CASE = Case("group/tiny", "A tiny case", "nobody", count)


def test_a_quick_run_against_a_full_one_is_named(
    invoke: Callable[..., Result], tmp_path: Path
) -> None:
    for name, quick in (("full", False), ("again", False), ("quick", True)):
        run_cases([CASE], tmp_path / name, quick=quick)
    (change,) = compare_runs(tmp_path / "full", tmp_path / "quick").changes
    assert (change.kind, change.before, change.after) == ("mode", "full", "quick")
    assert compare_runs(tmp_path / "full", tmp_path / "again").changes == []
    status, out, _ = invoke("compare-runs", "quick", "full")
    assert status == 0
    assert out.startswith("quick against full: 1 of 1 cases ran quick in one run and not")
    assert "against" not in invoke("compare-runs", "full", "again")[1]


def said(page: Page) -> None:
    """An answer, which every case has."""
    page.answer("Is it right?", "It is.", [])


def answers(run: Run, page: Page) -> None:
    page.found("stiffness [MN m/rad]", 579.0 * float(run.settings["k"]))
    page.answer("How stiff?", "So stiff.", [page.judged("stiffness")])


@pytest.mark.parametrize(
    ("factor", "kinds"), [(1.0, []), (1.0 + 1e-12, ["rounding"]), (1.01, ["value"])]
)
def test_answers_that_moved_are_named(tmp_path: Path, factor: float, kinds: list[str]) -> None:
    case = Case("group/tiny", "A tiny case", "nobody", answers, settings=("k",))
    run_cases([case], tmp_path / "one", {"k": 1.0})
    run_cases([case], tmp_path / "other", {"k": factor})
    changes = compare_runs(tmp_path / "one", tmp_path / "other").changes
    assert [change.kind for change in changes] == kinds
    assert all(change.what == "stiffness" for change in changes)


def judged(run: Run, page: Page) -> None:
    """Four checks, as the settings name, bound and compute the first, and allow the last."""
    page.at_most(
        str(run.settings.get("name", "largest error of the stiffness")),
        float(run.settings.get("error", 0.02)),
        bound=float(run.settings.get("bound", 0.05)),
        why="r",
        source="s",
    )
    for quantity in ("asymmetry", "residual"):
        page.vanishes(quantity, 0.0, within=1e-9, why="r", source="s")
    within = float(run.settings.get("within", 1e-12))
    page.equals("order", 4.0, 4.0, within=within, why="r", source="s")
    page.answer("Is it right?", "It is.", [page.judged("order")])
    page.data("numbers", [2.5 * (1.0 + float(run.settings.get("rounding", 0.0))), 4.0])


JUDGED = Case(
    "group/tiny",
    "A tiny case",
    "nobody",
    judged,
    settings=("name", "error", "bound", "rounding", "within"),
)


@pytest.mark.parametrize(
    ("settings", "kinds"),
    [
        ({"bound": 0.06}, ["looser"]),
        ({"bound": 0.04}, ["tighter"]),
        ({"within": 5e-12}, ["looser"]),
        ({"error": 0.03}, ["value"]),
        ({"error": 0.06}, ["verdict", "value"]),
        ({"name": "greatest error"}, ["renamed"]),  # by its value
        ({"name": "largest error of a stiffness", "error": 0.03}, ["value", "renamed"]),
        ({"name": "mass", "error": 0.03}, ["lost check", "new check"]),
    ],
)
def test_what_became_of_a_check(
    tmp_path: Path, settings: dict[str, float | str], kinds: list[str]
) -> None:
    run_cases([JUDGED], tmp_path / "one")
    run_cases([JUDGED], tmp_path / "other", settings)
    found = compare_runs(tmp_path / "one", tmp_path / "other")
    assert [change.kind for change in found.changes] == kinds
    assert found.equal == 3


def test_a_check_that_allows_the_same_in_other_words_has_not_changed(tmp_path: Path) -> None:
    """200 to 5 % is from 190 to 210; to 5 is from 195 to 205, which is less."""

    def relative(run: Run, page: Page) -> None:
        page.equals("load", 200.0, 200.0, within=0.05, why="r", source="s")
        said(page)

    def between(run: Run, page: Page) -> None:
        page.between("load", 200.0, 190.0, 210.0, why="r", source="s")
        said(page)

    def in_the_unit(run: Run, page: Page) -> None:
        page.equals("load", 200.0, 200.0, within=5.0, relative=False, why="r", source="s")
        said(page)

    for work in (relative, between, in_the_unit):
        run_cases([Case("group/tiny", "A tiny case", "nobody", work)], tmp_path / work.__name__)
    same = compare_runs(tmp_path / "relative", tmp_path / "between")
    assert [change.kind for change in same.changes] == []
    less = compare_runs(tmp_path / "relative", tmp_path / "in_the_unit")
    assert [change.kind for change in less.changes] == ["tighter"]


def test_a_check_that_moved_to_another_case_is_found_there(tmp_path: Path) -> None:
    def alone(run: Run, page: Page) -> None:
        page.vanishes("residual", 0.0, within=1e-9, why="r", source="s")
        said(page)

    run_cases([JUDGED, Case("group/alone", "Alone", "nobody", alone)], tmp_path / "other")
    run_cases([JUDGED], tmp_path / "one")
    file = tmp_path / "other/group/tiny/results.json"
    results = json.loads(file.read_text("utf-8"))
    del results["verdicts"][2]
    file.write_text(json.dumps(results), "utf-8")
    moved, new = compare_runs(tmp_path / "one", tmp_path / "other").changes
    assert (moved.kind, moved.case, moved.after) == ("moved", "group/tiny", "group/alone")
    assert (new.kind, new.case) == ("new case", "group/alone")


def test_a_changed_value_is_shown_beside_its_tolerance(
    invoke: Callable[..., Result], tmp_path: Path
) -> None:
    run_cases([JUDGED], tmp_path / "one")
    run_cases([JUDGED], tmp_path / "other", {"error": 0.03, "bound": 0.06})
    status, out, _ = invoke("compare-runs", "one", "other")
    assert status == 0
    assert "at most 0.05 -> at most 0.06" in out
    assert "0.02 -> 0.03 (3.3e-01 of it; 40 % -> 50 % of the tolerance)" in out


@pytest.mark.parametrize(("rounding", "near", "gone"), [(0.0, 0, 0), (1e-12, 1, 0), (0.1, 0, 1)])
def test_numbers_among_the_figures_are_found_again(
    tmp_path: Path, rounding: float, near: int, gone: int
) -> None:
    run_cases([JUDGED], tmp_path / "one")
    run_cases([JUDGED], tmp_path / "other", {"rounding": rounding})
    found = compare_runs(tmp_path / "one", tmp_path / "other")
    assert (found.numbers, found.near_numbers) == (2, near)
    assert [change.what for change in found.changes] == (
        [f"{gone} of 2 numbers are not there again"] if gone else []
    )


def test_results_that_do_not_say_whether_they_are_quick_count_as_neither(tmp_path: Path) -> None:
    for name in ("old", "new"):
        run_cases([CASE], tmp_path / name, quick=True)
    file = tmp_path / "old/group/tiny/results.json"
    old = json.loads(file.read_text("utf-8"))
    del old["environment"]["quick"]
    file.write_text(json.dumps(old | {"schema_version": 1}), "utf-8")
    assert compare_runs(tmp_path / "old", tmp_path / "new").changes == []
