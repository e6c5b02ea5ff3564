"""The surrogate of hub loads beside aeroelastic simulations of the same turbines and winds."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import yaml

from fe_drivetrain.cases import case
from fe_drivetrain.report import bars
from fe_drivetrain.report.answer import KeyFigure
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.studies import LoadOptions
from fe_drivetrain.studies.load_comparison import features
from fe_drivetrain.studies.load_digest import digest
from fe_drivetrain.turbine_loads.histories import Difference, differences
from fe_drivetrain.turbine_loads.hub_loads import (
    RIGID,
    Condition,
    Physics,
    Recorded,
    Rotor,
    Tuning,
    designed_controller,
    hub_loads,
    read_recorded,
    recorded_files,
    similar_turbine,
    turbine_histories,
)

OPTIONS = LoadOptions()
TABLE = Path(__file__).with_name("openfast.yaml")
#: Models of the turbine, each with what the one before has.
MODELS = {
    "default: speed and pitch of the mean wind": None,
    "controller, and a wake with delays": RIGID,
    "and blade modes": replace(RIGID, blades=True),
    "and tower modes": replace(RIGID, blades=True, tower=True),
    "and torsion of the shaft": replace(RIGID, blades=True, tower=True, torsion=True),
    "all, with tower shadow": Physics(),
}
DEFAULT, *_, ALL = MODELS
MISSING = (
    ("all loads, 9P", "the second flapwise mode, near 2 Hz for the 5 MW turbine"),
    ("Fy and Fz, cycles", "wind across and up; unsteady aerofoils, by which edge modes damp less"),
    ("Mx and Fx, 1P and cycles", "the very controller: ROSCO with peak shaving and set points"),
    ("means of My and Mz, Fx", "the very aerofoils, chord and twist; wake skew"),
    ("2.8 MW: all", "its own structure: it is the 5 MW turbine brought to its size"),
)


@case(
    "A surrogate of hub loads beside OpenFAST, by statistics, cycles, multiples and loops",
    source="OpenFAST 5.0.0 with ROSCO 2.10.6, NREL 5 MW and NREL 2.8 MW at 11 and 17 m/s, class B",
    settings={"loads": "FILES (otherwise figures that are stored)"},
)
def run(run: Run, page: Page) -> None:
    """Make histories of several seeds for each real one, and name what differs beyond them."""
    given = yaml.safe_load(TABLE.read_text(encoding="utf-8"))
    real = read_again(run, page, given) if "loads" in run.settings else stored(given)
    names = list(real)[: 1 if run.quick else None]
    seeds = range(1, 4 if run.quick else 7)
    chosen = (DEFAULT, ALL) if run.quick else tuple(MODELS)
    of_model = {}
    for name in names:
        for model in chosen:
            with run.step(f"{name}: {model}"):
                row = given["histories"][name]
                of_model[name, model] = surrogates(given, row, MODELS[model], seeds)
    counts = [
        counted(name, model, differences([real[name]], made))
        for (name, model), made in of_model.items()
    ]
    page.section("What each part of the turbine adds")
    page.add(
        bars(
            BEYOND,
            {
                family: {f"{c['history']}, {c['model']}": float(c[family]) for c in counts}
                for family in FAMILIES
            },
            "quantities that differ by more than seeds scatter [-]",
            stacked=True,
        )
    )
    page.table(
        f"Quantities of OpenFAST beyond what {len(seeds)} seeds of a model scatter, by load; each "
        "model has what stands above it, too",
        counts,
    )
    page.data("counts", counts)
    page.text(
        "A model that scatters less from seed to seed has more beyond its scatter at an equal "
        "error. The turbine is the NREL 5 MW by its public definition, but for its aerofoils, "
        "chord and twist, which are those of the default rotor, and the 2.8 MW turbine is similar "
        "to it, on a tower that stands, as its file says. The controller is that of the 5 MW "
        "turbine's definition, its gains made for this rotor, with constant torque above rated "
        "wind (ROSCO's default). Nothing was fitted to the files."
    )
    rows: list[Record] = []
    for (name, model), made in of_model.items():
        if model in (DEFAULT, ALL):
            rows += beside(page, name, model, real[name], made)
            halves = differences(made[::2], made[1::2])
            page.at_most(
                f"{name}, {model}: share of quantities in which seeds differ from other seeds",
                sum(d.beyond for d in halves) / len(halves),
                0.1,
                why="1 % by chance where quantities are independent; they come in families of ten",
                source="both sets are one surrogate",
            )
    answer(page, names[0], counts, rows, len(seeds))
    page.section("What is still left out")
    page.table("Where it may show; no reason was isolated", MISSING, ["quantity", "left out"])
    page.data("differences", rows)


FAMILIES = {
    "Fx": ("Fx",),
    "Fy, Fz, radial": ("Fy", "Fz", "radial"),
    "Mx": ("Mx",),
    "My, Mz, bending": ("My", "Mz", "bending"),
    "loops": ("loops",),
}


def counted(name: str, model: str, found: Sequence[Difference]) -> Record:
    """How many quantities of a history a model does not have, by load."""
    return {
        "history": name,
        "model": model,
        **{family: beyond(found, starts) for family, starts in FAMILIES.items()},
        "all": beyond(found, ("",)),
        "of": len(found),
    }


ASKED_FOR = {
    "My, DEL of m = 4": "equivalent tilt moment, m = 4",
    "My, standard": "standard deviation of the tilt moment",
    "Mx, DEL of m = 4": "equivalent torque, m = 4",
    "Fx, mean": "mean thrust",
}
"""Quantities of the answer, by how their names begin, and what they are called there."""
IN_WORDS = {
    "Fx": "axial force",
    "Fy, Fz, radial": "radial force",
    "Mx": "torque",
    "My, Mz, bending": "bending moment",
    "loops": "load loops",
}
BEYOND = "Quantities of OpenFAST outside a surrogate's scatter by seed, by load"


def answer(
    page: Page, name: str, counts: Sequence[Record], rows: Sequence[Record], seeds: int
) -> None:
    """State what OpenFAST has beyond the default surrogate, and beyond the fullest one."""
    of = sum(int(c["of"]) for c in counts if c["model"] == ALL)
    before, after = (
        100.0 / of * sum(int(c["all"]) for c in counts if c["model"] == model)
        for model in (DEFAULT, ALL)
    )
    most = max(
        FAMILIES,
        key=lambda family: sum(int(c[family]) for c in counts if c["model"] == ALL),
    )
    page.answer(
        "How close are the surrogate's hub loads to those of OpenFAST?",
        f"Of OpenFAST's load quantities {before:.0f}\u00a0% lie outside the default surrogate's "
        f"scatter, {after:.0f}\u00a0% with all modes and tower shadow, most in {IN_WORDS[most]}.",
        [
            page.value(
                "quantities outside the scatter, all modes and tower shadow [%]",
                after,
                beside=before,
                by="default surrogate",
            ),
            *(over_openfast(page, rows, name, *named) for named in ASKED_FOR.items()),
            page.judged(
                f"{name}, {ALL}: mean of Fz, the rotor's weight across the shaft",
                "mean vertical force",
                "OpenFAST",
            ),
        ],
        hero=BEYOND,
        cautions=[
            f"Scatter is that of {seeds} seeds: of two models with equal errors, the one that "
            "scatters less has more quantities outside.",
            "Aerofoils, chord and twist are those of the default rotor; nothing was fitted to "
            "OpenFAST.",
        ],
    )


def over_openfast(
    page: Page, rows: Sequence[Record], name: str, starts: str, words: str
) -> KeyFigure:
    """A quantity of the fullest surrogate beside that of OpenFAST."""
    row = next(
        row
        for row in rows
        if row["history"] == name
        and row["model"] == ALL
        and str(row["quantity"]).startswith(starts)
    )
    unit = str(row["quantity"]).rpartition(" [")[2]
    return page.value(
        f"{words} [{unit}",
        float(row["surrogate"]),
        float(row["scatter of seeds"]),
        beside=float(row["OpenFAST"]),
        by="OpenFAST",
    )


def beyond(found: Sequence[Difference], starts: tuple[str, ...]) -> int:
    """How many of a family differ."""
    return sum(d.beyond and d.quantity.startswith(starts) for d in found)


def surrogates(
    given: Mapping[str, Any], row: Mapping[str, Any], physics: Physics | None, seeds: Sequence[int]
) -> list[dict[str, float]]:
    """Quantities of made histories of ten minutes at 20 Hz."""
    rotor = Rotor(**given["rotors"][row["rotor"]])
    conditions = [Condition(row["wind"], "medium", 0.2, seed) for seed in seeds]
    if physics is None:
        speed = rotor.rotor_speed(row["wind"])
        histories = [hub_loads(condition, rotor=rotor) for condition in conditions]
        recorded = [Recorded(h, np.full(len(h), speed)) for h in histories]
    else:
        turbine = similar_turbine(rotor)
        controller = designed_controller(turbine, Tuning(constant_power=False))
        moves = replace(physics, tower=physics.tower and row["rotor"] not in given["stands"])
        recorded = [h.recorded for h in turbine_histories(conditions, turbine, controller, moves)]
    return [quantities(one) for one in recorded]


def quantities(found: Recorded) -> dict[str, float]:
    """Quantities of a history, by the names that the table has."""
    every = features(digest(found, OPTIONS), OPTIONS.slopes)
    return {str(feature): value for feature, value in every.items()}


def beside(
    page: Page,
    name: str,
    model: str,
    real: Mapping[str, float],
    made: Sequence[Mapping[str, float]],
) -> list[Record]:
    """Tables and answer of one turbine, wind and model; every quantity."""
    found = differences([real], made)
    differing = [d for d in found if d.beyond]
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
    page.section(f"{name}: {model}")
    chosen = (
        "My, standard",
        "My, DEL of m = 4",
        "My, 3P",
        "My, max",
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
    farthest = sorted(differing, key=lambda d: -abs(d.one - d.other) / d.allowed)[:15]
    kept = {d.quantity for d in farthest}
    page.table("Farthest beyond the seeds", [row for row in rows if row["quantity"] in kept])
    weight = next(d for d in found if d.quantity.startswith("Fz, mean"))
    page.equals(
        f"{name}, {model}: mean of Fz, the rotor's weight across the shaft",
        weight.other,
        weight.one,
        within=0.015,
        why="both carry one rotor; wind adds about a percent of it",
        source="OpenFAST",
        unit="kN",
        measure="reaction",
    )
    return [{"history": name, "model": model, **row} for row in rows]


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
                found[file.stem] = quantities(read_recorded(file))
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
