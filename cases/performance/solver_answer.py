"""The answer of solvers side by side: how far the choice of auto is from the fastest."""

from collections.abc import Sequence

from fe_drivetrain.report.suite import Page, Record

MANY = 12  # right-hand sides

#: Goals: choices within this of the best are as good, since from run to run times differ by that
#: much; and how much longer many right-hand sides take than one.
ALLOWED = 1.5
SHARED = 4.0

TIMES = f"Set-up and {MANY} right-hand sides; a symbol for each solid; bars: all runs"


def answer(page: Page, choices: Sequence[Record], shared: float) -> None:
    """State how far the choice of `auto` is from the fastest solver, at the worst.

    Parameters
    ----------
    page : Page
        Takes the answer.
    choices : sequence of dict
        Rows of the table of choices.
    shared : float
        Time of multigrid with many right-hand sides over that with one, the worst.
    """
    worst = max(choices, key=lambda row: float(row["times the best"]))
    ratio = float(worst["times the best"])
    good = sum(float(row["times the best"]) <= ALLOWED for row in choices)
    rule = (
        "always within run-to-run scatter"
        if good == len(choices)
        else f"{worst['best']} wins by {ratio:.2g} times on {worst['unknowns']} unknowns"
    )
    estimates = [check for check in page.checks if check.check == "at least"]
    page.answer(
        "Does auto choose the fastest solver, and does it stop when it should?",
        f"The solver that auto chooses is within {ALLOWED:g} times the fastest in {good} of "
        f"{len(choices)} cases; {rule}.",
        [
            page.value(
                "time of auto's choice over the best, worst", ratio, beside=ALLOWED, by="goal"
            ),
            page.value(
                f"choices within {ALLOWED:g} times the best", good, beside=len(choices), by="all"
            ),
            page.value(
                f"multigrid, {MANY} right-hand sides over one", shared, beside=SHARED, by="goal"
            ),
            page.judged(
                min(estimates, key=lambda check: check.computed).quantity,
                "estimated over true energy error, least",
                "direct solution",
            ),
        ],
        hero=TIMES,
        cautions=[f"Times of one solver differ by up to {ALLOWED:g} times from run to run."],
    )
