"""Decks of Abaqus and CalculiX: read as they are meant, or refused with the line and the reason."""

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.elasticity.mesh.measures import mass_moments
from fe_drivetrain.foreign.from_file import body_of_mesh
from fe_drivetrain.foreign.mesh_file import read
from fe_drivetrain.foreign.survey import surveyed
from fe_drivetrain.geometry import ForeignFile, Pick

#: A unit cube of six tetrahedra, its nodes numbered with gaps, as programs do.
NODES = """*NODE
5, 0., 0., 0.
15, 1., 0., 0.
25, 0., 1., 0.
35, 1., 1., 0.
45, 0., 0., 1.
55, 1., 0., 1.
65, 0., 1., 1.
75, 1., 1., 1.
"""
TETRAHEDRA = """1, 5, 15, 35, 75
2, 5, 15, 75, 55
3, 5, 55, 75, 45
4, 5, 35, 25, 75
5, 5, 25, 65, 75
6, 5, 65, 45, 75
"""
CUBE = NODES + "*ELEMENT, TYPE=C3D4, ELSET=BLOCK\n" + TETRAHEDRA
PART = f"*PART, NAME=P\n{CUBE}*NSET, NSET=FOOT\n5, 15, 25, 35\n*END PART\n*ASSEMBLY, NAME=A\n"


def deck(folder, text):
    path = folder / "a.inp"
    path.write_text(text)
    return str(path)


def members(found):
    return {key: len(value) for key, value in found.items() if " " in key}


def box(found, cells=slice(None)):
    used = found["points"][np.unique(found["cells"][cells])]
    return used.min(axis=0).tolist(), used.max(axis=0).tolist()


def volume(found):
    return float(mass_moments(found["points"], found["cells"])[0])


def test_a_second_section_of_nodes_adds_to_the_first(tmp_path):
    """It replaced the first one's positions: the volume was 16, from z = 5 on."""
    far = "".join(f"{100 + k}, {2 * (k & 1)}., {k & 2}., {5 + (k & 4) // 2}.\n" for k in range(8))
    five = "100,101,102,104\n101,103,102,107\n101,107,104,105\n102,104,107,106\n101,102,104,107"
    second = "".join(f"{201 + k},{row}\n" for k, row in enumerate(five.split()))
    text = f"{CUBE}*NODE\n{far}*ELEMENT, TYPE=C3D4, ELSET=B201\n{second}"
    found = read(deck(tmp_path, text))
    assert len(found["cells"]) == 11
    assert volume(found) == pytest.approx(9.0, rel=1e-14)
    assert box(found) == ([0, 0, 0], [2, 2, 7])
    assert box(found, found["solid BLOCK"]) == ([0, 0, 0], [1, 1, 1])


@pytest.mark.parametrize(
    ("more", "sets"),
    [
        ("*NODE, NSET=REF\n9999, 0., 0., 5.\n", {"nodes REF": 1}),
        ("*ELSET, ELSET=LOW, GENERATE\n1, 3, 1\n5, 6, 1\n", {"solid LOW": 5}),
        ("*ELSET, ELSET=ODD, GENERATE\n1, 2000000000, 2\n", {"solid ODD": 3}),
        ("*NSET, NSET=A, GENERATE\n5, 35, 10\n*NSET,NSET=A\n45\n", {"nodes A": 5}),
        (
            "*NSET, NSET=BASE\n5, 15, 25, 35\n*NSET, NSET=HELD\nBase\n",
            {"nodes BASE": 4, "nodes HELD": 4},
        ),
        (
            "*NSET, NSET=BOTH\nTOP, 5\n*NSET, NSET=TOP\n45, 55,\n65, 75\n",
            {"nodes BOTH": 5, "nodes TOP": 4},
        ),
        ("*NSET, NSET=ALL, ELSET=BLOCK\n", {"nodes ALL": 8}),
        ("*NSET, NSET=NONE\n", {"empty NONE": 0}),
        ("*NSET, NSET=NONE\n4711\n", {"empty NONE": 0}),
        ("*ELEMENT, TYPE=S3, ELSET=FACE\n11, 5, 15, 35\n", {"face FACE": 1}),
        ("*ELEMENT, TYPE=CPS3, ELSET=FACE\n11, 5, 15, 35\n12, 5, 35, 25\n", {"face FACE": 2}),
        ("*SURFACE, NAME=FOOT\n1, S1\n4, S1\n", {"face FOOT": 2}),
        ("*SURFACE, NAME=FOOT\nBLOCK, S1\n", {"face FOOT": 6}),
        ("*SURFACE, NAME=FOOT, TYPE=NODE\n5\n15\n", {"nodes FOOT": 2}),
        ("** 1\n\n*NSET,\nNSET=A\n** 2\n5\n\n15,\n", {"nodes A": 2}),
        ('*nset , nset = "My Set" , unsorted\n 5 , 15\n', {"nodes My Set": 2}),
        ("*HEADING\nTeil für 5\n*STEP\n*NODE FILE\nU\n*NODE PRINT, NSET=ALL\nU\n", {}),
        ("*BOUNDARY\n5, 1, 6\n*MATERIAL, NAME=STEEL\n*ELASTIC\n2.1e11, 0.3\n", {}),
    ],
)
def test_sets_are_those_that_the_cards_say(tmp_path, more, sets):
    found = read(deck(tmp_path, CUBE + more))
    assert volume(found) == pytest.approx(1.0, rel=1e-14)
    assert members(found) == {"solid BLOCK": 6, **sets}


def test_faces_of_a_surface_are_the_sides_that_it_names(tmp_path):
    found = read(deck(tmp_path, f"{CUBE}*SURFACE, NAME=X\n1, S1\n1, S2\n2, S3\n3, S4\n"))
    corners = [sorted(map(tuple, found["points"][face].tolist())) for face in found["face X"]]
    of = {5: (0, 0, 0), 15: (1, 0, 0), 35: (1, 1, 0), 75: (1, 1, 1), 55: (1, 0, 1), 45: (0, 0, 1)}
    for got, wanted in zip(
        corners, ((5, 15, 35), (5, 15, 75), (15, 75, 55), (75, 45, 5)), strict=True
    ):
        assert got == sorted(of[n] for n in wanted)


def test_elements_of_ten_nodes_may_go_on_over_lines_and_have_faces_of_six(tmp_path):
    corners = [(0, 0, 0), (2, 0, 0), (0, 2, 0), (0, 0, 2)]
    middles = [(1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (0, 1, 1)]
    rows = "".join(f"{n}, {x}, {y}, {z}\n" for n, (x, y, z) in enumerate(corners + middles, 1))
    text = f"*NODE\n{rows}*ELEMENT, TYPE=C3D10, ELSET=ALL\n1, 1, 2, 3, 4, 5,\n6, 7, 8, 9, 10\n"
    found = read(deck(tmp_path, f"{text}*ELEMENT, TYPE=S6, ELSET=F\n2, 1, 2, 3, 5, 6, 7\n"))
    assert volume(found) == pytest.approx(8 / 6, rel=1e-14)
    assert members(found) == {"solid ALL": 1, "face F": 1}


def test_masses_and_springs_are_left_out_and_said(tmp_path):
    more = "*NODE\n99, 0, 0, 3.D0\n*ELEMENT, TYPE=MASS, ELSET=M\n77, 99\n"
    text = surveyed(deck(tmp_path, f"{CUBE}{more}*NSET, NSET=NONE\n")).text
    assert "left out, as it carries nothing in a housing: 1 of MASS" in text
    assert "box: (0, 0, 0) to (1, 1, 1), volume 1" in text
    assert "empty sets by label: M, NONE" in text


def test_instances_are_placed_copies_with_sets_of_their_own(tmp_path):
    """The second is shifted by 3 along x, and turned by a quarter about z through (3, 0, 0)."""
    text = (
        f"{PART}*INSTANCE, NAME=one, PART=P\n*END INSTANCE\n"
        "*INSTANCE, NAME=two, PART=P\n3., 0., 0.\n3., 0., 0., 3., 0., 1., 90.\n*END INSTANCE\n"
        "*NSET, NSET=FEET, INSTANCE=one\n5\n*NSET, NSET=FEET, INSTANCE=two\n5, 15\n"
        "*NSET, NSET=BOTH\none.FOOT, two.FOOT\n*END ASSEMBLY\n"
    )
    found = read(deck(tmp_path, text))
    assert volume(found) == pytest.approx(2.0, rel=1e-14)
    assert box(found, found["solid two.BLOCK"]) == ([2, 0, 0], [3, 1, 1])
    sets = {"nodes one.FOOT": 4, "nodes two.FOOT": 4, "nodes FEET": 3, "nodes BOTH": 8}
    assert members(found) == {"solid one.BLOCK": 6, "solid two.BLOCK": 6, **sets}


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (f"{CUBE}*INCLUDE, INPUT=more.inp\n", r"line 17: \*INCLUDE takes 'more.inp': write the"),
        ("*NODE, INPUT=nodes.txt\n", r"line 1: \*NODE takes 'nodes.txt'"),
        (f"{CUBE}*NGEN\n5, 15\n", r"line 17: \*NGEN generates nodes"),
        (f"{CUBE}*ELCOPY, OLD SET=BLOCK\n", r"\*ELCOPY copies elements"),
        ("*SYSTEM\n0,0,1\n", r"\*SYSTEM gives nodes in other coordinates"),
        ("*NODE, SYSTEM=C\n1, 0, 0, 0\n", "SYSTEM=C gives other coordinates than x, y and z"),
        (f"{CUBE}*NODE\n5, 0., 0., 1.\n", r"line 18: node 5 is at \(0, 0, 1\), but in line 2 at"),
        (f"{CUBE}*ELEMENT, TYPE=C3D4\n6, 5, 15, 35, 55\n", "element 6 is there before"),
        (f"{CUBE}*ELEMENT, TYPE=C3D4\n7, 5, 15, 35, 4\n", "element 7 .* has the node 4, which"),
        (f"{CUBE}*ELEMENT, TYPE=C3D4\n7, 5, 15, 35\n", "line 18: .* has 4 numbers, but must"),
        (f"{CUBE}*ELEMENT, TYPE=C3D4\n7, 5, 15, 35, 55, 4\n", "line 18: .* more numbers than"),
        (f"{CUBE}*ELEMENT, TYPE=C3D8R\n7, 5\n", "elements of kind C3D8R are no tetrahedra"),
        (f"{CUBE}*ELEMENT\n7, 5\n", "elements of kind none are no tetrahedra"),
        (f"{CUBE}*NSET, NSET=A\nLOWER\n", "line 17: there is no set of nodes 'LOWER'"),
        (f"{CUBE}*NSET, NSET=A\nB\n*NSET, NSET=B\na\n", "the set 'A' contains itself"),
        (f"{CUBE}*NSET, NSET=A, GENERATE\n5, 1, 1\n", "line 18: a generated set has the line"),
        (f"{CUBE}*NSET\n5\n", r"\*NSET has no name: add NSET=NAME"),
        ("*NODE\n1, 0, 1_0, 0\n", "line 2: '1_0' must be a number"),
        ("*NODE\n1, 0, nan, 0\n", "line 2: 'nan' must be a number"),
        ("*NODE\n1.5, 0, 0, 0\n", "line 2: '1.5' must be the whole number of a node or element"),
        (PART, "has parts but no .INSTANCE that places them"),
        (f"{PART}*INSTANCE, NAME=x, PART=Q\n", "instance 'x' is of the part 'Q'.* one of P"),
        (f"{PART}*INSTANCE, NAME=x, PART=P\n0\n1, 2\n", "turned by 2 numbers but must be by 7"),
        ("", "holds no nodes"),
        (NODES, "elements of kind none but must have tetrahedra"),
        (f"{NODES}*ELEMENT, TYPE=C3D4\n", "elements of kind none but must have tetrahedra"),
        (
            "*NODE\n1, 0, 0, 1e300\n2,1,0,0\n3,0,1,0\n4,0,0,1\n*ELEMENT,TYPE=C3D4\n1,1,2,3,4\n",
            "but",
        ),
    ],
)
def test_what_is_wrong_is_said_with_its_line(tmp_path, text, words):
    path = deck(tmp_path, text)
    with pytest.raises(InputError, match=words) as error:
        read(path)
    assert "a.inp" in str(error.value)
    assert len(str(error.value)) < 300


def copied(step, shift):
    """The cube again with other numbers, shifted along x."""
    rows = [row.split(",") for row in NODES.splitlines()[1:]]
    nodes = "".join(f"{int(n) + step},{float(x) + shift},{y},{z}\n" for n, x, y, z in rows)
    cells = [[int(n) for n in row.split(",")] for row in TETRAHEDRA.splitlines()]
    lines = "".join(f"{e + step}, {', '.join(str(n + step) for n in ns)}\n" for e, *ns in cells)
    return f"*NODE\n{nodes}*ELEMENT, TYPE=C3D4\n{lines}"


@pytest.mark.parametrize("shift", [0.0, 0.5, -0.7])
def test_parts_that_stand_in_one_another_are_noticed(tmp_path, shift):
    path = deck(tmp_path, CUBE + copied(100, shift))
    with pytest.raises(InputError, match=r"elements overlap at \d+ of 24 faces of the outside"):
        read(path)


@pytest.mark.parametrize("shift", [1.0, 5.0])
def test_parts_that_touch_or_stand_apart_are_read(tmp_path, shift):
    assert volume(read(deck(tmp_path, CUBE + copied(100, shift)))) == pytest.approx(2.0)


def test_two_elements_on_one_side_of_a_face_are_noticed(tmp_path):
    text = f"{CUBE}*NODE\n99, 0.9, 0.1, 0.3\n*ELEMENT, TYPE=C3D4\n7, 5, 15, 35, 99\n"
    with pytest.raises(InputError, match="1 faces have two of them on one side, the first near"):
        read(deck(tmp_path, text))


def test_a_set_that_holds_no_face_is_not_among_those_to_choose(tmp_path):
    more = "*NSET, NSET=REF\n5\n*NSET, NSET=NONE\n*NSET, NSET=BASE\n5, 15, 25, 35\n"
    part = ForeignFile(mesh=deck(tmp_path, CUBE + more), unit="m")
    _, surface = body_of_mesh(part)
    assert len(surface.picked(Pick(label="BASE"), "held face")) == 2
    with pytest.raises(
        InputError, match=r"set 'NONE' for the held face is empty.*of REF, BASE, or"
    ):
        surface.picked(Pick(label="NONE"), "held face")
    with pytest.raises(InputError, match="set 'REF' for the held face holds no whole face"):
        surface.picked(Pick(label="REF"), "held face")
