"""Teeth that part: where a mesh without backlash in the model pulls, and what parting does."""

from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp

from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats
from fe_drivetrain.common.arrays import rounded
from fe_drivetrain.comparison import InTime, converge_in_time, peak_between
from fe_drivetrain.dynamics import (
    Equations,
    Motion,
    State,
    equations_of_motion,
    fourier_wave,
    integrate,
    spring_laws,
    steady,
)
from fe_drivetrain.dynamics.bodies.steady_state import restoring
from fe_drivetrain.report import marked, trace
from fe_drivetrain.report.suite import Page, Run, check_in_time

#: Variation of the stiffness, damping ratio, half backlash over the static deflection.
VARIATION, RATIO, HALF = 0.2, 0.03, 2.0
STEPS, PERIODS, SETTLE = 96, 10, 70
LARGEST = "Largest force of the mesh over its frequency; shaded: teeth always in contact"
OVER = "mesh frequency over the natural frequency"
EXTRA = HALF + 1.0
"""Deflection under the mean load, of 1, from the middle of the backlash."""


@dataclass(frozen=True)
class Sweeps:
    """Minimum and maximum mesh force over its mean, over the mesh frequency.

    Attributes
    ----------
    at : (n,) array
        Mesh frequency over the natural one.
    up, down, linear : (n, 2) array
        With backlash, frequency rising and falling, and without backlash.
    lost : int
        Time steps without convergence.
    """

    at: Floats
    up: Floats
    down: Floats
    linear: Floats
    lost: int


@case(
    "Teeth that part: jumps of a mesh with backlash beside a linear one",
    source="x'' + 2 z x' + (1 + e cos W t) g(x) = 1, dead zone of two flanks: Kahraman and "
    "Blankenship 1997, J. Appl. Mech. 64, 217-226, in kind",
)
def run(run: Run, page: Page) -> None:
    """Sweep the mesh frequency up and down, with backlash and without."""
    at = np.linspace(0.55, 1.25, 15 if run.quick else 71)
    with run.step("sweeps"):
        found = sweeps(at)
    check_contact(page, found)
    with run.step("peer"):
        check_peer(page)
    check_steps(page)
    up, down, linear = found.up, found.down, found.linear
    pulls = linear[:, 0] < 0.0
    low, high = float(at[pulls].min()), float(at[pulls].max())
    parted = at[(np.minimum(up[:, 0], down[:, 0]) < 1e-6) | pulls]
    past = float(parted.min())
    safe = float(at[at > parted.max()].min())
    page.limit(
        "a mesh as a spring that pulls as it pushes",
        OVER,
        low=safe,
        criterion="force of the mesh above zero all the time, wherever the motion comes from",
        beyond=f"from {low:.2f} to {high:.2f} teeth part, and down to {past:.2f} they stay "
        f"parted if they were: the linear model pulls with up to "
        f"{-linear[:, 0].min():.2f} of the mean force, and its peak is {linear[:, 1].max():.2f}, "
        f"with backlash {max(up[:, 1].max(), down[:, 1].max()):.2f}",
        program="has a dead zone with both flanks (backlash), met by Newton's method in each step",
        remedy="give the backlash; start from both sides: motion may depend on where it comes from",
    )
    answer(page, found, (low, high, past, safe))
    page.say(
        f"The stiffness varies by {100 * VARIATION:.0f} %, with {100 * RATIO:.0f} % of critical "
        "damping. Parting softens the mesh: where sweeps up and down differ, the motion depends on "
        "its past.",
    )
    show(page, found, safe)


def answer(page: Page, found: Sweeps, at: tuple[float, float, float, float]) -> None:
    """State where teeth part (from, to, down to, and never from), and what a spring makes of it."""
    low, high, past, safe = at
    up, down, linear = found.up, found.down, found.linear
    parting = float(max(up[:, 1].max(), down[:, 1].max()))
    page.answer(
        "At which speeds do gear teeth separate, and what does a model without backlash miss?",
        f"Teeth separate from {low:.2f} (slowing down: {past:.2f}) to {high:.2f} times the natural "
        f"frequency; a model without backlash peaks at {linear[:, 1].max():.2f} instead of "
        f"{parting:.2f} mean forces.",
        [
            page.value(
                "mesh frequency over the natural one from which teeth separate, running up", low
            ),
            page.value(
                "mesh frequency over the natural one down to which they separate, slowing down",
                past,
            ),
            page.value(
                "mesh frequency over the natural one from which teeth stay in contact again", safe
            ),
            page.value("peak force over the mean, with backlash", rounded([parting], 3)[0]),
            page.value(
                "peak force over the mean, without backlash",
                rounded([linear[:, 1].max()], 3)[0],
                beside=rounded([parting], 3)[0],
                by="backlash",
            ),
            page.value(
                "largest tension over the mean force, without backlash", -linear[:, 0].min()
            ),
        ],
        hero=LARGEST,
        cautions=[
            "Near these frequencies two motions are possible: compute a run-up and a run-down.",
        ],
    )


def check_contact(page: Page, found: Sweeps) -> None:
    """Check that backlash changes nothing while teeth stay in contact, and pulls none."""
    least = np.minimum(found.up[:, 0], found.down[:, 0])
    page.vanishes(
        "frequencies at which teeth stay in contact: swings with and without backlash",
        float(np.abs(found.up - found.linear)[found.linear[:, 0] > 0.05].max(initial=0.0)),
        within=1e-4,
        why="the same law there; what is left of the start decays to 1e-4",
        source="linear where nothing parts",
    )
    page.holds(
        "with backlash no tooth is pulled",
        bool((least >= -1e-9).all()),
        why="flanks push and do not pull; the other flank is not reached here",
        source="contact",
    )
    page.vanishes(
        "time steps in which Newton's method did not converge",
        float(found.lost),
        within=0.0,
        why="the law has one slope on each side of a flank",
        source="piecewise linear",
    )


def sweeps(at: Floats) -> Sweeps:
    """Sweep the mesh frequency up and down, with backlash and without."""
    up, lost_up = sweep(at, HALF)
    down, lost_down = sweep(at[::-1], HALF)
    return Sweeps(at, up, down[::-1], sweep(at, 0.0)[0], lost_up + lost_down)


def show(page: Page, found: Sweeps, safe: float) -> None:
    """Show maximum and minimum force; the linear model is safe from the frequency `safe` on."""
    at, up, down, linear = found.at, found.up, found.down, found.linear
    page.section("Sweeps")
    for caption, y, k in (
        (LARGEST, "largest force over the mean", 1),
        ("Least force of the mesh: 0 where teeth part", "least force over the mean", 0),
    ):
        traces = [
            marked("with backlash, up", at, up[:, k]),
            marked("with backlash, down", at, down[:, k]),
            trace("spring that pulls", at, linear[:, k], line={"dash": "dot"}),
        ]
        page.chart(caption, traces, OVER, y, safe=(safe, None))
    page.data("sweep", {"frequency": at, "up": up, "down": down, "linear": linear})


def mesh(frequency: float, half: float) -> Equations:
    """One mesh of unit mass and mean stiffness, its frequency over its natural one."""
    springs = (
        spring_laws([[1.0]], 1.0, 0.0, lower=-half, upper=half)
        .in_phase(frequency=frequency / (2.0 * np.pi))
        .with_waves([fourier_wave([VARIATION], [0.0])])
    )
    return equations_of_motion([1.0], springs, [[2.0 * RATIO]])


def sweep(at: Floats, half: float) -> tuple[Floats, int]:
    """Least and largest force at each frequency, each begun where the one before ended."""
    start = State(np.array([half + 1.0]), np.zeros(1), np.zeros(1))
    found, lost = [], 0
    for frequency in at:
        period = 2.0 * np.pi / float(frequency)
        last: Motion | None = None
        for periods in (SETTLE, PERIODS):
            last = integrate(
                mesh(float(frequency), half),
                steady([1.0]),
                periods * period,
                period / STEPS,
                start=start,
            )
            # whole periods later: the same phase
            start = State(last.end.q, last.end.velocity, last.end.acceleration)
            lost += last.not_converged
        assert last is not None
        force = last.forces[:, 0]
        found.append((float(force.min()), float(force.max())))
    return np.array(found), lost


def check_steps(page: Page) -> None:
    """Energy, and forces of a mesh that parts and of one that does not, over the step."""

    def run(share: float, _: int) -> InTime:
        values, lost, met = {}, 0.0, True
        for name, half, frequency in (("parts", HALF, 0.95), ("in contact", HALF, 0.6)):
            period = 2.0 * np.pi / frequency
            start = State(np.array([half + 1.0]), np.zeros(1), np.zeros(1))
            motion = integrate(
                mesh(frequency, half),
                steady([1.0]),
                40 * period,
                share * period / STEPS,
                start=start,
            )
            late = motion.forces[motion.times > 30 * period, 0]
            values[f"{name}: largest force over the mean"] = peak_between(late)
            lost, met = max(lost, motion.relative_imbalance), met and motion.converged
        return InTime(values, lost, met)

    found = converge_in_time(run, 1.0)
    page.section("Over the step")
    check_in_time(
        page,
        "mesh",
        found,
        dict.fromkeys(found.finest.values, 0.05),
        energy=1e-2,
        why="clock and instants at which teeth part, by trapezia over the step",
        open_for=["parts: largest force over the mean"],
    )


def check_peer(page: Page) -> None:
    """An explicit method on a motion that parts."""
    one = mesh(0.95, HALF)
    duration = 12.0

    def rates(t: float, y: Floats) -> Floats:
        return np.array([y[1], 1.0 - restoring(one, t, y[:1], y[1:])[0][0]])

    begin = [EXTRA + 1.5, 0.0]
    exact = solve_ivp(rates, (0.0, duration), begin, "DOP853", rtol=1e-10, max_step=0.02).y[0, -1]
    start = State(np.array(begin[:1]), np.zeros(1), np.zeros(1))
    errors = []
    for dt in (0.01, 0.005):
        found = integrate(one, steady([1.0]), duration, dt, start=start)
        errors.append(abs(float(found.end.q[0]) - float(exact)))
    page.vanishes(
        "motion that parts, displacement after 12 s against an explicit method",
        errors[1],
        within=2e-4,
        why="steps of 0.005 s, of second order but for the instants at which teeth part",
        source="SciPy, DOP853",
    )
