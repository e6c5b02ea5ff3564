"""Kills, full disks, two runs at once, broken caches and a failing mesher: what is left on disk."""

import json
import os
from typing import Any

from fe_drivetrain.cases import case
from fe_drivetrain.common import CORES_VARIABLE, MissingToolError, run_python, scratch_folder
from fe_drivetrain.report import Chart, chart, trace
from fe_drivetrain.report.suite import Page, Record, Run, column

#: Kills over the duration of a run without faults.
MOMENTS, QUICK_MOMENTS = 40, 10

CRITERION = "every file on disk is of one run, old or new"

#: Exit status of each fault, and whose results it leaves.
EXPECTED = {
    "SIGINT while it solves": (130, "old"),
    "SIGTERM while it solves": (143, "old"),
    "disk full from 5 kB a file on": (2, "old"),
    "cache that cannot be written": (0, "new"),
    "two runs into one folder": (0, "new"),
    "gmsh fails in one case of three": (2, "old"),
}

PICTURE = (
    "What a kill leaves in the result folder over its moment: as the program writes, whole old or "
    "new results; written in place, broken ones (shaded, if anywhere: whole ones)"
)
MARKED = 'counted; "old" and "new" are distinguished by a mark in every file'
THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")


def experiment(moments: int) -> Any:
    """What `fault_moments.Found` holds, measured in a process of its own."""
    if not hasattr(os, "fork"):
        raise MissingToolError(
            "this system cannot fork processes, to which the faults happen: run it on Linux"
        )
    with scratch_folder() as folder:
        done = run_python(
            *("-m", "fe_drivetrain.cases.stability.fault_moments", str(folder), str(moments)),
            environment={**dict.fromkeys(THREADS, "1"), CORES_VARIABLE: "1"},
            timeout=600,
        )
    if done.returncode != 0:
        raise RuntimeError(f"the experiment ended with status {done.returncode}: {done.stderr}")
    return json.loads(done.stdout)


@case(
    "Kills, full disks, two runs at once, broken caches: what is on disk is old or new",
    source="renameat2(2) and flock(2), Linux man-pages 6; IEEE Std 1003.1-2017, rename",
)
def run(run: Run, page: Page) -> None:
    """Let each fault happen to a small case, in processes of their own, and see what is left."""
    with run.step("kills and other faults"):
        found = experiment(QUICK_MOMENTS if run.quick else MOMENTS)
    killed, in_place = kills_of(found, "killed"), kills_of(found, "killed_in_place")
    check_kills(page, killed, in_place, found["left"])
    for fault in found["faults"]:
        status, whose = EXPECTED[fault["fault"]]
        page.holds(
            f"{fault['fault']}: ends with status {status}, leaves the {whose} results, and nothing "
            "else",
            is_as_expected(fault),
            why="a half-written result could be taken for one",
            source=MARKED,
        )
    tries, wrong = found["damaged"]
    page.vanishes(
        f"{tries} damages of a kept mesh: read back with other numbers",
        wrong,
        within=0.0,
        why="a mesh with other numbers would be solved without a sign",
        source="counted; what is read is compared with what was kept, byte by byte",
    )
    show(page, killed, in_place, found)
    page.data("killed", killed)
    page.data("killed in place", in_place)
    page.data("duration [s]", found["seconds"])


def kills_of(found: Any, way: str) -> list[Record]:
    """Kills in the order of their moments."""
    return [
        {
            "moment [s]": kill["moment"],
            "share of a run [-]": kill["moment"] / found["seconds"],
            "during the step": kill["step"],
            "results on disk": kill["found"],
            "hidden beside them, until the next run": kill["hidden"],
        }
        for kill in sorted(found[way], key=lambda kill: kill["moment"])
    ]


def broken(kills: list[Record]) -> list[bool]:
    """Which kills left half of a result."""
    return [kill["results on disk"] == "broken" for kill in kills]


def check_kills(page: Page, killed: list[Record], in_place: list[Record], left: int) -> None:
    """Results are whole wherever a run is killed, and not if they are written in place."""
    page.vanishes(
        f"{len(killed)} kills over the run: results that are neither old nor new",
        sum(broken(killed)),
        within=0.0,
        why="one half-written result is one too many",
        source=MARKED,
    )
    page.holds(
        "without the protection, written straight into the folder: a kill left half a result",
        any(broken(in_place)),
        why="otherwise the kills would not test the protection",
        source=MARKED,
    )
    page.holds(
        "kills began before the end and went on beyond it: old and new results were left",
        {"old", "new"} <= set(column(killed, "results on disk")),
        why="otherwise the kills would not have covered the whole run",
        source=MARKED,
    )
    page.vanishes(
        "hidden files and folders after the next run",
        left,
        within=0.0,
        why="what kills leave would otherwise fill the disk in time",
        source="counted",
    )


def safe_moment(in_place: list[Record]) -> float | None:
    """Share of a run after which no kill leaves half a result written in place."""
    last = max((k for k, is_broken in enumerate(broken(in_place)) if is_broken), default=-1)
    shares = column(in_place, "share of a run [-]")
    return shares[last + 1] if last + 1 < len(shares) else None


def is_as_expected(fault: Record) -> bool:
    """Whether a fault ends as `EXPECTED`, and leaves nothing hidden."""
    status, whose = EXPECTED[fault["fault"]]
    return (fault["status"], fault["found"], fault["hidden"]) == (status, whose, 0)


def answer(page: Page, killed: list[Record], half: list[bool], found: Any) -> None:
    """State what kills, other faults and damages leave; half of results written in place."""
    tries, wrong = found["damaged"]
    spoilt = sum(broken(killed))
    whole = sum(is_as_expected(fault) for fault in found["faults"])
    page.answer(
        "What is left on disk after a killed run, a full disk or a damaged cache?",
        f"{spoilt or 'None'} of {len(killed)} killed runs left an incomplete result, and "
        f"{wrong or 'none'} of {tries} damaged mesh files changed a number.",
        [
            page.value(
                f"killed runs that left an incomplete result, of {len(killed)}", spoilt, at_most=0.0
            ),
            page.value(f"damaged mesh files that changed a number, of {tries}", wrong, at_most=0.0),
            page.value(
                f"other faults that leave complete results, of {len(EXPECTED)}",
                whole,
                at_least=len(EXPECTED),
            ),
            page.value("hidden files left after the next run", found["left"], at_most=0.0),
            page.value(
                f"incomplete results if written in place, of {len(half)} killed runs", sum(half)
            ),
        ],
        hero=PICTURE,
        cautions=[
            "Only processes were killed; what a power cut leaves depends on the disk, and was not "
            "tried."
        ],
    )


def show(page: Page, killed: list[Record], in_place: list[Record], found: Any) -> None:
    """Answer, limits, charts, tables."""
    half, safe_from = broken(in_place), safe_moment(in_place)
    hidden = sum(kill["hidden beside them, until the next run"] > 0 for kill in killed)
    answer(page, killed, half, found)
    page.say(
        f"{hidden} kills left unfinished files or folders under hidden names; {found['left']} are "
        "left after the next run.",
    )
    state_limits(page, killed, half, found["damaged"], safe_from)
    page.section("Killed")
    page.add(picture(killed, in_place, safe_from))
    page.table(
        "Kills, in order of their moments, as the program writes",
        [{**kill, "moment [s]": round(kill["moment [s]"], 3)} for kill in killed],
        [name for name in killed[0] if name != "share of a run [-]"],
    )
    show_others(page, found)


def state_limits(
    page: Page,
    killed: list[Record],
    half: list[bool],
    damaged: tuple[int, int],
    safe_from: float | None,
) -> None:
    """State when a kill spoils results written in place, and what damages of kept meshes do."""
    tries, wrong = damaged
    page.limit(
        "results written straight into their folder",
        "moment of a kill, share of the run [-]",
        low=safe_from,
        criterion=CRITERION,
        beyond=f"{sum(half)} of {len(half)} kills left half a result, and the old one lost",
        program="writes beside them under a hidden name, exchanges the two in one operation, and "
        "removes what a kill left at the next run",
        remedy=f"{len(killed) - sum(broken(killed))} of {len(killed)} kills left the whole of the "
        "old or the new results",
    )
    page.limit(
        "kept meshes read back from the cache",
        "damages of the file at random places [-]",
        criterion="no other number than was written",
        beyond=f"{wrong} of {tries} damages were read back as other numbers",
        program="checks every byte by its checksum; what does not match is made again",
        remedy="the mesh made again gives the same stiffness to the last digit",
    )


def picture(killed: list[Record], in_place: list[Record], safe_from: float | None) -> Chart:
    """Chart of the results that kills leave, over the moment of the kill."""
    heights = {"broken": 0, "old": 1, "new": 2}
    drawn = chart(
        PICTURE,
        [
            trace(
                name,
                column(kills, "share of a run [-]"),
                [heights[kill["results on disk"]] for kill in kills],
                True,
                marker={"symbol": symbol, "size": 11},
                text=column(kills, "during the step"),
            )
            for name, kills, symbol in (
                ("as the program writes", killed, "circle"),
                ("written straight into the folder", in_place, "x"),
            )
        ],
        "moment of the kill over the duration of a run [-]",
        "results on disk",
        safe=None
        if safe_from is None
        else (safe_from, 1.05 * max(column([*killed, *in_place], "share of a run [-]"))),
    )
    drawn.figure["layout"]["yaxis"] |= {
        "tickvals": list(heights.values()),
        "ticktext": list(heights),
        "range": [-0.4, 2.4],
    }
    return drawn


def show_others(page: Page, found: Any) -> None:
    """Show other faults, and how results are protected."""
    tries, _ = found["damaged"]
    page.section("Other faults")
    page.table(
        "What the program reports, returns and leaves",
        [
            {
                "fault": f["fault"],
                "its last message": f["message"] if f["status"] else "none: it ends as usual",
                "exit status": f["status"],
                "results on disk": f["found"],
                "hidden beside them": f["hidden"],
            }
            for f in found["faults"]
        ],
    )
    page.text(
        f"A kept mesh was damaged {tries} times, at random places: a bit turned, the rest cut off, "
        "256 bytes of zeros. What is damaged is made again. Of three cases of which one fails in "
        "gmsh, the other two finish; the failed one keeps its old results and is marked."
    )
    page.section("How results are protected")
    page.text(
        "A run fills a hidden folder beside the result folder, and exchanges the two in one "
        "operation of the file system when all is written (where the system has no such operation, "
        "in two, and the next run puts back what a kill between them took away). While it runs it "
        "holds a lock on the hidden folder, which the system releases when the process ends, "
        "however it ends: a hidden folder without a lock was left by a kill, and the next run "
        "into the same place removes it. Files are written the same way."
    )
