"""A case that only counts to one, in this process and as a script; what commands make of it."""

from typing import Any

from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.run import Run

Result = tuple[int, str, str]
"""Exit status, standard output and standard error of a command."""

# a user's own script of a case, that counts to one or does what --set work says
SCRIPT = """
import time
from fe_drivetrain.command_line import main_of_case
from fe_drivetrain.report.suite import Case

def work(run, page):
    with run.step("work"):
        (run.folder / "half.txt").write_text("half")
        if run.settings.get("work") == "forever":
            time.sleep(600)
    page.equals("one", 1.0, 1.0, within=0.1, why="r", source="s")
    page.answer("Is it one?", "\u2208 one.", [page.judged("one")])

if __name__ == "__main__":
    main_of_case(Case("group/tiny", "T\u00eft\u2082e", "s", work, settings=("work",)))
"""


def check_one(page: Page, computed: float = 1.01, within: float = 0.05, **more: Any) -> None:
    """One check, that the computed value is one; `more` is unit, measure, band."""
    page.equals("one", computed, 1.0, within=within, why="r", source="s", **more)
    if page.answered is None:
        page.answer("Is it one?", "The answer is one.", [page.judged("one")])


def count(run: Run, page: Page, computed: float = 1.01) -> None:
    """Two checks, the first of which a computed value beyond 1.05 fails."""
    with run.step("count to one"):
        pass
    page.say("Second.", "Third.", "Fourth.")
    check_one(page, computed, unit="N m/rad")
    page.equals("ratio", 2.0, 2.0, within=0.0, why="r", source="s", relative=False)
