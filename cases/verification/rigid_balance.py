"""The balance of shafts between rigid ends, as a check."""

from collections.abc import Sequence

from fe_drivetrain.report.suite import Page


def check_balance(page: Page, imbalances: Sequence[float]) -> None:
    """Clapeyron's theorem on every mesh: twice the energy stored is the work of the loads."""
    page.vanishes(
        "work of the loads less twice the energy stored, relative, worst of all meshes",
        max(imbalances),
        within=1e-7,
        why="iterations end at 1e-9 in the energy norm; round-off of slender solids is above",
        source="Clapeyron's theorem",
    )
