"""Verdicts as JUnit XML: what a CI server counts."""

from pathlib import Path
from xml.etree import ElementTree

from fe_drivetrain.report.answer import Answer
from fe_drivetrain.report.junit import write_junit
from fe_drivetrain.report.results import Environment, Problem, Results, judge


def results_of(name: str, *computed: float) -> Results:
    return Results(
        case=name,
        title="t",
        source="s",
        details=[],
        verdicts=[
            judge(f"q <{k}>", x, 1.0, tolerance=0.1, reason="why", source="s", unit="N")
            for k, x in enumerate(computed)
        ],
        sections=[],
        times={"a": 1.25},
        environment=Environment(date="", python="", platform="", versions={}, settings={}),
    )


def test_every_verdict_is_a_test(tmp_path: Path) -> None:
    path = tmp_path / "out.xml"
    names = ["a/good", "a/bad", "a/broken", "a/skipped"]
    results = {"a/good": results_of("a/good", 1.0, 1.05), "a/bad": results_of("a/bad", 2.0, 1.0)}
    problems = {
        "a/broken": Problem("length is -1 <m>"),
        "a/skipped": Problem("install ccx", "skipped"),
    }
    write_junit(path, names, results, problems)
    suites = {s.get("name"): s for s in ElementTree.parse(path).getroot()}
    counts = {
        name: tuple(s.get(k) for k in ("tests", "failures", "errors", "skipped"))
        for name, s in suites.items()
    }
    assert counts == {
        "a/good": ("2", "0", "0", "0"),
        "a/bad": ("2", "1", "0", "0"),
        "a/broken": ("1", "0", "1", "0"),
        "a/skipped": ("1", "0", "0", "1"),
    }
    assert suites["a/good"].get("time") == "1.250"
    failure = suites["a/bad"].find("testcase/failure")
    assert failure is not None
    assert "computed 2, reference 1 N" in str(failure.get("message"))
    assert [p.name for p in tmp_path.iterdir()] == ["out.xml"]


def test_a_suite_has_the_answer_of_its_case(tmp_path: Path) -> None:
    verdict = "The force is 1 N."
    answer = Answer(question="Which force?", verdict=verdict, figures=[], status="good")
    plain = results_of("a/one", 1.0)
    results = {"a/one": plain.model_copy(update={"answer": answer}), "a/two": plain}
    write_junit(tmp_path / "out.xml", ["a/one", "a/two"], results, {})
    one, two = ElementTree.parse(tmp_path / "out.xml").getroot()
    said = {p.get("name"): p.get("value") for p in one.iter("property")}
    assert said == {"question": "Which force?", "verdict": verdict, "status": "good"}
    assert two.find("properties") is None
