"""Round bar under an eccentric end force: verification problem VM12 of Ansys."""

from typing import Any

from fe_drivetrain.cases.verification.units import (
    INCH,
    POUND,
    PSI,
)
from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

LENGTH, DIAMETER = 300.0 * INCH, 4.67017 * INCH
E, NU = 30e6 * PSI, 0.3
FORCE, TORQUE = 250.0 * POUND, 9000.0 * POUND * INCH

#: The manual's targets.
PRINCIPAL, SHEAR = 7527.0 * PSI, 3777.0 * PSI

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
    from fe_drivetrain.operator import nodal_stresses, principal, traction_loads
    from fe_drivetrain.report import Measure, Section, Table, Text, chart, judge, trace
    from fe_drivetrain.scene import Material
    from fe_drivetrain.solve import solve_solid
    from fe_drivetrain.validation.bar_sections import (
        round_bar,
        section_motion,
        section_stresses,
    )
    from fe_drivetrain.validation.ring_solids import (
        facets_where,
    )

    steel = Material(youngs_modulus=E, poisson_ratio=NU, density=0.0)
    radius, area = 0.5 * DIAMETER, 0.25 * np.pi * DIAMETER**2
    inertia = np.pi * DIAMETER**4 / 64.0

    def end_traction(x: Any, normal: Any) -> Any:
        """The force along z, and shear that grows with the radius."""
        shear = TORQUE / (2.0 * inertia)
        zero = np.zeros(len(x))
        return np.column_stack([zero, -shear * x[:, 2], shear * x[:, 1] + FORCE / area])

    def solve(around: int) -> tuple[dict[str, float], Any]:
        bar = round_bar(DIAMETER, LENGTH, around, FAR)
        n = bar.points.size
        facets = facets_where(bar.cells, bar.end)
        F = traction_loads(bar.points, facets, end_traction)
        held = [fixed("clamp", bar.clamp, n)]
        static = solve_solid(bar.points, bar.cells, steel.lame, held, F)
        u = static.u[:, 0]
        s = nodal_stresses(bar.points, bar.cells, u, steel.lame)
        three = principal(section_stresses(bar.points, bar.cells, bar.root, u, steel.lame))
        tip = np.array([LENGTH, 0.0, 0.0])
        end, root = (section_motion(bar.points, bar.cells, k, u, tip) for k in (bar.end, bar.root))
        surface = np.abs(np.hypot(bar.points[:, 1], bar.points[:, 2]) - radius) < 1e-9
        top = surface & (np.abs(bar.points[:, 1]) < 1e-9) & (bar.points[:, 2] < 0.0)
        top &= (bar.points[:, 0] >= -1e-9) & (bar.points[:, 0] < 0.99 * LENGTH)
        order = np.flatnonzero(top)[np.argsort(bar.points[top, 0])]
        return {
            "principal": float(three[:, 2].max()),
            "shear": float(0.5 * (three[:, 2] - three[:, 0]).max()),
            "deflection": float(end[2] - root[2]),
            "twist": float(end[3] - root[3]),
        }, (bar.points[order, 0], principal(s[order])[:, 2])

    levels = QUICK_AROUND if run.quick else AROUND
    found: list[dict[str, float]] = []
    profile: Any = None
    for around in levels:
        with run.step(f"{around} elements round"):
            values, profile = solve(around)
            found.append(values)

    def peak(x: Any) -> Any:
        """Largest principal stress of the section at x, by beam theory."""
        half = 0.5 * FORCE * (LENGTH - x) * radius / inertia
        return half + np.hypot(half, 0.5 * TORQUE * radius / inertia)

    G = steel.shear_modulus
    cowper = 6.0 * (1.0 + NU) / (7.0 + 6.0 * NU)
    deflection = FORCE * LENGTH**3 / (3.0 * E * inertia) + FORCE * LENGTH / (cowper * G * area)
    twist = TORQUE * LENGTH / (2.0 * G * inertia)
    manual = "Ansys Mechanical APDL verification manual, VM12, target as in PyMAPDL's example"
    lateral = (
        "curved elements hold axial strain and shear exactly, but miss (2 pi / n)^2 / 12 of the "
        "lateral one, 0.8 % with n = 20 elements round and 2.3 % with 12; 2 nu^2 / ((1 + nu)(1 - 2 "
        "nu)) = 0.35 of that reaches the stress. Rounded up to 1 and 1.5 %"
    )
    theory = "beam theory: F l^3 / (3 E I) + F l / (k G A), Cowper 1966; T l / (G J)"
    sizes = 1.0 / np.array(levels)
    quantities: list[tuple[str, str, float, float, str, str, Measure]] = [
        (
            *("principal", "largest principal stress at the root", PRINCIPAL, 1e-6, "MPa"),
            *(manual, "stress"),
        ),
        ("shear", "largest shear stress at the root", SHEAR, 1e-6, "MPa", manual, "stress"),
        ("deflection", "deflection of the end", deflection, 1e3, "mm", theory, "deflection"),
        ("twist", "twist of the end", twist, 1e3, "mrad", theory, "rotation"),
    ]
    tolerances = {
        "principal": (0.015 if run.quick else 0.01, lateral),
        "shear": (0.015 if run.quick else 0.01, lateral),
        "deflection": (
            5e-3 if run.quick else 1e-3,
            "theory is exact but for the coefficient of shear, whose whole part is 2e-4; away from "
            "the root elements are 3.5 diameters long, in a quick run 6",
        ),
        "twist": (1e-3, "exact for a round bar; elements of second order on the true circle"),
    }
    verdicts = [
        judge(
            name,
            factor * found[-1][key],
            factor * reference,
            tolerance=tolerances[key][0],
            unit=unit,
            source=source,
            reason=tolerances[key][1],
            measure=measure,
            band=factor * band_of(sizes, [f[key] for f in found]),
        )
        for key, name, reference, factor, unit, source, measure in quantities
    ]
    last = found[-1]
    x = np.linspace(0.0, 0.99 * LENGTH, 60)
    return CASE.results(
        run,
        summary=[
            f"The bar's root carries a largest principal stress of {last['principal'] / PSI:.0f} "
            f"psi (target 7527) and a largest shear of {last['shear'] / PSI:.0f} psi (3777).",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Along the bar",
                items=[
                    chart(
                        "Largest principal stress of the stretched fibre",
                        [
                            trace("beam theory", x, peak(x) / 1e6),
                            trace("finest mesh", profile[0], profile[1] / 1e6, points=True),
                        ],
                        "distance from the root [m]",
                        "stress [MPa]",
                    ),
                    Table(
                        caption="By mesh",
                        columns=[
                            "elements round",
                            "principal stress [psi]",
                            "shear stress [psi]",
                            "deflection [mm]",
                            "twist [mrad]",
                        ],
                        rows=[
                            [
                                n,
                                f["principal"] / PSI,
                                f["shear"] / PSI,
                                1e3 * f["deflection"],
                                1e3 * f["twist"],
                            ]
                            for n, f in zip(levels, found, strict=True)
                        ],
                    ),
                    Text(
                        text="The bar goes on two diameters behind its root and is clamped there, "
                        "so that the clamp's singular rim does not reach the root; displacements "
                        "are against the root section's mean motion. Stresses of the root are "
                        "taken from the elements' own strains; those along the fibre are "
                        "recovered, which adds (2 pi / n)^2 / 12 with n elements round."
                    ),
                ],
            )
        ],
        figures={"around": levels, "values": found},
    )


CASE = Case(
    name="verification/vm12_bending_and_torsion",
    title="Round bar in bending and torsion (VM12)",
    source="Ansys Mechanical APDL verification manual, VM12 (PyMAPDL examples); Timoshenko, "
    "Strength of Materials, part I, 1955, p 299, problem 2",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
