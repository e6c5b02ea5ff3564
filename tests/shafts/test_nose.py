"""A shaft that turns round a standing nose: against two cantilevers, and level by level."""

from typing import Any

import numpy as np
import pytest

from fe_drivetrain.bearing_life.coupled.of_scene import scene_body
from fe_drivetrain.cases.fidelity.energy_sensitivities import energy_slopes, total
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.nose import Nose
from fe_drivetrain.drivetrain_file.scene import Scene, coarser_scene
from fe_drivetrain.export.calculix_plan import plan_deck
from fe_drivetrain.export.formats.summary import summary
from fe_drivetrain.shafts.beam.sections import cowper_shear_coefficient
from fe_drivetrain.shafts.fidelity.adviser import advise
from fe_drivetrain.shafts.fidelity.ladder import (
    LevelModel,
    shaft_level,
    solved_assembly,
    statics_level,
)
from fe_drivetrain.shafts.fidelity.level_costs import forecast
from fe_drivetrain.shafts.fidelity.over_loads import imbalance
from fe_drivetrain.shafts.fidelity.quantity import Quantity
from fe_drivetrain.shafts.response.influence_fields import (
    influences_of_all_reactions,
    reaction_influences,
)
from fe_drivetrain.shafts.response.model import Model, mesh_scene
from fe_drivetrain.shafts.response.unit_loads import Response, unit_load_response

pytestmark = pytest.mark.usefixtures("kept_between_runs")

FRONT, SPAN, ROOT = 1.0, 1.2, 3.0
SHAFT, NOSE = (3.0, 2.6), (2.2, 1.8)
ALL = ["rigid"] * 6
RADIAL = [0, "rigid", "rigid", 0, 0, 0]


def scene_of(upwind: list[Any], downwind: list[Any] | None, **changes: Any) -> Scene:
    """Tubes of one diameter: hub at -1 m, bearings at 0 and 1.2 m, the nose's end at 3 m."""
    bearings = [{"name": "upwind", "x": 0.0, "width": 0.3, "stiffness": upwind}]
    if downwind is not None:
        bearings.append({"name": "downwind", "x": SPAN, "width": 0.3, "stiffness": downwind})
    tubes = [
        {"outer_diameter": outer, "inner_diameter": inner, "length": length}
        for (outer, inner), length in ((SHAFT, 2.6), (NOSE, 0.3 + ROOT))
    ]
    data: dict[str, Any] = {
        "title": "nose",
        "shaft": {"front": -FRONT, "sections": [tubes[0]]},
        "nose": {"body": {"front": -0.3, "sections": [tubes[1]]}, "bearings": bearings},
        "gearbox": {"stiffness": [0, 0, 0, 0 if upwind[3] else "rigid", 0, 0]},
        "mesh": {"shaft": 0.5, "elements_per_turn": 16},
    }
    return Scene.model_validate(data | changes)


def rigidities(scene: Scene, tube: tuple[float, float]) -> tuple[float, float]:
    """Bending and shear rigidity of a tube."""
    steel = scene.material_of("shaft")
    outer, inner = tube
    shear = steel.youngs_modulus / (2 * (1 + steel.poisson_ratio))
    shear *= float(cowper_shear_coefficient(steel.poisson_ratio, inner / outer))
    area = np.pi / 4 * (outer**2 - inner**2)
    return steel.youngs_modulus * np.pi / 64 * (outer**4 - inner**4), shear * area


#: Bearings that hold a shaft without a gearbox, one of them by springs.
COUPLED = scene_of(["rigid", "rigid", "rigid", 0, "rigid", "rigid"], [0, 2e10, 2e10, 0, 0, 0])

COARSE = coarser_scene(COUPLED, 1.2, 8)


def hub_compliance(model: LevelModel) -> float:
    row = 6 * model.points.index("hub") + 2
    return float(model.compliance[row, row])


def test_on_one_bearing_shaft_and_nose_are_two_cantilevers_in_series() -> None:
    scene = scene_of(ALL, None)
    EI, GA = rigidities(scene, SHAFT)
    of_shaft = FRONT**3 / (3 * EI) + FRONT / GA
    EI, GA = rigidities(scene, NOSE)
    # a force at the nose's bearing, and its moment about it
    of_nose = ROOT**3 / (3 * EI) + ROOT / GA + FRONT * ROOT**2 / EI + FRONT**2 * ROOT / EI
    np.testing.assert_allclose(
        hub_compliance(shaft_level(scene, 1)), of_shaft + of_nose, rtol=1e-10
    )


def test_on_two_bearings_the_nose_moves_the_span_of_a_simple_beam() -> None:
    scene = scene_of(["rigid", *RADIAL[1:]], RADIAL)
    EI, GA = rigidities(scene, SHAFT)
    lever = FRONT / SPAN
    of_shaft = FRONT**2 * (SPAN + FRONT) / (3 * EI) + (FRONT + lever**2 * SPAN) / GA
    EI, GA = rigidities(scene, NOSE)

    def cantilever(at: float, load: float) -> float:
        short, long = sorted((at, load))
        return short**2 * (3 * long - short) / (6 * EI) + short / GA

    arms = np.array([ROOT, ROOT - SPAN])
    shares = np.array([1 + lever, -lever])
    softness = np.array([[cantilever(a, b) for b in arms] for a in arms])
    expected = of_shaft + shares @ softness @ shares
    np.testing.assert_allclose(hub_compliance(shaft_level(scene, 1)), expected, rtol=1e-10)
    for model in (statics_level(scene), shaft_level(scene, 1), shaft_level(scene, 2)):
        found = [model.reaction_matrices[name][2, 2] for name in ("upwind", "downwind")]
        np.testing.assert_allclose(found, shares, rtol=1e-6)


@pytest.fixture(scope="module")
def levels() -> list[LevelModel]:
    """Beam, meridian and solid of a shaft that nothing but its nose holds."""
    return [shaft_level(COUPLED, level) for level in (1, 2, 3)]


@pytest.fixture(scope="module")
def assembly() -> tuple[LevelModel, Model, Response]:
    return solved_assembly(COARSE)


def test_beam_meridian_and_solid_agree_and_stand(levels: list[LevelModel]) -> None:
    assert all(imbalance(COUPLED, model) < 1e-8 for model in levels)
    # tubes as wide as long: seats are bent out of round, which a beam does not know
    assert hub_compliance(levels[1]) == pytest.approx(hub_compliance(levels[0]), rel=0.2)
    assert hub_compliance(levels[2]) == pytest.approx(hub_compliance(levels[1]), rel=0.02)
    for name in ("upwind", "downwind"):
        weight = sum(levels[1].reaction_matrices[n][2, 8] for n in ("upwind", "downwind"))
        for load, size in ((1, 1.0), (2, 1.0), (4, 1.0), (8, weight)):
            meridian, solid = (m.reaction_matrices[name][:, load] for m in levels[1:])
            np.testing.assert_allclose(solid, meridian, atol=0.01 * size)


def test_the_assembly_is_the_solid_shaft_on_the_solid_nose(
    assembly: tuple[LevelModel, Model, Response],
) -> None:
    """Condensed each and put in series, or assembled in one system: the same model."""
    solid, (top, _, response) = shaft_level(COARSE, 3), assembly
    assert top.neglects == solid.neglects
    assert response.equilibrium_error < 1e-7
    assert response.superposition_error < 1e-7
    first = 6 * solid.points.index("hub")
    condensed = solid.compliance[first : first + 6, first : first + 6]
    size = np.sqrt(condensed.diagonal())
    scale = np.outer(size, size)
    np.testing.assert_allclose(top.compliance / scale, condensed / scale, atol=1e-7)
    assert set(top.reaction_matrices) == set(solid.reaction_matrices)
    size = np.max([np.abs(m).max(axis=0) for m in top.reaction_matrices.values()], axis=0)
    for name, matrix in top.reaction_matrices.items():
        np.testing.assert_allclose(
            matrix / size, solid.reaction_matrices[name] / size, atol=1e-7, err_msg=name
        )


def test_a_motion_between_shaft_and_nose_is_the_influence_of_a_bearings_force(
    assembly: tuple[LevelModel, Model, Response],
) -> None:
    """Mueller-Breslau: it moves each load by as much as that load puts on the bearing."""
    _, model, response = assembly
    for name, component in (("upwind", 4), ("downwind", 2)):
        # an iteration is as good as its tolerance beside the jump, which is far larger
        influence = reaction_influences(model, name, [component], "superlu")
        (moved,) = (model.unit_loads().T @ influence).T
        expected = response.reactions[name][component]
        np.testing.assert_allclose(moved, expected, atol=1e-7 * np.abs(expected).max())


def test_a_nose_stands_still_when_all_that_is_on_it_moves_rigidly(
    assembly: tuple[LevelModel, Model, Response],
) -> None:
    _, model, _ = assembly
    together = influences_of_all_reactions(model, "superlu")
    response = unit_load_response(model, "superlu")
    loads = model.unit_loads()[: model.mesh.points.size]
    for name, found in together.items():
        expected = response.reactions[name][:, 6:9]  # gravity, which acts on nodes alone
        moved = found.T @ loads[:, 6:9]
        np.testing.assert_allclose(moved, expected, atol=1e-9 * model.mass.sum(), err_msg=name)


def test_moduli_and_bearings_are_all_that_gives(
    assembly: tuple[LevelModel, Model, Response],
) -> None:
    slopes = energy_slopes(assembly[1], assembly[2])
    assert {f"nose.bearings.1.stiffness.{c}" for c in (1, 2)} < set(slopes)
    hub = assembly[2].motions["hub"][:, :6]
    error = total(slopes)[:6, :6] + hub
    assert np.abs(error).max() < 1e-6 * np.abs(hub).max()


def test_a_deck_has_the_nose_and_the_springs_of_its_bearings(
    assembly: tuple[LevelModel, Model, Response],
) -> None:
    """Its equations and springs hold what the solution of the assembly does."""
    _, model, response = assembly
    plan = plan_deck(model, ["hub.Fz"])
    (joint,) = (3 * plan.references["downwind.joint"][0],)
    assert dict(plan.springs)[joint + 1] == dict(plan.springs)[joint + 2] == 2e10
    force = 2e10 * response.motions["downwind.joint"][2, 2]
    assert force == pytest.approx(response.reactions["downwind"][2, 2], rel=1e-9)
    root = 3 * plan.references["nose.root"][0]
    assert set(range(root, root + 6)) <= set(plan.held.tolist())


def test_what_a_level_takes_is_known_for_shaft_and_nose(
    assembly: tuple[LevelModel, Model, Response],
) -> None:
    found = forecast(assembly[1])
    assert [level.level for level in found] == [0, 1, 2, 3, 4]
    assert found[-1].unknowns == assembly[2].diagnostics.n_unknowns
    assert all(level.fits and level.seconds > 0 for level in found)


def test_a_heavier_nose_sags_and_shares_the_shaft_otherwise() -> None:
    rigid = ["rigid", "rigid", "rigid", 0, "rigid", "rigid"]
    steel = {"youngs_modulus": 2e11, "poisson_ratio": 0.3}
    found = []
    for density in (0.0, 7850.0):
        scene = scene_of(rigid, RADIAL, materials={"cast": {**steel, "density": density}})
        nose = scene.nose
        assert nose is not None
        body = nose.body.model_copy(update={"material": "cast"})
        scene = scene.model_copy(update={"nose": nose.model_copy(update={"body": body})})
        reactions = shaft_level(scene, 1).reaction_matrices
        found.append([reactions[name][2, 8] for name in ("upwind", "downwind")])
    light, heavy = np.array(found)
    # the nose's own weight goes to its root: the bearings carry the shaft's alone, both times
    np.testing.assert_allclose(light.sum(), heavy.sum(), rtol=1e-10)
    weight = np.pi / 4 * (SHAFT[0] ** 2 - SHAFT[1] ** 2) * 2.6 * 7850.0
    np.testing.assert_allclose(heavy.sum(), weight, rtol=1e-10)
    assert abs(heavy[0] - light[0]) > 1e-3 * weight


def test_the_adviser_knows_its_bearings() -> None:
    scene = scene_of(["rigid", *RADIAL[1:]], RADIAL)
    advice = advise(scene, Quantity("downwind.Fz"), 0.01)
    assert advice.chosen == 0
    deck = summary(scene, 1)
    assert {"upwind", "downwind", "gearbox"} == set(deck.reactions.matrices)


def test_what_has_no_nose_says_so() -> None:
    with pytest.raises(InputError, match="has a nose"):
        scene_body(COUPLED, 1)


def test_a_wall_of_the_nose_bounds_the_mesh_as_that_of_the_shaft_does() -> None:
    thin = [{"outer_diameter": 2.2, "inner_diameter": 2.14, "length": 0.3 + ROOT}]
    nose = COUPLED.model_dump(mode="json")["nose"] | {"body": {"front": -0.3, "sections": thin}}

    scene = COUPLED.model_copy(update={"nose": Nose.model_validate(nose)})
    with pytest.raises(InputError, match=r"nose, .* thinnest wall of 0\.03 m"):
        mesh_scene(scene)
    assert coarser_scene(scene, 1.0, 8).mesh.shaft <= 3 * 0.03 + 1e-9


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"body": {"front": -0.3, "sections": [{"length": 3, "outer_diameter": 2.7}]}}, "thinner"),
        ({"body": {"front": 0.0, "sections": [{"length": 3, "outer_diameter": 2.2}]}}, "its seat"),
        ({"bearings": []}, "bearings"),
    ],
)
def test_a_nose_that_does_not_fit_is_refused(changes: dict[str, Any], message: str) -> None:
    nose = scene_of(ALL, None).model_dump(mode="json")["nose"]
    with pytest.raises((InputError, ValueError), match=message):
        scene_of(ALL, None, nose=nose | changes)


def test_a_bearing_of_a_nose_needs_a_bore_and_a_scene_a_bearing() -> None:
    solid = {"front": -1.0, "sections": [{"length": 2.6, "outer_diameter": 3.0}]}
    with pytest.raises((InputError, ValueError), match="bore the shaft there"):
        scene_of(ALL, None, shaft=solid)
    with pytest.raises((InputError, ValueError), match="there is no bearing"):
        scene_of(ALL, None, nose=None)
    loose = ["rigid", "rigid", "rigid", 0, 0, 0]
    with pytest.raises((InputError, ValueError), match="mechanism"):
        scene_of(loose, None)
