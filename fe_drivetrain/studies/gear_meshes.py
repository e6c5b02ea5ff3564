"""Meshes of a machine as they are rated: gears, loads per turn, strength, and what is missing."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.gear_stages import ParallelData, PlanetaryData
from fe_drivetrain.drivetrain_file.gear_strength import GearSteel, GearStrength
from fe_drivetrain.drivetrain_file.machine_table import MachineTable
from fe_drivetrain.drivetrain_file.stage_gears import stage_pairs
from fe_drivetrain.dynamics.bodies.mesh_loads import mesh_springs
from fe_drivetrain.gear.accuracy import gear_tolerances
from fe_drivetrain.gear.damage import ParallelStage, PlanetaryStage, loads_per_turn
from fe_drivetrain.gear.involute import Gear, Pair
from fe_drivetrain.gear.iso import IsoStiffness, iso_gear_stiffness
from fe_drivetrain.gear.load_factors import reduced_mass
from fe_drivetrain.gear.root_geometry import Cutter
from fe_drivetrain.gear.strength import GearMaterial

NOMINAL_STEEL = GearMaterial("case-hardened", 1500e6, 430e6)
"""Steel whose elasticity counts where the file states no strength."""

_NEEDED, _SIZES = ("teeth", "module", "shifts"), ("centre_distance", "face_width")

ALTERNATING = 0.7
"""Y_M of a planet, whose roots are bent both ways (ISO 6336-3)."""


@dataclass(frozen=True)
class Flank:
    """One flank of a gear in a mesh.

    Attributes
    ----------
    name : str
        As `loads_per_turn` names it, "stage 1 planet, flank to sun".
    loads : float
        Loads of the flank of a tooth per turn of the rotor.
    gear : Gear
        The gear.
    steel : GearSteel or None
        What the file states of its steel.
    mean_stress : float
        Y_M.
    """

    name: str
    loads: float
    gear: Gear
    steel: GearSteel | None
    mean_stress: float = 1.0

    @property
    def material(self) -> GearMaterial:
        """Its steel; where none is stated, one with the elasticity of steel."""
        if self.steel is None:
            return NOMINAL_STEEL
        contact, root = self.steel.limits
        return GearMaterial(
            self.steel.steel,
            contact,
            root,
            self.steel.yield_strength or 0.0,
            self.steel.brinell or 0.0,
        )


@dataclass(frozen=True)
class GearMesh:
    """A mesh with its gears.

    Attributes
    ----------
    name : str
        As `machine_pairs` names it.
    stage : int
        Number of its stage, from 1.
    planets : int
        Number of planets that share the torque; 1 of a pair.
    pair : Pair
        Both gears, the first one the sun, the planet in the ring, or the pinion.
    flanks : tuple of Flank
        Flanks of both gears.
    torque_ratio : float
        Torque on the first gear in one planet's mesh over that of the rotor.
    speed_ratio : float
        Speed of the first gear, against the carrier, over the rotor's.
    strength : GearStrength or None
        What the file states of the stage.
    stiffness : IsoStiffness
        By ISO 6336-1.
    mass : float
        Reduced mass per face width [kg/m].
    cutter : Cutter or None
        Tool of the ring.
    turns_with_rotor : bool
        Whether the carrier turns as the rotor, so that teeth of the ring can be told apart.
    missing : tuple of str
        Keys that the file lacks for a rating.
    """

    name: str
    stage: int
    planets: int
    pair: Pair
    flanks: tuple[Flank, Flank]
    torque_ratio: float
    speed_ratio: float
    strength: GearStrength | None
    stiffness: IsoStiffness
    mass: float
    cutter: Cutter | None = None
    turns_with_rotor: bool = False
    missing: tuple[str, ...] = field(default=())

    @property
    def materials(self) -> tuple[GearMaterial, GearMaterial]:
        """Materials of both gears."""
        return self.flanks[0].material, self.flanks[1].material

    @property
    def key(self) -> str:
        """Name of the mesh in its stage, as `GearStrength` has it."""
        return self.name.split(" ")[2].replace("-", "_")

    @property
    def tooth_height(self) -> float:
        """The larger one of both gears [m]."""
        gears = (self.pair.first, self.pair.second)
        return max(abs(gear.tip_radius - gear.root_radius) for gear in gears)

    @property
    def deviations(self) -> tuple[float, float, float] | None:
        """Largest base pitch, profile form and helix slope deviation [m]; None without a grade."""
        if self.strength is None or self.strength.grade is None:
            return None
        both = [gear_tolerances(flank.gear, self.strength.grade) for flank in self.flanks]
        return (
            max(one.base_pitch for one in both),
            max(one.profile_form for one in both),
            max(one.helix_slope for one in both),
        )

    @property
    def knows_roots(self) -> bool:
        """Whether root stresses can be computed: a ring needs its cutter."""
        return not self.pair.internal or self.cutter is not None


def gear_meshes(
    machine: MachineTable, strengths: Mapping[int, GearStrength]
) -> tuple[dict[str, GearMesh], dict[str, str]]:
    """Meshes of all stages whose gears are given in full, and why others are left out.

    Parameters
    ----------
    machine : MachineTable
        The machine.
    strengths : mapping of int to GearStrength
        Strength of stages by their number, from 1.

    Returns
    -------
    meshes : dict of str to GearMesh
        By the names of `machine_pairs`.
    left_out : dict of str to str
        Why a mesh is not rated, by its name.
    """
    meshes: dict[str, GearMesh] = {}
    left_out: dict[str, str] = {}
    for number, stage in enumerate(machine.stages, start=1):
        name = f"stage {number}"
        of_stage = [mesh for mesh in mesh_springs(machine) if mesh.startswith(f"{name} ")]
        lacking = [key for key in _NEEDED if getattr(stage, key) is None]
        lacking += [key for key in _SIZES if f"{name}: {key}" in machine.not_given]
        if lacking:
            left_out |= dict.fromkeys(of_stage, f"{name}: {', '.join(lacking)}")
            continue
        strength = strengths.get(number)
        for mesh, pair in stage_pairs(stage, name).items():
            made = _mesh(machine, number, mesh, pair, strength)
            meshes[made.name] = made
    return meshes, left_out


def _mesh(
    machine: MachineTable, number: int, mesh: str, pair: Pair, strength: GearStrength | None
) -> GearMesh:
    """One mesh of a stage."""
    stage, name = machine.stages[number - 1], f"stage {number}"
    speeds, counts = machine.speeds, _loads(machine, number)
    steels = {} if strength is None else strength.gears
    stiffness = iso_gear_stiffness(pair, blank=stage.blank)
    missing = [f"{name}: strength"] if strength is None else []
    if strength is not None and strength.grade is None:
        missing.append(f"{name}: strength.grade")
    width, cutter, planets = pair.face_width, None, 1

    def per_width(part: str, radius: float) -> float:
        return float(getattr(stage, part).inertia) / (width * radius**2)

    first = per_width(*_first(mesh, pair))
    torque, speed, mass = 1.0 / abs(speeds[number]), abs(speeds[number]), first
    if isinstance(stage, PlanetaryData):
        planets = stage.planets
        torque, speed = torque / planets, abs(speeds[number] - speeds[number - 1])
        _, planet, sun = stage.teeth or (0, 1, 1)
        if mesh == "sun-planet":
            mass = reduced_mass(first, per_width("planet", pair.second.base_radius), planets)
            flanks = (("sun", "sun"), ("planet", "planet, flank to sun"))
        else:
            torque, speed = torque * planet / sun, speed * sun / planet
            flanks = (("planet", "planet, flank to ring"), ("ring", "ring"))
            cutter = Cutter(stage.cutter) if stage.cutter else None
            missing += [] if cutter else [f"{name}: cutter"]
    else:
        mass = reduced_mass(first, per_width("gear", pair.second.base_radius))
        flanks = (("pinion", "pinion"), ("gear", "gear"))
    made = [
        Flank(
            f"{name} {label}",
            counts[f"{name} {label}"],
            gear,
            steels.get(part),
            ALTERNATING if part == "planet" else 1.0,
        )
        for (part, label), gear in zip(flanks, (pair.first, pair.second), strict=True)
    ]
    return GearMesh(
        f"{name} {mesh}",
        number,
        planets,
        pair,
        (made[0], made[1]),
        torque,
        speed,
        strength,
        stiffness,
        mass,
        cutter,
        abs(speeds[number - 1]) == 1.0,
        tuple(missing),
    )


def _first(mesh: str, pair: Pair) -> tuple[str, float]:
    """Part that is the first gear of a mesh, and its base radius [m]."""
    part = {"sun-planet": "sun", "ring-planet": "planet", "mesh": "pinion"}[mesh]
    return part, pair.first.base_radius


def counted_stage(stage: PlanetaryData | ParallelData) -> PlanetaryStage | ParallelStage:
    """Teeth of a stage, as `loads_per_turn` counts their loads.

    Parameters
    ----------
    stage : PlanetaryData or ParallelData
        Stage with teeth.

    Raises
    ------
    InputError
        The stage has a speed ratio in their place.
    """
    if stage.teeth is None:
        raise InputError("a stage has a ratio and no teeth, which are counted here: give teeth")
    if isinstance(stage, PlanetaryData):
        ring, planet, sun = stage.teeth
        return PlanetaryStage(sun, planet, ring, stage.planets)
    return ParallelStage(*stage.teeth)


def _loads(machine: MachineTable, number: int) -> dict[str, float]:
    """Loads per turn of the rotor of the flanks of a stage, by their names."""
    turns = abs(machine.speeds[number - 1])
    return {
        name.replace("stage 1", f"stage {number}"): turns * loads
        for name, loads in loads_per_turn([counted_stage(machine.stages[number - 1])]).items()
    }
