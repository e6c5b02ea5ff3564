"""Turbulent wind: the formulas against their integrals, the field against the formulas."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.signal import welch

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.turbine_loads.hub_loads.wind import (
    DiscTurbulence,
    at_azimuth,
    coherence_decay,
    disc_turbulence,
    kaimal_variance_below,
    length_scales,
    power_law,
    turbulence_sigma,
)

SPEED = 12.0
LENGTH = 340.2
RADIUS = np.array([8.0, 22.0, 38.0])
HARMONICS = 7
NODES = 2 * HARMONICS + 1
DURATION, RATE = 120.0, 10.0


def kaimal_spectrum(frequency, wind_speed: float, sigma: float, length: float):
    """One-sided power spectral density [m^2/s] of the along-wind speed.

    IEC 61400-1 Ed. 3, Eq B.14: f S / sigma^2 = 4 f L / V / (1 + 6 f L / V)^(5/3).
    """
    passage = length / wind_speed
    return sigma**2 * 4.0 * passage / (1.0 + 6.0 * frequency * passage) ** (5.0 / 3.0)


@pytest.fixture(scope="module")
def disc() -> DiscTurbulence:
    return disc_turbulence(RADIUS, HARMONICS, SPEED, LENGTH, LENGTH, DURATION, RATE)


@pytest.fixture(scope="module")
def draws(disc: DiscTurbulence) -> np.ndarray:
    """Many realisations: (draw, harmonic, ring, time)."""
    generator = np.random.default_rng(20240601)
    return np.stack([disc.draw(generator) for _ in range(200)])


def at_node(draws: np.ndarray, ring: int, node: int) -> np.ndarray:
    """Wind at one fixed node of a ring in every draw: (draw, time)."""
    angle = 2.0 * np.pi * node / NODES
    turns = angle * np.arange(1, HARMONICS + 1)
    waves = np.concatenate(([1.0], np.cos(turns), np.sin(turns)))
    return np.einsum("dmt,m->dt", draws[:, :, ring], waves)


def distance(ring: int, other: int, node: int) -> float:
    """Between node 0 of a ring and a node of another."""
    here = RADIUS[ring] * np.array([0.0, 1.0])
    angle = 2.0 * np.pi * node / NODES
    return float(np.linalg.norm(RADIUS[other] * np.array([np.sin(angle), np.cos(angle)]) - here))


# --- formulas ------------------------------------------------------------------------------------


def test_slow_gusts_are_smaller_than_the_coherence_scale() -> None:
    """IEC 61400-1 Ed. 3, Eq B.16: 0.12 r / L_c under the root, whatever the frequency."""
    still = coherence_decay(0.0, SPEED, LENGTH)
    assert still == pytest.approx(12.0 * 0.12 / LENGTH, rel=1e-14)
    f = 0.05
    fast = 12.0 * np.sqrt((f / SPEED) ** 2 + (0.12 / LENGTH) ** 2)
    assert coherence_decay(f, SPEED, LENGTH) == pytest.approx(fast, rel=1e-14)


def test_the_whole_spectrum_holds_the_variance() -> None:
    assert kaimal_variance_below([0.0, 1e12], SPEED, LENGTH) == pytest.approx([0.0, 1.0], abs=1e-7)


def test_variance_below_is_the_integral_of_the_spectrum() -> None:
    for low, high in ((0.0, 0.01), (0.01, 0.3), (0.3, 5.0)):
        share, _ = quad(lambda f: float(kaimal_spectrum(f, SPEED, 1.0, LENGTH)), low, high)
        closed = np.diff(kaimal_variance_below([low, high], SPEED, LENGTH))[0]
        assert closed == pytest.approx(share, rel=1e-9)


def test_what_is_left_above_falls_with_the_inertial_power() -> None:
    slow, fast = 1.0 - kaimal_variance_below([10.0, 80.0], SPEED, LENGTH)
    assert np.log(fast / slow) / np.log(8.0) == pytest.approx(-2.0 / 3.0, abs=1e-3)


def test_normal_turbulence_at_the_reference_speed() -> None:
    # IEC 61400-1 Ed. 3, section 6.2: Iref is the expected intensity at 15 m/s; sigma of Eq 11 is
    # its 90 % quantile, which is higher there by 5.6 / 15 + 0.75 - 1.
    for name, intensity in (("low", 0.12), ("medium", 0.14), ("high", 0.16)):
        assert turbulence_sigma(15.0, name) / 15.0 == pytest.approx(intensity * (0.75 + 5.6 / 15))
    assert turbulence_sigma(15.0, "none") == 0.0
    with pytest.raises(InputError, match="'fierce' is not one of none, low, medium, high"):
        turbulence_sigma(15.0, "fierce")


def test_scales_grow_with_height_up_to_sixty_metres() -> None:
    assert length_scales(30.0)[0] == pytest.approx(0.5 * length_scales(60.0)[0])
    assert length_scales(60.0) == length_scales(140.0)


def test_power_law_is_exact_at_the_hub_and_straight_in_logarithms() -> None:
    assert power_law(SPEED, 80.0, 80.0, 0.37) == SPEED
    speeds = power_law(SPEED, [40.0, 80.0, 160.0], 80.0, 0.37)
    np.testing.assert_allclose(np.diff(np.log(speeds)) / np.log(2.0), 0.37)


@pytest.mark.needs("pyconturb")
def test_formulas_agree_with_pyconturb() -> None:
    import pandas as pd
    from pyconturb.coherence import get_iec_cor_mat
    from pyconturb.sig_models import iec_sig
    from pyconturb.spectral_models import kaimal_spectrum as kaimal_of_pyconturb

    points = pd.DataFrame(
        [[0.0, 0.0, 0.0, 80.0], [0.0, 0.0, 20.0, 95.0]],
        index=["u_p0", "u_p1"],
        columns=["k", "x", "y", "z"],
    ).T
    f = np.geomspace(1e-3, 10.0, 40)
    length, coherence_length = length_scales(80.0)
    theirs = kaimal_of_pyconturb(f, points, u_ref=SPEED)[:, 0]
    np.testing.assert_allclose(kaimal_spectrum(f, SPEED, 1.0, length), theirs, rtol=1e-12)

    coherence = get_iec_cor_mat(f, points, u_ref=SPEED, l_c=coherence_length)[:, 0, 1]
    ours = np.exp(-coherence_decay(f, SPEED, coherence_length) * np.hypot(20.0, 15.0))
    np.testing.assert_allclose(ours, coherence, rtol=1e-12)

    for name, letter in (("low", "C"), ("medium", "B"), ("high", "A")):
        sigma = np.atleast_1d(iec_sig(points, turb_class=letter, u_ref=SPEED))[0]
        assert turbulence_sigma(SPEED, name) == pytest.approx(sigma)


# --- the factored field, exactly -----------------------------------------------------------------


def test_factors_give_the_iec_cross_spectrum_of_every_pair_of_nodes(disc: DiscTurbulence) -> None:
    factors = np.moveaxis(disc.factors, -1, 1).astype(float)
    spectra = factors @ factors.swapaxes(-1, -2)
    frequency = np.arange(1, factors.shape[1] + 1) / DURATION
    power = spectra[:, :, 0, 0].sum(axis=0)  # at any one point: what the coherence is relative to
    decay = coherence_decay(frequency, SPEED, LENGTH)
    for ring in range(len(RADIUS)):
        for other in range(len(RADIUS)):
            for node in range(NODES):
                turns = np.cos(2.0 * np.pi * node / NODES * np.arange(HARMONICS + 1))
                cross = np.einsum("mf,m->f", spectra[:, :, ring, other], turns)
                expected = np.exp(-decay * distance(ring, other, node))
                np.testing.assert_allclose(cross / power, expected, atol=2e-6)


@pytest.mark.parametrize("duration", [60.0, 60.1])
def test_variance_of_a_point_is_whole_for_short_records_too(duration: float) -> None:
    disc = disc_turbulence(RADIUS, 3, SPEED, LENGTH, LENGTH, duration, RATE)
    factors = np.moveaxis(disc.factors, -1, 1).astype(float)
    spectra = np.einsum("mfij,mfij->fi", factors, factors)
    # A line (n / 2) a (p + i q) of the transform is a wave of variance a^2.
    variance = (spectra / (0.5 * disc.samples) ** 2).sum(axis=0)
    np.testing.assert_allclose(
        variance, kaimal_variance_below(RATE / 2.0, SPEED, LENGTH), rtol=1e-5
    )


def test_lines_of_a_field_are_factors_times_independent_numbers(disc: DiscTurbulence) -> None:
    factors = np.moveaxis(disc.factors, -1, 1)
    lines = factors.shape[1]
    shape = (2 * HARMONICS + 1, lines, len(RADIUS), 2)
    noise = np.random.default_rng(7).standard_normal(shape, dtype=np.float32)
    drawn = np.fft.rfft(disc.draw(np.random.default_rng(7)), axis=-1)[..., 1 : lines + 1]
    of_rows = factors[[*range(HARMONICS + 1), *range(1, HARMONICS + 1)]].astype(float)
    expected = of_rows @ (noise[..., 0] + 1j * noise[..., 1])[..., None]
    found = np.moveaxis(drawn, -1, 1)
    np.testing.assert_allclose(found, expected[..., 0], atol=1e-5 * np.abs(expected).max())


# --- the drawn field, statistically --------------------------------------------------------------


def test_drawn_wind_has_the_variance_and_no_mean(draws: np.ndarray) -> None:
    for ring in range(len(RADIUS)):
        wind = at_node(draws, ring, 4)
        np.testing.assert_allclose(wind.mean(axis=1), 0.0, atol=1e-5)
        variances = wind.var(axis=1)
        error = variances.std(ddof=1) / np.sqrt(len(variances))
        expected = float(kaimal_variance_below(RATE / 2.0, SPEED, LENGTH))
        assert abs(variances.mean() - expected) < 3.5 * error
        assert error < 0.06  # enough draws for the line above to mean something


def test_drawn_wind_has_the_kaimal_spectrum(draws: np.ndarray) -> None:
    wind = at_node(draws, 1, 9)
    # One whole record a segment: the lines of the draw are the lines of the estimate.
    frequency, power = welch(wind, RATE, window="boxcar", nperseg=wind.shape[1], detrend=False)
    inner = slice(2, -2)  # the first line and the last carry what lies beyond them as well
    ratio = power.mean(axis=0)[inner] / kaimal_spectrum(frequency[inner], SPEED, 1.0, LENGTH)
    # Each line is chi-squared with 2 degrees of freedom: relative error 1 / sqrt(draws).
    error = 1.0 / np.sqrt(len(wind))
    bands = [b.mean() for b in np.array_split(ratio, 20)]
    lines = len(ratio) / 20
    np.testing.assert_allclose(bands, 1.0, atol=4.0 * error / np.sqrt(lines))


@pytest.mark.parametrize(("ring", "other", "node"), [(2, 2, 1), (0, 2, 0), (1, 2, 2), (0, 0, 7)])
def test_drawn_wind_has_the_iec_coherence(
    draws: np.ndarray, ring: int, other: int, node: int
) -> None:
    here = np.fft.rfft(at_node(draws, ring, 0))[:, 1:-1]
    there = np.fft.rfft(at_node(draws, other, node))[:, 1:-1]
    cross = (here * there.conj()).mean(axis=0)
    norm = np.sqrt((np.abs(here) ** 2).mean(axis=0) * (np.abs(there) ** 2).mean(axis=0))
    measured = cross / norm
    frequency = np.arange(1, measured.size + 1) / DURATION
    expected = np.exp(-coherence_decay(frequency, SPEED, LENGTH) * distance(ring, other, node))
    # A complex correlation of `draws` samples has an error of at most 1 / sqrt(draws) a line.
    bands = np.array_split(np.arange(measured.size), 25)
    error = 1.0 / np.sqrt(len(draws) * measured.size / 25)
    for band in bands:
        assert abs(measured.real[band].mean() - expected[band].mean()) < 4.0 * error
        assert abs(measured.imag[band].mean()) < 4.0 * error


def test_drawn_wind_is_gaussian(draws: np.ndarray) -> None:
    wind = at_node(draws, 2, 3)
    wind = wind / wind.std()
    assert abs((wind**3).mean()) < 0.1
    assert (wind**4).mean() == pytest.approx(3.0, abs=0.2)


# --- sampling along the blades -------------------------------------------------------------------


def test_wind_at_a_still_azimuth_is_the_wind_of_that_point(draws: np.ndarray) -> None:
    still = at_azimuth(draws[0].astype(np.float32), np.full(draws.shape[-1], 2 * np.pi * 3 / NODES))
    for ring in range(len(RADIUS)):
        np.testing.assert_allclose(still[:, ring], at_node(draws, ring, 3)[0], atol=1e-5)


def test_turning_once_more_changes_nothing(draws: np.ndarray) -> None:
    psi = 0.4 + 1.7 * np.arange(draws.shape[-1]) / RATE
    coefficients = draws[0].astype(np.float32)
    np.testing.assert_allclose(
        at_azimuth(coefficients, psi), at_azimuth(coefficients, psi + 2.0 * np.pi), atol=1e-5
    )


def test_turning_moves_energy_from_slow_gusts_to_the_rotor_frequency(draws: np.ndarray) -> None:
    """Rotational sampling: a blade cuts the same eddy once a turn; total variance is kept."""
    turns = 0.25  # Hz, a line of the record
    psi = 2.0 * np.pi * turns * np.arange(draws.shape[-1]) / RATE
    blade = np.stack([at_azimuth(d.astype(np.float32), psi)[:, 2] for d in draws])
    still = at_node(draws, 2, 0)
    assert blade.var() == pytest.approx(still.var(), rel=0.05)
    frequency = np.fft.rfftfreq(blade.shape[1], 1.0 / RATE)
    line = int(np.argmin(np.abs(frequency - turns)))
    power_blade = (np.abs(np.fft.rfft(blade)) ** 2).mean(axis=0)
    power_still = (np.abs(np.fft.rfft(still)) ** 2).mean(axis=0)
    # The line itself is empty: a coefficient has no mean.  Its neighbours hold the slowest gusts.
    beside = [line - 1, line + 1]
    assert power_blade[beside].mean() > 5.0 * power_still[beside].mean()
    assert power_blade[1] < power_still[1]


def test_equal_seeds_give_equal_wind_and_others_do_not(disc: DiscTurbulence) -> None:
    first = disc.draw(np.random.default_rng(5))
    np.testing.assert_array_equal(first, disc.draw(np.random.default_rng(5)))
    other = disc.draw(np.random.default_rng(6))
    assert abs(np.corrcoef(first[:, 1].ravel(), other[:, 1].ravel())[0, 1]) < 0.1
