"""What Stirling 2023, section 5.2.1 says of loads over the operating range, beside ours."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.cases.histories.operating_loads import (
    AXIAL,
    BASE,
    FIXED,
    MOMENT,
    RADIAL,
    ROLLERS,
)
from fe_drivetrain.common import Bools, Floats
from fe_drivetrain.report.answer import Claim
from fe_drivetrain.report.suite import Page, Record, grouped


@dataclass(frozen=True, eq=False)
class BySet:
    """Loads by set of winds.

    Attributes
    ----------
    sets : dict[str, list[Record]]
        Means over seeds at each wind speed, by set.
    """

    sets: dict[str, list[Record]]

    @property
    def winds(self) -> Floats:
        """Wind speeds [m/s]."""
        return self.of("wind [m/s]")

    @property
    def above(self) -> Bools:
        """Whether each wind is rated wind or more."""
        return self.winds >= 12.0

    @property
    def far(self) -> Bools:
        """Whether each wind is well above rated wind."""
        return self.winds >= 14.0

    @property
    def rated(self) -> int:
        """Place of rated wind."""
        return int(np.flatnonzero(self.winds == 12.0)[0])

    def of(self, what: str, own: str = BASE) -> Floats:
        """A quantity of a set at each wind speed."""
        return np.array([float(row[what]) for row in self.sets[own]])  # type: ignore[arg-type]

    def ratio(self, what: str, own: str, other: str, at: Bools | None = None) -> str:
        """A quantity of one set over that of another, in words."""
        share = (self.of(what, own) / self.of(what, other))[self.above if at is None else at]
        return f"{share.min():.2f} to {share.max():.2f} times"

    def near(self, what: str, own: str, other: str, at: Bools | None = None) -> bool:
        """Whether both sets have nearly the same."""
        change = np.abs(self.of(what, own) / self.of(what, other) - 1.0)
        return bool(change[self.above if at is None else at].max() < 0.05)

    def exceeds(self, what: str, own: str, other: str, times: float = 1.0) -> bool:
        """Whether one set has more than another, or so many times that, from rated wind on."""
        return bool((self.of(what, own) > times * self.of(what, other))[self.above].all())

    def growth(self, what: str, own: str = BASE) -> float:
        """A quantity at cut-out over that at cut-in."""
        values = self.of(what, own)
        return float(values[-1] / values[0])


DOUBLE = 2.0
"""Growth of the mean moment from cut-in to cut-out that the thesis exceeds."""
LOW_SET, HIGH_SET = "low, shear 0.2", "high, shear 0.2"
FLAT, STEEP = "medium, shear 0.1", "medium, shear 0.4"

Statement = tuple[str, str, bool]
"""Sentence of the thesis, what stands here, and whether it agrees."""


def statements(page: Page, means: Sequence[Record]) -> dict[str, BySet]:
    """What section 5.2.1 says of min, mean and max, and what stands here with either bearing."""
    found = {
        str(model): BySet({str(name): list(own) for name, own in grouped(rows, "set")})
        for model, rows in grouped(means, "bearing")
    }
    said = {
        model: [*of_axial(one), *of_radial(one), *of_moment(one)] for model, one in found.items()
    }
    page.section("Statements of section 5.2.1")
    page.table(
        "The thesis, of a 1.5 MW turbine, and ours, of 2 MW; means over seeds",
        [
            [words, ours, _yes(agrees), beside, _yes(too)]
            for (words, ours, agrees), (_, beside, too) in zip(
                said[ROLLERS], said[FIXED], strict=True
            )
        ],
        ["thesis", ROLLERS, "agrees", FIXED, "agrees, fixed"],
    )
    answer(page, found, {model: sum(ok for *_, ok in rows) for model, rows in said.items()})
    page.text(
        "Section 5 of the thesis has the rollers of its bearing in the beam, with a stiffness that "
        "varies (section 4.3). Beside it stands the beam of its section 3: Eq 3.18 and 3.19 with "
        "K_R of 392 and 145 MN m/rad. Hub loads are those of the 2 MW turbine with its controller; "
        "the thesis's 1.5 MW turbine and its histories are private, so that directions are "
        "compared and no numbers."
    )
    return found


def _yes(agrees: bool) -> str:
    return "yes" if agrees else "no"


def answer(page: Page, found: dict[str, BySet], held: dict[str, int]) -> None:
    """State how many statements hold with either bearing, and how the mean moment grows."""
    one, fixed = found[ROLLERS], found[FIXED]
    every = len([*of_axial(one), *of_radial(one), *of_moment(one)])
    grown = one.growth(f"mean {MOMENT}")
    claim: Claim = "holds in part" if held[ROLLERS] else "does not hold"
    shears = [
        float((of.of(f"mean {MOMENT}", STEEP) / of.of(f"mean {MOMENT}", FLAT))[-1])
        for of in (one, fixed)
    ]
    page.answer(
        "Do main-bearing loads vary over the operating range as the thesis says?",
        f"With rollers modelled, {held[ROLLERS]} of {every} thesis statements hold, with constant "
        f"stiffness {held[FIXED]}; mean moment at cut-out is {grown:.2f} times that at cut-in.",
        [
            page.value(
                "statements that hold, rollers modelled", held[ROLLERS], beside=every, by="thesis"
            ),
            page.value(
                "statements that hold, constant bearing stiffness",
                held[FIXED],
                beside=every,
                by="thesis",
            ),
            page.value(
                "mean moment, cut-out over cut-in",
                grown,
                at_least=DOUBLE,
                by="thesis: more than double",
            ),
            page.value(
                "largest moment at high turbulence, cut-out over cut-in",
                one.growth(f"largest {MOMENT}", HIGH_SET),
                beside=4.0,
                by="thesis",
            ),
            page.value("mean moment at cut-out, shear 0.4 over 0.1", shears[0]),
            page.value("the same, constant bearing stiffness", shears[1]),
        ],
        hero=f"Mean {MOMENT}, mean of seeds",
        cautions=[
            "The thesis's turbine, of 1.5 MW, is private; ours has 2 MW: only directions of "
            "changes are compared.",
            "Rollers of bearing S are alone in a rigid housing; contact angle, arrangement and "
            "shaft diameter are assumed.",
        ],
        claim="holds" if held[ROLLERS] == every else claim,
    )


def of_axial(one: BySet) -> list[Statement]:
    """Statements on the axial force."""
    axial, low, high = AXIAL, LOW_SET, HIGH_SET
    at_low, at_high = (float(one.of(f"mean {axial}", own)[one.rated]) for own in (low, high))
    peak = float(one.winds[int(np.argmax(one.of(f"mean {axial}")))])
    return [
        ("axial: the mean peaks near rated wind (11 m/s)", f"at {peak:g} m/s", 8.0 < peak < 14.0),
        (
            "axial: its mean is nearly the same for all turbulence, away from rated wind",
            "high " + one.ratio(f"mean {axial}", high, low, one.far) + " low, from 14 m/s",
            one.near(f"mean {axial}", high, low, one.far),
        ),
        (
            "axial: near rated wind it is slightly higher at lower turbulence",
            f"low {at_low / at_high:.2f} times high, at 12 m/s",
            bool(at_low > at_high),
        ),
        (
            "axial: its largest grows with turbulence",
            "high " + one.ratio(f"largest {axial}", high, low) + " low",
            one.exceeds(f"largest {axial}", high, low),
        ),
    ]


def of_radial(one: BySet) -> list[Statement]:
    """Statements on the radial force."""
    radial, low, high = RADIAL, LOW_SET, HIGH_SET
    flat, steep = FLAT, STEEP
    first, last = one.of(f"mean {radial}")[[0, -1]]
    radial_max = one.of(f"largest {radial}")[[0, -1]]
    return [
        ("radial: its mean falls with wind", f"{first:.0f} to {last:.0f} kN", bool(last < first)),
        (
            "radial: its largest grows with wind",
            f"{radial_max[0]:.0f} to {radial_max[1]:.0f} kN",
            bool(radial_max[1] > radial_max[0]),
        ),
        (
            "radial: turbulence hardly changes its mean",
            "high " + one.ratio(f"mean {radial}", high, low) + " low",
            one.near(f"mean {radial}", high, low),
        ),
        (
            "radial: the steepest shear has the least mean",
            "shear 0.4 " + one.ratio(f"mean {radial}", steep, flat) + " shear 0.1",
            one.exceeds(f"mean {radial}", flat, steep),
        ),
        (
            "radial: it has the least maximum, too",
            "shear 0.4 " + one.ratio(f"largest {radial}", steep, flat) + " shear 0.1",
            one.exceeds(f"largest {radial}", flat, steep),
        ),
    ]


def of_moment(one: BySet) -> list[Statement]:
    """Statements on the moment."""
    moment, flat, steep = MOMENT, FLAT, STEEP
    own, low, high = (one.growth(f"mean {moment}", of) for of in (BASE, LOW_SET, HIGH_SET))
    largest = one.growth(f"largest {moment}", HIGH_SET)
    return [
        (
            "moment: its mean more than doubles from cut-in to cut-out",
            f"{own:.2f} times",
            bool(own > DOUBLE),
        ),
        (
            "moment: it does so the more the higher turbulence is",
            f"high {high:.2f}, low {low:.2f} times",
            bool(high > low),
        ),
        (
            "moment: its largest grows fourfold at high turbulence",
            f"{largest:.2f} times",
            bool(largest > 3.5),
        ),
        (
            "moment: shear raises mean and largest strongly",
            "mean, shear 0.4 " + one.ratio(f"mean {moment}", steep, flat) + " shear 0.1",
            one.exceeds(f"mean {moment}", steep, flat, 1.2),
        ),
    ]
