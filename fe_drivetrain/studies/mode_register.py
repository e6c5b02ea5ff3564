"""Register of a drivetrain's excitations: how far each stays from the modes that it can drive."""

from __future__ import annotations

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import RPM
from fe_drivetrain.procedure import Excitation, Meeting
from fe_drivetrain.procedure.resonance import NEAR
from fe_drivetrain.report.charts import chart, trace
from fe_drivetrain.report.results import Chart
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.studies.mode_record import Modes

SPEEDS = 121
"""Speeds of the range at which margins are drawn."""

DRAWN = 6
"""Excitations whose margins are drawn, the nearest first."""

FARTHEST = 1.0
"""Margin beyond which a curve is cut off."""


def nearest_meetings(modes: Modes) -> dict[str, Meeting | None]:
    """By excitation its meeting of the least margin with a mode that it can drive, or None.

    Defects of bearings are among them.
    Where margins are equal, as with several crossings, it is that with most of the mode's energy.

    Parameters
    ----------
    modes : Modes
        With speeds of operation.
    """
    known = (*modes.excitations, *modes.defects)
    found: dict[str, Meeting | None] = {one.name: None for one in known}
    for one in (*modes.meetings, *modes.defect_meetings):
        nearest = found[one.excitation]
        if one.verdict == "not excited":
            continue
        if nearest is None or (one.margin, -one.share) < (nearest.margin, -nearest.share):
            found[one.excitation] = one
    return found


def register_rows(modes: Modes) -> list[Record]:
    """Each excitation over the range of speeds, with the mode that it can drive next to it.

    Parameters
    ----------
    modes : Modes
        With speeds of operation.

    Returns
    -------
    rows : list of Record
        First all that acts in operation, then what defects of bearings would excite.
    """
    if modes.speeds is None:
        return []
    low, high = modes.speeds
    nearest = nearest_meetings(modes)
    meetings = (*modes.meetings, *modes.defect_meetings)
    defects = {one.name for one in modes.defects}
    rows: list[Record] = []
    for one in (*modes.excitations, *modes.defects):
        row: Record = {
            "excitation": one.name,
            "acts": "with a defect" if one.name in defects else "always",
            "periods in a turn of the rotor": one.per_turn or None,
            "at the least speed [Hz]": one.frequency(low),
            "at the largest speed [Hz]": one.frequency(high),
        }
        met = nearest[one.name]
        if met is None:
            rest: Record = dict.fromkeys(_OF_MODE, None)
            rows.append({**row, **rest, "crossings": 0, "verdict": "drives no mode"})
            continue
        crossings = sum(m.excitation == one.name and m.verdict == "resonance" for m in meetings)
        of_mode = (
            met.mode,
            modes.kinds[met.mode - 1],
            met.frequency,
            None if met.crossing == np.inf else met.crossing * RPM,
            100.0 * met.share,
            100.0 * met.margin,
        )
        rows.append(
            {
                **row,
                **dict(zip(_OF_MODE, of_mode, strict=True)),
                "crossings": crossings,
                "verdict": met.verdict,
            }
        )
    return rows


_OF_MODE = (
    "nearest mode",
    "kind",
    "its frequency [Hz]",
    "they meet at [rpm]",
    "share of its energy [%]",
    "least margin [%]",
)


def defect_rows(modes: Modes) -> list[Record]:
    """Defect frequencies of each bearing, per turn of the rotor and at the largest speed.

    Parameters
    ----------
    modes : Modes
        With defects of its bearings.
    """
    rows: list[Record] = []
    for one in modes.bearing_defects:
        row: Record = {
            "bearing": one.name,
            "catalogue entry": one.entry,
            "rows": one.rows,
            "elements of a row": one.elements,
            "speed of a ring over the rotor's": one.speed_ratio,
        }
        kinds = one.per_turn.by_name()
        row |= {f"{kind} in a turn of the rotor": value for kind, value in kinds.items()}
        if modes.speeds is not None:
            turns = modes.speeds[1] / (2.0 * np.pi)
            row |= {f"{kind} [Hz]": turns * value for kind, value in kinds.items()}
        if any(other.insides for other in modes.bearing_defects):
            for kind in kinds:
                low, high = one.ends(kind) or (None, None)
                row[f"{kind} in a turn, least of all insides"] = low
                row[f"{kind} in a turn, most of all insides"] = high
        rows.append(row)
    return rows


def margins_of(excitation: Excitation, modes: Modes, speeds: Floats) -> Floats:
    """(s,) distance of an excitation from the nearest mode that it can drive, over its frequency.

    Infinite where it can drive none.

    Parameters
    ----------
    excitation : Excitation
        Excitation of the register.
    modes : Modes
        With speeds of operation.
    speeds : ndarray, (s,)
        Speeds of the rotor [rad/s].
    """
    driven = [
        one.frequency
        for one in modes.meetings
        if one.excitation == excitation.name and one.verdict != "not excited"
    ]
    at = np.array([excitation.frequency(float(speed)) for speed in speeds])
    apart = np.abs(at[:, None] / np.array(driven or [np.nan]) - 1.0)
    return np.asarray(apart.min(axis=1) if driven else np.full(len(speeds), np.inf))


def margin_chart(modes: Modes) -> Chart | None:
    """Margins over the speed of the rotor, of the excitations that come nearest; None of none.

    Parameters
    ----------
    modes : Modes
        With speeds of operation.
    """
    if modes.speeds is None:
        return None
    acting = {one.name for one in modes.excitations}
    nearest = nearest_meetings(modes)
    near = [
        one for name, one in nearest.items() if one and name in acting and one.margin < FARTHEST
    ]
    near.sort(key=lambda one: (one.margin, -one.share))
    names = [one.excitation for one in near[:DRAWN]]
    if not names:
        return None
    speeds = np.linspace(*modes.speeds, SPEEDS)
    curves = [
        trace(one.name, speeds * RPM, 100.0 * margins_of(one, modes, speeds).clip(max=FARTHEST))
        for one in modes.excitations
        if one.name in names
    ]
    ends = np.array(modes.speeds) * RPM
    curves.append(trace("margin asked for", ends, np.full(2, 100.0 * NEAR), line={"dash": "dot"}))
    return chart(
        "Margin of excitations to the modes that they can drive, over the speed of the rotor, the "
        f"{len(names)} nearest of {len(modes.excitations)}",
        curves,
        "speed of the rotor [rpm]",
        "margin [%]",
    )
