"""Figures from Python in the style of the pages, as Plotly figures.

In: arrays. Out: figures that show in a notebook, and can be changed and saved as any other.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
