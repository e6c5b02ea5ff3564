"""Both approaches to uncertain inputs: what varies, and what either of them can see."""

from collections.abc import Callable

import numpy as np
import pytest

from fe_drivetrain.cases.procedure.two_stages import stages_of
from fe_drivetrain.cases.procedure.uncertain_inputs import Width, inputs_of
from fe_drivetrain.dynamics import library_machine
from fe_drivetrain.dynamics.torsion import natural_modes
from fe_drivetrain.report.results import Results, Table

CASE = "procedure/uncertain_inputs"


def test_all_stiffnesses_and_inertias_are_varied_once() -> None:
    """All stiffnesses 1 % larger and all inertias too: every frequency stays where it was."""
    machine = library_machine("nrel_750kw")
    system = stages_of(machine, 0.05).detailed
    inputs = inputs_of(machine, system, 0.1)
    changed = system
    for one in inputs:
        changed = one.on(changed, 0.01)
    np.testing.assert_allclose(
        natural_modes(changed).frequencies, natural_modes(system).frequencies, rtol=1e-9
    )
    np.testing.assert_allclose(changed.J, 1.01 * system.J)
    grid = system.k == 0.0  # the generator is free
    np.testing.assert_allclose(changed.k[~grid], 1.01 * system.k[~grid])


def test_the_band_of_a_width_falls_with_the_root_of_the_samples() -> None:
    few, many = (Width(0.1, 0.1, count).band for count in (33, 129))
    assert few == pytest.approx(2.0 * many)


@pytest.mark.quick(CASE)
def test_damping_is_seen_by_loads_alone(quick_run: Callable[[str], Results]) -> None:
    results = quick_run(CASE)
    (table,) = (
        item
        for section in results.sections
        for item in section.items
        if isinstance(item, Table) and "Approach 1" in item.caption
    )
    (damping,) = (row for row in table.rows if row[0] == "damping")
    by = dict(zip(table.columns, damping, strict=True))
    assert by["approach 1: first frequency ± [%]"] == 0.0
    assert float(str(by["approach 2: peak in a dip ± [%]"])) > 0.5
    assert results.passed
