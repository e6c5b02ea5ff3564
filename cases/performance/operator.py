"""The elastic operator beside scikit-fem's generic form: same matrix, other time."""

from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from skfem import (
    Basis,
    ElementHex1,
    ElementHex2,
    ElementHexS2,
    ElementTetP1,
    ElementTetP2,
    ElementVector,
    MeshHex,
    MeshTet,
    MeshTet2,
)
from skfem.models.elasticity import linear_elasticity

from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats, Ints, Times, run_python, scratch_folder, timed_runs
from fe_drivetrain.drivetrain_file import MATERIALS
from fe_drivetrain.elasticity.interfaces import eliminate, fixed
from fe_drivetrain.elasticity.mesh import Mesh, element_kind, generate
from fe_drivetrain.elasticity.operator import assemble, is_straight, kernels, sparsity
from fe_drivetrain.elasticity.solve import Solution, factorise, reduce
from fe_drivetrain.geometry import MeshSizes, Section, Shaft
from fe_drivetrain.report import bars
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run, column, goal

#: Mesh size of the hollow shaft of about 110 000 unknowns [m], and a small one.
SIZE, QUICK = 0.0515, MeshSizes(shaft=0.3, elements_per_turn=8)

#: Goals: times faster than scikit-fem's generic form, and share of set-up and solve of one load.
FASTER = 15.0
SHARE = 1.0 / 3.0

#: Elements as a reader knows them.
IN_WORDS = {
    "tetra": "tetrahedra of 4 nodes",
    "tetra10": "tetrahedra of 10 nodes",
    "hexahedron": "hexahedra of 8 nodes",
    "hexahedron20": "hexahedra of 20 nodes",
    "hexahedron27": "hexahedra of 27 nodes",
}
BY_ELEMENT = "Time to assemble a box of each element, here and by scikit-fem; bars: all runs"

#: Cuts of a cube's edges: about as many nodes of each element, by its number of nodes.
CUTS = {4: 24, 10: 12, 8: 24, 20: 14, 27: 12}

COMPILE = """
import time
import numpy as np
start = time.perf_counter()
from fe_drivetrain.elasticity.interfaces import eliminate, fixed
from fe_drivetrain.elasticity.operator import assemble
from fe_drivetrain.elasticity.solve import multigrid, reduce
imported = time.perf_counter()
points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [.5, 0, 0], [.5, .5, 0],
                   [0, .5, 0], [0, 0, .5], [.5, 0, .5], [0, .5, .51]], dtype=float)
cells = np.arange(10)[None]
K = assemble(points, cells, (1.0, 1.0))
assembled = time.perf_counter()
system = reduce(points, cells, K, eliminate([fixed("", np.array([0, 1, 2]), 30)], 30))
hierarchy = multigrid.build(system)
multigrid.conjugate_gradients(system.K, np.ones((30, 2)), hierarchy.precondition, 1e-3)
print(imported - start, assembled - imported, time.perf_counter() - assembled)
"""

#: Columns that the stiffness is multiplied with at once.
COLUMNS = (1, 4, 6, 8, 10, 12, 16, 24)


@case(
    "The elastic operator against scikit-fem's generic assembly",
    source="scikit-fem (Gustafsson, McBain 2020), measured in one run",
    settings={"repeats": "5 (quick 1; from 1)"},
    alone="full",
)
def run(run: Run, page: Page) -> None:
    """Assemble every element kind both ways, and the shaft of 110 000 unknowns."""
    lame = MATERIALS["steel"].lame
    with run.step("compile"):
        first, later = (None, None) if run.quick else compile_times(5)
        for n_nodes in (4, 10, 8):
            assemble(*box(n_nodes, 1), lame)
    repeats = run.count("repeats", 1 if run.quick else 5)
    section = Section(length=2.0, outer_diameter=0.7, inner_diameter=0.3)
    sizes = QUICK if run.quick else MeshSizes(shaft=SIZE)
    found = assembled(run, generate(Shaft(sections=(section,), front=0.0), [], {}, sizes), repeats)
    with run.step("products"):
        products = [product_time(found.K, count, 2 * repeats) for count in COLUMNS]
    with run.step("other elements"):
        rows = [
            beside(kind, cuts // (4 if run.quick else 1), repeats) for kind, cuts in CUTS.items()
        ]
    page.vanishes(
        "largest difference from scikit-fem's matrix, relative to its largest entry",
        max(found.apart, *column(rows, "difference")),
        within=1e-12,
        why="the same integrals by the same quadrature: round-off",
        source="scikit-fem, linear_elasticity on the same elements",
    )
    show(page, found, rows, products, repeats)
    answer(page, found, rows)
    page.text(
        f"Compiling takes {in_words(first)} the first time that it is used on a machine, and is "
        f"kept on disk: {in_words(later)} from then on, of which most is loading. Both beside the "
        "import of the libraries."
    )
    for name, value in {
        "unknowns": found.unknowns,
        "ratio": found.ratio,
        "own_seconds": found.own.seconds,
        "generic_seconds": found.generic.seconds,
        "reused_seconds": found.reused.seconds,
        "solve_seconds": found.solved.seconds,
        "straight_share": found.straight,
        "compile_seconds": first and first.seconds,
        "load_seconds": later and later.seconds,
        "products": products,
    }.items():
        page.data(name, value)


def answer(page: Page, found: "Assembled", rows: list[Record]) -> None:
    """State the ratio against scikit-fem, of the shaft and of the element where it is least."""
    least = min(rows, key=lambda row: float(row["ratio of medians"]))
    ratio = float(least["ratio of medians"])
    wins = f"; scikit-fem wins with {IN_WORDS[least['element']]}" if ratio < 1.0 else ""
    faster = (
        f"{found.ratio:.0f} times as fast as scikit-fem"
        if found.ratio >= 1.0
        else f"{1 / found.ratio:.2g} times as long as scikit-fem"
    )
    page.answer(
        "How fast is the stiffness matrix of a solid assembled?",
        f"Assembling {found.unknowns:,} unknowns takes {1e3 * found.own.median:.3g}\u00a0ms, "
        f"{faster}, and {formatted(100 * found.share, 2)}\u00a0% of the solve's time{wins}.",
        [
            page.value("time of scikit-fem over ours", found.ratio, beside=FASTER, by="goal"),
            page.value(
                "assembly [ms]",
                1e3 * found.own.median,
                beside=1e3 * found.generic.median,
                by="scikit-fem",
            ),
            page.value(
                "assembly over the solve of one load [%]",
                100.0 * found.share,
                beside=100.0 * SHARE,
                by="goal",
            ),
            page.value(
                f"time of scikit-fem over ours, smallest ({IN_WORDS[least['element']]})", ratio
            ),
            page.value(
                "largest difference of the matrices, relative",
                max(found.apart, *column(rows, "difference")),
            ),
        ],
        hero=BY_ELEMENT,
        cautions=[
            "scikit-fem assembles any weak form; ours is for elasticity alone, and compiled before."
        ],
    )


@dataclass(frozen=True)
class Assembled:
    """Stiffness of the shaft, with times of assembly and solution.

    Attributes
    ----------
    K : sparse array
        Ours.
    unknowns : int
        Its size.
    straight, apart : float
        Share of straight elements, and largest difference from the generic form, relative.
    own, reused, generic, solved : Times
        Assembled with and without the sparsity, generically, and solved for one load.
    method : str
        What solved it.
    """

    K: Any
    unknowns: int
    straight: float
    apart: float
    own: Times
    reused: Times
    generic: Times
    solved: Times
    method: str

    @property
    def ratio(self) -> float:
        """Time of the generic form over ours."""
        return self.generic.median / self.own.median

    @property
    def share(self) -> float:
        """Time of assembly over that of the solve."""
        return self.own.median / self.solved.median


def assembled(run: Run, mesh: Mesh, repeats: int) -> Assembled:
    """Assemble the stiffness of a shaft in each way, and solve it for one load."""
    lame, points, cells = MATERIALS["steel"].lame, mesh.points, mesh.cells
    with run.step("shaft of curved tetrahedra"):
        K, own = timed_runs(partial(assemble, points, cells, lame), repeats)
        pattern = sparsity(cells, len(points))
        _, reused = timed_runs(partial(assemble, points, cells, lame, pattern=pattern), repeats)
        theirs, generic = timed_runs(partial(generic_form, points, cells, lame), repeats)
    with run.step("solve"):
        solution, solved = timed_solution(mesh, K, repeats)
    return Assembled(
        K=K,
        unknowns=points.size,
        straight=float(is_straight(points, cells).mean()),
        apart=difference(K, *theirs, points),
        own=own,
        reused=reused,
        generic=generic,
        solved=solved,
        method=solution.diagnostics.method,
    )


def timed_solution(mesh: Mesh, K: Any, repeats: int) -> tuple[Solution, Times]:
    """One load at the front of a shaft that is held at its rear."""
    n = mesh.points.size
    elimination = eliminate([fixed("rear", mesh.face_nodes("shaft.rear"), n)], n)
    system = reduce(mesh.points, mesh.cells, K, elimination)
    F = np.zeros((n, 1))
    F[3 * mesh.face_nodes("shaft.front") + 2] = 1.0
    return timed_runs(lambda: factorise(system).solve(F), repeats)


def beside(n_nodes: int, cuts: int, repeats: int) -> Record:
    """Times of one kind of element, and the difference of both matrices."""
    lame, cube = MATERIALS["steel"].lame, box(n_nodes, cuts)
    K, mine = timed_runs(partial(assemble, *cube, lame), repeats)
    matched, other = timed_runs(partial(generic_form, *cube, lame), repeats)
    return {
        "element": element_kind(n_nodes).name,
        "unknowns": f"{cube[0].size:,}",
        **mine.columns("ours", "ms"),
        **other.columns("scikit-fem", "ms"),
        "ratio of medians": other.median / mine.median,
        "difference": difference(K, *matched, cube[0]),
    }


def show(
    page: Page, found: Assembled, rows: list[Record], products: list[Record], repeats: int
) -> None:
    """Show times of the shaft, goals, other elements, and products with several columns."""
    times = {
        "scikit-fem: basis and linear_elasticity": found.generic,
        "ours, sparsity and values": found.own,
        "ours, values with the sparsity kept": found.reused,
        f"set-up and solve of one load by {found.method}": found.solved,
    }
    page.section("Assembly")
    page.table(
        f"Hollow shaft, curved ten-node tetrahedra, {found.unknowns:,} unknowns, runs of each: "
        f"{repeats}",
        [{"what": what, **of.columns()} for what, of in times.items()],
    )
    page.table(
        "Goals of this project: compiled kernels for one form against a form of any kind, pass by "
        "pass over memory; and assembly is not what a user waits for",
        [
            goal("scikit-fem's generic assembly over ours [x]", found.ratio, least=FASTER),
            goal("assembly over set-up and solve of one load [-]", found.share, most=SHARE),
        ],
    )
    both = {"this project": "ours", "scikit-fem": "scikit-fem"}
    groups: dict[str, dict[str, float]] = {}
    ends: dict[str, dict[str, tuple[float, float]]] = {}
    for name, of in both.items():
        low, middle, high = (f"{of}, {what} [ms]" for what in ("least", "median", "most"))
        groups[name] = {IN_WORDS[row["element"]]: row[middle] for row in rows}
        ends[name] = {IN_WORDS[row["element"]]: (row[low], row[high]) for row in rows}
    shortest = min(min(values.values()) for values in groups.values())
    page.add(bars(BY_ELEMENT, groups, "time [ms]", 0.3 * shortest, ends=ends))
    page.table(
        "Other elements, on a box; tetrahedra straight, hexahedra integrated with 2 or 3 Gauss "
        "points a direction",
        rows,
    )
    page.table(
        "Stiffness of the shaft times several columns at once: part of a vector takes "
        "takes longer than a whole one, so that the solver fills blocks up",
        products,
    )


def product_time(K: Any, columns: int, repeats: int) -> Record:
    """Time of a product with so many columns; K as of `assemble`."""
    X = np.random.default_rng(0).standard_normal((K.shape[0], columns))
    zero, out = np.zeros_like(X), np.empty_like(X)
    _, times = timed_runs(
        lambda: kernels.residual(K.indptr, K.indices, K.data, X, zero, out), repeats
    )
    return {
        "columns": columns,
        **times.columns("", "ms"),
        "median a column [ms]": 1e3 * times.median / columns,
    }


def in_words(times: Times | None) -> str:
    """What a process took, or that it was not measured."""
    if times is None:
        return "some time (not measured in a quick run)"
    return f"{times.median:.1f} s ({times.least:.1f} to {times.most:.1f} s)"


def compile_times(repeats: int) -> tuple[Times, Times]:
    """First calls of all kernels in a new process, with an empty cache and with a full one."""
    found: tuple[list[float], list[float]] = [], []
    for _ in range(repeats):
        with scratch_folder() as folder:
            for seconds in found:
                result = run_python("-c", COMPILE, environment={"NUMBA_CACHE_DIR": str(folder)})
                result.check_returncode()
                _, assembly, solve = map(float, result.stdout.split())
                seconds.append(assembly + solve)
    return Times(tuple(found[0])), Times(tuple(found[1]))


def box(n_nodes: int, cuts: int) -> tuple[Floats, Ints]:
    """A unit cube of one element kind, nodes in VTK's order."""
    kind = element_kind(n_nodes)
    ends = np.linspace(0.0, 1.0, cuts + 1)
    if kind.n_corners == 4:
        mesh = MeshTet.init_tensor(ends, ends, ends)
        corners, points = mesh.t.T, mesh.p.T
    else:
        hexahedra = MeshHex.init_tensor(ends, ends, ends)
        corners, points = hexahedra.t.T[:, element_kind(8).order], hexahedra.p.T
    everywhere = np.einsum("nc,ecd->end", kind.corner_weights(), points[corners])
    _, first, cells = np.unique(
        np.round(everywhere.reshape(-1, 3), 9), axis=0, return_index=True, return_inverse=True
    )
    return everywhere.reshape(-1, 3)[first], cells.reshape(-1, n_nodes).astype(np.int64)


def generic_form(points: Floats, cells: Ints, lame: tuple[float, float]) -> tuple[Any, Basis]:
    """scikit-fem's matrix, and its basis."""
    kind = element_kind(cells.shape[1])
    if kind.name == "tetra10":
        mesh = MeshTet2(points.T.copy(), cells.T.copy(), sort_t=False)
        element = ElementTetP2()
    else:
        used, corners = np.unique(cells[:, : kind.n_corners], return_inverse=True)
        corners = corners.reshape(-1, kind.n_corners)[
            :, np.argsort(element_kind(kind.n_corners).order)
        ]
        make = MeshTet if kind.n_corners == 4 else MeshHex
        mesh = make(points[used].T.copy(), corners.T.copy(), sort_t=False)
        elements = {4: ElementTetP1, 8: ElementHex1, 20: ElementHexS2, 27: ElementHex2}
        element = elements[cells.shape[1]]()
    basis = Basis(mesh, ElementVector(element), intorder=kind.degree)
    return linear_elasticity(*lame).assemble(basis), basis


def difference(own: Any, generic: Any, basis: Basis, points: Floats) -> float:
    """Largest difference of the entries, relative to the largest; matched by the nodes' places."""
    where = np.round(np.vstack([basis.doflocs.T, points]), 9)
    _, number = np.unique(where, axis=0, return_inverse=True)
    node = np.empty(number.max() + 1, dtype=np.int64)
    node[number[basis.N :]] = np.arange(len(points))
    k = basis.element_dofs.shape[0] // 3
    component = np.empty(basis.N, dtype=np.int64)
    component[basis.element_dofs] = np.tile(np.arange(3), k)[:, None]
    ours = 3 * node[number[: basis.N]] + component
    apart = own.tocsr()[ours][:, ours] - generic
    return float(abs(apart).max() / abs(generic).max())
