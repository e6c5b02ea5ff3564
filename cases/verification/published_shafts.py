"""What the cases of published main shafts share: torsion of a tube by finite elements."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fe_drivetrain.compare import GridConvergence, grid_convergence
from fe_drivetrain.report import AssumptionRow, Verdict, judge
from fe_drivetrain.scene import Material
from fe_drivetrain.suite import Run
from fe_drivetrain.validation import (
    solid_shafts,
)
from fe_drivetrain.validation.shaft_theory import (
    parabola_shortfall,
)

#: Elements round the axis of the coarsest mesh; of a quick run.
BASE_TURN, QUICK_TURN = 12, 8
POISSON = 0.3
"""Assumed: in torsion it has no part."""


class Torsion(NamedTuple):
    """Torsional stiffness of a uniform shaft on three meshes.

    Attributes
    ----------
    series
        Of the stiffness [N m/rad].
    per_turn, unknowns
        Of the finest mesh.
    """

    series: GridConvergence
    per_turn: int
    unknowns: int

    @property
    def tolerance(self) -> float:
        """Twice what J lacks since parabolas stand for the circle."""
        return 2 * 4 * parabola_shortfall(self.per_turn)


#: Of turbines without a gearbox.
RIGID_ENDS = AssumptionRow(
    name="generator and hub",
    value="rigid",
    unit="",
    source="the turbine has no gearbox: the field would hold the generator's structure too, which "
    "is not published",
)


def judge_free_free(by_eigenvalues: float, closed: float) -> Verdict:
    """The free-free frequency of rotor and generator, by eigenvalues and in closed form."""
    return judge(
        "free-free frequency by eigenvalues against the closed form",
        by_eigenvalues / closed - 1,
        0.0,
        tolerance=1e-9,
        relative=False,
        source="sqrt(k (1 / J_rotor + 1 / n^2 J_generator)) / 2 pi",
        reason="round-off",
        measure="identity",
    )


def material_of(shear_modulus: float, density: float = 7800.0) -> Material:
    """A material of that shear modulus [Pa]."""
    E = 2 * (1 + POISSON) * shear_modulus
    return Material(youngs_modulus=E, poisson_ratio=POISSON, density=density)


def torsion(run: Run, outer: float, inner: float, length: float, shear_modulus: float) -> Torsion:
    """Twist a tube, or a solid shaft, between rigid ends [m, Pa]."""
    found, turns = [], []
    for refinement in (1, 2, 3):
        with run.step("mesh and solve"):
            # the angle is linear along the axis, and elements hold that at any length
            mesh = solid_shafts.solid(
                solid_shafts.straight((0.0, length), outer, inner),
                refinement,
                base_turn=QUICK_TURN if run.quick else BASE_TURN,
                size=length,
            )
            found.append(solid_shafts.twist(mesh, material_of(shear_modulus))[1])
        turns.append(mesh.per_turn)
    series = grid_convergence(1.0 / np.array(turns), found, expected_order=4.0)
    return Torsion(series, turns[-1], mesh.n_unknowns)


def judge_torsion(name: str, found: Torsion, reference: float, source: str) -> Verdict:
    """The stiffness by finite elements against a closed form or a published figure."""
    return judge(
        name,
        found.series.finest,
        reference,
        tolerance=found.tolerance,
        unit="N m/rad",
        source=source,
        reason=f"{found.per_turn} parabolic arcs round a turn: J is {found.tolerance / 2:.1g} too "
        "low by their formula; twice that is allowed",
        measure="stiffness",
        band=found.series.uncertainty,
    )
