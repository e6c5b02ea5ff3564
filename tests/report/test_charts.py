"""Charts by their rules: events, differences, bands, what is chosen; numbers of tables."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from fe_drivetrain.plots.figures import error_traces
from fe_drivetrain.plots.style import styled
from fe_drivetrain.report.charts import bars, chart, trace
from fe_drivetrain.report.number_text import (
    computed_text,
    error_text,
    expected_text,
    given_text,
    value_with_band,
)
from fe_drivetrain.report.results import Chart, Table, judge
from fe_drivetrain.report.suite.key_figures import key_figure
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.table_text import band_columns, cell_texts


@pytest.mark.parametrize("log", ["", "x"])
def test_names_of_events_that_are_close_stand_side_by_side(log: str) -> None:
    curve = [trace("all", [1.0, 1e3, 1e4], [1.0, 2.0, 3.0])]
    # a hundredth of a decade apart, and of the whole width
    near, far = ({"b": 102.0, "a": 100.0}, 5e3) if log else ({"b": 200.0, "a": 100.0}, 5e3)
    item = chart("c", curve, "t [s]", "F [N]", log, events={**near, "later": far})
    layout = item.figure["layout"]
    assert [one["text"] for one in layout["annotations"]] == ["a<br>b", "later"]
    assert len(layout["shapes"]) == 3


def test_events_are_lines_with_their_names_on_either_kind_of_axis() -> None:
    curve = [trace("force", [1.0, 1000.0], [0.0, 1.0])]
    for log, at in (("", 100.0), ("x", 2.0)):
        layout = chart("c", curve, "t [s]", "F [N]", log, events={"gust": 100.0}).figure["layout"]
        (line,), (name,) = layout["shapes"], layout["annotations"]
        assert (line["x0"], line["x1"], line["yref"]) == (100.0, 100.0, "paper")
        # Plotly takes the logarithm of a label's place, but not of a shape's
        assert (name["text"], name["x"]) == ("gust", pytest.approx(at))


def test_a_strip_shows_by_how_much_curves_differ_that_cover_each_other() -> None:
    x = np.linspace(0.0, 1.0, 5)
    curves = [trace("thesis", x, x**2), trace("ours", x, x**2 + 0.001 * x)]
    points = trace("measured", [0.5], [0.25], points=True)
    figure = chart("c", [*curves, points], "t [s]", "F [kN]", beside="thesis").figure
    *_, strip = figure["data"]
    assert len(figure["data"]) == 4
    assert (strip["name"], strip["yaxis"], strip["showlegend"]) == ("ours", "y2", False)
    assert_allclose(strip["y"], 0.001 * x, atol=1e-12)
    layout = figure["layout"]
    assert layout["yaxis2"]["title"]["text"] == "difference [kN]"
    assert layout["yaxis2"]["domain"][1] < layout["yaxis"]["domain"][0]
    drawn = styled(figure["data"], layout)["data"]
    assert drawn[1]["line"] == drawn[3]["line"]  # the same curve has the same look
    with pytest.raises(ValueError, match="no curve 'other' among 'thesis', 'ours'"):
        chart("c", curves, "t [s]", "F [kN]", beside="other")


def test_axes_show_the_range_that_is_asked_for() -> None:
    curve = [trace("force", [1.0, 1000.0], [1.0, 2.0])]
    layout = chart("c", curve, "t", "F", "x", x_range=(10.0, 100.0), y_range=(0.0, 3.0)).figure[
        "layout"
    ]
    assert layout["xaxis"]["range"] == pytest.approx([1.0, 2.0])
    assert layout["yaxis"]["range"] == [0.0, 3.0]


def test_a_sweep_draws_bands_and_marks_what_is_chosen() -> None:
    page = Page()
    rows = [{"time [s]": 1.0 + k, "error [%]": 2.0 / (1.0 + k), "band": 0.1 * k} for k in range(3)]
    look: Any = {"bands": {"error [%]": "band"}, "chosen": 1, "events": {"deadline": 2.5}}
    page.sweep("Error over time", rows, "time [s]", "error [%]", table=False, **look)
    (shown,) = page.sections[0].items
    assert isinstance(shown, Chart)
    curve, chosen = shown.figure["data"]
    assert_allclose(curve["error_y"]["array"], [0.0, 0.1, 0.2])
    assert (chosen["x"], chosen["y"], chosen["text"]) == ([2.0], [1.0], ["chosen"])
    assert [one["text"] for one in shown.figure["layout"]["annotations"]] == ["deadline"]


def test_errors_over_time_have_bars_down_to_what_a_logarithm_shows() -> None:
    names, times, errors = ["beam", "solid", "none"], [0.1, 10.0, 20.0], [0.1, 0.01, 1.0]
    bands = [0.02, 0.05, np.nan]
    beam, solid, unknown, tolerance = error_traces(names, times, errors, 0.05, 1, bands)
    assert_allclose((beam["error_y"]["array"], beam["error_y"]["arrayminus"]), 2.0)
    assert solid["error_y"]["array"] == [5.0]
    assert solid["error_y"]["arrayminus"][0] < solid["y"][0]
    assert "error_y" not in unknown
    assert "error_y" not in tolerance
    assert [one.get("text") for one in (beam, solid, unknown)] == [None, ["chosen"], None]


TABLE = Table(
    caption="Levels",
    columns=["mesh", "k [MN/m]", "error [%]", "± k [MN/m]", "f [Hz]", "band ± [%]", "n"],
    rows=[
        ["fine", 420.6597929, 1.15440654, 15.6621681, 12.345678, 0.52, 10401],
        ["none", 420.6597929, 1.15440654, None, 12.345678, None, 7.0],
        ["tight", 0.001, 1.0, 0.01, 12.345678, 0.0, None],
    ],
)


def test_values_of_a_table_have_no_digit_beyond_the_band_in_their_row() -> None:
    assert band_columns(TABLE) == {1: 3, 4: 5}
    fine, none, tight = cell_texts(TABLE)
    assert fine == ["fine", "421", "1.154", "16", "12.346", "0.52", "10\u202f401"]
    assert none == ["none", "420.7", "1.154", "–", "12.35", "–", "7"]
    assert tight[1] == "~0"


@pytest.mark.parametrize(
    ("columns", "found"),
    [
        (["a [m]", "b [m]", "± a [m]", "± b [m]"], {0: 2, 1: 3}),
        (["solid", "band ± [%]", "beam [%]"], {0: 1}),
        (["value [N]", "error [%]", "band ± [%]", "time [s]"], {1: 2}),
        (["value [N]", "error [%]", "own error ± [%]"], {0: 2}),
        (["f", "±"], {0: 1}),
        (["±", "f"], {}),
        (["time [s]", "± [m]"], {}),
    ],
)
def test_a_band_belongs_to_the_column_that_it_is_of(
    columns: list[str], found: dict[int, int]
) -> None:
    assert band_columns(Table(caption="c", columns=columns, rows=[[1.5] * len(columns)])) == found


def test_what_was_given_keeps_its_digits_and_what_was_computed_does_not() -> None:
    assert given_text(13.4262) == "13.4262"
    assert given_text(2.31712e9 * 1e-9) == "2.31712"  # in another unit
    assert given_text(1.0 / 3.0) == "0.3333"
    given: Any = {"tolerance": 0.01, "reason": "", "source": "", "unit": "Hz"}
    check = judge("f", 727.0345678, 727.02, **given)
    assert (computed_text(check), expected_text(check)) == ("727.03", "727.02")
    assert expected_text(check, "727.020") == "727.020"
    assert value_with_band(key_figure(check, printed="727.02")) == "727.03\u00a0Hz"
    banded = judge("f", 727.0345678, 727.02, band=0.5, **given)
    assert (computed_text(banded), error_text(banded)) == ("727.03", "~0\u00a0%")
    failing = judge("f", 750.0, 727.02, band=30.0, **given)
    assert error_text(failing) == "+3.2\u00a0%"  # what fails says by how much
    off = judge("f", 720.0, 727.02, band=0.5, **given)
    assert error_text(off) == "\u22120.966\u00a0%"


def test_a_logarithmic_axis_has_dots_and_no_bars() -> None:
    """A bar's length is from zero, which such an axis does not have."""
    groups = {"L10r": {"front": 2.0, "rear": 30.0}, "L10mr": {"front": 5.0}}
    plain = bars("lives", groups, "life [years]").figure["data"]
    dots = bars("lives", groups, "life [years]", least=1.0).figure
    assert {one["type"] for one in plain} == {"bar"}
    assert {(one["type"], one["mode"]) for one in dots["data"]} == {("scatter", "markers")}
    assert dots["layout"]["xaxis"]["type"] == "log"
    assert len({one["marker"]["symbol"] for one in dots["data"]}) == 2
