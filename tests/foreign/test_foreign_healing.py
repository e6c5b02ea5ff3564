"""STEP files are healed where they need it, as little as will do, and sound ones not at all."""

import re
from importlib.metadata import files

import gmsh
import numpy as np
import pytest

from fe_drivetrain.common.cache import Cache
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.foreign import known_healing, step_heal
from fe_drivetrain.foreign.housing import placed_housing
from fe_drivetrain.foreign.step_solid import opened
from fe_drivetrain.foreign.survey import surveyed
from fe_drivetrain.geometry import Bearing, ForeignHousing, MeshSizes, gmsh_session, write_sample
from fe_drivetrain.geometry.step_files import write_step


def survey_of(path, **how):
    with gmsh_session():
        return opened(str(path), **how)


def test_sewing_loses_a_torus_and_so_it_is_taken_as_it_is(tmp_path):
    path = tmp_path / "torus.step"
    with gmsh_session():
        write_step(path, [gmsh.model.occ.addTorus(0, 0, 0, 1.0, 0.2)])
    with gmsh_session():
        gmsh.model.occ.importShapes(str(path))
        gmsh.model.occ.healShapes()  # all that it does by itself
        gmsh.model.occ.synchronize()
        assert not gmsh.model.getEntities(3)
    found = survey_of(path)
    assert found["healing"].startswith("not healed")
    assert found["after"] == found["before"]
    assert found["after"]["volume"] == pytest.approx(2e9 * np.pi**2 * 0.04, rel=1e-9)
    assert "not healed: its shells are closed" in surveyed(path).text


def test_a_detail_is_removed_from_a_solid_that_sewing_would_lose(tmp_path):
    path = tmp_path / "torus.step"
    with gmsh_session():
        write_step(path, [gmsh.model.occ.addTorus(0, 0, 0, 1.0, 0.2)])
    found = survey_of(path, smallest_detail=0.1)
    assert found["healing"] == "healed: small edges and faces were repaired"
    assert found["after"]["solids"] == 1


def loose_faces(path, gap=0.0, left_out=0):
    """Six squares of a cube of 1000 mm, each with edges of its own, written as a STEP file."""
    with gmsh_session():
        occ = gmsh.model.occ
        for axis, side in [(a, s) for a in range(3) for s in (0, 1)][left_out:]:
            corners = []
            for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)):
                at = np.insert([float(u), float(v)], axis, side * (1 + gap))
                corners.append(occ.addPoint(*(1000 * at)))
            lines = [occ.addLine(a, b) for a, b in zip(corners, np.roll(corners, -1), strict=True)]
            occ.addPlaneSurface([occ.addCurveLoop(lines)])
        occ.synchronize()
        gmsh.write(str(path))
    return path


def test_loose_faces_that_enclose_a_volume_are_sewn_to_a_solid(tmp_path):
    found = survey_of(loose_faces(tmp_path / "loose.step", gap=1e-7))
    assert found["healing"].startswith("healed: 6 loose faces were sewn to 1 solid")
    assert found["after"]["volume"] == pytest.approx(1e9, rel=1e-6)
    assert len(found["faces"]) == 6
    assert all(face["kind"] == "Plane" for face in found["faces"])


@pytest.mark.parametrize("how", [{"gap": 1e-3}, {"left_out": 1}])
def test_loose_faces_with_a_gap_are_refused_with_the_place_of_an_edge(tmp_path, how):
    with pytest.raises(InputError, match=r"belong to one face alone, the first round \(.*\) mm"):
        survey_of(loose_faces(tmp_path / "open.step", **how))


def test_a_solid_with_a_cavity_has_two_shells_and_keeps_them(tmp_path):
    path = tmp_path / "hollow.step"
    with gmsh_session():
        occ = gmsh.model.occ
        hollow, _ = occ.cut(
            [(3, occ.addBox(0, 0, 0, 1, 1, 1))], [(3, occ.addSphere(0.5, 0.5, 0.5, 0.2))]
        )
        write_step(path, [hollow[0][1]])
    found = survey_of(path)
    assert found["after"]["volume"] == pytest.approx(1e9 * (1 - 4 / 3 * np.pi * 0.008), rel=1e-9)
    assert found["healing"].startswith("not healed")
    [ball] = [face for face in found["faces"] if face["kind"] == "Sphere"]
    assert ball["hole"]


def test_a_fault_is_healed_by_the_least_step_that_mends_it(tmp_path, monkeypatch):
    path = tmp_path / "box.step"
    with gmsh_session():
        write_step(path, [gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)])
    fault, calls = step_heal.fault, []

    def twice():
        calls.append(1)
        return "an edge is odd" if len(calls) <= 2 else fault()

    monkeypatch.setattr(step_heal, "fault", twice)
    words = survey_of(path)["healing"]
    assert words == "healed: an edge is odd; degenerated and small edges were repaired"


def test_repeated_instances_of_an_assembly_are_read_in_time_linear_in_their_faces(
    tmp_path, monkeypatch
):
    """Faces after gluing are compared with a list made once, not integrated again for each."""
    from fe_drivetrain.foreign import step_solids

    path, times = tmp_path / "rows.step", []
    placed = step_solids.placed
    monkeypatch.setattr(step_solids, "placed", lambda tag: times.append(tag) or placed(tag))
    with gmsh_session():
        occ = gmsh.model.occ
        boxes = [occ.addBox(k, 0, 0, 1, 1, 1) for k in range(12)]
        write_step(path, boxes)
    found = survey_of(path)
    assert found["after"]["solids"] == 12
    assert len(times) <= 12 * 6 + found["after"]["faces"]
    assert found["after"]["volume"] == pytest.approx(12e9, rel=1e-12)


def test_the_volume_of_solids_with_splines_counts_common_faces_once(tmp_path):
    """Two halves of a stretched, so spline-described, ball: their common face is inside."""
    path = tmp_path / "halves.step"
    with gmsh_session():
        occ = gmsh.model.occ
        halves = [
            occ.addSphere(0, 0, 0, 1, angle1=a, angle2=b)
            for a, b in ((0, np.pi / 2), (-np.pi / 2, 0))
        ]
        occ.dilate([(3, t) for t in halves], 0, 0, 0, 1.0, 1.0, 0.7)
        write_step(path, halves)
    text = surveyed(path).text
    value, band = re.search(r"edges, ([\d.e+]+) \+- ([\d.e+-]+) dm\^3", text).groups()
    exact = 4 / 3 * np.pi * 0.7 * 1e3
    assert abs(float(value) - exact) < 5e-3 * exact
    assert float(band) < 1e-2 * exact


@pytest.mark.parametrize(
    ("package", "name"),
    [
        pytest.param("netgen-mesher", "frame.step", marks=pytest.mark.needs("netgen")),
        ("gmsh", "step_header_data.stp"),
        ("gmsh", "as1-tu-203.stp"),
    ],
)
def test_public_parts_that_packages_ship_are_read_as_they_are(package, name):
    found = next(f for f in files(package) or [] if f.name == name)
    survey = survey_of(found.locate())
    assert survey["healing"].startswith("not healed")
    assert survey["after"]["volume"] == survey["before"]["volume"] > 0


def test_what_healing_found_is_remembered_and_changes_no_mesh(tmp_path, monkeypatch):
    path, tried = tmp_path / "block.step", []
    write_sample("ribbed_pillow_block", path)
    kept = Cache(tmp_path / "cache")
    monkeypatch.setattr(known_healing, "user_cache", lambda: kept)
    read = known_healing.read_in_process

    def reading(action, file, request, limits):
        tried.append("healed" not in request)
        return read(action, file, request, limits)

    monkeypatch.setattr(known_healing, "read_in_process", reading)
    housing = ForeignHousing(
        step=str(path), seat={"radius": 300}, held=[{"point": [0, 0, -420], "normal": [0, 0, 1]}]
    )
    sizes = MeshSizes(housing=0.2, elements_per_turn=8)
    bearing = Bearing(kind="ring", raceway_diameter=0.6)
    first, again = (placed_housing(housing, bearing, sizes, Cache(None)) for _ in range(2))
    assert tried[0]
    assert not any(tried[1:])
    assert first.facts == again.facts
    # where it moves nodes, gmsh itself differs by some 1e-10 m from one time to the next
    assert np.allclose(first.mesh.points, again.mesh.points, rtol=0, atol=1e-8)
    assert np.array_equal(first.mesh.cells, again.mesh.cells)


@pytest.mark.parametrize("step", [None, 1])
def test_a_known_healing_is_done_again_without_looking_for_faults(tmp_path, monkeypatch, step):
    path, seen = tmp_path / "box.step", []
    with gmsh_session():
        write_step(path, [gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)])
    monkeypatch.setattr(step_heal, "fault", lambda: seen.append(1) or "")
    with gmsh_session():
        found = opened(str(path), known={"words": "as before", "step": step})
    assert found["healing"] == "as before"
    assert found["after"]["volume"] == pytest.approx(1e9)
    assert not seen


def test_loose_faces_that_are_known_are_sewn_without_looking_for_faults(tmp_path, monkeypatch):
    path, seen = loose_faces(tmp_path / "loose.step", gap=1e-7), []
    first = survey_of(path)
    monkeypatch.setattr(step_heal, "fault", lambda: seen.append(1) or "")
    again = survey_of(path, known=first["healed"])
    assert (again["healing"], again["after"]) == (first["healing"], first["after"])
    assert not seen


def test_faces_whose_chords_cross_get_smaller_elements_there_alone(tmp_path, monkeypatch):
    path, radius, inner = tmp_path / "tube.step", 1.0, 0.9982  # a wall of one chord's height
    with gmsh_session():
        occ = gmsh.model.occ
        bore = occ.addCylinder(0, 0, -1, 0, 0, 3, inner)
        occ.rotate([(3, bore)], 0, 0, 0, 0, 0, 1, 0.2)
        ((_, tube),), _ = occ.cut([(3, occ.addCylinder(0, 0, 0, 0, 0, 1, radius))], [(3, bore)])
        write_step(path, [tube])
    factors = []
    meshed = step_heal.surface_mesh
    monkeypatch.setattr(step_heal, "surface_mesh", lambda *f: factors.append(f) or meshed(*f))
    found = survey_of(path, smallest_detail=0.0)
    assert found["healing"].startswith("not healed")
    assert found["after"]["volume"] == pytest.approx(1e9 * np.pi * (1 - inner**2), rel=1e-9)
    assert len(factors) > 1
    assert set(factors) == {(1.0,)}


def test_a_bore_whose_edges_lie_elsewhere_is_refused_with_its_radius(tmp_path):
    path = tmp_path / "bored.step"
    with gmsh_session():
        occ = gmsh.model.occ
        bore = occ.addCylinder(0, 0, -1, 0, 0, 3, 0.1)
        ((_, block),), _ = occ.cut([(3, occ.addBox(-0.5, -0.5, 0, 1, 1, 1))], [(3, bore)])
        write_step(path, [block])
    text = path.read_text()
    (radius,) = re.findall(r"CYLINDRICAL_SURFACE\('',#\d+,([\d.]+)\)", text)
    path.write_text(text.replace(f",{radius})", f",{1.6 * float(radius)})"))
    with pytest.raises(InputError, match=r"cylinder of radius 160 mm .* has edges 60 mm off it"):
        survey_of(path, smallest_detail=0.0)
