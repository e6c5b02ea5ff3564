"""Nearly incompressible solids: where elements lock and multigrid stalls, and what holds there."""

from collections.abc import Sequence

import numpy as np
from pydantic import ValidationError

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import locking_solids as solids
from fe_drivetrain.cases.stability.bonded_disc import (
    DISC_ERRORS,
    REMEDIED,
    DiscSweep,
    bent_shaft,
    check_disc,
    iterations,
    show_disc,
    solve_disc,
)
from fe_drivetrain.cases.stability.locking_curves import (
    AVERAGED,
    AXIS,
    CRITERION,
    DEFAULT,
    HOLDS,
    averaged,
    error_traces,
    largest,
    limit,
    plain,
    shaded,
)
from fe_drivetrain.common import InputError
from fe_drivetrain.common.arrays import rounded
from fe_drivetrain.comparison import band_of, last_within
from fe_drivetrain.drivetrain_file import MAX_POISSON_RATIO
from fe_drivetrain.elasticity.operator import incompatible, incompressible
from fe_drivetrain.report import crosses, marked
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Run

#: Poisson's ratios of the pressed cylinder.
NUS = (0.3, 0.35, 0.4, 0.45, 0.48, 0.49, 0.495, 0.499, 0.4995, 0.4999)
QUICK_NUS = (0.3, 0.499, 0.4999)

#: Distances of nu from 1/2, down to round-off; criterion there: four digits.
DISTANCES = (1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14, 1e-15)
QUICK_DISTANCES = (1e-4, 1e-6, 1e-8, 1e-12, 1e-14)
DIGITS = 1e-4

#: Nodes, elements through the wall, straight edges, by the elements' names: meshes that are within
#: the criterion at nu = 0.3.
ELEMENTS = {
    "tetrahedra": {
        "4 nodes": (4, 16, False),
        "10 nodes, straight": (10, 6, True),
        "10 nodes, curved": (10, 2, False),
    },
    "hexahedra": {"8 nodes": (8, 8, False), "20 nodes": (20, 2, False), "27 nodes": (27, 2, False)},
}
QUICK_LEFT_OUT = ("10 nodes, straight", "20 nodes")

LAME = "Lame 1852; Timoshenko and Goodier 1970, art 28, in plane strain"


@case(
    "Volumetric locking: Poisson's ratio towards 1/2, elements and multigrid",
    source="Malkus and Hughes 1978, Comput. Methods Appl. Mech. Eng. 15, 63-81; Lame 1852",
)
def run(run: Run, page: Page) -> None:
    """Raise Poisson's ratio towards 1/2 in plain elements and in remedied ones."""
    best = cylinder(run, page)
    of_disc = solve_disc(run)
    check_disc(page, of_disc)
    show_disc(page, of_disc)
    near_half(run, page)
    bent_shaft(run, page, of_disc)
    stress(run, page)
    counts = iterations(run, page, of_disc)
    nus = of_disc.nus
    answer(page, of_disc, best)
    page.say(
        f"Averaging repairs the stiffness, not the matrix: multigrid takes {counts[0]} iterations "
        f"at nu = {nus[0]:g} and stops short at {nus[-1]:g}, where a direct solver steps in.",
    )
    page.image("The disc that is bonded to rigid plates", run.sketch(solids.disc_mesh(0.1, 16)))


def answer(page: Page, of_disc: DiscSweep, best: float) -> None:
    """State how stiff the default element makes a disc, and what averaging leaves of that."""
    nus, errors = of_disc.nus, of_disc.errors
    plain_nu = last_within(nus, errors[DEFAULT], CRITERION)
    worst = nus[int(np.abs(errors[AVERAGED]).argmax())]
    figures = [
        page.value(
            f"disc too stiff by, plain 10-node tetrahedra, ratio {nus[-1]:g} [%]",
            rounded([100 * errors[DEFAULT][-1]], 2)[0],
        ),
        page.value(
            f"disc too stiff by, plain 4-node tetrahedra, ratio {nus[-1]:g} [%]",
            rounded([100 * errors["4 nodes"][-1]], 2)[0],
        ),
        page.judged(
            REMEDIED.format(worst), "worst stiffness of the disc over the exact one, averaged"
        ),
        page.value(
            "worst error of a cylinder, averaged, elements of 8 nodes and more [%]",
            100 * best,
            at_most=100 * CRITERION,
        ),
        page.value("largest Poisson's ratio that the program accepts", MAX_POISSON_RATIO),
    ]
    if plain_nu is not None:
        name = "largest ratio tried with plain 10-node tetrahedra within 1 %, disc"
        figures.insert(0, page.value(name, plain_nu))
    page.answer(
        "How near to 1/2 may Poisson's ratio be in a finite-element model?",
        f"Up to {nus[-1]:g}, as of rubber, if elements average the change of volume: the error is "
        f"{formatted(100 * largest(errors[AVERAGED]), 2)}\u00a0%; without, a disc is "
        f"{formatted(100 * errors[DEFAULT][-1], 2)}\u00a0% too stiff.",
        figures,
        hero=DISC_ERRORS,
        cautions=[
            "The program averages the dilatation by itself from a ratio of "
            f"{incompressible.AVERAGED_FROM:g} on; a bent shaft then needs four elements across.",
            f"The disc was tried at ratios of {', '.join(f'{nu:g}' for nu in nus)} only.",
            "Near 1/2 the multigrid solver does not converge, even with averaging: a direct solver "
            "takes over.",
        ],
    )


def cylinder(run: Run, page: Page) -> float:
    """Press a cylinder in every element, plain and remedied; the worst error of remedied ones."""
    nus = QUICK_NUS if run.quick else NUS
    curves: dict[str, dict[str, list[float]]] = {}
    worst_of_all = 0.0
    page.section("Locking")
    for family, elements in ELEMENTS.items():
        of = curves[family] = {}
        for name, (nodes, through, straight) in elements.items():
            if run.quick and name in QUICK_LEFT_OUT:
                continue
            with run.step("cylinder"):
                run.report(f"cylinder: {family} of {name}")
                of[name] = [solids.press(nodes, through, n, plain, straight).excess for n in nus]
            if nodes == 4:
                continue
            with run.step("cylinder"):
                remedied = [solids.press(nodes, through, n, averaged, straight).excess for n in nus]
            of[f"{name}, averaged"] = remedied
            worst_of_all = max(worst_of_all, largest(remedied))
            with run.step("bands of the cylinder"):
                check_remedied(page, f"{family} of {name}", nus, remedied)
            if family == "hexahedra":
                check_locked(page, name, nus, of[name])
    with run.step("cylinder"):
        modes = [solids.press(8, 8, nu, incompatible.assemble).excess for nu in nus]
        curves["hexahedra"]["8 nodes, incompatible modes"] = modes
    for family, of in curves.items():
        for name, errors in of.items():
            remedy = of.get(f"{name}, averaged")
            limit(
                page,
                f"{family} of {name}, cylinder under pressure",
                nus,
                errors,
                "incompressible.assemble refuses them; scenes are meshed in 10 nodes"
                if remedy is None
                else "averages when asked: solve_solid(assembly=incompressible.assemble)",
                "none inside an element: take more nodes"
                if remedy is None
                else f"dilatation averaged: within {100 * largest(remedy):.2g} %",
            )
        within = [last_within(nus, of[name], CRITERION) for name in of if name in ELEMENTS[family]]
        all_within = None if None in within else min(nu for nu in within if nu is not None)
        page.chart(
            f"Error of the cylinder's stiffness, {family}: solid lines plain, dashed ones remedied "
            "(shaded: where all plain ones are within 1 %)",
            error_traces(of, nus),
            AXIS,
            "error [%]",
            "xy",
            shaded(all_within),
        )
    page.data("nu", nus)
    page.data("cylinder", curves)
    return worst_of_all


def check_locked(page: Page, name: str, nus: Sequence[float], errors: list[float]) -> None:
    """How the stiffness of plain hexahedra grows."""
    modulus = [nu / (1.0 - 2.0 * nu) for nu in nus[-2:]]
    page.equals(
        f"cylinder, plain hexahedra of {name}: power of lambda / mu that the excess of the "
        f"stiffness grows with, nu from {nus[-2]:g} to {nus[-1]:g}",
        float(np.log(abs(errors[-1]) / abs(errors[-2])) / np.log(modulus[1] / modulus[0])),
        1.0,
        within=0.1,
        relative=False,
        why="A, the stiffness without locking, is below a tenth of the excess",
        source="a locked mesh has no field without dilatation: its stiffness is A + lambda B with "
        "B in the way of every displacement",
        measure="order",
    )


def check_remedied(page: Page, label: str, nus: Sequence[float], errors: list[float]) -> None:
    """The stiffness of averaged elements where it is worst, with its band."""
    family, _, name = label.partition(" of ")
    nodes, through, straight = ELEMENTS[family][name]
    worst = int(np.abs(errors).argmax())
    halved = [through // 2, through, 2 * through]
    values = [
        solids.press(nodes, n, nus[worst], averaged, straight).excess
        if n != through
        else errors[worst]
        for n in halved
    ]
    # the band of the mesh in the middle: its difference from the finest, and that one's own band
    beyond = band_of([1.0 / n for n in halved], [1.0 + v for v in values])
    page.equals(
        f"cylinder, {label}, averaged: stiffness over the exact one where it is worst, "
        f"nu = {nus[worst]:g}",
        1.0 + errors[worst],
        1.0,
        within=CRITERION,
        why=HOLDS,
        source=LAME,
        measure="stiffness",
        band=abs(values[2] - values[1]) + beyond,
    )


def near_half(run: Run, page: Page) -> None:
    """Averaged hexahedra down to round-off in 1/2 - nu, and the largest nu of a material."""
    distances = QUICK_DISTANCES if run.quick else DISTANCES
    with run.step("round-off"):
        settled = solids.press(27, 2, 0.5 - distances[0], averaged).excess
        lost, refused = towards_half(distances, settled)
        highest, finer = (solids.press(27, n, MAX_POISSON_RATIO, averaged).excess for n in (2, 4))
    kept, changes = list(lost), np.abs(list(lost.values()))
    check_highest(page, highest, abs(highest - finer))
    nearest = last_within(kept, changes, DIGITS)
    page.limit(
        "averaged dilatation, round-off",
        "1/2 - nu [-]",
        low=nearest,
        criterion=f"stiffness settled within {DIGITS:g}",
        beyond="digits of the stiffness are lost without a warning, "
        + (
            f"from {max(refused):g} on the matrix is singular"
            if refused
            else f"{changes.max():.0e} of it at {kept[-1]:g}"
        ),
        program=f"a material with nu above {MAX_POISSON_RATIO:g} is refused",
        remedy=f"nu = {MAX_POISSON_RATIO:g}, whose stiffness is that of 1/2 to "
        f"{abs(highest - settled):.0e}",
    )
    page.section("How near to 1/2")
    page.chart(
        "Cylinder, averaged hexahedra of 27 nodes: how far the stiffness, over the exact one, is "
        f"from its value at 1/2 - nu = {distances[0]:g} (shaded: four digits)",
        [
            marked("averaged", kept, np.maximum(changes, 1e-12)),
            crosses("found singular", refused),
        ],
        "1/2 - nu [-]",
        "change of the stiffness, relative [-]",
        "xy",
        (nearest, None),
    )


def towards_half(
    distances: Sequence[float], settled: float
) -> tuple[dict[float, float], list[float]]:
    """Change of the stiffness by distance from 1/2, and where the matrix is singular."""
    lost, refused = {}, []
    for distance in distances:
        try:
            lost[distance] = solids.press(27, 2, 0.5 - distance, averaged).excess - settled
        except InputError:
            refused.append(distance)
    return lost, refused


def check_highest(page: Page, highest: float, change: float) -> None:
    """Check the maximum nu of a material, and that a larger one is refused."""
    try:
        solids.material(0.5 - 1e-7)
        accepted = True
    except ValidationError:
        accepted = False
    page.equals(
        "cylinder, hexahedra of 27 nodes, averaged: stiffness over the exact one at the largest nu "
        f"that a material may have, {MAX_POISSON_RATIO:g}",
        1.0 + highest,
        1.0,
        within=CRITERION,
        why="the remedy is to hold a stiffness within 1 % wherever it is accepted",
        source=LAME,
        measure="stiffness",
        band=2.0 * change,
    )
    page.holds(
        "a material with nu = 1/2 - 1e-7 is refused",
        not accepted,
        why="nearer to 1/2 digits of the stiffness are lost without a warning",
        source=f"materials.Material: at most {MAX_POISSON_RATIO:g}",
    )


def stress(run: Run, page: Page) -> None:
    """Radial stress at the middles of the cylinder's elements."""
    h = (solids.RIM - solids.BORE) / 2
    first_middle = solids.BORE + h / 2
    varying = solids.BORE**2 * solids.RIM**2 / (solids.RIM**2 - solids.BORE**2)
    missed = 6.0 * varying / first_middle**4 * h**2 / 24.0
    rows = []
    for nu in (NUS[0], NUS[-1]):
        with run.step("stresses"):
            coarse, fine = (solids.press(27, n, nu, averaged) for n in (2, 4))
            locked = solids.press(27, 2, nu, plain)
            error = solids.radial_stress_error(coarse, nu, averaged=True)
            finer = solids.radial_stress_error(fine, nu, averaged=True)
        rows.append(
            {
                "nu": nu,
                "plain": solids.radial_stress_error(locked, nu, averaged=False),
                "averaged, lambda times the dilatation at the point": solids.radial_stress_error(
                    coarse, nu, averaged=False
                ),
                "averaged, incompressible.stresses": error,
            }
        )
    page.vanishes(
        f"cylinder, hexahedra of 27 nodes, averaged, nu = {nu:g}: largest error of the radial "
        "stress at the middles of elements, over the pressure",
        error,
        within=2.0 * missed,
        why="a line through an element of size h misses s'' h^2 / 24 at its middle, here "
        f"{missed:.2g}; twice that is allowed",
        source=LAME,
        measure="stress",
        band=abs(error - finer),
    )
    page.section("Stress")
    page.table(
        "Cylinder, two hexahedra of 27 nodes through the wall: largest error of the radial stress "
        "at their middles, over the pressure",
        rows,
    )
