"""Two masses on a shaft as a drivetrain's file: what it does in time has closed forms."""

from typing import Any

import yaml

from fe_drivetrain.drivetrain_file import Drivetrain, parse_drivetrain

ROTOR, GENERATOR = 4e6, 1e6
"""Inertias [kg m^2]."""
STIFFNESS, TORQUE, SPEED = 2e8, 1e6, 1.5
"""Stiffness of the shaft [N m/rad]; rated torque and speed of the rotor [N m, rad/s]."""


def two_mass_file(**more: Any) -> dict[str, Any]:
    """The file as plain data; no damping where none is given."""
    return {
        "title": "Two masses",
        "rotor": {"inertia": ROTOR},
        "shaft": {"name": "shaft", "torsion": STIFFNESS},
        "generator": {"inertia": GENERATOR},
        "operation": {"rated_power": TORQUE * SPEED, "rotor_speed": [0.5, SPEED]},
        "damping": {"shafts": 0.0, "meshes": 0.0},
        **more,
    }


def two_masses(**more: Any) -> Drivetrain:
    """Two masses on a shaft, without gears."""
    return parse_drivetrain(yaml.safe_dump(two_mass_file(**more)))
