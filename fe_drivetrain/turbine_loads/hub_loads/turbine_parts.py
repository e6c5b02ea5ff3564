"""Turbine, controller and wind as the compiled equations take them."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.turbine_loads.hub_loads.controller import (
    CUT_IN_SHARE,
    FULL_SHARE,
    MIN_PITCH,
    SLIP,
    Controller,
)
from fe_drivetrain.turbine_loads.hub_loads.histories import MIN_SAMPLES
from fe_drivetrain.turbine_loads.hub_loads.turbine import Physics, Turbine, blade_modes
from fe_drivetrain.turbine_loads.hub_loads.wind import (
    DiscTurbulence,
    Singles,
    disc_turbulence,
    length_scales,
    power_law,
)

SETTLING = 60.0
"""Left out at the beginning [s]: 20 lengths of the speed's answer, 15 of the slowest wake."""


@dataclass(frozen=True, eq=False)
class Inflow:
    """Wind that a rotor meets.

    Attributes
    ----------
    speed : float
        Mean at hub height [m/s].
    shear : float
        Power-law exponent of the mean.
    harmonics : ndarray, (n, 2 M + 1, r)
        What is added at each sample, in harmonics of azimuth on the rings of the blade elements
        [m/s]: the mean around a ring, cosines, sines.
    rate : float
        Samples per second [Hz].
    """

    speed: float
    shear: float
    harmonics: Singles
    rate: float

    def up_to(self, count: int | None) -> Inflow:
        """The same wind without harmonics of azimuth above a number of them.

        Parameters
        ----------
        count : int or None
            Harmonics that stay, 0 or more; all if not given, or more than there are.

        Raises
        ------
        InputError
            It is negative.
        """
        highest = (self.harmonics.shape[1] - 1) // 2
        if count is None or count >= highest:
            return self
        if count < 0:
            raise InputError(f"inflow: {count} harmonics must stay, but 0 or more can")
        rows = [*range(count + 1), *range(highest + 1, highest + 1 + count)]
        return replace(self, harmonics=np.ascontiguousarray(self.harmonics[:, rows]))


def even_inflow(
    turbine: Turbine, speed: float, gust: ArrayLike, rate: float, shear: float = 0.0
) -> Inflow:
    """A wind that is equal over the disc but for shear.

    Parameters
    ----------
    turbine : Turbine
        Gives the blade elements.
    speed : float
        Mean [m/s].
    gust : array_like, (n,)
        Added to it at each sample [m/s].
    rate : float
        Samples per second [Hz].
    shear : float
        Power-law exponent.
    """
    added = np.asarray(gust, dtype=np.float32)
    rings = turbine.rotor.elements
    harmonics = np.repeat(added[:, None, None], rings, axis=2)
    return Inflow(speed, shear, harmonics, rate)


def turbulence_of(
    turbine: Turbine, wind_speed: float, duration: float, rate: float
) -> DiscTurbulence:
    """Turbulence on the rings of a rotor, with `SETTLING` before what is kept.

    Parameters
    ----------
    turbine : Turbine
        The turbine.
    wind_speed, duration, rate : float
        Mean wind [m/s], length [s], samples per second [Hz].

    Raises
    ------
    InputError
        Duration or rate leave too few samples.
    """
    if not (np.isfinite(duration * rate) and rate > 0.0 and duration * rate >= MIN_SAMPLES):
        raise InputError(
            f"turbine: {duration} s at {rate} Hz is no history; give a positive duration and rate "
            f"with at least {MIN_SAMPLES} samples"
        )
    rotor = turbine.rotor
    scales = length_scales(rotor.hub_height)
    radius = rotor.element_radius()[0]
    return disc_turbulence(radius, rotor.harmonics, wind_speed, *scales, duration + SETTLING, rate)


def mean_shear(turbine: Turbine, inflow: Inflow) -> Floats:
    """Mean of the steady wind around each ring over that at the hub."""
    rotor = turbine.rotor
    angle = 2.0 * np.pi / 36.0 * np.arange(36)
    above = np.outer(np.cos(angle), rotor.element_radius()[0]) * math.cos(rotor.shaft_tilt)
    height = rotor.hub_height + above
    return np.asarray(power_law(1.0, height, rotor.hub_height, inflow.shear).mean(axis=0))


def kernel_parts(turbine: Turbine, physics: Physics, inflow: Inflow):  # type: ignore[no-untyped-def]
    """The turbine as the compiled equations take it (whose module is slow to import)."""
    from fe_drivetrain.turbine_loads.hub_loads.turbine_air import Parts

    rotor = turbine.rotor
    radius, weight = rotor.element_radius()
    along = (radius - turbine.blade_root) / (rotor.radius - turbine.blade_root)

    modes = blade_modes(turbine)
    own = 2.0 * math.pi * np.array([turbine.flap_frequency, turbine.edge_frequency])
    mass = np.diag(modes.mass)
    shape = [[np.interp(along, modes.place, f) for f in mode] for mode in modes.shape]

    return Parts(
        radius=radius,
        weight=weight,
        chord=rotor.chord(radius),
        twist=rotor.twist(radius),
        shape=np.array(shape),
        lift_slope=rotor.lift_slope,
        zero_lift=rotor.zero_lift_angle,
        stall=rotor.stall_angle,
        stall_width=rotor.stall_width,
        drag=rotor.min_drag,
        density=rotor.air_density,
        tip_radius=rotor.radius,
        tilt=rotor.shaft_tilt,
        cone=turbine.cone,
        gravity=rotor.gravity,
        rotor_mass=rotor.rotor_mass,
        first_moment=modes.first_moment,
        rotor_inertia=turbine.rotor_inertia,
        generator_inertia=turbine.generator_inertia,
        force=modes.force,
        moment=modes.moment,
        products=modes.products,
        stiffening=modes.stiffening,
        stiffness=mass * own**2,
        damping=2.0 * turbine.blade_damping * mass * own,
        shaft_stiffness=turbine.shaft_stiffness,
        shaft_damping=turbine.shaft_damping,
        top_mass=turbine.top_mass,
        tower_rate=2.0 * math.pi * turbine.tower_frequency,
        tower_damping=turbine.tower_damping,
        imbalance=turbine.mass_imbalance,
        pitch_errors=np.array(turbine.pitch_errors, dtype=float),
        blades_move=physics.blades,
        tower_moves=physics.tower,
        torsion=physics.torsion,
        frozen=physics.wake == "frozen",
        wind_speed=float(inflow.speed),
        hub_height=rotor.hub_height,
        shear=float(inflow.shear),
        shadow=physics.shadow,
        overhang=turbine.overhang,
        tower_height=turbine.tower_height,
        tower_foot=turbine.tower_foot,
        tower_head=turbine.tower_head,
    )


def kernel_control(controller: Controller, held: bool):  # type: ignore[no-untyped-def]
    from fe_drivetrain.turbine_loads.hub_loads.turbine_kernel import Control

    tuning = controller.tuning
    return Control(
        optimal=controller.optimal,
        slope=controller.slope,
        origin=controller.torque_speed / (1.0 + SLIP),
        cut_in=CUT_IN_SHARE * controller.torque_speed,
        full=FULL_SHARE * controller.torque_speed,
        transition=controller.transition,
        torque_speed=controller.torque_speed,
        rated_speed=controller.rated_speed,
        rated_torque=controller.rated_torque,
        rated_power=controller.rated_power,
        constant_power=tuning.constant_power,
        min_pitch=MIN_PITCH,
        proportional=controller.proportional,
        integral=controller.integral,
        doubling=controller.doubling,
        filter=tuning.filter,
        pitch_rate=tuning.pitch_rate,
        torque_rate=tuning.torque_rate * controller.rated_torque,
        held=held,
    )
