"""The cases in which another program reads what this project has written."""

import pytest
from conftest import QuickRun

from fe_drivetrain.report.suite.case import find_cases

#: The programs and packages of each.
NEEDS = {
    "bearing/flexible_rings_calculix": ["ccx"],
    "export/calculix_matrix": ["ccx"],
    "export/exudyn_drivetrain": ["exudyn"],
    "export/matrix_files": ["h5py"],
    "export/nastran": ["pyNastran"],
    "export/ross_rotor": ["ross"],
    "export/wisdem": ["windIO", "wisdem"],
    "performance/peers_in_time": ["exudyn", "ross"],
    "verification/calculix_bonded": ["ccx"],
    "verification/calculix_spherical": ["ccx"],
}


@pytest.mark.parametrize(
    "name",
    [
        pytest.param(name, marks=[pytest.mark.needs(*needs), pytest.mark.quick(name)])
        for name, needs in NEEDS.items()
    ],
)
def test_the_other_program_finds_the_same(quick_run: QuickRun, name: str) -> None:
    results = quick_run(name)
    failed = [(v.quantity, v.computed, v.reference) for v in results.verdicts if not v.passed]
    assert not failed
    assert results.verdicts


def test_every_export_case_but_the_one_that_needs_nothing_is_here() -> None:
    exports = {case.name for case in find_cases("export")}
    assert exports - set(NEEDS) == {"export/openfast"}
