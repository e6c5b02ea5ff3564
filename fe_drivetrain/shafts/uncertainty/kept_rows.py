"""Results of many samples, kept as they come: a study that was stopped goes on where it was."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.cache import Cache, user_cache
from fe_drivetrain.common.jobs import mapped, on_cluster
from fe_drivetrain.common.progress import Progress

AT_A_TIME = 8
"""Samples of one job of a cluster."""

EVERY = 2.0
"""Seconds between two times that results are written: so much is lost at most."""


def evaluated_rows(
    rows: Floats,
    evaluate: Callable[[Floats], Mapping[str, float]],
    content: Mapping[str, Any] | None,
    report: Callable[[int], object] = lambda done: None,
    cache: Cache | None = None,
) -> dict[str, Floats]:
    """Results of each sample by name; those that are kept are not evaluated again.

    Parameters
    ----------
    rows : ndarray, (n, d)
        Values of each sample.
    evaluate : callable
        Gives the results of one sample, always of the same names.
    content : mapping or None
        All that the results depend on, as plain data; None keeps nothing.
    report : callable
        Called with the number of a sample that was evaluated, the first being 1.
    cache : Cache or None
        Where they are kept; the user's if not given.

    Returns
    -------
    dict
        (n,) by name.
    """
    used = Cache(None) if content is None else user_cache() if cache is None else cache
    whole = {**(content or {}), "rows": rows.tolist()}
    kept = used.load("solutions", whole) or {}
    names = [str(name) for name in kept.get("names", ())]
    values = [row.tolist() for row in kept.get("values", ())]
    written, last = len(values), time.monotonic()

    def keep() -> None:
        nonlocal written, last
        if len(values) > written:
            arrays = {"names": np.array(names, dtype=np.str_), "values": np.array(values)}
            used.keep("solutions", whole, arrays)
            written, last = len(values), time.monotonic()

    # a sample takes some milliseconds: other processes of this machine would not pay
    chunk = AT_A_TIME if on_cluster() else 1
    items = ((evaluate, rows[k : k + chunk]) for k in range(len(values), len(rows), chunk))
    try:
        for found in mapped(_evaluated, items, 1):
            for one in found:
                report(len(values) + 1)
                names = names or list(one)
                values.append([one[name] for name in names])
            if time.monotonic() - last > EVERY:
                keep()
    finally:
        keep()
    return dict(zip(names, np.array(values).reshape(len(rows), len(names)).T.copy(), strict=True))


def _evaluated(
    _report: Progress, evaluate: Callable[[Floats], Mapping[str, float]], rows: Floats
) -> list[Mapping[str, float]]:
    return [evaluate(row) for row in rows]
