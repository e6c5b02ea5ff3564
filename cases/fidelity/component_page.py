"""What cases of components share: levels compared, the band of the solid, files, a picture."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from fe_drivetrain import export
from fe_drivetrain.common import Floats, largest_difference
from fe_drivetrain.compare import GridConvergence, grid_convergence
from fe_drivetrain.export import Superelement, from_scene
from fe_drivetrain.fidelity import (
    LEAST_ORDER,
    LevelModel,
    SolidComponent,
    frame_levels,
    solid_component,
    solid_level,
)
from fe_drivetrain.report import (
    AssumptionRow,
    Cell,
    Image,
    NoPictureError,
    Section,
    Table,
    Text,
    Verdict,
    chart,
    judge,
    picture_of_displacements,
    trace,
)
from fe_drivetrain.scene import Component, SomeComponent
from fe_drivetrain.suite import Run

#: Coarsening of the mesh under --quick.
QUICK = 1.8

#: Factors on mesh sizes of the two coarser solids that give the finest its band.
COARSER = (1.8, from_scene.COARSER)

#: Allowed error of the level that is recommended.
TOLERANCE = 0.1

#: What an iterative solver's energy error of 1e-9 leaves of balances and symmetries, with two
#: digits to spare for the motions that are small beside the largest.
SOLVED = 1e-7
SOLVED_REASON = (
    "holds exactly; systems are solved to an energy error of 1e-9, and two digits are left for "
    "motions that are small beside the largest"
)

_LEAST = 1e-6  # per cent: what is exact has a place on a logarithmic axis


def coarser(component: SomeComponent, factor: float) -> SomeComponent:
    """The component with its mesh sizes times a factor."""
    return component.model_copy(update={"mesh": component.mesh.scaled(factor)})


@dataclass(frozen=True)
class Ladder:
    """The levels of a component, from cheap to dear, the last the solid.

    Attributes
    ----------
    models, seconds
        Each level and its wall time, meshes included.
    solids
        The solids, of the coarsest mesh first.
    coarse
        Levels of all solids but the finest.
    """

    models: Sequence[LevelModel]
    seconds: Sequence[float]
    solids: Sequence[SolidComponent]
    coarse: Sequence[LevelModel]

    @property
    def solid(self) -> SolidComponent:
        """The solid of the finest mesh."""
        return self.solids[-1]

    @property
    def top(self) -> LevelModel:
        """The solid."""
        return self.models[-1]

    def band(self, quantity: Callable[[LevelModel], float]) -> GridConvergence:
        """What the three solids say of a quantity."""
        values = [quantity(model) for model in (*self.coarse, self.top)]
        return band_of([solid.sizes.edge for solid in self.solids], values)


def band_of(sizes: Sequence[float], values: Sequence[float]) -> GridConvergence:
    """What meshes say of a quantity, coarse first; their sizes may be finer than asked for.

    Raises
    ------
    InputError
        A coarse mesh had to be made as fine as a finer one.
    """
    return grid_convergence(sizes, values, least_order=LEAST_ORDER)


def climb(run: Run, component: SomeComponent) -> Ladder:
    """Solve a component at every level, and its solid on two coarser meshes, too."""
    models, seconds, coarse, solids = [], [], [], []
    with run.step("frames"):
        makers = frame_levels(component)
        makers[-1]()  # what is compiled or loaded at first use is no part of the cost
        for make in makers:
            start = time.perf_counter()
            models.append(make())
            seconds.append(time.perf_counter() - start)
    for factor in COARSER:
        with run.step(f"solid, sizes times {factor:g}"):
            rough = coarser(component, factor)
            solids.append(solid_component(rough))
            coarse.append(solid_level(rough, solids[-1]))
    with run.step("solid"):
        start = time.perf_counter()
        solids.append(solid_component(component))
        models.append(solid_level(component, solids[-1]))
        seconds.append(time.perf_counter() - start)
    return Ladder(models, seconds, solids, coarse)


@dataclass(frozen=True)
class Quantity:
    """A number that levels are asked for.

    Attributes
    ----------
    name, unit
        For headings.
    of
        Its value at a level; NaN where the level cannot tell.
    """

    name: str
    unit: str
    of: Callable[[LevelModel], float]


def ladder_section(ladder: Ladder, quantities: Sequence[Quantity]) -> tuple[Section, Verdict, str]:
    """Levels compared: value, error against the solid, its band, time, what is neglected.

    Returns
    -------
    The section, whether some level is known to be within `TOLERANCE` in the first quantity, and
    the answer in a sentence.
    """
    rows: list[list[Cell]] = []
    traces: list[Any] = []
    bands = [ladder.band(quantity.of) for quantity in quantities]
    times = ladder.seconds
    errors_of = [
        [abs(quantity.of(model) / quantity.of(ladder.top) - 1.0) for model in ladder.models]
        for quantity in quantities
    ]
    for model, seconds, error in zip(ladder.models, times, errors_of[0], strict=True):
        is_top = model is ladder.top
        known = bands[0].relative_uncertainty if is_top else error
        rows.append(
            [
                f"{model.level} {model.title}",
                _cell(quantities[0].of(model)),
                _cell(100 * error),
                100 * known if is_top else None,
                seconds,
                times[-1] / seconds,
                "; ".join(model.neglects) or "nothing that the component has",
            ]
        )
        if np.isfinite(known):
            title = f"level {model.level}, {model.title}"
            at = [seconds], [max(100 * known, _LEAST)]
            traces.append(trace(title, *at, points=True, marker={"size": 11}))
    limit = 100 * TOLERANCE
    traces.append(trace("tolerance", [min(times), max(times)], [limit] * 2, line={"dash": "dash"}))
    first, band = quantities[0], bands[0]
    known_errors = [
        error + band.relative_uncertainty if model is not ladder.top else band.relative_uncertainty
        for model, error in zip(ladder.models, errors_of[0], strict=True)
    ]
    enough = [k for k, error in enumerate(known_errors) if error <= TOLERANCE]
    chosen = enough[0] if enough else len(ladder.models) - 1
    model = ladder.models[chosen]
    share = f"{100 * TOLERANCE:g} %"
    if model is ladder.top:
        sentence = (
            f"{first.name} within {share} needs level {model.level}, {model.title}: "
            f"band ± {100 * band.relative_uncertainty:.2g} %"
        )
    else:
        sentence = (
            f"{first.name} within {share}: level {model.level}, {model.title}, is enough: "
            f"{100 * errors_of[0][chosen]:.2g} % from the solid (± "
            f"{100 * band.relative_uncertainty:.2g} %), and {times[-1] / times[chosen]:.3g} times "
            "faster"
        )
    sentence = _capital(sentence)
    verdict = judge(
        f"{first.name}: error of level {model.level}, {model.title}, and band of the solid",
        known_errors[chosen],
        0.0,
        tolerance=TOLERANCE,
        relative=False,
        source="the solid and its grid convergence",
        reason="asked for",
    )
    table = Table(
        caption=_capital(f"{first.name} at each level"),
        columns=[
            "level",
            f"value [{first.unit}]",
            "error against the solid [%]",
            "band ± [%]",
            "time [s]",
            "times faster than the solid",
            "neglects",
        ],
        rows=rows,
    )
    others = Table(
        caption="All quantities: the solid, its band, and the error of the levels below it",
        columns=[
            "quantity",
            "unit",
            "solid",
            "band ± [%]",
            *(f"{model.title} [%]" for model in ladder.models[:-1]),
        ],
        rows=[
            [
                quantity.name,
                quantity.unit,
                quantity.of(ladder.top),
                100 * found.relative_uncertainty,
                *(_cell(100 * error) for error in errors[:-1]),
            ]
            for quantity, found, errors in zip(quantities, bands, errors_of, strict=True)
        ],
    )
    picture = chart(
        _capital(f"{first.name}: error against time; of the solid its own band"),
        traces,
        x="time [s]",
        y="error [%]",
        logarithmic=("x", "y"),
    )
    said = "; ".join(
        f"{q.name}: {b.sentence(q.unit)}" for q, b in zip(quantities, bands, strict=True)
    )
    note = Text(
        text=f"Band: three meshes, sizes times {COARSER[0]:g}, {COARSER[1]:g} and 1. Stress is "
        "singular at inner edges, energy converges there as h^1.09 at best (Williams 1952), and "
        f"coarse meshes are not there yet: no better order than {LEAST_ORDER:g} is relied upon. "
        f"{said}."
    )
    return (
        Section(title="The ladder", items=[Text(text=sentence), picture, table, others, note]),
        verdict,
        sentence,
    )


def _capital(text: str) -> str:
    return text[0].upper() + text[1:]


def _cell(value: float) -> Cell:
    return value if np.isfinite(value) else None


def files_section(run: Run, element: Superelement) -> tuple[Section, Verdict]:
    """Write a superelement in every format that can be read back here, and read it again."""
    rows: list[list[Cell]] = []
    worst = 0.0
    with run.step("export"):
        for name, form in export.FORMATS.items():
            module = export.format_module(name)
            if form.extra or not hasattr(module, "read") or name == "mtx-mass":
                continue
            path = run.folder / f"{element.name}_{name}{form.suffix}"
            export.write(path, element, name)
            back = export.read(path, name)
            changed = largest_difference(back.stiffness, element.stiffness)
            worst = max(worst, changed)
            rows.append([name, path.name, path.stat().st_size, changed, 10.0**-form.digits])
    table = Table(
        caption=f"{element.name} at {', '.join(element.points)}: stiffness read back",
        columns=["format", "file", "bytes", "change over the diagonal [-]", "the format keeps [-]"],
        rows=rows,
    )
    verdict = judge(
        "stiffness read back from files, largest change over the diagonal",
        worst,
        0.0,
        tolerance=1e-9,
        relative=False,
        unit="-",
        source="the superelement that was written",
        reason="the format with the fewest digits keeps 10",
        measure="identity",
    )
    band = "not known" if element.band is None else f"{100 * element.band:.2g} %"
    text = Text(
        text=f"Free at its points, with mass; band of the stiffness {band} of the diagonal, from a "
        f"coarser mesh. `fe-drivetrain export {element.name} --format json --out FILE` writes the "
        "same."
    )
    return Section(title="Exported", items=[text, table]), verdict


def picture_section(run: Run, solid: SolidComponent, motions: Floats, what: str) -> Section:
    """The solid, deformed."""
    with run.step("picture"):
        try:
            u = solid.displacements(motions)
            factor = picture_of_displacements(solid.mesh, u, run.folder / "deformed.png")
        except NoPictureError as reason:
            return Section(title="Deformed", items=[Text(text=f"No picture: {reason}")])
    caption = f"{what}; displacements times {factor:g}, and the elements' edges"
    return Section(title="Deformed", items=[Image(caption=caption, file="deformed.png")])


def assumption_rows(component: Component) -> list[AssumptionRow]:
    """The body's dimensions, and where each comes from."""
    return [
        AssumptionRow(name=a.name, value=a.value, unit=a.unit, source=a.source)
        for a in component.body.assumptions()
    ]


def rigid_verdict(element: Superelement) -> Verdict:
    """No force against a rigid motion of the free solid."""
    return judge(
        "free solid: force against rigid motions, of those that its terms have one by one",
        element.rigid_error(),
        0.0,
        tolerance=1e-12,
        relative=False,
        unit="-",
        source="a body that moves as a whole is not strained",
        reason="the condensed stiffness is made of flexibilities between points, so that only "
        "round-off of its products is left",
        measure="identity",
    )
