"""The program with one number wrong: ``python tests/mutated.py FAULT fe-drivetrain run CASE ...``.

Each fault is put where that number enters the program, before anything else is imported, so that
every part of it works with the wrong one. A name that is not there any more is an error.
"""

import sys
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np


def _wrap(owner: Any, name: str, changed: Callable[..., Any]) -> None:
    """Put ``changed(original, *arguments)`` in the place of a function."""
    original = getattr(owner, name)
    setattr(owner, name, lambda *arguments, **named: changed(original, *arguments, **named))


def modulus() -> None:
    """Solids are 5 % too stiff."""
    from fe_drivetrain.drivetrain_file.materials import Material

    right = Material.lame
    wrong = property(lambda material: tuple(1.05 * value for value in right.fget(material)))
    Material.lame = wrong  # type: ignore[assignment, method-assign]


def poisson_ratio() -> None:
    """Solids have 0.02 too much of it, at the same modulus."""
    from fe_drivetrain.drivetrain_file.materials import Material

    right = Material.lame

    def wrong(material: Material) -> tuple[float, float]:
        more = {"poisson_ratio": material.poisson_ratio + 0.02}
        return right.fget(material.model_copy(update=more))  # type: ignore[attr-defined, no-any-return]

    Material.lame = property(wrong)  # type: ignore[assignment, method-assign]


def weight_upward() -> None:
    """Body loads act the other way."""
    from fe_drivetrain.elasticity.operator import loads

    _wrap(loads, "body_loads", lambda right, *given: -right(*given))


def lever_arm() -> None:
    """Each arm between the points of a rigid body is 1 % too long."""
    from fe_drivetrain.common import spatial

    _wrap(spatial, "wrench_transport", lambda right, arm: right(1.01 * np.asarray(arm)))


def none() -> None:
    """The program as it is, to compare with."""


FAULTS: Mapping[str, Callable[[], None]] = {
    fault.__name__: fault for fault in (modulus, poisson_ratio, weight_upward, lever_arm, none)
}

if __name__ == "__main__":
    _, fault, program, *arguments = sys.argv
    FAULTS[fault]()
    from fe_drivetrain.command_line.app import main

    sys.argv = [program, *arguments]
    sys.exit(main())
