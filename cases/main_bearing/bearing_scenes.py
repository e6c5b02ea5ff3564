"""Scenes of the main-bearing cases, the user's changes in them, and how they are solved."""

from typing import Any

from fe_drivetrain.common import InputError
from fe_drivetrain.drivetrain_file import Scene, change_scene, library_scene
from fe_drivetrain.elasticity.mesh import Mesh, write
from fe_drivetrain.elasticity.solve import METHODS
from fe_drivetrain.report.suite import Page, Run
from fe_drivetrain.report.suite.chosen import SETTING
from fe_drivetrain.shafts.response import LOADS
from fe_drivetrain.studies.scene_description import quick_scene
from fe_drivetrain.studies.seat_stiffness import SeatStiffness, seat_stiffness
from fe_drivetrain.studies.solved_assembly import Assembly, solved_assembly, timed_mesh

#: Interfaces of a spherical bearing.
SPHERICAL = ("sliding", "averaged", "rigid")


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
        scene = quick_scene(scene)
    page.about(scene)
    if SETTING in run.settings:
        page.subject = scene.title
    return scene


def is_changed(run: Run) -> bool:
    """Whether the user has another scene than the thesis's, to which its numbers do not apply."""
    own = {SETTING, *Scene.model_fields}
    return any(key.partition(".")[0] in own for key in run.settings)


def changed_scene(run: Run, kind: str) -> Scene:
    """The library's scene of a kind, or that of the user, with the user's changes.

    Raises
    ------
    InputError
        The closed forms do not know it, or it has no shaft of sections.
    """
    changes = {
        key: value
        for key, value in run.settings.items()
        if key.partition(".")[0] in Scene.model_fields
    }
    default = library_scene(f"main_bearing_{kind}")
    given = run.drivetrain(default).drivetrain if SETTING in run.settings else default
    if not isinstance(given, Scene):
        raise InputError(
            f"drivetrain {given.title!r} does not state shaft.sections and bearing_units, which "
            "the main-bearing cases solve: give these, or run fe-drivetrain modes"
        )
    scene = change_scene(given, changes)
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


def solve(
    run: Run, scene: Scene, label: str, mesh: Mesh | None = None, with_errors: bool = False
) -> Assembly:
    """The assembly of a scene, solved as the study solves it, with the user's choice of solver."""
    return solved_assembly(run, scene, label, mesh, solver(run), with_errors)


def solve_and_write(run: Run, scene: Scene, label: str, mesh: Mesh | None, file: str) -> Assembly:
    """`solve`, with errors of reactions, and `write_mesh_files`."""
    solved = solve(run, scene, label, mesh, with_errors=True)
    write_mesh_files(run, solved, file)
    return solved


def solve_seat(run: Run, scene: Scene, label: str, mesh: Mesh | None = None) -> SeatStiffness:
    """K_R as the study measures it at the seat, with the user's choice of solver."""
    return seat_stiffness(run, scene, label, mesh, solver(run))


def solve_both(run: Run, scene: Scene, label: str) -> tuple[Assembly, SeatStiffness]:
    """A scene solved with and without its gearbox, on one mesh."""
    mesh = timed_mesh(run, scene, label)
    return (
        solve(run, scene, label, mesh),
        solve_seat(run, scene, f"{label}, without gearbox", mesh),
    )


def write_mesh_files(run: Run, solved: Assembly, name: str) -> None:
    """The mesh for ParaView (.vtu) and gmsh (.msh), with unit-load displacements."""
    fields = {
        f"displacement {load}": solved.response.displacements[:, :, k]
        for k, load in enumerate(LOADS)
    }
    with run.step("mesh files"):
        write(solved.model.mesh, run.folder / f"{name}.vtu", fields)
        write(solved.model.mesh, run.folder / f"{name}.msh")
