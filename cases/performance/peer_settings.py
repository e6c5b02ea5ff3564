"""What the comparison with other tools may be given by ``--set``, and its plan."""

from typing import Any

from fe_drivetrain.common import InputError
from fe_drivetrain.peers import BENCHMARKS, MOST_MOTIONS, TOOLS, Limits, Plan, parse
from fe_drivetrain.suite import Run

OURS = "this_project"

SIZES = (10_000, 50_000, 110_000, 300_000, 1_000_000)
QUICK_SIZES = (10_000,)
DEFAULT_TOOLS = (
    OURS,
    "scikit_fem.superlu",
    "scikit_fem.pyamg",
    "calculix",
    "ngsolve",
    "sfepy.pardiso",
    "felupe.pardiso",
    "felupe.pardiso_own",
    "dolfinx",
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
    "right_hand_sides": (1, MOST_MOTIONS, True),
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
    for key in ("tools", "problems", "sizes"):
        value = settings[key]
        settings[key] = list(value) if isinstance(value, list | tuple) else [value]
        if not settings[key]:
            raise InputError(f"{key} is empty: name at least one")
    try:
        parse(list(map(str, settings["tools"])))
    except KeyError as error:
        raise InputError(
            f"tools: {error.args[0]!r} is unknown: use some of {', '.join(TOOLS)}, all solvers of "
            "a tool, or one as in ngsolve.multigrid"
        ) from error
    for name in settings["problems"]:
        if name not in BENCHMARKS:
            raise InputError(f"problems: {name!r} is unknown: use some of {', '.join(BENCHMARKS)}")
    for size in settings["sizes"]:
        if isinstance(size, bool) or not isinstance(size, int) or not 1000 <= size <= 5_000_000:
            raise InputError(f"sizes: {size!r} must be a whole number from 1000 to 5000000")
    settings["sizes"] = sorted(set(settings["sizes"]))
    for key, (low, high, whole) in RANGES.items():
        value = settings[key]
        kind = int if whole else int | float
        if isinstance(value, bool) or not isinstance(value, kind) or not low <= value <= high:
            raise InputError(
                f"{key} = {value!r} must be a {'whole ' if whole else ''}number from {low:g} to "
                f"{high:g}"
            )
    return settings


def plan_of(settings: dict[str, Any]) -> Plan:
    """Repetitions and limits."""
    limits = Limits(
        float(settings["time_limit"]), settings["memory_limit"] * 2.0**30, settings["threads"]
    )
    return Plan(settings["repetitions"], limits)
