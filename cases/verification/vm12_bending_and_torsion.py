"""Round bar under an eccentric end force: verification problem VM12 of Ansys."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification.units import INCH, POUND, PSI
from fe_drivetrain.common import Floats
from fe_drivetrain.compare import band_of
from fe_drivetrain.interfaces import fixed
from fe_drivetrain.operator import nodal_stresses, principal, traction_loads
from fe_drivetrain.report import Measure, trace
from fe_drivetrain.scene import Material
from fe_drivetrain.solve import solve_solid
from fe_drivetrain.suite import Page, Record, Run, column
from fe_drivetrain.validation.bar_sections import round_bar, section_motion, section_stresses
from fe_drivetrain.validation.ring_solids import facets_where

LENGTH, DIAMETER = 300.0 * INCH, 4.67017 * INCH
RADIUS = 0.5 * DIAMETER
AREA, INERTIA = 0.25 * np.pi * DIAMETER**2, np.pi * DIAMETER**4 / 64.0
STEEL = Material(youngs_modulus=30e6 * PSI, poisson_ratio=0.3, density=0.0)
E, NU, G = STEEL.youngs_modulus, STEEL.poisson_ratio, STEEL.shear_modulus
FORCE, TORQUE = 250.0 * POUND, 9000.0 * POUND * INCH

#: The manual's targets.
PRINCIPAL, SHEAR = 7527.0 * PSI, 3777.0 * PSI

#: Units shown, and their factors from SI.
UNITS = {"stress": ("MPa", 1e-6), "deflection": ("mm", 1e3), "rotation": ("mrad", 1e3)}

#: Elements round the bar.
AROUND = (12, 16, 20)
QUICK_AROUND = (4, 8, 12)
#: Diameters that the long rest of the bar counts as in elements.
FAR = 14


def end_traction(x: Floats, normal: Floats) -> Floats:
    """The force along z, and shear that grows with the radius."""
    shear = TORQUE / (2.0 * INERTIA)
    zero = np.zeros(len(x))
    return np.column_stack([zero, -shear * x[:, 2], shear * x[:, 1] + FORCE / AREA])


def solve(around: int) -> tuple[Record, Floats]:
    """Quantities in SI; along the stretched fibre x and the largest principal stress, (2, n)."""
    bar = round_bar(DIAMETER, LENGTH, around, FAR)
    facets = facets_where(bar.cells, bar.end)
    F = traction_loads(bar.points, facets, end_traction)
    held = [fixed("clamp", bar.clamp, bar.points.size)]
    u = solve_solid(bar.points, bar.cells, STEEL.lame, held, F).u[:, 0]
    s = nodal_stresses(bar.points, bar.cells, u, STEEL.lame)
    three = principal(section_stresses(bar.points, bar.cells, bar.root, u, STEEL.lame))
    tip = np.array([LENGTH, 0.0, 0.0])
    end, root = (section_motion(bar.points, bar.cells, k, u, tip) for k in (bar.end, bar.root))
    surface = np.abs(np.hypot(bar.points[:, 1], bar.points[:, 2]) - RADIUS) < 1e-9
    top = surface & (np.abs(bar.points[:, 1]) < 1e-9) & (bar.points[:, 2] < 0.0)
    top &= (bar.points[:, 0] >= -1e-9) & (bar.points[:, 0] < 0.99 * LENGTH)
    order = np.flatnonzero(top)[np.argsort(bar.points[top, 0])]
    return {
        "elements round": around,
        "principal": float(three[:, 2].max()),
        "shear": float(0.5 * (three[:, 2] - three[:, 0]).max()),
        "deflection": float(end[2] - root[2]),
        "twist": float(end[3] - root[3]),
    }, np.array([bar.points[order, 0], principal(s[order])[:, 2]])


def peak(x: Floats) -> Floats:
    """Largest principal stress of the section at x, by beam theory [Pa]."""
    half = 0.5 * FORCE * (LENGTH - x) * RADIUS / INERTIA
    return np.asarray(half + np.hypot(half, 0.5 * TORQUE * RADIUS / INERTIA))


@case(
    "Round bar in bending and torsion (VM12)",
    source="Ansys Mechanical APDL verification manual, VM12 (PyMAPDL examples); Timoshenko, "
    "Strength of Materials, part I, 1955, p 299, problem 2",
)
def run(run: Run, page: Page) -> None:
    """Solve the bar on three meshes and look at its root and its end."""
    rows: list[Record] = []
    for around in QUICK_AROUND if run.quick else AROUND:
        row, fibre = run.timed(f"{around} elements round", solve, around)
        rows.append(row)
    check(run, page, rows)
    last = rows[-1]
    page.answer(
        f"The bar's root carries a largest principal stress of {last['principal'] / PSI:.0f} "
        f"psi (target 7527) and a largest shear of {last['shear'] / PSI:.0f} psi (3777)."
    )
    page.section("Along the bar")
    x = np.linspace(0.0, 0.99 * LENGTH, 60)
    page.chart(
        "Largest principal stress of the stretched fibre",
        [
            trace("beam theory", x, peak(x) / 1e6),
            trace("finest mesh", fibre[0], fibre[1] / 1e6, points=True),
        ],
        "distance from the root [m]",
        "stress [MPa]",
    )
    shown = [
        {
            "elements round": row["elements round"],
            "principal stress [psi]": row["principal"] / PSI,
            "shear stress [psi]": row["shear"] / PSI,
            "deflection [mm]": 1e3 * row["deflection"],
            "twist [mrad]": 1e3 * row["twist"],
        }
        for row in rows
    ]
    page.table("By mesh", shown)
    page.text(
        "The bar goes on two diameters behind its root and is clamped there, so that the clamp's "
        "singular rim does not reach the root; displacements are against the root section's mean "
        "motion. Stresses of the root are taken from the elements' own strains; those along the "
        "fibre are recovered, which adds (2 pi / n)^2 / 12 with n elements round."
    )
    page.data("by mesh", shown)


def check(run: Run, page: Page, rows: list[Record]) -> None:
    """The finest mesh against the manual's stresses, and the end against beam theory."""
    kGA = 6.0 * (1.0 + NU) / (7.0 + 6.0 * NU) * G * AREA
    deflection = FORCE * LENGTH**3 / (3.0 * E * INERTIA) + FORCE * LENGTH / kGA
    twist = TORQUE * LENGTH / (2.0 * G * INERTIA)
    lateral = (
        "curved elements hold axial strain and shear exactly, but miss (2 pi / n)^2 / 12 of the "
        "lateral one, 0.8 % with n = 20 elements round and 2.3 % with 12; 2 nu^2 / ((1 + nu)(1 - 2 "
        "nu)) = 0.35 of that reaches the stress. Rounded up to 1 and 1.5 %"
    )
    close = 0.015 if run.quick else 0.01
    root = "stress at the root"
    quantities: tuple[tuple[str, str, float, Measure, float, str], ...] = (
        ("principal", f"largest principal {root}", PRINCIPAL, "stress", close, lateral),
        ("shear", f"largest shear {root}", SHEAR, "stress", close, lateral),
        (
            "deflection",
            "deflection of the end",
            deflection,
            "deflection",
            5e-3 if run.quick else 1e-3,
            "theory is exact but for the coefficient of shear, whose whole part is 2e-4; away from "
            "the root elements are 3.5 diameters long, in a quick run 6",
        ),
        (
            "twist",
            "twist of the end",
            twist,
            "rotation",
            1e-3,
            "exact for a round bar; elements of second order on the true circle",
        ),
    )
    sizes = 1.0 / np.array(column(rows, "elements round"))
    for key, name, reference, measure, tolerance, reason in quantities:
        unit, factor = UNITS[measure]
        page.equals(
            name,
            factor * rows[-1][key],
            factor * reference,
            within=tolerance,
            why=reason,
            source="Ansys Mechanical APDL verification manual, VM12, target as in PyMAPDL's example"
            if measure == "stress"
            else "beam theory: F l^3 / (3 E I) + F l / (k G A), Cowper 1966; T l / (G J)",
            unit=unit,
            measure=measure,
            band=factor * band_of(sizes, column(rows, key)),
        )
