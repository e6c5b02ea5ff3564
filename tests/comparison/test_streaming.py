"""Histories in chunks: the same statistics as whole, whatever the chunks."""

from dataclasses import asdict

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.comparison.comparison import BLOCK, compare, compare_streamed
from fe_drivetrain.comparison.moments import moments

NAMES, UNITS = ("Fy", "My"), ("N", "N m")


def pieces(r, m, size):
    return lambda: ((r[i : i + size], m[i : i + size]) for i in range(0, len(r), size))


def history(mean=1.0, samples=5000, seed=0):
    rng = np.random.default_rng(seed)
    r = mean + rng.standard_normal((samples, 2)) * [1.0, 30.0]
    return r, 1.05 * r + rng.normal(0.0, 0.2, r.shape)


def assert_same(found, whole):
    for name, value in asdict(whole).items():
        if isinstance(value, np.ndarray):
            here = getattr(found, name)
            np.testing.assert_allclose(here, value, rtol=1e-12, atol=1e-14, err_msg=name)
    assert (found.names, found.units, found.samples) == (whole.names, whole.units, whole.samples)


@pytest.mark.parametrize("size", [1, 7, 999, 5000])
@pytest.mark.parametrize("mean", [0.0, 1.0, 1e3])
def test_chunks_change_nothing(mean, size):
    r, m = history(mean, 500 if size == 1 else 5000)
    whole = compare(r[None], m[None], NAMES, UNITS)
    assert_same(compare_streamed(pieces(r, m, size), NAMES, UNITS), whole)


def test_more_than_a_block_at_once():
    r, m = history(samples=2 * BLOCK + 3)
    found = compare_streamed(lambda: [(r, m)], NAMES, UNITS)
    assert_same(found, compare(r[None], m[None], NAMES, UNITS))


def test_settings_are_those_of_compare():
    r, m = history(0.0)
    settings = {"negligible": [0.0, 100.0], "exclude_below": 0.2}
    whole = compare(r[None], m[None], NAMES, UNITS, **settings)
    found = compare_streamed(pieces(r, m, 64), NAMES, UNITS, **settings)
    assert_same(found, whole)
    assert np.isnan(found.correlation[0, 1])
    assert found.excluded_share[0, 0] > 0.1


@pytest.mark.parametrize("level", [0.0, 1e5])
def test_a_constant_has_no_correlation(level):
    """Nor a percentage where it is zero; as whole."""
    r, m = history()
    r[:] = level
    found = compare_streamed(pieces(r, m, 100), NAMES, UNITS)
    assert np.isnan(found.correlation).all()
    assert np.isnan(found.mean_percentage_error).all() == (level == 0.0)
    assert_same(found, compare(r[None], m[None], NAMES, UNITS))
    back = compare_streamed(pieces(m, r, 100), NAMES, UNITS)
    assert np.isnan(back.correlation).all()


def test_a_far_mean_takes_no_digits():
    """Shifted by a power of two, which is exact, the products about the mean stay."""
    rng = np.random.default_rng(3)
    r = np.round(rng.standard_normal((4000, 1)) * 2**20) / 2**20
    m = np.round(rng.standard_normal((4000, 1)) * 2**20) / 2**20
    far = 2.0**30
    found = []
    for shift in (0.0, far):
        a, b = r + shift, m + shift
        origin = np.array([a[0], b[0], b[0] - a[0]])
        total = moments(a[:1], b[:1], origin)
        for i in range(1, 4000, 97):
            total = total.merged(moments(a[i : i + 97], b[i : i + 97], origin))
        found.append(total)
    np.testing.assert_allclose(found[1].products, found[0].products, rtol=1e-13, atol=1e-10)
    assert found[1].mean[0, 0] == pytest.approx(far + found[0].mean[0, 0], rel=1e-15)


def test_merging_does_not_care_about_the_order():
    r, m = history(10.0)
    a, b = moments(r[:700], m[:700]), moments(r[700:], m[700:])
    for one, other in ((a.merged(b), b.merged(a)), (a.merged(b), moments(r, m))):
        for name, value in asdict(one).items():
            np.testing.assert_allclose(getattr(other, name), value, rtol=1e-12, err_msg=name)


@pytest.mark.parametrize(
    ("chunks", "says"),
    [
        (lambda: [], "histories of 0 samples"),
        (lambda: [(np.ones((1, 2)), np.ones((1, 2)))], "histories of 1 samples"),
        (lambda: [(np.ones((5, 2)), np.ones((4, 2)))], r"\(samples, 2\)"),
        (lambda: [(np.ones(5), np.ones(5))], r"\(samples, 2\)"),
        (
            lambda: [(np.ones((5, 2)),) * 2, (np.full((5, 2), np.nan), np.ones((5, 2)))],
            "reference holds a value that is not finite in sample 6",
        ),
        (
            lambda: [(np.ones((5, 2)), np.where(np.arange(10).reshape(5, 2) == 5, np.inf, 1.0))],
            "model holds a value that is not finite in sample 3",
        ),
    ],
)
def test_bad_chunks_are_named(chunks, says):
    with pytest.raises(InputError, match=says):
        compare_streamed(chunks, NAMES, UNITS)


def test_bad_calls_are_named():
    r, m = history()
    once = pieces(r, m, 100)()
    with pytest.raises(InputError, match="5000 samples the first time and 0 the second"):
        compare_streamed(lambda: once, NAMES, UNITS)
    with pytest.raises(InputError, match="exclude_below = 1"):
        compare_streamed(pieces(r, m, 100), NAMES, UNITS, exclude_below=1.0)
    with pytest.raises(InputError, match="2 names and 1 units"):
        compare_streamed(pieces(r, m, 100), NAMES, UNITS[:1])
    with pytest.raises(InputError, match="negligible"):
        compare_streamed(pieces(r, m, 100), NAMES, UNITS, negligible=[1.0, 2.0, 3.0])
