"""A sheet to draw on: solids, and lines and text over them."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Concatenate, ParamSpec

import numpy as np
import numpy.typing as npt

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.report.pictures.off_screen import off_screen_plotter
from fe_drivetrain.report.pictures.surfaces import smooth
from fe_drivetrain.report.pictures.view import SIZE, STRIP, View

INK = "#1f2933"
FAINT = "#7b8794"

_P = ParamSpec("_P")


@dataclass(frozen=True)
class Plan:
    """What a picture shows, as plain data: it can be drawn in another process.

    Attributes
    ----------
    view : View
        How it looks at what is drawn.
    steps : list
        Functions that draw on a `Sheet`, in order, with their arguments.
    """

    view: View
    steps: list[tuple[Callable[..., object], tuple[Any, ...], dict[str, Any]]] = field(
        default_factory=list
    )

    def add(
        self,
        draw: Callable[Concatenate[Sheet, _P], object],
        *args: _P.args,
        **kwargs: _P.kwargs,
    ) -> None:
        """Have ``draw(sheet, ...)`` called; it is a function that can be imported, or a method."""
        self.steps.append((draw, args, kwargs))


@dataclass(frozen=True)
class Sheet:
    """A picture in the making.

    Attributes
    ----------
    plotter : pyvista.Plotter
        Off screen; whatever is added to it appears in the picture.
    view : View
        How it looks at what is added.
    taken : list
        Lower left and upper right corners, (2, 2) [pixels], of the notes.
    """

    plotter: Any
    view: View
    taken: list[Floats] = field(default_factory=list)

    def solid(self, surface: Any, edges: Any, colour: str) -> None:
        """A surface in one colour, and its edges."""
        self.plotter.add_mesh(
            smooth(surface), color=colour, ambient=0.25, diffuse=0.8, smooth_shading=True
        )
        self.plotter.add_mesh(edges, color=INK, line_width=2.0)

    def coloured(self, surface: Any, limits: tuple[float, float]) -> None:
        """A surface in the colours of the lengths of its "vectors" [m], and their scale [mm]."""
        import pyvista

        title = "displacement [mm]"
        surface[title] = 1e3 * np.linalg.norm(surface["vectors"], axis=1)
        self.plotter.add_mesh(
            smooth(surface),
            scalars=title,
            clim=limits,
            cmap="viridis",
            show_scalar_bar=False,
            ambient=0.5,
            diffuse=0.55,
            smooth_shading=True,
        )
        if title in self.plotter.scalar_bars:
            return
        bar = self.plotter.add_scalar_bar(
            title,
            color=INK,
            label_font_size=16,
            unconstrained_font_size=True,
            fmt="%g",
            vertical=False,
            position_x=0.37,
            position_y=0.07,
            width=0.26,
            height=0.065,
        )
        step = round_step(limits[1] - limits[0], 8)
        ticks = step * np.arange(math.ceil(limits[0] / step), math.floor(limits[1] / step) + 1)
        bar.SetCustomLabels(pyvista.convert_array(ticks))
        bar.SetUseCustomLabels(True)
        # numbers below the bar, and the title above it, where VTK would put it among them
        bar.SetTextPositionToPrecedeScalarBar()
        bar.SetTextPad(6)
        bar.SetTitle("")
        low, high = limits
        self.text((SIZE[0] / 2, 138), f"{title}, {low:.3g} to {high:.3g}", size=18)

    def text(
        self,
        at: npt.ArrayLike,
        text: str,
        colour: str = INK,
        size: int = 16,
        centred: bool = True,
        background: bool = False,
    ) -> Any:
        """Write at a pixel, which is the middle of the text, or of its left side.

        Returns
        -------
        pyvista.Text
            What was written.
        """
        import pyvista

        written = pyvista.Text(text, position=[float(x) for x in np.asarray(at)])
        written.prop = pyvista.TextProperty(
            color=colour,
            font_size=size,
            justification_horizontal="center" if centred else "left",
            justification_vertical="center",
            background_color="white",
            background_opacity=float(background),
        )
        self.plotter.add_actor(written, reset_camera=False)
        return written

    def line(self, pixels: npt.ArrayLike, colour: str = INK, width: float = 2.0) -> None:
        """Straight lines between pixels (2 n, 2), two by two."""
        import pyvista

        ends: Any = self.view.in_front(pixels)
        lines = pyvista.line_segments_from_points(ends)
        self.plotter.add_mesh(lines, color=colour, line_width=width, lighting=False)

    def area(self, corners: npt.ArrayLike, colour: str) -> None:
        """A filled convex polygon between pixels (n, 2)."""
        import pyvista

        points = self.view.in_front(corners)
        shape = pyvista.PolyData(points, faces=[len(points), *range(len(points))])
        self.plotter.add_mesh(shape, color=colour, lighting=False)

    def note(
        self, point: npt.ArrayLike, text: str, offset: tuple[float, float], colour: str = INK
    ) -> None:
        """Label a point [m] from a distance [pixels], with a line to it, clear of earlier notes."""
        foot = self.view.project(point)
        written = self.text(foot, f" {text} ", colour, size=18, background=True)
        written.prop.show_frame = True
        written.prop.frame_color = colour
        extent = [0.0, 0.0]
        written.GetSize(self.plotter.renderer, extent)
        half = np.array(extent) / 2 + 4
        low, high = half + np.array([8, STRIP]), np.array(SIZE) - half - 8
        for step in range(10):
            away = (offset[0], offset[1] + math.copysign(32 * step, offset[1]))
            at = np.clip(foot + away, low, high)
            box = np.array([at - half, at + half])
            if not any((box[0] < b[1]).all() and (b[0] < box[1]).all() for b in self.taken):
                break
        written.position = [float(x) for x in at]
        self.taken.append(box)
        self.line([foot, at], colour, 1.6)
        turn = np.linspace(0.0, 2 * np.pi, 24, endpoint=False)
        self.area(foot + 4 * np.column_stack([np.cos(turn), np.sin(turn)]), colour)

    def column(self, left: float, rows: Sequence[tuple[str, str | None]]) -> None:
        """Lines of text in the strip below the drawing.

        Parameters
        ----------
        left : float
            Where the column begins [pixels].
        rows : sequence of tuple
            Text and colour of its swatch: "head" for a heading, None for no swatch.
        """
        y = STRIP - 22
        indent = 30 if any(colour not in (None, "head") for _, colour in rows) else 0
        for text, colour in rows:
            if colour == "head":
                self.text((left, y), text, size=18, centred=False)
                y -= 30
                continue
            if colour is not None:
                self.area(
                    [(left, y - 8), (left + 20, y - 8), (left + 20, y + 8), (left, y + 8)], colour
                )
            self.text((left + indent, y), text, centred=False)
            y -= 24

    def triad(self) -> None:
        """The axes of the frame, in the lower left corner."""
        origin = np.array([88.0, 80.0])
        for axis, e in zip("xyz", np.eye(3), strict=True):
            seen = np.array([e @ self.view.right, e @ self.view.up])
            along = seen / np.linalg.norm(seen)
            across = np.array([-along[1], along[0]])
            tip = origin + 58 * seen
            self.line([origin, tip], width=2.5)
            self.area([tip + 8 * along, tip + 5 * across, tip - 5 * across], INK)
            self.text(tip + 21 * along, axis, size=19)

    def scale_bar(self) -> None:
        """A length along x, as it is drawn, beside the axes."""
        metre = self.view.project([1.0, 0.0, 0.0]) - self.view.project(np.zeros(3))
        pixels = float(np.linalg.norm(metre))
        length = round_step(250 / pixels, 2)
        start = np.array([210.0, 70.0])
        end = start + length * metre
        across = 7 * np.array([-metre[1], metre[0]]) / pixels
        ends = [start - across, start + across, end - across, end + across]
        self.line([start, end, *ends], width=2.5)
        self.text((start + end) / 2 - 3.2 * across, f"{length:g} m along x")


@contextmanager
def drawing(path: Path, view: View) -> Iterator[Sheet]:
    """A sheet that is written as a PNG in the end.

    Parameters
    ----------
    path : Path
        PNG to write, of `SIZE`.
    view : View
        How to look at what is drawn.

    Yields
    ------
    Sheet
        To draw on.
    """
    with off_screen_plotter(SIZE) as plotter:
        yield Sheet(plotter, view)
        plotter.enable_parallel_projection()
        plotter.camera.focal_point = tuple(view.centre)
        plotter.camera.position = tuple(view.centre - 4 * view.reach * view.forward)
        plotter.camera.up = tuple(view.up)
        plotter.camera.parallel_scale = SIZE[1] / 2 / view.scale
        plotter.reset_camera_clipping_range()
        plotter.screenshot(path)


def round_step(largest: float, most: int) -> float:
    """The least of 1, 2, 5, 10, ... whose multiples divide a range in at most so many."""
    power = 10.0 ** math.floor(math.log10(largest / most))
    steps = [m * power for m in (1, 2, 5, 10) if largest / (m * power) <= most * (1 + 1e-9)]
    return float(steps[0])
