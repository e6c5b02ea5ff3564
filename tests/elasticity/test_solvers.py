"""Every solver behind one interface, on systems whose answer is known."""

import importlib.util
import os
import sys

import numpy as np
import pytest
from scipy import sparse

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.interpreter import run_python
from fe_drivetrain.common.spatial import rigid_motions
from fe_drivetrain.elasticity.interfaces.constraints import eliminate, fixed
from fe_drivetrain.elasticity.mesh.blocks import brick
from fe_drivetrain.elasticity.operator.elasticity import assemble
from fe_drivetrain.elasticity.solve import cost_model, direct_solvers, multigrid, petsc
from fe_drivetrain.elasticity.solve.reduction import System, reduce
from fe_drivetrain.elasticity.solve.solvers import ITERATIVE, METHODS, factorise, solve


def missing(method):
    return method in direct_solvers.PACKAGES and not direct_solvers.is_installed(method)


EACH = [
    pytest.param(
        method,
        marks=pytest.mark.needs(direct_solvers.PACKAGES[method])
        if method in ("pardiso", "cholmod")
        else [],
    )
    for method in METHODS
    if method != "auto" and method not in petsc.METHODS  # test_petsc.py
]


def tetrahedra(cuts):
    """A unit cube of linear tetrahedra."""
    x = np.linspace(0.0, 1.0, cuts + 1)
    points = np.array([(a, b, c) for c in x for b in x for a in x])
    m = cuts + 1
    i, j, k = np.meshgrid(*[np.arange(cuts)] * 3, indexing="ij")
    first = (i + m * j + m * m * k).ravel()
    corners = first[:, None] + np.array(
        [0, 1, 1 + m, m, m * m, 1 + m * m, 1 + m + m * m, m + m * m]
    )
    split = [(0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6)]
    return points, np.concatenate([corners[:, list(s)] for s in split])


@pytest.fixture(scope="module")
def cube():
    """Stiffness of a cube held at one face, as a system."""
    points, cells = tetrahedra(6)
    K = assemble(points, cells, (1.0, 1.0))
    held = fixed("wall", np.flatnonzero(points[:, 0] == 0.0), points.size)
    elimination = eliminate([held], points.size)
    return reduce(points, cells, K, elimination), elimination


def known(system, elimination, rng, columns=3):
    x = rng.standard_normal((system.K.shape[0], columns)) * elimination.free[:, None]
    return x, system.K @ x


@pytest.mark.parametrize("method", EACH)
def test_recovers_a_known_solution(cube, method, rng):
    system, elimination = cube
    x, F = known(system, elimination, rng)
    solution = solve(system, F, method, tolerance=1e-12)
    np.testing.assert_allclose(solution.x, x, atol=1e-9 * np.abs(x).max())
    assert solution.diagnostics.method == method
    assert solution.diagnostics.reason == "as asked"
    assert solution.diagnostics.residual < 1e-10
    assert solution.diagnostics.energy_error < 1e-12
    assert solution.diagnostics.bytes > 0
    assert (solution.diagnostics.iterations > 0) == (method in ITERATIVE)
    assert 0.0 < solution.diagnostics.round_off < 1e-10


@pytest.mark.parametrize(("wrong", "taken"), [(1e-3, [40, 1, 40]), (0.0, [40, 1])])
def test_a_direct_solution_is_refined_unless_it_has_the_few_digits_asked_for(
    cube, monkeypatch, rng, wrong, taken
):
    system, elimination = cube
    x, F = known(system, elimination, rng, 40)
    right, columns = direct_solvers.factorise(system.K, "superlu"), []

    def apply(F):
        columns.append(F.shape[1])
        return (1.0 + wrong) * right.apply(F)

    factor = direct_solvers.Factor(apply, right.bytes)
    monkeypatch.setattr(direct_solvers, "factorise", lambda K, method: factor)
    solution = solve(system, F, "superlu", tolerance=1e-5)
    assert columns == taken
    error = np.einsum("nm,nm->m", solution.x - x, system.K @ (solution.x - x))
    assert np.sqrt(error / np.einsum("nm,nm->m", F, x)).max() < 1e-5
    assert solution.diagnostics.energy_error == pytest.approx(wrong, rel=0.01, abs=1e-12)
    columns.clear()
    solve(system, F, "superlu")
    assert columns == [40, 40]  # all digits: always refined


@pytest.mark.parametrize("method", EACH)
def test_set_up_once_and_solve_again(cube, method, rng):
    system, elimination = cube
    solver = factorise(system, method, tolerance=1e-12)
    for columns in (1, 4):
        x, F = known(system, elimination, rng, columns)
        np.testing.assert_allclose(solver.solve(F).x, x, atol=1e-9 * np.abs(x).max())


@pytest.mark.parametrize("method", EACH)
def test_the_system_is_left_as_it_is(cube, method, rng):
    system, elimination = cube
    _, F = known(system, elimination, rng)
    before, load = system.K.data.copy(), F.copy()
    solve(system, F, method)
    assert np.array_equal(system.K.data, before)
    assert np.array_equal(F, load)


@pytest.mark.parametrize("method", EACH)
def test_residual_is_the_true_one(cube, method, rng):
    system, elimination = cube
    _, F = known(system, elimination, rng)
    solution = solve(system, F, method, tolerance=1e-3)
    true = np.linalg.norm(system.K @ solution.x - F, axis=0) / np.linalg.norm(F, axis=0)
    assert solution.diagnostics.residual == pytest.approx(true.max())


@pytest.mark.parametrize("method", EACH)
def test_zero_load_is_no_division_by_zero(cube, method):
    system, _ = cube
    solution = solve(system, np.zeros((system.K.shape[0], 1)), method)
    assert solution.diagnostics.residual == 0.0
    assert np.abs(solution.x).max() == 0.0


@pytest.mark.parametrize("method", [m for m in EACH if m.values[0] not in ITERATIVE])
def test_singular_matrix_is_refused(method):
    points, cells = tetrahedra(2)
    K = assemble(points, cells, (1.0, 1.0))
    system = reduce(points, cells, K, eliminate([], points.size))
    with pytest.raises(InputError, match="singular"):
        solve(system, rigid_motions(points), method)


@pytest.mark.parametrize("method", ["multigrid", "schwarz"])
def test_iterations_refuse_a_floating_body(method):
    """No solution exists: it must not pass one off, and the direct solver behind it neither."""
    points, cells = tetrahedra(3)
    K = assemble(points, cells, (1.0, 1.0))
    system = reduce(points, cells, K, eliminate([], points.size))
    with pytest.raises(InputError, match="singular"):
        solve(system, rigid_motions(points)[:, :1], method)


@pytest.mark.parametrize("method", ["multigrid", "schwarz"])
def test_an_iteration_that_stalls_falls_back_and_says_so(cube, rng, monkeypatch, method):
    system, elimination = cube
    x, F = known(system, elimination, rng)
    monkeypatch.setattr(multigrid, "MAX_ITERATIONS", 3)
    solution = solve(system, F, method)
    assert solution.diagnostics.method in direct_solvers.PACKAGES
    assert f"{method} stopped after 3 iterations" in solution.diagnostics.reason
    np.testing.assert_allclose(solution.x, x, atol=1e-9 * np.abs(x).max())


def test_an_iteration_that_stalls_fails_where_no_factor_fits(cube, rng, monkeypatch):
    system, elimination = cube
    _, F = known(system, elimination, rng)
    monkeypatch.setattr(multigrid, "MAX_ITERATIONS", 3)
    monkeypatch.setattr(cost_model, "available_memory", lambda: 1000.0)
    with pytest.raises(InputError, match=r"stopped after 3 iterations.*relative residual.*memory"):
        solve(system, F, "multigrid")


def test_auto_names_its_choice_and_the_others(cube, rng):
    system, elimination = cube
    _, F = known(system, elimination, rng)
    solution = solve(system, F)
    costs = cost_model.predict(system, F.shape[1])
    assert solution.diagnostics.method == costs[0].method
    for each in costs:
        assert each.method in solution.diagnostics.reason
    assert [c.seconds for c in costs] == sorted(c.seconds for c in costs)


def test_auto_takes_no_factor_that_does_not_fit(cube, monkeypatch):
    system, _ = cube
    monkeypatch.setattr(cost_model, "available_memory", lambda: 1000.0)
    assert not any(c.fits for c in cost_model.predict(system, 1))
    monkeypatch.setattr(cost_model, "available_memory", lambda: 1e12)
    assert all(c.fits for c in cost_model.predict(system, 1))


def test_width_tells_a_rod_from_a_cube():
    """A row of cubes has the cross-section of one, whatever its length."""
    points, cells = tetrahedra(5)
    rows = []
    for copies in (1, 8):
        moved, joined = [], []
        for k in range(copies):
            moved.append(points + np.array([k, 0, 0]))
            joined.append(cells + k * len(points))
        everywhere = np.round(np.vstack(moved), 9)
        unique, number = np.unique(everywhere, axis=0, return_inverse=True)
        rod = number[np.vstack(joined)]
        rows.append(cost_model.width(assemble(unique, rod, (1.0, 1.0))))
    assert 0.5 < rows[1] / rows[0] < 2.0


def test_missing_solver_says_how_to_install(cube, monkeypatch):
    system, _ = cube
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    with pytest.raises(InputError, match=r"pip install 'fe-drivetrain\[pardiso\]'"):
        factorise(system, "pardiso")


FAULTY = {
    "pardiso": ("pypardiso", "no library mkl_rt"),
    "cholmod": ("sksparse", "libcholmod.so.3: cannot open shared object file"),
}


@pytest.fixture
def put_in_place(tmp_path, monkeypatch):
    """A function that puts a package of some lines in the place of an optional solver's."""
    put = []

    def put_lines(name, lines):
        put.append(name)
        for module in [m for m in sys.modules if m.partition(".")[0] == name]:
            monkeypatch.delitem(sys.modules, module)
        direct_solvers._fault.cache_clear()
        (tmp_path / name).mkdir()
        for file in ("__init__.py", "cholmod.py"):
            (tmp_path / name / file).write_text(lines, "utf-8")
        monkeypatch.syspath_prepend(tmp_path)
        monkeypatch.setattr(os, "environ", os.environ.copy())  # loading sets some of it

    yield put_lines
    for module in [m for m in sys.modules if m.partition(".")[0] in put]:
        del sys.modules[module]
    direct_solvers._fault.cache_clear()


@pytest.mark.parametrize("method", FAULTY)
def test_a_solver_that_cannot_be_loaded_is_not_installed(cube, rng, tmp_path, put_in_place, method):
    name, words = FAULTY[method]
    tries = tmp_path / "tries"
    count = f"open({str(tries)!r}, 'a').write('x')\n"
    put_in_place(name, f"{count}raise OSError({words!r} '. Use another one.')\n")
    system, elimination = cube
    assert importlib.util.find_spec(name) is not None
    assert not direct_solvers.is_installed(method)
    assert method not in [cost.method for cost in cost_model.predict(system, 3)]
    x, F = known(system, elimination, rng)
    for asked in ("auto", "schwarz"):  # the second has a factor of its coarse level
        found = solve(system, F, asked)
        assert method not in found.diagnostics.method + found.diagnostics.reason
        np.testing.assert_allclose(found.x, x, atol=1e-6 * np.abs(x).max())
    with pytest.raises(InputError, match=rf"'{method}' cannot be loaded \({words}\): \S+ .* or"):
        factorise(system, method)
    assert tries.read_text() == "x"  # tried once


def test_a_package_without_what_is_used_of_it_is_not_installed(put_in_place):
    """As of another major version: it loads all the same."""
    put_in_place("sksparse", "")
    assert not direct_solvers.is_installed("cholmod")
    with pytest.raises(InputError, match="cannot import name 'Cholmod"):
        direct_solvers.require("cholmod")


def test_no_solver_is_loaded_before_it_is_asked_for():
    """Programs begin without the libraries of the optional ones."""
    code = "import sys, fe_drivetrain.elasticity.solve.solvers; print(*sys.modules)"
    loaded = run_python("-c", code)
    assert "scipy" in loaded.stdout.split()
    assert not {"pypardiso", "sksparse"} & set(loaded.stdout.split())


def test_unknown_solver_is_refused(cube):
    with pytest.raises(InputError, match="use one of auto, superlu"):
        factorise(cube[0], "gauss")


def test_a_matrix_without_blocks_of_elements_is_solved(rng):
    """The interface asks for a System only: here a chain of springs in three directions."""
    one = sparse.diags_array([-1.0, 2.0, -1.0], offsets=[-1, 0, 1], shape=(40, 40))
    K = sparse.kron(one, sparse.eye_array(3)).tobsr((3, 3))
    motions = np.tile(np.eye(3), (40, 1))
    system = System(K, None, motions, np.zeros(40, dtype=int), 120)
    x = rng.standard_normal((120, 2))
    np.testing.assert_allclose(solve(system, K @ x, "multigrid", 1e-12).x, x, atol=1e-9)


@pytest.mark.parametrize(
    ("size", "divisions", "chunky"),
    [
        ((2.0, 1.0, 1.0), (8, 4, 4), True),
        ((1.0, 1.0, 0.01), (6, 6, 1), False),
        ((100.0, 1.0, 1.0), (20, 1, 1), False),
    ],
)
def test_thin_and_slender_solids_are_expected_to_take_multigrid_long(size, divisions, chunky):
    """More than it tries; chunky ones are judged by the kind of their elements alone."""
    block = brick(divisions, 27, lambda p: p * size)
    K = assemble(block.points, block.cells, (1.0, 1.0))
    wall = fixed("wall", block.face_nodes("x0"), block.points.size)
    system = reduce(block.points, block.cells, K, eliminate([wall], block.points.size))
    if chunky:
        assert cost_model.iterations(system) == cost_model.ORDINARY[27]
        # each takes off as much of the error
        assert cost_model.iterations(system, 1e-3) == pytest.approx(cost_model.ORDINARY[27] / 3)
    else:
        assert cost_model.iterations(system) > multigrid.MAX_ITERATIONS > cost_model.ORDINARY[27]


def test_thinness_of_a_plate_is_that_of_its_wall():
    """A plate l x l x t of square elements h: wall t, in the limit, and extent l sqrt(2)."""
    block = brick((10, 10, 1), 8, lambda p: p * [1.0, 1.0, 1e-4])
    K = assemble(block.points, block.cells, (1.0, 1.0))
    system = reduce(block.points, block.cells, K, eliminate([], block.points.size))
    expected = 0.1 / 1e-4 * np.sqrt(np.sqrt(2.0) / 2e-4)
    assert cost_model.thinness(system.elements) == pytest.approx(expected, rel=1e-3)


@pytest.mark.needs("sksparse")
def test_entries_of_a_factor_are_counted(cube):
    """Against CHOLMOD's own factor, which it copies to show; its supernodes keep some zeros."""
    from sksparse.cholmod import cholesky

    A = sparse.csc_matrix(cube[0].K)
    factor = cholesky(A, ordering_method="metis", mode="simplicial")
    counted = direct_solvers.entries_of_factor(A.indptr, A.indices, factor.P())
    assert counted == factor.L().nnz
    dense = sparse.csc_matrix(np.ones((7, 7)))
    assert direct_solvers.entries_of_factor(dense.indptr, dense.indices, np.arange(7)) == 28


def test_what_rounding_decides_is_refused_by_every_solver():
    """A rod of a million times its width: no digit of its bending is left."""
    block = brick((12, 1, 1), 27, lambda p: p * [1e6, 1.0, 1.0])
    K = assemble(block.points, block.cells, (1.0, 1.0))
    wall = fixed("wall", block.face_nodes("x0"), block.points.size)
    system = reduce(block.points, block.cells, K, eliminate([wall], block.points.size))
    F = np.zeros((block.points.size, 1))
    F[3 * block.face_nodes("x1") + 2] = 1.0
    for method in METHODS:
        if not missing(method):
            with pytest.raises(InputError):
                solve(system, F, method)


def test_doubt_by_rounding_is_told():
    block = brick((8, 1, 1), 27, lambda p: p * [600.0, 1.0, 1.0])
    K = assemble(block.points, block.cells, (1.0, 1.0))
    wall = fixed("wall", block.face_nodes("x0"), block.points.size)
    system = reduce(block.points, block.cells, K, eliminate([wall], block.points.size))
    F = np.zeros((block.points.size, 1))
    F[3 * block.face_nodes("x1") + 2] = 1.0
    solution = solve(system, F, "superlu")
    assert 1e-4 < solution.diagnostics.round_off < 0.1
    assert "rounding may change the answer" in solution.diagnostics.reason
