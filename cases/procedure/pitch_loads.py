"""What a pitch bearing and its drive carry while the turbine moves, and with loads held."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.cases.procedure.slewing_drives import AXIAL, DIAMETER, MOMENT, PITCH, RADIAL
from fe_drivetrain.common import Floats
from fe_drivetrain.procedure import drive_torque, friction_torque, thermal_torque
from fe_drivetrain.report.suite import Page, Record
from fe_drivetrain.turbine_loads.histories import (
    damage_equivalent_load,
    even_levels,
    rainflow_cycles,
    time_at_level,
)
from fe_drivetrain.turbine_loads.hub_loads import (
    ROOT_LOADS,
    BladeRoots,
    Condition,
    Rotor,
    blade_roots,
    similar_turbine,
)

HELD_TORSION = 8e3  # N m, about the pitch axis, where loads are held
SLOPE = 4.0
_LEVELS = 20


@dataclass(frozen=True)
class Pitched:
    """Pitching of blade 1 in a wind: loads of its bearing, and torque of its motor.

    Attributes
    ----------
    wind : float
        Mean wind speed [m/s].
    roots : BladeRoots
        The run.
    """

    wind: float
    roots: BladeRoots

    @property
    def step(self) -> float:
        """Between two samples [s]."""
        return float(self.roots.made.history.step)

    @property
    def pitch(self) -> Floats:
        """(n,) [rad]."""
        return self.roots.made.pitch

    @property
    def speed(self) -> Floats:
        """(n,) [rad/s]."""
        return np.asarray(np.gradient(self.pitch, self.step))

    @property
    def acceleration(self) -> Floats:
        """(n,) [rad/s^2]."""
        return np.asarray(np.gradient(self.speed, self.step))

    @property
    def loads(self) -> Floats:
        """(n, 6) loads of the root of blade 1 [N, N m]."""
        return np.asarray(self.roots.loads[:, 0])

    def friction(self, held: bool = False) -> Floats:
        """(n,) friction of the bearing [N m], with loads held or as they are."""
        if held:
            return np.full(len(self.pitch), float(friction_torque(MOMENT, AXIAL, RADIAL, DIAMETER)))
        return friction_torque(
            self.roots.bending[:, 0], self.loads[:, 1], self.roots.shear[:, 0], DIAMETER
        )

    def about_axis(self, held: bool = False) -> Floats:
        """(n,) load about the pitch axis that resists feathering [N m]."""
        return np.full(len(self.pitch), HELD_TORSION) if held else self.loads[:, 4]

    def motor(self, held: bool = False) -> Floats:
        """(n,) torque of the pitch motor [N m]."""
        return drive_torque(
            PITCH, self.about_axis(held), self.friction(held), self.speed, self.acceleration
        )


def pitched(wind: float, seconds: float) -> Pitched:
    """Pitching of the surrogate turbine of 2 MW by its controller in turbulent wind.

    Parameters
    ----------
    wind : float
        Mean wind speed [m/s].
    seconds : float
        Length [s].
    """
    turbine = similar_turbine(Rotor())
    return Pitched(wind, blade_roots(Condition(wind, "medium", 0.2, 1), turbine, duration=seconds))


def show_loads(page: Page, runs: list[Pitched]) -> list[Record]:
    """Table 5.3 of the bearing: what its loads count, and that held ones count nothing."""
    rows: list[Record] = []
    for one in runs:
        for k, name in enumerate(ROOT_LOADS):
            values = one.loads[:, k] / 1e3
            cycles = rainflow_cycles(values)
            spread = float(np.ptp(values))
            levels = time_at_level(
                values, one.step, even_levels(values.min(), values.max(), _LEVELS)
            )
            rows.append(
                {
                    "wind [m/s]": one.wind,
                    "channel": name,
                    "unit": "kN" if k < 3 else "kN m",
                    "least": float(values.min()),
                    "mean": float(values.mean()),
                    "largest": float(values.max()),
                    "cycles above a tenth of the range": float(
                        cycles.counts[cycles.ranges > 0.1 * spread].sum()
                    ),
                    "equivalent range at 1 Hz": damage_equivalent_load(
                        [cycles], one.step * len(values), SLOPE
                    ),
                    "longest at one of 20 levels [%]": 100.0
                    * float(levels.amount.max() / levels.amount.sum()),
                }
            )
    page.section("Loads of the pitch bearing")
    page.table(
        f"Table 5.3, blade and pitch bearing: blade 1 of the turbine that moves, slope {SLOPE:g}",
        rows,
    )
    page.data("pitch_bearing_loads", rows)
    page.text(
        "Loads that are held constant have no cycle, no equivalent range, and stay at one level "
        "all the time. Torsion is that of bent blades: aerofoils' own pitching moments and masses "
        "beside the pitch axis are not in the turbine's model."
    )
    return rows


def show_drive(page: Page, runs: list[Pitched]) -> list[Record]:
    """What loads that move do to the drive, beside held ones."""
    rows: list[Record] = []
    for one in runs:
        moving, held = one.motor(), one.motor(held=True)
        friction = one.friction()
        rows.append(
            {
                "wind [m/s]": one.wind,
                "friction, least [kN m]": float(friction.min()) / 1e3,
                "largest [kN m]": float(friction.max()) / 1e3,
                "held [kN m]": float(one.friction(held=True)[0]) / 1e3,
                "thermal torque of 600 s [N m]": thermal_torque(moving, one.step),
                "thermal, held [N m]": thermal_torque(held, one.step),
                "largest torque of the motor [N m]": float(np.abs(moving).max()),
                "largest, held [N m]": float(np.abs(held).max()),
                "cycles of the motor's torque above a tenth of its range": counted(moving),
                "cycles, held": counted(held),
            }
        )
    page.table("The pitch drive with loads of the turbine, and with loads held", rows)
    page.data("pitch_drive", rows)
    return rows


def counted(values: Floats) -> float:
    """Cycles above a tenth of the range."""
    cycles = rainflow_cycles(values)
    return float(cycles.counts[cycles.ranges > 0.1 * float(np.ptp(values))].sum())
