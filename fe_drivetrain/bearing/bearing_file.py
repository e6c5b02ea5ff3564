"""A file of bearings to start from, and its JSON schema for editors."""

from __future__ import annotations

import json

from pydantic import TypeAdapter

from fe_drivetrain.bearing.catalogue import Entry
from fe_drivetrain.bearing.catalogue_page import CataloguePage

SCHEMA_FILE = "bearings.schema.json"
"""Name of the schema's file, which stands beside the bearings."""

_START = f"""\
# yaml-language-server: $schema={SCHEMA_FILE}
# Bearings by name, for catalogue: NAME in a drivetrain's file, with --catalogue of life, check and
# transient. Values are those of an example: replace them by your own. Lengths in m, ratings in N,
# angles in deg. All keys: docs/bearing.md.

# By a catalogue's page: designation, ratings and factors as they are printed. d, D and B (T of
# tapered bearings) follow from the designation; give them where no table has the size. Number, size
# and angle of the rollers are an ensemble that fits the page.
main_bearing:
  designation: 240/600
  C: 8.15e+6
  C0: 1.7e+7
  Cu: 1.1e+6
  e: 0.30
  Y1: 2.3
  Y2: 3.4
  Y0: 2.2
  source: which catalogue, which page
  # what is known of the inside narrows the ensemble:
  # elements: 29
  # element_diameter: 0.068
  # element_length: 0.110
  # pitch_diameter: 0.728
  # clearance: 1.0e-4

high_speed_shaft:
  designation: NU 2220 ECP
  C: 3.8e+5
  C0: 4.5e+5
  Cu: 5.4e+4
  F: 0.119   # raceway of the inner ring, which catalogues print of NU and NJ

# A designation of a maker's own: kind, d, D and B in its place.
own_designation:
  designation: 331555 B
  kind: double_row_tapered   # or single_row_tapered, spherical_roller, cylindrical, toroidal, ball
  arrangement: O             # of two tapered rows: X face to face, O back to back
  d: 0.635
  D: 0.9398
  B: 0.3048
  C: 6.71e+6
  C0: 1.66e+7
  Cu: 1.1e+6

# With its inside: each number has its source, or "assumed: why".
known_inside:
  title: cylindrical bearing of a planet
  kind: cylindrical
  elements: 16
  element_diameter: 0.040
  element_length: 0.050
  pitch_diameter: 0.225
  law: iso
  bore: 0.160
  ratings: {{C: 9.3e+5, C0: 1.2e+6}}
  sources:
    elements: drawing
    element_diameter: drawing
    element_length: drawing
    pitch_diameter: drawing
    bore: drawing
    ratings: which catalogue
"""


def starting_bearings() -> str:
    """A file of bearings to start from, with comments.

    Returns
    -------
    str
        YAML text that `read_bearing_catalogue` reads. Its first line names `SCHEMA_FILE`.
    """
    return _START


def bearing_schema() -> str:
    """The JSON schema (draft 2020-12) of files of bearings; ends with a line break."""
    kinds = TypeAdapter(CataloguePage | Entry).json_schema()
    content = {
        "$defs": kinds["$defs"],
        "type": "object",
        "additionalProperties": {
            "if": {"required": ["designation"]},
            "then": {"$ref": "#/$defs/CataloguePage"},
            "else": {"$ref": "#/$defs/Entry"},
        },
    }
    return json.dumps(content, indent=1, ensure_ascii=False) + "\n"
