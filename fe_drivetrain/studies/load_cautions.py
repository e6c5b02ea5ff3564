"""Cautions about load histories that may say less than they seem to."""

from __future__ import annotations

import numpy as np

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.studies.load_digest import LOADS, LoadOptions
from fe_drivetrain.studies.load_totals import LoadTotals, Suspects
from fe_drivetrain.turbine_loads.histories.faults import FAR
from fe_drivetrain.turbine_loads.histories.windows import TEN_MINUTES
from fe_drivetrain.turbine_loads.hub_loads.turbines import different_turbines

MUCH = 0.1
"""Share of damage from half cycles that is named."""

_NAMED = 5


def cautions(found: LoadTotals, options: LoadOptions) -> list[str]:
    """Sentences on files of several turbines, spikes, still channels, short files, the residue.

    Parameters
    ----------
    found : LoadTotals
        All files.
    options : LoadOptions
        How they were counted.
    """
    names, vertical = found.files.names, found.statistics.mean_and_deviation("Fz")
    said = []
    if unlike := different_turbines(dict(zip(names, vertical, strict=True))):
        said.append(unlike)
    said += _lone(found.suspects)
    count = len(names)
    said += [
        f"{channel} does not vary in {number} of {count} files: no cycles are "
        "counted. The turbine may be at rest, or the channel not recorded."
        for channel, number in found.suspects.still.items()
    ]
    short = sum(span.seconds < 0.99 * TEN_MINUTES for span in found.files.spans)
    if short:
        said.append(
            f"{short} of {count} files are shorter than ten minutes: their windows are as "
            "long as they are, and turbulence slower than that is missing."
        )
    return said + _residue(found, options)


def _lone(found: Suspects) -> list[str]:
    said = []
    for file, channel, number, first, far in found.lone[:_NAMED]:
        samples = "one sample stands" if number == 1 else f"{number} samples stand"
        most = "up to " if number > 1 else ""
        distance = (
            f"{most}{formatted(far, 2)} times as far from both neighbours as usual (named from "
            f"{FAR:g} times on)"
            if np.isfinite(far)
            else "away from both neighbours, which are usually equal"
        )
        said.append(
            f"{file}: {samples} alone in {channel}, {distance}, the first at {first:g} s: look at "
            "it, since one range may decide the damage; "
            "nothing is taken out."
        )
    if len(found.lone) > _NAMED:
        said.append(
            f"{len(found.lone) - _NAMED} more channels of files have samples that stand alone."
        )
    return said


def _residue(found: LoadTotals, options: LoadOptions) -> list[str]:
    """Half cycles that decide the damage."""
    cycles = found.cycles
    if options.residue != "half" or not cycles.damage.any():
        return []
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.nan_to_num(cycles.halves / cycles.damage)
    c, k = np.unravel_index(int(np.argmax(share)), share.shape)
    if not share[c, k] > MUCH:
        return []
    slope = options.slopes[int(k)]
    more = 100.0 * ((1.0 + share[c, k]) ** (1.0 / slope) - 1.0)
    return [
        f"{LOADS[int(c)]}, m = {slope:g}: {100 * share[c, k]:.3g} % of the damage is of half "
        f"cycles that the ends of files leave open; counted as whole ones "
        f"({argument('LoadOptions.residue', 'closed')}) "
        f"they make its equivalent load {more:.2g} % larger."
    ]
