"""Nonlinear bearings in a linear body: one equilibrium of shaft, housings and rollers.

In: a condensed shaft of any level, bearings, loads. Out: their loads and motions, roller by roller.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
