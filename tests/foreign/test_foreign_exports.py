"""A bonded bearing in a housing from STEP: exported, read back, and standing in another scene."""

import numpy as np
import pytest
import yaml

from fe_drivetrain.drivetrain_file.reading import change_scene, parse_scene
from fe_drivetrain.export.files import read_superelement, write_superelement
from fe_drivetrain.export.scene_export import superelement_of
from fe_drivetrain.geometry import Bearing, Housing, gmsh_session, write_step
from fe_drivetrain.shafts.fidelity.bearing_units import unit_stiffness

NAME = "main_bearing"
SCENE = """
title: a bonded unit from STEP
shaft: {{front: -1.0, sections: [{{length: 2.2, outer_diameter: 0.4}}]}}
bearing_units:
  - bearing: {{name: main_bearing, kind: ring}}
    housing:
      step: {file}
      seat: {{radius: 300}}
      held: [{{point: [0, 0, -420], normal: [0, 0, 1]}}]
    interface: bonded
gearbox: {{stiffness: [0, 0, 0, 0, 0, 0]}}
mesh: {{shaft: 0.3, bearing: 0.2, housing: 0.3, bearing_edge: 0.2, elements_per_turn: 8}}
"""
FORMATS = [
    ("json", ".json"),
    ("csv", ".csv"),
    pytest.param("hdf5", ".h5", marks=pytest.mark.needs("h5py")),
    ("dmig", ".bdf"),
    ("op4", ".op4"),
]


@pytest.fixture(scope="module")
def unit(tmp_path_factory):
    file = tmp_path_factory.mktemp("bonded") / "block.step"
    with gmsh_session():
        write_step(file, [Housing().build(Bearing(kind="ring")).volume])
    scene = parse_scene(SCENE.format(file=file))
    return scene, superelement_of(scene, NAME)


@pytest.mark.parametrize(("format", "ending"), FORMATS)
def test_a_bonded_unit_from_step_is_written_read_and_stands_in_a_scene(
    unit, tmp_path, invoke, format, ending
):
    scene, element = unit
    path = tmp_path / f"unit{ending}"
    write_superelement(path, element, format)
    K, scale = element.stiffness, np.sqrt(np.outer(*2 * [element.stiffness.diagonal()]))
    assert np.abs((read_superelement(path, format).stiffness - K) / scale).max() < 1e-9
    status, out, _ = invoke("part", str(path))
    assert status == 0
    housing = yaml.safe_load(out[out.index("housing:") :])["housing"]
    changes = {
        "bearing_units.0.housing": housing,
        "bearing_units.0.interface": "spring",
        "bearing_units.0.stiffness": ["rigid"] * 6,
    }
    again = unit_stiffness(change_scene(scene, changes), NAME)
    assert np.abs((again - K) / scale).max() < 1e-6  # to the digits of the lines
