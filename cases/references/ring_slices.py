"""Slices of a ring between planes of symmetry: of a long cylinder, or of a thin disc."""

from collections.abc import Callable, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from fe_drivetrain.cases.references.loaded_blocks import LoadedBlock, face_loads, solve_block
from fe_drivetrain.cases.references.plane_rings import Lame
from fe_drivetrain.cases.references.ring_solids import (
    moves_as_one,
    plane_strain_hold,
    ring_sector,
    sector_symmetry,
)
from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.elasticity.interfaces import Constraint, held_nodes
from fe_drivetrain.elasticity.mesh import Block
from fe_drivetrain.elasticity.operator import pressure

EIGHTH = 0.25 * np.pi  # rad, between planes of symmetry


def divided_sector(
    radii: Sequence[float], counts: Sequence[int], width: float, angle: float
) -> Block:
    """A sector of a ring, one element wide, that is divided at given radii.

    Parameters
    ----------
    radii : Sequence[float]
        Ascending, from bore to outside [m].
    counts : Sequence[int]
        Equal elements between each radius and the next; a quarter of their sum goes round.
    width, angle : float
        Along the axis [m], and from t = 0 on [rad].
    """
    inner, outer, n = radii[0], radii[-1], sum(counts)
    parts = [
        (np.linspace(a, b, n_part + 1)[1:] - inner) / (outer - inner)
        for a, b, n_part in zip(radii[:-1], radii[1:], counts, strict=True)
    ]
    edges: Floats = np.concatenate([[0.0], *parts])
    return ring_sector(inner, outer, width, angle, (n, n // 4, 1), edges=(edges, None, None))


def half_wave(inner: float, outer: float, n: int, level: int) -> Block:
    """A sector of a ring over half a wave of cos(n t), one element wide.

    Its elements are no longer than the wall is thick on the first level, and there is a node in the
    middle.

    Parameters
    ----------
    inner, outer : float
        Radii [m].
    n : int
        Waves round the ring.
    level : int
        Half of the elements through the wall; elements are as wide as they are thick.
    """
    angle, wall = np.pi / n, outer - inner
    pairs = max(2, int(np.ceil(angle * 0.5 * (inner + outer) / (2.0 * wall))))
    divisions = (2 * level, 2 * pairs * level, 1)
    return ring_sector(inner, outer, wall / (2 * level), angle, divisions)


def wave_pressure(amplitude: float, n: int) -> Callable[[Floats, Floats], Floats]:
    """Traction of a pressure that varies as cos(n t) round the x axis, as `face_loads` takes it.

    Parameters
    ----------
    amplitude : float
        [Pa].
    n : int
        Waves round the ring.
    """

    def traction(x: Floats, normal: Floats) -> Floats:
        wave = np.cos(n * np.arctan2(x[:, 2], x[:, 1]))
        return np.asarray(-amplitude * wave[:, None] * normal)

    return traction


def slice_supports(block: Block, angle: float, plane_end: bool) -> list[Constraint]:
    """Planes of symmetry at both ends of a sector and at x = 0; the side beyond plane, or free.

    Parameters
    ----------
    block : Block
        Block from `ring_sector`.
    angle : float
        Angle of the sector [rad].
    plane_end : bool
        Whether the side z1 stays plane and carries no net force, as in a long cylinder; otherwise
        it is free, as in a disc of twice the width.
    """
    size = block.points.size
    middle_plane = held_nodes("middle plane", block.face_nodes("z0"), [0], size)
    held = [*sector_symmetry(block, angle), middle_plane]
    if plane_end:
        held.append(moves_as_one("plane end", block.face_nodes("z1"), 0, size))
    return held


def along_the_middle(
    found: LoadedBlock, angle: float, radii: Mapping[str, float]
) -> dict[str, float]:
    """What a solved sector has on its side x = 0, halfway between its ends.

    Parameters
    ----------
    found : LoadedBlock
        A sector of a ring.
    angle : float
        Angle of the sector [rad].
    radii : Mapping[str, float]
        Name of each place, and its radius [m].

    Returns
    -------
    record : dict[str, float]
        Radial stress, hoop stress and radial displacement by place: "hoop stress, bore [MPa]".
    """
    t = 0.5 * angle
    record = {}
    for name, r in radii.items():
        node = found.node(0.0, r * np.cos(t), r * np.sin(t))
        record[f"radial stress, {name} [MPa]"] = 1e-6 * float(found.polar.radial[node])
        record[f"hoop stress, {name} [MPa]"] = 1e-6 * float(found.polar.hoop[node])
        record[f"radial displacement, {name} [µm]"] = 1e6 * float(found.polar_u[node, 1])
    return record


class PressedBore(NamedTuple):
    """What one mesh gives of a ring's bore.

    Attributes
    ----------
    moved : float
        Mean radial displacement, by the work of the pressure over pressure and area [m].
    hoop, radial : float
        Recovered stresses, halfway round the sector [Pa].
    """

    moved: float
    hoop: float
    radial: float


def eighth_of(ring: Lame, nodes: int, n: int) -> Block:
    """An eighth of a ring, one element wide; see `pressed_ring`."""
    width = (ring.outer - ring.inner) / n
    return ring_sector(ring.inner, ring.outer, width, EIGHTH, (n, n, 1), nodes)


def pressed_ring(
    ring: Lame, material: Material, nodes: int, n: int, free_ends: bool = False
) -> PressedBore:
    """An eighth of a ring under internal pressure, one element wide.

    Parameters
    ----------
    ring : Lame
        Its radii and the pressure inside.
    material : Material
        Material of the ring.
    nodes : int
        Number of nodes of an element: 4, 8, 10, 20 or 27.
    n : int
        Elements through the wall, and round the sector: those at the bore are about square.
    free_ends : bool
        Whether one side is free, and not held as in plane strain.
    """
    width = (ring.outer - ring.inner) / n
    block = eighth_of(ring, nodes, n)
    free = held_nodes("end", block.face_nodes("z0"), [0], block.points.size) if free_ends else None
    F = face_loads(block, x0=pressure(ring.inside))
    held = [*sector_symmetry(block, EIGHTH), free or plane_strain_hold(block)]
    found = solve_block(block, material, F, *held)
    t = 0.5 * EIGHTH
    middle = found.node(0.0, ring.inner * np.cos(t), ring.inner * np.sin(t))
    work = float(F @ found.u.ravel())
    return PressedBore(
        work / (ring.inside * (EIGHTH * ring.inner * width)),
        float(found.polar.hoop[middle]),
        float(found.polar.radial[middle]),
    )
