"""Slices of teeth: what stiffness, balance and symmetry leave no choice about."""

from dataclasses import replace
from math import cos, pi, radians, sin, tan

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.gear.coupled_slices import Coupling, loaded_with_coupling
from fe_drivetrain.gear.energy import yang_sun_contact
from fe_drivetrain.gear.involute import Gear, Pair, meshing_without_backlash
from fe_drivetrain.gear.load_distribution import even_phases, loaded, over_period, supported
from fe_drivetrain.gear.load_factors import face_factor
from fe_drivetrain.gear.pair_stiffness import constant_law, parabolic_law
from fe_drivetrain.gear.slices import (
    Modifications,
    SlicedMesh,
    contact_rows,
    contacts,
)

C = 14e9
MODULE = 0.008
TORQUE = 5e3
PLAY = 0.5e-3


def pair(helix: float = 0.0, overlap: float | None = None, ring: bool = False) -> Pair:
    """Spur or helical, of a face width that gives an overlap."""
    width = 0.1 if overlap is None else overlap * pi * MODULE / abs(sin(helix))
    first = Gear(23, MODULE, width, helix, 0.4 if ring else 0.1)
    second = Gear(-97, MODULE, width, helix, 0.5) if ring else Gear(71, MODULE, width, -helix, 0.0)
    return meshing_without_backlash(first, second)


SPUR, RING = pair(), pair(ring=True)
HELICAL = pair(radians(12.0), 1.0)
KINDS = {"spur": SPUR, "ring": RING, "helical": HELICAL, "left": pair(radians(-12.0), 1.0)}


def sliced(of: Pair, ratio: float = 0.8, **more) -> SlicedMesh:
    return SlicedMesh(of, parabolic_law(of, ratio, C), backlash=PLAY, **more)


def total_stiffness(mesh: SlicedMesh, phases: int) -> np.ndarray:
    at = (np.arange(phases) + 0.5) / phases
    found = (contacts(mesh, phase) for phase in at)
    return np.array([c.stiffness[c.driving].sum() for c in found]) / mesh.pair.face_width


def test_stiffness_of_a_pair_of_teeth_has_its_bounds() -> None:
    path = SPUR.path
    k = parabolic_law(SPUR, 0.8, C)
    places = np.linspace(path.start, path.end, 101)
    assert (k(places) <= C).all()
    assert k(places).min() == pytest.approx(0.8 * C)
    assert k(np.array([path.pitch]))[0] == C


@pytest.mark.parametrize("kind", KINDS)
def test_mean_of_the_mesh_stiffness_is_that_of_the_closed_form(kind: str) -> None:
    of = KINDS[kind]
    path, pitch = of.path, of.first.base_pitch
    s1, s2 = path.start - path.pitch, path.end - path.pitch
    S = max(-s1, s2)
    exact = C * ((s2 - s1) / pitch - 0.2 * (s2**3 - s1**3) / (3.0 * S**2 * pitch))
    found = total_stiffness(sliced(of, slices=1), 500)
    assert found.mean() == pytest.approx(exact, rel=2e-3)


def test_a_whole_overlap_makes_the_stiffness_constant_as_slices_get_thin() -> None:
    ripple = []
    for slices in (5, 10, 35, 140):
        k = total_stiffness(sliced(HELICAL, slices=slices), 97)
        ripple.append(np.ptp(k) / k.mean())
    assert ripple[2] < 0.02
    assert ripple[0] > ripple[1] > ripple[2] > ripple[3]
    # one slice comes or goes at a time: first order
    assert ripple[0] / ripple[2] == pytest.approx(7.0, rel=0.25)
    half = pair(radians(12.0), 0.5)
    k = total_stiffness(sliced(half, slices=140), 97)
    assert np.ptp(k) / k.mean() > 0.1


@pytest.mark.parametrize("of", [SPUR, RING], ids=["external", "internal"])
def test_aligned_spur_gears_load_slices_equally_without_tilting(of: Pair) -> None:
    found = loaded(sliced(of), 0.3, TORQUE)
    over = found.over_face
    assert over == pytest.approx(np.full(35, over.mean()), rel=1e-13)
    assert over.sum() == pytest.approx(TORQUE / of.first.base_radius, rel=1e-13)
    assert found.face_factor == pytest.approx(1.0)
    assert np.abs(found.wrench[[4, 5, 10, 11]]).max() < 1e-9 * TORQUE
    assert found.converged


def test_mean_over_a_period_of_aligned_helical_gears_is_even() -> None:
    period = over_period(sliced(HELICAL, 1.0), TORQUE, phases=70)
    assert period.face_factor == pytest.approx(1.0, abs=0.03)
    assert period.over_face.sum(axis=1) == pytest.approx(
        np.full(70, TORQUE / HELICAL.first.base_radius), rel=1e-12
    )


@pytest.mark.parametrize("ratio", [1.4627260609736992, 1.2, 1.71])
def test_slices_are_in_contact_equally_often_wherever_they_begin(ratio: float) -> None:
    n = even_phases(ratio, 128, 256)
    phases = (np.arange(8 * n) + 0.5) / n  # of eight periods
    begins = np.linspace(2.0, 3.0, 560, endpoint=False)
    counts = [np.count_nonzero((phases >= b) & (phases < b + ratio)) for b in begins]
    # another number of phases gives one more to a good share of the slices
    share_of_most = np.mean(np.array(counts) == np.bincount(counts).argmax())
    assert share_of_most > 0.95
    other = [np.count_nonzero(((p := phases * n / (n + 3)) >= b) & (p < b + ratio)) for b in begins]
    assert np.mean(np.array(other) == np.bincount(other).argmax()) < share_of_most


@pytest.mark.parametrize("slices", [5, 9])
@pytest.mark.parametrize("torque", [0.1 * TORQUE, -TORQUE], ids=["light", "reversed"])
@pytest.mark.parametrize("kind", ["spur", "ring", "left"])
def test_twice_the_phases_stay_within_the_band(kind: str, torque: float, slices: int) -> None:
    mesh = sliced(KINDS[kind], slices=slices, modifications=Modifications(slope=5e-5))
    period = over_period(mesh, torque)
    more = over_period(mesh, torque, phases=2 * len(period.phases))
    moved = abs(more.face_factor - period.face_factor)
    assert moved < period.face_factor_band < 0.03 * period.face_factor
    # a band of fewer phases is wider, and still holds
    few = over_period(mesh, torque, phases=32)
    assert period.face_factor_band < 0.5 * few.face_factor_band
    assert abs(more.face_factor - few.face_factor) < few.face_factor_band


def test_loads_that_do_not_change_over_the_period_have_no_band() -> None:
    assert over_period(sliced(SPUR), TORQUE).face_factor_band < 1e-12
    assert over_period(sliced(SPUR, slices=1), TORQUE).face_factor_band == 0.0


@pytest.mark.parametrize(("least", "most"), [(0, 4), (8, 8)])
def test_ranges_without_phases_are_refused(least: int, most: int) -> None:
    with pytest.raises(InputError, match="give a least above 0"):
        even_phases(1.5, least, most)
    with pytest.raises(InputError, match="give at least 1"):
        over_period(sliced(SPUR), TORQUE, phases=0)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("torque", [TORQUE, -TORQUE], ids=["driving", "reversed"])
def test_wrenches_balance_and_the_torque_is_carried(kind: str, torque: float) -> None:
    of = KINDS[kind]
    size = np.tile([1e-6, 1e-6, 1e-6, 0.0, 2e-4, 2e-4], 2)
    tilts = np.random.default_rng(3).normal(size=12) * size
    found = loaded(sliced(of), 0.7, torque, tilts)
    w = found.wrench
    assert w[3] == pytest.approx(-torque, rel=1e-12)
    assert w[:3] + w[6:9] == pytest.approx(np.zeros(3), abs=1e-9 * abs(w[:3]).max())
    second = np.array([0.0, of.second.sign * of.centre_distance, 0.0])
    moment = w[3:6] + w[9:] + np.cross(second, w[6:9])
    assert moment == pytest.approx(np.zeros(3), abs=1e-9 * abs(torque))
    # the ratio of base radii
    assert w[9] / w[3] == pytest.approx(of.second.teeth / of.first.teeth, rel=1e-12)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("driving", [True, False])
def test_a_rigid_motion_of_both_gears_and_turning_with_the_ratio_approach_nothing(
    kind: str, driving: bool
) -> None:
    of, x = KINDS[kind], np.array([-0.02, 0.0, 0.03])
    rows = contact_rows(of, np.linspace(of.path.start, of.path.end, 3), x, driving)
    second = np.array([0.0, of.second.sign * of.centre_distance, 0.0])
    rigid = np.zeros((12, 7))
    for k in range(3):
        unit = np.eye(3)[k]
        rigid[k, k] = rigid[6 + k, k] = 1.0
        rigid[3 + k, 3 + k] = rigid[9 + k, 3 + k] = 1.0
        rigid[6:9, 3 + k] = np.cross(unit, second)
    rigid[3, 6], rigid[9, 6] = 1.0, -of.first.teeth / of.second.teeth
    assert np.abs(rows @ rigid).max() < 1e-15
    side = 1.0 if driving else -1.0
    assert rows[:, 3] == pytest.approx(np.full(3, side * of.first.base_radius))


def test_force_presses_the_gears_apart_and_a_right_handed_driver_is_pushed_forward() -> None:
    found = loaded(sliced(HELICAL), 0.2, TORQUE).wrench
    F_bt = TORQUE / HELICAL.first.base_radius
    angle = HELICAL.working_angle
    assert found[2] == pytest.approx(-F_bt * cos(angle))
    assert found[1] == pytest.approx(-F_bt * sin(angle))
    assert found[0] == pytest.approx(F_bt * tan(HELICAL.first.base_helix))
    assert loaded(sliced(RING), 0.2, TORQUE).wrench[7] > 0.0  # the ring is pushed outwards


def test_a_mirrored_helix_flips_axial_force_and_tilting() -> None:
    flip = np.tile([-1.0, 1.0, 1.0, 1.0, -1.0, -1.0], 2)
    right, left = (loaded(sliced(KINDS[k]), 0.35, TORQUE) for k in ("helical", "left"))
    assert right.wrench * flip == pytest.approx(left.wrench, abs=1e-9 * TORQUE)
    assert right.over_face == pytest.approx(left.over_face[::-1])
    assert abs(right.wrench[0]) > 0.1 * abs(right.wrench[2])


@pytest.mark.parametrize(("slope", "whole"), [(20e-6, True), (200e-6, False)])
def test_face_factor_of_a_linear_misalignment_is_that_of_the_closed_form(
    slope: float, whole: bool
) -> None:
    for slices in (35, 140):
        mesh = sliced(SPUR, 1.0, modifications=Modifications(slope=slope), slices=slices)
        found = loaded(mesh, 0.5, TORQUE)
        pairs = len(set(found.contacts.tooth[found.contacts.driving]))
        mean = TORQUE / SPUR.first.base_radius / SPUR.face_width
        exact = face_factor(slope, pairs * C, mean)
        assert (found.loaded_share == 1.0) is whole
        # exact where the load is straight; else a slice is loaded in part: second order
        within = 1e-9 if whole else 3.0 / slices**2 * exact
        assert found.face_factor == pytest.approx(exact, rel=within)


def test_a_small_tilt_moves_the_centre_of_the_load_by_its_closed_form() -> None:
    mesh, b = sliced(SPUR, 1.0, slices=200), SPUR.face_width
    pressed = loaded(mesh, 0.5, TORQUE).approach - 0.5 * PLAY
    gamma = 0.5 * pressed * 2.0 / b
    motion = np.zeros(12)
    # a turn of the first gear about the line of centres tilts the line of action
    angle = SPUR.working_angle
    motion[4:6] = gamma * np.array([cos(angle), -sin(angle)])
    found = loaded(mesh, 0.5, TORQUE, motion)
    centre = float(found.over_face @ mesh.x / found.over_face.sum())
    assert abs(centre) == pytest.approx(b**2 * gamma / (12.0 * pressed), rel=1e-3)
    far = loaded(mesh, 0.5, TORQUE, 8.0 * motion)
    # lifted off: a triangle of the same area, of a width that falls with the root of the tilt
    assert far.loaded_share == pytest.approx(1.0 / np.sqrt(0.5 * 8.0), rel=0.02)


def test_35_slices_are_within_two_percent_of_many() -> None:
    for of in (SPUR, HELICAL):
        change = Modifications(slope=30e-6, crowning=10e-6)
        # transmission errors are of the flanks in touch, without the play
        few, many = (
            over_period(sliced(of, modifications=change, slices=n), TORQUE, phases=16)
            for n in (35, 350)
        )
        assert few.face_factor == pytest.approx(many.face_factor, rel=0.02)
        pressed = [p.approach - 0.5 * PLAY for p in (few, many)]
        assert pressed[0] == pytest.approx(pressed[1], rel=0.02)


def test_gears_hang_free_in_their_backlash() -> None:
    play = 200e-6
    mesh = SlicedMesh(SPUR, constant_law(C), backlash=play)
    forth, back = (loaded(mesh, 0.5, t) for t in (1e-3, -1e-3))
    assert forth.approach - back.approach == pytest.approx(play, rel=1e-6)
    assert not forth.forces[~forth.contacts.driving].any()
    assert not back.forces[back.contacts.driving].any()
    reversed_, driven = loaded(mesh, 0.5, -TORQUE), loaded(mesh, 0.5, TORQUE)
    assert reversed_.wrench[3] == pytest.approx(-driven.wrench[3])


def test_both_flanks_touch_where_gears_are_pressed_together() -> None:
    mesh, motion = replace(sliced(SPUR), backlash=0.0), np.zeros(12)
    motion[1] = 50e-6
    found = loaded(mesh, 0.5, TORQUE, motion)
    both = [found.forces[found.contacts.driving == side].sum() for side in (True, False)]
    assert min(both) > 0.0
    assert both[0] - both[1] == pytest.approx(TORQUE / SPUR.first.base_radius)


def test_tip_relief_takes_load_from_the_tips() -> None:
    relief = Modifications(tip_relief=(50e-6, 0.0), relief_length=(0.005, 0.0))
    path = SPUR.path
    at = np.array([path.start, path.pitch, path.end - 0.0025, path.end])
    gap = relief.gap(SPUR, at, np.zeros(4))
    assert gap == pytest.approx([0.0, 0.0, 25e-6, 50e-6])
    plain, relieved = sliced(SPUR), sliced(SPUR, modifications=relief)
    phase = 0.999 * ((path.end - path.start) / SPUR.first.base_pitch - 1.0)
    last = [loaded(mesh, phase, TORQUE) for mesh in (plain, relieved)]
    end = [f.forces[f.contacts.place > path.end - 0.001].sum() for f in last]
    assert end[1] < 0.5 * end[0]


def test_a_helix_deviation_is_a_tilt_about_the_line_of_centres() -> None:
    b, slope, motion = SPUR.face_width, 40e-6, np.zeros(12)
    angle = SPUR.working_angle
    # about the line of centres: what opens one flank closes the other
    motion[4] = slope / b / cos(angle)
    for torque in (TORQUE, -TORQUE):
        deviated = loaded(sliced(SPUR, modifications=Modifications(slope=slope)), 0.5, torque)
        tilted = loaded(sliced(SPUR), 0.5, torque, motion)
        assert tilted.over_face == pytest.approx(deviated.over_face, rel=1e-9)
        assert tilted.approach == pytest.approx(deviated.approach, rel=1e-9)
    # larger than the play it jams
    jammed = loaded(sliced(SPUR, modifications=Modifications(slope=4.0 * PLAY)), 0.5, TORQUE)
    assert jammed.forces[~jammed.contacts.driving].sum() > 0.0


def test_crowning_and_end_relief_unload_the_ends() -> None:
    for change in (Modifications(crowning=20e-6), Modifications(end_relief=20e-6, end_length=0.02)):
        over = loaded(sliced(SPUR, modifications=change), 0.5, TORQUE).over_face
        assert over[0] == pytest.approx(over[-1])
        assert over[0] < over[17]


def test_stiff_supports_hold_the_gears_and_soft_ones_let_them_tilt() -> None:
    mesh = sliced(HELICAL)
    load = np.zeros(12)
    load[3] = TORQUE
    stiff = np.diag([1e16, 1e16, 1e16, 0.0, 1e14, 1e14] + [1e16] * 3 + [1e14] * 3)
    found, motion = supported(mesh, 0.3, load, stiff)
    fixed = loaded(mesh, 0.3, TORQUE)
    assert found.converged
    assert found.forces == pytest.approx(fixed.forces, rel=1e-4, abs=1e-3)
    assert found.approach == pytest.approx(fixed.approach, rel=1e-4)
    soft = np.diag([1e9, 1e9, 1e9, 0.0, 1e6, 1e6] + [1e9] * 3 + [1e9] * 3)
    tilted, motion = supported(mesh, 0.3, load, soft)
    assert tilted.converged
    assert tilted.wrench + load == pytest.approx(soft @ motion, abs=1e-6 * TORQUE)
    assert abs(motion[4:6]).max() > 1e-5


def test_supports_that_leave_a_motion_free_are_refused() -> None:
    load = np.zeros(12)
    load[3] = TORQUE
    with pytest.raises(InputError, match="free"):
        supported(sliced(SPUR), 0.3, load, np.zeros((12, 12)))


def test_coupling_without_length_changes_nothing_and_long_one_makes_teeth_rigid() -> None:
    mesh = sliced(SPUR, 1.0, modifications=Modifications(slope=20e-6), slices=140)
    hertz = 1.0 / yang_sun_contact()
    plain = loaded(mesh, 0.5, TORQUE)
    none = loaded_with_coupling(mesh, 0.5, TORQUE, Coupling(0.0, hertz))
    driving = plain.contacts.driving
    assert none.converged
    assert none.forces == pytest.approx(plain.forces[driving], rel=1e-9)
    # teeth that do not bend over the face: only the contact gives way to the misalignment
    rigid = loaded_with_coupling(mesh, 0.5, TORQUE, Coupling(1e3, hertz))
    assert rigid.converged
    pairs = len(set(rigid.contacts.tooth))
    mean = TORQUE / SPUR.first.base_radius / SPUR.face_width
    assert rigid.face_factor == pytest.approx(face_factor(20e-6, pairs * hertz, mean), rel=0.03)
    assert rigid.forces.sum() == pytest.approx(plain.forces.sum())


def test_wrong_inputs_say_what_to_give() -> None:
    with pytest.raises(InputError, match="at least 1"):
        sliced(SPUR, slices=0)
    with pytest.raises(InputError, match="jam"):
        SlicedMesh(SPUR, constant_law(C), backlash=-1e-4)
    with pytest.raises(InputError, match="contact in series"):
        loaded_with_coupling(sliced(SPUR), 0.5, TORQUE, Coupling(0.0, 1e9))
    assert replace(sliced(SPUR), backlash=None).play == pytest.approx(0.0, abs=1e-12)
