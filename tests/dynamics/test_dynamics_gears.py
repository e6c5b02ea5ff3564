"""Gears of a machine with full data: stiffness and contact ratios against its table."""

from itertools import pairwise
from math import cos, pi
from typing import Any

import numpy as np
import pytest

from fe_drivetrain.cases.references.published_gears import nrel_5mw
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.dynamics.bodies.gear_pairs import (
    contact_ratios,
    machine_pairs,
    mesh_courses,
    mesh_stresses,
    pitch_contacts,
    with_iso_stiffness,
)
from fe_drivetrain.dynamics.bodies.levels import Level, machine_system
from fe_drivetrain.dynamics.bodies.machine import Machine, library_machine
from fe_drivetrain.dynamics.bodies.meshing import machine_meshing, varying_equations
from fe_drivetrain.gear.flank_stress import reduced_modulus, tooth_contact
from fe_drivetrain.gear.pair_stiffness import constant_law


def test_stiffness_of_iso_6336_is_what_the_table_of_the_5_mw_gearbox_states() -> None:
    machine = library_machine("nrel_5mw")
    own, iso = (machine_system(m, Level.TORSIONAL) for m in (machine, with_iso_stiffness(machine)))
    assert iso.spring_names == own.spring_names
    # C_R = 0.862 is printed with three digits, stiffness times the face stated with four or more
    assert iso.stiffness == pytest.approx(own.stiffness, rel=0.5e-3 / 0.862 + 1e-4)
    assert np.array_equal(iso.rows, own.rows)


def test_pairs_work_as_the_meshes_of_the_system_do() -> None:
    machine = library_machine("nrel_5mw")
    pairs = machine_pairs(machine)
    for pair, published in zip(pairs.values(), nrel_5mw().values(), strict=True):
        assert pair.contact_ratio == pytest.approx(published.contact_ratio, rel=1e-12)
        assert pair.backlash == pytest.approx(published.backlash, rel=1e-6, abs=1e-12)
    for number, stage in enumerate(machine.stages, 1):
        meshes = stage.meshes if stage.kind == "planetary" else (stage.meshing,)
        for mesh, pair in zip(
            meshes, (p for n, p in pairs.items() if n.startswith(f"stage {number}")), strict=True
        ):
            assert mesh.pressure_angle == pytest.approx(pair.working_angle, rel=1e-12)
            assert mesh.base_helix == pytest.approx(abs(pair.first.base_helix), rel=1e-12)


def test_contacts_at_the_pitch_point_are_those_of_the_gears() -> None:
    machine = library_machine("nrel_5mw")
    contacts = pitch_contacts(machine)
    for name, pair in machine_pairs(machine).items():
        teeth = tooth_contact(pair, pair.path.pitch, 1e6, reduced_modulus())
        of = contacts[name]
        assert of.radius == pytest.approx(teeth.radius, rel=1e-12)
        # 1e6 N/m in the transverse plane, on a fifth of the face
        force = 0.2 * 1e6 * pair.face_width / cos(pair.first.base_helix)
        assert of.under(force, 0.2).pressure == pytest.approx(teeth.pressure, rel=1e-12)


def test_contact_ratios_are_what_varying_meshes_need() -> None:
    machine = library_machine("nrel_5mw")
    ratios = contact_ratios(machine)
    assert all(1.0 < ratio < 3.5 for ratio in ratios.values())
    meshing = machine_meshing(machine, 1.267, ratios)
    assert meshing["stage 2 sun-planet 3"].contact_ratio == ratios["stage 2 sun-planet"]


def test_meshes_vary_as_those_of_their_gears() -> None:
    machine = library_machine("nrel_5mw")
    courses = mesh_courses(machine, lambda pair: constant_law(14e9))
    meshing = machine_meshing(machine, 1.267, contact_ratios(machine), courses)
    system = machine_system(machine, Level.TORSIONAL)
    springs = varying_equations(system, meshing).springs
    row = system.spring_names.index("stage 2 ring-planet 2 slice 1")
    # teeth that all are as stiff: one pair or two, of the contact ratio on average
    ratio = contact_ratios(machine)["stage 2 ring-planet"]
    wave = springs.waves[springs.wave[row]][:, 0]
    # the table of 200 phases rounds the contact ratio to 1/200
    assert [wave.min(), wave.max()] == pytest.approx([1 / ratio, 2 / ratio], rel=5e-3)


def test_missing_data_of_gears_is_named() -> None:
    with pytest.raises(InputError, match="stage 1 has no full data"):
        with_iso_stiffness(library_machine("park_2021"))
    data = library_machine("nrel_5mw").model_dump(exclude_none=True)
    data["stages"][2]["shifts"] = (0.1, 0.2, 0.3)
    with pytest.raises(InputError, match="shifts"):
        Machine.model_validate(data)
    data["stages"][2]["shifts"] = (0.6691, 0.48)
    data["stages"][2]["faces"] = (0.3, 0.37)
    with pytest.raises(InputError, match=r"at least the face width in contact, 0.36 m"):
        Machine.model_validate(data)


def test_stresses_of_the_5_mw_gearbox_are_those_printed_for_it() -> None:
    # sigma_H0 as a licensed program prints it, with shifts of four digits in this table
    printed = [759.92, 588.62, 573.40, 312.44, 570.79]
    found = mesh_stresses(library_machine("nrel_5mw"), 5e6 / (12.1 * pi / 30))
    contact = [mesh.contact.nominal / 1e6 for mesh in found.values()]
    assert contact == pytest.approx(printed, rel=2e-5)
    roots = [mesh.roots[0].nominal / 1e6 for mesh in found.values() if mesh.roots]
    assert roots == pytest.approx([113.46, 95.70, 73.95, 61.98, 117.82], rel=2e-4)


def fitted(teeth: list[int], roots: list[float], stage: Any) -> np.ndarray:
    """Dedendum and shifts: sums by the centre distance, the rest from root circles."""
    m, beta, tan_n = stage.module, np.radians(stage.helix), np.tan(np.radians(20.0))
    signs = np.array([-1 if z < 0 else 1 for z in teeth])
    transverse = np.arctan(tan_n / np.cos(beta))

    def involute(angle: float) -> float:
        return float(np.tan(angle) - angle)

    sums = []
    for one, two in pairwise(teeth):
        total = one + two
        base = abs(total) * m / np.cos(beta) * np.cos(transverse) / 2
        working = np.arccos(base / stage.centre_distance)
        sums.append(total * (involute(working) - involute(transverse)) / (2 * tan_n))
    # unknowns h, x_1 ...; rows: sums, held by a heavy weight, and d = z m_t - 2 s m (h - x)
    A, b = np.zeros((2 * len(teeth) - 1, len(teeth) + 1)), []
    for k, total in enumerate(sums):
        A[k, [k + 1, k + 2]] = 1e6
        b.append(1e6 * total)
    for k, (z, s, d) in enumerate(zip(teeth, signs, roots, strict=True)):
        A[len(sums) + k, [0, k + 1]] = -2 * s * m, 2 * s * m
        b.append(d - abs(z) * m / np.cos(beta))
    return np.linalg.lstsq(A, np.array(b), rcond=None)[0]


def test_shifts_of_the_750_kw_gearbox_follow_from_root_circles_and_centre_distances() -> None:
    published = {99: 1.047, 39: 0.372, 21: 0.186, 82: 0.678, 23: 0.174, 88: 0.440, 22: 0.100}
    for stage in library_machine("nrel_750kw").stages:
        assert stage.teeth is not None
        assert stage.shifts is not None
        teeth = [-z if z == 99 else z for z in stage.teeth]
        h, *shifts = fitted(teeth, [published[z] for z in stage.teeth], stage)
        assert stage.dedendum == pytest.approx(h, abs=1e-4)
        assert stage.shifts == pytest.approx(shifts, abs=1e-4)
    for pair in machine_pairs(library_machine("nrel_750kw")).values():
        for gear in (pair.first, pair.second):
            assert 2 * gear.root_radius == pytest.approx(published[abs(gear.teeth)], abs=0.2e-3)


@pytest.mark.parametrize("name", ["nrel_5mw", "nrel_750kw", "synthetic_2mw"])
def test_gears_of_every_table_fit_and_can_be_rated(name: str) -> None:
    machine = library_machine(name)
    found = mesh_stresses(machine, 1e5)
    assert len(found) == sum(2 if s.kind == "planetary" else 1 for s in machine.stages)
    for mesh in found.values():
        assert abs(mesh.pair.backlash) < 2e-6  # shifts are rounded to four digits
        rack = mesh.pair.first.rack
        fits = (pi / 4 - rack.dedendum * np.tan(np.radians(20))) / np.tan(np.radians(35))
        assert rack.fillet <= fits + 1e-3
        assert mesh.roots is not None
    # the torque on a planet is the same from sun and ring
    sun, ring = (found[f"stage 1 {part}-planet"] for part in ("sun", "ring"))
    on_planet = sun.torque * sun.pair.second.teeth / sun.pair.first.teeth
    assert ring.torque == pytest.approx(on_planet, rel=1e-14)
    # stresses go with the root of the torque, and with the torque
    double = mesh_stresses(machine, 2e5)["stage 1 sun-planet"]
    assert double.contact.nominal == pytest.approx(np.sqrt(2) * sun.contact.nominal, rel=1e-13)
    iso = with_iso_stiffness(machine)
    stage = iso.stages[0]
    assert stage.kind == "planetary"
    # teeth of an internal gear count as rigid as a rack's, q' without its 1/z
    assert stage.ring_planet > stage.sun_planet
