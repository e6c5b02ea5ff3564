"""A gear that winds up along its face between its teeth and the end that takes its torque away.

The slices of a mesh act on sections of the gear, each of which turns against its body by its own
angle. With a torsional rigidity G J, a mesh of c = k / b per length of face b at a lever r, and the
torque taken at x = b, the load per length of a gear on a rigid rack is

    w(x) = F kappa cosh(kappa x) / sinh(kappa b),    kappa^2 = c r^2 / (G J)

(a bar on an elastic foundation in torsion, Timoshenko, Strength of Materials, part II, 1956), to
which the slices converge.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.dynamics import Body, Spring

_ANGLE = np.eye(6)[0]


@dataclass(frozen=True)
class FaceTwist:
    """A gear's resistance to winding up along its face.

    Attributes
    ----------
    gear : str
        Name of its body, which turns with the end that takes the torque.
    rigidity : float
        Torsional rigidity G J of its section [N m^2].
    width : float
        Face width that its meshes are sliced over [m].
    held : int
        End that takes the torque: 1 that of the largest x, -1 that of the smallest.
    """

    gear: str
    rigidity: float
    width: float
    held: int = 1

    def __post_init__(self) -> None:
        for name in ("rigidity", "width"):
            if not 0.0 < getattr(self, name) < np.inf:
                raise InputError(
                    f"twist of {self.gear!r}: {name} is {getattr(self, name):g} but must be a "
                    "finite number above 0: correct it"
                )


def with_twist(springs: Sequence[Spring], twist: FaceTwist) -> tuple[list[Body], list[Spring]]:
    """Angles of a gear's sections, and the springs with what these move its teeth by.

    Each angle is a body without mass, "NAME twist 1" and so on from the smallest x, whose one
    degree of freedom "ux" is the angle [rad] by which that section has turned against the body.

    Parameters
    ----------
    springs : sequence of Spring
        Springs of a stage; all meshes of the gear have as many slices.
    twist : FaceTwist
        The gear.

    Returns
    -------
    bodies : list of Body
        The angles.
    springs : list of Spring
        All springs, with those of the gear itself.

    Raises
    ------
    InputError
        The gear has no mesh among them, or meshes of different numbers of slices.
    """
    places = {k: _slice_of(one) for k, one in enumerate(springs) if twist.gear in one.by}
    places = {k: place for k, place in places.items() if place}
    count = max(places.values(), default=0)
    even = [list(places.values()).count(place) for place in range(1, count + 1)]
    if count < 2 or len(set(even)) > 1:
        raise InputError(
            f"twist of {twist.gear!r}: its meshes must have one number of slices, 2 or more, but "
            f"have {len(places)} slices numbered up to {count}: give slices"
        )
    names = [f"{twist.gear} twist {i + 1}" for i in range(count)]
    found = list(springs)
    for k, place in places.items():
        turned = float(springs[k].by[twist.gear][3])
        by = {**springs[k].by, names[place - 1]: turned * _ANGLE}
        found[k] = replace(springs[k], by=by)
    inwards = names if twist.held < 0 else names[::-1]
    between = twist.rigidity * count / twist.width
    held = Spring(f"{twist.gear} winding 1", {inwards[0]: _ANGLE}, 2 * between)
    found.append(held)
    for i, (near, far) in enumerate(pairwise(inwards), start=2):
        by = {far: _ANGLE, near: -_ANGLE}
        found.append(Spring(f"{twist.gear} winding {i}", by, between))
    return [Body(name, free=frozenset({"ux"})) for name in names], found


def _slice_of(spring: Spring) -> int:
    """Number of the slice of a mesh that a spring is; 0 of other springs."""
    _, cut, number = spring.name.rpartition(" slice ")
    return int(number) if cut and number.isdigit() else 0
