"""A bent bracket as a plane problem, by scikit-fem alone: the reference for the solid one.

Independent of the project's elements, assembly, loads and recovery: quartic triangles, scikit-fem's
weak form of elasticity and its own solver, stresses straight from the gradients.
"""

from dataclasses import dataclass

import numpy as np
from skfem import (
    Basis,
    ElementTriP4,
    ElementVector,
    FacetBasis,
    LinearForm,
    MeshTri,
    MeshTri2,
    condense,
    solve,
)
from skfem.models.elasticity import linear_elasticity

from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file import Material


@dataclass(frozen=True)
class Bracket:
    """A strip bent by a quarter circle: a horizontal arm, the corner, a vertical arm.

    The corner's centre is the origin of y and z. The horizontal arm ends at y = ``arm``, the
    vertical one at z = -``leg``.

    Attributes
    ----------
    fillet : float
        Inner radius of the corner [m].
    height : float
        Of the strip [m].
    arm, leg : float
        Lengths of the straight parts [m].
    """

    fillet: float
    height: float
    arm: float
    leg: float

    @property
    def length(self) -> float:
        """Length of the middle line [m]."""
        return self.arm + self.leg + 0.5 * np.pi * self._middle

    @property
    def _middle(self) -> float:
        return self.fillet + 0.5 * self.height

    def edges(self, through: int) -> Floats:
        """Boundaries of elements along the middle line, as shares of it, for so many through it."""
        parts = np.array([self.arm, 0.5 * np.pi * self._middle, self.leg])
        # twice as many in the corner, whose inside is what matters
        counts = [
            max(1, round(through * p / self.height * k))
            for p, k in zip(parts, (1, 2, 1), strict=True)
        ]
        ends = np.concatenate([[0.0], np.cumsum(parts)])
        pieces = [
            np.linspace(a, b, n, endpoint=False)
            for a, b, n in zip(ends[:-1], ends[1:], counts, strict=True)
        ]
        return np.asarray(np.concatenate([*pieces, [ends[-1]]]) / ends[-1])

    def place(self, through: Floats, along: Floats) -> Floats:
        """(n, 2) y and z of shares of the height, from inside, and of the middle line.

        The line begins at the end of the arm.
        """
        r, s = self.fillet + self.height * through, self.length * along
        turn = 0.5 * np.pi * self._middle
        t = 0.5 * np.pi + np.clip((s - self.arm) / self._middle, 0.0, 0.5 * np.pi)
        before = np.maximum(self.arm - s, 0.0)
        after = np.maximum(s - self.arm - turn, 0.0)
        return np.column_stack([r * np.cos(t) + before, r * np.sin(t) - after])

    def end_shear(self, z: Floats, force: float) -> Floats:
        """Shear stress over the end of the arm: a parabola that carries the force [Pa]."""
        q = (z - self.fillet) / self.height
        return np.asarray(6.0 * force * q * (1.0 - q) / self.height)


def plane_answer(
    bracket: Bracket, material: Material, force: float, through: int
) -> tuple[float, float]:
    """Strain energy per width and greatest principal stress of the fillet, in plane strain.

    Parameters
    ----------
    bracket : Bracket
        The leg's end stays on its plane, and slides in it.
    material : Material
        Of the bracket.
    force : float
        On the end of the arm, upwards, per width [N/m].
    through : int
        Quartic triangles through the height.

    Returns
    -------
    energy, stress
        [J/m] and [Pa].
    """
    E, nu = material.youngs_modulus, material.poisson_ratio
    lam, mu = E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), E / (2.0 * (1.0 + nu))
    unit = MeshTri2.from_mesh(
        MeshTri.init_tensor(np.linspace(0.0, 1.0, through + 1), bracket.edges(through))
    )
    mesh = MeshTri2(np.ascontiguousarray(bracket.place(*unit.doflocs).T), unit.t)
    element = ElementVector(ElementTriP4())
    basis = Basis(mesh, element, intorder=8)
    K = linear_elasticity(lam, mu).assemble(basis)
    near = 1e-9 * bracket.length
    end = mesh.facets_satisfying(lambda x: np.abs(x[0] - bracket.arm) < near, boundaries_only=True)
    base = mesh.facets_satisfying(lambda x: np.abs(x[1] + bracket.leg) < near, boundaries_only=True)

    @LinearForm
    def load(v, w):  # type: ignore[no-untyped-def]
        return bracket.end_shear(w.x[1], force) * v[1]

    f = load.assemble(FacetBasis(mesh, element, facets=end, intorder=8))
    on_base = basis.get_dofs(base)
    held = np.concatenate([on_base.all(["u^2"]), on_base.all(["u^1"])[:1]])
    u = solve(*condense(K, f, D=held))

    inside = mesh.facets_satisfying(
        lambda x: (np.hypot(*x) < bracket.fillet + near) & (x[0] < near) & (x[1] > -near),
        boundaries_only=True,
    )
    along = FacetBasis(mesh, element, facets=inside, intorder=12)
    gradient = along.interpolate(u).grad
    yy, zz = gradient[0, 0], gradient[1, 1]
    shear = mu * (gradient[0, 1] + gradient[1, 0])
    mean = (lam + mu) * (yy + zz)
    principal = mean + np.hypot(mu * (yy - zz), shear)
    return 0.5 * float(f @ u), float(principal.max())
