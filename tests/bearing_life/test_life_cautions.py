"""What ``life`` says before its figures: what was not stated, and where its methods end."""

import pickle
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import yaml
from answer_rules import broken_rules
from tiny_case import Result

from fe_drivetrain.bearing.catalogue import catalogue_entry
from fe_drivetrain.bearing_life.life.life_rules import LifeRules
from fe_drivetrain.bearing_life.life.lubricants import (
    GRADES,
    Lubricant,
    grade_viscosities,
    viscosity_by_index,
)
from fe_drivetrain.bearing_life.life.modified_life import viscosity
from fe_drivetrain.common.components import FORCES
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.reading import library_scene
from fe_drivetrain.report.results import Results, read_results
from fe_drivetrain.studies.life_assumptions import Assumption, in_words, sampled, what_ifs
from fe_drivetrain.studies.rolling_bearings import Choices, bearings_of

SCENE, ENTRY = "main_bearing_spherical", "spherical_23180"
STATED = (
    *("--temperature", "50", "--lubricant", "VG 460", "--cleanliness", "normal"),
    *("--profile", "--riser", "--turning", "inner"),
)


@pytest.fixture
def run(invoke: Callable[..., Result], tmp_path: Path) -> Callable[..., tuple[Results, str]]:
    """``life`` of a constant load for 10 s at 12 1/min, and what it printed."""

    def made(*options: str, scene: str = SCENE, factor: float = 1.0) -> tuple[Results, str]:
        loads = factor * np.array([2e5, 0.0, -9e5, 9e5, -1e5, 0.0])
        units = 3 * ["N"] + 3 * ["N m"]
        names = [f"{name} [{unit}]" for name, unit in zip(FORCES, units, strict=True)]
        time = np.arange(0.0, 10.0, 0.5)
        table = np.column_stack([time, np.tile(loads, (len(time), 1))])
        file, out = tmp_path / "a.csv", tmp_path / "out"
        head = ",".join(["time [s]", *names])
        np.savetxt(file, table, delimiter=",", header=head, comments="", fmt="%.9g")
        status, printed, error = invoke(
            *("life", scene, "--loads", str(file), "--out", str(out), "--rotor-speed", "12"),
            *options,
        )
        assert status == 0, printed + error
        return read_results(out / "results.json"), printed

    return made


def own_entry(folder: Path, **changes: object) -> tuple[str, ...]:
    """Options that name the spherical roller bearing with other values."""
    entry = catalogue_entry(ENTRY).model_dump(exclude_unset=True) | changes
    file = folder / "own.yaml"
    file.write_text(yaml.safe_dump({"own": entry}))
    return "--catalogue", str(file), "--bearing", "main_bearing=own"


def assumed(results: Results) -> dict[str, dict[str, float]]:
    return {row["not stated, and taken"]: row for row in results.figures["assumed"]}


def life_of(results: Results) -> float:
    return float(results.figures["lives"][0]["L10mr [years]"])


def test_rollers_are_held_against_the_load_and_what_cheap_rings_leave_is_said(run) -> None:
    scene, words = "main_bearing_bonded", "leave up to"
    rigid, _ = run(scene=scene)
    (check,) = (v for v in rigid.verdicts if "forces of its rollers" in v.quantity)
    assert check.passed
    assert 0.0 < check.computed < 1e-7
    cheap, _ = run("--rings", "three-degree", scene=scene)
    assert not any("forces of its rollers" in v.quantity for v in cheap.verdicts)
    assert words in str(cheap)
    assert words not in str(rigid)


def test_a_clearance_that_is_not_stated_is_said_with_what_it_does(run, tmp_path: Path) -> None:
    taken, printed = run()
    row = assumed(taken)["clearance 0"]
    # 1/4000 of 525 mm, to one digit
    assert row["instead"] == "0.1 mm along the contact normal"
    loose, other = run(*own_entry(tmp_path, clearance=1e-4))
    assert row["L10mr then [years]"] == pytest.approx(life_of(loose), rel=1e-6)
    assert life_of(loose) < 0.9 * life_of(taken)
    (note,) = [note for note in taken.notes if "was not stated" in note]
    assert f"clearance 0 (0.1 mm along the contact normal: {life_of(loose):.2g} years)" in note
    assert note in printed
    # a clearance that is stated, 0 or not, is no assumption
    assert "clearance" not in other.split("was not stated")[1].splitlines()[0]
    stated, _ = run(*own_entry(tmp_path, clearance=0.0))
    assert "clearance 0" not in assumed(stated)
    assert life_of(stated) == pytest.approx(life_of(taken), rel=1e-12)


def test_options_that_are_given_are_no_assumptions(run) -> None:
    results, _ = run()
    rows = assumed(results)
    lives = {
        "50 degC": ("--temperature", "60"),
        "VG 460": ("--lubricant", "VG 320"),
        "cleanliness 'normal'": ("--cleanliness", "slight to typical"),
        "the inner ring turns against the load": ("--turning", "outer"),
        "the standard's stress riser at their ends": ("--no-riser",),
    }
    for name, options in lives.items():
        other, _ = run(*options)
        assert rows[name]["L10mr then [years]"] == pytest.approx(life_of(other), rel=1e-6)
        assert name not in assumed(other)
    given, _ = run(*STATED)
    assert set(assumed(given)) == {"clearance 0", "ratings of assumed rolling elements"}


def test_assumptions_come_the_most_severe_first_and_small_ones_not_at_all() -> None:
    made = bearings_of(library_scene(SCENE), Choices({}, (), True, "rollers", "rigid", True))
    (one,) = pickle.loads(pickle.dumps(made))  # as for many files
    first, second = what_ifs(one, LifeRules(), Choices({}, (), True, "rollers", "rigid", True))
    lives = ((first, 9.0), (second, 4.0), (first, 9.6))
    changed = [Assumption(other.assumed, other.instead, years) for other, years in lives]
    words = in_words("b", 10.0, changed)
    assert words is not None
    assert "its L10mr of 10 years" in words
    assert words.index("4 years)") < words.index("9 years)")
    assert "9.6" not in words
    assert in_words("b", 10.0, changed[2:]) is None
    assert in_words("b", float("inf"), changed) is None


def test_profile_and_preload_are_assumed_of_tapered_rollers_alone() -> None:
    every = ("lubricant", "temperature", "cleanliness", "profile", "riser", "turning")
    choices = Choices(
        {"main_bearing": "bearing_s_o20"}, (), True, "rollers", "rigid", True, assumed=every
    )
    (one,) = bearings_of(library_scene("main_bearing_bonded"), choices)
    found = {other.assumed: other for other in what_ifs(one, LifeRules(), choices)}
    assert found["preload 0"].instead == "0.02 mm"
    rows = found["preload 0"].rated.bearing.rows
    assert [row.clearance for row in rows] == pytest.approx([-2e-5, -2e-5])
    straight = found["the standard's profile of rollers"]
    assert straight.rules.riser == "none"
    assert not any(row.crown for row in straight.rated.bearing.rows)
    assert "50 degC" not in found  # without a lubricant
    assert "ratings of assumed rolling elements" not in found  # they are printed


@pytest.mark.parametrize(("element", "pitch", "play"), [(90.0, 4000.0, 0.9), (85.0, 3900.0, 0.85)])
def test_no_clearance_is_compared_that_a_bearing_cannot_have(
    tmp_path: Path, element: float, pitch: float, play: float
) -> None:
    """1/4000 of the pitch diameter, 1 mm, is more than 1 % of the rollers' diameter."""
    sizes = {"pitch_diameter": 1e-3 * pitch, "element_diameter": 1e-3 * element}
    _, file, *_ = own_entry(tmp_path, **sizes, bore=1.2, elements=60)
    choices = Choices({"main_bearing": "own"}, (Path(file),), True, "rollers", "rigid", True)
    (one,) = bearings_of(library_scene(SCENE), choices)
    (found,) = [f for f in what_ifs(one, LifeRules(), choices) if f.assumed == "clearance 0"]
    assert found.instead == f"{play:g} mm along the contact normal"
    assert [row.clearance for row in found.rated.bearing.rows] == pytest.approx(2 * [1e-3 * play])


def test_a_sample_sums_to_the_whole() -> None:
    """Exactly what goes with the weights; else as means of many draws do."""
    rng = np.random.default_rng(1)
    weights = rng.exponential(size=20000) ** 4
    steps, times = sampled(weights)
    assert len(steps) <= 200
    assert times @ weights[steps] == pytest.approx(weights.sum(), rel=1e-12)
    other = weights * (1.0 + 0.5 * np.sin(np.arange(20000)))
    assert times @ other[steps] == pytest.approx(other.sum(), rel=3 * 0.36 / np.sqrt(200))
    few, once = sampled(weights[:10])
    assert (few == np.arange(10)).all()
    assert (once == 1.0).all()


def test_a_bearing_beyond_the_pressure_of_its_rating_is_not_usable(run) -> None:
    usual, _ = run()
    of = usual.figures["limits"][0]
    of_rollers = (4000.0 / of["max pressure [MPa]"]) ** 2
    assert of["min S0"] == pytest.approx(min(of_rollers, 1.0 / of["max P0 / C0"]))
    over, printed = run(factor=8.0)
    of = over.figures["limits"][0]
    assert of["min S0"] < 1.0 < of["max pressure [MPa]"] / 4000.0
    words = f"{of['max pressure [MPa]']:,.0f} MPa contact pressure in the main bearing"
    assert printed.startswith(f"Not usable: {words}, above the 4,000 MPa limit of ISO 76")
    assert over.answer is not None
    assert broken_rules(over) == []
    assert "load of the places of its rollers" in over.answer.hero
    pressure, years, safety, *_ = over.answer.figures
    assert (pressure.value, safety.value) == pytest.approx((of["max pressure [MPa]"], of["min S0"]))
    assert (pressure.status, years.name[:5], safety.status) == ("bad", "L10mr", "bad")
    assert any("static safety is below 1" in note for note in over.notes)
    assert not any("static safety is below 1" in note for note in usual.notes)
    assert usual.answer is not None
    assert "Not usable" not in usual.answer.verdict


def test_speeds_of_no_bearing_are_refused_and_nothing_is_written(
    run, invoke: Callable[..., Result], tmp_path: Path
) -> None:
    _, printed = run("--rotor-speed", "2000")
    assert "at 2,000 1/min a rolling element is pressed on the outer race by" in printed
    assert "above kappa = 4" in printed
    _, printed = run(
        *own_entry(
            tmp_path,
            limiting_speed_rpm=10.0,
            sources=catalogue_entry(ENTRY).sources | {"limiting_speed_rpm": "of its maker"},
        )
    )
    assert "in 100 % of the time it turns faster than its limiting speed, 10.0 1/min" in printed
    status, _, error = invoke(
        *("life", SCENE, "--loads", str(tmp_path / "a.csv"), "--out", str(tmp_path / "fast")),
        *("--rotor-speed", "1.2e7"),
    )
    assert status == 2
    assert "turns at 1.2e+07 1/min" in error
    assert "none runs faster than 5.71e+03 1/min" in error
    assert not (tmp_path / "fast").exists()


def test_a_lubricant_that_does_not_flow_is_refused() -> None:
    with pytest.raises(InputError, match=r"-40 degC, where .* 1\.11e\+07 mm2/s .* give -17 to 200"):
        Lubricant(*GRADES["VG 460"], temperature=-40.0)
    with pytest.raises(InputError, match="give -31 to 186 degC"):
        Lubricant(*GRADES["LGWM 2"], temperature=200.0)
    oil = Lubricant(*GRADES["VG 460"])
    known = ((40.0, 460.0), (100.0, 30.5))
    assert oil.range == (-17.0, 200.0)
    assert viscosity(-17.0, known) < 150e3 < viscosity(-18.0, known)


@pytest.mark.parametrize(("temperature", "said"), [(9.0, True), (10.0, False), (131.0, True)])
def test_a_viscosity_far_from_where_it_is_known_is_said(temperature: float, said: bool) -> None:
    assert (Lubricant(*GRADES["VG 460"], temperature=temperature).caution is not None) is said


def test_a_cold_bearing_says_that_its_viscosity_is_extrapolated(run) -> None:
    found, _ = run("--temperature", "0")
    said = " ".join(found.notes)
    assert "The viscosity at 0 degC, 1.51e+04 mm2/s, is extrapolated" in said
    assert "the film is above kappa = 4" in said


@pytest.mark.parametrize("name", ["VG 460", "VG 320", "VG 220"])
def test_grades_have_a_viscosity_index_of_95(name: str) -> None:
    """ASTM D2270 from their usual values, against what the program states of them."""
    at_40, at_100 = GRADES[name]
    low, high = (viscosity_by_index(at_100, index) for index in (0.0, 100.0))
    assert (low - at_40) / (low - high) == pytest.approx(0.95, abs=0.007)


def test_fits_of_the_viscosity_index_meet() -> None:
    for end in (6.4, 7.0, 7.7, 9.0, 12.0, 15.0, 18.0, 22.0, 28.0, 40.0, 55.0):
        below, above = viscosity_by_index(end), viscosity_by_index(end * (1.0 + 1e-9))
        assert above == pytest.approx(below, rel=2e-3)
    # and with the one formula that the standard has beyond them
    assert viscosity_by_index(70.0, 0.0) == pytest.approx(
        0.8353 * 70.0**2 + 14.67 * 70.0 - 216.0, rel=2e-3
    )


def test_a_grade_of_iso_3448_has_its_viscosities() -> None:
    assert grade_viscosities("VG 320") == GRADES["VG 320"]
    at_40, at_100 = grade_viscosities("VG 680")
    assert at_40 == 680.0
    assert viscosity_by_index(at_100) == pytest.approx(680.0, rel=1e-9)
    for name in ("VG 5", "VG x", "VG nan", "SAE 90"):
        with pytest.raises(InputError, match="is no grade"):
            grade_viscosities(name)
