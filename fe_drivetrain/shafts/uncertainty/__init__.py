"""Effect of uncertain inputs on all that is reported of a scene.

In: a scene with spreads. Out: sensitivities, bands, shares of variance.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
