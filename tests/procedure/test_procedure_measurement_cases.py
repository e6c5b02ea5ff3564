"""Scripts of a campaign, torques by table, and what governs a gearbox's strength."""

from pathlib import Path

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.dynamics.torsion.system import Inertia, chain, modal_damping
from fe_drivetrain.procedure.decay import logarithmic_decrement
from fe_drivetrain.procedure.duty import governing_torque
from fe_drivetrain.procedure.measurement_cases import (
    case_channels,
    protest_measurement_cases,
    read_measurement_cases,
)
from fe_drivetrain.procedure.voltage_dips import Dip, TorqueTable

FRONT, REAR = 150.0, 24.0
SYSTEM = chain([Inertia("rotor", FRONT), Inertia("generator", REAR)], [("s", 5300.0, 20.0)])
RATED, STEP = 8000.0, 0.02
CODES = ["NTA", "NTB", "NTD", "NTE", "NTF", "NTH", "STB", "STC", "STD", "STF", "STG"]


def test_all_cases_of_the_table_are_there() -> None:
    assert [case.code for case in protest_measurement_cases().cases] == CODES


@pytest.mark.parametrize("code", CODES)
def test_a_case_ends_at_its_speed_with_the_momentum_that_it_was_given(code: str) -> None:
    case = protest_measurement_cases().of(code)
    found = case_channels(case, SYSTEM, RATED, STEP)
    momentum = FRONT * found["rotor speed"] + REAR * found["generator speed"]
    speed = case.speed(found["time"])
    # what torque, straight between samples, gives of the script's momentum: half a step at corners
    error = np.abs(momentum - (FRONT + REAR) * speed).max()
    assert error <= (FRONT + REAR) * np.abs(np.diff(speed)).max() + 1e-6
    steady = STEP * np.arange(2)
    assert found["shaft torque"][:2] == pytest.approx(RATED * case.torque(steady), abs=1e-6)


def test_standstill_stands_and_reverse_turns_back() -> None:
    cases = protest_measurement_cases()
    still = case_channels(cases.of("NTF"), SYSTEM, RATED, STEP)
    assert all(not still[name].any() for name in still if name != "time")
    back = case_channels(cases.of("STG"), SYSTEM, RATED, STEP)
    assert back["generator speed"][-1] == pytest.approx(-50.0 * np.pi / 30.0, rel=1e-3)


def test_after_loss_of_the_grid_the_twist_decays_with_the_modal_damping() -> None:
    case = protest_measurement_cases().of("STB")
    found = case_channels(case, SYSTEM, RATED, 0.005)
    # held speed from 11 s on: nothing drives it
    part = (found["time"] > 11.05) & (found["time"] < 13.9)
    decay = logarithmic_decrement(found["twist"][part], 0.005)
    assert decay.ratio == pytest.approx(float(modal_damping(SYSTEM)[1]), rel=2e-3)


def test_a_users_scripts_and_their_faults(tmp_path: Path) -> None:
    path = tmp_path / "mine.yaml"
    row = "{code: A, title: mine, corners: [[0, 10, 0], [5, 20, 0]]}"
    path.write_text(f"title: mine\ncases: [{row}]\n")
    assert read_measurement_cases(path).of("A").seconds == 5.0
    for cases, words in ((f"{row}, {row}", "two measurement"), (row.replace("5,", "0,"), "later")):
        path.write_text(f"title: mine\ncases: [{cases}]\n")
        with pytest.raises(InputError, match=words):
            read_measurement_cases(path)
    with pytest.raises(InputError, match="use one of"):
        protest_measurement_cases().of("XXX")
    with pytest.raises(InputError, match="shortest part"):
        case_channels(protest_measurement_cases().of("STB"), SYSTEM, RATED, 0.1)


def test_a_table_of_torque_is_any_dip() -> None:
    time = np.linspace(0.0, 3.0, 301)
    dip = Dip(0.5, 0.8, 0.15, 0.01, 0.4)
    table = TorqueTable((0.5, 0.51, 0.65, 1.05), (1.0, 0.2, 0.2, 1.0))
    assert dip.shares(time) == pytest.approx(table.shares(time))
    twice = TorqueTable((0.5, 0.5, 0.7, 0.7, 1.5, 1.5), (1.0, 0.0, 0.0, 1.0, 1.0, 0.5))
    assert twice.shares(np.array([0.6, 1.0, 2.0])).tolist() == [0.0, 1.0, 0.5]
    with pytest.raises(InputError, match="in order"):
        TorqueTable((1.0, 0.5), (1.0, 1.0))


def test_the_brake_governs_unless_something_has_more() -> None:
    assert governing_torque(90.0, 60.0, 40.0).brake_covers
    outpaced = governing_torque(90.0, 60.0, 40.0, transient=3.0 * 40.0)
    assert (outpaced.by, outpaced.torque, outpaced.brake_covers) == ("transient", 120.0, False)
    with pytest.raises(InputError, match="give its size"):
        governing_torque(-1.0, 0.0, 0.0)
