"""Solids in parts on MPI processes: strong and weak scaling, and what 1e9 unknowns would take."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats, MissingToolError, cores
from fe_drivetrain.comparison import PowerLaw, power_law
from fe_drivetrain.drivetrain_file import MATERIALS
from fe_drivetrain.elasticity.interfaces import eliminate, fixed
from fe_drivetrain.elasticity.mesh import brick
from fe_drivetrain.elasticity.solve import ElementSystem, cut, petsc, solve
from fe_drivetrain.report import error_bars, trace
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import Page, Record, Run

#: Unknowns of the strong series, of a full and a quick run.
UNKNOWNS, QUICK = 200_000, 3_000
#: Shares of these that the model is fitted to, too.
SHARES = (0.06, 0.12, 0.25, 0.5)
REPEATS = 5
TOLERANCE = 1e-10
#: Unknowns of the system whose iterations cost what messages cost.
SMALL = 500
TARGET = 1e9
#: Processes that the target is extrapolated to.
MANY = (8192, 16384, 32768)
#: Parts whose border is counted.
PARTS = (2, 4, 8, 16, 32, 64)

PROCESSES, SIZE, EACH = "processes", "unknowns", "unknowns of a process"
ASSEMBLY, SET_UP, SOLVE = "assembly [s]", "set-up [s]", "solve [s]"
TOTAL, ITERATION = "all three [s]", "time of an iteration [ms]"
MEMORY, PEAK = "memory of a process [MB]", "with interpreter [MB]"
ENDS = "least [s]", TOTAL, "most [s]"
STRONG = "Time of one size on more processes; bars: least and most of all runs"
HANDING = "handing over, by one process [s]"
FILES = "files handed over [bytes/unknown]"
ITERATIONS = "iterations"


def bar(unknowns: float) -> tuple[ElementSystem, Floats]:
    """A bar of steel, four times as long as wide, held at one end and pulled sideways at the other.

    Quadratic tetrahedra, six in each cube of the bar; nobody has assembled it.
    """
    cuts = max(1, round((unknowns / 3 / (4 * 8)) ** (1 / 3)))
    block = brick((4 * cuts, cuts, cuts), 10, lambda x: x * [4.0, 1.0, 1.0])
    points, n = block.points, block.points.size
    elimination = eliminate([fixed("end", np.flatnonzero(points[:, 0] == 0.0), n)], n)
    F = np.zeros((n, 1))
    F[3 * np.flatnonzero(points[:, 0] == 4.0) + 2] = 1.0
    return ElementSystem(points, [(block.cells, MATERIALS["steel"].lame)], elimination), F


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


def measured(system: ElementSystem, F: Floats, count: int, repeats: int) -> tuple[Record, Floats]:
    """Times of some solutions on so many processes, those of the median run; its solution."""
    runs = []
    with processes(count):
        for _ in range(repeats):
            ranks = petsc.Ranks(system, "petsc")
            found = ranks.solve(F, TOLERANCE)
            runs.append((row_of(system, ranks.facts, found.iterations), found.x))
            del ranks
    runs.sort(key=lambda run: float(run[0][TOTAL]))
    row, x = runs[len(runs) // 2]
    least, most = runs[0][0][TOTAL], runs[-1][0][TOTAL]
    return row | {"least [s]": least, "most [s]": most}, x


def row_of(system: ElementSystem, facts: petsc.Facts, iterations: int) -> Record:
    """What a table shows of one run."""
    n, count = system.n_free, facts["ranks"]
    seconds = [facts[f"{phase}_seconds"] for phase in ("read", "setup", "solve")]
    return {
        PROCESSES: count,
        SIZE: n,
        EACH: n / count,
        ITERATIONS: iterations,
        **dict(zip((ASSEMBLY, SET_UP, SOLVE), seconds, strict=True)),
        TOTAL: sum(seconds),
        ITERATION: 1e3 * seconds[2] / iterations,
        MEMORY: max(facts["bytes"]) / 1e6,
        PEAK: max(facts["peaks"]) / 1e6,
        "elements integrated twice [%]": 100 * (sum(facts["elements"]) / len(system.cells) - 1),
        "largest share of entries, times processes": max(facts["nnz"]) * count / sum(facts["nnz"]),
        HANDING: facts["hand_over_seconds"],
        FILES: facts["hand_over_bytes"] / n,
    }


@case(
    "Solids in parts: PETSc's GAMG on MPI processes",
    source="this project's own solver, in one process; PETSc (Balay et al. 1997)",
    settings={"unknowns": "200000 (quick 3000; from 1000)", "processes": "CORES (from 1)"},
    alone="full",
)
def run(run: Run, page: Page) -> None:
    """The same bar on more processes, and bars that grow with them."""
    if petsc.interpreter() is None:
        raise MissingToolError(f"no Python here has petsc4py: {petsc.INSTALL}")
    size = float(run.count("unknowns", QUICK if run.quick else UNKNOWNS, least=1000))
    most = run.count("processes", cores())
    counts = [2**k for k in range(most.bit_length()) if 2**k <= most]
    repeats = 1 if run.quick else REPEATS
    with run.step("one size"):
        system, F = bar(size)
        halo: list[Record] = [
            {"parts": count, "elements integrated twice [%]": 100 * cut(system, count).halo}
            for count in PARTS
        ]
        strong, apart = one_size(system, F, counts, repeats)
    with run.step("sizes that grow with the processes"):
        weak = [measured(*bar(size / most * count), count, repeats)[0] for count in counts[:-1]]
        weak.append(strong[-1])
    with run.step("smaller sizes, and messages"):
        smaller = [] if run.quick else [measured(*bar(s * size), most, repeats)[0] for s in SHARES]
        small = measured(*bar(SMALL), counts[-1], repeats)[0]
    page.vanishes(
        "largest difference from the solution of one process without PETSc, relative",
        apart,
        within=1e-8,
        why=f"both stop at an energy error of {TOLERANCE:g}",
        source="this project's solver, chosen by itself, of the matrix that one process assembles",
    )
    last = strong[-1]
    shown = f"median of {repeats} by time" if repeats > 1 else "one run"
    show(page, strong, weak, halo, shown)
    if run.quick:
        page.note("A quick run is too small to extrapolate from.")
        answer(page, strong, None)
        return
    model = Model.of([*smaller, last], [*weak[:-1], *strong[:-1]], small)
    best = extrapolate(page, model, [*smaller, last], f"{most} processes, {shown}")
    answer(page, strong, best)


def answer(page: Page, strong: list[Record], best: Record | None) -> None:
    """State what more processes gain, and what a billion unknowns would take."""
    first, last = strong[0], strong[-1]
    seconds, gain = float(last[TOTAL]), float(first[TOTAL]) / float(last[TOTAL])
    pays = (
        f"{gain:.2g} times as fast as one"
        if gain >= 1.0
        else f"{1 / gain:.2g} times slower than one"
    )
    far = "" if best is None else f"; extrapolated, 10⁹ unknowns take {best['time [s]']:.0f}\u00a0s"
    figures = [
        page.value("speed over one process", gain, beside=float(last[PROCESSES]), by="processes"),
        page.value("assembly, set-up and solve [s]", seconds, beside=float(first[TOTAL]), by="one"),
        page.value(MEMORY, float(last[MEMORY]), beside=float(first[MEMORY]), by="one"),
        page.value(ITERATIONS, float(last[ITERATIONS]), beside=float(first[ITERATIONS]), by="one"),
    ]
    if best is not None:
        figures += [
            page.value(
                f"10⁹ unknowns on {best[PROCESSES]:,} processes [s]",
                float(best["time [s]"]),
                0.5 * (float(best["at most [s]"]) - float(best["at least [s]"])),
            ),
            page.value("memory of these [TB]", float(best["memory [TB]"])),
        ]
    page.answer(
        "What do more processes gain for a solid in parts, and where would that end?",
        f"{last[SIZE]:,} unknowns on {last[PROCESSES]} processes take {value_text(seconds, 's')}, "
        f"{pays}{far}.",
        figures,
        hero=STRONG,
        cautions=[
            "Processes share one machine and its memory: a network is slower.",
            "One process cuts up the mesh and hands it over, which is not in the times.",
        ],
    )


def one_size(
    system: ElementSystem, F: Floats, counts: Sequence[int], repeats: int
) -> tuple[list[Record], float]:
    """Times of one system over the number of processes, and the difference from our solution."""
    exact = solve(system, F, tolerance=TOLERANCE).x
    rows, apart = [], 0.0
    for count in counts:
        row, x = measured(system, F, count, repeats)
        rows.append(row)
        apart = max(apart, float(np.abs(x - exact).max() / np.abs(exact).max()))
    return rows, apart


def extrapolate(page: Page, model: Model, fitted: list[Record], measured_on: str) -> Record:
    """Show 1e9 unknowns by the model, and the points of its fit; the row that takes least time."""
    predicted = [model.row(TARGET, count) for count in MANY]
    best = min(predicted, key=lambda row: float(row["time [s]"]))
    page.say(
        f"By the model below 1e9 unknowns take {best['time [s]']:.0f} s (95 %: "
        f"{best['at least [s]']:.0f} to {best['at most [s]']:.0f} s) on {best[PROCESSES]:,} "
        f"processes such as these, and {best['memory [TB]']:.2g} TB; cutting up the mesh and "
        f"handing it over, which one process does, {best[HANDING]:.0f} s before.",
    )
    page.section("Extrapolated")
    page.table("1e9 unknowns, by the model", predicted)
    page.table(
        f"What the model is fitted to, on {measured_on}",
        fitted,
        [SIZE, EACH, ITERATIONS, ASSEMBLY, SET_UP, ITERATION, MEMORY, HANDING],
    )
    page.table("Laws, and how far the points are from them", model.laws())
    page.text(model.words())
    page.data("predicted", predicted)
    page.data("laws", model.laws())
    return best


def show(
    page: Page, strong: list[Record], weak: list[Record], halo: list[Record], shown: str
) -> None:
    """Show both sweeps, memory, and the elements that are integrated twice."""
    page.section("Measured")
    page.chart(
        STRONG,
        [
            trace(
                name,
                [row[PROCESSES] for row in strong],
                [row[key] for row in strong],
                mode="lines+markers",
                **more,
            )
            for name, key, more in (
                ("all three", TOTAL, error_bars("y", *([r[k] for r in strong] for k in ENDS))),
                ("assembly", ASSEMBLY, {}),
                ("set-up", SET_UP, {}),
                ("solve", SOLVE, {}),
            )
        ],
        PROCESSES,
        "time [s]",
        "xy",
    )
    page.table(f"One size (strong), {shown}", strong)
    page.table(f"So many unknowns a process (weak), {shown}", weak)
    page.data("strong", strong)
    page.data("weak", weak)
    page.sweep(
        "Memory of a process, one size on more of them",
        strong,
        PROCESSES,
        {MEMORY: "its part", PEAK: "with interpreter and libraries"},
        log="xy",
        table=False,
        axis="memory [MB]",
    )
    page.sweep(
        f"Elements at borders, integrated by two processes, of {strong[-1][SIZE]:,} unknowns",
        halo,
        "parts",
        "elements integrated twice [%]",
        log="x",
    )


@dataclass(frozen=True)
class Model:
    """Time of n unknowns on p processes: A(n/p) + S(n/p) + i(n) I(n/p) + (l_s + i l) log2 p.

    Attributes
    ----------
    assembly, set_up, iteration, memory : PowerLaw
        A, S and I [s], and memory of a process [bytes], of its number of unknowns.
    iterations : PowerLaw
        i, of the number of unknowns; never fewer than measured.
    handing : float
        Seconds of handing over an unknown, of the largest system.
    set_up_messages, messages : float
        l_s and l, of a system so small that nothing but messages counts [s].
    """

    assembly: PowerLaw
    set_up: PowerLaw
    iteration: PowerLaw
    memory: PowerLaw
    iterations: PowerLaw
    handing: float
    set_up_messages: float
    messages: float

    @classmethod
    def of(cls, rows: Sequence[Record], others: Sequence[Record], small: Record) -> Model:
        """That of rows on equally many processes, iterations of others, and the smallest system."""

        def law(
            key: str, of: str = EACH, unit: float = 1.0, more: Sequence[Record] = ()
        ) -> PowerLaw:
            both = [*rows, *more]
            return power_law([float(r[of]) for r in both], [unit * float(r[key]) for r in both])

        doublings = max(1.0, float(np.log2(int(small[PROCESSES]))))
        return cls(
            law(ASSEMBLY),
            law(SET_UP),
            law(ITERATION, unit=1e-3),
            law(MEMORY, unit=1e6),
            law(ITERATIONS, SIZE),
            float(rows[-1][HANDING]) / float(rows[-1][SIZE]),
            float(small[SET_UP]) / doublings,
            float(small[ITERATION]) / 1e3 / doublings,
        )

    def row(self, n: float, count: int) -> Record:
        """What n unknowns take on so many processes, with the band of all laws together."""
        each, doublings = n / count, float(np.log2(count))

        fewest = float(self.iterations.y.max())

        def seconds(of: Callable[[PowerLaw, float], float]) -> float:
            its = max(fewest, of(self.iterations, n))
            waiting = (self.set_up_messages + its * self.messages) * doublings
            here = of(self.assembly, each) + of(self.set_up, each) + its * of(self.iteration, each)
            return here + waiting

        its = max(fewest, self.iterations(n))
        return {
            PROCESSES: count,
            EACH: each,
            ITERATIONS: its,
            "messages [s]": (self.set_up_messages + its * self.messages) * doublings,
            "time [s]": seconds(lambda law, x: law(x)),
            "at least [s]": seconds(lambda law, x: law.band(x)[0]),
            "at most [s]": seconds(lambda law, x: law.band(x)[1]),
            MEMORY: self.memory(each) / 1e6,
            "memory [TB]": self.memory(each) * count / 1e12,
            "memory at most [TB]": self.memory.band(each)[1] * count / 1e12,
            HANDING: self.handing * n,
        }

    def laws(self) -> list[Record]:
        """The fitted laws, and how well they fit."""
        named = {
            "assembly [s], of the unknowns of a process": self.assembly,
            "set-up [s], of the unknowns of a process": self.set_up,
            "an iteration [s], of the unknowns of a process": self.iteration,
            "memory of a process [bytes], of its unknowns": self.memory,
            "iterations, of all unknowns": self.iterations,
        }
        return [
            {
                "law": name,
                "exponent": law.exponent,
                "at 1e5 unknowns": law(1e5),
                "points": len(law.x),
                "largest misfit [%]": 100 * law.misfit,
            }
            for name, law in named.items()
        ]

    def words(self) -> str:
        """The model, and what it leaves out."""
        smallest, largest = self.assembly.x.min(), self.assembly.x.max()
        return (
            "Model: A(n/p) + S(n/p) + i(n) I(n/p) + (l_s + i l) log2 p seconds for n unknowns on p "
            "processes: assembly A, set-up S and an iteration I as power laws of the unknowns of a "
            f"process, between {smallest:,.0f} and {largest:,.0f} of them, iterations i as one of "
            f"all unknowns; l_s = {1e3 * self.set_up_messages:.3g} ms and l = "
            f"{1e3 * self.messages:.3g} ms of messages, measured with {SMALL} unknowns. At least "
            "and at most are 95 % prediction intervals of every law, all taken at once, so that "
            "chance alone leaves them more rarely than that. What no interval holds: messages are "
            "those of processes that share one machine and its memory, and sums are taken to grow "
            "as log2 p, where a network is slower; levels of few unknowns on many processes are "
            "not in it; iterations are carried on over decades. Each process assembles the rows "
            "of its own elements, and none has the whole matrix. One process has the whole mesh, "
            "cuts it up and hands it over in files: that is measured beside, and not in the time."
        )
