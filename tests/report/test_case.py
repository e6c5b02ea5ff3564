"""A result folder appears whole or not at all, and says what was computed."""

import os
import shlex
from collections.abc import Callable
from functools import partial
from importlib import import_module
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from tiny_case import check_one

from fe_drivetrain.command_line.settings import parse_settings
from fe_drivetrain.common import folders
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.manifest import MANIFEST
from fe_drivetrain.pages.advise import tornado
from fe_drivetrain.report.charts import trace
from fe_drivetrain.report.headline import headline
from fe_drivetrain.report.history import FILE
from fe_drivetrain.report.results import Chart, Image, Table, Text, read_results
from fe_drivetrain.report.suite import case as case_module
from fe_drivetrain.report.suite.case import Case, find_cases
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.result_folders import run_case
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.shafts.fidelity.ablation import Effect
from fe_drivetrain.studies.level_advice import AdviseResult

Work = Callable[[Run, Page], None]


def tiny(run: Run, page: Page) -> None:
    with run.step("count"):
        (run.folder / "one.txt").write_text("1")
    fill(run, page)


def fill(run: Run, page: Page) -> None:
    """A page with a check and an assumed value, and no file."""
    page.say("The answer is one.")
    check_one(page, unit="m")
    page.assume("two", 2, "-", "assumed")


def showing(*items: Text | Table | Chart | Image) -> Work:
    """Work that shows these in a section."""

    def work(run: Run, page: Page) -> None:
        page.section("Only one")
        page.add(*items)
        fill(run, page)

    return work


def tiny_case(work: Work = tiny) -> Case:
    return Case("group/tiny", "A tiny case", "nobody", work, settings=("a", "k"))


def contents(folder: Path) -> dict[str, bytes]:
    """Every file at or below a folder, hidden ones included."""
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file()
    }


def test_run_writes_what_it_returns(tmp_path: Path) -> None:
    out = tmp_path / "new" / "folder"
    results = run_case(tiny_case(), out, {"a": [1, "b"]})
    assert read_results(out / "results.json") == results
    assert results.environment.settings == {"a": [1, "b"]}
    assert set(contents(out)) == {MANIFEST, FILE, "results.json", "report.html", "one.txt"}
    assert [path.name for path in out.parent.iterdir()] == ["folder"]


def answering(run: Run, page: Page) -> None:
    page.found("stiffness [MN m/rad]", 579.2, 141.0)
    page.found("ratio", 2.0)
    page.scene = "shaft: {}"
    check_one(page)
    page.answer("How stiff?", "It is 579.", [page.judged("stiffness")])


def test_a_case_states_its_answers_and_what_runs_it_again(tmp_path: Path) -> None:
    settings = {"a": "two words", "k": [1, "b"]}
    results = run_case(tiny_case(answering), tmp_path / "out", settings, quick=True)
    stiffness, ratio = results.answers
    assert (stiffness.quantity, stiffness.unit) == ("stiffness", "MN m/rad")
    assert (stiffness.computed, stiffness.band) == (579.2, 141.0)
    assert (ratio.quantity, ratio.unit, ratio.band) == ("ratio", "", None)
    assert headline(results) == stiffness
    assert results.scene == "shaft: {}"
    typed = shlex.split(results.environment.command)
    assert typed[:4] == ["fe-drivetrain", "run", "group/tiny", "--quick"]
    pairs = [word.partition("=") for word in typed[5::2]]
    assert {key: parse_settings([f"{key}={value}"])[key] for key, _, value in pairs} == settings


def test_every_kind_of_item_survives_the_round_trip(tmp_path: Path) -> None:
    items = (
        Text(text="text with <b>, \u2028 and \\u0000 in it"),
        Table(caption="c", columns=["a", "b"], rows=[[1, 2.5], ["x", None], [True, 1e-300]]),
        Chart(caption="c", figure={"data": [{"y": [1, 2.5, None]}], "layout": {}}),
    )
    run_case(tiny_case(showing(*items)), tmp_path / "out")
    (section,) = read_results(tmp_path / "out" / "results.json").sections
    assert tuple(section.items) == items


def test_a_chart_of_one_point_is_a_sentence() -> None:
    page = Page()
    page.chart("Mass of all", [trace("a", [0.5], [12.0])], "height [m]", "mass [kg]")
    page.chart("None", [trace("a", [], [])], "height [m]", "mass [kg]")
    one, none = page.sections[0].items
    assert one.text == "Mass of all: mass [kg] 12 at height [m] 0.5, the only point of this run."
    assert none.text == "None: there is nothing to show in this run."


def test_details_that_change_nothing_have_no_empty_bars() -> None:
    def result(*effects: Effect) -> AdviseResult:
        advice: Any = SimpleNamespace(quantity=SimpleNamespace(name="hub.Fz"), tolerance=0.05)
        scene: Any = None
        page = Page()
        page.answer("Which details matter?", "None of 2 details matters.", [], hero="tornado")
        return AdviseResult(
            drivetrain=scene, advice=advice, effects=effects, effects_level=1, **page.frozen({})
        )

    items = tornado(result(Effect("bore", 0.0), Effect("rings", 0.0))).items
    assert [item.kind for item in items] == ["text"]
    said: Any = items[0]
    assert said.text == (
        "No detail changes hub.Fz at level 1 with housings as springs: bore, rings."
    )
    kinds = [item.kind for item in tornado(result(Effect("bore", 0.1))).items]
    assert kinds == ["chart", "table"]


def test_a_nan_is_a_failed_check_and_not_an_unreadable_file(tmp_path: Path) -> None:
    case = tiny_case(lambda run, page: check_one(page, float("nan")))
    assert not run_case(case, tmp_path / "out").passed
    (verdict,) = read_results(tmp_path / "out" / "results.json").verdicts
    assert verdict.computed != verdict.computed
    assert not verdict.passed


def test_steps_are_reported_and_timed(tmp_path: Path) -> None:
    seen: list[str] = []
    results = run_case(tiny_case(), tmp_path / "out", report=seen.append)
    assert seen == ["count", "report"]
    assert list(results.times) == ["count"]
    assert results.times["count"] > 0


def test_quick_and_settings_reach_the_case(tmp_path: Path) -> None:
    got: list[Run] = []

    def work(run: Run, page: Page) -> None:
        got.append(run)
        fill(run, page)

    run_case(tiny_case(work), tmp_path / "out", {"k": 3}, quick=True)
    assert got[0].quick
    assert got[0].settings == {"k": 3}


@pytest.mark.parametrize("error", [RuntimeError, KeyboardInterrupt, SystemExit, InputError])
def test_a_run_that_fails_leaves_the_earlier_results(
    tmp_path: Path, error: type[BaseException]
) -> None:
    run_case(tiny_case(), tmp_path / "out")
    before = contents(tmp_path)

    def work(run: Run, page: Page) -> None:
        (run.folder / "half.txt").write_text("written")
        raise error("midway")

    with pytest.raises(error, match="midway"):
        run_case(tiny_case(work), tmp_path / "out")
    assert contents(tmp_path) == before
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


def test_a_page_that_fails_leaves_the_earlier_results(tmp_path: Path) -> None:
    run_case(tiny_case(), tmp_path / "out")
    before = contents(tmp_path)
    image = Image(caption="not there", file="missing.png")
    with pytest.raises(InputError, match=r"missing\.png"):
        run_case(tiny_case(showing(image)), tmp_path / "out")
    assert contents(tmp_path) == before


def test_ctrl_c_between_the_two_renames_puts_the_earlier_results_back(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    run_case(tiny_case(), tmp_path / "out")
    before = contents(tmp_path)
    rename, calls = os.rename, []

    def interrupted(source: object, target: object) -> None:
        calls.append(target)
        if len(calls) == 2:
            raise KeyboardInterrupt
        rename(source, target)  # type: ignore[arg-type]

    # as where the system cannot exchange two folders in one go
    monkeypatch.setattr(folders, "_exchange", lambda first, second: False)
    monkeypatch.setattr(os, "rename", interrupted)
    with pytest.raises(KeyboardInterrupt):
        run_case(tiny_case(), tmp_path / "out")
    assert contents(tmp_path) == before


def test_a_new_run_replaces_the_whole_folder(tmp_path: Path) -> None:
    run_case(tiny_case(), tmp_path / "out")
    run_case(tiny_case(fill), tmp_path / "out")
    assert set(contents(tmp_path / "out")) == {MANIFEST, FILE, "results.json", "report.html"}


def test_an_empty_folder_is_used_and_a_foreign_one_refused(tmp_path: Path) -> None:
    out = tmp_path / "out"
    out.mkdir()
    run_case(tiny_case(), out)
    foreign = tmp_path / "thesis"
    foreign.mkdir()
    (foreign / "chapter.tex").write_text("years of work")
    with pytest.raises(InputError, match="not results"):
        run_case(tiny_case(), foreign)
    assert contents(foreign) == {"chapter.tex": b"years of work"}


def test_a_file_or_a_folder_below_a_file_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "file"
    file.write_text("x")
    for out in (file, file / "below", file / "far" / "below"):
        with pytest.raises(InputError, match="folder"):
            run_case(tiny_case(), out)
    assert contents(tmp_path) == {"file": b"x"}


def test_a_case_is_found_by_its_name_or_its_last_part(monkeypatch: pytest.MonkeyPatch) -> None:
    names = ("a/one", "a/two", "b/two")
    cases = {name: Case(name, "t", "s", fill) for name in names}
    monkeypatch.setattr(case_module, "all_cases", lambda: cases)
    assert [case.name for case in find_cases("a/two")] == ["a/two"]
    assert [case.name for case in find_cases("one")] == ["a/one"]
    assert [case.name for case in find_cases("a")] == ["a/one", "a/two"]
    with pytest.raises(InputError, match="ambiguous"):
        find_cases("two")
    with pytest.raises(InputError, match=r"unknown.*fe-drivetrain list"):
        find_cases("three")


def test_every_case_of_the_package_is_named_after_its_place() -> None:
    cases = case_module.all_cases()
    assert cases
    for name, found in cases.items():
        assert found.name == name
        group, _, last = name.partition("/")
        assert isinstance(found.run, partial)
        module, function = found.run.args
        assert callable(getattr(import_module(module), function))
        place = f"fe_drivetrain.cases.{group}"
        script = module.rpartition(".")[2]
        assert module == f"{place}.{script}"
        # of a table, in any script of the group; else of another name only where a folder has it
        if "row" not in found.run.keywords and script != last:
            assert hasattr(import_module(f"{place}.{last}"), "__path__")


def test_an_exponent_is_fitted_and_judged_with_its_band() -> None:
    page = Page()
    x = np.array([1.0, 2.0, 4.0, 8.0])
    error = 3.0 * x**-2.0 * np.array([1.02, 0.99, 1.01, 0.98])
    beyond = np.append(error, 1e-30)  # round-off, outside what is fitted
    found = page.exponent(
        "error over steps, exponent",
        np.append(x, 16.0),
        beyond,
        -2.0,
        within=0.05,
        between=(1e-3, 10.0),
        why="scatter",
        source="second order",
    )
    page.exponent("the same", x, error, -1.0, within=0.05, why="scatter", source="first order")
    right, wrong = page.checks
    assert found == right.computed == pytest.approx(np.polyfit(np.log(x), np.log(error), 1)[0])
    assert (right.passed, wrong.passed) == (True, False)
    assert (right.measure, right.tolerance, right.relative) == ("order", 0.05, True)
    assert right.band is not None
    assert 0.0 < right.band < 0.1
