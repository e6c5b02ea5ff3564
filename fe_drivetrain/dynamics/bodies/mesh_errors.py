"""Transmission errors that excite a machine: along lines of action, in frequency and in time.

A mesh of stiffness k and damping c with the error e presses with k (delta - e) + c (delta' - e'):
the error moves the free place of the spring. For a stiffness that does not vary, that is a load
(k e + c e') along the row of the mesh, whose answer is linear.
"""

from dataclasses import dataclass
from math import cos

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.dynamics.bodies.equations import wave_table
from fe_drivetrain.gear.loaded_error import TransmissionError

INTERVALS = 256
"""Number of intervals of an error's spline in its period."""


@dataclass(frozen=True)
class MeshError:
    """Error of a mesh along the normal of its teeth, positive where material is missing.

    Attributes
    ----------
    values : ndarray, (p,)
        Error at even phases of its period from 0 [m].
    turns : float
        Periods of the error for each of the mesh: 1 of a form that each tooth has, 1/z of the
        run-out and pitch errors of a gear with z teeth.
    phase : float
        Phase of the error at phase 0 of the mesh [periods of the error].
    """

    values: Floats
    turns: float = 1.0
    phase: float = 0.0

    __repr__ = short_repr

    @property
    def table(self) -> Floats:
        """(p, 4) as `wave_table` has it, on a common number of intervals."""
        from scipy.interpolate import CubicSpline

        at = np.asarray(self.values, dtype=np.float64)
        if len(at) != INTERVALS:
            ends = np.linspace(0.0, 1.0, len(at) + 1)
            spline = CubicSpline(ends, [*at, at[0]], bc_type="periodic")
            at = spline(np.arange(INTERVALS) / INTERVALS)
        return wave_table(at)

    def harmonic(self, order: int) -> complex:
        """Amplitude of exp(2 pi i order psi) by the phase of its own period, twice [m].

        Parameters
        ----------
        order : int
            Number of the harmonic, from 1.

        Raises
        ------
        InputError
            There are too few values for it.
        """
        return harmonic_of(self.values, order)


def harmonic_of(values: Floats, order: int) -> complex:
    """Twice the amplitude of exp(2 pi i order psi) in values (p,) at even phases of a period.

    Raises
    ------
    InputError
        There are too few values for it.
    """
    n = len(values)
    if not 1 <= order <= (n - 1) // 2:
        raise InputError(
            f"order {order} of a mesh with {n} values in a period must be 1 to {(n - 1) // 2}: "
            "give more values, or a lower order"
        )
    return complex(np.fft.rfft(values)[order] * 2.0 / n)


def harmonic_error(
    cosines: ArrayLike, sines: ArrayLike, turns: float = 1.0, phase: float = 0.0
) -> MeshError:
    """An error of harmonics.

    Parameters
    ----------
    cosines, sines : array_like
        Coefficients (l,) of cos(2 pi l psi) and sin(2 pi l psi), l from 1 [m].
    turns, phase : float
        Periods of the error per period of the mesh, and its phase, see `MeshError`.

    Returns
    -------
    error : MeshError
    """
    a, b = np.asarray(cosines, dtype=np.float64), np.asarray(sines, dtype=np.float64)
    angle = 2.0 * np.pi * np.outer(np.arange(INTERVALS) / INTERVALS, np.arange(1, len(a) + 1))
    return MeshError(np.asarray(np.cos(angle) @ a + np.sin(angle) @ b), turns, phase)


def error_of_slices(
    found: TransmissionError, base_helix: float = 0.0, *, loaded: bool
) -> MeshError:
    """The error of a mesh in slices, along the normal of its teeth.

    Parameters
    ----------
    found : TransmissionError
        Transmission error, from `gear.transmission_error`.
    base_helix : float
        Base helix angle of the gears [rad]: errors in the transverse plane are longer by 1 / cos.
    loaded : bool
        Static error under load, for a mesh of constant stiffness; or the free place of the flanks,
        for one whose stiffness varies as the slices do (`found.stiffness`). Both with their mean
        taken away, which is wound up by the load and shifts nothing else.

    Returns
    -------
    error : MeshError
    """
    values = found.static if loaded else found.unloaded
    return MeshError(np.asarray((values - values.mean()) * cos(base_helix), dtype=np.float64))
