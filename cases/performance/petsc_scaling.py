"""Solids in parts on MPI processes: strong and weak scaling, and what 1e9 unknowns would take."""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats, MissingToolError, cores
from fe_drivetrain.interfaces import eliminate, fixed
from fe_drivetrain.mesh import brick
from fe_drivetrain.operator import assemble
from fe_drivetrain.scene import MATERIALS
from fe_drivetrain.solve import System, petsc, reduce, solve
from fe_drivetrain.suite import Page, Record, Run

#: Unknowns of the strong series, of a full and a quick run.
UNKNOWNS, QUICK = 200_000, 3_000
TOLERANCE = 1e-10
#: Unknowns of the system whose iterations cost what messages cost.
SMALL = 500
TARGET = 1e9
#: Processes that the target is extrapolated to.
MANY = (512, 2048, 8192, 32768)


def bar(unknowns: float) -> tuple[System, Floats]:
    """A bar of steel, four times as long as wide, held at one end and pulled sideways at the other.

    Quadratic tetrahedra, six in each cube of the bar.
    """
    cuts = max(1, round((unknowns / 3 / (4 * 8)) ** (1 / 3)))
    block = brick((4 * cuts, cuts, cuts), 10, lambda x: x * [4.0, 1.0, 1.0])
    points, cells, n = block.points, block.cells, block.points.size
    elimination = eliminate([fixed("end", np.flatnonzero(points[:, 0] == 0.0), n)], n)
    K = assemble(points, cells, MATERIALS["steel"].lame)
    F = np.zeros((n, 1))
    F[3 * np.flatnonzero(points[:, 0] == 4.0) + 2] = 1.0
    return reduce(points, cells, K, elimination), F


@contextmanager
def processes(count: int) -> Iterator[None]:
    """Have PETSc take so many."""
    before = os.environ.get(petsc.MPI_VARIABLE)
    os.environ[petsc.MPI_VARIABLE] = f"mpiexec -n {count}"
    try:
        yield
    finally:
        del os.environ[petsc.MPI_VARIABLE]
        if before is not None:
            os.environ[petsc.MPI_VARIABLE] = before


def measured(system: System, F: Floats, count: int, repeats: int) -> tuple[Record, Floats]:
    """Best times of some solutions on so many processes, and the last solution."""
    with processes(count):
        runs = []
        for _ in range(repeats):
            ranks = petsc.Ranks(system, "petsc")
            found = ranks.solve(F, TOLERANCE)
            runs.append(ranks.facts)
            del ranks
    best = min(runs, key=lambda facts: facts["setup_seconds"] + facts["solve_seconds"])
    n = system.n_free
    row: Record = {
        "processes": count,
        "unknowns": n,
        "iterations": found.iterations,
        "set-up [s]": best["setup_seconds"],
        "solve [s]": best["solve_seconds"],
        "time of an iteration [ms]": 1e3 * best["solve_seconds"] / found.iterations,
        "memory of a process [bytes/unknown]": max(best["bytes"]) * count / n,
        "largest share of entries, times processes": max(best["nnz"]) * count / sum(best["nnz"]),
    }
    return row, found.x


@case(
    "Solids in parts: PETSc's GAMG on MPI processes",
    source="this project's own solver, in one process; PETSc (Balay et al. 1997)",
    settings=("unknowns", "processes"),
    alone="full",
)
def run(run: Run, page: Page) -> None:
    """The same bar on more processes, and bars that grow with them."""
    if petsc.interpreter() is None:
        raise MissingToolError(f"no Python here has petsc4py: {petsc.INSTALL}")
    size = float(run.settings.get("unknowns", QUICK if run.quick else UNKNOWNS))
    most = int(run.settings.get("processes", cores()))
    counts = [2**k for k in range(most.bit_length()) if 2**k <= most]
    repeats = 1 if run.quick else 5
    strong: list[Record] = []
    apart = 0.0
    with run.step("one size"):
        system, F = bar(size)
        exact = solve(system, F, tolerance=TOLERANCE).x
        for count in counts:
            row, x = measured(system, F, count, repeats)
            strong.append(row)
            apart = max(apart, float(np.abs(x - exact).max() / np.abs(exact).max()))
    with run.step("sizes that grow with the processes"):
        weak = [measured(*bar(size / most * count), count, repeats)[0] for count in counts]
    with run.step("messages"):
        small = measured(*bar(SMALL), counts[-1], repeats)[0]
    page.vanishes(
        "largest difference from the solution of one process without PETSc, relative",
        apart,
        within=1e-8,
        why=f"both stop at an energy error of {TOLERANCE:g}",
        source="this project's solver, chosen by itself",
    )
    model = Model.of(strong[0], weak, small)
    predicted = [model.row(TARGET, count) for count in MANY]
    best = min(predicted, key=lambda row: float(row["set-up and solve [s]"]))
    last = strong[-1]
    gain = sum(times(strong[0])) / sum(times(last))
    page.answer(
        f"{last['unknowns']:,} unknowns: {last['processes']} processes are {gain:.2f} times as "
        f"fast as one, with {last['iterations']} iterations against {strong[0]['iterations']}.",
        "A quick run is too small to extrapolate from."
        if run.quick
        else f"By the model below, 1e9 unknowns would take {best['set-up and solve [s]']:.0f} s on "
        f"{best['processes']:,} processes such as these, and {best['memory [TB]']:.2g} TB.",
    )
    page.section("Measured")
    page.table(f"One size (strong), best of {repeats}", strong)
    page.table(f"So many unknowns a process (weak), best of {repeats}", weak)
    page.data("strong", strong)
    page.data("weak", weak)
    if not run.quick:
        page.section("Extrapolated")
        page.table("1e9 unknowns, by the model", predicted)
        page.text(model.words())
        page.data("predicted", predicted)


def times(row: Record) -> tuple[float, float]:
    """Seconds of set-up and of solve."""
    return float(row["set-up [s]"]), float(row["solve [s]"])


@dataclass(frozen=True)
class Model:
    """Time of n unknowns on p processes: (s + i c) n / (p e) + (l_s + i l) log2 p.

    Attributes
    ----------
    set_up, iteration : float
        s and c, of one process [s for each unknown].
    efficiency : float
        e of the weak series: what processes of one machine lose to each other.
    set_up_messages, messages : float
        l_s and l, of a system so small that nothing but messages counts [s].
    iterations, growth : float
        i = iterations n^growth, of the weak series; none where it falls.
    bytes : float
        For each unknown.
    """

    set_up: float
    iteration: float
    efficiency: float
    set_up_messages: float
    messages: float
    iterations: float
    growth: float
    bytes: float

    @classmethod
    def of(cls, one: Record, weak: Sequence[Record], small: Record) -> Model:
        """That of measured rows."""
        n, count = float(one["unknowns"]), max(1.0, np.log2(int(small["processes"])))
        set_up, solve = times(one)
        first, last = weak[0], weak[-1]
        ratio = float(last["unknowns"]) / float(first["unknowns"])
        its = [float(row["iterations"]) for row in (first, last)]
        growth = max(0.0, float(np.log(its[1] / its[0]) / np.log(ratio))) if ratio > 1.0 else 0.0
        each = [
            sum(times(row)) / float(row["unknowns"]) * int(row["processes"])
            for row in (first, last)
        ]
        small_set_up, small_solve = times(small)
        return cls(
            set_up / n,
            solve / n / float(one["iterations"]),
            min(1.0, each[0] / each[1]),
            small_set_up / count,
            small_solve / float(small["iterations"]) / count,
            its[1] / float(last["unknowns"]) ** growth,
            growth,
            float(last["memory of a process [bytes/unknown]"]),
        )

    def row(self, n: float, count: int) -> Record:
        """What n unknowns take on so many processes."""
        its = self.iterations * n**self.growth
        work = (self.set_up + its * self.iteration) * n / count / self.efficiency
        waiting = (self.set_up_messages + its * self.messages) * float(np.log2(count))
        return {
            "processes": count,
            "iterations": its,
            "work [s]": work,
            "messages [s]": waiting,
            "set-up and solve [s]": work + waiting,
            "memory [TB]": self.bytes * n / 1e12,
            "memory of a process [GB]": self.bytes * n / count / 1e9,
        }

    def words(self) -> str:
        """The model, and what it leaves out."""
        return (
            "Model: (s + i c) n / (p e) + (l_s + i l) log2 p seconds for n unknowns on p "
            f"processes, with s = {1e6 * self.set_up:.3g} us of set-up and c = "
            f"{1e9 * self.iteration:.3g} ns of each of i = {self.iterations:.3g} "
            f"n^{self.growth:.2f} iterations for an unknown on one process, e = "
            f"{self.efficiency:.2f} from the weak series, and l_s = "
            f"{1e3 * self.set_up_messages:.3g} ms and l = {1e3 * self.messages:.3g} ms of "
            f"messages, measured with {SMALL} unknowns. Messages are those of processes that share "
            "memory, and sums are taken to grow as log2 p: a network is slower, and levels "
            "of few unknowns on many processes are not in the model. Growth of iterations is that "
            "of two sizes, carried on over decades. Mesh, assembly and elimination are made by one "
            "process, which reads and writes the matrix once: for 1e9 unknowns these would have to "
            "be in parts, too."
        )
