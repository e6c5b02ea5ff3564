"""The cases in which another program reads what this project has written."""

from pathlib import Path

import pytest

from fe_drivetrain.suite.case import find_cases
from fe_drivetrain.suite.result_folders import run_case

#: The programs and packages of each.
NEEDS = {
    "bearing/flexible_rings_calculix": ["ccx"],
    "export/calculix_matrix": ["ccx"],
    "export/exudyn_drivetrain": ["exudyn"],
    "export/matrix_files": ["h5py"],
    "export/nastran": ["pyNastran"],
    "export/ross_rotor": ["ross"],
    "export/wisdem": ["windIO", "wisdem"],
    "verification/calculix_bonded": ["ccx"],
    "verification/calculix_spherical": ["ccx"],
}


@pytest.mark.parametrize(
    "name", [pytest.param(n, marks=pytest.mark.needs(*needs)) for n, needs in NEEDS.items()]
)
def test_the_other_program_finds_the_same(tmp_path: Path, name: str) -> None:
    (case,) = find_cases(name)
    results = run_case(case, tmp_path, quick=True)
    failed = [(v.quantity, v.computed, v.reference) for v in results.verdicts if not v.passed]
    assert not failed
    assert results.verdicts


def test_every_export_case_but_the_one_that_needs_nothing_is_here() -> None:
    exports = {case.name for case in find_cases("export")}
    assert exports - set(NEEDS) == {"export/openfast"}
