"""The assembled model of a scene, unit-load responses, bearing stiffness.

In: a scene and its mesh. Out: reactions and displacements of unit loads; K_R.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
