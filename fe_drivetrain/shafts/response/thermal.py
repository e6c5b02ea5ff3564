"""A scene at the temperatures that it states, each part of one: the assembly of solids."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.elasticity.operator import kernels
from fe_drivetrain.elasticity.operator.loads import thermal_loads
from fe_drivetrain.shafts.response.model import Model
from fe_drivetrain.shafts.response.part_forces import part_forces
from fe_drivetrain.shafts.response.prepared import prepared
from fe_drivetrain.shafts.response.unit_loads import reactions_by_part


@dataclass(frozen=True, eq=False)
class ThermalState:
    """What temperatures do to a drivetrain that nothing else loads.

    Attributes
    ----------
    reactions : Mapping[str, Floats]
        (6,) by bearing, and "gearbox": what the drivetrain puts on its support [N, N m].
    motions : Mapping[str, Floats]
        (6,) by reference point: "hub", "gearbox", "NAME.seat" [m, rad].
    seats : Mapping[str, float]
        Mean radial growth of the shaft's seat by bearing [m].
    """

    reactions: Mapping[str, Floats]
    motions: Mapping[str, Floats]
    seats: Mapping[str, float]

    __repr__ = short_repr

    @property
    def imbalance(self) -> float:
        """Sum of all reactions over the largest of them; they are in equilibrium."""
        forces = np.array([one[:3] for one in self.reactions.values()])
        largest = np.abs(forces).max()
        return float(np.abs(forces.sum(axis=0)).max() / largest) if largest else 0.0


def part_thermal_loads(model: Model) -> dict[str, Floats]:
    """Nodal forces (n_dofs, 1) of the temperature of each part [N].

    Parameters
    ----------
    model : Model
        The model; its scene states temperatures.
    """
    mesh, scene, found = model.mesh, model.scene, {}
    for part in mesh.part_names:
        free = np.full(len(mesh.points), scene.free_strain(part))
        cells = mesh.cells[mesh.part_cells(part)]
        loads = thermal_loads(mesh.points, cells, scene.material_of(part).lame, free, model.n_dofs)
        found[part] = loads[:, None]
    return found


def thermal_state(model: Model, method: str = "auto") -> ThermalState:
    """Solve the assembly for its temperatures alone.

    Parameters
    ----------
    model : Model
        The model; its scene states temperatures.
    method : str
        Solver, see `fe_drivetrain.elasticity.solve.solvers.solve`.

    Raises
    ------
    InputError
        The system is singular, see `fe_drivetrain.elasticity.solve.solvers.factorise`.
    """
    by_part = part_thermal_loads(model)
    F = np.sum(list(by_part.values()), axis=0)
    ready = prepared(model, method, len(model.loads))
    U, _ = ready.solve(F)
    internal = kernels.product(ready.stiffness, U)
    multipliers = ready.elimination.multipliers(internal - F)
    forces = part_forces(model, U, internal)
    on_parts = {part: of - by_part.get(part, 0.0) for part, of in forces.items()}
    cases = np.zeros((len(model.loads), 1))
    reactions = reactions_by_part(model, multipliers, on_parts, U, cases)
    names = (*model.scene.bearing_names, "gearbox")
    return ThermalState(
        {name: reactions[name][:, 0] for name in names},
        {name: (point.motion @ U)[:, 0] for name, point in model.points.items()},
        {
            unit.bearing.name: _growth(model, unit.bearing.name, U)
            for unit in model.scene.bearing_units
        },
    )


def _growth(model: Model, name: str, U: Floats) -> float:
    """Mean radial displacement of the shaft's seat [m]."""
    mesh = model.mesh
    nodes = mesh.face_nodes(f"shaft.seat.{name}")
    u = U[: mesh.points.size, 0].reshape(-1, 3)[nodes]
    across = mesh.points[nodes, 1:] / np.linalg.norm(mesh.points[nodes, 1:], axis=1)[:, None]
    moved = u[:, 1:] - u[:, 1:].mean(axis=0)
    return float((moved * across).sum(axis=1).mean())
