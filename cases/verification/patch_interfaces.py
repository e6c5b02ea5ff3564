"""Patch test of the interfaces: each transmits a constant stress, or the page states why not."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification import patched_interfaces as patched
from fe_drivetrain.report import bars
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Run, Target, column

WITHIN = 1e-12  # of an error that is round-off
DIVISIONS = "elements along a side of the sector"
ERROR = "error of the stress"
ROUND_OFF = "the discrete equations hold exactly for a constant stress, so only round-off is left: "
ROUND_OFF += "about a thousand operations at 1e-16 each, and the elements' condition"
LARGEST = (
    "Largest error of the stress, of unit stress; interfaces that pass, and ties node by node "
)
LARGEST += "beside them"
PATCH = "constant stress (Irons and Razzaque 1972, patch test)"


@case(
    "Patch test: constant stress through every interface, conforming or not",
    source="Irons and Razzaque 1972 (patch test); Puso 2004, Int. J. Numer. Meth. Engng 59, 315",
)
def run(run: Run, page: Page) -> None:
    """Every interface under constant stress."""
    meshes = patched.QUICK_MESHES if run.quick else patched.MESHES
    ties, by_nodes = run.timed("ties", patched.tied_blocks, meshes)
    with run.step("reference points"):
        points = {**patched.sprung_block(), **patched.averaged_block(), **patched.rigid_block()}
    with run.step("spheres"):
        kinematics = patched.sphere_kinematics()
        divisions = (2, 4) if run.quick else (2, 4, 8)
        spheres = [{DIVISIONS: n, ERROR: patched.sphere_error(n)} for n in divisions]
    for name, error in {**ties, **points, **kinematics}.items():
        page.meets(error, Target(name, 0.0, WITHIN, ROUND_OFF, PATCH))
    order = check_order(page, *column(spheres, ERROR)[-2:])
    exact = {**ties, **points}
    answer(page, ties, exact, by_nodes)
    page.say(
        "Bonds and ties pass it at any mesh ratio, whichever side is the slave. Pressure through "
        f"the sliding sphere converges with order {order:.1f}."
    )
    show_errors(page, exact, by_nodes)
    page.section("Pressure through a sliding sphere")
    title = "Root mean square of the stress error, of the pressure: sliding sphere, tet10"
    page.sweep(title, spheres, DIVISIONS, ERROR, log="xy")
    page.text(
        "An isotropic strain fulfils the joint exactly, sliding and averaged. The forces do not "
        "balance exactly: the sliding joint pushes each node along the sphere's radius, the "
        "pressure on a facet is integrated with the facet's own normals. The averaged joint "
        "carries the sphere's resultant only: it passes no pressure, and adds nothing to what "
        "presses on both faces."
    )
    sketch = run.sketch(patched.two_blocks((27, 10, 2, 3)))
    page.image("Two of the oblique blocks, hexahedra on tetrahedra", sketch)
    page.data("stress errors", exact | by_nodes)


def answer(
    page: Page, ties: dict[str, float], exact: dict[str, float], by_nodes: dict[str, float]
) -> None:
    """State how exactly constant stress passes, and what ties node by node make of it."""
    largest, loose = max(exact.values()), max(by_nodes.values())
    page.answer(
        "Does a constant stress pass every interface unchanged, whether its meshes match or not?",
        "Bonds, ties, springs and rigid faces pass a constant stress within "
        f"{formatted(largest, 2, '')} of it; meshes tied node by node err by "
        f"{formatted(loose, 2)} times the stress.",
        [
            page.value(
                f"largest error through {len(ties)} bonds and mortar ties, of unit stress",
                max(ties.values()),
                at_most=WITHIN,
                by="round-off",
            ),
            page.value(
                "largest error through springs, averaged points and rigid faces",
                max(error for name, error in exact.items() if name not in ties),
                at_most=WITHIN,
                by="round-off",
            ),
            page.value("largest error if tied node by node, of unit stress", loose),
            page.judged(
                "sliding sphere under pressure: order of the stress error",
                "order of the error of pressure through the sliding sphere",
                "interpolation",
            ),
        ],
        hero=LARGEST,
        cautions=["A mesh tied node by node passes only where it divides the other one."],
    )


def check_order(page: Page, before: float, last: float) -> float:
    """Order of the stress error of the sliding sphere, on its two finest meshes."""
    order = float(np.log2(before / last))
    page.at_least(
        "sliding sphere under pressure: order of the stress error",
        order,
        1.9,
        why="the joint acts along exact normals, the pressure along those of the facets, which are "
        "of second order. On meshes of 4 and 8 elements the next term of the error, of relative "
        "size h^2, moves the order by log2((1 + 1/16) / (1 + 1/64)) = 0.07",
        source="interpolation: normals of quadratic facets are of second order",
        measure="order",
    )
    return order


def show_errors(page: Page, exact: dict[str, float], by_nodes: dict[str, float]) -> None:
    """Interfaces that pass by design, and ties node by node beside them."""
    page.section("Interfaces under constant stress")
    groups = {"passes by design": exact, "tied node by node": by_nodes}
    page.add(bars(LARGEST, groups, "error of the stress", least=1e-17))
    page.table(
        "Meshes that do not match, tied node by node: not judged, the error is the point",
        list(by_nodes.items()),
        ["tie", "largest error of the stress, of unit stress"],
    )
    page.text(
        "Two oblique blocks, or one, loaded on all outer faces by the tractions of each of the six "
        "states of unit stress, and held at three nodes. Elements are skewed; those of the slave "
        "are graded, so that meshes do not nest. A number after an element is the divisions of the "
        "face's sides. Node by node passes only where the slave's mesh divides the master's. A "
        "rigid face can pass only what leaves it plane and undeformed: tension along its normal "
        "without lateral contraction, here with Poisson's ratio zero."
    )
