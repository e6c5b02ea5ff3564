"""Dimensions driven to their limits and beyond: refused in one sentence, or meshed right."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.stability import extreme_parts
from fe_drivetrain.report import crosses, marked
from fe_drivetrain.report.suite import Page, Run


@dataclass(frozen=True)
class Sweep:
    """One dimension.

    Attributes
    ----------
    make : callable
        Makes the part of a value.
    parameter : str
        What is varied.
    values, quick : tuple of float
        Its values, and those of a quick run.
    program, remedy : str
        What the program does beyond the limits, and what the user can do.
    finer, quick_finer : tuple of float
        Values that a finer mesh makes possible.
    """

    make: Callable[..., Any]
    parameter: str
    values: tuple[float, ...]
    quick: tuple[float, ...]
    program: str
    remedy: str
    finer: tuple[float, ...] = ()
    quick_finer: tuple[float, ...] = ()


SWEEPS = (
    Sweep(
        extreme_parts.bored,
        "bore over outer diameter of a shaft of 0.4 m",
        (0.5, 0.6, 0.7, 0.8, 0.9, 0.98, 0.99, 0.999, 0.99999, 1.0),
        (0.5, 0.9, 0.99999, 1.0),
        "refuses with the largest mesh size that the wall allows",
        "mesh size of two walls",
        (0.8, 0.9, 0.98, 0.99),
        (0.9,),
    ),
    Sweep(
        extreme_parts.pierced,
        "thin bore over outer diameter of a shaft of 0.4 m",
        (1e-6, 1e-5, 1e-4, 0.1, 0.2, 0.4),
        (1e-5, 1e-4, 0.2),
        "refuses a radius below 1e-5 m, and more than a million elements, foreseen",
        "leave the bore out: solid",
    ),
    Sweep(
        extreme_parts.filleted,
        "fillet radius over height of the step of 0.05 m",
        (1e-5, 0.05, 0.1, 0.3, 0.6, 0.9, 0.999, 1 - 1e-7, 1.0, 1.01, 2.0),
        (1e-5, 0.3, 1 - 1e-7, 1.0, 1.01, 2.0),
        "refuses with the largest fillet that the step allows, or the detail left over",
        "fillet as large as the step, or one that leaves a flat of 1e-5 m",
    ),
    Sweep(
        extreme_parts.collared,
        "length of a collar of 0.5 m on a shaft of 0.4 m [m]",
        (0.0, 1e-9, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1),
        (0.0, 1e-7, 1e-3, 0.1),
        "refuses a length of 0 and details below 1e-5 m; refines where elements fold",
        "leave the collar out",
    ),
    Sweep(
        extreme_parts.seated,
        "width of the bearing over that of its seat of 0.4 m",
        (0.25, 0.5, 0.9, 0.99, 0.995, 1 - 1e-5, 1.0, 1 + 1e-5, 1.2),
        (0.5, 1 - 1e-5, 1.0, 1.2),
        "refuses with the lengths on which a seat can lie, or the detail left over",
        "bearing as wide as the seat, or with a rim of 1e-5 m beside it",
    ),
    Sweep(
        extreme_parts.walled,
        "wall of the housing over the mesh size of 0.15 m",
        (0.05, 0.1, 0.2, 0.3, 0.34, 0.5, 1.0, 2.0),
        (0.05, 0.2, 0.5),
        "refuses with the largest mesh size that the wall allows",
        "mesh size of two walls",
        (0.2, 0.3),
        (0.3,),
    ),
)


@case(
    "Extreme dimensions: bores, fillets, collars, seats and walls, refused or meshed right",
    source="exact volumes and areas of cylinders, spheres and fillets (Pappus)",
)
def run(run: Run, page: Page) -> None:
    """Mesh each value that is not refused, and compare with the exact shape."""
    swept = [(sweep, *outcomes(run, sweep)) for sweep in SWEEPS]
    bounds = [show(page, *one) for one in swept]
    answer(page, [(found, fine) for _, found, fine in swept])
    page.section("Why details are refused")
    page.text(
        "The CAD kernel takes points nearer than 1e-7 m for one, and before that a detail needs "
        "elements of its own size all round the shaft. Steps, rims and bores below 1e-5 m, less "
        "than the tolerance of any turned part of this size, are refused; so is what would make "
        "more than a million elements, which is foreseen from area, length and size of each face "
        "before gmsh begins."
    )
    page.say(
        "Volumes and named areas of what is meshed are exact but for the parabolas that make the "
        "circles, and for rims of the shaft's ends that are drawn back where an element would "
        "fold.",
        f"Meshed as asked: {'; '.join(bounds)}.",
    )
    collared = extreme_parts.collared(0.05).shaft
    assert collared is not None
    page.image("A shaft with a narrow collar", run.sketch(collared))


Outcomes = list[extreme_parts.Outcome]


def answer(page: Page, swept: list[tuple[Outcomes, Outcomes]]) -> None:
    """State how many shapes are meshed wrong, and how thin a hollow shaft's wall may be."""
    every = [one for found, fine in swept for one in (*found, *fine)]
    meshed = [one for one in every if not one.sentence]
    refused, unclear = len(every) - len(meshed), sum(not one.clear for one in every)
    wrong = sum(one.allowed > 1.0 or one.folded + one.faults > 0 for one in meshed)
    bored, finer = swept[0]
    as_asked, finest = (float(extreme_parts.meshed(some)[-1]) for some in (bored, [*bored, *finer]))
    page.answer(
        "What becomes of a shaft or housing with extreme dimensions?",
        f"{wrong or 'None'} of {len(every)} extreme shapes {'are' if wrong > 1 else 'is'} meshed "
        f"wrongly: {refused} are rejected with the allowed range; bores may reach {short(finest)} "
        "of a shaft's outer diameter.",
        [
            page.value("shapes meshed wrongly", wrong, at_most=0.0),
            page.value(
                "rejections that do not state the allowed range or a remedy", unclear, at_most=0.0
            ),
            page.value("shapes rejected", refused),
            page.value("largest bore over outer diameter, element size as asked for", as_asked),
            page.value("largest bore over outer diameter, element size twice the wall", finest),
            page.value(
                "worst error of a volume or area, over what element edges allow",
                max(one.allowed for one in meshed),
                at_most=1.0,
            ),
        ],
        hero=caption_of_errors(SWEEPS[0].parameter),
        cautions=[
            "Limits of bores and walls are those of one mesh size: smaller elements allow thinner "
            "walls."
        ],
    )


def caption_of_errors(parameter: str) -> str:
    """Caption of the chart of one dimension."""
    return (
        f"Largest error of a volume or a named area over the {parameter}; shaded: meshed as asked, "
        "crosses: refused (0 is in the table alone)"
    )


def outcomes(run: Run, sweep: Sweep) -> tuple[Outcomes, Outcomes]:
    """What comes of each value, and of some in a finer mesh."""
    name, found, fine = sweep.make.__name__, [], []
    for value in sweep.quick if run.quick else sweep.values:
        run.report(f"{sweep.parameter}: {value:g}")
        with run.step(name):
            found.append(extreme_parts.outcome(value, sweep.make))
    for value in sweep.quick_finer if run.quick else sweep.finer:
        with run.step(f"{name}, finer mesh"):
            fine.append(extreme_parts.outcome(value, partial(sweep.make, fine=True)))
    return found, fine


def show(page: Page, sweep: Sweep, found: Outcomes, fine: Outcomes) -> str:
    """Checks, chart, table and limit of one dimension; its range in words."""
    parameter, every = sweep.parameter, [*found, *fine]
    refused = [o for o in found if o.sentence]
    inside, both = extreme_parts.meshed(found), extreme_parts.meshed(every)
    check(page, parameter, every)
    page.holds(
        f"{parameter}: some are refused and some are meshed, with the remedy all of its values",
        bool(refused) and len(inside) > 0 and not any(o.sentence for o in fine),
        why="a sweep that fails nowhere is not driven far enough",
        source="this sweep",
    )
    low, high = float(inside[0]), float(inside[-1])
    safe = (
        low if any(o.value < low for o in refused) else None,
        high if any(o.value > high for o in refused) else None,
    )
    gaps = [o.value for o in refused if low < o.value < high]
    page.limit(
        "building and meshing a part",
        parameter + (f" (gaps: {', '.join(map(short, gaps))})" if gaps else ""),
        low=safe[0],
        high=safe[1],
        criterion="volume and areas exact but for parabolas round circles and rims drawn back; no "
        "fault",
        beyond="refused in one sentence; nothing is meshed wrong",
        program=sweep.program,
        remedy=sweep.remedy + (f": meshed from {both[0]:g} to {both[-1]:g}" if fine else ""),
    )
    show_outcomes(page, sweep, found, fine, safe)
    return f"{parameter}: {short(low)} to {short(high)}"


def check(page: Page, parameter: str, every: Outcomes) -> None:
    """Check that meshed shapes are exact, and that each refusal says how to correct the value."""
    page.at_most(
        f"{parameter}: error of volumes and named areas over what parabolas round a circle allow, "
        "and rims drawn back, worst of what was meshed",
        max(o.allowed for o in every if not o.sentence),
        1.0,
        why="circles of parabolas, three quarters of the elements a turn asked for; rims are drawn "
        "back where an element would fold, by as much as their nodes are off the circle",
        source="exact volumes and areas (cylinders, spheres, Pappus)",
    )
    page.vanishes(
        f"{parameter}: folded elements and other faults in what was meshed",
        sum(o.folded + o.faults for o in every if not o.sentence),
        within=0.0,
        why="a mesh that the program accepts is solved without further checks",
        source="fe_drivetrain.elasticity.mesh.checks",
    )
    page.vanishes(
        f"{parameter}: refusals without the allowed range or the fix, or in gmsh's words",
        sum(not o.clear for o in every),
        within=0.0,
        why="every refusal has to enable the user to correct the value",
        source="one sentence: object, value, allowed range, fix",
    )


def show_outcomes(
    page: Page,
    sweep: Sweep,
    found: Outcomes,
    fine: Outcomes,
    safe: tuple[float | None, float | None],
) -> None:
    """Show the errors and every value."""
    parameter, every = sweep.parameter, [*found, *fine]
    page.section(parameter[0].upper() + parameter[1:])
    traces = [curve("meshed", [o for o in found if not o.sentence])]
    traces.append(crosses("refused", [o.value for o in found if o.sentence]))
    if fine:
        traces.append(curve(f"{sweep.remedy}: meshed", fine))
    positive = [o.value for o in every if o.value > 0]
    page.chart(
        caption_of_errors(parameter),
        traces,
        parameter,
        "relative error",
        "xy" if max(positive) / min(positive) > 100 else "y",
        safe,
    )
    rows = [
        {
            parameter: o.value,
            "outcome": o.sentence or "meshed, sound",
            "largest error": None if np.isnan(o.error) else o.error,
            "elements": o.elements or None,
        }
        for o in every
    ]
    page.table("Every value", rows)
    page.data(parameter, rows)


def curve(name: str, meshed: Outcomes) -> Any:
    """Errors of what was meshed."""
    errors = [max(o.error, 1e-16) for o in meshed]
    return marked(name, [o.value for o in meshed], errors)


def short(value: float) -> str:
    """A number in few digits, also where it is close to one."""
    return f"1 - {1 - value:.0e}" if 0 < 1 - value < 1e-3 else f"{value:g}"
