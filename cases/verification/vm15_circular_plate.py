"""Circular plate under pressure, clamped and simply supported: problem VM15 of Ansys."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification.units import INCH, PSI
from fe_drivetrain.common import Floats
from fe_drivetrain.operator import pressure
from fe_drivetrain.scene import Material
from fe_drivetrain.suite import MeshSeries, Page, Record, Run, Target, column
from fe_drivetrain.validation.loaded_blocks import edge_nodes, face_loads, solve_block, supports
from fe_drivetrain.validation.quarter_disc import quarter_disc
from fe_drivetrain.validation.ring_solids import node_at

RADIUS, THICKNESS = 40.0 * INCH, 1.0 * INCH
MIDDLE = 0.5 * THICKNESS
STEEL = Material(youngs_modulus=30e6 * PSI, poisson_ratio=0.3, density=0.0)
NU = STEEL.poisson_ratio
PRESSURES = {"clamped": 6.0 * PSI, "simply supported": 1.5 * PSI}

COUNT = "elements from the middle to the edge"
DEFLECTION, STRESS = "deflection of the middle [mm]", "greatest stress [MPa]"
#: The manual's targets: deflection of the middle [mm], greatest stress [MPa].
TARGETS = {
    "clamped": (1e3 * (0.08736 * INCH), 7200.0 * PSI / 1e6),
    "simply supported": (1e3 * (0.08904 * INCH), 2970.0 * PSI / 1e6),
}
MANUAL = "Ansys Mechanical APDL verification manual, VM15, target as in PyMAPDL's example"
PLATES = "Timoshenko and Woinowsky-Krieger 1959, art 16, and Reissner's shear"


def edge_shear(x: Floats, normal: Floats) -> Floats:
    """Of a pressure of 1: the parabola through the thickness that carries p r / 2 a length."""
    along = (x[:, 0] - MIDDLE) / MIDDLE
    return -1.5 * (0.5 * RADIUS / THICKNESS) * (1.0 - along**2)[:, None] * [1.0, 0.0, 0.0]


def solve(count: int) -> dict[str, Record]:
    """Both plates on one mesh, two elements thick."""
    disc = quarter_disc(RADIUS, THICKNESS, count // 2, 2)
    pressed = face_loads(disc, front=pressure(1.0))
    carried = face_loads(disc, rim=edge_shear)
    # the edge carries what presses, to round-off, so that the point which holds does not
    carried *= -pressed[::3].sum() / carried[::3].sum()
    edge = node_at(disc.points, [MIDDLE, RADIUS, 0.0])
    held = {
        # no rotation of the edge, which is free to swell through its thickness
        "clamped": supports(disc, (edge, "x"), y="y", z="z", rim="yz"),
        "simply supported": supports(disc, (edge, "x"), y="y", z="z"),
    }
    line = edge_nodes(disc, "z", "rear", along=1)
    found = {
        name: solve_block(disc, STEEL, p * (pressed + carried), held[name])
        for name, p in PRESSURES.items()
    }
    return {
        name: {
            COUNT: count,
            DEFLECTION: 1e3 * float(of.u[of.node(MIDDLE, 0.0, 0.0), 0] - of.u[edge, 0]),
            STRESS: float(np.abs(of.stress[line, 1]).max()) / 1e6,
        }
        for name, of in found.items()
    }


def thin_plate(support: str) -> tuple[float, float]:
    """Deflection of the middle of a thin plate, and Reissner's part of shear [m]."""
    p = PRESSURES[support]
    D = STEEL.youngs_modulus * THICKNESS**3 / (12.0 * (1.0 - NU**2))
    thin = p * RADIUS**4 / (64.0 * D)
    if support == "simply supported":
        thin *= (5.0 + NU) / (1.0 + NU)
    # the shear p r / 2 over a shear stiffness of 5/6 G t
    return thin, p * RADIUS**2 / (4.0 * (5.0 / 6.0) * STEEL.shear_modulus * THICKNESS)


def targets(support: str) -> list[Target]:
    """What the manual and plate theory say of one plate."""
    thin, shear = thin_plate(support)
    deflection, stress = TARGETS[support]
    no_shear = f"a thin plate has no shear, which is {100 * shear / thin:.2f} % here"
    reissner = "what Reissner's plate leaves out is of the order of (t/r)^2 = 6e-4"
    sunk = f"{support}: deflection of the middle"
    if support == "clamped":
        where, within = "edge", 0.03
        why = "along a clamped edge plate theory is right to the order of t/r = 2.5 %"
    else:
        where, within = "middle", 5e-3
        why = "away from the edge a plate's bending stress is right to (t/r)^2 = 6e-4; the rest "
        why += "is for recovered stress"
    return [
        Target(DEFLECTION, deflection, 5e-3, no_shear, MANUAL, f"{sunk}, thin plate"),
        Target(DEFLECTION, 1e3 * (thin + shear), 1e-3, reissner, PLATES, f"{sunk}, with shear"),
        Target(STRESS, stress, within, why, MANUAL, f"{support}: greatest stress, at the {where}"),
    ]


@case(
    "Circular plate under pressure (VM15)",
    source="Ansys Mechanical APDL verification manual, VM15 (PyMAPDL examples); Timoshenko, "
    "Strength of Materials, part II, 1956, p 96, 97 and 103",
)
def run(run: Run, page: Page) -> None:
    """Solve both plates as solids, their edges carried by the shear that plate theory has there."""
    counts = (4, 8, 16) if run.quick else (6, 12, 24)
    found = [run.timed(f"{n} {COUNT}", solve, n) for n in counts]
    series = {name: MeshSeries(column(found, name), COUNT) for name in PRESSURES}
    sunk = {name: 1e-3 * of.rows[-1][DEFLECTION] / INCH for name, of in series.items()}
    parts = {name: 100 * shear / thin for name in sunk for thin, shear in [thin_plate(name)]}
    page.answer(
        f"The clamped plate sinks by {sunk['clamped']:.5f} in (thin plate 0.08736), the simply "
        f"supported one by {sunk['simply supported']:.5f} in (0.08904); shear accounts for "
        f"{parts['clamped']:.2f} % and {parts['simply supported']:.2f} %."
    )
    page.section("Stress and deflection")
    for support, of in series.items():
        page.targets(f"Plate with a {support} edge", of, targets(support))
    page.text(
        "A quarter of hexahedra of 27 nodes, two through the thickness. A plate's supports are not "
        "a solid's: the edge is carried by the parabolic shear stress that plate theory has there, "
        "and the clamped one is besides kept from moving radially and round, but not from "
        "swelling; so no edge is singular. The manual's second load, a point force, has no finite "
        "deflection in a solid, and is left out."
    )
