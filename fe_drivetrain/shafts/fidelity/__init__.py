"""One scene at several levels: statics, beam, meridian, solids; and which level is enough.

In: a scene or a component. Out: reactions and stiffness of each level, with time and error.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
