"""Life at a site: damage at single winds, weighted by how often the site has each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.bearing_life.life.roller_damage import KINDS, Damage
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError, require_known
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.turbine_loads.histories.sites import HOURS_A_YEAR, Site, midpoint_edges


@dataclass(frozen=True, eq=False)
class SiteLife:
    """Life at a site, and what takes it.

    Attributes
    ----------
    site : Site
        Whose winds are weighted.
    speeds, shares : Floats
        (n,) mean winds [m/s], and their shares of time, whose sum is below 1.
    at_winds : tuple of Damage
        Damage at each wind, as its histories have it.
    a_year : Damage
        Damage of a year at the site, all winds together.
    """

    site: Site
    speeds: Floats
    shares: Floats
    at_winds: tuple[Damage, ...]
    a_year: Damage

    __repr__ = short_repr

    @property
    def covered(self) -> float:
        """Share of time in which one of the winds blows."""
        return float(self.shares.sum())

    @property
    def years(self) -> dict[str, float]:
        """Life [years] by each of `KINDS`; time outside of all winds does no damage."""
        return {kind: 1.0 / d if d else np.inf for kind, d in self.a_year.totals.items()}

    def of_winds(self, kind: str = "L10r") -> Floats:
        """(n,) share of each wind in the damage of a kind of life, one of `KINDS`."""
        require_known("kind of life", kind, KINDS)
        damage = np.array(
            [
                one.totals[kind] * share * HOURS_A_YEAR * 3600.0 / one.seconds
                for one, share in zip(self.at_winds, self.shares, strict=True)
            ]
        )
        whole = damage.sum()
        return np.asarray(damage / whole if whole else damage)


def site_lives(
    damages: Sequence[tuple[float, Damage]], site: Site, edges: Floats | None = None
) -> SiteLife:
    """Life at a site from histories at single winds.

    Parameters
    ----------
    damages : sequence of tuple
        Mean wind speed [m/s] and damage of each history; those of one wind, as of several seeds,
        are pooled.
    site : Site
        Whose winds are weighted.
    edges : Floats, optional
        (n + 1,) limits of the winds' bins [m/s]; halfway between the winds if not given, which
        needs two of them.

    Returns
    -------
    life : SiteLife
        1 / sum(W / L) (Stirling 2023, eq. 5.23).

    Raises
    ------
    InputError
        There is one wind and no edges, or edges do not fit.
    """
    pooled: dict[float, Damage] = {}
    for wind, one in damages:
        pooled[wind] = pooled[wind] + one if wind in pooled else one
    speeds = np.array(sorted(pooled))
    limits = midpoint_edges(speeds) if edges is None else np.asarray(edges, dtype=float)
    if len(limits) != len(speeds) + 1:
        raise InputError(
            f"{len(speeds)} winds need {len(speeds) + 1} limits of their bins, not {len(limits)}"
        )
    shares = site.shares(limits)
    winds = tuple(pooled[speed] for speed in speeds.tolist())
    whole: Damage | None = None
    for one, share in zip(winds, shares.tolist(), strict=True):
        part = one.times(share * HOURS_A_YEAR * 3600.0 / one.seconds)
        whole = part if whole is None else whole + part
    assert whole is not None
    return SiteLife(site, speeds, shares, winds, whole)
