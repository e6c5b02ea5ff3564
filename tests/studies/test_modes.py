"""Modes of a drivetrain: frequencies by hand, energy, crossings, levels, bands, the command."""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fe_drivetrain.cases.references import published_drivetrains as published
from fe_drivetrain.command_line import main
from fe_drivetrain.common import InputError
from fe_drivetrain.drivetrain_file import LumpedDrivetrain, read_drivetrain
from fe_drivetrain.dynamics import (
    Level,
    Operation,
    ladder,
    library_machine,
    machine_of,
    machine_system,
    plain_rungs,
    system_modes,
    torsional_frequency,
    turning_modes,
)
from fe_drivetrain.dynamics.torsion import gear_masses, natural_modes
from fe_drivetrain.pages.mode_shapes import shape_charts
from fe_drivetrain.procedure import Excitation, drivetrain_excitations, resonances
from fe_drivetrain.procedure.assessment import needed_of
from fe_drivetrain.procedure.project import Need
from fe_drivetrain.report.results import read_results
from fe_drivetrain.studies.drivetrain_modes import ModesResult, modes
from fe_drivetrain.studies.mode_register import margin_chart, margins_of

RPM = math.pi / 30.0
ROTOR, GENERATOR, SHAFT = 4e6, 9e5, 2e8  # kg m^2, kg m^2, N m/rad
RANGE = (4.0 * RPM, 40.0 * RPM)


def two_inertias(**changes: Any) -> LumpedDrivetrain:
    """Rotor and generator on a shaft, without a gearbox; of neither is the mass known."""
    values: dict[str, Any] = {
        "title": "direct drive",
        "rotor": {"inertia": ROTOR},
        "shaft": {"name": "main", "torsion": SHAFT},
        "generator": {"inertia": GENERATOR},
    }
    return LumpedDrivetrain.model_validate({**values, **changes})


def three_inertias() -> LumpedDrivetrain:
    """Rotor with a gear on it, pinion, and generator on a shaft."""
    stage = {
        "kind": "parallel",
        "teeth": {"gear": 100, "pinion": 20},
        "centre_distance": 1.2,
        "face_width": 0.3,
        "stiffness_of": "line",
        "stiffness": 4e8,
        "gear": {"inertia": 3e3, "mass": 6e3},
        "pinion": {"inertia": 40.0, "mass": 400.0},
    }
    bearings = [
        {"name": "front", "holds": "stage 1 gear", "stiffness": [1e9] * 3 + [0, 1e9, 1e9]},
        {"name": "rear", "holds": "stage 1 pinion", "stiffness": [1e9] * 3 + [0, 1e8, 1e8]},
    ]
    return LumpedDrivetrain.model_validate(
        {
            "title": "one stage",
            "rotor": {"inertia": ROTOR, "mass": 1e4},
            "shaft": {"name": "hub", "length": 0.5, "kind": "rigid"},
            "gearbox": {
                "stages": [stage],
                "shafts": [{"name": "fast", "length": 1.0, "torsion": 3e7}],
                "bearings": bearings,
            },
            "generator": {"inertia": 2e4},
        }
    )


@pytest.fixture(scope="module")
def geared() -> ModesResult:
    return modes(read_drivetrain("synthetic_2mw"), speeds=(8.0 * RPM, 18.1 * RPM))


def test_two_inertias_by_hand() -> None:
    found = modes(two_inertias(), speeds=RANGE)
    by_hand = math.sqrt(SHAFT * (1 / ROTOR + 1 / GENERATOR)) / (2 * math.pi)
    assert found.level is Level.TORSIONAL
    assert found.frequencies == pytest.approx([by_hand], rel=1e-12)
    assert found["first torsional frequency"].computed == found.frequencies[0]
    assert found.kinetic["rotor"] == pytest.approx(GENERATOR / (ROTOR + GENERATOR))
    assert found.strain["shaft main"] == pytest.approx([1.0])
    assert found.words == ("turning of the generator (82 %); 100 % of the strain in shaft main",)


def test_a_held_generator_by_hand() -> None:
    found = modes(two_inertias(), generator="held")
    assert found.frequencies == pytest.approx([math.sqrt(SHAFT / ROTOR) / (2 * math.pi)])
    assert found.kinetic["rotor"] == pytest.approx([1.0])


def test_three_inertias_by_hand() -> None:
    found = modes(three_inertias(), level="torsional")
    ratio, base = 5.0, 1.0 * math.cos(math.radians(20.0))
    J = ROTOR + 3e3, 40.0 * ratio**2, 2e4 * ratio**2
    k1, k2 = 4e8 * base**2, 3e7 * ratio**2
    b = k1 / J[0] + (k1 + k2) / J[1] + k2 / J[2]
    c = k1 * k2 * sum(J) / math.prod(J)
    squares = np.roots([1.0, -b, c])
    assert found.frequencies == pytest.approx(np.sort(np.sqrt(squares)) / (2 * math.pi), rel=1e-9)


def test_a_library_machine_has_the_frequencies_of_its_published_table() -> None:
    # the planets' masses are in the table's carrier already
    mine = read_drivetrain("synthetic_2mw", {"gearbox.stages.0.planet.mass": 0.0})
    table = natural_modes(gear_masses(published.table("drivetrain_c"), "free")).frequencies
    assert modes(mine, level="torsional").frequencies == pytest.approx(table[table > 0.0], rel=1e-9)


def test_energies_are_all_of_it_at_every_level(geared: ModesResult) -> None:
    mine = read_drivetrain("synthetic_2mw")
    for found in (geared, *(modes(mine, level=level) for level in ("torsional", "rigid"))):
        for parts in (found.kinetic, found.strain):
            assert sum(parts.values()) == pytest.approx(np.ones(len(found.frequencies)), abs=1e-9)
    assert {"rotor", "stage 1 planets", "stage 3 pinion", "generator"} <= geared.kinetic.keys()
    springs = {"shaft LSS", "stage 1 sun meshes", "stage 1 planet bearings", "bearing PLC-A"}
    assert springs <= geared.strain.keys()


def test_crossings_by_hand() -> None:
    found = modes(two_inertias(), speeds=RANGE)
    frequency = float(found.frequencies[0])
    met = {one.excitation: one.crossing / RPM for one in found.meetings if one.margin == 0.0}
    wanted = {f"{k}P": 60.0 * frequency / k for k in (3, 6, 9)}
    wanted |= {"generator 2x": 30.0 * frequency}
    inside = {name: speed for name, speed in wanted.items() if 4.0 <= speed <= 40.0}
    assert len(inside) > 1
    assert met == pytest.approx(inside)
    assert {one.excitation for one in found.resonances} == inside.keys()
    (margin,) = [one for one in found.meetings if one.excitation == "1P"]
    assert margin.margin == pytest.approx(1.0 - 40.0 / 60.0 / frequency)


def test_the_register_has_the_least_margin_of_each_excitation_over_the_speeds() -> None:
    found = modes(two_inertias(), speeds=RANGE)
    rows = {row["excitation"]: row for row in found.tables["register"]}
    assert rows.keys() == {one.name for one in found.excitations}
    frequency, (low, high) = float(found.frequencies[0]), RANGE
    assert rows["1P"]["least margin [%]"] == pytest.approx(100.0 - 4000.0 / 60.0 / frequency)
    assert rows["1P"]["at the largest speed [Hz]"] == pytest.approx(high / (2.0 * math.pi))
    for order in (3, 6, 9):
        inside = low < 2.0 * math.pi * frequency / order < high
        assert rows[f"{order}P"]["crossings"] == inside
    assert sum(row["verdict"] == "resonance" for row in rows.values()) > 1
    speeds = np.linspace(low, high, 20001)
    for one in found.excitations:
        least = 100.0 * float(margins_of(one, found, speeds).min())
        assert rows[one.name]["least margin [%]"] == pytest.approx(least, abs=0.1)
    assert margin_chart(found) is not None
    assert margin_chart(modes(two_inertias())) is None


def test_a_fixed_frequency_meets_a_mode_at_any_speed() -> None:
    frequency = float(modes(two_inertias()).frequencies[0])
    grid = [Excitation(name, 0.0, ("generator",), f) for name, f in (("at", 1.0), ("off", 1.2))]
    tuned = [Excitation(one.name, 0.0, one.at, one.fixed * frequency) for one in grid]
    found = modes(two_inertias(), speeds=RANGE, excitations=tuned)
    verdicts = {one.excitation: one.verdict for one in found.meetings}
    assert (verdicts["at"], verdicts["off"]) == ("resonance", "clear")


def test_crossings_of_whirling_modes_are_on_their_curves(geared: ModesResult) -> None:
    assert geared.campbell is not None
    backward, forward = geared.running[0], geared.running[1]
    assert backward < geared.frequencies[0] < geared.frequencies[1] < forward
    orders = {one.name: one.per_turn for one in geared.excitations}
    met = [one for one in geared.meetings if one.margin == 0.0]
    assert len(met) > 20
    for one in met:
        on_curve = geared.campbell.at(one.crossing)[one.mode - 1]
        assert one.frequency == pytest.approx(on_curve, rel=1e-9)
        assert orders[one.excitation] * one.crossing / (2 * math.pi) == pytest.approx(on_curve)


def test_whirls_keep_apart_over_the_speed(geared: ModesResult) -> None:
    """Whirls of a rotor that is equally stiff in both planes: one falls, one rises, no jump."""
    for found in (geared, modes(read_drivetrain("park_2021"), level="rigid", speeds=RANGE)):
        assert found.campbell is not None
        first, second = [k for k in range(4) if found.kinds[k] == "lateral"][:2]
        assert np.all(np.diff(found.campbell.frequencies[:, first]) < 0.0)
        assert np.all(np.diff(found.campbell.frequencies[:, second]) > 0.0)


def test_between_the_speeds_that_are_solved_frequencies_are_known_well(
    geared: ModesResult,
) -> None:
    assert geared.campbell is not None
    system = machine_system(geared.machine, Level.FLEXIBLE)
    solved = geared.campbell.speeds
    between = 0.5 * float(solved[2] + solved[3])
    exact = turning_modes(system, between).frequencies
    assert np.sort(geared.campbell.at(between)) == pytest.approx(exact, rel=1e-3)
    assert geared.campbell.at(float(solved[2])) == pytest.approx(geared.campbell.frequencies[2])


def test_without_turning_the_register_is_that_of_the_modes_at_rest() -> None:
    machine = library_machine("synthetic_2mw")
    at_rest = system_modes(machine_system(machine))
    every = drivetrain_excitations(machine.stages)
    plain = resonances(every, at_rest, RANGE)
    same = resonances(every, at_rest, RANGE, turning=lambda _: at_rest.frequencies)
    assert [one.verdict for one in same] == [one.verdict for one in plain]
    for key in ("frequency", "crossing", "margin"):
        numbers = ([getattr(one, key) for one in of] for of in (same, plain))
        assert next(numbers) == pytest.approx(next(numbers), abs=1e-9)


def test_levels_are_those_of_the_ladder() -> None:
    mine = read_drivetrain("nrel_5mw")
    found = modes(mine, level="torsional")
    questions = {"f": torsional_frequency(1)}
    known = ladder(machine_of(mine), Operation(0.0), plain_rungs(mine), questions)
    name = "first torsional frequency [Hz]"
    assert [one.values[name] for one in found.ladder] == pytest.approx(
        [one.values["f"] for one in known]
    )
    assert found.enough[name] == "torsional"  # 4.4 % is within 5 %
    strict = modes(mine, level="torsional", tolerance=0.04)
    assert strict.enough[name] == "rigid bodies"
    # modes that are no turning are not at this level
    assert all(one is None for key, one in found.ladder[0].values.items() if key != name)
    assert found.bands[0] == pytest.approx(found.frequencies[0] - known[-1].values["f"], rel=1e-4)


def test_a_project_takes_level_and_margin_of_modes_as_evidence(tmp_path: Path) -> None:
    with pytest.raises(SystemExit):
        main(["modes", "nrel_5mw", "--speeds", "6.9:12.1", "--out", str(tmp_path / "out")])
    results = read_results(tmp_path / "out/results.json")
    levels, needed = (
        needed_of(results, results.drivetrains[0], Need(quantity=name, tolerance=tolerance))
        for name, tolerance in (
            ("first torsional frequency [Hz]", 0.05),
            ("mode 1, lateral [Hz]", 0.05),
        )
    )
    assert levels == ([("0", "torsional"), ("1", "rigid bodies"), ("2", "flexible shafts")], 0)
    assert needed is not None
    assert needed[1] == 2
    (margin,) = [one for one in results.answers if "resonance" in one.loads]
    assert margin.computed == 0.0


def test_bands_cover_what_more_elements_change() -> None:
    mine = read_drivetrain("park_2021")
    found = modes(mine)
    finer = system_modes(machine_system(machine_of(mine), Level.FLEXIBLE, elements=24)).frequencies
    change = np.abs(finer[finer > 0.0][:16] - found.frequencies[:16])
    assert np.all(change <= found.bands[:16])
    assert np.all(found.bands[:16] < 3e-3 * found.frequencies[:16])


def test_what_a_level_needs_is_named() -> None:
    with pytest.raises(InputError, match=r"needs what its file does not state: rotor: mass, shaft"):
        modes(two_inertias(), level="rigid")
    with pytest.raises(InputError, match=r"does not state its generator"):
        modes(two_inertias(generator=None))
    with pytest.raises(InputError, match="no level 'beam': use one of torsional, rigid"):
        modes(two_inertias(), level="beam")
    found = modes(two_inertias())
    assert any("rotor: mass" in note for note in found.notes)
    assert any("speeds of operation" in note for note in found.notes)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"generator": "loose"}, "generator is 'loose' but must be free or held"),
        ({"speeds": (2.0, 1.0)}, "speeds of the rotor are 2 to 1 rad/s"),
        ({"speed": -1.0}, "speed of the rotor is -1 rad/s, -9.5493 rpm, but must be above 0"),
        ({"blades": 0}, "has 0 blades"),
        ({"tolerance": 1.0}, "tolerance is 1 but must be between 0 and 1"),
    ],
)
def test_an_option_out_of_its_range_is_refused(options: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        modes(two_inertias(), **options)


def test_speeds_of_operation_are_those_of_the_file() -> None:
    found = modes(two_inertias(operation={"rotor_speed": RANGE}))
    assert found.speeds == RANGE
    assert found.speed == RANGE[1]
    fixed = modes(two_inertias(operation={"rotor_speed": (2.0, 2.0)}))
    assert fixed.speeds == pytest.approx((2.0, 2.0))
    assert not fixed.resonances


def test_damping_ratios_of_the_file_are_those_of_one_mode() -> None:
    # of two inertias the shaft alone is the whole mode
    found = modes(two_inertias(damping={"shafts": 0.02}), speeds=RANGE)
    assert found.damping == pytest.approx([0.02], rel=1e-6)
    assert found.running == pytest.approx(found.frequencies * math.sqrt(1 - 0.02**2))
    assert not modes(two_inertias(), speeds=RANGE).damping.any()


def test_shapes_swing_between_their_envelopes(geared: ModesResult) -> None:
    charts = shape_charts(geared, 3)
    assert len(charts) == 3
    assert "turning of the generator" in charts[2].caption
    for one in charts:
        rest, other, out = one.figure["data"]
        swing = one.figure["swing"]
        for axis in "xy":
            at, moved = (np.array(swing[key], dtype=float) for key in (axis, f"d{axis}"))
            assert np.array(rest[axis], dtype=float) == pytest.approx(at, nan_ok=True)
            ends = (np.array(line[axis], dtype=float) for line in (out, other))
            for sign, end in zip((1, -1), ends, strict=True):
                assert end == pytest.approx(at + sign * moved, abs=2e-3, nan_ok=True)


def test_the_command_writes_a_page_that_moves(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    words = ["modes", "park_2021", "--level", "rigid", "--speeds", "6:12", "--excite", "grid=50"]
    with pytest.raises(SystemExit) as ended:
        main([*words, "--json", "--out", str(tmp_path / "out")])
    assert ended.value.code == 0
    found = json.loads(capsys.readouterr().out)
    assert found["schema"] == "fe-drivetrain/modes/1"
    assert found["options"]["excitations"] == ["grid"]
    page = (tmp_path / "out/report.html").read_text("utf-8")
    assert "requestAnimationFrame" in page
    assert '"swing"' in page


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["nosuch"], "nosuch"),
        (["park_2021", "--level", "beam"], "no level 'beam'"),
        (["park_2021", "--speeds", "12"], "--speeds 12 must be two speeds in rpm"),
        (["park_2021", "--excite", "grid"], "--excite grid must be a name and a frequency"),
        (["park_2021", "--excite", "a=1", "--excite", "a=2"], "--excite a is given twice"),
        (["park_2021", "--set", "rotor.masss=1"], "masss"),
    ],
)
def test_a_mistake_ends_with_status_2(
    words: list[str], message: str, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["modes", *words, "--out", str(tmp_path / "out")])
    assert ended.value.code == 2
    assert message in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
