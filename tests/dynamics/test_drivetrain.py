"""Torsional systems and drivetrains from a table: exact answers, invariances, energy, messages."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from fe_drivetrain.cases.references import published_drivetrains as published
from fe_drivetrain.cases.references.independent_torsion import (
    certified,
    holzer_frequencies,
    inverse_squares,
    modes_below,
    two_mass_frequencies,
)
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.comparison.tolerances import digit
from fe_drivetrain.drivetrain_file import parse_drivetrain, read_drivetrain
from fe_drivetrain.dynamics import gear_table, machine_of, torsional
from fe_drivetrain.dynamics.torsion.damping import mesh_damping, shaft_damping
from fe_drivetrain.dynamics.torsion.gear_table import (
    GENERATOR,
    ROTOR,
    gear_masses,
    gear_speeds,
    stage_masses,
    two_masses,
)
from fe_drivetrain.dynamics.torsion.system import (
    Element,
    Inertia,
    Torsional,
    chain,
    changed,
    damped,
    damped_modes,
    frequency_bands,
    modal_damping,
    natural_modes,
    referred,
    relative_sensitivities,
    response,
    static_stiffness,
)
from fe_drivetrain.report.suite.case import find_cases
from fe_drivetrain.report.suite.run import Run

NAMES = ("nrel_750kw", "drivetrain_a", "drivetrain_b", "drivetrain_c")
MODELS = (two_masses, stage_masses, gear_masses)


def random_chain(n=6, seed=0, ground=False):
    """A chain over eight orders of magnitude of inertia."""
    rng = np.random.default_rng(seed)
    parts = [Inertia(f"J{i}", float(10 ** rng.uniform(-2, 6))) for i in range(n)]
    shafts = [
        (f"k{i}", float(10 ** rng.uniform(4, 9)), float(10 ** rng.uniform(0, 3)))
        for i in range(n - 1)
    ]
    return chain(parts, shafts, ("ground", 1e6, 10.0) if ground else None)


@pytest.fixture(scope="module")
def table():
    return published.table("nrel_750kw")


def test_two_masses_are_the_quadratic():
    system = chain([Inertia("a", 9.0), Inertia("b", 4.0)], [("k", 50.0, 0.0)], ("g", 7.0, 0.0))
    assert_allclose(
        natural_modes(system).frequencies, two_mass_frequencies(9.0, 4.0, 50.0, 7.0), rtol=1e-13
    )


@pytest.mark.parametrize("ground", [False, True])
@pytest.mark.parametrize("seed", range(5))
def test_chains_have_the_frequencies_of_holzers_table(seed, ground):
    system = random_chain(seed=seed, ground=ground)
    k = [e.stiffness for e in system.elements]
    exact = holzer_frequencies(system.J, k[:5], k[5] if ground else 0.0)
    found = natural_modes(system).frequencies
    assert_allclose(found[found > 0], exact, rtol=1e-8)
    assert np.sum(found == 0) == (0 if ground else 1)


def test_uniform_chain_has_the_closed_form():
    n = 8
    system = chain(
        [Inertia(f"{i}", 2.0) for i in range(n)], [(f"k{i}", 3.0, 0.0) for i in range(n - 1)]
    )
    exact = 2 * np.sqrt(3.0 / 2.0) * np.sin(np.arange(n) * np.pi / (2 * n)) / (2 * np.pi)
    assert_allclose(natural_modes(system).frequencies, exact, rtol=1e-12)


def test_free_turning_is_exactly_zero_and_all_masses_take_part():
    modes = natural_modes(random_chain())
    assert modes.frequencies[0] == 0.0
    assert_allclose(modes.to_one[:, 0], 1.0, rtol=1e-9)
    assert np.all(modes.stiffness_shares[:, 0] == 0.0)


def test_low_frequency_keeps_its_digits_beside_a_stiff_one():
    # eigenvalues of K would leave 1e-16 * 1e18 of 1
    soft, stiff = 1.0, 1e18
    system = chain(
        [Inertia("a", 1.0), Inertia("b", 0.5), Inertia("c", 0.5)],
        [("soft", soft, 0.0), ("stiff", stiff, 0.0)],
    )
    assert_allclose(natural_modes(system).frequencies[1], np.sqrt(2.0) / (2 * np.pi), rtol=1e-6)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("model", MODELS)
def test_modes_are_those_of_mass_and_stiffness(name, model):
    system = model(published.table(name), "free")
    modes = natural_modes(system)
    omega = 2 * np.pi * modes.frequencies
    shapes = modes.shapes
    assert_allclose(shapes.T @ system.M @ shapes, np.eye(len(omega)), atol=1e-9)
    stiffness = shapes.T @ system.K @ shapes
    assert_allclose(stiffness, np.diag(omega**2), atol=1e-9 * omega.max() ** 2)
    assert_allclose(modes.inertia_shares.sum(axis=0), 1.0, rtol=1e-9)
    assert_allclose(modes.stiffness_shares.sum(axis=0), omega > 0, rtol=1e-9)
    # angular momentum at the rotor's ratios: none in what swings
    if model is gear_masses:
        speeds = gear_speeds(published.table(name))
        momentum = np.array([speeds[n] for n in system.names]) @ system.M @ shapes
    else:
        momentum = np.ones(len(omega)) @ system.M @ shapes
    assert_allclose(momentum[1:] / abs(momentum[0]), 0.0, atol=1e-9)


@pytest.mark.parametrize("name", NAMES)
def test_exact_counting_finds_every_mode_of_every_gear(name):
    system = gear_masses(published.table(name), "free")
    frequencies = natural_modes(system).frequencies
    assert certified(system, frequencies) == 0
    assert certified(system, frequencies * (1 + 1e-6)) == len(frequencies) - 1


def test_exact_counting_counts():
    system = chain([Inertia("a", 1.0), Inertia("b", 1.0)], [("k", 2.0, 0.0)], ("g", 1.0, 0.0))
    low, high = natural_modes(system).frequencies
    assert [modes_below(system, f) for f in (0.5 * low, 0.5 * (low + high), 2 * high)] == [0, 1, 2]


def test_a_spring_more_raises_frequencies_but_not_beyond_the_next(table):
    for model in MODELS:
        free = natural_modes(model(table, "free")).frequencies
        fixed = natural_modes(model(table, "fixed")).frequencies
        assert np.all(fixed >= free * (1 - 1e-12))
        assert np.all(fixed[:-1] <= free[1:] * (1 + 1e-12))


def test_inverse_squares_are_the_trace(table):
    for model in MODELS:
        system = model(table, "fixed")
        omega = 2 * np.pi * natural_modes(system).frequencies
        assert_allclose(np.sum(omega**-2.0), inverse_squares(system), rtol=1e-8)


def test_ratios_are_a_change_of_coordinates(table):
    system = gear_masses(table, "fixed")
    seen = referred(system, gear_speeds(table))
    assert_allclose(natural_modes(seen).frequencies, natural_modes(system).frequencies, rtol=1e-10)
    # seen from the rotor, all angles of free turning are one
    free = referred(gear_masses(table, "free"), gear_speeds(table))
    assert_allclose(natural_modes(free).to_one[:, 0], 1.0, rtol=1e-9)
    assert_allclose(free.K @ np.ones(len(free.J)), 0.0, atol=1e-14 * free.K.max())


def test_five_masses_are_the_gears_with_rigid_meshes(table):
    system = gear_masses(table, "fixed")
    rigid = changed(
        system, {e.name: 1e8 * e.stiffness for e in system.elements if "stage" in e.name}
    )
    stages = stage_masses(table)
    planetary = table.stages[0]
    planets = planetary.planets * planetary.planet * planetary.planet_speed**2
    stages = changed(stages, {"stage 1": float(stages.J[1] + planets)})
    assert_allclose(
        natural_modes(rigid).frequencies[:5], natural_modes(stages).frequencies, rtol=1e-5
    )


def test_published_five_masses(table):
    # Al-Hamadani 2018, Table 6.1: to half of the last printed digit and 0.1 % of three-digit inputs
    found = natural_modes(stage_masses(table)).frequencies
    assert_allclose(found[[0, 1, 4]], [0.864, 5.889, 1974.0], rtol=2e-3)
    assert_allclose(natural_modes(two_masses(table, "free")).frequencies[1], 2.524, rtol=1e-3)


def test_drivetrain_a_is_as_published():
    # Al-Hamadani 2018, Table 6.4, whose inputs have three figures: 0.2 % of a frequency
    modes = natural_modes(gear_masses(published.table("drivetrain_a"), "free"))
    printed = [float(v) for v in published.OTHERS["A"]]
    assert_allclose(modes.frequencies[published.observable(modes)], printed, rtol=2e-3)


def test_stiffness_between_rotor_and_held_generator_is_the_series(table):
    assert_allclose(
        static_stiffness(stage_masses(table, "free"), ROTOR, GENERATOR),
        two_masses(table).k[0],
        rtol=1e-12,
    )
    with pytest.raises(InputError, match="meets no stiffness"):
        static_stiffness(Torsional((Inertia("a", 1.0), Inertia("b", 1.0)), ()), "a", "b")
    with pytest.raises(InputError, match="meets no stiffness"):
        static_stiffness(stage_masses(table), ROTOR, ROTOR)
    loose = Torsional(
        (Inertia("a", 1.0), Inertia("b", 1.0), Inertia("c", 1.0)),
        (Element("k", {"a": 1.0, "b": -1.0}, 2.0),),
    )
    with pytest.raises(InputError, match="meets no stiffness"):
        static_stiffness(loose, "a", "b")


def test_sensitivities_are_the_derivatives(table):
    system = gear_masses(table, "fixed")
    step = 1e-5
    simple = [0, 1, 2, 3, 4, 5, 8, 9, 10]  # not the two equal ones
    for name, found in relative_sensitivities(system).items():
        value = dict(
            [(p.name, p.inertia) for p in system.inertias]
            + [(e.name, e.stiffness) for e in system.elements]
        )[name]
        ahead, behind = (
            natural_modes(changed(system, {name: value * (1 + s)})).frequencies
            for s in (step, -step)
        )
        slope = np.log(ahead / behind) / (2 * step)
        # one planet made different from the others parts the two equal modes only
        assert_allclose(found[simple], slope[simple], atol=1e-6)


def test_sensitivities_add_up(table):
    # all stiffnesses and inertias times the same number leave every frequency
    for model in MODELS:
        total = sum(relative_sensitivities(model(table, "free")).values())
        assert_allclose(total, 0.0, atol=1e-9)


def test_bands_are_of_first_order(table):
    system = stage_masses(table)
    band = frequency_bands(system, {"LSS": 0.01})
    ends = [
        natural_modes(changed(system, {"LSS": system.k[0] * s})).frequencies for s in (0.99, 1.01)
    ]
    assert_allclose(band, (ends[1] - ends[0]) / 2, rtol=1e-2)
    assert_allclose(
        frequency_bands(system, {"LSS": 0.01, ROTOR: 0.02}),
        band + frequency_bands(system, {ROTOR: 0.02}),
        rtol=1e-12,
    )
    with pytest.raises(InputError, match="no part 'ISS'"):
        frequency_bands(system, {"ISS": 0.1})


def test_damped_eigenvalues_make_the_dynamic_stiffness_singular():
    system = random_chain(ground=True)
    found = damped_modes(system)
    assert len(found.eigenvalues) * 2 + len(found.creeping) == 12
    root = np.sqrt(system.J)
    for value in [*found.eigenvalues, *found.creeping]:
        matrix = value**2 * system.M + value * system.C + system.K
        scaled = matrix / np.outer(root, root)
        singular = np.linalg.svd(scaled, compute_uv=False)
        assert singular[-1] < 1e-9 * singular[0]


def test_single_oscillator_is_damped_by_its_ratio():
    k, J = 5e4, 3.0
    for ratio in (0.0, 1e-7, 0.006, 0.9):
        c = shaft_damping(ratio, J, k)
        found = damped_modes(chain([Inertia("a", J)], [], ("g", k, c)))
        assert_allclose(found.ratios, [ratio], atol=1e-12)
        assert_allclose(
            found.frequencies, np.sqrt(k / J * (1 - ratio**2)) / (2 * np.pi), rtol=1e-12
        )
    heavy = damped_modes(chain([Inertia("a", J)], [], ("g", k, shaft_damping(2.0, J, k))))
    omega = np.sqrt(k / J)
    assert len(heavy.eigenvalues) == 0
    assert_allclose(heavy.creeping, -omega * np.array([2 + np.sqrt(3), 2 - np.sqrt(3)]), rtol=1e-10)


def test_damping_in_proportion_to_stiffness_rises_with_the_frequency(table):
    system = gear_masses(table, "fixed")
    beta = 1e-7
    system = damped(system, {e.name: beta * e.stiffness for e in system.elements})
    modes = natural_modes(system)
    expected = beta * np.pi * modes.frequencies
    assert_allclose(modal_damping(system), expected, rtol=1e-9)
    assert_allclose(damped_modes(system).ratios, expected, rtol=1e-7)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("model", MODELS)
def test_dampers_of_a_table_are_seen_from_the_rotor_as_its_springs_are(name, model):
    """Damping in proportion to stiffness, row by row, is so in every model: C = beta K."""
    beta = 1e-4
    data = published.table(name).model_dump()
    for shaft in data["shafts"]:
        shaft["damping"] = beta * shaft["stiffness"]
    data["generator"]["stiffness"] = data["generator"]["stiffness"] or 1e6
    data["generator"]["damping"] = beta * data["generator"]["stiffness"]
    for stage in data["stages"]:
        for mesh in ("mesh", "ring_planet", "sun_planet"):
            if mesh in stage:
                stage[f"{mesh}_damping"] = beta * stage[mesh]
    system = model(type(published.table(name)).model_validate(data), "fixed")
    size = np.sqrt(np.outer(np.diag(system.K), np.diag(system.K)))
    assert_allclose(system.C / size, beta * system.K / size, atol=1e-14 * beta)


def test_free_turning_has_no_damping_ratio(table):
    assert np.isnan(modal_damping(gear_masses(table, "free"))[0])
    assert len(damped_modes(gear_masses(table, "free")).eigenvalues) == 10


def test_mesh_damping_is_of_the_two_gears_against_each_other():
    J1, J2, k, ratio, gear = 30.0, 0.4, 5e7, 0.1, 3.5
    c = mesh_damping(ratio, k, J1, J2, gear)
    system = Torsional(
        (Inertia("gear", J1), Inertia("pinion", J2)),
        (Element("mesh", {"gear": 1.0, "pinion": 1 / gear}, k, c),),
    )
    assert_allclose(damped_modes(system).ratios, [ratio], rtol=1e-10)
    # the other gear held: the one that is left
    assert_allclose(mesh_damping(ratio, k, J1, 1e15, gear), shaft_damping(ratio, J1, k), rtol=1e-9)


def test_response_is_reciprocal_and_static_at_rest(table):
    system = gear_masses(table, "fixed")
    frequencies = [0.3, 7.0, 200.0]
    a, b = system.place(ROTOR), system.place(GENERATOR)
    assert_allclose(
        response(system, ROTOR, frequencies)[:, b],
        response(system, GENERATOR, frequencies)[:, a],
        rtol=1e-9,
    )
    still = response(system, ROTOR, [1e-6])[0, a]
    # from rotor to ground: the drivetrain and the generator's spring, one after the other
    drive = static_stiffness(gear_masses(table, "free"), ROTOR, GENERATOR)
    ground = table.speeds[-1] ** 2 * table.generator.stiffness
    assert_allclose(still.real, 1 / drive + 1 / ground, rtol=1e-8)


def test_what_a_torque_puts_in_is_what_dampers_take_out(table):
    """Mean powers of a harmonic motion; and at resonance it lags by a quarter of a period."""
    system = gear_masses(table, "fixed")
    system = damped(system, {e.name: 1e-5 * e.stiffness for e in system.elements})
    frequencies = np.array([0.3, 2.0, 9.0, 40.0, 300.0])
    omega = 2 * np.pi * frequencies
    theta = response(system, ROTOR, frequencies)
    put_in = 0.5 * (1j * omega * theta[:, system.place(ROTOR)]).real
    c = np.array([e.damping for e in system.elements])
    taken_out = 0.5 * omega**2 * (np.abs(theta @ system.B.T) ** 2 @ c)
    assert_allclose(put_in, taken_out, rtol=1e-6)
    one = chain([Inertia("a", 2.0)], [], ("g", 50.0, 0.3))
    assert_allclose(response(one, "a", 5.0 / (2 * np.pi)), [[1 / (0.3 * 5.0j)]], rtol=1e-9)


DIRECT = """
title: direct drive
rotor: {inertia: 5.0}
shaft: {name: s, torsion: 80.0}
generator: {inertia: 3.0}
"""


def test_direct_drive_has_no_stages():
    table = gear_table(parse_drivetrain(DIRECT))
    exact = np.sqrt(80 * (1 / 5 + 1 / 3)) / (2 * np.pi)
    for model in MODELS:
        assert_allclose(natural_modes(model(table, "free")).frequencies, [0, exact], rtol=1e-12)


def test_teeth_give_the_ratio_and_gears_turn_without_winding():
    for name in NAMES:
        table = published.table(name)
        system, speeds = gear_masses(table, "free"), gear_speeds(table)
        turning = np.array([speeds[n] for n in system.names])
        assert_allclose(system.B @ turning, 0.0, atol=1e-12)
        assert abs(speeds[GENERATOR]) == pytest.approx(table.speeds[-1], rel=1e-12)
    # Table 4.1 has 1:115
    assert published.table("drivetrain_b").speeds[-1] == pytest.approx(115, rel=0.005)


def test_number_of_planets_does_not_matter_where_they_share(table):
    # three planets as one of three times the inertia and stiffness: what shafts feel is the same
    one = published.with_values(
        table,
        {"stages.0.planets": 1}
        | {
            f"stages.0.{key}": 3 * getattr(table.stages[0], key)
            for key in ("planet", "ring_planet", "sun_planet")
        },
    )
    modes = natural_modes(gear_masses(table))
    assert_allclose(
        natural_modes(gear_masses(one)).frequencies,
        modes.frequencies[published.observable(modes)],
        rtol=1e-9,
    )


def test_digits_are_those_of_the_print():
    assert [digit(v) for v in ("3.69e7", "998138", "0.40", "1.54E+9")] == pytest.approx(
        [1e5, 1.0, 0.01, 1e7], rel=1e-12
    )
    inputs = dict(published.printed_inputs("drivetrain_a"))
    assert inputs["stages.1.carrier"] == "871.4"
    assert inputs["shafts.0.stiffness"] == "9.30e9"
    assert not any("teeth" in key or "planets" in key for key in inputs)


GOOD = """
title: t
rotor: {inertia: 100.0}
shaft: {name: low, torsion: 1e6}
gearbox:
  stages:
    - {kind: parallel, ratio: 3.0, gear: {inertia: 2.0}, pinion: {inertia: 0.5},
       stiffness_of: axis, stiffness: 1e7, damping: 10.0}
  shafts: [{name: high, torsion: 1e5, damping: 2.0}]
generator: {inertia: 4.0}
"""


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("inertia: 100.0", "inertia: -1", "rotor: .*inertia is -1 but must be at least 1e-09"),
        ("rotor: {inertia: 100.0}\n", "", "does not state its rotor"),
        ("ratio: 3.0", "ratio: 0.5", "ratio is 0.5 but must be greater"),
        ("ratio: 3.0", "ratio: 3.0, teeth: {gear: 60, pinion: 20}", "one of teeth, radii and"),
        ("ratio: 3.0, ", "", "one of teeth, radii and ratio, not none"),
        ("kind: parallel", "kind: worm", "kind is 'worm' but must be one of planetary"),
        ("stiffness: 1e7", "stifness: 1e7", "unknown key 'stifness'.*did you mean 'stiffness'"),
        ("stiffness: 1e7, ", "", "damping of a mesh is 10 but its stiffness is not given"),
        ("stiffness_of: axis, ", "", "needs stiffness_of"),
        ("inertia: 2.0", "inertia: true", "truth value"),
        ("inertia: 2.0", "inertia: .nan", "gear: .*inertia is"),
        ("[{name: high, torsion: 1e5, damping: 2.0}]", "[]", "1 stages and 0 shafts behind"),
        ("torsion: 1e5, damping: 2.0", "kind: rigid", "shaft 'high' of 't' is rigid"),
        ("name: high", "name: low", "must be one of its own"),
        ("name: high", "name: rotor", "must be one of its own"),
        ("title: t", "title: &a t", "is not plain YAML"),
    ],
)
def test_wrong_drivetrains_say_what_is_wrong(old, new, message):
    table = gear_table(parse_drivetrain(GOOD))
    assert table.speeds == pytest.approx((1.0, 3.0), rel=1e-14)
    assert table.shafts[1].damping == 2.0
    with pytest.raises(InputError, match=message.replace("[", r"\[")) as error:
        gear_table(parse_drivetrain(GOOD.replace(old, new), source="mine"))
    assert "\n" not in str(error.value)


def test_planets_need_room():
    text = GOOD.replace(
        "{kind: parallel, ratio: 3.0, gear: {inertia: 2.0}, pinion: {inertia: 0.5},\n"
        "       stiffness_of: axis, stiffness: 1e7, damping: 10.0}",
        "{kind: planetary, ratio: 1.9, planets: 3, carrier: {inertia: 1}, planet: {inertia: 1}, "
        "sun: {inertia: 1}, stiffness_of: axis, ring_planet: 1e6, sun_planet: 1e6}",
    )
    with pytest.raises(InputError, match="must be greater than 2"):
        parse_drivetrain(text)


def test_a_generator_without_stiffness_cannot_be_fixed():
    with pytest.raises(InputError, match="generator cannot be fixed"):
        stage_masses(gear_table(parse_drivetrain(GOOD)), "fixed")


@pytest.mark.parametrize("name", [*NAMES, "library nrel_750kw", "library nrel_5mw", "good"])
def test_a_table_and_the_machine_of_one_file_swing_and_decay_alike(name):
    """Two assemblies of one file: by ratios about the planet's axis, and by lines of action."""
    if name == "good":
        drivetrain = parse_drivetrain(GOOD)
    elif name.startswith("library"):
        drivetrain = read_drivetrain(name.removeprefix("library "))
    else:
        drivetrain = published.drivetrain(name)
    ours, other = gear_masses(gear_table(drivetrain), "free"), torsional(machine_of(drivetrain))
    if drivetrain.generator.stiffness:
        ours = gear_masses(gear_table(drivetrain), "fixed")
    here, there = natural_modes(ours).frequencies, natural_modes(other).frequencies
    moving = here > 1e-6 * here[-1]
    assert_allclose(here[moving], there[moving], rtol=1e-10)
    order = [other.place(part) for part in ours.names]
    assert_allclose(ours.J, other.J[order], rtol=1e-12)
    assert ours.C.any() == (name in ("nrel_750kw", "good"))
    scale = np.sqrt(np.outer(ours.C.diagonal(), ours.C.diagonal())) + 1e-300
    assert_allclose(ours.C / scale, other.C[np.ix_(order, order)] / scale, atol=1e-9)


def test_damping_along_the_line_is_that_about_the_axis():
    text = published.text_of("drivetrain_c")
    about = parse_drivetrain(text, {"gearbox.stages.1.damping": 300.0})
    arm = machine_of(about).stages[1].arm
    changes = {
        "gearbox.stages.1.stiffness_of": "line",
        "gearbox.stages.1.damping": 300.0 / arm**2,
        "gearbox.stages.1.stiffness": 1.63e9 / arm**2,
    }
    along = gear_table(parse_drivetrain(text, changes)).stages[1]
    assert along.mesh_damping == pytest.approx(300.0, rel=1e-12)
    assert along.mesh == pytest.approx(1.63e9, rel=1e-12)


def test_planets_with_a_mass_are_points_of_their_carrier():
    library = read_drivetrain("nrel_750kw")
    stage = library.gearbox.stages[0]
    own = gear_table(library).stages[0].carrier
    expected = 65.2 + stage.planets * stage.planet.mass * stage.centre_distance**2
    assert own == pytest.approx(expected, rel=1e-12)
    assert gear_table(published.drivetrain("nrel_750kw")).stages[0].carrier == 65.2


def test_a_stage_without_sizes_may_have_planets_at_unequal_angles():
    text = published.text_of("drivetrain_b")
    stage = parse_drivetrain(text).gearbox.stages[0]
    assert [row.value for row in stage.assumptions() if row.name == "angles of planets"] == [
        "unequal"
    ]
    with pytest.raises(InputError, match="cannot be put in at equal angles"):
        parse_drivetrain(text, {"gearbox.stages.0.centre_distance": 0.5})


def test_own_drivetrain_runs_as_a_case(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text(DIRECT, "utf-8")
    (case,) = find_cases("drivetrain/from_table")
    results = case.results(Run({"drivetrain": str(path)}, True, tmp_path))
    exact = np.sqrt(80 * (1 / 5 + 1 / 3)) / (2 * np.pi)
    for frequencies in results.figures["frequencies"].values():
        assert_allclose(frequencies, [0.0, exact], rtol=1e-12)
    assert results.figures["static_stiffness"] == pytest.approx(80.0, rel=1e-12)
    assert results.passed


def test_wrong_systems_say_what_is_wrong():
    a, b = Inertia("a", 1.0), Inertia("b", 2.0)
    for parts, elements, message in (
        ((), (), "at least one inertia"),
        ((a, a), (), "called 'a'"),
        ((a, b), (Element("a", {"a": 1.0}, 1.0),), "called 'a'"),
        ((Inertia("a", 0.0),), (), "must be a finite number above 0"),
        ((a,), (Element("k", {"a": 1.0}, -1.0),), "at least 0"),
        ((a,), (Element("k", {"a": 1.0}, 1.0, float("inf")),), "at least 0"),
        ((a,), (Element("k", {"c": 1.0}, 1.0),), "wound up by 'c'"),
        ((a,), (Element("k", {"a": float("nan")}, 1.0),), "finite number"),
    ):
        with pytest.raises(InputError, match=message):
            Torsional(parts, elements)
    with pytest.raises(InputError, match="one less than inertias"):
        chain([a, b], [])
    system = chain([a, b], [("k", 1.0, 0.0)])
    with pytest.raises(InputError, match="no part 'x'"):
        changed(system, {"x": 1.0})
    with pytest.raises(InputError, match="no element 'a'"):
        damped(system, {"a": 1.0})
    with pytest.raises(InputError, match="no inertia 'x'"):
        response(system, "x", 1.0)
