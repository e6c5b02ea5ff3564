"""A study, its page and its files as the work of a case: compute, show, write."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Generic, TypeVar

from fe_drivetrain.command_line.option_names import result_with_options, sections_with_options

if TYPE_CHECKING:
    from fe_drivetrain.report.suite.page import Page
    from fe_drivetrain.report.suite.run import Run
    from fe_drivetrain.studies.result import Result

_R = TypeVar("_R", bound="Result")


class Shown(Generic[_R]):
    """The work of a case that makes a study, shows its result, and writes its files.

    Parameters
    ----------
    study : callable
        Makes the study; it takes whether it is quick, and whom to report to, from the run.
    show : callable
        Adds sections to a page that has answer, figures, checks and cautions of the result
        already; pictures go to the folder of the run.
    write : callable, optional
        Writes files to the folder of the run, and lists them in the last section.
    draws : bool
        Whether it shows pictures: then the process that draws starts before the study.

    Attributes
    ----------
    result : Result or None
        What was found, with options in place of arguments; None until it is.
    """

    def __init__(
        self,
        study: Callable[[Run], _R],
        show: Callable[[Run, Page, _R], None],
        write: Callable[[Run, Page, _R], None] | None = None,
        draws: bool = False,
    ) -> None:
        self._study, self._show, self._write, self._draws = study, show, write, draws
        self.result: _R | None = None

    def __call__(self, run: Run, page: Page) -> None:
        """Make the study, and fill the page."""
        if not self._draws:
            self._make(run, page)
            return
        from fe_drivetrain.report.pictures.drawing_process import drawing_ready

        with drawing_ready():
            self._make(run, page)

    def _make(self, run: Run, page: Page) -> None:
        result = self._study(run)
        run.take(result)
        self.result = result_with_options(result)
        page.take(self.result)
        self._show(run, page, result)
        page.sections = sections_with_options(page.sections)
        if self._write is not None:
            self._write(run, page, result)
