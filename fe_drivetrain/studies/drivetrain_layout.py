"""A whole drivetrain from the side, unfolded so that all its shafts lie in one plane, to scale."""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import accumulate
from typing import Any

from fe_drivetrain.common.arrays import rounded
from fe_drivetrain.drivetrain_file.gear_stages import ParallelData, PlanetaryData
from fe_drivetrain.drivetrain_file.machine_table import MachineTable
from fe_drivetrain.drivetrain_file.turning_parts import BearingData, ShaftData
from fe_drivetrain.report.charts import chart, trace
from fe_drivetrain.report.results import Chart

LAYOUT = "The drivetrain from the side, its shafts unfolded into one plane, to scale"
"""Caption of the layout."""

_STEEL, _GEAR, _PLANET, _RING = "#9aa7b5", "#5b8db8", "#7fb0a3", "#52606d"
_BEARING, _BODY = "#c77700", "#7a869a"
#: Radius of a shaft that is given by its stiffness alone, over the length of the drivetrain.
_THIN = 0.012
#: Size of the boxes of rotor and generator over the length of the drivetrain.
_BOX = 0.06
#: Pixels by which labels of stages next to each other stand at two heights.
_STAGGER = 20


@dataclass
class _Drawing:
    """Boxes and labels, and the marks of bearings."""

    scale: float
    shapes: list[dict[str, Any]] = field(default_factory=list)
    notes: list[dict[str, Any]] = field(default_factory=list)
    marks: list[tuple[float, float, str]] = field(default_factory=list)

    def box(self, x: tuple[float, float], y: tuple[float, float], colour: str) -> None:
        """Draw a box."""
        self.shapes.append(
            {
                "type": "rect",
                "x0": x[0],
                "x1": x[1],
                "y0": y[0],
                "y1": y[1],
                "fillcolor": colour,
                "opacity": 0.85,
                "layer": "below",
                "line": {"color": "#37424f", "width": 1},
            }
        )

    def label(self, x: float, y: float, text: str, shift: int = -26) -> None:
        """Write a label with a line to its place, so many pixels below it."""
        self.notes.append(
            {"x": x, "y": y, "ax": 0, "ay": shift, "text": text, "font": {"size": 13}}
        )


def drivetrain_layout(caption: str, machine: MachineTable) -> Chart:
    """Draw a drivetrain from the rotor to the generator.

    Parameters
    ----------
    caption : str
        What it shows.
    machine : MachineTable
        Bodies, shafts, stages and bearings.

    Returns
    -------
    Chart
        Lengths in m; x from the rotor on, each parallel stage one centre distance further up.
    """
    begins = [axis[0] for axis in machine.axes]
    end = begins[-1] + machine.shafts[-1].length
    drawing = _Drawing(end)
    heights = _heights(machine)
    for number, (shaft, x, y) in enumerate(zip(machine.shafts, begins, heights, strict=True)):
        _shaft(drawing, shaft, x, y, 26 + _STAGGER * (number % 2))
    for number, stage in enumerate(machine.stages, start=1):
        at = begins[number]
        if isinstance(stage, PlanetaryData):
            _planetary(drawing, stage, number, at, heights[number - 1])
        else:
            _parallel(drawing, stage, number, at, heights[number - 1 : number + 1])
    size = _BOX * end
    drawing.box((-0.4 * size, 0.0), (-3 * size, 3 * size), _BODY)
    drawing.label(-0.2 * size, 3 * size, "rotor")
    top = heights[-1]
    drawing.box((end, end + 2 * size), (top - size, top + size), _BODY)
    drawing.label(end + size, top + size, "generator")
    _bearings(drawing, machine, begins, heights)
    found = chart(caption, [_marks(drawing)], "x [m]", "height, unfolded [m]")
    found.figure["layout"] |= {
        "shapes": drawing.shapes,
        "annotations": drawing.notes,
        "showlegend": False,
        "height": 430,
        "xaxis": {
            "title": {"text": "x [m]"},
            "zeroline": False,
            "range": rounded([-2 * size, end + 4 * size]),
        },
        "yaxis": {
            "title": {"text": "height, unfolded [m]"},
            "scaleanchor": "x",
            "zeroline": False,
        },
    }
    return found


def _heights(machine: MachineTable) -> list[float]:
    """Height of each shaft's axis, unfolded."""
    steps = (s.centre_distance if isinstance(s, ParallelData) else 0.0 for s in machine.stages)
    return list(accumulate(steps, initial=0.0))


def _shaft(drawing: _Drawing, shaft: ShaftData, x: float, y: float, shift: int) -> None:
    if shaft.sections is None:
        r = shaft.outer / 2 if shaft.outer is not None else _THIN * drawing.scale
        drawing.box((x, x + shaft.length), (y - r, y + r), _STEEL)
        drawing.label(x + shaft.length / 2, y - r, shaft.name, shift)
        return
    at = x
    for piece in shaft.sections:
        r = (piece.outer_diameter + piece.end_diameter) / 4
        drawing.box((at, at + piece.length), (y - r, y + r), _STEEL)
        at += piece.length
    drawing.label(x + shaft.length / 2, y - r, shaft.name, shift)


def _planetary(drawing: _Drawing, stage: PlanetaryData, number: int, x: float, y: float) -> None:
    half, a, sun = stage.face_width / 2, stage.centre_distance, stage.sun_radius
    planet = a - sun
    rim = a + planet
    for sign in (1, -1):
        drawing.box((x - half, x + half), (y + sign * rim, y + sign * 1.12 * rim), _RING)
        drawing.box(
            (x - half, x + half), (y + sign * (a - planet), y + sign * (a + planet)), _PLANET
        )
    drawing.box((x - half, x + half), (y - sun, y + sun), _GEAR)
    drawing.label(x, y + 1.12 * rim, f"stage {number}", -26 - _STAGGER * (number % 2))


def _parallel(
    drawing: _Drawing, stage: ParallelData, number: int, x: float, heights: list[float]
) -> None:
    half, gear = stage.face_width / 2, stage.gear_radius
    pinion = stage.centre_distance - gear
    for y, r, colour in ((heights[0], gear, _GEAR), (heights[1], pinion, _PLANET)):
        drawing.box((x - half, x + half), (y - r, y + r), colour)
    drawing.label(x, heights[1] + pinion, f"stage {number}", -26 - _STAGGER * (number % 2))


def _bearings(
    drawing: _Drawing, machine: MachineTable, begins: list[float], heights: list[float]
) -> None:
    for bearing in machine.bearings:
        x, y = _place(bearing, machine, begins, heights)
        drawing.marks.append((x, y, bearing.name))


def _place(
    bearing: BearingData, machine: MachineTable, begins: list[float], heights: list[float]
) -> tuple[float, float]:
    """Where a bearing is: on a shaft, or on a body of a stage."""
    for k, shaft in enumerate(machine.shafts):
        if shaft.name == bearing.holds:
            return begins[k] + bearing.at, heights[k]
    if bearing.holds == "rotor":
        return bearing.at, heights[0]
    if bearing.holds == "generator":
        return begins[-1] + machine.shafts[-1].length + bearing.at, heights[-1]
    _, number, part = bearing.holds.split(" ")
    behind = part in ("sun", "pinion")
    return begins[int(number)] + bearing.at, heights[int(number) - (0 if behind else 1)]


def _marks(drawing: _Drawing) -> Any:
    """Bearings as marks on their axes, named where the pointer is."""
    x, y, names = zip(*drawing.marks, strict=True) if drawing.marks else ((), (), ())
    return trace(
        "bearings",
        list(x),
        list(y),
        points=True,
        text=list(names),
        hovertemplate="%{text}: x %{x:.3f} m<extra></extra>",
        marker={"size": 11, "symbol": "x-thin", "line": {"width": 3, "color": _BEARING}},
    )
