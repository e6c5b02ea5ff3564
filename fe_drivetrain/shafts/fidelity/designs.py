"""Designs side by side: what differs between scenes, each quantity at the cheapest level enough.

A difference counts where it is larger than what its two values may be wrong by. So every quantity
of every design has a band, and a level is enough where the bands of both are within a tolerance.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import FORCES, MOTIONS
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.jobs import mapped
from fe_drivetrain.common.progress import Progress, silent
from fe_drivetrain.common.reading import value_changes
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.scene import Scene, coarser_scene
from fe_drivetrain.shafts.fidelity.assembly_series import assembly_series, mesh_neighbours
from fe_drivetrain.shafts.fidelity.change_bands import OnMeshes, OnSprings, change_band
from fe_drivetrain.shafts.fidelity.ladder import housing_springs, shaft_level, statics_level
from fe_drivetrain.shafts.fidelity.quantities import NOISE
from fe_drivetrain.shafts.fidelity.quantity import Quantity, Reported, named_load
from fe_drivetrain.shafts.fidelity.shafts import condensed_shaft
from fe_drivetrain.shafts.response.entering import Factors
from fe_drivetrain.shafts.response.neighbours import Neighbours


@dataclass(frozen=True)
class Value:
    """A quantity of one design.

    Attributes
    ----------
    values : Floats
        (k,) see `Quantity.of`.
    band : float
        Largest error of their norm, relative; NaN where it is not known.
    level : int or str
        At which they were found; one of all that turns has a name.
    cheaper : tuple[float, float] or None
        The two parts of the band at level 2: half of what the bounds of the housings differ by, and
        the change from beam to meridian; None of what statics decides.
    rests_on : OnSprings or OnMeshes, or None
        The values that the band was found from; None of what statics decides.
    """

    values: Floats
    band: float
    level: int | str
    cheaper: tuple[float, float] | None = None
    rests_on: OnSprings | OnMeshes | None = None

    @property
    def size(self) -> float:
        """The value, or the norm of several."""
        one = len(self.values) == 1
        return float(self.values[0]) if one else float(np.linalg.norm(self.values))


@dataclass(frozen=True)
class Difference:
    """A quantity of all designs.

    Attributes
    ----------
    quantity : Reported
        What it is.
    values : tuple[Value, ...]
        Value of each design, the first one that the others are compared with.
    """

    quantity: Reported
    values: tuple[Value, ...]

    @property
    def changes(self) -> Floats:
        """(n,) of the designs after the first: change relative to the first's; infinite from zero.

        Of several values it is the norm of their changes, and has no sign.
        """
        return self._over(self._absolute, self._first)

    @property
    def bands(self) -> Floats:
        """(n,) what each change may be wrong by: see `fe_drivetrain.shafts.fidelity.change_bands`.

        The bands of its two values together where nothing is known of what they have in common.
        """
        return self._over(self._uncertain, self._first)

    @property
    def ranks(self) -> Floats:
        """(n,) size of each change, relative to the larger of its two values: 1 from zero."""
        return np.abs(self._over(self._absolute, self._larger))

    @property
    def rank_bands(self) -> Floats:
        """(n,) what each of the `ranks` may be wrong by."""
        return self._over(self._uncertain, self._larger)

    @property
    def is_known(self) -> bool:
        """Whether a change is larger than its band."""
        return bool((self.ranks > self.rank_bands).any())

    def _over(self, part: Callable[[Value], float], size: Callable[[Value], float]) -> Floats:
        """(n,) of the designs after the first; nothing over nothing is nothing."""
        found = [(part(other), size(other)) for other in self.values[1:]]
        return np.array([p / s if s > 0.0 else np.inf * p if p else 0.0 for p, s in found])

    def _first(self, other: Value) -> float:
        return abs(self.values[0].size)

    def _larger(self, other: Value) -> float:
        return max(abs(self.values[0].size), abs(other.size))

    def _uncertain(self, other: Value) -> float:
        first = self.values[0]
        band = change_band(first.rests_on, other.rests_on, (first.size, other.size))
        if band is not None:
            return band
        return sum(value.band * abs(value.size) for value in (first, other))

    def _absolute(self, other: Value) -> float:
        first = self.values[0].values
        change = other.values - first
        if len(first) == 1:
            return float(change[0] * (np.sign(first[0]) or 1.0))
        return float(np.linalg.norm(change))


def all_quantities(scene: Scene, load: Factors | None = None) -> list[Quantity]:
    """Stiffness at the hub, and reactions of the bearings and of the gearbox.

    Parameters
    ----------
    scene : Scene
        The scene.
    load : Factors or None
        That causes the reactions, see `Quantity`.
    """
    names = [f"{owner}.{c}" for owner in (*scene.bearing_names, "gearbox") for c in FORCES]
    hub = [Quantity(f"hub.stiffness.{motion}") for motion in MOTIONS]
    return [*hub, *(Quantity(name, load) for name in names)]


def compare_designs(
    designs: Mapping[str, Scene],
    quantities: Sequence[Quantity] | None = None,
    tolerance: float = 0.05,
    load: Mapping[str, float] | None = None,
    report: Progress = silent,
) -> list[Difference]:
    """Quantities of several designs, each at the cheapest level that is enough for all of them.

    Parameters
    ----------
    designs : mapping of str to Scene
        By name; the others are compared with the first.
    quantities : sequence of Quantity, optional
        What is compared; `all_quantities` that every design has, and that are not zero, where left
        out.
    tolerance : float
        Allowed error of a change, relative to the first design's value.
    load : mapping of str to float, optional
        That causes the reactions, by names of `fe_drivetrain.shafts.response.scene_loads`; each of
        the six hub loads, one at a time, where left out.
    report : callable
        Called with what is being done.

    Returns
    -------
    list of Difference
        The largest change first; those that are not known to be one last.

    Raises
    ------
    InputError
        There are fewer than two designs, or a quantity is none of theirs.
    """
    check_comparison(len(designs), tolerance)
    # a thinner wall than the sizes were made for needs smaller ones
    designs = {
        name: coarser_scene(scene, 1.0, scene.mesh.elements_per_turn)
        for name, scene in designs.items()
    }
    asked: dict[str, Sequence[Quantity]] = {}
    for name, scene in designs.items():
        factors = None if load is None else named_load(scene, load)
        if quantities is None:
            asked[name] = all_quantities(scene, factors)
        else:
            asked[name] = [Quantity(one.name, factors) for one in quantities]
            for one in asked[name]:
                one.check(scene)
    common = [
        one.name
        for one in next(iter(asked.values()))
        if all(one.name in {other.name for other in others} for others in asked.values())
    ]
    # one after the other on this machine: each takes all cores, and much memory
    items = [(name, scene, _chosen(asked[name], common)) for name, scene in designs.items()]
    found = dict(zip(designs, mapped(_on_springs, items, 1, report), strict=True))
    if quantities is None:
        something = [_not_zero(found[name], scene) for name, scene in designs.items()]
        common = [q for q in common if any(q in some for some in something)]
    short = [q for q in common if not _is_within(found, q, tolerance)]
    if short:
        near = mesh_neighbours()
        solved = [
            (name, scene, _chosen(asked[name], short), near) for name, scene in designs.items()
        ]
        for name, better in zip(designs, mapped(_as_assembly, solved, 1, report), strict=True):
            for short_of, value in better.items():
                found[name][short_of] = replace(value, cheaper=found[name][short_of].cheaper)
    first = next(iter(asked))
    differences = [
        Difference(quantity, tuple(found[d][quantity.name] for d in designs))
        for quantity in _chosen(asked[first], common)
    ]
    return ranked(differences)


def check_comparison(count: int, tolerance: float) -> None:
    """Refuse a lone design, and a tolerance out of its range.

    Parameters
    ----------
    count : int
        Number of designs.
    tolerance : float
        Allowed error of a change, relative.

    Raises
    ------
    InputError
        See above.
    """
    if count < 2:
        raise InputError("there is one design: give at least two to compare")
    if not 0 < tolerance < 1:
        raise InputError(f"tolerance is {100 * tolerance:g} % but must be between 0 and 100 %")


def ranked(differences: Iterable[Difference]) -> list[Difference]:
    """Changes larger than their bands first, the largest before the others."""
    return sorted(differences, key=lambda d: (not d.is_known, -float(d.ranks.max())))


def scene_changes(before: Drivetrain, after: Drivetrain) -> list[tuple[str, Any, Any]]:
    """What two scenes state differently: dotted key, and both values (None where there is none)."""
    found = value_changes(before.model_dump(mode="json"), after.model_dump(mode="json"))
    return [change for change in found if change[0] != "title"]


def _named(report: Callable[[str], object], name: str) -> Callable[[str], object]:
    """Reports what is being done with the design that it is done with."""
    return lambda step: report(f"{name}: {step}")


def _chosen(quantities: Sequence[Quantity], names: Sequence[str]) -> list[Quantity]:
    return [one for one in quantities if one.name in names]


def _not_zero(found: Mapping[str, Value], scene: Scene) -> list[str]:
    """Names of the values that are more than the noise of a mesh."""
    sizes = {
        name: abs(value.size) / (scene.shaft.length if ".M" in name else 1.0)
        for name, value in found.items()
        if not name.startswith("hub.")
    }
    least = NOISE * max(sizes.values(), default=0.0)
    return [name for name in found if sizes.get(name, np.inf) > least]


def _is_within(found: Mapping[str, Mapping[str, Value]], name: str, tolerance: float) -> bool:
    """Whether the band of each change of a quantity is within the tolerance."""
    changes = Difference(Quantity(name), tuple(of[name] for of in found.values()))
    return bool((changes.rank_bands <= tolerance).all())


def _as_assembly(
    report: Progress,
    name: str,
    scene: Scene,
    quantities: Sequence[Quantity],
    near: Sequence[Neighbours],
) -> dict[str, Value]:
    """Values of the assembly of solids, by name of the quantity, with what neighbours have left."""
    level, _, series = assembly_series(scene, quantities, _named(report, name), neighbours=near)
    return {
        quantity.name: Value(of.values[-1], of.band.half_width, level.level, rests_on=of)
        for quantity, of in zip(quantities, series, strict=True)
    }


def _on_springs(
    progress: Progress, name: str, scene: Scene, quantities: Sequence[Quantity]
) -> dict[str, Value]:
    """Values by statics where it decides them, else of the meridian between its housings' bounds.

    The band is that of the adviser: half of what the bounds differ by, and the change from beam to
    meridian.
    """
    report, length = _named(progress, name), scene.shaft.length
    report("level 0: statics")
    statics = statics_level(scene)
    found = {one.name: Value(one.of(statics, length), 0.0, 0) for one in quantities}
    open_ = [one for one in quantities if not np.isfinite(found[one.name].values).all()]
    if not open_:
        return found
    report("housings, faces in shape")
    stiff = housing_springs(scene, coupling="rigid")[0]
    report("housings, faces on average")
    soft = housing_springs(scene, coupling="averaged")[0]
    models = []
    for level in (1, 2):
        report(f"level {level}")
        body = condensed_shaft(scene, level)
        models.append([shaft_level(scene, level, springs, body) for springs in (stiff, soft)])
    (beam, _), (meridian, bound) = models
    for one in open_:
        values = one.of(meridian, length)
        if not values.any():
            found[one.name] = Value(values, 0.0, 2)
            continue
        on = OnSprings(values, one.of(bound, length), one.of(beam, length))
        size = float(np.linalg.norm(values))
        housing, shaft = (part / size for part in on.parts)
        found[one.name] = Value(values, housing + shaft, 2, (housing, shaft), on)
    return found
