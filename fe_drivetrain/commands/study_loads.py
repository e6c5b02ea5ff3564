"""Hub loads of a study: the user's files, or the surrogate's."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import GRAVITY
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.compare.time_weighted import sample_weights
from fe_drivetrain.hub_loads.aero_rotor import assumptions
from fe_drivetrain.hub_loads.channel_map import ChannelMap
from fe_drivetrain.hub_loads.files import read_hub_load_files, read_hub_loads
from fe_drivetrain.hub_loads.histories import LoadHistory
from fe_drivetrain.hub_loads.recorded import read_mapped
from fe_drivetrain.hub_loads.surrogate import hub_load_set, surrogate_grid
from fe_drivetrain.hub_loads.turbines import different_turbines, vertical_forces
from fe_drivetrain.response.entering import at_front
from fe_drivetrain.scene.scene import Scene
from fe_drivetrain.suite.run import Run

_QUICK_SEEDS = 1


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
    """

    histories: Sequence[LoadHistory]
    statement: str
    own: bool
    assumptions: Sequence[tuple[str, float, str, str]] = field(default_factory=tuple)
    gravity: float = GRAVITY

    @property
    def seconds(self) -> float:
        """How long all last together [s]."""
        return sum(history.seconds for history in self.histories)

    @property
    def weights(self) -> Floats:
        """(n,) of all samples, one history after the other: each by the time that it lasts."""
        histories = self.histories
        return sample_weights([len(h) for h in histories], [h.step for h in histories])


def own_loads(
    patterns: str | Sequence[str], skip: float, scene: Scene, mapping: ChannelMap | None = None
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
    mapping : ChannelMap, optional
        How files of other programs call their channels, and their frame and origin.

    Raises
    ------
    InputError
        A file cannot be read, or all loads are zero.
    """
    front, at = scene.shaft.front, scene.loads_at
    read = read_hub_loads if mapping is None else partial(read_mapped, mapping)
    found = read_hub_load_files(patterns, skip, read)
    histories = [at_front(scene, history) for history in found]
    moved = f" Their moments, about x = {at:g} m, are moved to the front face." * (at != front)
    if not any(history.loads.any() for history in histories):
        raise InputError(f"--loads {patterns!r}: all hub loads are zero: give histories with loads")
    unlike = different_turbines(vertical_forces(histories))
    count, samples = len(histories), sum(map(len, histories))
    seconds = sum(history.seconds for history in histories)
    return StudyLoads(
        histories,
        f"Hub loads: {count} file{'s' if count > 1 else ''} of your own, {samples:,} load steps "
        f"over {seconds:,.6g} s"
        + (f"; the first {skip:g} s of each are left out." if skip else ".")
        + moved
        + (f" {unlike}" if unlike else ""),
        True,
    )


def surrogate_loads(run: Run) -> StudyLoads:
    """The surrogate's histories; under ``--quick`` those of one seed.

    Parameters
    ----------
    run : Run
        The run that this is a step of.
    """
    grid = [c for c in surrogate_grid() if not run.quick or c.seed <= _QUICK_SEEDS]
    with run.step("hub loads"):
        found = hub_load_set(
            grid, progress=lambda done, of: run.report(f"hub loads ({done} of {of})")
        )
    return StudyLoads(
        list(found),
        f"Hub loads are a surrogate, not those of your turbine: {len(grid)} ten-minute histories "
        "of a generic 2 MW, 80 m rotor in turbulent wind. Give your own with --loads.",
        False,
        list(assumptions()),
    )
