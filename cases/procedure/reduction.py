"""Which level a drivetrain needs, and which degrees of freedom matter: three propositions, run."""

import time
from collections.abc import Callable

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.machine_rungs import more_rungs
from fe_drivetrain.common import Floats
from fe_drivetrain.dynamics import (
    RUNGS,
    Level,
    Machine,
    System,
    machine_of,
    machine_system,
    with_proportional_damping,
)
from fe_drivetrain.procedure import (
    Dip,
    Influence,
    Trial,
    frequency_that_holds,
    influences,
    locked_basis,
    mode_error,
    one_after_another,
    spring_groups,
    threshold_share,
    torque_signal,
)
from fe_drivetrain.report import trace
from fe_drivetrain.report.suite import Page, Record, Run

MACHINE, TORQUE = "nrel_5mw", 3.946e6  # N m
DEPTH, LENGTH, STEP = 1.0, 0.15, 4e-3  # of the torque, s, s
SECONDS = {True: 1.6, False: 6.0}  # quick or not
DAMPING = 1e-4  # s, damping over stiffness: 0.06 % of critical at 2 Hz
TOLERANCE = 0.02
BY_LEVEL = "Error of the torque's peak against the time that a level takes; star: enough"
WHOLE = "Error of the torque over the whole dip, root mean square"
SHARE = 0.999  # of the signal's power
THRESHOLDS = tuple(10.0**exponent for exponent in np.arange(-6.0, 0.1, 0.5))


@case(
    "Reduction of a drivetrain: levels, thresholds on modes and signals, one after another",
    source="PROTEST 2010, ECN-E--10-100, section 4.3; Nejad et al. 2016 for the 5 MW gearbox",
    settings={"drivetrain": "FILE, or a name of the library (otherwise nrel_5mw)"},
)
def run(run: Run, page: Page) -> None:
    """A generator's torque dips by its whole size; what of the model does the main shaft need?"""
    chosen = run.drivetrain(MACHINE)
    chosen.state(page)
    machine = machine_of(chosen.drivetrain)
    torque = chosen.rated_torque() if chosen.own else TORQUE
    level = levels(run, page, chosen.name, machine, torque)
    system = damped(machine_system(machine, Level.RIGID))
    signal = dip_torque(machine, torque, system, SECONDS[run.quick])
    with run.step("spectrum"):
        full = signal(locked_basis(system, ()))
        needed = frequency_that_holds(full, STEP, SHARE)
        highest = 3.0 * needed
    page.section("By the spectrum of the signal")
    page.text(
        f"{100 * SHARE:g} % of the power of the main shaft's torque in a dip is below {needed:.1f} "
        f"Hz. Modes up to three times that, {highest:.1f} Hz, are kept in view."
    )
    groups = {
        name: springs
        for name, springs in spring_groups(system).items()
        if name != f"{machine.shafts[0].name} torsion"
    }
    with run.step("modes"):
        found = influences(system, groups, highest)
    thresholds(page, system, found, highest)
    with run.step("one after another"):
        trials = one_after_another(system, found, signal, TOLERANCE)
    after_another(page, found, trials)
    answer(page, level, found, trials)


def answer(page: Page, level: Record, found: list[Influence], trials: list[Trial]) -> None:
    """State the level that is enough, and how many degrees of freedom of it."""
    last = [trial for trial in trials if trial.stays][-1]
    locked = len(found) - sum(not trial.stays for trial in trials)
    page.answer(
        "Which gearbox model is enough for the main shaft's torque in a voltage dip?",
        f"A gearbox model of {level['level']} gives the peak torque within "
        f"{100 * TOLERANCE:g}\u00a0%; {last.degrees} of its {trials[0].degrees} degrees of "
        "freedom are enough.",
        [
            page.value(
                f"error of the peak torque, {level['level']} [%]",
                float(level["error of its peak [%]"]),
                at_most=100.0 * TOLERANCE,
            ),
            page.value(
                "degrees of freedom that are enough",
                last.degrees,
                beside=trials[0].degrees,
                by="rigid bodies",
            ),
            page.value(
                "error of the torque with these alone [%]",
                100.0 * last.signal_error,
                at_most=100.0 * TOLERANCE,
            ),
            page.value("groups of springs that may be rigid", locked, beside=len(found), by="all"),
            page.value("time of a run with these alone [s]", last.seconds),
        ],
        hero=BY_LEVEL,
        cautions=[
            f"Over the whole dip {level['level']} err by "
            f"{float(level['error of the torque [%]']):.2g} % in root mean square.",
            "Errors are those against the finest level of the ladder, not against a measurement.",
            "Damping is assumed: the table of the machine has none.",
        ],
    )


def damped(system: System) -> System:
    """With dampers in proportion to all springs."""
    return with_proportional_damping(system, DAMPING)


def dip_torque(
    machine: Machine, torque: float, system: System, seconds: float
) -> Callable[[Floats], Floats]:
    """Torque of the main shaft while the generator's dips, less that before."""
    history = 1.0 - Dip(0.2, DEPTH, LENGTH).shares(np.arange(0.0, seconds, STEP))
    turn = np.zeros(6)
    turn[3] = torque / machine.speeds[-1]
    load = system.load_on("generator", turn)
    return torque_signal(system, load, history, STEP, machine.shafts[0].name, front="rotor")


def levels(run: Run, page: Page, name: str, machine: Machine, torque: float) -> Record:
    """The same signal on each level of the ladder; the first that has its peak."""
    signals: dict[str, Floats] = {}
    rows: list[Record] = []
    for rung in [*RUNGS, *more_rungs(run, name)]:
        with run.step(rung.name):
            start = time.perf_counter()
            system = damped(machine_system(machine, rung.level, flexible=rung.flexible))
            basis = locked_basis(system, ())
            signals[rung.name] = dip_torque(machine, torque, system, SECONDS[run.quick])(basis)
            seconds = time.perf_counter() - start
        rows.append({"level": rung.name, "degrees of freedom": basis.shape[1], "time [s]": seconds})
    finest = list(signals.values())[-1]
    for row, samples in zip(rows, signals.values(), strict=True):
        size = np.linalg.norm(finest - finest.mean())
        row["error of the torque [%]"] = 100.0 * float(np.linalg.norm(samples - finest) / size)
        peaks = float(np.abs(samples).max() / np.abs(finest).max())
        row["error of its peak [%]"] = 100.0 * abs(peaks - 1.0)
    page.section("Levels of the ladder")
    page.table("Torque of the main shaft in a dip, against the finest level", rows)
    enough = next(row for row in rows if row["error of its peak [%]"] <= 100.0 * TOLERANCE)
    ends = [row["time [s]"] for row in rows[:-1]]
    for caption, error in ((BY_LEVEL, "error of its peak [%]"), (WHOLE, "error of the torque [%]")):
        points = [
            trace(
                f"{row['level']} (chosen)" if row is enough else row["level"],
                [row["time [s]"]],
                [row[error]],
                mode="markers",
                marker={"size": 15, "symbol": "star"} if row is enough else {"size": 9},
            )
            for row in rows[:-1]
        ]
        if caption == BY_LEVEL:
            bound = [100.0 * TOLERANCE] * 2
            points.append(trace("allowed", [min(ends), max(ends)], bound, line={"dash": "dot"}))
        page.chart(caption, points, "time [s]", error, ("x", "y"))
    times = np.arange(0.0, SECONDS[run.quick], STEP)
    shown = slice(0, round(2.0 / STEP))
    page.chart(
        "Torque of the main shaft, less that before the dip",
        [trace(name, times[shown], 1e-6 * samples[shown]) for name, samples in signals.items()],
        "time [s]",
        "torque [MN m]",
    )
    page.data("levels", rows)
    return enough


def thresholds(page: Page, system: System, found: list[Influence], highest: float) -> None:
    """Share of energy against the error of locking; all below a threshold locked together."""
    errors = []
    for threshold in THRESHOLDS:
        springs = [k for one in found if one.error < threshold for k in one.springs]
        errors.append(mode_error(system, springs, highest))
    known = [error for error in errors if np.isfinite(error)]
    page.at_least(
        "growth of the error of the frequencies as more springs are locked, least",
        float(np.diff(known).min()),
        -1e-9,
        why="a constraint lowers no natural frequency, but for what the eigenvalues are rounded by",
        source="Courant's principle",
        measure="identity",
    )
    alone = [one for one in found if one.error > 1e-12 and one.share < 1.0]
    shares = [one.share for one in alone]
    page.section("By a threshold on the modes")
    page.chart(
        f"Groups locked alone, modes up to {highest:.1f} Hz; line: two springs in series",
        [
            trace("groups", shares, [100 * o.error for o in alone], mode="markers"),
            trace(
                "1/sqrt(1 - s) - 1",
                [threshold_share(e) for e in THRESHOLDS],
                [100.0 * e for e in THRESHOLDS],
            ),
        ],
        "largest share of the strain energy of a mode",
        "largest error of a frequency [%]",
        ("x", "y"),
    )
    rows: list[Record] = [
        {
            "threshold: error of a group alone [%]": 100.0 * threshold,
            "groups locked": sum(one.error < threshold for one in found),
            "error of the frequencies [%]": 100.0 * error if np.isfinite(error) else None,
        }
        for threshold, error in zip(THRESHOLDS, errors, strict=True)
    ]
    page.table("All groups below a threshold locked together; no error where modes are gone", rows)
    page.data("thresholds", rows)
    page.text(
        "A group matters by how much locking it alone raises a frequency. Its share of the energy "
        "tells that of springs in series, on the line. Groups above it are soft springs beside "
        "stiff ones: they have no energy, and yet locking them holds what the others let move, so "
        "that a threshold on shares alone would lock what matters."
    )
    enough = [t for t, error in zip(THRESHOLDS, errors, strict=True) if error <= TOLERANCE]
    if enough:
        locked = sum(one.error < enough[-1] for one in found)
        page.text(
            f"Groups that raise no frequency up to {highest:.1f} Hz by {100 * enough[-1]:.2g} % or "
            f"more alone, {locked} of {len(found)}, can all be locked within "
            f"{100 * TOLERANCE:g} % of each frequency."
        )


def after_another(page: Page, found: list[Influence], trials: list[Trial]) -> None:
    """Groups locked one after another; those that change the signal are let go again."""
    alone = {one.group: one.error for one in found}
    rows: list[Record] = [
        {
            "locked": trial.group or "nothing",
            "error of a frequency, locked alone [%]": 100.0 * alone.get(trial.group, 0.0),
            "stays locked": "yes" if trial.stays else "no",
            "degrees of freedom": trial.degrees,
            "error of the torque [%]": 100.0 * trial.signal_error,
            "time [s]": trial.seconds,
        }
        for trial in trials
    ]
    page.section("One after another")
    page.table(f"A group stays locked if the torque changes by {100 * TOLERANCE:g} % or less", rows)
    page.chart(
        "Error of the torque against the time of a run",
        [
            trace(
                name,
                [row["time [s]"] for row in rows[1:] if row["stays locked"] == word],
                [
                    max(row["error of the torque [%]"], 1e-9)
                    for row in rows[1:]
                    if row["stays locked"] == word
                ],
                mode="markers",
            )
            for name, word in (("stays locked", "yes"), ("is let go again", "no"))
        ],
        "time [s]",
        "root mean square error [%]",
        ("y",),
    )
    page.data("one_after_another", rows)
    last = [trial for trial in trials if trial.stays][-1]
    page.at_most(
        "error of the torque of the model that is left",
        last.signal_error,
        TOLERANCE,
        why="the tolerance of the proposition",
        source="PROTEST 2010, section 4.3, proposition 3",
        basis="self-consistency",
    )
    freed = [trial.group for trial in trials if not trial.stays]
    page.say(f"What must move: {', '.join(freed) or 'nothing'}.")
    page.assume("damping over stiffness", DAMPING, "s", "the table has none")
