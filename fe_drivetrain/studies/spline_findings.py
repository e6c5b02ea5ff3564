"""What a rating of gears says of splines: torque, shift, tilt, and which teeth lift."""

from __future__ import annotations

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.dynamics.bodies.spline_loads import SplineLoad, spline_loads
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.studies.gear_machine import GearTrain


def state_splines(found: Findings, train: GearTrain, hub: Floats, weight: bool) -> None:
    """State the loads of a drivetrain's splines at the reference torque, and those that lift.

    Parameters
    ----------
    found : Findings
        Takes them.
    train : GearTrain
        The machine, and the level of its rating.
    hub : ndarray, (6,)
        Loads of the hub beside the torque [N, N m].
    weight : bool
        Whether the rotor has its weight beside them.
    """
    loads = spline_loads(train.machine, train.rung, train.torque, hub, weight=weight)
    if not loads:
        return
    found.data("splines", [spline_row(name, one) for name, one in loads.items()])
    for name, one in loads.items():
        if one.used > 1.0:
            found.note(
                f"Shift and tilt of the spline of {name} are {one.used:.3g} times what its torque "
                "keeps in contact: teeth lift, and its springs there are too stiff."
            )


def spline_row(name: str, of: SplineLoad) -> Record:
    """A spline's row, over a turn of the rotor.

    Parameters
    ----------
    name : str
        Name of its shaft.
    of : SplineLoad
        Its loads.
    """
    teeth = of.worst
    return {
        "spline of": name,
        "torque [kN m]": of.torque / 1e3,
        "shift [um]": 1e6 * of.shift,
        "tilt [mrad]": 1e3 * of.tilt,
        "tilt that lifts a tooth [mrad]": 1e3 * of.data.spline.capacity(of.torque),
        "share of that limit": of.used,
        "peak over mean of the teeth": teeth.peak_over_mean,
        "teeth in contact [%]": 100.0 * teeth.carrying,
    }
