"""Parametric drivetrain parts, built with gmsh's OpenCASCADE kernel; no mechanics in here.

In: sizes of parts. Out: parts that have checked themselves, solids in gmsh, STEP files.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
