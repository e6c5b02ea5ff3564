"""The command ``compare-runs``: what changed between two runs, versions or machines."""

from __future__ import annotations

import math
import sys
from collections import Counter
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fe_drivetrain.command_line.answer_text import write_json
from fe_drivetrain.command_line.output_options import wants_json
from fe_drivetrain.command_line.terminal import FAILED, PASSED, guarded, write

if TYPE_CHECKING:
    from fe_drivetrain.report.suite.run_comparison import Change, RunComparison

_LOSSES = {"lost case", "lost check", "verdict"}


def compare_runs_command(
    before: Annotated[
        Path, typer.Argument(metavar="BEFORE", help="Folder of the first run: what --out named.")
    ],
    after: Annotated[Path, typer.Argument(metavar="AFTER", help="Folder of the second run.")],
) -> None:
    """Compare all checks and figures of two runs of the cases.

    Lists cases and checks that were lost, added or renamed, and verdicts, values and tolerances
    that changed, the most serious first. Counts what is the same to the last digit. The exit
    status is 0 if no case, no check and no passed verdict was lost, 1 otherwise.
    """

    def work() -> int:
        from fe_drivetrain.report.suite.run_comparison import compare_runs

        found = compare_runs(before, after)
        if wants_json():
            write_json(asdict(found))
        else:
            write(sys.stdout, _text(found))
        lost = any(c.kind in _LOSSES and c.after != "pass" for c in found.changes)
        return FAILED if lost else PASSED

    raise typer.Exit(guarded(work))


def _text(found: RunComparison) -> str:
    lines = []
    modes = Counter(f"{c.before} against {c.after}" for c in found.changes if c.kind == "mode")
    for mode, count in modes.items():
        lines.append(
            f"{mode}: {count} of {found.cases} cases ran quick in one run and not in "
            "the other: their values differ for that"
        )
    lines += [_line(change) for change in found.changes]
    kinds = Counter(change.kind for change in found.changes)
    lines += [
        f"{found.cases} cases in both runs; of {found.checks} checks of the first, {found.equal} "
        "are the same to the last digit",
        f"{found.equal_numbers} of {found.numbers} numbers among the figures are the same, "
        f"{found.near_numbers} more but for rounding",
    ]
    if kinds:
        lines.append("; ".join(f"{kind}: {count}" for kind, count in kinds.items()))
    return "".join(f"{line}\n" for line in lines)


def _line(change: Change) -> str:
    text = f"{change.kind:<10}  {change.case}"
    if change.what:
        text += f": {change.what}"
    if change.before is not None and change.after is not None:
        text += f": {_shown(change.before)} -> {_shown(change.after)}"
    notes = [] if math.isnan(change.error) else [f"{change.error:.1e} of it"]
    if change.shares is not None:
        used = (f"{100 * share:.2g} %" for share in change.shares)
        notes.append(f"{' -> '.join(used)} of the tolerance")
    if notes:
        text += f" ({'; '.join(notes)})"
    return text


def _shown(value: float | str) -> str:
    return value if isinstance(value, str) else f"{value:.10g}"
