"""``loads`` on a torque alone: the answer, what is left out by name, and who refuses it."""

import csv
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from tiny_case import Result

from fe_drivetrain.report.results import read_results

TIME = 0.1 * np.arange(1200)
TORQUE = 1000.0 + 200.0 * np.sin(2.0 * np.pi * 0.25 * TIME)  # kN m
LEFT_OUT = "Fx, Fy, Fz, My, Mz are not recorded, so not known rather than zero. Left out: "


def write(path: Path, header: str, *columns: np.ndarray) -> str:
    rows = zip(*(column.tolist() for column in columns), strict=True)
    path.write_text("\n".join([header, *(",".join(map(repr, row)) for row in rows)]) + "\n")
    return str(path)


@pytest.fixture
def torque(tmp_path: Path) -> str:
    header = "time [s],torque [kN m],rotor speed [rpm]"
    return write(tmp_path / "t.csv", header, TIME, TORQUE, 15.0 + 0.0 * TIME)


def test_the_page_of_a_torque_alone(
    invoke: Callable[..., Result], torque: str, tmp_path: Path
) -> None:
    out = tmp_path / "out"
    status, printed, err = invoke("loads", torque, "--out", str(out), "--scene", "two_bearings")
    assert status == 0, err
    assert printed.startswith(
        "Torque alone: it reaches 1,200 kN m, 1,000 kN m on average; its equivalent load, slope 3, "
    )
    results = read_results(out / "results.json")
    assert results.notes[0] == (
        f"{LEFT_OUT}their statistics, cycles and spectra; direction and loops of force and moment; "
        "bearing reactions, which need all six components."
    )
    captions = [
        getattr(part, "caption", "") for section in results.sections for part in section.items
    ]
    assert any("Load revolution distribution of the torque" in caption for caption in captions)
    assert any(caption.startswith("Power spectral density") for caption in captions)
    for absent in ("Fy", "My", "bending", "orce", "Direction"):
        assert not [caption for caption in captions if absent in caption], absent
    tables = {file.stem for file in out.glob("*.csv")}
    assert not tables & {"loops", "reactions", "reaction_loops"}
    lines = (out / "levels.csv").read_text().splitlines()
    rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    assert {row["channel"] for row in rows} == {"Mx"}
    turns = sum(float(row["amount"]) for row in rows if row["of"] == "turns")
    assert turns == pytest.approx(120.0 * 0.25)


def test_gaps_and_uneven_steps_are_stated(invoke: Callable[..., Result], tmp_path: Path) -> None:
    kept = (TIME < 40.0) | (TIME > 52.0)
    kept &= np.arange(len(TIME)) % 7 > 0
    start = np.datetime64("2024-03-01T12:00:00.000")
    rows = [
        f"{start + np.timedelta64(round(1e3 * t), 'ms')},{q!r}"
        for t, q in zip(TIME[kept].tolist(), TORQUE[kept].tolist(), strict=True)
    ]
    file = tmp_path / "logger.csv"
    file.write_text("\n".join(["timestamp,Mx [kN m]", *rows]) + "\n")
    out = tmp_path / "out"
    status, _, err = invoke("loads", str(file), "--out", str(out))
    assert status == 0, err
    notes = " ".join(read_results(out / "results.json").notes)
    assert "logger is sampled unevenly, every 0.1 to 0.2 s, usually 0.1 s" in notes
    assert "straight lines between samples, every 0.1 s" in notes
    before, after = TIME[kept & (TIME < 40.0)][-1], TIME[kept & (TIME > 52.0)][0]
    gap, begin = f"{after - before:.4g}", TIME[kept][0]
    whole = f"{TIME[kept][-1] - begin:.4g} s"
    place = f"the longest {gap} s from {before - begin:.12g} s on"
    assert f"logger has a gap, {gap} of {whole}, {place}" in notes
    assert "0 s at 2024-03-01T12:00:00.100000" in (out / "files.csv").read_text()


def test_a_torque_of_the_generator_says_whose_it_is(
    invoke: Callable[..., Result], tmp_path: Path
) -> None:
    file = write(tmp_path / "g.csv", "time [s],HSS torque [kN m]", TIME, TORQUE / 100.0)
    status, printed, err = invoke("loads", file, "--out", str(tmp_path / "out"))
    assert status == 0, err
    assert printed.startswith("Torque alone, of the high-speed shaft: it reaches 12 kN m, ")
    assert "gearbox_ratio in a mapping makes it the rotor's torque" in printed
    (tmp_path / "map.yaml").write_text("gearbox_ratio: 100\n")
    again = ("--mapping", str(tmp_path / "map.yaml"), "--out", str(tmp_path / "again"))
    status, printed, err = invoke("loads", file, *again)
    assert status == 0, err
    assert printed.startswith("Torque alone: it reaches 1,200 kN m, ")


def test_some_components_are_counted(invoke: Callable[..., Result], tmp_path: Path) -> None:
    wave = np.sin(TIME)
    file = write(tmp_path / "f.csv", "time [s],Fx [kN],Fz [kN]", TIME, 300 + 9 * wave, wave - 400)
    status, printed, err = invoke("loads", file, "--out", str(tmp_path / "out"))
    assert status == 0, err
    assert printed.startswith("Fx, Fz alone: peak thrust Fx is 309 kN; the equivalent load of Fx, ")
    status, _, err = invoke("loads", file, "--ultimate", "My=9 MNm", "--out", str(tmp_path / "no"))
    assert status == 2
    assert "an ultimate load of My is given, which not every file has (Fx, Fz are there)" in err


@pytest.mark.parametrize("command", ["study", "life"])
def test_statics_refuse_a_torque_alone(
    invoke: Callable[..., Result], torque: str, tmp_path: Path, command: str
) -> None:
    out = tmp_path / "out"
    status, _, err = invoke(command, "two_bearings", "--loads", torque, "--out", str(out))
    assert status == 2
    assert "no column Fx, Fy, Fz, Mx, My, Mz" in err or "no column Fx, Fy, Fz, My, Mz" in err
    assert "reactions need all six" in err
    assert not out.exists()
