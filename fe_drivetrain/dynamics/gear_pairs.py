"""Gears of a machine that has all of their data: pairs, mesh stiffness and contact ratios."""

from collections.abc import Callable
from math import radians

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.dynamics.tables import Machine, ParallelData, PlanetaryData
from fe_drivetrain.gear.involute import Gear, Pair
from fe_drivetrain.gear.iso import iso_stiffness
from fe_drivetrain.gear.meshes import StiffnessTable, mesh_stiffness
from fe_drivetrain.gear.pair_stiffness import Law


def machine_pairs(machine: Machine) -> dict[str, Pair]:
    """Pairs of gears of all meshes.

    Parameters
    ----------
    machine : Machine
        Its table, with a module, teeth, profile shifts and tip diameters of each stage.

    Returns
    -------
    pairs : dict[str, Pair]
        By "stage 1 sun-planet", "stage 1 ring-planet", "stage 3 mesh" and so on; the pinion of a
        parallel stage first.

    Raises
    ------
    InputError
        A stage lacks data, or its gears do not fit.
    """
    found = {}
    for number, stage in enumerate(machine.stages, start=1):
        gears = _gears(stage, number)
        if isinstance(stage, PlanetaryData):
            ring, planet, sun = gears
            found[f"stage {number} sun-planet"] = Pair(sun, planet, stage.centre_distance)
            found[f"stage {number} ring-planet"] = Pair(planet, ring, stage.centre_distance)
        else:
            wheel, pinion = gears
            found[f"stage {number} mesh"] = Pair(pinion, wheel, stage.centre_distance)
    return found


def _gears(stage: PlanetaryData | ParallelData, number: int) -> list[Gear]:
    """In the order of the teeth."""
    if stage.teeth is None or stage.module is None or stage.shifts is None or stage.tips is None:
        raise InputError(
            f"stage {number} has no full data of its gears: give teeth, module, shifts and tips"
        )
    helix = stage.hand * radians(stage.helix)
    planetary = isinstance(stage, PlanetaryData)
    # a sun is opposite to its planets, and they are as their ring; a wheel opposite to its pinion
    helices = (-helix, -helix, helix) if planetary else (helix, -helix)
    signs = (-1, 1, 1) if planetary else (1, 1)
    return [
        Gear(
            sign * teeth,
            stage.module,
            stage.face_width,
            turned,
            shift,
            pressure_angle=radians(stage.pressure_angle),
            tip_diameter=tip,
        )
        for sign, teeth, turned, shift, tip in zip(
            signs, stage.teeth, helices, stage.shifts, stage.tips, strict=True
        )
    ]


def contact_ratios(machine: Machine) -> dict[str, float]:
    """Pairs of teeth in contact on average, of all meshes, as `machine_meshing` takes them.

    Parameters
    ----------
    machine : Machine
        As of `machine_pairs`.
    """
    return {name: pair.contact_ratio for name, pair in machine_pairs(machine).items()}


def mesh_courses(machine: Machine, law: Callable[[Pair], Law]) -> dict[str, StiffnessTable]:
    """Stiffness of all meshes over their phase, as `machine_meshing` takes it.

    Parameters
    ----------
    machine : Machine
        As of `machine_pairs`.
    law : callable
        From a pair of gears to the law of one pair of teeth, such as `parabolic_law`.

    Returns
    -------
    courses : dict[str, StiffnessTable]
        By the names of `machine_pairs` [N/m].
    """
    return {name: mesh_stiffness(pair, law(pair)) for name, pair in machine_pairs(machine).items()}


def with_iso_stiffness(machine: Machine) -> Machine:
    """The machine with the mean mesh stiffness of ISO 6336-1, method B, in place of its own.

    Parameters
    ----------
    machine : Machine
        As of `machine_pairs`.

    Returns
    -------
    machine : Machine
        Each mesh as stiff as c_gamma_alpha times the face width, along its line of action.
    """
    data = machine.model_dump(exclude_none=True)
    keys = {"sun-planet": "sun_planet", "ring-planet": "ring_planet", "mesh": "stiffness"}
    for name, pair in machine_pairs(machine).items():
        _, number, mesh = name.split(" ")
        stage = data["stages"][int(number) - 1]
        stage["stiffness_of"] = "line"
        stage[keys[mesh]] = iso_stiffness(pair, blank=stage["blank"]).mesh * pair.face_width
    return Machine.model_validate(data)
