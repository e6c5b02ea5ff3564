"""REXS models as they are in a file: components with their attributes, and relations.

XML (``.rexs``, ``.rexs.xml``), JSON (``.rexsj``, ``.rexs.json``) and a ZIP archive with one of them
(``.rexsz``, ``.rexs.zip``) hold the same model (spec.rexs.info 1.6, "File formats", "JSON syntax").
What a file is, its content says, not its ending.
"""

from __future__ import annotations

import base64
import io
import math
import re
import zipfile
import zlib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.plain_json import plain_json
from fe_drivetrain.common.plain_xml import plain_root
from fe_drivetrain.common.reading import unreadable
from fe_drivetrain.common.regular_files import content_of
from fe_drivetrain.common.strict_yaml import shown

MAX_CONTENT = 32_000_000
"""Bytes of a model, out of its archive, that are read."""
LATEST = (1, 6)
"""Latest version that is published, and read."""
ENDINGS = (".rexs", ".rexs.xml", ".rexsj", ".rexs.json")
"""Endings of a model in a ZIP archive."""

_BOM = b"\xef\xbb\xbf"
_CODES = {"int32": "<i4", "float32": "<f4", "float64": "<f8"}
_SCALARS = ("floating_point", "integer", "string", "enum", "boolean", "reference_component")

#: Factor to SI by unit as REXS writes it, for each dimension that is read here.
UNITS: Mapping[str, Mapping[str, float]] = {
    "length": {"mm": 1e-3, "m": 1.0, "mum": 1e-6, "µm": 1e-6, "dm": 0.1, "cm": 1e-2},
    "angle [deg]": {"°": 1.0, "deg": 1.0, "rad": 180 / math.pi},
    "number": {"none": 1.0, "-": 1.0, "%": 1e-2},
    "direction": {"mm": 1.0, "m": 1.0, "none": 1.0},
    "stiffness": {"N / m": 1.0, "N / mm": 1e3, "N / mum": 1e6},
    "stiffness in tilt": {"N mm / rad": 1e-3, "N m / rad": 1.0},
    "modulus": {"N / mm^2": 1e6, "MPa": 1e6, "Pa": 1.0, "GPa": 1e9},
    "density": {"kg / dm^3": 1e3, "kg / m^3": 1.0},
    "mass": {"kg": 1.0, "g": 1e-3},
    "inertia": {"kg m^2": 1.0, "kg mm^2": 1e-6},
}


@dataclass
class Attribute:
    """A value of a component as the file has it, with its unit; lists of arrays and matrices."""

    value: Any
    unit: str | None
    used: bool = False


@dataclass
class Part:
    """A component: its number, type and name, and its attributes by their REXS names."""

    number: str
    type: str
    name: str
    attributes: dict[str, Attribute] = field(default_factory=dict)
    used: bool = False

    def __str__(self) -> str:
        """The component as messages name it."""
        named = f" {self.name!r}" if self.name else ""
        return f"{self.type} {self.number}{named}"

    def has(self, key: str) -> bool:
        """Whether it has a value of this name."""
        return key in self.attributes

    def number_of(self, key: str, dimension: str) -> float | None:
        """A number in SI, angles in degrees; None where there is none.

        Parameters
        ----------
        key : str
            REXS's name of the attribute.
        dimension : str
            A key of `UNITS`.

        Raises
        ------
        InputError
            It is no finite number, or in a unit of another dimension.
        """
        found = self._of(key)
        if found is None:
            return None
        return self._scaled(key, found, [found.value], dimension)[0]

    def vector(self, key: str, dimension: str = "length") -> list[float] | None:
        """Three numbers of a vector; None where there is none; see `number_of`."""
        found = self._of(key)
        if found is None:
            return None
        if not isinstance(found.value, list) or len(found.value) != 3:
            raise InputError(f"{self}: {key} must have three numbers: correct it")
        return self._scaled(key, found, found.value, dimension)

    def word(self, key: str) -> str | None:
        """A word, or the first of several; None where there is none."""
        found = self._of(key)
        if found is None:
            return None
        value = found.value
        while isinstance(value, list) and value:
            value = value[0]
        if isinstance(value, float) and value.is_integer():
            value = int(value)  # an id, in JSON of a program that has no integers
        return str(value).strip().lower() if isinstance(value, bool) else str(value).strip()

    def _of(self, key: str) -> Attribute | None:
        found = self.attributes.get(key)
        if found is not None:
            self.used = found.used = True
        return found

    def _scaled(
        self, key: str, found: Attribute, values: Sequence[Any], dimension: str
    ) -> list[float]:
        known = UNITS[dimension]
        # without a unit, that of the attribute in REXS's own list, which stands first
        unit = next(iter(known)) if found.unit is None else " ".join(found.unit.split())
        if unit not in known:
            raise InputError(
                f"{self}: {key} is in {shown(unit)} but must be in one of {', '.join(known)}: "
                "correct its unit"
            )
        try:
            numbers = [float(value) * known[unit] for value in values]
        except (TypeError, ValueError, OverflowError):
            numbers = [math.nan]
        if not all(map(math.isfinite, numbers)):
            raise InputError(
                f"{self}: {key} is {shown(found.value)} but must be a finite number: correct it"
            )
        return numbers


@dataclass(frozen=True)
class Relation:
    """What belongs together: a type, and components by their role."""

    type: str
    ends: Mapping[str, str]
    order: int = 0


@dataclass(frozen=True)
class Model:
    """A REXS model.

    Attributes
    ----------
    version : tuple of int
        Version of REXS that it says.
    program, date : str
        What wrote it, and when.
    parts : dict of str to Part
        Components by their numbers.
    relations : list of Relation
        Relations, in the order of the file.
    """

    version: tuple[int, int]
    program: str
    date: str
    parts: Mapping[str, Part]
    relations: Sequence[Relation]

    def of_type(self, *types: str) -> list[Part]:
        """Components of these types, in the order of the file."""
        return [part for part in self.parts.values() if part.type in types]

    @cached_property
    def _index(self) -> dict[tuple[str, str, str], list[Relation]]:
        """Relations by type, and by type, role and component."""
        found: dict[tuple[str, str, str], list[Relation]] = {}
        for one in self.relations:
            for role, number in (("", ""), *one.ends.items()):
                found.setdefault((one.type, role, number), []).append(one)
        return found

    def related(self, relation: str, **end: Part) -> Iterator[dict[str, Part]]:
        """Components by role in relations of a type, of those with a component in a role."""
        role, number = next(((role, part.number) for role, part in end.items()), ("", ""))
        for one in self._index.get((relation, role, number), ()):
            yield {role: self.parts[number] for role, number in one.ends.items()}


def read_model(path: str | Path) -> Model:
    """A REXS model from a file: XML, JSON, or a ZIP archive with one of them.

    Parameters
    ----------
    path : str or Path
        The file.

    Raises
    ------
    InputError
        It cannot be read, is too large, is no REXS model, or has a component twice or a relation
        of one that there is not.
    """
    try:
        content = content_of(path, MAX_CONTENT)
    except (OSError, ValueError) as error:
        raise unreadable(path, "REXS model", error) from error
    source = f"{path} is no REXS model"
    if content.startswith(b"PK"):
        content = _from_archive(content, str(path))
    if content.removeprefix(_BOM).lstrip()[:1] == b"{":
        return _of_json(content.removeprefix(_BOM), source)
    return _of_xml(content, source)


def _from_archive(content: bytes, path: str) -> bytes:
    """The one model in a ZIP archive."""
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            found = [
                one
                for one in archive.infolist()
                if not one.is_dir() and one.filename.lower().endswith(ENDINGS)
            ]
            if len(found) != 1:
                raise InputError(
                    f"{path} is an archive with {len(found)} REXS models "
                    f"({', '.join(ENDINGS)}) but must have one: take the others out"
                )
            with archive.open(found[0]) as file:
                model = file.read(MAX_CONTENT + 1)
    except (
        zipfile.BadZipFile,
        zlib.error,
        NotImplementedError,
        RuntimeError,
        EOFError,
        OSError,
        ValueError,
        OverflowError,
    ) as error:
        raise InputError(
            f"{path} is no sound ZIP archive: {' '.join(str(error).split())}: export it again"
        ) from error
    if len(model) > MAX_CONTENT:
        raise InputError(
            f"{path}: the model in the archive has more than {MAX_CONTENT:,} bytes: shorten it"
        )
    return model


def _of_json(content: bytes, source: str) -> Model:
    try:
        data = plain_json(content.decode("utf-8"))
    except ValueError as error:
        why = " ".join(str(error).split())
        raise InputError(f"{source}: {why}: export it again, or correct it") from error
    model = data.get("model") if isinstance(data, dict) else None
    if not isinstance(model, dict):
        raise InputError(f"{source}: it has no object 'model': export it again")
    parts = []
    for one in _objects(model.get("components"), source):
        attributes = {
            str(row.get("id")): Attribute(_json_value(row, source), _unit(row.get("unit")))
            for row in _objects(one.get("attributes"), source)
        }
        parts.append(
            Part(str(one.get("id")), str(one.get("type")), _name(one.get("name")), attributes)
        )
    relations = []
    for one in _objects(model.get("relations"), source):
        ends = {
            str(ref.get("role")): str(ref.get("id")) for ref in _objects(one.get("refs"), source)
        }
        relations.append((str(one.get("type")), ends, one.get("order")))
    return _model(model, parts, relations, source)


def _of_xml(content: bytes, source: str) -> Model:
    root = plain_root(content, source)
    model = root if root.tag == "model" else root.find("model")
    if model is None:
        raise InputError(f"{source}: its root is <{shown(root.tag)}>, not <model>: give another")
    parts = []
    for one in model.iterfind("components/component"):
        attributes = {}
        for row in one.iterfind("attribute"):
            value = _xml_value(row, source)
            attributes[row.get("id", "")] = Attribute(value, _unit(row.get("unit")))
        parts.append(
            Part(one.get("id", ""), one.get("type", ""), _name(one.get("name")), attributes)
        )
    relations = []
    for one in model.iterfind("relations/relation"):
        ends = {ref.get("role", ""): ref.get("id", "") for ref in one.iterfind("ref")}
        relations.append((one.get("type", ""), ends, one.get("order")))
    return _model(model.attrib, parts, relations, source)


def _xml_value(row: Any, source: str) -> Any:
    for tag in ("array", "matrix"):
        found = row.find(tag)
        if found is None:
            continue
        if found.get("code") is not None:
            return _decoded(found.get("code"), found.text, source)
        rows = [found] if tag == "array" else list(found.iterfind("r"))
        cells = [[(c.text or "").strip() for c in one.iterfind("c")] for one in rows]
        return cells[0] if tag == "array" else cells
    return (row.text or "").strip()


def _json_value(row: Mapping[str, Any], source: str) -> Any:
    """The value of an attribute, whose key is its type."""
    for key, value in row.items():
        if key in ("id", "unit"):
            continue
        if key.endswith("_coded") and isinstance(value, dict):
            return _decoded(value.get("code"), value.get("value"), source)
        if key in _SCALARS or isinstance(value, list | str | int | float):
            return value
    return None


def _decoded(code: Any, text: Any, source: str) -> list[float]:
    """Numbers of an array that is written in binary, little endian, in base64."""
    kind = _CODES.get(str(code))
    if kind is None:
        raise InputError(
            f"{source}: an array has the code {shown(code)} but must have one of "
            f"{', '.join(_CODES)}: export it again"
        )
    try:
        raw = base64.b64decode("".join(str(text or "").split()), validate=True)
        return [float(value) for value in np.frombuffer(raw, kind).tolist()]
    except ValueError as error:
        raise InputError(f"{source}: an array in {code}: {error}: export it again") from error


def _objects(value: Any, source: str) -> list[dict[str, Any]]:
    """A list of objects, or an empty one where nothing stands."""
    if value is None:
        return []
    if not isinstance(value, list) or not all(isinstance(one, dict) for one in value):
        raise InputError(
            f"{source}: components, relations, refs and attributes must be lists of objects: "
            "export it again"
        )
    return value


def _unit(value: Any) -> str | None:
    return value if isinstance(value, str) and value.strip() else None


def _name(value: Any) -> str:
    """A name in one line."""
    text = " ".join(str(value).split()) if isinstance(value, str) else ""
    return "".join(c for c in text if c.isprintable())[:200].strip()


def _model(
    head: Mapping[str, Any],
    parts: Sequence[Part],
    relations: Sequence[tuple[str, dict[str, str], Any]],
    source: str,
) -> Model:
    """Check what both forms hold in the same way."""
    version = _version(head.get("version"), source)
    if not parts:
        raise InputError(f"{source}: it has no components: export it again")
    found: dict[str, Part] = {}
    for part in parts:
        if not re.fullmatch(r"\d{1,18}", part.number) or not part.type:
            raise InputError(
                f"{source}: a component has the id {shown(part.number)} and the type "
                f"{shown(part.type)} but must have a number and a word: correct it"
            )
        if part.number in found:
            raise InputError(
                f"{source}: two components have the id {part.number}: give each its own"
            )
        found[part.number] = part
    made = []
    for kind, ends, order in relations:
        for number in ends.values():
            if number not in found:
                raise InputError(
                    f"{source}: a relation {shown(kind)} is of a component {shown(number)}, which "
                    "there is not: correct the relation, or add the component"
                )
        place = str(order) if order is not None else "0"
        made.append(Relation(kind, ends, int(place) if re.fullmatch(r"\d{1,9}", place) else 0))
    program = f"{_name(head.get('applicationId'))} {_name(head.get('applicationVersion'))}".strip()
    return Model(version, program, _name(head.get("date")), found, made)


def _version(value: Any, source: str) -> tuple[int, int]:
    stated = re.fullmatch(r"(\d{1,4})\.(\d{1,4})", str(value).strip())
    if stated is None:
        raise InputError(
            f"{source}: its version is {shown(value)} but must be one such as 1.6: correct it"
        )
    version = int(stated[1]), int(stated[2])
    if version[0] != LATEST[0]:
        raise InputError(
            f"{source} of a version that is read: it is of REXS {version[0]}.{version[1]}, and "
            f"1.0 to {LATEST[0]}.{LATEST[1]} are: export it in one of these"
        )
    return version
