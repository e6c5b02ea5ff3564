"""Rolling bearings by rollers and laminae: closed forms, identities and published numbers."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from fe_drivetrain.bearing import kernels
from fe_drivetrain.bearing.answers import (
    approaches,
    ball_contacts,
    end_loads,
    lamina_loads,
    load_zones,
    pressures,
    secant_stiffness,
    toroidal_clearance_loss,
    truncations,
)
from fe_drivetrain.bearing.arrangements import (
    ball_row,
    cylindrical,
    double_row_tapered,
    spherical_roller,
    tapered_row,
    toroidal,
)
from fe_drivetrain.bearing.contact import (
    ContactLaw,
    houpert,
    iso_line,
    linear,
    palmgren_line,
    point_contact,
)
from fe_drivetrain.bearing.contact_forces import elements, forces, roller_loads, turn
from fe_drivetrain.bearing.distribution import (
    effective_centre,
    sjovall,
    superposed_peak,
)
from fe_drivetrain.bearing.geometry import Bearing, angles, pitch_ratio
from fe_drivetrain.bearing.rating import (
    ball_capacity_factor,
    ball_dynamic_rating,
    capacity_factor,
    ratings,
)
from fe_drivetrain.bearing.rolling import equilibrium, three_degrees
from fe_drivetrain.bearing.tables import reduced_table
from fe_drivetrain.common.errors import InputError

ALPHA = np.radians(38.0)
Z = 36
EXACT = 1e-12

#: Axial, radial, moment and combined loads, in and out of one plane.
LOADS = 1e3 * np.array(
    [
        (200, 0, -400, 800, 0),
        (200, 0, -400, -800, 0),
        (200, 0, -400, 0, 800),
        (100, 0, -400, -300, 0),
        (-50, 90, 20, 10, -600),
    ]
)


def size(
    spread: float = 0.152, arrangement: str = "X", angle: float = 38.0, **more: float
) -> Bearing:
    return double_row_tapered(
        "S",
        Z,
        0.065,
        0.095,
        0.7874,
        angle,
        spread,
        arrangement,
        **more,  # type: ignore[arg-type]
    )


S = size()
ROW = S.rows[1]
LAW = houpert(0.095, 0.065)


def solved(bearing: Bearing, *loads: tuple[float, ...]):
    found = equilibrium(bearing, np.array(loads), tolerance=EXACT)
    assert found.converged.all()
    return found


# closed forms (Stirling 2023, ch. 4; Sjovall 1933)


def test_axial_force_loads_one_row_evenly_and_the_other_not() -> None:
    up, down = solved(S, (-1e5, 0, 0, 0, 0), (1e5, 0, 0, 0, 0)).rollers
    assert_allclose(down[Z:], 1e5 / (Z * np.sin(ALPHA)), rtol=1e-11)
    assert not down[:Z].any()
    assert_allclose(up, np.roll(down, Z), rtol=1e-9)


@pytest.mark.parametrize(("exponent", "factor"), [(1.1, 4.0766), (10 / 9, 4.0850), (1.5, 4.3701)])
def test_radial_force_has_sjovalls_peak(exponent: float, factor: float) -> None:
    law = ContactLaw(LAW.stiffness, exponent)
    found = solved(S.with_rows(law=law), (0, 0, -4e5, 0, 0))
    peak = found.rollers.max(axis=1) * Z * np.cos(ALPHA) / 2e5
    assert_allclose(peak, factor, rtol=3e-5)
    assert_allclose(peak, 1.0 / sjovall(0.5, exponent)[0], rtol=3e-5)
    assert_allclose(found.rollers[0, :Z], found.rollers[0, Z:], rtol=1e-9, atol=1e-6)
    assert np.abs(found.displacements[0, [0, 1, 3, 4]]).max() < 1e-9 * abs(
        found.displacements[0, 2]
    )


def test_discrete_rollers_have_the_peaks_of_sums() -> None:
    for n, factor in ((8, 4.0770), (14, 4.0860), (20, 4.0846), (72, 4.0850)):
        one = cylindrical("one", n, 0.02, 0.03, 0.6)
        peak = solved(one, (0, -1e5, 0, 0, 0)).rollers.max() * n / 1e5
        assert_allclose(peak, factor, atol=6e-5)


def test_sjovalls_integrals_are_the_published_table() -> None:
    # epsilon: J_r and J_a of point contact, of line contact, of the exponent 1.1
    table = {
        0.2: (0.1590, 0.1707, 0.1732, 0.1879, 0.1736, 0.1885),
        0.5: (0.2288, 0.2782, 0.2448, 0.3080, 0.2453, 0.3090),
        0.8: (0.2559, 0.3658, 0.2655, 0.4084, 0.2658, 0.4099),
        1.0: (0.2546, 0.4244, 0.2525, 0.4798, 0.2523, 0.4817),
        1.25: (0.2289, 0.5044, 0.2087, 0.5751, 0.2079, 0.5775),
        2.5: (0.1339, 0.7240, 0.1083, 0.7819, 0.1075, 0.7837),
        5.0: (0.0711, 0.8558, 0.0549, 0.8899, 0.0544, 0.8909),
    }
    for epsilon, values in table.items():
        found = [sjovall(epsilon, n) for n in (1.5, 10 / 9, 1.1)]
        assert_allclose(np.ravel(found), values, atol=5.1e-5)
    # NSK, catalogue E728g, section 5.1: half of the circle, to its digits
    for exponent, peak, axial in ((1.5, 4.37, 1.216), (10 / 9, 4.08, 1.260)):
        Jr, Ja = sjovall(0.5, exponent)
        assert_allclose([1.0 / Jr, Ja / Jr], [peak, axial], rtol=2e-3)
    with pytest.raises(InputError, match="must be positive"):
        sjovall(0.0, 1.1)


def test_single_row_with_half_of_it_loaded_needs_1_26_of_axial_force() -> None:
    row = tapered_row(200, 0.01, 0.002, 0.7874, 38.0, place=0.3937 * np.tan(ALPHA))
    axial = 1.2595 * 1e5 * np.tan(ALPHA)
    found = solved(Bearing("one", (replace(row, aligning=True),)), (axial, 0, -1e5, 0, 0))
    assert 98 <= (found.rollers > 0.0).sum() <= 102


def test_moment_alone_has_its_closed_form_and_opposite_load_zones() -> None:
    theta = 1e-3
    F, _ = forces(S, [0, 0, 0, theta, 0])
    e = ROW.arm + ROW.places
    M = 2 * Z * sjovall(0.5, 1.1)[0] * LAW.stiffness * np.mean(np.abs(e) ** 2.1) * theta**1.1
    assert_allclose(F[0, 3], M, rtol=3e-5)
    assert np.abs(F[0, :3]).max() < 1e-9 * M
    upwind, downwind = load_zones(S, [0, 0, 0, theta, 0])
    assert_allclose((upwind.centre_deg - downwind.centre_deg) % 360.0, 180.0, rtol=1e-9)
    assert_allclose(superposed_peak(S, np.array([0, 0, 0, M, 0])), upwind.peak[0], rtol=0.03)


def test_uniform_preload_has_a_diagonal_stiffness() -> None:
    d0 = 2e-5
    K = forces(S.with_rows(clearance=-d0), np.zeros(5))[1][0]
    k = 1.1 * LAW.stiffness * d0**0.1
    squared = ROW.arm**2 + 0.095**2 / 12 * (1 - 1 / ROW.laminae**2)
    exact = np.diag(
        [2 * Z * k * np.sin(ALPHA) ** 2, *2 * [Z * k * np.cos(ALPHA) ** 2], *2 * [Z * k * squared]]
    )
    assert_allclose(K, exact, rtol=1e-12, atol=1e-12 * K.max())


def test_one_lamina_has_no_length_and_many_converge_to_the_closed_form() -> None:
    u = np.array([[3e-5, 1e-5, -4e-5, 4e-4, 1e-4]])
    exact = forces(S.with_rows(laminae=0), u)[0]
    error = [
        np.abs(forces(S.with_rows(laminae=n), u)[0] - exact).max() / np.abs(exact).max()
        for n in (10, 40, 160)
    ]
    assert error[1] < 0.1 * error[0]
    assert error[2] < 0.1 * error[1]
    assert error[2] < 2e-6
    middle = replace(ROW, laminae=1)
    assert_allclose(middle.places, 0.0)


@pytest.mark.parametrize(
    ("middle", "slope"), [(1e-5, 1e-9), (1e-5, 1e-4), (1e-5, -4e-4), (-1e-5, 1e-3)]
)
def test_a_straight_roller_is_integrated_in_closed_form(middle: float, slope: float) -> None:
    x = 0.095 * ((np.arange(200_000) + 0.5) / 200_000 - 0.5)
    q = LAW.load(middle + slope * x) / 200_000
    load, moment = q.sum(), (q * x).sum()
    row = tapered_row(36, 0.065, 0.095, 0.7874, 38.0, laminae=0)
    # a displacement that makes this approach at roller 0, whose tangent is -z
    b, t = middle, slope
    u = [(b - t * row.arm) / np.sin(ALPHA), 0.0, 0.0, 0.0, -t]
    Q, M, _ = elements(Bearing("one", (row,)), u)
    assert_allclose(Q[0, 0], load, rtol=1e-7)
    assert_allclose(M[0, 0], moment, rtol=1e-4, atol=1e-9 * load)


# identities


def test_loads_times_s_are_displacements_times_a_power_of_s() -> None:
    one, three = (equilibrium(S, s * LOADS, tolerance=EXACT) for s in (1.0, 3.0))
    scale = np.array([1, 1, 1, 0.4, 0.4])
    assert_allclose(
        three.displacements * scale,
        3 ** (1 / 1.1) * one.displacements * scale,
        rtol=1e-8,
        atol=1e-14,
    )
    assert_allclose(three.rollers, 3.0 * one.rollers, rtol=1e-7, atol=1e-5)
    secants = [secant_stiffness(S, found.displacements) for found in (one, three)]
    assert_allclose(secants[1], 3 ** (1 / 11) * secants[0], rtol=1e-6, atol=1e-6 * secants[0].max())


def test_equilibrium_holds_in_vectors_of_space() -> None:
    """Forces of the laminae at their places, without the arms that the solver uses."""
    found = solved(S, *LOADS)
    for case, u in enumerate(found.displacements):
        total = np.zeros(6)
        for row in S.rows:
            q, psi = lamina_loads(row, u)[0], angles(row)
            e_r = np.column_stack([np.zeros(Z), -np.cos(psi), np.sin(psi)])
            n = np.sin(row.angle) * np.eye(3)[0] + np.cos(row.angle) * e_r
            along = np.cos(row.angle) * np.eye(3)[0] - np.sin(row.angle) * e_r
            middle = row.place * np.eye(3)[0] + row.radius * e_r
            r = middle[:, None] + row.places[:, None] * along[:, None]
            f = q[..., None] * n[:, None]
            total[:3] += f.sum(axis=(0, 1))
            total[3:] += np.cross(r, f).sum(axis=(0, 1))
        assert_allclose(total[[0, 1, 2, 4, 5]], LOADS[case], rtol=1e-9, atol=1e-5)
        assert abs(total[3]) < 1e-6  # no friction: none about the axis


def every_kind() -> list[Bearing]:
    return [
        S,
        size(arrangement="O", angle=20.0, clearance=1e-5, crown=3e-5),
        size(clearance=-1e-5, laminae=0),
        cylindrical("cylindrical", 16, 0.04, 0.05, 0.225, clearance=2e-5),
        spherical_roller("spherical", 20, 0.05, 0.06, 0.5, 12.0),
        toroidal("toroidal", 20, 0.05, 0.06, 0.5),
        Bearing("deep groove", (ball_row(7, 0.0115, 0.0435, radial_clearance=1e-5),)),
        Bearing(
            "angular", tuple(ball_row(16, 0.03, 0.3, a, -0.02 * np.sign(a)) for a in (-40, 40))
        ),
        Bearing("single tapered", S.rows[:1]),
    ]


@pytest.mark.parametrize("bearing", every_kind(), ids=lambda b: b.name)
def test_the_tangent_is_the_derivative_of_the_forces_and_of_an_energy(bearing: Bearing) -> None:
    rng = np.random.default_rng(1)
    scale = 1e-4 * np.array([1, 1, 1, 1 / bearing.arm, 1 / bearing.arm])
    u = scale * rng.normal(size=(20, 5))
    K = forces(bearing, u)[1]
    h = 1e-5
    for j in range(5):
        step = h * scale * np.eye(5)[j]
        slope = (forces(bearing, u + step)[0] - forces(bearing, u - step)[0]) / (2 * step[j])
        size_of = np.abs(K * scale).max()
        assert np.abs(slope - K[:, :, j]).max() * scale[j] < 2e-3 * size_of
    assert_allclose(K, np.swapaxes(K, 1, 2), rtol=0, atol=1e-9 * np.abs(K).max())
    scaled = K * scale[:, None] * scale
    assert np.linalg.eigvalsh(scaled).min() > -1e-12 * np.abs(scaled).max()
    # round a closed way no work is left
    way = np.linspace(0, 2 * np.pi, 401)
    turn_of = (
        np.array([np.cos(way), np.sin(way), np.cos(way), np.sin(way), np.sin(2 * way)]).T * scale
    )
    along = forces(bearing, turn_of)[0]
    work = 0.5 * ((along[1:] + along[:-1]) * np.diff(turn_of, axis=0)).sum()
    assert abs(work) < 1e-3 * np.abs(along * turn_of).max()


def test_a_turn_by_one_pitch_moves_the_rollers_by_one() -> None:
    base = solved(S, *LOADS)
    turned = solved(S, *turn(LOADS, np.full(len(LOADS), 2 * np.pi / Z)))
    assert_allclose(
        turned.rollers.reshape(-1, 2, Z),
        np.roll(base.rollers.reshape(-1, 2, Z), 1, axis=2),
        rtol=1e-7,
        atol=1e-4,
    )


def test_the_mirror_image_exchanges_the_rows() -> None:
    mirror = np.array([-1, 1, 1, -1, -1])
    base, image = solved(S, *LOADS), solved(S, *(LOADS * mirror))
    assert_allclose(image.displacements, base.displacements * mirror, rtol=1e-7, atol=1e-14)
    assert_allclose(image.rollers, np.roll(base.rollers, Z, axis=1), rtol=1e-6, atol=1e-4)


def test_face_to_face_and_back_to_back_carry_thrust_on_other_rows() -> None:
    face, back = S, size(arrangement="O")
    assert_allclose(
        abs(face.rows[1].arm) + abs(back.rows[1].arm), 2 * 0.3937 * np.sin(ALPHA), rtol=1e-12
    )
    (row,) = np.nonzero(solved(back, (1e5, 0, 0, 0, 0)).rollers[0])
    assert row.max() < Z
    assert effective_centre(back.rows[1]) > 0.3 > effective_centre(face.rows[1])


def test_three_degrees_are_exact_in_one_plane_and_leave_force_out_of_it() -> None:
    plane = three_degrees(S, LOADS[:2], tolerance=EXACT)
    assert_allclose(plane.displacements, solved(S, *LOADS[:2]).displacements, rtol=1e-8, atol=1e-13)
    turned = [
        (2e5, 0, -4e5, 8e5 * np.cos(a), 8e5 * np.sin(a)) for a in np.radians([0.0, 5, 15, 30])
    ]
    left = np.hypot(*three_degrees(S, turned).unbalanced[:, 1:3].T)
    assert (np.diff(left) > 0).all()
    assert left[0] < 1e-2 < left[-1]
    assert three_degrees(S, LOADS).converged.all()


def test_a_cage_that_has_moved_on_is_a_bearing_that_is_turned() -> None:
    phase = np.full(len(LOADS), 0.03)
    moved = equilibrium(S, LOADS, phases=phase, tolerance=EXACT)
    other = solved(S.with_rows(phase=0.03), *LOADS)
    assert_allclose(moved.displacements, other.displacements, rtol=1e-7, atol=1e-14)
    assert_allclose(moved.rollers, other.rollers, rtol=1e-6, atol=1e-3)
    assert np.abs(moved.unbalanced).max() < 1e-2
    F, K = forces(S, moved.displacements, phases=phase)
    assert_allclose(F, LOADS, rtol=1e-8, atol=1e-3)
    assert_allclose(K, forces(other.bearing, other.displacements)[1], rtol=1e-6, atol=1e-3 * 1e9)
    # a rolling roller at the place of a held one carries about the same
    assert_allclose(moved.rollers.max(axis=1), solved(S, *LOADS).rollers.max(axis=1), rtol=0.02)
    assert 0.45 < 0.5 * (1 - pitch_ratio(ROW)) < 0.5


def test_a_roller_that_rolls_feels_the_curve_of_those_that_are_held() -> None:
    pitch = 2 * np.pi / Z
    for load in LOADS[:3]:
        steps = np.linspace(0.0, pitch, 9)[:-1]
        held = solved(S, load).rollers[0, :Z]
        # held rollers at every place, by turning the bearing; the rolling one moves on with it
        many = equilibrium(S, np.tile(load, (len(steps), 1)), phases=steps, tolerance=EXACT)
        rolling = many.rollers[:, :Z]
        assert_allclose(rolling[0], held, rtol=1e-7, atol=1e-3)
        # through one pitch roller i comes where roller i + 1 was
        once = equilibrium(S, load, phases=np.array([pitch]), tolerance=EXACT).rollers[0, :Z]
        assert_allclose(once, np.roll(held, -1), rtol=1e-7, atol=1e-3)
        # between, on the curve through the held ones, within the ripple of the peak
        between = np.fft.irfft(
            np.fft.rfft(held)[None] * np.exp(1j * np.outer(steps, np.arange(Z // 2 + 1))), Z
        )
        carried = held > 0.2 * held.max()
        inside = carried & np.roll(carried, -1) & np.roll(carried, 1)
        assert np.abs(rolling - between)[:, inside].max() < 0.02 * held.max()


def test_the_secant_stiffness_returns_the_load() -> None:
    found = solved(S, *LOADS)
    u = found.displacements
    Ks = secant_stiffness(S, u)
    assert_allclose(Ks, forces(S, u)[1] / 1.1, rtol=1e-6, atol=1e-6 * np.abs(Ks).max())
    ball = Bearing("ball", (ball_row(16, 0.03, 0.3, 25.0),))
    at = np.array([1e-4, 2e-5, 1e-5, 1e-4, 0.0])
    difference = (forces(ball, at)[0] - forces(ball, np.zeros(5))[0])[0]
    assert_allclose(secant_stiffness(ball, at)[0] @ at, difference, rtol=1e-3, atol=10.0)


# answers


def test_pressure_is_hertzs_and_laminae_carry_what_rollers_do() -> None:
    u = solved(S, *LOADS).displacements
    total = np.concatenate([lamina_loads(row, u).sum(axis=2) for row in S.rows], axis=1)
    assert_allclose(total, roller_loads(S, u), rtol=1e-10, atol=1e-6)
    row = cylindrical("planet", 16, 0.04, 0.05, 0.225).rows[0]
    bearing = Bearing("planet", (row,))
    at = solved(bearing, (0, 0, -178e3, 0, 0)).displacements
    ((inner, outer),) = pressures(bearing, at)
    # Al-Hamadani 2018's planet bearing in public size: 45.4 kN and 1411 MPa on the inner race
    assert_allclose(roller_loads(bearing, at).max(), 45.4e3, rtol=2e-3)
    assert_allclose(inner.max() / 1e6, 1411.0, rtol=5e-3)
    assert outer.max() < inner.max()
    assert (np.hypot(*approaches(row, at)[0, 0, [0, -1]]) >= 0).all()


def test_clearance_concentrates_the_load_and_preload_spreads_it() -> None:
    peaks, loaded = [], []
    for clearance in (-3e-5, 0.0, 2.5e-5, 5e-5, 1e-4):  # along the contact: half of the diametral
        one = cylindrical("planet", 16, 0.04, 0.05, 0.225, clearance=clearance)
        (zone,) = load_zones(one, solved(one, (0, 0, -178e3, 0, 0)).displacements)
        peaks.append(float(zone.peak[0]))
        loaded.append(int(zone.loaded[0]))
        assert_allclose(zone.at_deg, 270.0)
    assert peaks[1:] == sorted(peaks[1:])
    assert loaded == sorted(loaded, reverse=True)
    assert_allclose(np.array(peaks[1:]) / 1e3, [45.4, 51.1, 55.6, 62.5], rtol=3e-3)


def test_a_crown_relieves_the_ends_of_a_tilted_roller() -> None:
    straight, crowned = (size(crown=c) for c in (0.0, 0.00045 * 0.065))
    ends = [
        end_loads(b.rows[1], solved(b, LOADS[0]).displacements).max() for b in (straight, crowned)
    ]
    assert ends[0] > 1.02
    assert ends[1] < 0.9
    even = end_loads(S.rows[1], solved(S, (1e5, 0, 0, 0, 0)).displacements)
    assert_allclose(even, 1.0, rtol=1e-9)


def test_a_ball_under_thrust_climbs_until_its_ellipse_is_cut_off() -> None:
    row = ball_row(7, 0.0115, 0.0435, radial_clearance=1e-5)
    bearing = Bearing("ball", (row,))
    u = solved(bearing, *[(F, 0, 0, 0, 0) for F in np.linspace(50.0, 6000.0, 60)]).displacements
    inner, outer = truncations(row, u, (0.1, 0.1))
    assert inner[0].max() == outer[0].max() == 0.0
    assert (np.diff(inner.max(axis=1)) >= 0.0).all()
    assert 0.05 < inner.max() < 0.5
    assert_allclose(inner, inner[:, :1] @ np.ones((1, 7)), rtol=1e-9)
    # where it begins, contact angle and half the ellipse reach the shoulder together
    first = int(np.argmax(inner[:, 0] > 0.0))
    load, _, angle = elements(bearing, u[first - 1 : first + 1])
    half = ball_contacts(row)[0].half_axes[0] * np.cbrt(load[:, 0]) / (0.5 * row.diameter)
    before, after = angle[:, 0] + half - np.arccos(1.0 - 0.1 * 0.0115 / row.inner_groove)
    assert before < 0.02
    assert after > -0.02
    assert not truncations(row, np.zeros(5))[0].any()
    assert not truncations(row, u, (0.45, 0.45))[0].any()
    with pytest.raises(InputError, match="outer shoulder"):
        truncations(row, u, (0.2, 0.6))


def test_a_toroidal_bearing_loses_clearance_as_two_arcs_do() -> None:
    """Profiles of races and rollers as circles: centres apart by B / k_2 leave this gap."""
    width, factor = 0.104, 0.096
    apart = width / factor
    s = np.array([0.0, 1e-3, -6.5e-3, 12.7e-3])
    gap = np.hypot(apart, s) - apart  # of one side, diametral is twice it
    lost = toroidal_clearance_loss(width, s, factor)
    assert_allclose(lost, 2.0 * gap, rtol=1e-4)
    with pytest.raises(InputError, match="width"):
        toroidal_clearance_loss(0.0, 1e-3)


# contact laws


def test_hertz_point_contact_of_two_spheres_is_exact() -> None:
    R, E, nu = 0.01, 210e9, 0.3
    contact = point_contact((1 / R, 1 / R), E, nu)
    effective = E / (1 - nu**2) / 2
    assert_allclose(contact.stiffness, 4 / 3 * effective * np.sqrt(R), rtol=1e-12)
    a = np.cbrt(3 * 100.0 * R / (4 * effective))
    assert_allclose(contact.pressure(np.array(100.0)), 1.5 * 100.0 / (np.pi * a**2), rtol=1e-12)
    # nearly a circle, and long: continuous, and softer than a circle of the same sharper curvature
    near = point_contact((1 / R, 1.0011 / R), E, nu)
    assert_allclose(near.stiffness, contact.stiffness, rtol=1e-3)
    with pytest.raises(InputError, match="sum of curvatures"):
        point_contact((1 / R, -1.0), E, nu)


def test_line_laws_agree_where_they_should() -> None:
    # two contacts in series by Palmgren are within 4 % of ISO/TS 16281 (37310 against 35948)
    assert_allclose(
        palmgren_line(0.05).stiffness / iso_line(0.05).stiffness, 37310 / 35948, rtol=3e-3
    )
    # Houpert's law is 18 % above at 0.05 mm
    ratio = LAW.load(np.array(5e-5)) / iso_line(0.095).load(np.array(5e-5))
    assert_allclose(ratio, 1.18, atol=0.01)
    assert linear(2.0).load(np.array([-1.0, 3.0])).tolist() == [0.0, 6.0]


def test_linear_rollers_under_radial_force_are_as_stiff_as_half_of_them() -> None:
    one = cylindrical("one", 40, 0.02, 0.03, 0.6, law=linear(1e9))
    u = solved(one, (0, 0, -1e5, 0, 0)).displacements[0, 2]
    assert_allclose(-1e5 / u, 40 * 1e9 / 4, rtol=1e-6)


# published


@pytest.mark.parametrize(
    ("clearance", "load", "masta"),
    [
        (0.0, (0, 1000.0), (0, 15.1101)),
        (0.0, (1000.0, 0), (133.5381, 0)),
        (1e-5, (0, 1000.0), (0, 21.223)),
        (1e-5, (1000.0, 0), (149.1717, 0)),
        (1e-5, (1000.0, 1000.0), (146.4603, 19.5923)),
    ],
)
def test_deep_groove_displacements_are_those_of_masta(
    clearance: float, load: tuple[float, float], masta: tuple[float, float]
) -> None:
    row = ball_row(7, 0.0115, 0.0435, radial_clearance=clearance, youngs_modulus=210e9)
    u = solved(Bearing("ball", (row,)), (load[0], -load[1], 0, 0, 0)).displacements[0] * 1e6
    assert_allclose([u[0], -u[1]], masta, rtol=5e-5, atol=1e-9)
    if all(load):
        # MASTA's tilt takes the pitch radius as arm of the balls, not that of the groove centres
        arm = row.groove_centre[1] / row.radius
        assert_allclose(abs(u[4]) / 1e3 * arm, 2.6872, rtol=1e-4)


def test_the_rating_of_balls_follows_lundberg_and_palmgren() -> None:
    gamma = np.arange(1, 41) / 100.0
    grooves = (2 * 0.52 / (2 * 0.52 - 1)) ** 0.41
    opening = ((1 - gamma) / (1 + gamma)) ** 1.72
    shape = gamma**0.3 * (1 - gamma) ** 1.39 / (1 + gamma) ** (1 / 3) * grooves
    formula = 39.9 * (1 + (1.04 * opening) ** (10 / 3)) ** -0.3 * shape
    table = np.array([ball_capacity_factor(g) for g in gamma])
    # each value is rounded to a tenth: one factor between both fits all of them
    low, high = ((table + half) / formula for half in (-0.05, 0.05))
    assert low.max() < high.min()


def test_ratings_of_balls_grow_with_their_number_and_size() -> None:
    def rated(size: float, rows: int = 1, balls: int = 8) -> float:
        row = ball_row(balls, size, 5.0 * size)
        return ball_dynamic_rating(Bearing("balls", (row,) * rows))

    assert_allclose(rated(0.02, rows=2) / rated(0.02), 2**0.7)
    assert_allclose(rated(0.02, balls=10) / rated(0.02, balls=5), 2 ** (2 / 3))
    assert_allclose(rated(0.0254 * (1 + 1e-9)), rated(0.0254), rtol=2e-4)
    with pytest.raises(InputError, match=r"0\.01 to 0\.4"):
        ball_dynamic_rating(Bearing("large balls", (ball_row(3, 0.03, 0.07),)))
    with pytest.raises(InputError, match="must be balls"):
        ball_dynamic_rating(size())


def test_ratings_of_balls_grow_more_slowly_above_an_inch() -> None:
    """All sizes of a bearing scaled, its rating grows as D^1.8, and as D^1.4 above 25.4 mm."""

    def rating(diameter: float) -> float:
        row = ball_row(8, diameter, 6.0 * diameter)
        return ball_dynamic_rating(Bearing("balls", (row,)))

    assert rating(0.024) / rating(0.012) == pytest.approx(2.0**1.8, rel=1e-12)
    assert rating(0.06) / rating(0.03) == pytest.approx(2.0**1.4, rel=1e-12)
    # 3.647 is 25.4^0.4 in four digits
    assert rating(0.025401) / rating(0.0254) == pytest.approx(1.0, abs=2e-4)


def test_clearance_holds_laminae_back_as_it_does_rollers() -> None:
    bearing = double_row_tapered("S", 36, 0.065, 0.095, 0.7874, 38.0, 0.152, "X", clearance=3e-5)
    u = np.array([[2e-5, 4e-5, -9e-5, 2e-4, 1e-4], [0.0, 0.0, 1.2e-4, 0.0, 3e-4]])
    rollers = roller_loads(bearing, u)
    free = roller_loads(bearing.with_rows(clearance=0.0), u)
    assert (rollers.sum(axis=1) < 0.9 * free.sum(axis=1)).all()
    laminae = [lamina_loads(row, u).sum(axis=2) for row in bearing.rows]
    np.testing.assert_allclose(np.hstack(laminae), rollers, atol=1e-9 * rollers.max())


def test_grooves_stand_where_the_free_contact_angle_has_them() -> None:
    """ISO/TS 16281: R_i = D_pw/2 + (r_i - D_w/2) cos(alpha_0), cos(alpha_0) = 1 - s / (2 A)."""
    clearance = 4e-5
    row = ball_row(8, 0.02, 0.1, radial_clearance=clearance)
    A = 0.02 * (0.52 + 0.53 - 1.0)
    expected = 0.05 + 0.02 * (0.52 - 0.5) * (1.0 - clearance / (2.0 * A))
    assert row.groove_centre == pytest.approx((0.0, expected), rel=1e-14)
    assert row.groove_centre[1] < ball_row(8, 0.02, 0.1).groove_centre[1]


def test_ratings_are_those_of_masta_and_of_the_catalogue() -> None:
    one = Bearing("A4", (tapered_row(87, 0.11051, 0.238048, 3.3309, 19.0),))
    found = ratings(one)
    assert_allclose(found.fatigue, 3_929_016.7, rtol=1e-6)
    assert_allclose(found.dynamic, 22_227_978.9, rtol=1e-3)
    table = {0.01: 52.12, 0.02: 60.79, 0.03: 66.46, 0.04: 70.71, 0.05: 74.10, 0.10: 84.23}  # f_c
    assert_allclose([capacity_factor(g) for g in table], list(table.values()), atol=6e-3)
    skf = ratings(size(angle=20.0))  # 331555B: 6710, 16600, 1100 kN (Stirling 2023, Table 4.1)
    assert_allclose([skf.dynamic, skf.static, skf.fatigue], [6710e3, 16600e3, 1100e3], rtol=0.03)
    with pytest.raises(InputError, match="must be rollers"):
        ratings(Bearing("ball", (ball_row(7, 0.0115, 0.0435),)))


# Newton's method


@pytest.mark.parametrize("bearing", every_kind(), ids=lambda b: b.name)
def test_any_start_leads_to_the_same_equilibrium(bearing: Bearing) -> None:
    rng = np.random.default_rng(2)
    n, arm = 40, bearing.arm
    scale = np.array([1, 1, 1, arm, arm])
    u = 2e-4 * rng.normal(size=(n, 5)) / scale
    F = forces(bearing, u)[0]  # loads that it can carry
    F = F[np.abs(F).max(axis=1) > 0.0]
    cold = equilibrium(bearing, F, warm=False, tolerance=1e-10)
    far = equilibrium(bearing, F, start=1e-3 * rng.normal(size=F.shape) / scale, tolerance=1e-10)
    assert cold.converged.all()
    assert far.converged.all()
    size_of = np.abs(F / scale).max()
    assert np.abs((cold.unbalanced - far.unbalanced) / scale).max() < 1e-8 * size_of
    assert_allclose(cold.rollers, far.rollers, atol=1e-5 * cold.rollers.max())


def test_loads_of_any_size_down_to_none_converge() -> None:
    for bearing in (S, S.with_rows(clearance=2e-5), S.with_rows(clearance=-2e-5)):
        F = np.concatenate([LOADS * 10.0**-k for k in range(0, 12, 2)] + [np.zeros((1, 5))])
        found = equilibrium(bearing, F)
        assert found.converged.all()
        assert np.abs(found.unbalanced).max() < 1e-1
    # inside the clearance nothing carries, and a vanishing load just touches
    assert not equilibrium(S.with_rows(clearance=2e-5), np.zeros(5)).rollers.any()


def test_a_series_started_from_the_step_before_is_the_same_as_from_nothing() -> None:
    t = np.linspace(0, 6, 1200)[:, None]
    F = LOADS[:1] * (1.2 + np.sin(t * [1.0, 1.3, 0.7, 1.9, 1.0])) + LOADS[2:3] * np.sin(2 * t)
    warm, cold = equilibrium(S, F), equilibrium(S, F, warm=False)
    assert warm.converged.all()
    assert_allclose(warm.displacements, cold.displacements, rtol=1e-4, atol=1e-10)
    assert warm.evaluations.sum() < 0.8 * cold.evaluations.sum()
    one = [equilibrium(S, f, warm=False).displacements[0] for f in F[::300]]
    assert_allclose(cold.displacements[::300], one, rtol=1e-12, atol=0)


@pytest.mark.parametrize("bearing", every_kind(), ids=lambda b: b.name)
def test_a_load_that_stays_leaves_the_rollers_as_they_are(bearing: Bearing) -> None:
    """Tilt and shift of a single row belong together: a start must not take one for the other."""
    u = 1e-4 * np.array([1.0, 0.4, -0.8, 0.3 / bearing.arm, 0.2 / bearing.arm])
    F = np.repeat(forces(bearing, u)[0], 6, axis=0)
    found = equilibrium(bearing, F)
    assert found.converged.all()
    arms = np.array([1, 1, 1, bearing.arm, bearing.arm])
    assert np.abs(found.unbalanced / arms).max() <= 1e-7 * np.abs(F / arms).max()
    assert_allclose(found.displacements, found.displacements[:1].repeat(6, axis=0), rtol=1e-12)


# what a user can get wrong


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: size(angle=0.0), "between 0 and 90 deg"),
        (lambda: size(angle=90.0), "between 0 and 90 deg"),
        (lambda: size(arrangement="T"), "X .face to face. or O"),
        (lambda: size(spread=-1.0), "positive distance"),
        (lambda: tapered_row(40, 0.065, 0.095, 0.7874, 38.0), "overlap"),
        (lambda: tapered_row(2, 0.065, 0.095, 0.7874, 38.0), "give 3 or more"),
        (lambda: tapered_row(8, 0.5, 0.095, 0.7874, 38.0), "no inner ring"),
        (lambda: tapered_row(36, 0.065, -0.1, 0.7874, 38.0), "must be positive"),
        (lambda: size(clearance=0.002), "beyond 1 %"),
        (lambda: size(clearance=-0.002), "beyond 1 %"),
        (lambda: size(clearance=float("nan")), "beyond 1 %"),
        (lambda: size(laminae=-1), "laminae"),
        (lambda: size(crown=0.01), "crown"),
        (lambda: size(crown=1e-5, laminae=0), "no closed form"),
        (lambda: ball_row(7, 0.0115, 0.0435, 90.0), "between -90 and 90"),
        (lambda: ball_row(7, 0.0115, 0.0435, inner_conformity=0.5), "sum of curvatures"),
        (lambda: ball_row(7, 0.0115, 0.0435, radial_clearance=6e-4), "clearance"),
        (lambda: replace(ROW, aligning=True), "aligning row"),
        (lambda: replace(ROW, angle=np.pi), "-90 and 90 deg"),
        (lambda: Bearing("none", ()), "no rows"),
        (lambda: ContactLaw(0.0, 1.1), "must be positive"),
        (lambda: ContactLaw(1e9, 3.0), "exponent"),
        (lambda: equilibrium(S, [1, 2, np.nan, 0, 0]), "Fz of case 0"),
        (lambda: equilibrium(S, [1, 2, 3]), "shape"),
        (lambda: equilibrium(S, LOADS, tolerance=0.0), "tolerance"),
        (lambda: forces(S, [0, 0, 0, np.inf, 0]), "tilt about y"),
        (lambda: equilibrium(toroidal("C", 20, 0.05, 0.06, 0.5), [1e3, 0, 0, 0, 0]), "axial"),
        (
            lambda: equilibrium(
                spherical_roller("P", 20, 0.05, 0.06, 0.5, 12.0), [0, 0, 0, 1e3, 0]
            ),
            "tilt about y",
        ),
    ],
)
def test_mistakes_are_named_in_one_sentence(make, words: str) -> None:
    with pytest.raises(InputError, match=words) as caught:
        make()
    assert "\n" not in str(caught.value)


def test_a_moment_that_arms_of_zero_cannot_carry_is_refused() -> None:
    """Contact normals through the centre, and short rollers: a mechanism."""
    place = 0.3937 * np.tan(ALPHA)
    rows = tuple(
        replace(tapered_row(Z, 0.065, 1e-6, 0.7874, 38.0, sign * place, sign), laminae=1)
        for sign in (-1, 1)
    )
    with pytest.raises(InputError, match="no contact of the bearing carries"):
        equilibrium(Bearing("mechanism", rows), [0, 0, -1e5, 1e5, 0])
    assert equilibrium(Bearing("mechanism", rows), [1e4, 0, -1e5, 0, 0]).converged.all()


@pytest.mark.parametrize("exponent", [0.0, 0.1, 1 / 9, 0.5, 1.0])
def test_powers_from_a_table_are_those_of_the_library(exponent: float) -> None:
    x = 10.0 ** np.random.default_rng(3).uniform(-30, 3, 2000)
    table = kernels.power_table(exponent)
    assert_allclose([kernels.power(value, table) for value in x], x**exponent, rtol=2e-15)
    assert kernels.power(0.0, table) == 0.0


@pytest.mark.parametrize("count", [11, 30, 64, 0])
def test_gauss_s_rule_stands_for_the_sum_over_laminae(count: int) -> None:
    x, share = kernels.gauss_of_laminae(count)
    places = (np.arange(count or 10**6) + 0.5) / (count or 10**6) - 0.5
    assert_allclose(share.sum(), 1.0, rtol=1e-14)
    for degree in range(2 * kernels.NODES):
        exact = 0.0 if degree % 2 else np.mean(places**degree)
        assert_allclose((share * x**degree).sum(), exact, rtol=1e-10, atol=1e-15)
    for power in (0.1, 1.1, 1 / 9, 0.5):  # the steepest approach that it is used for
        exact = np.mean((1.0 + places) ** power)
        assert_allclose((share * (1.0 + x) ** power).sum(), exact, rtol=1e-12)


def test_a_table_of_reduced_loads_interpolates_equilibrium() -> None:
    short = size(laminae=0)
    table = reduced_table(short, (13, 9, 24))
    at_node = 3e5 * np.array([[0, 0, -1, 0, 0], [1, 0, 0, 0, 0], [0, 0, 0, -0.3937, 0]])
    found = solved(short, *at_node)
    u, peaks = table(at_node)
    scale = np.array([1, 1, 1, 0.4, 0.4])
    assert_allclose(u * scale, found.displacements * scale, rtol=1e-6, atol=1e-11)
    assert_allclose(peaks.max(axis=1), found.rollers.max(axis=1), rtol=1e-6)
    between = table(LOADS)[1].max(axis=1)
    assert_allclose(between, solved(short, *LOADS).rollers.max(axis=1), rtol=0.1)
    with pytest.raises(InputError, match="does not scale"):
        reduced_table(size(clearance=1e-5))
    with pytest.raises(InputError, match="nodes"):
        reduced_table(short, (1, 2, 3))
