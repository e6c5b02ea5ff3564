"""One MPI process of `petsc`: rows of a matrix, its preconditioner by PETSc, conjugate gradients.

It is run by a Python that has petsc4py, numpy and scipy, which may be the system's. Usage:
petsc_ranks.py FOLDER, with the files that `petsc.Ranks` writes. Requests come to the first process
on standard input, a line each, and answers go to standard output, a line each behind "@".
"""

from __future__ import annotations

import importlib.util
import json
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import petsc4py

petsc4py.init([])

from petsc4py import PETSc  # noqa: E402
from scipy import linalg, sparse  # noqa: E402


def _module(path: str) -> Any:
    """A module of this package, which this Python may not have, by itself."""
    spec = importlib.util.spec_from_file_location("alone", Path(__file__).parents[1] / path)
    assert spec is not None
    assert spec.loader is not None
    found = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(found)
    return found


stopping, memory = _module("solve/stopping.py"), _module("common/memory.py")

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


def rows_of(folder: Path, low: int, high: int) -> tuple[Any, ...]:
    """Rows of nodes ``low`` to ``high`` as PETSc takes them; only they are read."""
    indptr = np.load(folder / "indptr.npy", mmap_mode="r")[low : high + 1]
    first, last = int(indptr[0]), int(indptr[-1])
    indices = np.array(np.load(folder / "indices.npy", mmap_mode="r")[first:last])
    data = np.array(np.load(folder / "data.npy", mmap_mode="r")[first:last])
    width = 3 * (int(indices.max(initial=0)) + 1)
    local = np.asarray(indptr) - first
    rows = sparse.bsr_matrix((data, indices, local), shape=(3 * (high - low), width)).tocsr()
    rows.eliminate_zeros()  # through which eliminated nodes would join aggregates
    return rows.indptr.astype(PETSc.IntType), rows.indices.astype(PETSc.IntType), rows.data


class Joined:
    """A preconditioner of bodies, corrected for joints that take means over faces.

    As `multigrid.Joined`, whose parts it has for the rows of this process; sums over all processes
    are of as many numbers as joints have rows.
    """

    def __init__(self, rank: Rank, pc: Any) -> None:
        low, high = 3 * rank.low, 3 * rank.high
        folder, self.mpi, self.pc = rank.folder / "bodies", rank.comm.tompi4py(), pc
        self.rows = sparse.load_npz(folder / "rows.npz").tocsc()[:, low:high].tocsr()
        self.shares = sparse.load_npz(folder / "shares.npz").tocsc()[:, low:high].tocsr()
        self.free = np.load(folder / "free.npy")[low:high]
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
    """Its part of the system."""

    def __init__(self, folder: Path) -> None:
        setup = json.loads((folder / "setup.json").read_text())
        self.comm = PETSc.COMM_WORLD
        self.folder, starts = folder, self._starts(setup["blocks"])
        self.low, self.high = starts
        self.size = ((3 * (self.high - self.low), 3 * setup["blocks"]),) * 2
        start, self.before = time.perf_counter(), memory.peak_memory()
        self.K = self._matrix(folder)
        self.nnz = int(self.K.getInfo(PETSc.Mat.InfoType.LOCAL)["nz_used"])
        bodies = self._matrix(folder / "bodies") if setup["apart"] else self.K
        read = time.perf_counter()
        pc = self._preconditioner(setup["method"], bodies)
        self.precondition = Joined(self, pc) if setup["joined"] else pc.apply
        done = time.perf_counter()
        self.answer(read_seconds=read - start, setup_seconds=done - read, **self._facts())

    def _starts(self, blocks: int) -> tuple[int, int]:
        each, more = divmod(blocks, self.comm.size)
        low = self.comm.rank * each + min(self.comm.rank, more)
        return low, low + each + (self.comm.rank < more)

    def _matrix(self, folder: Path) -> Any:
        rows = rows_of(folder, self.low, self.high)
        K = PETSc.Mat().createAIJ(self.size, bsize=3, csr=rows, comm=self.comm)
        K.setOption(PETSc.Mat.Option.SYMMETRIC, True)
        K.setOption(PETSc.Mat.Option.SPD, True)
        return K

    def _facts(self) -> dict[str, Any]:
        more = memory.peak_memory() - self.before
        both = self.comm.tompi4py().allgather((more, self.nnz))
        return {"ranks": self.comm.size, "bytes": [b for b, _ in both], "nnz": [n for _, n in both]}

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
        np.save(self.folder / f"x-{number}-{self.comm.rank}.npy", x)
        self.comm.barrier()
        self.answer(
            iterations=max(i for _, i, _ in columns),
            energy_error=max(e for _, _, e in columns),
            solve_seconds=time.perf_counter() - start,
        )

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

    def answer(self, **values: Any) -> None:
        """What the first process has to say."""
        if self.comm.rank == 0:
            print("@" + json.dumps(values), flush=True)


def main(folder: Path) -> None:
    """Set up, and solve until standard input ends."""
    rank = Rank(folder)
    mpi = PETSc.COMM_WORLD.tompi4py()
    while True:
        line = mpi.bcast(sys.stdin.readline() if mpi.rank == 0 else None)
        if not line.strip():
            return
        rank.solve(**json.loads(line))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
