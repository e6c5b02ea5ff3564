"""Bodies and springs: rigid motion gives nothing, ties are exact, gear rows are those of bodies."""

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.spatial import point_motions, wrench_transport
from fe_drivetrain.drivetrain_file.materials import Material
from fe_drivetrain.drivetrain_file.turning_parts import ShaftData
from fe_drivetrain.dynamics.bodies.bodies import Body, Superelement, assemble, disc
from fe_drivetrain.dynamics.bodies.machine_shafts import Slice, in_series, shaft_slices
from fe_drivetrain.dynamics.bodies.springs import (
    Place,
    Spring,
    bushing,
    directed,
    gear_mesh,
    line_of_action,
)
from fe_drivetrain.dynamics.bodies.system import System, with_stiffness
from fe_drivetrain.gear.working_angles import Mesh
from fe_drivetrain.shafts.beam.frame import (
    Member,
    SpatialFrame,
    beam_stiffness,
    rectangle,
    round_section,
)

STEEL = Material(youngs_modulus=210e9, poisson_ratio=0.3, density=7850.0)
CENTRES = {"one": (0.1, 0.2, -0.3), "two": (0.7, -0.4, 0.5)}
ONE, TWO = (Place(name, at) for name, at in CENTRES.items())
GEAR, PINION = Place("one", (0.0, 0.0, 0.0)), Place("two", (0.02, 0.5, 0.0))
PAIR = Mesh(pressure_angle=np.radians(22), base_helix=np.radians(13), face_width=0.2)


def rigid(centres: dict[str, tuple[float, float, float]]) -> np.ndarray:
    return point_motions(np.array(list(centres.values())))


def two_bodies(springs: list[Spring], **kwargs: object) -> System:
    bodies = [Body(name, at, 2.0, 3.0, 4.0) for name, at in CENTRES.items()]
    return assemble(bodies, springs, **kwargs)  # type: ignore[arg-type]


def all_kinds() -> list[Spring]:
    rng = np.random.default_rng(1)
    A = rng.normal(size=(6, 6))
    section = round_section(0.1, 0.3, 0.02)
    return [
        *bushing("six", ONE, TWO, (1, 2, 3), [1e8, 2e8, 3e8, 1e6, 2e6, 3e6]),
        *bushing("full", ONE, TWO, (0.3, 0, 1), A @ A.T),
        *gear_mesh("external", ONE, TWO, (0.4, 0.1, 0.1), PAIR, 1e9, slices=3),
        *gear_mesh("back", ONE, TWO, (0.4, 0.1, 0.1), PAIR, 1e9, flank=-1),
        *shaft_springs((ONE, TWO), [Slice(0.25, 0.5, section)]),
        directed("line", ONE, TWO, (0, 1, 0), np.array([0.6, 0, 0.8, 0, 0, 0]), 5.0),
    ]


def shaft_springs(places: tuple[Place, Place], slices: list[Slice]) -> list[Spring]:
    """A shaft along x from the origin, at its elastic centre."""
    centre, k = in_series(slices, STEEL)
    return bushing("shaft", *places, (centre, 0, 0), k)


def test_a_common_rigid_motion_stretches_no_spring() -> None:
    system = two_bodies(all_kinds())
    motion = rigid(CENTRES)
    sizes = np.abs(system.rows).max(axis=1, keepdims=True)
    assert np.abs((system.rows / sizes) @ motion).max() < 1e-14
    assert np.array_equal(system.K, system.K.T) or np.allclose(system.K, system.K.T, rtol=1e-14)
    assert np.linalg.matrix_rank(system.rows / sizes) == 6


def test_forces_of_a_spring_on_two_bodies_are_in_balance() -> None:
    for spring in all_kinds():
        moved = [wrench_transport(CENTRES[name]) @ row for name, row in spring.by.items()]
        assert np.abs(moved[0] + moved[1]).max() < 1e-13 * np.abs(moved[0]).max()


def test_a_full_matrix_comes_back_as_springs() -> None:
    A = np.random.default_rng(2).normal(size=(6, 6)) * [1e4, 1e4, 1e4, 1e2, 1e2, 1e2]
    K = A.T @ A
    springs = bushing("bearing", Place("one", (0, 0, 0)), None, (0, 0, 0), K)
    found = assemble([Body("one")], springs).K
    assert np.abs(found - K).max() < 1e-12 * np.abs(K).max()


def test_a_matrix_of_a_spring_must_be_one() -> None:
    skew = np.eye(6)
    skew[0, 1] = 1.0
    with pytest.raises(InputError, match="symmetric"):
        bushing("bearing", ONE, None, (0, 0, 0), skew)
    with pytest.raises(InputError, match="eigenvalue"):
        bushing("bearing", ONE, None, (0, 0, 0), np.ones((6, 6)) + np.diag([-0.5] + [1.0] * 5))
    with pytest.raises(InputError, match="at least 0"):
        bushing("bearing", ONE, None, (0, 0, 0), [-1, 0, 0, 0, 0, 0])


def test_a_shaft_as_springs_is_the_timoshenko_beam() -> None:
    section, length = round_section(0.3, 0.3, 0.1), 0.8
    places = Place("one", (0, 0, 0)), Place("two", (length, 0, 0))
    springs = shaft_springs(places, [Slice(length / 2, length, section)])
    found = assemble([Body("one"), Body("two", (length, 0, 0))], springs).K
    exact = beam_stiffness(section, length, STEEL)
    assert np.abs(found - exact).max() < 1e-12 * np.abs(exact).max()


def test_a_stepped_shaft_as_six_springs_is_its_beams_condensed() -> None:
    sections = [(0.3, round_section(0.4, 0.3)), (0.9, round_section(0.25, 0.3, 0.1))]
    K, begin = np.zeros((18, 18)), 0.0
    slices = []
    for i, (length, section) in enumerate(sections):
        K[6 * i : 6 * i + 12, 6 * i : 6 * i + 12] += beam_stiffness(section, length, STEEL)
        slices.append(Slice(begin + length / 2, length, section))
        begin += length
    ends, inner = np.r_[0:6, 12:18], np.arange(6, 12)
    between = np.linalg.solve(K[np.ix_(inner, inner)], K[np.ix_(inner, ends)])
    exact = K[np.ix_(ends, ends)] - K[np.ix_(ends, inner)] @ between
    places = Place("one", (0, 0, 0)), Place("two", (begin, 0, 0))
    found = assemble([Body("one"), Body("two", (begin, 0, 0))], shaft_springs(places, slices)).K
    assert np.abs(found - exact).max() < 1e-11 * np.abs(exact).max()


def test_a_tapered_shaft_is_cut_into_slices_that_converge() -> None:
    taper = {"length": 1.0, "outer_diameter": 0.4, "outer_diameter_end": 0.2}
    shaft = ShaftData.model_validate({"name": "cone", "length": 1.0, "sections": [taper]})
    centre, k = in_series(shaft_slices(shaft, 0.0, 1.0), shaft.material)
    # G J / L of a cone: the integral of 32 / (pi G d^4) over its length (Timoshenko 1955)
    twist = 32 / np.pi / shaft.material.shear_modulus * (0.2**-3 - 0.4**-3) / (3 * 0.2)
    assert k[3] == pytest.approx(1 / twist, rel=1e-2)
    assert 0.5 < centre < 1.0


def test_external_gears_press_apart_and_turn_by_their_base_radii() -> None:
    point = (0.01, 0.3, 0.0)
    (spring,) = gear_mesh("mesh", GEAR, PINION, point, PAIR, 1.0)
    first, second = spring.by["one"], spring.by["two"]
    cosines = np.cos(PAIR.pressure_angle) * np.cos(PAIR.base_helix)
    assert first[3] == pytest.approx(0.3 * cosines, rel=1e-14)
    assert second[3] == pytest.approx(0.2 * cosines, rel=1e-14)
    # the force on the first gear is minus the row's translation: away from the second, which is +y
    assert first[1] > 0
    assert -first[1] == pytest.approx(second[1], rel=1e-14)
    assert np.linalg.norm(first[:3]) == pytest.approx(1.0, rel=1e-14)


def test_a_right_hand_gear_that_drives_forward_is_pushed_downwind() -> None:
    normal = line_of_action(PAIR, (0, 1, 0))
    # force on the driver is -normal; its tooth turns with x, so it is pushed towards +x
    assert normal[0] == pytest.approx(-np.sin(PAIR.base_helix))
    assert line_of_action(PAIR, (0, 1, 0), -1)[0] == pytest.approx(np.sin(PAIR.base_helix))


def test_gears_that_turn_at_their_ratio_wind_nothing_external_internal_and_helical() -> None:
    planet, ring, sun = Place("p", (0, 0.5, 0)), Place("r", (0, 0, 0)), Place("s", (0, 0, 0))
    ring_mesh = gear_mesh("ring", planet, ring, (0, 0.7, 0), PAIR, 1.0, slices=4)
    sun_mesh = gear_mesh("sun", sun, planet, (0, 0.3, 0), PAIR, 1.0, slices=4)

    def turn(angle: float, y: float = 0.0, about: float = 0.0) -> np.ndarray:
        return np.array([0.0, 0.0, about * y, angle, 0.0, 0.0])

    # the carrier turns by 1: the planet's centre moves along z, the ring stands
    spin = 1 - 0.7 / 0.2  # carrier, and relative to it -r_ring / r_planet
    motions = {"p": turn(spin, 0.5, 1.0), "r": turn(0.0), "s": turn(1 + 0.7 / 0.3)}
    wound = [sum(h @ motions[b] for b, h in s.by.items()) for s in ring_mesh + sun_mesh]
    assert np.abs(wound).max() < 1e-14


def test_slices_give_a_mesh_its_stiffness_against_tilt() -> None:
    for n in (1, 2, 5, 40):
        springs = gear_mesh("mesh", GEAR, PINION, (0, 0.3, 0), Mesh(0.3, 0.0, 0.2), 6.0, slices=n)
        K = sum(s.stiffness * np.outer(s.by["one"], s.by["one"]) for s in springs)
        tilt = K[4, 4] / np.cos(0.3) ** 2
        assert tilt == pytest.approx(6.0 * 0.2**2 * (1 - 1 / n**2) / 12, abs=1e-15)


def test_a_tied_body_is_a_part_of_its_host() -> None:
    bodies = [
        Body("host", (0, 0, 0), 5.0, 1.0, 2.0),
        Body("part", (0.3, 0.4, 0), 2.0, 0.1, 0.2, tied_to="host", free=frozenset({"rx"})),
    ]
    system = assemble(bodies, [])
    assert system.names == (*(f"host {m}" for m in ("ux", "uy", "uz", "rx", "ry", "rz")), "part rx")
    M = system.mass
    assert M[3, 3] == pytest.approx(1.0 + 2.0 * 0.4**2)  # a point, free to spin
    assert M[5, 5] == pytest.approx(2.0 + 0.2 + 2.0 * (0.3**2 + 0.4**2))
    assert system.gravity(np.array([0, 0, -9.81]))[2] == pytest.approx(-7.0 * 9.81)


def test_a_superelement_joins_bodies_and_held_degrees_are_gone() -> None:
    section = round_section(0.2, 0.3)
    beam = beam_stiffness(section, 1.0, STEEL)
    bodies = [Body("wall", free=frozenset()), Body("tip", (1, 0, 0), 1.0, 1.0, 1.0)]
    system = assemble(bodies, [], [Superelement("beam", ("wall", "tip"), beam)])
    assert system.rows.shape == (0, 6)
    load = system.load_on("tip", np.array([0, 1000.0, 0, 0, 0, 0]))
    EI, GA = 210e9 * section.inertias[0], STEEL.shear_modulus * section.shear_areas[0]
    assert np.linalg.solve(system.K, load)[1] == pytest.approx(1000 / (3 * EI) + 1000 / GA)


def test_gyroscopic_terms_do_no_work_and_those_of_a_frame_are_a_change_of_coordinates() -> None:
    bodies = [Body("one", (0, 0, 0), 2.0, *disc(2.0, 0.5, 0.1), speed=3.0)]
    springs = bushing("bearing", Place("one", (0, 0, 0)), None, (0, 0, 0), [1, 9, 9, 0, 4, 4])
    speed = 0.7

    def frequencies(frame: float) -> np.ndarray:
        system = assemble(bodies, springs, frame_speed=frame)
        assert np.array_equal(system.gyroscopic, -system.gyroscopic.T)
        n = len(system.names)
        A = np.block(
            [
                [np.zeros((n, n)), np.eye(n)],
                [
                    -np.linalg.solve(system.mass, system.K - speed**2 * system.centripetal),
                    -np.linalg.solve(system.mass, speed * system.gyroscopic),
                ],
            ]
        )
        return np.sort(np.linalg.eigvals(A).imag)

    at_rest, turning = frequencies(0.0), frequencies(1.0)
    # a circular whirl at w is seen at w - speed or w + speed: in the frame that turns
    whirls = at_rest[at_rest > 1.5]  # without the axial mode and free turning
    seen = turning[(turning > 0.0) & (np.abs(turning - np.sqrt(0.5)) > 1e-9)]
    for w in whirls:
        assert min(np.abs(seen - (w - speed)).min(), np.abs(seen - (w + speed)).min()) < 1e-7


def test_names_are_checked() -> None:
    with pytest.raises(InputError, match="twice"):
        assemble([Body("a"), Body("a")], [])
    with pytest.raises(InputError, match="before it"):
        assemble([Body("a", tied_to="b"), Body("b")], [])
    with pytest.raises(InputError, match="no body"):
        assemble([Body("a")], [directed("s", ONE, None, (0, 0, 0), np.eye(6)[0], 1.0)])
    with pytest.raises(InputError, match="at least 0"):
        assemble([Body("a", mass=-1.0)], [])
    system = two_bodies(all_kinds())
    with pytest.raises(InputError, match="no degree"):
        system.place("three ux")
    with pytest.raises(InputError, match="no spring"):
        with_stiffness(system, {"nothing": 1.0})
    assert with_stiffness(system, {"line": 7.0}).stiffness[system.spring("line")] == 7.0


def test_a_tied_body_has_its_mass_where_it_is() -> None:
    """Felt at its host, which holds it by a rigid arm in space."""
    host = Body("host", (0.3, -0.1, 0.2), 2.0, 3.0, 4.0)
    tied = Body("tied", (1.4, 0.6, -0.5), 5.0, 0.7, 0.9, free=frozenset(), tied_to="host")
    system = assemble([host, tied], [])
    T = wrench_transport(np.subtract(tied.position, host.position))
    expected = np.diag([2.0, 2.0, 2.0, 3.0, 4.0, 4.0])
    expected = expected + T @ np.diag([5.0, 5.0, 5.0, 0.7, 0.9, 0.9]) @ T.T
    np.testing.assert_allclose(system.mass, expected, atol=1e-14)


@pytest.mark.parametrize(("axis", "width", "height"), [(1, 0.08, 0.02), (2, 0.02, 0.08)])
def test_a_rectangle_is_stiff_across_its_long_side(axis: int, width: float, height: float) -> None:
    """Sides along the first axis (y) and the second (z): F L^3 / 3 E I, and shear beside it."""
    section, length = rectangle(width, height, 0.3), 2.0
    force = np.zeros(6)
    force[axis] = 1.0
    tip = np.linalg.solve(beam_stiffness(section, length, STEEL)[6:, 6:], force)[axis]
    bending = length**3 / (3.0 * STEEL.youngs_modulus * 0.02 * 0.08**3 / 12.0)
    shear = length / (STEEL.shear_modulus * section.shear_areas[axis - 1])
    assert tip == pytest.approx(bending + shear, rel=1e-12)


def test_a_frame_has_the_mass_of_its_beams_and_bodies() -> None:
    section, ends = round_section(0.1, 0.3), np.array([[0.0, 0.0, 0.0], [0.0, 3.0, 4.0]])
    member = Member((0, 1), (ends[0], ends[1]), section, np.array([1.0, 0.0, 0.0]))
    body = np.diag([7.0, 7.0, 7.0, 0.1, 0.2, 0.3])
    frame = SpatialFrame(ends, [member], STEEL, {1: body})
    motions = point_motions(ends)
    whole = motions.T @ frame.mass @ motions
    mass = STEEL.density * section.area * 5.0
    np.testing.assert_allclose(whole[:3, :3], (mass + 7.0) * np.eye(3), atol=1e-9)
    # of a beam halves at its ends, and the body: m c x
    assert whole[0, 4] == pytest.approx(4.0 * (0.5 * mass + 7.0))
