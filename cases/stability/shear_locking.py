"""Bent bars and shafts: where linear elements lock, by theory and measured, and what holds."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

CRITERION = 0.01  # error of a stiffness

#: Lengths of elements over the depth of the square bar, and over the diameter of the round one.
LENGTHS = (1 / 16, 1 / 8, 1 / 4, 1 / 2, 1.0, 2.0, 4.0, 8.0, 16.0)
QUICK_LENGTHS = (1 / 16, 1 / 8, 2.0, 16.0)
#: (From a quarter on, all of them have one section: shorter ones are divided more finely across.)
ROUND_LENGTHS = (1 / 4, 1 / 2, 1.0, 2.0, 4.0)
QUICK_ROUND_LENGTHS = (1 / 4, 4.0)

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

#: Shafts in the program's own tetrahedra: length over diameter, elements across.
SHAFT_SLENDERNESS = 5
SHAFT_ACROSS = (2, 4)
QUICK_SHAFT_ACROSS = (2,)

ROUND_OFF = 1e-8
ROUND_OFF_REASON = (
    "exact but for round-off: 1e-16 times the condition number, about 1e8 of elements 16 times as "
    "long as the bar is deep"
)


def run(run: Run) -> Any:
    """Bend a bar, load a cantilever, bend shafts, all in longer and longer elements."""
    import numpy as np

    from fe_drivetrain.operator import elasticity, incompatible, incompressible
    from fe_drivetrain.report import Cell, Limit, Section, Table, Text, chart, judge, trace
    from fe_drivetrain.solve import recovery_estimate
    from fe_drivetrain.validation import (
        locking_bars as bars,
    )

    plain, modes, averaged = elasticity.assemble, incompatible.assemble, incompressible.assemble
    lengths = QUICK_LENGTHS if run.quick else LENGTHS
    round_lengths = QUICK_ROUND_LENGTHS if run.quick else ROUND_LENGTHS
    acrosses = QUICK_ACROSS if run.quick else ACROSS
    slenderness = QUICK_SLENDERNESS if run.quick else SLENDERNESS
    most = acrosses[-1]
    remedies: dict[str, tuple[int, Any]] = {
        "8 nodes, incompatible modes": (8, modes),
        "20 nodes": (20, plain),
        "27 nodes": (27, plain),
        "tetrahedra of 10 nodes": (10, plain),
    }
    pure = "E I: a prism under end moments, Timoshenko and Goodier 1970, art 102"

    def squared(nodes: int, across: int, assembly: Any) -> list[float]:
        # hexahedra are all alike, tetrahedra at the ends are not
        along = 6 if nodes in (4, 10) else 2
        return [
            bars.bend(bars.square(nodes, across, along, a * bars.SIDE), assembly).excess
            for a in lengths
        ]

    verdicts = []
    with run.step("square bar"):
        linear: dict[int, dict[int, list[float]]] = {}
        for nodes in (8, 4):
            run.report(f"square bar: {nodes} nodes")
            linear[nodes] = {n: squared(nodes, n, plain) for n in acrosses}
        held = {name: squared(nodes, 1, assembly) for name, (nodes, assembly) in remedies.items()}
        cubes: dict[str, list[float]] = {}
        cubes_across: dict[str, list[int]] = {}
        for name, series in CUBES.items():
            run.report(f"square bar: {name}, cubes")
            nodes = int("".join(c for c in name if c.isdigit()))
            assembly = averaged if name.endswith("averaged") else plain
            cubes_across[name] = [n for n in series if not run.quick or n <= QUICK_CUBES]
            cubes[name] = [
                bars.bend(bars.square(nodes, n, 2, bars.SIDE / n), assembly).excess
                for n in cubes_across[name]
            ]
    theory = [bars.locked_excess(a * bars.SIDE) for a in lengths]
    verdicts.append(
        judge(
            "square bar, single hexahedra of 8 nodes across: stiffness over that of the locking "
            "theory, less one, worst of all lengths",
            float(np.abs((1.0 + np.array(linear[8][1])) / (1.0 + np.array(theory)) - 1.0).max()),
            0.0,
            tolerance=ROUND_OFF,
            relative=False,
            source="own derivation, locking_bars.locked_excess: parasitic shear G A a^2 / 12 and "
            "the parabolas that are missing in the section",
            reason=ROUND_OFF_REASON,
            measure="identity",
            band=0.0,
        )
    )

    def shear_part(excess: list[float], at: tuple[float, ...], of: Any) -> float:
        """What more length adds, over what the theory adds, less one; the worst."""
        section = bars.area(of), bars.second_moment(of)
        expected = np.array([bars.shear_excess(a * bars.SIDE, *section) for a in at])
        found = np.array(excess)
        return float(np.abs((found - found[0])[1:] / (expected - expected[0])[1:] - 1.0).max())

    for n in acrosses[1:]:
        verdicts.append(
            judge(
                f"square bar, {n} hexahedra of 8 nodes across: stiffness that longer elements add, "
                "over G A a^2 / 12, less one, worst of all lengths",
                shear_part(linear[8][n], lengths, bars.square(8, n, 1, 1.0)),
                0.0,
                tolerance=ROUND_OFF,
                relative=False,
                source="parasitic shear, whatever the number of elements across",
                reason=ROUND_OFF_REASON,
                measure="identity",
                band=0.0,
            )
        )

    with run.step("cantilever"):
        tip: dict[str, list[float]] = {}
        for nodes, name in ((8, "8 nodes"), (4, "tetrahedra of 4 nodes")):
            for n in (1, most):
                run.report(f"cantilever: {name}, {n} across")
                tip[f"{name}, {n} across"] = [
                    bars.tip_loaded(nodes, n, ALONG, s * bars.SIDE, plain) for s in slenderness
                ]
        run.report("cantilever: remedies")
        for name, (nodes, assembly) in remedies.items():
            tip[name] = [
                bars.tip_loaded(nodes, 1, ALONG, s * bars.SIDE, assembly) for s in slenderness
            ]
            worst = int(np.abs(tip[name]).argmax())
            finer = bars.tip_loaded(nodes, 1, 2 * ALONG, slenderness[worst] * bars.SIDE, assembly)
            verdicts.append(
                judge(
                    f"cantilever, {name}, 1 across: stiffness over the exact one where it is "
                    f"worst, L/D = {slenderness[worst]:g}",
                    1.0 + tip[name][worst],
                    1.0,
                    tolerance=CRITERION,
                    source="Timoshenko's beam, exact here: Timoshenko and Goodier 1970, art 21",
                    reason="the remedy is to hold a stiffness within 1 %",
                    measure="stiffness",
                    band=2.0 * abs(finer - tip[name][worst]),
                )
            )
    for name in (f"8 nodes, {most} across", f"tetrahedra of 4 nodes, {most} across"):
        verdicts.append(
            judge(
                f"cantilever, {name}: power of L/D that the excess of the stiffness grows with, "
                f"L/D from {slenderness[-2]} to {slenderness[-1]}",
                float(np.log2(tip[name][-1] / tip[name][-2])),
                2.0,
                tolerance=0.1,
                relative=False,
                source="parasitic shear grows with the square of the element's length",
                reason="what does not grow with the length is below a tenth of the excess there",
                measure="order",
                band=0.0,
            )
        )
    for name, values in held.items():
        verdicts.append(
            judge(
                f"square bar, {name}, 1 across: stiffness over E I, less one, worst of all lengths",
                float(np.abs(values).max()),
                0.0,
                tolerance=1e-6,
                relative=False,
                source=pure,
                reason="bricks of these hold the parabolas of pure bending exactly; round-off as "
                "above, and more of tetrahedra as flat as 1:16",
                measure="identity",
                band=0.0,
            )
        )

    with run.step("shafts of hexahedra"):
        shafts: dict[str, list[float]] = {}
        for name, nodes, refinement, assembly in (
            ("8 nodes, 8 round a turn", 8, 1, plain),
            ("8 nodes, 16 round a turn", 8, 2, plain),
            ("8 nodes, incompatible modes, 8 round a turn", 8, 1, modes),
            ("8 nodes, incompatible modes, 16 round a turn", 8, 2, modes),
            ("20 nodes, 8 round a turn", 20, 1, plain),
            ("27 nodes, 8 round a turn", 27, 1, plain),
        ):
            run.report(f"shafts of hexahedra: {name}")
            meshes = [
                bars.round_hexahedra(nodes, refinement, 2, a * bars.SIDE) for a in round_lengths
            ]
            shafts[name] = [bars.bend(mesh, assembly).excess for mesh in meshes]
            if nodes == 8 and assembly is plain:
                verdicts.append(
                    judge(
                        f"round shaft, hexahedra of {name}: stiffness that longer elements add, "
                        "over G A a^2 / 12, less one, worst of all lengths",
                        shear_part(shafts[name], round_lengths, meshes[0]),
                        0.0,
                        tolerance=ROUND_OFF,
                        relative=False,
                        source="parasitic shear of a prism of any section; A and I of the mesh",
                        reason=ROUND_OFF_REASON,
                        measure="identity",
                        band=0.0,
                    )
                )
            if nodes > 8:
                finer_mesh = bars.round_hexahedra(nodes, 2, 2, round_lengths[-1] * bars.SIDE)
                finer = bars.bend(finer_mesh, assembly).excess
                verdicts.append(
                    judge(
                        f"round shaft, hexahedra of {name}, {round_lengths[-1]:g} diameters long: "
                        "stiffness over E I",
                        1.0 + shafts[name][-1],
                        1.0,
                        tolerance=CRITERION,
                        source=pure,
                        reason="the remedy is to hold a stiffness within 1 %",
                        measure="stiffness",
                        band=2.0 * abs(finer - shafts[name][-1]),
                    )
                )
    with run.step("shafts of tetrahedra"):
        tetrahedra: dict[int, list[float]] = {4: [], 10: []}
        rows: list[list[Cell]] = []
        for n in QUICK_SHAFT_ACROSS if run.quick else SHAFT_ACROSS:
            run.report(f"shafts of tetrahedra: {n} across")
            length = SHAFT_SLENDERNESS * bars.SIDE
            for nodes, mesh in bars.round_tetrahedra(length, n).items():
                bent = bars.bend(mesh, plain)
                tetrahedra[nodes].append(bent.excess)
                true = bent.rigidity / (bars.E * np.pi / 64.0 * bars.SIDE**4) - 1.0
                rows.append([nodes, n, mesh.unknowns, 100 * bent.excess, 100 * true])
                if nodes == 10:
                    estimate = recovery_estimate(mesh.points, [(mesh.cells, bars.LAME)], bent.u)
                    band = estimate.band(1.0)
    verdicts.append(
        judge(
            "round shaft, curved tetrahedra of 10 nodes: stiffness over E I, the coarsest mesh",
            1.0 + tetrahedra[10][0],
            1.0,
            tolerance=CRITERION,
            source=pure,
            reason="the remedy is to hold a stiffness within 1 %",
            measure="stiffness",
            band=abs(tetrahedra[10][0] - tetrahedra[10][-1]) + band,
        )
    )

    # Whether the estimate of the error from one mesh sees the locking.
    estimates: dict[str, list[tuple[float, float]]] = {}
    with run.step("error estimate"):
        for n in (2, 4):
            pairs = []
            for a in lengths:
                block = bars.square(8, n, 4, a * bars.SIDE)
                bent = bars.bend(block, plain)
                guess = recovery_estimate(block.points, [(block.cells, bars.LAME)], bent.u)
                # both as shares of the energy of the solution
                pairs.append((bent.excess / (1.0 + bent.excess), guess.relative))
            estimates[f"{n} across"] = pairs
    share = min(guess / true for pairs in estimates.values() for true, guess in pairs)
    verdicts.append(
        judge(
            "error estimate of one mesh, hexahedra of 8 nodes in any length: sees at least a third "
            "of the locking, 1, or not, 0",
            float(share >= 1.0 / 3.0),
            1.0,
            tolerance=0.0,
            relative=False,
            source="error_estimate.recovery_estimate, whose band is three times the estimate",
            reason="yes or no",
            measure="identity",
        )
    )

    def last_within(values: list[float], at: Any) -> float:
        """The last place of the sweep up to which the criterion holds, NaN: nowhere."""
        bad = [k for k, v in enumerate(values) if abs(v) > CRITERION]
        if not bad:
            return float(at[-1])
        return float(at[bad[0] - 1]) if bad[0] else float("nan")

    def first_within(values: list[float], at: Any) -> float:
        """The first place of the sweep from which on the criterion holds, NaN: nowhere."""
        return last_within(values[::-1], at[::-1])

    program = (
        "scenes are meshed in curved tetrahedra of 10 nodes only; of other meshes the error "
        f"estimate is at least {share:.2g} times the error by locking"
    )

    limits: list[Any] = []

    def limit(method: str, parameter: str, at: Any, values: list[float], remedy: str) -> None:
        """A bound from above, where the sweep has found one."""
        high, worst = last_within(values, at), float(np.abs(values).max())
        if worst > CRITERION and not np.isnan(high):
            limits.append(
                Limit(
                    method=method,
                    parameter=parameter,
                    high=high,
                    criterion=f"stiffness within {100 * CRITERION:g} %",
                    beyond=f"too stiff by {100 * worst:,.0f} % at {at[-1]:g}",
                    program=program,
                    remedy=remedy,
                )
            )

    length_over_depth = "length of an element over the depth of a square bar [-]"
    length_over_diameter = "length of an element over the diameter of the shaft [-]"
    slender = f"length over depth, {ALONG} elements along [-]"
    second_order = "elements of second order"
    for n in acrosses:
        limit(
            f"hexahedra of 8 nodes, {n} across",
            length_over_depth,
            lengths,
            linear[8][n],
            "incompatible modes, or " + second_order,
        )
        limit(
            f"tetrahedra of 4 nodes, {n} across",
            length_over_depth,
            lengths,
            linear[4][n],
            second_order,
        )
    limit(
        f"hexahedra of 8 nodes, {most} across, cantilever",
        slender,
        slenderness,
        tip[f"8 nodes, {most} across"],
        "incompatible modes, or " + second_order,
    )
    for name, values in shafts.items():
        limit(f"hexahedra of {name}", length_over_diameter, round_lengths, values, second_order)
    for name, values in cubes.items():
        low, worst_error = first_within(values, cubes_across[name]), max(values, key=abs)
        if abs(worst_error) > CRITERION and not np.isnan(low):
            limits.append(
                Limit(
                    method=("" if name.startswith("tetra") else "hexahedra of ")
                    + f"{name}, nu = {bars.NU:g}",
                    parameter="cubes across a bent square bar [-]",
                    low=low,
                    criterion=f"stiffness within {100 * CRITERION:g} %",
                    beyond=f"error up to {100 * worst_error:+.0f} % with fewer",
                    program=f"averages from nu = {incompressible.AVERAGED_FROM:g} on only, and "
                    "asks for four across"
                    if name.endswith("averaged")
                    else program,
                    remedy=second_order + ", plain",
                )
            )

    def percent(values: Any) -> Any:
        return 100 * np.maximum(np.abs(values), 1e-12)

    def curve(name: str, x: Any, values: Any, dashed: bool = False) -> Any:
        line = {"dash": "dash"} if dashed else {}
        return trace(name, x, percent(values), mode="lines+markers", line=line)

    def shaded(values: list[float], at: Any) -> tuple[float | None, float | None] | None:
        high = last_within(values, at)
        return None if np.isnan(high) else (None, high)

    fewest = first_within(cubes["8 nodes"], cubes_across["8 nodes"])
    at_200 = tip[f"8 nodes, {most} across"][-1]
    return CASE.results(
        run,
        summary=[
            f"Hexahedra of 8 nodes shear where they should bend: {ALONG} along a bar of L/D = "
            f"{slenderness[-1]} make it {1 + at_200:.0f} times too stiff with {most} across, for "
            "more across do not help: it is the length of an element that counts, by G A a^2 / 12, "
            f"as theory has it to {verdicts[0].computed:.0e}. Tetrahedra of 4 nodes lock worse.",
            "Elements of second order, and hexahedra with incompatible modes, bend with one across "
            f"within {100 * max(np.abs(tip[name]).max() for name in remedies):.2g} % at every L/D; "
            "incompatible modes only where they are bricks: in a round shaft "
            f"{100 * shafts['8 nodes, incompatible modes, 8 round a turn'][-1]:.0f} % are left.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Square bar in pure bending",
                items=[
                    chart(
                        "Hexahedra: error of the bending stiffness; dashed, the remedies with one "
                        f"across (shaded: 8 nodes, {most} across, within 1 %)",
                        [
                            trace("8 nodes, 1 across, theory", lengths, percent(theory)),
                            *(
                                curve(f"8 nodes, {n} across", lengths, values)
                                for n, values in linear[8].items()
                            ),
                            *(
                                curve(name, lengths, held[name], dashed=True)
                                for name in remedies
                                if not name.startswith("tetra")
                            ),
                        ],
                        length_over_depth,
                        "error [%]",
                        ("x", "y"),
                        shaded(linear[8][most], lengths),
                    ),
                    chart(
                        "Tetrahedra, six in each hexahedron: error of the bending stiffness; those "
                        "of 4 nodes are within 1 % nowhere",
                        [
                            *(
                                curve(f"4 nodes, {n} across", lengths, values)
                                for n, values in linear[4].items()
                            ),
                            curve(
                                "10 nodes, 1 across",
                                lengths,
                                held["tetrahedra of 10 nodes"],
                                dashed=True,
                            ),
                        ],
                        length_over_depth,
                        "error [%]",
                        ("x", "y"),
                        shaded(linear[4][most], lengths),
                    ),
                    Text(
                        text="Edges of linear elements stay straight, so a bent element shears, "
                        "by its curvature times the distance from its middle. The energy of that "
                        "grows with the square of its length and drowns the energy of bending."
                    ),
                    chart(
                        "Cubes: error of the bending stiffness against their number across; "
                        "averaged dilatations are no remedy here (shaded: 8 nodes within 1 %)",
                        [
                            curve(name, cubes_across[name], values, dashed="averaged" in name)
                            for name, values in cubes.items()
                        ],
                        "cubes across, for tetrahedra of six each [-]",
                        "error [%]",
                        ("x", "y"),
                        (fewest, None),
                    ),
                ],
            ),
            Section(
                title="Cantilever",
                items=[
                    chart(
                        f"Error of the tip stiffness, {ALONG} elements along (shaded: 8 nodes, "
                        f"{most} across, within 1 %)",
                        [
                            curve(name, slenderness, values, dashed=name in remedies)
                            for name, values in tip.items()
                        ],
                        "length over depth [-]",
                        "error [%]",
                        ("x", "y"),
                        shaded(tip[f"8 nodes, {most} across"], slenderness),
                    )
                ],
            ),
            Section(
                title="Round shafts in pure bending",
                items=[
                    chart(
                        "Hexahedra: error of the bending stiffness against E I of the mesh "
                        "(shaded: incompatible modes, 16 round a turn, within 1 %)",
                        [
                            curve(name, round_lengths, values, dashed=not name.startswith("8"))
                            for name, values in shafts.items()
                        ],
                        length_over_diameter,
                        "error [%]",
                        ("x", "y"),
                        shaded(
                            shafts["8 nodes, incompatible modes, 16 round a turn"], round_lengths
                        ),
                    ),
                    Table(
                        caption=f"Tetrahedra as the program meshes, L/D = {SHAFT_SLENDERNESS}; "
                        "linear ones on the same corners. Against the circle's E I, linear ones "
                        "lose by their flat sides a part of what they gain by locking",
                        columns=[
                            "nodes",
                            "elements across",
                            "unknowns",
                            "error against E I of the mesh [%]",
                            "error against E I of the circle [%]",
                        ],
                        rows=rows,
                    ),
                ],
            ),
            Section(
                title="Does the program notice?",
                items=[
                    chart(
                        "Error of the energy estimated from one mesh of 8-node hexahedra, over the "
                        "true one: 1 is right, above a third the estimate's band holds the answer",
                        [
                            trace(
                                name,
                                lengths,
                                [guess / true for true, guess in pairs],
                                mode="lines+markers",
                            )
                            for name, pairs in estimates.items()
                        ],
                        length_over_depth,
                        "estimated over true error [-]",
                        ("x",),
                    )
                ],
            ),
        ],
        limits=limits,
        figures={
            "lengths": list(lengths),
            "linear": {str(k): {str(n): v for n, v in d.items()} for k, d in linear.items()},
            "theory": theory,
            "cubes": cubes,
            "slenderness": list(slenderness),
            "cantilever": tip,
            "round_lengths": list(round_lengths),
            "round": shafts,
        },
    )


CASE = Case(
    name="stability/shear_locking",
    title="Shear locking: linear elements in bent bars and shafts, L/D from 5 to 200",
    source="Timoshenko and Goodier 1970, Theory of Elasticity, art 21 and 102; Taylor, Beresford "
    "and Wilson 1976, Int. J. Numer. Meth. Eng. 10, 1211-1219",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
