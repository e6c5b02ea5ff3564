"""What load cases leave out, of one machine: values that a project holds against its limits."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.procedure.two_stages import RATIO, off_grid
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import (
    ConvergenceInTime,
    InTime,
    converge_in_time,
    peak_between,
    round_off,
)
from fe_drivetrain.dynamics import (
    Level,
    Machine,
    assemble,
    assembly,
    machine_of,
    machine_system,
    system_modes,
)
from fe_drivetrain.dynamics.torsion import GENERATOR, ROTOR, Torsional, natural_modes
from fe_drivetrain.procedure import (
    DIPS,
    MISALIGNMENT,
    RESONANCE,
    REVERSALS,
    Dip,
    driven_motions,
    drivetrain_excitations,
    element_torques,
    machine_misalignment,
    motions_energy_error,
    resonances,
)
from fe_drivetrain.report import chart, mark_events, trace
from fe_drivetrain.report.number_text import certain_value, formatted
from fe_drivetrain.report.suite import ChosenDrivetrain, Page, Record, Run, check_in_time

DEFAULT = "nrel_750kw"
RPM = 2.0 * np.pi / 60.0  # rad/s
DEPTHS, SECONDS = (0.2, 0.5, 0.8, 1.0), (0.1, 0.15, 0.25, 0.5)  # of the torque, s
START = 0.2  # s
TORQUE = "Torque of the main shaft in voltage dips of 0.15 s"
MARGIN = "least margin of an excited frequency"
FORCE = "largest force of misalignment on a bearing [kN]"
MAXIMUM, MINIMUM = (
    "largest torque of the main shaft in a dip",
    "least torque of the main shaft in a dip",
)


@case(
    "What load cases leave out, of one drivetrain: resonance, misalignment, voltage dips",
    source="PROTEST 2010, ECN-E--10-100, section 4.2 and appendix A",
    settings={
        "drivetrain": "FILE, or a name of the library (otherwise nrel_750kw)",
        "low": "21.9 (rpm, lowest speed of the rotor, of another drivetrain that of its operation)",
        "high": "22.3 (rpm, highest speed of the rotor, likewise)",
        "torque": "325 (kN m, of the rotor before a dip, likewise)",
        "offset": "0.5 (mm, of each bearing of rotor, generator or a shaft)",
    },
)
def run(run: Run, page: Page) -> None:
    """One value for each gap, of the drivetrain that the page states."""
    chosen = run.drivetrain(DEFAULT)
    machine = machine_of(chosen.drivetrain)
    chosen.state(page)
    page.subject = machine.title
    low, high, torque = operation(run, chosen)
    offset = run.positive("offset", 0.5)
    with run.step("resonance"):
        resonance(page, machine, (low, high))
    with run.step("misalignment"):
        if machine.not_given:
            lost = ", ".join(machine.not_given)
            page.skip(FORCE, f"the file does not state what it needs: {lost}")
        else:
            misalignment(page, machine, 1e-3 * offset)
    with run.step("voltage dips"):
        dips(page, machine, 1e3 * torque)
    answer(page, (low, high), torque, offset)


def answer(page: Page, speeds: tuple[float, float], torque: float, offset: float) -> None:
    """State the margin to resonance, and what dips and offsets load."""
    low, high = speeds
    margin = page.judged(
        MARGIN, f"smallest margin of speed to a resonance, {low:.4g} to {high:.4g} rpm"
    )
    most = page.judged(MAXIMUM, "largest torque of the main shaft in a dip")
    least = page.judged(MINIMUM, "lowest torque of the main shaft in a dip")
    over = page.judged(
        f"{MAXIMUM}, over that before", "largest torque over that before", "two steps"
    )
    force = FORCE.partition(" [")[0]
    loaded = [
        page.judged(force, f"force on a bearing by {offset:g} mm of misalignment")
        for figure in page.figures
        if figure.quantity == force
    ]
    meets = (
        f"a resonance lies {100 * margin.value:.2g}\u00a0% from operating speed"
        if margin.value
        else "operation crosses a resonance"
    )
    page.answer(
        "What do a voltage dip, a resonance and misalignment do to this drivetrain?",
        f"A voltage dip swings the main shaft's torque from {certain_value(least)} to "
        f"{certain_value(most)}, {formatted(over.value, 3)} times that before; {meets}.",
        [most, least, over, margin, *loaded],
        hero=TORQUE,
        cautions=[
            f"Damping is assumed, {100 * RATIO:g} % of critical: the drivetrain's file has none.",
            f"Torque before a dip is {torque:.4g} kN m; in a dip the generator's torque falls to "
            "zero at worst.",
        ],
    )


def operation(run: Run, chosen: ChosenDrivetrain) -> tuple[float, float, float]:
    """Lowest and highest speed of the rotor [rpm], and its torque before a dip [kN m]."""
    low, high = run.positive("low", 21.9), run.positive("high", 22.3)
    torque = run.positive("torque", 325.0)
    if not chosen.own:
        return low, high, torque
    if "low" not in run.settings:
        low = chosen.rotor_speeds()[0] / RPM
    if "high" not in run.settings:
        high = chosen.rotor_speeds()[1] / RPM
    if "torque" not in run.settings:
        torque = chosen.rated_torque() / 1e3
    return low, high, torque


def resonance(page: Page, machine: Machine, speeds: tuple[float, float]) -> None:
    """Least margin of all excitations at all frequencies that they excite."""
    register = drivetrain_excitations(machine.stages)
    within = speeds[0] * RPM, speeds[1] * RPM
    level = Level.TORSIONAL if machine.not_given else Level.RIGID
    found = resonances(register, system_modes(machine_system(machine, level)), within)
    met = sorted((m for m in found if m.verdict != "not excited"), key=lambda m: m.margin)
    by_name = {e.name: e for e in register}
    page.vanishes(
        "frequencies of excitations at their crossings, largest relative error",
        max(abs(by_name[m.excitation].frequency(m.crossing) / m.frequency - 1.0) for m in met),
        **round_off(10, "a frequency divided by its order, and multiplied again"),
        source="speed = 2 pi f / order",
        basis="self-consistency",
    )
    at = np.linspace(*within, 4001)
    orders = [by_name[m.excitation].per_turn / (2.0 * np.pi * m.frequency) for m in met]
    nearest = min(float(np.abs(order * at - 1.0).min()) for order in orders)
    # both ends are among the speeds, so that a crossing within them alone may be missed
    steps = [0.5 * order for order, m in zip(orders, met, strict=True) if not m.margin]
    page.equals(
        f"{MARGIN}, by speeds one after another",
        met[0].margin,
        nearest,
        within=1e-12 + float(at[1] - at[0]) * max(steps, default=0.0),
        relative=False,
        why="rounding; a crossing between two speeds is missed by half of what a step changes",
        source="all frequencies at 4001 speeds",
        measure="frequency",
    )
    page.found(MARGIN, met[0].margin, loads=(RESONANCE,))
    page.section("Resonance")
    page.table(
        f"Nearest of {len(met)} excited, from {speeds[0]:.4g} to {speeds[1]:.4g} rpm",
        [
            {
                "excitation": m.excitation,
                "frequency [Hz]": m.frequency,
                "crossing [rpm]": m.crossing / RPM,
                "margin": m.margin,
                "energy share": m.share,
                "verdict": m.verdict,
            }
            for m in met[:12]
        ],
    )
    page.text(
        f"From {speeds[0]:.4g} to {speeds[1]:.4g} rpm the least margin is {met[0].margin:.3g}: "
        f"{met[0].excitation} at {met[0].frequency:.4g} Hz."
    )


def misalignment(page: Page, machine: Machine, offset: float) -> None:
    """Largest force on any bearing while those of shafts are anywhere within an offset."""
    found = machine_misalignment(machine)
    apart = {ROTOR, GENERATOR, *(shaft.name for shaft in machine.shafts)}
    moved = {bearing.name for bearing in machine.bearings if bearing.holds in apart}
    if not moved:
        page.skip(FORCE, "no bearing of this machine holds rotor, generator or a shaft")
        return
    places = [name.rpartition(" ")[0] for name in found.names]
    shifts = [name[-2] == "u" for name in found.names]
    wide = [offset * (p in moved and u) for p, u in zip(places, shifts, strict=True)]
    forces, _ = found.worst(np.array(wide))
    other = by_stiffness(machine)
    page.vanishes(
        "influence of offsets, largest difference of two ways over the largest",
        float(np.abs(other - found.influence).max() / np.abs(other).max()),
        within=1e-8,
        why="a pseudo-inverse of stiffnesses that lie ten powers of ten apart",
        source="stiffness equations of the machine on its bearings",
        measure="identity",
    )
    sizes = np.where(shifts, forces, 0.0)
    most = int(sizes.argmax())
    page.found(FORCE, float(sizes[most]) / 1e3, loads=(MISALIGNMENT,))
    page.section("Misalignment")
    rows = [
        {"bearing": name, "force [kN]": float(force) / 1e3}
        for name, force, shift in zip(found.names, forces, shifts, strict=True)
        if shift
    ]
    words = ", ".join(sorted(moved))
    page.table(f"Worst force while {words} is within {1e3 * offset:g} mm of its place", rows)
    page.text(
        f"Offsets of {1e3 * offset:g} mm ({words}) load {found.names[most]} by up to "
        f"{sizes[most] / 1e3:.3g} kN."
    )
    page.text("Bearings in the gearbox are bored in one housing, and keep their places.")


def by_stiffness(machine: Machine) -> Floats:
    """Influence of offsets by the stiffness equations of the machine on its bearings."""
    made = assembly(machine, Level.FLEXIBLE, held_generator=True)
    system = assemble(made.bodies, made.springs, made.superelements)
    bearings = {bearing.name for bearing in machine.bearings}
    held = np.array([name.rpartition(" ")[0] in bearings for name in system.spring_names])
    H, k = system.rows[held], system.stiffness[held]
    flexible = np.linalg.pinv(system.K, hermitian=True)
    return np.asarray(np.diag(k) - (k[:, None] * H) @ flexible @ (H.T * k))


def dips(page: Page, machine: Machine, torque: float) -> None:
    """Torque of the main shaft while the generator's dips, over depth and duration."""
    system = off_grid(machine)
    frequency = float(natural_modes(system).frequencies[1])
    shown: dict[str, Floats] = {}

    def run(step: float, _: int) -> InTime:
        one, curves = dips_of(system, machine, step)
        shown.update(curves)  # the shortest step is the last
        return one

    found = converge_in_time(run, 1.0 / (200.0 * frequency))
    page.section("Voltage dips")
    check_in_time(
        page,
        "dips",
        found,
        dict.fromkeys(found.finest.values, 0.02),
        energy=1e-4,
        why="integrals of the fourth order of the step, over what the shaft takes up",
        scale=dict.fromkeys(found.finest.values, 1.0),
    )
    rows = dip_rows(found, torque)
    band = torque / 1e3 * max(found.band(key) for key in found.finest.values)
    front = machine.rotor.inertia
    rear = machine.speeds[-1] ** 2 * machine.generator.inertia
    most = max(row["largest [kN m]"] for row in rows)
    page.at_most(
        f"{MAXIMUM}, over that before",
        1e3 * most / torque,
        1.0 + 2.0 * max(DEPTHS) * front / (front + rear),
        why="without damping two steps leave an amplitude of twice one step at most",
        source="an oscillator: 1 + 2 depth J_r / (J_r + J_g)",
        measure="reaction",
        band=1e3 * band / torque,
    )
    page.found(f"{MAXIMUM} [kN m]", most, band, (DIPS,))
    least = min(row["least [kN m]"] for row in rows)
    page.found(f"{MINIMUM} [kN m]", least, band, (REVERSALS,))
    curves = [
        trace(name, found.steps[-1] * np.arange(len(q))[::4], torque * q[::4] / 1e3)
        for name, q in shown.items()
    ]
    torques = chart(TORQUE, curves, "time [s]", "torque [kN m]")
    page.add(mark_events(torques, {"dip": START, "end of it": START + SECONDS[1]}))
    page.table(f"By depth and duration; first frequency {frequency:.3g} Hz", rows)
    page.assume("damping ratio of the drivetrain", RATIO, "", "the drivetrain's file has none")


def name_of(depth: float, seconds: float, end: str) -> str:
    """Key of an end of the torque in a dip, over that before."""
    return f"{depth:g} for {seconds:g} s: {end} torque / before"


def dips_of(system: Torsional, machine: Machine, step: float) -> tuple[InTime, dict[str, Floats]]:
    """Ends of the torque in the main shaft over that before, of each dip, and what is shown."""
    values, lost, shown = {}, 0.0, {}
    for depth in DEPTHS:
        for seconds in SECONDS:
            found, error = torque_of(system, machine, Dip(START, depth, seconds), step)
            lost = max(lost, error)
            values[name_of(depth, seconds, "largest")] = peak_between(found)
            values[name_of(depth, seconds, "least")] = -peak_between(-found)
            if seconds == SECONDS[1]:
                shown[f"depth {depth:g}"] = found
    return InTime(values, lost), shown


def dip_rows(found: ConvergenceInTime, torque: float) -> list[Record]:
    """Ends of the torque of each dip, of the shortest step."""
    ends = ("largest", "least")
    return [
        {"depth": depth, "duration [s]": seconds}
        | {f"{e} [kN m]": torque * found.value(name_of(depth, seconds, e)) / 1e3 for e in ends}
        for depth in DEPTHS
        for seconds in SECONDS
    ]


def torque_of(system: Torsional, machine: Machine, dip: Dip, step: float) -> tuple[Floats, float]:
    """(n,) torque in the main shaft over that before, in four seconds; and its energy's error."""
    time = np.arange(0.0, 4.0, step)
    torques = np.zeros((len(system.names), len(time)))
    torques[system.place(ROTOR)] = 1.0
    torques[system.place(GENERATOR)] = -dip.shares(time) / machine.speeds[-1]
    motions = driven_motions(system, torques, step)
    row = [element.name for element in system.elements].index(machine.shafts[0].name)
    found = np.asarray(element_torques(system, motions)[row])
    return found, motions_energy_error(system, torques, motions)
