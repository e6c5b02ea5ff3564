"""Turbulent wind over a rotor disc: Kaimal spectrum, exponential coherence, sampled on rings.

IEC 61400-1 gives the along-wind turbulence at a point (Kaimal spectrum) and the coherence of two
points, which depends on frequency, distance and mean speed only.  Points on circles about the hub
are then statistically equal at every azimuth, so the cross-spectral matrix of rings is circulant
in azimuth: its harmonics after a discrete Fourier transform in azimuth are independent,
and one dense matrix of all points falls apart into one small matrix (rings by rings) per harmonic.
This is exact at the nodes of the rings, and it serves rotational sampling directly: what a blade
meets is the sum of harmonics at its own azimuth.

The number of nodes on a ring is odd (2 M + 1), so that there is no Nyquist harmonic and the
variance is the same at every azimuth, nodes or not.

Why not a package.  PyConTurb generates the same field and is the independent check of spectrum and
coherence in the tests, but it factors one matrix of all points per frequency and again for each
history: measured side by side on one thread for 12 000 samples, PyConTurb 2.7 took 17 times
(73 points: 6 rings of 12 and the hub) and 140 times (311 points: 10 rings of 31 and the hub) as
long as one whole history, loads included, takes here.  HiperSim generates Mann boxes, which
is another spectrum.

Only the along-wind component is generated: it drives thrust and bending moment, the others change
the blades' relative speed by a per cent or two of the speed of rotation.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.fft
from numpy.typing import ArrayLike, NDArray

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError

Singles = NDArray[np.float32]

REFERENCE_INTENSITY = {"none": 0.0, "low": 0.12, "medium": 0.14, "high": 0.16}
"""Iref of IEC 61400-1 Ed. 3, Table 1: classes C, B, A; none is a wind without turbulence."""

COHERENCE_DECAY = 12.0
COHERENCE_OFFSET = 0.12


def turbulence_sigma(wind_speed: float, turbulence: str) -> float:
    """Standard deviation of the along-wind speed [m/s], normal turbulence model.

    IEC 61400-1 Ed. 3, Eq 11: sigma = Iref (0.75 V + 5.6 m/s).

    Raises
    ------
    InputError
        If the class is unknown.
    """
    if turbulence not in REFERENCE_INTENSITY:
        raise InputError(
            f"turbulence '{turbulence}' is not one of {', '.join(REFERENCE_INTENSITY)}"
        )
    return REFERENCE_INTENSITY[turbulence] * (0.75 * wind_speed + 5.6)


def length_scales(hub_height: float) -> tuple[float, float]:
    """Integral scale of the Kaimal spectrum and coherence scale [m], along-wind component.

    IEC 61400-1 Ed. 3, Eq 5 and Table B.1: both are 8.1 times 0.7 z, at most 42 m.
    """
    scale = 0.7 * min(hub_height, 60.0)
    return 8.1 * scale, 8.1 * scale


def kaimal_variance_below(frequency: ArrayLike, wind_speed: float, length: float) -> Floats:
    """Share of the variance slower than a frequency: the exact integral of Kaimal's spectrum.

    IEC 61400-1 Ed. 3, Eq B.14: f S / sigma^2 = 4 f L / V / (1 + 6 f L / V)^(5/3).
    """
    f = np.asarray(frequency, dtype=float)
    return np.asarray(1.0 - (1.0 + 6.0 * f * length / wind_speed) ** (-2.0 / 3.0))


def coherence_decay(frequency: ArrayLike, wind_speed: float, length: float) -> Floats:
    """Decay of the coherence with distance [1/m], so that coherence = exp(-decay distance).

    IEC 61400-1 Ed. 3, Eq B.16: exp(-12 sqrt((f r / V)^2 + (0.12 r / Lc)^2)).
    """
    f = np.asarray(frequency, dtype=float)
    return np.asarray(COHERENCE_DECAY * np.hypot(f / wind_speed, COHERENCE_OFFSET / length))


def power_law(wind_speed: float, height: ArrayLike, hub_height: float, shear: float) -> Floats:
    """Mean wind speed [m/s] at a height [m]: V (z / z_hub)^alpha (IEC 61400-1 Ed. 3, Eq 10)."""
    return np.asarray(wind_speed * (np.asarray(height, dtype=float) / hub_height) ** shear)


@dataclass(frozen=True, eq=False)
class DiscTurbulence:
    """What all turbulent histories of one mean wind speed share: the factored spectra.

    Attributes
    ----------
    radius : array_like, (r,)
        Radii of the rings [m].
        Rings of the disc.
    samples, rate : int, float
        Length n of a history and its samples a second [Hz].
    factors : (M + 1, r, r, k)
        For each azimuth harmonic and frequency line, the lower Cholesky factor of the rings'
        cross-spectral matrix, scaled so that the inverse real FFT gives unit variance at a point.
    """

    radius: Floats
    samples: int
    rate: float
    factors: Singles

    @property
    def harmonics(self) -> int:
        """Highest azimuth harmonic M; a ring has 2 M + 1 nodes."""
        return len(self.factors) - 1

    def draw(self, generator: np.random.Generator) -> Singles:
        """One realisation with unit variance: (2 M + 1, r, n).

        Row 0 is the mean around each ring, rows 1..M the cosine and M+1..2M the sine coefficients.
        The history is periodic: its end runs on into its beginning.
        """
        m, lines, rings = self.harmonics, self.factors.shape[-1], self.radius.size
        # Single precision: seven digits are far more than a random field needs, at half the cost.
        noise = generator.standard_normal((2 * m + 1, lines, rings, 2), dtype=np.float32)
        lines_out = np.zeros((2 * m + 1, rings, self.samples // 2 + 1), dtype=np.complex64)
        for row in range(2 * m + 1):
            factor = self.factors[row if row <= m else row - m]
            # all lines at once: a product of small matrices for each takes three times as long
            drawn = np.ascontiguousarray(np.moveaxis(noise[row], 0, -1))
            correlated = factor[:, 0, None] * drawn[0]
            for ring in range(1, rings):
                correlated[ring:] += factor[ring:, ring, None] * drawn[ring]
            of_row = lines_out[row, :, 1 : lines + 1]
            of_row.real, of_row.imag = correlated[:, 0], correlated[:, 1]
        return np.asarray(scipy.fft.irfft(lines_out, n=self.samples, axis=-1))


def disc_turbulence(
    radius: ArrayLike,
    harmonics: int,
    wind_speed: float,
    length: float,
    coherence_length: float,
    duration: float,
    rate: float,
) -> DiscTurbulence:
    """Factor the spectra of the rings of a disc, once for all histories of one mean speed.

    Each frequency line carries the variance of its own band, exactly integrated, and the first line
    also all that is slower than the record: the expected variance at a point is then the variance
    asked for (less what is faster than half the sampling rate), however short the record.

    Parameters
    ----------
    radius : array_like, (r,)
        Radii of the rings [m].
    harmonics : int
        Highest azimuth harmonic M.
    wind_speed : float
        Mean [m/s].
    length, coherence_length : float
        Integral length scale, and that of the coherence [m].
    duration : float
        Length of the histories [s].
    rate : float
        Samples per second [Hz].
    """
    r = np.asarray(radius, dtype=float)
    samples = round(duration * rate)
    step = rate / samples
    # The line at half the sampling rate, there for even lengths only, stays empty: it has no phase.
    frequency = step * np.arange(1, (samples + 1) // 2)
    edges = np.concatenate(([0.0], frequency[:-1] + step / 2.0, [rate / 2.0]))
    variance = np.diff(kaimal_variance_below(edges, wind_speed, length))
    decay = coherence_decay(frequency, wind_speed, coherence_length)

    nodes = 2 * harmonics + 1
    angle = 2.0 * np.pi * np.arange(harmonics + 1) / nodes
    square = r[:, None, None] ** 2 + r[None, :, None] ** 2
    product = r[:, None, None] * r[None, :, None]
    distance = np.sqrt(np.maximum(square - 2.0 * product * np.cos(angle), 0.0))

    # Coherence is even in azimuth, so its transform over all nodes is a cosine sum over half.
    weight = np.where(np.arange(harmonics + 1) == 0, 1.0, 2.0)
    transform = weight[:, None] * np.cos(np.outer(np.arange(harmonics + 1), angle)).T / nodes
    transform *= np.where(np.arange(harmonics + 1) == 0, 1.0, 2.0)

    # A line of variance v is sqrt(v) (p cos - q sin) with p, q standard normal, and irfft makes
    # that from (n / 2) sqrt(v) (p + i q).
    amplitude = 0.5 * samples * np.sqrt(variance)
    factors = np.empty((harmonics + 1, r.size, r.size, frequency.size), dtype=np.float32)
    for lines in np.array_split(np.arange(frequency.size), max(1, frequency.size // 500)):
        coherence = np.exp(-decay[lines, None, None, None] * distance)
        spectra = np.moveaxis(coherence @ transform, -1, 0)
        lower = np.linalg.cholesky(spectra) * amplitude[lines, None, None]
        factors[..., lines] = np.moveaxis(lower, 1, -1)
    return DiscTurbulence(r, samples, rate, factors)


def at_azimuth(coefficients: Singles, azimuth: ArrayLike) -> Floats:
    """Wind on all rings at a moving azimuth: (n, r), from coefficients (2 M + 1, r, n).

    Parameters
    ----------
    coefficients : ndarray, (2 M + 1, r, n)
        As ``DiscTurbulence.draw`` gives them.
    azimuth : array_like, (n,)
        [rad].
    """
    psi = np.asarray(azimuth, dtype=float)
    m = (len(coefficients) - 1) // 2
    # sines and cosines of 2 M multiples would take most of the time: powers of one turn instead
    turns = np.multiply.accumulate(np.broadcast_to(np.exp(1j * psi), (m, psi.size)), axis=0)
    waves = np.concatenate((np.ones((1, psi.size)), turns.real, turns.imag))
    wind = np.einsum("mrt,mt->tr", coefficients, waves.astype(np.float32))
    return np.asarray(wind, dtype=np.float64)
