"""Rolling elements coloured by their load, and the curve of a sweep that was chosen."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from fe_drivetrain.bearing.catalogue import catalogue_bearing
from fe_drivetrain.bearing.geometry import angles
from fe_drivetrain.report.results import Chart
from fe_drivetrain.report.roller_chart import roller_chart
from fe_drivetrain.report.suite import Page

BEARING = catalogue_bearing("bearing_s_o20")
COUNT = BEARING.counts[0]


def test_each_roller_stands_at_its_angle_in_the_colour_of_its_load() -> None:
    loads = np.zeros(2 * COUNT)
    loads[:3] = 1e3, 5e3, 2e3
    drawn = roller_chart("loads", BEARING, loads).figure["data"]
    shown = [t for t in drawn if "colorscale" in t["marker"]]
    (loaded,) = shown
    assert loaded["marker"]["color"] == [1.0, 5.0, 2.0]
    assert loaded["marker"]["cmax"] == 5.0
    assert loaded["marker"]["showscale"] is True
    psi = angles(BEARING.rows[0])[:3]
    assert_allclose(np.arctan2(loaded["y"], loaded["x"]), psi, atol=1e-3)
    assert sum(len(t["x"]) for t in drawn) == 2 * COUNT


def test_the_upwind_row_is_outermost() -> None:
    drawn = roller_chart("loads", BEARING, np.ones(2 * COUNT)).figure["data"]
    radii = [float(np.hypot(t["x"][0], t["y"][0])) for t in drawn]
    places = [row.place for row in BEARING.rows]
    assert radii[0] > radii[1]
    assert places[0] < places[1]


def test_there_are_as_many_loads_as_rollers() -> None:
    with pytest.raises(ValueError, match="3 loads of 72 rolling elements"):
        roller_chart("loads", BEARING, np.ones(3))


def test_the_chosen_curve_of_a_sweep_is_a_star() -> None:
    page = Page()
    rows = [{"model": name, "t": t, "e": 1.0} for name in ("fast", "exact") for t in (1.0, 2.0)]
    page.sweep("errors", rows, "t", "e", by="model", points=True, chosen_curve="exact", table=False)
    (chart,) = (item for item in page.sections[0].items if isinstance(item, Chart))
    symbols = {t["name"]: t.get("marker", {}).get("symbol") for t in chart.figure["data"]}
    assert symbols == {"fast": None, "exact": "star"}
