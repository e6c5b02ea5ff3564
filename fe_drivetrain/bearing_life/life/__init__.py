"""Rating life of rolling bearings, from what each lamina carries to years at a site.

In: rows of a bearing with the loads of their laminae, load ratings, lubricant. Out: lives.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
