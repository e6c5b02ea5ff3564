"""``export``: what it writes, and what it refuses."""

from pathlib import Path

import numpy as np
import pytest
import yaml
from coarse_scenes import coarse_scene

from fe_drivetrain import export
from fe_drivetrain.command_line.app import main
from fe_drivetrain.export.files import FORMATS
from fe_drivetrain.export.scene_export import superelement_of
from fe_drivetrain.export.turning_files import TURNING_FORMATS
from fe_drivetrain.shafts.fidelity.ladder import housing_springs, shaft_level
from fe_drivetrain.studies import export_content

CONDENSED = ("main_bearing_bonded", "--out", "a", "--format", "csv")


def exported(monkeypatch: pytest.MonkeyPatch, *arguments: str) -> int:
    monkeypatch.setattr("sys.argv", ["fe-drivetrain", "export", *arguments])
    with pytest.raises(SystemExit) as end:
        main()
    return int(end.value.code or 0)


def test_export_lists_every_format(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert exported(monkeypatch, "--list") == 0
    head, *lines = capsys.readouterr().out.splitlines()
    assert head.split() == ["format", "holds", "ending", "read", "by", "needs"]
    assert [line.split()[:2] for line in lines] == [
        *([name, "part"] for name in FORMATS),
        *([name, "turning"] for name in TURNING_FORMATS),
    ]
    for line, form in zip(lines, (*FORMATS.values(), *TURNING_FORMATS.values()), strict=True):
        assert form.suffix in line
        assert form.reader in line
        assert (f"fe-drivetrain[{form.extra}]" in line) == bool(form.extra)


def test_export_condenses_and_writes(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    """The free shaft and a bearing, as Python gives them."""
    scene = coarse_scene("bonded")
    file = tmp_path / "mine.yaml"
    file.write_text(yaml.safe_dump(scene.model_dump(mode="json")), "utf-8")
    out = tmp_path / "out.csv"
    common = (str(file), "--format", "csv", "--out", str(out))
    for arguments, element in (
        (("--at", "hub,gearbox", "--level", "auto"), superelement_of(scene, at=["hub", "gearbox"])),
        (("--what", "main_bearing"), superelement_of(scene, "main_bearing")),
    ):
        assert exported(monkeypatch, *common, *arguments, "--overwrite") == 0
        said = capsys.readouterr().out
        assert f"{element.name} at {', '.join(element.points)}, " in said
        found = export.read_superelement(out, "csv")
        assert found.points == element.points
        assert found.supported == element.supported
        assert found.band == element.band
        assert found.origin == element.origin
        np.testing.assert_array_equal(found.stiffness, element.stiffness)
        assert (found.mass is None) == (element.mass is None)
    assert [path.name for path in tmp_path.iterdir() if path.name.startswith(".")] == []


def test_several_formats_are_of_one_condensation(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    """The files begin with the stem, or with the part in a folder; all appear or none."""
    element = superelement_of(coarse_scene("bonded"), "main_bearing")
    calls: list[str] = []
    monkeypatch.setattr(
        export_content, "superelement_of", lambda *_: calls.append("condensed") or element
    )
    monkeypatch.chdir(tmp_path)
    formats = [word for name in ("csv", "dmig", "subdyn", "op4") for word in ("--format", name)]
    asked = ("main_bearing_bonded", "--what", "main_bearing", *formats)
    endings = ("-csv.csv", "-dmig.bdf", "-subdyn.dat", "-op4.op4")
    Path("folder").mkdir()
    for out, stem in (("unit", "unit"), ("folder", "folder/main_bearing")):
        assert exported(monkeypatch, *asked, "--out", out) == 0
        said = capsys.readouterr().out
        assert said.splitlines()[-4:] == [f"{stem}{ending}" for ending in endings]
        assert f"Bound of bearing units: {element.bound}. Rollers: {element.rollers}." in said
        assert "Format op4 leaves out" in said
        for name, ending in zip(("csv", "dmig"), endings, strict=False):
            found = export.read_superelement(f"{stem}{ending}", name)
            assert (found.bound, found.band) == (element.bound, element.band)
    assert calls == ["condensed"] * 2
    # a unit at rest has no mass, which the second format asks for
    there = sorted(tmp_path.rglob("*"))
    assert exported(monkeypatch, *asked, "--format", "extptfm", "--out", "other") == 2
    assert "has no mass" in capsys.readouterr().err
    assert exported(monkeypatch, *asked, "--out", "unit") == 2
    assert "--out unit-csv.csv exists" in capsys.readouterr().err
    assert sorted(tmp_path.rglob("*")) == there


def test_the_exported_drivetrain_stands_on_springs_within_its_band() -> None:
    scene = coarse_scene("bonded")
    element = superelement_of(scene, "drivetrain", level=1)
    assert element.points == ("hub",)
    assert element.supported
    assert element.origin.level.startswith("1 ")
    soft = shaft_level(scene, 1, housing_springs(scene)[0]).stiffness(["hub"])
    size = np.sqrt(np.outer(element.stiffness.diagonal(), element.stiffness.diagonal()))
    apart = np.abs((element.stiffness - soft) / size).max(axis=1)
    assert element.band is not None
    assert element.band.axial == pytest.approx(apart[0])
    assert element.band.torsion == pytest.approx(apart[3])
    assert element.band.bending == pytest.approx(apart[[1, 2, 4, 5]].max())
    # faces that keep their shape are never softer
    assert np.linalg.eigvalsh((element.stiffness - soft) / size)[0] > -1e-9


def test_export_overwrites_only_if_asked(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    for name, more in (("a.json", ("--format", "json")), ("a.vtu", ())):
        out = tmp_path / name
        out.write_text("mine")
        arguments = ("main_bearing_bonded", "--out", str(out), *more)
        assert exported(monkeypatch, *arguments) == 2
        assert "add --overwrite" in capsys.readouterr().err
        assert out.read_text() == "mine"
    # what fails leaves the file as it was, and nothing beside it
    assert exported(monkeypatch, *arguments, "--overwrite", "--set", "shaft.front=7") == 2
    assert out.read_text() == "mine"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["a.json", "a.vtu"]


@pytest.mark.parametrize(
    ("arguments", "hint"),
    [
        ((), "Missing SCENE"),
        (("main_bearing_bonded",), "Missing --out FILE"),
        (("main_bearing_bonded", "--out", "a.inp", "--at", "hub"), "--at needs --format"),
        (("main_bearing_bonded", "--out", "a.inp", "--level", "2"), "--level needs --format"),
        (("main_bearing_bonded", "--out", "a.csv"), "or give --format"),
        (("main_bearing_bonded", "--out", "a", "--format", "xyz"), "use json, csv"),
        (("main_bearing_bonded", "--out", "no/a", "--format", "csv"), "existing folder"),
        ((*CONDENSED, "--format", "csv"), "--format csv is given twice"),
        ((*CONDENSED, "--format", "dmig", "--out", "a.bdf"), "--out a.bdf is one file, but 2"),
        ((*CONDENSED, "--format", "dmig", "--out", "no/a"), "begin the names of files"),
        ((*CONDENSED, "--format", "dmig", "--format", "ross"), "all that turns, as ross asks for"),
        ((*CONDENSED, "--format", "json", "--modes", "3"), "not as --format csv"),
        (
            ("nrel_5mw", *CONDENSED[1:], "--format", "elastodyn", "--template", "a"),
            "add --level torsional",
        ),
        (
            (*CONDENSED, "--what", "tower"),
            "use one of shaft, drivetrain, seats, main_bearing",
        ),
        (
            (*CONDENSED, "--level", "9"),
            "level 9 of shaft is unknown: use auto or one of 1, 2, 3",
        ),
        (
            (*CONDENSED, "--level", "two"),
            "level 'two'",
        ),
        ((*CONDENSED, "--at", ","), "none must be"),
        ((*CONDENSED, "--modes", "3"), "--modes is written in json, not as --format csv"),
        ((*CONDENSED, "--what", "summary"), "--what summary is json, not csv"),
        (
            (*CONDENSED, "--at", "hub,hub"),
            "each once",
        ),
        (
            (*CONDENSED, "--what", "main_bearing", "--at", "hub"),
            "its only point is 'main_bearing'",
        ),
        (
            (*CONDENSED, "--level", "1", "--at", "nose"),
            "point 'nose' is unknown",
        ),
    ],
)
def test_wrong_options_of_export_are_refused(
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    arguments: tuple[str, ...],
    hint: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    assert exported(monkeypatch, *arguments) == 2
    said = capsys.readouterr().err
    assert hint in said
    assert "Traceback" not in said
    assert not list(tmp_path.iterdir())
