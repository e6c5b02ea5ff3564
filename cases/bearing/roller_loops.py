"""What rollers of a main bearing feel while the moment on it runs in a loop."""

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.bearing import (
    Bearing,
    RollerRow,
    approaches,
    by_row,
    equilibrium,
    lamina_loads,
    load_zones,
    pitch_ratio,
    turn,
)
from fe_drivetrain.bearing_life.coupled import coupled_equilibrium
from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.thesis_beam import (
    ASSUMED,
    BEAM,
    WIND_SPEEDS,
    beam_body,
    bearing_s,
    histories,
    housed_body,
    radial,
)
from fe_drivetrain.common import Floats
from fe_drivetrain.report import bars, density_chart, mark_events, rolling_elements, trace
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.shafts.beam import torsional_spring_model
from fe_drivetrain.turbine_loads.hub_loads import (
    Condition,
    Loops,
    Rotor,
    find_loops,
    hub_load_set,
    loop_statistics,
)

#: Length of an example [s], as in the thesis's figures 4.15 and 4.16.
WINDOW = 2.0

#: Rollers below this share of the window's peak are left out of edge loading in percent.
LOADED = 0.02

CONSTANT, ALONE, HOUSED = "constant K_R, 145 MN m/rad", "rollers", "rollers, housing in series"

OPPOSITE = "zones of the rows opposite [% of time]"
RANGE = "force, least to largest [kN]"
ZONES = "Share of steps in which the load zones of both rows are opposite, by wind file"
RANGES = "Range of the radial force at 24 m/s: varying rollers, a constant, both in a housing"

THESIS = {
    12.0: "500, 1000, < 100, 1500, 400 kN m; roller 220, > 450, 100, 380, < 50 kN, other row < 50",
    14.0: "200 to 600 kN m, turns by 540 deg; roller 110, 100, 130, 0 kN, other row 175 to > 270",
    18.0: "500, 750, < 250, 0, 500, 200 kN m; roller 175, 40, 0, 175 kN, other row up to 275",
    24.0: "> 1000, < 500, 1400, 0 kN m; roller 40, 0, 100 kN, other row 120 to 200",
}


@dataclass(frozen=True)
class Example:
    """A roller that moves with the cage through a loop of the moment: (n,) each, [kN, kN m].

    ``loads`` and ``ends`` are (n, 2): of the two rows, and what their end laminae differ by.
    """

    time: Floats
    moment: Floats
    loads: Floats
    ends: Floats
    roller: int
    at: Floats


@case(
    "Roller loads of a main bearing while its moment runs in loops",
    source="Stirling 2023, sections 4.5 and 4.6, figures 4.13 to 4.16",
)
def run(run: Run, page: Page) -> None:
    """Direction of force and moment, loops, and rollers in them, over four wind files."""
    page.assume_all(ASSUMED)
    page.assume(
        "places of rollers",
        "rolling",
        "",
        "with the cage, (1 - gamma) / 2 turns a turn of the rotor",
    )
    size = (30.0, 20.0) if run.quick else (600.0, 20.0)
    with run.step("hub loads"):
        factors = histories(*size)
        conditions = [Condition(v, "medium", 0.2, 1) for v in WIND_SPEEDS]
        hub = hub_load_set(conditions, *size)
    flat = factors.reshape(-1, factors.shape[-1])
    bearing, laminae = bearing_s(), bearing_s(laminae=30)
    loads = {CONSTANT: torsional_spring_model(hub.loads, BEAM)[..., [0, 1, 2, 4, 5]]}
    for name, body in ((ALONE, beam_body()), (HOUSED, housed_body())):
        with run.step(name):
            found = coupled_equilibrium(body, {"bearing": bearing}, flat)
            loads[name] = found.of("bearing").reshape(len(factors), -1, 5)
    ranges = directions(page, loads)
    loops = {
        name: [find_loops(hub.time, *(1e-3 * one[:, 3:].T)) for one in of]
        for name, of in loads.items()
    }
    loop_table(page, loops, float(hub.time[-1]))
    with run.step("rollers"):
        zones = zones_and_edges(page, laminae, loads[ALONE], every=1 if run.quick else 10)
        follow(page, laminae, hub.time, loads[ALONE], loops[ALONE])
    answer(page, ranges, zones)
    check(page, laminae, loads[ALONE][0])
    page.section("Other controller")
    page.text(
        "Appendix A of the thesis repeats figures 4.13 and 4.14 with a better tuned pitch "
        "controller, which varies less and moves the moment towards 180 deg. The loads of this "
        "case hold the pitch of the mean wind. `histories/controllers` has a turbine that moves, "
        "with two tunings of its controller, beside the appendix's statements. How far the "
        "rotor's mean moment moves the cloud is in the table of directions."
    )
    page.image("The rollers of bearing S", run.sketch(*rolling_elements(bearing)))


def directions(page: Page, loads: dict[str, Floats]) -> dict[str, float]:
    """Range of force [kN] at 24 m/s, and shape of the moment's cloud, as figures 4.13 and 4.14."""
    rows: list[Record] = []
    for name, files in loads.items():
        for speed, one in zip(WIND_SPEEDS, files, strict=True):
            force, moment = 1e-3 * radial(one[:, 1:3]), 1e-3 * radial(one[:, 3:])
            rows.append(
                {
                    "bearing": name,
                    "wind [m/s]": speed,
                    RANGE: float(np.ptp(force)),
                    "force, 1 to 99 % of the time [kN]": float(
                        np.ptp(np.quantile(force, (0.01, 0.99)))
                    ),
                    "moment, mean [kN m]": float(moment.mean()),
                    "largest [kN m]": float(moment.max()),
                    "height over width of its cloud": float(one[:, 4].std() / one[:, 3].std()),
                    "overturning [% of time]": 100.0 * float((one[:, 3] > 0.0).mean()),
                }
            )
    page.section("Where the loads point")
    page.table("Range of the radial force, and size and shape of the moment's cloud", rows)
    page.data("directions", rows)
    last = {row["bearing"]: row for row in rows if row["wind [m/s]"] == WIND_SPEEDS[-1]}
    ranges = {str(name): float(row[RANGE]) for name, row in last.items()}
    page.add(bars(RANGES, {"computed": ranges}, "range of the radial force [kN]"))
    page.text(
        "The thesis puts the smaller range of the force down to the varying stiffness. It is the "
        "mean stiffness: rollers alone are ten times as stiff as the 145 MN m/rad of the housing, "
        "so that the bearing takes more as a moment and less as a force. With the housing in "
        "series range and cloud are what they were. Clouds of a rigid housing are rounder, since "
        "rollers are equally stiff about both axes; those of chapter 3 have 392 against 145."
    )
    for speed, one in zip(WIND_SPEEDS, loads[ALONE], strict=True):
        if speed in (WIND_SPEEDS[0], WIND_SPEEDS[-1]):
            for word, part, unit in (("force", one[:, 1:3], "kN"), ("moment", one[:, 3:], "kN m")):
                caption = f"Radial {word} at {speed:g} m/s, rollers alone, looking downwind"
                page.add(density_chart(caption, -1e-3 * part[:, 0], 1e-3 * part[:, 1], unit))
    return ranges


def answer(page: Page, ranges: dict[str, float], zones: tuple[float, float]) -> None:
    """State how rollers follow the moment, and what makes the range of the force [kN] smaller."""
    opposite, follows = zones
    page.found("range of the radial force at 24 m/s, rollers alone [kN]", ranges[ALONE])
    # with the same varying rollers and the housing the range is that of a constant again
    of_mean = abs(ranges[HOUSED] - ranges[CONSTANT]) < abs(ranges[HOUSED] - ranges[ALONE])
    of_zones = opposite > 50.0
    cause = (
        "a rigid housing narrows the force range, not varying stiffness as the thesis says"
        if of_mean
        else "varying stiffness narrows the force range, as the thesis says"
    )
    verdict = f"Rows carry on opposite sides in at least {value_text(opposite, '%')} of steps; "
    verdict += f"{cause}."
    page.answer(
        "How are the rollers of a main bearing loaded while its moment varies in loops?",
        verdict,
        [
            page.value(
                "steps with load zones of the rows opposite, lowest of four wind files [%]",
                opposite,
                at_least=50.0,
                by="thesis: most of the time",
            ),
            page.value("correlation of the peak roller load with the moment, lowest", follows),
            page.judged(
                "range of the radial force at 24 m/s, rollers alone",
                "force range at 24 m/s, rigid housing",
            ),
            page.value("force range at 24 m/s, flexible housing [kN]", ranges[HOUSED]),
            page.value("force range at 24 m/s, constant 145 MN m/rad [kN]", ranges[CONSTANT]),
        ],
        ZONES,
        [
            "In a rigid housing the force range is smaller because the rollers are ten times as "
            "stiff as the housing, not because their stiffness varies; the thesis prints less than "
            "200 kN, against 800 kN."
        ],
        claim="holds" if of_zones and not of_mean else "holds in part",
    )


def loop_table(page: Page, loops: dict[str, list[Loops]], duration: float) -> None:
    """Loops of the moment, by bearing and wind file."""
    rows: list[Record] = []
    for name, of in loops.items():
        for speed, one in zip(WIND_SPEEDS, of, strict=True):
            passing = 3.0 * Rotor().rotor_speed(speed) / (2.0 * np.pi)
            numbers = loop_statistics(one, duration, passing)
            rows.append(
                {
                    "bearing": name,
                    "wind [m/s]": speed,
                    "share of time [%]": 100.0 * numbers["share of time"],
                    "rate over 3P": numbers["rate over 3P"],
                    "median duration [s]": numbers["median duration [s]"],
                    "median swept angle [deg]": numbers["median swept angle [deg]"],
                    "largest range [kN m]": numbers["largest magnitude range"],
                }
            )
    page.section("Loops of the moment")
    page.table(
        "Loops of more than a tenth of the mean moment; main_bearing/load_loops defines", rows
    )
    page.data("loops", rows)


def opposite(bearing: Bearing, displacements: Floats) -> float:
    """Share of steps in which the load zones of both rows point apart [%]."""
    upwind, downwind = load_zones(bearing, displacements)
    apart = np.abs((upwind.centre_deg - downwind.centre_deg + 180.0) % 360.0 - 180.0)
    return 100.0 * float(np.mean(apart[np.isfinite(apart)] > 90.0))


def end_difference(row: RollerRow, displacements: Floats) -> tuple[Floats, Floats]:
    """Load of each roller, and what its end laminae differ by: (n, rollers) [N]."""
    q = lamina_loads(row, displacements)
    return q.sum(axis=2), np.abs(q[..., -1] - q[..., 0])


def zones_and_edges(page: Page, bearing: Bearing, loads: Floats, every: int) -> tuple[float, float]:
    """Load zones of whole wind files, peak rollers with the moment, and edge loading.

    Returns the least share of time with opposite zones [%] and the least correlation.
    """
    rows: list[Record] = []
    for speed, one in zip(WIND_SPEEDS, loads, strict=True):
        some = one[::every]
        found = equilibrium(bearing, some)
        peaks = np.column_stack([part.max(axis=1) for part in by_row(bearing, found.rollers)])
        moment = radial(some[:, 3:])
        shares: list[Floats] = []
        for row in bearing.rows:
            assert isinstance(row, RollerRow)
            Q, ends = end_difference(row, found.displacements)
            carried = LOADED * Q.max() < Q
            shares.append(100.0 * ends[carried] / Q[carried])
        share = np.concatenate(shares)
        rows.append(
            {
                "wind [m/s]": speed,
                OPPOSITE: opposite(bearing, found.displacements),
                "peak roller with |M|, correlation": float(
                    np.corrcoef(moment, peaks.max(axis=1))[0, 1]
                ),
                "upwind row, largest [kN]": 1e-3 * float(peaks[:, 0].max()),
                "downwind row, largest [kN]": 1e-3 * float(peaks[:, 1].max()),
                "upwind above downwind [% of time]": 100.0
                * float((peaks[:, 0] > peaks[:, 1]).mean()),
                "end difference over load, median [%]": float(np.median(share)),
                "99 % of rollers below [%]": float(np.quantile(share, 0.99)),
            }
        )
    page.section("Load zones and edge loading")
    page.table(
        "Rollers over each wind file; the end difference is that of two laminae of thirty, of "
        "rollers with more than a fiftieth of the largest load",
        rows,
    )
    page.text(
        "The thesis reads one row to 2 or 3 % and the other to 20 %; both are here, the "
        "larger share at rollers that are hardly loaded. An even load is 3.3 % on each lamina."
    )
    page.data("rollers", rows)
    of_wind = {f"{row['wind [m/s]']:g} m/s": float(row[OPPOSITE]) for row in rows}
    drawn = bars(ZONES, {"computed": of_wind}, "share of steps [%]")
    drawn.figure["layout"]["xaxis"]["range"] = [0.0, 100.0]
    page.add(mark_events(drawn, {"most of the time: 50 %": 50.0}))
    least = min(row[OPPOSITE] for row in rows)
    page.holds(
        "load zones of the two rows are on opposite sides in more than half of the steps",
        least > 50.0,
        why="moments drive the rollers more than forces do",
        source="Stirling 2023, section 4.6: three of four examples",
    )
    return least, min(r["peak roller with |M|, correlation"] for r in rows)


def follow(page: Page, bearing: Bearing, time: Floats, loads: Floats, loops: list[Loops]) -> None:
    """The loop of each wind file that changes most, and the roller that feels it most."""
    rows: list[Record] = []
    page.section("Rollers in a loop")
    for speed, one, of in zip(WIND_SPEEDS, loads, loops, strict=True):
        i = int(np.argmax(of.highest - of.lowest))
        middle = 0.5 * (of.start[i] + of.end[i])
        begin = min(max(middle - 0.5 * WINDOW, time[0]), time[-1] - WINDOW)
        shown = (time >= begin) & (time <= begin + WINDOW)
        example = in_window(bearing, time[shown], one[shown], Rotor().rotor_speed(speed))
        row, other = np.argsort(-np.ptp(example.loads, axis=0))
        share = example.ends / np.maximum(example.loads, LOADED * example.loads.max())
        rows.append(
            {
                "wind [m/s]": speed,
                "thesis": THESIS[speed],
                "ours: moment [kN m]": f"{of.lowest[i]:.0f} to {of.highest[i]:.0f}",
                "turns by [deg]": float(np.degrees(of.swept[i])),
                "in [s]": float(of.duration[i]),
                "roller [kN]": _span(example.loads[:, row]),
                "same place, other row [kN]": _span(example.loads[:, other]),
                "end difference, largest [kN]": float(example.ends.max()),
                "over load [%]": 100.0 * float(share.max()),
            }
        )
        draw(page, speed, example)
    page.table(
        "The moment's loop of largest range in each wind file, and the roller that changes most in "
        f"the {WINDOW:g} s about it",
        rows,
    )
    page.data("examples", rows)
    page.text(
        "What the thesis describes is there: loads of rollers follow the size of the moment, the "
        "row at the other end of the diameter is loaded when this one is not, and the ends of a "
        "roller differ whenever it is loaded. That the difference falls to zero in both rows "
        "together has a simple reason: it is the tilt of the inner ring about the tangent at that "
        "place, which both rows share. Its size goes as one over the number of laminae."
    )


def _span(values: Floats) -> str:
    """Least and largest."""
    return f"{values.min():.0f} to {values.max():.0f}"


def in_window(bearing: Bearing, time: Floats, loads: Floats, rotor_speed: float) -> Example:
    """The roller whose load changes most, moving with the cage."""
    turned = -0.5 * (1.0 - pitch_ratio(bearing.rows[0])) * rotor_speed * (time - time[0])
    found = equilibrium(bearing, loads, phases=turned)
    # seen by the cage the rollers stand still
    u = turn(found.displacements, -turned)
    parts = [end_difference(row, u) for row in bearing.rows if isinstance(row, RollerRow)]
    Q, ends = (1e-3 * np.stack(columns, axis=-1) for columns in zip(*parts, strict=True))
    roller = int(np.argmax(np.ptp(Q, axis=0).max(axis=1)))
    at = np.degrees(2.0 * np.pi * roller / Q.shape[1] + turned) % 360.0
    return Example(time, 1e-3 * loads[:, 3:], Q[:, roller], ends[:, roller], roller + 1, at)


def draw(page: Page, speed: float, example: Example) -> None:
    """Draw what figures 4.15 and 4.16 show."""
    right, up = -example.moment[:, 0], example.moment[:, 1]
    page.chart(
        f"Moment at {speed:g} m/s, looking downwind: right is that of the rotor's weight",
        [
            trace("2 s", right, up),
            trace("start", right[:1], up[:1], points=True, marker={"size": 11}),
            trace("end", right[-1:], up[-1:], points=True, marker={"size": 11, "symbol": "square"}),
        ],
        "right [kN m]",
        "up [kN m]",
    )
    t = example.time - example.time[0]
    caption = (
        f"Roller {example.roller} of both rows at {speed:g} m/s, which moves from "
        f"{example.at[0]:.0f} to {example.at[-1]:.0f} deg"
    )
    page.chart(
        caption,
        [
            trace(f"{row} row{words}", t, values, line={"color": color, "dash": dash})
            for k, (row, color) in enumerate((("upwind", "#0072b2"), ("downwind", "#d55e00")))
            for words, values, dash in (
                (", load", example.loads[:, k], "solid"),
                (", end laminae differ by, times 10", 10.0 * example.ends[:, k], "dot"),
            )
        ],
        "time [s]",
        "load [kN]",
    )


def check(page: Page, bearing: Bearing, loads: Floats) -> None:
    """Why the end differences of both rows vanish together."""
    u = equilibrium(bearing, loads[:200]).displacements
    first, second = (approaches(row, u) for row in bearing.rows if isinstance(row, RollerRow))
    one, other = (np.abs(a[..., -1] - a[..., 0]) for a in (first, second))
    page.vanishes(
        "approach of a roller's two ends: difference between the rows, over the largest",
        float(np.abs(one - other).max() / one.max()),
        within=1e-9,
        why="round-off: both rows see the same tilt about their tangent",
        source="rigid rings",
    )
