"""What the main-bearing cases share: their scene, its solution, and how both are shown."""

import warnings
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from fe_drivetrain.common import FORCES, Floats, InputError
from fe_drivetrain.mesh import Mesh, MeshQuality, quality, write
from fe_drivetrain.report import (
    AssumptionRow,
    Image,
    NoPictureError,
    Section,
    Table,
    Text,
    Verdict,
    judge,
    picture_of_deformation,
    picture_of_model,
)
from fe_drivetrain.response import (
    LOADS,
    PLANES,
    Model,
    Response,
    bearing_unit_stiffness,
    build_model,
    mesh_scene,
    tilt_stiffness,
    unit_load_response,
    without_gearbox,
)
from fe_drivetrain.scene import Scene, change_scene, library_scene, read_scene
from fe_drivetrain.solve import METHODS
from fe_drivetrain.suite import Run

SOURCE = "Stirling 2023, PhD thesis, chapter 3 (sections 3.1 to 3.3, Table 3.1)"

#: Keys of --set that are the case's own; every other key changes the scene.
OWN_KEYS = ("scene", "solver")

ESTIMATORS = ("four nodes", "averaged seat", "energy")

#: Coarsening of the mesh under --quick.
QUICK = 1.5


@dataclass(frozen=True)
class Solved:
    """A scene with its model and its response to unit loads."""

    scene: Scene
    model: Model
    response: Response
    quality: MeshQuality

    @property
    def bearing(self) -> str:
        """Name of the main bearing."""
        return self.scene.bearing_units[0].bearing.name


def scene_of(
    run: Run, kind: str, own_keys: tuple[str, ...] = OWN_KEYS, coarsen: bool = True
) -> Scene:
    """The library's scene, or the user's own, with the user's changes.

    Parameters
    ----------
    kind
        "spherical" or "bonded". A user's scene is made to have that interface.
    own_keys
        Settings that are not changes of the scene.
    coarsen
        Whether ``--quick`` coarsens the mesh.

    Raises
    ------
    InputError
        The scene has not exactly one bearing unit, as the closed forms need.
    """
    changes = {key: value for key, value in run.settings.items() if key not in own_keys}
    if "scene" in run.settings:
        scene = read_scene(str(run.settings["scene"]), changes)
    else:
        scene = change_scene(library_scene(f"main_bearing_{kind}"), changes)
    if len(scene.bearing_units) != 1:
        raise InputError(
            f"scene {scene.title!r} has {len(scene.bearing_units)} bearing units: the "
            "main-bearing cases compare with closed forms for one; give a scene with one"
        )
    if "scene" in run.settings:
        scene = with_kind(scene, kind)
    if run.quick and coarsen:
        scene = scene.model_copy(update={"mesh": scene.mesh.scaled(QUICK)})
    return scene


def with_kind(scene: Scene, kind: str) -> Scene:
    """The scene with its bearing spherical (sliding joint) or bonded (plain ring)."""
    unit = scene.bearing_units[0]
    if kind == "spherical" and unit.interface == "bonded":
        changes = {"bearing.kind": "spherical", "interface": "sliding"}
    elif kind == "bonded" and unit.interface != "bonded":
        changes = {"bearing.kind": "ring", "interface": "bonded"}
    else:
        return scene
    return change_scene(scene, {f"bearing_units.0.{k}": v for k, v in changes.items()})


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


def solve_scene(run: Run, scene: Scene, label: str, meshed: Meshed | None = None) -> Solved:
    """Mesh, assemble and solve a scene, timing each step.

    The operators of the parts, by far the largest of what comes out, are not kept: what is solved
    side by side travels between processes.

    Parameters
    ----------
    meshed
        The mesh, where there is one already.
    """
    mesh, mesh_quality = mesh_of(run, scene, label) if meshed is None else meshed
    with run.step(f"assembly ({label})"):
        model = build_model(scene, mesh)
    for warning in model.warnings:
        run.report(f"warning: {label}: {warning}")
    with run.step(f"solve 10 unit loads ({label})"):
        response = unit_load_response(model, solver(run))
    run.report(f"{label}: {response.method}, {response.reason}")
    return Solved(scene, replace(model, part_stiffness={}), response, mesh_quality)


def solve_and_write(run: Run, scene: Scene, label: str, meshed: Meshed | None, file: str) -> Solved:
    """`solve_scene` and `write_mesh_files`."""
    solved = solve_scene(run, scene, label, meshed)
    write_mesh_files(run, solved, file)
    return solved


@dataclass(frozen=True)
class Tilt:
    """Stiffness of a bonded bearing unit, measured with the gearbox springs removed.

    Attributes
    ----------
    by_plane
        K_R [N m/rad] by plane ("vertical", "horizontal") and estimator.
    matrix
        (6, 6) condensed stiffness at the bearing's centre.
    free
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
    scene, meshed
        With its gearbox springs, and its mesh.
    label
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


def solve_level(run: Run, scene: Scene, label: str) -> tuple[Solved, Tilt, float]:
    """A scene solved with and without its gearbox, and the time that the first took [s]."""
    meshed = mesh_of(run, scene, label)
    before = sum(run.times.values())
    solved = solve_scene(run, scene, label, meshed)
    seconds = sum(run.times.values()) - before
    return solved, solve_tilt(run, scene, f"{label}, without gearbox", meshed), seconds


def spread(values: dict[str, float]) -> float:
    """Largest less smallest of several estimates, relative to their median [%]."""
    found = list(values.values())
    return 100.0 * (max(found) - min(found)) / float(np.median(found))


def tilt_table(tilt: Tilt) -> Table:
    """K_R by plane and estimator beside the thesis's."""
    published = {"vertical": 145.0, "horizontal": 392.0}
    rows: list[list[Any]] = []
    for plane, values in tilt.by_plane.items():
        k = [v / 1e6 for v in values.values()]
        rows.append([plane, *k, spread(values), published[plane]])
    return Table(
        caption="K_R = M / theta of bearing and housing [MN m/rad], gearbox springs removed. The "
        "thesis's figures belong to its own housing, whose dimensions it does not give",
        columns=["plane", *ESTIMATORS, "spread [%]", "Stirling 2023"],
        rows=rows,
    )


def matrix_table(caption: str, matrix: Floats) -> Table:
    """A 6x6 stiffness."""
    names = ("ux", "uy", "uz", "rx", "ry", "rz")
    size = np.sqrt(np.outer(matrix.diagonal(), matrix.diagonal()))
    shown = np.where(np.abs(matrix) < 1e-3 * size, 0.0, matrix)
    return Table(
        caption=caption + " [N/m, N, N m/rad]; terms below 0.1 % of their diagonals shown as 0",
        columns=["", *names],
        rows=[[names[i], *(float(v) for v in shown[i])] for i in range(6)],
    )


def check_verdicts(solved: Solved, label: str) -> list[Verdict]:
    """The two independent checks that every solution carries."""
    source = "exact"
    return [
        judge(
            f"{label}: total equilibrium, applied less reacted",
            solved.response.equilibrium_error,
            0.0,
            tolerance=1e-8,
            relative=False,
            source=source,
            reason="reactions come from the residual on constrained freedoms: solver accuracy",
            measure="identity",
        ),
        judge(
            f"{label}: linearity, a random load solved directly against superposed",
            solved.response.superposition_error,
            0.0,
            tolerance=1e-8,
            relative=False,
            source=source,
            reason="the scene is linear: solver accuracy",
            measure="identity",
        ),
    ]


def mesh_table(solutions: dict[str, Solved]) -> Table:
    """Mesh, solver and diagnostics of each solution."""
    rows: list[list[Any]] = []
    for label, s in solutions.items():
        mesh = s.model.mesh
        rows.append(
            [
                label,
                len(mesh.cells),
                len(mesh.points),
                s.response.n_unknowns,
                s.quality.minimum_scaled_jacobian,
                s.response.method,
                s.response.iterations or None,
                s.response.seconds,
                s.response.residual,
                s.response.energy_error,
                s.response.equilibrium_error,
                s.response.superposition_error,
            ]
        )
    return Table(
        caption="Meshes of curved ten-node tetrahedra, and what ten unit loads took to solve. "
        f"Solver {_choices(solutions)}{_warnings(solutions)}",
        columns=[
            "model",
            "elements",
            "nodes",
            "unknowns",
            "minimum scaled Jacobian",
            "solver",
            "iterations",
            "set-up and solve [s]",
            "relative residual",
            "energy error",
            "equilibrium error",
            "superposition error",
        ],
        rows=rows,
    )


def _choices(solutions: dict[str, Solved]) -> str:
    """Which solver, and why, of each model that gives another reason."""
    reasons: dict[str, str] = {}
    for label, s in solutions.items():
        reasons.setdefault(s.response.reason, label)
    return "; ".join(f"({label}): {reason}" for reason, label in reasons.items())


def _warnings(solutions: dict[str, Solved]) -> str:
    """What the models warn of, each once, with the first model that does."""
    found: dict[str, str] = {}
    for label, s in solutions.items():
        for warning in s.model.warnings:
            found.setdefault(warning, label)
    return "".join(f". Warning ({label}): {warning}" for warning, label in found.items())


def reaction_table(caption: str, reaction: Floats) -> Table:
    """A (6, 10) reaction matrix; what is nothing but the mesh's asymmetry is shown as zero."""
    size = np.abs(reaction).max(axis=0)
    # A column may hold nothing but round-off: the bearing feels no torque, no gearbox weight.
    shown = np.where(np.abs(reaction) < np.maximum(1e-4 * size, 1e-6), 0.0, reaction)
    return Table(
        caption=f"{caption}. Below 0.01 % of their column's largest, or 1e-6, entries show as 0",
        columns=["reaction", *(f"{c} [per {_unit(c)}]" for c in LOADS)],
        rows=[
            [f"{c} [{'N' if c[0] == 'F' else 'N m'}]", *(float(v) for v in shown[i])]
            for i, c in enumerate(FORCES)
        ],
    )


def _unit(load: str) -> str:
    if load.startswith("gravity"):
        return "m/s²"
    return "N m" if load.startswith("hub.M") else "N"


def picture_section(run: Run, solved: Solved, loads: Floats, what: str) -> Section:
    """Pictures of the model and of its deformed shape; says why where there is none.

    Parameters
    ----------
    loads
        (10,) load factors of the deformed shape.
    what
        The loads in words.
    """
    items: list[Any] = []
    with run.step("pictures"):
        try:
            picture_of_model(solved.model, run.folder / "model.png")
            factor = picture_of_deformation(
                solved.model, solved.response, loads, run.folder / "deformed.png"
            )
        except NoPictureError as reason:
            items.append(Text(text=f"No picture: {reason}"))
        else:
            items += [
                Image(
                    caption=f"{solved.scene.title}: parts, loads and supports",
                    file="model.png",
                ),
                Image(
                    caption=f"Deformed {factor:,.0f} times too large, under {what}",
                    file="deformed.png",
                ),
            ]
    return Section(title="Model", items=items)


def write_mesh_files(run: Run, solved: Solved, name: str) -> None:
    """The mesh for ParaView (.vtu) and gmsh (.msh), with unit-load displacements."""
    fields = {
        f"displacement {load}": solved.response.displacements[:, :, k]
        for k, load in enumerate(LOADS)
    }
    with run.step("mesh files"):
        write(solved.model.mesh, run.folder / f"{name}.vtu", fields)
        write(solved.model.mesh, run.folder / f"{name}.msh")


def assumptions(scene: Scene) -> list[AssumptionRow]:
    """Everything that the thesis does not give."""
    unit = scene.bearing_units[0]
    torque = scene.gearbox.stiffness[3]
    base = {
        "fixed": "the whole underside of the housing is fixed, as in the thesis",
        "bolted": "four washer footprints are fixed; in the thesis the whole underside",
    }[unit.housing.base]
    rows: list[tuple[Any, ...]] = [
        (
            "gearbox torque reaction",
            torque if torque == "rigid" else float(torque),
            "" if torque == "rigid" else "N m/rad",
            "a spherical joint lets the shaft spin, so the gearbox must react torque; the thesis "
            "names three translational springs only",
        ),
        (
            "coupling of hub and gearbox",
            f"{scene.hub.coupling}, {scene.gearbox.coupling}",
            "",
            "averaged: loads and springs act on the mean motion of the shaft's end face (RBE3)",
        ),
        ("bedplate", "rigid", "", base),
        ("clearance, friction, damping", "none", "", "as in the thesis: quasi-static, linear"),
    ]
    for unit in scene.bearing_units:
        name = unit.bearing.name
        for owner, part in ((name, unit.bearing), (f"{name}.housing", unit.housing)):
            rows += [
                (f"{owner}: {row[0]}", *row[1:])
                for row in part.assumptions()
                if unit.housing.base == "bolted" or not row[0].startswith(("bolt_", "washer_"))
            ]
    for name in _parts(scene):
        material = scene.material_of(name)
        own = material in scene.materials.values()
        rows.append(
            (
                f"{name}: E, nu, density",
                f"{material.youngs_modulus / 1e9:g} GPa, {material.poisson_ratio:g}, "
                f"{material.density:g} kg/m³",
                "",
                "given by the scene" if own else "assumed: the thesis names no material",
            )
        )
    return [AssumptionRow(name=n, value=v, unit=u, source=s) for n, v, u, s in rows]


def _parts(scene: Scene) -> list[str]:
    names = [unit.bearing.name for unit in scene.bearing_units]
    return ["shaft", *names, *(f"{name}.housing" for name in names)]
