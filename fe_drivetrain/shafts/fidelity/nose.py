"""What a nose does to the shaft round it: a support that couples its bearings with each other.

Shaft and nose are two cantilevers, one inside the other, joined by springs. The nose is condensed
at the same level as the shaft, held at its rear face, and put in series with its bearings: their
compliances add up, C = C_nose + C_bearings, over the components that the bearings carry, so that a
rigid bearing is no compliance at all. The nose sags under its own weight; the bearings feel that.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.drivetrain_file.joint_springs import as_numbers
from fe_drivetrain.drivetrain_file.nose import Nose
from fe_drivetrain.drivetrain_file.scene import Gearbox, LoadPoint, Scene
from fe_drivetrain.elasticity.solve.condensation import Condensed
from fe_drivetrain.shafts.fidelity.shafts import condensed_shaft


@dataclass(frozen=True)
class NoseSupport:
    """The nose and its bearings, as the shaft feels them.

    Attributes
    ----------
    carried : Ints
        (k,) components that the bearings carry, of six for each bearing in their order.
    stiffness : Floats
        (k, k) of these [N/m, N, N m/rad].
    sag : Floats
        (k, 3) their motions under the nose's own weight, at 1 m/s^2 along x, y, z [m, rad].
    """

    carried: Ints
    stiffness: Floats
    sag: Floats


def nose_as_shaft(scene: Scene, nose: Nose) -> Scene:
    """The nose as the shaft of a scene: its bearings become points where loads enter.

    Parameters
    ----------
    scene : Scene
        Whose materials and mesh sizes are taken.
    nose : Nose
        Its nose.

    Returns
    -------
    Scene
        Not a sound one, for nothing holds it.
    """
    points = tuple(LoadPoint(name=b.name, x=b.x, width=b.width) for b in nose.bearings)
    change = {
        "shaft": nose.body,
        "bearing_units": (),
        "nose": None,
        "load_points": points,
        "gearbox": Gearbox(stiffness=(0.0,) * 6),
    }
    return scene.model_copy(update=change)


def nose_support(nose: Nose, body: Condensed) -> NoseSupport:
    """The support that a condensed nose is.

    Parameters
    ----------
    nose : Nose
        The nose.
    body : Condensed
        It, free, with its bearings' names, and "gearbox" for the face that is held.
    """
    held = body.rows("gearbox")
    left = np.setdiff1d(np.arange(len(body.stiffness)), np.arange(held.start, held.stop))
    compliance = np.zeros_like(body.stiffness)
    compliance[np.ix_(left, left)] = np.linalg.inv(body.stiffness[np.ix_(left, left)])
    springs = np.concatenate([as_numbers(b.stiffness) for b in nose.bearings])
    rows = np.concatenate([np.r_[body.rows(b.name)] for b in nose.bearings])
    carried = np.flatnonzero(springs)
    among = rows[carried]
    softness = compliance[np.ix_(among, among)] + np.diag(1.0 / springs[carried])
    stiffness = np.linalg.inv(0.5 * (softness + softness.T))
    return NoseSupport(carried, 0.5 * (stiffness + stiffness.T), (compliance @ body.gravity)[among])


@dataclass(frozen=True)
class OnNose:
    """A free shaft with the springs of its nose and its bearings.

    Attributes
    ----------
    body : Condensed
        The shaft, its stiffness with theirs and its gravity with what the nose's sag does.
    support : NoseSupport
        The springs.
    rows : Ints
        (k,) of the shaft's degrees of freedom that they act on.
    names : tuple[str, ...]
        Names of the bearings.
    """

    body: Condensed
    support: NoseSupport
    rows: Ints
    names: tuple[str, ...]

    def reactions(self, motions: Floats) -> dict[str, Floats]:
        """What the shaft puts on each bearing, (6, 6 n + 3), see `Supported`."""
        stretched = motions[self.rows]
        stretched[:, -3:] -= self.support.sag
        found = np.zeros((6 * len(self.names), motions.shape[1]))
        found[self.support.carried] = self.support.stiffness @ stretched
        return dict(zip(self.names, np.split(found, len(self.names)), strict=True))


def on_nose(scene: Scene, nose: Nose, level: int, body: Condensed) -> OnNose:
    """Put the condensed shaft of a scene on its nose.

    Parameters
    ----------
    scene, nose : Scene, Nose
        The scene, and its nose.
    level : int
        Level of the nose: 1 beam, 2 meridian, 3 solid.
    body : Condensed
        The free shaft.
    """
    support = nose_support(nose, condensed_shaft(nose_as_shaft(scene, nose), level))
    rows = np.concatenate([np.r_[body.rows(b.name)] for b in nose.bearings])[support.carried]
    stiffness, gravity = body.stiffness.copy(), body.gravity.copy()
    stiffness[np.ix_(rows, rows)] += support.stiffness
    gravity[rows] += support.stiffness @ support.sag
    held = Condensed(body.names, body.positions, stiffness, gravity, body.mass)
    return OnNose(held, support, rows, tuple(b.name for b in nose.bearings))
