"""Parts driven through the limits of their dimensions, with their exact volumes and areas."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from fe_drivetrain.common import Floats, InputError
from fe_drivetrain.elasticity.mesh import Mesh, area, find_faults, generate, inverted_cells, volume
from fe_drivetrain.geometry import Bearing, Housing, MeshSizes, Section, Shaft

TURN = 8
SIZES = MeshSizes(shaft=0.3, bearing=0.12, housing=0.15, bearing_edge=0.06, elements_per_turn=TURN)


@dataclass(frozen=True)
class Assembly:
    """Parts, mesh sizes, and what they measure.

    Attributes
    ----------
    shaft, bearing, housing, sizes : Shaft or None, Bearing or None, Housing or None, MeshSizes
        As for `mesh.generate`.
    volumes, areas : dict[str, float]
        Exact ones by part and by named face [m^3, m^2].
    round_off : dict[str, float]
        By part or face: what a round surface in parabolas may change, relative.
    """

    shaft: Shaft | None
    volumes: dict[str, float]
    areas: dict[str, float]
    sizes: MeshSizes = SIZES
    bearing: Bearing | None = None
    housing: Housing | None = None
    round_off: dict[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Outcome:
    """What became of one value of a parameter.

    Attributes
    ----------
    value : float
        Of the parameter.
    sentence : str
        Of the refusal, empty where it was meshed.
    clear : bool
        Whether that is the program's own sentence: object, allowed range, fix; or it was meshed.
    error : float
        Largest relative error of a volume or area; NaN where refused.
    allowed : float
        Largest such error over what the shape error of the round surfaces allows, and of an end of
        the shaft what `drawn_back` measures.
    folded, faults : int
        Elements not proved sound, and kinds of other faults.
    elements : int
        Number of them.
    """

    value: float
    sentence: str = ""
    clear: bool = True
    error: float = math.nan
    allowed: float = 0.0
    folded: int = 0
    faults: int = 0
    elements: int = 0


def sagging(turn: float) -> float:
    """Relative error of a circle's area drawn with so many parabolas through points on it.

    Each has two thirds of the area of the rectangle round it.
    """
    a = math.pi / turn
    drawn = turn * (math.sin(a) * math.cos(a) + 4 / 3 * math.sin(a) * (1 - math.cos(a)))
    return 1 - drawn / math.pi


#: Elements may be longer than asked for: three quarters of their number round a turn.
SHAPE_ERROR = sagging(0.75 * TURN)


def drawn_back(mesh: Mesh, face: str) -> float:
    """Area by which edges drawn back from a circle change a plane end of the shaft.

    `mesh.relax_flat_cells` does that to a cell which lies with all of its corners on the cylinder.

    Parameters
    ----------
    mesh : Mesh
        Of a shaft along x.
    face : str
        Its end.

    Returns
    -------
    float
        Two thirds of chord times distance, of each mid-side node from the circle through the
        corners beside it [m^2].
    """
    facets = mesh.faces[face]
    edges = facets[:, [[0, 1, 3], [1, 2, 4], [2, 0, 5]]].reshape(-1, 3)
    _, first, sides = np.unique(edges[:, 2], return_index=True, return_counts=True)
    a, b, mid = mesh.points[edges[first[sides == 1]].T]
    chord = np.linalg.norm(b - a, axis=1)
    off = np.hypot(a[:, 1], a[:, 2]) - np.hypot(mid[:, 1], mid[:, 2])
    return float(2 / 3 * (chord * np.abs(off)).sum())


def outcome(value: float, make: Callable[[float], Assembly]) -> Outcome:
    """Build and mesh, and measure the mesh; or what the refusal says."""
    try:
        made = make(value)
        bearings = [] if made.bearing is None else [made.bearing]
        housings = {} if made.housing is None else {bearings[0].name: made.housing}
        mesh = generate(made.shaft, bearings, housings, made.sizes)
    except InputError as error:
        text = str(error)
        clear = "\n" not in text and ": " in text and "must" in text and "gmsh" not in text
        return Outcome(value, text, clear)
    found = {name: volume(mesh, name) for name in made.volumes}
    found |= {name: area(mesh, name) for name in made.areas}
    exact = made.volumes | made.areas
    errors = {name: abs(found[name] / exact[name] - 1) for name in exact}
    allowed = {name: made.round_off.get(name, SHAPE_ERROR) for name in exact}
    for name in {"shaft.front", "shaft.rear"} & set(made.areas):
        allowed[name] += drawn_back(mesh, name) / exact[name]
    share = [errors[name] / allowed[name] for name in exact]
    return Outcome(
        value,
        error=max(errors.values()),
        allowed=max(share),
        folded=len(inverted_cells(mesh)),
        faults=len(find_faults(mesh, made.areas)),
        elements=len(mesh.cells),
    )


def _stack(*pieces: tuple[float, float]) -> float:
    """Volume of solid cylinders of (length, diameter)."""
    return math.fsum(math.pi / 4 * d * d * length for length, d in pieces)


def _shaft(*sections: Section, front: float = 0.0) -> Shaft:
    return Shaft(front=front, sections=sections)


def bored(ratio: float, fine: bool = False) -> Assembly:
    """A ring of 0.4 m, its bore so large; finely meshed as thick as its wall, and as short."""
    outer = 0.4
    wall = outer * (1 - ratio) / 2
    length = min(0.5, 10 * wall) if fine else 0.5
    sizes = SIZES.model_copy(update={"shaft": min(2 * wall, 0.3)}) if fine else SIZES
    turn = max(TURN, math.pi * outer / sizes.shaft)
    inner = outer * ratio
    ring = _stack((length, outer)) - _stack((length, inner))
    disc = sagging(0.75 * turn) * _stack((length, outer)) / max(ring, 1e-300)
    return Assembly(
        _shaft(Section(length=length, outer_diameter=outer, inner_diameter=inner)),
        {"shaft": ring},
        {"shaft.bore": math.pi * inner * length, "shaft.front": ring / length},
        sizes,
        round_off={"shaft": disc, "shaft.front": disc, "shaft.bore": sagging(0.75 * turn)},
    )


def pierced(ratio: float) -> Assembly:
    """The same shaft with a thin bore."""
    return bored(ratio)


def filleted(ratio: float) -> Assembly:
    """A step of 0.05 m in radius with a fillet of so much of it."""
    step, thin, length = 0.05, 0.1, 0.2
    r = ratio * step
    spandrel = r * r * (1 - math.pi / 4)
    centroid = r * (10 - 3 * math.pi) / (12 - 3 * math.pi)
    wide = thin + 2 * step
    whole = _stack((length, thin), (length, wide))
    return Assembly(
        _shaft(
            Section(length=length, outer_diameter=thin, fillet=r),
            Section(length=length, outer_diameter=wide),
        ),
        {"shaft": whole + 2 * math.pi * (thin / 2 + centroid) * spandrel},
        {"shaft.front": _stack((1, thin)), "shaft.rear": _stack((1, wide))},
    )


def collared(length: float) -> Assembly:
    """A collar of 0.5 m on a shaft of 0.4 m, of so much length."""
    return Assembly(
        _shaft(
            Section(length=0.5, outer_diameter=0.4),
            Section(length=length, outer_diameter=0.5),
            Section(length=0.5, outer_diameter=0.4),
        ),
        {"shaft": _stack((1.0, 0.4), (length, 0.5))},
        {"shaft.front": _stack((1, 0.4)), "shaft.rear": _stack((1, 0.4))},
    )


def seated(ratio: float) -> Assembly:
    """A bearing of so much of the width of its seat, between shoulders of 0.44 and 0.36 m."""
    seat, sphere, bore = 0.4, 0.8, 0.4
    width = ratio * seat
    zone = math.pi * (sphere**2 / 4 * width - width**3 / 12)
    # a bearing that fills its seat stands against the shoulder, too
    shoulder = _stack((1, 0.44), (-1, bore)) if abs(ratio - 1) < 1e-9 else 0.0
    return Assembly(
        _shaft(
            Section(length=0.2, outer_diameter=0.44),
            Section(length=seat, outer_diameter=bore),
            Section(length=0.2, outer_diameter=0.36),
            front=-0.4,
        ),
        {
            "main_bearing": zone - _stack((width, bore)),
            "shaft": _stack((0.2, 0.44), (seat, bore), (0.2, 0.36)),
        },
        {
            "shaft.seat.main_bearing": math.pi * bore * width + shoulder,
            "main_bearing.outer": math.pi * sphere * width,
        },
        bearing=Bearing(width=width, raceway_diameter=sphere),
    )


def walled(ratio: float, fine: bool = False) -> Assembly:
    """A housing with a wall of so many mesh sizes of 0.15 m; finely: one mesh size is two walls."""
    wall = 0.15 * ratio
    sizes = SIZES.model_copy(update={"housing": 2 * wall}) if fine else SIZES
    bearing = Bearing(bore_diameter=0.4)
    radius = bearing.raceway_diameter / 2 + wall
    housing = Housing(wall=wall, pedestal_width=2 * radius)
    block = housing.width * (
        math.pi * radius**2 / 2 + 2 * radius * (housing.centre_height - housing.foot_thickness)
    )
    foot = housing.foot_length * housing.foot_width * housing.foot_thickness
    sphere = math.pi * (bearing.raceway_diameter**2 / 4 * housing.width - housing.width**3 / 12)
    return Assembly(
        None,
        {"main_bearing.housing": block + foot - sphere},
        {
            "main_bearing.housing.base": housing.foot_length * housing.foot_width,
            "main_bearing.housing.bore": math.pi * bearing.raceway_diameter * bearing.width,
        },
        sizes,
        bearing,
        housing,
    )


def meshed(outcomes: list[Outcome]) -> Floats:
    """Values of the parameter that were meshed, ascending."""
    return np.sort(np.array([o.value for o in outcomes if not o.sentence]))
