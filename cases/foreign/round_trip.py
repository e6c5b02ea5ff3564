"""A parametric housing written to STEP and mesh files, read back, against itself."""

import gmsh
import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats, max_difference
from fe_drivetrain.drivetrain_file import Scene, change_scene, library_scene
from fe_drivetrain.elasticity.mesh import write
from fe_drivetrain.foreign import mesh_parts, placed_housing
from fe_drivetrain.geometry import Bearing, gmsh_session, unit_solids, write_step
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.shafts.fidelity import UnitBounds, unit_bounds, unit_stiffness

NAME = "main_bearing"
READ_BACK = "Stiffness of the housing read back, against the parametric one"
COARSER, QUICK_COARSER = 1.0, 2.5
SPRING = [1e10, 1e10, 1e10, 1e8, 1e8, 1e8]  # N/m, N m/rad
FROM_STEP = {
    "step": "block.step",
    "seat": {"radius": 300},
    "held": [{"point": [0, 0, -420], "normal": [0, 0, 1]}],
}
PART = f"{NAME}.housing"
PICKS = {
    "block.msh": {
        "part": PART,
        "seat": {"label": f"{PART}.bore"},
        "held": [{"label": f"{PART}.base"}],
    },
    "block.vtu": {
        "part": "part 1",
        "seat": {"radius": 0.3, "axis": [1, 0, 0], "point": [0, 0, 0]},
        "held": [{"point": [0, 0, -0.42], "normal": [0, 0, 1]}],
    },
}


def write_files(run: Run, joint: Scene) -> None:
    """The block as STEP file, with all its faces as splines besides, and as meshes."""
    unit = joint.bearing_units[0]
    with run.step("files"), gmsh_session():
        write_step(run.folder / "block.step", [unit.block.build(unit.bearing).volume])
    with gmsh_session():
        solid = unit.block.build(unit.bearing).volume
        gmsh.model.occ.convertToNURBS([(3, solid)])
        write_step(run.folder / "splines.step", [solid])
    bearing = with_bore(unit.bearing)
    mesh = mesh_parts(None, [unit.model_copy(update={"bearing": bearing})], joint.mesh)
    for name in PICKS:
        write(mesh, run.folder / name)


def check_meshes(run: Run, page: Page, joint: Scene, own: Floats) -> list[Record]:
    """Meshes read back have the stiffness of what was written."""
    rows = []
    for name, picks in PICKS.items():
        with run.step(name):
            data = {"mesh": str(run.folder / name), "unit": "m", **picks}
            read = unit_stiffness(with_housing(joint, data), NAME)
        rows.append(row(name, "6x6 spring", own, read))
        page.vanishes(
            f"{name}: largest difference of stiffness, relative to its diagonal",
            max_difference(read, own),
            within=1e-10,
            why="the same nodes and elements, so that round-off of the solver is all that differs",
            source="the mesh that was written",
        )
    return rows


def check_stiffness(
    page: Page, bounds: UnitBounds, own: Floats, step: UnitBounds, splines: Floats
) -> None:
    """Solids read back have the stiffness of the one that was written, within both meshes."""
    for k, motion in ((2, "along z [GN/m]"), (4, "about y [GN m/rad]")):
        page.equals(
            f"block.step, bonded: K {motion}",
            step.stiff[k, k] / 1e9,
            bounds.stiff[k, k] / 1e9,
            within=(bounds.mesh + step.mesh).bending,
            why="the error of each mesh, as recovered stresses estimate it; its nodes are others, "
            "and the bearing is tied to it instead of sharing nodes",
            source="the same solid, meshed by the program",
            band=step.mesh.bending * step.stiff[k, k] / 1e9,
        )
        page.equals(
            f"splines.step, 6x6 spring: K {motion}",
            splines[k, k] / 1e9,
            own[k, k] / 1e9,
            within=(bounds.mesh + step.mesh).bending,
            why="the error of each mesh of this size, as above; the seat is a cylinder fitted to "
            "splines, which are the same surface",
            source="the same solid, meshed by the program",
        )


@case(
    "A housing read back from STEP and mesh files, against the parametric one",
    source="the parametric housing itself, meshed by the program",
)
def run(run: Run, page: Page) -> None:
    """Write the library's block to files, read them back, and compare stiffness."""
    scene = sized(library_scene("main_bearing_bonded"), QUICK_COARSER if run.quick else COARSER)
    joint = change_scene(
        scene, {"bearing_units.0.interface": "spring", "bearing_units.0.stiffness": SPRING}
    )
    unit = joint.bearing_units[0]
    bearing = with_bore(unit.bearing)
    write_files(run, joint)
    with run.step("parametric"):
        own, bounds = unit_stiffness(joint, NAME), unit_bounds(scene, NAME)
    rows = check_meshes(run, page, joint, own)
    with run.step("STEP"):
        foreign = with_housing(scene, FROM_STEP | {"step": str(run.folder / "block.step")})
        step = unit_bounds(foreign, NAME)
        housing = foreign.bearing_units[0].foreign
        assert housing is not None
        placed = placed_housing(housing, bearing, scene.mesh)
    rows.append(row("block.step", "bonded: tied", bounds.stiff, step.stiff))
    with run.step("STEP, all faces splines"):
        data = FROM_STEP | {"step": str(run.folder / "splines.step")}
        splines = unit_stiffness(with_housing(joint, data), NAME)
    rows.append(row("splines.step", "6x6 spring", own, splines))
    exact = unit_solids(bearing, unit.block, 0.4)[1].volume
    page.equals(
        "block.step: volume of the solid [m^3]",
        placed.facts["volume after healing [m^3]"],
        exact,
        within=1e-9,
        why="STEP keeps 15 digits",
        source="the solid that was written",
    )
    check_stiffness(page, bounds, own, step, splines)
    page.section("Differences")
    page.table("Stiffness read back over that of the parametric housing, less one", rows)
    answer(page, rows, 100 * (bounds.mesh + step.mesh).bending)
    page.image("The block as read from STEP, with its own mesh", run.sketch(placed.mesh))


def answer(page: Page, rows: list[Record], by_mesh: float) -> None:
    """State how far what is read back is from the parametric housing; error of both meshes [%]."""
    meshes, off, splines = (
        100 * max(abs(x) for row in some for x in row.values() if isinstance(x, float))
        for some in (rows[:-2], rows[-2:-1], rows[-1:])
    )
    both = "along z", "about y"
    step, by_splines = (
        [page.judged(f"{name}: K {motion}", f"{file}, {motion}", "parametric") for motion in both]
        for name, file in (
            ("block.step, bonded", "STEP"),
            ("splines.step, 6x6 spring", "STEP of splines"),
        )
    )
    inside = max(off, splines) <= by_mesh
    page.answer(
        "Is a housing that is read back from a file as stiff as the one that was written?",
        f"{'Yes' if inside else 'No'}: read back from STEP, its stiffness differs by "
        f"{off:.2g}\u00a0%, as splines by {splines:.2g}\u00a0%, {'less' if inside else 'more'} "
        f"than the error of the meshes, {by_mesh:.2g}\u00a0%.",
        [
            page.value("largest difference, STEP [%]", off, at_most=by_mesh, by="both meshes"),
            page.value("largest difference, all faces splines [%]", splines, at_most=by_mesh),
            page.value("largest difference, mesh files [%]", meshes),
            *step,
            by_splines[0],
        ],
        hero=READ_BACK,
        cautions=[
            "After STEP the bearing is tied to the housing; before, it shared the housing's nodes."
        ],
    )
    page.errors(READ_BACK, [*step, *by_splines])


def with_bore(bearing: Bearing) -> Bearing:
    """The bearing on a bore of 0.4 m."""
    return bearing.model_copy(update={"bore_diameter": 0.4})


def sized(scene: Scene, coarser: float) -> Scene:
    """The scene on a mesh that is so many times coarser."""
    return scene.model_copy(update={"mesh": scene.mesh.scaled(coarser)})


def with_housing(scene: Scene, housing: Record) -> Scene:
    """The scene with another housing."""
    return change_scene(scene, {"bearing_units.0.housing": housing})


def row(name: str, joint: str, own: Floats, read: Floats) -> Record:
    """Relative differences of the diagonals."""
    change = (np.diag(read) / np.diag(own) - 1.0).tolist()
    motions = ("along x", "along y", "along z", "about x", "about y", "about z")
    return {"file": name, "joint": joint} | dict(zip(motions, change, strict=True))
