"""Compiled loops over rollers and laminae.

A rolling element at the angle psi sees three numbers of the inner ring's motion: a along the axis,
w = e_r . (u_y, u_z) along its radius, and the tilt t about its tangent. Its laminae approach by

    b + xi c - free,   b = a sin(alpha) + w cos(alpha) + t arm,   c = t

(rollers), or by how much the distance of the groove centres grows (balls). The sum of the energies
K delta_+^(n+1) / (n+1) over all laminae is convex in the motion, and its gradient and Hessian are
forces and tangent stiffness.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numba import types
from numba.extending import intrinsic

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.compiled import inner_loop, njit

#: Kinds of rows, and where in a row of ``data`` its numbers are.
LAMINAE, CLOSED, BALLS = 0, 1, 2
KIND, SIN, COS, ARM, LEAN, STIFF, EXPONENT, LENGTH, GAP, AXIAL, RADIAL, DISTANCE, GROOVE = range(13)
EVEN = 13  # 1 where the nodes of a row may stand for its laminae
N_DATA = 14

#: Load cases that are taken in turn, each starting from the one before it. A fixed number, so that
#: results do not depend on how many threads share the chunks.
CHUNK = 512


class Packed(NamedTuple):
    """A bearing as these loops take it.

    Attributes
    ----------
    data : Floats
        Numbers (rows, N_DATA) of each row.
    first : Ints
        Number (rows + 1,) at which the rolling elements of each row begin.
    sines, cosines : Floats
        Sines and cosines (total,) of the places of all rolling elements.
    lam : Ints
        Number (rows + 1,) at which the laminae of each row begin.
    xi, free, shares : Floats
        Places (laminae,) along the roller, what each has to approach first [m], and its share of
        the roller's stiffness.
    nodes, node_shares : Floats
        Places and shares (rows, NODES) that stand for all laminae of a straight roller which is
        loaded along all of its length: `gauss_of_laminae`.
    tables : Floats
        Tables (rows, POWERS) from `power_table`.
    """

    data: Floats
    first: Ints
    sines: Floats
    cosines: Floats
    lam: Ints
    xi: Floats
    free: Floats
    shares: Floats
    nodes: Floats
    node_shares: Floats
    tables: Floats


class PackedRow(NamedTuple):
    """One row of a bearing; each field is the row's part of that of `Packed`."""

    data: Floats
    xi: Floats
    free: Floats
    shares: Floats
    nodes: Floats
    node_shares: Floats
    table: Floats


NODES = 10
"""Places that stand for the laminae of a roller. Where approaches along it are within half of their
mean, sums of their powers are those over the laminae to 1e-13."""


def gauss_of_laminae(count: int) -> tuple[Floats, Floats]:
    """Gauss's rule of a sum over equal laminae: places over the length, -1/2 to 1/2, and weights.

    Sums of polynomials up to degree 2 NODES - 1 are exact. The orthogonal polynomials are Gram's
    (discrete Chebyshev), whose recurrence is that of Legendre as ``count`` grows; 0 laminae is
    their integral.
    """
    k = np.arange(1.0, NODES)
    beta = k**2 / (4.0 * (4.0 * k**2 - 1.0))
    if count:
        beta *= np.maximum(1.0 - (k / count) ** 2, 0.0)
    x, vectors = np.linalg.eigh(np.diag(np.sqrt(beta), 1) + np.diag(np.sqrt(beta), -1))
    return np.asarray(x), np.asarray(vectors[0] ** 2)


# Gauss points of [-1, 1], for straight rollers whose load is smooth along them.
_GAUSS_X, _GAUSS_W = np.polynomial.legendre.leggauss(10)


# Powers of many numbers without a logarithm each: x = 2^e m, m near one of these middles, m^q from
# a table and six terms of the binomial series, whose rest is below round-off. (A library's power
# takes most of the time of an equilibrium otherwise.)
_BITS = 7
_TERMS = 6
POWERS = 2048 + 2 * 2**_BITS + _TERMS
_TO_MIDDLE, _OF_MIDDLE, _SERIES = 2048, 2048 + 2**_BITS, 2048 + 2 * 2**_BITS


def power_table(q: float) -> Floats:
    """Constants that `power` needs for the exponent q: (POWERS,)."""
    table = np.zeros(POWERS)
    with np.errstate(over="ignore", under="ignore"):
        table[1:_TO_MIDDLE] = 2.0 ** (q * (np.arange(1.0, 2048.0) - 1023.0))
    middles = 1.0 + (np.arange(2**_BITS) + 0.5) / 2**_BITS
    table[_TO_MIDDLE:_OF_MIDDLE] = 1.0 / middles
    table[_OF_MIDDLE:_SERIES] = middles**q
    k = np.arange(_TERMS)
    table[_SERIES:] = np.cumprod((q - k) / (k + 1.0))
    return table


def _same_bits(context: Any, builder: Any, signature: Any, values: Any) -> Any:
    return builder.bitcast(values[0], context.get_value_type(signature.return_type))


def _float_to_bits(_context: Any, _x: Any) -> tuple[Any, Callable[..., Any]]:
    return types.uint64(types.float64), _same_bits


def _bits_to_float(_context: Any, _bits: Any) -> tuple[Any, Callable[..., Any]]:
    return types.float64(types.uint64), _same_bits


# The bits of a float as a whole number, and back.
_bits: Any = intrinsic(_float_to_bits)
_of_bits: Any = intrinsic(_bits_to_float)


# Unsigned, so that an index needs no look whether it counts from the end.
_TO_BIT, _IN_TABLE, _TO_EXPONENT = np.uint64(52 - _BITS), np.uint64(2**_BITS - 1), np.uint64(52)
_MANTISSA, _ONE = np.uint64(2**52 - 1), np.uint64(1023 << 52)
_FIRST, _SECOND = np.uint64(_TO_MIDDLE), np.uint64(_OF_MIDDLE)


@njit(cache=True, error_model="numpy", fastmath={"reassoc", "contract"})
def power(x: float, table: Floats) -> float:
    """x^q of a positive x, and 0 of 0, from the table of q."""
    c1, c2, c3 = table[_SERIES], table[_SERIES + 1], table[_SERIES + 2]
    c4, c5, c6 = table[_SERIES + 3], table[_SERIES + 4], table[_SERIES + 5]
    b = _bits(x)
    i = (b >> _TO_BIT) & _IN_TABLE
    r = _of_bits((b & _MANTISSA) | _ONE) * table[_FIRST + i] - 1.0
    series = 1.0 + r * (c1 + r * (c2 + r * (c3 + r * (c4 + r * (c5 + r * c6)))))
    return float(table[b >> _TO_EXPONENT] * table[_SECOND + i] * series)


@inner_loop
def _power(x: float, n: float) -> float:
    """x^n for positive x; the exponents of springs and balls without a logarithm."""
    if n == 0.0:
        return 1.0
    if n == 0.5:
        return float(np.sqrt(x))
    return float(x**n)


@inner_loop
def closed(b: float, c: float, K: float, n: float, L: float, s: Floats) -> None:
    """Integrals along a straight roller: s becomes load, moment, and three of the tangent."""
    half = 0.5 * abs(c) * L
    z1, z2 = max(b - half, 0.0), b + half
    s[:] = 0.0
    if z2 <= 0.0:
        return
    if z1 > 0.2 * z2:  # smooth and without a rim: the closed form would cancel
        for i in range(10):
            x = 0.5 * L * _GAUSS_X[i]
            z = b + c * x
            e = 0.5 * K * _GAUSS_W[i] * z ** (n - 1.0)
            s[0] += e * z
            s[1] += e * z * x
            s[2] += n * e
            s[3] += n * e * x
            s[4] += n * e * x * x
        return
    q = K / L / abs(c)
    p1, p2 = (z1 ** (n - 1.0) if z1 > 0.0 else 0.0), z2 ** (n - 1.0)
    # integrals of z^(n-1), z^n, z^(n+1) over z; x = (z - b) / c
    i0 = (p2 * z2 - p1 * z1) / n
    i1 = (p2 * z2 * z2 - p1 * z1 * z1) / (n + 1.0)
    i2 = (p2 * z2**3 - p1 * z1**3) / (n + 2.0)
    s[0] = q * i1
    s[1] = q * (i2 - b * i1) / c
    s[2] = q * n * i0
    s[3] = q * n * (i1 - b * i0) / c
    s[4] = q * n * (i2 - 2.0 * b * i1 + b * b * i0) / (c * c)


@inner_loop(fastmath={"reassoc", "contract", "nsz"})
def lamina_sums(
    b: float,
    c: float,
    K: float,
    n: float,
    xi: Floats,
    free: Floats,
    shares: Floats,
    table: Floats,
    s: Floats,
) -> None:
    """The same sums over laminae, `free` being what each has to approach first."""
    s0 = s1 = s2 = s3 = s4 = 0.0
    for k in range(len(xi)):
        x = xi[k]
        z = b + c * x - free[k]
        z = z if z > 0.0 else 0.0
        e = shares[k] * power(z, table)
        q, ex = e * z, e * x
        s0 += q
        s1 += q * x
        s2 += e
        s3 += ex
        s4 += ex * x
    s[0], s[1] = K * s0, K * s1
    K *= n
    s[2], s[3], s[4] = K * s2, K * s3, K * s4


@inner_loop(fastmath={"reassoc", "contract", "nsz"})
def even_sums(
    b: float, c: float, K: float, n: float, x: Floats, shares: Floats, table: Floats, s: Floats
) -> None:
    """The same at nodes that stand for all laminae, each of which is in contact."""
    s0 = s1 = s2 = s3 = s4 = 0.0
    for k in range(NODES):
        at = x[k]
        z = b + c * at
        e = shares[k] * power(z, table)
        q, ex = e * z, e * at
        s0 += q
        s1 += q * at
        s2 += e
        s3 += ex
        s4 += ex * at
    s[0], s[1] = K * s0, K * s1
    K *= n
    s[2], s[3], s[4] = K * s2, K * s3, K * s4


@inner_loop(inline="always")
def roller_sums(row: PackedRow, b: float, c: float, s: Floats) -> None:
    """The same along a roller, in the fastest way that is exact."""
    d = row.data
    K, n = d[STIFF], d[EXPONENT]
    if d[EVEN] == 1.0 and abs(c) * d[LENGTH] <= b:
        even_sums(b, c, K, n, row.nodes, row.node_shares, row.table, s)
    elif d[KIND] == CLOSED:
        closed(b, c, K, n, d[LENGTH], s)
    else:
        lamina_sums(b, c, K, n, row.xi, row.free, row.shares, row.table, s)


@njit(cache=True, error_model="numpy")
def row_of(bearing: Packed, r: int) -> PackedRow:
    """Numbers of one row of a bearing."""
    laminae = slice(bearing.lam[r], bearing.lam[r + 1])
    return PackedRow(
        bearing.data[r],
        bearing.xi[laminae],
        bearing.free[laminae],
        bearing.shares[laminae],
        bearing.nodes[r],
        bearing.node_shares[r],
        bearing.tables[r],
    )


@inner_loop(inline="always")
def _element(row: PackedRow, a: float, w: float, t: float, s: Floats, f: Floats) -> float:
    """One rolling element: f becomes its forces and tangent over (a, w, t); returns its load.

    Written into its callers: handing the arrays on takes longer than the work.

    f holds three forces, then the tangent's aa, aw, at, ww, wt, tt; untouched where the load is
    zero.
    """
    return _ball(row.data, a, w, t, f) if row.data[KIND] == BALLS else _roller(row, a, w, t, s, f)


@inner_loop(inline="always")
def _ball(d: Floats, a: float, w: float, t: float, f: Floats) -> float:
    """The same of a ball, whose approach is by how much its groove centres move apart."""
    vx = d[AXIAL] + a - d[GROOVE] * t
    vr = d[RADIAL] + w + d[ARM] * t
    distance = np.sqrt(vx * vx + vr * vr)
    z = distance - d[DISTANCE]
    if z <= 0.0:
        return 0.0
    e = d[STIFF] * _power(z, d[EXPONENT] - 1.0)
    Q, k = e * z, d[EXPONENT] * e
    vx /= distance
    vr /= distance
    # k n n^T + Q / distance (I - n n^T), over the groove centre's motion, then over (a, w, t)
    turn = Q / distance
    xx = k * vx * vx + turn * vr * vr
    xr = (k - turn) * vx * vr
    rr = k * vr * vr + turn * vx * vx
    g, x = -d[GROOVE], d[ARM]
    f[0], f[1], f[2] = Q * vx, Q * vr, Q * (vx * g + vr * x)
    f[3], f[4], f[5] = xx, xr, xx * g + xr * x
    f[6], f[7] = rr, xr * g + rr * x
    f[8] = xx * g * g + 2.0 * xr * g * x + rr * x * x
    return float(Q)


@inner_loop(inline="always")
def _roller(row: PackedRow, a: float, w: float, t: float, s: Floats, f: Floats) -> float:
    """The same of a roller; s becomes its sums along it."""
    d = row.data
    sin, cos, arm, lean = d[SIN], d[COS], d[ARM], d[LEAN]
    b = a * sin + w * cos + t * arm - d[GAP]
    c = t * lean
    if b + 0.5 * abs(c) * d[LENGTH] <= 0.0:
        return 0.0
    roller_sums(row, b, c, s)
    Q = s[0]
    if Q <= 0.0:
        return 0.0
    k, k1 = s[2], s[2] * arm + s[3] * lean
    f[0], f[1], f[2] = Q * sin, Q * cos, Q * arm + s[1] * lean
    f[3], f[4], f[5] = k * sin * sin, k * sin * cos, k1 * sin
    f[6], f[7] = k * cos * cos, k1 * cos
    f[8] = s[2] * arm * arm + 2.0 * s[3] * arm * lean + s[4] * lean
    return float(Q)


@inner_loop
def evaluate(
    u: Floats,
    bearing: Packed,
    F: Floats,
    K: Floats,
    s: Floats,
    f: Floats,
) -> float:
    """Forces and tangent stiffness at a motion u, into F and K; the sum of all loads."""
    total = 0.0
    F0 = F1 = F2 = F3 = F4 = 0.0
    K00 = K01 = K02 = K03 = K04 = K11 = K12 = K22 = 0.0
    K13 = K14 = K23 = K24 = K33 = K34 = K44 = 0.0
    a, uy, uz, ty, tz = u
    cosines, sines = bearing.cosines, bearing.sines
    for r in range(len(bearing.data)):
        d = bearing.data[r]
        row = row_of(bearing, r)
        sin, cos, arm, half = d[SIN], d[COS], d[ARM], 0.5 * d[LENGTH] * d[LEAN]
        ball = d[KIND] == BALLS
        for i in range(bearing.first[r], bearing.first[r + 1]):
            co, si = cosines[i], sines[i]
            # e_r = (-cos, sin) of (y, z), and the tangent e_x x e_r = (-sin, -cos)
            w = si * uz - co * uy
            t = -(si * ty + co * tz)
            if not ball and a * sin + w * cos + t * arm + abs(t) * half <= d[GAP]:
                continue
            Q = _element(row, a, w, t, s, f)
            if Q <= 0.0:
                continue
            total += Q
            F0 += f[0]
            F1 -= co * f[1]
            F2 += si * f[1]
            F3 -= si * f[2]
            F4 -= co * f[2]
            cc, cs, ss = co * co, co * si, si * si
            K00 += f[3]
            K01 -= co * f[4]
            K02 += si * f[4]
            K03 -= si * f[5]
            K04 -= co * f[5]
            K11 += cc * f[6]
            K12 -= cs * f[6]
            K22 += ss * f[6]
            K13 += cs * f[7]
            K14 += cc * f[7]
            K24 -= cs * f[7]
            K23 -= ss * f[7]
            K33 += ss * f[8]
            K34 += cs * f[8]
            K44 += cc * f[8]
    F[0], F[1], F[2], F[3], F[4] = F0, F1, F2, F3, F4
    K[0, 0], K[0, 1], K[0, 2], K[0, 3], K[0, 4] = K00, K01, K02, K03, K04
    K[1, 0], K[1, 1], K[1, 2], K[1, 3], K[1, 4] = K01, K11, K12, K13, K14
    K[2, 0], K[2, 1], K[2, 2], K[2, 3], K[2, 4] = K02, K12, K22, K23, K24
    K[3, 0], K[3, 1], K[3, 2], K[3, 3], K[3, 4] = K03, K13, K23, K33, K34
    K[4, 0], K[4, 1], K[4, 2], K[4, 3], K[4, 4] = K04, K14, K24, K34, K44
    return total


@njit(cache=True, nogil=True, error_model="numpy")
def forces_of(
    displacements: Floats,
    bearing: Packed,
    loads: Floats,
    tangents: Floats,
) -> None:
    """Loads (n, 5) and tangent stiffness (n, 5, 5) at given displacements (n, 5), filled."""
    s, f = np.zeros(5), np.zeros(9)
    for i in range(len(displacements)):
        evaluate(
            displacements[i],
            bearing,
            loads[i],
            tangents[i],
            s,
            f,
        )


@njit(cache=True, nogil=True, error_model="numpy")
def elements_of(
    displacements: Floats,
    bearing: Packed,
    loads: Floats,
    moments: Floats,
    angles: Floats,
) -> None:
    """Load, moment about its middle, and contact angle of each rolling element: (n, total)."""
    s, f = np.zeros(5), np.zeros(9)
    for i in range(len(displacements)):
        a, uy, uz, ty, tz = displacements[i]
        for r in range(len(bearing.data)):
            d = bearing.data[r]
            row = row_of(bearing, r)
            for j in range(bearing.first[r], bearing.first[r + 1]):
                co, si = bearing.cosines[j], bearing.sines[j]
                w = si * uz - co * uy
                t = -(si * ty + co * tz)
                Q = _element(row, a, w, t, s, f)
                loads[i, j] = Q
                moments[i, j] = s[1] if Q > 0.0 and d[KIND] != BALLS else 0.0
                angles[i, j] = np.arctan2(d[SIN], d[COS])
                if Q > 0.0 and d[KIND] == BALLS:
                    angles[i, j] = np.arctan2(f[0], f[1])
