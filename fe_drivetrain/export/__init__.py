"""Stiffness for other models: superelements, their file formats, and other programs' inputs.

In: scenes and components at any level. Out: files, and models of ROSS, Exudyn, CalculiX.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
