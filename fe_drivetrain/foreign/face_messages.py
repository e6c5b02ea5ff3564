"""Words of several modules' messages about faces."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

ROUND = 1e-4
"""Deviation over the radius beyond which a face is no cylinder or sphere."""


def nearly(face: Mapping[str, Any]) -> str:
    """Name a surface that a face nearly is, with its deviation.

    Parameters
    ----------
    face : Mapping
        Face from `fe_drivetrain.foreign.step_fit.recognised`, with "nearly".
    """
    off, radius = face["off"], face["nearly"]
    x, y, z = face["middle"]
    return (
        f"a {face['described']} round ({x:.4g}, {y:.4g}, {z:.4g}) mm that deviates {off:.3g} mm "
        f"from a {face['shape']} of radius {radius:.7g} mm, {off / radius:.2g} of the radius, "
        f"where at most {ROUND:g} is taken for one"
    )
