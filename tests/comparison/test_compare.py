import warnings

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.comparison import statistics as cp
from fe_drivetrain.comparison.comparison import compare

NAMES, UNITS = ("Fy", "Fz", "My", "Mz"), ("N", "N", "N m", "N m")


@pytest.fixture(scope="module")
def signal():
    return np.random.default_rng(11).normal(3.0, 1.0, (5, 400))


@pytest.fixture(autouse=True)
def _no_warnings():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        yield


def test_resultant_is_pythagoras():
    assert cp.resultant([3.0, -5.0], [4.0, 12.0]) == pytest.approx([5.0, 13.0])


def test_a_perfect_model(signal):
    assert cp.rmse(signal, signal) == pytest.approx(np.zeros(5), abs=0.0)
    assert cp.bias(signal, signal) == pytest.approx(np.zeros(5), abs=0.0)
    assert cp.relative_scatter(signal, signal) == pytest.approx(np.zeros(5), abs=0.0)
    assert cp.relative_error(signal, signal) == pytest.approx(np.zeros(5), abs=0.0)
    assert cp.mean_percentage_error(signal, signal) == pytest.approx(np.zeros(5), abs=0.0)
    assert cp.correlation(signal, signal) == pytest.approx(np.ones(5), abs=1e-14)
    slope, cov = cp.model_uncertainty(signal, signal)
    assert slope == pytest.approx(np.ones(5), abs=1e-14)
    assert cov == pytest.approx(np.zeros(5), abs=1e-14)


def test_a_constant_offset(signal):
    model = signal - 0.25
    assert cp.rmse(signal, model) == pytest.approx(np.full(5, 0.25), rel=1e-12)
    assert cp.bias(signal, model) == pytest.approx(np.full(5, -0.25), rel=1e-12)
    assert cp.relative_scatter(signal, model) == pytest.approx(np.zeros(5), abs=1e-14)
    assert cp.correlation(signal, model) == pytest.approx(np.ones(5), abs=1e-13)


@pytest.mark.parametrize("factor", [1.02, 0.5, -2.0])
def test_a_constant_factor(signal, factor):
    model = factor * signal
    wrong = abs(factor - 1.0)
    assert cp.relative_error(signal, model) == pytest.approx(np.full(5, wrong), rel=1e-12)
    assert cp.mean_percentage_error(signal, model, 0.0) == pytest.approx(
        np.full(5, 100 * wrong), rel=1e-10
    )
    assert cp.correlation(signal, model) == pytest.approx(np.full(5, np.sign(factor)), abs=1e-13)
    slope, cov = cp.model_uncertainty(signal, model)
    assert slope == pytest.approx(np.full(5, 1.0 / factor), rel=1e-13)
    assert cov == pytest.approx(np.zeros(5), abs=1e-14)


def test_sines_with_a_phase_shift():
    # Over whole periods: correlation cos(phi), rmse a sqrt(1 - cos(phi)), mean |sin| = 2/pi.
    t = 2 * np.pi * np.arange(20000) / 20000 * 5
    phi, a = 0.4, 7.0
    r, m = a * np.sin(t), a * np.sin(t + phi)
    assert cp.correlation(r, m) == pytest.approx(np.cos(phi), rel=1e-12)
    assert cp.rmse(r, m) == pytest.approx(a * np.sqrt(1 - np.cos(phi)), rel=1e-12)
    assert cp.bias(r, m) == pytest.approx(0.0, abs=1e-12)
    # |difference| is a sine too, of amplitude 2 a sin(phi/2).
    assert cp.relative_error(r, m) == pytest.approx(2 * np.sin(phi / 2), rel=1e-6)
    scatter = np.sqrt(2 * (1 - np.cos(phi))) * np.sqrt(20000 / 19999)
    assert cp.relative_scatter(r, m) == pytest.approx(scatter, rel=1e-12)
    # r = cos(phi) m - a sin(phi) cos(t + phi), the last part orthogonal to m.
    slope, cov = cp.model_uncertainty(r, m)
    assert slope == pytest.approx(np.cos(phi), rel=1e-12)
    assert cov == pytest.approx(np.tan(phi) * np.sqrt(20000 / 19999), rel=1e-12)


def test_bias_and_scatter_make_up_the_rmse(signal):
    model = 0.9 * signal + np.random.default_rng(2).normal(0, 0.2, signal.shape)
    spread = cp.relative_scatter(signal, model) * np.sqrt((signal**2).mean(axis=-1))
    spread = spread * np.sqrt(399 / 400)
    assert cp.rmse(signal, model) ** 2 == pytest.approx(
        cp.bias(signal, model) ** 2 + spread**2, rel=1e-12
    )


def test_model_uncertainty_of_a_constant_model_is_mean_and_cov_of_the_ratio(signal):
    model = np.full(signal.shape, 2.0)
    ratio = signal / model
    slope, cov = cp.model_uncertainty(signal, model)
    assert slope == pytest.approx(ratio.mean(axis=-1), rel=1e-12)
    assert cov == pytest.approx(ratio.std(axis=-1, ddof=1) / ratio.mean(axis=-1), rel=1e-12)


def test_units_change_nothing_that_has_none(signal):
    model = signal + np.random.default_rng(4).normal(0, 0.1, signal.shape)
    for statistic in (
        cp.relative_scatter,
        cp.relative_error,
        cp.mean_percentage_error,
        cp.correlation,
    ):
        assert statistic(1e6 * signal, 1e6 * model) == pytest.approx(
            statistic(signal, model), rel=1e-11
        )
    assert cp.rmse(1e6 * signal, 1e6 * model) == pytest.approx(1e6 * cp.rmse(signal, model))


def test_percentage_error_leaves_out_zero_crossings_and_says_how_many():
    # 100 N with 1 % error, and one crossing at 0.01 N where the error is 1e4 %.
    r = np.full(100, 100.0)
    m = 1.01 * r
    r[40], m[40] = 0.01, 1.01
    assert cp.mean_percentage_error(r, m) == pytest.approx(1.0, rel=1e-12)
    assert cp.excluded_share(r) == pytest.approx(0.01, rel=1e-12)
    assert cp.mean_percentage_error(r, m, 0.0) == pytest.approx((99 + 1e4) / 100, rel=1e-12)
    assert cp.excluded_share(r, 0.0) == 0.0
    # The robust one hardly notices: each of the 100 samples is 1 N wrong.
    assert cp.relative_error(r, m) == pytest.approx(100 / (99 * 100 + 0.01), rel=1e-12)


def test_exact_zero_is_left_out_even_when_nothing_else_is():
    assert cp.mean_percentage_error([0.0, 2.0], [5.0, 3.0], 0.0) == pytest.approx(50.0)


def test_undefined_is_nan_and_nothing_else_is():
    zero, varying = np.zeros(4), np.array([1.0, -2.0, 3.0, -1.0])
    constant = np.full(4, 0.1)
    for a, b in ((constant, varying), (varying, constant), (constant, constant)):
        assert np.isnan(cp.correlation(a, b))
    # A constant offset by rounding only is still constant.
    assert np.isnan(cp.correlation(varying, constant + np.array([0, 1e-17, 0, 1e-17])))
    for statistic in (cp.relative_scatter, cp.relative_error, cp.mean_percentage_error):
        assert np.isnan(statistic(zero, varying))
        assert np.isfinite(statistic(varying, zero))
    assert np.isfinite(cp.rmse(zero, varying))
    assert np.isnan(cp.model_uncertainty(varying, zero)).all()
    # A reference of zero has slope 0, and no coefficient of variation.
    slope, cov = cp.model_uncertainty(zero, varying)
    assert slope == 0.0
    assert np.isnan(cov)
    orthogonal = cp.model_uncertainty([1.0, 1.0, 1.0, 1.0], [1.0, -1.0, 1.0, -1.0])
    assert orthogonal[0] == pytest.approx(0.0, abs=1e-15)
    assert np.isnan(orthogonal[1])


def test_only_the_constant_row_is_nan(signal):
    model = signal.copy()
    model[2] = 5.0
    assert np.flatnonzero(np.isnan(cp.correlation(signal, model))).tolist() == [2]


def test_inputs_are_left_alone(signal):
    before = signal.copy()
    cp.correlation(signal, signal)
    cp.mean_percentage_error(signal, signal)
    assert np.array_equal(signal, before)


def test_by_group_is_mean_and_sample_deviation_of_each_group():
    values = np.array([[1.0, 10.0], [5.0, 0.0], [3.0, 20.0], [9.0, 0.0], [2.0, 30.0]])
    groups = [
        (10, "low", 0.2),
        (12, "low", 0.2),
        (10, "low", 0.2),
        (12, "low", 0.2),
        (10, "low", 0.2),
    ]
    out = cp.by_group(values, groups)
    assert out.groups == ((10, "low", 0.2), (12, "low", 0.2))
    assert out.count.tolist() == [3, 2]
    assert out.mean == pytest.approx(np.array([[2.0, 20.0], [7.0, 0.0]]))
    # Deviations -1, 0, 1 over n - 1 = 2.
    assert out.std == pytest.approx(np.array([[1.0, 10.0], [np.sqrt(8.0), 0.0]]))


def test_by_group_of_scalars_and_order_of_histories(signal):
    values = np.arange(12.0) ** 2
    groups = np.repeat(["a", "b"], 6)
    first = cp.by_group(values, groups)
    shuffled = np.random.default_rng(0).permutation(12)
    second = cp.by_group(values[shuffled], groups[shuffled])
    order = [second.groups.index(label) for label in first.groups]
    assert second.mean[order] == pytest.approx(first.mean, rel=1e-14)
    assert second.std[order] == pytest.approx(first.std, rel=1e-14)


def test_compare_is_every_statistic_of_every_history_and_quantity():
    rng = np.random.default_rng(8)
    r = rng.normal(1.0, 1.0, (3, 50, 4))
    m = 1.1 * r + rng.normal(0.0, 0.1, r.shape)
    out = compare(r, m, NAMES, UNITS)
    assert (out.names, out.units, out.samples) == (NAMES, UNITS, 50)
    a, b = np.moveaxis(r, 1, -1), np.moveaxis(m, 1, -1)
    slope, cov = cp.model_uncertainty(a, b)
    for name, expected in {
        "reference_rms": np.sqrt((a**2).mean(axis=-1)),
        "rmse": cp.rmse(a, b),
        "bias": cp.bias(a, b),
        "relative_scatter": cp.relative_scatter(a, b),
        "relative_error": cp.relative_error(a, b),
        "mean_percentage_error": cp.mean_percentage_error(a, b),
        "excluded_share": cp.excluded_share(a),
        "correlation": cp.correlation(a, b),
        "slope": slope,
        "cov": cov,
    }.items():
        assert getattr(out, name).shape == (3, 4)
        assert getattr(out, name) == pytest.approx(expected, rel=1e-12, abs=1e-15), name
    assert out.index("My") == 2
    with pytest.raises(InputError, match="choose one of Fy, Fz, My, Mz"):
        out.index("Mx")


def test_negligible_reference_counts_as_zero_in_its_quantity_only():
    # A spherical bearing: forces of 1e5 N, moments of rounding size against a model of zero.
    rng = np.random.default_rng(1)
    r = rng.normal(1.0, 1.0, (2, 30, 2)) * [1e5, 1e-6]
    m = r * [1.01, 0.0]
    out = compare(r, m, ["Fz", "My"], ["N", "N m"], negligible=[0.0, 1.0])
    for name in ("relative_scatter", "relative_error", "mean_percentage_error", "slope", "cov"):
        assert np.isnan(getattr(out, name)[:, 1]).all()
        assert np.isfinite(getattr(out, name)[:, 0]).all()
    assert np.isnan(out.correlation[:, 1]).all()
    assert np.isfinite(out.rmse).all()


def test_a_reference_of_zero_is_undefined_without_being_told():
    r = np.zeros((1, 4, 1))
    out = compare(r, r + np.array([1.0, -1.0, 2.0, 0.0])[:, None], ["My"], ["N m"])
    for name in ("relative_error", "mean_percentage_error", "correlation", "slope", "cov"):
        assert np.isnan(getattr(out, name)).all()
    assert out.rmse == pytest.approx(np.sqrt(1.5))
    assert out.excluded_share == pytest.approx(1.0)


def test_numpy_agrees_on_correlation(signal):
    model = signal[::-1] + 0.3 * signal
    expected = [np.corrcoef(a, b)[0, 1] for a, b in zip(signal, model, strict=True)]
    assert cp.correlation(signal, model) == pytest.approx(expected, rel=1e-12)


def test_statistics_at_once_are_those_one_by_one_to_the_last_digit(signal):
    model = 1.1 * signal[::-1] - 0.7
    at_once = cp.errors_at_once(signal - 3.0, model, 0.2)
    pair = signal - 3.0, model
    assert (at_once.excluded_share > 0.0).all()
    np.testing.assert_array_equal(
        at_once.mean_percentage_error, cp.mean_percentage_error(*pair, 0.2)
    )
    np.testing.assert_array_equal(at_once.relative_error, cp.relative_error(*pair))
    np.testing.assert_array_equal(at_once.correlation, cp.correlation(*pair))
    np.testing.assert_array_equal(at_once.excluded_share, cp.excluded_share(pair[0], 0.2))


def test_correlation_survives_a_large_mean():
    # A mean a hundred million times the variation: raw sums of squares would lose it all.
    t = np.linspace(0.0, 1.0, 1000)
    wave = np.sin(20 * t)
    assert cp.correlation(1e8 + wave, 1e8 - wave) == pytest.approx(-1.0, abs=1e-9)


def test_median_error_does_not_feel_outliers():
    """A minority of samples, however wrong, leaves it within the differences of the others."""
    rng = np.random.default_rng(2)
    r = rng.standard_normal(1001)
    error = rng.uniform(0.1, 0.3, 1001) * np.where(rng.random(1001) < 0.5, -1.0, 1.0)
    clean = cp.median_error(r, r + error)
    assert clean == pytest.approx(np.sort(np.abs(error))[500], rel=1e-12)
    error[:400] = 1e9
    assert 0.1 <= cp.median_error(r, r + error) <= 0.3
    assert cp.rmse(r, r + error) > 1e8


STATISTICS = (
    cp.rmse,
    cp.median_error,
    cp.bias,
    cp.relative_scatter,
    cp.relative_error,
    cp.mean_percentage_error,
    cp.correlation,
    cp.model_uncertainty,
)


@pytest.mark.parametrize("statistic", STATISTICS)
@pytest.mark.parametrize(
    ("r", "m", "says"),
    [
        (np.ones((2, 5)), np.ones(5), "one shape"),
        (np.ones(5), np.ones(4), "one shape"),
        (np.ones(1), np.ones(1), "at least 2"),
        (np.ones((3, 0)), np.ones((3, 0)), "at least 2"),
        (1.0, 1.0, "one shape"),
        ([1.0, np.nan], [1.0, 2.0], "reference holds"),
        ([1.0, 2.0], [1.0, np.inf], "model holds"),
    ],
)
def test_bad_histories_are_named(statistic, r, m, says):
    with pytest.raises(InputError, match=says):
        statistic(r, m)


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda: cp.mean_percentage_error([1.0, 2.0], [1.0, 2.0], 1.0), "exclude_below = 1"),
        (lambda: cp.mean_percentage_error([1.0, 2.0], [1.0, 2.0], -0.1), "exclude_below = -0.1"),
        (lambda: cp.by_group([1.0, 2.0], ["a"]), "one label"),
        (lambda: cp.by_group([1.0, 2.0, 3.0], ["a", "a", "b"]), "'b' has 1 history"),
        (lambda: cp.by_group([1.0, np.nan], ["a", "a"]), "undefined"),
        (lambda: cp.by_group(1.0, []), "one label"),
        (lambda: cp.by_group([], []), "at least 1"),
        (lambda: compare(np.ones((5, 4)), np.ones((5, 4)), NAMES, UNITS), "histories, samples"),
        (
            lambda: compare(np.ones((1, 5, 4)), np.ones((1, 5, 3)), NAMES, UNITS),
            "histories, samples",
        ),
        (lambda: compare(np.ones((1, 5, 4)), np.ones((1, 5, 4)), NAMES[:3], UNITS), "3 names"),
        (
            lambda: compare(np.ones((1, 5, 4)), np.ones((1, 5, 4)), NAMES, UNITS, [1.0, 2.0]),
            "negligible",
        ),
        (lambda: compare(np.ones((1, 1, 4)), np.ones((1, 1, 4)), NAMES, UNITS), "at least 2"),
        (lambda: compare(np.ones((0, 5, 4)), np.ones((0, 5, 4)), NAMES, UNITS), "at least 1"),
        (
            lambda: compare(np.full((1, 5, 4), np.nan), np.ones((1, 5, 4)), NAMES, UNITS),
            "reference holds",
        ),
    ],
)
def test_bad_calls_are_named(call, says):
    with pytest.raises(InputError, match=says):
        call()
