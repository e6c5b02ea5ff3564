"""Torsional stiffness of uniform shafts by finite elements, for published main shafts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.compare import GridConvergence, grid_convergence
from fe_drivetrain.scene import Material
from fe_drivetrain.validation.shaft_theory import parabola_shortfall
from fe_drivetrain.validation.solid_shafts import solid, straight, twist

POISSON = 0.3
"""Assumed: in torsion it has no part."""


@dataclass(frozen=True)
class TwistedTube:
    """Torsional stiffness of a uniform shaft on three meshes.

    Attributes
    ----------
    series : GridConvergence
        Of the stiffness [N m/rad].
    per_turn, unknowns : int
        Elements round the axis of the finest mesh, and its number of unknowns.
    """

    series: GridConvergence
    per_turn: int
    unknowns: int

    @property
    def stiffness(self) -> float:
        """Of the finest mesh [N m/rad]."""
        return self.series.finest

    @property
    def band(self) -> float:
        """Half width of the numerical uncertainty of the stiffness [N m/rad]."""
        return self.series.uncertainty

    @property
    def tolerance(self) -> float:
        """Twice the relative deficit of J that comes of parabolas in place of the circle."""
        return 2 * 4 * parabola_shortfall(self.per_turn)

    @property
    def reason(self) -> str:
        """Why `tolerance` is what it is."""
        return (
            f"{self.per_turn} parabolic arcs round a turn: J is {self.tolerance / 2:.1g} too "
            "low by their formula; twice that is allowed"
        )


def material_of(shear_modulus: float, density: float = 7800.0) -> Material:
    """A material of a given shear modulus.

    Parameters
    ----------
    shear_modulus : float
        G [Pa].
    density : float
        [kg/m^3].

    Returns
    -------
    material : Material
        With Poisson's ratio `POISSON`.
    """
    E = 2 * (1 + POISSON) * shear_modulus
    return Material(youngs_modulus=E, poisson_ratio=POISSON, density=density)


def twisted_tube(
    outer: float, inner: float, length: float, shear_modulus: float, quick: bool = False
) -> TwistedTube:
    """Twist a tube, or a solid shaft, between rigid ends.

    Parameters
    ----------
    outer, inner : float
        Diameters [m]; inner 0 where solid.
    length : float
        [m].
    shear_modulus : float
        G [Pa].
    quick : bool
        Eight elements round the axis of the coarsest mesh instead of twelve.

    Returns
    -------
    found : TwistedTube
        Its stiffness on three meshes.
    """
    material = material_of(shear_modulus)
    stiffnesses, turns = [], []
    for refinement in (1, 2, 3):
        # the angle is linear along the axis, and elements hold that at any length
        mesh = solid(
            straight((0.0, length), outer, inner),
            refinement,
            base_turn=8 if quick else 12,
            size=length,
        )
        stiffnesses.append(twist(mesh, material)[1])
        turns.append(mesh.per_turn)
    series = grid_convergence(1.0 / np.array(turns), stiffnesses, expected_order=4.0)
    return TwistedTube(series, turns[-1], mesh.n_unknowns)
