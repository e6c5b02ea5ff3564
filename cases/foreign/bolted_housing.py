"""A housing from a STEP file, held by its underside, in a scene."""

from pathlib import Path

from fe_drivetrain.drivetrain_file import Scene, parse_scene

_SCENE = """
title: {title}
shaft: {{front: -2.145, sections: [{{length: 4.76, outer_diameter: 0.4}}]}}
bearing_units:
  - bearing: {{name: main_bearing, kind: ring}}
    interface: bonded
    housing:
      step: {file}
      seat: {{radius: 300}}
      held: [{{point: [0, 0, -420], normal: [0, 0, 1]}}]
      {bolts}
gearbox: {{stiffness: [4.0e6, 8.0e7, 8.0e7, rigid, 0, 0]}}
"""


def in_scene(title: str, file: Path, bolts: str) -> Scene:
    """A housing from a STEP file, held by its underside, under the ring of a shaft."""
    return parse_scene(_SCENE.format(title=title, file=file, bolts=bolts))
