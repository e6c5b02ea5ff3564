"""Compiled forces of rolling bearings on few rows, by the kernels of a single bearing.

Each bearing has five rows, the motion u of its inner ring against the outer one. Its damper is a
matrix D that stays in a step, of a time times the tangent at the beginning of it.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from fe_drivetrain.bearing import kernels
from fe_drivetrain.bearing.contact_forces import packed
from fe_drivetrain.bearing.geometry import Bearing
from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.compiled import inner_loop
from fe_drivetrain.dynamics.time.law_loops import ZR, D, Z


class Rolling(NamedTuple):
    """Bearings one after the other.

    ``row`` is the first of their rows, ``drift`` that of their drifts or -1; ``seconds`` (b,) their
    dampers over the tangent; ``of`` (b + 1,) which rows of ``pack`` belong to each.
    """

    row: int
    drift: int
    seconds: Floats
    of: Ints
    pack: kernels.Packed


@lru_cache(maxsize=32)
def rolling_of(
    kinds: tuple[Bearing, ...], seconds: tuple[float, ...], row: int, drift: int
) -> Rolling:
    """Bearings in the form of the compiled loop.

    Parameters
    ----------
    kinds : tuple of Bearing
        Bearings (b,).
    seconds : tuple of float
        Damping (b,) of each over its tangent stiffness [s].
    row, drift : int
        Their first row, and the first of their drifts or -1.
    """
    packs = [packed(kind) for kind in kinds]
    counts = np.cumsum([0, *(len(pack.data) for pack in packs)])

    def whole(name: str, *shape: int) -> Floats:
        parts = [getattr(pack, name) for pack in packs]
        return np.ascontiguousarray(np.concatenate(parts) if parts else np.zeros(shape))

    def placed(name: str) -> Ints:
        found = [np.zeros(1, dtype=np.int64)]
        for pack in packs:
            first = np.asarray(getattr(pack, name), dtype=np.int64)
            found.append(first[1:] + found[-1][-1])
        return np.concatenate(found)

    pack = kernels.Packed(
        whole("data", 0, kernels.N_DATA),
        placed("first"),
        whole("sines", 0),
        whole("cosines", 0),
        placed("lam"),
        whole("xi", 0),
        whole("free", 0),
        whole("shares", 0),
        whole("nodes", 0, kernels.NODES),
        whole("node_shares", 0, kernels.NODES),
        whole("tables", 0, kernels.POWERS),
    )
    return Rolling(int(row), int(drift), np.array(seconds, dtype=np.float64), counts, pack)


@inner_loop
def new_dampers(rolling: Rolling, bearings: Floats) -> None:  # pragma: no cover - compiled
    """Dampers of the next step, by the tangents at its beginning: (2, b, 5, 5), as overwritten."""
    for b in range(len(rolling.seconds)):
        for i in range(5):
            for j in range(5):
                bearings[1, b, i, j] = rolling.seconds[b] * bearings[0, b, i, j]


@inner_loop
def _one(pack: kernels.Packed, first: int, last: int) -> kernels.Packed:  # pragma: no cover
    """The rows of one bearing."""
    return kernels.Packed(
        pack.data[first:last],
        pack.first[first : last + 1],
        pack.sines,
        pack.cosines,
        pack.lam[first : last + 1],
        pack.xi,
        pack.free,
        pack.shares,
        pack.nodes[first:last],
        pack.node_shares[first:last],
        pack.tables[first:last],
    )


@inner_loop
def bearing_forces(
    rolling: Rolling,
    by_rate: float,
    at: int,
    y: Floats,
    tangent: Floats,
    bearings: Floats,
    resisted: Floats,
    scratch: Floats,
) -> None:  # pragma: no cover - compiled
    """Loads of all bearings with their dampers, and derivatives, behind those of the springs.

    Parameters
    ----------
    rolling : Rolling
        Bearings.
    by_rate, at, y, tangent : float, int, Floats
        As `law_forces` takes them; d and its derivative are overwritten at the bearings' rows.
    bearings : Floats
        Tangents, overwritten, and dampers (2, b, 5, 5).
    resisted : Floats
        Loads of the dampers (2, 5 b) at the beginning and the end of a step, overwritten.
    scratch : Floats
        Memory (14,) of the kernels.
    """
    z, rate, extra = y[Z + at], y[ZR + at], y[D + at]
    for b in range(len(rolling.seconds)):
        p = rolling.row + 5 * b
        drift = rolling.drift + 5 * b if rolling.drift >= 0 else -1
        one = _one(rolling.pack, rolling.of[b], rolling.of[b + 1])
        K, C = bearings[0, b], bearings[1, b]
        kernels.evaluate(z[p : p + 5], one, extra[p : p + 5], K, scratch[:5], scratch[5:])
        for i in range(5):
            force = 0.0
            for j in range(5):
                moves = rate[p + j] + (z[drift + j] if drift >= 0 else 0.0)
                force += C[i, j] * moves
                tangent[p + i, p + j] = K[i, j] + by_rate * C[i, j]
                if drift >= 0:
                    tangent[p + i, drift + j] = C[i, j]
            resisted[at, 5 * b + i] = force
            extra[p + i] += force
