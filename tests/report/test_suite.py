"""Several cases in one go: each whole or not at all, measuring ones alone, and a page of all."""

import logging
import os
import re
import signal
import sqlite3
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import pytest
from suite_cases import (
    a_case,
    count,
    fault,
    last,
    miss,
    need_a_tool,
    off,
    read_the_index,
    refuse,
)

from fe_drivetrain.command_line.answer_text import outcome_text
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.manifest import MANIFEST, manifest_of
from fe_drivetrain.common.progress import OVERALL
from fe_drivetrain.common.threads import CORES_VARIABLE
from fe_drivetrain.report.history import FILE
from fe_drivetrain.report.index import write_index
from fe_drivetrain.report.junit import write_junit
from fe_drivetrain.report.results import read_results
from fe_drivetrain.report.suite.case import BESIDE_OTHERS, Case
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.result_folders import run_case
from fe_drivetrain.report.suite.resuming import finished_cases
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.report.suite.suite import run_cases


@pytest.fixture(params=["1", "2"])
def number_of_cores(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.setenv(CORES_VARIABLE, request.param)
    return str(request.param)


def test_each_case_has_its_results_and_all_are_listed(tmp_path: Path, number_of_cores: str) -> None:
    cases = [a_case("a/one", count), a_case("a/miss", miss), a_case("b/three", count)]
    assert run_cases(cases, tmp_path, {"k": 1}) == {}
    for case in cases:
        results = read_results(tmp_path / case.name / "results.json")
        assert results.environment.settings == {"k": 1}
        assert (tmp_path / case.name / "report.html").is_file()
    page = (tmp_path / "index.html").read_text()
    assert "2 of 3 cases pass" in page
    assert re.findall(r'href="([^"]*\.html)"', page) == [
        "checks.html",
        *(f"{name}/report.html" for name in ("a/miss", "a/one", "b/three")),
    ]
    assert "Title of &lt;a/miss&gt;" in page
    # times add up to what passed
    assert page.count('data-value="1.25">1.25</td>') == 3
    assert re.findall('<tr class="[^"]*" data-state="([^"]*)"', page) == ["fail", "pass", "pass"]
    pages = ["checks.html", MANIFEST, "history.sqlite", "index.html"]
    assert sorted(os.listdir(tmp_path)) == ["a", "b", *pages]
    assert sorted(os.listdir(tmp_path / "a")) == ["miss", "one"]


def test_a_case_that_cannot_run_keeps_no_other_from_running(
    tmp_path: Path, number_of_cores: str, capfd: pytest.CaptureFixture[str]
) -> None:
    cases = [a_case("a/refuse", refuse), a_case("a/fault", fault), a_case("a/one", count)]
    problems = run_cases(cases, tmp_path)
    assert problems["a/refuse"].message == "shaft: length is -1 <m>: give a length"
    assert "ZeroDivisionError" in problems["a/fault"].message
    assert list(problems) == ["a/refuse", "a/fault"] or number_of_cores == "2"
    assert "in fault" in capfd.readouterr().err  # a fault of ours can be found
    page = (tmp_path / "index.html").read_text()
    assert "1 of 3 cases passes" not in page
    assert "1 of 3 cases pass" in page
    assert "shaft: length is -1 &lt;m&gt;: give a length" in page
    assert sorted(os.listdir(tmp_path / "a")) == ["one"]


def test_a_case_without_its_tool_is_skipped_and_none_fails_for_it(tmp_path: Path) -> None:
    problems = run_cases([a_case("a/tool", need_a_tool), a_case("a/one", count)], tmp_path)
    assert problems["a/tool"].state == "skipped"
    page = (tmp_path / "index.html").read_text()
    assert "1 of 1 case passes, 1 skipped" in page
    assert "apt-get install calculix-ccx" in page


def test_bias_and_scatter_of_all_stand_on_the_front_page(tmp_path: Path) -> None:
    """Errors of +25 % and -25 % of stiffness: no bias, a scatter of 35.4 %."""
    run_cases([a_case("a/off", off)], tmp_path)
    page = (tmp_path / "index.html").read_text()
    row = page[page.index('<th scope="row">stiffness</th>') :].partition("</tr>")[0]
    assert re.findall('<td class="number">([^<]*)</td>', row) == ["2", "0", "35.4", "25"]
    assert "±5" in (tmp_path / "checks.html").read_text()  # the band of each


def test_earlier_results_stay_where_a_case_cannot_run(tmp_path: Path) -> None:
    run_cases([a_case("a/one", count)], tmp_path)
    before = (tmp_path / "a/one/results.json").read_bytes()
    assert set(run_cases([a_case("a/one", refuse)], tmp_path)) == {"a/one"}
    assert (tmp_path / "a/one/results.json").read_bytes() == before
    assert "0 of 1 case passes" in (tmp_path / "index.html").read_text()


def test_a_case_run_by_itself_is_listed_with_those_that_ran_before(tmp_path: Path) -> None:
    first, second = a_case("g/first", count), a_case("g/second", refuse)
    run_cases([first, second], tmp_path)
    run_case(replace(first, run=miss), tmp_path / "g/first")
    page = (tmp_path / "index.html").read_text()
    assert re.findall(r'data-state="(.*?)" data-group', page) == ["fail", "failed"]
    assert "length is -1 &lt;m&gt;" in page  # of the run before: there are no results still
    assert 'href="../../index.html"' in (tmp_path / "g/first/report.html").read_text()
    with pytest.raises(InputError):
        run_case(second, tmp_path / "g/second")
    assert "length is -1 &lt;m&gt;" in (tmp_path / "index.html").read_text()
    run_case(replace(second, run=miss), tmp_path / "g/second")
    assert not (tmp_path / "problems.json").exists()
    run_cases([replace(first, run=fault)], tmp_path)
    page = (tmp_path / "index.html").read_text()
    assert re.findall(r'data-state="(.*?)" data-group', page) == ["fail", "failed"]


def test_a_case_that_runs_elsewhere_is_on_no_list(tmp_path: Path) -> None:
    run_case(a_case("g/first", miss), tmp_path / "mine")
    assert not list(tmp_path.glob("**/index.html"))


def test_measuring_cases_run_alone_in_processes_of_their_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(CORES_VARIABLE, "2")
    names = [f"a/beside{k}" for k in range(3)] + [f"b/alone{k}" for k in range(2)]
    cases = [a_case(name, count, alone=name.startswith("b/")) for name in reversed(names)]
    assert run_cases(cases, tmp_path) == {}
    found = {n: read_results(tmp_path / n / "results.json").figures for n in names}
    assert len({figures["pid"] for name, figures in found.items() if "alone" in name}) == 2
    assert os.getpid() not in {figures["pid"] for figures in found.values()}
    for name, figures in found.items():
        assert figures["kept"] == ("beside" in name)
        for other, others in found.items():
            if other != name and "alone" in name:
                assert figures["ended"] <= others["began"] or others["ended"] <= figures["began"]
    last = max(figures["ended"] for name, figures in found.items() if "beside" in name)
    assert all(figures["began"] >= last for name, figures in found.items() if "alone" in name)


@pytest.mark.parametrize("quick", [True, False])
def test_what_measures_in_its_full_form_alone_runs_beside_others_in_a_quick_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, quick: bool
) -> None:
    monkeypatch.setenv(CORES_VARIABLE, "2")
    cases = [replace(a_case(f"a/{k}", count), alone="full") for k in range(3)]
    assert run_cases(cases, tmp_path, quick=quick) == {}
    found = [read_results(tmp_path / case.name / "results.json") for case in cases]
    processes = {results.figures["pid"] for results in found}
    assert len(processes) == (2 if quick else 3)
    assert os.getpid() not in processes
    for results in found:
        assert not results.figures["kept"]  # nor does what it measures come from the cache
        assert (BESIDE_OTHERS in results.notes) == quick


def test_cases_that_took_longest_begin_first(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(CORES_VARIABLE, "1")
    cases = [replace(a_case(f"a/{k}", last), settings=("k",)) for k in range(3)]
    run_cases(cases, tmp_path)
    with sqlite3.connect(tmp_path / FILE) as database:
        database.execute("UPDATE runs SET seconds = 1.0 + 8.0 * (name = 'a/1')")
    run_cases([*cases, a_case("a/new", last)], tmp_path)
    began = [
        read_results(tmp_path / f"a/{name}/results.json").figures["began"]
        for name in ("new", "1", "0", "2")
    ]
    assert began == sorted(began)
    # quick runs have a history of their own
    run_cases(cases, tmp_path, quick=True)
    began = [read_results(tmp_path / c.name / "results.json").figures["began"] for c in cases]
    assert began == sorted(began)


def test_steps_are_told_with_the_name_of_their_case(tmp_path: Path, number_of_cores: str) -> None:
    told: list[str] = []
    run_cases(
        [a_case("a/one", count), a_case("a/two", count)],
        tmp_path,
        report=lambda step, lane=0: told.append(step) if lane != OVERALL else None,
    )
    assert {f"a/{name}: {step}" for name in ("one", "two") for step in ("count", "report")} == {
        step for step in told if step
    }


def test_a_folder_that_holds_something_else_is_refused_before_any_work(tmp_path: Path) -> None:
    (tmp_path / "a/two").mkdir(parents=True)
    (tmp_path / "a/two/thesis.tex").write_text("years of work")
    with pytest.raises(InputError, match="not results"):
        run_cases([a_case("a/one", count), a_case("a/two", count)], tmp_path)
    assert os.listdir(tmp_path / "a") == ["two"]
    assert os.listdir(tmp_path / "a/two") == ["thesis.tex"]


def test_results_that_cannot_be_read_are_listed_as_such(tmp_path: Path) -> None:
    run_cases([a_case("a/one", count)], tmp_path)
    (tmp_path / "a/old").mkdir()
    (tmp_path / "a/old/results.json").write_text('{"schema_version": 0}')
    page = write_index(tmp_path).read_text()
    assert "1 of 2 cases pass" in page
    assert "cannot be read: run it again" in page


def test_a_run_that_was_stopped_goes_on_where_it_was(tmp_path: Path) -> None:
    def with_files(name: str, work: Callable[[Run, Page], None]) -> Case:
        return replace(a_case(name, work), settings=("k", "scene"))

    cases = [with_files(f"a/{name}", off) for name in ("one", "two", "three")]
    assert finished_cases(cases, tmp_path, {"k": 1}) == []
    run_cases(cases[:2], tmp_path, {"k": 1})
    first = (tmp_path / "a/one/results.json").read_bytes()
    kept = finished_cases(cases, tmp_path, {"k": 1})
    assert kept == ["a/one", "a/two"]
    # another mode, other settings, or files of the user's that may have changed: run again
    assert finished_cases(cases, tmp_path, {"k": 1}, quick=True) == []
    assert finished_cases(cases, tmp_path, {"k": 2}) == []
    run_cases(cases[:1], tmp_path / "own", {"scene": "mine.yaml"})
    assert finished_cases(cases[:1], tmp_path / "own", {"scene": "mine.yaml"}) == []
    steps: list[str] = []
    problems = run_cases(cases, tmp_path, {"k": 1}, False, lambda s, lane=0: steps.append(s), kept)
    assert problems == {}
    assert not any("a/one" in step for step in steps)
    assert (tmp_path / "a/one/results.json").read_bytes() == first
    assert "3 of 3 cases pass" in (tmp_path / "index.html").read_text()
    # results of another program, or that cannot be read, are made again
    (tmp_path / "a/one/results.json").write_bytes(first.replace(b'"code": "', b'"code": "0'))
    (tmp_path / "a/two/results.json").write_bytes(first[:200])
    for name in ("a/one", "a/two"):  # as such a program would have listed them
        listed = manifest_of(tmp_path / name, "results").text()
        (tmp_path / name / MANIFEST).write_text(listed)
    assert finished_cases(cases, tmp_path, {"k": 1}) == ["a/three"]


@pytest.mark.parametrize("name", ["results.json", "report.html", MANIFEST])
def test_results_that_have_changed_since_are_made_again_and_said(
    tmp_path: Path, caplog: pytest.LogCaptureFixture, name: str
) -> None:
    cases = [a_case("a/one", off), a_case("a/two", off)]
    run_cases(cases, tmp_path)
    assert finished_cases(cases, tmp_path) == ["a/one", "a/two"]
    file = tmp_path / "a/one" / name
    content = file.read_bytes()
    file.write_bytes(content.replace(b"1", b"2", 1))  # some digit that still can be read
    assert file.read_bytes() != content
    with caplog.at_level(logging.INFO, logger="fe_drivetrain"):
        assert finished_cases(cases, tmp_path) == ["a/two"]
    (said,) = caplog.messages
    assert said.startswith("results of a/one are made again: ")
    file.unlink()
    assert finished_cases(cases, tmp_path) == ["a/two"]


def test_how_many_cases_are_done_is_counted(tmp_path: Path, number_of_cores: str) -> None:
    counts: list[str] = []

    def report(step: str, lane: int = 0) -> None:
        if lane == OVERALL:
            counts.append(step)

    run_cases([a_case(f"a/{k}", off) for k in range(3)], tmp_path, report=report)
    assert counts == [f"cases ({k} of 3)" for k in range(4)]


def test_what_a_kill_would_leave_looks_incomplete(tmp_path: Path) -> None:
    """A process that is killed can write nothing more: the page is so at any time of the run."""
    run_cases([a_case("a/one", count), a_case("a/two", count)], tmp_path)
    cases = [a_case("a/one", count, alone=True), a_case("a/two", read_the_index, alone=True)]
    run_cases(cases, tmp_path)
    before, meanwhile = read_results(tmp_path / "a/two/results.json").details
    assert '<p class="outcome running">1 of 2 cases pass, 1 planned</p>' in before
    assert '<p class="outcome running">1 of 2 cases pass, 1 running</p>' in meanwhile
    after = (tmp_path / "index.html").read_text()
    assert '<p class="outcome pass">2 of 2 cases pass</p>' in after
    assert "not run" not in after


@pytest.mark.parametrize("quick", [True, False])
def test_quick_runs_are_seen_to_be_quick(tmp_path: Path, quick: bool) -> None:
    cases = [a_case("a/one", count), a_case("a/two", count)]
    run_cases(cases, tmp_path, quick=quick)
    results = read_results(tmp_path / "a/one/results.json")
    assert results.environment.quick == quick
    for page in (tmp_path / "a/one/report.html", tmp_path / "index.html"):
        assert ('class="badge quick"' in page.read_text()) == quick
    assert ("2 cases were run quickly" in (tmp_path / "index.html").read_text()) == quick
    write_junit(tmp_path / "all.xml", ["a/one"], {"a/one": results}, {})
    (suite,) = ElementTree.parse(tmp_path / "all.xml").getroot()
    assert (suite.find("properties/property[@name='quick']") is not None) == quick
    assert suite.get("tests") == str(len(results.verdicts))
    assert ("Quick run: coarser" in outcome_text(results, tmp_path)) == quick


@pytest.mark.parametrize(("sent", "status"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_stopping_keeps_what_is_done_and_leaves_nothing_half_written(
    tmp_path: Path, sent: signal.Signals, status: int
) -> None:
    program = (
        "import sys; sys.argv[:] = ['fe-drivetrain', 'run', '--all']\n"
        "import suite_cases as t\n"
        "from fe_drivetrain.command_line import main\n"
        "from fe_drivetrain.report.suite import case\n"
        "found = [t.a_case('a/one', t.count), t.a_case('a/wait', t.wait)]\n"
        "case.all_cases = lambda: {c.name: c for c in found}\n"
        "main()\n"
    )
    environment = {
        **os.environ,
        CORES_VARIABLE: "2",
        "PYTHONPATH": os.pathsep.join([str(Path(__file__).parents[1]), *sys.path]),
    }
    with subprocess.Popen(
        [sys.executable, "-c", program],
        cwd=tmp_path,
        env=environment,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    ) as process:
        assert process.stderr is not None
        end = time.monotonic() + 60
        while not (tmp_path / "reports/a/one").exists() or not list(
            tmp_path.glob("reports/a/.wait-*/pid-*")
        ):
            assert time.monotonic() < end
            time.sleep(0.02)
        os.killpg(process.pid, sent) if sent == signal.SIGINT else process.send_signal(sent)
        assert process.wait(60) == status
        assert "Traceback" not in process.stderr.read()
    assert sorted(os.listdir(tmp_path / "reports")) == [
        "a",
        "checks.html",
        MANIFEST,
        "history.sqlite",
        "index.html",
        "problems.json",
    ]
    page = (tmp_path / "reports/index.html").read_text()
    assert '<p class="outcome fail">1 of 2 cases pass, 1 not run</p>' in page
    assert ">not run<" in page
    assert "Incomplete" in page
    assert os.listdir(tmp_path / "reports/a") == ["one"]
    assert (tmp_path / "reports/a/one/report.html").is_file()
