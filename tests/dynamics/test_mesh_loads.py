"""Loads of meshes by superposition, against the equilibrium of the whole system."""

import numpy as np
import pytest

from fe_drivetrain.dynamics import (
    Level,
    library_machine,
    machine_system,
    mesh_springs,
    static,
    steady_load,
)
from fe_drivetrain.dynamics.bodies.mesh_loads import MeshResponses

TORQUE = 4e6


@pytest.mark.parametrize("share", [1.0, 0.2])
def test_superposed_forces_are_those_of_the_equilibrium_with_contacts(share: float) -> None:
    """Under a moment on the hub some slices are apart, of which `static` finds the same."""
    machine, hub = library_machine("nrel_5mw"), np.array([0.0, 0.0, 0.0, 0.0, 2e6, 0.0])
    system = machine_system(machine, Level.RIGID, 0.0, held_generator=True)
    slices = [name for name in system.spring_names if " slice " in name]
    whole = static(system, steady_load(machine, system, share * TORQUE, hub), contacts=slices)
    forces = dict(zip(whole.system.spring_names, whole.forces, strict=True))
    found = MeshResponses(machine, Level.RIGID, 1, 5).under(share * TORQUE, hub)
    largest = max(abs(forces[name]) for name in slices)
    for mesh, springs in mesh_springs(machine).items():
        expected = [[forces[f"{s} slice {k}"] for k in range(1, 6)] for s in springs]
        assert found.slices[mesh][0] == pytest.approx(np.array(expected), abs=1e-9 * largest)
    apart = sum(int((found.slices[mesh] == 0.0).sum()) for mesh in found.slices)
    assert apart > 0


def test_no_slice_pulls_and_the_torque_is_carried() -> None:
    machine = library_machine("nrel_5mw")
    found = MeshResponses(machine, Level.FLEXIBLE, 3, 5).under(TORQUE, (0, 0, 0, 0, 3e6, 1e6))
    for mesh, forces in found.slices.items():
        assert forces.min() >= 0.0, mesh
    sums = {mesh: forces.sum(axis=(1, 2)) for mesh, forces in found.slices.items()}
    first, meshing = machine.stages[0], machine.stages[0].meshes[0]
    radius = first.sun_radius * np.cos(meshing.pressure_angle)
    expected = TORQUE / first.speed_ratio / radius
    assert sums["stage 1 sun-planet"] == pytest.approx(expected, rel=1e-6)
