"""The study of a drivetrain in time: what it finds of two masses, of files, and what it refuses."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from answer_rules import broken_rules
from numpy.testing import assert_allclose
from small_drivetrain import GENERATOR, ROTOR, SPEED, STIFFNESS, TORQUE, two_mass_file, two_masses
from tiny_case import Result

from fe_drivetrain.common import InputError
from fe_drivetrain.common.cache import CACHE_VARIABLE
from fe_drivetrain.drivetrain_file import read_drivetrain
from fe_drivetrain.drivetrain_file.turning_parts import DampingRatios
from fe_drivetrain.dynamics import machine_of
from fe_drivetrain.dynamics.bodies.damping_ratios import ASSUMED_RATIOS, first_mode_damping
from fe_drivetrain.procedure import drivetrain_operation
from fe_drivetrain.procedure.failure_modes import (
    BEARING_RATING,
    DIPS,
    ELECTRICAL_FAULT,
    HIGH_SPEED_REVERSALS,
    MISALIGNMENT,
    OVERLOAD,
    RESONANCE,
    REVERSALS,
    ROTOR_TORQUE,
    TORQUE_AND_BENDING,
    protest_catalogue,
)
from fe_drivetrain.report.results import read_results
from fe_drivetrain.shafts.fidelity.quantity import ERROR_AGAINST_LAST, LEVEL_ERRORS, OWN_ERROR
from fe_drivetrain.studies import (
    TransientResult,
    drivetrain_transient,
    transient,
    transient_digest,
)
from fe_drivetrain.studies.transient_digest import equivalent_range
from fe_drivetrain.studies.transient_histories import OperationOptions
from fe_drivetrain.studies.transient_ladder import cheapest_level, level_error
from fe_drivetrain.studies.transient_loads import design_loads
from fe_drivetrain.studies.transient_parts import DamageOptions
from fe_drivetrain.studies.transient_runs import Extreme, Samples, telling_torque
from fe_drivetrain.turbine_loads.histories.sites import Site
from fe_drivetrain.turbine_loads.hub_loads.drive_history import DriveHistory

CATALOGUE = protest_catalogue()
PARK = {"operation.rated_power": 1.5e6, "operation.rotor_speed": [1.0, 1.8]}


@pytest.fixture(scope="module")
def stopped() -> TransientResult:
    return transient(
        two_masses(), "stop", {"off": 0.1, "pitched": 0.2, "braked": 0.5, "rise": 0.0, "brake": 2.0}
    )


@pytest.fixture(scope="module")
def dipped() -> TransientResult:
    """A drivetrain of the library at all of its levels."""
    park = read_drivetrain("park_2021", PARK)
    return transient(park, "dip", {"start": 0.2}, duration=0.8, quantity="torque")


def write_torque(path: Path, amplitude: float, seconds: float = 40.0) -> None:
    """Torque about three quarters of rated at 0.05 Hz, at rated speed, other loads constant."""
    time = np.arange(0.0, seconds + 0.01, 0.05)
    torque = 0.75 * TORQUE + amplitude * np.cos(2 * np.pi * 0.05 * time)
    still = np.tile([1e3, 0.0, -1e5], (len(time), 1))
    table = np.column_stack([time, still, torque, 0.0 * time, 0.0 * time, 0.0 * time + SPEED])
    header = "time [s],Fx [N],Fy [N],Fz [N],Mx [N m],My [N m],Mz [N m],rotor speed [rad/s]"
    np.savetxt(path, table, delimiter=",", header=header, comments="", fmt="%.9g")


@pytest.fixture(scope="module")
def operated(tmp_path_factory: pytest.TempPathFactory) -> TransientResult:
    folder = tmp_path_factory.mktemp("histories")
    write_torque(folder / "a.csv", 1e5)
    write_torque(folder / "b.csv", 2e5)
    options = OperationOptions(slopes=(4.0, 10.0), step=0.02)
    return transient(two_masses(), "operation", loads=folder, options=options)


def test_a_stop_has_the_extremes_of_its_samples_and_its_band(stopped: TransientResult) -> None:
    assert stopped.level == "torsional"
    one, values = stopped.extremes["torque of shaft"], stopped.samples.of("torque of shaft")
    assert_allclose(one.rated, TORQUE, rtol=1e-9)
    assert_allclose([one.most, one.least], [values.max(), values.min()], rtol=1e-4)
    assert one.most_band is not None
    assert 0.0 < one.most_band < 1e-2 * one.most
    assert one.reversals > 0
    assert stopped.imbalance < 1e-8
    assert stopped.passed
    # what both have of momentum, over twice the generator's torque
    still = (ROTOR + GENERATOR) * SPEED / (2.0 * TORQUE) + 0.5
    assert abs(stopped.marks["disc stands"] - still) < 1.0
    assert "bodies only turn" in stopped.notes[0].lower()


def test_the_peak_of_a_stop_is_one_of_those_by_the_instant_of_the_brake(
    stopped: TransientResult,
) -> None:
    """Over a period of the first mode; at no delay it is that of the stop itself."""
    found = stopped.by_instant
    assert found is not None
    reduced = ROTOR * GENERATOR / (ROTOR + GENERATOR)
    assert_allclose(found.period, 2 * np.pi * np.sqrt(reduced / STIFFNESS), rtol=1e-9)
    assert len(found.delays) == len(found.peaks) == 8
    later = stopped.samples.times >= 0.5
    first = stopped.samples.times < 0.5 + 2.5 * found.period
    own = stopped.samples.of("torque of shaft")[later & first].max() / TORQUE
    assert_allclose(found.peaks[0], own, rtol=1e-4)
    # undamped, the swing that the brake meets adds to its own or takes from it
    assert max(found.peaks) > 1.2 * min(found.peaks)


def test_a_torque_that_a_brake_reverses_counts_by_the_instant_of_the_brake() -> None:
    """A disc at the rotor: what is behind winds the shaft up backwards."""
    values = {"off": 0.1, "pitched": 0.2, "braked": 0.5, "rise": 0.0, "brake": 6.0}
    found = transient(two_masses(), "stop", {**values, "shaft": "rotor"}, damage=None)
    assert found.by_instant is not None
    later = found.samples.times >= 0.5
    first = found.samples.times < 0.5 + 2.5 * found.by_instant.period
    own = found.samples.of("torque of shaft")[later & first] / TORQUE
    assert -own.min() > 1.1 * own.max()
    assert_allclose(found.by_instant.peaks[0], -own.min(), rtol=1e-4)


def test_assumed_values_of_the_event_are_stated_and_given_ones_are_not(
    stopped: TransientResult,
) -> None:
    names = [row.name for row in stopped.assumptions]
    assert "left of the event" in names
    assert "braked of the event" not in names
    assert not any("damping" in name for name in names)


def test_the_brake_of_the_file_is_the_one_that_stops() -> None:
    braked = two_masses(brake={"shaft": "shaft", "torque": 3e6, "rise": 0.1})
    found = transient(braked, "stop", {"shaft": "generator"}, duration=8.0)
    assert found.options["values"] == {"shaft": "generator", "brake_torque": 3e6, "rise": 0.1}
    still = (ROTOR + GENERATOR) * SPEED / 3e6
    assert 3.0 < found.marks["disc stands"] < 3.0 + still + 1.0


def test_levels_are_compared_with_the_finest(dipped: TransientResult) -> None:
    assert [run.degrees for run in dipped.runs] == [10, 60, 60]
    finest = dipped.runs[-1]
    assert level_error(finest, finest, "torque").error == 0.0
    assert level_error(dipped.runs[0], finest, "bearing").error == np.inf
    chosen = dipped.runs.index(dipped.chosen)
    assert level_error(dipped.chosen, finest, "torque").error <= dipped.tolerance
    assert cheapest_level(dipped.runs, "bearing", 0.05) > 0
    # the error of each level is that of its extremes, the worst of the shafts
    errors = [next(e for e in of if e.kind == "torque") for of in dipped.errors]
    worst = errors[0].worst
    own, its = dipped.runs[0].extremes[worst], finest.extremes[worst]
    apart = max(abs(own.most - its.most), abs(own.least - its.least)) / its.largest
    assert_allclose(errors[0].error, apart, rtol=1e-12)
    assert [row[""] for row in dipped.tables["levels"]][chosen] == "reported"


def test_the_json_holds_digests_and_no_samples(dipped: TransientResult) -> None:
    found = json.loads(dipped.to_json())
    assert found["schema"] == "fe-drivetrain/transient/1"
    assert "samples" not in found["tables"]
    assert len(found["tables"]["extremes"]) == len(dipped.extremes)
    frame = dipped.frames()["samples"]
    assert len(frame) == len(dipped.samples.times)
    assert frame[0]["torque of HSS [N m]"] == dipped.samples.of("torque of HSS")[0]


def test_histories_come_back_as_torque_cycles_and_time_at_level(operated: TransientResult) -> None:
    """Two cycles of 0.2 and two of 0.4 of rated, slow: ranges by hand, of both files together."""
    one = operated.extremes["torque of shaft"]
    assert_allclose([one.most, one.least], [0.95e6, 0.55e6], rtol=5e-3)
    assert one.file == "b"
    (row,) = [r for r in operated.tables["equivalent_loads"] if r["channel"] == "torque of shaft"]
    for slope in (4.0, 10.0):
        known = ((2 * 2e5**slope + 2 * 4e5**slope) / 80.0) ** (1.0 / slope) / 1e3
        assert_allclose(row[f"equivalent range, m = {slope:g}"], known, rtol=2e-2)
    spectrum = [r for r in operated.tables["duration_spectra"] if r["channel"] == "torque of shaft"]
    assert_allclose(sum(r["time [s]"] for r in spectrum), 80.0, rtol=2e-3)
    below = sum(r["time [s]"] for r in spectrum if r["to"] <= 750.0)
    assert_allclose(below, 40.0, atol=2.0)
    assert all(digest.against_file < 0.01 for digest in operated.files.values())
    assert operated.passed


def test_an_equivalent_range_is_that_of_a_sine_of_a_hertz() -> None:
    assert_allclose(equivalent_range(60.0 * 3.0**5, 60.0, 5.0), 3.0)


def test_a_run_that_is_resumed_reads_what_is_done_no_more(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path / "cache"))
    for name in ("a", "b", "c"):
        write_torque(tmp_path / f"{name}.csv", 1e5, 4.0)
    files = tmp_path / "?.csv"
    options = OperationOptions(step=0.05)
    first = transient(two_masses(), "operation", loads=files, options=options)

    def refuse(_: object, history: DriveHistory, *__: object) -> None:
        raise AssertionError(history.name)

    monkeypatch.setattr(transient_digest, "driven", refuse)
    again = transient(two_masses(), "operation", loads=files, options=options, resume=True)
    assert again.tables["equivalent_loads"] == first.tables["equivalent_loads"]
    with pytest.raises(AssertionError, match="b"):
        transient(
            two_masses(), "operation", loads=files, options=OperationOptions(step=0.04), resume=True
        )


@pytest.mark.parametrize(
    ("event", "more", "said"),
    [
        ("halt", {}, "event"),
        ("stop", {"quantity": "stress"}, "quantity"),
        ("stop", {"tolerance": 0.0}, "`tolerance` is 0 but must be between 0 and 1"),
        ("stop", {"duration": -1.0}, "`duration` is -1 s but must be above 0 s"),
        ("stop", {"step": 0.0}, "`step` is 0 s but must be from 1e-07 to 1 s"),
        ("stop", {"loads": "x.csv"}, "event stop takes no histories: leave `loads` out"),
        ("stop", {"level": "rigid"}, "needs what its file does not state: rotor: mass"),
        ("offset", {"values": {"coupling": 1e6}}, "event offset needs all motions of 'Two masses'"),
        ("offset", {"values": {"coupling": 1e6}, "level": "torsional"}, "does not happen at"),
        ("dip", {"values": {"gearbox_uz": 1e-3}, "level": "torsional"}, "dip with its values does"),
        ("operation", {}, "operation needs histories"),
        ("operation", {"loads": "none.csv"}, "none.csv"),
    ],
)
def test_what_cannot_be_asked_is_refused(event: str, more: dict[str, object], said: str) -> None:
    with pytest.raises(InputError, match=said):
        transient(two_masses(), event, **more)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ({"duration": -5.0}, "`duration` is -5 s but must be above 0 s: change it"),
        ({"duration": 0.0}, "`duration` is 0 s but must be above 0 s"),
        ({"step": 0.0}, "`step` is 0 s but must be from 1e-07 to 1 s"),
        ({"step": 0.1}, "`step` is 0.1 s but samples of .*a.csv' are 0.05 s apart"),
        ({"options": OperationOptions(until=-1.0)}, "`duration` is -1 s"),
        ({"damage": DamageOptions(site=Site(8.5))}, "there is no wind speed"),
    ],
)
def test_operation_refuses_what_it_cannot_count_before_it_runs(
    tmp_path: Path, more: dict[str, Any], said: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Zero is no word for the whole history, and one file no climate, before an hour of work."""
    path = tmp_path / "a.csv"
    write_torque(path, 1e5)

    def refuse(*_: object) -> None:
        raise AssertionError("a history was driven")

    monkeypatch.setattr(drivetrain_transient, "moving_under", refuse)
    with pytest.raises(InputError, match=said):
        transient(two_masses(), "operation", loads=path, **more)


@pytest.mark.parametrize(
    ("operation", "said"),
    [
        (None, "does not state the speed of its rotor: add operation"),
        ({"rated_power": 1e6}, "does not state the speed of its rotor"),
        ({"rotor_speed": [1.0, 1.5]}, "does not state its rated power"),
    ],
)
def test_what_the_file_lacks_is_named(operation: dict[str, object] | None, said: str) -> None:
    with pytest.raises(InputError, match=said):
        transient(two_masses(operation=operation), "stop")


def test_a_rated_torque_of_the_generator_stands_for_the_power() -> None:
    generator = {"inertia": GENERATOR, "rated_torque": 4e5, "slip": 0.02}
    slow = two_masses(operation={"rotor_speed": [1.0, 1.5]}, generator=generator)
    found = transient(slow, "grid_loss", duration=1.2)
    assert_allclose(found.extremes["torque of shaft"].rated, 4e5, rtol=1e-9)
    assert found.options["rated"]["slip"] == 0.02


def test_the_command_writes_a_page_and_samples(
    invoke: Callable[..., Result], tmp_path: Path
) -> None:
    mine = tmp_path / "mine.yaml"
    mine.write_text(yaml.safe_dump(two_mass_file()), encoding="utf-8")
    write_torque(tmp_path / "a.csv", 1e5, 10.0)
    out = tmp_path / "out"
    status, printed, _ = invoke(
        *("transient", str(mine), "grid-loss", "--value", "off=0.5", "--duration", "1"),
        *("--csv", "--out", str(out)),
    )
    assert status == 0, printed
    assert printed.startswith("Losing the grid reverses the torque of the shaft to -0.6 of rated")
    results = read_results(out / "results.json")
    assert broken_rules(results) == []
    lines = (out / "samples.csv").read_text(encoding="utf-8").splitlines()
    assert lines[0].startswith("time [s],torque of shaft [N m]")
    assert len(lines) == 2002
    status, printed, _ = invoke(
        *("transient", str(mine), "operation", "--loads", str(tmp_path / "a.csv")),
        *("--out", str(tmp_path / "driven"), "--json", "--slope", "4"),
    )
    assert status == 0, printed
    assert json.loads(printed)["tables"]["files"][0]["file"] == "a"
    assert broken_rules(read_results(tmp_path / "driven" / "results.json")) == []


@pytest.mark.parametrize(
    ("typed", "said"),
    [
        (("halt",), "no event 'halt': use one of operation, stop, grid-loss"),
        (("stop", "--skip", "2"), "give --loads, too, or leave --skip out"),
        (("stop", "--value", "off"), "--value 'off' must be KEY=VALUE"),
        (("stop", "--value", "off=true"), "--value off: True must be a number or a word"),
        (("stop", "--level", "solid"), "level"),
        (("stop", "--duration", "0"), "--duration is 0 s but must be above 0 s"),
        (("operation",), "operation needs histories: give --loads"),
        (("dip", "--set", "rotor.inertia=-1"), "inertia"),
    ],
)
def test_a_mistake_is_one_sentence_and_leaves_nothing(
    invoke: Callable[..., Result], tmp_path: Path, typed: tuple[str, ...], said: str
) -> None:
    mine, out = tmp_path / "mine.yaml", tmp_path / "out"
    mine.write_text(yaml.safe_dump(two_mass_file()), encoding="utf-8")
    status, _, error = invoke("transient", str(mine), *typed, "--out", str(out))
    assert status == 2
    assert said in error
    assert not (out / "results.json").exists()


def test_a_chart_of_many_samples_keeps_a_peak_of_one() -> None:
    times = np.linspace(0.0, 1.0, 100_001)
    values = np.sin(40.0 * times)
    values[73_217] = -5.0
    samples = Samples(times, values[:, None], ("torque of HSS",), ("N m",))
    at, shown = samples.course("torque of HSS", 2000)
    assert len(at) <= 2000
    assert shown.min() == -5.0
    assert at[shown.argmin()] == times[73_217]
    assert (np.diff(at) > 0).all()
    late, _ = samples.course("torque of HSS", 2000, begin=0.5)
    assert late[0] >= 0.5


def test_what_tells_is_the_shaft_that_is_loaded_most_and_the_last_of_those_alike() -> None:
    """A brake before the last shaft loads the gears and not that shaft."""

    def torque(most: float, least: float, rated: float = 10.0) -> Extreme:
        return Extreme("torque", "N m", rated, most, 0.0, least, 0.0, 0)

    braked = {"torque of main": torque(22.0, 0.0), "torque of last": torque(10.0, -9.0)}
    assert telling_torque(braked) == "torque of main"
    assert telling_torque(braked | {"torque of last": torque(5.0, -21.5)}) == "torque of last"
    assert telling_torque({"torque of main": torque(1.0, 0.0, 0.0)}) == ""


@pytest.mark.parametrize(
    ("event", "channel", "most", "least"),
    [
        ("operation", "torque of main", {ROTOR_TORQUE, TORQUE_AND_BENDING}, {REVERSALS}),
        ("stop", "torque of main", {TORQUE_AND_BENDING}, {REVERSALS}),
        ("stop", "torque of last", {TORQUE_AND_BENDING}, {REVERSALS, HIGH_SPEED_REVERSALS}),
        ("stop", "force of stage 1 mesh", {OVERLOAD}, {REVERSALS}),
        ("stop", "force of front", {TORQUE_AND_BENDING}, {TORQUE_AND_BENDING}),
        ("stop", "axial force of HS-A", {BEARING_RATING}, {BEARING_RATING}),
        ("dip", "force of stage 1 mesh", {OVERLOAD, DIPS, ELECTRICAL_FAULT}, None),
        ("grid_loss", "torque of main", {TORQUE_AND_BENDING, ELECTRICAL_FAULT}, None),
        ("offset", "force of HS-A", {BEARING_RATING, MISALIGNMENT}, None),
        ("run_up", "force of stage 1 mesh", {OVERLOAD, RESONANCE}, None),
        ("dip", "speed of rotor", set(), set()),
    ],
)
def test_extremes_are_values_of_design_loads_of_the_catalogue(
    event: str, channel: str, most: set[str], least: set[str] | None
) -> None:
    kinds = {
        **{"torque of main": "torque", "torque of last": "torque", "speed of rotor": "speed"},
        **{"force of stage 1 mesh": "mesh", "force of front": "bearing"},
        **{"force of HS-A": "bearing", "axial force of HS-A": "bearing"},
    }
    extremes = {
        name: Extreme(kind, "N", 1.0, 1.0, 0.0, 1.0, 0.0, 0)  # type: ignore[arg-type]
        for name, kind in kinds.items()
    }
    found = design_loads(event, extremes, {"front"})[channel]
    assert set(found.most) == most
    assert least is None or set(found.least) == least
    known = {load.name for system in ("gearbox", "drivetrain") for load in CATALOGUE.of(system)}
    assert set(found.most) | set(found.least) <= known


def test_results_say_of_which_loads_their_values_are(stopped: TransientResult) -> None:
    assert stopped["largest torque of shaft"].loads == (TORQUE_AND_BENDING,)
    assert HIGH_SPEED_REVERSALS in stopped["least torque of shaft"].loads
    of = stopped.tables[LEVEL_ERRORS]["torques of shafts"]
    assert of["levels"] == ["torsional"]
    assert of[ERROR_AGAINST_LAST] == [0.0]
    one = stopped.extremes["torque of shaft"]
    assert_allclose(of[OWN_ERROR], max(one.most_band, one.least_band) / one.largest)


def test_samples_of_a_history_are_even_where_some_are_left_out(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Over the ends of the pieces in which it is integrated, so that they can be compared."""
    monkeypatch.setattr(transient_digest, "KEPT", 300)
    monkeypatch.setattr(drivetrain_operation, "AT_ONCE", 500)
    write_torque(tmp_path / "a.csv", 1e5)
    options = OperationOptions(step=0.02)
    found = transient(two_masses(), "operation", loads=tmp_path / "a.csv", options=options)
    assert_allclose(np.diff(found.samples.times), 0.12, atol=1e-6)
    assert 300 < len(found.samples.times) < 400


def test_what_the_first_mode_keeps_of_the_ratios_is_said() -> None:
    """All of it with two masses; with bodies that are light against both ends next to nothing."""
    ratios = DampingRatios(shafts=0.03, meshes=0.1)
    assert_allclose(first_mode_damping(machine_of(two_masses()), ratios), 0.03, rtol=1e-12)
    park = read_drivetrain("park_2021", PARK)
    assert first_mode_damping(machine_of(park)) < 0.2 * ASSUMED_RATIOS.shafts
    words = "Swings hardly decay"
    damped = transient(two_masses(damping={"shafts": 0.03}), "grid_loss", duration=1.2)
    assert not any(note.startswith(words) for note in damped.notes)
    light = transient(park, "grid_loss", {"off": 0.1}, level="torsional", duration=0.3)
    assert any(note.startswith(words) for note in light.notes)
