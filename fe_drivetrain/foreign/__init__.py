"""Parts from files of other programs: STEP solids and meshes, picked, placed, meshed and held.

In: files, read in a process of limited memory and time, and what a scene says of them. Out: meshes
with named faces, ties to bearings, bolts as springs, and lists of seats to pick from.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
