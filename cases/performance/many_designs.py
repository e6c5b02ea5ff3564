"""Many designs as solids: samples a minute with what neighbours leave, and each for itself.

A sweep of bores, as `compare --vary` has it, and samples of uncertain values, as `uncertainty` has
them at level 4. Every pair of times is of one design, one after the other, in one run.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from statistics import median
from typing import TypeVar

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.common import MOTIONS, Cache, Floats
from fe_drivetrain.drivetrain_file import Scene, library_scene
from fe_drivetrain.report import trace
from fe_drivetrain.report.suite import Page, Record, Run, column
from fe_drivetrain.shafts.fidelity import Quantity, banded_assembly
from fe_drivetrain.shafts.response import (
    GROWTH,
    LOADS,
    NOTHING,
    Neighbours,
    Response,
    build_model,
    unit_load_response,
)
from fe_drivetrain.shafts.uncertainty import (
    SAMPLED_ERROR,
    AssemblySamples,
    assembly_of,
    latin_hypercube,
    sensitivities,
    with_values,
)

SCENE = "main_bearing_bonded_uncertain"
BORE = "shaft.sections.0.inner_diameter"
BORES = (0.16, 0.25)
"""Bores of the sweep [m]; the shaft has 0.4 m outside."""
SWEPT = 20
"""Bores between these; a quick run has the first few."""
QUANTITY = "main_bearing.My"
SIZE, QUICK_SIZE = 1.0, 2.0
"""Factors on the sizes of the scene's elements."""

HUB = tuple(f"hub.stiffness.{motion}" for motion in MOTIONS)
OWN, REUSED = "each for itself", "from neighbours"
ITERATIONS = "Iterations of each design of a sweep of bores"
TIMES = "Time of each design: meshed and solved for itself, and from neighbours"

_T = TypeVar("_T")


@dataclass(frozen=True)
class Pairs:
    """Designs solved both ways.

    Attributes
    ----------
    rows : list of Record
        Times [s] and iterations of each design, both ways.
    apart : Mapping[str, float]
        Largest relative difference of each number between the two ways, over all designs.
    """

    rows: list[Record]
    apart: Mapping[str, float]

    @property
    def ratios(self) -> list[float]:
        """Time for itself over that from neighbours, of designs that had neighbours."""
        return [float(r[f"{OWN} [s]"]) / float(r[f"{REUSED} [s]"]) for r in self.near]

    @property
    def near(self) -> list[Record]:
        """Those that were not meshed."""
        return [row for row in self.rows if not row["meshed because"]]

    def a_minute(self, way: str) -> float:
        """Designs a minute, by the median time."""
        return 60.0 / median(float(row[f"{way} [s]"]) for row in self.near)


@case(
    "Many designs as solids: samples a minute, for themselves and from neighbours",
    source="the same designs meshed and solved one by one, measured in one run",
    settings={"designs": "20 (quick 4; from 3)", "samples": "100 (quick 4; from 4)"},
    changes="scene",
    alone="full",
)
def run(run: Run, page: Page) -> None:
    """Solve a sweep and samples both ways."""
    scene = library_scene(SCENE)
    size = QUICK_SIZE if run.quick else SIZE
    scene = scene.model_copy(update={"mesh": scene.mesh.scaled(size)})
    page.about(scene)
    designs = run.count("designs", 4 if run.quick else SWEPT, least=3)
    samples = run.count("samples", 4 if run.quick else 100, least=4)
    with run.step("compile"):
        alone(scene.model_copy(update={"mesh": scene.mesh.scaled(2.0 / size)}))
    with run.step("bands"):
        load = np.zeros(len(LOADS))
        load[LOADS.index("hub.My")] = 1e6
        bands = banded_assembly(scene, [Quantity(name) for name in HUB], run.report)[2]
        band = {name: one.half_width for name, one in zip(HUB, bands, strict=True)}
    with run.step("sweep"):
        swept, same = sweep(scene, designs, run)
    with run.step("samples"):
        at = assembly_of(scene, [QUANTITY], load, run.report)
        sampled = samples_of(scene, at, samples, 1 if run.quick else 5, run)
    check(page, swept, sampled, same, band)
    show(page, swept, sampled, designs)
    answer(page, swept, sampled, band)


def alone(scene: Scene) -> Response:
    """Mesh a design and solve it, from nothing."""
    return unit_load_response(Neighbours(NOTHING, meshes=Cache(None)).model(scene))


def clocked(work: Callable[[], _T]) -> tuple[_T, float]:
    """A result, and the wall time that it took [s]."""
    start = time.perf_counter()
    found = work()
    return found, time.perf_counter() - start


def stiffness(response: Response) -> Floats:
    """(6,) force over motion of the hub."""
    return np.asarray(1.0 / response.motions["hub"][:, :6].diagonal())


def sweep(scene: Scene, count: int, run: Run) -> tuple[Pairs, float]:
    """Solve the sweep both ways; and how far reuse is off on one and the same mesh."""
    near, rows = Neighbours(meshes=Cache(None)), []
    apart = dict.fromkeys(HUB, 0.0)
    same = 0.0

    def moved(changed: Scene) -> Response:
        return unit_load_response(near.model(changed))

    for number, bore in enumerate(np.linspace(*BORES, max(count, SWEPT))[:count].tolist(), 1):
        run.report(f"sweep ({number} of {count})")
        changed = with_values(scene, {BORE: bore})
        own, seconds = clocked(partial(alone, changed))
        found, reused = clocked(partial(moved, changed))
        step = near.steps[-1]
        rows.append(
            {
                "bore [m]": bore,
                f"{OWN} [s]": seconds,
                f"{REUSED} [s]": reused,
                f"iterations, {OWN}": own.diagnostics.iterations,
                f"iterations, {REUSED}": step.iterations,
                "error at the start": step.started,
                "largest stretch of an edge": step.stretch,
                "meshed because": step.meshed,
            }
        )
        off = np.abs(stiffness(found) / stiffness(own) - 1.0)
        apart = {name: max(apart[name], float(o)) for name, o in zip(HUB, off, strict=True)}
        if number == count:
            model = near.model(changed)
            exact = unit_load_response(build_model(changed, model.mesh))
            same = float(np.abs(stiffness(found) / stiffness(exact) - 1.0).max())
    return Pairs(rows, apart), same


def samples_of(scene: Scene, at: AssemblySamples, count: int, every: int, run: Run) -> Pairs:
    """Solve samples of the uncertain values from neighbours, and some of them for themselves."""
    keys, inputs = latin_hypercube(scene, count)
    sensitivities(scene, at.evaluate, keys)  # as the study does before its samples
    rows: list[Record] = []
    apart = {number.name: 0.0 for number in at.numbers}
    for number, row in enumerate(inputs):
        run.report(f"samples ({number + 1} of {count})")
        changed = with_values(scene, dict(zip(keys, row.tolist(), strict=True)))
        values, reused = clocked(partial(at.sampled, changed))
        step = at.neighbours.steps[-1]
        if number % every:
            continue
        own = AssemblySamples(
            at.numbers, at.bands, at.columns, Neighbours(NOTHING, meshes=Cache(None))
        )
        exact, seconds = clocked(partial(own.evaluate, changed))
        rows.append(
            {
                "sample": number + 1,
                f"{OWN} [s]": seconds,
                f"{REUSED} [s]": reused,
                f"iterations, {REUSED}": step.iterations,
                "error at the start": step.started,
                "largest stretch of an edge": step.stretch,
                "meshed because": step.meshed,
            }
        )
        for name, value in values.items():
            apart[name] = max(apart[name], abs(value / exact[name] - 1.0))
    return Pairs(rows, apart)


def check(page: Page, swept: Pairs, sampled: Pairs, same: float, band: Mapping[str, float]) -> None:
    """Results from neighbours against those of each design for itself."""
    page.vanishes(
        "stiffness of the hub on one mesh, from neighbours and for itself, relative",
        same,
        within=1e-9,
        why="iterations end at an energy error of 1e-10, and the stiffness has its square",
        source="the last design of the sweep, solved from zero with a hierarchy of its own",
        measure="identity",
    )
    for what, pairs in (("sweep", swept), ("samples", sampled)):
        for name in HUB:
            page.at_most(
                f"{what}: {name}, moved meshes against meshes of their own, relative",
                pairs.apart[name],
                band[name],
                why="the band of the level: how far one mesh is from element size zero",
                source="each design meshed and solved for itself",
            )


def show(page: Page, swept: Pairs, sampled: Pairs, designs: int) -> None:
    """Show times and iterations of every design."""
    page.section("A sweep of bores")
    bores = column(swept.rows, "bore [m]")
    page.chart(
        ITERATIONS,
        [
            trace(way, bores, column(swept.rows, f"iterations, {way}"), points=True)
            for way in (OWN, REUSED)
        ],
        "bore [m]",
        "iterations [-]",
    )
    page.chart(
        TIMES,
        [trace(way, bores, column(swept.rows, f"{way} [s]"), points=True) for way in (OWN, REUSED)],
        "bore [m]",
        "time [s]",
    )
    page.table(f"Each of {designs} bores", swept.rows)
    page.section("Samples of uncertain values")
    page.table("Samples that were solved both ways", sampled.rows)
    page.table("Both ways side by side", [*_sides("sweep", swept), *_sides("samples", sampled)])
    page.text(
        "From neighbours: the mesh of a design is moved as its surfaces do, its inside by "
        "Laplace's equation, as long as no element loses half of its shape and no edge changes by "
        "more than 15 %; else the design is meshed. Its factor or hierarchy is the first design's, "
        f"until iterations for each decade of the error are {GROWTH:g} times as many. They start "
        "with Galerkin's solution in the space of the solutions so far, and end at the same error "
        f"as from zero; those of samples where numbers are known to {SAMPLED_ERROR:g}, and only "
        "the loads that are asked for are solved. For itself, a design is meshed by gmsh, set up "
        "and solved from zero."
    )


def _sides(what: str, pairs: Pairs) -> list[Record]:
    return [
        {
            "designs": f"{what}, {way}",
            "least [s]": min(times),
            "median [s]": median(times),
            "most [s]": max(times),
            "a minute": pairs.a_minute(way),
        }
        for way in (OWN, REUSED)
        for times in [[float(row[f"{way} [s]"]) for row in pairs.near]]
    ]


def _ratio(ratios: Sequence[float]) -> str:
    return f"{median(ratios):.2g} ({min(ratios):.2g} to {max(ratios):.2g})"


def answer(page: Page, swept: Pairs, sampled: Pairs, band: Mapping[str, float]) -> None:
    """State designs a minute, both ways."""
    minute = sampled.a_minute(REUSED)
    page.answer(
        "How many designs a minute can a solid-element assembly compute?",
        f"A solid assembly computes {minute:.3g} samples a minute when each starts from its "
        f"neighbour, {sampled.a_minute(OWN):.3g} otherwise; sweeps over bores "
        f"{swept.a_minute(REUSED):.3g} against {swept.a_minute(OWN):.3g}.",
        [
            page.value(
                "samples a minute, from neighbours",
                minute,
                beside=sampled.a_minute(OWN),
                by="otherwise",
            ),
            page.value(
                "bores of a sweep a minute, from neighbours",
                swept.a_minute(REUSED),
                beside=swept.a_minute(OWN),
                by="otherwise",
            ),
            page.value(
                "largest difference of the hub's stiffness from a new mesh [%]",
                100.0 * max(max(p.apart[name] for name in HUB) for p in (swept, sampled)),
                beside=100.0 * max(band.values()),
                by="mesh error",
            ),
            page.value(
                "iterations of the last bore of the sweep",
                float(swept.near[-1][f"iterations, {REUSED}"]),
                beside=float(swept.near[-1][f"iterations, {OWN}"]),
                by="from zero",
            ),
        ],
        hero=ITERATIONS,
        cautions=[
            "Times are wall times, both ways measured in turn; designs that needed a new mesh do "
            "not count.",
            "All designs are of one drivetrain file, a bonded main bearing.",
        ],
    )
    page.say(
        f"Time for itself over time from a neighbour: samples {_ratio(sampled.ratios)}, bores of a "
        f"sweep {_ratio(swept.ratios)}."
    )
    for name, pairs in (("sweep", swept), ("samples", sampled)):
        page.data(name, {"ratios": pairs.ratios, "apart": dict(pairs.apart), "rows": pairs.rows})
