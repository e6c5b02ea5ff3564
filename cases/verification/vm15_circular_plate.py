"""Circular plate under pressure, clamped and simply supported: problem VM15 of Ansys."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.loaded_blocks import edge_nodes, solve_block
from fe_drivetrain.cases.verification.pressed_plate import PressedPlate
from fe_drivetrain.cases.verification.units import INCH, PSI
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.report.number_text import certain_value, difference_text, percent_text
from fe_drivetrain.report.suite import MeshSeries, Page, Record, Run, Target

STEEL = Material(youngs_modulus=30e6 * PSI, poisson_ratio=0.3, density=0.0)
PLATE = PressedPlate(radius=40.0 * INCH, thickness=1.0 * INCH, material=STEEL)
PRESSURES = {"clamped": 6.0 * PSI, "simply supported": 1.5 * PSI}

DIFFERENCES = "Differences from plate theory and from the manual, over what is allowed"
COUNT = "elements from the middle to the edge"
DEFLECTION, STRESS = "deflection of the middle [mm]", "greatest stress [MPa]"
#: The manual's targets: deflection of the middle [mm], greatest stress [MPa].
TARGETS = {
    "clamped": (1e3 * (0.08736 * INCH), 7200.0 * PSI / 1e6),
    "simply supported": (1e3 * (0.08904 * INCH), 2970.0 * PSI / 1e6),
}
MANUAL = "Ansys Mechanical APDL verification manual, VM15, target as in PyMAPDL's example"
PLATES = "Timoshenko and Woinowsky-Krieger 1959, art 16, and Reissner's shear"


def solve(support: str, count: int) -> Record:
    """One plate, two elements thick."""
    disc = PLATE.quarter(count // 2, 2)
    held = PLATE.supports(disc, clamped=support == "clamped")
    found = solve_block(disc, STEEL, PRESSURES[support] * PLATE.loads(disc), held)
    middle = found.node(0.5 * PLATE.thickness, 0.0, 0.0)
    rear = edge_nodes(disc, "z", "rear", along=1)
    return {
        COUNT: count,
        DEFLECTION: 1e3 * float(found.u[middle, 0] - found.u[PLATE.edge_node(disc), 0]),
        STRESS: float(np.abs(found.stress[rear, 1]).max()) / 1e6,
    }


def targets(support: str, thin: float, shear: float) -> list[Target]:
    """What the manual and plate theory say of one plate."""
    deflection, stress = TARGETS[support]
    no_shear = f"a thin plate has no shear, which is {100 * shear / thin:.2f} % here"
    reissner = "what Reissner's plate leaves out is of the order of (t/r)^2 = 6e-4"
    sunk = f"{support}: deflection of the middle"
    where, within = "edge", 0.03
    why = "along a clamped edge plate theory is right to the order of t/r = 2.5 %"
    if support == "simply supported":
        where, within = "middle", 5e-3
        why = "away from the edge a plate's bending stress is right to (t/r)^2 = 6e-4; the rest "
        why += "is for recovered stress"
    return [
        Target(DEFLECTION, deflection, 5e-3, no_shear, MANUAL, f"{sunk}, thin plate"),
        Target(DEFLECTION, 1e3 * (thin + shear), 1e-3, reissner, PLATES, f"{sunk}, with shear"),
        Target(STRESS, stress, within, why, MANUAL, f"{support}: greatest stress, at the {where}"),
    ]


def answer(page: Page) -> None:
    """State how far both plates sink, and what they carry."""
    sunk = "{}: deflection of the middle, {}"
    clamped, simple = (
        page.judged(sunk.format(support, "with shear"), f"deflection, {support}", "plate and shear")
        for support in PRESSURES
    )
    manual = [
        page.judged(sunk.format(support, "thin plate"), f"deflection, {support}, thin", "VM15")
        for support in PRESSURES
    ]
    stresses = [
        page.judged(f"{support}: greatest stress, at the {at}", f"stress, {support}", "VM15")
        for support, at in (("clamped", "edge"), ("simply supported", "middle"))
    ]
    page.answer(
        "How far does the circular plate of Ansys's VM15 sink, clamped and simply supported?",
        f"The plate sinks by {certain_value(clamped)} clamped and {certain_value(simple)} simply "
        f"supported: {difference_text(manual[0])} and {difference_text(manual[1])} from VM15, "
        "which neglects shear.",
        [clamped, simple, *manual, *stresses],
        hero=DIFFERENCES,
    )
    page.errors(DIFFERENCES, [clamped, simple, *manual, *stresses])


@case(
    "Circular plate under pressure (VM15)",
    source="Ansys Mechanical APDL verification manual, VM15 (PyMAPDL examples); Timoshenko, "
    "Strength of Materials, part II, 1956, p 96, 97 and 103",
)
def run(run: Run, page: Page) -> None:
    """Solve both plates as solids, their edges carried by the shear that plate theory has there."""
    counts = (4, 8, 16) if run.quick else (6, 12, 24)
    page.section("Stress and deflection")
    page.image("Quarter of the plate", run.sketch(PLATE.quarter(4, 2)))
    for support, load in PRESSURES.items():
        rows = [run.timed(f"{support}, {n} {COUNT}", solve, support, n) for n in counts]
        thin = PLATE.thin_deflection(load, clamped=support == "clamped")
        shear = PLATE.shear_deflection(load)
        title = f"Plate with a {support} edge"
        page.targets(title, MeshSeries(rows, COUNT), targets(support, thin, shear))
        page.say(
            f"In the manual's unit, the {support} plate sinks by "
            f"{1e-3 * rows[-1][DEFLECTION] / INCH:.5f} in (thin plate "
            f"{1e-3 * TARGETS[support][0] / INCH:.5f}); shear accounts for "
            f"{percent_text(shear / thin)}."
        )
    answer(page)
    page.text(
        "A quarter of hexahedra of 27 nodes, two through the thickness. A plate's supports are not "
        "a solid's: the edge is carried by the parabolic shear stress that plate theory has there, "
        "and the clamped one is besides kept from moving radially and round, but not from "
        "swelling; so no edge is singular. The manual's second load, a point force, has no finite "
        "deflection in a solid, and is left out."
    )
