"""Broken solids and meshes as housings: one sentence with the place, and no long wait."""

import re

import gmsh
import meshio
import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.foreign.mesh_file import read
from fe_drivetrain.foreign.reading import Limits, read_in_process
from fe_drivetrain.foreign.step_solid import opened
from fe_drivetrain.foreign.step_text import refuse_damaged_step
from fe_drivetrain.foreign.survey import surveyed
from fe_drivetrain.geometry import gmsh_session
from fe_drivetrain.geometry.step_files import write_step

SMALL = Limits(file=5_000_000, memory=1_500_000_000, seconds=10, result=20_000_000)
CORNERS = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 1.0]])
PAIR = [[0, 1, 2, 3], [1, 2, 3, 4]]


@pytest.fixture(scope="module")
def bored(tmp_path_factory):
    """Text of a STEP file of a bored block, and what its shell lists."""
    path = tmp_path_factory.mktemp("bored") / "block.step"
    with gmsh_session():
        occ = gmsh.model.occ
        box, hole = occ.addBox(-0.2, -0.5, -0.5, 0.4, 1, 1), occ.addCylinder(-1, 0, 0, 2, 0, 0, 0.3)
        ((_, solid),), _ = occ.cut([(3, box)], [(3, hole)])
        write_step(path, [solid])
    text = path.read_text()
    return text, re.search(r"CLOSED_SHELL\s*\(\s*'[^']*'\s*,\s*\(([^()]*)\)", text)[1]


def refused_solid(path):
    with gmsh_session(), pytest.raises(InputError) as error:
        opened(str(path))
    sentence = str(error.value)
    assert path.name in sentence
    assert sentence.count(". ") == 0
    return sentence


def prism(path, outline):
    """A prism along x over corners (y, z), whose sides may cross."""
    with gmsh_session():
        occ = gmsh.model.occ
        points = [occ.addPoint(0, *corner) for corner in outline]
        lines = [occ.addLine(a, b) for a, b in zip(points, points[1:] + points[:1], strict=True)]
        face = occ.addPlaneSurface([occ.addCurveLoop(lines)])
        solids = [tag for dim, tag in occ.extrude([(2, face)], 0.3, 0, 0) if dim == 3]
        write_step(path, solids)
    return path


@pytest.mark.parametrize("kept", [slice(1, None), slice(0, -1), slice(0, 1)])
def test_an_open_shell_is_refused_with_the_place_of_a_free_edge(bored, tmp_path, kept):
    text, shell = bored
    path = tmp_path / "open.step"
    path.write_text(text.replace(shell, ",".join(shell.split(",")[kept])))
    assert re.search(r"belong to one face alone, the first round \(.*\) mm", refused_solid(path))


def test_a_solid_whose_faces_cross_so_that_it_encloses_nothing_is_refused(tmp_path):
    path = prism(tmp_path / "bow.step", [(-0.5, -0.5), (0.5, -0.5), (-0.5, 0.5), (0.5, 0.5)])
    assert "round (150, 0, 0) mm encloses" in refused_solid(path)


def test_a_solid_that_cuts_itself_is_refused(tmp_path):
    outline = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5), (-0.5, 0.45), (0.8, 0.9)]
    path = prism(tmp_path / "cut.step", [*outline, (0.9, 0.8), (-0.9, 0.4)])
    assert "its faces cross" in refused_solid(path)


@pytest.mark.parametrize("value", ["NAN", "1.E300"])
def test_a_place_that_is_no_number_or_far_away_is_refused_with_its_entity(bored, tmp_path, value):
    path = tmp_path / "odd.step"
    path.write_text(bored[0].replace("-0.2,-0.5,-0.5", f"-0.2,{value},-0.5"))
    assert re.search(
        rf"its entity #\d+ is at \(-0.2,{re.escape(value)},-0.5\)", refused_solid(path)
    )


def test_a_face_that_contains_its_own_shell_ends_the_child_alone(bored, tmp_path):
    text = bored[0]
    shell = re.search(r"(#\d+) = CLOSED_SHELL", text)[1]
    path = tmp_path / "cycle.step"
    path.write_text(
        re.sub(r"ADVANCED_FACE\('',\(#\d+", f"ADVANCED_FACE('',({shell}", text, count=1)
    )
    with pytest.raises(InputError, match=r"cycle.step makes its reader fail"):
        read_in_process("look", path, {"smallest_detail": 0.0}, SMALL)


def test_thin_faces_and_the_same_face_twice_do_no_harm(bored, tmp_path):
    text, shell = bored
    path = tmp_path / "twice.step"
    path.write_text(text.replace(shell, f"{shell},{shell.split(',')[0]}"))
    with gmsh_session():
        assert opened(str(path))["after"]["volume"] == pytest.approx(
            4e8 - np.pi * 300**2 * 400, rel=1e-9
        )
    with gmsh_session():
        occ = gmsh.model.occ
        box = occ.addBox(0, 0, 0, 1, 1, 1)
        ((_, solid),), _ = occ.cut([(3, box)], [(3, occ.addBox(-1, 0.5, 0.999999, 3, 1, 1))])
        write_step(tmp_path / "step.step", [solid])
    with gmsh_session():
        areas = [face["area"] for face in opened(str(tmp_path / "step.step"))["faces"]]
    assert min(areas) == pytest.approx(1.0, rel=1e-3)  # mm^2, of a face 1 um wide


def mesh(folder, points, cells):
    path = folder / "a.vtu"
    meshio.write(path, meshio.Mesh(np.asarray(points), [("tetra", cells)]))
    return path


def test_elements_that_stand_twice_are_refused_with_their_place(tmp_path):
    path = mesh(tmp_path, CORNERS, [*PAIR, [2, 1, 0, 3]])
    with pytest.raises(
        InputError,
        match=r"1 of its 3 elements stand where another does, the first near \(0.25, 0.25, 0.25\)",
    ):
        read(str(path))


def test_a_node_far_away_is_refused_and_nodes_of_no_element_are_left_out(tmp_path):
    far = CORNERS.copy()
    far[4] = 1e300
    with pytest.raises(InputError, match=r"node 4 is at \(1e\+300, 1e\+300, 1e\+300\)"):
        read(str(mesh(tmp_path, far, PAIR)))
    lost = np.vstack([CORNERS, [[np.nan] * 3], CORNERS[:1] + 9])
    text = surveyed(mesh(tmp_path, lost, PAIR)).text
    assert "2 tetrahedra of 4 nodes" in text
    assert "(0, 0, 0) to (1, 1, 1)" in text


def test_a_mesh_inside_out_is_described_without_its_faces(tmp_path):
    text = surveyed(mesh(tmp_path, CORNERS, [[0, 2, 1, 3]])).text
    assert "elements fold over" in text
    assert "volume unknown" in text


HUGE = {
    "a.msh": "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n2000000000\n1 0 0 0\n$EndNodes\n",
    "b.msh": "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 2000000000 1 2000000000\n"
    "3 1 0 2000000000\n1\n0 0 0\n$EndNodes\n",
    "c.msh": "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n2\n1 0 0 0\n9000000000000 0 0 1\n"
    "$EndNodes\n",
    "d.vtu": '<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian">'
    '<UnstructuredGrid><Piece NumberOfPoints="4000000000" NumberOfCells="1"><Points><DataArray '
    'type="Float64" NumberOfComponents="3" format="ascii">0 0 0</DataArray></Points><Cells>'
    '<DataArray type="Int64" Name="connectivity" format="ascii">0</DataArray></Cells></Piece>'
    "</UnstructuredGrid></VTKFile>",
    "e.inp": "*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n*ELEMENT,TYPE=C3D4\n1,1,2,3,4\n"
    "*NSET,NSET=A,GENERATE\n1,4000000000,1\n*ELEMENT,TYPE=C3D4\n2,1,2,3,4000000000\n",
}


@pytest.mark.parametrize("name", HUGE)
def test_huge_counts_and_labels_end_in_a_sentence_and_status_2(name, tmp_path, invoke):
    path = tmp_path / name
    path.write_text(HUGE[name])
    status, out, error = invoke("part", str(path))
    assert status == 2, out
    assert name in error
    assert "Traceback" not in error


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("));", ";", r"#\d+ is not whole"),
        (" = PLANE(", " PLANE(", "what follows #\\d+ is not whole"),
        ("#1 =", "\n#1 = PLANE('');#1 ;", "not whole"),
    ],
)
def test_a_step_file_with_an_entity_that_is_not_whole_is_refused_by_its_number(
    tmp_path, old, new, words
):
    path = tmp_path / "block.step"
    with gmsh_session():
        write_step(path, [gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)])
    refuse_damaged_step(str(path))
    head, data = path.read_text().split("DATA;")
    path.write_text(f"{head}DATA;{data.replace(old, new, 1)}")
    with pytest.raises(InputError, match=words):
        refuse_damaged_step(str(path))


def test_strings_and_comments_of_a_step_file_may_hold_anything(tmp_path):
    path = tmp_path / "words.step"
    path.write_text("DATA;\n#1=NAME('a;b(''c', #2);/* ( ; */\n#2=(A(1.)B());\nENDSEC;\n")
    refuse_damaged_step(str(path))
