"""Inertia, damping and stiffness from measured torque and twist, by lines of their spectra.

Derivatives of a line are products with its frequency, so that noise outside the band that is used
is never amplified; lines are uncorrelated whatever the colour of the noise, so that the residual
gives a covariance that holds (White 1980). Instruments made of the torque by the model found so far
(Young 1970) take out the bias that noise in the twist has in least squares.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.procedure.identification import Fit

_ITERATIONS = 8


def spectral_fit(
    torque: Floats,
    angle: Floats,
    step: float,
    band: tuple[float, float],
    instrument: Floats | None = None,
) -> Fit:
    """Fit ``torque = I angle'' + D angle' + K angle`` to lines of a band.

    A record is not a period: the difference of its ends adds a polynomial in i w to the spectrum of
    a derivative (Pintelon and Schoukens 2012, section 6.3.2), which is fitted too.

    Parameters
    ----------
    torque : ndarray, (n,)
        The reduced torque (`reduced_torque`) [N m].
    angle : ndarray, (n,)
        Twist, on the same side [rad]; an offset does not matter.
    step : float
        Between two samples [s].
    band : tuple of float
        Lowest and highest frequency that is used [Hz]: about the natural frequency, well inside of
        what was sampled.
    instrument : ndarray, (n,), optional
        Another record of the torque, or of anything that moves with it, whose noise is independent:
        a second bridge. Where left out it is the torque itself, whose noise then multiplies all
        three by one plus its power over that of the signal in the band, which no band shows.

    Returns
    -------
    Fit
        With a covariance by the residual of each line.

    Raises
    ------
    InputError
        The band does not rise, is above half the sampling rate, or has fewer than ten lines.
    """
    count = len(torque)
    frequency = np.fft.rfftfreq(count, step)
    if not 0.0 <= band[0] < band[1] <= frequency[-1]:
        raise InputError(
            f"frequencies from {band[0]:g} to {band[1]:g} Hz are no band of a record of "
            f"{1.0 / step:g} Hz: give two that rise, from 0 to {frequency[-1]:g} Hz"
        )
    inside = (frequency >= band[0]) & (frequency <= band[1]) & (frequency > 0.0)
    if int(inside.sum()) < 10:
        raise InputError(
            f"{inside.sum()} lines of the spectrum are from {band[0]:g} to {band[1]:g} Hz, but ten "
            "are needed: give a longer history, or a wider band"
        )
    # of least squares, lengths of order 1: frequencies over the middle of the band
    middle = 2.0 * np.pi * float(np.sqrt(max(band[0], frequency[1]) * band[1]))
    s = 2j * np.pi * frequency[inside] / middle
    moving = torque if instrument is None else instrument
    T, X, V = (np.fft.rfft(np.asarray(of) - np.mean(of))[inside] for of in (torque, angle, moving))
    size_t, size_x = np.abs(T).max(), np.abs(X).max()
    T, X, V = T / size_t, X / size_x, V / np.abs(V).max()
    ends = np.stack([np.ones_like(s), s], axis=1)

    def columns(twist: NDArray[np.complex128]) -> NDArray[np.complex128]:
        return np.column_stack([s**2 * twist, s * twist, twist, ends])

    regressors = columns(X)
    theta = _solved(regressors, regressors, T, np.ones(len(s)))
    for _ in range(_ITERATIONS):
        model = theta[0] * s**2 + theta[1] * s + theta[2]
        instruments = columns(V / model)
        # noise in the twist appears in the residual times the model
        theta = _solved(instruments, regressors, T, 1.0 / np.abs(model))
    weights = 1.0 / np.abs(theta[0] * s**2 + theta[1] * s + theta[2])
    residual = (T - regressors @ theta) * weights
    Z, R = instruments * weights[:, None], regressors * weights[:, None]
    bread = np.linalg.inv((Z.conj().T @ R).real)
    each = (Z.conj() * residual[:, None]).real
    degrees = 2.0 * len(s) / (2.0 * len(s) - len(theta))
    covariance = degrees * bread @ (each.T @ each) @ bread.T
    to_units = size_t / size_x * np.array([middle**-2, middle**-1, 1.0])
    return Fit(
        np.asarray(theta[:3] * to_units, dtype=np.float64),
        np.asarray(covariance[:3, :3] * np.outer(to_units, to_units), dtype=np.float64),
    )


def _solved(
    instruments: NDArray[np.complex128],
    regressors: NDArray[np.complex128],
    T: NDArray[np.complex128],
    weights: Floats,
) -> Floats:
    """Real unknowns of which the weighted residual is orthogonal to the instruments."""
    Z = instruments * weights[:, None]
    matrix = (Z.conj().T @ (regressors * weights[:, None])).real
    return np.asarray(np.linalg.solve(matrix, (Z.conj().T @ (T * weights)).real))
