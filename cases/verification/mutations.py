"""Single faults in the program that somebody could make: how many of them do the tests catch?"""

import tempfile
from collections.abc import Sequence
from pathlib import Path

from scipy.stats import binomtest

from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification.mutation_rows import (
    Fault,
    clone,
    faults_of,
    is_there_once,
    source_of,
)
from fe_drivetrain.cases.verification.mutation_runs import (
    SKIPPED,
    Bench,
    Tried,
    all_tried,
    controlled,
)
from fe_drivetrain.common import InputError, cores
from fe_drivetrain.report import Chart, bars
from fe_drivetrain.report.suite import Page, Record, Run

ROOMS = "Faults of each room: caught by tests, or not"
LIMIT, GOAL, CONFIDENCE = 240, 95.0, 0.95
"""Seconds for the tests of a fault; share to catch [%]; level of the interval."""


@case(
    "Single faults put into the program: the share of them that its tests catch",
    source="DeMillo, Lipton and Sayward 1978, Hints on test data selection, Computer 11(4)",
    settings={
        "only": "all (or those with a text in their module or words, such as gear/)",
        "limit": "240 (from 1, seconds for the tests of each)",
    },
)
def run(run: Run, page: Page) -> None:
    """Run the tests without a fault, then on a copy with each, and count."""
    root = clone()
    faults = _chosen(run, root)
    stale = [fault for fault in faults if not is_there_once(root, fault)]
    faults = [fault for fault in faults if fault not in stale]
    jobs = cores()
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        with run.step("copy of program and tests"):
            bench = Bench(root, Path(folder), float(run.count("limit", LIMIT)))
        with run.step("tests without a fault"):
            passing, others = controlled(bench, faults, jobs, run.report)
        with run.step("faults"):
            tried = all_tried(bench, faults, passing, jobs, run.report)
    _judge(page, tried, others, stale)
    _show(page, root, tried, others)


def _chosen(run: Run, root: Path) -> list[Fault]:
    only = str(run.settings.get("only", "all"))
    if only == "all":
        faults = [fault for fault in faults_of(root) if fault.quick or not run.quick]
    else:
        faults = [f for f in faults_of(root) if only in f.file or only in f.what]
    if not faults:
        raise InputError(
            f"only = {only!r} is in the module and in the words of no fault: give a room, as "
            "only=bearing/"
        )
    return faults


def _judge(
    page: Page, tried: Sequence[Tried], others: dict[str, str], stale: Sequence[Fault]
) -> None:
    failing = [f"{test} ({how})" for test, how in others.items() if how != SKIPPED]
    page.vanishes(
        "tests that fail without a fault",
        len(failing),
        within=0.0,
        why="what fails without a fault says nothing of the fault: "
        + ("; ".join(failing) or "there is none"),
        source="the same tests on the same copy of the program, without a fault",
    )
    page.vanishes(
        "faults whose line is not in its module exactly once",
        len(stale),
        within=0.0,
        why="a fault that cannot be put in is not tried: "
        + ("; ".join(f"{f.file}: {f.what}" for f in stale) or "there is none"),
        source="text of each row against the module",
    )
    unnamed = [one for one in tried if not one.caught and not one.fault.survives]
    page.vanishes(
        "survivors without a reason",
        len(unnamed),
        within=0.0,
        why="a fault that no test catches needs a test, or a reason in its row: "
        + ("; ".join(f"{t.fault.file}: {t.fault.what}" for t in unnamed) or "there is none"),
        source="rows of tests/mutations",
    )
    page.vanishes(
        "reasons why a fault survives, of one that is caught",
        sum(one.caught and bool(one.fault.survives) for one in tried),
        within=0.0,
        why="a reason that no longer holds is to be taken out of its row",
        source="rows of tests/mutations",
    )


def _show(page: Page, root: Path, tried: Sequence[Tried], others: dict[str, str]) -> None:
    count, caught = len(tried), sum(one.caught for one in tried)
    interval = binomtest(caught, count).proportion_ci(CONFIDENCE, method="exact")
    low, high = 100.0 * interval.low, 100.0 * interval.high
    rate = 100.0 * caught / count
    page.found("faults that tests catch [%]", rate)
    page.answer(
        "How many faults that are put into the program on purpose do its tests catch?",
        f"The tests catch {caught} of {count} deliberate faults, {rate:.1f}\u00a0%, which "
        f"{'reaches' if rate >= GOAL else 'does not reach'} the goal of {GOAL:g} %.",
        [
            page.value("faults that tests catch [%]", rate, at_least=GOAL, by="goal"),
            page.value("of all such faults, at least, at 95 % confidence [%]", low),
            page.value("faults that were tried", count),
            page.value("faults that survive", count - caught),
        ],
        hero=ROOMS,
        cautions=[
            "The faults are chosen by hand, and tests written for them: fewer of other faults may "
            f"be caught. If they were an independent sample, {low:.1f} to {high:.1f} % of all such "
            f"faults would be caught, at a confidence of {100 * CONFIDENCE:g} % (Clopper, Pearson "
            "1934)."
        ],
    )
    survivors = [_survivor(one) for one in tried if not one.caught]
    page.section("Survivors")
    if survivors:
        page.table("Faults that no test catches, and why", survivors)
    else:
        page.text("There is none.")
    page.section("Faults")
    page.add(_bars(tried))
    page.table("All faults", [_row(root, one) for one in tried])
    page.text(
        "Each fault is put into a copy of the program, whose loops that hold it are compiled "
        "again, and the tests that ought to catch it run there until the first failed assertion. "
        "A fault is caught where an assertion fails of a test that passes without it. Errors (at "
        "import, at set-up, an exception within a test) are no catches, and neither are tests that "
        "do not end within the limit of time: both count as survivors. Faults are chosen by hand: "
        "a sign, a factor, an index, an axis, a unit, a term left out, the wrong end, one too many."
    )
    skipped = [test for test, how in others.items() if how == SKIPPED]
    if skipped:
        page.text(f"Skipped, for want of a program or package: {', '.join(skipped)}.")
    page.data("caught [%], with interval", [rate, low, high])
    page.data("tests not passing without a fault", dict(others))


def _bars(tried: Sequence[Tried]) -> Chart:
    rooms = sorted({one.fault.room for one in tried})
    groups = {
        name: {
            room: float(sum(one.caught is is_caught and one.fault.room == room for one in tried))
            for room in rooms
        }
        for name, is_caught in (("caught", True), ("survive", False))
    }
    return bars(ROOMS, groups, "faults", stacked=True)


def _survivor(one: Tried) -> Record:
    return {
        "module": one.fault.file,
        "fault": one.fault.what,
        "outcome": f"{one.outcome} {one.by}".strip(),
        "reason": one.fault.survives or "none is stated",
    }


def _row(root: Path, one: Tried) -> Record:
    loops = "numba" in source_of(root, one.fault).read_text(encoding="utf-8")
    return {
        "module": one.fault.file,
        "compiled": "yes" if loops else "",
        "fault": one.fault.what,
        "in place of": one.fault.line.strip(),
        "stands": one.fault.fault.strip(),
        "caught by": one.by if one.caught else f"({one.outcome})",
        "seconds": round(one.seconds, 1),
    }
