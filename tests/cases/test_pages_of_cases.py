"""Every page of a quick run of all cases: what no page may show, whatever case it is of.

The cases are not run for it: it reads the folder of results that the other tests of a run share.
"""

import json
import os
import re
from collections import Counter
from pathlib import Path
from typing import Any

import pytest
from conftest import QUICK_VARIABLE
from test_report import Page

from fe_drivetrain.report.chart_style import figure_as_json
from fe_drivetrain.report.page import render
from fe_drivetrain.report.results import Chart, Image, Solid, read_results, results_below

FOLDER = os.environ.get(QUICK_VARIABLE)
FILES = results_below(Path(FOLDER)) if FOLDER else {}

pytestmark = pytest.mark.skipif(not FILES, reason=f"{QUICK_VARIABLE} names no folder of results")

#: Seen by nobody, or to be typed again.
HIDDEN = ("style", "script", "code", "pre")
RAW = {
    "a backtick": r"`",
    "a caret": r"\^",
    "a power of ten as typed": r"(?<![\w=.-])\d+(\.\d+)?e[+-]?\d+\b",
    "a prefix twice": r"\b[numk]k[NWJ]\b",
    "a gap before a stop": r"\w [,;](?= |$)",
}

#: Groups whose questions are about a body, and the cases in them that are about numbers alone.
OF_BODIES = ("verification", "stability", "bearing", "gear", "foreign", "export")
WITHOUT_BODY = {
    "verification/grid_convergence_index",
    "verification/vm63_vm191_hertz",
    # files, slips and faults
    *(f"verification/{name}" for name in ("files_of_others", "kept_files", "mutations")),
    *(f"verification/{name}" for name in ("mutated_machines", "mutated_scenes")),
    "verification/din_743",
    # tables of catalogues, and closed forms
    "bearing/ratings",
    *(f"bearing/{name}" for name in ("by_designation", "defect_frequencies", "friction")),
    "bearing/operating_clearance",
    *(f"stability/{name}" for name in ("bearing_friction", "fitted_insides", "press_fits")),
    "gear/power_losses",
    "gear/gear_damage",
    "gear/mesh_wave",
    "gear/time_factors",
    *(f"stability/{name}" for name in ("bearing_life", "life_resolution", "repeatability")),
    *(f"stability/{name}" for name in ("faults", "time_series", "time_series_length")),
    # masses on springs
    *(f"stability/{name}" for name in ("loose_bearings", "near_singular_carriers")),
    "stability/whirl_senses",
    "stability/flat_designs",
    *(f"stability/{name}" for name in ("parametric_resonance", "stiff_limits", "time_step")),
    "stability/tooth_separation",
}


def looks(trace: dict[str, Any]) -> str:
    """Colour, dashes and kind of points, of which no two curves of a chart may have the same."""
    line, marker = trace.get("line", {}), trace.get("marker", {})
    kind = trace.get("type", "scatter"), trace.get("mode"), line.get("dash"), marker.get("symbol")
    return json.dumps([line.get("color") or marker.get("color"), *kind])


def drawn_alike(data: list[dict[str, Any]]) -> list[str]:
    """Looks of several curves that the legend tells apart."""
    named = [t for t in data if t.get("showlegend", True) and t.get("type") != "heatmap"]
    return [look for look, count in Counter(map(looks, named)).items() if count > 1]


def raw_text(page: Page) -> list[str]:
    """What is wrong in the texts of a page, with the text."""
    texts = [text for tag, text in page.texts if tag not in HIDDEN]
    return [
        f"{what}: {text[:120]}"
        for text in texts
        for what, pattern in RAW.items()
        if re.search(pattern, text)
    ]


@pytest.mark.parametrize("name", [n for n in FILES if n.split("/")[0] in OF_BODIES])
def test_a_page_about_a_body_shows_it(name: str) -> None:
    items = [item for section in read_results(FILES[name]).sections for item in section.items]
    assert any(isinstance(item, (Image, Solid)) for item in items) != (name in WITHOUT_BODY)


@pytest.mark.parametrize("name", FILES)
def test_a_page_has_no_raw_text_and_charts_that_can_be_read(name: str) -> None:
    found = read_results(FILES[name])
    folder = FILES[name].parent
    assert raw_text(Page(render(found, folder, folder))) == []
    for section in found.sections:
        assert section.items, section.title
        for item in section.items:
            if not isinstance(item, Chart):
                continue
            figure = json.loads(figure_as_json(item))
            assert drawn_alike(figure["data"]) == [], item.caption
            for axis in "xy":
                layout = figure["layout"][f"{axis}axis"]
                named = any(isinstance(v, str) for t in figure["data"] for v in t[axis])
                if named or "ticktext" in layout:
                    continue  # names speak for themselves
                title = layout["title"]["text"]
                assert re.match(r"[^\[]", title), (item.caption, axis)
