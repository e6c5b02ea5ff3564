"""A short main bearing on gearbox springs of any stiffness, solved as the program does."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from fe_drivetrain.common import Floats, InputError
from fe_drivetrain.drivetrain_file import Scene, change_scene, library_scene
from fe_drivetrain.elasticity.interfaces import (
    Elimination,
    WeakMotion,
    eliminate,
    refuse_mechanisms,
    warn_of_weak_restraints,
    weak_restraints,
)
from fe_drivetrain.elasticity.mesh import Mesh
from fe_drivetrain.elasticity.solve import reduce, solve
from fe_drivetrain.shafts.response import LOADS, Model, build_model

#: A short shaft in a coarse mesh: statics are the same on any mesh.
CHANGES = {
    "mesh.elements_per_turn": 8,
    "mesh.shaft": 0.4,
    "mesh.bearing": 0.2,
    "mesh.housing": 0.25,
    "mesh.bearing_edge": 0.2,
    "shaft.front": -1.0,
    "shaft.sections.0.length": 2.2,
}


def scene_of(kind: str, joint: str | None = None, rigid: Sequence[int] = (3,)) -> Scene:
    """The library's scene of a main bearing on a short shaft, with gearbox springs of 1e8.

    Parameters
    ----------
    kind : str
        "spherical" or "bonded".
    joint : str, optional
        Form of the spherical joint.
    rigid : sequence of int
        Components 0-5 of the gearbox that are held rigidly instead.

    Returns
    -------
    scene : Scene
    """
    stiffness = ["rigid" if c in rigid else 1e8 for c in range(6)]
    changes: dict[str, object] = {**CHANGES, "gearbox.stiffness": stiffness}
    if joint is not None:
        changes["bearing_units.0.interface"] = joint
    return change_scene(library_scene(f"main_bearing_{kind}"), changes)


@dataclass(frozen=True)
class Motion:
    """Motions under unit loads, one a column.

    Attributes
    ----------
    hub, gearbox : (6, n_loads) array
        Displacements [m] and rotations [rad].
    energy_error, residual : float
        Energy error and residual of the solver.
    method : str
        That solved in the end.
    """

    hub: Floats
    gearbox: Floats
    energy_error: float
    residual: float
    method: str


@dataclass(frozen=True)
class Sprung:
    """A model whose gearbox springs can be changed without assembling it again."""

    model: Model

    @cached_property
    def elimination(self) -> Elimination:
        """Elimination of all constraints; springs are not among them."""
        return eliminate(self.model.constraints, self.model.n_dofs)

    @cached_property
    def moduli(self) -> dict[str, float]:
        """Young's modulus of each part [Pa]."""
        scene = self.model.scene
        return {part: scene.material_of(part).youngs_modulus for part in self.model.mesh.part_names}

    def with_springs(self, stiffness: Sequence[float]) -> Model:
        """The model with other springs at the gearbox [N/m, N m/rad]; zeros are none."""
        k = np.diag(np.asarray(stiffness, dtype=float))
        springs = ((self.model.points["gearbox"], k),) if k.any() else ()
        return replace(self.model, springs=springs)

    def warnings_and_refusal(self, stiffness: Sequence[float]) -> tuple[tuple[str, ...], str]:
        """What the program reports before it solves.

        Parameters
        ----------
        stiffness : sequence of 6 floats
            Stiffness of the gearbox springs [N/m, N m/rad].

        Returns
        -------
        warnings : tuple of str
            Warnings of motions that are hardly restrained.
        refusal : str
            Why it refuses to solve; empty if it does not.
        """
        model = self.with_springs(stiffness)
        parts = model.mesh, model.constraints, model.springs
        try:
            refuse_mechanisms(*parts)
            return warn_of_weak_restraints(*parts, self.moduli), ""
        except InputError as error:
            return (), str(error)

    def weakest(self, stiffness: Sequence[float]) -> list[WeakMotion]:
        """All motions without strain that springs restrain, the weakest first."""
        model = self.with_springs(stiffness)
        return weak_restraints(
            model.mesh, model.constraints, model.springs, self.moduli, float("inf")
        )

    def solve(
        self, stiffness: Sequence[float], loads: Sequence[str], method: str = "auto"
    ) -> Motion | None:
        """Motions under some of the unit loads; None where the solver refuses.

        Parameters
        ----------
        stiffness : sequence of 6 floats
            Stiffness of the gearbox springs [N/m, N m/rad].
        loads : sequence of str
            Names of `fe_drivetrain.shafts.response.LOADS`.
        method : str
            Solver.

        Returns
        -------
        motion : Motion or None
        """
        model = self.with_springs(stiffness)
        F = model.unit_loads()[:, [LOADS.index(load) for load in loads]]
        system = reduce(model.mesh.points, model.mesh.cells, model.stiffness, self.elimination)
        try:
            found = solve(system, self.elimination.T.T @ F, method)
        except InputError:
            return None
        U = self.elimination.T @ found.x
        hub, gearbox = (model.points[name].motion @ U for name in ("hub", "gearbox"))
        return Motion(
            hub,
            gearbox,
            found.diagnostics.energy_error,
            found.diagnostics.residual,
            found.diagnostics.method,
        )


def sprung(scene: Scene, mesh: Mesh) -> Sprung:
    """Assemble a scene."""
    return Sprung(build_model(scene, mesh))
