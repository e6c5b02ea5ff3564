"""Histories of a turbine whose speed and pitch vary: hub loads with azimuth, speed and pitch.

The wind is that of `surrogate`, with the same random numbers for a condition, and so are the
aerofoils and the mean state of the rotor.  What is new: the controller (`controller`), the delays
of the wake, blades that bend, a tower that moves and slows the wind, a shaft that twists
(`turbine`), each of which can be left out.

Left out: second and higher modes of blades and tower, blades that twist, a nacelle that nods or
yaws, wind across and up, unsteady aerofoils, wake skew.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterable, Iterator
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.cache import Cache, user_cache
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.turbine_loads.hub_loads.aero_rotor import OperatingPoint
from fe_drivetrain.turbine_loads.hub_loads.controller import (
    Controller,
    designed_controller,
    steady_operation,
)
from fe_drivetrain.turbine_loads.hub_loads.csv_table import write_hub_loads
from fe_drivetrain.turbine_loads.hub_loads.histories import Attribute, LoadHistory
from fe_drivetrain.turbine_loads.hub_loads.recorded import Recorded
from fe_drivetrain.turbine_loads.hub_loads.surrogate import DURATION, RATE, Condition, made_by
from fe_drivetrain.turbine_loads.hub_loads.turbine import Physics, Turbine
from fe_drivetrain.turbine_loads.hub_loads.turbine_account import STORED, EnergyAccount
from fe_drivetrain.turbine_loads.hub_loads.turbine_parts import (
    SETTLING,
    Inflow,
    even_inflow,
    kernel_control,
    kernel_parts,
    mean_shear,
    turbulence_of,
)
from fe_drivetrain.turbine_loads.hub_loads.wind import (
    DiscTurbulence,
    turbulence_sigma,
)

LONGEST_STEP = 0.025
"""Of the integration [s]: 15 in a period of the fastest mode, which it damps by 2e-4 of it."""

_KEPT = ("loads", "azimuth", "rotor_speed", "pitch", "generator_torque", "power", "wind_speed")


@dataclass(frozen=True, eq=False)
class TurbineHistory:
    """What one run gives, each (n,) but for the loads.

    Attributes
    ----------
    history : LoadHistory
        The hub loads.
    azimuth : ndarray
        Angle of blade 1 from upwards [rad], growing.
    rotor_speed : ndarray
        [rad/s].
    pitch : ndarray
        [rad].
    generator_torque : ndarray
        At the slow shaft [N m].
    power : ndarray
        That the air gives [W].
    wind_speed : ndarray
        Mean over the disc [m/s].
    """

    history: LoadHistory
    azimuth: Floats
    rotor_speed: Floats
    pitch: Floats
    generator_torque: Floats
    power: Floats
    wind_speed: Floats

    __repr__ = short_repr

    @property
    def recorded(self) -> Recorded:
        """The loads with speed and wind, as a file of measurements gives them."""
        return Recorded(self.history, self.rotor_speed, self.wind_speed)

    def write(self, path: str | os.PathLike[str]) -> None:
        """Write a table that the command ``loads`` and `read_recorded` read.

        Parameters
        ----------
        path : str or path-like
            A file that ends in .csv.

        Raises
        ------
        InputError
            It cannot be written.
        """
        beside = {
            "rotor speed [rad/s]": self.rotor_speed,
            "wind speed [m/s]": self.wind_speed,
            "azimuth [rad]": self.azimuth,
            "pitch [rad]": self.pitch,
            "generator torque [N m]": self.generator_torque,
        }
        write_hub_loads(self.history, path, beside)


def simulate(
    turbine: Turbine,
    controller: Controller,
    inflow: Inflow,
    physics: Physics | None = None,
    *,
    azimuth: float = 0.0,
    held: bool = False,
    start: tuple[float, float] | None = None,
    longest_step: float = LONGEST_STEP,
) -> tuple[Floats, Floats]:
    """Let a turbine turn in a wind.

    Parameters
    ----------
    turbine, controller, inflow : Turbine, Controller, Inflow
        The turbine, its controller, the wind.
    physics : Physics or None
        All of it if not given.
    azimuth : float
        At the beginning [rad].
    held : bool
        Pitch and torque of the generator stay as they are at the beginning.
    start : tuple of float or None
        Speed [rad/s] and pitch [rad] at the beginning; those of the mean wind if not given.
    longest_step : float
        Longest step of the integration [s]: it decides how many steps a sample takes.

    Returns
    -------
    ndarray, (n, 6)
        Hub loads [N, N m].
    ndarray, (n, 68)
        Pitch [rad], torque of the generator [N m], power of the air [W], wind [m/s], state, its
        rates, and the air's sums over each blade, of which `root_loads` makes loads of its root.

    Raises
    ------
    InputError
        The rotor stops or runs away, or the step is not above zero.
    """
    moves = physics or Physics()
    return _run(turbine, controller, inflow, moves, azimuth, held, start, longest_step, False)[:2]


def energy_account(
    turbine: Turbine,
    controller: Controller,
    inflow: Inflow,
    physics: Physics | None = None,
    *,
    azimuth: float = 0.0,
    held: bool = False,
    start: tuple[float, float] | None = None,
    longest_step: float = LONGEST_STEP,
) -> EnergyAccount:
    """Energies, and work of all that changes them, of the run that `simulate` makes.

    Parameters
    ----------
    turbine, controller, inflow, physics : Turbine, Controller, Inflow, Physics or None
        The same as for `simulate`.
    azimuth, held, start, longest_step : float, bool, tuple of float or None, float
        As there.

    Raises
    ------
    InputError
        As there.
    """
    moves = physics or Physics()
    books = _run(turbine, controller, inflow, moves, azimuth, held, start, longest_step, True)[2]
    return _account(books)


def turbine_history(
    condition: Condition,
    turbine: Turbine,
    controller: Controller | None = None,
    physics: Physics | None = None,
    duration: float = DURATION,
    rate: float = RATE,
) -> TurbineHistory:
    """Make one history, without looking on disk.

    Parameters
    ----------
    condition : Condition
        The wind.
    turbine : Turbine
        The turbine.
    controller : Controller or None
        `designed_controller` if not given.
    physics : Physics or None
        All of it if not given.
    duration, rate : float
        Length [s], and samples per second [Hz].

    Raises
    ------
    InputError
        Duration or rate leave too few samples, or the turbine cannot work in this wind.
    """
    field = turbulence_of(turbine, condition.wind_speed, duration, rate)
    chosen = controller or designed_controller(turbine)
    return simulated_condition(condition, turbine, chosen, physics or Physics(), field)[0]


def accounted_history(
    condition: Condition,
    turbine: Turbine,
    controller: Controller | None = None,
    physics: Physics | None = None,
    duration: float = DURATION,
    rate: float = RATE,
    *,
    longest_step: float = LONGEST_STEP,
    harmonics: int | None = None,
) -> tuple[TurbineHistory, EnergyAccount]:
    """Make one history, with the account of its energy.

    Parameters
    ----------
    condition, turbine : Condition, Turbine
        The wind, the turbine.
    controller, physics, duration, rate : Controller or None, Physics or None, float, float
        The same as for `turbine_history`.
    longest_step : float
        Longest step of the integration [s], as for `simulate`.
    harmonics : int or None
        Harmonics of azimuth in the wind, the first of those that are drawn for the rotor; all if
        not given.

    Returns
    -------
    TurbineHistory
        That of `turbine_history` with its step and all harmonics.
    EnergyAccount
        From the beginning, of `SETTLING` before the history, too.

    Raises
    ------
    InputError
        As there, or the step is not above zero.
    """
    field = turbulence_of(turbine, condition.wind_speed, duration, rate)
    chosen, moves = controller or designed_controller(turbine), physics or Physics()
    made, _, books = simulated_condition(
        condition, turbine, chosen, moves, field, longest_step, harmonics, accounted=True
    )
    return made, _account(books)


def turbine_histories(
    conditions: Iterable[Condition],
    turbine: Turbine,
    controller: Controller | None = None,
    physics: Physics | None = None,
    duration: float = DURATION,
    rate: float = RATE,
    *,
    cache: bool | Cache = True,
    progress: Callable[[int], None] | None = None,
) -> Iterator[TurbineHistory]:
    """Make histories one after the other, or take those that were kept.

    One is in memory at a time, and each is kept as soon as it is made: stopped and begun again, the
    work goes on where it was.

    Parameters
    ----------
    conditions : iterable of Condition
        The winds; those of one mean speed side by side share what is expensive.
    turbine, controller, physics : Turbine, Controller or None, Physics or None
        The same as for `turbine_history`.
    duration, rate : float
        As there.
    cache : bool or Cache
        Whether to keep histories in the user's cache, or another.
    progress : callable or None
        Called with the number done.

    Raises
    ------
    InputError
        As `turbine_history`.
    """
    kept = cache if isinstance(cache, Cache) else user_cache() if cache else Cache(None)
    chosen, moves = controller or designed_controller(turbine), physics or Physics()
    field: DiscTurbulence | None = None
    of_speed = float("nan")
    for done, condition in enumerate(conditions, 1):
        content = {
            "made by": made_by(),
            "what": "moving turbine",
            "turbine": asdict(turbine),
            "controller": asdict(chosen),
            "physics": asdict(moves),
            "condition": asdict(condition),
            "duration": float(duration),
            "rate": float(rate),
        }
        made = _load(kept.load("hub-loads", content), condition, rate)
        if made is None:
            if field is None or condition.wind_speed != of_speed:
                field = turbulence_of(turbine, condition.wind_speed, duration, rate)
                of_speed = condition.wind_speed
            made = simulated_condition(condition, turbine, chosen, moves, field)[0]
            arrays = {name: getattr(made, name) for name in _KEPT[1:]}
            kept.keep("hub-loads", content, {"loads": made.history.loads, **arrays})
        if progress is not None:
            progress(done)
        yield made


# --- making --------------------------------------------------------------------------------------


def _run(
    turbine: Turbine,
    controller: Controller,
    inflow: Inflow,
    physics: Physics,
    azimuth: float,
    held: bool,
    start: tuple[float, float] | None,
    longest_step: float,
    accounted: bool,
) -> tuple[Floats, Floats, Floats]:
    """Loads and what is beside them, as of `simulate`, and the compiled account, if it is kept."""
    from fe_drivetrain.turbine_loads.hub_loads.turbine_kernel import run_turbine

    if not longest_step > 0.0:
        raise InputError(f"turbine: longest_step is {longest_step} s; it must be above zero")
    point = steady_operation(turbine, controller, inflow.speed)
    speed, pitch = start or (point.rotor_speed, point.pitch)
    parts = kernel_parts(turbine, physics, inflow)
    state, wake = _beginning(turbine, controller, inflow, point, parts, azimuth, speed, pitch)
    # a step that divides a sample but for round-off divides it
    steps = max(math.ceil(1.0 / (inflow.rate * longest_step) - 1e-9), 1)
    made, beside, books = run_turbine(
        parts,
        kernel_control(controller, held),
        np.ascontiguousarray(inflow.harmonics),
        mean_shear(turbine, inflow),
        state,
        pitch,
        wake,
        1.0 / inflow.rate,
        steps,
        accounted,
    )
    if len(made) < len(inflow.harmonics):
        raise InputError(
            f"turbine at {inflow.speed:g} m/s: the rotor stopped or ran away after "
            f"{len(made) / inflow.rate:g} s; choose a controller whose "
            "frequency and damping suit it, or a higher wind"
        )
    return made, beside, books


def _beginning(
    turbine: Turbine,
    controller: Controller,
    inflow: Inflow,
    point: OperatingPoint,
    parts: Any,
    azimuth: float,
    speed: float,
    pitch: float,
) -> tuple[Floats, Floats]:
    """State and wake; blades and tower begin bent as the mean thrust bends them."""
    from fe_drivetrain.turbine_loads.hub_loads import turbine_air as air

    wake = np.empty((4, point.radius.size))
    wake[::2] = point.axial * inflow.speed * math.cos(turbine.rotor.shaft_tilt)
    wake[1::2] = point.tangential * point.rotor_speed * point.radius
    state = np.zeros(air.STATES)
    state[[air.PSI, air.SPEED, air.GENERATOR]] = azimuth, speed, speed
    torque = controller.torque(speed, pitch)
    state[air.TWIST] = torque / turbine.shaft_stiffness if parts.torsion else 0.0
    mean = even_inflow(turbine, inflow.speed, np.zeros(1), inflow.rate, inflow.shear)
    sums = np.zeros((5, max(wake.shape[1], air.SUMS)))
    wind = np.zeros((3, point.radius.size))
    air.met_wind(parts, mean.harmonics[0].astype(float), azimuth, wind, np.zeros(1))
    air.blade_sums(parts, state, pitch, wind, wake, sums)
    if parts.tower_moves:
        state[air.FORE] = sums[:3, 0].sum() / (turbine.top_mass * parts.tower_rate**2)
    if parts.blades_move:
        stiffness = parts.stiffness[0] + speed**2 * parts.stiffening[0, 0]
        own = sums[:3, 4] + turbine.cone * speed**2 * parts.moment[0, 0]
        state[air.MODES : air.MODES + 3] = own.mean() / stiffness
    return state, wake


def _account(books: Floats) -> EnergyAccount:
    """The compiled account; what is done before the first record is not in it."""
    count = len(STORED)
    return EnergyAccount(books[:, :count], books[:, count:] - books[0, count:])


def simulated_condition(
    condition: Condition,
    turbine: Turbine,
    controller: Controller,
    physics: Physics,
    field: DiscTurbulence,
    longest_step: float = LONGEST_STEP,
    highest: int | None = None,
    *,
    accounted: bool = False,
) -> tuple[TurbineHistory, Floats, Floats]:
    """A history, what is beside its loads, and the compiled account, if it is kept.

    Parameters
    ----------
    condition, turbine, controller, physics : Condition, Turbine, Controller, Physics
        The wind, the turbine.
    field : DiscTurbulence
        Turbulence at the wind's mean speed, see `turbulence_of`.
    longest_step : float
        Longest step of the integration [s].
    highest : int or None
        Harmonics of azimuth in the wind; all if not given.
    accounted : bool
        Whether the account of the energy is kept.
    """
    generator = condition.generator()
    azimuth = generator.uniform(0.0, 2.0 * np.pi)
    sigma = turbulence_sigma(condition.wind_speed, condition.turbulence)
    if sigma > 0.0:
        drawn = np.moveaxis(field.draw(generator), -1, 0)
        harmonics = np.ascontiguousarray(np.float32(sigma) * drawn)
    else:
        harmonics = np.zeros((field.samples, 1, field.radius.size), dtype=np.float32)
    inflow = Inflow(condition.wind_speed, condition.shear, harmonics, field.rate).up_to(highest)
    loads, beside, books = _run(
        turbine, controller, inflow, physics, azimuth, False, None, longest_step, accounted
    )
    loads, beside = (of[round(SETTLING * field.rate) :] for of in (loads, beside))
    pitch, torque, power, wind, psi, speed = beside[:, :6].T
    arrays = dict(zip(_KEPT, (loads, psi, speed, pitch, torque, power, wind), strict=True))
    return _history(condition, arrays, field.rate), beside, books


def _history(condition: Condition, arrays: dict[str, Floats], rate: float) -> TurbineHistory:
    attributes: dict[str, Attribute] = {**asdict(condition), "source": "moving turbine"}
    loads = arrays["loads"]
    time = np.arange(len(loads)) / rate
    history = LoadHistory(condition.name, time, loads, attributes, about="front face")
    return TurbineHistory(history, **{name: arrays[name] for name in _KEPT[1:]})


def _load(
    arrays: dict[str, Floats] | None, condition: Condition, rate: float
) -> TurbineHistory | None:
    """A kept history, or None if it is not there or not sound."""
    if arrays is None or set(arrays) != set(_KEPT):
        return None
    if any(len(a) != len(arrays["loads"]) or not np.isfinite(a).all() for a in arrays.values()):
        return None
    return _history(condition, arrays, rate)
