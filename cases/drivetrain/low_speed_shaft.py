"""The low-speed shaft of the NREL 750 kW drivetrain as solids of revolution, and its stiffness.

The thesis gives k, not the shaft. What its damper implies (see `implied_shafts`) is
J = (C / 2 zeta)^2 / k, and with it the length G J / k of a uniform solid shaft. A shaft of that
length with flange and steps, whose sections add up to the same k, is what finite elements are asked
about.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fe_drivetrain.cases.references.implied_shafts import SHEAR_MODULUS, Uniform
from fe_drivetrain.cases.references.twisted_tubes import material_of
from fe_drivetrain.comparison import GridConvergence, grid_convergence
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.elasticity.interfaces import (
    Constraint,
    averaged_point,
    fixed,
    rigid_face,
    rigid_point,
)
from fe_drivetrain.elasticity.mesh import Mesh, face_weights, generate
from fe_drivetrain.elasticity.revolution import end_stiffness
from fe_drivetrain.elasticity.solve import solve_solid
from fe_drivetrain.geometry import Flange, MeshSizes, Section, Shaft
from fe_drivetrain.report.suite import Run

MATERIAL = material_of(SHEAR_MODULUS)

#: Shares of the length, and diameters over each other: flange, body with the main bearing's seat,
#: rear with the gearbox's. Chosen: the thesis has no drawing.
SHARES = (0.05, 0.45, 0.50)
DIAMETERS = (0.70, 0.40, 0.30)
FILLET = 0.04
"""Radius at the foot of both steps [m]."""

#: Elements round a turn of the meshes.
TURNS, QUICK_TURNS = (8, 11, 14), (8, 9, 10)
#: Orders of the elements in the meridian.
ORDERS = (2, 3, 4)


class Stiffness(NamedTuple):
    """A stiffness and the half width of its band [N m/rad]."""

    value: float
    band: float


class Solid(NamedTuple):
    """The stepped shaft in three dimensions.

    Attributes
    ----------
    unknowns, stiffness : list[int], list[float]
        Unknowns of each mesh, and its stiffness with rigid ends [N m/rad].
    averaged : float
        On the first mesh, the front face free to deform [N m/rad].
    series : GridConvergence
        The convergence of the stiffness.
    """

    unknowns: list[int]
    stiffness: list[float]
    averaged: float
    series: GridConvergence


def uniform(found: Uniform) -> Shaft:
    """The uniform solid shaft that k and C imply, from x = 0 on; `found` is from `implied`."""
    return Shaft(front=0.0, sections=(Section(length=found.length, outer_diameter=found.diameter),))


def stepped(length: float, stiffness: float, fillet: float = FILLET) -> Shaft:
    """Flange and two sections whose G J / L in series are a stiffness.

    Parameters
    ----------
    length : float
        Length of all three [m].
    stiffness : float
        1 / sum(L / G J) [N m/rad].
    fillet : float
        Radius at the foot of both steps [m]; 0 for sharp ones.
    """
    lengths = [share * length for share in SHARES]
    scale = (
        sum(
            L * 32 / (np.pi * SHEAR_MODULUS * d**4) for L, d in zip(lengths, DIAMETERS, strict=True)
        )
        * stiffness
    ) ** 0.25
    flange, *sections = ((L, float(scale * d)) for L, d in zip(lengths, DIAMETERS, strict=True))
    last = len(sections) - 1
    return Shaft(
        front=0.0,
        flange=Flange(thickness=flange[0], outer_diameter=flange[1], fillet=fillet),
        sections=tuple(
            Section(length=L, outer_diameter=d, fillet=0.0 if i == last else fillet)
            for i, (L, d) in enumerate(sections)
        ),
    )


def in_series(shaft: Shaft) -> float:
    """1 / sum(L / G J) of the sections [N m/rad]: Eq 4.4 piece by piece."""
    return float(
        1 / sum(p.length * 32 / (np.pi * SHEAR_MODULUS * p.outer_diameter**4) for p in shaft.pieces)
    )


def meridian_stiffness(
    shaft: Shaft, size: float, order: int | None = None, material: Material = MATERIAL
) -> float:
    """Torsional stiffness between rigid ends by Fourier harmonics.

    Parameters
    ----------
    shaft : Shaft
        The shaft.
    size : float
        Size of elements in the meridian [m].
    order : int, optional
        Order of these elements; `end_stiffness` chooses where it is left out.
    material : Material
        Its material; steel of G = 80 GPa where left out.

    Returns
    -------
    stiffness : float
        [N m/rad].
    """
    return float(end_stiffness(shaft, material, size, order=order)[3, 3])


def meshed(shaft: Shaft, turn: int) -> Mesh:
    """Curved tetrahedra of ten nodes, at least so many round a turn, and as fine along the rest."""
    size = 2.4 * max(section.outer_diameter for section in shaft.sections) / turn
    return generate(shaft, sizes=MeshSizes(shaft=size, elements_per_turn=turn))


def solid_stiffness(mesh: Mesh, material: Material = MATERIAL, *, rigid: bool = True) -> float:
    """Torque over the angle of the front face, the rear face held.

    Parameters
    ----------
    mesh : Mesh
        From `meshed`.
    material : Material
        Its material; steel of G = 80 GPa where left out.
    rigid : bool
        Whether the front face is; otherwise it is free to deform, and its angle is its mean.

    Returns
    -------
    stiffness : float
        [N m/rad].
    """
    n = len(mesh.points)
    origin = np.array([mesh.points[:, 0].min(), 0.0, 0.0])
    face = mesh.face_nodes("shaft.front")
    constraints: list[Constraint]
    if rigid:
        n_dofs = 3 * n + 6
        front = rigid_point("front", origin, 3 * n, n_dofs)
        constraints = [rigid_face("front", face, mesh.points, front)]
    else:
        n_dofs = 3 * n
        weights = face_weights(mesh.points, mesh.faces["shaft.front"], n)[face]
        front = averaged_point("front", face, weights, mesh.points, origin, n_dofs)
        constraints = []
    constraints.append(fixed("rear", mesh.face_nodes("shaft.rear"), n_dofs))
    row = front.motion[[3]]
    found = solve_solid(mesh.points, mesh.cells, material.lame, constraints, row.T.toarray())
    return float(1.0 / (row @ found.u)[0, 0])


def in_meridian(shaft: Shaft, size: float, material: Material = MATERIAL) -> Stiffness:
    """By Fourier harmonics, rigid ends, orders of elements up to the fourth."""
    series = [meridian_stiffness(shaft, size, order, material) for order in ORDERS]
    return Stiffness(series[-1], abs(series[-1] - series[-2]))


def in_three_dimensions(run: Run, shaft: Shaft, material: Material = MATERIAL) -> Solid:
    """On three meshes, and with another coupling of the front face on the first of them."""
    turns = QUICK_TURNS if run.quick else TURNS
    stiffness, unknowns = [], []
    for turn in turns:
        with run.step("mesh and solve in three dimensions"):
            mesh = meshed(shaft, turn)
            stiffness.append(solid_stiffness(mesh, material))
            unknowns.append(int(mesh.points.size))
        if turn == turns[0]:
            with run.step("front face free to deform"):
                averaged = solid_stiffness(mesh, material, rigid=False)
    series = grid_convergence(1 / np.array(turns), stiffness, min_order=1.0)
    return Solid(unknowns, stiffness, averaged, series)


def taken_over(meridian: Stiffness, solid: Solid) -> Stiffness:
    """From a free to a rigid front face, with the bands of meridian and solid.

    The coupling's part is of one mesh, which is why the band of the series counts beside it.
    """
    softer = solid.averaged / solid.stiffness[0]
    low = meridian.value * min(softer, 1.0) - meridian.band - solid.series.uncertainty
    high = meridian.value * max(softer, 1.0) + meridian.band + solid.series.uncertainty
    return Stiffness((low + high) / 2, (high - low) / 2)
