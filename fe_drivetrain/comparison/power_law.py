"""Power laws of measured values, and where the next value is expected."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError


@dataclass(frozen=True)
class PowerLaw:
    """y = a x^b, a straight line through logarithms by least squares.

    Attributes
    ----------
    x, y : Floats
        (n,) what it was fitted to, positive.
    exponent : float
        b.
    """

    x: Floats
    y: Floats
    exponent: float

    def __call__(self, x: float) -> float:
        """The y of the line at x."""
        from_middle = np.log(x) - np.log(self.x).mean()
        return float(np.exp(np.log(self.y).mean() + self.exponent * from_middle))

    @property
    def misfit(self) -> float:
        """Largest relative difference of the points from the line."""
        return float(max(abs(self(x) / y - 1.0) for x, y in zip(self.x, self.y, strict=True)))

    def exponent_band(self, level: float = 0.95) -> tuple[float, float]:
        """Between what the exponent is found, from points that scatter normally in logarithms.

        Student's confidence interval of the slope of a straight line; endless from two points.

        Parameters
        ----------
        level : float
            Chance that it is in between.

        Returns
        -------
        low, high
            Band of the exponent.
        """
        from scipy.stats import t  # slow to load

        n = len(self.x)
        if n < 3:
            return -float("inf"), float("inf")
        half = float(t.ppf(0.5 + 0.5 * level, n - 2)) * float(
            np.sqrt(self._variance / self._spread)
        )
        return self.exponent - half, self.exponent + half

    @property
    def _variance(self) -> float:
        """Variance of the points about the line, in logarithms."""
        left = [np.log(y / self(at)) for at, y in zip(self.x, self.y, strict=True)]
        return float(np.sum(np.square(left))) / (len(self.x) - 2)

    @property
    def _spread(self) -> float:
        """Sum of squares of the distances of log x from their mean."""
        log_x = np.log(self.x)
        return float(((log_x - log_x.mean()) ** 2).sum())

    def band(self, x: float, level: float = 0.95) -> tuple[float, float]:
        """Between what a further measurement at x would be found.

        Student's prediction interval of a straight line with points that scatter normally, in
        logarithms; endless from two points.

        Parameters
        ----------
        x : float
            Where; far from the points it becomes wide.
        level : float
            Chance that it is in between.

        Returns
        -------
        low, high
            Band of y.
        """
        from scipy.stats import t  # slow to load

        log_x = np.log(self.x)
        n, middle = len(log_x), float(log_x.mean())
        if n < 3:
            return 0.0, float("inf")
        leverage = 1.0 + 1.0 / n + (np.log(x) - middle) ** 2 / self._spread
        half = float(t.ppf(0.5 + 0.5 * level, n - 2)) * float(np.sqrt(self._variance * leverage))
        return self(x) * float(np.exp(-half)), self(x) * float(np.exp(half))


def power_law(x: ArrayLike, y: ArrayLike) -> PowerLaw:
    """Fit y = a x^b.

    Parameters
    ----------
    x, y : (n,) array
        Positive.

    Raises
    ------
    InputError
        There are not two different x, or a value is not positive.
    """
    at, values = np.asarray(x, dtype=np.float64), np.asarray(y, dtype=np.float64)
    if len(np.unique(at)) < 2 or not (at > 0.0).all() or not (values > 0.0).all():
        raise InputError("a power law needs positive values at two different places or more")
    return PowerLaw(at, values, float(np.polyfit(np.log(at), np.log(values), 1)[0]))
