"""Whirl of a drivetrain's shafts: keys of its file, bounds, the whole drivetrain, the command."""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml

from fe_drivetrain.command_line import main
from fe_drivetrain.common import InputError
from fe_drivetrain.drivetrain_file import parse_drivetrain, read_drivetrain
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.gear_stages import PlanetaryData
from fe_drivetrain.drivetrain_file.reading import library_text, scene_text
from fe_drivetrain.drivetrain_file.whirl_data import WhirlData
from fe_drivetrain.dynamics import machine_of
from fe_drivetrain.dynamics.whirl.modes import critical_speeds
from fe_drivetrain.dynamics.whirl.rotor import Disc
from fe_drivetrain.report.results import read_results
from fe_drivetrain.studies.shaft_whirl import WhirlResult, whirl
from fe_drivetrain.studies.whirl_rollers import roller_tables
from fe_drivetrain.studies.whirl_shafts import over_speed, shaft_rotors

RPM = math.pi / 30.0
NAME = "grc_750kw"


def with_whirl(**keys: Any) -> Drivetrain:
    return parse_drivetrain(yaml.safe_dump({**yaml.safe_load(library_text(NAME)), "whirl": keys}))


@pytest.fixture(scope="module")
def found() -> WhirlResult:
    return whirl(read_drivetrain(NAME))


def test_each_shaft_that_has_a_mass_whirls(found: WhirlResult) -> None:
    assert [one.name for one in found.shafts] == ["LSS", "IS1", "IS2", "HSS, stage 3 pinion"]
    assert found.passed
    high = found.speeds[1]
    for shaft in found.shafts:
        assert shaft.range[1] == pytest.approx(shaft.ratio * high)
        assert shaft.margin > 0.9


def test_condensed_levels_come_from_above(found: WhirlResult) -> None:
    for shaft in found.shafts:
        by_name = {one.name: one.speed for one in shaft.ladder}
        finest = shaft.ladder[-1].speed
        if finest is None or len(by_name) < 3:
            continue
        static = by_name["timoshenko, 4 times as many, condensed to bearings"]
        modal = by_name["timoshenko, 4 times as many, condensed, and 4 modes"]
        assert static is not None
        assert modal is not None
        assert static >= modal * (1 - 1e-9) >= finest * (1 - 1e-8)
        assert modal == pytest.approx(finest, rel=1e-3)


def test_a_direct_drive_has_no_words_on_meshes() -> None:
    found = whirl(read_drivetrain("iea_15mw_main_shaft"))
    assert found.answer is not None
    said = " ".join([*found.answer.cautions, *found.notes])
    assert "mesh" not in said
    assert "planets" not in said


def test_the_main_shaft_is_between_its_bounds_and_as_in_the_whole(found: WhirlResult) -> None:
    main_shaft = found.shafts[0]
    assert main_shaft.first is not None
    assert main_shaft.without_meshes is not None
    assert main_shaft.without_meshes < main_shaft.first.speed
    assert main_shaft.in_drivetrain == pytest.approx(main_shaft.first.speed, rel=2e-3)


def test_a_pinion_behind_a_coupling_is_a_disc_on_its_bearings(found: WhirlResult) -> None:
    """Its lateral frequency is that of its mass on the springs of both bearings, by hand."""
    machine = machine_of(read_drivetrain(NAME))
    pinion = shaft_rotors(machine, None)[-1]
    rows = [row for row in machine.bearings if row.holds == "stage 3 pinion"]
    k = sum(float(row.stiffness[1]) for row in rows)  # type: ignore[arg-type]
    free = critical_speeds(pinion.rotor(without=pinion.meshes), 1e6)
    assert isinstance(pinion.discs[0], Disc)
    assert any(one.speed == pytest.approx(math.sqrt(k / pinion.mass), rel=1e-2) for one in free)


def test_planets_are_carried_by_the_main_shaft() -> None:
    """Their masses are there, and turn about its axis on the circle of their centres."""
    machine = machine_of(read_drivetrain(NAME))
    main_shaft = shaft_rotors(machine, None)[0]
    stage = machine.stages[0]
    assert isinstance(stage, PlanetaryData)
    radius = stage.centre_distance - stage.sun_radius
    mass, _ = stage.planet.inertias(radius, stage.face_width)
    carried = [disc for disc in main_shaft.discs if disc.mass == pytest.approx(mass)]
    assert len(carried) == 3
    for disc in carried:
        assert disc.polar == pytest.approx(mass * stage.centre_distance**2)
        assert disc.transverse > disc.polar / 2


def test_bearings_over_the_speed_act_at_the_speed_of_their_shaft() -> None:
    machine = machine_of(read_drivetrain(NAME))
    row = next(one for one in machine.bearings if one.name == "HSS-A")
    own = [float(k) for k in row.stiffness]  # type: ignore[arg-type]
    stiffer = [4.0 * k for k in own]
    table = [{"speed": 1.0, "stiffness": own}, {"speed": 3e3, "stiffness": stiffer}]
    plain = whirl(with_whirl(bearings=[{"name": "HSS-A", "over_speed": table[:1]}])).shafts[-1]
    changing = whirl(with_whirl(bearings=[{"name": "HSS-A", "over_speed": table}])).shafts[-1]
    reference = whirl(read_drivetrain(NAME)).shafts[-1]
    assert plain.first is not None
    assert changing.first is not None
    assert reference.first is not None
    assert plain.first.speed == pytest.approx(reference.first.speed, rel=1e-9)
    assert changing.first.speed > 1.05 * plain.first.speed
    assert changing.in_drivetrain is None


def test_damping_of_the_shaft_alone_is_unstable_and_of_bearings_is_not() -> None:
    names = [row.name for row in machine_of(read_drivetrain(NAME)).bearings]
    inner = whirl(with_whirl(viscous=1e-5))
    damped = [{"name": name, "damping": [0, 1e6, 1e6, 0, 1e4, 1e4]} for name in names]
    outer = whirl(with_whirl(viscous=1e-9, bearings=damped))
    assert inner.shafts[0].unstable_from is not None
    forward = [one for one in inner.shafts[0].criticals if one.sense > 0.9]
    assert inner.shafts[0].unstable_from == pytest.approx(forward[0].speed, rel=0.02)
    assert all(shaft.unstable_from is None for shaft in outer.shafts)
    assert inner.passed
    assert outer.passed


def test_forces_go_with_the_unbalance_or_the_grade() -> None:
    """A grade is a speed of the centre of mass: e W = G."""
    machine, high = machine_of(read_drivetrain(NAME)), 200.0
    (own,) = shaft_rotors(machine, WhirlData(balance_grade=2.5))[-1].unbalances(high, 1)
    pinion = shaft_rotors(machine, None)[-1]
    assert own.moment / pinion.mass * high == pytest.approx(2.5e-3)
    rows = ({"shaft": "LSS", "at": 1.0, "moment": 3.0, "angle": 90.0},)
    shaft = shaft_rotors(machine, WhirlData(unbalance=rows))[0]
    (stated,) = shaft.unbalances(high, 2)
    assert stated.moment == 3.0
    assert stated.angle == pytest.approx(math.pi / 2)
    stations = shaft.rotor(2).stations
    assert stations[stated.node] == pytest.approx(1.0, abs=float(np.diff(stations).max()))


@pytest.mark.parametrize(
    ("keys", "message"),
    [
        ({"bearings": [{"name": "X"}]}, "whirl: bearing 'X' is none: use one of"),
        (
            {"bearings": [{"name": "HSS-A"}, {"name": "HSS-A"}]},
            "'HSS-A' has two rows",
        ),
        ({"unbalance": [{"shaft": "X", "moment": 1}]}, "whirl: unbalance is of shaft 'X'"),
        (
            {"unbalance": [{"shaft": "LSS", "at": 50, "moment": 1}]},
            "unbalance of shaft 'LSS' is at 50 m but the shaft is",
        ),
        (
            {
                "bearings": [
                    {
                        "name": "HSS-A",
                        "over_speed": [
                            {"speed": 9, "stiffness": [1] * 6},
                            {"speed": 9, "stiffness": [2] * 6},
                        ],
                    }
                ]
            },
            "over_speed has 9 rad/s before 9 rad/s but speeds must ascend",
        ),
        (
            {"bearings": [{"name": "HSS-A", "damping": [0, -1, 0, 0, 0, 0]}]},
            "damping -1 N s/m must be from 0 to",
        ),
    ],
)
def test_wrong_keys_are_refused(keys: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        with_whirl(**keys)


def test_keys_come_back_from_a_file() -> None:
    drivetrain = with_whirl(
        viscous=1e-5, bearings=[{"name": "HSS-A", "damping": [0, 1, 2, 0, 3, 4]}]
    )
    assert parse_drivetrain(scene_text(drivetrain)).whirl == drivetrain.whirl


def test_options_out_of_range_are_refused() -> None:
    with pytest.raises(InputError, match="speeds of the rotor are 2 to 1 rad/s"):
        whirl(read_drivetrain(NAME), speeds=(2.0, 1.0))
    with pytest.raises(InputError, match=r"states no operation\.rotor_speed"):
        whirl(read_drivetrain("park_2021"))


def test_rollers_stiffen_with_the_torque_and_centrifugal_forces_are_small() -> None:
    drivetrain = read_drivetrain("nrel_5mw")
    machine = machine_of(drivetrain)
    tables = roller_tables(drivetrain, machine, (0.7, 1.2671))
    assert np.all(np.diff(tables.torques) > 0)
    for stiffness in tables.stiffness.values():
        assert stiffness.shape == (len(tables.speeds), 6, 6)
        np.testing.assert_allclose(stiffness, stiffness.swapaxes(1, 2))
    shares = [row["centrifugal force over that load, at most [%]"] for row in tables.rows]
    assert all(isinstance(share, float) and 0 < share < 1 for share in shares)
    # a shaft four times as fast has its bearings' stiffness at four times the speeds
    name = "PLC-A"
    speeds, stiffness, _ = over_speed(name, WhirlData(), tables, 4.0)
    np.testing.assert_allclose(speeds, 4.0 * tables.speeds)
    assert stiffness is tables.stiffness[name]
    own = WhirlData.model_validate(
        {"bearings": [{"name": name, "over_speed": [{"speed": 3, "stiffness": [1] * 6}]}]}
    )
    assert list(over_speed(name, own, tables, 4.0)[0]) == [3.0]


def test_the_command_prints_and_writes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["modes", NAME, "--whirl", "--json", "--out", str(tmp_path / "out")]
    with pytest.raises(SystemExit) as ended:
        main(words)
    assert ended.value.code == 0
    shown = json.loads(capsys.readouterr().out)
    assert shown["schema"] == "fe-drivetrain/whirl/1"
    assert next(row["shaft"] for row in shown["tables"]["shafts"]) == "LSS"
    assert read_results(tmp_path / "out/results.json").answer is not None


def test_the_command_refuses_options_that_whirl_does_not_take(
    capsys: pytest.CaptureFixture[str],
) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["modes", NAME, "--whirl", "--level", "rigid"])
    assert ended.value.code == 2
    assert "--level is of modes of the whole drivetrain" in capsys.readouterr().err


@pytest.mark.parametrize("more", [("--whirl",), ()])
def test_speeds_beyond_the_machine_are_refused(
    more: tuple[str, ...], capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["modes", NAME, "--speeds", "1e9:2e9", *more, "--out", str(tmp_path / "out")])
    assert ended.value.code == 2
    said = capsys.readouterr().err
    assert "has a speed of 2e+09 1/min but must have one from 0 to 221 1/min, 10 times" in said
    assert not (tmp_path / "out").exists()
