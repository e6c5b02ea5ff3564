"""Loads of planet bearings over a turn of the carrier: gravity, torque, moments of the hub."""

from collections.abc import Sequence

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.dynamics.planets_on_pins import TURNS, first_stage, isotropic
from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file import CarrierComponent, library_component, read_drivetrain
from fe_drivetrain.dynamics import (
    Flexible,
    Level,
    Machine,
    System,
    azimuths,
    load_sharing,
    machine_of,
    machine_system,
    over_a_turn,
    steady_load,
)
from fe_drivetrain.dynamics.bodies.static import Turn
from fe_drivetrain.report import bars, mark_events, trace
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import ChosenDrivetrain, Page, Record, Run
from fe_drivetrain.shafts.fidelity.component_frames import carrier_frame

NAME = "nrel_750kw"
TORQUE = 3.25e5  # N m, at 750 kW
MOMENTS = {"torque and gravity": (TORQUE, 0.0), "with -300 kN m of tilt": (TORQUE, -3e5)}
PRINTED = (1.41, 1.47)  # upwind over downwind, of the thesis
RATIOS = "Mean load of a planet's upwind bearing over that of its downwind one, beside the thesis"
TURNING = "Radial load of the bearings of planet 1, {}"


@case(
    "Planet bearings over a turn of the carrier: upwind and downwind, with moments of the hub",
    source="Al-Hamadani 2018, section 7.1; NREL Gearbox Reliability Collaborative",
    settings={
        "drivetrain": "FILE, or a name of the library (otherwise nrel_750kw, and nrel_5mw)",
        "moment": "NUMBER (kN m, against y at your own hub, otherwise as its torque)",
    },
)
def run(run: Run, page: Page) -> None:
    """Statics at each azimuth; balance, shifts by a third of a turn, harmonics of the rotor."""
    count = 12 if run.quick else 36
    chosen = run.drivetrain(NAME)
    if chosen.own:
        own(run, page, chosen, count)
        return
    machine = machine_of(chosen.drivetrain)
    chosen.state(page)
    angles = azimuths(count)

    with run.step("turns"):
        found = {name: turned(machine, angles, *given) for name, given in MOMENTS.items()}
        still = turned(machine, angles, TORQUE, 0.0, gravity=False)
        alone = turned(machine, angles, 0.0, 0.0)
    check(page, machine, found["torque and gravity"], still, alone, TORQUE)
    rows: list[Record] = []
    for name, one in found.items():
        rows += rows_of(f"{NAME}, {name}", machine, one)
    of_five = read_drivetrain("nrel_5mw")
    five = machine_of(of_five)
    page.concerns(of_five, "nrel_5mw")
    with run.step("5 MW, flexible carrier"):
        rows += five_megawatt(five, count)
    means = [float(str(row["mean [kN]"])) for row in rows]
    ratios = [up / down for up, down in zip(means[::2], means[1::2], strict=True)]
    cases = [str(row["load case"]) for row in rows[::2]]
    show_ratios(page, dict(zip(cases, ratios, strict=True)))
    show(page, found, angles, rows, ("upwind", "downwind"))
    answer(page, rows, ratios, not_round(still))
    for text in machine.assumed:
        page.assume(text.partition(":")[0][:60], "", "", text)


def answer(page: Page, rows: list[Record], ratios: list[float], uneven: float) -> None:
    """State how upwind and downwind bearings share, beside the thesis."""
    low, high = PRINTED
    reached = max(ratios) >= low
    page.answer(
        "How do the upwind and downwind bearings of a planet share its load over a turn?",
        "Averaged over a turn, a planet's upwind bearing carries at most "
        f"{value_text(max(ratios))} times its downwind one's load: the thesis's {low:g} to "
        f"{high:g} {'is' if reached else 'is not'} reached.",
        [
            page.value(
                "upwind over downwind load, rigid carrier",
                ratios[0],
                beside=low,
                by="thesis, least",
            ),
            page.value(
                "upwind over downwind load, elastic carrier of beams (5 MW)",
                ratios[2],
                beside=low,
                by="thesis, least",
            ),
            page.value("largest upwind load, torque and gravity [kN]", rows[0]["largest [kN]"]),
            page.value(
                "largest upwind load, with a tilt moment, too [kN]", rows[2]["largest [kN]"]
            ),
            page.value("variation in a turn by torque alone, over the mean [%]", 100 * uneven),
            page.judged("sum of the tangential loads of the planets' bearings", by="statics"),
        ],
        RATIOS,
        [
            "Possible causes of the thesis's ratios are tested one by one in the case "
            "dynamics/upwind_bearing."
        ],
        claim="holds" if reached else "does not hold",
    )
    page.say(
        "Loads of the planet bearings vary once a turn, shifted by a third from planet to planet: "
        "by gravity, by moments of the hub, and, with torque alone, since the gears of the next "
        "stage push the sun's shaft to one side.",
    )


def own(run: Run, page: Page, chosen: ChosenDrivetrain, count: int) -> None:
    """Loads of the planets' bearings of a user's drivetrain over a turn of its first carrier."""
    machine, torque = machine_of(chosen.drivetrain), chosen.rated_torque()
    chosen.state(page)
    _, pins = first_stage(machine)
    moment = -torque
    if "moment" in run.settings:
        moment = -1e3 * run.positive("moment")
    else:
        page.assume("moment about y at the hub", moment / 1e3, "kN m", "as large as the torque")
    cases = {TURNS[0]: 0.0, TURNS[1]: moment}
    angles = azimuths(count)
    with run.step("turns"):
        found = {name: turned(machine, angles, torque, m) for name, m in cases.items()}
        still = turned(machine, angles, torque, 0.0, gravity=False)
        alone = turned(machine, angles, 0.0, 0.0)
    check(page, machine, found[TURNS[0]], still, alone, torque)
    rows = [row for name, one in found.items() for row in rows_of(name, machine, one)]
    show(page, found, angles, rows, pins)
    most = max(rows, key=lambda row: float(str(row["largest [kN]"])))
    page.answer(
        "How do the bearings of a planet share its load over a turn of the carrier?",
        f"With {most['load case']} the {most['bearing']} bearing carries up to "
        f"{value_text(float(str(most['largest [kN]'])), 'kN')}, "
        f"{value_text(float(str(most['mean [kN]'])), 'kN')} on average.",
        [
            *(
                page.value(
                    f"largest {row['bearing']} load, {row['load case']} [kN]", row["largest [kN]"]
                )
                for row in rows[:4]
            ),
            page.judged("sum of the tangential loads of the planets' bearings", by="statics"),
        ],
        TURNING.format(most["load case"]),
        ["Carrier and housing are rigid, and bearings are without clearance."],
    )
    page.assume_all(machine.assumptions())
    for text in machine.assumed:
        page.assume(text.partition(":")[0][:60], "", "", text)


def show_ratios(page: Page, ratios: dict[str, float]) -> None:
    """Show how upwind and downwind bearings share, by load case, beside what the thesis prints."""
    page.section("Upwind over downwind")
    drawn = bars(RATIOS, {"computed": ratios}, "upwind over downwind")
    drawn.figure["layout"]["xaxis"]["range"] = [0.0, 1.1 * max(*ratios.values(), *PRINTED)]
    low, high = PRINTED
    page.add(mark_events(drawn, {f"thesis: {low:g} to {high:g}": low, "": high}))


def turned(
    machine: Machine, angles: Floats, torque: float, moment: float, gravity: bool = True
) -> Turn:
    """Statics at each azimuth under a torque and a moment about y of the hub [N m]."""

    def at(azimuth: float) -> System:
        return machine_system(machine, Level.RIGID, azimuth, held_generator=True)

    def loads(system: System) -> Floats:
        hub = np.array([0.0, 0.0, 0.0, 0.0, moment, 0.0])
        if gravity:
            return steady_load(machine, system, torque, hub)
        return system.load_on("rotor", hub + torque * np.eye(6)[3])

    return over_a_turn(at, loads, angles)


def show(
    page: Page, found: dict[str, Turn], angles: Floats, rows: list[Record], pins: Sequence[str]
) -> None:
    """Show the loads over a turn, for each moment of the hub."""
    page.section("Over a turn")
    for name, one in found.items():
        page.chart(
            TURNING.format(name),
            [
                trace(side, np.degrees(angles), one.resultant(f"stage 1 pin 1 {side}") / 1e3)
                for side in pins
            ],
            "azimuth of the carrier [deg]",
            "radial load [kN]",
        )
    page.table("Loads of the planets' bearings", rows)
    page.data("loads", rows)


def rows_of(name: str, machine: Machine, one: Turn) -> list[Record]:
    """Mean, largest and orders of the bearings on the pins, from the rotor on."""
    stage, pins = first_stage(machine)
    rows: list[Record] = []
    for side in pins:
        places = range(1, stage.planets + 1)
        loads = np.array([one.resultant(f"stage 1 pin {k} {side}") for k in places])
        orders = one.amplitudes(loads[0])
        rows.append(
            {
                "load case": name,
                "bearing": side,
                "mean [kN]": float(loads[0].mean()) / 1e3,
                "largest [kN]": float(loads.max()) / 1e3,
                "1P [kN]": float(orders[1]) / 1e3,
                "2P [kN]": float(orders[2]) / 1e3,
                "3P [kN]": float(orders[3]) / 1e3,
                "largest sharing of the planets": max(load_sharing(p) for p in loads.T),
            }
        )
    return rows


def five_megawatt(machine: Machine, count: int) -> list[Record]:
    """The 5 MW gearbox at rated torque, with a carrier of beams and with a rigid one."""
    component = library_component("planet_carrier")
    assert isinstance(component, CarrierComponent)
    body = carrier_frame(component)
    rows = []
    for name, flexible in (("carrier of beams", Flexible({1: body})), ("rigid carrier", None)):

        def at(azimuth: float, flexible: Flexible | None = flexible) -> System:
            return machine_system(
                machine, Level.RIGID, azimuth, held_generator=True, flexible=flexible
            )

        def loads(system: System) -> Floats:
            return steady_load(machine, system, 3.946e6, np.zeros(6))

        rows += rows_of(f"nrel_5mw, {name}", machine, over_a_turn(at, loads, azimuths(count)))
    return rows


def check(
    page: Page, machine: Machine, loaded: Turn, still: Turn, alone: Turn, torque: float
) -> None:
    """Balance and symmetry."""
    stage, pins = first_stage(machine)
    planets, count = stage.planets, len(loaded.azimuths)
    tangential = sum(
        still.of(f"stage 1 pin {k} {s} uz") for k in range(1, planets + 1) for s in pins
    )
    page.equals(
        "sum of the tangential loads of the planets' bearings [kN]",
        float(np.abs(tangential).mean()) / 1e3,
        torque / stage.centre_distance / 1e3,
        within=1e-6,
        why="solver; the bearings of the carrier carry no torque",
        source="statics: the torque over the radius of the pins",
    )
    if planets > 1 and count % planets == 0:
        one, two = (loaded.resultant(f"stage 1 pin {k} {pins[0]}") for k in (1, 2))
        share = {3: "a third of a turn"}.get(planets, f"a turn over {planets}")
        page.vanishes(
            f"planet 2 has planet 1's load {share} earlier: relative difference",
            float(np.abs(np.roll(one, -count // planets) - two).max() / one.max()),
            within=1e-7,
            why="round-off; planets are equal",
            source="symmetry",
        )
    if isotropic(stage, machine):
        check_gravity(page, alone, pins)


def check_gravity(page: Page, alone: Turn, pins: list[str]) -> None:
    """Gravity alone swings once a turn."""
    orders = alone.amplitudes(alone.of(f"stage 1 pin 1 {pins[0]} uz"))
    page.vanishes(
        "gravity alone: all orders but 1P over 1P, tangential load of one bearing",
        float(np.delete(orders, 1).max() / orders[1]),
        within=1e-9,
        why="round-off; linear bearings as stiff in all directions see gravity once a turn",
        source="statics",
    )


def not_round(still: Turn) -> float:
    """Spread of the upwind bearings over planets and azimuths, torque alone, over their mean."""
    loads = np.array([still.resultant(f"stage 1 pin {k} upwind") for k in (1, 2, 3)])
    return float(np.ptp(loads) / loads.mean())
