"""What a user mistypes is answered at once, with what was meant."""

import os

import pytest

from fe_drivetrain.commands.app import main
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.hub_loads.csv_table import read_csv
from fe_drivetrain.scene.reading import read_scene
from fe_drivetrain.suite.case import find_cases

HEADER = "time [s],Fx [N],Fy [N],Fz [N],Mx [N m],My [N m],Mz [N m]"


def test_a_pipe_or_device_as_scene_is_refused_at_once(tmp_path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    for path in (pipe, "/dev/zero", tmp_path):
        with pytest.raises(InputError, match="it is a folder, a pipe or a device: give a file"):
            read_scene(path)


@pytest.mark.parametrize(
    ("typed", "meant"),
    [
        ("verification/torsion_unifrom", "verification/torsion_uniform"),
        ("nafems_le01", "verification/nafems_le10"),
        ("stabilty", "stability"),
    ],
)
def test_the_case_that_was_meant_is_named(typed, meant):
    with pytest.raises(InputError, match=f"is unknown .did you mean '{meant}'") as caught:
        find_cases(typed)
    assert "\n" not in str(caught.value)


def test_nothing_is_guessed_of_what_is_like_no_case():
    with pytest.raises(InputError) as caught:
        find_cases("zzzzzz")
    assert "did you mean" not in str(caught.value)


@pytest.mark.parametrize(
    ("header", "row", "says"),
    [
        (HEADER.replace(",", ";"), "0;1;2;3;4;5;6", "separated by semicolons"),
        (HEADER, "0,0,1,5,2,0,3,0,4,0,5,0,6,0", "as decimal commas make"),
        (HEADER, '"0,5",1,2,3,4,5,6', "'0,5' has a decimal comma"),
    ],
)
def test_semicolons_and_decimal_commas_are_named(tmp_path, header, row, says):
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
