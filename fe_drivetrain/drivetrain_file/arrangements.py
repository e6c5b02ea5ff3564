"""Scene files to start from, by how the shaft is supported, and the schema that they follow."""

from __future__ import annotations

import json
from collections.abc import Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

from pydantic import TypeAdapter

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.lumped import LumpedDrivetrain
from fe_drivetrain.drivetrain_file.reading import BY_STIFFNESS, library_text
from fe_drivetrain.drivetrain_file.scene import Scene

SCHEMA_FILE = "drivetrain.schema.json"
"""Name of the schema file beside a drivetrain's file, and under ``docs/``."""


class Arrangement(NamedTuple):
    """How a shaft is supported, in words, and the scene of the library that is so."""

    title: str
    library: str


ARRANGEMENTS: Mapping[str, Arrangement] = MappingProxyType(
    {
        "three-point": Arrangement(
            "one spherical bearing, gearbox on two torque arms; shaft with flange and taper",
            "three_point_suspension",
        ),
        "spherical": Arrangement(
            "one spherical bearing that carries no moment, gearbox on springs; plain shaft",
            "main_bearing_spherical",
        ),
        "bonded": Arrangement(
            "one bearing that carries moments (double-row tapered rollers); plain shaft",
            "main_bearing_bonded",
        ),
        "bedplate": Arrangement(
            "one bearing that carries moments, its housing on a bedplate that gives",
            "housing_on_bedplate",
        ),
        "two-bearings": Arrangement(
            "two main bearings: the front one carries moments, the rear one is spherical",
            "two_bearings",
        ),
        "gearbox-shaft": Arrangement(
            "a stepped shaft inside a gearbox on two spherical bearings", "stepped_shaft"
        ),
        "geared-one-planetary": Arrangement(
            "a whole drivetrain: one planetary and two parallel stages, on three points",
            "grc_750kw",
        ),
        "geared-two-planetary": Arrangement(
            "a whole drivetrain: two planetary stages and a parallel one, two main bearings",
            "nrel_5mw",
        ),
        "direct-drive": Arrangement(
            "a wide tube on two bearings without a gearbox", "iea_15mw_main_shaft"
        ),
        "nose": Arrangement(
            "a direct drive whose shaft turns round a standing nose", "iea_15mw_shaft_on_nose"
        ),
    }
)
"""The arrangements by name; the first one is the default."""

# Sections of a scene file that may be left out. Each becomes valid by taking the "# " away.
_OPTIONAL = {
    "hub": "hub: {coupling: averaged}   # how loads enter the front face: averaged or rigid\n",
    "rotor": (
        "rotor: {mass: 9.0e4, inertia: 4.0e7}   # at the front face; for modes and transients\n"
    ),
    "generator": "generator: {inertia: 4.5e6, rated_torque: 4.1e6}   # [kg m^2, N m]\n",
    "operation": (
        "operation: {rated_power: 5.0e6, rotor_speed: [0.7, 1.27]}   # [W]; least, rated [rad/s]\n"
    ),
    "load_points": (
        "load_points:   # where else loads enter the shaft: columns brake.Fz [kN] of a CSV file\n"
        "  - {name: brake, x: -0.23, width: 0.03, weight: 5000}\n"
    ),
    "materials": (
        "materials:   # steel and ductile_iron are there; name others here\n"
        "  cast_steel: {youngs_modulus: 2.05e11, poisson_ratio: 0.29, density: 7800}\n"
    ),
    "mesh": "mesh: {shaft: 0.12, bearing: 0.05, housing: 0.06, bearing_edge: 0.03}   # sizes [m]\n",
    "uncertainty": (
        "uncertainty:   # how certain values are, for fe-drivetrain uncertainty\n"
        "  shaft.sections.0.outer_diameter: {uniform: 0.001}\n"
    ),
}


def starting_scene(arrangement: str) -> str:
    """A scene file to start from, with comments: a scene of the library, and what else it may have.

    Parameters
    ----------
    arrangement : str
        A name of `ARRANGEMENTS`.

    Returns
    -------
    str
        YAML text that `parse_scene` reads. Its first line names `SCHEMA_FILE` for editors.

    Raises
    ------
    InputError
        There is no such arrangement.
    """
    if arrangement not in ARRANGEMENTS:
        raise InputError(
            f"arrangement {arrangement!r} is unknown: use one of {', '.join(ARRANGEMENTS)}"
        )
    title, library = ARRANGEMENTS[arrangement]
    text = library_text(library)
    keys = {line.partition(":")[0] for line in text.splitlines() if not line.startswith("#")}
    rest = "\n".join(block for key, block in _OPTIONAL.items() if key not in keys)
    return (
        f"# yaml-language-server: $schema={SCHEMA_FILE}\n"
        f"# Start: {title}.\n"
        "# Values are those of an example: replace them by your own.\n"
        "# interface: bonded, spring or rollers carry moments; sliding, averaged and rigid are\n"
        "# spherical joints, which do not. All keys and defaults: docs/scene.md.\n"
        "# shaft.front: x of the front face, where the hub loads act; sections go from there to\n"
        "# the rear face, where the gearbox is. gearbox.stiffness, along x, y, z [N/m] and about\n"
        "# them [N m/rad]: a number, rigid, or 0 for free. A bearing's x is 0 where left out.\n"
        "# gearbox.stages, shafts and bearings: what is inside; rotor, generator, operation:\n"
        "# for modes, gears and transients. What is left out is not modelled.\n"
        "#\n"
        f"{text.rstrip()}\n"
        "\n# What else a scene may have (take the # away):\n#\n"
        + "".join(f"# {line}".rstrip() + "\n" for line in rest.splitlines())
    )


def drivetrain_schema() -> str:
    """The JSON schema (draft 2020-12) of drivetrains' files for editors; ends with a line break.

    What the main shaft has decides which of both kinds a file is, so that faults are found in it.
    """
    kinds = TypeAdapter(Scene | LumpedDrivetrain).json_schema()
    by_stiffness = [{"required": [key]} for key in BY_STIFFNESS]
    content = {
        "$defs": kinds["$defs"],
        "type": "object",
        "if": {"required": ["shaft"], "properties": {"shaft": {"anyOf": by_stiffness}}},
        "then": {"$ref": "#/$defs/LumpedDrivetrain"},
        "else": {"$ref": "#/$defs/Scene"},
    }
    return json.dumps(_with_named_gears(content), indent=1, ensure_ascii=False) + "\n"


def _with_named_gears(content: dict[str, Any]) -> dict[str, Any]:
    """The schema with values of gears by name, which pydantic describes as arrays."""
    renamed: dict[str, str] = {}
    definitions: dict[str, Any] = {}
    for key, value in content["$defs"].items():
        parts = value.get("prefixItems")
        if not parts:
            definitions[key] = value
            continue
        names = [part.pop("title").lower() for part in parts]
        kind = key.partition("_")[0]
        short = f"{kind}{sum(name.startswith(kind) for name in definitions) + 1}"
        renamed[f"#/$defs/{key}"] = f"#/$defs/{short}"
        definitions[short] = {
            "type": "object",
            "properties": dict(zip(names, parts, strict=True)),
            "required": names,
            "additionalProperties": False,
        }
    text = json.dumps(content | {"$defs": definitions})
    for old, new in renamed.items():
        text = text.replace(json.dumps(old), json.dumps(new))
    found: dict[str, Any] = json.loads(text)
    return found
