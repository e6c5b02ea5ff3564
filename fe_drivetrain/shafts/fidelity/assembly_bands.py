"""How far an assembly of solids is from element size zero: three meshes, and one alone.

Two estimates that share little. The series: the same scene on two coarser meshes, over the mean
sizes of the elements that these really have, with the slowest order that is assumed where stress is
singular, and with a wide band where values scatter (`fe_drivetrain.comparison.convergence`). The
one mesh: stresses recovered from those of the elements, and what their differences do to the
quantity (`fe_drivetrain.elasticity.solve.error_estimate`). The band is the larger of what they say.

Meshes that are not nested differ by their topology as well as by their sizes. Of two that are
a ratio r apart, the limit lies difference / (r - 1) away at first order: as r nears 1, what sizes
do to the difference vanishes, what topology does stays, and is multiplied. So the series is asked
only where its coarsest elements are 1.3 times its finest, the ratio that Celik et al. (2008) take
for the least, from experience. Where walls, bores and fillets decide the sizes of the elements and
not what was asked for, there is no such series, and recovered stresses are what is known.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil, floor, isnan, log10

import numpy as np

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.cache import Cache, user_cache
from fe_drivetrain.common.provenance import source_hash
from fe_drivetrain.comparison.convergence import DOUBTFUL, Behaviour, grid_convergence
from fe_drivetrain.elasticity.solve.error_estimate import SAFETY, Lame, recovered_work
from fe_drivetrain.geometry import MAX_TURN, MeshSizes
from fe_drivetrain.shafts.fidelity.shaft_bands import APART
from fe_drivetrain.shafts.response.cached import solved_content
from fe_drivetrain.shafts.response.influence_fields import (
    influences_of_all_reactions,
    reaction_influences,
)
from fe_drivetrain.shafts.response.model import Model
from fe_drivetrain.shafts.response.solution_keys import mesh_hash, solved_by
from fe_drivetrain.shafts.response.unit_loads import Response

#: Factors on mesh sizes of the two coarser assemblies.
COARSER = (1.8, 1.35)

#: Least ratio of the coarsest mean size of elements of a series to the finest (Celik et al. 2008).
MIN_RATIO = 1.3

#: Stress is singular where parts meet: no better order is relied upon. Of energy it is 1 at a
#: crack, the sharpest of notches; half of that is the least that Oberkampf and Roy (2010) believe.
MIN_ORDER = 0.5

_SHOWN: dict[Behaviour, str] = {
    "monotone": "three meshes converge",
    "converged": "three meshes agree to round-off",
    "oscillatory": "values of three meshes go up and down: they show no order of convergence",
    "divergent": "values of three meshes do not converge: their differences do not shrink",
}
_FILE = "assembly_bands.py"  # of the estimate, beside the rooms that make a solution
_TWO = "of coarser meshes there is only one, which shows no order of convergence"
_NONE = f"no series of coarser meshes could be made, each {MIN_RATIO:g} times as coarse as the next"


@dataclass(frozen=True)
class AssemblyBand:
    """Band of values of an assembly, relative to their norm.

    Attributes
    ----------
    series : float
        Half width by the series of meshes; NaN where there is none.
    recovered : float
        Half width by recovered stresses of the finest mesh.
    sizes : tuple[float, ...]
        Mean sizes of the elements of the meshes that the series has, coarse first [m].
    words : str
        What the series shows.
    """

    series: float
    recovered: float
    sizes: tuple[float, ...]
    words: str

    @property
    def half_width(self) -> float:
        """The larger of the two."""
        return float(np.nanmax([self.series, self.recovered]))

    def sentence(self) -> str:
        """What the band rests on."""
        of_series = self.series > self.recovered
        wider = "the series" if of_series else "recovered stresses of the finest mesh"
        larger = "" if isnan(self.series) else " (the larger estimate)"
        return f"{self.words}; the error is estimated from {wider}{larger}"


def finer_mesh(sizes: MeshSizes | None, band: float) -> str:
    """What to set where the band of an assembly is wider than asked, as the end of a sentence.

    Parameters
    ----------
    sizes : MeshSizes or None
        Element sizes of its scene, where they are known.
    band : float
        Half width over the value.
    """
    percent = 100.0 * band
    digits = 10.0 ** (floor(log10(percent)) - 1) if percent > 0.0 else 1.0
    enough = ceil(percent / digits) * digits
    wider = f"ask for {argument('tolerance', round(enough / 100.0, 12))}" if enough < 100.0 else ""
    if sizes is None:
        return wider or "make its mesh finer"
    half = sizes.scaled(0.5, min(2 * sizes.elements_per_turn, MAX_TURN))
    keys = ("shaft", "bearing", "bearing_edge", "housing", "elements_per_turn")
    smaller = {f"mesh.{key}": _rounded(getattr(half, key)) for key in keys}
    given = argument("change_scene.changes", smaller)
    return (
        f"make the element sizes under mesh smaller, for instance half of those here, {given} (all "
        f"in m but for the elements a turn){', or ' if wider else ''}{wider}"
    )


def _rounded(value: float) -> float:
    """A size to three digits; a number of elements as it is."""
    return value if isinstance(value, int) else float(f"{value:.3g}")


def assembly_band(
    sizes: Sequence[float], values: Sequence[Floats], recovered: Floats
) -> AssemblyBand:
    """The band of the values of the finest mesh.

    Of two meshes it is Roache's (1994): three times the difference to the limit, at first order.

    Parameters
    ----------
    sizes : Sequence[float]
        Mean size of the elements of each mesh, coarse first [m].
    values : Sequence[Floats]
        (k,) values of each mesh.
    recovered : Floats
        (k,) errors of the values of the finest mesh, estimated from recovered stresses.

    Returns
    -------
    AssemblyBand
        See there.
    """
    size = float(np.linalg.norm(values[-1]))
    own = SAFETY * float(np.linalg.norm(recovered)) / size
    kept = [len(sizes) - 1]
    for number in range(len(sizes) - 2, -1, -1):  # what folded over was meshed again, finer
        if sizes[number] > APART * sizes[kept[0]]:
            kept.insert(0, number)
    if sizes[kept[0]] < MIN_RATIO * sizes[-1]:
        kept = kept[-1:]
    h, table = np.array(sizes)[kept], np.array(values)[kept]
    if len(kept) == 1:
        return AssemblyBand(float("nan"), own, tuple(h), _NONE)
    if len(kept) == 2:
        missing = np.linalg.norm(table[0] - table[1]) / (h[0] / h[1] - 1.0)
        return AssemblyBand(DOUBTFUL * float(missing) / size, own, tuple(h), _TWO)
    found = [
        grid_convergence(h, column, min_order=MIN_ORDER)
        for column in table.T
        if np.abs(column).max() > 1e-6 * size  # the rest is the mesh's asymmetry
    ]
    series = float(np.linalg.norm([f.uncertainty for f in found])) / size
    widest = max(found, key=lambda f: f.uncertainty)
    return AssemblyBand(series, own, tuple(h), _SHOWN[widest.behaviour])


def motion_error(model: Model, response: Response, columns: Floats) -> Floats:
    """Estimated errors of the compliance between sums of unit loads, from recovered stresses.

    Parameters
    ----------
    model, response : Model, Response
        A solved scene.
    columns : Floats
        (n, k) factors of the unit loads, see `fe_drivetrain.shafts.response.model.scene_loads`.

    Returns
    -------
    Floats
        (k, k) [J].
    """
    u = _displacements(response, columns)
    return recovered_work(model.mesh.points, _parts(model), u, u).estimate


def reaction_error(
    model: Model, response: Response, name: str, components: Sequence[int], columns: Floats
) -> Floats:
    """Estimated errors of a reaction to sums of unit loads, from recovered stresses.

    Parameters
    ----------
    model, response : Model, Response
        A solved scene.
    name : str
        Name of a bearing, or "gearbox".
    components : Sequence[int]
        Which of the six.
    columns : Floats
        (n, k) factors of the unit loads, see `fe_drivetrain.shafts.response.model.scene_loads`.

    Returns
    -------
    Floats
        (n, k) of n components: what they are short of, farther from zero by its scatter [N, N m].
    """
    influences = reaction_influences(model, name, components)
    u = _displacements(response, columns)
    return recovered_work(model.mesh.points, _parts(model), influences, u).estimate


def all_reaction_errors(model: Model, response: Response) -> dict[str, Floats]:
    """`reaction_error` of all components of every support to each unit load, solved together.

    Parameters
    ----------
    model, response : Model, Response
        A solved scene.

    Returns
    -------
    dict[str, Floats]
        (6, n) by the name of each bearing and "gearbox", to n unit loads [N, N m].
    """
    influences = influences_of_all_reactions(model)
    u = _displacements(response, np.eye(len(model.loads)))
    together = np.hstack(list(influences.values()))
    work = recovered_work(model.mesh.points, _parts(model), together, u).estimate
    return dict(zip(influences, work.reshape(-1, 6, u.shape[1]), strict=True))


def cached_reaction_errors(
    model: Model, response: Response, cache: Cache | None = None
) -> tuple[dict[str, Floats], bool]:
    """`all_reaction_errors`, taken from the cache where they were estimated before.

    Parameters
    ----------
    model, response : Model, Response
        A solved scene.
    cache : Cache or None
        The user's if not given.

    Returns
    -------
    dict[str, Floats]
        Errors as from `all_reaction_errors`, the same to the last bit whether kept or not.
    bool
        Whether they were kept.
    """
    used = user_cache() if cache is None else cache
    content = {
        "errors of reactions": solved_content(model.scene),
        "mesh": mesh_hash(model.mesh),
        "method": response.diagnostics.method,
        "made by": solved_by()
        | {"estimate": source_hash({"fe_drivetrain.shafts.fidelity": {_FILE}})},
    }
    kept = used.load("solutions", content)
    if kept is not None and set(kept) == {*model.scene.bearing_names, "gearbox"}:
        return {name: kept[name] for name in (*model.scene.bearing_names, "gearbox")}, True
    found = {n: np.ascontiguousarray(e) for n, e in all_reaction_errors(model, response).items()}
    used.keep("solutions", content, found)
    return found, False


def _parts(model: Model) -> list[tuple[Ints, Lame]]:
    mesh = model.mesh
    return [
        (mesh.cells[mesh.part_cells(p)], model.scene.material_of(p).lame) for p in mesh.part_names
    ]


def _displacements(response: Response, columns: Floats) -> Floats:
    return response.displacements.reshape(-1, response.displacements.shape[-1]) @ columns
