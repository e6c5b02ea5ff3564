"""Parametric drivetrain parts, built with gmsh's OpenCASCADE kernel; no mechanics in here."""

from .assembly import NO_BANDS, build
from .bearing import Bearing
from .body import BodySizes
from .element_sizes import MeshSizes, size_name
from .fits import WIDEST, Band, check_bands, check_parts, refuse_millimetres
from .foreign_housing import AnyHousing, Bolts, CondensedHousing, ForeignHousing, Pick
from .gearbox_housing import GearboxHousing
from .housing import Housing
from .local_sizes import LocalSizes, apply_local_sizes
from .masses import Solid, bearing_solid, unit_solids
from .part import LENGTH_TOLERANCE, Assumption, Part
from .planet_carrier import PlanetCarrier
from .sample_parts import write_sample
from .session import gmsh_session
from .shaft import Flange, Section, Shaft
from .step_files import write_step
from .walls import within_walls

__all__ = [
    "LENGTH_TOLERANCE",
    "NO_BANDS",
    "WIDEST",
    "AnyHousing",
    "Assumption",
    "Band",
    "Bearing",
    "BodySizes",
    "Bolts",
    "CondensedHousing",
    "Flange",
    "ForeignHousing",
    "GearboxHousing",
    "Housing",
    "LocalSizes",
    "MeshSizes",
    "Part",
    "Pick",
    "PlanetCarrier",
    "Section",
    "Shaft",
    "Solid",
    "apply_local_sizes",
    "bearing_solid",
    "build",
    "check_bands",
    "check_parts",
    "gmsh_session",
    "refuse_millimetres",
    "size_name",
    "unit_solids",
    "within_walls",
    "write_sample",
    "write_step",
]
