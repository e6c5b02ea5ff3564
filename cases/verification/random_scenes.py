"""Random scenes, inside the limits of what can be built, to measure if bands of assemblies hold.

Shafts with steps, fillets, tapers and bores on one bearing unit or two, of every interface, on the
ground or on a bedplate that gives. All follows from a seed, so that a scene can be looked at again.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from fe_drivetrain.common import InputError
from fe_drivetrain.common.reading import validated
from fe_drivetrain.drivetrain_file import Scene

#: The interface of the first bearing, in turn.
INTERFACES = ("bonded", "spring", "rollers", "sliding", "averaged", "rigid")
#: Element sizes [m], and how many round a turn: coarse, so that a much finer mesh is affordable.
SHAFT, BEARING, TURNS = (0.14, 0.18), (0.1, 0.13), (8, 11)


def random_scene(seed: int) -> Scene:
    """A random drivetrain, about as large as the library's main bearings.

    Parameters
    ----------
    seed : int
        Of the random numbers; the same seed makes the same scene. Its remainder by six is the
        number of the first bearing's interface.

    Returns
    -------
    Scene
        On a coarse mesh.
    """
    rng = np.random.default_rng(seed)
    while True:
        try:
            return validated(Scene, _drawn(rng, seed), f"random scene {seed}")
        except InputError:  # a fillet that is too large for its step, a seat beside a fillet
            continue


def _drawn(rng: np.random.Generator, seed: int) -> dict[str, Any]:
    seat = float(rng.uniform(0.34, 0.42))
    bore = seat * float(rng.uniform(0.15, 0.3)) if rng.random() < 0.6 else 0.0
    interfaces = [INTERFACES[seed % len(INTERFACES)]]
    if rng.random() < 0.2:
        interfaces.append(INTERFACES[int(rng.integers(len(INTERFACES)))])
    sections: list[dict[str, Any]] = [_section(rng, seat * float(rng.uniform(1.1, 1.4)), bore)]
    units = []
    at = 0.0
    for number, interface in enumerate(interfaces):
        section = _section(rng, seat, bore) | {"length": float(rng.uniform(0.5, 0.8))}
        units.append(_unit(rng, f"bearing_{number + 1}", at + section["length"] / 2, interface))
        at += section["length"]
        seat *= float(rng.uniform(0.88, 0.95))
        sections += [section, _section(rng, seat, bore)]
        if rng.random() < 0.3:
            sections[-1]["outer_diameter_end"] = seat * float(rng.uniform(0.88, 0.96))
            seat = sections[-1]["outer_diameter_end"]
        at += sections[-1]["length"]
        seat *= float(rng.uniform(0.9, 0.95))
    if rng.random() < 0.3:  # small ones make meshes of many elements: of the largest step alone
        step = sections[0]["outer_diameter"] - sections[1]["outer_diameter"]
        sections[0]["fillet"] = step / 2 * float(rng.uniform(0.5, 0.9))
    ring = float(rng.uniform(*BEARING))
    return {
        "title": f"Random scene {seed}",
        "shaft": {"front": -sections[0]["length"], "sections": sections},
        "bearing_units": units,
        "hub": {"coupling": str(rng.choice(["averaged", "rigid"]))},
        "gearbox": {
            "stiffness": [
                *(10.0 ** rng.uniform(7.0, 9.0, 3)).tolist(),
                *(10.0 ** rng.uniform(6.0, 8.0, 3)).tolist(),
            ]
        },
        "mesh": {
            "shaft": float(rng.uniform(*SHAFT)),
            "bearing": ring,
            "housing": ring * float(rng.uniform(1.0, 1.3)),
            "bearing_edge": ring * float(rng.uniform(0.9, 1.2)),
            "elements_per_turn": int(rng.integers(*TURNS)),
        },
    }


def _section(rng: np.random.Generator, diameter: float, bore: float) -> dict[str, Any]:
    wider = bore > 0 and rng.random() < 0.25
    return {
        "length": float(rng.uniform(0.25, 0.8)),
        "outer_diameter": diameter,
        "inner_diameter": bore * (float(rng.uniform(1.1, 1.3)) if wider else 1.0),
    }


def _unit(rng: np.random.Generator, name: str, x: float, interface: str) -> dict[str, Any]:
    width, wall = float(rng.uniform(0.16, 0.22)), float(rng.uniform(0.1, 0.15))
    raceway = float(rng.uniform(0.56, 0.64))
    rolling = interface in ("bonded", "spring", "rollers")
    unit: dict[str, Any] = {
        "bearing": {
            "name": name,
            "x": x,
            "width": width,
            "kind": "ring" if rolling else "spherical",
            "raceway_diameter": raceway,
        },
        "housing": {
            "width": width + float(rng.uniform(0.06, 0.12)),
            "wall": wall,
            "foot_width": width + float(rng.uniform(0.13, 0.18)),
            "pedestal_width": raceway + 2.0 * wall,
            "centre_height": raceway / 2 + float(rng.uniform(0.11, 0.2)),
        },
        "interface": interface,
    }
    if interface == "spring":
        k = 10.0 ** rng.uniform(8.5, 10.0, 6)
        unit["stiffness"] = (k * np.repeat([1.0, 0.01], 3)).tolist()
    elif interface == "rollers":
        apart = width / 4
        unit["rollers"] = {
            "count": int(rng.integers(16, 31)),
            "stiffness": float(10.0 ** rng.uniform(8.0, 9.5)),
            "rows": [{"x": -apart, "contact_angle": -10.0}, {"x": apart, "contact_angle": 10.0}],
        }
    if rng.random() < 0.3:
        k = 10.0 ** rng.uniform(8.5, 10.0, 6)
        unit["bedplate"] = (k * np.repeat([1.0, 0.1], 3)).tolist()
    return unit
