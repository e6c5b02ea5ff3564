"""``life`` on anyone's scene and files: lives of known histories, mistakes, stop and go on."""

import csv
import os
import pickle
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from tiny_case import Result

from fe_drivetrain.bearing_life.life.life_rules import LifeRules
from fe_drivetrain.bearing_life.life.load_series import years
from fe_drivetrain.bearing_life.life.roller_damage import step_lives
from fe_drivetrain.command_line.life_request import parse_lubricant
from fe_drivetrain.command_line.option_names import result_with_options
from fe_drivetrain.common.array_records import as_arrays
from fe_drivetrain.common.cache import CACHE_VARIABLE
from fe_drivetrain.common.components import FORCES
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.reading import library_scene
from fe_drivetrain.report.results import read_results
from fe_drivetrain.studies import LifeOptions, life, life_digest
from fe_drivetrain.studies.life_options import ASSUMED
from fe_drivetrain.studies.life_sums import BearingSums, scatter
from fe_drivetrain.studies.rolling_bearings import Choices, bearings_of, rollers_in_words
from fe_drivetrain.turbine_loads.histories.sites import site_of_class

REAL_FOLDER = Path(os.environ.get("FE_DRIVETRAIN_OPENFAST", "no folder is given"))
SCENE = "main_bearing_bonded"
CHOICES = Choices({}, (), True, "rollers", "rigid", True)
LOADS = {8.0: (2e5, 0.0, -3e5, 9e5, -1e5, 0.0), 14.0: (1e5, 2e4, -3e5, 9e5, 6e5, 2e5)}
RPM = {8.0: 12.0, 14.0: 18.0}


def write_history(path: Path, wind: float, columns: str = "Wind1VelX [m/s],RotSpeed [rpm]") -> None:
    """A constant load for 10 s, at a constant speed."""
    time = np.arange(0.0, 10.0, 0.5)
    units = 3 * ["N"] + 3 * ["N m"]
    names = [f"{name} [{unit}]" for name, unit in zip(FORCES, units, strict=True)]
    beside = [wind, RPM[wind]][: len(columns.split(","))]
    table = np.column_stack([time, np.tile([*LOADS[wind], *beside], (len(time), 1))])
    header = ",".join(["time [s]", *names, columns])
    np.savetxt(path, table, delimiter=",", header=header, comments="", fmt="%.9g")


@pytest.fixture
def histories(tmp_path: Path) -> Path:
    folder = tmp_path / "own"
    folder.mkdir()
    for wind in LOADS:
        write_history(folder / f"v{wind:g}.csv", wind)
    return folder


def rows_of(file: Path) -> list[dict[str, str]]:
    lines = [line for line in file.read_text().splitlines() if not line.startswith("#")]
    return list(csv.DictReader(lines))


def test_lives_of_constant_loads_are_those_of_one_step(
    invoke: Callable[..., Result], histories: Path
) -> None:
    out = histories.parent / "out"
    status, printed, error = invoke(
        *("life", SCENE, "--loads", str(histories / "*.csv"), "--site", "class-II"),
        *("--out", str(out), "--bearing", "main_bearing=bearing_s_o20"),
    )
    assert status == 0, printed + error
    assert printed.startswith("The main bearing lives ")
    (one,) = bearings_of(
        library_scene(SCENE), Choices({"main_bearing": "bearing_s_o20"}, (), *CHOICES_REST)
    )
    winds = rows_of(out / "winds.csv")
    alone = []
    for wind, row in zip(LOADS, winds, strict=True):
        steps = next(one.path.steps(LOADS[wind], RPM[wind], 1.0))
        alone.append(years(step_lives(one.rated, steps.laminae, LifeRules()), RPM[wind]).item())
        assert float(row["L10r [years]"]) == pytest.approx(alone[-1], rel=1e-6)
    shares = site_of_class("II").shares([5.0, 11.0, 17.0])
    (lives,) = rows_of(out / "lives.csv")
    at_site = 1.0 / np.sum(shares / np.array(alone))
    assert float(lives["L10r [years]"]) == pytest.approx(at_site, rel=1e-6)
    ratio = float(lives["C [kN]"]) / float(lives["P_ref [kN]"])
    assert ratio ** (10 / 3) == pytest.approx(float(lives["L10r [Mrev]"]), rel=1e-6)
    covered, years_here = float(shares.sum()), float(lives["L10mr [years]"])
    (said,) = read_results(out / "results.json").details
    assert f"blow {100 * covered:.3g} % of the time and the rest is taken to do no" in said
    assert f"blew all the time it would live {covered * years_here:.3g} years" in said
    places = rows_of(out / "places.csv")
    laminae = rows_of(out / "laminae.csv")
    assert len(places) == 72
    used = 1.0 / at_site
    by_place = sum(float(r[f"{ring} ring, damage by L10r"]) for r in places for ring in RINGS)
    by_lamina = sum(
        float(r[f"{ring} ring, damage"]) for r in laminae if r["kind"] == "L10r" for ring in RINGS
    )
    assert [by_place, by_lamina] == pytest.approx([used, used], rel=1e-5)
    results = read_results(out / "results.json")
    assert all(verdict.passed for verdict in results.verdicts)
    (answer,) = (one for one in results.answers if one.quantity.startswith("L10mr of "))
    assert answer.computed == pytest.approx(float(lives["L10mr [years]"]), rel=1e-5)
    assert answer.band is None  # each wind has one file
    assert any("ISO" in note for note in results.notes)
    # bearing S stands on the thesis's shaft, which is thinner than its bore
    misfit = "entry bearing_s_o20 is 635 mm, the shaft at its seat 400 mm"
    assert misfit in printed
    assert any(misfit in note for note in results.notes)
    charts = [i.caption for s in results.sections for i in s.items if i.kind == "chart"]
    assert sum("looking downwind" in caption for caption in charts) == 3  # two of them by wind
    assert sum("pressure along" in caption for caption in charts) == 1
    shown = {i.caption for s in results.sections for i in s.items if i.kind == "table"}
    assert "Bearings on their seats" in shown


def test_a_bearing_that_slides_in_the_file_leaves_the_thrust_to_the_other(
    invoke: Callable[..., Result], histories: Path
) -> None:
    words = ["life", "two_bearings", "--loads", str(histories / "*.csv")]
    sliding = [
        *("--set", "bearing_units.front.interface=spring"),
        *("--set", "bearing_units.front.stiffness=[0, rigid, rigid, 0, 0, 0]"),
    ]
    years, stated = [], []
    for k, changes in enumerate([[], sliding]):
        status, printed, error = invoke(*words, *changes, "--out", str(histories.parent / f"{k}"))
        assert status == 0, printed + error
        results = read_results(histories.parent / f"{k}" / "results.json")
        years.append({row["bearing"]: row["L10mr [years]"] for row in results.figures["lives"]})
        stated.append([one for one in results.assumptions if one.name == "front: housing"])
    assert years[1]["rear"] < 0.9 * years[0]["rear"]
    assert not stated[0]
    assert "holds no axial force" in str(stated[1])


CHOICES_REST = (True, "rollers", "rigid", True)
RINGS = ("inner", "outer")


def test_study_and_command_give_the_same_numbers_with_the_same_defaults(
    invoke: Callable[..., Result], histories: Path
) -> None:
    out, loads = histories.parent / "out", str(histories / "*.csv")
    status, _, error = invoke(
        *("life", SCENE, "--loads", loads, "--site", "class-II", "--out", str(out))
    )
    assert status == 0, error
    shown = read_results(out / "results.json")
    found = result_with_options(life(library_scene(SCENE), loads, site_of_class("II")))
    plain = found.to_dict()
    assert shown.details == plain["details"]
    assert shown.notes == plain["notes"]
    assert [one.model_dump(mode="json") for one in shown.answers] == plain["figures"]
    assert [one.model_dump(mode="json") for one in shown.verdicts] == plain["checks"]
    assert [one.model_dump(mode="json") for one in shown.assumptions] == plain["assumptions"]
    assert [one.model_dump(mode="json") for one in shown.drivetrains] == plain["drivetrains"]
    for name, table in found.tables.items():
        assert shown.figures[name] == table, name
    for name in ("files", "winds", "places", "rollers", "laminae"):
        written = [list(row.values()) for row in rows_of(out / f"{name}.csv")]
        table = [
            [f"{v:.9g}" if isinstance(v, float) else str(v) for v in row.values()]
            for row in found.all_tables()[name]
        ]
        assert written == table, name


def test_what_is_kept_of_each_file_is_small(histories: Path) -> None:
    """Places, laminae and time are those of all files together: memory hardly grows."""
    options = LifeOptions()
    scene, rules, choices = library_scene(SCENE), options.rules, options.choices
    (one,) = bearings_of(scene, choices)
    digest = life_digest.digest(histories / "v8.csv", one, rules, options.reading, scene, choices)
    sums = BearingSums(one, None)
    for _ in range(100):
        sums.add(histories / "v8.csv", digest)
    found = sums.life(rules, choices)
    of_digest = sum(array.nbytes for array in as_arrays(digest).values())
    assert of_digest > 50_000
    assert all(not one.damage.basic and not one.damage.modified for one in found.files)
    of_files = sum(len(pickle.dumps(one)) for one in found.files) / 100
    assert of_files < 0.05 * of_digest
    assert found.damage.of_bearing == pytest.approx(100 * digest.damage.of_bearing, rel=1e-12)
    assert found.mean_load == pytest.approx(digest.mean_load, rel=1e-12)


def of_rates(*rates_by_wind: tuple[float, ...]) -> Any:
    """A bearing with such rates of damage in the files of each wind, winds of equal time."""
    speeds = [8.0 + 2.0 * k for k in range(len(rates_by_wind))]
    files = [
        SimpleNamespace(
            wind=speed,
            damage=SimpleNamespace(totals={"L10mr": 10 * r, "L10r": 5 * r**2}, seconds=10.0),
        )
        for speed, rates in zip(speeds, rates_by_wind, strict=True)
        for r in rates
    ]
    shares = np.full(len(speeds), 1.0 / len(speeds))
    site = SimpleNamespace(
        speeds=np.array(speeds), shares=shares, years={"L10mr": 50.0, "L10r": 80.0}
    )
    return SimpleNamespace(files=files, site=site)


def test_the_band_of_a_life_is_the_scatter_of_files_of_one_wind() -> None:
    assert scatter(of_rates((1.0, 1.0), (2.0, 2.0))) == 0.0
    # a tenth up and down: the mean of the two has a standard error of a tenth
    assert scatter(of_rates((0.9, 1.1))) == pytest.approx(2 * 0.1 * 50.0)
    of_square = 0.5 * (1.1**2 - 0.9**2) / np.mean([1.1**2, 0.9**2])
    assert scatter(of_rates((0.9, 1.1)), "L10r") == pytest.approx(2 * of_square * 80.0)
    both = scatter(of_rates((0.9, 1.1), (0.9, 1.1)))
    assert both == pytest.approx(2 * 0.1 * 50.0 / np.sqrt(2))
    assert scatter(of_rates((0.9, 1.1), (1.0,))) is None
    assert scatter(SimpleNamespace(site=None)) is None  # type: ignore[arg-type]


def test_a_stopped_run_goes_on(
    invoke: Callable[..., Result], histories: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    done: list[str] = []
    real = life_digest.digest
    # what is in files counts, and other tests may have had the same
    monkeypatch.setenv(CACHE_VARIABLE, str(histories.parent / "cache"))

    def counted(file: Path, *more: object) -> object:
        done.append(file.name)
        if len(done) == 2:
            raise KeyboardInterrupt
        return real(file, *more)  # type: ignore[arg-type]

    monkeypatch.setattr(life_digest, "digest", counted)
    out = histories.parent / "out"
    words = ("life", SCENE, "--loads", str(histories), "--out", str(out))
    status, _, error = invoke(*words)
    assert status == 130
    assert "--resume" in error
    assert not out.exists()
    status, printed, _ = invoke(*words, "--resume")
    assert status == 0, printed
    assert done == ["v8.csv", "v14.csv", "v14.csv"] or done == ["v14.csv", "v8.csv", "v8.csv"]
    invoke(*words, "--resume", "--temperature", "60")
    assert len(done) == 5


def test_a_bearing_that_stands_is_said_to_stand(
    invoke: Callable[..., Result], tmp_path: Path
) -> None:
    write_history(tmp_path / "a.csv", 8.0, "Wind1VelX [m/s]")
    out = tmp_path / "out"
    status, printed, error = invoke(
        *("life", "main_bearing_spherical", "--loads", str(tmp_path / "a.csv"), "--out", str(out)),
        *("--rotor-speed", "0.01"),
    )
    assert status == 0, error
    assert "the bearing stands: no life is computed" in printed
    assert printed.startswith("The main bearing takes no damage (L10mr)")


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--bearing", "main_bearing"], "NAME=ENTRY"),
        (["--bearing", "rear=bearing_s"], "has no bearing 'rear'"),
        (["--bearing", "main_bearing=nothing"], "in no catalogue"),
        (
            ["--bearing", "main_bearing=planet_nj2232"],
            "planet_nj2232 is 160 mm, the shaft at its seat 400 mm, which must be at most 168 mm: "
            "name another entry under its catalogue, or with --bearing main_bearing=ENTRY for "
            "`life`",
        ),
        (
            ["--bearing", "main_bearing=bearing_s", "--bearing", "main_bearing=bearing_s_o20"],
            "--bearing main_bearing is given twice",
        ),
        (["--channel", "rotor speed=a", "--channel", "rotor speed=b"], "speed is given twice"),
        (["--lubricant", "honey"], "VG 460"),
        (["--supply", "water"], "oil bath"),
        (["--cleanliness", "dirty"], "very severe"),
        (["--support", "soft"], "145e6"),
        (["--rings", "round"], "three-degree"),
        (["--site", "class-V"], "choose I, II, III"),
        (["--reliability", "91"], "99.9"),
        (["--only", "rear"], "no such bearing"),
        (["--turning", "both"], "'inner' or 'outer'"),
        (["--temperature", "900"], "-60 to 200"),
        (["--channel", "rotor speed=nothing"], "no channel 'nothing'"),
    ],
)
def test_mistakes_are_one_sentence(
    invoke: Callable[..., Result], histories: Path, options: list[str], words: str
) -> None:
    out = histories.parent / "out"
    status, _, error = invoke("life", SCENE, "--loads", str(histories), "--out", str(out), *options)
    assert status == 2
    assert words in error
    assert not out.exists()


def test_what_files_and_scenes_do_not_say_is_asked_for(
    invoke: Callable[..., Result], tmp_path: Path
) -> None:
    write_history(tmp_path / "a.csv", 8.0, "Wind1VelX [m/s]")
    words = ("life", "--loads", str(tmp_path / "a.csv"), "--out", str(tmp_path / "out"))
    status, _, error = invoke(*words, SCENE)
    assert status == 2
    assert "--rotor-speed" in error
    status, _, error = invoke("life", SCENE, "--loads", str(tmp_path / "none.outb"))
    assert status == 2
    assert "none.outb" in error
    status, _, error = invoke(*words, SCENE, "--rotor-speed", "12", "--site", "II")
    assert status == 2
    assert "two winds" in error
    status, _, error = invoke(*words, "stepped_shaft", "--rotor-speed", "12")
    assert status == 2
    assert "--bearing front=ENTRY" in error
    assert not (tmp_path / "out").exists()
    status, _, error = invoke("life", "stepped_shaft", "--loads", str(tmp_path / "a.csv"))
    assert "--bearing front=ENTRY" in error
    assert not (tmp_path / "reports").exists()


@pytest.mark.skipif(
    not REAL_FOLDER.is_dir(), reason="FE_DRIVETRAIN_OPENFAST names no folder with real files"
)
def test_real_files_have_lives_that_fall_with_the_load_on_the_row(
    invoke: Callable[..., Result], tmp_path: Path
) -> None:
    status, printed, error = invoke(
        *("life", "iea_15mw_main_shaft", "--loads", str(REAL_FOLDER / "nrel5mw_*.outb")),
        *("--site", "class-II", "--every", "200", "--out", str(tmp_path / "out")),
    )
    assert status == 0, printed + error
    files = rows_of(tmp_path / "out" / "files.csv")
    assert [round(float(row["mean wind [m/s]"])) for row in files[:2]] == [11, 17]
    places = rows_of(tmp_path / "out" / "places.csv")
    # the downwind bearing carries down: damage of its standing ring is below, not on top
    below = [r for r in places if r["bearing"] == "downwind" and float(r["place [deg]"]) > 180]
    above = [r for r in places if r["bearing"] == "downwind" and float(r["place [deg]"]) < 180]
    of_outer = [
        sum(float(r["outer ring, damage by L10r"]) for r in part) for part in (below, above)
    ]
    assert of_outer[0] > 100 * of_outer[1]


OWN = """
big_ball:
  title: A large deep-groove ball bearing
  kind: ball
  elements: 20
  element_diameter: 0.06
  pitch_diameter: 0.6
  contact_angle: 0
  ratings: {C: 8.0e+5, C0: 1.2e+6, Cu: 4.0e+4}
  sources:
    elements: assumed
    element_diameter: assumed
    pitch_diameter: assumed
    contact_angle: a deep groove
    ratings: assumed
"""


def test_balls_of_an_own_catalogue_in_oil(invoke: Callable[..., Result], histories: Path) -> None:
    (histories / "own.yaml").write_text(OWN)
    out = histories.parent / "out"
    status, printed, error = invoke(
        *("life", SCENE, "--loads", str(histories / "v14.csv"), "--out", str(out)),
        *("--catalogue", str(histories / "own.yaml"), "--bearing", "main_bearing=big_ball"),
        *("--lubricant", "100,11", "--supply", "oil bath", "--cleanliness=-/17/14"),
    )
    assert status == 0, printed + error
    (lives,) = rows_of(out / "lives.csv")
    ratio = float(lives["C [kN]"]) / float(lives["P_ref [kN]"])
    assert ratio**3 == pytest.approx(float(lives["L10r [Mrev]"]), rel=1e-6)
    assert len(rows_of(out / "places.csv")) == 20
    assert not (out / "laminae.csv").exists()


def test_ends_of_rollers_are_stated_with_profile_and_riser() -> None:
    scene = library_scene(SCENE)
    (profiled,) = bearings_of(scene, CHOICES)
    (straight,) = bearings_of(scene, Choices({}, (), False, "rollers", "rigid", True))
    assert "twice" not in rollers_in_words(profiled, "standard")
    assert "ends count twice" in rollers_in_words(straight, "standard")
    assert "no stress riser" in rollers_in_words(straight, "none")


def test_lubricants_are_grades_or_two_viscosities() -> None:
    assert parse_lubricant("460,30.5") == (460.0, 30.5)
    oil = LifeOptions(lubricant=(460.0, 30.5)).rules.lubricant
    assert oil == LifeOptions(lubricant=parse_lubricant("VG 460")).rules.lubricant
    assert oil == LifeOptions(cleanliness="normal").rules.lubricant
    with pytest.raises(InputError, match="40 and"):
        LifeOptions(lubricant=parse_lubricant("460"))


def test_defaults_are_assumed_and_other_values_are_not() -> None:
    assert LifeOptions().assumed == ASSUMED
    some = LifeOptions(temperature=60.0, riser=False, stated=("turning",))
    assert some.assumed == ("lubricant", "cleanliness", "profile")
    assert some.choices.assumed == some.assumed
    assert LifeOptions(stated=ASSUMED).assumed == ()


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"every": 0}, "whole number of samples"),
        ({"skip": -1.0}, "skip is -1 s"),
        ({"rotor_speed_rpm": float("inf")}, "rotor speed is inf 1/min but must be at least 0"),
        ({"stated": ("speed",)}, "an option that is stated is 'speed': choose 'lubricant'"),
        ({"reliability_percent": 91.0}, "99.9 %"),
        ({"lubricant": (30.0, 460.0)}, "460"),
        ({"turning": "both"}, "'inner' or 'outer'"),
    ],
)
def test_options_out_of_their_range_are_refused(options: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError) as error:
        LifeOptions(**options)
    assert words in str(error.value)
