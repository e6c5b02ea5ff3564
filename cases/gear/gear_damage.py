"""Damage of the gears of the NREL 5 MW gearbox over twenty years, both flanks apart."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from scipy.stats import norm

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.rated_gears import RatedMesh, rated_meshes, with_dynamics
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import round_off
from fe_drivetrain.gear import (
    ParallelStage,
    PlanetaryStage,
    RatedTooth,
    ToothDamage,
    contact_stress,
    damage_of_history,
    damage_of_turns,
    endured_contact,
    endured_root,
    loads_per_turn,
    root_stress,
    torque_exponent,
)
from fe_drivetrain.report import bars
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.turbine_loads.histories import Site, equivalent_level

STAGES = (PlanetaryStage(19, 17, 56), PlanetaryStage(18, 36, 93), ParallelStage(95, 24))
RPM = np.pi / 30.0
RATED = 5e6 / (12.1 * RPM)  # N m of the rotor
SAFETY = (1.25, 1.56)
"""On contact and root stress (IEC 61400-4, as the reports have them)."""

HOURS = 175200.0
SITE = Site(mean_wind=10.0, years=20.0)
WINDS = np.arange(4.0, 26.0)
SCATTER = 0.1
"""Standard deviation of the torque over its mean: assumed."""

STOPS = 1100.0
"""A year (Al-Hamadani 2018, section 7)."""

KISSSOFT = "KISSsoft 03/2017 reports in gfsReboucas/Drivetrain"
THESIS = "Al-Hamadani 2018, Table 7.2, divides by the ratios"

Teeth = tuple[RatedMesh, int, str]


def teeth() -> list[Teeth]:
    """Mesh, which of its gears, and the name under which its loads are counted."""
    names = (
        ("stage 1 sun", "stage 1 planet, flank to sun"),
        ("stage 1 planet, flank to ring", "stage 1 ring"),
        ("stage 2 sun", "stage 2 planet, flank to sun"),
        ("stage 2 planet, flank to ring", "stage 2 ring"),
        ("stage 3 pinion", "stage 3 gear"),
    )
    meshes = [m for name, m in rated_meshes().items() if name.startswith("NREL")]
    return [(m, n, pair[n]) for m, pair in zip(meshes, names, strict=True) for n in (0, 1)]


def rated_teeth(application: float, endless: bool = True) -> list[RatedTooth]:
    """All teeth with their stresses at the rated torque, with the application factor given."""
    counts, found = loads_per_turn(STAGES), []
    for mesh, number, name in teeth():
        # load spectra stand in the place of an application factor; the others are those of rating
        K = replace(with_dynamics(mesh), K_A=application)
        contact = contact_stress(mesh.pair, mesh.running.torque, K, mesh.materials)
        root = root_stress(mesh.pair, mesh.running.torque, K, mesh.cutter)[number]
        gear = (mesh.pair.first, mesh.pair.second)[number]
        flank = endured_contact(mesh.pair, mesh.running, mesh.materials, endless)[number]
        fillet = endured_root(
            gear,
            root.root,
            mesh.materials[number],
            mesh.running.root_roughness[number],
            mesh.mean_stress[number],
            endless,
        )
        found.append(
            RatedTooth(
                name,
                counts[name],
                RATED,
                SAFETY[0] * contact.stress[number],
                SAFETY[1] * root.stress,
                flank.curve,
                fillet.curve,
            )
        )
    return found


def operation() -> Iterator[tuple[float, Floats, Floats]]:
    """Wind speed, torques of the rotor and its turns at each over the life, normal about means."""
    hours = SITE.hours(np.append(WINDS - 0.5, WINDS[-1] + 0.5))
    levels = np.linspace(-4.0, 4.0, 42)
    share = np.diff(norm.cdf(levels)) / (norm.cdf(4.0) - norm.cdf(-4.0))
    for wind, time in zip(WINDS, hours, strict=True):
        power = 5e6 * min((wind / 11.4) ** 3, 1.0)
        speed = RPM * min(max(12.1 * wind / 11.4, 6.9), 12.1)
        torque = power / speed * (1.0 + SCATTER * 0.5 * (levels[1:] + levels[:-1]))
        yield float(wind), torque, share * time * 3600.0 * speed / (2.0 * np.pi)


def shutdown() -> tuple[Floats, Floats, float]:
    """Torque and speed of a stop: a swing of the shaft that dies out while the rotor slows down."""
    step = 0.01
    t = np.arange(0.0, 30.0, step)
    torque = RATED * 1.2 * np.exp(-0.15 * t) * np.cos(2.0 * np.pi * 2.18 * t)
    return torque, 12.1 * RPM * (1.0 - t / 30.0), step


@case(
    "Gear damage over twenty years: NREL 5 MW gearbox",
    source="ISO 6336-2, -3 and -6; KISSsoft 03/2017 reports; Al-Hamadani 2018, sections 5.4, 7.6",
)
def run(run: Run, page: Page) -> None:
    """Constant load as in the reports, then operation and stops at a site."""
    with run.step("constant load"):
        constant(page)
    with run.step("twenty years"):
        rows = twenty_years(page)
    with run.step("counts"):
        counts(page)
    answer(page, rows)


DAMAGES = "Damage of each tooth's flank in 20 years; 1 is failure"


def answer(page: Page, rows: list[Record]) -> None:
    """State which tooth is used up first, and when."""
    worst, second = sorted(rows, key=lambda r: -float(r["flank"]))[:2]
    other, root = (max(float(r[key]) for r in rows) for key in ("other flank", "root"))
    damage, years = float(worst["flank"]), SITE.years
    if damage > 1.0:
        verdict = f"The flank of the {worst['tooth']} does not last {years:.0f}\u00a0years: damage "
        verdict += f"{damage:.3g}, failure after {value_text(years / damage, 'years')}."
    else:
        verdict = f"All teeth last {years:.0f}\u00a0years: the largest damage is {damage:.2g}, of "
        verdict += f"the flank of the {worst['tooth']}."
    ring, sun = "stage 1 ring", "stage 2 sun"
    lasting = "damage of the flank in 175200 h"
    page.answer(
        "Do the gears of the NREL 5 MW gearbox last 20 years?",
        verdict,
        [
            page.value(f"flank damage in 20 years, {worst['tooth']}", damage, at_most=1.0),
            page.value(f"life of the {worst['tooth']} [years]", years / damage, at_least=years),
            page.value(
                f"flank damage, next: {second['tooth']}", float(second["flank"]), at_most=1.0
            ),
            page.value("largest root damage", root, at_most=1.0),
            page.judged(f"{ring}: {lasting}", f"{ring}, damage at rated torque", "KISSsoft"),
            page.judged(f"{sun}: {lasting}", f"{sun}, damage at rated torque", "KISSsoft"),
        ],
        hero=DAMAGES,
        cautions=[
            f"At S_H = {SAFETY[0]} and S_F = {SAFETY[1]}; turbulence of the torque and swings of "
            "stops are assumed, and load factors are those of the KISSsoft reports.",
            "The thesis weights fast shafts by the inverse of how often their teeth mesh, which "
            "does not hold: see the table of drivetrain C.",
        ],
    )
    page.say(f"Stops load the other flanks, too: a damage of {other:.1g} at most.")


def constant(page: Page) -> None:
    """Rated torque with its application factor over 175200 h, as the reports have it."""
    of = {tooth.name: tooth for tooth in rated_teeth(1.25)}
    turns = 12.1 * 60.0 * HOURS
    found = {name: damage_of_turns(tooth, [RATED], [turns]) for name, tooth in of.items()}
    for name, printed, within, why in (
        (
            "stage 2 sun",
            2.9374,
            0.045,
            "K_Hbeta was typed in with three digits, 2.06; half of the last to the power 16.3",
        ),
        ("stage 1 ring", HOURS / 1005.0, 1e-3, "four digits of the life, 1005 h"),
    ):
        page.equals(
            f"{name}: damage of the flank in 175200 h",
            found[name].flank,
            printed,
            within=within,
            why=why,
            source=KISSSOFT,
        )
    others = sum(d.flank for n, d in found.items() if n not in ("stage 2 sun", "stage 1 ring"))
    page.vanishes(
        "damage of all other flanks and of all roots",
        others + sum(d.root for d in found.values()),
        within=1e-12,
        why="below the endless limit there is none",
        source=KISSSOFT,
    )


def twenty_years(page: Page) -> list[Record]:
    """Operation and stops: damage of each tooth, by wind speed of the worst."""
    torque, speed, step = shutdown()
    rows: list[Record] = []
    by_wind: dict[str, list[ToothDamage]] = {}
    for tooth, lasting in zip(rated_teeth(1.0), rated_teeth(1.0, endless=False), strict=True):
        parts = [damage_of_turns(tooth, T, turns) for _, T, turns in operation()]
        stops = damage_of_history(tooth, torque, speed, step).times(STOPS * SITE.years)
        total = sum(parts, start=stops)
        on = sum((damage_of_turns(lasting, T, n) for _, T, n in operation()), start=stops)
        by_wind[tooth.name] = [*parts, stops]
        p = torque_exponent(tooth.contact_curve)
        T, n = (np.concatenate(c) for c in zip(*((T, n) for _, T, n in operation()), strict=True))
        rows.append(
            {
                "tooth": tooth.name,
                "loads per turn": tooth.loads_per_turn,
                "flank": total.flank,
                "flank, no endless limit": on.flank,
                "other flank": total.back,
                "root": max(total.root, total.root_back),
                "life [years]": SITE.years / total.largest if total.largest else None,
                "equivalent torque over rated": equivalent_level(T, p, n) / RATED,
            }
        )
    worst = max(rows, key=lambda r: float(r["flank"]))["tooth"]
    page.section("Twenty years")
    page.table("Damage of each tooth in 20 years; 1 is failure", rows)
    labels = [f"{w:.0f} m/s" for w in WINDS] + ["stops"]
    damages = (d.flank for d in by_wind[str(worst)])
    of_wind = {"flank": dict(zip(labels, damages, strict=True))}
    of_teeth = {"flank": {str(row["tooth"]): float(row["flank"]) for row in rows}}
    page.add(bars(DAMAGES, of_teeth, "damage; 10⁻⁶ stands for less", least=1e-6))
    page.add(bars(f"Damage of the flank by wind speed: {worst}", of_wind, "damage"))
    page.text(
        f"Site with {SITE.mean_wind:.0f} m/s of mean wind, Rayleigh. Torque follows the power up "
        f"to 5 MW at 12.1 1/min and scatters normally by {100 * SCATTER:.0f} % of its mean "
        f"(assumed); {STOPS:.0f} stops a year, each a swing of 1.2 of the rated torque at 2.18 Hz "
        "that dies out in 30 s (assumed). Histories, measured or simulated, come in by "
        "`damage_of_history` or `damage_of_levels`. Load factors are those of the rating without "
        "K_A, whose place the distribution takes. Without an endless limit the line from the knee "
        "to 1e10 cycles goes on below."
    )
    return rows


def counts(page: Page) -> None:
    """Loads of a flank per turn of the rotor, beside the weights of the thesis."""
    c = (PlanetaryStage(29, 58, 145), ParallelStage(108, 27), ParallelStage(111, 29))
    of = loads_per_turn(c)
    thesis = {
        "stage 1 ring": 1.0 / 145,
        "stage 1 planet, flank to sun": 1.0 / 58,
        "stage 1 sun": 3.0 / (58 * 6),
        "stage 2 gear": 3.0 / (58 * 6),
        "stage 2 pinion": 3.0 / (58 * 6 * 4),
        "stage 3 gear": 3.0 / (58 * 6 * 4),
        "stage 3 pinion": 3.0 / (58 * 6 * 4 * 111 / 29),
    }
    rows = [
        {
            "tooth": name,
            "loads per turn of the rotor": of[name],
            "over those of the ring": of[name] / 3.0,
            "weight in the thesis over that of the ring": weight * 145,
        }
        for name, weight in thesis.items()
    ]
    for name, exact in (("stage 1 sun", 15.0), ("stage 3 pinion", 24.0 * 111.0 / 29.0)):
        page.equals(
            f"loads of {name} per turn of the rotor, drivetrain C",
            of[name],
            exact,
            **round_off(10, "a quotient of whole numbers of teeth"),
            source="teeth of drivetrain C",
        )
    page.section("How often a tooth is loaded")
    page.table("Drivetrain C of Al-Hamadani 2018: loads of one flank", rows)
    page.text(
        f"{THESIS}, so that fast shafts get less damage from the same stress; a tooth of a faster "
        "shaft meshes more often, not less. It adds both flanks of a planet, too: ring and sun "
        "load opposite ones."
    )
