"""STEP files read with the healing that they are known to need: it is found once for a file.

Whether a solid is sound is seen by meshing it, which takes as long as the mesh that is wanted.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from fe_drivetrain.common.cache import user_cache
from fe_drivetrain.common.made_by import machine, source_hash
from fe_drivetrain.foreign.reading import Arrays, read_in_process


def read_step(action: str, path: str | Path, request: Mapping[str, Any]) -> Arrays:
    """Have a STEP file read by a process of its own, and remember how it was healed.

    Parameters
    ----------
    action : str
        Of `read_in_process`.
    path : str or Path
        The file.
    request : Mapping[str, Any]
        What else the action needs.

    Returns
    -------
    dict
        Arrays by name.

    Raises
    ------
    InputError
        As of `read_in_process`.
    """
    content = {
        "healing of": file_digest(str(path)),
        "part": request.get("part"),
        "smallest detail": request["smallest_detail"],
        "made by": reader_versions(),
    }
    cache = user_cache()
    kept = cache.load("figures", content)
    known = {} if kept is None else {"healed": json.loads(str(kept["healed"]))}
    found = read_in_process(action, path, {**request, **known})
    if kept is None:
        healed = json.loads(str(found["survey"]))["healed"]
        cache.keep("figures", content, {"healed": np.array(json.dumps(healed))})
    return found


@lru_cache(maxsize=256)
def _digest(path: str, modified: int, size: int) -> str:
    with open(path, "rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def file_digest(path: str) -> str:
    """SHA-256 of a file; "" where there is none.

    Parameters
    ----------
    path : str
        The file.
    """
    try:
        found = Path(path).stat()
        return _digest(str(path), found.st_mtime_ns, found.st_size)
    except OSError:
        return ""


def reader_versions() -> dict[str, str]:
    """Versions of all that reads and meshes a file, and of the machine that it runs on."""
    import gmsh
    import meshio

    code = source_hash({"fe_drivetrain.geometry": None, "fe_drivetrain.foreign": None})
    versions = {"gmsh": gmsh.__version__, "meshio": meshio.__version__, "numpy": np.__version__}
    return versions | {"machine": machine(), "code": code}
