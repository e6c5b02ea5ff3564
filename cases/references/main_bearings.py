"""A main bearing on its rollers in its shaft: the thesis's, or that of a user's drivetrain."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from fe_drivetrain.bearing import Bearing
from fe_drivetrain.bearing_life.coupled import (
    CoupledEquilibrium,
    LinearBody,
    LoadPath,
    coupled_equilibrium,
    factors_of,
)
from fe_drivetrain.cases.references.thesis_beam import BEAM, BEARINGS, beam_body, bearing_s
from fe_drivetrain.common import InputError
from fe_drivetrain.drivetrain_file import Scene
from fe_drivetrain.report.suite import Page, Run
from fe_drivetrain.report.suite.chosen import ChosenDrivetrain
from fe_drivetrain.shafts.response import entering
from fe_drivetrain.shafts.response.entering import Loads
from fe_drivetrain.studies.rolling_bearings import Choices, OneBearing, bearings_of
from fe_drivetrain.turbine_loads.hub_loads import Rotor

ARRANGED, OTHERWISE = "X, 38 deg", "O, 20 deg"
"""Arrangement and contact angle of bearing S, neither of which is printed, and another."""

SPREAD = 2.3
"""Power of the radius by which rotor masses go from the rotor of 2 MW to the NREL 5 MW one."""


@dataclass(frozen=True, eq=False)
class InShaft:
    """A main bearing in its shaft, in equilibrium with it and with the others.

    Attributes
    ----------
    name : str
        Name of the bearing in the body.
    body : LinearBody
        The shaft on its gearbox.
    bearings : Mapping[str, Bearing]
        All bearings of the body.
    gearbox_weight, gravity : float
        [N], [m/s^2].
    """

    name: str
    body: LinearBody
    bearings: Mapping[str, Bearing]
    gearbox_weight: float
    gravity: float = 0.0

    @property
    def bearing(self) -> Bearing:
        """The bearing that is asked about."""
        return self.bearings[self.name]

    def under(self, hub_loads: Loads) -> CoupledEquilibrium:
        """Balance under hub loads: a history, or (n, 6) about the front of the shaft [N, N m]."""
        loads = entering(self.body, hub_loads)
        factors = factors_of(loads, self.gearbox_weight, self.gravity)
        return coupled_equilibrium(self.body, self.bearings, factors)


@dataclass(frozen=True, eq=False)
class OwnBearing:
    """The main bearing of a user's drivetrain, and the turbine that loads it.

    Attributes
    ----------
    chosen : ChosenDrivetrain
        The drivetrain.
    one : OneBearing
        The bearing with its ratings and its path from the hub's loads.
    rotor : Rotor
        Brought to the drivetrain's rated power and speed.
    choices : Choices
        By which the bearing was found.
    """

    chosen: ChosenDrivetrain
    one: OneBearing
    rotor: Rotor
    choices: Choices

    def profiled(self) -> OneBearing:
        """The bearing with the standard's profile of its rollers, where their entry has none."""
        scene = self.chosen.drivetrain
        assert isinstance(scene, Scene)
        return bearings_of(scene, replace(self.choices, profiled=True))[0]

    @property
    def in_shaft(self) -> InShaft:
        """The bearing in its shaft."""
        path = self.one.path
        assert isinstance(path, LoadPath)
        return InShaft(path.name, path.body, path.bearings, path.gearbox_weight, path.gravity)


def thesis_in_shaft(arrangement: str = ARRANGED) -> InShaft:
    """Bearing S in the beam of Stirling 2023, chapter 4."""
    bearing = bearing_s(BEARINGS[arrangement])
    return InShaft("bearing", beam_body(), {"bearing": bearing}, BEAM.gearbox_weight)


def own_bearing(run: Run, page: Page, topic: str, moments: bool = False) -> OwnBearing | None:
    """The main bearing of the drivetrain that the user names; None of the thesis's own.

    Parameters
    ----------
    run : Run
        With the settings drivetrain, bearing and catalogue.
    page : Page
        Takes what is assumed.
    topic : str
        What is asked of it.
    moments : bool
        Whether it has to carry moments.

    Raises
    ------
    InputError
        The file has no main shaft with sections, no rollers of its main bearings, no such bearing,
        one that aligns itself where moments are asked about, or does not state its operation; or
        a setting stands there without a drivetrain.
    """
    if "drivetrain" not in run.settings:
        for name in ("bearing", "catalogue"):
            if name in run.settings:
                raise InputError(f"{name} is of a drivetrain of yours: give drivetrain=FILE, too")
        return None
    chosen = run.drivetrain("")
    chosen.state(page, topic=topic)
    scene = chosen.drivetrain
    if not isinstance(scene, Scene):
        raise InputError(
            f"drivetrain {chosen.name!r} does not state shaft.sections, on whose bearings loads "
            "are asked for: give shaft.front, shaft.sections and bearing_units"
        )
    _require_rollers(chosen.name, scene, run.settings.get("bearing"))
    catalogues = [Path(str(run.settings["catalogue"]))] if "catalogue" in run.settings else []
    choices = Choices({}, catalogues, False, "rollers", "rigid", True, run.settings.get("bearing"))
    one = bearings_of(scene, choices)[0]
    if moments and all(getattr(row, "aligning", False) for row in one.rated.bearing.rows):
        raise InputError(
            f"bearing {one.name!r} aligns itself and resists no tilt: name another one of "
            f"{chosen.name!r} with bearing=NAME, or give it rollers of another kind"
        )
    return OwnBearing(chosen, one, own_rotor(page, chosen), choices)


def _require_rollers(name: str, scene: Scene, asked: object) -> None:
    """Refuse a scene without rollers in its main bearings, or without the one asked for."""
    units = {unit.bearing.name: unit.catalogue for unit in scene.bearing_units}
    if asked is not None and asked not in units:
        raise InputError(
            f"bearing={asked}: {name!r} has no such main bearing: name one of {', '.join(units)}"
        )
    if missing := [bearing for bearing, entry in units.items() if entry is None]:
        raise InputError(
            f"bearing {missing[0]!r} of {name!r} has no rollers: name its entry of the bearing "
            "catalogue in its unit, as in catalogue: bearing_s, and give catalogue=FILE where the "
            "entry is yours"
        )


def own_rotor(page: Page, chosen: ChosenDrivetrain) -> Rotor:
    """The rotor of the surrogate, brought to a drivetrain's rated power and speed.

    Raises
    ------
    InputError
        The file states neither of them.
    """
    power, speed = chosen.rated_torque() * chosen.rotor_speeds()[1], chosen.rotor_speeds()[1]
    base = Rotor()
    size = (power / base.rated_power) ** 0.5
    rotor = chosen.drivetrain.rotor
    mass = None if rotor is None else rotor.mass
    found = Rotor(
        rated_power=power,
        radius=size * base.radius,
        hub_height=size * base.hub_height,
        rotor_mass=mass or base.rotor_mass * size**SPREAD,
        blade_start=size * base.blade_start,
        tip_speed_limit=speed * size * base.radius,
    )
    by = "as the surrogate's of 2 MW, by rated power"
    page.assume("rotor radius, in proportion to the root of rated power", found.radius, "m", by)
    page.assume("hub height", found.hub_height, "m", by)
    if not mass:
        page.assume("rotor mass", found.rotor_mass, "kg", "the file states none; by radius")
    page.assume("hub loads", "surrogate", "", "a turbine of that size with a controller")
    page.assume("housing", "rigid", "", "rollers alone give way")
    return found
