"""How short a time step has to be: steps in a mesh period, and where a method blows up."""

from collections.abc import Mapping

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats, Ints
from fe_drivetrain.comparison import decades, last_within
from fe_drivetrain.dynamics import (
    AVERAGE,
    LINEAR,
    Level,
    Meshing,
    Scheme,
    State,
    equations_of,
    equations_of_motion,
    generalised_alpha,
    integrate,
    library_machine,
    machine_system,
    spring_laws,
    steady,
    varying_equations,
    wind_up,
)
from fe_drivetrain.report import marked
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Run

FREQUENCY = 128.5  # Hz, of the third stage's mesh at 6 rpm
STEPS = "steps in a period of the mesh"
OVER = "step over the shortest period"
ENOUGH = 0.05
SLOPE = "average acceleration: error of a mesh force over the steps in its period, exponent"
STABLE = "linear acceleration: longest stable step over the period"
GROWN = "growth in a step of linear acceleration, longest step tried"
ERRORS = (
    "Largest error of the mesh force, of its swing, over the steps in a mesh period; shaded: "
    f"within {100 * ENOUGH:g} %"
)
#: 0.551 of the period: sqrt(3) / pi.
CRITICAL = float(np.sqrt(3.0) / np.pi)
DURATION, QUICK_DURATION = 0.5, 0.1


@case(
    "Time step: too long for a varying mesh, or unstable",
    source="Park et al. 2021, Table 2, as a torsional system; Bathe 1996, section 9.4",
)
def run(run: Run, page: Page) -> None:
    """Error of a mesh force over the step, and growth of linear acceleration."""
    with run.step("error of a mesh force"):
        enough = accuracy(page, QUICK_DURATION if run.quick else DURATION)
    with run.step("stability"):
        stability(page)
    answer(page, enough)
    page.say("Each harmonic of the stiffness that counts needs as many steps in its own period.")


def answer(page: Page, enough: float) -> None:
    """State how many steps a mesh period needs, and where linear acceleration is unstable."""
    stable = all(one.passed for one in page.checks if "largest growth" in one.quantity)
    page.answer(
        "How short must time steps be for a drivetrain with a varying gear mesh stiffness?",
        f"{enough:.0f} time steps per mesh period give the mesh force within "
        f"{100 * ENOUGH:g}\u00a0% of its peak-to-peak variation; the default method "
        + ("is stable" if stable else "is not stable")
        + " for every step tried.",
        [
            page.value(f"least time steps per mesh period for {100 * ENOUGH:g} %", enough),
            page.judged(SLOPE, "exponent of the number of steps in the error", "second order"),
            page.judged(
                STABLE, "linear acceleration: longest stable step over the shortest period", "Bathe"
            ),
            page.judged(GROWN, "linear acceleration: growth per step in the longest step tried"),
        ],
        hero=ERRORS,
        cautions=[
            "This is for one harmonic of the mesh stiffness; each further one needs as many steps "
            "in its own period.",
            "The linear acceleration method is unstable from steps of "
            f"{formatted(CRITICAL, 3)} times the shortest natural period of the drivetrain on.",
        ],
    )


def accuracy(page: Page, duration: float) -> float:
    """Mesh force of Park's drivetrain, one harmonic, against ever shorter steps."""
    machine = library_machine("park_2021")
    system = machine_system(machine, Level.TORSIONAL)
    turn = np.array([0.0, 0.0, 0.0, 1.0, 0.0, 0.0])
    load = 15e3 * system.load_on("rotor", turn)
    load += system.load_on("generator", -15e3 / machine.speeds[-1] * turn)
    equations = varying_equations(
        system, {"stage 3 mesh": Meshing(1.6, FREQUENCY)}, damping=2e-5, harmonics=1
    )
    begin = wind_up(equations_of(system), load)
    start = State(begin.q, np.zeros(len(load)), np.zeros(len(load)))
    mesh = system.spring_names.index("stage 3 mesh")

    def force(scheme: Scheme, count: int) -> Floats:
        dt = 1.0 / (FREQUENCY * count)
        periods = round(duration * FREQUENCY)
        motion = integrate(
            equations, steady(load), periods / FREQUENCY, dt, scheme, start, every=count // 4
        )
        return np.asarray(motion.forces[:, mesh])

    counts = np.array([4, 8, 16, 32, 64, 128, 256])
    # two steps extrapolated: of the fourth order
    exact = (4.0 * force(AVERAGE, 1024) - force(AVERAGE, 512)) / 3.0
    swing = float(np.ptp(exact))
    found = {}
    for scheme in (AVERAGE, generalised_alpha(0.8), generalised_alpha(0.0)):
        error = [np.abs(force(scheme, int(n)) - exact).max() / swing for n in counts]
        found[scheme.name] = np.array(error)
    return judge_accuracy(page, counts, found)


def judge_accuracy(page: Page, counts: Ints, found: Mapping[str, Floats]) -> float:
    """Check the order of the errors, show them; return the minimum number of steps."""
    page.exponent(
        SLOPE,
        counts,
        found[AVERAGE.name],
        -2.0,
        within=0.1,
        between=(1e-6, 1e-1),
        why="largest errors of beats have no steady phase",
        source="second order",
    )
    error = found[AVERAGE.name]
    least = last_within(counts[::-1], error[::-1], ENOUGH) or float(counts[-1])
    page.limit(
        "time integration of a varying mesh",
        STEPS,
        low=least,
        criterion=f"largest error of the mesh force below {100 * ENOUGH:g} % of its swing",
        beyond="the amplitude and the phase of the mesh's line are wrong; below two steps the mesh "
        "appears at another frequency",
        program="shows the energy that appears from nowhere (imbalance) of every run",
        remedy=f"{least:.0f} steps in the period of the highest harmonic that counts",
    )
    page.section("Steps in a period of the mesh")
    page.chart(
        ERRORS,
        [marked(name, counts, error) for name, error in found.items()],
        STEPS,
        "error",
        "xy",
        (least, None),
    )
    page.data("error", {"steps": counts, **found})
    return least


def stability(page: Page) -> None:
    """Growth in a step of one mass, over its period."""
    one = equations_of_motion([1.0], spring_laws([[1.0]], 1.0))
    steps = np.unique(np.concatenate([decades(-1, 0.5, 10), CRITICAL * np.array([0.98, 1.02])]))
    growth = {}
    for scheme in (AVERAGE, generalised_alpha(0.8), LINEAR):
        sizes = []
        for dt in 2.0 * np.pi * steps:
            start = State(np.ones(1), np.zeros(1), np.zeros(1))
            motion = integrate(one, steady([0.0]), 60 * dt, float(dt), scheme, start)
            size = np.hypot(motion.q[:, 0], motion.velocity[:, 0])
            sizes.append((size[30:].max() / size[:31].max()) ** (1.0 / 30.0))
        growth[scheme.name] = np.array(sizes)
    stable = growth[LINEAR.name] < 1.01
    last = float(steps[stable].max())
    page.between(
        STABLE,
        last,
        0.97 * CRITICAL,
        CRITICAL,
        why="steps of the sweep are 2 % from the bound on either side",
        source="sqrt(3) / pi: Bathe 1996, section 9.4.2",
    )
    for name in (AVERAGE.name, generalised_alpha(0.8).name):
        page.at_most(
            f"{name}: largest growth in a step",
            float(growth[name].max()),
            1.01,
            why="bounded motion passes through its largest value at different steps",
            source="unconditionally stable",
            measure="identity",
        )
    page.found(GROWN, float(growth[LINEAR.name].max()))
    page.limit(
        "linear acceleration",
        OVER,
        high=CRITICAL,
        criterion="bounded motion",
        beyond=f"motion grows by {growth[LINEAR.name].max():.1f} in each step of the longest tried",
        program="has average acceleration as its default",
        remedy="average acceleration or generalised alpha",
    )
    page.section("Stability")
    page.chart(
        "Growth of one mass in a step",
        [marked(name, steps, values) for name, values in growth.items()],
        OVER,
        "growth in a step",
        "xy",
        (None, CRITICAL),
    )
