"""The scene or component that a user names: a file, or one of the library."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from fe_drivetrain.drivetrain_file.component import Component
    from fe_drivetrain.drivetrain_file.scene import Scene


def named_scene(name: str, changes: Mapping[str, Any]) -> Scene:
    """The scene in a file or of the library, with changes by the user.

    Parameters
    ----------
    name : str
        A file, or a name of the library.
    changes : mapping
        Values by dotted key.

    Returns
    -------
    Scene

    Raises
    ------
    InputError
        There is no such scene, it is a component, or a value is wrong.
    """
    from fe_drivetrain.drivetrain_file.reading import library_text, parse_scene, read_scene

    if _is_file(name):
        return read_scene(name, changes)
    return parse_scene(library_text(name), changes, name)


def named_scene_or_component(name: str, changes: Mapping[str, Any]) -> Scene | Component:
    """The scene or component in a file or of the library; see `named_scene`."""
    from fe_drivetrain.common.reading import read_text
    from fe_drivetrain.drivetrain_file.reading import is_component, library_text, parse_component

    text = read_text(name, "scene") if _is_file(name) else library_text(name)
    return (
        parse_component(text, changes, name) if is_component(text) else named_scene(name, changes)
    )


def _is_file(name: str) -> bool:
    return Path(name).suffix != "" or Path(name).exists()
