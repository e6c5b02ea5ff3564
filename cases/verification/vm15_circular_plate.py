"""Circular plate under pressure, clamped and simply supported: problem VM15 of Ansys."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification.units import INCH, PSI
from fe_drivetrain.common import Floats
from fe_drivetrain.compare import band_of
from fe_drivetrain.interfaces import held_dofs
from fe_drivetrain.operator import nodal_stresses, pressure, traction_loads
from fe_drivetrain.report import trace
from fe_drivetrain.scene import Material
from fe_drivetrain.solve import solve_solid
from fe_drivetrain.suite import Page, Record, Run, column, grouped
from fe_drivetrain.validation.quarter_disc import quarter_disc
from fe_drivetrain.validation.ring_solids import node_at

RADIUS, THICKNESS = 40.0 * INCH, 1.0 * INCH
MIDDLE = 0.5 * THICKNESS
STEEL = Material(youngs_modulus=30e6 * PSI, poisson_ratio=0.3, density=0.0)
NU = STEEL.poisson_ratio
PRESSURES = {"clamped": 6.0 * PSI, "simply supported": 1.5 * PSI}

#: The manual's targets: deflection of the middle, greatest stress.
TARGETS = {
    "clamped": (0.08736 * INCH, 7200.0 * PSI),
    "simply supported": (0.08904 * INCH, 2970.0 * PSI),
}
MANUAL = "Ansys Mechanical APDL verification manual, VM15, target as in PyMAPDL's example"

#: Half of the elements from the middle to the edge.
DIVISIONS = (3, 6, 12)
QUICK_DIVISIONS = (2, 4, 8)
LAYERS = 2

SUPPORT, HALF = "support", "half of the elements from middle to edge"
DEFLECTION, STRESS = "deflection [m]", "greatest stress [Pa]"


def edge_shear(x: Floats, normal: Floats) -> Floats:
    """Of a pressure of 1: the parabola through the thickness that carries p r / 2 a length."""
    along = (x[:, 0] - MIDDLE) / MIDDLE
    shear = -1.5 * (0.5 * RADIUS / THICKNESS) * (1.0 - along**2)
    return np.column_stack([shear, np.zeros_like(shear), np.zeros_like(shear)])


def solve(n: int) -> tuple[list[Record], dict[str, Floats]]:
    """Both plates on one mesh; by support radius and radial stress at the stretched face."""
    block = quarter_disc(RADIUS, THICKNESS, n, LAYERS)
    points, cells = block.points, block.cells
    rim = block.face_nodes("rim")
    pressed = traction_loads(points, block.faces["front"], pressure(1.0))
    carried = traction_loads(points, block.faces["rim"], edge_shear)
    # the edge carries what presses, to round-off, so that the point which holds does not
    carried *= -pressed[::3].sum() / carried[::3].sum()
    centre = node_at(points, [MIDDLE, 0.0, 0.0])
    edge = node_at(points, [MIDDLE, RADIUS, 0.0])
    symmetry = [3 * block.face_nodes("y") + 1, 3 * block.face_nodes("z") + 2, np.array([3 * edge])]
    holds = {
        # no rotation of the edge, which is free to swell through its thickness
        "clamped": np.unique(np.concatenate([*symmetry, 3 * rim + 1, 3 * rim + 2])),
        "simply supported": np.unique(np.concatenate(symmetry)),
    }
    line = np.intersect1d(block.face_nodes("z"), block.face_nodes("rear"))
    line = line[np.argsort(points[line, 1])]
    rows, profiles = [], {}
    for support, p in PRESSURES.items():
        held = [held_dofs(support, holds[support], points.size)]
        u = solve_solid(points, cells, STEEL.lame, held, p * (pressed + carried)).u[:, 0]
        s = nodal_stresses(points, cells, u, STEEL.lame)[line, 1]
        rows.append(
            {
                SUPPORT: support,
                HALF: n,
                DEFLECTION: float(u[3 * centre] - u[3 * edge]),
                STRESS: float(np.abs(s).max()),
            }
        )
        profiles[support] = np.array([points[line, 1], s])
    return rows, profiles


def thin_plate(support: str) -> tuple[float, float]:
    """Deflection of the middle of a thin plate, and Reissner's part of shear [m]."""
    p = PRESSURES[support]
    D = STEEL.youngs_modulus * THICKNESS**3 / (12.0 * (1.0 - NU**2))
    thin = p * RADIUS**4 / (64.0 * D)
    if support == "simply supported":
        thin *= (5.0 + NU) / (1.0 + NU)
    # the shear p r / 2 over a shear stiffness of 5/6 G t
    return thin, p * RADIUS**2 / (4.0 * (5.0 / 6.0) * STEEL.shear_modulus * THICKNESS)


def thin_stress(support: str, r: Floats) -> Floats:
    """Radial stress of the stretched face of a thin plate [Pa]."""
    edge = (1.0 + NU) if support == "clamped" else (3.0 + NU)
    moment = PRESSURES[support] * (edge * RADIUS**2 - (3.0 + NU) * r**2) / 16.0
    return np.asarray(6.0 / THICKNESS**2 * moment)


@case(
    "Circular plate under pressure (VM15)",
    source="Ansys Mechanical APDL verification manual, VM15 (PyMAPDL examples); Timoshenko, "
    "Strength of Materials, part II, 1956, p 96, 97 and 103",
)
def run(run: Run, page: Page) -> None:
    """Solve both plates as solids, their edges carried by the shear that plate theory has there."""
    levels = QUICK_DIVISIONS if run.quick else DIVISIONS
    rows: list[Record] = []
    for n in levels:
        found, profiles = run.timed(f"{2 * n} elements from the middle to the edge", solve, n)
        rows += found
    by_support = dict(grouped(rows, SUPPORT))
    for support, series in by_support.items():
        check(page, support, series)
    sunk = {support: series[-1][DEFLECTION] / INCH for support, series in by_support.items()}
    shear = {support: 100 * part / thin for support in sunk for thin, part in [thin_plate(support)]}
    page.answer(
        f"The clamped plate sinks by {sunk['clamped']:.5f} in (thin plate 0.08736), the simply "
        f"supported one by {sunk['simply supported']:.5f} in (0.08904); shear accounts for "
        f"{shear['clamped']:.2f} % and {shear['simply supported']:.2f} %."
    )
    page.section("Stress and deflection")
    r = np.linspace(0.0, RADIUS, 80)
    page.chart(
        "Radial stress of the stretched face",
        [trace(f"{support}, thin plate", r, thin_stress(support, r) / 1e6) for support in PRESSURES]
        + [
            trace(f"{support}, finest mesh", x, s / 1e6, points=True)
            for support, (x, s) in profiles.items()
        ],
        "distance from the middle [m]",
        "radial stress [MPa]",
    )
    page.table(
        "By mesh, in the manual's units",
        [
            {
                SUPPORT: support,
                "quantity": quantity,
                **{f"{2 * row[HALF]} elements": row[key] / unit for row in series},
                "target": target / unit,
            }
            for support, series in by_support.items()
            for key, quantity, unit, target in zip(
                (DEFLECTION, STRESS),
                ("deflection [in]", "greatest stress [psi]"),
                (INCH, PSI),
                TARGETS[support],
                strict=True,
            )
        ],
    )
    page.text(
        "A quarter of hexahedra of 27 nodes, two through the thickness. A plate's supports are not "
        "a solid's: the edge is carried by the parabolic shear stress that plate theory has there, "
        "and the clamped one is besides kept from moving radially and round, but not from "
        "swelling; so no edge is singular. The manual's second load, a point force, has no finite "
        "deflection in a solid, and is left out."
    )
    page.data("by mesh", rows)


def check(page: Page, support: str, series: list[Record]) -> None:
    """Deflection of the middle and greatest stress of one plate."""
    sizes = 1.0 / np.array(column(series, HALF))
    deflection, stress = TARGETS[support]
    thin, shear = thin_plate(support)
    sunk = column(series, DEFLECTION)
    for name, reference, tolerance, source, reason in (
        (
            "thin plate",
            deflection,
            5e-3,
            MANUAL,
            f"a thin plate has no shear, which is {100 * shear / thin:.2f} % here",
        ),
        (
            "with shear",
            thin + shear,
            1e-3,
            "Timoshenko and Woinowsky-Krieger 1959, art 16, and Reissner's shear",
            "what Reissner's plate leaves out is of the order of (t/r)^2 = 6e-4",
        ),
    ):
        page.equals(
            f"{support}: deflection of the middle, {name}",
            1e3 * sunk[-1],
            1e3 * reference,
            within=tolerance,
            why=reason,
            source=source,
            unit="mm",
            measure="deflection",
            band=1e3 * band_of(sizes, sunk),
        )
    clamped = support == "clamped"
    page.equals(
        f"{support}: greatest stress, at the {'edge' if clamped else 'middle'}",
        series[-1][STRESS] / 1e6,
        stress / 1e6,
        within=0.03 if clamped else 5e-3,
        why="along a clamped edge plate theory is right to the order of t/r = 2.5 %"
        if clamped
        else "away from the edge a plate's bending stress is right to (t/r)^2 = 6e-4; the rest is "
        "for recovered stress",
        source=MANUAL,
        unit="MPa",
        measure="stress",
        band=band_of(sizes, column(series, STRESS)) / 1e6,
    )
