"""Beams on springs: the exact Timoshenko beam on any supports, by Macaulay's brackets."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common import Floats


@dataclass(frozen=True)
class Spring:
    """A support in the plane of x and z.

    Attributes
    ----------
    x : float
        Station [m].
    force : float
        Stiffness against u_z [N/m], inf is rigid.
    moment : float
        Stiffness against the slope [N m/rad].
    """

    x: float
    force: float
    moment: float = 0.0


@dataclass(frozen=True)
class Bent:
    """Answer of `macaulay`.

    Attributes
    ----------
    deflection, slope : Floats
        At the stations asked for: u_z [m] and the rotation of the section, positive as u_z'
        where there is no shear [rad].
    forces, moments : Floats
        That the supports put on the beam, along z and in the sense of the slope [N, N m].
    """

    deflection: Floats
    slope: Floats
    forces: Floats
    moments: Floats


@dataclass(frozen=True)
class _Beam:
    """Deflections and slopes by single forces, moments and loads; arguments of `macaulay`."""

    length: float
    EI: float
    kGA: float
    loads: Sequence[tuple[float, float, float]]
    per_length: float

    def effect(self, kind: int, a: float, x: Floats) -> tuple[Floats, Floats]:
        """Deflection and slope at x by a unit force (kind 0) or moment (kind 1) at station a."""
        d = np.maximum(x - a, 0.0)
        if kind == 0:
            return d**3 / (6 * self.EI) - d / self.kGA, d**2 / (2 * self.EI)
        return -(d**2) / (2 * self.EI), -d / self.EI

    def given(self, x: Floats) -> tuple[Floats, Floats]:
        """Deflection and slope at x by all loads."""
        w = self.per_length * (x**4 / (24 * self.EI) - x**2 / (2 * self.kGA))
        phi = self.per_length * x**3 / (6 * self.EI)
        for a, force, moment in self.loads:
            (wf, pf), (wm, pm) = self.effect(0, a, x), self.effect(1, a, x)
            w, phi = w + force * wf + moment * wm, phi + force * pf + moment * pm
        return w, phi

    def equations(self, unknowns: Sequence[tuple[float, int, float]]) -> tuple[Floats, Floats]:
        """Matrix and right side for reactions (station, kind, stiffness), c0 and c1."""
        n = len(unknowns)
        matrix, right = np.zeros((n + 2, n + 2)), np.zeros(n + 2)
        for row, (station, kind, stiffness) in enumerate(unknowns):
            here = np.array([station])
            for column, (a, of, _) in enumerate(unknowns):
                matrix[row, column] = self.effect(of, a, here)[kind][0]
            matrix[row, row] += 0.0 if np.isinf(stiffness) else 1.0 / stiffness
            matrix[row, n:] = (1.0, station) if kind == 0 else (0.0, 1.0)
            right[row] = -self.given(here)[kind][0]
        for column, (a, kind, _) in enumerate(unknowns):
            matrix[n:, column] = (1.0, a) if kind == 0 else (0.0, 1.0)
        right[n] = -self.per_length * self.length - sum(load[1] for load in self.loads)
        right[n + 1] = -self.per_length * self.length**2 / 2
        right[n + 1] -= sum(load[0] * load[1] + load[2] for load in self.loads)
        return matrix, right


def macaulay(
    length: float,
    EI: float,
    kGA: float,
    supports: Sequence[Spring],
    loads: Sequence[tuple[float, float, float]],
    at: ArrayLike,
    load_per_length: float = 0.0,
) -> Bent:
    """A uniform Timoshenko beam from 0 to L on any springs, by Macaulay's brackets.

    With F and m the forces along z and the moments in the sense of the slope at stations a,
    ``phi = c1 + sum F <x-a>^2 / 2EI - m <x-a> / EI + q x^3 / 6EI`` and
    ``w = c0 + c1 x + sum F (<x-a>^3 / 6EI - <x-a> / kGA) - m <x-a>^2 / 2EI + q (x^4 / 24EI -
    x^2 / 2kGA)``: the reactions and c0, c1 follow from the springs and from equilibrium.

    Parameters
    ----------
    length, EI, kGA : float
        [m], [N m^2], [N]; kGA may be infinite.
    supports : Sequence[Spring]
        The springs.
    loads : Sequence[tuple[float, float, float]]
        Station [m], force [N] and moment [N m].
    at : ArrayLike
        Stations where the answer is wanted [m].
    load_per_length : float
        q along z [N/m].
    """
    x = np.atleast_1d(np.asarray(at, dtype=float))
    beam = _Beam(length, EI, kGA, loads, load_per_length)
    unknowns = [(s.x, 0, s.force) for s in supports if s.force > 0]
    unknowns += [(s.x, 1, s.moment) for s in supports if s.moment > 0]
    matrix, right = beam.equations(unknowns)
    # forces are many times what deflections are
    rows = np.abs(matrix).max(axis=1)
    columns = np.abs(matrix / rows[:, None]).max(axis=0)
    found = np.linalg.solve(matrix / rows[:, None] / columns, right / rows) / columns
    w, phi = beam.given(x)
    reactions = np.zeros((2, len(supports)))
    for value, (a, kind, _) in zip(found, unknowns, strict=False):
        more = beam.effect(kind, a, x)
        w, phi = w + value * more[0], phi + value * more[1]
    w, phi = w + found[-2] + found[-1] * x, phi + found[-1]
    for kind, name in enumerate(("force", "moment")):
        held = [i for i, s in enumerate(supports) if getattr(s, name) > 0]
        reactions[kind, held] = [v for v, u in zip(found, unknowns, strict=False) if u[1] == kind]
    return Bent(w, phi, *reactions)
