"""Misalignment and dips in time: what adds up, and what the case says of each sentence."""

from collections.abc import Callable

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file import read_drivetrain
from fe_drivetrain.procedure.drivetrain_events import event_of
from fe_drivetrain.report.results import Results, Table
from fe_drivetrain.studies.drivetrain_transient import transient

CASE = "procedure/gaps_in_time"


def test_a_dip_of_a_misaligned_gearbox_is_the_dip_and_the_offset_of_every_torque() -> None:
    """Linear equations: a torque that the offset shifts is shifted by the same all the time."""
    drivetrain, dip = read_drivetrain("nrel_750kw"), {"start": 0.2}
    both, alone = (
        transient(
            drivetrain, "dip", {**dip, **moved}, level="rigid", duration=0.6, step=2e-3, damage=None
        )
        for moved in ({"gearbox_uz": 1e-3}, {})
    )
    for name in ("torque of LSS", "torque of HSS"):
        apart = both.samples.of(name) - alone.samples.of(name)
        assert np.ptp(apart) < 1e-6 * abs(alone.extremes[name].rated)
    bearing = "force of PLC-A"
    assert both.extremes[bearing].rated == alone.extremes[bearing].rated
    assert both.samples.of(bearing)[0] > 3.0 * alone.samples.of(bearing)[0]


def test_a_dip_refuses_an_offset_out_of_its_range() -> None:
    with pytest.raises(InputError, match="gearbox_uz of the event is 1 m but must be from"):
        event_of("dip", {"gearbox_uz": 1.0})


@pytest.mark.quick(CASE)
def test_the_case_judges_each_sentence_by_its_own_numbers(
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
    assert verdict["misalignment may cause constraining forces in the gearbox"] == "holds"
    time = "calculations in the time domain are necessary for it"
    assert verdict[time] == "holds in part"
    shifted = "loads at the interfaces do not shift significantly, those of components do"
    assert verdict[shifted] == "holds in part"
    hold = sum(value == "holds" for value in verdict.values())
    assert f"{hold} of {len(verdict)} statements hold" in results.answer.verdict
