"""What a turbine adds to its rotor when speed, pitch, blades, shaft and tower may move.

The figures are those of the NREL 5 MW turbine (Jonkman, Butterfield, Musial and Scott 2009,
NREL/TP-500-38060, and its input files of OpenFAST); another turbine is similar to it: lengths grow
with the radius, masses with the rotor's mass, frequencies with the rotor's highest speed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, fields
from typing import Literal

import numpy as np
from numpy.polynomial import Polynomial

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.turbine_loads.hub_loads.aero_rotor import Rotor

FLAP_SHAPE = Polynomial([0.0, 0.0, 0.0622, 1.7254, -3.2452, 4.7131, -2.2555])
EDGE_SHAPE = Polynomial([0.0, 0.0, 0.3627, 2.5337, -3.5772, 2.3760, -0.6952])
"""First modes over the blade's length (0 root, 1 tip): ``NRELOffshrBsline5MW_Blade.dat``."""

_PLACES = (np.arange(17) + 0.5) / 17.0
_MASS = (
    *(787.554, 464.487, 414.917, 412.664, 361.957, 346.452, 330.982, 304.395, 272.375, 250.787),
    *(211.668, 177.049, 153.160, 128.005, 102.116, 77.547, 51.403),
)
_TWIST = (
    *(13.308, 13.308, 13.308, 12.545, 10.770, 9.757, 8.731, 7.647, 6.549, 5.498, 4.462, 3.482),
    *(2.693, 1.993, 1.292, 0.598, 0.141),
)
"""Mass per length [kg/m] and structural twist [deg] at 17 nodes along the blade of the NREL 5 MW
turbine, as OpenFAST's summary of it prints them (r-test, ``5MW_Land_DLL_WTurb.ED.sum``)."""

_JONKMAN = "NREL 5 MW (Jonkman 2009)"


def _of(unit: str, source: str) -> float:
    """A dataclass field that carries its unit and its source."""
    made: float = field(metadata={"unit": unit, "source": source})
    return made


@dataclass(frozen=True)
class Turbine:
    """A rotor, what it turns, and what carries it; see `similar_turbine`.

    Attributes
    ----------
    rotor : Rotor
        Its aerodynamics and mass; three blades.
    mass_imbalance : float
        First moment of a surplus of mass on blade 1 [kg m].
    pitch_errors : tuple of float
        What stands at the pitch of each blade beyond the controller's [rad].
    """

    rotor: Rotor
    rotor_inertia: float = _of(
        "kg m^2", f"{_JONKMAN}, 38.76e6: 3 blades 11.78e6 about the axis, hub"
    )
    generator_inertia: float = _of("kg m^2", f"{_JONKMAN}, 534.116 x 97^2, at the slow shaft")
    blade_mass: float = _of("kg", f"{_JONKMAN}, 17 740; shared along it as there")
    blade_root: float = _of("m", f"{_JONKMAN}, radius of the hub 1.5")
    flap_frequency: float = _of("Hz", f"{_JONKMAN}, Table 9-1: first flapwise 0.6993, standing")
    edge_frequency: float = _of("Hz", f"{_JONKMAN}, Table 9-1: first edgewise 1.0793, standing")
    blade_damping: float = _of("-", f"{_JONKMAN}, 0.477465 % of critical")
    cone: float = _of("rad", f"{_JONKMAN}, tips 2.5 degrees upwind")
    shaft_stiffness: float = _of("N m/rad", f"{_JONKMAN}, 867.637e6")
    shaft_damping: float = _of("N m s/rad", f"{_JONKMAN}, 6.215e6")
    tower_frequency: float = _of("Hz", f"{_JONKMAN}, Table 9-1: first fore-aft 0.3240")
    tower_damping: float = _of("-", f"{_JONKMAN}, 1 % of critical")
    top_mass: float = _of("kg", f"{_JONKMAN}: rotor 110 000, nacelle 240 000; tower's share 86 750")
    overhang: float = _of("m", f"{_JONKMAN}, hub 5.0191 before the tower's axis")
    tower_height: float = _of("m", f"{_JONKMAN}, 87.6")
    tower_foot: float = _of("m", f"{_JONKMAN}, radius 3.0 at the foot")
    tower_head: float = _of("m", f"{_JONKMAN}, radius 1.935 at the top")
    mass_imbalance: float = field(default=0.0, metadata={"unit": "kg m", "source": "balanced"})
    pitch_errors: tuple[float, float, float] = field(
        default=(0.0, 0.0, 0.0), metadata={"unit": "rad", "source": "none"}
    )

    def __post_init__(self) -> None:
        if self.rotor.blades != 3:
            raise InputError(
                f"turbine: the rotor has {self.rotor.blades} blades; one that may move needs 3, "
                "or make histories with the speed and pitch of the mean wind"
            )
        for entry in fields(self):
            if entry.name in ("rotor", "mass_imbalance", "pitch_errors", "cone"):
                continue
            value = getattr(self, entry.name)
            if not (math.isfinite(value) and value > 0.0):
                unit = entry.metadata["unit"]
                raise InputError(f"turbine: {entry.name} is {value} {unit}; it must be positive")
        others = (*self.pitch_errors, self.mass_imbalance, self.cone)
        if len(others) != 5 or not all(math.isfinite(v) for v in others):
            raise InputError(
                f"turbine: pitch_errors {self.pitch_errors}, mass_imbalance {self.mass_imbalance} "
                f"and cone {self.cone} must be finite, and pitch_errors three"
            )
        if not self.tower_height < self.rotor.hub_height:
            raise InputError(
                f"turbine: tower_height is {self.tower_height} m; it must be below hub_height "
                f"{self.rotor.hub_height} m"
            )


def similar_turbine(rotor: Rotor, **changes: float | tuple[float, float, float]) -> Turbine:
    """The NREL 5 MW turbine, brought to the size of another rotor.

    Parameters
    ----------
    rotor : Rotor
        Gives radius, mass, highest speed and hub height; with those of the NREL 5 MW turbine all
        values are its own.
    **changes : float or tuple
        Attributes of `Turbine` in place of the scaled ones.
    """
    length = rotor.radius / 63.0
    mass = rotor.rotor_mass / 110.0e3
    rate = (rotor.tip_speed_limit / rotor.radius) / (80.0 / 63.0)
    inertia = mass * length**2
    values: dict[str, float | tuple[float, float, float]] = {
        "rotor_inertia": 38_759_227.0 * inertia,
        "generator_inertia": 534.116 * 97.0**2 * inertia,
        "blade_mass": 17_740.0 * mass,
        "blade_root": 1.5 * length,
        "flap_frequency": 0.6993 * rate,
        "edge_frequency": 1.0793 * rate,
        "blade_damping": 0.00477465,
        "cone": math.radians(2.5),
        "shaft_stiffness": 867.637e6 * inertia * rate**2,
        "shaft_damping": 6.215e6 * inertia * rate,
        "tower_frequency": 0.3240 * rate,
        "tower_damping": 0.01,
        "top_mass": 436_750.0 * mass,
        "overhang": 5.0191 * length,
        "tower_height": rotor.hub_height - 2.4 * length,
        "tower_foot": 3.0 * length,
        "tower_head": 1.935 * length,
    }
    return Turbine(rotor, **{**values, **changes})  # type: ignore[arg-type]


@dataclass(frozen=True)
class Physics:
    """What moves, and what is in the wind.

    Attributes
    ----------
    blades : bool
        The first flapwise and edgewise mode of each blade.
    tower : bool
        The first fore-aft and side-to-side mode, by which the hub moves without turning.
    torsion : bool
        The shaft between rotor and generator.
    shadow : bool
        Wind slows before the tower.
    wake : str
        "dynamic": induced velocities follow the loading with the delays of Oye; "frozen": they stay
        those of the mean wind.
    """

    blades: bool = True
    tower: bool = True
    torsion: bool = True
    shadow: bool = True
    wake: Literal["dynamic", "frozen"] = "dynamic"


RIGID = Physics(blades=False, tower=False, torsion=False, shadow=False)
"""A rigid turbine whose speed and pitch vary, in a wind without tower."""


FLAP, EDGE = 0, 1
OUT, IN = 0, 1
"""Modes, and components out of and in the plane of rotation at zero pitch."""


@dataclass(frozen=True, eq=False)
class BladeModes:
    """Shapes of the two modes of a blade, and integrals over its mass m and radius r.

    Both bend about the axes of their sections, which structural twist turns, so that each moves out
    of the plane of rotation and in it.

    Attributes
    ----------
    place : ndarray, (k,)
        Share of the length.
    shape : ndarray, (2, 2, k)
        By mode, component and place.
    force, moment : ndarray, (2, 2)
        Integrals of m and m r, times the shape, by mode and component [kg], [kg m].
    products : ndarray, (2, 2, 2, 2)
        Integrals of m times two shapes, by both modes and both components [kg].
    stiffening : ndarray, (2, 2)
        Integrals of the tension under unit speed of rotation times slopes of two modes [kg].
    first_moment, second_moment : float
        Integrals of m r [kg m] and m r^2 [kg m^2].
    """

    place: Floats
    shape: Floats
    force: Floats
    moment: Floats
    products: Floats
    stiffening: Floats
    first_moment: float
    second_moment: float

    @property
    def mass(self) -> Floats:
        """(2, 2), by mode [kg]."""
        return np.asarray(np.einsum("abcc->ab", self.products))


def blade_modes(turbine: Turbine, count: int = 400) -> BladeModes:
    """Modes and integrals of a blade, along which mass and twist are those of the NREL 5 MW.

    Parameters
    ----------
    turbine : Turbine
        Gives mass, root and tip of a blade.
    count : int
        Places of the integration.
    """
    length = turbine.rotor.radius - turbine.blade_root
    step = 1.0 / count
    place = step * (np.arange(count, dtype=np.float64) + 0.5)
    density = np.interp(place, _PLACES, _MASS)
    mass = turbine.blade_mass * density / density.sum()
    radius = turbine.blade_root + length * place
    twist = np.radians(np.interp(place, _PLACES, _TWIST))
    slope = np.empty((2, 2, count))
    for mode, polynomial in ((FLAP, FLAP_SHAPE), (EDGE, EDGE_SHAPE)):
        bent = polynomial.deriv(2)(place)
        own, other = np.cos(twist) * bent, np.sin(twist) * bent
        if mode == FLAP:  # at a twist, the suction side looks into the sense of rotation
            slope[mode] = _integral([own, other], step)
        else:
            slope[mode] = _integral([-other, own], step)
    shape = _integral(slope, step)
    tension = np.cumsum((mass * radius)[::-1])[::-1] - 0.5 * mass * radius
    return BladeModes(
        place,
        shape,
        shape @ mass,
        shape @ (mass * radius),
        np.einsum("acx,bdx,x->abcd", shape, shape, mass),
        np.einsum("acx,bcx,x->ab", slope, slope, tension) * step / length,
        float(mass @ radius),
        float(mass @ radius**2),
    )


def _integral(values: list[Floats] | Floats, step: float) -> Floats:
    """From the root to each of the places, which are in the middle of their steps."""
    whole = np.asarray(values)
    return np.asarray((np.cumsum(whole, axis=-1) - 0.5 * whole) * step)


def natural_frequencies(
    turbine: Turbine, rotor_speed: float, pitch: float = 0.0
) -> dict[str, float]:
    """Frequencies of the modes that a turning rotor has without air, on a tower that stands [Hz].

    Parameters
    ----------
    turbine : Turbine
        The turbine.
    rotor_speed : float
        [rad/s].
    pitch : float
        Pitch of all blades [rad].

    Returns
    -------
    dict
        "flap" and "edge" of one blade while the others move against it; "flap, all blades" and
        "edge, all blades" with a rotor that answers and a shaft free at the generator; "torsion" of
        rigid rotor and generator.  Forces on a standing frame have the first two plus and minus 1P.
    """
    modes = blade_modes(turbine)
    turn = np.array([[np.cos(pitch), -np.sin(pitch)], [np.sin(pitch), np.cos(pitch)]])
    own = 2.0 * np.pi * np.array([turbine.flap_frequency, turbine.edge_frequency])
    in_plane = np.einsum("c,d,abcd->ab", turn[IN], turn[IN], modes.products)
    stiffness = np.diag(np.diag(modes.mass) * own**2)
    stiffness = stiffness + rotor_speed**2 * (modes.stiffening - in_plane)
    moment = modes.moment @ turn[IN]
    # the rotor, of which nothing holds the angle, takes its share of inertia
    together = modes.mass - 3.0 * np.outer(moment, moment) / turbine.rotor_inertia

    def frequencies(mass: Floats) -> list[float]:
        values = np.linalg.eigvals(np.linalg.solve(mass, stiffness))
        return [math.sqrt(v) / (2.0 * math.pi) for v in np.sort(values.real).tolist()]

    flap, edge = frequencies(modes.mass)
    flap_all, edge_all = frequencies(together)
    torsion = turbine.shaft_stiffness * (1 / turbine.rotor_inertia + 1 / turbine.generator_inertia)
    return {
        "flap": flap,
        "edge": edge,
        "flap, all blades": flap_all,
        "edge, all blades": edge_all,
        "torsion": math.sqrt(torsion) / (2.0 * math.pi),
    }
