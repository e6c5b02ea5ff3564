"""From the command to the report: what a user waits for, imports and compiling included."""

from __future__ import annotations

import json
import statistics
import time
from pathlib import Path
from typing import Any, NamedTuple

from fe_drivetrain.cases import case
from fe_drivetrain.common import (
    CACHE_VARIABLE,
    InputError,
    MissingToolError,
    run_python,
    scratch_folder,
)
from fe_drivetrain.report import bars
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import Page, Record, Run

_PROGRAM = "import sys; from fe_drivetrain.command_line import main; sys.exit(main())"
REPEATS, QUICK_REPEATS = 5, 2

FIRST, SECOND, ALONE = "compiled now, nothing kept", "all kept", "compiled before, nothing kept"


class Wait(NamedTuple):
    """A command, what was there before it, and how long it may take [s]."""

    command: tuple[str, ...]
    before: str
    goal: float


WAITING = "Wait from the command to its report, beside the goal; bars: least and most of all runs"
_STUDY = ("run", "main_bearing/rmse")
WAITS = (
    Wait(_STUDY, FIRST, 40.0),
    Wait(_STUDY, ALONE, 25.0),
    Wait(_STUDY, SECOND, 10.0),
    Wait(("advise", "main_bearing_bonded"), ALONE, 8.0),
    Wait(("uncertainty", "main_bearing_bonded_uncertain"), ALONE, 15.0),
)
#: Decided by statics: imports and the report are all that takes time.
_STATICS = ("advise", "main_bearing_spherical")
QUICK = (Wait(_STATICS, FIRST, 8.0),)


class Took(NamedTuple):
    """One run: wall time and time of all its processes on processors [s], and its results."""

    wall: float
    processors: float
    results: dict[str, Any]


def waited(wait: Wait, compiled: Path, kept: Path) -> Took:
    """Run a command in a process of its own, and wait for its report.

    Parameters
    ----------
    wait : Wait
        Which.
    compiled, kept : Path
        Hold compiled loops, and meshes and solutions, from one run to the next.
    """
    import resource  # which Windows does not have

    with scratch_folder() as out:
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        start = time.perf_counter()
        done = run_python(
            *("-c", _PROGRAM, *wait.command, "--out", f"{out}/results"),
            environment={
                "NUMBA_CACHE_DIR": str(compiled),
                CACHE_VARIABLE: str(kept),
                "PYTHONDONTWRITEBYTECODE": "",  # an installed package has its bytecode
            },
        )
        wall = time.perf_counter() - start
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        file = Path(out, "results", "results.json")
        # 1 says that a check fails, which is an answer, too
        if done.returncode not in (0, 1) or not file.is_file():
            raise InputError(f"{' '.join(wait.command)} gave no answer: {done.stderr[-500:]}")
        spent = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        return Took(wall, spent, json.loads(file.read_text()))


def measured(run: Run, wait: Wait, repeats: int) -> list[Took]:
    """A command several times, each time with the same things there before it."""
    name = f"{' '.join(wait.command)}, {wait.before}"
    found = []
    with run.step(name), scratch_folder() as folder:
        compiled, kept = folder / "compiled", folder / "kept"
        if wait.before != FIRST:
            waited(wait, compiled, kept)
        for number in range(repeats):
            run.report(f"{name} ({number + 1} of {repeats})")
            # as a user has it: what a run makes is kept for the rest of it
            with scratch_folder() as empty:
                found.append(
                    waited(
                        wait,
                        empty / "compiled" if wait.before == FIRST else compiled,
                        kept if wait.before == SECOND else empty / "kept",
                    )
                )
    return found


@case(
    "Start to answer: what a user waits for, imports and compiling included",
    source="wall time of commands in processes of their own",
    settings={"repeats": "5 (quick 2; from 1)"},
    alone="full",
)
def run(run: Run, page: Page) -> None:
    """Time the study, the adviser and the uncertainty of a main bearing."""
    try:
        import resource  # noqa: F401
    except ImportError:
        raise MissingToolError(
            "this system does not say what time its processes take: run it on Linux"
        ) from None
    repeats = run.count("repeats", QUICK_REPEATS if run.quick else REPEATS)
    waits = QUICK if run.quick else WAITS
    found = {wait: measured(run, wait, repeats) for wait in waits}
    rows = [row_of(wait, took) for wait, took in found.items()]
    for command in dict.fromkeys(wait.command for wait in waits):
        verdicts = [
            [(v["quantity"], v["passed"]) for v in took.results["verdicts"]]
            for wait, all_of in found.items()
            for took in all_of
            if wait.command == command
        ]
        page.holds(
            f"{' '.join(command)}: every run has the same checks with the same verdicts",
            all(found == verdicts[0] for found in verdicts),
            why="what is compiled or kept may change the time, not the answer",
            source="the first run",
        )
    page.section("What a user waits for")
    answer(page, rows)
    page.table(
        f"Wall time of {repeats} run{'s' * (repeats > 1)} each, on this machine, with whatever "
        "else it was doing; time on processors is that of all processes, the median",
        rows,
    )
    page.text(
        f"{FIRST.capitalize()}: the first run of a fresh installation. {SECOND.capitalize()}: the "
        "same command once more. " + f"{ALONE.capitalize()}: a scene that was never solved."
    )
    for sentence in of_compiling(rows):
        page.text(sentence)
    page.section("Where it goes")
    page.table("The longest steps of the last run of each, in whatever process", steps_of(found))
    page.data("waits", rows)


def of_compiling(rows: list[Record]) -> list[str]:
    """What compiling adds to a first run, for each command that was run with and without it."""
    medians = {(row["command"], row["before"]): float(row["median [s]"]) for row in rows}
    found = []
    for (command, before), first in medians.items():
        alone = medians.get((command, ALONE))
        if before == FIRST and alone is not None:
            found.append(
                f"'{command}' waits {first - alone:.2g} s for compiling: a first run takes "
                f"{first / alone:.2g} times one whose loops were compiled before. The rest is "
                "meshing and solving, which is kept for the next run."
            )
    return found


def answer(page: Page, rows: list[Record]) -> None:
    """State the longest of all waits against its goal."""
    names = [f"{row['command']}, {row['before']}" for row in rows]
    medians = {n: float(row["median [s]"]) for n, row in zip(names, rows, strict=True)}
    ends = {
        n: (float(row["least [s]"]), float(row["most [s]"]))
        for n, row in zip(names, rows, strict=True)
    }
    goals = {n: float(row["goal [s]"]) for n, row in zip(names, rows, strict=True)}
    page.add(bars(WAITING, {"median": medians, "goal": goals}, "time [s]", ends={"median": ends}))
    longest = max(rows, key=lambda row: float(row["median [s]"]) / float(row["goal [s]"]))
    seconds, goal = float(longest["median [s]"]), float(longest["goal [s]"])
    within = sum(medians[name] <= goals[name] for name in names)
    page.answer(
        "How long does a user wait from the command to its report?",
        f"The command '{longest['command']}' takes {value_text(seconds, 's')} "
        f"({longest['before']}), {'within' if seconds <= goal else 'beyond'} its goal of "
        f"{goal:g}\u00a0s; {within} of {len(rows)} commands reach theirs.",
        [
            *(
                page.value(f"{name} [s]", medians[name], beside=goals[name], by="goal")
                for name in names
            ),
            page.value("processor time of that command [s]", float(longest["on processors [s]"])),
            page.value(
                "spread of its wait between runs [s]",
                float(longest["most [s]"]) - float(longest["least [s]"]),
            ),
        ][:6],
        hero=WAITING,
        cautions=[
            "Times are those of this machine, which had other work, too. 'Nothing kept' is a "
            "first run: no mesh or solution is stored from before."
        ],
    )


def row_of(wait: Wait, took: list[Took]) -> Record:
    """A row of the table of waits."""
    wall = [one.wall for one in took]
    return {
        "command": " ".join(wait.command),
        "before": wait.before,
        "goal [s]": wait.goal,
        "least [s]": min(wall),
        "median [s]": statistics.median(wall),
        "most [s]": max(wall),
        "on processors [s]": statistics.median(one.processors for one in took),
    }


def steps_of(found: dict[Wait, list[Took]], most: int = 6) -> list[Record]:
    """Rows of the longest steps."""
    rows: list[Record] = []
    for wait, took in found.items():
        times = sorted(took[-1].results["times"].items(), key=lambda item: -item[1])
        rows += [
            {"command": " ".join(wait.command), "before": wait.before, "step": k, "time [s]": t}
            for k, t in times[:most]
        ]
    return rows
