"""FEniCSx: dolfinx's assembly of order-two elements on order-two geometry, PETSc's solvers.

dolfinx uses several cores by as many MPI processes, each of one thread. Written for the Python
interface of dolfinx 0.5, which is what Debian 12 has.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from fe_drivetrain.cases.performance.peers.runner import Clock, Problem

NAME = "dolfinx"
TOGETHER = True
INSTALL = (
    "apt-get install python3-dolfinx openmpi-bin; PCHPDDM needs a PETSc that was configured with "
    "--download-hpddm --download-slepc"
)
VARIANTS = {
    "mumps": ("MUMPS", "direct", "common"),
    "gamg": ("GAMG and CG", "iterative", "common"),
    "hpddm": ("PCHPDDM (GenEO) and CG", "iterative", "common"),
    "bddc": ("PCBDDC, adaptive, and CG", "iterative", "common"),
}
UNASSEMBLED = ("hpddm", "bddc")
"""Their matrix stays in parts, one of each process, as spectral coarse spaces need it."""

TOLERANCE = 1e-5
OPTIONS: dict[str, dict[str, Any]] = {
    "gamg": {"mg_levels_ksp_type": "chebyshev", "mg_levels_pc_type": "jacobi"},
    "bddc": {
        "pc_bddc_symmetric": None,
        "pc_bddc_adaptive_threshold": 10.0,
    },
    # the options of PETSc's ex76, GenEO's example: eigenvectors of each part, exact solvers
    "hpddm": {
        "pc_hpddm_levels_1_sub_pc_type": "cholesky",
        "pc_hpddm_levels_1_sub_pc_factor_mat_solver_type": "mumps",
        "pc_hpddm_levels_1_eps_nev": 20,
        "pc_hpddm_levels_1_st_pc_type": "cholesky",
        "pc_hpddm_coarse_pc_type": "cholesky",
        "pc_hpddm_coarse_pc_factor_mat_solver_type": "mumps",
        "pc_hpddm_coarse_correction": "balanced",
    },
}
"""Options of PETSc, for each preconditioner."""

LAUNCH = ("mpiexec", "--bind-to", "none", "--oversubscribe", "-n", "{threads}")
"""What stands before the interpreter on the command line."""


def version() -> str:
    """dolfinx's version."""
    import dolfinx

    return str(dolfinx.__version__)


def rank() -> int:
    """Number of this process, after all have come here."""
    from mpi4py import MPI

    MPI.COMM_WORLD.Barrier()
    return int(MPI.COMM_WORLD.rank)


def total(number: int) -> int:
    """Sum over all processes."""
    from mpi4py import MPI

    return int(MPI.COMM_WORLD.allreduce(number, op=MPI.SUM))


def load(problem: Problem) -> Any:
    """dolfinx's mesh with curved cells, and the two faces' facets."""
    import dolfinx
    import ufl
    from mpi4py import MPI
    from scipy.spatial import cKDTree

    comm = MPI.COMM_WORLD
    order = dolfinx.cpp.io.perm_vtk(dolfinx.mesh.CellType.tetrahedron, 10)
    root = comm.rank == 0
    cells = problem.cells[:, order].astype(np.int64) if root else np.empty((0, 10), np.int64)
    points = problem.points if root else np.empty((0, 3))
    coordinates = ufl.VectorElement("Lagrange", ufl.tetrahedron, 2)
    # without cells of neighbours, so that a matrix in parts has no empty rows
    apart = dolfinx.mesh.GhostMode.none
    mesh = dolfinx.mesh.create_mesh(comm, cells, points, ufl.Mesh(coordinates), apart)
    faces = []
    for facets in (problem.fixed, problem.moved):
        tree = cKDTree(problem.points[np.unique(facets)])
        faces.append(
            dolfinx.mesh.locate_entities_boundary(
                mesh, 2, lambda x, tree=tree: tree.query(x.T)[0] < 1e-9
            )
        )
    # dolfinx deals the cells out in an order of its own
    points = mesh.geometry.x
    corners = np.stack([mesh.geometry.dofmap.links(c)[:4] for c in range(_n_cells(mesh))])
    centres = cKDTree(problem.points[problem.cells[:, :4]].mean(axis=1))
    material = problem.material[centres.query(points[corners].mean(axis=1))[1]]
    return problem, mesh, faces, material


def solve(state: Any, variant: str, clock: Clock) -> list[float]:
    """The stiffnesses."""
    import dolfinx
    import ufl
    from dolfinx import fem
    from petsc4py import PETSc

    problem, mesh, (fixed, moved), material = state
    clock.notes["processes"] = mesh.comm.size
    with clock.step("assembly"):
        space = fem.VectorFunctionSpace(mesh, ("Lagrange", 2))
        constant = fem.FunctionSpace(mesh, ("DG", 0))
        lam, mu = fem.Function(constant), fem.Function(constant)
        for function, values in zip((lam, mu), problem.lame(), strict=True):
            function.x.array[:] = values[material]
        u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
        rule = {
            "quadrature_degree": 4,
            "quadrature_rule": "custom",
            "quadrature_points": tuple(map(tuple, problem.rule_points.tolist())),
            "quadrature_weights": tuple(problem.rule_weights.tolist()),
        }
        dx = ufl.dx(metadata=rule)
        a = fem.form(_work(u, v, lam, mu) * dx)
        ends = [fem.locate_dofs_topological(space, 2, facets) for facets in (fixed, moved)]
        held = fem.dirichletbc(fem.Function(space), ends[0])
        systems = []
        for M in problem.motions:
            motion = fem.Function(space)
            motion.interpolate(lambda x, M=M: M[:, :3] @ x + M[:, 3:])
            conditions = [held, fem.dirichletbc(motion, ends[1])]
            b = dolfinx.la.create_petsc_vector(space.dofmap.index_map, 3)
            fem.petsc.apply_lifting(b, [a], bcs=[conditions])
            b.ghostUpdate(addv=PETSc.InsertMode.ADD, mode=PETSc.ScatterMode.REVERSE)
            fem.petsc.set_bc(b, conditions)
            systems.append((b, conditions))
        A = _matrix(a, systems[0][1], space, variant)
    with clock.step("solve"):
        solver = _solver(mesh.comm, A, space, variant)
        solutions = []
        for b, conditions in systems:
            solution = fem.Function(space)
            if variant in UNASSEMBLED:
                fem.petsc.set_bc(b, conditions, scale=0.0)
            else:
                fem.petsc.set_bc(solution.vector, conditions)
            solver.solve(b, solution.vector)
            # GAMG's coarse spaces move the prescribed displacements a little
            fem.petsc.set_bc(solution.vector, conditions)
            solution.x.scatter_forward()
            solutions.append(solution)
            if variant != "mumps":
                clock.iterations = max(clock.iterations or 0, int(solver.getIterationNumber()))
    return _energies(space, solutions, lam, mu, dx)


def _energies(space: Any, solutions: list[Any], lam: Any, mu: Any, dx: Any) -> list[float]:
    """Twice the strain energy of each solution, of all processes together."""
    from dolfinx import fem
    from mpi4py import MPI

    shown = fem.Function(space)
    energy = fem.form(_work(shown, shown, lam, mu) * dx)
    found = []
    for solution in solutions:
        shown.x.array[:] = solution.x.array
        own = fem.assemble_scalar(energy)
        found.append(float(space.mesh.comm.allreduce(own, op=MPI.SUM)))
    return found


def _work(u: Any, v: Any, lam: Any, mu: Any) -> Any:
    """Work of the stress of displacement u on the strain of displacement v."""
    import ufl

    strain = ufl.sym(ufl.grad(u))
    stress = 2 * mu * strain + lam * ufl.tr(strain) * ufl.Identity(3)
    return ufl.inner(stress, ufl.sym(ufl.grad(v)))


def _matrix(a: Any, conditions: Any, space: Any, variant: str) -> Any:
    """The matrix: assembled, or in parts, with each prescribed displacement on its own in all."""
    from dolfinx import fem
    from dolfinx.cpp import fem as compiled
    from petsc4py import PETSc

    if variant not in UNASSEMBLED:
        A = fem.petsc.assemble_matrix(a, bcs=conditions)
        A.assemble()
        return A
    if variant == "hpddm" and not PETSc.Sys.hasExternalPackage("hpddm"):
        raise ImportError("this PETSc is built without HPDDM and SLEPc, as Debian's is")
    index_map = space.dofmap.index_map
    own, count = index_map.size_local, index_map.size_local + index_map.num_ghosts
    part = PETSc.Mat().createAIJ(
        (3 * count, 3 * count), bsize=3, nnz=_row_lengths(space, count), comm=PETSc.COMM_SELF
    )
    here = np.arange(count, dtype=np.int32)
    names = PETSc.LGMap().create(here.astype(PETSc.IntType), bsize=3, comm=PETSc.COMM_SELF)
    part.setLGMap(names, names)
    constants, coefficients = compiled.pack_constants(a), compiled.pack_coefficients(a)
    compiled.petsc.assemble_matrix(part, a, constants, coefficients, conditions)
    part.assemblyBegin(PETSc.Mat.AssemblyType.FLUSH)
    part.assemblyEnd(PETSc.Mat.AssemblyType.FLUSH)
    for row in np.concatenate([c.dof_indices()[0] for c in conditions]).tolist():
        part.setValue(row, row, 1.0)
    part.assemble()
    A = PETSc.Mat().create(space.mesh.comm)
    A.setType("is")
    A.setSizes(((3 * own, None), (3 * own, None)), bsize=3)
    numbers = index_map.local_to_global(here).astype(PETSc.IntType)
    places = PETSc.LGMap().create(numbers, bsize=3, comm=space.mesh.comm)
    A.setLGMap(places, places)
    A.setISLocalMat(part)
    A.assemble()
    return A


def _row_lengths(space: Any, count: int) -> Any:
    """Entries of each row of this process's part."""
    from petsc4py import PETSc
    from scipy import sparse

    nodes = space.dofmap.list.array.reshape(-1, 10)
    cells = np.repeat(np.arange(len(nodes)), 10)
    of = sparse.csr_matrix(
        (np.ones(nodes.size, np.int32), (cells, nodes.ravel())), (len(nodes), count)
    )
    return np.repeat(3 * np.diff((of.T @ of).tocsr().indptr), 3).astype(PETSc.IntType)


def _solver(comm: Any, A: Any, space: Any, variant: str) -> Any:
    """PETSc's solver: a Cholesky factor, or conjugate gradients with a preconditioner."""
    from petsc4py import PETSc

    solver = PETSc.KSP().create(comm)
    preconditioner = solver.getPC()
    if variant == "mumps":
        A.setOption(PETSc.Mat.Option.SPD, True)
        solver.setType("preonly")
        preconditioner.setType("cholesky")
        preconditioner.setFactorSolverType("mumps")
    else:
        A.setNearNullSpace(_rigid_motions(space))
        solver.setType("cg")
        solver.setTolerances(rtol=TOLERANCE, max_it=1000)
        preconditioner.setType(variant)
        options = PETSc.Options()
        for key, value in OPTIONS[variant].items():
            options[key] = value
        solver.setFromOptions()
    solver.setOperators(A)
    solver.setErrorIfNotConverged(True)
    solver.setInitialGuessNonzero(variant == "gamg")
    return solver


def _n_cells(mesh: Any) -> int:
    """Cells of this process, its neighbours' among them."""
    index_map = mesh.topology.index_map(3)
    return int(index_map.size_local + index_map.num_ghosts)


def _rigid_motions(space: Any) -> Any:
    """PETSc's near-nullspace of the six rigid motions."""
    import dolfinx
    from petsc4py import PETSc

    x = space.tabulate_dof_coordinates()
    index_map = space.dofmap.index_map
    n = index_map.size_local
    vectors = []
    for k in range(6):
        vector = dolfinx.la.create_petsc_vector(index_map, 3)
        values = np.zeros((n, 3))
        if k < 3:
            values[:, k] = 1.0
        else:
            values[:] = np.cross(np.eye(3)[k - 3], x[:n])
        vector.setArray(values.ravel())
        vectors.append(vector)
    for i, vector in enumerate(vectors):
        for other in vectors[:i]:
            vector.axpy(-vector.dot(other), other)
        vector.normalize()
    return PETSc.NullSpace().create(vectors=vectors)
