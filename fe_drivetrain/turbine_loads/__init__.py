"""Hub loads, from files or from a turbine that moves, and what histories of them amount to.

In: load files, wind, a turbine. Out: histories of hub loads, spectra, equivalent loads.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
