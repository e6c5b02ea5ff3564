"""Other finite-element programs on the same problem: each in a process of its own, on a leash.

In: nodes, elements, one face held and one moved rigidly. Out: stiffness, time and memory of each
step, or why there is none.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
