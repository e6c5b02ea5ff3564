"""Sensitivities and samples against what closed forms say."""

import numpy as np
import pytest
from conftest import coarse_scene

from fe_drivetrain.errors import InputError
from fe_drivetrain.scene import Scene, Spread, change_scene
from fe_drivetrain.uncertainty import (
    nominal_value,
    sample,
    sensitivities,
    sobol_shares,
    with_values,
)

DIAMETER = "shaft.sections.0.outer_diameter"
LENGTH = "shaft.sections.0.length"
MODULUS = "materials.steel.youngs_modulus"


def torsion(scene: Scene) -> float:
    """G J / L of the shaft."""
    G = scene.material_of("shaft").shear_modulus
    twists = [
        section.length / (section.outer_diameter**4 - section.inner_diameter**4)
        for section in scene.shaft.sections
    ]
    return float(G * np.pi / 32 / sum(twists))


@pytest.fixture(scope="module")
def scene() -> Scene:
    return coarse_scene("spherical")


def test_torsion_goes_with_the_fourth_power_of_the_diameter(scene: Scene) -> None:
    found = sensitivities(scene, torsion, [DIAMETER, LENGTH, MODULUS])
    assert found[DIAMETER] == pytest.approx(4.0, rel=1e-4)
    assert found[LENGTH] == pytest.approx(-1.0, rel=1e-4)
    assert found[MODULUS] == pytest.approx(1.0, rel=1e-4)


def test_first_order_variance_of_a_power_law(scene: Scene) -> None:
    """Small spreads: the variance is that of the first-order terms."""
    spreads = {DIAMETER: Spread(normal=0.002), MODULUS: Spread(uniform=0.01)}
    found = sample(scene, torsion, spreads, count=256)
    parts = np.array([(4 * 0.002) ** 2, 0.01**2 / 3])
    assert found.values.std() / found.nominal == pytest.approx(np.sqrt(parts.sum()), rel=0.02)
    assert found.linear_share > 0.999
    np.testing.assert_allclose(found.contributions(), parts / parts.sum(), atol=0.03)
    low, high = found.band(0.95)
    assert low < found.nominal < high


def test_shares_of_sobol_agree_with_the_plane(scene: Scene) -> None:
    spreads = {DIAMETER: Spread(normal=0.002), MODULUS: Spread(uniform=0.01)}
    first, total = sobol_shares(scene, torsion, spreads, count=256)
    parts = np.array([(4 * 0.002) ** 2, 0.01**2 / 3])
    # 256 samples: some percent
    np.testing.assert_allclose(first, parts / parts.sum(), atol=0.06)
    np.testing.assert_allclose(total, first, atol=0.06)


def test_a_scene_carries_its_own_spreads(scene: Scene) -> None:
    own = change_scene(scene, {"uncertainty": {MODULUS: {"lognormal": 0.05}}})
    found = sample(own, torsion, count=200, seed=1)
    assert np.median(found.values) == pytest.approx(found.nominal, rel=0.01)
    assert np.std(np.log(found.values)) == pytest.approx(0.05, rel=0.1)


def test_values_by_key(scene: Scene) -> None:
    assert nominal_value(scene, MODULUS) == 200e9
    assert nominal_value(scene, "bearing_units.main_bearing.housing.wall") == 0.11
    assert nominal_value(scene, "gearbox.stiffness.1") == 8e7
    changed = with_values(scene, {MODULUS: 210e9})
    assert changed.material_of("shaft").youngs_modulus == 210e9
    assert changed.material_of("shaft").density == 7850.0


@pytest.mark.parametrize("key", ["shaft.material", "shaft.nothing", "gearbox.stiffness.3", "x.9"])
def test_what_is_no_number_is_refused(scene: Scene, key: str) -> None:
    with pytest.raises(InputError, match="has no number there"):
        nominal_value(scene, key)


@pytest.mark.parametrize(
    ("spread", "message"),
    [
        ({}, "give one of uniform, normal and lognormal, not none"),
        ({"uniform": 0.1, "normal": 0.1}, "not uniform and normal"),
        ({"uniform": -1}, "must be greater than 0"),
        ({"even": 0.1}, "unknown key"),
    ],
)
def test_a_wrong_spread_gets_one_sentence(scene: Scene, spread: object, message: str) -> None:
    with pytest.raises(InputError, match=message):
        change_scene(scene, {"uncertainty": {MODULUS: spread}})


def test_a_scene_without_uncertainty_says_how_to_add_some(scene: Scene) -> None:
    with pytest.raises(InputError, match="add some under 'uncertainty'"):
        sample(scene, torsion)
