"""Interface loads of drivetrains that move, and of levels of the ladder."""

import csv
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from test_procedure_interfaces import PLACES

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.reading import library_scene
from fe_drivetrain.dynamics.time.superposition import exact_steps
from fe_drivetrain.procedure import moving
from fe_drivetrain.procedure.interface_loads import (
    LoadTable,
    analysed,
    check_equilibrium,
    read_load_json,
    write_load_csv,
    write_load_json,
)
from fe_drivetrain.procedure.levels import level_loads
from fe_drivetrain.procedure.moving import Mounts, moving_energy_error, moving_three_points
from fe_drivetrain.procedure.three_points import three_point_loads
from fe_drivetrain.shafts.fidelity.ladder import shaft_level, statics_level

MOUNTS = Mounts(
    bearing=(3e9, 3e9, 3e9),
    entrance=(2e9, 2e9, 2e9, 1e8, 1e8),
    arm=(2e6, 1e7, 4e7),
    supports=(1e8, 1e8, 1e8, 1e8, 1e8),
    torsion=4e3,
    grid=2.8e4,
    shaft=(3e3, 5e3),
    gearbox=(8e3, 9e3),
    generator=(60.0, 3e3),
    seconds=2e-3,
)
MEAN = np.array([250e3, 5e4, -400e3, 800e3, 1e5, 2e5])


@pytest.fixture(scope="module")
def table() -> LoadTable:
    time = np.arange(400) * 0.005
    wave = np.sin(2.0 * np.pi * time)[:, None] * [0.1, -0.5, 0.2, 0.3, 1.0, -0.7]
    return moving_three_points(PLACES, MOUNTS, time, MEAN * (1.0 + wave))


@pytest.mark.parametrize("ratio", [95.0, -95.0])
def test_at_rest_on_determinate_supports_they_are_those_of_statics(ratio: float) -> None:
    places = replace(PLACES, ratio=ratio)
    time, hub = np.arange(5) * 0.1, np.tile(MEAN, (5, 1))
    found = moving_three_points(places, replace(MOUNTS, arm=(0.0, 1e7, 4e7)), time, hub)
    static = three_point_loads(places, time, hub)
    for one, two in zip(found.interfaces, static.interfaces, strict=True):
        assert np.abs(one.loads - two.loads).max() < 1e-8 * np.abs(hub).max(), one.name


def test_bodies_that_move_are_in_equilibrium_with_their_inertia(table: LoadTable) -> None:
    check_equilibrium(table)
    bare = tuple(replace(body, own=body.own[0]) for body in table.bodies)
    with pytest.raises(InputError, match="not in equilibrium"):
        check_equilibrium(replace(table, bodies=bare))


def test_accelerations_are_those_of_the_displacements(table: LoadTable) -> None:
    step = table.time[1] - table.time[0]
    for part in table.interfaces:
        assert part.displacements is not None
        assert part.accelerations is not None
        second = np.diff(part.displacements, 2, axis=0) / step**2
        late = slice(200, None)  # what the start sets moving has died out
        size = np.abs(part.accelerations[late]).max()
        assert np.abs(second[199:] - part.accelerations[200:-1]).max() < 0.02 * size, part.name


def test_the_housing_takes_the_difference_of_the_torques(table: LoadTable) -> None:
    entrance = table.interface("gearbox entrance").loads[:, 3]
    output = table.interface("high-speed shaft").loads[:, 3]
    assert entrance == pytest.approx(-PLACES.ratio * output)
    arms = sum(
        np.cross(part.position, part.loads[:, :3])[:, 0]
        for part in table.interfaces
        if part.name.endswith("arm")
    )
    gearbox = next(body for body in table.bodies if body.name == "gearbox")
    lateral = np.cross(gearbox.centre, gearbox.own[:, :3])[:, 0] + gearbox.own[:, 3]
    output_forces = entrance + output + arms + lateral
    assert np.abs(output_forces).max() < 1e-9 * np.abs(entrance).max()


def test_twice_the_loads_without_weight_are_twice_the_motion(table: LoadTable) -> None:
    hub = table.interface("hub").loads
    one, two = (
        moving_three_points(PLACES, MOUNTS, table.time, factor * hub, weight=False)
        for factor in (1.0, 2.0)
    )
    for a, b in zip(one.interfaces, two.interfaces, strict=True):
        assert a.displacements is not None
        assert b.displacements is not None
        assert b.displacements == pytest.approx(2.0 * a.displacements, rel=1e-9, abs=1e-15)


def test_motions_are_exported_and_analysed(table: LoadTable, tmp_path: Path) -> None:
    rows = analysed(table)
    assert len(rows) == 7 * 18
    hub = {row["component"]: row for row in rows if row["interface"] == "hub"}
    assert hub["uz"]["unit"] == "m"
    assert hub["alpha_x"]["unit"] == "rad/s^2"
    assert sum(hub["Fz"]["cycles"]) > 1.0
    assert sum(hub["uz"]["seconds"]) == pytest.approx(2.0)
    write_load_csv(table, tmp_path / "a.csv")
    with (tmp_path / "a.csv").open() as file:
        head, first, *_ = csv.reader(file)
    assert head[1:8] == [f"hub F{x} [N]" for x in "xyz"] + [f"hub M{x} [N m]" for x in "xyz"] + [
        "hub ux [m]"
    ]
    assert head[13] == "hub ax [m/s^2]"
    motions = table.interface("hub").displacements
    assert motions is not None
    assert float(first[7]) == motions[0, 0]
    write_load_json(table, tmp_path / "a.json")
    back = read_load_json(tmp_path / "a.json").interface("left arm").accelerations
    assert back is not None
    assert (back == table.interface("left arm").accelerations).all()


def test_a_level_is_in_equilibrium_and_moves_as_its_compliance_says() -> None:
    scene = library_scene("three_point_suspension")
    model = shaft_level(scene, 1)
    time = np.arange(50) * 0.1
    hub = np.outer(1.0 + time**2, MEAN)
    found = level_loads(scene, model, time, hub)
    check_equilibrium(found)
    part = found.interface("hub")
    assert part.displacements is not None
    assert part.accelerations is not None
    C = np.linalg.inv(model.stiffness(["hub"]))
    assert part.displacements == pytest.approx(hub @ C.T, rel=1e-6)
    # of loads that go with the square of time
    assert part.accelerations[10] == pytest.approx(2.0 * C @ MEAN, rel=1e-6)
    assert {i.name for i in found.interfaces} == {"hub", "main bearing", "gearbox entrance"}
    with pytest.raises(InputError, match="no displacements"):
        level_loads(scene, statics_level(scene), time, hub)


def waves(step: float) -> tuple[Floats, Floats]:
    time = np.arange(round(1.0 / step) + 1) * step
    return time, MEAN * (1.0 + np.sin(2.0 * np.pi * time)[:, None] * [0.1, -0.5, 0.2, 0.3, 1, -0.7])


def test_energy_of_the_motion_is_the_work_of_hub_and_weights(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    errors = [moving_energy_error(PLACES, MOUNTS, *waves(step)) for step in (4e-3, 2e-3, 1e-3)]
    assert errors[2] < 1e-6
    assert errors[0] / errors[1] > 8.0
    assert errors[1] / errors[2] > 8.0

    def slower(*given: Any) -> tuple[Floats, Floats, Floats]:
        t, q, v = exact_steps(*given)
        return t, q, 0.99 * v

    monkeypatch.setattr(moving, "exact_steps", slower)
    assert moving_energy_error(PLACES, MOUNTS, *waves(1e-3)) > 100.0 * errors[2]


def test_what_cannot_move_is_refused() -> None:
    time, hub = np.arange(5) * 0.1, np.tile(MEAN, (5, 1))
    with pytest.raises(InputError, match="masses"):
        moving_three_points(replace(PLACES, shaft_mass=0.0), MOUNTS, time, hub)
    with pytest.raises(InputError, match="inertias"):
        replace(MOUNTS, shaft=(0.0, 1.0))
