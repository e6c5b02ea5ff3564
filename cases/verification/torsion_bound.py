"""Checks shared by the torsion cases with two bounds from the meridian."""

from fe_drivetrain.cases.references.torsion_meridian import Bounds
from fe_drivetrain.report.suite import Page, Target

BOUNDS = "between two bounds from the meridian (displacements; torsion function)"
"""Where a reference between the bounds comes from."""


def between(
    bounds: Bounds, key: str, within: float, why: str, order: float | None = None
) -> Target:
    """A stiffness between the bounds, whose own width is allowed besides; see `Target`."""
    width = bounds.half_width / bounds.middle
    reasons = f"{why}; and the bounds' own width"
    return Target(key, bounds.middle, within + width, reasons, BOUNDS, order=order)


def check_plane_sections(page: Page, quantity: str, bounds: Bounds, stiffness: float) -> None:
    """Sections that stay plane are the stiffer: the upper bound is no larger."""
    page.at_most(
        quantity,
        bounds.upper / stiffness - 1.0,
        1e-9,
        why="no excess is allowed but round-off",
        source="plane sections that stay plane are one of the displacements over which the energy "
        "is least, so that stiffness is no smaller than the bound",
        measure="identity",
    )


def check_width(page: Page, quantity: str, bounds: Bounds) -> None:
    """The bounds are close enough to show what a step adds."""
    page.at_most(
        quantity,
        2 * bounds.half_width / bounds.middle,
        1e-3,
        why="a tenth of what the step adds",
        source="exact stiffness lies between them",
        measure="identity",
    )
