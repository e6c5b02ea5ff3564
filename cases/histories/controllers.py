"""What a controller's tuning does to the loads on a main bearing."""

import math
from collections.abc import Sequence

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.histories.operating_loads import FIXED, ROLLERS, bearing_loads
from fe_drivetrain.cases.references.thesis_beam import ASSUMED
from fe_drivetrain.common import Floats
from fe_drivetrain.common.typeset import MINUS
from fe_drivetrain.comparison import ConvergenceInTime, InTime, converge_in_time
from fe_drivetrain.report import density_chart
from fe_drivetrain.report.answer import Claim, KeyFigure
from fe_drivetrain.report.suite import Page, Record, Run, check_in_time
from fe_drivetrain.turbine_loads.hub_loads import (
    LONGEST_STEP,
    RIGID,
    Condition,
    Controller,
    EnergyAccount,
    Physics,
    Rotor,
    Tuning,
    Turbine,
    TurbineHistory,
    accounted_history,
    designed_controller,
    even_inflow,
    similar_turbine,
    simulate,
    speed_poles,
    steady_operation,
    turbine_histories,
)

WINDS = (12.0, 14.0, 18.0, 24.0)
TUNINGS = {
    "slow": Tuning(frequency=0.3),
    "tuned": Tuning(),
}
PITCH, SPEED = 0, 5
FOCUS = "moment within 45 deg of left [% of time]"
SETTLED = 0.02
"""What a step may leave uncertain of a quantity, over it: controller and wake act once in it."""
OF_HARMONICS = 0.05
"""What the upper half of the wind's harmonics may change of it: another seed changes as much."""


@case(
    "A controller's tuning and the loads on a main bearing",
    source="Stirling 2023, appendix A; Jonkman, Butterfield, Musial and Scott 2009, "
    "NREL/TP-500-38060, section 7",
)
def run(run: Run, page: Page) -> None:
    """The same winds with two tunings of one controller."""
    page.assume_all(row for row in ASSUMED if row[0] != "hub loads")
    turbine = similar_turbine(Rotor())
    controllers = {name: designed_controller(turbine, t) for name, t in TUNINGS.items()}
    with run.step("steady states and decay"):
        check_controllers(page, turbine, controllers)
    seeds = range(1, 2 if run.quick else 7)
    winds = WINDS[1:2] if run.quick else WINDS
    length = 30.0 if run.quick else 600.0
    grid = [Condition(v, "medium", 0.2, seed) for v in winds for seed in seeds]
    found: dict[str, dict[str, list[Record]]] = {ROLLERS: {}, FIXED: {}}
    shown: dict[str, Floats] = {}
    for name, controller in controllers.items():
        with run.step(f"histories, {name}"):
            for rows in found.values():
                rows[name] = []
            for made in turbine_histories(grid, turbine, controller, duration=length):
                for model, rows in found.items():
                    loads = bearing_loads(made.history.loads, model)
                    rows[name].append(measures(made, loads))
                    shown.setdefault(f"{name} controller, {model}", loads)
    compare(page, found)
    with run.step("energy and step"):
        check_step(page, turbine, controllers["tuned"], length)
    page.section(f"Where moments point at {winds[0]:g} m/s")
    for name, loads in shown.items():
        caption = f"Moment on the bearing, {name}, looking downwind; right is overhang"
        page.add(density_chart(caption, -loads[:, 3], loads[:, 4], "kN m"))
    page.data(
        "histories",
        [
            {"bearing": model, "controller": name, **row}
            for model, of in found.items()
            for name, rows in of.items()
            for row in rows
        ],
    )


def check_step(page: Page, turbine: Turbine, controller: Controller, length: float) -> None:
    """Energy of one history, and its quantities with the ordinary step, half and twice of it."""
    accounts: list[EnergyAccount] = []
    finest = 0.5 * LONGEST_STEP

    def run(step: float, harmonics: int) -> InTime:
        made, account = accounted_history(
            Condition(14.0, "medium", 0.2, 1),
            turbine,
            controller,
            None,
            length,
            longest_step=step,
            harmonics=harmonics or None,
        )
        accounts.append(account)
        of = measures(made, bearing_loads(made.history.loads, ROLLERS))
        values = {key: float(of[key]) for key in list(of)[2:]}  # type: ignore[arg-type]
        return InTime(values, account.relative_imbalance)

    found = converge_in_time(run, finest)
    page.section("Energy and step")
    check_in_time(
        page,
        "history at 14 m/s",
        found,
        dict.fromkeys(found.finest.values, SETTLED),
        energy=1e-4,
        why="a ten-thousandth of the largest swing of one energy is half of that of speeds and "
        "deflections; Runge and Kutta's method of order 4",
        scale={FOCUS: 100.0},
    )
    show_account(page, accounts[-1])
    check_ordinary(page, found)
    count = turbine.rotor.harmonics // 2
    check_harmonics(page, count, run(finest, count), found.finest)


def check_ordinary(page: Page, found: ConvergenceInTime) -> None:
    """What the step that histories have leaves uncertain, and the order of its energy's error."""
    ordinary = found.by_step[1]
    left = {
        key: abs(ordinary.values[key] - found.value(key)) + found.step_band(key)
        for key in ordinary.values
    }
    worst, share = worst_of(left, found.finest)
    page.at_most(
        "history at 14 m/s, step of all histories: left uncertain of the worst quantity, over it",
        share,
        SETTLED,
        why="the answer would be one of the step, not of the turbine",
        source=f"half the step, and its band: {worst}",
        measure="identity",
    )
    page.at_least(
        "history at 14 m/s: order with which the error of the energy falls",
        math.log2(ordinary.energy_error / found.energy_error),
        2.0,
        why="4 or more in smooth wind, 2 at the edge of the tower's shadow, where wind jumps",
        source="Runge and Kutta's method: this step, and half of it",
        measure="identity",
    )


def check_harmonics(page: Page, count: int, fewer: InTime, all_of_them: InTime) -> None:
    """What half of the wind's harmonics of azimuth change."""
    change = {key: abs(fewer.values[key] - all_of_them.values[key]) for key in fewer.values}
    worst, share = worst_of(change, all_of_them)
    page.at_most(
        "history at 14 m/s: change of the worst quantity by half the wind's harmonics, over it",
        share,
        OF_HARMONICS,
        why="another seed changes each of them by as much in ten minutes",
        source=f"the same wind with its first {count} harmonics of azimuth alone: {worst}",
        measure="identity",
    )
    page.table(
        "The wind's harmonics of azimuth",
        [
            {"quantity": key, "all": all_of_them.values[key], f"the first {count}": value}
            for key, value in fewer.values.items()
        ],
    )


def worst_of(errors: dict[str, float], of: InTime) -> tuple[str, float]:
    """The quantity whose error is largest over it, and how large; a share of time is over all."""
    shares = {
        key: error / (100.0 if key == FOCUS else abs(of.values[key]))
        for key, error in errors.items()
    }
    worst = max(shares, key=lambda key: shares[key])
    return worst, shares[worst]


def show_account(page: Page, account: EnergyAccount) -> None:
    """Swings of energies, works, and what is missing in the equations."""
    greatest = account.greatest()
    rows: list[Record] = [
        {"energy or work": name, "largest change [kJ]": 1e-3 * value}
        for name, value in greatest.items()
    ]
    page.table("Where the energy of a history is, and what changes it, 14 m/s", rows)
    page.data("account", rows)
    left_out = max(value for name, value in greatest.items() if "left out" in name)
    page.text(
        f"Terms of second order that the equations leave out would do up to {1e-3 * left_out:.2g} "
        f"kJ of work, {100.0 * left_out / account.swing:.2g} % of the largest swing of an energy. "
        "It has rows of its own, so that the error of the energy is that of the integration alone."
    )


def measures(made: TurbineHistory, loads: Floats) -> Record:
    """Measures of one history; loads on the bearing (n, 5), Fx, Fy, Fz, My, Mz [kN, kN m]."""
    force, moment = np.hypot(*loads[:, 1:3].T), np.hypot(*loads[:, 3:].T)
    # looking downwind, y is to the left: overturning, which is along +y, points left
    return {
        "wind [m/s]": made.history.attributes["wind_speed"],
        "seed": made.history.attributes["seed"],
        "rotor speed, standard deviation [%]": 100.0
        * float(made.rotor_speed.std() / made.rotor_speed.mean()),
        "pitch travel [deg/s]": float(np.degrees(np.abs(np.gradient(made.pitch)).mean()))
        / made.history.step,
        "thrust, standard deviation [kN]": float(loads[:, 0].std()),
        "radial force, standard deviation [kN]": float(force.std()),
        "moment, standard deviation [kN m]": float(moment.std()),
        "moment, mean component to the left [kN m]": float(loads[:, 3].mean()),
        FOCUS: 100.0 * float((loads[:, 3] > np.abs(loads[:, 4])).mean()),
    }


def compare(page: Page, found: dict[str, dict[str, list[Record]]]) -> None:
    """Means by wind, differences of the same winds, and the thesis's statements."""
    page.section("The same winds, two tunings")
    rows = [{"bearing": model, **row} for model, of in found.items() for row in means_by_wind(of)]
    page.table("Means over seeds", rows)
    page.data("means", rows)
    changes = {model: changes_by_tuning(of) for model, of in found.items()}
    listed = [{"bearing": model, **row} for model, of in changes.items() for row in of]
    page.table("Differences of histories of one wind and seed", listed)
    page.data("changes", listed)
    by_name = {model: {str(row["quantity"]): row for row in of} for model, of in changes.items()}
    said, fixed = (statements(by_name[model]) for model in (ROLLERS, FIXED))
    page.table(
        "Statements of appendix A, and ours for tuned against slow",
        [[*one, *other[1:]] for one, other in zip(said, fixed, strict=True)],
        [
            "thesis",
            "slow, and what tuning adds",
            "agrees",
            f"slow, and what tuning adds, {FIXED}",
            f"agrees, {FIXED}",
        ],
    )
    agreed = [agrees for *_, agrees in said]
    answer(page, by_name[ROLLERS], agreed, len(found[ROLLERS]["slow"]))
    page.say(
        "The bearing's moment comes from differences of wind over the disc, which collective "
        "pitch cannot take away: tuning acts on speed, torque and thrust."
    )
    page.text(
        "Not reproducible: the thesis prints neither of its controllers and no number, its turbine "
        "is private, and the wind files of its chapter 4 and appendix A share their statistics but "
        "not their wind. What remains is the direction of its statements under a change of tuning "
        "alone, in the same wind. A controller that turned each blade by itself, or one that held "
        "another mean pitch, would do more; the thesis says neither."
    )


CHANGES = "What tuning changes, in percent of the slow controller; bars are two standard errors"


def answer(page: Page, changes: dict[str, Record], agreed: Sequence[str], histories: int) -> None:
    """State what tuning does to speed and moment, and how many statements of the thesis hold."""
    figures = [beside_slow(page, row) for row in changes.values()]
    page.errors(CHANGES, figures)
    shown = {figure.name: figure for figure in figures}
    speed, moment = shown["spread of rotor speed"], shown["spread of moment"]
    clear, refuted = agreed.count("yes"), agreed.count("no")
    claim: Claim = "holds in part" if clear else "does not hold" if refuted else ""
    agreement = f"{clear} of the thesis's {len(agreed)} statements hold beyond scatter"
    if not clear:
        agreement = f"the thesis's {len(agreed)} statements are not confirmed beyond scatter"
    page.answer(
        "Does a controller tuned twice as fast relieve the main bearing, as the thesis says?",
        f"Faster tuning changes the spread of rotor speed by {percent(speed)}, of the bearing "
        f"moment by {percent(moment)}; {agreement}.",
        [speed, moment, *(f for f in figures if f not in (speed, moment))][:6],
        hero=CHANGES,
        cautions=[
            f"{histories} {'histories' if histories > 1 else 'history'} of each controller: a "
            "change within two standard errors may come from the random wind alone.",
            "The thesis prints neither its controllers nor a number, so that only the direction of "
            "changes can be compared. Spread is the standard deviation.",
        ],
        claim="holds" if clear == len(agreed) else claim,
    )


def beside_slow(page: Page, row: Record) -> KeyFigure:
    """A quantity of the tuned controller beside that of the slow one."""
    slow, change, error = (
        float(row[key]) for key in ("slow, mean", "tuned less slow", "its standard error")
    )
    band = 2.0 * error if math.isfinite(error) else None
    name = str(row["quantity"])
    if ", standard deviation" in name:
        name = f"spread of {name.replace(', standard deviation', '')}"
    return page.value(name, slow + change, band, beside=slow, by="slow controller")


def percent(figure: KeyFigure) -> str:
    """A change from the slow controller, with its sign."""
    change = 100.0 * (figure.value / (figure.limit or math.nan) - 1.0)
    return f"{change:+.2g}\u00a0%".replace("-", MINUS)


def quantities_of(found: dict[str, list[Record]]) -> list[str]:
    """Names of what each history was measured by."""
    return [name for name in found["slow"][0] if name not in ("wind [m/s]", "seed")]


def means_by_wind(found: dict[str, list[Record]]) -> list[Record]:
    """Each quantity by wind speed and controller, means over seeds."""
    rows: list[Record] = []
    for wind in dict.fromkeys(row["wind [m/s]"] for row in found["slow"]):
        for label, of in found.items():
            own = [row for row in of if row["wind [m/s]"] == wind]
            rows.append(
                {"wind [m/s]": wind, "controller": label}
                | {name: mean([row[name] for row in own]) for name in quantities_of(found)}
            )
    return rows


def changes_by_tuning(found: dict[str, list[Record]]) -> list[Record]:
    """What tuning changes of each quantity, over histories of one wind and seed."""
    slow, tuned = found["slow"], found["tuned"]
    rows: list[Record] = []
    for name in quantities_of(found):
        pairs = zip(slow, tuned, strict=True)
        change = np.array([float(t[name]) - float(s[name]) for s, t in pairs])  # type: ignore[arg-type]
        error = change.std(ddof=1) / np.sqrt(len(change)) if len(change) > 1 else np.nan
        rows.append(
            {
                "quantity": name,
                "slow, mean": mean([s[name] for s in slow]),
                "tuned less slow": float(change.mean()),
                "its standard error": float(error),
                "histories in which it falls": f"{int((change < 0).sum())} of {len(change)}",
            }
        )
    return rows


def statements(by_name: dict[str, Record]) -> list[list[str]]:
    """Sentences of appendix A, what stands here, and whether it agrees."""
    kinds = (
        (
            "variation of the radial force is slightly reduced",
            "radial force, standard deviation [kN]",
            True,
        ),
        (
            "variation of the moment is slightly reduced",
            "moment, standard deviation [kN m]",
            True,
        ),
        (
            "the moment shifts to the left (overturning)",
            "moment, mean component to the left [kN m]",
            False,
        ),
        ("it is more focused about 180 deg", FOCUS, False),
    )
    rows = []
    for words, name, falls in kinds:
        row = by_name[name]
        change, error = float(row["tuned less slow"]), float(row["its standard error"])
        agrees = "yes" if (change < 0.0) == falls else "no"
        clear = "" if abs(change) > 2.0 * error else ", within what seeds scatter"
        unit = name[name.index("[") + 1 : -1]
        shown = f"{float(row['slow, mean']):.3g} {unit}, {change:+.2g} {unit}"
        rows.append([words, shown, agrees + clear])
    return rows


def mean(values: Sequence[object]) -> float:
    """Mean of each number over records."""
    return float(np.mean([float(v) for v in values]))  # type: ignore[arg-type]


def check_controllers(page: Page, turbine: Turbine, controllers: dict[str, Controller]) -> None:
    """Steady states against momentum theory, decay against the poles of the linear equation."""
    rows: list[Record] = []
    for name, controller in controllers.items():
        point = steady_operation(turbine, controller, 14.0)
        one, other = speed_poles(turbine, controller, point)
        rows.append(
            {
                "controller": name,
                "gain of the error at zero pitch [s]": controller.proportional,
                "of its integral [-]": controller.integral,
                "pitch that doubles the answer [deg]": np.degrees(controller.doubling),
                "poles at 14 m/s [1/s]": f"{one:.3f}, {other:.3f}",
            }
        )
        fast = designed_controller(turbine, Tuning(**{**vars(TUNINGS[name]), "filter": 1e3}))
        count, step = 1500, 0.01
        time = step * np.arange(count)
        begin = 1e-4 * point.rotor_speed
        level = similar_turbine(Rotor(shaft_tilt=0.0))
        at = steady_operation(level, fast, 14.0)
        one, other = speed_poles(level, fast, at)
        linear = ((one * np.exp(one * time) - other * np.exp(other * time)) / (one - other)).real
        _, beside = simulate(
            level,
            fast,
            even_inflow(level, 14.0, np.zeros(count), 1.0 / step),
            Physics(**{**vars(RIGID), "wake": "frozen"}),
            start=(at.rotor_speed + begin, at.pitch),
        )
        page.vanishes(
            f"{name}: decay of a speed error at 14 m/s less that of the linear equation's poles",
            float(np.abs((beside[:, SPEED] - at.rotor_speed) / begin - linear).max()),
            within=0.01,
            why="the controller acts every 0.01 s; over the error at the beginning",
            source="Jonkman 2009, section 7.2, with the slopes of both torques by speed",
        )
        _, beside = simulate(
            level,
            controller,
            even_inflow(level, 14.0, np.zeros(1500), 10.0),
            RIGID,
            start=(0.97 * at.rotor_speed, at.pitch),
        )
        page.equals(
            f"{name}: pitch at 14 m/s after a disturbance",
            float(np.degrees(beside[-1, PITCH])),
            float(np.degrees(at.pitch)),
            within=1e-5,
            why="the simulation and momentum theory have the same steady state",
            source="blade element momentum theory by bisection",
            unit="deg",
            measure="identity",
        )
    page.section("Controllers")
    page.table("Two tunings, of 0.3 and 0.6 rad/s at 0.7 of critical damping", rows)
