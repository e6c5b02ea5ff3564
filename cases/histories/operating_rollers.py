"""Loads of each roller over the operating range, beside Stirling 2023, section 5.2.2."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.bearing import angles
from fe_drivetrain.cases.histories.operating_loads import (
    BASE,
    OfCondition,
    Studied,
    set_name,
)
from fe_drivetrain.cases.histories.operating_words import FLAT, HIGH_SET, LOW_SET, STEEP
from fe_drivetrain.common import Floats
from fe_drivetrain.report import trace
from fe_drivetrain.report.suite import Page, Record
from fe_drivetrain.studies.rolling_bearings import row_names
from fe_drivetrain.turbine_loads.hub_loads import Condition

NEAR = 60.0
"""How far from top or bottom the load zone may be centred to be there [deg]."""
SAME = 0.05
"""What turbulence may change of a mean roller load that it hardly affects, over it."""


@dataclass(frozen=True, eq=False)
class Rollers:
    """Mean and largest loads of places of rollers, by set of winds.

    Attributes
    ----------
    winds : Floats
        (w,) wind speeds [m/s].
    psi : Floats
        (n,) places [rad], from the right upward, looking downwind.
    mean, largest : dict of str to Floats
        (w, rows, n) over the seeds: mean of means, largest of all; by set [kN].
    """

    winds: Floats
    psi: Floats
    mean: dict[str, Floats]
    largest: dict[str, Floats]

    def peak(self, own: str = BASE, what: str = "mean") -> Floats:
        """(w, rows) load of the roller with most of it, of each row [kN]."""
        return np.asarray(getattr(self, what)[own].max(axis=2))

    def centre(self, own: str = BASE) -> Floats:
        """(w, rows) angle about which mean loads lie [deg], 0 on the right, 90 on top."""
        return np.asarray(np.degrees(np.angle(self.mean[own] @ np.exp(1j * self.psi))))

    def share(self, own: str) -> Floats:
        """(w, rows) share of a row's rollers with more than half of the largest mean load."""
        mean = self.mean[own]
        return np.asarray((mean > 0.5 * mean.max(axis=2, keepdims=True)).mean(axis=2))


def by_set(
    grid: Sequence[Condition], found: Sequence[OfCondition], name: str, of: Studied
) -> Rollers:
    """Loads of an arrangement's rollers over the seeds of each wind and set."""
    rows = of.arrangements[name].bearing.rows
    winds = np.unique([c.wind_speed for c in grid])
    mean: dict[str, Floats] = {}
    largest: dict[str, Floats] = {}
    for own in dict.fromkeys(set_name(c) for c in grid):
        by_wind = [
            [one for c, one in zip(grid, found, strict=True) if (c.wind_speed, set_name(c)) == key]
            for key in ((wind, own) for wind in winds)
        ]
        mean[own] = np.stack([np.mean([o.mean[name] for o in part], axis=0) for part in by_wind])
        largest[own] = np.stack(
            [np.max([o.largest[name] for o in part], axis=0) for part in by_wind]
        )
    halves = (len(winds), len(rows), -1)
    return Rollers(
        winds,
        angles(rows[0]),
        {own: values.reshape(halves) for own, values in mean.items()},
        {own: values.reshape(halves) for own, values in largest.items()},
    )


def show(
    page: Page, grid: Sequence[Condition], found: Sequence[OfCondition], of: Studied
) -> Rollers:
    """Loads of each place by wind; of the thesis's bearing also what section 5.2.2 says of them."""
    ways = {name: by_set(grid, found, name, of) for name in of.arrangements}
    rollers = ways[of.first]
    psi = np.degrees(rollers.psi) % 360.0
    order = np.argsort(psi)
    rows = row_names(len(of.arrangements[of.first].bearing.rows))
    page.section("Rollers by wind")
    for own in (FLAT, STEEP):
        for k, row in enumerate(rows):
            page.chart(
                f"Mean load of each roller, {row}, {own}",
                [
                    trace(f"{wind:g} m/s", psi[order], values[k][order])
                    for wind, values in zip(rollers.winds, rollers.mean[own], strict=True)
                ],
                "place, 0 right, 90 on top, looking downwind [deg]",
                "mean load [kN]",
            )
    page.data(
        "rollers",
        [
            {"bearing": name, **record}
            for name, one in ways.items()
            for record in _records(one, rows)
        ],
    )
    if of.springs:
        _statements(page, ways)
    return rollers


def _statements(page: Page, ways: Mapping[str, Rollers]) -> None:
    """Sentences of section 5.2.2 on both arrangements of bearing S."""
    (first, rollers), (second, otherwise) = ways.items()
    page.section("Statements of section 5.2.2")
    page.table(
        "The thesis, of a 1.5 MW turbine, and ours, of 2 MW; rollers held in their places",
        [
            [words, ours, "yes" if agrees else "no", beside, "yes" if too else "no"]
            for (words, ours, agrees), (_, beside, too) in zip(
                said(rollers), said(otherwise), strict=True
            )
        ],
        ["thesis", first, f"agrees, {first}", second, f"agrees, {second}"],
    )
    held = [sum(agrees for *_, agrees in said(one)) for one in (rollers, otherwise)]
    page.text(
        f"With rows in X and 38 deg {held[0]} of {len(said(rollers))} statements hold, in O and "
        f"20 deg {held[1]}. The thesis prints neither arrangement nor contact angle."
    )


def _records(rollers: Rollers, rows: Sequence[str]) -> list[Record]:
    psi = np.degrees(rollers.psi) % 360.0
    return [
        {
            "set": own,
            "wind [m/s]": float(wind),
            "row": row,
            "place [deg]": float(psi[j]),
            "mean load [kN]": float(rollers.mean[own][i, k, j]),
            "largest load [kN]": float(rollers.largest[own][i, k, j]),
        }
        for own in rollers.mean
        for i, wind in enumerate(rollers.winds)
        for k, row in enumerate(rows)
        for j in np.argsort(psi)
    ]


def said(rollers: Rollers) -> list[tuple[str, str, bool]]:
    """Sentences of section 5.2.2, what stands here, and whether it agrees."""
    return [*_of_places(rollers), *_of_shear(rollers), *_of_turbulence(rollers)]


def _of_places(rollers: Rollers) -> list[tuple[str, str, bool]]:
    first, last = rollers.peak(FLAT)[[0, -1]]
    centre = rollers.centre(FLAT)
    off = np.abs((centre - np.array([-90.0, 90.0]) + 180.0) % 360.0 - 180.0)
    idle = rollers.mean[FLAT].min(axis=2)
    peak = rollers.peak(FLAT)
    return [
        (
            "the most loaded roller of each row carries more with more wind",
            f"upwind {first[0]:.0f} to {last[0]:.0f}, downwind {first[1]:.0f} to {last[1]:.0f} kN",
            bool((last > first).all()),
        ),
        (
            "upwind the bottom is loaded",
            f"centre {centre[:, 0].min():.0f} to {centre[:, 0].max():.0f} deg",
            bool((off[:, 0] < NEAR).all()),
        ),
        (
            "downwind the top is loaded",
            f"centre {centre[:, 1].min():.0f} to {centre[:, 1].max():.0f} deg",
            bool((off[:, 1] < NEAR).all()),
        ),
        (
            "the most loaded roller upwind has more than that downwind",
            f"{(peak[:, 0] / peak[:, 1]).min():.2f} to {(peak[:, 0] / peak[:, 1]).max():.2f} times",
            bool((peak[:, 0] > peak[:, 1]).all()),
        ),
        (
            "downwind every roller is loaded on average, upwind some are hardly",
            f"least mean at cut-out upwind {idle[-1, 0]:.1f}, downwind {idle[-1, 1]:.1f} kN",
            bool((idle[:, 1] > idle[:, 0]).all()),
        ),
    ]


def _of_shear(rollers: Rollers) -> list[tuple[str, str, bool]]:
    flat, base, steep = (rollers.peak(own) for own in (FLAT, BASE, STEEP))
    of_wind = [(peak[-1] - peak[0]).max() for peak in (flat, steep)]
    share = [rollers.share(own).mean(axis=0) for own in (FLAT, STEEP)]
    largest = [rollers.peak(own, "largest") for own in (FLAT, STEEP)]
    idle = [rollers.mean[own][:, 1].min(axis=1).mean() for own in (FLAT, STEEP)]
    return [
        (
            "shear raises the mean load of the most loaded rollers",
            f"0.4 {(steep / flat).min():.2f} to {(steep / flat).max():.2f} times 0.1",
            bool(((steep > base) & (base > flat)).all()),
        ),
        (
            "shear narrows the load zones",
            f"{100 * share[0].mean():.0f} to {100 * share[1].mean():.0f} % of rollers have more "
            "than half of the largest mean",
            bool((share[1] < share[0]).all()),
        ),
        (
            "shear takes load off the bottom of the downwind row",
            f"least mean {idle[0]:.1f} to {idle[1]:.1f} kN",
            bool(idle[1] < idle[0]),
        ),
        (
            "wind raises mean loads more at shear 0.4 (250 kN) than at 0.1 (75 kN)",
            f"by {of_wind[1]:.0f} and {of_wind[0]:.0f} kN",
            bool(of_wind[1] > of_wind[0]),
        ),
        (
            "largest loads grow with wind and shear",
            f"at 0.4 {largest[1][0].max():.0f} to {largest[1][-1].max():.0f} kN, at 0.1 "
            f"{largest[0][0].max():.0f} to {largest[0][-1].max():.0f} kN",
            bool(
                all((one[-1] > one[0]).all() for one in largest)
                and (largest[1][-1] > largest[0][-1]).all()
            ),
        ),
    ]


def _of_turbulence(rollers: Rollers) -> list[tuple[str, str, bool]]:
    ratio = rollers.peak(HIGH_SET) / rollers.peak(LOW_SET)
    largest = rollers.peak(HIGH_SET, "largest") / rollers.peak(LOW_SET, "largest")
    return [
        (
            "turbulence hardly changes mean loads of rollers",
            f"high {ratio.min():.2f} to {ratio.max():.2f} times low",
            bool((np.abs(ratio - 1.0) < SAME).all()),
        ),
        (
            "turbulence raises their largest loads",
            f"high {largest.min():.2f} to {largest.max():.2f} times low",
            bool((largest > 1.0).all()),
        ),
    ]
