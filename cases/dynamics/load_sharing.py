"""Planets with a pin that is out of place: load sharing against its closed form."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.dynamics.own_load_sharing import own
from fe_drivetrain.cases.dynamics.planet_loads import SharingStage, shared_load
from fe_drivetrain.dynamics import load_sharing
from fe_drivetrain.report.suite import Page, Record, Run, Target
from fe_drivetrain.report.suite.chosen import SETTING

NOMINAL = 20e3  # N, mean force of a mesh
SHARE = 0.25  # K e over it, as of 1e8 N/m and 50 um along the line of action
#: K_gamma by these, from 3 planets to 7.
TABLED = {
    "floating": (1.0, 1.0625, 1.1, 1.125, 1.1429),
    "fixed": (1.1667, 1.1875, 1.2, 1.2083, 1.2143),
}
HERO = "Load sharing K_gamma by the number of planets, one pin out of place"
SHARING, MEAN = "load sharing K_gamma", "mean load over K e"
LINEAR = "linear; the fixed sun is held a million times stiffer than a mesh"
CLOSED = "a branch of stiffness K a planet: F_1 = T/(N r) + K e (1 - 3/N), or (1 - 1/N) fixed"


@case(
    "Load sharing of planets with a pin error: floating and fixed sun, three to seven planets",
    source="closed form of parallel branches; Guo and Keller 2020 for measured values",
    settings={
        "drivetrain": "FILE, or a name of the library (otherwise stages of three to seven planets)",
        "error": "50 (um, by which a pin of your own drivetrain is ahead of its place)",
    },
)
def run(run: Run, page: Page) -> None:
    """Statics of the assembled stage against the closed form; four planets by clearance."""
    if SETTING in run.settings:
        own(run, page)
        return
    rows: list[Record] = []
    for planets in (3, 4, 5, 6, 7):
        for floating in (True, False):
            stage = SharingStage(planets, floating)
            pressed = SHARE * NOMINAL / stage.branch
            pin = pressed / (2 * np.cos(stage.ANGLE))  # both meshes see its tangential error
            found = run.timed(f"{planets} planets", stage.solved, NOMINAL, {1: pin})
            forces = stage.mesh_forces(found)
            exact = shared_load(planets, NOMINAL, stage.branch, pressed, floating)
            name = "floating" if floating else "fixed"
            one = Target("load of planet 1 [kN]", float(exact[0]) / 1e3, 1e-5, LINEAR, CLOSED)
            page.meets(float(forces[0]) / 1e3, one, of=f"{planets} planets, {name} sun")
            rows.append(
                {
                    "planets": planets,
                    "sun": name,
                    SHARING: load_sharing(forces),
                    "closed form": load_sharing(exact),
                    "as tabled": TABLED[name][planets - 3],
                    "pin error [um]": 1e6 * pin,
                }
            )
    title = "load sharing of all ten against the tabled closed form"
    decimals = "half of the fourth decimal", "closed form, tabled to four decimals"
    tabled = Target(title, 0.0, 5.5e-5, *decimals)
    page.meets(max(abs(row[SHARING] - row["as tabled"]) for row in rows), tabled)
    three = SharingStage(3)
    both = three.mesh_forces(three.solved(1e3, {1: 80e-6, 2: -30e-6}))
    title = "three planets, floating sun, two pins out of place: load sharing"
    determinate = "round-off; three branches on three motions are statically determinate"
    page.meets(load_sharing(both), Target(title, 1.0, 1e-8, determinate, "statics"))
    pairs = by_torque(page, 5 if run.quick else 21)
    answer(page, rows)
    page.section("One pin out of place")
    page.sweep(HERO, rows, "planets", SHARING, by="sun")
    page.section("Four planets by the torque")
    title = "Load of each planet over the mean, one pin out of place, teeth that only press"
    curves = {f"planet {k}": f"planet {k}" for k in (1, 2, 3, 4)}
    page.sweep(title, pairs, MEAN, curves, axis="load over the mean", log="x")


def answer(page: Page, rows: list[Record]) -> None:
    """State the load sharing of planets, beside the closed form."""
    at = {(row["planets"], row["sun"]): row for row in rows}
    worst = max(abs(row[SHARING] / row["closed form"] - 1) for row in rows)
    same = "as" if all(check.passed for check in page.checks) else "not as"
    page.answer(
        "How unevenly do planets share the load when one pin is out of place?",
        f"The load-sharing factor K_gamma is {at[3, 'floating'][SHARING]:.4f} for three planets "
        f"with a floating sun, but {at[3, 'fixed'][SHARING]:.4f} with a fixed sun, {same} the "
        "closed form gives.",
        [
            *(
                page.value(
                    f"{SHARING}, {planets} planets, {sun} sun",
                    at[planets, sun][SHARING],
                    beside=at[planets, sun]["as tabled"],
                    by="closed form",
                )
                for planets, sun in ((3, "floating"), (4, "floating"), (3, "fixed"), (7, "fixed"))
            ),
            page.value(
                "largest difference from the closed form, ten cases [%]", 100 * worst, at_most=0.001
            ),
            page.judged(
                "four planets, little torque: load of planet 1 over the mean",
                "four planets at low torque: load of planet 1 over the mean",
                "statics",
            ),
        ],
        HERO,
        [
            f"The pin's error, times the stiffness of a planet's branch, is {SHARE:g} of the mean "
            "load of a planet.",
            "Teeth can only push: at low torque two opposite planets of four carry all of the "
            "load.",
        ],
    )


def by_torque(page: Page, count: int) -> list[Record]:
    """Four planets with contacts, from little torque to much."""
    shares = np.geomspace(0.05, 5, count)
    over = SharingStage(4, weak=1e2).over_mean(50e-6, shares)
    pairs = "a floating sun between two opposite planets: each has half of the torque; weak "
    pairs += "springs that hold what is loose have a millionth of a mesh's stiffness"
    little = Target("load of planet 1 over the mean", 2.0, 1e-4, pairs, "statics")
    press = "all press, so that the closed form holds: 1 + K e / (4 F)"
    much = Target("planets 1 and 3 share equally", 1 + 0.25 / 5, 1e-5, press, CLOSED)
    page.meets(float(over[0, 0]), little, of="four planets, little torque")
    page.meets(float(over[-1, 0]), much, of="four planets, much torque")
    names = [f"planet {k}" for k in (1, 2, 3, 4)]
    loads = [dict(zip(names, row.tolist(), strict=True)) for row in over]
    return [{MEAN: float(share)} | row for share, row in zip(shares, loads, strict=True)]
