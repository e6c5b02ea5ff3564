"""Studies as functions: what a result holds, and how it goes into JSON, tables and charts."""

import dataclasses
import json
import math
from typing import Any

import pytest
from coarse_scenes import coarse_scene
from test_commands_life import write_history

from fe_drivetrain.common import InputError
from fe_drivetrain.histories import Site
from fe_drivetrain.scene import change_scene, library_scene
from fe_drivetrain.studies import (
    CheckResult,
    CompareResult,
    LifeResult,
    Result,
    check,
    compare,
    life,
)
from fe_drivetrain.studies.design_comparison import Varied


@pytest.fixture(scope="module")
def checked() -> CheckResult:
    return check(coarse_scene("bonded"))


@pytest.fixture(scope="module")
def compared() -> CompareResult:
    scene, key, values = coarse_scene("bonded"), "gearbox.weight", (1e5, 2e5)
    designs = {f"{value:g}": change_scene(scene, {key: value}) for value in values}
    return compare(designs, tolerance=0.5, varied=Varied(key, values))


@pytest.fixture(scope="module")
def lived(tmp_path_factory: pytest.TempPathFactory) -> LifeResult:
    folder = tmp_path_factory.mktemp("histories")
    for wind in (8.0, 14.0):
        write_history(folder / f"v{wind:g}.csv", wind)
    return life(library_scene("main_bearing_spherical"), folder / "*.csv", Site(8.5))


@pytest.fixture(params=["checked", "compared", "lived"])
def result(request: pytest.FixtureRequest) -> Result:
    found: Result = request.getfixturevalue(request.param)
    return found


def test_the_json_of_a_result_is_strict_and_names_its_schema(result: Result) -> None:
    def refuse(constant: str) -> Any:
        raise AssertionError(constant)

    found = json.loads(result.to_json(), parse_constant=refuse)
    assert found["schema"] == f"fe-drivetrain/{result.STUDY}/{result.SCHEMA_VERSION}"
    assert [one["hash"] for one in found["drivetrains"]] == [d.hash for d in result.drivetrains]
    assert found["answer"] == list(result.answer)
    assert len(found["checks"]) == len(result.checks)
    assert found["tables"].keys() == result.all_tables().keys() >= result.tables.keys()


def test_a_result_cannot_be_changed_and_prints_in_one_line(result: Result) -> None:
    with pytest.raises(dataclasses.FrozenInstanceError):
        result.answer = ()  # type: ignore[misc]
    assert "\n" not in repr(result)
    assert len(repr(result)) < 200


def test_a_result_is_drawn_by_plotly(result: Result) -> None:
    figure = result.plot()
    assert figure.layout.title.text
    assert len(figure.data) > 0
    assert len(figure.data[0].x) > 0


def test_a_result_has_frames_of_its_figures_and_tables(result: Result) -> None:
    pytest.importorskip("pandas")
    assert len(result.to_frame()) == len(result.figures)
    with pytest.raises(InputError, match="is no table: choose of"):
        result.to_frame("nosuch")


def test_masses_and_costs_are_numbers(checked: CheckResult) -> None:
    assert checked.mass == pytest.approx(float(checked.model.mass.sum()))
    assert [row["unknowns"] for row in checked.tables["levels"]] == [
        one.unknowns for one in checked.costs
    ]
    assert all(math.isfinite(one.seconds) for one in checked.costs)


def test_a_figure_is_found_by_its_name(compared: CompareResult) -> None:
    for figure in compared.figures:
        assert compared[figure.quantity] is figure
    with pytest.raises(KeyError, match="is no figure of this result; its figures are:"):
        compared["nosuch"]


def test_what_differs_between_designs_is_named(compared: CompareResult) -> None:
    assert compared.inputs == {"200000": [("gearbox.weight", 1e5, 2e5)]}


def test_a_life_is_a_number_with_what_takes_it(lived: LifeResult) -> None:
    (one,) = lived.bearings.values()
    years = one.years["L10mr"]
    assert lived["L10mr of bearing main_bearing"].computed == years
    assert one.site is not None
    turns = one.million_revolutions["L10mr"] / one.damage.turns * 1e6  # in a year at the site
    assert turns == pytest.approx(years, rel=1e-12)
    assert one.damage.of_rows(True).sum() == pytest.approx(1.0 / years, rel=1e-9)
    assert one.site.of_winds("L10mr").sum() == pytest.approx(1.0)
    whole = sum(f.damage.seconds for f in one.files)
    mean = one.mean_load.mean(axis=1)
    assert whole == pytest.approx(20.0)
    assert (one.peak_load.max(axis=1) >= mean).all()


def test_tables_of_lives_by_file_and_place_are_frames(lived: LifeResult) -> None:
    pytest.importorskip("pandas")
    assert list(lived.to_frame("files")["file"]) == ["v14.csv", "v8.csv"]
    places, rings = lived.to_frame("places"), lived.to_frame("main_bearing: rows and rings")
    (one,) = lived.bearings.values()
    by_place = places["outer ring, damage by L10mr"].sum()
    outer = rings[rings["ring"] == "outer"]["share of L10mr's damage [%]"].sum()
    assert by_place * one.years["L10mr"] == pytest.approx(0.01 * outer, rel=1e-9)
