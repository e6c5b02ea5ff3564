"""Quantities of one design, checked at the level that is enough, with the band of each.

The adviser's rule: half of what two bounds of the housings' faces differ by, and the change from
beam to meridian. Where that is more than the tolerance, the assembly of solids on three meshes
answers, as far as it has the quantity.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.progress import Progress
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.reading import with_sections
from fe_drivetrain.drivetrain_file.scene import Scene, coarser_scene
from fe_drivetrain.elasticity.mesh.measures import mean_size
from fe_drivetrain.shafts.fidelity.assembly_bands import COARSER, assembly_band
from fe_drivetrain.shafts.fidelity.change_bands import OnSprings
from fe_drivetrain.shafts.fidelity.ladder import LevelModel, solved_assembly
from fe_drivetrain.shafts.fidelity.quantity import Quantity, named_load
from fe_drivetrain.shafts.response.entering import Factors
from fe_drivetrain.shafts.response.unit_loads import Response
from fe_drivetrain.studies.design_quantities import OWN, DesignQuantities

_ROUND_OFF = 1e-9  # relative

EXACT = "exact"
"""Level of what no model of the shaft decides."""


@dataclass(frozen=True, eq=False)
class CheckedQuantity:
    """A quantity of a design at the level that is enough.

    Attributes
    ----------
    values, bands : Floats
        (k,) values, and half width of the band of each, in the unit of the quantity.
    level : str
        At which they were found.
    """

    values: Floats
    bands: Floats
    level: str

    __repr__ = short_repr

    @property
    def share(self) -> float:
        """Largest band over its value."""
        return float((self.bands / np.maximum(np.abs(self.values), 1e-300)).max(initial=0.0))


def checked_quantities(
    asked: DesignQuantities, design: Drivetrain, tolerance: float, report: Progress
) -> dict[str, CheckedQuantity]:
    """Every quantity of a design at the level that is enough.

    Parameters
    ----------
    asked : DesignQuantities
        What is asked.
    design : Drivetrain
        The design.
    tolerance : float
        Band over value up to which a level is enough; the assembly is asked beyond.
    report : Progress
        Called with what is being done.
    """
    report("level 1 of the design")
    cheap = asked.values(design)
    report("level 2 of the design, faces in shape")
    better = asked.values(design, "better")
    on_shaft = [name for name in asked.names if asked.turning_name(name) is None]
    bound = better
    if any(_kind(asked, name) not in ("mass", "cost") for name in on_shaft):
        report("level 2 of the design, faces on average")
        bound = asked.values(design, "bound")
    found: dict[str, CheckedQuantity] = {}
    for name in asked.names:
        values = better[name]
        if name not in on_shaft:
            bands = np.abs(cheap[name] - values) + asked.turning_band(design, name)
            found[name] = CheckedQuantity(values, bands, "the finest of what turns")
        elif _kind(asked, name) in ("mass", "cost"):
            found[name] = CheckedQuantity(values, np.zeros(len(values)), EXACT)
        else:
            rows = zip(values, bound[name], cheap[name], strict=True)
            bands = np.array([OnSprings(*map(np.atleast_1d, row)).half_width for row in rows])
            bands[bands < _ROUND_OFF * np.abs(values)] = 0.0  # statics decides it
            found[name] = CheckedQuantity(values, bands, "2, meridian")
    short = [name for name in on_shaft if found[name].share > tolerance and _of_solids(asked, name)]
    if short:
        whole = with_sections(design, design.title)
        # a thinner wall than the sizes were made for needs smaller ones
        fitting = coarser_scene(whole, 1.0, whole.mesh.elements_per_turn)
        found |= _as_assembly(asked, fitting, short, report)
    return found


def _kind(asked: DesignQuantities, name: str) -> str:
    kind = name.partition(".")[0]
    return kind if kind in OWN and asked.units[name] == OWN[kind] else ""


def _of_solids(asked: DesignQuantities, name: str) -> bool:
    """Whether an assembly of solids has a quantity."""
    kind, owner = _kind(asked, name), name.partition(".")[0]
    reaction = not kind and owner != "shaft" and (owner == "hub" or name[-2] in "FM")
    return kind in ("deflection", "tilt") or reaction


def _as_assembly(
    asked: DesignQuantities, scene: Scene, names: Sequence[str], report: Progress
) -> dict[str, CheckedQuantity]:
    """Quantities of the assembly of solids, with the band of a series of meshes."""
    sizes: list[float] = []
    series: dict[str, list[Floats]] = {name: [] for name in names}
    for number, factor in enumerate((*COARSER, 1.0), 1):
        report(f"level 4 of the design ({number} of {len(COARSER) + 1})")
        coarser = scene.model_copy(update={"mesh": scene.mesh.scaled(factor)})
        try:
            level, model, response = solved_assembly(coarser)
        except InputError:  # too coarse for a wall
            if factor == 1.0:
                raise
            continue
        sizes.append(mean_size(model.mesh))
        for name, values in _of_assembly(asked, scene, names, level, response).items():
            series[name].append(values)
    found = {}
    for name, every in series.items():
        band = [
            assembly_band(sizes, [v[[k]] for v in every], np.zeros(1)).half_width * abs(last)
            for k, last in enumerate(every[-1])
        ]
        found[name] = CheckedQuantity(every[-1], np.array(band), "4, assembly of solids")
    return found


def _of_assembly(
    asked: DesignQuantities,
    scene: Scene,
    names: Sequence[str],
    level: LevelModel,
    response: Response,
) -> Mapping[str, Floats]:
    given = asked.request.load
    load = named_load(scene, given) if given else None
    found = {}
    for name in names:
        owner = name.partition(".")[2]
        if _kind(asked, name) == "deflection":
            assert load is not None
            found[name] = np.array([np.linalg.norm((response.motions["hub"] @ load.values)[:3])])
        elif _kind(asked, name) == "tilt":
            assert load is not None
            at = [owner] if owner else [unit.bearing.name for unit in scene.bearing_units]
            found[name] = np.array(
                [np.linalg.norm((response.motions[f"{n}.seat"] @ load.values)[4:]) for n in at]
            )
        else:
            quantity = Quantity(name, None if load is None else Factors(load.values))
            found[name] = np.abs(quantity.of(level, 1.0))
    return found
