"""NGSolve's shafts against closed forms."""

import numpy as np
import pytest

from fe_drivetrain.cases.verification.independent_shafts import independent_shaft
from fe_drivetrain.cases.verification.random_shafts import random_scene
from fe_drivetrain.geometry import Section, Shaft

pytestmark = pytest.mark.needs("ngsolve")


@pytest.mark.parametrize("bore", [0.0, 0.2])
def test_a_uniform_shaft_is_as_theory_has_it(bore: float) -> None:
    """Tension and twist are exact, bending by a moment, too: sections stay plane."""
    length, diameter = 1.5, 0.5
    scene = random_scene(2)
    section = Section(length=length, outer_diameter=diameter, inner_diameter=bore)
    found = independent_shaft(scene, Shaft(front=-0.3, sections=(section,))).compliance
    steel = scene.material_of("shaft")
    area, second = np.pi / 4 * (diameter**2 - bore**2), np.pi / 64 * (diameter**4 - bore**4)
    E, G = steel.youngs_modulus, steel.shear_modulus
    assert found[0, 0] == pytest.approx(length / (E * area), rel=1e-4)
    assert found[3, 3] == pytest.approx(length / (G * 2 * second), rel=1e-6)
    assert found[5, 5] == pytest.approx(length / (E * second), rel=1e-4)
    # a moment about z lifts the front end's mean to the opposite side
    assert found[1, 5] == pytest.approx(-(length**2) / (2 * E * second), rel=1e-4)
    assert found[1, 1] > length**3 / (3 * E * second)
    np.testing.assert_allclose(found, found.T, rtol=1e-6, atol=1e-9 * found.max())
