"""Resonance of bodies with six degrees of freedom: register, margins, a run-up and its Campbell."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.procedure.swept_modes import Sweep, run_up_peak, swept_response
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import (
    ConvergenceInTime,
    InTime,
    converge_in_time,
    peak_between,
    round_off,
)
from fe_drivetrain.dynamics import (
    Loads,
    System,
    SystemModes,
    crossings,
    direction_kinds,
    energy_error,
    equations_of,
    exact_steps,
    library_machine,
    machine_system,
    system_modes,
    with_proportional_damping,
)
from fe_drivetrain.dynamics.torsion import mesh_orders
from fe_drivetrain.procedure import (
    Meeting,
    drivetrain_excitations,
    resonances,
)
from fe_drivetrain.report import heat_map, trace
from fe_drivetrain.report.suite import Page, Record, Run, check_in_time
from fe_drivetrain.turbine_loads.histories import campbell

MACHINE = library_machine("synthetic_2mw")
SPEEDS = (8.0, 18.0)  # rpm, in operation
RPM = np.pi / 30.0
BEGIN, END = 6.0, 28.0  # rpm, of the run-up
SECONDS, STEP = 20.0, 2.5e-4  # s
RATIO, AT = 0.01, 60.0  # of critical damping, at that frequency [Hz], in proportion to it elsewhere
ERROR = 10e-6  # m, of transmission, once in each mesh
MESH = "stage 1 sun-planet 1"
SEGMENT, CLASS = 0.5, 1.0  # s, rpm, of the short-time spectra
PEAK = "largest motion of the planet [µm]"
SHARE, LATE = "peak over that at rest", "later than the crossing by [Hz]"
DIAGRAM = (
    "Campbell diagram of the planet's motion in a run-up; lines: mesh of stage 1, and natural "
    "frequencies (dotted); circles: crossings"
)
HIGHEST = 90.0  # Hz, of what is drawn


@case(
    "Run-up of a drivetrain with six degrees of freedom: register, margins, Campbell diagram",
    source="PROTEST 2010, ECN-E--10-100, section 4.2, appendix A; Lewis 1932, Trans. ASME 54",
)
def run(run: Run, page: Page) -> None:
    """Register against modes; a run-up by the whole matrices, against exact modes."""
    page.about(MACHINE)
    system = with_proportional_damping(machine_system(MACHINE), RATIO / (np.pi * AT))
    modes = system_modes(system)
    with run.step("register"):
        found = register(page, system, modes)
    with run.step("run-up"):
        signal, exact, step, orders = simulated_run_up(system, modes, 0.5 if run.quick else 1.0)
    with run.step("convergence of the run-up"):
        series = converge_in_time(
            lambda h, _: peak_motion(system, 0.25 if run.quick else 1.0, h), STEP
        )
    page.section("Steps of the run-up")
    check_in_time(
        page,
        "run-up",
        series,
        {PEAK: 0.05},
        energy=2e-2,
        why="integrals over records, which do not resolve modes above a kilohertz",
    )
    error = float(np.abs(signal - exact).max() / np.abs(exact).max())
    fastest = 2.0 * np.pi * orders * END / 60.0 * step
    page.vanishes(
        "run-up: motion of the planet by the whole matrices and by exact modes, largest difference "
        "over the largest motion",
        error,
        within=0.25 * fastest**2,
        why="loads are straight between steps, which is (w h)^2 / 12 of a sine; three times that, "
        "as modes pass it at different times",
        source="sum of modes, each by Lewis' integral",
    )
    with run.step("Campbell"):
        shown(page, modes, signal, step)
    by_time = peaks(page, modes, orders)
    answer(page, found, [row for row in by_time if row["run-up [s]"] == SECONDS], series)
    page.assume(
        "damping ratio at 60 Hz, in proportion to frequency", RATIO, "", "none is published"
    )
    page.assume("error of transmission", ERROR * 1e6, "µm", "linear: all motions scale with it")


def answer(
    page: Page, found: list[Meeting], swept: list[Record], series: ConvergenceInTime
) -> None:
    """State how many resonances operation meets, and what a run-up makes of them."""
    met = sum(m.verdict == "resonance" for m in found)
    highest = max(float(row[SHARE]) for row in swept)
    page.answer(
        "Which resonances does the drivetrain pass in operation, and how far are they excited?",
        f"From {SPEEDS[0]:g} to {SPEEDS[1]:g}\u00a0rpm {met} excitations meet a mode; a run-up in "
        f"{SECONDS:g}\u00a0s excites the mesh's modes to {100 * highest:.0f}\u00a0% of their "
        "steady response at most.",
        [
            page.value(
                "crossings at a part with 1 % or more of the energy",
                met,
                beside=sum(m.margin == 0.0 for m in found),
                by="all crossings",
            ),
            *(
                page.value(
                    f"peak in the run-up over that at rest, mode of {row['mode [Hz]']:.3g} Hz",
                    float(row[SHARE]),
                )
                for row in swept
            ),
            page.value(
                "peak comes later than the crossing by [Hz]",
                max(float(row[LATE]) for row in swept),
            ),
            page.value(PEAK, series.value(PEAK), series.step_band(PEAK)),
        ],
        hero=DIAGRAM,
        cautions=[
            "Damping and the error of transmission are assumed: all motions scale with the latter."
        ],
    )


def register(page: Page, system: System, modes: SystemModes) -> list[Meeting]:
    """All excitations against all modes, with energy shares; crossings of `dynamics` the same."""
    excitations = drivetrain_excitations(MACHINE.stages)
    operation = (SPEEDS[0] * RPM, SPEEDS[1] * RPM)
    found = resonances(excitations, modes, operation)
    kinds = direction_kinds(system, modes)
    free = int(np.count_nonzero(modes.frequencies == 0.0))
    rows: list[Record] = [
        {
            "excitation": m.excitation,
            "mode": m.mode,
            "kind": kinds[free + m.mode - 1],
            "frequency [Hz]": m.frequency,
            "crossing [rpm]": m.crossing / RPM,
            "margin": m.margin,
            "energy share": m.share,
            "verdict": m.verdict,
        }
        for m in found
        if m.verdict in ("resonance", "near")
    ]
    orders = mesh_orders(MACHINE.stages)
    names = {f"{name} mesh {k}x" for name in orders for k in (1, 2, 3)}
    other = crossings(modes.frequencies[free:], orders, operation)
    ours = sorted(m.crossing for m in found if m.margin == 0.0 and m.excitation in names)
    page.holds(
        f"register and diagram of speeds have the same {len(other)} mesh crossings in operation",
        len(ours) == len(other),
        why="a crossing that the register leaves out would not be assessed",
        source="crossings of `dynamics`",
    )
    page.vanishes(
        "speeds of these crossings, largest difference [rpm]",
        float(np.abs(np.array(ours) - sorted(c.speed for c in other)).max()) / RPM,
        **round_off(10 * SPEEDS[1], "a frequency over the same order, in other units"),
        source="crossings of `dynamics`",
    )
    page.section("Register against modes")
    page.table(
        f"Excitations that meet or near a mode from {SPEEDS[0]:g} to {SPEEDS[1]:g} rpm", rows
    )
    counts: list[Record] = [
        {
            "kind of mode": kind,
            "modes": kinds[free:].count(kind),
            **{
                verdict: sum(
                    m.verdict == verdict and kinds[free + m.mode - 1] == kind for m in found
                )
                for verdict in ("resonance", "near", "clear", "not excited")
            },
        }
        for kind in dict.fromkeys(kinds[free:])
    ]
    page.table("Verdicts by kind of mode", counts)
    page.data("resonances", rows)
    return found


def simulated_run_up(
    system: System, modes: SystemModes, share: float
) -> tuple[Floats, Floats, float, float]:
    """Radial motion of a planet while the speed rises evenly, by matrices and by exact modes."""
    order = mesh_orders(MACHINE.stages)["stage 1"]
    sweep, loads = swept_load(system, share, STEP)
    time, push = loads.times, loads.patterns[:, 0]
    _, q, _ = exact_steps(equations_of(system), loads, SECONDS * share, STEP)
    place = system.place("stage 1 planet 1 uy")
    exact = np.zeros(len(time))
    for frequency, shape in zip(modes.frequencies, modes.shapes.T, strict=True):
        if frequency > 0.0:
            ratio = RATIO * frequency / AT
            each = shape[place] * float(shape @ push)
            if ratio < 1.0:
                exact += each * swept_response(float(frequency), ratio, sweep, time).real
            else:
                # far above the sweep, and overdamped: it follows
                exact += each * np.cos(sweep.phase(time)) / (2.0 * np.pi * frequency) ** 2
    return q[:, place], exact, STEP, order


def swept_load(system: System, share: float, step: float) -> tuple[Sweep, Loads]:
    """The sweep of the mesh, and its push at samples."""
    order = mesh_orders(MACHINE.stages)["stage 1"]
    seconds = SECONDS * share
    sweep = Sweep(order * BEGIN / 60.0, order * (END - BEGIN) / 60.0 / seconds)
    springs = [k for k, n in enumerate(system.spring_names) if n.startswith(f"{MESH} slice")]
    push = system.rows[springs].T @ system.stiffness[springs] * ERROR
    time = np.asarray(np.arange(round(seconds / step) + 1) * step, dtype=np.float64)
    return sweep, Loads(push[:, None], time, np.cos(sweep.phase(time))[:, None])


def peak_motion(system: System, share: float, step: float) -> InTime:
    """Largest motion of a planet in a run-up."""
    loads = swept_load(system, share, step)[1]
    equations = equations_of(system)
    time, q, velocity = exact_steps(equations, loads, SECONDS * share, step)
    motion = q[:, system.place("stage 1 planet 1 uy")]
    values = {PEAK: 1e6 * max(peak_between(motion), peak_between(-motion))}
    return InTime(values, energy_error(equations, loads, time, q, velocity))


def shown(page: Page, modes: SystemModes, signal: Floats, step: float) -> None:
    """Short-time spectra of the run-up by speed, with known modes and mesh orders drawn in."""
    speed = np.linspace(BEGIN, END, len(signal))
    edges = np.arange(BEGIN, END + CLASS, CLASS)
    found = campbell([(signal, speed * np.pi / 30.0, step)], edges * np.pi / 30.0, SEGMENT)
    kept = found.frequency <= HIGHEST
    level = np.log10(np.maximum(found.density[:, kept].T, 1e-12 * np.nanmax(found.density)))
    order = mesh_orders(MACHINE.stages)["stage 1"]
    middles = 0.5 * (edges[1:] + edges[:-1])
    drawn = modes.frequencies[(modes.frequencies > 0.0) & (modes.frequencies <= HIGHEST)]
    ends = np.array([BEGIN, END])
    page.section("Run-up")
    diagram = heat_map(
        DIAGRAM,
        middles,
        found.frequency[kept],
        level,
        ("rotor speed [rpm]", "frequency [Hz]", "log10 of density [m^2/Hz]"),
        yaxis={"range": [0.0, HIGHEST]},
    )
    white = {"color": "white", "width": 1}
    diagram.figure["data"] += [
        trace("stage 1 mesh 1x", ends, order * ends / 60.0, line=white, showlegend=False),
        *(
            trace(f"{f:.1f} Hz", ends, [f, f], line={**white, "dash": "dot"}, showlegend=False)
            for f in drawn
        ),
    ]
    crossed = 60.0 * drawn / order
    within = (crossed >= BEGIN) & (crossed <= END)
    diagram.figure["data"].append(
        trace(
            "crossings",
            crossed[within],
            drawn[within],
            True,
            marker={"color": "white", "size": 8, "symbol": "circle-open"},
            showlegend=False,
        )
    )
    page.add(diagram)
    there = found.segments > 0.0
    met = order * middles[there] / 60.0
    ridge = found.frequency[found.density[there][:, kept].argmax(axis=1)]
    page.at_most(
        "ridge of the diagram, largest distance from the mesh order or a natural frequency [Hz]",
        max(
            min(abs(r - m), float(np.abs(r - drawn).min())) for r, m in zip(ridge, met, strict=True)
        ),
        order * (0.5 * CLASS + 0.5 * SEGMENT * (END - BEGIN) / (len(signal) * step)) / 60.0
        + 2.0 / SEGMENT,
        why="half a class of 1 rpm, half the rise in a segment of 0.5 s, and two of its lines",
        source="excitation, or the decay of a mode that was passed",
        measure="frequency",
        basis="self-consistency",
    )
    page.text(
        f"The ridge follows the mesh order to within {float(np.abs(ridge - met).max()):.1f} Hz, "
        "and is brightest where it has just passed a mode that moves the planet."
    )


def peaks(page: Page, modes: SystemModes, order: float) -> list[Record]:
    """Peak of each mode in the run-up over that at rest, by the time that the run-up takes."""
    inside = [f for f in modes.frequencies if order * BEGIN / 60.0 < f < order * END / 60.0]
    rows: list[Record] = []
    for seconds in (5.0, 20.0, 100.0, 1000.0):
        sweep = Sweep(order * BEGIN / 60.0, order * (END - BEGIN) / 60.0 / seconds)
        for f in (inside[0], inside[-1]):
            peak = run_up_peak(float(f), RATIO * float(f) / AT, sweep)
            rows.append(
                {
                    "run-up [s]": seconds,
                    "mode [Hz]": float(f),
                    SHARE: peak.share,
                    LATE: peak.frequency - float(f),
                }
            )
    shares = [float(r[SHARE]) for r in rows]
    page.holds(
        "a slower run-up brings each mode nearer to its response at rest",
        all(a < b for a, b in zip(shares, shares[2:], strict=False)),
        why="there is more time in the resonance",
        source="Lewis 1932",
    )
    page.table("Peaks in run-ups of several durations", rows)
    page.data("peaks", rows)
    return rows
