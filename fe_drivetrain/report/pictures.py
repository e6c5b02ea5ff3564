"""Pictures of a model and of its deformation, drawn without a screen.

VTK (imported when the first picture is drawn) renders the solids, larger than needed; labels,
dimensions and legend are drawn over them, and all is scaled down together.

A machine may be unable to draw: then `NoPictureError` is raised, and a case says so on its page in
the picture's place instead of failing.
"""

from __future__ import annotations

import functools
import math
import subprocess
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt
from PIL import Image, ImageDraw, ImageFont

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.interpreter import run_python
from fe_drivetrain.mesh.mesh import EIGHTHS, Mesh, boundary

if TYPE_CHECKING:
    from fe_drivetrain.response.model import Model
    from fe_drivetrain.response.unit_loads import Response
    from fe_drivetrain.scene.scene import BearingUnit, Gearbox

SIZE = (1600, 900)
"""Width and height of every picture, pixels."""

_OVERSAMPLING = 2
_STRIP = 225  # below the picture, for axes and legend, pixels
_MARGIN = 40  # on the other sides, pixels
_SUBDIVIDED_CELLS = 60_000  # above, elements are small enough to be drawn with straight edges
_SYMBOL = 0.11  # length of an arrow, of the length of the shaft
_EXAGGERATION = 0.08  # largest displacement as drawn, of the length of the shaft

_VISIBLE = 4.0  # a movement as drawn that the eye can tell, pixels

_INK = "#1f2933"
_FAINT = "#7b8794"
_FORCE = "#b3261e"
_MOMENT = "#6b3fa0"
_SPRING = "#25567b"
_GROUND = "#5b4636"
_PARTS = {"shaft": "#9fb4c7", "bearing": "#e8a33d", "housing": "#6ba292"}
_COLOURS = "viridis"
_DEFORMED = "#2a788e"  # the middle of it
_GHOST = "#d9dde1"

_Point = Sequence[float] | Floats
_Points = Sequence[_Point] | Floats

_AXES = ("x", "y", "z")
_INTERFACES = {
    "bonded": "bonded",
    "spring": "6x6 spring",
    "rollers": "ring of rollers as springs",
    "sliding": "spherical joint (sliding)",
    "averaged": "spherical joint (averaged)",
    "rigid": "spherical joint (rigid faces)",
}


class NoPictureError(Exception):
    """This machine cannot draw; the message says why."""


@functools.cache
def _refusal() -> str:
    """Why this machine cannot draw; empty where it can.

    VTK ends the whole process where there is no OpenGL at all, so another process tries first.
    """
    trial = (
        "import vtkmodules.vtkRenderingOpenGL2\n"
        "from vtkmodules.vtkRenderingCore import vtkRenderer, vtkRenderWindow\n"
        "window = vtkRenderWindow()\n"
        "window.SetOffScreenRendering(1)\n"
        "window.AddRenderer(vtkRenderer())\n"
        "window.Render()\n"
    )
    try:
        tried = run_python("-c", trial, timeout=60)
    except (OSError, subprocess.TimeoutExpired) as error:
        return f"a trial of off-screen rendering did not end well ({error})"
    if tried.returncode == 0:
        return ""
    missing = [line for line in tried.stderr.splitlines() if line.startswith("ImportError: ")]
    if missing:
        return f"VTK cannot be loaded ({missing[-1].removeprefix('ImportError: ')})"
    return "there is no OpenGL for off-screen rendering: install Mesa's libEGL or libOSMesa"


def can_draw() -> bool:
    """Whether this machine can draw pictures."""
    return not _refusal()


def picture_of_model(model: Model, path: Path) -> None:
    """Draw what a model consists of, cut open by a quarter, with loads, supports and dimensions.

    Parameters
    ----------
    model
        The model; it need not be solved.
    path
        PNG to write, of `SIZE`.

    Raises
    ------
    NoPictureError
        This machine cannot draw.
    """
    mesh, scene = model.mesh, model.scene
    hub, rear = model.points["hub"].position, model.points["gearbox"].position
    a = _SYMBOL * scene.shaft.length
    radius = float(np.abs(mesh.points[mesh.face_nodes("shaft.rear")][:, 1:]).max())
    symbols = [
        hub + a * np.array([[-2.4, 0, 0], [0, 2.4, 0], [0, 0, 2.4]]),
        rear + a * np.array([[1.2, 0, 0], [0, -1.2, 0], [0, 0, -1.2]]),
        rear + np.array([[0, 0, radius + 1.2 * a]]),
    ]
    stations = [hub[0], *sorted(unit.bearing.x for unit in scene.bearing_units), rear[0]]
    under = _line_under(mesh, stations)
    view = _View.fitting(np.concatenate([mesh.points, *symbols, under]), top=60, bottom=60)
    with _plotter(view) as plotter:
        grid, owner = _linear_grid(mesh)
        for number, part in enumerate(mesh.part_names):
            surface = _curved_surface(boundary(mesh, part), mesh.points)
            colour = _PARTS[_kind(part)]
            # a solid shaft stays whole, as in any drawing
            if part == "shaft" and "shaft.bore" not in mesh.faces:
                _add_solid(plotter, surface, _edges(surface), colour)
            else:
                solid = grid.extract_cells(np.flatnonzero(owner == number))
                _add_solid(plotter, *_cut_open(surface, solid), colour)
        _add_hub_loads(plotter, hub, a)
        _add_gearbox(plotter, scene.gearbox, rear, radius, a)
        for unit in scene.bearing_units:
            _add_fixed_base(plotter, mesh, unit, 0.06 * a)
        canvas = _Canvas(view, plotter)
    canvas.dimensions(stations, under, mesh)
    _label_hub_loads(canvas, hub, a)
    _label_parts(canvas, model)
    canvas.triad()
    for left, rows in zip((190, 520, 945, 1270), _model_legend(model), strict=True):
        canvas.column(left, rows)
    canvas.save(path)


def picture_of_deformation(
    model: Model, response: Response, load_factors: npt.ArrayLike, path: Path, title: str = ""
) -> float:
    """Draw the deformed shape, exaggerated and coloured by displacement, over the undeformed one.

    Parameters
    ----------
    model, response
        A model and its response to the unit loads.
    load_factors
        (10,) multiples of the loads of `fe_drivetrain.response.model.LOADS`.
    path
        PNG to write, of `SIZE`.
    title
        What the load is, in a few words: written into the picture.

    Returns
    -------
    factor
        How many times larger the displacements are drawn than they are, for the caption. The
        largest is then about 8 % of the length of the shaft. 1 where nothing moves.

    Raises
    ------
    NoPictureError
        This machine cannot draw.
    ValueError
        A displacement is not finite.
    """
    mesh = model.mesh
    u = response.displacements @ np.asarray(load_factors, dtype=float)
    size = np.linalg.norm(u, axis=1)
    if not np.isfinite(size).all():
        raise ValueError("a displacement is not finite: check the load factors")
    largest = float(size.max())
    factor = exaggeration(largest, model.scene.shaft.length)
    moved = mesh.points + factor * u
    view = _View.fitting(np.concatenate([mesh.points, moved]), top=90, bottom=40)
    top_of_scale = 1e3 * largest if largest > 0 else 1.0
    with _plotter(view) as plotter:
        for part in mesh.part_names:
            facets, nodes = boundary(mesh, part), mesh.part_nodes(part)
            if factor * size[nodes].max() * view.scale > _VISIBLE:
                _add_ghost(plotter, _curved_surface(facets, mesh.points))
            shape = _curved_surface(facets, moved, u)
            shape["mm"] = 1e3 * np.linalg.norm(shape["values"], axis=1)
            plotter.add_mesh(
                _smooth(shape),
                scalars="mm",
                clim=(0.0, top_of_scale),
                cmap=_COLOURS,
                show_scalar_bar=False,
                ambient=0.5,
                diffuse=0.55,
                smooth_shading=True,
            )
            plotter.add_mesh(_edges(shape), color=_INK, line_width=_OVERSAMPLING)
        canvas = _Canvas(view, plotter)
    canvas.heading(title)
    canvas.triad()
    canvas.scale_bar()
    if largest > 0:
        canvas.note(moved[np.argmax(size)], f"largest: {1e3 * largest:.4g} mm", (90, -90))
    canvas.colour_bar(top_of_scale, "displacement [mm]")
    canvas.column(
        1110,
        [
            ("Shape", "head"),
            (f"deformed, displacements times {factor:g}", _DEFORMED),
            ("undeformed, where it differs", _GHOST),
        ],
    )
    canvas.save(path)
    return factor


def exaggeration(largest: float, length: float) -> float:
    """The factor to draw displacements with: one significant digit, or 1 where nothing moves.

    Parameters
    ----------
    largest
        Largest displacement [m].
    length
        Length of the shaft [m].
    """
    return float(f"{_EXAGGERATION * length / largest:.0e}") if largest > 0 else 1.0


def _kind(part: str) -> str:
    return "shaft" if part == "shaft" else "housing" if part.endswith(".housing") else "bearing"


# --- the view -------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _View:
    """A parallel projection: x to the right, z up, seen from upstream, from the side and above.

    Attributes
    ----------
    centre
        (3,) the point in the middle of the picture [m].
    scale
        Pixels a metre.
    """

    centre: Floats
    scale: float

    FORWARD = np.array([0.50, 1.0, -0.45]) / np.linalg.norm([0.50, 1.0, -0.45])
    RIGHT = np.cross(FORWARD, [0.0, 0.0, 1.0]) / np.linalg.norm(np.cross(FORWARD, [0.0, 0.0, 1.0]))
    UP = np.cross(RIGHT, FORWARD)

    @classmethod
    def fitting(cls, points: Floats, top: int, bottom: int) -> _View:
        """The view that shows all points above the legend, between two margins in pixels."""
        flat = points @ np.column_stack([cls.RIGHT, cls.UP])
        low, high = flat.min(axis=0), flat.max(axis=0)
        bottom += _STRIP
        room = np.array([SIZE[0] - 2 * _MARGIN, SIZE[1] - top - bottom])
        scale = float((room / (high - low)).min())
        # the middle of the points goes to the middle of the room, not of the picture
        across, along = (low + high) / 2 + (0.0, (top - bottom) / 2 / scale)
        depth = float((points @ cls.FORWARD).mean())
        return cls(across * cls.RIGHT + along * cls.UP + depth * cls.FORWARD, scale)

    def project(self, points: Floats) -> Floats:
        """Pixels (..., 2), from the upper left corner, of points (..., 3) [m]."""
        d = np.asarray(points) - self.centre
        across = SIZE[0] / 2 + self.scale * (d @ self.RIGHT)
        down = SIZE[1] / 2 - self.scale * (d @ self.UP)
        return np.stack([across, down], axis=-1)


@contextmanager
def _plotter(view: _View) -> Iterator[Any]:
    """An off-screen plotter that looks along the view.

    Raises
    ------
    NoPictureError
    """
    if reason := _refusal():
        raise NoPictureError(reason)
    import pyvista
    from vtkmodules.vtkCommonCore import vtkLogger

    # VTK warns on the terminal about every missing display before it finds one that works
    vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_ERROR)
    width, height = (_OVERSAMPLING * pixels for pixels in SIZE)
    plotter: Any = pyvista.Plotter(off_screen=True, window_size=[width, height])
    try:
        # The larger picture is smoothed when it is scaled down: more samples change nothing there.
        plotter.render_window.SetMultiSamples(0)
        plotter.set_background("white")
        plotter.enable_parallel_projection()
        plotter.camera.focal_point = tuple(view.centre)
        plotter.camera.position = tuple(view.centre - 100.0 * view.FORWARD)
        plotter.camera.up = tuple(view.UP)
        plotter.camera.parallel_scale = SIZE[1] / 2 / view.scale
        yield plotter
    finally:
        plotter.close()
        vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_WARNING)


# --- the solids -----------------------------------------------------------------------------------


def _linear_grid(mesh: Mesh) -> tuple[Any, Ints]:
    """The curved elements as straight ones, eight for each, and the part of each."""
    import pyvista

    if len(mesh.cells) > _SUBDIVIDED_CELLS:
        cells, points, owner = mesh.cells[:, :4], mesh.points, mesh.part
    else:
        # the ten nodes are the corners of the eight pieces
        nodes = np.argmax((EIGHTHS[:, :, None] == _ten_nodes()).all(axis=3), axis=2)
        cells = mesh.cells[:, nodes].reshape(-1, 4)
        points, owner = mesh.points, np.repeat(mesh.part, len(EIGHTHS))
    # a copy: VTK would share the mesh's own array
    return pyvista.UnstructuredGrid({pyvista.CellType.TETRA: cells}, points.copy()), owner


def _ten_nodes() -> Floats:
    """Barycentric coordinates (10, 4) of the nodes of a tetrahedron, in VTK's order."""
    corners = np.eye(4)
    edges = np.array([(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)])
    return np.concatenate([corners, corners[edges].mean(axis=1)])


def _curved_surface(facets: Ints, positions: Floats, values: Floats | None = None) -> Any:
    """Six-node triangles as a fine surface of flat ones.

    Parameters
    ----------
    facets
        (nf, 6) node ids: corners, then mid-sides.
    positions
        (n, 3) of the nodes [m].
    values
        (n, k) at the nodes: the surface carries them as "values".
    """
    import pyvista

    n = 4 if len(facets) < 20_000 else 2
    lattice = [(i, j) for i in range(n + 1) for j in range(n + 1 - i)]
    number = {at: k for k, at in enumerate(lattice)}
    triangles = [
        [number[i, j], number[i + 1, j], number[i, j + 1]] for i, j in lattice if i + j < n
    ] + [
        [number[i + 1, j], number[i + 1, j + 1], number[i, j + 1]]
        for i, j in lattice
        if i + j < n - 1
    ]
    r, s = np.array(lattice).T / n
    t = 1 - r - s
    shapes = np.stack(
        [t * (2 * t - 1), r * (2 * r - 1), s * (2 * s - 1), 4 * t * r, 4 * r * s, 4 * s * t], axis=1
    )
    points = np.einsum("pa,fai->fpi", shapes, positions[facets]).reshape(-1, 3)
    first = len(lattice) * np.arange(len(facets))
    faces = (first[:, None, None] + np.array(triangles)).reshape(-1, 3)
    # VTK's own merging of points takes seconds where all lie in one plane
    _, kept, same = np.unique(points.round(9), axis=0, return_index=True, return_inverse=True)
    surface = pyvista.PolyData.from_regular_faces(points[kept], same.reshape(-1)[faces])
    if values is not None:
        fine = np.einsum("pa,fai->fpi", shapes, values[facets])
        surface["values"] = fine.reshape(len(points), -1)[kept]
    return surface


def _smooth(surface: Any) -> Any:
    """The surface with normals that are smooth but for its edges."""
    return surface.compute_normals(feature_angle=30, split_vertices=True, auto_orient_normals=False)


def _edges(surface: Any) -> Any:
    return surface.extract_feature_edges(
        feature_angle=30, boundary_edges=False, non_manifold_edges=False, manifold_edges=False
    )


def _cut_open(surface: Any, solid: Any) -> tuple[Any, Any]:
    """Take the quarter y < 0, z > 0 away, and close the cut.

    Parameters
    ----------
    surface
        The closed surface of a part.
    solid
        Its elements.

    Returns
    -------
    What is left of the surface, with the faces of the cut; and the edges of both.
    """
    import pyvista

    def below(shape: Any, axis: str, inverted: bool) -> Any:
        return shape.clip(axis, origin=(0.0, 0.0, 0.0), invert=inverted)

    def outside(shape: Any) -> Any:
        near = below(shape, "y", True)
        return below(shape, "y", False).append_polydata(below(near, "z", True))

    # next to the planes, where no node can lie exactly
    upright = below(solid.slice("y", origin=(0.0, 1e-7, 0.0)), "z", False)
    level = below(solid.slice("z", origin=(0.0, 0.0, -1e-7)), "y", True)
    faces = [face.clean() for face in (upright, level) if face.n_cells]
    rims = [
        face.extract_feature_edges(
            boundary_edges=True, feature_edges=False, non_manifold_edges=False, manifold_edges=False
        )
        for face in faces
    ]
    edges = pyvista.merge([outside(_edges(surface)), *rims])
    return outside(_smooth(surface)).append_polydata(*faces), edges


def _add_solid(plotter: Any, surface: Any, edges: Any, colour: str) -> None:
    plotter.add_mesh(_smooth(surface), color=colour, ambient=0.25, diffuse=0.8, smooth_shading=True)
    plotter.add_mesh(edges, color=_INK, line_width=1.2 * _OVERSAMPLING)


def _add_ghost(plotter: Any, surface: Any) -> None:
    plotter.add_mesh(surface, color="#9aa5b1", opacity=0.16)
    plotter.add_mesh(_edges(surface), color=_FAINT, line_width=1.2 * _OVERSAMPLING)


def _add_fixed_base(plotter: Any, mesh: Mesh, unit: BearingUnit, thickness: float) -> None:
    """Show where a housing is held: a plate under its base, or washers on its foot."""
    surface = _curved_surface(mesh.faces[f"{unit.bearing.name}.housing.base"], mesh.points)
    plate = surface.extrude((0.0, 0.0, -thickness), capping=True)
    if unit.housing.base == "bolted":
        plate = plate.translate((0.0, 0.0, unit.housing.foot_thickness + thickness))
    plotter.add_mesh(plate, color=_GROUND, ambient=0.3)


def _add_arrow(plotter: Any, tail: Floats, tip: Floats, colour: str, heads: int = 1) -> None:
    """An arrow of cylinder and cones; two heads for a moment."""
    import pyvista

    way = tip - tail
    length = float(np.linalg.norm(way))
    way = way / length
    head = 0.26 * length
    end = tip - head * (1.0 + 0.75 * (heads - 1)) * way
    shank = pyvista.Cylinder(
        center=(tail + end) / 2,
        direction=way,
        radius=0.045 * length,
        height=float(np.linalg.norm(end - tail)),
        resolution=32,
    )
    plotter.add_mesh(shank, color=colour, ambient=0.3)
    for k in range(heads):
        middle = tip - (0.5 + 0.75 * k) * head * way
        cone = pyvista.Cone(
            center=middle, direction=way, height=head, radius=0.115 * length, resolution=48
        )
        plotter.add_mesh(cone, color=colour, ambient=0.3)


def _hub_arrows(hub: Floats, a: float) -> list[tuple[str, Floats, Floats]]:
    """Name, tail and tip of the arrows of the six hub loads: moments beyond forces.

    All point along the positive axes. Those along x stand upstream, outside the shaft.
    """
    arrows = []
    for axis, e in zip(_AXES, np.eye(3), strict=True):
        tails = (-1.0, -2.3) if axis == "x" else (0.0, 1.3)
        for letter, at in zip("FM", tails, strict=True):
            arrows.append((f"{letter}{axis}", hub + a * at * e, hub + a * (at + 1.0) * e))
    return arrows


def _add_hub_loads(plotter: Any, hub: Floats, a: float) -> None:
    for name, tail, tip in _hub_arrows(hub, a):
        moment = name.startswith("M")
        _add_arrow(plotter, tail, tip, _MOMENT if moment else _FORCE, 2 if moment else 1)


def _add_gearbox(plotter: Any, gearbox: Gearbox, rear: Floats, radius: float, a: float) -> None:
    """Springs (coils), rigid supports (rods) and the weight (an arrow from above)."""
    import pyvista

    x, y, z = np.eye(3)
    # towards the viewer and down, where they hide nothing
    starts = ((x, 0.0), (-y, radius), (-z, radius))
    for (way, start), k in zip(starts, gearbox.stiffness[:3], strict=True):
        if k == 0:
            continue
        foot, ground = rear + start * way, rear + (start + a) * way
        if k == "rigid":
            shape = pyvista.Tube(pointa=foot, pointb=ground, radius=0.06 * a)
        else:
            shape = _coil(foot, ground, 0.13 * a).tube(radius=0.022 * a, n_sides=16)
        plotter.add_mesh(shape, color=_SPRING, ambient=0.3)
        plate_x, plate_y, plate_z = np.where(way != 0, 0.06 * a, 0.45 * a)
        plate = pyvista.Cube(center=ground, x_length=plate_x, y_length=plate_y, z_length=plate_z)
        plotter.add_mesh(plate, color=_GROUND, ambient=0.3)
    if gearbox.weight > 0:
        tip = rear + radius * z
        _add_arrow(plotter, tip + a * z, tip, _FORCE)


def _coil(start: Floats, end: Floats, radius: float, turns: int = 6) -> Any:
    """A helical spring with straight ends, as a line."""
    import pyvista

    length = float(np.linalg.norm(end - start))
    way = (end - start) / length
    side = np.cross(way, [0.3, 0.5, 0.8])
    side /= np.linalg.norm(side)
    other = np.cross(way, side)
    s = np.linspace(0.0, 1.0, 40 * turns)
    r = radius * np.clip(np.minimum(s, 1.0 - s) / 0.12 - 0.6, 0.0, 1.0)
    angle = 2 * np.pi * turns * s
    points = start + np.outer(length * s, way)
    points += (r * np.cos(angle))[:, None] * side + (r * np.sin(angle))[:, None] * other
    return pyvista.lines_from_points(points)


# --- what is written over them --------------------------------------------------------------------


class _Canvas:
    """The rendered image, to write on; all lengths in pixels of the finished picture."""

    def __init__(self, view: _View, plotter: Any) -> None:
        self.view = view
        self.image = Image.fromarray(plotter.screenshot(None, return_img=True)).convert("RGB")
        self.draw = ImageDraw.Draw(self.image)
        self.taken: list[tuple[float, float, float, float]] = []

    def save(self, path: Path) -> None:
        self.image.resize(SIZE, Image.Resampling.LANCZOS).save(path, format="PNG")

    def line(self, points: _Points, colour: str = _INK, width: float = 1.4) -> None:
        flat = [tuple(p) for p in _OVERSAMPLING * np.asarray(points)]
        self.draw.line(flat, fill=colour, width=round(_OVERSAMPLING * width), joint="curve")

    def polygon(self, points: _Points, colour: str) -> None:
        self.draw.polygon([tuple(p) for p in _OVERSAMPLING * np.asarray(points)], fill=colour)

    def text(
        self,
        at: _Point,
        text: str,
        colour: str = _INK,
        size: float = 19,
        anchor: str = "lm",
        on_white: bool = False,
    ) -> None:
        """Write with a white rim, or on a white box."""
        font = ImageFont.load_default(_OVERSAMPLING * size)
        place = (_OVERSAMPLING * at[0], _OVERSAMPLING * at[1])
        rim = 3 * _OVERSAMPLING
        if on_white:
            left, top, right, bottom = self.draw.textbbox(place, text, font=font, anchor=anchor)
            self.draw.rectangle((left - rim, top - rim, right + rim, bottom + rim), fill="white")
        else:
            self.draw.text(
                place, text, font=font, anchor=anchor, stroke_width=rim, stroke_fill="white"
            )
        self.draw.text(place, text, fill=colour, font=font, anchor=anchor)

    def note(
        self, point: Floats, text: str, offset: tuple[float, float], colour: str = _INK
    ) -> None:
        """Label a point from a distance, with a line to it; out of the way of earlier labels."""
        foot = self.view.project(point)
        across, down = offset
        font = ImageFont.load_default(_OVERSAMPLING * 19)
        half = self.draw.textlength(text, font=font) / _OVERSAMPLING / 2
        low, high = np.array([half + 12, 20]), np.array([SIZE[0] - half - 12, SIZE[1] - _STRIP])
        for step in range(10):
            at = np.clip(
                foot + np.array([across, down + math.copysign(32 * step, down)]), low, high
            )
            box = (at[0] - half - 6, at[1] - 14, at[0] + half + 6, at[1] + 14)
            if not any(_overlap(box, other) for other in self.taken):
                break
        self.line([foot, at], colour, 1.2)
        x, y = _OVERSAMPLING * foot
        r = 4 * _OVERSAMPLING
        self.draw.ellipse((x - r, y - r, x + r, y + r), fill=colour)
        corners = (_OVERSAMPLING * side for side in box)
        self.draw.rounded_rectangle(tuple(corners), 6 * _OVERSAMPLING, fill="white", outline=colour)
        self.text(at, text, colour, anchor="mm")
        self.taken.append(box)

    def dimensions(self, stations: Sequence[float], under: Floats, mesh: Mesh) -> None:
        """A chain of dimensions along x, next to the line under the solids."""
        line = self.view.project(under) + np.array([0.0, 34.0])
        for x, end in zip(stations, line, strict=True):
            near = mesh.points[np.abs(mesh.points[:, 0] - x) < 0.03 * np.ptp(stations)]
            lowest = np.array([x, 0.0, near[:, 2].min()])
            self.dashed(self.view.project(lowest), end + np.array([0.0, 8.0]))
        for (x0, p), (x1, q) in pairwise(zip(stations, line, strict=True)):
            way = (q - p) / np.linalg.norm(q - p)
            across = np.array([-way[1], way[0]])
            self.line([p, q])
            for tip, sign in ((p, 1.0), (q, -1.0)):
                back = tip + 13 * sign * way
                self.polygon([tip, back + 4 * across, back - 4 * across], _INK)
            self.text((p + q) / 2, f"{x1 - x0:.4g} m", anchor="mm", on_white=True)

    def dashed(self, start: Floats, end: Floats) -> None:
        length = float(np.linalg.norm(end - start))
        for s in np.arange(0.0, length, 9.0):
            piece = [start + (end - start) * min(t / length, 1.0) for t in (s, s + 4.5)]
            self.line(piece, _FAINT, 1.2)

    def triad(self) -> None:
        """The axes of the frame, in the lower left corner."""
        origin = np.array([88.0, SIZE[1] - 80.0])
        for axis, e in zip(_AXES, np.eye(3), strict=True):
            way = self.view.project(self.view.centre + e) - self.view.project(self.view.centre)
            way = 58 * way / self.view.scale
            tip = origin + way
            along = way / np.linalg.norm(way)
            across = np.array([-along[1], along[0]])
            self.line([origin, tip], _INK, 2.2)
            self.polygon([tip + 8 * along, tip + 5 * across, tip - 5 * across], _INK)
            self.text(tip + 21 * along, axis, anchor="mm", size=20)

    def scale_bar(self) -> None:
        """A length along x, as it is drawn, beside the axes."""
        metre = self.view.project(np.eye(3)[0]) - self.view.project(np.zeros(3))
        pixels = float(np.linalg.norm(metre))
        length = _round_step(250 / pixels, 2)
        start = np.array([210.0, SIZE[1] - 70.0])
        end = start + length * metre
        across = 7 * np.array([-metre[1], metre[0]]) / pixels
        self.line([start, end], _INK, 2.2)
        for tip in (start, end):
            self.line([tip - across, tip + across], _INK, 2.2)
        self.text((start + end) / 2 + 2.6 * across, f"{length:g} m along x", anchor="mm", size=17)

    def heading(self, text: str) -> None:
        self.text((_MARGIN, 40), text, size=24)

    def column(self, left: float, rows: Sequence[tuple[str, str | None]]) -> None:
        """Lines of text in the strip below the picture.

        Parameters
        ----------
        left
            Where the column begins, pixels.
        rows
            (text, colour of a swatch), colour "head" for a heading and None for no swatch.
        """
        y = SIZE[1] - _STRIP + 22
        indent = 30 if any(colour not in (None, "head") for _, colour in rows) else 0
        for text, colour in rows:
            if colour == "head":
                self.text((left, y), text, size=19)
                y += 30
                continue
            if colour is not None:
                box = [(left, y - 8), (left + 20, y - 8), (left + 20, y + 8), (left, y + 8)]
                self.polygon(box, colour)
            self.text((left + indent, y), text, size=17)
            y += 24

    def colour_bar(self, largest: float, title: str) -> None:
        """The scale of the colours, from 0."""
        import pyvista

        colours = pyvista.LookupTable(_COLOURS, n_values=256).values[:, :3]
        left, top, width, height = 590, SIZE[1] - 110, 420, 26
        self.text((left + width / 2, top - 26), title, size=19, anchor="mm")
        for column in range(width):
            shade = colours[round(255 * column / (width - 1))]
            corners = [left + column, top, left + column + 1, top + height]
            box = tuple(_OVERSAMPLING * side for side in corners)
            self.draw.rectangle(box, fill=tuple(int(c) for c in shade))
        step = _round_step(largest, 8)
        for number in range(math.floor(largest / step * (1 + 1e-9)) + 1):
            x = left + width * number * step / largest
            self.line([(x, top + height), (x, top + height + 8)], _INK, 1.4)
            self.text((x, top + height + 22), f"{number * step:g}", size=18, anchor="mm")


def _overlap(first: Sequence[float], second: Sequence[float]) -> bool:
    return (
        first[0] < second[2]
        and second[0] < first[2]
        and first[1] < second[3]
        and second[1] < first[3]
    )


def _round_step(largest: float, most: int) -> float:
    """The least of 1, 2, 5, 10, ... whose multiples divide a range in at most so many."""
    power = 10.0 ** math.floor(math.log10(largest / most))
    steps = [m * power for m in (1, 2, 5, 10) if largest / (m * power) <= most * (1 + 1e-9)]
    return float(steps[0])


def _line_under(mesh: Mesh, stations: Sequence[float]) -> Floats:
    """Points (n, 3) under the axis at each station, on a line that no solid is below as seen."""
    slope = _View.UP[0] / _View.RIGHT[0]
    across, along = mesh.points @ _View.RIGHT, mesh.points @ _View.UP
    depth = (slope * across - along).max()
    axis = np.outer(stations, np.eye(3)[0])
    points: Floats = axis - depth * _View.UP
    return points


def _label_hub_loads(canvas: _Canvas, hub: Floats, a: float) -> None:
    sides = {"x": (0.0, 26.0), "y": (-2.0, -24.0), "z": (28.0, 0.0)}
    for name, tail, tip in _hub_arrows(hub, a):
        # an arrow along y is foreshortened: its head has the most room
        middle = canvas.view.project(tip if name.endswith("y") else (tail + tip) / 2)
        colour = _MOMENT if name.startswith("M") else _FORCE
        canvas.text(middle + sides[name[1]], name, colour, anchor="mm")


def _label_parts(canvas: _Canvas, model: Model) -> None:
    mesh = model.mesh
    canvas.note(model.points["hub"].position, "hub", (-110, 120))
    canvas.note(model.points["gearbox"].position, "gearbox", (100, -115))
    for unit in model.scene.bearing_units:
        name = unit.bearing.name
        # the upright face of the cut shows the bearing at y = 0, between seat and outer face
        faces = (f"{name}.outer", f"shaft.seat.{name}")
        height = np.mean([mesh.points[mesh.face_nodes(face)][:, 2].max() for face in faces])
        middle = np.array([unit.bearing.x, 0.0, height])
        canvas.note(middle, name.replace("_", " "), (-60, -150))
        base = mesh.points[mesh.face_nodes(f"{name}.housing.base")]
        corner = base[np.argmin(base @ [1.0, 1.0, 0.0])]
        if unit.housing.base == "bolted":
            top = corner + unit.housing.foot_thickness * np.eye(3)[2]
            bolts = "fixed at the bolts" if unit.bedplate is None else "bolted to a bedplate"
            canvas.note(top, bolts, (-150, 80), _GROUND)
        else:
            stands = "fixed base" if unit.bedplate is None else "on a bedplate"
            canvas.note(corner, stands, (-140, 14), _GROUND)


def _model_legend(model: Model) -> list[list[tuple[str, str | None]]]:
    """Four columns: parts, interfaces, hub loads, gearbox."""
    scene = model.scene
    materials: dict[tuple[str, str], None] = {}
    for part in model.mesh.part_names:
        kind = _kind(part)
        unit = None if kind == "shaft" else scene.bearing_unit(part.partition(".")[0])
        owner = scene.shaft if unit is None else unit.housing if kind == "housing" else unit.bearing
        modulus = with_prefix(scene.material_of(part).youngs_modulus, "Pa")
        materials[kind, f"{kind}: {owner.material.replace('_', ' ')}, E = {modulus}"] = None
    parts = [(text, _PARTS[kind]) for kind, text in materials]
    interfaces = [
        (f"{unit.bearing.name.replace('_', ' ')}: {_INTERFACES[unit.interface]}", None)
        for unit in scene.bearing_units
    ]
    gearbox: list[tuple[str, str | None]] = []
    for name, k in zip(("x", "y", "z", "rx", "ry", "rz"), scene.gearbox.stiffness, strict=True):
        unit_name = "N m/rad" if name.startswith("r") else "N/m"
        value = "held" if k == "rigid" else f"k = {with_prefix(k, unit_name)}" if k else "free"
        gearbox.append((f"{name}: {value}", _SPRING if k else None))
    if scene.gearbox.weight:
        gearbox.append((f"weight: {with_prefix(scene.gearbox.weight, 'N')}", _FORCE))
    hub = [
        (f"forces ({scene.hub.coupling} over the face)", _FORCE),
        ("moments (two heads)", _MOMENT),
    ]
    return [
        [("Parts", "head"), *parts, ("fixed to the ground", _GROUND)],
        [("Interfaces", "head"), *interfaces],
        [("Loads at the hub", "head"), *hub],
        [("Gearbox", "head"), *gearbox],
    ]


def with_prefix(value: float, unit: str) -> str:
    """A positive number in its unit with an SI prefix: 80e6 N/m is "80 MN/m"."""
    power = min(max(math.floor(math.log10(value) / 3), 0), 4)
    return f"{value / 1e3**power:.4g} {('', 'k', 'M', 'G', 'T')[power]}{unit}"
