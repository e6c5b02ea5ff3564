"""What a validation case is, and how one is run into a folder that appears whole or not at all."""

from __future__ import annotations

import ast
import importlib
import importlib.util
import pkgutil
import re
import time
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Future
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Concatenate, Generic, ParamSpec, TypeVar

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.files import HiddenFolder
from fe_drivetrain.common.processes import Processes
from fe_drivetrain.common.progress import Progress, silent

if TYPE_CHECKING:
    from fe_drivetrain.report.results import Results
    from fe_drivetrain.suite.page import Page

_P = ParamSpec("_P")
_T = TypeVar("_T")


@dataclass
class Step:
    """A step as it runs; its time is kept under the name that it has at its end."""

    name: str


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
        Wall time of each finished step [s]. Steps side by side count each for itself; what that
        saved stands among them as a negative time, so that they add up to the time that passed.
    """

    settings: Mapping[str, Any]
    quick: bool
    folder: Path
    report: Progress = silent
    times: dict[str, float] = field(default_factory=dict)

    @contextmanager
    def step(self, name: str) -> Iterator[Step]:
        """Show a step while it runs, and add its wall time to `times`."""
        self.report(name)
        step = Step(name)
        start = time.perf_counter()
        yield step
        self.add_time(step.name, time.perf_counter() - start)

    def timed(
        self, name: str, function: Callable[_P, _T], *args: _P.args, **kwargs: _P.kwargs
    ) -> _T:
        """What the function returns, called as a step of that name."""
        with self.step(name):
            return function(*args, **kwargs)

    def add_time(self, name: str, seconds: float) -> None:
        """Add to the wall time of a step."""
        self.times[name] = self.times.get(name, 0.0) + seconds

    @contextmanager
    def side_by_side(self, jobs: int) -> Iterator[Jobs]:
        """Do independent work in processes, as many as the cores allow; see `Processes`.

        Parameters
        ----------
        jobs
            How many may run at once.
        """
        start, before = time.perf_counter(), sum(self.times.values())
        with Processes(jobs, self.report) as processes:
            yield Jobs(self, processes)
        if processes.count:
            passed = time.perf_counter() - start
            counted = sum(self.times.values()) - before
            self.add_time(f"side by side in {processes.count} processes", passed - counted)


class Jobs:
    """Work of a run that is done side by side."""

    def __init__(self, run: Run, processes: Processes) -> None:
        self._run = run
        self._processes = processes

    def start(
        self, function: Callable[Concatenate[Run, _P], _T], *args: _P.args, **kwargs: _P.kwargs
    ) -> RunJob[_T]:
        """Hand in ``function(run, ...)``, with a run of its own that has this one's folder.

        The function stands in a module that can be imported; what it is given, and what it returns,
        can be pickled.
        """
        run = self._run
        job = self._processes.start(
            _with_own_run, function, dict(run.settings), run.quick, run.folder, args, kwargs
        )
        return RunJob(job, run, bool(self._processes.count))


class RunJob(Generic[_T]):
    """One such piece of work."""

    def __init__(self, job: Future[tuple[_T, dict[str, float]]], run: Run, elsewhere: bool) -> None:
        self._job = job
        self._run = run
        self._elsewhere = elsewhere

    def result(self) -> _T:
        """What the function returned; its times are then among those of the run.

        Raises
        ------
        Exception
            What this or any other piece of the work raised.
        """
        if self._elsewhere:
            self._run.report("")  # this process only waits
        result, times = self._job.result()
        for name, seconds in times.items():
            self._run.add_time(name, seconds)
        return result


def _with_own_run(
    report: Progress,
    function: Callable[..., _T],
    settings: Mapping[str, Any],
    quick: bool,
    folder: Path,
    args: tuple[Any, ...],
    kwargs: dict[str, Any],
) -> tuple[_T, dict[str, float]]:
    run = Run(settings, quick, folder, report)
    return function(run, *args, **kwargs), run.times


@dataclass(frozen=True)
class OldCase:
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
    alone
        It measures time or memory: nothing may run beside it, and nothing it uses comes from the
        cache.
    """

    name: str
    title: str
    source: str
    run: Callable[[Run], Results]
    alone: bool = False

    def results(self, run: Run, *, seed: int | None = 0, **found: Any) -> Results:
        """What a run of this case found.

        Parameters
        ----------
        run
            The run: its times and settings.
        seed
            Of random numbers.
        found
            ``summary``, ``verdicts``, ``sections``, and where there are any ``figures``, ``limits``
            and ``assumptions``; see `fe_drivetrain.report.results.Results`.
        """
        from fe_drivetrain.report.environment import environment
        from fe_drivetrain.report.results import Results

        return Results(
            case=self.name,
            title=self.title,
            source=self.source,
            times=run.times,
            environment=environment(run.settings, seed),
            **found,
        )


@dataclass(frozen=True)
class Case:
    """A validation case: it describes, runs and judges.

    Attributes
    ----------
    name : str
        "GROUP/NAME", as under ``cases/``.
    title : str
        One line.
    source : str
        Where the problem and its reference come from.
    run : callable
        Does the work: takes a `Run` and fills a `Page`.
    alone : bool
        It measures time or memory: nothing may run beside it, and nothing it uses comes from the
        cache.
    """

    name: str
    title: str
    source: str
    run: Callable[[Run, Page], None]
    alone: bool = False

    def results(self, run: Run) -> Results:
        """Run the case; what it found."""
        from fe_drivetrain.report.environment import environment
        from fe_drivetrain.report.results import Results
        from fe_drivetrain.suite.page import Page

        page = Page()
        self.run(run, page)
        return Results(
            case=self.name,
            title=self.title,
            source=self.source,
            summary=page.summary,
            verdicts=page.verdicts,
            sections=page.sections,
            limits=page.limits,
            assumptions=page.assumptions,
            times=run.times,
            figures=page.figures,
            environment=environment(run.settings, page.seed),
        )


AnyCase = Case | OldCase


def all_cases() -> dict[str, AnyCase]:
    """Every case by name, in order.

    What a script declares is read from its source: importing all of them, and the solvers with
    them, would take many times as long as a list may.
    """
    package = "fe_drivetrain.cases"  # found by its name: the suite does not build on the cases
    spec = importlib.util.find_spec(package)
    places = list(spec.submodule_search_locations or ()) if spec else []
    found: dict[str, AnyCase] = {}
    for info in pkgutil.walk_packages(places, package + "."):
        if not info.ispkg:
            for case in _declared_in(info.name):
                found[case.name] = case
            if _states_a_case(info.name):
                module = importlib.import_module(info.name)
                found[module.CASE.name] = module.CASE
    return dict(sorted(found.items()))


_DECLARATION = re.compile(r"^@(cases?)\((.*?)\)\ndef (\w+)\(", re.MULTILINE | re.DOTALL)


def _declared_in(module: str) -> list[Case]:
    """The cases that a module declares, without importing it."""
    spec = importlib.util.find_spec(module)
    if spec is None or spec.origin is None:
        return []
    file = Path(spec.origin)
    declaration = _DECLARATION.search(file.read_text(encoding="utf-8"))
    if declaration is None:
        return []
    kind, call, function = declaration.groups()
    *_, group, name = module.split(".")
    arguments = ast.parse(f"f({call})", mode="eval").body
    assert isinstance(arguments, ast.Call)
    (first,) = [ast.literal_eval(value) for value in arguments.args]
    named = {str(key.arg): ast.literal_eval(key.value) for key in arguments.keywords}
    if kind == "case":
        run = partial(_run_declared, module, function)
        return [Case(f"{group}/{name}", first, run=run, **named)]
    import yaml

    from fe_drivetrain.common.strict_yaml import PlainLoader

    rows = yaml.load(file.with_name(first).read_text(encoding="utf-8"), Loader=PlainLoader)
    return [
        Case(
            f"{group}/{key}",
            row["title"],
            row["source"],
            partial(_run_declared, module, function, row=row),
            row.get("alone", False),
        )
        for key, row in rows.items()
    ]


def _run_declared(module: str, function: str, run: Run, page: Page, **more: Any) -> None:
    getattr(importlib.import_module(module), function)(run, page, **more)


def _states_a_case(module: str) -> bool:
    """Whether the source of a module has a ``CASE``, found without importing it."""
    found = importlib.util.find_spec(module)
    source = getattr(found.loader, "get_source", lambda name: None)(module) if found else None
    return source is None or re.search(r"^CASE\b", source, re.MULTILINE) is not None


def find_cases(name: str) -> list[AnyCase]:
    """The case of that name, its last part being enough where it is unique; or a group's cases.

    Raises
    ------
    InputError
        There is none, or there are several.
    """
    cases = all_cases()
    group = [c for full, c in cases.items() if full.partition("/")[0] == name]
    if group:
        return group
    matches = [c for full, c in cases.items() if name in (full, full.rpartition("/")[2])]
    if len(matches) != 1:
        raise InputError(
            f"case {name!r} is {'ambiguous' if matches else 'unknown'}: "
            f"use one of {', '.join(cases)}"
        )
    return matches


def run_case(
    case: AnyCase,
    out: Path,
    settings: Mapping[str, Any] | None = None,
    quick: bool = False,
    report: Progress = silent,
) -> Results:
    """Run a case and write its result folder: results.json, report.html and what else it makes.

    Everything is written to a hidden folder beside ``out`` first, so that a run that fails or is
    stopped leaves what was there before. Of a run that was killed, the next one into the same place
    removes that folder.

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
    out = Path(out)
    folder = new_folder(out)
    try:
        results = run_into(case, folder.path, settings or {}, quick, report)
        put_in_place(folder, out)
    finally:
        folder.discard()
    return results


def run_into(
    case: AnyCase, folder: Path, settings: Mapping[str, Any], quick: bool, report: Progress
) -> Results:
    """Run a case and write its results and its page into a folder as it goes; see `run_case`."""
    from fe_drivetrain.common import cache
    from fe_drivetrain.report.page import write_page

    run = Run(settings, quick, folder, report)
    with cache.switched_off() if case.alone else nullcontext():
        results = case.run(run) if isinstance(case, OldCase) else case.results(run)
    with run.step("report"):
        (folder / "results.json").write_text(results.model_dump_json(indent=1), "utf-8")
        write_page(folder)
    return results


def new_folder(out: Path) -> HiddenFolder:
    """A hidden folder beside the result folder ``out``, for `put_in_place` when it is complete.

    Raises
    ------
    InputError
        ``out`` cannot be written or holds something else.
    """
    _check_folder(out)
    try:
        return HiddenFolder(out)
    except OSError as error:
        raise _not_writable(out.parent, error) from error


def _check_folder(out: Path) -> None:
    if not out.exists():
        return
    if not out.is_dir():
        raise InputError(f"--out {out} is a file: give a folder")
    if any(out.iterdir()) and not (out / "results.json").exists():
        raise InputError(
            f"--out {out} holds files that are not results of a case: give a new or empty folder"
        )


def put_in_place(folder: HiddenFolder, out: Path) -> None:
    """Put a complete folder of `new_folder` in the place of an older one."""
    try:
        folder.put_in_place()
    except OSError as error:
        raise _not_writable(out, error) from error


def _not_writable(where: Path, error: OSError) -> InputError:
    return InputError(
        f"cannot write to {where}: {error.strerror}: give a writable folder with --out"
    )
