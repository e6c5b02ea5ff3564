"""What a drivetrain's file states and REXS has no attribute for, in attributes of our own.

REXS lets programs add attributes whose names begin with ``custom_`` (spec.rexs.info 1.4,
"Extensibility of the interface"); those that do not know them pass over them. Each has a key of the
drivetrain's file and its value in SI as JSON.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.plain_json import plain_json
from fe_drivetrain.common.strict_yaml import shown
from fe_drivetrain.export.formats.rexs_model import Part

PREFIX = "custom_fe_drivetrain_"
STAGE_KEYS = (
    *("kind", "name", "teeth", "module", "helix", "hand", "pressure_angle", "shifts", "tips"),
    *("faces", "face_width", "centre_distance", "planets", "pins", "angle"),
    *("dedendum", "fillets", "cutter"),
)
"""Keys of a stage that REXS's own attributes and relations hold."""
SHAFT_KEYS = ("name", "sections", "outer", "inner", "material")
"""Keys of a shaft that they hold; its length, where it has sections or a diameter."""
BEARING_KEYS = ("name", "at", "offset", "stiffness")
"""Keys of a bearing that they hold; its stiffness without couplings, of one radial value."""


def own_attributes(values: Mapping[str, Any]) -> dict[str, tuple[str, object]]:
    """Attributes of our own, each a unit and a text, by their names in REXS."""
    return {PREFIX + key: ("none", json.dumps(value)) for key, value in values.items()}


def own_values(part: Part) -> dict[str, Any]:
    """Values of our own by keys of the drivetrain's file.

    Raises
    ------
    InputError
        One is no JSON.
    """
    found: dict[str, Any] = {}
    for name in part.attributes:
        if not name.startswith(PREFIX):
            continue
        text = part.word(name) or ""
        try:
            found[name.removeprefix(PREFIX)] = plain_json(text)
        except ValueError as error:
            raise InputError(
                f"{part}: {name} is {shown(text)} but must be a value in JSON, as this program "
                "writes it: correct it, or remove the attribute"
            ) from error
    return found
