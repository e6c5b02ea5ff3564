"""A statement of Al-Hamadani 2018, chapter 7.2, and how it is held against what stands here."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from fe_drivetrain.cases.dynamics.two_mw_damage import Shares
from fe_drivetrain.cases.dynamics.two_mw_guesses import planet_pins
from fe_drivetrain.cases.dynamics.two_mw_loads import Change, Rolling
from fe_drivetrain.cases.dynamics.two_mw_machine import Chain
from fe_drivetrain.cases.references.printed_values import Stands
from fe_drivetrain.report.suite import Record

RING, SUN, MIDDLE, FAST = (
    "stage 1 ring-planet",
    "stage 1 sun-planet",
    "stage 2 mesh",
    "stage 3 mesh",
)
MESHES = {RING: "ring and planet", SUN: "sun and planet", MIDDLE: "intermediate", FAST: "fast"}
MORE = {RING: 1.27, SUN: 1.12, MIDDLE: 1.31, FAST: 1.37}
"""Largest force of a mesh in the shutdown over that in normal operation, Figure 7.15."""

STRESSES = {RING: 2.32, SUN: 1.32, MIDDLE: 1.22}
"""Contact stress of the fast stage over that of others in normal operation, Figure 7.19."""

UPWIND = (1.20, 1.13, 1.05)
"""Upwind over downwind bearing of planets A, B, C in the shutdown, Figure 7.17."""

RANGE = (202.0, 302.0)
"""Circumferential force of ring and planet in normal operation [kN], Figure 7.14."""


@dataclass(frozen=True, eq=False)
class Computed:
    """All that statements are held against.

    Attributes
    ----------
    chain : Chain
        The machine in both states.
    meshes, bearings : Mapping[str, Change]
        Largest loads.
    stress : Mapping[str, tuple of float]
        Contact stress of meshes, normal and in the shutdown [Pa].
    depth : Mapping[str, float]
        Depth of the largest shear of meshes in normal operation [m].
    rollers : Mapping[str, tuple of Rolling]
        Rollers of bearings.
    bearing_depths : tuple of float
        Least and largest depth below races [m].
    moved : sequence of Record
        Results with each guess changed, see `moved_by`.
    rolls : sequence of Record
        Rollers of a planet bearing by size and clearance, see `of_rollers`.
    shares : Shares or None
        Damage; None where it was not counted.
    """

    chain: Chain
    meshes: Mapping[str, Change]
    bearings: Mapping[str, Change]
    stress: Mapping[str, tuple[float, float]]
    depth: Mapping[str, float]
    rollers: Mapping[str, tuple[Rolling, Rolling]]
    bearing_depths: tuple[float, float]
    moved: Sequence[Record]
    rolls: Sequence[Record]
    shares: Shares | None

    @property
    def pins(self) -> tuple[list[str], list[str]]:
        """Upwind and downwind planet bearings."""
        found = planet_pins(self.chain)
        assert found is not None
        return found


@dataclass(frozen=True)
class Statement:
    """A statement of the thesis and what stands here.

    Attributes
    ----------
    figure, words, printed : str
        Where, what, and its numbers.
    ours, stands, reason : str
        What stands here, whether it holds, and why.
    """

    figure: str
    words: str
    printed: str
    ours: str
    stands: Stands
    reason: str

    @property
    def row(self) -> Record:
        """A row of a table."""
        return {
            "figure": self.figure,
            "statement": self.words,
            "printed": self.printed,
            "ours": self.ours,
            "verdict": self.stands,
            "reason": self.reason,
        }


def of_guesses(span: tuple[float, float]) -> str:
    """What guesses do to a number, in words."""
    return f"{span[0]:.2f} to {span[1]:.2f} with one guess changed"
