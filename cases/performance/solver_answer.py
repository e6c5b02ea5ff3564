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
        "that is the scatter between runs"
        if good == len(choices)
        else f"at worst {ratio:.2g} times, against {worst['best']}"
    )
    estimates = [check for check in page.checks if check.check == "at least"]
    page.answer(
        "Does the setting auto choose the fastest solver?",
        f"In {good} of {len(choices)} cases auto's choice takes at most {ALLOWED:g} times the time "
        f"of the fastest solver; {rule}.",
        [
            page.value(
                "time of auto's choice over that of the fastest, at worst",
                ratio,
                beside=ALLOWED,
                by="goal",
            ),
            page.value(
                f"choices within {ALLOWED:g} times the fastest", good, beside=len(choices), by="all"
            ),
            page.value(
                f"time of multigrid, {MANY} right-hand sides over one",
                shared,
                beside=SHARED,
                by="goal",
            ),
            page.judged(
                min(estimates, key=lambda check: check.computed).quantity,
                "estimated over true energy error at the stop, smallest",
                "direct solution",
            ),
        ],
        hero=TIMES,
        cautions=[f"Times of one solver differ by up to {ALLOWED:g} times from run to run."],
    )
