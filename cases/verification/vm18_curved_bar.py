"""Quarter circle of round bar under a force out of its plane: problem VM18 of Ansys."""

from typing import Any

from fe_drivetrain.cases.verification.units import (
    INCH,
    POUND,
    PSI,
)
from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

RADIUS, DIAMETER = 100.0 * INCH, 2.0 * INCH
E, NU = 30e6 * PSI, 0.3
FORCE = 50.0 * POUND

#: The manual's targets.
DEFLECTION, BENDING, TORSION = 2.648 * INCH, 6366.0 * PSI, 3183.0 * PSI

#: Elements round the bar.
AROUND = (12, 16, 20)
QUICK_AROUND = (4, 8, 12)
#: Diameters that the long rest of the bar counts as in elements.
FAR = 14


def run(run: Run) -> Any:
    """Solve the bar on three meshes and look at its root and its end."""
    import numpy as np

    from fe_drivetrain.compare import (
        band_of,
    )
    from fe_drivetrain.interfaces import fixed
    from fe_drivetrain.operator import nodal_stresses, tensor, traction_loads
    from fe_drivetrain.report import Section, Table, Text, chart, judge, trace
    from fe_drivetrain.scene import Material
    from fe_drivetrain.solve import solve_solid
    from fe_drivetrain.validation.bar_sections import (
        round_bar,
        section_motion,
        section_stresses,
    )
    from fe_drivetrain.validation.ring_solids import (
        facets_where,
        node_at,
    )

    steel = Material(youngs_modulus=E, poisson_ratio=NU, density=0.0)
    area, inertia = 0.25 * np.pi * DIAMETER**2, np.pi * DIAMETER**4 / 64.0

    def bent(points: Any) -> Any:
        """The straight bar along x laid on the circle, z out of its plane."""
        t, r = points[:, 0] / RADIUS, RADIUS + points[:, 1]
        return np.column_stack([r * np.sin(t), r * np.cos(t), points[:, 2]])

    def solve(around: int) -> tuple[dict[str, float], Any]:
        bar = round_bar(DIAMETER, 0.5 * np.pi * RADIUS, around, FAR)
        points = bent(bar.points)
        facets = facets_where(bar.cells, bar.end)
        F = traction_loads(points, facets, np.array([0.0, 0.0, -FORCE / area]))
        held = [fixed("clamp", bar.clamp, points.size)]
        static = solve_solid(points, bar.cells, steel.lame, held, F)
        u = static.u[:, 0]
        s = tensor(nodal_stresses(points, bar.cells, u, steel.lame))
        tip = np.array([RADIUS, 0.0, 0.0])
        end, root = (section_motion(points, bar.cells, k, u, tip) for k in (bar.end, bar.root))
        top = node_at(bar.points, [0.0, 0.0, 0.5 * DIAMETER])
        at_top = tensor(section_stresses(points, bar.cells, np.array([top]), u, steel.lame)[0])
        # at the root the bar runs along x, and y is its radius
        fibre = (np.abs(bar.points[:, 1]) < 1e-9) & (
            np.abs(bar.points[:, 2] - 0.5 * DIAMETER) < 1e-9
        )
        fibre &= (bar.points[:, 0] > -1e-9) & (bar.points[:, 0] < 0.97 * 0.5 * np.pi * RADIUS)
        order = np.flatnonzero(fibre)[np.argsort(bar.points[fibre, 0])]
        t = bar.points[order, 0] / RADIUS
        along = np.column_stack([np.cos(t), -np.sin(t), np.zeros_like(t)])
        across = np.column_stack([np.sin(t), np.cos(t), np.zeros_like(t)])
        return {
            "deflection": float(root[2] - end[2]),
            "bending": float(at_top[0, 0]),
            "torsion": float(abs(at_top[0, 1])),
        }, (
            np.degrees(t),
            np.einsum("ni,nij,nj->n", along, s[order], along),
            np.abs(np.einsum("ni,nij,nj->n", along, s[order], across)),
        )

    levels = QUICK_AROUND if run.quick else AROUND
    found: list[dict[str, float]] = []
    profile: Any = None
    for around in levels:
        with run.step(f"{around} elements round"):
            values, profile = solve(around)
            found.append(values)

    bending = 0.25 * np.pi / (E * inertia)
    torsion = (0.75 * np.pi - 2.0) / (2.0 * steel.shear_modulus * inertia)
    closed = FORCE * RADIUS**3 * (bending + torsion)
    manual = "Ansys Mechanical APDL verification manual, VM18, target as in PyMAPDL's example"
    stress_reason = (
        "curved elements hold axial strain and shear exactly, but miss (2 pi / n)^2 / 12 of the "
        "lateral one, 0.8 % with n = 20 elements round and 2.3 % with 12; 2 nu^2 / ((1 + nu)(1 - 2 "
        "nu)) = 0.35 of that reaches the stress. Rounded up to 1 and 1.5 %; curvature "
        "adds (d/R)^2 = 4e-4"
    )
    close = 0.015 if run.quick else 0.01
    sizes = 1.0 / np.array(levels)
    verdicts = [
        judge(
            name,
            factor * found[-1][key],
            factor * reference,
            tolerance=tolerance,
            unit=unit,
            source=source,
            reason=reason,
            measure="deflection" if key == "deflection" else "stress",
            band=factor * band_of(sizes, [f[key] for f in found]),
        )
        for key, name, reference, factor, unit, tolerance, source, reason in (
            (
                *("deflection", "deflection of the end", DEFLECTION, 1e3, "mm", 2e-3, manual),
                "the closed form evaluated here is 0.05 % above the printed target; shear and "
                "curvature, which it leaves out, are 1e-4 and (d/R)^2 = 4e-4",
            ),
            (
                *("deflection", "deflection of the end, closed form", closed, 1e3, "mm", 1e-3),
                "Timoshenko, Strength of Materials, part I, 1955, eq 241, evaluated here",
                "shear and curvature, which it leaves out, are 1e-4 and (d/R)^2 = 4e-4",
            ),
            (
                *(
                    "bending",
                    "bending stress at the root",
                    BENDING,
                    1e-6,
                    "MPa",
                    close,
                    manual,
                ),
                stress_reason,
            ),
            (
                *(
                    "torsion",
                    "shear stress of torsion at the root",
                    TORSION,
                    1e-6,
                    "MPa",
                    close,
                ),
                manual,
                stress_reason,
            ),
        )
    ]
    last = found[-1]
    t = np.linspace(0.0, 87.0, 60)
    force = FORCE * RADIUS * 0.5 * DIAMETER / inertia
    return CASE.results(
        run,
        summary=[
            f"The end sinks by {last['deflection'] / INCH:.4f} in (target 2.648, closed form "
            f"{closed / INCH:.4f}); the root carries {last['bending'] / PSI:.0f} psi in bending "
            f"(6366) and {last['torsion'] / PSI:.0f} psi in torsion (3183).",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Along the bar",
                items=[
                    chart(
                        "Stress of the top fibre",
                        [
                            trace("bending, theory", t, force * np.cos(np.radians(t)) / 1e6),
                            trace(
                                "torsion, theory",
                                t,
                                0.5 * force * (1.0 - np.sin(np.radians(t))) / 1e6,
                            ),
                            trace("bending", profile[0], profile[1] / 1e6, points=True),
                            trace("torsion", profile[0], profile[2] / 1e6, points=True),
                        ],
                        "angle from the root [deg]",
                        "stress [MPa]",
                    ),
                    Table(
                        caption="By mesh",
                        columns=[
                            "elements round",
                            "deflection [in]",
                            "bending stress [psi]",
                            "shear stress [psi]",
                        ],
                        rows=[
                            [n, f["deflection"] / INCH, f["bending"] / PSI, f["torsion"] / PSI]
                            for n, f in zip(levels, found, strict=True)
                        ],
                    ),
                    Text(
                        text="The bar goes on two diameters behind its root and is clamped there, "
                        "so that the clamp's singular rim does not reach the root; the deflection "
                        "is against the root section's mean motion. Stresses of the root are "
                        "taken from the elements' own strains; those along the fibre are "
                        "recovered, which adds (2 pi / n)^2 / 12 with n elements round."
                    ),
                ],
            )
        ],
        figures={"around": levels, "values": found, "closed form [m]": closed},
    )


CASE = Case(
    name="verification/vm18_curved_bar",
    title="Curved bar bent out of its plane (VM18)",
    source="Ansys Mechanical APDL verification manual, VM18 (PyMAPDL examples); Timoshenko, "
    "Strength of Materials, part I, 1955, p 412, eq 241",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
