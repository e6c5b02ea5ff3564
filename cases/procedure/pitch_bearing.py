"""Rings of a pitch bearing under the root moment: oval, strains at gauges, core below the race."""

import numpy as np

from fe_drivetrain.bearing import (
    Bearing,
    HardenedCase,
    PointContact,
    RollerRow,
    angles,
    equilibrium,
    equilibrium_on_races,
    exposure,
    iso_line,
    point_contact,
    shear_at_depth,
    stresses_below_ellipse,
)
from fe_drivetrain.bearing_life.rings import races_of_revolution
from fe_drivetrain.cases import case
from fe_drivetrain.cases.procedure.pitch_loads import Pitched, pitched
from fe_drivetrain.common import Floats, Ints
from fe_drivetrain.drivetrain_file import MATERIALS
from fe_drivetrain.elasticity.revolution import (
    Meridian,
    Strip,
    dofs,
    harmonic_solver,
    meridian,
    strip_averages,
)
from fe_drivetrain.geometry import Section, Shaft
from fe_drivetrain.procedure import GAUGES, RingShape, fitted_shape
from fe_drivetrain.report import trace
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.turbine_loads.histories import rainflow_cycles

ROLLERS, PLACE, ANGLE, LENGTH = 80, 0.03, np.pi / 4.0, 0.036
ROWS = tuple(
    RollerRow(ROLLERS, s * PLACE, 1.0, s * ANGLE, 0.04, LENGTH, iso_line(LENGTH), laminae=0)
    for s in (-1, 1)
)
BEARING = Bearing("blade bearing", ROWS)
BORE, OUTSIDE, WIDTH = 1.015, 1.12, 0.2  # m, of the outer ring
NEUTRAL, HALF = 0.5 * (BORE + OUTSIDE), 0.5 * (OUTSIDE - BORE)
NECK = 1.05, 1.10  # m, radii of the hub's neck behind it
LOAD = (2e5, 0.0, 1e5, 3e6, 0.0)  # N, N m
STEEL = MATERIALS["steel"]
WAVES = 9
BALL, GROOVE = 0.04, 0.53  # m; radius of the groove over the ball's diameter
STRENGTHS = 1050e6, 400e6  # Pa, shear strength of case and core
WIND = 16.0  # m/s, of the history
CASES = (1e-3, 2e-3, 3e-3, 4e-3, 5e-3)  # m
TRANSITION = 1e-3  # m
OVAL = "Waves of the ring's radius under 3 MN m, over the length of the hub's neck"
WAVES_SHOWN = {"oval w2": "oval", "w3": "three waves", "w4": "four waves"}
SLOPES = (4.0, 9.0)  # of S-N curves


@case(
    "Rings of a pitch bearing under the root moment: oval, strains, core crushing",
    source="PROTEST 2010, ECN-E--10-100, sections 5.4.3.2, 7.1.1; Timoshenko, Strength of "
    "Materials, part II, 1956 (thin rings); Johnson 1985, Contact mechanics, sections 3.4, 4.2",
)
def run(run: Run, page: Page) -> None:
    """Thin rings, a ring on necks of several lengths, what gauges tell, and the core."""
    with run.step("thin rings"):
        thin_rings(page)
    with run.step("ring on its hub"):
        rows, shapes = on_necks(page, (0.1, 0.8) if run.quick else (0.05, 0.1, 0.2, 0.4, 0.8))
    with run.step("gauges"):
        seen, all_round = gauges(page, *shapes[-1])
    with run.step("turbine"):
        turned = pitched(WIND, 60.0 if run.quick else 600.0)
    with run.step("core"):
        load = max(float(row["largest roller load [kN]"]) for row in rows) * 1e3
        cases = core(page, load, turned)
    answer(page, rows, (seen, all_round), cases, turned)
    for name, value, unit in (
        ("ring: bore, outside, width", f"{BORE:g}, {OUTSIDE:g}, {WIDTH:g}", "m"),
        ("rollers in each of two rows at 45 degrees", ROLLERS, ""),
        ("shear strength of case and core", "1050, 400", "MPa"),
    ):
        page.assume(name, value, unit, "the report prints none: of the size of a machine of 2 MW")


def answer(
    page: Page,
    rows: list[Record],
    strains: tuple[float, float],
    cases: list[Record],
    turned: Pitched,
) -> None:
    """State how oval the ring becomes, by how the hub holds it."""
    short, long = rows[0], rows[-1]
    near, far = (float(row["oval w2 [µm]"]) for row in (short, long))
    holds = [float(row["case [mm]"]) for row in cases if row["the core fails first"] == "no"]
    page.answer(
        "How oval does a pitch bearing become under the blade-root moment, and what decides it?",
        f"A moment of 3\u00a0MN\u00a0m makes the ring oval by {near:.0f}\u00a0µm on a stiff hub, "
        f"by {far:.0f}\u00a0µm on a hub neck {long['neck [m]']:g}\u00a0m long: "
        f"{'the hub decides' if far > 1.2 * near else 'the hub hardly matters'}.",
        [
            page.value(
                f"ovality of the ring, neck of {long['neck [m]']:g} m [µm]",
                far,
                beside=near,
                by=f"neck of {short['neck [m]']:g} m",
            ),
            page.value(
                "largest roller load over that of rigid rings",
                float(long["over that of rigid rings"]),
            ),
            page.value("largest roller load [kN]", float(long["largest roller load [kN]"])),
            page.value(
                "largest strain at eight gauges [µm/m]",
                1e6 * strains[0],
                beside=1e6 * strains[1],
                by="all round",
            ),
            *(page.value("hardened depth that spares the core [mm]", depth) for depth in holds[:1]),
            page.value(
                f"largest root moment of a turbine at {WIND:g} m/s [kN m]",
                float(turned.roots.bending[:, 0].max()) / 1e3,
                beside=LOAD[3] / 1e3,
                by="load here",
            ),
        ],
        hero=OVAL,
        cautions=[
            "Dimensions, rollers and strengths are assumed, of a machine of 2 MW: the report "
            "prints none.",
            "Strain gauges on one half of the ring miss the strains of the other half.",
        ],
    )


def thin_rings(page: Page) -> None:
    """Harmonics of a thin ring of revolution against w_n = p R^4 / (E I (n^2 - 1)^2)."""
    radius, wall, width = 1.0, 0.02, 0.02
    ring = Section(length=width, outer_diameter=2 * radius + wall, inner_diameter=2 * radius - wall)
    mesh = meridian(Shaft(front=-width / 2, sections=(ring,)), wall, order=3, layers=0)
    nodes, mean, _ = strip_averages(mesh, Strip(radius - wall / 2, -width / 2, width / 2))
    push = np.zeros((3 * len(mesh.nodes), 1))
    np.add.at(push[:, 0], dofs(nodes, 1), mean)
    bending = STEEL.youngs_modulus * width * wall**3 / 12.0
    rows: list[Record] = []
    for n in (2, 3, 4):
        u = harmonic_solver(mesh, STEEL, n, np.array([], dtype=np.int64))(push)
        # 1 / pi newtons a radian
        exact = radius**3 / (np.pi * bending * (n**2 - 1.0) ** 2)
        found = float((push * u).sum())
        rows.append({"wave": n, "elements [µm/kN]": found * 1e9, "thin ring [µm/kN]": exact * 1e9})
        page.equals(
            f"thin ring, wave {n}: radial displacement over that of the formula",
            found / exact,
            1.0,
            within=2.0 * (n * wall / radius) ** 2,
            why="a thin ring leaves out shear and stretching, of the order of (n h / R)^2",
            source="w_n = p_n R^4 / (E I (n^2 - 1)^2)",
            measure="deflection",
        )
    page.section("Thin rings")
    page.table("Radial displacement by waves, elements of revolution and thin ring, R/h = 50", rows)


def on_necks(
    page: Page, necks: tuple[float, ...]
) -> tuple[list[Record], list[tuple[Meridian, Ints, Floats]]]:
    """The ring on a hub's neck that is held at its end, over the neck's length."""
    rigid = equilibrium(BEARING, [LOAD])
    psi = angles(ROWS[0])
    rows: list[Record] = []
    shapes = []
    for neck in necks:
        sections = (
            Section(length=WIDTH, outer_diameter=2 * OUTSIDE, inner_diameter=2 * BORE),
            Section(length=neck, outer_diameter=2 * NECK[1], inner_diameter=2 * NECK[0]),
        )
        mesh = meridian(Shaft(front=-WIDTH / 2, sections=sections), 0.06, order=3, layers=0)
        end = np.flatnonzero(np.abs(mesh.nodes[:, 0] - (WIDTH / 2 + neck)) < 1e-9)
        held = np.concatenate([dofs(end, c) for c in range(3)])
        races = races_of_revolution(BEARING, mesh, STEEL, BORE, held=held, harmonics=24)
        found = equilibrium_on_races(races, [LOAD])
        recession = found.recession[0, : 2 * ROLLERS].reshape(2, ROLLERS)
        outwards = recession.sum(axis=0) / (2.0 * np.cos(ANGLE))
        along = np.diff(recession, axis=0)[0] / (2.0 * np.sin(ANGLE))
        waves, axial = (np.fft.rfft(u) / (ROLLERS / 2) for u in (outwards, along))
        oval = RingShape(BORE, np.array([2]), waves.real[2:3], -waves.imag[2:3])
        across = oval.diameter(psi)
        rows.append(
            {
                "neck [m]": neck,
                "oval w2 [µm]": float(np.abs(waves[2])) * 1e6,
                "w3 [µm]": float(np.abs(waves[3])) * 1e6,
                "w4 [µm]": float(np.abs(waves[4])) * 1e6,
                "stretched by [µm]": float(waves.real[0]) / 2 * 1e6,
                "axial wave 2 [µm]": float(np.abs(axial[2])) * 1e6,
                "diameters, largest and least change of the oval [µm]": (
                    f"{across.max() * 1e6:+.0f}, {across.min() * 1e6:+.0f}"
                ),
                "largest roller load [kN]": float(found.rollers.max()) / 1e3,
                "over that of rigid rings": float(found.rollers.max() / rigid.rollers.max()),
            }
        )
        page.vanishes(
            f"neck of {neck:g} m: loads that rollers leave unbalanced, over the moment",
            float(np.abs(found.unbalanced).max()) / LOAD[3],
            within=1e-6,
            why="tolerance of the equilibrium",
            source="statics of the inner ring",
        )
        shapes.append((mesh, held, found.rollers[0]))
    show_necks(page, rows)
    return rows, shapes


def show_necks(page: Page, rows: list[Record]) -> None:
    """Waves of the ring over the length of the neck, and that a longer one holds it less."""
    page.section("Ring on its hub")
    page.table("A root moment of 3 MN m on a ring whose hub is held at the end of a neck", rows)
    page.sweep(
        OVAL,
        rows,
        "neck [m]",
        {f"{wave} [µm]": name for wave, name in WAVES_SHOWN.items()},
        axis="radial displacement [µm]",
        table=False,
    )
    page.data("necks", rows)
    page.holds(
        "a longer neck lets the ring become more oval",
        bool(np.all(np.diff([float(r["oval w2 [µm]"]) for r in rows]) > 0.0)),
        why="what holds the ring round is farther away",
        source="the hub holds the ring",
    )


def on_the_outside(
    mesh: Meridian, held: Ints, rollers: Floats, places: Floats
) -> tuple[Floats, Floats]:
    """Strain around and radial displacement [m] outside of the ring, in its middle."""
    outer = int(np.hypot(mesh.nodes[:, 0], mesh.nodes[:, 1] - OUTSIDE).argmin())
    r = float(mesh.nodes[outer, 1])
    psi = angles(ROWS[0])
    strain, outwards = np.zeros(len(places)), np.zeros(len(places))
    for n in range(WAVES):
        still = np.unique(np.concatenate([held, dofs(np.arange(len(mesh.nodes)), 2)]))
        solve = harmonic_solver(mesh, STEEL, n, still if n == 0 else held)
        for row, loads in zip(ROWS, rollers.reshape(2, ROLLERS), strict=True):
            middle = row.place + (BORE - row.radius) * np.tan(row.angle)
            half = 0.5 * row.length * np.cos(row.angle)
            nodes, mean, _ = strip_averages(mesh, Strip(BORE, middle - half, middle + half))
            push = np.zeros((3 * len(mesh.nodes), 1))
            np.add.at(push[:, 0], dofs(nodes, 0), np.sin(row.angle) * mean)
            np.add.at(push[:, 0], dofs(nodes, 1), np.cos(row.angle) * mean)
            u = solve(push)[:, 0]
            radial, around = u[dofs(np.array([outer]), 1)[0]], u[dofs(np.array([outer]), 2)[0]]
            waves = np.cos(n * np.subtract.outer(places, psi)) @ loads
            outwards += radial * waves
            strain += (radial + n * around) / r * waves
    return strain, outwards


def gauges(page: Page, mesh: Meridian, held: Ints, rollers: Floats) -> tuple[float, float]:
    """Strain at the published places, and the waves that a fit of constant length makes of it."""
    dense = np.linspace(0.0, 2.0 * np.pi, 360, endpoint=False)
    at = np.array(GAUGES)
    strains, outwards = on_the_outside(mesh, held, rollers, np.concatenate([dense, at]))
    strain, values = strains[: len(dense)], strains[len(dense) :]
    true = float(np.abs(np.fft.rfft(outwards[: len(dense)])[2])) / (len(dense) / 2)
    rows: list[Record] = [
        {
            "waves fitted": ", ".join(map(str, orders)),
            "w2 from strains [µm]": float(np.hypot(fit.shape.cosine[0], fit.shape.sine[0])) * 1e6,
            "w2 of the ring there [µm]": true * 1e6,
            "left over [µm/m]": fit.residual * 1e6,
            "strains, standard deviation [µm/m]": float(values.std()) * 1e6,
            "condition": fit.condition,
        }
        for orders in ([2], [2, 3], [2, 4])
        for fit in (fitted_shape(NEUTRAL, HALF, at, values, orders),)
    ]
    page.section("Gauges")
    page.table("Eight gauges at the published places, outside of the ring, in its middle", rows)
    chart_strain(page, dense, strain, values)
    page.data("gauges", rows)
    page.text(
        f"Gauges that stand on one half see {values.max() * 1e6:.0f} µm/m at most, the ring has "
        f"{strains.max() * 1e6:.0f} µm/m on the other half: one wave round, which a ring of "
        "constant length has not, comes of the hub that holds it."
    )
    page.holds(
        "an oval of constant length leaves more than a fifth of the strains unexplained",
        float(rows[0]["left over [µm/m]"]) > 0.2 * float(values.std()) * 1e6,
        why="the ring is also stretched, bent out of its plane and held by the hub",
        source="PROTEST 2010, section 5.4.3.2: the fit did not match the measurements",
    )
    return float(values.max()), float(strains.max())


def chart_strain(page: Page, dense: Floats, strain: Floats, values: Floats) -> None:
    """Strain round the ring, at gauges, and of an oval fitted to these."""
    at = np.array(GAUGES)
    oval = fitted_shape(NEUTRAL, HALF, at, values, [2])
    page.chart(
        "Strain round the ring: all of it, at gauges, and as an oval of constant length has it",
        [
            trace("ring on its neck", np.degrees(dense), strain * 1e6),
            trace("gauges", np.degrees(at) % 360.0, values * 1e6, mode="markers"),
            trace(
                "oval fitted to the gauges",
                np.degrees(dense),
                (oval.shape.strain(dense, HALF) + oval.offset) * 1e6,
                line={"dash": "dash"},
            ),
        ],
        "angle [deg]",
        "strain [µm/m]",
    )


def core(page: Page, load: float, turned: Pitched) -> list[Record]:
    """Shear stress over strength below a ball's contact, over the depth of the case."""
    over = 2.0 / BALL
    contact = point_contact((over - 1.0 / (GROOVE * BALL), over + 1.0 / (1.0 + 0.5 * BALL)))
    a, b = (axis * np.cbrt(load) for axis in contact.half_axes)
    pressure = float(contact.pressure(np.array(load)))
    depths = np.linspace(0.1 * b, 8e-3, 400)
    stresses = stresses_below_ellipse(depths, (float(a), float(b)), pressure)
    rows: list[Record] = []
    for depth in CASES:
        found = exposure(depths, stresses, HardenedCase(*STRENGTHS, depth, TRANSITION))
        rows.append(
            {
                "case [mm]": depth * 1e3,
                "shear over strength, case": found.case,
                "core": found.core,
                "depth of that in the core [mm]": found.core_depth * 1e3,
                "the core fails first": "yes" if found.crushes else "no",
            }
        )
    page.equals(
        "normal stress below the contact, over -p0 / sqrt((1 + z^2 / a^2) (1 + z^2 / b^2))",
        float(
            np.abs(
                stresses[:, 2]
                * np.sqrt((1.0 + (depths / a) ** 2) * (1.0 + (depths / b) ** 2))
                / -pressure
            ).max()
        ),
        1.0,
        within=1e-6,
        why="Gauss's rule keeps six digits from a tenth of the short half axis down",
        source="the limits of a circle and of a line, Johnson 1985, Eq 3.45, 4.46",
        measure="stress",
    )
    shares: Floats = np.array([float(r["core"]) for r in rows])
    page.holds(
        "a deeper case unloads the core",
        bool(np.all(np.diff(shares) < 0.0)),
        why="shear falls with depth below the contact's largest",
        source="Hertz",
    )
    page.section("Core crushing")
    page.sweep(
        f"A ball of {BALL * 1e3:g} mm under {load / 1e3:.0f} kN ({pressure / 1e9:.2f} GPa): shear "
        "stress over strength",
        rows,
        "case [mm]",
        {"shear over strength, case": "in the case", "core": "in the core"},
        axis="shear stress over strength",
    )
    fatigue(page, contact, load, turned)
    page.text(
        "The load is the largest of a rolling element above. Case and core are compared with half "
        "of their yield stress. ISO 281 and ISO 76 are for bearings that turn, and for rings that "
        "are hard throughout."
    )
    return rows


def fatigue(page: Page, contact: PointContact, load: float, turned: Pitched) -> None:
    """Damage of the core at the end of the case, over that below the deepest case.

    The load of the contact is that under the root moment of 3 MN m, in proportion to the moment.
    """
    bending = turned.roots.bending[:, 0]
    loads = bending * (load / LOAD[3])
    damages = []
    for depth in CASES:
        cycles = rainflow_cycles(shear_at_depth(contact, loads, depth + TRANSITION))
        damages.append([float(cycles.counts @ cycles.ranges**slope) for slope in SLOPES])
    over: Floats = np.array(damages) / damages[-1]
    rows: list[Record] = [
        {"case [mm]": depth * 1e3}
        | {f"slope {slope:g}": float(d) for slope, d in zip(SLOPES, row, strict=True)}
        for depth, row in zip(CASES, over, strict=True)
    ]
    page.holds(
        "a deeper case has less damage in the core, the more so the steeper the S-N curve",
        bool((np.diff(over, axis=0) < 0.0).all() and (np.diff(over[:-1], axis=1) > 0.0).all()),
        why="ranges of shear stress fall with depth",
        source="Miner 1945",
    )
    page.table(
        "Fatigue: damage in the core below the transition, over that of the deepest case, by slope "
        "of the S-N curve of shear ranges",
        rows,
    )
    page.data("core fatigue", rows)
    cycles = rainflow_cycles(bending)
    count = float(cycles.counts[cycles.ranges > 0.1 * float(np.ptp(bending))].sum())
    page.text(
        f"The most loaded contact follows the root moment of a blade of a turbine that moves, at "
        f"{WIND:g} m/s: {bending.min() / 1e6:.2f} to {bending.max() / 1e6:.2f} MN m, with "
        f"{count:.0f} cycles above a tenth of its range in {turned.step * len(bending):.0f} s. "
        "Damages are compared, so that no S-N curve of the core is needed; a life needs one."
    )
