"""What makes the operating clearance of a bearing, as rows of a table."""

from __future__ import annotations

from fe_drivetrain.bearing.operating_clearance import Band, OperatingClearance
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.report.suite.records import Record

_GROWS = 1e-6  # m in each metre between two bearings: what is less is nothing beside a clearance


def clearance_parts(name: str, found: OperatingClearance) -> list[Record]:
    """Contributions to a radial clearance, their sum, its probable range, and what fits press.

    Parameters
    ----------
    name : str
        Name of the bearing.
    found : OperatingClearance
        Its clearance.
    """
    rows = [_row(name, part, band, 1e6, "µm") for part, band in found.parts.items()]
    rows.append(_row(name, "radial clearance in operation", found.radial, 1e6, "µm"))
    probable = Band(found.probable.low, found.radial.mean, found.probable.high)
    rows.append(_row(name, "its probable range, tolerances as squares", probable, 1e6, "µm"))
    for ring, band in found.pressures.items():
        rows.append(_row(name, f"pressure on the seat of the {ring}", band, 1e-6, "MPa"))
    if "inner ring" in found.pressures:
        stress = found.hoop_stress
        rows.append(_row(name, "hoop stress in its bore by that", stress, 1e-6, "MPa"))
    return rows


def state_clearance(found: Findings, name: str, clearance: OperatingClearance) -> None:
    """State an operating clearance with its band, what it assumes, and a ring without pressure.

    Parameters
    ----------
    found : Findings
        Takes the figure, assumptions and notes.
    name : str
        Name of the bearing.
    clearance : OperatingClearance
        Its clearance.
    """
    radial = clearance.radial
    band = max(radial.most - radial.mean, radial.mean - radial.least)
    found.found(
        f"radial clearance of bearing {name} in operation [µm]", 1e6 * radial.mean, 1e6 * band
    )
    for text in clearance.assumed:
        found.assume(f"{name}: mounting", text, "", "not stated under its mounting")
    if "inner ring" in clearance.loose:
        found.note(
            f"Bearing {name}: its inner ring may have no pressure on the shaft, and creep under a "
            "load that turns against it: give a tighter fit."
        )
    if abs(growth := clearance.left_out) > _GROWS:
        parts, changes = ("shaft", "housing"), ("less", "more")
        (part, other), (x, o) = (parts, changes) if growth > 0.0 else (parts[::-1], changes[::-1])
        found.note(
            f"Bearing {name} carries axial force one way, as one of a pair. Its {part} grows "
            f"{1e6 * abs(growth):.3g} µm more than its {other} for each metre to the other "
            f"bearing: {x} axial clearance of both together face to face (X), {o} back to "
            "back (O). That is not in its clearance, since the file does not say which: add it to "
            "the clearance that you state."
        )
    meant = clearance.parts.get("mounted")
    if radial.least < 0.0 and (meant is None or meant.mean >= 0.0):
        found.note(
            f"Bearing {name}: with its tolerances at their limits it runs with a preload, "
            f"{-1e6 * radial.least:.0f} µm of radial clearance below zero: give more clearance "
            "before mounting, or a looser fit, unless that is meant."
        )


def _row(name: str, part: str, band: Band, factor: float, unit: str) -> Record:
    return {
        "bearing": name,
        "what": part,
        "unit": unit,
        "least clearance": factor * band.least,
        "mean": factor * band.mean,
        "most clearance": factor * band.most,
    }
