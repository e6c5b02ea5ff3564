"""Basic life of a main bearing against wind speed, with both stress risers."""

from dataclasses import replace

import numpy as np

from fe_drivetrain.bearing_life.life import equivalent_life, stress_riser, years
from fe_drivetrain.cases import case
from fe_drivetrain.cases.life.operating import state_assumptions, state_meaning
from fe_drivetrain.cases.life.own_lives import (
    EVENLY,
    FAIR,
    PROFILED,
    RISEN,
    own_histories,
    own_variants,
)
from fe_drivetrain.cases.references.main_bearings import OwnBearing, own_bearing
from fe_drivetrain.cases.references.studied_lives import (
    EDGES,
    HOUSING,
    SPEEDS,
    Setup,
    Winds,
    at_site,
    basic_lives,
    bearing_s,
    by_wind,
    rotor_speed,
    scatter_of_seeds,
    shares,
    thesis_setup,
)
from fe_drivetrain.cases.references.thesis_beam import BEARINGS, beam_body, housed_body
from fe_drivetrain.common import Floats
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import percent_text, value_text
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.studies.shown_units import bearing_in_words
from fe_drivetrain.turbine_loads.histories import Site

#: Site of the thesis's figure 5.9 [m/s], and its lives without and with the stress riser [years].
MEAN_WIND = 10.0
THESIS = (7.9, 1.6)
SOURCE = "Stirling 2023, section 5.3.6, figure 5.9"


@case(
    "Basic life of a main bearing against wind speed, with and without stress riser",
    source="Stirling 2023, section 5.3.6",
    settings={
        "drivetrain": "FILE, or a name of the library (otherwise the thesis's beam and bearing S)",
        "bearing": "NAME of a main bearing of your drivetrain (otherwise its first one)",
        "catalogue": "FILE with entries of your bearings, beside the program's",
    },
)
def run(run: Run, page: Page) -> None:
    """Lives at eleven wind speeds and at a site, of three arrangements in two housings."""
    own = own_bearing(run, page, "Basic life of a main bearing against wind speed")
    if own is not None:
        of_own(run, page, own)
        return
    state_assumptions(page)
    winds = Winds("medium", 0.1, 3, 20.0, 1.0) if run.quick else Winds("medium", 0.1, 6, 600.0, 0.5)
    with run.step("hub loads"):
        loads = winds.hub_loads()
    thesis = thesis_setup()
    with run.step("lives as the thesis's"):
        lives = variants(thesis, loads)
    check(page, lives, winds)
    rows: list[Record] = []
    for name, entry in BEARINGS.items():
        for housing, body in (("rigid", beam_body()), ("in series", housed_body(*HOUSING))):
            if run.quick and housing != "rigid":
                continue
            with run.step(f"{name}, housing {housing}"):
                setup = replace(thesis, bearing=bearing_s(entry, False), body=body)
                found = variants(setup, loads)
            rows.append({"bearing S": name, "housing": housing, **at_the_site(found)})
    ratios = [row["ratio"] for row in rows]
    page.between(
        "life with the stress riser over life without, of the thesis",
        THESIS[1] / THESIS[0],
        min(ratios),
        max(ratios),
        why="contact angle, arrangement and housing, none of them printed, decide how uneven "
        "laminae are: our choices are on both sides",
        source="bearing S in three arrangements and two housings",
    )
    show(page, lives, winds)
    page.section("Arrangement, contact angle, housing")
    page.table(
        f"Life at a site of {MEAN_WIND:g} m/s [years], and its ratio with and without stress riser "
        f"(thesis: {THESIS[1]:g} over {THESIS[0]:g}, {THESIS[1] / THESIS[0]:.2f})",
        rows,
    )
    page.data("life at the site [years]", rows)
    state_meaning(page)
    at = {name: at_site(by_wind(one), MEAN_WIND) for name, one in lives.items()}
    answer(page, at, ratios)
    page.say(
        f"Laminae that carry evenly would have {np.mean(stress_riser(30) ** 4.5) ** (-8 / 9):.2f} "
        "of the life. With the roller profile that the stress riser is meant for, life is "
        f"{at[PROFILED]:.1f} years; without stress riser, but with the lambda nu = 1 that belongs "
        f"to that, {at[FAIR]:.1f} years.",
    )


def of_own(run: Run, page: Page, own: OwnBearing) -> None:
    """Lives of a user's bearing at the same winds, and at the same site."""
    winds = Winds("medium", 0.1, 3, 20.0, 1.0) if run.quick else Winds("medium", 0.1, 6, 600.0, 0.5)
    with run.step("hub loads"):
        histories = own_histories(winds, own.rotor)
    with run.step(f"lives of {own.one.name}"):
        lives = own_variants(own, histories)
    check_variants(page, lives)
    speed = rotor_speed(own.rotor)
    show(page, lives, winds, speed, printed=False)
    state_meaning(page)
    at = {name: at_site(by_wind(one, speed[:, None]), MEAN_WIND) for name, one in lives.items()}
    left = 100.0 * at[RISEN] / at[EVENLY]
    page.answer(
        f"How much life of {bearing_in_words(own.one.name)} does the stress at roller ends cost?",
        f"At {MEAN_WIND:g}\u00a0m/s mean wind, stress at roller ends leaves "
        f"{percent_text(at[RISEN] / at[EVENLY])} of the basic life of "
        f"{value_text(at[EVENLY], 'years')}; with profiled rollers it is "
        f"{value_text(at[PROFILED], 'years')}.",
        [
            page.value("life with stress at ends over life without [%]", left),
            page.value("life without stress at ends [years]", at[EVENLY]),
            page.value("life with stress at ends [years]", at[RISEN]),
            page.value("life with stress at ends and profiled rollers [years]", at[PROFILED]),
        ],
        hero=HERO,
        cautions=[
            "Hub loads are those of a substitute turbine, scaled to the rated power and speed of "
            "the drivetrain: `fe-drivetrain life` takes your own files.",
            "Housings are rigid, and lives are basic ones: `fe-drivetrain life` includes lubricant "
            "and contamination.",
        ],
    )


HERO = "Basic reference life by wind speed, rigid housing"


def answer(page: Page, own: dict[str, float], ratios: list[float]) -> None:
    """State what the stress riser leaves of the life at the site, beside the thesis."""
    ratio, thesis = own[RISEN] / own[EVENLY], THESIS[1] / THESIS[0]
    low, high = min(ratios), max(ratios)
    holds = low <= thesis <= high
    page.answer(
        "How much life of a main bearing does the stress at roller ends cost?",
        f"Stress at roller ends leaves {percent_text(ratio)} of the life at {MEAN_WIND:g}\u00a0m/s "
        f"mean wind; the thesis's {percent_text(thesis)} lies "
        f"{'within' if holds else 'not within'} our range of {percent_text(low)} to "
        f"{percent_text(high)}.",
        [
            page.value(
                "life with stress at ends over life without [%]",
                100.0 * ratio,
                beside=100.0 * thesis,
                by="thesis",
            ),
            page.value("the same, lowest over arrangements and housings [%]", 100.0 * low),
            page.value("the same, highest over arrangements and housings [%]", 100.0 * high),
            page.value(
                "life without stress at ends [years]", own[EVENLY], beside=THESIS[0], by="thesis"
            ),
            page.value(
                "life with stress at ends [years]", own[RISEN], beside=THESIS[1], by="thesis"
            ),
            page.value("life with stress at ends and profiled rollers [years]", own[PROFILED]),
        ],
        hero=HERO,
        cautions=[
            "The thesis's years are of another turbine and bearing: compare shares, not years."
        ],
        claim="holds" if holds else "does not hold",
    )


def variants(setup: Setup, loads: Floats) -> dict[str, Floats]:
    """L10r (winds, steps) of both stress risers, and of what belongs to each."""
    straight = setup.deflections(loads)
    name = setup.bearing.with_rows(crown=45e-5 * setup.bearing.rows[0].diameter)
    crowned = replace(setup, bearing=name, riser=None)
    even = basic_lives(setup, straight)
    return {
        EVENLY: even,
        RISEN: basic_lives(replace(setup, riser=None), straight),
        PROFILED: basic_lives(crowned, crowned.deflections(loads)),
        FAIR: basic_lives(replace(setup, edge=1.0), straight),
    }


def at_the_site(lives: dict[str, Floats]) -> Record:
    """Years of each variant, and the ratio of the thesis's two."""
    found = {name: at_site(by_wind(one), MEAN_WIND) for name, one in lives.items()}
    return {**found, "ratio": found[RISEN] / found[EVENLY]}


def check_variants(page: Page, lives: dict[str, Floats]) -> None:
    """Life without stress riser by both values of lambda nu."""
    page.equals(
        "life without stress riser: lambda nu of 0.83 over 1, the worst step",
        float((lives[EVENLY] / lives[FAIR]).max()),
        0.83**-4,
        within=1e-9,
        why="round-off: life goes with the fourth power of C",
        source="Q_c is as 1 / (lambda nu), Stirling 2023, eqs 5.1 and 5.8",
    )


def check(page: Page, lives: dict[str, Floats], winds: Winds) -> None:
    """What does not depend on whose turbine it is."""
    check_variants(page, lives)
    of_winds = by_wind(lives[EVENLY])
    weights = np.broadcast_to(Site(MEAN_WIND).shares(EDGES)[:, None], lives[EVENLY].shape)
    steps = years(lives[EVENLY], rotor_speed()[:, None])
    at_once = equivalent_life(steps.ravel(), weights.ravel()) / Site(MEAN_WIND).shares(EDGES).sum()
    page.equals(
        "life at the site: of each wind, then of all, over all steps at once",
        at_site(of_winds, MEAN_WIND) / float(at_once),
        1.0,
        within=1e-10,
        why="round-off of a sum",
        source="Miner's rule does not depend on the order",
        basis="self-consistency",
    )
    for name in (EVENLY, RISEN):
        fall = np.diff(np.log(by_wind(lives[name])))
        error = scatter_of_seeds(lives[name], winds.seeds)
        allowed = 2.0 * np.hypot(error[1:], error[:-1])
        page.holds(
            f"{name}: life falls from each wind speed to the next, but for twice the standard "
            "error of the seeds",
            bool((fall < allowed).all() and fall.sum() < 0.0),
            why="the moment grows with wind speed",
            source=SOURCE,
        )
        rated = int(np.searchsorted(SPEEDS, 12.0))
        page.holds(
            f"{name}: a m/s costs more up to 12 m/s than above",
            fall[:rated].mean() < fall[rated:].mean(),
            why="thrust and rotor speed grow up to rated wind, and not above",
            source=SOURCE,
        )


def show(
    page: Page,
    lives: dict[str, Floats],
    winds: Winds,
    speed: Floats | None = None,
    printed: bool = True,
) -> None:
    """Figure 5.9, and the share of damage; of rotor speeds (winds,) [1/min], or the thesis's."""
    page.section("Life by wind speed")
    turning = (rotor_speed() if speed is None else speed)[:, None]
    found = {name: by_wind(one, turning) for name, one in lives.items()}
    ends = [SPEEDS[0], SPEEDS[-1]]
    colors = {EVENLY: "#0072b2", RISEN: "#d55e00", PROFILED: "#009e73", FAIR: "#999999"}
    traces = [
        trace(name, SPEEDS, one, mode="lines+markers", line={"color": colors[name]})
        for name, one in found.items()
    ]
    for name, years_there in zip((EVENLY, RISEN), THESIS, strict=True):
        site = at_site(found[name], MEAN_WIND)
        shown = [("site", site, "dash")]
        if printed:
            shown.append(("thesis, site", years_there, "dot"))
        for words, value, dash in shown:
            line = {"color": colors[name], "dash": dash}
            traces.append(trace(f"{words}: {value:.2g} years", ends, [value, value], line=line))
    page.chart(
        HERO,
        traces,
        "mean wind speed [m/s]",
        "life [years]",
        "y",
    )
    rows: list[Record] = [
        {
            "mean wind speed [m/s]": float(v),
            "time [%]": 100.0 * float(w),
            **{f"life, {name} [years]": float(one[k]) for name, one in found.items()},
            "damage, f = 1 [%]": float(shares(found[EVENLY], MEAN_WIND)[k]),
            "damage, f of ISO [%]": float(shares(found[RISEN], MEAN_WIND)[k]),
        }
        for k, (v, w) in enumerate(zip(SPEEDS, Site(MEAN_WIND).shares(EDGES), strict=True))
    ]
    page.sweep(
        f"Share of time and of damage at a site of {MEAN_WIND:g} m/s",
        rows,
        "mean wind speed [m/s]",
        {"time [%]": "time", "damage, f = 1 [%]": "damage"},
        axis="share [%]",
    )
    error = float(scatter_of_seeds(lives[EVENLY], winds.seeds, MEAN_WIND, turning))
    page.data("standard error of the logarithm of life, of seeds [-]", error)
    page.text(
        f"{winds.seeds} histories of {winds.duration:g} s at each wind speed: their number alone "
        f"leaves a standard error of {100 * error:.0f} % in the life at the site, but hardly any "
        "in ratios of lives, which share the histories. Wind speeds above 14 m/s, a small part of "
        "the time, do most of the damage: life goes with the fourth power of load."
    )
