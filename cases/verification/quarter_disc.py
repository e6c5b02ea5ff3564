"""A quarter of a disc in three structured blocks: a square about the axis, and two beside it."""

import numpy as np

from fe_drivetrain.common import Floats
from fe_drivetrain.elasticity.mesh import Block, brick, joined

_SIDE, _CORNER = 0.5, 0.4
"""Where the square's side and its corner (its y and z) are, as shares of the radius."""


def quarter_disc(radius: float, thickness: float, n: int, layers: int) -> Block:
    """Hexahedra of 27 nodes; the axis is x, and y and z are positive.

    Parameters
    ----------
    radius, thickness : float
        [m].
    n : int
        Elements along each side of each block: 2 n reach from the axis to the rim.
    layers : int
        Through the thickness.

    Returns
    -------
    Block
        Faces ``front`` (x = 0), ``rear``, ``rim``, and the planes ``y`` and ``z`` (where those
        coordinates vanish).
    """
    corner = np.array([_CORNER, _CORNER])
    ends = np.array([[_SIDE, 0.0], corner, [0.0, _SIDE]])

    def square(unit: Floats) -> Floats:
        a, b = unit[:, :1], unit[:, 1:2]
        flat = a * (1.0 - b) * ends[0] + a * b * corner + (1.0 - a) * b * ends[2]
        return np.column_stack([thickness * unit[:, 2], radius * flat])

    def outer(number: int, unit: Floats) -> Floats:
        a, b = unit[:, :1], unit[:, 1:2]
        t = 0.25 * np.pi * (number + unit[:, 1])
        inside = (1.0 - b) * ends[number] + b * ends[number + 1]
        flat = (1.0 - a) * inside + a * np.column_stack([np.cos(t), np.sin(t)])
        return np.column_stack([thickness * unit[:, 2], radius * flat])

    shapes = square, lambda u: outer(0, u), lambda u: outer(1, u)
    blocks = [brick((n, n, layers), 27, shape) for shape in shapes]
    first = np.cumsum([0, *(len(block.points) for block in blocks)])
    parts = {
        "front": [(0, "z0"), (1, "z0"), (2, "z0")],
        "rear": [(0, "z1"), (1, "z1"), (2, "z1")],
        "rim": [(1, "x1"), (2, "x1")],
        "y": [(0, "x0"), (2, "y1")],
        "z": [(0, "y0"), (1, "y0")],
    }
    return joined(
        Block(
            np.vstack([block.points for block in blocks]),
            np.vstack([block.cells + f for block, f in zip(blocks, first, strict=False)]),
            {
                name: np.vstack([blocks[k].faces[face] + first[k] for k, face in faces])
                for name, faces in parts.items()
            },
        )
    )
