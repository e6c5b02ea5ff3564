"""Spherical main bearing (DSRB): determinate forces, and what tells the joint's forms apart.

A spherical joint makes the shaft determinate: reactions follow from statics and say nothing about
the FE model. Deflection, slope and stiffness do; three forms of the joint show how much it matters.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.main_bearing import bands, bearing_scenes, shown
from fe_drivetrain.common import (
    GRAVITY,
    Floats,
)
from fe_drivetrain.drivetrain_file import Scene
from fe_drivetrain.export import stiffness_matrix, write_stiffness_json
from fe_drivetrain.report import Image, Solid, Text, drawing_ready, trace
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.shafts.beam import beam_of_scene, main_bearing_beam, shaft
from fe_drivetrain.shafts.response import (
    LOADS,
    bearing_unit_stiffness,
)
from fe_drivetrain.studies import Assembly, LinearModel
from fe_drivetrain.studies.closed_forms import PINNED, closed_form_models
from fe_drivetrain.studies.solved_assembly import timed_mesh
from fe_drivetrain.turbine_loads.hub_loads import PointLoads

FORMS = ("sliding", "averaged", "rigid")

#: Beams by whether the ring is a section of the shaft.
BEAMS = {False: "beam, bare shaft", True: "beam, ring as shaft"}
HERO = "Vertical deflection of the shaft's axis under Fz = 1 kN at the hub"
SPREAD, BARE_ERROR = "spread of the forms [%]", "bare beam against sliding [%]"


@dataclass(frozen=True, eq=False)
class Worked:
    """The three forms of the joint solved, coarser meshes of one, and the beams beside it.

    Attributes
    ----------
    solved : dict[str, Assembly]
        By form.
    series : bands.Series
        Figures of the sliding form by mesh.
    pictures : sequence of Image, Solid or Text
        Pictures of the model.
    pinned : LinearModel
        The pinned beam.
    """

    solved: dict[str, Assembly]
    series: bands.Series
    pictures: Sequence[Image | Solid | Text]
    pinned: LinearModel

    @property
    def main(self) -> Assembly:
        """The sliding form."""
        return self.solved[FORMS[0]]

    @cached_property
    def unit(self) -> dict[str, Floats]:
        """(6, 6) stiffness of the bearing unit, by form."""
        name = self.main.bearing
        return {f: bearing_unit_stiffness(s.response, name) for f, s in self.solved.items()}

    @cached_property
    def stations(self) -> Floats:
        """(60,) places along the shaft [m]."""
        shaft_of = self.main.scene.shaft
        return np.linspace(shaft_of.front, shaft_of.rear, 60)

    @cached_property
    def motion_of_beam(self) -> dict[bool, list[Floats]]:
        """Motions of both beams at the stations, at the hub and at the bearing."""
        scene = self.main.scene
        ends = [scene.shaft.front, scene.bearing_units[0].bearing.x]
        at = np.concatenate([self.stations, ends])
        return beam_motions(self.main, self.unit[FORMS[0]], at)

    @cached_property
    def rows(self) -> list[Record]:
        """Deflection and slope, FE and beams."""
        return deflections(self.solved, self.motion_of_beam, self.series)


def beam_motions(main: Assembly, stiffness: Floats, at: Floats) -> dict[bool, list[Floats]]:
    """Motions of both beams at stations, under a vertical force of 1 kN and a moment of 1 kN m."""
    scene = main.scene
    return {
        rings: [
            shaft.solve(
                beam_of_scene(scene, {main.bearing: stiffness}, rings=rings),
                scene.shaft.front,
                f,
                at=at,
            ).displacements
            for f in 1000.0 * np.eye(6)[[2, 4]]
        ]
        for rings in BEAMS
    }


def deflections(
    solved: dict[str, Assembly], motion_of_beam: dict[bool, list[Floats]], series: bands.Series
) -> list[Record]:
    """Deflection and slope at the hub (station -2) and at the bearing (-1), FE and beams."""
    name = solved[FORMS[0]].bearing
    rows: list[Record] = []
    for k, (load, label) in enumerate(((2, "Fz = 1 kN"), (4, "My = 1 kN m"))):
        for quantity, unit, station, point, component in (
            ("hub deflection uz", "µm", -2, "hub", 2),
            ("hub slope ry", "µrad", -2, "hub", 4),
            ("slope ry at the bearing", "µrad", -1, f"{name}.seat", 4),
        ):
            values = [
                1e9 * float(s.response.motions[point][component, load]) for s in solved.values()
            ]
            beams = {
                title: 1e6 * float(motion_of_beam[rings][k][station, component])
                for rings, title in BEAMS.items()
            }
            rows.append(
                {
                    "quantity": f"{quantity} [{unit}]",
                    "hub load": label,
                    **dict(zip(FORMS, values, strict=True)),
                    "± sliding": series.band(
                        lambda f, p=point, at=(component, load): 1e9 * float(f[f"motion {p}"][at])
                    ),
                    SPREAD: 100.0 * (max(values) - min(values)) / abs(values[0]),
                    **beams,
                    BARE_ERROR: 100.0 * (beams[BEAMS[False]] / values[0] - 1.0),
                }
            )
    return rows


def causes(main: Assembly, beam_load: Floats, mean_load: Floats) -> list[Record]:
    """Vertical loads on the bearing with what a drivetrain has and statics have not."""
    name, weight = main.bearing, main.scene.gearbox.weight
    front = main.scene.shaft.front
    at_hub, ahead = PointLoads(mean_load, front), PointLoads(mean_load, front - 0.05)
    loads = {
        "pinned beam (Eq 3.1)": beam_load,
        "FE, gearbox weight at the gearbox: goes into its spring, no lever arm": (
            main.response.history(name, at_hub, weight)
        ),
        "FE with self-weight of shaft, bearing and housing (Eq 3.1 has none)": (
            main.response.history(name, at_hub, weight, GRAVITY)
        ),
        "FE, hub load 50 mm in front of the shaft's face (lever arm)": (
            main.response.history(name, ahead, weight)
        ),
    }
    return [
        {
            "model": model,
            "Fz [kN]": load[2] / 1e3,
            "difference from statics [%]": 100 * (load[2] / beam_load[2] - 1),
        }
        for model, load in loads.items()
    ]


def axis_deflection(solved: Assembly, load: int, n_slices: int) -> tuple[Floats, Floats]:
    """Mean vertical displacement of the shaft's nodes in slices along x, by volume."""
    mesh = solved.model.mesh
    weights = solved.model.part_mass["shaft"]
    nodes = np.flatnonzero(weights > 0)
    x = mesh.points[nodes, 0]
    edges = np.linspace(x.min(), x.max(), n_slices + 1)
    slot = np.clip(np.digitize(x, edges) - 1, 0, n_slices - 1)
    total = np.bincount(slot, weights[nodes], n_slices)
    mean_x = np.bincount(slot, weights[nodes] * x, n_slices) / total
    u = solved.response.displacements[nodes, 2, load]
    return mean_x, np.bincount(slot, weights[nodes] * u, n_slices) / total


def solved_forms(run: Run, scene: Scene) -> Worked:
    """Solve the three forms of the joint, and one of them on coarser meshes, too."""
    main_bearing_beam(scene)  # refuses before the work what it cannot stand for
    with drawing_ready(), run.side_by_side(len(FORMS) + 2) as jobs:
        mesh = timed_mesh(run, scene, "all forms")  # which differ in their constraints only
        scenes = {form: bearing_scenes.with_interface(scene, form) for form in FORMS}
        solving = {
            form: jobs.start(bearing_scenes.solve_and_write, scenes[form], form, mesh, "mesh")
            if form == FORMS[0]
            else jobs.start(bearing_scenes.solve, scenes[form], form, mesh)
            for form in FORMS
        }
        coarser = bands.start(jobs, scenes[FORMS[0]], FORMS[0])
        main = solving[FORMS[0]].result()
        load_factors = np.array([0, 0, -1e5, 0, 0, 0, 0, 0, 0, 0], dtype=float)
        drawing = shown.start_pictures(run, jobs, main, load_factors, "Fz = -100 kN at the hub")
        solved = {form: job.result() for form, job in solving.items()}
        pictures = drawing()
        series = coarser.below(bands.of_solved(main))
    return Worked(solved, series, pictures, closed_form_models(scene, {})[PINNED])


def check_statics(page: Page, work: Worked) -> None:
    """Reactions of each form against statics."""
    main, pinned = work.main, work.pinned.matrix.T
    for form, s in work.solved.items():
        reaction = s.response.reactions[main.bearing][:, :6]
        worst = np.abs(reaction - pinned)[1:3, [1, 2, 4, 5]].max() / np.abs(pinned[1:3]).max()
        page.vanishes(
            f"{form}: radial reactions of unit hub loads against statics (Eq 3.1)",
            float(worst),
            within=1e-8,
            why="the shaft is determinate and loads act at the same points: solver accuracy",
            source="Stirling 2023, Eq 3.1: moment balance about the gearbox",
        )
        shown.check_solution(page, s, form)
    shown.check_series(page, work.series, FORMS[0])
    page.vanishes(
        "sliding: moment on the bearing per unit of bending moment at the hub",
        float(np.abs(main.response.reactions[main.bearing][3:, 3:6]).max()),
        within=1e-8,
        why="the residual at which the solver stops: the joint has no row for a moment",
        source="a sphere without friction carries no moment",
    )


def check_deflections(page: Page, rows: list[Record]) -> None:
    """What the reactions cannot show: FE between beams on the bearing unit's own stiffness."""
    for row in rows:
        stiff, soft = row[BEAMS[True]], row[BEAMS[False]]
        band = row["± sliding"]
        page.between(
            f"{row['quantity'].partition(' [')[0]} under {row['hub load']}: FE (sliding) between "
            "the bare beam (1) and the beam with the ring turned from one piece with the shaft (0)",
            (row[FORMS[0]] - stiff) / (soft - stiff),
            0.0,
            1.0,
            why="the ring stiffens the seat, but less than a section that stays plane",
            source="Timoshenko beams on the FE stiffness of the bearing unit",
            band=None if band is None else band / abs(soft - stiff),
        )


def answer(page: Page, work: Worked) -> None:
    """What statics decide, and what the beam and the forms differ by."""
    rows, series = work.rows, work.series
    along_z = [u[2, 2] / 1e9 for u in work.unit.values()]
    softer = max(abs(row[BARE_ERROR]) for row in rows)
    bare = "bare beam against FE, worst of deflection and slope"
    page.found(f"{bare} [%]", softer)
    deflection = next(row for row in rows if "deflection" in str(row["quantity"]))
    quantity, _, unit = str(deflection["quantity"]).partition(" [")
    under = f"{quantity} under {deflection['hub load']} [{unit}"
    page.answer(
        "Which quantities of a shaft on a spherical main bearing need a model of solids?",
        "Only deflection and slope need one: a beam of the bare shaft errs there by up to "
        f"{softer:.2g}\u00a0%. Bearing forces follow from statics alone.",
        [
            page.judged(bare, "largest error of the bare beam"),
            page.value(under, deflection[FORMS[0]], deflection["± sliding"]),
            page.value(
                under.replace(" under", ", bare beam, under"),
                deflection[BEAMS[False]],
                beside=deflection[FORMS[0]],
                by="solids",
            ),
            page.value(
                under.replace(" under", ", ring as shaft, under"),
                deflection[BEAMS[True]],
                beside=deflection[FORMS[0]],
                by="solids",
            ),
            page.value(
                "largest difference between forms of the joint [%]",
                max(row[SPREAD] for row in rows),
            ),
        ],
        hero=HERO,
        cautions=[
            "The bare beam lacks the bearing ring, which stiffens the seat; with the ring as part "
            "of the shaft it is too stiff.",
            "That forces agree with statics does not validate the solid model.",
        ],
    )
    page.say(
        f"The three forms of the joint differ by at most {max(row[SPREAD] for row in rows):.2g} % "
        f"in deflection and slope; radial stiffness along z lies between {min(along_z):.3g} and "
        f"{max(along_z):.3g} GN/m.",
    )
    if series.complete:
        seat = f"{work.main.bearing}.seat"
        uncertainty = max(
            series.percent(lambda f, p=p, at=at: float(f[f"motion {p}"][at])) or 0.0
            for p, at in (("hub", (2, 2)), ("hub", (4, 4)), (seat, (4, 2)))
        )
        page.say(
            "Numerical uncertainty of deflection and slope, from two coarser meshes: "
            f"{uncertainty:.2g} %."
        )


def reactions_section(page: Page, work: Worked) -> None:
    """Reactions to unit loads, and what can make FE and statics differ."""
    main = work.main
    page.section("Reactions")
    page.text(
        "The spherical joint makes the shaft determinate, so its radial reactions follow from "
        "statics and must agree to solver accuracy. That agreement proves nothing about the FE "
        "model. By construction the shaft can twist freely in the bearing: the gearbox holds the "
        "torque."
    )
    shown.reaction_table(
        page,
        "Load on the main bearing for unit loads (sliding joint), moments about its centre",
        main.response.reactions[main.bearing],
    )
    shown.reaction_table(
        page,
        "Load on the gearbox for unit loads (sliding joint), moments about the rear face's centre",
        main.response.reactions["gearbox"],
    )
    mean_load = np.array([200e3, 0.0, -370e3, 0.0, 660e3, 0.0])
    page.table(
        "Vertical load on the main bearing under a typical mean hub load (Fx 200 kN, Fz -370 kN, "
        "My 660 kN m): what can make FE and statics differ",
        causes(main, work.pinned.reaction(mean_load), mean_load),
    )


def deflections_section(page: Page, work: Worked) -> None:
    """Deflection, slope and stiffness, which do depend on the FE model."""
    page.section("Deflection, slope and stiffness")
    page.text(
        "These do depend on the FE model. The sliding sphere lets the faces slip; the averaged "
        "form joins only their mean displacements; the rigid form keeps each face a rigid body "
        "about the centre, fulfils the constraints of both others, and so is the stiffest. The "
        "other two have no fixed order: slip can shift a face's mean."
    )
    page.table(
        "Deflection and slope: FE with three forms of the spherical joint, and Timoshenko beams "
        "on the stiffness of the FE bearing unit (sliding)",
        work.rows,
    )
    x, uz = axis_deflection(work.main, LOADS.index("hub.Fz"), 40)
    page.chart(
        HERO,
        [
            *(
                trace(title, work.stations, 1e6 * work.motion_of_beam[rings][0][:60, 2])
                for rings, title in BEAMS.items()
            ),
            trace("FE, mean of each slice", x, 1e9 * uz, points=True),
        ],
        "x along the shaft [m]",
        "uz [µm]",
    )
    band_row = [
        work.series.band(lambda f, k=k: float(f["stiffness"][k, k]) / 1e9) for k in range(3)
    ]
    page.table(
        "Translational stiffness of bearing and housing at the bearing's centre [GN/m], and its "
        "band of the sliding form, whose mesh the others share",
        [
            *([form, *(u.diagonal()[:3] / 1e9).tolist()] for form, u in work.unit.items()),
            [f"± {FORMS[0]}", *band_row],
        ],
        ["form", "along x", "along y", "along z"],
    )


def write_stiffness(run: Run, work: Worked) -> None:
    """The 6x6 stiffness of the bearing unit by each form, for other programs."""
    main = work.main
    write_stiffness_json(
        run.folder / "stiffness.json",
        main.scene.title,
        [
            stiffness_matrix(
                f"{main.bearing}, {form} joint",
                stiffness,
                main.response.positions[main.bearing],
                "from the strain energy of bearing and housing; the joint leaves rotations free",
            )
            for form, stiffness in work.unit.items()
        ],
        main.response.diagnostics.n_unknowns,
    )


@case(
    "Spherical main bearing: reactions, deflection and the joint's three forms",
    source="Stirling 2023, PhD thesis, sections 3.1 and 3.2 (DSRB), Table 3.1, Eq 3.1",
    settings={
        "solver": "auto (or superlu, cholmod, pardiso, multigrid, schwarz, petsc, petsc-mumps)",
    },
    changes="scene",
)
def run(run: Run, page: Page) -> None:
    """Solve the three forms of the joint and compare them with statics and with a beam."""
    scene = bearing_scenes.scene_of(run, page, "spherical")
    if scene.bearing_units[0].interface != FORMS[0]:
        page.note(
            f"The scene's joint is {scene.bearing_units[0].interface}: here stand all three forms "
            f"of it, and what names none is of the {FORMS[0]} one."
        )
    work = solved_forms(run, scene)
    check_statics(page, work)
    check_deflections(page, work.rows)
    write_stiffness(run, work)
    answer(page, work)
    page.section("Model")
    page.add(*work.pictures)
    reactions_section(page, work)
    deflections_section(page, work)
    shown.mesh_section(page, work.solved)
    page.text(work.series.note())
    shown.assume(page, scene)
    for form, u in work.unit.items():
        page.data(form, {f"stiffness_{axis}": u[k, k] for k, axis in enumerate("xyz")})
