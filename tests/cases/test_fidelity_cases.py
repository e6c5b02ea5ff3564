"""The ladder's cases: all are found, and their scenes can be built."""

import numpy as np
import pytest

from fe_drivetrain.drivetrain_file.reading import library_scene
from fe_drivetrain.report.suite.case import find_cases
from fe_drivetrain.shafts.fidelity.ladder import shaft_level, statics_level
from fe_drivetrain.shafts.fidelity.quantity import Quantity

SCENES = (
    "housing_on_bedplate",
    "iea_15mw_main_shaft",
    "iea_15mw_shaft_on_nose",
    "main_bearing_bonded",
    "main_bearing_spherical",
    "nrel_5mw_main_shaft",
    "nrel_750kw_high_speed_shaft",
    "nrel_750kw_low_speed_shaft",
    "short_thick_shaft",
    "stepped_shaft",
    "three_point_suspension",
    "two_bearings",
)


def test_every_scene_has_its_case() -> None:
    found = {case.name for case in find_cases("fidelity")}
    assert found >= {f"fidelity/{name}" for name in SCENES}


@pytest.mark.parametrize("name", SCENES)
def test_cheap_levels_of_library_scenes(name: str) -> None:
    """Their beams stand, and statics agrees with them where it decides."""
    scene = library_scene(name)
    beam = shaft_level(scene, 1)
    Quantity("hub.stiffness.uz").check(scene)
    # of the largest reaction to each load: a gearbox may carry nothing
    size = np.max([abs(m).max(axis=0) for m in beam.reaction_matrices.values()], axis=0)
    for bearing, matrix in statics_level(scene).reaction_matrices.items():
        difference = (matrix - beam.reaction_matrices[bearing]) / size
        assert np.nanmax(abs(difference), initial=0.0) <= 1e-6
