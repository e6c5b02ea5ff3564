"""Motion of the base on which a drivetrain stands, from samples in an array or a file.

Displacements are then those against the base, so that springs, bearings and brakes to it act as on
a base that stands. What moves feels the base by its inertia, -M S g'', and a frame or shaft that
spins by its gyroscopic terms, -C S g', with the rigid motions S by those of the base. Its
acceleration is straight between samples, as loads are; samples of g are joined by a cubic spline,
whose acceleration is that.
"""

from __future__ import annotations

import csv
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import MOTIONS
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.reading import read_text
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.common.spatial import point_motions
from fe_drivetrain.dynamics.bodies.bodies import ALL, Body
from fe_drivetrain.dynamics.bodies.equations import Equations, Loads, summed, varying
from fe_drivetrain.dynamics.bodies.levels import TURNS
from fe_drivetrain.dynamics.bodies.system import System

UNITS = ("m", "m", "m", "rad", "rad", "rad")
"""Units of the base's motions in a file."""

MINIMUM = 4
"""Least number of samples, as many as a cubic spline takes."""

FINER = 16
"""Parts of an interval of samples for gyroscopic terms, which are quadratic in time."""


@dataclass(frozen=True)
class BaseMotion:
    """Motion of the base, given by samples.

    Attributes
    ----------
    motions : Floats
        Displacements (n, b) of all degrees of freedom as the base moves by one, rigidly.
    times : Floats
        Times (s,) of the samples, ascending [s].
    accelerations : Floats
        Acceleration (s, b) of the base [m/s^2, rad/s^2].
    velocity : Floats
        Velocity (b,) of the base at the first sample [m/s, rad/s].
    """

    __repr__ = short_repr

    motions: Floats
    times: Floats
    accelerations: Floats
    velocity: Floats

    def loads_on(self, equations: Equations) -> Loads:
        """Loads of inertia and gyroscopic terms on what stands on the base."""
        inertia = varying(-equations.mass @ self.motions, self.times, self.accelerations)
        turned = equations.damping @ self.motions
        if not turned.any():
            return inertia
        return summed(inertia, varying(-turned, *self._velocities()))

    def _velocities(self) -> tuple[Floats, Floats]:
        """Times (f,), finer than samples, and velocities (f, b) there."""
        from scipy.integrate import cumulative_trapezoid

        steps, a = np.diff(self.times)[:, None], self.accelerations
        v = self.velocity + cumulative_trapezoid(a, self.times, axis=0, initial=0.0)
        part = (np.arange(FINER) / FINER)[:, None, None]
        slopes = np.diff(a, axis=0) * part / 2.0
        within = v[:-1] + steps * part * (a[:-1] + slopes)
        finer = (self.times[:-1] + steps[:, 0] * part[..., 0]).T.ravel()
        velocities = within.transpose(1, 0, 2).reshape(-1, a.shape[1])
        return np.append(finer, self.times[-1]), np.vstack([velocities, v[-1:]])

    def check(self, begin: float, end: float) -> None:
        """Refuse a run that is not within the samples [s]."""
        first, last = float(self.times[0]), float(self.times[-1])
        if begin < first - 1e-9 or end > last + 1e-9:
            raise InputError(
                f"the base's motion is known from {first:g} to {last:g} s but the run goes from "
                f"{begin:g} to {end:g} s: give more samples, or a shorter run"
            )


def base_motion(motions: ArrayLike, times: ArrayLike, displacements: ArrayLike) -> BaseMotion:
    """Motion of the base from arrays.

    Parameters
    ----------
    motions : array_like
        Displacements (n, b) of all degrees of freedom as the base moves by one, rigidly: such as
        `on_base`.
    times : array_like
        Times (s,) of at least 4 samples, ascending [s].
    displacements : array_like
        Motion (s, b) of the base [m, rad], or (s,) of one.

    Raises
    ------
    InputError
        There are too few samples, times do not ascend, or numbers do not fit each other.
    """
    from scipy.interpolate import CubicSpline

    S, t, g = _samples(motions, times, displacements)
    path = CubicSpline(t, g)
    return BaseMotion(S, t, path(t, 2), path(t[0], 1))


def base_acceleration(
    motions: ArrayLike, times: ArrayLike, accelerations: ArrayLike, velocity: ArrayLike = 0.0
) -> BaseMotion:
    """Motion of the base from its acceleration, which is straight between samples.

    Parameters
    ----------
    motions : array_like
        Displacements (n, b) of all degrees of freedom as the base moves by one, rigidly: such as
        `on_base`.
    times : array_like
        Times (s,) of at least 4 samples, ascending [s].
    accelerations : array_like
        Acceleration (s, b) of the base [m/s^2, rad/s^2], or (s,) of one.
    velocity : array_like
        Velocity (b,) of the base at the first sample, which gyroscopic terms feel [m/s, rad/s].

    Raises
    ------
    InputError
        There are too few samples, times do not ascend, or numbers do not fit each other.
    """
    S, t, a = _samples(motions, times, accelerations)
    begin = np.broadcast_to(np.asarray(velocity, dtype=np.float64), (S.shape[1],))
    return BaseMotion(S, t, a, np.array(begin))


def _samples(
    motions: ArrayLike, times: ArrayLike, values: ArrayLike
) -> tuple[Floats, Floats, Floats]:
    """Motions, times and values of a base, as arrays that fit each other."""
    S, t = np.asarray(motions, dtype=np.float64), np.asarray(times, dtype=np.float64)
    S = S[:, None] if S.ndim == 1 else S
    g = np.asarray(values, dtype=np.float64).reshape(len(t), -1)
    if len(t) < MINIMUM or not (np.isfinite(t).all() and (np.diff(t) > 0.0).all()):
        raise InputError(
            f"a base's motion has {len(t)} samples but must have at least {MINIMUM}, whose times "
            "ascend: correct them"
        )
    if g.shape[1] != S.shape[1] or not np.isfinite(g).all():
        raise InputError(
            f"a base's motion has {g.shape[1]} columns of numbers and moves the system in "
            f"{S.shape[1]} ways, but must have as many, all finite: correct them"
        )
    return S, t, g


def read_base_motion(path: str | Path, system: System, bodies: Iterable[Body]) -> BaseMotion:
    """Motion of the base from a table "time [s],ux [m],...,rz [rad]"; what it has not is zero.

    Parameters
    ----------
    path : str or Path
        CSV file; the motion is about the origin of the frame.
    system, bodies : System, iterable of Body
        What stands on the base, see `on_base`.

    Raises
    ------
    InputError
        The file cannot be read, or a title or a cell is not as it must be.
    """
    rows = list(csv.reader(read_text(path, "motion of the base").splitlines()))
    known = {
        f"{name} [{unit}]": k for k, (name, unit) in enumerate(zip(MOTIONS, UNITS, strict=True))
    }
    header = [title.strip() for title in rows[0]] if rows else []
    wrong = [title for title in header[1:] if title not in known]
    if header[:1] != ["time [s]"] or wrong or len(header) < 2:
        raise InputError(
            f"motion of the base '{path}': its header is '{','.join(header)}' but must be "
            f"'time [s]' and some of {', '.join(known)}: correct it"
        )
    try:
        table = np.array(rows[1:], dtype=np.float64).reshape(-1, len(header))
    except ValueError as error:
        raise InputError(
            f"motion of the base '{path}': a cell is not a number, or a line has not as many as "
            f"the header: correct it ({error})"
        ) from error
    columns = [known[title] for title in header[1:]]
    return base_motion(on_base(system, bodies)[:, columns], table[:, 0], table[:, 1:])


def on_base(system: System, bodies: Iterable[Body]) -> Floats:
    """(n, 6) displacements of a system that moves rigidly with its base, about the origin.

    Parameters
    ----------
    system : System
        System with n degrees of freedom.
    bodies : iterable of Body
        Bodies at their places; what is not named does not move rigidly, as amplitudes of elastic
        rings do not. Beside bodies with all motions, one that turns alone stands on the base.

    Raises
    ------
    InputError
        The degrees of freedom do not allow that motion, as those of a torsional system.
    """
    identity, stands = np.eye(len(system.names)), list(bodies)
    moving = any(body.free == ALL for body in stands)
    rows, rigid = [np.zeros((0, len(identity)))], [np.zeros((0, 6))]
    # nodes of condensed shafts have their mass in a superelement
    heavy = {system.bodies[number] for number in system.body_of.tolist()}
    for body in stands:
        moves = system.motion_of(body.name, identity)
        # what is held is part of the base, and what has no inertia does not feel it
        if moves.any() and (body.mass > 0.0 or body.polar > 0.0 or body.name in heavy):
            # a generator that turns alone on its foundation goes along with the base otherwise
            own = moves.any(axis=1) if moving and body.free == TURNS else np.ones(6, dtype=bool)
            rows.append(moves[own])
            rigid.append(point_motions(np.array([body.position]))[own])
    by, whole = np.vstack(rows), np.vstack(rigid)
    found = np.linalg.lstsq(by, whole, rcond=1e-12)[0]
    missed = np.abs(by @ found - whole).max(axis=0, initial=0.0)
    for name, size in zip(MOTIONS, missed, strict=True):
        if size > 1e-9:
            raise InputError(
                f"the system cannot move with its base along {name}: a body has no degree of "
                "freedom for it; use a level with all motions of its bodies"
            )
    return np.asarray(found)
