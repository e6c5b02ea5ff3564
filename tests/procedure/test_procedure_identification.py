"""Identification of a known drivetrain: printed methods fail as theory says, fits do not."""

import re
from pathlib import Path

import numpy as np
import pytest

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.dynamics.torsion.system import Inertia, Torsional, chain, damped_modes, referred
from fe_drivetrain.procedure.decay import logarithmic_decrement
from fe_drivetrain.procedure.identification import (
    Twist,
    least_squares,
    method_a,
    method_b,
    method_c,
    ratio_by_ranges,
    reduced_torque,
    stiffness_by_ranges,
)
from fe_drivetrain.procedure.motions import (
    band_torque,
    driven_motions,
    element_torques,
    periodic_motions,
)
from fe_drivetrain.procedure.sensors import (
    Sensor,
    counted_angle,
    measured,
    sampling_rates,
    scaled_to_power,
    timed_angle,
)
from fe_drivetrain.procedure.spectral_fit import spectral_fit
from fe_drivetrain.turbine_loads.histories.spectra import alias

FRONT, REAR, K, ZETA = 150.34, 24.0, 5296.0, 0.03
REDUCED = FRONT * REAR / (FRONT + REAR)
D = 2 * ZETA * np.sqrt(K * REDUCED)
TRUTH = np.array([REDUCED, D, K])
W0 = np.sqrt(K / REDUCED)
STEP, SAMPLES = 0.005, 20000


@pytest.fixture(scope="module")
def system() -> Torsional:
    parts = Inertia("rotor", FRONT), Inertia("generator", REAR)
    return chain(parts, [("shaft", K, float(D))])


def twists(system: Torsional, driving: Floats, braking: Floats) -> dict[str, Twist]:
    motions = periodic_motions(system, np.stack([driving, -braking]), STEP)
    x = [a[0] - a[1] for a in (motions.angle, motions.speed, motions.acceleration)]
    reduced, _ = reduced_torque(driving, braking, FRONT, REAR)
    torques = {"shaft": element_torques(system, motions)[0], "reduced": reduced, "aero": driving}
    return {name: Twist(STEP, torque, *x) for name, torque in torques.items()}


@pytest.fixture(scope="module")
def broadband(system: Torsional) -> dict[str, Twist]:
    driving = band_torque(SAMPLES, STEP, (0.05, 20.0), 100.0, 1)
    return twists(system, driving, band_torque(SAMPLES, STEP, (0.05, 20.0), 40.0, 2))


@pytest.fixture(scope="module")
def resonance(system: Torsional) -> dict[str, Twist]:
    driving = band_torque(SAMPLES, STEP, (2.5, 2.6), 50.0, 1)
    return twists(system, driving, 0.0 * driving)


def test_motions_obey_newton_for_each_inertia(system: Torsional) -> None:
    torques = np.stack([band_torque(500, STEP, (0.1, 9.0), 10.0, s) for s in (1, 2)])
    m = periodic_motions(system, torques, STEP)
    shaft = element_torques(system, m)[0]
    assert np.abs(FRONT * m.acceleration[0] + shaft - torques[0]).max() < 1e-9
    assert np.abs(REAR * m.acceleration[1] - shaft - torques[1]).max() < 1e-9


def test_power_in_is_dissipation_and_change_of_energy(system: Torsional) -> None:
    torques = np.stack([200.0 + 50.0 * np.sin(np.arange(4001) * 0.01), np.full(4001, -200.0)])
    m = driven_motions(system, torques, 0.001)
    twist, rate = m.angle[0] - m.angle[1], m.speed[0] - m.speed[1]
    energy = 0.5 * (system.J @ m.speed**2 + K * twist**2)
    power = np.einsum("it,it->t", torques, m.speed) - D * rate**2
    assert 0.001 * (power[1:] + power[:-1]).sum() / 2 == pytest.approx(
        energy[-1] - energy[0], rel=1e-5
    )


def test_mean_torques_that_do_not_balance_are_refused(system: Torsional) -> None:
    with pytest.raises(InputError, match="same mean"):
        periodic_motions(system, np.ones((2, 100)), STEP)


@pytest.mark.parametrize("kind", ["broadband", "resonance"])
def test_least_squares_is_exact_without_noise(kind: str, request: pytest.FixtureRequest) -> None:
    of = request.getfixturevalue(kind)
    assert least_squares(of["reduced"]).values == pytest.approx(TRUTH, rel=1e-10)
    shaft = least_squares(of["shaft"]).values
    assert shaft[1:] == pytest.approx(TRUTH[1:], rel=1e-10)
    assert abs(shaft[0]) < 1e-10 * REDUCED


def test_aerodynamic_torque_alone_multiplies_all_by_one_factor(resonance: dict[str, Twist]) -> None:
    assert least_squares(resonance["aero"]).values == pytest.approx(
        FRONT / REDUCED * TRUTH, rel=1e-10
    )


def test_referring_to_the_other_side_multiplies_by_the_ratio_squared(
    broadband: dict[str, Twist], system: Torsional
) -> None:
    n = 81.5
    of = broadband["reduced"]
    low = Twist(STEP, n * of.torque, of.angle / n, of.speed / n, of.acceleration / n)
    assert least_squares(low).values == pytest.approx(n**2 * TRUTH, rel=1e-10)
    on_low = referred(system, {"rotor": n, "generator": n})
    assert on_low.K[0, 0] == pytest.approx(n**2 * K, rel=1e-12)


def test_printed_methods_give_what_one_frequency_makes_of_them(
    resonance: dict[str, Twist],
) -> None:
    shaft, reduced = resonance["shaft"], resonance["reduced"]
    assert np.median(stiffness_by_ranges(shaft)) / K - 1 == pytest.approx(2 * ZETA**2, rel=0.1)
    ratio = float(np.median(ratio_by_ranges(shaft)))
    assert ratio == pytest.approx(1 / W0, rel=0.02)
    # the median of 1 / (1 - tan u) over a turn of u is 1 / 2
    inertia, damping = method_a(shaft, K, ratio).medians()
    assert damping == pytest.approx(D / 2, rel=0.05)
    assert inertia == pytest.approx(ratio * D / 2, rel=0.05)
    assert method_a(reduced, K, ratio).medians()[1] == pytest.approx(
        (D + REDUCED * W0) / 2, rel=0.05
    )


def test_methods_b_and_c_do_not_find_the_truth(broadband: dict[str, Twist]) -> None:
    for of in broadband.values():
        for found in (method_b(of, 2.7), method_c(of, 2.7, K)):
            for plausible in (False, True):
                errors = np.array(found.medians(plausible)) / TRUTH[:2] - 1
                assert not np.abs(errors).max() < 0.5  # NaN where no answer is plausible


def test_one_frequency_is_refused() -> None:
    x = np.sin(2 * np.pi * np.arange(400) / 40)
    v = np.cos(2 * np.pi * np.arange(400) / 40)
    with pytest.raises(InputError, match="one frequency"):
        least_squares(Twist(STEP, x, x, v, -x))


def test_spectral_fit_of_a_record_that_is_no_period(broadband: dict[str, Twist]) -> None:
    of = broadband["reduced"]
    fit = spectral_fit(of.torque[:13000], of.angle[:13000], STEP, (1.0, 5.0))
    assert fit.values == pytest.approx(TRUTH, rel=2e-4)


def test_bands_of_spectral_fits_hold_the_truth_and_those_of_least_squares_do_not(
    broadband: dict[str, Twist],
) -> None:
    of = broadband["reduced"]
    held, biased = [], []
    for seed in range(20):
        noise = np.random.default_rng(seed).standard_normal((3, SAMPLES))
        torque, second = (of.torque + 5.0 * noise[i] for i in (0, 1))
        angle = of.angle + 0.004 * noise[2]
        fit = spectral_fit(torque, angle, STEP, (1.0, 5.0), second)
        held.append(np.abs(fit.values - TRUTH) < fit.bands)
        rate = np.gradient(angle, STEP)
        naive = least_squares(Twist(STEP, torque, angle, rate, np.gradient(rate, STEP)))
        biased.append(np.abs(naive.values - TRUTH) < naive.bands)
    # 19 of 20 of sixty correlated answers
    assert np.mean(held) > 0.85
    assert not np.any(biased)


def test_noise_of_the_torque_without_a_second_record_is_the_bias_that_is_stated(
    broadband: dict[str, Twist],
) -> None:
    of = broadband["reduced"]
    frequency = np.fft.rfftfreq(SAMPLES, STEP)
    band = (frequency >= 1.0) & (frequency <= 5.0)
    found, expected = [], []
    for seed in range(10):
        noise = 40.0 * np.random.default_rng(seed).standard_normal(SAMPLES)
        found.append(spectral_fit(of.torque + noise, of.angle, STEP, (1.0, 5.0)).values / TRUTH)
        noisy, clean = (np.abs(np.fft.rfft(a)[band]) ** 2 for a in (noise, of.torque))
        expected.append(noisy.sum() / clean.sum())
    assert np.mean(found) - 1 == pytest.approx(np.mean(expected), rel=0.25)


def test_decrement_of_a_stop_is_the_modal_damping(system: Torsional) -> None:
    step = 0.002
    time = np.arange(4000) * step
    drive = np.interp(time, [0.0, 1.0, 1.0 + step], [1000.0, 1000.0, 0.0])
    motions = driven_motions(system, np.stack([drive, -drive]), step)
    decay = logarithmic_decrement((motions.angle[0] - motions.angle[1])[520:], step)
    modes = damped_modes(system)
    assert decay.ratio == pytest.approx(modes.ratios[0], rel=1e-4)
    assert decay.frequency == pytest.approx(modes.frequencies[0], rel=1e-5)
    with pytest.raises(InputError, match="two are needed"):
        logarithmic_decrement(np.ones(10), step)


def test_peaks_between_samples_have_the_heights_of_their_parabolas() -> None:
    """Some ten samples a period, of which none is at a peak; four peaks, two of them enough."""
    damping, period, step = 0.02, 1.0, 1.0 / 10.37
    rate = 2.0 * np.pi / period
    time = (np.arange(60) + 0.31) * step
    signal = np.exp(-damping * rate * time) * np.cos(rate * time)
    for peaks in (2, 4):
        decay = logarithmic_decrement(signal, step, peaks)
        # the fourth power of the phase between samples that a parabola leaves out, over 24
        left_out = (rate * step) ** 4 / 24.0
        assert decay.decrement == pytest.approx(2.0 * np.pi * damping, abs=left_out)


def test_a_sensor_without_errors_records_the_truth() -> None:
    signal = np.sin(np.arange(100.0))
    assert (measured(Sensor(), signal, 0) == signal).all()
    dull = measured(Sensor(gain=2.0, offset=1.0, resolution=0.5, every=5), signal, 0)
    assert np.abs(dull - (2 * signal + 1)[::5]).max() <= 0.25
    noisy = measured(Sensor(noise=0.1), np.zeros(10000), 3)
    assert noisy.std() == pytest.approx(0.1, rel=0.03)
    with pytest.raises(InputError, match="from 1"):
        Sensor(every=0)


def test_timing_pulses_is_finer_than_counting_them_by_orders() -> None:
    time = np.arange(0.0, 2.0, 1e-3)
    angle = 188.5 * time + 0.05 * np.sin(16.0 * time)
    coarse = counted_angle(angle, 60)
    assert 0.9 * 2 * np.pi / 60 < (angle - coarse).max() <= 2 * np.pi / 60
    inside = time[50:-50:5]
    fine = timed_angle(time, angle, 60, inside)
    assert np.abs(fine - angle[50:-50:5]).max() < 1e-5
    with pytest.raises(InputError, match="turns back"):
        timed_angle(time, -angle, 60, inside)


def test_power_takes_out_a_gain_in_full_and_makes_a_gain_of_an_offset() -> None:
    torque = 1000.0 + band_torque(1000, 0.01, (0.5, 5.0), 100.0, 1)
    speed = np.full(1000, 188.5)
    power = 0.94 * torque * speed
    assert scaled_to_power(0.9 * torque, speed, power, 0.94) == pytest.approx(1 / 0.9, rel=1e-12)
    assert scaled_to_power(torque + 50.0, speed, power, 0.94) == pytest.approx(1 / 1.05, rel=1e-12)
    with pytest.raises(InputError, match="efficiency"):
        scaled_to_power(torque, speed, power, 1.2)


def test_three_to_five_times_the_frequency_does_not_alias() -> None:
    f = 2.546
    assert all(alias(f, 1 / rate) == pytest.approx(f) for rate in sampling_rates(f))
    assert alias(f, 1 / (1.5 * f)) == pytest.approx(0.5 * f)


def test_the_example_of_the_docs_finds_what_it_says() -> None:
    text = (Path(__file__).parents[2] / "docs" / "procedure.md").read_text("utf-8")
    blocks = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    (code,) = (block for block in blocks if "least_squares" in block)
    names: dict[str, object] = {}
    exec(code, names)
    assert names["found"] == pytest.approx([150.0 * 24.0 / 174.0, 20.0, 5300.0], rel=1e-9)


def test_a_band_that_a_record_cannot_have_is_a_sentence() -> None:
    for band in ((3.0, 0.2), (60.0, 80.0), (-1.0, 5.0)):
        with pytest.raises(InputError, match="are no band of a record of 100 Hz"):
            spectral_fit(np.ones(1000), np.ones(1000), 0.01, band)
