"""Lives of bearings: ratings, rollers between elastic rings, bearings coupled with the shaft.

In: catalogue entries, reactions over time. Out: loads of rollers, lives.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
