"""Orders of gear meshes: how often teeth meet in a turn of the rotor, and where a mode is met."""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Protocol

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.strict_yaml import shown


class Geared(Protocol):
    """A gear stage: its teeth, the ring's or the gear's first, and speed out over speed in."""

    @property
    def kind(self) -> str:
        """Either "planetary" or "parallel"."""

    @property
    def teeth(self) -> tuple[int, ...] | None:
        """Numbers of teeth, from the largest gear on; the last are those of the output."""

    @property
    def speed_ratio(self) -> float:
        """Speed of the output over that of the input."""


@dataclass(frozen=True)
class Toothed:
    """A stage of which only kind and teeth are known.

    Attributes
    ----------
    kind : str
        "planetary", with its ring standing and driven by its carrier, or "parallel".
    teeth : tuple of int
        Teeth of ring and sun, or of gear and pinion.
    """

    kind: str
    teeth: tuple[int, int]

    def __post_init__(self) -> None:
        if self.kind not in ("planetary", "parallel"):
            raise InputError(
                f"kind of a stage is {shown(self.kind)} but must be planetary or parallel: change "
                "it"
            )
        if not all(isinstance(z, int) and not isinstance(z, bool) and z > 0 for z in self.teeth):
            raise InputError(
                f"teeth of a stage are {shown(self.teeth)} but must be whole numbers above 0: "
                "correct them"
            )

    @property
    def speed_ratio(self) -> float:
        """Speed of the sun over the carrier's, or of the pinion over the gear's."""
        large, small = self.teeth
        return (1.0 if self.kind == "planetary" else 0.0) + large / small


def mesh_orders(stages: Iterable[Geared]) -> dict[str, float]:
    """Mesh frequencies over the rotor's, of stages from the rotor on.

    A planetary stage with its ring standing has z_ring times the speed of its carrier, a parallel
    one z_gear times that of its gear. (Al-Hamadani 2018, Table 4.8, has the sun's teeth times its
    absolute speed, z_ring + z_sun, which counts the turning of the carrier too.)

    Parameters
    ----------
    stages : iterable of Geared
        Rows of a gear table, of a machine, or `Toothed`.

    Returns
    -------
    dict
        Orders by "stage 1" and so on; stages without teeth are left out.
    """
    return _orders(stages, absolute=False)


def absolute_sun_orders(stages: Iterable[Geared]) -> dict[str, float]:
    """Orders of Table 4.8 of Al-Hamadani 2018, with z_ring + z_sun in planetary stages: wrong."""
    return _orders(stages, absolute=True)


def _orders(stages: Iterable[Geared], absolute: bool) -> dict[str, float]:
    found, speed = {}, 1.0
    for number, stage in enumerate(stages, start=1):
        if stage.teeth:
            beside = stage.teeth[-1] if absolute and stage.kind == "planetary" else 0
            found[f"stage {number}"] = (stage.teeth[0] + beside) * speed
        speed *= stage.speed_ratio
    return found


def crossing_speed(frequency: float, order: float) -> float:
    """Speed of the rotor at which an order has a frequency, 2 pi f / order [rad/s].

    Parameters
    ----------
    frequency : float
        Frequency [Hz].
    order : float
        Periods in a turn of the rotor.
    """
    return 2.0 * math.pi * frequency / order
