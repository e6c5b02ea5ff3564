"""Quarter circle of round bar under a force out of its plane: problem VM18 of Ansys."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification.units import INCH, POUND, PSI
from fe_drivetrain.common import Floats
from fe_drivetrain.compare import band_of
from fe_drivetrain.interfaces import fixed
from fe_drivetrain.operator import nodal_stresses, tensor, traction_loads
from fe_drivetrain.report import trace
from fe_drivetrain.scene import Material
from fe_drivetrain.solve import solve_solid
from fe_drivetrain.suite import Page, Record, Run, column
from fe_drivetrain.validation.bar_sections import round_bar, section_motion, section_stresses
from fe_drivetrain.validation.ring_solids import facets_where, node_at

RADIUS, DIAMETER = 100.0 * INCH, 2.0 * INCH
LENGTH = 0.5 * np.pi * RADIUS
AREA, INERTIA = 0.25 * np.pi * DIAMETER**2, np.pi * DIAMETER**4 / 64.0
STEEL = Material(youngs_modulus=30e6 * PSI, poisson_ratio=0.3, density=0.0)
FORCE = 50.0 * POUND

#: The manual's targets.
DEFLECTION, BENDING, TORSION = 2.648 * INCH, 6366.0 * PSI, 3183.0 * PSI

#: Timoshenko's eq 241: bending and torsion.
CLOSED = (
    FORCE
    * RADIUS**3
    * (
        0.25 * np.pi / (STEEL.youngs_modulus * INERTIA)
        + (0.75 * np.pi - 2.0) / (2.0 * STEEL.shear_modulus * INERTIA)
    )
)

#: Elements round the bar.
AROUND = (12, 16, 20)
QUICK_AROUND = (4, 8, 12)
#: Diameters that the long rest of the bar counts as in elements.
FAR = 14

MANUAL = "Ansys Mechanical APDL verification manual, VM18, target as in PyMAPDL's example"


def bent(points: Floats) -> Floats:
    """The straight bar along x laid on the circle, z out of its plane."""
    t, r = points[:, 0] / RADIUS, RADIUS + points[:, 1]
    return np.column_stack([r * np.sin(t), r * np.cos(t), points[:, 2]])


def solve(around: int) -> tuple[Record, Floats]:
    """Quantities in SI; along the top fibre angle [deg], bending and torsional stress, (3, n)."""
    bar = round_bar(DIAMETER, LENGTH, around, FAR)
    points = bent(bar.points)
    facets = facets_where(bar.cells, bar.end)
    F = traction_loads(points, facets, np.array([0.0, 0.0, -FORCE / AREA]))
    held = [fixed("clamp", bar.clamp, points.size)]
    u = solve_solid(points, bar.cells, STEEL.lame, held, F).u[:, 0]
    s = tensor(nodal_stresses(points, bar.cells, u, STEEL.lame))
    tip = np.array([RADIUS, 0.0, 0.0])
    end, root = (section_motion(points, bar.cells, k, u, tip) for k in (bar.end, bar.root))
    top = node_at(bar.points, [0.0, 0.0, 0.5 * DIAMETER])
    at_top = tensor(section_stresses(points, bar.cells, np.array([top]), u, STEEL.lame)[0])
    # at the root the bar runs along x, and y is its radius
    fibre = (np.abs(bar.points[:, 1]) < 1e-9) & (np.abs(bar.points[:, 2] - 0.5 * DIAMETER) < 1e-9)
    fibre &= (bar.points[:, 0] > -1e-9) & (bar.points[:, 0] < 0.97 * LENGTH)
    order = np.flatnonzero(fibre)[np.argsort(bar.points[fibre, 0])]
    t = bar.points[order, 0] / RADIUS
    along = np.column_stack([np.cos(t), -np.sin(t), np.zeros_like(t)])
    across = np.column_stack([np.sin(t), np.cos(t), np.zeros_like(t)])
    bending = np.einsum("ni,nij,nj->n", along, s[order], along)
    torsion = np.abs(np.einsum("ni,nij,nj->n", along, s[order], across))
    return {
        "elements round": around,
        "deflection": float(root[2] - end[2]),
        "bending": float(at_top[0, 0]),
        "torsion": float(abs(at_top[0, 1])),
    }, np.array([np.degrees(t), bending, torsion])


@case(
    "Curved bar bent out of its plane (VM18)",
    source="Ansys Mechanical APDL verification manual, VM18 (PyMAPDL examples); Timoshenko, "
    "Strength of Materials, part I, 1955, p 412, eq 241",
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
        f"The end sinks by {last['deflection'] / INCH:.4f} in (target 2.648, closed form "
        f"{CLOSED / INCH:.4f}); the root carries {last['bending'] / PSI:.0f} psi in bending "
        f"(6366) and {last['torsion'] / PSI:.0f} psi in torsion (3183)."
    )
    page.section("Along the bar")
    t = np.linspace(0.0, 87.0, 60)
    stress = FORCE * RADIUS * 0.5 * DIAMETER / INERTIA / 1e6
    page.chart(
        "Stress of the top fibre",
        [
            trace("bending, theory", t, stress * np.cos(np.radians(t))),
            trace("torsion, theory", t, 0.5 * stress * (1.0 - np.sin(np.radians(t)))),
            trace("bending", fibre[0], fibre[1] / 1e6, points=True),
            trace("torsion", fibre[0], fibre[2] / 1e6, points=True),
        ],
        "angle from the root [deg]",
        "stress [MPa]",
    )
    shown = [
        {
            "elements round": row["elements round"],
            "deflection [in]": row["deflection"] / INCH,
            "bending stress [psi]": row["bending"] / PSI,
            "shear stress [psi]": row["torsion"] / PSI,
        }
        for row in rows
    ]
    page.table("By mesh", shown)
    page.text(
        "The bar goes on two diameters behind its root and is clamped there, so that the clamp's "
        "singular rim does not reach the root; the deflection is against the root section's mean "
        "motion. Stresses of the root are taken from the elements' own strains; those along the "
        "fibre are recovered, which adds (2 pi / n)^2 / 12 with n elements round."
    )
    page.data("by mesh", shown)
    page.data("closed form [m]", CLOSED)


def check(run: Run, page: Page, rows: list[Record]) -> None:
    """The finest mesh against the manual's targets and the closed form."""
    sizes = 1.0 / np.array(column(rows, "elements round"))
    for name, reference, tolerance, source, reason in (
        (
            "deflection of the end",
            DEFLECTION,
            2e-3,
            MANUAL,
            "the closed form evaluated here is 0.05 % above the printed target; shear and "
            "curvature, which it leaves out, are 1e-4 and (d/R)^2 = 4e-4",
        ),
        (
            "deflection of the end, closed form",
            CLOSED,
            1e-3,
            "Timoshenko, Strength of Materials, part I, 1955, eq 241, evaluated here",
            "shear and curvature, which it leaves out, are 1e-4 and (d/R)^2 = 4e-4",
        ),
    ):
        page.equals(
            name,
            1e3 * rows[-1]["deflection"],
            1e3 * reference,
            within=tolerance,
            why=reason,
            source=source,
            unit="mm",
            measure="deflection",
            band=1e3 * band_of(sizes, column(rows, "deflection")),
        )
    for key, name, target in (
        ("bending", "bending stress at the root", BENDING),
        ("torsion", "shear stress of torsion at the root", TORSION),
    ):
        page.equals(
            name,
            1e-6 * rows[-1][key],
            1e-6 * target,
            within=0.015 if run.quick else 0.01,
            why="curved elements hold axial strain and shear exactly, but miss (2 pi / n)^2 / 12 "
            "of the lateral one, 0.8 % with n = 20 elements round and 2.3 % with 12; 2 nu^2 / "
            "((1 + nu)(1 - 2 nu)) = 0.35 of that reaches the stress. Rounded up to 1 and 1.5 %; "
            "curvature adds (d/R)^2 = 4e-4",
            source=MANUAL,
            unit="MPa",
            measure="stress",
            band=1e-6 * band_of(sizes, column(rows, key)),
        )
