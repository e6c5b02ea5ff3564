"""One run of a case: its settings and folder, a clock for each step, and work done side by side."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import Future
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, Concatenate, Generic, ParamSpec, TypeVar

import numpy as np

from fe_drivetrain.common.cache import user_cache
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.jobs import Pool, pool
from fe_drivetrain.common.progress import Progress, silent
from fe_drivetrain.common.provenance import arithmetic, program_hash
from fe_drivetrain.common.steps import Clock

if TYPE_CHECKING:
    from fe_drivetrain.common.arrays import Floats
    from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
    from fe_drivetrain.elasticity.mesh.blocks import Block
    from fe_drivetrain.geometry.shaft import Shaft
    from fe_drivetrain.report.pictures.sketch import Body, Faces
    from fe_drivetrain.report.results import Image, Solid
    from fe_drivetrain.report.suite.chosen import ChosenDrivetrain
    from fe_drivetrain.report.suite.findings import Found

_P = ParamSpec("_P")
_T = TypeVar("_T")


@dataclass
class Run(Clock):
    """One run of a case: what the user asked for, where files go, and a clock for each step.

    Attributes
    ----------
    settings : mapping
        The user's ``--set key=value``, values parsed as YAML scalars.
    quick : bool
        Coarser and smaller, for a first look.
    folder : Path
        Where the case may put files beside its results; it becomes the result folder.
    report : callable
        Called with the name of each step as it begins.
    times : dict
        Wall time of each finished step [s]. Steps side by side count each for itself; what that
        saved stands among them as a negative time, so that they add up to the time that passed.
    """

    settings: Mapping[str, Any]
    quick: bool
    folder: Path
    report: Progress = silent
    times: dict[str, float] = field(default_factory=dict)

    def kept(self, content: Mapping[str, Any], work: Callable[[], _T]) -> _T:
        """What the work returns, or what it returned before: a stopped run goes on where it was.

        Parameters
        ----------
        content : mapping
            All that the work depends on beside this program, as plain data.
        work : callable
            Returns plain data that JSON can hold. It is called where the user's cache has nothing
            of this content, made by the same program with the same arithmetic.

        Returns
        -------
        object
            The data, floats to their last digit, tuples as lists.
        """
        cache = user_cache()
        made_by = {"code": program_hash(), "arithmetic": arithmetic()}
        full = {"content": content, "made by": made_by}
        before = cache.load("figures", full)
        if before is None:
            before = {"figures": np.array(json.dumps(work()))}
            cache.keep("figures", full, before)
        found: _T = json.loads(str(before["figures"]))
        return found

    def count(self, key: str, default: int, least: int = 1) -> int:
        """A setting that is a whole number.

        Parameters
        ----------
        key : str
            Its name.
        default : int
            What it is where the user does not say.
        least : int
            The smallest that makes sense.

        Returns
        -------
        int

        Raises
        ------
        InputError
            It is no whole number, or less than that.
        """
        value = self.settings.get(key, default)
        number = not isinstance(value, bool) and isinstance(value, int | float)
        if not number or not least <= value < np.inf or value != int(value):
            raise InputError(
                f"{key} = {value!r} must be a whole number from {least} on, as in {key}={default}"
            )
        return int(value)

    def positive(self, key: str, default: float | None = None) -> float:
        """A setting that is a number above 0.

        Parameters
        ----------
        key : str
            Its name.
        default : float, optional
            What it is where the user does not say; without one he has to.

        Returns
        -------
        float

        Raises
        ------
        InputError
            It is no number above 0, or is not given.
        """
        value = self.settings.get(key, default)
        example = 10 if default is None else default
        if value is None:
            raise InputError(f"{key} has to be given for this machine, as in --set {key}={example}")
        number = not isinstance(value, bool) and isinstance(value, int | float)
        if not number or not 0.0 < value < np.inf:
            raise InputError(f"{key} = {value!r} must be a number above 0, as in {key}={example:g}")
        return float(value)

    def drivetrain(self, default: str | Drivetrain, gears: bool = False) -> ChosenDrivetrain:
        """The drivetrain that the user names by ``--set drivetrain=FILE``, or the case's own.

        Parameters
        ----------
        default : str or Drivetrain
            The case's own, by its name in the library or as read.
        gears : bool
            Whether the case is about gears, so that a direct drive is refused.

        Raises
        ------
        InputError
            There is no such drivetrain, it is wrong, or it has no gears.
        """
        from fe_drivetrain.report.suite.chosen import SETTING, chosen_drivetrain

        return chosen_drivetrain(self.settings.get(SETTING), default, gears)

    def sketch(self, *bodies: Body | Shaft | list[Faces], file: str = "model.png") -> str:
        """Write a small picture of bodies, as meshed, shafts or surfaces; its name for a page."""
        # with its meshes come scikit-fem and SciPy, for which every process of cases would wait
        from fe_drivetrain.report.pictures.sketch import sketch

        (self.folder / file).write_bytes(sketch(*bodies))
        return file

    def view(
        self,
        caption: str,
        part: tuple[str, Block, tuple[float, float]],
        fields: Mapping[str, Floats],
        still: str,
    ) -> Solid | Image:
        """A body as it is bent, to be turned in the browser, beside a picture of it.

        Parameters
        ----------
        caption : str
            Of either.
        part : tuple
            The body's name, its mesh, and Lame's constants of its material [Pa].
        fields : mapping
            Name of each load, and displacements (n, 3) [m] under it.
        still : str
            File of the picture, as of `sketch`.
        """
        from fe_drivetrain.report.solid_view import Parts, solid_or_picture

        name, block, lame = part
        body = Parts(block.points, {name: block.cells})
        return solid_or_picture(caption, body, fields, {name: lame}, self.folder, still)

    def take(self, found: Found) -> None:
        """Count the steps of a study among those of the run."""
        self.add_times(found.times)

    @contextmanager
    def side_by_side(self, jobs: int) -> Iterator[Jobs]:
        """Do independent work in processes, or on a cluster; see `pool`.

        Parameters
        ----------
        jobs : int
            How many may run at once on this machine.
        """
        start, before = time.perf_counter(), sum(self.times.values())
        with pool(jobs, self.report) as workers:
            yield Jobs(self, workers)
        if workers.count:
            passed = time.perf_counter() - start
            counted = sum(self.times.values()) - before
            self.add_time(f"side by side in {workers.count} processes", passed - counted)


class Jobs:
    """Work of a run that is done side by side."""

    def __init__(self, run: Run, workers: Pool) -> None:
        self._run = run
        self._workers = workers

    def start(
        self, function: Callable[Concatenate[Run, _P], _T], *args: _P.args, **kwargs: _P.kwargs
    ) -> RunJob[_T]:
        """Hand in ``function(run, ...)``, with a run of its own that has this one's folder.

        The function stands in a module that can be imported; what it is given, and what it returns,
        can be pickled.
        """
        run = self._run
        job = self._workers.start(
            _with_own_run, function, dict(run.settings), run.quick, run.folder, args, kwargs
        )
        return RunJob(job, run, bool(self._workers.count))


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
        self._run.add_times(times)
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
