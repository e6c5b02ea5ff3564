"""Spherical joint of a main bearing: forces through its centre, and no moment about it."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification.determinate_bearings import carried, coarse_bearing
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import formatted, value_text
from fe_drivetrain.report.suite import Page, Record, Run, Target, column
from fe_drivetrain.shafts.response import LOADS, build_model, mesh_scene

FORMS = "sliding", "averaged", "rigid", "bonded"  # of the joint, the last one for comparison
FACTOR, QUICK_FACTOR = 3.0, 4.0  # coarser than the library's mesh: forces are exact on any mesh

#: What vanishes, why only round-off is allowed, and the source.
CHECKS = {
    "moment about the joint's centre, largest of six unit hub loads [N m]": (
        "each form passes its forces on through the centre exactly: round-off of a direct solver, "
        "of nodal forces of some 1 N",
        "a sphere without friction carries no moment",
    ),
    "distance of the line of the force from the joint's centre, over the joint's radius": (
        "as for the moment",
        "a force that carries no moment about a point passes through it",
    ),
    "radial reactions of unit hub loads, self-weight and gearbox weight against statics": (
        "the shaft is determinate: round-off of a direct solver, relative to the largest reaction "
        "to each load",
        "Stirling 2023, Eq 3.1, for hub loads and gearbox weight; moment balance about the gearbox "
        "for self-weight",
    ),
    "joint and base of the housing carry the same force and moment, hub loads": (
        "round-off of a direct solver",
        "equilibrium of the housing, on which no load acts in between",
    ),
}
CARRIED = "Moment that the interface carries about the joint's centre"
WITHIN = 1e-9  # of an error that is round-off
NM = "N\u00a0m"
MOMENT, DISTANCE, MY = "largest moment [N m]", "largest distance [m]", LOADS.index("hub.My")
#: Axis of the force through the joint, and load, of the table.
SHARES = {
    "Fy per Fy [N/N]": (1, LOADS.index("hub.Fy")),
    "Fz per Fz [N/N]": (2, LOADS.index("hub.Fz")),
    "Fz per My [N/N m]": (2, MY),
}


def answer(page: Page, rows: list[Record], from_statics: float, bonded: float) -> None:
    """State the moment of a spherical and of a bonded bearing.

    Parameters
    ----------
    page : Page
        Where it stands.
    rows : list of dict
        By form of the spherical joint.
    from_statics : float
        Largest difference of the reactions from statics, relative.
    bonded : float
        What a bonded bearing takes of 1 N m about y at the hub [N m].
    """
    moment = max(column(rows, MOMENT))
    page.answer(
        "Does a spherical main bearing carry a moment, and are its reactions those of statics?",
        f"{'No' if moment <= WITHIN else 'Yes'}: under 1\u00a0N\u00a0m at the hub a spherical "
        f"joint carries at most {value_text(moment, NM)}, a bonded one {value_text(bonded, NM)}; "
        f"reactions agree with statics within {formatted(from_statics, 2, '')}.",
        [
            page.value(
                "largest moment of a spherical joint, unit hub loads [N m]",
                moment,
                at_most=WITHIN,
                by="no friction",
            ),
            page.value("moment of a bonded bearing, 1 N m at the hub [N m]", bonded),
            page.value(
                "largest difference of reactions from statics",
                from_statics,
                at_most=WITHIN,
                by="Eq 3.1",
            ),
            page.value(
                "largest distance of the force's line from the centre [m]",
                max(column(rows, DISTANCE)),
            ),
        ],
        hero=CARRIED,
    )


@case(
    "Spherical joint of a main bearing: no moment about its centre, reactions by statics",
    source="Stirling 2023, PhD thesis, section 3.1 (Eq 3.1) and section 3.2 (DSRB: three forces, "
    "rotation free)",
)
def run(run: Run, page: Page) -> None:
    """Solve the three forms, and a bonded bearing beside them."""
    rows, points, apart = [], [], []
    for form in FORMS:
        scene = coarse_bearing(form, QUICK_FACTOR if run.quick else FACTOR)
        if form in ("sliding", "bonded"):  # the others have the mesh of the first
            mesh = run.timed(f"mesh ({form})", mesh_scene, scene)
        with run.step(f"ten unit loads ({form})"):
            # a direct solver: nothing but round-off is to be seen
            found = carried(build_model(scene, mesh), "superlu")
        page.data(form, {"moments": found.moments})
        shown = trace(form, [], np.maximum(found.moments, 1e-18), True, marker={"size": 9})
        points.append(shown | {"x": list(LOADS)})
        if form == "bonded":
            continue
        spherical, worst = mesh, found.max_moment
        apart.append(found.from_statics)
        values = worst, found.distance / found.radius, found.from_statics, found.apart
        for value, (what, reason) in zip(values, CHECKS.items(), strict=True):
            page.meets(value, Target(what, 0.0, WITHIN, *reason), of=form)
        shares = {name: float(found.joint[where]) for name, where in SHARES.items()}
        rows.append({"form": form, **shares, MOMENT: worst, DISTANCE: found.distance})
    answer(page, rows, max(apart), abs(float(found.joint[4, MY])))
    page.say("Reactions are those of statics (Eq 3.1), and say nothing about the mesh.")
    page.section("What the joint carries")
    page.image("Shaft, bearing and housing, as meshed here", run.sketch(spherical))
    page.chart(CARRIED, points, "unit load", "moment [N m]", "y")
    title = "Force through the joint for unit hub loads, its moment, and the distance of its line "
    page.table(f"{title}from the centre", rows)
    page.text(
        "Sliding: each pair of nodes passes a force along its normal, and all normals meet in the "
        "centre. Averaged: one force, spread over each face with weights whose centroid is the "
        "centre. Rigid: two rigid spheres that share their centre's displacement. The chart shows "
        f"no point below 1e-18 N m. Mesh: {len(spherical.cells):,} curved ten-node tetrahedra, "
        f"{len(spherical.points):,} nodes; the bonded bearing, for comparison, has its own."
    )
