"""What a validation case is, and how one is run into a folder that appears whole or not at all."""

import importlib
import os
import pkgutil
import shutil
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from fe_drivetrain.errors import InputError
from fe_drivetrain.results import Results


@dataclass
class Run:
    """One run of a case: what the user asked for, where files go, and a clock for each step.

    Attributes
    ----------
    settings
        The user's ``--set key=value``, values parsed as YAML scalars.
    quick
        Coarser and smaller, for a first look.
    folder
        Where the case may put files beside its results; it becomes the result folder.
    report
        Called with the name of each step as it begins.
    times
        Wall time of each finished step [s].
    """

    settings: Mapping[str, Any]
    quick: bool
    folder: Path
    report: Callable[[str], None] = lambda step: None
    times: dict[str, float] = field(default_factory=dict)

    @contextmanager
    def step(self, name: str) -> Iterator[None]:
        """Show a step while it runs, and add its wall time to `times`."""
        self.report(name)
        start = time.perf_counter()
        yield
        self.times[name] = self.times.get(name, 0.0) + time.perf_counter() - start


@dataclass(frozen=True)
class Case:
    """A validation case: it describes, runs and judges.

    Attributes
    ----------
    name
        "GROUP/NAME", as under ``cases/``.
    title
        One line.
    source
        Where the problem and its reference come from.
    run
        Does the work.
    """

    name: str
    title: str
    source: str
    run: Callable[[Run], Results]


def all_cases() -> dict[str, Case]:
    """Every case by name, in order."""
    import fe_drivetrain.cases as package

    found = {}
    for info in pkgutil.walk_packages(package.__path__, package.__name__ + "."):
        module = importlib.import_module(info.name)
        if hasattr(module, "CASE"):
            found[module.CASE.name] = module.CASE
    return dict(sorted(found.items()))


def find_case(name: str) -> Case:
    """The case of that name; its last part is enough where it is unique.

    Raises
    ------
    InputError
        There is none, or there are several.
    """
    cases = all_cases()
    matches = [c for full, c in cases.items() if name in (full, full.rpartition("/")[2])]
    if len(matches) != 1:
        raise InputError(
            f"case {name!r} is {'ambiguous' if matches else 'unknown'}: "
            f"use one of {', '.join(cases)}"
        )
    return matches[0]


def run_case(
    case: Case,
    out: Path,
    settings: Mapping[str, Any] | None = None,
    quick: bool = False,
    report: Callable[[str], None] = lambda step: None,
) -> Results:
    """Run a case and write its result folder: results.json, report.html and what else it makes.

    Everything is written to a hidden folder beside ``out`` first, so that a run that fails or is
    stopped leaves what was there before.

    Parameters
    ----------
    case
        What to run.
    out
        The result folder. It must not exist, be empty, or hold the results of an earlier run.
    settings, quick, report
        See `Run`.

    Raises
    ------
    InputError
        The settings are wrong, or ``out`` cannot be written or holds something else.
    """
    from fe_drivetrain.report import write_page

    out = Path(out)
    _check_folder(out)
    try:
        out.parent.mkdir(parents=True, exist_ok=True)
        folder = Path(tempfile.mkdtemp(prefix=f".{out.name}-", dir=out.parent))
    except OSError as error:
        raise InputError(
            f"cannot write to {out.parent}: {error.strerror}: give a writable folder with --out"
        ) from error
    try:
        run = Run(settings or {}, quick, folder, report)
        results = case.run(run)
        with run.step("report"):
            (folder / "results.json").write_text(results.model_dump_json(indent=1), "utf-8")
            write_page(folder)
        folder.chmod(0o755)
        _replace(folder, out)
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    return results


def _check_folder(out: Path) -> None:
    if not out.exists():
        return
    if not out.is_dir():
        raise InputError(f"--out {out} is a file: give a folder")
    if any(out.iterdir()) and not (out / "results.json").exists():
        raise InputError(
            f"--out {out} holds files that are not results of a case: give a new or empty folder"
        )


def _replace(folder: Path, out: Path) -> None:
    """Put a finished folder in the place of an older one."""
    old = Path(tempfile.mkdtemp(prefix=f".{out.name}-old-", dir=out.parent))
    try:
        try:
            if out.exists():
                os.rename(out, old / "results")
            os.rename(folder, out)
        finally:
            # whatever went wrong, Ctrl-C between the two included
            if not out.exists() and (old / "results").exists():
                os.rename(old / "results", out)
    except OSError as error:
        raise InputError(
            f"cannot write {out}: {error.strerror}: give a writable folder with --out"
        ) from error
    finally:
        shutil.rmtree(old, ignore_errors=True)
