"""Round shafts in pure bending, of hexahedra and of the program's own tetrahedra."""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from fe_drivetrain.cases.references import locking_bars as bars
from fe_drivetrain.cases.stability.locking_curves import CRITERION
from fe_drivetrain.elasticity.operator import elasticity, incompatible
from fe_drivetrain.elasticity.solve import recovery_estimate
from fe_drivetrain.report.suite import Page, Record, Run

#: Lengths of elements over the diameter. From a quarter on, all of them have one section: shorter
#: ones are divided more finely across.
ROUND_LENGTHS = (1 / 4, 1 / 2, 1.0, 2.0, 4.0)
QUICK_ROUND_LENGTHS = (1 / 4, 4.0)

#: Shafts in the program's own tetrahedra: length over diameter, elements across.
SHAFT_SLENDERNESS = 5
SHAFT_ACROSS = (2, 4)
QUICK_SHAFT_ACROSS = (2,)

Assembly = Callable[..., Any]
PLAIN, MODES = elasticity.assemble, incompatible.assemble
#: Round shafts of hexahedra: nodes, refinement of 8 elements round a turn, and assembly.
SHAFTS: dict[str, tuple[int, int, Assembly]] = {
    "8 nodes, 8 round a turn": (8, 1, PLAIN),
    "8 nodes, 16 round a turn": (8, 2, PLAIN),
    "8 nodes, incompatible modes, 8 round a turn": (8, 1, MODES),
    "8 nodes, incompatible modes, 16 round a turn": (8, 2, MODES),
    "20 nodes, 8 round a turn": (20, 1, PLAIN),
    "27 nodes, 8 round a turn": (27, 1, PLAIN),
}

PURE = "E I: a prism under end moments, Timoshenko and Goodier 1970, art 102"
ROUND_OFF = 1e-8
ROUND_OFF_REASON = (
    "exact but for round-off: 1e-16 times the condition number, about 1e8 of elements 16 times as "
    "long as the bar is deep"
)
ONE_PERCENT = "1 % is the error of a stiffness that a remedy may leave"
OVER_DIAMETER = "length of an element over the diameter of the shaft [-]"
Excesses = dict[str, list[float]]
"""By name of the elements: stiffness over the exact one, less one, along a sweep."""


def shear_part(excess: Sequence[float], lengths: Sequence[float], mesh: Any) -> float:
    """Stiffness that more length adds, over what theory adds, less one; the worst."""
    section = bars.area(mesh), bars.second_moment(mesh)
    expected = np.array([bars.shear_excess(a * bars.SIDE, *section) for a in lengths])
    found = np.array(excess)
    return float(np.abs((found - found[0])[1:] / (expected - expected[0])[1:] - 1.0).max())


def round_hexahedra(run: Run, page: Page, lengths: Sequence[float]) -> Excesses:
    """Bend round shafts of hexahedra."""
    shafts: Excesses = {}
    with run.step("shafts of hexahedra"):
        for name, (nodes, refinement, assembly) in SHAFTS.items():
            run.report(f"shafts of hexahedra: {name}")
            meshes = [bars.round_hexahedra(nodes, refinement, 2, a * bars.SIDE) for a in lengths]
            shafts[name] = [bars.bend(mesh, assembly).excess for mesh in meshes]
            if nodes == 8 and assembly is PLAIN:
                page.vanishes(
                    f"round shaft, hexahedra of {name}: stiffness that longer elements add, over "
                    "G A a^2 / 12, less one, worst of all lengths",
                    shear_part(shafts[name], lengths, meshes[0]),
                    within=ROUND_OFF,
                    why=ROUND_OFF_REASON,
                    source="parasitic shear of a prism of any section; A and I of the mesh",
                )
            if nodes > 8:
                finer = bars.round_hexahedra(nodes, 2, 2, lengths[-1] * bars.SIDE)
                page.equals(
                    f"round shaft, hexahedra of {name}, {lengths[-1]:g} diameters long: stiffness "
                    "over E I",
                    1.0 + shafts[name][-1],
                    1.0,
                    within=CRITERION,
                    why=ONE_PERCENT,
                    source=PURE,
                    measure="stiffness",
                    band=2.0 * abs(bars.bend(finer, assembly).excess - shafts[name][-1]),
                )
    return shafts


def round_tetrahedra(run: Run, page: Page) -> list[Record]:
    """Bend round shafts of tetrahedra, as the program meshes them and linear ones."""
    rows: list[Record] = []
    exact = bars.E * np.pi / 64.0 * bars.SIDE**4
    quadratic, band = [], 0.0
    with run.step("shafts of tetrahedra"):
        for n in QUICK_SHAFT_ACROSS if run.quick else SHAFT_ACROSS:
            run.report(f"shafts of tetrahedra: {n} across")
            for nodes, mesh in bars.round_tetrahedra(SHAFT_SLENDERNESS * bars.SIDE, n).items():
                bent = bars.bend(mesh, PLAIN)
                rows.append(
                    {
                        "nodes": nodes,
                        "elements across": n,
                        "unknowns": mesh.unknowns,
                        "error against E I of the mesh [%]": 100 * bent.excess,
                        "error against E I of the circle [%]": 100 * (bent.rigidity / exact - 1.0),
                    }
                )
                if nodes == 10:
                    quadratic.append(bent.excess)
                    estimate = recovery_estimate(mesh.points, [(mesh.cells, bars.LAME)], bent.u)
                    band = estimate.band(1.0)
    page.equals(
        "round shaft, curved tetrahedra of 10 nodes: stiffness over E I, the coarsest mesh",
        1.0 + quadratic[0],
        1.0,
        within=CRITERION,
        why=ONE_PERCENT,
        source=PURE,
        measure="stiffness",
        band=abs(quadratic[0] - quadratic[-1]) + band,
    )
    return rows
