"""Results of many samples, kept as they come: a study that was stopped goes on where it was."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.cache import Cache, user_cache

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
        Called with the number of a sample before it is evaluated, the first being 1.
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

    try:
        for number in range(len(values), len(rows)):
            report(number + 1)
            found = evaluate(rows[number])
            names = names or list(found)
            values.append([found[name] for name in names])
            if time.monotonic() - last > EVERY:
                keep()
    finally:
        keep()
    return dict(zip(names, np.array(values).reshape(len(rows), len(names)).T.copy(), strict=True))
