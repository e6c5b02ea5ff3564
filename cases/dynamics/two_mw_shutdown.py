"""A 2 MW machine in six degrees of freedom: normal operation against shutdown, part by part."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.dynamics.two_mw_damage import HOURS, STOPS, Shares, damage_shares
from fe_drivetrain.cases.dynamics.two_mw_guesses import (
    COLUMN,
    FLEXIBLE,
    grown,
    moved_by,
    of_rollers,
    planet_pins,
)
from fe_drivetrain.cases.dynamics.two_mw_loads import (
    EVERY,
    QUICK_EVERY,
    Change,
    Rolling,
    bearing_changes,
    bearing_rows,
    catalogued,
    contact_of,
    mesh_changes,
    mesh_rows,
    rolled,
    tangential,
)
from fe_drivetrain.cases.dynamics.two_mw_machine import (
    CLEARANCE,
    SCALE,
    TWO_MW,
    Chain,
    chain,
    scaled_bearings,
    thesis_machine,
)
from fe_drivetrain.cases.dynamics.two_mw_rolling_words import whole_share
from fe_drivetrain.cases.dynamics.two_mw_statements import MORE, Computed, Statement
from fe_drivetrain.cases.dynamics.two_mw_words import statements
from fe_drivetrain.cases.references.operated_machines import PEAK, RATED_WIND
from fe_drivetrain.common import Floats
from fe_drivetrain.dynamics import Level, pitch_contacts
from fe_drivetrain.report import bars, chart, mark_events, trace
from fe_drivetrain.report.answer import KeyFigure
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.studies import LifeOptions

FORCES = "Largest load in the shutdown over that in normal operation"
OVER_TIME = "Mesh forces over their rated values in the shutdown"
SAME = 0.02
"""Share of a ratio that step and level may leave uncertain together."""


@case(
    "A 2 MW machine in six degrees of freedom: normal operation against shutdown",
    source="Al-Hamadani 2018, section 7.2, Figures 7.11 to 7.32",
    settings={"drivetrain": "FILE, or a name of the library (otherwise synthetic_2mw)"},
)
def run(run: Run, page: Page) -> None:
    """Loads, reversals, contact stress, rollers and damage in both states, beside the thesis."""
    chosen = run.drivetrain(TWO_MW, gears=True)
    if not chosen.own:
        chosen = replace(chosen, drivetrain=thesis_machine())
    chosen.state(page, topic="Normal operation against shutdown, in six degrees of freedom")
    lives = LifeOptions() if chosen.own else scaled_bearings(run.folder)
    with run.step("normal operation and shutdown"):
        one = chain(chosen, run.folder, Level.RIGID, lives, damage=not run.quick)
    meshes = mesh_changes(one, one.normal.extremes, one.stop.extremes)
    bearings = bearing_changes(one, one.normal.extremes, one.stop.extremes)
    every = QUICK_EVERY if run.quick else EVERY
    with run.step("rollers"):
        rollers = rolled(one, every)
    with run.step("guesses"):
        moved = moved_by(one, run.quick)
    shares = damage_shares(one, rollers)
    check(page, one, meshes, moved)
    if chosen.own:
        own_answer(page, meshes, bearings)
    else:
        rolls = of_rollers(one, run.folder, every)
        known = meshes, bearings, rollers, moved, rolls
        said = statements(computed(one, *known, shares))
        answer(page, meshes, said, moved, shares)
        show_statements(page, said)
    show(page, one, meshes, bearings, rollers, not chosen.own)
    show_guesses(page, moved)
    if not chosen.own:
        page.table("Pressure and rollers of upwind bearing A by its size and clearance", rolls)
    show_damage(page, shares)
    assume(page, one, chosen.own)


def computed(
    one: Chain,
    meshes: Mapping[str, Change],
    bearings: Mapping[str, Change],
    rollers: Mapping[str, tuple[Rolling, Rolling]],
    moved: list[Record],
    rolls: list[Record],
    shares: Shares | None,
) -> Computed:
    """All that the statements of the thesis are held against."""
    contacts, known = pitch_contacts(one.rig.machine), catalogued(one)
    at = {
        name: [contacts[name].under(force) for force in (of.normal, of.stop)]
        for name, of in meshes.items()
    }
    depths = [
        contact_of(known[name], float(pair[0].pressure.max())).max_shear[1]
        for name, pair in rollers.items()
    ]
    return Computed(
        one,
        meshes,
        bearings,
        {name: (pair[0].pressure, pair[1].pressure) for name, pair in at.items()},
        {name: pair[0].max_shear[1] for name, pair in at.items()},
        rollers,
        (min(depths), max(depths)),
        moved,
        rolls,
        shares,
    )


def level_band(name: str, moved: list[Record]) -> float:
    """What the level leaves uncertain of a mesh's ratio; 0 where it was not run."""
    key = grown(name)
    other = [row for row in moved if row[COLUMN] == FLEXIBLE]
    return abs(float(str(other[0][key])) - float(str(moved[0][key]))) if other else 0.0


def check(page: Page, one: Chain, meshes: Mapping[str, Change], moved: list[Record]) -> None:
    """Check energy, convergence, and planets' balance."""
    for state, result in (("normal operation", one.normal), ("shutdown", one.stop)):
        page.at_most(
            f"{state}: energy that appears from nowhere, over the largest",
            result.imbalance,
            1e-6,
            why="average acceleration conserves the energy of linear systems, to round-off",
            source="work of loads and dampers is kinetic and strain energy",
            measure="identity",
        )
    for name, of in meshes.items():
        page.at_most(
            f"{name}: band of shutdown over normal by step and level, over it",
            (of.band + level_band(name, moved)) / of.ratio,
            SAME,
            why="two percent of a load are a fifteenth of a life of rollers",
            source="twice and four times the step; shafts that bend",
            basis="self-consistency",
        )


def answer(
    page: Page,
    meshes: Mapping[str, Change],
    said: list[Statement],
    moved: list[Record],
    shares: Shares | None,
) -> None:
    """State how many statements of the thesis hold, and the main ratios."""
    good, tested = counts(said)
    names = list(meshes)
    ring, fast = (meshes[name] for name in (names[1], names[-1]))
    most = max(meshes.values(), key=lambda one: one.ratio)
    ends = f"at the high-speed stage {fast.ratio:.2f} times"
    if fast.ratio >= most.ratio:
        ends = "most at the high-speed stage"
    label, other = most.name, most
    if most is ring or most is fast:
        label, other = "ring and planet", ring
    page.answer(
        "Does a shutdown load gears and bearings of a 2 MW machine as the thesis states?",
        f"{good} of {tested} statements hold: in a shutdown mesh forces reach {most.ratio:.2f} "
        f"times those of normal operation, {ends}.",
        [
            page.value(
                f"largest mesh force, {label}: shutdown over normal operation",
                of.ratio,
                of.band + level_band(of.name, moved),
                beside=MORE[of.name],
                by="thesis",
            )
            for label, of in ((label, other), ("high-speed stage", fast))
        ]
        + [
            page.value(
                "lowest force of the high-speed mesh in the shutdown, over rated",
                fast.least / fast.rated,
            ),
            page.value("statements of the thesis that hold", good),
            *damage_figures(page, shares),
        ],
        hero=FORCES,
        cautions=[
            "Torque records, brake, bearings, pins, modules and face widths are not printed but "
            "assumed; a table shows what each assumption changes.",
            f"The brake is sized so that the high-speed shaft reaches the printed {PEAK} of rated "
            "torque; its instant within a swing changes all ratios.",
            "The carrier stands at one azimuth: loads that turn with it are left out.",
        ],
        claim="holds in part" if 0 < good < tested else "holds" if good else "does not hold",
    )


def damage_figures(page: Page, shares: Shares | None) -> list[KeyFigure]:
    """Share of shutdowns in the damage of 20 years, where it was counted."""
    if shares is None:
        return []
    return [
        page.value(f"share of shutdowns in the damage of {name} [%]", 100.0 * whole_share(kind))
        for name, kind in (("gears", shares.gears), ("bearings", shares.bearings))
    ]


def counts(said: list[Statement]) -> tuple[int, int]:
    """How many statements hold, and how many can be tested."""
    tested = [one for one in said if one.stands != "not testable"]
    return sum(one.stands == "holds" for one in tested), len(tested)


def own_answer(page: Page, meshes: Mapping[str, Change], bearings: Mapping[str, Change]) -> None:
    """State which parts of a user's machine a shutdown loads most."""
    mesh = max(meshes.values(), key=lambda one: one.ratio)
    bearing = max(bearings.values(), key=lambda one: one.ratio)
    back = min(meshes.values(), key=lambda one: one.least / one.rated)
    page.answer(
        "How much more do gears and bearings carry in a shutdown than in normal operation?",
        f"In a shutdown {mesh.name} carries {mesh.ratio:.2f} times as much as in normal operation, "
        f"and {bearing.name} {bearing.ratio:.2f} times.",
        [
            page.value(f"{mesh.name}: shutdown over normal", mesh.ratio, mesh.band),
            page.value(f"{bearing.name}: shutdown over normal", bearing.ratio, bearing.band),
            page.value(f"{back.name}: least over rated", back.least / back.rated),
        ],
        hero=FORCES,
        cautions=[
            "Normal operation is that of a generic turbine in wind of the same rated power.",
            "Planets stand at one azimuth: loads that turn with the carrier are left out.",
        ],
    )


def show_statements(page: Page, said: list[Statement]) -> None:
    """Show each statement of the thesis with its verdict."""
    page.section("Statements of section 7.2")
    rows = [one.row for one in said]
    page.table("Printed, ours, verdict", rows)
    page.data("statements", rows)
    page.text(
        "The thesis has ring and sun grow by 27 and 12 % although they press the same planets: "
        "a planet's inertia takes a percent of these forces, so one of both is not of this event. "
        "Its fast bearings double their load (7.18) while their pressure grows by 17 % (7.24), "
        "which is a load grown by 37 %: the two contradict each other. Three printed stress ratios "
        "contradict Hertz as `dynamics/contact_stresses` shows."
    )


def show(
    page: Page,
    one: Chain,
    meshes: Mapping[str, Change],
    bearings: Mapping[str, Change],
    rollers: Mapping[str, tuple[Rolling, Rolling]],
    printed: bool,
) -> None:
    """Show loads, histograms, stresses and rollers."""
    page.section("Loads of gears")
    ratios = {name: of.ratio for name, of in meshes.items()}
    gearbox = {name: of.ratio for name, of in bearings.items() if of.stop > 0.1 * of.normal}
    groups = {"here": ratios, "thesis": dict(MORE)} if printed else {"here": ratios | gearbox}
    page.add(bars(FORCES, groups, "shutdown over normal"))
    rows = mesh_rows(one, meshes)
    page.table(
        "Circumferential force and contact stress (Figures 7.11, 7.14, 7.15, 7.19 to 7.21)", rows
    )
    page.data("meshes", rows)
    page.add(over_time(one, meshes))
    show_histograms(page, one, meshes)
    page.section("Loads of bearings")
    if printed:
        page.add(bars(f"{FORCES}, bearings", {"here": gearbox}, "shutdown over normal"))
    rows = bearing_rows(one, bearings, rollers)
    page.table("Radial load, pressure and rollers (Figures 7.12, 7.16 to 7.18, 7.22 to 7.28)", rows)
    page.data("bearings", rows)
    pins = planet_pins(one)
    if pins is None:
        return
    first = pins[0][0], pins[1][0]
    for state, result in (("normal operation", one.normal), ("the shutdown", one.stop)):
        page.chart(
            f"Share of the time at each load of the first planet's bearings, {state}",
            [trace(name, *density(result.samples.of(f"force of {name}") / 1e3)) for name in first],
            "radial load [kN]",
            "share of the time",
        )
    if first[0] in rollers:
        show_rollers(page, first[0], rollers[first[0]])
    show_pressures(page, rollers)


def show_pressures(page: Page, rollers: Mapping[str, tuple[Rolling, Rolling]]) -> None:
    """Show how long the pressure of each bearing is at each level, in both states."""
    for place, state in enumerate(("normal operation", "the shutdown")):
        traces = [
            trace(name, *density(pair[place].pressure / 1e6))
            for name, pair in rollers.items()
            if float(np.ptp(pair[place].pressure)) > 0.0
        ]
        if traces:
            page.chart(
                f"Share of the time at each pressure of bearings, {state} (Figures 7.22, 7.23)",
                traces,
                "Hertz pressure [MPa]",
                "share of the time",
            )


def over_time(one: Chain, meshes: Mapping[str, Change]) -> Any:
    """Forces of one mesh of each kind over time in the shutdown."""
    traces = []
    for name, of in meshes.items():
        times, values = one.stop.samples.course(of.channels[0], 2000)
        traces.append(trace(name, times, values / of.rated))
    drawn = chart(OVER_TIME, traces, "time [s]", "force over rated")
    return mark_events(drawn, one.stop.marks)


def show_histograms(page: Page, one: Chain, meshes: Mapping[str, Change]) -> None:
    """Show how long the circumferential force of each mesh is at each level, in both states."""
    share = tangential(one)
    for state, result in (("normal operation", one.normal), ("the shutdown", one.stop)):
        traces = []
        for name, of in meshes.items():
            values = share[name] * result.samples.of(of.channels[0]) / 1e3
            traces.append(trace(name, *density(values)))
        page.chart(
            f"Share of the time at each circumferential force, {state}",
            traces,
            "circumferential force [kN]",
            "share of the time",
        )


def density(values: Floats, bins: int = 40) -> tuple[Floats, Floats]:
    """Middles of bins, and the share of samples in each."""
    counts, edges = np.histogram(values, bins)
    return 0.5 * (edges[1:] + edges[:-1]), np.asarray(counts / len(values))


def show_rollers(page: Page, name: str, pair: tuple[Rolling, Rolling]) -> None:
    """Show the number of loaded rollers over time in both states."""
    page.chart(
        f"Rollers that carry load, {name} (Figure 7.25)",
        [
            trace(state, rolls.times, rolls.loaded)
            for state, rolls in zip(("normal operation", "shutdown"), pair, strict=True)
        ],
        "time [s]",
        "rollers",
    )


def show_guesses(page: Page, moved: list[Record]) -> None:
    """Show how far each guess moves the results."""
    page.section("What each guess moves")
    page.table("One guess changed at a time; the brake is that of the first row", moved)
    page.data("guesses", moved)


def show_damage(page: Page, shares: Shares | None) -> None:
    """Show damage by both counts."""
    if shares is None:
        page.say("Damage of gears and bearings is counted in full runs.")
        return
    page.section("Damage in 20 years")
    rows = shares.rows()
    page.table(
        f"{HOURS:,.0f} h at rated wind, {STOPS:,.0f} shutdowns (Figures 7.31 and 7.32)", rows
    )
    page.data("damage", rows)
    page.text(
        "A tooth feels its whole contact stress at each pass, and a race at each roller: damage "
        "goes with loads and turns. The thesis counts rainflow cycles of the stress over time, so "
        "that the steady load of normal operation does nothing at all and a shutdown, which goes "
        "from nothing to the peak, does nearly everything."
    )


def assume(page: Page, one: Chain, own: bool) -> None:
    """State what is not printed."""
    page.assume(
        "torque of normal operation",
        f"simulated, {RATED_WIND:g} m/s, medium turbulence",
        "",
        "measured records are private",
    )
    page.assume("sequence", "generator off at 1 s, blades pitched and brake at 3 s", "", "chosen")
    for key, value in one.values.items():
        page.assume(key.replace("_", " "), value, "", f"the fast shaft reaches {PEAK} of rated")
    if own:
        return
    words = "of the public 750 kW gearbox, by the root of the ratio of torques"
    page.assume("size of bearings over those", f"{SCALE:.3g}", "-", words)
    page.assume("diametral clearance of planet bearings", 1e3 * CLEARANCE, "mm", "not printed")
    page.assume("steels", "case-hardened, 1450 and 430 MPa", "", "1450 MPa printed, other chosen")
    for text in one.rig.machine.assumed:
        page.assume(text.partition(":")[0][:60], "", "", text)
