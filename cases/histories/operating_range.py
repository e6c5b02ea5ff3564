"""Loads on a main bearing over the operating range: 330 histories with a controller."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.common import Bools, Floats
from fe_drivetrain.report.answer import Claim
from fe_drivetrain.report.suite import Page, Record, Run, grouped
from fe_drivetrain.shafts.beam import MainBearingBeam, torsional_spring_model
from fe_drivetrain.turbine_loads.hub_loads import (
    Condition,
    Rotor,
    TurbineHistory,
    designed_controller,
    operating_grid,
    similar_turbine,
    turbine_histories,
)

#: As the loads on the bearing are named, with the component or plane of it.
LOADS: dict[str, Callable[[Floats], Floats]] = {
    "axial force [kN]": lambda loads: loads[:, 0],
    "radial force [kN]": lambda loads: np.hypot(*loads[:, 1:3].T),
    "moment [kN m]": lambda loads: np.hypot(*loads[:, 4:6].T),
}
BASE = "medium, shear 0.2"


@case(
    "Main-bearing loads from cut-in to cut-out: 11 winds, 5 sets, 6 seeds",
    source="Stirling 2023, sections 5.1 and 5.2.1",
)
def run(run: Run, page: Page) -> None:
    """Make the histories one after the other, and take least, mean and largest loads of each."""
    grid = operating_grid()
    if run.quick:
        grid = [c for c in grid if c.seed == 1 and c.wind_speed in (4.0, 12.0, 24.0)]
    turbine = similar_turbine(Rotor())
    controller = designed_controller(turbine)
    rows: list[Record] = []
    worst = 0.0
    with run.step("histories"):
        made = turbine_histories(
            grid,
            turbine,
            controller,
            duration=30.0 if run.quick else 600.0,
            progress=lambda done: run.report(f"histories ({done} of {len(grid)})"),
        )
        for condition, history in zip(grid, made, strict=True):
            rows.append(extremes(condition, history))
            worst = max(worst, gap(history))
    page.vanishes(
        "azimuth turned less the integral of the rotor's speed, over it, the worst history",
        worst,
        within=1e-3,
        why="trapezia between samples 0.05 s apart",
        source="azimuth and speed of one motion, both in every history",
    )
    means = averaged(rows)
    show(page, means)
    page.data("histories", rows)
    statements(page, means)


def show(page: Page, means: Sequence[Record]) -> None:
    """Loads, rotor speed and pitch by wind speed and set."""
    for name in LOADS:
        page.section(name.partition(" [")[0].capitalize())
        page.sweep(
            f"Mean {name}, mean of seeds",
            means,
            "wind [m/s]",
            f"mean {name}",
            by="set",
            table=(
                "wind [m/s]",
                "set",
                *(f"{what} {name}" for what in ("least", "mean", "largest")),
            ),
        )
        page.sweep(
            f"Largest {name}, mean of seeds",
            means,
            "wind [m/s]",
            f"largest {name}",
            by="set",
            table=False,
        )
    page.section("Speed and pitch")
    page.sweep(
        "Mean rotor speed",
        means,
        "wind [m/s]",
        "rotor speed [rad/s]",
        by="set",
        table=("wind [m/s]", "set", "rotor speed [rad/s]", "pitch [deg]"),
    )


def gap(history: TurbineHistory) -> float:
    """Between azimuth and integrated speed, over the angle turned."""
    step, speed = history.history.step, history.rotor_speed
    turned = step * float((0.5 * (speed[1:] + speed[:-1])).sum())
    return abs(float(history.azimuth[-1] - history.azimuth[0]) / turned - 1.0)


def extremes(condition: Condition, history: TurbineHistory) -> Record:
    """Least, mean and largest loads on the bearing of one history."""
    loads = 1e-3 * torsional_spring_model(history.history.loads[None], MainBearingBeam())[0]
    row: Record = {
        "wind [m/s]": condition.wind_speed,
        "set": f"{condition.turbulence}, shear {condition.shear:g}",
        "seed": condition.seed,
        "rotor speed [rad/s]": float(history.rotor_speed.mean()),
        "pitch [deg]": float(np.degrees(history.pitch.mean())),
    }
    for name, of in LOADS.items():
        values = of(loads)
        for what, function in (("least", np.min), ("mean", np.mean), ("largest", np.max)):
            row[f"{what} {name}"] = float(function(values))
    return row


def averaged(rows: Sequence[Record]) -> list[Record]:
    """Over the seeds of one wind and set."""
    result: list[Record] = []
    for _, of_wind in grouped(rows, "wind [m/s]"):
        for _, own in grouped(of_wind, "set"):
            row = dict(own[0])
            for key, value in own[0].items():
                if key != "seed" and isinstance(value, float):
                    row[key] = float(np.mean([float(r[key]) for r in own]))  # type: ignore[arg-type]
            del row["seed"]
            result.append(row)
    return result


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


AXIAL, RADIAL, MOMENT = LOADS
DOUBLE = 2.0
"""Growth of the mean moment from cut-in to cut-out that the thesis exceeds."""
LOW_SET, HIGH_SET = "low, shear 0.2", "high, shear 0.2"
FLAT, STEEP = "medium, shear 0.1", "medium, shear 0.4"

Statement = tuple[str, str, bool]
"""Sentence of the thesis, what stands here, and whether it agrees."""


def statements(page: Page, means: Sequence[Record]) -> None:
    """What section 5.2.1 says of min, mean and max, and what stands here."""
    one = BySet({str(name): list(own) for name, own in grouped(means, "set")})
    rows = [*of_axial(one), *of_radial(one), *of_moment(one)]
    page.section("Statements of section 5.2.1")
    page.table(
        "The thesis, of a 1.5 MW turbine, and ours, of 2 MW; means over seeds",
        [[words, ours, "yes" if agrees else "no"] for words, ours, agrees in rows],
        ["thesis", "here", "agrees"],
    )
    answer(page, one, [agrees for *_, agrees in rows])
    page.text(
        "Loads on a bearing that carries moments (Eq 3.18 and 3.19, K_R of 392 and 145 MN m/rad) "
        "under hub loads of the 2 MW turbine with its controller; the thesis's 1.5 MW turbine and "
        "its histories are private, so that directions are compared and no numbers."
    )


def answer(page: Page, one: BySet, agreed: Sequence[bool]) -> None:
    """State how many statements hold, and how the mean moment grows."""
    held, every = sum(map(bool, agreed)), len(agreed)
    grown = one.growth(f"mean {MOMENT}")
    peak = float(one.winds[int(np.argmax(one.of(f"mean {AXIAL}")))])
    shear = float((one.of(f"mean {MOMENT}", STEEP) / one.of(f"mean {MOMENT}", FLAT))[-1])
    first, last = one.of(f"mean {RADIAL}")[[0, -1]]
    count = f"All {every}" if held == every else f"{held} of {every}"
    claim: Claim = "holds in part" if held else "does not hold"
    page.answer(
        "Do main-bearing loads vary over the operating range as the thesis says?",
        f"{count} statements of the thesis hold; from cut-in to cut-out the mean moment grows "
        f"{grown:.2f} times, {'as' if grown > DOUBLE else 'not'} the stated {DOUBLE:g} or more.",
        [
            page.value("statements that hold", held, beside=every, by="thesis"),
            page.value("mean moment, cut-out over cut-in", grown, beside=DOUBLE, by="thesis"),
            page.value(
                "largest moment at high turbulence, cut-out over cut-in",
                one.growth(f"largest {MOMENT}", HIGH_SET),
                beside=4.0,
                by="thesis",
            ),
            page.value("mean moment at cut-out, shear 0.4 over 0.1", shear),
            page.value("mean radial force, cut-out over cut-in", float(last / first)),
            page.value("mean axial force peaks at [m/s]", peak, beside=11.0, by="thesis"),
        ],
        hero=f"Mean {MOMENT}, mean of seeds",
        cautions=[
            "The thesis's turbine, of 1.5 MW, is private; ours has 2 MW: directions are compared."
        ],
        claim="holds" if held == every else claim,
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
