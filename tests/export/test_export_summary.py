"""The summary of a scene, and the published schemas."""

import json
from pathlib import Path

import jsonschema
import numpy as np
import pytest
from coarse_scenes import coarse_scene
from typer.testing import CliRunner

from fe_drivetrain import export
from fe_drivetrain.command_line.app import app
from fe_drivetrain.command_line.terminal import MISTAKE
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.export.craig_bampton import craig_bampton_shaft
from fe_drivetrain.export.formats.craig_bampton_json import (
    CraigBamptonFile,
    read_craig_bampton,
    write_craig_bampton,
)
from fe_drivetrain.export.formats.summary import SummaryFile, read_summary, summary, write_summary
from fe_drivetrain.export.formats.superelement_json import SuperelementFile
from fe_drivetrain.export.from_scene import shaft_superelement, unit_superelement
from fe_drivetrain.shafts.fidelity.ladder import assembly_level
from fe_drivetrain.shafts.response.model import Model

DOCS = Path(__file__).parents[2] / "docs"
SCHEMAS = {
    "superelement": SuperelementFile,
    "summary": SummaryFile,
    "craig_bampton": CraigBamptonFile,
}


@pytest.fixture(scope="module")
def content() -> SummaryFile:
    return summary(coarse_scene("bonded"))


@pytest.mark.parametrize("name", SCHEMAS)
def test_published_schema_is_that_of_the_program(name: str) -> None:
    published = json.loads((DOCS / f"{name}.schema.json").read_text())
    assert published == SCHEMAS[name].model_json_schema(mode="serialization")


def test_files_fulfil_the_published_schemas(tmp_path: Path, content: SummaryFile) -> None:
    write_summary(tmp_path / "summary.json", content)
    export.write_superelement(
        tmp_path / "superelement.json", shaft_superelement(coarse_scene("bonded"), 2), "json"
    )
    write_craig_bampton(
        tmp_path / "craig_bampton.json", craig_bampton_shaft(coarse_scene("bonded"), 3, order=3)
    )
    for name in SCHEMAS:
        schema = json.loads((DOCS / f"{name}.schema.json").read_text())
        content_of_file = json.loads((tmp_path / f"{name}.json").read_text())
        validator = jsonschema.validators.validator_for(schema)(schema)
        assert [error.message for error in validator.iter_errors(content_of_file)] == []


def test_shaft_by_closed_forms(content: SummaryFile) -> None:
    """Slender enough for Timoshenko's beam: 5 diameters, loads spread over the end face."""
    scene = coarse_scene("bonded")
    section, material = scene.shaft.sections[0], scene.material_of("shaft")
    L, d = section.length, section.outer_diameter
    E, G, second = material.youngs_modulus, material.shear_modulus, np.pi / 64 * d**4
    assert content.shaft.axial == pytest.approx(E * np.pi / 4 * d**2 / L, rel=1e-9)
    assert content.shaft.torsional == pytest.approx(2 * G * second / L, rel=1e-9)
    assert content.shaft.bending == pytest.approx(E * second / L, rel=1e-9)
    assert content.shaft.lateral < 3 * E * second / L**3  # shear makes it softer
    assert content.shaft.lateral == pytest.approx(3 * E * second / L**3, rel=0.1)


def test_parts_have_the_mass_of_the_mesh(content: SummaryFile, bonded_model: Model) -> None:
    mesh = bonded_model.mesh
    for part, mass in bonded_model.part_mass.items():
        found = content.parts[part]
        # parabolas round circles: 12 elements a turn
        assert found.mass == pytest.approx(mass.sum(), rel=2e-3)
        centre = mass @ mesh.points / mass.sum()
        np.testing.assert_allclose(found.centre, centre, atol=3e-3)
        arm = mesh.points - centre
        about = np.einsum("n,nij->ij", mass, np.einsum("nk,nk,ij->nij", arm, arm, np.eye(3)))
        about -= np.einsum("n,ni,nj->ij", mass, arm, arm)
        # nodal masses of quadratic elements integrate squares of positions to about a percent
        np.testing.assert_allclose(np.diag(found.inertia), np.diag(about), rtol=0.03)


def test_bounds_of_k_r_and_reactions_are_in_order(content: SummaryFile) -> None:
    unit = content.bearing_units["main_bearing"]
    for pair in (unit.tilt, unit.yaw, unit.radial_y, unit.radial_z, unit.axial):
        assert pair is not None
        assert 0 < pair[0] < pair[1]
    top = assembly_level(coarse_scene("bonded")).reaction_matrices["main_bearing"]
    found = np.array(content.reactions.matrices["main_bearing"])
    assert found.shape == (6, 10)
    assert found[4, 4] == pytest.approx(top[4, 4], rel=0.15)


def test_a_joint_has_no_k_r_and_bounds_of_all_else() -> None:
    """The joint says how the face moves, so that the error of the mesh alone is between them."""
    unit = summary(
        coarse_scene("spherical", **{"bearing_units.main_bearing.interface": "rigid"}), 1
    ).bearing_units["main_bearing"]
    for low, high in (unit.radial_y, unit.radial_z, unit.axial):
        assert 0 < low < high < 1.5 * low


def test_a_sliding_joint_has_no_k_r() -> None:
    unit = summary(coarse_scene("spherical"), 1).bearing_units["main_bearing"]
    assert unit.tilt is None
    assert unit.yaw is None


def test_round_trip_and_malformed_files(tmp_path: Path, content: SummaryFile) -> None:
    path = tmp_path / "summary.json"
    write_summary(path, content)
    assert read_summary(path) == content
    path.write_text(path.read_text()[:500])
    with pytest.raises(InputError, match="is no drivetrain summary"):
        read_summary(path)


def test_the_command_writes_summary_and_seats(tmp_path: Path) -> None:
    sizes = ["mesh.shaft=0.3", "mesh.bearing=0.1", "mesh.housing=0.1", "mesh.bearing_edge=0.1"]
    coarse = [word for size in sizes for word in ("--set", size)]
    command = ["export", "main_bearing_bonded", *coarse, "--format", "json"]
    path = tmp_path / "summary.json"
    done = CliRunner().invoke(app, [*command, "--what", "summary", "--out", str(path)])
    assert done.exit_code == 0, done.output
    assert set(read_summary(path).parts) == {"shaft", "main_bearing", "main_bearing.housing"}
    seats = tmp_path / "seats.json"
    done = CliRunner().invoke(app, [*command, "--what", "seats", "--out", str(seats)])
    assert done.exit_code == 0, done.output
    assert export.read_superelement(seats, "json").points == ("main_bearing",)
    wrong = [*command[:-1], "csv", "--what", "summary", "--out", str(tmp_path / "a.csv")]
    assert CliRunner().invoke(app, wrong).exit_code == MISTAKE


def test_compliance_is_written_where_there_is_one(tmp_path: Path) -> None:
    scene = coarse_scene("bonded")
    for name, has in (("unit", True), ("shaft", False)):
        made = unit_superelement(scene, "main_bearing") if has else shaft_superelement(scene, 1)
        export.write_superelement(tmp_path / name, made, "json")
        compliance = json.loads((tmp_path / name).read_text())["compliance"]
        assert (compliance is not None) == has
        if has:
            np.testing.assert_allclose(made.stiffness @ compliance, np.eye(6), atol=1e-9)


def test_modes_by_the_command_come_back(tmp_path: Path) -> None:
    path = tmp_path / "modes.json"
    command = ["export", "main_bearing_bonded", "--format", "json", "--out", str(path)]
    done = CliRunner().invoke(app, [*command, "--at", "hub,gearbox", "--modes", "4"])
    assert done.exit_code == 0, done.output
    body = read_craig_bampton(path)
    assert body.points == ("hub", "gearbox")
    assert len(body.omega) >= 4
    assert body.mass.shape == (12 + len(body.omega),) * 2
    assert np.linalg.eigvalsh(body.mass)[0] > 0
    content = json.loads(path.read_text())
    content["omega"].append(1.0)
    path.write_text(json.dumps(content))
    with pytest.raises(InputError, match="a column for each of"):
        read_craig_bampton(path)
    other = [*command[:-1], str(tmp_path / "a"), "--what", "drivetrain", "--modes", "4"]
    assert CliRunner().invoke(app, other).exit_code == MISTAKE
