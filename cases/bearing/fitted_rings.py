"""A warm, turning inner ring pressed on a hollow shaft, a quarter of both in solids."""

from __future__ import annotations

import numpy as np

from fe_drivetrain.bearing.operating_clearance import Seats, Warm
from fe_drivetrain.bearing.press_fits import Ring, RingMaterial
from fe_drivetrain.cases.references.interference_fits import QUARTER, pressed_pairs
from fe_drivetrain.cases.references.ring_solids import ring_sector, sector_symmetry
from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.elasticity.interfaces import held_nodes
from fe_drivetrain.elasticity.mesh import Block
from fe_drivetrain.elasticity.operator import body_loads, thermal_loads, traction_loads
from fe_drivetrain.elasticity.solve import solve_solid


def lame_of(material: RingMaterial) -> tuple[float, float]:
    """Lame's constants [Pa]."""
    return Material(
        youngs_modulus=material.youngs_modulus,
        poisson_ratio=material.poisson_ratio,
        density=material.density,
    ).lame


def _sector(ring: Ring, width: float, divisions: tuple[int, int, int]) -> Block:
    return ring_sector(ring.inner, ring.outer, width, QUARTER, divisions)


def _loads(block: Block, ring: Ring, warmer: float, speed: float) -> Floats:
    """Nodal forces of a temperature and of rotation."""
    material = ring.material
    free = np.full(len(block.points), material.expansion * warmer)
    F = thermal_loads(block.points, block.cells, lame_of(material), free)
    pull = material.density * speed**2
    return F + body_loads(block.points, block.cells, lambda at: pull * at * [0.0, 1.0, 1.0])


def raceway_growth(
    seats: Seats, interference: float, warm: Warm, width: float, n: int, longer: int
) -> float:
    """Mean growth of the inner raceway's diameter, in solids [m].

    Parameters
    ----------
    seats : Seats
        Diameters and materials; the shaft is hollow.
    interference : float
        Interference of the diameters, cold [m].
    warm : Warm
        Temperatures above that of mounting, and the speed.
    width : float
        Width of the ring [m]; its middle is a plane of symmetry.
    n : int
        Elements through the ring, and along half of it.
    longer : int
        Length of the shaft over the width of the ring: 1 is a plane problem.
    """
    half, ring = 0.5 * width, seats.inner_ring
    shaft = _sector(seats.shaft, half * longer, (2 * n, 6 * n, n * longer))
    inner = _sector(ring, half, (n, 6 * n, n))
    first = len(shaft.points)
    both = Block(
        np.vstack([shaft.points, inner.points]),
        np.vstack([shaft.cells, inner.cells + first]),
        {
            name: np.vstack([shaft.faces[name], inner.faces[name] + first])
            for name in ("y0", "y1", "z0")
        },
    )
    size = both.points.size + 3
    outside = shaft.face_nodes("x1")
    outside = outside[shaft.points[outside, 0] < half * (1.0 + 1e-9)]
    bore = inner.face_nodes("x0")
    order = [np.lexsort(np.round(p, 9).T) for p in (shaft.points[outside], inner.points[bore])]
    outside, bore = outside[order[0]], bore[order[1]] + first
    normals = both.points[outside] * [0.0, 1.0, 1.0]
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    F = np.zeros(size)
    F[: shaft.points.size] = _loads(shaft, seats.shaft, warm.shaft, warm.speed)
    F[shaft.points.size : -3] = _loads(inner, ring, warm.inner_ring, warm.speed)
    lames = lame_of(seats.shaft.material), lame_of(ring.material)
    static = solve_solid(
        both.points,
        list(zip(np.split(both.cells, [len(shaft.cells)]), lames, strict=True)),
        None,
        [
            pressed_pairs("fit", outside, bore, normals, both.points.size, size),
            *sector_symmetry(both, QUARTER, size),
            held_nodes("side", both.face_nodes("z0"), [0], size),
        ],
        F,
        prescribed=(both.points.size + np.arange(3), np.array([0.5 * interference, 0.0, 0.0])),
    )
    u = static.u[shaft.points.size : both.points.size, 0]
    outward = traction_loads(inner.points, inner.faces["x1"], lambda _, normal: normal)
    return 2.0 * float(outward @ u) / (QUARTER * ring.outer * half)
