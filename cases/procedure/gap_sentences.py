"""Sentences of a report on misalignment and voltage dips, each judged by a drivetrain in time."""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.drivetrain_file import Drivetrain
from fe_drivetrain.dynamics import machine_of
from fe_drivetrain.procedure import DIPS, MISALIGNMENT
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record
from fe_drivetrain.studies import TransientResult

NOTABLE = 0.05
"""Share of the largest rated force of a bearing from which a change of forces is notable."""
SMALL = 0.01
"""Share of its rated value within which a torque or a force has not shifted."""
DIP = "dip of {:g} % for {:g} s"
NEEDS_TIME = "calculations in the time domain are necessary for it"
CHANGE = "largest change of a bearing's force by misalignment"
PEAK = "largest torque in a dip over rated"
YEARLY, YEARS = 100, 20
"""Dips of a year, and years, that fatigue is put beside; no source prints a number."""
MOUNT = "force of gearbox mount"
PINS = tuple(f"force of stage {number} pin" for number in range(1, 10))
"""Channels of the mount, and of planets, which are apart from bearings that stand."""


@dataclass(frozen=True)
class Misaligned:
    """A misalignment in time: its name, its values, and what the drivetrain does."""

    name: str
    values: Mapping[str, float]
    result: TransientResult

    def changes(self, kind: str) -> dict[str, float]:
        """Largest change of each channel of a kind against aligned turning, by its name."""
        return {
            name: max(abs(one.most - one.rated), abs(one.least - one.rated))
            for name, one in self.result.extremes.items()
            if one.kind == kind and not name.startswith((MOUNT, *PINS))
        }

    def varies(self) -> dict[str, float]:
        """How far the force of each bearing varies in time, by its name."""
        return {n: e.most - e.least for n, e in self.result.extremes.items() if e.kind == "bearing"}

    @property
    def stands(self) -> bool:
        """Whether nothing of the misalignment turns with a shaft."""
        return not {"anisotropy", "run_out"} & self.values.keys()

    @property
    def worst(self) -> str:
        """Channel of the bearing whose force changes most."""
        changes = self.changes("bearing")
        return max(changes, key=lambda name: changes[name])


def sentence(what: str, place: str, ours: str, verdict: str) -> Record:
    """A row: what the report says and where, what ours does, and whether it holds."""
    return {"report": what, "section": place, "ours": ours, "verdict": verdict}


def main_channels(drivetrain: Drivetrain) -> set[str]:
    """Channels of the bearings that hold the main shaft or the rotor."""
    machine = machine_of(drivetrain)
    fronts = {"rotor", machine.shafts[0].name}
    return {f"force of {one.name}" for one in machine.bearings if one.holds in fronts}


def of_misalignment(
    page: Page, found: Sequence[Misaligned], mains: Collection[str]
) -> list[Record]:
    """Sentences on misalignment, of all of it."""
    worst = max(found, key=lambda one: max(one.changes("bearing").values()))
    extremes = worst.result.extremes
    name, change = worst.worst, worst.changes("bearing")[worst.worst]
    band = max(extremes[name].most_band or 0.0, extremes[name].least_band or 0.0)
    page.found(f"{CHANGE} [kN]", change / 1e3, band / 1e3, (MISALIGNMENT,))
    largest = max(one.rated for one in extremes.values() if one.kind == "bearing")
    share = change / largest
    torque = max(
        value / abs(one.result.extremes[channel].rated)
        for one in found
        for channel, value in one.changes("torque").items()
    )
    main = max(
        (
            value / max(abs(one.result.extremes[channel].rated), SMALL * largest)
            for one in found
            for channel, value in one.changes("bearing").items()
            if channel in mains
        ),
        default=0.0,
    )
    return [
        sentence(
            "misalignment may cause constraining forces in the gearbox",
            "4.2",
            f"{worst.name}: {name} changes by {change / 1e3:.3g} kN, {100 * share:.0f} % of the "
            "largest rated force of a bearing",
            "holds" if share > NOTABLE else "does not hold",
        ),
        *of_either_end(found),
        sentence(
            "models with few degrees of freedom cannot analyse it",
            "4.2",
            f"torques of all shafts change by {100 * torque:.2g} % of rated at most: in torsion "
            "alone nothing is seen",
            "holds" if torque < SMALL else "does not hold",
        ),
        sentence(
            "loads at the interfaces do not shift significantly, those of components do",
            "4.2",
            f"torques shift by {100 * torque:.2g} %; the main bearing's force, by "
            f"{100 * main:.2g} %",
            "holds" if max(torque, main) < NOTABLE else "holds in part",
        ),
        in_time(found),
    ]


def of_either_end(found: Sequence[Misaligned]) -> list[Record]:
    """Where misalignment comes from: each end of the gearbox, with its largest change."""
    ends = {"main shaft and gearbox": "gearbox", "gearbox and generator": "generator"}
    rows = []
    for end, begins in ends.items():
        of = [one for one in found if one.name.startswith(begins)]
        most = max(of, key=lambda one: max(one.changes("bearing").values()))
        change = most.changes("bearing")[most.worst]
        rated = abs(most.result.extremes[most.worst].rated)
        rows.append(
            sentence(
                f"it originates from the interface of {end}",
                "4.2",
                f"{most.name}: {most.worst} by {change / 1e3:.3g} kN, of {rated / 1e3:.3g} kN "
                "aligned",
                "holds" if change > NOTABLE * rated else "does not hold",
            )
        )
    return rows


def in_time(found: Sequence[Misaligned]) -> Record:
    """Whether misalignment needs the time domain: what varies in time of bearings that stand."""
    parts = []
    for one in found:
        changes = one.changes("bearing")
        change, rated = (
            max(changes.values()),
            max(abs(one.result.extremes[n].rated) for n in changes),
        )
        if change > SMALL * rated:
            varies = one.varies()
            pins = max((v for n, v in varies.items() if n.startswith(PINS)), default=0.0)
            parts.append((max(varies[n] for n in changes) / change, one, pins))
    if not parts:
        words = "the drivetrain follows it: nothing changes, in time or else"
        return sentence(NEEDS_TIME, "4.2", words, "does not hold")
    share, name = max((share, one.name) for share, one, _ in parts)
    even = [share for share, one, _ in parts if one.stands]
    pins = max(part[2] for part in parts)
    steady = f"of what stands they vary by {100 * max(even):.2g} % of their change" if even else ""
    return sentence(
        NEEDS_TIME,
        "4.2",
        f"forces of bearings: {steady + ', as statics has it; ' if even else ''}{name}: by "
        f"{100 * share:.2g} %; of planets by {pins / 1e3:.3g} kN in a turn",
        "holds in part" if even and max(even) < NOTABLE else "holds",
    )


def peak_of(one: TransientResult, kind: str) -> tuple[str, float]:
    """Channel of a kind with the largest value over rated, and that."""
    size = {
        name: e.largest / abs(e.rated)
        for name, e in one.extremes.items()
        if e.kind == kind and np.isfinite(e.over_rated) and "axial" not in name
    }
    largest = max(abs(e.rated) for e in one.extremes.values() if e.kind == kind)
    size = {n: v for n, v in size.items() if abs(one.extremes[n].rated) > NOTABLE * largest}
    name = max(size, key=lambda name: size[name])
    return name, size[name]


def worn(one: TransientResult) -> dict[str, float]:
    """Damage of gears and bearings by an event, of those that are rated, by name."""
    if one.parts is None:
        return {}
    bearings = {name: of.damage["L10"] for name, of in one.parts.bearings.items()}
    return bearings | {name: of.damage.largest for name, of in one.parts.gears.items()}


def of_dips(
    page: Page,
    dips: Mapping[tuple[float, float], TransientResult],
    both: TransientResult,
    still: TransientResult,
    aligned: Misaligned,
) -> list[Record]:
    """Sentences on dips of the voltage."""
    peaks = {shape: peak_of(one, "torque") for shape, one in dips.items()}
    most = max(peaks, key=lambda shape: peaks[shape][1])
    least = min(peaks, key=lambda shape: peaks[shape][1])
    highest = dips[most].extremes[peaks[most][0]]
    page.found(PEAK, peaks[most][1], (highest.most_band or 0.0) / abs(highest.rated), loads=(DIPS,))
    spread = peaks[most][1] / peaks[least][1]
    return [
        superposed(both, still, dips[next(iter(dips))], aligned),
        sentence(
            "shapes of the voltage have different effects on the turbine",
            "4.2",
            f"torque up to {peaks[most][1]:.2f} of rated ({DIP.format(100 * most[0], most[1])}), "
            f"but {peaks[least][1]:.2f} ({DIP.format(100 * least[0], least[1])})",
            "holds" if spread > 1.0 + NOTABLE else "does not hold",
        ),
        fatigue(page, dips, still),
        levels(dips),
    ]


def superposed(
    both: TransientResult, still: TransientResult, dip: TransientResult, offset: Misaligned
) -> Record:
    """A transient of a misaligned gearbox: more than the dip and the offset by themselves?"""
    name = max(
        offset.changes("bearing").keys() & both.extremes.keys() & dip.extremes.keys(),
        key=lambda n: both.extremes[n].largest - dip.extremes[n].largest,
    )
    alone = dip.extremes[name].largest - still.extremes[name].rated
    together = both.extremes[name].largest - still.extremes[name].rated
    shift = offset.changes("bearing").get(name, 0.0)
    return sentence(
        "transient events are to be analysed with misalignment",
        "4.2",
        f"{name}: {together / 1e3:.3g} kN above aligned turning, dip alone {alone / 1e3:.3g} kN, "
        f"{offset.name} alone {shift / 1e3:.3g} kN",
        "holds" if together > (1.0 + NOTABLE) * max(alone, shift) else "does not hold",
    )


def fatigue(
    page: Page, dips: Mapping[tuple[float, float], TransientResult], still: TransientResult
) -> Record:
    """Whether dips matter for ultimate strength and for fatigue."""
    peak = max(peak_of(one, "mesh")[1] for one in dips.values())
    steady = worn(still)
    most = {
        name: max(worn(one).get(name, 0.0) for one in dips.values()) - before
        for name, before in steady.items()
    }
    if not most:
        page.skip("damage of dips", "the drivetrain's file states no strengths and no bearings")
        words = f"forces of meshes up to {peak:.2f} of rated; fatigue: strengths are not stated"
        return sentence("dips matter for fatigue and ultimate strength", "4.2", words, "open")
    name = max(most, key=lambda key: most[key])
    life = most[name] * YEARLY * YEARS
    page.found("largest damage by one dip beyond that of the same time at rated", most[name])
    ultimate, tires = peak > 1.0 + NOTABLE, life > NOTABLE
    verdict = "holds" if ultimate and tires else "holds in part" if ultimate or tires else None
    return sentence(
        "dips matter for fatigue and ultimate strength",
        "4.2",
        f"forces of meshes up to {peak:.2f} of rated; a dip adds {formatted(most[name], 2)} to "
        f"the damage of {name}, {YEARLY} a year for {YEARS} years {formatted(life, 2)}",
        verdict or "does not hold",
    )


def levels(dips: Mapping[tuple[float, float], TransientResult]) -> Record:
    """Which level of the model dips need: error of the torsional one against the finest."""
    errors = {
        of.kind: max(e.error for one in dips.values() for e in one.errors[0] if e.kind == of.kind)
        for of in next(iter(dips.values())).errors[0]
    }
    torque, mesh = errors.get("torque", 0.0), errors.get("mesh", 0.0)
    return sentence(
        "tools of the time are too simple for the loads of a dip",
        "4.2",
        f"torsion alone misses torques by {100 * torque:.2g} %, forces of meshes by "
        f"{100 * mesh:.2g} %, and has no forces of bearings",
        "holds in part" if torque < NOTABLE else "holds",
    )
