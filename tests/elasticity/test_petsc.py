"""Systems in parts, on one, two and four processes of MPI, against the solver of this process."""

from functools import cache
from itertools import product

import numpy as np
import pytest
from coarse_scenes import coarse_scene
from element_systems import SYSTEMS

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.materials import MATERIALS
from fe_drivetrain.elasticity.interfaces.constraints import eliminate, fixed
from fe_drivetrain.elasticity.mesh.blocks import brick
from fe_drivetrain.elasticity.solve import petsc
from fe_drivetrain.elasticity.solve.element_system import ElementSystem, cut
from fe_drivetrain.elasticity.solve.reduction import reduce
from fe_drivetrain.elasticity.solve.solvers import factorise, solve
from fe_drivetrain.shafts.response.model import build_model, mesh_scene


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
    ("method", "ranks"),
    [*product(("petsc",), (1, 2, 4)), *product(("petsc-mumps",), (1, 2))],
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


@pytest.mark.needs("mpiexec")
@pytest.mark.parametrize(
    ("kind", "method", "ranks"),
    [
        *product(("averaged", "mortar"), ("petsc",), (1, 2)),
        ("sliding", "petsc", 2),
        # of four processes one with each method
        *product(("bonded",), ("petsc",), (1, 2, 4)),
        *product(("rubber",), ("petsc-mumps",), (1, 2, 4)),
    ],
)
def test_rows_that_processes_assemble_answer_as_the_whole(
    with_petsc, monkeypatch, kind, method, ranks
):
    system, F, exact = answered(kind)
    monkeypatch.setenv(petsc.MPI_VARIABLE, f"mpiexec -n {ranks}")
    monkeypatch.setattr(ElementSystem, "whole", None)  # nobody has the matrix
    found = factorise(system, method, tolerance=1e-10).solve(F)
    assert found.diagnostics.reason == "as asked"
    assert found.diagnostics.energy_error <= 1e-10
    difference = np.abs(found.x - exact.x).max(axis=0)
    assert (difference < 1e-8 * np.abs(exact.x).max(axis=0)).all()
    assert found.diagnostics.round_off == pytest.approx(exact.diagnostics.round_off, rel=1e-6)
    assert found.diagnostics.residual < 1e-6
    assert found.diagnostics.n_unknowns == exact.diagnostics.n_unknowns


@cache
def answered(kind):
    """A system of elements, two loads, and what the default answers."""
    system = SYSTEMS[kind]()
    F = np.zeros((len(system.elimination.free), 2))
    body = system.body[: len(system.points)]
    # pulled at one node of the first body, and turned
    far = np.argsort(system.points[:, 0] + 1e9 * body)[:3]
    F[3 * far[:1] + 1, 0], F[3 * far[:2] + 2, 1] = 1.0, [1.0, -1.0]
    F = system.elimination.T.T @ F
    return system, F, solve(system, F, tolerance=1e-10)


@pytest.mark.needs("mpiexec")
def test_more_processes_have_less_memory_each(with_petsc, monkeypatch):
    """Of a bar of 38 thousand unknowns; interpreter and libraries left out."""
    block = brick((28, 7, 7), 10, lambda x: x * [4.0, 1.0, 1.0])
    n = block.points.size
    end = fixed("end", np.flatnonzero(block.points[:, 0] == 0.0), n)
    steel = MATERIALS["steel"].lame
    system = ElementSystem(block.points, [(block.cells, steel)], eliminate([end], n))
    facts = []
    for ranks in (1, 2, 4):
        monkeypatch.setenv(petsc.MPI_VARIABLE, f"mpiexec -n {ranks}")
        facts.append(petsc.Ranks(system, "petsc").facts)
        assert facts[-1]["ranks"] == len(facts[-1]["bytes"]) == ranks
        assert max(facts[-1]["nnz"]) < 1.1 * sum(facts[-1]["nnz"]) / ranks
        assert sum(facts[-1]["elements"]) == cut(system, ranks).cells_of.nnz
    one, two, four = (max(fact["bytes"]) for fact in facts)
    assert two < 0.8 * one
    assert four < 0.8 * two
    assert sum(facts[0]["elements"]) == len(system.cells)


@pytest.mark.needs("mpiexec")
def test_parts_that_stop_short_are_put_together(with_petsc, monkeypatch):
    system, F, exact = answered("mortar")
    monkeypatch.setenv(petsc.MPI_VARIABLE, "mpiexec -n 2")
    monkeypatch.setattr(petsc, "MAXIMUM", 3)
    found = solve(system, F, "petsc", tolerance=1e-10)
    assert "petsc stopped after 3 iterations" in found.diagnostics.reason
    assert (np.abs(found.x - exact.x) < 1e-8 * np.abs(exact.x).max(axis=0)).all()


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
    monkeypatch.setattr(petsc, "MAXIMUM", 3)
    found = solve(system, F[:, :1], "petsc", tolerance=1e-10)
    assert found.diagnostics.method not in petsc.METHODS
    assert "petsc stopped after 3 iterations" in found.diagnostics.reason
    assert np.abs(found.x[:, 0] - exact.x[:, 0]).max() < 1e-8 * np.abs(exact.x[:, 0]).max()
