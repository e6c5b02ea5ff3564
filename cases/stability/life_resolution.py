"""How fine a rating life has to be resolved: laminae of rollers, and histories of each wind."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from fe_drivetrain.bearing import equilibrium, lamina_loads
from fe_drivetrain.bearing_life.life import stress_riser
from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.studied_lives import (
    ENOUGH,
    LOAD,
    SPEEDS,
    Winds,
    at_site,
    basic_lives,
    by_wind,
    own_setup,
    roller_rows,
    thesis_setup,
)
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import (
    as_printed,
)
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run

LAMINAE = "laminae of a roller"
SEEDS = "histories of each wind speed"
EVEN = "even load, f of ISO over f = 1"
LIVES = (
    "Life over that with the most laminae, over their number; shaded: profiled rollers within "
    f"{100 * ENOUGH:g} %"
)
#: Laminae that ISO/TS 16281 asks for at least.
ISO_LAMINAE = 30
#: Load histories of each wind speed that IEC 61400-1 asks for at least.
IEC_HISTORIES = 6.0


@case(
    "Rating life of a bearing: too few laminae, too few histories",
    source="ISO/TS 16281 as Stirling 2023, chapter 5, prints it; surrogate hub loads",
)
def run(run: Run, page: Page) -> None:
    """Life over the number of laminae, and scatter of damage over the number of seeds."""
    with run.step("laminae"):
        enough = laminae(page, run.quick)
    with run.step("seeds"):
        needed, scatter = seeds(page, run.quick)
    answer(page, enough, needed, scatter)


def answer(page: Page, enough: int, needed: float, scatter: float) -> None:
    """State how many laminae and histories are enough; scatter of damage with one history [%]."""
    thirty, many = left_by_riser(30), left_by_riser(100_000)
    percent = f"{100 * ENOUGH:g}"
    page.answer(
        "How many laminae and how many load histories does a rating life need?",
        f"A rating life within {percent}\u00a0% needs {enough} laminae per profiled roller and "
        f"{formatted(needed, 3)} load histories per wind speed, while IEC 61400-1 asks for "
        f"{IEC_HISTORIES:g}.",
        [
            page.value(
                f"laminae per profiled roller for {percent} %",
                enough,
                at_most=ISO_LAMINAE,
                by="ISO",
            ),
            page.value(
                f"load histories per wind speed for {percent} %",
                needed,
                beside=IEC_HISTORIES,
                by="IEC 61400-1",
            ),
            page.value("scatter of damage with one history per wind speed [%]", scatter),
            page.value(f"life with over without the stress riser, {ISO_LAMINAE} laminae", thirty),
            page.value("life with over without the stress riser, very many laminae", many),
        ],
        hero=LIVES,
        cautions=[
            f"The standard's stress riser at roller ends is right for {ISO_LAMINAE} laminae only: "
            "with more, it shortens the life less.",
            "The scatter is that of artificial loads: rare large loads of a real site decide how "
            "many histories are needed.",
        ],
    )


def laminae(page: Page, quick: bool) -> int:
    """Number of laminae, with and without stress riser; how many profiled rollers need."""
    counts = (3, 5, 10, 20, 30, 50, 100) if quick else (3, 5, 7, 10, 14, 20, 30, 50, 100, 200, 400)
    rows = lives_over_laminae(counts)
    n = np.array(counts, dtype=float)
    error = {
        name: np.abs(np.array([row[name] for row in rows]) / rows[-1][name] - 1.0)
        for name in ("straight, f = 1", "straight, f of ISO", "profile, f of ISO")
    }
    page.exponent(
        "straight rollers without stress riser: error of life over laminae, exponent",
        n[:-1],
        error["straight, f = 1"][:-1],
        -2.0,
        within=0.25,
        between=(1e-6, 0.2),
        why="the finest of the sweep stands for the limit, and its own error bends the last "
        "points of the curve",
        source="midpoint rule",
    )
    page.equals(
        "even load, 30 laminae: life with the stress riser over life without",
        rows[counts.index(ISO_LAMINAE)][EVEN],
        **as_printed("0.2886"),
        source="Stirling 2023, eq. 5.5, summed by itself",
        basis="self-consistency",
    )
    limit_laminae(page, rows, error["straight, f = 1"])
    page.say(
        f"The stress riser of ISO/TS 16281 belongs to {ISO_LAMINAE} laminae: under an even load "
        "life does not converge to what they give. With the profile that it is meant for the "
        "outermost laminae carry nothing, and life converges.",
    )
    enough = counts[int(np.argmax(error["profile, f of ISO"] <= ENOUGH))]
    page.section("Laminae")
    page.sweep(
        LIVES,
        [
            {LAMINAE: row[LAMINAE], **{name: row[name] / rows[-1][name] for name in error}}
            for row in rows
        ],
        LAMINAE,
        {name: name for name in error},
        log="x",
        safe=(enough, None),
        axis="life over that of the most laminae",
    )
    page.table("Under an even load the stress riser alone", rows, [LAMINAE, list(rows[0])[-1]])
    return enough


def lives_over_laminae(counts: Sequence[int]) -> list[Record]:
    """Life of three kinds of rollers, and under an even load, over the number of laminae."""
    rows: list[Record] = []
    for count in counts:
        record: Record = {LAMINAE: count}
        for name, profile, risen in (
            ("straight, f = 1", False, False),
            ("straight, f of ISO", False, True),
            ("profile, f of ISO", True, True),
        ):
            setup = own_setup() if profile else thesis_setup("bearing_s_o20")
            bearing = setup.bearing.with_rows(laminae=count)
            rule = None if risen else np.ones(count)
            one = replace(setup, bearing=bearing, riser=rule)
            u = equilibrium(bearing, LOAD, tolerance=1e-12).displacements
            life = one.lives([lamina_loads(row, u) for row in roller_rows(bearing)])
            record[name] = float(life[0])
        record[EVEN] = left_by_riser(count)
        rows.append(record)
    return rows


def left_by_riser(count: int) -> float:
    """Life under an even load with the stress riser over life without."""
    return float(np.mean(stress_riser(count) ** 4.5) ** (-8.0 / 9.0))


def limit_laminae(page: Page, rows: list[Record], error: Floats) -> None:
    """State how many laminae straight rollers need, and how many the stress riser is made for."""
    enough = [row[LAMINAE] for row, one in zip(rows[:-1], error[:-1], strict=True) if one <= ENOUGH]
    page.limit(
        "basic reference life, straight rollers without stress riser",
        LAMINAE,
        low=float(min(enough)) if enough else None,
        criterion=f"life within 5 % of that with {rows[-1][LAMINAE]}",
        beyond="the most loaded end of a leaning roller is averaged away",
        program="has 30 laminae where none are given; a closed form has none, and is refused",
        remedy="laminae=30 or more",
    )
    page.limit(
        "stress riser of ISO/TS 16281",
        LAMINAE,
        low=30.0,
        high=30.0,
        criterion="the standard asks for 30 laminae or more (Stirling 2023, section 2.3)",
        beyond=f"the two outermost laminae have f = {stress_riser(30)[0]:.2f} whatever their "
        f"length: under an even load the riser leaves {left_by_riser(30):.2f} of life with 30 "
        f"laminae, {rows[0][EVEN]:.2f} with {rows[0][LAMINAE]}, "
        f"{left_by_riser(100_000):.2f} with 100 000: life does not converge to what 30 give",
        program="takes 30 laminae where none are given",
        remedy="state the number of laminae with such a life, or take the rollers' real profile",
    )


def seeds(page: Page, quick: bool) -> tuple[float, float]:
    """How many histories a life at a site takes, and the scatter of damage with one [%]."""
    count = 6 if quick else 24
    winds = Winds(seeds=count, duration=20.0 if quick else 600.0, rate=0.2 if quick else 0.1)
    setup = thesis_setup()
    lives = basic_lives(setup, setup.deflections(winds.hub_loads()))
    rows = scatter_of_seeds(lives.reshape(len(SPEEDS), count, -1), 50 if quick else 200)
    n, scatter = (np.array([row[key] for row in rows]) for key in list(rows[0])[:2])
    page.exponent(
        "scatter of damage over the number of seeds, exponent",
        n,
        scatter,
        -0.5,
        within=0.25 if quick else 0.1,
        between=(1e-9, 1e9),
        relative=False,
        why="200 draws leave 5 % of each scatter, over a factor of 12; fewer in a quick run",
        source="independent histories",
    )
    needed = float(np.ceil((scatter * np.sqrt(n)).mean() ** 2 / (100.0 * ENOUGH) ** 2))
    page.limit(
        "life at a site from few seeds",
        SEEDS,
        low=needed,
        criterion="scatter of damage, one standard deviation, below 5 %; histories of "
        f"{winds.duration:g} s at {len(SPEEDS)} wind speeds",
        beyond=f"one seed scatters by {scatter[0]:.0f} %: rare large loads do most of the damage",
        program="pools all histories of a wind speed; the cases of life show their standard error",
        remedy="six seeds of each wind speed, as IEC 61400-1 asks for",
    )
    page.section("Seeds")
    page.sweep(
        "Scatter of the damage at a site of 8 m/s, rigid housing, over the number of seeds",
        rows,
        SEEDS,
        "scatter of damage [%]",
        log="xy",
        safe=(needed, None),
    )
    page.say(
        f"One history of {winds.duration:g} s of each wind speed leaves {scatter[0]:.0f} % scatter "
        f"in the damage at a site, {count} of them leave {scatter[0] / np.sqrt(count):.1f} %.",
    )
    return needed, float(scatter[0])


def scatter_of_seeds(steps: Floats, draws: int) -> list[Record]:
    """Scatter and median of the damage at a site, over the number of seeds.

    Parameters
    ----------
    steps : (wind speeds, seeds, steps) array
        Lives [Mrev].
    draws : int
        Random choices of seeds for each number.
    """
    speeds, count = steps.shape[:2]
    whole = at_site(by_wind(steps.reshape(speeds, -1)), 8.0)
    rng = np.random.default_rng(0)
    rows: list[Record] = []
    for chosen in (n for n in (1, 2, 3, 6, 12) if 2 * n <= count):
        found = []
        for _ in range(draws):
            some = np.array([rng.choice(count, chosen, replace=False) for _ in range(speeds)])
            part = np.take_along_axis(steps, some[:, :, None], axis=1)
            found.append(whole / at_site(by_wind(part.reshape(speeds, -1)), 8.0))
        # drawn without replacement: of so many histories that there would be
        correction = np.sqrt((count - 1.0) / (count - chosen))
        rows.append(
            {
                SEEDS: chosen,
                "scatter of damage [%]": 100.0 * float(np.std(found)) * float(correction),
                "median life over that of all [%]": 100.0 * (1.0 / float(np.median(found)) - 1.0),
            }
        )
    return rows
