"""Meshes of a user's drivetrain as the cases of gears rate, slice and count them."""

from __future__ import annotations

from collections.abc import Mapping
from math import pi
from typing import NamedTuple

from fe_drivetrain.cases.references.rated_gears import HOURS, RatedMesh
from fe_drivetrain.common import InputError
from fe_drivetrain.drivetrain_file.gear_strength import GearStrength
from fe_drivetrain.drivetrain_file.machine_table import MachineTable
from fe_drivetrain.gear import LoadFactors, Running
from fe_drivetrain.report.suite import Page
from fe_drivetrain.report.suite.chosen import ChosenDrivetrain
from fe_drivetrain.studies import GearOptions
from fe_drivetrain.studies.gear_findings import BY_QUALITY
from fe_drivetrain.studies.gear_machine import GearTrain, gear_train
from fe_drivetrain.studies.gear_meshes import GearMesh, gear_meshes
from fe_drivetrain.studies.gear_stresses import MeshStresses

TORSIONAL = GearOptions(level="torsional")
"""Load factors as the file has them, or by formula: what the cases of single meshes take."""


class OwnMeshes(NamedTuple):
    """Meshes of a drivetrain whose gears are given in full, by name.

    Attributes
    ----------
    train : GearTrain
        The machine, its rated torque and speed.
    meshes : dict of str to GearMesh
        Meshes with their gears.
    """

    train: GearTrain
    meshes: dict[str, GearMesh]


def own_meshes(chosen: ChosenDrivetrain, page: Page) -> OwnMeshes:
    """Meshes of a user's drivetrain under its rated torque; see `given_meshes`.

    Raises
    ------
    InputError
        No mesh has all of its gears' data, or the file does not state its operation.
    """
    chosen.rated_torque()  # names operation where it is missing
    train = gear_train(chosen.drivetrain, TORSIONAL, None)
    return OwnMeshes(train, given_meshes(chosen, train.machine, train.strengths, page))


def given_meshes(
    chosen: ChosenDrivetrain,
    machine: MachineTable,
    strengths: Mapping[int, GearStrength],
    page: Page,
) -> dict[str, GearMesh]:
    """Meshes of a user's drivetrain; those without full data are named on the page.

    Parameters
    ----------
    chosen : ChosenDrivetrain
        The drivetrain.
    machine : MachineTable
        Its machine.
    strengths : mapping of int to GearStrength
        Strength of stages by their number, from 1.
    page : Page
        The page.

    Raises
    ------
    InputError
        No mesh has all of its gears' data.
    """
    meshes, left_out = gear_meshes(machine, strengths)
    if not meshes:
        raise InputError(
            f"drivetrain {chosen.name!r} has no mesh whose gears are given in full, which this "
            f"case needs: give {'; '.join(dict.fromkeys(left_out.values()))}"
        )
    _name_left_out(page, left_out)
    page.assume_all(machine.assumptions())
    return meshes


def _name_left_out(page: Page, missing: Mapping[str, str]) -> None:
    if missing:
        words = "; ".join(f"{name} ({keys})" for name, keys in missing.items())
        page.note(f"Left out, since the file lacks what stands in brackets: {words}.")


class OwnRating(NamedTuple):
    """A mesh of a user's drivetrain that has all that a rating needs.

    Attributes
    ----------
    mesh : GearMesh
        The mesh, its flanks and the strength that the file states.
    rated : RatedMesh
        The same for `rated`; nothing is printed of it.
    """

    mesh: GearMesh
    rated: RatedMesh


def own_ratings(chosen: ChosenDrivetrain, page: Page) -> tuple[OwnMeshes, list[OwnRating]]:
    """Meshes of a user's drivetrain at its rated torque, with what they endure.

    Raises
    ------
    InputError
        No mesh has all that a rating needs; the message names the keys.
    """
    own = own_meshes(chosen, page)
    missing = {
        name: ", ".join(keys)
        for name, mesh in own.meshes.items()
        if (keys := (*mesh.missing, *own.train.missing))
    }
    if len(missing) == len(own.meshes):
        lacking = dict.fromkeys(key for one in missing.values() for key in one.split(", "))
        raise InputError(
            f"drivetrain {chosen.name!r} has no mesh with all that a rating by ISO 6336 needs: "
            f"give {'; '.join(lacking)}"
        )
    _name_left_out(page, missing)
    if any(s.quality for one in own.train.strengths.values() for s in one.gears.values()):
        page.note(BY_QUALITY)
    return own, [
        OwnRating(mesh, _rated(own.train, mesh))
        for name, mesh in own.meshes.items()
        if name not in missing
    ]


def _rated(train: GearTrain, mesh: GearMesh) -> RatedMesh:
    """A mesh with its strength and all deviations, at the rated torque over twenty years."""
    stresses, strength = MeshStresses(mesh, train.conditions), mesh.strength
    steels = [flank.steel for flank in mesh.flanks]
    speed, viscosity = train.conditions.speed, train.conditions.viscosity
    deviations = mesh.deviations
    if strength is None or deviations is None or speed is None or viscosity is None:
        raise InputError(f"{mesh.name} lacks {', '.join(mesh.missing)}: give what it lacks")
    sharing, face = stresses.formula(train.torque, speed, strength.application or 1.0)
    dynamic = (strength.dynamic or {}).get(mesh.key)
    turns = speed / (2.0 * pi) * 3600.0 * HOURS
    first, second = (
        (one.flank_roughness, one.root_roughness, one.rim) for one in steels if one is not None
    )
    return RatedMesh(
        name=mesh.name,
        pair=mesh.pair,
        materials=mesh.materials,
        running=Running(
            stresses.torque(train.torque),
            speed * mesh.speed_ratio,
            viscosity,
            (first[0], second[0]),
            (first[1], second[1]),
        ),
        cycles=(mesh.flanks[0].loads * turns, mesh.flanks[1].loads * turns),
        stiffness=(mesh.stiffness.single, mesh.stiffness.mesh),
        factors=LoadFactors(strength.application or 1.0, sharing, dynamic or 1.0, face),
        mass=mesh.mass,
        deviations=deviations[:2],
        tooth_height=mesh.tooth_height,
        computed_dynamics=(dynamic is None, True),
        cutter=mesh.cutter,
        mean_stress=(mesh.flanks[0].mean_stress, mesh.flanks[1].mean_stress),
        rims=(first[2], second[2]),
    )
