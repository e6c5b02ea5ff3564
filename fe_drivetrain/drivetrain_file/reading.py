"""Scenes and components from YAML files, from the library, and with changed values."""

from __future__ import annotations

from collections.abc import Mapping
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Any

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.near_words import did_you_mean
from fe_drivetrain.common.reading import (
    changed,
    parse_mapping,
    read_text,
    set_by_key,
    validated,
)
from fe_drivetrain.drivetrain_file.component import COMPONENTS, Component, SomeComponent
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.gate import check_files
from fe_drivetrain.drivetrain_file.lumped import LumpedDrivetrain
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.geometry import Bearing

GEARBOX_MODELS = (".rexs", ".rexs.xml", ".rexsj", ".rexs.json", ".rexsz", ".rexs.zip")
"""Endings of gearbox models in REXS."""
BY_STIFFNESS = ("torsion", "outer", "kind")
"""Keys of a main shaft that is given without sections."""


def read_scene(path: str | Path, changes: Mapping[str, Any] | None = None) -> Scene:
    """Read a scene from a YAML file.

    Parameters
    ----------
    path : str or Path
        A file of at most 1 MB, plain YAML without anchors, aliases or tags.
    changes : mapping, optional
        Values by dotted key that replace those of the file, as in
        ``{"shaft.sections.0.inner_diameter": 0.2}``; a bearing unit is addressed by its
        bearing's name. Files that it names are looked for in the scene's folder.

    Returns
    -------
    Scene

    Raises
    ------
    InputError
        The file cannot be read, is not such YAML, does not describe a scene, or a file that it
        names is not there.
    """
    return with_sections(drivetrain_of_file(path, changes), str(path))


def drivetrain_of_file(path: str | Path, changes: Mapping[str, Any] | None = None) -> Drivetrain:
    """Read a drivetrain from a YAML file, its main shaft with sections or not; see `read_scene`."""
    data = _changed_mapping(scene_file_text(path), changes, str(path))
    _beside(Path(path).parent, data.get("bearing_units"))
    _carriers_beside(Path(path).parent, data.get("gearbox"))
    found = _drivetrain(data, str(path))
    if isinstance(found, Scene):
        check_files(found.bearing_units)
    return found


def scene_file_text(path: str | Path) -> str:
    """Text of a scene's or component's file.

    Raises
    ------
    InputError
        It cannot be read, or is a gearbox model by its name.
    """
    if str(path).lower().endswith(GEARBOX_MODELS):
        raise InputError(
            f"{path} is a gearbox model in REXS, and no drivetrain's file: make one of it by "
            "fe-drivetrain new, which begins from such a model"
        )
    return read_text(path, "scene")


def with_sections(drivetrain: Drivetrain, source: str) -> Scene:
    """The drivetrain as a scene.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain.
    source : str
        Where it comes from, for messages.

    Raises
    ------
    InputError
        Its main shaft is given by one diameter or its torsional stiffness alone.
    """
    if isinstance(drivetrain, Scene):
        return drivetrain
    raise InputError(
        f"{source}: the main shaft has no sections, which this needs: give shaft.front and "
        "shaft.sections, bearing_units and gearbox.stiffness, as fe-drivetrain new writes them"
    )


def parse_scene(
    text: str, changes: Mapping[str, Any] | None = None, source: str = "scene"
) -> Scene:
    """A scene from YAML text; see `read_scene`."""
    return with_sections(parse_drivetrain(text, changes, source), source)


def parse_drivetrain(
    text: str, changes: Mapping[str, Any] | None = None, source: str = "drivetrain"
) -> Drivetrain:
    """A drivetrain from YAML text, its main shaft with sections or not; see `read_scene`."""
    return _drivetrain(_changed_mapping(text, changes, source), source)


def _drivetrain(data: dict[str, Any], source: str) -> Drivetrain:
    for kind in COMPONENTS:
        if kind in data:
            raise InputError(
                f"{source} is a component, for it has {kind!r}, and no scene of a shaft: "
                "components can be exported, and have cases of their own"
            )
    shaft = data.get("shaft")
    by_stiffness = isinstance(shaft, dict) and any(key in shaft for key in BY_STIFFNESS)
    return validated(LumpedDrivetrain if by_stiffness else Scene, data, source)


def scene_text(drivetrain: Drivetrain) -> str:
    """A drivetrain as a file: plain YAML that `parse_drivetrain` reads as the same."""
    import yaml

    data = drivetrain.model_dump(mode="json", exclude_unset=True)
    return yaml.safe_dump(data, sort_keys=False, allow_unicode=True)


def library_scene(name: str) -> Scene:
    """A scene that comes with the package, by name: "main_bearing_spherical", "..._bonded"."""
    return parse_scene(library_text(name), source=name)


def change_scene(scene: Scene, changes: Mapping[str, Any]) -> Scene:
    """A copy of the scene with other values by dotted key; see `read_scene`."""
    return changed(scene, changes, "scene")


def read_component(path: str | Path, changes: Mapping[str, Any] | None = None) -> Component:
    """Read a component from a YAML file.

    Parameters
    ----------
    path : str or Path
        A file of at most 1 MB, plain YAML without anchors, aliases or tags.
    changes : mapping, optional
        Values by dotted key that replace those of the file, as in
        ``{"gearbox_housing.arm_z": -0.1}``.

    Returns
    -------
    Component

    Raises
    ------
    InputError
        The file cannot be read, is not such YAML, or does not describe a component.
    """
    return parse_component(scene_file_text(path), changes, source=str(path))


def parse_component(
    text: str, changes: Mapping[str, Any] | None = None, source: str = "component"
) -> Component:
    """A component from YAML text; see `read_component`."""
    data = _changed_mapping(text, changes, source)
    kinds = [kind for kind in COMPONENTS if kind in data]
    if len(kinds) != 1:
        raise InputError(
            f"{source} must have one of the keys {', '.join(COMPONENTS)}, not "
            f"{' and '.join(kinds) or 'none of them'}: the key determines the kind of component"
        )
    return validated(COMPONENTS[kinds[0]], data, source)


def library_component(name: str) -> Component:
    """A component that comes with the package: "gearbox_housing" or "planet_carrier"."""
    return parse_component(library_text(name), source=name)


def change_component(component: SomeComponent, changes: Mapping[str, Any]) -> SomeComponent:
    """A copy with other values by dotted key; see `read_component`."""
    return changed(component, changes, "component")


def is_component(text: str) -> bool:
    """Whether YAML text describes a component; False of text that cannot be read at all."""
    try:
        data = parse_mapping(text, "text")
    except InputError:
        return False
    return any(kind in data for kind in COMPONENTS)


def library_text(name: str) -> str:
    """The text of a file of the library, by its name without ending."""
    known = _library()
    if name not in known:
        near = did_you_mean(name, known) or f"use one of {', '.join(known)};"
        raise InputError(f"no scene {name!r} in the library: {near} a file of yours ends in .yaml")
    return known[name].read_text("utf-8")


def library_names() -> tuple[str, ...]:
    """Names of the drivetrains that come with the package, for `read_drivetrain`."""
    return tuple(name for name in _library() if not is_component(library_text(name)))


def _library() -> dict[str, Traversable]:
    """Files of scenes and components that come with the package, by name."""
    folder = files("fe_drivetrain.geometry") / "library"
    return {
        file.name.removesuffix(".yaml"): file
        for file in sorted(folder.iterdir(), key=lambda file: file.name)
    }


def _changed_mapping(text: str, changes: Mapping[str, Any] | None, source: str) -> dict[str, Any]:
    data = parse_mapping(text, source)
    _name_bearings(data.get("bearing_units"))
    for key, value in (changes or {}).items():
        set_by_key(data, key, value)
    return data


def _beside(folder: Path, units: Any) -> None:
    """Take the names of files in a scene's file as from its own folder."""
    for unit in units if isinstance(units, list) else []:
        if not isinstance(unit, dict):
            continue
        parts = unit.get("parts")
        for part in (unit.get("housing"), *(parts if isinstance(parts, list) else ())):
            for key in ("step", "mesh"):
                if isinstance(part, dict) and isinstance(part.get(key), str):
                    part[key] = str(folder / part[key])


def _carriers_beside(folder: Path, gearbox: Any) -> None:
    """Take the names of files of carriers as from the folder of the drivetrain's file."""
    stages = gearbox.get("stages") if isinstance(gearbox, dict) else None
    for stage in stages if isinstance(stages, list) else []:
        carrier = stage.get("carrier") if isinstance(stage, dict) else None
        name = carrier.get("component") if isinstance(carrier, dict) else None
        if isinstance(carrier, dict) and isinstance(name, str) and Path(name).suffix:
            carrier["component"] = str(folder / name)


def _name_bearings(units: Any) -> None:
    """Write out the default name of bearings without one, so that changes can go by it."""
    for unit in units if isinstance(units, list) else []:
        bearing = unit.get("bearing") if isinstance(unit, dict) else None
        if isinstance(bearing, dict):
            bearing.setdefault("name", Bearing.model_fields["name"].default)
