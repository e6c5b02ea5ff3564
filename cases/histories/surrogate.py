"""The surrogate of hub loads beside aeroelastic simulations of the same turbines and winds."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from fe_drivetrain.cases import case
from fe_drivetrain.commands import Options, digest, features
from fe_drivetrain.histories import differences
from fe_drivetrain.hub_loads import (
    Condition,
    Recorded,
    Rotor,
    hub_loads,
    read_recorded,
    recorded_files,
)
from fe_drivetrain.suite import Page, Record, Run

OPTIONS = Options({}, 0.0, (3.0, 4.0, 10.0), "half", 0.0, None)
TABLE = Path(__file__).with_name("openfast.yaml")
MISSING = (
    ("Mx at 3P and 6P", "the rotor turns at one speed: its inertia takes no aerodynamic torque"),
    ("Mx and Fx, slow", "no controller: gusts pass at the pitch and speed of the mean wind"),
    ("Fy and Fz, cycles and 6P", "tower and blades are rigid, so that no inertia forces act"),
    ("Fx at 1P", "no tower that moves fore and aft near it, and no imbalance"),
    ("My, mean", "no cone of the blades, whose weight acts upwind of the hub"),
    ("My and Mz, 3P and more", "no blades that yield, and no individual pitch"),
)


@case(
    "A surrogate of hub loads beside OpenFAST, by statistics, cycles, multiples and loops",
    source="OpenFAST 5.0.0 with ROSCO 2.10.6, NREL 5 MW and NREL 2.8 MW at 11 and 17 m/s, class B",
    settings=("loads",),
)
def run(run: Run, page: Page) -> None:
    """Make histories of several seeds for each real one, and name what differs beyond them."""
    given = yaml.safe_load(TABLE.read_text(encoding="utf-8"))
    real = read_again(run, page, given) if "loads" in run.settings else stored(given)
    names = list(real)[: 1 if run.quick else None]
    seeds = range(1, 4 if run.quick else 7)
    rows: list[Record] = []
    for name in names:
        row = given["histories"][name]
        rotor = Rotor(**given["rotors"][row["rotor"]])
        with run.step(f"surrogate of {name}"):
            made = [surrogate(rotor, row["wind"], seed) for seed in seeds]
        rows += beside(page, name, real[name], made)
        halves = differences(made[::2], made[1::2])
        page.at_most(
            f"{name}: share of quantities in which seeds differ from other seeds",
            sum(d.beyond for d in halves) / len(halves),
            0.1,
            why="1 % by chance where quantities are independent; they come in families of ten",
            source="both sets are one surrogate",
        )
    page.section("What the surrogate leaves out")
    page.table("Where it may show; no reason was isolated", MISSING, ["quantity", "left out"])
    page.data("differences", rows)


def surrogate(rotor: Rotor, wind: float, seed: int) -> dict[str, float]:
    """Quantities of one made history of ten minutes at 20 Hz."""
    history = hub_loads(Condition(wind, "medium", 0.2, seed), rotor=rotor)
    speed = np.full(len(history), rotor.rotor_speed(wind))
    return features(digest(Recorded(history, speed), OPTIONS), OPTIONS.slopes)


def beside(
    page: Page, name: str, real: Mapping[str, float], made: Sequence[Mapping[str, float]]
) -> list[Record]:
    """Table and answer of one turbine and wind; every quantity."""
    found = differences([real], made)
    beyond = [d for d in found if d.beyond]
    rows: list[Record] = [
        {
            "quantity": d.quantity,
            "OpenFAST": d.one,
            "surrogate": d.other,
            "surrogate over OpenFAST": d.other / d.one if d.one else None,
            "scatter of seeds": d.scatter,
            "beyond": d.beyond,
        }
        for d in found
    ]
    page.answer(
        f"{name}: {len(beyond)} of {len(found)} quantities of OpenFAST are beyond what "
        f"{len(made)} seeds of the surrogate scatter."
    )
    page.section(name)
    chosen = (
        "My, standard",
        "My, DEL of m = 4",
        "My, 3P",
        "My, largest",
        "Mx, standard",
        "Mx, DEL of m = 4",
        "Fx, mean",
        "Fx, standard",
        "Fz, mean",
        "Fz, DEL of m = 4",
        "bending moment, mean",
        "loops of moment",
    )
    page.table(
        "Quantities that load a main bearing, and whether they differ by more than the seeds do",
        [row for row in rows if str(row["quantity"]).startswith(chosen)],
    )
    farthest = sorted(beyond, key=lambda d: -abs(d.one - d.other) / d.allowed)[:15]
    kept = {d.quantity for d in farthest}
    page.table("Farthest beyond the seeds", [row for row in rows if row["quantity"] in kept])
    weight = next(d for d in found if d.quantity.startswith("Fz, mean"))
    page.equals(
        f"{name}: mean of Fz, the rotor's weight across the shaft",
        weight.other,
        weight.one,
        within=0.015,
        why="both carry one rotor; wind adds about a percent of it",
        source="OpenFAST",
        unit="kN",
        measure="reaction",
    )
    return [{"history": name, **row} for row in rows]


def stored(given: Mapping[str, Any]) -> dict[str, dict[str, float]]:
    """Quantities of each real history, from the table."""
    return {
        name: {quantity: float(row[k]) for quantity, row in given["quantities"].items()}
        for k, name in enumerate(given["histories"])
    }


def read_again(run: Run, page: Page, given: Mapping[str, Any]) -> dict[str, dict[str, float]]:
    """The same from the user's files, which must give what the table holds."""
    known = stored(given)
    found = {}
    with run.step("files"):
        for file in recorded_files([str(run.settings["loads"])]):
            if file.stem in known:
                found[file.stem] = features(digest(read_recorded(file), OPTIONS), OPTIONS.slopes)
    for name, values in found.items():
        page.vanishes(
            f"{name}: the file's quantities less those of the table, the worst, as a share",
            max(abs(values[q] - v) / (abs(v) or 1.0) for q, v in known[name].items()),
            within=1e-5,
            why="the table has six digits",
            source="the file itself",
            basis="self-consistency",
        )
    return found or known
