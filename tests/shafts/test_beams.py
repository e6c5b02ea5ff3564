from dataclasses import replace

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.shafts.beam.closed_forms import (
    MainBearingBeam,
    main_bearing_frame,
    pinned_model,
    pinned_reaction,
    torsional_spring_model,
    torsional_spring_reaction,
)
from fe_drivetrain.shafts.beam.shaft import solve, unit_load_response

inf = np.inf
TABLE = MainBearingBeam()
L1, L2, EI = TABLE.overhang, TABLE.span, TABLE.bending_stiffness
K1, W = TABLE.radial_stiffness, TABLE.gearbox_weight


@pytest.fixture(scope="module")
def loads():
    rng = np.random.default_rng(5)
    return rng.normal([3e5, 0, -4e5, 8e5, 1e5, 0], [1e5, 6e4, 6e4, 1e5, 5e5, 5e5], (3, 40, 6))


def plane_by_equilibrium(B, M, stiffness, G, EI=EI, K1=K1):
    """One plane from first principles, unknowns R_A, M_T, R_B (loads on the supports), phi, w."""
    # Forces and moments about the bearing (B at -L1, so its moment is +L1 B; G and R_B at +L2),
    # the three supports, and the cantilever from bearing to gearbox under G - R_B.
    rows = np.array(
        [
            [1, 0, 1, 0, 0],
            [0, 1, -L2, 0, 0],
            [0, 1, 0, -stiffness, 0],
            [0, 0, 1, 0, -K1],
            [0, 0, L2**3 / (3 * EI), L2, 1],
        ]
    )
    right = [B + G, M + L1 * B - L2 * G, 0, 0, G * L2**3 / (3 * EI)]
    # Columns brought to one size: N, N m, N, rad, m.
    size = np.array([1e6, 1e6, 1e6, 1e-2, 1e-2])
    return (np.linalg.solve(rows * size, right) * size)[:3]


def frame_reaction(load, table, bearing=None, shear=True, gravity=(0, 0, 0)):
    """Load on the main bearing of the spatial beam that the closed forms are special cases of."""
    unit = unit_load_response(
        main_bearing_frame(table, bearing, shear), [-table.overhang, table.span], at=0.0
    )
    weight = np.array([0, 0, -table.gearbox_weight, 0, 0, 0])
    constant = unit.solution([np.zeros(6), weight], gravity).reaction("bearing")
    return np.asarray(load) @ unit.reaction_matrix("bearing")[:, 0, :].T + constant


def test_table_3_1_is_the_default():
    # Stirling 2023, Table 3.1 and section 3.3.1.
    assert (TABLE.overhang, TABLE.span) == (2.145, 2.615)
    assert (TABLE.radial_stiffness, TABLE.axial_stiffness) == (8e7, 4e6)
    assert (TABLE.gearbox_weight, TABLE.shaft_diameter, TABLE.bore) == (392280.0, 0.4, 0.0)
    assert (TABLE.tilt_stiffness, TABLE.yaw_stiffness) == (145e6, 392e6)
    assert TABLE.bending_stiffness == pytest.approx(200e9 * np.pi * 0.4**4 / 64)
    half = replace(TABLE, bore=0.2)
    assert half.bending_stiffness == pytest.approx(TABLE.bending_stiffness * (1 - 0.5**4))


def test_pinned_reaction_balances_moments_about_the_gearbox():
    assert pinned_reaction(1.0, 0.0, 2.0, 4.0) == pytest.approx(1.5)
    assert pinned_reaction(0.0, 1.0, 2.0, 4.0) == pytest.approx(0.25)
    # A moment that cancels the force's arm unloads the bearing.
    assert pinned_reaction(10.0, -60.0, 2.0, 4.0) == pytest.approx(0.0)


@pytest.mark.parametrize("stiffness", [1e3, 145e6, 1e12])
@pytest.mark.parametrize("G", [-W, 0.0, W])
def test_equation_3_18_follows_from_equilibrium_and_compatibility(stiffness, G):
    B, M = -4e5, 7e5
    force, moment, _ = plane_by_equilibrium(B, M, stiffness, G)
    result = torsional_spring_reaction(B, M, L1, L2, EI, K1, stiffness, G)
    # A soft bearing's small moment is known to the rounding of the large ones it balances.
    assert result[1] == pytest.approx(moment, rel=1e-10, abs=1e-14 * abs(M))
    assert result[0] == pytest.approx(force, rel=1e-10)


def test_downward_gearbox_weight_presses_the_bearing_down_and_tilts_its_rear_down():
    # Nothing at the hub: the weight at x > 0 turns the shaft about +y (rear end down).
    out = torsional_spring_model(np.zeros(6), TABLE)
    assert out[4] > 0.0
    assert out[2] < 0.0
    assert out[[0, 1, 3, 5]] == pytest.approx(0.0)
    # Moments about the gearbox: the weight itself has no arm there.
    assert out[4] + L2 * out[2] == pytest.approx(0.0, abs=1e-9 * out[4])


def test_gearbox_force_in_the_direction_of_b_mirrors_with_the_plane():
    # Turning the plane upside down changes every sign, G's too.
    up = torsional_spring_reaction(-4e5, 7e5, L1, L2, EI, K1, 145e6, -W)
    down = torsional_spring_reaction(4e5, -7e5, L1, L2, EI, K1, 145e6, W)
    assert up[0] == pytest.approx(-down[0], rel=1e-15)
    assert up[1] == pytest.approx(-down[1], rel=1e-15)


def test_bearing_stiffness_limits():
    B, M, G = 3e5, -2e5, -W
    force, moment = torsional_spring_reaction(B, M, L1, L2, EI, K1, 0.0, G)
    assert moment == 0.0
    assert force == pytest.approx(pinned_reaction(B, M, L1, L2), rel=1e-15)
    # Clamped: the overhang's moment and that of the gearbox spring's share of G.
    _, moment = torsional_spring_reaction(B, M, L1, L2, EI, K1, inf, G)
    kept = 1 / K1 / (1 / K1 + L2**3 / (3 * EI))
    assert moment == pytest.approx(M + B * L1 - G * L2 * kept, rel=1e-12)
    # Rigid gearbox: its weight goes straight down; rigid shaft: only the two springs share.
    _, moment = torsional_spring_reaction(B, M, L1, L2, inf, inf, 145e6, G)
    assert moment == pytest.approx(0.0, abs=1e-6)
    _, moment = torsional_spring_reaction(B, M, L1, L2, inf, K1, 145e6)
    share = 145e6 / (145e6 + K1 * L2**2)
    assert moment == pytest.approx((M + B * L1) * share, rel=1e-12)


def test_closed_forms_are_vectorised_over_histories(loads):
    whole = torsional_spring_model(loads, TABLE)
    assert whole.shape == loads.shape
    assert whole[2, 7] == pytest.approx(torsional_spring_model(loads[2, 7], TABLE), rel=1e-15)
    assert pinned_model(loads, TABLE)[2, 7] == pytest.approx(pinned_model(loads[2, 7], TABLE))


def test_pinned_model_balances_in_space(loads):
    # With the gearbox taking what is left, moments about the gearbox vanish but for the torque.
    bearing = pinned_model(loads, TABLE)
    moment = loads[..., 3:] + np.cross([-L1 - L2, 0, 0], loads[..., :3])
    moment = moment - np.cross([-L2, 0, 0], bearing[..., :3]) - bearing[..., 3:]
    assert moment[..., 1:] == pytest.approx(0.0, abs=1e-8)
    assert bearing[..., 3:] == pytest.approx(0.0, abs=0.0)


def test_torsional_spring_model_balances_in_space(loads):
    bearing = torsional_spring_model(loads, TABLE)
    moment = loads[..., 3:] + np.cross([-L1 - L2, 0, 0], loads[..., :3])
    moment = moment - np.cross([-L2, 0, 0], bearing[..., :3]) - bearing[..., 3:]
    assert moment[..., 1:] == pytest.approx(0.0, abs=1e-8)


def relative_difference(a, b):
    return np.abs(a - b).max(axis=(0, 1)) / (np.abs(b).max(axis=(0, 1)) + 1.0)


def test_frame_reproduces_the_pinned_form(loads):
    free = replace(TABLE, tilt_stiffness=0.0, yaw_stiffness=0.0)
    for shear in (True, False):
        assert relative_difference(
            frame_reaction(loads, free, shear=shear), pinned_model(loads, TABLE)
        ) == pytest.approx(0.0, abs=1e-12)


def test_frame_reproduces_the_torsional_spring_form(loads):
    assert relative_difference(
        frame_reaction(loads, TABLE, shear=False), torsional_spring_model(loads, TABLE)
    ) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("stiffness", [1e-3, 1.0, 1e5, 1e9, 1e15, inf])
def test_frame_and_closed_form_agree_at_any_bearing_stiffness(loads, stiffness):
    other = replace(TABLE, tilt_stiffness=stiffness, yaw_stiffness=2 * stiffness)
    assert relative_difference(
        frame_reaction(loads, other, shear=False), torsional_spring_model(loads, other)
    ) == pytest.approx(0.0, abs=1e-10)


def test_a_quarter_turn_takes_one_plane_to_the_other(loads):
    # y to z, z to -y; without the weight and with equal stiffness the planes are equal.
    equal = replace(TABLE, gearbox_weight=0.0, yaw_stiffness=145e6)
    turn = np.kron(np.eye(2), [[1, 0, 0], [0, 0, -1], [0, 1, 0]])
    for model in (pinned_model, torsional_spring_model, frame_reaction):
        assert model(loads @ turn.T, equal) == pytest.approx(
            model(loads, equal) @ turn.T, rel=1e-10, abs=1e-6
        )


def test_shear_gives_the_bearing_more_moment():
    # Shear makes the shaft from bearing to gearbox softer, so the overhang's moment turns the
    # bearing more: L2/(3 EI) becomes L2/(3 EI) + 1/(GAs L2) in Eq 3.18.
    load = np.array([0, 0, 0, 0, 1e6, 0])
    light = replace(TABLE, gearbox_weight=0.0)
    G = light.material.shear_modulus
    nu = light.material.poisson_ratio
    shear_rigidity = 6 * (1 + nu) / (7 + 6 * nu) * G * np.pi * 0.4**2 / 4
    bend, lift = L2 / (3 * EI) + 1 / (shear_rigidity * L2), 1 / (K1 * L2**2)
    expected = 1e6 * (bend + lift) / (1 / 145e6 + lift + bend)
    assert frame_reaction(load, light)[4] == pytest.approx(expected, rel=1e-11)


def test_frame_shares_thrust_by_stiffness_when_the_bearing_yields():
    # Bearing spring at x = 0 beside the span L2 in series with K2.
    k = 5e7
    rest = 1 / (1 / TABLE.axial_stiffness + L2 / (200e9 * np.pi * 0.4**2 / 4))
    out = frame_reaction([1e5, 0, 0, 0, 0, 0], TABLE, (k, inf, inf, 0, 0, 0))
    assert out[0] == pytest.approx(1e5 * k / (k + rest), rel=1e-11)
    assert frame_reaction([1e5, 0, 0, 0, 0, 0], TABLE)[0] == pytest.approx(1e5, rel=1e-12)


def test_frame_takes_a_full_stiffness_matrix_and_gravity():
    k = np.diag([4e8, 1e10, 2e10, 0.0, 145e6, 392e6])
    k[2, 4] = k[4, 2] = -3e8
    load = np.array([1e5, 2e4, -3e5, 5e5, 4e5, -2e5])
    out = frame_reaction(load, TABLE, bearing=k, gravity=(0, 0, -9.81))
    beam = main_bearing_frame(TABLE, k)
    weight = [0, 0, -W, 0, 0, 0]
    whole = solve(beam, [-L1, L2], [load, weight], at=0.0, gravity=(0, 0, -9.81))
    assert out == pytest.approx(whole.reaction("bearing"), rel=1e-12)
    assert out == pytest.approx(k @ whole.displacements, rel=1e-9, abs=1e-6)
    mass = 7850 * np.pi / 4 * 0.4**2 * (L1 + L2)
    down = -3e5 - W - mass * 9.81
    assert whole.reactions[:, 2].sum() == pytest.approx(down, rel=1e-12)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("overhang", 0.0),
        ("span", inf),
        ("span", np.nan),
        ("radial_stiffness", 0.0),
        ("axial_stiffness", -1.0),
        ("gearbox_weight", -392280.0),
        ("shaft_diameter", -0.4),
        ("bore", 0.4),
        ("tilt_stiffness", -1.0),
    ],
)
def test_bad_parameters_are_named(name, value):
    with pytest.raises(InputError, match=name):
        replace(TABLE, **{name: value})


def test_bad_loads_and_stiffness_are_named():
    with pytest.raises(InputError, match="6 components"):
        pinned_model(np.zeros((4, 5)), TABLE)
    with pytest.raises(InputError, match="not finite"):
        torsional_spring_model(np.full(6, np.nan), TABLE)
    with pytest.raises(InputError, match="gearbox stiffness 0"):
        torsional_spring_reaction(1.0, 0.0, L1, L2, EI, 0.0, 1e8)
    with pytest.raises(InputError, match="bearing stiffness -1"):
        torsional_spring_reaction(1.0, 0.0, L1, L2, EI, K1, -1.0)
    with pytest.raises(InputError, match="shares of the load are indeterminate"):
        torsional_spring_reaction(1.0, 0.0, L1, L2, inf, inf, inf)
