"""Capture matrices of a published measuring campaign (PROTEST 2010, ECN-E--10-100, section 4.6)."""

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common import Floats


@dataclass(frozen=True)
class Campaign:
    """A capture matrix as printed.

    Attributes
    ----------
    where : str
        In the report.
    counts : tuple of tuple of int
        Windows of ten minutes, a row for each class of turbulence, from 3 % on in steps of 2 %.
    first_wind : float
        Middle of the first class of wind [m/s]; the others follow in steps of 1 m/s.
    windows : int
        As printed, or as the period that is printed has them.
    turbulence : float
        Mean, as printed.
    """

    where: str
    counts: tuple[tuple[int, ...], ...]
    first_wind: float
    windows: int
    turbulence: float

    @property
    def edges(self) -> tuple[Floats, Floats]:
        """Limits of the classes of wind [m/s], and of turbulence."""
        rows, columns = np.shape(self.counts)
        return (
            self.first_wind - 0.5 + np.arange(columns + 1.0),
            0.03 + 0.02 * np.arange(rows + 1.0),
        )

    @property
    def each(self) -> tuple[Floats, Floats]:
        """Mean wind [m/s] and its standard deviation of each window, in the middle of its class."""
        counts = np.array(self.counts)
        wind, turbulence = (0.5 * (e[1:] + e[:-1]) for e in self.edges)
        speed = np.repeat(np.tile(wind, len(turbulence)), counts.ravel())
        share = np.repeat(np.repeat(turbulence, len(wind)), counts.ravel())
        return speed, speed * share


MONITORING = Campaign(
    "Table 4.10",
    (
        (0, 0, 5, 7, 7, 22, 2),
        (0, 16, 10, 16, 12, 14, 3),
        (0, 15, 17, 11, 18, 16, 3),
        (1, 6, 13, 25, 21, 14, 0),
        (1, 7, 14, 22, 27, 13, 1),
        (1, 5, 16, 9, 13, 8, 0),
        (0, 4, 6, 4, 2, 2, 0),
        (0, 1, 5, 0, 1, 0, 0),
        (0, 0, 1, 2, 0, 0, 0),
        (0, 0, 1, 0, 0, 0, 0),
    ),
    4.0,
    440,
    0.0978,
)
"""All windows of the monitoring campaign."""

IDENTIFICATION = Campaign(
    "Fig. 4-14",
    (
        (0, 2, 7, 4, 15, 1),
        (0, 1, 4, 3, 3, 0),
        (0, 2, 0, 2, 2, 0),
        (1, 2, 1, 2, 0, 0),
        (1, 2, 2, 2, 0, 0),
        (2, 1, 0, 0, 0, 0),
        (1, 1, 1, 0, 0, 0),
        (1, 0, 0, 0, 0, 0),
    ),
    5.0,
    66,
    0.0320,
)
"""Files of which inertia, damping and stiffness were identified."""
