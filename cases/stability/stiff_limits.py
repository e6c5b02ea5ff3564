"""Rigid bodies on ever stiffer bearings: the torsional model comes back, until digits run out."""

import numpy as np
from scipy import linalg

from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import decades, safe_range
from fe_drivetrain.dynamics import Level, System, library_machine, machine_system
from fe_drivetrain.report import marked
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Run

FACTOR = "stiffness of bearings, shafts in bending and pins, over the tabled one"
WITHIN = 1e-4
SLOPE, LEAST = (
    "{}: error over the stiffness, exponent",
    "{}: least error of all torsional frequencies",
)
BY_ROWS, BY_MATRIX = "singular values of rows", "eigenvalues of the matrix"
MACHINES = ("nrel_750kw", "park_2021")


@case(
    "Stiff limits: from rigid bodies in six degrees of freedom back to the torsional table",
    source="Al-Hamadani 2018, Table 4.2; Park et al. 2021, Table 2, by two models of this program",
)
def run(run: Run, page: Page) -> None:
    """Stiffen all but the torsional springs; compare the torsional frequencies."""
    factors = decades(0, 14, 1 if run.quick else 3)
    for name in MACHINES[:1] if run.quick else MACHINES:
        with run.step(name):
            sweep(page, name, factors)
    answer(page)
    page.say(
        "Errors fall as one over the stiffness, down to round-off of what is far below the "
        "stiffest springs. The eigenvalues of the stiffness matrix have only half of the digits "
        "that singular values of the springs' rows have."
    )


def answer(page: Page) -> None:
    """State how stiff bearings bring back the torsional table, for the first machine."""
    name = MACHINES[0]
    by_rows, by_matrix = page.limits[:2]
    low = formatted(by_rows.low or 1.0, 3, "")
    reach = (
        f"at least {low} times"
        if by_rows.high is None
        else f"{low} to {formatted(by_rows.high, 3, '')} times"
    )
    ends = {"least stiffening": by_rows.low, "largest stiffening, by eigenvalues": by_matrix.high}
    page.answer(
        "Do stiff bearings make a model in six degrees of freedom a torsional one?",
        f"Bearings stiffened {reach} give the torsional frequencies within "
        f"{formatted(100 * WITHIN, 2, '%')}\u00a0% by singular values; eigenvalues of the matrix "
        + (
            "give them, too."
            if by_matrix.high is None
            else f"lose them beyond {formatted(by_matrix.high, 3, '')} times."
        ),
        [
            *(
                page.value(f"{what}, over the published stiffness", end)
                for what, end in ends.items()
                if end is not None
            ),
            page.judged(
                LEAST.format(name),
                "largest error of a torsional frequency, best stiffening",
                "program",
            ),
            page.judged(SLOPE.format(name), "exponent of the stiffness in the error", "theory"),
        ],
        hero=caption_of_errors(name),
        cautions=[
            "Rather fix or leave out degrees of freedom than stiffen bearings: beyond the limit "
            "frequencies are nothing but round-off."
        ],
    )


def caption_of_errors(name: str) -> str:
    """Caption of the chart of one machine."""
    return (
        "Largest error of a torsional frequency over the stiffening, "
        f"{library_machine(name).title}; shaded: safe by singular values"
    )


def sweep(page: Page, name: str, factors: Floats) -> None:
    """One machine, by two ways to its frequencies."""
    machine = library_machine(name)
    exact = frequencies(machine_system(machine, Level.TORSIONAL), 1.0, BY_ROWS)
    exact = exact[exact > 1e-6 * exact[-1]]
    system = machine_system(machine, Level.RIGID)
    errors = {
        way: np.array([max_error(system, float(f), way, exact) for f in factors])
        for way in (BY_ROWS, BY_MATRIX)
    }
    error = errors[BY_ROWS]
    best = int(error.argmin())
    # before, the nearest frequency may be that of another motion; behind, round-off
    far = slice(*np.searchsorted(factors, [9e4, 2e9]).tolist())
    page.exponent(
        SLOPE.format(name),
        factors[far],
        error[far],
        -1.0,
        within=0.1,
        between=(1e-8, 1e-3),
        why="the next order is a thousandth of the largest error that is taken",
        source="springs in series",
    )
    page.at_most(
        LEAST.format(name),
        float(error[best]),
        1e-8,
        why="compliance of the stiff springs and round-off meet there",
        source="torsional model",
        measure="frequency",
    )
    for way, found in errors.items():
        low, high = safe_range(factors, found, WITHIN)
        page.limit(
            f"stiff springs in place of held degrees of freedom: {name}, {way}",
            FACTOR,
            low=low,
            high=high,
            criterion=f"all torsional frequencies within {WITHIN:g}",
            beyond="below: bodies give way, which is the tabled machine; above: round-off of the "
            "stiffest springs is as large as the softest",
            program="leaves out degrees of freedom at the torsional level",
            remedy="hold or leave out degrees of freedom instead of stiffening them",
        )
    page.section(machine.title)
    page.chart(
        caption_of_errors(name),
        [marked(way, factors, np.maximum(found, 1e-17)) for way, found in errors.items()],
        FACTOR,
        "relative error",
        "xy",
        safe_range(factors, error, WITHIN),
    )
    page.data(name, {"factor": factors, **errors})


def max_error(system: System, factor: float, way: str, exact: Floats) -> float:
    """Largest error of the nearest frequency to each; other modes go up and away."""
    found = frequencies(system, factor, way)
    nearest = np.array([found[np.abs(found / f - 1.0).argmin()] for f in exact])
    return float(np.abs(nearest / exact - 1.0).max())


def frequencies(system: System, factor: float, way: str) -> Floats:
    """Natural frequencies [Hz] with all springs but those of torsion stiffer by a factor."""
    turns = np.array([name.endswith(" rx") for name in system.names])
    winds = np.abs(system.rows[:, turns]).max(axis=1, initial=0.0) > 0.0
    across = np.abs(system.rows[:, ~turns]).max(axis=1, initial=0.0) > 0.0
    mesh = np.array(
        ["mesh" in n or ("planet" in n and "pin" not in n) for n in system.spring_names]
    )
    torsional = winds & (~across | mesh)
    stiffness = system.stiffness * np.where(torsional, 1.0, factor)
    half = np.linalg.cholesky(system.mass)
    wound = linalg.solve_triangular(half, (np.sqrt(stiffness)[:, None] * system.rows).T, lower=True)
    if way == BY_ROWS:
        values = np.linalg.svd(wound, compute_uv=False)[::-1]
        return np.asarray(values / (2.0 * np.pi))
    return np.asarray(np.sqrt(np.abs(np.linalg.eigvalsh(wound @ wound.T))) / (2.0 * np.pi))
