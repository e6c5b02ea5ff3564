"""Elimination by fronts: a mesh of few, rich elements condensed to the freedoms that are kept.

Elements are joined two by two along a nested dissection of the mesh; what then belongs to no other
element is eliminated at once, in a dense front (Duff and Reid 1983, ACM Trans. Math. Softw. 9,
302-325). For elements of high order the fronts are large and few, which a general sparse factor
can't know.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from fe_drivetrain.elasticity import Floats, Ints
from fe_drivetrain.errors import InputError

JOIN = -1
"""In a dissection: join the last two."""

_PANEL, _STRIP = 24, 96


def condensed(
    grams: Floats, law: Floats, ids: Ints, shares: Floats, kept: int, order: Ints
) -> Floats:
    """Stiffness of the kept freedoms of a mesh.

    Parameters
    ----------
    grams
        (ne, s m, s m) of each element, integrals of products of s derivatives of m shape functions.
    law
        (k, k, s, s): element matrices are ``K[p m + i, q m + j] = sum of law[p, q, a, b]
        grams[a m + i, b m + j]`` for components p and q; symmetric.
    ids
        (ne, k m) freedom that each of an element's follows; the kept are the first `kept`; negative
        where it is held at zero.
    shares
        (ne, k m) of that freedom.
    kept
        Number of freedoms that are kept.
    order
        From `dissection`.

    Returns
    -------
    (kept, kept)

    Raises
    ------
    InputError
        What is eliminated can move without strain.
    """
    # one layout, so that it is compiled once
    grams, law, shares = (np.ascontiguousarray(a) for a in (grams, law, shares))
    found, K = _condensed(grams, law, np.ascontiguousarray(ids), shares, kept, order)
    if not found:
        raise InputError(
            "a part of the mesh can move without strain: hold it, or make its wall thicker"
        )
    return np.asarray(K)


@njit(cache=True, fastmath=True)  # type: ignore[untyped-decorator]
def _element(gram: Floats, law: Floats, K: Floats) -> None:
    """K of `condensed` of one element; overwrites K."""
    k, s = law.shape[0], law.shape[2]
    m = gram.shape[0] // s
    for p in range(k):
        for q in range(p, k):
            for i in range(m):
                row = K[p * m + i, q * m : (q + 1) * m]
                row[:] = 0.0
                for a in range(s):
                    for b in range(s):
                        share = law[p, q, a, b]
                        if share != 0.0:
                            of = gram[a * m + i, b * m : (b + 1) * m]
                            for j in range(m):
                                row[j] += share * of[j]
    for i in range(k * m):
        for j in range(m * (i // m)):
            K[i, j] = K[j, i]


def element_matrices(grams: Floats, law: Floats) -> Floats:
    """All K (ne, k m, k m) of `condensed`."""
    return np.asarray(_element_matrices(np.ascontiguousarray(grams), np.ascontiguousarray(law)))


@njit(cache=True)  # type: ignore[untyped-decorator]
def _element_matrices(grams: Floats, law: Floats) -> Floats:
    size = law.shape[0] * grams.shape[1] // law.shape[2]
    K = np.empty((len(grams), size, size))
    for e in range(len(grams)):
        _element(grams[e], law, K[e])
    return K


@njit(cache=True)  # type: ignore[untyped-decorator]
def dissection(centres: Floats) -> Ints:
    """Order in which to take and to join elements, from their centres (ne, 2).

    Halves across the longer side, halved again. Returns (2 ne - 1,): an element's number where it
    is taken, `JOIN` where the last two are joined.
    """
    program = np.empty(2 * len(centres) - 1, dtype=np.int64)
    length = 0
    waiting = [np.arange(len(centres))]
    while len(waiting) > 0:
        some = waiting.pop()
        if len(some) == 0:
            program[length] = -1
            length += 1
        elif len(some) == 1:
            program[length] = some[0]
            length += 1
        else:
            x, r = centres[some, 0], centres[some, 1]
            wide, high = x.max() - x.min(), r.max() - r.min()
            # what is level is told apart by the other coordinate, so that cuts are straight
            key = x + 1e-6 * r if wide >= high else r + 1e-6 * x
            some = some[np.argsort(key)]
            half = len(some) // 2
            waiting.append(some[:0])
            waiting.append(some[:half])
            waiting.append(some[half:])
    return program


@njit(cache=True)  # type: ignore[untyped-decorator]
def _condensed(
    grams: Floats, law: Floats, ids: Ints, shares: Floats, kept: int, order: Ints
) -> tuple[bool, Floats]:
    ne, size = ids.shape
    users = np.zeros(ids.max() + 1, dtype=np.int64)
    last = np.full(len(users), -1)
    for e in range(ne):
        for f in ids[e]:
            if f >= 0 and last[f] != e:
                last[f] = e
                users[f] += 1
    users[:kept] = ne + 1
    place = np.full(len(users), -1)
    K = np.empty((size, size))
    matrices = [np.empty((0, 0))]
    freedoms = [np.empty(0, dtype=np.int64)]
    counts = [np.empty(0, dtype=np.int64)]
    seen = np.zeros(len(users), dtype=np.int64)
    for what in order:
        # the freedoms of the front, and how many elements have brought each
        if what >= 0:
            brought = np.empty(size, dtype=np.int64)
            n = 0
            for f in ids[what]:
                if f >= 0 and seen[f] == 0:
                    seen[f] = 1
                    brought[n] = f
                    n += 1
            _element(grams[what], law, K)
        else:
            A, B = matrices.pop(), matrices.pop()
            of_a, of_b = freedoms.pop(), freedoms.pop()
            by_a, by_b = counts.pop(), counts.pop()
            brought = np.empty(len(of_a) + len(of_b), dtype=np.int64)
            n = 0
            for i in range(len(of_a)):
                brought[n] = of_a[i]
                seen[of_a[i]] = by_a[i]
                n += 1
            for i in range(len(of_b)):
                if seen[of_b[i]] == 0:
                    brought[n] = of_b[i]
                    n += 1
                seen[of_b[i]] += by_b[i]
        # those that are complete come first
        gone = 0
        for i in range(n):
            if seen[brought[i]] == users[brought[i]]:
                place[brought[i]] = gone
                gone += 1
        left = np.empty(n - gone, dtype=np.int64)
        by = np.empty(n - gone, dtype=np.int64)
        at = 0
        for i in range(n):
            f = brought[i]
            if seen[f] != users[f]:
                place[f] = gone + at
                left[at] = f
                by[at] = seen[f]
                at += 1
            seen[f] = 0
        front = np.zeros((n, n))
        if what >= 0:
            for i in range(size):
                if ids[what, i] >= 0:
                    to = front[place[ids[what, i]]]
                    share = shares[what, i]
                    for j in range(size):
                        if ids[what, j] >= 0:
                            to[place[ids[what, j]]] += share * shares[what, j] * K[i, j]
        else:
            _add(front, A, of_a, place)
            _add(front, B, of_b, place)
        if not _eliminate(front, gone):
            return False, front
        matrices.append(front[gone:, gone:].copy())
        freedoms.append(left)
        counts.append(by)
    found, last = matrices.pop(), freedoms.pop()
    result = np.zeros((kept, kept))
    for i in range(len(last)):
        for j in range(len(last)):
            result[last[i], last[j]] = 0.5 * (found[i, j] + found[j, i])
    return True, result


@njit(cache=True)  # type: ignore[untyped-decorator]
def _add(front: Floats, matrix: Floats, freedoms: Ints, place: Ints) -> None:
    for i in range(len(freedoms)):
        to = front[place[freedoms[i]]]
        for j in range(len(freedoms)):
            to[place[freedoms[j]]] += matrix[i, j]


@njit(cache=True, fastmath=True)  # type: ignore[untyped-decorator]
def _eliminate(A: Floats, count: int) -> bool:
    """Cholesky of the first `count` rows, in panels; the rest becomes its Schur complement."""
    n = len(A)
    for first in range(0, count, _PANEL):
        end = min(first + _PANEL, count)
        for j in range(first, end):
            pivot = A[j, j]
            if not pivot > 0.0:
                return False
            row = A[j]
            scale = 1.0 / np.sqrt(pivot)
            for c in range(j, n):
                row[c] *= scale
            for i in range(j + 1, end):
                share = row[i]
                other = A[i]
                for c in range(i, n):
                    other[c] -= share * row[c]
        panel = np.ascontiguousarray(A[first:end, end:])
        # only what is right of the diagonal
        for top in range(0, n - end, _STRIP):
            bottom = min(top + _STRIP, n - end)
            A[end + top : end + bottom, end + top :] -= np.dot(
                np.ascontiguousarray(panel[:, top:bottom].T), np.ascontiguousarray(panel[:, top:])
            )
    for i in range(count, n):
        for j in range(count, i):
            A[i, j] = A[j, i]
    return True
