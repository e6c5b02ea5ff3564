"""Manufactured displacements, the blocks they live on, and how an error of theirs converges."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray
from skfem.quadrature import get_quadrature

from fe_drivetrain.common import Floats, Ints
from fe_drivetrain.drivetrain_file import MATERIALS
from fe_drivetrain.elasticity.mesh import Block, brick, element_kind, jacobian
from fe_drivetrain.elasticity.operator import body_loads, traction_loads
from fe_drivetrain.elasticity.solve import solve_solid

LAME = MATERIALS["steel"].lame

INNER, OUTER, HEIGHT = 1.0, 2.0, 1.0  # of the thick quarter ring [m]

_CHUNK = 1024  # cells at a time
_STEP = 1e-30  # of the complex step: too small to be seen in the real part


class Exact(Protocol):
    """A displacement that is known everywhere."""

    def displacement(self, x: Floats) -> Floats:
        """(..., 3) at the positions (..., 3) [m]."""
        ...

    def gradient(self, x: Floats) -> Floats:
        """(..., 3, 3) du_i/dx_j at the positions (..., 3)."""
        ...


@dataclass(frozen=True)
class PlaneWaves:
    """u(x) = sum of a sin(k . x + phase), with all that follows from it in closed form.

    Attributes
    ----------
    amplitudes : Floats
        (m, 3) a [m].
    wave_vectors : Floats
        (m, 3) k [1/m].
    phases : Floats
        (m,) [rad].
    lame : tuple[float, float]
        Lame's constants (lambda, mu) [Pa].
    """

    amplitudes: Floats
    wave_vectors: Floats
    phases: Floats
    lame: tuple[float, float]

    def _phase(self, x: NDArray[Any]) -> NDArray[Any]:
        return np.asarray(x @ self.wave_vectors.T + self.phases)

    def displacement(self, x: NDArray[Any]) -> NDArray[Any]:
        """(..., 3) [m] at the positions (..., 3) [m]."""
        return np.asarray(np.sin(self._phase(x)) @ self.amplitudes)

    def gradient(self, x: NDArray[Any]) -> NDArray[Any]:
        """(..., 3, 3) du_i/dx_j at the positions (..., 3) [m]."""
        each = np.einsum("mi,mj->mij", self.amplitudes, self.wave_vectors)
        return np.asarray(np.tensordot(np.cos(self._phase(x)), each, axes=1))

    def stress(self, x: NDArray[Any]) -> NDArray[Any]:
        """(..., 3, 3) [Pa] by Hooke's law."""
        lam, mu = self.lame
        g = self.gradient(x)
        trace = np.trace(g, axis1=-2, axis2=-1)[..., None, None]
        return np.asarray(lam * trace * np.eye(3) + mu * (g + np.swapaxes(g, -1, -2)))

    def body_force(self, x: NDArray[Any]) -> NDArray[Any]:
        """(..., 3) [N/m^3] that keeps the balance: f = -div sigma.

        Of each wave ((lambda + mu) (k . a) k + mu |k|^2 a) sin(k . x + phase).
        """
        lam, mu = self.lame
        along = np.einsum("mi,mi->m", self.amplitudes, self.wave_vectors)
        square = np.einsum("mi,mi->m", self.wave_vectors, self.wave_vectors)
        each = (lam + mu) * along[:, None] * self.wave_vectors
        each = each + mu * square[:, None] * self.amplitudes
        return np.asarray(np.sin(self._phase(x)) @ each)

    def derivative_errors(self, x: Floats) -> tuple[float, float]:
        """Differences of gradient and body force from derivatives by the complex step.

        f'(x) = Im f(x + i h) / h has no cancellation (Squire and Trapp 1998), so it is exact to
        round-off; nothing of the hand-made derivatives is in it.

        Returns
        -------
        gradient, body_force
            Largest difference over the positions (n, 3), relative to the largest value.
        """
        shifts = [x + 1j * _STEP * np.eye(3)[j] for j in range(3)]
        gradient = np.stack([self.displacement(s).imag / _STEP for s in shifts], axis=-1)
        force = -sum(self.stress(s)[..., j].imag / _STEP for j, s in enumerate(shifts))
        pairs = ((self.gradient(x), gradient), (self.body_force(x), force))
        first, second = (float(np.abs(a - b).max() / np.abs(b).max()) for a, b in pairs)
        return first, second


def three_waves() -> PlaneWaves:
    """One wave along, one across its direction, and one between: all parts of Hooke's law work."""
    return PlaneWaves(
        amplitudes=1e-3 * np.array([[1.0, 0.5, -0.3], [0.4, -0.8, 0.6], [-0.5, 0.2, 0.9]]),
        wave_vectors=np.array([[1.2, 0.6, -0.36], [0.9, 1.2, 1.0], [-0.6, 1.1, 0.8]]),
        phases=np.array([0.3, 1.1, -0.7]),
        lame=LAME,
    )


def quarter_ring(p: Floats) -> Floats:
    """The unit cube as a thick quarter ring about z; its first direction is the radius."""
    radius = INNER + (OUTER - INNER) * p[:, 0]
    angle = 0.5 * np.pi * p[:, 1]
    return np.column_stack([radius * np.cos(angle), radius * np.sin(angle), HEIGHT * p[:, 2]])


def bar(p: Floats) -> Floats:
    """The unit cube as a straight bar of 1 x 2 x 1 m."""
    return np.asarray(p * [1.0, 2.0, 1.0])


def plane_waves() -> PlaneWaves:
    """Two waves in the plane of x and y."""
    return PlaneWaves(
        amplitudes=1e-3 * np.array([[1.0, 0.5, 0.0], [0.4, -0.8, 0.0]]),
        wave_vectors=np.array([[2.4, 1.2, 0.0], [-1.0, 2.6, 0.0]]),
        phases=np.array([0.3, 1.1]),
        lame=LAME,
    )


def trapezoids(nodes: int, share: float = 0.5) -> Callable[[int], Block]:
    """Meshes of the unit square in x and y, one hexahedron thick, that stay distorted.

    Every other line across y is a zigzag, so that all elements are trapezoids of one shape, as in
    Arnold, Boffi and Falk 2002; for `convergence`.

    Parameters
    ----------
    nodes : int
        Number of nodes of the hexahedra.
    share : float
        How far the line moves, in heights of an element; parallel sides are as 1 + share to
        1 - share.
    """

    def mesh(n: int) -> Block:
        def shape(p: Floats) -> Floats:
            # linear between lines of the mesh, so that mid-side nodes stay in the middle
            hat = 1.0 - np.abs(np.mod(n * p[:, :2], 2.0) - 1.0)
            moved = share / n * (1.0 - 2.0 * hat[:, 0]) * hat[:, 1]
            return np.column_stack([p[:, 0], p[:, 1] + moved, 0.25 * p[:, 2]])

        return brick((n, n, 1), nodes, shape)

    return mesh


def regular(nodes: int, shape: Callable[[Floats], Floats]) -> Callable[[int], Block]:
    """Meshes of (n, 2 n, n) hexahedra, or six tetrahedra in each, for `convergence`."""
    return lambda n: brick((n, 2 * n, n), nodes, shape)


@dataclass(frozen=True)
class Domain:
    """A body whose faces slide, are displaced or loaded as an exact solution says.

    Face "x0" is displaced and "x1" loaded; the four others slide: their normal displacement is
    prescribed, their tangential traction applied. At each edge a reflection makes the boundary
    smooth, so that the dual problem behind the order in L2 is as regular as theory asks.

    Attributes
    ----------
    sliding : dict[str, int]
        Face to the axis of its normal.
    project : callable
        Function of positions (n, 3) on the face "x1" of a mesh: positions and normals on the true
        face.
    """

    sliding: dict[str, int]
    project: Callable[[Floats], tuple[Floats, Floats]]


def _on_outer_cylinder(x: Floats) -> tuple[Floats, Floats]:
    angle = np.arctan2(x[:, 1], x[:, 0])
    normal = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(len(x))])
    return OUTER * normal + x * np.eye(3)[2], normal


def _on_end(x: Floats) -> tuple[Floats, Floats]:
    return x, np.broadcast_to(np.eye(3)[0], x.shape)


RING = Domain({"y0": 1, "y1": 0, "z0": 2, "z1": 2}, _on_outer_cylinder)
BAR = Domain({"y0": 1, "y1": 1, "z0": 2, "z1": 2}, _on_end)


def solve_manufactured(block: Block, domain: Domain, exact: PlaneWaves) -> Floats:
    """(3 n,) displacements of the finite elements for the exact solution's forces and supports."""
    points = block.points
    given = np.zeros((len(points), 3), dtype=bool)
    given[block.face_nodes("x0")] = True
    for face, axis in domain.sliding.items():
        given[block.face_nodes(face), axis] = True
    columns = np.flatnonzero(given.ravel())
    values = exact.displacement(points).ravel()[columns]

    def traction(x: Floats, normal: Floats) -> Floats:
        return np.asarray(np.einsum("nij,nj->ni", exact.stress(x), normal))

    def outer_traction(x: Floats, _: Floats) -> Floats:
        return traction(*domain.project(x))

    F = body_loads(points, block.cells, exact.body_force)
    F += traction_loads(points, block.faces["x1"], outer_traction)
    for face in domain.sliding:
        F += traction_loads(points, block.faces[face], traction)
    return solve_solid(points, block.cells, LAME, [], F, prescribed=(columns, values)).u[:, 0]


def relative_errors(
    points: Floats, cells: Ints, u: Floats, exact: Exact, lame: tuple[float, float], degree: int
) -> tuple[float, float]:
    """Errors of a displacement in L2 and in the energy norm, relative to the exact solution.

    Parameters
    ----------
    points, cells : Floats, Ints
        The mesh; integrals are over its elements.
    u : Floats
        (3 n,) displacements [m].
    exact : Exact
        The exact solution.
    lame : tuple[float, float]
        Lame's constants (lambda, mu) [Pa].
    degree : int
        Degree of the quadrature.

    Returns
    -------
    l2, energy
        sqrt(int |e|^2 / int |u|^2) and sqrt(int sigma(e):eps(e) / int sigma(u):eps(u)).
    """
    lam, mu = lame
    kind = element_kind(cells.shape[1])
    X, W = get_quadrature(kind.element.refdom, degree)
    values, gradients = kind.shape(X)
    U = u[: 3 * len(points)].reshape(-1, 3)
    sums = np.zeros((2, 2))
    for start in range(0, len(cells), _CHUNK):
        part = cells[start : start + _CHUNK]
        physical, determinant = jacobian(points, part, gradients)
        w = determinant * W
        x = values @ points[part]
        true = exact.displacement(x), np.swapaxes(exact.gradient(x), -1, -2)
        found = values @ U[part], physical @ U[part][:, None]
        for k, scale in enumerate((1.0, 0.0)):
            v = true[0] - scale * found[0]
            g = true[1] - scale * found[1]
            strain = 0.5 * (g + np.swapaxes(g, -1, -2))
            trace = np.trace(strain, axis1=-2, axis2=-1)
            density = lam * trace**2 + 2.0 * mu * (strain**2).sum(axis=(-2, -1))
            sums[k] += (w * (v**2).sum(axis=-1)).sum(), (w * density).sum()
    l2, energy = np.sqrt(sums[0] / sums[1])
    return float(l2), float(energy)


@dataclass(frozen=True)
class Series:
    """Errors of one element on meshes from coarse to fine.

    Attributes
    ----------
    label : str
        The element and its mesh.
    sizes : list[float]
        Edge of an element relative to the body.
    unknowns : list[int]
        Three a node.
    errors : dict[str, list[float]]
        By norm or quantity: relative errors.
    orders : dict[str, float]
        By the same names: the order that theory gives.
    """

    label: str
    sizes: list[float]
    unknowns: list[int]
    errors: dict[str, list[float]]
    orders: dict[str, float]

    def slopes(self, name: str) -> Floats:
        """Observed order between each mesh and the next finer one."""
        e, h = np.array(self.errors[name]), np.array(self.sizes)
        return np.asarray(np.log(e[1:] / e[:-1]) / np.log(h[1:] / h[:-1]))

    def order(self, name: str) -> tuple[float, float]:
        """Observed order between the two finest meshes, and its change from the pair before."""
        slopes = self.slopes(name)
        return float(slopes[-1]), float(abs(slopes[-1] - slopes[-2]))


NORMS = ("L2 norm", "energy norm")


def convergence(
    label: str,
    divisions: Sequence[int],
    mesh: Callable[[int], Block],
    domain: Domain,
    exact: PlaneWaves,
    theory: tuple[float, float],
    degree: int,
) -> Series:
    """Errors of one element for an exact solution, on ever finer meshes.

    Parameters
    ----------
    divisions : Sequence[int]
        n, ascending; the size of the elements goes with 1 / n.
    mesh : callable
        Function of n that makes a mesh.
    domain, exact : Domain, PlaneWaves
        The problem.
    theory : tuple[float, float]
        Orders in L2 and in the energy norm.
    degree : int
        Degree of the quadrature of the norms.
    """
    errors: dict[str, list[float]] = {name: [] for name in NORMS}
    unknowns = []
    for n in divisions:
        block = mesh(n)
        u = solve_manufactured(block, domain, exact)
        found = relative_errors(block.points, block.cells, u, exact, LAME, degree)
        for name, error in zip(NORMS, found, strict=True):
            errors[name].append(error)
        unknowns.append(3 * len(block.points))
    orders = dict(zip(NORMS, theory, strict=True))
    return Series(label, [1.0 / n for n in divisions], unknowns, errors, orders)
