"""``run`` and ``list``: what they print and return, with cases that only count."""

import json
from collections.abc import Callable
from functools import partial
from pathlib import Path

import pytest
from tiny_case import Result, count

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.report.results import read_results
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.run import Run


def test_list_groups_the_cases(invoke: Callable[..., Result]) -> None:
    status, out, _ = invoke("list")
    assert status == 0
    assert [line.split() for line in out.splitlines()] == [
        ["group"],
        ["group/other", "Another", "[bold]", "case"],
        ["group/tiny", "A", "tiny", "case"],
        [],
        ["next"],
        ["next/third", "A", "third"],
    ]


def test_list_shows_what_can_be_set_of_each_case(invoke: Callable[..., Result]) -> None:
    status, out, _ = invoke("list", "--settings")
    assert status == 0
    lines = [line.strip() for line in out.splitlines()]
    taken = "--set: a, k; any value of its scene by its dotted key"
    assert lines[lines.index("group") + 2] == taken
    assert lines.count(taken) == 3


def test_help_of_a_case_shows_its_source_and_settings(invoke: Callable[..., Result]) -> None:
    status, out, _ = invoke("run", "tiny", "--help")
    assert status == 0
    assert "Usage" in out
    assert "--set: a, k; any value of its scene by its dotted key" in out
    assert "Source: " in out
    assert "did you mean" in invoke("run", "tine", "--help")[1]
    assert "--set: " not in invoke("run", "--help")[1]


def test_a_passing_case_exits_0_and_says_where_to_read(
    invoke: Callable[..., Result], tmp_path: Path
) -> None:
    status, out, err = invoke("run", "tiny")
    assert status == 0
    lines = out.splitlines()
    assert lines[0] == "The answer is one."
    assert "Fourth." not in lines
    assert lines[-2:] == ["2 of 2 checks pass", "Report: reports/group/tiny/report.html"]
    assert (tmp_path / "reports/group/tiny/report.html").is_file()
    assert err.splitlines() == ["count to one ...", "report ..."]


def test_a_failing_check_exits_1(invoke: Callable[..., Result], tmp_path: Path) -> None:
    status, out, _ = invoke("run", "group/tiny", work=partial(count, computed=1.2))
    assert status == 1
    assert "1 of 2 checks pass\nFAIL  one: computed 1.2" in out
    # a failed check is a result, and is kept
    assert not read_results(tmp_path / "reports/group/tiny/results.json").passed


def test_a_nan_fails(invoke: Callable[..., Result]) -> None:
    status, out, _ = invoke("run", "tiny", work=partial(count, computed=float("nan")))
    assert status == 1
    assert "FAIL  one: computed nan" in out


def test_options_reach_the_case(invoke: Callable[..., Result], tmp_path: Path) -> None:
    got: list[Run] = []

    def work(run: Run, page: Page) -> None:
        got.append(run)
        count(run, page)

    settings = ["--set", "gearbox.weight=1e6", "--set", "a=[1, x]"]
    assert invoke("run", "tiny", "--quick", "--out", "here/there", *settings, work=work)[0] == 0
    assert got[0].quick
    assert got[0].settings == {"gearbox.weight": 1e6, "a": [1, "x"]}
    stored = json.loads((tmp_path / "here/there/results.json").read_text())
    assert stored["environment"]["settings"] == got[0].settings


def test_a_link_stays_and_the_folder_that_it_leads_to_is_replaced(
    invoke: Callable[..., Result], tmp_path: Path
) -> None:
    assert invoke("run", "tiny", "--out", "real")[0] == 0
    (tmp_path / "link").symlink_to("real")
    assert invoke("run", "tiny", "--out", "link", "--set", "k=2")[0] == 0
    assert (tmp_path / "link").is_symlink()
    assert read_results(tmp_path / "real/results.json").environment.settings == {"k": 2}


def test_the_current_folder_can_be_the_result_folder(
    invoke: Callable[..., Result], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    assert invoke("run", "tiny", "--out", ".")[0] == 0
    assert (tmp_path / "here/report.html").is_file()


@pytest.mark.parametrize(
    ("arguments", "hint"),
    [
        (("run", "nothing"), "group/tiny"),
        (("run", "tiny", "--set", "novalue"), "KEY=VALUE"),
        (("run", "tiny", "--set", "=1"), "KEY=VALUE"),
        (("run", "tiny", "--set", "k=[1"), "YAML"),
        (("run", "tiny", "--set", "k={a: 1}"), "one by one"),
        (("run", "tiny", "--set", "k=!!python/name:os.system ''"), "YAML"),
        (("run", "tiny", "--set", "k=&a [*a]"), "YAML"),
        (("run", "tiny", "--out", "file"), "folder"),
        (("run", "tiny", "--out", "file/below"), "folder"),
        (("run", "tiny", "--out", "full"), "not results"),
        (("run", "tiny", "--out", "x" * 300), "folder"),
        (("run", "tiny", "--out", "loop/x"), "folder"),
        (("run",), "Missing"),
        (("run", "tiny", "--all"), "leave one of the two out"),
        (("run", "tiny", "nothing"), "group/tiny"),
        (("run", "tiny", "other", "--out", "file"), "folder"),
        (("walk",), "No such command"),
        (("run", "tiny", "--fast"), "No such option"),
    ],
)
def test_mistakes_exit_2_with_a_hint(
    invoke: Callable[..., Result], tmp_path: Path, arguments: tuple[str, ...], hint: str
) -> None:
    (tmp_path / "file").write_text("x")
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "thesis.tex").write_text("x")
    (tmp_path / "loop").symlink_to("loop")
    before = sorted(tmp_path.rglob("*"))
    status, out, err = invoke(*arguments)
    assert status == 2
    assert hint in err
    assert out == ""
    assert sorted(tmp_path.rglob("*")) == before


@pytest.mark.parametrize(
    ("arguments", "names"),
    [
        (("tiny", "next/third", "tiny"), ["group/tiny", "next/third"]),
        (("--all",), ["group/other", "group/tiny", "next/third"]),
    ],
)
def test_several_cases_have_a_page_that_lists_them(
    invoke: Callable[..., Result], tmp_path: Path, arguments: tuple[str, ...], names: list[str]
) -> None:
    status, out, err = invoke("run", *arguments, "--set", "k=2", "--quick")
    assert status == 0
    lines = out.splitlines()
    said = [line.split(maxsplit=2) for line in lines[:-2]]
    assert said == [["pass", name, "The answer is one."] for name in names]
    assert lines[-1] == f"{len(names)} of {len(names)} cases pass: reports/index.html"
    page = (tmp_path / "reports/index.html").read_text()
    for name in names:
        assert f"{name}/report.html" in page
        assert read_results(tmp_path / "reports" / name / "results.json").environment.settings
        assert err.splitlines().count(f"{name}: count to one ...") == 1


def test_several_cases_exit_1_where_a_check_fails_and_2_where_one_cannot_run(
    invoke: Callable[..., Result], tmp_path: Path
) -> None:
    status, out, _ = invoke("run", "--all", "--out", "x", work=partial(count, computed=1.2))
    assert status == 1
    assert out.splitlines()[0].startswith("FAIL  group/other: one: computed 1.2")
    assert [line.split()[:2] for line in out.splitlines()[-5:-2]] == [
        ["FAIL", "group/other"],
        ["FAIL", "group/tiny"],
        ["FAIL", "next/third"],
    ]
    assert out.endswith("0 of 3 cases pass: x/index.html\n")

    def work(run: Run, page: Page) -> None:
        raise InputError("loads: no file is there: give one")

    status, out, _ = invoke("run", "tiny", "other", "--out", "y", work=work)
    assert status == 2
    assert out.splitlines()[0] == "none  group/tiny   loads: no file is there: give one"
    assert [path.name for path in (tmp_path / "y/group").iterdir()] == []
    assert "loads: no file is there" in (tmp_path / "y/index.html").read_text()
