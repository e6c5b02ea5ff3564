"""Studies: each is a function that takes a drivetrain and what is asked, and returns a Result.

In: scenes, load histories, options as plain values. Out: frozen results: numbers with units and
bands, answer and checks. No page, no terminal, no folder: `pages` show, cases judge.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
