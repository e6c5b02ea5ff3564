"""The answer of pitch and yaw drives: torque of the motors, printed and put right."""

from fe_drivetrain.cases.procedure.slewing_drives import TEETH
from fe_drivetrain.common import Floats
from fe_drivetrain.common.typeset import MINUS
from fe_drivetrain.report.suite import Page

BENDING = "root bending z"
"""Flapwise moment of a blade's root, about the way that it turns."""
SHUTDOWN = "Torque of the pitch motor over a shutdown from 0 to 70 degrees"


def answer(page: Page, counts: Floats) -> None:
    """State the torque of a shutdown, by Eq 5.1 as printed and with its signs put right."""
    right, printed = (float(row["largest torque [N m]"]) for row in page.tables["shutdown"])
    drive = page.tables["pitch_drive"]
    worst = max(drive, key=lambda row: float(row["thermal torque of 600 s [N m]"]))
    loads = [row for row in page.tables["pitch_bearing_loads"] if row["channel"] == BENDING]
    bending = max(loads, key=lambda row: float(row["equivalent range at 1 Hz"]))
    (yawing,) = page.tables["yawing"]
    page.answer(
        "What torque do pitch and yaw motors need, and does Eq 5.1 of PROTEST give it?",
        "Eq 5.1 as printed does not hold: a shutdown needs "
        f"{right:.0f}\u00a0N\u00a0m of the pitch motor, not {printed:.0f}\u00a0N\u00a0m; its "
        "inertia and friction have the wrong sign.".replace("-", MINUS),
        [
            page.value(
                "largest torque of the pitch motor in a shutdown [N m]",
                right,
                beside=printed,
                by="Eq 5.1",
            ),
            page.value(
                "thermal torque of the pitch motor, worst wind [N m]",
                float(worst["thermal torque of 600 s [N m]"]),
                beside=float(worst["thermal, held [N m]"]),
                by="loads held",
            ),
            page.value(
                "flapwise moment of the pitch bearing, equivalent range [kN m]",
                float(bending["equivalent range at 1 Hz"]),
                beside=0.0,
                by="loads held",
            ),
            page.value(
                "thermal torque of the yaw motors [N m]",
                float(yawing["thermal torque of 600 s [N m]"]),
            ),
            page.value(
                "contacts of the tooth used most, over the mean of all teeth",
                float(counts.max() / counts.mean()),
            ),
            page.value(
                "teeth of a pitch ring that are used",
                float((counts > 0.0).sum()),
                beside=TEETH,
                by="all",
            ),
        ],
        hero=SHUTDOWN,
        cautions=[
            "Inertias and gear ratios of the drives are assumed for a turbine of 2 MW.",
            "Loads of the pitch bearing are simulated; those of the shutdown and of the yaw "
            "drives are assumed.",
        ],
        claim="does not hold",
    )
