"""Tables changed at random, as slips of the pen do: numbers, signs, types, keys and rows."""

import copy
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

Path = tuple[str | int, ...]

#: What stands where a number should; the whole number is beyond what a float can be.
JUNK: tuple[Any, ...] = (
    "text",
    "3 m",
    "",
    True,
    False,
    None,
    float("nan"),
    float("inf"),
    -float("inf"),
    [],
    [1.0],
    {},
    {"a": 1},
    10**400,
    1e308,
    5e-324,
)
DECADES = 6


def leaves(data: Any, path: Path = ()) -> list[Path]:
    """Where the values of nested mappings and lists are."""
    if isinstance(data, Mapping):
        items = list(data.items())
    elif isinstance(data, list | tuple):
        items = list(enumerate(data))
    else:
        return [path]
    return [leaf for key, value in items for leaf in leaves(value, (*path, key))]


def value_at(data: Any, path: Path) -> Any:
    """What is at a path."""
    for key in path:
        data = data[key]
    return data


def put(data: Any, path: Path, value: Any) -> None:
    """Replace what is at a path, in place."""
    value_at(data, path[:-1])[path[-1]] = value


def mutated(table: Mapping[str, Any], random: np.random.Generator) -> tuple[dict[str, Any], str]:
    """A table with one or two slips.

    Parameters
    ----------
    table : mapping
        Mappings, lists and values.
    random : numpy.random.Generator
        Where the slips come from.

    Returns
    -------
    data : dict
        The changed table.
    said : str
        What was done.
    """
    data, said = copy.deepcopy(dict(table)), []
    for _ in range(1 + int(random.integers(2))):
        slip = SLIPS[int(random.choice(len(SLIPS), p=WEIGHTS))]
        said.append(slip(data, random))
    return data, "; ".join(said)


def _name(path: Path) -> str:
    return ".".join(str(key) for key in path)


def _number(data: Any, random: np.random.Generator) -> Path:
    """A place where a number is."""
    found = [
        p
        for p in leaves(data)
        if isinstance(value_at(data, p), int | float) and not isinstance(value_at(data, p), bool)
    ]
    return found[int(random.integers(len(found)))]


def _any(data: Any, random: np.random.Generator) -> Path:
    found = leaves(data)
    return found[int(random.integers(len(found)))]


def _replace(data: Any, path: Path, value: Any) -> str:
    put(data, path, value)
    text = "a number of 401 digits" if value == 10**400 else repr(value)
    return f"{_name(path)}: {text}"


def _by_decades(data: Any, random: np.random.Generator) -> str:
    path = _number(data, random)
    return _replace(
        data, path, value_at(data, path) * float(10 ** random.uniform(-DECADES, DECADES))
    )


def _a_little(data: Any, random: np.random.Generator) -> str:
    path = _number(data, random)
    value = value_at(data, path)
    if isinstance(value, int):
        return _replace(data, path, value + int(random.integers(-3, 4)))
    return _replace(data, path, value * float(random.uniform(0.5, 2.0)))


def _sign(data: Any, random: np.random.Generator) -> str:
    path = _number(data, random)
    return _replace(data, path, -value_at(data, path))


def _zero(data: Any, random: np.random.Generator) -> str:
    return _replace(data, _number(data, random), 0)


def _junk(data: Any, random: np.random.Generator) -> str:
    return _replace(data, _any(data, random), JUNK[int(random.integers(len(JUNK)))])


def _swap(data: Any, random: np.random.Generator) -> str:
    one, two = _number(data, random), _number(data, random)
    a, b = value_at(data, one), value_at(data, two)
    put(data, one, b)
    put(data, two, a)
    return f"{_name(one)} and {_name(two)} exchanged"


def _places(data: Any, kind: type, path: Path = ()) -> list[Path]:
    """Where mappings, or lists, are, the table itself left out."""
    if isinstance(data, Mapping):
        items: list[tuple[str | int, Any]] = list(data.items())
    elif isinstance(data, list | tuple):
        items = list(enumerate(data))
    else:
        return []
    own = [path] if path and isinstance(data, kind) else []
    return own + [p for key, value in items for p in _places(value, kind, (*path, key))]


def _without_a_key(data: Any, random: np.random.Generator) -> str:
    places: list[Path] = [(), *_places(data, dict)]
    at = places[int(random.integers(len(places)))]
    row = value_at(data, at)
    keys = list(row)
    if not keys:
        return "nothing"
    key = keys[int(random.integers(len(keys)))]
    del row[key]
    return f"{_name((*at, key))} left out"


def _a_key_more(data: Any, random: np.random.Generator) -> str:
    places: list[Path] = [(), *_places(data, dict)]
    at = places[int(random.integers(len(places)))]
    value_at(data, at)["lenght"] = 1.0
    return f"{_name((*at, 'lenght'))} added"


def _rows(data: Any, random: np.random.Generator) -> str:
    places = [p for p in _places(data, list) if value_at(data, p)]
    at = places[int(random.integers(len(places)))]
    rows = value_at(data, at)
    k = int(random.integers(len(rows)))
    if random.integers(2):
        del rows[k]
        return f"{_name((*at, k))} left out"
    rows.insert(k, copy.deepcopy(rows[k]))
    return f"{_name((*at, k))} twice"


def _teeth(data: Any, random: np.random.Generator) -> str:
    teeth = [p for p in leaves(data) if p[-2:-1] == ("teeth",)]
    if not teeth:
        return _a_little(data, random)
    path = teeth[int(random.integers(len(teeth)))]
    value = value_at(data, path)
    if not isinstance(value, int) or abs(value) > 10**6:
        return _replace(data, path, 17)
    return _replace(data, path, value + int(random.integers(-30, 31)))


#: What is done, and how often: small changes are often, so that many tables are still machines.
SLIPS: tuple[Callable[[Any, np.random.Generator], str], ...] = (
    _a_little,
    _by_decades,
    _sign,
    _zero,
    _junk,
    _swap,
    _without_a_key,
    _a_key_more,
    _rows,
    _teeth,
)
WEIGHTS = np.array([6, 5, 1, 2, 3, 2, 2, 1, 2, 2]) / 26
