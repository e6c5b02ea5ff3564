"""The elastic operator of a solid: stiffness, mass, loads and stresses of its elements.

In: points, cells, Lame's constants. Out: sparse matrices, load vectors, stresses.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
