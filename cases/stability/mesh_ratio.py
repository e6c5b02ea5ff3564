"""Ties of flat faces, meshes up to twenty times apart: patch test, reactions, stress, fill."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: Elements across the coarser side, and how many times as many across the finer.
COARSE = 2
RATIOS = (1, 1.5, 2, 3, 5, 8, 12, 20)
QUICK_RATIOS = (1, 2, 5, 20)

ERROR = 0.05  # of the stress, that is let pass
#: Machine precision times the condition of strips 40 elements across, each 20 times as long as
#: wide, squared as for any second-order operator, and ten for what is not counted.
ROUND_OFF = 10 * 2.2e-16 * (40 * 20) ** 2


def run(run: Run) -> Any:
    """Each tie at each ratio, either side the slave."""
    import numpy as np

    from fe_drivetrain.report import Limit, Section, Table, Text, chart, judge, trace
    from fe_drivetrain.validation import (
        tied_strips,
    )
    from fe_drivetrain.validation.tied_strips import (
        TIES,
        Strip,
    )

    ratios = np.array(QUICK_RATIOS if run.quick else RATIOS, dtype=float)
    sides = ("finer", "coarser")
    found: dict[tuple[str, str], list[Strip]] = {}
    with run.step("tied strips"):
        for ratio in ratios:
            fine = round(COARSE * ratio)
            for side in sides:
                own, other = (fine, COARSE) if side == "finer" else (COARSE, fine)
                for kind in TIES:
                    run.report(f"{own} on {other}, {kind}")
                    strip = tied_strips.tied_strip(own, other, kind)
                    found.setdefault((kind, side), []).append(strip)

        matching = tied_strips.tied_strip(COARSE, COARSE, "node by node", grading=1.0)

    def of(kind: str, side: str, what: str) -> Any:
        return np.array([getattr(strip, what) for strip in found[kind, side]], dtype=float)

    def highest_within(kind: str, side: str, what: str) -> float | None:
        """The last ratio up to which the error is let pass."""
        within = of(kind, side, what) <= ERROR
        if not within[0]:
            return None
        return float(ratios[len(within) - 1 if within.all() else int(np.argmin(within)) - 1])

    mortar = ("standard", "dual")
    verdicts = []
    for kind in mortar:
        verdicts.append(
            judge(
                f"patch test, {kind} multipliers: largest error of all ratios, either side the "
                "slave",
                max(float(of(kind, side, "patch").max()) for side in sides),
                0.0,
                tolerance=ROUND_OFF,
                relative=False,
                source="constant stress (Irons and Razzaque 1972); the multipliers sum to one",
                reason=f"round-off times the condition of the finest strip: {ROUND_OFF:.1e}",
                measure="identity",
            )
        )
    verdicts.append(
        judge(
            "remedy: standard multipliers in pure bending, largest error of the stress, either "
            "side the slave",
            max(float(of("standard", side, "bending").max()) for side in sides),
            0.0,
            tolerance=ROUND_OFF,
            relative=False,
            source="linear tractions are among the multipliers, quadratic displacements among the "
            "elements'",
            reason=f"round-off times the condition of the finest strip: {ROUND_OFF:.1e}",
            measure="identity",
        )
    )
    verdicts.append(
        judge(
            "reactions: force and moment that ties fail to pass on, of the end's, worst of all",
            max(float(of(kind, side, "reaction").max()) for kind in TIES for side in sides),
            0.0,
            tolerance=1e-12,
            relative=False,
            source="on flat faces every tie holds for rigid motions, so what it carries balances",
            reason="a sum of a few hundred forces",
            measure="identity",
        )
    )
    verdicts.append(
        judge(
            "failure: node by node, patch test, ratios over one at which the coarser slave is off "
            f"by more than {100 * ERROR:g} %",
            float((of("node by node", "coarser", "patch")[1:] > ERROR).sum()),
            float(len(ratios) - 1),
            tolerance=0.0,
            source="forces arrive at the nodes opposite to the slave's, not spread as the "
            "traction is",
            reason="a count",
            measure="identity",
        )
    )
    verdicts.append(
        judge(
            "node by node, nodes that match: patch test",
            matching.patch,
            0.0,
            tolerance=ROUND_OFF,
            relative=False,
            source="nodes that match are the same as shared ones",
            reason="round-off",
            measure="identity",
        )
    )
    order = -float(np.polyfit(np.log(ratios[1:]), np.log(of("dual", "finer", "bending")[1:]), 1)[0])
    verdicts.append(
        judge(
            "dual multipliers, slave finer: order that the error of bending lacks to one",
            max(1.0 - order, 0.0),
            0.0,
            tolerance=0.1,
            relative=False,
            source="they hold constant tractions only: a linear one to first order in the slave's "
            "elements",
            reason="a tenth for an order seen on few meshes",
            measure="order",
            band=0.1,
        )
    )
    last = found["standard", "coarser"][-1]
    verdicts.append(
        judge(
            f"failure: entries of the stiffness at {ratios[-1]:g} to 1, slave coarser, are those "
            "of a full block of the master's freedoms, or more",
            float(last.entries >= (3 * last.master) ** 2),
            1.0,
            tolerance=0.0,
            source=f"the slave follows every node of the master: (3 x {last.master})^2 = "
            f"{(3 * last.master) ** 2:,}",
            reason="a yes or no",
            measure="identity",
        )
    )
    bad = {
        (side, k)
        for side in sides
        for k in range(len(ratios))
        if found["dual", side][k].bending > ERROR
    }
    warned = {
        (side, k) for side in sides for k in range(len(ratios)) if found["dual", side][k].warned
    }
    verdicts.append(
        judge(
            "protection: ratios and sides at which dual multipliers are off by more than "
            f"{100 * ERROR:g} % and no warning came",
            float(len(bad - warned)),
            0.0,
            tolerance=0.0,
            relative=False,
            source="`mortar.mortar_tie` warns of a slave with less than half of the master's nodes "
            "to an area",
            reason="a count",
            measure="identity",
        )
    )
    verdicts.append(
        judge(
            "protection: warnings where the slave is the finer",
            float(sum(side == "finer" for side, _ in warned)),
            0.0,
            tolerance=0.0,
            relative=False,
            source="a warning of what is right would teach to ignore it",
            reason="a count",
            measure="identity",
        )
    )

    dual_high = highest_within("dual", "coarser", "bending")
    floor = 1e-16

    def curves(what: str, kinds: Any = TIES) -> list[Any]:
        return [
            trace(
                f"{kind}, slave {side}",
                ratios,
                np.maximum(of(kind, side, what), floor),
                mode="lines+markers",
                line={} if side == "finer" else {"dash": "dash"},
            )
            for kind in kinds
            for side in sides
        ]

    rows: list[list[Any]] = [
        [
            f"{ratio:g}",
            side,
            *(found[kind, side][k].patch for kind in TIES),
            *(found[kind, side][k].bending for kind in TIES),
            found["standard", side][k].entries,
            found["standard", side][k].warned,
        ]
        for k, ratio in enumerate(ratios)
        for side in sides
    ]
    block = (3 * np.array([s.master for s in found["standard", "coarser"]])) ** 2
    node = of("node by node", "coarser", "patch")
    growth = last.entries / found["standard", "finer"][-1].entries
    return CASE.results(
        run,
        summary=[
            f"Mortar ties of flat faces pass constant stress at every ratio up to "
            f"{ratios[-1]:g} to 1, either side the slave; with standard multipliers linear stress "
            "as well.",
            f"With dual multipliers bending is within {100 * ERROR:g} % up to a slave "
            f"{dual_high:g} times coarser, and off by "
            f"{100 * of('dual', 'coarser', 'bending')[-1]:.2g} % at {ratios[-1]:g}; a finer slave "
            f"is never off by more than {100 * of('dual', 'finer', 'bending').max():.1g} %. "
            f"Node by node, constant stress is off by {100 * node[1]:.0f} to "
            f"{100 * node.max():.0f} % where the slave is the coarser.",
            f"A coarse slave fills the stiffness: {growth:.1f} times the entries at "
            f"{ratios[-1]:g} to 1 on a strip, and the square of the face's nodes in general.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Stress",
                items=[
                    chart(
                        "Patch test: largest error of a constant stress. Mortar ties pass to "
                        "round-off, ties node by node fail, worst where the slave is the coarser",
                        curves("patch"),
                        "elements of the finer side to one of the coarser",
                        "error of the stress",
                        logarithmic="xy",
                        safe=(None, None),
                    ),
                    chart(
                        "Pure bending: spurious stress. Dual multipliers fail with a coarser "
                        "slave; standard ones, and a finer slave, hold. Shaded where dual "
                        f"multipliers with the coarser slave are within {100 * ERROR:g} %",
                        curves("bending"),
                        "elements of the finer side to one of the coarser",
                        "largest error over largest stress",
                        logarithmic="xy",
                        safe=(None, dual_high),
                    ),
                    Text(
                        text="Both states are among the displacements of the elements, so that all "
                        "error is the tie's. The slave's divisions are graded, so that the "
                        "meshes do not nest where both have the same number."
                    ),
                ],
            ),
            Section(
                title="Fill",
                items=[
                    chart(
                        "Entries of the stiffness that is factorised: a coarse slave couples all "
                        "nodes of the master's face",
                        [
                            *curves("entries", mortar),
                            trace(
                                "full block of the master's freedoms",
                                ratios,
                                block,
                                line={"dash": "dot"},
                            ),
                        ],
                        "elements of the finer side to one of the coarser",
                        "entries",
                        logarithmic="xy",
                    ),
                    Table(
                        caption="Errors of constant and of linear stress, and entries with "
                        "standard multipliers",
                        columns=[
                            "ratio",
                            "slave",
                            *(f"patch, {kind}" for kind in TIES),
                            *(f"bending, {kind}" for kind in TIES),
                            "entries",
                            "warned",
                        ],
                        rows=rows,
                    ),
                ],
            ),
        ],
        limits=[
            Limit(
                method="mortar tie of flat faces, standard multipliers",
                parameter="elements of the finer side to one of the coarser",
                criterion="constant and linear stress to round-off, either side the slave",
                beyond=f"no error up to {ratios[-1]:g}; a coarser slave fills the stiffness with "
                "the square of the master's freedoms",
                program="warns of a slave with less than half of the master's nodes to an area",
                remedy="the finer face as the slave",
            ),
            Limit(
                method="mortar tie of flat faces, dual multipliers, slave coarser",
                parameter="elements of the finer side to one of the coarser",
                high=dual_high,
                criterion=f"linear stress within {100 * ERROR:g} %",
                beyond=f"spurious stress beside the tie, up to "
                f"{100 * of('dual', 'coarser', 'bending').max():.2g} % of the largest",
                program="warns of a slave with less than half of the master's nodes to an area",
                remedy="the finer face as the slave, or standard multipliers",
            ),
            *(
                Limit(
                    method=f"tie node by node of flat faces, slave {side}",
                    parameter="elements of the finer side to one of the coarser; at 1 nodes that "
                    "match",
                    **_range_of(ratios, of("node by node", side, "patch")),
                    criterion=f"constant stress within {100 * ERROR:g} %",
                    beyond=f"constant stress is off by up to "
                    f"{100 * of('node by node', side, 'patch').max():.3g} %",
                    program="warns of a slave that is the coarser"
                    if side == "coarser"
                    else "nothing, but its documentation says that constant stress does not pass",
                    remedy="mortar tie",
                )
                for side in sides
            ),
        ],
        figures={
            "ratios": ratios.tolist(),
            "patch": {f"{k}, slave {s}": of(k, s, "patch").tolist() for k, s in found},
            "bending": {f"{k}, slave {s}": of(k, s, "bending").tolist() for k, s in found},
            "entries": {f"{k}, slave {s}": of(k, s, "entries").tolist() for k, s in found},
        },
    )


def _range_of(ratios: Any, errors: Any) -> dict[str, float]:
    """Lowest and highest ratio with errors that are let pass, where these are not all or none."""
    good = ratios[errors <= ERROR]
    if len(good) == 0:  # but nodes that match: judged above
        return {"low": 1.0, "high": 1.0}
    bounds = {}
    if good[0] > ratios[0]:
        bounds["low"] = float(good[0])
    if good[-1] < ratios[-1]:
        bounds["high"] = float(good[-1])
    return bounds


CASE = Case(
    name="stability/mesh_ratio",
    title="Ties of flat faces with meshes up to twenty times apart: either side the slave",
    source="constant stress and pure bending, which the elements hold exactly; Puso 2004, Int. J. "
    "Numer. Meth. Engng 59, 315; Wohlmuth 2000, SIAM J. Numer. Anal. 38, 989",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
