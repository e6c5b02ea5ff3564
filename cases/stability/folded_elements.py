"""Curved elements folded on a coarse fillet: how many, what they do, and what mends them."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: Elements to a full turn of the fillet's radius; a fillet is a quarter of a turn.
PER_TURN = (6.0, 5.0, 4.0, 3.5, 3.0, 2.5, 2.0, 1.5, 1.0)
QUICK_PER_TURN = (5.0, 2.0, 1.5)

REPAIRS = {
    "as curved": "left as gmsh's setOrder(2) makes them",
    "relaxed": "edges of flat elements drawn towards straight (relax_flat_cells)",
    "HighOrder": "gmsh's optimisation of curved elements, corners move too",
    "HighOrderElastic": "gmsh's elastic analogy",
    "refined": "relaxed and refined locally until sound (generate: what the program does)",
}
#: An engineer's accuracy of a stiffness from a coarse mesh, the outer contour of the atlas.
COARSE = 0.05


def run(run: Run) -> Any:
    """Mesh the fillet ever coarser, count, solve and mend."""
    import numpy as np

    from fe_drivetrain.geometry import MeshSizes
    from fe_drivetrain.mesh import find_faults, generate, inverted_cells, relax_flat_cells, volume
    from fe_drivetrain.report import Limit, Section, Table, Text, chart, judge, trace
    from fe_drivetrain.validation import (
        fillet_factors,
        folded_meshes,
        rigid_ended_shafts,
    )

    sweep = QUICK_PER_TURN if run.quick else PER_TURN
    with run.step("reference"):
        exact = rigid_ended_shafts.exact(folded_meshes.SHAFT, 0.1, 10)
        thin = folded_meshes.SHAFT.sections[-1].outer_diameter
        wide = folded_meshes.SHAFT.sections[0].outer_diameter
        factor = fillet_factors.peak("torsion", wide / thin, folded_meshes.RADIUS / thin, 8).factor
    exact_volume = folded_meshes.exact_volume()
    counts: dict[str, list[int]] = {name: [] for name in REPAIRS}
    errors: dict[str, list[float]] = {name: [] for name in REPAIRS}
    peaks: dict[str, list[float]] = {name: [] for name in REPAIRS}
    rows: list[list[Any]] = []
    missed = needless = hidden = 0
    sentence = ""
    for per_turn in sweep:
        run.report(f"{per_turn:g} elements to a turn of the fillet")
        size = 2 * np.pi * folded_meshes.RADIUS / per_turn
        with run.step("meshes"):
            raw = folded_meshes.curved(per_turn)
            meshes = {
                "as curved": raw,
                "relaxed": relax_flat_cells(raw),
                "HighOrder": folded_meshes.curved(per_turn, "HighOrder"),
                "HighOrderElastic": folded_meshes.curved(per_turn, "HighOrderElastic"),
                "refined": generate(
                    folded_meshes.SHAFT, sizes=MeshSizes(shaft=size, elements_per_turn=6)
                ),
            }
        with run.step("check and solve"):
            for name, mesh in meshes.items():
                found = inverted_cells(mesh)
                sampled = folded_meshes.folded_by_sampling(mesh)
                missed += len(np.setdiff1d(sampled, found))
                faults = [f for f in find_faults(mesh) if f.kind == "inverted"]
                missed += int((faults[0].count if faults else 0) != len(found))
                needless += int(bool(faults) and len(found) == 0)
                answer = folded_meshes.solved(mesh)
                stiffness = answer.stiffness["torsion"] / exact["torsion"] - 1.0
                peak = answer.peak / factor - 1.0
                counts[name].append(len(found))
                errors[name].append(stiffness)
                peaks[name].append(peak)
                if name == "as curved":
                    hidden += len(found) - folded_meshes.folded_at_nodes(mesh)
                    sentence = faults[0].sentence if faults else sentence
                rows.append(
                    [
                        per_turn,
                        name,
                        len(mesh.cells),
                        len(found),
                        folded_meshes.folded_at_nodes(mesh),
                        volume(mesh) / exact_volume - 1.0,
                        None if np.isnan(stiffness) else stiffness,
                        None if np.isnan(peak) else peak,
                        answer.failure or "solved",
                    ]
                )
    x = np.array(sweep)
    raw_counts = np.array(counts["as curved"])
    folded = raw_counts > 0
    safe = float(x[: int(folded.argmax())].min()) if folded.any() and not folded[0] else None
    no_answer = [k for k, e in enumerate(errors["as curved"]) if np.isnan(e)]
    silent = int(folded.sum()) - len(no_answer)
    refined = np.array(errors["refined"])
    worst_peak = float(np.nanmax(np.abs(np.array(peaks["as curved"])[folded])))
    mended_peak = float(np.abs(np.array(peaks["refined"])[folded]).max())
    verdicts = [
        judge(
            "the sweep goes on until elements fold: folded ones of the coarsest mesh, at least one",
            float(raw_counts[-1] > 0),
            1.0,
            tolerance=0.0,
            relative=False,
            source="this sweep",
            reason="yes or no",
            measure="identity",
        ),
        judge(
            "elements with a negative Jacobian at one of 455 points inside that the bounds or "
            "the check of the mesh miss",
            float(missed),
            0.0,
            tolerance=0.0,
            relative=False,
            source="dense sampling, which proves a fold wherever it finds one",
            reason="none may get through",
            measure="identity",
        ),
        judge(
            "elements folded after what the program does, relaxed and refined, over the sweep",
            float(sum(counts["refined"])),
            0.0,
            tolerance=0.0,
            relative=False,
            source="Johnen, Remacle and Geuzaine 2013, J. Comp. Phys. 233, 359-372",
            reason="every element valid everywhere inside",
            measure="identity",
        ),
        judge(
            "torsional stiffness after that, from the coarsest size asked for",
            float((1 + refined[-1]) * exact["torsion"]),
            exact["torsion"],
            tolerance=COARSE,
            unit="N m/rad",
            source="the meridian of the shaft in fourth-order elements",
            reason="5 %, the outer contour of the atlas, of the coarsest mesh that is sound",
            measure="stiffness",
            band=float(abs(refined[-1] - refined[0]) * exact["torsion"]),
        ),
    ]
    label = "elements to a full turn of the fillet's radius"
    style: dict[str, Any] = {"mode": "lines+markers"}
    number_traces = [trace(n, x, [c + 0.1 for c in counts[n]], **style) for n in REPAIRS]
    error_traces = [trace(n, x, np.abs(errors[n]), **style) for n in REPAIRS]
    peak_traces = [trace(n, x, np.abs(peaks[n]), **style) for n in REPAIRS]
    cross = {"symbol": "x", "size": 11, "color": "#c62828"}
    gone = trace("no answer as curved", x[no_answer], [1.0] * len(no_answer), True, marker=cross)
    if no_answer:
        error_traces.append(gone)
        peak_traces.append(gone)
    for traces in (error_traces, peak_traces):
        for t in traces:
            t["y"] = [None if np.isnan(y) else y for y in t["y"]]
    totals = {name: sum(c) for name, c in counts.items()}
    return CASE.results(
        run,
        summary=[
            f"Curving folds elements on the fillet below {safe:g} elements to a turn."
            if safe is not None
            else "Curving folds elements in every mesh of the sweep.",
            f"{totals['as curved']} elements fold over the sweep, {hidden} of them where none of "
            f"their ten nodes shows it. Relaxing leaves {totals['relaxed']}, gmsh's HighOrder "
            f"{totals['HighOrder']}, its HighOrderElastic {totals['HighOrderElastic']}, and "
            f"relaxing with local refinement, as the program does, {totals['refined']}.",
            f"Left in, they mostly give no sign: {silent} of {int(folded.sum())} such meshes are "
            f"solved as if nothing were, with the peak stress of torsion wrong by up to "
            f"{100 * worst_peak:.0f} %, where the program's meshes are within "
            f"{100 * mended_peak:.0f} %; the others end as 'singular', which names the wrong "
            "cause. The check names them before.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="How many fold",
                items=[
                    chart(
                        "Folded elements, plus 0.1 so that none can be drawn",
                        number_traces,
                        label,
                        "folded elements + 0.1",
                        ("x", "y"),
                        safe=(safe, None),
                    ),
                    Table(
                        caption="Repairs",
                        columns=["name", "what it does", "folded elements left in the sweep"],
                        rows=[[n, text, totals[n]] for n, text in REPAIRS.items()],
                    ),
                    Text(text=f"What the check says of the coarsest mesh: {sentence}."),
                ],
            ),
            Section(
                title="What they do to the answer",
                items=[
                    chart(
                        "Error of the torsional stiffness. Folded elements hide in the error of "
                        "the coarse mesh, until there is no answer at all",
                        error_traces,
                        label,
                        "relative error of the stiffness",
                        ("x", "y"),
                        safe=(safe, None),
                    ),
                    chart(
                        "Error of the peak stress in torsion: here folded elements show",
                        peak_traces,
                        label,
                        "relative error of the peak stress",
                        ("x", "y"),
                        safe=(safe, None),
                    ),
                    Table(
                        caption="Every mesh",
                        columns=[
                            "elements a turn",
                            "repair",
                            "elements",
                            "folded",
                            "folded at a node",
                            "error of the volume",
                            "error of torsion",
                            "error of the peak stress",
                            "outcome",
                        ],
                        rows=rows,
                    ),
                ],
            ),
        ],
        limits=[
            Limit(
                method="curved tetrahedra on a fillet, as gmsh's setOrder(2) makes them",
                parameter="elements to a full turn of the fillet's radius [-]",
                low=safe,
                high=None,
                criterion="no element folded anywhere inside",
                beyond=f"elements fold, {hidden} of {totals['as curved']} only between their "
                f"nodes; peak stress wrong by up to {100 * worst_peak:.0f} %, or 'singular'",
                program="relaxes, then refines the part up to three times; refuses what is left "
                "with element and place",
                remedy="relaxing and local refinement: none folded, stiffness of torsion within "
                f"{100 * float(np.abs(refined).max()):.1f} %, peak stress within "
                f"{100 * mended_peak:.0f} %",
            )
        ],
        figures={"per_turn": list(sweep), "folded": counts},
    )


CASE = Case(
    name="stability/folded_elements",
    title="Curved elements folded on a coarse fillet, before and after repair",
    source="Johnen, Remacle and Geuzaine 2013, Geometrical validity of curvilinear finite "
    "elements, J. Comp. Phys. 233, 359-372",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
