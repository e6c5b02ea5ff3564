"""Studies as functions: what a result holds, and how it goes into JSON, tables and charts."""

import dataclasses
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from coarse_scenes import coarse_scene
from test_commands_life import write_history

from fe_drivetrain.common import InputError
from fe_drivetrain.histories import Site
from fe_drivetrain.hub_loads import LoadHistory, write_csv
from fe_drivetrain.scene import change_scene, library_scene
from fe_drivetrain.studies import (
    CheckResult,
    CompareResult,
    LifeResult,
    LoadOptions,
    LoadsResult,
    Result,
    check,
    compare,
    life,
    loads,
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
def loaded(tmp_path_factory: pytest.TempPathFactory) -> LoadsResult:
    """Three cycles of My of a range of 2 kN m, and noise."""
    file = tmp_path_factory.mktemp("loads") / "wave.csv"
    time = np.arange(301) * 0.1
    samples = np.random.default_rng(3).standard_normal((301, 6))
    samples[:, 4] = 1e3 * np.sin(2.0 * np.pi * time / 10.0)
    write_csv(LoadHistory("wave", time, samples), file)
    options = LoadOptions(slopes=(3.0, 5.0), rotor_speed=1.5, ultimate={"My": 1e6})
    return loads([file], options, scene=coarse_scene("bonded"))


@pytest.fixture(scope="module")
def lived(tmp_path_factory: pytest.TempPathFactory) -> LifeResult:
    folder = tmp_path_factory.mktemp("histories")
    for wind in (8.0, 14.0):
        write_history(folder / f"v{wind:g}.csv", wind)
    return life(library_scene("main_bearing_spherical"), folder / "*.csv", Site(8.5))


@pytest.fixture(params=["checked", "compared", "lived", "loaded"])
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


def test_equivalent_loads_are_those_of_a_sine(loaded: LoadsResult) -> None:
    found = loaded.equivalent_loads["My"]
    # from 0 by 1, -1, 1, -1, 1, -1 to 0 kN m: five half cycles of 2 kN m, two of 1 kN m
    for slope, one in found.items():
        load = ((2.5 * 2e3**slope + 1e3**slope) / 30.1) ** (1.0 / slope)
        assert one.load == pytest.approx(load, rel=1e-6)
        assert one.band is not None
        assert one.load + one.band == pytest.approx(load * 2.0 ** (1.0 / slope), rel=1e-6)
    figure = loaded["equivalent load of My, slope 3"]
    assert (figure.unit, figure.computed) == ("kN m", found[3.0].load / 1e3)
    reaction = loaded.reactions["main_bearing"].equivalent_load("Fz", 3.0, loaded.asked)
    assert reaction.load > 0.0
    rows = {row["reaction"]: row for row in loaded.tables["reactions"]}
    assert rows["main_bearing, Fz [kN]"]["DEL, m = 3"] == pytest.approx(reaction.load / 1e3)
    assert loaded.capture is None
    assert loaded.lifetime is None


def test_long_tables_of_loads_are_frames(loaded: LoadsResult) -> None:
    pytest.importorskip("pandas")
    found = loaded.to_frame("equivalent_loads")
    assert set(found["file"]) == {"all", "wave"}
    my = found[(found["channel"] == "My") & (found["slope"] == 5.0)]["DEL at 1 Hz"]
    assert list(my) == [loaded.equivalent_loads["My"][5.0].load] * 2
    assert "windows" not in loaded.to_dict()["tables"]


def test_distributions_hold_all_time_and_turns(loaded: LoadsResult) -> None:
    levels = loaded.hub.levels
    assert levels.seconds["Mx"].amount.sum() == pytest.approx(30.1)
    assert levels.turns["bending moment"].amount.sum() == pytest.approx(30.1 * 1.5 / 2 / np.pi)
    tables = loaded.file_tables()
    assert sum(row["amount"] for row in tables["levels"] if row["of"] == "seconds") == (
        pytest.approx(8 * 30.1)
    )
    assert [row["frequency [Hz]"] for row in tables["spectra"]] == pytest.approx(
        [line / 60.0 for line in range(300)]  # up to half of 10 Hz
    )


def test_loads_without_files_winds_or_slopes_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="there are no files"):
        loads([])
    still = tmp_path / "still.csv"
    write_csv(LoadHistory("still", np.arange(20) * 0.1, np.ones((20, 6))), still)
    with pytest.raises(InputError, match="no wind speed, by which --site weights"):
        loads([still], site=Site(8.5))
    with pytest.raises(InputError, match="give a site, too"):
        loads(still, transients=[(700.0, still)])
    with pytest.raises(InputError, match="no slope of an S-N curve"):
        LoadOptions(slopes=())
    with pytest.raises(InputError, match="must be from 1 to 20"):
        LoadOptions(slopes=(0.5,))


def test_a_lifetime_is_that_of_its_winds_and_events(tmp_path: Path) -> None:
    """Winds by their hours over the time of their files, stops of unlike damage by their mean."""
    time, slope = np.arange(201) * 0.1, 4.0

    def written(name: str, size: float, wind: float) -> Path:
        samples = np.full((201, 6), 1.0)
        samples[:, 4] = size * np.sin(2.0 * np.pi * time / 10.0)
        table = np.column_stack([time, samples, np.full(201, wind)])
        header = "time [s],Fx [N],Fy [N],Fz [N],Mx [N m],My [N m],Mz [N m],wind speed [m/s]"
        file = tmp_path / f"{name}.csv"
        np.savetxt(file, table, delimiter=",", header=header, comments="", fmt="%.9g")
        return file

    def damage(size: float) -> float:  # 0, 1, -1, 1, -1, 0: three half cycles of 2, two of 1
        return (1.5 * 2.0**slope + 1.0) * size**slope

    written("calm", 1e3, 8.0)
    written("storm", 2e3, 12.0)
    stops = [written("stop", 3e3, 9.0), written("other_stop", 4e3, 9.0)]
    found = loads(
        tmp_path / "*m.csv",  # calm and storm
        LoadOptions(slopes=(slope,)),
        site=Site(9.0),
        transients=[(500.0, stops)],
    ).lifetime
    assert found is not None
    hours = Site(9.0).hours([6.0, 10.0, 14.0])
    parts = [3600.0 * h / 20.1 * damage(size) for h, size in zip(hours, (1e3, 2e3), strict=True)]
    parts.append(500.0 * 20.0 * (damage(3e3) + damage(4e3)) / 2.0)
    assert found.sources == ("8 m/s", "12 m/s", "stop and 1 more")
    np.testing.assert_allclose(found.damage[4, 0], parts, rtol=1e-6)
    equivalent = found.equivalent_loads([slope])[4, 0]
    assert equivalent == pytest.approx((sum(parts) / 1e7) ** (1.0 / slope), rel=1e-6)
    of_events = 500.0 * 20.0 * 20.1 / 3600.0
    assert found.hours_at_level["Mx"].amount.sum() == pytest.approx(hours.sum() + of_events)


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
