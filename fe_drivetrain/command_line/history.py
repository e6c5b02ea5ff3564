"""The command ``history``: the runs so far of a folder of reports, so that a drift is seen."""

from __future__ import annotations

import math
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fe_drivetrain.command_line.answer_text import write_json
from fe_drivetrain.command_line.names import complete_case
from fe_drivetrain.command_line.output_options import wants_json
from fe_drivetrain.command_line.terminal import PASSED, guarded, write
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.near_words import did_you_mean

if TYPE_CHECKING:
    from fe_drivetrain.report.history import PastRun

_COLUMNS = ("when", "case", "program", "mode", "verdict", "answer", "change", "time")


def history_command(
    case: Annotated[
        str,
        typer.Argument(
            metavar="CASE",
            autocompletion=complete_case,
            help="GROUP/NAME, or NAME if it is unique.",
        ),
    ] = "",
    out: Annotated[
        Path, typer.Option("--out", metavar="DIR", help="Folder of reports, as of `run`.")
    ] = Path("reports"),
) -> None:
    """List the runs so far of one case, or of all: when, by which program, and what they found.

    Each run writes history.sqlite in the folder of reports. `program` is the beginning of the hash
    of the program's sources, `change` that of the answer since the last run with the same settings
    in the same mode.
    """

    def work() -> int:
        from fe_drivetrain.report.history import past_runs

        runs = past_runs(out)
        shown = _of_case(runs, case) if case else runs
        if wants_json():
            write_json([run._asdict() for run in shown])
            return PASSED
        write(sys.stdout, history_text(shown))
        return PASSED

    raise typer.Exit(guarded(work))


def history_text(runs: Sequence[PastRun]) -> str:
    """A table of runs in plain text, the oldest first.

    Parameters
    ----------
    runs : sequence of PastRun
        Which.

    Returns
    -------
    str
    """
    lines: list[Sequence[str]] = [_COLUMNS]
    before: dict[tuple[object, ...], PastRun] = {}
    for run in runs:
        key = (run.name, run.quick, str(sorted(run.settings.items())), run.quantity, run.unit)
        lines.append(_cells(run, before.get(key)))
        before[key] = run
    widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
    return "".join(
        "  ".join(c.ljust(w) for c, w in zip(line, widths, strict=True)).rstrip() + "\n"
        for line in lines
    )


def _cells(run: PastRun, before: PastRun | None) -> list[str]:
    from fe_drivetrain.report.number_text import value_with_band
    from fe_drivetrain.report.results import Figure
    from fe_drivetrain.report.trend import relative_change

    computed = math.nan if run.computed is None else run.computed
    found = Figure(quantity=run.quantity, unit=run.unit, computed=computed, band=run.band)
    change = "" if before is None else "same"
    if before is not None:
        old = math.nan if before.computed is None else before.computed
        moved = relative_change(old, computed, run.allowed)
        change = f"{100 * moved:+.2g} %" if moved else change
    return [
        run.date,
        run.name,
        run.code[:8],
        "quick" if run.quick else "full",
        "pass" if not run.failed else f"FAIL {run.failed} of {run.checks}",
        f"{run.quantity}: {value_with_band(found)}" if run.quantity else "no checks",
        change,
        f"{run.seconds:.1f} s",
    ]


def _of_case(runs: Sequence[PastRun], case: str) -> list[PastRun]:
    names = sorted({run.name for run in runs})
    found = [name for name in names if case in (name, name.rpartition("/")[2])]
    if len(found) > 1:
        raise InputError(f"case {case!r} is ambiguous: use one of {', '.join(found)}")
    if not found:
        near = did_you_mean(case, names) or "none is like it;"
        raise InputError(f"case {case!r} is not in this history: {near} without CASE all are shown")
    return [run for run in runs if run.name == found[0]]
