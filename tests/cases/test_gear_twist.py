"""A gear that winds up along its face, beside a bar in torsion on an elastic foundation."""

import math

import numpy as np
import pytest

from fe_drivetrain.cases.dynamics.gear_twist import FaceTwist, with_twist
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.dynamics import Body, Place, assemble, gear_mesh, static
from fe_drivetrain.gear.working_angles import Mesh

RIGIDITY, STIFFNESS, WIDTH, RADIUS, TORQUE = 1e7, 2e9, 0.22, 0.1, 5e4
GEAR, RACK = Place("gear", (0.0, 0.0, 0.0)), Place("rack", (0.0, 0.3, 0.0))


def loads(slices: int, held: int) -> np.ndarray:
    """Load per length of each slice, from the smallest x [N/m]."""
    pitch = (0.0, RADIUS / math.cos(0.35), 0.0)
    mesh = gear_mesh("mesh", GEAR, RACK, pitch, Mesh(0.35, 0.0, WIDTH), STIFFNESS, slices=slices)
    angles, springs = with_twist(mesh, FaceTwist("gear", RIGIDITY, WIDTH, held))
    bodies = [Body("gear", free=frozenset({"rx"})), Body("rack", RACK.centre, free=frozenset())]
    system = assemble([*bodies, *angles], springs)
    found = static(system, system.load_on("gear", TORQUE * np.eye(6)[3]))
    each = [found.force(f"mesh slice {i + 1}") for i in range(slices)]
    return np.array(each) * slices / WIDTH


@pytest.mark.parametrize("held", [1, -1])
def test_load_over_the_face_is_that_of_a_bar_in_torsion(held: int) -> None:
    kappa = math.sqrt(STIFFNESS / WIDTH * RADIUS**2 / RIGIDITY)
    errors = []
    for slices in (10, 20):
        x = (np.arange(slices) + 0.5) / slices * WIDTH
        exact = kappa * np.cosh(kappa * x) / np.sinh(kappa * WIDTH) * TORQUE / RADIUS
        errors.append(np.abs(loads(slices, held)[::held] / exact - 1.0).max())
    assert errors[1] < 1e-4
    assert errors[0] / errors[1] == pytest.approx(4.0, rel=0.05)  # of the second order


def test_a_gear_without_slices_is_refused() -> None:
    one = gear_mesh("mesh", GEAR, RACK, (0.0, 0.1, 0.0), Mesh(0.35), STIFFNESS)
    with pytest.raises(InputError, match="one number of slices, 2 or more"):
        with_twist(one, FaceTwist("gear", RIGIDITY, WIDTH))
    with pytest.raises(InputError, match="rigidity is 0 but must be"):
        FaceTwist("gear", 0.0, WIDTH)
