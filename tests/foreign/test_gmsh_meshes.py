"""Meshes in every form that gmsh writes: read as one and the same cube, or refused."""

import subprocess
import sys

import gmsh
import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.elasticity.mesh.measures import mass_moments
from fe_drivetrain.foreign.mesh_file import read
from fe_drivetrain.foreign.reading import read_in_process
from fe_drivetrain.foreign.step_solid import opened
from fe_drivetrain.foreign.survey import surveyed
from fe_drivetrain.geometry import gmsh_session

#: What gmsh is told before it writes: version, binary, all entities, parametric, partitions.
FORMS = {
    "v1.msh": {"Mesh.MshFileVersion": 1},
    "v22.msh": {"Mesh.MshFileVersion": 2.2},
    "v22_binary.msh": {"Mesh.MshFileVersion": 2.2, "Mesh.Binary": 1},
    "v40.msh": {"Mesh.MshFileVersion": 4.0},
    "v41.msh": {"Mesh.MshFileVersion": 4.1},
    "v41_binary.msh": {"Mesh.MshFileVersion": 4.1, "Mesh.Binary": 1},
    "all_22.msh": {"Mesh.MshFileVersion": 2.2, "Mesh.SaveAll": 1},
    "all_41.msh": {"Mesh.MshFileVersion": 4.1, "Mesh.SaveAll": 1},
    "parametric.msh": {"Mesh.MshFileVersion": 4.1, "Mesh.SaveParametric": 1},
    "a.unv": {},
    "a.med": {},
    "a.inp": {},
}
OPTIONS = ("Mesh.MshFileVersion", "Mesh.Binary", "Mesh.SaveAll", "Mesh.SaveParametric")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A cube of 24 tetrahedra, and its second order, in all forms; and its solid."""
    top = tmp_path_factory.mktemp("forms")
    with gmsh_session():
        solid = gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
        gmsh.model.occ.synchronize()
        for ending in ("brep", "igs"):
            gmsh.write(str(top / f"a.{ending}"))
        gmsh.option.setNumber("Mesh.MeshSizeMin", 1)
        gmsh.option.setNumber("Mesh.MeshSizeMax", 1)
        gmsh.model.mesh.generate(3)
        gmsh.write(str(top / "a.stl"))
        gmsh.model.addPhysicalGroup(3, [solid], 1, "block")
        gmsh.model.addPhysicalGroup(2, [5], 2, "base")
        defaults = {option: gmsh.option.getNumber(option) for option in OPTIONS}

        def write(name, **options):
            for option, value in {**defaults, **options}.items():
                gmsh.option.setNumber(option, value)
            gmsh.write(str(top / name))

        for name, options in FORMS.items():
            write(name, **options)
        gmsh.model.mesh.setOrder(2)
        for name in ("second.msh", "second.unv", "second.med", "second.inp"):
            write(name)
        gmsh.model.mesh.setOrder(1)
        gmsh.model.addPhysicalGroup(3, [solid], 7, "also")
        write("twice.msh", **{"Mesh.MshFileVersion": 2.2})
        gmsh.option.setNumber("Mesh.PartitionCreateGhostCells", 1)
        gmsh.model.mesh.partition(3)
        write("parts_22.msh", **{"Mesh.MshFileVersion": 2.2})
        write("parts_41.msh", **{"Mesh.MshFileVersion": 4.1})
    return top


SECOND = ("second.msh", "second.unv", "second.med", "second.inp")
PARTED = ("twice.msh", "parts_22.msh", "parts_41.msh")


@pytest.mark.parametrize("name", [*FORMS, *SECOND, *PARTED])
def test_the_cube_is_the_same_in_every_form(folder, name):
    found = read(str(folder / name))
    points = found["points"]
    assert len(found["cells"]) == 24
    assert bool(found["linear"]) == (name not in SECOND)
    assert float(mass_moments(points, found["cells"])[0]) == pytest.approx(1.0, rel=1e-14)
    if name == "all_22.msh":  # in which gmsh writes no groups
        assert not [key for key in found if " " in key]
        return
    face = found["face 2" if name == "v1.msh" else "face base"]
    sides = points[face[:, 1:]] - points[face[:, :1]]
    assert np.abs(points[face][:, :, 2]).max() == 0.0
    areas = np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1) / 2
    assert areas.sum() == pytest.approx(1.0, rel=1e-14)
    solids = {k: len(v) for k, v in found.items() if k.startswith("solid ")}
    if name in PARTED:
        assert solids == {"solid block": 24, "solid also": 24}
    elif name == "v1.msh":  # which has no names
        assert solids == {"solid 1": 24}
    else:
        assert solids["solid block"] == 24


def test_a_closed_surface_is_filled(folder, tmp_path):
    found = read(str(folder / "a.stl"))
    assert float(mass_moments(found["points"], found["cells"])[0]) == pytest.approx(1.0)
    text = (folder / "a.stl").read_text()
    (tmp_path / "open.stl").write_text(text.replace("facet normal", "facet_normal", 1))
    broken = text[: text.rindex("facet normal", 0, len(text))] + "endsolid\n"
    (tmp_path / "open.stl").write_text(broken)
    with pytest.raises(InputError, match=r"open.stl is a surface of which 3 edges belong to one"):
        read(str(tmp_path / "open.stl"))


@pytest.mark.parametrize("name", ["a.igs", "a.brep"])
def test_solids_of_other_forms_than_step_are_read_in_mm(folder, name):
    with gmsh_session():
        found = opened(str(folder / name))
    assert found["after"]["solids"] == 1
    assert found["after"]["volume"] == pytest.approx(1.0, rel=1e-9)
    assert [face["kind"] for face in found["faces"]] == ["Plane"] * 6


@pytest.mark.parametrize(
    ("name", "kept", "words"),
    [
        ("a.igs", lambda t: t[: len(t) // 2], r"a.igs cannot be read as IGES \(its line \d+ "),
        ("a.igs", lambda t: t.replace("108,-1.,", "108,-1.E99,", 1), "line"),
        ("a.brep", lambda t: t[: len(t) // 2], r"a.brep cannot be read as BREP \(it has "),
        ("a.brep", lambda t: t[40:], r"has no head of CASCADE Topology"),
    ],
)
def test_damaged_solids_are_refused_before_their_reader_hangs(folder, tmp_path, name, kept, words):
    (tmp_path / name).write_text(kept((folder / name).read_text()))
    with gmsh_session(), pytest.raises(InputError, match=words):
        opened(str(tmp_path / name))


def test_a_reader_that_does_not_end_is_ended(folder, tmp_path):
    path = tmp_path / "a.brep"
    text = (folder / "a.brep").read_text()
    path.write_text(text.replace("1e-07 1 1 0", "1e-07 1 x 0", 1))
    with pytest.raises(InputError, match=r"a.brep makes its reader go on without end"):
        read_in_process("look", path, {"smallest_detail": 0.0})


def test_a_survey_names_the_solid_of_another_form(folder):
    assert "a.brep: 1 solid, 6 faces, 12 edges, 1e-06 dm^3" in surveyed(folder / "a.brep").text


@pytest.mark.parametrize("name", ["v22.msh", "v41.msh", "v41_binary.msh", "a.unv", "a.med"])
def test_what_is_cut_off_is_refused(folder, tmp_path, name):
    content = (folder / name).read_bytes()
    path = tmp_path / name
    path.write_bytes(content[: 3 * len(content) // 4])
    with pytest.raises(InputError, match=rf"{name} cannot be read as a mesh \(gmsh: .*\)"):
        read(str(path))


def test_a_label_that_is_not_utf_8_goes_by_its_number(folder, tmp_path):
    content = (folder / "v41.msh").read_bytes()
    (tmp_path / "a.msh").write_bytes(content.replace(b'"block"', b'"Geh\xe4use"'))
    assert len(read(str(tmp_path / "a.msh"))["solid 1"]) == 24


def test_no_command_of_a_script_is_run(folder, tmp_path):
    """gmsh takes a file that is no mesh as a script of its own, and FILE.opt beside any file."""
    script = f'SystemCall "touch {tmp_path / "run"}";\n'
    (tmp_path / "script.msh").write_text(script)
    (tmp_path / "beside.msh").write_bytes((folder / "v41.msh").read_bytes())
    (tmp_path / "beside.msh.opt").write_text(script)
    with pytest.raises(InputError, match=r"script\.msh is no mesh of gmsh: it must begin with"):
        read(str(tmp_path / "script.msh"))
    assert len(read(str(tmp_path / "beside.msh"))["cells"]) == 24
    gmsh_runs = "import gmsh, sys; gmsh.initialize(argv=[]); gmsh.open(sys.argv[1])"
    assert not (tmp_path / "run").exists()
    path = str(tmp_path / "beside.msh")
    subprocess.run([sys.executable, "-c", gmsh_runs, path], capture_output=True, check=False)
    assert (tmp_path / "run").exists()  # else the two files above try nothing
