"""``report``: one folder that answers, made once, and made again where something has changed."""

import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from answer_rules import broken_rules
from hub_load_tables import swinging_loads
from tiny_case import Result

from fe_drivetrain.command_line import printing
from fe_drivetrain.command_line.dossier import content_of
from fe_drivetrain.command_line.dossier_works import turning_works
from fe_drivetrain.command_line.report_request import ReportRequest
from fe_drivetrain.drivetrain_file import change_scene, library_scene, read_drivetrain
from fe_drivetrain.drivetrain_file.without_weight import weightless
from fe_drivetrain.report.answer import Answer, KeyFigure
from fe_drivetrain.report.environment import environment
from fe_drivetrain.report.results import Results, read_results
from fe_drivetrain.report.suite.case import QUICK
from fe_drivetrain.studies.dossier_overview import (
    AROUND_PEAK,
    EXTREMES,
    LIFE,
    LIVES,
    REACTIONS,
    dossier,
    life_chart,
)

pytestmark = pytest.mark.usefixtures("kept_between_runs")

SCENE = "main_bearing_spherical"
COARSE = ("mesh.shaft=0.5", "mesh.bearing=0.2", "mesh.housing=0.3", "mesh.elements_per_turn=6")


@pytest.fixture
def loads(tmp_path: Path) -> Path:
    """A minute of loads that swing, and the rotor's speed."""
    return swinging_loads(tmp_path / "gust.csv", 60.0)


def test_a_dossier_answers_and_is_made_once(
    invoke: Callable[..., Result], loads: Path, tmp_path: Path
) -> None:
    out = tmp_path / "boss"
    words = ["report", SCENE, "--loads", str(loads), "--quick", "--out", str(out)]
    words += [word for change in COARSE for word in ("--set", change)]
    status, said, error = invoke(*words)
    assert status == 0, error
    pages = {folder.name for folder in (out / "dossier").iterdir()}
    assert pages == {"overview", "loads", "reactions", "life", "model", "check", "export"}
    overview = read_results(out / "dossier/overview/results.json")
    assert broken_rules(overview) == []
    assert overview.answer is not None
    typed = overview.answer.verdict.replace("\u00a0", " ").replace("\u202f", ",")
    assert said.splitlines()[0] == typed
    assert overview.links[0].title == "Overview"
    life = read_results(out / "dossier/life/results.json")
    assert life.notes
    for note in life.notes:
        assert f"life: {note}" in overview.answer.cautions or note == QUICK
    extremes = {(row["place"], row["load"]): row for row in overview.figures["extremes"]}
    assert extremes["hub", "My"]["largest [kN m]"] == pytest.approx(600.0, rel=0.05)
    assert extremes["hub", "My"]["file"] == "gust"

    made = {path: path.stat().st_mtime_ns for path in (out / "dossier").rglob("results.json")}
    assert invoke(*words)[0] == 0
    assert {path: path.stat().st_mtime_ns for path in made} == made


def test_a_whole_drivetrain_has_parts_of_all_that_turns(loads: Path) -> None:
    asked = ReportRequest("mine", [str(loads)])
    assert turning_works(asked, library_scene(SCENE)) == {}
    assert turning_works(asked, library_scene("iea_15mw_main_shaft")).keys() == {"modes"}
    whole = library_scene("grc_750kw")
    assert turning_works(asked, whole).keys() == {"modes", "gears"}
    braked = change_scene(whole, {"brake": {"shaft": "HSS", "torque": 7e3}})
    assert turning_works(asked, braked).keys() == {"modes", "gears", "stop"}


def test_a_file_that_has_changed_is_other_content(loads: Path) -> None:
    asked, scene = ReportRequest(SCENE, [str(loads)]), library_scene(SCENE)
    before = content_of(asked, scene)
    assert content_of(asked, scene) == before
    loads.write_text(loads.read_text() + "60,2e5,0,-3e5,9e5,7e5,0,15\n")
    assert content_of(asked, scene) != before
    assert content_of(asked, weightless(scene)) != content_of(asked, scene)


def test_a_housing_file_that_has_changed_is_another_drivetrain(loads: Path, tmp_path: Path) -> None:
    (tmp_path / "mine.yaml").write_text(
        "title: mine\n"
        "shaft: {front: -1.2, sections: [{length: 2.8, outer_diameter: 0.4}]}\n"
        "bearing_units:\n"
        "  - bearing: {kind: ring, raceway_diameter: 0.6}\n"
        "    interface: bonded\n"
        "    housing:\n"
        "      step: block.step\n"
        "      seat: {radius: 300}\n"
        "      held: [{point: [0, 0, -420], normal: [0, 0, 1]}]\n"
        "gearbox: {stiffness: [4.0e6, 8.0e7, 8.0e7, rigid, 0, 0]}\n"
    )
    asked, found = ReportRequest(SCENE, [str(loads)]), []
    for content in ("one", "other", "one"):
        (tmp_path / "block.step").write_text(content)
        found.append(content_of(asked, read_drivetrain(tmp_path / "mine.yaml")))
    assert found[0] == found[2]
    assert found[0] != found[1]


@pytest.mark.skipif(
    not any(map(shutil.which, printing.BROWSERS)), reason="no Chromium or Chrome is installed"
)
def test_files_of_the_user_where_a_dossier_is_printed_stop_it_before_any_work(
    invoke: Callable[..., Result], loads: Path, tmp_path: Path
) -> None:
    out = tmp_path / "boss"
    mine = out / "printed" / "dossier.pdf"
    mine.parent.mkdir(parents=True)
    mine.write_text("mine")
    status, _, error = invoke("report", SCENE, "--loads", str(loads), "--pdf", "--out", str(out))
    assert status == 2
    assert "printed" in error
    assert mine.read_text() == "mine"
    assert [path.name for path in out.iterdir()] == ["printed"]


def test_without_a_browser_nothing_is_begun(
    invoke: Callable[..., Result], loads: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(printing.shutil, "which", lambda name: None)
    out = tmp_path / "boss"
    status, _, error = invoke("report", SCENE, "--loads", str(loads), "--pdf", "--out", str(out))
    assert status == 2
    assert "--pdf and --png need Chromium or Chrome" in error
    assert not out.exists()


@pytest.mark.skipif(
    not any(map(shutil.which, printing.BROWSERS)), reason="no Chromium or Chrome is installed"
)
def test_a_page_is_printed_as_a_pdf(tmp_path: Path) -> None:
    page, target = tmp_path / "page.html", tmp_path / "page.pdf"
    page.write_text("<!DOCTYPE html><title>t</title><p>One page.", encoding="utf-8")
    printing.write_pdf(printing.browser(), page, target)
    assert target.read_bytes().startswith(b"%PDF")


def test_the_shortest_life_is_of_any_bearing_that_of_a_gearbox_too() -> None:
    scene = library_scene("two_bearings")
    names = scene.bearing_names

    def found(**more: Any) -> Results:
        given = {"title": "t", "source": "s", "details": [], "verdicts": [], "sections": []}
        return Results(case="a/b", environment=environment({}), **(given | more))

    largest = [
        {"load": "radial force", "place": name, "largest [kN]": 100.0 + k}
        for k, name in enumerate(names)
    ]
    around = {"time [s]": [0.0], "radial force [kN]": {names[0]: [1.0]}, "bearing": names[0]}
    around |= {"peak [kN]": 1.0, "at [s]": 0.0, "file": "a"}
    years = dict(zip([*names, "stage 1 pin A"], (70.0, 80.0, 23.0), strict=True))
    lives = [{"bearing": name, "L10mr [years]": years[name]} for name in years]
    limits = [{"bearing": name, "min S0": 5.0, "max pressure [MPa]": 900.0} for name in years]
    parts = {
        REACTIONS: found(figures={EXTREMES: largest, AROUND_PEAK: around}),
        LIFE: found(figures={"lives": lives, "limits": limits}),
    }
    result = dossier(scene, parts)
    assert result.answer.verdict.endswith("the bearings live 23\u00a0years or more.")
    chart = life_chart(result.tables[LIVES])
    assert chart is not None
    assert "stage 1 pin A" in str(chart.figure)

    # the band that the part's answer has, by insides that fit a page, counts here, too
    wide = KeyFigure(
        name="L10mr of bearing stage 1 pin A", value=23.0, unit="years", band=9.0, status="none"
    )
    said = Answer(question="q", verdict="v", figures=[wide], status="none", cautions=["Two files."])
    parts[LIFE] = parts[LIFE].model_copy(update={"answer": said})
    silent = said.model_copy(update={"figures": [], "cautions": ["Two files.", "Other."]})
    parts[REACTIONS] = parts[REACTIONS].model_copy(update={"answer": silent})
    result = dossier(scene, parts)
    verdict = "stage 1 pin A lives 23.0 ± 9.0\u00a0years, not surely 20."
    assert result.answer.verdict.endswith(verdict)
    # what several parts say stands once
    assert result.answer.cautions == ["life, reactions: Two files.", "reactions: Other."]


def test_a_bearing_that_fails_is_seen_beside_one_that_hardly_carries() -> None:
    chart = life_chart(
        [{"bearing": name, "L10mr [years]": value} for name, value in (("a", 1.0), ("b", 1.4e5))]
    )
    assert chart is not None
    layout = chart.figure["layout"]
    assert layout["xaxis"]["type"] == "log"
    assert [shape["x0"] for shape in layout["shapes"]] == [20.0]
    assert life_chart([{"bearing": "a", "L10mr [years]": None}]) is None
    assert life_chart([{"bearing": "a", "L10mr [years]": float("inf")}]) is None


@pytest.mark.parametrize("command", ["report", "life"])
def test_a_site_for_one_file_is_refused_before_any_work(
    invoke: Callable[..., Result], loads: Path, tmp_path: Path, command: str
) -> None:
    out = tmp_path / "boss"
    words = (command, "two_bearings", "--loads", str(loads), "--site", "IIB", "--out", str(out))
    status, _, error = invoke(*words)
    assert status == 2
    assert error.splitlines()[-1] == (
        "fe-drivetrain: --site weights winds, and there is one file: give files of two winds or "
        "more, or leave --site out"
    )
    assert "..." not in error
    assert not out.exists()
