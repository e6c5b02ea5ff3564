"""Frequencies at which a defect of a rolling bearing strikes, from its rows and its speeds."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi

from fe_drivetrain.bearing.geometry import Row, count, pitch_ratio

NAMES = ("BPFO", "BPFI", "BSF", "FTF")
"""Defects by the names of condition monitoring: outer ring, inner ring, rolling element, cage."""


@dataclass(frozen=True)
class DefectFrequencies:
    """Frequencies of the defects of one row of a bearing, all positive.

    Attributes
    ----------
    outer : float
        Rolling elements that pass a place of the outer ring, BPFO [Hz].
    inner : float
        Rolling elements that pass a place of the inner ring, BPFI [Hz].
    element : float
        Turns of a rolling element about its axis against the cage, BSF [Hz]. A place on it strikes
        both rings in each turn: twice as often.
    cage : float
        Turns of the cage, FTF, in the frame in which both speeds of the rings are given [Hz].
    """

    outer: float
    inner: float
    element: float
    cage: float

    def by_name(self) -> dict[str, float]:
        """Frequencies [Hz] by the names of condition monitoring, in the order of `NAMES`."""
        return dict(zip(NAMES, (self.outer, self.inner, self.element, self.cage), strict=True))


def defect_frequencies(row: Row, inner: float, outer: float = 0.0) -> DefectFrequencies:
    """Frequencies of defects by rolling without slip, at the contact angle without load.

    Parameters
    ----------
    row : RollerRow or BallRow
        Row of rolling elements.
    inner, outer : float
        Speeds of both rings about the same axis, with their signs, in any frame [rad/s]. Of a
        planet's bearing in the frame of its carrier: 0 of the ring on the pin.

    Returns
    -------
    frequencies : DefectFrequencies
        BPFO and BPFI are, in sum, the number of elements times the relative speed of the rings.

    Notes
    -----
    With gamma = D cos(alpha) / D_pw the cage turns at (1 - gamma) / 2 of the inner ring's speed
    and (1 + gamma) / 2 of the outer ring's; an element turns against the cage D_pw / (2 D)
    (1 - gamma^2) times as fast as one ring against the other. Real bearings slip by 1 % or 2 %.
    """
    gamma, elements = pitch_ratio(row), count(row)
    cage = 0.5 * ((1.0 - gamma) * inner + (1.0 + gamma) * outer)
    spin = row.radius / row.diameter * (1.0 - gamma**2) * (inner - outer)
    turns = (elements * (outer - cage), elements * (inner - cage), spin, cage)
    return DefectFrequencies(*(abs(speed) / (2.0 * pi) for speed in turns))
