"""How far two models, two meshes or two histories are from each other.

In: arrays. Out: RMSE, mean error, correlation, observed order, grid convergence index.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
