"""Two rings, one in the other, meshed apart and tied on the cylinder between them."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

RADII = 0.5, 1.0, 1.5  # m: bore, tied cylinder, outer surface
WIDTH = 1.0  # m
E, NU = 210e9, 0.3

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


def run(run: Run) -> Any:
    """Torsion and radial stiffness of tied rings, and stress through the curved tie."""
    import numpy as np

    from fe_drivetrain.compare import grid_convergence
    from fe_drivetrain.report import Section, Table, Text, chart, judge, trace

    pairs = QUICK_PAIRS if run.quick else PAIRS
    ratios = QUICK_RATIOS if run.quick else RATIOS
    shared_turns = QUICK_SHARED if run.quick else SHARED
    exact = torsion_stiffness()
    with run.step("shared nodes"):
        shared = [stiffnesses(one_ring(turn)) for turn in shared_turns]
    radial = grid_convergence(
        [1.0 / turn for turn in shared_turns], [found["radial"] for found in shared]
    )
    with run.step("tied"):
        tied = [stiffnesses(*tied_rings(own, other)) for own, other in (*pairs, *ratios)]
    with run.step("stress through the tie"):
        turns = QUICK_PATCH if run.quick else PATCH
        patches = {
            name: [traction_error(turn, *how) for turn in turns]
            for name, how in (
                ("standard, settled", ("standard", True)),
                ("standard, as meshed", ("standard", False)),
                ("dual, settled", ("dual", True)),
            )
        }
        loose = rigid_energy(*as_meshed(*pairs[0]))
    references = {"torsion": exact, "radial": radial.extrapolated}
    doubt = {"torsion": 0.0, "radial": radial.extrapolated_uncertainty}
    labels = [f"{own} on {other}" for own, other in (*pairs, *ratios)]

    def errors(found: Any, quantity: str) -> Any:
        return np.abs([each[quantity] / references[quantity] - 1.0 for each in found])

    verdicts = []
    # what the reference is in doubt by may be in them too
    of_shared = {q: errors(shared, q) + doubt[q] / references[q] for q in references}
    for quantity, unit, source in (
        (
            "torsion",
            "N m/rad",
            "closed form: shear stress falls with r^-2, ends stay free of stress",
        ),
        ("radial", "N/m", f"rings that share their nodes, {radial.sentence('N/m')}"),
    ):
        for label, found, (own, other) in zip(labels, tied, (*pairs, *ratios), strict=True):
            # Error of the shared mesh as coarse as the coarser ring, by its order of convergence.
            coarse = error_of(min(own, other), shared_turns, of_shared[quantity])
            verdicts.append(
                judge(
                    f"{quantity} stiffness, {label} elements round",
                    found[quantity],
                    references[quantity],
                    tolerance=2.0 * coarse,
                    unit=unit,
                    source=source,
                    reason="twice the error of shared nodes on a mesh as coarse as the coarser "
                    "ring: a tie of optimal order adds no more than the elements' own error"
                    + (", and the band of the reference" if doubt[quantity] else ""),
                    measure="stiffness",
                    band=coarse * references[quantity],
                )
            )
    verdicts.append(
        judge(
            "rigid motions: strain energy beside that of unit strain, worst of all",
            max(found["rigid"] for found in tied),
            0.0,
            tolerance=1e-12,
            relative=False,
            source="a rigid motion strains nothing",
            reason="settled nodes fulfil the tie by their positions, so only round-off is left",
            measure="identity",
        )
    )
    settled_errors = patches["standard, settled"]
    order = float(np.log2(settled_errors[-2] / settled_errors[-1]))
    verdicts.append(
        judge(
            "traction through the cylinder: order that its error lacks to two",
            max(2.0 - order, 0.0),
            0.0,
            tolerance=0.1,
            relative=False,
            source="interpolation: normals of quadratic facets are of second order",
            reason="the traction's error cannot be of lower order than that of the facets' "
            "normals; a tenth for an order seen on few meshes",
            measure="order",
            band=0.1,
        )
    )
    worst = max(float(errors(tied, q).max()) for q in references)
    charts = []
    for quantity, title in (("torsion", "torsion"), ("radial", "radial")):
        lines = [
            trace("shared nodes", shared_turns, of_shared[quantity], mode="lines+markers"),
            trace(
                "tied",
                [min(pair) for pair in pairs],
                errors(tied[: len(pairs)], quantity),
                mode="lines+markers",
            ),
            trace(
                "tied, " + " and ".join(labels[len(pairs) :]),
                [min(pair) for pair in ratios],
                errors(tied[len(pairs) :], quantity),
                points=True,
            ),
        ]
        charts.append(
            chart(
                f"Error of the {title} stiffness",
                lines,
                "elements round the turn, of the coarser ring",
                "relative error",
                logarithmic="xy",
            )
        )
    charts.append(
        chart(
            "Error of a uniform stress passed through the tie, as nodal forces on the master",
            [trace(name, turns, errors, mode="lines+markers") for name, errors in patches.items()],
            "elements round the turn",
            "relative error of the forces",
            logarithmic="xy",
        )
    )
    return CASE.results(
        run,
        summary=[
            f"Rings tied on a cylinder are within {100 * worst:.2g} % of the closed form in "
            "torsion and of rings that share their nodes in radial stiffness, and turn freely as "
            f"one body. Uniform stress passes the curved tie with order {order:.1f}.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Stiffness",
                items=[
                    *charts[:2],
                    Table(
                        caption="Rings tied, and rings of shared nodes",
                        columns=[
                            "elements round, slave on master",
                            "torsion [N m/rad]",
                            "error",
                            "radial [N/m]",
                            "error",
                        ],
                        rows=[
                            [
                                label,
                                found["torsion"],
                                found["torsion"] / exact - 1.0,
                                found["radial"],
                                found["radial"] / references["radial"] - 1.0,
                            ]
                            for label, found in zip(
                                [*labels, *(f"shared, {turn}" for turn in shared_turns)],
                                [*tied, *shared],
                                strict=True,
                            )
                        ],
                    ),
                    Text(
                        text="The inner ring is the slave. In torsion the bore is held and the "
                        "outer surface turned; radially the outer surface is moved across as a "
                        "rigid body."
                    ),
                ],
            ),
            Section(
                title="Curvature",
                items=[
                    charts[2],
                    Text(
                        text="Two meshes of one cylinder lie a little apart. Slave nodes are "
                        "settled where the tie sees the master face, so that rigid motions pass "
                        "exactly; with the nodes as meshed, turning the rings as one body about "
                        f"an axis across costs {loose:.1e} of the energy of unit strain "
                        f"({labels[0]} elements). Stress passes as well as facets meet the "
                        "cylinder; with dual multipliers only what is constant in a facet does, "
                        "and the rest is wrong from node to node, though right in the mean."
                    ),
                ],
            ),
        ],
        figures={
            "torsion": [found["torsion"] for found in tied],
            "radial": [found["radial"] for found in tied],
            "exact torsion": exact,
            "traction errors": patches,
            "elements round": list(turns),
        },
    )


def error_of(turn: int, turns: Any, errors: Any) -> float:
    """Error of shared nodes with so many elements round, by a power law through those solved."""
    import numpy as np

    slope, offset = np.polyfit(np.log(turns), np.log(errors), 1)
    return float(np.exp(offset + slope * np.log(turn)))


def lame() -> tuple[float, float]:
    return E * NU / ((1.0 + NU) * (1.0 - 2.0 * NU)), E / (2.0 * (1.0 + NU))


def torsion_stiffness() -> float:
    """tau = T / (2 pi r^2 b) from bore to surface: T / theta = 4 pi G b / (1/r0^2 - 1/r2^2)."""
    import math

    G = E / (2.0 * (1.0 + NU))
    return 4.0 * math.pi * G * WIDTH / (1.0 / RADII[0] ** 2 - 1.0 / RADII[2] ** 2)


def ring(inner: float, outer: float, turn: int, across: int, twist: float = 0.0) -> Any:
    """A closed ring of curved tetrahedra, its axis on x."""
    import numpy as np

    from fe_drivetrain.mesh import brick, joined

    def shape(x: Any) -> Any:
        r = inner + x[:, 0] * (outer - inner)
        angle = 2.0 * np.pi * (x[:, 1] + twist)
        return np.column_stack([WIDTH * x[:, 2], r * np.cos(angle), r * np.sin(angle)])

    along = max(round(turn * WIDTH / 8.0), 1)
    return joined(brick((across, turn, along), 10, shape))


def layers(turn: int) -> int:
    """Elements across one ring."""
    return max(round(turn / 8), 1)


def one_ring(turn: int) -> Any:
    from fe_drivetrain.validation import (
        two_bodies,
    )

    return two_bodies.together(ring(RADII[0], RADII[2], turn, 2 * layers(turn)))


def tied_rings(own: int, other: int, multipliers: Any = "standard") -> tuple[Any, Any]:
    """The inner ring as the slave of the outer, settled, and the tie."""
    from dataclasses import replace

    from fe_drivetrain.interfaces import settled

    bodies, tie = as_meshed(own, other, multipliers)
    return replace(bodies, points=settled(bodies.points, tie)), tie


def as_meshed(own: int, other: int, multipliers: Any = "standard") -> tuple[Any, Any]:
    from fe_drivetrain.interfaces import mortar_tie
    from fe_drivetrain.validation import (
        two_bodies,
    )

    bodies = two_bodies.together(
        ring(RADII[0], RADII[1], own, layers(own)),
        ring(RADII[1], RADII[2], other, layers(other), 0.3 / other),
    )
    faces = bodies.faces[0]["x1"], bodies.faces[1]["x0"]
    return bodies, mortar_tie("tie", bodies.points, *faces, bodies.points.size, multipliers)


def stiffnesses(bodies: Any, tie: Any = None) -> dict[str, float]:
    """Stiffness in torsion and radially; energy of rigid motions beside that of unit strain."""
    import numpy as np

    from fe_drivetrain.common import rigid_motions
    from fe_drivetrain.interfaces import dofs, held_dofs
    from fe_drivetrain.validation import (
        two_bodies,
    )

    points, n = bodies.points, bodies.points.size
    K = bodies.stiffness(lame())
    ties = [] if tie is None else [tie]
    bore, outside = np.unique(bodies.faces[0]["x0"]), np.unique(bodies.faces[-1]["x1"])
    supports = [
        held_dofs("bore", dofs(bore).ravel(), n),
        held_dofs("outside", dofs(outside).ravel(), n),
    ]
    moved = rigid_motions(points[outside])[:, [3, 1]]
    solved = two_bodies.solve(K, [*ties, *supports], np.zeros((n, 2)), {"outside": moved})
    energy = np.einsum("nm,nm->m", solved.u, K @ solved.u)
    found = {"torsion": float(energy[0]), "radial": float(energy[1])}
    if tie is not None:
        found["rigid"] = rigid_energy(bodies, tie)
    return found


def rigid_energy(bodies: Any, tie: Any) -> float:
    """Largest energy of the six rigid motions, as the tie leaves them, beside that of unit strain.

    The rotations are by one radian, so both are of like size.
    """
    import numpy as np

    from fe_drivetrain.common import rigid_motions

    K = bodies.stiffness(lame())
    motions = rigid_motions(bodies.points)
    motions[tie.pivots] -= tie.rows @ motions
    strained = (bodies.points * [1.0, 0.0, 0.0]).ravel()
    energies = np.einsum("nm,nm->m", motions, K @ motions)
    return float(np.abs(energies).max() / (strained @ (K @ strained)))


def traction_error(turn: int, multipliers: Any, settle: bool) -> float:
    """How far the slave's nodal forces of a uniform stress, passed on, are from the master's.

    The worst of all states of stress that load the cylinder: all but tension along its axis.
    """
    import numpy as np

    from fe_drivetrain.validation import (
        two_bodies,
    )

    bodies, tie = (tied_rings if settle else as_meshed)(turn, round(0.8 * turn), multipliers)
    error = 0.0
    for stress in two_bodies.unit_stresses()[1:]:
        on_slave = bodies.loads(stress, [(0, "x1")])
        on_master = -bodies.loads(stress, [(1, "x0")])
        passed = on_slave - tie.rows.T @ on_slave[tie.pivots]
        error = max(error, float(np.abs(passed - on_master).sum() / np.abs(on_master).sum()))
    return error


CASE = Case(
    name="verification/tie_on_cylinder",
    title="Rings tied on a cylinder: torsion and radial stiffness",
    source="closed form of the twisted ring; rings that share their nodes",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
