"""Published stiffness of main shafts and drivetrains, by closed forms and by finite elements."""

from collections.abc import Callable, Mapping
from typing import Any

from fe_drivetrain.cases import cases
from fe_drivetrain.cases.references.solid_shafts import straight
from fe_drivetrain.cases.verification import (
    published_dtu_10mw,
    published_iea_10,
    published_iea_15,
    published_iea_22,
    published_nrel_5mw,
)
from fe_drivetrain.cases.verification.published_checks import MainShaft, main_shaft
from fe_drivetrain.cases.verification.shaft_inputs import show_inputs
from fe_drivetrain.report.suite import Page, Record, Run

#: By the turbine of a row: what judges it.
TURBINES: dict[str, Callable[[Page, Mapping[str, Any], Record, MainShaft], None]] = {
    "dtu_10mw": published_dtu_10mw.judge,
    "iea_10": published_iea_10.judge,
    "iea_15": published_iea_15.judge,
    "iea_22": published_iea_22.judge,
    "nrel_5mw": published_nrel_5mw.judge,
}


@cases("published_shafts.yaml")
def run(run: Run, page: Page, row: Mapping[str, Any]) -> None:
    """The shaft by finite elements, and what else is published of the turbine."""
    given = {key: value for key, (_, value, _, _) in row["inputs"].items()}
    given |= {key: row[key] for key in ("hawc2_x", "hawc2_polar") if key in row}
    shaft = main_shaft(run, given)
    page.section(row["heading"])
    show_inputs(page, *(tuple(line) for line in row["inputs"].values()))
    sources = {key: source for key, (_, _, _, source) in row["inputs"].items()}
    TURBINES[row["turbine"]](page, given, sources, shaft)
    if row.get("no_gearbox"):
        page.assume(
            "generator and hub",
            "rigid",
            "",
            "the turbine has no gearbox: the field would hold the generator's structure too, "
            "which is not published",
        )
    page.image(
        "The main shaft", run.sketch(straight((0.0, shaft.length), shaft.outer, shaft.inner))
    )
    page.data("stiffness", shaft.found.stiffness)
    page.data("band", shaft.found.band)
