"""Curved elements folded on a coarse fillet: how many, their effect, and what repairs them."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import fillet_factors, rigid_ended_shafts
from fe_drivetrain.cases.stability import folded_meshes
from fe_drivetrain.elasticity.mesh import (
    Mesh,
    find_faults,
    generate,
    inverted_cells,
    relax_flat_cells,
    volume,
)
from fe_drivetrain.geometry import MeshSizes
from fe_drivetrain.report import crosses, marked
from fe_drivetrain.report.suite import Page, Record, Run, column, grouped

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

REPAIRED = "torsional stiffness after that, from the coarsest size asked for"
PEAKS = (
    "Error of the peak stress in torsion over the elements on the fillet: folded ones show here; "
    "shaded: none folded"
)
TURN = "elements a turn"
AROUND = "elements to a full turn of the fillet's radius"
FOLDED, AT_NODE = "folded", "folded at a node"
TORSION, PEAK = "error of torsion", "error of the peak stress"


def meshes(per_turn: float) -> dict[str, Mesh]:
    """The fillet in elements of one size, by repair."""
    raw = folded_meshes.curved(per_turn)
    size = 2 * np.pi * folded_meshes.RADIUS / per_turn
    return {
        "as curved": raw,
        "relaxed": relax_flat_cells(raw),
        "HighOrder": folded_meshes.curved(per_turn, "HighOrder"),
        "HighOrderElastic": folded_meshes.curved(per_turn, "HighOrderElastic"),
        "refined": generate(folded_meshes.SHAFT, sizes=MeshSizes(shaft=size, elements_per_turn=6)),
    }


def examine(per_turn: float, repair: str, mesh: Mesh, exact: float, factor: float) -> Record:
    """Folded elements of a mesh, what the check reports of them, and errors of its answers."""
    found = inverted_cells(mesh)
    faults = [f for f in find_faults(mesh) if f.kind == "inverted"]
    missed = len(np.setdiff1d(folded_meshes.folded_by_sampling(mesh), found))
    missed += int((faults[0].count if faults else 0) != len(found))
    answer = folded_meshes.solved(mesh)
    return {
        TURN: per_turn,
        "repair": repair,
        "elements": len(mesh.cells),
        FOLDED: len(found),
        AT_NODE: folded_meshes.folded_at_nodes(mesh),
        "error of the volume": volume(mesh) / folded_meshes.exact_volume() - 1.0,
        TORSION: answer.stiffness["torsion"] / exact - 1.0,
        PEAK: answer.peak / factor - 1.0,
        "outcome": answer.failure or "solved",
        "missed": missed,
        "sentence": faults[0].sentence if faults else "",
    }


@case(
    "Curved elements folded on a coarse fillet, before and after repair",
    source="Johnen, Remacle and Geuzaine 2013, Geometrical validity of curvilinear finite "
    "elements, J. Comp. Phys. 233, 359-372",
)
def run(run: Run, page: Page) -> None:
    """Mesh the fillet ever coarser, count, solve and repair."""
    shaft = folded_meshes.SHAFT
    with run.step("reference"):
        exact = rigid_ended_shafts.exact(shaft, 0.1, 10)["torsion"]
        wide, thin = (shaft.sections[k].outer_diameter for k in (0, -1))
        factor = fillet_factors.peak("torsion", wide / thin, folded_meshes.RADIUS / thin, 8).factor
    rows: list[Record] = []
    for per_turn in QUICK_PER_TURN if run.quick else PER_TURN:
        run.report(f"{per_turn:g} elements to a turn of the fillet")
        with run.step("meshes"):
            repaired = meshes(per_turn)
        with run.step("check and solve"):
            rows += [examine(per_turn, name, m, exact, factor) for name, m in repaired.items()]
    of = dict(grouped(rows, "repair"))
    check(page, rows, of, exact)
    show(page, rows, of)
    page.image("The shaft with its fillet", run.sketch(shaft))


def check(page: Page, rows: list[Record], of: Mapping[str, list[Record]], exact: float) -> None:
    """The sweep folds elements; the check sees each; the program leaves none."""
    page.at_least(
        "the sweep goes on until elements fold: folded ones of the coarsest mesh, at least one",
        of["as curved"][-1][FOLDED],
        1,
        why="otherwise there would be nothing to repair",
        source="this sweep",
        measure="identity",
    )
    page.vanishes(
        "elements with a negative Jacobian at one of 455 points inside that the bounds or the "
        "check of the mesh miss",
        sum(column(rows, "missed")),
        within=0.0,
        why="a folded element that gets through changes the answer without a sign",
        source="dense sampling, which proves a fold wherever it finds one",
    )
    page.vanishes(
        "elements folded after what the program does, relaxed and refined, over the sweep",
        sum(column(of["refined"], FOLDED)),
        within=0.0,
        why="every element valid everywhere inside",
        source="Johnen, Remacle and Geuzaine 2013, J. Comp. Phys. 233, 359-372",
    )
    errors = column(of["refined"], TORSION)
    page.equals(
        f"{REPAIRED} [MN m/rad]",
        (1 + errors[-1]) * exact / 1e6,
        exact / 1e6,
        within=COARSE,
        why="5 %, the outer contour of the atlas, of the coarsest mesh that is sound",
        source="the meridian of the shaft in fourth-order elements",
        band=abs(errors[-1] - errors[0]) * exact / 1e6,
    )


def show(page: Page, rows: list[Record], of: Mapping[str, list[Record]]) -> None:
    """Answer, charts, tables and the limit."""
    raw, x = of["as curved"], np.array(column(of["as curved"], TURN))
    folded = np.array(column(raw, FOLDED)) > 0
    safe = float(x[: int(folded.argmax())].min()) if folded.any() and not folded[0] else None
    no_answer = np.isnan(column(raw, TORSION))
    silent, hidden = folded.sum() - no_answer.sum(), sum(r[FOLDED] - r[AT_NODE] for r in raw)
    worst_peak = np.nanmax(np.abs(np.array(column(raw, PEAK))[folded]))
    repaired_peak = np.abs(np.array(column(of["refined"], PEAK))[folded]).max()
    worst_torsion = np.abs(column(of["refined"], TORSION)).max()
    answer(page, of, safe, 100 * worst_peak, 100 * repaired_peak)
    page.say(
        f"{total(raw)} elements fold over the sweep, {hidden} of them where none of "
        f"their ten nodes shows it. Relaxing leaves {total(of['relaxed'])}, gmsh's HighOrder "
        f"{total(of['HighOrder'])}, its HighOrderElastic {total(of['HighOrderElastic'])}, and "
        f"relaxing with local refinement, as the program does, {total(of['refined'])}.",
        f"Left in, they mostly give no sign: {silent} of {folded.sum()} such meshes are solved as "
        "if nothing were wrong; the others end as 'singular', which names the wrong cause. The "
        "check names them before.",
    )
    page.limit(
        "curved tetrahedra on a fillet, as gmsh's setOrder(2) makes them",
        f"{AROUND} [-]",
        low=safe,
        criterion="no element folded anywhere inside",
        beyond=f"elements fold, {hidden} of {total(raw)} only between their nodes; peak "
        f"stress wrong by up to {100 * worst_peak:.0f} %, or 'singular'",
        program="relaxes, then refines the part up to three times; refuses what is left with "
        "element and place",
        remedy="relaxing and local refinement: none folded, stiffness of torsion within "
        f"{100 * worst_torsion:.1f} %, peak stress within {100 * repaired_peak:.0f} %",
    )
    show_sweeps(page, of, safe)
    shown = [name for name in rows[0] if name not in ("missed", "sentence")]
    every = [
        {name: None if row[name] != row[name] else row[name] for name in shown} for row in rows
    ]
    page.table("Every mesh", every)
    page.data("every mesh", every)


def answer(
    page: Page,
    of: Mapping[str, list[Record]],
    safe: float | None,
    worst_peak: float,
    repaired_peak: float,
) -> None:
    """State where curving folds elements, and the errors of the peak stress with them [%]."""
    left = total(of["refined"])
    page.answer(
        "When do curved elements fold on a coarse fillet, and how wrong is the stress then?",
        (
            f"With fewer than {safe:g} elements per turn, curved elements fold on a fillet: "
            if safe is not None
            else "Curved elements fold on a fillet in every mesh of the sweep: "
        )
        + f"peak stress is wrong by up to {worst_peak:.0f}\u00a0%, or {repaired_peak:.0f}\u00a0% "
        "after repair.",
        [
            *([page.value("least elements per turn without folded ones", safe)] if safe else []),
            page.value("worst error of the peak stress, elements folded [%]", round(worst_peak)),
            page.value(
                "worst error of the peak stress, elements repaired [%]", round(repaired_peak)
            ),
            page.judged(
                REPAIRED, "torsional stiffness, coarsest mesh, elements repaired", "meridian"
            ),
            page.value("folded elements before repair, whole sweep", total(of["as curved"])),
            page.value("folded elements after the program's repair", left, at_most=0.0),
        ],
        hero=PEAKS,
        cautions=[
            "A solver seldom notices folded elements: check the Jacobian inside each element."
        ],
    )


def total(series: list[Record]) -> int:
    """Elements that fold in all meshes of a series."""
    return sum(column(series, FOLDED))


def show_sweeps(page: Page, of: Mapping[str, list[Record]], safe: float | None) -> None:
    """Show how many elements fold, and the errors, over the elements to a turn."""
    page.section("How many fold")
    page.chart(
        "Folded elements, plus 0.1 so that none can be drawn",
        curves(of, FOLDED, 0.1),
        AROUND,
        "folded elements + 0.1",
        "xy",
        (safe, None),
    )
    page.table(
        "Repairs",
        [
            {"name": n, "what it does": text, "folded elements left in the sweep": total(of[n])}
            for n, text in REPAIRS.items()
        ],
    )
    sentences = [row["sentence"] for row in of["as curved"] if row["sentence"]]
    page.text(f"What the check reports of the coarsest mesh: {' '.join(sentences[-1:])}.")
    page.section("What they do to the answer")
    page.chart(
        "Error of the torsional stiffness. Folded elements hide in the error of the coarse mesh, "
        "until there is no answer at all",
        curves(of, TORSION) + no_answers(of["as curved"]),
        AROUND,
        "relative error of the stiffness",
        "xy",
        (safe, None),
    )
    page.chart(
        PEAKS,
        curves(of, PEAK) + no_answers(of["as curved"]),
        AROUND,
        "relative error of the peak stress",
        "xy",
        (safe, None),
    )


def curves(of: Mapping[str, list[Record]], quantity: str, shift: float = 0.0) -> list[Any]:
    """Curves of the absolute value of a quantity, one for each series of meshes."""
    traces = []
    for name, series in of.items():
        answered = [row for row in series if np.isfinite(row[quantity])]
        values = np.abs(column(answered, quantity)) + shift
        traces.append(marked(name, column(answered, TURN), values))
    return traces


def no_answers(raw: list[Record]) -> list[Any]:
    """Crosses at the meshes that have no answer, if there are any."""
    at = [row[TURN] for row in raw if np.isnan(row[TORSION])]
    return [crosses("no answer as curved", at)] if at else []
