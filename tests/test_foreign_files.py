"""Hostile, damaged and unusual STEP and mesh files: one sentence, in bounded time and memory."""

import base64
import struct
import zlib

import gmsh
import meshio
import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.foreign.housing import placed_housing
from fe_drivetrain.foreign.mesh_file import _EDGES, read
from fe_drivetrain.foreign.reading import Limits, read_in_process
from fe_drivetrain.foreign.step_mesh import mesh as mesh_solid
from fe_drivetrain.foreign.step_solid import opened, seat_cylinders
from fe_drivetrain.geometry import Bearing, ForeignHousing, MeshSizes, gmsh_session, write_sample
from fe_drivetrain.geometry.step_files import write_step
from fe_drivetrain.mesh.shapes import TETRAHEDRON_EDGES

pytestmark = pytest.mark.usefixtures("kept_between_runs")

SMALL = Limits(file=5_000_000, memory=1_500_000_000, seconds=5, result=20_000_000)
TETRAHEDRON = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])


@pytest.fixture(scope="module")
def samples(tmp_path_factory):
    folder = tmp_path_factory.mktemp("samples")
    volumes = {
        name: write_sample(name, folder / f"{name}.step")
        for name in ("ribbed_pillow_block", "split_housing", "torque_arm")
    }
    return folder, volumes


@pytest.mark.parametrize("name", ["ribbed_pillow_block", "split_housing", "torque_arm"])
def test_sample_parts_are_one_solid_of_the_volume_that_was_written(samples, name):
    folder, volumes = samples
    with gmsh_session():
        found = opened(str(folder / f"{name}.step"))
        seats = seat_cylinders(found)
    assert found["before"]["solids"] == found["after"]["solids"] == 1
    assert found["after"]["volume"] == pytest.approx(1e9 * volumes[name], rel=1e-9)
    widest = 360 if name == "torque_arm" else 300
    assert seats[0]["radius"] == pytest.approx(widest)
    assert len(seats) == {"ribbed_pillow_block": 9, "split_housing": 13, "torque_arm": 2}[name]


def test_a_torque_arm_stands_by_its_eye(samples):
    folder, _ = samples
    housing = ForeignHousing(
        step=str(folder / "torque_arm.step"),
        seat={"radius": 360},
        held=[{"radius": 130}],
    )
    bearing = Bearing(kind="ring", raceway_diameter=0.72)
    sizes = MeshSizes(housing=0.2, elements_per_turn=8)
    mesh = placed_housing(housing, bearing, sizes).mesh
    eye = mesh.points[mesh.face_nodes("main_bearing.housing.base")]
    assert np.allclose(np.hypot(eye[:, 1] - 1.25, eye[:, 2]), 0.13, atol=1e-6)


def damaged(folder, name, text):
    path = folder / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def refused(path, action="read mesh", limits=SMALL, **request):
    with pytest.raises(InputError) as error:
        read_in_process(action, path, {"smallest_detail": 0.0, **request}, limits)
    sentence = str(error.value)
    assert path.name in sentence
    assert "Traceback" not in sentence
    return sentence


def test_damaged_step_files_are_refused_in_one_sentence(samples, tmp_path):
    folder, _ = samples
    whole = (folder / "torque_arm.step").read_text()
    assert "cannot be read" in refused(
        damaged(tmp_path, "a.step", whole[: len(whole) // 2]), "look"
    )
    assert "1 to 5000000" in refused(damaged(tmp_path, "b.step", ""), "look")
    assert "1 to 5000000" in refused(damaged(tmp_path, "c.step", whole * 200), "look")


def test_a_solid_that_healing_changes_is_refused_with_both_volumes(tmp_path, monkeypatch):
    from fe_drivetrain.foreign import step_heal

    with gmsh_session():
        write_step(tmp_path / "box.step", [gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)])
    counted = step_heal.counted

    def shrunk():  # what is counted before comes from `step_solid`, unpatched
        found = counted()
        return found | {"volume": found["volume"] * 0.99}

    monkeypatch.setattr(step_heal, "counted", shrunk)
    with gmsh_session(), pytest.raises(InputError) as error:
        opened(str(tmp_path / "box.step"), 0.1)
    assert "1e+09 mm^3 before and 1 of 990000000 mm^3 after healing" in str(error.value)


def test_what_gmsh_cannot_mesh_is_said_with_its_place(tmp_path, monkeypatch):
    with gmsh_session():
        write_step(tmp_path / "box.step", [gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)])
    with gmsh_session():
        found = opened(str(tmp_path / "box.step"))

        def failing(dim):
            raise Exception("Impossible to mesh periodic surface 2")

        monkeypatch.setattr(gmsh.model.mesh, "generate", failing)
        with pytest.raises(InputError) as error:
            mesh_solid(found, 300.0, 8, False)
    at = next(face["middle"] for face in found["faces"] if face["tag"] == 2)
    assert "face 2, a plane, round ({:.4g}, {:.4g}, {:.4g}) mm".format(*at) in str(error.value)


def test_a_mesh_of_too_many_elements_is_refused_before_it_is_made(tmp_path):
    with gmsh_session():
        write_step(tmp_path / "box.step", [gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)])
    with gmsh_session():
        found = opened(str(tmp_path / "box.step"))
        with pytest.raises(
            InputError, match=r"elements of 1 mm make about .* choose 28 mm or more"
        ):
            mesh_solid(found, 1.0, 8, False)


def test_an_unreasonably_large_count_in_a_binary_msh_costs_no_memory(tmp_path):
    content = b"$MeshFormat\n2.2 1 8\n" + struct.pack("i", 1) + b"\n$EndMeshFormat\n"
    content += b"$Nodes\n2000000000\n" + b"\0" * 64
    refused(damaged(tmp_path, "huge.msh", content))


def packed_vtu(blocks, size):
    """One tetrahedron, whose points are given as so many packed blocks of zeros."""
    packed = zlib.compress(b"\0" * size, 9)
    head = struct.pack("<3I", blocks, size, 0) + struct.pack("<I", len(packed)) * blocks
    data = base64.b64encode(head).decode() + base64.b64encode(packed * blocks).decode()
    return f"""<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian"
 header_type="UInt32" compressor="vtkZLibDataCompressor">
<UnstructuredGrid><Piece NumberOfPoints="4" NumberOfCells="1">
<Points><DataArray type="Float64" NumberOfComponents="3" format="binary">{data}</DataArray></Points>
<Cells><DataArray type="Int64" Name="connectivity" format="ascii">0 1 2 3</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">4</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">10</DataArray></Cells>
</Piece></UnstructuredGrid></VTKFile>"""


def test_a_vtu_that_unpacks_to_gigabytes_is_stopped(tmp_path):
    limits = Limits(file=50_000_000, memory=700_000_000, seconds=20, result=20_000_000)
    sentence = refused(damaged(tmp_path, "bomb.vtu", packed_vtu(400, 32_000_000)), limits=limits)
    assert "memory" in sentence
    # one tetrahedron is read within the same memory
    sound = damaged(tmp_path, "four.vtu", packed_vtu(1, 96))
    assert len(read_in_process("read mesh", sound, {}, limits)["cells"]) == 1


def test_a_file_that_takes_too_long_is_stopped(samples):
    folder, _ = samples
    limits = Limits(seconds=1)
    request = {
        "smallest_detail": 0.0,
        "seat": {"radius": 300},
        "held": [{"point": [0, 0, -420], "normal": [0, 0, 1]}],
        "bolts": None,
        "part": None,
        "kind": "Cylinder",
        "radius": 300.0,
        "tolerance": 1e-4,
        "along": [1.0, 0.0, 0.0],
        "low": -100.0,
        "high": 100.0,
        "centre": None,
        "size": 20.0,
        "per_turn": 200,
        "optimise": True,
    }
    with pytest.raises(InputError, match="more than 1 s of processor time"):
        read_in_process("mesh step", folder / "split_housing.step", request, limits)


@pytest.mark.parametrize(
    ("points", "cells", "words"),
    [
        (TETRAHEDRON * np.nan, [("tetra", [[0, 1, 2, 3]])], "no finite position"),
        (TETRAHEDRON, [("triangle", [[0, 1, 2]])], "must have tetrahedra of 4 or 10 nodes"),
        (
            np.vstack([TETRAHEDRON, TETRAHEDRON + 2]),
            [("hexahedron", [[0, 1, 2, 3, 4, 5, 6, 7]])],
            "elements of kind hexahedron",
        ),
    ],
)
def test_meshes_of_no_use_are_refused(tmp_path, points, cells, words):
    meshio.write(tmp_path / "a.vtu", meshio.Mesh(points, cells))
    with pytest.raises(InputError, match=words):
        read(str(tmp_path / "a.vtu"))


def test_a_node_that_there_is_not_is_refused(tmp_path):
    path = tmp_path / "a.inp"
    path.write_text("*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n*ELEMENT,TYPE=C3D4\n1,1,2,3,9\n")
    with pytest.raises(InputError, match=r"a.inp"):
        read(str(path))


def test_an_input_deck_that_reads_other_files_is_refused(tmp_path):
    path = tmp_path / "a.inp"
    path.write_text("*INCLUDE, INPUT=/etc/passwd\n")
    with pytest.raises(InputError, match="includes other files"):
        read(str(path))


def test_straight_tetrahedra_get_nodes_in_the_middle_of_their_edges(tmp_path):
    points = np.vstack([TETRAHEDRON, [[1, 1, 1.0]]])
    cells = [("tetra", [[0, 1, 2, 3], [1, 2, 3, 4]])]
    meshio.write(tmp_path / "a.vtu", meshio.Mesh(points, cells))
    found = read(str(tmp_path / "a.vtu"))
    assert bool(found["linear"])
    assert len(found["points"]) == 5 + 9  # edges, the three of the common facet once
    ends = found["points"][found["cells"][:, [0, 1]]].mean(axis=1)
    assert np.allclose(found["points"][found["cells"][:, 4]], ends)


def test_a_mesh_inside_out_is_refused(tmp_path):
    meshio.write(tmp_path / "a.vtu", meshio.Mesh(TETRAHEDRON, [("tetra", [[0, 2, 1, 3]])]))
    housing = ForeignHousing(
        mesh=str(tmp_path / "a.vtu"),
        unit="m",
        seat={"radius": 0.3, "axis": [1, 0, 0], "point": [0, 0, 0]},
        held=[{"point": [0, 0, 0]}],
    )
    with pytest.raises(InputError, match="1 of its 1 elements are inside out"):
        placed_housing(housing, Bearing(kind="ring"), MeshSizes())


def test_a_damaged_housing_ends_a_command_with_status_2_and_one_sentence(samples, tmp_path, invoke):
    folder, _ = samples
    whole = (folder / "ribbed_pillow_block.step").read_text()
    (tmp_path / "half.step").write_text(whole[: len(whole) // 2])
    (tmp_path / "mine.yaml").write_text(
        "title: t\nshaft: {front: -1.0, sections: [{length: 2.2, outer_diameter: 0.4}]}\n"
        "bearing_units:\n  - bearing: {name: main_bearing, kind: ring}\n    interface: bonded\n"
        "    housing: {step: half.step, seat: {radius: 300}, held: [{point: [0, 0, -420]}]}\n"
        "gearbox: {stiffness: [4.0e6, 8.0e7, 8.0e7, rigid, 0, 0]}\n"
    )
    for words in (("check", "mine.yaml"), ("part", "half.step")):
        status, _, error = invoke(*words)
        assert status == 2
        assert "half.step cannot be read as STEP" in error


def test_small_details_are_removed_where_asked_for_and_with_a_message(tmp_path):
    with gmsh_session():
        occ = gmsh.model.occ
        bored, _ = occ.cut(
            [(3, occ.addBox(-0.5, -0.5, -0.5, 1, 1, 1))],
            [(3, occ.addCylinder(-1, 0, 0, 2, 0, 0, 0.3))],
        )
        occ.synchronize()
        edge = next(
            tag
            for _, tag in gmsh.model.getEntities(1)
            if gmsh.model.getType(1, tag) == "Line" and occ.getMass(1, tag) == pytest.approx(1)
        )
        face = int(gmsh.model.getAdjacencies(1, edge)[0][0])
        ((_, solid),) = occ.chamfer([bored[0][1]], [edge], [face], [5e-5])
        write_step(tmp_path / "box.step", [solid])
    housing = {
        "step": str(tmp_path / "box.step"),
        "seat": {"radius": 300},
        "held": [{"point": [0, 0, -500], "normal": [0, 0, 1]}],
    }
    sizes, bearing = MeshSizes(housing=0.3, elements_per_turn=8), Bearing(kind="ring")
    with gmsh_session():
        assert opened(housing["step"])["after"]["faces"] == 8
    with pytest.warns(UserWarning, match="box.step: healing has removed 1 faces and 3 edges"):
        found = placed_housing(ForeignHousing(**housing, smallest_detail=0.2), bearing, sizes)
    assert found.facts["faces removed"] == 1


def test_edges_are_those_of_all_tetrahedra() -> None:
    np.testing.assert_array_equal(np.sort(_EDGES, axis=1), TETRAHEDRON_EDGES)
