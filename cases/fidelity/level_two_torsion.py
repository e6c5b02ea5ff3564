"""Level 2 in torsion of a stepped shaft, to 1e-8: between two bounds that leave no more."""

from itertools import pairwise

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.torsion_meridian import torsion_bounds
from fe_drivetrain.drivetrain_file import MATERIALS
from fe_drivetrain.elasticity.revolution import meridian, stiffness_between_ends
from fe_drivetrain.geometry import Section, Shaft
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import Page, Record, Run, column, grouped

LARGE, SMALL, LENGTH = 0.6, 0.4, 0.6
BORES = {"bored": 0.2, "solid": 0.0}

#: Order and layers of elements at the corners, from coarse to fine.
SETTINGS = ((4, 3), (5, 4), (6, 5), (8, 6), (10, 8))
QUICK_SETTINGS = SETTINGS[:4]

#: Element size of the bounds [m], and halvings at the corners: below, size is what is left.
SIZES = (0.05, 0.025, 0.0125)
HALVINGS = 24
CLAIM = 1e-8

STEEL = MATERIALS["steel"]
ORDER, WIDTH = "order", "width, relative"
STIFFNESS, ERROR = "stiffness [N m/rad]", "from the bounds' middle, relative"


def stepped(bore: float) -> Shaft:
    """The shaft with one step."""
    return Shaft(
        front=0.0,
        sections=tuple(
            Section(length=LENGTH, outer_diameter=outer, inner_diameter=bore)
            for outer in (LARGE, SMALL)
        ),
    )


def bounded(run: Run, name: str) -> tuple[float, list[Record]]:
    """Middle of the closest bounds [N m/rad], and records of all."""
    shaft, rows = stepped(BORES[name]), list[Record]()
    with run.step(f"{name}: bounds"):
        for size in SIZES[:1] if run.quick else SIZES:
            bounds = torsion_bounds(shaft, STEEL.shear_modulus, size, HALVINGS)
            rows.append(
                {
                    "shaft": name,
                    "element size [mm]": 1e3 * size,
                    "lower [N m/rad]": bounds.lower,
                    "upper [N m/rad]": bounds.upper,
                    WIDTH: 2 * bounds.half_width / bounds.middle,
                }
            )
    return bounds.middle, rows


def between(run: Run, name: str, middle: float) -> list[Record]:
    """The meridian's stiffness between rigid ends, from coarse to fine."""
    shaft, rows = stepped(BORES[name]), list[Record]()
    for order, layers in QUICK_SETTINGS if run.quick else SETTINGS:
        with run.step(f"{name}: meridian"):
            mesh = meridian(shaft, order=order, layers=layers)
            found = float(stiffness_between_ends(mesh, STEEL)[3, 3])
        rows.append(
            {
                "shaft": name,
                ORDER: order,
                "layers at corners": layers,
                "nodes": len(mesh.nodes),
                STIFFNESS: found,
                ERROR: found / middle - 1,
            }
        )
    return rows


def judge(run: Run, page: Page, name: str, middle: float, width: float, of: list[Record]) -> None:
    """The meridian between its bounds, their width, and what finer elements change."""
    series = column(of, STIFFNESS)
    page.equals(
        f"{name}: torsional stiffness, order {of[-1][ORDER]} [N m/rad]",
        series[-1],
        middle,
        within=width / 2,
        why="half the distance of the bounds",
        source="between two bounds, by displacements and by the torsion function (Michell "
        "1899), in triangles of scikit-fem",
        band=abs(series[-1] - series[-2]),
    )
    page.at_most(
        f"{name}: width of the bounds, relative",
        width,
        1e-6 if run.quick else CLAIM,
        why="coarse bounds of a quick run"
        if run.quick
        else "a comparison to 1e-8 needs bounds that are no farther apart",
        source="exact stiffness lies between them",
        measure="identity",
    )
    page.at_most(
        f"{name}: largest growth of stiffness as elements gain degrees of freedom, relative",
        max(b / a - 1 for a, b in pairwise(series)),
        1e-10,
        why="round-off; the meshes are nested but for the middle of the corners",
        source="displacements of the coarser mesh make no less energy",
        measure="identity",
    )


HERO = "Difference of the meridian's stiffness from the bounds' middle"


def answer(page: Page, finest: dict[str, Record], width: float) -> None:
    """State how far the meridian is from two bounds, which are so far apart, relative."""
    error = max(abs(row[ERROR]) for row in finest.values())
    stiffness = [
        page.judged(
            f"{name}: torsional stiffness, order {row[ORDER]}",
            f"torsional stiffness, {name} shaft",
            "two bounds",
            unit="MN m/rad",
        )
        for name, row in finest.items()
    ]
    inside = all(figure.status == "good" for figure in stiffness)
    page.answer(
        "How accurate is an axisymmetric model's torsional stiffness of a stepped shaft?",
        "The axisymmetric model's torsional stiffness lies "
        f"{'between' if inside else 'not between'} a lower and an upper bound that are only "
        f"{value_text(100 * width, '%')} apart.",
        [
            page.value("largest difference from the middle of the bounds [%]", 100 * error),
            page.value("distance between the bounds [%]", 100 * width),
            *stiffness,
            page.value(
                "unknowns of the axisymmetric model", max(row["nodes"] for row in finest.values())
            ),
        ],
        hero=HERO,
        cautions=["Ends are rigid; the shaft and its step are chosen, not those of a turbine."],
    )


def show(page: Page, rows: list[Record], widths: list[Record]) -> None:
    """Distance of the meridian from the bounds' middle, and the bounds."""
    page.section("Torsion")
    page.chart(
        HERO,
        [
            trace(name, column(of, "nodes"), [abs(error) for error in column(of, ERROR)])
            for name, of in grouped(rows, "shaft")
        ],
        "nodes, one unknown each",
        "relative difference [-]",
        "xy",
    )
    page.table("Meridian between rigid ends", rows)
    page.table("Bounds", widths)
    page.text(
        f"Bounds: triangles of fourth order, halved {HALVINGS} times at the corners, so that the "
        "size elsewhere is what is left. The upper one is the energy of an angle of twist, the "
        "lower one that of a torsion function; both are least, and nothing is shared with the "
        "meridian's program but the outline. Of the solid shaft the lower bound takes the torsion "
        "function on the step's face by interpolation, and is a bound but for that."
    )


@case(
    "Level 2 in torsion of a stepped shaft, to 1e-8",
    source="Two bounds of the stiffness from scalar problems in the meridian (Michell 1899)",
)
def run(run: Run, page: Page) -> None:
    """The bounds closed in on, and the meridian's 12 x 12 between them."""
    rows: list[Record] = []
    widths: list[Record] = []
    for name in BORES:
        middle, bounds = bounded(run, name)
        own = between(run, name, middle)
        judge(run, page, name, middle, bounds[-1][WIDTH], own)
        rows += own
        widths += bounds
    finest = {name: of[-1] for name, of in grouped(rows, "shaft")}
    answer(page, finest, max(of[-1][WIDTH] for _, of in grouped(widths, "shaft")))
    show(page, rows, widths)
    page.data("errors", {name: abs(row[ERROR]) for name, row in finest.items()})
    page.assume("large diameter", LARGE, "m", "chosen")
    page.assume("small diameter", SMALL, "m", "chosen")
    page.assume("bore of the bored shaft", BORES["bored"], "m", "chosen")
    page.assume("length of each part", LENGTH, "m", "chosen")
    page.assume("E", STEEL.youngs_modulus / 1e9, "GPa", "steel, assumed")
    page.assume("nu", STEEL.poisson_ratio, "-", "steel, assumed")
    page.assume("G = E / (2 (1 + nu))", STEEL.shear_modulus / 1e9, "GPa", "of these")
