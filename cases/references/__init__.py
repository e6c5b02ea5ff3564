"""Exact solutions and test solids, to verify this program or any other with.

In: dimensions, materials, loads. Out: exact answers from theory, and meshes of bodies whose answer
is known; published machines that cases of several groups solve. Each module is one solution, one
family of bodies, or one machine.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
