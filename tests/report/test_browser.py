"""The pages in a browser, from the file system: what is drawn, pressed, read, copied and saved."""

import csv
import io
import re
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from urllib.parse import unquote, urlparse

import numpy as np
import pytest
from PIL import Image as Pixels
from test_own_drivetrain import QUICK, write_loads
from test_report import limit, lines, results, verdict

from fe_drivetrain.command_line import main
from fe_drivetrain.report.bundle import plotly_file
from fe_drivetrain.report.charts import bars, chart, trace
from fe_drivetrain.report.history import record_run
from fe_drivetrain.report.index import write_index
from fe_drivetrain.report.page import write_page
from fe_drivetrain.report.results import Chart, Problem, Section, Solid, Table, Text
from fe_drivetrain.report.solid_view import write_solid_view
from fe_drivetrain.shafts.response.model import Model
from fe_drivetrain.shafts.response.unit_loads import Response

pytestmark = pytest.mark.needs("chromium", "playwright", "axe_playwright_python")

PAGES = ("index.html", "checks.html", "atlas.html", "group/one/report.html")
PAGES += ("compare/report.html", "sweep/report.html", "study/report.html")
WIDE, NARROW = 1400, 390
PAPER, TURNED = 687, 1016  # pixels between the margins of A4, upright and turned
#: What statics decides, so that nothing is meshed.
STATICS = ["compare", "main_bearing_spherical", "--quantity", "main_bearing.Fz"]
PROBLEMS = {
    "other/later": Problem("waits for its turn", "planned"),
    "other/now": Problem("at work", "running"),
    "other/tool": Problem("ccx is not installed: apt-get install calculix-ccx", "skipped"),
    "other/error": Problem("ended by an error of its own, " + "x" * 90),
}
BARS = {"type": "bar", "orientation": "h", "name": "b", "x": [1, 2], "y": ["one", "two"]}
SECTION = Section(
    title="A section with a long title, " * 3,
    items=[
        Text(text="A sentence with `code_of_many_letters_that_do_not_break` in it. " * 3),
        Chart(caption="A chart of `two` lines", figure={"data": lines("equal", "beam")}),
        Chart(caption="Bars", figure={"data": [BARS]}),
        Table(
            caption="A wide table",
            columns=["name", *(f"column {k} [kN m]" for k in range(14))],
            rows=[['first, "quoted"', *(k / 7.0 for k in range(14))]] * 3,
        ),
    ],
)


@pytest.fixture(scope="module")
def reports(
    tmp_path_factory: pytest.TempPathFactory, bonded_model: Model, bonded_response: Response
) -> Path:
    """A folder of reports, with everything in it that a page can show."""
    folder = tmp_path_factory.mktemp("reports")
    for number, name in enumerate(("group/one", "group/two", "next/three")):
        checks = [verdict(1.0 + 0.003 * number, band=1e-3), verdict(1.0 + 0.02 * (number == 1))]
        content = results("plain", case=name, title=f"Title of {name}", verdicts=checks)
        environment = content.environment.model_copy(
            update={"command": f"fe-drivetrain run {name} --quick", "quick": number == 2}
        )
        sections = [SECTION]
        (folder / name).mkdir(parents=True)
        if number == 0:
            mesh = bonded_model.mesh
            fields = {
                "1 MN down": -1e6 * bonded_response.displacements[..., 2],
                "0.3 MN m about x": 3e5 * bonded_response.displacements[..., 3],
            }
            steel = dict.fromkeys(mesh.part_names, (115e9, 77e9))
            assert write_solid_view(mesh, fields, steel, folder / name / "view.json")
            Pixels.new("RGB", (8, 5), "teal").save(folder / name / "still.png")
            solid = Solid(caption="Model under 1 MN", file="view.json", still="still.png")
            sections.append(Section(title="Model", items=[solid]))
        content = content.model_copy(
            update={
                "environment": environment,
                "sections": sections,
                "limits": [limit()],
                "scene": "shaft:\n  front: -2.145\n" * 20,
            }
        )
        (folder / name / "results.json").write_text(content.model_dump_json(), "utf-8")
        record_run(folder, content)
        record_run(folder, content)
    for name, how in (
        ("sweep", ["--vary", "shaft.front=-2.0:-1.6:3"]),
        ("compare", ["three_point_suspension", "--quantity", "main_bearing.Fy"]),
    ):
        with pytest.raises(SystemExit) as ended:
            main([*STATICS, *how, "--out", str(folder / name)])
        assert ended.value.code in (0, 1)
    write_loads(folder.parent / "own.csv", 3)
    loads = ["--loads", str(folder.parent / "own.csv"), "--out", str(folder / "study")]
    with pytest.raises(SystemExit) as ended:
        main(["study", "main_bearing_spherical", "--quick", *QUICK, *loads])
    assert ended.value.code == 0
    write_index(folder, PROBLEMS)
    for name in ("group/one", "group/two", "next/three"):
        write_page(folder / name, folder)
    return folder


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        # the system's own: nothing is loaded for it
        started = playwright.chromium.launch(
            executable_path=shutil.which("chromium"),
            args=["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
        )
        yield started
        started.close()


class Opened:
    """A page, and all that it said and asked for."""

    def __init__(
        self,
        browser: Any,
        file: Path,
        width: int = WIDE,
        scheme: str = "light",
        unfolded: bool = True,
    ) -> None:
        self.context = browser.new_context(
            viewport={"width": width, "height": 900}, color_scheme=scheme, accept_downloads=True
        )
        self.page = self.context.new_page()
        self.said: list[str] = []
        self.asked: list[str] = []
        self.page.on("console", lambda message: self.said.append(message.text))
        self.page.on("pageerror", lambda error: self.said.append(str(error)))
        self.page.on("request", lambda request: self.asked.append(request.url))
        self.page.goto(file.as_uri())
        if "report" in file.name and unfolded:
            self.page.evaluate(
                "for (const of of document.querySelectorAll('details')) of.open = true"
            )
            self.page.wait_for_selector(".main-svg")

    def __enter__(self) -> "Opened":
        return self

    def __exit__(self, *_: object) -> None:
        self.context.close()

    def shown(self) -> list[str]:
        """Text of the name of each row that is seen."""
        names: list[str] = self.page.evaluate(
            "Array.from(document.querySelectorAll('.listing tbody tr'))"
            ".filter(row => row.offsetParent !== null)"
            ".map(row => (row.querySelector('th a') || row.querySelector('th')).textContent)"
        )
        return names


@pytest.mark.parametrize("name", PAGES)
@pytest.mark.parametrize(("width", "scheme"), [(WIDE, "light"), (NARROW, "dark")])
def test_a_page_fits_is_open_to_all_and_asks_for_nothing_but_its_files(
    browser: Any, reports: Path, name: str, width: int, scheme: str
) -> None:
    from axe_playwright_python.sync_playwright import Axe

    with Opened(browser, reports / name, width, scheme) as opened:
        assert opened.said == []
        for address in opened.asked:
            parts = urlparse(address)
            assert parts.scheme in ("file", "data", "blob")
            if parts.scheme == "file":
                assert Path(unquote(parts.path)).is_relative_to(reports)
        assert opened.page.evaluate("document.documentElement.scrollWidth") <= width
        background = opened.page.evaluate("getComputedStyle(document.body).backgroundColor")
        assert (background == "rgb(255, 255, 255)") == (scheme == "light")
        found = Axe().run(opened.page).response["violations"]
    faults = [(one["id"], [node["html"][:200] for node in one["nodes"]][:3]) for one in found]
    assert faults == []


ANSWER = {
    "question": "Which force does the bearing carry?",
    "verdict": "The bearing carries 412\u00a0kN, which is within the 500\u00a0kN that it may. " * 2,
    "figures": [
        {
            "name": f"load of row {k}",
            "value": 412.3,
            "unit": "kN",
            "band": 3.1,
            "bound": "at most",
            "limit": 500.0,
            "by": "catalogue",
            "status": "good",
        }
        for k in range(6)
    ],
    "hero": "A chart of `two` lines",
    "cautions": [f"Caution {k} is as long as such a sentence may well be." for k in range(5)],
    "status": "good",
}


@pytest.fixture
def answering(tmp_path: Path) -> Path:
    """A page with an answer."""
    section = SECTION.model_copy(update={"items": [SECTION.items[2], *SECTION.items]})
    content = results("plain", verdicts=[verdict()], sections=[section], answer=ANSWER)
    (tmp_path / "results.json").write_text(content.model_dump_json(), "utf-8")
    return write_page(tmp_path)


def test_the_first_screen_answers(browser: Any, answering: Path) -> None:
    with Opened(browser, answering, 1300, unfolded=False) as opened:
        page = opened.page
        page.wait_for_selector("#figure-hero .main-svg")
        for part in (".verdict-line", ".keys li:last-child", "#figure-hero", ".badges"):
            box = page.locator(part).bounding_box()
            assert box["y"] + box["height"] <= 900, part
        assert page.locator("#summary > .caution").count() == 3
        assert not page.is_visible("text=Caution 3")
        assert page.evaluate("document.documentElement.scrollHeight") < 1600
        # few curves are named where they end, not in a legend
        assert page.locator("#figure-hero .legend").count() == 0
        assert page.locator("#figure-hero .annotation").count() == 2


def test_a_link_unfolds_what_it_leads_to_and_draws_it(browser: Any, answering: Path) -> None:
    with Opened(browser, answering, 1300, unfolded=False) as opened:
        page = opened.page
        fold, inner = page.locator("#section-1 > details"), page.locator("#section-1 .main-svg")
        assert fold.get_attribute("open") is None
        assert inner.count() == 0
        page.click("nav a[href='#section-1']")
        inner.first.wait_for()
        assert fold.get_attribute("open") is not None
        assert page.locator("#checks > details").get_attribute("open") is None
        page.click(".badges a")
        page.wait_for_selector("#checks table", state="visible")
        page.click("#checks summary")
        page.click(".badges a")  # the address is the same as before
        page.wait_for_selector("#checks table", state="visible")
        # contents stay in view
        page.evaluate("window.scrollTo(0, document.body.scrollHeight)")
        assert page.locator("nav").bounding_box()["y"] >= 0
        assert opened.said == []


PLACES = """() => Array.from(document.querySelectorAll(".chart")).map(place => [
  place.getBoundingClientRect().height,
  place.querySelector(".main-svg").getBoundingClientRect().height,
])"""


def test_paper_has_what_is_folded(browser: Any, answering: Path) -> None:
    with Opened(browser, answering, PAPER, unfolded=False) as opened:
        page = opened.page
        count = "document.querySelectorAll('details:not([open])').length"
        folded = page.evaluate(count)
        assert folded > 4
        page.emulate_media(media="print")
        # without the script, too
        assert page.locator("#checks table").bounding_box()["height"] > 20
        page.evaluate("window.dispatchEvent(new Event('beforeprint'))")
        assert page.evaluate(count) == 0
        boxes = [page.locator(part).bounding_box() for part in (".keys", "#figure-hero")]
        assert boxes[0]["y"] + boxes[0]["height"] <= boxes[1]["y"]
        assert page.locator("#section-1 .main-svg").count() > 0
        # a chart fills its place: a taller one would cover what follows it
        heights = page.evaluate(PLACES)
        assert len(heights) > 1
        assert {round(high) for high, _ in heights} != {450}
        assert [round(drawn) for _, drawn in heights] == [round(high) for high, _ in heights]
        page.evaluate("window.dispatchEvent(new Event('afterprint'))")
        assert page.evaluate(count) == folded


def test_long_names_of_cases_and_files_break_on_a_narrow_screen(
    browser: Any, reports: Path, tmp_path: Path
) -> None:
    long = "stability/a_case_whose_name_is_as_long_as_any"
    shutil.copytree(reports / "group/one", tmp_path / long)
    (tmp_path / long / "deformed.3d.json").write_text("{}")
    content = results("plain", case=long, title="Title", sections=[])
    (tmp_path / long / "results.json").write_text(content.model_dump_json(), "utf-8")
    for _ in range(2):  # the command for all runs stands where there were others
        record_run(tmp_path, content)
    write_page(tmp_path / long, tmp_path)
    context = browser.new_context(viewport={"width": NARROW, "height": 900})
    page = context.new_page()
    page.goto((tmp_path / long / "report.html").as_uri())
    page.click("text=unfold all")
    assert page.is_visible("text=lists every run")
    assert page.is_visible("text=what the page shows in three dimensions")
    assert page.evaluate("document.documentElement.scrollWidth") <= NARROW
    context.close()


def test_cases_are_searched_filtered_and_sorted(browser: Any, reports: Path) -> None:
    with Opened(browser, reports / "index.html") as opened:
        page = opened.page
        worst_first = ["group/two", "other/error", "other/now", "other/later", "other/tool"]
        worst_first += ["next/three", "group/one"]
        assert opened.shown() == worst_first
        assert page.inner_text("#count") == "7 of 7 cases"
        page.fill("#search", "TITLE three")
        assert opened.shown() == ["next/three"]
        page.fill("#search", "")
        page.click("button.filter[data-value='planned']")
        page.click("button.filter[data-value='running']")
        assert opened.shown() == ["other/now", "other/later"]
        page.click("button.filter[data-value='planned']")
        page.click("button.filter[data-value='running']")
        page.click("button.filter[data-key='quick']")
        assert opened.shown() == ["next/three"]
        page.click("button.filter[data-key='quick']")
        page.select_option("#group", "group")
        assert opened.shown() == ["group/two", "group/one"]
        page.select_option("#group", "")
        page.click("th button:text('Case')")
        assert opened.shown() == sorted(worst_first)
        page.click("th button:text('Case')")
        assert opened.shown() == sorted(worst_first, reverse=True)
        assert page.get_attribute("th[aria-sort]", "aria-sort") == "descending"
        page.click("th button:text('Verdict')")
        assert opened.shown() == worst_first


def test_paper_has_all_rows_and_nothing_to_press(browser: Any, reports: Path) -> None:
    with Opened(browser, reports / "index.html") as opened:
        opened.page.fill("#search", "three")
        opened.page.emulate_media(media="print")
        assert len(opened.shown()) == 7
        assert not opened.page.is_visible("#search")
    with Opened(browser, reports / "group/one/report.html", scheme="dark") as opened:
        opened.page.emulate_media(media="print", color_scheme="dark")
        for button in opened.page.locator("button").all():
            assert not button.is_visible()
        background = "getComputedStyle(document.body).backgroundColor"
        assert opened.page.evaluate(background) == "rgb(255, 255, 255)"


@pytest.mark.parametrize("name", PAGES)
def test_nothing_is_wider_than_paper(browser: Any, reports: Path, name: str) -> None:
    """The printer need not shrink a page: tables of many columns stand on turned ones."""
    with Opened(browser, reports / name, PAPER) as opened:
        opened.page.emulate_media(media="print")
        opened.page.evaluate("window.dispatchEvent(new Event('beforeprint'))")
        wide = opened.page.evaluate(WIDTHS)
        assert wide["upright"] <= PAPER
        assert wide["turned"] <= TURNED
        sizes = re.findall(rb"/MediaBox \[0 0 ([\d.]+) ([\d.]+)\]", opened.page.pdf())
        assert len(sizes) >= 1
        assert any(float(across) > float(up) for across, up in sizes) == (wide["turned"] > 0)
    assert wide["turned"] > 0 or name != "group/one/report.html"


WIDTHS = """() => {
  const broad = Array.from(document.querySelectorAll(".broad table"));
  const right = of => Math.max(0, ...of.map(e => e.getBoundingClientRect().right));
  const turned = right(broad);
  for (const table of broad) table.style.display = "none";
  return { turned, upright: document.documentElement.scrollWidth };
}"""


# corners of each text as it is turned: two are apart where a line along a side of one has room for
# both; a text that is not shown has no size
LABELS = """() => {
  const corners = t => {
    const { x, y, width, height } = t.getBBox(), m = t.getScreenCTM();
    const dx = Math.min(1, width / 3), dy = Math.min(1.5, height / 3);
    return [[x + dx, y + dy], [x + width - dx, y + dy], [x + width - dx, y + height - dy],
            [x + dx, y + height - dy]].map(([u, v]) => new DOMPoint(u, v).matrixTransform(m));
  };
  const apart = (a, b) => [[a, 0], [a, 1], [b, 0], [b, 1]].some(([of, k]) => {
    const side = [of[k + 1].x - of[k].x, of[k + 1].y - of[k].y];
    const [p, q] = [a, b].map(o => o.map(c => c.x * side[0] + c.y * side[1]));
    return Math.max(...p) <= Math.min(...q) || Math.max(...q) <= Math.min(...p);
  });
  const found = [];
  for (const plot of document.querySelectorAll(".js-plotly-plot")) {
    const frame = plot.getBoundingClientRect();
    const texts = Array.from(plot.querySelectorAll("svg text")).filter(
      t => t.textContent.trim() && !t.closest(".modebar") && t.getBoundingClientRect().width > 0);
    const boxes = texts.map(t => ({ text: t.textContent, at: t.getBoundingClientRect(),
                                    of: corners(t) }));
    boxes.forEach((a, i) => {
      if (a.at.left < frame.left - 1 || a.at.right > frame.right + 1
          || a.at.top < frame.top - 1 || a.at.bottom > frame.bottom + 1)
        found.push("cut: " + a.text);
      for (const b of boxes.slice(i + 1))
        if (!apart(a.of, b.of)) found.push(a.text + " over " + b.text);
    });
    const bar = plot.querySelector(".legend .scrollbar");
    if (bar && bar.getBoundingClientRect().width > 0) found.push("names to be scrolled");
    for (const axis of ["x", "y"]) {
      const ticks = Array.from(plot.querySelectorAll(`g.${axis}tick text`));
      const seen = ticks.filter(t => t.getBoundingClientRect().width > 0);
      if (ticks.length > 1 && seen.length < 2) found.push("no scale of " + axis);
    }
  }
  return found;
}"""


@pytest.mark.parametrize("width", [WIDE, NARROW])
def test_names_of_a_chart_are_whole_and_apart(
    browser: Any, reports: Path, tmp_path: Path, width: int
) -> None:
    names = [f"curve {k}, whose name is longer than half of a screen is wide" for k in range(9)]
    x = np.geomspace(0.02, 0.2, 9)
    title = "a quantity with a name as long as that, over the same of another one [-]"
    curves = [trace(name, x, x**k) for k, name in enumerate(names)]
    few = [trace("one", np.geomspace(1.0, 1e9, 9), x), trace("other", 2.0 * x, x)]
    items = [chart("Many", curves, title, "y [-]", "xy"), chart("Few", few, title, "y [m]", "x")]
    places = {f"a place whose name is {word} of a screen": 1.0 for word in ("half", "most", "all")}
    items.append(bars("Beside", {"one": places, "other": places}, title, 1e-3))
    for low, high in ((2e3, 1.1e4), (2e3, 1e5), (-1.1e4, 0.9e4), (3.1e7, 3.7e7)):
        line = [trace("one", np.linspace(low, high, 5), np.arange(5.0))]
        items.append(chart("Numbers", line, "x [N]", "y [m], " * 12, "x" * (low > 0)))
        items.append(chart("Plain", line, "x [N]", "y [m]"))
    named = [trace("one", [0.0, 1.0], [0.0, -1.0])]
    items.append(chart("Named", named, "a title as wide as the chart is, about", ""))
    axis = {"tickvals": [0, -1], "ticktext": list(places)[:2], "automargin": True}
    items[-1].figure["layout"]["yaxis"] = axis
    content = results("plain", sections=[Section(title="Charts", items=items)])
    (tmp_path / "results.json").write_text(content.model_dump_json(), "utf-8")
    write_page(tmp_path)
    with Opened(browser, tmp_path / "report.html", width) as opened:
        assert opened.page.evaluate(LABELS) == []
        assert opened.said == []


def test_the_head_of_a_long_list_stays_in_sight(browser: Any, reports: Path) -> None:
    with Opened(browser, reports / "checks.html") as opened:
        opened.page.set_viewport_size({"width": WIDE, "height": 160})
        opened.page.evaluate("window.scrollTo(0, document.body.scrollHeight)")
        top = "document.querySelector('.listing thead th').getBoundingClientRect().top"
        assert opened.page.evaluate("window.scrollY") > 100
        assert opened.page.evaluate(top) == pytest.approx(0.0, abs=1.0)


def test_what_is_to_be_typed_is_copied(browser: Any, reports: Path) -> None:
    with Opened(browser, reports / "group/one/report.html") as opened:
        page = opened.page
        page.click("button[data-copies='command']")
        page.wait_for_selector("button:text('copied')")
        # what a user would paste
        page.evaluate("document.body.append(document.createElement('textarea'))")
        page.focus("textarea")
        page.keyboard.press("Control+V")
        pasted = page.input_value("textarea")
        assert pasted == "fe-drivetrain run group/one --quick"
        assert page.is_visible("#scene")


def test_a_table_is_saved_with_all_its_digits(browser: Any, reports: Path) -> None:
    with Opened(browser, reports / "group/one/report.html") as opened:
        with opened.page.expect_download() as download:
            opened.page.click("button[data-saves]")
        text = Path(download.value.path()).read_text("utf-8-sig")
    head, *rows = csv.reader(io.StringIO(text))
    assert head[:2] == ["name", "column 0 [kN\u00a0m]"]
    assert rows[0][0] == 'first, "quoted"'
    assert [float(cell) for cell in rows[0][1:]] == [k / 7.0 for k in range(14)]


@pytest.mark.parametrize("name", ["index.html", "group/one/report.html"])
def test_all_that_can_be_pressed_is_reached_by_the_keyboard(
    browser: Any, reports: Path, name: str
) -> None:
    kinds = ("a[href]", "button", "input", "select", "summary", "[tabindex='0']")
    every = ", ".join(f"main {kind}" for kind in kinds)
    found = f'Array.from(document.querySelectorAll("{every}"))'
    can = f"{found}.filter(e => e.checkVisibility() && !e.disabled)"
    with Opened(browser, reports / name) as opened:
        page = opened.page
        expected = page.evaluate(f"{can}.length")
        assert expected > 10
        reached = 0
        for _ in range(3 * expected):
            page.keyboard.press("Tab")
            seen = page.evaluate(
                f"(() => {{ const e = document.activeElement; return {can}.includes(e) && !e.seen"
                " ? (e.seen = true, getComputedStyle(e).outlineStyle) : null; })()"
            )
            if seen is not None:
                reached += 1
                assert seen != "none"
            if reached == expected:
                break
        assert reached == expected


def test_charts_take_the_colours_of_the_page_and_of_paper(browser: Any, reports: Path) -> None:
    back = "document.querySelector('.main-svg').style.background"
    with Opened(browser, reports / "group/one/report.html", scheme="dark") as opened:
        assert opened.page.evaluate(back) == "rgb(20, 25, 31)"
        opened.page.evaluate("window.dispatchEvent(new Event('beforeprint'))")
        assert opened.page.evaluate(back) in ("white", "rgb(255, 255, 255)")
        width = "document.querySelector('.main-svg').getBoundingClientRect().width"
        assert opened.page.evaluate(width) == 680
        opened.page.evaluate("window.dispatchEvent(new Event('afterprint'))")
        opened.page.emulate_media(color_scheme="light")
        opened.page.wait_for_selector(".main-svg[style*='white'], .main-svg[style*='255']")


def test_error_bars_are_seen_on_dark(browser: Any, reports: Path, tmp_path: Path) -> None:
    curve = trace("one", [0.0, 1.0], [0.0, 1.0])
    curve["error_y"] = {"type": "data", "array": [0.1, 0.2]}
    items = [chart("Bands", [curve], "x [m]", "y [m]")]
    content = results("plain", sections=[Section(title="Charts", items=items)])
    (tmp_path / "results.json").write_text(content.model_dump_json(), "utf-8")
    write_page(tmp_path)
    stroke = "getComputedStyle(document.querySelector('path.yerror')).stroke"
    for scheme, light in (("dark", True), ("light", False)):
        with Opened(browser, tmp_path / "report.html", scheme=scheme) as opened:
            parts = [int(x) for x in re.findall(r"\d+", opened.page.evaluate(stroke))[:3]]
            assert (min(parts) > 200) == light


def test_a_page_without_the_program_of_the_charts_says_so(
    browser: Any, reports: Path, tmp_path: Path
) -> None:
    (tmp_path / "report.html").write_bytes((reports / "group/one/report.html").read_bytes())
    context = browser.new_context()
    page = context.new_page()
    page.goto((tmp_path / "report.html").as_uri() + "#section-1")
    assert plotly_file().partition("-")[0] in page.inner_text(".chart >> nth=0")
    assert page.is_visible("text=The chart needs the file")
    context.close()


def test_a_model_is_turned_cut_coloured_and_read(browser: Any, reports: Path) -> None:
    with Opened(browser, reports / "group/one/report.html") as opened:
        page = opened.page
        canvas = page.locator(".solid canvas")
        canvas.scroll_into_view_if_needed()
        seen = [canvas.screenshot()]

        def changes() -> None:
            seen.append(canvas.screenshot())
            assert seen[-1] != seen[-2]

        box = canvas.bounding_box()
        middle = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
        read = page.locator(".solid > output")
        page.mouse.click(*middle)
        assert re.fullmatch(
            r"(main bearing|main bearing.housing|shaft) at x .* m: displacement [\d.]+ mm, "
            r"von Mises stress [\d.]+ MPa",
            read.inner_text(),
        )
        assert page.input_value("input[aria-label='most value of the colours']") != "1"
        page.select_option(".controls select >> nth=1", label="von Mises stress")
        changes()
        page.fill("input[aria-label='most value of the colours']", "1")
        page.keyboard.press("Enter")
        changes()
        page.select_option(".controls select >> nth=1", label="part")
        changes()
        before = page.locator(".controls > output").inner_text()
        page.select_option(".controls select >> nth=0", label="0.3 MN m about x")
        changes()
        assert page.locator(".controls > output").inner_text() != before  # its own scale
        assert read.inner_text() == "Click on the model to read a value."
        page.locator(".controls input[type=range] >> nth=0").fill("3")
        changes()
        page.select_option(".controls select >> nth=2", label="x")
        changes()
        page.mouse.move(*middle)
        page.mouse.down()
        page.mouse.move(middle[0] + 80, middle[1] + 20)
        page.mouse.up()
        changes()
        canvas.focus()
        for key in ("ArrowLeft", "+"):
            page.keyboard.press(key)
            changes()
        for part in page.locator(".controls input[type=checkbox]").all():
            part.uncheck()
        changes()
        page.keyboard.press("Enter")
        assert page.locator(".for-paper").count() == 1
        assert not page.locator(".for-paper").is_visible()
        canvas.focus()
        page.keyboard.press("Enter")
        assert read.inner_text() == "There is nothing at that point."
        page.emulate_media(media="print")
        assert page.locator(".for-paper").is_visible()
        assert not canvas.is_visible()
        assert opened.said == []


def test_the_largest_displacement_is_read_where_it_is(browser: Any, reports: Path) -> None:
    """The hub's end of the shaft moves most, and the base of the housing not at all."""
    with Opened(browser, reports / "group/one/report.html") as opened:
        page = opened.page
        canvas = page.locator(".solid canvas")
        canvas.scroll_into_view_if_needed()
        largest = float(page.input_value("input[aria-label='most value of the colours']"))
        box = canvas.bounding_box()
        found = []
        for k in range(2, 30):
            page.mouse.click(box["x"] + box["width"] * k / 32.0, box["y"] + box["height"] * 0.6)
            text = page.locator(".solid > output").inner_text()
            if number := re.search(r"displacement ([\d.]+) mm", text):
                found.append(float(number[1]))
        assert max(found) <= largest * 1.005
        assert max(found) > 0.7 * largest
        assert min(found) < 0.2 * largest


def test_without_webgl_the_still_picture_stands_in(browser: Any, reports: Path) -> None:
    context = browser.new_context()
    page = context.new_page()
    page.add_init_script("HTMLCanvasElement.prototype.getContext = () => null")
    page.goto((reports / "group/one/report.html").as_uri() + "#section-2")
    assert page.locator("figure img[alt='Model under 1 MN']").is_visible()
    assert not page.locator(".solid").is_visible()
    context.close()
