"""Errors of a stiffness by locking: curves and limits, over Poisson's ratio among others."""

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.cases.references.locking_solids import bulk_over_shear
from fe_drivetrain.comparison import last_within
from fe_drivetrain.elasticity.operator import elasticity, incompressible
from fe_drivetrain.report import trace
from fe_drivetrain.report.suite import Page

plain, averaged = elasticity.assemble, incompressible.assemble

CRITERION = 0.01  # error of a stiffness
WITHIN = f"stiffness within {100 * CRITERION:g} %"
HOLDS = "the remedy is to hold a stiffness within 1 % at every nu of the sweep"

AXIS = "bulk over shear modulus: 2.2 at nu = 0.3, 9.7 at 0.45, 50 at 0.49, 500 at 0.499"
NU = "Poisson's ratio [-]"

#: The tetrahedron in which the program meshes.
DEFAULT = "10 nodes, curved"
AVERAGED = f"{DEFAULT}, averaged"

Range = tuple[float | None, float | None]


def largest(values: ArrayLike) -> float:
    """Largest size."""
    return float(np.abs(values).max())


def curve(name: str, x: Sequence[float], errors: ArrayLike, dashed: bool = False) -> Any:
    """Errors without their sign [%], for a logarithmic axis."""
    percent = 100 * np.maximum(np.abs(errors), 1e-12)
    return trace(name, x, percent, mode="lines+markers", line={"dash": "dash"} if dashed else {})


def error_traces(of: Mapping[str, Sequence[float]], nus: Sequence[float]) -> list[Any]:
    """Errors over the ratio of moduli, remedied ones dashed."""
    moduli = [bulk_over_shear(nu) for nu in nus]
    return [
        curve(name, moduli, errors, dashed="averaged" in name or "modes" in name)
        for name, errors in of.items()
    ]


def error_chart(
    page: Page,
    caption: str,
    x: str,
    curves: Mapping[str, tuple[Sequence[float], ArrayLike]],
    dashed: Callable[[str], bool],
    safe: Range | None,
) -> None:
    """Errors without their sign over x, both on logarithmic axes; some curves are dashed."""
    traces = [curve(name, *of, dashed=dashed(name)) for name, of in curves.items()]
    page.chart(caption, traces, x, "error [%]", "xy", safe)


def shaded(nu: float | None) -> Range | None:
    """Ratios of moduli up to that of nu."""
    return None if nu is None else (None, bulk_over_shear(nu))


def limit(
    page: Page,
    method: str,
    at: Sequence[float],
    errors: Sequence[float],
    program: str,
    remedy: str,
    parameter: str = NU,
) -> None:
    """A bound from above, where the sweep has found one."""
    high, worst = last_within(at, errors, CRITERION), max(errors, key=abs)
    if abs(worst) > CRITERION and high is not None:
        page.limit(
            method,
            parameter,
            high=high,
            criterion=WITHIN,
            beyond=f"error up to {100 * worst:+,.0f} % at {at[-1]:.4g}",
            program=program,
            remedy=remedy,
        )
