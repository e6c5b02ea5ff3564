"""Gears of a machine that has all of their data: pairs, mesh stiffness, stresses."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from math import cos, sin

from fe_drivetrain.drivetrain_file.gear_stages import OF_TEETH, ParallelData, PlanetaryData
from fe_drivetrain.drivetrain_file.stage_gears import stage_pairs
from fe_drivetrain.dynamics.bodies.machine import Machine
from fe_drivetrain.gear.flank_stress import LineContact, reduced_modulus
from fe_drivetrain.gear.involute import Pair
from fe_drivetrain.gear.iso import iso_gear_stiffness
from fe_drivetrain.gear.load_factors import LoadFactors
from fe_drivetrain.gear.meshes import StiffnessTable, mesh_stiffness
from fe_drivetrain.gear.pair_stiffness import Law
from fe_drivetrain.gear.rating import ContactStress, RootStress, contact_stress, root_stress
from fe_drivetrain.gear.root_geometry import Cutter
from fe_drivetrain.gear.strength import GearMaterial
from fe_drivetrain.gear.working_angles import Mesh

STEELS = (GearMaterial("case-hardened", 1500e6, 430e6),) * 2
"""Case-hardened gears of quality MQ, ISO 6336-5."""

NO_FACTORS = "load factors: assumed: all 1, stresses are nominal"


def machine_pairs(machine: Machine) -> dict[str, Pair]:
    """Pairs of gears of all meshes.

    Parameters
    ----------
    machine : Machine
        Table of the machine, with a module, teeth and profile shifts of each stage.

    Returns
    -------
    pairs : dict[str, Pair]
        Pairs by "stage 1 sun-planet", "stage 1 ring-planet", "stage 3 mesh" and so on; the pinion
        of a parallel stage first.

    Raises
    ------
    InputError
        A stage lacks data, or its gears do not fit.
    """
    return {
        f"stage {number} {mesh}": pair
        for number, stage in enumerate(machine.stages, start=1)
        for mesh, pair in stage_pairs(stage, f"stage {number}").items()
    }


def contact_ratios(machine: Machine) -> dict[str, float]:
    """Mean number of pairs of teeth in contact, of all meshes, as `machine_meshing` takes them.

    Parameters
    ----------
    machine : Machine
        Table of the machine, as `machine_pairs` takes it.
    """
    return {name: pair.contact_ratio for name, pair in machine_pairs(machine).items()}


def mesh_courses(machine: Machine, law: Callable[[Pair], Law]) -> dict[str, StiffnessTable]:
    """Stiffness of all meshes over their phase, as `machine_meshing` takes it.

    Parameters
    ----------
    machine : Machine
        Table of the machine, as `machine_pairs` takes it.
    law : callable
        Function from a pair of gears to the law of one pair of teeth, such as `parabolic_law`.

    Returns
    -------
    courses : dict[str, StiffnessTable]
        Stiffness tables by the names of `machine_pairs` [N/m].
    """
    return {name: mesh_stiffness(pair, law(pair)) for name, pair in machine_pairs(machine).items()}


def with_iso_stiffness(machine: Machine) -> Machine:
    """Machine with the mean mesh stiffness of ISO 6336-1, method B, in place of its own.

    Parameters
    ----------
    machine : Machine
        Table of the machine, as `machine_pairs` takes it.

    Returns
    -------
    machine : Machine
        Machine with each mesh as stiff as c_gamma_alpha times the face width, along its line of
        action.
    """
    data = machine.model_dump(exclude_none=True)
    keys = {"sun-planet": "sun_planet", "ring-planet": "ring_planet", "mesh": "stiffness"}
    for name, pair in machine_pairs(machine).items():
        _, number, mesh = name.split(" ")
        stage = data["stages"][int(number) - 1]
        stage["stiffness_of"] = "line"
        stage[keys[mesh]] = iso_gear_stiffness(pair, blank=stage["blank"]).mesh * pair.face_width
    return Machine.model_validate(data)


@dataclass(frozen=True)
class MeshStress:
    """Stresses of a mesh under a torque on the rotor, by ISO 6336.

    Attributes
    ----------
    pair : Pair
        Gears of the mesh.
    torque : float
        Torque on the first gear in this mesh [N m].
    contact : ContactStress
        Hertz pressure of both flanks.
    roots : tuple of RootStress, or None
        Root stresses of both gears; none of a ring whose cutter is not known.
    assumed : tuple of str
        Names of what was not given and counts here: load factors, and keys of the stage.
    """

    pair: Pair
    torque: float
    contact: ContactStress
    roots: tuple[RootStress, RootStress] | None
    assumed: tuple[str, ...]


def mesh_stresses(
    machine: Machine,
    torque: float,
    factors: Mapping[str, LoadFactors] | None = None,
    materials: tuple[GearMaterial, GearMaterial] = STEELS,
) -> dict[str, MeshStress]:
    """Contact and root stresses of all meshes under a torque on the rotor, without losses.

    Parameters
    ----------
    machine : Machine
        Table of the machine, as `machine_pairs` takes it.
    torque : float
        Torque on the rotor [N m].
    factors : mapping of str to LoadFactors, optional
        Load factors by the names of `machine_pairs`; all 1 where left out. Planets share the torque
        equally but for K_gamma.
    materials : tuple of GearMaterial
        Materials of both gears of each pair, of which the elasticity counts here.

    Returns
    -------
    stresses : dict[str, MeshStress]
        Stresses by the names of `machine_pairs`.
    """
    given, found = factors or {}, {}
    for name, pair in machine_pairs(machine).items():
        number = int(name.split(" ")[1])
        stage = machine.stages[number - 1]
        on_first, cutter = abs(torque / machine.speeds[number]), None
        if isinstance(stage, PlanetaryData):
            on_first /= stage.planets
            if name.endswith("ring-planet"):
                _, planet, sun = stage.teeth or (0, 1, 1)
                on_first *= planet / sun
                cutter = Cutter(stage.cutter) if stage.cutter else None
        own = given.get(name, LoadFactors())
        known = cutter is not None or not pair.internal
        found[name] = MeshStress(
            pair,
            on_first,
            contact_stress(pair, on_first, own, materials),
            root_stress(pair, on_first, own, cutter) if known else None,
            (*(() if name in given else (NO_FACTORS,)), *silent_keys(stage)),
        )
    return found


def silent_keys(stage: PlanetaryData | ParallelData) -> list[str]:
    """Assumed keys of a stage's gears, a phrase each."""
    of_gears = ("pressure_angle", *OF_TEETH)
    silent = [row for row in stage.assumptions() if row.is_assumed]
    return [f"{row.name}: {row.source}" for row in silent if row.name in of_gears]


@dataclass(frozen=True)
class PitchContact:
    """Flanks of a mesh at its pitch point, as cylinders.

    Attributes
    ----------
    mesh : Mesh
        Angles and face width.
    radius : float
        Relative radius of curvature, in the normal plane [m].
    """

    mesh: Mesh
    radius: float

    def under(self, force: float, share: float = 1.0) -> LineContact:
        """Contact of one pair of teeth, of steel.

        Parameters
        ----------
        force : float
            Force normal to the flanks, in space [N].
        share : float
            Share of the face width that carries the force, such as 1/5 of one of five slices.

        Returns
        -------
        LineContact
            Contact whose length is the width over cos(beta_b), along the inclined lines.
        """
        length = share * self.mesh.face_width / cos(self.mesh.base_helix)
        return LineContact(abs(force) / length, self.radius, reduced_modulus())


def pitch_contacts(machine: Machine) -> dict[str, PitchContact]:
    """Contacts of all meshes at their pitch points, by the machine's own working circles.

    Parameters
    ----------
    machine : Machine
        Table of the machine; profile shifts are not needed.

    Returns
    -------
    contacts : dict[str, PitchContact]
        Contacts by the names of `machine_pairs`.
    """
    found = {}
    for number, stage in enumerate(machine.stages, start=1):
        a = stage.centre_distance
        if isinstance(stage, PlanetaryData):
            sun, ring = stage.meshes
            r = stage.sun_radius
            # one base circle of the planet, two working circles
            planet = (a - r) * cos(sun.pressure_angle) / cos(ring.pressure_angle)
            found[f"stage {number} sun-planet"] = _at_pitch(sun, r, a - r)
            found[f"stage {number} ring-planet"] = _at_pitch(ring, planet, -(a + planet))
        else:
            r = stage.gear_radius
            found[f"stage {number} mesh"] = _at_pitch(stage.meshing, r, a - r)
    return found


def _at_pitch(mesh: Mesh, one: float, two: float) -> PitchContact:
    """The pair at its working pitch radii [m], negative for a ring."""
    curvature = (1 / one + 1 / two) * cos(mesh.base_helix) / sin(mesh.pressure_angle)
    return PitchContact(mesh, 1 / curvature)
