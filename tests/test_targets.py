"""Checks and targets carry the unit of their quantity, and it says what kind of quantity it is."""

import pytest

from fe_drivetrain.compare.convergence import band_of
from fe_drivetrain.report.charts import bars, trace
from fe_drivetrain.suite.page import Page
from fe_drivetrain.suite.records import MeshSeries, goal
from fe_drivetrain.suite.targets import Target, order_of, split_unit, targets_of


@pytest.mark.parametrize(
    ("key", "parts"),
    [
        ("deflection of the end [mm]", ("deflection of the end", "mm")),
        ("K[0] of the joint [N m/rad]", ("K[0] of the joint", "N m/rad")),
        ("ratio", ("ratio", "")),
        ("entry K[0]", ("entry K[0]", "")),
    ],
)
def test_the_unit_is_what_stands_in_brackets_at_the_end(key: str, parts: tuple[str, str]) -> None:
    assert split_unit(key) == parts


def test_a_quantity_with_its_unit_is_judged_as_one_whose_unit_is_given() -> None:
    page = Page()
    why, source = "round-off", "theory"
    page.equals("sag [mm]", 1.0, 1.1, within=0.2, why=why, source=source)
    page.equals(
        "sag", 1.0, 1.1, within=0.2, why=why, source=source, unit="mm", measure="deflection"
    )
    page.meets(1.0, Target("sag [mm]", 1.1, 0.2, why, source))
    first, *others = page.verdicts
    assert first.unit == "mm"
    assert first.measure == "deflection"
    assert others == [first, first]


def test_an_identity_stays_one_whatever_its_unit() -> None:
    page = Page()
    page.vanishes("moment about the centre [N m]", 0.0, within=1e-9, why="a sphere", source="it")
    assert page.verdicts[0].measure == "identity"


def test_a_sweep_shows_several_quantities_of_each_group() -> None:
    rows = [
        {"part": part, "x": x, "a": x, "b": None if x == 2 else 2 * x}
        for part in ("one", "two")
        for x in (1, 2)
    ]
    page = Page()
    page.sweep("sweep", rows, "x", {"a": "first", "b": "second"}, by="part", axis="y [-]")
    figure = page.sections[0].items[0].figure  # type: ignore[union-attr]
    curves = {curve["name"]: (curve["x"], curve["y"]) for curve in figure["data"]}
    # a record without a value has no point
    assert curves == {
        f"{part}, {name}": points
        for part in ("one", "two")
        for name, points in (("first", ([1, 2], [1, 2])), ("second", ([1], [2])))
    }
    assert figure["layout"]["yaxis"]["title"]["text"] == "y [-]"
    assert page.figures["sweep"] == rows


def test_bars_on_a_logarithmic_axis_end_at_the_least_that_is_shown() -> None:
    found = bars("errors", {"small": {"a": 0.0, "b": 1e-3}}, "error", least=1e-6).figure
    (of,) = found["data"]
    assert dict(zip(of["y"], of["x"], strict=True)) == {"a": 1e-6, "b": 1e-3}
    assert found["layout"]["xaxis"]["type"] == "log"


def a_series() -> MeshSeries:
    return MeshSeries([{"n": n, "sag [mm]": 1.0 - n**-2.0, "gap": n**-2.0} for n in (1, 2, 4)], "n")


def test_a_target_of_zero_is_a_check_that_something_vanishes() -> None:
    page = Page()
    page.meets(1e-9, Target("gap", 0.0, 1e-8, "round-off", "theory"), of="ring")
    verdict = page.verdicts[0]
    assert (verdict.check, verdict.quantity, verdict.measure) == (
        "vanishes",
        "ring: gap",
        "identity",
    )
    assert verdict.passed
    assert not verdict.relative


def test_what_is_allowed_goes_by_the_first_words_that_stand_in_a_key() -> None:
    values = {"hoop stress [MPa]": 3.0, "pressure [MPa]": 2.0}
    hoop, pressure = targets_of(
        values, {"stress": (0.1, "recovered"), "": (0.01, "fourth order")}, "Lame"
    )
    assert hoop == Target("hoop stress [MPa]", 3.0, 0.1, "recovered", "Lame")
    assert pressure == Target("pressure [MPa]", 2.0, 0.01, "fourth order", "Lame")
    with pytest.raises(ValueError, match=r"'pressure \[MPa\]' has none of the words 'stress'"):
        targets_of(values, {"stress": (0.1, "recovered")}, "Lame")


def test_what_is_allowed_of_an_order_is_of_the_order_itself() -> None:
    page = Page()
    for found in (3.6, 4.4, 3.4):
        page.meets(found, order_of("order", 4.0, 0.5, "coarse meshes", "theory"))
    assert [verdict.passed for verdict in page.verdicts] == [True, True, False]
    assert {verdict.measure for verdict in page.verdicts} == {"order"}


def test_a_target_keeps_what_its_value_rests_on() -> None:
    page = Page()
    page.meets(1.0, Target("gap", 1.0, 0.1, "digits", "a program", basis="second-hand"))
    assert page.verdicts[0].basis == "second-hand"


def test_the_band_is_of_all_meshes_or_the_change_from_the_one_before() -> None:
    page, series = Page(), a_series()
    sag = Target("sag [mm]", 1.0, 0.1, "mesh", "theory", order=2.0)
    page.finest(series, sag, of="shaft")
    page.settled(series, sag, of="shaft")
    by_order, by_change = page.verdicts
    assert by_order.quantity == by_change.quantity == "shaft: sag"
    # a quarter of the last change is left, and 1.25 of that is the band (Roache 1994)
    assert by_change.band == pytest.approx(3 / 16)
    assert by_order.band == pytest.approx(1.25 * (3 / 16) / 3)


def test_a_series_of_meshes_shows_its_order() -> None:
    assert a_series().order("sag [mm]") == pytest.approx(2.0)


def test_of_two_meshes_the_band_is_three_times_what_is_missing() -> None:
    assert band_of([1.0, 0.5], [0.0, 0.75], order=2.0) == pytest.approx(3 * 0.25)


def test_a_chart_without_points_is_a_sentence() -> None:
    page = Page()
    page.chart("Mass of all", [trace("none", [], [])], "x", "y")
    assert page.sections[0].items[0].kind == "text"


@pytest.mark.parametrize(
    ("measured", "bound", "reached"),
    [
        (1.0, {"most": 1.0}, "yes"),
        (1.1, {"most": 1.0}, "no"),
        (1.1, {"least": 1.0}, "yes"),
        (0.9, {"least": 1.0}, "no"),
        (float("nan"), {"most": 1.0}, "no"),
        (None, {"least": 1.0}, "no"),
    ],
)
def test_a_goal_is_reached_at_its_bound_and_never_unmeasured(
    measured: float | None, bound: dict[str, float], reached: str
) -> None:
    assert goal("time [s]", measured, **bound)["reached"] == reached


def test_a_goal_has_one_bound() -> None:
    with pytest.raises(TypeError, match="either most or least"):
        goal("time [s]", 1.0, most=1.0, least=0.5)
