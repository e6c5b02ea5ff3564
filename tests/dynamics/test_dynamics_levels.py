"""One drivetrain at several levels: the torsional tables come back, statics are those of torque."""

import numpy as np
import pytest

from fe_drivetrain.cases.references import published_drivetrains as published
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.gear_stages import PlanetaryData
from fe_drivetrain.dynamics.bodies.bodies import assemble
from fe_drivetrain.dynamics.bodies.levels import (
    Level,
    assembly,
    azimuths,
    machine_system,
    planetary_set,
    steady_load,
    torsional,
)
from fe_drivetrain.dynamics.bodies.machine import MACHINES, Machine, library_machine
from fe_drivetrain.dynamics.bodies.machine_shafts import shaft_slices
from fe_drivetrain.dynamics.bodies.modes import system_modes, turning_modes
from fe_drivetrain.dynamics.bodies.springs import Place, bushing
from fe_drivetrain.dynamics.bodies.static import over_a_turn, static
from fe_drivetrain.dynamics.bodies.system import System, with_proportional_damping, without_massless
from fe_drivetrain.dynamics.torsion.gear_table import (
    GearTable,
    PlanetaryStage,
    gear_masses,
    gear_speeds,
    stage_masses,
)
from fe_drivetrain.dynamics.torsion.system import natural_modes
from fe_drivetrain.gear.planets import check_assembly

C, GRC, PARK, FIVE_MW = (
    library_machine(n) for n in ("synthetic_2mw", "nrel_750kw", "park_2021", "nrel_5mw")
)


def with_light_planets(machine: Machine) -> Machine:
    """Planets without mass, whose carrier's inertia is as tabled."""
    data = machine.model_dump(exclude_none=True)
    for stage in data["stages"]:
        if stage["kind"] == "planetary":
            stage["planet"]["mass"] = 0.0
    return Machine.model_validate(data)


def held_system(machine: Machine, tilt: float, move: float) -> System:
    """The rigid level with every body held across and against tilt, too [N m/rad, N/m]."""
    made = assembly(machine, Level.RIGID)
    springs = list(made.springs)
    for body in made.bodies:
        if {"ux", "ry"} <= body.free:
            place = Place(body.name, body.position)
            held = (move, move, move, 0, tilt, tilt)
            if "planet" in body.name:
                held = (0, 0, 0, 0, tilt, tilt)
            springs += bushing(f"{body.name} held", place, None, body.position, held)
    return without_massless(assemble(made.bodies, springs))


def test_the_torsional_level_is_the_standing_table_of_c() -> None:
    table = published.table("drivetrain_c")
    expected = natural_modes(gear_masses(table, "free")).frequencies
    found = natural_modes(torsional(with_light_planets(C))).frequencies
    assert np.allclose(found[1:], expected[1:], rtol=2e-14)


def test_the_torsional_level_is_the_standing_table_of_d_with_its_teeth() -> None:
    table = published.table("nrel_750kw")
    data = table.model_dump(exclude_none=True)
    for stage, teeth in zip(data["stages"], ((99, 21), (82, 23), (88, 22)), strict=True):
        del stage["ratio"]
        stage["teeth"] = teeth
    with_teeth = type(table).model_validate(data)
    expected = natural_modes(gear_masses(with_teeth, "fixed")).frequencies
    found = natural_modes(torsional(with_light_planets(GRC))).frequencies
    assert np.allclose(found, expected, rtol=1e-12)


def test_profile_shifted_planets_of_the_5_mw_gearbox_have_their_own_teeth() -> None:
    # 19, 17 and 56 teeth: 17 is not half of 56 - 19
    data = with_light_planets(FIVE_MW).model_dump(exclude_none=True)
    for shaft, given in zip(data["shafts"], FIVE_MW.shafts, strict=True):
        shaft.pop("outer", None)
        shaft.pop("sections", None)
        shaft["torsion"] = (
            8.0e10 * shaft_slices(given, 0.0, given.length)[0].section.torsion / given.length
        )
    machine = Machine.model_validate(data)
    stages = []
    for stage in machine.stages:
        if isinstance(stage, PlanetaryData):
            assert stage.teeth is not None
            ring, planet, sun = stage.teeth
            base = (stage.centre_distance - stage.sun_radius) * np.cos(
                stage.meshes[0].pressure_angle
            )
            stages.append(
                {
                    "kind": "planetary",
                    "teeth": [ring, sun],
                    "planet_teeth": planet,
                    "planets": stage.planets,
                    "carrier": stage.carrier.inertia,
                    "planet": stage.planet.inertia,
                    "sun": stage.sun.inertia,
                    "ring_planet": stage.ring_planet * base**2,
                    "sun_planet": stage.sun_planet * base**2,
                }
            )
        else:
            mesh = stage.meshing
            base = stage.gear_radius * np.cos(mesh.pressure_angle) * np.cos(mesh.base_helix)
            stages.append(
                {
                    "kind": "parallel",
                    "teeth": list(stage.teeth or ()),
                    "gear": stage.gear.inertia,
                    "pinion": stage.pinion.inertia,
                    "mesh": stage.stiffness * base**2,
                }
            )
    table = GearTable.model_validate(
        {
            "title": "5 MW",
            "rotor": machine.rotor.inertia,
            "shafts": [{"name": s.name, "stiffness": s.torsion} for s in machine.shafts],
            "stages": stages,
            "generator": {"inertia": machine.generator.inertia},
        }
    )
    masses = gear_masses(table, "free")
    found = natural_modes(torsional(machine)).frequencies
    assert np.allclose(natural_modes(masses).frequencies[1:], found[1:], rtol=1e-12)
    speeds = gear_speeds(table)
    turning = np.array([speeds[part] for part in masses.names])
    assert np.abs(masses.B @ turning).max() < 1e-12 * np.abs(turning).max()
    assert speeds["stage 1 planet 1"] == pytest.approx(-(56 - 17) / 17, rel=1e-14)
    del stages[0]["planet_teeth"]
    table = GearTable.model_validate(table.model_dump(exclude_none=True) | {"stages": stages})
    halved = natural_modes(gear_masses(table, "free")).frequencies
    assert np.abs(halved[1:] / found[1:] - 1).max() > 0.01


def test_teeth_of_planets_that_do_not_fit_are_refused() -> None:
    row = {
        "planets": 3,
        "carrier": 1.0,
        "planet": 1.0,
        "sun": 1.0,
        "ring_planet": 1.0,
        "sun_planet": 1.0,
    }
    with pytest.raises(InputError, match=r"fewer than the ring, 56; .* they have about 18"):
        PlanetaryStage.model_validate(row | {"teeth": [56, 19], "planet_teeth": 60})
    with pytest.raises(InputError, match="ring and sun have a ratio alone"):
        PlanetaryStage.model_validate(row | {"ratio": 5.0, "planet_teeth": 39})


def test_the_torsional_level_of_park() -> None:
    # the reference spectrum, pressure angle 20 deg on all meshes, carrier as tabled
    found = natural_modes(torsional(with_light_planets(PARK))).frequencies
    in_step = [0, 1.8626, 55.75, 207.59, 263.69, 445.29, 664.19, 768.08]
    apart = found[4:6] if abs(found[4] - found[5]) < 1e-6 else found[5:7]
    assert abs(apart[1] - apart[0]) < 1e-6  # planets against each other, twice
    others = np.array([f for f in found if abs(f - apart[0]) > 1e-3])
    assert np.abs(others - in_step).max() < 6e-3


def test_held_bodies_recover_the_torsional_spectrum() -> None:
    machine = with_light_planets(C)
    expected = natural_modes(torsional(machine)).frequencies
    errors = []
    for stiff in (1e12, 1e14):
        system = held_system(with_stiff_pins(machine, stiff), stiff, stiff)
        own = system_modes(system)
        energy = own.shapes * (system.mass @ own.shapes)
        turning = np.array([n.endswith("rx") for n in system.names])
        kept = own.frequencies[energy[turning].sum(axis=0) > 0.99]
        errors.append(np.abs(kept[1:10] / expected[1:10] - 1).max())
    # of first order in the mesh's stiffness over that of what holds
    assert errors[1] < 1e-4
    assert errors[1] / errors[0] == pytest.approx(0.01, rel=0.1)


def with_stiff_pins(machine: Machine, stiffness: float) -> Machine:
    data = machine.model_dump(exclude_none=True)
    for stage in data["stages"]:
        for pin in stage.get("pins", ()):
            pin["stiffness"] = [stiffness, stiffness, stiffness, 0, 0, 0]
        if stage["kind"] == "planetary":
            stage["planet"]["mass"] = 1.0
            stage["carrier"]["inertia"] -= 3 * stage["centre_distance"] ** 2
    return Machine.model_validate(data)


@pytest.mark.parametrize("name", MACHINES)
def test_every_level_turns_as_freely_as_its_generator(name: str) -> None:
    machine = library_machine(name)
    free = 0 if machine.generator.stiffness else 1
    for level in (Level.TORSIONAL, Level.RIGID):
        system = machine_system(machine, level)
        modes = system_modes(system)
        assert (modes.frequencies < 1e-3).sum() == free
        assert np.abs(modes.strain_shares.sum(axis=0)[free:] - 1).max() < 1e-6


def test_the_free_motion_turns_every_gear_at_its_ratio() -> None:
    modes = system_modes(machine_system(C, Level.RIGID))
    shape = modes.shapes[:, 0] / modes.shapes[modes.names.index("rotor rx"), 0]
    for body, ratio in (("stage 1 sun", 6), ("stage 2 pinion", -24), ("generator", C.speeds[-1])):
        assert shape[modes.names.index(f"{body} rx")] == pytest.approx(ratio, rel=1e-6)


def test_an_other_azimuth_leaves_the_frequencies() -> None:
    one, two = (
        system_modes(machine_system(C, Level.RIGID, azimuth)).frequencies for azimuth in (0.0, 0.4)
    )
    assert np.allclose(one[1:], two[1:], rtol=1e-6)


def test_flexible_shafts_are_softer_and_settle_with_elements() -> None:
    rigid, six, twelve = (
        system_modes(machine_system(FIVE_MW, level, elements=n)).frequencies[1:30]
        for level, n in ((Level.RIGID, 1), (Level.FLEXIBLE, 6), (Level.FLEXIBLE, 12))
    )
    first = np.abs(six / rigid - 1).max()
    assert np.abs(twelve / six - 1).max() < 0.2 * first


def statics(machine: Machine, torque: float) -> tuple[System, np.ndarray]:
    system = machine_system(machine, Level.RIGID, held_generator=True)
    return system, np.asarray(system.load_on("rotor", np.array([0, 0, 0, torque, 0, 0])))


def test_mesh_forces_are_those_of_the_torque() -> None:
    torque = 1.0e6
    system, load = statics(C, torque)
    found = static(system, load)
    shares = [found.force(f"stage 1 sun-planet {k}") for k in (1, 2, 3)]
    stage = C.stages[0]
    assert isinstance(stage, PlanetaryData)
    mesh = stage.meshes[0]
    base = stage.sun_radius * np.cos(mesh.pressure_angle) * np.cos(mesh.base_helix)
    assert sum(shares) == pytest.approx(torque / C.speeds[1] / base, rel=1e-3)
    assert min(shares) > 0
    ring = sum(found.force(f"stage 1 ring-planet {k}") for k in (1, 2, 3))
    assert ring == pytest.approx(sum(shares), rel=1e-3)  # planets are in balance
    housing = system.rows.T @ found.forces - load
    assert np.abs(housing).max() < 1e-6 * torque


def test_meshes_of_park_carry_the_torque_of_the_table() -> None:
    system, load = statics(PARK, 15e3)
    found = static(system, load)
    cosine = np.cos(np.radians(20.0))
    for mesh, tangential in (("stage 2 mesh", 10536.0), ("stage 3 mesh", 5411.0)):
        assert found.force(mesh) * cosine == pytest.approx(tangential, abs=0.51)
    shares = [found.force(f"stage 1 sun-planet {k}") * cosine for k in (1, 2, 3)]
    assert np.mean(shares) == pytest.approx(9259.0, abs=0.51)


def test_ring_and_sun_take_their_shares_of_the_torque() -> None:
    torque = 1e6
    system, load = statics(C, torque)
    found = static(system, load)
    stage = planetary_set(C, 1)
    torques = {"ring": 0.0, "sun": 0.0}
    for spring, force in zip(
        assembly(C, Level.RIGID, held_generator=True).springs, found.forces, strict=True
    ):
        for part in torques:
            if "-planet" in spring.name and f"stage 1 {part}" in spring.by:
                torques[part] += float(spring.by[f"stage 1 {part}"][3] * force)
    assert abs(torques["ring"]) == pytest.approx(torque * (stage.ratio - 1) / stage.ratio, rel=1e-9)
    assert abs(torques["sun"]) == pytest.approx(torque / stage.ratio, rel=1e-9)


def test_rigid_meshes_are_the_model_of_one_mass_a_stage() -> None:
    data = with_light_planets(C).model_dump(exclude_none=True)
    for stage in data["stages"]:
        for key in ("ring_planet", "sun_planet", "stiffness"):
            if key in stage:
                stage[key] *= 1e6
        if stage["kind"] == "planetary":
            stage["planet"]["inertia"] = 1e-3  # the stage model has none of its planets' own
    found = natural_modes(torsional(Machine.model_validate(data))).frequencies
    expected = natural_modes(stage_masses(published.table("drivetrain_c"), "free")).frequencies
    assert np.allclose(found[1:5], expected[1:], rtol=1e-4)


def test_damping_in_proportion_to_the_stiffness() -> None:
    system = with_proportional_damping(machine_system(GRC, Level.RIGID), 1e-5)
    damped, modes = turning_modes(system), system_modes(system)
    assert np.allclose(damped.frequencies[:10], modes.frequencies[:10], rtol=1e-4)
    assert np.allclose(damped.ratios[:10], np.pi * 1e-5 * modes.frequencies[:10], rtol=1e-4)
    with pytest.raises(InputError, match="at least 0 s"):
        with_proportional_damping(system, -1.0)


def test_loads_over_a_turn_shift_by_a_third() -> None:
    def at(azimuth: float) -> System:
        return machine_system(C, Level.RIGID, azimuth, held_generator=True)

    def loads(system: System) -> np.ndarray:
        return steady_load(C, system, 1.055e6, np.array([0, 0, 0, 0, 3e5, 0.0]))

    turn = over_a_turn(at, loads, azimuths(6))
    one, two = (turn.resultant(f"stage 1 pin {k} upwind") for k in (1, 2))
    assert np.allclose(np.roll(one, -2), two, rtol=1e-6)
    assert turn.amplitudes(one)[1] > 0.01 * one.mean()


def test_stages_that_cannot_be_put_together_are_refused() -> None:
    refused = []
    for letter in "abc":
        table = published.table(f"drivetrain_{letter}")
        for number, stage in enumerate(table.stages, start=1):
            if isinstance(stage, PlanetaryStage) and stage.teeth:
                ring, sun = stage.teeth
                try:
                    check_assembly("stage", sun, ring, stage.planets)
                except InputError:
                    refused.append((letter, number))
    assert refused == [("a", 1), ("b", 1), ("b", 2)]
    data = C.model_dump(exclude_none=True)
    data["stages"][0]["teeth"] = (122, 49, 24)
    with pytest.raises(InputError, match=r"24 \+ 122 = 146, must be a multiple of 3"):
        Machine.model_validate(data)


def test_faults_of_a_table_are_one_sentence() -> None:
    data = C.model_dump(exclude_none=True)
    data["shafts"] = data["shafts"][:-1]
    with pytest.raises(InputError, match="one shaft more than stages"):
        Machine.model_validate(data)
    data = C.model_dump(exclude_none=True)
    data["shafts"][0]["outer"] = 0.4
    with pytest.raises(InputError, match="not several of them"):
        Machine.model_validate(data)
    with pytest.raises(InputError, match="use one of"):
        library_machine("unknown")
    with pytest.raises(InputError, match="without teeth"):
        _ = PARK.meshing


def test_what_has_no_mass_is_eliminated_exactly() -> None:
    made = assembly(GRC, Level.FLEXIBLE, elements=3)
    whole = assemble(made.bodies, made.springs)
    short = without_massless(whole)
    assert len(short.names) < len(whole.names)
    load = whole.load_on("rotor", np.array([0, 1e4, 0, 0, 0, 0.0]))
    q = np.linalg.solve(whole.K, load)
    kept = [whole.names.index(n) for n in short.names]
    assert np.allclose(np.linalg.solve(short.K, load[kept]), q[kept], rtol=1e-6, atol=1e-12)
