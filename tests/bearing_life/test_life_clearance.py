"""The clearance that a mounting makes is that of a life's rollers, and its band is on the page."""

from pathlib import Path

import pytest
from hub_load_tables import openfast_text

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file import Scene, library_scene, read_drivetrain
from fe_drivetrain.drivetrain_file.mounted_bearings import unit_clearance
from fe_drivetrain.studies import check, life
from fe_drivetrain.studies.bearing_lives import LifeResult
from fe_drivetrain.studies.life_options import LifeOptions

MOUNTING = {
    "internal_clearance": [2.6e-4, 4.1e-4],
    "fit": {"shaft": "m6", "housing": "H7", "outside_diameter": 0.72},
    "temperatures": {"inner_ring": 60, "outer_ring": 52},
}


def mounted(**mounting: object) -> Scene:
    data = library_scene("two_bearings").model_dump(mode="json")
    data["bearing_units"][1]["mounting"] = mounting
    return Scene.model_validate(data)


@pytest.fixture(scope="module")
def history(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return openfast_text(tmp_path_factory.mktemp("loads") / "a.out")


@pytest.fixture(scope="module")
def with_band(history: Path) -> LifeResult:
    return life(mounted(**MOUNTING), history, options=LifeOptions(only="rear"))


def lives_at(history: Path, clearance: float) -> float:
    """L10mr with a clearance that was measured, and no band."""
    scene = mounted(mounted_clearance=[clearance, clearance])
    found = life(scene, history, options=LifeOptions(only="rear"))
    return found.bearings["rear"].years["L10mr"]


def test_rollers_have_the_mean_of_the_operating_clearance(
    with_band: LifeResult, history: Path
) -> None:
    of = with_band.bearings["rear"]
    clearance = of.bearing.clearance
    assert clearance is not None
    (first, *_) = of.bearing.rated.bearing.rows
    assert first.clearance == pytest.approx(clearance.along_normal.mean, rel=1e-12)
    same = lives_at(history, clearance.radial.mean)
    assert of.years["L10mr"] == pytest.approx(same, rel=1e-9)


def test_lives_at_both_ends_of_the_band_are_those_of_these_clearances(
    with_band: LifeResult, history: Path
) -> None:
    """All steps of a short file are in the sample, so that the lives are those of another run."""
    of = with_band.bearings["rear"]
    found = {one.instead: one.years for one in of.clearances}
    assert of.bearing.clearance is not None
    radial = of.bearing.clearance.radial
    for name, value in (("least", radial.least), ("most", radial.most), ("zero", 0.0)):
        assert found[name] == pytest.approx(lives_at(history, value), rel=1e-6)
    # loose: fewer rollers carry more
    assert found["zero"] > found["least"] > of.years["L10mr"] > found["most"]


def test_tables_show_them(with_band: LifeResult) -> None:
    rows = with_band.tables["clearances"]
    assert [row["clearance"] for row in rows] == ["zero", "least", "mean", "most"]
    parts = with_band.tables["clearance_parts"]
    *added, whole, _probable, _p, _q, _stress = parts
    for column in ("least clearance", "mean", "most clearance"):
        assert sum(row[column] for row in added) == pytest.approx(whole[column], rel=1e-9)


def test_seats_of_the_scene_are_those_of_the_fit() -> None:
    """A stiffer way round: the scene's bore and shell, stated, change nothing."""
    scene = mounted(**MOUNTING)
    from fe_drivetrain.bearing import catalogue_entry

    entry = catalogue_entry("spherical_230_500")
    shell = scene.bearing_units[1].bearing.raceway_diameter + 2 * scene.blocks["rear"].wall
    fit = {**MOUNTING["fit"], "shaft_bore": 0.1, "housing_diameter": shell}  # type: ignore[dict-item]
    stated = unit_clearance(mounted(**{**MOUNTING, "fit": fit}), "rear", entry)
    found = unit_clearance(scene, "rear", entry)
    assert stated is not None
    assert found is not None
    assert stated.radial == found.radial
    assert not any("solid shaft" in text for text in found.assumed)


HOT = {"temperatures": {"inner_ring": 250, "outer_ring": -60}}


@pytest.mark.parametrize(
    ("more", "key"),
    [
        (HOT, r"mounting\.temperatures makes -2\.34 mm"),
        ({"speed": 1500}, r"mounting\.speed makes -3\.07\d? mm"),
        ({"internal_clearance": [4e-3, 5e-3]}, r"mounting\.internal_clearance makes \+5 mm"),
    ],
)
def test_check_refuses_the_clearance_that_life_refuses(
    more: dict[str, object], key: str, history: Path
) -> None:
    scene = mounted(**{**MOUNTING, **more})
    for study in (check, lambda one: life(one, history, options=LifeOptions(only="rear"))):
        with pytest.raises(InputError, match=f"bearing 'rear': radial clearance .*{key} of it"):
            study(scene)


def test_check_refuses_it_of_the_gearbox_too() -> None:
    base = {"gearbox.stages.0.pins.0.mounting": {"clearance_class": "C3", "speed": 1e4}}
    with pytest.raises(InputError, match="bearing 'upwind': radial clearance in operation is -"):
        check(read_drivetrain("nrel_5mw", base))
