"""Commands among files of others: kills at random moments, and folders that are not theirs."""

import json
import os
from typing import Any

from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification import command_kills
from fe_drivetrain.common import (
    CORES_VARIABLE,
    InputError,
    MissingToolError,
    run_python,
    scratch_folder,
)
from fe_drivetrain.report import bars
from fe_drivetrain.report.suite import Page, Run, column

KILLS, QUICK_KILLS = 100, 2
KINDS, QUICK_KINDS = [*command_kills.QUICK, *command_kills.OTHERS], [*command_kills.QUICK]
THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
AFTER = "What kills at random moments did: runs that they ended, and what was damaged"
COUNTED = "counted: kind, mode and SHA-256 of every file, link and folder, before and after"


def chosen(run: Run) -> list[str]:
    """The kinds of command that are asked for."""
    asked = run.settings.get("kinds", QUICK_KINDS if run.quick else KINDS)
    names = [asked] if isinstance(asked, str) else list(asked)
    if unknown := [name for name in names if name not in KINDS]:
        raise InputError(f"kinds: {unknown[0]!r} is unknown: choose of {', '.join(KINDS)}")
    return names


def experiment(kills: int, kinds: list[str]) -> list[dict[str, Any]]:
    """What `command_kills.Found` holds of each kind of command, found in a process of its own."""
    if not hasattr(os, "fork"):
        raise MissingToolError("this system cannot fork processes: run the case on Linux")
    with scratch_folder() as folder:
        done = run_python(
            *("-m", "fe_drivetrain.cases.verification.command_kills"),
            *(str(folder), str(kills), *kinds),
            environment={**dict.fromkeys(THREADS, "1"), CORES_VARIABLE: "1"},
            timeout=60 * kills * len(kinds),
        )
    if done.returncode != 0:
        raise RuntimeError(f"the experiment ended with status {done.returncode}: {done.stderr}")
    found: list[dict[str, Any]] = json.loads(done.stdout)
    return found


@case(
    "Files of others: kills of every kind of command, and folders that are not theirs",
    source="renameat2(2), link(2) and flock(2), Linux man-pages 6",
    settings={
        "kills": "100 (quick 2; from 1)",
        "kinds": "[run, new, export, run of several, advise, validate, check, compare, study, "
        "loads, life, uncertainty] (quick [run, new, export])",
    },
)
def run(run: Run, page: Page) -> None:
    """Kill each kind of command while its folders hold files of others, and look at every file."""
    kills = run.count("kills", QUICK_KILLS if run.quick else KILLS)
    with run.step("kills, and folders of others"):
        found = experiment(kills, chosen(run))
    check(page, kills, found)
    answer(page, kills, found)
    page.section("Each kind of command")
    fates = {
        "ended by the kill": "ended",
        "lost a file of others": "lost",
        "half a result": "broken",
    }
    by_fate = {name: {one["command"]: one[key] for one in found} for name, key in fates.items()}
    page.add(bars(AFTER, by_fate, "runs"))
    page.table(
        "Kills at random moments of a run, and what was there afterwards",
        [
            {
                "command": one["command"],
                "one run [s]": round(one["seconds"], 2),
                "kills": one["kills"],
                "of them before the end": one["ended"],
                "files of others lost": one["lost"],
                "results broken": one["broken"],
                "hidden after the next run": one["left"],
                "folder of others": "untouched" if one["untouched"] else "changed",
            }
            for one in found
        ],
    )
    page.section("How files of others are kept")
    page.text(
        "A run lists in `fe-drivetrain-files.json` what it wrote, each file with the SHA-256 of "
        "its content. A later run replaces these alone. All else is linked into the new folder "
        "before that is exchanged for the old one in one operation, so that it is never missing; "
        "a file that was changed since the run is kept, with `.kept` added to its name. A folder "
        "without such a list, which is not empty, is refused before any work."
    )
    page.data("commands", found)


def answer(page: Page, kills: int, found: list[dict[str, Any]]) -> None:
    """State what kills and folders of others came to."""
    total, ended = kills * len(found), sum(column(found, "ended"))
    lost, broken = sum(column(found, "lost")), sum(column(found, "broken"))
    polite = sum(one["refused"] and one["untouched"] for one in found)
    page.answer(
        "Can a command that is killed damage files that are not its own?",
        f"{'Yes' if lost + broken else 'No'}: a kill ended {ended} of {total} runs of {len(found)} "
        f"commands; {lost} damaged a file that was not theirs, {broken} left half a result.",
        [
            page.value("files lost or changed that are not its own", lost, at_most=0),
            page.value("results that are half written", broken, at_most=0),
            page.value("hidden files after the next run", sum(column(found, "left")), at_most=0),
            page.value("runs that a kill ended", ended),
            page.value("commands that leave other folders alone", polite, at_least=len(found)),
        ],
        hero=AFTER,
        cautions=[f"Each kill comes at a random moment: only {total} moments were tried."],
    )


def check(page: Page, kills: int, found: list[dict[str, Any]]) -> None:
    """No file of others is lost, and the experiment would have found it."""
    for key, what, why in (
        ("lost", "files of others lost or changed", "one lost file is one too many"),
        ("broken", "results that are neither old nor new", "half a result could be taken for one"),
        ("left", "hidden files and folders after the next run", "they would fill the disk in time"),
    ):
        page.vanishes(
            f"{kills} kills of each of {len(found)} commands: {what}",
            sum(column(found, key)),
            within=0.0,
            why=why,
            source=COUNTED,
        )
    page.holds(
        "every command into a folder of others: is refused, or writes its own file alone",
        all(column(found, "refused")) and all(column(found, "untouched")),
        why="a folder that is not of an earlier run belongs to somebody",
        source=COUNTED,
    )
    page.holds(
        "kills ended runs of every command, and a file that is changed on purpose is found",
        all(column(found, "ended")) and all(column(found, "seen")),
        why="otherwise nothing would have been tested",
        source=COUNTED,
    )
