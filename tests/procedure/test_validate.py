"""Projects in six steps: what each lacks, stale evidence, loops, and one that is complete."""

import json
import re
import shlex
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import pytest
import yaml
from conftest import QuickRun
from small_project import RANGE, Content, change, small_project, write_case
from tiny_case import Result

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.reading import parse_mapping
from fe_drivetrain.drivetrain_file.reading import change_scene, library_scene, scene_text
from fe_drivetrain.procedure.channels import ChannelFile, read_channels, write_channels
from fe_drivetrain.procedure.failure_modes import TORQUE_AND_BENDING
from fe_drivetrain.procedure.iteration_log import log_file, procedure_of, read_log
from fe_drivetrain.procedure.project import (
    PROJECT_SCHEMA_FILE,
    SECTIONS,
    Project,
    parse_project,
    project_schema,
    starting_project,
)
from fe_drivetrain.procedure.signatures import content_digest
from fe_drivetrain.procedure.steps import require_complete
from fe_drivetrain.report.results import Results, Table, read_results
from fe_drivetrain.report.seal import drivetrain_record
from fe_drivetrain.shafts.fidelity.quantity import ERROR_AGAINST_LAST, OWN_ERROR
from fe_drivetrain.studies.project_validation import validate as validate_project

pytestmark = pytest.mark.usefixtures("kept_between_runs")

ROOT = Path(__file__).parents[2]
EVIDENCE = ("procedure/machine_gaps", "dynamics/drivetrain_levels", "procedure/campaign")
Invoke = Callable[..., Result]


@pytest.fixture
def small(tmp_path: Path) -> Content:
    return small_project(tmp_path)


@pytest.fixture
def validate(invoke: Invoke, tmp_path: Path) -> Callable[[Content], tuple[int, Results]]:
    """Validate a project; exit status and results."""

    def run(content: Content) -> tuple[int, Results]:
        (tmp_path / "p.yaml").write_text(yaml.safe_dump(content), "utf-8")
        status, _, error = invoke("validate", "p.yaml")
        assert status in (0, 1), error
        return status, read_results(tmp_path / "reports/validate/p/results.json")

    return run


Validate = Callable[[Content], tuple[int, Results]]


def lacks(results: Results) -> dict[int, list[str]]:
    return {row["step"]: row["lacks"] for row in results.figures["steps"] if row["lacks"]}


def test_a_project_is_complete_with_all_six_steps(
    small: Content, validate: Validate, tmp_path: Path
) -> None:
    status, results = validate(small)
    assert lacks(results) == {}
    assert status == 0
    assert results.answer is not None
    assert results.answer.verdict.startswith("Complete: all 6 steps were taken")
    require_complete(procedure_of("mine", read_log(tmp_path / "p.log.jsonl")))
    # the page leads to the page of each case
    tables = [i for s in results.sections for i in s.items if isinstance(i, Table) and i.links]
    assert {link for table in tables for link in table.links} == {
        "../../group/run/report.html",
        "../../group/levels/report.html",
    }
    assert 'href="../../group/run/report.html"' in (
        tmp_path / "reports/validate/p/report.html"
    ).read_text("utf-8")
    by_name = {v.quantity: v for v in results.verdicts}
    assert by_name["torque: mean"].computed / by_name["torque: mean"].reference == pytest.approx(
        1.01
    )


@pytest.mark.parametrize("number", range(1, 7))
def test_it_is_not_complete_without_any_one_step(
    number: int, small: Content, tmp_path: Path
) -> None:
    key = SECTIONS[number - 1]
    del small[key]
    found = validate_project(Project.model_validate(small), tmp_path)
    assert found.states[number - 1].lacks == (f"it was not begun: add the section {key}",)


@pytest.mark.parametrize(
    ("key", "value", "step", "words"),
    [
        ("failure_modes.gaps", [], 1, "'resonance' is covered by no load case"),
        ("failure_modes.critical", [], 1, "no design load is critical"),
        ("failure_modes.critical.0.load", "rust", 1, "'rust' is no design load"),
        ("failure_modes.critical.1.variables", [], 1, "no critical design variable"),
        ("model.level", "torsional", 2, "'torsional' is too simple"),
        ("model.level", "solid", 2, "not on the ladder"),
        ("model.evidence", [], 2, "no evidence says which level"),
        ("model.needs.0.tolerance", 0.34, 2, "says nothing"),
        ("load_cases.cases.0.loads", [], 3, "brings no design load about"),
        ("load_cases.cases.0.loads.0", "resonance", 3, "is a value of 'torque oscillation"),
        ("load_cases.cases.0.evidence", [], 3, "was not run"),
        ("load_cases.cases.0.number", "1.9", 3, "no load case 1.9: use one of 1.1, 1.2,"),
        ("load_cases.cases", [], 3, "no load case brings 'torque oscillation"),
        ("inputs.values.0.band", None, 4, "has no band, and no signal"),
        ("inputs.values.0.band", 0.5, 4, "of 50 % says nothing"),
        ("inputs.values.0.value", None, 4, "no value with a unit"),
        ("inputs.values.0.unit", "", 4, "no value with a unit"),
        ("inputs.values.0.known_by", None, 4, "does not say how it is known"),
        ("inputs.values.0.known_by", "assumption", 4, "is an assumption"),
        ("inputs.values.0.source", "best guess", 4, "which is a guess"),
        ("inputs.values.0.source", "?", 4, "which is a guess"),
        ("inputs.values.0.measured_by", "speed", 4, "no signal of the campaign"),
        ("inputs.values.0.name", "stiffness", 4, "'stiffness of shafts' of Table 4.7 is not"),
        ("inputs.waived.0.name", "mass of screws", 4, "'mass of blades' of Table 4.7 is not"),
        ("inputs.waived.0.name", "mass of screws", 4, "'mass of screws' is waived but"),
        ("inputs.waived.0.reason", "-", 4, "waived without a reason"),
        ("campaign.signals.0.accuracy", 1.0, 5, "of 100 % says nothing"),
        ("comparison.quantities.0.tolerance", 1.0, 6, "of 100 % says nothing"),
        ("campaign.signals.0.rate", 2, 5, "sampled at 2 Hz, but 1 Hz need 3 Hz"),
        ("campaign.capture.target", 2, 5, "6 m/s has 1 of 2 windows"),
        ("campaign.capture", None, 5, "no capture matrix"),
        ("campaign.capture.files.file", "none.csv", 5, "there is no file"),
        (
            "comparison.quantities.0.tolerance",
            0.001,
            6,
            "torque: mean is 3.03e+05 N m",
        ),
        ("comparison.measured.file", "none.csv", 6, "there is no file"),
        ("comparison.evidence", [{"case": "group/none"}], 6, "run the case"),
        ("comparison.evidence", [{"case": "group/run", "check": "laod"}], 6, "did you mean 'load'"),
        ("failure_modes.gaps.0.evidence", [], 1, "is covered by no load case"),
        ("failure_modes.gaps.0", {"load": "resonance", "dismissed": "-"}, 1, "by no load case"),
        ("failure_modes.gaps.0.evidence.0", {"case": "group/run"}, 1, "names no quantity"),
        ("failure_modes.gaps.0.evidence.0.quantity", "range", 1, "no quantity 'range' without"),
        ("failure_modes.gaps.0.evidence.0", RANGE, 1, "and not of 'resonance'"),
        ("failure_modes.gaps.0.evidence.0.at_least", 0.25, 1, "margin is 0.2, asked: at least"),
        ("failure_modes.gaps.0.evidence.0.at_least", -1, 1, "as every margin has it"),
        ("failure_modes.gaps.0.evidence.0.at_least", None, 1, "no limit is stated"),
        ("failure_modes.gaps.0.evidence.0.limit_from", "a guess", 1, "the source of its limit"),
        # 80 kN m with a band of 2 kN m
        ("load_cases.cases.0.evidence.0.at_most", 81, 3, "range is 80 ± 2 kN m, asked: at most 81"),
        ("load_cases.cases.0.evidence.0.at_most", 8001, 3, "more than 100 times the value"),
        ("load_cases.cases.0.evidence.0.unit", "N m", 3, "no quantity 'range' in N m"),
    ],
)
def test_a_step_says_what_it_lacks(
    key: str, value: Any, step: int, words: str, small: Content, tmp_path: Path
) -> None:
    change(small, key, value)
    states = validate_project(Project.model_validate(small), tmp_path).states
    assert words in " ".join(states[step - 1].lacks)


def test_evidence_that_fails_is_quick_or_stale_does_not_count(
    small: Content, validate: Validate, tmp_path: Path
) -> None:
    reports = tmp_path / "reports"
    for more, words, accept in (
        ({"passed": False}, "'load' does not pass", ["quick", "other version"]),
        ({"quick": True}, "of a quick run", ["other version"]),
        ({"code": "0" * 64}, "of another version of the program", ["quick"]),
    ):
        write_case(reports, "group/run", **more)
        found = validate_project(Project.model_validate(small | {"accept": accept}), tmp_path)
        assert words in found.states[0].lacks[0]
    write_case(reports, "group/run", quick=True)
    status, results = validate(small | {"accept": ["quick"]})
    assert status == 0
    assert results.notes[0] == "Evidence that counts although of a quick run: group/run."
    assert results.answer is not None
    assert results.answer.verdict.endswith("2 of them accepted as they are.")
    write_case(reports, "group/run", code="0" * 64)
    accepted = Project.model_validate(small | {"accept": ["other version"]})
    assert validate_project(accepted, tmp_path).states[0].complete
    # what is both is accepted as both, or not at all
    write_case(reports, "group/run", code="0" * 64, quick=True)
    assert not validate_project(accepted, tmp_path).states[0].complete
    both = Project.model_validate(small | {"accept": ["other version", "quick"]})
    assert validate_project(both, tmp_path).states[0].complete


def test_evidence_of_another_scene_does_not_count(small: Content, tmp_path: Path) -> None:
    scene = library_scene("two_bearings")
    levels = [
        {"level": 0, "title": "statics", OWN_ERROR: None, ERROR_AGAINST_LAST: 0.5},
        {"level": 1, "title": "beam", OWN_ERROR: 0.01, ERROR_AGAINST_LAST: 0.02},
        {"level": 2, "title": "meridian", OWN_ERROR: 0.001, ERROR_AGAINST_LAST: 0.0},
    ]
    figures = {"quantity": "main_bearing.Fz", "levels": levels}
    small["model"] |= {
        "drivetrain": "two_bearings",
        "level": 1,
        "needs": [{"quantity": "main_bearing.Fz", "tolerance": 0.05}],
        "evidence": [{"case": "advise/two_bearings"}],
    }

    def missing() -> tuple[str, ...]:
        return validate_project(Project.model_validate(small), tmp_path).states[1].lacks

    def advised(changes: dict[str, float]) -> None:
        changed = change_scene(scene, changes)
        write_case(
            tmp_path / "reports",
            "advise/two_bearings",
            scene=scene_text(changed),
            drivetrains=[drivetrain_record(changed)],
            figures=figures,
        )

    advised({})
    assert missing() == ()
    change(small, "model.needs.0.tolerance", 0.01)
    assert "needs 'meridian'" in missing()[0]
    change(small, "model.needs.0.tolerance", 0.05)
    advised({"mesh.shaft": 0.77})
    assert f"and the project is of {scene.title!r}" in missing()[0]
    assert ": mesh.shaft was 0.77 and is" in missing()[0]


def test_each_run_that_changes_something_is_logged_and_loops_are_shown(
    small: Content, validate: Validate, tmp_path: Path
) -> None:
    validate({k: v for k, v in small.items() if k not in ("campaign", "comparison")})
    validate(small)
    validate(small)  # nothing has changed
    log = log_file(tmp_path / "p.yaml")
    assert len(read_log(log)) == 2
    assert "step 6: begun" in read_log(log)[1].changes
    change(small, "model.level", "torsional")
    change(small, "model.decision", "torsion is enough")
    assert validate(small)[0] == 1
    entry = read_log(log)[2]
    assert "step 2: level: rigid bodies -> torsional" in entry.changes
    assert "step 2: no longer complete" in entry.changes
    change(small, "model.level", "rigid bodies")
    change(small, "model.decision", "it is not")
    write_case(tmp_path / "reports", "group/run", quick=True)  # no step is taken again for that
    _, results = validate(small | {"accept": ["quick"]})
    procedure = procedure_of("mine", read_log(log))
    assert procedure.loops == ((6, 2, "torsion is enough"), (2, 2, "it is not"))
    require_complete(procedure)
    assert len(results.figures["log"]) == 4
    assert "group/run: passed -> quick" in results.figures["log"][3]["changes"][0]
    log.write_text("{}\n")
    with pytest.raises(InputError, match="line 1 of the log"):
        read_log(log)


def test_a_signature_holds_for_what_was_signed_alone(
    small: Content, validate: Validate, tmp_path: Path
) -> None:
    digest = validate(small)[1].figures["digest"]
    signature = {"name": "A. B.", "date": "2026-11-23", "digest": digest}
    status, results = validate(small | {"signed": [signature]})
    assert status == 0
    assert results.verdicts[-1].quantity == "signature of A. B.: of these six steps, complete"
    # run again with the same result it still holds, with another it does not
    write_case(tmp_path / "reports", "group/run")
    project = Project.model_validate(small | {"signed": [signature]})

    def now() -> str:
        found = validate_project(project, tmp_path)
        return content_digest(project, found.states, found.measured.verdicts, found.drivetrain)

    assert now() == digest
    (tmp_path / "wind.csv").touch()
    time = np.arange(1200.0)
    write_channels(tmp_path / "mine.csv", 1.0, {"gauge [kN m]": -300.0 - 10.0 * np.sin(time)})
    assert now() != digest
    change(small, "model.level", "flexible shafts")
    status, results = validate(small | {"signed": [signature]})
    assert status == 1
    assert not results.verdicts[-1].passed


@pytest.mark.parametrize(
    ("change_to", "words"),
    [
        ({"subject": None}, "subject"),
        ({"sistems": ["gearbox"]}, "did you mean 'systems'"),
        ({"systems": ["tower"]}, "no system 'tower'"),
        (
            {"model": {"decision": "d", "level": "1", "needs": []}},
            "model.drivetrain (drivetrain file, or a drivetrain of the library) is missing",
        ),
        (
            {"model": {"decision": "d", "machine": "nrel_5mw", "level": "1", "needs": []}},
            "by one key: write drivetrain in place of machine",
        ),
        (
            {"model": {"decision": "d", "scene": "a.yaml", "level": "1", "needs": []}},
            "by one key: write drivetrain in place of scene",
        ),
        ({"inputs": {"decision": "", "values": []}}, "decision"),
    ],
)
def test_faults_of_a_project_are_sentences_and_status_2(
    change_to: Content, words: str, small: Content, invoke: Invoke, tmp_path: Path
) -> None:
    (tmp_path / "p.yaml").write_text(yaml.safe_dump(small | change_to), "utf-8")
    status, _, error = invoke("validate", "p.yaml")
    assert status == 2
    assert words in error
    assert error.count("\n") == 1


def test_the_published_schema_is_that_of_the_program_and_the_example_follows_it() -> None:
    assert (ROOT / "docs" / PROJECT_SCHEMA_FILE).read_text("utf-8") == project_schema()
    validator = jsonschema.Draft202012Validator(json.loads(project_schema()))
    text = starting_project()
    assert text.startswith(f"# yaml-language-server: $schema={PROJECT_SCHEMA_FILE}\n")
    assert isinstance(parse_project(text), Project)
    assert not list(validator.iter_errors(parse_mapping(text, "project")))
    assert list(validator.iter_errors(parse_mapping(text.replace("level:", "levle:"), "")))


def test_every_key_of_a_project_is_documented() -> None:
    text = (ROOT / "docs/procedure.md").read_text("utf-8")
    for name, model in json.loads(project_schema())["$defs"].items():
        for key in model["properties"]:
            assert f"`{key}`" in text, f"{name}.{key}"
    for key in Project.model_fields:
        assert f"`{key}`" in text, key


@pytest.mark.quick(*EVIDENCE)
def test_the_tutorial_validates_the_reference_turbine_and_goes_back_once(
    quick_run: QuickRun, invoke: Invoke, tmp_path: Path
) -> None:
    text = (ROOT / "docs/procedure.md").read_text("utf-8")
    for name in EVIDENCE:
        quick_run(name)
    blocks = re.findall(r"^```sh\n(.*?)^```", text, re.DOTALL | re.MULTILINE)
    for line in "".join(blocks).replace("\\\n", " ").splitlines():
        words = shlex.split(line, comments=True)
        if words[:2] == ["fe-drivetrain", "run"]:
            for name in (word for word in words if word in EVIDENCE):
                shutil.copytree(quick_run.folder / name, tmp_path / "reports" / name)
        elif words[:1] == ["fe-drivetrain"]:
            status, out, error = invoke(*words[1:])
            assert status == int("# ends with 1" in line), out + error
        else:
            subprocess.run(["sh", "-euc", line], check=True)
    results = read_results(tmp_path / "reports/validate/project/results.json")
    # what it cannot show stays open, and no more than that
    steps = results.figures["steps"]
    assert [row["complete"] for row in steps] == [False, True, False, False, False, False]
    states = {
        (row["step"], one["stands for"]): one["state"] for row in steps for one in row["evidence"]
    }
    assert states == {
        (1, "misalignment in the drivetrain"): "no limit, does not count",
        (1, "low voltage ride through"): "no limit, does not count",
        (1, "resonance"): "beyond its limit, does not count",
        (2, "the step"): "quick",
        (3, f"rotor torque, {TORQUE_AND_BENDING}"): "quick",
        (3, "torque reversals"): "no limit, does not count",
        (6, "the step"): "quick",
    }
    open_inputs = " ".join(steps[3]["lacks"])
    for name in ("inertia of drivetrain parts: rotor", "stiffness of meshes: stage 1"):
        assert f"{name!r} has no band" in open_inputs
    assert "'damping of meshes' of Table 4.7 is not stated" in open_inputs
    assert [text for text in steps[5]["lacks"] if "is no measurement" not in text] == []
    procedure = procedure_of("750 kW", read_log(tmp_path / "project.log.jsonl"))
    assert [loop[:2] for loop in procedure.loops] == [(6, 2), (2, 2)]
    # the identified shaft is that of the gear table
    stiffness = next(v for v in results.verdicts if v.quantity.startswith("stiffness"))
    assert stiffness.reference == pytest.approx(3.69e7, rel=0.02)
    assert "digest" not in results.figures


def test_own_channels_of_the_documentation_are_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    text = (ROOT / "docs/procedure.md").read_text("utf-8")
    (code,) = re.findall(
        r"^```python\n([^`]*?read_channels.*?)^```", text, re.DOTALL | re.MULTILINE
    )
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    exec(code, names)
    assert names["largest"] == pytest.approx(320e3, rel=1e-4)


def test_channels_come_back_as_written_with_their_mapping(tmp_path: Path) -> None:
    values = np.array([1.0, 2.0, -3.5, 1e-300])
    write_channels(tmp_path / "a.csv", 0.02, {"a [kN]": values, "speed [rpm]": values})
    given = ChannelFile(file="a.csv", channels={"force": "-a", "v": "speed"})
    found = read_channels(given, tmp_path, frozenset({"force", "v"}))
    assert found.step == pytest.approx(0.02)
    assert (found.of("force") == -1e3 * values).all()
    assert found.units == {"force": "N", "v": "rad/s"}
    assert found.of("v") == pytest.approx(values * np.pi / 30.0)
    with pytest.raises(InputError, match="no channel 'x'"):
        found.of("x")


@pytest.mark.parametrize(
    ("text", "units", "words"),
    [
        ("time [s],a [furlong]\n0,1\n1,2\n", {}, "furlong"),
        ("time [s],b [N]\n0,1\n1,2\n", {}, "no column 'a'"),
        ("time [s],a [N]\n0,1\n1,nan\n", {}, "not finite"),
        ("time [s],a [N]\n0,1\n1,2\n3,2\n", {}, "not uniform"),
        ("time [s],a [N]\n0,1\n", {}, "two are needed"),
        ("time [N],a [N]\n0,1\n1,2\n", {}, "no unit of time"),
        ("time [s],a\n0,1\n1,2\n", {"a": "kN"}, ""),
    ],
)
def test_faults_of_channels_are_sentences(
    text: str, units: dict[str, str], words: str, tmp_path: Path
) -> None:
    (tmp_path / "a.csv").write_text(text)
    given = ChannelFile(file="a.csv", units=units)
    if not words:
        assert read_channels(given, tmp_path, frozenset({"a"})).of("a").tolist() == [1e3, 2e3]
        return
    with pytest.raises(InputError, match=words):
        read_channels(given, tmp_path, frozenset({"a"}))
