"""The rolling bearings of a machine for ``life``: by reactions of its statics, level by level.

Bearings of shafts and carriers in the housing, and of planets on their pins. Main bearings of a
machine are among them where no scene has them on rollers.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from fe_drivetrain.bearing.catalogue import Entry, Named, name_of, read_bearing_catalogue
from fe_drivetrain.bearing_life.coupled.reaction_paths import ReactionPath
from fe_drivetrain.bearing_life.life.lubricants import GRADES, Lubricant, grade_viscosities
from fe_drivetrain.bearing_life.life.rated import RatedBearing, rated_from_catalogue
from fe_drivetrain.bearing_life.life.roller_models import rigid_rings
from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.mounted_bearings import clearance_change, row_clearance
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.drivetrain_file.turning_parts import BearingData, PinData
from fe_drivetrain.dynamics.bodies.advice import RUNGS, Rung
from fe_drivetrain.dynamics.bodies.bearing_reactions import (
    BearingModel,
    Reactions,
    planet_bearing_name,
)
from fe_drivetrain.dynamics.bodies.catalogue_seats import catalogued, main_names
from fe_drivetrain.dynamics.bodies.gearbox_mount import stated_mount
from fe_drivetrain.dynamics.bodies.levels import Level
from fe_drivetrain.dynamics.bodies.machine import Machine, machine_of
from fe_drivetrain.studies.named_bearings import entry_of
from fe_drivetrain.studies.rolling_bearings import (
    Choices,
    Oil,
    OneBearing,
    OtherPath,
    profile_of,
)

LEVELS = (Level.RIGID, Level.FLEXIBLE)
"""Levels that have loads of bearings, from the cheapest; lives are those of the last."""

FACTORS = ((0.5, "half of it"), (2.0, "twice as much"))
"""Stiffness of a bearing to compare with over that which its file states, and in words."""


@dataclass(frozen=True)
class Unrated:
    """A bearing that has no entry of a catalogue.

    Attributes
    ----------
    name : str
        Name of the bearing.
    speed_ratio : float
        Its speed over that of the rotor.
    """

    name: str
    speed_ratio: float


@dataclass(frozen=True)
class MachineBearings:
    """Bearings of a machine.

    Attributes
    ----------
    lacks : str or None
        Why there is no machine, of a drivetrain with gears whose main bearings are rated all the
        same, as a sentence.
    assumes : tuple of str
        What the finest level assumes of housings, see `Rung`.
    rated : tuple of OneBearing
        Those with an entry of a catalogue, ready for lives: main bearings first.
    unrated : tuple of Unrated
        The others, named alone.
    degrees : Mapping[str, int]
        Degrees of freedom of each level.
    """

    rated: tuple[OneBearing, ...] = ()
    unrated: tuple[Unrated, ...] = ()
    degrees: Mapping[str, int] = field(default_factory=dict)
    lacks: str | None = None
    assumes: tuple[str, ...] = ()


def machine_bearings(
    machine: Machine,
    entries: Mapping[str, Named],
    choices: Choices,
    oil: Oil,
    on_rollers: Sequence[str] = (),
    finest: Rung = RUNGS[-1],
) -> MachineBearings:
    """The bearings of a machine by the loads that its statics give them.

    Parameters
    ----------
    machine : Machine
        The machine.
    entries : Mapping[str, str]
        Catalogue entry by the name of a bearing; of planets as "stage 1 pin upwind".
    choices : Choices
        Catalogues, profile of rollers, rings, and the one bearing that is asked for.
    oil : Oil
        The oil of the gearbox.
    on_rollers : sequence of str
        Bearings that are rated elsewhere, with their rollers in equilibrium with the shaft.
    finest : Rung
        The finest of `plain_rungs`, with what gives at both levels; housings rigid on the ground
        where left out.

    Returns
    -------
    bearings : MachineBearings
        Main bearings first, then others in the order of the machine, then planets.

    Raises
    ------
    InputError
        An entry is unknown or of no bearing, or the machine has no statics.
    """
    models = {level: BearingModel(machine, level, flexible=finest.flexible) for level in LEVELS}
    loads = {level: model.reactions() for level, model in models.items()}
    main = main_names(machine)
    names = [n for n in models[LEVELS[-1]].names if n not in on_rollers]
    names = [*(n for n in names if n in main), *(n for n in names if n not in main)]
    require_bearings((*on_rollers, *names), entries, choices.only)
    known = read_bearing_catalogue(*choices.catalogues)
    rows = catalogued(machine)
    rated, unrated = [], []
    for name in names:
        here = {level: of[name] for level, of in loads.items()}
        if choices.only not in (None, name):
            continue
        if name not in entries:
            unrated.append(Unrated(name, here[LEVELS[-1]].speed_ratio))
        else:
            entry = entry_of(name, entries[name], known)
            made = _Maker(name, entries[name], entry, choices, rows.get(name))
            rated.append(made.bearing(models[LEVELS[-1]], here, None if name in main else oil))
    degrees = {level.value: model.degrees for level, model in models.items()}
    return MachineBearings(tuple(rated), tuple(unrated), degrees, assumes=finest.assumes)


def catalogue_entries(drivetrain: Drivetrain) -> dict[str, Named]:
    """Catalogue entries in a drivetrain's file, by bearing; of planets "stage 1 pin upwind".

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain.
    """
    found: dict[str, Named | None] = {}
    if isinstance(drivetrain, Scene):
        found |= {unit.bearing.name: unit.catalogue for unit in drivetrain.bearing_units}
    found |= {bearing.name: bearing.catalogue for bearing in drivetrain.gearbox.bearings}
    for number, stage in enumerate(drivetrain.gearbox.stages, start=1):
        for pin in getattr(stage, "pins", ()):
            found[planet_bearing_name(number, pin.name)] = pin.catalogue
    return {name: entry for name, entry in found.items() if entry is not None}


def machine_with_bearings(drivetrain: Drivetrain) -> Machine | str | None:
    """The machine of a drivetrain with gears, or why there is none; None of one without gears.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain.

    Raises
    ------
    InputError
        There is none, and nothing else has bearings.
    """
    if isinstance(drivetrain, Scene) and not drivetrain.gearbox.stages:
        return None
    try:
        machine = machine_of(drivetrain)
        BearingModel(machine, LEVELS[0], 1, stated_mount(drivetrain, machine))
    except InputError as error:
        if isinstance(drivetrain, Scene):
            return str(error)
        raise
    return machine


def gearbox_oil(
    grade: str | tuple[float, float] | None,
    temperature: float | None,
    cleanliness: str | None,
) -> Oil:
    """The oil of a gearbox, circulating through a filter; what is not stated is assumed.

    Parameters
    ----------
    grade : str or tuple of float or None
        A grade, as `fe_drivetrain.bearing_life.life.grade_viscosities` takes it, or viscosities at
        40 and at 100 degC [mm2/s]; None takes VG 320.
    temperature : float or None
        Temperature of bearings in operation [degC]; None takes 60.
    cleanliness : str or None
        Code of ISO 4406; None takes -/17/14.

    Raises
    ------
    InputError
        There is no such grade, or a value is out of its range.
    """
    given = {"lubricant": grade, "temperature": temperature, "cleanliness": cleanliness}
    name = "VG 320" if grade is None else grade
    at_40, at_100 = grade_viscosities(name) if isinstance(name, str) else name
    lubricant = Lubricant(
        at_40,
        at_100,
        60.0 if temperature is None else temperature,
        "filtered oil",
        cleanliness or "-/17/14",
    )
    assumed = [key for key, value in given.items() if value is None]
    if isinstance(name, str) and name not in GRADES:
        assumed.append("viscosity index")
    return Oil(lubricant, tuple(assumed))


@dataclass(frozen=True)
class _Maker:
    """A bearing of a machine with its entry, to be made ready for lives."""

    name: str
    named: Named
    entry: Entry
    choices: Choices
    row: BearingData | PinData | None = None

    def bearing(
        self, model: BearingModel, here: Mapping[Level, Reactions], oil: Oil | None
    ) -> OneBearing:
        """The bearing by the finest of its levels, with the others and other stiffnesses."""
        catalogues, profile = self.choices.catalogues, profile_of(self.entry, self.choices.profiled)
        mounted, given = None, None
        if self.row is not None:
            mounted, given = row_clearance(self.row, self.entry), self.row.clearance
        change = clearance_change(given, mounted)
        rated = rated_from_catalogue(self.named, *catalogues, **profile, **change)
        paths = {level.value: self._path(rated, of) for level, of in here.items()}
        of = here[LEVELS[-1]]
        return OneBearing(
            self.name,
            name_of(self.named),
            self.entry.model_copy(update=change),
            rated,
            paths[LEVELS[-1].value],
            None,
            rigid_rings,
            oil=oil,
            turning="outer" if of.planets else None if oil is None else "inner",
            planets=of.planets,
            levels=paths,
            others=tuple(
                OtherPath(
                    "the stiffness of this bearing as stated",
                    words,
                    self._path(rated, model.reactions({self.name: factor}, {self.name})[self.name]),
                )
                for factor, words in FACTORS
            ),
            clearance=mounted,
        )

    def _path(self, rated: RatedBearing, of: Reactions) -> ReactionPath:
        weight = of.by_weight if self.choices.weight else np.zeros_like(of.by_weight)
        return ReactionPath(self.name, rated, of.by_hub, weight, of.speed_ratio)


def require_bearings(names: Sequence[str], entries: Mapping[str, Named], only: str | None) -> None:
    """Refuse names of bearings that there are not, and to ask for one that cannot be rated."""
    known = f"name one of {', '.join(names)}"
    for name in entries:
        if name not in names:
            raise InputError(
                f"{argument('LifeOptions.bearings', {name: name_of(entries[name])})}: the "
                f"drivetrain has no bearing {name!r}; {known}"
            )
    if only is not None and only not in names:
        raise InputError(
            f"{argument('LifeOptions.only', only)}: the drivetrain has no such bearing; {known}"
        )
    if only is not None and only not in entries:
        raise InputError(
            f"{argument('LifeOptions.only', only)}: bearing {only!r} has no entry of the "
            f"catalogue: name it with {argument('LifeOptions.bearings', {only: 'ENTRY'})}, or "
            "under 'catalogue' in the drivetrain's file"
        )
