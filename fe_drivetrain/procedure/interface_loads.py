"""Loads at the interfaces of a drivetrain over time, in equilibrium with one another in every row.

The table of PROTEST 2010 (Table 4.5): six loads, displacements and accelerations at each interface,
where they come from, and what is made of them. An interface stands between two bodies; the loads on
a body from all of its interfaces, its weight and its inertia add up to nothing, which is checked.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import FORCES, MOTIONS
from fe_drivetrain.common.csv_cells import SafeWriter
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.files import atomic_path
from fe_drivetrain.common.plain_json import plain_json
from fe_drivetrain.common.reading import unreadable
from fe_drivetrain.common.regular_files import text_of
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.common.spatial import wrench_transport
from fe_drivetrain.turbine_loads.histories.cycles import Cycles, rainflow_cycles
from fe_drivetrain.turbine_loads.histories.damage import damage_equivalent_load
from fe_drivetrain.turbine_loads.histories.levels import even_levels, time_at_level

Source = Literal["measured", "simulated", "estimated"]
GROUND = "ground"
"""What is outside of all bodies: rotor, frame, grid."""

_UNITS = ("N", "N", "N", "N m", "N m", "N m")
_ACCELERATIONS = ("ax", "ay", "az", "alpha_x", "alpha_y", "alpha_z")


@dataclass(frozen=True, eq=False)
class Interface:
    """Where one body loads another.

    Attributes
    ----------
    name : str
        Unique in a table.
    of, on : str
        Body, or `GROUND`, that gives the loads, and body that takes them; it takes them reversed
        the other way.
    position : ndarray, (3,)
        Place of the loads [m].
    loads : ndarray, (n, 6)
        Forces [N] and moments [N m] on `on`.
    displacements, accelerations : ndarray, (n, 6), optional
        Motion of the interface [m, rad], [m/s^2, rad/s^2].
    source : str
        "measured", "simulated", "estimated".
    """

    name: str
    of: str
    on: str
    position: Floats
    loads: Floats
    displacements: Floats | None = None
    accelerations: Floats | None = None
    source: Source = "simulated"

    __repr__ = short_repr


@dataclass(frozen=True, eq=False)
class Body:
    """A body between interfaces.

    Attributes
    ----------
    name : str
        Unique in a table.
    centre : ndarray, (3,)
        Centre of mass [m].
    own : ndarray, (6,) or (n, 6)
        Weight and inertia, mass times gravity less acceleration, about the centre [N, N m].
    """

    name: str
    centre: Floats
    own: Floats

    __repr__ = short_repr


@dataclass(frozen=True, eq=False)
class LoadTable:
    """Loads at interfaces over time.

    Attributes
    ----------
    time : ndarray, (n,)
        Times of uniform step [s].
    interfaces : tuple of Interface
    bodies : tuple of Body

    Raises
    ------
    InputError
        A name is used twice, a body unknown, or an array of another length.
    """

    time: Floats
    interfaces: tuple[Interface, ...]
    bodies: tuple[Body, ...]

    __repr__ = short_repr

    def __post_init__(self) -> None:
        names = [*(i.name for i in self.interfaces), *(b.name for b in self.bodies)]
        for name in names:
            if names.count(name) > 1:
                raise InputError(f"two parts of a load table are called {name!r}: rename one")
        known = {GROUND, *(body.name for body in self.bodies)}
        for part in self.interfaces:
            for body in (part.of, part.on):
                if body not in known:
                    raise InputError(
                        f"interface {part.name!r} is at {body!r}, which is no body: use one of "
                        f"{', '.join(sorted(known))}"
                    )
            for values in (part.loads, part.displacements, part.accelerations):
                if values is not None and np.shape(values) != (len(self.time), 6):
                    raise InputError(
                        f"interface {part.name!r} has an array of shape {np.shape(values)}: give "
                        f"{len(self.time)} rows, one for each time, of six"
                    )

    def interface(self, name: str) -> Interface:
        """The interface of a name.

        Parameters
        ----------
        name : str
            Name of an interface.

        Raises
        ------
        InputError
            There is none.
        """
        for part in self.interfaces:
            if part.name == name:
                return part
        raise InputError(
            f"no interface {name!r}: use one of {', '.join(i.name for i in self.interfaces)}"
        )


def imbalance(table: LoadTable, body: str) -> Floats:
    """What is missing to the equilibrium of a body in each row, over the largest load on it.

    Parameters
    ----------
    table : LoadTable
        All interfaces of the body.
    body : str
        Its name.

    Returns
    -------
    ndarray, (n, 6)
        Forces over the largest force, moments over the largest moment about the body's centre, of
        any row.

    Raises
    ------
    InputError
        There is no such body.
    """
    found = next((b for b in table.bodies if b.name == body), None)
    if found is None:
        raise InputError(f"no body {body!r}: use one of {', '.join(b.name for b in table.bodies)}")
    loads = [np.broadcast_to(found.own, (len(table.time), 6))]
    for part in table.interfaces:
        sign = (part.on == body) - (part.of == body)
        if sign:
            arm = np.asarray(part.position) - found.centre
            loads.append(sign * part.loads @ wrench_transport(arm).T)
    size = np.abs(loads).max(axis=(0, 1))
    scale = np.repeat([size[:3].max(), size[3:].max()], 3)
    return np.asarray(np.sum(loads, axis=0) / np.where(scale > 0.0, scale, 1.0))


def check_equilibrium(table: LoadTable, within: float = 1e-9) -> None:
    """Refuse a table in which a body is not in equilibrium in some row.

    Parameters
    ----------
    table : LoadTable
        To be checked.
    within : float
        Allowed of `imbalance`: rounding of simulated loads, 0.05 of measured ones.

    Raises
    ------
    InputError
        Names the body, the time and the component.
    """
    for body in table.bodies:
        error = np.abs(imbalance(table, body.name))
        if error.max() > within:
            row, column = np.unravel_index(int(error.argmax()), error.shape)
            raise InputError(
                f"{body.name!r} is not in equilibrium: at {table.time[row]:g} s {FORCES[column]} "
                f"has an error of {error[row, column]:.2g} of the largest load, but {within:g} is "
                "allowed: give all interfaces, weight and inertia of it, with their signs"
            )


def analysed(table: LoadTable, slopes: Sequence[float] = (4.0, 10.0)) -> list[dict[str, Any]]:
    """Mean, extremes and fatigue of each load, displacement and acceleration at each interface.

    Parameters
    ----------
    table : LoadTable
        Table of uniform step.
    slopes : sequence of float
        Exponents of damage-equivalent loads at 1 Hz.

    Returns
    -------
    list of dict
        Interface, component, unit, source, mean, least, largest, a damage-equivalent value for each
        slope, the duration distribution (limits and seconds of 20 levels), and rainflow cycles
        (limits of 20 ranges, and how many).
    """
    step = float(table.time[1] - table.time[0])
    rows = []
    for part in table.interfaces:
        for component, unit, signal in _signals(part):
            levels = time_at_level(
                signal, step, even_levels(float(signal.min()), float(signal.max()), 20)
            )
            cycles = [rainflow_cycles(signal)]
            rows.append(
                {
                    "interface": part.name,
                    "component": component,
                    "unit": unit,
                    "source": part.source,
                    "mean": float(signal.mean()),
                    "least": float(signal.min()),
                    "largest": float(signal.max()),
                    **{
                        f"equivalent, m {slope:g}": damage_equivalent_load(
                            cycles, len(signal) * step, slope
                        )
                        for slope in slopes
                    },
                    "levels": levels.edges.tolist(),
                    "seconds": levels.amount.tolist(),
                    **_cycles(cycles[0]),
                }
            )
    return rows


def _signals(part: Interface) -> list[tuple[str, str, Floats]]:
    """Component, unit and (n,) samples of all that an interface has."""
    found = []
    for names, units, values in (
        (FORCES, _UNITS, part.loads),
        (MOTIONS, ("m",) * 3 + ("rad",) * 3, part.displacements),
        (_ACCELERATIONS, ("m/s^2",) * 3 + ("rad/s^2",) * 3, part.accelerations),
    ):
        if values is not None:
            found += list(zip(names, units, np.asarray(values).T, strict=True))
    return found


def _cycles(cycles: Cycles) -> dict[str, list[float]]:
    """Rainflow cycles in 20 even classes of their range."""
    largest = float(cycles.ranges.max(initial=0.0))
    counts, limits = np.histogram(
        cycles.ranges, bins=20, range=(0.0, largest or 1.0), weights=cycles.counts
    )
    return {"ranges": limits.tolist(), "cycles": counts.tolist()}


def write_load_csv(table: LoadTable, path: str | Path) -> None:
    """Write time and all loads and motions, a column each, as "gearbox entrance Fx [N]".

    Displacements are "hub ux [m]" to "hub rz [rad]", accelerations "hub ax [m/s^2]" to
    "hub alpha_z [rad/s^2]".

    Parameters
    ----------
    table : LoadTable
        With loads of any source.
    path : str or Path
        File, which appears whole.
    """
    signals = [(part.name, *signal) for part in table.interfaces for signal in _signals(part)]
    heads = [f"{name} {component} [{unit}]" for name, component, unit, _ in signals]
    columns = np.column_stack([table.time, *(values for *_, values in signals)])
    with atomic_path(Path(path)) as hidden, hidden.open("w", newline="") as file:
        writer = SafeWriter(file)
        writer.writerow(["time [s]", *heads])
        writer.writerows([[repr(float(value)) for value in row] for row in columns])


def write_load_json(table: LoadTable, path: str | Path) -> None:
    """Write all of a table, with its analysis.

    Parameters
    ----------
    table : LoadTable
        Table of uniform step.
    path : str or Path
        File, which appears whole.
    """
    content = {
        "time [s]": table.time.tolist(),
        "components": list(FORCES),
        "units": list(_UNITS),
        "interfaces": [
            {
                "name": part.name,
                "of": part.of,
                "on": part.on,
                "source": part.source,
                "position": np.asarray(part.position).tolist(),
                **{
                    key: None if values is None else np.asarray(values).tolist()
                    for key, values in (
                        ("loads", part.loads),
                        ("displacements", part.displacements),
                        ("accelerations", part.accelerations),
                    )
                },
            }
            for part in table.interfaces
        ],
        "bodies": [
            {
                "name": body.name,
                "centre": np.asarray(body.centre).tolist(),
                "own": np.asarray(body.own).tolist(),
            }
            for body in table.bodies
        ],
        "analysis": analysed(table),
    }
    with atomic_path(Path(path)) as hidden:
        hidden.write_text(json.dumps(content), encoding="utf-8")


def read_load_json(path: str | Path) -> LoadTable:
    """Read what `write_load_json` wrote, the same to the last digit.

    Parameters
    ----------
    path : str or Path
        The file.

    Returns
    -------
    LoadTable

    Raises
    ------
    InputError
        The file cannot be read, or does not hold such a table.
    """
    try:
        text = text_of(path)
    except (OSError, ValueError) as error:
        raise unreadable(path, "a load table from", error) from error
    try:
        content = plain_json(text)
        interfaces = tuple(
            Interface(
                row["name"],
                row["of"],
                row["on"],
                np.array(row["position"], dtype=np.float64),
                np.array(row["loads"], dtype=np.float64),
                _optional(row["displacements"]),
                _optional(row["accelerations"]),
                source=row["source"],
            )
            for row in content["interfaces"]
        )
        bodies = tuple(
            Body(
                row["name"],
                np.array(row["centre"], dtype=np.float64),
                np.array(row["own"], dtype=np.float64),
            )
            for row in content["bodies"]
        )
        time = np.array(content["time [s]"], dtype=np.float64)
    except (ValueError, KeyError, TypeError) as error:
        raise InputError(
            f"cannot read a load table from {path} ({error!r}): give a file that write_load_json "
            "wrote"
        ) from error
    return LoadTable(time, interfaces, bodies)


def _optional(values: Any) -> Floats | None:
    return None if values is None else np.array(values, dtype=np.float64)
