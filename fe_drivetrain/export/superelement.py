"""A condensed model as other programs take it: matrices at points, and where they come from."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.scaling import min_eigenvalue, symmetry_error
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.common.spatial import point_motions
from fe_drivetrain.common.stiffness_bands import StiffnessBands
from fe_drivetrain.plots.figures import stiffness_map

FRAME = (
    "x downwind along the shaft, z up, y = z cross x; origin at the main bearing's centre where "
    "the scene puts its shaft so"
)
UNITS = "N/m, N, N m/rad; kg, kg m, kg m^2; m, rad"

#: What a matrix may be off: of symmetry, of a rigid motion's forces, of a negative eigenvalue;
#: relative to the largest entry of a unit diagonal.
ALLOWED = 1e-9

#: What a free body may resist a rigid motion with: formats keep ten digits of each term, positions
#: in another unit leave none of the first.
RIGID = 1e-6

#: Any term of a matrix [N/m, kg and their like]: products of larger ones overflow.
LARGEST = 1e30

#: Any coordinate of a point [m]: no drivetrain is that long.
FARTHEST = 100.0


def refuse_one_point(part: str, at: Sequence[str], points: Sequence[str], held: str) -> None:
    """Refuse a free body at one point, where no motion strains it: all its stiffness is round-off.

    Parameters
    ----------
    part : str
        What it is, for the message.
    at, points : Sequence[str]
        Points that are kept, and all there are.
    held : str
        What has its supports: the name that asks for it.

    Raises
    ------
    InputError
    """
    if len(at) != 1 or at[0] not in points:
        return
    others = [name for name in points if name != at[0]]
    raise InputError(
        f"a free {part} has no stiffness at one point, {at[0]}, for nothing holds it: add a point "
        f"to {argument('at')} ({', '.join(others)}), or export it on its supports with "
        f"{argument('what', held)}"
    )


@dataclass(frozen=True)
class Origin:
    """Where the matrices come from.

    Attributes
    ----------
    scene : str
        Title.
    scene_hash : str
        Hash of all values of the scene or component, as results state it.
    level : str
        Level of the ladder, with its name.
    mesh : str
        In words.
    program : str
        Name and version.
    """

    scene: str = ""
    scene_hash: str = ""
    level: str = ""
    mesh: str = ""
    program: str = ""


@dataclass(frozen=True)
class Superelement:
    """Stiffness and mass of a model at n reference points.

    Attributes
    ----------
    name : str
        Letters, digits and "_": other programs know it by that.
    points : tuple[str, ...]
        Names of the n points.
    positions : Floats
        (n, 3) [m], in `FRAME`.
    stiffness : Floats
        (6 n, 6 n), symmetric: `components.MOTIONS` of each point to forces and moments there.
    mass : Floats or None
        (6 n, 6 n), symmetric; None where there is none.
    supported : bool
        Whether the scene's supports are in it; else it is free, and has six rigid motions.
    band : StiffnessBands or None
        Half widths of the uncertainty of the stiffness, of each kind of motion by itself, relative;
        None where it is not known. Of one number for all, `StiffnessBands.uniform`.
    origin : Origin
        Where it comes from.
    bound, rollers : str
        Bearing units in the stiffness, in words: which of their bounds it has, and whether
        rollers give in it; empty where there are none, or it is not known.
    """

    name: str
    points: tuple[str, ...]
    positions: Floats
    stiffness: Floats
    mass: Floats | None = None
    supported: bool = False
    band: StiffnessBands | None = None
    origin: Origin = field(default_factory=Origin)
    bound: str = ""
    rollers: str = ""

    __repr__ = short_repr

    def __post_init__(self) -> None:
        """Refuse what is no superelement.

        Raises
        ------
        InputError
            A shape is wrong, a value is not finite, a position is none of a drivetrain's in metres,
            a matrix is not symmetric or has a negative eigenvalue, or the stiffness of a free body
            resists a rigid motion.
        """
        n = len(self.points)
        if not self.name.replace("_", "").isalnum() or not self.name[0].isalpha():
            raise InputError(
                f"superelement {self.name!r} must have a name of letters, digits and '_' that "
                "begins with a letter: rename it"
            )
        if n == 0 or len(set(self.points)) < n or np.shape(self.positions) != (n, 3):
            raise InputError(
                f"superelement {self.name!r} has positions of shape {np.shape(self.positions)} for "
                f"the points {', '.join(self.points) or 'none'}: give each point once, with x, y, z"
            )
        self._check_positions()
        if self.band is not None and not self.band.are_numbers:
            raise InputError(
                f"superelement {self.name!r}: its band is {self.band}, of which each must be from "
                "0 on and finite, relative to the stiffness: correct it, or leave it open"
            )
        for kind, matrix in (("stiffness", self.stiffness), ("mass", self.mass)):
            if matrix is None:
                continue
            if np.shape(matrix) != (6 * n, 6 * n) or not (np.abs(matrix) <= LARGEST).all():
                raise InputError(
                    f"superelement {self.name!r}: its {kind} of shape {np.shape(matrix)} must be "
                    f"({6 * n}, {6 * n}) and finite, at most {LARGEST:g}: six degrees of freedom "
                    f"for each of {n} points"
                )
            asymmetry, least = symmetry_error(matrix), min_eigenvalue(matrix)
            if asymmetry > ALLOWED or least < -ALLOWED:
                fault = (
                    f"is not symmetric, by {asymmetry:.2g} of its diagonal"
                    if asymmetry > ALLOWED
                    else f"has a negative eigenvalue, {least:.2g} of its diagonal"
                )
                raise InputError(
                    f"superelement {self.name!r}: its {kind} {fault}: check its source"
                )
        if n > 1 and not self.supported and (error := self.rigid_error()) > RIGID:
            raise InputError(
                f"superelement {self.name!r}: it is free, but its stiffness resists a rigid motion "
                f"with {error:.2g} of its terms, which must be at most {RIGID:g}: check that "
                "positions are in metres, in the order of the points, or that it has supports"
            )

    def _check_positions(self) -> None:
        for point, position in zip(self.points, self.positions, strict=True):
            if not np.abs(position).max() <= FARTHEST:  # nor is a number that is none
                place = ", ".join(f"{value:g}" for value in position)
                raise InputError(
                    f"superelement {self.name!r}: the position of {point} is ({place}) but must be "
                    f"finite and within {FARTHEST:g} m of the origin: give metres"
                )

    @property
    def of_units(self) -> dict[str, str]:
        """What is stated of its bearing units, by name; empty where nothing is."""
        stated = {"bound": self.bound, "rollers": self.rollers}
        return {key: " ".join(text.split()) for key, text in stated.items() if text}

    @property
    def rigid_motions(self) -> Floats:
        """(6 n, 6) unit motions of the whole about the first point."""
        return point_motions(self.positions, self.positions[0])

    def plot(self) -> Any:
        """The stiffness and its couplings, as a Plotly figure.

        Returns
        -------
        plotly.graph_objects.Figure
            See `fe_drivetrain.plots.stiffness_map`.
        """
        return stiffness_map(self.points, self.stiffness, self.name)

    def rigid_error(self) -> float:
        """Largest force against a rigid motion, of those that its terms would have one by one."""
        R = self.rigid_motions
        one_by_one = (np.abs(self.stiffness) @ np.abs(R)).max()
        return float(np.abs(self.stiffness @ R).max() / one_by_one) if one_by_one else 0.0

    def inertia(self) -> Floats | None:
        """(6, 6) mass matrix of its rigid motions about the first point; None without mass."""
        return None if self.mass is None else self.rigid_motions.T @ self.mass @ self.rigid_motions

    def checks(self) -> dict[str, float]:
        """What a reader can check, by name."""
        found = {
            "asymmetry": symmetry_error(self.stiffness),
            "least eigenvalue": min_eigenvalue(self.stiffness),
        }
        if not self.supported:
            found["force against rigid motions"] = self.rigid_error()
        return found
