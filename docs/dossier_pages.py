"""The dossier of the site: a drivetrain of the library under loads of a turbine that moves.

Parts that the same program has made are kept in ``build/dossier``, which can be removed at any
time. As a script, with a folder: makes the loads and the dossier in it.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

from result_pages import LEFT_OUT, linked

SITE = "dossier"
"""Folder of the site that has the dossier."""
DRIVETRAIN = "three_point_suspension"
WINDS = (8.0, 14.0, 20.0)
"""Mean winds of its loads, ten minutes each [m/s]."""
LOADS = "loads"
COMMAND = ("report", DRIVETRAIN, "--loads", f"{LOADS}/*.csv", "--site", "class-II", "--quick")
"""What makes it, in its folder."""
PAGES = {
    "overview": "the first page, which answers",
    "loads": "what acts on the hub",
    "reactions": "what the bearings carry",
    "life": "how long they last",
    "model": "which model is enough",
    "check": "the drivetrain, and what each model costs",
    "export": "what other programs can take of it",
}


def begun(folder: Path) -> subprocess.Popen[bytes]:
    """Begin to make the dossier, or what of it is not kept, beside all else.

    Parameters
    ----------
    folder : Path
        Keeps it.
    """
    folder.mkdir(parents=True, exist_ok=True)
    return subprocess.Popen(
        [sys.executable, __file__, str(folder)], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    )


def finish(process: subprocess.Popen[bytes], folder: Path, site: Path) -> None:
    """Wait for the dossier, and put its pages into the site.

    Parameters
    ----------
    process : Popen
        From `begun`.
    folder : Path
        Where it makes the dossier.
    site : Path
        Folder of the site.

    Raises
    ------
    RuntimeError
        There is no dossier; or a check of it fails.
    """
    said, errors = (stream.decode(errors="replace") for stream in process.communicate())
    if process.returncode:
        raise RuntimeError(f"the dossier of the site was not made: {errors or said}")
    to = site / SITE
    shutil.rmtree(to, ignore_errors=True)
    shutil.copytree(folder / "dossier", to, ignore=LEFT_OUT, copy_function=linked)
    for file in folder.glob("plotly-*.js"):
        linked(file, site / file.name)


def dossier_page() -> str:
    """The page of the site that leads to the dossier."""
    winds = ", ".join(f"{wind:g}" for wind in WINDS)
    typed = " ".join(f"'{word}'" if "*" in word else word for word in COMMAND)
    rows = [
        f'- <a href="../{SITE}/{name}/report.html">{name.capitalize()}</a>: {what}'
        for name, what in PAGES.items()
    ]
    return "\n".join(
        [
            "# A dossier",
            "",
            "What `fe-drivetrain report` makes of a drivetrain and loads: pages for who decides, "
            f"with one menu. This one is of `{DRIVETRAIN}` of the [library](../library.md), under "
            f"ten minutes each of a [turbine that moves](../turbine.md) in winds of {winds} m/s. "
            "It is made again when the program changes and this site is built.",
            "",
            "```sh",
            f"fe-drivetrain {typed}",
            "```",
            "",
            *rows,
            "",
        ]
    )


def make(folder: Path) -> None:
    """Make loads and dossier in a folder; ends with the exit status of the command.

    The folder is the current one then, so that pages name no folder of this machine.
    """
    os.chdir(folder)
    from fe_drivetrain.turbine_loads.hub_loads import (
        Condition,
        Rotor,
        similar_turbine,
        turbine_history,
    )

    Path(LOADS).mkdir(exist_ok=True)
    turbine = similar_turbine(Rotor())
    for wind in WINDS:
        history = turbine_history(Condition(wind, "medium", 0.2, seed=1), turbine)
        history.write(f"{LOADS}/wind_{wind:g}.csv")
    from fe_drivetrain.command_line.app import main

    sys.argv = ["fe-drivetrain", *COMMAND, "--out", "."]
    main()


if __name__ == "__main__":
    make(Path(sys.argv[1]))
