"""A gearbox housing on bushings: its levels against closed forms, balances and each other."""

import numpy as np
import pytest
from test_component import coarse

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.spatial import wrench_transport
from fe_drivetrain.drivetrain_file.component import HousingComponent, material_of
from fe_drivetrain.elasticity.solve.condensation import supported
from fe_drivetrain.export.from_component import component_superelement
from fe_drivetrain.shafts.beam.frame import rectangle
from fe_drivetrain.shafts.fidelity import component_frames, component_levels
from fe_drivetrain.shafts.fidelity.component_frames import housing_frame
from fe_drivetrain.shafts.fidelity.component_levels import (
    frame_level,
    frame_levels,
    gearbox_springs,
    loads_of,
    rigid_level,
    solid_level,
    stiffness_on_supports,
)
from fe_drivetrain.shafts.fidelity.component_solid import SolidComponent, solid_component
from fe_drivetrain.shafts.fidelity.ladder import LevelModel

ALONG_AXIS = {"gearbox_housing.arm_z": 0.0, "gearbox_housing.arm_x": 0.0}
NO_TWIST = {"bushings.stiffness": [2e6, 3e7, 4e7, 0.0, 3e5, 3e5]}


@pytest.fixture(scope="module")
def housing() -> HousingComponent:
    found = coarse("gearbox_housing", **{"gearbox_housing.arm_x": 0.05})
    assert isinstance(found, HousingComponent)
    return found


@pytest.fixture(scope="module")
def solid(housing: HousingComponent) -> SolidComponent:
    return solid_component(housing)


@pytest.fixture(scope="module")
def levels(housing: HousingComponent, solid: SolidComponent) -> list[LevelModel]:
    return [*(make() for make in frame_levels(housing)), solid_level(housing, solid)]


def test_every_level_carries_the_whole_load(
    housing: HousingComponent, levels: list[LevelModel]
) -> None:
    places = {a.name: a.position for a in housing.attachments}
    mass = material_of(housing).density * housing.gearbox_housing.volume_and_centre()[0]
    for model in levels:
        total = sum(
            wrench_transport(places[name]) @ R for name, R in model.reaction_matrices.items()
        )
        np.testing.assert_allclose(total[:, :6], np.eye(6), atol=1e-6)
        # a frame misses what is at the roots of its arms, a mesh the roundness of its arcs
        np.testing.assert_allclose(total[:3, 6:], mass * np.eye(3), atol=0.01 * mass)
        reactions = model.reactions(np.eye(len(loads_of(housing)))[3])
        np.testing.assert_allclose(reactions["left"], model.reaction_matrices["left"][:, 3])


def test_rigid_arms_on_springs_that_do_not_twist_are_determinate() -> None:
    """Torque over span, and half the weight each."""
    housing = coarse("gearbox_housing", **ALONG_AXIS, **NO_TWIST)
    model = rigid_level(housing)
    span, s = housing.gearbox_housing.arm_span, housing.gearbox_housing.arm_span / 2
    for name, side in (("left", 1.0), ("right", -1.0)):
        found = model.reaction_matrices[name]
        assert found[2, 3] == pytest.approx(side / span)
        assert found[2, 2] == pytest.approx(0.5)
    _, ky, kz, *_ = housing.bushings.stiffness
    expected = [2 * ky, 2 * kz, 2 * kz * s**2]
    np.testing.assert_allclose(model.stiffness(["ring"]).diagonal()[1:4], expected)


def test_arms_on_a_rigid_ring_are_cantilevers_in_series_with_the_bushings() -> None:
    component = coarse("gearbox_housing", **ALONG_AXIS, **NO_TWIST)
    housing, material = component.gearbox_housing, material_of(component)
    arm = rectangle(housing.arm_width, housing.arm_height, material.poisson_ratio)
    length, s = housing.arm_span / 2 - housing.outer_diameter / 2, housing.arm_span / 2
    give = length**3 / (3 * material.youngs_modulus * arm.inertias[0])
    give += length / (material.shear_modulus * arm.shear_areas[1])
    kz = component.bushings.stiffness[2]
    model = frame_level(component, ring_gives=False)
    assert 1 / model.compliance[3, 3] == pytest.approx(2 * s**2 / (1 / kz + give), rel=1e-9)


def test_a_ring_of_more_beams_is_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    component = coarse("gearbox_housing")
    found = 1 / frame_level(component).compliance[:6, :6].diagonal()
    free = housing_frame(component, ring_gives=True).stiffness.diagonal()
    monkeypatch.setattr(component_frames, "HALF_RING", 96)
    monkeypatch.setattr(component_frames, "PIECES", 16)
    finer = 1 / frame_level(component).compliance[:6, :6].diagonal()
    # chords of a circle are off by (angle)^2 / 24 of 2 degrees, the lumped weight likewise
    np.testing.assert_allclose(found, finer, rtol=1e-3)
    finest = housing_frame(component, ring_gives=True).stiffness.diagonal()
    np.testing.assert_allclose(free, finest, rtol=5e-3)


def test_a_ring_under_two_opposite_forces_is_the_curved_bar_of_theory() -> None:
    """Radial give of a thin ring at the arms: (pi/4 - 2/pi) F R^3 / EI (Timoshenko, Strength of
    Materials II, art. 16), for forces at points, so with arms that are low."""
    changes = {
        "gearbox_housing.inner_diameter": 1.96,
        "gearbox_housing.outer_diameter": 2.0,
        "gearbox_housing.arm_height": 0.01,
        "gearbox_housing.eye_diameter": 0.3,
        "gearbox_housing.eye_bore_diameter": 0.1,
    }
    component = coarse("gearbox_housing", **ALONG_AXIS, **changes)
    housing, material = component.gearbox_housing, material_of(component)
    body = housing_frame(component, ring_gives=True)
    # a pair of forces along y at the eyes, the arms' own stretch taken away
    left, right = (body.rows(name).start + 1 for name in ("left", "right"))
    pair = np.zeros(len(body.stiffness))
    pair[[left, right]] = [1.0, -1.0]
    give = float(pair @ np.linalg.pinv(body.stiffness, rcond=1e-13) @ pair)
    section = rectangle(housing.length, 0.02, material.poisson_ratio)
    length = housing.arm_span / 2 - 1.0
    E = material.youngs_modulus
    give -= 2 * length / (E * housing.arm_width * housing.arm_height)
    R = 0.99
    expected = (np.pi / 4 - 2 / np.pi) * R**3 / (E * section.inertias[0])
    # shear and stretch of the ring, and its wall at the foot of the arms: (t / R)^2 and t / R
    assert give == pytest.approx(expected, rel=0.03)


def test_what_gives_more_is_softer(levels: list[LevelModel]) -> None:
    torsion = [1 / model.compliance[3, 3] for model in levels]
    assert torsion[0] > torsion[1] > torsion[2]
    assert torsion[1] > torsion[3]
    vertical = [1 / model.compliance[2, 2] for model in levels]
    assert vertical[0] > vertical[1] > max(vertical[2:])


def test_left_and_right_are_mirror_images(levels: list[LevelModel]) -> None:
    sign = np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])
    for model in levels:
        left, right = (model.reaction_matrices[name][:, :6] for name in ("left", "right"))
        np.testing.assert_allclose(
            left, np.outer(sign, sign) * right, atol=1e-7 * np.abs(left).max()
        )


def test_only_mirror_symmetric_couplings_are_left(levels: list[LevelModel]) -> None:
    """About the plane y = 0, ux, uz and ry do not couple with uy, rx and rz."""
    for model in levels:
        K = model.stiffness(["ring"])
        size = np.sqrt(K.diagonal())
        across = (K / np.outer(size, size))[np.ix_([0, 2, 4], [1, 3, 5])]
        assert np.abs(across).max() < 1e-7
        # arms below the axis: a motion along y turns the housing about x
        assert "uy-rx" in gearbox_springs(K).left_out


def test_springs_of_a_housing_that_is_symmetric_all_round_leave_nothing_out() -> None:
    model = frame_level(coarse("gearbox_housing", **ALONG_AXIS))
    found = gearbox_springs(model.stiffness(["ring"]))
    assert found.left_out == {}
    np.testing.assert_allclose(found.stiffness, 1 / model.compliance[:6, :6].diagonal(), rtol=1e-6)


def test_stiffness_on_supports_is_the_inverse_of_the_compliance(
    housing: HousingComponent, solid: SolidComponent, levels: list[LevelModel]
) -> None:
    direct = stiffness_on_supports(solid.body, housing.supports, ["ring"])
    size = np.sqrt(direct.diagonal())
    inverse = levels[-1].stiffness(["ring"])
    np.testing.assert_allclose(
        direct / np.outer(size, size), inverse / np.outer(size, size), atol=1e-9
    )


def test_a_hinge_of_two_bushings_is_refused_but_has_a_stiffness(solid: SolidComponent) -> None:
    hinge = coarse("gearbox_housing", **{"bushings.stiffness": [2e6, 4e7, 4e7, 0.0, 0.0, 0.0]})
    for make in (lambda: rigid_level(hinge), lambda: frame_level(hinge)):
        with pytest.raises(InputError, match="hinge"):
            make()
    body = housing_frame(hinge, ring_gives=True)
    K = stiffness_on_supports(body, hinge.supports, ["ring"])
    # along y it turns freely about the eyes' line
    turn = np.zeros(6)
    _, _, z = hinge.gearbox_housing.eye
    turn[4], turn[0] = 1.0, -z
    size = np.sqrt(np.abs(K.diagonal()))
    assert np.abs((K / np.outer(size, size)) @ (size * turn)).max() < 1e-7 * size[4]


@pytest.mark.parametrize(
    ("springs", "says"),
    [
        ([2e6, 4e7, 4e7, 0.0, 0.0, 0.0], r"housing can turn freely about y through \(0, 0, -0.1\)"),
        ([0.0, 4e7, 4e7, 2e4, 3e5, 3e5], "housing can move freely along x"),
        ([2e6, 4e7, 0.0, 0.0, 3e5, 3e5], "move freely along z"),
        ([2e6, 4e7, 4e7, 2e4, 1e-5, 3e5], "within round-off: housing can nearly turn about y"),
    ],
)
def test_every_level_refuses_a_mechanism_before_it_is_meshed(
    springs: list[float], says: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    component = coarse(
        "gearbox_housing", **{"bushings.stiffness": springs, "gearbox_housing.arm_z": -0.1}
    )
    monkeypatch.setattr(component_levels, "solid_component", None)
    for level in (rigid_level, frame_level, solid_level):
        with pytest.raises(InputError, match=says):
            level(component)


def test_a_spring_of_nothing_is_refused_as_it_is_read() -> None:
    with pytest.raises(InputError, match=r"1e-300 must be 0, a number from 1e-06"):
        coarse("gearbox_housing", **{"bushings.stiffness": [2e6, 4e7, 4e7, 2e4, 1e-300, 3e5]})


def test_stiff_bushings_show_the_housing_alone(
    housing: HousingComponent, solid: SolidComponent
) -> None:
    """1/K of bushings and housing add up, in torsion, whatever the bushings."""
    flexible = []
    for factor in (0.1, 1.0, 10.0):
        springs = {name: factor * k for name, k in housing.supports.items()}
        whole = supported(solid.body, springs).motions[3, 3]
        stiffness = (factor * np.array(housing.bushings.stiffness)).tolist()
        rigid = rigid_level(coarse("gearbox_housing", **{
            "gearbox_housing.arm_x": 0.05, "bushings.stiffness": stiffness}))  # fmt: skip
        flexible.append(whole - rigid.compliance[3, 3])
    # not quite the same: the bushings' share of the load changes a little
    np.testing.assert_allclose(flexible, flexible[1], rtol=0.05)


def test_the_free_solid_is_a_superelement_with_its_mass(
    housing: HousingComponent, solid: SolidComponent
) -> None:
    element = component_superelement(housing, solids=(solid, solid))
    assert element.rigid_error() < 1e-12
    # there is no coarser mesh, and recovered stresses give the band
    assert element.band is not None
    assert all(1e-3 < half_width < 0.5 for half_width in element.band)
    inertia = element.inertia()
    assert inertia is not None
    volume, centre = housing.gearbox_housing.volume_and_centre()
    mass = material_of(housing).density * volume
    assert inertia[0, 0] == pytest.approx(mass, rel=2e-3)
    # moment of the weight about the ring's middle: m z, m x
    assert inertia[0, 4] == pytest.approx(mass * centre[2], rel=2e-2)
    assert inertia[2, 4] == pytest.approx(-mass * centre[0], rel=2e-2)
