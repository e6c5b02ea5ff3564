"""Folded elements at a coarse bore are unfolded; the part keeps its shape and its named faces."""

import gmsh
import numpy as np
import pytest

from fe_drivetrain.elasticity.mesh.checks import find_faults
from fe_drivetrain.elasticity.mesh.generation import read_gmsh
from fe_drivetrain.elasticity.mesh.measures import area, inverted_cells, scaled_jacobians, volume
from fe_drivetrain.foreign.unfolding import unfolded
from fe_drivetrain.geometry import gmsh_session

RADIUS, WIDE = 0.3, 0.65  # of a plate with a bore, whose webs are 25 mm wide [m]
FLOOR = 0.1


def bored_plate(thick):
    """The plate as gmsh curves it, its bore named a seat, its lower face a base."""
    with gmsh_session():
        occ = gmsh.model.occ
        plate = occ.addBox(-WIDE / 2, -WIDE / 2, 0, WIDE, WIDE, thick)
        hole = occ.addCylinder(0, 0, 0, 0, 0, thick, RADIUS)
        occ.cut([(3, plate)], [(3, hole)])
        occ.synchronize()
        faces = [tag for _, tag in gmsh.model.getEntities(2)]
        bore = [tag for tag in faces if gmsh.model.getType(2, tag) == "Cylinder"]
        under = [tag for tag in faces if abs(occ.getCenterOfMass(2, tag)[2]) < 1e-9]
        gmsh.model.addPhysicalGroup(3, [tag for _, tag in gmsh.model.getEntities(3)], name="body")
        gmsh.model.addPhysicalGroup(2, bore, name="body.seat")
        gmsh.model.addPhysicalGroup(2, under, name="body.base")
        for key, value in (("FromPoints", 0), ("Max", 0.25), ("FromCurvature", 10)):
            gmsh.option.setNumber(f"Mesh.MeshSize{key}", value)
        gmsh.model.mesh.generate(3)
        gmsh.model.mesh.setOrder(2)
        return read_gmsh([])


def away_from_bore(mesh):
    """Of the seat's nodes from its cylinder [m]."""
    at = mesh.points[mesh.face_nodes("body.seat")]
    return np.abs(np.hypot(at[:, 0], at[:, 1]) - RADIUS)


@pytest.fixture(scope="module")
def thick():
    return bored_plate(0.3)


def test_nodes_inside_give_way_and_the_outside_keeps_its_shape(thick):
    assert len(inverted_cells(thick)) > 5
    mesh = unfolded(thick)
    assert scaled_jacobians(mesh.points, mesh.cells).min() > FLOOR
    assert find_faults(mesh) == []
    assert volume(mesh) == pytest.approx(volume(thick), rel=1e-12)
    assert away_from_bore(mesh).max() < 1e-12
    # facets of the base were folded, too, and counted twice
    exact = {"body.seat": 2 * np.pi * RADIUS * 0.3, "body.base": WIDE**2 - np.pi * RADIUS**2}
    for face, size in exact.items():
        assert area(mesh, face) == pytest.approx(size, rel=1e-3)
    assert area(thick, "body.base") > 1.002 * exact["body.base"]
    assert np.abs(mesh.points[mesh.face_nodes("body.base"), 2]).max() < 1e-12


def test_the_same_nodes_come_out_each_time(thick):
    np.testing.assert_array_equal(unfolded(thick).points, unfolded(thick).points)


def test_a_sound_mesh_stays_as_it_is(thick):
    sound = unfolded(thick)
    assert unfolded(sound) is sound


def test_elements_flat_on_a_bore_stay_folded_and_the_bore_where_it_is():
    plate = bored_plate(0.05)
    assert len(inverted_cells(plate)) > 0
    mesh = unfolded(plate)
    assert away_from_bore(mesh).max() < 1e-12
    assert 0 < len(inverted_cells(mesh)) < len(inverted_cells(plate))
    assert volume(mesh) == pytest.approx(volume(plate), rel=1e-12)
