"""Peaks of torques against the limits that a drivetrain's file states."""

from __future__ import annotations

from collections.abc import Mapping

from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.scene import Scene, main_shaft
from fe_drivetrain.report.answer import KeyFigure
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.studies.transient_runs import Extreme

BY = "limit of the file"
"""Whose limit it is."""

_TORQUE = "torque of "


def torque_limits(drivetrain: Drivetrain, extremes: Mapping[str, Extreme]) -> dict[str, float]:
    """Limits of channels that are torques of shafts, by channel [N m].

    Parameters
    ----------
    drivetrain : Drivetrain
        Its file states them.
    extremes : Mapping[str, Extreme]
        Extremes by channel.
    """
    found = {}
    for name in extremes:
        limit = drivetrain.peak_torque(name.removeprefix(_TORQUE))
        if name.startswith(_TORQUE) and limit is not None:
            found[name] = limit
    return found


def hardest_limit(limits: Mapping[str, float], extremes: Mapping[str, Extreme]) -> str | None:
    """Channel whose peak comes nearest to its limit, or is farthest beyond; None without limits."""
    return max(limits, key=lambda name: extremes[name].largest / limits[name], default=None)


def limit_figure(
    found: Findings, limits: Mapping[str, float], extremes: Mapping[str, Extreme]
) -> list[KeyFigure]:
    """The peak of the torque that is nearest to its limit, with that; empty without limits.

    Parameters
    ----------
    found : Findings
        Makes the figure.
    limits : Mapping[str, float]
        Limits by channel [N m].
    extremes : Mapping[str, Extreme]
        Extremes by channel.
    """
    name = hardest_limit(limits, extremes)
    if name is None:
        return []
    one = extremes[name]
    band = max((b for b in (one.most_band, one.least_band) if b is not None), default=None)
    return [
        found.value(
            f"peak {name} [kN m]",
            one.largest / 1e3,
            None if band is None else band / 1e3,
            at_most=limits[name] / 1e3,
            by=BY,
        )
    ]


def note_limits(
    found: Findings, limits: Mapping[str, float], extremes: Mapping[str, Extreme]
) -> None:
    """State which torques pass their limits, first of all notes.

    Parameters
    ----------
    found : Findings
        Takes the note.
    limits : Mapping[str, float]
        Limits by channel [N m].
    extremes : Mapping[str, Extreme]
        Extremes by channel.
    """
    beyond = [
        f"{name} {value_text(extremes[name].largest / 1e3, 'kN m')} of "
        f"{value_text(limit / 1e3, 'kN m')}"
        for name, limit in limits.items()
        if extremes[name].largest > limit
    ]
    if beyond:
        found.note(
            f"Beyond limits of the file: {', '.join(beyond)}. A torque limiter would slip there, "
            "which is not modelled.",
            first=True,
        )


def limit_of_histories(scene: Scene | None, shaft: str) -> float | None:
    """Limit of the torque that histories have, that of the rotor or of the generator [N m].

    Parameters
    ----------
    scene : Scene or None
        Its file states limits.
    shaft : str
        What the torque is of: "generator", or empty of the rotor.
    """
    if scene is None:
        return None
    shafts = scene.gearbox.shafts
    if shaft:
        return scene.peak_torque(shafts[-1].name) if shafts and shaft == "generator" else None
    return scene.peak_torque(main_shaft(scene).name)
