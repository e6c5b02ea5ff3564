"""Meshes and what an element is: generation, quality, checks, refinement, files.

In: geometry. Out: points, cells, named parts and faces.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
