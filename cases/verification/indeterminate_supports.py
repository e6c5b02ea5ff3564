"""Two and three supports, rigid or on springs: frame, Macaulay's beam and solid."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from fe_drivetrain.beam import Beam, BeamSection, Support, solve, torsional_spring_reaction
from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification.shaft_inputs import show_inputs
from fe_drivetrain.common import Floats
from fe_drivetrain.report import trace
from fe_drivetrain.scene import MATERIALS
from fe_drivetrain.suite import Page, Record, Run
from fe_drivetrain.validation import solid_shafts
from fe_drivetrain.validation.shaft_theory import (
    Spring,
    Tube,
    evenly_loaded_shear,
    macaulay,
    parabola_shortfall,
)

STEEL = MATERIALS["steel"]
OUTER = 0.4
#: Hub, main bearing, second bearing, gearbox [m] from the hub.
STATIONS = (0.0, 1.2, 2.8, 4.8)
LENGTH = STATIONS[-1]
TUBE = Tube(OUTER, 0.0, LENGTH, STEEL)
#: Radial stiffness of the bearings and of the gearbox [N/m], tilt of the main bearing [N m/rad].
RADIAL, GEARBOX, TILT = 2e9, 8e7, 145e6
RIGID = float("inf")
NAMES = ("main bearing", "second bearing", "gearbox")

Springs = Sequence[tuple[float, float]]
"""(force, moment) stiffness at the main bearing, the second one and the gearbox [N/m, N m/rad]."""
SETS: dict[str, Springs] = {
    "bearing with tilt, gearbox": ((RADIAL, TILT), (0.0, 0.0), (GEARBOX, 0.0)),
    "clamped in the bearing, gearbox": ((RIGID, RIGID), (0.0, 0.0), (RIGID, 0.0)),
    "three rigid supports": ((RIGID, 0.0), (RIGID, 0.0), (RIGID, 0.0)),
    "two bearings, soft gearbox": ((RADIAL, 0.0), (RADIAL, 0.0), (GEARBOX, 0.0)),
    "two bearings with tilt, gearbox": ((RADIAL, TILT), (RADIAL, TILT), (GEARBOX, 0.0)),
}
#: Force along z [N] and moment about y [N m] at the hub.
LOADS = {"force": (1e6, 0.0), "moment": (0.0, 1e6)}
SIZE = 1e6

EVEN = evenly_loaded_shear(TUBE)
EVENLY = "Macaulay's brackets with shear of evenly loaded sections (Hutchinson 2001)"


class Carried(NamedTuple):
    """Forces and moments (6,) that the shaft puts on the supports, and the hub's motion (2,)."""

    loads: Floats
    hub: Floats


def by_macaulay(
    springs: Springs,
    load: tuple[float, float],
    kGA: float = TUBE.kGA,
    local: tuple[float, float] = (0.0, 0.0),
) -> Carried:
    """Macaulay's beam; supports softer by a local compliance [m/N, rad/(N m)]."""
    supports = [
        Spring(x, _softened(k, local[0]), _softened(m, local[1]))
        for x, (k, m) in zip(STATIONS[1:], springs, strict=True)
    ]
    force, moment = load
    found = macaulay(LENGTH, TUBE.EI, kGA, supports, [(0.0, force, -moment)], [0.0])
    loads = np.column_stack([-found.forces, found.moments]).ravel()
    # the slope is minus the rotation about y
    return Carried(loads, np.array([found.deflection[0], -found.slope[0]]))


def _softened(stiffness: float, compliance: float) -> float:
    return 1.0 / (1.0 / stiffness + compliance) if stiffness > 0 and compliance > 0 else stiffness


def by_frame(springs: Springs, load: tuple[float, float], shear: bool = True) -> Floats:
    """Forces and moments (6,) on the supports."""
    supports = []
    for name, x, (k, m) in zip(NAMES, STATIONS[1:], springs, strict=True):
        # the gearbox also locates the shaft and takes the torque
        along = RIGID if name == "gearbox" else 0.0
        if k > 0:
            supports.append(Support(name, x, (along, k, k, along, m, m)))
    beam = Beam([BeamSection(LENGTH, OUTER)], supports, material=STEEL, shear=shear)
    found = solve(beam, 0.0, np.array([0, 0, load[0], 0, load[1], 0]), 0.0)
    present = {support.name for support in supports}
    loads = [found.reaction(n)[[2, 4]] if n in present else np.zeros(2) for n in NAMES]
    return np.concatenate(loads)


def by_solid(C: solid_shafts.Compliance, springs: Springs, load: tuple[float, float]) -> Carried:
    """The solid on springs, by its compliance."""
    loads = np.zeros((4, 2))
    loads[0] = load
    found = solid_shafts.on_springs(C, [(0.0, 0.0), *springs], loads)
    return Carried(-found.reactions[1:].ravel(), found.motions[0])


@case(
    "Two and three supports on springs: frame, Macaulay's beam and solid",
    source="Macaulay's brackets with shear; Stirling 2023, Eq 3.18-3.19",
)
def run(run: Run, page: Page) -> None:
    """Several sets of supports under a hub force and a hub moment."""
    refinements = (1, 2) if run.quick else (2, 3)
    compliances = []
    for refinement in refinements:
        with run.step("mesh and solve"):
            shaft = solid_shafts.straight(STATIONS, OUTER)
            mesh = solid_shafts.solid(shaft, refinement, size=3 * OUTER)
            compliances.append(solid_shafts.sectional_compliance(mesh, STEEL, STATIONS))
    rows = [
        check(page, label, kind, compliances, refinements, mesh.per_turn)
        for label in SETS
        for kind in LOADS
    ]
    check_thesis(page)
    largest = max(abs(row["solid"] / row["Macaulay"] - 1) for row in rows)
    page.answer(
        "On five sets of supports the frame and Macaulay's beam agree to round-off, and the "
        f"solid's largest reactions differ from them by at most {100 * largest:.2f} %."
    )
    page.section("Indeterminate supports")
    show_inputs(
        page,
        ("diameter, solid", OUTER, "m", "Stirling 2023, Table 3.1"),
        ("main bearing from the hub", STATIONS[1], "m"),
        ("second bearing from the hub", STATIONS[2], "m"),
        ("gearbox from the hub", STATIONS[3], "m", "Table 3.1, nearly (4.76 m)"),
        ("radial stiffness of a bearing", RADIAL / 1e9, "GN/m"),
        ("radial stiffness of the gearbox", GEARBOX / 1e6, "MN/m", "Table 3.1"),
        ("tilt stiffness of a bearing", TILT / 1e6, "MN m/rad", "section 3.3.1"),
        ("force and moment at the hub", 1, "MN, MN m"),
        steel=STEEL,
    )
    add_sweep(page, compliances[-1])
    page.table("Largest load on a support [N, N m]", rows)
    page.text(
        "The solid is solved once, for unit loads on its sections; springs are added to its "
        "compliance afterwards, so that any stiffness, rigid ones too, costs nothing more."
    )
    page.data("largest load on a support [N, N m]", rows)
    page.data("largest_difference", largest)


def check(
    page: Page,
    label: str,
    kind: str,
    compliances: Sequence[solid_shafts.Compliance],
    refinements: tuple[int, int],
    turn: int,
) -> Record:
    """One set of supports under one load; its row of the table."""
    springs, load = SETS[label], LOADS[kind]
    section = 2 * 4 * parabola_shortfall(turn)
    # a moment that enters inside the shaft bends it anticlastically on one side only
    local = solid_shafts.local_compliance(TUBE), solid_shafts.LOCAL * OUTER / TUBE.EI
    framed = by_frame(springs, load)
    same = by_macaulay(springs, load)
    exact = by_macaulay(springs, load, EVEN)
    softer = by_macaulay(springs, load, EVEN, local)
    rough, fine = (by_solid(C, springs, load) for C in compliances)
    finer = (refinements[1] / refinements[0]) ** 4 - 1
    worst = int(np.abs(exact.loads[::2]).argmax()) * 2
    if abs(exact.loads[worst]) < 1.0:  # a clamp takes a moment, and no force
        worst = 1
    where = NAMES[worst // 2]
    reference = exact.loads[worst]
    page.vanishes(
        f"{label}, {kind}: largest difference of a reaction, frame",
        float(np.abs(framed - same.loads).max()) / SIZE,
        within=1e-8,
        why="two exact solutions of one beam: round-off; over the hub load",
        source="Macaulay's brackets with shear, solved for the reactions",
    )
    page.equals(
        f"{label}, {kind}: load on the {where}, solid",
        fine.loads[worst],
        reference,
        within=section + abs(softer.loads[worst] - reference) / abs(reference),
        why=f"{turn} parabolic arcs round a turn; and what supports would change that are softer "
        f"by {solid_shafts.LOCAL:.0%} of what one diameter shears, or bends",
        source=EVENLY,
        unit="N m" if worst % 2 else "N",
        measure="reaction",
        band=float(3 * np.abs(rough.loads - fine.loads)[worst] / finer),
    )
    at = 0 if kind == "force" else 1
    slack = abs(softer.hub[at] / exact.hub[at] - 1)
    slack += local[0] * (load[0] / abs(exact.hub[0]) if kind == "force" else 0.0)
    page.equals(
        f"{label}, {kind}: {('deflection', 'rotation')[at]} of the hub, solid",
        float(fine.hub[at]),
        float(exact.hub[at]),
        within=section + slack,
        why="the same arcs and softer supports as for the load, at the hub",
        source=EVENLY,
        unit=("m", "rad")[at],
        measure="rotation" if at else "deflection",
        band=float(3 * np.abs(rough.hub - fine.hub)[at] / finer),
    )
    return {
        "supports": label,
        "hub": kind,
        "support": where,
        "Macaulay": reference,
        "frame": framed[worst],
        "solid": fine.loads[worst],
    }


def check_thesis(page: Page) -> None:
    """Eq 3.18 and 3.19: this beam without shear, on a radially rigid bearing."""
    span = LENGTH - STATIONS[1]
    R, M = torsional_spring_reaction(1e6, 1e6, STATIONS[1], span, TUBE.EI, GEARBOX, TILT)
    springs = ((RIGID, TILT), (0.0, 0.0), (GEARBOX, 0.0))
    plain = by_frame(springs, (1e6, 1e6), shear=False)
    for what, value, expected, unit in (
        ("force", plain[0], R, "N"),
        ("moment", plain[1], M, "N m"),
    ):
        page.equals(
            f"{what} on the bearing with tilt, frame without shear",
            value,
            float(expected),
            within=1e-9,
            why="the same beam: round-off",
            source="Stirling 2023, Eq 3.18-3.19",
            unit=unit,
            measure="reaction",
        )


def add_sweep(page: Page, C: solid_shafts.Compliance) -> None:
    """Loads on three supports as the second bearing is made stiffer."""
    stiff = np.logspace(6, 11, 41)
    shown = stiff[::8]

    def second(k: float) -> Springs:
        return ((RADIAL, 0.0), (k, 0.0), (GEARBOX, 0.0))

    beams = np.array([by_macaulay(second(k), LOADS["force"]).loads for k in stiff]) / 1e6
    meshed = np.array([by_solid(C, second(k), LOADS["force"]).loads for k in shown]) / 1e6
    traces = []
    for i, name in enumerate(NAMES):
        traces += [
            trace(name, stiff, beams[:, 2 * i]),
            trace(f"{name}, solid", shown, meshed[:, 2 * i], True),
        ]
    page.chart(
        "Loads on three supports under a hub force of 1 MN, as the second bearing is made stiffer: "
        "Macaulay's beam, and the solid by its compliance",
        traces,
        "radial stiffness of the second bearing [N/m]",
        "load [MN]",
        "x",
    )
