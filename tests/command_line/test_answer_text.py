"""The answer on the terminal: verdict first, figures with their limits, JSON, pages, names."""

import json
import re
import shlex
import webbrowser
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from coarse_scenes import coarse_scene
from tiny_case import Result, check_one
from typer.main import get_command

from fe_drivetrain.command_line.answer_text import answer_text, figures_table, rendered
from fe_drivetrain.command_line.app import app
from fe_drivetrain.command_line.examples import EXAMPLES, unfolded
from fe_drivetrain.command_line.names import complete_case, complete_scene
from fe_drivetrain.common.near_words import did_you_mean
from fe_drivetrain.drivetrain_file import library_names
from fe_drivetrain.drivetrain_file.reading import scene_text
from fe_drivetrain.report.answer import Answer
from fe_drivetrain.report.number_text import standing_text, standing_words
from fe_drivetrain.report.results import read_results
from fe_drivetrain.report.suite.key_figures import KeyLimit, limited
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.studies import check

Invoke = Callable[..., Result]

VERDICT = "The bearing carries 4\u202f800\u00a0MPa, above its limit."


def answering(run: Run, page: Page, cautions: int = 1, computed: float = 1.01) -> None:
    """One check and an answer with a figure of each status."""
    check_one(page, computed)
    page.answer(
        "What does it carry?",
        VERDICT,
        [
            page.value("contact pressure [MPa]", 4800.0, 20.0, at_most=4000.0, by="ISO 76"),
            page.value("offset [mm]", -1.5, at_least=-2.0),
            page.value("mass [kg]", 12.0, 1.0, at_most=12.5),
            page.value("speed [rpm]", 12.1),
        ],
        cautions=[f"Caution {k}." for k in range(cautions)],
    )


def test_the_answer_comes_first_and_the_page_last(invoke: Invoke) -> None:
    status, out, _ = invoke("run", "tiny", work=answering)
    assert status == 0
    assert out.splitlines() == [
        "The bearing carries 4,800 MPa, above its limit.",
        "",
        "contact pressure  4,800 ± 20 MPa  at most 4,000 MPa (ISO 76)  beyond",
        "offset            -1.5 mm         at least -2 mm              within",
        "mass              12.0 ± 1.0 kg   at most 12.5 kg             near",
        "speed             12.1 rpm",
        "",
        "Caution: Caution 0.",
        "",
        "1 of 1 checks pass",
        "Report: reports/group/tiny/report.html",
    ]


def test_three_cautions_are_shown_and_the_others_counted(invoke: Invoke) -> None:
    _, out, _ = invoke("run", "tiny", work=partial(answering, cautions=5))
    assert out.count("Caution: ") == 3
    assert "2 more cautions are on the page." in out.splitlines()


def test_a_failing_check_takes_the_ground_from_the_verdict(invoke: Invoke) -> None:
    status, out, _ = invoke("run", "tiny", work=partial(answering, computed=2.0))
    assert status == 1
    assert out.startswith("Not to be relied on, 1 of 1 checks fail: The bearing")
    assert "0 of 1 checks pass\nFAIL  one: computed 2, reference 1" in out


def test_a_terminal_has_colours_and_its_own_width(
    invoke: Invoke, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert "\x1b[" not in invoke("run", "tiny", work=partial(answering, cautions=2))[1]
    monkeypatch.setenv("FORCE_COLOR", "1")
    monkeypatch.setenv("COLUMNS", "60")
    monkeypatch.setenv("TERM", "xterm")
    out = invoke("run", "tiny", work=answering)[1]
    assert "\x1b[1;31m4,800 ± 20 MPa" in out
    assert "\x1b[32mwithin" in out
    plain = re.sub(r"\x1b\[[\d;]*m", "", out).splitlines()
    assert max(map(len, plain)) <= 60
    assert len(plain) > 11  # the table folds


def test_json_is_the_answer_of_a_case_and_nothing_else(invoke: Invoke) -> None:
    _, out, _ = invoke("run", "tiny", "--json", work=answering)
    found = Answer.model_validate_json(out)
    assert (found.verdict, found.status) == (VERDICT, "bad")
    assert [one.status for one in found.figures] == ["bad", "good", "watch", "none"]
    _, out, _ = invoke("run", "group", "--json", work=answering)
    assert [name for name, one in json.loads(out).items() if one["verdict"] == VERDICT] == [
        "group/other",
        "group/tiny",
    ]
    # it is of the command that is typed, not of the one before
    assert invoke("run", "tiny", work=answering)[1].startswith("The bearing")


def test_json_of_a_study_is_that_of_its_result(invoke: Invoke, tmp_path: Path) -> None:
    scene = coarse_scene("bonded")
    (tmp_path / "mine.yaml").write_text(scene_text(scene))
    status, out, _ = invoke("check", "mine.yaml", "--json")
    assert status == 0
    found, same = json.loads(out), check(scene).to_dict()
    assert found.keys() == same.keys()
    assert found["schema"] == same["schema"] == "fe-drivetrain/check/2"
    assert found["answer"]["verdict"] == same["answer"]["verdict"]
    # options stand in place of arguments
    assert "--bearing main_bearing=ENTRY" in found["answer"]["cautions"][0]


@pytest.mark.parametrize(
    ("words", "keys"),
    [
        (("list", "tiny"), [{"name", "title", "source"}]),
        (("new", "--list"), {"three-point", "two-bearings"}),
        (("new", "mine.yaml"), {"file", "title"}),
        (("new", "bearings.yaml", "--bearing"), {"file", "title"}),
        (("export", "--list"), [{"format", "ending", "holds", "read by", "needs"}]),
    ],
)
def test_commands_without_a_page_have_json_too(
    invoke: Invoke, words: tuple[str, ...], keys: Any
) -> None:
    status, out, _ = invoke(*words, "--json")
    assert status == 0
    found = json.loads(out)
    if isinstance(keys, list):
        assert found[0].keys() == keys[0]
    else:
        assert found.keys() >= keys


def test_runs_so_far_and_their_comparison_have_json(invoke: Invoke, tmp_path: Path) -> None:
    for folder in ("before", "after"):
        assert invoke("run", "group", "--out", folder, work=answering)[0] == 0
    rows = json.loads(invoke("history", "tiny", "--out", "after", "--json")[1])
    assert [(row["name"], row["quantity"]) for row in rows] == [("group/tiny", "contact pressure")]
    found = json.loads(invoke("compare-runs", "before", "after", "--json")[1])
    assert (found["cases"], found["checks"], found["changes"]) == (2, 2, [])


def test_open_shows_the_page_in_the_browser(
    invoke: Invoke, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    opened: list[str] = []
    monkeypatch.setattr(webbrowser, "open", opened.append)
    invoke("run", "tiny", work=answering)
    assert opened == []
    invoke("run", "tiny", "--open", work=answering)
    invoke("run", "group", "--open", work=answering)
    reports = (tmp_path / "reports").as_uri()
    assert opened == [f"{reports}/group/tiny/report.html", f"{reports}/index.html"]


def test_a_group_ends_with_a_table_of_answers(invoke: Invoke) -> None:
    status, out, _ = invoke("run", "group", work=partial(answering, computed=2.0))
    assert status == 1
    *_, one, two, _, last = out.splitlines()
    said = "Not to be relied on, 1 of 1 checks fail: The bearing carries 4,800 MPa"
    assert one.startswith(f"FAIL  group/other  {said}")
    assert two.startswith(f"FAIL  group/tiny   {said}")
    assert last == "0 of 2 cases pass: reports/index.html"


def test_list_takes_a_group_or_words(invoke: Invoke) -> None:
    def named(*words: str) -> list[str]:
        out = invoke("list", *words)[1]
        return [line.split()[0] for line in out.splitlines() if line.startswith("  ")]

    assert named("group") == ["group/other", "group/tiny"]
    assert named("THIRD") == ["next/third"]
    assert named("case", "tiny") == ["group/tiny"]
    status, out, error = invoke("list", "nowhere")
    assert (status, out) == (2, "")
    assert "no case has 'nowhere'" in error


def test_a_misspelt_name_has_its_three_nearest(invoke: Invoke) -> None:
    error = invoke("run", "tinny")[2]
    assert "'tinny' is unknown: did you mean 'group/tiny'?" in error
    assert "next/third" not in error
    error = invoke("check", "main_baring_bonded")[2]
    assert "did you mean 'main_bearing_bonded', 'main_bearing_bonded_uncertain' or '" in error
    assert error.count("'") == 2 * (1 + 3)
    known = [f"group/case_{k}" for k in range(9)]
    assert did_you_mean("case_10", known).count("group/") == 3
    assert did_you_mean("zzz", known) == ""


def test_names_are_completed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert complete_case("verification/nafems_le") == [
        "verification/nafems_le10",
        "verification/nafems_le11",
    ]
    assert complete_case("verif")[0] == "verification"
    monkeypatch.chdir(tmp_path)
    (tmp_path / "two_mine.yaml").touch()
    assert complete_scene("two_") == ["two_bearings", "two_mine.yaml"]
    assert set(complete_scene("")) == {*library_names(), "two_mine.yaml"}


def test_a_shell_completes_cases(invoke: Invoke, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("_FE_DRIVETRAIN_COMPLETE", "complete_bash")
    monkeypatch.setenv("COMP_WORDS", "fe-drivetrain run group/t")
    monkeypatch.setenv("COMP_CWORD", "2")
    assert invoke()[1].split() == ["group/tiny"]


@pytest.mark.parametrize("name", sorted(get_command(app).commands))  # type: ignore[attr-defined]
def test_help_has_examples_and_fits_80_columns(
    invoke: Invoke, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    status, out, _ = invoke(name, "--help")
    assert status == 0
    assert max(map(len, out.splitlines())) <= 80
    assert "--json" in out
    for words in EXAMPLES[name]:
        # options of examples are those of the command
        options = [word.split("=")[0] for word in shlex.split(words) if word.startswith("--")]
        assert all(option in out for option in options)
        assert f"fe-drivetrain {name} {words}" in " ".join(out.split())


def test_commands_stand_in_panels(invoke: Invoke) -> None:
    out = invoke("--help")[1]
    places = [out.index(panel) for panel in ("Describe a", "Study it", "Prove it", "Hand it over")]
    assert places == sorted(places)
    assert places[1] < out.index(" life ") < places[2] < out.index(" history ") < places[3]


def test_paragraphs_of_a_description_are_lines() -> None:
    assert unfolded("One\n    two.\n\n    Three\n    four.") == "One two.\n\nThree four."


def test_an_answer_without_a_page_has_its_cautions(tmp_path: Path) -> None:
    page = Page()
    answering(Run({}, quick=True, folder=tmp_path), page)
    assert page.answered is not None
    said = answer_text(page.answered, ["Last."]).splitlines()
    assert said[0] == "The bearing carries 4,800 MPa, above its limit."
    assert said[-2:] == ["Caution: Caution 0.", "Caution: Last."]


def test_results_keep_the_answer_as_it_is(invoke: Invoke, tmp_path: Path) -> None:
    invoke("run", "tiny", work=answering)
    answer = read_results(tmp_path / "reports/group/tiny/results.json").answer
    assert answer is not None
    assert answer.verdict == VERDICT  # with spaces that do not break, for the page


@pytest.mark.parametrize(
    ("limit", "words"),
    [
        ({"at_most": 12.5}, "near"),
        ({"at_least": 10.0}, "within"),
        ({"at_least": 20.0}, "below"),
        ({"between": (1.0, 2.0)}, "beyond"),
        ({"beside": 12.0}, ""),
    ],
)
def test_page_and_terminal_have_the_same_words(limit: KeyLimit, words: str) -> None:
    figure = limited("mass", "kg", 12.0, 1.0, **limit)
    marked = standing_text(figure)
    assert standing_words(figure) == words
    assert marked.partition(" ")[2] == words
    assert words in rendered(figures_table([figure]))
