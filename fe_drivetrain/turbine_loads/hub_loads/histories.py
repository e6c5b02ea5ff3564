"""Hub-load histories: loads of the rotor on the end of the shaft, against time.

A history is six components against time at the hub (the apex of the rotor), in the shaft frame that
does NOT rotate: x along the shaft downwind, z up (square to x, in the vertical plane), y = z cross
x.  It is the load of the rotor on the shaft: rotor weight is a negative Fz.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import FORCES, LARGEST_LOAD
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.comparison.statistics import CONSTANT
from fe_drivetrain.plots.figures import load_lines
from fe_drivetrain.turbine_loads.hub_loads.high_speed import TORQUE_OF
from fe_drivetrain.turbine_loads.hub_loads.point_loads import PointLoads
from fe_drivetrain.turbine_loads.hub_loads.sampling import STEP_TOLERANCE, Sampling, sampling_of

UNITS = ("N", "N", "N", "N m", "N m", "N m")

MAX_LOAD = LARGEST_LOAD
"""A hub load beyond this (N, N m) is a typing or unit error."""

MIN_SAMPLES = 3
"""Two samples of any two signals correlate perfectly, so three is the fewest for which a mean
error, an RMSE and a correlation all say something."""

SHORTEST_STEP, LONGEST_STEP = 1e-9, 1e9
"""Time steps [s] beyond these are a typing or unit error."""

NEED_ALL = (
    "reactions need all six, so add the others, or ask for statistics of what there is (loads)"
)
"""What a history without some components is good for, as the end of a sentence."""

Attribute = float | int | str

About = float | Literal["front face"] | None
"""What moments at the hub are about: x on the shaft's axis [m], the front face of any shaft, or,
of None, the point that a scene states for hub loads (hub.loads_at)."""


@dataclass(frozen=True, eq=False)
class LoadHistory:
    """Hub loads against time, in the shaft frame that does not rotate.

    Attributes
    ----------
    name : str
        What the history is called in tables and messages.
    time : (n,) [s]
        Uniform to within ``STEP_TOLERANCE``, increasing, at least ``MIN_SAMPLES`` long.
    loads : (n, 6) [N, N, N, N m, N m, N m]
        Fx, Fy, Fz, Mx, My, Mz of the rotor on the shaft, at the hub.
    attributes : Mapping[str, Attribute]
        What is known of the conditions: wind_speed [m/s], turbulence, shear, seed, source.
    at : Mapping[str, Floats]
        (n, 6) loads on the shaft at other points of it, by the point's name, in the same frame and
        about that point.
    unread : Sequence[str]
        Titles of the other columns of the table that it was read from, in which `require_points`
        looks for misspelt load points.
    about : float, "front face" or None
        The point that moments at the hub are about, see `About`; None of a file.
    measured : bool
        Components may be absent, columns of NaN throughout, and steps may differ or leave gaps: see
        `absent` and `sampling`. Its statistics can be counted, but it cannot act on a scene.

    Raises
    ------
    InputError
        If the shapes disagree, a value is NaN or infinite, time does not increase or has a gap,
        or there are too few samples.
    """

    name: str
    time: Floats
    loads: Floats
    attributes: Mapping[str, Attribute] = field(default_factory=dict)
    at: Mapping[str, Floats] = field(default_factory=dict)
    unread: Sequence[str] = ()
    about: About = None
    measured: bool = False

    __repr__ = short_repr

    def __post_init__(self) -> None:
        time = _frozen(self.time)
        loads = _frozen(self.loads)
        if time.ndim != 1 or loads.shape != (time.size, len(FORCES)):
            raise InputError(
                f"load history '{self.name}': time has shape {time.shape} and loads {loads.shape}; "
                f"give (n,) and (n, 6) in the order {', '.join(FORCES)}"
            )
        object.__setattr__(self, "time", time)
        object.__setattr__(self, "loads", loads)
        object.__setattr__(self, "attributes", dict(self.attributes))
        at = {name: _frozen(values) for name, values in self.at.items()}
        object.__setattr__(self, "at", at)
        columns = {n: c for n, c in zip(FORCES, loads.T, strict=True) if n not in self.absent}
        if not columns:
            raise InputError(
                f"load history '{self.name}': it has none of {', '.join(FORCES)}; give one or more"
            )
        for point, values in at.items():
            if values.shape != loads.shape:
                raise InputError(
                    f"load history '{self.name}': loads at {point} have shape {values.shape} and "
                    f"those at the hub {loads.shape}; give one row for each sample"
                )
            columns |= {f"{point}.{c}": v for c, v in zip(FORCES, values.T, strict=True)}
        require_sound(f"load history '{self.name}'", time, columns, even=not self.measured)

    def __len__(self) -> int:
        return int(self.time.size)

    @property
    def step(self) -> float:
        """Mean time between two samples [s]."""
        return float(self.time[-1] - self.time[0]) / (len(self) - 1)

    @property
    def seconds(self) -> float:
        """From the first sample to the last [s]."""
        return float(self.time[-1] - self.time[0])

    @property
    def absent(self) -> tuple[str, ...]:
        """Components that were not recorded, which are not known rather than zero."""
        if not self.measured:
            return ()
        return tuple(n for n, c in zip(FORCES, self.loads.T, strict=True) if np.isnan(c).all())

    @property
    def torque_of(self) -> str:
        """The shaft that Mx was recorded at, where that is not the rotor's; else empty."""
        return str(self.attributes.get(TORQUE_OF, ""))

    @property
    def sampling(self) -> Sampling:
        """Steps and gaps."""
        return sampling_of(self.time)

    def component(self, name: str) -> Floats:
        """One component by its name, for example ``"My"``: (n,) [N or N m].

        Raises
        ------
        InputError
            If there is no component of that name.
        """
        if name not in FORCES:
            raise InputError(f"hub-load component '{name}' is not one of {', '.join(FORCES)}")
        return self.loads[:, FORCES.index(name)]

    def between(self, start: float, stop: float = np.inf) -> LoadHistory:
        """The samples with start <= time <= stop [s], for example without a start-up transient."""
        kept = (self.time >= start) & (self.time <= stop)
        at = {name: values[kept] for name, values in self.at.items()}
        return replace(self, time=self.time[kept], loads=self.loads[kept], at=at)

    def moved(self, start: float, stop: float) -> LoadHistory:
        """The same loads, those at the hub with moments about another point of the shaft's axis.

        Loads that are to act on a scene are moved by `fe_drivetrain.shafts.response.entering`.

        Parameters
        ----------
        start, stop : float
            x of the point that they are about, and of the other [m].

        Returns
        -------
        LoadHistory
            About the other point; where both differ, its "channels" say that it was moved.
        """
        if start == stop:
            return replace(self, about=stop)
        loads = PointLoads(self.loads, start).moved(stop).values
        read = self.attributes.get("channels", "as in the file")
        channels = f"{read}; moments about x = {start:g} m moved to x = {stop:g} m"
        attributes = {**self.attributes, "channels": channels}
        return replace(self, loads=loads, attributes=attributes, about=stop)

    def plot(self) -> Any:
        """Forces and moments over time, as a Plotly figure; see `fe_drivetrain.plots.load_lines`.

        Returns
        -------
        plotly.graph_objects.Figure
        """
        return load_lines(self.time, self.loads, self.name)


def require_sound(
    source: str,
    time: Floats,
    columns: Mapping[str, Floats],
    rows: Sequence[int] | None = None,
    even: bool = True,
) -> None:
    """Raise InputError at the first NaN, infinity, backward step or gap, and for too few samples.

    Parameters
    ----------
    source : str
        The file, for messages.
    time : ndarray, (n,)
        [s].
    columns : mapping
        Values (n,) by name.
    rows : sequence of int, (n,)
        Line of each sample in a text file; without it samples are counted from 1.
    even : bool
        Whether steps that differ and gaps are refused, too.
    """

    def at(i: int) -> str:
        place = f"line {rows[i]}" if rows is not None else f"sample {i + 1}"
        return f"{place} (t = {time[i]:g} s)"

    if time.size < MIN_SAMPLES:
        raise InputError(
            f"{source}: {time.size} sample{'s' * (time.size != 1)}, fewer than the {MIN_SAMPLES} "
            "that statistics and steps of time need; give a longer history"
        )
    for name, values in {"time": time, **columns}.items():
        bad = np.flatnonzero(~np.isfinite(values))
        if bad.size:
            raise InputError(
                f"{source}: {name} is {values[bad[0]]} at {at(bad[0])}, one of {bad.size} such "
                "samples; a finite number is needed, so repair it or cut the history there"
            )
    for name, values in columns.items():
        huge = np.flatnonzero(np.abs(values) > MAX_LOAD)
        if huge.size:
            raise InputError(
                f"{source}: {name} is {values[huge[0]]:.3g} N or N m at {at(huge[0])}; a load must "
                f"be at most {MAX_LOAD:.0e}, so check the unit in the column's heading"
            )
    with np.errstate(over="ignore"):
        steps = np.diff(time)
        median = float(np.median(steps))
    back = np.flatnonzero(steps <= 0.0)
    if back.size:
        raise InputError(
            f"{source}: time does not increase after {at(back[0])}, the next is "
            f"{time[back[0] + 1]:g} s; sort the samples and remove repeated ones, or write time "
            "with more digits"
        )
    if not SHORTEST_STEP <= median <= LONGEST_STEP:
        raise InputError(
            f"{source}: the time step is {median:g} s but must be from {SHORTEST_STEP:g} to "
            f"{LONGEST_STEP:g} s: check the unit of time"
        )
    uneven = np.flatnonzero(np.abs(steps - median) > STEP_TOLERANCE * median)
    if even and uneven.size:
        i = uneven[0]
        raise InputError(
            f"{source}: the time step after {at(i)} is {steps[i]:g} s where the others are "
            f"{median:g} s (allowed: within {STEP_TOLERANCE:.0%}); samples are missing or the step "
            "changes, so resample to one step or cut the history there"
        )


def require_all_loads(history: LoadHistory) -> None:
    """Raise InputError where a history lacks components, so that it cannot act on a scene.

    Parameters
    ----------
    history : LoadHistory
        The history.
    """
    if history.absent:
        there = [name for name in FORCES if name not in history.absent]
        raise InputError(
            f"hub loads: {history.name} has {', '.join(there)}, and {', '.join(history.absent)} "
            f"are not known rather than zero: {NEED_ALL}"
        )
    if history.torque_of:
        raise InputError(
            f"hub loads: {history.name} has the torque of the {history.torque_of}, not the "
            "rotor's: give gearbox_ratio in a mapping"
        )


def require_even(history: LoadHistory) -> None:
    """Raise InputError where the samples of a measured history have uneven steps or gaps.

    Parameters
    ----------
    history : LoadHistory
        The history.
    """
    if history.measured:
        columns = dict(zip(FORCES, history.loads.T, strict=True))
        known = {n: c for n, c in columns.items() if n not in history.absent}
        require_sound(f"hub loads: {history.name}", history.time, known)


def require_variation(source: str, loads: Floats) -> None:
    """Raise InputError where all samples are one load but for rounding, and that is not zero."""
    largest = np.abs(loads).max(axis=0)
    if largest.any() and (np.ptp(loads, axis=0) <= CONSTANT * largest).all():
        raise InputError(
            f"{source}: all {len(loads)} samples are the same load, so that a correlation of "
            "two models is undefined; give a history whose loads vary"
        )


def _frozen(values: ArrayLike) -> Floats:
    array = np.array(values, dtype=np.float64)
    array.setflags(write=False)
    return array
