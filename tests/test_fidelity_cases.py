"""The ladder's cases: the quickest two run; all are found, and their scenes can be built."""

from pathlib import Path

import pytest

from fe_drivetrain.adviser import Quantity
from fe_drivetrain.case import find_cases, run_case
from fe_drivetrain.levels import shaft_level, statics_level
from fe_drivetrain.scene import library_scene

SCENES = (
    "main_bearing_bonded",
    "main_bearing_spherical",
    "two_bearings",
    "short_thick_shaft",
    "stepped_shaft",
)


def test_every_scene_has_its_case() -> None:
    assert {case.name for case in find_cases("fidelity")} == {f"fidelity/{s}" for s in SCENES}


@pytest.mark.parametrize("name", ["main_bearing_spherical", "short_thick_shaft"])
def test_a_level_is_found_that_is_enough(tmp_path: Path, name: str) -> None:
    (case,) = find_cases(f"fidelity/{name}")
    results = run_case(case, tmp_path / "out", quick=True)
    assert results.passed
    rungs = results.figures["rungs"]
    assert [rung["level"] for rung in rungs] == [0, 1, 1, 2, 4]
    assert rungs[-1]["error"] == 0.0
    assert rungs[1]["seconds"] < rungs[-1]["seconds"]


@pytest.mark.parametrize("name", SCENES)
def test_cheap_levels_of_library_scenes(name: str) -> None:
    """Their beams stand, and statics agrees with them where it decides."""
    scene = library_scene(name)
    beam = shaft_level(scene, 1)
    Quantity("hub.stiffness.uz").check(scene)
    for bearing, matrix in statics_level(scene).reaction_matrices.items():
        reference = beam.reaction_matrices[bearing]
        known = abs(matrix) < 1e30  # not NaN
        assert abs((matrix - reference)[known]).max(initial=0.0) <= 1e-6 * abs(reference).max()
