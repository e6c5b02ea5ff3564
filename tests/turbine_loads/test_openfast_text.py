"""Text output of OpenFAST as it comes: old units, INVALID, exponents without E, stars, headers."""

from __future__ import annotations

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from hub_load_tables import COLUMNS, LOADS, TIME, openfast_text

from fe_drivetrain.command_line.option_names import with_options
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.studies.load_cautions import _why_left_out
from fe_drivetrain.turbine_loads.hub_loads.channel_map import ChannelMap
from fe_drivetrain.turbine_loads.hub_loads.files import read_hub_loads
from fe_drivetrain.turbine_loads.hub_loads.openfast import turn_to_fixed
from fe_drivetrain.turbine_loads.hub_loads.openfast_output import openfast_channels
from fe_drivetrain.turbine_loads.hub_loads.recorded import Recorded, read_recorded

KN_M, KN = "kN-m", "kN"


def is_right(found: Recorded, wind: bool = True) -> str:
    """The loads are those of the columns; how they were read."""
    np.testing.assert_allclose(found.history.time, TIME, atol=1e-12)
    np.testing.assert_allclose(found.history.loads, LOADS, atol=1e-2)
    assert (found.wind_speed is not None) is wind
    assert found.rotor_speed == pytest.approx(0.4 * np.pi + 0.0 * TIME)
    return str(found.history.attributes["channels"])


def test_a_channel_that_is_invalid_is_left_out_with_a_note(tmp_path: Path) -> None:
    file = openfast_text(tmp_path / "a.out", {"Wind1VelX": "INVALID"})
    assert is_right(read_recorded(file), wind=False).endswith("INVALID in the file: Wind1VelX")
    with pytest.raises(InputError, match=r"Wind1VelX is INVALID.*name another, or correct OutList"):
        read_recorded(file, ChannelMap(channels={"wind speed": "Wind1VelX"}))


def test_the_next_alias_is_taken_of_an_invalid_channel(tmp_path: Path) -> None:
    zeros = 0.0 * TIME
    columns = COLUMNS | {"LSShftFxa": ("INVALID", zeros), "LSSTipVxa": ("INVALID", zeros)}
    read = is_right(read_recorded(openfast_text(tmp_path / "a.out", columns=columns)))
    assert "Fx = RotThrust [kN]" in read
    assert "not read, since INVALID in the file: LSShftFxa" in read


def test_the_rotating_pair_is_taken_of_an_invalid_fixed_one(tmp_path: Path) -> None:
    azimuth = 1.2 * TIME
    columns = {**COLUMNS, "Azimuth": ("deg", np.degrees(azimuth))}
    for letter, pair in (("LSShftF", KN), ("LSSTipM", KN_M)):
        fixed = [COLUMNS[f"{letter}{axis}s"][1] for axis in "yz"]
        turned = turn_to_fixed(*fixed, -azimuth)
        for axis, values in zip("yz", turned, strict=True):
            columns[f"{letter}{axis}a"] = (pair, np.asarray(values))
            columns[f"{letter}{axis}s"] = ("INVALID", 0.0 * TIME)
    read = is_right(read_recorded(openfast_text(tmp_path / "a.out", columns=columns)))
    assert "LSShftFya [kN], LSShftFza [kN], turned back by Azimuth" in read
    none = openfast_text(tmp_path / "b.out", {"RotThrust": "INVALID"})
    with pytest.raises(
        InputError, match=r"no channel for the thrust, not read, since INVALID.*Rot"
    ):
        read_hub_loads(none)


@pytest.mark.parametrize(
    "units",
    [
        {"Time": "sec", "Wind1VelX": "m/sec", "RotSpeed": "RPM"},
        {"RotSpeed": "1/min"},
        {"RotSpeed": "U/min", "RotThrust": "kN ".strip(), "RotTorq": "kN*m"},
    ],
)
def test_units_as_old_programs_spell_them(tmp_path: Path, units: dict[str, str]) -> None:
    found = read_recorded(openfast_text(tmp_path / "a.out", units))
    is_right(found)
    np.testing.assert_allclose(found.wind_speed, COLUMNS["Wind1VelX"][1], atol=1e-6)


@pytest.mark.parametrize(
    ("cell", "number"),
    [("1.234567-101", 1.234567e-101), ("-1.5+100", -1.5e100), ("2.5D+02", 250.0), (".5-300", 0.0)],
)
def test_an_exponent_of_three_digits_has_no_e(tmp_path: Path, cell: str, number: float) -> None:
    file = openfast_text(tmp_path / "a.out", cells={(5, "LSShftFys"): cell})
    found = openfast_channels(file, {"lsshftfys", "time"})["lsshftfys"].values
    assert found[5] == pytest.approx(number, rel=1e-15, abs=1e-300)
    np.testing.assert_allclose(np.delete(found, 5), np.delete(COLUMNS["LSShftFys"][1], 5), 1e-8)


@pytest.mark.parametrize("cell", ["*********", "-1.2****", "Infinity?", "1_0", "0x10"])
def test_a_bad_cell_matters_where_it_is_read(tmp_path: Path, cell: str) -> None:
    also = {"TwrBsMxt": (KN_M, 1.0 + TIME)}
    file = openfast_text(tmp_path / "a.out", cells={(4, "TwrBsMxt"): cell}, columns=COLUMNS | also)
    is_right(read_recorded(file))
    with pytest.raises(InputError, match=r"line 13, channel TwrBsMxt: '.*") as caught:
        read_recorded(file, also=["TwrBsMxt"])
    stars = "*" in cell
    assert ("widen OutFmt of the .fst file" in str(caught.value)) is stars
    assert ("write the binary file (OutFileFmt 2)" in str(caught.value)) is stars


def test_values_that_grew_together_are_named(tmp_path: Path) -> None:
    file = openfast_text(tmp_path / "a.out")
    lines = file.read_text().replace("\t", " ").split("\n")
    lines[10] = lines[10].replace(" -", "-")
    file.write_text("\n".join(lines))
    with pytest.raises(InputError, match=r"line 11 has 8 values for 9 .*grown together; widen Out"):
        read_hub_loads(file)


@pytest.mark.parametrize("before", [0, 2, 4, 9])
def test_the_header_is_found_wherever_it_is(tmp_path: Path, before: int) -> None:
    is_right(read_recorded(openfast_text(tmp_path / "a.out", before=before)))


def test_a_header_that_is_repeated_within_a_run_is_skipped(tmp_path: Path) -> None:
    file = openfast_text(tmp_path / "a.out")
    lines = file.read_text().split("\n")
    file.write_text("\n".join([*lines[:15], "", *lines[6:8], *lines[15:]]))
    is_right(read_recorded(file))
    file.write_text("\n".join([*lines[:15], *lines[6:]]))
    with pytest.raises(InputError, match="line 16 has the names of channels again, where a second"):
        read_recorded(file)
    other = lines[6].replace("RotThrust", "RotPwr")
    file.write_text("\n".join([*lines[:15], other, *lines[7:8], *lines[15:]]))
    with pytest.raises(InputError, match="line 16 has other names of channels than line 7"):
        read_recorded(file)


def test_moments_at_the_gage_are_a_caution_of_what_there_is(tmp_path: Path) -> None:
    columns = {name.replace("Tip", "Gag"): column for name, column in COLUMNS.items()}
    file = openfast_text(tmp_path / "a.out", columns=columns)
    history = read_recorded(file, measured=True).history
    assert history.absent == ("My", "Mz")
    read = str(history.attributes["channels"])
    (why,) = _why_left_out(SimpleNamespace(files=SimpleNamespace(channels={read: 1})))  # type: ignore[arg-type]
    assert "LSSGagMys and LSSGagMzs are moments at the strain gage" in why
    assert "give moments_at in --mapping" in with_options(why)
    shaft = ChannelMap(moments_at=2.0)
    carried = read_recorded(file, shaft).history.component("My")
    np.testing.assert_allclose(carried, LOADS[:, 4] - 2.0 * LOADS[:, 2], atol=1e-2)
