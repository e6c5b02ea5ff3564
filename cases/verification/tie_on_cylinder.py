"""Two concentric rings, meshed separately and tied on the cylinder between them."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import tied_rings, two_bodies
from fe_drivetrain.cases.references.tied_rings import BORE, LAME, OUTSIDE, TIED
from fe_drivetrain.cases.references.two_bodies import Bodies
from fe_drivetrain.common import Floats, rigid_motions
from fe_drivetrain.comparison import grid_convergence
from fe_drivetrain.elasticity.interfaces import Constraint, dofs, held_dofs, mortar_tie, settled
from fe_drivetrain.elasticity.mesh import Block
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import percent_text
from fe_drivetrain.report.suite import Page, Record, Run, column

WIDTH = 1.0  # m

#: Elements round the turn: of the inner ring, of the outer.
PAIRS = ((10, 8), (16, 13), (20, 16))
QUICK_PAIRS = ((8, 7), (12, 10))
#: The same with meshes far apart in size, and either side as the slave.
RATIOS = ((20, 8), (8, 20))
QUICK_RATIOS = ((12, 6), (6, 12))
SHARED = (8, 16, 24)
QUICK_SHARED = (8, 12, 16)
PATCH = (8, 16, 32)
QUICK_PATCH = (8, 16)

Multipliers = Literal["dual", "standard"]
#: How stress is passed through the tie: multipliers, and whether nodes of the slave are settled.
WAYS: dict[str, tuple[Multipliers, bool]] = {
    "standard, settled": ("standard", True),
    "standard, as meshed": ("standard", False),
    "dual, settled": ("dual", True),
}
RINGS, COARSER, RIGID = "elements round, slave on master", "coarser", "energy of rigid motions"
TORSION, RADIAL = "torsion [N m/rad]", "radial [N/m]"
UNITS = {TORSION: "N m/rad", RADIAL: "N/m"}
ERROR_OF = "Error of the {} stiffness"
NAMES = {TORSION: "torsion", RADIAL: "radial"}


def ring(inner: float, outer: float, turn: int, twist: float = 0.0, rings: int = 1) -> Block:
    """A ring, or several with shared nodes, of curved tetrahedra about as wide as long."""
    layers = max(round(turn / 8), 1)
    return tied_rings.ring(inner, outer, turn, 10, twist, (rings * layers, layers), WIDTH)


def as_meshed(own: int, other: int, how: Multipliers = "standard") -> tuple[Bodies, Constraint]:
    """The inner ring as the slave of the outer, and the tie."""
    bodies = two_bodies.together(ring(BORE, TIED, own), ring(TIED, OUTSIDE, other, 0.3 / other))
    faces = bodies.faces[0]["x1"], bodies.faces[1]["x0"]
    return bodies, mortar_tie("tie", bodies.points, *faces, bodies.points.size, how)


def tied(own: int, other: int, how: Multipliers = "standard") -> tuple[Bodies, Constraint]:
    """The same with the nodes of the slave settled."""
    bodies, tie = as_meshed(own, other, how)
    return replace(bodies, points=settled(bodies.points, tie)), tie


def stiffnesses(bodies: Bodies, ties: Sequence[Constraint] = ()) -> Record:
    """In torsion the bore is held and the outer surface turned; radially it is moved across."""
    points, n = bodies.points, bodies.points.size
    K = bodies.stiffness(LAME)
    bore, outside = np.unique(bodies.faces[0]["x0"]), np.unique(bodies.faces[-1]["x1"])
    supports = [
        held_dofs("bore", dofs(bore).ravel(), n),
        held_dofs("outside", dofs(outside).ravel(), n),
    ]
    moved = rigid_motions(points[outside])[:, [3, 1]]
    solved = two_bodies.solve(K, [*ties, *supports], np.zeros((n, 2)), {"outside": moved})
    torsion, radial = np.einsum("nm,nm->m", solved.u, K @ solved.u).tolist()
    return {TORSION: torsion, RADIAL: radial}


def rigid_energy(bodies: Bodies, tie: Constraint) -> float:
    """Largest energy of the six rigid motions, as the tie leaves them, beside that of unit strain.

    The rotations are by one radian, so both are of like size.
    """
    K = bodies.stiffness(LAME)
    motions = rigid_motions(bodies.points)
    motions[tie.pivots] -= tie.rows @ motions
    strained = (bodies.points * [1.0, 0.0, 0.0]).ravel()
    energies = np.einsum("nm,nm->m", motions, K @ motions)
    return float(np.abs(energies).max() / (strained @ (K @ strained)))


def traction_error(turn: int, how: Multipliers, settle: bool) -> float:
    """How far the slave's nodal forces of a uniform stress, passed on, are from the master's.

    The worst of all states of stress that load the cylinder: all but tension along its axis.
    """
    bodies, tie = (tied if settle else as_meshed)(turn, round(0.8 * turn), how)
    error = 0.0
    for stress in two_bodies.unit_stresses()[1:]:
        on_slave = bodies.loads(stress, [(0, "x1")])
        on_master = -bodies.loads(stress, [(1, "x0")])
        passed = on_slave - tie.rows.T @ on_slave[tie.pivots]
        error = max(error, float(np.abs(passed - on_master).sum() / np.abs(on_master).sum()))
    return error


@dataclass(frozen=True)
class Reference:
    """What a stiffness of tied rings is compared with.

    Attributes
    ----------
    value : float
        In the unit of the stiffness.
    doubt : float
        Its uncertainty.
    source : str
        Where it comes from.
    """

    value: float
    doubt: float
    source: str

    def errors(self, rows: Sequence[Record], quantity: str) -> Floats:
        """Relative."""
        return np.abs([row[quantity] / self.value - 1.0 for row in rows])

    def of_shared(self, shared: Sequence[Record], quantity: str) -> Floats:
        """Errors of shared nodes; the uncertainty of the reference may be in them too."""
        return np.asarray(self.errors(shared, quantity) + self.doubt / self.value)


def solve_rings(run: Run, pairs: Sequence[tuple[int, int]]) -> tuple[list[Record], list[Record]]:
    """Stiffness of rings that share their nodes, and of tied pairs."""
    shared: list[Record] = []
    with run.step("shared nodes"):
        for turn in QUICK_SHARED if run.quick else SHARED:
            one = two_bodies.together(ring(BORE, OUTSIDE, turn, rings=2))
            shared.append({RINGS: f"shared, {turn}", COARSER: turn, **stiffnesses(one)})
    rows: list[Record] = []
    with run.step("tied"):
        for own, other in pairs:
            bodies, tie = tied(own, other)
            found = {**stiffnesses(bodies, [tie]), RIGID: rigid_energy(bodies, tie)}
            rows.append({RINGS: f"{own} on {other}", COARSER: min(own, other), **found})
    return shared, rows


@case(
    "Rings tied on a cylinder: torsion and radial stiffness",
    source="closed form of the twisted ring; rings that share their nodes",
)
def run(run: Run, page: Page) -> None:
    """Torsion and radial stiffness of tied rings, and stress through the curved tie."""
    pairs = QUICK_PAIRS if run.quick else PAIRS
    ratios = QUICK_RATIOS if run.quick else RATIOS
    turns = QUICK_PATCH if run.quick else PATCH
    shared, rows = solve_rings(run, (*pairs, *ratios))
    with run.step("stress through the tie"):
        patches = {name: [traction_error(n, *how) for n in turns] for name, how in WAYS.items()}
        loose = rigid_energy(*as_meshed(*pairs[0]))
    references = references_of(shared)
    for quantity, reference in references.items():
        check_stiffness(page, quantity, reference, shared, rows)
    page.vanishes(
        "rigid motions: strain energy beside that of unit strain, worst of all",
        max(column(rows, RIGID)),
        within=1e-12,
        why="settled nodes fulfil the tie by their positions, so only round-off is left",
        source="a rigid motion strains nothing",
    )
    order = check_order(page, patches["standard, settled"])
    worst = {q: float(of.errors(rows, q).max()) for q, of in references.items()}
    answer(page, rows[len(pairs) - 1][RINGS], worst, order)
    page.say("Tied rings turn freely as one body.")
    page.section("Stiffness")
    for quantity, reference in references.items():
        add_chart(page, quantity, reference, shared, rows[: len(pairs)], rows[len(pairs) :])
    show_stiffness(page, references, shared, rows)
    show_patches(page, turns, patches, loose, rows[0][RINGS])
    page.image("The tied rings", run.sketch(tied(*pairs[0])[0]))
    page.data("tied", rows)
    page.data("shared", shared)
    page.data("exact torsion [N m/rad]", references[TORSION].value)
    page.data("traction errors", patches)
    page.data("elements round", turns)


def answer(page: Page, finest: str, worst: dict[str, float], order: float) -> None:
    """State the largest errors of tied rings; `finest` is the finest pair of about one size."""
    page.answer(
        "Which error of the stiffness does a tie between rings of different meshes cause?",
        f"Tied rings are within {percent_text(worst[TORSION])} of the closed form in torsion, and "
        f"radially within {percent_text(worst[RADIAL])} of rings that share their nodes.",
        [
            page.judged(
                f"torsion stiffness, {finest} elements round",
                f"torsion, {finest} elements round",
                "closed form",
                unit="GN m/rad",
            ),
            page.judged(
                f"radial stiffness, {finest} elements round",
                f"radial, {finest} elements round",
                "shared nodes",
                unit="GN/m",
            ),
            page.value("largest error in torsion, all pairs [%]", 100 * worst[TORSION]),
            page.value("largest error radially, all pairs [%]", 100 * worst[RADIAL]),
            page.judged(
                "traction through the cylinder: order of its error",
                "order of convergence of the stress passed on",
                "interpolation",
            ),
        ],
        hero=ERROR_OF.format(NAMES[TORSION]),
    )


def show_stiffness(
    page: Page, references: dict[str, Reference], shared: list[Record], rows: list[Record]
) -> None:
    """Stiffness of all rings, and their errors."""
    page.table(
        "Rings tied, and rings of shared nodes",
        [
            (
                row[RINGS],
                *(x for q, of in references.items() for x in (row[q], row[q] / of.value - 1.0)),
            )
            for row in (*rows, *shared)
        ],
        [RINGS, TORSION, "error", RADIAL, "error"],
    )
    page.text(
        "The inner ring is the slave. In torsion the bore is held and the outer surface turned; "
        "radially the outer surface is moved across as a rigid body."
    )


def show_patches(
    page: Page, turns: Sequence[int], patches: dict[str, list[float]], loose: float, first: str
) -> None:
    """Stress through the tie over the mesh, and what settling the nodes is for."""
    page.section("Curvature")
    page.chart(
        "Error of a uniform stress passed through the tie, as nodal forces on the master",
        [trace(name, turns, errors, mode="lines+markers") for name, errors in patches.items()],
        "elements round the turn",
        "relative error of the forces",
        "xy",
    )
    page.text(
        "Two meshes of one cylinder lie a little apart. Slave nodes are settled where the tie sees "
        "the master face, so that rigid motions pass exactly; with the nodes as meshed, turning "
        f"the rings as one body about an axis across costs {loose:.1e} of the energy of unit "
        f"strain ({first} elements). Stress passes as well as facets meet the cylinder; "
        "with dual multipliers only what is constant in a facet does, and the rest is wrong from "
        "node to node, though right in the mean."
    )


def references_of(shared: Sequence[Record]) -> dict[str, Reference]:
    """The closed form in torsion, and shared nodes extrapolated radially."""
    sizes = [1.0 / turn for turn in column(shared, COARSER)]
    radial = grid_convergence(sizes, column(shared, RADIAL))
    closed = "closed form: shear stress falls with r^-2, ends stay free of stress"
    return {
        TORSION: Reference(tied_rings.stiffness(WIDTH), 0.0, closed),
        RADIAL: Reference(
            radial.extrapolated,
            radial.extrapolated_uncertainty,
            f"rings that share their nodes, {radial.sentence('N/m')}",
        ),
    }


def check_stiffness(
    page: Page, quantity: str, reference: Reference, shared: list[Record], rows: list[Record]
) -> None:
    """Each tied pair against the reference."""
    # error of the shared mesh as coarse as the coarser ring, by its order of convergence
    errors = reference.of_shared(shared, quantity)
    slope, offset = np.polyfit(np.log(column(shared, COARSER)), np.log(errors), 1)
    for row in rows:
        coarse = float(np.exp(offset + slope * np.log(row[COARSER])))
        page.equals(
            f"{NAMES[quantity]} stiffness, {row[RINGS]} elements round",
            row[quantity],
            reference.value,
            within=2.0 * coarse,
            why="twice the error of shared nodes on a mesh as coarse as the coarser ring: a tie of "
            "optimal order adds no more than the elements' own error"
            + (", and the band of the reference" if reference.doubt else ""),
            source=reference.source,
            unit=UNITS[quantity],
            measure="stiffness",
            band=coarse * reference.value,
        )


def check_order(page: Page, errors: Sequence[float]) -> float:
    """Order of the error of a traction, on ever finer meshes; that of the finest two."""
    orders = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    order = float(orders[-1])
    page.at_least(
        "traction through the cylinder: order of its error",
        order,
        1.9,
        why="the traction's error cannot be of lower order than that of the facets' normals. On "
        "16 and 32 elements round, the finest, the next term of the error, of the relative size "
        "t^2, t being the half angle of an element, moves the order by "
        "log2((1 + t^2) / (1 + t^2 / 4)) = 0.04 either way; rounded up to a tenth",
        source="interpolation: normals of quadratic facets are of second order",
        measure="order",
        band=float(abs(orders[-1] - orders[-2])) if len(orders) > 1 else None,
    )
    return order


def add_chart(
    page: Page,
    quantity: str,
    reference: Reference,
    shared: list[Record],
    pairs: list[Record],
    ratios: list[Record],
) -> None:
    """Errors of one stiffness by the coarser ring."""
    far_apart = "tied, " + " and ".join(column(ratios, RINGS))
    page.chart(
        ERROR_OF.format(NAMES[quantity]),
        [
            trace(name, column(rows, COARSER), errors, mode=mode)
            for name, rows, errors, mode in (
                ("shared nodes", shared, reference.of_shared(shared, quantity), "lines+markers"),
                ("tied", pairs, reference.errors(pairs, quantity), "lines+markers"),
                (far_apart, ratios, reference.errors(ratios, quantity), "markers"),
            )
        ],
        "elements round the turn, of the coarser ring",
        "relative error",
        "xy",
    )
