"""One MPI process of `petsc`: its rows, their preconditioner by PETSc, conjugate gradients.

It is run by a Python that has petsc4py, numpy and scipy, which may be the system's. Usage:
petsc_ranks.py FOLDER. The first process says how many there are, and then the files of `hand_over`
are there. Requests come to it on standard input, a line each, and answers go to standard output, a
line each behind "@".
"""

from __future__ import annotations

import json
import sys
import time
import types
from pathlib import Path
from typing import Any

import numpy as np
import petsc4py

petsc4py.init([])

from petsc4py import PETSc  # noqa: E402
from scipy import linalg, sparse  # noqa: E402


def _package() -> None:
    """Let modules of this package be imported, whose own `__init__` needs more than there is."""
    root = Path(__file__).parents[2]
    wing = ".elasticity"
    for name in ("", ".common", wing, f"{wing}.mesh", f"{wing}.operator", f"{wing}.solve"):
        package = types.ModuleType(f"fe_drivetrain{name}")
        package.__path__ = [str(root.joinpath(*name.split(".")))]
        sys.modules[package.__name__] = package


if "fe_drivetrain" not in sys.modules:  # started by its path
    _package()

from fe_drivetrain.common import memory  # noqa: E402
from fe_drivetrain.elasticity.solve import rank_rows, stopping  # noqa: E402

Floats = np.ndarray[Any, np.dtype[np.float64]]

GAMG = {
    "pc_gamg_threshold": "0.0",
    "pc_gamg_agg_nsmooths": "1",
    "mg_levels_ksp_type": "chebyshev",
    "mg_levels_ksp_max_it": "3",
    "mg_levels_pc_type": "jacobi",  # blocks of aggregates of two nodes have no inverse
}
"""Smoothed aggregation of the six rigid motions; what the environment's PETSC_OPTIONS say goes
before."""


def rows_of(folder: Path, low: int, high: int) -> Any:
    """Rows of nodes ``low`` to ``high``; only they are read."""
    indptr = np.load(folder / "indptr.npy", mmap_mode="r")[low : high + 1]
    first, last = int(indptr[0]), int(indptr[-1])
    indices = np.array(np.load(folder / "indices.npy", mmap_mode="r")[first:last])
    data = np.array(np.load(folder / "data.npy", mmap_mode="r")[first:last])
    width = 3 * (int(indices.max(initial=0)) + 1)
    local = np.asarray(indptr) - first
    rows = sparse.bsr_array((data, indices, local), shape=(3 * (high - low), width)).tocsr()
    rows.eliminate_zeros()  # through which eliminated nodes would join aggregates
    return rows


class Joined:
    """A preconditioner of bodies, corrected for joints that take means over faces.

    Same as `multigrid.Joined`, whose parts it has for the rows of this process; sums over all
    processes are of as many numbers as joints have rows.
    """

    def __init__(self, rank: Rank, pc: Any) -> None:
        low, high = 3 * rank.low, 3 * rank.high
        folder, self.mpi, self.pc = rank.folder / "bodies", rank.comm.tompi4py(), pc
        self.rows = sparse.load_npz(folder / "rows.npz")[:, low:high]
        self.shares = sparse.load_npz(folder / "shares.npz")[:, low:high]
        self.free = np.array(np.load(folder / "free.npy", mmap_mode="r")[low:high])
        dofs = np.load(folder / "dofs.npy")
        self.own = np.flatnonzero((dofs >= low) & (dofs < high))
        self.here = dofs[self.own] - low
        spread = []
        for row in self.rows.toarray():
            found = rank.K.createVecLeft()
            pc.apply(rank.vector(row), found)
            spread.append(found.getArray().copy())
        self.spread = np.array(spread).T
        met = self._summed(self.rows @ self.spread)
        flexibility = np.load(folder / "flexibility.npy")
        self.factor = linalg.cho_factor(np.diag(flexibility) + 0.5 * (met + met.T))

    def _summed(self, values: Floats) -> Floats:
        total = np.empty_like(values)
        self.mpi.Allreduce(np.ascontiguousarray(values), total)
        return total

    def __call__(self, r: Any, z: Any) -> None:
        """Precondition r, into z."""
        lifted = r.duplicate()
        R = r.getArray(readonly=True)
        of_sums = np.zeros(self.shares.shape[0])
        of_sums[self.own] = R[self.here]
        found = R + self.shares.T @ self._summed(of_sums)
        found[self.here] = 0.0
        lifted.setArray(found)
        self.pc.apply(lifted, z)
        X = z.getArray()
        X -= self.spread @ linalg.cho_solve(self.factor, self._summed(self.rows @ X))
        X[self.here] = self._summed(self.shares @ X)[self.own]
        X[~self.free] = 0.0


class Rank:
    """One process and its part of the system."""

    def __init__(self, folder: Path) -> None:
        setup = json.loads((folder / "setup.json").read_text())
        self.comm, self.folder = PETSc.COMM_WORLD, folder
        starts = setup["starts"]
        self.low, self.high = starts[self.comm.rank : self.comm.rank + 2]
        self.blocks = starts[-1]
        self.size = ((3 * (self.high - self.low), 3 * self.blocks),) * 2
        start, self.before = time.perf_counter(), memory.peak_memory()
        rows, bodies, self.elements = self._made(setup) if setup["elements"] else self._read(setup)
        self.K = self._matrix(rows)
        self.nnz = rows.nnz
        del rows
        apart = self._matrix(bodies) if setup["apart"] else self.K
        del bodies
        read = time.perf_counter()
        pc = self._preconditioner(setup["method"], apart)
        self.precondition = Joined(self, pc) if setup["joined"] else pc.apply
        done = time.perf_counter()
        say(read_seconds=read - start, setup_seconds=done - read, **self._facts())

    def _read(self, setup: dict[str, Any]) -> tuple[Any, Any, int]:
        """Rows of the matrix, and of bodies where they are apart."""
        rows = rows_of(self.folder, self.low, self.high)
        apart = rows_of(self.folder / "bodies", self.low, self.high) if setup["apart"] else None
        return rows, apart, 0

    def _made(self, setup: dict[str, Any]) -> tuple[Any, Any, int]:
        """Rows like those of `_read`, and the number of elements that they were made of."""
        share, reductions = rank_rows.kept(self.folder / f"share-{self.comm.rank}.npz")
        K = rank_rows.assembled(share)
        n = 3 * self.blocks
        trace = self.comm.tompi4py().allreduce(rank_rows.own_trace(K, share))
        mean, *others = ((trace + r.trace) / n for r in reductions)
        rows = rank_rows.own_rows(K, share, reductions[0], mean)
        apart = None
        if setup["joined"]:
            ground = setup["ground"] * mean
            apart = rank_rows.own_rows(K, share, reductions[1], others[0], ground, True)
        elif setup["apart"]:
            apart = rank_rows.own_rows(K, share, reductions[0], mean, within_bodies=True)
        return rows, apart, len(share.cells)

    def _matrix(self, rows: Any) -> Any:
        """PETSc's matrix of these rows."""
        csr = (rows.indptr.astype(PETSc.IntType), rows.indices.astype(PETSc.IntType), rows.data)
        K = PETSc.Mat().createAIJ(self.size, bsize=3, csr=csr, comm=self.comm)
        K.setOption(PETSc.Mat.Option.SYMMETRIC, True)
        K.setOption(PETSc.Mat.Option.SPD, True)
        return K

    def _facts(self) -> dict[str, Any]:
        """Memory of each process, and what it has."""
        most = memory.peak_memory() or 0
        here = (most - (self.before or 0), most, self.nnz, self.elements)
        names = ("bytes", "peaks", "nnz", "elements")
        every = zip(*self.comm.tompi4py().allgather(here), strict=True)
        return dict(zip(names, map(list, every), strict=True))

    def _preconditioner(self, method: str, K: Any) -> Any:
        pc = PETSc.PC().create(self.comm)
        pc.setOperators(K)
        if method == "petsc-mumps":
            pc.setType("cholesky")
            pc.setFactorSolverType("mumps")
        else:
            K.setNearNullSpace(self._motions())
            options = PETSc.Options()
            for name, value in GAMG.items():
                if not options.hasName(name):
                    options[name] = value
            pc.setType("gamg")
            pc.setFromOptions()
        pc.setUp()
        pc.setUpOnBlocks()
        return pc

    def _motions(self) -> Any:
        """Rigid motions, orthonormal, which the constraints have taken their part of."""
        motions = np.load(self.folder / "motions.npy", mmap_mode="r")[3 * self.low : 3 * self.high]
        vectors: list[Any] = []
        for column in np.array(motions).T:
            vector = self.vector(column)
            for _ in range(2):
                for other in vectors:
                    vector.axpy(-vector.dot(other), other)
            norm = vector.norm()
            if norm > 0.0:
                vector.scale(1.0 / norm)
                vectors.append(vector)
        return PETSc.NullSpace().create(vectors=vectors, comm=self.comm)

    def vector(self, values: Floats) -> Any:
        """One whose part here has these values."""
        found = self.K.createVecLeft()
        found.setArray(np.ascontiguousarray(values))
        return found

    def solve(self, number: int, tolerance: float, most: int) -> None:
        """Solve for all columns of f-NUMBER.npy, and write this part of x."""
        start = time.perf_counter()
        F = np.load(self.folder / f"f-{number}.npy", mmap_mode="r")[3 * self.low : 3 * self.high]
        columns = [self._column(np.array(f), tolerance, most) for f in F.T]
        x = np.column_stack([x for x, _, _ in columns])
        seconds = time.perf_counter() - start
        np.save(self.folder / f"x-{number}-{self.comm.rank}.npy", x)
        checks = self._checks(x, F)  # all have written once this is done
        say(
            iterations=max(i for _, i, _ in columns),
            energy_error=max(e for _, _, e in columns),
            solve_seconds=seconds,
            **checks,
        )

    def _checks(self, x: Floats, F: Floats) -> dict[str, Any]:
        """Maximum |K x - f| / |f|, and |x|.|K||x| and x.K x of each column; see `rounding`."""
        indptr, columns, data = self.K.getValuesCSR()
        low, high = 3 * self.low, 3 * self.high
        outside = (columns < low) | (columns >= high)
        others, place = np.unique(columns[outside], return_inverse=True)
        columns -= low
        columns[outside] = high - low + place
        met = np.vstack([x, np.column_stack([self._elsewhere(values, others) for values in x.T])])
        rows = sparse.csr_array((data, columns, indptr), shape=(len(x), len(met)))
        forces = rows @ met
        np.abs(rows.data, out=rows.data)
        each = [(forces - F) ** 2, F**2, np.abs(x) * (rows @ np.abs(met)), x * forces]
        sums = np.array([values.sum(axis=0) for values in each])
        total = np.empty_like(sums)
        self.comm.tompi4py().Allreduce(sums, total)
        left, given, sizes, energies = total
        given[given == 0.0] = 1.0
        return {
            "residual": float(np.sqrt((left / given).max())),
            "sizes": sizes.tolist(),
            "energies": energies.tolist(),
        }

    def _elsewhere(self, values: Floats, chosen: Any) -> Floats:
        """Some entries, of any processes, of the vector that has these values here."""
        vector, found = self.vector(values), PETSc.Vec().createSeq(len(chosen))
        index = PETSc.IS().createGeneral(chosen.astype(PETSc.IntType), comm=PETSc.COMM_SELF)
        PETSc.Scatter().create(vector, index, found, None).scatter(vector, found)
        return np.array(found.getArray())

    def _column(self, f: Floats, tolerance: float, most: int) -> tuple[Floats, int, float]:
        """Conjugate gradients, with the end of `multigrid.iterates`."""
        r = self.vector(f)
        x, p, Kp, z = r.duplicate(), r.duplicate(), r.duplicate(), r.duplicate()
        x.set(0.0)
        self.precondition(r, p)
        rz = start = r.dot(p)
        terms: list[float] = []
        errors = [0.0]  # of a column of zeros
        while not abs(rz) <= stopping.LAST_DIGIT * abs(start):
            self.K.mult(p, Kp)
            curvature = p.dot(Kp)
            if not (rz > 0.0 and curvature > 0.0):  # or no number
                errors.append(float("inf"))
                break
            alpha = rz / curvature
            x.axpy(alpha, p)
            r.axpy(-alpha, Kp)
            terms.append(alpha * rz)
            errors.append(stopping.energy_error(np.array(terms)[:, None]))
            if errors[-1] <= tolerance or len(terms) == most:
                break
            if stopping.is_hopeless(errors[1:], tolerance, most):
                break
            self.precondition(r, z)
            new = r.dot(z)
            p.aypx(new / rz, z)
            rz = new
        return x.getArray().copy(), len(terms), errors[-1]


def main(folder: Path) -> None:
    """Set up, and solve until standard input ends."""
    mpi = PETSc.COMM_WORLD.tompi4py()

    def line() -> str:
        found = sys.stdin.readline() if mpi.rank == 0 else ""
        read = mpi.Ibarrier()
        while not read.Test():
            time.sleep(0.002)  # a broadcast would keep a core busy until there is something to do
        return str(mpi.bcast(found)).strip()

    say(ranks=mpi.size)
    if not line():
        return
    rank = Rank(folder)
    while request := line():
        rank.solve(**json.loads(request))


def say(**values: Any) -> None:
    """Write a message of the first process."""
    if PETSc.COMM_WORLD.rank == 0:
        print("@" + json.dumps(values), flush=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
