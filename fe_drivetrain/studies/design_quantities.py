"""Quantities of a design by name, at the levels of the ladder: mass, deflection, tilt, life, ...

``mass`` and ``cost`` are of all parts of the scene, ``mass.shaft`` of one. ``deflection`` is how
far the hub moves under the load, ``tilt`` how far the shaft turns out of its axis in a bearing,
``stress`` the nominal one of a section, ``pressure`` the largest Hertz pressure of a bearing under
the load, ``life`` its L10mr in hours; ``frequency`` is the first torsional one. Without a name
behind it, a quantity is that of every bearing or section, so that a limit is kept by each. Beside
them stand the names of reactions, stiffnesses and of all that turns.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from fe_drivetrain.bearing.answers import race_pressures
from fe_drivetrain.bearing.geometry import RollerRow
from fe_drivetrain.bearing_life.coupled.body import LinearBody
from fe_drivetrain.bearing_life.coupled.load_paths import LoadPath
from fe_drivetrain.bearing_life.coupled.of_scene import scene_body
from fe_drivetrain.bearing_life.life.roller_damage import damage_of_history
from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import RPM
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.near_words import did_you_mean
from fe_drivetrain.drivetrain_file.bearing_unit import BearingUnit
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.quantity_names import is_turning
from fe_drivetrain.drivetrain_file.reading import with_sections
from fe_drivetrain.drivetrain_file.scene import Coupling, Scene
from fe_drivetrain.dynamics import plain_rungs
from fe_drivetrain.shafts.fidelity.bearing_units import unit_stiffness
from fe_drivetrain.shafts.fidelity.loaded_shaft import (
    LoadedShaft,
    loaded_shaft,
    part_masses,
    shaft_volume,
)
from fe_drivetrain.shafts.fidelity.quantities import Solved, known_names, numbers
from fe_drivetrain.shafts.fidelity.quantity import named_load
from fe_drivetrain.shafts.response.entering import AtFront, Factors, entering, joined
from fe_drivetrain.shafts.response.model import scene_loads
from fe_drivetrain.shafts.uncertainty.resolver import Resolver, unit_content
from fe_drivetrain.studies.design_request import DesignRequest
from fe_drivetrain.studies.rolling_bearings import OneBearing, bearings_of
from fe_drivetrain.studies.rotor_speeds import rated_speed
from fe_drivetrain.studies.turning_advice import finest_modes
from fe_drivetrain.studies.turning_model import TurningModel
from fe_drivetrain.studies.turning_quantities import turning_quantity
from fe_drivetrain.turbine_loads.hub_loads.point_loads import PointLoads
from fe_drivetrain.turbine_loads.hub_loads.recorded import read_recorded, recorded_files

#: Quantities with a name of their own, and their units.
OWN: Mapping[str, str] = {
    "mass": "kg",
    "cost": "-",
    "deflection": "m",
    "tilt": "rad",
    "stress": "Pa",
    "pressure": "Pa",
    "life": "h",
}
UNDER_LOAD = ("deflection", "tilt", "stress", "pressure")
_FREQUENCY = "modes.torsional.1"
_HOUR = 3600.0
_WITHOUT_DAMAGE = 1e9  # [h] life of a bearing that no load wears out, so that it has a slope


@dataclass(frozen=True)
class Steps:
    """Hub loads under which lives are.

    Attributes
    ----------
    loads : PointLoads
        (n, 6) as they enter the scene.
    speed_rpm, seconds : Floats
        (n,) speed of the rotor, and how long each lasts.
    """

    loads: PointLoads
    speed_rpm: Floats
    seconds: Floats


class DesignQuantities:
    """What a search asks of designs, at the cheap level and at the better one.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain that the designs differ from in values.
    request : DesignRequest
        What is asked.

    Raises
    ------
    InputError
        A name is unknown, a load is missing, or a limit has a unit of something else.
    """

    def __init__(self, drivetrain: Drivetrain, request: DesignRequest) -> None:
        self.drivetrain, self.request = drivetrain, request
        self.names = tuple(
            dict.fromkeys([request.minimise, *(limit.name for limit in request.limits)])
        )
        self._resolvers = {
            key: Resolver(level, coupling=coupling) for key, (level, coupling) in MODELS.items()
        }
        self._masses: dict[str, dict[str, float]] = {}
        self.units = {name: self._unit(name) for name in self.names}
        for limit in request.limits:
            limit.size(self.units[limit.name])
        # what is shown of a limit has its unit, also where SI was meant without a word
        limits = tuple(limit.in_unit(self.units[limit.name]) for limit in request.limits)
        self.request = replace(request, limits=limits)
        if any(self._kind(name) in UNDER_LOAD for name in self.names) and not request.load:
            raise InputError(
                f"{', '.join(n for n in self.names if self._kind(n) in UNDER_LOAD)} needs a load: "
                f"give one with {argument('hub', {'hub.Fz': -1e6})}"
            )

    def values(self, design: Drivetrain, model: str = "cheap") -> dict[str, Floats]:
        """Each quantity of a design: one value, or one for every bearing or section.

        Parameters
        ----------
        design : Drivetrain
            The design.
        model : str
            A key of `MODELS`.
        """
        at = _AtModel(self, design, model)
        return {
            name: np.asarray(at.value(name), dtype=np.float64).reshape(-1) for name in self.names
        }

    def _kind(self, name: str) -> str:
        kind = name.partition(".")[0]
        return kind if kind in OWN and kind not in self._bearing_names else ""

    @property
    def _bearing_names(self) -> tuple[str, ...]:
        return tuple(getattr(self.drivetrain, "bearing_names", ()))

    def _unit(self, name: str) -> str:
        """Unit of a quantity; a name that is unknown is refused."""
        turning = self.turning_name(name)
        if turning is not None:
            return turning_quantity(self.drivetrain, turning).unit
        scene = with_sections(self.drivetrain, self.drivetrain.title)
        kind = self._kind(name)
        if kind:
            of, known = name.partition(".")[2], self._owners(scene, kind)
            if of and of not in known:
                raise InputError(
                    f"{name} is unknown: use {kind}"
                    + (f", or with one of {', '.join(known)} behind it" if known else "")
                )
            return OWN[kind]
        if name not in known_names(scene):
            near = did_you_mean(name, [*OWN, "frequency", *known_names(scene)])
            raise InputError(
                f"quantity {name!r} is unknown: {near + ' ' if near else ''}use one of "
                f"{', '.join([*OWN, 'frequency', *known_names(scene)])}, or of all that turns"
            )
        return numbers(scene, [name])[0].unit.partition(" for ")[0]

    def _owners(self, scene: Scene, kind: str) -> list[str]:
        """What a quantity may be of."""
        if kind == "mass":
            return list(self.masses(scene))
        if kind == "stress":
            return [str(number) for number in range(len(scene.shaft.pieces))]
        return (
            [] if kind in ("cost", "deflection") else [u.bearing.name for u in scene.bearing_units]
        )

    def turning_name(self, name: str) -> str | None:
        """Name of a quantity of all that turns, where it is one."""
        if name == "frequency":
            return _FREQUENCY
        own = self._kind(name) == "life" and name.count(".") < 2
        return name if is_turning(name, self.drivetrain) and not own else None

    def turning_band(self, design: Drivetrain, name: str) -> float:
        """What the finest level of all that turns leaves open in a quantity, in its unit."""
        turning = self.turning_name(name)
        assert turning is not None
        quantity, rungs = turning_quantity(design, turning), plain_rungs(design)
        model = TurningModel(design, rungs[-1], finest_modes(design, rungs))
        own = quantity.own(model)
        return own if np.isfinite(own) else 0.0

    def masses(self, scene: Scene) -> dict[str, float]:
        """Mass of each part [kg]; that of the units as long as they do not change."""
        key = repr([unit_content(scene, unit.bearing.name) for unit in scene.bearing_units])
        if key not in self._masses:
            self._masses[key] = part_masses(scene)
        density = scene.material_of("shaft").density
        return {**self._masses[key], "shaft": density * shaft_volume(scene.shaft)}

    def resolver(self, model: str) -> Resolver:
        """What solves a scene by a model of `MODELS`."""
        return self._resolvers[model]

    @cached_property
    def steps(self) -> Steps:
        """Hub loads under which lives are: files, or the one load."""
        request = self.request
        where = self.drivetrain if isinstance(self.drivetrain, Scene) else AtFront()
        speed = request.life.rotor_speed_rpm
        rated = rated_speed(self.drivetrain)
        if speed is None and rated is not None:
            speed = rated * RPM
        if speed is not None and not speed > 0.0:
            raise InputError(
                f"{argument('LifeOptions.rotor_speed_rpm', speed)} 1/min, but life counts turns: "
                "give a speed above 0"
            )
        if request.hub_loads is not None:
            return _recorded_steps(where, request, speed)
        if not request.load:
            raise InputError(
                f"life needs loads: give files with {argument('loads', 'FILES')}, or one load with "
                f"{argument('hub', {'hub.Fz': -1e6})}"
            )
        if speed is None:
            raise InputError(
                "life counts turns, and neither the file's operation nor an option has a rotor "
                f"speed: give {argument('LifeOptions.rotor_speed_rpm', 12)} in 1/min"
            )
        scene = with_sections(self.drivetrain, self.drivetrain.title)
        values = named_load(scene, request.load).values
        loads = np.concatenate([values[:6], values[10:]])[None]
        return Steps(PointLoads(loads, scene.shaft.front), np.array([speed]), np.ones(1))


MODELS: Mapping[str, tuple[int, Coupling]] = {
    "cheap": (1, "rigid"),
    "better": (2, "rigid"),
    "bound": (2, "averaged"),
}
"""Models of a design: level of the shaft, and how faces of housings move."""


def _recorded_steps(where: Scene | AtFront, request: DesignRequest, speed: float | None) -> Steps:
    """Load steps of files, one after the other."""
    loads, speeds, seconds = [], [], []
    every = request.life.every
    assert request.hub_loads is not None
    for file in recorded_files(request.hub_loads):
        found = read_recorded(file, request.life.names, request.life.skip)
        entered = entering(where, found.history)[::every]
        if found.rotor_speed is None and speed is None:
            raise InputError(
                f"hub loads '{file}': there is no rotor speed, by which lives count turns: give "
                f"{argument('LifeOptions.rotor_speed_rpm')} in 1/min"
            )
        own = found.rotor_speed
        turns = np.full(len(entered), speed) if own is None else np.asarray(own * RPM)[::every]
        loads.append(entered)
        speeds.append(turns)
        seconds.append(np.full(len(entered), found.history.step * every))
    return Steps(joined(loads), np.concatenate(speeds), np.concatenate(seconds))


class _AtModel:
    """A design by one model; what several quantities need is solved once."""

    def __init__(self, of: DesignQuantities, design: Drivetrain, model: str) -> None:
        self._of, self._design, self._model = of, design, model

    def value(self, name: str) -> float | list[float] | Floats:
        """A quantity, see `DesignQuantities`."""
        of = self._of
        turning = of.turning_name(name)
        if turning is not None:
            return self._turning(turning)
        kind, _, owner = name.partition(".")
        if not of._kind(name):
            return self._reported(name)
        if kind == "mass":
            masses = of.masses(self._scene)
            return masses[owner] if owner else sum(masses.values())
        if kind == "cost":
            return self._cost()
        if kind == "deflection":
            return self._loaded.deflection
        if kind == "stress":
            found = self._loaded.stresses()
            return found[int(owner)] if owner else np.concatenate(found)
        names = [owner] if owner else [u.bearing.name for u in self._scene.bearing_units]
        if kind == "tilt":
            return [self._loaded.tilt(one) for one in names]
        return [self._rolling(kind, one) for one in names]

    @cached_property
    def _scene(self) -> Scene:
        return with_sections(self._design, self._design.title)

    @cached_property
    def _solved(self) -> Solved:
        return self._of.resolver(self._model)(self._scene)

    @cached_property
    def _factors(self) -> Floats:
        given = self._of.request.load
        if not given:
            return np.zeros(len(scene_loads(self._scene)))
        return named_load(self._scene, given).values

    @cached_property
    def _loaded(self) -> LoadedShaft:
        return loaded_shaft(self._scene, self._solved, self._factors)

    def _reported(self, name: str) -> list[float]:
        load = Factors(self._factors) if self._of.request.load else None
        return [abs(one.of(self._solved)) for one in numbers(self._scene, [name], load)]

    def _cost(self) -> float:
        """Price of all parts: that of the part itself, or of the last word of its name."""
        prices, masses = self._of.request.prices, self._of.masses(self._scene)
        known = {*masses, *(part.rpartition(".")[2] for part in masses)}
        if unknown := [part for part in prices if part not in known]:
            raise InputError(
                f"price of {unknown[0]!r}: there is no such part; use one of "
                f"{', '.join(sorted(known))}"
            )
        return sum(
            mass * prices.get(part, prices.get(part.rpartition(".")[2], 0.0))
            for part, mass in masses.items()
        )

    def _turning(self, name: str) -> float:
        rungs = plain_rungs(self._design)
        quantity = turning_quantity(self._design, name)
        reference = finest_modes(self._design, rungs)
        tried = rungs if self._model == "cheap" else rungs[::-1]
        for rung in tried:
            value = quantity.of(TurningModel(self._design, rung, reference))
            if value is not None:
                return value
        raise InputError(f"no level of {self._design.title!r} has {name}: ask for another quantity")

    @cached_property
    def _bearings(self) -> dict[str, OneBearing]:
        return {one.name: one for one in bearings_of(self._scene, self._of.request.life.choices)}

    def _rolling(self, kind: str, name: str) -> float:
        """Pressure under the load [Pa], or life [h], of a bearing."""
        one = self._bearings[name]
        path = one.path
        assert isinstance(path, LoadPath)
        if self._model != "cheap":
            path = replace(path, body=self._body)
        if kind == "pressure":
            return _peak_pressure(self._scene, one, self._weighed(path), self._factors)
        steps, rules = self._of.steps, self._of.request.life.rules
        if self._of.request.hub_loads is None:
            path = self._weighed(path)
        found = damage_of_history(
            path.steps(steps.loads, steps.speed_rpm, steps.seconds), one.rated, one.rules(rules)
        )
        damage = float(found.totals["L10mr"])
        return min(found.seconds / _HOUR / damage, _WITHOUT_DAMAGE) if damage else _WITHOUT_DAMAGE

    def _weighed(self, path: LoadPath) -> LoadPath:
        """The path with the weights that the load states, and no others."""
        load = self._of.request.load
        if any(load.get(f"gravity.{axis}") for axis in "xy"):
            raise InputError(
                "life and pressure take weight along z alone: leave gravity.x and gravity.y out of "
                "the load"
            )
        return replace(
            path,
            gravity=-load.get("gravity.z", 0.0),
            gearbox_weight=load.get("gearbox.weight", 0.0),
        )

    @cached_property
    def _body(self) -> LinearBody:
        """The shaft in its meridian between housings that give, at one of the two bounds."""
        level, coupling = MODELS[self._model]
        scene = self._scene
        housings = {
            unit.bearing.name: unit_stiffness(_bonded(scene, unit), unit.bearing.name, coupling)
            for unit in scene.bearing_units
            if unit.condensed is None
        }
        return scene_body(scene, level, housings)


def _bonded(scene: Scene, unit: BearingUnit) -> Scene:
    """The scene with a bearing bonded to its housing, whose own stiffness is then left."""
    units = tuple(
        one.model_copy(update={"interface": "bonded"}) if one is unit else one
        for one in scene.bearing_units
    )
    return scene.model_copy(update={"bearing_units": units})


def _peak_pressure(scene: Scene, one: OneBearing, path: LoadPath, factors: Floats) -> float:
    """Largest pressure of a bearing on its races under the load [Pa]."""
    loads = PointLoads(np.concatenate([factors[:6], factors[10:]])[None], scene.shaft.front)
    worst = 0.0
    for steps in path.steps(loads, 1.0, 1.0):
        for row, q in zip(one.rated.bearing.rows, steps.laminae, strict=True):
            count = q.shape[2] if isinstance(row, RollerRow) else 1
            worst = max(worst, *(float(p.max()) for p in race_pressures(row, q, count)))
    return worst
