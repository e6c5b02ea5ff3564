"""Kills, full disks, two runs at once, broken caches and a failing mesher: what is left on disk."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: Kills over the duration of a run that nothing disturbs.
MOMENTS, QUICK_MOMENTS = 40, 10

CRITERION = "every file on disk is of one run, old or new"


def run(run: Run) -> Any:
    """Let each fault happen to a small case, in processes of their own, and see what is left."""
    import json
    import os
    import subprocess
    import sys
    import tempfile

    from fe_drivetrain.common import CORES_VARIABLE, MissingToolError
    from fe_drivetrain.report import Limit, Section, Table, Text, chart, judge, trace

    if not hasattr(os, "fork"):
        raise MissingToolError(
            "this system cannot fork processes, to which the faults happen: run it on Linux"
        )
    moments = QUICK_MOMENTS if run.quick else MOMENTS
    threads = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
    with (
        run.step("kills and other faults"),
        tempfile.TemporaryDirectory() as folder,
    ):
        program = "fe_drivetrain.cases.stability.fault_moments"
        done = subprocess.run(
            [sys.executable, "-P", "-m", program, folder, str(moments)],
            env={**os.environ, **dict.fromkeys(threads, "1"), CORES_VARIABLE: "1"},
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=600,
            check=False,
        )
    if done.returncode != 0:
        raise RuntimeError(f"the experiment ended with status {done.returncode}: {done.stderr}")
    found = json.loads(done.stdout)

    seconds = found["seconds"]
    killed, in_place = found["killed"], found["killed_in_place"]
    for kills in (killed, in_place):
        kills.sort(key=lambda kill: kill["moment"])
    broken = [kill["found"] == "broken" for kill in killed]
    broken_in_place = [kill["found"] == "broken" for kill in in_place]
    shares = [kill["moment"] / seconds for kill in in_place]
    last_broken = max((k for k, is_broken in enumerate(broken_in_place) if is_broken), default=-1)
    safe_from = shares[last_broken + 1] if last_broken + 1 < len(shares) else None

    tries, wrong = found["damaged"]
    exact = 'counted; "old" and "new" are told by a mark that stands in every file'
    whole = "an identity: one half-written result is one too many"

    def identity(quantity: str, computed: float, reference: float) -> Any:
        return judge(
            quantity,
            computed,
            reference,
            tolerance=0.0,
            relative=False,
            source=exact,
            reason=whole,
            measure="identity",
            band=0.0,
        )

    expected = {
        "SIGINT while it solves": (130, "old"),
        "SIGTERM while it solves": (143, "old"),
        "disk full from 5 kB a file on": (2, "old"),
        "cache that cannot be written": (0, "new"),
        "two runs into one folder": (0, "new"),
        "gmsh fails in one case of three": (2, "old"),
    }
    verdicts = [
        identity(
            f"{len(killed)} kills over the run: results that are neither old nor new",
            sum(broken),
            0,
        ),
        identity(
            "without the protection, written straight into the folder: a kill left half a result",
            float(any(broken_in_place)),
            1,
        ),
        identity(
            "kills began before the end and went on beyond it: old and new results were left",
            float({"old", "new"} <= {kill["found"] for kill in killed}),
            1,
        ),
        identity("hidden files and folders after the next run", found["left"], 0),
        *(
            identity(
                f"{fault['fault']}: ends with status {expected[fault['fault']][0]}, leaves the "
                f"{expected[fault['fault']][1]} results, and nothing else",
                float(
                    (fault["status"], fault["found"], fault["hidden"])
                    == (*expected[fault["fault"]], 0)
                ),
                1,
            )
            for fault in found["faults"]
        ),
        identity(f"{tries} damages of a kept mesh: read back with other numbers", wrong, 0),
    ]

    heights = {"broken": 0, "old": 1, "new": 2}
    curves = [
        trace(
            name,
            [kill["moment"] / seconds for kill in kills],
            [heights[kill["found"]] for kill in kills],
            mode="markers",
            marker={"symbol": symbol, "size": 11},
            text=[kill["step"] for kill in kills],
        )
        for name, kills, symbol in (
            ("as the program writes", killed, "circle"),
            ("written straight into the folder", in_place, "x"),
        )
    ]
    latest = max(kill["moment"] for kill in killed + in_place) / seconds
    picture = chart(
        "What a kill leaves in the result folder, against its moment: as the program writes, "
        "always the whole of the old or of the new results; written in place, half of them until "
        "the end (safe range of writing in place shaded)",
        curves,
        "moment of the kill over the duration of a run [-]",
        "results on disk",
        safe=None if safe_from is None else (safe_from, 1.05 * latest),
    )
    picture.figure["layout"]["yaxis"] |= {
        "tickvals": list(heights.values()),
        "ticktext": list(heights),
        "range": [-0.4, 2.4],
    }
    left_by_kills = sum(kill["hidden"] > 0 for kill in killed)
    return CASE.results(
        run,
        summary=[
            f"Of {len(killed)} kills over the run of a small case none left anything but the whole "
            f"of the old or the new results; written straight into the folder, "
            f"{sum(broken_in_place)} of {len(in_place)} left half of them.",
            f"{left_by_kills} kills left unfinished files or folders under hidden names; "
            f"{found['left']} are left after the next run.",
            f"{tries} damages of a kept mesh gave other numbers {wrong} times; a full disk, "
            "signals, two runs at once and a mesher that fails each leave whole results.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Killed",
                items=[
                    picture,
                    Table(
                        caption="Kills, in order of their moments, as the program writes",
                        columns=[
                            "moment [s]",
                            "during the step",
                            "results on disk",
                            "hidden beside them, until the next run",
                        ],
                        rows=[
                            [round(k["moment"], 3), k["step"], k["found"], k["hidden"]]
                            for k in killed
                        ],
                    ),
                ],
            ),
            Section(
                title="Other faults",
                items=[
                    Table(
                        caption="What the program says, returns and leaves",
                        columns=[
                            "fault",
                            "its last words",
                            "exit status",
                            "results on disk",
                            "hidden beside them",
                        ],
                        rows=[
                            [
                                f["fault"],
                                f["said"] if f["status"] else "none: it ends as usual",
                                f["status"],
                                f["found"],
                                f["hidden"],
                            ]
                            for f in found["faults"]
                        ],
                    ),
                    Text(
                        text=f"A kept mesh was damaged {tries} times, at random places: a bit "
                        "turned, the rest cut off, 256 bytes of zeros. What is damaged is made "
                        "anew. Of three cases of which one fails in gmsh, the other two finish; "
                        "the failed one keeps its old results and is marked."
                    ),
                ],
            ),
            Section(
                title="How results are protected",
                items=[
                    Text(
                        text="A run fills a hidden folder beside the result folder, and exchanges "
                        "the two in one operation of the file system when all is written (where "
                        "the system has no such operation, in two, and the next run puts back what "
                        "a kill between them took away). While it runs it holds a lock on the "
                        "hidden folder, of which the system lets go when the process ends, however "
                        "it ends: a hidden folder that nobody holds was left by a kill, and the "
                        "next run into the same place removes it. Files are written the same way."
                    )
                ],
            ),
        ],
        limits=[
            Limit(
                method="results written straight into their folder",
                parameter="moment of a kill, share of the run [-]",
                low=safe_from,
                high=None,
                criterion=CRITERION,
                beyond=f"{sum(broken_in_place)} of {len(in_place)} kills left half a result, and "
                "the old one lost",
                program="writes beside them under a hidden name, exchanges the two in one "
                "operation, and removes what a kill left at the next run",
                remedy=f"{len(killed) - sum(broken)} of {len(killed)} kills left the whole of the "
                "old or the new results",
            ),
            Limit(
                method="kept meshes read back from the cache",
                parameter="damages of the file at random places [-]",
                low=None,
                high=None,
                criterion="no other number than was written",
                beyond=f"{wrong} of {tries} damages were read back as other numbers",
                program="checks every byte by its checksum; what does not fit is made anew",
                remedy="the mesh made anew gives the same stiffness to the last digit",
            ),
        ],
        figures={"killed": killed, "killed in place": in_place, "duration [s]": seconds},
    )


CASE = Case(
    name="stability/faults",
    title="Kills, full disks, two runs at once, broken caches: what is on disk is old or new",
    source="renameat2(2) and flock(2), Linux man-pages 6; IEEE Std 1003.1-2017, rename",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
