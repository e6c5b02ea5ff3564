"""Tilting stiffness of a bearing at fixed displacements: the eight scenarios of Table 4.2."""

from collections.abc import Sequence

import numpy as np

from fe_drivetrain.bearing import (
    Arrangement,
    Bearing,
    RollerRow,
    double_row_tapered,
    equilibrium,
    sjovall,
)
from fe_drivetrain.bearing_life.coupled import on_springs, tilt_springs
from fe_drivetrain.cases import case
from fe_drivetrain.cases.bearing.tilt_scenarios import (
    SCENARIOS,
    TiltCurve,
    best_fit,
    displacement_scenarios,
    tilt_curve,
)
from fe_drivetrain.cases.references.main_bearings import OwnBearing, own_bearing
from fe_drivetrain.cases.references.thesis_beam import (
    ASSUMED,
    BEARINGS,
    BEST_FIT,
    HOUSING_TILT,
    WIND_SPEEDS,
    beam_body,
    bearing_s,
    histories,
    radial,
)
from fe_drivetrain.common import Floats
from fe_drivetrain.report import rolling_elements, trace
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.studies.shown_units import bearing_in_words
from fe_drivetrain.turbine_loads.hub_loads import Condition, hub_load_set

#: Distance of the middles of the inner races: half the width of Table 4.1 [m].
RACES = 0.1524

HERO = "Best fit against the contact angle, middles of the inner races at a quarter of the width"


@case(
    "Tilting stiffness of a double-row tapered bearing: eight scenarios",
    source="Stirling 2023, section 4.3, Table 4.2",
    settings={
        "drivetrain": "FILE, or a name of the library (otherwise the thesis's beam and bearing S)",
        "bearing": "NAME of a main bearing of your drivetrain (otherwise its first one)",
        "catalogue": "FILE with entries of your bearings, beside the program's",
    },
)
def run(run: Run, page: Page) -> None:
    """Displacements over four wind files; moment and stiffness against tilt; best fit."""
    own = own_bearing(run, page, "Tilting stiffness of a main bearing", moments=True)
    if own is not None:
        of_own(run, page, own)
        return
    page.assume_all(ASSUMED)
    with run.step("hub loads"):
        factors = histories(*((10.0, 2.0) if run.quick else (600.0, 2.0)))
    flat = factors.reshape(-1, factors.shape[-1])
    fits: list[Record] = []
    for name, entry in BEARINGS.items():
        bearing = bearing_s(entry)
        with run.step(name):
            fits.append(of_thesis(name, page, bearing, flat))
    check_closed_form(page, bearing_s())
    answer(page, fits)
    page.section("Best fit")
    page.table("Slope of the best straight line, and what it depends on", fits)
    angle_sweep(run, page, flat)
    page.text(
        "The tangent dM / d theta of Eq 4.20 is not what a spring of the beam needs, which is "
        "M / theta; and at fixed axial and radial displacements M is not zero without tilt: no "
        "constant has such an offset. The rollers' stiffness acts in series with the housing's "
        f"{HOUSING_TILT / 1e6:.0f} MN m/rad: together {series(BEST_FIT) / 1e6:.0f}, not "
        f"{BEST_FIT / 1e6:.0f} MN m/rad."
    )
    statements(page, bearing_s(), factors)
    page.image("The rollers of bearing S", run.sketch(*rolling_elements(bearing_s())))


def of_own(run: Run, page: Page, own: OwnBearing) -> None:
    """The scenarios of a user's bearing, at the motions that it has in its shaft."""
    place = own.in_shaft
    conditions = [Condition(v, "medium", 0.2, 1) for v in WIND_SPEEDS]
    with run.step("hub loads"):
        made = hub_load_set(conditions, *((10.0, 2.0) if run.quick else (600.0, 2.0)), own.rotor)
    with run.step(place.name):
        k = place.body.bearings.index(place.name)
        moved = np.concatenate([place.under(one).deflections[:, k] for one in made])
        row = one_bearing(page, place.name, place.bearing, moved)
    check_homogeneous(page, place.bearing)
    page.section("Best fit")
    page.table("Slope of the best straight line, and the motions that it is from", [row])
    fit, other, offset, tilt = (
        float(row[name])  # type: ignore[arg-type]
        for name in (
            "best fit [MN m/rad]",
            "tilted the other way [MN m/rad]",
            "largest moment without tilt [kN m]",
            "tilt, max [mrad]",
        )
    )
    page.answer(
        f"Which constant tilting stiffness fits {bearing_in_words(place.name)} best?",
        f"The best fit is {value_text(fit, 'MN m/rad')}, for tilt in the other direction "
        f"{value_text(other, 'MN m/rad')}; without tilt the rollers carry up to "
        f"{value_text(offset, 'kN m')}, which no constant gives.",
        [
            page.value("best fit [MN m/rad]", fit),
            page.value("best fit, tilted the other way [MN m/rad]", other),
            page.value("largest moment without tilt [kN m]", offset),
            page.value("largest tilt [mrad]", tilt),
        ],
        tilt_caption(place.name),
        [
            "Rollers alone, in a rigid housing: that of the housing acts in series with theirs, as "
            "`fe-drivetrain study` finds it."
        ],
    )


def answer(page: Page, fits: list[Record]) -> None:
    """State the best fit for each bearing that the thesis's words allow."""
    slopes = [row["best fit [MN m/rad]"] for row in fits]
    page.found("slope of the best straight line [MN m/rad]", slopes[0])
    printed = BEST_FIT / 1e6
    names = ("38°, face to face", "20°, face to face", "20°, back to back")
    page.answer(
        "Which constant tilting stiffness fits a double-row tapered bearing best?",
        f"The best fit is {value_text(min(slopes))} to {value_text(max(slopes), 'MN m/rad')}, "
        "depending on contact angle and arrangement; the thesis's "
        f"{value_text(printed)} cannot be checked, since it prints no angle.",
        [
            *(
                page.value(
                    f"best fit, contact angle {name} [MN m/rad]", slope, beside=printed, by="thesis"
                )
                for name, slope in zip(names, slopes, strict=True)
            ),
            page.value(
                "contact angle 38°, with the housing in series [MN m/rad]",
                fits[0]["with the housing in series [MN m/rad]"],
            ),
            page.judged(
                "scenario 1: moment at a tilt of 0.2 mrad",
                "moment at a tilt of 0.2 mrad, ring centred",
                "Sjovall",
            ),
        ],
        HERO,
        [
            "Displaced along the axis or radially, the bearing has a moment of up to "
            f"{fits[0]['largest moment without tilt [kN m]']:.0f} kN m without tilt: no constant "
            "stiffness has that."
        ],
    )


def series(K_R: float) -> float:
    """With the housing's."""
    return 1.0 / (1.0 / K_R + 1.0 / HOUSING_TILT)


def operation(bearing: Bearing, factors: Floats) -> Floats:
    """Displacements under loads of the beam with the thesis's first K_R, for both planes."""
    springs = tilt_springs(bearing, HOUSING_TILT)
    loads = on_springs(beam_body(), factors, springs).forces[:, 0]
    return equilibrium(bearing, loads).displacements


def one_bearing(page: Page, name: str, bearing: Bearing, u: Floats) -> Record:
    """Charts of one bearing; its best fit and the ranges of motions (n, 5) that it is from."""
    axial, across, tilt = u[:, 0], radial(u[:, 1:3]), radial(u[:, 3:])
    tilts = np.linspace(0.0, tilt.max(), 61)
    curves = [tilt_curve(bearing, a, r, tilts) for a, r in displacement_scenarios(axial, across)]
    other = [tilt_curve(bearing, a, r, -tilts) for a, r in displacement_scenarios(axial, across)]
    K = best_fit(curves)
    show_curves(page, name, tilts, curves, K)
    offsets = [abs(c.moments[0]) for c in curves]
    return {
        "bearing": name,
        "axial, min [µm]": 1e6 * axial.min(),
        "axial, max [µm]": 1e6 * axial.max(),
        "radial, max [µm]": 1e6 * across.max(),
        "tilt, max [mrad]": 1e3 * tilt.max(),
        "best fit [MN m/rad]": 1e-6 * K,
        "tilted the other way [MN m/rad]": 1e-6 * best_fit(other),
        "largest moment without tilt [kN m]": 1e-3 * max(offsets),
    }


def of_thesis(name: str, page: Page, bearing: Bearing, factors: Floats) -> Record:
    """A bearing that the thesis's words allow, in its beam, beside what it prints."""
    row = one_bearing(page, name, bearing, operation(bearing, factors))
    fit = float(row["best fit [MN m/rad]"])  # type: ignore[arg-type]
    row["with the housing in series [MN m/rad]"] = 1e-6 * series(1e6 * fit)
    row["thesis [MN m/rad]"] = 1e-6 * BEST_FIT
    return row


def show_curves(
    page: Page, name: str, tilts: Floats, curves: Sequence[TiltCurve], K: float
) -> None:
    """Moment and stiffness of all scenarios, and the straight line through them."""
    dashed = {"dash": "dash", "color": "black"}
    line = np.mean([c.moments.mean() for c in curves]) + K * (tilts - tilts.mean())
    labels = [f"{i + 1}: axial {a}, radial {r}" for i, (a, r) in enumerate(SCENARIOS)]
    page.section(name)
    page.chart(
        tilt_caption(name),
        [
            *(
                trace(label, 1e3 * tilts, 1e-3 * c.moments)
                for label, c in zip(labels, curves, strict=True)
            ),
            trace("best fit", 1e3 * tilts, 1e-3 * line, line=dashed),
        ],
        "tilt [mrad]",
        "moment [kN m]",
    )
    page.chart(
        f"{name}: stiffness dM / d theta against moment",
        [
            *(
                trace(label, 1e-3 * c.moments, 1e-6 * c.stiffness)
                for label, c in zip(labels, curves, strict=True)
            ),
            trace("best fit", 1e-3 * line[[0, -1]], [1e-6 * K] * 2, line=dashed),
        ],
        "moment [kN m]",
        "stiffness [MN m/rad]",
    )
    page.data(
        f"{name}: scenarios",
        {
            "tilt [rad]": tilts,
            "moment [N m]": [c.moments for c in curves],
            "stiffness [N m/rad]": [c.stiffness for c in curves],
        },
    )


def tilt_caption(name: str) -> str:
    """Caption of the chart of moments."""
    return f"{name}: moment against tilt, the other displacements held"


def statements(page: Page, bearing: Bearing, factors: Floats) -> None:
    """What the thesis says of the scenarios and of operation, beside ours."""
    page.section("Statements of the thesis")
    statements_on_scenarios(page, bearing, factors.reshape(-1, factors.shape[-1]))
    springs = tilt_springs(bearing, BEST_FIT)
    rows = [
        in_operation(bearing, speed, on_springs(beam_body(), one, springs).forces[:, 0])
        for speed, one in zip(WIND_SPEEDS, factors, strict=True)
    ]
    page.table(
        "Operation with 1272 MN m/rad in both planes: the thesis finds axial and radial "
        "displacement well correlated and the bearing moved upwind for significant periods (its "
        "figure 4.7), and a mean angle of force and moment close to 90 deg with a wide deviation "
        "(its figure 4.1)",
        rows,
    )
    page.data("operation", rows)


def statements_on_scenarios(page: Page, bearing: Bearing, flat: Floats) -> None:
    """How far apart the curves of the scenarios are, and how steep."""
    u = operation(bearing, flat)
    tilts = np.linspace(0.0, radial(u[:, 3:]).max(), 61)[1:]
    table = displacement_scenarios(u[:, 0], radial(u[:, 1:3]))
    curves = [tilt_curve(bearing, a, r, tilts) for a, r in table]
    moments = np.array([c.moments for c in curves])
    rest = [np.delete(moments, i, axis=0).mean(axis=0) for i in range(len(moments))]
    apart = np.abs(moments - rest).mean(axis=1)
    stiffness = np.array([c.stiffness for c in curves])
    spread = np.ptp(stiffness, axis=0) / stiffness.mean(axis=0)
    page.table(
        "Statements on the scenarios, and ours for X, 38 deg",
        [
            [
                "scenario 7 stands apart",
                f"scenario {int(apart.argmax()) + 1} is farthest from the mean of the others, by "
                f"{1e-3 * apart.max():.0f} kN m; next {int(np.argsort(apart)[-2]) + 1}, by "
                f"{1e-3 * np.sort(apart)[-2]:.0f}",
            ],
            [
                "curves converge towards the largest tilt",
                f"stiffness of the scenarios differs by {100 * spread[0]:.0f} % of its mean at the "
                f"least tilt, by {100 * spread[-1]:.0f} % at the largest",
            ],
            [
                "145 MN m/rad is too low by about 10",
                f"by {best_fit(curves) / 145e6:.1f}",
            ],
        ],
        ("thesis", "ours"),
    )


def in_operation(bearing: Bearing, speed: float, loads: Floats) -> Record:
    """Displacements under a history of bearing loads (n, 5), and the angle of force and moment."""
    moved = equilibrium(bearing, loads).displacements
    turned = np.degrees(
        np.arctan2(loads[:, 4], -loads[:, 3]) - np.arctan2(loads[:, 2], -loads[:, 1])
    )
    turned = np.abs((turned + 180.0) % 360.0 - 180.0)
    return {
        "wind [m/s]": speed,
        "axial with radial displacement, correlation": float(
            np.corrcoef(moved[:, 0], radial(moved[:, 1:3]))[0, 1]
        ),
        "upwind [% of time]": 100.0 * float((moved[:, 0] < 0.0).mean()),
        "angle of force and moment, mean [deg]": float(turned.mean()),
        "its deviation [deg]": float(turned.std()),
    }


def angle_sweep(run: Run, page: Page, factors: Floats) -> None:
    """Best fit over the contact angle, which is not printed."""
    rows: list[Record] = []
    with run.step("contact angles"):
        arrangements: tuple[Arrangement, ...] = ("X", "O")
        for arrangement in arrangements:
            for angle in [12.0, 20.0, 30.0, 40.0] if run.quick else range(12, 41, 2):
                lean = 0.065 * np.sin(np.radians(angle))
                spread = RACES + (lean if arrangement == "X" else -lean)
                sizes = (36, 0.065, 0.095, 0.7874)
                bearing = double_row_tapered(
                    "bearing S", *sizes, float(angle), float(spread), arrangement, laminae=0
                )
                u = operation(bearing, factors)
                tilts = np.linspace(0.0, radial(u[:, 3:]).max(), 31)
                table = displacement_scenarios(u[:, 0], radial(u[:, 1:3]))
                K = best_fit([tilt_curve(bearing, a, r, tilts) for a, r in table])
                rows.append(
                    {
                        "arrangement": arrangement,
                        "contact angle [deg]": float(angle),
                        "best fit [MN m/rad]": 1e-6 * K,
                        "arm at the rollers' middle [mm]": 1e3 * abs(bearing.rows[1].arm),  # type: ignore[union-attr]
                    }
                )
    page.sweep(
        HERO,
        rows,
        "contact angle [deg]",
        "best fit [MN m/rad]",
        by="arrangement",
        reference={"thesis": 1e-6 * BEST_FIT},
    )


def check_closed_form(page: Page, bearing: Bearing) -> None:
    """Scenario 1 is a pure moment, for which there is a closed form."""
    theta = 2e-4
    curve = tilt_curve(bearing, 0.0, 0.0, [theta])
    row = bearing.rows[1]
    n = row.law.exponent
    x = np.polynomial.legendre.leggauss(40)
    arms = row.arm + 0.5 * row.length * x[0]  # type: ignore[union-attr]
    mean = float(0.5 * x[1] @ np.abs(arms) ** (n + 1.0))
    share = sjovall(0.5, n)[0]
    exact = 2.0 * bearing.counts[0] * share * row.law.stiffness * mean * theta**n
    page.equals(
        "scenario 1: moment at a tilt of 0.2 mrad",
        float(curve.moments[0]) / 1e3,
        exact / 1e3,
        within=1e-4,
        why="36 rollers in place of a ring",
        source="2 Z J_r(0.5) K mean(|e|^(n + 1)) theta^n (Sjovall's integral)",
        unit="kN m",
        measure="reaction",
    )
    check_homogeneous(page, bearing)


def check_homogeneous(page: Page, bearing: Bearing) -> None:
    """Without clearance the moment of scenario 1 is a power of the tilt."""
    if any(row.clearance or not isinstance(row, RollerRow) for row in bearing.rows):
        return  # of balls the contact angle turns, and a clearance is no power
    theta, n = 2e-4, bearing.rows[0].law.exponent
    curve = tilt_curve(bearing, 0.0, 0.0, [theta])
    page.equals(
        "scenario 1: tangent over secant stiffness",
        float(curve.stiffness[0] * theta / curve.moments[0]),
        n,
        within=1e-9,
        why="no clearance: the moment is a power of the tilt",
        source="homogeneity",
        measure="identity",
    )
