"""Slices of teeth that hold each other over the face, as parts of one plate do."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.gear.load_distribution import Loaded, loaded
from fe_drivetrain.gear.slices import SlicedMesh


@dataclass(frozen=True)
class Coupling:
    """Slices of one pair of teeth that hold each other, as those of a plate do.

    Attributes
    ----------
    length : float
        Length over which a load of one slice spreads to its neighbours [m].
    hertz : float
        Stiffness of the contact alone per face width [N/m^2], in series with the teeth:
        1 / `yang_sun_contact()`, say.
    """

    length: float
    hertz: float


def loaded_with_coupling(
    mesh: SlicedMesh,
    phase: float,
    torque: float,
    coupling: Coupling,
    motion: ArrayLike | None = None,
    steps: int = 60,
) -> Loaded:
    """The loaded mesh of `loaded`, with slices of a pair of teeth that hold each other.

    The teeth are an elastic layer that resists being bent over the face: c w - c l^2 w'' = p with
    the load p per face width, free at the ends; the contact is a spring on it. Without a length,
    both in series are the stiffness of the mesh.

    Parameters
    ----------
    mesh : SlicedMesh
        Pair of gears, its teeth in slices.
    phase : float
        Phase of the mesh, in periods.
    torque : float
        Torque on the first gear [N m], positive.
    coupling : Coupling
        Stiffness of the contact and length of the coupling between slices.
    motion : array_like, (12,), optional
        Position of both gears [m, rad].
    steps : int
        Maximum number of Newton steps.

    Returns
    -------
    Loaded
        Load of the slices, with `converged` false where Newton's method has not converged.
    """
    free = loaded(mesh, phase, torque, motion)
    all_of, driving = free.contacts, free.contacts.driving
    touching = replace(all_of, **{name: value[driving] for name, value in vars(all_of).items()})
    m, width = len(touching.gap), mesh.pair.face_width / mesh.slices
    away = touching.gap
    if motion is not None:
        away = away - touching.rows @ np.asarray(motion, dtype=np.float64)
    local = np.full(m, coupling.hertz * width)
    if not (local > touching.stiffness).all():
        raise InputError(
            f"the stiffness of the teeth's contact is {1e-9 * coupling.hertz:.4g} N/(mm um) but "
            "must be above that of teeth and contact in series: raise it"
        )
    bending = 1.0 / (1.0 / touching.stiffness - 1.0 / local)
    B = np.diag(bending)
    same = (touching.tooth[:, None] == touching.tooth) & (
        touching.slice[:, None] + 1 == touching.slice
    )
    for i, j in np.argwhere(same):
        spring = 0.5 * (bending[i] + bending[j]) * (coupling.length / width) ** 2
        B[np.ix_((i, j), (i, j))] += spring * np.array([[1.0, -1.0], [-1.0, 1.0]])
    load = torque / mesh.pair.first.base_radius
    # deflections of the teeth, and the approach of the gears
    unknown = np.append(np.maximum(free.approach - away, 0.0) * local / (local + bending), 0.0)
    unknown[-1] = free.approach
    right = np.append(np.zeros(m), load)
    good = False
    for _ in range(steps):
        pressed = unknown[-1] - unknown[:-1] - away
        active = pressed > 0.0
        k = np.where(active, local, 0.0)
        K = np.zeros((m + 1, m + 1))
        K[:-1, :-1] = B + np.diag(k)
        K[:-1, -1] = K[-1, :-1] = -k
        K[-1, -1] = k.sum()
        before = unknown
        unknown = np.linalg.solve(K, right + np.append(-k * away, float(k @ away)))
        # the same slices in touch: the straight problem is solved
        if ((unknown[-1] - unknown[:-1] - away > 0.0) == active).all():
            good = True
            break
        if not np.isfinite(unknown).all():
            unknown = before
            break
    forces = local * np.maximum(unknown[-1] - unknown[:-1] - away, 0.0)
    good = good and abs(float(forces.sum()) - load) <= 1e-9 * load
    return Loaded(float(unknown[-1]), touching, forces, mesh.slices, good)
