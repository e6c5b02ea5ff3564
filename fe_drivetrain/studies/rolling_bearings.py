"""The rolling bearings of a scene for ``life``: their catalogue entries, ratings and models."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import Any

from fe_drivetrain.bearing.catalogue import (
    Entry,
    Named,
    insides_of_page,
    name_of,
    read_bearing_catalogue,
)
from fe_drivetrain.bearing.entry_clearance import normal_of
from fe_drivetrain.bearing.geometry import Bearing, RollerRow
from fe_drivetrain.bearing.operating_clearance import OperatingClearance
from fe_drivetrain.bearing.races import Races
from fe_drivetrain.bearing_life.coupled.load_paths import PINNED, LoadPath
from fe_drivetrain.bearing_life.coupled.of_scene import scene_body
from fe_drivetrain.bearing_life.coupled.reaction_paths import ReactionPath
from fe_drivetrain.bearing_life.life.life_rules import LifeRules
from fe_drivetrain.bearing_life.life.lubricants import Lubricant
from fe_drivetrain.bearing_life.life.rated import RatedBearing, rated_from_catalogue
from fe_drivetrain.bearing_life.life.reference_life import Turning
from fe_drivetrain.bearing_life.life.roller_models import (
    RollerModel,
    flexible_rings,
    rigid_rings,
    three_degree_rings,
)
from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.components import GRAVITY
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.mounted_bearings import clearance_change, unit_clearance
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.studies.named_bearings import NamedBearing, named_bearings

SUPPORTS = ("rollers", "pinned")
"""How the shaft stands on its bearings; a number is K_R [N m/rad] of springs."""

RINGS_OF = ("rigid", "three-degree", "housing")
"""How the load of a bearing is shared by its rollers."""

PROFILE = {"double_row_tapered": 4.5e-4, "single_row_tapered": 4.5e-4, "cylindrical": 3.5e-4}
"""Logarithmic profile over a roller's diameter by kind (ISO/TS 16281 as public code has it); other
rollers align themselves, and have none here."""


@dataclass(frozen=True)
class Choices:
    """What the user asks of the model.

    Attributes
    ----------
    named : Mapping
        Catalogue entry by bearing, before what the scene says.
    catalogues : Sequence
        Catalogue files of the user.
    profiled : bool
        Rollers have the standard's profile where their entry has none.
    support : str or float
        One of `SUPPORTS`, or K_R of springs [N m/rad].
    rings : str
        One of `RINGS_OF`.
    weight : bool
        Whether the weight of gearbox and shaft counts.
    only : str or None
        The one bearing whose life is asked for.
    assumed : tuple of str
        Options that were not given: their defaults are assumptions.
    """

    named: Mapping[str, Named]
    catalogues: Sequence[Path]
    profiled: bool
    support: str | float
    rings: str
    weight: bool
    only: str | None = None
    assumed: tuple[str, ...] = ()


@dataclass(frozen=True)
class Oil:
    """The oil of a gearbox.

    Attributes
    ----------
    lubricant : Lubricant
        The oil in its bearings.
    assumed : tuple of str
        Which of "lubricant", "temperature", "cleanliness" and "viscosity index" nobody stated.
    """

    lubricant: Lubricant
    assumed: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class OtherPath:
    """A way of the load to a bearing with another value of what was assumed.

    Attributes
    ----------
    assumed, instead : str
        What is taken, and what it is compared with.
    path : ReactionPath
        The way then.
    """

    assumed: str
    instead: str
    path: ReactionPath


@dataclass(frozen=True, eq=False)
class OneBearing:
    """A bearing of a drivetrain, ready for lives.

    Attributes
    ----------
    name, entry_name : str
        In the drivetrain, and in the catalogue.
    entry : Entry
        Of the catalogue.
    rated : RatedBearing
        With ratings.
    path : LoadPath or ReactionPath
        From the hub to its rollers: with them in equilibrium with the shaft, or by reactions.
    seat : float or None
        Diameter of the shaft there [m], where the drivetrain has it.
    rollers : callable
        From a bearing as this one, but for clearance and profile, to how its load is shared.
    misfit : str or None
        What does not fit there, though it may be meant, as a sentence.
    oil : Oil or None
        The oil of a gearbox's bearing; a main bearing has the lubricant of the options.
    turning : {"inner", "outer"} or None
        The ring that turns against the load, where the drivetrain says so: the outer of planets.
    planets : int
        Number of planets with such a bearing; 0 of one in the housing.
    levels : Mapping[str, ReactionPath]
        The load by each level of the drivetrain's statics, from the cheapest.
    others : tuple of OtherPath
        The load with other values of what was assumed.
    clearance : OperatingClearance or None
        Where the drivetrain says how it is mounted; `rated` has its mean.
    """

    name: str
    entry_name: str
    entry: Entry
    rated: RatedBearing
    path: LoadPath | ReactionPath
    seat: float | None
    rollers: Callable[[Bearing], RollerModel]
    misfit: str | None = None
    oil: Oil | None = None
    turning: Turning | None = None
    planets: int = 0
    levels: Mapping[str, ReactionPath] = field(default_factory=dict)
    others: tuple[OtherPath, ...] = ()
    clearance: OperatingClearance | None = None

    @property
    def seen(self) -> str:
        """How places of its rolling elements are counted."""
        if self.planets:
            return "on its pin, 0 deg towards the sun, 90 deg along the tangent about +x"
        return "looking downwind, 90 deg on top"

    @property
    def normal(self) -> float:
        """Clearance of the catalogue's kind for one of radial clearance."""
        return normal_of(self.entry)

    def path_with(self, bearing: Bearing) -> LoadPath | ReactionPath:
        """The load path with another clearance or profile of this bearing."""
        return self.path.with_bearing(bearing, self.rollers(bearing))

    def rules(self, asked: LifeRules) -> LifeRules:
        """Choices that change the life of this bearing, from those that are asked for."""
        return own_rules(asked, self.turning, self.oil)


def own_rules(asked: LifeRules, turning: Turning | None, oil: Oil | None) -> LifeRules:
    """Choices that change the life of a bearing, from those that are asked for.

    Parameters
    ----------
    asked : LifeRules
        Asked for, of all bearings.
    turning : {"inner", "outer"} or None
        The ring that turns against the load, where the drivetrain says so.
    oil : Oil or None
        The oil of a gearbox's bearing.
    """
    found = asked if turning is None else replace(asked, turning=turning)
    if oil is None or asked.lubricant is None:
        return found
    return replace(found, lubricant=oil.lubricant)


def bearings_of(scene: Scene, choices: Choices) -> list[OneBearing]:
    """The rolling bearings of a scene.

    Parameters
    ----------
    scene : Scene
        With one bearing unit or more.
    choices : Choices
        Of the user.

    Returns
    -------
    bearings : list of OneBearing
        In the scene's order; all of them, or the one that is asked for.

    Raises
    ------
    InputError
        A bearing has no entry, an entry is unknown or does not go on the shaft, or a choice is
        none.
    """
    stiffness = _stiffness(choices.support)
    _require_choices(scene, choices)
    named = _all_named(scene, choices)
    mounted = {name: unit_clearance(scene, name, one.entry) for name, one in named.items()}
    rated = {
        name: rated_from_catalogue(
            one.named,
            *choices.catalogues,
            **profile_of(one.entry, choices.profiled),
            **clearance_change(None, mounted[name]),
        )
        for name, one in named.items()
    }
    rolling = {name: one.bearing for name, one in rated.items()}
    body = scene_body(scene, 1)
    result = []
    for name, (entry_name, entry, seat, misfit, _) in named.items():
        if choices.only not in (None, name):
            continue
        rollers = _rollers(scene, name, rolling[name], choices.rings)
        path = LoadPath(
            body,
            rolling,
            name,
            rollers(rolling[name]),
            stiffness,
            scene.gearbox.weight if choices.weight else 0.0,
            GRAVITY if choices.weight else 0.0,
        )
        result.append(
            OneBearing(
                name,
                entry_name,
                entry.model_copy(update=clearance_change(None, mounted[name])),
                rated[name],
                path,
                seat,
                rollers,
                misfit,
                clearance=mounted[name],
            )
        )
    return result


def _require_choices(scene: Scene, choices: Choices) -> None:
    """Refuse a model of rings, or bearings, that there are not."""
    if choices.rings not in RINGS_OF:
        raise InputError(
            f"{argument('LifeOptions.rings', choices.rings)}: choose one of {', '.join(RINGS_OF)}"
        )
    units = [unit.bearing.name for unit in scene.bearing_units]
    if wrong := [name for name in choices.named if name not in units]:
        raise InputError(
            f"{_named(wrong[0], name_of(choices.named[wrong[0]]))}: the scene has no bearing "
            f"{wrong[0]!r}; name one of {', '.join(units)}"
        )
    if choices.only is not None and choices.only not in units:
        raise InputError(
            f"{argument('LifeOptions.only', choices.only)}: the scene has no such bearing; name "
            f"one of {', '.join(units)}"
        )


def _all_named(scene: Scene, choices: Choices) -> dict[str, NamedBearing]:
    """The catalogue entry of every bearing of the scene."""
    named = named_bearings(scene, choices.catalogues, choices.named)
    units = [unit.bearing.name for unit in scene.bearing_units]
    if nameless := [name for name in units if name not in named]:
        raise InputError(
            f"bearing {nameless[0]!r} of the scene has no rollers: name its entry of the catalogue "
            f"with {_named(nameless[0], 'ENTRY')}, or under 'catalogue' in the scene; there are "
            f"{', '.join(read_bearing_catalogue(*choices.catalogues))}"
        )
    return named


def _named(bearing: str, entry: str) -> str:
    """The option that names a bearing's entry."""
    return argument("LifeOptions.bearings", {bearing: entry})


def _rollers(
    scene: Scene, name: str, bearing: Bearing, rings: str
) -> Callable[[Bearing], RollerModel]:
    """How a bearing's load is shared, for any clearance and profile of its rollers."""
    if rings != "housing":
        return three_degree_rings if rings == "three-degree" else rigid_rings
    from fe_drivetrain.bearing_life.rings.housing import housing_races

    races = housing_races(scene, name, bearing)
    return partial(_on_races, races)


def _on_races(races: Races, bearing: Bearing) -> RollerModel:
    return flexible_rings(replace(races, bearing=bearing))


def rollers_in_words(one: OneBearing, riser: str) -> str:
    """What the ends of rollers are taken to be, as a sentence.

    Parameters
    ----------
    one : OneBearing
        The bearing.
    riser : str
        Of `LifeRules`.

    Returns
    -------
    text : str
        Names profile and stress riser together.
    """
    rows = [row for row in one.rated.bearing.rows if isinstance(row, RollerRow)]
    if not rows:
        return "balls, whose contact angle follows the load"
    profiled = any(row.crown for row in rows)
    shape = "rollers with the logarithmic profile" if profiled else "straight rollers"
    if rows[0].aligning and not profiled:
        shape = "barrel rollers that align themselves, evenly loaded along their length"
    ends = "with the stress riser of ISO/TS 16281" if riser == "standard" else "no stress riser"
    if riser == "standard" and not profiled and not rows[0].aligning:
        ends += ", which is for profiled ones: their ends count twice"
    return f"{shape}, {ends}"


def profile_of(entry: Entry, profiled: bool) -> dict[str, Any]:
    """The standard's profile, for rollers whose entry has none.

    Parameters
    ----------
    entry : Entry
        The bearing's entry.
    profiled : bool
        Whether it is asked for.
    """
    if not profiled or entry.crown or entry.kind not in PROFILE:
        return {}
    page, crown = entry.page, PROFILE[entry.kind]
    if entry.fitted and page is not None and page.inside is not None:
        crown *= float(insides_of_page(page).crown[page.inside])
    return {"crown": crown}


def _stiffness(support: str | float) -> float | None:
    if support in SUPPORTS:
        return None if support == "rollers" else PINNED
    try:
        value = float(support)
    except ValueError:
        value = -1.0
    if not 0.0 <= value < 1e16:
        raise InputError(
            f"{argument('LifeOptions.support', support)}: choose {', '.join(SUPPORTS)}, or K_R in "
            "N m/rad, as 145e6"
        )
    return value


def row_names(count: int) -> list[str]:
    """What rows are called, upwind first."""
    return ["row"] if count == 1 else ["upwind row", "downwind row"][:count]
