"""Results as data, and the pages, charts and pictures made from them.

In: what a case found. Out: results.json, report.html, index.html, JUnit XML.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
