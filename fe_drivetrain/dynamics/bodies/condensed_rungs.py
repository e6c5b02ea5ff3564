"""The ladder of a drivetrain: as many levels as its file states what they need.

After bodies and beam shafts, what is condensed comes in, one cause after the other: housings of
main bearings at both bounds of their seats, the gearbox's housing on its mount, carriers, the main
shaft in its meridian or as a solid. Each rung keeps what the ones before it brought.
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
from fe_drivetrain.dynamics.bodies.flexible import Flexible
from fe_drivetrain.dynamics.bodies.gearbox_mount import on_mount
from fe_drivetrain.dynamics.bodies.levels import Level
from fe_drivetrain.dynamics.bodies.machine import Machine, machine_of
from fe_drivetrain.elasticity.solve.condensation import Condensed
from fe_drivetrain.shafts.fidelity.component_frames import carrier_frame
from fe_drivetrain.shafts.fidelity.component_solid import solid_component
from fe_drivetrain.shafts.fidelity.main_supports import MainSupports, main_supports
from fe_drivetrain.shafts.fidelity.shafts import meridian_shaft, solid_shaft

SOFT_SEATS, STIFF_SEATS = "housings, seats averaged", "housings, seats rigid"
"""Names of the rungs with housings of main bearings, at their lower and their upper bound."""

_HOUSINGS, _MOUNT, _CARRIERS, _SECTIONS, _ROLLERS = UNCONDENSED
_TUBE = (
    "inertia of the gearbox's housing: a thin tube round the largest gear, from the first stage to "
    "the last, since gearbox.housing_inertia is not given"
)
_NO_MASS = "the gearbox's housing has no mass, since gearbox.weight is not given"
_REST = "mass of the gearbox's housing: what gears and shafts leave of gearbox.weight"


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
        Torsional, rigid bodies, flexible shafts; then `SOFT_SEATS` and `STIFF_SEATS` of a main
        shaft on housings, "gearbox housing on its mount", "carriers of beams", "main shaft in its
        meridian", and with ``solids`` "solid main shaft and carriers". All are for the one
        `machine_of` the drivetrain.

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
    built = _Built(list(RUNGS), {}, Flexible(), clock)
    carriers = carriers_of(drivetrain)
    if isinstance(drivetrain, Scene):
        _add_housings(built, main_supports(drivetrain, cache, clock))
        _add_mount(built, drivetrain, machine)
    else:
        why = "the main shaft has no sections and no bearing units"
        built.left_out |= {SOFT_SEATS: why, STIFF_SEATS: why}
        built.left_out["gearbox housing on its mount"] = "gearbox.stiffness is not given"
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
        assumed = (*last.assumes, *assumes)
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
        built.add(name, given, (_HOUSINGS,), instead)


def _add_mount(built: _Built, scene: Scene, machine: Machine) -> None:
    """Add the gearbox's housing on its mount; main bearings and generator stand beside it."""
    name = "gearbox housing on its mount"
    try:
        given = on_mount(scene, machine, built.gives)
    except InputError as error:
        built.left_out[name] = str(error)
        return
    heavy = scene.gearbox.weight > 0
    assumed = [_REST if heavy else _NO_MASS]
    if heavy and scene.gearbox.housing_inertia is None:
        assumed.append(_TUBE)
    built.add(name, given, (_MOUNT,), "a gearbox housing that deforms", tuple(assumed))


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
