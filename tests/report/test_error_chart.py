"""Charts of differences: each value stands where it is from its reference, over what is allowed."""

import pytest

from fe_drivetrain.report.answer import KeyFigure
from fe_drivetrain.report.charts import bars, mark_events
from fe_drivetrain.report.error_chart import Difference, difference_chart, error_chart


def test_differences_stand_over_what_is_allowed() -> None:
    shown = [Difference("a", 0.3, allowed=0.05), Difference("b", -0.2, band=0.1, allowed=0.4)]
    allowed, points = difference_chart("c", shown, "computed less printed [Hz]").figure["data"]
    assert (allowed["base"], allowed["x"]) == ([-0.05, -0.4], [0.1, 0.8])
    assert (points["x"], points["y"]) == ([0.3, -0.2], ["a", "b"])
    assert points["error_x"]["array"] == [0.0, 0.1]
    assert [one.share for one in shown] == pytest.approx([6.0, 0.5])


def test_key_figures_are_compared_in_percent_of_their_reference() -> None:
    figures = [
        KeyFigure(name="f", value=-1.98, unit="Hz", bound="beside", limit=-2.0, status="none"),
        KeyFigure(name="unasked", value=1.0, unit="Hz", status="none"),
    ]
    (points,) = error_chart("c", figures).figure["data"]
    assert points["y"] == ["f"]
    assert points["x"] == pytest.approx([1.0])


def test_names_of_events_stand_above_bars_which_would_hide_them() -> None:
    item = mark_events(bars("b", {"ours": {"a": 1.0}}, "s"), {"limit": 0.5})
    (name,) = item.figure["layout"]["annotations"]
    assert (name["yanchor"], name["y"]) == ("bottom", 1)
    assert "textangle" not in name
