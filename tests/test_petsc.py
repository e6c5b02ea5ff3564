"""Systems in parts, on one, two and four processes of MPI, against the solver of this process."""

from itertools import pairwise

import numpy as np
import pytest
from conftest import coarse_scene

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.interfaces.constraints import eliminate
from fe_drivetrain.response.model import build_model, mesh_scene
from fe_drivetrain.solve import petsc
from fe_drivetrain.solve.reduction import reduce
from fe_drivetrain.solve.solvers import factorise, solve


@pytest.fixture(scope="module")
def with_petsc():
    if petsc.interpreter() is None:
        pytest.skip(f"no Python here has petsc4py: {petsc.INSTALL}")


@pytest.fixture(scope="module")
def jointed():
    """A shaft that sits in its housing by means over faces; two unit loads."""
    scene = coarse_scene("spherical", **{"bearing_units.0.interface": "averaged"})
    model = build_model(scene, mesh_scene(scene))
    elimination = eliminate(model.constraints, model.n_dofs)
    system = reduce(
        model.mesh.points, model.mesh.cells, model.stiffness, elimination, model.springs
    )
    F = (elimination.T.T @ model.unit_loads())[:, 2:4]
    return system, F, solve(system, F, tolerance=1e-10)


@pytest.mark.needs("mpiexec")
@pytest.mark.parametrize(
    ("method", "ranks"), [("petsc", 1), ("petsc", 2), ("petsc", 4), ("petsc-mumps", 2)]
)
def test_parts_answer_as_the_whole(with_petsc, jointed, monkeypatch, method, ranks):
    system, F, exact = jointed
    monkeypatch.setenv(petsc.MPI_VARIABLE, f"mpiexec -n {ranks}")
    solver = factorise(system, method, tolerance=1e-10)
    found = solver.solve(F)
    again = solver.solve(F[:, ::-1])  # set up once
    for one, columns in ((found, slice(None)), (again, slice(None, None, -1))):
        assert one.diagnostics.method == method
        assert one.diagnostics.reason == "as asked"
        assert one.diagnostics.energy_error <= 1e-10
        difference = np.abs(one.x[:, columns] - exact.x).max(axis=0)
        assert (difference < 1e-8 * np.abs(exact.x).max(axis=0)).all()
    assert solver.bytes > 0


def test_parts_are_equal_and_compact(rng):
    points = rng.uniform(size=(1003, 3)) * [10.0, 1.0, 1.0]
    order = petsc.parts(points, 5)
    assert sorted(order) == list(range(1003))
    runs = np.split(order, np.cumsum([201, 201, 201, 200]))
    assert [len(run) for run in runs] == [201, 201, 201, 200, 200]
    # along the long axis
    ends = [(points[run, 0].min(), points[run, 0].max()) for run in runs]
    assert all(high <= low for (_, high), (low, _) in pairwise(ends))


def test_without_petsc_it_is_said_how_to_get_it(jointed, monkeypatch):
    monkeypatch.setattr(petsc, "interpreter", lambda: None)
    with pytest.raises(InputError, match="apt-get install python3-petsc4py"):
        factorise(jointed[0], "petsc")


@pytest.mark.needs("mpiexec")
def test_processes_that_die_are_a_mistake_and_not_a_hang(with_petsc, jointed, monkeypatch):
    monkeypatch.setenv(petsc.MPI_VARIABLE, "mpiexec -n 1 -x PYTHONHOME=/nowhere")
    with pytest.raises(InputError, match="PETSc ended with status"):
        factorise(jointed[0], "petsc")


@pytest.mark.needs("mpiexec")
def test_an_iteration_that_stops_short_falls_back_and_says_so(with_petsc, jointed, monkeypatch):
    system, F, exact = jointed
    monkeypatch.setenv(petsc.MPI_VARIABLE, "mpiexec -n 1")
    monkeypatch.setattr(petsc, "MOST", 3)
    found = solve(system, F[:, :1], "petsc", tolerance=1e-10)
    assert found.diagnostics.method not in petsc.METHODS
    assert "petsc stopped after 3 iterations" in found.diagnostics.reason
    assert np.abs(found.x[:, 0] - exact.x[:, 0]).max() < 1e-8 * np.abs(exact.x[:, 0]).max()
