"""What a user describes: parts, materials, bearing units, supports and loads, read and checked.

In: YAML text and changes of single keys. Out: frozen `Scene` and `Component` objects.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
