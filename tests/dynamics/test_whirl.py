"""Whirl: closed forms of rotors, symmetry, balance of power, motion in time, ROSS."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from fe_drivetrain.cases.references.published_rotors import NELSON_MCVAUGH, criticals_rpm
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.materials import Material
from fe_drivetrain.dynamics.whirl.condensed import condensed_rotor
from fe_drivetrain.dynamics.whirl.modes import (
    Critical,
    chart_criticals,
    critical_speeds,
    sense_word,
    stability_limit,
    whirl_chart,
    whirl_modes,
)
from fe_drivetrain.dynamics.whirl.rotor import (
    THEORIES,
    Bearing,
    Disc,
    Element,
    Joint,
    Rotor,
    Theory,
    beam_matrices,
    bearing_of,
    equations,
    refined,
    rigid_rotor,
    rotor_of,
)
from fe_drivetrain.dynamics.whirl.unbalance import Unbalance, balance_moment, unbalance_response
from fe_drivetrain.shafts.beam.frame import round_section

E, RHO, NU = 2.1e11, 7800.0, 0.3
STEEL = Material(youngs_modulus=E, poisson_ratio=NU, density=RHO)
LIGHT = STEEL.model_copy(update={"density": 0.0})
D, L = 0.05, 1.0
SECTION = round_section(D, NU)
EI, A, INERTIA = E * SECTION.inertias[0], SECTION.area, SECTION.inertias[0]
MASS = 20.0
STIFF = 1e8 * EI / L**3
W0 = float(np.sqrt(48 * EI / L**3 / MASS))


def pinned(node: int, y: float = STIFF, z: float = STIFF) -> Bearing:
    return bearing_of(f"bearing at {node}", node, np.diag([0.0, y, z, 0.0, 0.0, 0.0]))


def jeffcott(outer: float = 0.0, viscous: float = 0.0, loss: float = 0.0) -> Rotor:
    """A disc without inertia of turning in the middle of a light shaft, damped from outside."""
    air = bearing_of("air", 1, np.zeros((6, 6)), np.diag([0.0, outer, outer, 0.0, 0.0, 0.0]))
    halves = [Element(L / 2, SECTION, LIGHT)] * 2
    discs = [Disc(1, MASS, 0.0, 0.0)]
    return rotor_of(
        "Jeffcott",
        halves,
        discs,
        [pinned(0), pinned(2), air],
        theory="euler",
        viscous=viscous,
        loss_factor=loss,
    )


def uniform(theory: Theory, elements: int = 24, z: float = STIFF, **damping: float) -> Rotor:
    pieces = [Element(L / elements, SECTION, STEEL)] * elements
    bearings = [pinned(0, z=z), pinned(elements, z=z)]
    return rotor_of("uniform", pieces, [], bearings, theory=theory, **damping)


def uneven() -> Rotor:
    """Bearings that are softer along z, one with a coupling, which change with the speed."""
    pieces = [Element(L / 8, SECTION, STEEL)] * 8
    K = np.diag([0.0, 4e6, 3e6, 0.0, 0.0, 0.0])
    K[1, 2] = K[2, 1] = 5e5
    damping = 50.0 * np.diag([0.0, 1.0, 1.0, 0.0, 0.0, 0.0])
    bearings = [
        bearing_of("front", 0, np.array([K, 3 * K, 4 * K]), damping, [50.0, 400.0, 1500.0]),
        bearing_of("rear", 8, K, damping),
    ]
    return rotor_of("uneven", pieces, [Disc(3, 12.0, 0.2, 0.11)], bearings, viscous=1e-5)


def test_jeffcott_is_critical_at_its_frequency() -> None:
    found = [one.speed for one in critical_speeds(jeffcott(), 10 * W0)]
    np.testing.assert_allclose(found, [W0, W0], rtol=1e-6)


@pytest.mark.parametrize("ratio", [0.3, 0.9, 1.1, 3.0])
def test_jeffcott_whirls_by_unbalance_as_its_closed_form(ratio: float) -> None:
    damping, moment = 0.08, 0.002
    rotor = jeffcott(outer=2 * damping * MASS * W0)
    found = unbalance_response(rotor, [Unbalance(1, moment)], [ratio * W0])
    form = moment / MASS * ratio**2 / np.hypot(1 - ratio**2, 2 * damping * ratio)
    assert found.amplitudes[0, 1] == pytest.approx(form, rel=1e-4)
    assert found.power[0] == pytest.approx(
        2 * damping * MASS * W0 * (ratio * W0 * form) ** 2, rel=1e-4
    )


@pytest.mark.parametrize("share", [0.0, 0.5, 2.0])
def test_jeffcott_loses_stability_where_inner_damping_is_of_outer(share: float) -> None:
    """W = w0 (1 + c_outer / c_inner), Smith 1933."""
    seconds = 1e-3 / W0
    inner = seconds * 48 * EI / L**3
    rotor = jeffcott(outer=share * inner, viscous=seconds)
    assert stability_limit(rotor, 5 * W0) == pytest.approx(W0 * (1 + share), rel=1e-4)
    assert stability_limit(rotor, 0.9 * W0 * (1 + share)) is None


def test_hysteresis_damps_below_the_critical_and_drives_above() -> None:
    loss = 0.01
    rotor = jeffcott(loss=loss)
    for speed, forward in ((0.5 * W0, 1.0), (2.0 * W0, -1.0)):
        modes = whirl_modes(rotor, speed)
        for sense, decrement in zip(modes.senses, modes.decrements, strict=True):
            expected = np.pi * loss * (forward if sense > 0 else 1.0)
            assert decrement == pytest.approx(expected, rel=1e-3)
    assert stability_limit(rotor, 3 * W0) == pytest.approx(W0, rel=1e-4)


@pytest.mark.parametrize("speed", [0.0, 50.0, 400.0, 3000.0])
def test_a_rigid_disc_precesses_as_its_closed_form(speed: float) -> None:
    """J w^2 - w W J_p - k = 0: forward above, backward below the frequency at rest."""
    polar, across, k, kt = 0.4, 0.22, 2e6, 5e4
    K = np.diag([0.0, k, k, 0.0, kt, kt])
    rotor = rotor_of("disc", [], [Disc(0, 3.0, polar, across)], [bearing_of("b", 0, K)])
    half = polar * speed / (2 * across)
    tilts = {half + np.sqrt(half**2 + kt / across), -half + np.sqrt(half**2 + kt / across)}
    expected = sorted([np.sqrt(k / 3.0)] * 2 + [min(tilts), max(tilts)])
    modes = whirl_modes(rotor, speed)
    np.testing.assert_allclose(2 * np.pi * modes.frequencies, expected, rtol=1e-9)
    if speed:
        faster = modes.senses[np.argmin(np.abs(2 * np.pi * modes.frequencies - max(tilts)))]
        assert faster == pytest.approx(1.0)


def test_critical_speeds_of_a_uniform_shaft_are_those_of_its_theory() -> None:
    """Forward w^2 (rho A - rho I k^2) = E I k^4 of Rayleigh's, backward with + 3 rho I k^2."""
    k = np.pi / L
    bends = EI * k**4
    euler = np.sqrt(bends / (RHO * A))
    forward, backward = (np.sqrt(bends / (RHO * A + s * RHO * INERTIA * k**2)) for s in (-1, 3))
    found = {t: [one.speed for one in critical_speeds(uniform(t), 1.5 * euler)] for t in THEORIES}
    np.testing.assert_allclose(found["euler"], [euler, euler], rtol=1e-5)
    np.testing.assert_allclose(found["rayleigh"], [backward, forward], rtol=1e-5)
    # shear: of k^4 E I remains its part in series with k^2 kappa G A, and the turn is less than w'
    soft = 1 + EI * k**2 / (STEEL.shear_modulus * SECTION.shear_areas[0])
    assert found["timoshenko"][1] == pytest.approx(np.sqrt(bends / soft / (RHO * A)), rel=2e-3)


@pytest.mark.parametrize("theory", THEORIES)
def test_whirls_are_pairs_at_rest_and_apart_as_it_turns(theory: Theory) -> None:
    rotor = uniform(theory, 6)
    rest = whirl_modes(rotor, 0.0, 8).frequencies.reshape(-1, 2)
    np.testing.assert_allclose(rest[:, 0], rest[:, 1], rtol=1e-9)
    turning = whirl_modes(rotor, 2000.0, 8)
    if theory == "euler":
        np.testing.assert_allclose(turning.frequencies.reshape(-1, 2), rest, rtol=1e-9)
        return
    assert np.all(turning.senses.reshape(-1, 2) @ [1, -1] == pytest.approx(-2.0))
    pairs = turning.frequencies.reshape(-1, 2)
    assert np.all(pairs[:, 0] < rest[:, 0])
    assert np.all(pairs[:, 1] > rest[:, 1])


@pytest.mark.parametrize("order", [0.5, 1.0, 2.0])
def test_both_ways_find_the_same_criticals(order: float) -> None:
    rotor = uneven()
    one, other = (way(rotor, 3000.0, order) for way in (critical_speeds, chart_criticals))
    assert len(one) >= 3
    np.testing.assert_allclose([c.speed for c in one], [c.speed for c in other], rtol=1e-9)
    np.testing.assert_allclose([c.sense for c in one], [c.sense for c in other], atol=1e-6)


def test_a_critical_of_changing_bearings_is_that_of_their_stiffness_there() -> None:
    rotor = uneven()
    for found in critical_speeds(rotor, 3000.0):
        K, C = rotor.bearings[0].at(found.speed)
        frozen = Bearing("front", 0, np.zeros(1), K[None], C[None])
        same = Rotor(
            "frozen",
            rotor.stations,
            rotor.mass,
            rotor.gyroscopic,
            rotor.stiffness,
            (frozen, rotor.bearings[1]),
        )
        speeds = np.array([one.speed for one in critical_speeds(same, 1e5)])
        assert np.abs(speeds / found.speed - 1).min() < 1e-9


def test_bearings_are_straight_between_speeds_and_stay_beyond() -> None:
    bearing = uneven().bearings[0]
    low, middle, high = (bearing.at(speed)[0] for speed in (0.0, 225.0, 9e3))
    np.testing.assert_allclose(middle, 2 * low)
    np.testing.assert_allclose(high, 4 * low)


def test_shape_and_sense_of_a_critical_obey_its_equations() -> None:
    rotor = uneven()
    for found in critical_speeds(rotor, 3000.0):
        plain = Rotor(
            rotor.name,
            rotor.stations,
            rotor.mass,
            rotor.gyroscopic,
            rotor.stiffness,
            rotor.bearings,
        )
        at, w = equations(plain, found.speed), found.speed
        rates = at.rates - at.absorbing
        left = (at.stiffness - w**2 * at.mass + 1j * w * rates) @ found.shape
        assert np.abs(left).max() < 1e-7 * np.abs(at.stiffness @ found.shape).max()
        assert isinstance(found, Critical)
        assert abs(found.sense) <= 1.0


def test_mirrored_shafts_whirl_alike_against_the_other_sense() -> None:
    """A shaft that turns from z to y on mirrored bearings is the same shaft in a mirror."""
    K = np.diag([0.0, 4e6, 3e6, 0.0, 1e3, 2e3])
    K[1, 2] = K[2, 1] = 8e5
    K[1, 5] = K[5, 1] = 3e4
    mirror = np.diag([1.0, 1.0, -1.0, -1.0, -1.0, 1.0])
    kept = bearing_of("b", 0, K)
    turned = bearing_of("b", 0, mirror @ K @ mirror, mirrored=True)
    np.testing.assert_allclose(kept.stiffness, turned.stiffness)


def test_power_of_unbalance_is_what_bearings_and_shaft_take() -> None:
    rotor = uneven()
    found = unbalance_response(rotor, [Unbalance(3, 1e-3), Unbalance(6, 2e-3, 1.0)], [80.0, 900.0])
    np.testing.assert_allclose(found.power, found.absorbed + found.inner, rtol=1e-9)
    assert np.all(found.absorbed > 0)


@pytest.mark.parametrize("damping", [{"viscous": 1e-4}, {"loss_factor": 0.02}])
def test_damping_of_a_round_shaft_on_equal_bearings_takes_no_power(
    damping: dict[str, float],
) -> None:
    """It whirls bent, and is not strained as it turns."""
    found = unbalance_response(uniform("timoshenko", 6, **damping), [Unbalance(2, 1e-3)], [200.0])
    scale = 1e-3 * 200.0**2 * float(found.amplitudes.max()) * 200.0
    assert abs(float(found.inner[0])) < 1e-9 * scale
    uneven_bearings = uniform("timoshenko", 6, z=1e-6 * STIFF, **damping)
    other = unbalance_response(uneven_bearings, [Unbalance(2, 1e-3)], [200.0])
    assert abs(float(other.inner[0])) > 1e-6 * scale


@pytest.mark.parametrize(("share", "grows"), [(0.8, False), (1.2, True)])
def test_motion_in_time_grows_where_eigenvalues_do(share: float, grows: bool) -> None:
    seconds = 0.02 / W0
    rotor = jeffcott(outer=0.5 * seconds * 48 * EI / L**3, viscous=seconds)
    at = equations(rotor, share * 1.5 * W0)
    # the disc alone has a mass: its condensed motion in both planes
    kept = np.array([2, 8])
    gone = np.setdiff1d(np.arange(12), kept)

    def condensed(A: np.ndarray) -> np.ndarray:
        follow = -np.linalg.solve(
            at.stiffness[np.ix_(gone, gone)], at.stiffness[np.ix_(gone, kept)]
        )
        T = np.zeros((12, 2))
        T[kept, [0, 1]] = 1.0
        T[gone] = follow
        return np.asarray(T.T @ A @ T)

    M, C, K = (condensed(one) for one in (at.mass, at.rates, at.stiffness))

    def slope(_: float, y: np.ndarray) -> np.ndarray:
        return np.concatenate([y[2:], -np.linalg.solve(M, C @ y[2:] + K @ y[:2])])

    span = 60 * 2 * np.pi / W0
    out = solve_ivp(slope, (0.0, span), [1e-3, 0.0, 0.0, 0.0], rtol=1e-9, atol=1e-12)
    size = np.hypot(out.y[0], out.y[1])
    early, late = (float(size[part].max()) for part in (slice(0, 200), slice(-200, None)))
    assert (late > early) is grows


def test_a_rigid_rotor_is_the_limit_of_a_stiff_one() -> None:
    K = np.diag([0.0, 1e4, 1e4, 0.0, 0.0, 0.0])
    bearings = [bearing_of("front", 1, K), bearing_of("rear", 4, 2 * K)]
    pieces = [Element(L / 5, SECTION, STEEL)] * 5
    whole = rotor_of("soft", pieces, [Disc(5, 9.0, 0.2, 0.1)], bearings)
    soft, rigid = ([c.speed for c in critical_speeds(r, 60.0)] for r in (whole, rigid_rotor(whole)))
    assert len(rigid) >= 3
    np.testing.assert_allclose(soft, rigid, rtol=2e-3)


def test_a_joint_of_a_beams_stiffness_is_the_beam_without_mass() -> None:
    light = [Element(L / 2, SECTION, LIGHT)] * 2
    first = rotor_of("one", light, [Disc(1, MASS, 0.3, 0.2)], [pinned(0), pinned(2)])
    joint = Joint(L / 2, beam_matrices(light[0], "timoshenko")[2])
    second = rotor_of("two", [joint, light[1]], [Disc(1, MASS, 0.3, 0.2)], [pinned(0), pinned(2)])
    one, two = (criticals_rpm(rotor) for rotor in (first, second))
    np.testing.assert_allclose(one, two, rtol=1e-9)
    fine, nodes = refined([joint, light[1]], 3)
    assert nodes == [0, 1, 4]
    assert len(fine) == 4


def test_each_mode_is_followed_over_the_speed() -> None:
    rotor = NELSON_MCVAUGH.rotor("timoshenko")
    chart = whirl_chart(rotor, np.linspace(500.0, 12000.0, 24).tolist(), 6)
    assert not np.isnan(chart.frequencies).any()
    for senses in chart.senses[1:].T:
        assert np.ptp(senses) < 1e-6
        assert sense_word(float(senses[0])) in ("forward", "backward")


def test_balance_grade_is_a_speed_of_the_centre_of_mass() -> None:
    moment = balance_moment(6.3e-3, 100.0, 150.0)
    assert moment / 100.0 * 150.0 == pytest.approx(6.3e-3)


def test_what_is_not_held_is_refused() -> None:
    loose = rotor_of("loose", [Element(L, SECTION, STEEL)], [], [pinned(0)])
    with pytest.raises(InputError, match="rotor 'loose' is not held across its axis"):
        critical_speeds(loose, 100.0)
    with pytest.raises(InputError, match="loss factor of rotor 'bad' is -1 but must be at least 0"):
        rotor_of("bad", [], [], [], loss_factor=-1.0)


@pytest.mark.needs("ross")
def test_ross_has_the_same_critical_speeds_and_frequencies() -> None:
    """The same elements there: rotary inertia, shear by Cowper's coefficient, gyroscopic terms."""
    import ross

    steel = ross.Material("steel", rho=NELSON_MCVAUGH.density, E=NELSON_MCVAUGH.modulus, Poisson=NU)
    lengths = np.diff(NELSON_MCVAUGH.stations) / 1e3
    shaft = [
        ross.ShaftElement(L=float(length), idl=bore / 1e3, odl=outer / 1e3, material=steel, n=k)
        for k, (length, outer, bore) in enumerate(
            zip(lengths, NELSON_MCVAUGH.outer, NELSON_MCVAUGH.bore, strict=True)
        )
    ]
    discs = [
        ross.DiskElement(n=n, m=m, Ip=polar, Id=across)
        for n, m, polar, across in NELSON_MCVAUGH.discs
    ]
    bearings = [
        ross.BearingElement(n=n, kxx=NELSON_MCVAUGH.stiffness, cxx=0.0)
        for n in NELSON_MCVAUGH.bearings
    ]
    theirs = ross.Rotor(shaft, discs, bearings)
    own = NELSON_MCVAUGH.rotor("timoshenko")
    for speed in (1000.0, 8000.0):
        modes = whirl_modes(own, speed, 6).values.imag
        values = np.linalg.eigvals(np.asarray(theirs.A(speed))).imag
        for mode in modes:
            assert np.abs(values / mode - 1).min() < 1e-9


@pytest.mark.needs("exudyn")
def test_exudyn_precesses_with_these_frequencies() -> None:
    """A spinning rigid body of Exudyn on two springs: nothing is left of its motion beside both."""
    import exudyn
    from exudyn import utilities

    mass, polar, across, k, arm, speed = 5.0, 0.08, 0.05, 2e5, 0.2, 300.0
    container = exudyn.SystemContainer()
    system = container.AddSystem()
    body = system.CreateRigidBody(
        inertia=utilities.RigidBodyInertia(mass, np.diag([polar, across, across])),
        initialAngularVelocity=[speed, 0.0, 1e-3],
    )
    ground = system.CreateGround()
    for x in (-arm, arm):
        system.CreateCartesianSpringDamper(
            itemNumbers=[ground, body],
            localPosition0=[x, 0.0, 0.0],
            localPosition1=[x, 0.0, 0.0],
            stiffness=[k, k, k],
            damping=[0.0, 0.0, 0.0],
        )
    sensor = system.AddSensor(
        utilities.SensorBody(
            bodyNumber=body,
            localPosition=[arm, 0.0, 0.0],
            storeInternal=True,
            outputVariableType=exudyn.OutputVariableType.Position,
        )
    )
    system.Assemble()
    settings = exudyn.SimulationSettings()
    settings.timeIntegration.endTime = 0.5
    settings.timeIntegration.numberOfSteps = 50000
    settings.solution.sensors.writePeriod = 1e-4
    settings.solution.file.write = False
    settings.timeIntegration.verboseMode = 0
    system.SolveDynamic(settings)
    t, _, y, z = system.GetSensorStoredData(sensor).T
    own = bearing_of("springs", 0, np.diag([0, 2 * k, 2 * k, 0, 2 * k * arm**2, 2 * k * arm**2]))
    rotor = rotor_of("body", [], [Disc(0, mass, polar, across)], [own])
    modes = whirl_modes(rotor, speed)
    tilts = np.argsort(np.abs(modes.frequencies - np.sqrt(2 * k / mass) / (2 * np.pi)))[2:]
    whirl = y + 1j * z
    turning = np.sign(modes.senses[tilts]) * modes.values.imag[tilts]
    basis = np.exp(1j * np.outer(t, turning))
    left = whirl - basis @ np.linalg.lstsq(basis, whirl, rcond=None)[0]
    assert np.abs(whirl).max() > 1e-7
    assert np.abs(left).max() < 2e-3 * np.abs(whirl).max()
    shifted = np.exp(1j * np.outer(t, 1.01 * turning))
    worse = whirl - shifted @ np.linalg.lstsq(shifted, whirl, rcond=None)[0]
    assert np.abs(worse).max() > 10 * np.abs(left).max()


def test_a_condensed_rotor_is_stiffer_and_with_all_modes_the_rotor() -> None:
    whole = NELSON_MCVAUGH.rotor("timoshenko", 2)
    exact = criticals_rpm(whole, 1)
    before = np.full(len(exact), np.inf)
    for modes in (0, 2, 4, 8, 16):
        rotor = condensed_rotor(whole, modes)
        assert len(rotor.mass) == 2 * 2 + modes
        found = criticals_rpm(rotor, 1)[: len(exact)]
        # of whirl with the speed, by Rayleigh and Ritz, from above
        assert (found >= exact[: len(found)] * (1.0 - 1e-9)).all()
        assert (found <= before[: len(found)] * (1.0 + 1e-9)).all()
        before[: len(found)] = found
    assert before == pytest.approx(exact, rel=1e-3)
    everything = condensed_rotor(whole, 1000)
    assert len(everything.mass) == len(whole.mass)
    assert criticals_rpm(everything, 1) == pytest.approx(exact, rel=1e-8)


def test_condensing_keeps_what_moves_as_a_rigid_body() -> None:
    whole = NELSON_MCVAUGH.rotor("timoshenko")
    one, other = rigid_rotor(whole), rigid_rotor(condensed_rotor(whole))
    # the second begins at its first bearing: mass alone is the same
    assert other.mass[0, 0] == pytest.approx(one.mass[0, 0], rel=1e-9)
