"""The command line: options, messages, files and exit statuses of each command.

In: words typed in a shell. Out: files, lines on a terminal, and an exit status.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
