"""The problems that all tools solve: one face held, another moved."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from skfem.quadrature import get_quadrature
from skfem.refdom import RefTet

from fe_drivetrain.cases.performance.peers.runner import Problem
from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.drivetrain_file.materials import MATERIALS, Material
from fe_drivetrain.drivetrain_file.reading import library_scene
from fe_drivetrain.elasticity.mesh.cached import cached_mesh
from fe_drivetrain.elasticity.mesh.mesh import Mesh
from fe_drivetrain.geometry import MeshSizes, Section, Shaft
from fe_drivetrain.shafts.response.model import mesh_scene

DEGREE = 4
"""Of the common quadrature: scikit-fem's eleven points, exact where the edges are straight."""

_ELEMENTS_PER_TURN = 6  # so that the size alone decides, on coarse meshes too
_WALLS = 2.99  # the largest size beside the wall; three are refused
_TRIES = 4
_NEAR = 0.05


@dataclass(frozen=True)
class Benchmark:
    """A family of meshes of one problem.

    Attributes
    ----------
    title, quantity, unit : str
        For the page.
    exact : float or None
        The stiffness where it is known.
    at : callable
        The problem at a mesh size, relative to `size`.
    guess : float
        Nodal displacements at relative size 1, about.
    """

    title: str
    quantity: str
    unit: str
    exact: float | None
    at: Callable[[float], Problem]
    guess: float


def torsional_stiffness(material: Material, section: Section) -> float:
    """G J / L of a round shaft [N m/rad]: exact, as its cross-sections stay plane."""
    polar = np.pi / 32 * (section.outer_diameter**4 - section.inner_diameter**4)
    return float(material.shear_modulus * polar / section.length)


def of_size(benchmark: Benchmark, unknowns: int, motions: int = 1) -> Problem:
    """The problem with about so many displacements, and so many motions of the moved face.

    Meshes are tried at sizes that follow from the number at the last: near a coarsest mesh, which
    the shape sets, that number stays above what was asked for.
    """
    factor = (benchmark.guess / unknowns) ** (1 / 3)
    for _ in range(_TRIES):
        problem = benchmark.at(factor)
        ratio = 3 * len(problem.points) / unknowns
        if abs(ratio - 1) < _NEAR:
            break
        factor *= ratio ** (1 / 3)
    return with_motions(problem, motions)


def with_motions(problem: Problem, number: int) -> Problem:
    """A problem with its own motion first, and others beside it.

    Nine linear motions of a plane face are linearly independent; the tenth is their mean, of which
    no tool makes use.

    Parameters
    ----------
    problem : Problem
        With a moved face across x, and a motion along an axis or about x.
    number : int
        Number of motions, up to `MAX_MOTIONS`: translations, rotation about x, stretches and shear
        in the face, and tilts.
    """
    own = problem.motions[0]
    others = [m for m in _MOTIONS if not np.array_equal(m, own)]
    independent = np.array([own, *others])
    return replace(problem, motions=np.array([*independent, independent.mean(axis=0)])[:number])


def _translation(axis: int) -> Floats:
    motion = np.zeros((3, 4))
    motion[axis, 3] = 1.0
    return motion


def _gradient(*entries: tuple[int, int, float]) -> Floats:
    """Displacement along i by so many times what lies along j."""
    motion = np.zeros((3, 4))
    for i, j, factor in entries:
        motion[i, j] = factor
    return motion


_TWIST = _gradient((2, 1, 1.0), (1, 2, -1.0))
_MOTIONS = (
    *(_translation(axis) for axis in range(3)),
    _TWIST,
    _gradient((1, 1, 1.0)),
    _gradient((2, 2, 1.0)),
    _gradient((2, 1, 1.0), (1, 2, 1.0)),
    _gradient((0, 1, 1.0)),
    _gradient((0, 2, 1.0)),
)
MAX_MOTIONS = len(_MOTIONS) + 1


def hollow_shaft() -> Benchmark:
    """Rear end held, front end turned about the axis."""
    section = Section(length=2.0, outer_diameter=0.7, inner_diameter=0.3)
    return _twisted("Hollow shaft in torsion", section, size=0.1, guess=20_500)


def thin_tube() -> Benchmark:
    """A wall of a fiftieth of the radius; no element of any mesh is larger than three walls."""
    section = Section(length=1.0, outer_diameter=2.0, inner_diameter=1.96)
    return _twisted("Thin tube in torsion, R/t = 50", section, size=0.04, guess=167_000)


def slender_shaft() -> Benchmark:
    """Two hundred diameters long: its softest motion is far from the stiffest."""
    section = Section(length=140.0, outer_diameter=0.7)
    return _twisted("Slender shaft in torsion, L/D = 200", section, size=0.2, guess=220_000)


def _twisted(title: str, section: Section, size: float, guess: float) -> Benchmark:
    """A round shaft with its rear end held, and its front end turned about the axis."""
    steel = MATERIALS["steel"]
    shaft = Shaft(front=0.0, sections=(section,))
    largest = _WALLS * (section.outer_diameter - section.inner_diameter) / 2.0

    def at(factor: float) -> Problem:
        sizes = MeshSizes(shaft=min(size * factor, largest), elements_per_turn=_ELEMENTS_PER_TURN)
        mesh = cached_mesh(shaft, [], {}, sizes, frozenset())
        faces = mesh.faces["shaft.rear"], mesh.faces["shaft.front"]
        return _problem(mesh, [steel], faces, _TWIST)

    return Benchmark(
        title=title,
        quantity="torsional stiffness",
        unit="N m/rad",
        exact=torsional_stiffness(steel, section),
        at=at,
        guess=guess,
    )


def main_bearing() -> Benchmark:
    """Base of the housing held, front face of the shaft lifted."""
    scene = library_scene("main_bearing_bonded")
    name = scene.bearing_units[0].bearing.name

    def at(factor: float) -> Problem:
        sizes = scene.mesh.scaled(factor, _ELEMENTS_PER_TURN)
        mesh = mesh_scene(scene.model_copy(update={"mesh": sizes}))
        faces = mesh.faces[f"{name}.housing.base"], mesh.faces["shaft.front"]
        materials = [scene.material_of(part) for part in mesh.part_names]
        return _problem(mesh, materials, faces, _translation(2))

    return Benchmark(
        title="Main-bearing assembly, front face of the shaft lifted",
        quantity="stiffness",
        unit="N/m",
        exact=None,
        at=at,
        guess=63_500,
    )


BENCHMARKS: dict[str, Callable[[], Benchmark]] = {
    "shaft": hollow_shaft,
    "assembly": main_bearing,
    "tube": thin_tube,
    "slender": slender_shaft,
}


def _problem(
    mesh: Mesh, materials: list[Material], faces: tuple[Ints, Ints], motion: Floats
) -> Problem:
    points, weights = get_quadrature(RefTet, DEGREE)
    return Problem(
        points=mesh.points,
        cells=mesh.cells,
        material=mesh.part,
        youngs_modulus=np.array([m.youngs_modulus for m in materials]),
        poisson_ratio=np.array([m.poisson_ratio for m in materials]),
        fixed=faces[0],
        moved=faces[1],
        motions=motion[None],
        rule_points=np.ascontiguousarray(points.T),
        rule_weights=weights,
    )
