"""What every room needs: errors, types of arrays, files that appear whole, the cache, processes.

In: nothing of the project. Out: small helpers without mechanics.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
