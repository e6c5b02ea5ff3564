"""How far a condensed shaft is from its limit: bands of the meridian and of the solid.

A band is of any entry of the stiffness, relative to the diagonal entries of its row and column. It
never rests on a series of meshes alone: three values that scatter little say nothing of what all of
them are short of.

The meridian is compared with elements of one order more. Where stress is singular as r^(a - 1), the
energy of the error falls with the order p at least as p^(-4 a) on the same mesh (Babuska and Suri
1987, RAIRO Math. Model. Numer. Anal. 21, 199-238), elsewhere faster; a is 0.545 at a step of 90
degrees, and 0.5 at a crack, the sharpest of all notches. That exponent bounds what is still missing
from above, so that the band covers notches of any angle and is at most a few times the error.

The solid is compared with a coarser mesh of it, by the mean size of the elements that there are,
and its stresses with recovered ones (`fe_drivetrain.solve.error_estimate`); the band is the larger.
"""

from __future__ import annotations

from collections.abc import Sequence

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.scaling import largest_difference
from fe_drivetrain.compare.convergence import SAFETY
from fe_drivetrain.fidelity.shafts import meridian_shaft, shaft_solid
from fe_drivetrain.mesh.measures import mean_size
from fe_drivetrain.scene.scene import Scene
from fe_drivetrain.solve.condensation import Condensed, followed, keep_points
from fe_drivetrain.solve.coupled_solid import CondensedSolid
from fe_drivetrain.solve.error_estimate import SAFETY as RECOVERY_SAFETY
from fe_drivetrain.solve.error_estimate import recovery_estimate

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


def banded_meridian(scene: Scene, at: Sequence[str] | None = None) -> tuple[Condensed, float]:
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
    float
        Half width of the band of any entry, relative to the diagonal entries of its row and column.
    """
    order = meridian_order(scene)
    body, higher = (_kept(meridian_shaft(scene, order=p), at) for p in (order, order + 1))
    left = (order / (order + 1)) ** (4.0 * SHARPEST)
    return body, SAFETY * largest_difference(higher.stiffness, body.stiffness) / (1.0 - left)


def banded_solid(scene: Scene, at: Sequence[str] | None = None) -> tuple[Condensed, float]:
    """The solid shaft, and the band of its stiffness; see `banded_meridian`."""
    solid = shaft_solid(scene)
    body = _kept(solid.body, at)
    band = RECOVERY_SAFETY * _recovered_error(scene, solid, body.names)
    try:
        coarse = shaft_solid(scene.model_copy(update={"mesh": scene.mesh.scaled(COARSER)}))
    except InputError:  # too coarse for a wall: what is recovered is the band
        return body, band
    ratio = mean_size(coarse.mesh) / mean_size(solid.mesh)
    if ratio < APART:
        return body, band
    change = largest_difference(_kept(coarse.body, at).stiffness, body.stiffness)
    return body, max(band, change / (ratio**ORDER - 1.0))


def _recovered_error(scene: Scene, solid: CondensedSolid, at: Sequence[str]) -> float:
    """Largest estimated error of a diagonal entry, relative.

    The error is positive semidefinite, so that no other entry has a larger one.
    """
    mesh, motions = solid.mesh, followed(solid.body, at)
    parts = [(mesh.cells[mesh.part_cells(p)], scene.material_of(p).lame) for p in mesh.part_names]
    columns = [6 * k + c for k in range(len(at)) for c in _COMPONENTS]
    return max(
        recovery_estimate(mesh.points, parts, solid.displacements(motions[:, k]).ravel()).relative
        for k in columns
    )


def _kept(body: Condensed, at: Sequence[str] | None) -> Condensed:
    return body if at is None else keep_points(body, at)
