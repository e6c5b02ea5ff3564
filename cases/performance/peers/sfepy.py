"""SfePy: its field of order two and its own solvers, on curved elements.

SfePy knows tetrahedra with straight edges only. So that it solves the same problem, its field of
order two is given the curved nodes, and its reference mapping the field's own polynomials; the
assembly stays SfePy's.
"""

from __future__ import annotations

from functools import reduce
from operator import add
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from fe_drivetrain.cases.performance.peers.runner import Clock, Problem

NAME = "SfePy"
INSTALL = "pip install sfepy pypardiso"
VARIANTS = {
    "superlu": ("SuperLU, its default", "direct", "common"),
    "pardiso": ("PARDISO", "direct", "common"),
}

EDGES = ((0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3))


def version() -> str:
    """SfePy's version."""
    import sfepy
    from sfepy.base.base import output

    output.set_output(quiet=True)
    return str(sfepy.__version__)


def load(problem: Problem) -> Any:
    """SfePy's domain of straight tetrahedra, its regions, and the curved nodes."""
    from sfepy.discrete import Function, Functions
    from sfepy.discrete.fem import FEDomain, Mesh

    corners, cells = np.unique(problem.cells[:, :4], return_inverse=True)
    cells = cells.reshape(-1, 4).astype(np.int32)
    number = np.full(len(problem.points), -1)
    number[corners] = np.arange(len(corners))
    points = problem.points[corners].copy()
    groups = problem.material.astype(np.int32)
    mesh = Mesh.from_data("mesh", points, None, [cells], [groups], ["3_4"])
    domain = FEDomain("domain", mesh)
    regions = [domain.create_region("all", "all")]
    for group in range(len(problem.youngs_modulus)):
        regions.append(domain.create_region(f"material{group}", f"cells of group {group}"))
    for name, facets in (("fixed", problem.fixed), ("moved", problem.moved)):
        chosen = number[np.unique(facets[:, :3])]
        select = Function(name, lambda coors, domain=None, chosen=chosen: chosen)
        functions = Functions([select])
        regions.append(
            domain.create_region(name, f"vertices by {name}", "facet", functions=functions)
        )
    return problem, domain, regions, number


def solve(state: Any, variant: str, clock: Clock) -> list[float]:
    """The stiffness, by SfePy's assembly and solver."""
    from sfepy.discrete import (
        Equation,
        Equations,
        FieldVariable,
        Function,
        Integral,
        Integrals,
        Material,
    )
    from sfepy.discrete import Problem as SfepyProblem
    from sfepy.discrete.conditions import Conditions, EssentialBC
    from sfepy.discrete.fem import Field
    from sfepy.mechanics.matcoefs import stiffness_from_lame
    from sfepy.solvers.ls import PyPardisoSolver, ScipySuperLU
    from sfepy.solvers.nls import Newton
    from sfepy.terms import Term

    problem, _, (everything, *materials, fixed, moved), number = state
    with clock.step("assembly"):
        field = Field.from_args("displacement", np.float64, "vector", everything, approx_order=2)
        _curve(field, problem, number)
        u = FieldVariable("u", "unknown", field)
        v = FieldVariable("v", "test", field, primary_var_name="u")
        integral = Integral("i", coors=problem.rule_points, weights=problem.rule_weights, order=4)
        terms = []
        for region, lam, mu in zip(materials, *problem.lame(), strict=True):
            material = Material(f"m_{region.name}", D=stiffness_from_lame(3, lam, mu))
            call = f"dw_lin_elastic({material.name}.D, v, u)"
            terms.append(Term.new(call, integral, region, v=v, u=u, **{material.name: material}))
        motion = Function("motion", _motion(problem))
        conditions = Conditions(
            [
                EssentialBC("fixed", fixed, {"u.all": 0.0}),
                EssentialBC("moved", moved, {"u.all": motion}),
            ]
        )
        equations = Equations([Equation("balance", reduce(add, terms))])
        pb = SfepyProblem("elasticity", equations=equations)
        pb.set_bcs(ebcs=conditions)
        linear = (PyPardisoSolver if variant == "pardiso" else ScipySuperLU)({})
        with_clock = _Timed(linear, clock)
        newton = {"i_max": 1, "is_linear": True, "eps_a": 1e-300, "lin_red": None}
        pb.set_solver(Newton(newton, lin_solver=with_clock))
        pb.solve()
        stiffness = sum(
            pb.evaluate(
                f"dw_lin_elastic.i.{region.name}(m_{region.name}.D, u, u)",
                integrals=Integrals([integral]),
                copy_materials=False,
                mode="eval",
                u=u,
            )
            for region in materials
        )
    clock.steps["assembly"] -= clock.steps["solve"]
    return [float(stiffness)]


class _Timed:
    """A linear solver of SfePy with a clock."""

    def __init__(self, solver: Any, clock: Clock) -> None:
        self._solver, self._clock = solver, clock

    def __getattr__(self, name: str) -> Any:
        return getattr(self._solver, name)

    def presolve(self, *values: Any, **options: Any) -> Any:
        with self._clock.step("solve"):
            return self._solver.presolve(*values, **options)

    def __call__(self, *values: Any, **options: Any) -> Any:
        with self._clock.step("solve"):
            return self._solver(*values, **options)


def _motion(problem: Problem) -> Any:
    (M,) = problem.motions

    def motion(ts: Any, coors: Any, **_: Any) -> Any:
        return coors @ M[:, :3].T + M[:, 3]

    return motion


def _curve(field: Any, problem: Problem, number: Any) -> None:
    """Give a field of order two curved nodes, and a mapping that follows them."""
    from sfepy.discrete.fem.mappings import FEMapping

    n = len(problem.points)
    pairs = np.sort(number[problem.cells[:, np.array(EDGES)]].reshape(-1, 2), axis=1)
    keys, first = np.unique(pairs[:, 0] * n + pairs[:, 1], return_index=True)
    middle = problem.cells[:, 4:].ravel()[first]
    nodes = field.poly_space.nodes
    for local in range(4, 10):
        ends = field.econn[:, np.flatnonzero(nodes[local])]
        low, high = np.sort(ends, axis=1).T.astype(np.int64)
        found = middle[np.searchsorted(keys, low * n + high)]
        field.coors[field.econn[:, local]] = problem.points[found]

    def create_mapping(
        region: Any, integral: Any, integration: Any, return_mapping: bool = True
    ) -> Any:
        cells = region.get_cells(true_cells_only=True)
        points = field.get_qp("v", integral)
        values = field.eval_basis("v", 0, integral, iels=cells)
        mapping = FEMapping(field.coors, field.econn[cells], poly_space=field.poly_space)
        out = mapping.get_mapping(points.vals, points.weights, values, poly_space=field.poly_space)
        out.integral, out.qp, out.ps = integral, points, field.poly_space
        return (out, mapping) if return_mapping else out

    field.create_mapping = create_mapping
