"""Torsional stiffness K_R of the bearing unit in both planes, by three estimators side by side."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.main_bearing import bands, bearing_scenes, calibrated, shown
from fe_drivetrain.report import bars
from fe_drivetrain.report.number_text import certain_value, value_text
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.shafts.response import PLANES
from fe_drivetrain.studies import Assembly, SeatStiffness
from fe_drivetrain.studies.solved_assembly import timed_mesh

HERO = "K_R by plane and estimator"


def check_energies(page: Page, free: Assembly, series: bands.Series) -> None:
    """Energy of hub moments: against their work, and that in the overhang against a beam's."""
    response, scene, shaft = free.response, free.scene, free.scene.shaft
    for plane in PLANES:
        load = plane.moment
        page.equals(
            f"{plane.name}: work of the hub moment against energy stored [rad/(N m)]",
            sum(float(e[load, load]) for e in response.strain_energy.values()),
            float(response.motions["hub"][load, load]),
            within=1e-8,
            why="no spring and no constraint does work: solver accuracy",
            source="Clapeyron: U = M theta / 2",
            measure="energy",
            band=series.band(
                lambda f, k=load: sum(
                    float(e[k, k]) for key, e in f.items() if key.startswith("free energy ")
                )
            ),
        )
    if len(shaft.sections) > 1 or shaft.flange is not None:
        return  # not a uniform beam
    # The overhang carries a pure moment, M^2 L / (2 EI), that leaves the shaft under the ring.
    section, bearing = shaft.sections[0], scene.bearing_units[0].bearing
    if bearing.width < 0.5 * section.outer_diameter:
        return  # of a narrow ring the shaft feels the moment beyond it, too
    inertia = np.pi / 64.0 * (section.outer_diameter**4 - section.inner_diameter**4)
    EI = scene.material_of("shaft").youngs_modulus * inertia
    near, far = (
        (bearing.x - shaft.front + d) / EI for d in (-bearing.width / 2.0, bearing.width / 2.0)
    )
    page.between(
        "vertical: energy in the shaft between that of a beam up to the ring's near side (0) and "
        "up to its far side (1)",
        (float(response.strain_energy["shaft"][4, 4]) - near) / (far - near),
        0.0,
        1.0,
        why="under the ring the moment passes from the shaft into the bearing",
        source="beam in pure bending, U = M^2 L / (2 EI)",
        band=series.band(lambda f: float(f["free energy shaft"][4, 4]) / (far - near)),
    )


def by_load(free: Assembly, series: bands.Series) -> list[Record]:
    """K_R under a hub moment, and under a hub force with the same moment at the bearing."""
    seat = f"{free.bearing}.seat"
    arm = free.scene.bearing_units[0].bearing.x - free.scene.shaft.front
    rows: list[Record] = []
    for plane in PLANES:
        by_moment = free.response.motions[seat][plane.moment, plane.moment]
        by_force = free.response.motions[seat][plane.moment, plane.force]
        k_force = plane.sign * arm / by_force / 1e6
        rows.append(
            {
                "plane": plane.name,
                "hub moment": 1e-6 / by_moment,
                "hub force": k_force,
                "difference [%]": 100.0 * (k_force * 1e6 * by_moment - 1.0),
                "± difference [%]": series.band(
                    lambda f, p=plane: (
                        100.0
                        * p.sign
                        * arm
                        * float(
                            f[f"free motion {seat}"][p.moment, p.moment]
                            / f[f"free motion {seat}"][p.moment, p.force]
                        )
                    )
                ),
            }
        )
    return rows


def answer(page: Page, tilt: SeatStiffness, series: bands.Series) -> None:
    """K_R of a user's scene in both planes, and how far the estimators spread."""
    both = [k / 1e6 for k in tilt.both("averaged seat")]
    percent: list[float | None] = [None, None]
    if series.complete:
        percent = [series.percent(lambda f, p=p: float(f["K_R"][p, 1])) for p in range(len(PLANES))]
        page.say(
            f"Numerical uncertainty from two coarser meshes: {percent[0]:.2g} % in the vertical "
            f"and {percent[1]:.2g} % in the horizontal plane (averaged seat)."
        )
    for plane, value, share in zip(tilt.by_plane, both, percent, strict=True):
        band = None if share is None else share / 100.0 * value
        page.found(f"K_R, {plane} plane [MN m/rad]", value, band)
    found = [page.judged(f"K_R, {plane} plane") for plane in tilt.by_plane]
    vertical, horizontal = (certain_value(one) for one in found)
    spreads = {plane: tilt.spread(plane) for plane in tilt.by_plane}
    page.answer(
        "How stiff against tilting (K_R) are a main bearing and its housing?",
        f"K_R is {vertical} in the vertical and {horizontal} in the horizontal plane; "
        f"three ways to read it differ by {max(spreads.values()):.0f} %.",
        [
            *found,
            *(
                page.value(f"spread of three estimators, {plane} plane [%]", spread)
                for plane, spread in spreads.items()
            ),
        ],
        hero=HERO,
        cautions=[
            "Values are of the averaged seat; which estimator a beam is given decides its "
            "reactions.",
        ],
    )


def answer_of_both(page: Page, found: dict[str, calibrated.Housed], tilt: SeatStiffness) -> None:
    """K_R of both housings as the thesis finds it, and how far the estimators spread."""
    generic = found[calibrated.GENERIC]
    times = max(generic.K_R[plane] / shown.PUBLISHED[plane] for plane in generic.K_R)
    vertical, horizontal = (
        value_text(generic.K_R[plane], "MN m/rad", generic.band(p), False)
        for p, plane in enumerate(generic.K_R)
    )
    spread = max(tilt.spread(plane) for plane in tilt.by_plane)
    for p, plane in enumerate(generic.K_R):
        page.found(f"K_R, {plane} plane [MN m/rad]", generic.K_R[plane], generic.band(p))
    page.answer(
        "How stiff against tilting (K_R) are a main bearing and its housing?",
        f"The library's housing resists tilting with {vertical} vertically, {horizontal} "
        f"horizontally, up to {times:.1f} times the published; three ways of evaluation differ "
        f"by {spread:.0f}\u00a0%.",
        [
            *(
                page.value(
                    f"K_R, {plane} plane, {name} [MN m/rad]",
                    one.K_R[plane],
                    one.band(p),
                    beside=shown.PUBLISHED[plane],
                    by="thesis's housing",
                )
                for name, one in found.items()
                for p, plane in enumerate(one.K_R)
            ),
            page.value("spread of three methods of evaluation, library's housing [%]", spread),
        ],
        hero=HERO,
        cautions=[
            "The thesis does not state its housing's dimensions: the calibrated housing is one of "
            "many with the thesis's K_R.",
            f"K_R is read from {calibrated.THESIS_WAY}, as in the thesis; the way of reading "
            "decides a beam's reactions.",
        ],
    )


def estimators_section(page: Page, tilt: SeatStiffness, series: bands.Series) -> None:
    """K_R by three estimators, and the points that one of them uses."""
    page.section("K_R by three estimators")
    shown.tilt_table(page, tilt, series)
    by_plane = {
        plane: {name: K / 1e6 for name, K in values.items()}
        for plane, values in tilt.by_plane.items()
    }
    page.add(bars(HERO, by_plane, "K_R [MN m/rad]"))
    page.text(
        "Four nodes: rotation of the line between two housing points, as in the thesis; it misses "
        "the compliance of the ring and of the shell between shaft and housing, so it is usually "
        "the stiffest. Averaged seat: least-squares rotation of the face between shaft and "
        "bearing. Energy: M²/2U with the energy of bearing and housing alone, without the shaft's "
        "own compliance under the ring."
    )
    mesh = tilt.free.model.mesh
    page.table(
        "The points that the four-node estimator uses, imprinted in the geometry",
        [
            [key, *mesh.points[node].tolist()]
            for key, node in mesh.named_points.items()
            if key.startswith(f"{tilt.free.bearing}.housing.")
        ],
        ["point", "x [m]", "y [m]", "z [m]"],
    )


def load_section(page: Page, free: Assembly, series: bands.Series) -> None:
    """Where the work of a moment goes, and K_R under a moment and under a force."""
    page.section("Energy and load")
    page.table(
        "Where the work of a hub moment goes [%]",
        [
            {"plane": p.name}
            | {
                part: 100.0
                * float(e[p.moment, p.moment])
                / float(free.response.motions["hub"][p.moment, p.moment])
                for part, e in free.response.strain_energy.items()
            }
            for p in PLANES
        ],
    )
    page.table(
        "K_R [MN m/rad] from the averaged seat under a pure moment and under a hub force with the "
        "same moment at the bearing",
        by_load(free, series),
    )


@case(
    "Torsional stiffness K_R of bearing and housing, by three estimators",
    source="Stirling 2023, PhD thesis, section 3.3.1, Eq 3.20, Figures 3.13 and 3.14",
    settings={
        "drivetrain": "FILE with one main bearing, or a name of the library (otherwise both)",
        "solver": "auto (or superlu, cholmod, pardiso, multigrid, schwarz, petsc, petsc-mumps)",
    },
    changes="scene",
)
def run(run: Run, page: Page) -> None:
    """Measure K_R, and show how much it depends on the estimator and on the load."""
    scene = bearing_scenes.scene_of(run, page, "bonded")
    with run.side_by_side(4) as jobs:
        coarser = bands.start(jobs, scene, "bonded", solved=False, tilted=True)
        mesh = timed_mesh(run, scene, "bonded")
        tilt = bearing_scenes.solve_seat(run, scene, "without gearbox", mesh)
        series = coarser.below(bands.of_tilt(tilt))
        coming = calibrated.start(run, jobs, solved=False)
        other = None if coming is None else coming.result()
    free = tilt.free
    shown.check_solution(page, free, "without gearbox")
    shown.check_series(page, series, "without gearbox")
    check_energies(page, free, series)
    if other is None:
        answer(page, tilt, series)
    else:
        calibrated.check(page, other)
        found = {calibrated.GENERIC: calibrated.Housed(None, tilt, series)}
        found[calibrated.CALIBRATED] = other
        answer_of_both(page, found, tilt)
    load_factors = np.zeros(10)
    load_factors[4] = 1e6
    page.section("Model")
    page.add(*shown.pictures_of(run, free, load_factors, "My = 1 MN m at the hub, no gearbox"))
    estimators_section(page, tilt, series)
    if other is not None:
        calibrated.section(page, calibrated.stiffness_rows(found))
    load_section(page, free, series)
    shown.mesh_section(page, {"without gearbox": free})
    page.text(series.note())
    shown.assume(page, scene)
    page.data("tilt_stiffness", tilt.by_plane)
