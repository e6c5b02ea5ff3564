"""Involute gears alone: geometry, planets' phases, stiffness of a mesh.

In: teeth, module, angles, profile shifts, centre distance. Out: circles, path of contact, contact
ratios, stiffness along the line of action.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
