"""Scenes that no closed form stands for, on the general beam: several bearings, stepped shafts.

The questions are those of the cases; what a closed form of one bearing on a uniform shaft answers
there, a Timoshenko beam on the bearing units' own stiffness answers here, between their two bounds.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from fe_drivetrain.beam import main_bearing_beam
from fe_drivetrain.cases.main_bearing import shown, study
from fe_drivetrain.cases.main_bearing.secants import Cases
from fe_drivetrain.cases.main_bearing.study import Solved
from fe_drivetrain.common import FORCES, Floats, InputError
from fe_drivetrain.compare import resultant
from fe_drivetrain.coupled import factors_of
from fe_drivetrain.fidelity import (
    Levels,
    UnitBounds,
    imbalance,
    levels_of,
    shaft_level,
    statics_level,
    unit_bounds,
)
from fe_drivetrain.hub_loads import Condition, hub_loads
from fe_drivetrain.report import trace
from fe_drivetrain.response import LOADS, entering, secant_stiffness
from fe_drivetrain.scene import Scene, change_scene
from fe_drivetrain.suite import Page, Record, Run

#: Reactions in bending to unit hub loads, (component, load).
BENDING = ((2, 2), (2, 4), (4, 2), (4, 4), (1, 1), (1, 5), (5, 1), (5, 5))
RIGID, STIFF, SOFT = "beam, rigid housings", "beam, stiff housings", "beam, soft housings"
#: Share of a column's largest below which an entry is the mesh's asymmetry.
_SMALL = 1e-4

_KINDS = {"spherical": ("spherical", "sliding"), "bonded": ("ring", "bonded")}


def general_scene(
    run: Run, page: Page, kind: str, exchange: bool = False, uniform: bool = True
) -> Scene | None:
    """The user's scene, where no closed form stands for it; None where one does.

    Parameters
    ----------
    kind : str
        Of the library's scene where none is given: "spherical" or "bonded".
    exchange : bool
        Whether every bearing is made of that kind; the page says so first.
    uniform : bool
        Whether the case needs a uniform shaft, and not one bearing alone.
    """
    scene = study.any_scene(run, kind)
    reason = _reason(scene, uniform)
    if not reason:
        return None
    page.subject = scene.title
    page.source = f"scene {run.settings.get('scene', 'of the library, changed')}"
    page.note(f"On the general beam, since the closed forms do not apply: {reason}.")
    if exchange:
        before = [unit.interface for unit in scene.bearing_units]
        scene = _with_kind(scene, kind)
        changed = [
            f"{unit.bearing.name} ({old})"
            for unit, old in zip(scene.bearing_units, before, strict=True)
            if unit.interface != old
        ]
        if changed:
            page.note(
                f"Other bearings: {', '.join(changed)} of the scene made "
                f"{scene.bearing_units[0].interface}, as this case needs."
            )
    if run.quick:
        scene = scene.model_copy(update={"mesh": scene.mesh.scaled(*study.QUICK)})
    return scene


def _reason(scene: Scene, uniform: bool) -> str:
    """Why no closed form stands for a scene; empty where one does."""
    if scene.load_points:
        return f"loads enter at {', '.join(scene.bands)}, too"
    if len(scene.bearing_units) > 1:
        return f"the scene has {len(scene.bearing_units)} bearing units and not one"
    if uniform:
        try:
            main_bearing_beam(scene)
        except InputError as error:
            return str(error).partition(": compare")[0]
    return ""


def _with_kind(scene: Scene, kind: str) -> Scene:
    bearing, interface = _KINDS[kind]
    changes: dict[str, object] = {}
    for k, unit in enumerate(scene.bearing_units):
        if not (kind == "spherical" and unit.interface in study.SPHERICAL):
            at = f"bearing_units.{k}"
            changes |= {f"{at}.bearing.kind": bearing, f"{at}.interface": interface}
            changes |= {f"{at}.stiffness": None, f"{at}.rollers": None}
    return change_scene(scene, changes)


def unit_load_page(run: Run, page: Page, scene: Scene, forms: Sequence[str] = ()) -> None:
    """Reactions of every bearing and motions of the hub to unit loads: FE, and general beams.

    Parameters
    ----------
    scene : Scene
        The scene.
    forms : sequence of str
        Other interfaces of all bearings, beside that of the scene.
    """
    page.about(scene)
    solved = study.solve_scene(run, scene, "scene")
    others = {
        form: study.solve_scene(run, _with_interface(scene, form), form)
        for form in forms
        if form != scene.bearing_units[0].interface
    }
    with run.step("levels 1 and 2"):
        levels = levels_of(scene, solved.response, run.report)
    for label, one in {"scene": solved, **others}.items():
        shown.check_solution(page, one, label)
    check_levels(page, scene, levels)
    check_statics(page, scene, solved)
    rows = reaction_rows(scene, levels)
    page.answer(_nearest(rows))
    page.section("Reactions")
    page.text(
        "Between the stiff and the soft beam lies what the housings' own stiffness leaves open; "
        "± FE is what a coarser mesh changes, continued at first order."
    )
    page.table("Reactions in bending per unit load: FE, and Timoshenko beams", rows)
    for name in levels.reference.reaction_matrices:
        shown.reaction_table(
            page,
            f"Load on {name} for unit loads",
            solved.response.reactions[name],
            solved.model.loads,
        )
    page.section("Deflection and slope of the hub")
    page.table("Motion of the hub for unit loads there", hub_rows(levels, others))
    shown.mesh_section(page, {"scene": solved, **others})
    page.data("reactions", rows)


def _with_interface(scene: Scene, form: str) -> Scene:
    count = len(scene.bearing_units)
    return change_scene(scene, {f"bearing_units.{k}.interface": form for k in range(count)})


def check_levels(page: Page, scene: Scene, levels: Levels) -> None:
    """Whether every level is in balance."""
    page.vanishes(
        "every level: reactions to unit hub loads balance the load, the worst",
        max(imbalance(scene, model) for model in levels.models.values()),
        within=1e-6,
        why="each level must be in equilibrium, whatever its stiffness",
        source="statics",
    )


def check_statics(page: Page, scene: Scene, solved: Solved) -> None:
    """What equilibrium alone decides must be the same in FE."""
    worst, count = 0.0, 0
    for name, matrix in statics_level(scene).reaction_matrices.items():
        exact = matrix[:, :6]
        known = np.isfinite(exact)
        count += int((known & (exact != 0.0)).sum())
        error = np.abs(solved.response.reactions[name][:, :6] - exact)[known]
        size = np.array([1.0, 1.0, 1.0, *3 * (scene.shaft.length,)])
        scale = np.outer(size, 1.0 / size)[known]
        worst = max(worst, float((error / scale).max(initial=0.0)))
    if count:
        page.vanishes(
            f"{count} reactions to unit hub loads that statics decides, FE against statics",
            worst,
            within=1e-6,
            why="solver accuracy; the nodes of a curved raceway meet at its centre to the mesh's "
            "order",
            source="statics: what has no stiffness in it",
        )


def reaction_rows(scene: Scene, levels: Levels) -> list[Record]:
    """Reactions in bending, FE with its band, and beams."""
    rows: list[Record] = []
    for name, matrix in levels.reference.reaction_matrices.items():
        size = np.abs(matrix).max(axis=0)
        pairs = [
            (component, place, load)
            for place in range(1 + len(scene.load_points))
            for component, load in BENDING
        ]
        for component, place, load_at in pairs:
            # loads at points follow those of every scene, six by six
            load = load_at if place == 0 else len(LOADS) + 6 * (place - 1) + load_at
            value = float(matrix[component, load])
            if abs(value) < _SMALL * size[load]:
                continue
            beams = {
                label: float(levels.models[label].reaction_matrices[name][component, load])
                for label in (RIGID, STIFF, SOFT)
            }
            rows.append(
                {
                    "reaction": f"{name} {FORCES[component]} per {FORCES[load_at]} at "
                    + ("the hub", *scene.bands)[place],
                    "FE": value,
                    "± FE": _band(levels, name, component, load),
                    **beams,
                    **{
                        f"{label} against FE [%]": 100.0 * (beam / value - 1.0)
                        for label, beam in beams.items()
                    },
                }
            )
    return rows


def _band(levels: Levels, name: str, component: int, load: int) -> float | None:
    if levels.coarser is None:
        return None
    both = [m.reaction_matrices[name][component, load] for m in (levels.coarser, levels.reference)]
    return float(levels.band(np.array(both[0] - both[1])))


def hub_rows(levels: Levels, others: Mapping[str, Solved]) -> list[Record]:
    """Deflection and slope of the hub: FE, other forms of the joints, and beams."""
    rows: list[Record] = []
    for what, component, load in (
        ("deflection uz per Fz [nm/N]", 2, 2),
        ("deflection uy per Fy [nm/N]", 1, 1),
        ("slope ry per My [nrad/(N m)]", 4, 4),
        ("slope rz per Mz [nrad/(N m)]", 5, 5),
    ):
        fe = float(levels.reference.compliance[component, load])
        beams = {}
        for label in (RIGID, STIFF, SOFT):
            model = levels.models[label]
            first = 6 * model.points.index("hub")
            beams[label] = float(model.compliance[first + component, first + load])
        of_others = {
            form: float(one.response.motions["hub"][component, load])
            for form, one in others.items()
        }
        rows.append(
            {
                "quantity": what,
                **{n: 1e9 * v for n, v in {"FE": fe, **of_others, **beams}.items()},
                **{f"{n} against FE [%]": 100.0 * (v / fe - 1.0) for n, v in beams.items()},
            }
        )
    return rows


def _nearest(rows: list[Record]) -> str:
    # what a bearing hardly carries says little of a model: as a share of the largest of its kind
    largest: dict[str, float] = {}
    for row in rows:
        kind = row["reaction"].split(" ", 1)[1]
        largest[kind] = max(largest.get(kind, 0.0), abs(row["FE"]))
    worst = {
        label: max(
            100.0 * abs(row[label] - row["FE"]) / largest[row["reaction"].split(" ", 1)[1]]
            for row in rows
        )
        for label in (RIGID, STIFF, SOFT)
    }
    best = min(worst, key=lambda label: worst[label])
    return (
        f"Reactions in bending to unit loads: of three Timoshenko beams the one on "
        f"{best.split(', ')[1]} is nearest to FE, within {worst[best]:.2g} % of the largest of its "
        "kind; " + "; ".join(f"{label} {error:.2g} %" for label, error in worst.items()) + "."
    )


def bounds_of(scene: Scene) -> dict[str, UnitBounds]:
    """Two bounds of every bearing unit."""
    names = [unit.bearing.name for unit in scene.bearing_units]
    return {name: unit_bounds(scene, name) for name in names}


def wall_page(run: Run, page: Page, scenes: Mapping[int, Scene]) -> None:
    """Radial reactions of every bearing over ten seconds of hub loads, by the shaft's wall.

    Parameters
    ----------
    scenes : mapping
        Scenes by wall, in percent of the solid radius, the solid shaft first.
    """
    page.about(next(iter(scenes.values())))
    with run.step("hub loads"):
        history = hub_loads(Condition(16.0, "medium", 0.2, 1)).between(100.0, 110.0)
    solutions = {
        wall: study.solve_scene(run, scene, f"{wall} % wall") for wall, scene in scenes.items()
    }
    with run.step("bearing units, two bounds"):
        bounds = bounds_of(next(iter(scenes.values())))
    rows: list[Record] = []
    references: dict[tuple[str, str], Floats] = {}
    for wall, solved in solutions.items():
        shown.check_solution(page, solved, f"{wall} % wall")
        scene = solved.scene
        models = {
            "FE": solved.response.reactions,
            **{
                label: shaft_level(
                    scene, 1, {n: getattr(b, which) for n, b in bounds.items()}
                ).reaction_matrices
                for label, which in ((STIFF, "stiff"), (SOFT, "soft"))
            },
        }
        factors = factors_of(entering(scene, history), scene.gearbox.weight).values
        for unit in scene.bearing_units:
            name = unit.bearing.name
            row: Record = {
                "bearing": name,
                "wall [%]": wall,
                "bore [m]": scene.shaft.sections[0].inner_diameter,
            }
            for label, matrices in models.items():
                found = factors @ matrices[name].T
                force = np.asarray(resultant(found[:, 1], found[:, 2]))
                reference = references.setdefault((name, label), force)
                change = np.abs(force - reference).mean() / reference.mean()
                if label == "FE":
                    row["mean, FE [kN]"] = float(force.mean()) / 1e3
                row[f"mean change, {label} [%]"] = 100.0 * float(change)
            row["hub deflection per Fz [nm/N]"] = 1e9 * float(solved.response.motions["hub"][2, 2])
            rows.append(row)
    largest = max(rows, key=lambda row: float(row["mean change, FE [%]"]))
    page.answer(
        f"A bore changes the radial force on a bearing by at most "
        f"{largest['mean change, FE [%]']:.2g} % on average ({largest['bearing']}, "
        f"{largest['wall [%]']} % wall); the beam says "
        f"{largest[f'mean change, {STIFF} [%]']:.2g} to "
        f"{largest[f'mean change, {SOFT} [%]']:.2g} %."
    )
    page.section("Radial reactions by wall")
    page.text(
        "Wall in percent of the radius of the thinnest section, solid: one bore all along the "
        "shaft. Change: mean over ten seconds of a surrogate's loads, against the solid shaft."
    )
    page.table("Radial force on each bearing: FE, and Timoshenko beams", rows)
    shown.mesh_section(page, {f"{wall} % wall": solved for wall, solved in solutions.items()})
    page.data("walls", rows)


def secant_page(run: Run, page: Page, scene: Scene, cases: Cases) -> None:
    """K_R of every bearing that carries moments, as a secant over load cases.

    Parameters
    ----------
    cases : Cases
        Load cases at the hub and at the scene's load points.
    """
    hub, weights = cases.hub, cases.weights
    page.about(scene)
    solved = study.solve_scene(run, scene, "scene")
    with run.step("bearing units, two bounds"):
        bounds = bounds_of(scene)
    shown.check_solution(page, solved, "scene")
    factors = factors_of(hub, scene.gearbox.weight).values
    page.section("The secant over load cases")
    page.text(cases.statement)
    rows: list[Record] = []
    traces = []
    for name, bound in bounds.items():
        loads = factors @ solved.response.reactions[name].T
        motions = factors @ solved.response.motions[f"{name}.seat"].T
        if np.abs(loads[:, 4:]).max() < _SMALL * np.abs(hub.values[:, 3:6]).max():
            page.text(f"{name} carries no moment in bending: its K_R is zero in all load cases.")
            continue
        fit = secant_stiffness.fitted_spring(loads, motions, weights)
        for a, axis in ((4, "y"), (5, "z")):
            found = secant_stiffness.secant(loads, motions, a, weights)
            bracket = [1.0 / np.linalg.inv(k)[a, a] for k in (bound.soft, bound.stiff)]
            rows.append(
                {
                    "bearing": name,
                    "axis": axis,
                    "secant [MN m/rad]": found.stiffness / 1e6,
                    "scatter [%]": 100.0 * found.scatter,
                    "unit alone, soft [MN m/rad]": bracket[0] / 1e6,
                    "unit alone, stiff [MN m/rad]": bracket[1] / 1e6,
                }
            )
            try:
                parts = secant_stiffness.parts_of(loads, motions, fit.matrix, a, weights)
            except InputError as reason:
                page.text(f"{name}, about {axis}: {reason}.")
                continue
            page.text(f"{name}: {secant_stiffness.statement(found, parts)}.")
            page.equals(
                f"{name}: shares of the scatter about {axis}, their sum",
                float(parts.shares.sum()) if found.scatter else 1.0,
                1.0,
                within=1e-6,
                why="terms of a moment may cancel but for a share of 1e-9 of them, of which "
                "rounding leaves six digits",
                source="the terms and the rest are all of the moment",
                basis="self-consistency",
            )
        shown_cases = slice(None, None, max(1, len(hub) // 600))
        traces.append(
            trace(name, 1e6 * motions[shown_cases, 4], loads[shown_cases, 4] / 1e3, points=True)
        )
    if not rows:
        page.answer("No bearing of this scene carries moments: K_R is zero in all load cases.")
        return
    page.answer(
        "K_R about y, secant over the load cases: "
        + "; ".join(
            f"{row['bearing']} {row['secant [MN m/rad]']:.3g} MN m/rad, scatter "
            f"{row['scatter [%]']:.2g} %"
            for row in rows
            if row["axis"] == "y"
        )
        + "."
    )
    page.table("K_R of each bearing, in the drivetrain over the load cases, and alone", rows)
    page.chart(
        "Moment about y against rotation of the seat, one point a load case",
        traces,
        "rotation [µrad]",
        "My [kN m]",
    )
    shown.mesh_section(page, {"scene": solved})
    page.data("secants", rows)
