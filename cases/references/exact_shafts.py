"""Uniform solid shafts under the loads of exact fields: pulled, bent, flexed, twisted."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fe_drivetrain.cases.references import end_loaded, solid_shafts
from fe_drivetrain.cases.references.shaft_theory import (
    Tube,
    flexure_field,
    flexure_stress,
    pure_bending_field,
)
from fe_drivetrain.common import Floats, Ints


@dataclass(frozen=True)
class ExactShaft:
    """A shaft of hexahedra of 27 nodes, loaded on its ends as an exact field loads it.

    Attributes
    ----------
    tube : Tube
        The shaft; it lies from x = 0 to its length.
    found : EndLoaded
        The solution.
    exact : ndarray
        (n, 3) exact displacements of the nodes [m].
    rear : ndarray
        (3 n,) nodal forces on the rear face [N]; of a twisted shaft none, its ends are displaced.
    """

    tube: Tube
    found: end_loaded.EndLoaded
    exact: Floats
    rear: Floats

    @property
    def mesh(self) -> solid_shafts.Solid:
        """Its elements."""
        return self.found.mesh

    @property
    def error(self) -> float:
        """Largest difference from the exact displacements, over the largest of them."""
        return self.found.error(self.exact)

    @property
    def rear_moment(self) -> float:
        """Moment of the rear face's forces about y, in the sense of a slope du_z/dx [N m]."""
        return float(-self.rear.reshape(-1, 3)[:, 0] @ self.mesh.points[:, 2])

    @cached_property
    def skin(self) -> Ints:
        """Nodes on the outer surface at mid length, ordered by `angle`."""
        nodes = end_loaded.skin_nodes(self.mesh, self.tube.length / 2)
        return np.asarray(nodes[np.argsort(self._angle(nodes))])

    @property
    def angle(self) -> Floats:
        """Angle of each node of `skin` from the y axis [degrees]."""
        return self._angle(self.skin)

    def _angle(self, nodes: Ints) -> Floats:
        _, y, z = self.mesh.points[nodes].T
        return np.asarray(np.degrees(np.arctan2(z, y)))


def pulled(tube: Tube, stress: float, refinement: int) -> ExactShaft:
    """Uniform traction [Pa] on both ends: u = sigma / E (x, -nu y, -nu z)."""
    shaft = solid_shafts.straight((0.0, tube.length), tube.outer, tube.inner)
    mesh = solid_shafts.solid(shaft, refinement, size=tube.length)
    nu = tube.material.poisson_ratio
    exact = stress / tube.material.youngs_modulus * mesh.points * [1.0, -nu, -nu]
    front, rear = end_loaded.end_forces(mesh, lambda positions, normals: stress * normals)
    found = end_loaded.solve_loaded(mesh, tube.material, front + rear, like=exact)
    return ExactShaft(tube, found, exact, rear)


def bent(tube: Tube, curvature: float, refinement: int) -> ExactShaft:
    """Linear tractions on both ends: pure bending by a curvature [1/m] in the plane of x and z."""
    shaft = solid_shafts.straight((0.0, tube.length / 2, tube.length), tube.outer, tube.inner)
    mesh = solid_shafts.solid(shaft, refinement)
    exact = pure_bending_field(mesh.points, curvature, tube.material.poisson_ratio)

    def traction(positions: Floats, normals: Floats) -> Floats:
        pull = np.zeros_like(positions)
        pull[:, 0] = -tube.material.youngs_modulus * curvature * positions[:, 2] * normals[:, 0]
        return pull

    front, rear = end_loaded.end_forces(mesh, traction)
    found = end_loaded.solve_loaded(mesh, tube.material, front + rear, like=exact)
    return ExactShaft(tube, found, exact, rear)


def flexed(tube: Tube, force: float, refinement: int) -> ExactShaft:
    """Saint-Venant's tractions on both ends: flexure by a force along z [N] at the rear."""
    shaft = solid_shafts.straight((0.0, tube.length / 2, tube.length), tube.outer, tube.inner)
    mesh = solid_shafts.solid(shaft, refinement)
    exact = flexure_field(mesh.points, force, tube)

    def traction(positions: Floats, normals: Floats) -> Floats:
        s = flexure_stress(positions, force, tube)
        return np.asarray(normals[:, :1] * s[:, [0, 3, 5]])

    front, rear = end_loaded.end_forces(mesh, traction)
    F = end_loaded.balanced(mesh, front + rear)
    found = end_loaded.solve_loaded(mesh, tube.material, F, like=exact)
    return ExactShaft(tube, found, exact, rear)


def twisted(tube: Tube, angle: float, refinement: int) -> tuple[ExactShaft, float, float]:
    """The rear face turned by an angle [rad] as a rigid plane, the front face held.

    Returns
    -------
    shaft, by_torque, by_energy : ExactShaft, float, float
        The solution; the stiffness [N m/rad] as torque over angle, and as twice the energy over its
        square.
    """
    shaft = solid_shafts.straight((0.0, tube.length), tube.outer, tube.inner)
    mesh = solid_shafts.solid(shaft, refinement, size=tube.length)
    static, by_torque, by_energy = solid_shafts.twist(mesh, tube.material, angle)
    found = end_loaded.EndLoaded(mesh, tube.material, static)
    exact = solid_shafts.rotation_of(mesh.points, angle * mesh.points[:, 0] / tube.length)
    return ExactShaft(tube, found, exact, np.zeros(mesh.n_unknowns)), by_torque, by_energy


def tip_deflection(shaft: ExactShaft) -> float:
    """Mean deflection of the rear face from the mean tangent of the front face [m]."""
    (root, slope), (end, _) = (shaft.found.means(x) for x in (0.0, shaft.tube.length))
    return float(end[2] - root[2] - slope * shaft.tube.length)


def neutral_shear(shaft: ExactShaft, force: float) -> tuple[float, float, float]:
    """Shear stress tau_xz on the neutral axis at mid length of a flexed shaft.

    At the skin of a bored shaft, at the centre of a solid one.

    Parameters
    ----------
    shaft : ExactShaft
        From `flexed`.
    force : float
        The same force [N].

    Returns
    -------
    found, exact, largest : float
        Recovered and exact stress there, and the largest exact shear of the section [Pa].
    """
    mesh, tube = shaft.mesh, shaft.tube
    middle = mesh.section_nodes(tube.length / 2)
    _, y, z = mesh.points[middle].T
    at = y.argmax() if tube.inner else np.hypot(y, z).argmin()
    there = flexure_stress(mesh.points[middle], force, tube)[:, [3, 5]]
    recovered = shaft.found.stress[middle[at], 5]
    return float(recovered), float(there[at, 1]), float(np.abs(there).max())
