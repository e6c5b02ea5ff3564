"""Times of several runs."""

import pytest

from fe_drivetrain.common.timing import Times, timed_runs


def test_each_run_counts_and_the_last_result_is_kept():
    ticks = iter([0.0, 3.0, 10.0, 11.0, 20.0, 22.0])
    made = iter("abc")
    found, times = timed_runs(lambda: next(made), 3, clock=lambda: next(ticks))
    assert found == "c"
    assert times.seconds == (3.0, 1.0, 2.0)
    assert (times.least, times.median, times.most) == (1.0, 2.0, 3.0)


def test_columns_of_a_table_have_their_unit():
    times = Times((0.002, 0.001, 0.004))
    assert times.columns("solve", "ms") == pytest.approx(
        {"solve, least [ms]": 1.0, "solve, median [ms]": 2.0, "solve, most [ms]": 4.0}
    )
    assert list(times.columns()) == ["least [s]", "median [s]", "most [s]"]
