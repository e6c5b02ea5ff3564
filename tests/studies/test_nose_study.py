"""Check and study of a shaft round its nose: masses, reactions with weight, levels, files."""

import math
from pathlib import Path

import numpy as np
import pytest
from test_nose import COARSE, NOSE, ROOT, SHAFT
from test_own_drivetrain import table_of, tables, write_loads

from fe_drivetrain.command_line.app import main
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.export.formats.summary import read_summary

pytestmark = pytest.mark.usefixtures("kept_between_runs")


def run(*words: str) -> None:
    with pytest.raises(SystemExit) as end:
        main(list(words))
    assert end.value.code == 0


def tube(diameters: tuple[float, float], length: float) -> float:
    """Mass of a steel tube [kg]."""
    outer, inner = diameters
    return 7850.0 * math.pi / 4 * (outer**2 - inner**2) * length


@pytest.fixture(scope="module")
def study(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Floats]:
    """The result folder of a study of a shaft round its nose, and its loads."""
    folder = tmp_path_factory.mktemp("nose")
    (folder / "nose.yaml").write_text(COARSE.model_dump_json(), "utf-8")
    loads = write_loads(folder / "loads.csv", 1)
    words = ["--loads", str(folder / "loads.csv"), "--slope", "4", "--out", str(folder / "out")]
    run("study", str(folder / "nose.yaml"), *words)
    return folder / "out", loads


def test_bearings_on_a_nose_carry_the_loads_and_the_shafts_weight(
    study: tuple[Path, Floats],
) -> None:
    folder, loads = study
    masses = {str(row["part"]): float(str(row["mass [kg]"])) for row in tables(folder)["Parts"]}
    # parabolic arcs, eight to a turn, miss some of a thin wall's section
    assert masses["shaft"] == pytest.approx(tube(SHAFT, 2.6), rel=0.01)
    assert masses["nose"] == pytest.approx(tube(NOSE, 0.3 + ROOT), rel=0.01)
    columns, values, head = table_of(folder / "reactions_loads.csv")
    assert "upwind at x = 0 m, downwind at x = 1.2 m" in head
    assert f"that of the nose, {9.80665 * masses['nose'] / 1e3:.4g} kN, goes into" in head
    # the nose's own weight is none of the bearings'
    weight = 9.80665 * masses["shaft"]
    for component, column in (("Fx", 0), ("Fy", 1), ("Fz", 2)):
        total = sum(
            values[:, columns.index(f"{support} {component} [N]")]
            for support in ("upwind", "downwind", "gearbox")
        )
        applied = 1e3 * loads[:, column] - (weight if component == "Fz" else 0.0)
        np.testing.assert_allclose(total, applied, rtol=0, atol=1e-5 * weight)


def test_levels_below_the_assembly_have_no_housings_to_speak_of(
    study: tuple[Path, Floats],
) -> None:
    found = tables(study[0])
    assert not any("housings" in caption for caption in found)
    shares = {
        str(row["reaction"]): row
        for rows in found.values()
        for row in rows
        if {"beam", "meridian"} <= row.keys() and "rms of FE" not in row
    }
    # a wide tube on a nose is no beam: the solid's meridian shares the load as the solid does
    for share in shares.values():
        assert float(str(share["meridian"])) < 1.0
    assert float(str(shares["downwind, force"]["beam"])) > 5.0
    (needed,) = [rows for caption, rows in found.items() if caption.startswith("The cheapest")]
    levels = {str(row["reaction"]): str(row["level that it needs"]) for row in needed}
    assert levels["downwind, force"] == "2 meridian"


def test_its_files_are_those_that_there_are(study: tuple[Path, Floats]) -> None:
    folder, _ = study
    listed = [str(row["file"]) for row in tables(folder)["Files of this study"]]
    assert "stiffness.json" not in listed
    assert all(list(folder.glob(file)) for file in listed)
    found = read_summary(folder / "summary.json")
    assert set(found.reactions.matrices) == {"upwind", "downwind", "gearbox"}


def test_check_says_what_holds_the_shaft(study: tuple[Path, Floats], tmp_path: Path) -> None:
    scene = study[0].parent / "nose.yaml"
    run("check", str(scene), "--out", str(tmp_path / "page"))
    found = tables(tmp_path / "page")
    held = {
        row["bearing"]: row["holds"] for row in found["Bearings between the shaft and its nose"]
    }
    assert held["downwind"] == "uy 20 GN/m, uz 20 GN/m"
    levels = [str(row["level"]) for row in found["What each level costs"]]
    assert levels[-2:] == ["3 solid shaft and solid nose alone", "4 assembly of solids"]
