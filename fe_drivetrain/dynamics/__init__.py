"""Drivetrains in three dimensions: rigid bodies with six degrees of freedom, and springs.

In: bodies, shafts, bearings, gear meshes, superelements. Out: system matrices, modes, responses.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
