"""A shaft of a machine as a scene of its own, to be condensed as beam, meridian or solid."""

from typing import Any

from fe_drivetrain.common import InputError
from fe_drivetrain.common.reading import validated
from fe_drivetrain.drivetrain_file import Scene
from fe_drivetrain.dynamics import Machine

#: Of a seat, over the shaft's diameter.
SEAT = 0.2


def shaft_scene(machine: Machine, name: str, size: float = 0.2) -> Scene:
    """A round shaft of a machine with its bearings' seats; its supports have no part in this.

    Parameters
    ----------
    machine : Machine
        Its table.
    name : str
        Name of a shaft that is given by its size.
    size : float
        Size of elements over the diameter.

    Returns
    -------
    Scene
        The shaft begins at x = 0; its reference points are "hub", its bearings and "gearbox".

    Raises
    ------
    InputError
        There is no such shaft.
    """
    given = {shaft.name: shaft for shaft in machine.shafts if shaft.has_mass}
    if name not in given:
        raise InputError(f"no shaft {name!r} with a diameter: use one of {', '.join(given)}")
    shaft = given[name]
    sections = [section.model_dump(exclude_none=True) for section in shaft.sections or ()]
    if shaft.outer is not None:
        size_of = {"outer_diameter": shaft.outer, "inner_diameter": shaft.inner}
        sections = [{"length": shaft.length, **size_of}]
    d = max(section["outer_diameter"] for section in sections)
    return validated(
        Scene,
        {
            "title": f"{name} of {machine.title}",
            "materials": {"shaft_steel": shaft.material.model_dump()},
            "shaft": {
                "front": 0.0,
                "material": "shaft_steel",
                "sections": sections,
            },
            "bearing_units": units_of(machine, name, d),
            "gearbox": {"stiffness": [1e6] * 6},
            "mesh": {"shaft": size * d, "bearing": size * d, "housing": size * d},
        },
        f"shaft {name}",
    )


def units_of(machine: Machine, name: str, d: float) -> list[dict[str, Any]]:
    """Bearing units of a shaft, their seats and housings in proportion to its diameter d [m]."""
    return [
        {
            "bearing": {
                "name": bearing.name.replace("-", "_"),
                "x": bearing.at,
                "width": SEAT * d,
                "kind": "ring",
                "raceway_diameter": 1.3 * d,
            },
            "housing": {
                "width": 0.3 * d,
                "wall": 0.25 * d,
                "foot_width": 0.4 * d,
                "pedestal_width": 2.0 * d,
                "centre_height": 1.0 * d,
                "foot_length": 3.0 * d,
            },
            "interface": "bonded",
        }
        for bearing in machine.bearings
        if bearing.holds == name
    ]
