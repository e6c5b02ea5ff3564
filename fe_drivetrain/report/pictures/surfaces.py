"""Surfaces and solids of a mesh as VTK draws them: curved, and cut open."""

from __future__ import annotations

from typing import Any

import numpy as np

from fe_drivetrain.common.arrays import Floats, Ints

_FINE = 20_000  # facets; of more, each is small enough to be drawn with fewer pieces


def curved_surface(facets: Ints, positions: Floats, vectors: Floats | None = None) -> Any:
    """Six-node triangles as a fine surface of flat ones.

    Parameters
    ----------
    facets : Ints
        (nf, 6) node ids: corners, then mid-sides.
    positions : Floats
        (n, 3) of the nodes [m].
    vectors : Floats, optional
        (n, 3) at the nodes: the surface carries them as "vectors".

    Returns
    -------
    pyvista.PolyData
        Its points are on the curved triangles.
    """
    import pyvista

    # a copy: VTK would share the mesh's own array
    cells = {pyvista.CellType.QUADRATIC_TRIANGLE: facets}
    grid = pyvista.UnstructuredGrid(cells, np.array(positions))
    if vectors is not None:
        grid["vectors"] = vectors
    return grid.extract_surface(
        nonlinear_subdivision=2 if len(facets) < _FINE else 1, algorithm="dataset_surface"
    )


def part_solid(cells: Ints, points: Floats) -> Any:
    """Elements (ne, 10) as VTK's quadratic tetrahedra, a pyvista.UnstructuredGrid."""
    import pyvista

    return pyvista.UnstructuredGrid({pyvista.CellType.QUADRATIC_TETRA: cells}, points.copy())


def sharp_edges(surface: Any) -> Any:
    """The edges at which a surface turns by more than 30 degrees."""
    return surface.extract_feature_edges(
        feature_angle=30, boundary_edges=False, non_manifold_edges=False, manifold_edges=False
    )


def cut_open(surface: Any, solid: Any) -> tuple[Any, Any]:
    """Take the quarter y < 0, z > 0 away, and close the cut.

    Parameters
    ----------
    surface : pyvista.PolyData
        The closed surface of a part.
    solid : pyvista.UnstructuredGrid
        Its elements.

    Returns
    -------
    cut, edges : pyvista.PolyData
        What is left of the surface, with the faces of the cut; and the edges of both.
    """
    import pyvista

    def below(shape: Any, axis: str, inverted: bool) -> Any:
        return shape.clip(axis, origin=(0.0, 0.0, 0.0), invert=inverted)

    def outside(shape: Any) -> Any:
        near = below(shape, "y", True)
        return below(shape, "y", False).append_polydata(below(near, "z", True))

    # next to the planes, where no node can lie exactly
    upright = below(solid.slice("y", origin=(0.0, 1e-7, 0.0)), "z", False)
    level = below(solid.slice("z", origin=(0.0, 0.0, -1e-7)), "y", True)
    faces = [face.clean() for face in (upright, level) if face.n_cells]
    rims = [
        face.extract_feature_edges(
            boundary_edges=True, feature_edges=False, non_manifold_edges=False, manifold_edges=False
        )
        for face in faces
    ]
    edges = pyvista.merge([outside(sharp_edges(surface)), *rims])
    return outside(smooth(surface)).append_polydata(*faces), edges


def smooth(surface: Any) -> Any:
    """The surface with normals that are smooth but for its edges."""
    return surface.compute_normals(feature_angle=30, split_vertices=True, auto_orient_normals=False)
