"""All that turns as a script of ROSS: what ROSS assembles is what this project's modes solve."""

import runpy
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from scipy.linalg import eigh
from small_drivetrain import two_mass_file

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file import parse_drivetrain, read_drivetrain
from fe_drivetrain.dynamics import Level, machine_of, machine_system
from fe_drivetrain.export.programs.ross_rotor import FROM_PROJECT
from fe_drivetrain.export.turning import turning_of
from fe_drivetrain.export.turning_files import write_turning
from fe_drivetrain.export.turning_lines import Beam, turning_lines

GEARED = "nrel_750kw"


def hertz(stiffness: Floats, mass: Floats) -> Floats:
    squares = eigh(stiffness, mass, eigvals_only=True)
    return np.asarray(np.sqrt(np.maximum(squares, 0.0)) / (2.0 * np.pi))


@pytest.fixture(scope="module")
def in_ross(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., dict[str, Any]]:
    """What the script of a drivetrain at a level defines, in ROSS."""

    def run(name: str, level: Level, held: bool = False) -> dict[str, Any]:
        path = tmp_path_factory.mktemp("ross") / "rotor.py"
        write_turning(path, turning_of(read_drivetrain(name), level, held), "ross")
        return runpy.run_path(str(path))

    return run


@pytest.mark.parametrize("name", ["nrel_5mw", GEARED])
def test_stages_carry_what_the_system_carries(name: str) -> None:
    """A torque on the rotor, the generator held, winds up lines and stages as it does the whole."""
    machine = machine_of(read_drivetrain(name))
    lines, couplings = turning_lines(machine, Level.TORSIONAL)
    assert [one.number for one in couplings] == [1, 2, 3]
    whole = machine_system(machine, Level.TORSIONAL, held_generator=True)
    load = whole.load_on("rotor", np.eye(6)[3])
    exact = float(load @ np.linalg.solve(whole.K, load))
    twist, ratio = 0.0, 1.0
    for k, line in enumerate(lines):
        piece = line.pieces[-1]
        assert not isinstance(piece, Beam)
        twist += ratio**2 / piece.stiffness[3, 3]
        if k < len(couplings):
            turns = couplings[k].stiffness[3::6, 3::6]
            # a torque on what drives, with what is driven held
            twist += ratio**2 * np.linalg.inv(turns[:-1, :-1])[0, 0]
            ratio /= machine.speeds[k + 1] / machine.speeds[k]
    assert twist == pytest.approx(exact, rel=1e-9)


def test_planets_roll_between_carrier_and_sun_without_a_force() -> None:
    machine = machine_of(read_drivetrain(GEARED))
    stage, (lines, (first, *_)) = machine.stages[0], turning_lines(machine, Level.FLEXIBLE)
    assert lines[1].planets == stage.planets
    place, rolling = stage.centre_distance, np.zeros((stage.planets + 2, 6))
    spin = [body.speed for body in lines[1].bodies[: stage.planets]]
    rolling[:, 3] = 1.0, *spin, stage.speed_ratio
    for k, body in enumerate(lines[1].bodies[: stage.planets], start=1):
        _, y, z = body.position
        assert np.hypot(y, z) == pytest.approx(place)
        rolling[k, 1:3] = -z, y
    forces = np.abs(first.stiffness) @ np.abs(rolling.ravel())
    assert np.abs(first.stiffness @ rolling.ravel()).max() < 1e-12 * forces.max()
    assert not first.mass.any()


def test_rigid_bodies_are_refused(tmp_path: Path) -> None:
    turning = turning_of(read_drivetrain(GEARED), Level.RIGID)
    with pytest.raises(InputError, match="the shafts of ROSS bend: take 'flexible'"):
        write_turning(tmp_path / "rotor.py", turning, "ross")
    assert not list(tmp_path.iterdir())


def test_the_head_states_what_is_left_out(tmp_path: Path) -> None:
    drivetrain = parse_drivetrain(yaml.safe_dump(two_mass_file()))
    path = tmp_path / "rotor.py"
    write_turning(path, turning_of(drivetrain, Level.TORSIONAL), "ross")
    head = " ".join(path.read_text().split("import numpy")[0].replace("#", " ").split())
    for said in (
        "left out: dampers",
        "ROSS has no planetary stage",
        "held: all motions of a node but",
    ):
        assert said in head
    compile(path.read_text(), str(path), "exec")


@pytest.mark.needs("ross")
def test_ross_finds_the_torsional_frequencies(in_ross: Callable[..., dict[str, Any]]) -> None:
    turning = turning_of(read_drivetrain("nrel_5mw"), Level.TORSIONAL)
    own = hertz(turning.stiffness, turning.mass)
    made = in_ross("nrel_5mw", Level.TORSIONAL)
    found = made["frequencies"](made["build"]())
    # the free turn is round-off of a zero; an eigenvalue keeps 1e-16 of the largest
    for frequency in own[1:]:
        within = 1e-9 + 1e-15 * (found[-1] / frequency) ** 2
        assert np.abs(found / frequency - 1.0).min() < within


@pytest.mark.needs("ross")
def test_ross_deflects_as_the_system_does(in_ross: Callable[..., dict[str, Any]]) -> None:
    """Statics are exact for stepped beams; what is held gives by 1e-4 of what gives beside it."""
    machine = machine_of(read_drivetrain("nrel_5mw"))
    system = machine_system(machine, Level.FLEXIBLE, held_generator=True)
    whole = in_ross("nrel_5mw", Level.FLEXIBLE, True)["build"]()
    lines, _ = turning_lines(machine, Level.FLEXIBLE)
    nodes = {}
    for line in lines:
        for body in line.bodies:
            nodes.setdefault(body.name, len(nodes))
    assert len(nodes) == len(whole.nodes)
    K, back = np.asarray(whole.K(0.0)), np.argsort(FROM_PROJECT)
    wrench = np.array([1e5, 2e5, -3e5, 1e6, 2e6, -1e6])
    for at in ("rotor", "stage 2 carrier", "stage 3 pinion"):
        load = np.zeros(len(K))
        load[6 * nodes[at] : 6 * nodes[at] + 6] = wrench[list(FROM_PROJECT)]
        moved = np.linalg.solve(K, load).reshape(-1, 6)[:, back]
        exact = np.linalg.solve(system.K, system.load_on(at, wrench))
        for name in ("rotor", "stage 1 planet 2", "stage 1 sun", "stage 3 pinion"):
            want = system.motion_of(name, exact)
            np.testing.assert_allclose(
                moved[nodes[name]], want, rtol=1e-3, atol=1e-5 * np.abs(want).max()
            )


@pytest.mark.needs("ross")
def test_ross_finds_the_frequencies_of_flexible_shafts(
    in_ross: Callable[..., dict[str, Any]],
) -> None:
    """Its beams have their mass along them, ours at nodes."""
    turning = turning_of(read_drivetrain(GEARED), Level.FLEXIBLE)
    own = hertz(turning.stiffness, turning.mass)
    made = in_ross(GEARED, Level.FLEXIBLE)
    whole = made["build"]()
    found = made["frequencies"](whole)
    np.testing.assert_allclose(found[:4], own[:4], rtol=1e-6)
    np.testing.assert_allclose(found[:20], own[:20], rtol=1e-4)
    # a rotor's tilt about y drives one about z by its polar inertia, and as this project has it
    place = turning.names.index("rotor ry"), turning.names.index("rotor rz")
    assert whole.G()[3, 4] == pytest.approx(turning.gyroscopic[place], rel=1e-3)
