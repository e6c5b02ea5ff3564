"""The command ``compare``: designs side by side, over values of a parameter, or searched."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import typer

from fe_drivetrain.command_line.design_options import (
    CompareRequest,
    refuse_without_search,
    run_search,
)
from fe_drivetrain.command_line.options import with_options
from fe_drivetrain.command_line.settings import (
    parse_loads,
    parse_settings,
    parse_tolerance,
)
from fe_drivetrain.command_line.showing import Shown
from fe_drivetrain.command_line.studies import loads_of_drivetrain, run_on_scene
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.threads import hold_threads
from fe_drivetrain.drivetrain_file.named_scenes import read_drivetrain

if TYPE_CHECKING:
    from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
    from fe_drivetrain.shafts.fidelity.quantity import Quantity
    from fe_drivetrain.studies.design_comparison import Varied

#: Most designs of one comparison.
_MAXIMUM = 50


@with_options(CompareRequest)
def compare_command(context: typer.Context, asked: CompareRequest) -> int:
    """Compare designs: what changes, ranked; with --minimise find the best one within limits.

    Each quantity comes from the cheapest level that is enough: its bands in both designs together
    are within the tolerance. Changes that are smaller than their bands may be zero: they are named.

    With --minimise, values of --vary are searched for the design that is least in mass, cost or
    another quantity and keeps each --limit at the level that is enough. A search that was stopped
    continues where it was.

    The exit status is 0 if every change is known within the tolerance, or every limit is kept, and
    1 if not.
    """
    hold_threads()
    if asked.minimise is not None:
        return run_search(asked)
    refuse_without_search(asked)
    scenes = asked.scenes
    changes = parse_settings(asked.set_ or ())
    varied = None if not asked.vary else parse_values(_only(asked.vary))
    designs = _designs(scenes, changes, varied)
    from fe_drivetrain.pages.compare import show_compare
    from fe_drivetrain.studies.design_comparison import compare

    load = parse_loads(asked.load or (), loads_of_drivetrain(next(iter(designs.values()))))
    quantities = _quantities(asked.quantity, designs.values())
    share = parse_tolerance(asked.tolerance)
    title = f"{' against '.join(reversed(scenes))}: what changes"
    if varied is not None:
        title = f"{scenes[0]}: what changes with {varied.key}"
    return run_on_scene(
        "compare",
        scenes,
        title,
        asked.out,
        Shown(
            lambda run: compare(designs, quantities, share, load, varied, report=run.report),
            show_compare,
        ),
        scheduler=asked.scheduler,
    )


def _only(texts: Sequence[str]) -> str:
    """The one parameter that is varied without a search."""
    if len(texts) > 1:
        raise InputError(
            f"--vary is given {len(texts)} times: a comparison is over values of one parameter; "
            "name what to minimise with --minimise to search over several"
        )
    return texts[0]


def _quantities(
    names: Sequence[str] | None, designs: Collection[Drivetrain]
) -> list[Quantity] | None:
    """Quantities of ``--quantity``, which every design must have; None for all."""
    from fe_drivetrain.drivetrain_file.quantity_names import is_turning
    from fe_drivetrain.drivetrain_file.reading import with_sections
    from fe_drivetrain.shafts.fidelity.quantity import Quantity
    from fe_drivetrain.studies.turning_quantities import turning_quantity

    if not names:
        return None
    found = [Quantity(name) for name in names]
    for one in found:
        for design in designs:
            if is_turning(one.name, design):
                turning_quantity(design, one.name)
            else:
                one.check(with_sections(design, design.title))
    return found


def parse_values(text: str) -> Varied:
    """Values of one parameter from ``--vary KEY=V1,V2,...`` or ``KEY=FROM:TO:COUNT``.

    Parameters
    ----------
    text : str
        What the user wrote.

    Raises
    ------
    InputError
        It is neither, has fewer than two values, one twice, or too many.
    """
    import numpy as np

    from fe_drivetrain.studies.design_comparison import Varied

    key, _, given = (part.strip() for part in text.partition("="))
    shape = "write it as in --vary shaft.front=-1.2,-1.0 or --vary shaft.front=-1.2:-0.8:5"
    try:
        if given.count(":") == 2:
            low, high, count = given.split(":")
            values = np.linspace(float(low), float(high), int(count)).tolist()
        else:
            values = [float(part) for part in given.split(",")]
    except ValueError as error:
        raise InputError(f"--vary {text!r} is no KEY=VALUES: {shape}") from error
    if not key or not np.isfinite(values).all():
        raise InputError(f"--vary {text!r} is no KEY=VALUES: {shape}")
    if not 2 <= len(set(values)) == len(values) <= _MAXIMUM:
        raise InputError(
            f"--vary {key} has {len(set(values))} different values but must have 2 to {_MAXIMUM}, "
            f"none of them twice: {shape}"
        )
    return Varied(key, tuple(values))


def _designs(
    scenes: Sequence[str], changes: Mapping[str, object], varied: Varied | None
) -> dict[str, Drivetrain]:
    """Scenes by a name for tables: their own, or that of their value."""
    if varied is not None:
        if len(scenes) > 1:
            raise InputError("--vary changes one scene: give one, or leave --vary out")
        return {
            f"{value:g}": read_drivetrain(scenes[0], {**changes, varied.key: value})
            for value in varied.values
        }
    if len(scenes) < 2:
        raise InputError(
            f"there is nothing to compare {scenes[0]} with: give a second scene, or values of a "
            "parameter with --vary"
        )
    if len(scenes) > _MAXIMUM:
        raise InputError(f"{len(scenes)} scenes are given but {_MAXIMUM} can be compared at once")
    stems = [Path(name).stem for name in scenes]
    unique = len(set(stems)) == len(stems)
    names = stems if unique else list(scenes)
    if len(set(names)) < len(names):
        raise InputError(f"{' and '.join(names)}: one scene is given twice; give each of them once")
    return {name: read_drivetrain(one, changes) for name, one in zip(names, scenes, strict=True)}
