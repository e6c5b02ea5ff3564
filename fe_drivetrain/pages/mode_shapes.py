"""Shapes of a drivetrain's modes, drawn obliquely from the side: at rest, swung out, and moving."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from fe_drivetrain.common.arrays import Floats, rounded
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.dynamics import Assembly, Body, Machine, assembly
from fe_drivetrain.report.chart_style import SWING
from fe_drivetrain.report.charts import chart
from fe_drivetrain.report.results import Chart
from fe_drivetrain.studies.drivetrain_modes import ModesResult

_CORNERS = 24  # of a circle
_OBLIQUE = np.array([[1.0, 0.35, 0.0], [0.0, 0.25, 1.0]])
_REACH = 0.3  # of the largest motion, over the largest radius
_REST, _MOVING, _ENVELOPE = "#9aa7b5", "#0072b2", "#e69f00"


@dataclass(frozen=True)
class Outline:
    """Lines of a drivetrain, each point on a body.

    Attributes
    ----------
    bodies : tuple[str, ...]
        Body (p,) that each point moves with.
    points : Floats
        Places (p, 3) of the points [m]; NaN between lines.
    arms : Floats
        Places (p, 3) against the centres of their bodies [m].
    gearing : Floats
        Speed (p,) of each point's body over the rotor's, 1 at least: turning is drawn over it.
    """

    bodies: tuple[str, ...]
    points: Floats
    arms: Floats
    gearing: Floats

    __repr__ = short_repr


def shape_charts(result: ModesResult, count: int) -> list[Chart]:
    """Charts of the first modes and the first torsional one, of which each can be set in motion.

    Parameters
    ----------
    result : ModesResult
        With shapes.
    count : int
        Number of modes.
    """
    outline = drivetrain_outline(result.machine, assembly(result.machine, result.level))
    kept = next(iter(result.shapes.values())).shape[1]
    first = [] if result.torsional is None or result.torsional >= kept else [result.torsional]
    # the first torsional one is among them, wherever it stands
    drawn = list(dict.fromkeys([*first, *range(kept)]))[:count]
    return [_shape_chart(result, outline, mode) for mode in sorted(drawn)]


def drivetrain_outline(machine: Machine, parts: Assembly) -> Outline:
    """Circles of gears and carriers with a spoke, and axes of shafts.

    Parameters
    ----------
    machine : Machine
        The drivetrain.
    parts : Assembly
        Its bodies at a level.
    """
    lines: list[tuple[list[Body], Floats]] = []
    radii = _radii(machine)
    for body in parts.bodies:
        if body.name in radii:
            lines.append(([body] * (_CORNERS + 2), _wheel(radii[body.name])))
    known = {body.name: body for body in parts.bodies}
    for k, shaft in enumerate(machine.shafts):
        nodes = [b for b in parts.bodies if b.name.startswith(f"{shaft.name} node ")]
        ends = [known[name] for name in _ends(machine, k)]
        line = sorted([*nodes, *ends], key=lambda body: body.position[0])
        lines.append((line, np.zeros((len(line), 3))))
    bodies = [body for line, _ in lines for body in [*line, line[-1]]]
    gap = np.full((1, 3), np.nan)
    arms = np.concatenate([np.concatenate([of, gap]) for _, of in lines])
    return Outline(
        tuple(body.name for body in bodies),
        np.array([body.position for body in bodies]) + arms,
        arms,
        np.array([max(1.0, abs(body.speed)) for body in bodies]),
    )


def motions_of(outline: Outline, result: ModesResult, mode: int) -> Floats:
    """(p, 3) motions of an outline in a mode, turning over the gearing, of any size.

    Parameters
    ----------
    outline : Outline
        Points on bodies.
    result : ModesResult
        With shapes.
    mode : int
        Number of the mode, from 0.
    """
    moved = np.array([result.shapes[body][:, mode] for body in outline.bodies])
    moved[:, 3] /= outline.gearing
    return np.asarray(moved[:, :3] + np.cross(moved[:, 3:], outline.arms))


def _shape_chart(result: ModesResult, outline: Outline, mode: int) -> Chart:
    """A mode at rest, swung out to both sides, and what a page needs to let it swing."""
    moved = motions_of(outline, result, mode)
    radius = float(np.nanmax(np.linalg.norm(outline.arms, axis=1)))
    moved *= _REACH * radius / float(np.nanmax(np.linalg.norm(moved, axis=1)))
    flat, out = outline.points @ _OBLIQUE.T, moved @ _OBLIQUE.T
    traces = [
        _line("at rest", flat, _REST, 1.2),
        _line("swung to the other side", flat - out, _ENVELOPE, 1.2, dash="dot"),
        _line("swung out", flat + out, _MOVING, 2.0),
    ]
    frequency = f"{float(result.frequencies[mode]):.4g}\u00a0Hz"
    found = chart(f"Mode {mode + 1} at {frequency}: {result.words[mode]}", traces, "", "")
    bare = {"visible": False, "showgrid": False, "zeroline": False}
    seen = np.concatenate([flat - out, flat + out])
    ends = [(float(np.nanmin(v)), float(np.nanmax(v))) for v in seen.T]
    found.figure["layout"] |= {
        "height": 380,
        "margin": {"l": 10, "r": 10, "t": 30, "b": 10},
        "xaxis": {**bare, "range": rounded(ends[0])},
        "yaxis": {**bare, "range": rounded(ends[1]), "scaleanchor": "x"},
        "hovermode": False,
    }
    found.figure[SWING] = {
        "trace": 2,
        "x": _column(flat, 0),
        "y": _column(flat, 1),
        "dx": _column(out, 0),
        "dy": _column(out, 1),
    }
    return found


def _line(name: str, points: Floats, colour: str, width: float, **look: Any) -> dict[str, Any]:
    return {
        "type": "scatter",
        "mode": "lines",
        "name": name,
        "x": _column(points, 0),
        "y": _column(points, 1),
        "line": {"color": colour, "width": width, **look},
    }


def _column(points: Floats, k: int) -> list[float | None]:
    """One coordinate of points; none between lines."""
    return [None if np.isnan(v) else rounded([v], 4)[0] for v in points[:, k]]


def _wheel(radius: float) -> Floats:
    """(m, 3) circle across x, and a spoke that shows how it turns."""
    angles = np.linspace(0.5 * np.pi, 2.5 * np.pi, _CORNERS + 1)
    circle = radius * np.column_stack([0 * angles, np.cos(angles), np.sin(angles)])
    return np.concatenate([circle, np.zeros((1, 3))])


def _radii(machine: Machine) -> dict[str, float]:
    """Radius at which each body is drawn [m]."""
    found: dict[str, float] = {}
    for number, stage in enumerate(machine.stages, start=1):
        name, a = f"stage {number}", stage.centre_distance
        if stage.kind == "planetary":
            planet = a - stage.sun_radius
            found |= {f"{name} carrier": a, f"{name} ring": a + planet}
            found[f"{name} sun"] = stage.sun_radius
            found |= {f"{name} planet {k}": planet for k in range(1, stage.planets + 1)}
        else:
            found |= {f"{name} gear": stage.gear_radius}
            found[f"{name} pinion"] = a - stage.gear_radius
    length = sum(shaft.length for shaft in machine.shafts)
    largest = max([*found.values(), 0.15 * length])
    return {"rotor": largest, "generator": 0.6 * largest, **found}


def _ends(machine: Machine, k: int) -> Sequence[str]:
    """Bodies that a shaft holds at its ends."""
    kinds = [stage.kind == "planetary" for stage in machine.stages]
    first = "rotor" if k == 0 else f"stage {k} {'sun' if kinds[k - 1] else 'pinion'}"
    if k == len(kinds):
        return first, "generator"
    return first, f"stage {k + 1} {'carrier' if kinds[k] else 'gear'}"
