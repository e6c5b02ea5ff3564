"""Matrix files, read by the programs that they are for."""

import csv
import re
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from coarse_scenes import coarse_scene
from hypothesis import given
from hypothesis import strategies as st
from scipy.io import mmread
from scipy.linalg import eigh
from test_superelement import random_element

from fe_drivetrain import export
from fe_drivetrain.cases.export import second_reader
from fe_drivetrain.cases.export.calculix_runs import (
    compliance_by_calculix,
    frequencies_by_calculix,
    held,
)
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError, MissingToolError
from fe_drivetrain.common.scaling import scaled_to_unit_diagonal
from fe_drivetrain.common.stiffness_bands import StiffnessBands
from fe_drivetrain.export.calculix_results import ROUNDING, read_dat
from fe_drivetrain.export.formats.calculix_springs import model_lines, squares
from fe_drivetrain.export.formats.dmig import double
from fe_drivetrain.export.formats.statement import comment_lines, commented, statement
from fe_drivetrain.export.from_scene import shaft_superelement, unit_superelement
from fe_drivetrain.export.programs.ccx import run_calculix
from fe_drivetrain.export.superelement import FRAME, UNITS, Superelement
from fe_drivetrain.shafts.fidelity.ladder import shaft_level

ROOT = Path(__file__).parents[2]
TEXTS = ("csv", "mtx", "mtx-mass", "dmig", "calculix")


def difference(found: Floats, expected: Floats) -> float:
    """Largest, of a unit diagonal."""
    size = np.sqrt(np.outer(expected.diagonal(), expected.diagonal()))
    return float(np.abs((found - expected) / size).max())


def moderate_element(n: int, seed: int = 0, supported: bool = True) -> Superelement:
    """Full matrices whose entries span no more orders than those of a shaft in SI."""
    rng = np.random.default_rng(seed)
    size = 10.0 ** rng.uniform(3, 5, 6 * n)
    root, inertia = rng.standard_normal((2, 6 * n, 6 * n))
    K, M = size[:, None] * (root @ root.T) * size, inertia @ inertia.T
    positions = np.column_stack([np.arange(n), np.zeros((n, 2))])
    names = tuple(f"p{k}" for k in range(n))
    return Superelement(
        f"full_{seed}", names, positions, 0.5 * (K + K.T), 0.5 * (M + M.T), supported
    )


@pytest.fixture(scope="module")
def shaft() -> Superelement:
    return shaft_superelement(coarse_scene("bonded"), 2)


def written(path: Path, element: Superelement, format: str) -> Path:
    target = path / f"{format}{export.FORMATS[format].suffix}"
    export.write_superelement(target, element, format)
    return target


@pytest.mark.parametrize("format", TEXTS)
def test_a_text_says_what_it_is(tmp_path: Path, format: str, shaft: Superelement) -> None:
    element = replace(shaft, band=StiffnessBands(0.02, 0.001, 0.03))
    lines = written(tmp_path, element, format).read_text().splitlines()
    if format == "csv":
        said = {row[0]: row[1] for row in csv.reader(lines) if len(row) == 2}
        said = {key[2:]: value for key, value in said.items()}
    else:
        said = commented(lines, {"dmig": "$", "calculix": "**"}.get(format, "%"))
    assert said["frame"] == FRAME
    assert said["units"] == UNITS
    assert said["scene hash"] == shaft.origin.scene_hash
    assert said["scene"] == shaft.origin.scene
    assert said["level"] == "2 meridian in harmonics"
    assert said["band"] == "axial 0.02, torsion 0.001, bending 0.03 of the stiffness"
    assert said["supports"] == "none: the body is free"
    assert said["point 2"] == "main_bearing at 0.0 0.0 0.0 m"
    assert float(said["check, force against rigid motions"].split()[0]) < 1e-12


@pytest.mark.parametrize("mark", ["$", "%", "**"])
def test_a_statement_survives_as_comments(mark: str) -> None:
    """Lines of words, blanks, colons and the mark itself."""
    title = f"A: title {mark} of  many\nlines " + "word " * 40
    element = random_element(1)
    element = replace(element, origin=replace(element.origin, scene=title, mesh=""))
    said = statement(element)
    assert commented(comment_lines(said, mark), mark) == said
    assert said["scene"] == " ".join(title.split())


@pytest.mark.parametrize(
    "format",
    [
        "csv",
        "mtx",
        "calculix",
        "op4",
        "dmig",
    ],
)
def test_a_damaged_file_is_read_or_refused(
    tmp_path: Path, capfd: pytest.CaptureFixture[str], format: str
) -> None:
    """Characters and lines changed, left out, doubled: no other error, and nothing is printed."""
    path = written(tmp_path, moderate_element(1), format)
    good = path.read_text().splitlines()
    rng = np.random.default_rng(0)
    messages = []
    for _ in range(60):
        lines = list(good)
        k = int(rng.integers(len(lines)))
        match rng.integers(4):
            case 0:
                del lines[k]
            case 1:
                lines.insert(k, lines[int(rng.integers(len(lines)))])
            case 2:
                lines[k] = lines[k][: int(rng.integers(len(lines[k]) + 1))]
            case _:
                place = int(rng.integers(len(lines[k]) + 1))
                letter = "0123456789.,-+eED *$%#x"[int(rng.integers(23))]
                lines[k] = lines[k][:place] + letter + lines[k][place + 1 :]
        path.write_text("\n".join([*lines, ""]))
        try:
            export.read_superelement(path, format)
        except InputError as error:
            messages.append(str(error))
    assert len(messages) > 20
    assert all(str(path) in message for message in messages)
    assert capfd.readouterr() == ("", "")


# --- Matrix Market and HDF5 ---------------------------------------------------------------------


@pytest.mark.parametrize("seed", [0, 1])
def test_scipy_reads_matrix_market(tmp_path: Path, seed: int) -> None:
    element = random_element(seed)
    assert element.mass is not None
    assert (mmread(written(tmp_path, element, "mtx")) == element.stiffness).all()
    mass = written(tmp_path, element, "mtx-mass")
    assert (mmread(mass) == element.mass).all()
    with pytest.raises(InputError, match="holds a mass"):
        export.read_superelement(mass, "mtx")


def test_a_matrix_market_file_of_others_has_no_points(tmp_path: Path) -> None:
    path = tmp_path / "a.mtx"
    path.write_text("%%MatrixMarket matrix array real general\n1 1\n2.0\n")
    with pytest.raises(InputError, match="does not state"):
        export.read_superelement(path, "mtx")


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("\n6 6\n", "\n6 6\n1.0\n", "22 numbers are not"),
        ("\n6 6\n", "\n99999 99999\n", "21 numbers are not"),
        ("\n6 6\n", "\n6 6 6\n", "no Matrix Market file"),
        ("\n6 6\n", "\n6 6\n1.0 2.0\n", "no Matrix Market file"),
        ("array real", "array complex", "first line"),
        ("% point 1", "% dot 1", "does not state"),
    ],
)
def test_a_wrong_matrix_market_file_says_why(
    tmp_path: Path, old: str, new: str, message: str
) -> None:
    path = written(tmp_path, moderate_element(1), "mtx")
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))
    with pytest.raises(InputError, match=message) as caught:
        export.read_superelement(path, "mtx")
    assert str(path) in str(caught.value)


def test_a_general_array_is_read_by_columns(tmp_path: Path) -> None:
    """As other programs write it."""
    element = moderate_element(2)
    path = written(tmp_path, element, "mtx")
    lines = path.read_text().splitlines()
    head = [line for line in lines[1:] if line.startswith("%")]
    body = [repr(value) for value in element.stiffness.T.ravel().tolist()]
    first = "%%MatrixMarket matrix array real general"
    path.write_text("\n".join([first, *head, "12 12", *body]))
    assert (export.read_superelement(path, "mtx").stiffness == element.stiffness).all()


def test_no_mass_makes_no_file(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="has no mass"):
        export.write_superelement(tmp_path / "a.mtx", random_element(0, mass=False), "mtx-mass")
    assert not list(tmp_path.iterdir())


@pytest.mark.needs("h5py")
def test_h5py_reads_hdf5(tmp_path: Path, shaft: Superelement) -> None:
    import h5py

    with h5py.File(written(tmp_path, shaft, "hdf5")) as file:
        assert (file["stiffness"][:] == shaft.stiffness).all()
        assert (file["mass"][:] == shaft.mass).all()
        assert (file["positions"][:] == shaft.positions).all()
        assert [name.decode() for name in file["points"][:]] == list(shaft.points)
        assert file["degrees_of_freedom"][4].decode() == "hub ry"
        assert file.attrs["scene hash"] == shaft.origin.scene_hash


@pytest.mark.needs("h5py")
def test_hdf5_of_others_is_refused(tmp_path: Path) -> None:
    import h5py

    path = tmp_path / "a.h5"
    with h5py.File(path, "w") as file:
        file["other"] = [1.0]
    with pytest.raises(InputError, match="no dataset 'stiffness'"):
        export.read_superelement(path, "hdf5")
    with h5py.File(path, "w") as file:
        file.create_group("stiffness")
    with pytest.raises(InputError, match=r"a\.h5"):
        export.read_superelement(path, "hdf5")


# --- CSV ----------------------------------------------------------------------------------------


@pytest.mark.needs("pandas")
def test_csv_is_one_table_with_labels(tmp_path: Path, shaft: Superelement) -> None:
    import pandas

    text = written(tmp_path, shaft, "csv").read_text()
    start = text.splitlines().index(next(x for x in text.splitlines() if x.startswith("matrix,")))
    table = pandas.read_csv(tmp_path / "csv.csv", skiprows=start, comment="#", index_col=[0, 1])
    stiffness = table.loc["stiffness"]
    assert list(stiffness.index) == list(stiffness.columns)
    # some versions of pandas read numbers to the last bit but one
    np.testing.assert_allclose(stiffness.loc["hub rx", "gearbox rx"], shaft.stiffness[3, 15], 1e-15)
    np.testing.assert_allclose(stiffness.to_numpy(), shaft.stiffness, 1e-15)
    np.testing.assert_allclose(table.loc["mass"].to_numpy(), shaft.mass, 1e-15)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("stiffness,p0 uy,", "stiffness,p0 uz,", "line 1[0-9]: row 'p0 uz'"),
        ("stiffness,p0 ux,", "stiffness,p0 ux,x", "line 1[0-9]: could not convert"),
        ("mass,", "damping,", "matrices stiffness, damping"),
        ("# level,", "# floor,", "does not state 'level'"),
        ("# end", "", "cut off"),
        ("p0 at 0.0 0.0", "p0 at 0.0", "positions of shape"),
        ("# supports,in the stiffness", "# supports,perhaps", "perhaps"),
    ],
)
def test_a_wrong_csv_says_where(tmp_path: Path, old: str, new: str, message: str) -> None:
    path = written(tmp_path, moderate_element(1), "csv")
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))
    with pytest.raises(InputError, match=message) as caught:
        export.read_superelement(path, "csv")
    assert str(path) in str(caught.value)


# --- Nastran ------------------------------------------------------------------------------------


@given(st.floats(min_value=-1e30, max_value=1e30, allow_nan=False))
def test_sixteen_characters_keep_ten_digits(value: float) -> None:
    text = double(value)
    assert len(text) <= 16
    assert "." in text
    # a sign, a digit, a point, and D with a sign and two digits leave nine more: half of the last
    tiny = abs(value) < 1e-99
    assert abs(float(text.replace("D", "E")) - value) <= (1e-90 if tiny else 5e-10 * abs(value))


def dmig_by_pynastran(path: Path) -> tuple[dict[str, Floats], Floats]:
    """Matrices with six degrees of freedom of each grid in order, and positions."""
    model = second_reader.pynastran("bdf.bdf").BDF(debug=None)
    model.read_bdf(str(path), punch=True, xref=False)
    found = {}
    for name, matrix in model.dmig.items():
        values, rows, columns = matrix.get_matrix()
        assert rows == columns
        order = sorted(rows, key=lambda k: rows[k])
        assert [rows[k] for k in order] == [(g, c) for g in model.nodes for c in range(1, 7)]
        found[name] = values[np.ix_(order, order)]
    return found, np.array([node.xyz for node in model.nodes.values()])


@pytest.mark.needs("pyNastran")
@pytest.mark.parametrize("seed", [0, 1, 3])
def test_pynastran_reads_dmig(tmp_path: Path, seed: int) -> None:
    element = random_element(seed)
    assert element.mass is not None
    found, positions = dmig_by_pynastran(written(tmp_path, element, "dmig"))
    assert set(found) == {f"KRANDOM{seed}", f"MRANDOM{seed}"}
    assert difference(found[f"KRANDOM{seed}"], element.stiffness) < 1e-9
    assert difference(found[f"MRANDOM{seed}"], element.mass) < 1e-9
    np.testing.assert_allclose(positions, element.positions, rtol=1e-9)


@pytest.mark.needs("pyNastran")
def test_a_free_shaft_stays_free_in_dmig(tmp_path: Path, shaft: Superelement) -> None:
    """Rounding to the characters of a field is all that a rigid motion then meets."""
    found, _ = dmig_by_pynastran(written(tmp_path, shaft, "dmig"))
    assert replace(shaft, stiffness=found["KSHAFT"]).rigid_error() < 1e-9


def entries(path: Path) -> list[tuple[str, str, str]]:
    """Matrix name and column, row, value of each DMIG entry in large fields."""
    found, column = [], ""
    for line in path.read_text().splitlines():
        if line.startswith("DMIG*"):
            column = line[8:56]
        elif line.startswith("*") and column:
            found.append((column, line[8:40], line[40:56]))
    return found


def test_a_dmig_names_grid_and_component_of_each_entry(tmp_path: Path) -> None:
    """Read by its columns alone: fields of 8, then of 16 characters (MSC Nastran, DMIG)."""
    element = moderate_element(3)
    found: dict[str, dict[tuple[int, ...], float]] = {"K": {}, "M": {}}
    column: tuple[int, ...] = ()
    for line in written(tmp_path, element, "dmig").read_text().splitlines():
        if line.startswith("DMIG*"):
            letter, column = line[8], (int(line[24:40]), int(line[40:56]))
        elif line.startswith("*") and column:
            row = int(line[8:24]), int(line[24:40])
            found[letter][row + column] = float(line[40:56].replace("D", "e"))
    motions = [(grid, component) for grid in (1, 2, 3) for component in range(1, 7)]
    for letter, matrix in (("K", element.stiffness), ("M", element.mass)):
        assert matrix is not None
        lower = {
            row + column: matrix[i, j]
            for j, column in enumerate(motions)
            for i, row in enumerate(motions)
            if i >= j
        }
        assert found[letter] == pytest.approx(lower, rel=1e-9)


@pytest.mark.needs("pyNastran")
def test_one_triangle_of_a_symmetric_dmig_is_the_whole_matrix(tmp_path: Path) -> None:
    """Columns from the diagonal down, as here; and down to it, as Nastran punches them."""
    element = moderate_element(2)
    path = written(tmp_path, element, "dmig")
    lower = entries(path)
    assert len(lower) == 2 * 12 * 13 // 2
    assert all(row >= column[16:48] for column, row, _ in lower)
    text = path.read_text().splitlines()
    end = next(k for k, line in enumerate(text) if line.startswith("DMIG*"))
    headers = [line for line in text if line.startswith("DMIG ")]
    upper = [line for line in text[:end] if line not in headers] + headers
    for column, row, value in lower:
        upper.append(f"DMIG*   {column[:16]}{row}{'':16}")
        upper.append(f"*       {column[16:48]}{value}")
    other = tmp_path / "upper.bdf"
    other.write_text("\n".join([*upper, text[-1], ""]))
    there, _ = dmig_by_pynastran(path)
    for name, matrix in there.items():
        assert (matrix == matrix.T).all()
        assert np.count_nonzero(matrix) == 144, name
    mine, theirs = export.read_superelement(path, "dmig"), export.read_superelement(other, "dmig")
    assert (mine.stiffness == there["KFULL0"]).all()
    assert (mine.stiffness == theirs.stiffness).all()
    assert mine.mass is not None
    assert theirs.mass is not None
    assert (mine.mass == theirs.mass).all()


def test_columns_of_a_dmig_may_stand_in_any_order(tmp_path: Path) -> None:
    """They are known by their numbers."""
    element = moderate_element(2)
    path = written(tmp_path, element, "dmig")
    text = path.read_text().splitlines()
    end = next(k for k, line in enumerate(text) if line.startswith("DMIG*"))
    headers = [line for line in text if line.startswith("DMIG ")]
    lines = [line for line in text[:end] if line not in headers] + headers
    for column, row, value in reversed(entries(path)):
        lines += [f"DMIG*   {column}", f"*       {row}{value}"]
    path.write_text("\n".join([*lines, text[-1], ""]))
    assert difference(export.read_superelement(path, "dmig").stiffness, element.stiffness) < 1e-9


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("DMIG*   KFULL0  ", "DMIG*   KFULL1  ", "bulk data"),
        ("$ matrix K: KFULL0", "$ matrix K: KFULL9", "no DMIG 'KFULL9'"),
        ("GRID*                  1", "GRID*                  7", "its GRID entries"),
        ("GRID*   ", "GRIX*   ", r"a\.bdf|dmig\.bdf"),
        ("$ end", "$ ende", "cut off"),
    ],
)
def test_a_wrong_dmig_gets_one_sentence(tmp_path: Path, old: str, new: str, message: str) -> None:
    path = written(tmp_path, moderate_element(1), "dmig")
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))
    with pytest.raises(InputError, match=message) as caught:
        export.read_superelement(path, "dmig")
    assert str(path) in str(caught.value)


@pytest.mark.needs("pyyeti")
def test_pyyeti_reads_dmig_and_op4(tmp_path: Path, shaft: Superelement) -> None:
    """A second reader, that knows nothing of the first."""
    from pyyeti.nastran import bulk, op4

    frames = bulk.rddmig(str(written(tmp_path, shaft, "dmig")))
    for name, expected in (("kshaft", shaft.stiffness), ("mshaft", shaft.mass)):
        assert expected is not None
        assert difference(frames[name].to_numpy(), expected) < 1e-9
    matrices = op4.read(str(written(tmp_path, shaft, "op4")))
    assert (matrices["kgg"] == 0.5 * (shaft.stiffness + shaft.stiffness.T)).all()
    assert (matrices["mgg"] == shaft.mass).all()
    assert (matrices["xyz"] == shaft.positions).all()


def test_op4_tells_the_free_from_the_supported(tmp_path: Path, shaft: Superelement) -> None:
    assert not export.read_superelement(written(tmp_path, shaft, "op4"), "op4").supported
    (tmp_path / "op4.op4").unlink()
    assert export.read_superelement(written(tmp_path, moderate_element(2), "op4"), "op4").supported


@pytest.mark.needs("pyNastran")
def test_pynastran_reads_op4(tmp_path: Path, shaft: Superelement) -> None:
    op4 = second_reader.pynastran("op4.op4").OP4(debug=False)
    found = op4.read_op4(str(written(tmp_path, shaft, "op4")))
    assert (found["KGG"].data == 0.5 * (shaft.stiffness + shaft.stiffness.T)).all()
    assert (found["MGG"].data == shaft.mass).all()
    assert (found["XYZ"].data == shaft.positions).all()


def test_an_absent_pynastran_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    def absent(name: str) -> object:
        raise ImportError(name)

    monkeypatch.setattr(second_reader, "import_module", absent)
    with pytest.raises(MissingToolError, match=r'pip install "fe-drivetrain\[consumers\]"'):
        second_reader.pynastran("op4.op4")


def test_no_extra_of_a_user_holds_numpy_back() -> None:
    """pyNastran checks what is written, and needs numpy 1: only the checks install it."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    extras = dict(project["optional-dependencies"])
    assert any(needed.startswith("pyNastran") for needed in extras.pop("consumers"))
    needs = [*project["dependencies"], *(needed for extra in extras.values() for needed in extra)]
    assert [n for n in needs if re.match(r"(?i)pynastran|numpy\b.*<|.*\bconsumers\b", n)] == []


# --- CalculiX -----------------------------------------------------------------------------------


def assert_printed(found: Floats, stiffness: Floats) -> None:
    """The compliance of a stiffness, to the digits of a .dat file.

    Beside these stands the round-off of a deck's fourteen digits, times the condition of what is
    solved.
    """
    expected = np.linalg.inv(stiffness)
    size = np.sqrt(np.outer(expected.diagonal(), expected.diagonal()))
    solved = 1e-13 * np.linalg.cond(scaled_to_unit_diagonal(stiffness))
    assert (np.abs(found - expected) <= ROUNDING * np.abs(expected) + solved * size).all()


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_squares_sum_up_to_the_matrix(seed: int) -> None:
    K = random_element(seed).stiffness
    values, forms = squares(K)
    assert (values > 0).all()
    assert difference(forms.T @ (values[:, None] * forms), K) < 1e-13


def test_a_free_body_has_six_squares_less(shaft: Superelement) -> None:
    assert len(squares(shaft.stiffness)[0]) == 6 * len(shaft.points) - 6


@pytest.mark.needs("ccx")
@pytest.mark.parametrize("seed", [0, 1, 3])
def test_ccx_moves_as_a_random_stiffness_says(tmp_path: Path, seed: int) -> None:
    element = random_element(seed)
    assert_printed(compliance_by_calculix(element, tmp_path), element.stiffness)


@pytest.mark.needs("ccx")
def test_ccx_moves_as_the_free_shaft_and_as_a_bearing_unit(
    tmp_path: Path, shaft: Superelement
) -> None:
    assert_printed(compliance_by_calculix(shaft, tmp_path), shaft.stiffness[6:, 6:])
    unit = unit_superelement(coarse_scene("bonded"), "main_bearing")
    assert_printed(compliance_by_calculix(unit, tmp_path), unit.stiffness)


@pytest.mark.needs("ccx")
def test_ccx_swings_as_stiffness_and_mass_say(tmp_path: Path, shaft: Superelement) -> None:
    for element, count in ((shaft, 2), (moderate_element(4), 3)):
        start = held(element)
        assert element.mass is not None
        K, M = element.stiffness[start:, start:], element.mass[start:, start:]
        size = 1.0 / np.sqrt(np.outer(K.diagonal(), K.diagonal()))
        expected = 1.0 / np.sqrt(eigh(M * size, K * size)[0][::-1][:count]) / (2.0 * np.pi)
        found = frequencies_by_calculix(element, tmp_path, count)
        # seven digits, of which the eigenvalue solver leaves the last uncertain
        np.testing.assert_allclose(found, expected, rtol=1e-6)


@pytest.mark.needs("ccx")
def test_two_superelements_stand_in_one_deck(tmp_path: Path) -> None:
    """Shaft and housing, so to speak: numbers of their own, and their first points tied."""
    a, b = moderate_element(2, 5), moderate_element(1, 6)
    second = 1000
    lines = [*model_lines(a), *model_lines(b, second, second), "*EQUATION"]
    for dof in range(6):
        node, component = dof // 3, dof % 3 + 1
        lines += ["2", f"{second + node},{component},1.,{1 + node},{component},-1."]
    for dof in range(12):
        lines += ["*STEP", "*STATIC", "*CLOAD, OP=NEW"]
        lines += [f"{dof // 3 + 1},{dof % 3 + 1},1."]
        lines += ["*NODE PRINT, NSET=FULL_5_POINTS", "U", "*END STEP"]
    deck = tmp_path / "two.inp"
    deck.write_text("".join(f"{line}\n" for line in lines))
    found = np.array([t.values.ravel() for t in read_dat(run_calculix(deck))]).T
    together = a.stiffness.copy()
    together[:6, :6] += b.stiffness
    assert_printed(found, together)


@pytest.mark.needs("ccx")
def test_ccx_puts_a_drivetrain_together_from_its_parts(tmp_path: Path, shaft: Superelement) -> None:
    """Free shaft, bearing unit and gearbox reaction in one deck: the hub moves as at level 2."""
    scene = coarse_scene("bonded")
    unit = unit_superelement(scene, "main_bearing")
    second = 1000
    lines = [*model_lines(shaft), *model_lines(unit, second, second), "*EQUATION"]
    seat, gearbox = (1 + 2 * shaft.points.index(name) for name in ("main_bearing", "gearbox"))
    for dof in range(6):
        node, component = dof // 3, dof % 3 + 1
        lines += ["2", f"{second + node},{component},1.,{seat + node},{component},-1."]
    for dof, k in enumerate(scene.gearbox.stiffness):
        node, component = gearbox + dof // 3, dof % 3 + 1
        if k == "rigid":
            lines += ["*BOUNDARY", f"{node},{component},{component}"]
        elif k:
            lines += [f"*ELEMENT, TYPE=SPRING1, ELSET=G{dof}", f"{2000 + dof},{node}"]
            lines += [f"*SPRING, ELSET=G{dof}", f"{component}", f"{k:.13e}"]
    for dof in range(6):
        lines += ["*STEP", "*STATIC", "*CLOAD, OP=NEW"]
        lines += [f"{dof // 3 + 1},{dof % 3 + 1},1."]
        lines += ["*NODE PRINT, NSET=SHAFT_POINTS", "U", "*END STEP"]
    deck = tmp_path / "drivetrain.inp"
    deck.write_text("".join(f"{line}\n" for line in lines))
    found = np.array([t.values.ravel()[:6] for t in read_dat(run_calculix(deck))]).T
    model = shaft_level(scene, 2, {"main_bearing": unit.stiffness})
    assert_printed(found, model.stiffness(["hub"]))


def test_too_many_frequencies_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="6 degrees of freedom for each of 3"):
        frequencies_by_calculix(moderate_element(1), tmp_path, 3)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("*EQUATION", "*EQUATIONS"),
        ("*SPRING, ELSET=FULL_0_1\n1\n", "*SPRING, ELSET=FULL_0_99\n1\n"),
        ("*NODE, NSET=FULL_0_POINTS", "*NODE"),
        ("\n13\n", "\n99\n"),
        ("** end", "** fin"),
    ],
)
def test_a_wrong_deck_gets_one_sentence(tmp_path: Path, old: str, new: str) -> None:
    path = written(tmp_path, moderate_element(2), "calculix")
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))
    with pytest.raises(InputError, match=r"calculix\.inp"):
        export.read_superelement(path, "calculix")
