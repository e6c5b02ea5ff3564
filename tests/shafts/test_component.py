"""Components as data, their meshes' symmetry, frames in space, and the export of components."""

import re
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from fe_drivetrain import export
from fe_drivetrain.command_line.app import app
from fe_drivetrain.command_line.terminal import MISTAKE
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.spatial import point_motions, wrench_transport
from fe_drivetrain.drivetrain_file.component import Bushings, CarrierComponent, HousingComponent
from fe_drivetrain.drivetrain_file.materials import MATERIALS
from fe_drivetrain.drivetrain_file.reading import (
    change_component,
    is_component,
    library_component,
    library_scene,
    parse_component,
    read_component,
)
from fe_drivetrain.elasticity.mesh import measures
from fe_drivetrain.elasticity.mesh.mesh import boundary
from fe_drivetrain.elasticity.mesh.symmetry import meshed, mirror, repeated, turns
from fe_drivetrain.geometry import BodySizes, GearboxHousing, PlanetCarrier
from fe_drivetrain.shafts.beam.beam import Beam
from fe_drivetrain.shafts.beam.frame import (
    CrossSection,
    Follower,
    Member,
    SpatialFrame,
    annular_sector,
    beam_stiffness,
    on_node,
    rectangle,
    round_section,
    sector_centroid,
)
from fe_drivetrain.shafts.beam.sections import BeamSection
from fe_drivetrain.shafts.beam.shaft import shaft_stiffness
from fe_drivetrain.shafts.fidelity.component_solid import component_mesh

ROOT = Path(__file__).parents[2]
DOC = (ROOT / "docs" / "component.md").read_text(encoding="utf-8")
STEEL = MATERIALS["steel"]
COARSE = {
    "gearbox_housing": {"mesh.size": 0.25, "mesh.edge": 0.12, "mesh.elements_per_turn": 12},
    "planet_carrier": {"mesh.size": 0.4, "mesh.edge": 0.16, "mesh.elements_per_turn": 10},
}
NAMES = tuple(COARSE)


def coarse(name: str, **changes: object):  # type: ignore[no-untyped-def]
    return change_component(library_component(name), COARSE[name] | changes)


# --- data -----------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "model",
    [HousingComponent, CarrierComponent, Bushings, GearboxHousing, PlanetCarrier, BodySizes],
    ids=lambda m: m.__name__,
)
def test_every_key_is_documented(model) -> None:  # type: ignore[no-untyped-def]
    for key in model.model_fields:
        assert re.search(rf"`([a-z_]+\.)?{key}(\.[a-z_]+)?`", DOC), f"{model.__name__}.{key}"


def test_the_examples_of_the_documentation_are_valid() -> None:
    examples = re.findall(r"```yaml\n(.*?)```", DOC, re.DOTALL)
    kinds = [type(parse_component(text)) for text in examples]
    assert kinds == [HousingComponent, CarrierComponent]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("title: a", "must have one of the keys gearbox_housing, planet_carrier, not none"),
        ("title: a\nplanet_carrier: {}\ngearbox_housing: {}", "not gearbox_housing and planet_"),
        ("title: a\nplanet_carrier: {planets: 1}", "planets"),
        ("title: a\nplanet_carrier: {web_angle: 95}", "web_angle is 95 degrees but must be less"),
        ("title: a\nplanet_carrier: {pin_diameter: 0.8}", "pin_circle_diameter plus pin_diameter"),
        ("title: a\nplanet_carrier: {walls: 3}", "walls"),
        ("title: a\nplanet_carrier: {material: wood}", "material 'wood' is unknown"),
        ("title: a\nplanet_carrier: {hub_length: 3000}\nmesh: {size: 100}", "in metres"),
        ("title: a\ngearbox_housing: {}", "bushings is missing"),
        ("title: a\ngearbox_housing: {arm_height: 0.5}\n" + (b := "bushings: {stiffness: "
         "[1, 1, 1, 1, 1, 1]}"), "arm_height is 0.5 m but must be less than eye_diameter"),
        (f"title: a\ngearbox_housing: {{arm_x: 0.2}}\n{b}", "arm_width"),
        (f"title: a\ngearbox_housing: {{}}\n{b}\nwheight: 1", "'wheight' (did you mean 'weight'?)"),
        ("title: a\ngearbox_housing: {}\nbushings: {stiffness: [1, 1]}", "at least 6 values"),
    ],
)  # fmt: skip
def test_a_mistake_gets_one_sentence(text: str, message: str) -> None:
    with pytest.raises(InputError, match=re.escape(message)) as caught:
        parse_component(text)
    assert "\n" not in str(caught.value)


def test_files_tell_what_they_are(tmp_path: Path) -> None:
    path = tmp_path / "mine.yaml"
    path.write_text("title: mine\nplanet_carrier: {planets: 4}\n")
    assert isinstance(read_component(path, {"planet_carrier.walls": 1}), CarrierComponent)
    assert is_component(path.read_text())
    assert not is_component("title: a\nshaft: {}")
    assert not is_component("[1, 2]")
    with pytest.raises(InputError, match="is a component, for it has 'planet_carrier'"):
        library_scene("planet_carrier")
    with pytest.raises(InputError, match="must have one of the keys"):
        library_component("two_bearings")


# --- meshes ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", NAMES)
def test_the_mesh_has_the_body_s_volume_and_closes(name: str) -> None:
    component = coarse(name)
    mesh, sizes = component_mesh(component)
    assert sizes == component.mesh
    volume, centre = component.body.volume_and_centre()
    # faceted arcs of curved elements: coarse ones miss some 1e-4
    assert measures.volume(mesh) == pytest.approx(volume, rel=2e-3)
    assert len(measures.inverted_cells(mesh)) == 0
    # a closed surface has no net area, and copies that did not meet would leave walls inside
    outside = boundary(mesh)
    np.testing.assert_allclose(
        measures.area_vectors(mesh.points, outside).sum(axis=0), 0, atol=1e-9
    )
    edges = np.sort(outside[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()
    assert abs(centre[1]) == 0.0


def test_named_faces_have_the_areas_of_their_cylinders() -> None:
    carrier = coarse("planet_carrier", **{"planet_carrier.planets": 4,
                                          "planet_carrier.web_angle": 30.0})  # fmt: skip
    mesh, _ = component_mesh(carrier)
    body = carrier.planet_carrier
    for name in carrier.loaded:
        area = measures.area(mesh, f"carrier.{name}")
        assert area == pytest.approx(np.pi * body.pin_diameter * body.gap, rel=2e-3)
        place = mesh.points[mesh.face_nodes(f"carrier.{name}")].mean(axis=0)
        point = next(a for a in carrier.attachments if a.name == name)
        assert np.linalg.norm(place - point.position) < 0.03
    flange = np.pi / 4 * (body.hub_diameter**2 - body.hub_bore_diameter**2)
    assert measures.area(mesh, "carrier.hub") == pytest.approx(flange, rel=2e-3)


def test_copies_that_do_not_meet_are_refused() -> None:
    housing = GearboxHousing()
    half, _ = meshed(housing.build_half, BodySizes(size=0.3, edge=0.3, elements_per_turn=10))
    eyes = {"housing.eye": ["housing.left", "housing.right"]}
    with pytest.raises(InputError, match="do not meet"):
        repeated(half, turns(3)[:2], ["housing.cut"], eyes)
    whole = repeated(half, [np.eye(3), mirror(1)], ["housing.cut"], eyes)
    assert measures.volume(whole) == pytest.approx(2 * measures.volume(half), rel=1e-12)


def test_a_mesh_that_folds_is_made_finer() -> None:
    """Six elements round pins that stand on a thin wall fold over, as long as they are so large."""
    carrier = PlanetCarrier(walls=1, cheek_thickness=0.05, pin_diameter=0.5)
    sizes = BodySizes(size=1.0, edge=0.5, elements_per_turn=6)
    mesh, made = meshed(carrier.build_sector, sizes)
    assert made.edge < sizes.edge
    assert len(measures.inverted_cells(mesh)) == 0


@pytest.mark.parametrize("key", ["mesh.size", "mesh.edge"])
def test_a_mesh_too_fine_to_make_is_refused(key: str) -> None:
    with pytest.raises(InputError, match="but must make at most 1e\\+06: choose larger ones"):
        component_mesh(coarse("planet_carrier", **{key: 0.001}))


def test_turns_make_a_group() -> None:
    found = turns(5)
    np.testing.assert_allclose(found[2] @ found[3], np.eye(3), atol=1e-15)


# --- frames in space ------------------------------------------------------------------------------


def test_a_round_beam_is_that_of_the_plane_frame() -> None:
    section = round_section(0.5, STEEL.poisson_ratio, 0.2)
    own = beam_stiffness(section, 1.3, STEEL)
    other = shaft_stiffness(Beam([BeamSection(1.3, 0.5, 0.2)], [], 0.0, STEEL), 0.0, 1.3)
    np.testing.assert_allclose(own, other, rtol=1e-10, atol=1e-10 * np.abs(other).max())


def test_sections_against_published_and_limiting_values() -> None:
    square = rectangle(1.0, 1.0, 0.3)
    assert square.torsion == pytest.approx(0.1406, abs=5e-5)  # Timoshenko and Goodier, art. 109
    assert rectangle(0.1, 1.0, 0.3).torsion == pytest.approx(0.312e-3, rel=2e-3)  # there, b/a = 10
    flat = annular_sector(9.9, 10.1, 0.05, 0.3)
    like = rectangle(0.2, 0.5, 0.3)
    np.testing.assert_allclose(flat.inertias, like.inertias, rtol=2e-3)
    assert sector_centroid(0.0, 3.0, np.pi) == pytest.approx(4 / np.pi)  # half a disc: 4 R / 3 pi
    # four quarters make a ring: second moments about its centre
    quarter, R = annular_sector(1.0, 2.0, np.pi / 2, 0.3), sector_centroid(1.0, 2.0, np.pi / 2)
    total = 4 * (sum(quarter.inertias) + quarter.area * R**2)
    assert total == pytest.approx(np.pi / 2 * (2.0**4 - 1.0**4))


def _bent(turn: np.ndarray, pieces: int = 3) -> SpatialFrame:
    """Two legs at a right angle, in pieces, turned in space."""
    places = [np.array([x, 0.0, 0.0]) for x in np.linspace(0, 1, pieces + 1)]
    places += [np.array([1.0, y, 0.0]) for y in np.linspace(0, 0.7, pieces + 1)[1:]]
    section = rectangle(0.1, 0.2, STEEL.poisson_ratio)
    members = [
        Member((k, k + 1), (turn @ places[k], turn @ places[k + 1]), section, turn @ [0, 0, 1.0])
        for k in range(len(places) - 1)
    ]
    return SpatialFrame(np.array(places) @ turn.T, members, STEEL)


def _ends(frame: SpatialFrame) -> list[Follower]:
    last = len(frame.positions) - 1
    return [on_node("a", 0, frame.positions[0]), on_node("b", last, frame.positions[last])]


def test_a_frame_does_not_depend_on_how_it_lies_or_is_cut() -> None:
    turn = turns(7)[1] @ np.roll(np.eye(3), 1, axis=0)
    straight, turned = _bent(np.eye(3)), _bent(turn, pieces=5)
    first, second = (f.condensed(_ends(f)).stiffness for f in (straight, turned))
    T = np.kron(np.eye(4), turn)
    np.testing.assert_allclose(T.T @ second @ T, first, atol=1e-9 * np.abs(first).max())


def test_a_free_frame_moves_as_a_whole_without_force() -> None:
    body = _bent(np.eye(3)).condensed(_ends(_bent(np.eye(3))))
    forces = np.abs(body.stiffness @ point_motions(body.positions))
    assert forces.max() < 1e-12 * np.abs(body.stiffness).max()
    weight = STEEL.density * 0.02 * 1.7
    assert body.gravity.reshape(2, 6, 3)[:, 2, 2].sum() == pytest.approx(weight)


def test_a_beam_that_ends_off_its_nodes_is_carried_by_statics() -> None:
    """A beam between two rigid bodies: the same as between its own ends, moved there."""
    section = CrossSection(0.01, (0.008, 0.008), 2e-5, (1e-5, 2e-5))
    ends = np.array([0.0, 0.4, 0.1]), np.array([1.0, 0.4, 0.1])
    nodes = np.array([[0.0, 0.0, 0.0], [1.2, 0.1, 0.0]])
    frame = SpatialFrame(nodes, [Member((0, 1), ends, section, np.array([0.0, 1.0, 0.0]))], STEEL)
    bare = beam_stiffness(section, 1.0, STEEL)
    carry = np.zeros((12, 12))
    for k in range(2):
        part = slice(6 * k, 6 * k + 6)
        carry[part, part] = wrench_transport(ends[k] - nodes[k])
    np.testing.assert_allclose(frame.stiffness, carry @ bare @ carry.T, rtol=1e-12, atol=1e-4)


def test_a_follower_of_one_rigid_body_moves_with_it() -> None:
    frame = _bent(np.eye(3))
    last = len(frame.positions) - 1
    rng = np.random.default_rng(0)
    places = rng.uniform(-1, 1, (7, 3))
    spread = Follower("b", frame.positions[last], [last] * 7, places, rng.uniform(1, 2, 7))
    ends = _ends(frame)
    same = frame.condensed([ends[0], spread]).stiffness
    np.testing.assert_allclose(same, frame.condensed(ends).stiffness, rtol=1e-9, atol=1e-2)


# --- export ---------------------------------------------------------------------------------------


def _export(*arguments: str) -> tuple[int, str]:
    outcome = CliRunner().invoke(app, ["export", *arguments])
    return outcome.exit_code, outcome.output


def test_components_are_exported_by_name(tmp_path: Path) -> None:
    out = tmp_path / "ring.json"
    status, said = _export(
        "gearbox_housing", "--format", "json", "--what", "supported", "--level", "1", "--out",
        str(out), "--set", "gearbox_housing.arm_z=0",
    )  # fmt: skip
    assert status == 0, said
    found = export.read_superelement(out, "json")
    assert found.points == ("ring",)
    assert found.supported
    assert found.mass is None
    # arms at the axis, in the ring's middle: no couplings
    off = found.stiffness - np.diag(found.stiffness.diagonal())
    assert np.abs(off).max() < 1e-9 * found.stiffness.diagonal().max()


def test_a_component_s_mesh_is_written(tmp_path: Path) -> None:
    sizes = [f"--set={key}={value}" for key, value in COARSE["planet_carrier"].items()]
    status, said = _export("planet_carrier", "--out", str(tmp_path / "c.msh"), *sizes)
    assert status == 0, said
    assert (tmp_path / "c.msh").stat().st_size > 1e5


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--what", "shaft"], "'shaft' of a component cannot be exported: use body or supported"),
        (["--level", "2"], "level 2 of a component is unknown: use 1 or 3"),
        (["--level", "1", "--at", "rim"], "point 'rim' is unknown: use hub, pin_1"),
        (["--level", "1", "--at", "hub,hub"], "must be one or more, each once"),
        (["--level", "1", "--what", "supported", "--at", "hub"], "'hub' is held rigidly"),
        (["--modes", "3"], "--modes is for the shaft of a scene, not for a component"),
    ],
)
def test_what_cannot_be_exported_is_said(tmp_path: Path, options: list[str], message: str) -> None:
    out = tmp_path / "c.json"
    status, said = _export("planet_carrier", "--format", "json", "--out", str(out), *options)
    assert status == MISTAKE
    assert message in said
    assert not list(tmp_path.iterdir())


def test_a_component_is_no_model_for_calculix(tmp_path: Path) -> None:
    status, said = _export("planet_carrier", "--out", str(tmp_path / "c.inp"))
    assert status == MISTAKE
    assert ".vtu or .msh" in said


def test_advice_is_for_scenes() -> None:
    outcome = CliRunner().invoke(app, ["advise", "planet_carrier", "--quantity", "hub.Fx"])
    assert outcome.exit_code == MISTAKE
    assert "is a component" in outcome.output


def test_a_truth_value_among_stiffnesses_is_refused():
    """It counted as 1 N/m."""
    given = [2e6, 4e7, True, 2e4, 3e5, 3e5]
    with pytest.raises(InputError, match=r"bushings\.stiffness: a truth value has no meaning"):
        change_component(library_component("gearbox_housing"), {"bushings.stiffness": given})
