"""What the page of ``loads`` says of histories that may say less than they seem to."""

from __future__ import annotations

import numpy as np

from fe_drivetrain.commands.loads_digest import LOADS, Options
from fe_drivetrain.commands.loads_together import Together
from fe_drivetrain.histories.faults import FAR
from fe_drivetrain.histories.windows import TEN_MINUTES
from fe_drivetrain.hub_loads.turbines import different_turbines
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.suite.page import Page

MUCH = 0.1
"""Share of damage from half cycles that is named."""

_NAMED = 5


def faults(page: Page, found: Together, options: Options) -> None:
    """Note files of several turbines, spikes, still channels, short files, a deciding residue.

    Parameters
    ----------
    page : Page
        Takes the notes.
    found : Together
        All files.
    options : Options
        How they were counted.
    """
    if unlike := different_turbines(found.vertical):
        page.note(unlike)
    for file, channel, number, first, far in found.lone[:_NAMED]:
        samples = "one sample stands" if number == 1 else f"{number} samples stand"
        most = "up to " if number > 1 else ""
        distance = (
            f"{most}{formatted(far, 2)} times as far from both neighbours as usual (named from "
            f"{FAR:g} times on)"
            if np.isfinite(far)
            else "away from both neighbours, which are usually equal"
        )
        page.note(
            f"{file}: {samples} alone in {channel}, {distance}, the first at {first:g} s: look at "
            "it, since one range may decide the damage; "
            "nothing is taken out."
        )
    if len(found.lone) > _NAMED:
        page.note(
            f"{len(found.lone) - _NAMED} more channels of files have samples that stand alone."
        )
    count = len(found.names)
    for channel, number in found.constant.items():
        page.note(
            f"{channel} does not vary in {number} of {count} files: it counts no cycles, as of a "
            "turbine at rest, or of a channel that was not recorded."
        )
    short = [row for row in found.files if row["step [s]"] * row["samples"] < 0.99 * TEN_MINUTES]
    if short:
        page.note(
            f"{len(short)} of {count} files are shorter than ten minutes: their windows are as "
            "long as they are, and turbulence slower than that is missing."
        )
    assert found.damage is not None
    if options.residue != "half" or not found.damage.any():
        return
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.nan_to_num(found.halves / found.damage)
    c, k = np.unravel_index(int(np.argmax(share)), share.shape)
    if share[c, k] > MUCH:
        slope = options.slopes[int(k)]
        more = 100.0 * ((1.0 + share[c, k]) ** (1.0 / slope) - 1.0)
        page.note(
            f"{LOADS[int(c)]}, m = {slope:g}: {100 * share[c, k]:.3g} % of the damage is of half "
            f"cycles that the ends of files leave open; counted as whole ones (--residue closed) "
            f"they make its equivalent load {more:.2g} % larger."
        )
