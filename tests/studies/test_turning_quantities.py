"""Frequencies and factors of gears by name: levels they need, spreads of inputs, designs."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fe_drivetrain.command_line import main
from fe_drivetrain.common import InputError
from fe_drivetrain.common.steps import Steps
from fe_drivetrain.drivetrain_file import LumpedDrivetrain, read_drivetrain
from fe_drivetrain.dynamics import RUNGS, Asked, Operation, like_mode, machine_of
from fe_drivetrain.report.results import read_results
from fe_drivetrain.shafts.uncertainty import sensitivities
from fe_drivetrain.studies import advise_turning, compare, gears, transient, uncertainty
from fe_drivetrain.studies.gear_options import GearOptions
from fe_drivetrain.studies.turning_advice import turning_ladder
from fe_drivetrain.studies.turning_model import TurningModel
from fe_drivetrain.studies.turning_quantities import turning_quantities, turning_quantity

ROTOR, GENERATOR, SHAFT = 4e6, 9e5, 2e8  # kg m^2, kg m^2, N m/rad
FREQUENCY = math.sqrt(SHAFT * (1.0 / ROTOR + 1.0 / GENERATOR)) / (2.0 * math.pi)
TORSION = 206e9 / 2.6 * math.pi * 0.6**4 / 32.0 / 3.0  # steel, 0.6 m in diameter, 3 m long
THICK = math.sqrt(TORSION * (1.0 / ROTOR + 1.0 / GENERATOR)) / (2.0 * math.pi)
TWO = f"""\
title: direct drive
rotor: {{inertia: {ROTOR}}}
shaft: {{torsion: {SHAFT}}}
generator: {{inertia: {GENERATOR}}}
uncertainty:
  shaft.torsion: {{uniform: 0.02}}
"""


@pytest.fixture
def two(tmp_path: Path) -> Path:
    """File of a rotor and a generator on a shaft whose stiffness is uncertain."""
    path = tmp_path / "two.yaml"
    path.write_text(TWO)
    return path


def with_masses(**changes: Any) -> LumpedDrivetrain:
    """The two inertias on a thick shaft in stiff bearings; all of them may move."""
    stiff = [1e13, 1e13, 1e13, 0.0, 1e13, 1e13]
    values: dict[str, Any] = {
        "title": "direct drive",
        "rotor": {"inertia": ROTOR, "mass": 4e4, "transverse": ROTOR},
        "shaft": {"outer": 0.6, "length": 3.0},
        "generator": {"inertia": GENERATOR, "mass": 5e4},
        "gearbox": {
            "bearings": [
                {"name": "front", "holds": "main shaft", "at": 0.0, "stiffness": stiff},
                {"name": "rear", "holds": "main shaft", "at": 3.0, "stiffness": stiff},
            ]
        },
    }
    return LumpedDrivetrain.model_validate({**values, **changes})


def test_frequency_of_two_inertias_has_half_the_spread_of_the_stiffness(two: Path) -> None:
    """By hand: f goes with the root of k, so that 2 % of it are 1 % of f, 95 % of it 0.95 %."""
    found = uncertainty(read_drivetrain(two), samples=400)
    (one,) = found.effects.quantities
    assert one.name == "modes.torsional.1"
    assert one.nominal == pytest.approx(FREQUENCY, rel=1e-9)
    assert one.sensitivities["shaft.torsion"] == pytest.approx(0.5, rel=1e-6)
    ends = [FREQUENCY * math.sqrt(1.0 + sign * 0.02 * 0.95) for sign in (-1.0, 1.0)]
    for end, sampled, error in zip(
        ends,
        (one.band.low, one.band.high),
        (one.band.low_error, one.band.high_error),
        strict=True,
    ):
        assert sampled == pytest.approx(end, abs=4.0 * error)
    assert found.level == "torsional"


def test_change_of_frequency_by_hand() -> None:
    """A shaft that is 21 % stiffer has a frequency 10 % higher."""
    designs = {
        "first": LumpedDrivetrain.model_validate(_data()),
        "second": LumpedDrivetrain.model_validate(_data(1.21 * SHAFT)),
    }
    (found,) = compare(designs, ["modes.torsional.1"]).differences
    assert found.values[0].size == pytest.approx(FREQUENCY, rel=1e-9)
    assert found.changes == pytest.approx([0.1], rel=1e-9)
    assert found.bands == pytest.approx([0.0], abs=1e-9)


def _data(torsion: float = SHAFT) -> dict[str, Any]:
    return {
        "title": "direct drive",
        "rotor": {"inertia": ROTOR},
        "shaft": {"torsion": torsion},
        "generator": {"inertia": GENERATOR},
    }


def test_torsion_is_enough_in_stiff_bearings() -> None:
    """Nothing but turning gives way: the torsional level is the cheapest, by hand right."""
    found = advise_turning(with_masses(), "modes.torsional.1", 0.01)
    assert found.level == "torsional"
    assert len(found.ladder.levels) == len(RUNGS)
    simplest = found.ladder.levels[0]
    assert simplest.value == pytest.approx(THICK, rel=1e-3)  # but for the inertia of the shaft
    assert simplest.error <= found.ladder.bound(0) <= 0.01


def test_torsion_is_not_enough_where_no_mode_turns() -> None:
    """The first frequency of soft bearings is none of turning: the torsional level lacks it."""
    soft = [1e6, 1e6, 1e6, 0.0, 1e6, 1e6]
    bearings = [
        {"name": name, "holds": "main shaft", "at": at, "stiffness": soft}
        for name, at in (("front", 0.0), ("rear", 3.0))
    ]
    found = advise_turning(with_masses(gearbox={"bearings": bearings}), "modes.frequency.1", 0.05)
    assert found.ladder.levels[0].value is None
    assert found.level == "rigid bodies"


def test_factors_of_gears_are_those_of_the_rating() -> None:
    """A quantity of a name is the number that `gears` finds, at the level that it rates by."""
    drivetrain = read_drivetrain("synthetic_2mw")
    rated = gears(drivetrain, options=GearOptions(level="torsional"))
    model = TurningModel(drivetrain, RUNGS[0])
    known = turning_quantities(drivetrain)
    for name, mesh in rated.meshes.items():
        assert known[f"gears.{name}.K_Hbeta"].of(model) == mesh.spread.face_load
    for name, gear in rated.gears.items():
        assert known[f"gears.{name}.sigma_H"].of(model) == gear.contact_stress


def test_peaks_are_those_of_the_event() -> None:
    """A peak of a name is the largest value that `transient` finds at that level."""
    running = {"rated_power": 5e6, "rotor_speed": [0.7, 1.3]}
    drivetrain = LumpedDrivetrain.model_validate({**_data(), "operation": running})
    found = transient(drivetrain, "grid_loss", level="torsional", quantity="torque")
    name = "torque of main shaft"
    peak = turning_quantity(drivetrain, f"transient.grid_loss.{name}.peak")
    model = TurningModel(drivetrain, RUNGS[0])
    assert peak.unit == "N m"
    assert peak.value(model) == found.extremes[name].largest
    assert peak.value(model) > 0.9 * 5e6 / 1.3  # where it began
    assert 0.0 < peak.own(model) < 0.01 * peak.value(model)


def test_contact_stress_goes_with_the_root_of_the_load() -> None:
    """By hand: sigma_H of Hertz grows with the root of the torque, falls with that of the width."""
    drivetrain = read_drivetrain("synthetic_2mw")
    stress = turning_quantity(drivetrain, "gears.stage 3 pinion.sigma_H")
    keys = ["operation.rated_power", "gearbox.stages.2.face_width"]
    slopes = sensitivities(
        drivetrain, lambda one: {stress.name: stress.value(TurningModel(one, RUNGS[0]))}, keys
    )
    assert list(slopes[stress.name].values()) == pytest.approx([0.5, -0.5], rel=1e-5)


def test_mode_of_another_drivetrain_is_followed() -> None:
    """A frequency keeps its mode where another one overtakes it."""
    soft, stiff = (with_masses(shaft={"outer": d, "length": 3.0}) for d in (0.6, 0.62))
    finest = Asked(machine_of(soft), RUNGS[-1], Operation(0.0))
    frequencies = finest.modes.frequencies[finest.modes.frequencies > 0.0]
    number = int(np.abs(frequencies - THICK).argmin()) + 1
    moved = like_mode(finest, number)(Asked(machine_of(stiff), RUNGS[-1], Operation(0.0)))
    own = like_mode(finest, number)(finest)
    assert moved is not None
    assert own is not None
    assert moved / own == pytest.approx((0.62 / 0.6) ** 2, rel=1e-3)


def test_zero_has_no_relative_error() -> None:
    """A quantity that is zero at the finest level cannot be judged."""
    drivetrain = with_masses()
    zero = turning_quantity(drivetrain, "modes.torsional.1")
    object.__setattr__(zero, "of", lambda model: 0.0)
    with pytest.raises(InputError, match="is zero, and has no relative error"):
        turning_ladder(drivetrain, zero, RUNGS[:1], 0.01, Steps())


@pytest.mark.parametrize(
    "command", [["advise"], ["uncertainty"], ["compare", "--vary", "shaft.torsion=1e8,2e8"]]
)
def test_unknown_quantity_is_refused(
    command: list[str], two: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The message names what there is; nothing is written."""
    asked = [command[0], str(two), *command[1:], "--quantity", "modes.torsionl.1"]
    out = two.parent / "out"
    with pytest.raises(SystemExit) as ended:
        main([*asked, "--out", str(out)])
    assert ended.value.code == 2
    said = capsys.readouterr().err
    assert "did you mean 'modes.torsional.1'" in said
    assert not out.exists()


def test_load_and_reactions_do_not_go_with_what_turns(
    two: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Each is of another model."""
    with pytest.raises(InputError, match="ask for them one by one"):
        uncertainty(read_drivetrain("two_bearings"), ["modes.torsional.1", "hub.stiffness.uz"])
    with pytest.raises(InputError, match="but is for reactions"):
        uncertainty(read_drivetrain(two), ["modes.torsional.1"], {"hub.Fz": 1e5})
    with pytest.raises(InputError, match="no sections"):
        uncertainty(read_drivetrain(two), ["hub.stiffness.uz"])


def test_commands_answer(two: Path, tmp_path: Path) -> None:
    """Each command has its page, with the frequency by hand."""
    name = ["--quantity", "modes.torsional.1"]
    for command in (
        ["advise", str(two), *name],
        ["uncertainty", str(two), *name, "--samples", "40", "--level", "torsional"],
        ["compare", str(two), "--vary", "shaft.torsion=2e8,2.42e8", *name],
    ):
        out = tmp_path / command[0]
        with pytest.raises(SystemExit) as ended:
            main([*command, "--out", str(out)])
        assert ended.value.code == 0
        found = read_results(out / "results.json")
        assert found.answer is not None
        key = found.answer.figures[0]
        expected = 10.0 if command[0] == "compare" else FREQUENCY
        assert key.value == pytest.approx(expected, rel=1e-6)
        assert (out / "report.html").stat().st_size > 0
