"""A body of revolution as the outer ring of a bearing: its compliance at the rollers, by harmonics.

Between any two rollers it depends on the angle between them alone, as a sum of cosines. Rollers
press on the same windows as in a housing of any shape (`housing`), so that the two can be compared.
"""

from __future__ import annotations

import numpy as np

from fe_drivetrain.bearing.geometry import Bearing, RollerRow, angles
from fe_drivetrain.bearing.races import Races
from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.materials import Material
from fe_drivetrain.elasticity.revolution.harmonics import dofs, harmonic_solver
from fe_drivetrain.elasticity.revolution.influence import Strip, strip_averages
from fe_drivetrain.elasticity.revolution.meridian_mesh import Meridian


def races_of_revolution(
    bearing: Bearing,
    mesh: Meridian,
    material: Material,
    radius: float,
    *,
    held: Ints,
    centre: float = 0.0,
    harmonics: int | None = None,
) -> Races:
    """Compliance of a body of revolution under rollers that press on its bore.

    Parameters
    ----------
    bearing : Bearing
        Bearing with rows of rollers; its inner ring is rigid.
    mesh, material : Meridian, Material
        Meridian, best with elements that end where the rollers do, and its material.
    radius : float
        Radius of the bore [m].
    held : Ints
        Degrees of freedom (k,) of the mesh that don't move in any harmonic, see
        `revolution.dofs`: they must hold the body against all rigid motions but rotation about x.
    centre : float
        Axial place x of the bearing's centre [m].
    harmonics : int, optional
        Maximum harmonic; as many as a row has rollers where left out, which leaves out less than
        1e-3 of the effect of a roller's window.

    Returns
    -------
    races : Races
        Compliance relative to what is held.

    Raises
    ------
    InputError
        A row is of balls, or a roller does not lie on the bore.
    """
    pushes = np.zeros((3 * len(mesh.nodes), 2 * len(bearing.rows)))
    for number, row in enumerate(bearing.rows):
        if not isinstance(row, RollerRow):
            raise InputError(f"row {number + 1} of {bearing.name} has balls: give rows of rollers")
        sin, cos = np.sin(row.angle), np.cos(row.angle)
        middle, half = (
            centre + row.place + (radius - row.radius) * sin / cos,
            0.5 * row.length * cos,
        )
        nodes, mean, slope = strip_averages(mesh, Strip(radius, middle - half, middle + half))
        for column, weights in ((number, mean), (len(bearing.rows) + number, slope / cos)):
            np.add.at(pushes[:, column], dofs(nodes, 0), sin * weights)
            np.add.at(pushes[:, column], dofs(nodes, 1), cos * weights)
    highest = max(bearing.counts) if harmonics is None else harmonics
    psi = np.concatenate([angles(row) for row in bearing.rows])
    between = np.subtract.outer(psi, psi)
    of_row = np.repeat(np.arange(len(bearing.rows)), bearing.counts)
    pitch = 2.0 * np.pi / np.array(bearing.counts)[of_row]
    whole = np.zeros((2, len(psi), 2, len(psi)))
    for n in range(highest + 1):
        # rotation about x, which no roller feels: without it harmonic 0 is singular
        still = np.unique(np.concatenate([held, dofs(np.arange(len(mesh.nodes)), 2)]))
        solve = harmonic_solver(mesh, material, n, still if n == 0 else held)
        found: Floats = (pushes.T @ solve(pushes)).reshape(2, len(bearing.rows), 2, -1)
        share = np.sinc(n * pitch / (2.0 * np.pi)) ** 2
        waves = np.cos(n * between) * np.outer(share, share)
        whole += found[:, of_row][:, :, :, of_row] * waves[None, :, None]
    C = whole.reshape(2 * len(psi), -1)
    return Races(bearing, 0.5 * (C + C.T))
