"""Where varying meshes make the undisturbed drivetrain of Park et al. 2021 grow by itself."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from scipy import linalg

from fe_drivetrain.cases import case
from fe_drivetrain.cases.dynamics.park_models import DAMPING, SPEED, meshes
from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file.gear_stages import PlanetaryData
from fe_drivetrain.dynamics import (
    Level,
    Machine,
    Meshing,
    State,
    System,
    integrate,
    library_machine,
    machine_system,
    steady,
    varying_equations,
)
from fe_drivetrain.report import marked
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run

GROWS = 0.3
"""Rate from which a drivetrain counts as unstable [1/s]: threefold in some 4 s."""
PRINTED = 0.3
"""Bearings over those assumed at which the growth is held against Floquet's multiplier."""
OVER = "stiffness of all bearings over the assumed one"
RATE = "growth of an undisturbed drivetrain [1/s]"
CHART = "Growth of the undisturbed drivetrain over the stiffness of its bearings"
PARTS = 256
"""Parts of a mesh period in which the matrix of the equations is taken as constant."""


@case(
    "Bearings and contact ratio: where varying meshes make a drivetrain unstable",
    source="Park et al. 2021, Front. Energy Res. 8:604414, Table 2, sections 4 and 5; bearings and "
    "contact ratios are not printed",
)
def run(run: Run, page: Page) -> None:
    """Growth of a small disturbance at 6 rpm, over bearings and contact ratio."""
    page.about(library_machine("park_2021"))
    ratios: tuple[float, ...]
    if run.quick:
        factors, ratios, step, duration = np.array([0.2, 0.3, 1.0]), (1.4, 1.8), 1.25e-4, 2.0
    else:
        factors = np.array([0.1, 0.15, 0.2, 0.25, 0.3, 0.4, 0.5, 0.7, 1.0, 1.5, 2.0, 3.0])
        ratios, step, duration = (1.2, 1.4, 1.6, 1.8, 2.0), 3.125e-5, 8.0
    rows: list[Record] = []
    for factor in factors:
        with run.step(f"bearings times {factor:g}"):
            system = machine_system(on_bearings(float(factor)), Level.RIGID)
            for ratio in ratios:
                varying = with_ratio(ratio)
                rows.append(
                    {
                        OVER: float(factor),
                        "contact ratio": ratio,
                        RATE: growth(system, varying, step, duration),
                    }
                )
    with run.step("Floquet"):
        check_floquet(page, ratios[0] if run.quick else 1.6, 0.25 * step, duration)
    show(page, rows, factors)
    for quantity, value, unit in (
        ("damping over stiffness", DAMPING, "s"),
        ("harmonics of the meshes", 8, "-"),
        ("bearings", "3e8 to 1.2e9 N/m times the factor", ""),
    ):
        page.assume(quantity, value, unit, "not printed")


def on_bearings(factor: float) -> Machine:
    """The machine with all its bearings, pins with them, that many times as stiff."""
    machine = library_machine("park_2021")

    def stiffer(one: Any) -> Any:
        return one.model_copy(update={"stiffness": tuple(factor * k for k in one.stiffness)})

    bearings = tuple(stiffer(one) for one in machine.bearings)
    first, *others = machine.stages
    if not isinstance(first, PlanetaryData):
        raise TypeError("the first stage of Park et al. 2021 is planetary")
    pins = tuple(stiffer(pin) for pin in first.pins)
    stages = (first.model_copy(update={"pins": pins}), *others)
    return machine.model_copy(update={"bearings": bearings, "stages": stages})


def with_ratio(ratio: float) -> dict[str, Meshing]:
    """The meshes at the printed frequencies, with another contact ratio."""
    return {name: Meshing(ratio, one.frequency, one.phase) for name, one in meshes().items()}


def growth(system: System, varying: dict[str, Meshing], step: float, duration: float) -> float:
    """Rate at which the strain of a small disturbance grows, in the second half [1/s]."""
    n = len(system.names)
    equations = varying_equations(system, varying, SPEED, damping=DAMPING)
    begin = State(1e-5 * np.random.default_rng(1).standard_normal(n), np.zeros(n), np.zeros(n))
    motion = integrate(equations, steady(np.zeros(n)), duration, step, start=begin)
    stiffness = np.where(system.stiffness > 0.0, system.stiffness, np.inf)
    strain = (motion.forces**2 / stiffness).sum(axis=1)
    share = motion.times / duration
    early, late = strain[(share > 0.5) & (share < 0.6)].max(), strain[share > 0.9].max()
    return float(np.log(late / early) / (2.0 * 0.4 * duration))


def floquet(system: System, varying: dict[str, Meshing]) -> float:
    """The same by the largest multiplier of one mesh period, all meshes of one frequency [1/s]."""
    equations = varying_equations(system, varying, SPEED, damping=DAMPING)
    springs, n = equations.springs, len(system.names)
    frequency = float(springs.frequency.max())
    inverse = np.linalg.inv(equations.mass)
    damping = inverse @ equations.C
    whole = np.eye(2 * n)
    for part in range(PARTS):
        stiffness = equations.extra + stiffness_at(springs.rows, system, varying, part + 0.5)
        A = np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ stiffness, -damping]])
        whole = linalg.expm(A / (frequency * PARTS)) @ whole
    return float(frequency * np.log(np.abs(np.linalg.eigvals(whole)).max()))


def stiffness_at(rows: Floats, system: System, varying: dict[str, Meshing], part: float) -> Floats:
    """Stiffness matrix of the springs at a part of the mesh period."""
    k = system.stiffness.copy()
    for name, one in varying.items():
        wave = one.wave()
        at = (one.phase + part / PARTS) % 1.0 * len(wave)
        d = (at - int(at)) / len(wave)
        k[system.spring_names.index(name)] *= float(wave[int(at)] @ d ** np.arange(4))
    return np.asarray(rows.T @ (k[:, None] * rows))


def check_floquet(page: Page, ratio: float, step: float, duration: float) -> None:
    """Growth in time against Floquet's multiplier, the mesh of the third stage alone."""
    system = machine_system(on_bearings(PRINTED), Level.RIGID)
    alone = {"stage 3 mesh": with_ratio(ratio)["stage 3 mesh"]}
    page.equals(
        f"bearings times {PRINTED:g}, contact ratio {ratio:g}, third mesh alone: growth [1/s]",
        growth(system, alone, step, duration),
        floquet(system, alone),
        within=0.05,
        why="the eighth harmonic has 30 steps in its period, and other motions have not died",
        source="Floquet multiplier by matrix exponentials",
        measure="frequency",
    )


def show(page: Page, rows: Sequence[Record], factors: Floats) -> None:
    """The map, the limit, and the answer."""
    page.section("Bearings and contact ratio")
    rate = {
        (float(row[OVER]), float(row["contact ratio"])): float(row[RATE])  # type: ignore[arg-type]
        for row in rows
    }
    ratios = sorted({of for _, of in rate})
    grows = [factor for factor in factors if any(rate[factor, of] > GROWS for of in ratios)]
    safe = min((f for f in factors if not grows or f > max(grows)), default=float(factors[-1]))
    page.chart(
        CHART,
        [
            marked(f"contact ratio {of:g}", factors, [rate[factor, of] for factor in factors])
            for of in ratios
        ],
        OVER,
        RATE,
        "x",
        (float(safe), None),
    )
    page.table("Growth of a small disturbance at 6 rpm", list(rows))
    page.data("growth", list(rows))
    worst, of = max(rate, key=lambda key: rate[key])
    page.limit(
        "varying meshes of Park et al. 2021",
        OVER,
        low=float(safe),
        criterion=f"growth of an undisturbed motion below {GROWS:g} 1/s at all contact ratios",
        beyond=f"a motion without any load grows by {rate[worst, of]:.1f} 1/s",
        program="says nothing: the equations are right, and the drivetrain as stated is unstable",
        remedy="bearings that are known, more damping, or teeth that part",
    )
    assumed = max(rate[1.0, of] for of in ratios)
    page.answer(
        "Is the drivetrain of Park et al. stable, whatever its bearings and contact ratios?",
        (
            f"No: with bearings {formatted(worst, 2)} times the assumed it grows by "
            f"{formatted(rate[worst, of], 2)} per second with no load at all; with those assumed "
            + ("it is stable." if assumed < GROWS else "it grows, too.")
        )
        if grows
        else "Yes: with none of the bearings tried does an undisturbed motion grow.",
        [
            page.value("largest growth [1/s]", rate[worst, of]),
            page.value("at bearings over those assumed of", worst),
            page.value("and a contact ratio of", of),
            page.value("largest growth with the bearings assumed [1/s]", assumed, at_most=GROWS),
            page.value("least bearings with no growth at any stiffer", float(safe)),
        ],
        hero=CHART,
        cautions=[
            "Bearings, contact ratios and damping are not printed: figures 10 to 12 of the source "
            "rest on them.",
            "At one speed, 6 rpm; linear springs pull as they push, so that nothing limits growth.",
        ],
    )
