"""Two and three supports, rigid or on springs: frame, Macaulay's beam and solid."""

from collections.abc import Sequence

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.shaft_theory import Tube, parabola_shortfall
from fe_drivetrain.cases.references.solid_shafts import (
    LOCAL,
    Compliance,
    Supported,
    local_compliance,
    straight,
)
from fe_drivetrain.cases.references.supported_shafts import Load, SupportedShaft
from fe_drivetrain.cases.verification.shaft_inputs import begin, show_inputs
from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file import MATERIALS
from fe_drivetrain.report import trace
from fe_drivetrain.report.answer import KeyFigure
from fe_drivetrain.report.number_text import certain_value
from fe_drivetrain.report.suite import Page, Record, Run, Target
from fe_drivetrain.shafts.beam import torsional_spring_reaction

STEEL = MATERIALS["steel"]
OUTER = 0.4
#: Hub, main bearing, second bearing, gearbox [m] from the hub.
STATIONS = (0.0, 1.2, 2.8, 4.8)
LENGTH = STATIONS[-1]
TUBE = Tube(OUTER, 0.0, LENGTH, STEEL)
#: Radial stiffness of the bearings and of the gearbox [N/m], tilt of the main bearing [N m/rad].
RADIAL, GEARBOX, TILT = 2e9, 8e7, 145e6
RIGID = float("inf")
SHARED = "Loads on three supports under a hub force of 1 MN, as the second bearing is made "
SHARED += "stiffer: Macaulay's beam, and the solid by its compliance"
NAMES = ("main bearing", "second bearing", "gearbox")


def on(*springs: tuple[float, float]) -> SupportedShaft:
    """The shaft on (force, moment) stiffness at both bearings and the gearbox [N/m, N m/rad]."""
    return SupportedShaft(TUBE, STATIONS, ((0.0, 0.0), *springs))


SETS = {
    "bearing with tilt, gearbox": on((RADIAL, TILT), (0.0, 0.0), (GEARBOX, 0.0)),
    "clamped in the bearing, gearbox": on((RIGID, RIGID), (0.0, 0.0), (RIGID, 0.0)),
    "three rigid supports": on((RIGID, 0.0), (RIGID, 0.0), (RIGID, 0.0)),
    "two bearings, soft gearbox": on((RADIAL, 0.0), (RADIAL, 0.0), (GEARBOX, 0.0)),
    "two bearings with tilt, gearbox": on((RADIAL, TILT), (RADIAL, TILT), (GEARBOX, 0.0)),
}
LOADS = {"force": Load(0, force=1e6), "moment": Load(0, moment=1e6)}
SIZE = 1e6
EVENLY = "Macaulay's brackets with shear of evenly loaded sections (Hutchinson 2001)"


def carried(found: Supported) -> Floats:
    """(6,) forces and moments that the shaft puts on the supports."""
    return np.asarray(-found.reactions[1:].ravel())


@case(
    "Two and three supports on springs: frame, Macaulay's beam and solid",
    source="Macaulay's brackets with shear; Stirling 2023, Eq 3.18-3.19",
)
def run(run: Run, page: Page) -> None:
    """Several sets of supports under a hub force and a hub moment."""
    refinements = (1, 2) if run.quick else (2, 3)
    free = SETS["three rigid supports"]
    meshes = [run.timed("mesh and solve", free.compliance, r, 3 * OUTER) for r in refinements]
    turn, finest = meshes[-1]
    # three times what is missing at the fourth order
    finer = 3 / ((refinements[1] / refinements[0]) ** 4 - 1)
    rows = [
        check(page, label, kind, [C for _, C in meshes], finer, turn)
        for label in SETS
        for kind in LOADS
    ]
    check_thesis(page)
    largest = max(abs(row["solid"] / row["Macaulay"] - 1) for row in rows)
    answer(page, 100 * largest)
    begin(run, page, "Indeterminate supports", straight((0.0, LENGTH), OUTER))
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
    add_sweep(page, finest)
    page.table("Largest load on a support [N, N m]", rows)
    page.text(
        "The solid is solved once, for unit loads on its sections; springs are added to its "
        "compliance afterwards, so that any stiffness, rigid ones too, costs nothing more."
    )
    page.data("largest load on a support [N, N m]", rows)
    page.data("largest_difference", largest)


def answer(page: Page, largest: float) -> None:
    """State loads on bearings that statics leaves open, and how far solids are [%] from beams."""

    def on_main(supports: str) -> KeyFigure:
        quantity = f"{supports}, force: load on the main bearing, solid"
        return page.judged(quantity, f"load on the main bearing, {supports}", "beam", unit="MN")

    rigid, soft = on_main("three rigid supports"), on_main("two bearings, soft gearbox")
    page.answer(
        "How do supports share a hub force where statics alone does not determine it?",
        f"Under 1\u00a0MN at the hub the main bearing of three rigid supports carries "
        f"{certain_value(rigid)}; solids and beams agree within {largest:.2g}\u00a0% for five "
        "arrangements.",
        [
            rigid,
            soft,
            on_main("two bearings with tilt, gearbox"),
            on_main("bearing with tilt, gearbox"),
            page.judged(
                "clamped in the bearing, gearbox, moment: load on the main bearing, solid",
                "moment on a clamped bearing under 1 MN m",
                "beam",
                unit="MN m",
            ),
            page.value("largest difference of solid and beam [%]", largest),
        ],
        hero=SHARED,
        cautions=["Supports act evenly on a section of the shaft: bearing seats are not modelled."],
    )


def check(
    page: Page,
    label: str,
    kind: str,
    compliances: Sequence[Compliance],
    finer: float,
    turn: int,
) -> Record:
    """One set of supports under one load; its row of the table."""
    shaft, load = SETS[label], LOADS[kind]
    section = 2 * 4 * parabola_shortfall(turn)
    framed, same = (carried(found(load)) for found in (shaft.frame, shaft.beam))
    # a moment that enters inside the shaft bends it anticlastically on one side only
    exact, softer = shaft.evenly(load), shaft.softer(load)
    rough, fine = (shaft.solid(C, load) for C in compliances)
    on_supports = carried(exact)
    worst = int(np.abs(on_supports[::2]).argmax()) * 2
    if abs(on_supports[worst]) < 1.0:  # a clamp takes a moment, and no force
        worst = 1
    where = NAMES[worst // 2]
    reference = on_supports[worst]
    beams = "two exact solutions of one beam: round-off; over the hub load"
    brackets = "Macaulay's brackets with shear, solved for the reactions"
    softened = (
        f"{turn} parabolic arcs round a turn; and what supports would change that are softer "
    )
    softened += f"by {LOCAL:.0%} of what one diameter shears, or bends"
    hub = "the same arcs and softer supports as for the load, at the hub"

    apart = float(np.abs(framed - same).max()) / SIZE
    title = "largest difference of a reaction, frame"
    page.meets(apart, Target(title, 0.0, 1e-8, beams, brackets), of=f"{label}, {kind}")

    coarse, found = carried(rough), carried(fine)
    within = section + abs(carried(softer)[worst] - reference) / abs(reference)
    title = f"load on the {where}, solid [{'N m' if worst % 2 else 'N'}]"
    target = Target(title, reference, within, softened, EVENLY, measure="reaction")
    band = float(finer * np.abs(coarse - found)[worst])
    page.meets(found[worst], target, band, f"{label}, {kind}")

    at = 0 if kind == "force" else 1
    coarsely, moved, even = (of.motions[0, at] for of in (rough, fine, exact))
    slack = abs(softer.motions[0, at] / even - 1) + local_compliance(TUBE) * load.force / abs(even)
    title = ("deflection of the hub, solid [m]", "rotation of the hub, solid [rad]")[at]
    target = Target(title, float(even), section + slack, hub, EVENLY)
    page.meets(float(moved), target, float(finer * abs(coarsely - moved)), f"{label}, {kind}")
    return {
        "supports": label,
        "hub": kind,
        "support": where,
        "Macaulay": reference,
        "frame": framed[worst],
        "solid": found[worst],
    }


def check_thesis(page: Page) -> None:
    """Eq 3.18 and 3.19: this beam without shear, on a radially rigid bearing."""
    span, both = LENGTH - STATIONS[1], Load(0, force=1e6, moment=1e6)
    expected = torsional_spring_reaction(1e6, 1e6, STATIONS[1], span, TUBE.EI, GEARBOX, TILT)
    plain = carried(on((RIGID, TILT), (0.0, 0.0), (GEARBOX, 0.0)).frame(both, shear=False))
    why, thesis = "the same beam: round-off", "Stirling 2023, Eq 3.18-3.19"
    for what, value, reference in zip(("force [N]", "moment [N m]"), plain, expected, strict=False):
        name, unit = what.split(" ", 1)
        key = f"{name} on the bearing with tilt, frame without shear {unit}"
        page.meets(value, Target(key, float(reference), 1e-9, why, thesis, measure="reaction"))


def add_sweep(page: Page, C: Compliance) -> None:
    """Loads on three supports as the second bearing is made stiffer."""
    stiff = np.logspace(6, 11, 41)
    shown, force = stiff[::8], LOADS["force"]

    def second(k: float) -> SupportedShaft:
        return on((RADIAL, 0.0), (k, 0.0), (GEARBOX, 0.0))

    beams = np.array([carried(second(k).beam(force)) for k in stiff]) / 1e6
    meshed = np.array([carried(second(k).solid(C, force)) for k in shown]) / 1e6
    traces = []
    for i, name in enumerate(NAMES):
        traces += [
            trace(name, stiff, beams[:, 2 * i]),
            trace(f"{name}, solid", shown, meshed[:, 2 * i], True),
        ]
    page.chart(SHARED, traces, "radial stiffness of the second bearing [N/m]", "load [MN]", "x")
