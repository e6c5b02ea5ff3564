"""Short and long numbers: how many digits of a stiffness survive over L/D and the mesh."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

LOADS = ("bending", "torsion")

#: What round-off takes, as powers of L/D, where elements are as many at any length: the energy of
#: a rigid motion of the far end, E L u^2, over that of bending, 3 E I u^2 / L^3, and of torsion.
EXPONENTS = {"bending": 4.0, "torsion": 2.0}


def run(run: Run) -> Any:
    """Assemble and solve tubes in 32, 64 and 80 bits."""
    import numpy as np

    from fe_drivetrain.cases.stability.decades import (
        FOUR_DIGITS,
        safe_range,
        shown,
        slope,
    )
    from fe_drivetrain.report import Limit, Section, Table, Text, chart, judge, trace
    from fe_drivetrain.validation import (
        other_precisions,
    )

    turn, along = (4, 10) if run.quick else (8, 10)
    per_decade = 1.5 if run.quick else 3.0
    slenderness = 10.0 ** np.arange(0.0, 3.34, 1.0 / per_decade)

    def solved(L_over_D: float, turn: int, along: int) -> dict[str, Any]:
        """Relative errors (2,) by precision, the reference's own, and what the program says."""
        solid = other_precisions.tube(L_over_D, turn, along)
        short, double, long = (
            other_precisions.summed(solid, kind) for kind in (np.float32, np.float64, np.longdouble)
        )
        best = other_precisions.refined(long, double, solid.load, 14)
        before = other_precisions.refined(long, double, solid.load, 10)
        exact = other_precisions.compliances(solid, best)

        def error(u: Any) -> Any:
            return np.abs((other_precisions.compliances(solid, u) / exact - 1.0).astype(float))

        program, residual = other_precisions.by_the_program(double, solid.load)
        mixed = other_precisions.refined(double, double.astype(np.float32), solid.load, 20)
        return {
            "32 bits": error(other_precisions.solved(short, solid.load)),
            "64 bits": error(other_precisions.solved(double, solid.load)),
            "program": error(program),
            "mixed": error(mixed),
            "80 bits": error(before),
            "residual": residual,
            "unknowns": len(solid.free),
        }

    found = []
    for value in slenderness:
        with run.step("tubes of 32, 64 and 80 bits"):
            run.report(f"L/D = {value:.3g}")
            found.append(solved(float(value), turn, min(along, max(2, round(4 * value)))))
    meshes = ((4, 5), (8, 10)) if run.quick else ((4, 5), (8, 10), (12, 15))
    with run.step("meshes"):
        refined = [solved(4.0, *mesh) for mesh in meshes]

    def of(precision: str, load: int) -> Any:
        return np.array([f[precision][load] for f in found])

    verdicts, limits, sections = [], [], []
    highs: dict[tuple[str, str], float | None] = {}
    tolerance = 0.3 if run.quick else 0.15
    for k, load in enumerate(LOADS):
        double = of("64 bits", k)
        usable = (of("80 bits", k) < 0.1 * double) & (slenderness >= 2.0)
        verdicts.append(
            judge(
                f"{load}, 64 bits: error against L/D, exponent",
                slope(slenderness[usable], double[usable], (1e-15, 0.1)),
                EXPONENTS[load],
                tolerance=tolerance,
                source="energy of a rigid motion of the end over that of the deformation",
                reason="round-off scatters by about a decade over the decades of the fit",
                measure="order",
                band=0.5 * tolerance * EXPONENTS[load],
            )
        )
        short = of("32 bits", k)
        both = (short < 0.1) & (double > 0.0)
        decades_apart = np.log10(short[both] / double[both])
        verdicts.append(
            judge(
                f"{load}: digits between 32 and 64 bits, mean",
                float(decades_apart.mean()),
                float(29 * np.log10(2.0)),
                tolerance=1.0,
                relative=False,
                unit="digits",
                source="29 bits more of the mantissa",
                reason="round-off scatters by about a decade",
                measure="identity",
                band=float(decades_apart.std() / np.sqrt(len(decades_apart))),
            )
        )
        for name, precision in (
            ("32 bits", "32 bits"),
            ("64 bits", "64 bits"),
            ("32 bits, refined with residuals of 64", "mixed"),
        ):
            try:
                highs[precision, load] = safe_range(slenderness, of(precision, k), FOUR_DIGITS)[1]
            except ValueError:  # not even the shortest
                highs[precision, load] = 0.0
            if precision == "64 bits":
                program = "computes in 64 bits throughout; refuses a residual above 1e-2"
                remedy = "residuals of 80 bits: right to " + f"{of('80 bits', k).max():.0e} here; "
                remedy += "beam or meridian, which condense before they add"
            else:
                program = "never computes in 32 bits"
                remedy = "64 bits"
            limits.append(
                Limit(
                    method=f"direct solution in {name}: {load}",
                    parameter="L/D of a tube",
                    high=highs[precision, load],
                    criterion="error of the stiffness below 1e-4",
                    beyond=f"the error grows as (L/D)^{EXPONENTS[load]:.0f}"
                    if precision != "mixed"
                    else "refinement no longer converges, and answers are of any size",
                    program=program,
                    remedy=remedy,
                )
            )
        program_error = of("program", k)
        refused = ~np.isfinite(program_error)

        def clipped(values: Any) -> Any:
            return np.clip(np.where(np.isfinite(values), values, 10.0), 1e-17, 10.0)

        sections.append(
            Section(
                title=load.capitalize(),
                items=[
                    chart(
                        "Error of the stiffness of a tube against the solution with residuals of "
                        f"80 bits on the same mesh, {load}. Shaded: four digits in 64 bits; "
                        "above 1 there are none. Crosses: the program refuses",
                        [
                            trace("32 bits", slenderness, clipped(short)),
                            trace("64 bits", slenderness, clipped(double)),
                            trace(
                                "factor of 32 bits, residuals of 64",
                                slenderness,
                                clipped(of("mixed", k)),
                                line={"dash": "dash"},
                            ),
                            trace(
                                "factor of 64 bits, residuals of 80, two counts of steps",
                                slenderness,
                                clipped(of("80 bits", k)),
                                line={"dash": "dash"},
                            ),
                            trace(
                                "the program",
                                slenderness[~refused],
                                clipped(program_error[~refused]),
                                True,
                            ),
                            trace(
                                "the program refuses",
                                slenderness[refused],
                                np.ones(refused.sum()),
                                True,
                                marker={"symbol": "x"},
                            ),
                        ],
                        "L/D",
                        "relative error",
                        ("x", "y"),
                        (None, highs["64 bits", load]),
                    )
                ],
            )
        )
    bending = of("program", 0)
    # NaN is refused: no comparison holds
    verdicts.append(
        judge(
            "bending: the worst answer that the program gives without refusing",
            float(np.nanmax(bending)),
            0.0,
            tolerance=1e-2,
            relative=False,
            source="residuals of 80 bits",
            reason="a residual of 1e-2 is what it refuses; of a slender solid the error is no more",
            measure="identity",
            band=float(of("80 bits", 0)[np.isfinite(bending)].max()),
        )
    )
    short = of("32 bits", 0)
    usable = short < 0.1
    verdicts.append(
        judge(
            "bending: 32 bits refined with residuals of 64, worst error where 32 bits have a digit",
            float(of("mixed", 0)[usable].max()),
            0.0,
            tolerance=FOUR_DIGITS,
            relative=False,
            source="residuals of 80 bits",
            reason="refinement converges where the factor has a digit; four digits of stiffness",
            measure="identity",
            band=float(of("80 bits", 0)[usable].max()),
        )
    )
    rows = [
        [
            float(x),
            f["unknowns"],
            *(
                float(f[p][k]) if np.isfinite(f[p][k]) else None
                for k in (0, 1)
                for p in ("32 bits", "64 bits", "mixed", "80 bits")
            ),
            f["residual"] if np.isfinite(f["residual"]) else None,
        ]
        for x, f in zip([*slenderness, *[4.0] * len(meshes)], [*found, *refined], strict=True)
    ]
    digits = {
        (p, load): -np.log10(np.maximum([f[p][k] for f in refined], 1e-17))
        for k, load in enumerate(LOADS)
        for p in ("32 bits", "64 bits")
    }
    return CASE.results(
        run,
        summary=[
            "Four digits of the bending stiffness of a tube survive up to L/D = "
            f"{shown(highs['32 bits', 'bending'])} in 32 bits and "
            f"{shown(highs['64 bits', 'bending'])} in 64; of its torsional stiffness up to "
            f"{shown(highs['32 bits', 'torsion'])} in 32, and "
            + (
                "at all lengths tried in 64."
                if highs["64 bits", "torsion"] is None
                else f"{shown(highs['64 bits', 'torsion'])} in 64."
            ),
            "Round-off takes the fourth power of L/D in bending and the second in torsion; the "
            "mesh matters little: "
            f"{digits['32 bits', 'bending'].min():.1f} to {digits['32 bits', 'bending'].max():.1f} "
            "digits of bending in 32 bits and "
            f"{digits['64 bits', 'bending'].min():.1f} to {digits['64 bits', 'bending'].max():.1f} "
            f"in 64 on {len(meshes)} meshes of L/D = 4.",
            "A factor in 32 bits with residuals in 64 gives all digits back up to L/D = "
            f"{shown(highs['mixed', 'bending'])}.",
        ],
        verdicts=verdicts,
        sections=[
            *sections,
            Section(
                title="All points",
                items=[
                    Table(
                        caption="Relative errors; the last rows are meshes of one length. 80 bits: "
                        "what the last four of fourteen steps of refinement changed",
                        columns=[
                            "L/D",
                            "unknowns",
                            *(
                                f"{load}, {p}"
                                for load in LOADS
                                for p in ("32", "64", "32 refined by 64", "64 refined by 80")
                            ),
                            "the program's residual",
                        ],
                        rows=rows,
                    ),
                    Text(
                        text="Assembly, sums and factor are all in the precision named; the nodes "
                        "have coordinates of 32 bits in each, so that all solve the same solid. "
                        "Elements are as many at any length from three diameters on: their own "
                        "error is the same in each precision and not in the comparison."
                    ),
                ],
            ),
        ],
        limits=limits,
        figures={
            "slenderness": slenderness.tolist(),
            **{
                f"{load}, {p}": [float(v) if np.isfinite(v) else None for v in of(p, k)]
                for k, load in enumerate(LOADS)
                for p in ("32 bits", "64 bits", "mixed")
            },
        },
    )


CASE = Case(
    name="stability/precision",
    title="Short and long numbers: digits of a stiffness over L/D and the mesh",
    source="Higham 2002, Accuracy and stability of numerical algorithms, ch. 12; Melosh 1969, "
    "Manipulation errors in finite element analysis; IEEE 754",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
