"""A quarter of a thick plate between two ellipses, as of NAFEMS LE10."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common import Floats
from fe_drivetrain.elasticity.mesh import Block, brick


@dataclass(frozen=True)
class EllipticPlate:
    """A plate with an elliptic rim and an elliptic hole, both about the z axis.

    Attributes
    ----------
    inner, outer : tuple[float, float]
        Half axes of hole and rim along x and y [m].
    thickness : float
        Along z, half of it above and half below z = 0 [m].
    """

    inner: tuple[float, float]
    outer: tuple[float, float]
    thickness: float

    @property
    def quarter_area(self) -> float:
        """Area between the ellipses where x and y are positive [m^2]."""
        (a, b), (c, d) = self.inner, self.outer
        return 0.25 * np.pi * (c * d - a * b)

    def quarter(
        self,
        divisions: tuple[int, int, int],
        nodes: int,
        edges: tuple[ArrayLike | None, ArrayLike | None, ArrayLike | None] = (None, None, None),
    ) -> Block:
        """Mesh a quarter on straight rays between points with the same parameter of the ellipses.

        Parameters
        ----------
        divisions : tuple[int, int, int]
            Elements from hole to rim, from the x to the y axis, and through the thickness.
        nodes : int
            Of an element, as for `brick`.
        edges : tuple
            Boundaries of elements along these directions, as for `brick`.

        Returns
        -------
        block : Block
            Faces x0 and x1 are hole and rim, y0 and y1 lie on y = 0 and x = 0, z0 and z1 are the
            lower and the upper face.
        """

        def place(unit: Floats) -> Floats:
            s, t = unit[:, :1], 0.5 * np.pi * unit[:, 1]
            hole, rim = (
                np.column_stack([a * np.cos(t), b * np.sin(t)]) for a, b in (self.inner, self.outer)
            )
            height = self.thickness * (unit[:, 2] - 0.5)
            return np.column_stack([(1.0 - s) * hole + s * rim, height])

        return brick(divisions, nodes, place, edges)
