"""Matrices of other programs in every form that they write: one and the same superelement."""

import struct
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fe_drivetrain import export
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.spatial import point_motions
from fe_drivetrain.export.formats.labelled_matrices import Naming
from fe_drivetrain.export.formats.op4_records import matrices_of
from fe_drivetrain.export.superelement import Superelement

POSITIONS = np.array([[-2.0, 0.25, 0.5], [2.5, 0.0, -0.125]])
#: Between the two points, at the second: N/m, N/rad, N m/rad.
SPRING = np.diag([5e9, 3e8, 2e8, 4e7, 6e8, 7e8])
SPRING[1, 5] = SPRING[5, 1] = -3e8
POINTS = ("bore=3", "foot=11")


def between(positions: Floats, spring: Floats) -> Floats:
    """Stiffness of a spring at the second point, which rigid motions do not strain."""
    strain = np.hstack([-point_motions(positions[1:], positions[0]), np.eye(6)])
    return strain.T @ spring @ strain


STIFFNESS = between(POSITIONS, SPRING)
MASS = np.kron(np.diag([1.0, 2.0]), np.diag([800.0, 800.0, 800.0, 50.0, 60.0, 70.0]))
STRUT = Superelement("strut", ("bore", "foot"), POSITIONS, STIFFNESS, MASS)


def close(found: Superelement, relative: float = 1e-12) -> None:
    for mine, wanted in ((found.stiffness, STIFFNESS), (found.mass, MASS)):
        assert mine is not None
        np.testing.assert_allclose(mine, wanted, atol=relative * np.abs(wanted).max(), rtol=0)
    np.testing.assert_allclose(found.positions, POSITIONS, rtol=1e-9)
    assert found.points == ("bore", "foot")
    assert not found.supported


# --- Nastran bulk data ---------------------------------------------------------------------------


def free(*fields: object) -> str:
    return ",".join(map(str, fields)) + "\n"


def small(*fields: object) -> str:
    return f"{fields[0]:<8}" + "".join(f"{field:>8}" for field in fields[1:]) + "\n"


def dmig(
    name: str, matrix: Floats, degrees: list[tuple[int, int]], card: Callable[..., str] = free
) -> str:
    """The lower triangle, a term a line."""
    lines = [card("DMIG", name, 0, 6, 2, 0)]
    for j, column in enumerate(degrees):
        for i in range(j, len(degrees)):
            if matrix[i, j]:
                value = repr(float(matrix[i, j])).replace("e+", "D")
                lines.append(card("DMIG", name, *column, "", *degrees[i], value))
    return "".join(lines)


DEGREES = [(grid, component) for grid in (3, 11) for component in range(1, 7)]


def grids(scale: float = 1.0) -> str:
    rows = zip((3, 11), scale * POSITIONS, strict=True)
    return "".join(free("GRID", number, "", *map(float, place)) for number, place in rows)


def deck(stiffness: Floats = STIFFNESS, mass: Floats = MASS, head: str = "") -> str:
    return head + grids() + dmig("KAAX", stiffness, DEGREES) + dmig("MAAX", mass, DEGREES)


def read(folder: Path, text: str, **said: Any) -> Superelement:
    path = folder / "a.bdf"
    path.write_text(text)
    return export.read_superelement(path, "dmig", Naming(**{"points": POINTS, **said}))


def test_an_export_without_its_comments_has_the_same_matrix(tmp_path: Path) -> None:
    export.write_superelement(tmp_path / "own.bdf", STRUT, "dmig")
    own = export.read_superelement(tmp_path / "own.bdf", "dmig")
    lines = (tmp_path / "own.bdf").read_text().splitlines(keepends=True)
    (tmp_path / "a.bdf").write_text("".join(line for line in lines if line[0] != "$"))
    found = export.read_superelement(tmp_path / "a.bdf", "dmig")
    assert (found.stiffness == own.stiffness).all()
    assert own.mass is not None
    assert found.mass is not None
    assert (found.mass == own.mass).all()
    np.testing.assert_array_equal(found.positions, own.positions)
    assert found.points == ("grid_1", "grid_2")
    assert not found.supported


def test_grid_and_dmig_of_others_are_read(tmp_path: Path) -> None:
    close(read(tmp_path, deck()))
    head = "SOL 103\nCEND\nK2GG = KAAX\nM2GG= maax\nBEGIN BULK\n"
    close(read(tmp_path, deck(head=head) + dmig("KOTHER", STIFFNESS, DEGREES) + "ENDDATA\nJUNK"))
    turned = read(tmp_path, deck(), points=POINTS[::-1])
    assert turned.points == ("foot", "bore")
    np.testing.assert_allclose(turned.stiffness[:6, :6], STIFFNESS[6:, 6:], rtol=1e-12)
    assert read(tmp_path, deck(), points=()).points == ("grid_3", "grid_11")


def test_small_fields_and_short_exponents_are_read(tmp_path: Path) -> None:
    text = small("GRID", 1, "", "0.", "0.", "0.") + small("DMIG", "K1", 0, 1, 2, 0)
    for c in range(1, 7):
        text += small("DMIG", "K1", 1, c, "", 1, c, "2.5+7")
        if c in (1, 5):
            text += small("", 1, 6 - c, "-1.-3")
    found = read(tmp_path, text, points=("bore=1",))
    expected = 2.5e7 * np.eye(6)
    expected[0, 4] = expected[4, 0] = -1e-3
    np.testing.assert_array_equal(found.stiffness, expected)
    assert found.supported


def test_millimetres_newtons_and_tonnes_are_taken_as_such(tmp_path: Path) -> None:
    motions = np.tile([1e3, 1e3, 1e3, 1.0, 1.0, 1.0], 2)  # of the file for those in m and rad
    scaled = STIFFNESS * 1e3 / np.outer(motions, motions)
    masses = MASS * 1e3 / np.outer(motions, motions)
    text = grids(1e3) + dmig("K", scaled, DEGREES) + dmig("M", masses, DEGREES)
    close(read(tmp_path, text, units="mm"))
    assert scaled[0, 0] == pytest.approx(STIFFNESS[0, 0] / 1e3)  # N/mm
    assert masses[0, 0] == pytest.approx(MASS[0, 0] / 1e3)  # t
    assert masses[3, 3] == pytest.approx(MASS[3, 3] * 1e3)  # t mm^2


def test_motions_in_another_coordinate_system_are_turned(tmp_path: Path) -> None:
    """System 7 has its z along x and its x along y; GRID 11 stands and moves in it."""
    axes = np.array([[0.0, 0, 1], [1, 0, 0], [0, 1, 0]])
    turn = np.eye(12)
    turn[6:9, 6:9] = turn[9:, 9:] = axes
    at = axes.T @ POSITIONS[1]
    text = free("CORD2R", 7, "", 0.0, 0.0, 0.0, 1.0, 0.0, 0.0) + free("", 0.0, 1.0, 0.0)
    text += free("GRID", 3, 0, *map(float, POSITIONS[0])) + free("GRID", 11, 7, *at.tolist(), 7)
    local = (turn.T @ STIFFNESS @ turn, turn.T @ MASS @ turn)
    close(read(tmp_path, text + dmig("K", local[0], DEGREES) + dmig("M", local[1], DEGREES)))


def test_modes_of_craig_and_bampton_and_further_points_are_condensed(tmp_path: Path) -> None:
    """Modes leave the stiffness as it is; a point in the middle leaves springs in series."""
    modes = [(1001, 0), (1002, 0)]
    stiffness, mass = np.zeros((14, 14)), np.zeros((14, 14))
    stiffness[:12, :12], mass[:12, :12] = STIFFNESS, MASS
    stiffness[12:, 12:] = np.diag([4e5, 9e5])
    mass[12:, 12:] = np.eye(2)
    mass[12, :12] = mass[:12, 12] = 3.0
    degrees = [*DEGREES, *modes]
    close(read(tmp_path, grids() + dmig("K", stiffness, degrees) + dmig("M", mass, degrees)))
    middle = POSITIONS.mean(axis=0)
    halves = np.zeros((18, 18))
    soft = np.diag(np.full(6, 1e8))
    first = np.r_[0:6, 12:18]
    halves[np.ix_(first, first)] += between(np.array([POSITIONS[0], middle]), soft)
    second = np.r_[12:18, 6:12]
    halves[np.ix_(second, second)] += between(np.array([middle, POSITIONS[1]]), soft)
    text = grids() + free("GRID", 20, "", *map(float, middle))
    more = [*DEGREES, *((20, c) for c in range(1, 7))]
    found = read(tmp_path, text + dmig("K", halves, more))
    assert found.mass is None
    arm = point_motions(POSITIONS[1:], middle)
    series = np.linalg.inv(arm @ np.linalg.inv(soft) @ arm.T + np.linalg.inv(soft))
    wanted = between(POSITIONS, series)
    np.testing.assert_allclose(found.stiffness, wanted, atol=1e-10 * wanted.max(), rtol=0)


@pytest.mark.parametrize(
    ("text", "said", "words"),
    [
        (deck() + dmig("KAA", STIFFNESS, DEGREES) + dmig("KGG", STIFFNESS, DEGREES), {}, "has 3"),
        (deck(), {"stiffness_name": "KGG"}, "no stiffness 'KGG': name one of KAAX, MAAX"),
        (deck(), {"points": ("bore=4",)}, r"no component 1 of the point bore \(4\)"),
        (deck(), {"points": ("bore",)}, "'bore'.* must be as in 'hub=101'"),
        (deck(), {"points": ("bore=3", "bore=11")}, "give each point once"),
        (deck(), {"points": ("bore=3", "foot=3")}, "are the same one"),
        (deck(), {"units": "ft"}, "`units='ft'` must be one of m, mm"),
        (grids(), {}, "no square DMIG entries"),
        (dmig("K", STIFFNESS, DEGREES), {}, r"no position of the point bore \(3\)"),
        (dmig("K", STIFFNESS, DEGREES), {"points": ()}, "position and six degrees of freedom"),
        (deck().replace("DMIG,KAAX,0,6,2", "DMIG,KAAX,0,6,4"), {}, "line 3: .*complex"),
        (deck().replace("DMIG,KAAX,0,6,2", "DMIG,KAAX,0,7,2"), {}, "line 3: .* the form 7"),
        (deck().replace("DMIG,KAAX,0", "DMIG,KBBX,0"), {}, "line 4: DMIG KAAX has no header"),
        (deck().replace("DMIG,KAAX,3,2,", "DMIG,KAAX,3,9,"), {}, "point 3 with component 9"),
        (deck() + "DMIG,KAAX,3,1,,3,1,1.0\n", {}, r"row \(3, 1\) and column \(3, 1\) twice"),
        (deck().replace("GRID,3,,-2.0", "GRID,3,,2..0"), {}, "line 1: GRID has '2..0' in its"),
        (deck().replace("GRID,11,", "GRID,3,"), {}, "line 2: GRID 3 is there before"),
        (deck().replace("GRID,3,,", "GRID,3,8,"), {}, "GRID 3 is in the coordinate system 8"),
        (deck().replace("GRID,3,,-2.0", "GRID,3,,-2000."), {}, "position of bore is .*give metres"),
        ("INCLUDE 'more.bdf'\n" + deck(), {}, "line 1: it includes another file"),
        (deck(stiffness=-STIFFNESS), {}, "negative eigenvalue"),
        (deck(stiffness=1e295 * STIFFNESS), {}, r"must be finite, at most 1e\+30"),
        ("", {}, "no square DMIG"),
    ],
)
def test_what_is_open_or_wrong_is_one_sentence(
    tmp_path: Path, text: str, said: dict[str, Any], words: str
) -> None:
    with pytest.raises(InputError, match=words) as caught:
        read(tmp_path, text, **said)
    assert "a.bdf" in str(caught.value)
    assert len(str(caught.value)) < 500


# --- OUTPUT4 -------------------------------------------------------------------------------------


def record(order: str, content: bytes) -> bytes:
    length = struct.pack(f"{order}i", len(content))
    return length + content + length


def binary(name: str, matrix: Floats, order: str, form: str) -> bytes:
    """A matrix of double precision, its columns dense or one string of terms each."""
    rows, columns = matrix.shape
    sign = -1 if form == "big" else 1
    head = struct.pack(f"{order}4i", columns, sign * rows, 2, 2) + name.ljust(8).encode()
    out = record(order, head)
    for k, column in enumerate(matrix.T, 1):
        words = 2 * rows
        before = {
            "dense": b"",
            "big": struct.pack(f"{order}2i", words + 1, 1),
            "small": struct.pack(f"{order}i", 1 + 65536 * (words + 1)),
        }[form]
        first = 1 if form == "dense" else 0
        start = struct.pack(f"{order}3i", k, first, words + len(before) // 4)
        out += record(order, start + before + struct.pack(f"{order}{rows}d", *column))
    return out + record(order, struct.pack(f"{order}3i", columns + 1, 1, 2) + bytes(8))


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("form", ["dense", "big", "small"])
def test_output4_of_others_is_read_to_the_last_bit(tmp_path: Path, order: str, form: str) -> None:
    path = tmp_path / "a.op4"
    path.write_bytes(
        binary("KXX", STIFFNESS, order, form)
        + binary("K4XX", STIFFNESS, order, form)
        + binary("MXX", MASS, order, form)
    )
    assert (matrices_of(path)["KXX"] == STIFFNESS).all()
    places = [f"{n}={','.join(map(str, p))}" for n, p in zip(STRUT.points, POSITIONS, strict=True)]
    close(export.read_superelement(path, "op4", Naming(tuple(places))))


def test_points_of_output4_stand_in_bulk_data_beside_it(tmp_path: Path) -> None:
    """The order of rows is that of EXTRN; a mode comes before the points by its number."""
    degrees = sorted([*DEGREES, (1, 0)])
    at = [degrees.index(f) for f in DEGREES]
    stiffness, mass = 4e5 * np.eye(13), np.eye(13)
    stiffness[np.ix_(at, at)], mass[np.ix_(at, at)] = STIFFNESS, MASS
    path, beside = tmp_path / "a.op4", tmp_path / "a.pch"
    path.write_bytes(binary("KAA", stiffness, "<", "dense") + binary("MAA", mass, "<", "dense"))
    beside.write_text(grids() + free("EXTRN", 3, 123456, 11, 123456, 1, 0))
    close(export.read_superelement(path, "op4", Naming(POINTS, grids=str(beside))))
    beside.write_text(grids() + free("ASET1", 123456, 3, 11) + free("SPOINT", 1))
    with pytest.raises(InputError, match="has 13 rows, but its points have 12 degrees of freedom"):
        export.read_superelement(path, "op4", Naming(POINTS, grids=str(beside)))
    with pytest.raises(InputError, match=r"which points its 13 rows are of: give `points`"):
        export.read_superelement(path, "op4")
    with pytest.raises(InputError, match=r"`grids='.*none.pch'`: cannot read"):
        export.read_superelement(path, "op4", Naming(POINTS, grids=str(tmp_path / "none.pch")))


def test_complex_and_huge_matrices_of_output4_are_left_out(tmp_path: Path) -> None:
    path = tmp_path / "a.op4"
    huge = binary("BIG", np.ones((1, 2)), "<", "dense").replace(
        struct.pack("<4i", 2, 1, 2, 2), struct.pack("<4i", 2, 2_000_000_000, 2, 2)
    )
    phasor = binary("C", np.ones((4, 1)), "<", "dense").replace(
        struct.pack("<4i", 1, 4, 2, 2), struct.pack("<4i", 1, 2, 2, 4)
    )
    path.write_bytes(huge + phasor + binary("K", STIFFNESS, "<", "dense"))
    assert list(matrices_of(path)) == ["K"]
    path.write_bytes(huge + phasor)
    with pytest.raises(InputError, match=r"no real matrix of at most 6000 .* \(BIG, C\)"):
        matrices_of(path)


# --- substructures and Harwell-Boeing ------------------------------------------------------------


def triangle(matrix: Floats) -> str:
    return "".join(
        ",".join(f"{value:.13e}" for value in row[: k + 1]) + ",\n" for k, row in enumerate(matrix)
    )


def test_a_substructure_of_abaqus_is_read(tmp_path: Path) -> None:
    text = "**\n** ELEMENT NUMBER 1\n*USER ELEMENT,NODES=2,LINEAR\n** ELEMENT NODES\n** 3, 11\n"
    text += f"1, 2, 3, 4, 5, 6\n*MATRIX,TYPE=STIFFNESS\n{triangle(STIFFNESS)}"
    (tmp_path / "a.mtx").write_text(text + f"*MATRIX,TYPE=MASS\n{triangle(MASS)}")
    points = ("bore=3,-2,0.25,0.5", "foot=11,2.5,0,-0.125")
    close(export.read_superelement(tmp_path / "a.mtx", "substructure", Naming(points)))
    (tmp_path / "a.mtx").write_text(text[:-40])
    with pytest.raises(InputError, match="is no matrix of a substructure, or is cut off"):
        export.read_superelement(tmp_path / "a.mtx", "substructure", Naming(points))


def test_a_substructure_of_calculix_has_nodes_that_turn(tmp_path: Path) -> None:
    """It names a node for each degree of freedom; rotations are motions of a node of their own."""
    nodes = [3] * 3 + [4] * 3 + [11] * 3 + [12] * 3
    dofs = [1, 2, 3] * 4
    text = f"**\n** GENERATION OF SUBSTRUCTURE\n*USER ELEMENT,NODES=        {len(nodes)},LINEAR\n"
    text += "** ELEMENT NODES\n**" + ",".join(f"{n:10}" for n in nodes[:10]) + ",\n"
    text += "**" + ",".join(f"{n:10}" for n in nodes[10:]) + ",\n" + f"{dofs[0]:10}\n"
    text += "".join(f"{k:10},{dof:10}\n" for k, dof in list(enumerate(dofs, 1))[1:])
    (tmp_path / "a.mtx").write_text(f"{text}*MATRIX,TYPE=STIFFNESS\n{triangle(STIFFNESS)}")
    points = ("bore=3+4,-2,0.25,0.5", "foot=11+12,2.5,0,-0.125")
    found = export.read_superelement(tmp_path / "a.mtx", "substructure", Naming(points))
    close(replace(found, mass=MASS))


def test_a_matrix_market_file_of_ours_is_read_by_its_first_line(tmp_path: Path) -> None:
    export.write_superelement(tmp_path / "a.mtx", STRUT, "mtx")
    found = export.read_superelement(tmp_path / "a.mtx", "substructure")
    assert (found.stiffness == 0.5 * (STIFFNESS + STIFFNESS.T)).all()


def test_harwell_boeing_of_ansys_is_read(tmp_path: Path) -> None:
    places = [(i, j) for j in range(12) for i in range(j, 12) if STIFFNESS[i, j]]
    starts = np.r_[1, 1 + np.cumsum([sum(j == k for _, j in places) for k in range(12)])]

    def lines(values: Any, form: str, per_line: int) -> str:
        cells = [format(value, form) for value in values]
        rows = [cells[k : k + per_line] for k in range(0, len(cells), per_line)]
        return "".join("".join(row) + "\n" for row in rows)

    head = f"{'ANSYS':72}{'K':8}\n{100:14}{2:14}{10:14}{30:14}{0:14}\n"
    head += f"RSA{'':11}{12:14}{12:14}{len(places):14}{0:14}\n"
    head += f"{'(8I10)':16}{'(8I10)':16}{'(4E20.12)':20}{'(4E20.12)':20}\n"
    text = head + lines(starts.tolist(), "10d", 8) + lines([i + 1 for i, _ in places], "10d", 8)
    text += lines([STIFFNESS[place] for place in places], "20.12E", 4)
    path = tmp_path / "a.matrix"
    path.write_text(text)
    points = ("bore=-2,0.25,0.5", "foot=2.5,0,-0.125")
    found = export.read_superelement(path, "harwell-boeing", Naming(points))
    close(replace(found, mass=MASS), relative=1e-11)
    path.write_text(text[:-90])
    with pytest.raises(InputError, match="is no Harwell-Boeing matrix, or is cut off"):
        export.read_superelement(path, "harwell-boeing", Naming(points))


def test_a_file_that_says_all_itself_takes_no_names(tmp_path: Path) -> None:
    export.write_superelement(tmp_path / "a.json", STRUT, "json")
    with pytest.raises(InputError, match=r"names its points .* itself: leave out `units='mm'`"):
        export.read_superelement(tmp_path / "a.json", "json", Naming(units="mm"))
    with pytest.raises(InputError, match="'substructure' can be read only: write another one"):
        export.write_superelement(tmp_path / "a.mtx", STRUT, "substructure")
