"""Resonance of bodies with six degrees of freedom: register, margins, a run-up and its Campbell."""

from dataclasses import dataclass, replace

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.procedure.swept_modes import Sweep, run_up_peak, swept_response
from fe_drivetrain.common import Floats, InputError
from fe_drivetrain.comparison import (
    ConvergenceInTime,
    InTime,
    converge_in_time,
    peak_between,
    round_off,
)
from fe_drivetrain.dynamics import (
    Loads,
    Machine,
    System,
    SystemModes,
    crossings,
    direction_kinds,
    energy_error,
    equations_of,
    exact_steps,
    machine_of,
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
from fe_drivetrain.report.suite import ChosenDrivetrain, Page, Record, Run, check_in_time
from fe_drivetrain.turbine_loads.histories import campbell

DEFAULT = "synthetic_2mw"
RPM = np.pi / 30.0
SECONDS = 20.0  # s
RATIO = 0.01  # of critical damping, in proportion to frequency
ERROR = 10e-6  # m, of transmission, once in each mesh
SEGMENT, CLASS = 0.5, 1.0  # s, rpm, of the short-time spectra
PEAK = "largest motion of the planet [µm]"
SHARE, LATE = "peak over that at rest", "later than the crossing by [Hz]"
DIAGRAM = (
    "Campbell diagram of the planet's motion in a run-up; lines: mesh of stage 1, and natural "
    "frequencies (dotted); circles: crossings"
)


@dataclass(frozen=True)
class Passed:
    """A drivetrain and its run-up.

    Attributes
    ----------
    machine : Machine
        The drivetrain.
    speeds : tuple of float
        Lowest and highest speed of the rotor in operation [rpm].
    begin, end : float
        Speeds of the rotor at either end of the run-up [rpm].
    step : float
        Step in time [s].
    at : float
        Frequency of the damping ratio `RATIO` [Hz].
    highest : float
        Largest frequency that is drawn [Hz].
    """

    machine: Machine
    speeds: tuple[float, float]
    begin: float
    end: float
    step: float
    at: float
    highest: float

    @property
    def order(self) -> float:
        """Mesh frequency of the first stage over the rotor's."""
        return float(mesh_orders(self.machine.stages)["stage 1"])

    @property
    def first(self) -> tuple[str, str]:
        """The mesh that is excited, and the motion that is watched."""
        if self.machine.stages[0].kind == "planetary":
            return "stage 1 sun-planet 1", "stage 1 planet 1 uy"
        return "stage 1 mesh", "stage 1 pinion uy"


def passed_by(chosen: ChosenDrivetrain) -> Passed:
    """The run-up of a drivetrain; that of a user's own in proportion to its speeds and meshes."""
    machine = machine_of(chosen.drivetrain)
    if not chosen.own:
        return Passed(machine, (8.0, 18.0), 6.0, 28.0, 2.5e-4, 60.0, 90.0)
    low, high = (speed / RPM for speed in chosen.rotor_speeds())
    ends = Passed(machine, (low, high), 0.75 * low, 1.5 * high, 0.0, 0.0, 0.0)
    largest = ends.order * ends.end / 60.0
    return replace(ends, step=1 / (200.0 * largest), at=0.9 * largest, highest=1.3 * largest)


@case(
    "Run-up of a drivetrain with six degrees of freedom: register, margins, Campbell diagram",
    source="PROTEST 2010, ECN-E--10-100, section 4.2, appendix A; Lewis 1932, Trans. ASME 54",
    settings={"drivetrain": "FILE, or a name of the library (otherwise synthetic_2mw)"},
)
def run(run: Run, page: Page) -> None:
    """Register against modes; a run-up by the whole matrices, against exact modes."""
    chosen = run.drivetrain(DEFAULT, gears=True)
    chosen.state(page)
    of = passed_by(chosen)
    system = with_proportional_damping(machine_system(of.machine), RATIO / (np.pi * of.at))
    modes = system_modes(system)
    with run.step("register"):
        found = register(page, of, system, modes)
    with run.step("run-up"):
        signal, exact, step = simulated_run_up(of, system, modes, 0.5 if run.quick else 1.0)
    with run.step("convergence of the run-up"):
        series = converge_in_time(
            lambda h, _: peak_motion(of, system, 0.25 if run.quick else 1.0, h), of.step
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
    fastest = 2.0 * np.pi * of.order * of.end / 60.0 * step
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
        shown(page, of, modes, signal, step)
    by_time = peaks(page, of, modes)
    answer(page, of, found, [row for row in by_time if row["run-up [s]"] == SECONDS], series)
    page.assume(
        f"damping ratio at {of.at:.4g} Hz, in proportion to frequency",
        RATIO,
        "",
        "none is published",
    )
    page.assume("error of transmission", ERROR * 1e6, "µm", "linear: all motions scale with it")


def answer(
    page: Page, of: Passed, found: list[Meeting], swept: list[Record], series: ConvergenceInTime
) -> None:
    """State how many resonances operation meets, and what a run-up makes of them."""
    met = sum(m.verdict == "resonance" for m in found)
    highest = max(float(row[SHARE]) for row in swept)
    page.answer(
        "Which resonances does the drivetrain pass in operation, and how far are they excited?",
        f"Between {of.speeds[0]:.3g} and {of.speeds[1]:.3g}\u00a0rpm the drivetrain passes {met} "
        f"resonances; in a run-up of {SECONDS:g}\u00a0s gear-mesh modes reach at most "
        f"{100 * highest:.0f}\u00a0% of their steady response.",
        [
            page.value(
                "resonances (excited part has 1 % or more of the energy)",
                met,
                beside=sum(m.margin == 0.0 for m in found),
                by="all crossings",
            ),
            *(
                page.value(
                    f"peak in the run-up over the steady response, mode of {row['mode [Hz]']:.3g} "
                    "Hz",
                    float(row[SHARE]),
                )
                for row in swept
            ),
            page.value(
                "delay of the peak behind the resonance [Hz]",
                max(float(row[LATE]) for row in swept),
            ),
            page.value(PEAK, series.value(PEAK), series.step_band(PEAK)),
        ],
        hero=DIAGRAM,
        cautions=[
            "Damping and the transmission error of the gears are assumed: all motions are "
            "proportional to the latter."
        ],
    )


def register(page: Page, of: Passed, system: System, modes: SystemModes) -> list[Meeting]:
    """All excitations against all modes, with energy shares; crossings of `dynamics` the same."""
    excitations = drivetrain_excitations(of.machine.stages)
    operation = (of.speeds[0] * RPM, of.speeds[1] * RPM)
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
    orders = mesh_orders(of.machine.stages)
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
        float(np.abs(np.array(ours) - sorted(c.speed for c in other)).max(initial=0.0)) / RPM,
        **round_off(10 * of.speeds[1], "a frequency over the same order, in other units"),
        source="crossings of `dynamics`",
    )
    page.section("Register against modes")
    page.table(
        f"Excitations that meet or near a mode from {of.speeds[0]:.3g} to {of.speeds[1]:.3g} rpm",
        rows,
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
    of: Passed, system: System, modes: SystemModes, share: float
) -> tuple[Floats, Floats, float]:
    """Radial motion of a planet while the speed rises evenly, by matrices and by exact modes."""
    sweep, loads = swept_load(of, system, share, of.step)
    time, push = loads.times, loads.patterns[:, 0]
    _, q, _ = exact_steps(equations_of(system), loads, SECONDS * share, of.step)
    place = system.place(of.first[1])
    exact = np.zeros(len(time))
    for frequency, shape in zip(modes.frequencies, modes.shapes.T, strict=True):
        if frequency > 0.0:
            ratio = RATIO * frequency / of.at
            each = shape[place] * float(shape @ push)
            if ratio < 1.0:
                exact += each * swept_response(float(frequency), ratio, sweep, time).real
            else:
                # far above the sweep, and overdamped: it follows
                exact += each * np.cos(sweep.phase(time)) / (2.0 * np.pi * frequency) ** 2
    return q[:, place], exact, of.step


def swept_load(of: Passed, system: System, share: float, step: float) -> tuple[Sweep, Loads]:
    """The sweep of the mesh, and its push at samples."""
    seconds = SECONDS * share
    sweep = sweep_of(of, seconds)
    mesh = of.first[0]
    springs = [
        k for k, n in enumerate(system.spring_names) if n == mesh or n.startswith(f"{mesh} slice")
    ]
    push = system.rows[springs].T @ system.stiffness[springs] * ERROR
    time = np.asarray(np.arange(round(seconds / step) + 1) * step, dtype=np.float64)
    return sweep, Loads(push[:, None], time, np.cos(sweep.phase(time))[:, None])


def sweep_of(of: Passed, seconds: float) -> Sweep:
    """The sweep of the mesh in a run-up that takes so long."""
    return Sweep(of.order * of.begin / 60.0, of.order * (of.end - of.begin) / 60.0 / seconds)


def peak_motion(of: Passed, system: System, share: float, step: float) -> InTime:
    """Largest motion of a planet in a run-up, once the start has died away in its first tenth."""
    loads = swept_load(of, system, share, step)[1]
    equations = equations_of(system)
    time, q, velocity = exact_steps(equations, loads, SECONDS * share, step)
    motion = q[:, system.place(of.first[1])]
    later = motion[len(motion) // 10 :]
    values = {PEAK: 1e6 * max(peak_between(later), peak_between(-later))}
    return InTime(values, energy_error(equations, loads, time, q, velocity))


def shown(page: Page, of: Passed, modes: SystemModes, signal: Floats, step: float) -> None:
    """Short-time spectra of the run-up by speed, with known modes and mesh orders drawn in."""
    begin, end, highest, order = of.begin, of.end, of.highest, of.order
    speed = np.linspace(begin, end, len(signal))
    edges = np.arange(begin, end + CLASS, CLASS)
    found = campbell([(signal, speed * np.pi / 30.0, step)], edges * np.pi / 30.0, SEGMENT)
    kept = found.frequency <= highest
    level = np.log10(np.maximum(found.density[:, kept].T, 1e-12 * np.nanmax(found.density)))
    middles = 0.5 * (edges[1:] + edges[:-1])
    drawn = modes.frequencies[(modes.frequencies > 0.0) & (modes.frequencies <= highest)]
    ends = np.array([begin, end])
    page.section("Run-up")
    diagram = heat_map(
        DIAGRAM,
        middles,
        found.frequency[kept],
        level,
        ("rotor speed [rpm]", "frequency [Hz]", "log10 of density [m^2/Hz]"),
        yaxis={"range": [0.0, highest]},
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
    within = (crossed >= begin) & (crossed <= end)
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
        order * (0.5 * CLASS + 0.5 * SEGMENT * (end - begin) / (len(signal) * step)) / 60.0
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


def peaks(page: Page, of: Passed, modes: SystemModes) -> list[Record]:
    """Peak of each mode in the run-up over that at rest, by the time that the run-up takes."""
    ends = of.order * of.begin / 60.0, of.order * of.end / 60.0
    inside = [f for f in modes.frequencies if ends[0] < f < ends[1]]
    if not inside:
        raise InputError(
            f"no mode of {of.machine.title!r} is between {ends[0]:.4g} and {ends[1]:.4g} Hz, which "
            "the mesh of stage 1 passes in the run-up: give another operation.rotor_speed"
        )
    rows: list[Record] = []
    for seconds in (5.0, 20.0, 100.0, 1000.0):
        sweep = sweep_of(of, seconds)
        for f in (inside[0], inside[-1]):
            peak = run_up_peak(float(f), RATIO * float(f) / of.at, sweep)
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
