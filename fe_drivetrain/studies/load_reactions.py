"""Digests of files with the reactions of a scene to their loads, and how they are kept."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.cache import user_cache
from fe_drivetrain.common.components import GRAVITY
from fe_drivetrain.common.errors import require_known
from fe_drivetrain.common.jobs import mapped
from fe_drivetrain.common.progress import Progress
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.shafts.fidelity.ladder import LevelModel, assembly_level, shaft_level
from fe_drivetrain.shafts.fidelity.over_loads import ROUND_OFF, reaction_history
from fe_drivetrain.shafts.response.cached import whole_content
from fe_drivetrain.shafts.response.entering import entering
from fe_drivetrain.shafts.response.stated import Stated, stated_reactions
from fe_drivetrain.studies.load_digest import LOADS, Digest, LoadOptions, digest
from fe_drivetrain.turbine_loads.hub_loads.histories import LoadHistory
from fe_drivetrain.turbine_loads.hub_loads.recorded import Recorded, read_recorded

ALONE = "Fx"
"""Load under which a digest has another channel of the files, which is no vector; all else is
zero."""

_MANY = 8  # files for which it pays to start processes


@dataclass(frozen=True, eq=False)
class SceneReactions:
    """Reactions of a scene to hub loads, all weights included.

    Attributes
    ----------
    scene : Scene
        The scene.
    model : LevelModel
        What solved it for unit loads.
    """

    scene: Scene
    model: LevelModel

    @property
    def names(self) -> list[str]:
        """Names of bearings, and "gearbox"; without those that hold nothing."""
        return [name for name, R in self.model.reaction_matrices.items() if np.nan_to_num(R).any()]

    @property
    def stated(self) -> Stated:
        """What the reactions are."""
        mass = sum(float(R[2, 8]) for R in self.model.reaction_matrices.values())
        return stated_reactions(self.scene, {"shaft, rings and housings": mass})

    def content(self) -> dict[str, Any]:
        """All that reactions depend on."""
        return {"scene": whole_content(self.scene), "level": self.model.level}

    def of(self, history: LoadHistory) -> dict[str, Floats]:
        """Each reaction to a history, (n, 6) [N, N m], moments about the bearing's centre.

        Parameters
        ----------
        history : LoadHistory
            Its moments are about the point that the scene states.

        Raises
        ------
        InputError
            It has loads at a point that the scene does not have.
        """
        driving, weight = entering(self.scene, history), self.scene.gearbox.weight
        found = {n: reaction_history(self.model, n, driving, weight, GRAVITY) for n in self.names}
        size = max(float(np.abs(values).max()) for values in found.values())
        # what a support does not hold is round-off, and no load
        return {n: np.where(np.abs(v).max(0) > ROUND_OFF * size, v, 0.0) for n, v in found.items()}


def scene_reactions(scene: Scene, level: int) -> SceneReactions:
    """Solve a scene for unit loads.

    Parameters
    ----------
    scene : Scene
        The scene.
    level : int
        1, a beam on rigid housings; 4, the assembly of solids.

    Raises
    ------
    InputError
        There is no such level, or the scene cannot be solved.
    """
    require_known("level of reactions to load histories", level, (1, 4))
    return SceneReactions(scene, shaft_level(scene, 1) if level == 1 else assembly_level(scene))


@dataclass(frozen=True, eq=False)
class FileDigest:
    """All of one file.

    Attributes
    ----------
    hub : Digest
        Hub loads.
    reactions : Mapping[str, Digest]
        Each reaction of a scene to them, by name; empty where components are absent.
    others : Mapping[str, Digest]
        Each other channel, by name and unit, as the load `ALONE`.
    """

    hub: Digest
    reactions: Mapping[str, Digest] = field(default_factory=dict)
    others: Mapping[str, Digest] = field(default_factory=dict)


def file_digest(
    found: Recorded, options: LoadOptions, reactions: SceneReactions | None = None
) -> FileDigest:
    """The digest of a file, those of each reaction to it, and of other channels.

    Parameters
    ----------
    found : Recorded
        The history.
    options : LoadOptions
        How it is counted.
    reactions : SceneReactions, optional
        Reactions of a scene.
    """

    def beside(loads: Floats, options: LoadOptions) -> Digest:
        own = found.history
        history = LoadHistory(own.name, own.time, loads, measured=own.measured)
        return digest(Recorded(history, found.rotor_speed, found.wind_speed), options)

    whole = not found.history.absent and not found.history.torque_of
    of_scene = reactions.of(found.history) if reactions is not None and whole else {}
    plain = replace(options, ultimate={})
    others = {}
    for name, values in found.others.items():
        alone = np.zeros_like(found.history.loads)
        alone[:, LOADS.index(ALONE)] = values
        others[name] = beside(alone, plain)
    return FileDigest(
        digest(found, options),
        {name: beside(loads, options) for name, loads in of_scene.items()},
        others,
    )


def kept_digest(
    _report: Progress,
    file: Path,
    options: LoadOptions,
    resume: bool,
    reactions: SceneReactions | None = None,
) -> FileDigest:
    """The digest of a file, or that of an earlier run where it is kept and asked for.

    Parameters
    ----------
    _report : callable
        Report of a job in a process; what takes this long shows no steps.
    file : Path
        The file with the history.
    options : LoadOptions
        How it is counted.
    resume : bool
        Take what is kept.
    reactions : SceneReactions, optional
        Reactions of a scene.

    Raises
    ------
    InputError
        The file cannot be read.
    """
    cache, content = user_cache(), options.content(file)
    if reactions is not None:
        content |= {"reactions": reactions.content()}
    if resume:
        kept = cache.load_record("load-digests", content, FileDigest)
        if kept is not None:
            return kept
    recorded = read_recorded(file, options.names, options.skip, options.also, True)
    found = file_digest(recorded, options, reactions)
    cache.keep_record("load-digests", content, found)
    return found


def digests(
    files: Sequence[Path],
    options: LoadOptions,
    resume: bool,
    step: str,
    report: Progress,
    reactions: SceneReactions | None = None,
) -> Iterator[tuple[Path, FileDigest]]:
    """Digests file by file, several at a time where there are cores; each kept once it is done.

    Parameters
    ----------
    files : sequence of Path
        Histories.
    options : LoadOptions
        How they are counted.
    resume : bool
        Take digests that an earlier run kept.
    step : str
        What the files are called as they are counted.
    report : Progress
        Called with it and the number of each file.
    reactions : SceneReactions, optional
        Reactions of a scene.
    """
    items = ((file, options, resume, reactions) for file in files)
    made = mapped(kept_digest, items, len(files) if len(files) >= _MANY else 1, report)
    for number, file in enumerate(files, 1):
        report(f"{step} ({number} of {len(files)})")
        yield file, next(made)
