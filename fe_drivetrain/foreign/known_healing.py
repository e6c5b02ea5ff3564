"""STEP files read with the healing that they are known to need: it is found once for a file.

Whether a solid is sound is seen by meshing it, which takes as long as the mesh that is wanted.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import replace
from functools import cache as once
from pathlib import Path
from typing import Any

import numpy as np

from fe_drivetrain.common.cache import user_cache
from fe_drivetrain.common.provenance import file_digest, machine, source_hash, versions
from fe_drivetrain.foreign.reading import LIMITS, Arrays, Limits, read_in_process


def read_step(action: str, path: str | Path, request: Mapping[str, Any]) -> Arrays:
    """Have a STEP file read by a process of its own, and remember how it was healed.

    Parameters
    ----------
    action : str
        Action of `read_in_process`.
    path : str or Path
        Path of the STEP file.
    request : Mapping[str, Any]
        Further values that the action needs.

    Returns
    -------
    dict
        Arrays by name.

    Raises
    ------
    InputError
        The file cannot be read, see `read_in_process`.
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
    limits = _to_look(path) if action == "look" else LIMITS
    found = read_in_process(action, path, {**request, **known}, limits)
    if kept is None:
        healed = json.loads(str(found["survey"]))["healed"]
        cache.keep("figures", content, {"healed": np.array(json.dumps(healed))})
    return found


def _to_look(path: str | Path) -> Limits:
    """Limits on looking at a file: a sound one takes some twenty seconds a megabyte at most."""
    megabytes = Path(path).stat().st_size / 1e6 if Path(path).is_file() else 0.0
    return replace(LIMITS, seconds=min(LIMITS.seconds, round(120 * (1 + megabytes))))


@once
def reader_versions() -> dict[str, Any]:
    """All that reads and meshes a file: packages, sources, and the machine that it runs on."""
    code = source_hash({"fe_drivetrain.geometry": None, "fe_drivetrain.foreign": None})
    packages = versions(("gmsh", "meshio", "numpy"))
    return {"packages": packages, "machine": machine(), "code": code}
