"""A component as a solid in curved tetrahedra, condensed to its reference points."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.stiffness_bands import StiffnessBands
from fe_drivetrain.drivetrain_file.component import (
    Component,
    HousingComponent,
    SomeComponent,
    material_of,
)
from fe_drivetrain.elasticity.mesh.mesh import Mesh
from fe_drivetrain.elasticity.mesh.symmetry import meshed, mirror, repeated, turns
from fe_drivetrain.elasticity.solve.coupled_solid import CondensedSolid, condensed_solid
from fe_drivetrain.elasticity.solve.error_estimate import SAFETY, error_energies
from fe_drivetrain.geometry import BodySizes

COARSER = (1.8, 1.35)
"""Factors on mesh sizes of the two coarser solids that give the finest its band."""


def coarser(component: SomeComponent, factor: float) -> SomeComponent:
    """The component with its mesh sizes times a factor."""
    return component.model_copy(update={"mesh": component.mesh.scaled(factor)})


def component_mesh(component: Component) -> tuple[Mesh, BodySizes]:
    """The mesh of a component, mirrored from one half or turned from one sector, and its sizes:
    finer than asked for where elements would have folded over.

    Raises
    ------
    InputError
        The body cannot be meshed with these sizes.
    """
    if isinstance(component, HousingComponent):
        half, sizes = meshed(component.gearbox_housing.build_half, component.mesh)
        eyes = {"housing.eye": ["housing.left", "housing.right"]}
        return repeated(half, [np.eye(3), mirror(1)], ["housing.cut"], eyes), sizes
    carrier = component.planet_carrier
    sector, sizes = meshed(carrier.build_sector, component.mesh)
    pins = {"carrier.pin": [f"carrier.{name}" for name in component.loaded]}
    cuts = ["carrier.first", "carrier.last"]
    return repeated(sector, turns(carrier.planets), cuts, pins), sizes


@dataclass(frozen=True)
class SolidComponent(CondensedSolid):
    """A component's solid, solved for unit loads.

    Attributes
    ----------
    sizes : BodySizes
        The element sizes of its mesh.
    """

    sizes: BodySizes


def solid_component(component: Component, method: str = "auto") -> SolidComponent:
    """Mesh a component, solve it free for unit loads at its points, and condense it to these.

    Parameters
    ----------
    component : Component
        The component; its supports have no part in this.
    method : str
        Solver, see `fe_drivetrain.elasticity.solve.solvers.factorise`.

    Raises
    ------
    InputError
        The body cannot be meshed.
    """
    mesh, sizes = component_mesh(component)
    materials = dict.fromkeys(mesh.part_names, material_of(component))
    solid = condensed_solid(mesh, materials, component.attachments, method)
    return SolidComponent(**vars(solid), sizes=sizes)


def recovered_band(
    component: Component, solid: SolidComponent, motions: Floats, stiffness: Floats
) -> StiffnessBands:
    """The band of a component's stiffness by recovered stresses of its one mesh.

    The error of a displacement model in given motions is one of energy, and positive semidefinite:
    no entry off the diagonal has a larger one, relative to the diagonal entries of its row and
    column. Supports only add to the stiffness.

    Parameters
    ----------
    component : Component
        The component.
    solid : SolidComponent
        Its solid.
    motions : Floats
        (6 n, 6 m) of its n points, one column for each entry of the diagonal [m, rad].
    stiffness : Floats
        (6 m, 6 m) for these motions [N/m, N m/rad].

    Returns
    -------
    StiffnessBands
        Half widths, relative.
    """
    mesh, lame = solid.mesh, material_of(component).lame
    parts = [(mesh.cells[mesh.part_cells(p)], lame) for p in mesh.part_names]
    errors = error_energies(mesh.points, parts, solid.fields(motions))
    return StiffnessBands.of_motions(SAFETY * 2.0 * errors / stiffness.diagonal())
