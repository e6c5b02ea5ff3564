"""Evidence that does not count: of other machines, edited, vacuous, for other loads, used twice."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from coarse_scenes import COARSE
from conftest import QuickRun
from small_project import (
    MACHINE,
    MARGIN,
    OTHER,
    OWN,
    RANGE,
    Content,
    change,
    check_of,
    small_project,
    value_of,
    write_case,
)
from tiny_case import Result

from fe_drivetrain.command_line.validate_commands import ready_commands
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.named_scenes import read_drivetrain
from fe_drivetrain.drivetrain_file.reading import change_scene, library_scene
from fe_drivetrain.dynamics.bodies.machine import library_machine
from fe_drivetrain.procedure.answers import answer_of
from fe_drivetrain.procedure.channels import write_channels
from fe_drivetrain.procedure.failure_modes import (
    DIPS,
    MISALIGNMENT,
    RESONANCE,
    REVERSALS,
    ROTOR_TORQUE,
    TORQUE_AND_BENDING,
    protest_catalogue,
)
from fe_drivetrain.procedure.project import EvidenceLink, Project, read_project
from fe_drivetrain.procedure.tolerances import EXAMPLE, WIDEST, is_guess, is_vacuous, why_no_limit
from fe_drivetrain.report.results import read_results
from fe_drivetrain.report.seal import drivetrain_hash, drivetrain_record, results_digest
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.studies.gear_answer import LEAST_SAFETY
from fe_drivetrain.studies.mode_findings import MARGIN as MARGIN_OF_MODES
from fe_drivetrain.studies.project_validation import validate as validate_project
from fe_drivetrain.studies.stated_levels import Errors, state_level_errors

Invoke = Callable[..., Result]
GAPS = (MISALIGNMENT, DIPS, RESONANCE)


@pytest.fixture
def small(tmp_path: Path) -> Content:
    return small_project(tmp_path)


def lacks_of(content: Content, folder: Path, step: int = 1) -> str:
    standing = validate_project(Project.model_validate(content), folder)
    assert not standing.complete
    return "\n".join(standing.states[step - 1].lacks)


@pytest.mark.quick("dynamics/lin_parker")
def test_a_project_on_other_machines_and_empty_tolerances_is_not_certified(
    small: Content, quick_run: QuickRun, invoke: Invoke, tmp_path: Path
) -> None:
    """Planets of a helicopter stand for all; inputs, accuracy and comparison allow anything."""
    quick_run("dynamics/lin_parker")
    reports = tmp_path / "reports/dynamics/lin_parker"
    reports.mkdir(parents=True)
    results = (quick_run.folder / "dynamics/lin_parker/results.json").read_text("utf-8")
    (reports / "results.json").write_text(results, "utf-8")
    link = [{"case": "dynamics/lin_parker"}]
    small |= {"subject": "my 2.8 MW turbine", "accept": ["quick", "other version"]}
    small["systems"] = ["gearbox", "drivetrain"]
    small["failure_modes"]["gaps"] = [{"load": name, "evidence": link} for name in GAPS]
    small["load_cases"]["cases"][0]["evidence"] = link
    small["model"]["evidence"] = link
    small["comparison"]["evidence"] = link
    small["inputs"] = {
        "decision": "anything",
        "values": [{"name": "anything", "band": 0.5, "source": "guess"}],
    }
    small["campaign"]["signals"][0]["accuracy"] = 1.0
    for quantity in small["comparison"]["quantities"]:
        quantity["tolerance"] = 1.0
    (tmp_path / "p.yaml").write_text(json.dumps(small), "utf-8")
    status, out, error = invoke("validate", "p.yaml")
    assert status == 1, error
    assert out.startswith("Not complete: steps 1, 2, 3, 4, 5, 6 of 6 are open")
    for name in GAPS:
        assert f"dynamics/lin_parker, for {name!r}" in out
    assert out.count("its results do not say of which") == 4  # once for each step that links it
    for words in (
        OWN.title,
        "the band of 'anything' of 50 % says nothing",
        "'anything' has the source 'guess', which is a guess",
        "'anything' has no value with a unit",
        "'mass of blades', 'mass of drivetrain parts', 'mass of tower'",
        "'damping of meshes': each of Table 4.7 is not stated",
        "the accuracy of 'torque' of 100 % says nothing",
        "the tolerance of 'torque: mean' of 100 % says nothing",
    ):
        assert words in out
    found = read_results(tmp_path / "reports/validate/p/results.json")
    assert "digest" not in found.figures
    assert "There is no digest to sign" in (tmp_path / "reports/validate/p/report.html").read_text()


def test_results_of_another_drivetrain_do_not_count_and_both_titles_are_shown(
    small: Content, tmp_path: Path
) -> None:
    write_case(tmp_path / "reports", "group/run", drivetrains=[OTHER])
    words = lacks_of(small, tmp_path)
    assert OTHER.title in words
    assert OWN.title in words
    assert OTHER.hash in words
    states = validate_project(Project.model_validate(small), tmp_path).states
    assert [one.state for one in states[0].evidence] == ["of another drivetrain"]
    # and of none that is stated
    write_case(tmp_path / "reports", "group/run", drivetrains=[])
    assert "do not say of which drivetrain" in lacks_of(small, tmp_path)
    # before step 2 the project says of none
    write_case(tmp_path / "reports", "group/run")
    assert "the project does not say" in lacks_of(small | {"model": None}, tmp_path)


def test_of_results_of_several_drivetrains_only_what_is_of_this_one_counts(
    small: Content, tmp_path: Path
) -> None:
    reports, both = tmp_path / "reports", [OTHER, OWN]
    checks = [check_of(of=OWN.hash), check_of(of=OTHER.hash)]
    for of, words in (
        (OTHER.hash, "have no quantity 'margin'"),
        ("", "have no quantity 'margin'"),  # of one of both, but of which?
    ):
        answers = [value_of("margin", 0.2, RESONANCE, of=of)]
        write_case(reports, "group/run", drivetrains=both, answers=answers, verdicts=checks)
        assert words in lacks_of(small, tmp_path)
    answers = [
        value_of("margin", 0.01, RESONANCE, of=OTHER.hash),
        value_of("margin", 0.2, RESONANCE, of=OWN.hash),
    ]
    write_case(reports, "group/run", drivetrains=both, answers=answers, verdicts=checks)
    assert validate_project(Project.model_validate(small), tmp_path).states[0].complete
    write_case(reports, "group/run", drivetrains=both, answers=answers, verdicts=checks[1:])
    assert "has no checks of this drivetrain" in lacks_of(small, tmp_path)


def edited(folder: Path, change_to: Callable[[dict[str, Any]], None]) -> None:
    file = folder / "reports/group/run/results.json"
    content = json.loads(file.read_text("utf-8"))
    change_to(content)
    file.write_text(json.dumps(content), "utf-8")


def test_results_that_were_edited_or_have_no_digest_do_not_count(
    small: Content, tmp_path: Path
) -> None:
    small["failure_modes"]["gaps"][0]["evidence"][0] = MARGIN | {"at_least": 0.3}
    assert "margin is 0.2, asked: at least 0.3" in lacks_of(small, tmp_path)
    edited(tmp_path, lambda content: content["answers"][0].update(computed=0.4))
    assert "was edited after the run" in lacks_of(small, tmp_path)
    edited(tmp_path, lambda content: content.update(digest=""))
    assert "was edited after the run" in lacks_of(small, tmp_path)
    # another layout of the same values is no edit
    write_case(tmp_path / "reports", "group/run")
    edited(tmp_path, lambda content: None)
    small["failure_modes"]["gaps"][0]["evidence"][0] = MARGIN
    assert validate_project(Project.model_validate(small), tmp_path).states[0].complete


@pytest.mark.parametrize(
    ("more", "words", "state"),
    [
        ({"verdicts": [check_of(), check_of(passed=False)]}, "'load' does not pass", "failed"),
        # a verdict that says passed where its numbers do not
        (
            {"verdicts": [check_of(False).model_copy(update={"passed": True})]},
            "'load' does not pass",
            "failed",
        ),
        ({"skipped": ["share: NGSolve is not there"]}, "NGSolve is not there", "skipped checks"),
        ({"unsettled": ["the peak moves by 3 %"]}, "the peak moves by 3 %", "not converged"),
        ({"verdicts": []}, "has no checks", "missing"),
        ({"answers": []}, "have no quantity 'margin'", "no answer"),
        ({"answers": [value_of("margin", np.nan, RESONANCE)]}, "margin is nan", "beyond its limit"),
        ({"quick": True}, "of a quick run", "quick"),
        ({"code": "0" * 64}, "of another version", "stale"),
    ],
)
def test_a_run_that_is_no_proof_does_not_count(
    more: dict[str, Any], words: str, state: str, small: Content, tmp_path: Path
) -> None:
    write_case(tmp_path / "reports", "group/run", **more)
    assert words in lacks_of(small, tmp_path)
    found = validate_project(Project.model_validate(small), tmp_path).states[0].evidence
    assert [one.state for one in found] == [state]


def test_a_check_that_anything_passes_is_no_evidence_of_a_step(
    small: Content, tmp_path: Path
) -> None:
    small["comparison"]["evidence"] = [{"case": "group/wide"}]
    for tolerance, relative, counts in ((0.1, True, True), (0.5, True, False), (0.4, False, False)):
        checks = [check_of(tolerance=tolerance, relative=relative)]
        write_case(tmp_path / "reports", "group/wide", verdicts=checks)
        standing = validate_project(Project.model_validate(small), tmp_path)
        assert standing.states[5].complete == counts


def test_one_value_for_two_gaps_counts_for_neither(small: Content, tmp_path: Path) -> None:
    small["systems"] = ["gearbox", "drivetrain"]
    answers = [value_of("margin", 0.2, RESONANCE).model_copy(update={"loads": GAPS})]
    write_case(tmp_path / "reports", "group/run", answers=answers)
    small["failure_modes"]["gaps"] = [{"load": name, "evidence": [MARGIN]} for name in GAPS[:2]]
    small["failure_modes"]["gaps"].append({"load": GAPS[2], "dismissed": "there is no excitation"})
    words = lacks_of(small, tmp_path)
    assert words.count(f"one value is linked for {DIPS!r} and {MISALIGNMENT!r}") == 2


def test_values_of_other_loads_do_not_answer_a_load_case(small: Content, tmp_path: Path) -> None:
    case = small["load_cases"]["cases"][0]
    case["loads"] = [*case["loads"], TORQUE_AND_BENDING]
    words = lacks_of(small, tmp_path, 3)
    assert f"no evidence answers {TORQUE_AND_BENDING!r}" in words


def test_names_of_loads_are_those_of_the_catalogue() -> None:
    known = {load.name for load in protest_catalogue().design_loads}
    assert known >= {*GAPS, REVERSALS, ROTOR_TORQUE, TORQUE_AND_BENDING}
    assert {load.name for load in protest_catalogue().uncovered} == set(GAPS)


def test_a_tolerance_whose_ends_are_a_factor_of_two_apart_is_vacuous() -> None:
    for share in (1e-6, 0.05, 0.3, WIDEST - 1e-9):
        assert (1 + share) / (1 - share) < 2.0
        assert not is_vacuous(share)
    for share in (WIDEST + 1e-9, 0.5, 1.0, 2.0, np.nan, np.inf):
        assert is_vacuous(share)


@pytest.mark.parametrize(
    ("key", "step", "words"),
    [
        ("model.needs.0.tolerance", 2, "under model.needs set tolerance"),
        ("inputs.values.0.band", 4, "under inputs.values set band"),
        ("campaign.signals.0.accuracy", 5, "under campaign.signals set accuracy"),
        ("comparison.quantities.0.tolerance", 6, "under comparison.quantities set tolerance"),
    ],
)
def test_a_vacuous_tolerance_is_told_with_its_range_and_the_key_to_set(
    key: str, step: int, words: str, small: Content, tmp_path: Path
) -> None:
    said = "of 40 % says nothing, since 60 to 140 % of the right value would pass: it must be "
    said += "above 0 and below 33.3 %: " + words + " to less than 0.333, for instance "
    said += words.rpartition(" ")[2] + ": 0.05"
    change(small, key, 0.4)
    found = validate_project(Project.model_validate(small), tmp_path)
    assert said in "\n".join(found.states[step - 1].lacks)
    change(small, key, EXAMPLE)
    found = validate_project(Project.model_validate(small), tmp_path)
    assert "says nothing" not in "\n".join(found.states[step - 1].lacks)


def test_sources_that_are_guesses_are_told() -> None:
    for text in ("guess", "best guess", "Assumed", "an estimate", "unknown", "?", "-", "", "n/a"):
        assert is_guess(text), text
    for text in ("weighing log", "drawing 12", "Al-Hamadani 2018, Table 4.2", "ISO 6336-1"):
        assert not is_guess(text), text


def test_limits_that_are_none_are_told() -> None:
    assert "no limit is stated" in why_no_limit(1.0, "kN", None, None)
    assert not why_no_limit(1.0, "kN", 99.0, None)
    assert "more than 100 times" in why_no_limit(1.0, "kN", 101.0, None)
    assert not why_no_limit(0.0, "kN", 5.0, None)  # no load at all has any capacity
    # a torque may be asked not to reverse, a margin is never below 0
    assert not why_no_limit(-233.0, "kN m", None, 0.0)
    assert "as every margin" in why_no_limit(0.2, "", None, 0.0)
    assert "more than 100 times" in why_no_limit(-2.0, "kN m", None, -201.0)


def test_a_value_keeps_its_limit_with_its_band(tmp_path: Path) -> None:
    write_case(tmp_path, "group/run")
    results = read_results(tmp_path / "group/run/results.json")
    for limit, met in ((81.9, False), (82.0, True)):
        link = EvidenceLink.model_validate(RANGE | {"at_most": limit})
        found = answer_of(link, results, OWN.hash)
        assert found is not None
        assert found.met == met


def test_wind_and_measured_channels_are_of_one_run(small: Content, tmp_path: Path) -> None:
    write_channels(tmp_path / "mine.csv", 1.0, {"gauge [kN m]": -300.0 - np.sin(np.arange(600.0))})
    words = lacks_of(small, tmp_path, 6)
    assert "wind.csv is from 0 to 1199 s and mine.csv from 0 to 599 s" in words
    wind = 6.5 + np.sin(np.arange(1200.0))
    both = {"wind speed [m/s]": wind, "gauge [kN m]": -300.0 - wind}
    write_channels(tmp_path / "mine.csv", 1.0, both)
    small["campaign"]["capture"]["files"]["file"] = "mine.csv"
    assert "one run" not in lacks_of(small, tmp_path, 6)


def test_channels_are_not_compared_with_themselves(small: Content, tmp_path: Path) -> None:
    change(small, "comparison.computed", small["comparison"]["measured"])
    words = lacks_of(small, tmp_path, 6)
    assert "torque of mine.csv stands for measured and for computed" in words


def test_channels_that_a_case_made_are_no_measurement(small: Content, tmp_path: Path) -> None:
    write_case(tmp_path / "reports", "group/made", drivetrains=[OTHER])
    for name in ("mine", "model"):
        (tmp_path / f"{name}.csv").rename(tmp_path / f"reports/group/made/{name}.csv")
    for key, name in (("measured", "mine"), ("computed", "model")):
        change(small, f"comparison.{key}.file", f"reports/group/made/{name}.csv")
    words = lacks_of(small, tmp_path, 6)
    assert "mine.csv is no measurement: group/made made it by a model" in words
    assert f"computed channels of group/made are of {OTHER.title!r}" in words


def test_signals_give_the_spread_of_an_input_that_they_determine(
    small: Content, tmp_path: Path
) -> None:
    time = np.arange(0.0, 120.0, 0.05)
    twist = 1e-3 * sum(np.sin(2.0 * np.pi * f * time + f) for f in (0.4, 0.9, 1.3, 2.1))
    rate = np.gradient(twist, 0.05, edge_order=2)
    noise = 30.0 * np.random.default_rng(1).normal(size=len(time))
    torque = 3.69e7 * twist + 4e5 * rate + noise
    channels = {"front [rad]": twist, "rear [rad]": 0.0 * twist, "torque [N m]": torque}
    write_channels(tmp_path / "mine.csv", 0.05, channels)
    write_channels(tmp_path / "model.csv", 0.05, channels)
    small["comparison"] |= {"measured": {"file": "mine.csv"}, "quantities": []}
    identified = {"torque": "torque", "front": "front", "rear": "rear", "band": [0.2, 3]}
    identified |= {
        "stiffness": 3.69e7,
        "tolerance": 0.05,
        "stiffness_of": "stiffness of shafts: LSS",
        "turn": 4.0,
    }
    small["comparison"]["identified"] = [identified]
    small["inputs"]["values"][0] |= {"band": None, "measured_by": "torque"}
    standing = validate_project(Project.model_validate(small), tmp_path)
    assert standing.states[3].lacks == ()
    assert 0.0 < standing.measured.spreads["stiffness of shafts: LSS"] < 0.05
    methods = [row["method"] for row in standing.tables["identification"]]
    assert {"A, time", "B, differential", "C, constant", "fit of spectra"} <= set(methods)
    change(small, "inputs.values.0.value", 4e7)
    assert "is 40000000.0 N m/rad in step 4 and 36900000.0" in lacks_of(small, tmp_path, 6)
    change(small, "comparison.identified.0.stiffness_of", "")
    assert "nothing under identified of step 6 is named" in lacks_of(small, tmp_path, 4)


def test_a_hash_is_of_values_and_not_of_words() -> None:
    machine = library_machine(MACHINE)
    other = machine.model_copy(update={"title": "mine", "sources": ("a thesis",)})
    assert drivetrain_hash(other) == drivetrain_hash(machine)
    rotor = machine.rotor.model_copy(update={"inertia": machine.rotor.inertia * (1 + 1e-12)})
    assert drivetrain_hash(machine.model_copy(update={"rotor": rotor})) != drivetrain_hash(machine)
    scene = library_scene("two_bearings")
    assert drivetrain_hash(scene) != drivetrain_hash(change_scene(scene, {"mesh.shaft": 0.77}))
    assert drivetrain_record(scene, "a").title == scene.title


def test_a_page_stamps_what_is_of_its_drivetrain() -> None:
    page = Page()
    page.holds("before", True, why="w", source="s")
    page.about(read_drivetrain(MACHINE), MACHINE)
    page.holds("after", True, why="w", source="s")
    page.found("margin [-]", 0.2, loads=(RESONANCE,))
    page.skip("share", "NGSolve is not there")
    assert [v.of for v in page.checks] == ["", OWN.hash]
    assert page.figures[0].of == OWN.hash
    assert page.drivetrains == [OWN]
    assert page.skipped == ["share: NGSolve is not there"]


def test_a_command_on_a_scene_states_its_hash_and_a_digest(invoke: Invoke, tmp_path: Path) -> None:
    sizes = {key: size for key, size in COARSE.items() if key.startswith("mesh.")}
    words = [word for key, size in sizes.items() for word in ("--set", f"{key}={size}")]
    status, _, error = invoke("check", "two_bearings", *words, "--out", "out")
    assert status == 0, error
    text = (tmp_path / "out/results.json").read_text("utf-8")
    results = read_results(tmp_path / "out/results.json")
    scene = change_scene(library_scene("two_bearings"), sizes)
    assert results.drivetrains == [drivetrain_record(scene)]
    assert results.digest == results_digest(text)


def test_a_limit_needs_a_quantity() -> None:
    with pytest.raises(InputError, match="has a limit and no quantity"):
        EvidenceLink.model_validate({"case": "group/run", "at_most": 1.0})
    with pytest.raises(InputError, match="a check and a quantity"):
        EvidenceLink.model_validate({"case": "group/run", "check": "a", "quantity": "b"})
    with pytest.raises(ValueError, match="finite"):
        EvidenceLink.model_validate({"case": "g/r", "quantity": "b", "at_most": np.inf})


def test_ready_commands_name_cases_machine_and_paths_as_a_shell_takes_them(
    small: Content, tmp_path: Path
) -> None:
    folder = tmp_path / "my project"
    folder.mkdir()
    small["failure_modes"]["gaps"][0]["evidence"][0]["case"] = "procedure/machine_gaps"
    small["comparison"]["measured"]["file"] = "reports/procedure/campaign/measured.csv"
    for name in ("wind.csv", "model.csv"):
        (tmp_path / name).rename(folder / name)
    standing = validate_project(Project.model_validate(small), folder)
    file = folder / "p.yaml"
    assert ready_commands(standing, file) == [
        f"fe-drivetrain run --out '{folder}/reports' --set drivetrain={MACHINE} "
        "procedure/machine_gaps procedure/campaign",
        f"fe-drivetrain validate '{file}'",
    ]


def test_commands_repeat_what_was_typed_or_follow_from_the_name(
    small: Content, tmp_path: Path
) -> None:
    """Results of another drivetrain keep their files of loads; what is not there has an example."""
    typed = f"fe-drivetrain life {MACHINE} --loads a.outb --catalogue b.yaml"
    more = {"command": f"{typed} --quick", "quick": True}
    write_case(tmp_path / "reports", "life/mine", drivetrains=[OTHER], **more)
    in_time = ("transient/mine-grid-loss", "transient/mine-offset", "transient/mine-operation")
    names = ("life/mine", *in_time, "gears/mine")
    small["model"]["evidence"] = [{"case": name} for name in (*names, "transient/mine")]
    standing = validate_project(Project.model_validate(small), tmp_path)
    out = f"--out {tmp_path}/reports"
    assert ready_commands(standing, tmp_path / "p.yaml")[:-1] == [
        typed,
        f"fe-drivetrain transient {MACHINE} grid-loss {out}/transient/mine-grid-loss",
        f"fe-drivetrain transient {MACHINE} offset --value coupling=1000000 --value y=0.001 "
        f"{out}/transient/mine-offset",
        f"fe-drivetrain transient {MACHINE} operation --loads 'outputs/*.outb' --csv "
        f"{out}/transient/mine-operation",
        f"fe-drivetrain gears {MACHINE} {out}/gears/mine",
    ]


def test_a_level_rests_on_the_errors_that_results_state(small: Content, tmp_path: Path) -> None:
    """From the level on from which all are within; the strictest of several results decides."""
    small["model"]["needs"] = [{"quantity": "torques of shafts", "tolerance": 0.05}]
    small["model"]["evidence"] = [{"case": "transient/a"}, {"case": "transient/b"}]
    levels = ["torsional", "rigid bodies", "flexible shafts"]

    def write(name: str, errors: list[float | None], own: float) -> None:
        found = Findings()
        state_level_errors(found, levels, {"torques of shafts": Errors(errors, own)})
        write_case(tmp_path / "reports", name, figures=found.tables)

    def lacks() -> str:
        states = validate_project(Project.model_validate(small), tmp_path).states
        return " ".join(states[1].lacks)

    write("transient/a", [np.inf, 0.03, 0.0], 0.01)
    write("transient/b", [0.02, 0.03, 0.0], 0.01)
    assert lacks() == ""
    small["model"]["level"] = "torsional"
    assert "needs 'rigid bodies'" in lacks()
    write("transient/b", [0.02, 0.045, 0.0], 0.01)
    assert "needs 'flexible shafts'" in lacks()
    write("transient/b", [0.02, 0.03, 0.0], 0.06)
    assert "no level is known to give torques of shafts within 5 %" in lacks()


def test_a_project_of_a_drivetrain_of_ones_own_is_on_results_of_commands(
    invoke: Invoke, tmp_path: Path
) -> None:
    status, out, error = invoke("validate", "p.yaml", "--new", "--drivetrain", "nrel_5mw")
    assert status == 0, error
    assert "has the six steps of 'NREL 5 MW reference drivetrain" in out
    commands = [line.split()[1] for line in out.splitlines() if line.startswith("  ")]
    assert commands == ["transient"] * 2 + [
        "modes",
        *["transient"] * 2,
        "gears",
        "life",
        "validate",
    ]
    project = read_project(tmp_path / "p.yaml")
    standing = validate_project(project, tmp_path)
    assert all(state.begun for state in standing.states)
    assert {one.state for state in standing.states for one in state.evidence} == {"missing"}
    # every quantity that it names, results have: of channels by their names, others by constants
    names = {one.link.quantity for state in standing.states for one in state.evidence} - {""}
    channels = {n for n in names if n.startswith(("largest ", "least torque"))}
    shafts, bearings = {"LSS"}, {"HS-A"}
    assert {n.partition(" of ")[2] for n in channels} == shafts | bearings
    assert names - channels == {
        MARGIN_OF_MODES,
        LEAST_SAFETY,
        *(f"shortest L10mr of {whose}" for whose in ("gearbox bearings", "main bearings")),
    }
    assert invoke("validate", "p.yaml", "--drivetrain", "nrel_5mw")[0] == 2


def test_a_new_project_is_begun_in_sentences_with_commands(invoke: Invoke, tmp_path: Path) -> None:
    status, out, error = invoke("validate", "my file.yaml", "--new")
    assert status == 0, error
    commands = [line.strip() for line in out.splitlines() if line.startswith("  ")]
    assert commands[-1] == "fe-drivetrain validate 'my file.yaml'"
    status, out, _ = invoke("validate", "my file.yaml")
    assert status == 1
    assert "its evidence is not there: run procedure/machine_gaps." in out
    assert all(f"  {command}\n" in out for command in commands)
