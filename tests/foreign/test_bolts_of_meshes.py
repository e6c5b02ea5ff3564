"""Bolts and washers of housings from mesh files: found, and as stiff as those of the STEP file."""

import math

import meshio
import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.reading import parse_scene
from fe_drivetrain.elasticity.mesh.files import write
from fe_drivetrain.elasticity.mesh.mesh import boundary
from fe_drivetrain.foreign.holes import bolt_holes, cylinders, planes
from fe_drivetrain.foreign.housing import placed_housing
from fe_drivetrain.foreign.picking import Surface
from fe_drivetrain.geometry import Bearing, Housing, gmsh_session
from fe_drivetrain.geometry.step_files import write_step
from fe_drivetrain.shafts.fidelity.bearing_units import unit_stiffness

pytestmark = pytest.mark.usefixtures("kept_between_runs")

BEARING = Bearing(kind="ring")
SCENE = """
title: bolts
shaft: {{front: -1.0, sections: [{{length: 2.2, outer_diameter: 0.4}}]}}
bearing_units:
  - bearing: {{name: main_bearing, kind: ring}}
    housing:
      {part}
      bolts: {bolts}
    interface: bonded
gearbox: {{stiffness: [0, 0, 0, 0, 0, 0]}}
mesh: {{shaft: 0.3, bearing: 0.2, housing: 0.25, bearing_edge: 0.2, elements_per_turn: 8}}
"""
HOLES = "hole_radius: {hole}, washer_diameter: {washer}"
WAYS = {
    "washers": "{{{holes}}}",
    "beams": "{{{holes}, hold: beams, diameter: {shank}}}",
    "clamped": "{{{holes}, hold: clamped, diameter: {shank}, preload: 4.0e5}}",
}


def bolts(way, scale=1.0):
    holes = HOLES.format(hole=26 * scale, washer=140 * scale)
    return WAYS[way].format(holes=holes, shank=48 * scale)


def from_step(folder, way):
    part = (
        f"step: {folder}/block.step\n      seat: {{radius: 300}}\n"
        "      held: [{point: [0, 0, -420], normal: [0, 0, 1]}]"
    )
    return parse_scene(SCENE.format(part=part, bolts=bolts(way)))


def from_mesh(folder, way, ending):
    part = (
        f"mesh: {folder}/{way}.{ending}\n      unit: m\n      translate: [0, 0, 0]\n"
        "      seat: {radius: 0.3, axis: [1, 0, 0], point: [0, 0, 0]}\n"
        "      held: [{point: [0, 0, -0.42], normal: [0, 0, 1]}]"
    )
    return parse_scene(SCENE.format(part=part, bolts=bolts(way, 1e-3)))


def housing_of(scene):
    unit = scene.bearing_units[0]
    return placed_housing(unit.foreign, unit.bearing, scene.mesh).mesh


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """The bolted block as STEP, and as meshes that follow the washers' outlines."""
    folder = tmp_path_factory.mktemp("bolts")
    with gmsh_session():
        write_step(folder / "block.step", [Housing(base="bolted").build(BEARING).volume])
    for way, ending in (("washers", "vtu"), ("beams", "inp"), ("clamped", "msh")):
        mesh = housing_of(from_step(folder, way))
        if ending == "inp":
            body = meshio.Mesh(mesh.points, [("tetra10", mesh.cells)])
            meshio.write(folder / f"{way}.inp", body)
        else:
            write(mesh, folder / f"{way}.{ending}")
    return folder


@pytest.fixture(scope="module")
def surface(folder):
    mesh = housing_of(from_step(folder, "clamped"))
    return Surface("block", mesh.points, boundary(mesh), {})


@pytest.mark.parametrize(
    ("way", "ending"), [("washers", "vtu"), ("beams", "inp"), ("clamped", "msh")]
)
def test_a_mesh_on_its_bolts_is_as_stiff_as_its_step_file(folder, way, ending):
    step, mesh = (
        unit_stiffness(scene, "main_bearing", "rigid", "superlu", ring=False)
        for scene in (from_step(folder, way), from_mesh(folder, way, ending))
    )
    scale = np.sqrt(np.outer(step.diagonal(), step.diagonal()))
    # the file keeps sixteen digits, and the feet's middles come from facets in another order
    assert np.abs((mesh - step) / scale).max() < 1e-6


def test_holes_of_bolts_are_found_with_their_depth(surface):
    held = np.flatnonzero(
        (np.abs(surface.points[surface.facets[:, :3], 2] + 0.42) < 1e-9).all(axis=1)
    )
    holes = bolt_holes(surface, held, 0.026)
    assert len(holes) == 4
    for hole in holes:
        assert hole.length == pytest.approx(0.1, rel=1e-9)
        assert hole.up == pytest.approx([0, 0, 1], abs=1e-9)
        assert np.abs(hole.foot) == pytest.approx([0.1, 0.53, 0.42], abs=1e-9)
    assert bolt_holes(surface, held, 0.04) == []


def test_cylinders_are_fitted_and_planes_found(surface):
    found = cylinders(surface)
    seat, *bolted = [one for one in found if one.hole]
    assert seat.radius == pytest.approx(0.3, rel=1e-6)
    assert seat.length == pytest.approx(0.3, rel=1e-6)
    assert np.abs(seat.axis) == pytest.approx([1, 0, 0], abs=1e-6)
    assert [one.radius for one in bolted] == pytest.approx(4 * [0.026], rel=1e-6)
    assert any(not one.hole for one in found)  # the half-round shell
    foot = next(plane for plane in planes(surface) if plane[2][2] < -0.9)
    assert foot[0] == pytest.approx(0.36 * 1.25 - 4 * math.pi * 0.026**2, rel=2e-3)


def test_the_command_names_cylinders_and_planes_of_a_mesh(folder, invoke):
    status, out, _ = invoke("part", str(folder / "clamped.msh"))
    assert status == 0
    assert "S1  hole     radius: 0.3 " in out
    assert "normal: [0, 0, -1]" in out


def test_facets_that_do_not_follow_a_washer_are_refused_with_its_place(folder):
    scene = from_mesh(folder, "washers", "vtu")
    housing = scene.bearing_units[0].foreign
    wide = housing.bolts.model_copy(update={"washer_diameter": 0.24})
    with pytest.raises(InputError, match=r"under the washer at \(-0.1, -0.53, -0.42\)"):
        placed_housing(housing.model_copy(update={"bolts": wide}), BEARING, scene.mesh)
