"""Charts with spread and with events: every point and line stands where its numbers say."""

import math

import pytest

from fe_drivetrain.report.charts import bars, chart, error_bars, mark_events, trace


def test_error_bars_reach_from_the_least_to_the_most() -> None:
    bar = error_bars("y", [1.0, 2.0], [3.0, 2.0], [4.0, 7.0])["error_y"]
    assert (bar["arrayminus"], bar["array"]) == ([2.0, 0.0], [1.0, 5.0])
    # a median of sums may lie outside what the runs are between
    bar = error_bars("x", [2.0], [1.0], [0.5])["error_x"]
    assert (bar["arrayminus"], bar["array"]) == ([0.0], [0.0])


def test_bars_show_how_far_their_values_spread() -> None:
    ends = {"ours": {"a": (0.5, 2.0)}}
    item = bars("times", {"ours": {"a": 1.0, "b": 3.0}, "theirs": {"a": 2.0}}, "s", ends=ends)
    ours, theirs = item.figure["data"]
    assert ours["error_x"]["arrayminus"] == [0.5, 0.0]
    assert ours["error_x"]["array"] == [1.0, 0.0]
    assert "error_x" not in theirs


@pytest.mark.parametrize(("logarithmic", "place"), [("", 100.0), ("x", 2.0)])
def test_an_event_has_a_line_and_its_name_at_its_place(logarithmic: str, place: float) -> None:
    plain = chart("c", [trace("t", [1.0, 1e3], [0.0, 1.0])], "x", "y", logarithmic, (10.0, 20.0))
    item = mark_events(plain, {"stop": 100.0})
    shaded, line = item.figure["layout"]["shapes"]
    assert (line["x0"], line["x1"]) == (100.0, 100.0)
    (name,) = item.figure["layout"]["annotations"]
    assert (name["text"], name["x"]) == ("stop", pytest.approx(place))
    assert shaded["x0"] == 10.0
    # the chart that was given stays as it was
    assert len(plain.figure["layout"]["shapes"]) == 1
    assert math.isclose(item.figure["data"][0]["x"][1], 1e3)
