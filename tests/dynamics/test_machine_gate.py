"""The gate of machines and gear tables: what does not fit is refused with one sentence."""

from copy import deepcopy
from typing import Any

import numpy as np
import pytest

from fe_drivetrain.cases.references import published_drivetrains as published
from fe_drivetrain.cases.references.published_planetary import LIN_PARKER_STAGE, plane_stage
from fe_drivetrain.cases.verification import mutated_machines as mutations
from fe_drivetrain.cases.verification.machine_facts import machine_facts, own_energy, own_motion
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.machine_table import MachineTable
from fe_drivetrain.drivetrain_file.named_scenes import read_drivetrain
from fe_drivetrain.drivetrain_file.reading import library_text, parse_drivetrain
from fe_drivetrain.dynamics.bodies.bodies import Body, assemble
from fe_drivetrain.dynamics.bodies.gear_pairs import mesh_stresses
from fe_drivetrain.dynamics.bodies.levels import Level, machine_system
from fe_drivetrain.dynamics.bodies.machine import MACHINES, Machine, library_machine, machine_of
from fe_drivetrain.dynamics.bodies.machine_motions import turning_motion
from fe_drivetrain.dynamics.bodies.modes import spring_frequencies, system_modes
from fe_drivetrain.dynamics.bodies.planetary import PlanetarySet
from fe_drivetrain.dynamics.bodies.springs import Spring
from fe_drivetrain.dynamics.torsion.gear_table import GearTable, PlanetaryStage
from fe_drivetrain.dynamics.torsion.orders import Toothed
from fe_drivetrain.dynamics.torsion.system import Inertia, Torsional
from fe_drivetrain.gear.involute import Gear, Pair
from fe_drivetrain.gear.load_factors import LoadFactors
from fe_drivetrain.gear.rating import Running, contact_stress, root_stress
from fe_drivetrain.gear.strength import GearMaterial

PLAIN = {name: mutations.plain(library_machine(name)) for name in MACHINES}
FILES = [mutations.plain(read_drivetrain(name)) for name in MACHINES]
GONE = object()


def changed(name: str, changes: dict[str, Any]) -> dict[str, Any]:
    """A machine's data with other values by dotted key."""
    data = deepcopy(PLAIN[name])
    for key, value in changes.items():
        *path, last = (int(part) if part.isdecimal() else part for part in key.split("."))
        row: Any = data
        for part in path:
            row = row[part]
        if value is GONE:
            del row[last]
        else:
            row[last] = value
    return data


def planetary(ring: float, planet: float, sun: float) -> dict[str, float]:
    return {"ring": ring, "planet": planet, "sun": sun}


def radii(sun: float, planet: float) -> dict[str, float]:
    return {"sun": sun, "planet": planet}


def parallel(gear: float, pinion: float) -> dict[str, float]:
    return {"gear": gear, "pinion": pinion}


TEETH: dict[str, Any] = {"stages.0.radii": GONE}
NO_GEARS: dict[str, Any] = {
    f"stages.0.{key}": GONE for key in ("shifts", "tips", "faces", "fillets")
}

TOO_THICK: dict[str, Any] = {
    "stages.1.shifts": parallel(0.3, 0.3),
    "stages.1.tips": parallel(1.44, 0.37),
}


@pytest.mark.parametrize(
    ("name", "changes", "message"),
    [
        (
            "park_2021",
            TEETH | {"stages.0.teeth": planetary(60, 39, 21)},
            r"stage 1: .* ask for 99 where",
        ),
        (
            "park_2021",
            TEETH | {"stages.0.teeth": planetary(120, 39, 21)},
            r"stage 1: .* ask for 99 where",
        ),
        (
            "park_2021",
            {"stages.0.radii": radii(0.11, 0.36)},
            "stage 1: .* in sum 0.47 m, but must be",
        ),
        (
            "park_2021",
            {"stages.1.radii": parallel(0.29, 9.5)},
            "stage 2: .* the centre distance, 0.385 m",
        ),
        ("park_2021", {"stages.0.planets": 9}, "stage 1: 9 planets of radius 0.16 m overlap"),
        ("park_2021", {"bearings.0.at": 1e4}, "'rotor bearing' is at 10000 m but must be within"),
        ("park_2021", {"rotor.inertia": 1e308}, "rotor: .*inertia is 1e.308 but must be at most"),
        ("park_2021", {"stages.0.pins.0.stiffness": [0] * 6}, "stage 1 planet 1 can turn freely"),
        ("park_2021", {"stages.0.pins": []}, "mechanism: stage 1 planet 1 can turn freely"),
        ("park_2021", {"stages.0.pins.0.stiffness": [1e308] * 6}, "pin 1: .* must be at most 1e"),
        ("park_2021", {"stages.0.sun_planet": True}, "sun_planet is True: a truth value"),
        ("park_2021", {"bearings.0.stiffness.0": True}, "bearing 1: .* a truth value"),
        ("park_2021", {"stages.1.hand": 1}, "stage 2: hand is 1 but helix is 0 deg"),
        ("park_2021", {"stages.0.module": 0.01}, "stage 1: a module of 0.01 m needs the teeth"),
        ("park_2021", {"stages.0.planets": GONE}, "stage 1: .*planets .* is missing"),
        ("park_2021", {"stages.0.stiffness_of": GONE}, "stage 1: .*stiffness_of .* is missing"),
        ("park_2021", {"rotor.mass": GONE}, r"rotor: its mass \[kg\] is missing"),
        ("park_2021", {"rotor.transverse": 1e5}, "at least half of that about the axis"),
        ("park_2021", {"rotor.mass": 1e-3}, "rotor: .* radius of gyration of"),
        ("park_2021", {"bearings": []}, "mechanism: stage 1 sun and stage 2 gear can move freely"),
        ("park_2021", {"bearings.0.holds": "hub"}, "holds 'hub', which is no shaft or body"),
        ("park_2021", {"bearings.0.stiffness.3": 1e6}, "holds rotor against turning, with 1e.06"),
        ("park_2021", {"bearings.0.name": "generator"}, "name 'generator' of a shaft or bearing"),
        ("park_2021", {"bearings.0.name": "HSS"}, "name 'HSS' of a shaft or bearing must be one"),
        ("park_2021", {"stages.0.pins.0.stiffness.3": 1e3}, "against turning about its own axis"),
        ("park_2021", {"stages.0.pins.0.offset": 0.2}, "pin '' is 0.2 m from the planet's middle"),
        ("park_2021", {"stages.0.ring": {"inertia": 5.0}}, "both its inertias, ring, and its ring"),
        ("park_2021", {"stages.0.face_width": 1.4}, "stage 1: face width is 1.4 m but must be at"),
        (
            "park_2021",
            {"shafts.3.kind": "coupling", "shafts.3.bending": 2.83e6},
            "a coupling, which carries torque alone",
        ),
        ("park_2021", {"shafts.0.inner": 0.1}, "an inner diameter, 0.1 m, and no outer one"),
        (
            "park_2021",
            {"stages.0.pins.0.stiffness": [1e-30, 1e-30, 1e-30, 0, 1e6, 1e6]},
            "too far apart for the digits of a computer: stage 1 planet",
        ),
        ("nrel_750kw", {"stages.0.hand": GONE}, "stage 1: helix is 7.5 deg but the hand"),
        ("nrel_750kw", {"stages.1.hand": 0}, "stage 2: helix is 14 deg but the hand"),
        ("nrel_750kw", {"bearings.0.at": GONE}, "'main bearing' on shaft 'LSS' has no place"),
        ("nrel_750kw", {"bearings.0.at": 2.1}, "within 0 and 2 m, its shaft"),
        (
            "nrel_750kw",
            NO_GEARS | {"stages.0.teeth": planetary(60, 39, 21)},
            "planet and ring: a centre",
        ),
        (
            "nrel_750kw",
            {"stages.0.teeth": planetary(60, 39, 21)},
            "stage 1 .*: a centre distance of",
        ),
        (
            "nrel_750kw",
            {"stages.0.teeth": planetary(39, 99, 21)},
            "but the ring must have the most",
        ),
        ("nrel_750kw", {"stages.2.module": 0.0045}, "stage 3, pinion and gear: a centre distance"),
        ("nrel_750kw", {"generator.mass": 900.0}, "mechanism: generator can turn freely about y"),
        (
            "nrel_5mw",
            {"stages.0.tips": planetary(2.475, 0.86, 0.93)},
            "stage 1 .* the contact ratio of gears",
        ),
        ("synthetic_2mw", TOO_THICK, "stage 2: the teeth of gears of 27"),
        (
            "synthetic_2mw",
            {"stages.1.shifts": parallel(-0.5, -0.35)},
            "stage 2, mesh: play of the teeth",
        ),
        ("synthetic_2mw", {"stages.0.kind": ["planetary"]}, "stage 1: kind is .* must be one of"),
        ("synthetic_2mw", {"stages.0.teeth.ring": 10**400}, "stage 1: .*teeth.ring is 1000"),
        ("synthetic_2mw", {"stages.0.centre_distance": 10**400}, "centre_distance is 1000"),
        ("nrel_750kw", {"stages.0.teeth": [99, 39, 21]}, "is a list but must name each gear"),
        ("synthetic_2mw", {"stages.0": 7}, "stages.0 is 7 but must be a mapping"),
    ],
)
def test_what_does_not_fit_is_refused_with_one_sentence(
    name: str, changes: dict[str, Any], message: str
) -> None:
    with pytest.raises(InputError, match=message) as error:
        Machine.model_validate(changed(name, changes))
    assert "\n" not in str(error.value)
    assert len(str(error.value)) < 500


def test_teeth_that_fit_the_published_radii_pass() -> None:
    fits = TEETH | {"stages.0.teeth": planetary(99, 39, 21)}
    machine = Machine.model_validate(changed("park_2021", fits))
    assert machine.speeds[1] == pytest.approx(1 + 99 / 21, rel=1e-15)


def test_a_copy_passes_the_gate_again() -> None:
    park = library_machine("park_2021")
    with pytest.raises(InputError, match="mechanism"):
        park.model_copy(update={"bearings": ()})
    other = park.model_copy(update={"title": "other"})
    assert (other.title, other.speeds) == ("other", park.speeds)
    assert park.model_copy() == park


def test_a_file_with_a_number_of_400_digits_is_one_sentence() -> None:
    text = library_text("nrel_750kw").replace("ring: 99", f"ring: {'1' * 400}")
    with pytest.raises(InputError, match="is too large for a number") as error:
        parse_drivetrain(text, source="mine")
    assert str(error.value).startswith("mine is not plain YAML")


@pytest.mark.parametrize("name", MACHINES)
def test_ratio_and_modes_of_a_machine_are_of_one_geometry(name: str) -> None:
    machine = library_machine(name)
    for fact in machine_facts(machine):
        assert fact.holds, fact
    # turning as the teeth say is the motion without frequency, at the energy of the ratios alone
    system = machine_system(machine, Level.TORSIONAL)
    q = own_motion(machine, system.names)
    modes = system_modes(system)
    lowest = modes.shapes[:, 0] / modes.shapes[system.place("rotor rx"), 0]
    if machine.generator.stiffness == 0:
        assert lowest == pytest.approx(q, rel=1e-9)
    assert q @ system.mass @ q / 2 == pytest.approx(own_energy(machine), rel=1e-12)


def test_the_gates_motion_is_that_of_the_facts() -> None:
    from fe_drivetrain.dynamics.bodies.levels import assembly

    machine = library_machine("nrel_5mw")
    made = assembly(machine, Level.RIGID)
    system = assemble(made.bodies, made.springs, made.superelements)
    assert turning_motion(machine, made, system) == pytest.approx(own_motion(machine, system.names))


def test_frequencies_alone_are_those_of_the_modes() -> None:
    system = machine_system(library_machine("nrel_5mw"), Level.RIGID)
    found, modes = spring_frequencies(system), system_modes(system).frequencies
    assert np.abs(found - modes).max() < 1e-9 * modes.max()


def test_what_a_table_does_not_give_is_stated() -> None:
    said = {row.name: row.source for row in library_machine("park_2021").assumptions()}
    assert "nothing holds its angle" in said["generator: stiffness"]
    assert "2 J / r^2" in said["stage 1 planet: mass"]
    assert "rotor: mass" not in said
    assert "stage 1: dedendum" not in said  # a stage of radii has no rack
    assert "stage 3: fillets" in {row.name for row in library_machine("nrel_5mw").assumptions()}
    stresses = mesh_stresses(library_machine("nrel_5mw"), 1e6, {"stage 3 mesh": LoadFactors()})
    assert "all 1" in stresses["stage 1 sun-planet"].assumed[0]
    assert not any("load factors" in text for text in stresses["stage 3 mesh"].assumed)
    assert any("0.38 modules" in text for text in stresses["stage 3 mesh"].assumed)
    assert not any("tips" in text for text in stresses["stage 3 mesh"].assumed)


def test_gears_without_contact_are_not_rated() -> None:
    short = Gear(27, 0.01, 0.1, tip_diameter=0.278), Gear(80, 0.01, 0.1, tip_diameter=0.808)
    with pytest.raises(InputError, match=r"contact ratio of gears of 27 and 80 teeth is 0\."):
        Pair(*short, 0.535)
    # helical teeth that overlap over the face turn on, and are out of what ISO 6336 rates
    helix = np.radians(20.0)
    one = Gear(27, 0.01, 0.2, helix, tip_diameter=0.296)
    two = Gear(80, 0.01, 0.2, -helix, tip_diameter=0.860)
    pair = Pair(one, two, 0.535 / np.cos(helix))
    assert pair.transverse_ratio < 1 < pair.contact_ratio
    steel = GearMaterial("case-hardened", 1500e6, 430e6)
    with pytest.raises(InputError, match=r"transverse contact ratio .* must be within 1 and 2.5"):
        contact_stress(pair, 1e4, LoadFactors(), (steel, steel))
    with pytest.raises(InputError, match="to be rated by ISO 6336"):
        root_stress(pair, 1e4, LoadFactors())


def test_teeth_too_thick_for_their_distance_are_refused() -> None:
    tips = (0.285, 0.81)
    shifted = [
        Gear(teeth, 0.01, 0.1, shift=0.4, tip_diameter=tip)
        for teeth, tip in zip((27, 80), tips, strict=True)
    ]
    with pytest.raises(InputError, match=r"too thick for their centre distance, by 0\.5"):
        Pair(*shifted, 0.535)


def test_planets_of_a_stage_in_python_do_not_overlap() -> None:
    assert isinstance(plane_stage(LIN_PARKER_STAGE, 5), PlanetarySet)
    with pytest.raises(InputError, match="overlap"):
        plane_stage(LIN_PARKER_STAGE, 6)


@pytest.mark.parametrize("value", [float("nan"), float("inf"), -1.0])
def test_springs_are_finite(value: float) -> None:
    for stiffness, damping in ((value, 0.0), (1.0, value)):
        spring = Spring("s", {"a": np.eye(6)[0]}, stiffness, damping)
        with pytest.raises(InputError, match=r"'s': .* must be a finite number of at least 0"):
            assemble([Body("a", mass=1.0)], [spring])


def test_what_changes_a_rating_must_be_given() -> None:
    with pytest.raises(InputError, match="yield strength of a through-hardened gear material is 0"):
        GearMaterial("through-hardened", 700e6, 290e6)
    with pytest.raises(InputError, match="brinell of a through-hardened"):
        GearMaterial("through-hardened", 700e6, 290e6, yield_strength=1e9)
    with pytest.raises(InputError, match=r"flank_roughness .* above 0 and below 1e-3 m"):
        Running(1e3, 10.0, 220e-6, (4.8, 4.8), (20e-6, 20e-6))
    with pytest.raises(InputError, match="teeth"):
        Gear(24.5, 0.01, 0.1)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="K_A is inf"):
        LoadFactors(K_A=float("inf"))


@pytest.mark.parametrize("value", [True, float("nan"), -1.0])
def test_truth_values_are_no_inertias(value: float) -> None:
    with pytest.raises(InputError, match="finite number"):
        Torsional((Inertia("a", value),), ())
    with pytest.raises(InputError, match="finite number"):
        assemble([Body("a", mass=value)], [])


@pytest.mark.parametrize(
    ("kind", "teeth"), [("worm", (99, 21)), ("planetary", (99, 0)), ("parallel", (True, 21))]
)
def test_stages_of_orders_have_a_kind_and_teeth(kind: str, teeth: tuple[int, int]) -> None:
    with pytest.raises(InputError, match="of a stage"):
        Toothed(kind, teeth)


ROW = {
    "kind": "planetary",
    "planets": 3,
    "carrier": 1.0,
    "planet": 1.0,
    "sun": 1.0,
    "ring_planet": 1e6,
    "sun_planet": 1e6,
}


@pytest.mark.parametrize(
    ("row", "message"),
    [
        ({"teeth": [60, 21], "planet_teeth": 39}, "60 - 39 teeth, planet and sun 39 . 21"),
        ({"teeth": [120, 21], "planet_teeth": 39}, "which must be equal but for profile shifts"),
        ({"teeth": [99, 21], "planets": 9}, "9 planets of 1.857 times .* overlap"),
        ({"ratio": 12.0, "planets": 4}, "4 planets of 5 times"),
        ({"teeth": [10**400, 21]}, "teeth.0 is 1000"),
        ({"ratio": 10**400}, "ratio is 1000"),
        ({"teeth": [99, 21], "sun": True}, "truth value"),
        ({"teeth": [True, 21]}, "truth value"),
        ({"ratio": 5.0, "carrier": 1e12}, "carrier is 1000000000000.0 but must be at most"),
    ],
)
def test_gear_tables_refuse_planets_that_do_not_fit(row: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        PlanetaryStage.model_validate(ROW | row)


def test_gear_tables_state_what_they_assume() -> None:
    rows = {row.name: row for row in published.table("drivetrain_b").assumptions()}
    assert "127 + 27 teeth, are no multiple of 3" in rows["stage 1: angles of planets"].source
    of_machine = machine_of(published.drivetrain("drivetrain_b")).assumptions()
    assert "stage 1: angles of planets" in {row.name for row in of_machine}
    assert rows["stage 2: sun_planet_damping"].value == 0.0
    assert "stage 1: angles of planets" not in {
        row.name for row in published.table("drivetrain_c").assumptions()
    }


def test_gear_tables_name_a_kind_that_is_none_and_numbers_beyond_reason() -> None:
    data = published.table("drivetrain_b").model_dump(mode="json", exclude_none=True)
    with pytest.raises(InputError, match=r"stage 1: kind is .'planetary'. but must be one of"):
        GearTable.model_validate(data | {"stages": [{**data["stages"][0], "kind": ["planetary"]}]})
    file = mutations.plain(published.drivetrain("drivetrain_b"))
    with pytest.raises(InputError, match="is too large for a number"):
        parse_drivetrain(mutations.as_text(file).replace("127", "9" * 400))
    data["shafts"][1]["stiffness"] = 1e-300
    with pytest.raises(InputError, match="shaft 1-2 has 1e-300 N m/rad"):
        GearTable.model_validate(data)


def test_slips_of_another_seed_are_refused_or_right(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(mutations, "SEED", 7)
    rows = mutations.slips(FILES, 16, mutations.try_machine)
    assert not [row for row in rows if row["wrong"]]
    assert 0 < sum(bool(row["taken"]) for row in rows) < len(rows)


def test_facts_see_what_the_gate_refuses() -> None:
    data = changed("park_2021", TEETH | {"stages.0.teeth": planetary(60, 39, 21)})
    broken = {fact.name for fact in machine_facts(MachineTable.model_validate(data))}
    wrong = {f.name for f in machine_facts(MachineTable.model_validate(data)) if not f.holds}
    assert "rigid bodies: turning at the ratio of the teeth winds no spring" in wrong
    assert len(wrong) < len(broken)
