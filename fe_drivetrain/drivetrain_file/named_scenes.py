"""The scene or component that a user names: a file, or one of the library."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from fe_drivetrain.drivetrain_file.component import Component
    from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
    from fe_drivetrain.drivetrain_file.scene import Scene


def read_drivetrain(name: str | Path, changes: Mapping[str, Any] | None = None) -> Drivetrain:
    """Read a drivetrain from a file, or one that comes with the package.

    Parameters
    ----------
    name : str or Path
        A YAML file, or one of `library_names`.
    changes : mapping or None
        Values by dotted key, as ``{"shaft.sections.0.inner_diameter": 0.1}``; see `read_scene`.

    Returns
    -------
    Drivetrain
        The drivetrain, checked: a `Scene` where its main shaft has sections, else a
        `LumpedDrivetrain`.

    Raises
    ------
    InputError
        There is no such scene, it is a component, a value is wrong, or a carrier that it names is
        not there or does not fit.
    """
    from fe_drivetrain.drivetrain_file.carriers import carriers_of
    from fe_drivetrain.drivetrain_file.reading import (
        drivetrain_of_file,
        library_text,
        parse_drivetrain,
    )

    found = (
        drivetrain_of_file(name, changes)
        if _is_file(name)
        else parse_drivetrain(library_text(str(name)), changes, str(name))
    )
    carriers_of(found)
    return found


def named_scene(name: str | Path, changes: Mapping[str, Any] | None = None) -> Scene:
    """Read a drivetrain whose main shaft has sections; see `read_drivetrain`.

    Raises
    ------
    InputError
        Its main shaft is given by one diameter or its torsional stiffness alone, too.
    """
    from fe_drivetrain.drivetrain_file.reading import with_sections

    return with_sections(read_drivetrain(name, changes), str(name))


def named_drivetrain_or_component(
    name: str, changes: Mapping[str, Any] | None = None
) -> Drivetrain | Component:
    """The drivetrain or component in a file or of the library; see `read_drivetrain`."""
    from fe_drivetrain.drivetrain_file.reading import (
        is_component,
        library_text,
        parse_component,
        read_component,
        scene_file_text,
    )

    of_file = _is_file(name)
    text = scene_file_text(name) if of_file else library_text(name)
    if not is_component(text):
        return read_drivetrain(name, changes)
    return read_component(name, changes) if of_file else parse_component(text, changes, name)


def _is_file(name: str | Path) -> bool:
    return Path(name).suffix != "" or Path(name).exists()
