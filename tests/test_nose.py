"""A shaft that turns round a standing nose: against two cantilevers, and level by level."""

from typing import Any

import numpy as np
import pytest

from fe_drivetrain.beam.sections import cowper_shear_coefficient
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.coupled.of_scene import scene_body
from fe_drivetrain.export.formats.summary import summary
from fe_drivetrain.fidelity.adviser import Quantity, advise
from fe_drivetrain.fidelity.ladder import LevelModel, shaft_level, statics_level
from fe_drivetrain.fidelity.over_loads import imbalance
from fe_drivetrain.response.model import mesh_scene
from fe_drivetrain.scene.scene import Scene

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


def test_beam_meridian_and_solid_agree_and_stand() -> None:
    scene = scene_of(["rigid", "rigid", "rigid", 0, "rigid", "rigid"], [0, 2e10, 2e10, 0, 0, 0])
    levels = [shaft_level(scene, level) for level in (1, 2, 3)]
    assert all(imbalance(scene, model) < 1e-8 for model in levels)
    # tubes as wide as long: seats are bent out of round, which a beam does not know
    assert hub_compliance(levels[1]) == pytest.approx(hub_compliance(levels[0]), rel=0.2)
    assert hub_compliance(levels[2]) == pytest.approx(hub_compliance(levels[1]), rel=0.02)
    for name in ("upwind", "downwind"):
        weight = sum(levels[1].reaction_matrices[n][2, 8] for n in ("upwind", "downwind"))
        for load, size in ((1, 1.0), (2, 1.0), (4, 1.0), (8, weight)):
            meridian, solid = (m.reaction_matrices[name][:, load] for m in levels[1:])
            np.testing.assert_allclose(solid, meridian, atol=0.01 * size)


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
    scene = scene_of(ALL, None)
    with pytest.raises(InputError, match="has a nose, which the assembly of solids"):
        mesh_scene(scene)
    with pytest.raises(InputError, match="has a nose"):
        scene_body(scene, 1)


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
