"""Load loops: figures whose loops are known, and what must not change them."""

from dataclasses import fields

import numpy as np
import pytest
from numpy.testing import assert_allclose

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.turbine_loads.hub_loads.loops import (
    Loops,
    find_loops,
    loop_statistics,
    time_on_loops,
)


def circle(turns: float, *, rate: float = 20.0, frequency: float = 0.9, radius: float = 1.0):
    """A load that turns round the origin, both ends of the last turn included."""
    t = np.linspace(0.0, turns / frequency, round(turns * rate / frequency) + 1)
    return t, radius * np.exp(2j * np.pi * frequency * t)


def loops_of(t: np.ndarray, z: np.ndarray, **thresholds: float) -> Loops:
    return find_loops(t, z.real, z.imag, **thresholds)


def wander(n: int = 4000, rate: float = 20.0, seed: int = 5) -> tuple[np.ndarray, np.ndarray]:
    """A load as of turbulence at 3P: narrow-band round 0.9 Hz about a slow mean."""
    rng = np.random.default_rng(seed)
    t = np.arange(n) / rate
    f = np.fft.rfftfreq(n, 1 / rate)
    shape = np.exp(-0.5 * ((f - 0.9) / 0.15) ** 2) + 0.5 * np.exp(-f / 0.05)
    x, y = (np.fft.irfft(shape * np.exp(2j * np.pi * rng.random(len(f)))) for _ in range(2))
    return t, x / x.std() + 1j * y / y.std() - 2.0j


def test_a_circle_is_one_loop_with_its_size() -> None:
    t, z = circle(1.0, rate=180.0)
    found = loops_of(t, z)
    assert len(found) == 1
    assert_allclose(found.duration, 1 / 0.9, rtol=1e-9)
    assert_allclose(found.excursion, 2.0, rtol=1e-3)
    assert_allclose(found.area, np.pi, rtol=1e-3)
    assert_allclose(found.swept, 2 * np.pi, rtol=1e-9)
    assert_allclose(found.highest - found.lowest, 0.0, atol=1e-12)
    # the other way round, away from the origin
    (area,) = loops_of(t, np.conj(z) + 5.0).area
    assert_allclose(area, -np.pi, rtol=1e-3)
    away = loops_of(t, z + 5.0)
    assert_allclose([away.lowest[0], away.highest[0]], [4.0, 6.0], rtol=1e-3)
    assert_allclose(away.swept, 2 * np.arcsin(1 / 5), rtol=1e-3)


@pytest.mark.parametrize("start", [0.0, 0.1, 0.25, 0.4, 0.7])
def test_a_figure_of_eight_has_two_loops_wherever_it_begins(start: float) -> None:
    s = 2 * np.pi * (np.linspace(0, 1, 81) + start)
    found = find_loops(np.linspace(0, 1.5, 81), np.sin(2 * s), 2 * np.sin(s))
    assert len(found) == 2
    assert_allclose(np.abs(found.area), 8 / 3, rtol=1e-2)
    assert_allclose(found.area.sum(), 0.0, atol=1e-9)
    assert_allclose(time_on_loops(found), 1.5, rtol=1e-9)


def test_lines_and_points_have_no_loops() -> None:
    t = np.arange(400) / 20.0
    noise = np.random.default_rng(1).normal(size=400)
    for z in (
        np.zeros(400, complex),
        np.full(400, 3.0 - 4.0j),
        np.sin(5.6 * t) * (1 + 0.5j),
        3.0 + np.sin(5.6 * t) + 0.02 * noise * 1j,
        t * (1 + 1j),
    ):
        assert len(loops_of(t, z)) == 0


@pytest.mark.parametrize("rate", [9.0, 20.0, 20.3, 100.0])
def test_turning_at_3p_has_one_loop_a_blade(rate: float) -> None:
    t, z = circle(40.0, rate=rate)
    found = loops_of(t, z)
    # samples that do not repeat leave a rest shorter than a step at the end
    assert 39 <= len(found) <= 40
    numbers = loop_statistics(found, t[-1], 0.9)
    assert_allclose(numbers["median duration [s]"], 1 / 0.9, rtol=1e-3)
    assert_allclose(numbers["rate over 3P"], 1.0, atol=0.03)
    assert_allclose(numbers["share of time"], 1.0, atol=0.03)
    assert_allclose(numbers["median swept angle [deg]"], 360.0, rtol=1e-9)


def test_a_slow_circle_and_a_small_one_are_no_loops() -> None:
    t, z = circle(3.0, frequency=0.4)
    assert len(loops_of(t, z)) == 0
    assert len(loops_of(t, z, longest=2.6)) == 3
    t, z = circle(3.0, rate=18.0)  # the samples of all turns are the same
    assert len(loops_of(t, z + 30.0)) == 0
    assert len(loops_of(t, z + 30.0, excursion=1.0)) == 3
    assert len(loops_of(t, z + 30.0, excursion=3.0)) == 0


def test_a_loop_on_a_loop_is_found_with_it() -> None:
    s = np.linspace(0, 2 * np.pi, 401)
    z = np.exp(1j * s) + 0.5 * np.exp(-5j * s)  # six outer loops on a hexagon
    t = np.linspace(0, 1.8, 401)
    found = loops_of(t, z)
    assert len(found) == 7
    # it begins on an outer loop, which ends when all the others and the hexagon have
    assert_allclose(np.sort(found.duration)[-1], 1.8, rtol=1e-9)
    assert (np.sort(found.duration)[:5] < 0.3).all()
    assert_allclose(time_on_loops(found), 1.8, rtol=1e-9)
    outer = found.area < 0.0
    assert (outer.sum(), (~outer).sum()) == (6, 1)


@pytest.mark.parametrize("angle", [0.3, 1.5, 4.0])
def test_turned_mirrored_scaled_and_reversed_loads_have_the_same_loops(angle: float) -> None:
    t, z = wander()
    found = loops_of(t, z)
    assert len(found) > 50
    for other, scale, sign in (
        (z * np.exp(1j * angle), 1.0, 1.0),
        (np.conj(z), 1.0, -1.0),
        (1e6 * z, 1e6, 1.0),
    ):
        same = loops_of(t, other)
        assert_allclose(same.start, found.start, rtol=0, atol=1e-7)
        assert_allclose(same.end, found.end, rtol=0, atol=1e-7)
        assert_allclose(same.excursion, scale * found.excursion, rtol=1e-6)
        assert_allclose(same.area, sign * scale**2 * found.area, rtol=1e-5)
        assert_allclose(same.swept, found.swept, rtol=1e-6)
    back = loops_of(t, z[::-1])
    assert_allclose(np.sort(t[-1] - back.end), found.start, rtol=0, atol=1e-7)
    assert_allclose(time_on_loops(back), time_on_loops(found), rtol=1e-7)


def test_noise_and_sampling_change_little() -> None:
    t, z = circle(40.0, rate=50.0)
    z = z + 1.5  # magnitude and direction both change
    clean = loop_statistics(loops_of(t, z), t[-1], 0.9)
    noise = np.random.default_rng(2).normal(size=(2, len(t)))
    for level in (0.01, 0.03):
        noisy = z + level * (noise[0] + 1j * noise[1])
        found = loop_statistics(loops_of(t, noisy), t[-1], 0.9)
        for key in ("share of time", "rate over 3P", "median duration [s]"):
            assert_allclose(found[key], clean[key], rtol=0.06)
    t, z = wander()
    # the same band-limited load, sampled three times as often
    spectrum = np.fft.fftshift(np.fft.fft(z))
    fine = 3 * np.fft.ifft(np.fft.ifftshift(np.pad(spectrum, len(z))))
    f = np.arange(len(fine)) / 60.0
    assert_allclose(fine[::3], z, atol=1e-9)
    a, b = (loop_statistics(loops_of(*path), t[-1]) for path in ((t, z), (f, fine)))
    assert_allclose(a["rate [1/s]"], b["rate [1/s]"], rtol=0.05)
    assert_allclose(a["share of time"], b["share of time"], rtol=0.05)


def test_no_loops_have_no_medians() -> None:
    none = Loops(*np.empty((len(fields(Loops)), 0)))
    numbers = loop_statistics(none, 10.0)
    assert numbers["count"] == numbers["share of time"] == 0.0
    assert np.isnan(numbers["median duration [s]"])
    assert "rate over 3P" not in numbers


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: find_loops([0, 1, 2], [0, 1], [0, 1]), "one length"),
        (lambda: find_loops([0, 1, 1], [0, 1, 2], [0, 1, 2]), "does not increase"),
        (lambda: find_loops([0, 1, 2], [0, np.nan, 2], [0, 1, 2]), "no finite number"),
        (lambda: find_loops([0, 1], [0, 1], [0, 1], longest=0.0), "longest is 0 s"),
        (lambda: find_loops([0, 1], [0, 1], [0, 1], excursion=-1.0), "excursion is -1"),
        (lambda: loop_statistics(find_loops([0], [0], [0]), 0.0), "duration is 0 s"),
        (lambda: loop_statistics(find_loops([0], [0], [0]), 1.0, 0.0), "blade_passing is 0"),
    ],
)
def test_mistakes_are_named(make, words: str) -> None:
    with pytest.raises(InputError, match=words):
        make()
