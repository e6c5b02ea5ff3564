"""Cases of gears and dampers on a drivetrain of a user: what they answer, and what they refuse."""

from collections.abc import Callable
from pathlib import Path

import pytest

from fe_drivetrain.cases.drivetrain import damping, fe_low_speed_shaft
from fe_drivetrain.cases.gear import (
    gear_damage,
    nrel_5mw_rating,
    slices,
    time_factors,
    tooth_stiffness,
)
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.reading import parse_drivetrain
from fe_drivetrain.report.seal import drivetrain_hash
from fe_drivetrain.report.suite.case import all_cases
from fe_drivetrain.report.suite.findings import OF_NONE
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.run import Run

GEARS = """
title: Turbine with gears of a user
rotor: {inertia: 5.0e5, mass: 1.0e4}
shaft: {name: slow, length: 1.5, torsion: 3.0e7}
gearbox:
  stages:
    - kind: planetary
      teeth: {ring: 96, planet: 37, sun: 21}
      planets: 3
      module: 0.01
      centre_distance: 0.294
      face_width: 0.22
      cutter: 40
      carrier: {inertia: 60}
      strength:
        gears:
          ring: {steel: nitrided, quality: MQ}
          planet: {steel: case-hardened, quality: MQ}
          sun: {steel: case-hardened, quality: MQ}
        grade: 6
        application: 1.2
    - kind: parallel
      teeth: {gear: 98, pinion: 24}
      module: 0.006
      helix: 12
      hand: 1
      face_width: 0.18
      strength:
        gears:
          gear: {steel: case-hardened, quality: MQ}
          pinion: {steel: case-hardened, quality: MQ}
        grade: 6
  shafts:
    - {name: middle, torsion: 2.0e7}
    - {name: quick, torsion: 2.0e6}
generator: {inertia: 30}
operation: {rated_power: 7.5e5, rotor_speed: [1.0, 2.3], lubricant: VG 320}
damping: {shafts: 0.006, meshes: 0.05}
"""


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("drivetrain/damping", "The first mode"),
        ("gear/gear_damage", "damage"),
        ("gear/mesh_wave", "stage 1 sun-planet has fewest"),
        ("gear/nrel_5mw_rating", "where 1.25 is asked"),
        ("gear/nrel_750kw", "The file leaves them to ISO 6336-1"),
        ("gear/slices", "35 slices give K_Hbeta of all 3 meshes"),
        ("gear/subsurface", "presses most"),
        ("gear/time_factors", "Teeth of the stage 2 pinion are loaded most often"),
    ],
)
def test_a_case_answers_for_gears_of_the_users(
    name: str, words: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(slices, "FINEST", 70)
    monkeypatch.setattr(slices, "MISALIGNED", slices.MISALIGNED[3:4])
    monkeypatch.setattr(slices, "COUNTS", (5, 35))
    monkeypatch.setattr(slices, "PHASES", (16, 32))
    file = tmp_path / "mine.yaml"
    file.write_text(GEARS, "utf-8")
    results = all_cases()[name].results(Run({"drivetrain": str(file)}, True, tmp_path))
    own = drivetrain_hash(parse_drivetrain(GEARS))
    assert [record.hash for record in results.drivetrains] == [own]
    assert own in {verdict.of for verdict in results.verdicts} <= {own, OF_NONE}
    assert results.passed
    assert words in results.answer.verdict
    answer = results.answer.model_dump_json() + results.title
    assert not [word for word in ("5 MW", "750 kW", "thesis", "KISSsoft") if word in answer]
    assert any("printed numbers" in note for note in results.notes)


@pytest.mark.parametrize(
    ("run", "change", "message"),
    [
        (gear_damage.run, ("lubricant: VG 320", ""), "needs: give operation.lubricant"),
        (nrel_5mw_rating.run, ("        grade: 6\n", ""), "stage 1: strength.grade; stage 2"),
        (nrel_5mw_rating.run, ("operation:", "# operation:"), "does not state operation: add it"),
        (slices.run, ("module: 0.01\n", "module: 0.01\n      ratio: 5.0\n"), "teeth"),
        (damping.run, ("damping:", "# damping:"), "does not state its damping: add it"),
        (fe_low_speed_shaft.run, ("", ""), "does not state shaft.sections"),
        (tooth_stiffness.run, ("face_width: 0.22", "face_width: 0.22\n      helix: 7.5"), "helix"),
        (time_factors.run, ("operation:", "# operation:"), "does not state operation"),
    ],
)
def test_a_case_of_gears_names_the_key_that_a_drivetrain_lacks(
    run: Callable[[Run, Page], None], change: tuple[str, str], message: str, tmp_path: Path
) -> None:
    file = tmp_path / "mine.yaml"
    file.write_text(GEARS.replace(*change) if change[0] else GEARS, "utf-8")
    with pytest.raises(InputError, match=message):
        run(Run({"drivetrain": str(file)}, True, tmp_path), Page())
