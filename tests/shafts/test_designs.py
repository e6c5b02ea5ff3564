"""Designs side by side: what changes, by how much, and which level says so."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from coarse_scenes import coarse_scene

from fe_drivetrain.command_line.app import main
from fe_drivetrain.command_line.designs import parse_values
from fe_drivetrain.command_line.studies import run_on_scene
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.reading import change_scene
from fe_drivetrain.drivetrain_file.units import unit_of_key
from fe_drivetrain.pages.compare import why_solid
from fe_drivetrain.report.results import Chart, read_results
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.shafts.fidelity import designs as designs_module
from fe_drivetrain.shafts.fidelity.change_bands import OnMeshes, OnSprings, change_band
from fe_drivetrain.shafts.fidelity.designs import Difference, Value, compare_designs, scene_changes
from fe_drivetrain.shafts.fidelity.ladder import assembly_level
from fe_drivetrain.shafts.fidelity.quantity import Quantity
from fe_drivetrain.studies import compare
from fe_drivetrain.studies.design_comparison import level_two_error

pytestmark = pytest.mark.usefixtures("kept_between_runs")

BORE = "shaft.sections.0.inner_diameter"
#: What level 2 knows of a coarse scene.
ENOUGH = 0.5


@pytest.fixture(scope="module")
def found() -> dict[str, Difference]:
    """A bored shaft against a solid one, by name of the quantity."""
    solid = coarse_scene("spherical")
    designs = {"solid": solid, "bored": change_scene(solid, {BORE: 0.25}), "same": solid}
    names = ("hub.stiffness.ry", "hub.stiffness.rx", "gearbox.Mx", "main_bearing.Fz")
    return {d.quantity.name: d for d in compare_designs(designs, [*map(Quantity, names)], ENOUGH)}


def test_a_bored_shaft_gives_way(found: dict[str, Difference]) -> None:
    for name in ("hub.stiffness.ry", "hub.stiffness.rx"):
        bored, same = found[name].changes
        assert -0.5 < bored < 0.0
        assert same == 0.0
    # of torsion, the shaft between its ends is all that changes
    left = 1.0 - (0.25 / coarse_scene("bonded").shaft.sections[0].outer_diameter) ** 4
    assert found["hub.stiffness.rx"].changes[0] == pytest.approx(left - 1.0, rel=0.2)


def test_what_statics_decides_does_not_change(found: dict[str, Difference]) -> None:
    torque = found["gearbox.Mx"]
    assert [value.level for value in torque.values] == [0, 0, 0]
    assert not torque.bands.any()
    assert not torque.changes.any()
    assert not torque.is_known


def test_errors_that_two_designs_have_in_common_cancel(found: dict[str, Difference]) -> None:
    """At level 2, with the assembly of both for the truth."""
    stiffness = found["hub.stiffness.ry"]
    first, bored, _ = stiffness.values
    both = (first.band * abs(first.size) + bored.band * abs(bored.size)) / abs(first.size)
    assert 0.0 < stiffness.bands[0] < both
    assert stiffness.bands[1] == 0.0  # the same design
    solid = coarse_scene("spherical")
    of = Quantity("hub.stiffness.ry")
    exact = [
        of.of(assembly_level(scene), scene.shaft.length)[0]
        for scene in (solid, change_scene(solid, {BORE: 0.25}))
    ]
    change = exact[1] / exact[0] - 1.0
    assert abs(stiffness.changes[0] - change) < stiffness.bands[0]


def series(values: list[float], recovered: float, factors: tuple[float, ...]) -> OnMeshes:
    sizes = tuple(0.1 * f for f in factors)
    return OnMeshes(sizes, tuple(np.array([v]) for v in values), np.array([recovered]), factors)


def test_the_change_of_nearly_equal_designs_has_the_band_of_the_change() -> None:
    """Both converge from 4 % above as h^2; their change of -3.9 % does so as well."""
    factors = (1.8, 1.35, 1.0)
    errors = [0.04 * f**2 for f in factors]
    one, other = (series([v * (1.0 + e) for e in errors], 0.04 * v, factors) for v in (1.0, 0.961))
    whole = one.half_width + other.half_width
    band = change_band(one, other, (one.values[-1][0], other.values[-1][0]))
    assert band is not None
    error = abs((other.values[-1] - one.values[-1])[0] + 0.039)
    assert error < band < 0.1 * whole
    # meshes that scatter by themselves do not cancel
    shaken = series(
        [1.0 + e + s for e, s in zip(errors, (0, 0.02, -0.02), strict=True)], 0.04, factors
    )
    scattered = change_band(shaken, other, (1.0, 0.961))
    assert scattered is not None
    assert scattered > 0.02


def test_designs_that_differ_much_have_the_bands_of_both() -> None:
    factors = (1.8, 1.35, 1.0)
    one, other = (series([v * (1.0 + 0.04 * f**2) for f in factors], 0.04, factors) for v in (1, 9))
    assert change_band(one, other, (1.0, 9.0)) == pytest.approx(
        one.half_width + other.half_width, rel=0.2
    )
    # one mesh alone says nothing of its scatter, and levels have nothing in common
    alone = [series([v], 0.04, (1.0,)) for v in (1.0, 0.9)]
    assert change_band(*alone, (1.0, 0.9)) is None
    assert change_band(one, OnSprings(*np.ones((3, 1))), (1.0, 1.0)) is None


def test_meshes_too_near_for_a_series_show_their_scatter() -> None:
    """Sizes of walls decide: what is recovered cancels, what the meshes do by chance does not."""
    near = (1.02, 1.01, 1.0)
    one, other = series([1.020, 1.016, 1.018], 0.02, near), series([0.98, 0.98, 0.98], 0.019, near)
    assert one.band.series != one.band.series  # there is none
    band = change_band(one, other, (1.018, 0.98))
    assert band is not None
    # the difference of what is recovered, and 1.25 times 0.002 of scatter, and 4 % of both bands
    assert 0.0025 < band < 0.3 * (one.half_width + other.half_width)
    still = series([1.018] * 3, 0.02, near)  # the same mesh thrice says nothing of scatter
    assert change_band(still, other, (1.018, 0.98)) is None


def test_meshes_of_unlike_sizes_have_little_in_common() -> None:
    factors = (1.8, 1.35, 1.0)
    one, other = (
        series([v * (1 + 0.04 * f**2) for f in factors], 0.04, factors) for v in (1, 0.99)
    )
    bands = []
    for shrunk in (1.0, 0.97, 0.5):
        sizes = tuple(shrunk * h for h in other.sizes)
        bands.append(change_band(one, replace(other, sizes=sizes), (1.04, 1.03)))
    like, nearly, unlike = bands
    assert like is not None
    assert nearly is not None
    whole = one.half_width + other.half_width
    assert nearly - like == pytest.approx((1.0 / 0.97**2 - 1.0) * whole, rel=0.05)
    assert unlike == pytest.approx(whole, rel=0.01)


def test_only_meshes_that_both_designs_have_make_a_series() -> None:
    """A mesh that the thinner wall cannot have is left out of both."""
    three = series([1.13, 1.07, 1.04], 0.04, (1.8, 1.35, 1.0))
    two = series([0.97, 0.94], 0.04, (1.35, 1.0))
    change = two - three
    assert change.factors == (1.35, 1.0)
    assert [v[0] for v in change.values] == pytest.approx([-0.1, -0.1])


def test_known_changes_come_first(found: dict[str, Difference]) -> None:
    order = [(not one.is_known, -one.ranks.max()) for one in found.values()]
    assert order == sorted(order)


def test_a_page_says_why_a_quantity_needs_solids(
    found: dict[str, Difference], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where level 2 is not enough, by its own two parts; the better value stands in for solids."""

    def better(
        report: object, name: str, scene: object, quantities: Any, near: object
    ) -> dict[str, Value]:
        return {one.name: Value(np.ones(1), 1e-3, 4) for one in quantities}

    monkeypatch.setattr(designs_module, "_as_assembly", better)
    solid = coarse_scene("spherical")
    designs = {"solid": solid, "bored": change_scene(solid, {BORE: 0.25})}
    (one,) = compare_designs(designs, [Quantity("hub.stiffness.ry")], 1e-3)
    before = found["hub.stiffness.ry"].values
    bands = [value.band for value in before[:2]]
    assert [sum(value.cheaper or ()) for value in one.values] == pytest.approx(bands)
    assert max(bands) > 1e-3
    worst = int(np.argmax(bands))
    text = why_solid(level_two_error(one, list(designs)), 1e-3)
    said = f"level 2 may be wrong by {100 * bands[worst]:.2g} % in {list(designs)[worst]}"
    assert (
        f"hub.stiffness.ry needs level 4, since {said}, and the change by more than 0.1 %" in text
    )
    housing, shaft = before[worst].cheaper or (0.0, 0.0)
    assert ("beam and meridian" in text) == (shaft >= housing)
    assert found["gearbox.Mx"].values[0].cheaper is None


def test_a_change_from_zero_is_all_of_the_larger() -> None:
    quantity = Quantity("main_bearing.My", np.ones(10))
    one = Difference(quantity, (Value(np.zeros(1), 0.0, 2), Value(np.array([3.0]), 0.1, 2)))
    assert np.isinf(one.changes).all()
    assert one.ranks == pytest.approx([1.0])
    assert one.rank_bands == pytest.approx([0.1])


def test_a_band_is_not_that_of_a_value_which_is_round_off() -> None:
    nothing = Value(np.array([2e-11]), 3.8, 4, (0.01, 0.01))
    load = Value(np.array([5e3]), 0.002, 4, (0.02, 0.03))
    one = Difference(Quantity("main_bearing.My"), (nothing, load))
    assert level_two_error(one, ["a", "b"]).assembly == pytest.approx(0.2)
    both = Difference(Quantity("main_bearing.My"), (load, Value(load.values, 0.004, 4, (0, 0))))
    assert level_two_error(both, ["a", "b"]).assembly == pytest.approx(0.4)


def test_signs_are_those_of_a_growing_value() -> None:
    """From -2 to -3 a value grows by half, whatever its sign."""
    quantity = Quantity("main_bearing.Fz", np.ones(10))
    one = Difference(quantity, tuple(Value(np.array([v]), 0.0, 0) for v in (-2.0, -3.0, 2.0)))
    assert one.changes == pytest.approx([0.5, -2.0])


def test_scenes_differ_in_what_they_state() -> None:
    a = coarse_scene("bonded")
    assert scene_changes(a, a) == []
    assert scene_changes(a, change_scene(a, {BORE: 0.2})) == [(BORE, 0.0, 0.2)]


@pytest.mark.parametrize(
    ("text", "values"),
    [("a.b=1,2.5", (1.0, 2.5)), ("a.b=0:1:5", (0.0, 0.25, 0.5, 0.75, 1.0))],
)
def test_values_of_a_parameter(text: str, values: tuple[float, ...]) -> None:
    varied = parse_values(text)
    assert varied.key == "a.b"
    assert varied.values == values


@pytest.mark.parametrize("text", ["a.b", "a.b=", "=1,2", "a.b=1", "a.b=1,1", "a.b=1:2:99", "a=x,2"])
def test_what_are_no_values_is_said(text: str) -> None:
    with pytest.raises(InputError, match="--vary"):
        parse_values(text)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["two_bearings"], "nothing to compare two_bearings with"),
        (["two_bearings", "two_bearings"], "given twice"),
        (["two_bearings", "stepped_shaft", "--vary", "shaft.front=-1,-2"], "changes one scene"),
        (["two_bearings", "stepped_shaft", "--quantity", "front.Q"], "'front.Q' is unknown"),
        (["two_bearings", "main_bearing_bonded", "--quantity", "rear.Fz"], "'rear.Fz' is unknown"),
    ],
)
def test_what_cannot_be_compared_is_said(
    words: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["compare", *words])
    assert ended.value.code == 2
    assert message in capsys.readouterr().err


def test_the_command_shows_a_sweep(tmp_path: Any, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["--vary", f"{BORE}=0.1,0.25", "--quantity", "hub.stiffness.rx", "--tolerance", "50%"]
    settings = ["--set", "shaft.front=-1.0", "--set", "mesh.shaft=0.3"]
    with pytest.raises(SystemExit) as ended:
        main(["compare", "main_bearing_bonded", *words, *settings, "--out", str(tmp_path)])
    assert ended.value.code == 0
    verdict = capsys.readouterr().out.splitlines()[0]
    assert verdict.startswith("Stiffness of the hub about x changes most: -")
    assert verdict.endswith(f"% at {BORE} = 0.25 against 0.1.")
    assert "what changes with" in (tmp_path / "report.html").read_text()
    results = read_results(tmp_path / "results.json")
    (answer,) = results.answers
    assert (answer.quantity, answer.unit) == (
        "change of hub.stiffness.rx, 0.25 against 0.1",
        "%",
    )
    assert answer.computed < 0.0
    assert abs(answer.computed) > (answer.band or 0.0)
    (chart,) = [i for s in results.sections for i in s.items if isinstance(i, Chart)]
    assert chart.figure["layout"]["xaxis"]["title"]["text"] == f"{BORE} [m]"


@pytest.mark.parametrize(
    ("key", "unit"),
    [
        (BORE, "m"),
        ("shaft.front", "m"),
        ("bearing_units.main_bearing.housing.wall", "m"),
        ("gearbox.weight", "N"),
        ("gearbox.stiffness.1", "N/m"),
        ("gearbox.stiffness.5", "N m/rad"),
        ("materials.steel.youngs_modulus", "Pa"),
        ("materials.steel.poisson_ratio", ""),
        ("mesh.elements_per_turn", ""),
        ("bearing_units.nowhere.housing.wall", ""),
    ],
)
def test_a_value_of_a_scene_has_the_unit_that_it_is_read_in(key: str, unit: str) -> None:
    steel = {"materials.steel": {"youngs_modulus": 2e11, "poisson_ratio": 0.3, "density": 7850}}
    assert unit_of_key(change_scene(coarse_scene("bonded"), steel), key) == unit


def test_what_may_be_no_change_is_named() -> None:
    def two(name: str, after: float, band: float) -> Difference:
        values = tuple(Value(np.array([size]), band, 2) for size in (1.0, after))
        return Difference(Quantity(f"hub.stiffness.{name}"), values)

    known, open_ = two("rx", 0.9, 1e-3), two("ry", 0.97, 0.02)
    assert known.is_known
    assert not open_.is_known
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(
            "fe_drivetrain.studies.design_comparison.compare_designs", lambda *_: [known, open_]
        )
        result = compare(dict.fromkeys(("a", "b"), coarse_scene("bonded")))
    said = " ".join(result.details)
    assert "hub.stiffness.rx of b against a: -10 % ± 0.19 %" in said
    assert "The change of hub.stiffness.ry is smaller than its band: it may be zero." in said


def test_a_page_names_all_its_scenes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    class Nothing:
        result = None

        def __call__(self, run: Run, page: Page) -> None:
            page.answer("Which?", "None.", [])

    def said(*scenes: str) -> str:
        study: Any = Nothing()
        run_on_scene("compare", scenes, "Title", tmp_path, study)
        return str(read_results(tmp_path / "results.json").source)

    assert said("a/solid.yaml") == "the scene solid"
    assert said("a/solid.yaml", "b/bored.yaml") == "the scenes solid and bored"
    assert said("a/solid.yaml", "b/solid.yaml") == "the scenes a/solid.yaml and b/solid.yaml"
