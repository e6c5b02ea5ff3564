"""A user's superelement, read in a process of limited memory, time and output."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.reading import require_readable
from fe_drivetrain.common.stiffness_bands import StiffnessBands
from fe_drivetrain.export.files import format_module, read_superelement
from fe_drivetrain.export.formats.labelled_matrices import TAKEN_AS_IT_IS, Naming
from fe_drivetrain.export.superelement import Origin, Superelement
from fe_drivetrain.foreign.reading import LIMITS, Limits, read_in_process

_MATRICES = ("positions", "stiffness", "mass")


def read_limited(
    path: str | Path, format: str, limits: Limits = LIMITS, naming: Naming = TAKEN_AS_IT_IS
) -> Superelement:
    """Read a superelement in a process of its own: a damaged or huge file ends in one sentence.

    Parameters
    ----------
    path : str or Path
        The file.
    format : str
        A name of `FORMATS`.
    limits : Limits
        What reading may take.
    naming : Naming
        What a file of another program leaves open.

    Raises
    ------
    InputError
        As `read_superelement`, or reading takes more than the limits.
    """
    format_module(format)
    action = f"{__name__}:arrays_of"
    if naming.grids:  # the process has a folder of its own
        require_readable(naming.grids, "Nastran bulk data")
    whole = replace(naming, grids=naming.grids and str(Path(naming.grids).resolve()))
    request = {"format": format, "named": str(path), "naming": vars(whole)}
    found = read_in_process(action, path, request, limits)
    stated: dict[str, Any] = json.loads(str(found["stated"]))
    band = stated["band"]
    return Superelement(
        stated["name"],
        tuple(stated["points"]),
        found["positions"],
        found["stiffness"],
        found.get("mass"),
        stated["supported"],
        None if band is None else StiffnessBands(**band),
        Origin(**stated["origin"]),
        stated["bound"],
        stated["rollers"],
    )


def arrays_of(request: dict[str, Any]) -> dict[str, Any]:
    """What the limited process does: a superelement as arrays, and all else as JSON."""
    said = request["naming"]
    naming = Naming(**{**said, "points": tuple(said["points"])})
    try:
        element = read_superelement(request["file"], request["format"], naming)
    except InputError as error:
        # of links the process knows what they lead to, the user the name that was given
        raise InputError(str(error).replace(request["file"], request["named"])) from error
    stated = {
        "name": element.name,
        "points": element.points,
        "supported": element.supported,
        "band": None if element.band is None else vars(element.band),
        "origin": vars(element.origin),
        "bound": element.bound,
        "rollers": element.rollers,
    }
    matrices = {key: getattr(element, key) for key in _MATRICES}
    kept = {key: matrix for key, matrix in matrices.items() if matrix is not None}
    return {**kept, "stated": np.array(json.dumps(stated))}
