"""Spherical joint of a main bearing: forces through its centre, and no moment about it."""

import numpy as np

from fe_drivetrain.beam import main_bearing_beam, pinned_model
from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats
from fe_drivetrain.mesh import Mesh
from fe_drivetrain.report import trace
from fe_drivetrain.response import (
    LOADS,
    Model,
    Response,
    build_model,
    cached_response,
    mesh_scene,
)
from fe_drivetrain.scene import Scene, change_scene, library_scene
from fe_drivetrain.suite import Page, Record, Run, column

#: Forms of the spherical joint, and a bonded bearing beside them, with their colours.
COLOURS = {"sliding": "#0072b2", "averaged": "#009e73", "rigid": "#d55e00", "bonded": "#1f2933"}

#: Coarsening of the library's mesh: forces are exact on any mesh.
FACTOR, QUICK_FACTOR = 3.0, 4.0

HUB = [LOADS.index(load) for load in LOADS if load.startswith("hub")]
#: Gravity along x is no load of a drivetrain, and its lever arm is the mesh's asymmetry.
JUDGED = [k for k, load in enumerate(LOADS) if load != "gravity.x"]

#: Why a check allows only round-off, and its source.
SPHERE = (
    "each form passes its forces on through the centre exactly: round-off of a direct solver, of "
    "nodal forces of some 1 N",
    "a sphere without friction carries no moment",
)
DETERMINATE = (
    "the shaft is determinate: round-off of a direct solver, relative to the largest reaction to "
    "each load",
    "Stirling 2023, Eq 3.1, for hub loads and gearbox weight; moment balance about the gearbox for "
    "self-weight",
)
MOMENT, DISTANCE = "largest moment [N m]", "largest distance [m]"
#: Axis of the force through the joint, and load, of the table.
SHARES = {
    "Fy per Fy [N/N]": (1, "hub.Fy"),
    "Fz per Fz [N/N]": (2, "hub.Fz"),
    "Fz per My [N/N m]": (2, "hub.My"),
}


def scene_of(form: str, factor: float) -> Scene:
    """The library's main bearing with an interface of that form, on a coarse mesh."""
    scene = library_scene(f"main_bearing_{'bonded' if form == 'bonded' else 'spherical'}")
    sizes = scene.mesh.scaled(factor, 8)
    scene = scene.model_copy(update={"mesh": sizes})
    return scene if form == "bonded" else change_scene(scene, {"bearing_units.0.interface": form})


def statics(model: Model) -> Floats:
    """(2, 10): Fy and Fz at the bearing by statics; gravity along x is left out.

    Self-weight by the moments of shaft and bearing about the gearbox, and the housing's own weight.
    """
    exact = np.zeros((6, len(LOADS)))
    exact[:, :6] = pinned_model(np.eye(6), main_bearing_beam(model.scene)).T
    name = model.scene.bearing_units[0].bearing.name
    gearbox, bearing = (model.points[key].position[0] for key in ("gearbox", f"{name}.seat"))
    turning = model.part_mass["shaft"] + model.part_mass[name]
    lever = float(turning @ (gearbox - model.mesh.points[:, 0])) / (gearbox - bearing)
    for axis in (1, 2):
        exact[axis, 6 + axis] = lever + model.part_mass[f"{name}.housing"].sum()
    # the gearbox's weight stands on its own springs
    return exact[1:3]


def difference(reaction: Floats, exact: Floats) -> float:
    """Largest difference of Fy and Fz, relative to the largest of a load, or to 1 N."""
    apart = np.abs(reaction[1:3] - exact)[:, JUDGED].max(axis=0)
    return float((apart / np.maximum(1.0, np.abs(exact)[:, JUDGED].max(axis=0))).max())


@case(
    "Spherical joint of a main bearing: no moment about its centre, reactions by statics",
    source="Stirling 2023, PhD thesis, section 3.1 (Eq 3.1) and section 3.2 (DSRB: three forces, "
    "rotation free)",
)
def run(run: Run, page: Page) -> None:
    """Solve the three forms, and a bonded bearing beside them."""
    meshes: dict[bool, Mesh] = {}
    rows: list[Record] = []
    moments: dict[str, Floats] = {}
    for form in COLOURS:
        bonded = form == "bonded"
        scene = scene_of(form, QUICK_FACTOR if run.quick else FACTOR)
        if bonded not in meshes:
            with run.step(f"mesh ({'bonded' if bonded else 'spherical'})"):
                meshes[bonded] = mesh_scene(scene)
        with run.step(f"ten unit loads ({form})"):
            model = build_model(scene, meshes[bonded])
            # a direct solver: nothing but round-off is to be seen
            response = cached_response(model, "superlu")
        joint = response.reactions[f"{scene.bearing_units[0].bearing.name}.outer"]
        moments[form] = np.linalg.norm(joint[3:], axis=0)
        if bonded:
            held = float(np.abs(joint[4, LOADS.index("hub.My")]))
        else:
            rows.append(check(page, form, model, response))
    page.answer(
        "All three forms of the spherical joint carry forces through the centre and nothing else: "
        f"at most {max(column(rows, MOMENT)):.1e} N m over the unit hub loads, where a bonded "
        f"bearing takes {held:.2f} N m of 1 N m at the hub.",
        "Reactions are those of statics (Eq 3.1) to round-off, and say nothing about the mesh.",
    )
    page.section("What the joint carries")
    points = [
        trace(form, [], np.maximum(of, 1e-18), True, marker={"color": COLOURS[form], "size": 9})
        | {"x": list(LOADS)}
        for form, of in moments.items()
    ]
    title = "Moment that the interface carries about the joint's centre"
    page.chart(title, points, "unit load", "moment [N m]", "y")
    title = "Force through the joint for unit hub loads, its moment, and the distance of its line "
    page.table(f"{title}from the centre", rows)
    page.text(
        "Sliding: each pair of nodes passes a force along its normal, and all normals meet in the "
        "centre. Averaged: one force, spread over each face with weights whose centroid is the "
        "centre. Rigid: two rigid spheres that share their centre's displacement. The chart shows "
        "no point below 1e-18 N m."
    )
    mesh = meshes[False]
    page.text(
        f"Mesh: {len(mesh.cells):,} curved ten-node tetrahedra, {len(mesh.points):,} nodes. "
        "Bonded, for comparison, on a mesh of its own."
    )
    for form, of in moments.items():
        page.data(form, {"moments": of})


def check(page: Page, form: str, model: Model, response: Response) -> Record:
    """Moments, lines of force and reactions of one form; its row of the table."""
    bearing = model.scene.bearing_units[0].bearing
    joint, base = (response.reactions[name] for name in (f"{bearing.name}.outer", bearing.name))
    moment, size = np.linalg.norm(joint[3:], axis=0), np.linalg.norm(joint[:3], axis=0)
    worst = float(moment[HUB].max())
    loaded = size > 1e-6
    distance = float((moment[loaded] / size[loaded]).max())
    apart = np.abs((base - joint)[:, HUB]).max() / np.abs(joint[:, HUB]).max()
    for what, computed, why, source in (
        ("moment about the joint's centre, largest of six unit hub loads [N m]", worst, *SPHERE),
        (
            "distance of the line of the force from the joint's centre, over the joint's radius",
            distance / (0.5 * bearing.raceway_diameter),
            "as for the moment",
            "a force that carries no moment about a point passes through it",
        ),
        (
            "radial reactions of unit hub loads, self-weight and gearbox weight against statics",
            difference(base, statics(model)),
            *DETERMINATE,
        ),
        (
            "joint and base of the housing carry the same force and moment, hub loads",
            float(apart),
            "round-off of a direct solver",
            "equilibrium of the housing, on which no load acts in between",
        ),
    ):
        page.vanishes(f"{form}: {what}", computed, within=1e-9, why=why, source=source)
    shares = {name: float(joint[c, LOADS.index(load)]) for name, (c, load) in SHARES.items()}
    return {"form": form, **shares, MOMENT: worst, DISTANCE: distance}
