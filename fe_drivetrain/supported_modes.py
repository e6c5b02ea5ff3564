"""Natural frequencies of a condensed shaft, free or on the supports of its scene."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from scipy import linalg

from fe_drivetrain.elasticity import Floats, Ints
from fe_drivetrain.errors import InputError
from fe_drivetrain.scene import Scene


def scene_supports(scene: Scene, housings: Mapping[str, Floats]) -> dict[str, Floats]:
    """Stiffness to ground (6, 6) of the points of a scene: its bearing units and its gearbox.

    Parameters
    ----------
    scene
        The scene; what its gearbox holds rigidly has inf on the diagonal.
    housings
        (6, 6) of each bearing unit by name, see `fe_drivetrain.bearing_units.unit_stiffness`.
    """
    supports = {unit.bearing.name: housings[unit.bearing.name] for unit in scene.bearing_units}
    gearbox = np.array([np.inf if k == "rigid" else float(k) for k in scene.gearbox.stiffness])
    if gearbox.any():
        supports["gearbox"] = np.diag(gearbox)
    return supports


def on_supports(
    points: Sequence[str], stiffness: Floats, supports: Mapping[str, Floats]
) -> tuple[Floats, Ints]:
    """Stiffness with that of the supports added, and which freedoms they leave.

    Parameters
    ----------
    points
        Names of n points.
    stiffness
        (6 n + m, 6 n + m): six freedoms of each point first, then m of anything.
    supports
        (6, 6) by point; inf on the diagonal holds that motion, and nothing else is in its row.

    Returns
    -------
    (k, k) stiffness of the freedoms that are left, and their (k,) numbers.

    Raises
    ------
    InputError
        A support is at no point.
    """
    K = np.array(stiffness)
    held = np.zeros(len(K), dtype=bool)
    for name, k in supports.items():
        if name not in points:
            raise InputError(
                f"support {name!r} is at none of the points {', '.join(points)}: keep its point"
            )
        rows = slice(6 * points.index(name), 6 * points.index(name) + 6)
        held[rows] = np.isinf(np.diag(k))
        K[rows, rows] += np.where(np.isinf(k), 0.0, k)
    left = np.flatnonzero(~held)
    return K[np.ix_(left, left)], left


def natural_frequencies(
    points: Sequence[str],
    stiffness: Floats,
    mass: Floats,
    supports: Mapping[str, Floats] | None = None,
) -> Floats:
    """Natural frequencies, ascending, those of free motions among them as about 0 [Hz].

    For the arguments see `on_supports`; the mass is of the same freedoms as the stiffness.
    """
    K, left = on_supports(points, stiffness, supports or {})
    M = np.asarray(mass)[np.ix_(left, left)]
    # lengths and angles, points and modes alike: a unit diagonal keeps the digits of all
    size = np.sqrt(M.diagonal())
    values = linalg.eigh(K / np.outer(size, size), M / np.outer(size, size), eigvals_only=True)
    return np.asarray(np.sqrt(np.maximum(values, 0.0)) / (2.0 * np.pi))
