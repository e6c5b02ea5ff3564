"""Files of other programs: names, signs, units, frames and origins, as a mapping states them."""

from pathlib import Path

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.reading import library_scene
from fe_drivetrain.studies.study_loads import own_loads
from fe_drivetrain.turbine_loads.hub_loads.channel_map import ChannelMap, read_channel_map
from fe_drivetrain.turbine_loads.hub_loads.recorded import read_recorded

TIME = 0.1 * np.arange(50)
FORCE = np.array([200e3, -15e3, -400e3])
MOMENT = np.array([900e3, 300e3, -100e3])
NAMES = {"Fx": "thrust", "Fy": "side", "Fz": "lift", "Mx": "torque", "My": "nod", "Mz": "yaw"}


def write_table(file: Path, loads: np.ndarray, **more: np.ndarray) -> Path:
    """Loads (6,) or (n, 6) in kN and kN m under other names; the unit of yaw is left out."""
    columns = dict(zip(NAMES.values(), np.broadcast_to(loads / 1e3, (50, 6)).T, strict=True))
    units = {**dict.fromkeys(NAMES.values(), " [kN-m]"), "thrust": " (kN)", "yaw": ""}
    units |= {"side": " [kN]", "lift": " [kN]", "angle": " [deg]"}
    columns |= more
    header = ",".join(["time [s]", *(name + units[name] for name in columns)])
    table = np.column_stack([TIME, *columns.values()])
    np.savetxt(file, table, delimiter=",", header=header, comments="", fmt="%.15g")
    return file


def test_signs_and_units_are_those_of_the_mapping(tmp_path: Path) -> None:
    file = write_table(tmp_path / "a.csv", np.concatenate([FORCE, MOMENT]))
    (tmp_path / "map.yaml").write_text(
        "channels: {Fx: thrust, Fy: -Side, Fz: lift, Mx: torque, My: nod, Mz: yaw}\n"
        "units: {yaw: MN m}\n"
    )
    found = read_recorded(file, read_channel_map(tmp_path / "map.yaml")).history
    expected = [200e3, 15e3, -400e3, 900e3, 300e3, -100e6]
    np.testing.assert_allclose(found.loads, np.broadcast_to(expected, (50, 6)))
    assert "-side [kN]" in str(found.attributes["channels"])


def test_loads_of_a_horizontal_frame_are_turned_by_the_tilt(tmp_path: Path) -> None:
    """The weight of a raised rotor points downwind along its shaft, and presses across it."""
    weight = np.array([0.0, 0.0, -1000e3, 0.0, 500e3, 0.0])
    file = write_table(tmp_path / "a.csv", weight)
    mapping = ChannelMap(channels=NAMES, units={"yaw": "kN m"}, tilt=5.0)
    found = read_recorded(file, mapping).history
    assert found.loads[0, 0] == pytest.approx(1000e3 * np.sin(np.radians(5.0)))
    assert found.loads[0, 2] == pytest.approx(-1000e3 * np.cos(np.radians(5.0)))
    assert found.loads[0, 4] == pytest.approx(500e3)
    assert np.linalg.norm(found.loads[0, :3]) == pytest.approx(1000e3)
    assert "tilt of 5 deg" in str(found.attributes["channels"])


def test_moments_about_another_point_are_carried_to_the_hub_by_statics(tmp_path: Path) -> None:
    behind = 1.9
    at_point = MOMENT + np.cross([-behind, 0.0, 0.0], FORCE)
    file = write_table(tmp_path / "a.csv", np.concatenate([FORCE, at_point]))
    mapping = ChannelMap(channels=NAMES, units={"yaw": "kN m"}, moments_at=behind)
    found = read_recorded(file, mapping).history
    np.testing.assert_allclose(found.loads[0, 3:], MOMENT)
    assert "carried to the hub from 1.9 m downwind" in str(found.attributes["channels"])


def test_the_documented_sign_of_carried_moments_is_that_of_statics(tmp_path: Path) -> None:
    """800 kN down 1.9 m downwind of the hub turn the shaft about +y (z towards x) by 1520 kN m."""
    loads = np.array([400e3, 50e3, -800e3, 2000e3, 1000e3, 0.0])
    file = write_table(tmp_path / "a.csv", loads)
    mapping = ChannelMap(channels=NAMES, units={"yaw": "kN m"}, moments_at=1.9)
    found = read_recorded(file, mapping).history
    np.testing.assert_allclose(found.loads[0, 3:], [2000e3, 2520e3, 95e3])
    page = Path(__file__).parents[2].joinpath("docs", "loads.md").read_text("utf-8")
    assert r"$M_\mathrm{hub} = M + (d, 0, 0) \times F$" in page


def test_rotating_loads_are_turned_back_by_the_azimuth(tmp_path: Path) -> None:
    azimuth = np.radians(20.0) + 1.3 * TIME
    ya = np.stack([0.0 * TIME, np.cos(azimuth), np.sin(azimuth)], axis=1)
    za = np.cross([1.0, 0.0, 0.0], ya)
    force, moment = (
        np.column_stack([np.full(50, load[0]), ya @ load, za @ load]) for load in (FORCE, MOMENT)
    )
    shown = np.degrees(azimuth) + 30.0
    file = write_table(tmp_path / "a.csv", np.hstack([force, moment]), angle=shown)
    names = {**NAMES, "azimuth": "angle"}
    units = {"yaw": "kN m"}
    mapping = ChannelMap(channels=names, units=units, rotating=True, azimuth_blade1_up=30.0)
    found = read_recorded(file, mapping).history
    np.testing.assert_allclose(found.loads[:, 1:3], np.broadcast_to(FORCE[1:], (50, 2)))
    np.testing.assert_allclose(found.loads[:, 4:], np.broadcast_to(MOMENT[1:], (50, 2)))
    with pytest.raises(InputError, match="no azimuth to turn them back"):
        read_recorded(file, ChannelMap(channels=NAMES, units=units, rotating=True))


def test_a_study_reads_files_of_other_programs(tmp_path: Path) -> None:
    waving = np.concatenate([FORCE, MOMENT]) * (1.0 + 0.1 * np.sin(TIME))[:, None]
    write_table(tmp_path / "a.csv", waving)
    scene = library_scene("main_bearing_bonded")
    mapping = ChannelMap(channels=NAMES, units={"yaw": "kN m"})
    (history,) = own_loads(str(tmp_path), 1.0, scene, mapping).histories
    np.testing.assert_allclose(history.loads, waving[10:])
    with pytest.raises(InputError, match="no column Fx, Fy"):
        own_loads(str(tmp_path), 1.0, scene)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("channels: {torque: Q}", "channel 'torque' is not one of time, Fx"),
        ("tilt: 95", "tilt"),
        ("frame: hub", "frame"),
        ("rotating: true\ntilt: 5", "leave out tilt or rotating"),
    ],
)
def test_mistakes_of_a_mapping_are_one_sentence(tmp_path: Path, text: str, message: str) -> None:
    (tmp_path / "map.yaml").write_text(text)
    with pytest.raises(InputError, match=message):
        read_channel_map(tmp_path / "map.yaml")


OWN = ("Fx", "Fy", "Fz", "Mx", "My", "Mz")
TURN = 20.0 * TIME  # deg


def rotating_table(file: Path, *more: str) -> Path:
    """A weight of 100 kN, and a moment of 30 kN m about y, as a rotating frame has them.

    At an azimuth psi, ya = cos(psi) y + sin(psi) z and za = -sin(psi) y + cos(psi) z.
    """
    psi = np.radians(TURN)
    columns = {
        "Fx [kN]": 5.0 + 0.0 * psi,
        "Fy [kN]": -100.0 * np.sin(psi),
        "Fz [kN]": -100.0 * np.cos(psi),
        "Mx [kN m]": 7.0 + psi,
        "My [kN m]": 30.0 * np.cos(psi),
        "Mz [kN m]": -30.0 * np.sin(psi),
        "brake.Fy [kN]": -4.0 * np.sin(psi),
        "brake.Fz [kN]": -4.0 * np.cos(psi),
    }
    columns |= dict.fromkeys(more, TURN)
    header = ",".join(["time [s]", *columns])
    table = np.column_stack([TIME, *columns.values()])
    np.savetxt(file, table, delimiter=",", header=header, comments="", fmt="%.15g")
    return file


@pytest.mark.parametrize(
    ("azimuth", "channels"),
    [
        ("azimuth [deg]", {}),
        ("LSSTipPxa [deg]", {}),
        ("angle [deg]", {"azimuth": "angle"}),
        ("azimuth [deg]", {"Fy": "Fy"}),
        ("Azimuth [deg]", {name: name for name in OWN}),
    ],
)
def test_rotating_loads_of_a_table_are_turned_back(
    tmp_path: Path, azimuth: str, channels: dict[str, str]
) -> None:
    """Turned back they are the constant weight and moment, whatever of the table is mapped."""
    file = rotating_table(tmp_path / "a.csv", azimuth)
    found = read_recorded(file, ChannelMap(channels=channels, rotating=True)).history
    expected = [5e3, 0.0, -100e3, 30e3, 0.0]
    np.testing.assert_allclose(found.loads[:, [0, 1, 2, 4, 5]], [expected] * 50, atol=1e-6)
    np.testing.assert_allclose(found.loads[:, 3], 7e3 + 1e3 * np.radians(TURN))
    at_brake = [0.0, 0.0, -4e3, 0.0, 0.0, 0.0]
    np.testing.assert_allclose(found.at["brake"], [at_brake] * 50, atol=1e-8)
    read = str(found.attributes["channels"])
    assert f"turned back by {azimuth}" in read
    assert "nothing turned" not in read


def test_rotating_loads_of_a_table_start_at_the_azimuth_of_blade_1(tmp_path: Path) -> None:
    file = rotating_table(tmp_path / "a.csv", "azimuth [deg]")
    found = read_recorded(file, ChannelMap(rotating=True, azimuth_blade1_up=90.0)).history
    # turned back by 90 deg less than before, what pointed down points along -y
    np.testing.assert_allclose(found.loads[:, 1:3], [[-100e3, 0.0]] * 50, atol=1e-6)
    assert "less 90 deg" in str(found.attributes["channels"])


@pytest.mark.parametrize("channels", [{}, {"Fy": "Fy"}])
def test_rotating_loads_of_a_table_need_an_azimuth(
    tmp_path: Path, channels: dict[str, str]
) -> None:
    mapping = ChannelMap(channels=channels, rotating=True)
    file = rotating_table(tmp_path / "a.csv")
    message = r"no azimuth to turn them back: add a column 'azimuth \[deg\]'"
    with pytest.raises(InputError, match=message):
        read_recorded(file, mapping)
    with pytest.raises(InputError, match=message):
        own_loads(str(file), 0.0, library_scene("main_bearing_bonded"), mapping)


def test_a_mapped_table_keeps_its_load_points(tmp_path: Path) -> None:
    file = rotating_table(tmp_path / "a.csv")
    found = read_recorded(file, ChannelMap(channels={"Fy": "-Fy"}, tilt=5.0)).history
    psi, sin = np.radians(TURN), np.sin(np.radians(5.0))
    np.testing.assert_allclose(found.at["brake"][:, 0], 4e3 * sin * np.cos(psi))
    assert "brake.Fz [kN]" in str(found.attributes["channels"])
    whole = read_recorded(file, ChannelMap(tilt=5.0)).history
    np.testing.assert_allclose(whole.at["brake"], found.at["brake"])


def test_openfast_channels_say_themselves_what_turns(tmp_path: Path) -> None:
    names = ["Time", "LSShftFxa", "LSShftFys", "LSShftFzs", "RotTorq", "LSSTipMys", "LSSTipMzs"]
    units = ["(s)", "(kN)", "(kN)", "(kN)", "(kN-m)", "(kN-m)", "(kN-m)"]
    rows = [f"{t:g} 1 2 3 4 5 {t:g}" for t in TIME]
    (tmp_path / "a.out").write_text(
        "\n".join([*6 * ["-"], " ".join(names), " ".join(units), *rows])
    )
    assert read_recorded(tmp_path / "a.out").history.loads[0, 4] == 5e3
    with pytest.raises(InputError, match="leave out rotating, or map the loads"):
        read_recorded(tmp_path / "a.out", ChannelMap(rotating=True))
