"""Torsional drivetrains: inertias and springs in a chain, gear tables, modes, damping.

In: a table of shafts and gear stages. Out: frequencies, mode shapes, responses.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
