"""Errors of models by measure: a scaled model, a shifted one, one that misses a peak."""

import numpy as np
import pytest

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.studies.design_measures import _larger, failure, sentence
from fe_drivetrain.turbine_loads.histories.model_errors import (
    damage_ratio,
    good_enough_for,
    measured,
    model_errors,
)


@pytest.fixture
def histories(rng: np.random.Generator) -> list[Floats]:
    return [10.0 + rng.standard_normal(n) for n in (500, 300)]


def test_a_scaled_model_has_its_scale_in_every_measure(histories: list[Floats]) -> None:
    reference = measured(histories, [0.1, 0.1])
    found = model_errors(measured([1.02 * h for h in histories], [0.1, 0.1]), reference)
    for name in ("mean", "extreme", "load duration", "DEL, m = 3", "DEL, m = 10"):
        assert found[name] == pytest.approx(0.02), name
    assert damage_ratio(found["DEL, m = 10"], 10.0) == pytest.approx(1.02**10)
    exact = model_errors(reference, reference)
    assert set(exact.values()) == {0.0}


def test_a_shift_changes_means_and_not_ranges(histories: list[Floats]) -> None:
    """Histories of unequal steps, so that samples have unequal weights."""
    steps = [0.1, 0.3]
    reference = measured(histories, steps)
    found = model_errors(measured([h + 1.0 for h in histories], steps), reference)
    assert found["mean"] == pytest.approx(1.0 / reference.mean)
    assert found["load duration"] == pytest.approx(found["mean"])
    assert found["DEL, m = 4"] == pytest.approx(0.0, abs=1e-12)


def test_a_delay_is_no_error_of_any_measure_and_a_lost_peak_is(histories: list[Floats]) -> None:
    one = np.concatenate([histories[0], [30.0], histories[1]])
    reference = measured([one], [0.1])
    turned = model_errors(measured([one[::-1]], [0.1]), reference)
    assert max(map(abs, turned.values())) < 1e-12
    without = model_errors(measured([np.minimum(one, 15.0)], [0.1]), reference)
    assert without["extreme"] == pytest.approx(-0.5)
    assert abs(without["mean"]) < 0.01
    assert without["DEL, m = 10"] < -0.3


def test_a_model_may_be_good_enough_for_one_use_and_not_for_another() -> None:
    errors = {
        "cheap": {"mean": 0.01, "extreme": -0.2, "DEL, m = 3": 0.04, "DEL, m = 10": 0.06},
        "better": {"mean": 0.001, "extreme": 0.04, "DEL, m = 3": 0.01, "DEL, m = 10": 0.02},
    }
    errors["cheap"]["load duration"] = 0.1
    assert good_enough_for(errors, 0.05) == {
        "means": "cheap",
        "load durations": "better",
        "extremes": "better",
        "fatigue": "better",
    }
    assert good_enough_for(errors, 0.01)["extremes"] is None


def test_a_load_that_never_changes_has_no_ratio_of_ranges() -> None:
    flat = measured([np.full(10, 3.0)], [0.1])
    found = model_errors(flat, flat)
    assert found["mean"] == 0.0
    assert np.isnan(found["DEL, m = 3"])


def test_samples_count_by_the_time_that_they_last() -> None:
    found = measured([np.array([1.0, 3.0]), np.array([10.0, 14.0])], [0.1, 0.4])
    assert found.weights.sum() == pytest.approx(1.0)
    assert found.mean == pytest.approx((0.1 * 2.0 * 2.0 + 0.4 * 2.0 * 12.0) / (0.1 * 2 + 0.4 * 2))


def test_the_answer_names_a_level_for_each_use() -> None:
    errors = {
        "1 beam": {"front, Fz": {"DEL, m = 3": 0.2, "DEL, m = 8": -0.4, "mean": 0.5}},
        "2 meridian": {
            "front, Fz": {"DEL, m = 3": 0.1, "DEL, m = 8": float("nan"), "mean": 0.0},
            "rear, My": {"DEL, m = 3": -0.3, "DEL, m = 8": 0.2, "mean": 0.0},
        },
    }
    worst = failure(errors, "fatigue")
    assert worst == "rear, My: -30 % in the DEL, m = 3 at 2 meridian"
    uses = {"means": "1 beam", "extremes": "2 meridian", "fatigue": None}
    found = sentence(uses, {"fatigue": worst}, 0.05)
    assert f"for means 1 beam; for extremes 2 meridian; for fatigue none ({worst})" in found
    none = sentence(dict.fromkeys(uses), dict.fromkeys(uses, worst), 0.05)
    assert "no level below the assembly has the mean, extreme, or" in none


def test_a_level_is_as_wrong_as_the_worse_of_its_bounds() -> None:
    soft, stiff = {"mean": 0.02, "extreme": -0.08, "DEL": np.nan}, {"mean": -0.03, "extreme": 0.01}
    worst = _larger([soft, stiff])
    assert (worst["mean"], worst["extreme"]) == (-0.03, -0.08)
    assert np.isnan(worst["DEL"])
