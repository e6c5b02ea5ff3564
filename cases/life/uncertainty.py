"""How certain the life of a main bearing is: inputs, loads' seeds, model, and which one decides."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy import stats

from fe_drivetrain.bearing import Bearing, lamina_loads
from fe_drivetrain.bearing_life.coupled import LinearBody, in_housings, scene_body
from fe_drivetrain.bearing_life.life import GRADES, LifeRules, Lubricant, Steps, damage_of_steps
from fe_drivetrain.bearing_life.rings import housing_races
from fe_drivetrain.cases import case
from fe_drivetrain.cases.life import models
from fe_drivetrain.cases.life.operating import state_assumptions, state_meaning
from fe_drivetrain.cases.references.housed_bearing import ASSUMED_HOUSING, housed_scene
from fe_drivetrain.cases.references.studied_lives import (
    SPEEDS,
    Setup,
    Winds,
    at_site,
    bearing_s,
    by_wind,
    roller_rows,
    rotor_speed,
)
from fe_drivetrain.cases.references.thesis_beam import HOUSING_RADIAL, HOUSING_TILT, HOUSING_YAW
from fe_drivetrain.common import Floats
from fe_drivetrain.report import Chart, bars, trace
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.shafts.uncertainty import Samples, Shares, variance_shares

MEAN_WIND = 8.0
SEEDS = 6
CLEANLINESS = ("normal", "slight to typical", "severe")
UM = 1e-6

#: Name, distribution, and why: of what a designer does not know.
INPUTS: dict[str, tuple[Any, str]] = {
    "contact angle [deg]": (stats.uniform(18.0, 4.0), "not printed; a series has 18 to 22"),
    "distance of the rows [m]": (stats.uniform(0.12, 0.02), "not printed; 15 % of its mean"),
    "clearance [um]": (
        stats.uniform(-40.0, 80.0),
        "along the contact normal, negative a preload: fits, mounting, inner ring warmer by 10 K",
    ),
    "profile, factor": (stats.lognorm(0.3, scale=1.0), "of the profile of ISO/TS 16281"),
    "K_R of the housing, factor": (
        stats.lognorm(0.3, scale=1.0),
        "of 145 and 392 MN m/rad: how it stands on the bedplate",
    ),
    "temperature [degC]": (stats.uniform(40.0, 20.0), "healthy main bearings run at 20 to 60"),
    "contamination, class": (stats.randint(0, 3), "grease: normal, slight to typical, severe"),
    "seed of the wind": (stats.randint(0, SEEDS), "one ten-minute history for each wind speed"),
}
NOMINAL = np.array([20.0, 0.12977, 0.0, 1.0, 1.0, 50.0, 1.0, np.nan])
NOISE = 2.0  # standard errors of shares that samples leave open, 95 % of normal ones
CHART = "Share of the variance of the logarithm of {} life, with the noise of its samples"
ALONE, TOGETHER = "alone", "with all others"
WITH_OTHERS, TOTAL_ERROR = "with all others [%]", "standard error of that [%]"
NOMINAL_LIFE, LOW_LIFE, HIGH_LIFE = "nominal [years]", "2.5 % [years]", "97.5 % [years]"
SEED = list(INPUTS).index("seed of the wind")


@dataclass(frozen=True)
class Lives:
    """Years at the site of rows of `INPUTS`, over hub loads (seeds, winds, steps, 6)."""

    hub: Floats
    beam: LinearBody
    elements: int

    def __call__(self, row: Floats) -> tuple[float, float]:
        """Basic and modified life [years]; all seeds together where the seed is no number."""
        setup = self.setup(row)
        seed = row[SEED]
        chosen = self.hub if np.isnan(seed) else self.hub[[int(seed)]]
        loads = np.concatenate(list(chosen), axis=1)
        u = setup.deflections(loads)
        rules = LifeRules(lubricant(row))
        found = [of_wind(setup, rules, u[k], float(n)) for k, n in enumerate(rotor_speed())]
        basic, modified = (at_site(np.array(one), MEAN_WIND) for one in zip(*found, strict=True))
        return basic, modified

    def setup(self, row: Floats) -> Setup:
        """Bearing and beam of a row."""
        angle, distance, clearance, profile, K_R = row[:5]
        return Setup(self.bearing(angle, distance, clearance, profile), self.body(K_R))

    def bearing(self, angle: float, distance: float, clearance: float, profile: float) -> Bearing:
        """Bearing S back to back, of these values."""
        nominal = bearing_s("bearing_s_o20", True, self.elements)
        rows = [
            replace(
                row,
                place=float(np.sign(row.place) * distance / 2.0),
                angle=float(np.sign(row.angle) * np.radians(angle)),
                clearance=float(clearance * UM),
                crown=float(row.crown * profile),
            )
            for row in roller_rows(nominal)
        ]
        return Bearing(nominal.name, tuple(rows))

    def body(self, factor: float) -> LinearBody:
        """The beam in its housing."""
        K = np.diag([*[HOUSING_RADIAL] * 3, 1e10, factor * HOUSING_TILT, factor * HOUSING_YAW])
        return in_housings(self.beam, {self.beam.bearings[0]: K})


def lubricant(row: Floats) -> Lubricant:
    """Grease of VG 460 at a temperature, of a cleanliness."""
    grade = GRADES["VG 460"]
    return Lubricant(*grade, temperature=float(row[5]), cleanliness=CLEANLINESS[int(row[6])])


def of_wind(setup: Setup, rules: LifeRules, u: Floats, speed: float) -> tuple[float, float]:
    """Basic and modified life [years] of steps at a wind speed, at a speed [1/min]."""
    laminae = tuple(lamina_loads(row, u) for row in roller_rows(setup.bearing))
    n = len(u)
    steps = Steps(np.zeros((n, 5)), laminae, np.full(n, speed), np.ones(n), np.ones(n, dtype=bool))
    rated = replace(setup.rated, fatigue=2.0 * setup.fatigue)
    lives = damage_of_steps(steps, rated, rules).lives("years")
    return lives["L10r"], lives["L10mr"]


@case(
    "How certain the life of a main bearing is, and which input decides it",
    source="bearing S back to back; Sobol 2001, Saltelli et al. 2010; Stirling 2023, section 5.3",
)
def run(run: Run, page: Page) -> None:
    """Sobol's shares of the variance of life's logarithm, one input at a time, and models."""
    state_assumptions(page)
    page.seed = 0
    for name, (_, why) in INPUTS.items():
        page.assume(name, "uncertain", "", why)
    winds = (
        Winds(seeds=SEEDS, duration=20.0, rate=0.1)
        if run.quick
        else Winds(seeds=SEEDS, duration=600.0, rate=0.1)
    )
    with run.step("hub loads"):
        hub = winds.hub_loads().reshape(len(SPEEDS), SEEDS, -1, 6).swapaxes(0, 1)
    lives = Lives(hub, scene_body(housed_scene(), level=1), 12 if run.quick else 36)
    asked: list[tuple[Floats, Floats]] = []

    def logarithms(rows: Floats) -> Floats:
        """(2, n) of basic and modified life."""
        found = np.log([lives(row) for row in rows]).T
        asked.append((rows, found))
        return found

    with run.step("samples"):
        inputs = {name: one for name, (one, _) in INPUTS.items()}
        shares = variance_shares(logarithms, inputs, 16 if run.quick else 64)
    base = asked[:2]
    rows, values = np.vstack([r for r, _ in base]), np.hstack([v for _, v in base])
    nominal = np.log(lives(NOMINAL))
    samples = [
        Samples(tuple(INPUTS), rows, one, float(at))
        for one, at in zip(values, nominal, strict=True)
    ]
    with run.step("one input at a time"):
        alone = {name: one_at_a_time(lives, k, run.quick) for k, name in enumerate(INPUTS)}
    check(page, samples, shares, alone)
    if not run.quick:
        against_plane(page, samples[1], alone)
    with run.step("models"):
        of_models = by_model(lives, run.quick)
    show(page, samples, shares, alone, of_models)
    page.assume_all(ASSUMED_HOUSING)
    state_meaning(page)


def one_at_a_time(lives: Lives, k: int, quick: bool) -> Floats:
    """Basic and modified life [years] (points, 2) over one input, the others nominal, one seed."""
    points = 2 if quick else 6
    of = list(INPUTS.values())[k][0].ppf((np.arange(points) + 0.5) / points)
    rows = np.tile(NOMINAL, (points, 1))
    rows[:, SEED] = 0
    rows[:, k] = of
    return np.array([[*lives(row)] for row in rows])


def by_model(lives: Lives, quick: bool) -> dict[str, float]:
    """Basic life of nominal inputs by each model, over that of the housing in series."""
    hub = np.concatenate(list(lives.hub), axis=1)
    flat = hub.reshape(-1, 6)
    setup = replace(lives.setup(NOMINAL), body=lives.beam)
    scene = housed_scene((3.6, 8))
    races = housing_races(scene, scene.bearing_units[0].bearing.name, setup.bearing)
    ground = models.GROUNDS[models.SOFT]
    world = models.World(setup, races, None, ground)
    known: dict[str, Callable[[models.World, Floats], models.Laminae]] = {
        name: one
        for name, one in models.MODELS.items()
        if name not in (models.SOLIDS, models.SOFTEST, *([models.THREE] if quick else []))
    }
    found = {
        name: at_site(
            by_wind(models.lives(setup, len(flat), one(world, flat)).reshape(hub.shape[:2])),
            MEAN_WIND,
        )
        for name, one in known.items()
    }
    return {name: life / found[models.FIVE_DEGREES] for name, life in found.items()}


def check(
    page: Page, samples: list[Samples], shares: list[Shares], alone: dict[str, Floats]
) -> None:
    """What shares must add up to, and what each input must do."""
    for words, of, sample in zip(("basic", "modified"), shares, samples, strict=True):
        error = float(np.linalg.norm(of.first_error))
        page.at_most(
            f"{words} life: sum of the first-order shares, less three standard errors",
            float(of.first.sum()) - 3.0 * error,
            1.0,
            why="parts of a variance",
            source="Sobol 2001",
            measure="identity",
        )
        page.at_most(
            f"{words} life: first-order less total share, the worst less three standard errors",
            float((of.first - of.total - 3.0 * np.hypot(of.first_error, of.total_error)).max()),
            0.0,
            why="what an input does alone is part of all that it does",
            source="Sobol 2001",
            measure="identity",
        )
        page.holds(
            f"{words} life: the nominal life is inside of the band",
            sample.band().low < sample.nominal < sample.band().high,
            why="the nominal inputs are in the middle of theirs",
            source="definition of the band",
        )
    basic, modified = (
        np.array([one[:, k] for one in alone.values()], dtype=object) for k in (0, 1)
    )
    names = list(INPUTS)
    for name in ("temperature [degC]", "contamination, class"):
        page.holds(
            f"{name}: changes modified life alone, and shortens it",
            bool(np.ptp(np.asarray(basic[names.index(name)], dtype=float)) == 0.0)
            and bool((np.diff(np.asarray(modified[names.index(name)], dtype=float)) <= 0.0).all()),
            why="basic life knows no lubricant",
            source="ISO/TS 16281",
        )


def against_plane(page: Page, sample: Samples, alone: dict[str, Floats]) -> None:
    """Shares by a plane through all samples, and by one input at a time."""
    planes = sample.contributions()
    single = np.array([np.log(one[:, 1]).var() for one in alone.values()]) / sample.values.var()
    worst = int(np.argmax(np.abs(planes - single)))
    noise = 3.0 * np.sqrt(2.0 / len(sample.values)) * float(single[worst])
    page.vanishes(
        "modified life: share of the variance by a plane through all samples less that of one "
        f"input at a time, the worst ({list(INPUTS)[worst]})",
        float(planes[worst] - single[worst]),
        within=1.0 - sample.linear_share + noise,
        why="what the plane leaves unexplained, and three standard errors of the variance of "
        f"{len(sample.values)} samples",
        source="inputs one by one, the others nominal",
    )


def show(
    page: Page,
    samples: list[Samples],
    shares: list[Shares],
    alone: dict[str, Floats],
    of_models: dict[str, float],
) -> None:
    """Bands, shares, and models beside them."""
    rows = {
        words: band_row(words, sample)
        for words, sample in zip(("basic", "modified"), samples, strict=True)
    }
    page.section("Bands")
    page.table("Life with all inputs uncertain, each seed of the wind as likely", [*rows.values()])
    page.data("bands", [*rows.values()])
    page.section("Which input decides")
    for words, of in zip(("modified", "basic"), reversed(shares), strict=True):
        page.add(shares_chart(CHART.format(words), of))
    table = shares_rows(samples, shares, alone)
    page.table("Shares of the variance, three ways", table)
    page.data("shares of the variance", table)
    models_section(page, rows["basic"], of_models)
    answer(page, rows, table, of_models)


def shares_chart(caption: str, of: Shares) -> Chart:
    """Shares of each input, alone and with all others, with the noise of few samples."""
    values = {
        ALONE: (of.first, of.first_error),
        TOGETHER: (of.total, of.total_error),
    }
    groups = {
        name: dict(zip(of.keys, (100.0 * share).tolist(), strict=True))
        for name, (share, _) in values.items()
    }
    ends = {
        name: {
            key: (100.0 * float(s - NOISE * e), 100.0 * float(s + NOISE * e))
            for key, s, e in zip(of.keys, share, error, strict=True)
        }
        for name, (share, error) in values.items()
    }
    return bars(caption, groups, "share [%]", ends=ends)


def band_row(words: str, sample: Samples) -> Record:
    """Nominal life, its band with all inputs uncertain, and how certain that is."""
    band = sample.band()
    low, high = np.exp(band.low), np.exp(band.high)
    return {
        "life": words,
        NOMINAL_LIFE: np.exp(sample.nominal),
        LOW_LIFE: low,
        HIGH_LIFE: high,
        "high over low": high / low,
        "standard error of low [%]": 100.0 * band.low_error,
        "of high [%]": 100.0 * band.high_error,
        "share that a plane explains [%]": 100.0 * sample.linear_share,
    }


def shares_rows(
    samples: list[Samples], shares: list[Shares], alone: dict[str, Floats]
) -> list[Record]:
    """Share of the variance of each input, three ways."""
    table: list[Record] = []
    for k, name in enumerate(INPUTS):
        spread = np.log(alone[name])
        table.append(
            {
                "input": name,
                "basic: alone [%]": 100.0 * float(shares[0].first[k]),
                "with others [%]": 100.0 * float(shares[0].total[k]),
                "modified: alone [%]": 100.0 * float(shares[1].first[k]),
                "its standard error [%]": 100.0 * float(shares[1].first_error[k]),
                WITH_OTHERS: 100.0 * float(shares[1].total[k]),
                TOTAL_ERROR: 100.0 * float(shares[1].total_error[k]),
                "by a plane [%]": 100.0 * float(samples[1].contributions()[k]),
                "modified life, largest over least, others nominal": float(
                    np.exp(np.ptp(spread[:, 1]))
                ),
                "one at a time [%]": 100.0 * float(spread[:, 1].var() / samples[1].values.var()),
            }
        )
    return table


def models_section(page: Page, basic: Record, of_models: dict[str, float]) -> None:
    """The band of basic life from the inputs, and lives of nominal inputs by each model."""
    page.section("Inputs beside models")
    lows = {name: basic[NOMINAL_LIFE] * ratio for name, ratio in of_models.items()}
    ends, y = [basic[LOW_LIFE], basic[HIGH_LIFE]], ["all inputs", *lows]
    page.chart(
        "Basic life: its band from the inputs, and of nominal inputs by each model",
        [
            trace("band of the inputs", ends, [0.0, 0.0], mode="lines+markers"),
            *(
                trace(name, [life], [-1.0 - k], True, marker={"size": 11})
                for k, (name, life) in enumerate(lows.items())
            ),
        ],
        "life [years]",
        "",
        "x",
    )
    layout = page.sections[-1].items[-1]
    layout.figure["layout"]["yaxis"] = {  # type: ignore[union-attr]
        "tickvals": [-float(k) for k in range(len(y))],
        "ticktext": y,
        "automargin": True,
    }
    page.data("basic life by model over that of the housing in series", of_models)


def deciding(table: list[Record]) -> tuple[list[Record], str]:
    """Inputs by their share, largest first, and which of them decide, in words.

    Samples leave noise in each share: what is within it of the largest may decide as well.
    """
    order = sorted(table, key=lambda row: -row[WITH_OTHERS])
    first = order[0]
    close = [
        row
        for row in order
        if first[WITH_OTHERS] - row[WITH_OTHERS]
        <= NOISE * np.hypot(first[TOTAL_ERROR], row[TOTAL_ERROR])
    ]
    one, two = (short_name(row) for row in order[:2])
    if len(close) == 1:
        return order, f"{one} decides most, then {two}"
    if len(close) == 2:
        return order, f"{one} and {two} decide most"
    return order, f"samples are too few to tell which of {len(close)} inputs decides"


def short_name(row: Record) -> str:
    """Name of an input without its unit and what it is varied by."""
    return str(row["input"]).partition(" [")[0].partition(",")[0]


def answer(
    page: Page, rows: dict[str, Record], table: list[Record], of_models: dict[str, float]
) -> None:
    """Which input decides, and that models do more than inputs."""
    basic, modified = rows["basic"], rows["modified"]
    order, words = deciding(table)
    seed = table[SEED]
    span = max(of_models.values()) / min(of_models.values())
    low, high = (value_text(float(modified[key])) for key in (LOW_LIFE, HIGH_LIFE))
    factor = float(modified["high over low"])
    page.answer(
        "How certain is the modified life of a main bearing, and which input decides it?",
        f"Modified life is uncertain by a factor of {factor:.2g}, from {low} to {high}\u00a0years; "
        f"{words}.",
        [
            page.value("nominal modified life [years]", float(modified[NOMINAL_LIFE])),
            page.value(
                "modified life that 2.5 % of samples do not reach [years]",
                float(modified[LOW_LIFE]),
            ),
            page.value(
                "modified life that 97.5 % of samples do not reach [years]",
                float(modified[HIGH_LIFE]),
            ),
            *(
                page.value(
                    f"share of the variance, {short_name(row)} [%]",
                    float(row[WITH_OTHERS]),
                    NOISE * float(row[TOTAL_ERROR]),
                )
                for row in order[:2]
            ),
            page.value(
                "basic life of a pinned beam over that of the best model here",
                of_models[models.PINNED],
            ),
        ],
        hero=CHART.format("modified"),
        cautions=[
            "The error of the model is not included: a pinned beam or a rigid housing changes life "
            "in addition.",
            "The range holds 95 % of samples, whose distributions are assumed; turbine and bearing "
            "are substitutes, so that years serve only to rank.",
        ],
    )
    page.say(
        f"Basic life, which knows no lubricant, has a factor of {basic['high over low']:.1f}. One "
        f"seed of the wind makes {seed['modified: alone [%]']:.0f} % of the variance of modified "
        "life, a sixth of that if six are taken.",
        f"Of nominal inputs a pinned beam has {of_models[models.PINNED]:.1f} times the basic life "
        "of five degrees with the housing in series, a rigid housing "
        f"{of_models[models.RIGID]:.2f} times, a factor of {span:.0f} between them where all "
        f"inputs make {basic['high over low']:.1f}; flexible rings have "
        f"{of_models[models.FLEXIBLE]:.2f} times.",
    )
