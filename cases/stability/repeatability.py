"""Two runs, bit for bit: with one thread, with two, and with the nodes in another order."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.stability.fingerprints import (
    STIFFNESS,
    Arrays,
    different,
    elsewhere,
    methods,
    tube_answers,
)
from fe_drivetrain.common import Floats, scratch_folder
from fe_drivetrain.comparison import FOUR_DIGITS, safe_range
from fe_drivetrain.report import marked, trace
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run

#: Lengths over diameters of the tubes that other processes solve.
LENGTHS = (5.0, 200.0)
QUICK_LENGTHS = (5.0,)

#: The runs that are to agree in every bit.
FIRST = "one thread / one thread, again"

SLOPE = "nodes in another order: difference of the stiffness against L/D, exponent"
CHANGES = (
    "Change of a tube's bending stiffness by another order of nodes or threads, over its "
    "slenderness; shaded: four digits; curves end where a solver refuses"
)

#: Lengths over diameters of the tubes whose nodes are numbered in two ways.
SLENDERNESS = (2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0)
QUICK_SLENDERNESS = (2.0, 20.0, 200.0, 2000.0)


def shift(a: Arrays, b: Arrays, name: str) -> float:
    """Relative difference of a stiffness in two runs; NaN where there is none."""
    stiffness = f"{STIFFNESS}, {name}"
    return abs(float((a[stiffness] / b[stiffness])[0]) - 1.0)


def compare(runs: Mapping[str, Arrays], a: str, b: str, part: str) -> Record:
    """What differs of one part between two runs: mesh, operator, or a solver's answers."""
    names = [n for n in runs[a] if n == part or n.startswith(f"{part} at")]
    solved = [n for n in names if not np.isnan(runs[a][n]).any()]
    changed = different({n: runs[a][n] for n in solved}, {n: runs[b][n] for n in solved})
    shifts = {
        float(n.rpartition(" ")[2]): shift(runs[a], runs[b], n)
        for n in changed
        if f"{STIFFNESS}, {n}" in runs[a]
    }
    return {
        "part": part,
        "runs": f"{a} / {b}",
        "arrays": len(names),
        "answered": len(solved),
        "differ in any bit": len(changed),
        "stiffness by, at most": max(shifts.values(), default=0.0),
        "shifts": shifts,
    }


def renumbered(slenderness: tuple[float, ...]) -> dict[str, Floats]:
    """Differences of the stiffness by each solver, the nodes in two orders."""
    one, other = tube_answers(slenderness), tube_answers(slenderness, backwards=True)
    return {
        method: np.array([shift(one, other, f"{method} at {x:g}") for x in slenderness])
        for method in methods()
    }


@dataclass(frozen=True)
class Renumbered:
    """Change of the stiffness of a tube with its nodes in another order.

    Attributes
    ----------
    slenderness : tuple of float
        L/D.
    by_method : dict of array
        Relative change by each solver, NaN where it refuses.
    """

    slenderness: tuple[float, ...]
    by_method: dict[str, Floats]

    @property
    def direct(self) -> list[Floats]:
        """Changes by the direct solvers."""
        return [values for method, values in self.by_method.items() if method != "multigrid"]

    @property
    def typical(self) -> Floats:
        """Geometric mean of the direct solvers."""
        return np.asarray(10.0 ** np.log10(np.maximum(self.direct, 1e-17)).mean(axis=0))

    @property
    def safe(self) -> float | None:
        """L/D up to which all direct solvers keep four digits."""
        return safe_range(self.slenderness, np.max(self.direct, axis=0), FOUR_DIGITS)[1]


@case(
    "Repeatability: two runs bit for bit, with one thread and with two",
    source="IEEE 754: sums depend on their order; Higham 2002, ch. 4",
)
def run(run: Run, page: Page) -> None:
    """Start processes that do the same, and compare what they wrote."""
    lengths = QUICK_LENGTHS if run.quick else LENGTHS
    planned = {"one thread": 1, "one thread, again": 1}
    pairs = [("one thread", "one thread, again")]
    if not run.quick:
        planned |= {"two threads": 2, "two threads, again": 2}
        pairs += [("two threads", "two threads, again"), ("one thread", "two threads")]
    runs: dict[str, Arrays] = {}
    with scratch_folder() as folder:
        for name, threads in planned.items():
            with run.step(f"a process with {name}"):
                runs[name] = elsewhere(folder / f"{len(runs)}.npz", lengths, threads)
    slenderness = QUICK_SLENDERNESS if run.quick else SLENDERNESS
    with run.step("nodes in another order"):
        reordered = Renumbered(slenderness, renumbered(slenderness))
    parts = ["mesh", "operator", *reordered.by_method]
    rows = [compare(runs, a, b, part) for part in parts for a, b in pairs]
    changed = check(page, runs, rows, reordered, run.quick)
    high = reordered.safe
    page.limit(
        "the last bits of a stiffness: any change of order (threads, node numbers)",
        "L/D of a tube",
        high=high,
        criterion="two orders of the same operations agree to 1e-4",
        beyond="round-off in another order is another answer; it grows as (L/D)^4",
        program="with one thread repeats every bit; refuses a residual above 1e-2",
        remedy="one thread (FE_DRIVETRAIN_CORES=1) for the bits; beam or meridian for the digits",
    )
    changing = dict.fromkeys(
        r["part"] for r in rows if r["runs"] != FIRST and r["differ in any bit"]
    )
    answer(page, len(runs["one thread"]), changed, reordered)
    page.say(
        "Two threads are not tried in a quick run."
        if run.quick
        else f"With two threads these change in their last bits: {', '.join(changing) or 'none'}; "
        f"these do not: {', '.join(part for part in parts if part not in changing)}.",
        "What another order of the operations changes grows as the fourth power of L/D.",
    )
    show(page, rows, lengths, reordered)


def answer(page: Page, arrays: int, changed: int, reordered: Renumbered) -> None:
    """State whether a run repeats bit for bit, and what another order of operations leaves."""
    high, at = reordered.safe, reordered.slenderness
    worst = np.max(reordered.direct, axis=0)
    figures = [
        page.value(f"arrays that differ in any bit, one thread, of {arrays}", changed, at_most=0.0),
        page.judged(SLOPE, "exponent of L/D in the change by renumbering", "theory"),
        page.value(f"relative change of a stiffness by renumbering, L/D = {at[0]:g}", worst[0]),
        page.value(
            "relative change of a stiffness by renumbering, L/D = 200", worst[at.index(200.0)]
        ),
    ]
    if high is not None:
        name = "largest L/D with four digits the same after renumbering"
        figures.insert(1, page.value(name, high))
    page.answer(
        "Does a run repeat bit for bit, and what does another numbering of the nodes change?",
        (
            f"Two runs with one thread agree in every bit of {arrays} arrays; "
            if changed == 0
            else f"Two runs with one thread differ in {changed} of {arrays} arrays; "
        )
        + "after renumbering nodes a stiffness agrees to four digits up to "
        + f"L/D\u00a0=\u00a0{formatted(at[-1] if high is None else high)}.",
        figures,
        hero=CHANGES,
        cautions=[
            "Bits repeat on the same machine with the same libraries; another machine may differ.",
            "L/D is length over diameter of a tube, whose bending stiffness is compared.",
        ],
    )


def check(
    page: Page, runs: Mapping[str, Arrays], rows: list[Record], reordered: Renumbered, quick: bool
) -> int:
    """Check bits and digits of all runs; return how many arrays differ with one thread."""
    one_thread = different(runs["one thread"], runs["one thread, again"])
    page.vanishes(
        f"two runs with one thread, {len(runs['one thread'])} arrays from mesh to stiffness: how "
        "many differ in any bit",
        len(one_thread),
        within=0.0,
        why="the same operations in the same order round in the same way: bit for bit",
        source="IEEE 754",
    )
    page.exponent(
        SLOPE,
        reordered.slenderness,
        reordered.typical,
        4.0,
        within=0.3 if quick else 0.15,
        between=(1e-15, 0.1),
        why="round-off scatters by about a decade from point to point: by as much at either end of "
        "the two and a half decades of the fit it changes a slope by 0.8, a fifth of it; 15 % of "
        "the mean of several solvers, and twice that of the three points of a quick run",
        source="round-off over the energy of bending, as in stability/precision",
    )
    if not quick:
        between = {r["part"]: r for r in rows if r["runs"] == "one thread / two threads"}
        page.at_most(
            "one thread against two: largest difference of a stiffness",
            max(between[part]["stiffness by, at most"] for part in reordered.by_method),
            FOUR_DIGITS,
            why="four digits of stiffness, at lengths where another order of the nodes leaves as "
            "many",
            source="the same operations in another order",
            measure="identity",
        )
        for part in ("mesh", "operator"):
            page.vanishes(
                f"{part}: one thread against two, arrays with differing bits",
                between[part]["differ in any bit"],
                within=0.0,
                why="no sum is divided among threads: the order of its terms is the same",
                source="each sum is one thread's, in one order",
            )
    return len(one_thread)


def show(page: Page, rows: list[Record], lengths: tuple[float, ...], reordered: Renumbered) -> None:
    """Show what differs between runs, and the differences over slenderness."""
    slenderness = reordered.slenderness
    page.section("Runs")
    page.table(
        "What differs between two processes: mesh and stiffness matrix of a main bearing, and "
        f"displacements of tubes of L/D = {', '.join(f'{x:g}' for x in lengths)}",
        rows,
        [name for name in rows[0] if name != "shifts"],
    )
    page.text(
        "Each process meshes, assembles and solves again, without the cache. An answer that a "
        "solver does not give (multigrid on slender tubes) is not compared."
    )
    at = np.array(slenderness)
    repeated = max(r["stiffness by, at most"] for r in rows if r["runs"] == FIRST)
    page.section("Nodes in another order")
    page.chart(
        CHANGES,
        [
            *(
                marked(
                    f"renumbered, {method}",
                    at[np.isfinite(values)],
                    np.maximum(values[np.isfinite(values)], 1e-17),
                )
                for method, values in reordered.by_method.items()
            ),
            *(
                trace(
                    f"one thread against two threads, {r['part']}",
                    [x for x, change in r["shifts"].items() if change > 0.0],
                    [change for change in r["shifts"].values() if change > 0.0],
                    True,
                )
                for r in rows
                if r["runs"] == "one thread / two threads" and r["stiffness by, at most"] > 0.0
            ),
            trace(
                "two runs, one thread",
                at,
                np.full(len(at), max(repeated, 1e-17)),
                line={"dash": "dash"},
            ),
        ],
        "L/D",
        "relative difference",
        "xy",
        (None, reordered.safe),
    )
    page.data("slenderness", slenderness)
    page.data("renumbered", reordered.by_method)
