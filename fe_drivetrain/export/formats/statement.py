"""Statement of a superelement in text formats, beside its matrices: comments "key: value".

Frame, units, points, order of degrees of freedom, source, uncertainty and checks stand in the file
as a person reads them, and are read back from there.
"""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path

import numpy as np

from fe_drivetrain.common import regular_files
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import MOTIONS
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.reading import unreadable
from fe_drivetrain.common.stiffness_bands import KINDS, StiffnessBands
from fe_drivetrain.export.superelement import FRAME, UNITS, Origin, Superelement

_WIDTH = 78
_NUMBER = re.compile(r"[-+0-9.eE]+")


def statement(element: Superelement) -> dict[str, str]:
    """The statement of a superelement, by key; numbers keep every digit."""
    origin = element.origin
    band = "not known" if element.band is None else f"{element.band} of the stiffness"
    entries = {
        "superelement": element.name,
        **element.of_units,
        "band": band,
        "program": origin.program,
        "scene": origin.scene,
        "scene hash": origin.scene_hash,
        "level": origin.level,
        "mesh": origin.mesh,
        "frame": FRAME,
        "units": UNITS,
        "degrees_of_freedom": f"{' '.join(MOTIONS)} of each point, in this order",
        "supports": "in the stiffness" if element.supported else "none: the body is free",
    }
    for number, (name, position) in enumerate(zip(element.points, element.positions, strict=True)):
        x, y, z = position.tolist()
        entries[f"point {number + 1}"] = f"{name} at {x!r} {y!r} {z!r} m"
    for name, value in element.checks().items():
        entries[f"check, {name}"] = f"{value:.2g} of a unit diagonal"
    return {key: " ".join(value.split()) for key, value in entries.items()}


def comment_lines(entries: Mapping[str, str], mark: str) -> Iterator[str]:
    """The statement as comments after a ``mark``; three more blanks go on with a line."""
    for key, value in entries.items():
        yield from textwrap.wrap(
            f"{key}: {value}".rstrip(),
            _WIDTH,
            initial_indent=f"{mark} ",
            subsequent_indent=f"{mark}    ",
            break_long_words=False,
            break_on_hyphens=False,
        )


def commented(lines: Iterable[str], mark: str) -> dict[str, str]:
    """The statement in the comments of a file; other comments are left out."""
    entries: dict[str, str] = {}
    key = ""
    for line in lines:
        if not line.startswith(f"{mark} "):
            key = ""
            continue
        text = line[len(mark) + 1 :].rstrip()
        if text.startswith("   ") and key:
            entries[key] = f"{entries[key]} {text.strip()}".strip()
            continue
        key, colon, value = text.partition(":")
        key = key if colon and not text.startswith(" ") else ""
        if key:
            entries[key] = value.strip()
    return entries


def element_of(
    path: Path, entries: Mapping[str, str], stiffness: Floats, mass: Floats | None
) -> Superelement:
    """The superelement that a statement and its matrices are.

    Raises
    ------
    InputError
        A key is missing, or a value is not what it is to be.
    """
    try:
        points, positions = _points(entries)
        band = _band(entries["band"])
        supported = {"in the stiffness": True, "none: the body is free": False}[entries["supports"]]
        keys = ("scene", "scene hash", "level", "mesh", "program")
        return Superelement(
            entries["superelement"],
            points,
            positions,
            stiffness,
            mass,
            supported,
            band,
            Origin(*(entries[key] for key in keys)),
            # of bearing units alone, and not in earlier files
            entries.get("bound", ""),
            entries.get("rollers", ""),
        )
    except KeyError as error:
        raise InputError(
            f"{path} does not state {error}: it is no superelement, or cut off"
        ) from error
    except (ValueError, IndexError) as error:
        raise InputError(f"{path} is no superelement: {error}") from error
    except InputError as error:
        raise InputError(f"{path}: {error}") from error


def _band(stated: str) -> StiffnessBands | None:
    """The band that is stated; earlier files have one number for all."""
    if stated == "not known":
        return None
    words = stated.replace(",", "").split()
    if words[0] not in KINDS:
        return StiffnessBands.uniform(float(words[0]))
    found = dict(zip(words[::2], words[1::2], strict=False))
    return StiffnessBands(*(float(found[kind]) for kind in KINDS))


def _points(entries: Mapping[str, str]) -> tuple[tuple[str, ...], Floats]:
    names: list[str] = []
    positions: list[list[float]] = []
    while f"point {len(names) + 1}" in entries:
        name, _, place = entries[f"point {len(names) + 1}"].rpartition(" at ")
        names.append(name)
        positions.append([float(value) for value in _NUMBER.findall(place)[:3]])
    if not names:
        raise KeyError("point 1")
    return tuple(names), np.array(positions)


def dof_labels(element: Superelement) -> list[str]:
    """The 6 n degrees of freedom by name, as in "hub ux"."""
    return [f"{point} {dof}" for point in element.points for dof in MOTIONS]


def text_of(path: Path, kind: str) -> str:
    """The text of a file.

    Raises
    ------
    InputError
        It cannot be read, or is not text.
    """
    try:
        text = regular_files.text_of(path)
    except (OSError, ValueError) as error:
        raise unreadable(path, kind, error) from error
    if "\0" in text:
        raise InputError(f"{path} is no {kind}: it is not text")
    return text
