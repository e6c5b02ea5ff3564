"""Torsion of a drivetrain in a turbine file, for WISDEM or for windIO.

WISDEM computes spring and damper from its own shafts, and takes others from
``components.drivetrain.spring_constant_user`` and ``damping_coefficient_user``. (Its schema lists
them a level deeper, in ``elastic_properties``, where WISDEM 4.2 does not look; windIO's own check
refuses them.) windIO's files hold the result in ``components.drivetrain.elastic_properties``, as
``spring_constant`` and ``damping_coefficient``: WISDEM reads that where it is set to take elastic
properties as given.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Literal, NamedTuple

import yaml

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.files import atomic_path
from fe_drivetrain.common.reading import unreadable
from fe_drivetrain.common.regular_files import content_of
from fe_drivetrain.export.formats.elastodyn import Torsion

Program = Literal["wisdem", "windio"]

_OVERRIDES = ("spring_constant_user", "damping_coefficient_user")
_RESULTS = ("spring_constant", "damping_coefficient")
_UNITS = ("N m/rad", "N m s/rad")


class Place(NamedTuple):
    """A value in the text: from here to there, in lines and columns from 0."""

    line: int
    start: int
    end: int
    value: float


def write_torsion(
    source: str | Path,
    target: str | Path,
    torsion: Torsion,
    program: Program = "wisdem",
    overwrite: bool = False,
) -> tuple[str, ...]:
    """Write a turbine file with another drivetrain spring and damper; its other text stays.

    Values that stand there are replaced, and others put in.

    Parameters
    ----------
    source : str or Path
        A turbine file in block style.
    target : str or Path
        Where the new one goes; may be ``source``.
    torsion : Torsion
        The new values, low-speed side.
    program : Program
        "wisdem" sets WISDEM's overrides, "windio" windIO's own values, which need the
        drivetrain's other elastic properties beside them.
    overwrite : bool
        Whether an existing ``target`` is replaced.

    Returns
    -------
    tuple
        Paths of the values that were set.

    Raises
    ------
    InputError
        ``source`` is no such file, ``target`` exists, or a value is out of its range.
    """
    source, target = Path(source), Path(target)
    if not 0 < torsion.spring < float("inf") or not 0 <= torsion.damper < float("inf"):
        raise InputError(
            f"spring {torsion.spring:g} must be positive and damper {torsion.damper:g} not "
            "negative, and both finite"
        )
    if target.exists() and not overwrite:
        raise InputError(f"{target} exists: name another file, or allow to overwrite it")
    text = _text(source)
    node, path, keys = _drivetrain(source, text), "components.drivetrain", _OVERRIDES
    if program == "windio":
        elastic = _child(node, "elastic_properties")
        if not isinstance(elastic, yaml.MappingNode) or elastic.flow_style:
            raise InputError(
                f"{source} has no {path}.elastic_properties in block style: windIO needs mass, "
                "inertia and location there; give them"
            )
        node, path, keys = elastic, f"{path}.elastic_properties", _RESULTS
    lines = text.splitlines(keepends=True)
    at = node.start_mark.line
    ending = "\r\n" if lines[at].endswith("\r\n") else "\n"
    new = []
    for key, value, unit in zip(keys, torsion, _UNITS, strict=True):
        place = _place(source, node, key)
        if place is None:
            indent = " " * node.start_mark.column
            new.append(f"{indent}{key}: {_number(value)} # {unit}, low-speed side{ending}")
        else:
            line = lines[place.line]
            lines[place.line] = line[: place.start] + _number(value) + line[place.end :]
    with atomic_path(target) as unfinished:
        unfinished.write_bytes("".join(lines[:at] + new + lines[at:]).encode("utf-8"))
    return tuple(f"{path}.{key}" for key in keys)


def read_torsion(path: str | Path) -> dict[str, float]:
    """The values of spring and damper in a turbine file, by their path; empty where none stands.

    Raises
    ------
    InputError
        The file is no turbine file, or a value no number.
    """
    path = Path(path)
    drivetrain = _drivetrain(path, _text(path))
    found: dict[str, float] = {}
    for key in _OVERRIDES:
        place = _place(path, drivetrain, key)
        if place is not None:
            found[f"components.drivetrain.{key}"] = place.value
    elastic = _child(drivetrain, "elastic_properties")
    if isinstance(elastic, yaml.MappingNode):
        for key in _RESULTS:
            place = _place(path, elastic, key)
            if place is not None:
                found[f"components.drivetrain.elastic_properties.{key}"] = place.value
    return found


def _number(value: float) -> str:
    """YAML takes an exponent for one only after a point."""
    return re.sub(r"^(-?\d+)e", r"\1.0e", repr(float(value)))


def _text(path: Path) -> str:
    try:
        return content_of(path).decode("utf-8")
    except (OSError, ValueError) as error:
        raise unreadable(path, "windIO turbine file", error) from error


def _drivetrain(path: Path, text: str) -> yaml.MappingNode:
    try:
        # the nodes know where they stand in the text
        top = yaml.compose(text, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))
    except yaml.YAMLError as error:
        raise InputError(f"{path} is no windIO turbine file: {error}") from error
    components = _child(top, "components")
    found = _child(components, "drivetrain")
    if not isinstance(found, yaml.MappingNode) or found.flow_style:
        raise InputError(
            f"{path} has no components.drivetrain in block style: give a windIO turbine file"
        )
    return found


def _child(node: yaml.Node | None, key: str) -> yaml.Node | None:
    if isinstance(node, yaml.MappingNode):
        for name, value in node.value:
            if name.value == key:
                return value  # type: ignore[no-any-return]
    return None


def _place(path: Path, node: yaml.MappingNode, key: str) -> Place | None:
    found = _child(node, key)
    if found is None:
        return None
    try:
        value = float(str(found.value))
    except ValueError as error:
        raise InputError(f"{path}: {key} is no number") from error
    mark, end = found.start_mark, found.end_mark
    return Place(mark.line, mark.column, end.column, value)
