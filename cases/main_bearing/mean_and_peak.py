"""Mean and peak loads on a main bearing with and without tilting stiffness, over all histories."""

from dataclasses import dataclass
from itertools import product

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.main_bearing.charts import group_chart
from fe_drivetrain.common import Floats
from fe_drivetrain.report import bars, trace
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.shafts.beam import MainBearingBeam, pinned_model, torsional_spring_model
from fe_drivetrain.turbine_loads.hub_loads import Condition, Rotor, hub_load_set, surrogate_grid

BEAM = MainBearingBeam()
WEIGHT = Rotor().weight()[2]
SOURCE = "Stirling 2023, section 3.4 and figure 3.16"


@dataclass(frozen=True)
class Quantity:
    """A number of each history (m,), and over seeds (wind, turbulence, shear) [kN, kN m]."""

    values: Floats
    means: Floats
    deviations: Floats

    def agreeing(self, axis: int, sign: int) -> float:
        """Share of neighbouring groups along an axis that rise (1) or fall (-1) [%]."""
        return 100.0 * float((sign * np.diff(self.means, axis=axis) > 0.0).mean())

    def range(self, shear: int) -> str:
        """Least and largest group mean of a shear."""
        of = self.means[..., shear]
        return f"{of.min():.0f} to {of.max():.0f}"

    def step(self, axis: int) -> float:
        """Mean change from the first to the last group along an axis [%]."""
        last, first = (np.take(self.means, k, axis=axis) for k in (-1, 0))
        return 100.0 * float((last / first - 1.0).mean())


WIND, TURBULENCE, SHEAR = range(3)
LOW, HIGH = 0, 1


@case(
    "Mean and peak loads on main bearings with and without tilting stiffness",
    source="Stirling 2023, section 3.4",
)
def run(run: Run, page: Page) -> None:
    """Two beams over 144 histories: what shear, turbulence and wind speed do to mean and peak."""
    grid = surrogate_grid()
    if run.quick:
        kept = product((10.0, 20.0), ("low", "high"), (0.2, 0.6), (1, 2))
        grid = [Condition(*c) for c in kept]
    with run.step("hub loads"):
        hub = hub_load_set(grid, *((100.0, 4.0) if run.quick else ()))
    shape = [len(dict.fromkeys(values)) for values in _parts(grid)]
    found = {
        f"{name}, {kind}": quantity(kind, values, shape)
        for name, values in resultants(hub.loads).items()
        for kind in ("mean", "peak")
    }
    page.text(
        "DSRB is a spherical bearing, of which the beam has Eq 3.1; DTRB is a double-row tapered "
        "one, Eq 3.18 and 3.19 with the thesis's K_R of 145 and 392 MN m/rad. Hub loads are a "
        f"surrogate, {len(grid)} histories of a generic 2 MW turbine on the thesis's grid of wind, "
        "turbulence and shear; its own are not public. Radial force and moment are resultants of "
        "both planes."
    )
    check(page, found)
    statements(page, found)
    weight(page, found, hub.loads)
    page.section("Groups of seeds")
    for name, one in found.items():
        unit = "kN m" if "moment" in name else "kN"
        group_chart(page, name, grid, one.values, f"{name} [{unit}]")
    page.data("group means [kN, kN m]", {name: one.means for name, one in found.items()})


def _parts(grid: list[Condition]) -> list[list[object]]:
    """Wind speeds, turbulence, shears and seeds of all conditions."""
    return [[getattr(c, k) for c in grid] for k in ("wind_speed", "turbulence", "shear", "seed")]


def resultants(loads: Floats) -> dict[str, Floats]:
    """Radial force of both beams and moment of one: (m, n) [kN, kN m]."""
    spherical, tapered = pinned_model(loads, BEAM), torsional_spring_model(loads, BEAM)
    return {
        "DSRB, radial force": 1e-3 * np.hypot(spherical[..., 1], spherical[..., 2]),
        "DTRB, radial force": 1e-3 * np.hypot(tapered[..., 1], tapered[..., 2]),
        "DTRB, moment": 1e-3 * np.hypot(tapered[..., 4], tapered[..., 5]),
    }


def quantity(kind: str, values: Floats, shape: list[int]) -> Quantity:
    """Mean or peak of each history, and of each group of seeds."""
    one = values.mean(axis=1) if kind == "mean" else values.max(axis=1)
    groups = one.reshape(shape)
    return Quantity(one, groups.mean(axis=-1), groups.std(axis=-1, ddof=1))


def check(page: Page, found: dict[str, Quantity]) -> None:
    """Directions that do not depend on whose turbine it is."""
    for name in ("DSRB, radial force, mean", "DTRB, radial force, mean"):
        page.holds(
            f"{name}: less with more shear, in every group",
            found[name].agreeing(SHEAR, -1) == 100.0,
            why="shear overturns the rotor, which lifts its weight",
            source=SOURCE,
        )
    moment = found["DTRB, moment, mean"].means.mean(axis=(WIND, TURBULENCE))
    page.holds(
        "DTRB, moment, mean over all wind speeds and turbulence: more with more shear",
        bool(moment[HIGH] > moment[LOW]),
        why="what shear adds to the rotor's moment outgrows the weight's, which it opposes",
        source=SOURCE,
    )
    force, peak = found["DSRB, radial force, mean"], found["DSRB, radial force, peak"]
    page.holds(
        "turbulence raises the peak of the radial force by more than its mean",
        peak.step(TURBULENCE) > force.step(TURBULENCE),
        why="turbulence is about the mean wind: it widens the range",
        source=SOURCE,
    )
    page.holds(
        "DTRB, radial force, peak: below that of the DSRB in every group",
        bool((found["DTRB, radial force, peak"].means < peak.means).all()),
        why="what the tilting stiffness takes as a moment is no force at the bearing",
        source=SOURCE,
    )


def statements(page: Page, found: dict[str, Quantity]) -> None:
    """Each sentence of the thesis, and what the surrogate says."""
    less = taken_off_the_peak(found)
    rows = [*of_means(found), *of_peaks(found, less)]
    page.section("Statements of the thesis")
    page.table(
        "Statements of the thesis on its own turbine, and ours: change from least to largest wind "
        "speed, turbulence or shear, mean over the other two; share of neighbouring groups of "
        "seeds in that order",
        rows,
    )
    page.data("statements", rows)
    agree = [r["in that order [%]"] for r in rows if isinstance(r["in that order [%]"], int)]
    answer(page, found, [int(a) for a in agree], less)
    shares = {
        str(r["thesis"]): float(a) for r in rows if isinstance(a := r["in that order [%]"], int)
    }
    page.add(bars(HERO, {"in that order": shares}, "share of neighbouring groups [%]"))
    still = 1e-3 * abs(WEIGHT) * (BEAM.overhang + BEAM.span) / BEAM.span
    page.text(
        f"What differs: without wind a DSRB carries {still:.0f} kN of the surrogate's rotor; the "
        "thesis's forces are some 100 kN less at low shear, and its rotor is not public. At 10 "
        "m/s, below rated wind, shear of our turbine turns the weight's moment about as far as it "
        "was on the other side, so that its mean does not change, while it grows at all higher "
        "wind speeds. Pitch is held in the surrogate: with a controller less would change with "
        "wind speed."
    )


HERO = "Statements of the thesis on order: how many neighbouring groups are in it"


def answer(page: Page, found: dict[str, Quantity], agree: list[int], less: Floats) -> None:
    """State how many statements of the thesis hold, and what tilting stiffness does."""
    always, mostly = sum(a == 100 for a in agree), sum(a > 50 for a in agree)
    holds = always == len(agree)
    page.answer(
        "Is the thesis right about what wind, turbulence and shear do to main-bearing loads?",
        f"All {always} statements of the thesis on which loads are larger hold."
        if holds
        else f"Of the thesis's {len(agree)} statements on which loads are larger, {always} hold "
        f"in all groups of histories, {mostly - always} in most, and {len(agree) - mostly} do not.",
        [
            page.value("statements that hold in all groups", always, beside=len(agree), by="all"),
            page.value("statements that hold in most groups", mostly, beside=len(agree), by="all"),
            page.value(
                "reduction of the peak force by tilting stiffness, low shear [%]", less[LOW]
            ),
            page.value(
                "reduction of the peak force by tilting stiffness, high shear [%]", less[HIGH]
            ),
            page.value(
                "change of the mean force from low to high shear, spherical bearing [%]",
                found["DSRB, radial force, mean"].step(SHEAR),
            ),
            page.value(
                "change of the mean moment from low to high shear [%]",
                found["DTRB, moment, mean"].step(SHEAR),
            ),
        ],
        hero=HERO,
        cautions=[
            "The loads are those of a surrogate turbine with constant pitch in each history; the "
            "thesis's hub loads are not public.",
            "DSRB is a spherical bearing, DTRB a double-row tapered one.",
        ],
        claim="holds" if holds else "holds in part",
    )


def taken_off_the_peak(found: dict[str, Quantity]) -> Floats:
    """(shear,) what tilting stiffness takes off the peak radial force [%]."""
    ps, pt = (found[f"{name}, radial force, peak"] for name in ("DSRB", "DTRB"))
    return np.asarray(100.0 * (1.0 - pt.means / ps.means).mean(axis=(WIND, TURBULENCE)))


def of_means(found: dict[str, Quantity]) -> list[Record]:
    """Statements on means."""
    ds, dt, dm = (
        found[f"{name}, mean"]
        for name in ("DSRB, radial force", "DTRB, radial force", "DTRB, moment")
    )
    return [
        row("DSRB mean force, low shear 400 to 500 kN", ds.range(LOW) + " kN"),
        row("DSRB mean force, high shear 200 to 300 kN", ds.range(HIGH) + " kN"),
        row(
            "DSRB mean force: slightly higher with turbulence",
            f"{ds.step(TURBULENCE):+.1f} %",
            ds.agreeing(TURBULENCE, 1),
        ),
        row(
            "DSRB mean force: small deviations among seeds, growing with wind speed",
            f"{ds.deviations[0].mean():.1f} to {ds.deviations[-1].mean():.1f} kN",
            100.0 * float((np.diff(ds.deviations, axis=WIND) > 0.0).mean()),
        ),
        row(
            "DTRB mean force about that of the DSRB",
            f"{(dt.means / ds.means).min():.2f} to {(dt.means / ds.means).max():.2f} of it",
        ),
        row(
            "DTRB mean force varies less with wind speed and turbulence",
            f"{dt.step(WIND):+.0f} and {dt.step(TURBULENCE):+.1f} % (DSRB {ds.step(WIND):+.0f} and "
            f"{ds.step(TURBULENCE):+.1f} %)",
        ),
        row(
            "DTRB mean force: low shear above high",
            f"{dt.step(SHEAR):+.0f} %",
            dt.agreeing(SHEAR, -1),
        ),
        row("mean moment: high shear above low", f"{dm.step(SHEAR):+.0f} %", dm.agreeing(SHEAR, 1)),
        row("mean moment grows with wind speed", f"{dm.step(WIND):+.0f} %", dm.agreeing(WIND, 1)),
        row(
            "mean moment: slightly higher with turbulence",
            f"{dm.step(TURBULENCE):+.0f} %",
            dm.agreeing(TURBULENCE, 1),
        ),
    ]


def of_peaks(found: dict[str, Quantity], less: Floats) -> list[Record]:
    """Statements on peaks; `less` is what tilting stiffness takes off, by shear [%]."""
    ps, pt, pm = (
        found[f"{name}, peak"]
        for name in ("DSRB, radial force", "DTRB, radial force", "DTRB, moment")
    )
    return [
        row("DSRB peak grows with wind speed", f"{ps.step(WIND):+.0f} %", ps.agreeing(WIND, 1)),
        row(
            "DSRB peak changes with turbulence",
            f"{ps.step(TURBULENCE):+.0f} %",
            ps.agreeing(TURBULENCE, 1),
        ),
        row(
            "DSRB peak most sensitive to shear", f"{ps.step(SHEAR):+.0f} %", ps.agreeing(SHEAR, -1)
        ),
        row(
            "DTRB peak below DSRB peak, most at low shear",
            f"by {less[LOW]:.0f} % at low, {less[HIGH]:.0f} % at high shear",
        ),
        *(
            row(
                f"DTRB peak {word} with wind speed at {level} shear",
                f"{100 * (pt.means[-1, :, k] / pt.means[0, :, k] - 1).mean():+.0f} %",
                100.0 * float((sign * np.diff(pt.means[..., k], axis=0) > 0.0).mean()),
            )
            for level, word, sign, k in (("low", "grows", 1, LOW), ("high", "falls", -1, HIGH))
        ),
        *(
            row(f"peak moment grows with {name}", f"{pm.step(axis):+.0f} %", pm.agreeing(axis, 1))
            for name, axis in (("wind speed", WIND), ("turbulence", TURBULENCE), ("shear", SHEAR))
        ),
    ]


def row(thesis: str, ours: str, share: float | None = None) -> Record:
    """One statement."""
    return {
        "thesis": thesis,
        "ours": ours,
        "in that order [%]": "" if share is None else round(share),
    }


def weight(page: Page, found: dict[str, Quantity], loads: Floats) -> None:
    """The explanation that it offers: overturning lifts the rotor's weight."""
    overturning = 1e-3 * loads[..., 4].mean(axis=1)
    page.section("Overturning lifts the weight")
    traces = []
    for name in ("DSRB, radial force, mean", "DTRB, radial force, mean", "DTRB, moment, mean"):
        traces.append(trace(name, overturning, found[name].values, points=True))
    force = found["DSRB, radial force, mean"].values
    page.chart(
        "Mean loads of each history against the rotor's mean overturning moment",
        traces,
        "mean My of the rotor at the hub [kN m]",
        "mean resultant [kN, kN m]",
    )
    slope = float(np.polyfit(overturning, force, 1)[0])
    page.text(
        "The thesis thinks that the moment lifts the rotor's weight. It does: over all histories "
        f"the mean force of the DSRB falls by {-slope:.3f} kN for each kN m of mean overturning "
        f"moment; 1 / L2 of Eq 3.1 is {1.0 / BEAM.span:.3f} (the resultant of both planes falls a "
        f"little less). Correlation: {np.corrcoef(overturning, force)[0, 1]:.3f}."
    )
