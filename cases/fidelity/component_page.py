"""What cases of components share: levels compared, the band of the solid, files, a picture."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain import export
from fe_drivetrain.common import (
    Floats,
    max_difference,
)
from fe_drivetrain.comparison import GridConvergence, grid_convergence
from fe_drivetrain.drivetrain_file import Component, SomeComponent, material_of
from fe_drivetrain.elasticity.mesh import mean_size
from fe_drivetrain.export import (
    Superelement,
)
from fe_drivetrain.pages import QUICK_BAND
from fe_drivetrain.plots.figures import error_range, error_traces
from fe_drivetrain.report import (
    Cell,
    Chart,
    NoPictureError,
    Solid,
    chart,
    picture_of_displacements,
    write_solid_view,
)
from fe_drivetrain.report.suite import Page, Run, column
from fe_drivetrain.shafts.fidelity import (
    COARSER,
    MIN_ORDER,
    LevelModel,
    SolidComponent,
    coarser,
    frame_levels,
    solid_component,
    solid_level,
)

#: Coarsening of the mesh under --quick.
QUICK = 2.2

#: Allowed error of the level that is recommended.
TOLERANCE = 0.1

#: What an iterative solver's energy error of 1e-9 leaves of balances and symmetries, with two
#: digits to spare for the motions that are small beside the largest.
SOLVED = 1e-7
SOLVED_REASON = (
    "holds exactly; systems are solved to an energy error of 1e-9, and two digits are left for "
    "motions that are small beside the largest"
)

_CHANGE = "change over the diagonal [-]"


@dataclass(frozen=True)
class Ladder:
    """The levels of a component, from cheap to expensive, the last the solid.

    Attributes
    ----------
    models, seconds : sequence of LevelModel, of float
        Each level and its wall time, meshes included.
    solids : sequence of SolidComponent
        The solids, of the coarsest mesh first.
    coarse : sequence of LevelModel
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
        return band_of([mean_size(solid.mesh) for solid in self.solids], values)


def band_of(sizes: Sequence[float], values: Sequence[float]) -> GridConvergence:
    """What meshes say of a quantity, coarse first; their sizes may be finer than asked for.

    Raises
    ------
    InputError
        A coarse mesh had to be made as fine as a finer one.
    """
    return grid_convergence(sizes, values, min_order=MIN_ORDER)


def all_levels(run: Run, component: SomeComponent) -> Ladder:
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
    name, unit : str
        For headings.
    of : callable
        Its value at a level; NaN where the level cannot tell.
    """

    name: str
    unit: str
    of: Callable[[LevelModel], float]


@dataclass(frozen=True, eq=False)
class Compared:
    """Levels of a component compared by several quantities, the first of which decides.

    Attributes
    ----------
    ladder : Ladder
        The levels.
    quantities : sequence of Quantity
        What they are compared by.
    bands : sequence of GridConvergence
        What the solids say of each quantity.
    errors : sequence of sequence of float
        By quantity and level: error against the solid.
    """

    ladder: Ladder
    quantities: Sequence[Quantity]
    bands: Sequence[GridConvergence]
    errors: Sequence[Sequence[float]]

    @classmethod
    def of(cls, ladder: Ladder, quantities: Sequence[Quantity]) -> Compared:
        """Compare all levels with the solid."""
        errors = [
            [abs(q.of(model) / q.of(ladder.top) - 1.0) for model in ladder.models]
            for q in quantities
        ]
        return cls(ladder, quantities, [ladder.band(q.of) for q in quantities], errors)

    @property
    def first(self) -> Quantity:
        """The quantity that decides."""
        return self.quantities[0]

    @property
    def own(self) -> float:
        """Band of the solid in that quantity, relative."""
        return self.bands[0].relative_uncertainty

    @property
    def known_errors(self) -> list[float]:
        """Error of each level in that quantity and band of the solid."""
        return [
            self.own if model is self.ladder.top else error + self.own
            for model, error in zip(self.ladder.models, self.errors[0], strict=True)
        ]

    @property
    def chosen(self) -> int:
        """Place of the cheapest level within `TOLERANCE`; the solid where there is none."""
        enough = [k for k, error in enumerate(self.known_errors) if error <= TOLERANCE]
        return enough[0] if enough else len(self.ladder.models) - 1

    @property
    def caption(self) -> str:
        """Caption of the chart of errors against time."""
        known = self.known_errors[self.chosen] <= TOLERANCE
        enough = "the chosen level is enough" if known else "none is accurate enough"
        return _capital(f"{self.first.name}: error against time, bars: band of the solid; {enough}")

    def sentence(self) -> str:
        """The level that is enough, and how far it is from the solid."""
        chosen, times = self.chosen, self.ladder.seconds
        model = self.ladder.models[chosen]
        share = f"{100 * TOLERANCE:g} %"
        if model is self.ladder.top:
            return (
                f"{self.first.name} within {share} needs level {model.level}, {model.title}: "
                f"band ± {100 * self.own:.2g} %"
            )
        return (
            f"{self.first.name} within {share}: level {model.level}, {model.title}, is enough: "
            f"{100 * self.errors[0][chosen]:.2g} % from the solid (± {100 * self.own:.2g} %), and "
            f"{times[-1] / times[chosen]:.3g} times faster"
        )


def show_ladder(run: Run, page: Page, ladder: Ladder, quantities: Sequence[Quantity]) -> Compared:
    """Levels compared: value, error against the solid, its band, time, what is neglected.

    Parameters
    ----------
    run : Run
        Whether the mesh is the component's own, or a quick run's.
    page : Page
        Takes the check whether some level is known to be within `TOLERANCE` in the first quantity,
        and the section.
    ladder : Ladder
        The levels.
    quantities : sequence of Quantity
        What they are compared by; the first decides.

    Returns
    -------
    Compared
        The levels by all quantities.
    """
    found = Compared.of(ladder, quantities)
    if run.quick:
        page.say(QUICK_BAND)
    else:
        model = ladder.models[found.chosen]
        page.at_most(
            f"{found.first.name}: error of level {model.level}, {model.title}, and band of the "
            "solid",
            found.known_errors[found.chosen],
            TOLERANCE,
            why="the tolerance that was requested",
            source="the solid and its grid convergence",
        )
    page.section("The ladder")
    page.text(_capital(found.sentence()))
    page.add(_against_time(found))
    _level_table(page, found)
    _quantity_tables(page, found)
    page.text(
        f"Band: three meshes, sizes times {COARSER[0]:g}, {COARSER[1]:g} and 1. Stress is "
        "singular at inner edges, energy converges there as h^1.09 at best (Williams 1952), and "
        f"coarse meshes are not there yet: no better order than {MIN_ORDER:g} is relied upon."
    )
    return found


def _level_table(page: Page, found: Compared) -> None:
    """The deciding quantity at each level: error, band, time, what is neglected."""
    ladder, first = found.ladder, found.first
    times = ladder.seconds
    page.table(
        _capital(f"{first.name} at each level"),
        [
            {
                "level": f"{model.level} {model.title}",
                f"value [{first.unit}]": _cell(first.of(model)),
                "error against the solid [%]": _cell(100 * error),
                "band ± [%]": 100 * found.own if model is ladder.top else None,
                "time [s]": seconds,
                "times faster than the solid": times[-1] / seconds,
                "neglects": "; ".join(model.neglects) or "nothing that the component has",
            }
            for model, seconds, error in zip(ladder.models, times, found.errors[0], strict=True)
        ],
    )


def _quantity_tables(page: Page, found: Compared) -> None:
    """All quantities at each level, and on each mesh of the solid."""
    below = found.ladder.models[:-1]
    page.table(
        "All quantities: the solid, its band, and the error of the levels below it",
        [
            [
                quantity.name,
                quantity.unit,
                quantity.of(found.ladder.top),
                100 * band.relative_uncertainty,
                *(_cell(100 * error) for error in errors[:-1]),
            ]
            for quantity, band, errors in zip(
                found.quantities, found.bands, found.errors, strict=True
            )
        ],
        ["quantity", "unit", "solid", "band ± [%]", *(f"{model.title} [%]" for model in below)],
    )
    page.table(
        "The solid's series of meshes",
        [
            {
                "quantity": quantity.name,
                "unit": quantity.unit,
                "finest mesh": band.finest,
                "convergence": band.behaviour,
                "order": _cell(band.order),
                "extrapolated": band.extrapolated,
                "band": band.uncertainty,
            }
            for quantity, band in zip(found.quantities, found.bands, strict=True)
        ],
    )


def _against_time(found: Compared) -> Chart:
    """Error of each level over its time, with the band of the solid; of the solid its own band."""
    below, times = len(found.ladder.models) - 1, found.ladder.seconds
    traces = error_traces(
        [f"level {model.level}, {model.title}" for model in found.ladder.models],
        times,
        [*found.errors[0][:-1], found.own],
        TOLERANCE,
        found.chosen,
        [found.own] * below + [0.0],
    )
    drawn = chart(
        found.caption,
        traces,
        x="time [s]",
        y="error [%]",
        logarithmic=("x", "y"),
    )
    drawn.figure["layout"]["yaxis"]["range"] = error_range(
        [*found.errors[0][:-1], found.own], TOLERANCE, found.own
    )
    return drawn


def _capital(text: str) -> str:
    return text[0].upper() + text[1:]


def _cell(value: float) -> Cell:
    return value if np.isfinite(value) else None


def show_files(run: Run, page: Page, element: Superelement) -> None:
    """Write a superelement in every format that can be read back here, and read it again."""
    rows = []
    with run.step("export"):
        for name, form in export.FORMATS.items():
            module = export.format_module(name)
            if form.extra or not hasattr(module, "read") or name == "mtx-mass":
                continue
            path = run.folder / f"{element.name}_{name}{form.suffix}"
            export.write_superelement(path, element, name)
            back = export.read_superelement(path, name)
            rows.append(
                {
                    "format": name,
                    "file": path.name,
                    "bytes": path.stat().st_size,
                    _CHANGE: max_difference(back.stiffness, element.stiffness),
                    "the format keeps [-]": 10.0**-form.digits,
                }
            )
    page.vanishes(
        "stiffness read back from files, largest change over the diagonal [-]",
        max(column(rows, _CHANGE)),
        within=1e-9,
        why="the format with the fewest digits keeps 10",
        source="the superelement that was written",
    )
    band = "not known" if element.band is None else element.band.in_percent
    page.section("Exported")
    page.text(
        f"Free at its points, with mass; band of the stiffness: {band} of the diagonal, from a "
        f"coarser mesh. `fe-drivetrain export {element.name} --format json --out FILE` writes the "
        "same."
    )
    page.table(f"{element.name} at {', '.join(element.points)}: stiffness read back", rows)


def show_picture(
    run: Run, page: Page, component: Component, solid: SolidComponent, motions: Floats, what: str
) -> None:
    """The solid, deformed."""
    page.section("Deformed")
    with run.step("picture"):
        try:
            u = solid.displacements(motions)
            factor, drawn = picture_of_displacements(solid.mesh, u, run.folder / "deformed.png")
        except NoPictureError as reason:
            page.text(f"No picture: {reason}")
            return
        lame = dict.fromkeys(solid.mesh.part_names, material_of(component).lame)
        is_turned = write_solid_view(solid.mesh, {what: u}, lame, run.folder / "deformed.3d.json")
        drawn.wait()
    caption = f"{what}; displacements times {factor:g}"
    if is_turned:
        page.add(Solid(caption=caption, file="deformed.3d.json", still="deformed.png"))
    else:
        page.image(f"{caption}, and the elements' edges", "deformed.png")


def assume_dimensions(page: Page, component: Component) -> None:
    """The body's dimensions, and where each comes from."""
    for a in component.body.assumptions():
        page.assume(a.name, a.value, a.unit, a.source)


def check_rigid_motion(page: Page, element: Superelement) -> None:
    """No force against a rigid motion of the free solid."""
    page.vanishes(
        "free solid: force against rigid motions, of those that its terms have one by one [-]",
        element.rigid_error(),
        within=1e-12,
        why="the condensed stiffness is made of flexibilities between points, so that only "
        "round-off of its products is left",
        source="a body that moves as a whole is not strained",
    )
