"""Forces of linear springs whose rows stand, from recorded displacements and velocities."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from fe_drivetrain.common.arrays import Floats, chunks
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.dynamics.bodies.equations import SpringLaws
from fe_drivetrain.dynamics.time.sparse_steps import FEW

_AT_ONCE = 512  # records, which stay in a processor's cache


@dataclass(frozen=True)
class SpringForces:
    """Forces of springs with their dampers, zero of those with laws.

    Attributes
    ----------
    stiff, damped : Floats or csr_array
        Forces (m, n) by displacements and by velocities.
    offsets : Floats
        Forces (m,) that the offsets take away [N].
    """

    __repr__ = short_repr

    stiff: Any
    damped: Any
    offsets: Floats

    def of(self, q: Floats, velocity: Floats) -> Floats:
        """(k, m) forces at displacements and velocities (k, n)."""
        forces = np.empty((len(q), len(self.offsets)))
        for part in chunks(len(q), _AT_ONCE):
            both = self.stiff @ q[part].T + self.damped @ velocity[part].T
            np.subtract(both.T, self.offsets, out=forces[part])
        return forces


def spring_forces(springs: SpringLaws) -> SpringForces:
    """The forces of springs that are linear.

    Parameters
    ----------
    springs : SpringLaws
        All springs.
    """
    from scipy import sparse

    linear = ~springs.special
    stiff = (linear * springs.stiffness)[:, None] * springs.rows
    damped = (linear * springs.damping)[:, None] * springs.rows
    offsets = linear * springs.stiffness * springs.offset
    if springs.rows.shape[1] < FEW:
        return SpringForces(stiff, damped, offsets)
    return SpringForces(sparse.csr_array(stiff), sparse.csr_array(damped), offsets)
