"""What an export writes: a part at points, modes, a summary, all that turns, a model, a mesh."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import ClassVar, Literal, get_args

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.errors import InputError, require_known
from fe_drivetrain.common.progress import Progress, silent
from fe_drivetrain.common.steps import Steps
from fe_drivetrain.common.stiffness_bands import KINDS, StiffnessBands
from fe_drivetrain.drivetrain_file.component import Component
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.reading import with_sections
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.elasticity.mesh.mesh import Mesh
from fe_drivetrain.export.craig_bampton import CraigBampton, craig_bampton_shaft
from fe_drivetrain.export.formats.summary import SummaryFile, summary
from fe_drivetrain.export.from_component import BODY, component_superelement
from fe_drivetrain.export.scene_export import AUTO, SHAFT, superelement_of
from fe_drivetrain.export.superelement import Superelement
from fe_drivetrain.export.turning import Turning
from fe_drivetrain.report.answer import KeyFigure
from fe_drivetrain.report.charts import bars, stiffness_chart
from fe_drivetrain.report.number_text import certain_value, formatted
from fe_drivetrain.report.results import Chart
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.shafts.fidelity.component_solid import component_mesh
from fe_drivetrain.shafts.response.model import Model, build_model, mesh_scene
from fe_drivetrain.studies.part_survey import place_records
from fe_drivetrain.studies.result import Result
from fe_drivetrain.studies.turning_export import state_turning, turning_chart, turning_content

Kind = Literal["superelement", "modes", "summary", "turning", "model", "mesh"]
"""A part condensed to points; the free shaft with fixed-interface modes, too; numbers of a
drivetrain model; matrices of all that turns; the whole model with its unit loads; its mesh."""

OfPart = Superelement | CraigBampton | SummaryFile | Model | Mesh
"""What is written of parts of a scene, or of a component."""
Content = OfPart | Turning
"""What is written of each of these kinds."""

#: Level of a component's export where none is asked for.
_COMPONENT_LEVEL = 3
#: Level of the reactions of a summary, and of the shaft that modes are of.
_SUMMARY_LEVEL, _MODES_LEVEL = 2, 2


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class ExportResult(Result):
    """What is to be written, with the facts that stand in the headers of its files.

    Attributes
    ----------
    drivetrain : Drivetrain or Component
        What it is of.
    kind : str
        A word of `Kind`.
    content : Content
        For a function of `fe_drivetrain.export` that writes it; not part of the JSON.
    points : tuple[str, ...]
        Names of the points that matrices are at; empty where there are none.
    level : str
        Level of the ladder, with its name; empty of model and mesh.
    band : StiffnessBands or None
        Half widths of the bands of a superelement's stiffness by kind of motion; None where they
        are not known.
    """

    STUDY: ClassVar[str] = "export"

    drivetrain: Drivetrain | Component
    kind: Kind
    content: Content = field(repr=False)
    points: tuple[str, ...]
    level: str
    band: StiffnessBands | None

    def chart(self) -> Chart:
        """Stiffness between points; masses of a summary; elements of each part of a mesh."""
        content = self.content
        if isinstance(content, Turning):
            return turning_chart(content)
        if isinstance(content, CraigBampton):
            return stiffness_chart("shaft", content.points, content.point_stiffness)
        if isinstance(content, Superelement):
            return stiffness_chart(content.name, content.points, content.stiffness)
        if isinstance(content, SummaryFile):
            masses = {name: part.mass for name, part in content.parts.items()}
            return bars("Mass of each part", {"mass": masses}, "mass [kg]")
        mesh = _mesh_of(content)
        counts = {name: float(len(mesh.part_cells(name))) for name in mesh.part_names}
        return bars("Elements of each part", {"elements": counts}, "elements")


def prepare_export(
    drivetrain: Drivetrain | Component,
    kind: Kind = "superelement",
    what: str = "",
    at: Sequence[str] | None = None,
    level: int | str | None = None,
    modes: int = 0,
    *,
    generator: str = "free",
    report: Progress = silent,
) -> ExportResult:
    """Prepare what other programs take of a drivetrain: choose level and points, and condense.

    Parameters
    ----------
    drivetrain : Drivetrain or Component
        What is exported; only "turning" takes one whose main shaft has no sections.
    kind : str
        "superelement", "modes" (a superelement of the free shaft with modes), "summary", "turning"
        (matrices of all that turns, and its torsion as one spring), "model" or "mesh".
    what : str
        Part of a scene for a superelement: "shaft", "drivetrain", "seats" or a bearing's name, see
        `fe_drivetrain.export.superelement_of`; of a component "body" or "supported". The first of
        each where left out.
    at : sequence of str or None
        Names of the points to keep; None for the usual ones.
    level : int, str or None
        Model level; None for the usual one: of scenes 4 for bearings and else 2, of components 3.
        For "turning" it is "torsional", "rigid" or "flexible", or the finest of them that the data
        allow.
    modes : int
        Number of fixed-interface modes.
    generator : str
        For "turning": whether the generator is "free" to turn, or "held".
    report : Progress
        Called with the name of each step as it begins.

    Raises
    ------
    InputError
        There is no such part, point or level, a component has nothing of this kind, or an argument
        is not used by this kind.
    """
    found, steps = Findings(), Steps(report)
    found.about(drivetrain)
    found.seed = None
    require_known("kind of export", kind, get_args(Kind))
    _refuse_unused(kind, what, at, level, modes)
    if kind == "turning":
        return _of_turning(found, steps, drivetrain, level, generator)
    if generator != "free":
        raise InputError(
            f"{argument('generator', generator)} is not used by an export of kind {kind!r}: leave "
            "it out"
        )
    drivetrain, level = _with_sections(drivetrain), _number(level)
    content: OfPart
    if kind in ("model", "mesh"):
        content = _model_or_mesh(found, steps, drivetrain, kind)
    else:
        content = _condensed(steps, drivetrain, kind, what, at, level, modes)
    found.say(_description(content))
    _data(found, content)
    _answer(found, drivetrain, kind, content)
    return ExportResult(
        drivetrain=drivetrain,
        kind=kind,
        content=content,
        points=_points(content),
        level=_level(content),
        band=content.band if isinstance(content, Superelement) else None,
        **found.frozen(steps.times, kind=kind, what=what, at=at, level=level, modes=modes),
    )


def _of_turning(
    found: Findings,
    steps: Steps,
    drivetrain: Drivetrain | Component,
    level: int | str | None,
    generator: str,
) -> ExportResult:
    """All that turns as matrices."""
    content = steps.timed("matrices", turning_content, drivetrain, level, generator)
    assert isinstance(drivetrain, Drivetrain)
    state_turning(found, drivetrain, content)
    return ExportResult(
        drivetrain=drivetrain,
        kind="turning",
        content=content,
        points=(),
        level=content.options["level"],
        band=None,
        **found.frozen(steps.times, kind="turning", level=level, generator=generator),
    )


def _with_sections(drivetrain: Drivetrain | Component) -> Scene | Component:
    """The drivetrain as what has a main shaft with sections, or a component."""
    if isinstance(drivetrain, Drivetrain):
        return with_sections(drivetrain, drivetrain.title)
    return drivetrain


def _number(level: int | str | None) -> int | None:
    """The number of a level.

    Raises
    ------
    InputError
        It is a word, which only all that turns has.
    """
    if isinstance(level, str):
        raise InputError(
            f"{argument('level', level)} must be a number, but for all that turns: change it"
        )
    return level


def _condensed(
    steps: Steps,
    drivetrain: Scene | Component,
    kind: Kind,
    what: str,
    at: Sequence[str] | None,
    level: int | None,
    modes: int,
) -> OfPart:
    """A superelement, with modes or without, or a summary."""
    if kind == "modes":
        scene = _scene_of_modes(drivetrain, what, level)
        return steps.timed("condense", craig_bampton_shaft, scene, modes, at)
    if kind == "summary":
        scene = _require_scene(drivetrain, "a summary is")
        number = _SUMMARY_LEVEL if level is None else level
        return steps.timed("condense", summary, scene, number)
    return steps.timed("condense", _superelement, drivetrain, what, at, level)


def _refuse_unused(
    kind: Kind, what: str, at: Sequence[str] | None, level: int | str | None, modes: int
) -> None:
    """Refuse arguments that a kind of export does not use."""
    if kind == "summary" and at is not None:
        raise InputError(
            f"{argument('at', list(at))} is not used by {argument('kind', kind)}, which has all "
            f"points of the scene: leave {argument('at')} out"
        )
    given = {"what": what, "at": at, "level": level, "modes": modes}
    used = {"superelement": ("what", "at", "level"), "summary": ("level",), "turning": ("level",)}
    used["modes"] = ("what", "at", "level", "modes")
    unused = [name for name, value in given.items() if value and name not in used.get(kind, ())]
    if unused:
        raise InputError(
            f"{argument(unused[0])} is not used by an export of kind {kind!r}: leave it out"
        )


def _superelement(
    drivetrain: Scene | Component, what: str, at: Sequence[str] | None, level: int | None
) -> Superelement:
    if isinstance(drivetrain, Scene):
        return superelement_of(drivetrain, what or SHAFT, at, AUTO if level is None else level)
    number = _COMPONENT_LEVEL if level is None else level
    return component_superelement(drivetrain, what or BODY, at, number)


def _model_or_mesh(
    found: Findings, steps: Steps, drivetrain: Scene | Component, kind: Kind
) -> Model | Mesh:
    if kind == "model":
        scene = _require_scene(drivetrain, "a whole model is")
        mesh = steps.timed("mesh", mesh_scene, scene)
        model = steps.timed("model", build_model, scene, mesh)
        for warning in model.warnings:
            found.note(warning)
        return model
    with steps.step("mesh"):
        if isinstance(drivetrain, Scene):
            return mesh_scene(drivetrain)
        return component_mesh(drivetrain)[0]


def _require_scene(drivetrain: Scene | Component, what: str) -> Scene:
    if isinstance(drivetrain, Scene):
        return drivetrain
    raise InputError(
        f"{what} of a scene, and {drivetrain.title!r} is a component: export its mesh, or its body "
        "condensed to points"
    )


def _scene_of_modes(drivetrain: Scene | Component, what: str, level: int | None) -> Scene:
    """The scene whose free shaft has the modes.

    Raises
    ------
    InputError
        It is another part, at another level, or of a component.
    """
    modes = argument("kind", "modes")
    if not isinstance(drivetrain, Scene):
        raise InputError(f"{modes} is for the shaft of a scene, not for a component: leave it out")
    if what not in ("", SHAFT):
        raise InputError(
            f"{modes} is for the free shaft, not for {argument('what', what)}: leave "
            f"{argument('what')} out"
        )
    if level not in (None, _MODES_LEVEL):
        raise InputError(
            f"{modes} is for the shaft of level {_MODES_LEVEL}, not "
            f"{argument('level', level)}: leave {argument('level')} out"
        )
    return drivetrain


def _mesh_of(content: Model | Mesh) -> Mesh:
    return content.mesh if isinstance(content, Model) else content


def _points(content: OfPart) -> tuple[str, ...]:
    return content.points if isinstance(content, Superelement | CraigBampton) else ()


def _level(content: OfPart) -> str:
    if isinstance(content, SummaryFile):
        return content.reactions.level
    return content.origin.level if isinstance(content, Superelement | CraigBampton) else ""


def _description(content: OfPart) -> str:
    """What is written, as the command says it."""
    if isinstance(content, CraigBampton):
        return f"shaft at {', '.join(content.points)}, free, with {len(content.omega)} modes"
    if isinstance(content, SummaryFile):
        return (
            f"summary of {', '.join(content.parts)}, reactions of level {content.reactions.level}"
        )
    if isinstance(content, Superelement):
        supports = "on its supports" if content.supported else "free"
        return (
            f"{content.name} at {', '.join(content.points)}, {supports}, level "
            f"{content.origin.level}, {'with' if content.mass is not None else 'without'} mass"
        )
    mesh = _mesh_of(content)
    return f"{len(mesh.cells):,} elements, {len(mesh.points):,} nodes"


def _answer(found: Findings, drivetrain: Scene | Component, kind: Kind, content: OfPart) -> None:
    """State what is ready to be written, and how certain it is."""
    if isinstance(content, Superelement | SummaryFile):
        stated = {"bound": content.bound, "rollers": content.rollers}
        if all(stated.values()):
            of_units = "Bound of bearing units: {bound}. Rollers: {rollers}."
            found.note(of_units.format(**stated), first=True)
            found.data("bearing units", stated)
    if isinstance(content, CraigBampton):
        verdict, figures = _of_modes(found, content)
    elif isinstance(content, Superelement):
        verdict, figures = _of_superelement(found, content)
    elif isinstance(content, SummaryFile):
        mass = found.value(
            "mass of all parts [t]", sum(p.mass for p in content.parts.values()) / 1e3
        )
        count = len(content.parts)
        verdict = f"The summary has {count} part{'s' * (count > 1)} of {certain_value(mass)} in "
        verdict += f"all, and reactions of level {content.reactions.level}."
        figures = [mass, found.value("parts", len(content.parts))]
        figures.append(found.value("bearing units", len(content.bearing_units)))
    else:
        mesh = _mesh_of(content)
        cells, points = (
            found.value("elements", len(mesh.cells)),
            found.value("nodes", len(mesh.points)),
        )
        verdict = (
            f"The {kind} has {certain_value(cells)} elements on {certain_value(points)} nodes."
        )
        figures = [cells, points, found.value("parts", len(mesh.part_names))]
    found.answer(f"What does the {kind} of {drivetrain.title} hold?", verdict, figures)


def _of_modes(found: Findings, content: CraigBampton) -> tuple[str, list[KeyFigure]]:
    """Verdict and key figures of a free shaft with modes."""
    n, m = len(content.points), len(content.omega)
    figures = [
        found.value("points", n),
        found.value("modes", m),
        found.value("size of its matrices", 6 * n + m),
    ]
    lowest = ""
    if m:
        first = found.value("lowest frequency, points fixed [Hz]", content.omega[0] / math.tau)
        figures.insert(0, first)
        lowest = f", the lowest at {certain_value(first)} with its points fixed"
    return f"The free shaft has {n} points and {m} modes{lowest}.", figures


def _of_superelement(found: Findings, content: Superelement) -> tuple[str, list[KeyFigure]]:
    """Verdict and key figures of a part that is condensed to points."""
    n = len(content.points)
    bands = [found.judged(f.quantity) for f in found.figures if f.quantity.startswith("band of")]
    mass = [found.judged("mass")] if content.mass is not None else []
    figures = [*bands, *mass, found.value("points", n), found.value("size of its matrices", 6 * n)]
    if not (bands and mass):
        level = float(content.origin.level.partition(" ")[0])
        figures.append(found.value("level of its model", level))
    bound = ", the stiff bound," if content.bound.startswith("stiff:") else ""
    known = f"the band of its stiffness{bound} is not known"
    if bands:
        widest = max(bands, key=lambda one: one.value)
        known = f"its stiffness{bound} is known within {formatted(widest.value, 2)}\u00a0%"
    state = "on its supports" if content.supported else "free"
    # other parts than these have names of the user's
    subject = "The shaft" if content.name == SHAFT else content.name
    return f"{subject} is condensed to {n} point{'s' * (n > 1)}, {state}; {known}.", figures


def _data(found: Findings, content: OfPart) -> None:
    """Keep the facts of the headers, and what a reader can check."""
    if isinstance(content, SummaryFile):
        found.data("summary", content.model_dump(mode="json"))
        return
    if isinstance(content, Model | Mesh):
        mesh = _mesh_of(content)
        found.data(
            "elements",
            [{"part": name, "elements": len(mesh.part_cells(name))} for name in mesh.part_names],
        )
        return
    found.data("points", place_records(content.points, content.positions))
    found.data("origin", vars(content.origin))
    if isinstance(content, CraigBampton):
        found.data("frequencies [rad/s]", content.omega)
        return
    if content.band is not None:
        for kind, band in zip(KINDS, content.band, strict=True):
            found.found(f"band of the stiffness, {kind} [%]", 100 * band)
    if (inertia := content.inertia()) is not None:
        found.found("mass [kg]", float(inertia[0, 0]))
    found.data("checks", content.checks())
