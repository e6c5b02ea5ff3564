"""Flexibility of shafts by beam theory and by Fourier harmonics in the meridian.

Every shaft here is held at its front end; a flexibility is the motion of the rear end for a force
or moment there, so that entry 0 is along x, 2 along z, 3 about x and 4 about y.
"""

import numpy as np

from fe_drivetrain.common import Floats, wrench_transport
from fe_drivetrain.drivetrain_file import MATERIALS
from fe_drivetrain.elasticity.revolution import end_stiffness
from fe_drivetrain.geometry import Section, Shaft
from fe_drivetrain.shafts.beam import BeamSection, element_integrals

STEEL = MATERIALS["steel"]
"""Of every shaft here."""

AXIAL, DEFLECTION, TORSION, ROTATION = 0, 2, 3, 4
"""Entries of a flexibility."""


def uniform(length: float, bore: float = 0.0, outer: float = 1.0) -> Shaft:
    """A cylinder from x = 0; lengths [m]."""
    return Shaft(
        front=0.0,
        sections=(Section(length=length, outer_diameter=outer, inner_diameter=bore),),
    )


def stepped(
    lengths: tuple[float, float], outers: tuple[float, float], fillet: float = 0.0
) -> Shaft:
    """Two solid cylinders from x = 0; lengths [m]."""
    return Shaft(
        front=0.0,
        sections=tuple(
            Section(length=length, outer_diameter=outer, fillet=radius)
            for length, outer, radius in zip(lengths, outers, (fillet, 0.0), strict=True)
        ),
    )


def by_elements(shaft: Shaft, size: float, order: int | None = None, layers: int = 3) -> Floats:
    """Flexibility (6, 6) between rigid end faces from the meridian; see `end_stiffness`.

    Parameters
    ----------
    shaft : Shaft
        Held at its front face.
    size : float
        Size of the elements [m].
    order : int or None
        Order of the elements.
    layers : int
        Number of layers of elements towards each corner.
    """
    K = end_stiffness(shaft, STEEL, size, order=order, layers=layers)
    return np.asarray(np.linalg.inv(K[6:, 6:]))


def by_beam(shaft: Shaft, shear: bool = True) -> Floats:
    """The same of Timoshenko's beam with Cowper's coefficient, or of Euler and Bernoulli's."""
    total = np.zeros((6, 6))
    for piece, end in zip(shaft.pieces, shaft.stations[1:], strict=True):
        section = BeamSection(piece.length, piece.outer_diameter, piece.inner_diameter)
        own = element_integrals(section, STEEL, shear, 0.0, piece.length).flexibility
        carried = wrench_transport([shaft.rear - end, 0.0, 0.0])
        total += carried.T @ own @ carried
    return total
