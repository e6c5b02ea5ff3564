"""What workers of a cluster do in tests; they import it, as this machine does."""

import os
import time
from pathlib import Path

import numpy as np

from fe_drivetrain.commands.loads_digest import Digest, Options
from fe_drivetrain.commands.loads_page import kept_digest
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.progress import Progress
from fe_drivetrain.suite.page import Page
from fe_drivetrain.suite.run import Run

WAIT = 60.0  # seconds; a hang is a failure


def await_kill(mark: Path) -> None:
    """The first process that comes here waits for its end; another goes on."""
    try:
        with mark.open("x") as stream:
            stream.write(str(os.getpid()))
    except FileExistsError:
        return
    time.sleep(WAIT)
    raise AssertionError("nobody has killed it")


def digest_with_death(
    report: Progress, file: Path, options: Options, folder: Path, dies: bool
) -> Digest:
    report(file.stem)
    with (folder / "log").open("a") as log:
        log.write(f"{file.stem}\n")
    if dies:
        await_kill(folder / "mark")
    return kept_digest(report, file, options, resume=True)


def samples_with_death(folder: Path, number: int) -> Floats:
    """A piece of a history; whoever reads the sixth one first, dies."""
    if number == 5:
        await_kill(folder / "mark")
    return np.random.default_rng(number).standard_normal(300)


def wait(report: Progress, mark: Path) -> None:
    mark.touch()
    time.sleep(WAIT)


def mistake(report: Progress) -> None:
    raise InputError("shaft: length is -1 but must be greater than 0: give a length")


def pid(run: Run, page: Page) -> None:
    page.data("pid", os.getpid())
    page.equals("one", 1.0, 1.0, within=0.1, why="r", source="s")
