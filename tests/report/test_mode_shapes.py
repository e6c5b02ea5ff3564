"""Mode shapes on a page: one of them swings, between the curves on both sides of rest."""

from functools import partial
from pathlib import Path

import numpy as np
from numpy.testing import assert_allclose
from tiny_case import check_one

from fe_drivetrain.report.chart_style import SWING
from fe_drivetrain.report.mode_shapes import shape_chart
from fe_drivetrain.report.results import read_results
from fe_drivetrain.report.suite.case import Case
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.result_folders import run_case
from fe_drivetrain.report.suite.run import Run

NAMES = ("rotor", "sun", "generator")
SHAPES = np.array([[1.0, 0.25], [1.0, -0.5], [1.0, -1.0]])


def test_the_mode_that_swings_goes_as_far_to_either_side() -> None:
    figure = shape_chart("shapes", NAMES, SHAPES, ("0 Hz", "2 Hz"), "angle", 1).figure
    swing, curves = figure[SWING], figure["data"]
    moving = curves[swing["trace"]]
    assert moving["name"] == "2 Hz"
    at_rest, out = np.array([swing["x"], swing["y"]]), np.array([swing["dx"], swing["dy"]])
    assert_allclose(at_rest + out, [moving["x"], moving["y"]])
    other = curves[-1]
    assert_allclose(at_rest - out, [other["x"], other["y"]])
    assert figure["layout"]["xaxis"]["ticktext"] == list(NAMES)


def shown(run: Run, page: Page, swings: bool) -> None:
    check_one(page)
    drawn = shape_chart("shapes", NAMES, SHAPES, ("0 Hz", "2 Hz"), "angle")
    if not swings:
        del drawn.figure[SWING]
    page.add(drawn)


def test_only_a_page_with_a_shape_has_the_script_that_lets_it_swing(tmp_path: Path) -> None:
    for swings in (True, False):
        folder = tmp_path / str(swings)
        case = Case("group/tiny", "tiny", "here", partial(shown, swings=swings))
        run_case(case, folder, {}, False, print)
        text = (folder / "report.html").read_text("utf-8")
        assert ("let it swing" in text) is swings
        # results keep it, so that the page can be written again
        (item,) = read_results(folder / "results.json").sections[0].items
        assert (SWING in item.figure) is swings  # type: ignore[union-attr]
