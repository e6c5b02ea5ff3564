"""Elimination by fronts: a mesh of few, rich elements condensed to what is kept, or factored.

Elements are joined two by two along a nested dissection of the mesh; what then belongs to no other
element is eliminated at once, in a dense front (Duff and Reid 1983, ACM Trans. Math. Softw. 9,
302-325). For elements of high order the fronts are large and few, which a general sparse factor
cannot know: a harmonic of a shaft takes 44 ms where SuperLU takes 117 ms
(``cases/performance/level_two.py``), and that is why there is a factorisation of our own here.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.compiled import inner_loop, njit
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.threads import one_blas_thread

_PANEL, _STRIP = 32, 96


def condensed(
    grams: Floats, law: Floats, ids: Ints, shares: Floats, kept: int, order: Ints
) -> Floats:
    """Stiffness of the kept degrees of freedom of a mesh.

    Parameters
    ----------
    grams : Floats
        Integrals (ne, s m, s m) of products of s derivatives of m shape functions over each
        element.
    law : Floats
        Law (k, k, s, s): element matrices are ``K[p m + i, q m + j] = sum of law[p, q, a, b]
        grams[a m + i, b m + j]`` for components p and q; symmetric.
    ids : Ints
        Degree of freedom (ne, k m) that each of an element's follows; the kept are the first
        `kept`; negative where it is held at zero.
    shares : Floats
        Share (ne, k m) of that degree of freedom.
    kept : int
        Number of degrees of freedom that are kept.
    order : Ints
        Order of elimination, from `element_order.dissection`.

    Returns
    -------
    (kept, kept)

    Raises
    ------
    InputError
        The eliminated part can move without strain.
    """
    return np.asarray(_sweep(grams, law, ids, shares, kept, order, False)[0])


@dataclass(frozen=True)
class Factor:
    """Cholesky factor of a mesh's stiffness, front by front.

    Attributes
    ----------
    dofs : Ints
        Numbers of each front's degrees of freedom, front by front; the eliminated ones first.
    sizes, gone : Ints
        Numbers (fronts,) of degrees of freedom of each front, and of those that are eliminated.
    values : Floats
        Rows of the factor, in panels whose diagonal blocks are inverted.
    """

    dofs: Ints
    sizes: Ints
    gone: Ints
    values: Floats

    def solve(self, loads: Floats) -> Floats:
        """Displacements (n, m) under loads (n, m); 0 of degrees of freedom that no element has."""
        x = np.zeros(loads.shape)
        used = np.unique(self.dofs)
        x[used] = loads[used]
        with one_blas_thread():  # fronts are small: threads would only wait for each other
            _solve(self.dofs, self.sizes, self.gone, self.values, x)
        return x


def factored(grams: Floats, law: Floats, ids: Ints, shares: Floats, order: Ints) -> Factor:
    """Stiffness of a mesh, factored; arguments and error of `condensed`, none kept."""
    return Factor(*_sweep(grams, law, ids, shares, 0, order, True)[1:])


def _sweep(
    grams: Floats, law: Floats, ids: Ints, shares: Floats, kept: int, order: Ints, store: bool
) -> tuple[Floats, Ints, Ints, Ints, Floats]:
    # one layout, so that it is compiled once
    grams, law, shares = (np.ascontiguousarray(a) for a in (grams, law, shares))
    ids = np.ascontiguousarray(ids)
    with one_blas_thread():  # as in `Factor.solve`
        found, K, dofs, sizes, gone, values = _swept(
            grams, law, ids, shares, kept, _users(ids, kept), order, store
        )
    if not found:
        raise InputError(
            "a part of the mesh can move without strain: hold it, or make its wall thicker"
        )
    return K, dofs, sizes, gone, values


@inner_loop(error_model="python", fastmath=True)
def _element(gram: Floats, law: Floats, K: Floats) -> None:
    """K of `condensed` of one element, what is right of the diagonal; overwrites K."""
    k, s = law.shape[0], law.shape[2]
    m = gram.shape[0] // s
    down, right, share = np.empty(s * s, np.int64), np.empty(s * s, np.int64), np.empty(s * s)
    for p in range(k):
        for q in range(p, k):
            terms = 0
            for a in range(s):
                for b in range(s):
                    if law[p, q, a, b] != 0.0:
                        down[terms], right[terms], share[terms] = a * m, b * m, law[p, q, a, b]
                        terms += 1
            for i in range(m):
                low = i if p == q else 0
                row = K[p * m + i, q * m + low : (q + 1) * m]
                row[:] = 0.0
                for t in range(terms):
                    of = gram[down[t] + i, right[t] + low : right[t] + m]
                    for j in range(len(row)):
                        row[j] += share[t] * of[j]


def element_matrices(grams: Floats, law: Floats) -> Floats:
    """All K (ne, k m, k m) of `condensed`."""
    return np.asarray(_element_matrices(np.ascontiguousarray(grams), np.ascontiguousarray(law)))


@njit(cache=True)
def _element_matrices(grams: Floats, law: Floats) -> Floats:
    size = law.shape[0] * grams.shape[1] // law.shape[2]
    K = np.empty((len(grams), size, size))
    for e in range(len(grams)):
        _element(grams[e], law, K[e])
        for i in range(size):
            for j in range(i):
                K[e, i, j] = K[e, j, i]
    return K


@njit(cache=True)
def _swept(
    grams: Floats,
    law: Floats,
    ids: Ints,
    shares: Floats,
    kept: int,
    users: Ints,
    order: Ints,
    store: bool,
) -> tuple[bool, Floats, Ints, Ints, Ints, Floats]:
    """Whether all could be eliminated, the stiffness of what is kept, and the `Factor` to store.

    Only the upper triangles of matrices are kept.
    """
    size = ids.shape[1]
    place = np.full(len(users), -1)
    K = np.empty((size, size))
    matrices = [np.empty((0, 0))]
    dofs = [np.empty(0, dtype=np.int64)]
    counts = [np.empty(0, dtype=np.int64)]
    seen = np.zeros(len(users), dtype=np.int64)
    fronts = len(order) if store else 0
    sizes = np.zeros(fronts, dtype=np.int64)
    eliminated = np.zeros(fronts, dtype=np.int64)
    numbers = [np.empty(0, dtype=np.int64)]
    rows = [np.empty(0)]
    nothing = np.empty(0, dtype=np.int64), np.empty(0)
    for step in range(len(order)):
        what = order[step]
        if what >= 0:
            brought = _of_element(ids[what], seen)
            _element(grams[what], law, K)
        else:
            A, B = matrices.pop(), matrices.pop()
            of_a, of_b = dofs.pop(), dofs.pop()
            brought = _of_both(of_a, counts.pop(), of_b, counts.pop(), seen)
        n = len(brought)
        gone, left, by = _placed(brought, users, seen, place)
        front = np.zeros((n, n))
        if what >= 0:
            _add_element(front, K, ids[what], shares[what], place)
        else:
            _add(front, A, of_a, place)
            _add(front, B, of_b, place)
        if not _eliminate(front, gone):
            return False, front, nothing[0], sizes, eliminated, nothing[1]
        if store:
            all_of = np.empty(n, dtype=np.int64)
            for i in range(n):
                all_of[place[brought[i]]] = brought[i]
            sizes[step], eliminated[step] = n, gone
            numbers.append(all_of)
            rows.append(front[:gone].copy().ravel())
        matrices.append(front[gone:, gone:].copy())
        dofs.append(left)
        counts.append(by)
    result = _of_kept(matrices.pop(), dofs.pop(), kept)
    if not store:
        return True, result, nothing[0], sizes, eliminated, nothing[1]
    return True, result, _joined(numbers), sizes, eliminated, _joined(rows)


def _users(ids: Ints, kept: int) -> Ints:
    """How many elements each degree of freedom belongs to; more than there are, of the kept."""
    own = np.sort(ids, axis=1)
    is_first = np.diff(own, axis=1, prepend=-1) != 0  # of each element; none is held
    users = np.bincount(own[is_first & (own >= 0)], minlength=int(ids.max()) + 1)
    users[:kept] = len(ids) + 1
    return users


@inner_loop(error_model="python")
def _of_element(ids: Ints, seen: Ints) -> Ints:
    """Degrees of freedom that an element brings to its front; each is seen once."""
    brought = np.empty(len(ids), dtype=np.int64)
    n = 0
    for f in ids:
        if f >= 0 and seen[f] == 0:
            seen[f] = 1
            brought[n] = f
            n += 1
    return brought[:n]


@inner_loop(error_model="python")
def _of_both(of_a: Ints, by_a: Ints, of_b: Ints, by_b: Ints, seen: Ints) -> Ints:
    """Degrees of freedom of two fronts, and in ``seen`` how many elements have brought each."""
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
    return brought[:n]


@inner_loop(error_model="python")
def _placed(brought: Ints, users: Ints, seen: Ints, place: Ints) -> tuple[int, Ints, Ints]:
    """Place in the front of each degree of freedom, those that are complete first.

    Returns the number of these, the others, and how many elements have brought each of the others.
    """
    n = len(brought)
    gone = int(np.int64(0))  # a literal would be a type of its own, compiled by itself
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
    return gone, left, by


@inner_loop(error_model="python")
def _of_kept(found: Floats, dofs: Ints, kept: int) -> Floats:
    """Stiffness of what is kept, whole, from the upper triangle of the last front."""
    result = np.zeros((kept, kept))
    for i in range(len(dofs)):
        for j in range(i, len(dofs)):
            result[dofs[i], dofs[j]] = result[dofs[j], dofs[i]] = found[i, j]
    return result


@inner_loop(error_model="python")
def _joined(parts: Sequence[Any]) -> Any:
    length = 0
    for part in parts:
        length += len(part)
    whole = np.empty(length, dtype=parts[0].dtype)
    at = 0
    for part in parts:
        for value in part:
            whole[at] = value
            at += 1
    return whole


@inner_loop(error_model="python")
def _add_element(front: Floats, K: Floats, dofs: Ints, shares: Floats, place: Ints) -> None:
    for i in range(len(K)):
        if dofs[i] < 0:
            continue
        a, share = place[dofs[i]], shares[i]
        for j in range(i, len(K)):
            if dofs[j] < 0:
                continue
            b = place[dofs[j]]
            value = share * shares[j] * K[i, j]
            if a < b:
                front[a, b] += value
            elif a > b:
                front[b, a] += value
            else:
                # two that follow one: both halves fall onto the diagonal
                front[a, a] += value if i == j else 2.0 * value


@inner_loop(error_model="python")
def _add(front: Floats, matrix: Floats, dofs: Ints, place: Ints) -> None:
    for i in range(len(dofs)):
        a = place[dofs[i]]
        for j in range(i, len(dofs)):
            b = place[dofs[j]]
            if a <= b:
                front[a, b] += matrix[i, j]
            else:
                front[b, a] += matrix[i, j]


@inner_loop(error_model="python", fastmath=True)
def _eliminate(A: Floats, count: int) -> bool:
    """Cholesky of the first `count` rows, in panels; the rest becomes its Schur complement.

    Only what is right of the diagonal is read and right. Diagonal blocks are left inverted, so that
    all else is products of matrices.
    """
    n = len(A)
    for first in range(0, count, _PANEL):
        end = min(first + _PANEL, count)
        inverse = A[first:end, first:end].copy()
        if not _inverse_of_root(inverse):
            return False
        panel = np.dot(np.ascontiguousarray(inverse.T), np.ascontiguousarray(A[first:end, end:]))
        for i in range(end - first):
            for j in range(end - first):
                A[first + i, first + j] = inverse[i, j]
            for j in range(n - end):
                A[first + i, end + j] = panel[i, j]
        for top in range(0, n - end, _STRIP):
            bottom = min(top + _STRIP, n - end)
            product = np.dot(
                np.ascontiguousarray(panel[:, top:bottom].T), np.ascontiguousarray(panel[:, top:])
            )
            for i in range(bottom - top):
                for j in range(n - end - top):
                    A[end + top + i, end + top + j] -= product[i, j]
    return True


@inner_loop(error_model="python", fastmath=True)
def _inverse_of_root(A: Floats) -> bool:
    """Overwrite a symmetric block, given right of its diagonal, by U^-1 where A = U^T U."""
    n = len(A)
    for j in range(n):
        pivot = A[j, j]
        if not pivot > 0.0:
            return False
        row = A[j]
        scale = 1.0 / np.sqrt(pivot)
        for c in range(j, n):
            row[c] *= scale
        for i in range(j + 1, n):
            share = row[i]
            other = A[i]
            for c in range(i, n):
                other[c] -= share * row[c]
    # U X = 1 by rows, from the last
    for i in range(n - 1, -1, -1):
        row = A[i]
        scale = 1.0 / row[i]
        shares = row[i + 1 :].copy()
        row[:] = 0.0
        row[i] = scale
        for k in range(len(shares)):
            share = shares[k] * scale
            other = A[i + 1 + k]
            for c in range(i + 1 + k, n):
                row[c] -= share * other[c]
    return True


@njit(cache=True)
def _solve(dofs: Ints, sizes: Ints, gone: Ints, values: Floats, x: Floats) -> None:
    """Forward and backward, in place."""
    m = x.shape[1]
    first, at = 0, 0
    for front in range(len(sizes)):
        n, count = sizes[front], gone[front]
        here = dofs[first : first + n]
        b = np.empty((n, m))
        for i in range(n):
            for k in range(m):
                b[i, k] = x[here[i], k]
        U = values[at : at + count * n].reshape(count, n)
        for low in range(0, count, _PANEL):
            high = min(low + _PANEL, count)
            turned = np.ascontiguousarray(U[low:high, low:].T)
            known = np.dot(turned[: high - low], np.ascontiguousarray(b[low:high]))
            below = np.dot(turned[high - low :], known)
            for i in range(n - low):
                for k in range(m):
                    if i < high - low:
                        b[low + i, k] = known[i, k]
                    else:
                        b[low + i, k] -= below[i - high + low, k]
        for i in range(n):
            for k in range(m):
                x[here[i], k] = b[i, k]
        first += n
        at += count * n
    for front in range(len(sizes) - 1, -1, -1):
        n, count = sizes[front], gone[front]
        first -= n
        at -= count * n
        here = dofs[first : first + n]
        b = np.empty((n, m))
        for i in range(n):
            for k in range(m):
                b[i, k] = x[here[i], k]
        U = values[at : at + count * n].reshape(count, n)
        start = _PANEL * ((count - 1) // _PANEL) if count > 0 else -1
        for low in range(start, -1, -_PANEL):
            high = min(low + _PANEL, count)
            known = b[low:high] - np.dot(np.ascontiguousarray(U[low:high, high:]), b[high:])
            found = np.dot(np.ascontiguousarray(U[low:high, low:high]), known)
            for i in range(high - low):
                for k in range(m):
                    b[low + i, k] = found[i, k]
        for i in range(count):
            for k in range(m):
                x[here[i], k] = b[i, k]
