"""Parts as a CAD program would hand them over: to be written as STEP files and read back.

Dimensions are plausible and in round numbers; none is a catalogue's.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable
from itertools import product

import gmsh

from fe_drivetrain.common.errors import InputError

from .session import gmsh_session
from .step_files import write_step

BORE = 0.6
"""Diameter of the bores [m]: the raceway of `Bearing`'s defaults."""

CENTRE = 0.42
"""Height of the bores' axis over the foot [m]."""

BOLT_HOLE, WASHER = 0.052, 0.092
"""Diameters of the holes of bolts M48, and of their washers [m]."""

_FOOT = (0.36, 1.25, 0.12)  # along x, y and z [m]
_SHELL, _WIDTH = 0.09, 0.30
_BOLTS_X, _BOLTS_Y = (-0.13, 0.13), (-0.55, -0.45, 0.45, 0.55)  # [m]


def ribbed_pillow_block() -> int:
    """Add a cast pillow block to the open gmsh model: shell, foot, one web, four ribs.

    Returns
    -------
    int
        Tag of the volume. The bore's axis is x, its middle the origin.
    """
    occ = gmsh.model.occ
    radius = BORE / 2 + _SHELL
    body = [
        (3, occ.addCylinder(-_WIDTH / 2, 0, 0, _WIDTH, 0, 0, radius)),
        (3, _foot()),
        (3, occ.addBox(-0.05, -radius, -CENTRE, 0.10, 2 * radius, CENTRE)),
    ]
    for y in (-0.37, 0.37):
        body.append((3, occ.addBox(-0.13, y - 0.02, -CENTRE, 0.26, 0.04, CENTRE - 0.02)))
    for y in (-0.14, 0.14):
        body.append((3, occ.addBox(-0.13, y - 0.02, -CENTRE, 0.26, 0.04, 0.15)))
    return _bored(body, [*_foot_holes()])


def split_housing() -> int:
    """Add a housing with a bolted cap to the open gmsh model, its joint closed.

    Ears stand out at the split; two holes on each side take the bolts of the cap. The joint is
    taken as one solid, as under bolts whose preload keeps it closed.

    Returns
    -------
    int
        Tag of the volume. The bore's axis is x, its middle the origin.
    """
    occ = gmsh.model.occ
    radius = BORE / 2 + _SHELL
    ear = 0.12
    body = [
        (3, occ.addCylinder(-_WIDTH / 2, 0, 0, _WIDTH, 0, 0, radius)),
        (3, _foot()),
        (3, occ.addBox(-_WIDTH / 2, -radius, -CENTRE, _WIDTH, 2 * radius, CENTRE)),
        (3, occ.addBox(-_WIDTH / 2, -radius - ear, -0.07, _WIDTH, 2 * (radius + ear), 0.14)),
    ]
    holes = [*_foot_holes()]
    for x, y in product((-0.08, 0.08), (-1, 1)):
        at = y * (radius + ear / 2)
        holes.append((3, occ.addCylinder(x, at, -0.07, 0, 0, 0.14, 0.018)))
    return _bored(body, holes)


def cap_and_base() -> tuple[int, int]:
    """Add the split housing to the open gmsh model as two solids, its joint open to both.

    Returns
    -------
    tuple of int
        Tags of the base's volume, below the bore's axis, and of the cap's.
    """
    occ = gmsh.model.occ
    whole = split_housing()
    above = occ.addBox(-1.0, -1.0, 0.0, 2.0, 2.0, 1.0)
    cap, _ = occ.intersect([(3, whole)], [(3, above)], removeObject=False, removeTool=False)
    base, _ = occ.cut([(3, whole)], [(3, above)])
    return _one(base), _one(cap)


def bedplate() -> int:
    """Add a welded bedplate to the open gmsh model: a plate on two webs, under the other samples.

    Returns
    -------
    int
        Tag of the volume. Its upper side is at the height of the housings' feet.
    """
    occ = gmsh.model.occ
    plate = occ.addBox(-0.30, -0.75, -CENTRE - 0.15, 0.60, 1.50, 0.15)
    webs = [(3, occ.addBox(-0.30, y - 0.06, -CENTRE - 0.38, 0.60, 0.12, 0.23)) for y in (-0.4, 0.4)]
    found, _ = occ.fuse([(3, plate)], webs)
    return _one(found)


def torque_arm() -> int:
    """Add a gearbox's torque arm to the open gmsh model: a ring, an arm to one side, an eye.

    Returns
    -------
    int
        Tag of the volume. The ring's axis is x, its middle the origin; the arm is along y.
    """
    occ = gmsh.model.occ
    arm = occ.addBox(-0.12, 0.0, -0.16, 0.24, 1.25, 0.32)
    eye = occ.addCylinder(-0.14, 1.25, 0, 0.28, 0, 0, 0.22)
    ring = occ.addCylinder(-0.15, 0, 0, 0.3, 0, 0, 0.46)
    cut = [
        (3, occ.addCylinder(-0.2, 0, 0, 0.4, 0, 0, 0.36)),
        (3, occ.addCylinder(-0.2, 1.25, 0, 0.4, 0, 0, 0.13)),
    ]
    fused, _ = occ.fuse([(3, ring)], [(3, arm), (3, eye)])
    found, _ = occ.cut(fused, cut)
    return _one(found)


PARTS: dict[str, Callable[[], int | tuple[int, ...]]] = {
    "ribbed_pillow_block": ribbed_pillow_block,
    "split_housing": split_housing,
    "cap_and_base": cap_and_base,
    "bedplate": bedplate,
    "torque_arm": torque_arm,
}
"""Parts that `write_sample` makes, by name."""


def write_sample(name: str, path: str | os.PathLike[str]) -> float:
    """Write one of `PARTS` as a STEP file.

    Parameters
    ----------
    name : str
        One of `PARTS`.
    path : str or path-like
        The file.

    Returns
    -------
    float
        Volume of all its solids [m^3].

    Raises
    ------
    InputError
        There is no such part.
    """
    if name not in PARTS:
        raise InputError(f"there is no part {name!r}: use one of {', '.join(PARTS)}")
    with gmsh_session(name):
        made = PARTS[name]()
        tags = made if isinstance(made, tuple) else (made,)
        gmsh.model.occ.synchronize()
        volume = math.fsum(gmsh.model.occ.getMass(3, tag) for tag in tags)
        write_step(path, tags)
    return volume


def _foot() -> int:
    """A plate with rounded corners."""
    occ, (x, y, z) = gmsh.model.occ, _FOOT
    plate = occ.addRectangle(-x / 2, -y / 2, -CENTRE, x, y, roundedRadius=0.05)
    swept = occ.extrude([(2, plate)], 0, 0, z)
    return int(next(tag for dim, tag in swept if dim == 3))


def _foot_holes() -> list[tuple[int, int]]:
    occ = gmsh.model.occ
    return [
        (3, occ.addCylinder(x, y, -CENTRE, 0, 0, _FOOT[2], BOLT_HOLE / 2))
        for x, y in product(_BOLTS_X, _BOLTS_Y)
    ]


def _bored(body: list[tuple[int, int]], holes: list[tuple[int, int]]) -> int:
    occ = gmsh.model.occ
    fused, _ = occ.fuse(body[:1], body[1:])
    bore = occ.addCylinder(-1.0, 0, 0, 2.0, 0, 0, BORE / 2)
    found, _ = occ.cut(fused, [(3, bore), *holes])
    return _one(found)


def _one(found: list[tuple[int, int]]) -> int:
    if len(found) != 1:
        raise RuntimeError(f"a part falls into {len(found)} pieces")
    return int(found[0][1])
