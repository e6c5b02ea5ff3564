"""Hours of wind speeds and time factors of gears: two printed tables, and what teeth count."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.gear import published_hours as printed
from fe_drivetrain.cases.gear.turbine_years import RATED_WIND, Duty, operation
from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file.gear_stages import PlanetaryData
from fe_drivetrain.dynamics import Machine, machine_of
from fe_drivetrain.gear import ParallelStage, PlanetaryStage, loads_per_turn
from fe_drivetrain.report import bars
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.report.suite.chosen import SETTING
from fe_drivetrain.studies.gear_meshes import counted_stage
from fe_drivetrain.turbine_loads.histories import Site, time_factors

STAGES = (PlanetaryStage(29, 58, 145), ParallelStage(108, 27), ParallelStage(111, 29))
LASTING = 20.0
"""Duration of a history [s]."""


@case(
    "Hours of wind speeds and time factors of gears: printed tables, and what teeth count",
    source="Al-Hamadani 2018, section 7.5, Eq 5.28-5.32, Tables 7.1 and 7.2",
    settings={"drivetrain": "FILE, or a name of the library (otherwise drivetrain C)"},
)
def run(run: Run, page: Page) -> None:
    """Both tables to the digit, and loads of a tooth that the second one divides by."""
    if SETTING in run.settings:
        own(run, page)
        return
    edges = np.arange(3.0, 26.0)
    hours = Site(mean_wind=10.0, years=20.0).hours(edges)
    factors = time_factors(hours, LASTING)
    check_tables(page, edges, hours, factors)
    rows = counted_loads()
    answer(page, rows, hours, factors)
    page.section("Hours in 20 years and time factors")
    winds = zip(printed.WINDS, hours, printed.HOURS, factors, printed.FACTORS, strict=True)
    page.table(
        "Table 7.1",
        [
            (wind, round(float(mine)), hour, round(float(factor)), given)
            for wind, mine, hour, factor, given in winds
        ],
        ("wind [m/s]", "hours", "printed hours", "time factor", "printed factor"),
    )
    page.section("Time factors of gears")
    keys = ("printed: over the ring's", "counted: over the ring's")
    groups = {
        key.partition(":")[0]: {str(row["tooth"]): float(str(row[key])) for row in rows}
        for key in keys
    }
    page.add(bars(HERO, groups, "loads of a flank over those of the ring's", least=1e-2))
    page.table("Loads of a tooth's flank over those of the ring's, drivetrain C", rows)
    page.text(
        "Table 7.2 divides by teeth and by ratios of speed, so that teeth of faster shafts count "
        "less. A tooth of a faster shaft meshes more often: a tooth of the ring three times in a "
        "turn of the carrier, of the sun once for each planet that passes, of a pinion once in "
        "each of its own turns. The last column is what damage by Table 7.2 has to be multiplied "
        "by, beside that of the ring."
    )
    page.say(
        "Both tables come out to the digit when they are computed as the thesis does: hours of "
        f"bins that end at the wind named, {hours.sum() / 1752.0:.1f} % of 20 years in all, and "
        "their factors divided by teeth and ratios of speed. Ratios have to multiply."
    )


LOADS = "Loads of a flank of each gear in 20 years"
CLOSEST = 1e-12


def own(run: Run, page: Page) -> None:
    """Loads of the teeth of a user's drivetrain in twenty years, at the winds of Table 7.1."""
    chosen = run.drivetrain("", gears=True)
    chosen.state(page, topic="Loads of gear teeth over twenty years")
    least, speed = chosen.rotor_speeds()
    machine = machine_of(chosen.drivetrain)
    turns = loads_per_turn([counted_stage(stage) for stage in machine.stages])
    duty = Duty(1.0, least, speed)  # turns do not depend on the power
    rotor = {wind: float(n.sum()) for wind, _, n in operation(duty)}
    total = sum(rotor.values())
    check_counts(page, machine, turns)
    rows: list[Record] = [
        {
            "tooth": name,
            "loads per turn of the rotor": one,
            "loads in 20 years": one * total,
        }
        for name, one in turns.items()
    ]
    page.section("Loads of teeth")
    page.add(bars(LOADS, {"loads": {name: one * total for name, one in turns.items()}}, "loads"))
    page.table("Loads of one flank of a tooth", rows)
    page.section("Turns of the rotor in 20 years")
    page.table(
        "Turns of the rotor by wind speed",
        [(wind, n, n / total) for wind, n in rotor.items()],
        ("wind [m/s]", "turns of the rotor", "share"),
    )
    own_answer(page, turns, total)
    page.assume("site", "10 m/s of mean wind, Rayleigh, 20 years", "", "of Table 7.1")
    page.assume("wind of rated speed", RATED_WIND, "m/s", "of the case; no file states it")
    page.assume_all(machine.assumptions())


def check_counts(page: Page, machine: Machine, turns: dict[str, float]) -> None:
    """Loads of teeth against speeds of shafts, and against those of the gears that they meet."""
    speeds = np.abs(machine.speeds)
    for number, stage in enumerate(machine.stages, start=1):
        name = f"stage {number}"
        if isinstance(stage, PlanetaryData):
            slip, planets = float(speeds[number] - speeds[number - 1]), stage.planets
            of = {"sun": planets * slip, "ring": planets * float(speeds[number - 1])}
        else:
            of = {"pinion": float(speeds[number]), "gear": float(speeds[number - 1])}
        for gear, exact in of.items():
            page.equals(
                f"{name} {gear}: loads per turn of the rotor",
                turns[f"{name} {gear}"],
                exact,
                within=CLOSEST,
                why="quotients of whole numbers of teeth: rounding",
                source="speeds of shafts against what the gear meets",
            )


def own_answer(page: Page, turns: dict[str, float], total: float) -> None:
    """State which tooth of a user's drivetrain is loaded most often, and how often."""
    most, least = (max(turns, key=lambda n: turns[n]), min(turns, key=lambda n: turns[n]))
    page.answer(
        "How often are the teeth of the gears loaded in 20 years?",
        f"Teeth of the {most} are loaded most often, {value_text(turns[most] * total)} times; "
        f"those of the {least} least, {value_text(turns[least] * total)} times.",
        [
            page.value(f"loads in 20 years, {most}", turns[most] * total),
            page.value(f"loads in 20 years, {least}", turns[least] * total),
            page.value(f"loads per turn of the rotor, {most}", turns[most]),
            page.value(f"loads per turn of the rotor, {least}", turns[least]),
            page.value("turns of the rotor in 20 years", total),
        ],
        hero=LOADS,
        cautions=["The rotor is taken to stand still outside of 4 to 25 m/s, without idling."],
    )


HERO = "How often a flank is loaded, beside the ring's: Table 7.2 and counted"


def answer(page: Page, rows: list[Record], hours: Floats, factors: Floats) -> None:
    """State which time factors of the thesis hold."""
    over = "counted over printed"
    teeth = {str(row["tooth"]): float(str(row[over])) for row in rows}
    worst = max(teeth, key=lambda name: abs(np.log(teeth[name])))
    holds = abs(teeth[worst] - 1.0) < 0.01
    page.answer(
        "Do Tables 7.1 and 7.2 of the thesis count rightly how often gear teeth are loaded?",
        f"Tables 7.1 and 7.2 hold: loads of all {len(rows)} teeth are those counted."
        if holds
        else f"Table 7.2 does not hold: relative to the ring, the {worst} is loaded "
        f"{value_text(teeth[worst])} times as often as printed; Table 7.1 holds.",
        [
            *(
                page.value(f"loads counted, times those of Table 7.2, {name}", teeth[name])
                for name in (worst, "stage 2 pinion", "stage 1 sun", "stage 1 planet, flank to sun")
            ),
            page.value(
                "Table 7.1: largest difference [h]",
                float(np.abs(hours - np.array(printed.HOURS)).max()),
                at_most=0.5,
                by="half of the last digit",
            ),
            page.value(
                "Table 7.1: largest difference of a time factor",
                float(np.abs(factors - np.array(printed.FACTORS)).max()),
                at_most=0.5,
                by="half of the last digit",
            ),
        ],
        hero=HERO,
        cautions=["Loads are counted from the numbers of teeth of the thesis's drivetrain C."],
        claim="holds" if holds else "does not hold",
    )


def check_tables(page: Page, edges: Floats, hours: Floats, factors: Floats) -> None:
    """Both tables come out to the digit."""
    for name, ours, table in (
        ("hours", hours, printed.HOURS),
        ("time factors", factors, printed.FACTORS),
    ):
        page.vanishes(
            f"Table 7.1, {name}: largest difference from the {len(table)} printed",
            float(np.abs(ours - np.array(table)).max()),
            within=0.5,
            why="half of the last digit",
            source="Rayleigh's distribution of 10 m/s: shares of bins that end at the wind named",
        )
    of_winds = factors[np.searchsorted(edges[1:], printed.ADJUSTED_WINDS)]
    divided = of_winds[:, None] / np.array(list(printed.DIVISORS.values()))
    page.vanishes(
        "Table 7.2: largest difference from the 49 printed",
        float(np.abs(divided - np.array(printed.ADJUSTED)).max()),
        within=0.5,
        why="half of the last digit",
        source="time factors over teeth of the planet, of the ring, and of the planet times ratios",
    )


def counted_loads() -> list[Record]:
    """Loads of each tooth over those of the ring's, as printed and as counted."""
    turns = loads_per_turn(STAGES)
    ring = printed.DIVISORS["stage 1 ring"]
    return [
        {
            "tooth": name,
            "printed: over the ring's": ring / divisor,
            "counted: over the ring's": turns[name] / turns["stage 1 ring"],
            "counted over printed": turns[name] / turns["stage 1 ring"] * divisor / ring,
        }
        for name, divisor in printed.DIVISORS.items()
    ]
