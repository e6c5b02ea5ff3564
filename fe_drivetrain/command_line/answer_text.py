"""Answers on the terminal: the verdict, key figures with their limits, cautions, and the page.

On a terminal figures are coloured by how they stand to their limits, and lines fold at its width;
in a pipe nothing is coloured, and each sentence is one line.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any, cast

from fe_drivetrain.command_line.output_options import open_if_asked, wants_json
from fe_drivetrain.command_line.terminal import FAILED, PASSED, Stream, write
from fe_drivetrain.common.typeset import MINUS, THIN_SPACE

if TYPE_CHECKING:
    from rich.console import Console, RenderableType
    from rich.table import Table

    from fe_drivetrain.report.answer import Answer, KeyFigure
    from fe_drivetrain.report.results import Problem, Results, Verdict
    from fe_drivetrain.studies.result import Result

_DETAILS = 3  # sentences of results without an answer
_UNFOLDED = 10_000  # columns of a pipe
_COLOURS = {"good": "green", "watch": "yellow", "bad": "red", "none": ""}
_TYPED = str.maketrans({MINUS: "-", THIN_SPACE: ",", "\u00a0": " "})


def show_outcome(
    results: Results, page: Path, result: Result | None = None, more: Sequence[str] = ()
) -> int:
    """Print the answer of a case or study, as its options ask; its exit status.

    Parameters
    ----------
    results : Results
        What was found, with its checks.
    page : Path
        Its page.
    result : Result or None
        The result of a study, whose JSON may be asked for; None of a case, which has its answer.
    more : sequence of str
        Lines before that of the page.

    Returns
    -------
    int
    """
    if wants_json():
        answer = None if results.answer is None else results.answer.model_dump(mode="json")
        write_json(answer if result is None else result.to_dict())
    else:
        write(sys.stdout, outcome_text(results, page, more))
    open_if_asked(page)
    return PASSED if results.passed else FAILED


def write_json(content: Any) -> None:
    """Write data as JSON to standard output: records, numbers, words and lists of these."""
    from fe_drivetrain.report.suite.records import strict_json

    plain = strict_json(content)
    write(sys.stdout, json.dumps(plain, ensure_ascii=False, indent=1, allow_nan=False) + "\n")


def outcome_text(results: Results, page: Path, more: Sequence[str] = ()) -> str:
    """Answer of one case or study, its failing checks, and where its page is.

    Parameters
    ----------
    results : Results
        What was found.
    page : Path
        Its page.
    more : sequence of str
        Lines before that of the page.

    Returns
    -------
    str
    """
    from fe_drivetrain.report.results import cautions_of, verdict_sentence

    parts: list[RenderableType]
    if results.answer is None:
        notes = cautions_of(results)
        parts = [*notes, *([""] if notes else []), *results.details[:_DETAILS]]
    else:
        verdict = verdict_sentence(results)
        parts = [*_answer_parts(results.answer, verdict, results.passed, cautions_of(results))]
    parts += ["", *_check_lines(results.verdicts), *more]
    return rendered(*parts, f"Report: {page}")


def answer_text(answer: Answer, notes: Sequence[str] = ()) -> str:
    """An answer that has no checks and no page beside it.

    Parameters
    ----------
    answer : Answer
        What was found.
    notes : sequence of str
        Cautions after its own.

    Returns
    -------
    str
    """
    cautions = [*answer.cautions, *notes]
    return rendered(*_answer_parts(answer, answer.verdict, True, cautions))


def _answer_parts(
    answer: Answer, verdict: str, passed: bool, cautions: Sequence[str]
) -> Iterator[RenderableType]:
    """Verdict, key figures and cautions."""
    from rich.text import Text

    from fe_drivetrain.report.answer import MAX_CAUTIONS

    colour = _COLOURS[answer.status] if passed else _COLOURS["bad"]
    yield Text(verdict.translate(_TYPED), style=f"bold {colour}".strip())
    yield ""
    yield figures_table(answer.figures)
    if cautions:
        yield ""
    for caution in cautions[:MAX_CAUTIONS]:
        yield Text(f"Caution: {caution}".translate(_TYPED), style="yellow")
    if len(cautions) > MAX_CAUTIONS:
        more = len(cautions) - MAX_CAUTIONS
        yield f"{more} more caution{'s are' if more > 1 else ' is'} on the page."


def figures_table(figures: Sequence[KeyFigure]) -> RenderableType:
    """Name, value with band, limit and status of each key figure.

    Parameters
    ----------
    figures : sequence of KeyFigure
        Those of an answer.

    Returns
    -------
    RenderableType
    """
    from rich.text import Text

    from fe_drivetrain.report.number_text import limit_text, standing_words, value_with_band

    table = _table()
    for figure in figures:
        cells = (figure.name, value_with_band(figure), limit_text(figure), standing_words(figure))
        name, value, limit, status = (cell.translate(_TYPED) for cell in cells)
        style = _COLOURS[figure.status]
        table.add_row(name, Text(value, style=f"bold {style}".strip()), limit, Text(status, style))
    return table


def _table() -> Table:
    """A table without lines, two spaces between its columns."""
    from rich.table import Table

    return Table.grid(padding=(0, 2, 0, 0))


def rendered(*parts: RenderableType) -> str:
    """Text of lines and tables, folded and coloured as standard output takes them.

    Parameters
    ----------
    *parts : RenderableType
        What rich prints; a str is a line that is never folded, and has no markup.

    Returns
    -------
    str
    """
    console = _console()
    with console.capture() as captured:
        for part in parts:
            plain = isinstance(part, str)
            console.print(part, markup=False, soft_wrap=plain or not console.is_terminal)
    return "".join(f"{line.rstrip()}\n" for line in captured.get().splitlines())


def _console() -> Console:
    from rich.console import Console

    console = Console(file=cast(IO[str], Stream(sys.stdout)), highlight=False)
    if not console.is_terminal:
        console.width = _UNFOLDED
    return console


def _check_lines(verdicts: Sequence[Verdict]) -> list[str]:
    """How many checks pass, and those that fail."""
    if not verdicts:
        return []
    failing = [verdict for verdict in verdicts if not verdict.passed]
    passed = len(verdicts) - len(failing)
    return [f"{passed} of {len(verdicts)} checks pass", *(check_line(one) for one in failing)]


def check_line(verdict: Verdict) -> str:
    """One check: outcome, quantity, computed value, reference and tolerance.

    Parameters
    ----------
    verdict : Verdict
        The check.

    Returns
    -------
    str
    """
    from fe_drivetrain.report.results import expectation

    unit = f" {verdict.unit}" if verdict.unit not in ("", "-") else ""
    return (
        f"{'pass' if verdict.passed else 'FAIL'}  {verdict.quantity}: "
        f"computed {verdict.computed:.5g}{unit}, {expectation(verdict)}"
    )


def several_results_text(
    names: Sequence[str],
    results: Mapping[str, Results],
    problems: Mapping[str, Problem],
    page: Path,
) -> str:
    """Outcome of several cases: failing checks, a table of answers, and where the list is.

    Parameters
    ----------
    names : sequence of str
        Names of the cases, in order.
    results : mapping
        Results by name.
    problems : mapping
        Why there are no results, by name.
    page : Path
        The page that lists the cases.

    Returns
    -------
    str
    """
    failing = [
        f"FAIL  {name}: {check_line(verdict)[6:]}"
        for name in names
        if name in results
        for verdict in results[name].verdicts
        if not verdict.passed
    ]
    unsettled = [
        f"open  {name}: {sentence}"
        for name in names
        if name in results
        for sentence in results[name].unsettled
    ]
    before = [*failing, *unsettled]
    passed = sum(found.settled for found in results.values())
    left = sum(found.passed and not found.settled for found in results.values())
    still = f", {left} open" if left else ""
    return rendered(
        *before,
        *([""] if before else []),
        _answers_table(names, results, problems),
        "",
        f"{passed} of {len(names)} cases pass{still}: {page}",
    )


def _answers_table(
    names: Sequence[str], results: Mapping[str, Results], problems: Mapping[str, Problem]
) -> RenderableType:
    """Outcome, case and verdict of each case."""
    from rich.text import Text

    from fe_drivetrain.report.results import verdict_sentence

    colours = {"pass": "green", "open": "yellow", "skip": "yellow", "FAIL": "red", "none": "red"}
    table = _table()
    for name in names:
        if name in problems:
            outcome = "skip" if problems[name].state == "skipped" else "none"
            said = problems[name].message
        else:
            found = results[name]
            outcome = "pass" if found.settled else "open" if found.passed else "FAIL"
            said = verdict_sentence(found) or " ".join(found.details[:1])
        table.add_row(Text(outcome, colours[outcome]), name, Text(said.translate(_TYPED)))
    return table
