"""Options of ``compare``, and how those that make it a search are run."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any

import typer

from fe_drivetrain.command_line.names import complete_scene
from fe_drivetrain.command_line.options import RotorSpeed, Scheduler
from fe_drivetrain.command_line.settings import (
    Loads,
    SceneSettings,
    Tolerance,
    parse_loads,
    parse_settings,
    parse_tolerance,
    refuse_again,
)
from fe_drivetrain.command_line.showing import Shown
from fe_drivetrain.command_line.studies import OutFolder, loads_of_drivetrain, run_on_scene
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.named_scenes import read_drivetrain

if TYPE_CHECKING:
    from fe_drivetrain.studies.design_request import DesignRequest

Minimise = Annotated[
    str | None,
    typer.Option(
        "--minimise",
        metavar="NAME",
        help="Search for the design that is least in this: mass, cost, deflection, or the name of "
        "another quantity. Values of --vary may then be ranges, as in 0.2:0.4.",
    ),
]
Limits = Annotated[
    list[str] | None,
    typer.Option(
        "--limit",
        metavar="LIMIT",
        help="A limit that the design must keep, in quotes: 'life>=20 years', 'pressure<=1.5 GPa', "
        "'tilt<=0.5 mrad', 'stress<=100 MPa', 'deflection<=1 mm', 'frequency>=2 Hz', 'mass<=9 t', "
        "or with a name of --quantity. May be repeated.",
    ),
]
Prices = Annotated[
    list[str] | None,
    typer.Option(
        "--price",
        metavar="PART=VALUE",
        help="Price of a kilogram of a part for --minimise cost, as in shaft=4.5 or housing=2. May "
        "be repeated.",
    ),
]
Front = Annotated[
    str | None,
    typer.Option(
        "--front",
        metavar="NAME",
        help="The limit over whose values the least result is shown, as in life. Default: the "
        "limit that costs most.",
    ),
]
Starts = Annotated[
    int | None,
    typer.Option(
        "--starts",
        metavar="COUNT",
        min=1,
        help="Number of designs that the search starts from. Default: 4.",
    ),
]
SearchLoads = Annotated[
    list[str] | None,
    typer.Option(
        "--loads",
        metavar="FILES",
        help="Hub loads for lives, as in `life`. Default: --load.",
    ),
]
SearchEvery = Annotated[
    int | None,
    typer.Option(
        "--every", metavar="COUNT", min=1, help="Use every n-th sample of --loads. Default: 1."
    ),
]


@dataclass(frozen=True)
class CompareRequest:
    """Arguments and options of ``compare`` as typed; each help text says what one is."""

    scenes: Annotated[
        list[str],
        typer.Argument(
            metavar="SCENE...",
            autocompletion=complete_scene,
            help="Scene files, or names of the library: the others are compared with the first.",
        ),
    ]
    vary: Annotated[
        list[str] | None,
        typer.Option(
            "--vary",
            metavar="KEY=VALUES",
            help="Compare one scene over values of a parameter: a list, as in "
            "shaft.sections.0.inner_diameter=0.2,0.3,0.4, or a range and a number of values, as in "
            "0.2:0.4:5. With --minimise a range, as in 0.2:0.4, or a list, each value of which is "
            "tried; may then be repeated.",
        ),
    ] = None
    quantity: Annotated[
        list[str] | None,
        typer.Option(
            "--quantity",
            metavar="NAME",
            help="What is compared: a reaction, as in main_bearing.My, or a stiffness, "
            "hub.stiffness.ux to hub.stiffness.rz; or what turns, as in modes.torsional.1. May be "
            "repeated. Default: all reactions and stiffnesses.",
        ),
    ] = None
    minimise: Minimise = None
    limit: Limits = None
    price: Prices = None
    front: Front = None
    starts: Starts = None
    loads: SearchLoads = None
    every: SearchEvery = None
    rotor_speed: RotorSpeed = None
    tolerance: Tolerance = "5%"
    load: Loads = None
    scheduler: Scheduler = None
    out: OutFolder = None
    set_: SceneSettings = None


def refuse_without_search(asked: CompareRequest) -> None:
    """Refuse options of a search where nothing shall be least.

    Parameters
    ----------
    asked : CompareRequest
        What was typed.

    Raises
    ------
    InputError
        There is one.
    """
    given = {
        "--limit": asked.limit,
        "--price": asked.price,
        "--front": asked.front,
        "--starts": asked.starts,
        "--loads": asked.loads,
        "--every": asked.every,
        "--rotor-speed": asked.rotor_speed,
    }
    for option, value in given.items():
        if value:
            raise InputError(
                f"{option} is for a search: name what to minimise, as in --minimise mass"
            )


def run_search(asked: CompareRequest) -> int:
    """Search for the best design, and print it; the exit status.

    Parameters
    ----------
    asked : CompareRequest
        What was typed.

    Raises
    ------
    InputError
        An option is wrong, or limits conflict.
    """
    if len(asked.scenes) > 1:
        raise InputError("--minimise searches one scene: give one")
    if asked.quantity:
        raise InputError(
            "--quantity is for a comparison: with --minimise name quantities in --limit"
        )
    scene = asked.scenes[0]
    drivetrain = read_drivetrain(scene, parse_settings(asked.set_ or ()))
    load = parse_loads(asked.load or (), loads_of_drivetrain(drivetrain))
    request = _request(asked, load or {})
    request.check(drivetrain)
    share = parse_tolerance(asked.tolerance)
    from fe_drivetrain.pages.search import show_search
    from fe_drivetrain.studies.design_search import STARTS, search

    starts = STARTS if asked.starts is None else asked.starts
    return run_on_scene(
        "compare",
        [scene],
        f"{scene}: the design with the least {request.minimise}",
        asked.out,
        Shown(
            lambda run: search(drivetrain, request, share, starts, asked.front, report=run.report),
            show_search,
        ),
        scheduler=asked.scheduler,
    )


def _request(asked: CompareRequest, load: Mapping[str, float]) -> DesignRequest:
    from fe_drivetrain.studies.design_request import DesignRequest, parse_limit
    from fe_drivetrain.studies.life_options import LifeOptions

    vary: dict[str, tuple[Any, ...]] = {}
    lists = set()
    for text in asked.vary or ():
        key, values, is_list = parse_range(text)
        refuse_again("--vary", key, vary)
        vary[key] = values
        lists |= {key} if is_list else set()
    prices = parse_settings(asked.price or (), "--price")
    for part, price in prices.items():
        if isinstance(price, bool) or not isinstance(price, int | float) or not 0 <= price < 1e15:
            raise InputError(f"--price {part}: {price!r} must be a number from 0 on")
    assert asked.minimise is not None
    return DesignRequest(
        vary,
        asked.minimise,
        tuple(map(parse_limit, asked.limit or ())),
        frozenset(lists),
        prices={part: float(price) for part, price in prices.items()},
        load=load,
        hub_loads=asked.loads or None,
        life=LifeOptions(rotor_speed_rpm=asked.rotor_speed, every=asked.every or 1),
    )


def parse_range(text: str) -> tuple[str, tuple[Any, ...], bool]:
    """What may vary from ``--vary KEY=FROM:TO``, ``KEY=FROM:TO:COUNT`` or ``KEY=V1,V2,...``.

    Parameters
    ----------
    text : str
        What the user wrote.

    Returns
    -------
    key : str
        Dotted key.
    values : tuple
        Both ends of a range, or values of a list: numbers, or words.
    is_list : bool
        Whether it is a list.

    Raises
    ------
    InputError
        It is none of these.
    """
    import numpy as np

    key, _, given = (part.strip() for part in text.partition("="))
    shape = (
        "write a range as in --vary shaft.front=-1.2:-0.8, or a list as in "
        "--vary bearing_units.0.catalogue=A,B"
    )
    if not key or not given:
        raise InputError(f"--vary {text!r} is no KEY=VALUES: {shape}")
    parts = [part.strip() for part in given.split(":")]
    try:
        if len(parts) == 2:
            low, high = map(float, parts)
            if not (np.isfinite(low) and np.isfinite(high) and low < high):
                raise InputError(
                    f"--vary {key}={given} must go from a lower to a higher number: {shape}"
                )
            return key, (low, high), False
        if len(parts) == 3:
            first, last, count = float(parts[0]), float(parts[1]), int(parts[2])
            return key, tuple(np.linspace(first, last, count).tolist()), True
    except ValueError as error:
        raise InputError(f"--vary {text!r} is no range: {shape}") from error
    values = tuple(_value(part.strip()) for part in given.split(","))
    if len(parts) > 1 or len(set(values)) < len(values) or "" in values:
        raise InputError(f"--vary {text!r} is no list of different values: {shape}")
    return key, values, True


def _value(text: str) -> float | str:
    """A number where it is one, else the word."""
    try:
        return float(text)
    except ValueError:
        return text
