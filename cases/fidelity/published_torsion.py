"""The torsional stiffness of a scene's shaft beside the one that its sources give."""

from __future__ import annotations

from dataclasses import dataclass

from fe_drivetrain.drivetrain_file import Material, Scene
from fe_drivetrain.elasticity.revolution import end_stiffness
from fe_drivetrain.geometry import (
    LENGTH_TOLERANCE,
    Shaft,
)
from fe_drivetrain.report import Cell
from fe_drivetrain.report.answer import KeyFigure
from fe_drivetrain.report.suite import Page
from fe_drivetrain.shafts.beam import Beam, BeamSection, shaft_stiffness


@dataclass(frozen=True)
class Published:
    """A torsional stiffness that the sources give.

    Attributes
    ----------
    name : str
        What they call it.
    to : float
        x of the station to which it reaches from the front face [m]; there, the shaft is cut.
    value, half_digit : float
        The stiffness, and half of its last printed digit [N m/rad].
    source : str
        Of the value.
    rounding : float
        Half of the last digit of the scene's diameters and lengths [m].
    """

    name: str
    to: float
    value: float
    half_digit: float
    source: str
    rounding: float = 0.0


def beside_published(page: Page, scene: Scene, published: Published) -> KeyFigure:
    """The shaft from its front face to a station, ends rigid, beside what the sources say.

    Parameters
    ----------
    page : Page
        Takes checks and a section.
    scene : Scene
        The scene.
    published : Published
        What its sources say.

    Returns
    -------
    KeyFigure
        The stiffness by finite elements, beside the published one.
    """
    shaft = front_part(scene.shaft, published.to)
    material = scene.material_of("shaft")
    found, coarser = (
        float(end_stiffness(shaft, material, order=order)[3, 3]) for order in (None, 3)
    )
    plain = float(end_stiffness(_without_fillets(shaft), material)[3, 3])
    summed = _in_series(shaft, material)
    thicker = _in_series(_enlarged(shaft, published.rounding), material)
    band = abs(found - coarser)
    where = f"front face to x = {published.to:g} m"
    page.equals(
        f"G J / L of the sections in series, {where} [N m/rad]",
        summed,
        published.value,
        within=published.half_digit / published.value + thicker / summed - 1.0,
        why="half of its last printed digit"
        + (", and of the scene's dimensions" if published.rounding else ""),
        source=published.source,
    )
    page.at_most(
        f"finite elements without fillets above the sections in series, {where}, relative",
        plain / summed - 1.0,
        1e-8,
        why="round-off of a condensed stiffness",
        source="sections kept plane and round only make it stiffer (least potential energy)",
        measure="identity",
    )
    _compare(page, published, (found, band), summed)
    return _key_figure(page, published, found)


def _compare(page: Page, published: Published, found: tuple[float, float], summed: float) -> None:
    """The published stiffness beside that of the sections in series, and finite elements' (±)."""
    value, band = found
    less = 100 * (1 - value / published.value)
    page.say(
        f"{published.name} is published as {published.value:.4g} N m/rad; the shaft of this scene "
        f"has {value:.4g} ± {band:.1g} by finite elements"
        + (f", {less:.2g} % less" if abs(less) > 0.01 else "")
        + "."
    )
    page.section("Beside the published stiffness")
    rows: list[list[Cell]] = [
        [published.name, published.value, published.half_digit, 1.0],
        ["G J / L of the sections in series", summed, None, summed / published.value],
        ["finite elements, ends rigid", value, band, value / published.value],
    ]
    page.table(
        f"Torsional stiffness from the front face to x = {published.to:g} m",
        rows,
        ["how", "stiffness [N m/rad]", "half width of the band", "over the published"],
    )


def _key_figure(page: Page, published: Published, found: float) -> KeyFigure:
    """The stiffness by finite elements [N m/rad], beside the published one."""
    prefix, size = ("G", 1e9) if published.value >= 1e9 else ("M", 1e6)
    return page.value(
        f"torsional stiffness of the shaft, {published.name} [{prefix}N m/rad]",
        found / size,
        beside=published.value / size,
        by=published.source,
        printed=f"{published.value / size:.4g}",
    )


def _in_series(shaft: Shaft, material: Material) -> float:
    """Torsional stiffness of a shaft as a beam: G J / L of its sections, one after the other."""
    sections = [
        BeamSection(
            piece.length,
            piece.outer_diameter,
            piece.inner_diameter,
            outer_diameter_end=piece.end_diameter,
        )
        for piece in shaft.pieces
    ]
    beam = Beam(sections, [], shaft.front, material)
    return float(shaft_stiffness(beam, shaft.front, shaft.rear)[3, 3])


def _enlarged(shaft: Shaft, by: float) -> Shaft:
    """Every section of a shaft without flange shorter and thicker by so much [m]."""
    sections = tuple(
        section.model_copy(
            update={
                "length": section.length - by,
                "outer_diameter": section.outer_diameter + by,
                "outer_diameter_end": section.end_diameter + by,
            }
        )
        for section in shaft.sections
    )
    return shaft.model_copy(update={"sections": sections})


def _without_fillets(shaft: Shaft) -> Shaft:
    """A shaft without flange, its steps sharp."""
    sections = tuple(section.model_copy(update={"fillet": 0.0}) for section in shaft.sections)
    return shaft.model_copy(update={"sections": sections})


def front_part(shaft: Shaft, to: float) -> Shaft:
    """The shaft from its front face to x = to [m], its flange a section."""
    cut = shaft.cut([to])
    kept = [
        section
        for section, end in zip(cut.sections, cut.stations[1:], strict=True)
        if end <= to + LENGTH_TOLERANCE
    ]
    last = kept[-1].model_copy(update={"fillet": 0.0})
    return cut.model_copy(update={"sections": (*kept[:-1], last)})
