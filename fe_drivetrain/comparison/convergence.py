"""How far a series of meshes is from its limit: observed order, extrapolation, and a band.

Richardson extrapolation and the grid convergence index (GCI) of Roache (1994, J. Fluids Eng. 116,
405-413) in the form of Celik et al. (2008, J. Fluids Eng. 130, 078001), which ASME V&V 20-2009
takes over. Both rest on f(h) = f0 + c h^p. Real series, of unstructured meshes above all, follow
that only roughly, and some not at all; what is observed decides how wide the band is:

- monotone: the last three meshes give the order and the limit; the band of the finest value is
  safety times what is missing to the limit. Where there is reason to doubt that order, other limits
  are put beside this one, and the band reaches to the farthest: the limit of the three meshes
  before, where there are four or more (in place of a least-squares fit, Eca and Hoekstra 2014, J.
  Comput. Phys. 262, 104-130, which wants more meshes than solids in three dimensions allow), and
  that of the last two meshes at a least order, where one is given, such as that of a singularity.
- oscillatory: differences change sign, or all but vanish at once; no order, and the band is
  safety times the range of the last three values. Nothing is averaged.
- divergent: differences do not shrink as the sizes do. No band, unless a least order is given.
- converged: differences are round-off, and so is the band.

Where a least order is given, the band reaches to the limit at that order, by the last two meshes.
These may agree by chance, as meshes that are not nested do: where no order is seen, or one above
2.1, which Eca and Hoekstra do not believe, it also reaches to that limit by the first and the last
of the last three. Where none is seen, it is at least what they give to series that scatter, their
equations 19 to 21, see `scattered_band`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError

SOLVER_ROUND_OFF = 1e-8
"""Relative; solutions are refined or iterated to about 1e-9 in energy."""

Behaviour = Literal["monotone", "oscillatory", "divergent", "converged"]

#: Orders that are looked for: below, a series hardly changes; above, the last difference
#: is small by chance.
ORDERS = 0.2, 8.0

#: Roache's safety factors: of an order that three meshes show, and of one that is not confirmed.
SAFETY, DOUBTFUL = 1.25, 3.0

_AGREES = 0.1
_TOO_HIGH = 2.1
_DIGITS = 4


@dataclass(frozen=True)
class GridConvergence:
    """What a series of meshes shows.

    Attributes
    ----------
    sizes, values : tuple[float, ...]
        As given, coarse first.
    behaviour : Behaviour
        "monotone", "oscillatory", "divergent" or "converged", by the last three values.
    order : float
        Observed order of convergence; NaN where there is none.
    extrapolated : float
        The value at element size zero; the finest value where no order is seen and none is given.
    extrapolated_uncertainty : float
        Half width of the band that the limit is expected in, in the unit of the values.
    uncertainty : float
        Half width of the band of the finest value, in its unit.
    gci_fine, gci_coarse : float
        Grid convergence index of the two finest meshes and of the two before, relative to the
        finer value of each (GCI21, GCI32); NaN where there is no order. ``uncertainty`` is at
        least ``gci_fine`` times the finest value, and more where the order is in doubt.
    asymptotic_ratio : float
        gci_coarse / (r^p gci_fine), 1 in the asymptotic range. With the order observed on the same
        three meshes it equals the ratio of the two finest values, whatever the series, and so
        tests nothing; it does with an expected order.
    """

    sizes: tuple[float, ...]
    values: tuple[float, ...]
    behaviour: Behaviour
    order: float
    extrapolated: float
    extrapolated_uncertainty: float
    uncertainty: float
    gci_fine: float
    gci_coarse: float
    asymptotic_ratio: float

    @property
    def finest(self) -> float:
        """Value of the finest mesh."""
        return self.values[-1]

    @property
    def relative_uncertainty(self) -> float:
        """The band's half width over the finest value; infinite of a value that is zero."""
        if self.uncertainty == 0.0:
            return 0.0
        return self.uncertainty / abs(self.finest) if self.finest else float("inf")

    def sentence(self, unit: str = "") -> str:
        """The finding in words."""
        unit = f" {unit}" if unit else ""
        found = f"{_shown(self.finest)}{unit} on the finest of {len(self.sizes)} meshes"
        band = f"band ± {self.uncertainty:.2g}{unit} ({100 * self.relative_uncertainty:.2g} %)"
        if self.behaviour == "converged":
            return f"converged to round-off: {found}, {band}"
        if self.behaviour == "monotone":
            return (
                f"monotone convergence of order {self.order:.2f}: {found}, "
                f"{_shown(self.extrapolated)}{unit} extrapolated to element size zero, {band}"
            )
        what = {
            "oscillatory": "no monotone convergence, values go up and down",
            "divergent": "no convergence in sight, differences do not shrink with the sizes",
        }[self.behaviour]
        if not np.isfinite(self.uncertainty):
            band = "no band can be given: add finer meshes"
        return f"{what}: {found}, {band}"

    def __str__(self) -> str:
        return self.sentence()


def grid_convergence(
    sizes: ArrayLike,
    values: ArrayLike,
    *,
    safety: float = SAFETY,
    expected_order: float | None = None,
    min_order: float | None = None,
    round_off: float = 1e-12,
) -> GridConvergence:
    """Judge a series of three meshes or more.

    Parameters
    ----------
    sizes : ArrayLike
        (n,) element sizes, coarse first, in any unit; of cell counts N in d dimensions N^(-1/d).
    values : ArrayLike
        (n,) what was computed with them.
    safety : float
        Factor on the distance to the limit: 1.25 with three meshes (Roache 1994).
    expected_order : float or None
        Order of the theory. A higher observed one is not believed; where they are more than a tenth
        apart, the safety factor is 3, as Roache has it where the observed order is unreasonable
        (2011, J. Fluids Eng. 133, 115501); the tenth is recalled of Oberkampf and Roy 2010, 8.7.
    min_order : float or None
        Order to count on at the worst, as where stress is singular. The band then holds the limits
        at that order, too, and where no order is observed, it is the one that is used. Oberkampf
        and Roy take 0.5 for the least that is believed.
    round_off : float
        Differences below this share of the values are none.

    Raises
    ------
    InputError
        There are fewer than three values, a number is not finite, or the sizes do not descend.
    """
    h, v = _checked(sizes, values)
    fine = float(v[-1])
    spread = float(np.ptp(v[-3:]))
    size = float(np.abs(v[-3:]).max())
    nan = float("nan")
    series = tuple(h.tolist()), tuple(v.tolist())

    if spread <= round_off * size:
        band = spread + round_off * size
        relative = band / abs(fine) if fine else 0.0
        return GridConvergence(*series, "converged", nan, fine, band, band, relative, nan, nan)

    order = observed_order(h[-3:], v[-3:])
    slowest = None
    if min_order is not None:
        coarse = (-2,) if order <= _TOO_HIGH else (-2, -3)
        pairs = (richardson(h[[k, -1]], v[[k, -1]], min_order) for k in coarse)
        slowest = max(pairs, key=lambda limit: abs(limit - fine))
    if np.isnan(order):
        return _without_order(h, v, safety, slowest)
    return _monotone(h, v, order, safety, expected_order, slowest)


def _without_order(h: Floats, v: Floats, safety: float, slowest: float | None) -> GridConvergence:
    """A series that shows no order: its band is how far its values lie apart."""
    fine, spread, nan = float(v[-1]), float(np.ptp(v[-3:])), float("nan")
    behaviour: Behaviour = "divergent" if _stands_still(h[-3:], v[-3:]) else "oscillatory"
    limit = fine if slowest is None else slowest
    known = max(spread, abs(limit - fine))
    scatter = 0.0 if slowest is None else scattered_band(h[-3:], v[-3:])
    band = max(safety * spread, abs(limit - fine), scatter)
    if behaviour == "divergent" and slowest is None:
        known = band = float("inf")
    relative = band / abs(fine) if fine else nan
    series = tuple(h.tolist()), tuple(v.tolist())
    return GridConvergence(*series, behaviour, nan, limit, known, band, relative, nan, nan)


def _monotone(
    h: Floats,
    v: Floats,
    order: float,
    safety: float,
    expected_order: float | None,
    slowest: float | None,
) -> GridConvergence:
    """A series with an order: Roache's grid convergence index about its limit."""
    fine, nan, used = float(v[-1]), float("nan"), order
    if expected_order is not None:
        used = min(order, expected_order)
        if abs(order / expected_order - 1.0) > _AGREES:
            safety = max(safety, DOUBTFUL)
    limit = richardson(h[-2:], v[-2:], used)
    missing = abs(limit - fine)
    limits = [] if slowest is None else [slowest]
    if len(h) > 3:
        before = observed_order(h[-4:-1], v[-4:-1])
        if not np.isnan(before):
            limits.append(richardson(h[-3:-1], v[-3:-1], before))
    doubt = max([(safety - 1.0) * missing, *(abs(limit - other) for other in limits)])
    coarse_missing = abs(richardson(h[-3:-1], v[-3:-1], used) - v[-2])
    gci_fine = safety * missing / abs(fine) if fine else nan
    gci_coarse = float(safety * coarse_missing / abs(v[-2])) if v[-2] else nan
    ratio = gci_coarse / ((h[-2] / h[-1]) ** used * gci_fine) if gci_fine else nan
    return GridConvergence(
        tuple(h.tolist()),
        tuple(v.tolist()),
        "monotone",
        order,
        limit,
        doubt,
        missing + doubt,
        gci_fine,
        gci_coarse,
        float(ratio),
    )


def richardson(sizes: ArrayLike, values: ArrayLike, order: float) -> float:
    """The limit of two values whose error is proportional to size^order (Richardson 1911).

    Parameters
    ----------
    sizes, values : ArrayLike
        (2,), coarse first.
    """
    h, v = np.asarray(sizes, dtype=float), np.asarray(values, dtype=float)
    return float(v[1] - (v[0] - v[1]) / ((h[0] / h[1]) ** order - 1.0))


def scattered_band(sizes: ArrayLike, values: ArrayLike) -> float:
    """The band of the last value of a series that shows no order (Eca and Hoekstra 2014).

    Lines in h and in h^2 are fitted by least squares, with equal weights and with weights 1/h, and
    the one of least standard deviation sigma is taken. With its error estimate e and its residual d
    at the finest mesh, and the data range D = (max - min) / (n - 1) (equation 19), the band is
    3 e + sigma + d where sigma < D (20), and 3 sigma / D (e + sigma + d) where it is not (21).
    Read in two programs that follow the paper. They fit a sum of both terms, too, which three
    values leave nothing over for; the authors ask for four meshes.

    Parameters
    ----------
    sizes, values : ArrayLike
        (n,), coarse first, three or more.

    Returns
    -------
    float
        Half width, in the unit of the values.
    """
    h, v = np.asarray(sizes, dtype=float), np.asarray(values, dtype=float)
    n = len(h)
    fits = []
    for order in (1.0, 2.0):
        x = (h / h[-1]) ** order
        A = np.column_stack([np.ones(n), x])
        for weights in (np.ones(n), n / h / (1.0 / h).sum()):
            root = np.sqrt(weights)
            limit, slope = np.linalg.lstsq(root[:, None] * A, root * v, rcond=None)[0]
            residuals = v - limit - slope * x
            sigma = float(np.sqrt((weights * residuals**2).sum() / (n - 2)))
            fits.append((sigma, abs(float(slope)), abs(float(residuals[-1]))))
    sigma, error, residual = min(fits)
    spread = float(np.ptp(v)) / (n - 1)
    if sigma < spread:
        return DOUBTFUL * error + sigma + residual
    return DOUBTFUL * (sigma / spread) * (error + sigma + residual)


def observed_order(sizes: ArrayLike, values: ArrayLike) -> float:
    """The p of f0 + c h^p through three values, of whatever ratios; NaN outside `ORDERS`.

    Parameters
    ----------
    sizes, values : ArrayLike
        (3,), coarse first.
    """
    h, v = np.asarray(sizes, dtype=float), np.asarray(values, dtype=float)
    first, second = v[0] - v[1], v[1] - v[2]

    def excess(p: float) -> float:
        steps = -np.diff((h / h[0]) ** p)
        return float(first * steps[1] - second * steps[0])

    steepness = np.sign([excess(order) for order in ORDERS])
    if np.sign(first) * np.sign(second) <= 0.0 or steepness.prod() >= 0.0:
        return float("nan")
    from scipy.optimize import brentq  # a third of a second, which few wait for

    return float(brentq(excess, *ORDERS))


def clipped_order(sizes: ArrayLike, values: ArrayLike) -> float:
    """`observed_order` of values that go one way; beyond `ORDERS`, the nearer end of these.

    Parameters
    ----------
    sizes, values : ArrayLike
        (3,), coarse first.
    """
    found = observed_order(sizes, values)
    if not np.isnan(found):
        return found
    h, v = np.asarray(sizes, dtype=float), np.asarray(values, dtype=float)
    return ORDERS[0] if _stands_still(h, v) else ORDERS[1]


def _stands_still(h: Floats, v: Floats) -> bool:
    """Whether three values go one way, and the differences do not shrink as the sizes do."""
    first, second = v[0] - v[1], v[1] - v[2]
    if np.sign(first) * np.sign(second) < 0.0 or second == 0.0:
        return False
    steps = -np.diff(h ** ORDERS[0])
    return bool(abs(first) * steps[1] <= abs(second) * steps[0])


def _checked(sizes: ArrayLike, values: ArrayLike) -> tuple[Floats, Floats]:
    h, v = np.asarray(sizes, dtype=float), np.asarray(values, dtype=float)
    if h.ndim != 1 or h.shape != v.shape or len(h) < 3:
        raise InputError(
            f"grid convergence of {v.size} values over {h.size} sizes needs at least three sizes "
            "that descend, with a value for each: add meshes"
        )
    if not (np.isfinite(v).all() and np.isfinite(h).all()):
        raise InputError(
            f"grid convergence of the values {v.tolist()} over the sizes {h.tolist()}: all must be "
            "finite: leave out the meshes that failed"
        )
    if np.any(np.diff(h) >= 0) or h[-1] <= 0:
        raise InputError(
            f"grid convergence over the sizes {h.tolist()} needs at least three sizes that "
            "descend and are above zero: sort them, coarse first"
        )
    return h, v


def _shown(value: float) -> str:
    return f"{value:.{_DIGITS}g}" if abs(value) < 10**_DIGITS else f"{value:,.0f}"


def band_of(sizes: ArrayLike, values: ArrayLike, order: float | None = None) -> float:
    """Half width of the uncertainty of the finest value of a series, in its unit.

    Parameters
    ----------
    sizes : array_like
        Element sizes, coarse to fine, in any unit.
    values : array_like
        What each mesh gave.
    order : float, optional
        Expected order of convergence; of two meshes it must be given.

    Returns
    -------
    band : float
        By the grid convergence index; where differences do not shrink, as of first order at least.
        Of two meshes three times what is missing at the expected order (Roache 1994).
    """
    if order is not None and np.size(values) == 2:
        (coarse, fine), (before, last) = np.asarray(sizes), np.asarray(values)
        return DOUBTFUL * float(abs(last - before) / ((coarse / fine) ** order - 1))
    found = grid_convergence(sizes, values, expected_order=order, round_off=SOLVER_ROUND_OFF)
    if np.isfinite(found.uncertainty):
        return found.uncertainty
    # differences that do not shrink: at least of first order, as whatever is not singular is
    return grid_convergence(
        sizes, values, expected_order=order, min_order=1.0, round_off=SOLVER_ROUND_OFF
    ).uncertainty
