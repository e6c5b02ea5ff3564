"""Parametric drivetrain parts, built with gmsh's OpenCASCADE kernel; no mechanics in here."""

from .assembly import NO_BANDS, build
from .bearing import Bearing
from .body import BodySizes
from .bolt_preload import Thread, assembly_preload, coarse_thread, yield_strength
from .element_sizes import MeshSizes, size_name
from .fits import WIDEST, Band, check_bands, check_parts, refuse_millimetres
from .foreign_housing import (
    AnyHousing,
    Bolts,
    CondensedHousing,
    ForeignFile,
    ForeignHousing,
    FurtherPart,
    Pick,
    Tie,
)
from .gearbox_housing import GearboxHousing
from .housing import Housing
from .local_sizes import LocalSizes, apply_local_sizes
from .masses import Solid, bearing_solid, unit_solids
from .part import LENGTH_TOLERANCE, Assumption, Part
from .planet_carrier import PlanetCarrier
from .sample_parts import bedplate, write_sample
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
    "ForeignFile",
    "ForeignHousing",
    "FurtherPart",
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
    "Thread",
    "Tie",
    "apply_local_sizes",
    "assembly_preload",
    "bearing_solid",
    "bedplate",
    "build",
    "check_bands",
    "check_parts",
    "coarse_thread",
    "gmsh_session",
    "refuse_millimetres",
    "size_name",
    "unit_solids",
    "within_walls",
    "write_sample",
    "write_step",
    "yield_strength",
]
