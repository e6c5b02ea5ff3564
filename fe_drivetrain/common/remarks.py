"""What the program says of its work with ``-v`` alone: the loggers under ``fe_drivetrain``."""

from __future__ import annotations

import logging
import os
import sys
from typing import TextIO

VERBOSE_VARIABLE = "FE_DRIVETRAIN_VERBOSE"
"""Environment variable that has processes of this program say as much as it does itself."""

_ALL = logging.getLogger("fe_drivetrain")


class _ToStandardError(logging.StreamHandler[TextIO]):
    """To standard error as it is when something is said: a display may have replaced it."""

    def emit(self, record: logging.LogRecord) -> None:
        self.stream = sys.stderr
        super().emit(record)


def show_remarks() -> None:
    """Write remarks on standard error, one a line, and have processes started here do so, too."""
    os.environ[VERBOSE_VARIABLE] = "1"
    if not any(isinstance(handler, _ToStandardError) for handler in _ALL.handlers):
        handler = _ToStandardError(sys.stderr)
        handler.setFormatter(logging.Formatter("fe-drivetrain: %(message)s"))
        _ALL.addHandler(handler)
    _ALL.setLevel(logging.INFO)


def show_remarks_if_asked() -> None:
    """`show_remarks` in a process whose program was started with ``-v``."""
    if os.environ.get(VERBOSE_VARIABLE):
        show_remarks()
