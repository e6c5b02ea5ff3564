"""Level 2 in torsion of a stepped shaft, to 1e-8: between two bounds that leave no more."""

from itertools import pairwise
from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

LARGE, SMALL, LENGTH = 0.6, 0.4, 0.6
BORES = {"bored": 0.2, "solid": 0.0}

#: Order and layers of elements at the corners, from coarse to fine.
SETTINGS = ((4, 3), (5, 4), (6, 5), (8, 6), (10, 8))
QUICK_SETTINGS = SETTINGS[:4]

#: Element size of the bounds [m], and halvings at the corners: below, size is what is left.
SIZES = (0.05, 0.025, 0.0125)
HALVINGS = 24
CLAIM = 1e-8


def run(run: Run) -> Any:
    """The bounds closed in on, and the meridian's 12 x 12 between them."""
    from fe_drivetrain.cases.verification import shaft_inputs
    from fe_drivetrain.geometry import Section as Length
    from fe_drivetrain.geometry import Shaft
    from fe_drivetrain.report import Section, Table, Text, chart, judge, trace
    from fe_drivetrain.revolution import meridian, stiffness_between_ends
    from fe_drivetrain.scene import MATERIALS
    from fe_drivetrain.validation.torsion_meridian import (
        torsion_bounds,
    )

    steel = MATERIALS["steel"]
    verdicts, traces = [], []
    rows: list[list[Any]] = []
    widths: list[list[Any]] = []
    errors = {}
    sizes = SIZES[:1] if run.quick else SIZES
    settings = QUICK_SETTINGS if run.quick else SETTINGS
    for name, bore in BORES.items():
        shaft = Shaft(
            front=0.0,
            sections=tuple(
                Length(length=LENGTH, outer_diameter=outer, inner_diameter=bore)
                for outer in (LARGE, SMALL)
            ),
        )
        with run.step(f"{name}: bounds"):
            all_bounds = [
                torsion_bounds(shaft, steel.shear_modulus, size, HALVINGS) for size in sizes
            ]
        bounds = all_bounds[-1]
        width = 2 * bounds.half_width / bounds.middle
        widths += [
            [name, 1e3 * size, b.lower, b.upper, 2 * b.half_width / b.middle]
            for size, b in zip(sizes, all_bounds, strict=True)
        ]
        found, unknowns = [], []
        for order, layers in settings:
            with run.step(f"{name}: meridian"):
                mesh = meridian(shaft, order=order, layers=layers)
                found.append(float(stiffness_between_ends(mesh, steel)[3, 3]))
            unknowns.append(len(mesh.nodes))
            rows.append([name, order, layers, unknowns[-1], found[-1]])
            rows[-1].append(found[-1] / bounds.middle - 1)
        errors[name] = abs(found[-1] / bounds.middle - 1)
        traces.append(trace(name, unknowns, [abs(k / bounds.middle - 1) for k in found]))
        verdicts += [
            judge(
                f"{name}: torsional stiffness, order {settings[-1][0]}",
                found[-1],
                bounds.middle,
                tolerance=width / 2,
                unit="N m/rad",
                source="between two bounds, by displacements and by the torsion function (Michell "
                "1899), in triangles of scikit-fem",
                reason="half the distance of the bounds",
                measure="stiffness",
                band=abs(found[-1] - found[-2]),
            ),
            judge(
                f"{name}: width of the bounds, relative",
                width,
                0.0,
                tolerance=1e-6 if run.quick else CLAIM,
                relative=False,
                source="exact stiffness lies between them",
                reason="coarse bounds of a quick run" if run.quick else "what is to be shown",
                measure="identity",
                band=0.0,
            ),
            judge(
                f"{name}: most by which stiffness grows as elements gain freedom, relative",
                max(0.0, *(b / a - 1 for a, b in pairwise(found))),
                0.0,
                tolerance=1e-10,
                relative=False,
                source="displacements of the coarser mesh make no less energy",
                reason="round-off; the meshes are nested but for the middle of the corners",
                measure="identity",
                band=0.0,
            ),
        ]
    return CASE.results(
        run,
        summary=[
            f"The torsional stiffness of a stepped shaft between rigid ends is that of two bounds "
            f"to {max(errors.values()):.1g}; the bounds are "
            f"{max(w[4] for w in widths if w[1] == 1e3 * sizes[-1]):.1g} apart.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Torsion",
                items=[
                    chart(
                        "Difference of the meridian's stiffness from the bounds' middle",
                        traces,
                        "nodes, one unknown each",
                        "relative difference [-]",
                        logarithmic="xy",
                    ),
                    Table(
                        caption="Meridian between rigid ends",
                        columns=[
                            "shaft",
                            "order",
                            "layers at corners",
                            "nodes",
                            "stiffness [N m/rad]",
                            "from the bounds' middle, relative",
                        ],
                        rows=rows,
                    ),
                    Table(
                        caption="Bounds",
                        columns=[
                            "shaft",
                            "element size [mm]",
                            "lower [N m/rad]",
                            "upper [N m/rad]",
                            "width, relative",
                        ],
                        rows=widths,
                    ),
                    Text(
                        text=f"Bounds: triangles of fourth order, halved {HALVINGS} times at the "
                        "corners, so that the size elsewhere is what is left. The upper one is the "
                        "energy of an angle of twist, the lower one that of a torsion function; "
                        "both are least, and nothing is shared with the meridian's program but the "
                        "outline. Of the solid shaft the lower bound takes the torsion function "
                        "on the step's face by interpolation, and is a bound but for that."
                    ),
                    shaft_inputs.inputs(
                        ("large diameter", LARGE, "m", "chosen"),
                        ("small diameter", SMALL, "m", "chosen"),
                        ("bore of the bored shaft", BORES["bored"], "m", "chosen"),
                        ("length of each part", LENGTH, "m", "chosen"),
                        *shaft_inputs.steel_rows(steel),
                    ),
                ],
            )
        ],
        figures={"errors": errors},
    )


CASE = Case(
    name="fidelity/level_two_torsion",
    title="Level 2 in torsion of a stepped shaft, to 1e-8",
    source="Two bounds of the stiffness from scalar problems in the meridian (Michell 1899)",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
