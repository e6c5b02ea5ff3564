"""The command line: what each command takes, does and prints, and the pages of advice.

In: words of a shell. Out: files, lines on a terminal, an exit status.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
