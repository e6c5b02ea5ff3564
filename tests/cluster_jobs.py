"""What workers of a cluster do in tests; they import it, as this machine does."""

import os
import time
from pathlib import Path
from typing import Any

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.progress import Progress
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.shafts.fidelity import beam_shaft
from fe_drivetrain.studies import transient_digest
from fe_drivetrain.studies.load_digest import LoadOptions
from fe_drivetrain.studies.load_reactions import FileDigest, kept_digest

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
    report: Progress, file: Path, options: LoadOptions, folder: Path, dies: bool
) -> FileDigest:
    report(file.stem)
    with (folder / "log").open("a") as log:
        log.write(f"{file.stem}\n")
    if dies:
        await_kill(folder / "mark")
    return kept_digest(report, file, options, resume=True)


def driven_with_death(
    folder: Path, report: Progress, file: Path, *asked: Any
) -> transient_digest.FileDigest:
    """A drivetrain under a history; whoever first takes the fourth, dies."""
    with (folder / "log").open("a") as log:
        log.write(f"{file.stem} {os.getpid()}\n")
    if file.stem == "3":
        await_kill(folder / "mark")
    return _kept(report, file, *asked)


_kept = transient_digest.kept_digest  # before a test puts another in its place


def samples_with_death(folder: Path, number: int) -> Floats:
    """A piece of a history; whoever reads the sixth one first, dies."""
    if number == 5:
        await_kill(folder / "mark")
    return np.random.default_rng(number).standard_normal(300)


def shaft_with_death(folder: Path, widest: float, scene: Scene) -> dict[str, float]:
    """Stiffness of a scene's shaft as beams; whoever first has a wider one than that, dies."""
    diameter = scene.shaft.pieces[0].outer_diameter
    with (folder / "log").open("a") as log:
        log.write(f"{diameter.hex()}\n")
    if diameter > widest:
        await_kill(folder / "mark")
    stiffness = beam_shaft(scene).stiffness
    return {f"{k}": float(stiffness[k, k]) for k in range(6)}


def case_with_death(run: Run, page: Page) -> None:
    """Whoever runs it first, dies half-way, and leaves a file."""
    shared = Path(run.settings["mark"]).parent
    with (shared / "log").open("a") as log:
        log.write("begun\n")
    assert not (run.folder / "half.txt").exists()
    (run.folder / "half.txt").write_text("half")
    await_kill(shared / "mark")
    numbers(run, page)


def numbers(run: Run, page: Page) -> None:
    values = np.sin(np.random.default_rng(1).standard_normal(50))
    page.data("values", values.tolist())
    page.equals("sum", float(values.sum()), float(values.sum()), within=0.0, why="r", source="s")
    page.answer("Which sum?", "It is 1 sum.", [page.judged("sum")])


def seeded(_report: Progress, number: int) -> Floats:
    return np.random.default_rng([7, number]).standard_normal(10)


def wait(report: Progress, mark: Path) -> None:
    mark.touch()
    time.sleep(WAIT)


def mistake(report: Progress) -> None:
    raise InputError("shaft: length is -1 but must be greater than 0: give a length")


def read(report: Progress, file: Path) -> str:
    return file.read_text()


def pid(run: Run, page: Page) -> None:
    page.data("pid", os.getpid())
    page.equals("one", 1.0, 1.0, within=0.1, why="r", source="s")
    page.answer("Is it one?", "It is 1.", [page.judged("one")])
