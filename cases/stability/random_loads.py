"""Random loads on a rolling bearing, of all directions and sizes."""

import numpy as np

from fe_drivetrain.common import Floats

#: Sizes of axial force, radial forces and moments of random loads [N, N m].
SIZES = np.array([3e5, 2e5, 4e5, 8e5, 6e5])


def random_loads(n: int) -> Floats:
    """Loads of all directions and of two decades of size."""
    rng = np.random.default_rng(0)
    return SIZES * rng.normal(size=(n, 5)) * 10.0 ** rng.uniform(-2.0, 0.0, (n, 1))
