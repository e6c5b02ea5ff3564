"""Torsional stiffness of uniform and of stepped shafts by finite elements."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.cases.references.shaft_theory import parabola_shortfall, within_arcs
from fe_drivetrain.cases.references.solid_shafts import mesh_band, solid, stepped, straight, twist
from fe_drivetrain.comparison import GridConvergence, grid_convergence
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.elasticity.mesh import Grading

POISSON = 0.3
"""Assumed: in torsion it has no part."""


@dataclass(frozen=True)
class TwistedTube:
    """Torsional stiffness of a uniform shaft on three meshes.

    Attributes
    ----------
    series : GridConvergence
        Series of the stiffness [N m/rad].
    per_turn, unknowns : int
        Elements round the axis of the finest mesh, and its number of unknowns.
    """

    series: GridConvergence
    per_turn: int
    unknowns: int

    @property
    def stiffness(self) -> float:
        """Stiffness of the finest mesh [N m/rad]."""
        return self.series.finest

    @property
    def band(self) -> float:
        """Half width of the numerical uncertainty of the stiffness [N m/rad]."""
        return self.series.uncertainty

    @property
    def tolerance(self) -> float:
        """Twice the relative deficit of J that comes of parabolas in place of the circle."""
        return within_arcs(self.per_turn, "J", 4)[0]

    @property
    def reason(self) -> str:
        """Why `tolerance` is what it is."""
        return within_arcs(self.per_turn, "J", 4)[1]


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


@dataclass(frozen=True)
class TwistedStep:
    """What a shaft with one sharp step gives, its ends turned as rigid planes.

    Attributes
    ----------
    stiffness, band : float
        Stiffness with the finest mesh, and half width of its numerical uncertainty [N m/rad].
    tolerance, reason : float, str
        How much that mesh may miss, relative, and why.
    unknowns : int
        Number of unknowns of that mesh.
    """

    stiffness: float
    band: float
    tolerance: float
    reason: str
    unknowns: int


def twisted_step(
    diameters: tuple[float, float],
    length: float,
    bore: float,
    material: Material,
    refinements: Sequence[int],
) -> TwistedStep:
    """Twist a shaft of two parts with a sharp step between them.

    Parameters
    ----------
    diameters : tuple of float
        Diameters of the thick part and of the thin one [m].
    length, bore : float
        Length and bore of each part [m].
    material : Material
        Material of the shaft.
    refinements : sequence of int
        Refinements, coarse first; see `fe_drivetrain.cases.references.solid_shafts.solid`.
    """
    large, small = diameters
    shaft = stepped(diameters, length, bore)
    meshes = [solid(shaft, r, Grading(steps=1), size=length) for r in refinements]
    found = [twist(mesh, material)[1] for mesh in meshes]
    arcs = [4 * parabola_shortfall(mesh.per_turn) for mesh in meshes]
    # without the deficit of parabolas against the circle, which would hide the corner's error
    round_ones = [k / (1 - missed) for k, missed in zip(found, arcs, strict=True)]
    band = mesh_band(refinements, round_ones, 4 / 3) + arcs[-1] * found[-1]
    size = large / 2 / 2 / refinements[-1] * 0.3
    corner = 0.1 * (2 * size / small) ** (4 / 3)
    why = (
        f"{meshes[-1].per_turn} parabolic arcs fall short of the circle; the re-entrant corner is "
    )
    why += f"met by elements of {size * 1e3:.2g} mm, and the energy lost there goes as their size "
    why += "over the radius to the power 4/3, of the tenth that the step adds at most"
    return TwistedStep(found[-1], band, arcs[-1] + corner, why, meshes[-1].n_unknowns)
