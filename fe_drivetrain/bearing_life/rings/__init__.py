"""Flexible rings: compliance of a bearing's races under its rollers.

In: a housing of revolution, or that of a scene, and a bearing. Out: its compliance at the rollers.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
