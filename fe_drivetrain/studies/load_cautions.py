"""Cautions about load histories that may say less than they seem to."""

from __future__ import annotations

import numpy as np

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.studies.load_digest import CHANNELS, LOADS, LoadOptions
from fe_drivetrain.studies.load_planes import PLANES
from fe_drivetrain.studies.load_totals import LoadTotals, Suspects
from fe_drivetrain.turbine_loads.histories.faults import FAR
from fe_drivetrain.turbine_loads.histories.windows import TEN_MINUTES
from fe_drivetrain.turbine_loads.hub_loads.sampling import GAP
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
    said += _sampling(found)
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


def left_out(found: LoadTotals, with_reactions: bool) -> list[str]:
    """Sentences on what is left out since files lack components, and on a torque of another shaft.

    Parameters
    ----------
    found : LoadTotals
        All files.
    with_reactions : bool
        Whether reactions of a scene were asked for.
    """
    said = []
    shaft = found.files.torque_of
    if found.absent:
        planes = [name for name, _ in PLANES if name not in found.planes]
        without = [f"direction and loops of {' and '.join(planes)}"] if planes else []
        without += ["bearing reactions, which need all six components"] if with_reactions else []
        said.append(
            f"{_where_absent(found)}, so not known rather than zero. Left out: "
            f"{'; '.join(['their statistics, cycles and spectra', *without])}."
        )
        said += [f"{why[0].upper()}{why[1:]}." for why in _why_left_out(found)]
    elif with_reactions and shaft:
        said.append(
            f"Bearing reactions are left out: they need the rotor's torque, and Mx is that of the "
            f"{shaft}."
        )
    if shaft:
        said.append(
            f"Mx is the torque of the {shaft} as recorded; turns are the rotor's. gearbox_ratio in "
            "a mapping makes it the rotor's torque, without losses and inertia between."
        )
    return said


def _why_left_out(found: LoadTotals) -> list[str]:
    """Why channels that files have are not read, each reason once."""
    parts = (part for read in found.files.channels for part in read.split("; "))
    return list(dict.fromkeys(part for part in parts if part.startswith("left out: ")))


def _where_absent(found: LoadTotals) -> str:
    """Which components are absent, and in which files."""
    absent, names = found.absent, found.files.names
    places = [CHANNELS.index(name) for name in absent]
    lacking = np.isnan(found.statistics.means[:, places]).any(axis=1)
    number = int(lacking.sum())
    what = f"{', '.join(absent)} {'is' if len(absent) == 1 else 'are'}"
    if len(names) == 1 or number == len(names):
        return f"{what} not recorded"
    first = names[int(np.argmax(lacking))]
    return f"{what} not in all of the {len(names)} files ({number} without, as {first})"


def _sampling(found: LoadTotals) -> list[str]:
    """Uneven steps, and gaps."""
    said = []
    files = list(zip(found.files.names, found.files.steps, found.files.spans, strict=True))
    for name, steps, _ in [one for one in files if not one[1].even][:_NAMED]:
        spectra = (
            f" Spectra are of values on straight lines between samples, every {steps.usual:.3g} s."
            if len(found.spectra.frequency)
            else ""
        )
        said.append(
            f"{name} is sampled unevenly, every {steps.least:.3g} to {steps.most:.3g} s, usually "
            f"{steps.usual:.3g} s: each sample counts for its own time, cycles are of samples as "
            f"they are.{spectra}"
        )
    for name, steps, span in [one for one in files if len(one[1].gaps)][:_NAMED]:
        count = len(steps.gaps)
        at, longest = steps.gaps[int(np.argmax(steps.gaps[:, 1]))].tolist()
        whole = span.end - span.start
        said.append(
            f"{name} has {'a gap' if count == 1 else f'{count} gaps'}, "
            f"{steps.gaps[:, 1].sum():.4g} of {whole:.4g} s, the longest {longest:.4g} s from "
            f"{at:.12g} s on (a step of more than {GAP:g} usual ones): nothing is filled in, and "
            "no cycle, spectrum or loop leads over it."
        )
    return said


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
            f"{file}: {samples} alone in {channel}, {distance}, the first at {first:.12g} s: look "
            "at it, since one range may decide the damage; "
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
    if options.residue != "half" or not np.nan_to_num(cycles.damage).any():
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
