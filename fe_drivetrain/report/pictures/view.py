"""How a picture looks at what is drawn.

Pixels are counted from the lower left corner of the picture, as VTK does.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from fe_drivetrain.common.arrays import Floats

SIZE = (1600, 900)
"""Width and height of every picture, pixels."""

STRIP = 225
"""Height of the strip below the drawing, for axes and legend, pixels."""

ALONG_THE_SHAFT = (0.50, 1.0, -0.45)
"""A direction to look in: from upstream, the side of -y and above; x then points to the right."""

_MARGIN = 40  # left and right of the drawing, pixels


@dataclass(frozen=True)
class View:
    """A parallel projection with z up.

    Attributes
    ----------
    forward : Floats
        (3,) unit vector in which the eye looks.
    centre : Floats
        (3,) the point in the middle of the picture [m].
    scale : float
        Pixels per metre.
    reach : float
        All that is drawn is nearer to the centre than this [m].
    """

    forward: Floats
    centre: Floats
    scale: float
    reach: float

    @classmethod
    def fitting(
        cls, points: Floats, forward: Sequence[float], top: float, bottom: float = STRIP
    ) -> View:
        """The view in which all points are within the margins of the picture.

        Parameters
        ----------
        points : Floats
            (n, 3) what is to be seen [m].
        forward : sequence of float
            The direction in which the eye looks, of any length, not along z.
        top, bottom : float
            Margins above and below the points [pixels].
        """
        unit = np.asarray(forward, dtype=float) / np.linalg.norm(forward)
        turned = cls(unit, np.zeros(3), 1.0, 0.0)
        axes = np.array([turned.right, turned.up, unit])
        flat = points @ axes.T
        low, high = flat.min(axis=0), flat.max(axis=0)
        room = np.array([SIZE[0] - 2 * _MARGIN, SIZE[1] - top - bottom])
        scale = float((room / (high - low)[:2]).min())
        # the middle of the points goes to the middle of the room, not of the picture
        middle = (low + high) / 2 + np.array([0.0, (top - bottom) / 2 / scale, 0.0])
        centre = middle @ axes
        reach = float(np.linalg.norm(points - centre, axis=1).max())
        return cls(unit, centre, scale, reach)

    @property
    def right(self) -> Floats:
        """(3,) unit vector to the right of the picture."""
        right = np.cross(self.forward, [0.0, 0.0, 1.0])
        return np.asarray(right / np.linalg.norm(right))

    @property
    def up(self) -> Floats:
        """(3,) unit vector to the top of the picture."""
        return np.cross(self.right, self.forward)

    def project(self, points: npt.ArrayLike) -> Floats:
        """Pixels (..., 2) at which points (..., 3) [m] are seen."""
        d = np.asarray(points) - self.centre
        seen = self.scale * np.stack([d @ self.right, d @ self.up], axis=-1)
        pixels: Floats = np.array(SIZE) / 2 + seen
        return pixels

    def in_front(self, pixels: npt.ArrayLike) -> Floats:
        """Points (..., 3) [m] seen at pixels (..., 2), nearer to the eye than all that is drawn."""
        across, along = np.moveaxis((np.asarray(pixels) - np.array(SIZE) / 2) / self.scale, -1, 0)
        plane = self.centre - 2 * self.reach * self.forward
        points: Floats = plane + across[..., None] * self.right + along[..., None] * self.up
        return points
