"""Two stages of detail of one drivetrain: what they share, and where stage 1 has too much swing."""

from collections.abc import Callable

import numpy as np
import pytest

from fe_drivetrain.cases.procedure.two_stages import (
    RATE,
    Stages,
    detailed_torques,
    driving_of,
    simple_torques,
    stages_of,
    turbine_of,
    with_blades,
)
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.dynamics import library_machine
from fe_drivetrain.dynamics.torsion import damped_modes, natural_modes, static_stiffness
from fe_drivetrain.report.results import Results, Table
from fe_drivetrain.turbine_loads.hub_loads import Rotor, natural_frequencies, similar_turbine

CASE = "procedure/stages"


@pytest.fixture(scope="module")
def stages() -> Stages:
    return stages_of(library_machine("synthetic_2mw"), 0.05)


def test_both_stages_have_stiffness_inertia_and_damping_in_common(stages: Stages) -> None:
    whole = static_stiffness(stages.detailed, "rotor", "generator")
    assert stages.shaft.stiffness == pytest.approx(whole, rel=1e-12)
    for system in (stages.simple, stages.detailed):
        assert damped_modes(system).ratios[0] == pytest.approx(0.05, rel=0.02)
    turning = natural_modes(stages.detailed).shapes[:, 0]
    kinetic = turning @ stages.detailed.M @ turning / turning[0] ** 2
    assert sum(stages.inertias) == pytest.approx(kinetic, rel=1e-12)


def test_the_high_speed_shaft_swings_by_the_share_of_the_generator(stages: Stages) -> None:
    """Far below the first gear mode all that is behind the main shaft turns as one."""
    time = np.arange(2000) / RATE
    front = 1e6 * (1.0 + 0.1 * np.sin(2.0 * np.pi * 0.5 * time))
    loads = np.zeros((len(time), 6))
    loads[:, 3] = front
    driving = driving_of(loads, np.ones(len(time)), np.full(len(time), 1e6), stages)
    one, two = simple_torques(stages, driving), detailed_torques(stages, driving)
    share = stages.ratio**2 * stages.detailed.J[-1] / stages.inertias[1]
    late = slice(1000, None)
    assert np.std(two.high[late]) / np.std(one.high[late]) == pytest.approx(share, rel=2e-3)
    assert np.std(two.low[late]) == pytest.approx(np.std(one.low[late]), rel=1e-3)


def test_blades_on_a_rotor_give_the_turbines_own_edgewise_frequency(stages: Stages) -> None:
    """Rotor alone with its blades: the closed form without the flapwise mode, which adds little."""
    turbine, _ = turbine_of(stages, 2e6, 1.895)
    alone = natural_modes(with_blades(stages.simple, turbine)).frequencies
    own = natural_frequencies(turbine, 0.0)
    lowest, highest = sorted((own["torsion"], own["edge, all blades"]))
    # two oscillators that share the rotor's inertia repel each other
    assert alone[1] < lowest < highest < alone[2]


def test_a_rotor_without_the_inertia_of_its_blades_is_refused(stages: Stages) -> None:
    heavy = similar_turbine(Rotor(rotor_mass=1e6))
    with pytest.raises(InputError, match=r"state the inertia of the rotor with its blades"):
        with_blades(stages.simple, heavy)


@pytest.mark.quick(CASE)
def test_stage_1_is_enough_for_the_main_shaft_and_not_for_the_high_speed_shaft(
    quick_run: Callable[[str], Results],
) -> None:
    results = quick_run(CASE)
    (table,) = (
        item
        for section in results.sections
        for item in section.items
        if isinstance(item, Table) and "Sentences" in item.caption
    )
    verdict = {str(row[0]): str(row[3]) for row in table.rows}
    same = "DLC 1.{}: no significant difference of the torque of the {}"
    assert verdict[same.format(0, "main shaft")] == "holds"
    assert verdict[same.format(2, "high-speed shaft")] != "holds"
    assert "enough for the main shaft, not the high-speed shaft:" in results.answer.verdict
