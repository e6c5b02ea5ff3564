"""Distributions over levels, statistics and spectra of channels: sums, limits, known signals."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fe_drivetrain.cases.references.published_campaigns import IDENTIFICATION, MONITORING
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.turbine_loads.histories.classes import added, in_classes
from fe_drivetrain.turbine_loads.histories.levels import (
    equivalent_level,
    even_levels,
    revolutions_at_level,
    time_at_level,
    torque_reversals,
)
from fe_drivetrain.turbine_loads.histories.polar import direction
from fe_drivetrain.turbine_loads.histories.spectra import alias, campbell, multiples, spectrum
from fe_drivetrain.turbine_loads.histories.windows import capture_matrix, window_statistics


def test_time_and_turns_at_level_add_up(rng: np.random.Generator) -> None:
    torque, speed = rng.normal(5.0, 1.0, 1000), rng.uniform(-1.0, 2.0, 1000)
    edges = even_levels(torque.min(), torque.max())
    duration = time_at_level(torque, 0.05, edges)
    assert duration.amount.sum() == pytest.approx(50.0)
    assert duration.at_least[0] == pytest.approx(50.0)
    turns = revolutions_at_level(torque, speed, 0.05, edges)
    assert turns.amount.sum() == pytest.approx(np.abs(speed).sum() * 0.05 / (2 * np.pi))
    constant = revolutions_at_level(torque, 2.0 * np.pi, 0.05, edges)
    np.testing.assert_allclose(constant.amount, duration.amount)
    both = duration + duration
    np.testing.assert_allclose(both.amount, 2.0 * duration.amount)
    # a transient of 30 ms adds exactly its time
    extended = time_at_level([*torque, torque.max()], 0.05, edges)
    assert (extended.amount - duration.amount)[-1] == pytest.approx(0.05)
    for power in (1.0, 3.0, 10.0):
        level = equivalent_level(torque, power)
        assert np.abs(torque).mean() <= level * (1 + 1e-12)
        assert level <= np.abs(torque).max()
        binned = (duration.amount @ np.abs(duration.middles) ** power / 50.0) ** (1 / power)
        assert level == pytest.approx(binned, rel=2e-3)
    with pytest.raises(InputError, match="let them hold every sample"):
        time_at_level(torque, 0.05, [0.0, 1.0])
    with pytest.raises(InputError, match="different limits"):
        duration + time_at_level([0.5], 0.05, [0.0, 1.0])


def test_a_constant_load_is_at_one_level() -> None:
    found = time_at_level(np.full(10, 3.0), 1.0, even_levels(3.0, 3.0, 4))
    assert sorted(found.amount) == [0.0, 0.0, 0.0, 10.0]
    assert equivalent_level([3.0, -3.0], 3.0) == pytest.approx(3.0)
    assert equivalent_level([0.0], 3.0) == 0.0


def test_reversals_of_torque_do_not_count_noise_within_the_band() -> None:
    time = np.arange(0.0, 10.0, 0.01)
    torque = np.cos(2 * np.pi * time)  # crosses zero twice a period
    noisy = torque + 0.09 * np.cos(2 * np.pi * 23.0 * time)
    assert torque_reversals(torque, 0.01).count == 20
    assert torque_reversals(noisy, 0.01).count > 20
    found = torque_reversals(noisy, 0.01, band=0.15)
    assert (found.count, found.band) == (20, 0.15)
    assert found.seconds == pytest.approx(5.0, abs=0.2)
    assert found.least == pytest.approx(-1.09, abs=0.02)
    assert torque_reversals(2.0 + torque, 0.01).seconds == 0.0


def test_windows_hold_every_sample_once(rng: np.random.Generator) -> None:
    time = 60.0 + np.arange(0, 15_001) * 0.1
    samples = rng.standard_normal((len(time), 2)) + time[:, None] / 1e3
    found = window_statistics(time, samples)
    # 1500.1 s: two whole windows, and one of half a length and more
    np.testing.assert_allclose(found.start, [60.0, 660.0, 1260.0])
    np.testing.assert_allclose(found.seconds, [600.0, 600.0, 300.1])
    first = samples[:6000]
    expected = np.stack([first.min(0), first.mean(0), first.max(0), first.std(0)], axis=1)
    np.testing.assert_allclose(found.values[0], expected)
    weights = found.seconds / found.seconds.sum()
    np.testing.assert_allclose(weights @ found.values[:, :, 1], samples.mean(axis=0))
    short = window_statistics(time[:8000], samples[:8000])
    np.testing.assert_allclose(short.seconds, [800.0])
    with pytest.raises(InputError, match="above 0 s"):
        window_statistics(time, samples, 0.0)


def test_the_capture_matrix_of_a_published_campaign() -> None:
    """PROTEST 2010 (ECN-E--10-100), Table 4.10: 440 windows, mean turbulence 9.73 % of the bins."""
    wind, deviation = (
        np.append(of, beyond) for of, beyond in zip(MONITORING.each, (30.0, 3.0), strict=True)
    )
    found = capture_matrix(wind, deviation, *MONITORING.edges)
    assert found.counts.tolist() == [list(row) for row in MONITORING.counts]
    assert found.counts.sum(axis=0).tolist() == [3, 54, 88, 96, 101, 89, 9]
    assert found.outside == 1
    assert found.mean_turbulence == pytest.approx(0.0973, abs=5e-5)
    assert found.missing(10)[0].tolist() == [10, 10, 5, 3, 3, 0, 8]


def test_the_matrix_of_files_used_for_inertia_has_another_mean_than_printed() -> None:
    """PROTEST 2010, Fig. 4-14: 66 windows; 3.20 % is printed, the bins have 7.30 %."""
    found = capture_matrix(*IDENTIFICATION.each, *IDENTIFICATION.edges)
    assert found.counts.tolist() == [list(row) for row in IDENTIFICATION.counts]
    assert found.counts.sum(axis=0).tolist() == [6, 11, 15, 13, 20, 1]
    assert found.mean_turbulence == pytest.approx(0.0730, abs=5e-5)


def test_directions_are_seen_looking_downwind() -> None:
    """Weight points down, 270 deg; the moment of an overhung weight (My < 0) points right, 0."""
    assert np.degrees(direction([0.0], [-1.0])) == pytest.approx([270.0])
    assert np.degrees(direction([-1.0], [0.0])) == pytest.approx([0.0])
    assert np.degrees(direction([1.0], [0.0])) == pytest.approx([180.0])


def test_sines_are_found_at_their_multiples_with_their_amplitudes() -> None:
    step, speed = 0.05, 2.0 * np.pi * 0.2  # 1P at 0.2 Hz
    time = np.arange(0, 600, step)
    amplitudes = {1: 3.0, 3: 10.0, 6: 2.0}
    signal = 5.0 + sum(a * np.sin(n * speed * time + n) for n, a in amplitudes.items())
    found = spectrum(signal, step)
    assert found.segments == 19
    # Parseval: the integral is the variance
    assert found.density.sum() * found.spacing == pytest.approx(np.var(signal), rel=1e-6)
    rows = {row.name: row for row in multiples(found, speed)}
    for number, amplitude in amplitudes.items():
        assert rows[f"{number}P"].amplitude == pytest.approx(amplitude, rel=1e-6)
        assert rows[f"{number}P"].appears_at == pytest.approx(rows[f"{number}P"].frequency)
    assert rows["9P"].amplitude == pytest.approx(0.0, abs=1e-6)


def test_what_is_sampled_too_slowly_is_named_with_where_it_appears() -> None:
    step, speed = 0.5, 2.0 * np.pi * 0.2  # half the sampling rate is 1 Hz, 6P is 1.2 Hz
    time = np.arange(0, 600, step)
    found = spectrum(np.sin(6 * speed * time), step)
    six = multiples(found, speed, [6])[0]
    assert six.amplitude is None
    assert six.appears_at == pytest.approx(0.8)
    assert found.frequency[np.argmax(found.density)] == pytest.approx(0.8)
    assert alias(0.3, step) == pytest.approx(0.3)
    with pytest.raises(InputError, match="needs 8"):
        spectrum(time[:5], step)


def test_a_line_of_the_campbell_diagram_follows_the_speed(rng: np.random.Generator) -> None:
    step, length = 0.05, 4000
    time = np.arange(length) * step
    parts = []
    for hertz in (0.1, 0.2, 0.3):
        signal = np.sin(3 * 2 * np.pi * hertz * time) + 0.01 * rng.standard_normal(length)
        parts.append((signal, np.full(length, 2 * np.pi * hertz), step))
    parts.append((parts[0][0][::2], parts[0][1][::2], 2 * step))  # another step
    found = campbell(parts, 2 * np.pi * np.array([0.05, 0.15, 0.25, 0.35, 0.45]), segment=40.0)
    assert found.segments.tolist() == [18, 9, 9, 0]
    peaks = found.frequency[np.argmax(found.density[:3], axis=1)]
    np.testing.assert_allclose(peaks, [0.3, 0.6, 0.9])
    assert np.isnan(found.density[3]).all()
    assert found.frequency[-1] == pytest.approx(5.0)
    with pytest.raises(InputError, match="no history holds a segment of 500 s"):
        campbell(parts, [0.0, 10.0], segment=500.0)


@given(
    st.lists(
        st.lists(st.floats(-1e9, 1e9, width=32), min_size=1, max_size=20), min_size=1, max_size=5
    )
)
def test_classes_of_many_histories_add_up_exactly(histories: list[list[float]]) -> None:
    parts = [in_classes(h, np.square(h), weights=np.ones(len(h))) for h in histories]
    found = added(parts)
    assert found.amount.sum() == sum(map(len, histories))
    values = np.concatenate([np.asarray(h) for h in histories])
    # no sample has left its class, whatever the order
    expected, _, _ = np.histogram2d(values, values**2, bins=[found.edges(0), found.edges(1)])
    np.testing.assert_array_equal(found.amount, expected)
    np.testing.assert_array_equal(added(parts[::-1]).amount, found.amount)
    assert max(found.amount.shape) <= 1024
    widest = max(np.ptp(h) or np.abs(h).max() for h in histories)
    assert np.diff(found.edges()).max() <= max(widest / 64, 2 * np.ptp(values) / 1022, 2.0**-60)
