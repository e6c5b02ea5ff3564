"""The assembly of solids of a scene and what unit loads do to it, each step timed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.steps import Clock
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.elasticity.mesh.mesh import Mesh
from fe_drivetrain.shafts.fidelity.assembly_bands import cached_reaction_errors
from fe_drivetrain.shafts.response.cached import cached_response
from fe_drivetrain.shafts.response.model import Model, build_model, mesh_scene
from fe_drivetrain.shafts.response.unit_loads import Response


@dataclass(frozen=True, eq=False)
class Assembly:
    """The assembly of solids of a scene, solved for unit loads.

    Attributes
    ----------
    model : Model
        The assembled model, without the operators of its parts, by far the largest of it.
    response : Response
        What unit loads do to it.
    errors : Mapping[str, Floats]
        (6, 10) error of each reaction to unit loads, estimated from recovered stresses; empty
        where they were not asked for.
    """

    model: Model
    response: Response
    errors: Mapping[str, Floats] = field(default_factory=dict)

    @property
    def scene(self) -> Scene:
        """The scene that was solved."""
        return self.model.scene

    @property
    def bearing(self) -> str:
        """Name of the first main bearing."""
        return self.scene.bearing_units[0].bearing.name


def timed_mesh(steps: Clock, scene: Scene, label: str = "") -> Mesh:
    """The mesh of a scene, made or taken from the cache; the name of the step says which.

    Parameters
    ----------
    steps : Clock
        Times the step.
    scene : Scene
        The scene.
    label : str
        Added to the name of the step in brackets, where several scenes are meshed.

    Raises
    ------
    InputError
        The scene cannot be meshed.
    """
    with steps.step(f"mesh{_of(label)}") as step:
        mesh = mesh_scene(scene)
        if mesh.kept:
            step.name += _KEPT
    return mesh


def checked_model(steps: Clock, scene: Scene, label: str = "", mesh: Mesh | None = None) -> Model:
    """The assembled model of a scene, with all that is checked of a scene before any level.

    Parameters
    ----------
    steps : Clock
        Times its two steps, and reports what the model warns of.
    scene : Scene
        The scene.
    label : str
        Added to the names of the steps in brackets, where several scenes are built.
    mesh : Mesh, optional
        The mesh, where there is one already.

    Raises
    ------
    InputError
        The scene cannot be built, or is a mechanism; see
        `fe_drivetrain.shafts.response.build_model`.
    """
    mesh = timed_mesh(steps, scene, label) if mesh is None else mesh
    with steps.step(f"assembly{_of(label)}"):
        model = build_model(scene, mesh)
    for warning in model.warnings:  # before what takes long
        steps.report(f"warning: {label}: {warning}" if label else f"warning: {warning}")
    return model


def solved_assembly(
    steps: Clock,
    scene: Scene,
    label: str = "",
    mesh: Mesh | None = None,
    method: str = "auto",
    with_errors: bool = False,
) -> Assembly:
    """Mesh, assemble and solve a scene for unit loads, or take from the cache what was solved.

    Parameters
    ----------
    steps : Clock
        Times each step.
    scene : Scene
        The scene.
    label : str
        Added to the names of the steps in brackets, where several scenes are solved.
    mesh : Mesh, optional
        The mesh, where there is one already.
    method : str
        Solver, see `fe_drivetrain.elasticity.solve.solve`.
    with_errors : bool
        Whether errors of its reactions are estimated, which takes a solution for each support.

    Raises
    ------
    InputError
        The scene cannot be built, or is a mechanism.
    """
    model = checked_model(steps, scene, label, mesh)
    return solved_model(steps, model, label, method, with_errors)


def solved_model(
    steps: Clock,
    model: Model,
    label: str = "",
    method: str = "auto",
    with_errors: bool = False,
) -> Assembly:
    """Solve a model that is assembled for unit loads, or take its solution from the cache.

    Parameters
    ----------
    steps : Clock
        Times each step.
    model : Model
        The model, with the operators of its parts.
    label : str
        Added to the names of the steps in brackets.
    method : str
        Solver, see `solved_assembly`.
    with_errors : bool
        Whether errors of its reactions are estimated.
    """
    with steps.step(f"assembly of solids{_of(label)}") as step:
        response = cached_response(model, method)
        if response.kept:
            step.name += _KEPT
    errors: dict[str, Floats] = {}
    if with_errors:
        with steps.step(f"errors of reactions from recovered stresses{_of(label)}") as step:
            errors, kept = cached_reaction_errors(model, response)
            if kept:
                step.name += _KEPT
    return Assembly(replace(model, part_stiffness={}), response, errors)


_KEPT = ", from the cache"


def _of(label: str) -> str:
    return f" ({label})" if label else ""
