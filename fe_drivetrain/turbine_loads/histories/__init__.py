"""What is in load histories: statistics, cycles, time at level, spectra, what differs between two.

In: channels against time. Out: counts, equivalent loads, distributions, each with its rule.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
