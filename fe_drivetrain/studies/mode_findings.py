"""Answer, figures, tables and cautions of a drivetrain's modes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fe_drivetrain.common.components import RPM
from fe_drivetrain.dynamics import Level, Machine
from fe_drivetrain.procedure import RESONANCE, Meeting
from fe_drivetrain.procedure.resonance import NEAR
from fe_drivetrain.report.answer import KeyFigure
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.studies.mode_levels import FIRST
from fe_drivetrain.studies.mode_record import Modes
from fe_drivetrain.studies.mode_register import defect_rows, register_rows

MARGIN = "least margin of an excited frequency"
"""As projects of validation name it."""
QUESTION = "Where are the drivetrain's natural frequencies, and what excites them in operation?"
JUDGED = 3
"""Number of multiples of 1P that the first torsional mode must be apart from: 1P, 3P and 6P."""
SAID = 5
"""Number of crossings that are told in words, the strongest first."""
LOW = 100.0
"""Frequency below which modes are counted [Hz]."""
LEAST_ERROR = 1e-3
"""Error of a level that is stated as a key figure, at least [%]."""
SMALL = 1e-4
"""Band over the value below which four digits are certain."""
ROUND_OFF = 1e-6
"""Round-off of sums of energy: free motions and all others come of one solution."""


def state_modes(found: Findings, machine: Machine, modes: Modes, shown: int) -> None:
    """State what was found of a drivetrain's modes.

    Parameters
    ----------
    found : Findings
        Takes it.
    machine : Machine
        The drivetrain.
    modes : Modes
        What is known of its modes.
    shown : int
        Number of modes that are stated one by one.
    """
    first = modes.torsional
    if first is not None:
        found.found(FIRST, float(modes.frequencies[first]), band_of(modes, first))
    for k in range(min(shown, len(modes.frequencies))):
        found.found(f"mode {k + 1} [Hz]", float(modes.frequencies[k]), band_of(modes, k))
    margins = [one.margin for one in modes.meetings if one.verdict != "not excited"]
    if margins:
        found.found(MARGIN, min(margins), loads=(RESONANCE,))
    for one in modes.resonances[:SAID]:
        found.say(_met(one, modes))
    _check_energy(found, modes)
    _tables(found, modes, shown)
    _notes(found, machine, modes)
    for text in machine.assumed:
        found.assume(text.partition(":")[0], "", "", text)
    found.assume_all(machine.assumptions())
    figures = _key_figures(found, modes)
    found.answer(QUESTION, _verdict(modes, figures[0]), figures)


def note_unknown(found: Findings, names: Sequence[str]) -> None:
    """Name bearings whose defect frequencies are not known.

    Parameters
    ----------
    found : Findings
        Takes the caution.
    names : sequence of str
        Bearings without a catalogue entry.
    """
    if names:
        found.note(
            f"Defect frequencies of {', '.join(names)} are not known, for want of an entry in the "
            "bearing catalogue: name one under 'catalogue' in the file."
        )


def band_of(modes: Modes, mode: int) -> float | None:
    """Half width of a frequency's uncertainty [Hz]; None where it is not known."""
    band = float(modes.bands[mode])
    return None if np.isnan(band) else band


def excited(modes: Modes) -> list[Meeting]:
    """Crossings and near ones whose excitation acts where the mode moves, by speed."""
    kept = [one for one in modes.meetings if one.verdict in ("resonance", "near")]
    return sorted(kept, key=lambda one: (one.crossing, one.frequency))


def crossing_row(one: Meeting, modes: Modes) -> Record:
    """A meeting as a record."""
    always = one.crossing == np.inf
    band = band_of(modes, one.mode - 1)
    share = None if band is None or always else band / float(modes.frequencies[one.mode - 1])
    return {
        "excitation": one.excitation,
        "mode": one.mode,
        "kind": modes.kinds[one.mode - 1],
        "frequency [Hz]": one.frequency,
        "speed of the rotor [rpm]": None if always else one.crossing * RPM,
        "band [rpm]": None if share is None else one.crossing * RPM * share,
        "margin [%]": 100.0 * one.margin,
        "share of the mode's energy [%]": 100.0 * one.share,
        "verdict": one.verdict,
    }


def _met(one: Meeting, modes: Modes) -> str:
    """A crossing in a sentence."""
    at = f"at {formatted(one.crossing * RPM, 3)}\u00a0rpm"
    name = one.excitation[:1].upper() + one.excitation[1:]
    return (
        f"{name} meets mode {one.mode} ({modes.words[one.mode - 1].partition(';')[0]}) "
        f"{at if np.isfinite(one.crossing) else 'at any speed'}, "
        f"{formatted(one.frequency, 4)}\u00a0Hz; it acts where {100.0 * one.share:.0f}\u00a0% of "
        "the mode's energy is."
    )


def mode_rows(modes: Modes, shown: int) -> list[Record]:
    """The first modes as records."""
    rows: list[Record] = []
    for k in range(min(shown, len(modes.frequencies))):
        row: Record = {
            "mode": k + 1,
            "frequency [Hz]": float(modes.frequencies[k]),
            "band [Hz]": band_of(modes, k),
        }
        if modes.speed is not None:
            row[f"at {modes.speed * RPM:.4g} rpm [Hz]"] = float(modes.running[k])
        if modes.damping.any():
            row["damping ratio [%]"] = 100.0 * float(modes.damping[k])
        rows.append({**row, "kind": modes.kinds[k], "what it is": modes.words[k]})
    return rows


def level_rows(modes: Modes) -> list[Record]:
    """Each level's frequencies, with their errors against the finest, as records."""
    rows: list[Record] = []
    finest = modes.ladder[-1].values
    for answer in modes.ladder:
        row: Record = {
            "level": answer.name,
            "degrees of freedom": answer.degrees,
            "time [s]": answer.seconds,
        }
        for name, value in answer.values.items():
            row[name] = value
            best = finest[name]
            error = None if value is None or best is None else 100.0 * (value / best - 1.0)
            row[f"error of {name.partition(' [')[0]} [%]"] = error
        rows.append(row)
    return rows


def _tables(found: Findings, modes: Modes, shown: int) -> None:
    """Keep modes, energy, crossings and levels for other programs."""
    found.data("modes", mode_rows(modes, shown))
    energy: list[Record] = [
        {"mode": k + 1, "part": part, "energy": kind, "share": float(shares[k])}
        for kind, parts in (("kinetic", modes.kinetic), ("strain", modes.strain))
        for part, shares in parts.items()
        for k in range(min(shown, len(modes.frequencies)))
        if shares[k] >= 1e-3
    ]
    found.data("energy", energy)
    found.data("levels", level_rows(modes))
    if modes.campbell is not None:
        rows: list[Record] = [
            {"speed of the rotor [rpm]": float(speed) * RPM}
            | {f"mode {k + 1} [Hz]": float(one) for k, one in enumerate(row[:shown])}
            for speed, row in zip(modes.campbell.speeds, modes.campbell.frequencies, strict=True)
        ]
        found.data("campbell", rows)
    if modes.speeds is not None:
        found.data("crossings", [crossing_row(one, modes) for one in excited(modes)])
        found.data("register", register_rows(modes))
    if modes.bearing_defects:
        found.data("bearing defects", defect_rows(modes))
        if fitted := [one.name for one in modes.bearing_defects if one.insides]:
            found.note(
                f"The page of {', '.join(fitted)} does not print what is inside: defect "
                "frequencies are those of the middle of all insides that fit it, and the table has "
                "their range."
            )


def _check_energy(found: Findings, modes: Modes) -> None:
    """Check that the parts' shares are all of the energy, kinetic and strain."""
    sums = np.array([sum(parts.values()) for parts in (modes.kinetic, modes.strain)])
    found.vanishes(
        "energy that no part of the drivetrain has, largest share of a mode",
        float(np.abs(sums - 1.0).max(initial=0.0)),
        within=ROUND_OFF,
        why="round-off: modes of unit mass, whose strain energy is their kinetic energy",
        source="Rayleigh's quotient of each mode",
        basis="self-consistency",
    )


def _notes(found: Findings, machine: Machine, modes: Modes) -> None:
    """State what limits the answer."""
    if machine.not_given:
        found.note(
            "Bodies only turn here: the file does not state what finer levels need, "
            f"{', '.join(machine.not_given)}."
        )
    if modes.speeds is None:
        found.note(
            "No range of speeds of operation is known: give operation.rotor_speed, or `speeds`; "
            "excitations are left out."
        )
    toothless = [k for k, stage in enumerate(machine.stages, start=1) if stage.teeth is None]
    if toothless and modes.speeds is not None:
        names = " and ".join(f"stage {k}" for k in toothless)
        found.note(f"Meshes of {names} excite, but are left out: no teeth are given.")
    found.note("The rotor is one rigid body: modes of blades and tower are not in these.")
    if modes.level is not Level.TORSIONAL:
        found.note(
            "Gyroscopic terms are those of all spinning bodies but planets on their carriers, and "
            "carriers stand at one azimuth."
        )


def _key_figures(found: Findings, modes: Modes) -> list[KeyFigure]:
    """What answers first."""
    first, figures = modes.torsional, []
    if first is not None:
        figures.append(_frequency(found, FIRST.partition(" [")[0]))
    if first != 0:
        figures.append(_frequency(found, "mode 1", f"lowest frequency, {modes.kinds[0]}"))
    if modes.speeds is not None:
        figures += _in_operation(found, modes)
    change = _change(modes)
    if change is not None and modes.speed is not None and change > 0.01:
        name = f"largest change of a frequency at {modes.speed * RPM:.4g} rpm [%]"
        figures.append(found.value(name, change))
    figures += _of_levels(found, modes)
    below = int((modes.frequencies < LOW).sum())
    figures.append(found.value(f"modes below {LOW:g} Hz", below))
    figures.append(found.value("modes of the model", len(modes.frequencies)))
    return figures[:6]


def _frequency(found: Findings, quantity: str, name: str = "") -> KeyFigure:
    """A frequency as a key figure; a band below the digits that are shown is left to the table."""
    figure = found.judged(quantity, name)
    small = figure.band is not None and figure.band < SMALL * figure.value
    return figure.model_copy(update={"band": None}) if small else figure


def _in_operation(found: Findings, modes: Modes) -> list[KeyFigure]:
    """How many crossings matter, and how far the first torsional mode is from blade passing."""
    figures = [
        found.value(
            "crossings that can be excited",
            len(modes.resonances),
            beside=sum(one.margin == 0.0 for one in modes.meetings),
            by="all crossings",
        )
    ]
    of_rotor = [one.name for one in modes.excitations if one.at == ("rotor",)][:JUDGED]
    margins = [
        one.margin
        for one in modes.meetings
        if modes.torsional is not None
        and one.mode == modes.torsional + 1
        and one.excitation in of_rotor
    ]
    if margins:
        name = f"margin of the first torsional mode to {', '.join(of_rotor)} [%]"
        margin = 100.0 * min(margins)
        figures.append(found.value(name, margin, at_least=100.0 * NEAR, by="margin asked for"))
    return figures


def _change(modes: Modes) -> float | None:
    """Largest change of one of the first ten frequencies as the rotor turns [%]."""
    if modes.speed is None:
        return None
    parts = np.abs(modes.running[:10] / modes.frequencies[:10] - 1.0)
    return 100.0 * float(np.nanmax(parts, initial=0.0))


def _of_levels(found: Findings, modes: Modes) -> list[KeyFigure]:
    """How far simpler levels are from the finest in the first torsional frequency."""
    if FIRST not in modes.enough or len(modes.ladder) < 2:
        return []
    best, figures = modes.ladder[-1].values[FIRST], []
    for answer in modes.ladder[:-1]:
        value = answer.values[FIRST]
        if value is not None and best is not None:
            error = 100.0 * abs(value / best - 1.0)
            if error < LEAST_ERROR:
                continue
            words = f"error of the level {answer.name} in that frequency [%]"
            limit = 100.0 * modes.tolerance
            figures.append(found.value(words, error, beside=limit, by="tolerance"))
    return figures


def _verdict(modes: Modes, first: KeyFigure) -> str:
    """Say where the first mode is, and what meets modes in operation."""
    which = "lowest" if modes.torsional is None else "first torsional"
    begins = f"The {which} mode is at {formatted(first.value, 4)}\u00a0Hz"
    if modes.speeds is None:
        if modes.torsional in (None, 0):
            return f"{begins}; without speeds of operation nothing is known of excitations."
        lowest = f"{formatted(float(modes.frequencies[0]), 4)}\u00a0Hz"
        return f"{begins}, the lowest, {modes.kinds[0]}, at {lowest}; no speeds of operation known."
    low, high = (formatted(speed * RPM, 3) for speed in modes.speeds)
    over = f"from {low} to {high}\u00a0rpm"
    met = modes.resonances
    if not met:
        return f"{begins}; {over} no excitation meets a mode that it can drive."
    at = "always" if met[0].crossing == np.inf else f"at {met[0].crossing * RPM:.3g}\u00a0rpm"
    if len(met) == 1:
        return f"{begins}; {over} one crossing can be excited, {met[0].excitation} {at}."
    count = f"{len(met)} crossings can be excited"
    return f"{begins}; {over} {count}, strongest {met[0].excitation} {at}."
