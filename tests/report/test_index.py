"""The page of all cases: worst first, every state told apart, nothing but its own script."""

import math
import re
from pathlib import Path

import pytest
from test_report import HOSTILE, Page, results, verdict

from fe_drivetrain.report.answer import Answer, Claim, Status
from fe_drivetrain.report.headline import answer_sentence, headline
from fe_drivetrain.report.index import WORDS, write_index
from fe_drivetrain.report.number_text import value_with_band
from fe_drivetrain.report.results import Problem, Verdict, judge, share_of_tolerance


def put(folder: Path, name: str, *verdicts: Verdict, **changes: object) -> None:
    (folder / name).mkdir(parents=True)
    content = results(name, verdicts=list(verdicts), **changes)
    (folder / name / "results.json").write_text(content.model_dump_json(), "utf-8")


def answer(status: Status, claim: Claim = "") -> Answer:
    """An answer without a figure."""
    verdict = "The force is 1 N."
    return Answer(question="Which force?", verdict=verdict, figures=[], claim=claim, status=status)


def listed(page: Path) -> list[tuple[str, str]]:
    """State and text of the first link, or of the name, of each row."""
    text = page.read_text("utf-8").partition("<tbody>")[2]
    row = r'data-state="([^"]*)".*?<th scope="row"[^>]*>(?:<a[^>]*>)?([^<]*)'
    return re.findall(row, text, re.DOTALL)


def test_cases_stand_worst_first_and_every_state_is_told_apart(tmp_path: Path) -> None:
    put(tmp_path, "a/easy", verdict(1.001))
    put(tmp_path, "a/tight", verdict(1.0), verdict(1.009))
    put(tmp_path, "a/open", verdict(1.0), unsettled=["Not converged: the peak."])
    put(tmp_path, "a/claim", verdict(1.0), answer=answer("watch", "does not hold"))
    put(tmp_path, "a/partly", verdict(1.0), answer=answer("watch", "holds in part"))
    put(tmp_path, "a/above", verdict(1.0), answer=answer("bad"))
    put(tmp_path, "a/close", verdict(1.0), answer=answer("watch"))
    put(tmp_path, "b/wrong", verdict(1.02), answer=answer("good", "holds"))
    put(tmp_path, "b/worse", verdict(2.0), verdict(1.0))
    problems = {
        "c/later": Problem("waits", "planned"),
        "c/now": Problem("at work", "running"),
        "c/stopped": Problem("stopped", "not run"),
        "c/tool": Problem("ccx is not installed", "skipped"),
        "c/error": Problem("ended by an error"),
    }
    page = write_index(tmp_path, problems)
    assert listed(page) == [
        ("fail", "b/worse"),
        ("fail", "b/wrong"),
        ("failed", "c/error"),
        ("not run", "c/stopped"),
        ("running", "c/now"),
        ("planned", "c/later"),
        ("skipped", "c/tool"),
        ("unsettled", "a/open"),
        ("refuted", "a/claim"),
        ("in part", "a/partly"),
        ("beyond", "a/above"),
        ("near", "a/close"),
        ("pass", "a/tight"),
        ("pass", "a/easy"),
    ]
    words = re.findall(r'<span class="badge [^"]*">([^<]*)', page.read_text("utf-8"))
    assert set(words) == set(WORDS.values())
    text = " ".join(Page(page.read_text("utf-8")).text().split())
    assert (
        "6 of 13 cases pass, 1 not run, 1 running, 1 planned, 1 skipped, 1 open, 1 refuted" in text
    )
    assert 'class="said bad">Not to be relied on, 1 of 1 checks fail' in page.read_text("utf-8")
    assert "Not converged: the peak." in text
    assert "Incomplete: of the cases that were asked for 3 did not come to their end" in text


@pytest.mark.parametrize(
    ("claim", "problem", "colour"),
    [
        ("", None, "pass"),
        ("holds", None, "pass"),
        ("does not hold", None, "unsettled"),
        ("", Problem("at work", "running"), "running"),
        ("", Problem("ccx is not installed", "skipped"), "pass"),
        ("", Problem("ended by an error"), "fail"),
    ],
)
def test_all_cases_together_are_red_only_where_something_failed(
    tmp_path: Path, claim: Claim, problem: Problem | None, colour: str
) -> None:
    put(tmp_path, "a/one", verdict(1.0), answer=answer("good", claim))
    page = write_index(tmp_path, {"a/two": problem} if problem else {})
    assert f'<p class="outcome {colour}">' in page.read_text("utf-8")


def test_the_checks_of_all_cases_stand_worst_first(tmp_path: Path) -> None:
    put(tmp_path, "a/one", verdict(1.001), verdict(1.5))
    put(tmp_path, "b/two", verdict(math.nan), verdict(1.009))
    write_index(tmp_path)
    assert listed(tmp_path / "checks.html") == [
        ("fail", "b/two"),
        ("fail", "a/one"),
        ("pass", "b/two"),
        ("pass", "a/one"),
    ]


def test_what_results_say_stays_text_and_only_the_own_script_may_run(tmp_path: Path) -> None:
    check = judge(HOSTILE, 1.0, 2.0, tolerance=0.1, reason="", source="", unit=HOSTILE)
    put(tmp_path, "a/one", check, title=HOSTILE, notes=[HOSTILE])
    write_index(tmp_path, {"a/two": Problem(HOSTILE)})
    for name in ("index.html", "checks.html"):
        page = Page((tmp_path / name).read_text("utf-8"))
        assert len(page.scripts) == 1
        assert HOSTILE in page.text() or name == "checks.html"
        assert not page.all("img")
        (policy,) = [m["content"] for m in page.all("meta") if "http-equiv" in m]
        assert "default-src 'none'" in str(policy)
        assert len(re.findall("sha256-", str(policy))) == 1


def test_a_result_that_is_written_again_is_read_again(tmp_path: Path) -> None:
    put(tmp_path, "a/one", verdict(1.5))
    assert listed(write_index(tmp_path)) == [("fail", "a/one")]
    file = tmp_path / "a/one/results.json"
    content = results("a/one", verdicts=[verdict(1.0)]).model_dump_json()
    file.unlink()
    file.write_text(content, "utf-8")
    assert listed(write_index(tmp_path)) == [("pass", "a/one")]


def check(kind: str, computed: float, reference: float, **more: object) -> Verdict:
    given: dict[str, object] = {"tolerance": 0.0, "reason": "", "source": "", "check": kind}
    return judge("q", computed, reference, **given | more)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("judged", "share"),
    [
        (check("equals", 1.02, 1.0, tolerance=0.05), 0.4),
        (check("equals", -0.5, -1.0, tolerance=1.0, relative=False), 0.5),
        (check("vanishes", -2e-7, 0.0, tolerance=1e-6, relative=False), 0.2),
        (check("at most", 3.0, 4.0), 0.75),
        (check("at most", -3.0, 4.0), 0.0),
        (check("at most", 5.0, 4.0), 1.25),
        (check("at least", 8.0, 2.0), 0.25),
        (check("at least", -8.0, 2.0), math.inf),
        (check("between", 2.5, 1.0, upper=3.0), 0.5),
        (check("holds", 1.0, 1.0), 0.0),
        (check("holds", 0.0, 1.0), math.inf),
        (check("equals", math.nan, 1.0, tolerance=0.1), math.inf),
        (check("equals", 1.0, 1.0), 0.0),
    ],
)
def test_the_share_of_a_tolerance_passes_one_where_the_check_fails(
    judged: Verdict, share: float
) -> None:
    assert share_of_tolerance(judged) == pytest.approx(share)
    assert (share_of_tolerance(judged) <= 1.0) == judged.passed


@pytest.mark.parametrize(
    ("computed", "band", "text"),
    [
        (5.41327, 0.0413, "5.413 ± 0.041\u00a0N"),
        (5.41327, None, "5.413\u00a0N"),
        (392280.4, 1234.5, "392\u202f300 ± 1\u202f200\u00a0N"),
        (579.2, 140.9, "580 ± 140\u00a0N"),
        (1.00827e-8, 7.31e-10, "(10.08 ± 0.73)\u00a0×\u00a010⁻⁹\u00a0N"),
        (-6.97362e10, 1.9e6, "(\u221269.7362 ± 0.0019)\u00a0×\u00a010⁹\u00a0N"),
        (1.0, 0.5, "1.00 ± 0.50\u00a0N"),
        (0.0, 0.5, "~0 ± 0.5\u00a0N"),
        (math.nan, 0.5, "not a number\u00a0N"),
        (5.06219, 1e-7, "5.06219\u00a0N ± 2\u00a0×\u00a010⁻⁶\u00a0%"),
    ],
)
def test_a_value_has_the_digits_that_its_band_leaves(
    computed: float, band: float | None, text: str
) -> None:
    assert value_with_band(verdict(computed, band=band)) == text


def test_the_answer_is_the_named_check_or_the_first_that_is_a_number() -> None:
    statement = check("holds", 1.0, 1.0)
    checks = [statement, verdict(1.0), judge("mass", 2.0, 2.0, tolerance=0, reason="", source="")]
    assert headline(results(verdicts=checks)) == checks[1]
    assert headline(results(verdicts=[statement])) == statement
    assert headline(results(verdicts=[])) is None
    plain = answer_sentence(verdict(1.004, band=0.001)).replace("\u00a0", " ")
    assert plain == "Force: 1.0040 ± 0.0010 N; expected 1 N (error +0.40 %, tolerance ±1 %)."
    named = check("holds", 1.0, 1.0).model_copy(update={"quantity": "main_bearing.My: one sign"})
    assert answer_sentence(named) == "main_bearing.My: one sign: yes."


def test_cases_without_results_here_are_named_and_do_not_count(tmp_path: Path) -> None:
    put(tmp_path, "a/one", verdict(1.0))
    page = write_index(tmp_path, {"a/two": Problem("waits", "planned")}, ["a/one", "a/two", "b/c"])
    text = " ".join(Page(page.read_text("utf-8")).text().split())
    assert "1 case of the program has no results here b/c" in text
    assert "1 of 2 cases pass, 1 planned" in text
    assert "no results here" not in write_index(tmp_path, {}, ["a/one"]).read_text("utf-8")
