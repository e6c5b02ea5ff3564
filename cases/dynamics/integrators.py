"""Methods of time integration: printed tables, exact motion, and what they must conserve."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import (
    decades,
    round_off,
)
from fe_drivetrain.dynamics import (
    AVERAGE,
    LINEAR,
    Equations,
    Loads,
    Scheme,
    State,
    StepControl,
    equations_of_motion,
    exact_steps,
    fourier_wave,
    generalised_alpha,
    integrate,
    modal_superposition,
    spring_laws,
    steady,
    varying,
)
from fe_drivetrain.report import marked
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import Page, Record, Run

SCHEMES = (AVERAGE, LINEAR, generalised_alpha(0.8), generalised_alpha(0.0))

#: Chopra, Dynamics of structures, examples 5.3 and 5.4 (displacement at 0.1, 0.2 ... 1 s).
CHOPRA = {
    AVERAGE: (0.0437, 0.2326, 0.6121, 1.0825, 1.4309, 1.4230, 0.9622, 0.1908, -0.6043, -1.1441),
    LINEAR: (0.0300, 0.2193, 0.6166, 1.1130, 1.4782, 1.4625, 0.9514, 0.1273, -0.6954, -1.2208),
}
#: Bathe, Finite element procedures, section 9.2.4: both displacements by the trapezoidal rule.
BATHE = (
    (0.00673, 0.0505, 0.189, 0.485, 0.961, 1.58, 2.23, 2.76, 3.00, 2.85, 2.28, 1.40),
    (0.364, 1.35, 2.68, 4.00, 4.95, 5.34, 5.13, 4.48, 3.64, 2.90, 2.44, 2.31),
)
BY_STEP = "Largest error of four displacements after 2 s over the step"
WRONG = 0.01  # of the energy
DT = "step over the shortest period"


@case(
    "Time integration: printed examples, order, period, energy, angle of a varying stiffness",
    source="Chopra 2012, sections 5.3-5.4; Bathe 1996, section 9.2; Chung and Hulbert 1993; "
    "Park et al. 2021, Eq 29-34; Oh, Grosh and Barber 2005",
)
def run(run: Run, page: Page) -> None:
    """Printed tables, then what each method gains and loses."""
    with run.step("printed examples"):
        check_tables(page)
    with run.step("order"):
        slopes = check_order(run, page)
    with run.step("period and damping"):
        check_period(page)
    with run.step("stiffness by angle"):
        lost = check_angle(page)
    with run.step("step control"):
        check_control(run, page)
    answer(page, slopes, lost)


def answer(page: Page, slopes: list[float], lost: float) -> None:
    """State orders and printed tables, and the energy that a force left out brings."""
    printed = [check for check in page.checks if check.quantity.startswith(("Chopra", "Bathe"))]
    met = "and meet" if all(check.passed for check in printed) else "but do not meet"
    energy = page.value("spurious energy without the reaction torque on the angle [%]", 100 * lost)
    if lost > WRONG:
        energy = energy.model_copy(update={"status": "watch"})
    page.answer(
        "Are the methods of time integration accurate, and what does a varying stiffness need?",
        f"All methods are of order {min(slopes):.1f} {met} printed tables; a mesh stiffness over "
        f"the angle needs its reaction torque, or {value_text(energy.value, '%')} false energy "
        "appears.",
        [
            *(
                page.judged(f"{name}: error over the step, exponent", f"order, {name}", "theory")
                for name in (AVERAGE.name, generalised_alpha(0.8).name)
            ),
            *(
                page.judged(
                    f"Chopra, {scheme.name}: largest difference of ten displacements",
                    f"largest difference from Chopra, {scheme.name}",
                    "last digit printed",
                )
                for scheme in CHOPRA
            ),
            energy,
            page.judged(
                "energy error over the step with the force on the angle, ratio of halved steps",
                "with the reaction torque: energy error over that of half the step",
                "second order",
            ),
        ],
        BY_STEP,
        [
            "A mesh stiffness that follows the gears' angle does work on them as it changes: Park "
            "et al. leave out the reaction torque on the angle."
        ],
        claim="holds in part" if lost > WRONG else "holds",
    )
    page.say(
        "Average acceleration conserves the energy of a linear system to round-off; its period is "
        "too long by w dt / (2 atan(w dt / 2)).",
    )


def check_tables(page: Page) -> None:
    """Chopra's half-sine pulse on one mass, Bathe's two masses."""
    one = equations_of_motion([0.2533], spring_laws([[1.0]], 10.0, 0.1592))
    pulse = varying([1.0], np.arange(7) * 0.1, [0.0, 5.0, 8.6602, 10.0, 8.6603, 5.0, 0.0])
    rows: list[Record] = []
    for scheme, printed in CHOPRA.items():
        found = integrate(one, pulse, 1.0, 0.1, scheme).q[1:, 0]
        page.vanishes(
            f"Chopra, {scheme.name}: largest difference of ten displacements [in]",
            float(np.abs(found - printed).max()),
            within=1.01e-4,
            why="one unit of the last printed digit, which is of rounded steps",
            source="Chopra 2012, Tables E5.3 and E5.4",
            measure="deflection",
        )
        rows += [
            {"example": f"Chopra, {scheme.name}", "step": k + 1, "printed": p, "ours": float(u)}
            for k, (p, u) in enumerate(zip(printed, found, strict=True))
        ]
    springs = spring_laws([[1.0, 0.0], [1.0, -1.0], [0.0, 1.0]], [4.0, 2.0, 2.0])
    q = integrate(equations_of_motion([2.0, 1.0], springs), steady([0.0, 10.0]), 3.36, 0.28).q[1:]
    for k, column in enumerate(BATHE):
        page.vanishes(
            f"Bathe, trapezoidal rule, displacement {k + 1}: largest relative difference",
            float(np.abs(q[:, k] / column - 1.0).max()),
            within=5.1e-3,
            why="half a unit of the third digit, of numbers that begin with a 1",
            source="Bathe 1996, section 9.2.4",
        )
        rows += [
            {"example": f"Bathe, displacement {k + 1}", "step": i + 1, "printed": p, "ours": u}
            for i, (p, u) in enumerate(zip(column, q[:, k].tolist(), strict=True))
        ]
    page.section("Printed examples")
    page.table("Displacements, printed and ours", rows)


def frame() -> tuple[Equations, Loads]:
    """Four masses, six springs and dampers, gyroscopic terms, a load with kinks."""
    rng = np.random.default_rng(0)
    springs = spring_laws(
        rng.normal(size=(6, 4)), rng.uniform(1.0, 20.0, 6), rng.uniform(0.0, 0.1, 6)
    )
    turning = rng.normal(size=(4, 4))
    equations = equations_of_motion(rng.uniform(1.0, 2.0, 4), springs, turning - turning.T)
    return equations, varying(rng.normal(size=4), [0.0, 0.5, 1.0, 2.0], [0.0, 1.0, -1.0, 0.3])


def check_order(run: Run, page: Page) -> list[float]:
    """Error over the step against the exponential of the state matrix."""
    equations, loads = frame()
    exact = exact_steps(equations, loads, 2.0, 0.5)[1][-1]
    counts = np.unique(np.round(0.5 / decades(-4.5, -3.5, 4 if run.quick else 10)) * 4.0)
    rows: list[Record] = []
    slopes = []
    for scheme in SCHEMES:
        errors = [error_of(equations, loads, scheme, 2.0 / count, exact) for count in counts]
        slope = page.exponent(
            f"{scheme.name}: error over the step, exponent",
            2.0 / counts,
            errors,
            2.0,
            within=0.05,
            between=(1e-11, 1e-3),
            why="the next term, of the third order where a method damps, is a few percent here",
            source="Newmark 1959; Chung and Hulbert 1993",
        )
        slopes.append(slope)
        rows += [
            {"method": scheme.name, "step [s]": 2.0 / n, "error": e}
            for n, e in zip(counts, errors, strict=True)
        ]
    page.section("Error over the step")
    page.sweep(
        BY_STEP,
        rows,
        "step [s]",
        "error",
        by="method",
        log="xy",
        table=False,
    )
    motion = integrate(equations, loads, 2.0, 0.01)
    page.vanishes(
        "average acceleration: energy that appears from nowhere, over the largest",
        motion.relative_imbalance,
        within=1e-12,
        why="round-off of 200 steps",
        source="work of loads by the trapezoidal rule is kinetic and strain energy and losses",
    )
    modal = modal_superposition(
        equations_of_motion(equations.mass, spring_laws(equations.springs.rows, 1.0)),
        loads,
        2.0,
        0.5,
    )
    plain = equations_of_motion(equations.mass, spring_laws(equations.springs.rows, 1.0))
    page.vanishes(
        "modal superposition in four steps of 0.5 s: difference from the exponential",
        float(np.abs(modal.q - exact_steps(plain, loads, 2.0, 0.5)[1]).max()),
        within=1e-12,
        why="both are exact where loads have their kinks at steps",
        source="exponential of the whole state matrix",
    )
    return slopes


def error_of(equations: Equations, loads: Loads, scheme: Scheme, dt: float, exact: Floats) -> float:
    """Largest error of a displacement at the end."""
    return float(np.abs(integrate(equations, loads, 2.0, dt, scheme).q[-1] - exact).max())


def check_period(page: Page) -> None:
    """Period and damping of one mass over the step."""
    one = equations_of_motion([1.0], spring_laws([[1.0]], 1.0))
    start = State(np.ones(1), np.zeros(1), np.zeros(1))
    steps = np.array([0.05, 0.1, 0.2, 0.4, 0.8, 1.6, 3.2])
    traces, damping = [], []
    for scheme in SCHEMES:
        longer, ratio = [], []
        for dt in steps:
            # two steps' matrix of a linear recursion: its eigenvalue turns and shrinks the state
            z = growth(one, scheme, float(dt), start)
            longer.append(dt / abs(np.angle(z)) - 1.0)
            ratio.append(-np.log(abs(z)) / abs(np.angle(z)))
        traces.append(marked(scheme.name, steps / (2 * np.pi), longer))
        damping.append(marked(scheme.name, steps / (2 * np.pi), ratio))
        if scheme is AVERAGE:
            page.vanishes(
                "average acceleration: relative error of the printed formula of the period",
                float(
                    np.abs((1.0 + np.array(longer)) * 2 * np.arctan(steps / 2) / steps - 1).max()
                ),
                **round_off(
                    100 / steps.min(), "the angle that an eigenvalue close to 1 turns in a step"
                ),
                source="w dt / (2 atan(w dt / 2))",
            )
    page.section("Period and damping")
    page.chart("Period too long by", traces, DT, "relative", "x")
    page.chart("Damping ratio of the method itself", damping, DT, "damping ratio", "x")


def growth(one: Equations, scheme: Scheme, dt: float, start: State) -> complex:
    """Eigenvalue of the step of one mass that oscillates, from three displacements and rates."""
    motion = integrate(one, steady([0.0]), 40 * dt, dt, scheme, start)
    states = np.column_stack([motion.q[20:, 0], motion.velocity[20:, 0]])
    step = np.linalg.lstsq(states[:-1], states[1:], rcond=None)[0]
    values = np.linalg.eigvals(step)
    return complex(values[np.argmax(values.imag)])


def check_angle(page: Page) -> float:
    """A mesh stiffness by the angle of its gear, with and without the force on the angle."""
    lost = {}
    wave = fourier_wave([0.3], [0.1])
    springs = (
        spring_laws([[1, -1], [0, 1]], [1e3, 50.0])
        .in_phase(turns=[[2, 0], [0, 0]])
        .with_waves([wave], [0, -1])
    )
    equations = equations_of_motion([1.0, 2.0], springs)
    start = State(np.array([0.2, 0.0]), np.array([5.0, 0.0]), np.zeros(2))
    rows: list[Record] = []
    for dt in (1e-3, 5e-4, 2.5e-4):
        row: Record = {"step [s]": dt}
        for name, driven in (("with its force on the angle", True), ("without", False)):
            found = integrate(equations, steady([0.0, 0.0]), 1.0, dt, start=start, driven=driven)
            row[name] = lost[driven, dt] = found.relative_imbalance
        rows.append(row)
    page.equals(
        "energy error over the step with the force on the angle, ratio of halved steps",
        lost[True, 5e-4] / lost[True, 2.5e-4],
        4.0,
        within=0.1,
        why="the next order is a hundredth of the error here",
        source="second order",
        measure="order",
    )
    page.at_least(
        "energy error without that force, shortest step",
        lost[False, 2.5e-4],
        0.5 * lost[False, 1e-3],
        why="an error of the model does not fall with the step",
        source="Oh, Grosh and Barber 2005",
        measure="identity",
    )
    page.section("Stiffness that varies with an angle")
    page.table("Energy that appears from nowhere, over the largest", rows)
    page.text(
        "Park et al. 2021 let the mesh stiffness follow the gear's angle (their Table 1) but have "
        "no force of it on the angle, -1/2 k' delta^2, which is what a potential gives."
    )
    return lost[False, 2.5e-4]


def check_control(run: Run, page: Page) -> None:
    """Steps of a tolerance against equal ones."""
    equations, loads = frame()
    exact = exact_steps(equations, loads, 2.0, 0.5)[1][-1]
    rows: list[Record] = []
    for tolerance in (1e-3, 1e-4, 1e-5) if run.quick else (1e-3, 1e-4, 1e-5, 1e-6, 1e-7):
        found = integrate(equations, loads, 2.0, StepControl(0.01, tolerance))
        rows.append(
            {
                "tolerance of a step": tolerance,
                "steps": len(found.control.steps),
                "made again": found.control.rejected,
                "lengths": found.control.matrices,
                "largest estimate": float(found.control.errors.max()),
                "error at the end": float(np.abs(found.q[-1] - exact).max()),
            }
        )
    page.holds(
        "no accepted step has an estimate above its tolerance",
        all(row["largest estimate"] <= row["tolerance of a step"] for row in rows),
        why="a step that misses it is made again",
        source="definition",
    )
    page.section("Step control")
    page.table("Steps chosen by the estimate of Zienkiewicz and Xie 1991", rows)
