"""The exact answers of the joint between spherical shells: Navier, known limits, and the joints."""

import numpy as np
import pytest

from fe_drivetrain.cases.verification.spherical_shells import (
    AXIS,
    JOINTS,
    Shell,
    Wave,
    amplitudes,
    core_stiffness,
    displaced_core,
    force,
    mesh_of,
    move_core,
    squeezed,
    turning_stiffness,
)

LAME = (1.2e11, 0.8e11)
INNER = Shell(0.2, 0.3, LAME)
OUTER = Shell(0.3, 0.41, (0.7e11, 0.6e11))


def derivative(field, x, i, h=2e-4):
    """Central difference of fourth order along axis i."""
    e = h * np.eye(3)[i]
    near, far = field(x + e) - field(x - e), field(x + 2 * e) - field(x - 2 * e)
    return (8 * near - far) / (12 * h)


@pytest.mark.parametrize("power", range(4))
def test_each_wave_fulfils_navier(power, rng):
    """(lambda + mu) grad div u + mu laplace u = 0, by finite differences in x, y, z."""
    wave = Wave(INNER, np.eye(4)[power])
    x = rng.standard_normal((20, 3))
    x *= (rng.uniform(0.22, 0.28, 20) / np.linalg.norm(x, axis=1))[:, None]
    lam, mu = LAME

    def gradient(x):
        return np.stack([derivative(wave.displacement, x, i) for i in range(3)], axis=-1)

    def stress(x):
        G = gradient(x)
        return lam * np.trace(G, axis1=1, axis2=2)[:, None, None] * np.eye(3) + mu * (
            G + G.transpose(0, 2, 1)
        )

    balance = sum(derivative(stress, x, i)[:, :, i] for i in range(3))
    size = max(np.abs(derivative(stress, x, i)).max() for i in range(3))
    # A term alone is of the size of E u / r^2; a translation has no stress at all.
    size = max(size, 1e-3 * mu / 0.25**2)
    assert np.abs(balance).max() < 1e-5 * size

    # the stresses of `amplitudes` are those of the field
    s, e = stress(x), x / np.linalg.norm(x, axis=1)[:, None]
    traction = np.einsum("nij,nj->ni", s, e)
    _, _, radial, shear = amplitudes(INNER, np.linalg.norm(x, axis=1))[:, power]
    normal = np.einsum("ni,ni->n", traction, e)
    scale = mu / 0.25
    np.testing.assert_allclose(normal, radial * e[:, 0], atol=1e-6 * scale)
    # e_theta sin(theta) = cos(theta) e_r - e_x
    along = shear[:, None] * (e[:, [0]] * e - np.array([1.0, 0.0, 0.0]))
    np.testing.assert_allclose(traction - normal[:, None] * e, along, atol=1e-6 * scale)


def test_rigid_sphere_in_an_infinite_solid():
    """24 pi mu (1 - nu) a / (5 - 6 nu): a rigid sphere bonded to an infinite solid (Kelvin)."""
    lam, mu = LAME
    nu = 0.5 * lam / (lam + mu)
    core = 0.2
    middle, far = 0.5, 2e5
    shells = Shell(core, middle, LAME), Shell(middle, far, LAME)
    exact = 24 * np.pi * mu * (1 - nu) * core / (5 - 6 * nu)
    # what is fixed at a distance b stiffens by about a / b = 1e-6
    assert core_stiffness(*shells, "bonded") == pytest.approx(exact, rel=1e-5)


def test_bonded_shells_of_one_material_are_one_shell():
    whole = core_stiffness(Shell(0.2, 0.25, LAME), Shell(0.25, 0.41, LAME), "bonded")
    assert core_stiffness(Shell(0.2, 0.3, LAME), Shell(0.3, 0.41, LAME), "bonded") == pytest.approx(
        whole, rel=1e-10
    )


@pytest.mark.parametrize("joint", JOINTS)
def test_the_force_is_the_same_on_every_sphere(joint):
    first, second = displaced_core(INNER, OUTER, joint)
    forces = [force(first, r) for r in (0.2, 0.25, 0.3)] + [force(second, r) for r in (0.3, 0.41)]
    np.testing.assert_allclose(forces, forces[0], rtol=1e-9)


def test_joints_that_constrain_more_are_stiffer():
    """Rigid faces also slide and keep equal means; bonded ones slide with more constraints."""
    k = {joint: core_stiffness(INNER, OUTER, joint) for joint in JOINTS}
    assert k["sliding"] < k["rigid"]
    assert k["averaged"] < k["rigid"]
    assert k["sliding"] < k["bonded"]


def test_pressure_is_carried_through_both_shells():
    """Equilibrium and Hooke's law of each shell, from the radial displacement alone."""
    found = squeezed(INNER, OUTER, 1e6)

    def stress(shell, factors, r):
        a, b = factors
        lam, mu = shell.lame
        return 3 * lam * a + 2 * mu * (a - 2 * b / r**3)

    assert stress(OUTER, found.outer, OUTER.outer) == pytest.approx(-1e6, rel=1e-9)
    assert stress(OUTER, found.outer, OUTER.inner) == pytest.approx(-found.contact, rel=1e-9)
    assert stress(INNER, found.inner, INNER.outer) == pytest.approx(-found.contact, rel=1e-9)
    a, b = found.inner
    assert abs(a * INNER.inner + b / INNER.inner**2) < 1e-12 * abs(a)


@pytest.mark.parametrize("joint", JOINTS)
def test_finite_elements_near_the_exact_answer(joint):
    """Two elements a quarter turn: (h/2)^4 of 45 degrees is 2.4 %."""
    mesh = mesh_of(INNER, OUTER, 2, 1, bonded=joint == "bonded")
    moved = move_core(mesh, (INNER, OUTER), joint)
    assert moved.stiffness == pytest.approx(core_stiffness(INNER, OUTER, joint), rel=0.024)
    assert moved.across < 1e-9
    turn = turning_stiffness(INNER, OUTER)
    if joint == "bonded":
        np.testing.assert_allclose(moved.moments, turn * AXIS, atol=0.024 * turn)
    else:
        assert np.abs(moved.moments).max() < 1e-9 * turn
