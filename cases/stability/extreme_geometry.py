"""Dimensions driven to their limits and beyond: refused in one sentence, or meshed right."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: By name: what it is, its values, and for a quick run.
SWEEPS: dict[str, tuple[str, tuple[float, ...], tuple[float, ...]]] = {
    "bored": (
        "bore over outer diameter of a shaft of 0.4 m",
        (0.5, 0.6, 0.7, 0.8, 0.9, 0.98, 0.99, 0.999, 0.99999, 1.0),
        (0.5, 0.9, 0.99999, 1.0),
    ),
    "pierced": (
        "thin bore over outer diameter of a shaft of 0.4 m",
        (1e-6, 1e-5, 1e-4, 0.1, 0.2, 0.4),
        (1e-5, 1e-4, 0.2),
    ),
    "filleted": (
        "fillet radius over height of the step of 0.05 m",
        (1e-5, 0.05, 0.1, 0.3, 0.6, 0.9, 0.999, 1 - 1e-7, 1.0, 1.01, 2.0),
        (1e-5, 0.3, 1 - 1e-7, 1.0, 1.01, 2.0),
    ),
    "collared": (
        "length of a collar of 0.5 m on a shaft of 0.4 m [m]",
        (0.0, 1e-9, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1),
        (0.0, 1e-7, 1e-3, 0.1),
    ),
    "seated": (
        "width of the bearing over that of its seat of 0.4 m",
        (0.25, 0.5, 0.9, 0.99, 0.995, 1 - 1e-5, 1.0, 1 + 1e-5, 1.2),
        (0.5, 1 - 1e-5, 1.0, 1.2),
    ),
    "walled": (
        "wall of the housing over the mesh size of 0.15 m",
        (0.05, 0.1, 0.2, 0.3, 0.34, 0.5, 1.0, 2.0),
        (0.05, 0.2, 0.5),
    ),
}
#: Where a finer mesh mends a refusal: parameter values of the second curve.
FINE = {"bored": (0.8, 0.9, 0.98, 0.99), "walled": (0.2, 0.3)}
QUICK_FINE = {"bored": (0.9,), "walled": (0.3,)}

REMEDIES = {
    "bored": "mesh size of two walls",
    "pierced": "leave the bore out: solid",
    "filleted": "fillet as large as the step, or one that leaves a flat of 1e-5 m",
    "collared": "leave the collar out",
    "seated": "bearing as wide as the seat, or with a rim of 1e-5 m beside it",
    "walled": "mesh size of two walls",
}
PROGRAM = {
    "bored": "refuses with the largest mesh size that the wall allows",
    "pierced": "refuses a radius below 1e-5 m, and more than a million elements, foreseen",
    "filleted": "refuses with the largest fillet that the step allows, or the detail left over",
    "collared": "refuses a length of 0 and details below 1e-5 m; refines where elements fold",
    "seated": "refuses with the lengths on which a seat can lie, or the detail left over",
    "walled": "refuses with the largest mesh size that the wall allows",
}


def run(run: Run) -> Any:
    """Mesh each value that is not refused, and compare with the exact shape."""
    from functools import partial

    import numpy as np

    from fe_drivetrain.report import Limit, Section, Table, Text, chart, judge, trace
    from fe_drivetrain.validation import (
        extreme_parts,
    )

    cross = {"symbol": "x", "size": 11, "color": "#c62828"}
    verdicts, sections, limits, bounds = [], [], [], []
    number = refused_in_all = 0
    for name, (parameter, values, quick_values) in SWEEPS.items():
        make = getattr(extreme_parts, name)
        found = []
        for value in quick_values if run.quick else values:
            run.report(f"{parameter}: {value:g}")
            with run.step(name):
                found.append(extreme_parts.outcome(value, make))
        fine = []
        for value in (QUICK_FINE if run.quick else FINE).get(name, ()):
            with run.step(f"{name}, finer mesh"):
                fine.append(extreme_parts.outcome(value, partial(make, fine=True)))
        every = [*found, *fine]
        number += len(every)
        sound = [o for o in every if not o.sentence]
        refused = [o for o in found if o.sentence]
        refused_in_all += len(refused)
        inside = extreme_parts.meshed(found)
        both = extreme_parts.meshed(every)
        verdicts += [
            judge(
                f"{parameter}: error of volumes and named areas over what parabolas round a circle "
                "allow, worst of what was meshed",
                max(o.allowed for o in sound),
                0.0,
                tolerance=1.0,
                relative=False,
                source="exact volumes and areas (cylinders, spheres, Pappus)",
                reason="circles of parabolas, three quarters of the elements a turn asked for",
            ),
            judge(
                f"{parameter}: folded elements and other faults in what was meshed",
                float(sum(o.folded + o.faults for o in sound)),
                0.0,
                tolerance=0.0,
                relative=False,
                source="fe_drivetrain.mesh.checks",
                reason="what is meshed is sound",
                measure="identity",
            ),
            judge(
                f"{parameter}: refusals that lack the allowed range or the mend, or are gmsh's",
                float(sum(not o.clear for o in every)),
                0.0,
                tolerance=0.0,
                relative=False,
                source="one sentence: object, value, allowed range, mend",
                reason="each one",
                measure="identity",
            ),
            judge(
                f"{parameter}: some are refused and some are meshed, with the remedy all of its "
                "values",
                float(bool(refused) and len(inside) > 0 and not any(o.sentence for o in fine)),
                1.0,
                tolerance=0.0,
                relative=False,
                source="this sweep",
                reason="a sweep that fails nowhere is not driven far enough",
                measure="identity",
            ),
        ]
        traces = [
            trace(
                "meshed",
                [o.value for o in found if not o.sentence],
                [max(o.error, 1e-16) for o in found if not o.sentence],
                mode="lines+markers",
            ),
            trace("refused", [o.value for o in refused], [1.0] * len(refused), True, marker=cross),
        ]
        if fine:
            traces.append(
                trace(
                    f"{REMEDIES[name]}: meshed",
                    [o.value for o in fine],
                    [max(o.error, 1e-16) for o in fine],
                    mode="lines+markers",
                )
            )
        low, high = float(inside[0]), float(inside[-1])
        below = any(o.value < low for o in refused)
        above = any(o.value > high for o in refused)
        safe = (low if below else None, high if above else None)
        positive = [o.value for o in every if o.value > 0]
        spread = max(positive) / min(positive) > 100
        sections.append(
            Section(
                title=parameter[0].upper() + parameter[1:],
                items=[
                    chart(
                        "Largest relative error of a volume or a named area; refused values are "
                        "crosses (0 is in the table alone)",
                        traces,
                        parameter,
                        "relative error",
                        ("x", "y") if spread else ("y",),
                        safe=safe,
                    ),
                    Table(
                        caption="Every value",
                        columns=[parameter, "outcome", "largest error", "elements"],
                        rows=[
                            [
                                o.value,
                                o.sentence or "meshed, sound",
                                None if np.isnan(o.error) else o.error,
                                o.elements or None,
                            ]
                            for o in every
                        ],
                    ),
                ],
            )
        )
        gaps = [o.value for o in refused if low < o.value < high]
        limits.append(
            Limit(
                method="building and meshing a part",
                parameter=parameter + (f" (gaps: {', '.join(map(_short, gaps))})" if gaps else ""),
                low=safe[0],
                high=safe[1],
                criterion="volume and areas exact but for parabolas round circles; no fault",
                beyond="refused in one sentence; nothing is meshed wrong",
                program=PROGRAM[name],
                remedy=REMEDIES[name]
                + (f": meshed from {both[0]:g} to {both[-1]:g}" if fine else ""),
            )
        )
        bounds.append(f"{parameter} {_short(low)} to {_short(high)}")
    sections.append(
        Section(
            title="Why details are refused",
            items=[
                Text(
                    text="The CAD kernel takes points nearer than 1e-7 m for one, and before "
                    "that a detail needs elements of its own size all round the shaft. Steps, rims "
                    "and bores below 1e-5 m, less than the tolerance of any turned part of this "
                    "size, are refused; so is what would make more than a million elements, "
                    "which is foreseen from area, length and size of each face before gmsh begins."
                )
            ],
        )
    )
    return CASE.results(
        run,
        summary=[
            f"Of {number} shapes at and beyond their limits {refused_in_all} are refused in one "
            "sentence with the allowed range, and all others are meshed without a fault, with "
            "volumes and named areas exact but for the parabolas that make the circles.",
            "Meshed as asked: " + "; ".join(bounds) + ".",
        ],
        verdicts=verdicts,
        sections=sections,
        limits=limits,
    )


def _short(value: float) -> str:
    return f"1 - {1 - value:.0e}" if 0 < 1 - value < 1e-3 else f"{value:g}"


CASE = Case(
    name="stability/extreme_geometry",
    title="Extreme dimensions: bores, fillets, collars, seats and walls, refused or meshed right",
    source="exact volumes and areas of cylinders, spheres and fillets (Pappus)",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
