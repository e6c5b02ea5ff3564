"""Sections of the page of ``loads``: cycles, equivalent loads, time and turns at level."""

from __future__ import annotations

import numpy as np

from fe_drivetrain.commands.loads_digest import LOADS, POWER, UNITS, Options
from fe_drivetrain.commands.loads_together import Together
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.histories.damage import FREQUENCY
from fe_drivetrain.procedure.failure_modes import ROTOR_TORQUE
from fe_drivetrain.report.answer import value_with_band
from fe_drivetrain.report.charts import heat_map, trace
from fe_drivetrain.suite.page import Page
from fe_drivetrain.suite.records import Record


def counts(page: Page, found: Together, options: Options, rule: str) -> dict[str, list[Record]]:
    """Add the sections; the tables that go to files, by name."""
    return {**_cycles(page, found, options, rule), **_levels(page, found)}


def equivalent(
    damage: Floats, seconds: float, slopes: Floats, frequency: float = FREQUENCY
) -> Floats:
    """Damage-equivalent loads (c, s) of sums of n r^m over so many seconds, at a frequency [Hz]."""
    return np.asarray((damage / (frequency * seconds)) ** (1.0 / slopes))


def answer_of_counts(page: Page, found: Together, options: Options) -> str:
    """The equivalent tilting moment and torque, with what the residue leaves open.

    Parameters
    ----------
    page : Page
        Takes the values.
    found : Together
        Of all files.
    options : Options
        Slopes, and the rule for the residue.

    Returns
    -------
    str
        The first words of the answer; none where nothing varies.
    """
    assert found.damage is not None
    slope, hertz = options.slopes[0], options.frequency
    words = []
    for name in ("My", "Mx"):
        sums = found.damage[LOADS.index(name), 0], found.halves[LOADS.index(name), 0]
        if not sums[0]:
            continue
        load, most = (
            float(equivalent(np.array([[total]]), found.seconds, np.array([slope]), hertz)[0, 0])
            for total in (sums[0], sums[0] + sums[1])
        )
        band = (most - load) / 1e3 if options.residue == "half" else None
        quantity = f"equivalent load of {name}, slope {slope:g} [kN m]"
        page.found(quantity, load / 1e3, band, (ROTOR_TORQUE,) if name == "Mx" else ())
        words.append(f"{value_with_band(page.answers[-1])} in {name}")
    if not words:
        return ""
    open_ends = " (± what whole cycles in place of half ones would add)"
    rule = open_ends if options.residue == "half" else ""
    return (
        f"These loads do the damage of a sine of {hertz:g} Hz with a range of "
        f"{' and '.join(words)} at a slope of {slope:g}{rule}: "
    )


def _cycles(page: Page, found: Together, options: Options, rule: str) -> dict[str, list[Record]]:
    page.section("Cycles")
    slopes = np.array(options.slopes, dtype=float)
    assert found.damage is not None
    assert found.cycles is not None
    hertz = options.frequency
    overall = equivalent(found.damage, found.seconds, slopes, hertz)
    page.table(
        f"Damage-equivalent loads: range of a sine of {hertz:g} Hz that does the same damage; "
        f"{rule}",
        [
            {
                "channel": f"{name} [{'kN' if unit == 'N' else 'kN m'}]",
                **{f"m = {m:g}": v / 1e3 for m, v in zip(options.slopes, row, strict=True)},
                "largest range": largest / 1e3,
                "cycles": number,
                "left out": left_out,
            }
            for name, unit, row, (largest, number, left_out) in zip(
                LOADS, UNITS, overall.tolist(), found.cycles.tolist(), strict=False
            )
        ],
    )
    page.data(
        "equivalent_loads",
        {
            n: dict(zip(map(str, options.slopes), row, strict=True))
            for n, row in zip(LOADS, overall.tolist(), strict=True)
        },
    )
    _about_zero(page, found, options, rule)
    for chosen, unit in ((("Fx", "Fy", "Fz"), "kN"), (("Mx", "My", "Mz"), "kN m")):
        traces = []
        for name in chosen:
            classes = found.classes[f"ranges of {name}"]
            traces.append(trace(name, classes.edges()[:-1] / 1e3, classes.at_least))
        page.chart(
            f"Cycles of a range or a larger one; {rule}",
            traces,
            f"range [{unit}]",
            "cycles",
            "y",
        )
    for name in ("Mx", "My"):
        both = found.classes[f"ranges and means of {name}"]
        with np.errstate(divide="ignore"):
            shown = np.log10(both.amount)
        shown[np.isinf(shown)] = np.nan
        page.add(
            heat_map(
                f"Cycles of {name} by range and mean; {rule}",
                both.middles(1) / 1e3,
                both.middles(0) / 1e3,
                shown,
                ("mean [kN m]", "range [kN m]", "log10 of cycles"),
            )
        )
    ranges = [
        {"channel": name, "unit": unit, "range from": low, "range to": high, "cycles": number}
        for name, unit in zip(LOADS, UNITS, strict=False)
        for low, high, number in _filled(found, f"ranges of {name}")
    ]
    matrix: list[Record] = []
    for name in ("Mx", "My"):
        both = found.classes[f"ranges and means of {name}"]
        rows, means = both.edges(0), both.edges(1)
        for r, c in np.argwhere(both.amount > 0.0).tolist():
            matrix.append(
                {
                    "channel": name,
                    "range from [N m]": float(rows[r]),
                    "range to [N m]": float(rows[r + 1]),
                    "mean from [N m]": float(means[c]),
                    "mean to [N m]": float(means[c + 1]),
                    "cycles": float(both.amount[r, c]),
                }
            )
    seconds = [row["step [s]"] * row["samples"] for row in found.files]
    equivalents = [
        {
            "file": file,
            "channel": name,
            "unit": unit,
            "slope": float(m),
            f"DEL at {hertz:g} Hz": value,
        }
        for file, damage, time in zip(
            ("all", *found.names),
            (found.damage, *found.damages),
            (found.seconds, *seconds),
            strict=True,
        )
        for name, unit, row in zip(
            LOADS, UNITS, equivalent(damage, time, slopes, hertz).tolist(), strict=False
        )
        for m, value in zip(slopes, row, strict=True)
    ]
    return {"equivalent_loads": equivalents, "ranges": ranges, "range_mean": matrix}


def _about_zero(page: Page, found: Together, options: Options, rule: str) -> None:
    """Equivalent loads of cycles about zero mean, where an ultimate load is given."""
    if not options.ultimate:
        return
    slopes = np.array(options.slopes, dtype=float)
    loads = equivalent(found.about_zero, found.seconds, slopes, options.frequency)
    page.table(
        "The same of cycles about zero mean, their ranges changed by Goodman's straight line to "
        f"the ultimate load; {rule}",
        [
            {
                "channel": f"{name} [{'kN' if unit == 'N' else 'kN m'}]",
                "ultimate load": options.ultimate[name] / 1e3,
                **{f"m = {m:g}": v / 1e3 for m, v in zip(options.slopes, row, strict=True)},
            }
            for name, unit, row in zip(LOADS, UNITS, loads.tolist(), strict=False)
            if name in options.ultimate
        ],
    )
    page.data(
        "equivalent_loads_about_zero",
        {
            name: dict(zip(map(str, options.slopes), row, strict=True))
            for name, row in zip(LOADS, loads.tolist(), strict=True)
            if name in options.ultimate
        },
    )


def _levels(page: Page, found: Together) -> dict[str, list[Record]]:
    page.section("Time and turns at level")
    torque = found.classes["time at Mx"]
    traces = [trace("time", torque.edges()[:-1] / 1e3, torque.at_least / 3600.0)]
    page.chart(
        "Load duration distribution of the torque: time at a level or above it",
        traces,
        "torque Mx [kN m]",
        "time [h]",
    )
    turning = "turns at Mx" in found.classes
    if turning:
        turns = found.classes["turns at Mx"]
        page.chart(
            "Load revolution distribution of the torque: turns of the rotor at each level",
            [trace("turns", turns.middles() / 1e3, turns.amount)],
            "torque Mx [kN m]",
            "turns",
        )
    reversals, negative, over_time, over_turns, all_turns = found.torque.tolist()
    rows: list[Record] = [
        {"quantity": "torque reversals beyond 1 % of a file's largest torque", "value": reversals},
        {"quantity": "time with negative torque [s]", "value": negative},
        {
            "quantity": f"equivalent torque, exponent {POWER:.3g}, over time [kN m]",
            "value": 1e3 * (over_time / found.seconds) ** (1.0 / POWER),
        },
    ]
    if turning and not np.isnan(all_turns) and all_turns > 0.0:
        rows += [
            {"quantity": "turns of the rotor", "value": all_turns},
            {
                "quantity": f"equivalent torque, exponent {POWER:.3g}, over turns [kN m]",
                "value": 1e3 * (over_turns / all_turns) ** (1.0 / POWER),
            },
        ]
    page.table(
        "Torque: reversals, and the constant torque of the same effect on roller bearings", rows
    )
    page.text(
        "Lives of gears and bearings follow the load and the turns at it, not counted cycles. Both "
        "distributions of every load are in levels.csv."
    )
    page.data("torque", {row["quantity"]: row["value"] for row in rows})
    levels = [
        {"channel": name, "unit": unit, "of": kind, "from": low, "to": high, "amount": amount}
        for kind, word in (("seconds", "time"), ("turns", "turns"))
        for name, unit in zip(LOADS, UNITS, strict=False)
        if f"{word} at {name}" in found.classes
        for low, high, amount in _filled(found, f"{word} at {name}")
    ]
    return {"levels": levels}


def _filled(found: Together, name: str) -> list[tuple[float, float, float]]:
    """Limits and amounts of the classes that hold something."""
    classes = found.classes[name]
    edges = classes.edges()
    return [
        (float(edges[k]), float(edges[k + 1]), float(classes.amount[k]))
        for k in np.flatnonzero(classes.amount > 0.0).tolist()
    ]
