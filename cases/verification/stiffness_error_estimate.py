"""The error of a stiffness, estimated from one mesh, against the error that it has."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

NAMES = {
    4: "tetrahedra of 4 nodes",
    10: "tetrahedra of 10 nodes",
    8: "hexahedra of 8 nodes",
    20: "hexahedra of 20 nodes",
    27: "hexahedra of 27 nodes",
}
#: Hexahedra across the bars: linear elements need more of them.
DIVISIONS = {4: (4, 8), 8: (4, 8), 10: (2, 5), 20: (2, 4), 27: (2, 4)}
QUICK_DIVISIONS = {4: (4,), 8: (4,), 10: (2, 4), 20: (2,), 27: (2,)}

#: Element sizes [m] of the shafts, and elements round a turn.
MESHES = ((0.25, 10), (0.16, 14))
QUICK_MESHES = ((0.25, 10),)

#: Allowed factor between the estimated and the true error.
FACTOR = 3.0
REASON = (
    "an estimate is of use where it is right within a factor of three: that is the factor on it "
    "that makes a band"
)


def run(run: Run) -> Any:
    """Estimate the errors of bars and shafts, and compare."""
    import numpy as np

    from fe_drivetrain.cases.verification import rigid_balance
    from fe_drivetrain.report import Section, Table, Text, chart, judge, trace
    from fe_drivetrain.solve import recovery_estimate
    from fe_drivetrain.validation import (
        exact_blocks,
        rigid_ended_shafts,
    )

    rows: list[list[Any]] = []
    verdicts, traces = [], []

    def add(
        problem: str, element: str, unknowns: int, error: float, found: Any, source: str
    ) -> float:
        """A row and its verdict; the effectivity."""
        effectivity = found.relative / error
        rows.append([problem, element, unknowns, 100 * error, 100 * found.relative, effectivity])
        verdicts.append(
            judge(
                f"{problem}, {element}, {unknowns:,} unknowns: factor between estimated and true "
                "error, common logarithm",
                float(np.log10(effectivity)) if effectivity > 0 else float("nan"),
                0.0,
                tolerance=float(np.log10(FACTOR)),
                relative=False,
                source=source,
                reason=REASON,
            )
        )
        return float(effectivity)

    bars = {
        "cantilever with shear": (
            exact_blocks.cantilever,
            "Timoshenko and Goodier 1970, Theory of Elasticity, art. 21",
        ),
        "twisted square bar": (
            exact_blocks.twisted,
            "Saint-Venant; Timoshenko and Goodier 1970, art. 109",
        ),
    }
    divisions = QUICK_DIVISIONS if run.quick else DIVISIONS
    with run.step("bars"):
        for problem, (solve, source) in bars.items():
            for nodes, series in divisions.items():
                run.report(f"{problem}: {NAMES[nodes]}")
                sizes, effectivities = [], []
                for across in series:
                    bar = solve(nodes, across)
                    found = recovery_estimate(
                        bar.block.points, [(bar.block.cells, bar.lame)], bar.u
                    )
                    # forces given: too little energy, k too high; displacements given: too much
                    ratio = bar.exact / bar.energy
                    k = ratio if problem.startswith("cantilever") else 1.0 / ratio
                    sizes.append(bar.unknowns)
                    effectivities.append(
                        add(problem, NAMES[nodes], bar.unknowns, k - 1.0, found, source)
                    )
                traces.append(
                    trace(f"{problem}, {nodes} nodes", sizes, effectivities, mode="lines+markers")
                )

    source = "the shaft's meridian in fourth-order elements, graded to its corners"
    exact_rows: list[list[Any]] = []
    imbalances: list[float] = []
    for name, shaft in rigid_ended_shafts.SHAFTS.items():
        if run.quick and name == "bored":
            continue
        with run.step("reference of the shafts"):
            exact = rigid_ended_shafts.exact(shaft, 0.1, 10)
            rough = rigid_ended_shafts.exact(shaft, 0.1, 5)
        smooth = name != "stepped, sharp"
        sizes_of: list[int] = []
        found_of: dict[str, list[float]] = {load: [] for load in exact}
        for size, turn in QUICK_MESHES if run.quick else MESHES:
            with run.step("meshes of the shafts"):
                mesh = rigid_ended_shafts.meshed(shaft, size, turn)
            with run.step("shafts"):
                shaft_found = rigid_ended_shafts.solved(mesh, shaft)
            sizes_of.append(shaft_found.unknowns)
            imbalances.append(shaft_found.imbalance)
            for load, k in shaft_found.stiffness.items():
                estimate = shaft_found.estimate[load]
                error = k / exact[load] - 1.0
                if smooth and load == "torsion":
                    # the polar moment is too low, and more of the error than the elements' share
                    shape = _shape_error(mesh, shaft)
                    exact_rows.append(
                        [
                            f"{name}, torsion",
                            shaft_found.unknowns,
                            *(1e6 * e for e in (error, shape, error - shape, estimate.relative)),
                        ]
                    )
                    error -= shape
                found_of[load].append(
                    add(
                        f"{name} shaft, {load}" + ", less shape" * (smooth and load == "torsion"),
                        "curved tetrahedra of 10 nodes",
                        shaft_found.unknowns,
                        error,
                        estimate,
                        f"{source}; uncertain by {abs(rough[load] / exact[load] - 1):.1g}",
                    )
                )
        traces += [
            trace(f"{name} shaft, {load}", sizes_of, values, mode="lines+markers")
            for load, values in found_of.items()
            if values
        ]

    verdicts.append(rigid_balance.balance_verdict(imbalances))
    effectivity = np.array([row[-1] for row in rows])
    return CASE.results(
        run,
        summary=[
            f"The estimated error of a stiffness is {effectivity.min():.2f} to "
            f"{effectivity.max():.2f} times the true one over {len(rows)} meshes: bars in five "
            "elements with smooth solutions, and shafts between rigid ends, whose stress is "
            "singular at the ends and at the step.",
            f"Its median is {np.median(effectivity):.2f}. So three times the estimate is a band "
            "that holds the answer, from the one mesh.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Effectivity",
                items=[
                    chart(
                        "Estimated over true error of the stiffness",
                        traces,
                        "unknowns",
                        "effectivity",
                        ("x", "y"),
                    ),
                    Table(
                        caption="Error of the stiffness, which is too high, and its estimate",
                        columns=[
                            "problem",
                            "element",
                            "unknowns",
                            "true error [%]",
                            "estimated [%]",
                            "effectivity",
                        ],
                        rows=rows,
                    ),
                ],
            ),
            Section(
                title="What the estimate does not see",
                items=[
                    Text(
                        text="Torsion of a shaft of uniform section moves points by products of "
                        "two coordinates, which straight quadratic elements contain and curved "
                        "ones nearly do. As large as what these miss is the error of the shape: "
                        "the polar moment of the section as it is meshed. Of that an estimate from "
                        "stresses knows nothing; the mesh's own moments do, and more elements "
                        "round a turn mend it. The effectivity above is that of the rest."
                    ),
                    Table(
                        caption="Uniform shafts in torsion, curved tetrahedra: errors in parts "
                        "per million",
                        columns=[
                            "shaft",
                            "unknowns",
                            "error of the stiffness",
                            "error of the meshed polar moment",
                            "the rest",
                            "estimated error",
                        ],
                        rows=exact_rows,
                    ),
                ],
            ),
        ],
        figures={"effectivity": effectivity.tolist()},
    )


def _shape_error(mesh: Any, shaft: Any) -> float:
    """Relative error of the integral of y^2 + z^2 over the mesh."""
    import numpy as np
    from skfem.quadrature import get_quadrature
    from skfem.refdom import RefTet

    from fe_drivetrain.mesh import element_kind, jacobian, shape_functions

    at, weights = get_quadrature(RefTet, 7)
    values, gradients = shape_functions(element_kind(10).element, at)
    volumes = np.abs(jacobian(mesh.points, mesh.cells, gradients)[1]) * weights
    positions = np.einsum("qn,eni->eqi", values, mesh.points[mesh.cells])
    found = float((volumes * (positions[..., 1] ** 2 + positions[..., 2] ** 2)).sum())
    exact = sum(
        np.pi / 32 * (p.outer_diameter**4 - p.inner_diameter**4) * p.length for p in shaft.pieces
    )
    return found / float(exact) - 1.0


CASE = Case(
    name="verification/stiffness_error_estimate",
    title="Error of a stiffness estimated from one mesh: effectivity on exact cases",
    source="Zienkiewicz and Zhu 1987, Int. J. Numer. Meth. Eng. 24, 337-357, and 1992, ibid. 33, "
    "1331-1364; Timoshenko and Goodier 1970, Theory of Elasticity",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
