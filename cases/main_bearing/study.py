"""What the main-bearing cases share: their scene and its solution."""

import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from fe_drivetrain.common import Floats, InputError
from fe_drivetrain.drivetrain_file import (
    Scene,
    change_scene,
    coarser_scene,
    library_scene,
)
from fe_drivetrain.elasticity.mesh import Mesh, MeshQuality, quality, write
from fe_drivetrain.elasticity.solve import METHODS
from fe_drivetrain.report.suite import Page, Run
from fe_drivetrain.shafts.fidelity import cached_reaction_errors
from fe_drivetrain.shafts.response import (
    LOADS,
    PLANES,
    Model,
    Response,
    bearing_unit_stiffness,
    build_model,
    cached_response,
    mesh_scene,
    tilt_stiffness,
    without_gearbox,
)

#: Interfaces of a spherical bearing.
SPHERICAL = ("sliding", "averaged", "rigid")

#: Coarsening of the mesh under --quick: factor of the sizes, and elements a turn.
QUICK = (2.0, 8)


@dataclass(frozen=True)
class Solved:
    """A scene with its model and its response to unit loads.

    Attributes
    ----------
    recovered : Mapping[str, Floats]
        (6, 10) error of each reaction, estimated from recovered stresses, where asked for.
    """

    scene: Scene
    model: Model
    response: Response
    quality: MeshQuality
    recovered: Mapping[str, Floats] = field(default_factory=dict)

    @property
    def bearing(self) -> str:
        """Name of the main bearing."""
        return self.scene.bearing_units[0].bearing.name


def scene_of(run: Run, page: Page, kind: str, coarsen: bool = True) -> Scene:
    """The library's scene of a kind with the user's changes.

    Where these make another bearing of it, that is exchanged, and load points are left out; the
    page says so first.

    Parameters
    ----------
    run : Run
        Its settings are the changes.
    page : Page
        Learns what it is about.
    kind : str
        "spherical" or "bonded".
    coarsen : bool
        Whether ``--quick`` coarsens the mesh.

    Raises
    ------
    InputError
        The scene has not exactly one bearing unit, or a nose, which the closed forms do not know.
    """
    given = changed_scene(run, kind)
    if given.load_points:
        page.note(
            f"Without the loads and weights at {', '.join(given.bands)}: this case loads the hub "
            "and the gearbox alone, and a stiffness does not depend on loads."
        )
        given = given.model_copy(update={"load_points": ()})
    scene = with_kind(given, kind)
    (before,), (after,) = given.bearing_units, scene.bearing_units
    if before.interface != after.interface:
        page.note(
            f"Another bearing: {before.bearing.name!r} of the scene is {before.interface}, and "
            f"this case needs a {kind} one. Its figures of a {kind} bearing are of the scene with "
            f"that bearing made {after.interface}, not of the scene as it was given."
        )
    if run.quick and coarsen:
        scene = coarser_scene(scene, *QUICK)
    page.about(scene)
    return scene


def changed_scene(run: Run, kind: str) -> Scene:
    """The library's scene of a kind with the user's changes, refused where closed forms end."""
    changes = {
        key: value
        for key, value in run.settings.items()
        if key.partition(".")[0] in Scene.model_fields
    }
    scene = change_scene(library_scene(f"main_bearing_{kind}"), changes)
    count = len(scene.bearing_units)
    if scene.nose is not None or count != 1:
        has = "a nose" if scene.nose is not None else f"{count} bearing units"
        raise InputError(
            f"scene {scene.title!r} has {has}: the main-bearing cases compare with closed forms "
            "for one bearing unit; run fe-drivetrain study, which takes any scene"
        )
    return scene


def with_kind(scene: Scene, kind: str) -> Scene:
    """The scene with its bearing spherical (sliding joint) or bonded (plain ring)."""
    interface = scene.bearing_units[0].interface
    if interface == kind or (kind == "spherical" and interface in SPHERICAL):
        return scene
    bearing, joint = {"spherical": ("spherical", "sliding"), "bonded": ("ring", "bonded")}[kind]
    unit = "bearing_units.0"
    kinds = {f"{unit}.bearing.kind": bearing, f"{unit}.interface": joint}
    return change_scene(scene, kinds | {f"{unit}.stiffness": None, f"{unit}.rollers": None})


def with_interface(scene: Scene, interface: str) -> Scene:
    """The scene with another form of the spherical joint."""
    return change_scene(scene, {"bearing_units.0.interface": interface})


def solver(run: Run) -> Any:
    """The user's choice of solver."""
    method = run.settings.get("solver", "auto")
    if method not in METHODS:
        raise InputError(f"solver = {method!r}: use one of {', '.join(METHODS)}")
    return method


Meshed = tuple[Mesh, MeshQuality]


def mesh_of(run: Run, scene: Scene, label: str) -> Meshed:
    """Mesh a scene, or take its mesh from the cache; the name of the step says which."""
    with run.step(f"mesh ({label})") as step:
        mesh = mesh_scene(scene)
        mesh_quality = quality(mesh)
        if mesh.kept:
            step.name += ", from the cache"
    return mesh, mesh_quality


def solve_scene(
    run: Run, scene: Scene, label: str, meshed: Meshed | None = None, recovered: bool = False
) -> Solved:
    """Mesh and solve a scene, or take its solution from the cache, timing each step.

    It is assembled where it is solved.

    The operators of the parts, by far the largest of the results, are not kept: what is solved
    side by side travels between processes.

    Parameters
    ----------
    meshed : Meshed or None
        The mesh, where there is one already.
    recovered : bool
        Whether errors of its reactions are estimated, which takes a solution for each support.
    """
    mesh, mesh_quality = mesh_of(run, scene, label) if meshed is None else meshed
    with run.step(f"model ({label})"):
        model = build_model(scene, mesh)
    for warning in model.warnings:
        run.report(f"warning: {label}: {warning}")
    with run.step(f"solve 10 unit loads ({label})") as step:
        response = cached_response(model, solver(run))
        if response.kept:
            step.name += ", from the cache"
    run.report(f"{label}: {response.diagnostics.method}, {response.diagnostics.reason}")
    errors: dict[str, Floats] = {}
    if recovered:
        with run.step(f"errors of reactions from recovered stresses ({label})") as step:
            errors, kept = cached_reaction_errors(model, response)
            if kept:
                step.name += ", from the cache"
    return Solved(scene, replace(model, part_stiffness={}), response, mesh_quality, errors)


def solve_and_write(run: Run, scene: Scene, label: str, meshed: Meshed | None, file: str) -> Solved:
    """`solve_scene`, with errors of reactions, and `write_mesh_files`."""
    solved = solve_scene(run, scene, label, meshed, recovered=True)
    write_mesh_files(run, solved, file)
    return solved


@dataclass(frozen=True)
class Tilt:
    """Stiffness of a bonded bearing unit, measured with the gearbox springs removed.

    Attributes
    ----------
    by_plane : dict[str, dict[str, float]]
        K_R [N m/rad] by plane ("vertical", "horizontal") and estimator.
    matrix : Floats
        (6, 6) condensed stiffness at the bearing's centre.
    free : Solved
        The solution without gearbox springs.
    """

    by_plane: dict[str, dict[str, float]]
    matrix: Floats
    free: Solved

    def both(self, estimator: str) -> tuple[float, float]:
        """K_R of the vertical and of the horizontal plane."""
        return self.by_plane["vertical"][estimator], self.by_plane["horizontal"][estimator]


def solve_tilt(run: Run, scene: Scene, label: str, meshed: Meshed) -> Tilt:
    """K_R of a bonded bearing unit, as the thesis measures it: gearbox springs removed.

    Parameters
    ----------
    scene, meshed : Scene, Meshed
        With its gearbox springs, and its mesh.
    label : str
        Of the solution without them.
    """
    free = solve_scene(run, without_gearbox(scene), label, meshed)
    with warnings.catch_warnings():
        # four nodes against the averaged seat: every page has both, side by side
        warnings.simplefilter("ignore")
        by_plane = {
            plane.name: tilt_stiffness(free.model, free.response, free.bearing, plane)
            for plane in PLANES
        }
    return Tilt(by_plane, bearing_unit_stiffness(free.response, free.bearing), free)


def solve_level(run: Run, scene: Scene, label: str) -> tuple[Solved, Tilt]:
    """A scene solved with and without its gearbox."""
    meshed = mesh_of(run, scene, label)
    solved = solve_scene(run, scene, label, meshed)
    return solved, solve_tilt(run, scene, f"{label}, without gearbox", meshed)


def spread(values: dict[str, float]) -> float:
    """Largest less smallest of several estimates, relative to their median [%]."""
    found = list(values.values())
    return 100.0 * (max(found) - min(found)) / float(np.median(found))


def write_mesh_files(run: Run, solved: Solved, name: str) -> None:
    """The mesh for ParaView (.vtu) and gmsh (.msh), with unit-load displacements."""
    fields = {
        f"displacement {load}": solved.response.displacements[:, :, k]
        for k, load in enumerate(LOADS)
    }
    with run.step("mesh files"):
        write(solved.model.mesh, run.folder / f"{name}.vtu", fields)
        write(solved.model.mesh, run.folder / f"{name}.msh")
