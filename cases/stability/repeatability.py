"""Two runs, bit for bit: with one thread, with two, and with the nodes in another order."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: Lengths over diameters of the tubes that other processes solve.
LENGTHS = (5.0, 200.0)
QUICK_LENGTHS = (5.0,)


def run(run: Run) -> Any:
    """Start processes that do the same, and compare what they wrote."""
    import tempfile
    from pathlib import Path

    import numpy as np

    from fe_drivetrain.cases.stability import (
        fingerprints,
    )
    from fe_drivetrain.cases.stability.decades import (
        FOUR_DIGITS,
        safe_range,
        shown,
        slope,
    )
    from fe_drivetrain.report import Limit, Section, Table, Text, chart, judge, trace

    lengths = QUICK_LENGTHS if run.quick else LENGTHS
    runs: dict[str, Any] = {}
    planned = {"one thread": 1, "one thread, again": 1}
    if not run.quick:
        planned |= {"two threads": 2, "two threads, again": 2}
    with tempfile.TemporaryDirectory() as folder:
        for name, threads in planned.items():
            with run.step(f"a process with {name}"):
                file = Path(folder) / f"{len(runs)}.npz"
                runs[name] = fingerprints.elsewhere(file, lengths, threads)
    pairs = [("one thread", "one thread, again")]
    if not run.quick:
        pairs += [("two threads", "two threads, again"), ("one thread", "two threads")]

    slenderness = (
        [2.0, 20.0, 200.0, 2000.0] if run.quick else [2.0, 5, 10, 20, 50, 100, 200, 500, 1000, 2000]
    )
    with run.step("nodes in another order"):
        one = fingerprints.tube_answers(slenderness)
        other = fingerprints.tube_answers(slenderness, backwards=True)
    methods = fingerprints.methods()
    reordered = {
        method: np.array(
            [
                abs(float((one[key] / other[key])[0]) - 1.0)
                for key in (f"{fingerprints.STIFFNESS}, {method} at {x:g}" for x in slenderness)
            ]
        )
        for method in methods
    }
    direct = [m for m in methods if m != "multigrid"]
    logs = np.array([np.log10(np.maximum(reordered[m], 1e-17)) for m in direct])
    typical = 10.0 ** logs.mean(axis=0)
    worst = np.max([reordered[m] for m in direct], axis=0)
    _, high = safe_range(slenderness, worst, FOUR_DIGITS)

    # of each part: which pairs of runs differ, and by how much of the stiffness
    parts = ["mesh", "operator", *methods]
    rows: list[list[Any]] = []
    largest: dict[tuple[str, str, str], float] = {}
    counts: dict[tuple[str, str, str], int] = {}
    for part in parts:
        row: list[Any] = [part]
        for a, b in pairs:
            names = [n for n in runs[a] if n == part or n.startswith(f"{part} at")]
            solved = [n for n in names if not np.isnan(runs[a][n]).any()]
            changed = fingerprints.different(
                {n: runs[a][n] for n in solved}, {n: runs[b][n] for n in solved}
            )
            shifts = [
                abs(float((runs[a][k] / runs[b][k])[0]) - 1.0)
                for k in (f"{fingerprints.STIFFNESS}, {n}" for n in changed)
                if k in runs[a]
            ]
            largest[part, a, b] = max(shifts, default=0.0)
            counts[part, a, b] = len(changed)
            if not changed:
                row.append(f"same bits ({len(solved)} of {len(names)} answered)")
            else:
                row.append(
                    f"{len(changed)} of {len(solved)} differ"
                    + (f", stiffness by {max(shifts):.0e}" if any(shifts) else "")
                )
        rows.append(row)
    one_thread = fingerprints.different(runs["one thread"], runs["one thread, again"])
    verdicts = [
        judge(
            f"two runs with one thread, {len(runs['one thread'])} arrays from mesh to stiffness: "
            "how many differ in any bit",
            float(len(one_thread)),
            0.0,
            tolerance=0.0,
            relative=False,
            source="the same operations in the same order",
            reason="bit for bit",
            measure="identity",
        ),
        judge(
            "nodes in another order: difference of the stiffness against L/D, exponent",
            slope(slenderness, typical, (1e-15, 0.1)),
            4.0,
            tolerance=0.3 if run.quick else 0.15,
            source="round-off over the energy of bending, as in stability/precision",
            reason="round-off scatters by about a decade over the decades of the fit",
            measure="order",
            band=0.3,
        ),
    ]
    if not run.quick:
        verdicts += [
            judge(
                "one thread against two: largest difference of a stiffness",
                max(largest[part, "one thread", "two threads"] for part in methods),
                0.0,
                tolerance=FOUR_DIGITS,
                relative=False,
                source="the same operations in another order",
                reason="four digits of stiffness, at lengths where another order of the nodes "
                "leaves as many",
                measure="identity",
            ),
            *(
                judge(
                    f"{part}: one thread against two, arrays with differing bits",
                    float(counts[part, "one thread", "two threads"]),
                    0.0,
                    tolerance=0.0,
                    relative=False,
                    source="each sum is one thread's, in one order",
                    reason="bit for bit",
                    measure="identity",
                )
                for part in ("mesh", "operator")
            ),
        ]
    changing = [part for part in parts for a, b in pairs[1:] if counts.get((part, a, b), 0) > 0]
    told = ", ".join(dict.fromkeys(changing)) or "none"
    same = ", ".join(part for part in parts if part not in changing)
    limits = [
        Limit(
            method="the last bits of a stiffness: any change of order (threads, node numbers)",
            parameter="L/D of a tube",
            high=high,
            criterion="two orders of the same operations agree to 1e-4",
            beyond="round-off in another order is another answer; it grows as (L/D)^4",
            program="with one thread repeats every bit; refuses a residual above 1e-2",
            remedy="one thread (FE_DRIVETRAIN_CORES=1) for the bits; beam or meridian for the "
            "digits",
        )
    ]
    at = np.array(slenderness)
    repeated = max(largest[part, *pairs[0]] for part in methods)
    return CASE.results(
        run,
        summary=[
            f"Two runs with one thread agree in every bit of {len(runs['one thread'])} arrays, "
            f"from mesh to stiffness: {len(one_thread)} differ.",
            (
                f"With two threads these change in their last bits: {told}; these do not: {same}."
                if not run.quick
                else "Two threads are not tried in a quick run."
            ),
            "What another order of the operations changes grows as the fourth power of L/D: "
            f"stiffnesses agree to four digits up to L/D = {shown(high)}.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Runs",
                items=[
                    Table(
                        caption="What differs between two processes: mesh and stiffness matrix of "
                        "a main bearing, and displacements of tubes of L/D = "
                        + ", ".join(f"{x:g}" for x in lengths),
                        columns=["part", *(f"{a} / {b}" for a, b in pairs)],
                        rows=rows,
                    ),
                    Text(
                        text="Each process meshes, assembles and solves anew, without the cache. "
                        "An answer that a solver does not give (multigrid on slender tubes) is not "
                        "compared."
                    ),
                ],
            ),
            Section(
                title="Another order",
                items=[
                    chart(
                        "Difference of the bending stiffness of a tube between nodes numbered from "
                        "the front and from the rear, and between one thread and two. Shaded: four "
                        "digits. Curves end where a solver refuses",
                        [
                            *(
                                trace(
                                    f"renumbered, {method}",
                                    at[np.isfinite(values)],
                                    np.maximum(values[np.isfinite(values)], 1e-17),
                                    mode="lines+markers",
                                )
                                for method, values in reordered.items()
                            ),
                            *(
                                trace(
                                    f"{a} against {b}, {method}",
                                    *_changes(runs, a, b, method, lengths),
                                    True,
                                )
                                for a, b in pairs[2:]
                                for method in methods
                                if largest[method, a, b] > 0.0
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
                        ("x", "y"),
                        (None, high),
                    )
                ],
            ),
        ],
        limits=limits,
        figures={
            "slenderness": slenderness,
            "renumbered": {
                m: [float(v) if np.isfinite(v) else None for v in values]
                for m, values in reordered.items()
            },
        },
    )


def _changes(runs: Any, a: str, b: str, method: str, lengths: Any) -> tuple[Any, Any]:
    """L/D and difference of the stiffness, where there is one."""
    found = []
    for x in lengths:
        key = f"stiffness, {method} at {x:g}"
        change = abs(float((runs[a][key] / runs[b][key])[0]) - 1.0)
        if change > 0.0:
            found.append((x, change))
    return [x for x, _ in found], [change for _, change in found]


CASE = Case(
    name="stability/repeatability",
    title="Repeatability: two runs bit for bit, with one thread and with two",
    source="IEEE 754: sums depend on their order; Higham 2002, ch. 4",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
