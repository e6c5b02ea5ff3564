"""Loads of a main bearing over the operating range, on rollers in the beam and on constant K_R."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.cases.histories.operating_spectra import Raceway, raceway_spectra
from fe_drivetrain.cases.references.main_bearings import (
    ARRANGED,
    OTHERWISE,
    InShaft,
    thesis_in_shaft,
)
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
    mean, largest : dict of str to Floats
        (rollers,) loads of each place of a roller, the upwind row first, by arrangement [kN].
    spectra : dict of str to Raceway
        Spectra of the load of the upwind raceway, by arrangement.
    settled : bool
        Whether the equilibrium converged in every step.
    """

    rows: list[Record]
    mean: dict[str, Floats]
    largest: dict[str, Floats]
    spectra: dict[str, Raceway]
    settled: bool


@dataclass(frozen=True, eq=False)
class Studied:
    """A main bearing under the loads of the operating range.

    Attributes
    ----------
    arrangements : dict of str to InShaft
        On its rollers; the first has its loads in rows, the others show what a choice does.
    springs : bool
        Whether the thesis's beam with constant K_R stands beside them.
    """

    arrangements: dict[str, InShaft]
    springs: bool

    @property
    def first(self) -> str:
        """The arrangement whose loads are shown."""
        return next(iter(self.arrangements))


def of_thesis() -> Studied:
    """Bearing S in two arrangements, beside constant K_R."""
    return Studied({name: thesis_in_shaft(name) for name in (ARRANGED, OTHERWISE)}, springs=True)


def set_name(condition: Condition) -> str:
    """Turbulence and shear."""
    return f"{condition.turbulence}, shear {condition.shear:g}"


def on_springs(hub_loads: Floats) -> Floats:
    """(n, 5) loads on the bearing of the beam of chapter 3, with constant K_R [N, N m]."""
    loads = torsional_spring_model(hub_loads[None], MainBearingBeam())[0]
    return np.asarray(loads[:, [0, 1, 2, 4, 5]])


def bearing_loads(hub_loads: Floats, model: str) -> Floats:
    """(n, 5) loads on the bearing by one of both models [kN, kN m]."""
    if model == ROLLERS:
        return 1e-3 * thesis_in_shaft().under(hub_loads).of("bearing")
    return 1e-3 * on_springs(hub_loads)


def of_condition(condition: Condition, history: TurbineHistory, of: Studied) -> OfCondition:
    """Loads on the bearing of one history, on its rollers and on constant springs."""
    ways = of.arrangements
    found = {name: one.under(history.history) for name, one in ways.items()}
    rollers = {name: 1e-3 * one.rollers(ways[name].name) for name, one in found.items()}
    both = {ROLLERS: found[of.first].of(ways[of.first].name)}
    if of.springs:
        both[FIXED] = on_springs(history.history.loads)
    return OfCondition(
        [_row(condition, history, name, 1e-3 * loads) for name, loads in both.items()],
        {name: one.mean(axis=0) for name, one in rollers.items()},
        {name: one.max(axis=0) for name, one in rollers.items()},
        {
            name: raceway_spectra(one[:, : ways[name].bearing.counts[0]], history)
            for name, one in rollers.items()
        },
        all(one.converged.all() for one in found.values()),
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
