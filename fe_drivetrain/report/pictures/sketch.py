"""A body as a small picture in milliseconds: its faces from far to near, those behind left out."""

from __future__ import annotations

import io
import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from fe_drivetrain.common.arrays import Bools, Floats, Ints
from fe_drivetrain.elasticity.mesh.facets import outside
from fe_drivetrain.elasticity.mesh.mesh import Mesh
from fe_drivetrain.geometry.shaft import Section, Segment, Shaft
from fe_drivetrain.plots.style import PALETTE

if TYPE_CHECKING:
    from PIL import ImageDraw

    from fe_drivetrain.drivetrain_file.scene import Scene

MAX_FACES = 20_000
"""From a quarter of as many facets on curved ones are drawn by their corners."""
WIDTH, MARGIN, STRIP = 900, 30, 56
"""Pixels of the picture, round the body, and below it for axes and scale."""
_MINIMUM, _MAXIMUM = 140, 420  # pixels of its height
_FINER = 2  # drawn larger, so that lines are smooth
_EYE = np.array([-0.55, -1.0, 0.55]) / math.sqrt(0.55**2 + 1.0 + 0.55**2)
_RIGHT = np.array([1.0, -0.55, 0.0]) / math.hypot(1.0, 0.55)
_UP = np.cross(_RIGHT, -_EYE)
_LIGHT = np.array([-0.3, -0.75, 0.6]) / math.sqrt(0.3**2 + 0.75**2 + 0.6**2)
_ROUND, _ARC = 48, 8  # pieces of a turn of a shaft, and of a fillet
_INK, _FAINT = (31, 41, 51), (123, 135, 148)


@dataclass(frozen=True)
class Faces:
    """Flat pieces of a surface, turned outward.

    Attributes
    ----------
    loops : Floats
        (n, m, 3) corners [m].
    sides : Bools
        (n, m) whether there is a line from each corner to the next.
    """

    loops: Floats
    sides: Bools


class Body(Protocol):
    """What has nodes and elements: a mesh, a block, hexahedra of a shaft, several blocks."""

    @property
    def points(self) -> Floats:
        """(n, 3) positions of nodes [m]."""

    @property
    def cells(self) -> Ints | tuple[Ints, ...]:
        """Nodes in VTK's order: (ne, 4), (ne, 8), (ne, 10), (ne, 20), (ne, 27); or such by part."""


@dataclass(frozen=True)
class Piece:
    """A body for `sketch` that stands in no other class.

    Attributes
    ----------
    points : Floats
        (n, 3) positions of nodes [m].
    cells : Ints
        (ne, k) nodes in VTK's order.
    """

    points: Floats
    cells: Ints


def sketch(*bodies: Body | Shaft | list[Faces]) -> bytes:
    """Bodies in parallel perspective, each in a colour of its own, with axes and a scale.

    Parameters
    ----------
    *bodies : Body, Shaft or list of Faces
        Meshes, whose elements are seen, part by part where they have several, shafts, or surfaces.

    Returns
    -------
    png : bytes
        The picture.
    """
    from PIL import Image, ImageDraw

    parts = [part for body in bodies for part in _parts(body)]
    groups = [(k, faces) for k, part in enumerate(parts) for faces in _faces(part)]
    seen = [_seen(faces.loops) for _, faces in groups]
    points = np.concatenate([at.reshape(-1, 2) for at in seen])
    low, high = points.min(axis=0), points.max(axis=0)
    room = np.array([WIDTH, _MAXIMUM]) - 2 * MARGIN
    scale = float((room / np.maximum(high - low, 1e-12 * float(np.abs(points).max()))).min())
    height = max(_MINIMUM, round(scale * (high - low)[1]) + 2 * MARGIN)
    middle, half = 0.5 * (low + high), 0.5 * np.array([WIDTH, height])
    image = Image.new("RGB", (_FINER * WIDTH, _FINER * (height + STRIP)), "white")
    draw = ImageDraw.Draw(image)
    corners, lines, depths, bright, colours = [], [], [], [], []
    for (k, faces), at in zip(groups, seen, strict=True):
        normals = _normals(faces.loops)
        front = normals @ _EYE > 1e-9
        at = _FINER * (half + scale * (at[front] - middle) * (1.0, -1.0))
        corners += [[tuple(corner) for corner in loop] for loop in at.tolist()]
        lines += faces.sides[front].tolist()
        depths.append((faces.loops[front] @ _EYE).mean(axis=1))
        bright.append(normals[front] @ _LIGHT)
        colours += [PALETTE[k % len(PALETTE)]] * len(at)
    fills, edges = (_shaded(colours, np.concatenate(bright) - dark) for dark in (0.0, 0.6))
    for k in np.argsort(np.concatenate(depths)).tolist():
        draw.polygon(corners[k], fill=fills[k], outline=fills[k])
        following = [*corners[k][1:], corners[k][0]]
        for start, end, is_line in zip(corners[k], following, lines[k], strict=True):
            if is_line:
                draw.line([start, end], fill=edges[k], width=_FINER)
    _axes(draw, height + STRIP)
    _scale_bar(draw, scale, height + STRIP)
    small = image.reduce(_FINER)
    file = io.BytesIO()
    small.quantize(128).save(file, "PNG", optimize=True)
    return file.getvalue()


def shaft_with_rings(scene: Scene) -> tuple[Shaft, ...]:
    """The shaft of a scene and the rings of its bearings, or its nose, for `sketch`; no housing."""
    rings = []
    for unit in scene.bearing_units:
        own = unit.bearing
        seat = own.bore_diameter or scene.seat_diameter(own.name)
        section = Section(
            length=own.width, outer_diameter=own.raceway_diameter, inner_diameter=seat
        )
        rings.append(Shaft(front=own.x - 0.5 * own.width, sections=(section,)))
    return scene.shaft, *rings, *([scene.nose.body] if scene.nose else [])


def surface(points: Floats, cells: Ints) -> list[Faces]:
    """Facets that belong to one element only, curved ones in flat pieces.

    Parameters
    ----------
    points, cells : Floats, Ints
        (n, 3) [m] and (ne, k) of one kind of element.
    """
    facets = outside(cells)
    corners = 3 if facets.shape[1] in (3, 6) else 4
    at = points[facets]
    if facets.shape[1] in (3, 4) or len(facets) > MAX_FACES // 4:
        loops = at[:, :corners]
        return [Faces(loops, np.ones(loops.shape[:2], dtype=bool))]
    if corners == 3:
        pieces = at[:, [[0, 3, 5], [3, 1, 4], [5, 4, 2], [3, 4, 5]]].reshape(-1, 3, 3)
        sides = np.array([[1, 0, 1], [1, 1, 0], [0, 1, 1], [0, 0, 0]], dtype=bool)
        return [Faces(pieces, np.tile(sides, (len(at), 1)))]
    if at.shape[1] == 8:  # of serendipity elements: the middle follows from the rest
        middle = 0.5 * at[:, 4:].sum(axis=1) - 0.25 * at[:, :4].sum(axis=1)
        at = np.concatenate([at, middle[:, None]], axis=1)
    return [_in_pieces(at, 3 if len(at) < MAX_FACES // 40 else 2)]


def _in_pieces(at: Floats, n: int) -> Faces:
    """(nf, 9, 3) biquadratic facets, each in n x n flat ones."""
    t = np.linspace(0.0, 1.0, n + 1)
    shape = np.stack([(1 - t) * (1 - 2 * t), 4 * t * (1 - t), t * (2 * t - 1)])
    nodes = at[:, [[0, 4, 1], [7, 8, 5], [3, 6, 2]]]
    grid = np.einsum("ai,bj,fabx->fijx", shape, shape, nodes)
    one, two = grid[:, :-1], grid[:, 1:]
    loops = np.stack([one[:, :, :-1], one[:, :, 1:], two[:, :, 1:], two[:, :, :-1]], axis=3)
    i, j = np.meshgrid(np.arange(n), np.arange(n), indexing="ij")
    sides = np.stack([i == 0, j == n - 1, i == n - 1, j == 0], axis=2)
    return Faces(loops.reshape(-1, 4, 3), np.tile(sides.reshape(-1, 4), (len(at), 1)))


def revolved(shaft: Shaft) -> list[Faces]:
    """Outer surface with its fillets, bore and end faces of a shaft."""
    inside, x = [], shaft.front
    for piece in shaft.pieces:
        last = x + piece.length
        inside += [(x, 0.5 * piece.inner_diameter), (last, 0.5 * piece.inner_diameter)]
        x = last
    lines = [_flat(segment) for segment in shaft.outer_profile()]
    back = [lines[-1][-1], *inside[::-1], lines[0][0]]
    lines += [np.array(ends) for ends in pairwise(back)]
    return turned(lines)


def turned(lines: Sequence[Floats], around: int = _ROUND) -> list[Faces]:
    """Surfaces of revolution about x.

    Parameters
    ----------
    lines : Sequence[Floats]
        (n, 2) x and radius [m] along smooth lines, with the body on their right.
    around : int
        Flat pieces of a turn.
    """
    turn = np.linspace(0.0, 2.0 * np.pi, around + 1)
    round_it = np.stack([np.ones(around + 1), np.cos(turn), np.sin(turn)], axis=1)
    found = []
    for line in lines:
        if np.array_equal(line[0], line[-1]) or line[:, 1].max() == 0.0:
            continue
        # in short bands: their depths say which is in front of which
        length = float(np.linalg.norm(np.diff(line, axis=0), axis=1).sum())
        count = min(max(math.ceil(4.0 * length / line[:, 1].max()), 1), 60)
        count = max(count // (len(line) - 1), 1)
        bands = [
            [start + (stop - start) * share / count for share in (k, k + 1)]
            for start, stop in pairwise(line)
            for k in range(count)
        ]
        for k, ends in enumerate(bands):
            one, two = (round_it * [end[0], end[1], end[1]] for end in ends)
            loops = np.stack([one[:-1], one[1:], two[1:], two[:-1]], axis=1)
            sides = [k == 0, False, k == len(bands) - 1, False]
            found.append(Faces(loops, np.tile(sides, (around, 1))))
    return found


def _flat(segment: Segment) -> Floats:
    """(n, 2) a piece of a meridian, an arc in short straight lines."""
    start, end = np.array(segment.start), np.array(segment.end)
    if segment.centre is None:
        return np.array([start, end])
    centre = np.array(segment.centre)
    (x0, y0), (x1, y1) = start - centre, end - centre
    first = math.atan2(y0, x0)
    # the shorter way round
    angle = math.remainder(math.atan2(y1, x1) - first, 2.0 * math.pi)
    turned = first + angle * np.linspace(0.0, 1.0, _ARC + 1)
    arc = centre + math.hypot(x0, y0) * np.stack([np.cos(turned), np.sin(turned)], axis=1)
    arc[[0, -1]] = start, end
    return arc


def _parts(body: Body | Shaft | list[Faces]) -> list[Piece | Shaft | list[Faces]]:
    """The parts of a body that has several, each by itself."""
    if isinstance(body, (Shaft, list)):
        return [body]
    if isinstance(body, Mesh):
        return [Piece(body.points, body.cells[body.part_cells(n)]) for n in body.part_names]
    several = body.cells if isinstance(body.cells, tuple) else (body.cells,)
    return [Piece(body.points, cells) for cells in several]


def _faces(part: Piece | Shaft | list[Faces]) -> list[Faces]:
    if isinstance(part, list):
        return part
    return revolved(part) if isinstance(part, Shaft) else surface(part.points, part.cells)


def _seen(points: Floats) -> Floats:
    """(..., 2) to the right and up."""
    return np.stack([points @ _RIGHT, points @ _UP], axis=-1)


def _normals(loops: Floats) -> Floats:
    """(n, 3) unit normals of loops by Newell's sums; zero of those without area."""
    first = loops[:, :1]
    area = np.cross(loops - first, np.roll(loops, -1, axis=1) - first).sum(axis=1)
    size = np.linalg.norm(area, axis=1, keepdims=True)
    return np.asarray(np.divide(area, size, out=area, where=size > 0.0))


def _shaded(colours: Sequence[str], towards_light: Floats) -> list[tuple[int, int, int]]:
    """Colours made paler, and darker where they are turned away from the light."""
    red_green_blue = {c: [int(c[k : k + 2], 16) for k in (1, 3, 5)] for c in set(colours)}
    own = np.array([red_green_blue[colour] for colour in colours])
    bright = 0.62 + 0.38 * np.maximum(towards_light, -1.0)
    mixed = (0.45 * own + 0.55 * 235.0) * bright[:, None]
    return [(r, g, b) for r, g, b in np.clip(mixed, 0, 255).astype(int).tolist()]


def _font(size: int) -> Any:
    from PIL import ImageFont

    return ImageFont.load_default(_FINER * size)


def _axes(draw: ImageDraw.ImageDraw, height: int) -> None:
    """x, y and z in the lower left corner."""
    start = np.array([MARGIN + 10.0, height - 18.0])
    for name, direction in zip("xyz", np.eye(3), strict=True):
        end = start + 26.0 * _seen(direction) * (1.0, -1.0)
        draw.line([*(_FINER * start), *(_FINER * end)], fill=_INK, width=3)
        beyond = start + 37.0 * _seen(direction) * (1.0, -1.0)
        draw.text(tuple(_FINER * beyond), name, fill=_INK, font=_font(13), anchor="mm")


def _scale_bar(draw: ImageDraw.ImageDraw, scale: float, height: int) -> None:
    """A round length in the lower right corner, as long as it is across the line of sight."""
    length = 130.0 / scale
    power = 10.0 ** math.floor(math.log10(length))
    whole = max(n for n in (1, 2, 5) if n * power <= length) * power
    right, y = WIDTH - MARGIN, height - 16
    ends = (right - whole * scale, right)
    draw.line([_FINER * ends[0], _FINER * y, _FINER * ends[1], _FINER * y], fill=_FAINT, width=4)
    text = f"{whole:g} m" if whole >= 0.1 else f"{1000 * whole:g} mm"
    at = (_FINER * 0.5 * sum(ends), _FINER * (y - 10))
    draw.text(at, text, fill=_FAINT, font=_font(13), anchor="mm")
