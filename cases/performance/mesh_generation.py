"""What making a mesh takes beside solving on it: sizes, gmsh's options, structured meshes."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from typing import NamedTuple

import gmsh
import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.performance.studies import TETRAHEDRA, meridian_stiffness
from fe_drivetrain.cases.references import stiffness_choices as choices
from fe_drivetrain.cases.references.growing_shafts import MATERIAL, STEPPED
from fe_drivetrain.common import Floats, Times, held_to_one_thread, timed_runs
from fe_drivetrain.drivetrain_file import Scene, coarser_scene, library_scene
from fe_drivetrain.elasticity.mesh import (
    Mesh,
    inverted_cells,
    read_gmsh,
    relax_flat_cells,
    scaled_jacobians,
)
from fe_drivetrain.geometry import Housing, build, gmsh_session
from fe_drivetrain.report import error_bars, trace
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.shafts.response import Response, build_model, mesh_scene, unit_load_response

STAGES = ("surfaces", "volumes", "curved", "read")
SCENE = "main_bearing_spherical"
FACTORS, TURN = (2.0, 1.6, 1.3, 1.0, 0.8), 12
QUICK_FACTORS, QUICK_TURN = (3.0,), 6
REPEATS = 5
PER_ELEMENT = "Time for each element of meshing, and of ten unit loads; bars: all runs"
MESHING = "meshing, least [s]", "median [s]", "most [s]"
SOLVING = "ten unit loads, least [s]", "ten unit loads, median [s]", "ten unit loads, most [s]"
AT_BEST = "times as fast, at best"


class Option(NamedTuple):
    """A way to have gmsh fill volumes."""

    name: str
    settings: dict[str, float]
    threads: int = 1


OPTIONS = (
    Option("as in use: Delaunay, optimised", {}),
    Option("Delaunay, not optimised", {"Optimize": 0}),
    Option("Delaunay, optimised by Netgen too", {"OptimizeNetgen": 1}),
    Option("HXT, 1 thread", {"Algorithm3D": 10}),
    Option("HXT, 2 threads", {"Algorithm3D": 10}, 2),
)


class Made(NamedTuple):
    """A mesh as gmsh left it, curved and relaxed, and the wall time of each of `STAGES` [s]."""

    mesh: Mesh
    seconds: dict[str, float]

    @property
    def total(self) -> float:
        """Wall time of all stages [s]."""
        return sum(self.seconds.values())


def scene_of(run: Run, factor: float) -> Scene:
    """The library's scene with its mesh sizes times a factor."""
    return coarser_scene(library_scene(SCENE), factor, QUICK_TURN if run.quick else TURN)


@contextmanager
def parts_in_gmsh(scene: Scene, threads: int = 1) -> Iterator[list[str]]:
    """Open gmsh with the parts of a scene, housings as blocks; gives those with joints."""
    units = scene.bearing_units
    blocks = {u.bearing.name: u.housing for u in units if isinstance(u.housing, Housing)}
    bonded = frozenset(u.bearing.name for u in units if u.interface == "bonded")
    with gmsh_session(threads=threads):
        build(scene.shaft, [u.bearing for u in units], blocks, scene.mesh, bonded, scene.seats)
        yield [f"{name}.housing" for name in blocks if name not in bonded]


def made(scene: Scene, option: Option = OPTIONS[0]) -> Made:
    """The mesh of a scene, elements that fold over not meshed again."""
    with parts_in_gmsh(scene, option.threads) as joints:
        for name, value in option.settings.items():
            gmsh.option.setNumber(f"Mesh.{name}", value)
        clock = [time.perf_counter()]
        for dim in (2, 3):
            gmsh.model.mesh.generate(dim)
            clock.append(time.perf_counter())
        gmsh.model.mesh.setOrder(2)
        clock.append(time.perf_counter())
        mesh = relax_flat_cells(read_gmsh(joints))
        clock.append(time.perf_counter())
    return Made(mesh, dict(zip(STAGES, np.diff(clock).tolist(), strict=True)))


def alone(scene: Scene, part: str) -> tuple[int, float]:
    """Number of elements of one part, and time to fill its volume alone [s]."""
    with parts_in_gmsh(scene):
        entities = {
            gmsh.model.getPhysicalName(3, group): gmsh.model.getEntitiesForPhysicalGroup(3, group)
            for _, group in gmsh.model.getPhysicalGroups(3)
        }
        gmsh.model.mesh.generate(2)
        others = [(3, e) for name, of in entities.items() if name != part for e in of]
        gmsh.model.setVisibility(others, 0)
        gmsh.option.setNumber("Mesh.MeshOnlyVisible", 1)
        start = time.perf_counter()
        gmsh.model.mesh.generate(3)
        seconds = time.perf_counter() - start
        count = sum(len(gmsh.model.mesh.getElementsByType(4, e)[0]) for e in entities[part])
    return count, seconds


def median_stages(scene: Scene, repeats: int, option: Option = OPTIONS[0]) -> tuple[Made, Floats]:
    """A mesh with the median time of each stage, and (repeats,) total times [s]."""
    found = [made(scene, option) for _ in range(repeats)]
    middle = {s: float(np.median([one.seconds[s] for one in found])) for s in STAGES}
    return Made(found[0].mesh, middle), np.array([one.total for one in found])


def ten_unit_loads(scene: Scene, mesh: Mesh, repeats: int) -> tuple[Response, Times]:
    """Set up and solved so often, each time by a model of its own: one keeps what it has set up."""
    seconds = []
    for _ in range(repeats):
        model = build_model(scene, mesh)
        _ = model.stiffness  # parts are assembled
        response, once = timed_runs(partial(unit_load_response, model), 1)
        seconds.append(once.most)
    return response, Times(tuple(seconds))


def beside_solver(run: Run, page: Page, factors: tuple[float, ...], repeats: int) -> list[Record]:
    """Meshing and solving over sizes; a row for each."""
    rows: list[Record] = []
    for factor in factors:
        scene = scene_of(run, factor)
        run.report(f"sizes x {factor:g}")
        mesh, totals = median_stages(scene, repeats)
        folded = len(inverted_cells(mesh.mesh)) > 0  # then it is meshed again, finer
        sound = mesh_scene(scene) if folded else mesh.mesh
        with held_to_one_thread():  # as gmsh
            if not rows:
                unit_load_response(build_model(scene, sound))  # loops are compiled, or loaded
            response, solve = ten_unit_loads(scene, sound, repeats)
        n = len(mesh.mesh.cells)
        rows.append(
            {
                "sizes x": factor,
                "elements": n,
                "unknowns": response.diagnostics.n_unknowns,
                **{f"{stage} [s]": mesh.seconds[stage] for stage in STAGES},
                "meshing, least [s]": float(totals.min()),
                "median [s]": float(np.median(totals)),
                "most [s]": float(totals.max()),
                **solve.columns("ten unit loads"),
                "meshing [µs/element]": 1e6 * float(np.median(totals)) / n,
                "solve [µs/element]": 1e6 * solve.median / n,
            }
        )
    page.section("Over sizes")
    elements = [float(str(row["elements"])) for row in rows]
    page.chart(
        PER_ELEMENT,
        [
            trace(
                name,
                elements,
                [float(row[key]) for row in rows],
                mode="lines+markers",
                **error_bars(
                    "y", *([1e6 * row[end] / row["elements"] for row in rows] for end in ends)
                ),
            )
            for name, key, ends in (
                ("meshing", "meshing [µs/element]", MESHING),
                ("solve of ten unit loads", "solve [µs/element]", SOLVING),
            )
        ],
        "elements",
        "time per element [µs]",
        logarithmic="x",
    )
    page.table("Stages of meshing, and the solve, each on one thread", rows)
    page.data("over_sizes", rows)
    return rows


def answer(page: Page, sizes: list[Record], bound: Record) -> None:
    """State the share that meshing has, and what side by side could save of it."""
    last = sizes[-1]
    meshing, solving = float(last[MESHING[1]]), float(last[SOLVING[1]])
    page.answer(
        "How long does meshing take, compared with the solve?",
        f"Meshing {last['elements']:,} elements takes {value_text(meshing, 's')}, "
        f"{meshing / solving:.2g} times as long as solving for ten unit loads.",
        [
            page.value(
                "meshing [s]",
                meshing,
                beside=solving,
                by="solve",
            ),
            page.value("meshing, for each element [µs]", float(last["meshing [µs/element]"])),
            page.value(
                "solve of ten unit loads, for each element [µs]", float(last["solve [µs/element]"])
            ),
            page.value(
                "possible speed-up by meshing parts in parallel, at best", float(bound[AT_BEST])
            ),
        ],
        hero=PER_ELEMENT,
        cautions=["Meshing and solve run on one thread each."],
    )


def options(run: Run, page: Page, scene: Scene, repeats: int) -> Made:
    """Options of gmsh: time, and quality before anything is meshed again; the mesh as in use."""
    rows: list[Record] = []
    found: list[Made] = []
    for option in OPTIONS[:4:3] if run.quick else OPTIONS:
        run.report(option.name)
        mesh, totals = median_stages(scene, repeats, option)
        found.append(mesh)
        scaled = scaled_jacobians(mesh.mesh.points, mesh.mesh.cells)
        rows.append(
            {
                "option": option.name,
                "elements": len(scaled),
                "volumes [s]": mesh.seconds["volumes"],
                "all, least [s]": float(totals.min()),
                "median [s]": float(np.median(totals)),
                "most [s]": float(totals.max()),
                "least scaled Jacobian": float(scaled.min()),
                "its mean": float(scaled.mean()),
                "elements below 0.1": int((scaled < 0.1).sum()),
                "folded over": len(inverted_cells(mesh.mesh)),
            }
        )
    page.section("Options of gmsh")
    page.table(f"{SCENE}, {rows[0]['elements']:,} elements as in use", rows)
    page.data("options", rows)
    again = made(scene)
    page.holds(
        "gmsh makes the same mesh again, to the last node",
        bool(np.array_equal(found[0].mesh.points, again.mesh.points)),
        why="one thread, and its random seed is set",
        source="the mesh made before",
    )
    return found[0]


def parts_apart(page: Page, scene: Scene, whole: Made, repeats: int) -> Record:
    """What meshing each part in a process of its own could save."""
    rows: list[Record] = []
    for number, part in enumerate(whole.mesh.part_names):
        runs = [alone(scene, part) for _ in range(repeats)]
        (count, _), times = runs[0], Times(tuple(seconds for _, seconds in runs))
        together = int((whole.mesh.part == number).sum())
        rows.append(
            {
                "part": part,
                "elements": count,
                "elements when meshed together": together,
                **times.columns("its volume"),
            }
        )
    longest = max(float(str(row["its volume, median [s]"])) for row in rows)
    volumes = whole.seconds["volumes"]
    apart = whole.total - volumes + longest
    bound: Record = {
        "all volumes, one after the other [s]": volumes,
        "longest volume alone [s]": longest,
        "meshing, as in use [s]": whole.total,
        "meshing, volumes side by side, at best [s]": apart,
        AT_BEST: whole.total / apart,
    }
    page.section("Parts in processes of their own")
    page.table(
        f"Time to fill the volume of each part, its surfaces being there, runs of each: {repeats}",
        rows,
    )
    page.table(
        "Bound of what that could save: medians, and the surfaces, which parts share, meshed once",
        [bound],
    )
    page.text(
        "Each process would mesh the surfaces again, or wait for them. The start of processes and "
        "the transport of meshes are not in the bound."
    )
    page.data("parts", bound)
    return bound


def structured(run: Run, page: Page, quick: bool, repeats: int) -> None:
    """Tetrahedra of gmsh beside swept hexahedra, at equal errors."""
    reference = meridian_stiffness(STEPPED, MATERIAL, *((4, 3) if quick else (9, 10)))
    levels = [
        choices.Level(choices.CURVED, *size) for size in (TETRAHEDRA[:1] if quick else TETRAHEDRA)
    ]
    levels += [
        choices.Level("hex 27", 0.4, 8, refinement=cut) for cut in ((1,) if quick else (1, 2, 3))
    ]
    rows: list[Record] = []
    for level in levels:
        run.report(f"shaft: {level.element}, {level.name}")
        (found,) = choices.shaft_outcomes(
            STEPPED, MATERIAL, level, [choices.Solve("auto")], repeats
        )
        rows.append(
            {
                "element": level.element,
                "mesh": level.name,
                "unknowns": found.unknowns,
                "error, torsional [%]": 100.0 * abs(float(found.values[0] / reference[0]) - 1.0),
                "runs": found.runs,
                "meshing, least [s]": found.times["mesh"].least,
                "meshing [s]": found.seconds["mesh"],
                "meshing, most [s]": found.times["mesh"].most,
                "all [s]": found.total,
            }
        )
    page.section("Swept hexahedra")
    page.chart(
        "Stepped hollow shaft: error of the torsional stiffness over the time of meshing",
        [
            trace(
                element,
                [float(str(row["meshing [s]"])) for row in rows if row["element"] == element],
                [
                    float(str(row["error, torsional [%]"]))
                    for row in rows
                    if row["element"] == element
                ],
                True,
            )
            for element in (choices.CURVED, "hex 27")
        ],
        "meshing [s]",
        "error [%]",
        logarithmic="xy",
    )
    page.table("Against the shaft in harmonics from its meridian, rigid ends", rows)
    page.data("structured", rows)


@case(
    "Mesh generation beside the solve",
    source="wall time of gmsh's stages, and of the solver on the same mesh",
    settings={"repeats": "5 (quick 1; from 1)"},
    alone="full",
)
def run(run: Run, page: Page) -> None:
    """Time meshing over sizes, by gmsh's options, by part, and swept."""
    factors = QUICK_FACTORS if run.quick else FACTORS
    repeats = run.count("repeats", 1 if run.quick else REPEATS)
    scene = scene_of(run, factors[0] if run.quick else 1.0)
    with run.step("over sizes"):
        sizes = beside_solver(run, page, factors, repeats)
    with run.step("options of gmsh"):
        whole = options(run, page, scene, repeats)
    with run.step("parts apart"):
        bound = parts_apart(page, scene, whole, repeats)
    answer(page, sizes, bound)
    with run.step("swept hexahedra"):
        structured(run, page, run.quick, repeats)
