"""Influence functions of a body of revolution: what a roller's push moves the raceway elsewhere.

A radial push on a patch of a cylinder's surface, a strip of it along x and an arc of it round the
axis, is a Fourier sum over the circumference, and so is the displacement that it causes. Harmonic
by harmonic the body answers in its meridian alone (see `harmonics`), so that the compliance
between any two places of the raceway is a sum of cosines of the angle between them. A push without
width has no finite displacement under itself (it grows as the logarithm of the number of
harmonics): patches have a width, along which both the pressure is uniform and the displacement is
averaged. Then the compliance is symmetric whatever the mesh, and the sum converges.

The elastic approach of a roller and the raceway close to their contact is part of the answer if the
patch is as narrow as the contact. Where a law of contact has it already, as Palmgren's line contact
does, give a patch about as wide as the rollers are apart, or it is counted twice.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy import linalg

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.drivetrain_file.materials import Material
from fe_drivetrain.elasticity.revolution.harmonics import (
    Traction,
    along_sides,
    dofs,
    harmonic_solver,
    rigid_motions,
    rigid_motions_at,
    surface_loads,
)
from fe_drivetrain.elasticity.revolution.meridian_mesh import Meridian
from fe_drivetrain.geometry import LENGTH_TOLERANCE


@dataclass(frozen=True)
class Strip:
    """A length of a cylinder of the body's surface, bore or outside.

    Attributes
    ----------
    radius : float
        Radius of the surface [m].
    low, high : float
        Both ends along x [m].
    """

    radius: float
    low: float
    high: float


@dataclass(frozen=True)
class InfluenceFunctions:
    """Radial compliance between patches of a body of revolution.

    Attributes
    ----------
    strips : tuple[Strip, ...]
        The m strips that patches lie on.
    half_angle : float
        Half of a patch's arc [rad].
    harmonic_compliances : Floats
        Compliances (N + 1, m, m) of harmonics 0 to N: amplitude of the mean radial displacement of
        a strip, outwards, for radial pressure on another of an amplitude of 1 / (2 pi) newtons a
        radian in harmonic 0, of 1 / pi in others [m/N].
    limits : Floats
        Product (m,) of order and compliance of each strip, on a half space in plane strain [m/N]:
        what high orders tend to away from the strip's ends.
    """

    strips: tuple[Strip, ...]
    half_angle: float
    harmonic_compliances: Floats
    limits: Floats

    __repr__ = short_repr

    @property
    def shares(self) -> Floats:
        """(N + 1,) of a patch's push in each harmonic: sin(n a) / (n a)."""
        n = np.arange(len(self.harmonic_compliances))
        return np.asarray(np.sinc(n * self.half_angle / np.pi))

    def matrix(self, angles: ArrayLike) -> Floats:
        """Compliance between patches at given angles [m/N].

        Parameters
        ----------
        angles : ArrayLike
            Angles (k,) of the middles of patches round the axis, each on all strips [rad].

        Returns
        -------
        (k m, k m), the m strips of the first angle first: mean radial displacement of a patch,
        outwards, for radial pressure that sums up to 1 N on another, outwards. Symmetric.
        """
        return self._between(angles, angles, self.shares**2)

    def profile(self, at: ArrayLike, angles: ArrayLike) -> Floats:
        """(k m, j m) as `matrix`, at single angles ``at`` (k,) for patches at ``angles`` (j,)."""
        return self._between(at, angles, self.shares)

    def _between(self, at: ArrayLike, angles: ArrayLike, shares: Floats) -> Floats:
        at, angles = np.atleast_1d(at), np.atleast_1d(angles)
        n = np.arange(len(shares))
        waves = np.cos(np.subtract.outer(at, angles)[..., None] * n) * shares
        found = np.tensordot(waves, self.harmonic_compliances, axes=1)
        m = len(self.strips)
        return np.asarray(found.transpose(0, 2, 1, 3).reshape(len(at) * m, len(angles) * m))

    @property
    def tail(self) -> Floats:
        """(m,) estimate of what the orders above N would add to a patch's own compliance [m/N].

        They fall as 1 / n: from the last one on, or as on a half space if that is more.
        """
        N = len(self.harmonic_compliances) - 1
        last = N * self.harmonic_compliances[-1].diagonal()
        return np.asarray(np.maximum(last, self.limits) * self._beyond(N))

    def _beyond(self, N: int) -> float:
        """Sum of sin^2(n a) / (n a)^2 / n over n > N."""
        from scipy import special

        a = self.half_angle
        n = np.arange(N + 1, max(100 * N, math.ceil(100 / a)) + 1)
        # sin^2 is half on average beyond
        rest = -special.polygamma(2, n[-1] + 1.0) / 4.0 / a**2
        return float((np.sinc(n * a / np.pi) ** 2 / n).sum() + rest)


def influence_functions(
    mesh: Meridian,
    material: Material,
    strips: Sequence[Strip],
    harmonics: int,
    half_angle: float,
    *,
    held: Ints | None = None,
    anchor: Strip | None = None,
) -> InfluenceFunctions:
    """Compliance of strips of a body of revolution against radial pushes, by harmonics.

    Parameters
    ----------
    mesh, material : Meridian, Material
        The meridian, fine enough at the strips for waves of 1 / N of the circumference, and what
        it is of.
    strips : Sequence[Strip]
        Strips on its outline; each may be one lamina of a raceway. Best with elements that end
        where they do (`Shaft.cut`): a jump of pressure inside an element makes it a little too
        stiff.
    harmonics : int
        N, the highest: about 5 / half_angle for 1e-3, see `InfluenceFunctions.tail`.
    half_angle : float
        Half of a patch's arc [rad].
    held : Ints or None
        Degrees of freedom (k,) of the mesh that don't move in any harmonic, such as those of a
        surface in a rigid housing; see `harmonics.dofs`.
    anchor : Strip or None
        Strip where a body that ``held`` leaves free to move sideways is supported: displacements
        are relative to the mean motion of this strip, which takes the resultant of all pushes.
        Where they are in balance it takes nothing and is only the reference.

    Raises
    ------
    InputError
        A strip is not on the outline, a number is out of its range, or the body is neither held
        nor anchored against moving sideways.
    """
    for name, value, right, allowed in (
        ("harmonics", harmonics, harmonics >= 1, "1 or more"),
        ("half_angle", half_angle, 0 < half_angle <= math.pi, "above 0 and at most pi rad"),
        ("strips", len(strips), len(strips) > 0, "at least one"),
    ):
        if not right:
            raise InputError(f"influence: {name} is {value:g} but must be {allowed}: change it")
    size = 3 * len(mesh.nodes)
    still = np.empty(0, dtype=np.int64) if held is None else np.asarray(held, dtype=np.int64)
    pushes = np.zeros((size, len(strips)))
    for column, strip in enumerate(strips):
        nodes, weights, _ = strip_averages(mesh, strip)
        np.add.at(pushes[:, column], dofs(nodes, 1), weights)
    found = []
    for n in range(harmonics + 1):
        mix = _loose(mesh, n, still)
        motions = rigid_motions(mesh, n).reshape(size, -1) @ mix
        loads = pushes
        if n == 1 and mix.size:
            if anchor is None:
                raise InputError(
                    "influence: the body is free to move sideways: give the anchor that its "
                    "displacements are relative to, or hold it"
                )
            # balanced by the anchor; the same takes its mean motion off the displacements
            takes = _tractions(mesh, n, anchor) @ mix
            loads = pushes - takes @ np.linalg.solve(motions.T @ takes, motions.T @ pushes)
        solve = harmonic_solver(mesh, material, n, np.concatenate([still, _pins(motions)]))
        found.append(loads.T @ solve(loads))
    E, nu = material.youngs_modulus, material.poisson_ratio
    widths = np.array([strip.high - strip.low for strip in strips])
    return InfluenceFunctions(
        tuple(strips),
        half_angle,
        np.array(found),
        2.0 * (1.0 - nu**2) / (math.pi * E * widths),
    )


def carried(compliance: Floats, rigid: Floats, supports: Sequence[int]) -> Floats:
    """Compliance of a body that rests on some of its patches, which don't give.

    Parameters
    ----------
    compliance : Floats
        Compliance (k, k) between all patches, relative to an anchor [m/N].
    rigid : Floats
        Displacement (k, r) of each patch by the body's rigid motions: cos and sin of its angle for
        those sideways.
    supports : Sequence[int]
        Numbers of the patches that are held; their forces, found along with the motions, balance
        all others, so that nothing is left to the anchor.

    Returns
    -------
    (k - s, k - s) between the other patches, in their order [m/N].

    Raises
    ------
    InputError
        The supports leave a rigid motion free.
    """
    at = np.asarray(supports, dtype=np.int64)
    other = np.setdiff1d(np.arange(len(compliance)), at)
    r = rigid.shape[1]
    if len(at) < r or np.linalg.matrix_rank(rigid[at]) < r:
        raise InputError(
            f"{len(at)} supports leave the body free to move: give at least {r} at other angles"
        )
    # forces in balance: those of the supports, and the motions, as unknowns
    system = np.zeros((len(at) + r, len(at) + r))
    system[: len(at), : len(at)] = compliance[np.ix_(at, at)]
    system[: len(at), len(at) :] = rigid[at]
    system[len(at) :, : len(at)] = rigid[at].T
    coupling = np.hstack([compliance[np.ix_(other, at)], rigid[other]])
    # of one size: compliances are some 1e-10 m/N, motions 1
    scale = np.concatenate(
        [np.full(len(at), 1.0), np.full(r, np.abs(compliance[np.ix_(at, at)]).max())]
    )
    system *= np.outer(scale, scale)
    coupling *= scale
    found = compliance[np.ix_(other, other)] - coupling @ np.linalg.solve(system, coupling.T)
    return np.asarray(0.5 * (found + found.T))


def roller_forces(
    compliance: Floats, approach: Floats, stiffness: float, exponent: float = 1.0
) -> Floats:
    """Forces of rollers that press where they touch, and are loose elsewhere.

    Each deforms by d = (F / stiffness)^(1 / exponent) and its raceway by the compliance times all
    forces; together they make up the approach, or less of it where the roller is loose.

    Parameters
    ----------
    compliance : Floats
        Compliance (k, k) of the raceway, outwards [m/N], see `InfluenceFunctions.matrix`; zero of a
        rigid one.
    approach : Floats
        Approach (k,) of the two raceways at each roller if nothing deformed, clearance taken off
        [m].
    stiffness, exponent : float
        Stiffness of each roller [N/m^exponent], and its exponent: 1 of a spring, 10/9 of a line
        contact, 3/2 of a point contact (Palmgren 1957).

    Returns
    -------
    (k,) [N]; by Newton's method, for every force is a growing function of its own d.

    Raises
    ------
    InputError
        The exponent is below 1, or the stiffness is not above 0.
    """
    if not (exponent >= 1.0 and stiffness > 0.0):
        raise InputError(
            f"rollers: stiffness is {stiffness:g} and exponent {exponent:g} but they must be above "
            "0 and at least 1: change them"
        )

    def forces(d: Floats) -> Floats:
        return np.asarray(stiffness * np.maximum(d, 0.0) ** exponent)

    def gap(d: Floats) -> Floats:
        return np.asarray(d + compliance @ forces(d) - approach)

    d = np.array(approach, dtype=float)
    size = np.linalg.norm(d)
    left = gap(d)
    for _ in range(_STEPS):
        if np.linalg.norm(left) <= 1e-13 * size:
            return forces(d)
        slope = np.where(d > 0.0, stiffness * exponent * np.maximum(d, 0.0) ** (exponent - 1), 0.0)
        step = np.linalg.solve(np.eye(len(d)) + compliance * slope, left)
        share = 1.0
        while np.linalg.norm(gap(d - share * step)) > np.linalg.norm(left) and share > 1e-6:
            share *= 0.5
        d = d - share * step
        left = gap(d)
    raise InputError(
        f"rollers: forces are not found within {_STEPS} steps of Newton's method: check that the "
        "compliance is symmetric and of stable supports"
    )


_STEPS = 100


def strip_averages(mesh: Meridian, strip: Strip) -> tuple[Ints, Floats, Floats]:
    """Nodes and their weights in the mean over a strip, which may end inside an element.

    Parameters
    ----------
    mesh : Meridian
        The meridian.
    strip : Strip
        Strip on the meridian's outline.

    Returns
    -------
    nodes : Ints
        Nodes (k,), some more than once.
    mean, slope : Floats
        Weights (k,) in the mean, and in the slope along x of the straight line that is closest
        [1/m].

    Raises
    ------
    InputError
        The strip is not on a cylinder of the outline.
    """
    width, middle = strip.high - strip.low, 0.5 * (strip.low + strip.high)
    abscissa, weight = np.polynomial.legendre.leggauss(mesh.element.order + 1)
    nodes, weights, slopes, covered = [], [], [], 0.0
    for side in range(mesh.element.corners):
        cells = mesh.boundary[mesh.boundary[:, 1] == side, 0]
        if not len(cells):
            continue
        _, at, _ = along_sides(mesh, side, cells, np.array([0.0, 0.5, 1.0]))
        on = np.flatnonzero((np.abs(at[..., 1] - strip.radius) < LENGTH_TOLERANCE).all(axis=1))
        for cell, (start, end) in zip(cells[on], at[on][:, [0, 2], 0], strict=True):
            low, high = max(strip.low, min(start, end)), min(strip.high, max(start, end))
            if high - low < LENGTH_TOLERANCE:
                continue
            x = low + (high - low) * (abscissa + 1.0) / 2.0
            values, _, _ = along_sides(mesh, side, cells[:1], (x - start) / (end - start))
            nodes.append(mesh.cells[cell])
            share = weight * (high - low) / 2.0
            weights.append(share @ values / width)
            slopes.append((share * (x - middle)) @ values / (width**3 / 12.0))
            covered += high - low
    if not 0.0 < width < math.inf or abs(covered - width) > 1e-6 * width:
        raise InputError(
            f"strip of radius {strip.radius:g} m from x = {strip.low:g} m to {strip.high:g} m is "
            "not on a cylinder of the outline, bore or outside: move or shorten it"
        )
    return np.concatenate(nodes), np.concatenate(weights), np.concatenate(slopes)


def _loose(mesh: Meridian, n: int, held: Ints) -> Floats:
    """(r, k) combinations of the harmonic's rigid motions that what is held leaves free."""
    motions = rigid_motions(mesh, n)
    if not motions.size:
        return np.zeros((0, 0))
    if not len(held):
        return np.eye(motions.shape[1])
    size = np.abs(motions).max(axis=0)
    return np.asarray(linalg.null_space(motions[held] / size, rcond=1e-9) / size[:, None])


def _pins(motions: Floats) -> Ints:
    """Degrees of freedom that stop the motions, one for each."""
    count = motions.shape[1]
    if not count:
        return np.empty(0, dtype=np.int64)
    scaled = motions / np.abs(motions).max(axis=0)
    return np.asarray(linalg.qr(scaled.T, mode="r", pivoting=True)[1][:count])


def _tractions(mesh: Meridian, n: int, anchor: Strip) -> Floats:
    """Nodal forces (3 n_nodes, r) of tractions on the anchor as large as each rigid motion."""
    sides = mesh.sides(
        lambda x, r: (
            (np.abs(r - anchor.radius) < LENGTH_TOLERANCE)
            & (x > anchor.low - LENGTH_TOLERANCE)
            & (x < anchor.high + LENGTH_TOLERANCE)
        )
    )
    if not len(sides):
        raise InputError(
            f"anchor of radius {anchor.radius:g} m from x = {anchor.low:g} m to {anchor.high:g} m "
            "has no whole side of an element: make it longer, or move it onto the outline"
        )

    def motion(k: int) -> Traction:
        return lambda at, _: rigid_motions_at(at, n)[:, :, k]

    return np.column_stack([surface_loads(mesh, n, sides, motion(k)) for k in (0, 1)])
