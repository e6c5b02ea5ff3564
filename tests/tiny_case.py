"""A case that only counts to one, in this process and as a script; what commands make of it."""

from fe_drivetrain.report.results import Environment, Results, judge
from fe_drivetrain.suite.case import Run

Result = tuple[int, str, str]
"""Exit status, standard output and standard error of a command."""

# a script of a case, as under cases/, that counts to one or does what --set work says
SCRIPT = """
import sys, time
from fe_drivetrain.commands import main_of_case
from fe_drivetrain.report import Environment, Results, judge
from fe_drivetrain.suite import OldCase as Case

def run(run):
    with run.step("work"):
        (run.folder / "half.txt").write_text("half")
        if run.settings.get("work") == "forever":
            time.sleep(600)
    return Results(
        case="group/tiny", title="T\u00eft\u2082e", source="s", summary=["\u2208 one"],
        verdicts=[judge("one", 1.0, 1.0, tolerance=0.1, reason="r", source="s")], sections=[],
        environment=Environment(date="", python="", platform="", versions={}, settings={}),
    )

if __name__ == "__main__":
    main_of_case(Case("group/tiny", "Title", "s", run))
"""


def count(run: Run, computed: float = 1.01) -> Results:
    """Two checks, the first of which a computed value beyond 1.05 fails."""
    with run.step("count to one"):
        pass
    return Results(
        case="group/tiny",
        title="A tiny case",
        source="nobody",
        summary=["The answer is one.", "Second.", "Third.", "Fourth."],
        verdicts=[
            judge("one", computed, 1.0, tolerance=0.05, reason="r", source="s", unit="N m/rad"),
            judge("ratio", 2.0, 2.0, tolerance=0.0, reason="r", source="s", relative=False),
        ],
        sections=[],
        environment=Environment(
            date="", python="", platform="", versions={}, settings=dict(run.settings)
        ),
    )
