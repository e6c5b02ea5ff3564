"""Raceway as it gives way: influence functions of a ring, and the rollers' share of the load."""

from dataclasses import dataclass, replace

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.fidelity.rollers_on_rings import (
    Pressed,
    RollerRing,
    ring_meridian,
    squeezed,
)
from fe_drivetrain.cases.references.plane_rings import Lame, harmonics, plane_strain
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import band_of
from fe_drivetrain.drivetrain_file import MATERIALS
from fe_drivetrain.elasticity.revolution import InfluenceFunctions, Strip, dofs, influence_functions
from fe_drivetrain.report import Cell, trace
from fe_drivetrain.report.suite import Page, Run

STEEL = MATERIALS["steel"]

#: Raceway and outside of the ring, its width, and the rollers' length [m].
RACEWAY, OUTSIDE, WIDTH, ROLLER = 0.35, 0.40, 0.16, 0.12
ROLLERS = 24
PITCH = 2 * np.pi / ROLLERS
RING = RollerRing(RACEWAY, OUTSIDE, WIDTH, ROLLER, ROLLERS, STEEL)
ANGLES, HALF = RING.angles, RING.half
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


@dataclass(frozen=True)
class FreeRing:
    """A free ring under two opposite pushes of 1 N: radial displacement under them and across.

    Attributes
    ----------
    found : InfluenceFunctions
        By harmonics.
    flat, rough : tuple of float
        By these, and by elements of one order less [m].
    solids : list of tuple of float
        By solids, from coarse to fine [m].
    """

    found: InfluenceFunctions
    flat: tuple[float, float]
    rough: tuple[float, float]
    solids: list[tuple[float, float]]

    @property
    def tail(self) -> float:
        """Left out by the sum over harmonics, of a patch's own compliance [m/N]."""
        return float(self.found.tail[0])

    @property
    def own(self) -> float:
        """A patch's own compliance [m/N]."""
        return float(self.found.matrix([0.0])[0, 0])


@case(
    "Raceway that gives way: influence functions of a ring, and the rollers' share",
    source="Michell 1899 in plane strain; curved beam; a solid of hexahedra; Betti 1872; "
    "Stribeck 1901 for the rigid ring; dimensions assumed",
)
def run(run: Run, page: Page) -> None:
    """Check the influence functions in four ways, then let rollers press."""
    count = QUICK_HARMONICS if run.quick else HARMONICS
    levels = QUICK_LEVELS if run.quick else LEVELS
    with run.step("plane strain, against Michell"):
        _check_plane_strain(page, count, QUICK_ORDERS if run.quick else ORDERS)
    with run.step("thin ring"):
        _check_thin_ring(page)
    with run.step("free ring, by harmonics"):
        found = RING.functions(count)
        flat, rough = squeezed(found), squeezed(RING.functions(count, order=5))
    with run.step("free ring, as a solid"):
        free = FreeRing(found, flat, rough, [RING.solid(level) for level in levels])
    _check_free_ring(page, free, levels)
    with run.step("reciprocity and equal pushes"):
        _check_sums(page, found, count)
    with run.step("ring on two feet"):
        compliances = {f"{OUTSIDE:g}": RING.on_feet(found, FEET)}
        for outer in HOUSINGS:
            ring = replace(RING, outside=outer)
            compliances[f"{outer:g}"] = ring.on_feet(ring.functions(count), FEET)
        _check_anchors(page)
        housed = RING.in_rigid_housing(count)
    with run.step("rollers"):
        pressed = {
            "rigid ring": press(np.zeros((ROLLERS, ROLLERS))),
            "ring in a rigid housing": press(housed),
            **{
                f"on two feet, outer radius {name} m": press(compliance)
                for name, compliance in compliances.items()
            },
        }
        _check_rigid_rings(page, compliances[f"{OUTSIDE:g}"], pressed)
    _answer(page, free, pressed, count)
    _show_rollers(page, pressed)
    _show_influence(page, free, count, levels)
    for name, value, unit, source in (
        ("radius of the raceway", RACEWAY, "m", "size of a 2 MW main bearing, chosen"),
        ("outer radius of the ring", OUTSIDE, "m", "chosen"),
        ("width of the ring", WIDTH, "m", "chosen"),
        ("length of a roller", ROLLER, "m", "chosen"),
        ("number of rollers", ROLLERS, "-", "chosen"),
        ("feet from the load's direction", FEET, "rad", "chosen"),
        ("stiffness of a roller with its contacts", STIFFNESS, "N/m", "order of magnitude"),
        ("load", LOAD, "N", "chosen; forces are in proportion"),
    ):
        page.assume(name, value, unit, source)
    page.data("angles", ANGLES)
    page.data("forces", {name: one.forces for name, one in pressed.items()})
    page.data("factors", {name: one.factor for name, one in pressed.items()})
    page.data("tail", free.tail / free.own)


HERO = f"Force of each roller over load / {ROLLERS}; the load acts at 0"


def _answer(page: Page, free: FreeRing, pressed: dict[str, Pressed], count: int) -> None:
    """Loads of rollers on a ring that deforms, and errors of its influence functions."""
    flat = free.flat
    feet = [one for name, one in pressed.items() if "feet" in name]
    rigid = pressed["rigid ring"].factor
    page.answer(
        "How does a flexible raceway share a load among its rollers?",
        f"In a ring held on two feet the most loaded roller carries {feet[0].factor:.2f} times the "
        f"mean roller force; in a rigid ring, {rigid:.2f} times.",
        [
            page.value(
                "most loaded roller over the mean, ring on two feet",
                feet[0].factor,
                beside=rigid,
                by="rigid ring",
            ),
            page.value(
                f"the same with {HOUSINGS[-1] - OUTSIDE:.2f} m of housing around the ring",
                feet[-1].factor,
                beside=rigid,
                by="rigid ring",
            ),
            page.value(
                "load of the most loaded roller, ring on two feet [kN]", feet[0].forces.max() / 1e3
            ),
            page.judged(
                "rigid ring, exponent 1.11: most loaded roller times their number over load",
                "most loaded roller over the mean, rigid ring, line contact",
                "Stribeck",
            ),
            page.judged(
                "free ring: radial displacement under two opposite pushes",
                "compliance under two opposite pushes",
                "solid",
            ),
        ],
        hero=HERO,
        cautions=[
            "Feet are narrow and hold the ring along the radius alone: a real housing is stiffer.",
            "The shaft is rigid, and there is no clearance; dimensions are chosen.",
        ],
    )
    page.say(
        "The ring deforms between its feet, and the rollers above these take over.",
        f"The influence functions agree with a solid within its band "
        f"({100 * abs(flat[0] / free.solids[-1][0] - 1):.2g} % under two opposite pushes, "
        f"{100 * abs(flat[1] / free.solids[-1][1] - 1):.2g} % across them); {count} harmonics "
        f"leave {100 * free.tail / free.own:.2g} % of a patch's own compliance.",
    )


def _check_plane_strain(page: Page, count: int, orders: tuple[int, int]) -> None:
    whole = [Strip(r, 0.0, WIDTH) for r in (RACEWAY, OUTSIDE)]
    plane = plane_strain(STEEL.youngs_modulus, STEEL.poisson_ratio)
    pressure = 1.0 / (np.pi * RACEWAY * WIDTH)
    n = np.arange(2, count + 1)
    series = harmonics(n, RACEWAY, OUTSIDE, np.full(len(n), pressure), np.zeros(len(n)))
    exact = series.displacement_amplitudes(RACEWAY, plane)[0]
    lame = Lame(RACEWAY, OUTSIDE, inside=pressure / 2).displacement(np.array(RACEWAY), plane)
    planes = []
    for order in orders:
        mesh = ring_meridian(RACEWAY, OUTSIDE, WIDTH, 0.02, order)
        still = dofs(np.arange(len(mesh.nodes)), 0)
        found = influence_functions(mesh, STEEL, whole, count, HALF, held=still, anchor=whole[1])
        planes.append(found.harmonic_compliances[:, 0, 0])
    for k in (0, 2, 8, count):
        reference = float(lame) if k == 0 else float(exact[k - 2])
        band = abs(planes[-1][k] - planes[0][k])
        page.equals(
            f"harmonic {k}: compliance of the raceway in plane strain [m/N]",
            planes[-1][k],
            reference,
            within=max(1e-9, band / reference),
            why="what the higher order of elements of two changed, or round-off",
            source="Lame 1852" if k == 0 else "Michell 1899: four powers of the radius",
            basis="self-consistency",
            band=band,
        )


def _check_thin_ring(page: Page) -> None:
    """Pushed apart at two opposite places, and narrow: plane stress."""
    wall = RACEWAY / THIN
    inner, outer, width = RACEWAY - wall / 2, RACEWAY + wall / 2, wall
    mesh = ring_meridian(inner, outer, width, width)
    outside = Strip(outer, 0.0, width)
    # so narrow that the oval does not see its width: a patch takes (2 a)^2 / 3 off it
    narrow = wall / (10 * RACEWAY)
    thin, fewer = (
        influence_functions(mesh, STEEL, [outside], k, narrow, anchor=outside) for k in (40, 20)
    )
    across, short = (f.matrix([0.0, np.pi / 2, np.pi])[1, [0, 2]].sum() for f in (thin, fewer))
    E, G = STEEL.youngs_modulus, STEEL.shear_modulus
    area, inertia = wall * width, width * wall**3 / 12
    # energy of a curved beam in bending, tension and shear, its middle line's ends turned back
    slim = inertia / (area * RACEWAY**2)
    sheared = 1.2 * E * inertia / (G * area * RACEWAY**2)
    one, two = 1.0 - slim + sheared, 1.0 - slim
    page.equals(
        f"thin ring, radius over wall {THIN:g}: radius across two opposite pushes [m/N]",
        across,
        -(RACEWAY**3) / (E * inertia) * (2 * two**2 / np.pi - two + one / 2) / 2,
        within=1.0 / THIN**2,
        why="what beam theory leaves out is of the order of (wall over radius)^2",
        source="curved beam with tension and shear (Roark's formulas, thin rings, case 1)",
        band=abs(across - short),
    )


def _check_free_ring(page: Page, free: FreeRing, levels: tuple[int, ...]) -> None:
    for k, place in enumerate(("under", "across")):
        values = [s[k] for s in free.solids]
        band = (
            abs(values[-1] - values[-2])
            if len(levels) == 2
            else band_of(1.0 / np.array(levels), values)
        )
        # of the sum: its orders, and the meridian's mesh
        left = (free.tail if k == 0 else 0.0) + abs(free.flat[k] - free.rough[k])
        page.equals(
            f"free ring: radial displacement {place} two opposite pushes [m/N]",
            free.flat[k],
            values[-1],
            within=(band + left) / abs(values[-1]),
            why="the solid's band, the tail of the sum, and what one order changed of the meridian",
            source=f"solid of hexahedra of 27 nodes, {len(levels)} meshes",
            band=left,
        )


def _check_sums(page: Page, found: InfluenceFunctions, count: int) -> None:
    matrix = found.matrix(ANGLES)
    page.vanishes(
        "influence of one patch on another less the other way round, relative",
        np.abs(matrix - matrix.T).max() / np.abs(matrix).max(),
        within=1e-10,
        why="round-off of a sum of some hundred terms",
        source="reciprocity (Betti 1872)",
    )
    equal = matrix.reshape(ROLLERS, 2, ROLLERS, 2).sum(axis=2)[0]
    few = np.arange(0, count + 1, ROLLERS)
    alone = ROLLERS * np.tensordot(found.shares[few] ** 2, found.harmonic_compliances[few], 1)
    page.vanishes(
        f"equal pushes of {ROLLERS} rollers less harmonics 0, {ROLLERS}, {2 * ROLLERS} ..., "
        "relative",
        np.abs(equal - alone).max() / np.abs(alone).max(),
        within=1e-10,
        why="round-off of a sum of some hundred terms",
        source="sum of a cosine over equal angles",
    )


def _check_anchors(page: Page) -> None:
    one, other = (RING.on_feet(RING.functions(8, anchor), FEET) for anchor in (1, 0))
    page.vanishes(
        "ring on two feet: compliance by one anchor less that by another, relative",
        np.abs(one - other).max() / np.abs(one).max(),
        within=1e-8,
        why="round-off, times some hundred: the ring is that much softer than its contact",
        source="forces in balance leave nothing to the anchor",
    )


def press(compliance: Floats, stiffness: float = STIFFNESS, exponent: float = 1.0) -> Pressed:
    """Forces that carry the load, the shaft rigid, no clearance."""
    return RING.press(compliance, LOAD, stiffness, exponent)


def _check_rigid_rings(page: Page, compliance: Floats, pressed: dict[str, Pressed]) -> None:
    x, w = np.polynomial.legendre.leggauss(200)
    for e in EXPONENTS:
        # stiffness in N/m^exponent: the same force at a tenth of a millimetre
        found = press(np.zeros((ROLLERS, ROLLERS)), STIFFNESS * 1e-4 ** (1 - e), e)
        page.equals(
            f"rigid ring, exponent {e:.3g}: most loaded roller times their number over load",
            found.factor,
            1.0 / float(w @ np.cos(x * np.pi / 2) ** (e + 1) / 4),
            within=1e-9 if e == 1.0 else (PITCH / 2) ** (e + 2),
            why="the sum over rollers of cos^2 is exact"
            if e == 1.0
            else "sum for an integral whose end goes as the angle to the power exponent + 1",
            source="integral over the loaded half (Stribeck, Sjoevall: 4.37 of a point "
            "contact, 4.08 of a line contact)",
            measure="reaction",
        )
    nearly = press(1e-9 * compliance).forces
    page.vanishes(
        "ring of nearly no compliance: forces less those of the rigid ring, over the largest",
        np.abs(nearly - pressed["rigid ring"].forces).max() / nearly.max(),
        within=1e-6,
        why="a billionth of the ring's compliance, which is some hundred times a roller's",
        source="the rigid limit",
    )
    page.vanishes(
        "rollers' forces less the load, relative, the worst",
        max(
            float(abs(one.forces @ np.sin(ANGLES)) / LOAD)
            + float(abs(one.forces @ np.cos(ANGLES) / LOAD - 1))
            for one in pressed.values()
        ),
        within=1e-9,
        why="the shaft's displacement is found to 1e-16 m of some 1e-4 m",
        source="balance",
    )


def _show_rollers(page: Page, pressed: dict[str, Pressed]) -> None:
    shown = np.degrees(np.where(np.pi < ANGLES, ANGLES - 2 * np.pi, ANGLES))
    by_angle = np.argsort(shown)
    page.section("Rollers round the ring")
    page.chart(
        HERO,
        [
            trace(name, shown[by_angle], (one.forces * ROLLERS / LOAD)[by_angle])
            for name, one in pressed.items()
        ],
        "angle from the load [deg]",
        "force / (load / number of rollers) [-]",
    )
    page.table(
        "Most loaded roller",
        [
            {
                "ring": name,
                "its force [kN]": one.forces.max() / 1e3,
                "times number of rollers over load": one.factor,
                "rollers that press": int((one.forces > 0).sum()),
                "shaft moves by [µm]": 1e6 * one.down,
            }
            for name, one in pressed.items()
        ],
    )
    page.text(
        "The shaft is rigid and there is no clearance; each roller with its contacts is a spring. "
        "A patch is as wide as half of the distance between rollers, so that their contact's own "
        "approach, which the spring stands for, isn't counted twice. Forces on the raceway are "
        "radial, and all along a roller the same. Feet are as narrow as a patch, and don't give "
        "along the radius; friction there and all else that would hold the ring are left out, so "
        "that a real housing is stiffer."
    )


def _show_influence(page: Page, free: FreeRing, count: int, levels: tuple[int, ...]) -> None:
    found = free.found
    orders = np.arange(1, count + 1)
    sums = np.cumsum(found.shares**2 * found.harmonic_compliances[:, 0, 0])[1:]
    # the tail that fewer harmonics would have
    estimates = [
        float(replace(found, harmonic_compliances=found.harmonic_compliances[: k + 1]).tail[0])
        for k in orders[1:-1]
    ]
    page.section("Influence functions")
    page.chart(
        "Compliance of the raceway by harmonic: relative to the outside, free ring",
        [
            trace("free ring", orders[1:], found.harmonic_compliances[2:, 0, 0]),
            trace("half space in plane strain", orders, found.limits[0] / orders),
        ],
        "harmonic n",
        "compliance [m/N]",
        "xy",
    )
    page.chart(
        "What orders above n add to a patch's own compliance, relative",
        [
            trace("sum", orders[1:-1], (sums[-1] - sums[1:-1] + free.tail) / free.own),
            trace("estimate, last order over n", orders[1:-1], np.array(estimates) / free.own),
        ],
        "highest harmonic n",
        "left out [-]",
        "xy",
    )
    rows: list[list[Cell]] = [
        [place, *(values[k] for values in free.solids), free.flat[k]]
        for k, place in enumerate(("under a push", "across"))
    ]
    page.table(
        "Free ring under two opposite pushes of 1 N [m]",
        rows,
        ["", *(f"solid, cut {level}" for level in levels), "meridian"],
    )
