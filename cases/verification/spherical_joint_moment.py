"""Spherical joint of a main bearing: forces through its centre, and no moment about it."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats
from fe_drivetrain.mesh import Mesh
from fe_drivetrain.report import trace
from fe_drivetrain.response import LOADS, build_model, mesh_scene
from fe_drivetrain.suite import Page, Record, Run, Target, column
from fe_drivetrain.validation.determinate_bearings import Carried, carried, coarse_bearing

#: Forms of the spherical joint, and a bonded bearing beside them, with their colours.
COLOURS = {"sliding": "#0072b2", "averaged": "#009e73", "rigid": "#d55e00", "bonded": "#1f2933"}

#: Coarsening of the library's mesh: forces are exact on any mesh.
FACTOR, QUICK_FACTOR = 3.0, 4.0

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
        scene = coarse_bearing(form, QUICK_FACTOR if run.quick else FACTOR)
        if bonded not in meshes:
            with run.step(f"mesh ({'bonded' if bonded else 'spherical'})"):
                meshes[bonded] = mesh_scene(scene)
        with run.step(f"ten unit loads ({form})"):
            # a direct solver: nothing but round-off is to be seen
            found = carried(build_model(scene, meshes[bonded]), "superlu")
        moments[form] = found.moments
        if bonded:
            held = float(np.abs(found.joint[4, LOADS.index("hub.My")]))
        else:
            rows.append(check(page, form, found))
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


def check(page: Page, form: str, found: Carried) -> Record:
    """Moments, lines of force and reactions of one form; its row of the table."""
    worst = found.largest_moment
    for what, computed, why, source in (
        ("moment about the joint's centre, largest of six unit hub loads [N m]", worst, *SPHERE),
        (
            "distance of the line of the force from the joint's centre, over the joint's radius",
            found.distance / found.radius,
            "as for the moment",
            "a force that carries no moment about a point passes through it",
        ),
        (
            "radial reactions of unit hub loads, self-weight and gearbox weight against statics",
            found.from_statics,
            *DETERMINATE,
        ),
        (
            "joint and base of the housing carry the same force and moment, hub loads",
            found.apart,
            "round-off of a direct solver",
            "equilibrium of the housing, on which no load acts in between",
        ),
    ):
        page.meets(computed, Target(what, 0.0, 1e-9, why, source), of=form)
    shares = {name: float(found.joint[c, LOADS.index(load)]) for name, (c, load) in SHARES.items()}
    return {"form": form, **shares, MOMENT: worst, DISTANCE: found.distance}
