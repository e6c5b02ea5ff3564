"""Stiffness of a bearing unit over the values that are uncertain in it, from some solid solutions.

A sample of hundreds would be as many meshes and solutions. The logarithm of the stiffness matrix,
relative to the nominal one, is instead taken as quadratic in the logarithm of each value and
additive over them: exact in the modulus of a unit of one material, near to that in any power, and
symmetric and positive definite wherever it is evaluated (log-Euclidean: Arsigny et al. 2007, SIAM
J. Matrix Anal. Appl. 29(1)). Solutions at values drawn from the distributions give its error,
which includes the noise of new meshes.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.scene import Coupling, Scene, Spread, nominal_values
from fe_drivetrain.shafts.fidelity.quantities import carried_root, unit_numbers
from fe_drivetrain.shafts.uncertainty.resolver import Resolver, unit_content
from fe_drivetrain.shafts.uncertainty.sampling import (
    distribution,
    nominal_value,
    with_values,
)

#: Least relative step of the design: below it the noise of a new mesh, some 1e-4 of the
#: stiffness, would drown the difference.
MIN_REACH = 0.01

#: Values are taken from this quantile to the opposite one.
EDGE = 0.05

#: Solutions that check the surface.
CHECKS = 4


@dataclass(frozen=True)
class UnitSurface:
    """A unit's stiffness as a function of the d uncertain values that it depends on.

    Attributes
    ----------
    name, coupling : str, Coupling
        Name of the bearing, and coupling of its face.
    keys, nominal : tuple[str, ...], Floats
        The values by dotted key, and (d,) what the scene gives.
    reach : Floats
        (d,) how far they were moved at least, relative.
    root : Floats
        (6, c) square root of the nominal stiffness, see `quantities.carried_root`.
    slopes, bends : Floats
        (d, c, c) coefficients of the logarithm of each value, and of its square.
    error : float
        Largest relative difference to the solutions that check it, over the stiffnesses of
        `quantities.UNIT`.
    solutions : int
        How many solid solutions it took.
    """

    name: str
    coupling: Coupling
    keys: tuple[str, ...]
    nominal: Floats
    reach: Floats
    root: Floats
    slopes: Floats
    bends: Floats
    error: float
    solutions: int

    @property
    def slope_error(self) -> float:
        """Error bound of a sensitivity due to ``error``: that over the least step."""
        return self.error / float(self.reach.min())

    def __call__(self, scene: Scene) -> Floats:
        """(6, 6) stiffness for the values of a scene that differs in nothing else."""
        values = np.array(nominal_values(scene, self.keys))
        if (values / self.nominal <= 0.0).any():
            raise InputError(
                f"the stiffness of {self.name!r} is asked for a value of another sign than the "
                "scene's: make its spread smaller"
            )
        t = np.log(values / self.nominal)
        logarithm = np.tensordot(t, self.slopes, 1) + np.tensordot(t**2, self.bends, 1)
        return np.asarray(self.root @ _exp(logarithm) @ self.root.T)


def touching(scene: Scene, name: str, keys: Sequence[str]) -> list[str]:
    """Which of these values the stiffness of a bearing unit depends on."""
    content = unit_content(scene, name)
    found = []
    for key in keys:
        # a small step: it must be a scene
        changed = with_values(scene, {key: nominal_value(scene, key) * (1 + 1e-9)})
        if unit_content(changed, name) != content:
            found.append(key)
    return found


class _Design(NamedTuple):
    """Steps (2,) of the logarithm of each value, values moved so far, and values drawn."""

    steps: list[Floats]
    moves: list[dict[str, float]]
    drawn: list[dict[str, float]]

    def scenes(self, scene: Scene) -> list[Scene]:
        """The nominal scene, and those with other values."""
        return [with_values(scene, values) for values in [{}, *self.moves, *self.drawn]]


def _design(scene: Scene, spreads: Mapping[str, Spread], seed: int) -> _Design:
    """Where a surface of these values is solved."""
    from scipy.stats import qmc

    values = nominal_values(scene, list(spreads))
    known = [distribution(s, v) for s, v in zip(spreads.values(), values, strict=True)]
    steps = []
    for value, spread in zip(values, known, strict=True):
        low, high = (math.log(spread.ppf(q) / value) for q in (EDGE, 1.0 - EDGE))
        steps.append(np.array([min(low, -MIN_REACH), max(high, MIN_REACH)]))
    moves = [
        {key: value * math.exp(step)}
        for key, value, t in zip(spreads, values, steps, strict=True)
        for step in t
    ]
    drawn = [
        {key: float(spread.ppf(q)) for key, spread, q in zip(spreads, known, row, strict=True)}
        for row in qmc.LatinHypercube(d=len(spreads), rng=seed).random(CHECKS)
    ]
    return _Design(steps, moves, drawn)


def surface_scenes(scene: Scene, spreads: Mapping[str, Spread], seed: int = 0) -> list[Scene]:
    """All scenes in which `unit_surface` solves a bearing unit, for whoever begins beforehand.

    Parameters
    ----------
    scene, spreads, seed : Scene, Mapping[str, Spread], int
        The same as for `unit_surface`.

    Raises
    ------
    InputError
        A value within the spread does not give a valid scene.
    """
    return _design(scene, spreads, seed).scenes(scene)


def unit_surface(
    scene: Scene,
    name: str,
    spreads: Mapping[str, Spread],
    resolver: Resolver,
    seed: int = 0,
    report: Callable[[str], object] = lambda step: None,
) -> UnitSurface:
    """Solve a bearing unit at two values of each key beside the nominal ones, and check that.

    Parameters
    ----------
    scene, name : Scene, str
        The scene, and the bearing of the unit.
    spreads : Mapping[str, Spread]
        By dotted key: of those values that the unit depends on, see `touching`.
    resolver : Resolver
        Solves the unit.
    seed : int
        Seed of the values that check it.
    report : callable
        Called with what is being done.

    Raises
    ------
    InputError
        A value within the spread does not give a valid scene.
    """
    keys = tuple(spreads)
    nominal = np.array(nominal_values(scene, keys))
    design = _design(scene, spreads, seed)
    steps, moves, drawn = design
    count = 1 + len(moves) + len(drawn)
    face = "in shape" if resolver.coupling == "rigid" else "on average"
    solved = resolver.solve_springs(
        design.scenes(scene),
        name,
        lambda number: report(f"stiffness of {name}, face {face} ({number} of {count})"),
    )
    base, moved, checks = solved[0], solved[1 : 1 + len(moves)], solved[1 + len(moves) :]
    root = carried_root(base)
    inverse = np.linalg.pinv(root, rcond=1e-13)

    def logarithm(stiffness: Floats) -> Floats:
        relative = inverse @ stiffness @ inverse.T
        values, vectors = np.linalg.eigh(0.5 * (relative + relative.T))
        return np.asarray(vectors * np.log(values) @ vectors.T)

    slopes, bends, reach = [], [], []
    for k, t in enumerate(steps):
        pair = np.array([logarithm(stiffness) for stiffness in moved[2 * k : 2 * k + 2]])
        slope, bend = np.tensordot(np.linalg.inv(np.column_stack([t, t**2])), pair, 1)
        slopes.append(slope)
        bends.append(bend)
        reach.append(np.abs(t).min())
    surface = UnitSurface(
        name,
        resolver.coupling,
        keys,
        nominal,
        np.array(reach),
        root,
        np.array(slopes),
        np.array(bends),
        0.0,
        count,
    )
    error = 0.0
    for values, stiffness in zip(drawn, checks, strict=True):
        exact = unit_numbers(stiffness)
        found = unit_numbers(surface(with_values(scene, values)))
        error = max(error, *(abs(found[n] / k - 1.0) for n, k in exact.items() if k > 0))
    return UnitSurface(**(vars(surface) | {"error": error}))


def _exp(symmetric: Floats) -> Floats:
    values, vectors = np.linalg.eigh(symmetric)
    return np.asarray(vectors * np.exp(values) @ vectors.T)
