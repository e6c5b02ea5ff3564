"""What holds for every bearing: homogeneity, symmetry, balance; three degrees against five."""

import numpy as np

from fe_drivetrain.bearing import catalogue_bearing, equilibrium, forces, three_degrees, turn
from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import round_off
from fe_drivetrain.report import rolling_elements
from fe_drivetrain.report.suite import Page, Record, Run, Target

BEARING = catalogue_bearing("bearing_s")
Z = BEARING.counts[0]
#: Axial, radial, moment and combined loads [kN, kN m]; and which change their sign in a mirror.
MOMENTS = (200, 0, -400, 800, 0), (200, 0, -400, -800, 0), (200, 0, -400, 0, 800)
LOADS = 1e3 * np.array([*MOMENTS, (100, 0, -400, -300, 0), (-50, 90, 20, 10, -600)])
MIRROR = np.array([-1, 1, 1, -1, -1])
SOURCE = "identities of the model of Stirling 2023, ch. 4"
RESIDUAL = "exact but for the solver's residual"
FIVE = "peak roller, five [kN]"
ANGLE, SIDE = "angle out of plane [deg]", "side force left [kN]"
PEAK = "error of the peak roller [%]"
TITLE = "{}: 200 kN axial, 400 kN down, 800 kN m, its axis turned out of plane"


@case(
    "Identities of a double-row tapered bearing, and three degrees against five",
    source="identities of the model of Stirling 2023, ch. 4",
)
def run(run: Run, page: Page) -> None:
    """Scale, turn and mirror the loads; reduce them to three degrees of freedom."""
    by_a_pitch = turn(LOADS, np.full(len(LOADS), 2 * np.pi / Z))
    with run.step("equilibrium"):
        base, scaled, turned, image = (
            equilibrium(BEARING, loads, tolerance=1e-12)
            for loads in (LOADS, 3.0 * LOADS, by_a_pitch, LOADS * MIRROR)
        )
        K = forces(BEARING, base.displacements)[1]
    shifted = np.roll(base.rollers.reshape(-1, 2, Z), 1, axis=2).reshape(len(LOADS), -1)
    for name, value, why in (
        ("loads times 3: rollers times 3", scaled.rollers / 3.0 - base.rollers, "no clearance"),
        ("loads turned by one pitch: rollers moved by one", turned.rollers - shifted, "symmetry"),
        ("mirrored loads: rows exchanged", image.rollers - np.roll(base.rollers, Z, 1), "symmetry"),
        ("unbalanced loads", base.unbalanced, "the residual that the solver leaves"),
    ):
        title, why = f"{name}, over the peak roller", f"{RESIDUAL}: {why}"
        largest = float(np.abs(value).max() / base.rollers.max())
        page.meets(largest, Target(title, 0.0, 1e-7, why, SOURCE))
    title = "displacements under three times the loads"
    power = "load is displacement to the power 1.1 where there is no clearance"
    grown = float(scaled.displacements[0, 2] / base.displacements[0, 2])
    target = Target(title, 3.0 ** (1 / 1.1), 1e-8, RESIDUAL, power, measure="deflection")
    page.meets(grown, target)
    mirrored = round_off(40, "mirrored entries are sums of the same products, in another order")
    title = "asymmetry of the tangent stiffness"
    target = Target(title, 0.0, **mirrored, source="an energy", basis="self-consistency")
    page.meets(float(np.abs(K - np.swapaxes(K, 1, 2)).max() / np.abs(K).max()), target)
    angles = range(0, 91, 30 if run.quick else 5)
    rows = [run.timed("three degrees", reduced, float(angle)) for angle in angles]
    title = "force and moment in one plane: side force left by three degrees [kN]"
    why, eq = f"{RESIDUAL}: 1e-8 of the load", "Stirling 2023, section 4.2.1"
    page.meets(rows[0][SIDE], Target(title, 0.0, 1e-3, why, eq, measure="identity"))
    worst = max(rows, key=lambda row: abs(row[PEAK]))
    answer(page, worst)
    page.section("Three degrees against five")
    for y, table in ((SIDE, True), (PEAK, False)):
        page.sweep(TITLE.format(y.partition(" [")[0].capitalize()), rows, ANGLE, y, table=table)
    page.image("The rollers of bearing S", run.sketch(*rolling_elements(BEARING)))


def answer(page: Page, worst: Record) -> None:
    """State where three degrees of freedom are exact, and what they miss elsewhere."""
    out = f"{worst[ANGLE]:.0f}° out of plane"
    page.answer(
        "When are three degrees of freedom enough for a double-row bearing?",
        "Three degrees of freedom suffice only for force and moment in one plane: "
        f"{worst[ANGLE]:.0f}° out of plane, the peak roller load errs by "
        f"{abs(worst[PEAK]):.0f}\u00a0%.",
        [
            page.value(f"error of the peak roller load, {out} [%]", worst[PEAK]),
            page.value(f"side force left unbalanced, {out} [kN]", worst[SIDE]),
            page.value(f"peak roller load with five degrees of freedom, {out} [kN]", worst[FIVE]),
            page.judged(
                "displacements under three times the loads",
                "growth of displacements under three times the loads",
                "3 to the power 1/1.1",
            ),
        ],
        TITLE.format(PEAK.partition(" [")[0].capitalize()),
    )
    page.say("Balance, symmetry and homogeneity of all five hold to the solver's residual.")


def reduced(degrees: float) -> Record:
    """The moment's axis turned by an angle: what three degrees of freedom leave."""
    a = np.radians(degrees)
    load: Floats = np.array([[2e5, 0.0, -4e5, 8e5 * np.cos(a), 8e5 * np.sin(a)]])
    five, three = equilibrium(BEARING, load), three_degrees(BEARING, load)
    left = three.unbalanced[0]
    return {
        ANGLE: degrees,
        SIDE: float(np.hypot(*left[1:3])) / 1e3,
        "moment left [kN m]": float(np.hypot(*left[3:])) / 1e3,
        FIVE: float(five.rollers.max()) / 1e3,
        PEAK: 100.0 * float(three.rollers.max() / five.rollers.max() - 1.0),
    }
