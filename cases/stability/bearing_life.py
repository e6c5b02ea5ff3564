"""Where the rating life of a bearing ends: lubricant, fatigue limit, load, standstill."""

from dataclasses import replace

import numpy as np

from fe_drivetrain.bearing import equilibrium, lamina_loads, pressures, sjovall
from fe_drivetrain.bearing_life.life import (
    GRADES,
    Damage,
    LifeRules,
    Limits,
    Lubricant,
    Steps,
    damage_of_steps,
    life_factor,
)
from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.studied_lives import (
    ENOUGH,
    LOAD,
    Setup,
    own_setup,
    roller_rows,
    thesis_setup,
)
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import (
    decades,
    round_off,
    safe_range,
)
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run

KAPPA = "viscosity ratio kappa"
OVER = "e_C C_u / P"
SIZE = "load over the usual"
AMPLITUDE = "amplitude of an oscillation [deg]"
MOVING = "life of the moving ring over that of rotation"
HARDLY_MOVING = "life of the moving ring at an amplitude of 0.5 deg, over that of rotation"
PROMISED = "formula of the life factor carried on to kappa 100, over the factor"
LOST = "largest exponent of load in modified life"
FLOWING = "largest pressure at the first load above C/2"
SWUNG = "least amplitude with life within 5 % of rotation's"
FACTORS = (
    "Life factor of rollers over the viscosity ratio, and its formula carried on; shaded: where "
    "ISO 281 gives it"
)


@case(
    "Rating life of a bearing: lubricant, load and standstill out of range",
    source="ISO 281 and ISO/TS 16281 as public code prints them; Stirling 2023, chapter 5",
)
def run(run: Run, page: Page) -> None:
    """Sweep each quantity that bounds the method, and see what the program does beyond."""
    with run.step("lubricant"):
        lubricant(page)
        fatigue_limit(page)
    with run.step("loads"):
        loads(page, run.quick)
    with run.step("standstill"):
        standstill(page)
    answer(page)
    page.say(
        "The program goes on as the standard asks. At the fatigue limit modified life no longer "
        "knows load or lubricant."
    )


def answer(page: Page) -> None:
    """State where a rating life ends, and whether the program counts the time beyond."""
    counts = all(one.passed for one in page.checks if "counted" in one.quantity)
    still, swung = page.judged(HARDLY_MOVING), page.judged(SWUNG)
    page.answer(
        "For which lubricant, load and motion is the rating life of a bearing valid?",
        "Rating lives are valid for viscosity ratios from 0.1 to 4 and loads below C/2; the "
        f"program {'reports' if counts else 'does not report'} the time outside these limits.",
        [
            page.judged(
                PROMISED, "life factor by its formula at viscosity ratio 100, over its limit"
            ),
            page.judged(LOST, "largest exponent of the load in the modified life"),
            page.judged(
                FLOWING, "largest contact pressure at the first load above C/2 (steel yields)"
            ),
            page.judged(
                SWUNG, "least swing to either side for a life within 5 % of that in rotation"
            ),
            page.judged(
                HARDLY_MOVING, "life of a moving ring that swings by ±0.5°, over that in rotation"
            ),
        ],
        hero=FACTORS,
        cautions=[
            f"A bearing that swings by less than {formatted(swung.value, 3)}\u00b0 to either side "
            f"loses up to {100.0 * (1.0 - still.value):.0f} % of the life of its moving ring, at "
            "the same number of turns; fretting and false brinelling are not considered.",
            "At the fatigue limit the program gives 50 times the basic life (C/P)^p, whatever the "
            "load: read it as 'more than'.",
        ],
    )


def lubricant(page: Page) -> None:
    """a_ISO over kappa, and the formula carried on beyond its ends."""
    rows = factors(decades(-2, 2, 8))
    check_factor(page)
    promised = (carried_on(0.5, 1e2) or np.inf) / float(life_factor(0.5, 1e2))
    page.found(PROMISED, promised)
    page.limit(
        "life factor a_ISO",
        KAPPA,
        low=0.1,
        high=4.0,
        criterion="ISO 281 gives a formula",
        beyond="below, surfaces touch, and wear ends a bearing before fatigue: the formula carried "
        f"on gives {carried_on(0.5, 1e-2) or 0.0:.2g} at kappa 0.01; above, it would promise "
        f"{promised:.1f} times the life at kappa 100",
        program="takes 0.1 below, the factor of 4 above, and counts the time beyond both",
        remedy="another grease or temperature; the counted time is with the result",
    )
    page.section("Viscosity")
    page.sweep(
        FACTORS,
        rows,
        KAPPA,
        {key: key for key in list(rows[0])[1:]},
        log="xy",
        safe=(0.1, 4.0),
        axis="a_ISO",
        table=False,
    )


def factors(kappas: Floats) -> list[Record]:
    """Life factor a_ISO, and its formula carried on, at two ratios e_C C_u / P."""
    return [
        {
            KAPPA: float(kappa),
            **{f"a_ISO at {r}": float(life_factor(r, kappa)) for r in (0.1, 0.5)},
            **{f"formula carried on, {r}": carried_on(r, float(kappa)) for r in (0.1, 0.5)},
        }
        for kappa in kappas
    ]


def check_factor(page: Page) -> None:
    """Check the life factor within the formula's range and beyond, and the time counted beyond."""
    inside = np.array([k for k in decades(-2, 2, 8) if 0.1 <= k <= 4.0])
    formula = np.array([carried_on(0.5, float(k)) for k in inside], dtype=float)
    formula = np.maximum(formula, 0.1)  # its smallest value, which at kappa 0.1 rounding passes
    page.vanishes(
        "life factor less the formula from kappa 0.1 to 4, relative, the worst",
        float(np.abs(life_factor(0.5, inside) / formula - 1.0).max()),
        **round_off(200, "the same four powers, the last of them -9, once more"),
        source="ISO 281 as Stirling 2023, eqs 5.11 to 5.13, prints it",
    )
    thin, thick = (float(life_factor(0.5, k)) for k in (1e-2, 1e2))
    page.equals(
        "life factor at kappa 0.01, over the least",
        thin / 0.1,
        1.0,
        **round_off(1, "one division of the least value"),
        source="below 0.1 no life is rated but the least",
    )
    page.equals(
        "life factor at kappa 100, over that at 4",
        thick / float(life_factor(0.5, 4.0)),
        1.0,
        **round_off(1, "both are the formula at kappa 4"),
        source="more viscosity than 4 brings nothing",
    )
    setup = own_setup()
    counted = {
        temperature: limits_of(setup, LOAD, Lubricant(*GRADES[grade], temperature=temperature))
        for grade, temperature in (("LGWM 2", 120.0), ("VG 460", 20.0), ("VG 460", 50.0))
    }
    page.holds(
        "time with kappa below 0.1, and above 4, is counted, and none in between",
        counted[120.0].thin == 10.0
        and counted[20.0].thick == 10.0
        and counted[50.0].thin + counted[50.0].thick == 0.0,
        why="the user would not see that the method was left",
        source="ten seconds at 18 1/min",
    )


def carried_on(ratio: float, kappa: float) -> float | None:
    """a_ISO of the branches at both ends, without ends; None where there is no number."""
    a, b = (1.3993, 0.054381) if kappa < 0.4 else (1.2348, 0.19087 if kappa < 1.0 else 0.071739)
    bracket = 1.0 - (1.5859 - a / kappa**b) * ratio**0.4
    return float(0.1 * bracket**-9.185) if bracket > 0.0 else None


def fatigue_limit(page: Page) -> None:
    """How much life changes for a change of load, near the fatigue limit."""
    rows: list[Record] = []
    step = 1e-4
    ratios = decades(-2, 0.5, 12)
    for kappa in (0.4, 1.0, 4.0):
        for ratio in ratios:
            low, high = (
                float(life_factor(ratio / (1.0 + s), kappa)) / (1.0 + s) ** 4 for s in (-step, step)
            )
            exponent = -np.log(high / low) / np.log((1.0 + step) / (1.0 - step))
            rows.append({OVER: float(ratio), KAPPA: kappa, "exponent of life": float(exponent)})
    clean = [row for row in rows if row[KAPPA] == 4.0]
    worst = max(row["exponent of life"] for row in rows)
    page.found(LOST, worst)
    bracket = 1.0 - 500.0 ** (-1.0 / 9.185)
    capped = float((bracket / (1.5859 - 1.2348 / 4.0**0.071739)) ** 2.5)
    page.equals(
        "life factor where its formula is 50, kappa 4",
        float(life_factor(capped, 4.0)),
        50.0,
        **round_off(1e3, "the power -9 of a bracket that its own inverse has made"),
        source="ISO 281 as Stirling 2023, eq. 5.13, prints it, solved for the load",
    )
    page.at_most(
        "exponent of life to load at a hundredth of the fatigue limit, kappa 4, over that of "
        "basic life",
        clean[0]["exponent of life"] / 4.0,
        1.25,
        why="a_ISO changes with the power 0.4 of a small ratio",
        source="basic reference life goes with the fourth power",
        measure="identity",
    )
    page.limit(
        "modified life, error of the load",
        OVER,
        high=capped,
        criterion="a_ISO is below 50, at kappa 4",
        beyond="life is 50 times the basic one, whatever lubricant and load: it has lost what it "
        f"knew; up to there it goes with up to the power {worst:.1f} of the load",
        program="ends a_ISO at 50, as ISO 281 does",
        remedy="read such a life as 'more than': basic life and its load beside it",
    )
    page.section("Near the fatigue limit")
    page.sweep(
        "Exponent of load in modified life, by viscosity ratio: 4 plus that of the life factor",
        rows,
        OVER,
        "exponent of life",
        by=KAPPA,
        log="x",
        safe=(None, capped),
        table=False,
    )


def limits_of(setup: Setup, load: Floats, grease: Lubricant | None) -> Limits:
    """Limits that ten seconds of 18 1/min under one load pass."""
    return damage(setup, load, grease, 18.0).limits


def damage(setup: Setup, load: Floats, grease: Lubricant | None, speed: float | Floats) -> Damage:
    """Damage of ten seconds under one load."""
    speeds = np.broadcast_to(np.asarray(speed, dtype=float), (10,))
    found = equilibrium(setup.bearing, np.tile(load, (10, 1)))
    steps = Steps(
        np.tile(load, (10, 1)),
        tuple(lamina_loads(row, found.displacements) for row in roller_rows(setup.bearing)),
        speeds,
        np.ones(10),
        found.converged,
    )
    rated = replace(setup.rated, fatigue=2.0 * setup.fatigue)
    return damage_of_steps(steps, rated, LifeRules(grease))


def loads(page: Page, quick: bool) -> None:
    """From nothing to beyond C/2."""
    straight, profiled = thesis_setup("bearing_s_o20"), own_setup()
    rows = lives_over_load(straight, profiled, decades(-8, 1, 1 if quick else 4))
    size = np.array([row[SIZE] for row in rows])
    life = np.array([row["life, straight [Mrev]"] for row in rows])
    page.vanishes(
        "straight rollers: life times load to the fourth, over that of the usual load, less 1, the "
        "worst",
        float(np.abs(life * size**4 / np.interp(0.0, np.log10(size), life * size**4) - 1.0).max()),
        within=1e-6,
        why="residuals of 1e-12 of the load, over nine decades",
        source="loads times s are roller loads times s without clearance and profile",
    )
    nothing = damage(profiled, np.zeros(5), Lubricant(*GRADES["VG 460"]), 18.0)
    page.holds(
        "no load: no damage, and a life without end",
        nothing.totals["L10mr"] == 0.0 and nothing.lives()["L10r"] == np.inf,
        why="a number would come from 0 / 0",
        source="Miner's rule",
    )
    limit_fourth_power(page, profiled, rows, size)
    limit_capacity(page, profiled, rows)
    page.section("Load")
    page.sweep(
        "Life of bearing S over nine decades of one load",
        rows,
        SIZE,
        {"life, straight [Mrev]": "straight", "life, profile [Mrev]": "profile"},
        log="xy",
        axis="L10r [Mrev]",
        table=False,
    )


def lives_over_load(straight: Setup, profiled: Setup, factors: Floats) -> list[Record]:
    """Lives of both bearings, equivalent load and pressure of the profiled one, over load."""
    rows: list[Record] = []
    for factor in factors:
        record: Record = {SIZE: float(factor)}
        for name, setup in (("straight", straight), ("profile", profiled)):
            u = equilibrium(setup.bearing, factor * LOAD, tolerance=1e-12).displacements
            q = [lamina_loads(row, u) for row in roller_rows(setup.bearing)]
            record[f"life, {name} [Mrev]"] = float(setup.lives(q)[0])
        P = float(profiled.rated.equivalent_load(factor * LOAD)[0])
        record["P / C"] = P / profiled.capacity
        highest = max(float(np.max(p)) for pair in pressures(profiled.bearing, u) for p in pair)
        record["largest pressure [MPa]"] = 1e-6 * highest
        rows.append(record)
    return rows


def limit_fourth_power(page: Page, profiled: Setup, rows: list[Record], size: Floats) -> None:
    """State the loads in which the life of profiled rollers goes with the fourth power."""
    profile = np.array([row["life, profile [Mrev]"] for row in rows]) * size**4
    few = replace(profiled, bearing=profiled.bearing.with_rows(laminae=200))
    u = equilibrium(few.bearing, size[0] * LOAD, tolerance=1e-12).displacements
    fine = float(few.lives([lamina_loads(row, u) for row in roller_rows(few.bearing)])[0])
    coarse = float(rows[0]["life, profile [Mrev]"]) / fine
    page.data("profile: life at the least load, 30 over 200 laminae [-]", coarse)
    away = safe_range(size, np.abs(profile / profile[np.argmin(np.abs(size - 1.0))] - 1.0), 0.5)
    page.limit(
        "profiled rollers, life by the fourth power of load",
        SIZE,
        low=away[0],
        high=away[1],
        criterion="life times load to the fourth within a factor of 1.5 of that at the usual load",
        beyond="below, the middle of the rollers carries alone: at the least load life with 30 "
        f"laminae is {coarse:.2g} times that with 200; above, the ends carry too",
        program="rates the laminae that carry; nothing is scaled",
        remedy="no life of one load from that of another; rollers that slide for want of load are "
        "not covered at all: catalogues ask for some 2 % of C (from memory)",
    )


def limit_capacity(page: Page, profiled: Setup, rows: list[Record]) -> None:
    """Check that time above C/2 is counted; state the limit."""
    heavy = [row for row in rows if row["P / C"] > 0.5]
    at = min(heavy, key=lambda row: row["P / C"])
    page.found(f"{FLOWING} [MPa]", at["largest pressure [MPa]"])
    page.holds(
        "time with P above C/2 is counted, and none below",
        limits_of(profiled, at[SIZE] * LOAD, None).heavy == 10.0
        and limits_of(profiled, LOAD, None).heavy == 0.0,
        why="the user would not see that the method was left",
        source="ten seconds at 18 1/min",
    )
    page.limit(
        "basic life",
        "equivalent load P over C",
        high=0.5,
        criterion="ISO 281 asks for P below C/2 (from memory)",
        beyond=f"material flows: at P/C = {at['P / C']:.2f} the largest pressure is "
        f"{at['largest pressure [MPa]']:.0f} MPa, and C_0 is at some 4000; life still goes with "
        "the fourth power and looks like a number",
        program="rates it, and counts the time with P above C/2, and with a static safety below 1",
        remedy="a larger bearing; the counted time is with the result",
    )


def standstill(page: Page) -> None:
    """Speeds towards zero, and oscillations."""
    check_time(page)
    rows, still = oscillating()
    ratio = np.array([row[MOVING] for row in rows])
    page.equals(
        HARDLY_MOVING,
        float(ratio[0]),
        still,
        within=1e-3,
        why="loads change little over half a degree",
        source="mean of powers of 4.5 of a ring that stands",
    )
    page.equals(
        "life of the moving ring at half a turn to either side, over that of rotation",
        float(ratio[-1]),
        1.0,
        **round_off(1e4, "sums over the rollers' places and two powers of them"),
        source="every place meets every load",
    )
    amplitude = np.array([row[AMPLITUDE] for row in rows])
    enough = amplitude[np.abs(ratio - 1.0) <= ENOUGH].min()
    page.found(f"{SWUNG} [deg]", float(enough))
    pitch = 360.0 / roller_rows(own_setup().bearing)[0].rollers
    page.limit(
        "rating life of a bearing that oscillates",
        AMPLITUDE,
        low=float(enough),
        criterion="life of the moving ring within 5 % of that of rotation by as many turns, radial "
        "load on half of the rollers",
        beyond=f"places of the moving ring keep their load: {1.0 - still:.0%} less life of it; "
        f"below {pitch:g} deg rollers do not reach their neighbours' marks, and fretting and "
        "false brinelling decide",
        program="rates the turns, counts reversals, and rates nothing below 0.1 1/min",
        remedy="turn the rotor now and then; another method for pitch and yaw bearings",
    )
    page.section("Oscillation")
    page.sweep(
        "Life of a ring that moves to and fro under a radial load, at as many turns",
        rows,
        AMPLITUDE,
        MOVING,
        log="x",
        safe=(float(enough), None),
        table=False,
    )
    page.data("peak over mean of the load zone [-]", float(0.5 / sjovall(0.5, 1.1)[0]))


def oscillating() -> tuple[list[Record], float]:
    """Life of the moving ring over that of rotation, for each amplitude and for a ring at rest."""
    psi = np.linspace(-np.pi, np.pi, 1440, endpoint=False)
    q = np.maximum(np.cos(psi), 0.0) ** 1.1
    ring = q**4
    modes = np.fft.rfft(ring)
    k = np.arange(len(modes))
    rows: list[Record] = []
    for degrees in np.geomspace(0.5, 180.0, 18):
        seen = np.fft.irfft(modes * np.sinc(k * np.radians(degrees) / np.pi), len(psi))
        risk = np.mean(np.maximum(seen, 0.0) ** 1.125) ** (8.0 / 9.0)
        rows.append({AMPLITUDE: float(degrees), MOVING: float(ring.mean() / risk)})
    return rows, float(ring.mean() / np.mean(q**4.5) ** (8.0 / 9.0))


def check_time(page: Page) -> None:
    """Check that time at standstill and reversals are counted."""
    setup, grease = own_setup(), Lubricant(*GRADES["VG 460"])
    turning, standing, back = (
        damage(setup, LOAD, grease, speed) for speed in (18.0, 0.01, np.array([18.0, -18.0] * 5))
    )
    page.holds(
        "a bearing that stands does no damage, and its time is counted apart",
        standing.totals["L10r"] == 0.0 and standing.limits.standing == 10.0,
        why="years would grow without end while the bearing corrodes in its marks",
        source="speed of 0.01 1/min, below the tenth that counts as standstill",
    )
    page.holds(
        "an oscillation has the damage of its turns, and its reversals are counted",
        bool(np.isclose(back.totals["L10r"], turning.totals["L10r"], rtol=1e-12))
        and back.limits.reversals == 9,
        why="turns to and fro are turns, but it is no rotation: the user has to know",
        source="ten seconds of 18 1/min to and fro",
    )
