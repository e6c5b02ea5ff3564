"""A foot that bolts clamp to the ground: patches of it that press, and may open.

The housing is condensed to its seat, to patches of its foot and to the heads of its bolts, so that
contact is a small dense problem. A patch is pressed on the ground or lifts: no tension between the
two. Bolts are beams that are shortened until each has its preload, all at once, while the foot
slides freely; they bend along with it. Then patches that are pressed no longer slide, whatever the
load; one that lifts is free, and slides without friction where it comes down again. What a state is
does not depend on how it was reached.

In the terms of VDI 2230 Part 1 (2003; names and meaning, no equation number is verified): the
preload F_V, the load F_A that would part the joint, its share F_SA = phi F_A that reaches a bolt
while the joint is closed, phi = k_S / (k_S + k_P) where load enters at the bolt's head.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy import sparse

from fe_drivetrain.common.arrays import Bools, Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.scaling import scaled_solve
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.elasticity.interfaces.constraints import ReferencePoint
from fe_drivetrain.elasticity.mesh.facets import MEANS, face_weights
from fe_drivetrain.elasticity.mesh.mesh import Mesh

MAX_PATCHES = 400
"""Maximum number of patches of a foot: its contact is a dense problem."""

_MIN_AREA = 0.2  # of the mean area of patches: smaller ones join their neighbours
_NOTHING = 1e-9  # of the maximum force or lift: round-off, no change of contact
_TOGETHER = 30  # passes in which all wrong patches change at once, then one by one
_MAX_PASSES = 2000


class Patches(NamedTuple):
    """Patches of a foot.

    Attributes
    ----------
    points : list[ReferencePoint]
        Mean displacements of each; no rotations. Their nodes are disjoint.
    areas : Floats
        (P,) [m^2].
    directions : Floats
        (P, 3, 3) rows: out of the ground, and two across.
    """

    points: list[ReferencePoint]
    areas: Floats
    directions: Floats


def foot_patches(mesh: Mesh, name: str, size: float, n_dofs: int) -> Patches:
    """Divide the foot of a housing into patches of about a size.

    Parameters
    ----------
    mesh : Mesh
        Mesh with the face "NAME.housing.base".
    name : str
        Name of the bearing.
    size : float
        Maximum length of a patch's sides [m].
    n_dofs : int
        Degrees of freedom of the model.

    Returns
    -------
    Patches
        Patches with points "NAME.foot 1", ... at the centroids.

    Raises
    ------
    InputError
        There would be too many.
    """
    facets = mesh.faces[f"{name}.housing.base"]
    weights = face_weights(mesh.points, facets, len(mesh.points), MEANS)
    corners = mesh.points[facets[:, :3]]
    vectors = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals = np.zeros_like(mesh.points)
    for k in range(facets.shape[1]):
        np.add.at(normals, facets[:, k], vectors)
    nodes = mesh.face_nodes(f"{name}.housing.base")
    nodes = nodes[np.abs(weights[nodes]) > 1e-6 * weights[nodes].max()]
    at, weight, normal = mesh.points[nodes], weights[nodes], normals[nodes]
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    low, extent = at.min(axis=0), np.maximum(np.ptp(at, axis=0), 1e-9 * size)
    count = np.ceil(extent / size - 1e-6)
    cell = np.minimum(np.floor((at - low) / extent * count + 1e-6), count - 1)
    keys = np.column_stack([cell, np.round(normal)])
    _, patch = np.unique(keys, axis=0, return_inverse=True)
    patch = _joined(patch.ravel(), at, weight)
    if (total := patch.max() + 1) > MAX_PATCHES:
        raise InputError(
            f"{name}.housing: its foot has {total} patches of {size:g} m but must have at most "
            f"{MAX_PATCHES}: make them larger"
        )
    points, areas, directions = [], [], []
    for number in range(total):
        mine = patch == number
        area = weight[mine].sum()
        share = weight[mine] / area
        columns = (3 * nodes[mine][:, None] + np.arange(3)).T
        motion = sparse.coo_array(
            (np.tile(share, 3), (np.repeat(np.arange(3), mine.sum()), columns.ravel())),
            shape=(6, n_dofs),
        )
        points.append(ReferencePoint(f"{name}.foot {number + 1}", share @ at[mine], motion.tocsr()))
        areas.append(area)
        directions.append(_axes(-(share @ normal[mine])))
    return Patches(points, np.array(areas), np.array(directions))


def _joined(patch: Ints, at: Floats, weight: Floats) -> Ints:
    """Patches numbered from 0, those of little area with the nearest other."""
    areas = np.bincount(patch, weight)
    centres = np.array([np.bincount(patch, weight * x) for x in at.T]).T / areas[:, None]
    large = areas > _MIN_AREA * areas.mean()
    for small in np.flatnonzero(~large):
        away = np.linalg.norm(centres - centres[small], axis=1)
        away[~large] = np.inf
        patch = np.where(patch == small, np.argmin(away), patch)
    return np.unique(patch, return_inverse=True)[1].ravel()


def _axes(up: Floats) -> Floats:
    """Rows: a direction of unit length, and two across."""
    up = up / np.linalg.norm(up)
    across = np.cross(up, np.eye(3)[np.argmin(np.abs(up))])
    across /= np.linalg.norm(across)
    return np.array([up, across, np.cross(up, across)])


class FootState(NamedTuple):
    """A clamped foot under one load.

    Attributes
    ----------
    motion : Floats
        Motion (6,) of the seat since the bolts were tightened [m, rad].
    closed : Bools
        Flags (P,): patches that are pressed.
    forces : Floats
        Forces (P, 3) of the ground on the patches: pressing, and two across [N].
    lifts : Floats
        Distances (P,) of the patches off the ground [m].
    bolts : Floats
        Forces and moments (B, 6) of the bolts on the housing at their heads [N, N m].
    tension : Floats
        Tension (B,) of the bolts [N].
    """

    motion: Floats
    closed: Bools
    forces: Floats
    lifts: Floats
    bolts: Floats
    tension: Floats


class _Tightened(NamedTuple):
    """Pressed patches, shortening of the bolts, motion of the seat, and where patches then are."""

    pressed: Bools
    shortened: Floats
    seat: Floats
    places: Floats


@dataclass(frozen=True)
class ClampedFoot:
    """A housing condensed to its seat, the patches of its foot, and the heads of its bolts.

    Degrees of freedom of the foot are three of each of P patches, along `directions`, then six of
    each of B heads.

    Attributes
    ----------
    compliance : Floats
        Compliance (n, n) of the foot, the seat held [m/N, 1/N, rad/(N m)].
    rigid : Floats
        Motions (n, 6) of the foot with the seat, where nothing strains.
    areas : Floats
        Areas (P,) of the patches [m^2].
    places : Floats
        Centroids (P, 3) of the patches [m].
    directions : Floats
        (P, 3, 3) rows: out of the ground, and two across.
    bolts : Floats
        (B, 6, 6) stiffness of each bolt at its head, its end in the ground held.
    axes : Floats
        Vectors (B, 3) from the ground to the head.
    preload : Floats
        Tension (B,) after tightening [N].
    ground : float
        Stiffness of the ground over its area, along and across [N/m^3]; inf where it is rigid.
    """

    compliance: Floats
    rigid: Floats
    areas: Floats
    places: Floats
    directions: Floats
    bolts: Floats
    axes: Floats
    preload: Floats
    ground: float = float("inf")

    __repr__ = short_repr

    @cached_property
    def _freely(self) -> Floats:
        """Motions of seat and foot for forces there; bolts hold them, the ground does not."""
        size = len(self.compliance)
        S = scaled_solve(self.compliance, np.eye(size))
        strain = np.hstack([-self.rigid, np.eye(size)])
        K = strain.T @ (0.5 * (S + S.T)) @ strain
        for k, stiffness in enumerate(self.bolts):
            K[self._head(k), self._head(k)] += stiffness
        G = scaled_solve(0.5 * (K + K.T), np.eye(len(K)))
        return np.asarray(0.5 * (G + G.T))

    def _head(self, bolt: int) -> slice:
        first = 6 + 3 * len(self.areas) + 6 * bolt
        return slice(first, first + 6)

    @cached_property
    def _along(self) -> Floats:
        """(B,) stiffness of the bolts along their axes [N/m]."""
        along = np.einsum("bi,bij,bj->b", self.axes, self.bolts[:, :3, :3], self.axes)
        return np.asarray(along, dtype=np.float64)

    @cached_property
    def _pull(self) -> Floats:
        """(6 + n, B) loads of bolts that are shortened by 1 m each."""
        loads = np.zeros((len(self._freely), len(self.bolts)))
        for k, (axis, along) in enumerate(zip(self.axes, self._along, strict=True)):
            loads[self._head(k), k][:3] = -along * axis
        return loads

    def _moved(
        self, pressed: Bools, stuck: Bools, loads: Floats, at: Floats | None = None
    ) -> tuple[Floats, Floats]:
        """Motions (6 + n, m), and forces of the ground on all patches (P, 3, m).

        Normal displacements of pressed patches are zero, those across of stuck ones what `at` has.
        """
        G = self._freely
        held = np.flatnonzero(np.column_stack([pressed, stuck, stuck]))
        u = G @ loads
        forces = np.zeros((3 * len(pressed), loads.shape[1]))
        if len(held):
            rows = 6 + held
            softness = np.repeat(1.0 / (self.ground * self.areas), 3)[held]
            wanted = -u[rows] if at is None else at[held, None] - u[rows]
            forces[held] = scaled_solve(G[np.ix_(rows, rows)] + np.diag(softness), wanted)
            u = u + G[:, rows] @ forces[held]
        return u, forces.reshape(len(pressed), 3, -1)

    def _tension(self, u: Floats, shortened: Floats) -> Floats:
        """(B, m) of the bolts."""
        heads = np.stack([u[self._head(k)][:3] for k in range(len(self.axes))])
        moved = np.einsum("bi,bim->bm", self.axes, heads)
        return np.asarray(self._along[:, None] * (moved + shortened))

    def _shortening(self, pressed: Bools) -> Floats:
        """(B,) by how much bolts are shortened to have their preload, the foot sliding [m]."""
        u, _ = self._moved(pressed, np.zeros_like(pressed), self._pull)
        return np.asarray(
            np.linalg.solve(self._tension(u, np.eye(len(self.axes))), self.preload), np.float64
        )

    @cached_property
    def _tightened(self) -> _Tightened:
        """State under the bolts alone; the foot slides while they are tightened."""
        free = np.zeros(len(self.areas), dtype=np.bool_)

        def solved(pressed: Bools) -> tuple[Floats, Floats]:
            if not pressed.any():
                raise InputError(
                    "no patch of the foot stays on the ground when its bolts are tightened: check "
                    "the held faces and the washers"
                )
            return self._moved(pressed, free, self._pull @ self._shortening(pressed)[:, None])

        pressed, u = self._settled(solved, ~free)
        places = u[6 : 6 + 3 * len(free), 0].copy()
        places[::3] = 0.0
        return _Tightened(pressed, self._shortening(pressed), u[:6, 0], places)

    def _settled(
        self, solved: Callable[[Bools], tuple[Floats, Floats]], start: Bools
    ) -> tuple[Bools, Floats]:
        """Change what is pressed until no patch is pulled and none is in the ground."""
        pressed = start
        for number in range(_MAX_PASSES):
            u, forces = solved(pressed)
            pressing, lift = forces[:, 0, 0], u[6 : 6 + 3 * len(pressed) : 3, 0]
            pulled = pressed & (pressing < -_NOTHING * np.abs(forces).max(initial=0.0))
            inside = ~pressed & (lift < -_NOTHING * np.abs(u[6 : 6 + 3 * len(pressed)]).max())
            wrong = np.flatnonzero(pulled | inside)
            if not len(wrong):
                return pressed, u
            pressed = pressed.copy()
            # changing the least number alone ends for certain (Murty 1974)
            some = wrong if number < _TOGETHER else wrong[:1]
            pressed[some] = ~pressed[some]
        raise InputError(
            f"contact of the foot does not settle in {_MAX_PASSES} passes: make its patches larger"
        )

    @property
    def tightened(self) -> FootState:
        """The state after tightening; its motion is zero."""
        return self.linear(np.zeros(6))

    def state(self, wrench: Floats) -> FootState:
        """State under a load at the seat, contact and all.

        Parameters
        ----------
        wrench : Floats
            Force and moment (6,) on the seat, at the bearing's centre [N, N m].

        Raises
        ------
        InputError
            Contact does not settle.
        """
        tightened = self._tightened
        loads = self._loads(wrench)
        pressed = stuck = tightened.pressed
        while True:

            def solved(some: Bools, stuck: Bools = stuck) -> tuple[Floats, Floats]:
                return self._moved(some, stuck, loads, tightened.places)

            pressed, _ = self._settled(solved, pressed)
            # one that lifts is let go, and slides where it comes down again
            if not (stuck & ~pressed).any():
                return self._state(pressed, stuck, loads)
            stuck = stuck & pressed

    def linear(self, wrench: Floats) -> FootState:
        """State where every patch stays as it is after tightening: the levels' answer.

        Parameters
        ----------
        wrench : Floats
            Force and moment (6,) on the seat, at the bearing's centre [N, N m].
        """
        pressed = self._tightened.pressed
        return self._state(pressed, pressed, self._loads(wrench))

    def _loads(self, wrench: Floats) -> Floats:
        loads = self._pull @ self._tightened.shortened[:, None]
        loads[:6, 0] += wrench
        return loads

    def _state(self, pressed: Bools, stuck: Bools, loads: Floats) -> FootState:
        tightened = self._tightened
        u, forces = self._moved(pressed, stuck, loads, tightened.places)
        bolts = [
            loads[self._head(k), 0] - stiffness @ u[self._head(k), 0]
            for k, stiffness in enumerate(self.bolts)
        ]
        return FootState(
            u[:6, 0] - tightened.seat,
            pressed,
            forces[..., 0],
            u[6 : 6 + 3 * len(pressed) : 3, 0],
            np.array(bolts),
            self._tension(u, tightened.shortened[:, None])[:, 0],
        )

    @cached_property
    def stiffness(self) -> Floats:
        """(6, 6) at the seat while the foot stays as it is after tightening [N/m, N, N m/rad]."""
        loads = np.zeros((len(self._freely), 6))
        loads[:6] = np.eye(6)
        C = self._moved(self._tightened.pressed, self._tightened.pressed, loads)[0][:6]
        return scaled_solve(0.5 * (C + C.T), np.eye(6))

    def slopes(self) -> tuple[Floats, Floats]:
        """Changes by unit loads at the seat while the foot stays as it is after tightening.

        Returns
        -------
        Floats
            (P, 6) pressing forces of the patches.
        Floats
            (B, 6) tension of the bolts: of a pull along their axes the load factors phi.
        """
        loads = np.zeros((len(self._freely), 6))
        loads[:6] = np.eye(6)
        u, forces = self._moved(self._tightened.pressed, self._tightened.pressed, loads)
        return forces[:, 0], self._tension(u, np.zeros((len(self.axes), 6)))

    def opening(self, wrench: Floats) -> tuple[float, int]:
        """Minimum factor on a load at which a pressed patch opens, and the number of the patch.

        Parameters
        ----------
        wrench : Floats
            Force and moment (6,) on the seat, at the bearing's centre [N, N m].

        Returns
        -------
        float
            inf where none ever opens.
        int
            Number of the patch, from 0.
        """
        pressed = self.tightened
        change = self.slopes()[0] @ wrench
        falls = pressed.closed & (change < 0.0)
        factors = np.full(len(change), np.inf)
        factors[falls] = pressed.forces[falls, 0] / -change[falls]
        first = int(np.argmin(factors))
        return float(factors[first]), first

    def opened_by(self, wrenches: Floats) -> Bools:
        """Flags (N,): whether the linear answer pulls on a patch, for each of many loads.

        Parameters
        ----------
        wrenches : Floats
            Wrenches (N, 6) at the seat [N, N m].
        """
        pressed = self.tightened
        forces = pressed.forces[:, 0] + wrenches @ self.slopes()[0].T
        least = forces[:, pressed.closed].min(axis=1)
        return np.asarray(least < -_NOTHING * pressed.forces[:, 0].max())

    def path(self, wrench: Floats, factors: Sequence[float]) -> list[FootState]:
        """States under a load times each of some factors.

        Parameters
        ----------
        wrench : Floats
            Force and moment (6,) on the seat, at the bearing's centre [N, N m].
        factors : Sequence[float]
            Factors on the wrench.
        """
        return [self.state(factor * np.asarray(wrench)) for factor in factors]
