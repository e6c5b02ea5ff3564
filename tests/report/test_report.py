"""The page shows the results, all of them, and does nothing else."""

import base64
import hashlib
import html
import json
import math
import re
import shlex
import subprocess
from html.parser import HTMLParser
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from PIL import Image as Pixels

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.plots.style import PALETTE
from fe_drivetrain.report.bundle import plotly_file
from fe_drivetrain.report.chart_style import SWING
from fe_drivetrain.report.charts import density_chart, heat_map
from fe_drivetrain.report.index import write_index
from fe_drivetrain.report.number_text import (
    band_text,
    error_text,
    formatted,
    safe_range,
    tolerance_text,
)
from fe_drivetrain.report.page import write_page
from fe_drivetrain.report.rendering import templates
from fe_drivetrain.report.results import (
    AssumptionRow,
    Chart,
    Environment,
    Image,
    Limit,
    Results,
    Section,
    Table,
    Text,
    Verdict,
    judge,
)

HOSTILE = (
    "</script><script>document.title='taken'</script><img src=x onerror=\"document.title='t'\">"
)


class Page(HTMLParser):
    """What a browser would find: elements with their attributes, and the text in each."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.texts: list[tuple[str, str]] = []
        self.open: list[str] = []
        self.scripts: list[tuple[dict[str, str | None], str]] = []
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs)))
        if tag not in ("meta", "link", "img", "br", "input"):
            self.open.append(tag)
        if tag == "script":
            self.scripts.append((dict(attrs), ""))

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if self.open and self.open[-1] == "script":
            attributes, before = self.scripts[-1]
            self.scripts[-1] = attributes, before + data
        elif data.strip():
            self.texts.append((self.open[-1] if self.open else "", data.strip()))

    def all(self, tag: str) -> list[dict[str, str | None]]:
        return [attributes for name, attributes in self.elements if name == tag]

    def text(self) -> str:
        return "\n".join(text for tag, text in self.texts if tag != "style")


def verdict(computed: float = 1.0, **changes: object) -> Verdict:
    given = {"tolerance": 0.01, "reason": "because", "source": "book", "unit": "N"} | changes
    return judge("force", computed, 1.0, **given)  # type: ignore[arg-type]


def results(string: str = "plain", **changes: object) -> Results:
    """Results with everything in them, and one string wherever a string can stand."""
    figure = {
        "data": [{"type": "scatter", "name": string, "x": [1, 2], "y": [3.5, None]}],
        "layout": {"xaxis": {"title": {"text": string}}, "width": 5000},
    }
    content: dict[str, object] = {
        "case": string,
        "title": string,
        "source": string,
        "details": [string],
        "verdicts": [
            judge(string, 1.0, 1.0, tolerance=0.1, reason=string, source=string, unit=string),
            judge("worse", 2.0, 1.0, tolerance=0.1, reason=string, source=string),
        ],
        "sections": [
            Section(
                title=string,
                items=[
                    Text(text=string),
                    Table(caption=string, columns=[string, "n"], rows=[[string, 392280.0]]),
                    Chart(caption=string, figure=figure),
                    Image(caption=string, file="model.png"),
                ],
            )
        ],
        "assumptions": [AssumptionRow(name=string, value=string, unit=string, source=string)],
        "times": {string: 1.5},
        "environment": Environment(
            date=string,
            python=string,
            platform=string,
            versions={string: string},
            settings={string: string},
            code=string,
            command=string,
        ),
        "scene": string,
    }
    return Results.model_validate(content | changes)


def page_of(folder: Path, content: Results) -> str:
    Pixels.new("RGB", (8, 5), "teal").save(folder / "model.png")
    (folder / "results.json").write_text(content.model_dump_json(), "utf-8")
    return write_page(folder).read_text("utf-8")


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (0.2, "0.2"),
        (1.54, "1.54"),
        (392280.0, "392\u202f280"),
        (12345.678, "12\u202f350"),
        (0.0012345678, "0.001235"),
        (80e6, "80\u00a0×\u00a010⁶"),
        (392.04e6, "392\u00a0×\u00a010⁶"),
        (392.16e6, "392.2\u00a0×\u00a010⁶"),
        (999999.9, "1\u00a0×\u00a010⁶"),
        (-1.5e-7, "\u2212150\u00a0×\u00a010⁻⁹"),
        (1728000, "1\u202f728\u202f000"),
        (-3, "\u22123"),
        (True, "yes"),
        (None, "–"),
        (math.nan, "not a number"),
        (-math.inf, "\u2212∞"),
        ("0.10", "0.10"),
    ],
)
def test_numbers_are_written_for_engineers(
    value: float | int | str | bool | None, text: str
) -> None:
    assert formatted(value) == text


@given(st.floats(-1e307, 1e307), st.integers(3, 8))
def test_a_formatted_number_is_the_number_to_its_digits(value: float, digits: int) -> None:
    text = formatted(value, digits).replace("\u202f", "").replace("\u2212", "-")
    mantissa, _, power = text.partition("\u00a0×\u00a010")
    plain = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹", "-0123456789")
    read = float(f"{mantissa}e{power.translate(plain) or 0}")
    # denormal numbers have fewer digits than asked for
    assert abs(read - value) <= 0.5001 * 10.0 ** (1 - digits) * abs(value) + 1e-322
    assert len(mantissa) <= digits + 5


def test_errors_and_tolerances_are_relative_or_in_the_unit() -> None:
    assert error_text(verdict(1.02)) == "+2\u00a0%"
    assert tolerance_text(verdict(1.02)) == "±1\u00a0%"
    assert error_text(verdict(0.98, relative=False)) == "\u22120.02\u00a0N"
    assert tolerance_text(verdict(0.98, relative=False)) == "±0.01\u00a0N"
    zero = judge("z", 0.5, 0.0, tolerance=0.1, reason="", source="", unit="m")
    assert error_text(zero) == "+0.5\u00a0m"
    assert band_text(verdict(2.0, band=0.03)) == "±1.5\u00a0%"
    assert band_text(verdict(2.0, band=0.03, relative=False)) == "±0.03\u00a0N"


def test_the_page_says_what_the_results_say(tmp_path: Path) -> None:
    text = Page(page_of(tmp_path, results("A plain string"))).text()
    assert "1 of 2 checks pass" in text
    assert ", 1 fails" in text
    assert "392\u202f280" in text
    # everywhere but in the chart's JSON and in attributes
    assert text.count("A plain string") >= 18


def test_failed_checks_are_marked(tmp_path: Path) -> None:
    page = Page(page_of(tmp_path, results()))
    assert [row.get("class") for row in page.all("tr")].count("failed") == 1
    assert [t for tag, t in page.texts if tag == "td" and t in ("pass", "FAIL")] == ["pass", "FAIL"]
    passing = Page(page_of(tmp_path, results(verdicts=[verdict()])))
    assert "1 of 1 check passes" in passing.text()
    assert "FAIL" not in passing.text()
    assert "outcome pass" in [p.get("class") for p in passing.all("span")]


def test_an_answer_that_has_not_converged_is_no_green_page(tmp_path: Path) -> None:
    said = results(verdicts=[verdict()], unsettled=["Not converged: the peak."])
    page = Page(page_of(tmp_path, said))
    assert said.passed
    assert not said.settled
    assert "1 of 1 check passes" in page.text()
    assert ", but not every answer has converged" in page.text()
    assert "Not converged: the peak." in page.text()
    classes = [p.get("class") for p in page.all("span")]
    assert "outcome unsettled" in classes
    assert "outcome pass" not in classes


def test_a_page_without_checks_claims_none(tmp_path: Path) -> None:
    page = Page(page_of(tmp_path, results(verdicts=[])))
    assert "No checks" in page.text()
    assert "outcome pass" not in [p.get("class") for p in page.all("span")]


def test_hostile_strings_stay_strings(tmp_path: Path) -> None:
    plain = Page(page_of(tmp_path, results("x" * len(HOSTILE))))
    hostile = Page(page_of(tmp_path, results(HOSTILE)))
    assert [tag for tag, _ in hostile.elements] == [tag for tag, _ in plain.elements]
    assert [sorted(a) for _, a in hostile.elements] == [sorted(a) for _, a in plain.elements]
    assert HOSTILE in hostile.text()
    assert {"title", "h1", "th", "td", "figcaption"} <= {
        tag for tag, text in hostile.texts if text == HOSTILE
    }


def test_a_figure_comes_through_whatever_it_says(tmp_path: Path) -> None:
    strings = (HOSTILE, "<!-- <script>", "]]>&amp;\u2028\u2029", "\\u003c")
    for string in strings:
        page = Page(page_of(tmp_path, results(string)))
        ((_, text),) = [s for s in page.scripts if s[0].get("type") == "application/json"]
        figure = json.loads(text)
        assert figure["data"][0]["name"] == string
        assert figure["data"][0]["y"] == [3.5, None]
        assert "width" not in figure["layout"]
        assert "<" not in text


def test_figures_need_no_webgl_and_no_finite_numbers(tmp_path: Path) -> None:
    figure = {"data": [{"type": "scattergl", "y": [1.0, math.nan, math.inf]}]}
    section = Section(title="s", items=[Chart(caption="c", figure=figure)])
    page = Page(page_of(tmp_path, results(sections=[section])))
    ((_, text),) = [s for s in page.scripts if s[0].get("type") == "application/json"]
    (trace,) = json.loads(text)["data"]
    assert (trace["type"], trace["y"]) == ("scatter", [1.0, None, None])


def drawn(folder: Path, *traces: dict[str, object], **layout: object) -> dict[str, Any]:
    """The figure of such traces as the page has it."""
    figure = {"data": list(traces), "layout": layout}
    section = Section(title="s", items=[Chart(caption="c", figure=figure)])
    page = Page(page_of(folder, results(sections=[section])))
    ((_, text),) = [s for s in page.scripts if s[0].get("type") == "application/json"]
    found: dict[str, Any] = json.loads(text)
    return found


def lines(*names: str) -> list[dict[str, object]]:
    return [{"type": "scatter", "name": name, "x": [1, 2], "y": [1, 2]} for name in names]


def test_only_a_chart_that_swings_brings_its_script_and_its_points(tmp_path: Path) -> None:
    swing = {"trace": 0, "x": [1, 2], "y": [1, 2], "dx": [0, 0], "dy": [0.5, None]}
    for figure, count in (({"data": lines("mode")}, 0), ({"data": lines("mode"), SWING: swing}, 1)):
        items = [Chart(caption="A mode", figure=figure)]
        content = results(sections=[Section(title="Modes", items=items)])
        text = page_of(tmp_path, content.model_copy(update={"case": "a/b", "scene": ""}))
        scripts = Page(text).scripts
        assert sum("requestAnimationFrame" in inside for _, inside in scripts) == count
        (drawn,) = [json.loads(inside) for of, inside in scripts if "data-chart" in of]
        assert drawn.get(SWING) == (swing if count else None)


def test_no_page_has_a_raw_backtick(tmp_path: Path) -> None:
    said = "run `fe-drivetrain history` now"
    chart = Chart(caption=said, figure={"data": lines(said), "layout": {"title": {"text": said}}})
    table = Table(caption=said, columns=[said], rows=[[said]])
    content = results(said, sections=[Section(title=said, items=[chart, table, Text(text=said)])])
    page = Page(page_of(tmp_path, content.model_copy(update={"case": "a/b", "scene": ""})))
    plain = [t for tag, t in page.texts if tag not in ("style", "code", "dd", "td", "pre")]
    assert not any("`" in text for text in plain)
    assert all("`" not in (v or "") for _, attributes in page.elements for v in attributes.values())
    (figure,) = [t for attributes, t in page.scripts if "data-chart" in attributes]
    assert "`" not in figure


def test_no_two_traces_look_the_same(tmp_path: Path) -> None:
    given = lines(*(str(k) for k in range(len(PALETTE) + 3)))
    given[2]["line"] = {"color": PALETTE[0]}
    traces = drawn(tmp_path, *given)["data"]
    looks = [(trace["line"]["color"], trace["line"].get("dash")) for trace in traces]
    assert len(set(looks)) == len(looks)
    assert len({colour for colour, _ in looks}) == len(PALETTE)
    assert [dash for _, dash in looks[-2:]] == ["dash", "dash"]


def test_a_method_has_the_same_colour_in_every_chart(tmp_path: Path) -> None:
    names = ("other", "hexahedra of 27 nodes", "level 2, meridian in harmonics", "another")
    colours = []
    for order in (names, names[::-1]):
        traces = drawn(tmp_path, *lines(*order))["data"]
        colours.append({trace["name"]: trace["line"]["color"] for trace in traces})
        assert len(set(colours[-1].values())) == 4
    for name in names[1:3]:
        assert colours[0][name] == colours[1][name]


def test_axes_are_equal_where_equal_is_a_diagonal_and_have_no_prefixes(tmp_path: Path) -> None:
    layout = drawn(tmp_path, *lines("equal", "beam"), yaxis={"title": {"text": "F [kN]"}})["layout"]
    assert layout["yaxis"]["scaleanchor"] == "x"
    assert layout["yaxis"]["title"] == {"text": "F [kN]"}
    assert layout["template"]["layout"]["yaxis"]["exponentformat"] == "power"
    flat = [{**line, "y": [0.1 * v for v in line["x"]]} for line in lines("equal", "beam")]
    for axes in ({}, {"xaxis": {"type": "log"}, "yaxis": {"type": "log"}}):
        both = drawn(tmp_path, *flat, **axes)["layout"]
        # a square, although one varies ten times as much as the other
        assert both["xaxis"]["range"] == both["yaxis"]["range"]
    assert "scaleanchor" not in drawn(tmp_path, *lines("beam"))["layout"].get("yaxis", {})


@pytest.mark.parametrize(("most", "tick"), [(5, "D1"), (50, "D2"), (1e5, 1), (1e20, 3)])
def test_labels_of_a_logarithmic_axis_leave_each_other_room(
    tmp_path: Path, most: float, tick: object
) -> None:
    trace = {"type": "scatter", "x": [1.0, most], "y": [0, 1]}
    axis = drawn(tmp_path, trace, xaxis={"type": "log"})["layout"]["xaxis"]
    assert axis["dtick"] == tick
    # 200, not a 2 whose power of ten nobody knows
    assert axis.get("tickformat") == (None if isinstance(tick, int) else ",~r")


def test_labels_between_powers_of_ten_are_whole_numbers(tmp_path: Path) -> None:
    trace = {"type": "scatter", "x": [2.1e-7, 6e-7], "y": [3e8, 7e8]}
    axes = {"xaxis": {"type": "log"}, "yaxis": {"type": "log"}}
    layout = drawn(tmp_path, trace, **axes)["layout"]
    for axis, at, text in (("xaxis", 3e-7, "3 × 10⁻⁷"), ("yaxis", 4e8, "4 × 10⁸")):
        labels = dict(zip(layout[axis]["tickvals"], layout[axis]["ticktext"], strict=True))
        assert labels[at].replace("\u00a0", " ") == text


def test_the_policy_allows_the_scripts_of_the_page_and_nothing_else(tmp_path: Path) -> None:
    page = Page(page_of(tmp_path, results(HOSTILE)))
    (policy,) = [m["content"] for m in page.all("meta") if "http-equiv" in m]
    assert policy is not None
    run = [text for attributes, text in page.scripts if not attributes]
    digests = [hashlib.sha256(script.encode()).digest() for script in run]
    allowed = " ".join(f"'sha256-{base64.b64encode(digest).decode()}'" for digest in digests)
    assert len(run) == 2
    # a chart's program stands in a file: the one that the page itself names, and no other file
    (nonce,) = [attributes["nonce"] for attributes, _ in page.scripts if "src" in attributes]
    assert nonce is not None
    assert len(nonce) == 64
    assert f"script-src {allowed} 'nonce-{nonce}';" in policy
    assert nonce not in results(HOSTILE).model_dump_json()
    assert "file:" not in policy
    assert "'self'" not in policy
    assert "default-src 'none'" in policy


def test_the_page_refers_to_nothing_but_files_of_its_folder(tmp_path: Path) -> None:
    (tmp_path / "mesh 1e5.vtu").write_text("")
    page = Page(page_of(tmp_path, results("https://example.org/x.png")))
    addresses = []
    for _, attributes in page.elements:
        for name in ("src", "href", "srcset", "action", "data", "poster"):
            address = attributes.get(name) or "#"
            if not address.startswith(("data:", "#")):
                addresses.append(unquote(address))
    assert set(addresses) == {
        f"./{plotly_file()}",
        "mesh 1e5.vtu",
        "model.png",
        "results.json",
    }
    assert all((tmp_path / address).is_file() for address in addresses)
    (style,) = [text for tag, text in page.texts if tag == "style"]
    assert "url(" not in style
    assert "@import" not in style


def test_plotly_stands_once_beside_the_pages_and_only_for_charts(tmp_path: Path) -> None:
    section = Section(title="s", items=[Chart(caption="c", figure={})] * 3)
    case = tmp_path / "group" / "case"
    case.mkdir(parents=True)
    (case / "results.json").write_text(results(sections=[]).model_dump_json(), "utf-8")
    none = write_page(case, tmp_path).read_text("utf-8")
    assert "plotly" not in none
    assert "file:" not in none
    assert list(tmp_path.glob("*.js")) == []
    (case / "results.json").write_text(results(sections=[section]).model_dump_json(), "utf-8")
    text = write_page(case, tmp_path).read_text("utf-8")
    assert [a["src"] for a, _ in Page(text).scripts if "src" in a] == [f"../../{plotly_file()}"]
    assert len(text) < 60_000
    (bundle,) = tmp_path.glob("**/*.js")
    assert bundle == tmp_path / plotly_file()
    assert "plotly.js" in bundle.read_text("utf-8")[:1000]


def test_a_case_can_be_run_again_from_what_its_page_says(tmp_path: Path) -> None:
    environment = results().environment.model_copy(
        update={
            "command": "fe-drivetrain run a/b --set k=-4e5",
            "code": "c0de" * 16,
            "commit": "0ff1ce" * 6 + "0000",
            "quick": True,
        }
    )
    content = results(environment=environment, scene="shaft:\n  front: -1e-5\n")
    text = Page(page_of(tmp_path, content)).text()
    for said in (
        "fe-drivetrain run a/b --set k=-4e5",
        "front: -1e-5",
        "c0dec0de",
        "0ff1ce0ff1ce",
        "quick: coarser",
    ):
        assert said in text


def test_no_time_is_negative(tmp_path: Path) -> None:
    times = {"a": 3.0, "b": 2.0, "side by side in 2 processes": -1.5}
    text = Page(page_of(tmp_path, results(times=times))).text()
    assert "saved, side by side in 2 processes\n1.5" in text
    assert "Computing times: 3.5" in text
    assert "\u22121.5" not in text


def test_images_are_embedded_whole_and_described(tmp_path: Path) -> None:
    page = Page(page_of(tmp_path, results("the caption")))
    (image,) = page.all("img")
    assert image["alt"] == "the caption"
    head, _, data = (image["src"] or "").partition(",")
    assert head == "data:image/png;base64"
    assert base64.b64decode(data) == (tmp_path / "model.png").read_bytes()


def test_addresses_are_no_text_to_set(tmp_path: Path) -> None:
    """Of a picture's letters and digits some look like a power of ten, as do those of a name."""
    page_of(tmp_path, results("plain"))
    picture = tmp_path / "model.png"
    content = picture.read_bytes()
    content += bytes(-len(content) % 3) + base64.b64decode("A+1e5+AA")
    picture.write_bytes(content)
    text = write_page(tmp_path).read_text("utf-8")
    (image,) = Page(text).all("img")
    assert base64.b64decode((image["src"] or "").partition(",")[2]) == content
    case = tmp_path / "all" / "own" / "mesh-1e5"
    case.mkdir(parents=True)
    page_of(case, results("own/mesh-1e5"))
    index = Page(write_index(tmp_path / "all").read_text("utf-8"))
    assert "own/mesh-1e5/report.html" in [a.get("href") for a in index.all("a")]


@pytest.mark.parametrize("file", ["missing.png", "../secret.png", "text.png", "link.png", ""])
def test_an_image_must_be_a_png_in_the_folder(tmp_path: Path, file: str) -> None:
    Pixels.new("RGB", (2, 2)).save(tmp_path / "secret.png")
    folder = tmp_path / "out"
    folder.mkdir()
    (folder / "text.png").write_text("no picture")
    (folder / "link.png").symlink_to(tmp_path / "secret.png")
    section = Section(title="s", items=[Image(caption="c", file=file)])
    with pytest.raises(InputError, match="image"):
        page_of(folder, results(sections=[section]))


def test_contents_lead_to_every_section(tmp_path: Path) -> None:
    sections = [Section(title=f"Part {k}", items=[]) for k in range(3)]
    text = page_of(tmp_path, results(sections=sections))
    page = Page(text)
    nav = text.partition("<nav")[2].partition("</nav>")[0]
    links = re.findall('href="#([^"]*)"', nav)
    assert links == [s["id"] for s in page.all("section")]
    assert len(links) > 4


def test_a_page_of_a_dossier_leads_to_the_others(tmp_path: Path) -> None:
    links = [
        {"title": "Overview", "address": ""},
        {"title": "Loads", "address": "loads/report.html"},
        {"title": "Own", "address": "javascript:alert(1)"},
    ]
    page = Page(page_of(tmp_path, results(links=links)))
    first, second, third = [a for a in page.all("a") if a.get("href")][:3]
    assert first == {"href": "#summary", "aria-current": "page"}
    assert second == {"href": "loads/report.html"}
    assert third == {"href": "javascript%3Aalert%281%29"}


def test_tables_have_headers_and_the_page_a_language(tmp_path: Path) -> None:
    page = Page(page_of(tmp_path, results()))
    assert page.all("html") == [{"lang": "en"}]
    assert all(head.get("scope") in ("col", "row") for head in page.all("th"))
    assert len(page.all("thead")) == len(page.all("table"))
    assert [figure["aria-label"] for figure in page.all("figure") if "aria-label" in figure]


def test_the_same_results_make_the_same_page(tmp_path: Path) -> None:
    assert page_of(tmp_path, results()) == page_of(tmp_path, results())


@pytest.mark.needs("chromium")
def test_a_browser_draws_the_chart_and_runs_nothing_hostile(tmp_path: Path) -> None:
    folder = tmp_path / "out"
    folder.mkdir()
    page_of(folder, results(HOSTILE))
    options = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-background-networking"]
    done = subprocess.run(
        [
            "chromium",
            *options,
            f"--user-data-dir={tmp_path / 'profile'}",
            "--virtual-time-budget=5000",
            "--dump-dom",
            # a chart is drawn when the fold that it stands in is opened, as its link does
            (folder / "report.html").as_uri() + "#section-1",
        ],
        capture_output=True,
        text=True,
        timeout=120,
        check=True,
    )
    assert 'class="main-svg"' in done.stdout
    head = done.stdout.partition("<title>")[2].partition("</title>")[0]
    assert "taken" in head  # the whole string is the title, escaped
    assert head.startswith("&lt;/script&gt;")


def limit(**changes: object) -> Limit:
    given: dict[str, object] = {
        "method": "linear tetrahedra",
        "parameter": "length over diameter [-]",
        "high": 12.5,
        "criterion": "error below 1 %",
        "beyond": "too stiff",
        "program": "takes quadratic ones",
        "remedy": "quadratic tetrahedra",
    }
    return Limit.model_validate(given | changes)


@pytest.mark.parametrize(
    ("low", "high", "text"),
    [
        (None, 12.5, "up to 12.5"),
        (0.1, None, "from 0.1"),
        (2.5, 80.0, "2.5 to 80"),
        (None, None, "the whole sweep"),
    ],
)
def test_safe_ranges_are_written_in_words(low: float | None, high: float | None, text: str) -> None:
    assert safe_range(limit(low=low, high=high)).replace("\N{THIN SPACE}", " ") == text


def test_only_ends_with_a_unit_are_written_in_steps_of_three_powers() -> None:
    assert safe_range(limit(parameter="ratio", low=1e-10, high=None)) == "from 1\u00a0×\u00a010⁻¹⁰"
    assert (
        safe_range(limit(parameter="spring [N/m]", low=1e-10, high=None))
        == "from 100\u00a0×\u00a010⁻¹²"
    )


def test_limits_are_on_the_page_and_on_the_atlas(tmp_path: Path) -> None:
    content = results(limits=[limit(method=HOSTILE)])
    folder = tmp_path / "stability" / "some"
    folder.mkdir(parents=True)
    assert HOSTILE in Page(page_of(folder, content)).text()
    write_index(tmp_path)
    atlas = Page((tmp_path / "atlas.html").read_text())
    assert ("a", {"href": "stability/some/report.html"}) in atlas.elements
    assert "up to 12.5" in [text.strip() for _, text in atlas.texts]
    assert not atlas.scripts
    # without limits there is no atlas, and no link to one
    (folder / "results.json").write_text(results().model_dump_json())
    write_index(tmp_path)
    assert not (tmp_path / "atlas.html").exists()
    assert "atlas.html" not in (tmp_path / "index.html").read_text()


def test_a_map_of_colours_has_named_or_numbered_cells_and_holes() -> None:
    z = [[1.0, np.nan, 3.0], [4.0, 5.0, 6.0]]
    titles = "load", "speed [m/s]", "share [%]"
    shown = heat_map("map", ["Fx", "Fy", "Fz"], [3.0, 5.0], z, titles, (0.0, 10.0), height=300)
    (data,) = shown.figure["data"]
    assert data["x"] == ["Fx", "Fy", "Fz"]
    assert data["y"] == [3.0, 5.0]
    assert data["z"] == [[1.0, None, 3.0], [4.0, 5.0, 6.0]]
    assert (data["zmin"], data["zmax"]) == (0.0, 10.0)
    assert shown.figure["layout"]["yaxis"]["title"]["text"] == "speed [m/s]"
    assert shown.figure["layout"]["height"] == 300


def test_a_density_has_all_of_the_time_and_points_the_right_way() -> None:
    rng = np.random.default_rng(0)
    right, up = rng.normal(5.0, 1.0, 2000), rng.normal(-3.0, 0.5, 2000)
    (heat,) = density_chart("density", right, up, "kN").figure["data"]
    shares = np.array([[cell or 0.0 for cell in row] for row in heat["z"]])
    assert_allclose(shares.sum(), 100.0, rtol=5e-3)
    x, y = np.meshgrid(heat["x"], heat["y"])
    assert_allclose((shares * x).sum() / 100.0, right.mean(), rtol=0.02)
    assert_allclose((shares * y).sum() / 100.0, up.mean(), rtol=0.02)
    # most of the plane that is shown is of the cloud, however far from zero it is
    assert max(heat["x"]) - min(heat["x"]) < 1.1 * np.ptp(right)
    assert np.isfinite(density_chart("nothing", [0.0], [0.0], "kN").figure["data"][0]["x"]).all()


def test_names_in_commands_are_quoted() -> None:
    template = templates().from_string("{{ name | as_word }}")
    assert shlex.split(html.unescape(template.render(name="life/a b's"))) == ["life/a b's"]
