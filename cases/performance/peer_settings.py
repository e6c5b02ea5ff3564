"""What the comparison with other tools may be given by ``--set``, and its plan."""

from typing import Any

from fe_drivetrain.cases.performance.peers import (
    BENCHMARKS,
    MAX_MOTIONS,
    TOOLS,
    Limits,
    Plan,
    parse,
)
from fe_drivetrain.common import InputError
from fe_drivetrain.report.suite import Run

OURS = "this_project"

SIZES = (10_000, 50_000, 110_000, 300_000, 1_000_000)
QUICK_SIZES = (10_000,)
DEFAULT_TOOLS = (
    OURS,
    "scikit_fem.superlu",
    "scikit_fem.pyamg",
    "scikit_fem.mumps",
    "scikit_fem.cholmod",
    "calculix",
    "ngsolve",
    "sfepy.pardiso",
    "felupe.pardiso",
    "felupe.pardiso_own",
    "dolfinx",
    "mfem",
    "kratos",
    "fedoo",
    "torch_fem",
)
"""With the solvers that serve each tool best; the others by ``--set tools=[...]``."""

DEFAULTS: dict[str, Any] = {
    "tools": list(DEFAULT_TOOLS),
    "problems": ["shaft", "assembly"],
    "sizes": list(SIZES),
    "repetitions": 5,
    "time_limit": 30.0,
    "memory_limit": 12.0,
    "threads": 2,
    "right_hand_sides": 1,
}

QUICK: dict[str, Any] = {
    "tools": [f"{OURS}.auto", "scikit_fem.superlu"],
    "problems": ["shaft"],
    "sizes": list(QUICK_SIZES),
    "repetitions": 1,
}

#: Of a number: its range, and whether it is a whole one.
RANGES = {
    "repetitions": (1, 100, True),
    "time_limit": (1.0, 86400.0, False),
    "memory_limit": (0.5, 4096.0, False),
    "threads": (1, 256, True),
    "right_hand_sides": (1, MAX_MOTIONS, True),
}


def settings_of(run: Run) -> dict[str, Any]:
    """The user's settings on top of the defaults.

    Raises
    ------
    InputError
        A setting is out of its range.
    """
    quick = QUICK if run.quick else {}
    settings = DEFAULTS | quick | dict(run.settings)
    settings["tools"] = _listed("tools", settings["tools"])
    try:
        parse(list(map(str, settings["tools"])))
    except KeyError as error:
        raise InputError(
            f"tools: {error.args[0]!r} is unknown: use some of {', '.join(TOOLS)}, all solvers of "
            "a tool, or one as in ngsolve.multigrid"
        ) from error
    settings["problems"] = problems_of(settings["problems"])
    settings["sizes"] = sizes_of(settings["sizes"])
    for key, (low, high, whole) in RANGES.items():
        value = settings[key]
        kind = int if whole else int | float
        if isinstance(value, bool) or not isinstance(value, kind) or not low <= value <= high:
            raise InputError(
                f"{key} = {value!r} must be a {'whole ' if whole else ''}number from {low:g} to "
                f"{high:g}"
            )
    return settings


def _listed(key: str, value: Any) -> list[Any]:
    found = list(value) if isinstance(value, list | tuple) else [value]
    if not found:
        raise InputError(f"{key} is empty: name at least one")
    return found


def problems_of(value: Any) -> list[str]:
    """Names of benchmarks.

    Raises
    ------
    InputError
        One is unknown, or there is none.
    """
    names = _listed("problems", value)
    for name in names:
        if name not in BENCHMARKS:
            raise InputError(f"problems: {name!r} is unknown: use some of {', '.join(BENCHMARKS)}")
    return names


def sizes_of(value: Any) -> list[int]:
    """Numbers of unknowns, each once, ascending.

    Raises
    ------
    InputError
        One is no whole number in their range, or there is none.
    """
    sizes = _listed("sizes", value)
    for size in sizes:
        number = isinstance(size, int | float) and not isinstance(size, bool)
        if not number or not 1000 <= size <= 5_000_000 or size != int(size):
            raise InputError(f"sizes: {size!r} must be a whole number from 1000 to 5000000")
    return sorted({int(size) for size in sizes})


def plan_of(settings: dict[str, Any]) -> Plan:
    """Repetitions and limits."""
    limits = Limits(
        float(settings["time_limit"]), settings["memory_limit"] * 2.0**30, settings["threads"]
    )
    return Plan(settings["repetitions"], limits)
