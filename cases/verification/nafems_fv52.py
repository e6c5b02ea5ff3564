"""Modes of a simply supported solid plate: NAFEMS benchmark FV52, and its singular support."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.loaded_blocks import edge_nodes, supports
from fe_drivetrain.cases.verification.vibrating_plates import bending_wave, block_modes, thick_plate
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import as_printed
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.elasticity.mesh import Block, brick
from fe_drivetrain.report.number_text import certain_value
from fe_drivetrain.report.suite import MeshSeries, Page, Record, Run, Target, column

STEEL = Material(youngs_modulus=200e9, poisson_ratio=0.3, density=8000.0)
SIDE, THICKNESS, BELOW = 10.0, 1.0, 20.0  # m, and Hz: below all modes but the free motions
NAFEMS = "NAFEMS, selected benchmarks for natural frequency analysis, FV52, as quoted"
#: Modes 4 to 10 [Hz]: the benchmark's reference, and its own 4 x 4 x 1 elements of 20 nodes.
REFERENCE = 45.897, 109.44, 109.44, 167.89, 193.59, 206.19, 206.19
PRINTED = "44.762", "110.52", "110.52", "169.08", "193.93", "206.64", "206.64"
#: Bending modes by half waves along both sides, whether each is symmetric about the middles.
WAVES = {
    "bending (1, 1) [Hz]": (1, 1),
    "bending (2, 1) [Hz]": (2, 1),
    "bending (2, 2) [Hz]": (2, 2),
}
IN_PLANE = {"in plane, mode 8 [Hz]": ((2, 2), 193.59), "in plane, mode 9 [Hz]": ((1, 2), 206.19)}
MESH, EDGE, FIRST = "elements along half a side", "element at the edge [mm]", "mode 4 [Hz]"
FALLING = "Mode 4 on lines keeps falling as the elements at the edge are halved"
FALL = "mode 4 on lines: fall with the last halving, over that with the one before"
LINES, SIDES = "lines under the edges", "whole sides, across and along themselves"
EXACT = "Rayleigh-Lamb wave of sin(pi m x / a) sin(pi n y / b): Graff 1975, section 8.1"


def whole() -> tuple[Block, Floats]:
    """The benchmark's own mesh, and its ten lowest frequencies [Hz]."""
    plate = brick((4, 4, 1), 20, lambda p: p * [SIDE, SIDE, THICKNESS])
    lines = [(edge_nodes(plate, "z0", side, 1), "z") for side in ("x0", "x1", "y0", "y1")]
    return plate, block_modes(plate, STEEL, supports(plate, *lines), 10, BELOW)[0]


def quarter(x: Floats, z: Floats) -> Block:
    """A quarter of the plate, with elements between places of the half side and thickness."""
    size = np.array([SIDE / 2.0, SIDE / 2.0, THICKNESS])
    return brick((len(x) - 1, len(x) - 1, len(z) - 1), 20, lambda p: p * size, (x, x, z))


def modes(plate: Block, support: str, waves: tuple[int, int], count: int) -> tuple[Floats, Floats]:
    """Modes of a quarter that are symmetric about the middle for odd numbers of half waves."""
    one, two = (
        sym if n % 2 else anti for n, sym, anti in zip(waves, ("x", "y"), ("yz", "xz"), strict=True)
    )
    if support == SIDES:
        held = supports(plate, x0="yz", y0="xz", x1=one, y1=two)
    else:
        lines = [(edge_nodes(plate, "z0", side, 1), "z") for side in ("x0", "y0")]
        held = supports(plate, *lines, x1=one, y1=two)
    return block_modes(plate, STEEL, held, count, BELOW)


def uniform(n: int) -> Record:
    """Bending of a plate whose sides are held, and modes in the plane of one on lines."""
    plate = quarter(np.linspace(0, 1, n + 1), np.linspace(0, 1, n // 2 + 1))
    row: Record = {MESH: n}
    for key, waves in WAVES.items():
        row[key] = float(modes(plate, SIDES, waves, 1)[0][0])
    for key, (waves, _) in IN_PLANE.items():
        frequencies, shapes = modes(plate, LINES, waves, 3)
        # in bending most of the motion is across
        across = (shapes[:, :, 2] ** 2).sum(axis=1) / (shapes**2).sum(axis=(1, 2))
        row[key] = float(frequencies[(across < 0.1) & (frequencies > BELOW)][0])
    return row


def on_lines(halvings: int) -> Record:
    """Mode 4 on lines, with the element at the edge halved in all directions."""
    halved = 2.0 ** np.arange(-halvings, 1)
    x = np.concatenate([[0.0], 0.25 * halved, [0.5, 0.75, 1.0]])
    plate = quarter(x, np.concatenate([[0.0], 0.5 * halved, [1.0]]))
    first = float(modes(plate, LINES, (1, 1), 1)[0][0])
    return {EDGE: 1e3 * SIDE / 8.0 / 2.0**halvings, FIRST: first}


def own_mesh(run: Run, page: Page) -> float:
    """The benchmark's elements beside its own numbers; the largest difference, relative."""
    with run.step("the benchmark's mesh"):
        plate, found = whole()
    element = "which points the benchmark's element was integrated at is not stated, and they "
    element += "change its digits (2 x 2 x 2 in place of 3 x 3 x 3 take 2 % from mode 4)"
    for number in (4, 5, 7, 8):
        printed, value = PRINTED[number - 4], float(found[number - 1])
        name = f"4 x 4 x 1 elements of 20 nodes: mode {number} [Hz]"
        page.meets(value, Target(name, float(printed), 1e-3, element, NAFEMS, basis="second-hand"))
    for number in (9, 10):
        name = f"4 x 4 x 1 elements of 20 nodes: mode {number} [Hz]"
        printed = PRINTED[number - 4]
        value = float(found[number - 1])
        page.equals(name, value, **as_printed(printed), source=NAFEMS, basis="second-hand")
    page.section("The benchmark's own mesh")
    rows = [
        [n, value, float(printed), 100.0 * (value / float(printed) - 1.0), reference]
        for n, value, printed, reference in zip(
            range(4, 11), found[3:], PRINTED, REFERENCE, strict=True
        )
    ]
    heads = ["mode", "found [Hz]", "NAFEMS, 20 nodes [Hz]", "apart [%]", "NAFEMS, reference [Hz]"]
    page.table("4 x 4 x 1 elements of 20 nodes, u_z = 0 on the four lower edges", rows, heads)
    page.image("The plate in the benchmark's own mesh", run.sketch(plate))
    apart = found[3:] / np.array(PRINTED, float) - 1.0
    return float(np.abs(apart).max())


def settled(page: Page, series: MeshSeries) -> None:
    """What converges: the plate on its sides against exact waves, and modes in its plane."""
    fourth = "eigenvalues converge with the fourth power of the element's size; with three "
    fourth += "elements or more a half wave less than 1e-3 is left"
    swells = "plate theory leaves out the inertia of swelling, which is of the order of "
    swells += "nu^2 (k t)^2 / 12 = 5e-4 with k = 0.26 per m; twice that"
    tells = "neither theory nor shear factor are stated; 1e-4 tells pi^2 / 12 from 5/6, which is "
    tells += "3e-4 apart, and from a solid"
    k = {key: np.pi / SIDE * float(np.hypot(*waves)) for key, waves in WAVES.items()}
    exact = {key: bending_wave(STEEL, THICKNESS, k[key]) for key in WAVES}
    thick = {key: thick_plate(STEEL, THICKNESS, k[key]) for key in WAVES}
    printed = dict(zip(WAVES, (REFERENCE[0], REFERENCE[1], REFERENCE[3]), strict=True))
    page.section("What converges")
    targets = [Target(key, value, 1e-3, fourth, EXACT) for key, value in exact.items()]
    page.targets("Whole sides held across and along themselves", series, targets, "exact", "sides")
    in_plane = [
        Target(key, value, 1e-3, swells, NAFEMS, basis="second-hand")
        for key, (_, value) in IN_PLANE.items()
    ]
    page.targets("In the plane of the plate on lines", series, in_plane, "NAFEMS", "lines")
    for key, value in thick.items():
        target = Target(key, printed[key], 1e-4, tells, NAFEMS, basis="second-hand")
        page.meets(value, target, of="thick plate on its sides")
    columns = ["mode", "solid, finest mesh", "exact", "thick plate, factor pi^2 / 12", "NAFEMS"]
    rows = [[key, series.last[key], exact[key], thick[key], printed[key]] for key in WAVES]
    page.table(
        "The benchmark's reference is that of a thick plate held on its sides", rows, columns
    )


def falling(page: Page, rows: list[Record]) -> None:
    """What does not converge: mode 4 on lines."""
    falls = -np.diff(column(rows, FIRST))
    page.at_least(
        FALL,
        float(falls[-1] / falls[-2]),
        0.75,
        why="with each halving a series that converges falls by half as much as before or less, "
        "and one that goes on with the logarithm of the size by nearly the same",
        source="a line load on a solid: its displacement has a logarithm (Flamant 1892)",
        measure="order",
    )
    page.section("What does not")
    page.sweep(
        FALLING,
        rows,
        EDGE,
        FIRST,
        log="x",
        reference={"NAFEMS, reference": REFERENCE[0], "NAFEMS, 20 nodes": float(PRINTED[0])},
    )
    least = rows[-1]
    page.limit(
        "solid supported along a line or at a point",
        "element at the support [mm]",
        criterion="frequencies, displacements and stresses that converge with the mesh",
        beyond=f"none is safe: mode 4 falls with each halving, to {least[FIRST]:.2f} Hz at "
        f"{least[EDGE]:.3g} mm",
        program="takes the support as it is given, for every displacement is that of the mesh",
        remedy="support a face: on its whole sides the plate meets the exact solid to "
        "1e-3, whatever the mesh",
    )


def answer(page: Page, apart: float, finest: Record) -> None:
    """State what of the benchmark has a limit.

    Parameters
    ----------
    page : Page
        With its checks.
    apart : float
        Largest difference of the benchmark's own mesh from its own frequencies [%].
    finest : dict
        Mode 4 on lines with the smallest elements at the edge.
    """
    sides = page.judged("sides: bending (1, 1)", "mode 4 on whole sides", "exact wave")
    fall = page.judged(FALL, "last fall of mode 4 over the fall before")
    has_limit = fall.status == "bad"
    verdict = "Supported on lines, mode 4 does not reach the reference of 45.897\u00a0Hz: it is "
    verdict += f"{finest[FIRST]:.2f}\u00a0Hz and still falls; on whole sides it is "
    verdict += f"{certain_value(sides)}."
    if has_limit:
        verdict = f"Supported on lines, mode 4 converges to {finest[FIRST]:.2f}\u00a0Hz; the "
        verdict += "reference is 45.897\u00a0Hz."
    page.answer(
        "Which frequencies does the simply supported solid plate have, and do they converge?",
        verdict,
        [
            page.value(
                f"mode 4 on lines, elements of {finest[EDGE]:.3g} mm [Hz]",
                finest[FIRST],
                beside=REFERENCE[0],
                by="NAFEMS",
                printed="45.897",
            ),
            fall,
            sides,
            page.judged("lines: in plane, mode 8", "mode 8, in plane", "NAFEMS", "193.59"),
            page.judged("lines: in plane, mode 9", "mode 9, in plane", "NAFEMS", "206.19"),
            page.value("largest difference on the benchmark's own mesh [%]", apart),
        ],
        hero=FALLING,
        cautions=["The benchmark is known from quotations: its own text was not read."],
        claim="" if has_limit else "holds in part",
    )


@case(
    "Simply supported solid plate, natural frequencies (NAFEMS FV52)",
    source="NAFEMS, Selected benchmarks for natural frequency analysis, 1987, test FV52",
)
def run(run: Run, page: Page) -> None:
    """The benchmark's mesh; supports that converge, and the lines that do not."""
    apart = own_mesh(run, page)
    counts, halvings = ((4, 6), 4) if run.quick else ((4, 6, 8), 6)
    series = MeshSeries([run.timed("sides and plane", uniform, n) for n in (2, *counts)], MESH)
    settled(page, series)
    rows = [run.timed("lines", on_lines, k) for k in range(halvings)]
    falling(page, rows)
    answer(page, 100.0 * apart, rows[-1])
    page.text(
        "Three free motions in the plane come first, so that modes count from 4. Modes 8 to 10 are "
        "in the plane, where lines that hold only u_z disturb little: these converge."
    )
