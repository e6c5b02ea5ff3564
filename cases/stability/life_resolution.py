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
from fe_drivetrain.report.suite import Page, Record, Run

LAMINAE = "laminae of a roller"
SEEDS = "histories of each wind speed"
EVEN = "even load, f of ISO over f = 1"


@case(
    "Rating life of a bearing: too few laminae, too few histories",
    source="ISO/TS 16281 as Stirling 2023, chapter 5, prints it; surrogate hub loads",
)
def run(run: Run, page: Page) -> None:
    """Life over the number of laminae, and scatter of damage over the number of seeds."""
    with run.step("laminae"):
        laminae(page, run.quick)
    with run.step("seeds"):
        seeds(page, run.quick)


def laminae(page: Page, quick: bool) -> None:
    """Number of laminae, with and without stress riser."""
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
    thirty, riser = rows[counts.index(30)][EVEN], left_by_riser(100_000)
    page.equals(
        "even load, 30 laminae: life with the stress riser over life without",
        thirty,
        **as_printed("0.2886"),
        source="Stirling 2023, eq. 5.5, summed by itself",
        basis="self-consistency",
    )
    limit_laminae(page, rows, error["straight, f = 1"])
    page.say(
        "The stress riser of ISO/TS 16281 belongs to 30 laminae: under an even load it leaves "
        f"{thirty:.2f} of life with them, and {riser:.2f} in the limit of very many. With the "
        "profile that it is meant for the outermost laminae carry nothing, and life converges: "
        f"{counts[int(np.argmax(error['profile, f of ISO'] <= ENOUGH))]} laminae are enough to "
        f"{100 * ENOUGH:g} %.",
    )
    page.section("Laminae")
    page.sweep(
        f"Life over that with {counts[-1]} laminae",
        [
            {LAMINAE: row[LAMINAE], **{name: row[name] / rows[-1][name] for name in error}}
            for row in rows
        ],
        LAMINAE,
        {name: name for name in error},
        log="x",
        axis="life over that of the most laminae",
    )
    page.table("Under an even load the stress riser alone", rows, [LAMINAE, list(rows[0])[-1]])


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


def seeds(page: Page, quick: bool) -> None:
    """How many histories a life at a site takes."""
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
    needed = (scatter * np.sqrt(n)).mean() ** 2 / (100.0 * ENOUGH) ** 2
    page.limit(
        "life at a site from few seeds",
        SEEDS,
        low=float(np.ceil(needed)),
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
        safe=(float(np.ceil(needed)), None),
    )
    page.say(
        f"One history of {winds.duration:g} s of each wind speed leaves {scatter[0]:.0f} % scatter "
        f"in the damage at a site, {count} of them leave {scatter[0] / np.sqrt(count):.1f} %.",
    )


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
