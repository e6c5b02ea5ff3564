"""Elasticity of solids: meshes, operators, interfaces of parts, solvers, bodies of revolution.

In: geometry and materials, constraints, loads. Out: displacements, stiffnesses, diagnostics.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
