"""The main shaft on its supports, from Timoshenko beam to solids, and the levels side by side.

In: a drivetrain file, hub loads. Out: reactions, stiffnesses, errors of each level, their bands.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
