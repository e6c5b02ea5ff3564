"""Energy account of a run in time: what is in motion and strain, and what came and went.

Where rows stand, dampers take force times displacement, by trapezia over each step, as loads give.
Where rows turn, they take power times time, since a damper is moved by turning, too, and what
turning the rows against the forces takes is put in by the clock.
"""

from __future__ import annotations

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.compiled import inner_loop, places
from fe_drivetrain.dynamics.time.law_loops import DAMPER, DAMPING, DRIFT, ROW, SPRING, ZR, Laws, Z
from fe_drivetrain.dynamics.time.turning_rows import Turning

KINETIC, STRAIN, WORK, DISSIPATED, CLOCK = places(5)
"""Columns of the energies."""

STORED, POWER, FOLLOWED, LOST = places(4, 5)
"""Places behind the energies: stored by laws beyond the constant stiffness, power of their clock,
power of dampers along errors, and power that dampers take where rows turn."""


@inner_loop
def product(x: Floats, y: Floats) -> float:  # pragma: no cover - compiled
    """Sum of x y."""
    total = 0.0
    for i in range(len(x)):
        total += x[i] * y[i]
    return total


@inner_loop
def powers_of_springs(
    turning: Turning, u: Floats, v: Floats, along: Floats
) -> tuple[float, float]:  # pragma: no cover - compiled
    """Power that linear springs' dampers take, and that turning their rows puts in.

    Parameters
    ----------
    turning : Turning
        Rows that turn, as they are now.
    u, v : Floats
        Displacements and velocities (n,).
    along : Floats
        Forces (m,) of all linear springs with their dampers, overwritten.
    """
    lost = clock = 0.0
    for i in range(turning.springs.shape[1]):
        if turning.springs[3, i] != 0.0:
            stiffness, damping = turning.springs[0, i], turning.springs[1, i]
            drift = product(turning.now[1, i], u)
            speed = product(turning.now[0, i], v) + drift
            stretch = product(turning.now[0, i], u) - turning.springs[2, i]
            along[i] = stiffness * stretch + damping * speed
            lost += damping * speed * speed
            clock += along[i] * drift
    for i in range(len(u)):
        lost += v[i] * product(turning.damping[i], v)
        clock += 0.5 * u[i] * product(turning.slopes[i], u)
    return lost, clock


@inner_loop
def powers_of_laws(
    laws: Laws, y: Floats, of: Floats
) -> tuple[float, float]:  # pragma: no cover - compiled
    """The same of springs with laws, beside the power along their errors and of their clock.

    Parameters
    ----------
    laws : Laws
        Laws of q springs, whose rows have drifts.
    y, of : Floats
        Vectors of the rows and of the laws, as `law_forces` has them at the beginning of a step.
    """
    lost = clock = 0.0
    for i in range(of.shape[1]):
        drift = y[Z, laws.numbers[DRIFT, i]]
        speed = y[ZR, laws.numbers[ROW, i]] + drift
        lost += (of[DAMPER, i] + laws.values[DAMPING, i] * speed) * speed
        clock += of[SPRING, i] * drift
    return lost, clock


@inner_loop
def powers_of_bearings(
    turning: Turning, u: Floats, v: Floats, loads: Floats, resisted: Floats
) -> tuple[float, float]:  # pragma: no cover - compiled
    """The same of bearings, with loads (5 b,) and those of their dampers (5 b,)."""
    lost = clock = 0.0
    m = turning.springs.shape[1]
    for i in range(len(loads)):
        drift = product(turning.now[1, m + i], u)
        lost += resisted[i] * (product(turning.now[0, m + i], v) + drift)
        clock += loads[i] * drift
    return lost, clock
