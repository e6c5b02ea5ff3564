"""Raceway as it gives way: influence functions of a ring, and the rollers' share of the load."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: Raceway and outside of the ring, its width, and the rollers' length [m].
RACEWAY, OUTSIDE, WIDTH, ROLLER = 0.35, 0.40, 0.16, 0.12
ROLLERS = 24
#: Outer radius of the ring with its housing, where that is part of it [m].
HOUSINGS = (0.45, 0.55)
#: Half of the angle between two feet, from the direction of the load [rad].
FEET = 0.9
LOAD = 1e6  # N

#: Spring of a roller and its two contacts [N/m].
STIFFNESS = 2e9
EXPONENTS = (1.0, 10 / 9, 1.5)

HARMONICS, QUICK_HARMONICS = 96, 32
ORDERS, QUICK_ORDERS = (6, 8), (5, 6)
LEVELS, QUICK_LEVELS = (1, 2, 3), (1, 2)
#: Of the thin ring, mean radius over wall.
THIN = 40.0


def run(run: Run) -> Any:
    """Check the influence functions in four ways, then let rollers press."""
    import numpy as np
    from scipy.optimize import brentq

    from fe_drivetrain.compare import (
        band_of,
    )
    from fe_drivetrain.geometry import Section as Length
    from fe_drivetrain.geometry import Shaft
    from fe_drivetrain.operator import traction_loads
    from fe_drivetrain.report import AssumptionRow, Section, Table, Text, chart, judge, trace
    from fe_drivetrain.revolution import (
        Strip,
        carried,
        freedoms,
        influence_functions,
        meridian,
        roller_forces,
    )
    from fe_drivetrain.scene import MATERIALS
    from fe_drivetrain.solve import solve_solid
    from fe_drivetrain.validation.plane_rings import (
        Lame,
        harmonics,
        plane_strain,
    )
    from fe_drivetrain.validation.ring_solids import (
        on_plane,
        ring_sector,
        sector_symmetry,
    )

    steel = MATERIALS["steel"]
    pitch = 2 * np.pi / ROLLERS
    half = pitch / 4
    count = QUICK_HARMONICS if run.quick else HARMONICS
    margin = (WIDTH - ROLLER) / 2

    def ring(inner: float, outer: float, width: float, size: float, order: int = 6) -> Any:
        shaft = Shaft(
            front=0.0,
            sections=(Length(length=width, outer_diameter=2 * outer, inner_diameter=2 * inner),),
        )
        return meridian(shaft, size, order=order, layers=0)

    def strips(outer: float) -> list[Strip]:
        return [Strip(r, margin, WIDTH - margin) for r in (RACEWAY, outer)]

    verdicts = []

    with run.step("plane strain, against Michell"):
        whole = [Strip(r, 0.0, WIDTH) for r in (RACEWAY, OUTSIDE)]
        plane = plane_strain(steel.youngs_modulus, steel.poisson_ratio)
        pressure = 1.0 / (np.pi * RACEWAY * WIDTH)
        n = np.arange(2, count + 1)
        series = harmonics(n, RACEWAY, OUTSIDE, np.full(len(n), pressure), np.zeros(len(n)))
        exact = series.displacement_amplitudes(RACEWAY, plane)[0]
        planes = []
        orders_of_elements = QUICK_ORDERS if run.quick else ORDERS
        for order in orders_of_elements:
            mesh = ring(RACEWAY, OUTSIDE, WIDTH, 0.02, order)
            still = freedoms(np.arange(len(mesh.nodes)), 0)
            planes.append(
                influence_functions(
                    mesh, steel, whole, count, half, held=still, anchor=whole[1]
                ).harmonic_compliances[:, 0, 0]
            )
    for k in (0, 2, 8, count):
        lame = Lame(RACEWAY, OUTSIDE, inside=pressure / 2).displacement(np.array(RACEWAY), plane)
        reference = float(lame) if k == 0 else float(exact[k - 2])
        verdicts.append(
            judge(
                f"harmonic {k}: compliance of the raceway in plane strain",
                planes[-1][k],
                reference,
                tolerance=max(1e-9, abs(planes[-1][k] - planes[0][k]) / reference),
                unit="m/N",
                source="Lame 1852" if k == 0 else "Michell 1899: four powers of the radius",
                reason="what the higher order of elements of two changed, or round-off",
                measure="deflection",
                band=abs(planes[-1][k] - planes[0][k]),
            )
        )

    with run.step("thin ring"):
        # pushed apart at two opposite places, and narrow: plane stress
        wall = RACEWAY / THIN
        inner, outer, width = RACEWAY - wall / 2, RACEWAY + wall / 2, wall
        mesh = ring(inner, outer, width, width)
        outside = Strip(outer, 0.0, width)
        # so narrow that the oval does not see its width: a patch takes (2 a)^2 / 3 off it
        narrow = wall / (10 * RACEWAY)
        thin, fewer = (
            influence_functions(mesh, steel, [outside], k, narrow, anchor=outside) for k in (40, 20)
        )
        across, short = (f.matrix([0.0, np.pi / 2, np.pi])[1, [0, 2]].sum() for f in (thin, fewer))
        E, G = steel.youngs_modulus, steel.shear_modulus
        area, inertia = wall * width, width * wall**3 / 12
        # energy of a curved beam in bending, tension and shear, its middle line's ends turned back
        slim = inertia / (area * RACEWAY**2)
        sheared = 1.2 * E * inertia / (G * area * RACEWAY**2)
        one, two = 1.0 - slim + sheared, 1.0 - slim
        beam = -(RACEWAY**3) / (E * inertia) * (2 * two**2 / np.pi - two + one / 2) / 2
    verdicts.append(
        judge(
            f"thin ring, radius over wall {THIN:g}: radius across two opposite pushes",
            across,
            beam,
            tolerance=1.0 / THIN**2,
            unit="m/N",
            source="curved beam with tension and shear (Roark's formulas, thin rings, case 1)",
            reason="what beam theory leaves out is of the order of (wall over radius)^2",
            measure="deflection",
            band=abs(across - short),
        )
    )

    with run.step("free ring, by harmonics"):
        mesh = ring(RACEWAY, OUTSIDE, WIDTH, 0.02)
        found = influence_functions(
            mesh, steel, strips(OUTSIDE), count, half, anchor=strips(OUTSIDE)[1]
        )
        rough = influence_functions(
            ring(RACEWAY, OUTSIDE, WIDTH, 0.02, 5),
            steel,
            strips(OUTSIDE),
            count,
            half,
            anchor=strips(OUTSIDE)[1],
        )
        places = np.array([0.0, np.pi, np.pi / 2])

        def squeezed(f: Any) -> Any:
            C = f.matrix(places)[::2, ::2]
            return C[0, 0] + C[0, 1], C[2, 0] + C[2, 1]

        flat, flatter = squeezed(found), squeezed(rough)
        tail = float(found.tail[0])

    def solid(level: int) -> tuple[float, float]:
        """Mean radial displacement under two opposite pushes of 1 N, and across them."""
        fine = np.arange(0, 3 * level + 1) * half / level
        last = 0.5 * np.pi - fine[::-1]
        middle = np.linspace(fine[-1], last[0], 9 * level + 1)
        around = np.concatenate([fine, middle[1:-1], last]) / (0.5 * np.pi)
        along = np.concatenate(
            [
                np.linspace(0.0, ROLLER / WIDTH, 2 * level + 1),
                np.linspace(ROLLER / WIDTH, 1.0, level + 1)[1:],
            ]
        )
        block = ring_sector(
            RACEWAY, OUTSIDE, WIDTH / 2, 0.5 * np.pi, (2 * level, 1, 1), 27, (None, around, along)
        )
        area = RACEWAY * half * ROLLER / 2

        def push(at: float) -> Any:
            centres = block.points[block.faces["x0"]].mean(axis=1)
            angle = np.arctan2(centres[:, 2], centres[:, 1])
            patch = block.faces["x0"][(np.abs(angle - at) < half) & (centres[:, 0] < ROLLER / 2)]
            return traction_loads(
                block.points,
                patch,
                lambda x, _: (
                    np.column_stack([0 * x[:, 0], x[:, 1], x[:, 2]])
                    / (np.hypot(x[:, 1], x[:, 2])[:, None] * 4 * area)
                ),
            )

        held = [
            *sector_symmetry(block, 0.5 * np.pi),
            on_plane("middle", block.face_nodes("z0"), (1.0, 0.0, 0.0), block.points.size),
        ]
        u = solve_solid(block.points, block.cells, steel.lame, held, push(0.0)).u[:, 0]
        return tuple(4 * float(push(at) @ u) for at in (0.0, 0.5 * np.pi))  # type: ignore[return-value]

    levels = QUICK_LEVELS if run.quick else LEVELS
    with run.step("free ring, as a solid"):
        solids = [solid(level) for level in levels]
    sizes = 1.0 / np.array(levels)
    for k, place in enumerate(("under", "across")):
        values = [s[k] for s in solids]
        band = abs(values[-1] - values[-2]) if run.quick else band_of(sizes, values)
        # of the sum: its orders, and the meridian's mesh
        left = (tail if k == 0 else 0.0) + abs(flat[k] - flatter[k])
        verdicts.append(
            judge(
                f"free ring: radial displacement {place} two opposite pushes",
                flat[k],
                values[-1],
                tolerance=(band + left) / abs(values[-1]),
                unit="m/N",
                source=f"solid of hexahedra of 27 nodes, {len(levels)} meshes",
                reason="the solid's band, the tail of the sum, and what one order changed of the "
                "meridian",
                measure="deflection",
                band=left,
            )
        )

    angles = pitch * np.arange(ROLLERS)
    with run.step("reciprocity and equal pushes"):
        matrix = found.matrix(angles)
        equal = matrix.reshape(ROLLERS, 2, ROLLERS, 2).sum(axis=2)[0]
        few = np.arange(0, count + 1, ROLLERS)
        alone = ROLLERS * np.tensordot(found.shares[few] ** 2, found.harmonic_compliances[few], 1)
    for quantity, computed, scale, source in (
        (
            "influence of one patch on another less the other way round",
            np.abs(matrix - matrix.T).max(),
            np.abs(matrix).max(),
            "reciprocity (Betti 1872)",
        ),
        (
            f"equal pushes of {ROLLERS} rollers less harmonics 0, {ROLLERS}, {2 * ROLLERS} ...",
            np.abs(equal - alone).max(),
            np.abs(alone).max(),
            "sum of a cosine over equal angles",
        ),
    ):
        verdicts.append(
            judge(
                f"{quantity}, relative",
                computed / scale,
                0.0,
                tolerance=1e-10,
                relative=False,
                source=source,
                reason="round-off of a sum of some hundred terms",
                measure="identity",
                band=0.0,
            )
        )

    # the ring on two feet: neither on its raceway nor anywhere else held otherwise
    feet = np.array([FEET, -FEET])
    everywhere = np.concatenate([angles, feet])
    rigid = np.column_stack([np.cos(everywhere), np.sin(everywhere)])

    def functions(outer: float, highest: int, anchor: int = 1) -> Any:
        both = strips(outer)
        mesh = ring(RACEWAY, outer, WIDTH, 0.02 if outer < 0.5 else 0.03)
        return influence_functions(mesh, steel, both, highest, half, anchor=both[anchor])

    def on_feet(f: Any) -> Any:
        """(rollers, rollers) of the ring that stands on two feet."""
        chosen = np.concatenate([2 * np.arange(ROLLERS), 2 * np.arange(ROLLERS, ROLLERS + 2) + 1])
        return carried(f.matrix(everywhere)[np.ix_(chosen, chosen)], rigid, [ROLLERS, ROLLERS + 1])

    with run.step("ring on two feet"):
        compliances = {f"{OUTSIDE:g}": on_feet(found)}
        for outer in HOUSINGS:
            compliances[f"{outer:g}"] = on_feet(functions(outer, count))
        one, other = (on_feet(functions(OUTSIDE, 8, anchor)) for anchor in (1, 0))
        mesh = ring(RACEWAY, OUTSIDE, WIDTH, 0.02)
        still = np.flatnonzero(np.abs(mesh.nodes[:, 1] - OUTSIDE) < 1e-9)
        housed = influence_functions(
            mesh,
            steel,
            strips(OUTSIDE)[:1],
            count,
            half,
            held=np.concatenate([freedoms(still, c) for c in range(3)]),
        ).matrix(angles)
    first = compliances[f"{OUTSIDE:g}"]
    verdicts.append(
        judge(
            "ring on two feet: compliance by one anchor less that by another, relative",
            np.abs(one - other).max() / np.abs(one).max(),
            0.0,
            tolerance=1e-8,
            relative=False,
            source="forces in balance leave nothing to the anchor",
            reason="round-off, times some hundred: the ring is that much softer than its contact",
            measure="identity",
            band=0.0,
        )
    )

    def rollers(compliance: Any, stiffness: float, exponent: float) -> Any:
        """Forces that carry the load, the shaft rigid, no clearance; and how far it moves."""

        def forces(down: float) -> Any:
            return roller_forces(compliance, down * np.cos(angles), stiffness, exponent)

        largest = 20 * LOAD * (1 / stiffness + np.abs(compliance).max())
        down = brentq(lambda d: forces(d) @ np.cos(angles) - LOAD, 0.0, largest, xtol=1e-16)
        return forces(down), down

    nothing = np.zeros((ROLLERS, ROLLERS))
    with run.step("rollers"):
        pressed = {"rigid ring": rollers(nothing, STIFFNESS, 1.0)}
        pressed["ring in a rigid housing"] = rollers(housed, STIFFNESS, 1.0)
        for name, compliance in compliances.items():
            pressed[f"on two feet, outer radius {name} m"] = rollers(compliance, STIFFNESS, 1.0)
        # stiffness in N/m^exponent: alike at a tenth of a millimetre
        rigid_factors = [
            ROLLERS * rollers(nothing, STIFFNESS * 1e-4 ** (1 - e), e)[0].max() / LOAD
            for e in EXPONENTS
        ]
        nearly = rollers(1e-9 * first, STIFFNESS, 1.0)[0]
    x, w = np.polynomial.legendre.leggauss(200)
    angle = x * np.pi / 2
    for e, factor in zip(EXPONENTS, rigid_factors, strict=True):
        integral = w @ np.cos(angle) ** (e + 1) / 4
        verdicts.append(
            judge(
                f"rigid ring, exponent {e:.3g}: most loaded roller times their number over load",
                factor,
                1.0 / float(integral),
                tolerance=1e-9 if e == 1.0 else (pitch / 2) ** (e + 2),
                source="integral over the loaded half (Stribeck, Sjoevall: 4.37 of a point "
                "contact, 4.08 of a line contact)",
                reason="the sum over rollers of cos^2 is exact"
                if e == 1.0
                else "sum for an integral whose end goes as the angle to the power exponent + 1",
                measure="reaction",
                band=0.0,
            )
        )
    verdicts.append(
        judge(
            "ring of nearly no compliance: forces less those of the rigid ring, over the largest",
            np.abs(nearly - pressed["rigid ring"][0]).max() / nearly.max(),
            0.0,
            tolerance=1e-6,
            relative=False,
            source="the rigid limit",
            reason="a billionth of the ring's compliance, which is some hundred times a roller's",
            measure="identity",
            band=0.0,
        )
    )
    largest = max(
        np.abs(f @ np.sin(angles)) / LOAD + abs(f @ np.cos(angles) / LOAD - 1)
        for f, _ in pressed.values()
    )
    verdicts.append(
        judge(
            "rollers' forces less the load, relative, the worst",
            largest,
            0.0,
            tolerance=1e-9,
            relative=False,
            source="balance",
            reason="the shaft's displacement is found to 1e-16 m of some 1e-4 m",
            measure="identity",
            band=0.0,
        )
    )
    shown = np.degrees(np.where(angles > np.pi, angles - 2 * np.pi, angles))
    by_angle = np.argsort(shown)
    factors = {name: ROLLERS * f.max() / LOAD for name, (f, _) in pressed.items()}
    feet_names = [name for name in pressed if "feet" in name]
    own = found.matrix([0.0])[0, 0]
    orders = np.arange(1, count + 1)
    sums = np.cumsum(found.shares**2 * found.harmonic_compliances[:, 0, 0])[1:]
    return CASE.results(
        run,
        summary=[
            f"On a ring that stands on two feet at {np.degrees(FEET):.0f} degrees the most loaded "
            f"roller carries {factors[feet_names[0]]:.2f} times the mean of the load over all "
            f"{ROLLERS} (rigid: {factors['rigid ring']:.2f}; with {HOUSINGS[-1] - OUTSIDE:.2f} "
            f"m of housing around it {factors[feet_names[-1]]:.2f}): the ring gives way between "
            "its feet, and the rollers above these take over.",
            f"The influence functions agree with a solid within its band "
            f"({100 * abs(flat[0] / solids[-1][0] - 1):.2g} % under two opposite pushes, "
            f"{100 * abs(flat[1] / solids[-1][1] - 1):.2g} % across them); {count} harmonics leave "
            f"{100 * tail / own:.2g} % of a patch's own compliance.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Rollers round the ring",
                items=[
                    chart(
                        f"Force of each roller over load / {ROLLERS}; the load acts at 0",
                        [
                            trace(name, shown[by_angle], (f * ROLLERS / LOAD)[by_angle])
                            for name, (f, _) in pressed.items()
                        ],
                        "angle from the load [deg]",
                        "force / (load / number of rollers) [-]",
                    ),
                    Table(
                        caption="Most loaded roller",
                        columns=[
                            "ring",
                            "its force [kN]",
                            "times number of rollers over load",
                            "rollers that press",
                            "shaft moves by [µm]",
                        ],
                        rows=[
                            [name, f.max() / 1e3, factors[name], int((f > 0).sum()), 1e6 * d]
                            for name, (f, d) in pressed.items()
                        ],
                    ),
                    Text(
                        text="The shaft is rigid and there is no clearance; each roller with its "
                        "contacts is a spring. A patch is as wide as half of the distance between "
                        "rollers, so that their contact's own approach, which the spring stands "
                        "for, isn't counted twice. Forces on the raceway are radial, and all "
                        "along a roller the same. Feet are as narrow as a patch, and don't give "
                        "along the radius; friction there and all else that would hold the ring "
                        "are left out, so that a real housing is stiffer."
                    ),
                ],
            ),
            Section(
                title="Influence functions",
                items=[
                    chart(
                        "Compliance of the raceway by harmonic: relative to the outside, free ring",
                        [
                            trace("free ring", orders[1:], found.harmonic_compliances[2:, 0, 0]),
                            trace("half space in plane strain", orders, found.limits[0] / orders),
                        ],
                        "harmonic n",
                        "compliance [m/N]",
                        logarithmic="xy",
                    ),
                    chart(
                        "What orders above n add to a patch's own compliance, relative",
                        [
                            trace("sum", orders[1:-1], (sums[-1] - sums[1:-1] + tail) / own),
                            trace(
                                "estimate, last order over n",
                                orders[1:-1],
                                [_estimate(found, k) / own for k in orders[1:-1]],
                            ),
                        ],
                        "highest harmonic n",
                        "left out [-]",
                        logarithmic="xy",
                    ),
                    Table(
                        caption="Free ring under two opposite pushes of 1 N [m]",
                        columns=["", *(f"solid, cut {k}" for k in levels), "meridian"],
                        rows=[
                            [place, *(s[k] for s in solids), flat[k]]
                            for k, place in enumerate(("under a push", "across"))
                        ],
                    ),
                ],
            ),
        ],
        assumptions=[
            AssumptionRow(name=name, value=value, unit=unit, source=source)
            for name, value, unit, source in (
                ("radius of the raceway", RACEWAY, "m", "size of a 2 MW main bearing, chosen"),
                ("outer radius of the ring", OUTSIDE, "m", "chosen"),
                ("width of the ring", WIDTH, "m", "chosen"),
                ("length of a roller", ROLLER, "m", "chosen"),
                ("number of rollers", ROLLERS, "-", "chosen"),
                ("feet from the load's direction", FEET, "rad", "chosen"),
                ("stiffness of a roller with its contacts", STIFFNESS, "N/m", "order of magnitude"),
                ("load", LOAD, "N", "chosen; forces are in proportion"),
            )
        ],
        figures={
            "angles": angles.tolist(),
            "forces": {name: f.tolist() for name, (f, _) in pressed.items()},
            "factors": factors,
            "tail": tail / own,
        },
    )


def _estimate(found: Any, last: int) -> float:
    """The tail that fewer harmonics would have."""
    from dataclasses import replace

    fewer = replace(found, harmonic_compliances=found.harmonic_compliances[: last + 1])
    return float(fewer.tail[0])


CASE = Case(
    name="fidelity/raceway_influence",
    title="Raceway that gives way: influence functions of a ring, and the rollers' share",
    source="Michell 1899 in plane strain; curved beam; a solid of hexahedra; Betti 1872; "
    "Stribeck 1901 for the rigid ring; dimensions assumed",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
