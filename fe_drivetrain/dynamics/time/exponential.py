"""Steps by exponentials: what is linear is exact, and laws of springs follow by collocation.

Matrices, with each spring's mean stiffness, and loads that are linear in a step are integrated
exactly, as by Van Loan 1978. Forces d of laws beyond the matrices act along few rows R; in a step
they are the polynomial through their values at Lobatto's four nodes c_i:

    y(c h) = exp(c h A) y_0 + loads - sum_i w_i(c) R^T d_i,   d_i = d(z_i, z_i', t_i)

(exponential collocation: Hochbruck and Ostermann 2005). The error falls with the sixth power of the
step where laws are smooth, and there is none without laws, whatever the step. Values z_i of the
rows are found by Newton's method, which leaves out how d changes with the rates.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy import linalg

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.compiled import inner_loop, njit
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.common.threads import one_blas_thread
from fe_drivetrain.dynamics.bodies.equations import Equations, Loads
from fe_drivetrain.dynamics.time.law_loops import (
    CHANGE,
    PIVOT,
    ZR,
    D,
    Laws,
    Z,
    law_forces,
    touching,
)
from fe_drivetrain.dynamics.time.mechanism import mechanism_of
from fe_drivetrain.dynamics.time.motion import State, at_rest
from fe_drivetrain.dynamics.time.newton_steps import MAX_STEPS, factorise, solve
from fe_drivetrain.dynamics.time.schemes import AVERAGE
from fe_drivetrain.dynamics.time.step_loop import histories_at
from fe_drivetrain.dynamics.time.stepper import TOLERANCE, prepared

NODES = np.array([0.0, 0.5 - np.sqrt(0.05), 0.5 + np.sqrt(0.05), 1.0])
"""Lobatto's nodes in a step; the first of a step is the last of the one before."""

FREE, FOUND = range(2)
"""Vectors of rows and rates at nodes: what they are without laws, and what laws take from it."""

#: Columns from which a library's product is faster than a loop.
MANY = 12


@dataclass(frozen=True)
class ExponentialMotion:
    """A history of motion by exponentials.

    Attributes
    ----------
    times : Floats
        Times (k,) of the records [s].
    q, velocity : Floats
        Displacements and velocities (k, n).
    iterations : int
        Newton steps, all.
    not_converged : int
        Steps in which Newton's method did not converge.
    """

    times: Floats
    q: Floats
    velocity: Floats
    iterations: int
    not_converged: int

    __repr__ = short_repr


class Weights(NamedTuple):
    """Matrices of a step of r rows at s nodes; x is (q, h q', loads before and after, 1).

    ``end`` (2 n, x) and ``end_laws`` (2 n, s r) give q and h q' after it; ``free`` (2 r (s - 1), x)
    and ``mutual`` (2 r (s - 1), s r) give the rows and h times their rates at each node. ``ahead``
    (s, s) goes on with forces of the step before.
    """

    step: float
    end: Floats
    end_laws: Floats
    free: Floats
    mutual: Floats
    ahead: Floats


class Memory(NamedTuple):
    """Memory of the loop at s nodes of r rows with q laws.

    ``values`` (s, 12, r) and ``laws`` (4, q) as `law_forces` takes them, ``tangents`` (s, r, r);
    ``forces`` (s r), node by node; ``vectors`` (2, 2 r (s - 1)) as `FREE` and `FOUND`; ``scale``
    (r,) maximum of each row so far; ``left`` (13, r (s - 1)) and ``square`` of Newton's method;
    ``last`` (s,); ``nodes`` (s,).
    """

    values: Floats
    laws: Floats
    tangents: Floats
    forces: Floats
    vectors: Floats
    scale: Floats
    left: Floats
    square: Floats
    last: Floats
    nodes: Floats


def exponential_steps(
    equations: Equations,
    loads: Loads,
    duration: float,
    dt: float,
    start: State | None = None,
    *,
    every: int = 1,
    tolerance: float = TOLERANCE,
) -> ExponentialMotion:
    """Integrate in time by exponentials: exact of linear systems, of sixth order with smooth laws.

    Parameters
    ----------
    equations : Equations
        Equations of motion; gyroscopic terms and any damping, too.
    loads : Loads
        Loads on the system, with kinks at steps only.
    duration, dt : float
        Duration of the whole motion, a whole number of steps, and length of a step [s].
    start : State, optional
        State at the beginning, at rest where left out.
    every : int
        Steps from record to record.
    tolerance : float
        Tolerance of Newton's method: what is left of an elongation over its maximum so far.

    Returns
    -------
    motion : ExponentialMotion
        Motion, converged in every step, or it says in how many it did not.

    Raises
    ------
    InputError
        The duration, the step or the number of steps from record to record is not positive.
    """
    if not (np.isfinite(duration) and duration > 0.0):
        raise InputError(f"duration is {duration:g} s but must be above 0 s: change it")
    if every < 1:
        raise InputError(f"every is {every} steps but must be at least 1: change it")
    model = prepared(mechanism_of(equations, loads), dt, AVERAGE).model
    rows = np.ascontiguousarray(model.matrices.rows[0])
    begin = start or at_rest(equations)
    steps, n, p = round(duration / dt), len(equations.mass), loads.histories.shape[1]
    x = np.concatenate([begin.q, dt * begin.velocity, np.zeros(2 * p), np.ones(1)])
    records = np.empty((steps // every + 1, 2 * n))
    counts: Ints = np.zeros(2, dtype=np.int64)
    span = float(begin.time), steps, int(every), float(tolerance)
    tables = np.ascontiguousarray(loads.times), np.ascontiguousarray(loads.histories)
    memory = _memory(rows, model.laws, begin)
    with one_blas_thread():
        weights = _weights(equations, loads, rows, model.matrices.constant, float(dt))
        _march(span, weights, model.laws, tables, x, memory, records, counts)
    times = begin.time + dt * every * np.arange(len(records), dtype=np.float64)
    return ExponentialMotion(
        times, records[:, :n], records[:, n:] / dt, int(counts[0]), int(counts[1])
    )


def _memory(rows: Floats, laws: Laws, begin: State) -> Memory:
    """Memory, with the values of the rows at the beginning."""
    s, r = len(NODES), len(rows)
    many = r * (s - 1)
    values = np.zeros((s, 12, r))
    values[0, Z], values[0, ZR] = rows @ begin.q, rows @ begin.velocity
    return Memory(
        values,
        np.zeros((4, laws.values.shape[1])),
        np.zeros((s, r, r)),
        np.zeros(s * r),
        np.zeros((2, 2 * many)),
        np.abs(values[0, Z]),
        np.zeros((PIVOT + 1, many)),
        np.zeros((many, many)),
        np.zeros(s),
        NODES,
    )


def _weights(
    equations: Equations, loads: Loads, rows: Floats, constant: Floats, h: float
) -> Weights:
    """Exponentials to each node, and integrals of them with powers of time (Van Loan 1978)."""
    n, r, s = len(equations.mass), len(rows), len(NODES)
    inputs = np.hstack([rows.T, loads.patterns, constant[:, None]])
    m, powers = inputs.shape[1], s if r else 2
    size = 2 * n + powers * m
    rate = np.zeros((size, size))
    rate[:n, n : 2 * n] = np.eye(n)
    by_mass = np.linalg.solve(equations.mass, np.hstack([-equations.K, -equations.C, inputs]))
    rate[n : 2 * n, : 2 * n + m] = by_mass
    rate[n : 2 * n, :n] *= h**2
    rate[n : 2 * n, n : 2 * n] *= h
    rate[n : 2 * n, 2 * n : 2 * n + m] *= h**2
    rate[2 * n : size - m, 2 * n + m :] = np.eye(size - m - 2 * n)
    at = NODES[1:] if r else NODES[-1:]
    found = linalg.expm(at[:, None, None] * rate)[:, : 2 * n]
    power = found[:, :, 2 * n :].reshape(len(at), 2 * n, powers, m)
    of_loads = power[..., r : m - 1]
    free = np.concatenate(
        [
            found[:, :, : 2 * n],
            of_loads[:, :, 0] - of_loads[:, :, 1],
            of_loads[:, :, 1],
            power[:, :, 0, m - 1 :],
        ],
        axis=2,
    )
    both = linalg.block_diag(rows, rows)
    # polynomials that are 1 at one node, by powers
    of_nodes = np.linalg.inv(np.vander(NODES, increasing=True))
    ahead = np.vander(1.0 + NODES, increasing=True) @ of_nodes
    if not r:
        none = np.zeros((2 * n, 0))
        return Weights(h, np.ascontiguousarray(free[-1]), none, both @ free[-1], both @ none, ahead)
    of_nodes *= np.cumprod([1.0, *range(1, s)])[:, None]
    laws = np.einsum("jakr,ki->jair", power[..., :r], of_nodes).reshape(len(at), 2 * n, s * r)
    return Weights(
        h,
        np.ascontiguousarray(free[-1]),
        np.ascontiguousarray(laws[-1]),
        np.concatenate([both @ one for one in free]),
        np.concatenate([both @ one for one in laws]),
        ahead,
    )


@inner_loop
def _times(W: Floats, x: Floats, y: Floats) -> None:  # pragma: no cover - compiled
    """``W x`` into y."""
    if W.shape[1] > MANY:
        np.dot(W, x, y)
        return
    for i in range(W.shape[0]):
        total = 0.0
        for j in range(W.shape[1]):
            total += W[i, j] * x[j]
        y[i] = total


@inner_loop
def _forces(laws: Laws, t: float, i: int, m: Memory) -> None:  # pragma: no cover - compiled
    """Forces of laws at node i, and their tangents."""
    r, y = m.values.shape[2], m.values[i]
    law_forces(laws, t, 0.0, int(np.int64(0)), y, m.laws, m.tangents[i])
    for k in range(r):
        m.forces[i * r + k] = y[D, k]


@inner_loop
def _predict(w: Weights, m: Memory) -> None:  # pragma: no cover - compiled
    """Forces at the nodes as those of the step before go on."""
    s, r = m.values.shape[0], m.values.shape[2]
    for k in range(r):
        for i in range(s):
            m.last[i] = m.forces[i * r + k]
        for i in range(1, s):
            m.forces[i * r + k] = 0.0
            for j in range(s):
                m.forces[i * r + k] += w.ahead[i, j] * m.last[j]


@inner_loop
def _rows(w: Weights, values: Floats, d: Floats, v: Floats) -> None:  # pragma: no cover - compiled
    """Values of the rows and their rates at all nodes but the first, from forces d."""
    r = values.shape[2]
    _times(w.mutual, d, v[FOUND])
    for i in range(1, values.shape[0]):
        first = 2 * r * (i - 1)
        for k in range(r):
            values[i, Z, k] = v[FREE, first + k] - v[FOUND, first + k]
            values[i, ZR, k] = (v[FREE, first + r + k] - v[FOUND, first + r + k]) / w.step


@inner_loop
def _unbalance(
    w: Weights, values: Floats, d: Floats, v: Floats, scale: Floats, left: Floats
) -> float:  # pragma: no cover - compiled
    """What is left of each value of the rows into ``left[CHANGE]``; the most over its size."""
    r, most = values.shape[2], 0.0
    _times(w.mutual, d, v[FOUND])
    for i in range(1, values.shape[0]):
        first = 2 * r * (i - 1)
        for k in range(r):
            z = values[i, Z, k]
            rest = v[FREE, first + k] - v[FOUND, first + k] - z
            if not np.isfinite(rest):  # the larger of a number and none is the number
                return np.inf
            left[CHANGE, r * (i - 1) + k] = rest
            scale[k] = max(scale[k], abs(z))
            if rest != 0.0:
                most = max(most, abs(rest) / (scale[k] if scale[k] > 0.0 else abs(rest)))
    return most


@inner_loop
def _jacobian(w: Weights, tangents: Floats, A: Floats) -> None:  # pragma: no cover - compiled
    """I + weights times tangents, into A."""
    r, nodes = tangents.shape[1], tangents.shape[0] - 1
    for row in range(A.shape[0]):
        for column in range(A.shape[0]):
            A[row, column] = 1.0 if row == column else 0.0
    for i in range(1, nodes + 1):
        for k in range(r):
            for m in range(r):
                by = tangents[i, k, m]
                if by != 0.0:
                    for j in range(nodes):
                        for row in range(r):
                            A[r * j + row, r * (i - 1) + m] += (
                                w.mutual[2 * r * j + row, r * i + k] * by
                            )


@inner_loop
def _newton(
    laws: Laws,
    t: float,
    tolerance: float,
    w: Weights,
    m: Memory,
    counts: Ints,
) -> None:  # pragma: no cover - compiled
    """Forces of laws at the nodes of a step, by Newton's method on the values of the rows there."""
    s, r = m.values.shape[0], m.values.shape[2]
    _rows(w, m.values, m.forces, m.vectors)
    for _ in range(MAX_STEPS):
        for i in range(1, s):
            _forces(laws, t + m.nodes[i] * w.step, i, m)
        counts[0] += 1
        if _unbalance(w, m.values, m.forces, m.vectors, m.scale, m.left) <= tolerance:
            return
        _jacobian(w, m.tangents, m.square)
        factorise(m.square, m.left)
        solve(m.square, m.left)
        for i in range(1, s):
            for k in range(r):
                for column in range(r):
                    m.forces[r * i + k] += (
                        m.tangents[i, k, column] * m.left[CHANGE, r * (i - 1) + column]
                    )
        _rows(w, m.values, m.forces, m.vectors)
    counts[1] += 1


@njit(cache=True, error_model="numpy")
def _march(
    span: tuple[float, int, int, float],
    w: Weights,
    laws: Laws,
    tables: tuple[Floats, Floats],
    x: Floats,
    m: Memory,
    records: Floats,
    counts: Ints,
) -> None:  # pragma: no cover - compiled
    """All steps; records of q and h q' in turn."""
    begin, steps, every, tolerance = span
    s, r, states, p = m.values.shape[0], m.values.shape[2], w.end.shape[0], tables[1].shape[1]
    end, by_laws = np.zeros(states), np.zeros(states)
    times, histories, after = tables[0], tables[1], x[states + p : states + 2 * p]
    place = histories_at(times, histories, begin, int(np.int64(0)), after)
    if r > 0:
        touching(laws, begin, m.values[0], m.laws)
        _forces(laws, begin, int(np.int64(0)), m)
        for i in range(r, s * r):
            m.forces[i] = m.forces[i % r]
    for j in range(states):  # slices would have their faults compiled, too
        records[0, j] = x[j]
    for step in range(1, steps + 1):
        t = begin + (step - 1) * w.step
        for j in range(p):
            x[states + j] = x[states + p + j]
        place = histories_at(times, histories, begin + step * w.step, place, after)
        _times(w.end, x, end)
        if r > 0:
            touching(laws, t, m.values[0], m.laws)
            _predict(w, m)
            _forces(laws, t, int(np.int64(0)), m)
            _times(w.free, x, m.vectors[FREE])
            _newton(laws, t, tolerance, w, m, counts)
            _times(w.end_laws, m.forces, by_laws)
            for j in range(states):
                end[j] -= by_laws[j]
            for k in range(r):
                m.values[0, Z, k] = m.values[s - 1, Z, k]
                m.values[0, ZR, k] = m.values[s - 1, ZR, k]
        for j in range(states):
            x[j] = end[j]
        if step % every == 0:
            for j in range(states):
                records[step // every, j] = end[j]
