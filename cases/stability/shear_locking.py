"""Bent bars and shafts: where linear elements lock, by theory and measured, and what holds."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import locking_bars as bars
from fe_drivetrain.cases.stability.bent_shafts import (
    ONE_PERCENT,
    OVER_DIAMETER,
    PURE,
    QUICK_ROUND_LENGTHS,
    ROUND_LENGTHS,
    ROUND_OFF,
    ROUND_OFF_REASON,
    SHAFT_SLENDERNESS,
    Assembly,
    Excesses,
    round_hexahedra,
    round_tetrahedra,
    shear_part,
)
from fe_drivetrain.cases.stability.locking_curves import CRITERION, WITHIN, error_chart, limit
from fe_drivetrain.common.arrays import rounded
from fe_drivetrain.comparison import last_within
from fe_drivetrain.elasticity.operator import elasticity, incompatible, incompressible
from fe_drivetrain.elasticity.solve import recovery_estimate
from fe_drivetrain.report import marked
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run

#: Lengths of elements over the depth of the square bar.
LENGTHS = (1 / 16, 1 / 8, 1 / 4, 1 / 2, 1.0, 2.0, 4.0, 8.0, 16.0)
QUICK_LENGTHS = (1 / 16, 1 / 8, 2.0, 16.0)
ACROSS = (1, 2, 4, 8)
QUICK_ACROSS = (1, 2)

#: Cubes across the square bar, by the elements' names.
CUBES = {
    "8 nodes": (1, 2, 4, 8, 12),
    "tetrahedra of 4 nodes": (1, 2, 4, 8, 16, 24),
    "8 nodes, averaged": (1, 2, 4, 8, 12),
    "tetrahedra of 10 nodes, averaged": (1, 2, 4, 6),
    "27 nodes": (1, 2, 4),
    "tetrahedra of 10 nodes": (1, 2, 4),
}
QUICK_CUBES = 8  # at most

#: Length over depth of the cantilever, and its elements along.
SLENDERNESS = (5, 10, 20, 50, 100, 200)
QUICK_SLENDERNESS = (5, 100, 200)
ALONG = 40

PLAIN, MODES, AVERAGED = elasticity.assemble, incompatible.assemble, incompressible.assemble
REMEDIES: dict[str, tuple[int, Assembly]] = {
    "8 nodes, incompatible modes": (8, MODES),
    "20 nodes": (20, PLAIN),
    "27 nodes": (27, PLAIN),
    "tetrahedra of 10 nodes": (10, PLAIN),
}
LINEAR = {"8 nodes": "8-node hexahedra", "tetrahedra of 4 nodes": "4-node tetrahedra"}
WORST = "cantilever, {}, 1 across: stiffness over the exact one where it is worst, L/D = {:g}"
TIPS = (
    f"Error of the tip stiffness over length by depth, {ALONG} elements along; dashed: remedies; "
    "shaded, if anywhere: 8 nodes, {} across, within 1 %"
)
OVER_DEPTH = "length of an element over the depth of a square bar [-]"
SECOND_ORDER = "elements of second order"


@dataclass(frozen=True)
class Square:
    """The square bar in pure bending.

    Attributes
    ----------
    lengths : sequence of float
        Of the elements, over the depth.
    linear : dict of dict of list
        Excesses over the lengths by nodes of linear elements (8, 4) and their number across.
    held : dict of list
        Of the remedies.
    theory : list of float
        Of single hexahedra of 8 nodes across.
    cubes, across : dict of list
        Excesses of cubes, and their numbers across.
    """

    lengths: Sequence[float]
    linear: dict[int, dict[int, list[float]]]
    held: Excesses
    theory: list[float]
    cubes: Excesses
    across: dict[str, list[int]]

    @property
    def most(self) -> int:
        """Largest number of linear elements across."""
        return max(self.linear[8])


@case(
    "Shear locking: linear elements in bent bars and shafts, L/D from 5 to 200",
    source="Timoshenko and Goodier 1970, Theory of Elasticity, art 21 and 102; Taylor, Beresford "
    "and Wilson 1976, Int. J. Numer. Meth. Eng. 10, 1211-1219",
)
def run(run: Run, page: Page) -> None:
    """Bend a bar, load a cantilever, bend shafts, all in longer and longer elements."""
    slenderness = QUICK_SLENDERNESS if run.quick else SLENDERNESS
    round_lengths = QUICK_ROUND_LENGTHS if run.quick else ROUND_LENGTHS
    square = square_bars(run)
    theory_error = check_theory(page, square)
    tip = cantilevers(run, page, square.most, slenderness)
    check_held(page, square.held)
    shafts = round_hexahedra(run, page, round_lengths)
    tetrahedra = round_tetrahedra(run, page)
    estimates = estimated(run, square.lengths)
    share = check_estimate(page, estimates)
    state_limits(page, square, tip, shafts, slenderness, round_lengths, share)
    left = shafts["8 nodes, incompatible modes, 8 round a turn"][-1]
    answer(page, square.most, tip, slenderness, left)
    page.say(
        "Hexahedra of 8 nodes shear where they should bend. More of them across do not help: it is "
        f"the length of an element that counts, by G A a^2 / 12, as theory has it to "
        f"{theory_error:.0e}. Tetrahedra of 4 nodes lock worse.",
    )
    show_square(page, square)
    show_others(page, square, tip, shafts, slenderness, round_lengths)
    show_tables(page, square, tetrahedra, estimates)
    page.image("The square bar, one brick across", run.sketch(bars.square(27, 1, 8, 1.0)))


def answer(page: Page, most: int, tip: Excesses, slenderness: Sequence[int], left: float) -> None:
    """State how stiff linear elements make a slender bar, and what elements hold."""
    longest = slenderness[-1]
    held = 100 * max(np.abs(tip[name]).max() for name in REMEDIES if "modes" not in name)
    linear = {name: 1 + tip[f"{name}, {most} across"][-1] for name in LINEAR}
    within = last_within(slenderness, tip[f"8 nodes, {most} across"], CRITERION)

    def where(name: str) -> int:
        return slenderness[int(np.abs(tip[name]).argmax())]

    figures = [
        *(
            page.value(
                f"stiffness over the true one, {kind}, L/D = {longest:g}",
                rounded([linear[name]], 3)[0],
                beside=1.0,
                by="exact",
            )
            for name, kind in LINEAR.items()
        ),
        *(
            page.judged(
                WORST.format(name, where(name)),
                f"worst stiffness over the true one, {kind}",
                "exact",
            )
            for name, kind in (("tetrahedra of 10 nodes", "10-node tetrahedra"),)
        ),
        page.value("worst error at any L/D, second-order elements [%]", held, at_most=1.0),
        page.value(
            "error of 8-node hexahedra with incompatible modes, round shaft [%]", 100 * left
        ),
    ]
    if within is not None:
        name = f"largest L/D within 1 %, 8-node hexahedra, {ALONG} along"
        figures.insert(1, page.value(name, within))
    page.answer(
        "Which elements may be used for the bending of a slender bar or shaft?",
        f"{ALONG} linear 8-node hexahedra along a bar of L/D\u00a0=\u00a0{longest:g} make it "
        f"{formatted(linear['8 nodes'], 3)} times too stiff; second-order elements are within "
        f"{formatted(held)}\u00a0% at every L/D.",
        figures,
        hero=TIPS.format(most),
        cautions=[
            "Incompatible modes help brick-shaped elements only: in a round shaft they are too "
            "stiff as well.",
            "Drivetrain files are meshed with curved 10-node tetrahedra, of second order.",
        ],
    )


def check_held(page: Page, held: Excesses) -> None:
    """Check that elements which contain the parabolas of pure bending have no error."""
    for name, values in held.items():
        page.vanishes(
            f"square bar, {name}, 1 across: stiffness over E I, less one, worst of all lengths",
            np.abs(values).max(),
            within=1e-6,
            why="bricks of these hold the parabolas of pure bending exactly; round-off of elements "
            "16 times as long as the bar is deep, and more of tetrahedra as flat as 1:16",
            source=PURE,
        )


def check_estimate(page: Page, estimates: Excesses) -> float:
    """Check the minimum of the estimated over the true error; return it."""
    share = min(min(values) for values in estimates.values())
    page.at_least(
        "error estimate of one mesh, hexahedra of 8 nodes in any length: estimated over true error "
        "by locking, least",
        share,
        1.0 / 3.0,
        why="the band of a result is three times the estimate: it would not contain the answer",
        source="error_estimate.recovery_estimate",
        measure="identity",
    )
    return share


def show_tables(page: Page, square: Square, tetrahedra: list[Record], estimates: Excesses) -> None:
    """Show tetrahedra as the program meshes, and the estimated over the true error."""
    page.table(
        f"Tetrahedra as the program meshes, L/D = {SHAFT_SLENDERNESS}; linear ones on the same "
        "corners. Against the circle's E I, linear ones lose by their flat sides a part of what "
        "they gain by locking",
        tetrahedra,
    )
    page.section("Does the program notice?")
    page.chart(
        "Error of the energy estimated from one mesh of 8-node hexahedra, over the true one: 1 is "
        "right, above a third the estimate's band contains the answer",
        [marked(name, square.lengths, values) for name, values in estimates.items()],
        OVER_DEPTH,
        "estimated over true error [-]",
        "x",
    )


def square_bars(run: Run) -> Square:
    """Bend the square bar in all elements."""
    lengths = QUICK_LENGTHS if run.quick else LENGTHS

    def swept(nodes: int, across: int, assembly: Assembly) -> list[float]:
        # all hexahedra have the same error, tetrahedra at the ends have not
        along = 6 if nodes in (4, 10) else 2
        return [
            bars.bend(bars.square(nodes, across, along, a * bars.SIDE), assembly).excess
            for a in lengths
        ]

    with run.step("square bar"):
        linear: dict[int, dict[int, list[float]]] = {}
        for nodes in (8, 4):
            run.report(f"square bar: {nodes} nodes")
            linear[nodes] = {
                n: swept(nodes, n, PLAIN) for n in (QUICK_ACROSS if run.quick else ACROSS)
            }
        held = {name: swept(nodes, 1, assembly) for name, (nodes, assembly) in REMEDIES.items()}
        cubes, across = {}, {}
        for name, numbers in CUBES.items():
            run.report(f"square bar: {name}, cubes")
            nodes = int("".join(c for c in name if c.isdigit()))
            assembly = AVERAGED if name.endswith("averaged") else PLAIN
            across[name] = [n for n in numbers if not run.quick or n <= QUICK_CUBES]
            cubes[name] = [
                bars.bend(bars.square(nodes, n, 2, bars.SIDE / n), assembly).excess
                for n in across[name]
            ]
    theory = [bars.locked_excess(a * bars.SIDE) for a in lengths]
    return Square(lengths, linear, held, theory, cubes, across)


def check_theory(page: Page, square: Square) -> float:
    """Linear hexahedra lock as theory has it; its error with one across."""
    error = float(
        np.abs((1.0 + np.array(square.linear[8][1])) / (1.0 + np.array(square.theory)) - 1.0).max()
    )
    page.vanishes(
        "square bar, single hexahedra of 8 nodes across: stiffness over that of the locking "
        "theory, less one, worst of all lengths",
        error,
        within=ROUND_OFF,
        why=ROUND_OFF_REASON,
        source="own derivation, locking_bars.locked_excess: parasitic shear G A a^2 / 12 and the "
        "parabolas that are missing in the section",
    )
    for n in list(square.linear[8])[1:]:
        page.vanishes(
            f"square bar, {n} hexahedra of 8 nodes across: stiffness that longer elements add, "
            "over G A a^2 / 12, less one, worst of all lengths",
            shear_part(square.linear[8][n], square.lengths, bars.square(8, n, 1, 1.0)),
            within=ROUND_OFF,
            why=ROUND_OFF_REASON,
            source="parasitic shear, whatever the number of elements across",
        )
    return error


def cantilevers(run: Run, page: Page, most: int, slenderness: Sequence[int]) -> Excesses:
    """Tip stiffness of ever longer bars with a fixed number of elements along."""
    tip: Excesses = {}

    def loaded(nodes: int, across: int, assembly: Assembly) -> list[float]:
        return [bars.tip_loaded(nodes, across, ALONG, s * bars.SIDE, assembly) for s in slenderness]

    with run.step("cantilever"):
        for nodes, name in ((8, "8 nodes"), (4, "tetrahedra of 4 nodes")):
            for n in (1, most):
                run.report(f"cantilever: {name}, {n} across")
                tip[f"{name}, {n} across"] = loaded(nodes, n, PLAIN)
        run.report("cantilever: remedies")
        for name, (nodes, assembly) in REMEDIES.items():
            tip[name] = loaded(nodes, 1, assembly)
            worst = int(np.abs(tip[name]).argmax())
            length = slenderness[worst] * bars.SIDE
            finer = bars.tip_loaded(nodes, 1, 2 * ALONG, length, assembly)
            page.equals(
                WORST.format(name, slenderness[worst]),
                1.0 + tip[name][worst],
                1.0,
                within=CRITERION,
                why=ONE_PERCENT,
                source="Timoshenko's beam, exact here: Timoshenko and Goodier 1970, art 21",
                measure="stiffness",
                band=2.0 * abs(finer - tip[name][worst]),
            )
    for name in (f"8 nodes, {most} across", f"tetrahedra of 4 nodes, {most} across"):
        page.equals(
            f"cantilever, {name}: power of L/D that the excess of the stiffness grows with, L/D "
            f"from {slenderness[-2]} to {slenderness[-1]}",
            np.log2(tip[name][-1] / tip[name][-2]),
            2.0,
            within=0.1,
            relative=False,
            why="what does not grow with the length is below a tenth of the excess there",
            source="parasitic shear grows with the square of the element's length",
            measure="order",
        )
    return tip


def estimated(run: Run, lengths: Sequence[float]) -> Excesses:
    """Error estimated from one mesh over the true one, of the energy, by elements across."""
    found: Excesses = {}
    with run.step("error estimate"):
        for n in (2, 4):
            found[f"{n} across"] = []
            for a in lengths:
                block = bars.square(8, n, 4, a * bars.SIDE)
                bent = bars.bend(block, PLAIN)
                guess = recovery_estimate(block.points, [(block.cells, bars.LAME)], bent.u)
                # both as shares of the energy of the solution
                true = bent.excess / (1.0 + bent.excess)
                found[f"{n} across"].append(guess.relative / true)
    return found


def state_limits(
    page: Page,
    square: Square,
    tip: Excesses,
    shafts: Excesses,
    slenderness: Sequence[int],
    round_lengths: Sequence[float],
    share: float,
) -> None:
    """Bounds where the sweeps have found any."""
    program = (
        "scenes are meshed in curved tetrahedra of 10 nodes only; of other meshes the error "
        f"estimate is at least {share:.2g} times the error by locking"
    )
    modes = f"incompatible modes, or {SECOND_ORDER}"
    for n in square.linear[8]:
        for nodes, kind, remedy in ((8, "hexahedra", modes), (4, "tetrahedra", SECOND_ORDER)):
            limit(
                page,
                f"{kind} of {nodes} nodes, {n} across",
                square.lengths,
                square.linear[nodes][n],
                program,
                remedy,
                OVER_DEPTH,
            )
    limit(
        page,
        f"hexahedra of 8 nodes, {square.most} across, cantilever",
        slenderness,
        tip[f"8 nodes, {square.most} across"],
        program,
        modes,
        f"length over depth, {ALONG} elements along [-]",
    )
    for name, values in shafts.items():
        of = f"hexahedra of {name}"
        limit(page, of, round_lengths, values, program, SECOND_ORDER, OVER_DIAMETER)
    limit_cubes(page, square, program)


def limit_cubes(page: Page, square: Square, program: str) -> None:
    """State how many cubes a bent bar needs across."""
    for name, values in square.cubes.items():
        low, worst = first_within(square.across[name], values), max(values, key=abs)
        if abs(worst) > CRITERION and low is not None:
            kind = "" if name.startswith("tetra") else "hexahedra of "
            page.limit(
                f"{kind}{name}, nu = {bars.NU:g}",
                "cubes across a bent square bar [-]",
                low=low,
                criterion=WITHIN,
                beyond=f"error up to {100 * worst:+.0f} % with fewer",
                program=f"averages from nu = {incompressible.AVERAGED_FROM:g} on only, and asks "
                "for four across"
                if name.endswith("averaged")
                else program,
                remedy=f"{SECOND_ORDER}, plain",
            )


def first_within(at: Sequence[float], values: Sequence[float]) -> float | None:
    """The first place of a sweep from which on the criterion holds; None: nowhere."""
    return last_within(at[::-1], values[::-1], CRITERION)


def shaded(at: Sequence[float], values: Sequence[float]) -> tuple[None, float] | None:
    """The safe range of a chart."""
    high = last_within(at, values, CRITERION)
    return None if high is None else (None, high)


def show_square(page: Page, square: Square) -> None:
    """Charts and data of the square bar."""
    lengths, most = square.lengths, square.most
    page.section("Square bar in pure bending")
    hexahedra = {"8 nodes, 1 across, theory": (lengths, square.theory)}
    hexahedra |= {f"8 nodes, {n} across": (lengths, v) for n, v in square.linear[8].items()}
    held = {name: (lengths, v) for name, v in square.held.items()}
    ten = "tetrahedra of 10 nodes"
    hexahedra |= {name: of for name, of in held.items() if name != ten}
    tetrahedra = {f"4 nodes, {n} across": (lengths, v) for n, v in square.linear[4].items()}
    tetrahedra["10 nodes, 1 across"] = held[ten]
    title = "Hexahedra: error of the bending stiffness; dashed, the remedies with one across "
    title += f"(shaded: 8 nodes, {most} across, within 1 %)"
    safe = shaded(lengths, square.linear[8][most])
    error_chart(page, title, OVER_DEPTH, hexahedra, lambda name: name in REMEDIES, safe)
    title = "Tetrahedra, six in each hexahedron: error of the bending stiffness; those of 4 nodes "
    safe = shaded(lengths, square.linear[4][most])
    title += "are within 1 % nowhere"
    error_chart(page, title, OVER_DEPTH, tetrahedra, lambda name: name.startswith("10"), safe)
    page.text(
        "Edges of linear elements stay straight, so a bent element shears, by its curvature times "
        "the distance from its middle. The energy of that grows with the square of its length and "
        "drowns the energy of bending."
    )
    title = "Cubes: error of the bending stiffness against their number across; averaged "
    title += "dilatations are no remedy here (shaded: 8 nodes within 1 %)"
    across = "cubes across, for tetrahedra of six each [-]"
    cubes = {name: (square.across[name], values) for name, values in square.cubes.items()}
    low = first_within(*cubes["8 nodes"])
    error_chart(page, title, across, cubes, lambda name: "averaged" in name, (low, None))
    page.data("lengths", lengths)
    page.data("linear", square.linear)
    page.data("theory", square.theory)
    page.data("remedies", square.held)
    page.data("cubes", square.cubes)


def show_others(
    page: Page,
    square: Square,
    tip: Excesses,
    shafts: Excesses,
    slenderness: Sequence[int],
    round_lengths: Sequence[float],
) -> None:
    """Charts and data of cantilever and round shafts."""
    page.section("Cantilever")
    loaded = {name: (slenderness, values) for name, values in tip.items()}
    safe = shaded(*loaded[f"8 nodes, {square.most} across"])
    title, x = TIPS.format(square.most), "length over depth [-]"
    error_chart(page, title, x, loaded, lambda name: name in REMEDIES, safe)
    page.section("Round shafts in pure bending")
    title = "Hexahedra: error of the bending stiffness against E I of the mesh (shaded: "
    title += "incompatible modes, 16 round a turn, within 1 %)"
    by_length = {name: (round_lengths, values) for name, values in shafts.items()}
    safe = shaded(*by_length["8 nodes, incompatible modes, 16 round a turn"])
    error_chart(page, title, OVER_DIAMETER, by_length, lambda name: not name.startswith("8"), safe)
    page.data("slenderness", slenderness)
    page.data("cantilever", tip)
    page.data("round_lengths", round_lengths)
    page.data("round", shafts)
