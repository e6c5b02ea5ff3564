"""A shaft of given stiffness in bending is one beam in all directions, in any number of pieces."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from fe_drivetrain.drivetrain_file.turning_parts import ShaftData
from fe_drivetrain.dynamics.bodies.bodies import Body, assemble
from fe_drivetrain.dynamics.bodies.machine_shafts import shaft_slices, shaft_springs
from fe_drivetrain.dynamics.bodies.springs import Place


@pytest.mark.parametrize("pieces", [1, 3])
@pytest.mark.parametrize("bending", [None, 1.34e8])
def test_a_cantilever_sags_and_turns_as_a_beam(pieces: int, bending: float | None) -> None:
    L = 1.002
    shaft = ShaftData(name="LSS", length=L, torsion=7.19e7, bending=bending)
    at = np.linspace(0.0, L, pieces + 1)
    bodies = [Body(f"node {k}", (float(x), 0.0, 0.0), 1.0, 1.0, 1.0) for k, x in enumerate(at)]
    places = [Place(body.name, body.position) for body in bodies]
    held = Body("node 0", bodies[0].position, 1.0, 1.0, 1.0, free=frozenset())
    springs = [
        spring
        for k in range(pieces)
        for spring in shaft_springs(
            f"element {k}", shaft, places[k : k + 2], (at[k], at[k + 1]), (0.0, 0.0, 0.0)
        )
    ]
    system = assemble([held, *bodies[1:]], springs)
    end = f"node {pieces}"
    (whole,) = shaft_slices(shaft, 0.0, L)
    EI = 1.3 * 7.19e7 * L if bending is None else bending * L
    sheared = L / (shaft.material.shear_modulus * whole.section.shear_areas[0])
    force = np.linalg.solve(system.K, system.load_on(end, np.eye(6)[1]))
    moment = np.linalg.solve(system.K, system.load_on(end, np.eye(6)[5]))
    assert_allclose(force[system.place(f"{end} uy")], L**3 / (3 * EI) + sheared, rtol=1e-9)
    assert_allclose(force[system.place(f"{end} rz")], L**2 / (2 * EI), rtol=1e-9)
    assert_allclose(moment[system.place(f"{end} rz")], L / EI, rtol=1e-9)
