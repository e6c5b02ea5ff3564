"""What loads the gears: a torque for all hours, a spectrum that is given, or files of hub loads."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import FORCES, LARGEST_LOAD
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.progress import Progress
from fe_drivetrain.studies.gear_machine import GearTrain
from fe_drivetrain.studies.gear_options import HOURS, GearOptions
from fe_drivetrain.studies.gear_spectra import (
    Reading,
    TorqueSpectrum,
    constant_spectrum,
    files_spectrum,
    stated_spectrum,
)
from fe_drivetrain.studies.torque_classes import Rows
from fe_drivetrain.turbine_loads.histories.sites import HOURS_A_YEAR, Site

_MOST = 20
"""Reference torques to which classes may reach."""


@dataclass(frozen=True)
class GearLoads:
    """What loads the gears.

    Attributes
    ----------
    spectrum : TorqueSpectrum or None
        Torques and turns of the life asked for; None where no speed of the rotor is known.
    hub : ndarray, (6,)
        Loads of the hub at the reference torque, Mx being 0 [N, N m].
    weight : bool
        Whether the rotor has its weight; loads of a hub hold it already.
    varies : bool
        Whether the spectrum has several torques.
    alone : bool
        Whether files have the torque alone, so that the rotor's weight acts beside it.
    hours : float
        Life asked for [h]: of a site all hours of its years, those outside of the winds of the
        files without load.
    """

    spectrum: TorqueSpectrum | None
    hub: Floats
    weight: bool
    varies: bool
    hours: float
    alone: bool = False


@dataclass(frozen=True)
class GearLoading:
    """Loads of gears as they are asked for; see `gears`."""

    files: Sequence[Path]
    site: Site | None
    hub: Mapping[str, float] | None
    spectrum: Rows | None
    resume: bool


def check_loading(options: GearOptions, given: GearLoading) -> None:
    """Refuse loads that contradict each other, or say nothing.

    Parameters
    ----------
    options : GearOptions
        Choices of the rating.
    given : GearLoading
        Loads as asked for.

    Raises
    ------
    InputError
        See above.
    """
    files, site, hub, spectrum = given.files, given.site, given.hub, given.spectrum
    if files and spectrum is not None:
        raise InputError(
            f"gears: {argument('loads')} and {argument('spectrum')} are both given: give one, "
            "since either makes the torque spectrum"
        )
    if site is not None and not files:
        raise InputError(
            f"gears: {argument('site')} weights files of hub loads: give {argument('loads')}, too"
        )
    if site is not None and options.hours is not None:
        raise InputError(
            f"gears: {argument('GearOptions.hours', options.hours)} h beside "
            f"{argument('site')}, whose years are the life asked for: leave one out"
        )
    if hub is not None:
        if files:
            raise InputError(
                f"gears: {argument('hub')} beside {argument('loads')}, which hold the loads of the "
                "hub: leave one out"
            )
        hub_wrench(hub)


def hub_wrench(hub: Mapping[str, float]) -> Floats:
    """(6,) loads of the hub by component, Mx being 0 [N, N m].

    Parameters
    ----------
    hub : mapping of str to float
        Some of Fx, Fy, Fz, My, Mz.

    Raises
    ------
    InputError
        A component is none of them, or no finite number.
    """
    found = np.zeros(6)
    for name, value in hub.items():
        if name not in FORCES or name == "Mx":
            raise InputError(
                f"gears: {name!r} is no load of the hub beside its torque: use one of Fx, Fy, Fz, "
                f"My, Mz, and {argument('torque')} for Mx"
            )
        if not abs(float(value)) < LARGEST_LOAD:
            raise InputError(
                f"gears: {name} of the hub is {value:g} N or N m but must be below "
                f"{LARGEST_LOAD:g}: correct it"
            )
        found[FORCES.index(name)] = float(value)
    return found


def loads_of(
    train: GearTrain, asked: GearOptions, given: GearLoading, report: Progress
) -> GearLoads:
    """Spectrum of the life asked for, and loads of the hub at the reference torque.

    Parameters
    ----------
    train : GearTrain
        The machine, its reference torque and speed.
    asked : GearOptions
        Choices of the rating.
    given : GearLoading
        Loads as asked for.
    report : Progress
        Told which file is read.

    Raises
    ------
    InputError
        A file cannot be read, or a spectrum has no turns or no hours.
    """
    files, site, hub, spectrum = given.files, given.site, given.hub, given.spectrum
    width, speed = train.torque / asked.classes, train.conditions.speed
    beside = np.zeros(6) if hub is None else hub_wrench(hub)
    hours = HOURS if asked.hours is None else asked.hours
    if files:
        reading = Reading(asked, width, train.entrance)
        whole, alone = files_spectrum(files, reading, site, given.resume, report)
        if len(whole.torques) > _MOST * asked.classes:
            raise InputError(
                f"gears: the torque of the files goes to {_MOST} times the reference torque, "
                f"{train.torque:g} N m, and more: give {argument('torque')} of their size"
            )
        if site is None:
            whole = whole.times(hours / whole.hours)
        nearest = int(np.abs(whole.torques - train.torque).argmin())
        asked_for = hours if site is None else site.years * HOURS_A_YEAR
        return GearLoads(whole, whole.hub[nearest], alone, True, asked_for, alone)
    if spectrum is not None:
        whole = stated_spectrum(spectrum, beside, speed, width)
        if not whole.hours > 0.0:
            raise InputError("the torque spectrum lasts 0 h: give hours above 0")
        if asked.hours is not None:
            whole = whole.times(hours / whole.hours)
        return GearLoads(whole, beside, hub is None, True, whole.hours)
    if speed is None:
        return GearLoads(None, beside, hub is None, False, hours)
    constant = constant_spectrum(train.torque, beside, hours, speed)
    return GearLoads(constant, beside, hub is None, False, hours)
