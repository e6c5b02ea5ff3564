"""The two problems that all tools solve: one face held, another moved rigidly."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from skfem.quadrature import get_quadrature
from skfem.refdom import RefTet

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.geometry import MeshSizes, Section, Shaft
from fe_drivetrain.mesh.cached import cached_mesh
from fe_drivetrain.mesh.mesh import Mesh
from fe_drivetrain.peers.runner import Problem
from fe_drivetrain.response.model import mesh_scene
from fe_drivetrain.scene.materials import MATERIALS, Material
from fe_drivetrain.scene.reading import library_scene

OUTER, INNER, LENGTH = 0.7, 0.3, 2.0
"""Diameters and length of the hollow shaft [m]."""

DEGREE = 4
"""Of the common quadrature: scikit-fem's eleven points, exact where the edges are straight."""

_ELEMENTS_PER_TURN = 6  # so that the size alone decides, on coarse meshes too
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


def torsional_stiffness(material: Material) -> float:
    """G J / L of the hollow shaft [N m/rad]: exact, as its cross-sections stay plane."""
    polar = np.pi / 32 * (OUTER**4 - INNER**4)
    return float(material.shear_modulus * polar / LENGTH)


def of_size(benchmark: Benchmark, unknowns: int) -> Problem:
    """The problem with about so many displacements.

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
    return problem


def hollow_shaft() -> Benchmark:
    """Rear end held, front end turned about the axis."""
    steel = MATERIALS["steel"]
    section = Section(length=LENGTH, outer_diameter=OUTER, inner_diameter=INNER)
    shaft = Shaft(front=0.0, sections=(section,))

    def at(factor: float) -> Problem:
        sizes = MeshSizes(shaft=0.1 * factor, elements_per_turn=_ELEMENTS_PER_TURN)
        mesh = cached_mesh(shaft, [], {}, sizes, frozenset())
        faces = mesh.faces["shaft.rear"], mesh.faces["shaft.front"]
        return _problem(mesh, [steel], faces, rotation=np.array([1.0, 0.0, 0.0]))

    return Benchmark(
        title="Hollow shaft in torsion",
        quantity="torsional stiffness",
        unit="N m/rad",
        exact=torsional_stiffness(steel),
        at=at,
        guess=20_500,
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
        return _problem(mesh, materials, faces, translation=np.array([0.0, 0.0, 1.0]))

    return Benchmark(
        title="Main-bearing assembly, front face of the shaft lifted",
        quantity="stiffness",
        unit="N/m",
        exact=None,
        at=at,
        guess=63_500,
    )


BENCHMARKS: dict[str, Callable[[], Benchmark]] = {"shaft": hollow_shaft, "assembly": main_bearing}


def _problem(
    mesh: Mesh,
    materials: list[Material],
    faces: tuple[Ints, Ints],
    translation: Floats | None = None,
    rotation: Floats | None = None,
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
        translation=np.zeros(3) if translation is None else translation,
        rotation=np.zeros(3) if rotation is None else rotation,
        rule_points=np.ascontiguousarray(points.T),
        rule_weights=weights,
    )
