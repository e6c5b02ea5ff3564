"""Strength of a shaft: printed solutions, exact stresses, statics, Miner's sums, joints."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fe_drivetrain.cases.references.plane_rings import Lame, Plane, interference_pressure
from fe_drivetrain.common.components import GRAVITY
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.materials import MATERIALS
from fe_drivetrain.drivetrain_file.reading import change_scene, library_scene
from fe_drivetrain.shafts.strength.din743 import (
    NotchEffect,
    SteelData,
    combined_safety,
    endured_amplitudes,
    equivalent_mean,
    geometric_size_factor,
    roughness_factor,
    section_strength,
    size_factor,
)
from fe_drivetrain.shafts.strength.fatigue import (
    AS_IT_IS,
    BETWEEN,
    FACTORS,
    MISSED,
    Rule,
    damage_of_point,
    damage_of_torque,
    safety_of_damage,
    turning_stress,
)
from fe_drivetrain.shafts.strength.fillet_stress import LOADS, Shoulder, fillet_factor, fillet_peak
from fe_drivetrain.shafts.strength.joints import flange_safety, press_pressure, press_safety
from fe_drivetrain.shafts.strength.local_stress import fkm_safety, fkm_support, mean_factor
from fe_drivetrain.shafts.strength.notches import (
    hole_effect,
    measured_effect,
    moduli,
    turned_factors,
    turned_gradients,
)
from fe_drivetrain.shafts.strength.rated import rated_section
from fe_drivetrain.shafts.strength.section_loads import section_loads
from fe_drivetrain.shafts.strength.sections import ShaftSection, shaft_sections

STEEL = SteelData("quenched and tempered", 1000e6, 800e6, (400e6, 500e6, 300e6), None, 5e-6)
PLAIN = NotchEffect(np.ones(3), np.ones(3), turned=False)
SCENE = "three_point_suspension"


@pytest.mark.parametrize("steel", ["quenched and tempered", "case-hardened", "structural"])
@pytest.mark.parametrize("of_yield", [False, True])
def test_size_factors_fall_without_a_jump_to_their_end(steel: str, of_yield: bool) -> None:
    """To the two digits that the standard prints of the value at the end."""
    d = np.geomspace(0.005, 0.6, 400)
    K = np.array([size_factor(steel, x, of_yield) for x in d])
    assert K[0] == 1.0
    assert (np.diff(K) <= 0.011).all()
    assert np.abs(np.diff(K)).max() < 0.03


def test_a_geometric_size_factor_is_one_of_a_specimen_and_ends_at_150_mm() -> None:
    assert geometric_size_factor(7.5e-3) == 1.0
    assert geometric_size_factor(0.15) == pytest.approx(0.8)
    assert geometric_size_factor(2.0) == geometric_size_factor(0.15)


def test_the_surface_factor_is_that_of_a_public_example() -> None:
    """Quadco: R_m 600 MPa, R_z 100 um: 0.79; smooth surfaces take nothing."""
    assert roughness_factor(100e-6, 600e6) == pytest.approx(0.79, abs=5e-3)
    assert roughness_factor(0.5e-6, 600e6) == 1.0


def test_mean_stress_takes_what_statics_leaves() -> None:
    """At the yield point nothing is left; without a mean stress all; between, less and less."""
    strength = section_strength(STEEL, 0.1, PLAIN, 0.1)
    unit = np.array([0.0, 1.0, 0.0])
    for case in (1, 2):
        means = np.linspace(0.0, float(strength.yields[1]), 30)
        left = [endured_amplitudes(strength, 1e6 * unit, m, case)[1] for m in means]
        assert left[0] == pytest.approx(strength.reversed[1])
        assert (np.diff(left) < 0.0).all()
    assert endured_amplitudes(strength, unit, strength.yields[1], 1)[1] == pytest.approx(0.0)


def test_both_cases_of_mean_stress_meet_where_loads_just_bring_failure() -> None:
    """Amplitude and mean at the limit are one point of the diagram, whichever way it is reached."""
    strength = section_strength(STEEL, 0.1, PLAIN, 0.1)
    for mean in (50e6, 200e6, 500e6):
        amplitude = endured_amplitudes(strength, np.ones(3), mean, 1)
        again = endured_amplitudes(strength, amplitude, mean, 2)
        np.testing.assert_allclose(again[:2], amplitude[:2], rtol=1e-12)


def test_stresses_that_act_together_add_as_the_standard_says() -> None:
    endured = np.array([100.0, 200.0, 50.0])
    assert combined_safety(np.array([0.0, 100.0, 0.0]), endured) == pytest.approx(2.0)
    assert combined_safety(np.array([50.0, 100.0, 0.0]), endured) == pytest.approx(1.0)
    assert combined_safety(np.array([0.0, 100.0, 25.0]), endured) == pytest.approx(2.0**0.5)
    assert combined_safety(np.zeros(3), endured) == np.inf
    assert equivalent_mean(0.0, 0.0, 10.0) == pytest.approx(10.0 * 3**0.5)
    assert equivalent_mean(-30.0, 0.0, 10.0) == 0.0


def test_moduli_of_a_tube_are_those_of_its_cylinders() -> None:
    d, b = 0.4, 0.25
    outer, inner = moduli(d), moduli(b)
    found = moduli(d, b)
    assert found[0] == pytest.approx(outer[0] - inner[0])
    assert found[1] * d == pytest.approx(outer[1] * d - inner[1] * b)
    assert found[2] == pytest.approx(2.0 * found[1])


@pytest.mark.parametrize("kind", ["shoulder", "groove"])
def test_formulas_of_notches_fall_with_the_radius_to_no_notch(kind: str) -> None:
    factors = np.array([turned_factors(kind, 0.1, 0.01, r) for r in np.geomspace(1e-4, 10.0, 30)])
    assert (np.diff(factors, axis=0) < 0.0).all()
    np.testing.assert_allclose(factors[-1], 1.0, atol=0.01)


def test_measured_notches_do_not_depend_on_the_size_beyond_150_mm() -> None:
    for kind in ("press fit", "keyway", "two keyways"):
        near, far = (measured_effect(kind, d, 800e6) for d in (0.15, 0.9))
        np.testing.assert_allclose(near.beta, far.beta)
    one, two = (measured_effect(kind, 0.1, 800e6).beta for kind in ("keyway", "two keyways"))
    assert (two > one).all()
    small = hole_effect(0.2, 1e-6, 600e6, False).alpha
    np.testing.assert_allclose(small[:2], 3.0, atol=0.02)  # Kirsch's 3 of a small hole


@pytest.mark.parametrize("load", LOADS)
def test_a_fillet_does_not_know_its_size(load: str) -> None:
    """Factors are of shapes; slopes go with one over the length."""
    small = Shoulder(1.0, 1.3, 0.05, 0.4, 0.4)
    large = Shoulder(0.6, 0.78, 0.03, 0.24, 0.24)
    one, two = (fillet_peak(load, of) for of in (small, large))
    assert two.factor == pytest.approx(one.factor, rel=1e-9)
    assert two.gradient == pytest.approx(one.gradient / 0.6, rel=1e-6)


@pytest.mark.parametrize("load", LOADS)
def test_a_thin_bore_changes_little_and_a_wide_one_much(load: str) -> None:
    solid, thin, wide = (
        fillet_factor(load, Shoulder(1.0, 1.2, 0.05, b, b)) for b in (0.0, 0.05, 0.9)
    )
    assert thin.peak.factor == pytest.approx(solid.peak.factor, rel=0.01)
    assert abs(wide.peak.factor / solid.peak.factor - 1.0) > 0.03
    assert wide.band < 0.01 * wide.peak.factor


def test_the_stress_at_a_sharp_fillet_falls_as_at_any_notch() -> None:
    """Its relative slope is near 2 over the radius in tension, 1 in torsion (Neuber)."""
    r = 0.01
    slopes = {load: fillet_peak(load, Shoulder(1.0, 1.3, r)).gradient * r for load in LOADS}
    assert slopes["tension"] == pytest.approx(2.0, abs=0.35)
    assert slopes["bending"] == pytest.approx(2.0, abs=0.35)
    assert slopes["torsion"] == pytest.approx(1.0, abs=0.15)
    formula = turned_gradients("shoulder", 1.0, 0.15, r) * r
    assert (np.array([*slopes.values()]) < formula).all()


def test_fillets_far_smaller_than_the_shaft_keep_the_order_of_the_corner() -> None:
    """In torsion the stress grows as the radius to -1/3 (Williams 1952)."""
    small, tiny = (fillet_peak("torsion", Shoulder(1.0, 1.2, r)).factor for r in (1e-4, 1e-5))
    assert tiny / small == pytest.approx(10.0 ** (1.0 / 3.0), rel=2e-3)


def test_internal_forces_are_those_of_the_loads_in_front() -> None:
    """In front of all bearings statics alone has them; behind the rear face nothing is left."""
    scene = library_scene(SCENE)
    density = scene.material_of("shaft").density
    x = -0.5
    found = section_loads(scene, [scene.shaft.front + 1e-9, x])
    assert found.imbalance < 1e-10
    loads = np.array([[1e5, 2e4, -4e5, 1e6, 3e5, -2e5]])
    at = found.at(1, loads)[0]
    arm = x - scene.shaft.front
    disc = 0.25 * np.pi * 1.2**2 * 0.14
    tube = 0.25 * np.pi * 0.68**2 * (arm - 0.14)
    weight = GRAVITY * density * np.array([disc, tube])
    to = np.array([arm - 0.07, (arm - 0.14) / 2])
    assert at[:2] == pytest.approx([1e5, 2e4])
    assert at[2] == pytest.approx(-4e5 - weight.sum())
    assert at[3] == pytest.approx(1e6)
    # a force up at an arm in front of the section turns it about +y: M_y = M + a F
    assert at[4] == pytest.approx(3e5 + arm * -4e5 - weight @ to)
    assert at[5] == pytest.approx(-2e5 - arm * 2e4)


def test_weight_that_hangs_in_front_pulls_the_top_of_the_shaft() -> None:
    scene = library_scene(SCENE)
    forces = section_loads(scene, [-0.2]).at(0, np.array([[0, 0, -4e5, 0, 0, 0.0]]))
    stress = turning_stress(forces, moduli(0.6), np.zeros(1))
    top, side, below = (float(stress.of_point(a)[0]) for a in (0.5 * np.pi, 0.0, -0.5 * np.pi))
    assert top > 0.0
    assert below == pytest.approx(-top)
    assert side == pytest.approx(0.0, abs=1e-6 * top)


def test_soft_bearings_do_not_change_what_statics_decides() -> None:
    scene = change_scene(library_scene(SCENE), {"gearbox.stiffness": [0, 8e7, 8e7, 8e7, 0, 0]})
    rigid = section_loads(scene, [-0.2, 0.5])
    soft = section_loads(scene, [-0.2, 0.5], {"main_bearing": np.diag([1e6] * 3 + [0.0] * 3)})
    np.testing.assert_allclose(soft.unit, rigid.unit, atol=1e-9)


def _turning(turns: float, bent: float, torque: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    n = int(72 * turns) + 1
    forces = np.zeros((n, 6))
    forces[:, 4], forces[:, 3] = -bent, torque
    return forces, np.linspace(0.0, 2.0 * np.pi * turns, n)


@pytest.mark.parametrize("case", [1, 2])
@pytest.mark.parametrize("place", [0.0, 1.0, 3.0])
def test_each_turn_of_a_bent_shaft_is_one_cycle(case: int, place: float) -> None:
    """A moment that stays, knee cycles of it: the safety is what is endured over what acts."""
    d = 0.5
    strength = section_strength(STEEL, d, PLAIN, d)
    forces, angle = _turning(200, 1e6, 5e5)
    stress = turning_stress(forces, moduli(d), angle)
    rule = Rule(case=case, knee=1e6)
    damage = damage_of_point(stress, strength, rule, place) * (rule.knee / 200)
    bent, shear = 1e6 / moduli(d)[1], 5e5 / moduli(d)[2]
    acting = np.array([0.0, bent, 0.0])
    endured = endured_amplitudes(strength, acting, equivalent_mean(0.0, 0.0, shear), case)
    expected = endured[1] / bent
    # half a cycle at each end of 200, to the power 1/5, and a sample beside the peak
    assert safety_of_damage(damage) == pytest.approx(expected, rel=2e-3 + BETWEEN)
    assert not damage_of_torque(stress, strength, rule).any()


def test_damage_follows_both_slopes_of_the_curve() -> None:
    """Twice the load is 2^5 above the knee, 2^9 below it by Haibach."""
    strength = section_strength(STEEL, 0.5, PLAIN, 0.5)
    forces, angle = _turning(50, 1e6)
    stress = turning_stress(forces, moduli(0.5), angle)
    damage = damage_of_point(stress, strength, Rule(case=1), 0.0)
    slope = np.diff(np.log(damage)) / np.diff(np.log(FACTORS))
    assert slope[0] == pytest.approx(9.0, rel=1e-6)
    assert slope[-1] == pytest.approx(5.0, rel=1e-6)
    assert FACTORS[AS_IT_IS] == 1.0


def test_coarse_samples_of_a_turning_shaft_are_refined() -> None:
    """Samples 60 deg apart would miss peaks of a moment that stays; their chord is filled in."""
    d, turns = 0.5, 60
    strength = section_strength(STEEL, d, PLAIN, d)
    found = []
    for per_turn in (6, 360):
        n = per_turn * turns + 1
        forces = np.zeros((n, 6))
        forces[:, 4] = -1e6
        stress = turning_stress(forces, moduli(d), np.linspace(0.0, 2 * np.pi * turns, n))
        found.append(safety_of_damage(damage_of_point(stress, strength, Rule(), 0.3) * 1e4))
    assert found[0] == pytest.approx(found[1], rel=MISSED + 1e-3)


def test_a_shaft_that_stands_is_not_tired_by_a_load_that_stays() -> None:
    strength = section_strength(STEEL, 0.5, PLAIN, 0.5)
    forces, angle = _turning(10, 1e6)
    stress = turning_stress(forces, moduli(0.5), 0.0 * angle)
    damage = damage_of_point(stress, strength, Rule(), 0.0)
    assert not damage.any()
    assert safety_of_damage(damage) == np.inf


def test_a_flange_slips_and_opens_where_statics_says() -> None:
    """At the load that just slips, friction of all bolts; at that which opens, one bolt's pull."""
    count, circle, preload, mu = 40, 1.0, 3e5, 0.15
    torque = mu * count * preload * circle / 2
    moment = preload * count * circle / 4
    forces = np.zeros((3, 6))
    forces[0, 3], forces[1, 4], forces[2, 0] = torque, moment, -count * preload
    found = flange_safety(forces, count, circle, preload, mu)
    assert found.slip[0] == pytest.approx(1.0)
    assert found.opening == pytest.approx([np.inf, 1.0, 1.0])
    # the linear forces of the ring have the moment that they carry
    angles = 2 * np.pi * np.arange(count) / count
    pulls = 4 * moment / (count * circle) * np.sin(angles)
    assert pulls @ (0.5 * circle * np.sin(angles)) == pytest.approx(moment)


@pytest.mark.parametrize("bore", [0.0, 0.12])
def test_the_pressure_of_a_press_fit_closes_lames_misfit(bore: float) -> None:
    plane = Plane(2.1e11, 0.3)
    shaft, ring = Lame(bore / 2, 0.2), Lame(0.2, 0.35)
    expected = interference_pressure(1e-4, shaft, ring, plane, plane)
    assert press_pressure(0.4, bore, 0.7, 2e-4, (2.1e11, 0.3)) == pytest.approx(expected)
    with pytest.raises(InputError, match="must each be less"):
        press_pressure(0.4, bore, 0.4, 2e-4, (2.1e11, 0.3))


def test_a_press_fit_holds_torque_and_axial_force_by_one_friction() -> None:
    d, length, p, mu = 0.4, 0.3, 80e6, 0.12
    holds = mu * p * np.pi * d * length
    forces = np.zeros((3, 6))
    forces[0, 3], forces[1, 0] = holds * d / 2, holds
    forces[2, [0, 3]] = holds / 2**0.5, holds * d / 2 / 2**0.5
    np.testing.assert_allclose(press_safety(forces, d, length, p, mu).slip, 1.0)


def test_the_second_way_has_its_limits() -> None:
    """No gradient and a smooth surface leave 0.45 R_m; a mean stress takes from it, pressure no."""
    smooth = SteelData("quenched and tempered", 800e6, 600e6, (0.0, 0.0, 0.0), None, 1e-7)
    still = fkm_safety(smooth, 800e6, (36e6, 0.0), (0.0, 0.0), (0.0, 0.0))
    assert still == pytest.approx(10.0)
    assert fkm_safety(smooth, 800e6, (36e6, 0.0), (36e6, 0.0), (0.0, 0.0)) < still
    assert fkm_safety(smooth, 800e6, (0.0, 0.0), (0.0, 0.0), (0.0, 0.0)) == np.inf
    for edge in (100.0, 1000.0):  # the pieces of n meet, to what the guideline's digits leave
        below, above = (fkm_support(edge * s, 800e6) for s in (0.999, 1.001))
        assert below == pytest.approx(above, rel=1e-3)
    for t in (-1.0, 1.0, 3.0):
        assert mean_factor(t - 1e-9, 0.2) == pytest.approx(mean_factor(t + 1e-9, 0.2), rel=1e-6)


def test_sections_are_those_that_the_file_states() -> None:
    """Steps without a fillet are named and not rated; seats of bearings are where they end."""
    strength = {"steel": "structural", "tensile_strength": 6e8, "yield_strength": 4e8}
    lock = {"name": "lock", "x": 1.3, "kind": "groove", "radius": 0.01, "depth": 0.02}
    scene = change_scene(
        library_scene(SCENE),
        {"strength": {**strength, "notches": [lock]}, "shaft.sections.0.fillet": 0.03},
    )
    assert scene.strength is not None
    sections, left_out = shaft_sections(scene, scene.strength)
    kinds = [one.kind for one in sections]
    assert kinds.count("shoulder") == 2  # the flange's foot, and the one with a fillet
    assert list(left_out) == ["step at x = 0.15 m"]
    assert [one.x for one in sections if one.kind == "press fit"] == pytest.approx([-0.1, 0.1])
    (groove,) = (one for one in sections if one.kind == "groove")
    assert groove.raw - groove.diameter == pytest.approx(0.04)
    assert [one.x for one in sections] == sorted(one.x for one in sections)


LOCK = {"name": "a", "x": 1.0, "kind": "groove", "radius": 0.1}
HUB = {"name": "a", "x": 1.4, "length": 0.2, "hub_diameter": 0.4, "interference": 1e-4}


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"yield_strength": 7e8}, "must be at most the tensile_strength"),
        ({"notches": [{"name": "a", "x": 9.0, "kind": "keyway"}]}, "must be on the shaft"),
        ({"notches": [{"name": "a", "x": 1.0, "kind": "keyway", "radius": 0.1}]}, "needs none"),
        ({"notches": [LOCK]}, "radius and depth"),
        ({"notches": [{**LOCK, "kind": "hole", "radius": 0.5}]}, "make it smaller"),
        ({"flange": {"count": 40, "circle": 1.3, "preload": 1e5}}, "less than the front face"),
        ({"press_fits": [HUB]}, "must be wider than the seat"),
    ],
)
def test_what_cannot_be_is_refused_in_a_sentence(change: dict[str, object], message: str) -> None:
    good = {"steel": "structural", "tensile_strength": 6e8, "yield_strength": 4e8}
    with pytest.raises(InputError, match=message):
        change_scene(library_scene(SCENE), {"strength": {**good, **change}})


def test_a_hole_through_a_tube_takes_a_strip_of_its_wall() -> None:
    """Second moment of the strip by quadrature, over the outer radius."""
    d, b, r = 0.4, 0.25, 0.01
    y = np.linspace(b / 2, d / 2, 20001)
    strip = 2.0 * np.trapezoid(2.0 * r * y**2, y) / (d / 2)
    lost = moduli(d, b) - moduli(d, b, r)
    assert lost == pytest.approx(np.array([2.0 * r * (d - b), strip, strip]), rel=1e-6)


def test_formulas_of_solid_shafts_are_named_where_the_shaft_is_bored() -> None:
    groove = ShaftSection("groove", 1.0, "groove", 0.4, 0.2, 0.44, 0.02, 0.01)
    shoulder = ShaftSection("step", 1.0, "shoulder", 0.4, 0.2, 0.5, 0.05, 0.02)
    solid = replace(groove, bore=0.0)
    plain = replace(groove, kind="plain", depth=0.0, radius=0.0)
    steels = next(iter(MATERIALS.values()))
    assert rated_section(groove, STEEL, steels).of_solid
    assert rated_section(shoulder, STEEL, steels, elastic=False).of_solid
    assert not rated_section(solid, STEEL, steels).of_solid
    assert not rated_section(plain, STEEL, steels).of_solid
