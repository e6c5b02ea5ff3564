import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.spatial import wrench_transport
from fe_drivetrain.drivetrain_file.materials import Material
from fe_drivetrain.shafts.beam.beam import Beam, Support
from fe_drivetrain.shafts.beam.sections import (
    BeamSection,
    RigiditySection,
    cowper_shear_coefficient,
)
from fe_drivetrain.shafts.beam.shaft import shaft_stiffness, solve, unit_load_response

inf = np.inf
STEEL = Material(youngs_modulus=210e9, poisson_ratio=0.3, density=7850.0)
E, G = STEEL.youngs_modulus, STEEL.shear_modulus
D = 0.4
A, EI = np.pi * D**2 / 4, E * np.pi * D**4 / 64
GAS = float(cowper_shear_coefficient(0.3)) * G * A
GJ = G * np.pi * D**4 / 32
CLAMP = (inf,) * 6
BALL = (inf, inf, inf, 0, 0, 0)
ROLLER = (0, inf, inf, 0, 0, 0)
TORQUE_BALL = (inf, inf, inf, inf, 0, 0)
g = 9.81


def shaft(length, supports, **kwargs):
    return Beam([BeamSection(length, D)], supports, material=STEEL, **kwargs)


def stepped_beam(shear=True, start=-2.1):
    """Statically indeterminate in both planes, different in each, with a step and a taper."""
    coupled = np.diag([2e8, 3e9, 4e9, 1e6, 2e8, 3e8])
    coupled[1, 5] = coupled[5, 1] = 2e8
    coupled[2, 4] = coupled[4, 2] = -4e8
    return Beam(
        [
            BeamSection(1.5, 0.5, 0.1, 0.8, 0.2),
            BeamSection(1.2, 0.8, 0.2),
            BeamSection(2.0, 0.6, 0.2, 0.4),
        ],
        [
            Support("front", start + 1.9, coupled),
            Support("rear", start + 3.0, (0, inf, inf, 0, 4e7, 9e7)),
            Support("gearbox", start + 4.7, (4e6, 8e7, 6e7, 5e8, 0, 0)),
        ],
        start=start,
        material=STEEL,
        shear=shear,
    )


# --- exact solutions -----------------------------------------------------------------------


def test_cantilever_tip_compliance_in_all_six_directions():
    L = 3.0
    unit = unit_load_response(shaft(L, [Support("wall", 0.0, CLAMP)]), L, at=L)
    bend = L**3 / (3 * EI) + L / GAS
    slope, turn = L**2 / (2 * EI), L / EI
    expected = np.diag([L / (E * A), bend, bend, L / GJ, turn, turn])
    expected[1, 5] = expected[5, 1] = slope
    expected[2, 4] = expected[4, 2] = -slope
    assert unit.displacement == pytest.approx(expected, rel=1e-13, abs=1e-25)


def test_euler_bernoulli_leaves_shear_out():
    unit = unit_load_response(shaft(3.0, [Support("wall", 0.0, CLAMP)], shear=False), 3.0, at=3.0)
    assert unit.displacement[2, 2] == pytest.approx(27.0 / (3 * EI), rel=1e-13)


def test_stepped_cantilever_is_a_series():
    a, L, d2 = 1.1, 2.7, 0.25
    beam = Beam(
        [BeamSection(a, D), BeamSection(L - a, d2)],
        [Support("wall", 0.0, CLAMP)],
        material=STEEL,
        shear=False,
    )
    unit = unit_load_response(beam, L, at=L).displacement
    EI2, GJ2 = EI * (d2 / D) ** 4, GJ * (d2 / D) ** 4
    tip = ((L**3 - (L - a) ** 3) / EI + (L - a) ** 3 / EI2) / 3
    assert unit[2, 2] == pytest.approx(tip, rel=1e-13)
    assert unit[3, 3] == pytest.approx(a / GJ + (L - a) / GJ2, rel=1e-13)


def test_simply_supported_with_central_load():
    L = 4.0
    beam = shaft(L, [Support("a", 0.0, TORQUE_BALL), Support("b", L, ROLLER)])
    P = -5e4
    out = solve(beam, L / 2, [0, 0, P, 0, 0, 0], at=[0.0, L / 2, L])
    assert out.reaction("a")[2] == pytest.approx(P / 2, rel=1e-13)
    assert out.reaction("b")[2] == pytest.approx(P / 2, rel=1e-13)
    sag = P * (L**3 / (48 * EI) + L / (4 * GAS))
    assert out.displacements[1, 2] == pytest.approx(sag, rel=1e-12)
    assert out.displacements[[0, 2], 2] == pytest.approx(0.0, abs=1e-18)
    slope = P * L**2 / (16 * EI)
    assert out.displacements[[0, 2], 4] == pytest.approx([-slope, slope], rel=1e-12)


def test_overhung_shaft():
    # Two bearings, load at the overhang a: tip P a^2 (a + L) / (3 EI), shear P a (1 + a/L) / GAs.
    a, L, P = 1.3, 2.2, 7e4
    beam = shaft(a + L, [Support("m", 0.0, TORQUE_BALL), Support("r", L, ROLLER)], start=-a)
    out = solve(beam, -a, [0, P, 0, 0, 0, 0], at=-a)
    assert out.reaction("m")[1] == pytest.approx(P * (1 + a / L), rel=1e-13)
    assert out.reaction("r")[1] == pytest.approx(-P * a / L, rel=1e-13)
    tip = P * a**2 * (a + L) / (3 * EI) + P * a * (1 + a / L) / GAS
    assert out.displacements[1] == pytest.approx(tip, rel=1e-12)


def test_propped_cantilever():
    # Central load, Euler-Bernoulli: 5/16 P at the prop, 3/16 P L at the wall.
    L, P = 3.0, 1e5
    beam = shaft(L, [Support("wall", 0.0, CLAMP), Support("prop", L, ROLLER)], shear=False)
    out = solve(beam, L / 2, [0, 0, P, 0, 0, 0])
    assert out.reaction("prop")[2] == pytest.approx(5 / 16 * P, rel=1e-12)
    assert out.reaction("wall")[2] == pytest.approx(11 / 16 * P, rel=1e-12)
    # Load up at +x turns about -y.
    assert out.reaction("wall")[4] == pytest.approx(-3 / 16 * P * L, rel=1e-12)


def test_propped_cantilever_with_shear():
    # Compatibility at the prop: R (L^3/3EI + L/GAs) = P (5 L^3/48EI + L/2GAs).
    L, P = 1.0, 1e5
    beam = shaft(L, [Support("wall", 0.0, CLAMP), Support("prop", L, ROLLER)])
    expected = P * (5 * L**3 / (48 * EI) + L / (2 * GAS)) / (L**3 / (3 * EI) + L / GAS)
    assert solve(beam, L / 2, [0, 0, P, 0, 0, 0]).reaction("prop")[2] == pytest.approx(
        expected, rel=1e-12
    )


def test_three_supports_under_own_weight():
    # Two equal spans, uniform load, Euler-Bernoulli: 3/8, 10/8, 3/8 of q L.
    L = 2.5
    beam = shaft(
        2 * L,
        [Support("a", 0.0, TORQUE_BALL), Support("b", L, ROLLER), Support("c", 2 * L, ROLLER)],
        shear=False,
    )
    out = solve(beam, 0.0, np.zeros(6), gravity=(0, 0, -g))
    qL = -STEEL.density * A * g * L
    assert out.reactions[:, 2] == pytest.approx([3 / 8 * qL, 10 / 8 * qL, 3 / 8 * qL], rel=1e-11)


def test_own_weight_sag():
    L = 5.0
    q = STEEL.density * A * g
    simple = shaft(L, [Support("a", 0.0, TORQUE_BALL), Support("b", L, ROLLER)])
    sag = solve(simple, 0.0, np.zeros(6), at=L / 2, gravity=(0, 0, -g)).displacements[2]
    assert sag == pytest.approx(-q * L**4 * 5 / (384 * EI) - q * L**2 / (8 * GAS), rel=1e-12)
    wall = shaft(L, [Support("wall", 0.0, CLAMP)])
    out = solve(wall, L, np.zeros(6), at=L, gravity=(g, 0, -g))
    assert out.displacements[2] == pytest.approx(
        -q * L**4 / (8 * EI) - q * L**2 / (2 * GAS), rel=1e-12
    )
    assert out.displacements[4] == pytest.approx(q * L**3 / (6 * EI), rel=1e-12)
    assert out.displacements[0] == pytest.approx(q * L**2 / (2 * E * A), rel=1e-12)
    assert out.reaction("wall") == pytest.approx([q * L, 0, -q * L, 0, q * L**2 / 2, 0], abs=1e-9)


def test_shaft_stiffness_is_the_textbook_timoshenko_element():
    # Przemieniecki 1968: 12 EI / (L^3 (1 + Phi)), Phi = 12 EI / (GAs L^2).
    L = 1.4
    beam = shaft(2.0, [])
    K = shaft_stiffness(beam, 0.3, 0.3 + L)
    phi = 12 * EI / (GAS * L**2)
    k = EI / (L**3 * (1 + phi))
    assert K[0, [0, 6]] == pytest.approx([E * A / L, -E * A / L], rel=1e-12)
    assert K[3, [3, 9]] == pytest.approx([GJ / L, -GJ / L], rel=1e-12)
    vertical = np.ix_([2, 4, 8, 10], [2, 4, 8, 10])
    near, far = (4 + phi) * L**2, (2 - phi) * L**2
    expected = k * np.array(
        [
            [12, -6 * L, -12, -6 * L],
            [-6 * L, near, 6 * L, far],
            [-12, 6 * L, 12, 6 * L],
            [-6 * L, far, 6 * L, near],
        ]
    )
    assert K[vertical] == pytest.approx(expected, rel=1e-11)
    horizontal = np.ix_([1, 5, 7, 11], [1, 5, 7, 11])
    mirror = np.diag([1, -1, 1, -1])
    assert K[horizontal] == pytest.approx(mirror @ expected @ mirror, rel=1e-11)


def test_shaft_stiffness_of_a_taper_knows_rigid_motion_and_symmetry():
    K = shaft_stiffness(stepped_beam(), -2.0, 2.0)
    rigid = np.vstack([np.eye(6), wrench_transport([4.0, 0.0, 0.0]).T])
    assert np.abs(K @ rigid).max() < 1e-11 * np.abs(K).max()
    assert np.array_equal(K, K.T) or np.abs(K - K.T).max() < 1e-15 * np.abs(K).max()
    assert np.sum(np.linalg.eigvalsh(K) > 1e-9 * np.abs(K).max()) == 6


def test_force_method_equals_direct_stiffness_assembly():
    beam = stepped_beam()
    stations = [-2.1, -0.6, -0.2, 0.6, 0.9, 2.6]
    K = np.zeros((36, 36))
    for i in range(5):
        s = slice(6 * i, 6 * i + 12)
        K[s, s] += shaft_stiffness(beam, stations[i], stations[i + 1])
    for support in beam.supports:
        i = int(np.argmin(np.abs(np.array(stations) - support.x)))
        s = slice(6 * i, 6 * i + 6)
        K[s, s] += np.where(np.isinf(support.stiffness), 0.0, support.stiffness)
    rigid = [6 * 4 + 1, 6 * 4 + 2]
    free = np.setdiff1d(np.arange(36), rigid)
    load = np.array([1e5, -2e5, 3e5, 4e5, -5e5, 6e5])
    f = np.zeros(36)
    f[:6] = load
    u = np.zeros(36)
    u[free] = np.linalg.solve(K[np.ix_(free, free)], f[free])
    out = solve(beam, stations[0], load, at=stations)
    scale = np.abs(u).max()
    assert out.displacements.ravel() == pytest.approx(u, abs=1e-10 * scale)
    residual = f[rigid] - K[rigid] @ u
    assert out.reaction("rear")[1:3] == pytest.approx(residual, rel=1e-9)


# --- balances, symmetries, invariances --------------------------------------------------------


def test_reactions_balance_loads_and_weight():
    beam = stepped_beam()
    rng = np.random.default_rng(3)
    at = [-2.1, 0.3, 2.6]
    loads = rng.normal(size=(5, 3, 6)) * 1e5
    out = solve(beam, at, loads, gravity=(0.5, 0.0, -g))
    force = loads[..., :3].sum(axis=1)
    moment = (loads[..., 3:] + np.cross([[x, 0, 0] for x in at], loads[..., :3])).sum(axis=1)
    # Frustum (outer less bore): L pi/12 (a^2 + ab + b^2), centroid L/4 (a^2 + 2ab + 3b^2)/(same).
    mass, first_moment, origin = 0.0, 0.0, -2.1
    for section in beam.sections:
        for (a, b), sign in zip(section.end_diameters, (1, -1), strict=True):
            m = sign * STEEL.density * section.length * np.pi / 12 * (a * a + a * b + b * b)
            shift = (a * a + 2 * a * b + 3 * b * b) / (a * a + a * b + b * b) / 4
            mass += m
            first_moment += m * (origin + section.length * shift)
        origin += section.length
    weight = mass * np.array([0.5, 0.0, -g])
    force = force + weight
    moment = moment + np.cross([first_moment / mass, 0, 0], weight)
    arms = [[support.x, 0, 0] for support in beam.supports]
    reaction = out.reactions
    assert reaction[..., :3].sum(axis=1) == pytest.approx(force, rel=1e-12, abs=1e-7)
    about = (reaction[..., 3:] + np.cross(arms, reaction[..., :3])).sum(axis=1)
    assert about == pytest.approx(moment, rel=1e-12, abs=1e-7)


def test_springs_take_stiffness_times_displacement():
    beam = stepped_beam()
    out = solve(beam, -2.1, [1e5, 2e5, -3e5, 4e5, 5e5, 6e5], at=[s.x for s in beam.supports])
    front = np.asarray(beam.supports[0].stiffness)
    assert out.reaction("front") == pytest.approx(front @ out.displacements[0], rel=1e-9)
    gearbox = np.diag(np.asarray(beam.supports[2].stiffness))
    assert out.reaction("gearbox") == pytest.approx(gearbox * out.displacements[2], rel=1e-9)
    assert out.displacements[1, 1:3] == pytest.approx(0.0, abs=1e-16)
    assert out.reaction("rear")[[0, 3]] == pytest.approx(0.0, abs=0.0)


def test_maxwell_betti_reciprocity():
    at = [-2.1, 0.1, 1.4, 2.6]
    D = unit_load_response(stepped_beam(), at, at=at).displacement.reshape(24, 24)
    assert pytest.approx(D.T, abs=1e-12 * np.abs(D).max()) == D
    assert np.linalg.eigvalsh(D).min() > -1e-12 * np.abs(D).max()


def test_moving_the_origin_changes_nothing():
    loads = [1e5, 2e5, -3e5, 4e5, 5e5, 6e5]
    here = solve(stepped_beam(), -2.1, loads, gravity=(0, 0, -g))
    there = solve(stepped_beam(start=97.9), 97.9, loads, gravity=(0, 0, -g))
    assert there.reactions == pytest.approx(here.reactions, rel=1e-9, abs=1e-6)
    assert there.displacements == pytest.approx(here.displacements, rel=1e-9, abs=1e-14)


def test_more_stations_change_nothing():
    loads = [1e5, 2e5, -3e5, 4e5, 5e5, 6e5]
    few = solve(stepped_beam(), -2.1, loads, at=[-2.1, 2.6], gravity=(0, 0, -g))
    many = solve(stepped_beam(), -2.1, loads, at=np.linspace(-2.1, 2.6, 40), gravity=(0, 0, -g))
    assert many.reactions == pytest.approx(few.reactions, rel=1e-10, abs=1e-6)
    assert many.displacements[[0, -1]] == pytest.approx(few.displacements, rel=1e-10, abs=1e-16)


def test_turning_the_frame_about_x_turns_the_answer():
    # A quarter turn takes y to z and z to -y, in forces and in moments.
    turn = np.kron(np.eye(2), [[1, 0, 0], [0, 0, -1], [0, 1, 0]])
    beam = stepped_beam()

    def turned(stiffness):
        rigid = np.isinf(stiffness)
        out = turn @ np.where(rigid, 0.0, stiffness) @ turn.T
        out[np.abs(turn) @ rigid @ np.abs(turn.T) > 0] = inf
        return out

    other = Beam(
        beam.sections,
        [Support(s.name, s.x, turned(np.asarray(s.stiffness))) for s in beam.supports],
        start=beam.start,
        material=STEEL,
    )
    load = np.array([1e5, 2e5, -3e5, 4e5, 5e5, 6e5])
    first = solve(beam, -2.1, load, gravity=(0, 3.0, -g))
    second = solve(other, -2.1, turn @ load, gravity=turn[:3, :3] @ [0, 3.0, -g])
    assert second.reactions == pytest.approx(first.reactions @ turn.T, rel=1e-10, abs=1e-6)
    assert second.displacements == pytest.approx(first.displacements @ turn.T, rel=1e-10, abs=1e-16)


def test_mirrored_shaft_mirrors_the_answer():
    # Through the plane x = 0: Fx, My, Mz change sign (a moment is an axial vector).
    mirror = np.diag([-1.0, 1, 1, 1, -1, -1])
    beam = stepped_beam()
    sections = [
        BeamSection(
            s.length,
            s.end_diameters[0][1],
            s.end_diameters[1][1],
            s.outer_diameter,
            s.inner_diameter,
        )
        for s in reversed(beam.sections)
    ]
    supports = []
    for s in beam.supports:
        k = np.asarray(s.stiffness)
        finite = mirror @ np.where(np.isinf(k), 0.0, k) @ mirror
        supports.append(Support(s.name, -s.x, np.where(np.isinf(k), inf, finite)))
    other = Beam(sections, supports, start=-2.6, material=STEEL)
    load = np.array([1e5, 2e5, -3e5, 4e5, 5e5, 6e5])
    first = solve(beam, -2.1, load, at=0.3, gravity=(1.0, 0, -g))
    second = solve(other, 2.1, mirror @ load, at=-0.3, gravity=(-1.0, 0, -g))
    assert second.reactions == pytest.approx(first.reactions @ mirror, rel=1e-10, abs=1e-6)
    assert second.displacements == pytest.approx(first.displacements @ mirror, rel=1e-10, abs=1e-16)


def test_coupled_support_equals_the_spring_at_the_end_of_a_rigid_arm():
    arm = 0.6
    spring = np.diag([1e7, 2e7, 3e7, 4e7, 5e7, 6e7])
    far = Beam(
        [BeamSection(2.0, D), RigiditySection(arm, inf, inf, inf, inf)],
        [Support("s", 2.0 + arm, spring)],
        material=STEEL,
    )
    H = wrench_transport([arm, 0.0, 0.0])
    near = Beam([BeamSection(2.0, D)], [Support("s", 2.0, H @ spring @ H.T)], material=STEEL)
    load = [1e5, 2e5, -3e5, 4e5, 5e5, 6e5]
    a, b = solve(far, 0.0, load, at=0.0), solve(near, 0.0, load, at=0.0)
    assert b.displacements == pytest.approx(a.displacements, rel=1e-12)
    assert b.reaction("s") == pytest.approx(H @ a.reaction("s"), rel=1e-11)


def test_singular_coupled_support_holds_only_what_it_holds():
    # One vertical spring at the end of an arm: rank 1 as a 6x6.
    H = wrench_transport([0.5, 0.0, 0.0])
    column = H @ np.eye(6)[2]
    support = Support("s", 1.0, 1e7 * np.outer(column, column))
    directions, compliance = support.directions
    assert compliance.shape == (1,)
    rebuilt = directions.T @ np.diag(1 / compliance) @ directions
    assert rebuilt == pytest.approx(np.asarray(support.stiffness), rel=1e-12)


@pytest.mark.parametrize("k", [1e16, 1e25])
def test_very_stiff_springs_tend_to_rigid(k):
    def reactions(value):
        beam = shaft(
            3.0,
            [
                Support("wall", 0.0, (value,) * 6),
                Support("mid", 1.0, (0, value, value, 0, 0, 0)),
                Support("end", 3.0, (0, value, value, 0, 0, 0)),
            ],
        )
        return unit_load_response(beam, 2.0).reaction

    assert reactions(k) == pytest.approx(reactions(inf), rel=1e-5, abs=1e-6)


def test_soft_support_beside_stiff_ones_gets_its_share():
    # A torsional spring twelve orders softer than the rest still takes all of the torque.
    beam = shaft(
        3.0,
        [Support("a", 0.0, (1e9, 1e9, 1e9, 1e-3, 0, 0)), Support("b", 3.0, (0, 1e9, 1e9, 0, 0, 0))],
    )
    out = solve(beam, 1.0, [0, 0, 5.0, 7.0, 0, 0], at=0.0)
    assert out.reaction("a")[3] == pytest.approx(7.0, rel=1e-12)
    assert out.displacements[3] == pytest.approx(7.0 / 1e-3, rel=1e-9)
    assert out.reaction("a")[2] == pytest.approx(10 / 3, rel=1e-12)


def test_a_soft_extra_support_changes_little_and_takes_k_times_u():
    supports = [Support("wall", 0.0, CLAMP), Support("soft", 3.0, (0, 0, 2.0, 0, 0, 0))]
    out = solve(shaft(3.0, supports), 3.0, [0, 0, 1e5, 0, 0, 0], at=3.0)
    tip = 1e5 * (9.0 / EI + 3.0 / GAS)
    assert out.displacements[2] == pytest.approx(tip, rel=1e-6)
    assert out.reaction("soft")[2] == pytest.approx(2.0 * tip, rel=1e-6)


# --- shapes of the answer -------------------------------------------------------------------


def test_many_load_cases_at_once_equal_one_by_one():
    rng = np.random.default_rng(0)
    loads = rng.normal(size=(3, 4, 2, 6))
    at = [-2.1, 2.6]
    together = solve(stepped_beam(), at, loads)
    assert together.displacements.shape == (3, 4, 6, 6)
    assert together.reactions.shape == (3, 4, 3, 6)
    alone = solve(stepped_beam(), at, loads[1, 2])
    assert together.displacements[1, 2] == pytest.approx(alone.displacements, rel=1e-12)
    assert together.reaction("rear")[1, 2] == pytest.approx(alone.reaction("rear"), rel=1e-12)


def test_unit_response_is_what_the_solution_uses():
    unit = unit_load_response(stepped_beam(), -2.1)
    load = np.array([1e5, 2e5, -3e5, 4e5, 5e5, 6e5])
    out = unit.solution(load)
    assert unit.reaction_matrix("front") @ load == pytest.approx(out.reaction("front"))
    assert unit.stations == pytest.approx([-2.1, -0.6, -0.2, 0.6, 0.9, 2.6])
    assert unit.solution(load[None, :]).reactions.shape == (1, 3, 6)


# --- refusals ---------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("supports", "says"),
    [
        ([], "move along x and to turn about x and to move along y and turn about z"),
        ([Support("a", 1.0, BALL)], "turn about x and to turn about z at x = 1 m and to turn"),
        (
            [Support("a", 0.5, BALL), Support("b", 1.5, ROLLER)],
            "^the beam is free to turn about x because",
        ),
        (
            [Support("a", 0.5, (0, 1, 1, 1, 0, 0)), Support("b", 1.5, (0, 1, 1, 0, 0, 0))],
            "^the beam is free to move along x because",
        ),
        (
            [Support("a", 0.5, TORQUE_BALL), Support("b", 1.5, (0, 0, inf, 0, 0, 0))],
            "^the beam is free to turn about z at x = 0.5 m because",
        ),
        (
            [Support("a", 0.5, (inf, inf, 0, inf, 1e6, 1e6))],
            "^the beam is free to move along z because",
        ),
    ],
)
def test_a_mechanism_is_named(supports, says):
    with pytest.raises(InputError, match=says):
        unit_load_response(shaft(2.0, supports), 0.0)


def test_a_coupled_mechanism_is_found():
    # Held along x + y only, never along x - y.
    k = np.diag([1e6, 1e6, 1e6, 1e6, 1e6, 1e6])
    k[0, 1] = k[1, 0] = 1e6
    with pytest.raises(InputError, match="coupled motion"):
        unit_load_response(shaft(2.0, [Support("a", 1.0, k)]), 0.0)


def test_a_support_however_soft_holds():
    unit = unit_load_response(shaft(2.0, [Support("a", 1.0, (1e-6,) * 6)]), 0.0)
    carried = unit.reaction_matrix("a")
    assert carried == pytest.approx(wrench_transport([-1.0, 0.0, 0.0]), abs=1e-9)


def test_shares_that_statics_cannot_tell_are_refused():
    twice = [Support("a", 1.0, CLAMP), Support("b", 1.0, ROLLER)]
    with pytest.raises(InputError, match=r"'a' and 'b' are both rigid in y at x = 1 m"):
        unit_load_response(shaft(2.0, twice), 0.0)
    rigid = Beam(
        [RigiditySection(2.0, inf, inf, inf, inf)],
        [Support("a", 0.0, TORQUE_BALL), Support("b", 1.0, ROLLER), Support("c", 2.0, ROLLER)],
    )
    with pytest.raises(InputError, match="shares are indeterminate"):
        unit_load_response(rigid, 0.0)


def test_rigid_shaft_on_springs_is_a_lever():
    beam = Beam(
        [RigiditySection(2.0, inf, inf, inf, inf)],
        [
            Support("a", 0.0, (1e6, 1e6, 1e6, 1e6, 0, 0)),
            Support("b", 1.0, (0, 1e6, 1e6, 0, 0, 0)),
            Support("c", 2.0, (0, 1e6, 1e6, 0, 0, 0)),
        ],
    )
    # Three equal springs, load at one end: 5/6, 2/6, -1/6.
    out = solve(beam, 0.0, [0, 0, 6.0, 0, 0, 0])
    assert out.reactions[:, 2] == pytest.approx([5.0, 2.0, -1.0], rel=1e-12)


ASYMMETRIC = np.eye(6)
ASYMMETRIC = ASYMMETRIC + np.eye(6, k=1) * 0.5
INDEFINITE = np.eye(6) + 2 * (np.eye(6, k=1) + np.eye(6, k=-1))
RIGID_COUPLED = np.diag([inf, 1, 1, 1, 1, 1.0])
RIGID_COUPLED[0, 1] = RIGID_COUPLED[1, 0] = 0.1


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: Support("a", 0.0, (1, 2, 3)), "shape"),
        (lambda: Support("a", 0.0, (1, 1, -1, 1, 1, 1)), "0 or more"),
        (lambda: Support("a", 0.0, (1, 1, np.nan, 1, 1, 1)), "0 or more"),
        (lambda: Support("a", inf, CLAMP), "finite station"),
        (lambda: Support("a", 0.0, ASYMMETRIC), "asymmetric"),
        (lambda: Support("a", 0.0, INDEFINITE), "negative eigenvalue"),
        (lambda: Support("a", 0.0, RIGID_COUPLED), "no coupling"),
        (lambda: Beam([], []), "at least 1"),
        (lambda: shaft(2.0, [Support("a", 3.0, CLAMP)]), "support 'a' at x = 3 m"),
        (lambda: shaft(2.0, [Support("a", 1.0, CLAMP)] * 2), "used 2 times"),
        (lambda: shaft(2.0, [], start=np.nan), "start"),
        (lambda: solve(shaft(2.0, [Support("a", 0.0, CLAMP)]), 3.0, np.zeros(6)), "load station"),
        (lambda: solve(shaft(2.0, [Support("a", 0.0, CLAMP)]), 1.0, np.zeros(5)), "must end in"),
        (
            lambda: solve(shaft(2.0, [Support("a", 0.0, CLAMP)]), [0.0, 1.0], np.zeros(6)),
            "must end in",
        ),
        (
            lambda: solve(shaft(2.0, [Support("a", 0.0, CLAMP)]), 1.0, np.full(6, np.nan)),
            "not finite",
        ),
        (
            lambda: solve(shaft(2.0, [Support("a", 0.0, CLAMP)]), 1.0, np.zeros(6), gravity=[9.81]),
            "gravity",
        ),
        (
            lambda: solve(shaft(2.0, [Support("a", 0.0, CLAMP)]), 1.0, np.zeros(6)).reaction("b"),
            "choose one of a",
        ),
        (lambda: shaft_stiffness(shaft(2.0, []), 1.0, 0.5), "swap"),
        (
            lambda: shaft_stiffness(Beam([RigiditySection(1.0, 1e9, 1e9, inf, 1e9)], []), 0.0, 1.0),
            "rigid in some direction",
        ),
    ],
)
def test_bad_input_is_named(make, says):
    with pytest.raises(InputError, match=says):
        make()


def test_a_spring_that_is_as_good_as_none_is_named_so() -> None:
    supports = [
        Support("bearing", 2.0, [np.inf, np.inf, np.inf, 0, 0, 0]),
        Support("gearbox", 4.0, [0, 1e-9, 1e-9, np.inf, 0, 0]),
    ]
    with pytest.raises(InputError, match="times softer than the shaft"):
        solve(Beam([BeamSection(4.0, 0.4)], supports), 0.0, [0, 0, 1e5, 0, 0, 0])
