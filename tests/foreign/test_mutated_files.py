"""Files of other programs that are wrong at random: read soundly, or refused in one sentence.

A few mutants of each form are tried; 500 of each by FE_DRIVETRAIN_MUTANTS=500.
"""

import json
from collections import Counter
from pathlib import Path
from typing import Any

import gmsh
import numpy as np
import pytest
from file_mutants import COUNT, mutants, outcome

from fe_drivetrain import export
from fe_drivetrain.common.spatial import point_motions
from fe_drivetrain.elasticity.mesh.measures import scaled_jacobians
from fe_drivetrain.export.formats.labelled_matrices import Naming
from fe_drivetrain.export.superelement import Superelement
from fe_drivetrain.foreign.child import _ACTIONS
from fe_drivetrain.foreign.mesh_file import read
from fe_drivetrain.foreign.step_solid import opened
from fe_drivetrain.geometry import gmsh_session

DECK = """*HEADING
 a cube
*NODE, NSET=ALL
5, 0., 0., 0.
15, 1., 0., 0.
25, 0., 1., 0.
35, 1., 1., 0.
** comment
45, 0., 0., 1.
55, 1., 0., 1.
65, 0., 1., 1.
75, 1., 1., 1.
*ELEMENT, TYPE=C3D4, ELSET=BLOCK
1, 5, 15, 35, 75
2, 5, 15, 75, 55
3, 5, 55, 75, 45
4, 5, 35, 25, 75
5, 5, 25, 65, 75
6, 5, 65, 45, 75
*ELEMENT, TYPE=S3, ELSET=FOOT
11, 5, 15, 35
12, 5, 35, 25
*NSET, NSET=BASE
5, 15,
25, 35
*NSET, NSET=HELD
BASE, 45
*ELSET, ELSET=LOW, GENERATE
1, 3, 1
*SURFACE, NAME=UNDER
LOW, S1
*STEP
*END STEP
"""
MESHES = (
    "cube.inp",
    "cube.vtu",
    "v22.msh",
    "v41.msh",
    "binary.msh",
    "cube.unv",
    "cube.med",
    "cube.stl",
)
SOLIDS = ("cube.igs", "cube.brep", "cube.step")
LOOKED = "bored.step"
MATRICES = {
    "own.json": ("json", Naming()),
    "own.csv": ("csv", Naming()),
    "own.bdf": ("dmig", Naming()),
    "other.bdf": ("dmig", Naming(("a=1", "b=2"))),
    "own.op4": ("op4", Naming()),
    "other.op4": ("op4", Naming(("a=0,0,0", "b=2,0,0"))),
    "other.mtx": ("substructure", Naming(("a=3,0,0,0", "b=11,2,0,0"))),
    "other.matrix": ("harwell-boeing", Naming(("a=0,0,0", "b=2,0,0"))),
}


def element() -> Superelement:
    places = np.array([[0.0, 0, 0], [2, 0, 0]])
    strain = np.hstack([-point_motions(places[1:], places[0]), np.eye(6)])
    stiffness = strain.T @ np.diag([5e9, 3e8, 2e8, 4e7, 6e8, 7e8]) @ strain
    return Superelement("strut", ("a", "b"), places, stiffness, np.eye(12))


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Sound files of every form."""
    top = tmp_path_factory.mktemp("sound")
    (top / "cube.inp").write_text(DECK)
    with gmsh_session():
        solid = gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
        gmsh.model.occ.synchronize()
        for name in SOLIDS:
            gmsh.write(str(top / name))
        for option in ("Min", "Max"):
            gmsh.option.setNumber(f"Mesh.MeshSize{option}", 1)
        gmsh.model.mesh.generate(3)
        gmsh.write(str(top / "cube.stl"))
        gmsh.model.addPhysicalGroup(3, [solid], 1, "block")
        gmsh.model.addPhysicalGroup(2, [5], 2, "base")
        for name in ("cube.unv", "cube.med"):
            gmsh.write(str(top / name))
        for name, version in (("v22", 2.2), ("v41", 4.1), ("binary", 4.1)):
            gmsh.option.setNumber("Mesh.MshFileVersion", version)
            gmsh.option.setNumber("Mesh.Binary", name == "binary")
            gmsh.write(str(top / f"{name}.msh"))
    with gmsh_session():
        occ = gmsh.model.occ
        block = occ.addBox(-200, -150, 0, 400, 300, 300)
        occ.cut([(3, block)], [(3, occ.addCylinder(-300, 0, 150, 600, 0, 0, 80))])
        occ.synchronize()
        gmsh.write(str(top / LOOKED))
    import meshio

    cells = read(str(top / "cube.inp"))
    meshio.write(top / "cube.vtu", meshio.Mesh(cells["points"], [("tetra10", cells["cells"])]))
    _write_matrices(top)
    return top


def _write_matrices(top: Path) -> None:
    one = element()
    for ending, form in (("json",) * 2, ("csv",) * 2, ("bdf", "dmig"), ("op4",) * 2):
        export.write_superelement(top / f"own.{ending}", one, form)
    lines = (top / "own.bdf").read_text().splitlines(keepends=True)
    (top / "other.bdf").write_text("".join(line for line in lines if line[0] != "$"))
    text = (top / "own.op4").read_text()
    (top / "other.op4").write_text(text[: text.index("XYZ") - 32])
    rows = "".join(
        ",".join(map(repr, row[: k + 1])) + ",\n" for k, row in enumerate(one.stiffness.tolist())
    )
    head = "*USER ELEMENT, NODES=2, LINEAR\n** ELEMENT NODES\n** 3, 11\n1,2,3,4,5,6\n"
    (top / "other.mtx").write_text(f"**\n{head}*MATRIX,TYPE=STIFFNESS\n{rows}")
    form = f"{'(12I6)':16}{'(12I6)':16}{'(3E25.16)':20}{'':20}\n"
    text = f"{'title':72}{'K':8}\n{50:14}{2:14}{12:14}{48:14}{0:14}\n"
    text += f"RUA{'':11}{12:14}{12:14}{144:14}{0:14}\n{form}"
    text += _wide([f"{k:6}" for k in range(1, 146, 12)], 12)
    text += _wide([f"{k % 12 + 1:6}" for k in range(144)], 12)
    text += _wide([f"{value:25.16E}" for value in one.stiffness.T.ravel()], 3)
    (top / "other.matrix").write_text(text)


def _wide(cells: list[str], per_line: int) -> str:
    rows = [cells[k : k + per_line] for k in range(0, len(cells), per_line)]
    return "".join("".join(row) + "\n" for row in rows)


def mesh(path: Path) -> dict[str, Any]:
    return {key: np.asarray(value) for key, value in read(str(path)).items()}


def solid(path: Path) -> dict[str, Any]:
    with gmsh_session():
        return opened(str(path))


def looked_at(path: Path) -> dict[str, Any]:
    """As `part` looks: the solids, what may be a seat, and a coarse surface for a picture."""
    request = {"file": str(path), "smallest_detail": 0.0}
    found = _ACTIONS["look"](request)
    survey: dict[str, Any] = json.loads(str(found["survey"]))
    return survey | {"triangles": found["triangles"], "points": found["points"]}


def matrix(path: Path) -> Superelement:
    form, naming = MATRICES[path.name]
    return export.read_superelement(path, form, naming)


def judge_mesh(found: dict[str, Any]) -> None:
    """Elements with positions, and sets of those that there are."""
    points, cells = found["points"], found["cells"]
    assert len(cells) >= 1
    assert 0 <= cells.min() <= cells.max() < len(points)
    assert np.isfinite(points[cells]).all()
    assert np.isfinite(scaled_jacobians(points, cells)).all()
    for key, members in found.items():
        if " " in key and members.size:
            most = len(cells) if key.startswith("solid ") else len(points)
            assert 0 <= members.min() <= members.max() < most


def judge_solid(found: dict[str, Any]) -> None:
    assert found["after"]["solids"] >= 1
    assert 0.0 < found["after"]["volume"] < np.inf


def judge_look(found: dict[str, Any]) -> None:
    """A picture of it, or why there is none."""
    judge_solid(found)
    assert len(found["triangles"]) or found["unmeshed"]
    assert np.isfinite(found["points"]).all()


def judge_matrix(found: Superelement) -> None:
    """Its own checks have passed; it is made again by them."""
    assert np.isfinite(found.stiffness).all()
    assert found.stiffness.shape == (6 * len(found.points),) * 2


KINDS = {
    **dict.fromkeys(MESHES, (mesh, judge_mesh)),
    **dict.fromkeys(SOLIDS, (solid, judge_solid)),
    LOOKED: (looked_at, judge_look),
    **dict.fromkeys(MATRICES, (matrix, judge_matrix)),
}


def one_sentence(text: str, name: str) -> bool:
    return name in text and text.isprintable() and 10 < len(text) < 900


@pytest.mark.parametrize("name", KINDS)
def test_a_mutant_is_read_or_refused_in_one_sentence(
    folder: Path, tmp_path: Path, name: str
) -> None:
    work, judge = KINDS[name]
    sound = (folder / name).read_bytes()
    path = tmp_path / name
    fates: Counter[str] = Counter()
    faults: list[str] = []
    count = COUNT or (2 if name in (*SOLIDS, LOOKED) else 5)
    for number, content in enumerate([sound, *mutants(sound, count, seed=48)]):
        path.write_bytes(content)
        fate, what = outcome(lambda: work(path))
        fates[fate] += 1
        if number == 0:
            assert fate == "read", what
        if fate == "read":
            judge(what)
        elif fate == "failed" or (fate == "refused" and not one_sentence(what, path.name)):
            faults.append(f"mutant {number}: {what}")
    print(f"{name}: {dict(fates)}")
    assert not faults
