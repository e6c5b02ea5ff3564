"""Re-solves, surfaces of units, the adjoint, and the study of a whole scene with its command."""

from pathlib import Path

import numpy as np
import pytest
from answer_rules import broken_rules
from coarse_scenes import coarse_scene
from typer.testing import CliRunner

from fe_drivetrain.cases.fidelity.energy_sensitivities import (
    compliance,
    energy_slopes,
    hub_elasticities,
    moment_elasticities,
    total,
)
from fe_drivetrain.command_line.app import app
from fe_drivetrain.command_line.terminal import FAILED, MISTAKE, PASSED
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.spatial import wrench_transport
from fe_drivetrain.drivetrain_file.reading import change_scene, library_scene
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.export.formats.summary import summary
from fe_drivetrain.pages.uncertainty import bands, inputs
from fe_drivetrain.report.results import read_results
from fe_drivetrain.shafts.fidelity.bearing_units import unit_stiffness
from fe_drivetrain.shafts.fidelity.ladder import shaft_level
from fe_drivetrain.shafts.fidelity.quantities import (
    numbers,
    shaft_numbers,
    stiffness_names,
    unit_numbers,
    without_zeros,
)
from fe_drivetrain.shafts.response.model import LOADS, Model, build_model
from fe_drivetrain.shafts.response.unit_loads import Response, unit_load_response
from fe_drivetrain.shafts.uncertainty import resolver as resolver_module
from fe_drivetrain.shafts.uncertainty.input_study import Study, study
from fe_drivetrain.shafts.uncertainty.numbers import figures
from fe_drivetrain.shafts.uncertainty.resolver import Resolver, shaft_content, unit_content
from fe_drivetrain.shafts.uncertainty.response_surface import touching, unit_surface
from fe_drivetrain.shafts.uncertainty.sampling import check_spreads, nominal_value, with_values
from fe_drivetrain.studies.input_effects import input_effects

BEARING = "main_bearing"
STEEL, IRON = "materials.steel.youngs_modulus", "materials.ductile_iron.youngs_modulus"
DIAMETER = "shaft.sections.0.outer_diameter"
SPRING, FRONT = "gearbox.stiffness.2", "shaft.front"
WALL = f"bearing_units.{BEARING}.housing.wall"
SPREADS = {
    STEEL: {"lognormal": 0.03},
    IRON: {"lognormal": 0.05},
    SPRING: {"uniform": 0.2},
    FRONT: {"uniform": 0.01},
}
COUNT = 200


@pytest.fixture(scope="module")
def scene() -> Scene:
    return coarse_scene("bonded", uncertainty=SPREADS)


@pytest.fixture(scope="module")
def found(scene: Scene) -> Study:
    return study(scene, level=1, count=COUNT)


@pytest.fixture(scope="module")
def resolver(scene: Scene) -> Resolver:
    found = Resolver(1)
    found(scene)
    return found


# what is solved again


def test_a_resolved_scene_is_the_level_itself(scene: Scene, resolver: Resolver) -> None:
    changed = with_values(scene, {STEEL: 190e9, SPRING: 5e7})
    springs = {BEARING: unit_stiffness(changed, BEARING, coupling="rigid")}
    direct = shaft_level(changed, 1, springs)
    found = Resolver(1)
    found(scene)
    again = found(changed).model
    np.testing.assert_allclose(
        again.compliance, direct.compliance, atol=1e-10 * np.abs(direct.compliance).max()
    )
    for name, matrix in direct.reaction_matrices.items():
        np.testing.assert_allclose(
            again.reaction_matrices[name], matrix, atol=1e-9 * np.abs(matrix).max()
        )


def test_only_what_a_change_touches_is_solved_again(
    scene: Scene, resolver: Resolver, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Springs, modulus of the shaft and places cost neither a housing nor, at most, a shaft."""

    def refuse(*_: object, **__: object) -> None:
        raise AssertionError("solved again")

    monkeypatch.setattr(resolver_module, "unit_stiffness", refuse)
    resolver(with_values(scene, {SPRING: 5e7}))
    resolver(with_values(scene, {"shaft.front": -1.1}))
    resolver(with_values(scene, {"shaft.sections.0.length": 2.3}))
    with pytest.raises(AssertionError, match="solved again"):
        resolver(with_values(scene, {IRON: 160e9}))
    monkeypatch.setattr(resolver_module, "condensed_shaft", refuse)
    resolver(with_values(scene, {SPRING: 6e7}))
    with pytest.raises(AssertionError, match="solved again"):
        resolver(with_values(scene, {"shaft.sections.0.length": 2.4}))


def test_what_a_unit_and_a_shaft_depend_on(scene: Scene) -> None:
    keys = [STEEL, IRON, SPRING, "shaft.front", DIAMETER, WALL, "shaft.sections.0.length"]
    assert touching(scene, BEARING, keys) == [STEEL, IRON, DIAMETER, WALL]
    moved = with_values(scene, {f"bearing_units.{BEARING}.bearing.x": 0.1})
    assert unit_content(moved, BEARING) == unit_content(scene, BEARING)
    assert shaft_content(moved) != shaft_content(scene)
    assert shaft_content(with_values(scene, {STEEL: 1e11})) == shaft_content(scene)
    assert shaft_content(with_values(scene, {DIAMETER: 0.41})) != shaft_content(scene)


# units as surfaces


def test_a_surface_is_exact_in_the_modulus_of_a_unit_of_one_material() -> None:
    scene = coarse_scene("spherical", uncertainty={IRON: {"normal": 0.05}})
    surface = unit_surface(scene, BEARING, scene.uncertainty, Resolver(1))
    factor = 1.3
    changed = with_values(scene, {IRON: factor * nominal_value(scene, IRON)})
    base = surface(scene)
    np.testing.assert_allclose(surface(changed), factor * base, atol=1e-7 * np.abs(base).max())
    assert surface.error < 1e-7


def test_all_moduli_of_a_unit_together_scale_it(found: Study) -> None:
    """Stiffness is homogeneous of degree one in them: a slope of one, up to the surface's error."""
    for surface in found.surfaces:
        scene = found.scene
        scaled = {key: 1.03 * nominal_value(scene, key) for key in (STEEL, IRON)}
        base = unit_numbers(surface(scene))
        for name, k in unit_numbers(surface(with_values(scene, scaled))).items():
            assert k == pytest.approx(1.03 * base[name], rel=2 * surface.error)
        # no mesh is made again: the error is of the surface alone
        assert surface.error < 1e-3


def test_a_surface_knows_how_far_it_is_off(scene: Scene) -> None:
    changed = change_scene(scene, {"uncertainty": {WALL: {"uniform": 0.2}, IRON: {"normal": 0.1}}})
    surface = unit_surface(changed, BEARING, changed.uncertainty, Resolver(1))
    there = with_values(changed, {WALL: 0.12, IRON: 180e9})
    exact = unit_numbers(unit_stiffness(there, BEARING, coupling="rigid"))
    found = unit_numbers(surface(there))
    # another point than the checks': of the same size of error
    for name, k in exact.items():
        assert found[name] == pytest.approx(k, rel=3 * surface.error)
    assert (np.linalg.eigvalsh(surface(there)) > 0).all()


# the adjoint of the assembly


def test_shares_of_energy_are_the_whole(bonded_model: Model, bonded_response: Response) -> None:
    slopes = energy_slopes(bonded_model, bonded_response)
    given = compliance(bonded_response)
    rows = [*range(6), LOADS.index("gearbox.weight")]
    np.testing.assert_allclose(-total(slopes)[rows], given, atol=1e-7 * np.abs(given).max())
    sums = sum(hub_elasticities(bonded_model, bonded_response).values())
    np.testing.assert_allclose(sums, 1.0, atol=1e-6)


@pytest.mark.parametrize("key", [IRON, SPRING])
def test_the_adjoint_is_the_difference_of_the_assembly(
    bonded_model: Model, bonded_response: Response, key: str
) -> None:
    step = 1e-3
    ends = []
    for sign in (-1, 1):
        value = nominal_value(bonded_model.scene, key) * (1 + sign * step)
        changed = build_model(with_values(bonded_model.scene, {key: value}), bonded_model.mesh)
        ends.append(unit_load_response(changed))
    hub = [np.log(1 / end.motions["hub"][:, :6].diagonal()) for end in ends]
    # the step leaves 1e-6, the solver 1e-8 over the step
    adjoint = hub_elasticities(bonded_model, bonded_response)[key]
    np.testing.assert_allclose(adjoint, (hub[1] - hub[0]) / (2 * step), atol=1e-4)
    column = LOADS.index("hub.My")
    moments = [end.reactions[BEARING][4, column] for end in ends]
    slope = (moments[1] - moments[0]) / (2 * step) / np.mean(moments)
    found = moment_elasticities(bonded_model, bonded_response, "hub.My")[key]
    assert found == pytest.approx(slope, abs=1e-4)


def test_the_adjoint_of_a_moment_says_where_it_does_not_hold(
    bonded_model: Model, bonded_response: Response
) -> None:
    scene = change_scene(bonded_model.scene, {"gearbox.stiffness": [4e6, 8e7, 0, "rigid", 0, 0]})
    model = build_model(scene, bonded_model.mesh)
    with pytest.raises(InputError, match="a spring along z and free about y"):
        moment_elasticities(model, bonded_response, "hub.My")


# what is reported


def test_numbers_are_those_of_the_summary(scene: Scene) -> None:
    """The stiff bound of each unit, and the shaft's stiffness."""
    content = summary(scene)
    solved = Resolver(2)(scene)
    unit = content.bearing_units[BEARING]
    for name, value in unit_numbers(solved.springs[BEARING]).items():
        assert value == pytest.approx(getattr(unit, name)[1], rel=1e-9)
    for name, value in shaft_numbers(solved.body).items():
        assert value == pytest.approx(getattr(content.shaft, name), rel=1e-9)


def test_numbers_of_a_unit_at_an_offset() -> None:
    """Springs at a point 0.4 m below the bearing: forces there give it a rotation, too."""
    k = np.array([1e10, 2e10, 3e10, 1e7, 1e8, 2e8])
    lever = wrench_transport(np.array([0.0, 0.0, -0.4]))
    found = unit_numbers(lever @ np.diag(k) @ lever.T)
    expected = {
        "axial": 1 / (1 / k[0] + 0.4**2 / k[4]),
        "radial_y": 1 / (1 / k[1] + 0.4**2 / k[3]),
        "radial_z": k[2],
        "tilt": k[4],
        "yaw": k[5],
    }
    assert found == pytest.approx(expected, rel=1e-9)
    # a hinge there: no moment about it, and no force along x that would turn it
    k[4] = 0.0
    found = unit_numbers(lever @ np.diag(k) @ lever.T)
    assert found == pytest.approx(expected | {"axial": 0.0, "tilt": 0.0}, rel=1e-9)


def test_a_reaction_without_a_load_is_one_number_a_hub_load(
    scene: Scene, resolver: Resolver
) -> None:
    found = without_zeros(numbers(scene, ["main_bearing.My"]), resolver(scene))
    # the vertical plane, and what eccentric thrust does
    assert [n.name for n in found] == [f"main_bearing.My of hub.{c}" for c in ("Fx", "Fz", "My")]
    load = np.zeros(10)
    load[4] = 2.0
    (one,) = numbers(scene, ["main_bearing.My"], load)
    assert one.of(resolver(scene)) == pytest.approx(2 * found[-1].of(resolver(scene)))


def test_a_number_that_is_zero_is_refused(scene: Scene, resolver: Resolver) -> None:
    load = np.zeros(10)
    load[1] = 1.0
    with pytest.raises(InputError, match=r"'main_bearing.My' is zero at level 1"):
        without_zeros(numbers(scene, ["main_bearing.My"], load), resolver(scene))


# the whole


def test_a_small_spread_gives_the_band_of_first_order(found: Study) -> None:
    """Sampled deviations against the root of the sum of squares of the sensitivities."""
    sizes = {STEEL: 0.03, IRON: 0.05, SPRING: 0.2 / np.sqrt(3), FRONT: 0.01 / np.sqrt(3)}
    for number in found.numbers:
        samples = found.samples[number.name]
        slopes = found.slopes[number.name]
        expected = np.linalg.norm([slopes[key] * size for key, size in sizes.items()])
        if not samples.varies:
            assert expected < 1e-9
            continue
        # two standard errors of a deviation, and second order
        allowed = 2 / np.sqrt(2 * COUNT) + 0.02
        deviation = samples.values.std(ddof=1) / abs(samples.nominal)
        assert deviation == pytest.approx(expected, rel=allowed), number.name


def test_a_value_moves_a_quantity_by_its_deviation_times_its_slope(found: Study) -> None:
    sizes = {STEEL: 0.03, IRON: 0.05, SPRING: 0.2 / np.sqrt(3), FRONT: 0.01 / np.sqrt(3)}
    effects = input_effects(found)
    assert [one.name for one in effects.quantities] == [number.name for number in found.numbers]
    for one in effects.quantities:
        expected = {key: one.sensitivities[key] * size for key, size in sizes.items()}
        assert one.changes == pytest.approx(expected, rel=2e-3)
        moved = [abs(change) for change in one.changes.values()]
        assert moved == sorted(moved)
        assert one.half == pytest.approx((one.band.high - one.band.low) / 2 / abs(one.nominal))
        if one.scatter is not None:
            assert one.scatter.first_order == pytest.approx(float(np.linalg.norm(moved)))
            assert one.scatter.counts.sum() == effects.samples == COUNT


def test_stiffness_is_homogeneous_in_moduli_and_springs(found: Study) -> None:
    """Elasticities add up to one; the other springs do nothing in the vertical plane."""
    for slopes in (found.slopes, found.soft_slopes):
        uz = slopes["hub.stiffness.uz"]
        assert uz[STEEL] + uz[IRON] + uz[SPRING] == pytest.approx(1.0, abs=1e-3)


def test_the_model_error_of_a_level_without_a_top_is_half_its_bounds(found: Study) -> None:
    tilt = "main_bearing.tilt"
    stiff, soft = found.samples[tilt].nominal, found.soft_samples[tilt].nominal
    assert soft < stiff
    assert found.errors[tilt].share == pytest.approx((stiff - soft) / 2 / stiff)
    assert found.advices == []
    # a uniform shaft: what a beam leaves out of its torsion is the meridian's own error
    assert found.errors["shaft.torsional"].share < 1e-6


def test_the_page_has_every_number(found: Study) -> None:
    effects = input_effects(found)
    sections = {section.title: section for section in (bands(effects), inputs(effects))}
    (table,) = (i for i in sections["Uncertainty of the results"].items if i.kind == "table")
    assert [row[0] for row in table.rows] == stiffness_names(found.scene)
    values, surfaces = (i for i in sections["Uncertain values"].items if i.kind == "table")
    assert [row[1] for row in values.rows] == list(SPREADS)
    assert [row[1] for row in surfaces.rows] == ["rigid", "averaged"]
    numbers = figures(found)["quantities"]
    assert numbers["main_bearing.tilt"]["half_band"] > 0
    tilt = found.samples["main_bearing.tilt"]
    assert figures(found)["samples"] == len(tilt.values) == COUNT
    assert numbers["main_bearing.tilt"]["standard_deviation"] == np.std(tilt.values, ddof=1)


def test_the_library_scene_is_uncertain_and_can_be_solved() -> None:
    scene = library_scene("main_bearing_bonded_uncertain")
    check_spreads(scene)
    assert len(scene.uncertainty) == 10
    # its extremes are scenes
    for key, spread in scene.uncertainty.items():
        far = spread.uniform or 3 * (spread.normal or spread.lognormal or 0)
        for sign in (-1, 1):
            with_values(scene, {key: nominal_value(scene, key) * (1 + sign * far)})


# the command

RUN = ["uncertainty", "SCENE", "--level", "1", "--samples", "40"]


@pytest.fixture(scope="module")
def scene_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """With values that touch no housing, so that it is quick."""
    spreads = {key: SPREADS[key] for key in (SPRING, FRONT)}
    path = tmp_path_factory.mktemp("scene") / "mine.yaml"
    scene = coarse_scene("bonded", uncertainty=spreads)
    path.write_text(scene.model_dump_json(exclude_none=True))
    return path


def _run(scene_file: Path, out: Path, *options: str) -> tuple[int, str, str]:
    arguments = [str(scene_file) if a == "SCENE" else a for a in RUN]
    outcome = CliRunner().invoke(app, [*arguments, *options, "--out", str(out)])
    return outcome.exit_code, outcome.stdout, outcome.stderr


def test_the_command_writes_a_page_and_the_same_again(scene_file: Path, tmp_path: Path) -> None:
    found = []
    for name in ("one", "two"):
        status, said, steps = _run(
            scene_file, tmp_path / name, "--quantity", "main_bearing.My", "--seed", "5", "--sobol"
        )
        assert status == PASSED, steps
        assert "My on the main bearing by " in said
        # the second run takes what the first one kept
        assert ("samples ..." in steps) == (name == "one")
        assert ("samples of Sobol's shares ..." in steps) == (name == "one")
        assert (tmp_path / name / "report.html").exists()
        found.append(read_results(tmp_path / name / "results.json"))
        assert broken_rules(found[-1]) == []
    assert found[0].figures == found[1].figures
    assert found[0].environment.seed == 5
    asked = found[0].figures["quantities"]["main_bearing.My of hub.My"]
    low, high = asked["band"]
    assert low < asked["nominal"] < high
    for share in asked["sobol"].values():
        first, error = share["first"]
        assert -3 * error < first < 1 + 3 * error


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--quantity", "main_bearing.Mq"], "'main_bearing.Mq' is unknown: use one of"),
        (["--level", "3"], "cannot be sampled: use 1 (beam), 2 (meridian) or 4 (assembly"),
        (["--quantity", "main_bearing.My", "--load", "hub.Fy=1"], "is zero at level 1"),
        (["--load", "hub.Fq=1"], "'hub.Fq' is unknown"),
        (["--tolerance", "much"], "must be between 0 and 100 %"),
        (["--set", f"uncertainty.{STEEL}=3"], "uncertainty"),
    ],
)
def test_a_wrong_option_gets_one_sentence_and_no_file(
    scene_file: Path, tmp_path: Path, options: list[str], message: str
) -> None:
    status, _, said = _run(scene_file, tmp_path / "out", *options)
    assert status == MISTAKE
    assert message in said
    assert "Traceback" not in said
    assert list(tmp_path.iterdir()) == []


def test_a_scene_without_spreads_says_what_to_add(tmp_path: Path) -> None:
    outcome = CliRunner().invoke(
        app, ["uncertainty", "main_bearing_bonded", "--out", str(tmp_path / "out")]
    )
    assert outcome.exit_code == MISTAKE
    assert "add some under 'uncertainty'" in outcome.stderr
    assert list(tmp_path.iterdir()) == []


def test_the_adviser_chooses_the_level_and_judges_it(scene_file: Path, tmp_path: Path) -> None:
    """A tolerance that no cheap level meets: the results are there, and the status says so."""
    out = tmp_path / "out"
    arguments = ["uncertainty", str(scene_file), "--tolerance", "0.1%", "--samples", "40"]
    outcome = CliRunner().invoke(app, [*arguments, "--out", str(out)])
    assert outcome.exit_code == FAILED, outcome.stderr
    results = read_results(out / "results.json")
    (verdict,) = results.verdicts
    level = results.figures["level"]
    assert verdict.quantity.startswith(f"hub.stiffness.uz: error of level {level}")
    # the level's distance to the assembly, and the band of that
    number = results.figures["quantities"]["hub.stiffness.uz"]
    assert 0.001 < number["model_error"] < verdict.computed
    assert "level 4" in number["model_error_source"]
