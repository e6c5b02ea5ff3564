"""A disc bonded to plates, and a bent shaft of the same elements, over Poisson's ratio."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.cases.references import locking_bars as bars
from fe_drivetrain.cases.references import locking_solids as solids
from fe_drivetrain.cases.stability import locking_curves as curves
from fe_drivetrain.cases.stability.locking_curves import (
    AVERAGED,
    AXIS,
    CRITERION,
    DEFAULT,
    NU,
    averaged,
    largest,
    plain,
)
from fe_drivetrain.comparison import DOUBTFUL, last_within
from fe_drivetrain.elasticity.operator import incompressible
from fe_drivetrain.elasticity.solve import MAX_ITERATIONS, TOLERANCE, direct_solvers
from fe_drivetrain.report import crosses, marked
from fe_drivetrain.report.suite import Page, Run

NUS = (0.3, 0.4, 0.45, 0.49, 0.499, 0.4999)
QUICK_NUS = (0.3, 0.49, 0.499, 0.4999)

#: Elements of the disc: size [m] and number round a turn; about two through its thickness.
SIZE, TURN = 0.07, 16
#: Coarser ones [m], to less than two elements through the thickness.
COARSER = (0.08, 0.09, 0.1)
QUICK_COARSER = (0.1,)

REMEDIED = (
    "disc, curved tetrahedra of 10 nodes, averaged: stiffness over the exact one where it is "
    "worst, nu = {:g}"
)
DISC_ERRORS = (
    "Error of the bonded disc's stiffness in tetrahedra over bulk by shear modulus; shaded, where "
    "wide enough to be seen: plain 10-node ones within 1 %"
)

#: Length of the bent shaft over its diameter.
SLENDERNESS = 2


@dataclass(frozen=True)
class DiscSweep:
    """The bonded disc over Poisson's ratio.

    Attributes
    ----------
    nus : tuple of float
        Poisson's ratios.
    errors : dict of list of float
        Of the stiffness, relative, by element.
    disc : Disc
        In tetrahedra of ten nodes.
    stiffness : float
        With averaged dilatation, at the last nu, by a direct solver [N/m].
    sizes : list of float
        Element sizes over the thickness, finest first.
    by_size : list of float
        Relative error of the averaged stiffness in each of them, at the last nu.
    change : float
        Change of the worst averaged error from a finer mesh.
    uncertain : float
        Relative uncertainty of the reference.
    """

    nus: tuple[float, ...]
    errors: dict[str, list[float]]
    disc: solids.Disc
    stiffness: float
    sizes: list[float]
    by_size: list[float]
    change: float
    uncertain: float


def solve_disc(run: Run) -> DiscSweep:
    """Pull a bonded disc in tetrahedra: every Poisson's ratio, and coarser meshes at the last."""
    nus = QUICK_NUS if run.quick else NUS
    with run.step("mesh of the disc"):
        discs = solids.discs(solids.disc_mesh(SIZE, TURN))
        finer = solids.discs(solids.disc_mesh(0.8 * SIZE, TURN))[10]
    with run.step("reference of the disc"):
        exact = [solids.exact_disc(nu) for nu in nus]
        rough = solids.exact_disc(nus[-1], order=5)
    errors: dict[str, list[float]] = {}
    for name, nodes, assembly in (
        ("4 nodes", 4, plain),
        (DEFAULT, 10, plain),
        (AVERAGED, 10, averaged),
    ):
        with run.step("disc, direct"):
            run.report(f"disc: tetrahedra of {name}")
            stiffness = [discs[nodes].stiffness(nu, assembly, "superlu")[0] for nu in nus]
            errors[name] = [k / e - 1.0 for k, e in zip(stiffness, exact, strict=True)]
    remedied = np.array(errors[AVERAGED])
    with run.step("band of the disc"):
        worst = int(np.abs(remedied).argmax())
        other = finer.stiffness(nus[worst], averaged, "superlu")[0] / exact[worst] - 1.0
    thickness = solids.DISC.rear - solids.DISC.front
    sizes = [SIZE, *(QUICK_COARSER if run.quick else COARSER)]
    by_size = [errors[AVERAGED][-1]]
    with run.step("coarser discs"):
        for size in sizes[1:]:
            coarse = solids.discs(solids.disc_mesh(size, TURN))[10]
            by_size.append(coarse.stiffness(nus[-1], averaged, "superlu")[0] / exact[-1] - 1.0)
    return DiscSweep(
        nus,
        errors,
        discs[10],
        stiffness[-1],
        [size / thickness for size in sizes],
        by_size,
        abs(other - remedied[worst]),
        abs(rough / exact[-1] - 1.0),
    )


def check_disc(page: Page, found: DiscSweep) -> None:
    """Check that plain tetrahedra lock and the remedy holds; state both limits."""
    nus, errors = found.nus, found.errors
    remedied, by_size = errors[AVERAGED], found.by_size
    worst = int(np.abs(remedied).argmax())
    page.equals(
        REMEDIED.format(nus[worst]),
        1.0 + remedied[worst],
        1.0,
        within=CRITERION,
        why=curves.HOLDS,
        source="the disc's meridian in elements of order 6, graded to its edge; uncertain by "
        f"{found.uncertain:.1g}",
        measure="stiffness",
        band=DOUBTFUL * found.change,
    )
    page.holds(
        f"disc, plain tetrahedra of 10 nodes, nu = {nus[-1]:g}: locked",
        errors[DEFAULT][-1] > CRITERION,
        why="a sweep in which nothing locks finds no limit",
        source="what the sweep is to find",
    )
    curves.limit(
        page,
        f"tetrahedra of {DEFAULT}, disc bonded to plates",
        nus,
        errors[DEFAULT],
        f"a part with nu of {incompressible.AVERAGED_FROM:g} or more has its dilatation averaged, "
        "and a warning says so",
        f"dilatation averaged: within {100 * largest(remedied):.2g} %",
    )
    curves.limit(
        page,
        f"averaged tetrahedra of {DEFAULT}, disc bonded to plates, nu = {nus[-1]:g}",
        found.sizes,
        by_size,
        "the warning asks for four elements through the thickness",
        f"smaller elements: {100 * by_size[0]:.2g} % at {found.sizes[0]:.2g}",
        "element size over the disc's thickness [-]",
    )


def show_disc(page: Page, found: DiscSweep) -> None:
    """Show the errors of the disc."""
    nus, errors = found.nus, found.errors
    page.chart(
        DISC_ERRORS,
        curves.error_traces(errors, nus),
        AXIS,
        "error [%]",
        "xy",
        curves.shaded(last_within(nus, errors[DEFAULT], CRITERION)),
    )
    page.text(
        "A locked mesh has no displacement that keeps the volume of each of its elements at every "
        "point, so its stiffness grows with lambda without limit. Straight tetrahedra of ten nodes "
        "have such displacements in the cylinder, curved ones do not: the curved map spoils them. "
        "The disc, 2 elements thick between plates, leaves them none. Averaged dilatations leave "
        "them again, if the elements are small enough."
    )
    page.table(
        f"Bonded disc in averaged tetrahedra, nu = {nus[-1]:g}",
        [
            {"element size over thickness": size, "error of the stiffness [%]": 100 * error}
            for size, error in zip(found.sizes, found.by_size, strict=True)
        ],
    )
    page.data("disc_nu", nus)
    page.data("disc", errors)


def bent_shaft(run: Run, page: Page, of_disc: DiscSweep) -> None:
    """What averaging costs where nothing locks: the same elements in a bent shaft."""
    nus, switch = of_disc.nus, incompressible.AVERAGED_FROM
    bent: dict[str, list[float]] = {}
    with run.step("bent shaft"):
        for across in (2, 4):
            shaft = bars.round_tetrahedra(SLENDERNESS * bars.SIDE, across)[10]
            for name, assembly in (("plain", plain), ("averaged", averaged)):
                if run.quick and (name, across) == ("plain", 4):
                    continue
                errors = [bars.bend(shaft, assembly, nu).excess for nu in nus]
                bent[f"{name}, {across} across"] = errors
    two, four = bent["averaged, 2 across"], bent["averaged, 4 across"]
    at = int(np.abs(four).argmax())
    page.equals(
        "bent shaft, curved tetrahedra of 10 nodes, averaged, 4 across: stiffness over E I where "
        f"it is worst, nu = {nus[at]:g}",
        1.0 + four[at],
        1.0,
        within=CRITERION,
        why=curves.HOLDS,
        source="E I of the mesh: a prism under end moments, Timoshenko and Goodier 1970, art 102",
        measure="stiffness",
        band=abs(four[at] - two[at]),
    )
    worse_plain, worse_averaged = (
        np.maximum(np.abs(of_disc.errors[element]), np.abs(bent[f"{name}, 2 across"]))
        for name, element in (("plain", DEFAULT), ("averaged", AVERAGED))
    )
    page.holds(
        f"where scenes are averaged, nu from {switch:g} on: the worse error of disc and bent "
        "shaft, two elements across, is less than that of plain elements",
        bool((worse_averaged < worse_plain)[np.array(nus) >= switch].all()),
        why="averaging that made a scene worse would have to begin at another nu",
        source="the rule by which the program switches",
    )
    bad = [across for across, of in ((2, two), (4, four)) if largest(of) > CRITERION]
    page.limit(
        f"averaged tetrahedra of {DEFAULT}, bent shaft, nu from {nus[0]:g} to {nus[-1]:g}",
        "elements across the diameter [-]",
        low=4.0 if bad == [2] else None,
        criterion=curves.WITHIN,
        beyond=f"{-100 * min(two):.2g} % too soft with 2",
        program="the warning asks for four elements through the thickness",
        remedy=f"4 across: {-100 * min(four):.2g} %; plain elements below nu = {switch:g}",
    )
    page.section("What averaging costs")
    page.chart(
        "Error of a bent shaft's stiffness, tetrahedra of 10 nodes as the program meshes: plain "
        "ones lock late, averaged ones are too soft, by one share at every nu (shaded: where "
        f"scenes stay plain, nu below {switch:g})",
        curves.error_traces(bent, nus),
        AXIS,
        "error [%]",
        "xy",
        curves.shaded(switch),
    )
    page.data("bent", bent)


def iterations(run: Run, page: Page, of_disc: DiscSweep) -> list[int]:
    """Multigrid on the disc, alone and with a fallback; iterations with plain elements."""
    nus, disc = of_disc.nus, of_disc.disc
    moduli = np.array([solids.bulk_over_shear(nu) for nu in nus])
    counts, converged = iterated(run, of_disc)
    used, automatic = check_fallback(run, page, of_disc)
    check_growth(page, nus, counts)
    safe = last_within(nus, [0.0 if ok else 1.0 for ok in converged[DEFAULT]], 0.5)
    page.limit(
        "multigrid, curved tetrahedra of 10 nodes",
        NU,
        high=safe,
        criterion=f"an energy error of {TOLERANCE:g} in {MAX_ITERATIONS} iterations",
        beyond=f"stops short after {counts[DEFAULT][-1]} iterations at nu = {nus[-1]:g}; averaging "
        "the dilatation does not help",
        program=f"solves directly instead ({used}), and says so; auto takes {automatic} at this "
        "size",
        remedy="a direct solver",
    )
    traces = []
    for name, n in counts.items():
        good, of = np.array(converged[name]), np.array(n)
        traces.append(marked(name, moduli[good], of[good]))
        traces.append(crosses(f"{name}: stopped short", moduli[~good], of[~good]))
    page.section("Iterations")
    page.chart(
        f"Multigrid on the disc, iterations to an energy error of {TOLERANCE:g} "
        f"({disc.unknowns:,} unknowns; a direct solver takes none)",
        traces,
        AXIS,
        "iterations",
        "x",
        curves.shaded(safe),
    )
    page.data("iterations", counts)
    page.data("reached", converged)
    return counts[DEFAULT]


def iterated(run: Run, of_disc: DiscSweep) -> tuple[dict[str, list[int]], dict[str, list[bool]]]:
    """Iterations of multigrid on the disc, by element, and whether each has converged."""
    counts: dict[str, list[int]] = {}
    converged: dict[str, list[bool]] = {}
    for name, assembly in ((DEFAULT, plain), (AVERAGED, averaged)):
        if run.quick and assembly is averaged:
            continue
        with run.step("disc, multigrid"):
            found = [of_disc.disc.iterated(nu, assembly) for nu in of_disc.nus]
        counts[name] = [i.iterations for i in found]
        converged[name] = [i.energy_error <= TOLERANCE for i in found]
    return counts, converged


def check_fallback(run: Run, page: Page, of_disc: DiscSweep) -> tuple[str, str]:
    """Check the fallback to a direct solver; return the solver used, and that of auto."""
    nus, disc = of_disc.nus, of_disc.disc
    with run.step("disc, fallback"):
        stiffness, used = disc.stiffness(nus[-1], averaged, "multigrid")
        automatic = disc.stiffness(nus[-1], averaged)[1]
    page.holds(
        f"disc, multigrid asked for at nu = {nus[-1]:g}: a direct solver stepped in",
        used.method in direct_solvers.PACKAGES,
        why="the stiffness of an iteration that has not converged would be wrong",
        source="solvers.Solver: an iteration short of its tolerance is not handed on",
    )
    page.vanishes(
        "disc: stiffness of that solution, relative to the direct one, less one",
        stiffness / of_disc.stiffness - 1.0,
        within=1e-9,
        why="round-off of a factor: 1e-16 times a condition number of about 1e6, and margin",
        source="the same matrix",
    )
    return used.method, automatic.method


def check_growth(page: Page, nus: tuple[float, ...], counts: Mapping[str, list[int]]) -> None:
    """Check how iterations grow with the ratio of moduli."""
    grew = [nus.index(nu) for nu in (0.49, 0.499)]
    at = [solids.bulk_over_shear(nus[k]) for k in grew]
    decades = np.log(at[1] / at[0])
    for name, n in counts.items():
        page.equals(
            f"disc, tetrahedra of {name}: power of bulk over shear modulus that multigrid's "
            "iterations grow with, nu from 0.49 to 0.499",
            float(np.log(n[grew[1]] / n[grew[0]]) / decades),
            0.5,
            within=0.25,
            relative=False,
            why="half way to 0, of a method that does not feel lambda, and to 1, of one without "
            "conjugate gradients",
            source="conjugate gradients take the root of the condition number, which a smoother of "
            "displacements leaves as lambda / mu",
            measure="order",
            band=float(np.log1p(1.0 / n[grew[0]]) / decades),
        )
