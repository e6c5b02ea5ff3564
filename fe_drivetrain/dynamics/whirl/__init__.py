"""Whirl of shafts on bearings: modes over the speed, critical speeds, unbalance, stability.

In: round elements, discs, bearings whose stiffness may change with the speed, damping that turns
with the shaft. Out: eigenvalues with their sense of whirl, critical speeds, steady whirl.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
