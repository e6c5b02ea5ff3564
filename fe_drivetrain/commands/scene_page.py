"""What a scene is, on a page: its parts, bearings and supports, its picture, and what it costs."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from fe_drivetrain.commands.named_bearings import named_bearings
from fe_drivetrain.commands.unused import catalogues_not_used
from fe_drivetrain.common.components import MOTIONS
from fe_drivetrain.fidelity.level_costs import forecast
from fe_drivetrain.geometry import FurtherPart
from fe_drivetrain.report.pictures import NoPictureError, picture_of_model
from fe_drivetrain.report.pictures.model import with_prefix
from fe_drivetrain.response.model import Model, build_model, mesh_scene
from fe_drivetrain.scene.bearing_unit import SPHERICAL_JOINTS, BearingUnit, Springs
from fe_drivetrain.scene.left_out import left_out
from fe_drivetrain.scene.nose import NoseBearing
from fe_drivetrain.scene.scene import Scene, coarser_scene
from fe_drivetrain.suite.page import Page
from fe_drivetrain.suite.records import Record
from fe_drivetrain.suite.run import Run

#: Coarsening of the mesh under --quick: factor of the sizes, and elements a turn.
_QUICK = (2.0, 8)

_UNITS = (*3 * ("N/m",), *3 * ("N m/rad",))


def quick_scene(scene: Scene) -> Scene:
    """The scene on a coarser mesh, for a first look."""
    return coarser_scene(scene, *_QUICK)


def checked_model(run: Run, scene: Scene) -> Model:
    """The assembled model of a scene, with all that is checked of a scene before any level.

    Parameters
    ----------
    run : Run
        The run that this is two steps of.
    scene : Scene
        The scene.

    Raises
    ------
    InputError
        The scene cannot be built, or is a mechanism; see `fe_drivetrain.response.build_model`.
    """
    with run.step("mesh"):
        mesh = mesh_scene(scene)
    with run.step("assembly"):
        return build_model(scene, mesh)


def picture(run: Run, page: Page, model: Model) -> None:
    """Draw the model; where nothing can be drawn, say why.

    Parameters
    ----------
    run : Run
        Its folder takes the picture.
    page : Page
        Shows it.
    model : Model
        The model.
    """
    with run.step("picture"):
        try:
            picture_of_model(model, run.folder / "model.png")
        except NoPictureError as reason:
            page.text(f"No picture: {reason}")
            return
    page.image(f"{model.scene.title}: parts, loads and supports", "model.png")


def describe(page: Page, model: Model) -> None:
    """Tables of the parts, bearings and supports of a scene, and what it leaves out.

    Parameters
    ----------
    page : Page
        Takes them.
    model : Model
        The model, meshed, so that masses are those of what is solved.
    """
    scene = model.scene
    page.about(scene)
    page.assume_all(left_out(scene))
    parts: list[Record] = [
        {
            "part": part,
            "material": scene.material_name(part),
            "E [GPa]": scene.material_of(part).youngs_modulus / 1e9,
            "density [kg/m³]": scene.material_of(part).density,
            "mass [kg]": float(mass.sum()),
            "size": _size(scene, part),
        }
        for part, mass in model.part_mass.items()
    ]
    page.table("Parts; masses are those of the mesh", parts)
    if scene.bearing_units:
        page.table(
            "Bearings" + _of_torque(scene),
            [_bearing_row(unit) for unit in scene.bearing_units],
        )
    if scene.nose is not None:
        page.table(
            "Bearings between the shaft and its nose: springs between the mean motions of both "
            "faces",
            [_nose_bearing_row(scene, bearing) for bearing in scene.nose_bearings],
        )
    points: list[Record] = [
        {
            "point": "hub (front face), where the hub loads act",
            "x [m]": scene.shaft.front,
            "coupling": scene.hub.coupling,
            "weight [N]": None,
            "held by": "nothing",
        },
        {
            "point": "gearbox (rear face)",
            "x [m]": scene.shaft.rear,
            "coupling": scene.gearbox.coupling,
            "weight [N]": scene.gearbox.weight,
            "held by": _springs(scene.gearbox.stiffness),
        },
    ]
    points[1:1] = [
        {
            "point": f"{point.name} (over {point.width:g} m)",
            "x [m]": point.x,
            "coupling": "averaged",
            "weight [N]": point.weight,
            "held by": "nothing",
        }
        for point in scene.load_points
    ]
    if scene.loads_at != scene.shaft.front:
        points.insert(
            1,
            {
                "point": "what hub loads of files are about (hub.loads_at), moved to the hub",
                "x [m]": scene.loads_at,
                "coupling": None,
                "weight [N]": None,
                "held by": "nothing",
            },
        )
    page.table("Where loads enter the shaft", points)
    page.text(
        "Frame: x downwind along the shaft, z up, y = z cross x. Lengths in m, forces in N, "
        "moments in N m, angles in rad."
    )


def _size(scene: Scene, part: str) -> str:
    if part in ("shaft", "nose"):
        shaft = scene.shaft if scene.nose is None or part == "shaft" else scene.nose.body
        widest = max(max(piece.outer_diameter, piece.end_diameter) for piece in shaft.pieces)
        bores = {piece.inner_diameter for piece in shaft.pieces} - {0.0}
        bored = f", bore {_range(bores)} m" if bores else ", no bore"
        return (
            f"{shaft.length:g} m long, {len(shaft.sections)} "
            f"section{'s' if len(shaft.sections) > 1 else ''}"
            f"{' and a flange' if shaft.flange else ''}, up to {widest:g} m wide{bored}"
        )
    name, _, housing = part.partition(".")
    unit = scene.bearing_unit(name)
    solid = unit.housing_parts.get(part)
    if isinstance(solid, FurtherPart):
        onto = ", ".join(dict.fromkeys(tie.to for tie in solid.tied))
        held = ", held" if solid.held else ""
        return f"from {Path(solid.file).name}, tied to {onto}{held}"
    if housing and unit.foreign is not None:
        return f"from {Path(unit.foreign.file).name}, {unit.foreign.held_by}"
    if housing:
        return (
            f"axis {unit.block.centre_height:g} m over its base, wall {unit.block.wall:g} m, "
            f"base {unit.block.base}"
        )
    return f"{unit.bearing.width:g} m wide, raceway {unit.bearing.raceway_diameter:g} m"


def _range(values: set[float]) -> str:
    low, high = min(values), max(values)
    return f"{low:g}" if low == high else f"{low:g} to {high:g}"


def _of_torque(scene: Scene) -> str:
    """Which bearings take hub torque that goes on to the gearbox where a bearing turns."""
    bonded = [u.bearing.name for u in scene.bearing_units if u.interface == "bonded"]
    if not bonded:
        return ""
    return (
        f"; {' and '.join(bonded)}: bonded, so held against turning, too, with hub torque in the "
        "housing as far as that is stiffer there than the gearbox. Where torque or "
        "hub.stiffness.rx counts, take the interface rollers, or spring with 0 about x"
    )


def _bearing_row(unit: BearingUnit) -> Record:
    return {
        "bearing": unit.bearing.name,
        "x [m]": unit.bearing.x,
        "interface": unit.interface,
        "carries moments": "no: spherical joint"
        if unit.interface in SPHERICAL_JOINTS
        else "yes"
        if unit.interface == "bonded"
        else "as its stiffness says",
        "stands on": "the ground" if unit.bedplate is None else _springs(unit.bedplate),
        "rolling bearing": unit.catalogue,
    }


def _nose_bearing_row(scene: Scene, bearing: NoseBearing) -> Record:
    assert scene.nose is not None
    return {
        "bearing": bearing.name,
        "x [m]": bearing.x,
        "width [m]": bearing.width,
        "diameter on the nose [m]": 2 * scene.nose.body.outer_radius(bearing.x),
        "diameter in the shaft [m]": 2 * scene.shaft.inner_radius(bearing.x),
        "holds": _springs(bearing.stiffness),
    }


def _springs(stiffness: Springs) -> str:
    """Springs in words, those that are 0 left out."""
    found = [
        f"{motion} {k}" if k == "rigid" else f"{motion} {with_prefix(k, unit)}"
        for motion, k, unit in zip(MOTIONS, stiffness, _UNITS, strict=True)
        if k != 0
    ]
    return ", ".join(found) or "nothing"


def cost_table(page: Page, model: Model) -> None:
    """What each level of the ladder takes on this machine.

    Parameters
    ----------
    page : Page
        Takes the table.
    model : Model
        The model.
    """
    rows: list[Record] = [
        {
            "level": f"{found.level} {found.title}",
            "unknowns": found.unknowns,
            "time [s]": float(f"{found.seconds:.2g}"),
            "memory [MiB]": None if found.bytes is None else float(f"{found.bytes / 2**20:.2g}"),
            "how known": f"predicted, solver {found.solver}"
            + ("" if found.fits else ": more memory than is free")
            if found.solver
            else "it was run",
        }
        for found in forecast(model)
    ]
    page.table("What each level costs: unknowns of its largest system, time, memory", rows)
    page.text(
        "Predicted times are those of the solver, fitted on two cores, without mesh and assembly, "
        "whose times stand below; a mesh comes from the cache the next time. "
        + (
            "Housings as springs are solved for two bounds, all bearing units; the shaft on them "
            "was run. "
            if model.scene.bearing_units
            else "The bearings on the nose have no solids: as far as the mesh is the same, the "
            "assembly (4) answers as solid shaft and solid nose (3) do. "
        )
        + "advise solves coarser meshes, too, for the band of the assembly."
    )
    page.data("levels", rows)


def checked(run: Run, page: Page, scene: Scene, catalogues: Sequence[Path] = ()) -> None:
    """Validate a scene, describe it, draw it, and say what it costs.

    Parameters
    ----------
    run : Run
        The run.
    page : Page
        Takes the tables and the picture.
    scene : Scene
        The scene.
    catalogues : Sequence[Path]
        Bearing catalogues of the user, beside the program's own.

    Raises
    ------
    InputError
        See `named_bearings` and `checked_model`.
    """
    named = named_bearings(scene, catalogues, {})
    misfits = [one.misfit for one in named.values()]
    for unused in catalogues_not_used(catalogues, {name: one.name for name, one in named.items()}):
        page.note(unused)
    model = checked_model(run, scene)
    mass = float(model.mass.sum())
    count = len(scene.bearing_names)
    on_nose = (
        ""
        if scene.nose is None
        else " round a nose"
        if not scene.bearing_units
        else (", some of them on a nose")
    )
    page.seed = None
    page.answer(
        f"{scene.title}: a shaft of {scene.shaft.length:g} m on {count} "
        f"bearing{'s' if count > 1 else ''}{on_nose}, {mass:,.0f} kg in all, "
        f"{model.n_dofs:,} degrees of freedom; it is held, and can be solved.",
        *model.warnings,
        *filter(None, misfits),
    )
    page.section("Scene")
    picture(run, page, model)
    describe(page, model)
    page.section("Cost")
    with run.step("levels"):
        cost_table(page, model)
