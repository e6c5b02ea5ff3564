"""A study and its page as the work of a case: compute, then show."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from fe_drivetrain.report.suite.page import Page
    from fe_drivetrain.report.suite.run import Run
    from fe_drivetrain.studies.result import Result

    _R = TypeVar("_R", bound=Result)


def shown(
    study: Callable[[Run], _R], show: Callable[[Run, Page, _R], None]
) -> Callable[[Run, Page], None]:
    """The work of a case that makes a study and shows its result.

    Parameters
    ----------
    study : callable
        Makes the study; it takes whether it is quick, and whom to report to, from the run.
    show : callable
        Adds sections to a page that has answer, figures, checks and cautions of the result
        already; files go to the folder of the run.
    """

    def work(run: Run, page: Page) -> None:
        result = study(run)
        run.take(result)
        page.take(result)
        show(run, page, result)

    return work
