"""Bracket with a fillet under an end force, against a plane solution by scikit-fem."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

FILLET, HEIGHT, ARM, LEG = 0.05, 0.1, 0.3, 0.2  # m
FORCE = 1e6  # N/m, per width
E, NU = 169e9, 0.275

#: Hexahedra through the height.
THROUGH = (2, 4, 8)
QUICK_THROUGH = (2, 3, 6)
#: Quartic triangles through the height, of the reference and of one coarser.
REFERENCE = (4, 6)


def run(run: Run) -> Any:
    """Solve the bracket as a solid on three meshes, and as a plane problem."""
    import numpy as np

    from fe_drivetrain.compare import (
        band_of,
    )
    from fe_drivetrain.interfaces import held_freedoms
    from fe_drivetrain.mesh import brick
    from fe_drivetrain.operator import nodal_stresses, principal, traction_loads
    from fe_drivetrain.report import AssumptionRow, Cell, Section, Table, Text, chart, judge, trace
    from fe_drivetrain.scene import Material
    from fe_drivetrain.solve import solve_solid
    from fe_drivetrain.validation.bracket_plane import (
        Bracket,
        plane_answer,
    )
    from fe_drivetrain.validation.ring_solids import (
        node_at,
        plane_strain_hold,
    )

    bracket = Bracket(FILLET, HEIGHT, ARM, LEG)
    lame = Material(youngs_modulus=E, poisson_ratio=NU, density=0.0).lame

    def solve(n: int) -> tuple[dict[str, float], Any]:
        width = HEIGHT / n
        along = bracket.edges(n)

        def shape(unit: Any) -> Any:
            return np.column_stack([width * unit[:, 2], bracket.place(unit[:, 0], unit[:, 1])])

        def traction(x: Any, normal: Any) -> Any:
            zero = np.zeros(len(x))
            return np.column_stack([zero, zero, bracket.end_shear(x[:, 2], FORCE)])

        # thinner elements at the inside, whose stress is what is looked for
        through = (np.arange(n + 1) / n) ** 1.5
        block = brick((n, len(along) - 1, 1), 27, shape, (through, along, None))
        points, size = block.points, block.points.size
        F = traction_loads(points, block.faces["y0"], traction)
        inside = node_at(points, [0.0, -FILLET, -LEG])
        held = [
            plane_strain_hold(block),
            held_freedoms("base", np.append(3 * block.face_nodes("y1") + 2, 3 * inside + 1), size),
        ]
        static = solve_solid(points, block.cells, lame, held, F)
        s = nodal_stresses(points, block.cells, static.u[:, 0], lame)
        edge = block.face_nodes("x0")
        edge = edge[points[edge, 0] == 0.0]
        inside_at = bracket.along_inside(points[edge, 1:])
        edge = edge[np.argsort(inside_at)]
        corner = edge[(points[edge, 1] < 1e-9) & (points[edge, 2] > -1e-9)]
        peaks = principal(s[edge])[:, 2]
        return {
            "energy": float(static.energy[0]) / width,
            "peak": float(principal(s[corner])[:, 2].max()),
            "base": float(s[inside, 2]),
        }, (np.sort(inside_at), peaks)

    levels = QUICK_THROUGH if run.quick else THROUGH
    found: list[dict[str, float]] = []
    profile: Any = None
    for n in levels:
        with run.step(f"solid, {n} hexahedra through the height"):
            values, profile = solve(n)
            found.append(values)
    with run.step("plane problem, scikit-fem"):
        coarse, reference = (plane_answer(bracket, E, NU, FORCE, n) for n in REFERENCE)

    lever = ARM + FILLET + 0.5 * HEIGHT
    nominal = FORCE / HEIGHT + 6.0 * FORCE * lever / HEIGHT**2
    doubt = [abs(fine / rough - 1.0) for fine, rough in zip(reference, coarse, strict=True)]
    sizes = 1.0 / np.array(levels)
    first = HEIGHT / levels[-1] ** 1.5
    missed = 0.5 * (first / FILLET) ** 2
    series = {key: [f[key] for f in found] for key in found[0]}
    plane = "the same bracket in plane strain by scikit-fem: quartic triangles, own assembly"
    verdicts = [
        judge(
            "stiffness P^2 / (2 U) per width",
            0.5e-9 * FORCE**2 / series["energy"][-1],
            0.5e-9 * FORCE**2 / reference[0],
            tolerance=2e-3 if run.quick else 5e-4,
            unit="GN/m/m",
            source=plane,
            reason="energy of elements of second order, which are at most a quarter of the "
            "fillet's radius long there (a third in a quick run), to the fourth power, in a part "
            f"of the bracket; the reference moves by {doubt[0]:.0e} from its next coarser mesh",
            measure="stiffness",
            band=0.5e-9
            * FORCE**2
            * band_of(sizes, series["energy"], 4.0)
            / series["energy"][-1] ** 2,
        ),
        judge(
            "greatest principal stress of the fillet",
            series["peak"][-1] / 1e6,
            reference[1] / 1e6,
            tolerance=0.02 if run.quick else 0.01,
            unit="MPa",
            source=plane,
            reason="hoop stress falls at most as 1 / r^2 from the fillet: recovered stress misses "
            f"6 (h/r)^2 / 12 = {100 * missed:.2f} % of it, with h the first element's height; as "
            "much again for its varying along the fillet. The "
            f"reference moves by {doubt[1]:.0e} from its next coarser mesh",
            measure="stress",
            band=band_of(sizes, series["peak"]) / 1e6,
        ),
        judge(
            "stress of the base's inner fibre",
            series["base"][-1] / 1e6,
            nominal / 1e6,
            tolerance=2e-3,
            unit="MPa",
            source="P / h + 6 P (lever) / h^2, Saint-Venant",
            reason="what the corner disturbs decays as exp(-4.2 x / h), 2e-4 at the base, two "
            "heights away, of a disturbance as great as the stress itself",
            measure="stress",
            band=band_of(sizes, series["base"]) / 1e6,
        ),
    ]
    rows: list[list[Cell]] = [
        [
            f"{n} hexahedra of 27 nodes through the height",
            f["energy"],
            f["peak"] / 1e6,
            f["base"] / 1e6,
        ]
        for n, f in zip(levels, found, strict=True)
    ]
    rows += [
        [f"{n} quartic triangles, plane", energy, peak / 1e6, None]
        for n, (energy, peak) in zip(REFERENCE, (coarse, reference), strict=True)
    ]
    factor = reference[1] / nominal
    last = found[-1]
    ends = [ARM, ARM + 0.5 * np.pi * FILLET]
    return CASE.results(
        run,
        summary=[
            f"The solid bracket is within "
            f"{100 * abs(reference[0] / last['energy'] - 1):.3f} % of the plane solution's "
            f"stiffness and within {100 * abs(last['peak'] / reference[1] - 1):.2f} % of its "
            f"greatest stress in the fillet, {reference[1] / 1e6:.1f} MPa: {factor:.2f} times the "
            "nominal stress of the leg.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Stress along the inside",
                items=[
                    chart(
                        "Greatest principal stress from the end of the arm to the base",
                        [
                            trace("solid, finest mesh", profile[0], profile[1] / 1e6),
                            trace(
                                "greatest in the fillet, plane problem",
                                ends,
                                [reference[1] / 1e6] * 2,
                                line={"dash": "dot"},
                            ),
                            trace(
                                "leg, beam theory",
                                [ends[1], ends[1] + LEG],
                                [nominal / 1e6] * 2,
                                line={"dash": "dot"},
                            ),
                        ],
                        "distance along the inside [m]",
                        "stress [MPa]",
                    ),
                    Table(
                        caption="By mesh",
                        columns=[
                            "mesh",
                            "energy per width [J/m]",
                            "fillet's greatest stress [MPa]",
                            "base's stress [MPa]",
                        ],
                        rows=rows,
                    ),
                    Text(
                        text="A strip bent by a quarter circle, its leg's end on a plane of "
                        "symmetry: half of a C-frame. The force on the end of the arm is a "
                        "parabola of shear, so that nothing is singular. Plane strain."
                    ),
                ],
            )
        ],
        assumptions=[
            AssumptionRow(
                name="fillet, height, arm, leg",
                value=f"{FILLET} / {HEIGHT} / {ARM} / {LEG}",
                unit="m",
                source="a bracket of ordinary proportions; there is no published one with these",
            )
        ],
        figures={"through": levels, "values": found, "reference": [coarse, reference]},
    )


CASE = Case(
    name="verification/bracket",
    title="Bracket with a fillet under an end force",
    source="Plane solution of the same bracket by scikit-fem (quartic triangles); beam theory in "
    "the leg",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
