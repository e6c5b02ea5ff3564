"""Reactions to hub-load histories hold the weight of the parts."""

import numpy as np
import pytest
from coarse_scenes import coarse_scene

from fe_drivetrain.common import Floats
from fe_drivetrain.common.components import GRAVITY
from fe_drivetrain.common.steps import Steps
from fe_drivetrain.studies import Assembly, solved_assembly


@pytest.fixture(scope="module")
def solved() -> Assembly:
    return solved_assembly(Steps(), coarse_scene("spherical"))


@pytest.fixture
def hub(rng) -> Floats:
    """Two histories of hub loads."""
    return rng.normal(size=(2, 50, 6)) * 1e5


def reaction_of(solved: Assembly, name: str, hub: Floats, self_weight: bool = True) -> Floats:
    """One reaction to hub loads, with the weight of the gearbox, and of the parts."""
    gravity = GRAVITY if self_weight else 0.0
    return solved.response.history(name, hub, solved.scene.gearbox.weight, gravity)


def weight_of(solved: Assembly, *parts: str) -> float:
    """Weight of parts by their geometry [N]."""
    return GRAVITY * sum(float(solved.model.part_mass[part].sum()) for part in parts)


def test_all_weight_is_carried(solved, hub):
    """Bearing and gearbox carry hub force, gearbox and, if it is in, the weight of all parts."""
    own = weight_of(solved, "shaft", "main_bearing", "main_bearing.housing")
    assert own > 1e3
    for self_weight, parts in ((True, own), (False, 0.0)):
        carried = sum(
            reaction_of(solved, name, hub, self_weight)[..., 2]
            for name in ("main_bearing", "gearbox")
        )
        expected = hub[..., 2] - solved.scene.gearbox.weight - parts
        np.testing.assert_allclose(carried, expected, rtol=1e-8, atol=1e-3)


def test_housing_weighs_on_its_base_and_not_on_the_bearing(solved, hub):
    base, outer, seat = (
        reaction_of(solved, f"main_bearing{face}", hub)[..., 2] for face in ("", ".outer", ".seat")
    )
    np.testing.assert_allclose(
        outer - base, weight_of(solved, "main_bearing.housing"), rtol=1e-6, atol=1e-2
    )
    np.testing.assert_allclose(seat - outer, weight_of(solved, "main_bearing"), rtol=1e-6, atol=0.1)
