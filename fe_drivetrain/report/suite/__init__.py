"""Validation cases: what one is, how it runs into a folder, and many side by side.

In: scripts below ``cases/``. Out: result folders that appear whole or not at all.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
