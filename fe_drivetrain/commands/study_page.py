"""A study of any scene on a page: K_R, reactions over load histories, and beams against FE."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from fe_drivetrain.commands.scene_page import checked_model, describe, quick_scene
from fe_drivetrain.commands.study_loads import StudyLoads, surrogate_loads
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import FORCES, GRAVITY
from fe_drivetrain.compare.statistics import rmse
from fe_drivetrain.export.formats.stiffness_file import stiffness_matrix, write_stiffness_json
from fe_drivetrain.fidelity.over_loads import (
    Levels,
    imbalance,
    levels_of,
    reaction_history,
    relative_errors,
)
from fe_drivetrain.fidelity.quantities import UNIT, unit_numbers
from fe_drivetrain.fidelity.shaft_bands import COARSER
from fe_drivetrain.report.charts import trace
from fe_drivetrain.report.pictures import (
    NoPictureError,
    picture_of_deformation,
    picture_of_model,
)
from fe_drivetrain.response.model import Model
from fe_drivetrain.response.unit_loads import Response, unit_load_response
from fe_drivetrain.scene.scene import Scene
from fe_drivetrain.suite.page import Page
from fe_drivetrain.suite.records import Record
from fe_drivetrain.suite.run import Run

_ENOUGH = 0.05  # of the root mean square: what the summary takes for accurate enough
_COMPARED = (
    "beam, rigid housings",
    "beam, stiff housings",
    "beam, soft housings",
    "meridian, stiff housings",
    "meridian, soft housings",
)
_ROUND_OFF = 1e-9  # of a reaction's largest component: shown as zero
_SHOWN = 60.0  # seconds of a chart over time
_UNITS = 3 * ("N",) + 3 * ("N m",)
_SHOWN_UNITS = 3 * ("kN",) + 3 * ("kN\u00a0m",)
_FRAME = "x downwind along the shaft, z up, y = z cross x; does not turn with the rotor"


def studied(run: Run, page: Page, scene: Scene, own: StudyLoads | None) -> None:
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

    Raises
    ------
    InputError
        The scene cannot be solved.
    """
    scene = quick_scene(scene) if run.quick else scene
    model = checked_model(run, scene)
    loads = surrogate_loads(run) if own is None else own
    page.seed = None if loads.own else 1
    with run.step("assembly of solids"):
        response = unit_load_response(model)
    with run.step("levels 1 and 2"):
        levels = levels_of(scene, response, run.report)
    hub = np.concatenate([history.loads for history in loads.histories])
    _check(page, scene, response, levels)

    if run.quick:
        page.answer(
            "Quick: on a coarser mesh than the scene's, for a first look; figures will change."
        )
    page.answer(loads.statement, *model.warnings)
    page.section("Scene")
    _pictures(run, page, model, response, hub.mean(axis=0))
    describe(page, model)
    page.section("Stiffness of the bearing units")
    _stiffness(run, page, model, response, levels)
    with run.step("reactions of all load steps"):
        _reactions(run, page, model, loads, levels)
        _errors(page, scene, levels, hub)
        _series(page, scene, loads, levels)
    if loads.own:
        with run.step("files of reactions"):
            _write_reactions(run.folder, model, loads, levels)
    for assumption in loads.assumptions:
        page.assume(*assumption)


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


def _pictures(run: Run, page: Page, model: Model, response: Response, mean: Floats) -> None:
    factors = np.zeros(10)
    factors[:6], factors[8], factors[9] = mean, -GRAVITY, model.scene.gearbox.weight
    with run.step("pictures"):
        try:
            picture_of_model(model, run.folder / "model.png")
            times = picture_of_deformation(model, response, factors, run.folder / "deformed.png")
        except NoPictureError as reason:
            page.text(f"No picture: {reason}")
            return
    page.image(f"{model.scene.title}: parts, loads and supports", "model.png")
    page.image(
        f"Deformed {times:,.0f} times too large, under the mean hub load and all weights",
        "deformed.png",
    )


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
                }
            )
    page.table(
        "Bearing, housing and bedplate without the shaft: the shaft keeps the face between them in "
        "shape, but not wholly, so that the truth is between two bounds (equal where the joint "
        "itself says how its faces move). Force over motion, all other loads zero",
        rows,
    )
    spherical = [
        unit.bearing.name
        for unit in model.scene.bearing_units
        if unit_numbers(levels.stiff[unit.bearing.name])["tilt"] == 0.0
    ]
    if spherical:
        page.text(f"{', '.join(spherical)}: a spherical joint has no K_R.")
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


def _weights(model: Model) -> str:
    """Which weights the reactions have."""
    parts = ", ".join(
        f"{part} {GRAVITY * float(mass.sum()) / 1e3:.4g} kN"
        for part, mass in model.part_mass.items()
    )
    return (
        f"included along -z: {parts}, gearbox {model.scene.gearbox.weight / 1e3:.4g} kN; "
        "that of the rotor as far as the hub loads have it"
    )


def _origins(model: Model) -> str:
    places = [f"{u.bearing.name} at x = {u.bearing.x:g} m" for u in model.scene.bearing_units]
    places.append(f"gearbox at x = {model.scene.shaft.rear:g} m")
    return f"on the shaft's axis: {', '.join(places)}"


def _reactions(run: Run, page: Page, model: Model, loads: StudyLoads, levels: Levels) -> None:
    """Extremes, means and standard deviations of every reaction, of all and of each history."""
    page.section("Reactions")
    page.text(
        f"What the drivetrain puts on its surroundings. Weight {_weights(model)}. Frame: {_FRAME}. "
        f"Origins of moments {_origins(model)}."
    )
    rows: list[Record] = []
    weight = model.scene.gearbox.weight
    with (run.folder / "reaction_statistics.csv").open("w", encoding="utf-8", newline="") as file:
        for fact in (
            f"frame = {_FRAME}",
            f"origin of moments = {_origins(model)}",
            f"weight = {_weights(model)}",
            f"loads = {loads.statement}",
        ):
            file.write(f"# {fact}\n")
        table = csv.writer(file, lineterminator="\n")
        table.writerow(
            ["history", "reaction", "component", "unit", "least", "mean", "largest", "std"]
        )
        for name in levels.reference.reaction_matrices:
            found = [
                reaction_history(levels.reference, name, history.loads, weight, GRAVITY)
                for history in loads.histories
            ]
            whole = _statistics(np.concatenate(found))
            names = ["all", *(history.name for history in loads.histories)]
            for history, numbers in zip(names, [whole, *map(_statistics, found)], strict=True):
                for component, unit, row in zip(FORCES, _UNITS, numbers, strict=True):
                    table.writerow([history, name, component, unit, *(f"{v:.9g}" for v in row)])
            shown = np.where(np.abs(whole) < _ROUND_OFF * np.abs(whole).max(), 0.0, whole) / 1e3
            for component, unit, row in zip(FORCES, _SHOWN_UNITS, shown, strict=True):
                least, mean, largest, deviation = row.tolist()
                rows.append(
                    {
                        "reaction": name,
                        "component": f"{component} [{unit}]",
                        "least": least,
                        "mean": mean,
                        "largest": largest,
                        "standard deviation": deviation,
                    }
                )
    page.table("Reactions of the assembly over all load steps", rows)
    page.text(
        "By history: reaction_statistics.csv"
        + ("; over time: reactions_*.csv." if loads.own else ".")
    )
    page.data("reactions_kN", rows)


def _statistics(reaction: Floats) -> Floats:
    """(6, 4) least, mean, largest and standard deviation of (n, 6) samples."""
    return np.column_stack(
        [reaction.min(axis=0), reaction.mean(axis=0), reaction.max(axis=0), reaction.std(axis=0)]
    )


def _errors(page: Page, scene: Scene, levels: Levels, hub: Floats) -> None:
    """RMSE of each level against the assembly, and the cheapest level that is enough."""
    page.section("Beams against FE")
    others = list(levels.models)[:-1]
    weight, length = scene.gearbox.weight, scene.shaft.length
    worst = dict.fromkeys(others, 0.0)
    absolute: list[Record] = []
    relative: list[Record] = []
    for name in levels.reference.reaction_matrices:
        reference = reaction_history(levels.reference, name, hub, weight, GRAVITY)
        errors: dict[str, Floats] = {}
        shares: dict[str, Floats] = {}
        for label in others:
            found = reaction_history(levels.models[label], name, hub, weight, GRAVITY)
            errors[label] = rmse(reference.T, found.T)
            shares[label] = relative_errors(reference, found, length)
            worst[label] = max(worst[label], float(np.nanmax(shares[label])))
        size = np.sqrt((reference**2).mean(axis=0))
        for k, kind in enumerate(("force", "moment")):
            if np.isnan(shares[others[0]][k]):
                continue
            relative.append(
                {
                    "reaction": f"{name}, {kind}",
                    **{label: 100.0 * shares[label][k] for label in others},
                }
            )
            for c in range(3 * k, 3 * k + 3):
                absolute.append(
                    {
                        "reaction": f"{name}, {FORCES[c]} [{_SHOWN_UNITS[c]}]",
                        "rms of FE": size[c] / 1e3,
                        **{label: errors[label][c] / 1e3 for label in others},
                    }
                )
    page.table(
        "Error of each reaction as a vector over all load steps: root mean square of the "
        "difference to the assembly over that of the assembly's [%]",
        relative,
    )
    page.table("RMSE of each component against the assembly over all load steps", absolute)
    note = "Stiff and soft housings are the two bounds of the bearing units. "
    if len(others) == len(_COMPARED):
        note += f"The mesh cannot be {COARSER:g} times coarser, so its own error is not shown. "
    else:
        note += (
            f"The assembly on a mesh {COARSER:g} times coarser shows what the mesh does to the "
            "reference: differences as small as that are not errors of a beam. "
        )
    page.text(f"{note}Forces and moments that are the mesh's noise are left out.")
    page.data("error_percent", relative)
    page.data("rmse_kN", absolute)
    page.answer(_enough(worst))


def _enough(worst: dict[str, float]) -> str:
    """The cheapest level whose reactions are all within the tolerance, for either bound."""
    share = f"{100 * _ENOUGH:g} %"
    for labels in (_COMPARED[:1], _COMPARED[1:3], _COMPARED[3:]):
        largest = max(worst[label] for label in labels)
        if largest <= _ENOUGH:
            return (
                f"Over these loads {' and '.join(labels)}: every reaction is within {share} of the "
                f"assembly's (root mean square of force and of moment; the worst "
                f"{100 * largest:.2g} %)."
            )
    best = min(_COMPARED, key=lambda label: worst[label])
    return (
        f"Over these loads no level below the assembly has every reaction within {share} of it; "
        f"the nearest, {best}, has {100 * worst[best]:.2g} %."
    )


def _series(page: Page, scene: Scene, loads: StudyLoads, levels: Levels) -> None:
    """The beginning of the middle history: radial force of each bearing, FE and beams."""
    page.section("Over time")
    history = loads.histories[len(loads.histories) // 2]
    shown = history.time - history.time[0] <= _SHOWN
    labels = ["assembly", "beam, stiff housings", "beam, soft housings"]
    for unit in scene.bearing_units:
        name = unit.bearing.name
        traces = []
        for label, dash in zip(labels, ("solid", "dash", "dot"), strict=True):
            reaction = reaction_history(
                levels.models[label],
                name,
                history.loads[shown],
                scene.gearbox.weight,
                GRAVITY,
            )
            force = np.hypot(reaction[:, 1], reaction[:, 2]) / 1e3
            traces.append(trace(label, history.time[shown], force, line={"dash": dash}))
        page.chart(
            f"Radial force on {name} with all weights: the beginning of {history.name}",
            traces,
            "time [s]",
            "radial force [kN]",
        )


def _write_reactions(folder: Path, model: Model, loads: StudyLoads, levels: Levels) -> None:
    """Every reaction of the assembly over time, one file a history."""
    names: Sequence[str] = list(levels.reference.reaction_matrices)
    for history in loads.histories:
        facts = {
            "history": history.name,
            "reactions": "what the drivetrain puts on its surroundings, by the assembly of solids",
            "frame": _FRAME,
            "origin of moments": _origins(model),
            "weight": _weights(model),
            "channels": history.attributes.get("channels", "as in the file"),
        }
        columns = ["time [s]"]
        columns += [
            f"{name} {component} [{unit}]"
            for name in names
            for component, unit in zip(FORCES, _UNITS, strict=True)
        ]
        reactions = [
            reaction_history(
                levels.reference, name, history.loads, model.scene.gearbox.weight, GRAVITY
            )
            for name in names
        ]
        np.savetxt(
            folder / f"reactions_{history.name}.csv",
            np.column_stack([history.time, *reactions]),
            delimiter=",",
            fmt="%.9g",
            header="\n".join([*(f"# {f} = {v}" for f, v in facts.items()), ",".join(columns)]),
            comments="",
            encoding="utf-8",
        )
