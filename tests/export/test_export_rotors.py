"""Shafts in other programs' hands: ROSS and Exudyn, and what they are given, Craig-Bampton."""

import sys
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from coarse_scenes import coarse_scene
from scipy import linalg
from scipy.optimize import brentq

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError, MissingToolError
from fe_drivetrain.drivetrain_file.reading import library_scene
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.elasticity.solve.condensation import Condensed, on_supports, supported
from fe_drivetrain.export.craig_bampton import _Harmonic, craig_bampton_shaft, free_frequencies
from fe_drivetrain.export.from_scene import shaft_superelement
from fe_drivetrain.export.lumped_shaft import lumped_superelement, rigid_mass
from fe_drivetrain.export.modes import natural_frequencies
from fe_drivetrain.export.programs import exudyn_system, ross_rotor
from fe_drivetrain.report.seal import drivetrain_hash
from fe_drivetrain.shafts.beam.beam import Beam, Support
from fe_drivetrain.shafts.beam.sections import BeamSection, cowper_shear_coefficient
from fe_drivetrain.shafts.beam.shaft import shaft_stiffness, unit_load_response
from fe_drivetrain.shafts.fidelity.bearing_units import scene_supports
from fe_drivetrain.shafts.fidelity.ladder import shaft_level
from fe_drivetrain.shafts.fidelity.shafts import meridian_shaft, reference_points, shaft_meridian

#: Polynomial order of the meridians here: identities hold at any.
ORDER = 3


def bearing_stiffness(scene: Scene, coupled: bool = True) -> dict[str, Floats]:
    """Full matrices of no structure, of a bearing unit's size; three rows where it is a joint."""
    rng = np.random.default_rng(5)
    found = {}
    for unit in scene.bearing_units:
        root = rng.standard_normal((6, 6))
        size = np.sqrt([1e9, 2e9, 3e9, 1e8, 2e8, 3e8])
        k = (root @ root.T / 6 + np.eye(6)) * np.outer(size, size)
        k = k if coupled else np.diag(np.diag(k))
        if unit.interface != "bonded":
            k[3:], k[:, 3:] = 0.0, 0.0
        found[unit.bearing.name] = k
    return found


# --- Craig-Bampton ---


def slender(length: float) -> Scene:
    """A long solid shaft without rings of its own material."""
    return coarse_scene(
        "bonded", **{"shaft.front": 1.2 - length, "shaft.sections.0.length": length}
    )


def test_free_torsion_is_that_of_a_bar() -> None:
    """u_t = r cos(k pi x / L) solves elasticity: f = k / (2 L) sqrt(G / rho), to round-off."""
    scene = coarse_scene("bonded")
    material, length = scene.material_of("shaft"), scene.shaft.length
    found = free_frequencies(scene, 6, order=8)
    first = np.sqrt(material.shear_modulus / material.density) / (2 * length)
    for k in (1, 2):
        assert np.abs(found / (k * first) - 1).min() < 1e-8


def timoshenko_free(scene: Scene, near: float, coefficient: float) -> float:
    """The free bending frequency [Hz] of a uniform Timoshenko beam near one that is given."""
    material, shaft = scene.material_of("shaft"), scene.shaft
    section = BeamSection(shaft.length, shaft.sections[0].outer_diameter)
    d, L = section.outer_diameter, section.length
    A, I = np.pi / 4 * d**2, np.pi / 64 * d**4  # noqa: E741
    E, G, rho = material.youngs_modulus, material.shear_modulus, material.density
    shear = coefficient * G * A

    def end(f: float) -> float:
        """Determinant of moment and force at the far end by deflection and slope at the near."""
        w2 = (2 * np.pi * f) ** 2
        along = np.array(
            [
                [0.0, 1.0, 0.0, 1.0 / shear],
                [0.0, 0.0, 1.0 / (E * I), 0.0],
                [0.0, -rho * I * w2, 0.0, -1.0],
                [-rho * A * w2, 0.0, 0.0, 0.0],
            ]
        )
        carried = linalg.expm(along * L)
        return float(np.linalg.det(carried[2:, :2]))

    return float(brentq(end, 0.97 * near, 1.03 * near, rtol=1e-12))


def test_free_bending_of_a_slender_shaft_is_timoshenkos() -> None:
    """With Hutchinson's coefficient (2001) it is elasticity's to (k r)^4, 1e-6 at 40 diameters."""
    scene = slender(16.0)
    nu = scene.material_of("shaft").poisson_ratio
    hutchinson = 6 * (1 + nu) ** 2 / (7 + 12 * nu + 4 * nu**2)
    found = free_frequencies(scene, 2, order=6)[0]
    assert found == pytest.approx(timoshenko_free(scene, found, hutchinson), rel=5e-6)


@pytest.fixture(scope="module")
def modal_bodies() -> dict[int, np.ndarray]:
    """Free frequencies by number of modes, rigid motions left out."""
    scene = coarse_scene("spherical")
    bodies = {n: craig_bampton_shaft(scene, n, ["hub", "gearbox"], order=ORDER) for n in (0, 6, 24)}
    return {n: natural_frequencies(b.points, b.stiffness, b.mass)[6:] for n, b in bodies.items()}


def test_modes_come_down_to_the_whole_meridians(modal_bodies: dict[int, np.ndarray]) -> None:
    """Ritz: subspaces in each other give frequencies from above, lower with each mode."""
    whole = free_frequencies(coarse_scene("spherical"), 4, order=ORDER)[:6]
    guyan, some, many = (modal_bodies[n][:6] for n in (0, 6, 24))
    assert (many >= whole * (1 - 1e-7)).all()
    assert (some >= many * (1 - 1e-9)).all()
    assert (guyan >= some * (1 - 1e-9)).all()
    # a dozen modes of bending more, up to many times this frequency
    np.testing.assert_allclose(many[:3], whole[:3], rtol=5e-3)
    assert (guyan[:3] > 1.05 * whole[:3]).all()


def test_modes_have_less_than_the_whole_mass_in_motion() -> None:
    """Bessel: modes of unit mass share the momentum of a rigid motion, and none is left over."""
    scene = coarse_scene("bonded")
    body = craig_bampton_shaft(scene, 9, order=ORDER)
    assert len(body.omega) in (9, 10)
    assert (np.diff(body.omega) >= 0).all()
    assert np.linalg.eigvalsh(body.mass).min() > 0
    np.testing.assert_array_equal(body.point_mass, meridian_shaft(scene, order=ORDER).mass)
    assert body.superelement.origin.scene_hash == drivetrain_hash(scene)
    motions = body.condensed.rigid_motions
    momentum = motions.T @ body.coupling
    size = np.sqrt(np.diag(motions.T @ body.point_mass @ motions))
    shares = ((momentum / size[:, None]) ** 2).sum(axis=1)
    assert (shares[:4] > 0.1).all()
    assert (shares < 1.0).all()
    # bending modes are the same along y and along z
    np.testing.assert_allclose(shares[1], shares[2], rtol=1e-9)


def test_fewer_modes_are_the_lowest_of_more() -> None:
    scene = coarse_scene("bonded")
    more = craig_bampton_shaft(scene, 8, order=ORDER)
    fewer = craig_bampton_shaft(scene, 3, order=ORDER)
    cut = more.with_modes(len(fewer.omega))
    np.testing.assert_allclose(cut.omega, fewer.omega, rtol=1e-9)
    np.testing.assert_allclose(
        cut.coupling @ cut.coupling.T,
        fewer.coupling @ fewer.coupling.T,
        atol=1e-6 * np.abs(fewer.coupling).max() ** 2,
    )


def test_condensed_shaft_and_modes_are_of_one_mesh() -> None:
    """Statics of the constrained problem is the meridian shaft's stiffness."""
    scene = coarse_scene("spherical")
    mesh, sides = shaft_meridian(scene, order=ORDER)
    material = scene.material_of("shaft")
    names, positions = reference_points(scene)
    problem = _Harmonic(mesh, material, 1, positions[:, 0], sides)
    K, P = problem.K.toarray(), problem.P
    scale = np.abs(K).max() / np.abs(P).max()
    zero = np.zeros((P.shape[1],) * 2)
    saddle = np.block([[K, scale * P], [scale * P.T, zero]])
    right = np.vstack([np.zeros_like(P), scale * np.eye(P.shape[1])])
    found = -scale * np.linalg.solve(saddle, right)[len(K) :]
    body = meridian_shaft(scene, order=ORDER)
    rows = np.add.outer(6 * np.arange(len(names)), [1, 5]).ravel()
    expected = body.stiffness[np.ix_(rows, rows)]
    size = np.sqrt(np.outer(expected.diagonal(), expected.diagonal()))
    assert np.abs((found - expected) / size).max() < 1e-8


def test_a_negative_number_of_modes_is_refused() -> None:
    with pytest.raises(InputError, match="number of modes is -1"):
        craig_bampton_shaft(coarse_scene("bonded"), -1)


# --- rigid bodies ---


def test_lumped_bodies_have_the_shafts_mass_centre_and_inertia() -> None:
    scene = coarse_scene("bonded")
    element = lumped_superelement(scene)
    shaft, density = scene.shaft, scene.material_of("shaft").density
    d, L = shaft.sections[0].outer_diameter, shaft.length
    mass = density * np.pi / 4 * d**2 * L
    expected = rigid_mass(
        mass,
        np.array([L / 2, 0.0, 0.0]),
        mass * np.diag([d**2 / 8, *[d**2 / 16 + L**2 / 3] * 2]),
    )
    found = element.inertia()
    np.testing.assert_allclose(found, expected, atol=1e-12 * mass)


def test_what_is_no_chain_of_rigid_bodies_is_refused() -> None:
    element = shaft_superelement(library_scene("two_bearings"), 2)
    with pytest.raises(InputError, match="no chain"):
        exudyn_system.chain_of(element)
    with pytest.raises(InputError, match="elastic body"):
        exudyn_system.bodies_of(element)
    with pytest.raises(InputError, match="no mass"):
        exudyn_system.bodies_of(replace(element, mass=None))


@pytest.mark.parametrize(("module", "extra"), [("ross", "ross"), ("exudyn", "exudyn")])
def test_an_absent_program_is_named(
    monkeypatch: pytest.MonkeyPatch, module: str, extra: str
) -> None:
    monkeypatch.setitem(sys.modules, module, None)
    scene = coarse_scene("bonded")
    builders = {
        "ross": lambda: ross_rotor.rotor_of_scene(scene, bearing_stiffness(scene)),
        "exudyn": lambda: exudyn_system.rigid_bodies_system(lumped_superelement(scene), {}),
    }
    with pytest.raises(MissingToolError, match=rf"fe-drivetrain\[{extra}\]"):
        builders[module]()


# --- Exudyn ---

SCENES = {"bonded": coarse_scene, "spherical": coarse_scene, "two_bearings": None}


def scene_named(name: str) -> Scene:
    make = SCENES[name]
    return library_scene(name) if make is None else make(name)


@pytest.mark.needs("exudyn")
@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("kind", ["guyan", "craig_bampton", "floating", "rigid bodies"])
def test_exudyn_has_the_reactions_and_frequencies_of_the_condensed_model(
    name: str, kind: str
) -> None:
    """Reactions to a millionth: loads are applied both ways, so turning counts only cubed."""
    scene = scene_named(name)
    supports = scene_supports(scene, bearing_stiffness(scene))
    if kind == "rigid bodies":
        body = lumped_superelement(scene)
        build = exudyn_system.rigid_bodies_system
        level = shaft_level(scene, 1, bearing_stiffness(scene))
    else:
        floating = kind == "floating"
        build = exudyn_system.floating_system if floating else exudyn_system.flexible_system
        shaft = meridian_shaft(scene, order=ORDER)
        level = shaft_level(scene, 2, bearing_stiffness(scene), shaft)
        modes = craig_bampton_shaft(scene, 6, order=ORDER)
        body = modes if kind == "craig_bampton" else modes.superelement
    system = build(body, supports)
    found = system.reaction_matrix("hub")
    for support in supports:
        expected = level.reaction_matrices[support][:, :6]
        np.testing.assert_allclose(found[support], expected, rtol=0, atol=1e-6)
    np.testing.assert_allclose(
        system.frequencies(),
        natural_frequencies(body.points, body.stiffness, body.mass, supports),
        # Exudyn takes the stiffness of a floating frame by differences, steps of 1e-8 m
        rtol=1e-5 if kind == "floating" else 1e-9,
    )
    # the shaft's own weight
    n = 6 * len(body.points)
    carried = body.mass[:n, :n] @ np.tile(np.eye(6)[:, :3], (len(body.points), 1))
    expected = supported(
        Condensed(body.points, body.positions, body.stiffness[:n, :n], carried), supports
    )
    both = [build(body, supports, gravity=(0, 0, g)).reactions({}) for g in (9.81, -9.81)]
    for support in supports:
        weight = expected.reactions[support][:, -1]
        half = (both[0][support] - both[1][support]) / (2 * 9.81)
        scale = max(np.abs(r[:, -1]).max() for r in expected.reactions.values())
        np.testing.assert_allclose(half, weight, rtol=0, atol=1e-6 * scale)


@pytest.mark.needs("exudyn")
@pytest.mark.parametrize("kind", ["floating", "rigid bodies"])
def test_exudyn_stretches_a_shaft_that_has_turned(kind: str) -> None:
    """Pulled at its hub after a swing of 1.2 rad: longer by F / k, and by nothing else."""
    body = lumped_superelement(coarse_scene("bonded"))
    build = {
        "floating": exudyn_system.floating_system,
        "rigid bodies": exudyn_system.rigid_bodies_system,
    }[kind]
    swing, force, spring = 1.2, 1e5, 1e7
    pivot = np.diag([1e9, 1e9, 1e9, 1e9, 1e9, spring])
    system = build(body, {"gearbox": pivot})
    pull = -force * np.array([np.cos(swing), np.sin(swing), 0.0, 0.0, 0.0, 0.0])
    turn = np.array([0.0, 0.0, 0.0, 0.0, 0.0, spring * swing])
    reaction = system.reactions({"hub": pull, "gearbox": turn})["gearbox"]
    np.testing.assert_allclose(reaction, pull + turn, rtol=0, atol=1e-7 * spring)
    hub, gearbox = system.place("hub"), system.place("gearbox")
    length = body.positions[-1, 0] - body.positions[0, 0]
    # points in a row: their springs' flexibilities add up
    flexibility = sum(1.0 / k[0, 0] for _, _, k in exudyn_system.chain_of(body))
    stretch = float(np.linalg.norm(hub - gearbox)) - length
    assert stretch == pytest.approx(force * flexibility, rel=1e-6)


@pytest.mark.needs("exudyn")
def test_exudyn_refuses_what_is_at_no_point() -> None:
    body = lumped_superelement(coarse_scene("bonded"))
    with pytest.raises(InputError, match="support 'nowhere'"):
        exudyn_system.flexible_system(body, {"nowhere": np.eye(6)})
    system = exudyn_system.flexible_system(body, {"gearbox": 1e6 * np.eye(6)})
    with pytest.raises(InputError, match="load at 'nowhere'"):
        system.reactions({"nowhere": np.ones(6)})
    with pytest.raises(InputError, match="has its supports in it"):
        exudyn_system.flexible_system(replace(body, supported=True), {})


@pytest.mark.needs("exudyn")
def test_exudyn_names_a_body_that_nothing_holds() -> None:
    system = exudyn_system.flexible_system(lumped_superelement(coarse_scene("bonded")), {})
    assert (system.frequencies()[:6] < 1e-2).all()
    with pytest.raises(ArithmeticError, match="no equilibrium"):
        system.reactions({"hub": np.full(6, 1e4)})


# --- ROSS ---


@pytest.fixture(scope="module")
def rotors() -> dict[str, tuple[Beam, ross_rotor.Rotor]]:
    """A scene's beam with full 6x6 supports, and its rotor."""
    found = {}
    for name in ("bonded", "two_bearings"):
        scene = scene_named(name)
        stiffness = bearing_stiffness(scene)
        beam = ross_rotor.beam_of_scene(scene, stiffness)
        found[name] = beam, ross_rotor.rotor_of_scene(scene, stiffness, rings=False)
    return found


@pytest.mark.needs("ross")
@pytest.mark.parametrize("name", ["bonded", "two_bearings"])
def test_ross_has_the_same_shaft_and_supports(rotors, name: str) -> None:  # type: ignore[no-untyped-def]
    """Its stiffness is that of exact elements, put together, and of the springs at their nodes."""
    beam, rotor = rotors[name]
    K = np.zeros((6 * len(rotor.stations),) * 2)
    for k, (low, high) in enumerate(pairwise(rotor.stations.tolist())):
        rows = np.arange(6 * k, 6 * k + 12)
        K[np.ix_(rows, rows)] += shaft_stiffness(beam, low, high)
    for node, k in rotor.supports.values():
        K[6 * node : 6 * node + 6, 6 * node : 6 * node + 6] += k
    size = np.sqrt(np.outer(K.diagonal(), K.diagonal()))
    assert np.abs((rotor.matrix("K") - K) / size).max() < 1e-10
    M = rotor.matrix("M")
    np.testing.assert_allclose(rotor.frequencies(8), natural_frequencies([], K, M)[:8], rtol=1e-8)
    # a shaft has one mass, whichever way it goes
    volume = sum(s.length * np.pi / 4 * (s.outer_diameter**2 - s.inner_diameter**2)
                 for s in beam.sections)  # fmt: skip
    for component in range(3):
        along = np.tile(np.eye(6)[component], len(rotor.stations))
        assert along @ M @ along == pytest.approx(beam.material.density * volume, rel=1e-12)


@pytest.mark.needs("ross")
@pytest.mark.parametrize("name", ["bonded", "two_bearings"])
def test_ross_deflects_and_reacts_as_level_1_does(rotors, name: str) -> None:  # type: ignore[no-untyped-def]
    """To a few times the millionth by which its stiff springs are not rigid."""
    beam, rotor = rotors[name]
    rng = np.random.default_rng(2)
    hub, gear = 1e5 * rng.standard_normal((2, 6))
    ends = beam.ends[[0, -1]]
    gravity = (0.5, 1.0, -9.81)
    found = rotor.deflections({ends[0]: hub, ends[1]: gear}, gravity)
    expected = unit_load_response(beam, ends, rotor.stations).solution([hub, gear], gravity)
    size = np.abs(expected.displacements).max(axis=0)
    assert (np.abs(found - expected.displacements) / size).max() < 5e-6
    reactions = rotor.reactions(found)
    for support in reactions:
        apart = np.abs(reactions[support] - expected.reaction(support)).max()
        assert apart < 5e-6 * np.abs(expected.reactions).max()
    total = sum(r[:3] for r in reactions.values())
    mass = rotor.rotor.m
    np.testing.assert_allclose(
        total, hub[:3] + gear[:3] + mass * np.array(gravity), rtol=1e-6, atol=1e-6 * mass
    )


@pytest.mark.needs("ross")
def test_ross_static_analysis_is_that_of_rigid_bearings() -> None:
    """Its reactions are not zero however stiff a bearing is, and add up to the weight."""
    scene = library_scene("stepped_shaft")
    for factor in (1.0, 1e6):
        stiffness = {n: factor * k for n, k in bearing_stiffness(scene, coupled=False).items()}
        rotor = ross_rotor.rotor_of_scene(scene, stiffness, rings=False)
        beam = ross_rotor.beam_of_scene(scene, stiffness)
        pinned = []
        for support in beam.supports:
            k = np.diag(np.asarray(support.stiffness)).copy()
            k[1:3] = np.inf
            pinned.append(Support(support.name, support.x, k))
        expected = unit_load_response(replace(beam, supports=pinned), beam.start).gravity_reaction
        found = rotor.static_reactions()
        weight = rotor.rotor.m * ross_rotor.STATIC_GRAVITY
        for number, support in enumerate(pinned):
            on_support = -expected[number, 2, 2] * ross_rotor.STATIC_GRAVITY
            # 1e20 N/m among 1e10: six digits are left, at least
            assert found[support.name] == pytest.approx(-on_support, abs=1e-6 * weight)
        assert sum(found.values()) == pytest.approx(weight, rel=1e-6)


@pytest.mark.needs("ross")
def test_ross_modal_analysis_has_these_frequencies(rotors) -> None:  # type: ignore[no-untyped-def]
    _, rotor = rotors["bonded"]
    modal = rotor.rotor.run_modal(speed=0.0, num_modes=12)
    found = rotor.frequencies(6)
    np.testing.assert_allclose(np.sort(modal.wn)[:6] / (2 * np.pi), found, rtol=1e-8)


@pytest.mark.needs("ross")
def test_free_frequencies_of_ross_come_down_to_timoshenkos() -> None:
    """Errors of its elements go with h^2 at least: a fourth at half the length."""
    scene = slender(8.0)
    beam = replace(ross_rotor.beam_of_scene(scene, {"main_bearing": np.zeros(6)}), supports=())
    found = []
    for parts in (8, 16):
        rotor = ross_rotor.ross_rotor(beam, longest=8.0 / parts)
        K, M = rotor.matrix("K"), rotor.matrix("M")
        found.append(natural_frequencies([], K, M)[6])
    cowper = float(cowper_shear_coefficient(scene.material_of("shaft").poisson_ratio))
    exact = timoshenko_free(scene, found[-1], cowper)
    errors = np.array(found) / exact - 1
    assert 0 < errors[1] < 1e-4
    assert errors[1] < errors[0] / 3.5


@pytest.mark.needs("ross")
def test_ross_refuses_what_it_cannot_hold() -> None:
    scene = coarse_scene("bonded")
    beam = ross_rotor.beam_of_scene(scene, bearing_stiffness(scene))
    with pytest.raises(InputError, match="longest element is 0 m"):
        ross_rotor.ross_rotor(beam, longest=0.0)
    with pytest.raises(InputError, match="must be on the beam"):
        ross_rotor.ross_rotor(beam, stations=[99.0])
    rotor = ross_rotor.ross_rotor(beam)
    with pytest.raises(InputError, match="no node at x"):
        rotor.node(0.123)


def test_supports_are_added_where_they_stand() -> None:
    held = np.zeros((6, 6))
    held[0, 0] = np.inf
    K, left = on_supports(("a", "b"), np.eye(13), {"a": held, "b": 2 * np.eye(6)})
    assert left.tolist() == list(range(1, 13))
    assert np.diag(K).tolist() == [1.0] * 5 + [3.0] * 6 + [1.0]
    with pytest.raises(InputError, match="none of the points"):
        on_supports(("a",), np.eye(6), {"b": held})
