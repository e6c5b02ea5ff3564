"""pyNastran, where it is installed: a second reader of what is written here."""

from __future__ import annotations

from importlib import import_module
from typing import Any

import numpy as np

from fe_drivetrain.common.errors import MissingToolError


def pynastran(module: str) -> Any:
    """A module of pyNastran, as in "bdf.bdf".

    Raises
    ------
    MissingToolError
        It is not installed, or does not go with this numpy.
    """
    # its version 1.4 takes numpy.in1d at import, which numpy 2.4 has no more: isin is the same of
    # vectors, and all that is read here does without
    missing = {} if hasattr(np, "in1d") else {"in1d": np.isin}
    vars(np).update(missing)
    try:
        return import_module(f"pyNastran.{module}")
    except (ImportError, AttributeError) as error:
        raise MissingToolError(
            f"this needs pyNastran, which cannot be loaded ({error}): install it, into an "
            "environment of its own since it needs numpy 1, with pip install "
            '"fe-drivetrain[consumers]"'
        ) from error
    finally:
        for name in missing:
            del vars(np)[name]
