"""Types of arrays, as they stand in signatures, and rows of long arrays in chunks.

Shapes and units are in the docstrings of what takes them.
"""

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

#: Rows at a time, as of cells: keeps work arrays inside the cache and memory bounded. Whoever needs
#: more than a few hundred numbers a row takes a half or a quarter.
CHUNK = 4096


def chunks(n: int, size: int = CHUNK) -> Iterator[slice]:
    """Slices of at most ``size`` rows that cover n rows in order."""
    return (slice(start, min(start + size, n)) for start in range(0, n, size))
