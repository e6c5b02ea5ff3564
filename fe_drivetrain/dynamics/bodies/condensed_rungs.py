"""The ladder of a drivetrain: as many levels as its file states what they need.

Bodies and beam shafts have the gearbox's housing on its mount where the file states one. Then what
is condensed comes in, one cause after the other: housings of main bearings at both bounds of their
seats, carriers, the main shaft in its meridian or as a solid. Each rung keeps what the ones before
it brought.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from fe_drivetrain.common.cache import Cache
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.common.steps import Clock, Steps
from fe_drivetrain.drivetrain_file.carriers import carriers_of
from fe_drivetrain.drivetrain_file.component import CarrierComponent
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.joint_springs import free_to_turn
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.dynamics.bodies.advice import RUNGS, UNCONDENSED, Rung
from fe_drivetrain.dynamics.bodies.catalogue_seats import catalogued
from fe_drivetrain.dynamics.bodies.flexible import Flexible
from fe_drivetrain.dynamics.bodies.gearbox_mount import stated_mount
from fe_drivetrain.dynamics.bodies.levels import Level
from fe_drivetrain.dynamics.bodies.machine import Machine, machine_of
from fe_drivetrain.elasticity.solve.condensation import Condensed
from fe_drivetrain.shafts.fidelity.component_frames import carrier_frame
from fe_drivetrain.shafts.fidelity.component_solid import solid_component
from fe_drivetrain.shafts.fidelity.main_supports import MainSupports, main_supports
from fe_drivetrain.shafts.fidelity.shafts import meridian_shaft, solid_shaft

SOFT_SEATS, STIFF_SEATS = "housings, seats averaged", "housings, seats rigid"
"""Names of the rungs with housings of main bearings, at their lower and their upper bound."""

ON_ROLLERS = "bearings on their rollers"
"""Name of the rung with the rollers of catalogued bearings, and their clearance."""

_HOUSINGS, _MOUNT, _CARRIERS, _SECTIONS, _ROLLERS = UNCONDENSED
_DEFORMS = "a gearbox housing that deforms"
_TUBE = (
    "inertia of the gearbox's housing: a thin tube round the largest gear, from the first stage to "
    "the last, since gearbox.housing_inertia is not given"
)
_NO_MASS = (
    "mass of the gearbox's housing: none, so that it follows its mount at once, since "
    "gearbox.weight is not given"
)
_REST = "mass of the gearbox's housing: what gears and shafts leave of gearbox.weight"

_ON_MOUNT = (
    "gearbox's housing: rigid in itself, on the springs of gearbox.stiffness at the main shaft's "
    "rear face; ring and bearings of the gearbox are in it"
)
_ON_GROUND = "gearbox's housing: rigid, on the ground, since {}"
_RIGID_MAINS = "housings of main bearings: rigid, on the ground"


def plain_rungs(drivetrain: Drivetrain, machine: Machine | None = None) -> tuple[Rung, ...]:
    """Levels without anything that has to be condensed, as far as a file has data for them.

    Torsional, where bodies turn and no housing moves; rigid bodies and flexible shafts, with the
    gearbox's housing on the springs of its mount where the file states them.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain.
    machine : Machine or None
        Its machine, where it is known; that of `machine_of` if not given.

    Raises
    ------
    InputError
        `machine_of` refuses the drivetrain, or its mount cannot be, see `gearbox_housing`.
    """
    made = machine_of(drivetrain) if machine is None else machine
    if made.not_given:
        return RUNGS[:1]
    gives = stated_mount(drivetrain, made)
    assumes = (*_of_housing(drivetrain, gives), _RIGID_MAINS)
    swap = {} if gives.housing is None else {_MOUNT: _DEFORMS}
    finer = (
        replace(
            rung,
            flexible=gives,
            neglects=tuple(swap.get(what, what) for what in rung.neglects),
            assumes=assumes,
        )
        for rung in RUNGS[1:]
    )
    return (RUNGS[0], *finer)


def _without_mount(drivetrain: Drivetrain) -> str:
    """Why a drivetrain's gearbox has no mount."""
    if not isinstance(drivetrain, Scene):
        return "a main shaft without sections has no gearbox.stiffness"
    return "gearbox.stiffness is not given"


def _of_housing(drivetrain: Drivetrain, gives: Flexible) -> tuple[str, ...]:
    """What is assumed of the gearbox's housing."""
    if not drivetrain.gearbox.stages:
        return ()
    if gives.housing is None or not isinstance(drivetrain, Scene):
        return (_ON_GROUND.format(_without_mount(drivetrain)),)
    if not drivetrain.gearbox.weight > 0:
        return (_ON_MOUNT, _NO_MASS)
    tube = () if drivetrain.gearbox.housing_inertia is not None else (_TUBE,)
    return (_ON_MOUNT, _REST, *tube)


@dataclass(frozen=True)
class Rungs:
    """Ladder of a drivetrain.

    Attributes
    ----------
    rungs : tuple[Rung, ...]
        Rungs from the simplest to the finest, for `ladder`.
    left_out : Mapping[str, str]
        What the ladder has no rung for, and what the file lacks.
    """

    rungs: tuple[Rung, ...]
    left_out: Mapping[str, str]

    __repr__ = short_repr

    def named(self, name: str) -> Rung:
        """The rung of a name.

        Raises
        ------
        InputError
            There is none.
        """
        for rung in self.rungs:
            if rung.name == name:
                return rung
        known = ", ".join(rung.name for rung in self.rungs)
        raise InputError(f"no level {name!r}: use one of {known}")


def rungs_of(
    drivetrain: Drivetrain,
    *,
    solids: bool = False,
    cache: Cache | None = None,
    steps: Clock | None = None,
) -> Rungs:
    """Rungs of a drivetrain's ladder, as far as its file states what they need.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain.
    solids : bool
        Whether the last rung has main shaft and carriers of finite elements, which takes minutes.
    cache : Cache or None
        Where housings may come from, the same to the last bit; the user's if not given.
    steps : Clock or None
        Times each step, and shows it while it runs.

    Returns
    -------
    Rungs
        Those of `plain_rungs`; then `SOFT_SEATS` and `STIFF_SEATS` of a main shaft on housings,
        "carriers of beams", "main shaft in its meridian", and with ``solids`` "solid main shaft and
        carriers". All are for the one `machine_of` the drivetrain.

    Raises
    ------
    InputError
        `machine_of` refuses the drivetrain, or a housing or carrier cannot be meshed.
    """
    machine = machine_of(drivetrain)
    if machine.not_given:
        why = f"the file does not state {', '.join(machine.not_given)}"
        return Rungs(RUNGS[:1], {rung.name: why for rung in RUNGS[1:]})
    clock = Steps() if steps is None else steps
    plain = plain_rungs(drivetrain, machine)
    built = _Built(list(plain), {}, plain[-1].flexible, clock)
    if drivetrain.gearbox.stages and built.gives.housing is None:
        built.left_out["gearbox housing on its mount"] = _without_mount(drivetrain)
    carriers = carriers_of(drivetrain)
    if isinstance(drivetrain, Scene):
        _add_housings(built, main_supports(drivetrain, cache, clock))
    else:
        why = "the main shaft has no sections and no bearing units"
        built.left_out |= {SOFT_SEATS: why, STIFF_SEATS: why}
    if carriers:
        frames = {number: carrier_frame(component) for number, component in carriers.items()}
        given = replace(built.gives, carriers=frames)
        built.add("carriers of beams", given, (_CARRIERS,), "cheeks of carriers that bend")
    else:
        built.left_out["carriers"] = "no stage has carrier.component"
    if isinstance(drivetrain, Scene):
        _add_shaft(built, drivetrain, carriers, solids)
    else:
        built.left_out["main shaft in its meridian"] = "the main shaft has no sections"
    return Rungs(tuple(built.rungs), built.left_out)


def with_rollers(rungs: Rungs, machine: Machine) -> Rungs:
    """The ladder with one rung more: bearings with a catalogue entry on their rollers, in statics.

    Parameters
    ----------
    rungs : Rungs
        Ladder of a drivetrain.
    machine : Machine
        Its machine.

    Raises
    ------
    InputError
        No bearing has an entry, or the last rung has no forces of bearings.
    """
    last = rungs.rungs[-1]
    if last.level is Level.TORSIONAL or not catalogued(machine):
        raise InputError(
            f"no bearing of {machine.title!r} has a catalogue entry and a load, whose rollers "
            "could carry it: give bearings catalogue, or leave rollers out"
        )
    names = ", ".join(catalogued(machine))
    finer = replace(
        last,
        name=ON_ROLLERS,
        neglects=tuple(what for what in last.neglects if what != _ROLLERS),
        assumes=(*last.assumes, f"rings of {names}: rigid, without housings of their own"),
        seconds=0.0,
        rollers=True,
    )
    return Rungs((*rungs.rungs, finer), rungs.left_out)


@dataclass
class _Built:
    """A ladder as it grows.

    Attributes
    ----------
    rungs, left_out : list[Rung], dict[str, str]
        Those of `Rungs`.
    gives : Flexible
        What the next rung keeps.
    clock : Clock
        Times of what was condensed.
    """

    rungs: list[Rung]
    left_out: dict[str, str]
    gives: Flexible
    clock: Clock
    counted: float = 0.0

    def add(
        self,
        name: str,
        gives: Flexible,
        no_longer: tuple[str, ...],
        instead: str = "",
        assumes: tuple[str, ...] = (),
    ) -> None:
        """Add a rung that no longer neglects something, or something less instead."""
        last = self.rungs[-1]
        neglects = tuple(what for what in last.neglects if what not in no_longer)
        if instead:
            neglects = (instead, *neglects)
        whole = sum(self.clock.times.values())
        seconds, self.counted = whole - self.counted, whole
        assumed = (*(a for a in last.assumes if a not in no_longer), *assumes)
        self.rungs.append(Rung(Level.FLEXIBLE, gives, name, neglects, assumed, seconds))
        self.gives = gives


_SHAPE = "seats of main bearings that keep their shape in part"


def _add_housings(built: _Built, supports: MainSupports) -> None:
    """Add both bounds of the main bearings' housings."""
    built.left_out |= {f"housing of {name}": why for name, why in supports.left_out.items()}
    if not supports.stiff:
        built.left_out |= dict.fromkeys((SOFT_SEATS, STIFF_SEATS), "no main bearing has a housing")
        return
    for name, found in ((SOFT_SEATS, supports.soft), (STIFF_SEATS, supports.stiff)):
        bearings = {bearing: free_to_turn(K) for bearing, K in found.items()}
        given = replace(built.gives, bearings=bearings)
        instead = "" if name == STIFF_SEATS else _SHAPE
        built.add(name, given, (_HOUSINGS, _RIGID_MAINS), instead)


def _add_shaft(
    built: _Built, scene: Scene, carriers: Mapping[int, CarrierComponent], solids: bool
) -> None:
    """Add the main shaft in its meridian, and with solids as one, carriers with it."""
    with built.clock.step("main shaft in its meridian"):
        shaft = meridian_shaft(scene)
    given = replace(built.gives, shafts={scene.shaft.name: shaft})
    built.add("main shaft in its meridian", given, (_SECTIONS,))
    if not solids:
        built.left_out["solid main shaft and carriers"] = "not asked for: solids"
        return
    with built.clock.step("solid main shaft"):
        solid = solid_shaft(scene)
    bodies: dict[int, Condensed] = {}
    for number, component in carriers.items():
        with built.clock.step(f"solid carrier of stage {number}"):
            bodies[number] = solid_component(component).body
    given = replace(given, shafts={scene.shaft.name: solid}, carriers=bodies)
    built.add("solid main shaft and carriers", given, ("cheeks of carriers that bend",))
