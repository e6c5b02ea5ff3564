"""The free shaft with fixed-interface modes: Craig-Bampton in the meridian.

To the points' motions, which follow statically (Guyan 1965), come the lowest modes that the shaft
has while all its points stand still (Craig and Bampton 1968, "Coupling of substructures for dynamic
analyses", AIAA Journal 6(7), 1313-1319). A point moves as the mean of a face (RBE3), so that it
stands still is a constraint on the mean, P u = 0, and the face itself goes on to vibrate: modes are
those of

    K u + P^T f = omega^2 M u,  P u = 0.

Stiffness has no coupling between the two kinds; mass has. Modes without motion of any mean, of
harmonics 2 and above (the shaft's wall becoming oval), are left out: nothing at the points excites
them, nor do these feel them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from importlib.metadata import version

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.drivetrain_file.materials import Material
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.elasticity.revolution import harmonics
from fe_drivetrain.elasticity.revolution.meridian_mesh import Meridian
from fe_drivetrain.elasticity.solve.condensation import Condensed, keep_points
from fe_drivetrain.elasticity.solve.vibration import lowest_modes
from fe_drivetrain.export.superelement import Origin, Superelement, refuse_one_point
from fe_drivetrain.report.seal import drivetrain_hash
from fe_drivetrain.shafts.fidelity.shafts import (
    harmonic_mass,
    meridian_shaft,
    motion_traction,
    reference_points,
    shaft_meridian,
)


@dataclass(frozen=True)
class CraigBampton:
    """A free body: the motions of its points, and modes that it has while these stand still.

    Attributes
    ----------
    points : tuple[str, ...]
        Names of the n points.
    positions : Floats
        (n, 3) [m].
    point_stiffness, point_mass : Floats
        (6 n, 6 n) of the points alone (Guyan).
    omega : Floats
        (m,) circular frequencies of the modes, ascending [rad/s]; each has unit mass.
    coupling : Floats
        (6 n, m) mass between points and modes.
    origin : Origin
        Where it comes from.
    """

    points: tuple[str, ...]
    positions: Floats
    point_stiffness: Floats
    point_mass: Floats
    omega: Floats
    coupling: Floats
    origin: Origin = field(default_factory=Origin)

    __repr__ = short_repr

    @property
    def stiffness(self) -> Floats:
        """(6 n + m, 6 n + m), the points' degrees of freedom first."""
        n = len(self.point_stiffness)
        K = np.zeros((n + len(self.omega),) * 2)
        K[:n, :n] = self.point_stiffness
        K[n:, n:] = np.diag(self.omega**2)
        return K

    @property
    def mass(self) -> Floats:
        """(6 n + m, 6 n + m), the points' degrees of freedom first."""
        return np.block(
            [[self.point_mass, self.coupling], [self.coupling.T, np.eye(len(self.omega))]]
        )

    @property
    def condensed(self) -> Condensed:
        """The points alone (Guyan)."""
        falling = np.tile(np.eye(6)[:, :3], (len(self.points), 1))
        gravity = self.point_mass @ falling
        return Condensed(
            self.points, self.positions, self.point_stiffness, gravity, self.point_mass
        )

    @property
    def superelement(self) -> Superelement:
        """The points alone (Guyan), to be written."""
        return Superelement(
            "shaft",
            self.points,
            self.positions,
            self.point_stiffness,
            self.point_mass,
            origin=self.origin,
        )

    def with_modes(self, count: int) -> CraigBampton:
        """The same with its lowest modes only, however many of a pair that leaves."""
        return replace(self, omega=self.omega[:count], coupling=self.coupling[:, :count])


def craig_bampton_shaft(
    scene: Scene,
    modes: int,
    at: Sequence[str] | None = None,
    size: float | None = None,
    order: int | None = None,
    rings: bool = True,
) -> CraigBampton:
    """The free shaft of a scene at level 2, with fixed-interface modes.

    Parameters
    ----------
    scene : Scene
        The scene.
    modes : int
        How many, the lowest; bending modes come in pairs, and no pair is parted, so it may be one
        more. 0 is Guyan's condensation.
    at : Sequence[str] or None
        Points that are kept, and stand still; all where not given.
    size, order, rings : float or None, int or None, bool
        The same as for `fe_drivetrain.shafts.fidelity.shafts.meridian_shaft`.

    Raises
    ------
    InputError
        The number of modes is negative, or more than the mesh has, or there is one point alone.
    """
    if modes < 0:
        raise InputError(f"number of modes is {modes} but must be 0 or more: give a count")
    names, _ = reference_points(scene)
    refuse_one_point("shaft", at or (), names, "drivetrain")
    body = meridian_shaft(scene, size, order, rings)
    body = body if at is None else keep_points(body, at)
    assert body.mass is not None
    n = len(body.names)
    mesh, sides = shaft_meridian(scene, size, order, rings)
    material = scene.material_of("shaft")
    here = [sides[names.index(name)] for name in body.names]
    found: list[tuple[float, list[Floats]]] = []
    if modes:
        for harmonic, kept in ((0, (0, 3)), (1, (1, 5))):
            count = modes if harmonic == 0 else (modes + 1) // 2
            problem = _Harmonic(mesh, material, harmonic, body.positions[:, 0], here)
            omega, coupling = problem.fixed_modes(count)
            for one, column in zip(omega, coupling.T, strict=True):
                placed = []
                for rows, sense in [(kept, 1.0), ((2, 4), -1.0)][: harmonic + 1]:
                    full = np.zeros((n, 6))
                    # along z as along y, but the rotation has the other sense
                    full[:, rows] = column.reshape(n, 2) * [1.0, sense]
                    placed.append(full.ravel())
                found.append((float(one), placed))
    found.sort(key=lambda mode: mode[0])
    omegas: list[float] = []
    columns: list[Floats] = []
    for one, placed in found:
        if len(omegas) >= modes:
            break
        omegas += [one] * len(placed)
        columns += placed
    return CraigBampton(
        body.names,
        body.positions,
        body.stiffness,
        body.mass,
        np.array(omegas),
        np.column_stack(columns) if columns else np.zeros((6 * n, 0)),
        Origin(
            scene.title,
            drivetrain_hash(scene),
            f"2 meridian in harmonics, {len(omegas)} fixed-interface modes",
            f"{len(mesh.nodes):,} nodes in the meridian, order {mesh.element.order}",
            f"fe-drivetrain {version('fe-drivetrain')}",
        ),
    )


def free_frequencies(
    scene: Scene,
    count: int,
    size: float | None = None,
    order: int | None = None,
    rings: bool = True,
) -> Floats:
    """Natural frequencies [Hz] of the free shaft's meridian, not condensed: what is left to reach.

    Parameters
    ----------
    scene, size, order, rings : Scene, float or None, int or None, bool
        The same as for `craig_bampton_shaft`.
    count : int
        How many of each harmonic, 0 and 1, rigid motions not counted.

    Returns
    -------
    (3 count,) ascending: those of harmonic 1 are there twice.
    """
    mesh, _ = shaft_meridian(scene, size, order, rings)
    material = scene.material_of("shaft")
    found = [
        np.repeat(_Harmonic(mesh, material, n, np.zeros(0), []).free_modes(count), n + 1)
        for n in (0, 1)
    ]
    return np.sort(np.concatenate(found)) / (2.0 * np.pi)


class _Harmonic:
    """Stiffness, mass and the points' motions in one harmonic: what the axis leaves free."""

    def __init__(
        self, mesh: Meridian, material: Material, n: int, places: Floats, sides: Sequence[Ints]
    ) -> None:
        target, share = harmonics.on_axis(mesh, n)
        size = len(target)
        local = 3 * np.tile(mesh.cells, 3) + np.repeat(np.arange(3), mesh.cells.shape[1])
        matrices = harmonics.element_matrices(mesh, material.lame, n)
        K = harmonics.assembled(matrices, target[local], share[local], size)
        follow = sparse.csr_array((share, (np.arange(size), target)), shape=(size, size))
        M = follow.T @ harmonic_mass(mesh, material.density, n) @ follow
        columns = []
        for place, where in zip(places, sides, strict=True):
            tractions = np.column_stack([motion_traction(mesh, n, where, place, k) for k in (0, 1)])
            motions = harmonics.rigid_motions(mesh, n, place).T
            columns.append(tractions @ np.linalg.inv(motions @ tractions))
        free = np.unique(target[share != 0.0])
        self.K = sparse.csc_array(K[free][:, free])
        self.M = sparse.csc_array(sparse.csr_array(M)[free][:, free])
        P = follow.T @ np.hstack(columns) if columns else np.zeros((size, 0))
        self.P = P[free]

    def fixed_modes(self, count: int) -> tuple[Floats, Floats]:
        """Circular frequencies (count,), and (2 n, count) mass between points and modes."""
        size, held = self.P.shape
        if count > size - held - 2:
            raise InputError(
                f"number of modes is {count} but the mesh has {size - held} degrees of freedom: "
                "ask for fewer"
            )
        # rows of the size of the stiffness, for the sake of the pivots
        scale = float(np.abs(self.K.diagonal()).mean() / np.abs(self.P).max())
        C = sparse.csc_array(scale * self.P)
        factor = splu(sparse.block_array([[self.K, C], [C.T, None]], format="csc"))

        def solved(forces: Floats, motions: Floats) -> Floats:
            return np.asarray(factor.solve(np.concatenate([forces, scale * motions]))[:size])

        rest = np.zeros(held)
        values, modes = lowest_modes(lambda b: solved(b, rest), self.M, count)
        shapes = solved(np.zeros((size, held)), np.eye(held))
        return np.sqrt(values), shapes.T @ (self.M @ modes)

    def free_modes(self, count: int) -> Floats:
        """Circular frequencies (count,), the two rigid motions left out."""
        shift = -1e-2 * float(self.K.diagonal().min() / self.M.diagonal().max())
        factor = splu(sparse.csc_array(self.K - shift * self.M))
        values, _ = lowest_modes(factor.solve, self.M, count + 2, shift)
        return np.sqrt(values[2:])
