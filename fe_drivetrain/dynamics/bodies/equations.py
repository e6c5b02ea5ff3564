"""Equations of motion for time integration: matrices, springs with laws, loads that vary in time.

    M q'' + C q' + K q + sum_i (dV_i/dq + d_i h_i) = f(t),  V_i = k_i kappa_i(psi_i) Phi_i(delta_i)

Each spring has a row h with the elongation delta = h . q - offset - e. Phi is delta^2 / 2 of a
linear spring; with a dead zone it is zero between the flanks, and beyond a flank a power of the
distance from it. The stiffness may vary with a phase psi = phase + frequency t + turns . q, in
periods: by time alone (a gear mesh at constant speed), or by an angle (the row ``turns``). A
stiffness that varies with an angle drives that angle, too, by -dV/dpsi turns: without this force
energy is not conserved (Oh, Grosh and Barber 2005). So does e, which varies with the same phase:
the transmission error of a mesh without load, a displacement along its line of action.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Bools, Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.scaling import min_eigenvalue
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.dynamics.bodies.system import System

CONSTANT = -1
"""Number of the wave of a stiffness that does not vary."""


@dataclass(frozen=True)
class SpringLaws:
    """Springs and dampers along rows, each with a law; see the module, and `spring_laws`.

    Attributes
    ----------
    rows : Floats
        (m, n) elongation by each degree of freedom.
    stiffness, damping : Floats
        (m,) force per elongation (mean over a period, where it varies) and per its rate; a damper
        works where the spring is in contact at the beginning of a step.
    lower, upper : Floats
        (m,) elongations of the flanks: force between them is zero; both 0 of a spring that pulls
        as it pushes, lower of minus infinity where there is but one flank.
    exponent : Floats
        Exponents (m,) of the distance from the flank: 1, 10/9 of rollers, 3/2 of balls.
    offset : Floats
        (m,) elongation of the row at which the spring is free.
    wave : Ints
        (m,) number of the wave by which the stiffness varies, or `CONSTANT`.
    phase, frequency : Floats
        Periods (m,) of the wave at t = 0, and periods a second.
    turns : Floats
        (m, n) periods of the wave for each degree of freedom.
    power, speed : Floats
        Power (m,) of machines that draw it constantly [W] at the speed ``speed + h . q'``; 0 of
        others.
    waves : Floats
        (w, p, 4) stiffness over its mean in a period: polynomials of p even intervals.
    error : Ints
        (m,) number of the error e that moves the free place of the spring, or `CONSTANT`.
    error_phase, error_turns : Floats
        (m,) periods of the error at psi = 0, and for each period of psi: 1 of one that repeats with
        the mesh, 1/z of the run-out of a gear with z teeth.
    errors : Floats
        (e, p, 4) errors in their periods, as waves [m].
    """

    rows: Floats
    stiffness: Floats
    damping: Floats
    lower: Floats
    upper: Floats
    exponent: Floats
    offset: Floats
    wave: Ints
    phase: Floats
    frequency: Floats
    turns: Floats
    power: Floats
    speed: Floats
    waves: Floats
    error: Ints
    error_phase: Floats
    error_turns: Floats
    errors: Floats

    __repr__ = short_repr

    @property
    def special(self) -> Bools:
        """(m,) whether a spring is more than a constant stiffness and damping."""
        return np.asarray(
            (self.lower != self.upper)
            | (self.exponent != 1.0)
            | (self.wave != CONSTANT)
            | (self.error != CONSTANT)
            | (self.power != 0.0)
        )

    def in_phase(
        self, phase: ArrayLike = 0.0, frequency: ArrayLike = 0.0, turns: ArrayLike = 0.0
    ) -> "SpringLaws":
        """Springs whose waves and errors have a phase psi = phase + frequency t + turns . q.

        Parameters
        ----------
        phase, frequency : array_like
            Periods at t = 0, and periods a second, of each spring or one for all.
        turns : array_like
            (m, n) periods for each degree of freedom, or one number for all.
        """
        m, rows = len(self.rows), self.rows.shape
        periods = np.array(np.broadcast_to(np.asarray(turns, dtype=np.float64), rows))
        return replace(self, phase=_each(phase, m), frequency=_each(frequency, m), turns=periods)

    def with_waves(self, waves: ArrayLike, wave: ArrayLike = 0) -> "SpringLaws":
        """Springs whose stiffness varies with their phase.

        Parameters
        ----------
        waves : array_like
            Waves (w, p, 4), by `wave_table` or `fourier_wave`, stacked.
        wave : array_like
            Number of the wave of each spring, or one for all; `CONSTANT` for none.

        Raises
        ------
        InputError
            There is no wave of that number.
        """
        chosen, table = _numbered("wave", wave, waves, len(self.rows))
        return replace(self, wave=chosen, waves=table)

    def with_errors(
        self,
        errors: ArrayLike,
        error: ArrayLike = 0,
        *,
        phase: ArrayLike = 0.0,
        turns: ArrayLike = 1.0,
    ) -> "SpringLaws":
        """Springs whose free place moves with their phase: transmission errors of meshes.

        Parameters
        ----------
        errors : array_like
            Waves (e, p, 4) of errors, by `wave_table` of lengths [m], stacked.
        error : array_like
            Number of the error of each spring, or one for all; `CONSTANT` for none.
        phase, turns : array_like
            Periods of the error at psi = 0 and for each period of psi, see `SpringLaws`.

        Raises
        ------
        InputError
            There is no error of that number.
        """
        m = len(self.rows)
        chosen, table = _numbered("error", error, errors, m)
        return replace(
            self,
            error=chosen,
            errors=table,
            error_phase=_each(phase, m),
            error_turns=_each(turns, m),
        )

    def with_power(self, power: ArrayLike, speed: ArrayLike = 0.0) -> "SpringLaws":
        """Springs that are machines, too: each draws a power [W] at a speed ``speed + h . q'``.

        Parameters
        ----------
        power, speed : array_like
            Values of each spring, or one for all, see `SpringLaws`.
        """
        m = len(self.rows)
        return replace(self, power=_each(power, m), speed=_each(speed, m))


def spring_laws(
    rows: ArrayLike,
    stiffness: ArrayLike,
    damping: ArrayLike = 0.0,
    *,
    lower: ArrayLike = 0.0,
    upper: ArrayLike = 0.0,
    exponent: ArrayLike = 1.0,
    offset: ArrayLike = 0.0,
) -> SpringLaws:
    """Springs of rows, linear ones where nothing else is given.

    What varies is added by `SpringLaws.in_phase`, `SpringLaws.with_waves`,
    `SpringLaws.with_errors` and `SpringLaws.with_power`.

    Parameters
    ----------
    rows : array_like
        (m, n) elongation of each spring by the degrees of freedom.
    stiffness, damping : array_like
        (m,), or one for all.
    lower, upper, exponent, offset : array_like
        Values of each spring, or one for all, see `SpringLaws`.

    Returns
    -------
    springs : SpringLaws

    Raises
    ------
    InputError
        A value is out of its range.
    """
    H = np.ascontiguousarray(np.atleast_2d(np.asarray(rows, dtype=np.float64)))
    m = len(H)
    zero, no_table = np.zeros(m), np.zeros((0, 1, 4))
    springs = SpringLaws(
        H,
        stiffness=_each(stiffness, m),
        damping=_each(damping, m),
        lower=_each(lower, m),
        upper=_each(upper, m),
        exponent=_each(exponent, m),
        offset=_each(offset, m),
        wave=np.full(m, CONSTANT),
        phase=zero,
        frequency=zero,
        turns=np.zeros(H.shape),
        power=zero,
        speed=zero,
        waves=no_table,
        error=np.full(m, CONSTANT),
        error_phase=zero,
        error_turns=np.ones(m),
        errors=no_table,
    )
    for name, good, allowed in (
        ("stiffness", springs.stiffness >= 0.0, "a number of at least 0 N/m"),
        ("damping", springs.damping >= 0.0, "a number of at least 0 N s/m"),
        ("lower", springs.lower <= 0.0, "at most 0 m"),
        ("upper", springs.upper >= 0.0, "at least 0 m"),
        ("exponent", springs.exponent >= 1.0, "at least 1"),
    ):
        _require(name, getattr(springs, name), good, allowed)
    return springs


def _each(values: ArrayLike, count: int) -> Floats:
    """Values of each spring, from as many or from one for all."""
    return np.array(np.broadcast_to(np.asarray(values, dtype=np.float64), count))


def _numbered(name: str, numbers: ArrayLike, table: ArrayLike, count: int) -> tuple[Ints, Floats]:
    """Numbers (m,) of waves in a table (w, p, 4), checked, and the table."""
    waves = np.ascontiguousarray(np.asarray(table, dtype=np.float64))
    chosen = np.array(np.broadcast_to(np.asarray(numbers, dtype=np.int64), count))
    good = (chosen >= CONSTANT) & (chosen < len(waves))
    _require(name, chosen, good, f"-1 to {len(waves) - 1}")
    return chosen, waves


def _require(name: str, values: Floats | Ints, good: Bools, allowed: str) -> None:
    """Refuse a value of a spring that is out of its range."""
    if not good.all():
        at = int(np.flatnonzero(~good)[0])
        raise InputError(
            f"{name} of spring {at + 1} is {values[at]:g} but must be {allowed}: change it"
        )


def joined_laws(*parts: SpringLaws) -> SpringLaws:
    """The springs of several groups on the same degrees of freedom, in their order."""
    tables: dict[str, Any] = {}
    renumbered = list(parts)
    for name, number in (("waves", "wave"), ("errors", "error")):
        found = [getattr(part, name) for part in parts]
        given = [table for table in found if len(table)]
        intervals = {table.shape[1] for table in given}
        if len(intervals) > 1:
            raise InputError(
                f"{name} of {' and '.join(map(str, sorted(intervals)))} intervals cannot be "
                "joined: make them with equal numbers"
            )
        tables[name] = np.concatenate(given or found[:1])
        first = np.cumsum([0, *(len(table) for table in found)])
        of = [getattr(part, number) for part in parts]
        moved = [np.where(n >= 0, n + start, CONSTANT) for n, start in zip(of, first, strict=False)]
        renumbered = [
            replace(part, **{number: n}) for part, n in zip(renumbered, moved, strict=True)
        ]
    fields = [name for name in SpringLaws.__dataclass_fields__ if name not in tables]
    return SpringLaws(
        **{f: np.concatenate([getattr(p, f) for p in renumbered]) for f in fields}, **tables
    )


def wave_table(values: ArrayLike) -> Floats:
    """A wave through values at even phases of a period, smooth: (p, 4) polynomials.

    Parameters
    ----------
    values : array_like
        (p,) stiffness over its mean, from phase 0; the spline through them is periodic, twice
        differentiable.

    Returns
    -------
    wave : Floats
        (p, 4) coefficients of 1, s, s^2, s^3 in each interval, s in periods.
    """
    from scipy.interpolate import CubicSpline

    at = np.asarray(values, dtype=np.float64)
    spline = CubicSpline(np.linspace(0.0, 1.0, len(at) + 1), [*at, at[0]], bc_type="periodic")
    return np.ascontiguousarray(spline.c[::-1].T)


def fourier_wave(cosines: ArrayLike, sines: ArrayLike, intervals: int = 256) -> Floats:
    """A wave of a Fourier series, as `wave_table`.

    Parameters
    ----------
    cosines, sines : array_like
        Coefficients (l,) of cos(2 pi l psi) and sin(2 pi l psi), l from 1, over the mean stiffness.
    intervals : int
        Number of intervals of the spline: its error falls with the fourth power of intervals over
        harmonics.

    Returns
    -------
    wave : Floats
        Wave (p, 4), as `wave_table` makes it.
    """
    a, b = np.asarray(cosines, dtype=np.float64), np.asarray(sines, dtype=np.float64)
    angle = 2.0 * np.pi * np.outer(np.arange(intervals) / intervals, np.arange(1, len(a) + 1))
    return wave_table(1.0 + np.cos(angle) @ a + np.sin(angle) @ b)


@dataclass(frozen=True)
class Loads:
    """Loads that are piecewise linear in time.

    Attributes
    ----------
    patterns : Floats
        (n, r) generalised force of a unit of each history.
    times : Floats
        (s,) ascending [s]; before the first and after the last the load stays.
    histories : Floats
        Histories (s, r) of each pattern.
    """

    patterns: Floats
    times: Floats
    histories: Floats

    __repr__ = short_repr

    def at(self, t: ArrayLike) -> Floats:
        """(..., n) loads at times."""
        when = np.asarray(t, dtype=np.float64)
        parts = [np.interp(when, self.times, history) for history in self.histories.T]
        return np.asarray(np.stack(parts, axis=-1) @ self.patterns.T)


def steady(load: ArrayLike) -> Loads:
    """A load (n,) that does not vary."""
    pattern = np.asarray(load, dtype=np.float64)[:, None]
    return Loads(np.ascontiguousarray(pattern), np.zeros(1), np.ones((1, 1)))


def varying(pattern: ArrayLike, times: ArrayLike, history: ArrayLike) -> Loads:
    """A pattern (n,) times a history over times (s,) [s], or patterns (n, r) times (s, r)."""
    P, T = np.asarray(pattern, dtype=np.float64), np.asarray(times, dtype=np.float64)
    H = np.asarray(history, dtype=np.float64)
    if len(T) != len(H) or np.any(np.diff(T) <= 0.0):
        raise InputError(
            f"a load of {len(H)} values has {len(T)} times, but must have as many, ascending: "
            "correct them"
        )
    if not (np.isfinite(T).all() and np.isfinite(H).all()):
        raise InputError("a load over time has values that are no numbers: correct them")
    return Loads(
        np.ascontiguousarray(P.reshape(len(P), -1)), T, np.ascontiguousarray(H.reshape(len(T), -1))
    )


def summed(*loads: Loads) -> Loads:
    """Loads that act together."""
    times = np.unique(np.concatenate([one.times for one in loads]))
    histories = [
        np.column_stack([np.interp(times, one.times, h) for h in one.histories.T]) for one in loads
    ]
    return Loads(
        np.ascontiguousarray(np.hstack([one.patterns for one in loads])),
        times,
        np.ascontiguousarray(np.hstack(histories)),
    )


@dataclass(frozen=True)
class Equations:
    """Matrices and springs; see the module.

    Attributes
    ----------
    mass : Floats
        Mass matrix (n, n), symmetric, positive.
    springs : SpringLaws
        Springs on the n degrees of freedom.
    damping : Floats
        Damping (n, n) beside the dampers of the springs: gyroscopic, proportional.
    extra : Floats
        (n, n) stiffness beside the springs: superelements.
    """

    mass: Floats
    springs: SpringLaws
    damping: Floats
    extra: Floats

    __repr__ = short_repr

    @property
    def K(self) -> Floats:
        """(n, n) stiffness, waves at their mean and every spring in contact without a gap."""
        H = self.springs.rows
        return np.asarray(H.T @ (self.springs.stiffness[:, None] * H)) + self.extra

    @property
    def C(self) -> Floats:
        """(n, n) damping, every spring in contact."""
        H = self.springs.rows
        return np.asarray(H.T @ (self.springs.damping[:, None] * H)) + self.damping

    def within(self, motions: ArrayLike) -> "Equations":
        """The equations of y in q = Z y, with motions Z of shape (n, k)."""
        Z = np.asarray(motions, dtype=np.float64)
        s = self.springs
        return Equations(
            Z.T @ self.mass @ Z,
            replace(s, rows=np.ascontiguousarray(s.rows @ Z), turns=s.turns @ Z),
            Z.T @ self.damping @ Z,
            Z.T @ self.extra @ Z,
        )


def equations_of_motion(
    mass: ArrayLike,
    springs: SpringLaws,
    damping: ArrayLike | None = None,
    extra: ArrayLike | None = None,
) -> Equations:
    """Equations of motion, what is not given being zero; a mass (n,) is a diagonal.

    Raises
    ------
    InputError
        The mass is not symmetric and positive, or the shapes do not fit each other.
    """
    M = np.asarray(mass, dtype=np.float64)
    M = np.diag(M) if M.ndim == 1 else M
    n = len(M)
    C = np.zeros((n, n)) if damping is None else np.asarray(damping, dtype=np.float64)
    E = np.zeros((n, n)) if extra is None else np.asarray(extra, dtype=np.float64)
    for name, shape in (("damping", C.shape), ("extra", E.shape), ("mass", M.shape)):
        if shape != (n, n):
            raise InputError(f"{name} is of shape {shape} but must be {n} by {n}: correct it")
    if springs.rows.shape[1] != n:
        raise InputError(
            f"rows of springs have {springs.rows.shape[1]} entries but must have {n}, as the mass: "
            "correct them"
        )
    if not np.allclose(M, M.T, rtol=0.0, atol=1e-9 * np.abs(M).max()):
        raise InputError("the mass matrix is not symmetric, but must be: correct it")
    if not ((M.diagonal() > 0.0).all() and min_eigenvalue(M) > 0.0):
        raise InputError(
            "the mass matrix has a motion without inertia, but time integration needs a mass for "
            "each degree of freedom: add one, or condense that degree of freedom"
        )
    return Equations(
        np.ascontiguousarray(M), springs, np.ascontiguousarray(C), np.ascontiguousarray(E)
    )


def equations_of(system: System, speed: float = 0.0) -> Equations:
    """The equations of a system of bodies whose frame turns at a steady speed [rad/s], linear."""
    return equations_of_motion(
        system.mass,
        spring_laws(system.rows, system.stiffness, system.damping),
        speed * system.gyroscopic,
        system.extra - speed**2 * system.centripetal,
    )
