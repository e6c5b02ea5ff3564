"""What design load cases leave out: resonance, misalignment, voltage dips; loads at interfaces."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.procedure.assumed import PLACES
from fe_drivetrain.cases.procedure.gapped_drivetrain import RPM, Gapped, gapped
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import (
    ConvergenceInTime,
    InTime,
    converge_in_time,
    peak_between,
    round_off,
)
from fe_drivetrain.dynamics import damped_by_ratio
from fe_drivetrain.dynamics.torsion import (
    GENERATOR,
    Torsional,
    damped,
    gear_masses,
    gear_speeds,
    natural_modes,
    shaft_damping,
    two_masses,
)
from fe_drivetrain.procedure import (
    Dip,
    Excitation,
    Meeting,
    Misalignment,
    TorqueTable,
    analysed,
    driven_motions,
    drivetrain_excitations,
    element_torques,
    imbalance,
    influence_of_offsets,
    motions_energy_error,
    protest_catalogue,
    resonances,
    three_point_loads,
    write_load_csv,
    write_load_json,
)
from fe_drivetrain.report import chart, mark_events, trace
from fe_drivetrain.report.number_text import formatted, value_text
from fe_drivetrain.report.suite import Page, Record, Run, check_in_time
from fe_drivetrain.shafts.beam import Beam, BeamSection, condensed_beam
from fe_drivetrain.turbine_loads.hub_loads import Condition, hub_loads

CONTROLLER = 10.0  # Hz, of its communication
SECOND = 1.2  # m, of a second main bearing
TOLERANCE = 0.5e-3  # m
BEARING, ARM = 3e9, 1e8  # N/m
DIPS = [(depth, seconds) for depth in (0.2, 0.5, 0.8, 1.0) for seconds in (0.1, 0.15, 0.25, 0.5)]
SHAPES = {
    "one dip": Dip(0.2, 0.8, 0.15).table,
    "slow recovery": TorqueTable((0.2, 0.21, 0.35, 1.7), (1.0, 0.2, 0.2, 1.0)),
    "two dips": TorqueTable(
        (0.2, 0.21, 0.35, 0.36, 0.6, 0.61, 0.75, 0.76), (1.0, 0.2, 0.2, 1.0, 1.0, 0.2, 0.2, 1.0)
    ),
}
#: Name, station, directions and their shares, stiffness [N/m].
Support = tuple[str, int, dict[int, float], float]
LARGEST = "largest torque of all dips, over that before"
TORQUE = "Torque of the low-speed shaft over that before, dips of 0.15 s"
OFFSETS = "offsets of supports"
LOADS = "loads at interfaces"
MAXIMUM, MINIMUM = "largest torque over that before", "least torque over that before"


@case(
    "What design load cases leave out: resonance, misalignment, voltage dips",
    source="PROTEST 2010, ECN-E--10-100, Tables 4.1 to 4.5, section 4.2, appendix A; "
    "Al-Hamadani 2018, Tables 4.3 and 4.7 (drivetrain C)",
    settings={
        "drivetrain": "FILE, or a name of the library (otherwise drivetrain C of Al-Hamadani)"
    },
)
def run(run: Run, page: Page) -> None:
    """The catalogue's gaps, each run; and loads at interfaces that are in equilibrium."""
    catalogue = protest_catalogue()
    page.section("Design loads without a load case")
    page.table(
        f"Of {len(catalogue.design_loads)} design loads, those that load cases do not cover",
        [
            {"load": load.name, "table": load.table, "covered": load.covered, "run": load.remedy}
            for load in catalogue.uncovered
        ],
    )
    of = gapped(run, page)
    with run.step("resonance"), page.of(of.drivetrain):
        met = resonance(page, of)
    force = None
    if of.title:
        page.skip(OFFSETS, "procedure/machine_gaps has those of your own bearings")
        page.skip(LOADS, "procedure/interfaces has those of your own on three points")
    else:
        with run.step("misalignment"), page.of(None):
            force = misalignment(page)
    with run.step("voltage dips"), page.of(of.drivetrain):
        least = dips(page, of)
    if not of.title:
        with run.step("interfaces"), page.of(None):
            interfaces(run, page)
    answer(page, of, met, least, force)


def answer(
    page: Page, of: Gapped, met: int, least: float, offset: tuple[str, float] | None
) -> None:
    """State the torque of dips, resonances in operation, and the force [kN] of an offset."""
    catalogue = protest_catalogue()
    largest = page.judged(LARGEST, "largest torque in a dip over that before", "two steps")
    dips = (
        f"Load cases leave out voltage dips ({formatted(largest.value, 3)} times the torque before)"
    )
    resonances = f"{met} resonances in the operating range"
    verdict = f"{dips} and {resonances}"
    forces = []
    share = f"{100 * of.ratio:g} % of critical"
    cautions = [
        f"Damping of {of.title} is {share}."
        if of.title
        else f"Damping of drivetrain C is assumed, {share}: its tables have none."
    ]
    if offset is not None:
        support, force = offset
        verdict = (
            f"{dips}, {resonances} and misalignment (0.5\u00a0mm loads a bearing with "
            f"{value_text(force, 'kN')})"
        )
        forces = [page.value(f"force by 0.5 mm of misalignment, {support} [kN]", force)]
        cautions.append(
            "The force is that with two main bearings: on a three-point suspension misalignment "
            "loads nothing."
        )
    page.answer(
        "What do the standard's design load cases leave out of a drivetrain?",
        f"{verdict}.",
        [
            largest,
            page.value("lowest torque in a dip over that before", least),
            page.value("resonances in the operating range", met),
            *forces,
            page.value(
                "design loads that no load case covers",
                len(catalogue.uncovered),
                beside=len(catalogue.design_loads),
                by="all",
            ),
        ],
        hero=TORQUE,
        cautions=cautions,
    )


def resonance(page: Page, of: Gapped) -> int:
    """Register of excitations against the modes of a gearbox."""
    system, speeds = gear_masses(of.table, "free"), of.speeds
    modes = natural_modes(system)
    register = (
        *drivetrain_excitations(of.table.stages),
        Excitation("controller", 0.0, (GENERATOR,), fixed=CONTROLLER),
    )
    found = resonances(register, modes, (speeds[0] * RPM, speeds[1] * RPM))
    by_name = {e.name: e for e in register}
    page.vanishes(
        "frequencies of excitations at their crossings, largest relative error",
        max(
            abs(by_name[m.excitation].frequency(m.crossing) / m.frequency - 1.0)
            for m in found
            if np.isfinite(m.crossing)
        ),
        **round_off(10, "a frequency divided by its order, and multiplied again"),
        source="n = 60 f / order",
        basis="self-consistency",
    )
    rows: list[Record] = [
        {
            "excitation": m.excitation,
            "mode": m.mode,
            "frequency [Hz]": m.frequency,
            "crossing [rpm]": m.crossing / RPM if np.isfinite(m.crossing) else None,
            "margin": m.margin,
            "energy share": m.share,
            "verdict": m.verdict,
        }
        for m in found
        if m.verdict in ("resonance", "near")
    ]
    met = sum(m.verdict == "resonance" for m in found)
    crossed = sum(m.margin == 0.0 for m in found)
    page.section("Resonance")
    page.table(f"Excitations that meet a mode from {speeds[0]:.4g} to {speeds[1]:.4g} rpm", rows)
    chart_meetings(page, speeds, [m for m in found if m.verdict == "resonance"], by_name)
    page.data("resonances", rows)
    page.assume("frequency of the controller's communication", CONTROLLER, "Hz", "none is given")
    page.text(
        f"Excitations of {of.title or 'drivetrain C'} cross a frequency {crossed} times in "
        f"operation, {met} times at a part that has 1 % or more of the mode's energy."
    )
    return met


def chart_meetings(
    page: Page,
    operation: tuple[float, float],
    met: list[Meeting],
    by_name: dict[str, Excitation],
) -> None:
    """Modes that are met, and the lines of the excitations that meet them."""
    lines = dict.fromkeys(m.excitation for m in met)
    speeds = np.array([0.0, operation[1]])
    frequencies = sorted({m.frequency for m in met})
    page.chart(
        "Campbell diagram: modes that are met, and what meets them; shaded: operation",
        [
            *(
                trace(name, speeds, [by_name[name].frequency(RPM * float(v)) for v in speeds])
                for name in lines
            ),
            *(
                trace(f"{f:.1f} Hz", speeds, [f, f], line={"dash": "dot"}, showlegend=False)
                for f in frequencies
            ),
        ],
        "rotor speed [rpm]",
        "frequency [Hz]",
        safe=operation,
    )


def misalignment(page: Page) -> tuple[str, float]:
    """Tolerances at the supports of a drivetrain on three points, and on four."""
    stations = np.array([PLACES.hub, PLACES.bearing, SECOND, PLACES.arms])
    beam = Beam([BeamSection(PLACES.arms - PLACES.hub, 0.6)], [], start=PLACES.hub)
    K = condensed_beam(beam, ("hub", "bearing", "second", "arms"), stations).stiffness
    three, four = supports()
    rows: list[Record] = []
    for name, held in (("three points", three), ("four points", four)):
        found = influences_of(K, held)
        check_determinacy(page, name, found)
        forces, _ = found.worst(np.full(len(held), TOLERANCE))
        rows += [
            {
                "drivetrain on": name,
                "support": support,
                "worst force [kN]": round(float(force)) / 1e3,
            }
            for support, force in zip(found.names, forces, strict=True)
        ]
    page.section("Misalignment")
    page.table(
        f"Worst force in each support, all supports anywhere within {TOLERANCE * 1e3:g} mm", rows
    )
    page.data("misalignment", rows)
    worst = max(rows, key=lambda row: float(row["worst force [kN]"]))
    return str(worst["support"]), float(worst["worst force [kN]"])


def supports() -> tuple[list[Support], list[Support]]:
    """Supports of a drivetrain on three points, and on four."""
    half = 0.5 * PLACES.between_arms
    three = [
        ("bearing, axial", 1, {0: 1.0}, BEARING),
        ("bearing, lateral", 1, {1: 1.0}, BEARING),
        ("bearing, vertical", 1, {2: 1.0}, BEARING),
        ("arms, lateral", 3, {1: 1.0}, ARM),
        ("left arm, vertical", 3, {2: 1.0, 3: half}, ARM),
        ("right arm, vertical", 3, {2: 1.0, 3: -half}, ARM),
    ]
    return three, [
        *three,
        ("second bearing, lateral", 2, {1: 1.0}, BEARING),
        ("second bearing, vertical", 2, {2: 1.0}, BEARING),
    ]


def influences_of(K: Floats, held: list[Support]) -> Misalignment:
    """What offsets of the supports do to the forces in all of them."""
    H = np.zeros((len(held), len(K)))
    for row, (_, station, entries, _) in zip(H, held, strict=True):
        for direction, value in entries.items():
            row[6 * station + direction] = value
    return influence_of_offsets(
        K, H, np.array([k for *_, k in held]), tuple(name for name, *_ in held)
    )


def check_determinacy(page: Page, name: str, found: Misalignment) -> None:
    """Offsets load no determinate supports."""
    supports = len(found.names)
    page.holds(
        f"{name}: the degree of static indeterminacy is {supports - 6}",
        found.degree == supports - 6,
        why="offsets of as many supports could not be made up for without force",
        source="restraints less six rigid motions",
    )
    if not found.degree:
        page.vanishes(
            f"{name}: largest force of misalignment [N]",
            float(np.abs(found.forces(np.full(supports, TOLERANCE))).max()),
            within=0.0,
            why="there is no state of stress that is in equilibrium with itself",
            source="statically determinate supports",
        )


def dips(page: Page, of: Gapped) -> float:
    """Torque of the shaft while the generator's dips, over depth and duration."""
    free = two_masses(of.table, "free")
    front, rear = free.J
    inertia = float(front * rear / (front + rear))
    system = damped(free, {"shafts": shaft_damping(of.ratio, inertia, float(free.k[0]))})
    frequency = float(natural_modes(system).frequencies[1])
    page.section("Voltage dips")
    found = converge_in_time(lambda h, _: simulate_dips(system, h)[0], 1.0 / (200.0 * frequency))
    check_dips(page, "dip", found)
    time, shown, reversals = simulate_dips(system, found.steps[-1])[1:]
    rows: list[Record] = [
        {
            "depth": depth,
            "duration [s]": seconds,
            "largest torque / before": found.value(f"{depth:g} for {seconds:g} s: {MAXIMUM}"),
            "least torque / before": found.value(f"{depth:g} for {seconds:g} s: {MINIMUM}"),
            "reversals": reversals[depth, seconds],
        }
        for depth, seconds in DIPS
    ]
    page.at_most(
        LARGEST,
        max(float(row["largest torque / before"]) for row in rows),
        1.0 + 2.0 * max(d for d, _ in DIPS) * float(front / (front + rear)),
        why="without damping two steps leave an amplitude of twice one step at most",
        source="an oscillator: 1 + 2 depth J_r / (J_r + J_g)",
        measure="reaction",
    )
    torques = chart(
        TORQUE,
        [trace(name, time[::4], torque[::4]) for name, torque in shown.items()],
        "time [s]",
        "torque / torque before",
    )
    page.add(mark_events(torques, {"voltage dips": 0.2, "voltage is back": 0.35}))
    page.table(f"Dips by depth and duration; first frequency {frequency:.2f} Hz", rows)
    page.data("dips", rows)
    page.say(
        f"How the length of a dip falls on the shaft's period of {1 / frequency:.2f} s matters as "
        "much as its depth."
    )
    tables(page, of)
    page.assume(
        "damping ratio of the drivetrain",
        of.ratio,
        "",
        "the file's of shafts, or a hundredth"
        if of.title
        else "the tables of drivetrain C have none",
    )
    return min(float(row["least torque / before"]) for row in rows)


def simulate_dips(
    system: Torsional, step: float
) -> tuple[InTime, Floats, dict[str, Floats], dict[tuple[float, float], int]]:
    """Largest and least torque of each dip, and what is shown of them."""
    time = np.asarray(np.arange(0.0, 4.0, step), dtype=np.float64)
    values, lost, shown, reversals = {}, 0.0, {}, {}
    for depth, seconds in DIPS:
        brake = Dip(0.2, depth, seconds).shares(time)
        torques = np.stack([np.ones_like(time), -brake])
        motions = driven_motions(system, torques, step)
        torque = element_torques(system, motions)[0]
        values[f"{depth:g} for {seconds:g} s: {MAXIMUM}"] = peak_between(torque)
        values[f"{depth:g} for {seconds:g} s: {MINIMUM}"] = -peak_between(-torque)
        lost = max(lost, motions_energy_error(system, torques, motions))
        reversals[depth, seconds] = int(np.count_nonzero(np.diff(np.sign(torque))))
        if seconds == 0.15:
            shown[f"depth {depth:g}"] = torque
    return InTime(values, lost), time, shown, reversals


def check_dips(page: Page, of: str, found: ConvergenceInTime) -> None:
    """Energy and convergence of dips."""
    check_in_time(
        page,
        of,
        found,
        dict.fromkeys(found.finest.values, 0.02),
        energy=1e-4,
        why="integrals of the fourth order of the step, over what the shaft takes up",
        scale=dict.fromkeys(found.finest.values, 1.0),
    )


def tables(page: Page, of: Gapped) -> None:
    """Dips of other shapes, by table, on all gears: largest and least torque of each element."""
    bare = gear_masses(of.table, "free")
    system = damped_by_ratio(bare, {e.name: of.ratio for e in bare.elements})
    ratio = gear_speeds(of.table)[GENERATOR]
    elements = [e.name for e in system.elements if e.name.rpartition(" ")[2] not in ("2", "3")]
    found = converge_in_time(lambda h, _: simulate_shapes(system, ratio, elements, h), 2.5e-4)
    check_dips(page, "dip on all gears", found)
    rows: list[Record] = [
        {
            "table": name,
            "element": element,
            "largest torque / before": found.value(f"{name}, {element}: {MAXIMUM}"),
            "least torque / before": found.value(f"{name}, {element}: {MINIMUM}"),
        }
        for name in SHAPES
        for element in elements
    ]
    page.table("Dips by table on all gears (one planet of each stage)", rows)
    page.data("dips by table", rows)


def simulate_shapes(system: Torsional, ratio: float, elements: list[str], step: float) -> InTime:
    """Ends of the torque of elements over that before, for dips of each shape."""
    time = np.asarray(np.arange(0.0, 3.0, step), dtype=np.float64)
    names = [e.name for e in system.elements]
    values, lost = {}, 0.0
    for name, table in SHAPES.items():
        torques = np.zeros((len(system.names), len(time)))
        torques[0] = 1.0
        torques[system.place(GENERATOR)] = -table.shares(time) / ratio
        motions = driven_motions(system, torques, step)
        found = element_torques(system, motions)
        for element in elements:
            share = found[names.index(element)] / found[names.index(element), 0]
            values[f"{name}, {element}: {MAXIMUM}"] = peak_between(share)
            values[f"{name}, {element}: {MINIMUM}"] = -peak_between(-share)
        lost = max(lost, motions_energy_error(system, torques, motions))
    return InTime(values, lost)


def interfaces(run: Run, page: Page) -> None:
    """Loads at all interfaces from simulated hub loads, in equilibrium, exported."""
    made = hub_loads(Condition(16.0, "medium", 0.2, 1), duration=60.0 if run.quick else 600.0)
    table = three_point_loads(PLACES, made.time, made.loads)
    for body in table.bodies:
        page.vanishes(
            f"{body.name}: error of equilibrium in any row, over the largest load",
            float(np.abs(imbalance(table, body.name)).max()),
            **round_off(100, "sums of a dozen forces and moments, arms of some metres"),
            source="forces and moments of all interfaces, and the weight",
        )
    arms = [table.interface(f"{side} arm").loads[:, 2] for side in ("left", "right")]
    housing = 0.5 * PLACES.between_arms * (arms[0] - arms[1])
    torque = made.loads[:, 3]
    page.vanishes(
        "torque of the arms and T_LSS - T_HSS, largest difference over the torque",
        float(np.abs(housing + torque * (1.0 - 1.0 / PLACES.ratio)).max() / np.abs(torque).max()),
        **round_off(100, "the torque of two arms from sums of a dozen forces"),
        source="torque of the housing",
    )
    rows = [
        {k: v for k, v in row.items() if not isinstance(v, list) and k != "source"}
        for row in analysed(table)
        if max(abs(row["least"]), abs(row["largest"])) > 0.0
    ]
    write_load_csv(table, run.folder / "interfaces.csv")
    write_load_json(table, run.folder / "interfaces.json")
    page.section("Loads at interfaces")
    page.table("Loads at interfaces at 16 m/s (interfaces.csv and .json have every row)", rows)
    page.text(
        "The drivetrain stands on a main bearing without moments and two torque arms, so that the "
        "loads follow from those of the hub. Equivalent loads are at 1 Hz, by the slope of the "
        "S-N curve. Places and masses are assumed, of a machine of 2 MW."
    )
