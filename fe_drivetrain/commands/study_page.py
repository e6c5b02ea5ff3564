"""A study of any scene on a page: K_R, reactions over load histories, and beams against FE."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from fe_drivetrain.commands.scene_page import describe
from fe_drivetrain.commands.study_errors import errors
from fe_drivetrain.commands.study_loads import StudyLoads, surrogate_loads
from fe_drivetrain.commands.study_reactions import STATISTICS, reactions, write_reactions
from fe_drivetrain.commands.uncertainty_page import bands, inputs
from fe_drivetrain.commands.uncertainty_page import slopes as slopes_section
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.compare.time_weighted import weighted_statistics
from fe_drivetrain.export.formats.stiffness_file import stiffness_matrix, write_stiffness_json
from fe_drivetrain.export.formats.summary import summary, write_summary
from fe_drivetrain.fidelity.foot_opening import foot_warnings
from fe_drivetrain.fidelity.over_loads import (
    Levels,
    imbalance,
    levels_of,
    reaction_history,
)
from fe_drivetrain.fidelity.quantities import UNIT, unit_numbers
from fe_drivetrain.histories.damage import SLOPES
from fe_drivetrain.mesh.files import write
from fe_drivetrain.report.charts import trace
from fe_drivetrain.report.pictures import NoPictureError, picture_of_model
from fe_drivetrain.report.solid_view import deformed_shape
from fe_drivetrain.response.cached import cached_response
from fe_drivetrain.response.entering import Factors, entering, joined
from fe_drivetrain.response.model import Model
from fe_drivetrain.response.unit_loads import Response
from fe_drivetrain.scene.left_out import left_out
from fe_drivetrain.scene.scene import Scene
from fe_drivetrain.scene.without_weight import weightless
from fe_drivetrain.studies.scene_description import checked_model, description, quick_scene
from fe_drivetrain.suite.page import Page
from fe_drivetrain.suite.records import Record
from fe_drivetrain.suite.run import Run
from fe_drivetrain.uncertainty.input_study import study
from fe_drivetrain.uncertainty.numbers import figures

_SAMPLES, _QUICK_SAMPLES = 128, 40
_SHOWN = 60.0  # seconds of a chart over time


def studied(
    run: Run,
    page: Page,
    scene: Scene,
    own: StudyLoads | None,
    slopes: Sequence[float] = SLOPES,
    weight: bool = True,
) -> None:
    """Stiffness of the bearing units, reactions over all loads, and levels against the assembly.

    Parameters
    ----------
    run : Run
        The run; its folder takes pictures and CSV files.
    page : Page
        Takes tables and charts.
    scene : Scene
        Any scene that the library solves.
    own : StudyLoads or None
        The user's hub loads; the surrogate's where None.
    slopes : sequence of float
        Of S-N curves, for damage-equivalent loads.
    weight : bool
        Whether the reactions have the weight of all parts.

    Raises
    ------
    InputError
        The scene cannot be solved.
    """
    page.about(scene)
    scene = quick_scene(scene) if run.quick else scene
    scene = scene if weight else weightless(scene)
    model = checked_model(run, scene)
    loads = surrogate_loads(run) if own is None else own
    loads = loads if weight else replace(loads, gravity=0.0)
    page.seed = None if loads.own else 1
    with run.step("assembly of solids") as step:
        response = cached_response(model)
        if response.kept:
            step.name += ", from the cache"
    with run.step("levels 1 and 2"):
        levels = levels_of(scene, response, run.report)
    driving = joined([entering(scene, history) for history in loads.histories])
    mean = weighted_statistics(driving.values, loads.weights)[:, 1]
    factors = np.concatenate([mean[:6], [0.0, 0.0, -loads.gravity, scene.gearbox.weight], mean[6:]])
    _check(page, scene, response, levels)

    if run.quick:
        page.answer(
            "Quick: on a coarser mesh than the scene's, for a first look; figures will change."
        )
    opening = foot_warnings(scene, response, driving, loads.weights, loads.gravity)
    page.answer(loads.statement, *model.warnings, *opening)
    page.section("Scene")
    _pictures(run, page, model, response, factors)
    page.assume_all(left_out(scene))
    describe(page, description(model))
    if scene.bearing_units:
        page.section("Stiffness of the bearing units")
        _stiffness(run, page, model, response, levels)
    with run.step("reactions of all load steps"):
        reactions(run, page, model, loads, levels, slopes)
    with run.step("beams against FE"):
        level = errors(page, scene, levels, loads, slopes)
        _series(page, scene, loads, levels)
    if scene.uncertainty:
        _uncertainty(run, page, scene, level, Factors(factors))
    with run.step("files"):
        _files(run, page, model, response, loads, levels)
    for assumption in loads.assumptions:
        page.assume(*assumption)


def _uncertainty(run: Run, page: Page, scene: Scene, level: int, load: Factors) -> None:
    """What the spreads that the scene states do to stiffnesses and bearing forces."""
    asked = [f"{name}.Fz" for name in scene.bearing_names]
    with run.step("uncertainty"):
        found = study(
            scene,
            asked,
            load,
            level=level,
            count=_QUICK_SAMPLES if run.quick else _SAMPLES,
            report=run.report,
        )
    page.sections += [bands(found), inputs(found), slopes_section(found)]
    page.data("uncertainty", figures(found))
    page.seed = 0 if page.seed is None else page.seed


def _files(
    run: Run, page: Page, model: Model, response: Response, loads: StudyLoads, levels: Levels
) -> None:
    """Exports beside the page, and a list of them."""
    if loads.own:
        write_reactions(run.folder, model, loads, levels)
    write_summary(run.folder / "summary.json", summary(model.scene, 2))
    fields = {
        f"displacement {load}": response.displacements[:, :, k]
        for k, load in enumerate(model.loads)
    }
    write(model.mesh, run.folder / "mesh.vtu", fields)
    page.section("Files")
    page.table(
        "Files of this study",
        [
            {"file": name, "content": content}
            for name, content in (
                (STATISTICS, "reactions of each history: statistics, bands, equivalent loads"),
                *([("reactions_*.csv", "reactions over time")] if loads.own else []),
                *(
                    [("stiffness.json", "6x6 stiffness of each bearing unit, two bounds")]
                    if levels.stiff
                    else []
                ),
                ("summary.json", "shaft, bearing units, reactions, masses of a drivetrain model"),
                ("mesh.vtu", "the assembly with its unit-load displacements, for ParaView"),
            )
        ],
    )
    page.text("'fe-drivetrain export' writes the model for other programs.")


def _check(page: Page, scene: Scene, response: Response, levels: Levels) -> None:
    page.vanishes(
        "assembly: total equilibrium, applied less reacted",
        response.equilibrium_error,
        within=1e-8,
        why="reactions come from the residual on constrained degrees of freedom: solver accuracy",
        source="exact",
    )
    page.vanishes(
        "assembly: linearity, a random load solved directly against superposed",
        response.superposition_error,
        within=1e-8,
        why="the scene is linear: solver accuracy",
        source="exact",
    )
    worst = max(imbalance(scene, model) for model in levels.models.values())
    page.vanishes(
        "every level: reactions to unit hub loads balance the load, the worst",
        worst,
        within=1e-6,
        why="each level must be in equilibrium, whatever its stiffness",
        source="statics",
    )


def _pictures(run: Run, page: Page, model: Model, response: Response, factors: Floats) -> None:
    weights = " and all weights" if factors[8] else ""
    with run.step("pictures"):
        try:
            picture_of_model(model, run.folder / "model.png")
            shape = deformed_shape(model, response, factors, run.folder, f"the mean load{weights}")
        except NoPictureError as reason:
            page.text(f"No picture: {reason}")
            return
    page.image(f"{model.scene.title}: parts, loads and supports", "model.png")
    page.add(shape)


def _stiffness(run: Run, page: Page, model: Model, response: Response, levels: Levels) -> None:
    """K_R and the other stiffnesses of each unit between two bounds, on the page and as JSON."""
    rows: list[Record] = []
    for name, stiff in levels.stiff.items():
        high, low = unit_numbers(stiff), unit_numbers(levels.soft[name])
        for quantity, component in UNIT.items():
            if high[quantity] == 0.0:
                continue
            rows.append(
                {
                    "bearing": name,
                    "quantity": {"tilt": "K_R about y", "yaw": "K_R about z"}.get(
                        quantity, quantity.replace("_", " along ")
                    ),
                    "unit": "MN/m" if component < 3 else "MN\u00a0m/rad",
                    "face on average (soft)": low[quantity] / 1e6,
                    "face in shape (stiff)": high[quantity] / 1e6,
                    "range [%]": 100.0 * (high[quantity] / low[quantity] - 1.0),
                    "mesh: less by up to [%]": 100.0 * levels.unit_mesh[name],
                }
            )
    page.table(
        "Bearing, housing and bedplate without the shaft: the shaft keeps the face between them in "
        "shape, but not wholly, so that the truth is between two bounds (equal where the joint "
        "itself says how its faces move). The mesh makes both too stiff by up to the last column. "
        "Force over motion, all other loads zero",
        rows,
    )
    free = {name: unit_numbers(stiff) for name, stiff in levels.stiff.items()}
    aligning = [name for name, of in free.items() if of["tilt"] == of["yaw"] == 0.0]
    floating = [name for name, of in free.items() if of["axial"] == 0.0]
    if aligning:
        page.text(f"No K_R of {', '.join(aligning)}: the bearing gives way to tilt.")
    if floating:
        page.text(
            f"No axial stiffness of {', '.join(floating)}: the bearing floats, and leaves axial "
            "force to the others at every level."
        )
    page.data("unit_stiffness", rows)
    write_stiffness_json(
        run.folder / "stiffness.json",
        model.scene.title,
        [
            stiffness_matrix(
                f"{name}, {bound}",
                matrices[name],
                response.positions[name],
                "bearing, housing and bedplate in series at the bearing's centre",
            )
            for bound, matrices in (("stiff", levels.stiff), ("soft", levels.soft))
            for name in matrices
        ],
        response.diagnostics.n_unknowns,
    )


def _series(page: Page, scene: Scene, loads: StudyLoads, levels: Levels) -> None:
    """The beginning of the middle history: radial force of each bearing, FE and beams."""
    page.section("Over time")
    history = loads.histories[len(loads.histories) // 2]
    shown = history.time - history.time[0] <= _SHOWN
    (*_, beams) = [models for level, models in levels.bounds.items() if level.startswith("1")]
    labels = ["assembly", *beams]
    with_weights = " with all weights" if loads.gravity else ""
    for name in scene.bearing_names:
        traces = []
        for label, dash in zip(labels, ("solid", "dash", "dot"), strict=False):
            reaction = reaction_history(
                levels.models[label],
                name,
                entering(scene, history)[shown],
                scene.gearbox.weight,
                loads.gravity,
            )
            force = np.hypot(reaction[:, 1], reaction[:, 2]) / 1e3
            traces.append(trace(label, history.time[shown], force, line={"dash": dash}))
        page.chart(
            f"Radial force on {name}{with_weights}: the beginning of {history.name}",
            traces,
            "time [s]",
            "radial force [kN]",
        )
