"""The main-bearing study: beams against FE over 144 ten-minute hub-load histories.

Three comparisons, as in the thesis: pinned beam against spherical FE, pinned beam against bonded
FE, torsional-spring beam against bonded FE; and a fourth, a beam on the full 6x6 stiffness.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.main_bearing import (
    bands,
    bearing_scenes,
    calibrated,
    charts,
    design_measures,
    shown,
    surrogate,
)
from fe_drivetrain.cases.main_bearing.comparison import (
    MEAN_ERROR,
    ON_MATRIX,
    PUBLISHED,
    Comparison,
    compared,
    of_one_mesh,
)
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import weighted_statistics
from fe_drivetrain.drivetrain_file import Scene
from fe_drivetrain.export import stiffness_matrix, write_stiffness_json
from fe_drivetrain.report import Image, Solid, Text, drawing_ready
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.shafts.beam import beam_of_scene, main_bearing_beam, shaft
from fe_drivetrain.shafts.response import bearing_unit_stiffness
from fe_drivetrain.studies import hub_load_rows
from fe_drivetrain.studies.seat_stiffness import SeatStiffness
from fe_drivetrain.studies.solved_assembly import Assembly, timed_mesh
from fe_drivetrain.turbine_loads.hub_loads import HubLoadSet, assumptions

OF_THESIS = (
    ". The thesis's stand beside them for orientation: its hub loads and its housing are not public"
)


def deflections(solved: Assembly, matrix: Floats, series: bands.Series, label: str) -> list[Record]:
    """Deflection at the hub and slope at the bearing, FE and Timoshenko beams."""
    scene, name = solved.scene, solved.bearing
    bare, ring = (
        shaft.solve(
            beam_of_scene(scene, {name: matrix}, rings=rings),
            scene.shaft.front,
            1000.0 * np.eye(6)[2],
            at=[scene.shaft.front, scene.bearing_units[0].bearing.x],
        ).displacements
        for rings in (False, True)
    )
    rows: list[Record] = []
    for quantity, station, point, component in (
        ("hub deflection uz [µm]", 0, "hub", 2),
        ("slope ry at the bearing [µrad]", 1, f"{name}.seat", 4),
    ):
        fe = 1e9 * float(solved.response.motions[point][component, 2])
        of_bare, of_ring = (1e6 * float(motion[station, component]) for motion in (bare, ring))
        rows.append(
            {
                "bearing": label,
                "quantity": quantity,
                "FE": fe,
                "± FE": series.band(
                    lambda f, p=point, c=component: 1e9 * float(f[f"motion {p}"][c, 2])
                ),
                "beam, bare shaft": of_bare,
                "beam, ring as shaft": of_ring,
                "bare beam against FE [%]": 100.0 * (of_bare / fe - 1.0),
            }
        )
    return rows


def check_beams(page: Page, found: Comparison, of_beams: bands.Series, spherical: Scene) -> None:
    """What is asked of the beams; `of_beams` has errors of two of them, and a correlation."""
    first, _, third = PUBLISHED
    with page.of(spherical):
        page.vanishes(
            f"{first}: mean error of the resultant [%]",
            found.mean_error[first],
            within=1e-6,
            why="loads act at the same points in both: solver accuracy",
            source="statics: the shaft is determinate",
        )
    page.at_most(
        f"{third}: mean error of the resultant [%]",
        found.mean_error[third],
        2.0,
        why="asked of the torsional-spring model: under 2 %",
        source="FE of this study; the thesis reports 1.61 %",
        band=of_beams.band(lambda f: float(f["beams"][1])),
    )
    if np.isfinite(found.correlation[third]):  # a load that never changes has no correlation
        page.at_least(
            f"{third}: correlation of the resultant",
            found.correlation[third],
            0.999,
            why="asked of the torsional-spring model: above 0.999",
            source="FE of this study; the thesis reports 0.9996",
            band=of_beams.band(lambda f: float(f["beams"][2])),
        )


def load_statistics(hub: HubLoadSet) -> Floats:
    """(6, 4) min, mean, max, standard deviation over all histories, which are equally long."""
    samples = hub.loads.reshape(-1, 6)
    return weighted_statistics(samples, np.full(len(samples), 1.0 / len(samples)))


def result_section(
    page: Page, hub: HubLoadSet, found: Comparison, error_band: dict[str, float | None]
) -> None:
    """Loads, errors over all histories, and what they come from."""
    page.section("Result")
    page.text(surrogate.statement(hub))
    page.table(
        "Hub loads over all histories, in the non-rotating shaft frame at the hub",
        hub_load_rows(load_statistics(hub)),
    )
    columns = list(found.headline[0])
    place = columns.index(MEAN_ERROR) + 1
    page.table(
        "Resultant radial force on the main bearing over all histories: mean of each history's "
        f"value{OF_THESIS}",
        [{**row, f"± {MEAN_ERROR}": error_band.get(row["comparison"])} for row in found.headline],
        [*columns[:place], f"± {MEAN_ERROR}", *columns[place:]],
    )
    page.text(
        "Mean error is |F_beam - F_FE| / |F_FE| averaged over samples, the thesis's metric; it "
        "breaks down where the reference passes zero, so samples with a reference below "
        "0.1 % of its rms are left out and counted, and a robust measure stands beside it."
    )
    page.text(
        "The pinned beam's mean error on a bonded bearing depends on the housing and on the "
        "loads, so likeness to the thesis's 22.74 % is chance: with the thesis's own K_R of "
        "145 and 392 MN m/rad in Eq 3.19 the same hub loads give "
        f"{found.with_their_stiffness:.1f} %, and its hub loads were others."
    )
    page.table(
        "By quantity, means over all histories: usable as a model uncertainty. FE = slope x beam, "
        "with the residual's coefficient of variation (EN 1990, Annex D); relative scatter is the "
        "standard deviation of the difference over the rms of the reference",
        found.quantities,
    )
    page.table(
        "What makes beam and FE differ: the comparison with one cause at a time taken out or put "
        "in",
        found.causes,
    )


@dataclass(frozen=True, eq=False)
class Worked:
    """Both bearings solved, their coarser meshes, the loads, and what comes of them.

    Attributes
    ----------
    spherical, bonded : Assembly
        Both bearings on the case's own mesh.
    tilt : SeatStiffness
        K_R of the bonded one.
    series : dict[str, bands.Series]
        Meshes of each kind.
    hub : HubLoadSet
        The load histories.
    found : Comparison
        Beams against FE.
    pictures : sequence of Image, Solid or Text
        Pictures of the model.
    other : calibrated.Housed or None
        The bonded bearing in the calibrated housing; None of a scene of the user's.
    """

    spherical: Assembly
    bonded: Assembly
    tilt: SeatStiffness
    series: dict[str, bands.Series]
    hub: HubLoadSet
    found: Comparison
    pictures: Sequence[Image | Solid | Text]
    other: calibrated.Housed | None

    @property
    def housings(self) -> dict[str, calibrated.Housed]:
        """Both housings; none of a scene of the user's."""
        if self.other is None:
            return {}
        own = calibrated.Housed(self.bonded, self.tilt, self.series["bonded"])
        return {calibrated.GENERIC: own, calibrated.CALIBRATED: self.other}


def solved(run: Run, spherical_scene: Scene, bonded_scene: Scene) -> Worked:
    """Make the hub loads, solve both scenes, compare over all histories."""
    main_bearing_beam(spherical_scene)  # refuses early what it cannot stand for
    with drawing_ready(), run.side_by_side(8) as jobs:
        solving = jobs.start(
            bearing_scenes.solve_and_write, spherical_scene, "spherical", None, "mesh_spherical"
        )
        # beside the first solid, which compiles loops: two at once would compile each of them twice
        making = surrogate.start(run, jobs)
        mesh = timed_mesh(run, bonded_scene, "bonded")
        solving_bonded = jobs.start(
            bearing_scenes.solve_and_write, bonded_scene, "bonded", mesh, "mesh_bonded"
        )
        tilting = jobs.start(bearing_scenes.solve_seat, bonded_scene, "bonded, no gearbox", mesh)
        coarser = bands.start(jobs, spherical_scene, "spherical")
        coarser_bonded = bands.start(jobs, bonded_scene, "bonded", tilted=True)
        coming = calibrated.start(run, jobs)
        hub = surrogate.made(run, making)
        spherical = solving.result()
        mean_load = np.zeros(10)
        mean_load[:6] = hub.loads.mean(axis=(0, 1))
        mean_load[9] = bonded_scene.gearbox.weight
        drawing = shown.start_pictures(
            run, jobs, spherical, mean_load, "the mean hub load of all histories"
        )
        bonded, tilt = solving_bonded.result(), tilting.result()
        found = compared(run, hub, spherical, bonded, tilt)
        pictures = drawing()
        series = {
            "spherical": coarser.below(bands.of_solved(spherical)),
            "bonded": coarser_bonded.below(bands.of_solved(bonded) | bands.of_tilt(tilt)),
        }
        other = None if coming is None else coming.result()
    return Worked(spherical, bonded, tilt, series, hub, found, pictures, other)


def errors_by_mesh(run: Run, work: Worked) -> bands.Series:
    """Mean errors of pinned and torsional-spring beam, and its correlation, on each mesh."""
    found, series = work.found, work.series["bonded"]
    name, scene = work.bonded.bearing, work.bonded.scene
    _, second, third = PUBLISHED
    with run.step("bands of the mean errors"):
        rows = [
            of_one_mesh(found.over, scene, f[f"reaction {name}"], f["K_R"][:, 1])
            for f in series.levels[:-1]
        ]
    rows.append((found.mean_error[second], found.mean_error[third], found.correlation[third]))
    sizes = [f["size"] for f in series.levels]
    return bands.Series(
        tuple({"beams": np.array(row), "size": size} for row, size in zip(rows, sizes, strict=True))
    )


def answer(
    page: Page, found: Comparison, work: Worked, error_band: dict[str, float | None]
) -> None:
    """State errors of the beams on the bonded bearing of a user's scene."""
    _, second, third = PUBLISHED
    mean_error, correlation = found.mean_error, found.correlation
    n_histories, n_samples = work.hub.loads.shape[:2]
    enough = mean_error[third] <= 2.0
    page.answer(
        "Which beam is enough for the forces on a bonded main bearing?",
        f"A beam with torsional springs is {'' if enough else 'not '}accurate enough: its mean "
        f"error is {mean_error[third]:.2g}\u00a0%, that of a pinned beam "
        f"{mean_error[second]:.3g}\u00a0%.",
        [
            *(
                page.value(f"mean error, {name} [%]", mean_error[label], error_band.get(label))
                for label, name in ((third, "torsional-spring beam"), (second, "pinned beam"))
            ),
            page.value("mean error, beam on the 6x6 stiffness [%]", mean_error[ON_MATRIX]),
            *(
                page.value(f"correlation, {name}", correlation[label])
                for label, name in ((third, "torsional-spring beam"), (second, "pinned beam"))
                if np.isfinite(correlation[label])
            ),
            page.value("load steps compared", n_histories * n_samples),
        ],
        hero=charts.series_caption(work.hub, "bonded", "vertical", "Fz"),
        cautions=[
            "Hub loads are a surrogate of 2 MW: `fe-drivetrain study` takes your own.",
            "The mean error leaves out samples with a reference below 0.1 % of its rms.",
        ],
    )


def answer_of_both(page: Page, errors: dict[str, calibrated.Errors], work: Worked) -> None:
    """State errors of the beams in both housings, beside those of the thesis."""
    _, second, third = PUBLISHED
    generic, other = errors.values()
    holds = other.as_thesis[0] <= calibrated.ENOUGH
    stated = "about the thesis's" if holds else "not by the thesis's"
    in_part = min(one.sprung[0] for one in errors.values()) <= calibrated.ENOUGH
    page.answer(
        "Which beam is enough for the forces on a bonded main bearing?",
        "With the thesis's torsional stiffness K_R a beam on springs errs by "
        f"{formatted(other.as_thesis[0], 3)}\u00a0% on average, "
        f"{stated} {PUBLISHED[third][0]:g}\u00a0%; a pinned beam by {other.pinned[0]:.3g}\u00a0%.",
        [
            *(
                page.value(
                    f"{words}, {name} [%]",
                    value[0],
                    band,
                    beside=PUBLISHED[label][0],
                    by="thesis",
                )
                for name, one in (
                    (calibrated.CALIBRATED, other),
                    (calibrated.GENERIC, generic),
                )
                for label, words, value, band in (
                    (third, "mean error, torsional springs", one.as_thesis, one.thesis_band),
                    (second, "mean error, pinned beam", one.pinned, one.pinned_band),
                )
            ),
            page.value(
                "correlation, pinned beam, calibrated housing",
                other.pinned[1],
                beside=PUBLISHED[second][1],
                by="thesis",
            ),
            page.value("load steps compared", work.hub.loads.shape[0] * work.hub.loads.shape[1]),
        ],
        hero=charts.series_caption(work.hub, "bonded", "vertical", "Fz"),
        cautions=[
            "Of the thesis's housing only K_R is public, and its hub loads are not: what thrust "
            "does to the bearing depends on the housing's shape.",
            f"K_R is read from {calibrated.THESIS_WAY} of the housing, as in the thesis; results "
            "with the average over the seat stand below.",
            "The mean error leaves out samples with a reference below 0.1 % of its rms.",
        ],
        claim="holds" if holds else "holds in part" if in_part else "does not hold",
    )


def answered(
    run: Run, page: Page, work: Worked, error_band: dict[str, float | None]
) -> dict[str, calibrated.Errors]:
    """Give the answer, in both housings where the scene is the thesis's; errors by housing."""
    with run.step("both housings"):
        loads, over = work.hub.loads, work.found.over
        errors = {n: calibrated.errors_of(loads, over, one) for n, one in work.housings.items()}
    if work.other is None:
        answer(page, work.found, work, error_band)
    else:
        calibrated.check(page, work.other)
        answer_of_both(page, errors, work)
    page.say(
        "On a spherical bearing pinned beam and FE agree to solver accuracy: statics decide, and "
        "their agreement says nothing about the FE model. Deflection, slope and stiffness, which "
        "do depend on it, stand below.",
    )
    return errors


def stiffness_section(page: Page, work: Worked, stiffness: Floats) -> None:
    """K_R, deflection and slope, which reactions do not show."""
    tilt, series = work.tilt, work.series
    page.section("What reactions do not show: stiffness, deflection, slope")
    shown.tilt_table(page, tilt, series["bonded"])
    page.table(
        "The torsional-spring beam with K_R of each estimator, against bonded FE; no value is "
        "fitted",
        work.found.estimators,
    )
    page.table(
        "Under Fz = 1 kN at the hub: FE, and Timoshenko beams on the FE stiffness of the bearing "
        "unit. The ring stiffens the shaft; the 6x6 of the bonded unit holds its share already, so "
        "there the beam with a ring counts it twice",
        [
            *deflections(work.spherical, stiffness, series["spherical"], "spherical"),
            *deflections(work.bonded, tilt.matrix, series["bonded"], "bonded"),
        ],
    )
    shown.matrix_table(
        page,
        "Condensed stiffness of the bonded bearing unit at the bearing's centre; "
        + series["bonded"].largest("stiffness"),
        tilt.matrix,
    )


@case(
    "Main-bearing study: beam models against FE over hub-load histories",
    source="Stirling 2023, PhD thesis, chapter 3 (Figures 3.6 to 3.15, Table 3.1, Eq 3.1-3.19)",
    settings={
        "drivetrain": "FILE with one main bearing, or a name of the library (otherwise both)",
        "solver": "auto (or superlu, cholmod, pardiso, multigrid, schwarz, petsc, petsc-mumps)",
    },
    changes="scene",
)
def run(run: Run, page: Page) -> None:
    """Make the hub loads, solve both scenes, compare over all histories."""
    page.seed = 1
    scenes = [bearing_scenes.scene_of(run, page, kind) for kind in ("spherical", "bonded")]
    work = solved(run, *scenes)
    hub, found, tilt = work.hub, work.found, work.tilt
    of_beams = errors_by_mesh(run, work)
    kinds = {
        "spherical": work.spherical,
        "bonded": work.bonded,
        "bonded, without gearbox": tilt.free,
    }
    for label, one in kinds.items():
        shown.check_solution(page, one, label)
    for label, of_meshes in work.series.items():
        with page.of(kinds[label].scene):
            shown.check_series(page, of_meshes, label)
    check_beams(page, found, of_beams, work.spherical.scene)
    stiffness = bearing_unit_stiffness(work.spherical.response, work.spherical.bearing)
    write_stiffness(run, work.bonded, tilt, stiffness)
    n_steps = hub.loads.shape[0] * hub.loads.shape[1]
    error_band = {
        label: of_beams.band(lambda f, k=k: float(f["beams"][k]))
        for k, label in enumerate(list(PUBLISHED)[1:])
    }
    errors = answered(run, page, work, error_band)
    page.section("Model")
    page.add(*work.pictures)
    result_section(page, hub, found, error_band)
    if errors:
        rows = [*calibrated.stiffness_rows(work.housings), *calibrated.conclusions(errors)]
        calibrated.section(page, rows)
        calibrated.statements_table(page, errors)
    page.section("RMSE by wind speed, turbulence and shear")
    charts.rmse_charts(page, hub.conditions, found.fe, found.pairs)
    page.section("Example time series")
    charts.series_charts(page, hub, found.fe, found.pairs)
    page.section("FE against beam")
    charts.scatter_charts(page, found.fe, found.pairs)
    design_measures.section(run, page, hub, found)
    stiffness_section(page, work, stiffness)
    shown.mesh_section(page, kinds)
    page.text(work.series["bonded"].note())
    page.text(
        f"{n_steps:,} load steps were turned into the reactions of two models in "
        f"{found.seconds:.2f} s: one matrix product each."
    )
    shown.assume(page, work.bonded.scene)
    page.assume_all(assumptions())
    page.data("mean_error_percent", found.mean_error)
    page.data("correlation", found.correlation)
    page.data("tilt_stiffness", tilt.by_plane)
    page.data("load_steps", n_steps)
    page.data("seconds_for_reactions", found.seconds)


def write_stiffness(run: Run, bonded: Assembly, tilt: SeatStiffness, stiffness: Floats) -> None:
    """The 6x6 stiffnesses of both bearing units, for other programs."""
    name = bonded.bearing
    centre = bonded.response.positions[name]
    write_stiffness_json(
        run.folder / "stiffness.json",
        bonded.scene.title,
        [
            stiffness_matrix(
                f"{name}, bonded: bearing and housing",
                tilt.matrix,
                centre,
                "condensed at the bearing's centre, gearbox springs removed, base fixed",
            ),
            stiffness_matrix(
                f"{name}, spherical: bearing and housing",
                stiffness,
                centre,
                "from the strain energy of bearing and housing; the joint leaves rotations free",
            ),
        ],
        bonded.response.diagnostics.n_unknowns,
        tilt.by_plane,
    )
