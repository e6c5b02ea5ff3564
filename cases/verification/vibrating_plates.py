"""Natural modes of a block of one material; exact bending waves of a plate as a solid."""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.elasticity.interfaces import Constraint
from fe_drivetrain.elasticity.interfaces.constraints import eliminate
from fe_drivetrain.elasticity.mesh import Block
from fe_drivetrain.elasticity.operator import assemble, mass_matrix
from fe_drivetrain.elasticity.solve import factorise, in_blocks, reduce
from fe_drivetrain.elasticity.solve.vibration import held_modes


def block_modes(
    block: Block, material: Material, held: Constraint, count: int, below: float = 0.0
) -> tuple[Floats, Floats]:
    """Frequencies and shapes of the lowest modes.

    Parameters
    ----------
    block : Block
        The mesh.
    material : Material
        Of all of it, with its density.
    held : Constraint
        What holds it.
    count : int
        How many modes, free motions among them.
    below : float
        Where the block can move freely, a frequency below those that matter [Hz]: the stiffness is
        shifted by its square, away from what is singular.

    Returns
    -------
    frequencies, shapes : Floats
        (count,) ascending, those of free motions about 0 [Hz]; (count, n, 3), each of unit mass.
    """
    n, shift = block.points.size, -((2.0 * np.pi * below) ** 2)
    M = mass_matrix(block.points, block.cells, material.density, n)
    K = assemble(block.points, block.cells, material.lame)
    elimination = eliminate([held], n)
    system = reduce(block.points, block.cells, in_blocks(K - shift * M), elimination)
    values, shapes = held_modes(factorise(system, "superlu"), elimination, M, count, shift)
    return np.sqrt(np.maximum(values, 0.0)) / (2.0 * np.pi), shapes.T.reshape(count, -1, 3)


def bending_wave(material: Material, thickness: float, wavenumber: float) -> float:
    """Frequency [Hz] of the lowest bending wave along a plate with free faces, exact as a solid.

    A plate whose sides are held across and along themselves, but not outward, vibrates in such
    waves: sin(pi m x / a) sin(pi n y / b) has the wavenumber pi hypot(m / a, n / b).

    Parameters
    ----------
    material : Material
        With its density.
    thickness, wavenumber : float
        [m] and [rad/m].

    Notes
    -----
    Rayleigh 1888 and Lamb 1917; Graff 1975, Wave motion in elastic solids, section 8.1: with p^2 =
    omega^2 / c_L^2 - k^2 and q^2 = omega^2 / c_T^2 - k^2, both divided by p cos cos,
    (q^2 - k^2)^2 tan(p t / 2) + 4 k^2 p q tan(q t / 2) = 0.
    """
    lame, mu = material.lame
    half, k = 0.5 * thickness, wavenumber
    longitudinal, transverse = (np.sqrt(c / material.density) for c in (lame + 2.0 * mu, mu))

    def excess(frequency: float) -> float:
        omega = 2.0 * np.pi * frequency
        p, q = (np.emath.sqrt((omega / c) ** 2 - k**2) for c in (longitudinal, transverse))
        # sin(p t / 2) / p is real, whether p is or not
        one = (q**2 - k**2) ** 2 * half * np.sinc(p * half / np.pi) * np.cos(q * half)
        return float((one + 4.0 * k**2 * q * np.sin(q * half) * np.cos(p * half)).real)

    # of waves from hundreds of thicknesses down to those of a face, thick-plate theory misses 3 %
    near = thick_plate(material, thickness, wavenumber)
    return float(brentq(excess, 0.95 * near, 1.05 * near, xtol=1e-13 * near))


def thick_plate(material: Material, thickness: float, wavenumber: float) -> float:
    """Frequency [Hz] of the same wave by thick-plate theory, its shear factor pi^2 / 12.

    Parameters
    ----------
    material : Material
        With its density.
    thickness, wavenumber : float
        [m] and [rad/m].

    Notes
    -----
    Mindlin 1951, Journal of Applied Mechanics 18, 31-38: deflection and rotation in one 2x2
    eigenproblem, of which this is the lower root.
    """
    t, k, nu = thickness, wavenumber, material.poisson_ratio
    bending = material.youngs_modulus * t**3 / (12.0 * (1.0 - nu**2))
    shear = np.pi**2 / 12.0 * material.shear_modulus * t
    K = np.array([[shear * k**2, shear * k], [shear * k, bending * k**2 + shear]])
    root = np.sqrt(material.density * np.array([t, t**3 / 12.0]))
    lower = float(np.linalg.eigvalsh(K / np.outer(root, root))[0])
    return float(np.sqrt(lower)) / (2.0 * np.pi)
