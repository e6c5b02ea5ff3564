"""Damage of the gears of the NREL 5 MW gearbox over twenty years, both flanks apart."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.gear.own_meshes import OwnMeshes, own_ratings
from fe_drivetrain.cases.gear.turbine_years import (
    RATED_WIND,
    SCATTER,
    SITE,
    WINDS,
    Duty,
    MeshStop,
    mesh_of,
    operation,
    stop_of_meshes,
)
from fe_drivetrain.cases.references.operated_machines import PEAK
from fe_drivetrain.cases.references.rated_gears import RatedMesh, rated_meshes, with_dynamics
from fe_drivetrain.comparison import round_off
from fe_drivetrain.drivetrain_file import read_drivetrain
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
from fe_drivetrain.report.suite.chosen import SETTING
from fe_drivetrain.turbine_loads.histories import equivalent_level

STAGES = (PlanetaryStage(19, 17, 56), PlanetaryStage(18, 36, 93), ParallelStage(95, 24))
RPM = np.pi / 30.0
SAFETY = (1.25, 1.56)
"""On contact and root stress (IEC 61400-4, as the reports have them)."""

HOURS = 175200.0
STOPS = 1100.0
"""A year (Al-Hamadani 2018, section 7)."""

FIVE = Duty(5e6, 6.9 * RPM, 12.1 * RPM)
RATED = FIVE.torque

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
    counts = loads_per_turn(STAGES)
    return [
        rated_tooth((mesh, number, name), counts[name], RATED, SAFETY, application, endless)
        for mesh, number, name in teeth()
    ]


def rated_tooth(
    of: Teeth,
    count: float,
    torque: float,
    safety: tuple[float, float],
    application: float,
    endless: bool,
) -> RatedTooth:
    """One tooth at a torque of the rotor [N m], which is that of the mesh's own rating."""
    mesh, number, name = of
    # load spectra stand in the place of an application factor; the others are those of rating
    K = replace(with_dynamics(mesh), K_A=application)
    contact = contact_stress(mesh.pair, mesh.running.torque, K, mesh.materials)
    root = root_stress(mesh.pair, mesh.running.torque, K, mesh.cutter, mesh.rims)[number]
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
    return RatedTooth(
        name,
        count,
        torque,
        safety[0] * contact.stress[number],
        safety[1] * root.stress,
        flank.curve,
        fillet.curve,
    )


@case(
    "Gear damage over twenty years: NREL 5 MW gearbox",
    source="ISO 6336-2, -3 and -6; KISSsoft 03/2017 reports; Al-Hamadani 2018, sections 5.4, 7.6",
    settings={"drivetrain": "FILE, or a name of the library (otherwise the gears as printed)"},
)
def run(run: Run, page: Page) -> None:
    """Constant load as in the reports, then operation and stops at a site."""
    if SETTING in run.settings:
        own(run, page)
        return
    with run.step("constant load"):
        constant(page)
    with run.step("stop"):
        stop = stop_of_meshes(read_drivetrain("nrel_5mw"), FIVE.torque)
    with run.step("twenty years"):
        rows = twenty_years(page, rated_teeth(1.0), rated_teeth(1.0, endless=False), FIVE, stop)
    with run.step("counts"):
        counts(page)
    answer(page, rows)


def own(run: Run, page: Page) -> None:
    """Damage of the teeth of a user's drivetrain at the same site."""
    chosen = run.drivetrain("", gears=True)
    chosen.state(page, topic="Damage of gears over twenty years")
    least, speed = chosen.rotor_speeds()
    found, ratings = own_ratings(chosen, page)
    duty = Duty(chosen.rated_torque() * speed, least, speed)
    with run.step("stop"):
        stop = stop_of_meshes(chosen.drivetrain, duty.torque)

    def teeth_of(endless: bool) -> list[RatedTooth]:
        return [
            rated_tooth(
                (one.rated, number, flank.name),
                flank.loads,
                duty.torque,
                (one.mesh.strength.contact_safety, one.mesh.strength.root_safety),
                1.0,
                endless,
            )
            for one in ratings
            if one.mesh.strength is not None
            for number, flank in enumerate(one.mesh.flanks)
        ]

    with run.step("twenty years"):
        rows = twenty_years(page, teeth_of(True), teeth_of(False), duty, stop)
    check_own(page, found, teeth_of(True), duty)
    own_answer(page, rows)
    page.assume("wind of rated power", RATED_WIND, "m/s", "of the case; no file states it")
    page.assume("scatter of the torque", 100.0 * SCATTER, "% of its mean", "of the case")
    page.assume("stops", STOPS, "a year", "Al-Hamadani 2018, section 7")


def check_own(page: Page, own: OwnMeshes, teeth: list[RatedTooth], duty: Duty) -> None:
    """Loads of teeth from speeds of shafts, and damage with twice as many levels of torque."""
    counts = {tooth.name: tooth.loads_per_turn for tooth in teeth}
    speeds = np.abs(own.train.machine.speeds)
    for number, stage in enumerate(own.train.machine.stages, start=1):
        planets = getattr(stage, "planets", 0)
        gear = f"stage {number} {'sun' if planets else 'pinion'}"
        if gear in counts:
            slip = speeds[number] - (speeds[number - 1] if planets else 0.0)
            page.equals(
                f"loads of {gear} per turn of the rotor",
                counts[gear],
                float(slip * max(planets, 1)),
                **round_off(100, "products of ratios of teeth"),
                source="speeds of shafts against what the gear meets",
            )
    damages = {
        levels: max(
            sum((damage_of_turns(tooth, T, n).flank for _, T, n in operation(duty, levels)))
            for tooth in teeth
        )
        for levels in (41, 82)
    }
    page.at_most(
        "change of the largest damage of a flank with twice as many levels of torque",
        abs(damages[82] - damages[41]),
        max(0.05 * damages[82], 1e-6),
        why="a twentieth of a damage is half a percent of the load at the slope of flanks",
        source="82 levels of torque at each wind",
        basis="self-consistency",
    )


def own_answer(page: Page, rows: list[Record]) -> None:
    """State which tooth of a user's drivetrain is used up first, and when."""
    ranked = sorted(rows, key=lambda row: -float(row["flank"]))
    worst, years = ranked[0], SITE.years
    root = max(rows, key=lambda row: float(row["root"]))
    flanks = float(worst["flank"]) >= float(root["root"])
    first, damage = (worst, float(worst["flank"])) if flanks else (root, float(root["root"]))
    what = f"the {'flank' if flanks else 'root'} of the {first['tooth']}"
    others = max(float(row["other flank"]) for row in rows)
    page.answer(
        "Do the gears last 20 years?",
        f"No: {what} reaches a damage of {damage:.3g} in {years:.0f}\u00a0years, so it fails after "
        f"{value_text(years / damage, 'years')}."
        if damage > 1.0
        else f"Yes: the largest damage in {years:.0f}\u00a0years is {damage:.2g}, of {what}.",
        [
            *(
                page.value(
                    f"flank damage in 20 years, {row['tooth']}", float(row["flank"]), at_most=1.0
                )
                for row in ranked[:3]
            ),
            page.value(f"largest root damage, {root['tooth']}", float(root["root"]), at_most=1.0),
            page.value("largest damage of other flanks, by stops", others, at_most=1.0),
        ],
        hero=DAMAGES,
        cautions=[
            "Turbulence of the torque, wind of rated power and times of stops are assumed; load "
            "factors are those of the file or by formula, without K_A.",
            "The command gears takes your own histories in place of the assumed ones.",
        ],
    )


DAMAGES = "Damage of each tooth's flank in 20 years; 1 is failure"


def answer(page: Page, rows: list[Record]) -> None:
    """State which tooth is used up first, and when."""
    worst, second = sorted(rows, key=lambda r: -float(r["flank"]))[:2]
    other, root = (max(float(r[key]) for r in rows) for key in ("other flank", "root"))
    damage, years = float(worst["flank"]), SITE.years
    if damage > 1.0:
        verdict = f"The flank of the {worst['tooth']} does not last {years:.0f}\u00a0years: its "
        verdict += f"damage reaches {damage:.3g} (1 is failure), so it fails after "
        verdict += f"{value_text(years / damage, 'years')}."
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
                f"flank damage in 20 years, next worst: {second['tooth']}",
                float(second["flank"]),
                at_most=1.0,
            ),
            page.value("largest root damage in 20 years", root, at_most=1.0),
            page.judged(
                f"{ring}: {lasting}",
                f"{ring}, flank damage of 20 years at rated torque",
                "KISSsoft",
            ),
            page.judged(
                f"{sun}: {lasting}", f"{sun}, flank damage of 20 years at rated torque", "KISSsoft"
            ),
        ],
        hero=DAMAGES,
        cautions=[
            f"The damage includes safety factors S_H = {SAFETY[0]} and S_F = {SAFETY[1]}; torque "
            "turbulence and the time of stops are assumed, load factors those of KISSsoft reports.",
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


def twenty_years(
    page: Page,
    teeth: list[RatedTooth],
    limitless: list[RatedTooth],
    duty: Duty,
    stop: Mapping[str, MeshStop],
) -> list[Record]:
    """Operation and stops: damage of each tooth, by wind speed of the worst.

    Parameters
    ----------
    page : Page
        The page.
    teeth, limitless : list of RatedTooth
        With and without an endless limit of their stresses.
    duty : Duty
        How the turbine runs.
    stop : mapping of str to MeshStop
        What each mesh carries in one stop.
    """
    years = list(operation(duty))
    rows: list[Record] = []
    by_wind: dict[str, list[ToothDamage]] = {}
    for tooth, lasting in zip(teeth, limitless, strict=True):
        parts = [damage_of_turns(tooth, T, turns) for _, T, turns in years]
        once = stop[mesh_of(tooth.name)]
        stops = damage_of_history(tooth, *once).times(STOPS * SITE.years)
        total = sum(parts, start=stops)
        on = sum((damage_of_turns(lasting, T, n) for _, T, n in years), start=stops)
        by_wind[tooth.name] = [*parts, stops]
        p = torque_exponent(tooth.contact_curve)
        T, n = (np.concatenate(c) for c in zip(*((T, n) for _, T, n in years), strict=True))
        rows.append(
            {
                "tooth": tooth.name,
                "loads per turn": tooth.loads_per_turn,
                "flank": total.flank,
                "flank, no endless limit": on.flank,
                "other flank": total.back,
                "root": max(total.root, total.root_back),
                "life [years]": SITE.years / total.largest if total.largest else None,
                "equivalent torque over rated": equivalent_level(T, p, n) / duty.torque,
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
    page.text(site_text(duty, stop))
    return rows


def site_text(duty: Duty, stop: Mapping[str, MeshStop]) -> str:
    """Site, torque and stops in words."""
    return (
        f"Site with {SITE.mean_wind:.0f} m/s of mean wind, Rayleigh. Torque follows the power up "
        f"to {1e-6 * duty.power:.3g} MW at {duty.speed / RPM:.3g} 1/min, reached at "
        f"{RATED_WIND} m/s, and scatters normally by {100 * SCATTER:.0f} % of its mean "
        f"(assumed); {STOPS:.0f} stops a year, each computed by bodies that turn: generator off, "
        "blades pitched in 2 s, then the brake, the file's own or one that brings the "
        f"last shaft to {PEAK} of rated torque; meshes reach {largest(stop, duty):.2f} of rated "
        f"torque and -{largest(stop, duty, -1.0):.2f}. Histories, measured or simulated, "
        "come in by `damage_of_history` or `damage_of_levels`. Load factors are those of the "
        "rating without K_A, whose place the distribution takes. Without an endless limit the line "
        "from the knee to 1e10 cycles goes on below."
    )


def largest(stop: Mapping[str, MeshStop], duty: Duty, sign: float = 1.0) -> float:
    """Largest torque of all meshes in a stop over rated, of one sign, without it."""
    return max(float((sign * one.torque).max()) for one in stop.values()) / duty.torque


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
