"""Results of studies on pages, for commands and cases: sections, charts, tables, pictures.

In: the result of a study, a run whose folder takes pictures, and a page. Out: sections of the page.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
