"""Options that files, scenes or catalogues leave without effect: said in a note, or refused."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import yaml
from coarse_scenes import coarse_scene
from tiny_case import Result

from fe_drivetrain.bearing.catalogue import catalogue_entry
from fe_drivetrain.cases.dynamics.drivetrain_levels import operations
from fe_drivetrain.common.components import FORCES
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.reading import library_scene
from fe_drivetrain.report.results import read_results
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.studies import check
from fe_drivetrain.studies.rolling_bearings import Choices, bearings_of
from fe_drivetrain.studies.unused import choices_not_used, own_speeds, speed_not_used
from fe_drivetrain.turbine_loads.hub_loads.channel_map import ChannelMap
from fe_drivetrain.turbine_loads.hub_loads.recorded import read_recorded

SCENE, ENTRY = "main_bearing_spherical", "spherical_23180"

Invoke = Callable[..., Result]


def write_history(path: Path, speed: float | None, samples: int = 20) -> None:
    """A load that swings, and a rotor speed that rises by 1 1/min, where there is one."""
    time = 0.5 * np.arange(samples)
    loads = np.tile([2e5, 0.0, -9e5, 9e5, -1e5, 0.0], (samples, 1))
    loads[:, 4] *= 1.0 + 0.1 * np.sin(time)
    units = 3 * ["N"] + 3 * ["N m"]
    names = [f"{name} [{unit}]" for name, unit in zip(FORCES, units, strict=True)]
    columns, titles = [time, loads], ["time [s]", *names]
    if speed is not None:
        columns.append(np.linspace(speed, speed + 1.0, samples))
        titles.append("RotSpeed [rpm]")
    table = np.column_stack(columns)
    np.savetxt(path, table, delimiter=",", header=",".join(titles), comments="", fmt="%.9g")


@pytest.fixture
def both(tmp_path: Path) -> Path:
    """Two files that state their speed."""
    folder = tmp_path / "own"
    folder.mkdir()
    write_history(folder / "a.csv", 11.2)
    write_history(folder / "b.csv", 11.7)
    return folder


def notes_of(folder: Path, option: str) -> list[str]:
    return [note for note in read_results(folder / "results.json").notes if option in note]


@pytest.mark.parametrize("command", ["life", "loads"])
def test_a_rotor_speed_beside_the_files_own_is_named_once(
    command: str, invoke: Invoke, both: Path, tmp_path: Path
) -> None:
    out = tmp_path / "out"
    words = ["life", SCENE, "--loads", str(both)] if command == "life" else ["loads", str(both)]
    words += ["--out", str(out)]
    said = (
        "--rotor-speed 12.1 1/min is not used: 2 of 2 files state a speed of their own, 11.2 to "
        "12.7 1/min."
    )
    for more in ([], ["--resume"]):  # what is kept of a file says it, too
        status, printed, error = invoke(*words, "--rotor-speed", "12.1", *more)
        assert status == 0, printed + error
        assert printed.count(said) == 1
        assert notes_of(out, "--rotor-speed") == [said]
    status, printed, error = invoke(*words)
    assert status == 0, error
    assert notes_of(out, "--rotor-speed") == []
    write_history(both / "c.csv", None)
    status, printed, error = invoke(*words, "--rotor-speed", "12.1")
    assert status == 0, printed + error
    assert notes_of(out, "--rotor-speed") == [
        "--rotor-speed 12.1 1/min is used for the other files alone: 2 of 3 files state a speed of "
        "their own, 11.2 to 12.7 1/min."
    ]


def test_no_word_where_every_file_takes_the_speed() -> None:
    own, none = own_speeds(np.array([1.0, 2.0])), own_speeds(None)
    assert own == pytest.approx(np.array([30.0, 60.0]) / np.pi)
    assert np.isnan(none).all()
    assert speed_not_used(12.1, [none, none]) is None
    assert speed_not_used(None, [own]) is None
    words = speed_not_used(12.1, [none, own_speeds(np.full(3, np.pi / 3))])
    assert words is not None
    assert words.endswith("1 of 2 files states a speed of its own, 10 1/min.")


def test_events_and_other_sets_count_as_files(invoke: Invoke, both: Path, tmp_path: Path) -> None:
    write_history(tmp_path / "other.csv", 14.0)
    out = tmp_path / "out"
    words = ("loads", str(both), "--out", str(out), "--rotor-speed", "12.1")
    status, printed, error = invoke(*words, "--against", str(tmp_path / "other.csv"))
    assert status == 0, printed + error
    assert "3 of 3 files state a speed of their own, 11.2 to 15 1/min" in printed


def test_thinning_leaves_a_history(invoke: Invoke, both: Path, tmp_path: Path) -> None:
    words = ("life", SCENE, "--loads", str(both), "--out", str(tmp_path / "out"))
    status, _, error = invoke(*words, "--every", "10")
    assert status == 2
    assert "--every 10 leaves 2 of 20 samples" in error
    assert "has 3 or more: give --every from 1 to 9" in error
    assert not (tmp_path / "out").exists()
    status, _, error = invoke(*words, "--every", "9")
    assert status == 0, error


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--shape", "2.2"], "--shape 2.2 says how the winds of a site are weighted: give --site"),
        (["--years", "25"], "--years 25.0 says how the winds of a site are weighted: give --site"),
        (["--level", "4"], "--level 4 is the model of a scene: give --scene, too, or leave"),
    ],
)
def test_what_stands_beside_an_option_that_is_missing_is_refused(
    options: list[str], words: str, invoke: Invoke, both: Path, tmp_path: Path
) -> None:
    status, _, error = invoke("loads", str(both), "--out", str(tmp_path / "out"), *options)
    assert status == 2
    assert words in error
    assert not (tmp_path / "out").exists()


def test_winds_that_no_file_has_are_named(invoke: Invoke, both: Path, tmp_path: Path) -> None:
    out = tmp_path / "out"
    status, printed, error = invoke("loads", str(both), "--out", str(out), "--winds", "4:24")
    assert status == 0, printed + error
    (note,) = notes_of(out, "--winds")
    assert note.startswith("--winds 4:24 m/s is not used: no file has a wind speed")


def test_a_unit_of_a_column_that_a_file_does_not_have_is_refused(both: Path) -> None:
    mapping = ChannelMap(units={"thrust": "kN"})
    with pytest.raises(InputError, match="no channel 'thrust', though the mapping states its unit"):
        read_recorded(both / "a.csv", mapping)
    assert read_recorded(both / "a.csv", ChannelMap(units={"rotspeed": "rad/s"})).rotor_speed[
        0
    ] == pytest.approx(11.2)


def own_catalogue(file: Path, name: str, **changes: object) -> Path:
    entry = catalogue_entry(ENTRY).model_dump(exclude_unset=True) | changes
    file.write_text(yaml.safe_dump({name: entry}))
    return file


def unused(tmp_path: Path, **changes: object) -> list[str]:
    """Sentences on choices of the library's spherical bearing."""
    given = {"named": {}, "catalogues": (), "profiled": True, "assumed": ("profile",), **changes}
    choices = Choices(
        given["named"],
        given["catalogues"],
        given["profiled"],
        "rollers",
        "rigid",
        True,
        assumed=given["assumed"],
    )
    scene = library_scene(SCENE)
    return list(choices_not_used(scene, choices, bearings_of(scene, choices)))


def test_entries_that_take_the_place_of_others_are_named(tmp_path: Path) -> None:
    assert unused(tmp_path) == []
    assert unused(tmp_path, named={"main_bearing": ENTRY}) == []
    mine = own_catalogue(tmp_path / "mine.yaml", "mine", clearance=1e-4)
    assert unused(tmp_path, catalogues=(mine,), named={"main_bearing": "mine"}) == [
        "`LifeOptions(bearings={'main_bearing': 'mine'})` takes the place of the entry "
        f"{ENTRY!r} that the scene names "
        "under catalogue."
    ]
    assert unused(tmp_path, catalogues=(mine,)) == [
        f"`catalogues=['{mine}']` is not used: no bearing of the scene takes an entry of it, which "
        "are mine: name one under catalogue in the scene."
    ]
    shadow = own_catalogue(tmp_path / "shadow.yaml", ENTRY, clearance=1e-4)
    assert unused(tmp_path, catalogues=(shadow,)) == [
        f"Entry {ENTRY!r} of {shadow} takes the place of that of the program's own catalogue."
    ]
    same = own_catalogue(tmp_path / "same.yaml", ENTRY)
    assert unused(tmp_path, catalogues=(same,)) == []
    # the later file counts, so that nothing of the earlier one is left
    first, second = unused(tmp_path, catalogues=(same, shadow))
    assert first == f"Entry {ENTRY!r} of {shadow} takes the place of that of {same}."
    assert second.startswith(f"`catalogues=['{same}']` is not used")


def test_a_profile_of_the_entry_comes_before_the_option(tmp_path: Path) -> None:
    mine = own_catalogue(tmp_path / "mine.yaml", "mine", crown=4e-4)
    given = {"catalogues": (mine,), "named": {"main_bearing": "mine"}}
    for profiled in (False, True):
        option = f"`LifeOptions(profile={profiled})`"
        (_, words) = unused(tmp_path, **given, profiled=profiled, assumed=())
        assert words == (
            f"{option} is not used for bearing main_bearing: its entry 'mine' states a profile of "
            "its own, crown 0.0004 of the diameter."
        )
    assert len(unused(tmp_path, **given)) == 1  # where the option was not given


def test_check_names_a_catalogue_that_it_does_not_use(tmp_path: Path) -> None:
    mine = own_catalogue(tmp_path / "mine.yaml", "mine")
    (note,) = check(coarse_scene("spherical"), (mine,)).notes
    assert note.startswith(f"`catalogues=['{mine}']` is not used")


def test_a_summary_has_all_points(invoke: Invoke, tmp_path: Path) -> None:
    out = tmp_path / "s.json"
    words = ("export", SCENE, "--out", str(out), "--format", "json", "--what", "summary")
    status, _, error = invoke(*words, "--at", "hub")
    assert status == 2
    assert "--at hub is not used by --what summary" in error
    assert not out.exists()


@pytest.mark.parametrize(
    ("file", "options", "words"),
    [
        ("a.step", ["--bore", "seat"], "--bore seat names points of a superelement, and a.step is"),
        ("a.inp", ["--held", "left"], "--held left names points of a superelement, and a.inp is"),
        ("a.json", ["--picture", "a.png"], "and a.json is a superelement, which has no faces"),
        ("a.step", ["--overwrite"], "--overwrite is for the file of --picture"),
    ],
)
def test_options_of_another_kind_of_part_are_refused(
    file: str, options: list[str], words: str, invoke: Invoke
) -> None:
    status, _, error = invoke("part", file, *options)
    assert status == 2
    assert words in error


def test_a_tolerance_beside_a_level_is_refused(invoke: Invoke, tmp_path: Path) -> None:
    out = tmp_path / "out"
    words = ("uncertainty", SCENE, "--level", "1", "--tolerance", "1%", "--out", str(out))
    status, _, error = invoke(*words)
    assert status == 2
    assert "--tolerance 1% is for the adviser, which --level 1 leaves out" in error
    assert not out.exists()


@pytest.mark.parametrize("settings", [{"torque": 100}, {"drivetrain": "nrel_5mw", "speed": 10}])
def test_an_operation_of_machines_that_have_their_own_is_refused(
    settings: dict[str, object], tmp_path: Path
) -> None:
    key = next(key for key in settings if key != "drivetrain")
    with pytest.raises(InputError, match=f"{key} = {settings[key]} is not used: nrel_5mw,"):
        operations(Run(settings, True, tmp_path))
    assert list(operations(Run({"drivetrain": "nrel_5mw"}, True, tmp_path))) == ["nrel_5mw"]
    own = operations(Run({"drivetrain": "park_2021", "torque": 15, "moment": 2}, True, tmp_path))
    assert own["park_2021"].torque == 15e3
