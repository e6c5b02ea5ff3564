"""Types of arrays, as they stand in signatures, rows of long arrays in chunks, rounded numbers.

Shapes and units are in the docstrings of what takes them.
"""

from collections.abc import Iterator

import numpy as np
from numpy.typing import ArrayLike, NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

#: Rows at a time, as of cells: keeps work arrays inside the cache and memory bounded. Whoever needs
#: more than a few hundred numbers a row takes a half or a quarter.
CHUNK = 4096


def chunks(n: int, size: int = CHUNK) -> Iterator[slice]:
    """Slices of at most ``size`` rows that cover n rows in order."""
    return (slice(start, min(start + size, n)) for start in range(0, n, size))


def rounded(values: ArrayLike, digits: int = 6) -> list[float]:
    """Plain floats of so many significant digits: keeps results.json and pages small."""
    return [float(f"{v:.{digits}g}") for v in np.ravel(np.asarray(values, dtype=float))]
