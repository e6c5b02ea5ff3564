"""Loads of a main bearing over the operating range, on rollers in the beam and on constant K_R."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.bearing_life.coupled import CoupledEquilibrium, coupled_equilibrium, factors_of
from fe_drivetrain.cases.references.thesis_beam import BEAM, beam_body, bearing_s
from fe_drivetrain.common import Floats
from fe_drivetrain.report.suite import Record, grouped
from fe_drivetrain.shafts.beam import MainBearingBeam, torsional_spring_model
from fe_drivetrain.turbine_loads.hub_loads import Condition, TurbineHistory

ROLLERS, FIXED = "rollers in the beam", "constant K_R"
#: As the loads on the bearing are named, with what they are of Fx, Fy, Fz, My, Mz.
LOADS: dict[str, Callable[[Floats], Floats]] = {
    "axial force [kN]": lambda loads: loads[:, 0],
    "radial force [kN]": lambda loads: np.hypot(*loads[:, 1:3].T),
    "moment [kN m]": lambda loads: np.hypot(*loads[:, 3:].T),
}
AXIAL, RADIAL, MOMENT = LOADS
BASE = "medium, shear 0.2"
LEFT = "moment within 60 deg of overturning [% of time]"


@dataclass(frozen=True, eq=False)
class OfCondition:
    """Loads of one history.

    Attributes
    ----------
    rows : list of Record
        Least, mean and largest loads, a row for each bearing.
    mean, largest : Floats
        (72,) loads of each place of a roller, those of the upwind row first [kN].
    settled : bool
        Whether the equilibrium converged in every step.
    """

    rows: list[Record]
    mean: Floats
    largest: Floats
    settled: bool


def set_name(condition: Condition) -> str:
    """Turbulence and shear."""
    return f"{condition.turbulence}, shear {condition.shear:g}"


def on_rollers(hub_loads: Floats) -> CoupledEquilibrium:
    """Beam and rollers of bearing S in balance under hub loads (n, 6) [N, N m]."""
    factors = factors_of(hub_loads, BEAM.gearbox_weight)
    return coupled_equilibrium(beam_body(), {"bearing": bearing_s()}, factors)


def on_springs(hub_loads: Floats) -> Floats:
    """(n, 5) loads on the bearing of the beam of chapter 3, with constant K_R [N, N m]."""
    loads = torsional_spring_model(hub_loads[None], MainBearingBeam())[0]
    return np.asarray(loads[:, [0, 1, 2, 4, 5]])


def bearing_loads(hub_loads: Floats, model: str) -> Floats:
    """(n, 5) loads on the bearing by one of both models [kN, kN m]."""
    of = on_rollers(hub_loads).of("bearing") if model == ROLLERS else on_springs(hub_loads)
    return 1e-3 * of


def of_condition(condition: Condition, history: TurbineHistory) -> OfCondition:
    """Loads on the bearing of one history, on its rollers and on constant springs."""
    hub_loads = history.history.loads
    found = on_rollers(hub_loads)
    rollers = 1e-3 * found.rollers("bearing")
    both = {ROLLERS: found.of("bearing"), FIXED: on_springs(hub_loads)}
    return OfCondition(
        [_row(condition, history, name, 1e-3 * loads) for name, loads in both.items()],
        rollers.mean(axis=0),
        rollers.max(axis=0),
        bool(found.converged.all()),
    )


def _row(condition: Condition, history: TurbineHistory, name: str, loads: Floats) -> Record:
    row: Record = {
        "bearing": name,
        "wind [m/s]": condition.wind_speed,
        "set": set_name(condition),
        "seed": condition.seed,
        "rotor speed [rad/s]": float(history.rotor_speed.mean()),
        "pitch [deg]": float(np.degrees(history.pitch.mean())),
        # looking downwind, y is to the left, and the axis of an overturning moment
        LEFT: 100.0 * float((loads[:, 3] > 0.5 * LOADS[MOMENT](loads)).mean()),
    }
    for load, of in LOADS.items():
        values = of(loads)
        for what, function in (("least", np.min), ("mean", np.mean), ("largest", np.max)):
            row[f"{what} {load}"] = float(function(values))
    return row


def averaged(rows: Sequence[Record]) -> list[Record]:
    """Means over the seeds of one wind, set and bearing."""
    result: list[Record] = []
    for _, of_bearing in grouped(rows, "bearing"):
        for _, of_wind in grouped(of_bearing, "wind [m/s]"):
            for _, own in grouped(of_wind, "set"):
                row = dict(own[0])
                for key, value in own[0].items():
                    if key != "seed" and isinstance(value, float):
                        row[key] = float(np.mean([float(r[key]) for r in own]))  # type: ignore[arg-type]
                del row["seed"]
                result.append(row)
    return result
