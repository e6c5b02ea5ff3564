"""Section of the page of ``loads``: two sets of histories beside each other, by wind."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fe_drivetrain.commands.loads_digest import (
    CHANNELS,
    LOADS,
    PLANES,
    POWER,
    UNITS,
    Digest,
    Options,
)
from fe_drivetrain.commands.loads_reactions import ALONE, OTHER, parts
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.histories.sets import CHANCE, Difference, differences
from fe_drivetrain.histories.spectra import MULTIPLES, SEGMENT
from fe_drivetrain.histories.windows import COLUMNS
from fe_drivetrain.report.charts import trace
from fe_drivetrain.suite.page import Page
from fe_drivetrain.suite.records import Record

WIND_BIN = 1.0
"""Histories whose mean winds round to the same multiple are of one condition [m/s]."""


def features(found: Digest, slopes: Sequence[float]) -> dict[str, float]:
    """Quantities of one history that are compared, by name with unit [kN, kN m].

    Parameters
    ----------
    found : dict
        Of `digest`.
    slopes : sequence of float
        With which it was made.
    """
    _, _, step, count = found["time"].tolist()
    values, weights = found["window values"], found["window seconds"]
    share = weights / weights.sum()
    mean = share @ values[:, :, 1]
    spread = np.sqrt(share @ (values[:, :, 3] ** 2 + (values[:, :, 1] - mean) ** 2))
    table = np.column_stack([values[:, :, 0].min(0), mean, values[:, :, 2].max(0), spread])
    result: dict[str, float] = {}
    for c, (name, unit) in enumerate(zip(LOADS, UNITS, strict=False)):
        shown = "kN" if unit == "N" else "kN m"
        for k, what in enumerate(COLUMNS):
            result[f"{name}, {what} [{shown}]"] = float(table[c, k]) / 1e3
        for k, slope in enumerate(slopes):
            load = (float(found["damage"][c, k]) / (count * step)) ** (1.0 / slope)
            result[f"{name}, DEL of m = {slope:g} at 1 Hz [{shown}]"] = load / 1e3
        if "multiples" in found:
            for k, number in enumerate(MULTIPLES):
                result[f"{name}, {number}P [{shown}]"] = float(found["multiples"][c, k]) / 1e3
    for name, _ in PLANES:
        number, seconds, over = found[f"loops of {name}"].tolist()
        result[f"loops of {name}, share of time [%]"] = 100.0 * seconds / (count * step)
        if not np.isnan(over):
            result[f"loops of {name}, over blade passages [-]"] = over
    torque = 1e3 * (float(found["torque"][2]) / (count * step)) ** (1.0 / POWER)
    result["Mx, equivalent over time [kN m]"] = torque
    return result


def all_features(found: Digest, slopes: Sequence[float]) -> dict[str, float]:
    """Quantities of one history, and of each reaction to it that a digest has.

    Parameters
    ----------
    found : dict
        Of `digest_with_reactions`.
    slopes : sequence of float
        With which it was made.
    """
    result: dict[str, float] = {}
    for name, part in parts(found).items():
        own = features(part, slopes)
        if name.startswith(OTHER):  # one channel, in its own unit
            start, shown = f"{ALONE}, ", name.removeprefix(OTHER)
            for key, value in own.items():
                if key.startswith(start):
                    what = key.removeprefix(start).removesuffix(" [kN]")
                    result[f"{shown}, {what}"] = 1e3 * value
            continue
        before = f"{name}: " if name else ""
        result |= {f"{before}{key}": v for key, v in own.items()}
    return result


def mean_wind(found: Digest) -> float:
    """Mean wind speed of one history [m/s]; NaN where it is not known."""
    weights = found["window seconds"]
    return float(found["window values"][:, CHANNELS.index("wind speed"), 1] @ weights) / float(
        weights.sum()
    )


def beside(
    page: Page,
    one: Sequence[Digest],
    other: Sequence[Digest],
    options: Options,
    names: tuple[str, str] = ("these files", "the others"),
) -> list[Record]:
    """Add the section; every quantity of every wind, for a file.

    Parameters
    ----------
    page : Page
        Takes the tables.
    one, other : sequence of Digest
        Of the two sets.
    options : Options
        With which both were made.
    names : tuple of str
        What the sets are called.

    Raises
    ------
    InputError
        No wind has histories of both, and three or more together.
    """
    page.section(f"{names[0][:1].upper()}{names[0][1:]} beside {names[1]}")
    rows: list[Record] = []
    alone: list[str] = []
    for wind in sorted(_winds(one) | _winds(other), key=str):
        sets = [
            [all_features(d, options.slopes) for d in s if _wind(d) == wind] for s in (one, other)
        ]
        if not sets[0] or not sets[1] or len(sets[0]) + len(sets[1]) < 3:
            alone.append(str(wind))
            continue
        found = differences(sets[0], sets[1])
        rows += [_row(wind, difference, names) for difference in found]
        _shown(page, wind, found, (len(sets[0]), len(sets[1])), names)
        _spectra(page, wind, [[d for d in own if _wind(d) == wind] for own in (one, other)], names)
    if not rows:
        raise InputError(
            f"--against: no mean wind speed, to {WIND_BIN:g} m/s, has histories of both sets and "
            "three or more together: give more histories of the same winds"
        )
    if alone:
        page.text(f"Not compared, for want of histories of both sets: {', '.join(alone)}.")
    return rows


def _shown(
    page: Page,
    wind: str,
    found: Sequence[Difference],
    counts: tuple[int, int],
    names: tuple[str, str],
) -> None:
    """What differs, the largest first."""
    beyond = sorted((d for d in found if d.beyond), key=lambda d: -abs(d.one - d.other) / d.allowed)
    page.answer(
        f"{wind}: {len(beyond)} of {len(found)} quantities differ between {names[0]} "
        f"({counts[0]}) and {names[1]} ({counts[1]}) by more than the scatter of seeds; "
        f"{CHANCE * len(found):.1g} would by chance."
    )
    page.table(
        f"{wind}: what differs by more than the scatter of seeds (Student's test at {CHANCE:.0%}, "
        "seeds of both sets scattering equally), farthest first",
        [_row(wind, d, names) for d in beyond[:40]],
        ["quantity", names[0], names[1], "ratio", "scatter of seeds", "allowed difference"],
    )


def _spectra(
    page: Page, wind: str, sets: Sequence[Sequence[Digest]], names: tuple[str, str]
) -> None:
    """Mean spectra of both sets, of the moments across the shaft and of what bearings carry."""
    if not all("spectra" in found for own in sets for found in own):
        return
    for name in parts(sets[0][0]):
        if name.startswith(OTHER):
            continue
        for load in ("My",) if not name else ("Fz", "My"):
            traces = []
            for label, own in zip(names, sets, strict=True):
                densities = [parts(d)[name]["spectra"][LOADS.index(load)] for d in own]
                lines = min(map(len, densities))
                mean = np.mean([one[:lines] for one in densities], axis=0) / 1e6
                traces.append(trace(label, np.arange(1, lines) / SEGMENT, mean[1:]))
            if max(max(t["y"]) for t in traces) > 0.0:
                unit = "kN" if load.startswith("F") else "kN m"
                page.chart(
                    f"{wind}: power spectral density of {name + ', ' if name else ''}{load}, mean "
                    f"of each set, segments of {SEGMENT:g} s",
                    traces,
                    "frequency [Hz]",
                    f"density [({unit})²/Hz]",
                    "xy",
                )


def _row(wind: str, found: Difference, names: tuple[str, str]) -> Record:
    return {
        "wind": wind,
        "quantity": found.quantity,
        names[0]: found.one,
        names[1]: found.other,
        "ratio": None if np.isnan(found.ratio) else found.ratio,
        "scatter of seeds": found.scatter,
        "allowed difference": found.allowed,
        "beyond": found.beyond,
    }


def _winds(digests: Sequence[Digest]) -> set[str]:
    return {_wind(found) for found in digests}


def _wind(found: Digest) -> str:
    wind: float | Floats = mean_wind(found)
    return "wind not known" if np.isnan(wind) else f"{WIND_BIN * np.round(wind / WIND_BIN):g} m/s"
