"""Load steps of a bearing, shared by its laminae."""

from __future__ import annotations

from dataclasses import dataclass

from fe_drivetrain.common.arrays import Bools, Floats
from fe_drivetrain.common.short_repr import short_repr


@dataclass(frozen=True, eq=False)
class Steps:
    """Load steps of a bearing.

    Attributes
    ----------
    loads : Floats
        (n, 5) on the inner ring [N, N m].
    laminae : tuple of Floats
        For each row (n, elements, laminae) loads [N]; of balls one lamina.
    speed_rpm : Floats
        (n,) of the turning ring against the other [1/min].
    seconds : Floats
        (n,) how long each lasts.
    converged : Bools
        (n,) whether the loads of laminae balance those of the ring.
    """

    loads: Floats
    laminae: tuple[Floats, ...]
    speed_rpm: Floats
    seconds: Floats
    converged: Bools

    __repr__ = short_repr
