"""What is known of the whirl of a shaft, as findings, charts and page read it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.dynamics.whirl.modes import Critical, WhirlChart
from fe_drivetrain.dynamics.whirl.unbalance import UnbalanceResponse

EXCITED = 0.01
"""Least share of forward whirl in a critical that unbalance excites: pure backward whirl takes no
power of a force that turns forward."""


@dataclass(frozen=True)
class Rung:
    """First critical at a level of the model.

    Attributes
    ----------
    name : str
        Name of the level.
    degrees : int
        Degrees of freedom.
    speed : float or None
        First critical that unbalance excites [rad/s]; None where there is none.
    seconds : float
        Processor time of model and criticals [s].
    """

    name: str
    degrees: int
    speed: float | None
    seconds: float


@dataclass(frozen=True, eq=False, kw_only=True)
class ShaftWhirl:
    """Whirl of one shaft of a drivetrain.

    Attributes
    ----------
    name : str
        Name of the shaft.
    ratio : float
        Speed over the rotor's, without its sign.
    range : tuple of float
        Least and largest speed in operation [rad/s].
    limit : float
        Highest speed that was looked at [rad/s].
    criticals : tuple of Critical
        Critical speeds by one eigenproblem.
    bands : Floats
        Half widths of what the number of elements leaves open of each [rad/s]; NaN where unknown.
    crossings : tuple of Critical
        The same where the Campbell diagram crosses once a turn.
    chart : WhirlChart
        Modes over the speed.
    damped : bool
        Whether damping is stated.
    unstable_from : float or None
        Speed from which a whirl grows [rad/s]; None where none does up to the limit.
    response : UnbalanceResponse
        Steady whirl by unbalance; its first speed is the largest of operation.
    bearings : tuple of str
        Names of what holds it.
    without_meshes : float or None
        First critical that unbalance excites without gear meshes [rad/s].
    in_drivetrain : float or None
        First critical by its unbalance in the whole drivetrain, where neighbours move and masses
        are lumped at nodes [rad/s]; None where there is none that is mostly its own, or where its
        bearings change with the speed.
    ladder : tuple of Rung
        The first critical at each level of the model.
    nodes : int
        Number of nodes.
    """

    name: str
    ratio: float
    range: tuple[float, float]
    limit: float
    criticals: tuple[Critical, ...] = field(repr=False)
    bands: Floats = field(repr=False)
    crossings: tuple[Critical, ...] = field(repr=False)
    chart: WhirlChart = field(repr=False)
    damped: bool
    unstable_from: float | None
    response: UnbalanceResponse = field(repr=False)
    bearings: tuple[str, ...]
    without_meshes: float | None
    in_drivetrain: float | None
    ladder: tuple[Rung, ...] = field(repr=False)
    nodes: int

    @property
    def first(self) -> Critical | None:
        """First critical that unbalance excites."""
        return excited_critical(self.criticals)

    @property
    def margin(self) -> float:
        """Least distance of a critical that unbalance excites from operation, over its speed."""
        low, high = self.range
        apart = [
            max(low - one.speed, one.speed - high, 0.0) / one.speed
            for one in self.criticals
            if is_excited(one)
        ]
        return min(apart, default=math.inf)


def is_excited(critical: Critical) -> bool:
    """Whether unbalance excites a critical: some of its whirl is forward."""
    return (1.0 + critical.sense) / 2.0 >= EXCITED


def excited_critical(criticals: Sequence[Critical]) -> Critical | None:
    """The first critical that unbalance excites, of criticals by speed; None where none is."""
    return next((one for one in criticals if is_excited(one)), None)
