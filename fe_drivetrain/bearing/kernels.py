"""Compiled loops over rollers and laminae.

A rolling element at the angle psi sees three numbers of the inner ring's motion: a along the axis,
w = e_r . (u_y, u_z) along its radius, and the tilt t about its tangent. Its laminae approach by

    b + xi c - free,   b = a sin(alpha) + w cos(alpha) + t arm,   c = t

(rollers), or by how much the distance of the groove centres grows (balls). The sum of the energies
K delta_+^(n+1) / (n+1) over all laminae is convex in the motion, and its gradient and Hessian are
forces and tangent stiffness.
"""

from typing import NamedTuple

import numpy as np
from numba import njit

from fe_drivetrain.common.arrays import Floats, Ints

#: Kinds of rows, and where in a row of ``data`` its numbers are.
LAMINAE, CLOSED, BALLS = 0, 1, 2
KIND, SIN, COS, ARM, LEAN, STIFF, EXPONENT, LENGTH, GAP, AXIAL, RADIAL, DISTANCE, GROOVE = range(13)
N_DATA = 13

#: Load cases that are taken in turn, each starting from the one before it. A fixed number, so that
#: results do not depend on how many threads share the chunks.
CHUNK = 512


class Packed(NamedTuple):
    """A bearing as these loops take it.

    Attributes
    ----------
    data : Floats
        (rows, N_DATA) numbers of each row.
    first : Ints
        (rows + 1,) where the rolling elements of each row begin.
    sines, cosines : Floats
        (total,) of the places of all rolling elements.
    lam : Ints
        (rows + 1,) where the laminae of each row begin.
    xi, free : Floats
        (laminae,) their places along the roller, and what each has to approach first [m].
    tables : Floats
        (rows, POWERS) of `power_table`.
    """

    data: Floats
    first: Ints
    sines: Floats
    cosines: Floats
    lam: Ints
    xi: Floats
    free: Floats
    tables: Floats


# Gauss points of [-1, 1], for straight rollers that are nearly parallel to the race.
_GAUSS_X, _GAUSS_W = np.polynomial.legendre.leggauss(10)


# Powers of many numbers without a logarithm each: x = 2^e m, m near one of these middles, m^q from
# a table and six terms of the binomial series, whose rest is below round-off. (A library's power
# takes most of the time of an equilibrium otherwise.)
_BITS = 7
_TERMS = 6
POWERS = 2048 + 2 * 2**_BITS + _TERMS
_TO_MIDDLE, _OF_MIDDLE, _SERIES = 2048, 2048 + 2**_BITS, 2048 + 2 * 2**_BITS


def power_table(q: float) -> Floats:
    """What `powers` needs for the exponent q: (POWERS,)."""
    table = np.zeros(POWERS)
    with np.errstate(over="ignore", under="ignore"):
        table[1:_TO_MIDDLE] = 2.0 ** (q * (np.arange(1.0, 2048.0) - 1023.0))
    middles = 1.0 + (np.arange(2**_BITS) + 0.5) / 2**_BITS
    table[_TO_MIDDLE:_OF_MIDDLE] = 1.0 / middles
    table[_OF_MIDDLE:_SERIES] = middles**q
    k = np.arange(_TERMS)
    table[_SERIES:] = np.cumprod((q - k) / (k + 1.0))
    return table


@njit(cache=True, error_model="numpy", fastmath={"reassoc", "contract"})
def powers(x: Floats, bits: Ints, n: int, table: Floats, out: Floats) -> None:
    """out = x^q of the first n, all positive; ``bits`` is the same memory as x, and is spoilt."""
    c1, c2, c3 = table[_SERIES], table[_SERIES + 1], table[_SERIES + 2]
    c4, c5, c6 = table[_SERIES + 3], table[_SERIES + 4], table[_SERIES + 5]
    for k in range(n):
        b = bits[k]
        i = (b >> (52 - _BITS)) & (2**_BITS - 1)
        out[k] = table[b >> 52] * table[_OF_MIDDLE + i]
        bits[k] = (b & (2**52 - 1)) | (1023 << 52)
        r = x[k] * table[_TO_MIDDLE + i] - 1.0
        out[k] *= 1.0 + r * (c1 + r * (c2 + r * (c3 + r * (c4 + r * (c5 + r * c6)))))


@njit(cache=True, error_model="numpy")
def _power(x: float, n: float) -> float:
    """x^n for positive x; the exponents of springs and balls without a logarithm."""
    if n == 0.0:
        return 1.0
    if n == 0.5:
        return float(np.sqrt(x))
    return float(x**n)


@njit(cache=True, error_model="numpy")
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


@njit(cache=True, error_model="numpy", fastmath={"reassoc", "contract"})
def laminae(
    b: float,
    c: float,
    K: float,
    n: float,
    xi: Floats,
    free: Floats,
    table: Floats,
    work: Floats,
    s: Floats,
) -> None:
    """The same sums over laminae, `free` being what each has to approach first.

    ``work`` is (3, 2 or more times the laminae): approaches twice, and powers.
    """
    z, spoilt, e = work[0], work[1], work[2]
    bits = spoilt.view(np.int64)
    count, first = 0, 0
    for k in range(len(xi)):
        here = b + c * xi[k] - free[k]
        if here > 0.0:
            if count == 0:
                first = k
            z[k] = spoilt[k] = here
            count = k + 1
        else:
            z[k], spoilt[k] = 0.0, 1.0
    count -= first
    powers(spoilt[first:], bits[first:], count, table, e)
    s0 = s1 = s2 = s3 = s4 = 0.0
    for k in range(count):
        x, here, power = xi[first + k], z[first + k], e[k]
        if here > 0.0:
            q = power * here
            s0 += q
            s1 += q * x
            s2 += power
            power *= x
            s3 += power
            s4 += power * x
    K /= len(xi)
    s[0], s[1] = K * s0, K * s1
    K *= n
    s[2], s[3], s[4] = K * s2, K * s3, K * s4


@njit(cache=True, error_model="numpy")
def _element(
    d: Floats,
    xi: Floats,
    free: Floats,
    table: Floats,
    a: float,
    w: float,
    t: float,
    work: Floats,
    s: Floats,
    f: Floats,
) -> float:
    """One rolling element: f becomes its forces and tangent over (a, w, t); returns its load.

    f holds three forces, then the tangent's aa, aw, at, ww, wt, tt; untouched where the load is
    zero.
    """
    if d[KIND] == BALLS:
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
    sin, cos, arm, lean = d[SIN], d[COS], d[ARM], d[LEAN]
    b = a * sin + w * cos + t * arm - d[GAP]
    c = t * lean
    if b + 0.5 * abs(c) * d[LENGTH] <= 0.0:
        return 0.0
    if d[KIND] == CLOSED:
        closed(b, c, d[STIFF], d[EXPONENT], d[LENGTH], s)
    else:
        laminae(b, c, d[STIFF], d[EXPONENT], xi, free, table, work, s)
    Q = s[0]
    if Q <= 0.0:
        return 0.0
    k, k1 = s[2], s[2] * arm + s[3] * lean
    f[0], f[1], f[2] = Q * sin, Q * cos, Q * arm + s[1] * lean
    f[3], f[4], f[5] = k * sin * sin, k * sin * cos, k1 * sin
    f[6], f[7] = k * cos * cos, k1 * cos
    f[8] = s[2] * arm * arm + 2.0 * s[3] * arm * lean + s[4] * lean
    return float(Q)


@njit(cache=True, error_model="numpy")
def evaluate(
    u: Floats,
    bearing: Packed,
    F: Floats,
    K: Floats,
    work: Floats,
    s: Floats,
    f: Floats,
) -> float:
    """Forces and tangent stiffness at a motion u, into F and K; the sum of all loads."""
    F[:] = 0.0
    K[:] = 0.0
    total = 0.0
    lam = bearing.lam
    a, uy, uz, ty, tz = u
    for r in range(len(bearing.data)):
        d, table = bearing.data[r], bearing.tables[r]
        x, g = bearing.xi[lam[r] : lam[r + 1]], bearing.free[lam[r] : lam[r + 1]]
        for i in range(bearing.first[r], bearing.first[r + 1]):
            co, si = bearing.cosines[i], bearing.sines[i]
            # e_r = (-cos, sin) of (y, z), and the tangent e_x x e_r = (-sin, -cos)
            w = si * uz - co * uy
            t = -(si * ty + co * tz)
            Q = _element(d, x, g, table, a, w, t, work, s, f)
            if Q <= 0.0:
                continue
            total += Q
            F[0] += f[0]
            F[1] -= co * f[1]
            F[2] += si * f[1]
            F[3] -= si * f[2]
            F[4] -= co * f[2]
            cc, cs, ss = co * co, co * si, si * si
            K[0, 0] += f[3]
            K[0, 1] -= co * f[4]
            K[0, 2] += si * f[4]
            K[0, 3] -= si * f[5]
            K[0, 4] -= co * f[5]
            K[1, 1] += cc * f[6]
            K[1, 2] -= cs * f[6]
            K[2, 2] += ss * f[6]
            K[1, 3] += cs * f[7]
            K[1, 4] += cc * f[7]
            K[2, 3] -= ss * f[7]
            K[2, 4] -= cs * f[7]
            K[3, 3] += ss * f[8]
            K[3, 4] += cs * f[8]
            K[4, 4] += cc * f[8]
    for i in range(5):
        for j in range(i):
            K[i, j] = K[j, i]
    return total


@njit(cache=True, nogil=True, error_model="numpy")
def forces_of(
    displacements: Floats,
    bearing: Packed,
    loads: Floats,
    tangents: Floats,
) -> None:
    """Loads (n, 5) and tangent stiffness (n, 5, 5) at given displacements (n, 5), filled."""
    work, s, f = np.empty((3, len(bearing.xi) + 1)), np.zeros(5), np.zeros(9)
    for i in range(len(displacements)):
        evaluate(
            displacements[i],
            bearing,
            loads[i],
            tangents[i],
            work,
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
    work, s, f = np.empty((3, len(bearing.xi) + 1)), np.zeros(5), np.zeros(9)
    lam = bearing.lam
    for i in range(len(displacements)):
        a, uy, uz, ty, tz = displacements[i]
        for r in range(len(bearing.data)):
            d, table = bearing.data[r], bearing.tables[r]
            x, g = bearing.xi[lam[r] : lam[r + 1]], bearing.free[lam[r] : lam[r + 1]]
            for j in range(bearing.first[r], bearing.first[r + 1]):
                co, si = bearing.cosines[j], bearing.sines[j]
                w = si * uz - co * uy
                t = -(si * ty + co * tz)
                Q = _element(d, x, g, table, a, w, t, work, s, f)
                loads[i, j] = Q
                moments[i, j] = s[1] if Q > 0.0 and d[KIND] != BALLS else 0.0
                angles[i, j] = np.arctan2(d[SIN], d[COS])
                if Q > 0.0 and d[KIND] == BALLS:
                    angles[i, j] = np.arctan2(f[0], f[1])
