"""A planet carrier: symmetry, closed forms, the twist of its hub, and equal pins."""

import math

import numpy as np
import pytest
from test_component import coarse

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.scaling import max_difference
from fe_drivetrain.common.spatial import wrench_transport
from fe_drivetrain.drivetrain_file.component import CarrierComponent, material_of
from fe_drivetrain.elasticity.mesh.symmetry import turns
from fe_drivetrain.export.from_component import component_superelement
from fe_drivetrain.shafts.beam.frame import round_section
from fe_drivetrain.shafts.fidelity import component_frames
from fe_drivetrain.shafts.fidelity.component_levels import (
    PinMotions,
    frame_level,
    loads_of,
    pin_motions,
    rigid_level,
    solid_level,
    stiffness_on_supports,
    torque_share,
)
from fe_drivetrain.shafts.fidelity.component_solid import SolidComponent, solid_component
from fe_drivetrain.shafts.fidelity.ladder import LevelModel

pytestmark = pytest.mark.usefixtures("kept_between_runs")


@pytest.fixture(scope="module")
def carrier() -> CarrierComponent:
    found = coarse("planet_carrier")
    assert isinstance(found, CarrierComponent)
    return found


@pytest.fixture(scope="module")
def solid(carrier: CarrierComponent) -> SolidComponent:
    return solid_component(carrier)


@pytest.fixture(scope="module")
def levels(carrier: CarrierComponent, solid: SolidComponent) -> list[LevelModel]:
    return [frame_level(carrier), solid_level(carrier, solid)]


def test_pins_are_alike_to_the_last_digit(
    carrier: CarrierComponent, levels: list[LevelModel]
) -> None:
    """Each in its own frame, the first pin's compliance, and that between neighbours."""
    n = carrier.planet_carrier.planets
    for model in levels:
        C = model.compliance[6:, 6:].reshape(n, 6, n, 6)
        size = np.sqrt(C[0, :, 0].diagonal())
        for k, Q in enumerate(turns(n)):
            T = np.kron(np.eye(2), Q)
            own = T.T @ C[k, :, k] @ T
            assert np.abs((own - C[0, :, 0]) / np.outer(size, size)).max() < 1e-7
            following = turns(n)[(k + 1) % n]
            across = T.T @ C[k, :, (k + 1) % n] @ np.kron(np.eye(2), following)
            first = C[0, :, 1] @ np.kron(np.eye(2), turns(n)[1])
            assert np.abs((across - first) / np.outer(size, size)).max() < 1e-7


def test_torque_on_the_pins_arrives_at_the_hub(
    carrier: CarrierComponent, levels: list[LevelModel]
) -> None:
    places = [a.position for a in carrier.attachments[1:]]
    carry = np.hstack([wrench_transport(p) for p in places])
    share = torque_share(carrier)
    np.testing.assert_allclose(carry @ share, [0, 0, 0, 1, 0, 0], atol=1e-12)
    for model in [rigid_level(carrier), *levels]:
        hub = model.reaction_matrices["hub"]
        assert hub.shape == (6, len(loads_of(carrier)))
        np.testing.assert_allclose(hub[:, : len(share)], carry, atol=1e-7)


def test_the_weight_acts_at_the_centre_of_gravity(
    carrier: CarrierComponent, levels: list[LevelModel]
) -> None:
    volume, (x, _, _) = carrier.planet_carrier.volume_and_centre()
    weight = material_of(carrier).density * volume
    for model in [rigid_level(carrier), *levels]:
        hub = model.reaction_matrices["hub"][:, -1]
        np.testing.assert_allclose(hub[[2, 4]], weight * np.array([1.0, -x]), rtol=2e-3)


def test_pins_on_one_wall_are_cantilevers(monkeypatch: pytest.MonkeyPatch) -> None:
    component = coarse("planet_carrier", **{"planet_carrier.walls": 1})
    body, material = component.planet_carrier, material_of(component)
    E, G, radius = material.youngs_modulus, material.shear_modulus, body.pin_circle_diameter / 2
    pin = round_section(body.pin_diameter, material.poisson_ratio)
    hub = round_section(body.hub_diameter, material.poisson_ratio, body.hub_bore_diameter)
    # mean deflection of a cantilever under an even load, bending and shear
    give = body.gap**3 / (20 * E * pin.inertias[0]) + body.gap / (3 * G * pin.shear_areas[0])
    closed = body.hub_length / (G * hub.torsion) + give / (body.planets * radius**2)
    errors = []
    for pieces in (8, 16):
        monkeypatch.setattr(component_frames, "PIECES", pieces)
        errors.append(abs(pin_motions(component, frame_level(component)).wind_up * closed - 1.0))
    assert errors[0] < 1e-3
    assert errors[1] < errors[0] / 3.5  # second order in the pieces


def test_a_longer_hub_twists_as_theory_says() -> None:
    """With equal ends of the hub, what another 2 m adds is l / GJ, whatever the cheeks do."""
    found = []
    for length in (1.0, 3.0):
        component = coarse("planet_carrier", **{"planet_carrier.hub_length": length})
        found.append(1 / pin_motions(component, solid_level(component)).wind_up)
    material, body = material_of(component), component.planet_carrier
    tube = math.pi / 32 * (body.hub_diameter**4 - body.hub_bore_diameter**4)
    added = 2.0 / (material.shear_modulus * tube)
    # the cheeks' own share, a quarter of that, differs by a per cent or so from mesh to mesh
    assert found[1] - found[0] == pytest.approx(added, rel=1e-2)


def test_the_solid_is_softer_than_rigid_cheeks_and_one_wall_than_two(
    carrier: CarrierComponent, levels: list[LevelModel]
) -> None:
    beams, solid = (pin_motions(carrier, model) for model in levels)
    assert solid.wind_up < beams.wind_up
    assert solid.tilt > beams.tilt
    single = coarse("planet_carrier", **{"planet_carrier.walls": 1})
    for model, two in ((frame_level(single), beams), (solid_level(single), solid)):
        one = pin_motions(single, model)
        assert isinstance(one, PinMotions)
        assert one.wind_up < two.wind_up
        assert one.tilt > 5 * two.tilt


def test_on_a_thick_wall_the_solid_is_the_beams_but_for_the_pins_roots() -> None:
    """The frame takes cheeks for rigid: on a thick one only the foot of a slender pin gives.

    It gives as if the pin were longer by dl: at most that of a rigid disc turned on a half space,
    3 (1 - nu^2) pi a / 16, 0.27 diameters (Johnson 1985, Contact Mechanics, section 5.5). Under an
    even load that adds 5 dl / l to the mean deflection of a cantilever and 4 dl / l to its slope.
    """
    diameter, length = 0.12, 0.8
    changes = {
        "planet_carrier.walls": 1,
        "planet_carrier.cheek_thickness": 1.2,
        "planet_carrier.pin_diameter": diameter,
        "planet_carrier.gap": length,
        "planet_carrier.hub_diameter": 2.2,
    }
    component = coarse("planet_carrier", **changes)
    beams, solid = (
        pin_motions(component, model) for model in (frame_level(component), solid_level(component))
    )
    longer = length / 5 * (beams.wind_up / solid.wind_up - 1.0)
    assert 0 < longer < 0.27 * diameter
    assert solid.tilt / beams.tilt - 1.0 == pytest.approx(4 * longer / length, rel=0.1)


def test_displacements_of_the_solid_are_those_of_its_points(
    carrier: CarrierComponent, solid: SolidComponent, levels: list[LevelModel]
) -> None:
    forces = np.zeros(len(levels[1].compliance))
    forces[6:] = torque_share(carrier)
    motions = levels[1].compliance @ forces
    u = solid.displacements(motions)
    mesh = solid.mesh
    np.testing.assert_allclose(u[mesh.face_nodes("carrier.hub")], 0.0, atol=1e-8 * np.abs(u).max())
    # turned by one pin, the same
    Q = turns(carrier.planet_carrier.planets)[1]
    turned = mesh.points @ Q.T
    from scipy.spatial import cKDTree

    distance, same = cKDTree(mesh.points).query(turned)
    assert distance.max() < 1e-9
    np.testing.assert_allclose(u[same], u @ Q.T, atol=1e-7 * np.abs(u).max())


def test_any_number_of_planets(carrier: CarrierComponent) -> None:
    for planets, angle in ((2, 60.0), (5, 15.0)):
        changes = {"planet_carrier.planets": planets, "planet_carrier.web_angle": angle}
        component = coarse("planet_carrier", **changes)
        if planets == 5:
            assert len(loads_of(component)) == 6 * 5 + 3
        element = component_superelement(component, level=1)
        assert element.points == ("hub", *(f"pin_{k + 1}" for k in range(planets)))
        assert element.rigid_error() < 1e-12
        held = component_superelement(component, "supported", level=1)
        assert np.linalg.eigvalsh(held.stiffness)[0] > 0


def test_a_rigid_carrier_has_no_stiffness(carrier: CarrierComponent) -> None:
    with pytest.raises(InputError, match="has no stiffness at pin_1"):
        rigid_level(carrier).stiffness(["pin_1"])


def test_the_band_is_positive_and_small(carrier: CarrierComponent, solid: SolidComponent) -> None:
    rough = coarse("planet_carrier").model_copy(update={"mesh": carrier.mesh.scaled(1.35)})
    element = component_superelement(carrier, solids=(solid, solid_component(rough)))
    assert element.band is not None
    assert all(0 < half_width < 0.5 for half_width in element.band)


def test_recovered_stresses_cover_what_a_finer_mesh_says(
    carrier: CarrierComponent, solid: SolidComponent
) -> None:
    """Meshes of one size are no series: the band is that of recovered stresses."""
    finer = solid_component(carrier.model_copy(update={"mesh": carrier.mesh.scaled(0.65)}))
    for what, at in (("body", ["hub", "pin_1"]), ("supported", ["pin_1"])):
        element = component_superelement(carrier, what, at, solids=(solid, solid))
        supports = carrier.supports if what == "supported" else {}
        better = stiffness_on_supports(finer.body, supports, at)
        error = max_difference(element.stiffness, better)
        assert element.band is not None
        assert error < element.band.largest < 10 * error
        allowed = element.band.half_widths(element.stiffness)
        assert (np.abs(element.stiffness - better) <= allowed).all()
