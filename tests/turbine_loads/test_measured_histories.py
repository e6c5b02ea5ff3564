"""Histories of some components at whatever times: read, counted by hand, and kept off scenes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from fe_drivetrain.common.components import FORCES
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.reading import library_scene
from fe_drivetrain.shafts.response.entering import entering
from fe_drivetrain.studies.load_digest import LoadOptions, OneShaft, digest
from fe_drivetrain.studies.load_totals import LoadSums
from fe_drivetrain.studies.study_loads import given_loads
from fe_drivetrain.turbine_loads.histories.cycle_sums import equivalent_loads
from fe_drivetrain.turbine_loads.hub_loads.channel_map import ChannelMap
from fe_drivetrain.turbine_loads.hub_loads.csv_table import read_csv, write_hub_loads
from fe_drivetrain.turbine_loads.hub_loads.histories import LoadHistory
from fe_drivetrain.turbine_loads.hub_loads.openfast import read_openfast
from fe_drivetrain.turbine_loads.hub_loads.recorded import Recorded, read_recorded
from fe_drivetrain.turbine_loads.hub_loads.sampling import GAP, sampling_of

TORQUE = FORCES.index("Mx")


def table(path: Path, *lines: str) -> Path:
    path.write_text("\n".join(lines) + "\n")
    return path


def output(path: Path, names: list[str], rows: list[list[float]]) -> Path:
    """A text output file of OpenFAST with torques and a speed."""
    units = {"Time": "(s)", "RotSpeed": "(rpm)", "RotThrust": "(kN)"}
    heads = [names, [units.get(name, "(kN-m)") for name in names]]
    lines = [*[""] * 6, *("\t".join(head) for head in heads)]
    return table(path, *lines, *("\t".join(f"{value:.8e}" for value in row) for row in rows))


def measured(time: np.ndarray, torque: np.ndarray) -> LoadHistory:
    """A history of a torque alone [N m]."""
    loads = np.full((len(time), 6), np.nan)
    loads[:, TORQUE] = torque
    return LoadHistory("made", time, loads, measured=True)


# --- reading -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("header", "first"),
    [
        ("time [s],Mx [kN m]", "0,{}"),
        ("time [s],hub.Mx [kN m]", "0,{}"),
        ("time [ms],torque [N m]", "0,{}e3"),
        ("timestamp,rotor torque [MN m]", "2024-03-01T12:00:00,{}e-3"),
        ("time,RotTorq [kNm]", "2024-03-01 12:00:00.00Z,{}"),
    ],
)
def test_a_lone_torque_is_read_by_each_of_its_names(
    tmp_path: Path, header: str, first: str
) -> None:
    stamp = first.split(",")[0]
    clock = {
        "0": ["0", "20", "40"] if "ms" in header else ["0", "0.02", "0.04"],
        "2024-03-01T12:00:00": [stamp, f"{stamp}.020", f"{stamp}.040000"],
        "2024-03-01 12:00:00.00Z": [
            stamp,
            stamp.replace(".00", ".02"),
            stamp.replace(".00", ".04"),
        ],
    }[stamp]
    cells = [first.split(",")[1].format(value) for value in (100, 250, 175)]
    rows = [f"{time},{cell}" for time, cell in zip(clock, cells, strict=True)]
    history = read_recorded(table(tmp_path / "a.csv", header, *rows), measured=True).history
    assert history.absent == ("Fx", "Fy", "Fz", "My", "Mz")
    np.testing.assert_allclose(history.time, [0.0, 0.02, 0.04], rtol=0, atol=1e-12)
    np.testing.assert_allclose(history.component("Mx"), [1e5, 2.5e5, 1.75e5], rtol=1e-15)
    if "ms" not in header and stamp != "0":
        assert "0 s at 2024-03-01T12:00:00" in str(history.attributes["channels"])


def test_columns_of_the_hub_beside_mapped_ones(tmp_path: Path) -> None:
    header = "time [s],hub.Fx [kN],hub.Mx [kN m],Tq [kN m]"
    file = table(tmp_path / "a.csv", header, "0,1,2,5", "1,2,3,6", "2,3,4,7")
    for mapped, torque in (({}, [2e3, 3e3, 4e3]), ({"Mx": "Tq"}, [5e3, 6e3, 7e3])):
        history = read_recorded(file, ChannelMap(channels=mapped), measured=True).history
        assert history.component("Fx").tolist() == [1e3, 2e3, 3e3]
        assert history.component("Mx").tolist() == torque
        assert not history.at
    twice = table(tmp_path / "b.csv", "time [s],Mx [N m],hub.Mx [N m]", "0,1,2", "1,2,3", "2,3,4")
    with pytest.raises(InputError, match="column Mx is there twice"):
        read_recorded(twice, measured=True)


def test_date_times_count_across_midnight_in_mapped_columns(tmp_path: Path) -> None:
    file = table(
        tmp_path / "a.csv",
        "Stamp,Drehmoment [kNm],n [rpm]",
        "2023-12-31T23:59:59.5+01:00,-1,12",
        "2024-01-01T00:00:00.5+01:00,-2,12",
        "2024-01-01T00:00:01.5+01:00,-3,12",
    )
    names = {"time": "Stamp", "Mx": "-Drehmoment", "rotor speed": "n"}
    found = read_recorded(file, ChannelMap(channels=names), measured=True)
    assert found.history.time.tolist() == [0.0, 1.0, 2.0]
    assert found.history.component("Mx").tolist() == [1e3, 2e3, 3e3]
    assert found.rotor_speed == pytest.approx([0.4 * np.pi] * 3, rel=1e-14)


@pytest.mark.parametrize("torque", ["RotTorq", "LSShftTq", "LSShftMxa"])
def test_openfast_files_with_a_lone_torque(tmp_path: Path, torque: str) -> None:
    rows = [[0.1 * k, 100.0 + k, 12.0] for k in range(5)]
    file = output(tmp_path / "a.out", ["Time", torque, "RotSpeed"], rows)
    found = read_recorded(file, measured=True)
    assert found.history.absent == ("Fx", "Fy", "Fz", "My", "Mz")
    np.testing.assert_allclose(found.history.component("Mx"), 1e3 * (100.0 + np.arange(5)))
    assert (found.history.torque_of, found.rotor_speed is None) == ("", False)
    with pytest.raises(
        InputError, match=r"no channel for the thrust, no pair of shear.*no pair of"
    ):
        read_openfast(file)


def test_a_torque_of_the_generator_becomes_the_rotors_by_the_gearbox_ratio(tmp_path: Path) -> None:
    rows = [[0.1 * k, 20.0 + k] for k in range(5)]
    files = [
        output(tmp_path / "a.out", ["Time", "GenTq"], rows),
        table(tmp_path / "a.csv", "time [s],HSS torque [kN m]", *(f"{a},{b}" for a, b in rows)),
        table(tmp_path / "b.csv", "time [s],q [kN m]", *(f"{a},{b}" for a, b in rows)),
    ]
    for file in files:
        names = {"high-speed torque": "q"} if file.name == "b.csv" else {}
        history = read_recorded(file, ChannelMap(channels=names), measured=True).history
        assert history.torque_of == "high-speed shaft"
        np.testing.assert_allclose(history.component("Mx"), 1e3 * (20.0 + np.arange(5)))
        turned = ChannelMap(channels=names, gearbox_ratio=97.0)
        at_rotor = read_recorded(file, turned, measured=True).history
        assert at_rotor.torque_of == ""
        np.testing.assert_allclose(at_rotor.component("Mx"), 97e3 * (20.0 + np.arange(5)))
        assert "times the gearbox ratio 97, without losses" in str(at_rotor.attributes["channels"])
    of_rotor = table(tmp_path / "c.csv", "time [s],Mx [kN m]", "0,1", "1,2", "2,3")
    with pytest.raises(InputError, match=r"gearbox_ratio is 97, but no torque of the high-speed"):
        read_recorded(of_rotor, ChannelMap(gearbox_ratio=97.0), measured=True)


def test_the_speed_of_the_generator_becomes_the_rotors(tmp_path: Path) -> None:
    header = "time [s],GenTq [kN m],{} [rpm]"
    for name in ("GenSpeed", "HSS speed", "n2"):
        file = table(tmp_path / "a.csv", header.format(name), "0,1,970", "1,2,970", "2,3,485")
        names = {"generator speed": "n2"} if name == "n2" else {}
        turned = ChannelMap(channels=names, gearbox_ratio=97.0)
        found = read_recorded(file, turned, measured=True)
        assert found.rotor_speed == pytest.approx(np.pi / 30 * np.array([10.0, 10.0, 5.0]))
        said = str(found.history.attributes["channels"])
        assert f"rotor speed = {name} [rpm] over the gearbox ratio 97" in said
        alone = read_recorded(file, ChannelMap(channels=names), measured=True)
        assert alone.rotor_speed is None
    both = "time [s],GenTq [kN m],GenSpeed [rpm],rotor speed [rpm]"
    file = table(tmp_path / "b.csv", both, "0,1,970,9", "1,2,970,9", "2,3,485,9")
    own = read_recorded(file, ChannelMap(gearbox_ratio=97.0), measured=True)
    assert own.rotor_speed == pytest.approx(3 * [0.3 * np.pi])


def test_torques_of_two_shafts_are_not_counted_together() -> None:
    time = np.arange(10.0)
    rotor = digest(Recorded(measured(time, 1e6 + time)), LoadOptions())
    loads = np.array(measured(time, 1e4 + time).loads)
    other = LoadHistory("hss", time, loads, {"torque of": "high-speed shaft"}, measured=True)
    shafts = OneShaft()
    shafts.add("a", rotor)
    with pytest.raises(
        InputError, match=r"a has the torque of the rotor and b that of the high-sp"
    ):
        shafts.add("b", digest(Recorded(other), LoadOptions()))


def test_what_rotates_without_an_azimuth_is_left_out_by_name(tmp_path: Path) -> None:
    rows = [[0.1 * k, 20.0 + k, 1.0, 2.0] for k in range(5)]
    file = output(tmp_path / "a.out", ["Time", "RotTorq", "LSSTipMya", "LSSTipMza"], rows)
    history = read_recorded(file, measured=True).history
    assert set(FORCES) - set(history.absent) == {"Mx"}
    said = str(history.attributes["channels"])
    assert "left out: LSSTipMya, LSSTipMza turn with the rotor and the file has no azimuth" in said
    gage = output(tmp_path / "b.out", ["Time", "LSSGagMys", "LSSGagMzs"], [r[:3] for r in rows])
    with pytest.raises(InputError, match=r"no channel for the torque.*at the strain gage"):
        read_recorded(gage, measured=True)


def test_tilt_cannot_turn_a_lone_torque(tmp_path: Path) -> None:
    file = table(tmp_path / "a.csv", "time [s],q [kN m]", "0,1", "1,2", "2,3")
    with pytest.raises(InputError, match=r"tilt makes Fx and Fz.*leave out tilt, or map both"):
        read_recorded(file, ChannelMap(channels={"Mx": "q"}, tilt=5.0), measured=True)


@pytest.mark.parametrize(
    ("lines", "match"),
    [
        (("time [s],torque [kN m],rotor torque [kN m]", "0,1,1"), "torque and rotor torque could"),
        (("time [s],torque", "0,1"), r"column 'torque' has no unit; .* 'torque \[N m\]'"),
        (("time,torque [kN m]", "0,1", "1,2", "2,1"), "column 'time' has no unit"),
        (("torque [kN m]", "0"), r"no column time; .* date-times like 2024"),
        (("time [s],power [kW]", "0,1"), "no column of a load"),
        (("time,Mx [Nm]", "1 March 2024,1"), "column time: .* neither a number nor a date-time"),
        (("time,Mx [Nm]", "01/03/2024 12:00,1"), "the day or the month first: write the year fir"),
        (("time,Mx [Nm]", "2024-03-01T12:00:00,1", "5,1"), "line 3, column time"),
        (("time,Mx [Nm]", "2024-03-01T12:00:00,1", "2024-03-01T12:00:01Z,1"), "line 3, column"),
        (("time,Mx [Nm]", *["2024-03-01T12:00:00,1"] * 3), "time does not increase.*more digits"),
        (("time [s],Mx [Nm]", "2,1", "1,1", "0,1"), "time does not increase after line 2"),
        (("time [s],Mx [Nm]", "0,1"), "1 sample, fewer than the 3"),
        (("time [s],Mx [Nm]", "0,1", "1,nan", "2,1"), "Mx is nan at line 3"),
    ],
)
def test_a_strangers_mistakes_are_one_sentence(
    tmp_path: Path, lines: tuple[str, ...], match: str
) -> None:
    with pytest.raises(InputError, match=match):
        read_recorded(table(tmp_path / "a.csv", *lines), measured=True)


# --- missing is not zero -------------------------------------------------------------------------


def test_a_history_without_components_cannot_act_on_a_scene(tmp_path: Path) -> None:
    scene = library_scene("two_bearings")
    alone = measured(np.arange(5.0), np.arange(5.0))
    for use in (lambda: entering(scene, alone), lambda: given_loads([alone], scene)):
        with pytest.raises(InputError, match=r"made has Mx, and Fx, Fy, Fz, My, Mz are not known"):
            use()
    loads = np.tile(np.arange(5.0)[:, None], 6)
    uneven = LoadHistory("uneven", np.array([0.0, 1.0, 2.0, 4.0, 5.0]), loads, measured=True)
    assert len(entering(scene, uneven)) == 5  # statics of each sample
    with pytest.raises(InputError, match="time step after sample 3"):
        given_loads([uneven], scene)
    with pytest.raises(InputError, match="Fx is nan"):
        LoadHistory("strict", alone.time, alone.loads)
    with pytest.raises(InputError, match="none of Fx, Fy"):
        LoadHistory("empty", alone.time, np.full((5, 6), np.nan), measured=True)
    file = table(tmp_path / "a.csv", "time [s],Mx [kN m]", "0,1", "1,2", "2,1")
    with pytest.raises(InputError, match=r"no column Fx, Fy, Fz, My, Mz; .*reactions need all six"):
        read_recorded(file)


def test_what_a_file_lacks_is_not_known_of_all() -> None:
    """Bending of one file and torque of both: only the torque is of both."""
    time = np.arange(0.0, 100.0, 0.5)
    whole = LoadHistory("whole", time, np.sin(time)[:, None] * np.arange(1.0, 7.0), measured=True)
    sums = LoadSums()
    for one in (whole, measured(time, 5.0 * np.cos(time))):
        sums.add(one.name, digest(Recorded(one), LoadOptions()))
    found = sums.totals()
    assert (found.loads, found.absent) == (("Mx",), ("Fx", "Fy", "Fz", "My", "Mz"))
    assert set(found.cycles.ranges) == set(found.levels.seconds) == {"Mx"}
    assert not found.planes
    assert np.isnan(found.equivalent_loads(LoadOptions())).any(axis=1).tolist() == [
        name != "Mx" for name in (*FORCES, "radial force", "bending moment")
    ]


def test_all_six_even_components_give_the_same_either_way() -> None:
    time = np.arange(0.0, 100.0, 0.1)
    loads = np.sin(np.outer(time, np.arange(1.0, 7.0)))
    speed = np.full(len(time), 1.2)
    one, other = (
        digest(Recorded(LoadHistory("a", time, loads, measured=flag), speed), LoadOptions())
        for flag in (False, True)
    )
    np.testing.assert_array_equal(one.windows.values, other.windows.values)
    np.testing.assert_array_equal(one.cycles.damage, other.cycles.damage)
    assert one.spectra is not None
    assert other.spectra is not None
    np.testing.assert_array_equal(one.spectra.density, other.spectra.density)


def test_a_measured_history_is_written_and_read_again(tmp_path: Path) -> None:
    time = np.array([0.0, 1.0, 2.5, 9.0])
    loads = np.array(measured(time, time**2).loads)
    history = LoadHistory("a", time, loads, {"torque of": "high-speed shaft"}, measured=True)
    write_hub_loads(history, tmp_path / "a.csv")
    again = read_csv(tmp_path / "a.csv", measured=True)
    assert (again.absent, again.torque_of) == (history.absent, "high-speed shaft")
    np.testing.assert_array_equal(again.loads, history.loads)
    np.testing.assert_array_equal(again.time, time)


# --- counted by hand -----------------------------------------------------------------------------


def test_the_equivalent_load_of_a_sine_of_torque_by_hand() -> None:
    """Sixty periods from a mean on: 119 half cycles of 2 A, one of A, and one at the open end."""
    time = np.arange(0.0, 600.0, 0.25)
    size = 1e5
    found = digest(Recorded(measured(time, 1e6 + size * np.sin(0.2 * np.pi * time))), LoadOptions())
    end = size * (1.0 - np.sin(0.2 * np.pi * 0.25))
    for k, m in enumerate(LoadOptions().slopes):
        damage = 0.5 * (size**m + 119 * (2 * size) ** m + end**m)
        assert found.cycles.damage[TORQUE, k] == pytest.approx(damage, rel=1e-9)
    assert found.cycles.number[TORQUE] == pytest.approx(60.5)
    equal = equivalent_loads(found.cycles.damage, 600.0, np.array(LoadOptions().slopes), 0.1)
    assert equal[TORQUE] == pytest.approx(3 * [2 * size], rel=0.01)  # at its own frequency


def test_time_and_turns_at_the_levels_of_a_torque_by_hand() -> None:
    """Twenty seconds at 100 kN m and 0.2 turns a second, thirty at 300 kN m and 0.1."""
    torque = np.repeat([1e5, 3e5], [40, 60])
    speed = 2.0 * np.pi * np.repeat([0.2, 0.1], [40, 60])
    history = measured(0.5 * np.arange(100), torque)
    found = digest(Recorded(history, speed), LoadOptions())
    for classes, amounts in (
        (found.levels.seconds["Mx"], (20.0, 30.0)),
        (found.levels.turns["Mx"], (4.0, 3.0)),
    ):
        edges = classes.edges()
        for level, amount in zip((1e5, 3e5), amounts, strict=True):
            (place,) = np.flatnonzero((edges[:-1] <= level) & (level < edges[1:]))
            assert classes.amount[place] == pytest.approx(amount, rel=1e-12)
        assert classes.amount.sum() == pytest.approx(sum(amounts), rel=1e-12)
    mean = (4.0 * 1e5 ** (10 / 3) + 3.0 * 3e5 ** (10 / 3)) / 7.0
    assert found.torque.equivalent_over_turns == pytest.approx(mean**0.3, rel=1e-12)


def test_steps_and_gaps_of_times() -> None:
    time = np.array([0.0, 1.0, 2.0, 4.0, 5.0, 15.0, 16.0])
    found = sampling_of(time)
    assert (found.steps.usual, found.steps.least, found.steps.most) == (1.0, 1.0, 2.0)
    assert found.steps.gaps.tolist() == [[5.0, 10.0]]
    assert found.pieces == (slice(0, 5), slice(5, 7))
    np.testing.assert_allclose(found.weights, [1.0, 1.0, 1.5, 1.5, 1.0, 1.0, 1.0])
    assert not found.steps.even
    assert not found.regular
    just = sampling_of(np.array([0.0, 1.0, 2.0, 2.0 + GAP, 3.0 + GAP]))
    assert not len(just.steps.gaps)
    printed = sampling_of(np.round(0.00625 * np.arange(100), 3))
    assert printed.regular
    assert printed.weights == pytest.approx(0.00625, rel=1e-3)


def test_no_cycle_leads_over_a_gap() -> None:
    """Two rises by 1 N m, ten apart: a half cycle each, and none of their distance."""
    time = np.concatenate([np.arange(5.0), 100.0 + np.arange(5.0)])
    rise = 0.25 * np.arange(5.0)
    found = digest(Recorded(measured(time, np.concatenate([rise, 10.0 + rise]))), LoadOptions())
    assert found.cycles.largest[TORQUE] == 1.0
    assert found.cycles.number[TORQUE] == 1.0
    assert found.span.seconds == pytest.approx(10.0)
    assert found.levels.seconds["Mx"].amount.sum() == pytest.approx(10.0)
    mean = float(found.windows.together()[TORQUE, 1])
    assert mean == pytest.approx(5.5)


def test_reversals_over_a_gap_are_not_counted() -> None:
    time = np.concatenate([np.arange(5.0), 100.0 + np.arange(5.0)])
    torque = np.concatenate([np.full(5, 1.0), [-1.0, -1.0, 1.0, -1.0, -1.0]])
    found = digest(Recorded(measured(time, torque)), LoadOptions())
    assert (found.torque.reversals, found.torque.negative_seconds) == (2.0, 4.0)


def test_each_sample_counts_for_its_own_time() -> None:
    """Steps of 1, 2, 1 s: samples stand for 1, 1.5, 1.5 and 1 s."""
    found = digest(
        Recorded(measured(np.array([0.0, 1, 3, 4]), np.array([1.0, 2, 3, 4]))), LoadOptions()
    )
    low, mean, high, deviation = found.windows.together()[TORQUE]
    variance = (1.5**2 + 1.5 * 0.5**2 + 1.5 * 0.5**2 + 1.5**2) / 5.0
    assert (low, mean, high) == (1.0, pytest.approx(2.5), 4.0)
    assert deviation == pytest.approx(np.sqrt(variance))


def test_windows_of_the_clock_leave_out_those_in_a_gap() -> None:
    time = np.concatenate([np.arange(600.0), 1800.0 + np.arange(300.0)])
    torque = np.concatenate([np.full(600, 1.0), np.full(300, 4.0)])
    windows = digest(Recorded(measured(time, torque)), LoadOptions()).windows
    assert windows.start.tolist() == [0.0, 1800.0]
    assert windows.seconds == pytest.approx([600.0, 300.0])
    assert windows.values[:, TORQUE, 1].tolist() == pytest.approx([1.0, 4.0])


def test_the_spectrum_of_uneven_samples_in_pieces_has_the_line_of_a_sine(
    rng: np.random.Generator,
) -> None:
    """A sine at 3P of the mean speed: its amplitude, of samples that jitter and miss 20 s."""
    time = np.sort(0.05 * np.arange(8000) + rng.uniform(-0.02, 0.02, 8000))
    time = time[(time < 150.0) | (time > 170.0)]
    torque = 5.0 * np.sin(2.0 * np.pi * 0.3 * time)
    turning = np.where(time < 160.0, 0.1 - 0.01 * 230 / 150, 0.11)  # 150 s and 230 s
    speed = 2.0 * np.pi * turning
    found = digest(Recorded(measured(time, torque), speed), LoadOptions())
    assert len(found.steps.gaps) == 1
    assert not found.steps.even
    assert found.spectra is not None
    assert found.spectra.multiples is not None
    one, three, six, nine = found.spectra.multiples[TORQUE]
    assert three == pytest.approx(5.0, rel=0.02)
    assert max(one, six, nine) < 0.1
    assert np.isnan(found.spectra.density[FORCES.index("My")]).all()
    power = found.spectra.density[TORQUE].sum() / 60.0
    assert power == pytest.approx(12.5, rel=0.02)  # half of the square of the amplitude


def test_spectra_of_pieces_are_their_mean_by_time(rng: np.random.Generator) -> None:
    """Pieces of 120 s and 240 s at two speeds: a third and two thirds, three and seven segments."""
    time = np.concatenate([0.1 * np.arange(1200), 500.0 + 0.1 * np.arange(2400)])
    torque = rng.standard_normal(3600)
    speed = np.repeat([1.01, 1.26], [1200, 2400])
    parts = [slice(0, 1200), slice(1200, 3600), slice(0, 3600)]
    one, other, both = (
        digest(Recorded(measured(time[p], torque[p]), speed[p]), LoadOptions()).spectra
        for p in parts
    )
    assert one is not None
    assert other is not None
    assert both is not None
    mean = (one.density[TORQUE] + 2.0 * other.density[TORQUE]) / 3.0
    np.testing.assert_allclose(both.density[TORQUE], mean, rtol=1e-9)
    assert both.by_speed is not None
    assert both.by_speed.segments.tolist() == [3.0, 7.0]
    assert both.by_speed.classes.tolist() == [20.0, 25.0]  # of 0.05 rad/s
    assert one.by_speed is not None
    np.testing.assert_allclose(both.by_speed.density[0], one.by_speed.density[0], rtol=1e-9)
