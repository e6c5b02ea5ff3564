"""What moves the inner ring along the axis: thrust, radial force, moment, or its direction."""

import numpy as np

from fe_drivetrain.bearing import equilibrium
from fe_drivetrain.bearing_life.coupled import coupled_equilibrium
from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.thesis_beam import (
    ASSUMED,
    BEARINGS,
    beam_body,
    bearing_s,
    histories,
    housed_body,
    radial,
)
from fe_drivetrain.common import Bools, Floats
from fe_drivetrain.common.typeset import MINUS
from fe_drivetrain.report import rolling_elements, trace
from fe_drivetrain.report.suite import Page, Record, Run

#: Sizes of correlations that count as none, and as clear (Evans 1996: very weak, strong).
NONE, CLEAR = 0.2, 0.6

#: Moment of the rotor's weight alone on a bearing S [N m].
MOMENT = 8e5


@case("What drives the axial displacement of a main bearing", source="Stirling 2023, section 4.4")
def run(run: Run, page: Page) -> None:
    """Axial displacement over one wind file against thrust, radial force and moment."""
    page.assume_all(ASSUMED)
    with run.step("hub loads"):
        factors = histories(*((20.0, 4.0) if run.quick else (600.0, 5.0)), (12.0,))[0]
    check_signs(page)
    rows: list[Record] = []
    for name, entry in BEARINGS.items():
        bearing = bearing_s(entry)
        for body, housing in ((beam_body(), "left out"), (housed_body(), "in series")):
            with run.step(f"{name}, housing {housing}"):
                found = coupled_equilibrium(body, {"bearing": bearing}, factors)
            axial = found.deflections[:, 0, 0]
            loads = found.of("bearing")
            rows.append({"bearing S": name, "housing": housing, **drivers(axial, loads)})
            if (name, housing) == ("X, 38 deg", "left out"):
                charts(page, axial, loads)
    first = rows[0]
    answer(page, first)
    page.section("Drivers")
    page.table("Correlation of the axial displacement, and steps in which it is upwind", rows)
    show_statements(page, first)
    page.data("drivers", rows)
    page.text(
        "A moment loads one row above and the other below; a radial force adds to one of the two "
        "and takes from the other, and the row that gains pushes the ring along the axis. So the "
        "moment's direction against the radial force decides, not its size. Back to back both the "
        "row that carries thrust and the sense of the rows' arms change, and the finding stays. A "
        "correlation with the moment's size is one with its direction in disguise: within either "
        "sign of the displacement the moment has mostly one direction."
    )
    page.image("The rollers of bearing S", run.sketch(*rolling_elements(bearing_s())))


def answer(page: Page, first: Record) -> None:
    """State what drives the axial displacement, and whether the thesis's statements hold."""
    page.found("ring moves upwind against the thrust, share of steps [%]", first["upwind [%]"])
    thrust, force, moment = (first[f"with {of}"] for of in ("thrust", "radial force", "My"))
    overhanging = first["of these with overhanging moment [%]"]
    holds = overhanging == 100.0 and force < -CLEAR and abs(thrust) < NONE
    ends = "practically none, as the thesis states" if holds else "where the thesis states none"
    both = f"{force:.2f} and {moment:.2f}".replace("-", MINUS)
    page.answer(
        "What moves the inner ring of a main bearing along the axis?",
        f"Radial force and bending moment move the ring along its axis (correlations {both}); "
        f"thrust has {f'{thrust:.2f}'.replace('-', MINUS)}, {ends}.",
        [
            page.value("correlation with the bending moment about y", moment),
            page.value("correlation with radial force", force),
            page.value("correlation with thrust", thrust, beside=0.0, by="thesis: none"),
            page.judged(
                "ring moves upwind against the thrust, share of steps",
                "steps in which the ring moves upwind, against the thrust",
            ),
            page.value(
                "share of these steps in which the rotor's weight governs the moment [%]",
                overhanging,
                beside=100.0,
                by="thesis",
            ),
        ],
        "Axial displacement against the moment's direction: 0 is that of the rotor's weight",
        [
            "Correlations are those of one wind file at 12 m/s and of rows face to face with a "
            "contact angle of 38° in a rigid housing; the thesis prints no contact angle."
        ],
        claim="holds" if holds else "holds in part",
    )


def show_statements(page: Page, found: Record) -> None:
    """What the thesis says of the drivers, beside ours."""
    overhanging = "of these with overhanging moment [%]"
    page.table(
        "Statements of the thesis, and ours for X, 38 deg, housing left out",
        [
            ("no correlation with thrust", f"{found['with thrust']:.2f}"),
            ("clear negative correlation with radial force", f"{found['with radial force']:.2f}"),
            (
                "weak negative correlation with the moment's size where negative",
                f"{found['with moment, upwind steps']:.2f}",
            ),
            (
                "weak positive correlation with it where positive",
                f"{found['with moment, downwind steps']:.2f}",
            ),
            (
                "all negative displacements with the overhanging moment",
                f"{found[overhanging]:.0f} %",
            ),
            (
                "positive ones with it too",
                f"{found['downwind all the same [%]']:.0f} % of steps with the overhanging moment",
            ),
        ],
        ("thesis", "ours"),
    )


def correlation(a: Floats, b: Floats) -> float:
    """Correlation of two series; NaN of fewer than three steps."""
    return float(np.corrcoef(a, b)[0, 1]) if len(a) > 2 else float("nan")


def drivers(axial: Floats, loads: Floats) -> Record:
    """Correlations of an axial displacement, and where it is upwind."""
    moment = radial(loads[:, 3:])
    upwind = axial < 0.0
    overhang = loads[:, 3] < 0.0
    return {
        "upwind [%]": 100.0 * float(upwind.mean()),
        "of these with overhanging moment [%]": share(overhang, upwind),
        "downwind all the same [%]": share(~upwind, overhang),
        "with thrust": correlation(axial, loads[:, 0]),
        "with radial force": correlation(axial, radial(loads[:, 1:3])),
        "with moment, upwind steps": correlation(axial[upwind], moment[upwind]),
        "with moment, downwind steps": correlation(axial[~upwind], moment[~upwind]),
        "with My": correlation(axial, loads[:, 3]),
    }


def share(what: Bools, among: Bools) -> float:
    """Share of steps among others [%]; NaN where there are none."""
    return 100.0 * float(what[among].mean()) if among.any() else float("nan")


def charts(page: Page, axial: Floats, loads: Floats) -> None:
    """Draw what the thesis's figure 4.12 shows."""
    page.section("Axial displacement at 12 m/s")
    um = 1e6 * axial
    for name, unit, values in (
        ("thrust", "kN", 1e-3 * loads[:, 0]),
        ("radial force", "kN", 1e-3 * radial(loads[:, 1:3])),
        ("moment", "kN m", 1e-3 * radial(loads[:, 3:])),
    ):
        page.chart(
            f"Axial displacement against {name}",
            [trace("load steps", values, um, points=True)],
            f"{name} [{unit}]",
            "axial displacement [µm]",
        )
    # 0 where the rotor's weight prevails (moment along -y), 180 deg where the rotor overturns
    direction = np.degrees(np.arctan2(loads[:, 4], -loads[:, 3]))
    page.chart(
        "Axial displacement against the moment's direction: 0 is that of the rotor's weight",
        [trace("load steps", direction, um, points=True)],
        "direction of the moment [deg]",
        "axial displacement [µm]",
    )


def check_signs(page: Page) -> None:
    """Moments alone, and turned round."""
    bearing = bearing_s()
    pure = equilibrium(bearing, [0.0, 0.0, 0.0, MOMENT, 0.0]).displacements[0]
    page.vanishes(
        "axial displacement under a moment alone, over tilt times pitch radius",
        float(pure[0] / (pure[3] * bearing.arm)),
        within=1e-8,
        why="the solver stops at a residual of 1e-8 of the load",
        source="Stirling 2023, section 4.4; symmetry of the two rows",
    )
    force = -4e5
    one, other = equilibrium(
        bearing, [[0.0, 0.0, force, MOMENT, 0.0], [0.0, 0.0, force, -MOMENT, 0.0]]
    ).displacements
    page.equals(
        "radial force and moment, without thrust: axial displacement, moment turned round",
        1e6 * float(one[0]),
        -1e6 * float(other[0]),
        within=1e-8,
        why="the solver stops at a residual of 1e-8 of the load, at mirrored steps besides",
        source="mirror image: the rows change places",
        unit="um",
        measure="deflection",
    )
    page.holds(
        "face to face the rotor's weight and its moment move the ring upwind",
        bool(other[0] < 0.0 < one[0]),
        why="the direction of the moment decides",
        source="Stirling 2023, section 4.4",
    )
