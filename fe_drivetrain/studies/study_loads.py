"""Hub loads of a study: the user's files, or the surrogate's."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.cache import user_cache
from fe_drivetrain.common.components import GRAVITY
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.steps import Clock
from fe_drivetrain.comparison.time_weighted import sample_weights
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.shafts.response.entering import at_front, entering, joined
from fe_drivetrain.turbine_loads.hub_loads.aero_rotor import assumptions
from fe_drivetrain.turbine_loads.hub_loads.channel_map import ChannelMap
from fe_drivetrain.turbine_loads.hub_loads.files import read_hub_load_files, read_hub_loads
from fe_drivetrain.turbine_loads.hub_loads.histories import LoadHistory, require_even
from fe_drivetrain.turbine_loads.hub_loads.point_loads import PointLoads
from fe_drivetrain.turbine_loads.hub_loads.recorded import Files, read_mapped
from fe_drivetrain.turbine_loads.hub_loads.surrogate import (
    Condition,
    HubLoadSet,
    hub_load_set,
    not_kept,
    surrogate_grid,
)
from fe_drivetrain.turbine_loads.hub_loads.turbines import different_turbines, vertical_forces

_NAMES = (str, os.PathLike)
"""Types of what names a file."""


@dataclass(frozen=True)
class StudyLoads:
    """Hub-load histories, and what they are.

    Attributes
    ----------
    histories : Sequence[LoadHistory]
        One or more, each with its own time.
    statement : str
        What they are, as a sentence.
    own : bool
        Whether they are the user's.
    assumptions : Sequence[tuple[str, float, str, str]]
        Name, value, unit and source of what a surrogate assumes.
    gravity : float
        Along -z, that gives all parts their weight [m/s^2]; 0 where weights are left out.
    skip : float
        Time that was left out at the beginning of each [s].
    seeds : tuple of int
        Seeds of made wind, which the program fixes; none of histories of the user.
    caution : str
        What does not belong together among them; empty where nothing does.
    """

    histories: Sequence[LoadHistory]
    statement: str
    own: bool
    assumptions: Sequence[tuple[str, float, str, str]] = field(default_factory=tuple)
    gravity: float = GRAVITY
    skip: float = 0.0
    seeds: tuple[int, ...] = ()
    caution: str = ""

    def asked(self) -> dict[str, Any]:
        """What they are, as plain data."""
        return {
            "loads": self.statement,
            "histories": [history.name for history in self.histories],
            "skip": self.skip,
            "seeds of the loads": list(self.seeds),
        }

    @property
    def seconds(self) -> float:
        """How long all last together [s]."""
        return sum(history.seconds for history in self.histories)

    @property
    def weights(self) -> Floats:
        """(n,) of all samples, one history after the other: each by the time that it lasts."""
        histories = self.histories
        return sample_weights([len(h) for h in histories], [h.step for h in histories])

    def entering(self, scene: Scene) -> EnteredLoads:
        """The loads as they enter a scene, with the loads and weights at its load points."""
        each = tuple(entering(scene, history) for history in self.histories)
        return EnteredLoads(self, each, joined(each))


@dataclass(frozen=True, eq=False)
class EnteredLoads:
    """Hub loads as they enter a scene.

    Attributes
    ----------
    given : StudyLoads
        What they are.
    each : tuple of PointLoads
        Each history.
    together : PointLoads
        All of them, one after the other.
    """

    given: StudyLoads
    each: tuple[PointLoads, ...]
    together: PointLoads


def own_loads(
    patterns: str | Sequence[str], skip: float, scene: Scene, channels: ChannelMap | None = None
) -> StudyLoads:
    """Read the user's files.

    Parameters
    ----------
    patterns : str or sequence of str
        Files, folders, or patterns; a file that several find counts once.
    skip : float
        What is left out at the beginning of each file [s].
    scene : Scene
        Says which point of the shaft they are about.
    channels : ChannelMap, optional
        How files of other programs call their channels, and their frame and origin.

    Raises
    ------
    InputError
        A file cannot be read, or all loads are zero.
    """
    read = read_hub_loads if channels is None else partial(read_mapped, channels)
    histories = read_hub_load_files(patterns, skip, read)
    return _of_the_user(histories, scene, argument("loads", patterns), ("file", "files"), skip)


def given_loads(histories: Sequence[LoadHistory] | Files, scene: Scene) -> StudyLoads:
    """The user's histories, about the shaft's front face.

    Parameters
    ----------
    histories : sequence of LoadHistory, or files
        One or more, of any length and step; or files, folders and patterns of these.
    scene : Scene
        States which point of the shaft they are about.

    Raises
    ------
    InputError
        There is none, or all loads are zero.
    """
    if not histories:
        raise InputError("there is no load history to study: give one or more, or None")
    several: list[Any] = [histories] if isinstance(histories, _NAMES) else [*histories]
    if all(isinstance(one, _NAMES) for one in several):
        return own_loads([os.fspath(one) for one in several], 0.0, scene)
    return _of_the_user(several, scene, argument("loads"), ("history", "histories"))


def _of_the_user(
    found: Sequence[LoadHistory],
    scene: Scene,
    source: str,
    words: tuple[str, str],
    skip: float = 0.0,
) -> StudyLoads:
    """Histories at the front face, and a sentence on them."""
    for history in found:
        require_even(history)
    histories = [at_front(scene, history) for history in found]
    if not any(history.loads.any() for history in histories):
        raise InputError(f"{source}: all hub loads are zero: give histories with loads")
    moved = scene.loads_at != scene.shaft.front
    about = f" Their moments, about x = {scene.loads_at:g} m, are moved to the front face." * moved
    unlike = different_turbines(vertical_forces(histories))
    count, samples = len(histories), sum(map(len, histories))
    seconds = sum(history.seconds for history in histories)
    return StudyLoads(
        histories,
        f"Hub loads: {count} {words[count > 1]} of your own, {samples:,} load steps "
        f"over {seconds:,.6g} s"
        + (f"; the first {skip:g} s of each are left out." if skip else ".")
        + about,
        True,
        skip=skip,
        caution=unlike,
    )


def surrogate_loads(steps: Clock, seeds: int | None = None) -> StudyLoads:
    """The surrogate's histories.

    Parameters
    ----------
    steps : Clock
        Times the step in which they are made.
    seeds : int, optional
        How many histories of each wind there are; all six where not given.
    """
    conditions = surrogate_conditions(seeds)
    found = surrogate_set(steps, conditions)
    return StudyLoads(
        list(found),
        f"{surrogate_statement(len(found))} Give your own with {argument('loads')}.",
        False,
        list(assumptions()),
        seeds=tuple(sorted({condition.seed for condition in conditions})),
    )


def surrogate_conditions(seeds: int | None = None) -> list[Condition]:
    """Winds of the surrogate's histories.

    Parameters
    ----------
    seeds : int, optional
        How many histories of each wind there are; all six where not given.
    """
    return [c for c in surrogate_grid() if seeds is None or c.seed <= seeds]


def surrogate_set(steps: Clock, conditions: Sequence[Condition]) -> HubLoadSet:
    """The surrogate's histories in one array, with their winds.

    Parameters
    ----------
    steps : Clock
        Times the step in which they are made, or taken from the cache.
    conditions : sequence of Condition
        Winds, see `surrogate_conditions`.
    """
    with steps.step("hub loads") as step:
        if user_cache().folder is not None and not not_kept(conditions):
            step.name += ", from the cache"
        return hub_load_set(
            conditions, progress=lambda done, of: steps.report(f"hub loads ({done} of {of})")
        )


def surrogate_statement(count: int) -> str:
    """What the surrogate's histories are, as a sentence.

    Parameters
    ----------
    count : int
        Number of histories.
    """
    return (
        f"Hub loads are a surrogate, not those of your turbine: {count} ten-minute histories "
        "of a generic 2 MW, 80 m rotor in turbulent wind."
    )
