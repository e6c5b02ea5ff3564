"""Al-Hamadani 2018: tables of four drivetrains as printed, and what their rounding leaves open.

The inputs stand in drivetrain files beside this module, digit for digit as in Tables 4.2, 4.3 and
4.7; the frequencies of Tables 6.1, 6.2 and 6.4 stand here.
"""

from collections.abc import Callable, Iterator, Mapping
from functools import cache, partial
from importlib.resources import files
from typing import Any

import numpy as np
import yaml

from fe_drivetrain.common import Floats, Ints
from fe_drivetrain.comparison.tolerances import digit
from fe_drivetrain.drivetrain_file import Drivetrain, parse_drivetrain
from fe_drivetrain.dynamics import gear_table
from fe_drivetrain.dynamics.torsion import (
    GearTable,
    GeneratorState,
    Modes,
    ParallelStage,
    PlanetaryStage,
    Torsional,
    natural_modes,
)

TABLE_6_1 = "Al-Hamadani 2018, Table 6.1"
TABLE_6_2 = "Al-Hamadani 2018, Table 6.2"
TABLE_6_4 = "Al-Hamadani 2018, Table 6.4"

#: Table 4.1: name of each drivetrain's table, power [W] and rated speed [rpm].
RATED = {
    "D": ("nrel_750kw", 750e3, 18.6),
    "A": ("drivetrain_a", 3e6, 14.8),
    "B": ("drivetrain_b", 3e6, 16.1),
    "C": ("drivetrain_c", 2e6, 16.0),
}

#: Table 6.1 [Hz], as printed: generator's speed constant (its spring on), then variable (off).
TWO = {"fixed": ("0.864", "5.888"), "free": ("0", "2.524")}
FIVE = {
    "fixed": ("0.864", "5.889", "312", "402", "1974"),
    "free": ("0", "2.524", "312", "402", "1974"),
}
ELEVEN = {
    "fixed": ("0.841", "5.859", "154", "307", "353", "748", "1020", "1530", "4398"),
    "free": ("0", "2.44", "154", "307", "353", "748", "1020", "1530", "4397"),
}
STATES: tuple[GeneratorState, GeneratorState] = ("fixed", "free")

#: Measured, in Table 6.1 after Mandic et al. 2012 (constant) and Girsang et al. 2014 (variable).
MEASURED = {"fixed": 0.806, "free": 2.32}

#: Table 6.2: the two masses [rad/s], the five [Hz], and what section 6.1.2 says of the first
#: frequency of five masses with variable speed [Hz].
OTHER_TWO = ("5.1951", "38.2748")
OTHER_FIVE = ("0.826", "6.092", "291.987", "371.528", "1974.245")
OTHER_FREE = "2.957"
#: Table 6.2's other column, Mandic et al. 2012, in the same units.
MANDIC_TWO = ("5.1972", "38.2818")
MANDIC_FIVE = ("0.83", "6.09", "291.8", "371.3", "1974")

#: Table 6.4 [Hz].
OTHERS = {
    "A": ("0", "9.049", "111.9", "352.8", "766.2", "1086", "2246", "3902"),
    "B": (
        "0",
        "4.54",
        "58.21",
        "190.74",
        "308.70",
        "538.61",
        "666.46",
        "1597.35",
        "2552.25",
        "2733.50",
    ),
    "C": ("0", "2.37", "213", "257", "431", "834", "1720", "2110", "3750"),
}
#: Section 6.2.3: peaks of the torque's spectrum in a simulated shutdown [Hz].
SHUTDOWN = {"A": 9.1, "B": 4.664, "C": 2.503}

#: What is counted is exact.
_EXACT = {"teeth", "planets"}
#: Keys of shafts and of the mesh of a parallel stage in a table, by those of a file.
OF_SHAFTS, OF_MESHES = {"torsion": "stiffness"}, {"stiffness": "mesh", "damping": "mesh_damping"}


def text_of(name: str) -> str:
    """The text of a drivetrain's file, digit for digit as printed.

    Parameters
    ----------
    name : str
        "nrel_750kw", "drivetrain_a", "drivetrain_b" or "drivetrain_c".
    """
    return (files("fe_drivetrain.cases.references") / f"{name}.yaml").read_text("utf-8")


@cache
def drivetrain(name: str) -> Drivetrain:
    """One of the drivetrains; `name` as in `text_of`."""
    return parse_drivetrain(text_of(name), source=name)


@cache
def table(name: str) -> GearTable:
    """One of the drivetrains in torsion, as its table has it; `name` as in `text_of`."""
    return gear_table(drivetrain(name))


def nrel_stages(table: GearTable) -> tuple[PlanetaryStage, ParallelStage, ParallelStage]:
    """The three stages of drivetrain D, the NREL 750 kW.

    Raises
    ------
    TypeError
        The table is of another drivetrain.
    """
    one, two, three = table.stages
    if not (
        isinstance(one, PlanetaryStage)
        and isinstance(two, ParallelStage)
        and isinstance(three, ParallelStage)
    ):
        raise TypeError("drivetrain D has a planetary stage and two parallel ones")
    return one, two, three


def with_values(table: GearTable, values: Mapping[str, float]) -> GearTable:
    """The table with other values, by dotted key such as "stages.0.carrier"."""
    data = table.model_dump(exclude_none=True)
    for key, value in values.items():
        *path, last = key.split(".")
        target: Any = data
        for part in path:
            target = target[int(part)] if part.isdecimal() else target[part]
        target[last] = value
    return GearTable.model_validate(data)


def printed_inputs(name: str) -> Iterator[tuple[str, str]]:
    """Dotted key in a table, and digits as printed, of all inputs that are measured or computed."""
    # the base loader leaves numbers the words that they are in the file
    for key, digits in _numbers(yaml.load(text_of(name), Loader=yaml.BaseLoader), ""):
        yield _key_in_table(key), digits


def _key_in_table(key: str) -> str:
    """Key of a `GearTable` of a file's key, as "stages.0.carrier" of its carrier's inertia."""
    match key.split("."):
        case ["rotor", "inertia"]:
            return "rotor"
        case ["shaft", last]:
            return f"shafts.0.{OF_SHAFTS.get(last, last)}"
        case ["gearbox", "shafts", number, last]:
            return f"shafts.{int(number) + 1}.{OF_SHAFTS.get(last, last)}"
        case ["gearbox", "stages", number, body, "inertia"]:
            return f"stages.{number}.{body}"
        case ["gearbox", "stages", number, last]:
            return f"stages.{number}.{OF_MESHES.get(last, last)}"
    return key


def _numbers(data: Any, key: str) -> Iterator[tuple[str, str]]:
    if isinstance(data, dict | list):
        for name, value in data.items() if isinstance(data, dict) else enumerate(data):
            if name not in _EXACT:
                yield from _numbers(value, f"{key}.{name}".removeprefix("."))
    elif data[:1].isdecimal():
        yield key, data


def rounding_bands(name: str, model: Callable[..., Torsional]) -> dict[GeneratorState, Floats]:
    """Bands as those of `rounding_band`, by state of the generator."""
    return {state: rounding_band(name, partial(model, generator=state)) for state in STATES}


def rounding_band(
    name: str,
    model: Callable[[GearTable], Torsional],
    base: GearTable | None = None,
    without: frozenset[str] = frozenset(),
) -> Floats:
    """Band of each frequency that the rounding of the printed inputs leaves.

    Parameters
    ----------
    name : str
        Name of the table whose digits count.
    model : callable
        From a table to its masses.
    base : Drivetrain, optional
        The table with some values changed; the printed one where left out.
    without : frozenset of str
        Keys of those values, which have no printed digits any more.

    Returns
    -------
    band : (n,) array
        Half widths [Hz]: every input at its worst within half of its last digit, summed.
    """
    middle = base or table(name)
    band = np.zeros(len(model(middle).inertias))
    for key, printed in printed_inputs(name):
        if key in without or "damping" in key:
            continue
        half = digit(printed) / 2
        pair = [
            natural_modes(model(with_values(middle, {key: float(printed) + step}))).frequencies
            for step in (half, -half)
        ]
        band += np.abs(pair[0] - pair[1]) / 2
    return band


def observable(modes: Modes, least: float = 1e-9) -> Ints:
    """Numbers of the modes that are in Tables 6.1 and 6.4.

    Planets that move against each other, their sum at rest, turn nothing else: the thesis finds
    frequencies from the response of the generator's speed to the rotor's torque, in which these
    modes have no part.

    Parameters
    ----------
    modes : Modes
        Modes of a model with a mass for each gear.
    least : float
        Share of the kinetic energy outside the planets, below which a mode is theirs alone.

    Returns
    -------
    numbers : (m,) array
        From 0, ascending.
    """
    planets = [i for i, name in enumerate(modes.names) if "planet" in name]
    others = np.delete(modes.inertia_shares, planets, axis=0).sum(axis=0)
    return np.flatnonzero(others > least)


#: Diameters of C (Table 3.1) and of the V90, which the thesis cites for 3 MW [m], and C's rated
#: speed of Table 3.1 [rpm].
DIAMETERS, C_SPEED = (80.0, 90.0), 18.1


def scaled_mean(letter: str, diameter: float = DIAMETERS[1]) -> float:
    """Rated torque of C, scaled by Eq 4.40 to another rotor, over the rated torque of that one.

    Parameters
    ----------
    letter : str
        "A" or "B", whose rated torque is that of Table 4.1.
    diameter : float
        Diameter of the other rotor [m].
    """
    _, power, speed = RATED[letter]
    rated = power / (speed * np.pi / 30.0)
    scaled = RATED["C"][1] / (C_SPEED * np.pi / 30.0) * (diameter / DIAMETERS[0]) ** 3
    return float(scaled / rated)
