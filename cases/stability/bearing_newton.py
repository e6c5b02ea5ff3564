"""Newton's method on rollers: clearances, small loads, lifted rings, mechanisms."""

from dataclasses import replace
from typing import Any

import numpy as np

from fe_drivetrain.bearing import Bearing, RollerRow, catalogue_bearing, equilibrium, forces
from fe_drivetrain.cases import case
from fe_drivetrain.cases.stability.random_loads import random_loads
from fe_drivetrain.common import InputError
from fe_drivetrain.common.arrays import rounded
from fe_drivetrain.comparison import decades
from fe_drivetrain.report import rolling_elements
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run, column

UM = 1e-6

SHARE = "clearance over the deflection of all rollers by the load"
FAILS = "plain Newton fails [%]"
OVER_SHARE = (
    "Random loads that Newton's method without damping fails to solve, over the clearance; shaded: "
    "none fails"
)


@case(
    "Equilibrium of a roller bearing: where Newton's method needs damping, and where it ends",
    source="damped Newton's method on a convex energy (Boyd, Vandenberghe 2004, ch. 9)",
)
def run(run: Run, page: Page) -> None:
    """Sweep clearance and preload, load size, and the arm that carries a moment."""
    n = 30 if run.quick else 1000
    with run.step("clearance and preload"):
        rows = [
            damping(um, float(factor), n)
            for um in (-20.0, 0.0, 1.0, 20.0, 200.0)
            for factor in decades(-8, 0, 0.5 if run.quick else 1)
        ]
    with run.step("small preload"):
        preload = [small_preload(d) for d in decades(-6, 2, 1 if run.quick else 2)]
    with run.step("mechanism"):
        arms = [mechanism(a) for a in decades(-9, -1, 1 if run.quick else 2)]
    check(page, rows, preload)
    last_safe = state_limits(page, rows, arms)
    sizes, stiff = (np.log(column(preload, k)) for k in ("preload [µm]", "radial stiffness [N/m]"))
    power = float(np.polyfit(sizes, stiff, 1)[0])
    answer(page, rows, arms, n * len(rows), last_safe)
    page.say(
        "With preload or without clearance plain Newton converges, too.",
        "There is no least preload: the stiffness of the unloaded bearing falls with its power "
        f"{power:.2g} only.",
    )
    show(page, rows, preload, arms, last_safe)
    page.image(
        "The rollers of bearing S", run.sketch(*rolling_elements(catalogue_bearing("bearing_s")))
    )


def answer(
    page: Page, rows: list[Record], arms: list[Record], cases: int, last_safe: float | None
) -> None:
    """State whether damped Newton's method always converges, and from where plain steps do not."""
    lost, worst = sum(column(rows, "not converged")), max(column(rows, FAILS))
    damped = (
        f"solves all {formatted(cases)} random loads"
        if lost == 0
        else f"does not solve {formatted(lost)} of {formatted(cases)} random loads"
    )
    plain = (
        "without it, the first fail once the clearance exceeds "
        f"{formatted(rounded([last_safe], 2)[0], unit='')} times a roller's deflection."
        if last_safe is not None
        else "without it none fails either, 0\u00a0%."
    )
    figures = [
        page.value(
            "random loads that Newton's method with damping does not solve", lost, at_most=0.0
        ),
        page.value("random loads that fail without damping, at the worst clearance [%]", worst),
        page.value("most steps of Newton's method with damping", max(column(rows, "steps, worst"))),
        page.value(
            "least arm of the moment for tilts below 10 mrad, over the pitch radius",
            least_arm(arms),
        ),
    ]
    if last_safe is not None:
        name = "clearance over roller deflection up to which none fails without damping"
        figures.insert(2, page.value(name, rounded([last_safe], 2)[0]))
    page.answer(
        "Is the equilibrium of a roller bearing found for every clearance and load?",
        f"Newton's method with damping {damped}; {plain}",
        figures,
        hero=OVER_SHARE,
        cautions=[
            "Loads that the bearing cannot carry are rejected: thrust that pushes a single tapered "
            "row apart, or a moment where all contact normals meet in the bearing's centre."
        ],
    )


def least_arm(arms: list[Record]) -> float:
    """Least arm over the pitch radius with a tilt below 10 mrad."""
    fine = [row for row in arms if (row["tilt [mrad]"] or 1e9) < 10.0]
    return float(min(column(fine, "arm over pitch radius")))


def check(page: Page, rows: list[Record], preload: list[Record]) -> None:
    """Check convergence, refusals of impossible loads, and the stiffness of a free bearing."""
    for name, of in (("clearances and loads", rows), ("preloads", preload)):
        page.vanishes(
            f"{name}: cases of damped Newton that have not converged",
            float(sum(row["not converged"] for row in of)),
            within=0.0,
            why="any start leads to the minimum of a convex function",
            source="convex energy",
        )
    for statement, bearing, load in refusals():
        try:
            equilibrium(bearing, load)
            refused = False
        except InputError:
            refused = True
        page.holds(
            f"{statement}: refused in one sentence",
            refused,
            why="a displacement without end would be reported otherwise",
            source="no roller can carry it",
        )
    free = catalogue_bearing("bearing_s", clearance=20 * UM)
    at_rest = equilibrium(free, np.zeros(5))
    page.vanishes(
        "no load in a clearance: tangent stiffness at rest [N/m]",
        float(np.abs(forces(free, at_rest.displacements)[1]).max()),
        within=0.0,
        why="no roller touches",
        source="clearance",
    )


def state_limits(page: Page, rows: list[Record], arms: list[Record]) -> float | None:
    """State the loads that plain Newton's method solves, and the arms that carry a moment.

    Returns
    -------
    last_safe : float or None
        Clearance over deflection up to which no load fails; None where none does at any.
    """
    worst = max(rows, key=lambda row: row[FAILS])
    tight = [row for row in rows if row["clearance [µm]"] > 0.0]
    least = min((row[SHARE] for row in tight if row[FAILS] > 0.0), default=None)
    safe = [row[SHARE] for row in tight if least is not None and row[SHARE] < least]
    last_safe = max(safe, default=0.0) if least is not None else None
    page.limit(
        "plain Newton's method on the rollers, in place of a damped one",
        SHARE,
        high=last_safe,
        criterion="none of the random loads fails",
        beyond="few rollers carry, as between rigid bodies, and steps jump from one set of them to "
        f"the next: {worst[FAILS]:.0f} % of the cases fail",
        program="brings the slope of the energy down along each step, and follows loads that just "
        "close a clearance down from larger ones",
        remedy="nothing to do; every case is converged or flagged",
    )
    page.limit(
        "moment on contacts whose normals meet near the bearing's centre",
        "arm of the contact normals over the pitch radius",
        low=least_arm(arms),
        criterion="tilt of a small moment below 10 mrad",
        beyond="the tilt grows without bound as the arm goes to zero, out of small angles",
        program="answers, and refuses the moment where the arm is below 1e-6 of the radius",
        remedy="a bearing that resists tilt, or no moment",
    )
    return last_safe


def show(
    page: Page,
    rows: list[Record],
    preload: list[Record],
    arms: list[Record],
    last_safe: float | None,
) -> None:
    """Show the three sweeps."""
    page.section("Clearance and load")
    tight = sorted((row for row in rows if row[SHARE] > 0.0), key=lambda row: row[SHARE])
    page.sweep(
        OVER_SHARE,
        tight,
        SHARE,
        FAILS,
        by="clearance [µm]",
        log="x",
        safe=(None, last_safe),
        table=False,
    )
    for y in (FAILS, "evaluations, mean"):
        page.sweep(
            f"Random loads on bearing S: {y}" + (", damped" if y.startswith("eval") else ""),
            rows,
            "load over nominal",
            y,
            by="clearance [µm]",
            log="x",
            table=y.startswith("plain"),
        )
    page.section("Small preload")
    page.sweep(
        "Radial stiffness of the unloaded bearing over its preload",
        preload,
        "preload [µm]",
        "radial stiffness [N/m]",
        log="xy",
    )
    page.section("Mechanism")
    page.sweep(
        "Tilt under 1 kN m and 400 kN down, contact normals ever nearer to the centre",
        [row for row in arms if not row["refused"]],
        "arm over pitch radius",
        "tilt [mrad]",
        log="xy",
        table=False,
    )
    page.table("All arms", arms)


def damping(um: float, factor: float, n: int) -> Record:
    """Random loads of one size at one clearance, by plain and by damped Newton."""
    bearing = catalogue_bearing("bearing_s", clearance=um * UM)
    loads = factor * random_loads(n)
    plain = equilibrium(bearing, loads, warm=False, damped=False)
    damped = equilibrium(bearing, loads, warm=False)
    law = bearing.rows[0].law
    typical = float(np.median(np.linalg.norm(loads[:, :3], axis=1)))
    deflection = (typical / (sum(bearing.counts) * law.stiffness)) ** (1.0 / law.exponent)
    return {
        "clearance [µm]": um,
        "load over nominal": factor,
        SHARE: um * UM / deflection,
        FAILS: 100.0 * float(1.0 - plain.converged.mean()),
        "not converged": int((~damped.converged).sum()),
        "steps, worst": int(damped.iterations.max()),
        "evaluations, mean": float(damped.evaluations.mean()),
    }


def small_preload(um: float) -> Record:
    """Stiffness of the unloaded bearing, and loads on it, at one preload."""
    bearing = catalogue_bearing("bearing_s", clearance=-float(um) * UM)
    found = equilibrium(bearing, np.concatenate([random_loads(10), np.zeros((1, 5))]), warm=False)
    return {
        "preload [µm]": float(um),
        "radial stiffness [N/m]": float(forces(bearing, np.zeros(5))[1][0, 2, 2]),
        "not converged": int((~found.converged).sum()),
        "steps, worst": int(found.iterations.max()),
    }


def near_centre(share: float) -> Bearing:
    """Bearing S as short rollers whose contact normals pass the centre at a share of the radius."""
    rows = []
    for row in catalogue_bearing("bearing_s").rows:
        assert isinstance(row, RollerRow)
        off = np.sin(row.angle) + share * np.sign(row.angle)
        place = row.radius * off / np.cos(row.angle)
        changes: dict[str, Any] = {"place": float(place), "laminae": 1}
        rows.append(replace(row, **changes))
    return Bearing(f"bearing with an arm of {share:.0e} of its radius", tuple(rows))


def mechanism(share: float) -> Record:
    """A small moment on contact normals that nearly meet in the centre."""
    bearing = near_centre(float(share))
    record: Record = {"arm over pitch radius": float(share)}
    try:
        found = equilibrium(bearing, [0, 0, -4e5, 1e3, 0])
    except InputError:
        return record | {"refused": True, "tilt [mrad]": None, "steps": None}
    tilt = float(found.displacements[0, 3]) * 1e3
    return record | {"refused": False, "tilt [mrad]": tilt, "steps": int(found.iterations[0])}


def refusals() -> list[tuple[str, Bearing, list[float]]]:
    """Loads that nothing carries."""
    whole = catalogue_bearing("bearing_s")
    half = Bearing("downwind row of bearing S", whole.rows[1:])
    return [
        ("a single tapered row pushed open", half, [-1e5, 0.0, 0.0, 0.0, 0.0]),
        ("a single tapered row under radial force alone", half, [0.0, 0.0, -1e5, 0.0, 0.0]),
        ("a moment on contact normals through the centre", near_centre(0.0), [0, 0, 0, 1e5, 0]),
        (
            "axial force on a toroidal bearing",
            catalogue_bearing("nrel_5mw_upwind"),
            [1e3, 0, 0, 0, 0],
        ),
        ("a load that is no number", whole, [0.0, float("nan"), 0.0, 0.0, 0.0]),
    ]
