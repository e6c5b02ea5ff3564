"""What holds for every bearing: homogeneity, symmetry, balance; three degrees against five."""

import numpy as np

from fe_drivetrain.bearing import catalogue_bearing, equilibrium, forces, three_degrees, turn
from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats
from fe_drivetrain.suite import Page, Record, Run

#: Axial, radial, moment and combined loads [kN, kN m].
LOADS = 1e3 * np.array(
    [
        (200, 0, -400, 800, 0),
        (200, 0, -400, -800, 0),
        (200, 0, -400, 0, 800),
        (100, 0, -400, -300, 0),
        (-50, 90, 20, 10, -600),
    ]
)
SOURCE = "identities of the model of Stirling 2023, ch. 4"


@case(
    "Identities of a double-row tapered bearing, and three degrees against five",
    source="identities of the model of Stirling 2023, ch. 4",
)
def run(run: Run, page: Page) -> None:
    """Scale, turn and mirror the loads; reduce them to three degrees of freedom."""
    bearing = catalogue_bearing("bearing_s")
    Z = bearing.counts[0]
    with run.step("equilibrium"):
        base = equilibrium(bearing, LOADS, tolerance=1e-12)
        scaled = equilibrium(bearing, 3.0 * LOADS, tolerance=1e-12)
        turned = equilibrium(
            bearing, turn(LOADS, np.full(len(LOADS), 2 * np.pi / Z)), tolerance=1e-12
        )
        mirror = np.array([-1, 1, 1, -1, -1])
        image = equilibrium(bearing, LOADS * mirror, tolerance=1e-12)
        K = forces(bearing, base.displacements)[1]
    peak = base.rollers.max()
    shifted = np.roll(base.rollers.reshape(-1, 2, Z), 1, axis=2).reshape(len(LOADS), -1)
    for name, value, why in (
        ("loads times 3: rollers times 3", scaled.rollers / 3.0 - base.rollers, "no clearance"),
        ("loads turned by one pitch: rollers moved by one", turned.rollers - shifted, "symmetry"),
        ("mirrored loads: rows exchanged", image.rollers - np.roll(base.rollers, Z, 1), "symmetry"),
        ("unbalanced loads", base.unbalanced, "the residual that the solver leaves"),
    ):
        page.vanishes(
            f"{name}, over the peak roller",
            float(np.abs(value).max() / peak),
            within=1e-7,
            why=f"exact but for the solver's residual: {why}",
            source=SOURCE,
        )
    page.equals(
        "displacements under three times the loads",
        float(scaled.displacements[0, 2] / base.displacements[0, 2]),
        3.0 ** (1 / 1.1),
        within=1e-8,
        why="exact but for the solver's residual",
        source="load is displacement to the power 1.1 where there is no clearance",
        measure="deflection",
    )
    page.vanishes(
        "asymmetry of the tangent stiffness",
        float(np.abs(K - np.swapaxes(K, 1, 2)).max() / np.abs(K).max()),
        within=1e-14,
        why="round-off",
        source="an energy",
        basis="self-consistency",
    )
    with run.step("three degrees"):
        rows = [reduced(float(angle)) for angle in range(0, 91, 30 if run.quick else 5)]
    page.vanishes(
        "force and moment in one plane: side force left by three degrees",
        rows[0]["side force left [kN]"],
        within=1e-3,
        why="exact but for the solver's residual: 1e-8 of the load",
        source="Stirling 2023, section 4.2.1",
        unit="kN",
    )
    worst = max(rows, key=lambda row: abs(row["error of the peak roller [%]"]))
    page.answer(
        "Balance, symmetry and homogeneity hold to the solver's residual.",
        "The reduction to three degrees is exact where force and moment act in one plane; a moment "
        f"turned by {worst['angle out of plane [deg]']:.0f} deg out of it leaves "
        f"{worst['side force left [kN]']:.0f} kN of side force unbalanced and changes the peak "
        f"roller by {worst['error of the peak roller [%]']:.0f} %.",
    )
    page.section("Three degrees against five")
    for y in ("side force left [kN]", "error of the peak roller [%]"):
        page.sweep(
            f"{y.partition(' [')[0].capitalize()}: 200 kN axial, 400 kN down, 800 kN m, its axis "
            "turned out of plane",
            rows,
            "angle out of plane [deg]",
            y,
            table=y.startswith("side"),
        )


def reduced(degrees: float) -> Record:
    """The moment's axis turned by an angle: what three degrees of freedom leave."""
    a = np.radians(degrees)
    load: Floats = np.array([[2e5, 0.0, -4e5, 8e5 * np.cos(a), 8e5 * np.sin(a)]])
    bearing = catalogue_bearing("bearing_s")
    five, three = equilibrium(bearing, load), three_degrees(bearing, load)
    left = three.unbalanced[0]
    return {
        "angle out of plane [deg]": float(degrees),
        "side force left [kN]": float(np.hypot(*left[1:3])) / 1e3,
        "moment left [kN m]": float(np.hypot(*left[3:])) / 1e3,
        "peak roller, five [kN]": float(five.rollers.max()) / 1e3,
        "error of the peak roller [%]": 100.0
        * float(three.rollers.max() / five.rollers.max() - 1.0),
    }
