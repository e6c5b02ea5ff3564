"""Where hub loads enter a shaft, and which point those are about that do not say so themselves."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Entrance:
    """Where loads enter a scene, as all that is solved of it takes along.

    Attributes
    ----------
    front : float
        x of the shaft's front face, where hub loads enter [m].
    loads_at : float
        x of the point that hub loads are about which name none, as those of files [m].
    points : tuple of str
        Names of the load points.
    weights : tuple of float
        Weights of these, along -z [N].
    """

    front: float
    loads_at: float
    points: tuple[str, ...] = ()
    weights: tuple[float, ...] = ()

    @property
    def elsewhere(self) -> bool:
        """Whether hub loads are stated to be about another point than the one they enter at."""
        return self.loads_at != self.front


AT_HUB = Entrance(0.0, 0.0)
"""Entrance of a body without a scene: loads are about the point "hub", where they enter."""
