"""Gears of a machine with full data: stiffness and contact ratios against its table."""

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.dynamics.gear_pairs import (
    contact_ratios,
    machine_pairs,
    mesh_courses,
    with_iso_stiffness,
)
from fe_drivetrain.dynamics.levels import Level, machine_system
from fe_drivetrain.dynamics.meshing import machine_meshing, varying_equations
from fe_drivetrain.dynamics.tables import Machine, library_machine
from fe_drivetrain.gear.pair_stiffness import constant_law
from fe_drivetrain.validation.published_gears import nrel_5mw


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
        with_iso_stiffness(library_machine("nrel_750kw"))
    data = library_machine("nrel_5mw").model_dump(exclude_none=True)
    data["stages"][2]["shifts"] = (0.1, 0.2, 0.3)
    with pytest.raises(InputError, match="as many as its 2 teeth"):
        Machine.model_validate(data)
