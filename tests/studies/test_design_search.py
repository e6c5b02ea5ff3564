"""The least design within limits: closed forms, conflicts, checks at a better level, resumption."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from coarse_scenes import LENGTHS, coarse_scene

from fe_drivetrain.cases.references.least_shafts import bending_stiffness, least_bored_shaft
from fe_drivetrain.command_line.app import main
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.comparison.constrained_minimum import slopes, starting_points
from fe_drivetrain.drivetrain_file.named_scenes import read_drivetrain
from fe_drivetrain.drivetrain_file.reading import scene_text
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.shafts.fidelity.loaded_shaft import (
    loaded_shaft,
    part_masses,
    section_stress,
    shaft_volume,
)
from fe_drivetrain.shafts.fidelity.quantity import named_load
from fe_drivetrain.shafts.uncertainty.resolver import Resolver
from fe_drivetrain.studies import design_request, design_search, search
from fe_drivetrain.studies.design_minima import (
    MARGIN,
    SECANT,
    Correction,
    Problem,
    correction,
    minima_of,
    with_slopes,
)
from fe_drivetrain.studies.design_quantities import DesignQuantities
from fe_drivetrain.studies.design_request import parse_limit
from fe_drivetrain.studies.design_search import SearchResult
from fe_drivetrain.studies.design_trials import DesignTrials

pytestmark = pytest.mark.usefixtures("kept_between_runs")

OUTER = (0.6, 0.5, 0.4)
BORES = {f"shaft.sections.{k}.inner_diameter": (0.02, d) for k, d in enumerate((0.47, 0.37, 0.37))}
LOAD = {"hub.Fz": -3e5, "hub.My": 2e5, "gravity.z": -9.81}


def _stepped(**changes: Any) -> Scene:
    steps = [
        {"length": length, "outer_diameter": d, "inner_diameter": 0.1}
        for length, d in zip(LENGTHS, OUTER, strict=True)
    ]
    return coarse_scene("bonded", **{"shaft.sections": steps, **changes})


def _stiffness() -> float:
    """Stiffness of the shaft with bores of 0.2 m."""
    return bending_stiffness(LENGTHS, OUTER, (0.2, 0.2, 0.2), 2.0e11)


def _problem(scene: Scene, minimise: str, limits: list[str], **more: Any) -> Problem:
    request = design_request(BORES, minimise, limits, **more)
    asked = DesignQuantities(scene, request)
    now = asked.values(scene)
    trials = DesignTrials(asked, {name: len(values) for name, values in now.items()}, {})
    return Problem(trials, minimise, request.limits, float(now[minimise][0]))


@pytest.fixture(scope="module")
def bored() -> Problem:
    return _problem(_stepped(), "mass.shaft", [f"shaft.bending>={_stiffness():.17g} N m/rad"])


def test_the_least_shaft_is_that_of_lagrange_from_every_start(bored: Problem) -> None:
    scene, kept = _stepped(), 1.0 + MARGIN
    steel = scene.material_of("shaft")
    exact = least_bored_shaft(
        LENGTHS, OUTER, _stiffness() * kept, steel.youngs_modulus, steel.density
    )
    for one in minima_of(bored, starting_points(np.array([0.2, 0.2, 0.2]), 3), print, []):
        values = list(bored.trials.values_at(one.at).values())
        assert values == pytest.approx(exact.bores, abs=2e-5)
        assert one.values[0] * bored.size == pytest.approx(exact.mass, rel=1e-6)
        (price,) = bored.prices(one)
        assert price * exact.mass / _stiffness() / kept == pytest.approx(exact.price, rel=1e-3)


def test_gradients_are_those_of_the_closed_form(bored: Problem) -> None:
    at = np.array([0.4, 0.5, 0.3])
    d = np.array(list(bored.trials.values_at(at).values()))
    low, high = np.array(list(BORES.values())).T
    mass = -7850.0 * np.pi / 2.0 * np.array(LENGTHS) * d * (high - low)
    found = slopes(bored.functions, at)
    assert found[0] * bored.size == pytest.approx(mass, rel=1e-6)
    # of log(limit / K): relative growth of the compliance
    D = np.array(OUTER)
    each = np.array(LENGTHS) / (D**4 - d**4)
    growth = each * 4.0 * d**3 / (D**4 - d**4) / each.sum() * (high - low)
    assert found[1] == pytest.approx(growth, rel=1e-5)


@pytest.fixture(scope="module")
def found() -> SearchResult:
    request = design_request(
        BORES, "mass", ["deflection<=0.16 mm", "stress<=15 MPa", "tilt<=5 mrad"], load=LOAD
    )
    return search(_stepped(), request, tolerance=0.9, starts=2)


def test_limits_are_kept_at_the_better_level(found: SearchResult) -> None:
    assert found.passed
    deflection = found.quantities["deflection"]
    assert deflection.level == "2, meridian"
    assert deflection.bands[0] > 0.0
    again = DesignQuantities(_stepped(), found.request).values(found.design, "better")
    assert again["deflection"] == pytest.approx(deflection.values, rel=1e-12)
    assert (again["stress"] <= 15e6).all()
    # one of them decides: it is met, not only kept
    left = [1.0 - again["deflection"].max() / 0.16e-3, 1.0 - again["stress"].max() / 15e6]
    assert min(left) == pytest.approx(0.0, abs=3e-4)


@pytest.fixture
def without_front(found: SearchResult, monkeypatch: pytest.MonkeyPatch) -> None:
    """Sweep no limit after the search."""
    monkeypatch.setattr("fe_drivetrain.studies.design_search._FRONT", np.ones(1))


@pytest.mark.usefixtures("without_front")
def test_the_price_of_a_limit_is_what_tightening_it_costs(found: SearchResult) -> None:
    limit = max(found.prices, key=lambda name: found.prices[name])
    number = [str(one) for one in found.request.limits].index(limit)
    before = found.request.limits[number]
    changed = [str(one) for one in found.request.limits]
    changed[number] = f"{before.name}<={before.value * 0.95} {before.unit}"
    other = search(
        _stepped(), design_request(BORES, "mass", changed, load=LOAD), tolerance=0.9, starts=1
    )
    least, more = (float(of.quantities["mass"].values[0]) for of in (found, other))
    # as a power of the limit, by a change far larger than the 0.2 % that a search leaves
    power = np.log(more / least) / np.log(1.0 / 0.95)
    assert power == pytest.approx(found.prices[limit] * before.value / least, rel=0.1)


def test_the_front_falls_as_the_limit_is_relaxed(found: SearchResult) -> None:
    values = [one.value for one in found.front]
    assert len(values) > 4
    assert (np.diff(values) <= 1e-6 * values[0]).all()


@pytest.mark.usefixtures("without_front")
def test_a_front_point_is_a_search_of_its_own(found: SearchResult) -> None:
    one = found.front[-1]
    others = [str(limit) for limit in found.request.limits if limit.name != one.limit.name]
    request = design_request(BORES, "mass", [str(one.limit), *others], load=LOAD)
    other = search(_stepped(), request, tolerance=0.9, starts=1)
    assert other.quantities["mass"].values[0] == pytest.approx(one.value, rel=5e-3)


def test_conflicting_limits_are_named() -> None:
    request = design_request(
        BORES, "deflection", ["mass.shaft<=1200 kg", "stress<=10 MPa"], load=LOAD
    )
    with pytest.raises(InputError, match=r"mass.shaft<=1200 kg and stress<=10 MPa conflict"):
        search(_stepped(), request, starts=1)
    request = design_request(BORES, "mass", ["deflection<=0.001 mm"], load=LOAD)
    with pytest.raises(InputError, match="is kept by no design within the ranges"):
        search(_stepped(), request, starts=1)


def test_what_changes_nothing_is_said() -> None:
    vary = {"shaft.sections.0.inner_diameter": (0.02, 0.47), "gearbox.weight": (1e5, 2e5)}
    limit = f"shaft.bending>={0.8 * _stiffness():g} N m/rad"
    found = search(_stepped(), design_request(vary, "mass", [limit]), tolerance=0.9, starts=1)
    assert any("gearbox.weight changes nothing" in note for note in found.notes)


def test_what_cannot_be_built_is_rejected_and_what_has_not_settled_is_said(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(design_search, "_ROUNDS", 1)
    vary = {"shaft.sections.0.inner_diameter": (0.02, 1.2)}  # from 0.5 on nothing holds together
    limits = ["deflection<=0.135 mm", "stress<=30 MPa"]
    found = search(
        _stepped(), design_request(vary, "mass", limits, load=LOAD), 0.9, 2, front="stress"
    )
    assert found.values["shaft.sections.0.inner_diameter"] < 0.5
    assert found.passed
    assert found.answer is not None
    assert "has not settled: the last of 1 rounds" in found.answer.cautions[0]
    assert {one.limit.name for one in found.front} == {"stress"}
    values = [one.value for one in found.front]
    assert (np.diff(values) <= 1e-6 * values[0]).all()
    # relaxed, the limit of deflection ends where the bore meets the next section
    other = search(_stepped(), design_request(vary, "mass", limits, load=LOAD), 0.9, 2)
    assert {one.limit.name for one in other.front} == {"deflection"}
    assert other.front[-1].values["shaft.sections.0.inner_diameter"] == pytest.approx(0.5, abs=1e-4)
    assert any("could not be built and were rejected" in note for note in other.notes)


def test_a_design_that_the_better_level_cannot_build_is_named(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def refused(*given: Any) -> None:
        raise InputError("no mesh of it")

    monkeypatch.setattr(design_search, "checked_quantities", refused)
    vary = {"shaft.sections.0.inner_diameter": (0.02, 0.3)}
    words = r"inner_diameter=0.3, cannot be built .* make ranges narrower \(no mesh of it\)"
    with pytest.raises(InputError, match=words):
        search(_stepped(), design_request(vary, "mass", ["deflection<=9 mm"], load=LOAD), 0.9, 1)


def test_a_limit_of_frequency_is_met() -> None:
    scene = read_drivetrain("iea_15mw_main_shaft", {})
    key = "shaft.sections.0.inner_diameter"
    request = design_request({key: (2.7, 2.9)}, "mass", ["frequency>=22 Hz", "frequency<=60 Hz"])
    asked = DesignQuantities(scene, request)
    now = asked.values(scene)
    trials = DesignTrials(asked, {name: len(values) for name, values in now.items()}, {})
    problem = Problem(trials, "mass", request.limits, float(now["mass"][0]))
    (one,) = minima_of(problem, [np.array([0.5])], print, [])
    at = trials.design(one.at)
    assert asked.values(at)["frequency"] == pytest.approx(22.0 * (1.0 + MARGIN), rel=1e-6)
    upper, lower = problem.prices(one)[::-1]
    assert upper == 0.0
    change = asked.values(trials.design(one.at + 0.01))
    slope = np.log(change["mass"] / asked.values(at)["mass"]) / np.log(
        change["frequency"] / asked.values(at)["frequency"]
    )
    assert lower == pytest.approx(float(slope[0]), rel=0.05)


def test_lists_are_tried_one_by_one() -> None:
    vary: Mapping[str, Any] = {
        "shaft.sections.0.inner_diameter": (0.02, 0.47),
        "shaft.sections.2.inner_diameter": [0.1, 0.15, 0.2],
    }
    limit = f"shaft.bending>={0.8 * _stiffness():g} N m/rad"
    found = search(_stepped(), design_request(vary, "mass", [limit]), tolerance=0.9, starts=1)
    masses = []
    for bore in (0.1, 0.15, 0.2):
        own = {"shaft.sections.0.inner_diameter": (0.02, 0.47)}
        scene = _stepped(**{"shaft.sections.2.inner_diameter": bore})
        try:
            one = search(scene, design_request(own, "mass", [limit]), tolerance=0.9, starts=1)
        except InputError:
            continue
        masses.append(one.quantities["mass"].values[0])
    assert found.quantities["mass"].values[0] == pytest.approx(min(masses), rel=1e-4)


def test_a_search_goes_on_where_it_was(found: SearchResult) -> None:
    asked = DesignQuantities(_stepped(), found.request)
    counts = {name: len(of.values) for name, of in found.quantities.items()}
    trials = DesignTrials(asked, counts, {})
    assert trials.kept > 10
    trials.quantities(trials_start(asked))
    assert trials.made == 0


def trials_start(asked: DesignQuantities) -> Any:
    return np.array(asked.request.start(asked.drivetrain))


def test_forces_of_sections_balance_and_stress_is_that_of_a_beam() -> None:
    scene = _stepped()
    factors = named_load(scene, LOAD).values
    loaded = loaded_shaft(scene, Resolver(1)(scene), factors)
    behind = loaded.section_forces(scene.shaft.rear)
    assert np.abs(behind).max() < 1e-7 * np.abs(loaded.forces).max()
    # in front of the bearing only the load and the weight of what is there
    x = scene.shaft.front + 0.3
    front = loaded.section_forces(x)
    weight = 7850.0 * 9.81 * np.pi / 4.0 * (0.6**2 - 0.1**2) * 0.3
    assert front[2] == pytest.approx(-3e5 - weight, rel=1e-12)
    assert front[4] == pytest.approx(2e5 - 3e5 * 0.3 - weight * 0.15, rel=1e-9)
    bent = np.array([0.0, 0.0, 0.0, 1e5, 2e5, 0.0])
    exact = 32.0 * 0.6 / (np.pi * (0.6**4 - 0.1**4)) * np.sqrt(2e5**2 + 0.75 * 1e5**2)
    assert section_stress(bent, 0.6, 0.1) == pytest.approx(exact, rel=1e-12)


def test_mass_of_a_shaft_is_that_of_cones_and_fillets() -> None:
    scene = _stepped()
    exact = sum(
        length * np.pi / 4.0 * (d**2 - 0.1**2) for length, d in zip(LENGTHS, OUTER, strict=True)
    )
    assert shaft_volume(scene.shaft) == pytest.approx(exact, rel=1e-12)
    assert part_masses(scene)["shaft"] == pytest.approx(7850.0 * exact, rel=1e-12)
    filleted = _stepped(**{"shaft.sections.0.fillet": 0.05})
    f, r = 0.05, 0.25
    ring = 2.0 * np.pi * (r + f * (5.0 / 6.0 - np.pi / 4.0) / (1.0 - np.pi / 4.0))
    more = shaft_volume(filleted.shaft) - exact
    assert more == pytest.approx(ring * (1.0 - np.pi / 4.0) * f**2, rel=1e-9)


def test_units_of_limits() -> None:
    assert parse_limit("life>=20 years").size("h") == 8766.0
    assert parse_limit("hub.stiffness.uz >= 1e9").size("N/m") == 1.0
    with pytest.raises(InputError, match="has the unit 'mm' but life is in h"):
        parse_limit("life>=20 mm").size("h")
    for text in ("life", "life>20", "life>=x", "life>=-1"):
        with pytest.raises(InputError):
            parse_limit(text)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--limit", "mass<=1 t"], "--limit is for a search"),
        (["--minimise", "mass"], "nothing may vary"),
        (["--minimise", "mass", "--vary", "shaft.front=-1:-0.9"], "has no limit"),
        (["--minimise", "mass", "--vary", "shaft.front=1:-1", "--limit", "a<=1"], "from a lower"),
        (
            ["--minimise", "masss", "--vary", "shaft.front=-1:-0.9", "--limit", "mass<=1 t"],
            "quantity 'masss' is unknown",
        ),
        (
            ["--minimise", "mass", "--vary", "shaft.frnt=-1:-0.9", "--limit", "mass<=1 t"],
            "design variable 'shaft.frnt': the scene has no number there: did you mean 'shaft.",
        ),
        (
            ["--minimise", "mass", "--vary", "shaft.materal=steel", "--limit", "mass<=1 t"],
            "design variable 'shaft.materal': the drivetrain has no such key: did you mean "
            "'shaft.material'",
        ),
    ],
)
def test_what_is_wrong_is_said(
    options: list[str], message: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "own.yaml"
    file.write_text(scene_text(_stepped()))
    with pytest.raises(SystemExit) as ended:
        main(["compare", str(file), "--out", str(tmp_path / "out"), *options])
    assert ended.value.code == 2
    assert message in " ".join(capsys.readouterr().err.split())
    assert not (tmp_path / "out").exists()


def test_the_command_finds_and_writes_the_design(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "own.yaml"
    file.write_text(scene_text(_stepped()))
    given = ["compare", str(file), "--minimise", "mass", "--starts", "1", "--tolerance", "90%"]
    given += ["--vary", "shaft.sections.0.inner_diameter=0.02:0.47", "--json"]
    given += ["--limit", "deflection<=0.16 mm", "--out", str(tmp_path / "out")]
    given += [part for name, value in LOAD.items() for part in ("--load", f"{name}={value}")]
    with pytest.raises(SystemExit) as ended:
        main(given)
    assert ended.value.code == 0
    said = json.loads(capsys.readouterr().out)
    assert said["schema"].startswith("fe-drivetrain/search/")
    (row,) = said["tables"]["design"]
    assert 0.02 <= row["found"] <= 0.47


def test_a_limit_without_a_unit_shows_the_one_that_it_took() -> None:
    asked = DesignQuantities(
        _stepped(), design_request(BORES, "mass", ["stress<=1e8", "mass.shaft<=2 t"], load=LOAD)
    )
    assert [str(one) for one in asked.request.limits] == ["stress<=1e+08 Pa", "mass.shaft<=2 t"]


def test_lists_that_keep_no_limit_are_to_be_given_more_values() -> None:
    vary = {"shaft.sections.0.inner_diameter": [0.1, 0.2, 0.3]}
    request = design_request(vary, "mass", ["deflection<=0.001 mm"], load=LOAD)
    with pytest.raises(InputError) as caught:
        search(_stepped(), request, starts=1)
    message = str(caught.value)
    assert "is kept by no design listed" in message
    assert message.endswith("relax it, or add values to the lists")
    assert "inner_diameter=0.1," in message  # the stiffest comes nearest


def test_slopes_of_a_ratio_count_where_they_were_found() -> None:
    """A move tells of one way alone: beyond a secant the others are asked again."""

    one = {"deflection": np.ones(1)}

    def ratios(at: Floats) -> dict[str, Floats]:
        return {"deflection": np.array([at[0] ** 2 - 0.5 * at[1]])}

    def checked(before: Correction | None, at: Floats) -> Correction:
        return correction(before, at, {"deflection": np.exp(ratios(at)["deflection"])}, one)

    first = checked(None, np.array([0.2, 0.7]))
    assert first.is_far
    found = with_slopes(first, ratios)
    assert not found.is_far
    assert found.slopes["deflection"][0] == pytest.approx([2 * 0.2 + SECANT, -0.5])
    near = checked(found, np.array([0.2, 0.7 - 0.9 * SECANT]))
    assert not near.is_far
    far = checked(near, np.array([0.6, 0.7 - 0.9 * SECANT]))
    assert far.is_far
    assert with_slopes(far, ratios).slopes["deflection"][0] == pytest.approx(
        [2 * 0.6 - SECANT, -0.5]
    )
