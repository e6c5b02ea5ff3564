"""A gearbox beside the main shaft: forces in bearings and meshes by the flexibility of the rest."""

from functools import lru_cache

import numpy as np
import pytest

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import MOTIONS
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.spatial import wrench_transport
from fe_drivetrain.drivetrain_file import read_drivetrain
from fe_drivetrain.dynamics import Level, Machine, library_machine, machine_of
from fe_drivetrain.dynamics.bodies.advice import RUNGS
from fe_drivetrain.dynamics.time.running import Running, running
from fe_drivetrain.procedure.drivetrain_events import event_of
from fe_drivetrain.procedure.gearbox_offset import GearboxOffset
from fe_drivetrain.procedure.misalignment import machine_misalignment
from fe_drivetrain.procedure.travelling_planets import with_travelling_planets
from fe_drivetrain.studies.drivetrain_transient import transient
from fe_drivetrain.studies.transient_runs import Prepared, Rated

SIZES = {"u": 1e-3, "r": 1e-3}


@lru_cache
def at(level: Level) -> Running:
    return running(library_machine("nrel_750kw"), level, 3.25e5, 2.31)


def change(of: Running, **offset: float) -> Floats:
    """(m,) what an offset changes of the forces of a system's springs, at rest."""
    found = []
    for name, values in (("offset", offset), ("dip", {"depth": 0.0})):
        planned = event_of(name, dict(values)).plan(of, 2.0, 0.01)
        s = planned.phases[0].equations.springs
        found.append(s.stiffness * (s.rows @ planned.start.q - s.offset))
    count = len(of.system.spring_names)
    return np.asarray(found[0][:count] - found[1][:count])


@pytest.mark.parametrize("level", [Level.RIGID, Level.FLEXIBLE])
@pytest.mark.parametrize("motion", ["ux", "uy", "uz", "ry", "rz"])
def test_it_loads_bearings_as_the_main_bearing_moved_the_other_way_does(
    motion: str, level: Level
) -> None:
    """Forces by another formula, of flexibilities; the main shaft has no mass of its own.

    The generator turns alone, and does not feel it.
    """
    of = at(level)
    size = SIZES[motion[0]]
    forces = change(of, **{f"gearbox_{motion}": size})
    (main,) = (one for one in of.machine.bearings if one.name == "main bearing")
    away = np.array([main.at, 0.0, 0.0]) - of.machine.axes[1]
    moved = -size * wrench_transport(away).T @ np.eye(6)[MOTIONS.index(motion)]
    influence = machine_misalignment(of.machine, level)
    offsets = np.array(
        [
            moved[MOTIONS.index(name.rpartition(" ")[2])] * name.startswith("main bearing ")
            for name in influence.names
        ]
    )
    known = influence.forces(offsets)
    own = np.array([forces[of.system.spring_names.index(name)] for name in influence.names])
    scale = np.abs(known).max()
    assert scale > 1.0
    # those are on the structure, a spring's force is what it has of the structure
    np.testing.assert_allclose(own, -known, atol=1e-6 * scale)


def fixed_along(machine: Machine) -> Machine:
    """The machine whose carrier goes with the housing along the axis."""
    bearings = [
        one.model_copy(update={"stiffness": (1e13, *one.stiffness[1:])})
        if one.name == "PLC-A"
        else one
        for one in machine.bearings
    ]
    return machine.model_copy(update={"bearings": tuple(bearings)})


def test_along_the_axis_it_is_springs_in_series() -> None:
    """Main bearing and main shaft, whose end the housing takes along."""
    machine = fixed_along(library_machine("nrel_750kw"))
    of = running(machine, Level.RIGID, 3.25e5, 2.31)
    names = of.system.spring_names
    k = [of.system.stiffness[names.index(name)] for name in ("main bearing ux", "LSS ux")]
    push = 1e-3 / (1.0 / k[0] + 1.0 / k[1])
    forces = change(of, gearbox_ux=1e-3)
    assert forces[names.index("main bearing ux")] == pytest.approx(push, rel=1e-3)


def test_a_generator_on_its_foundation_stays_where_the_gearbox_leaves_it() -> None:
    of = at(Level.RIGID)
    axes, length = of.machine.axes, of.machine.shafts[-1].length
    behind = axes[-1][0] + length - axes[1][0]
    moved = GearboxOffset(gearbox_uz=1e-3, gearbox_rz=2e-3)
    np.testing.assert_allclose(moved.of_generator(of), [-2e-3 * behind, -1e-3], rtol=1e-9)
    free = running(library_machine("park_2021"), Level.RIGID, 1e6, 1.8)
    assert not moved.of_generator(free).any()


def test_planets_that_travel_leave_the_bearings_of_their_carrier_what_the_offset_puts_on_them() -> (
    None
):
    """Three planets hold a carrier equally stiffly in all directions, wherever they are."""
    of = Prepared(library_machine("nrel_750kw"), RUNGS[1], Rated(3.25e5, 2.31))
    planned = event_of("offset", {"gearbox_uz": 1e-3, "gearbox_ry": 5e-4}).plan(of.of, 1.4, 0.01)
    run = of.event(with_travelling_planets(of.of, planned), 2e-3)
    force = run.samples.of("force of PLC-A")
    assert np.ptp(force) < 0.02 * force.mean()
    pin = run.samples.of("force of stage 1 pin 1 upwind")
    assert np.ptp(pin) > 0.1 * pin.mean()


def test_the_study_shows_what_it_does_to_bearings_and_meshes() -> None:
    found = transient(
        read_drivetrain("nrel_750kw"),
        "offset",
        {"gearbox_uz": 2e-3, "gearbox_ry": 1e-3},
        level="rigid",
        duration=0.4,
        step=2e-3,
    )
    assert found.passed
    rows = {row["force"]: row for row in found.tables["alternating"]}
    assert "and nothing alternates" in found.answer.verdict
    assert abs(rows["force of PLC-A"]["change of the mean [kN]"]) > 1.0
    assert any(name.startswith("force of stage 1 sun-planet") for name in rows)
    assert not any("coupling" in one.name for one in found.assumptions)


def test_an_offset_that_a_determinate_gearbox_follows_changes_nothing_and_says_so() -> None:
    """On one main bearing and a mount that tilts freely: the verdict is no round-off."""
    grc, values = read_drivetrain("grc_750kw"), {"gearbox_uz": 1e-3}
    asked = {"level": "rigid", "duration": 0.4, "step": 2e-3, "damage": None}
    found = transient(grc, "offset", values, **asked)  # type: ignore[arg-type]
    assert found.answer.verdict == (
        "The offset changes no mean force of a bearing or mesh, and nothing alternates."
    )
    assert not any("change of its mean" in one.name for one in found.answer.figures)


def test_what_cannot_be_is_refused() -> None:
    with pytest.raises(InputError, match=r"gearbox_uy of the event is 1 m but must be from -0.05"):
        event_of("offset", {"gearbox_uy": 1.0})
    with pytest.raises(
        InputError, match=r"radial stiffness of the coupling, as in .*, or an offset of the g"
    ):
        event_of("offset", {})
    with pytest.raises(InputError, match="coupling of the event is -1"):
        event_of("offset", {"gearbox_uy": 1e-3, "coupling": -1.0})
    of = running(machine_of(read_drivetrain("nrel_5mw")), Level.RIGID, 3.9e6, 1.2)
    direct = of.machine.model_copy(
        update={"stages": (), "shafts": of.machine.shafts[:1], "bearings": of.machine.bearings[:2]}
    )
    with pytest.raises(InputError, match="has no gearbox"):
        change(running(direct, Level.RIGID, 3.9e6, 1.2), gearbox_uy=1e-3)
