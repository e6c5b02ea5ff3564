"""Rows of tables that the cases of gears have in common."""

from math import degrees

from fe_drivetrain.gear import IsoStiffness, Pair
from fe_drivetrain.report.suite import Record


def mesh_row(name: str, pair: Pair) -> Record:
    """Angle and contact ratios of a mesh."""
    return {
        "mesh": name,
        "working angle [deg]": degrees(pair.working_angle),
        "contact ratio": pair.transverse_ratio,
        "overlap ratio": pair.overlap_ratio,
    }


def stiffness_row(found: IsoStiffness) -> Record:
    """Its stiffness by ISO 6336-1: of one pair of teeth, and of the mesh."""
    return {"c' [N/(mm µm)]": found.single / 1e9, "c_gamma [N/(mm µm)]": found.mesh / 1e9}
