"""How far a condensed shaft is from its limit: bands of the meridian and of the solid.

A band is of any entry of the stiffness, relative to the diagonal entries of its row and column. It
never rests on a series of meshes alone: three values that scatter little say nothing of what all of
them are short of.

The meridian is compared with elements of one order more. Where stress is singular as r^(a - 1), the
energy of the error falls with the order p at least as p^(-4 a) on the same mesh (Babuska and Suri
1987, RAIRO Math. Model. Numer. Anal. 21, 199-238), elsewhere faster; a is 0.545 at a step of 90
degrees, and 0.5 at a crack, the sharpest of all notches. That exponent bounds what is still missing
from above, so that the band covers notches of any angle and is at most a few times the error.

That holds of high orders. Of low ones it falls more slowly, measured as (p + 0.4)^(-4 a): where the
corners of rings decide, as on shafts with fillets, whose elements are of order 4 and less graded,
it falls from order 4 to 5 as at a crack, and of the band its safety factor alone is left over. So
three orders are solved, and the band reaches to the limit at half of the rate that these show where
that is slower than a crack's, and to that at half of a crack's rate at most, as series of meshes do
(`assembly_bands.MIN_ORDER`). With q the share of the error that one order more leaves, it is then
1.25 (1 + sqrt q) times that error.

The solid is compared with a coarser mesh of it, by the mean size of the elements that there are,
and its stresses with recovered ones (`fe_drivetrain.elasticity.solve.error_estimate`); the band is
the larger.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.stiffness_bands import StiffnessBands
from fe_drivetrain.comparison.convergence import SAFETY, SOLVER_ROUND_OFF, clipped_order
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.elasticity.mesh.measures import mean_size
from fe_drivetrain.elasticity.solve.condensation import Condensed, followed, keep_points
from fe_drivetrain.elasticity.solve.coupled_solid import CondensedSolid
from fe_drivetrain.elasticity.solve.error_estimate import SAFETY as RECOVERY_SAFETY
from fe_drivetrain.elasticity.solve.error_estimate import recovery_estimate
from fe_drivetrain.shafts.fidelity.shafts import meridian_shaft, shaft_solid

#: Exponent of the displacements at a crack: no notch is sharper.
SHARPEST = 0.5
#: Factor on the sizes of the coarser solid, and the order that is relied upon.
COARSER, ORDER = 1.35, 1.0
#: Two meshes whose mean sizes are nearer than this say nothing of each other.
APART = 1.05
#: Components that are looked at; what is along and about z repeats them.
_COMPONENTS = (0, 1, 3, 5)


def meridian_order(scene: Scene) -> int:
    """Order of the elements in the meridian of a scene's shaft where none is asked for."""
    return 4 if any(piece.fillet > 0 for piece in scene.shaft.pieces) else 6


def banded_meridian(
    scene: Scene, at: Sequence[str] | None = None
) -> tuple[Condensed, StiffnessBands]:
    """The shaft in its meridian, and the band of its stiffness.

    Parameters
    ----------
    scene : Scene
        Whose shaft.
    at : Sequence[str] or None
        Points that are kept; all where not given.

    Returns
    -------
    Condensed
        The shaft.
    StiffnessBands
        Half widths, of each kind of motion by itself.
    """
    order = meridian_order(scene)
    lower, body, higher = (
        _kept(meridian_shaft(scene, order=p), at) for p in (order - 1, order, order + 1)
    )
    before = StiffnessBands.of_difference(lower.stiffness, body.stiffness)
    last = StiffnessBands.of_difference(higher.stiffness, body.stiffness)
    found = before.each(lambda *changes: band_of_orders(order, *changes), last)
    # of what elements have exactly, as torsion without steps, round-off is left
    return body, found | StiffnessBands.uniform(SOLVER_ROUND_OFF)


def band_of_orders(order: int, before: float, last: float) -> float:
    """Half width of the band of a stiffness with elements of one order, of changes with the order.

    Parameters
    ----------
    order : int
        Order of the elements.
    before, last : float
        Changes from the order before to this one, and from this one to the next.

    Returns
    -------
    float
        In the unit of the changes: to the limit as at a crack, or at half of the rate that is seen
        where that is slower, but not below half of a crack's; times the safety factor.
    """
    sizes = 1.0 / np.array([order - 1.0, order, order + 1.0])
    seen = clipped_order(sizes, [before + last, last, 0.0])
    crack = 4.0 * SHARPEST
    rate = float(np.clip(seen / 2.0, crack / 2.0, crack))
    left: float = (order / (order + 1.0)) ** rate
    return SAFETY * last / (1.0 - left)


def banded_solid(scene: Scene, at: Sequence[str] | None = None) -> tuple[Condensed, StiffnessBands]:
    """The solid shaft, and the band of its stiffness; see `banded_meridian`."""
    solid = shaft_solid(scene)
    body = _kept(solid.body, at)
    band = _recovered_error(scene, solid, body.names).each(lambda e: RECOVERY_SAFETY * e)
    try:
        coarse = shaft_solid(scene.model_copy(update={"mesh": scene.mesh.scaled(COARSER)}))
    except InputError:  # too coarse for a wall: what is recovered is the band
        return body, band
    ratio = mean_size(coarse.mesh) / mean_size(solid.mesh)
    if ratio < APART:
        return body, band
    change = StiffnessBands.of_difference(_kept(coarse.body, at).stiffness, body.stiffness)
    return body, band | change.each(lambda c: c / (ratio**ORDER - 1.0))


def _recovered_error(scene: Scene, solid: CondensedSolid, at: Sequence[str]) -> StiffnessBands:
    """Largest estimated errors of diagonal entries, relative, of each kind of motion."""
    mesh, motions = solid.mesh, followed(solid.body, at)
    parts = [(mesh.cells[mesh.part_cells(p)], scene.material_of(p).lame) for p in mesh.part_names]
    errors = np.zeros(6 * len(at))
    for k in (6 * point + c for point in range(len(at)) for c in _COMPONENTS):
        u = solid.displacements(motions[:, k]).ravel()
        errors[k] = recovery_estimate(mesh.points, parts, u).relative
    return StiffnessBands.of_motions(errors)


def _kept(body: Condensed, at: Sequence[str] | None) -> Condensed:
    return body if at is None else keep_points(body, at)
