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

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.hub_loads.aero_rotor import Rotor

FLAP_SHAPE = Polynomial([0.0, 0.0, 0.0622, 1.7254, -3.2452, 4.7131, -2.2555])
EDGE_SHAPE = Polynomial([0.0, 0.0, 0.3627, 2.5337, -3.5772, 2.3760, -0.6952])
"""First modes over the blade's length (0 root, 1 tip): ``NRELOffshrBsline5MW_Blade.dat``."""

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
    blade_mass: float = _of("kg", f"{_JONKMAN}, 17 740; falls evenly to nothing at the tip")
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


@dataclass(frozen=True)
class ModeIntegrals:
    """Integrals over a blade of mass per length m, radius r and mode shape f.

    Attributes
    ----------
    force : float
        Of m f [kg].
    moment : float
        Of m r f [kg m].
    mass : float
        Of m f^2 [kg].
    stiffening : float
        Of T f'^2 with the tension T under unit speed of rotation [kg]: stiffness is its product
        with the square of the speed.
    """

    force: float
    moment: float
    mass: float
    stiffening: float


def mode_integrals(turbine: Turbine, shape: Polynomial) -> ModeIntegrals:
    """Integrals of a mode over a blade whose mass per length falls evenly to nothing at the tip.

    Parameters
    ----------
    turbine : Turbine
        Gives mass, root and tip of a blade.
    shape : Polynomial
        Over the length, 0 at the root and 1 at the tip.
    """
    length = turbine.rotor.radius - turbine.blade_root
    density = 2.0 * turbine.blade_mass * Polynomial([1.0, -1.0])  # over the share of the length
    radius = Polynomial([turbine.blade_root, length])

    def whole(integrand: Polynomial) -> float:
        return float(integrand.integ()(1.0))

    inside = (density * radius).integ()
    tension = float(inside(1.0)) - inside
    return ModeIntegrals(
        whole(density * shape),
        whole(density * radius * shape),
        whole(density * shape**2),
        whole(tension * shape.deriv() ** 2) / length,
    )


def first_moment(turbine: Turbine) -> float:
    """Of one blade about the axis of rotation [kg m]."""
    length = turbine.rotor.radius - turbine.blade_root
    return turbine.blade_mass * (turbine.blade_root + length / 3.0)


def natural_frequencies(turbine: Turbine, rotor_speed: float) -> dict[str, float]:
    """Frequencies of the modes that a turning rotor has without air [Hz].

    Parameters
    ----------
    turbine : Turbine
        The turbine.
    rotor_speed : float
        [rad/s].

    Returns
    -------
    dict
        "flap" and "edge" of one blade on a hub that stands; "edge, all blades" with a hub and rotor
        free to answer (shaft free at the generator); "torsion" of rigid rotor and generator.
        Both are in the frame that turns: forces on a standing frame have them plus and minus 1P.
    """
    flap, edge = (mode_integrals(turbine, shape) for shape in (FLAP_SHAPE, EDGE_SHAPE))
    square = rotor_speed**2
    of_flap = (2.0 * np.pi * turbine.flap_frequency) ** 2 + square * flap.stiffening / flap.mass
    of_edge = (2.0 * np.pi * turbine.edge_frequency) ** 2
    of_edge += square * (edge.stiffening / edge.mass - 1.0)
    together = 1.0 - 3.0 * edge.moment**2 / (edge.mass * turbine.rotor_inertia)
    torsion = turbine.shaft_stiffness * (1 / turbine.rotor_inertia + 1 / turbine.generator_inertia)
    squares = {
        "flap": of_flap,
        "edge": of_edge,
        "edge, all blades": of_edge / together,
        "torsion": torsion,
    }
    return {name: math.sqrt(value) / (2.0 * math.pi) for name, value in squares.items()}
