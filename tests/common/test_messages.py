"""What a user mistypes is answered at once, with what was meant."""

import os

import pytest

from fe_drivetrain.command_line.app import main
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.reading import read_scene
from fe_drivetrain.export.formats import windio
from fe_drivetrain.export.formats.summary import read_summary
from fe_drivetrain.procedure.interface_loads import read_load_json
from fe_drivetrain.report.suite.case import find_cases
from fe_drivetrain.turbine_loads.hub_loads.channel_map import ChannelMap, read_channel_map
from fe_drivetrain.turbine_loads.hub_loads.csv_table import read_csv
from fe_drivetrain.turbine_loads.hub_loads.files import read_hub_load_files
from fe_drivetrain.turbine_loads.hub_loads.openfast_output import openfast_channels
from fe_drivetrain.turbine_loads.hub_loads.recorded import read_recorded

HEADER = "time [s],Fx [N],Fy [N],Fz [N],Mx [N m],My [N m],Mz [N m]"


def test_a_pipe_or_device_as_scene_is_refused_at_once(tmp_path):
    pipe, link = tmp_path / "pipe", tmp_path / "link"
    os.mkfifo(pipe)
    link.symlink_to("/dev/zero")
    for path, says in (
        (pipe, "it is a pipe, which may have no end: write what comes from it to a file"),
        (link, "it is a device, which may have no end: write what comes from it to a file"),
        (tmp_path, "it is a folder: give a file"),
    ):
        with pytest.raises(InputError, match=says):
            read_scene(path)


def test_files_that_cannot_be_read_say_what_to_do(tmp_path):
    """No number of an error and no name of a codec, whatever is read."""
    latin, long = tmp_path / "latin.yaml", tmp_path / f"{'a' * 300}.yaml"
    latin.write_bytes("title: a\n# M\xfchle\n".encode("latin-1"))
    for path, says in (
        (tmp_path / "none.yaml", "there is no such file: check the path"),
        (latin, r"it is not UTF-8 text \(byte 0xfc in line 2\): save it as UTF-8"),
        (long, "File name too long: give another file"),
        (tmp_path / "a\0b.yaml", "its name cannot be that of a file"),
    ):
        for read in (
            read_scene,
            read_channel_map,
            windio.read_torsion,
            read_summary,
            read_load_json,
        ):
            with pytest.raises(InputError, match=f"cannot read .*{says}") as caught:
                read(path)
            assert "Errno" not in str(caught.value)
            assert "codec" not in str(caught.value)


def test_files_of_loads_that_cannot_be_read_say_what_to_do(tmp_path):
    table = tmp_path / "a.csv"
    table.write_bytes(f"{HEADER}\n0,1,2,3,4,5,6\n# M\xfch\0le\n".encode("latin-1"))
    mapped = ChannelMap(channels={"Fx": "Fx"})
    for path, says in (
        (table, "it is no text: save it as CSV in UTF-8"),
        (tmp_path / "none.csv", "there is no such file: check the path"),
        (tmp_path / f"{'a' * 300}.csv", "File name too long: give another file"),
    ):
        for read in (read_csv, read_recorded, lambda file: read_recorded(file, mapped)):
            with pytest.raises(InputError, match=says) as caught:
                read(path)
            assert "codec" not in str(caught.value)
        with pytest.raises(InputError, match=says):
            read_hub_load_files(str(path))
    with pytest.raises(InputError, match="it is a folder: give a file"):
        read_csv(tmp_path)


def test_an_openfast_file_may_have_letters_of_any_code_in_its_header(tmp_path):
    names = "Time LSShftFxa LSShftFys LSShftFzs RotTorq LSSTipMys LSSTipMzs"
    rows = [f"{t} 1 2 3 4 5 {t}" for t in range(9)]
    lines = ["", "of M\xfchle", "", "", "", "", names, "(s) " + 6 * "(kN) ", *rows]
    file = tmp_path / "a.out"
    file.write_bytes("\n".join(lines).replace("(kN)", "(kN-m)").encode("latin-1"))
    assert openfast_channels(file)["lsstipmzs"].values.tolist() == list(range(9))
    file.write_bytes("\n".join([*lines, "9 1 2 x 4 5 9"]).encode("latin-1"))
    with pytest.raises(InputError, match="line 18, channel LSShftFzs: 'x' is not a number"):
        openfast_channels(file)


@pytest.mark.parametrize(
    ("typed", "meant"),
    [
        ("verification/torsion_unifrom", "verification/torsion_uniform"),
        ("nafems_fv25", "verification/nafems_fv52"),
        ("stabilty", "stability"),
    ],
)
def test_the_case_that_was_meant_is_named(typed, meant):
    with pytest.raises(InputError, match=f"is unknown: did you mean '{meant}'") as caught:
        find_cases(typed)
    assert "\n" not in str(caught.value)


def test_nothing_is_guessed_of_what_is_like_no_case():
    with pytest.raises(InputError) as caught:
        find_cases("zzzzzz")
    assert "did you mean" not in str(caught.value)


@pytest.mark.parametrize(
    ("header", "row", "says"),
    [
        (HEADER, "0,0,1,5,2,0,3,0,4,0,5,0,6,0", "as decimal commas make"),
        (HEADER, '0.5,"1,25",2,3,4,5,6', "line 2, column Fx: '1,25' has a decimal comma, where o"),
        (HEADER, '"0,5",1.5,2,3,4,5,6', "line 2, column Fx: '1.5' has a decimal point, where oth"),
        (HEADER, '0,"1,250",2,3,4,5,6', "column Fx: '1,250' may be 1.250 or 1250: write decimals"),
    ],
)
def test_decimal_commas_that_cannot_be_read_are_named(tmp_path, header, row, says):
    table = tmp_path / "loads.csv"
    table.write_text(f"{header}\n{row}\n")
    with pytest.raises(InputError, match=says):
        read_csv(table)


@pytest.mark.parametrize(
    ("options", "says"),
    [
        (["--format", "json", "--what", "drivetrain"], "not for --what drivetrain: leave --what"),
        (["--format", "json", "--level", "1"], "of level 2, not --level 1: leave --level"),
        (["--format", "csv"], "in json, not as --format csv: give --format json"),
    ],
)
def test_modes_name_the_option_that_does_not_fit(options, says, tmp_path, capsys):
    words = ["export", "main_bearing_spherical", "--out", str(tmp_path / "out"), "--modes", "3"]
    with pytest.raises(SystemExit):
        main([*words, *options])
    assert says in capsys.readouterr().err
