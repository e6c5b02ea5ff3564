"""Splines of shafts and bushings of pins in a drivetrain's models."""

from typing import Any

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file import read_drivetrain
from fe_drivetrain.dynamics.bodies.levels import Level, machine_system, steady_load, torsional
from fe_drivetrain.dynamics.bodies.machine import machine_of
from fe_drivetrain.dynamics.bodies.modes import system_modes
from fe_drivetrain.dynamics.bodies.static import Static, static
from fe_drivetrain.dynamics.bodies.torsional_table import gear_table
from fe_drivetrain.dynamics.torsion.gear_table import gear_masses
from fe_drivetrain.dynamics.torsion.system import natural_modes
from fe_drivetrain.export.turning_lines import Link, turning_lines
from fe_drivetrain.studies.gear_options import GearOptions
from fe_drivetrain.studies.gear_ratings import gears

SPLINE = {"teeth": 32, "diameter": 0.2, "length": 0.11, "at": 0.3}
BUSHING = [1e9, 2e9, 3e9, 1e8, 2e8, 3e8]
RIGID = {"gearbox.shafts.0.torsion": None, "gearbox.shafts.0.kind": "rigid"}


def frequencies(level: Level, changes: dict[str, Any]) -> np.ndarray:
    machine = machine_of(read_drivetrain("grc_750kw", changes))
    return np.asarray(system_modes(machine_system(machine, level)).frequencies)


def loaded(changes: dict[str, Any]) -> Static:
    machine = machine_of(read_drivetrain("grc_750kw", changes))
    system = machine_system(machine, Level.FLEXIBLE, held_generator=True)
    return static(system, steady_load(machine, system, 3.24e5, np.zeros(6)))


def spline(**changes: Any) -> dict[str, Any]:
    return {"gearbox.shafts.0.spline": SPLINE | changes}


@pytest.mark.parametrize("level", list(Level))
@pytest.mark.parametrize("at", [0.0, 0.3, 0.6])
def test_a_rigid_spline_and_rigid_bushings_change_nothing(level: Level, at: float) -> None:
    stiff = {"gearbox.stages.0.bushing": [1e15] * 6} | spline(
        at=at, stiffness=1e14, axial=1e16, length=0.4
    )
    assert frequencies(level, stiff)[:40] == pytest.approx(frequencies(level, {})[:40], rel=1e-4)


def test_a_spline_is_in_series_in_torsion() -> None:
    machine = machine_of(read_drivetrain("grc_750kw", spline()))
    k = 32 * 1.4e10 * 0.11 * (0.1 * np.cos(np.pi / 6)) ** 2
    row = gear_table(machine).shafts[1]
    assert row.stiffness == pytest.approx(1 / (1 / 2.45e7 + 1 / k))
    modes = natural_modes(torsional(machine)).frequencies
    assert natural_modes(gear_masses(gear_table(machine))).frequencies == pytest.approx(
        modes, rel=1e-6
    )


def test_a_shaft_with_mass_has_half_of_it_on_each_side_of_its_spline() -> None:
    sized = {"gearbox.shafts.0.torsion": None, "gearbox.shafts.0.outer": 0.15} | spline()
    machine = machine_of(read_drivetrain("grc_750kw", sized))
    with_spline = gear_table(machine)
    alone = gear_table(
        machine_of(read_drivetrain("grc_750kw", sized | {"gearbox.shafts.0.spline": None}))
    )
    ends = [(one.stages[0].sun, one.stages[1].gear) for one in (with_spline, alone)]
    assert ends[0] == pytest.approx(ends[1], rel=1e-12)


def test_a_sun_on_a_spline_of_one_slice_carries_no_moment_there() -> None:
    free, held = loaded(spline(slices=1)), loaded(spline())
    torque = 3.24e5 * 21 / 120
    assert abs(free.wrench("IS1 spline")[3]) == pytest.approx(torque, rel=1e-6)
    assert np.abs(free.wrench("IS1 spline")[4:]).max() < 1e-6 * torque
    moment = float(np.hypot(*held.wrench("IS1 spline")[4:]))
    assert moment > 1e-4 * torque


def test_a_rigid_shaft_may_be_a_spline_alone() -> None:
    both = RIGID | spline(at=0.0)
    machine = machine_of(read_drivetrain("grc_750kw", both))
    system = machine_system(machine, Level.RIGID)
    assert "IS1 spline rx" in system.spring_names
    assert gear_table(machine).shafts[1].stiffness == pytest.approx(
        machine.shafts[1].spline.bushing[3] if machine.shafts[1].spline else 0.0
    )


def test_bushings_carry_what_the_bearings_of_their_planet_do() -> None:
    state = loaded({"gearbox.stages.0.bushing": BUSHING})
    for k in (1, 2, 3):
        bearings = state.wrench(f"stage 1 pin {k} upwind") + state.wrench(
            f"stage 1 pin {k} downwind"
        )
        bushing = state.wrench(f"stage 1 bushing {k}")
        # bearings hold the planet, bushings the pin: what comes from the planet goes on
        assert bushing[:3] == pytest.approx(bearings[:3], rel=1e-6, abs=1.0)
    springs = {name: k for k, name in enumerate(state.system.spring_names)}
    assert state.system.stiffness[springs["stage 1 bushing 2 rz"]] == 3e8


def test_a_bushing_that_tilts_shifts_load_between_the_bearings_of_a_planet() -> None:
    shares = []
    for tilt in (1e6, 1e9):
        state = loaded({"gearbox.stages.0.bushing": [1e10, 1e10, 1e10, 1e8, tilt, tilt]})
        shares.append(state.radial("stage 1 pin 1 upwind") / state.radial("stage 1 pin 1 downwind"))
    assert abs(np.log(shares[0] / shares[1])) > 0.01


def test_a_spline_is_a_link_between_two_nodes_of_its_line() -> None:
    machine = machine_of(read_drivetrain("grc_750kw", spline()))
    lines, _ = turning_lines(machine, Level.FLEXIBLE)
    line = lines[1]
    names = [body.name for body in line.bodies]
    at = names.index("IS1 before spline")
    assert names[at + 1] == "IS1 behind spline"
    piece = line.pieces[at]
    assert isinstance(piece, Link)
    assert piece.stiffness.diagonal()[:6] == pytest.approx(
        machine.shafts[1].spline.bushing if machine.shafts[1].spline else (), rel=1e-12
    )


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"gearbox.shafts.2.spline": SPLINE}, "shaft 'HSS' is a coupling.* and has a spline"),
        (spline(at=0.7), "shaft 'IS1' has its spline at 0.7 m but is 0.6 m long"),
        (spline(length=0.7), "has a spline that is 0.7 m long but is 0.6 m long itself"),
        (spline(teeth=3), "shaft 1: spline: .*teeth is 3 but must be at least 6"),
        (
            {"gearbox.stages.0.bushing": [1e9, 1e9, 1e9, 0, 1e8, 1e8]},
            "bushing.3 is 0 but must be greater than 0",
        ),
    ],
)
def test_mistakes_are_refused(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        machine_of(read_drivetrain("grc_750kw", changes))


def test_gears_name_a_spline_whose_teeth_lift() -> None:
    options = GearOptions(level="rigid", azimuths=4, slices=3)
    stiff = gears(
        read_drivetrain("grc_750kw", spline(stiffness=1e13, length=0.03)), options=options
    )
    (row,) = stiff.tables["splines"]
    assert row["share of that limit"] > 1.0
    assert row["teeth in contact [%]"] < 100.0
    assert any("teeth lift" in note for note in stiff.notes)
    calm = gears(read_drivetrain("grc_750kw", spline()), options=options)
    (row,) = calm.tables["splines"]
    assert row["torque [kN m]"] == pytest.approx(324.114 * 21 / 120, rel=1e-4)
    assert row["share of that limit"] == pytest.approx(
        row["peak over mean of the teeth"] - 1.0, rel=0.05
    )
    assert not any("teeth lift" in note for note in calm.notes)
