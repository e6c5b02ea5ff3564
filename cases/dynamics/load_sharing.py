"""Planets with a pin that is out of place: load sharing against its closed form."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.dynamics import load_sharing
from fe_drivetrain.suite import Page, Record, Run
from fe_drivetrain.validation.planet_loads import SharingStage, shared_load

ERROR = 50e-6  # m, tangential, of one pin
NOMINAL = 20e3  # N, mean force of a mesh
SHARING = "load sharing K_gamma"
CLOSED = "a branch of stiffness K a planet: F_1 = T/(N r) + K e (1 - 3/N), or (1 - 1/N) fixed"


@case(
    "Load sharing of planets with a pin error: floating and fixed sun, three to seven planets",
    source="closed form of parallel branches; Guo and Keller 2020 for measured values",
)
def run(run: Run, page: Page) -> None:
    """Statics of the assembled stage against the closed form; four planets by clearance."""
    rows: list[Record] = []
    for planets in (3, 4, 5, 6, 7):
        for floating in (True, False):
            stage = SharingStage(planets, floating)
            found = run.timed(f"{planets} planets", stage.solved, NOMINAL, {1: ERROR})
            forces = stage.mesh_forces(found)
            pressed = 2 * np.cos(stage.ANGLE) * ERROR
            exact = shared_load(planets, NOMINAL, stage.branch, pressed, floating)
            name = "floating" if floating else "fixed"
            page.equals(
                f"{planets} planets, {name} sun: load of planet 1 [kN]",
                float(forces[0]) / 1e3,
                float(exact[0]) / 1e3,
                within=1e-5,
                why="linear; the fixed sun is held a million times stiffer than a mesh",
                source=CLOSED,
            )
            rows.append(
                {
                    "planets": planets,
                    "sun": name,
                    SHARING: load_sharing(forces),
                    "closed form": load_sharing(exact),
                    "K e over the mean load": stage.branch * pressed / NOMINAL,
                }
            )
    three = SharingStage(3)
    both = three.mesh_forces(three.solved(1e3, {1: 80e-6, 2: -30e-6}))
    page.equals(
        "three planets, floating sun, two pins out of place: load sharing",
        load_sharing(both),
        1.0,
        within=1e-8,
        why="round-off; three branches on three motions are statically determinate",
        source="statics",
    )
    pairs = by_torque(page, 5 if run.quick else 21)
    last = rows[2]
    page.answer(
        "The assembled stage shares as the closed form says, to round-off of the solver: three "
        "planets of a floating sun always equally, four by "
        f"{last[SHARING]:.3f} with {1e6 * ERROR:.0f} um on one pin at {NOMINAL / 1e3:.0f} kN.",
        "Four planets with teeth that only press carry in pairs of opposite ones: at little torque "
        "two carry all, K_gamma = 2.",
    )
    page.section("One pin out of place")
    page.sweep(SHARING, rows, "planets", SHARING, by="sun")
    page.section("Four planets by the torque")
    page.sweep(
        "Load of each planet over the mean, one pin out of place, teeth that only press",
        pairs,
        "mean load over K e",
        {f"planet {k}": f"planet {k}" for k in (1, 2, 3, 4)},
        axis="load over the mean",
        log="x",
    )


def by_torque(page: Page, count: int) -> list[Record]:
    """Four planets with contacts, from little torque to much."""
    stage = SharingStage(4, weak=1e2)
    scale = stage.branch * 2 * np.cos(stage.ANGLE) * ERROR
    rows: list[Record] = []
    for share in np.geomspace(0.05, 5, count):
        forces = stage.mesh_forces(stage.solved(share * scale, {1: ERROR}, only_press=True))
        over = forces / forces.mean()
        record: Record = {"mean load over K e": float(share)}
        rows.append(record | {f"planet {k + 1}": float(f) for k, f in enumerate(over)})
    page.equals(
        "four planets, little torque: load of planet 1 over the mean",
        float(str(rows[0]["planet 1"])),
        2.0,
        within=1e-4,
        why="a floating sun between two opposite planets: each has half of the torque; weak "
        "springs that hold what is loose have a millionth of a mesh's stiffness",
        source="statics",
    )
    page.equals(
        "four planets, much torque: planets 1 and 3 share equally",
        float(str(rows[-1]["planet 1"])),
        1 + 0.25 / 5,
        within=1e-5,
        why="all press, so that the closed form holds: 1 + K e / (4 F)",
        source=CLOSED,
    )
    return rows
