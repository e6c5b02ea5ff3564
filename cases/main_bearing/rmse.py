"""The main-bearing study: beams against FE over 144 ten-minute hub-load histories.

Three comparisons, as in the thesis: pinned beam against spherical FE, pinned beam against bonded
FE, torsional-spring beam against bonded FE; and a fourth, a beam on the full 6x6 stiffness.
"""

import numpy as np

from fe_drivetrain.beam import beam_of_scene, main_bearing_beam, shaft
from fe_drivetrain.cases import case
from fe_drivetrain.cases.main_bearing import (
    bands,
    design_measures,
    general,
    loads,
    reactions,
    shown,
    study,
)
from fe_drivetrain.cases.main_bearing.comparison import (
    MEAN_ERROR,
    PUBLISHED,
    SIXBYSIX,
    THESIS,
    Comparison,
    compared,
    of_one_mesh,
)
from fe_drivetrain.cases.main_bearing.study import Solved, Tilt
from fe_drivetrain.commands import own_loads, studied
from fe_drivetrain.common import Floats, InputError
from fe_drivetrain.export import stiffness_matrix, write_stiffness_json
from fe_drivetrain.response import bearing_unit_stiffness
from fe_drivetrain.scene import Scene
from fe_drivetrain.suite import Page, Record, Run

OF_THESIS = (
    ". The thesis's stand beside them for orientation: its hub loads and its housing are not public"
)


def deflections(solved: Solved, matrix: Floats, series: bands.Series, label: str) -> list[Record]:
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
        source="FE of this study" + ("" if page.subject else "; the thesis reports 1.61 %"),
        band=of_beams.band(lambda f: float(f["beams"][1])),
    )
    if np.isfinite(found.correlation[third]):  # a load that never changes has no correlation
        page.at_least(
            f"{third}: correlation of the resultant",
            found.correlation[third],
            0.999,
            why="asked of the torsional-spring model: above 0.999",
            source="FE of this study" + ("" if page.subject else "; the thesis reports 0.9996"),
            band=of_beams.band(lambda f: float(f["beams"][2])),
        )


def result_section(
    page: Page, hub: loads.HubLoads, found: Comparison, error_band: dict[str, float | None]
) -> None:
    """Loads, errors over all histories, and what they come from."""
    page.section("Result")
    page.text(hub.statement)
    loads.load_table(page, hub)
    columns = [c for c in found.headline[0] if not (page.subject and c in THESIS)]
    place = columns.index(MEAN_ERROR) + 1
    page.table(
        "Resultant radial force on the main bearing over all histories: mean of each history's "
        "value" + ("" if page.subject else OF_THESIS),
        [{**row, f"± {MEAN_ERROR}": error_band.get(row["comparison"])} for row in found.headline],
        [*columns[:place], f"± {MEAN_ERROR}", *columns[place:]],
    )
    page.text(
        "Mean error is |F_beam - F_FE| / |F_FE| averaged over samples"
        + ("" if page.subject else ", the thesis's metric")
        + "; it breaks down where the reference passes zero, so samples with a reference below "
        "0.1 % of its rms are left out and counted, and a robust measure stands beside it."
    )
    if not page.subject:
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


def over_loads(run: Run, page: Page, scene: Scene) -> None:
    """The general study: every level against FE over the loads, each history with its own time.

    Raises
    ------
    InputError
        A setting is of the comparison with closed forms alone.
    """
    for key in ("self_weight", "solver"):
        if key in run.settings:
            raise InputError(
                f"{key} is a setting of the comparison with closed forms, which do not apply to "
                f"scene {scene.title!r}: leave it out"
            )
    skip = loads.skip_of(run)
    own = own_loads(str(run.settings["loads"]), skip, scene) if "loads" in run.settings else None
    studied(run, page, scene, own)


@case(
    "Main-bearing study: beam models against FE over hub-load histories",
    source="Stirling 2023, PhD thesis, chapter 3 (Figures 3.6 to 3.15, Table 3.1, Eq 3.1-3.19)",
    settings={
        "scene": "FILE (otherwise of the library)",
        "loads": "FILES (otherwise made for the study)",
        "skip": "0 (seconds of loads, from 0)",
        "self_weight": "true (or false)",
        "solver": "auto (or superlu, cholmod, pardiso, multigrid, schwarz, petsc, petsc-mumps)",
    },
    changes="scene",
)
def run(run: Run, page: Page) -> None:
    """Make or read the hub loads, solve both scenes, compare over all histories."""
    other = general.general_scene(run, page, "bonded")
    if other is not None:
        over_loads(run, page, study.any_scene(run, "bonded"))
        return
    try:
        # before the work: a fault in a file is reported at once
        given = loads.own_hub_loads(run, study.any_scene(run, "bonded"))
    except loads.UnequalHistoriesError:
        scene = study.any_scene(run, "bonded")
        page.subject = scene.title
        page.note(
            "On the general beam, over all load steps by the time that each stands for: the "
            "histories differ in length, and the closed forms are compared history by history."
        )
        over_loads(run, page, scene)
        return
    spherical_scene = study.scene_of(run, page, "spherical")
    bonded_scene = study.scene_of(run, page, "bonded")
    pinned_beam = main_bearing_beam(spherical_scene)  # refuses early what it cannot stand for
    self_weight = reactions.has_self_weight(run)
    with run.side_by_side(7) as jobs:
        solving = jobs.start(
            study.solve_and_write, spherical_scene, "spherical", None, "mesh_spherical"
        )
        # beside the first solid, which compiles loops: two at once would compile each of them twice
        making = loads.start_surrogate(run, jobs) if given is None else []
        meshed = study.mesh_of(run, bonded_scene, "bonded")
        solving_bonded = jobs.start(
            study.solve_and_write, bonded_scene, "bonded", meshed, "mesh_bonded"
        )
        tilting = jobs.start(study.solve_tilt, bonded_scene, "bonded, no gearbox", meshed)
        coarser = bands.start(jobs, spherical_scene, "spherical")
        coarser_bonded = bands.start(jobs, bonded_scene, "bonded", tilted=True)
        hub = loads.surrogate_hub_loads(run, making) if given is None else given
        spherical = solving.result()
        mean_load = np.zeros(10)
        mean_load[:6] = hub.loads.mean(axis=(0, 1))
        mean_load[9] = bonded_scene.gearbox.weight
        drawing = jobs.start(
            shown.pictures_of, spherical, mean_load, "the mean hub load of all histories"
        )
        bonded, tilt = solving_bonded.result(), tilting.result()
        found = compared(run, hub, pinned_beam, spherical, bonded, tilt)
        pictures = drawing.result()
        series = {
            "spherical": coarser.below(bands.of_solved(spherical)),
            "bonded": coarser_bonded.below(bands.of_solved(bonded) | bands.of_tilt(tilt)),
        }
    name = bonded.bearing
    kinds = {"spherical": spherical, "bonded": bonded}
    if not hub.conditions:
        reactions.write_files(run.folder, hub, kinds, self_weight)
    page.seed = hub.seed
    mean_error, correlation = found.mean_error, found.correlation
    _, second, third = PUBLISHED
    with run.step("bands of the mean errors"):
        by_mesh = [
            of_one_mesh(hub, bonded_scene, f[f"reaction {name}"], f["K_R"][:, 1])
            for f in series["bonded"].levels[:-1]
        ]
    by_mesh.append((mean_error[second], mean_error[third], correlation[third]))
    sizes = [f["size"] for f in series["bonded"].levels]
    of_beams = bands.Series(
        tuple(
            {"beams": np.array(row), "size": size} for row, size in zip(by_mesh, sizes, strict=True)
        )
    )
    error_band = {
        label: of_beams.band(lambda f, k=k: float(f["beams"][k]))
        for k, label in enumerate((second, third))
    }
    for label, solved in (
        ("spherical", spherical),
        ("bonded", bonded),
        ("bonded, without gearbox", tilt.free),
    ):
        shown.check_solution(page, solved, label)
    for label, of_meshes in series.items():
        with page.of(kinds[label].scene):
            shown.check_series(page, of_meshes, label)
    check_beams(page, found, of_beams, spherical_scene)

    stiffness = bearing_unit_stiffness(spherical.response, name)
    write_stiffness(run, bonded, tilt, stiffness)
    n_histories, n_samples = hub.loads.shape[:2]
    n_steps = n_histories * n_samples
    on_bonded = (
        f"Over {n_histories:,} hub-load histor{'y' if n_histories == 1 else 'ies'} "
        f"({n_steps:,} load steps) the pinned beam's resultant force on a bonded bearing has a "
        f"mean error of {mean_error[second]:.1f} %, with a correlation of "
        f"{correlation[second]:.3f}.",
        f"With torsional springs, K_R from the averaged seat, the beam has a mean error of "
        f"{mean_error[third]:.2g} % and a correlation of {correlation[third]:.4f}; on the "
        f"full 6x6 stiffness {mean_error[SIXBYSIX]:.2g} % and {correlation[SIXBYSIX]:.6f}.",
    )
    on_spherical = (
        "On a spherical bearing pinned beam and FE agree to solver accuracy: statics decide, and "
        "their agreement says nothing about the FE model. Deflection, slope and stiffness, which "
        "do depend on it, stand below.",
    )
    # the bearing that the scene has comes first
    own_kind = study.kind_of(study.given_scene(run, "bonded"))
    page.headline = "torsional-spring beam against bonded FE: mean error of the resultant"
    page.answer(
        *(on_spherical + on_bonded if own_kind == "spherical" else on_bonded + on_spherical)
    )
    page.section("Model")
    page.add(*pictures)
    result_section(page, hub, found, error_band)
    reactions.statistics_section(run, page, hub, kinds, self_weight)
    if hub.conditions:
        page.section("RMSE by wind speed, turbulence and shear")
        loads.rmse_charts(page, hub.conditions, found.fe, found.pairs)
    page.section("Example time series")
    loads.series_charts(page, hub, found.fe, found.pairs)
    page.section("FE against beam")
    loads.scatter_charts(page, found.fe, found.pairs)
    design_measures.section(run, page, hub, found)
    page.section("What reactions do not show: stiffness, deflection, slope")
    shown.tilt_table(page, tilt, series["bonded"])
    page.table(
        "The torsional-spring beam with K_R of each estimator, against bonded FE; no value is "
        "fitted",
        found.estimators,
    )
    page.table(
        "Under Fz = 1 kN at the hub: FE, and Timoshenko beams on the FE stiffness of the bearing "
        "unit. The ring stiffens the shaft; the 6x6 of the bonded unit holds its share already, so "
        "there the beam with a ring counts it twice",
        [
            *deflections(spherical, stiffness, series["spherical"], "spherical"),
            *deflections(bonded, tilt.matrix, series["bonded"], "bonded"),
        ],
    )
    shown.matrix_table(
        page,
        "Condensed stiffness of the bonded bearing unit at the bearing's centre; "
        + series["bonded"].largest("stiffness"),
        tilt.matrix,
    )
    shown.mesh_section(
        page, {"spherical": spherical, "bonded": bonded, "bonded, no gearbox": tilt.free}
    )
    page.text(series["bonded"].note())
    page.text(
        f"{n_steps:,} load steps were turned into the reactions of two models in "
        f"{found.seconds:.2f} s: one matrix product each."
    )
    shown.assume(page, bonded_scene)
    for assumption in hub.assumptions:
        page.assume(*assumption)
    page.data("mean_error_percent", mean_error)
    page.data("correlation", correlation)
    page.data("tilt_stiffness", tilt.by_plane)
    page.data("load_steps", n_steps)
    page.data("seconds_for_reactions", found.seconds)


def write_stiffness(run: Run, bonded: Solved, tilt: Tilt, stiffness: Floats) -> None:
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
