"""Main bearings solved by CalculiX on the project's own decks, beside the project's answers."""

from __future__ import annotations

import shutil
import subprocess
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from fe_drivetrain.cases import cases
from fe_drivetrain.common import Floats, scratch_folder
from fe_drivetrain.drivetrain_file import Scene, change_scene, library_scene
from fe_drivetrain.elasticity.interfaces import dofs
from fe_drivetrain.elasticity.mesh import Mesh
from fe_drivetrain.export import (
    ROUNDING,
    DeckResponse,
    find_calculix,
    four_point_model,
    read_response,
    run_calculix,
    write_inp,
)
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Run
from fe_drivetrain.shafts.response import (
    LOADS,
    Model,
    Response,
    build_model,
    mesh_scene,
    unit_load_response,
)

TOLERANCE = 1e-6

_NOTHING = (
    1e-6  # of the load's largest reaction or energy: a part that carries less carries nothing
)

#: Coarsening of the library's mesh in a quick run.
QUICK_COARSER = 4.0
QUICK_LOADS = ("hub.Mx", "hub.Fz", "gravity.z")

QUANTITIES = (
    "displacements of all nodes",
    "motions of hub, gearbox and seat",
    "forces on the nodes of the base",
    "reactions of bearing and gearbox",
    "strain energy of each part",
)

_COLOURS = ("#0072b2", "#56b4e9", "#d55e00", "#e69f00", "#009e73")


@dataclass(frozen=True)
class Compared:
    """One deck and what both programs make of it.

    Attributes
    ----------
    label : str
        The interface.
    loads : tuple[str, ...]
        The m unit loads.
    differences : Mapping[str, Floats]
        (m,) by quantity: largest difference to the project's answer with ccx's integration,
        relative to the largest value of that load.
    usual : Mapping[str, Floats]
        The same to the project's usual answer.
    nodes, elements, unknowns, bytes : int
        Size of mesh, system and deck.
    ours, theirs : float
        Wall time of assembly and solve, and of ccx from deck to answer [s].
    reactions : tuple[Floats, Floats]
        (6, m) of the bearing, by the project and by ccx [N, N m].
    """

    label: str
    loads: tuple[str, ...]
    differences: Mapping[str, Floats]
    usual: Mapping[str, Floats]
    nodes: int
    elements: int
    unknowns: int
    bytes: int
    ours: float
    theirs: float
    reactions: tuple[Floats, Floats]


def scene_of(kind: str, factor: float) -> Scene:
    """The library's main bearing on a coarser mesh."""
    scene = library_scene(f"main_bearing_{kind}")
    sizes = scene.mesh.scaled(factor, 8)
    return scene.model_copy(update={"mesh": sizes})


def compare(run: Run, scene: Scene, label: str, mesh: Mesh) -> Compared:
    """Solve a scene here and with ccx; its deck stays beside the results.

    Ten unit loads, and the three of `QUICK_LOADS` in a quick run: ccx factorises again for each.

    Raises
    ------
    MissingToolError
        CalculiX is not installed.
    """
    find_calculix()
    loads = QUICK_LOADS if run.quick else LOADS
    with run.step(f"unit loads here ({label})"):
        model = build_model(scene, mesh)
        usual = unit_load_response(model)
        start = time.perf_counter()
        four = four_point_model(model)
        ours = unit_load_response(four)
        seconds = time.perf_counter() - start
    deck = run.folder / f"{label}.inp"
    with run.step(f"deck ({label})"):
        write_inp(model, deck, loads, fields=False)
    with run.step(f"CalculiX ({label})"), scratch_folder() as name:
        copy = name / "job.inp"
        shutil.copy(deck, copy)
        start = time.perf_counter()
        dat = run_calculix(copy)
        theirs_seconds = time.perf_counter() - start
        theirs = read_response(model, dat, loads)
    bearing = scene.bearing_units[0].bearing.name
    return Compared(
        label=label,
        loads=tuple(loads),
        differences=differences(four, ours, theirs, loads),
        usual=differences(model, usual, theirs, loads),
        nodes=len(mesh.points),
        elements=len(mesh.cells),
        unknowns=ours.diagnostics.n_unknowns,
        bytes=deck.stat().st_size,
        ours=seconds,
        theirs=theirs_seconds,
        reactions=(ours.reactions[bearing][:, _columns(loads)], theirs.reactions[bearing]),
    )


def differences(
    model: Model, ours: Response, theirs: DeckResponse, loads: Sequence[str] = LOADS
) -> dict[str, Floats]:
    """(m,) largest difference of each load by quantity, relative to that load's largest value."""
    columns = _columns(loads)
    names = list(theirs.motions)
    moves, turns = (
        [
            np.concatenate([of[name][rows] for name in names])
            for of in (ours.motions, theirs.motions)
        ]
        for rows in (slice(0, 3), slice(3, 6))
    )
    reactions = [
        np.vstack([of[n] for n in theirs.reactions]) for of in (ours.reactions, theirs.reactions)
    ]
    min_force = _NOTHING * np.abs(reactions[0][:, columns]).max(axis=0)
    base = base_forces(model, ours)
    bases = [
        _relative(base[name][..., columns], forces, min_force)
        for name, forces in theirs.base_forces.items()
    ]
    stored = {
        part: 0.5 * matrix.diagonal()[None, columns] for part, matrix in ours.strain_energy.items()
    }
    # with the springs: a shaft that turns as a rigid body about its joint stores nothing itself
    total = np.sum([energy[0] for energy in stored.values()], axis=0)
    for point, k in model.springs:
        motion = ours.motions[point.name][:, columns]
        total += 0.5 * np.einsum("im,ij,jm->m", motion, k, motion)
    min_energy = _NOTHING * total
    energies = [
        _relative(stored[part], energy[None], min_energy)
        for part, energy in theirs.strain_energy.items()
    ]
    found = (
        _relative(ours.displacements[..., columns], theirs.displacements),
        np.maximum(*(_relative(mine[:, columns], yours) for mine, yours in (moves, turns))),
        np.max(bases, axis=0),
        _relative(reactions[0][:, columns], reactions[1]),
        np.max(energies, axis=0),
    )
    return dict(zip(QUANTITIES, found, strict=True))


def _columns(loads: Sequence[str]) -> list[int]:
    return [LOADS.index(load) for load in loads]


def base_forces(model: Model, response: Response) -> dict[str, Floats]:
    """(n, 3, 10) forces that the support puts on the nodes of each base [N]."""
    n_loads = len(LOADS)
    u = np.zeros((model.n_dofs, n_loads))
    u[: response.displacements[..., 0].size] = response.displacements.reshape(-1, n_loads)
    forces = -model.unit_loads()
    for stiffness in model.part_stiffness.values():
        forces += stiffness @ u
    found = {}
    for unit in model.scene.bearing_units:
        nodes = model.mesh.face_nodes(f"{unit.bearing.name}.housing.base")
        found[unit.bearing.name] = forces[dofs(nodes)]
    return found


def _relative(ours: Floats, theirs: Floats, least: Floats | None = None) -> Floats:
    """(m,) largest difference of each load, relative to the load's largest value.

    Values that are not above the least are round-off where there should be nothing, as in a housing
    while torque goes through a joint that is free to turn: their size is then ``least / _NOTHING``.
    """
    axes = tuple(range(ours.ndim - 1))
    size = np.abs(ours).max(axis=axes)
    bound = np.zeros_like(size) if least is None else least
    size = np.where(size > bound, size, bound / _NOTHING)
    return np.asarray(np.abs(theirs - ours).max(axis=axes) / np.where(size > 0.0, size, 1.0))


def ccx_version() -> str:
    """Version that ccx prints."""
    printed = subprocess.run([find_calculix(), "-v"], capture_output=True, text=True, check=False)
    return printed.stdout.strip().removeprefix("This is Version").strip()


@cases("calculix.yaml")
def run(run: Run, page: Page, row: Mapping[str, Any]) -> None:
    """Write a deck for each form of the interface, solve it twice, compare."""
    find_calculix()
    scene = scene_of(row["scene"], QUICK_COARSER if run.quick else row["coarser"])
    mesh = run.timed("mesh", mesh_scene, scene)
    forms = {
        form: change_scene(scene, {"bearing_units.0.interface": form}) for form in row["interfaces"]
    }
    with run.side_by_side(len(forms)) as jobs:
        work = [jobs.start(compare, changed, form, mesh) for form, changed in forms.items()]
        found = [job.result() for job in work]
    for one in found:
        page.about(forms[one.label], one.label)
        check(page, one)
    answer(page, found, row["question"], row["subject"])
    add_results(page, found)
    page.section("How it was compared")
    page.text(
        "The deck has all of the model: ten-node tetrahedra, materials, interfaces and couplings "
        "as linear equations, supports, springs to ground, and the unit loads, a step each. ccx "
        "solves it with its own elements, elimination and direct solver. It is beside this page "
        "(.inp)."
    )
    page.text(
        "ccx integrates its ten-node tetrahedra at four points, which is exact for straight edges "
        "only; this project takes eleven points in curved elements. To compare the programs and "
        "not the integration, the project's stiffness is integrated at four points, too. What the "
        "usual integration changes is shown by open symbols."
    )
    for one in found:
        page.data(one.label, one.differences)
    page.image("The scene, as meshed here", run.sketch(mesh))


def answer(page: Page, found: Sequence[Compared], question: str, subject: str) -> None:
    """State how far CalculiX is from the project's answers, over all forms of the interface."""
    worst = max(_worst(one.differences) for one in found)
    loads = f"{len(found[0].loads)} unit loads"
    digits = f"by {formatted(1e6 * worst, 2)} millionths at most"
    verdict = f"Yes: on {subject} both programs differ {digits} under {loads}, within CalculiX's "
    verdict += "printed digits."
    if worst > TOLERANCE:
        verdict = f"No: on {subject} both programs differ {digits} under {loads}, more than "
        verdict += "CalculiX's rounding."
    usual = 100 * max(float(one.usual[QUANTITIES[0]].max()) for one in found)
    page.answer(
        question,
        verdict,
        [
            *(
                page.value(
                    f"largest difference, {quantity} [-]",
                    max(float(one.differences[quantity].max()) for one in found),
                    at_most=TOLERANCE,
                    by="printed digits",
                )
                for quantity in (*QUANTITIES[:1], *QUANTITIES[2:])
            ),
            page.value("displacements, usual integration here [%]", usual),
        ],
        hero=_caption(found[0]),
        cautions=[
            "Both programs integrate elements at four points here; this project's usual eleven "
            f"points change displacements by {usual:.2g} % on this coarse mesh."
        ],
    )


def _caption(one: Compared) -> str:
    """Caption of the chart of one deck's differences."""
    return (
        f"{one.label}: largest difference between CalculiX and this project, relative to the "
        "largest value of the load"
    )


def check(page: Page, one: Compared) -> None:
    """Each quantity is the same in both programs."""
    for quantity, values in one.differences.items():
        page.vanishes(
            f"{one.label}: {quantity}, largest difference of all unit loads",
            float(values.max()),
            within=TOLERANCE,
            why="ccx prints seven digits, an error of up to 5e-7 of the largest number; "
            "coordinates and coefficients of the deck have fourteen",
            source=f"CalculiX {ccx_version()} on the same deck, C3D10 at four points",
            band=ROUNDING,
        )


def add_results(page: Page, found: Sequence[Compared]) -> None:
    """Differences of all decks, their sizes, and reactions side by side."""
    page.section("Differences")
    for one in found:
        add_differences(page, one)
    page.table(
        "Decks, times and largest differences",
        [
            {
                "interface": one.label,
                "elements": one.elements,
                "nodes": one.nodes,
                "unknowns": one.unknowns,
                "deck [MB]": one.bytes / 1e6,
                "CalculiX [s]": one.theirs,
                "here, ten loads in any run [s]": one.ours,
                "largest difference [-]": _worst(one.differences),
                "with the usual integration here [-]": _worst(one.usual),
            }
            for one in found
        ],
    )
    page.section("Reactions side by side")
    for one in found:
        page.table(
            f"{one.label}: load on the main bearing for unit loads, here and by CalculiX",
            [
                {
                    "load": load,
                    **{
                        f"{component} {who}": float(reaction[row, k])
                        for component, row in (("Fy", 1), ("Fz", 2), ("My", 4))
                        for who, reaction in zip(("here", "ccx"), one.reactions, strict=True)
                    },
                }
                for k, load in enumerate(one.loads)
            ],
        )


def _worst(differences: Mapping[str, Floats]) -> float:
    return max(float(values.max()) for values in differences.values())


def add_differences(page: Page, one: Compared) -> None:
    """Chart of one deck's differences, by unit load."""

    def line(name: str, loads: Sequence[str], values: Floats, **style: Any) -> Any:
        return trace(name, [], values, **style) | {"x": list(loads)}

    lines = []
    for number, quantity in enumerate(QUANTITIES):
        for values, symbol, name in (
            (one.differences, "circle", quantity),
            (one.usual, "circle-open", f"{quantity}, usual integration here"),
        ):
            marker = {"symbol": symbol, "size": 9, "color": _COLOURS[number]}
            lines.append(line(name, one.loads, values[quantity], points=True, marker=marker))
    ends, bound = (one.loads[0], one.loads[-1]), np.full(2, TOLERANCE)
    lines.append(line("tolerance", ends, bound, line={"color": "#888888", "dash": "dot"}))
    page.chart(
        _caption(one),
        lines,
        "unit load",
        "relative difference [-]",
        "y",
    )
