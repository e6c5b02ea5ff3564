"""``life --series``, and loads of the places of rollers by wind: digests, files, mistakes."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from test_commands_life import LOADS, RPM, SCENE, rows_of, write_history
from tiny_case import Result

from fe_drivetrain.bearing.rolling import equilibrium
from fe_drivetrain.command_line.life_files import SeriesFiles
from fe_drivetrain.command_line.life_request import rollers_of
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.reading import library_scene
from fe_drivetrain.report.results import read_results
from fe_drivetrain.studies import LifeOptions, LoadSeries, life
from fe_drivetrain.studies.life_sums import WindLoads
from fe_drivetrain.studies.rolling_bearings import Choices, bearings_of

PLACES = {1: 0.0, 10: 90.0, 21: 200.0}


@pytest.fixture
def histories(tmp_path: Path) -> Path:
    folder = tmp_path / "own"
    folder.mkdir()
    for wind in LOADS:
        write_history(folder / f"v{wind:g}.csv", wind)
    write_history(folder / "again.csv", 8.0)
    return folder


def test_series_and_winds_have_the_loads_of_the_rollers_in_equilibrium(
    invoke: Callable[..., Result], histories: Path
) -> None:
    out = histories.parent / "out"
    words = ["life", SCENE, "--loads", str(histories), "--out", str(out)]
    words += [f"--series=roller={number}" for number in PLACES]
    status, printed, error = invoke(*words)
    assert status == 0, printed + error
    (one,) = bearings_of(library_scene(SCENE), Choices({}, (), True, "rollers", "rigid", True))
    by_wind = rows_of(out / "rollers.csv")
    assert [float(r["wind [m/s]"]) for r in by_wind[::72]] == list(LOADS)
    for wind, hub_loads in LOADS.items():
        steps = next(one.path.steps(hub_loads, RPM[wind], 1.0))
        alone = 1e-3 * equilibrium(one.rated.bearing, steps.loads).rollers[0].reshape(2, -1)
        rows = rows_of(out / f"series_main_bearing_v{wind:g}.csv")
        assert [float(r["time [s]"]) for r in rows] == list(np.arange(0.0, 10.0, 0.5))
        own = [row for row in by_wind if float(row["wind [m/s]"]) == wind]
        for word, loads in zip(("upwind row", "downwind row"), alone, strict=True):
            places = [row for row in own if row["row"] == word]
            for kind in ("mean", "max"):  # of a constant load
                found = [float(row[f"{kind} load [kN]"]) for row in places]
                assert found == pytest.approx(loads, rel=1e-6, abs=1e-6)
            for row in (rows[0], rows[-1]):
                assert float(row[f"{word}, raceway [kN]"]) == pytest.approx(loads.sum(), rel=1e-6)
                assert float(row[f"{word}, peak element [kN]"]) == pytest.approx(loads.max())
                for number, degrees in PLACES.items():
                    one_place = float(row[f"{word}, element {number} at {degrees:g} deg [kN]"])
                    assert one_place == pytest.approx(loads[number - 1], rel=1e-6, abs=1e-6)
                    assert float(places[number - 1]["place [deg]"]) == pytest.approx(degrees)
    captions = [
        item.caption
        for section in read_results(out / "results.json").sections
        for item in section.items
        if item.kind == "chart"
    ]
    assert sum("load of the places of its rollers by wind" in text for text in captions) == 2
    first = (out / "series_main_bearing_v8.csv").read_bytes()
    invoke(*words, "--resume")
    assert (out / "series_main_bearing_v8.csv").read_bytes() == first


def test_series_come_one_by_one_and_stay_nowhere(histories: Path) -> None:
    came: list[LoadSeries] = []
    files = [histories / "v8.csv", histories / "v14.csv"]
    scene, options = library_scene(SCENE), LifeOptions(series=())
    found = life(scene, files, options=options, each=came.append)
    assert [(one.bearing, one.file) for one in came] == [("main_bearing", file) for file in files]
    assert [len(one.columns) for one in came] == [5, 5]  # speed, and two of each row
    assert all(one.values.shape == (len(one.time), 5) for one in came)
    assert not hasattr(found.bearings["main_bearing"], "series")
    assert life(scene, files, options=LifeOptions(), each=came.append).bearings
    assert len(came) == 2


def test_bearings_of_like_names_have_files_of_their_own(tmp_path: Path) -> None:
    files = SeriesFiles([Path("v8.csv")])
    write = files.into(tmp_path)
    for number, name in enumerate(("front a", "front-a", "front/a")):
        write(
            LoadSeries(name, Path("v8.csv"), ("x [kN]",), np.arange(2.0), np.full((2, 1), number))
        )
    names = ["series_front-a_v8.csv", "series_front-a_v8_2.csv", "series_front-a_v8_3.csv"]
    assert [row["file"] for row in files.written] == names
    for number, name in enumerate(names):
        assert {row["x [kN]"] for row in rows_of(tmp_path / name)} == {str(number)}


def test_winds_pool_files_by_their_time() -> None:
    one = WindLoads(8.0, 10.0, np.array([[1.0, 4.0]]), np.array([[2.0, 9.0]]))
    other = WindLoads(8.0, 30.0, np.array([[5.0, 0.0]]), np.array([[7.0, 1.0]]))
    both = one + other
    assert both.seconds == 40.0
    assert both.mean == pytest.approx(np.array([[4.0, 1.0]]))
    assert both.peak == pytest.approx(np.array([[7.0, 9.0]]))


def test_words_of_series() -> None:
    assert rollers_of(None) is None
    assert rollers_of(["raceways"]) == ()
    assert rollers_of(["roller=21", "raceways", "roller=3"]) == (21, 3)
    for texts in (["roller"], ["roller=x"], ["row=2"], ["roller=2.5"]):
        with pytest.raises(InputError, match="write raceways, or roller=21"):
            rollers_of(texts)
    with pytest.raises(InputError, match="roller=21 is given twice"):
        rollers_of(["roller=21", "roller=021"])


@pytest.mark.parametrize("number", ["0", "37"])
def test_a_place_that_no_row_has_is_refused(
    number: str, invoke: Callable[..., Result], histories: Path
) -> None:
    out = histories.parent / "out"
    status, _, error = invoke(
        *("life", SCENE, "--loads", str(histories), "--out", str(out)),
        *("--series", f"roller={number}"),
    )
    assert status == 2
    assert f"--series: there is no rolling element {number}: they are numbered 1 to 36" in error
    assert not out.exists()
