"""Meshes that vary as teeth come and go: waves, frequencies from teeth, lines in the spectrum."""

import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.dynamics.bodies.equations import equations_of, steady
from fe_drivetrain.dynamics.bodies.levels import Level, machine_system
from fe_drivetrain.dynamics.bodies.machine import library_machine
from fe_drivetrain.dynamics.bodies.meshing import (
    Meshing,
    contact_wave,
    machine_meshing,
    varying_equations,
    wave_of,
)
from fe_drivetrain.dynamics.bodies.steady_state import wind_up
from fe_drivetrain.dynamics.bodies.system import System
from fe_drivetrain.dynamics.time.integration import integrate
from fe_drivetrain.dynamics.time.motion import State
from fe_drivetrain.gear.meshes import StiffnessTable


def values(wave: Floats, points: int) -> Floats:
    """At even phases: the beginnings of its intervals and between."""
    intervals = len(wave)
    s = np.arange(points) / points * intervals
    j = s.astype(int)
    d = (s - j) / intervals
    return np.asarray(sum(wave[j, k] * d**k for k in range(4)))


@pytest.mark.parametrize("ratio", [1.2, 1.5, 1.7, 2.3])
def test_levels_duty_and_mean_of_the_wave(ratio: float) -> None:
    """n + 1 pairs for the share C - n of a period; mean C pairs; Gibbs 9 % of the jump beyond."""
    wave = ratio * values(contact_wave(ratio, 60), 4096)
    low, share = np.floor(ratio), ratio - np.floor(ratio)
    assert wave.mean() == pytest.approx(ratio, rel=1e-6)
    assert (wave > low + 0.5).mean() == pytest.approx(share, abs=0.003)
    phase = np.arange(4096) / 4096
    inside = (phase > 0.3 * share) & (phase < 0.7 * share)
    assert_allclose(wave[inside], low + 1.0, atol=0.05)
    assert wave.max() == pytest.approx(low + 1.0 + 0.09, abs=0.01)


def test_a_whole_contact_ratio_does_not_vary() -> None:
    assert_allclose(values(contact_wave(2.0), 512), 1.0, atol=1e-12)
    with pytest.raises(InputError, match=r"contact ratio of 0\.9"):
        contact_wave(0.9)


def test_a_tabled_course_over_its_mean() -> None:
    """Of the room `gear`, straight between its values: the spline goes through them."""
    table = StiffnessTable(np.array([1.0, 2.0, 4.0, 1.0]) * 1e8, 1.5)
    wave = wave_of(table)
    assert_allclose(values(wave, 4), np.array([1.0, 2.0, 4.0, 1.0]) / 2.0, rtol=1e-12)
    assert values(wave, 4096).mean() == pytest.approx(1.0, abs=1e-6)
    system, _ = park()
    equations = varying_equations(system, {"stage 3 mesh": Meshing(1.5, 100.0, course=table)})
    assert_allclose(equations.springs.waves[0], wave)


RATIOS = {
    "stage 1 sun-planet": 1.115,
    "stage 1 ring-planet": 1.278,
    "stage 2 sun-planet": 1.37,
    "stage 2 ring-planet": 1.618,
    "stage 3 mesh": 1.463,
}


def test_frequencies_and_phases_from_teeth() -> None:
    """NREL 5 MW at 12.1 rpm: z_ring times the carrier's speed; 19 / 3 leaves phases of thirds."""
    found = machine_meshing(library_machine("nrel_5mw"), 12.1 * np.pi / 30, RATIOS)
    assert len(found) == 13
    assert found["stage 1 sun-planet 2"].frequency == pytest.approx(56 * 12.1 / 60)
    assert found["stage 1 sun-planet 2"].phase == pytest.approx(-19 / 3 % 1)
    assert found["stage 2 ring-planet 3"].frequency == pytest.approx(93 * 12.1 / 60 * 75 / 19)
    assert found["stage 2 ring-planet 3"].phase == pytest.approx(0.0)
    assert found["stage 3 mesh"].frequency == pytest.approx(95 * 12.1 / 60 * 75 / 19 * 111 / 18)
    with pytest.raises(InputError, match="no contact ratio of 'stage 3 mesh'"):
        machine_meshing(library_machine("nrel_5mw"), 1.0, dict(list(RATIOS.items())[:4]))


def park() -> tuple[System, Floats]:
    machine = library_machine("park_2021")
    system = machine_system(machine, Level.TORSIONAL)
    load = system.load_on("rotor", np.array([0, 0, 0, 15e3, 0, 0]))
    held = system.load_on("generator", np.array([0, 0, 0, -15e3 / machine.speeds[-1], 0, 0]))
    return system, load + held


def test_spectrum_has_lines_at_the_mesh_frequency_and_its_multiples() -> None:
    system, load = park()
    equations = varying_equations(system, {"stage 3 mesh": Meshing(1.6, 128.0)}, damping=5e-5)
    start = wind_up(equations_of(system), load)
    zero = np.zeros(len(load))
    motion = integrate(equations, steady(load), 3.0, 2.5e-4, start=State(start.q, zero, zero))
    force = motion.forces[4000:-1, system.spring_names.index("stage 3 mesh")]
    size = np.abs(np.fft.rfft(force * np.hanning(len(force))))
    lines = np.fft.rfftfreq(len(force), 2.5e-4)
    fast = lines > 100.0
    for multiple in (1, 2, 3):
        assert lines[fast][np.argsort(size[fast])[-12:]].min() > 0.0
        near = np.abs(lines - 128.0 * multiple) < 0.6
        between = np.abs(lines - 128.0 * (multiple + 0.4)) < 10.0
        assert size[near].max() > 30.0 * np.median(size[between])
    assert force.mean() == pytest.approx(
        15e3 / system_ratio() / 0.08 / np.cos(np.radians(20)), rel=0.01
    )


def system_ratio() -> float:
    return float(abs(library_machine("park_2021").speeds[-1]))


def test_without_variation_the_wound_up_machine_stays() -> None:
    system, load = park()
    equations = varying_equations(system, {"stage 3 mesh": Meshing(2.0, 128.0)})
    start = wind_up(equations_of(system), load)
    zero = np.zeros(len(load))
    motion = integrate(equations, steady(load), 0.2, 1e-3, start=State(start.q, zero, zero))
    assert_allclose(motion.forces, motion.forces[:1] + 0 * motion.forces, rtol=1e-6, atol=1e-3)


def test_backlash_opens_meshes_of_an_unloaded_machine() -> None:
    system, load = park()
    equations = varying_equations(system, {"stage 3 mesh": Meshing(1.6, 128.0)}, backlash=2e-4)
    motion = integrate(equations, steady(0.0 * load), 0.01, 1e-4)
    assert not motion.forces.any()


def test_a_mesh_that_is_not_there() -> None:
    with pytest.raises(InputError, match="no mesh 'stage 9 mesh'"):
        varying_equations(park()[0], {"stage 9 mesh": Meshing(1.6, 128.0)})


def test_the_examples_of_the_docs_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    text = (Path(__file__).parents[2] / "docs" / "transients.md").read_text(encoding="utf-8")
    blocks = re.findall(r"```python\n(.*?)```", text, flags=re.S)
    assert len(blocks) == 7
    monkeypatch.chdir(tmp_path)  # which a page writes a table to
    found: dict[str, Any] = {}
    for block in blocks:
        exec(block, found)
    assert found["motion"].converged
    assert found["stopped"].ratio("HSS")[0] == pytest.approx(1.0, rel=1e-6)
    assert found["turned"].converged
    radial = found["on_rollers"].bearings.radial("stage 1 pin 1 upwind")
    assert radial[-1] > radial[0] > 1e5
    stops = found["shaken"].braking.events[0]
    assert stops == (pytest.approx(0.2 + 20 * 6 / 300, rel=1e-6), "stops")
    # errors of some microns against teeth of a GN/m
    assert 1e2 < abs(found["answer"].forces).max() < 1e5


def test_a_mesh_that_was_eliminated_cannot_vary() -> None:
    machine = library_machine("nrel_5mw")
    system = machine_system(machine, Level.TORSIONAL)
    mesh = "stage 3 mesh"
    name = next(spring for spring in system.spring_names if spring.startswith(mesh))
    eliminated = replace(system, unchangeable=(name,))
    with pytest.raises(InputError, match="eliminated by its stiffness"):
        varying_equations(eliminated, {mesh: Meshing(1.6, 128.0)})


@pytest.mark.parametrize("level", [Level.TORSIONAL, Level.RIGID])
def test_a_turn_of_the_driving_gear_has_as_many_periods_as_it_has_teeth(level: Level) -> None:
    """Whatever the speed; of a planetary stage with its ring held, the ring's teeth a turn."""
    machine = library_machine("nrel_750kw")
    generator = machine.generator.model_copy(update={"stiffness": 0.0})
    system = machine_system(machine.model_copy(update={"generator": generator}), level)
    ratios = {f"stage 1 {kind}-planet": 1.6 for kind in ("sun", "ring")}
    ratios |= {f"stage {number} mesh": 1.6 for number in (2, 3)}
    for speed in (0.3, 2.3):
        meshing = machine_meshing(machine, speed, ratios)
        found = varying_equations(system, meshing, speed, by="angle").springs
        assert not found.frequency.any()
        for name, body in (
            ("stage 1 sun-planet 1", "stage 1 carrier"),
            ("stage 1 ring-planet 2", "stage 1 carrier"),
            ("stage 2 mesh", "stage 2 gear"),
            ("stage 3 mesh", "stage 3 gear"),
        ):
            number = int(name.split()[1])
            spring = next(k for k, of in enumerate(system.spring_names) if of.startswith(name))
            turns = found.turns[spring]
            at = system.names.index(f"{body} rx")
            assert abs(turns[at]) * 2.0 * np.pi == pytest.approx(machine.meshing[number - 1][1][0])
            assert np.count_nonzero(turns) == 1


def test_meshes_by_angle_need_a_speed() -> None:
    with pytest.raises(InputError, match="reference speed of 0 rad/s but need one above 0"):
        varying_equations(park()[0], {"stage 3 mesh": Meshing(1.6, 128.0)}, by="angle")


def test_meshes_by_angle_need_what_turns_freely() -> None:
    machine = library_machine("park_2021")
    held = machine_system(machine, Level.TORSIONAL, held_generator=True)
    with pytest.raises(InputError, match="need one way to turn, but the system has 0"):
        varying_equations(held, {"stage 3 mesh": Meshing(1.6, 128.0)}, 0.6, by="angle")
