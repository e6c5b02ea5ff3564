"""Parametric drivetrain parts, built with gmsh's OpenCASCADE kernel; no mechanics in here."""

from .assembly import MeshSizes, build, size_name
from .bearing import Bearing
from .housing import Housing
from .local_sizes import LocalSizes, apply_local_sizes
from .part import Assumption, Part
from .session import gmsh_session
from .shaft import Flange, Section, Shaft

__all__ = [
    "Assumption",
    "Bearing",
    "Flange",
    "Housing",
    "LocalSizes",
    "MeshSizes",
    "Part",
    "Section",
    "Shaft",
    "apply_local_sizes",
    "build",
    "gmsh_session",
    "size_name",
]
