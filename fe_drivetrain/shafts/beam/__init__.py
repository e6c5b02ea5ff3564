"""Beam theory: tapered Timoshenko shafts, frames in space, closed forms of one main bearing.

In: sections, supports, loads. Out: reactions, deflections, 12x12 stiffness.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
