"""Pages of the documentation: their blocks run, what they show is so, and their links lead on."""

import contextlib
import importlib.util
import re
import shlex
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from test_report import limit, results
from tiny_case import Result

from fe_drivetrain.cases.export.sample_elastodyn import TEXT
from fe_drivetrain.elasticity.mesh.measures import volume
from fe_drivetrain.export.formats.elastodyn import read_torsion

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
sys.path.insert(0, str(DOCS))

import house  # noqa: E402
from result_pages import limits_page  # noqa: E402

pytestmark = pytest.mark.usefixtures("kept_between_runs")

PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted(DOCS.glob("**/*.md"))]
PAGES = [page for page in PAGES if "generated" not in page.parts]

BLOCK = re.compile(r"^```(\w*).*?\n(.*?)^```", re.DOTALL | re.MULTILINE)

Names = dict[str, Any]
Runner = Callable[[str], Names]


@pytest.fixture
def run_page(invoke: Callable[..., Result]) -> Runner:
    """Run the shell and Python blocks of a page in order in one empty folder."""

    def run(page: str) -> Names:
        names: Names = {}
        text = (DOCS / page).read_text(encoding="utf-8")
        for kind, block in BLOCK.findall(text):
            if kind == "python":
                with contextlib.redirect_stdout(None):
                    exec(compile(block, page, "exec"), names)
            if kind != "sh":
                continue
            for line in block.replace("\\\n", " ").splitlines():
                words = shlex.split(line, comments=True)
                if words[:1] == ["fe-drivetrain"]:
                    status, _, error = invoke(*words[1:])
                    assert status == 0, error
                elif words:
                    subprocess.run(["sh", "-euc", line], check=True)
        return names

    return run


def test_the_tutorial_ends_with_a_free_shaft_in_two_programs_forms(
    run_page: Runner, tmp_path: Path
) -> None:
    names = run_page("tutorial.md")
    shaft, unit = names["shaft"], names["unit"]
    assert np.abs(names["moved_rigidly"]).max() < 1e-12 * np.abs(shaft.stiffness).max()
    # statics: hub at -0.85 m, gearbox at 1.8 m, about the bearing
    assert names["reaction"][0, 2] == pytest.approx((0.85 * 3e5 - 5e5) / 1.8, rel=1e-9)
    assert np.allclose(unit.stiffness[3:], 0.0, atol=1e-9 * np.abs(unit.stiffness).max())
    assert (unit.stiffness.diagonal()[:3] > 0).all()
    assert (tmp_path / "shaft-dmig.bdf").is_file()
    assert (tmp_path / "reports/advise/mine/report.html").is_file()


def test_levels_agree_where_statics_decides(run_page: Runner) -> None:
    names = run_page("how-to/choosing-a-level.md")
    reference = names["statics_level"](names["scene"]).reaction_matrices["main_bearing"][2, 2]
    assert names["model"].level == 2
    assert names["model"].reaction_matrices["main_bearing"][2, 2] == pytest.approx(reference)


def test_a_series_of_second_order_is_found_so(run_page: Runner) -> None:
    found = run_page("how-to/reading-bands.md")["found"]
    assert (found.order, found.extrapolated) == pytest.approx((2.0, 1.0))


def test_own_loads_are_read_as_they_were_written(run_page: Runner, tmp_path: Path) -> None:
    history = run_page("how-to/own-loads.md")["history"]
    assert history.component("Mx").mean() == pytest.approx(1e6, rel=1e-3)
    assert history.component("My").max() == pytest.approx(3e5, rel=0.01)
    assert (tmp_path / "reports/mine/report.html").is_file()


def test_an_own_drivetrain_is_changed_without_editing(run_page: Runner, tmp_path: Path) -> None:
    names = run_page("how-to/own-drivetrain.md")
    bores = [names[scene].shaft.sections[0].inner_diameter for scene in ("scene", "bored")]
    assert bores == [0.0, 0.1]
    assert (tmp_path / "bored.csv").is_file()


def test_a_housing_from_step_stands_in_a_scene(run_page: Runner, tmp_path: Path) -> None:
    names = run_page("how-to/own-housing-from-step.md")
    for name in ("mine", "on_bedplate"):
        assert (tmp_path / f"reports/check/{name}/report.html").is_file()
    again = names["mesh_scene"](names["again"])
    own = names["mesh_scene"](names["scene"])
    assert volume(again) == pytest.approx(volume(own), rel=1e-12)


def test_reactions_moved_to_the_hub_are_the_hub_loads(run_page: Runner) -> None:
    names = run_page("how-to/hub-loads-to-reactions.md")
    assert np.allclose(names["at_hub"], names["hub_loads"].values, rtol=1e-9)
    # the tower carries the air's loads and the rotor's weight, by their levers about its axis
    tilt, mass = names["tilt"], names["mass"]
    c, s = np.cos(tilt), np.sin(tilt)
    level = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    front = np.array([names["scene"].shaft.front, 0, 0]) - names["top"]
    rotor = front - [names["ahead"], 0, 0]
    force, weight = level @ names["aero"][:3], 9.81 * mass * np.array([0, 0, -1])
    moment = level @ names["aero"][3:]
    moment = moment + np.cross(level @ front, force) + np.cross(level @ rotor, weight)
    exact = np.concatenate([force + weight, moment])
    assert np.allclose(names["on_tower"], exact, rtol=1e-9, atol=1e-9 * np.abs(exact).max())


def test_openfast_channels_become_turns_loads_and_cycles(run_page: Runner) -> None:
    names = run_page("how-to/openfast-to-spectra.md")
    turns = names["recorded"].rotor_speed.sum() * names["history"].step / (2 * np.pi)
    assert names["ldd"].amount.sum() == pytest.approx(turns)
    assert turns == pytest.approx(24.0, rel=0.03)  # 12 rpm for two minutes
    cycles = names["cycles"]
    assert names["markov"].sum() == pytest.approx(cycles.counts.sum())
    assert cycles.counts.sum() == pytest.approx(3.77 * 120 / (2 * np.pi), abs=1.0)
    size = 3e6 * (cycles.counts.sum() / 120) ** 0.1  # a sine of amplitude 1.5 MN m
    load = names["damage_equivalent_load"]([cycles], names["history"].seconds, slope=10.0)
    assert load == pytest.approx(size, rel=0.01)


def test_lives_of_the_page_are_in_order(run_page: Runner) -> None:
    years = run_page("how-to/bearing-life.md")["life"].years
    assert len(years) == 4
    assert all(value > 0 for value in years.values())
    # the moment is in L10r alone
    assert years["L10r"] < years["L10"]


def test_torque_of_each_shaft_keeps_the_power(run_page: Runner) -> None:
    names = run_page("how-to/shafts-of-a-gearbox.md")
    table, torques = names["table"], names["torques"]
    powers = [torques[s.name] * speed for s, speed in zip(table.shafts, table.speeds, strict=True)]
    assert powers == pytest.approx([387e3] * 4)
    assert names["shares"] == pytest.approx(1.0, abs=0.03)
    assert names["lumped"].frequencies[1] == pytest.approx(names["whole"].frequencies[1], rel=1e-3)
    series = sum(1 / (s.stiffness * n**2) for s, n in zip(table.shafts, table.speeds, strict=True))
    assert names["spring"] == pytest.approx(1 / series, rel=1e-9)


def test_a_drivetrain_in_time_carries_what_the_file_says(run_page: Runner) -> None:
    names = run_page("how-to/drivetrain-in-time.md")
    assert names["lost"].extremes["torque of HSS"].least_over_rated < 0.0
    assert names["torque"].runs[0].level.value == "torsional"
    driven = names["driven"]
    one = driven.extremes["torque of LSS"]
    # the file's torque swings by a tenth about 0.8 MN m
    assert one.most == pytest.approx(8.8e5, rel=0.02)
    assert one.least == pytest.approx(7.2e5, rel=0.02)
    # slow against the first mode with the generator held, which adds some hundredth to it
    assert driven.files["swing"].against_file < 0.02


def test_a_mean_load_counts_by_goodmans_line(run_page: Runner) -> None:
    names = run_page("how-to/mean-loads.md")
    assert names["corrected"] / names["as_counted"] == pytest.approx(20 / 15, rel=1e-3)
    hours = names["site"].hours(names["midpoint_edges"](names["winds"]))
    cycles = hours.sum() * 3600  # of a sine of 1 Hz, whose range goes with the wind
    ranges = 1e6 * np.array(names["winds"]) / 14.0
    assert cycles == pytest.approx((names["factors"] * 600.0).sum())
    size = (np.sum(hours * 3600 * ranges**10) / 1e7) ** 0.1
    assert names["lifetime"] == pytest.approx(size, rel=2e-3)


def test_planets_share_by_the_torque_and_teeth_vary_by_the_contact_ratio(run_page: Runner) -> None:
    names = run_page("how-to/planets-and-teeth.md")
    assert names["kinds"].count("planet") == 3
    assert names["kinds"].count("rotational") == 6
    assert names["sharing"][1e3] == pytest.approx(2.0, abs=1e-3)
    assert 1.0 < names["sharing"][1e5] < 1.2
    assert names["stiffness"][0] == pytest.approx(names["stiffness"][-1])


def test_clearance_raises_the_most_loaded_roller(run_page: Runner) -> None:
    names = run_page("how-to/bearing-clearance.md")
    peaks, zones = list(names["peaks"].values()), list(names["zones"].values())
    assert peaks[0] == pytest.approx(4.08 * 200e3 / 32, rel=0.005)
    assert peaks == sorted(peaks)
    assert zones == sorted(zones, reverse=True)
    assert names["tangent"][2, 2] > names["secant"][2, 2]
    assert abs((names["secant"] @ names["u"][0])[2]) == pytest.approx(200e3, rel=5e-3)


def test_plots_show_what_was_computed(run_page: Runner, tmp_path: Path) -> None:
    names = run_page("how-to/plots.md")
    assert len(names["over_time"].data) == len(names["on_bearing"].data) == 6
    forces = [trace.y for trace in names["beside"].data if trace.x[0] == "Fx"]
    assert np.sum(forces, axis=0) == pytest.approx([200.0, 0.0, -400.0], abs=1e-6)  # kN
    assert names["ladder"].data[-1].name == "tolerance"
    assert (tmp_path / "ring.html").stat().st_size > 1e5


def test_modes_bring_frequencies_down_to_those_of_the_shaft(run_page: Runner) -> None:
    errors = run_page("how-to/craig-bampton-modes.md")["errors"]
    for fewer, more in ((0, 4), (4, 8), (8, 16)):  # by Rayleigh: from above, never up again
        assert (errors[more] > -1e-6).all()
        assert (errors[more] <= errors[fewer] + 1e-9).all()
    assert errors[0][0] == pytest.approx(0.2, abs=0.01)
    assert errors[4][0] == pytest.approx(0.005, abs=0.001)


def test_a_housing_with_its_inertia_has_the_frequencies_of_the_solids(run_page: Runner) -> None:
    """Modes 5 to 8 move the housing; the others are those of a shaft on springs."""
    names = run_page("how-to/housing-inertia.md")
    whole = names["whole"]
    error, massless = names["found"] / whole - 1, names["massless"] / whole - 1
    assert np.abs(error[:4]).max() < 0.03
    assert np.abs(error[4:]).max() < 0.005
    assert massless[4:].round(3) == pytest.approx([0.162, 0.090, 0.119, 0.042], abs=0.002)
    assert names["element"].mass == pytest.approx(names["unit"].mass)


def test_all_that_turns_in_other_programs(run_page: Runner) -> None:
    Path("ElastoDyn.dat").write_text(TEXT)
    turning = run_page("how-to/turning-in-other-programs.md")["turning"]
    assert read_torsion("ElastoDyn_mine.dat").spring == pytest.approx(turning.spring.torsion.spring)
    one = turning.spring
    assert one.free == pytest.approx(one.free_of_two, rel=0.02)
    assert one.torsion.damper > 0.0


@pytest.mark.needs("exudyn", "ross")
def test_a_housing_in_ross_and_exudyn(run_page: Runner) -> None:
    names = run_page("how-to/housing-to-ross-and-exudyn.md")
    shaft, system = names["shaft"], names["system"]
    from fe_drivetrain.export import natural_frequencies

    supports = names["scene_supports"](names["scene"], names["units"])
    own = natural_frequencies(shaft.points, shaft.stiffness, shaft.mass, supports)
    assert system.frequencies()[:4] == pytest.approx(own[:4], rel=1e-6)
    assert names["rotor"].frequencies(1)[0] == pytest.approx(own[0], rel=0.05)
    masses = names["masses"]
    own = natural_frequencies(shaft.points, shaft.stiffness, shaft.mass, supports, masses)
    assert names["heavy_system"].frequencies()[:4] == pytest.approx(own[:4], rel=1e-6)
    assert names["heavy_rotor"].frequencies(1)[0] == pytest.approx(own[0], rel=0.05)


# --- links ---


def anchors(page: Path) -> set[str]:
    """Targets of a page's headings, as repository pages and the site make them."""
    text = BLOCK.sub("", page.read_text(encoding="utf-8"))
    titles = re.findall(r"^#+ (.+)$", text, re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles}


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.relative_to(ROOT).as_posix())
def test_links_lead_to_files_and_headings_that_are_there(page: Path) -> None:
    text = BLOCK.sub("", page.read_text(encoding="utf-8"))
    for target in re.findall(r"\]\(([^)\s]+)\)", text):
        if re.match(r"[a-z]+:", target):
            continue
        path, _, anchor = target.partition("#")
        to = (page.parent / path).resolve() if path else page
        assert to.exists(), target
        if anchor:
            assert anchor in anchors(to), target


def test_the_theory_names_modules_that_are_there() -> None:
    names = re.findall(r"`([^`]+)`", (DOCS / "theory.md").read_text(encoding="utf-8"))
    assert names
    for name in names:
        assert importlib.util.find_spec(f"fe_drivetrain.{name}"), name


#: Rooms that compute nothing of their own.
WITHOUT_THEORY = {
    "command_line",
    "common",
    "drivetrain_file",
    "pages",
    "plots",
    "report",
    "report.pictures",
    "report.suite",
}


def test_every_room_that_models_something_has_its_theory() -> None:
    text = (DOCS / "theory.md").read_text(encoding="utf-8")
    named = {house.folder_of(name) for name in re.findall(r"`([^`]+)`", text)}
    rooms = {house.folder_of(name) for name in house.modules() if name} - {"geometry"}
    without = {room for room in rooms if not room.startswith("cases")} - named
    assert without == WITHOUT_THEORY | {"bearing_life", "elasticity", "shafts", "turbine_loads"}


def test_limits_of_the_cases_are_collected_from_results() -> None:
    found = limit(low=2.0, high=None, parameter="samples in a *period*", beyond="it aliases")
    page = limits_page({"stability/one": (results("stability/one", limits=[found]), ROOT)})
    assert "1 limit of 1 case" in page
    assert "Safe from 2: samples in a \\*period\\*" in page
    assert "*Beyond:* it aliases" in page
    assert "built without results" in limits_page({"a/b": (results("a/b"), ROOT)})


def test_every_page_is_reached_from_the_index() -> None:
    index = (DOCS / "index.md").read_text(encoding="utf-8")
    for page in DOCS.glob("**/*.md"):
        name = page.relative_to(DOCS).as_posix()
        if "generated" not in page.parts and name != "index.md":
            assert f"({name})" in index, name
            assert f"\n{name.removesuffix('.md')}\n" in index, name
