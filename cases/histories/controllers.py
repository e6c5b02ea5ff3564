"""What a controller's tuning does to the loads on a main bearing."""

from collections.abc import Sequence

import numpy as np

from fe_drivetrain.beam import MainBearingBeam, torsional_spring_model
from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats
from fe_drivetrain.hub_loads import (
    RIGID,
    Condition,
    Controller,
    Physics,
    Rotor,
    Tuning,
    Turbine,
    TurbineHistory,
    designed_controller,
    even_inflow,
    similar_turbine,
    simulate,
    speed_poles,
    steady_operation,
    turbine_histories,
)
from fe_drivetrain.report import density_chart
from fe_drivetrain.suite import Page, Record, Run

WINDS = (12.0, 14.0, 18.0, 24.0)
TUNINGS = {
    "slow": Tuning(frequency=0.3),
    "tuned": Tuning(),
}
PITCH, SPEED = 0, 5


@case(
    "A controller's tuning and the loads on a main bearing",
    source="Stirling 2023, appendix A; Jonkman, Butterfield, Musial and Scott 2009, "
    "NREL/TP-500-38060, section 7",
)
def run(run: Run, page: Page) -> None:
    """The same winds with two tunings of one controller."""
    turbine = similar_turbine(Rotor())
    controllers = {name: designed_controller(turbine, t) for name, t in TUNINGS.items()}
    with run.step("steady states and decay"):
        check_controllers(page, turbine, controllers)
    seeds = range(1, 2 if run.quick else 7)
    winds = WINDS[1:2] if run.quick else WINDS
    length = 30.0 if run.quick else 600.0
    grid = [Condition(v, "medium", 0.2, seed) for v in winds for seed in seeds]
    found: dict[str, list[Record]] = {}
    shown: dict[str, Floats] = {}
    for name, controller in controllers.items():
        with run.step(f"histories, {name}"):
            rows = []
            for made in turbine_histories(grid, turbine, controller, duration=length):
                loads = 1e-3 * torsional_spring_model(made.history.loads[None], MainBearingBeam())
                rows.append(measures(made, loads[0]))
                if (made.history.attributes["wind_speed"], made.history.attributes["seed"]) == (
                    14.0,
                    1,
                ):
                    shown[name] = loads[0]
            found[name] = rows
    compare(page, found)
    page.section("Where moments point at 14 m/s")
    for name, loads in shown.items():
        caption = f"Moment on the bearing, {name} controller, looking downwind; right is overhang"
        page.add(density_chart(caption, -loads[:, 4], loads[:, 5], "kN m"))
    page.data("histories", [{"controller": n, **row} for n, rows in found.items() for row in rows])


def measures(made: TurbineHistory, loads: Floats) -> Record:
    """Measures of one history; loads on the bearing (n, 6) [kN, kN m]."""
    force, moment = np.hypot(*loads[:, 1:3].T), np.hypot(*loads[:, 4:6].T)
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
        "moment, mean component to the left [kN m]": float(loads[:, 4].mean()),
        "moment within 45 deg of left [% of time]": 100.0
        * float((loads[:, 4] > np.abs(loads[:, 5])).mean()),
    }


def compare(page: Page, found: dict[str, list[Record]]) -> None:
    """Means by wind, differences of the same winds, and the thesis's statements."""
    slow, tuned = found["slow"], found["tuned"]
    names = [name for name in slow[0] if name not in ("wind [m/s]", "seed")]
    rows: list[Record] = []
    for wind in dict.fromkeys(row["wind [m/s]"] for row in slow):
        for label, of in found.items():
            own = [row for row in of if row["wind [m/s]"] == wind]
            rows.append(
                {"wind [m/s]": wind, "controller": label}
                | {name: mean([row[name] for row in own]) for name in names}
            )
    page.section("The same winds, two tunings")
    page.table("Means over seeds", rows)
    page.data("means", rows)
    changes: list[Record] = []
    for name in names:
        pairs = zip(slow, tuned, strict=True)
        change = np.array([float(t[name]) - float(s[name]) for s, t in pairs])  # type: ignore[arg-type]
        error = change.std(ddof=1) / np.sqrt(len(change)) if len(change) > 1 else np.nan
        changes.append(
            {
                "quantity": name,
                "slow, mean": mean([s[name] for s in slow]),
                "tuned less slow": float(change.mean()),
                "its standard error": float(error),
                "histories in which it falls": f"{int((change < 0).sum())} of {len(change)}",
            }
        )
    page.table("Differences of histories of one wind and seed", changes)
    page.data("changes", changes)
    by_name = {row["quantity"]: row for row in changes}

    def statement(words: str, name: str, falls: bool) -> list[str]:
        row = by_name[name]
        change, error = float(row["tuned less slow"]), float(row["its standard error"])
        agrees = "yes" if (change < 0.0) == falls else "no"
        clear = "" if abs(change) > 2.0 * error else ", within what seeds scatter"
        unit = name[name.index("[") + 1 : -1]
        shown = f"{float(row['slow, mean']):.3g} {unit}, {change:+.2g} {unit}"
        return [words, shown, agrees + clear]

    said = [
        statement(
            "variation of the radial force is slightly reduced",
            "radial force, standard deviation [kN]",
            True,
        ),
        statement(
            "variation of the moment is slightly reduced", "moment, standard deviation [kN m]", True
        ),
        statement(
            "the moment shifts to the left (overturning)",
            "moment, mean component to the left [kN m]",
            False,
        ),
        statement(
            "it is more focused about 180 deg", "moment within 45 deg of left [% of time]", False
        ),
    ]
    page.table(
        "Statements of appendix A, and ours for tuned against slow",
        said,
        ["thesis", "slow, and what tuning adds", "agrees"],
    )
    speed = by_name[names[0]]
    page.answer(
        f"Twice as fast a controller lowers the rotor speed's standard deviation from "
        f"{float(speed['slow, mean']):.1f} % to "
        f"{float(speed['slow, mean']) + float(speed['tuned less slow']):.1f} %. On the bearing, "
        "appendix A says that " + "; ".join(f"{w}: here {c} ({a})" for w, c, a in said) + ".",
        "So here tuning acts on speed, torque and thrust, and the bearing's moment comes from "
        "differences of wind over the disc, which collective pitch cannot take away.",
    )
    page.text(
        "Not reproducible: the thesis prints neither of its controllers and no number, its turbine "
        "is private, and the wind files of its chapter 4 and appendix A share their statistics but "
        "not their wind. What remains is the direction of its statements under a change of tuning "
        "alone, in the same wind. A controller that turned each blade by itself, or one that held "
        "another mean pitch, would do more; the thesis says neither."
    )


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
