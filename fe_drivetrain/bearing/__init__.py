"""Rolling bearings from the inside: rollers, races and laminae between rigid rings.

In: geometry from a catalogue, loads on the inner ring. Out: displacements, roller loads, stiffness.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
