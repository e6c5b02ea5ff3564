"""The balance of shafts between rigid ends, as a check."""

from fe_drivetrain.report import Verdict, judge


def balance_verdict(imbalances: list[float]) -> Verdict:
    """Whether the solver solved: Clapeyron's theorem on every mesh."""
    return judge(
        "work of the loads less twice the energy stored, relative, worst of all meshes",
        max(imbalances),
        0.0,
        tolerance=1e-7,
        relative=False,
        source="Clapeyron's theorem",
        reason="iterations end at 1e-9 in the energy norm; round-off of slender solids is above",
        measure="identity",
    )
