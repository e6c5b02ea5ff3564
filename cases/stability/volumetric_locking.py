"""Nearly incompressible solids: where elements lock and multigrid stalls, and what holds there."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: Poisson's ratios of the pressed cylinder and of the bonded disc.
NUS = (0.3, 0.35, 0.4, 0.45, 0.48, 0.49, 0.495, 0.499, 0.4995, 0.4999)
QUICK_NUS = (0.3, 0.499, 0.4999)
DISC_NUS = (0.3, 0.4, 0.45, 0.49, 0.499, 0.4999)
QUICK_DISC_NUS = (0.3, 0.49, 0.499, 0.4999)

CRITERION = 0.01  # error of a stiffness

#: Elements of the disc: size [m] and number round a turn; about two through its thickness.
SIZE, TURN = 0.07, 16
#: Coarser ones [m], to less than two elements through the thickness.
COARSER = (0.08, 0.09, 0.1)
QUICK_COARSER = (0.1,)

#: Distances of nu from 1/2, down to round-off; criterion there: four digits.
DISTANCES = (1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13, 1e-14, 1e-15)
QUICK_DISTANCES = (1e-4, 1e-6, 1e-8, 1e-12, 1e-14)
DIGITS = 1e-4

#: Length of the bent shaft over its diameter.
SLENDERNESS = 2

#: Nodes, elements through the wall, straight edges, by the elements' names: meshes that are within
#: the criterion at nu = 0.3.
TETRAHEDRA = {
    "4 nodes": (4, 16, False),
    "10 nodes, straight": (10, 6, True),
    "10 nodes, curved": (10, 2, False),
}
HEXAHEDRA = {"8 nodes": (8, 8, False), "20 nodes": (20, 2, False), "27 nodes": (27, 2, False)}
QUICK_LEFT_OUT = ("10 nodes, straight", "20 nodes")

AXIS = "bulk over shear modulus: 2.2 at nu = 0.3, 9.7 at 0.45, 50 at 0.49, 500 at 0.499"
BULK = "Poisson's ratio [-]"


def run(run: Run) -> Any:
    """Raise Poisson's ratio towards 1/2 in plain elements and in remedied ones."""
    import numpy as np
    from pydantic import ValidationError

    from fe_drivetrain.common import InputError
    from fe_drivetrain.compare import (
        band_of,
    )
    from fe_drivetrain.operator import elasticity, incompatible, incompressible
    from fe_drivetrain.report import Cell, Limit, Section, Table, Text, chart, judge, trace
    from fe_drivetrain.scene import HIGHEST_POISSON_RATIO
    from fe_drivetrain.solve import MAX_ITERATIONS, TOLERANCE, direct_solvers
    from fe_drivetrain.validation import (
        locking_bars as bars,
    )
    from fe_drivetrain.validation import (
        locking_solids as solids,
    )

    plain, averaged = elasticity.assemble, incompressible.assemble
    nus = QUICK_NUS if run.quick else NUS
    moduli = [solids.bulk_over_shear(nu) for nu in nus]

    # The cylinder.
    families = {
        family: {n: e for n, e in elements.items() if not (run.quick and n in QUICK_LEFT_OUT)}
        for family, elements in (("tetrahedra", TETRAHEDRA), ("hexahedra", HEXAHEDRA))
    }
    curves: dict[str, dict[str, list[float]]] = {"tetrahedra": {}, "hexahedra": {}}
    remedies: list[tuple[str, int, int, bool, list[float]]] = []
    with run.step("cylinder"):
        for family, elements in families.items():
            for name, (nodes, through, straight) in elements.items():
                run.report(f"cylinder: {family} of {name}")
                for assembly, suffix in ((plain, ""), (averaged, ", averaged")):
                    if assembly is averaged and nodes == 4:
                        continue
                    series = [
                        solids.press(nodes, through, nu, assembly, straight).excess for nu in nus
                    ]
                    curves[family][name + suffix] = series
                    if assembly is averaged:
                        label = f"{family} of {name}{suffix}"
                        remedies.append((label, nodes, through, straight, series))
        modes = [solids.press(8, 8, nu, incompatible.assemble).excess for nu in nus]
        curves["hexahedra"]["8 nodes, incompatible modes"] = modes

    def last_within(
        values: list[float], at: tuple[float, ...], criterion: float = CRITERION
    ) -> float:
        """The last place of the sweep up to which the criterion holds, NaN: nowhere."""
        bad = [k for k, v in enumerate(values) if abs(v) > criterion]
        if not bad:
            return at[-1]
        return at[bad[0] - 1] if bad[0] else float("nan")

    source = "Lame 1852; Timoshenko and Goodier 1970, art 28, in plane strain"
    verdicts = []
    for name in families["hexahedra"]:
        first, last = (abs(curves["hexahedra"][name][k]) for k in (-2, -1))
        modulus = [nu / (1.0 - 2.0 * nu) for nu in nus[-2:]]
        verdicts.append(
            judge(
                f"cylinder, plain hexahedra of {name}: power of lambda / mu that the excess of the "
                f"stiffness grows with, nu from {nus[-2]:g} to {nus[-1]:g}",
                float(np.log(last / first) / np.log(modulus[1] / modulus[0])),
                1.0,
                tolerance=0.1,
                relative=False,
                source="a locked mesh has no field without dilatation: its stiffness is A + lambda "
                "B with B in the way of every displacement",
                reason="A, what is there without locking, is below a tenth of the excess",
                measure="order",
                band=0.0,
            )
        )
    with run.step("bands of the cylinder"):
        for label, nodes, through, straight, series in remedies:
            worst = int(np.abs(series).argmax())
            halved = [through // 2, through, 2 * through]
            values = [
                solids.press(nodes, n, nus[worst], averaged, straight).excess
                if n != through
                else series[worst]
                for n in halved
            ]
            # the band of the mesh in the middle: what the finest says of it, and its own band
            beyond = band_of([1.0 / n for n in halved], [1.0 + v for v in values])
            verdicts.append(
                judge(
                    f"cylinder, {label}: stiffness over the exact one where it is worst, "
                    f"nu = {nus[worst]:g}",
                    1.0 + series[worst],
                    1.0,
                    tolerance=CRITERION,
                    source=source,
                    reason="the remedy is to hold a stiffness within 1 % at every nu of the sweep",
                    measure="stiffness",
                    band=abs(values[2] - values[1]) + beyond,
                )
            )

    stress_rows: list[list[Cell]] = []
    h = (solids.RIM - solids.BORE) / 2
    first_middle = solids.BORE + h / 2
    varying = solids.BORE**2 * solids.RIM**2 / (solids.RIM**2 - solids.BORE**2)
    missed = 6.0 * varying / first_middle**4 * h**2 / 24.0
    with run.step("stresses"):
        for nu in (nus[0], nus[-1]):
            coarse, fine = (solids.press(27, n, nu, averaged) for n in (2, 4))
            locked = solids.press(27, 2, nu, plain)
            taken = solids.radial_stress_error(coarse, nu, averaged=True)
            stress_rows.append(
                [
                    nu,
                    solids.radial_stress_error(locked, nu, averaged=False),
                    solids.radial_stress_error(coarse, nu, averaged=False),
                    taken,
                ]
            )
        verdicts.append(
            judge(
                f"cylinder, hexahedra of 27 nodes, averaged, nu = {nu:g}: largest error of the "
                "radial stress at the middles of elements, over the pressure",
                taken,
                0.0,
                tolerance=2.0 * missed,
                relative=False,
                source=source,
                reason="a line through an element of size h misses s'' h^2 / 24 at its middle, "
                f"here {missed:.2g}; twice that is allowed",
                measure="stress",
                band=abs(taken - solids.radial_stress_error(fine, nu, averaged=True)),
            )
        )

    # Down to round-off.
    distances = QUICK_DISTANCES if run.quick else DISTANCES
    with run.step("round-off"):
        settled = solids.press(27, 2, 0.5 - distances[0], averaged).excess
        lost: list[float] = []
        refused: list[float] = []
        for distance in distances:
            try:
                lost.append(solids.press(27, 2, 0.5 - distance, averaged).excess - settled)
            except InputError:
                refused.append(distance)
        kept = [d for d in distances if d not in refused]
        nearest = last_within(lost, tuple(kept), DIGITS)
        try:
            solids.material(0.5 - 1e-7)
            accepted = 1.0
        except ValidationError:
            accepted = 0.0
        highest = solids.press(27, 2, HIGHEST_POISSON_RATIO, averaged).excess
        finer_ring = solids.press(27, 4, HIGHEST_POISSON_RATIO, averaged).excess
    verdicts += [
        judge(
            "cylinder, hexahedra of 27 nodes, averaged: stiffness over the exact one at the "
            f"largest nu that a material may have, {HIGHEST_POISSON_RATIO:g}",
            1.0 + highest,
            1.0,
            tolerance=CRITERION,
            source=source,
            reason="the remedy is to hold a stiffness within 1 % wherever it is let in",
            measure="stiffness",
            band=2.0 * abs(highest - finer_ring),
        ),
        judge(
            "a material with nu = 1/2 - 1e-7: accepted, 1, or refused, 0",
            accepted,
            0.0,
            tolerance=0.0,
            relative=False,
            source=f"materials.Material: at most {HIGHEST_POISSON_RATIO:g}",
            reason="yes or no",
            measure="identity",
        ),
    ]

    # The disc.
    disc_nus = QUICK_DISC_NUS if run.quick else DISC_NUS
    disc_moduli = [solids.bulk_over_shear(nu) for nu in disc_nus]
    with run.step("mesh of the disc"):
        discs = solids.discs(solids.disc_mesh(SIZE, TURN))
        finer = solids.discs(solids.disc_mesh(0.8 * SIZE, TURN))[10]
    with run.step("reference of the disc"):
        exact = [solids.exact_disc(nu) for nu in disc_nus]
        rough = solids.exact_disc(disc_nus[-1], order=5)
    kinds: dict[str, tuple[int, Any]] = {
        "4 nodes": (4, plain),
        "10 nodes, curved": (10, plain),
        "10 nodes, curved, averaged": (10, averaged),
    }
    disc_curves: dict[str, list[float]] = {}
    iterated: dict[str, list[Any]] = {}
    for name, (nodes, assembly) in kinds.items():
        with run.step("disc, direct"):
            run.report(f"disc: tetrahedra of {name}")
            found = [discs[nodes].stiffness(nu, assembly, "superlu") for nu in disc_nus]
            disc_curves[name] = [k / e - 1.0 for (k, _), e in zip(found, exact, strict=True)]
        if nodes == 10 and not (run.quick and assembly is averaged):
            with run.step("disc, multigrid"):
                iterated[name] = [discs[nodes].iterated(nu, assembly) for nu in disc_nus]
        if name.endswith("averaged"):
            direct_stiffness = found[-1][0]
    with run.step("disc, fallback"):
        asked, used = discs[10].stiffness(disc_nus[-1], averaged, "multigrid")
        automatic = discs[10].stiffness(disc_nus[-1], averaged)[1]
    with run.step("band of the disc"):
        series = disc_curves["10 nodes, curved, averaged"]
        worst = int(np.abs(series).argmax())
        other = finer.stiffness(disc_nus[worst], averaged, "superlu")[0] / exact[worst] - 1.0
    with run.step("coarser discs"):
        thickness = solids.DISC.rear - solids.DISC.front
        sizes = [SIZE, *(QUICK_COARSER if run.quick else COARSER)]
        by_size = [disc_curves["10 nodes, curved, averaged"][-1]]
        for size in sizes[1:]:
            coarse_disc = solids.discs(solids.disc_mesh(size, TURN))[10]
            stiffness = coarse_disc.stiffness(disc_nus[-1], averaged, "superlu")[0]
            by_size.append(stiffness / exact[-1] - 1.0)
        per_thickness = tuple(size / thickness for size in sizes)
    verdicts += [
        judge(
            "disc, curved tetrahedra of 10 nodes, averaged: stiffness over the exact one where it "
            f"is worst, nu = {disc_nus[worst]:g}",
            1.0 + series[worst],
            1.0,
            tolerance=CRITERION,
            source="the disc's meridian in elements of order 6, graded to its edge; uncertain by "
            f"{abs(rough / exact[-1] - 1.0):.1g}",
            reason="the remedy is to hold a stiffness within 1 % at every nu of the sweep",
            measure="stiffness",
            band=3.0 * abs(other - series[worst]),
        ),
        judge(
            f"disc, plain tetrahedra of 10 nodes, nu = {disc_nus[-1]:g}: locked, 1, or not, 0",
            float(disc_curves["10 nodes, curved"][-1] > CRITERION),
            1.0,
            tolerance=0.0,
            relative=False,
            source="what the sweep is to find",
            reason="yes or no",
            measure="identity",
        ),
        judge(
            f"disc, multigrid asked for at nu = {disc_nus[-1]:g}: a direct solver stepped in, 1, "
            "or not, 0",
            float(used.method in direct_solvers.PACKAGES),
            1.0,
            tolerance=0.0,
            relative=False,
            source="solvers.Solver: an iteration short of its tolerance is not handed on",
            reason="yes or no",
            measure="identity",
        ),
        judge(
            "disc: stiffness of that solution, relative to the direct one, less one",
            asked / direct_stiffness - 1.0,
            0.0,
            tolerance=1e-9,
            relative=False,
            source="the same matrix",
            reason="round-off of a factor: 1e-16 times a condition number of about 1e6, and margin",
            measure="identity",
            band=0.0,
        ),
    ]
    # What averaging costs where nothing locks: the same elements in a bent shaft.
    bent: dict[str, list[float]] = {}
    with run.step("bent shaft"):
        for across in (2, 4):
            shaft = bars.round_tetrahedra(SLENDERNESS * bars.SIDE, across)[10]
            for name, assembly in (("plain", plain), ("averaged", averaged)):
                if run.quick and (name, across) == ("plain", 4):
                    continue
                bent[f"{name}, {across} across"] = [
                    bars.bend(shaft, assembly, nu).excess for nu in disc_nus
                ]
    at = int(np.abs(bent["averaged, 4 across"]).argmax())
    default = "10 nodes, curved"
    worst_of = {
        name: np.maximum(np.abs(disc_curves[of]), np.abs(bent[f"{name}, 2 across"]))
        for name, of in (("plain", default), ("averaged", f"{default}, averaged"))
    }
    switched = np.array(disc_nus) >= incompressible.AVERAGED_FROM
    verdicts += [
        judge(
            "bent shaft, curved tetrahedra of 10 nodes, averaged, 4 across: stiffness over E I "
            f"where it is worst, nu = {disc_nus[at]:g}",
            1.0 + bent["averaged, 4 across"][at],
            1.0,
            tolerance=CRITERION,
            source="E I of the mesh: a prism under end moments, Timoshenko and Goodier 1970, "
            "art 102",
            reason="the remedy is to hold a stiffness within 1 % at every nu of the sweep",
            measure="stiffness",
            band=abs(bent["averaged, 4 across"][at] - bent["averaged, 2 across"][at]),
        ),
        judge(
            f"where scenes are averaged, nu from {incompressible.AVERAGED_FROM:g} on: the worse "
            "error of disc and bent shaft, two elements across, is less than that of plain "
            "elements, 1, or not, 0",
            float((worst_of["averaged"] < worst_of["plain"])[switched].all()),
            1.0,
            tolerance=0.0,
            relative=False,
            source="the rule by which the program switches",
            reason="yes or no",
            measure="identity",
        ),
    ]
    counts = {name: [i.iterations for i in of] for name, of in iterated.items()}
    reached = {
        name: [i.energy_error <= TOLERANCE for i in found] for name, found in iterated.items()
    }

    def last_reached(name: str) -> float:
        """The last nu of the sweep up to which multigrid gets there."""
        bad = [k for k, good in enumerate(reached[name]) if not good]
        return disc_nus[bad[0] - 1] if bad else disc_nus[-1]

    grew = [disc_nus.index(nu) for nu in (0.49, 0.499)]
    for name, n in counts.items():
        many = [disc_moduli[k] for k in grew]
        verdicts.append(
            judge(
                f"disc, tetrahedra of {name}: power of bulk over shear modulus that multigrid's "
                "iterations grow with, nu from 0.49 to 0.499",
                float(np.log(n[grew[1]] / n[grew[0]]) / np.log(many[1] / many[0])),
                0.5,
                tolerance=0.25,
                relative=False,
                source="conjugate gradients take the root of the condition number, which a "
                "smoother of displacements leaves as lambda / mu",
                reason="half way to 0, of a method that does not feel lambda, and to 1, of one "
                "without conjugate gradients",
                measure="order",
                band=float(np.log1p(1.0 / n[grew[0]]) / np.log(many[1] / many[0])),
            )
        )
    safe_disc = last_within(disc_curves[default], disc_nus)
    limits: list[Limit] = []

    def limit(
        method: str,
        at: tuple[float, ...],
        values: list[float],
        program: str,
        remedy: str,
        parameter: str = BULK,
    ) -> None:
        """A bound from above, where the sweep has found one."""
        high, worst = last_within(values, at), max(values, key=abs)
        if abs(worst) > CRITERION and not np.isnan(high):
            limits.append(
                Limit(
                    method=method,
                    parameter=parameter,
                    high=high,
                    criterion=f"stiffness within {100 * CRITERION:g} %",
                    beyond=f"error up to {100 * worst:+,.0f} % at {at[-1]:.4g}",
                    program=program,
                    remedy=remedy,
                )
            )

    averaged_disc = float(np.abs(disc_curves[f"{default}, averaged"]).max())
    limit(
        f"tetrahedra of {default}, disc bonded to plates",
        disc_nus,
        disc_curves[default],
        f"a part with nu of {incompressible.AVERAGED_FROM:g} or more has its dilatation averaged, "
        "and a warning says so",
        f"dilatation averaged: within {100 * averaged_disc:.2g} %",
    )
    for family, found_of in curves.items():
        for name, values in found_of.items():
            remedy = found_of.get(f"{name}, averaged")
            limit(
                f"{family} of {name}, cylinder under pressure",
                nus,
                values,
                "incompressible.assemble refuses them; scenes are meshed in 10 nodes"
                if remedy is None
                else "averages when asked: solve_solid(assembly=incompressible.assemble)",
                "none inside an element: take more nodes"
                if remedy is None
                else f"dilatation averaged: within {100 * np.abs(remedy).max():.2g} %",
            )
    limit(
        f"averaged tetrahedra of {default}, disc bonded to plates, nu = {disc_nus[-1]:g}",
        per_thickness,
        by_size,
        "the warning asks for four elements through the thickness",
        f"smaller elements: {100 * by_size[0]:.2g} % at {per_thickness[0]:.2g}",
        "element size over the disc's thickness [-]",
    )
    limits.append(
        Limit(
            method="averaged dilatation, round-off",
            parameter="1/2 - nu [-]",
            low=nearest,
            criterion=f"stiffness settled within {DIGITS:g}",
            beyond="digits of the stiffness are lost without a word, "
            + (
                f"from {max(refused):g} on the matrix is singular"
                if refused
                else f"{max(map(abs, lost)):.0e} of it at {kept[-1]:g}"
            ),
            program=f"a material with nu above {HIGHEST_POISSON_RATIO:g} is refused",
            remedy=f"nu = {HIGHEST_POISSON_RATIO:g}, whose stiffness is that of 1/2 to "
            f"{abs(highest - settled):.0e}",
        )
    )
    bad = [k for k in (2, 4) if np.abs(bent[f"averaged, {k} across"]).max() > CRITERION]
    limits.append(
        Limit(
            method=f"averaged tetrahedra of {default}, bent shaft, nu from {disc_nus[0]:g} to "
            f"{disc_nus[-1]:g}",
            parameter="elements across the diameter [-]",
            low=4.0 if bad == [2] else None,
            criterion=f"stiffness within {100 * CRITERION:g} %",
            beyond=f"{-100 * min(bent['averaged, 2 across']):.2g} % too soft with 2",
            program="the warning asks for four elements through the thickness",
            remedy=f"4 across: {-100 * min(bent['averaged, 4 across']):.2g} %; plain elements "
            f"below nu = {incompressible.AVERAGED_FROM:g}",
        )
    )
    limits.append(
        Limit(
            method="multigrid, curved tetrahedra of 10 nodes",
            parameter=BULK,
            high=last_reached(default),
            criterion=f"an energy error of {TOLERANCE:g} in {MAX_ITERATIONS} iterations",
            beyond=f"stops short after {counts[default][-1]} iterations at nu = {disc_nus[-1]:g}; "
            "averaging the dilatation does not help",
            program=f"solves directly instead ({used.method}), and says so; auto takes "
            f"{automatic.method} at this size",
            remedy="a direct solver",
        )
    )

    def shown(of: dict[str, list[float]], x: list[float]) -> list[Any]:
        return [
            trace(
                name,
                x,
                100 * np.maximum(np.abs(values), 1e-8),
                mode="lines+markers",
                line={"dash": "dash"} if "averaged" in name or "modes" in name else {},
            )
            for name, values in of.items()
        ]

    def shaded(nu: float) -> tuple[float | None, float | None] | None:
        return None if np.isnan(nu) else (None, solids.bulk_over_shear(nu))

    iteration_traces = []
    for name in iterated:
        good = np.array(reached[name])
        x, taken_by = np.array(disc_moduli), np.array(counts[name])
        iteration_traces.append(trace(name, x[good], taken_by[good], mode="lines+markers"))
        iteration_traces.append(
            trace(
                f"{name}: stopped short",
                x[~good],
                taken_by[~good],
                True,
                marker={"symbol": "x", "size": 12},
            )
        )
    worst_plain = disc_curves[default][-1]
    best = max(abs(v) for *_, series in remedies for v in series)
    charts = [
        chart(
            f"Error of the cylinder's stiffness, {family}: solid lines plain, dashed ones remedied "
            "(shaded: where all plain ones are within 1 %)",
            shown(curves[family], moduli),
            AXIS,
            "error [%]",
            ("x", "y"),
            shaded(
                min(
                    last_within(values, nus)
                    for name, values in curves[family].items()
                    if not name.endswith(("averaged", "modes"))
                )
            ),
        )
        for family in curves
    ]
    return CASE.results(
        run,
        summary=[
            f"At nu = {disc_nus[-1]:g} the program's default element, the curved tetrahedron of "
            f"ten nodes, makes a bonded disc {100 * worst_plain:,.0f} % too stiff, and one of four "
            f"nodes {100 * disc_curves['4 nodes'][-1]:,.0f} %. With the dilatation averaged "
            f"in each element the worst error over all nu is {100 * averaged_disc:.2g} %, and that "
            f"of the cylinder {100 * best:.2g} % in every element of 8 nodes and more.",
            "Averaging mends the stiffness, not the matrix: multigrid takes "
            f"{counts[default][0]} iterations at nu = {disc_nus[0]:g} and stops short at "
            f"{disc_nus[-1]:g}, where a direct solver steps in.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Locking",
                items=[
                    *charts,
                    chart(
                        "Error of the bonded disc's stiffness, tetrahedra (shaded: plain ones of "
                        "10 nodes within 1 %)",
                        shown(disc_curves, disc_moduli),
                        AXIS,
                        "error [%]",
                        ("x", "y"),
                        shaded(safe_disc),
                    ),
                    Text(
                        text="A locked mesh has no displacement that keeps the volume of each of "
                        "its elements at every point, so its stiffness grows with lambda without "
                        "end. Straight tetrahedra of ten nodes have such displacements in the "
                        "cylinder, curved ones do not: the curved map spoils them. The disc, 2 "
                        "elements thick between plates, leaves them none. Averaged dilatations "
                        "leave them again, if the elements are small enough."
                    ),
                    Table(
                        caption=f"Bonded disc in averaged tetrahedra, nu = {disc_nus[-1]:g}",
                        columns=[
                            "element size over thickness",
                            "error of the stiffness [%]",
                        ],
                        rows=[
                            [size, 100 * error]
                            for size, error in zip(per_thickness, by_size, strict=True)
                        ],
                    ),
                ],
            ),
            Section(
                title="How near to 1/2",
                items=[
                    chart(
                        "Cylinder, averaged hexahedra of 27 nodes: how far the stiffness, over the "
                        f"exact one, is from its value at 1/2 - nu = {distances[0]:g} (shaded: "
                        "four digits)",
                        [
                            trace(
                                "averaged",
                                kept,
                                np.maximum(np.abs(lost), 1e-12),
                                mode="lines+markers",
                            ),
                            trace(
                                "found singular",
                                refused,
                                np.full(len(refused), 1.0),
                                True,
                                marker={"symbol": "x", "size": 12},
                            ),
                        ],
                        "1/2 - nu [-]",
                        "change of the stiffness, relative [-]",
                        ("x", "y"),
                        (nearest, None),
                    )
                ],
            ),
            Section(
                title="What averaging costs",
                items=[
                    chart(
                        "Error of a bent shaft's stiffness, tetrahedra of 10 nodes as the program "
                        "meshes: plain ones lock late, averaged ones are too soft, by one share at "
                        f"every nu (shaded: where scenes stay plain, nu below "
                        f"{incompressible.AVERAGED_FROM:g})",
                        shown(bent, disc_moduli),
                        AXIS,
                        "error [%]",
                        ("x", "y"),
                        (None, solids.bulk_over_shear(incompressible.AVERAGED_FROM)),
                    )
                ],
            ),
            Section(
                title="Stress",
                items=[
                    Table(
                        caption="Cylinder, two hexahedra of 27 nodes through the wall: largest "
                        "error of the radial stress at their middles, over the pressure",
                        columns=[
                            "nu",
                            "plain",
                            "averaged, lambda times the dilatation at the point",
                            "averaged, incompressible.stresses",
                        ],
                        rows=stress_rows,
                    )
                ],
            ),
            Section(
                title="Iterations",
                items=[
                    chart(
                        f"Multigrid on the disc, iterations to an energy error of {TOLERANCE:g} "
                        f"({discs[10].unknowns:,} unknowns; a direct solver takes none)",
                        iteration_traces,
                        AXIS,
                        "iterations",
                        ("x",),
                        shaded(last_reached(default)),
                    )
                ],
            ),
        ],
        limits=limits,
        figures={
            "nu": list(nus),
            "cylinder": curves,
            "disc_nu": list(disc_nus),
            "disc": disc_curves,
            "bent": bent,
            "iterations": counts,
            "reached": reached,
        },
    )


CASE = Case(
    name="stability/volumetric_locking",
    title="Volumetric locking: Poisson's ratio towards 1/2, elements and multigrid",
    source="Malkus and Hughes 1978, Comput. Methods Appl. Mech. Eng. 15, 63-81; Lame 1852",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
