"""Block in shear, in bending and as a cantilever: strain energies known in closed form."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

LENGTH, HEIGHT, WIDTH = 0.6, 0.2, 0.15  # m
E, NU = 169e9, 0.275
SHEAR, CURVATURE = 1e-3, 1e-3  # rad, 1/m
FORCE = 1e6  # N/m, per width

NAMES = {
    4: "tetrahedra of 4 nodes",
    10: "tetrahedra of 10 nodes",
    8: "hexahedra of 8 nodes",
    20: "hexahedra of 20 nodes",
    27: "hexahedra of 27 nodes",
}
SECOND_ORDER = (10, 20, 27)

#: Elements through the height, by the nodes of an element; three times as many along the block.
DIVISIONS = {4: (8, 16, 32), 8: (8, 16, 32), 10: (2, 4, 8), 20: (2, 4, 8), 27: (2, 4, 8)}


def run(run: Run) -> Any:
    """Energy of three fields with every element."""
    import numpy as np

    from fe_drivetrain.compare import (
        band_of,
        observed_order,
    )
    from fe_drivetrain.interfaces import held_freedoms, held_nodes
    from fe_drivetrain.mesh import FACES, Block, brick
    from fe_drivetrain.operator import traction_loads
    from fe_drivetrain.report import Section, Table, Text, chart, judge, trace
    from fe_drivetrain.scene import Material
    from fe_drivetrain.solve import solve_solid
    from fe_drivetrain.validation.plane_rings import (
        plane_strain,
    )
    from fe_drivetrain.validation.ring_solids import (
        node_at,
    )

    iron = Material(youngs_modulus=E, poisson_ratio=NU, density=0.0)
    plane = plane_strain(E, NU)

    def mesh(nodes: int, divisions: tuple[int, int, int], width: float) -> Block:
        size = np.array([LENGTH, width, HEIGHT])
        return brick(divisions, nodes, lambda p: size * (p - [0.0, 0.5, 0.5]))

    def sheared(p: Any) -> Any:
        return SHEAR * np.column_stack([p[:, 2], np.zeros(len(p)), np.zeros(len(p))])

    def bent(p: Any) -> Any:
        """Pure bending with the section's own distortion: the stress is E kappa z along x alone."""
        x, y, z = p.T
        drop = -0.5 * (x**2 + NU * (z**2 - y**2))
        return CURVATURE * np.column_stack([x * z, -NU * y * z, drop])

    inertia = WIDTH * HEIGHT**3 / 12.0
    exact = {
        "shear": 0.5 * iron.shear_modulus * SHEAR**2 * LENGTH * HEIGHT * WIDTH,
        "bending": 0.5 * E * CURVATURE**2 * inertia * LENGTH,
        # per width: bending and the shear of a parabola, of the plane solution with E'
        "cantilever": FORCE**2
        * (LENGTH**3 / (6.0 * plane.E * HEIGHT**3 / 12.0) + 0.6 * LENGTH / (plane.G * HEIGHT)),
    }

    def under_displacement(nodes: int, field: Any) -> float:
        """Strain energy when the whole surface is displaced as by the field."""
        block = mesh(nodes, (4, 2, 2), WIDTH)
        surface = np.unique(np.concatenate([block.face_nodes(face) for face in FACES]))
        moved = (3 * surface[:, None] + np.arange(3)).ravel()
        values = field(block.points[surface]).ravel()
        n = block.points.size
        static = solve_solid(block.points, block.cells, iron.lame, [], np.zeros(n), (moved, values))
        return float(static.energy[0])

    def stress(x: Any, normal: Any) -> Any:
        """Tractions of the plane cantilever with its force at x = 0 (parabolic shear)."""
        inertia_per_width, c = HEIGHT**3 / 12.0, 0.5 * HEIGHT
        along = FORCE * x[:, 0] * x[:, 2] / inertia_per_width
        shear = FORCE * (c**2 - x[:, 2] ** 2) / (2.0 * inertia_per_width)
        zero = np.zeros(len(x))
        nx = normal[:, :1]
        return nx * np.column_stack([along, zero, shear])

    def cantilever(nodes: int, n: int) -> float:
        """Strain energy per width under the exact tractions on both ends, in plane strain."""
        width = HEIGHT / n
        block = mesh(nodes, (3 * n, 1, n), width)
        points, size = block.points, block.points.size
        top, bottom = (
            node_at(points, [LENGTH, -0.5 * width, z]) for z in (0.5 * HEIGHT, -0.5 * HEIGHT)
        )
        F = traction_loads(points, block.faces["x0"], stress)
        F += traction_loads(points, block.faces["x1"], stress)
        held = [
            held_nodes("plane strain", np.arange(len(points)), [1], size),
            held_freedoms("support", np.array([3 * top, 3 * bottom, 3 * bottom + 2]), size),
        ]
        static = solve_solid(points, block.cells, iron.lame, held, F)
        return float(static.energy[0]) / width

    with run.step("shear and bending"):
        displaced = {
            nodes: {
                "shear": under_displacement(nodes, sheared),
                "bending": under_displacement(nodes, bent),
            }
            for nodes in NAMES
        }
    found = {}
    for nodes, name in NAMES.items():
        with run.step(f"cantilever, {name}"):
            found[nodes] = [cantilever(nodes, n) for n in DIVISIONS[nodes]]

    verdicts = []
    for nodes, name in NAMES.items():
        for field in ("shear", "bending"):
            if field == "bending" and nodes not in SECOND_ORDER:
                continue
            verdicts.append(
                judge(
                    f"{field}, {name}: strain energy, relative to the exact one",
                    displaced[nodes][field] / exact[field] - 1.0,
                    0.0,
                    tolerance=1e-9,
                    relative=False,
                    source="G gamma^2 V / 2"
                    if field == "shear"
                    else "E kappa^2 I L / 2 (Saint-Venant)",
                    reason="the field is in the elements' own space: round-off",
                    measure="identity",
                )
            )
    source = "Timoshenko and Goodier 1970, art 21: P^2 L^3/(6 E' I) + 3 P^2 L/(5 G A)"
    for nodes, name in NAMES.items():
        order = 4.0 if nodes in SECOND_ORDER else 2.0
        sizes = 1.0 / np.array(DIVISIONS[nodes])
        verdicts.append(
            judge(
                f"cantilever, {name}: order of the strain energy",
                observed_order(sizes, np.array(found[nodes])),
                order,
                tolerance=0.3,
                relative=False,
                source="twice the order of the strains",
                reason="one lost order of the strains would show as 2 less; coarse meshes of "
                "linear elements lock, and are barely in their asymptotic range",
                measure="order",
            )
        )
        if nodes in SECOND_ORDER:
            verdicts.append(
                judge(
                    f"cantilever, {name}: strain energy per width",
                    found[nodes][-1],
                    exact["cantilever"],
                    tolerance=1e-4,
                    unit="J/m",
                    source=source,
                    reason="the stress is quadratic, of strains that are linear in an element "
                    "(1/8)^2 is missed, and in energy the square of that, 2e-4, times a small "
                    "factor",
                    measure="energy",
                    band=band_of(sizes, found[nodes], order),
                )
            )
    above = sum(
        value > exact["cantilever"] * (1.0 + 1e-9) for values in found.values() for value in values
    )
    verdicts.append(
        judge(
            "cantilever: meshes whose energy is above the exact one",
            above,
            0.0,
            tolerance=0.0,
            relative=False,
            source="minimum of the potential energy: under given forces, an element mesh is too "
            "stiff",
            reason="a bound has no exception",
            measure="identity",
        )
    )

    def error(nodes: int) -> Any:
        return np.maximum(1.0 - np.array(found[nodes]) / exact["cantilever"], 1e-12)

    return CASE.results(
        run,
        summary=[
            f"The cantilever stores {exact['cantilever']:.2f} J a metre of width; eight hexahedra "
            f"of 27 nodes through its height miss {error(27)[-1]:.1e} of it, as many of 8 nodes "
            f"{100 * error(8)[0]:.1f} %, of tetrahedra of 4 nodes {100 * error(4)[0]:.0f} %. Shear "
            "and pure bending are exact with every element of second order.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Energy of the cantilever",
                items=[
                    chart(
                        "Strain energy that is missed",
                        [
                            trace(name, DIVISIONS[nodes], error(nodes), mode="lines+markers")
                            for nodes, name in NAMES.items()
                        ],
                        "elements through the height",
                        "1 - energy / exact energy",
                        ("x", "y"),
                    ),
                    Table(
                        caption="Energies over the exact ones",
                        columns=[
                            "element",
                            "shear",
                            "bending",
                            "cantilever, coarse",
                            "cantilever, middle",
                            "cantilever, fine",
                        ],
                        rows=[
                            [
                                name,
                                *(displaced[nodes][f] / exact[f] for f in ("shear", "bending")),
                                *(v / exact["cantilever"] for v in found[nodes]),
                            ]
                            for nodes, name in NAMES.items()
                        ],
                    ),
                    Text(
                        text="Shear and bending: the whole surface is displaced as the exact field "
                        "says. Cantilever: plane strain; both ends carry the exact tractions, so "
                        "the stress is that of the closed form to the last corner."
                    ),
                ],
            )
        ],
        figures={
            "exact": exact,
            "divisions": {str(k): v for k, v in DIVISIONS.items()},
            "cantilever": {str(k): v for k, v in found.items()},
            "displaced": {str(k): v for k, v in displaced.items()},
        },
    )


CASE = Case(
    name="verification/cantilever_block",
    title="Block in shear, bending and as a cantilever: known energies",
    source="Saint-Venant's bending; Timoshenko and Goodier 1970, Theory of Elasticity, art 21",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
