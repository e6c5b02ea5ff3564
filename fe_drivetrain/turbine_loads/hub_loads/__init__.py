"""Histories of the six hub loads: read from files, or computed by a surrogate of a turbine.

In: OpenFAST and CSV files, or a turbine and its winds. Out: `LoadHistory`.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
