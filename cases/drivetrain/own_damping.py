"""Torsional modes of a user's drivetrain with the dampers of its file, exact and of first order."""

import numpy as np

from fe_drivetrain.cases.references import published_drivetrains as published
from fe_drivetrain.common import Floats, InputError
from fe_drivetrain.dynamics import damped_by_ratio, gear_table
from fe_drivetrain.dynamics.torsion import (
    GENERATOR,
    ROTOR,
    GearTable,
    GeneratorState,
    Torsional,
    damped_modes,
    gear_masses,
    modal_damping,
    natural_modes,
    response,
    stage_masses,
    two_masses,
)
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.report.suite.chosen import ChosenDrivetrain

MAKERS = {
    "two masses": two_masses,
    "a mass for each stage": stage_masses,
    "a mass for each gear": gear_masses,
}
FINEST = "a mass for each gear"
OF_EACH = (
    "The file's damping ratios are of each shaft and mesh against the masses at its ends, which "
    "leaves a slow swing of all masses far less."
)
CURVES = "Generator's speed for a torque of 1 N m on the rotor, generator free, at three levels"


def own_damping(run: Run, page: Page) -> None:
    """Damping ratios of a user's drivetrain at three levels of detail.

    Raises
    ------
    InputError
        The file states no damping.
    """
    chosen = run.drivetrain("")
    chosen.state(page, topic="Damping of torsional modes")
    table = gear_table(chosen.drivetrain)
    states = [s for s in published.STATES if s == "free" or table.generator.stiffness > 0]
    with run.step("eigenvalues"):
        systems = {
            (name, state): with_dampers(chosen, table, make(table, state))
            for state in states
            for name, make in MAKERS.items()
        }
        rows = [row for key, one in systems.items() for row in checked_rows(page, *key, one)]
    check_two(page, systems["two masses", "free"])
    answer(page, rows, not has_dampers(gear_masses(table, "free")))
    page.section("Damped modes")
    curves = []
    for name in MAKERS:
        x, y = curve(systems[name, "free"], 120 if run.quick else 500)
        # two and five masses turn as the rotor does
        scale = 1.0 if name == FINEST else float(table.speeds[-1])
        curves.append(trace(name, x, y * scale))
    page.chart(CURVES, curves, "frequency [Hz]", "speed per torque [rad/s / (N m)]", "xy")
    page.table("Damping ratios: exact eigenvalues, and to first order, phi^T C phi / 2 omega", rows)
    page.assume_all(table.assumptions())


def with_dampers(chosen: ChosenDrivetrain, table: GearTable, system: Torsional) -> Torsional:
    """The system with its own dampers, or with those of the file's damping ratios."""
    if has_dampers(system):
        return system
    ratios = chosen.drivetrain.damping
    if ratios is None or not max(ratios.shafts, ratios.meshes) > 0.0:
        raise InputError(
            f"drivetrain {chosen.name!r} does not state its damping: add it, as in damping: "
            "{shafts: 0.006, meshes: 0.05}"
        )
    shafts = {shaft.name for shaft in table.shafts} | {"shafts"}
    return damped_by_ratio(
        system,
        {e.name: ratios.shafts if e.name in shafts else ratios.meshes for e in system.elements},
    )


def has_dampers(system: Torsional) -> bool:
    """Whether the file states dampers of single shafts or meshes."""
    return any(element.damping > 0.0 for element in system.elements)


def checked_rows(
    page: Page, name: str, state: GeneratorState, system: Torsional, strict: bool = False
) -> list[Record]:
    """Damping ratios of one model, its eigenvalues checked; strictly one for each mode, or fewer.

    A mode that is damped beyond critical has no ratio.
    """
    found = damped_modes(system)
    page.vanishes(
        f"{name}, generator {state}: largest residual of lambda^2 M + lambda C + K",
        max(residual(system, value) for value in found.eigenvalues),
        within=1e-9,
        why="an eigenvalue makes it singular; ten digits of each are asked for",
        source="least over largest singular value, each row and column over sqrt J, "
        "times the stiffest over the mode's own",
    )
    undamped, first = natural_modes(system).frequencies, modal_damping(system)
    moving = np.flatnonzero(undamped > 0.0)
    return [
        {
            "model": name,
            "generator": state,
            "undamped [Hz]": float(undamped[m]),
            "damped [Hz]": float(f),
            "damping ratio": float(value),
            "to first order": float(first[m]),
        }
        for m, value, f in zip(moving, found.ratios, found.frequencies, strict=strict)
    ]


def residual(system: Torsional, value: complex) -> float:
    """How far lambda^2 M + lambda C + K is from singular, as a relative error of lambda^2."""
    root = np.sqrt(system.J)
    scaled = np.outer(root, root)
    matrix = value**2 * np.eye(len(root)) + (value * system.C + system.K) / scaled
    return float(np.linalg.svd(matrix, compute_uv=False)[-1] / abs(value) ** 2)


def check_two(page: Page, system: Torsional) -> None:
    """Two free masses are one oscillator."""
    (a, b), k, c = system.J, float(system.k[0]), float(system.C[0, 0])
    page.equals(
        "two masses, generator free: damping ratio",
        float(damped_modes(system).ratios[0]),
        float(c / (2.0 * np.sqrt(k * a * b / (a + b)))),
        within=1e-9,
        why="exact but for rounding",
        source="one oscillator: C / 2 sqrt(k J), J = J_1 J_2 / (J_1 + J_2)",
        measure="frequency",
    )


def curve(system: Torsional, points: int) -> tuple[Floats, Floats]:
    """Frequencies [Hz], and the generator's speed per torque on the rotor [rad/s / (N m)]."""
    grid = np.geomspace(0.1, 1e4, points)
    x = np.unique(np.concatenate([grid, damped_modes(system).frequencies]))
    turned = response(system, ROTOR, x)[:, system.place(GENERATOR)]
    return x, np.abs(turned) * 2.0 * np.pi * x


def answer(page: Page, rows: list[Record], by_ratio: bool) -> None:
    """State how strongly the first mode is damped, and which one is damped least."""
    free = [row for row in rows if row["generator"] == "free"]
    first = {
        name: next(float(row["damping ratio"]) for row in free if row["model"] == name)
        for name in MAKERS
    }
    modes = [row for row in free if row["model"] == FINEST]
    least = min(modes, key=lambda row: float(row["damping ratio"]))
    apart = max(
        abs(float(r["to first order"]) / float(r["damping ratio"]) - 1.0)
        for r in modes
        if float(r["damping ratio"]) > 0.0
    )
    other = f"the mode of {value_text(float(least['damped [Hz]']), 'Hz')} is damped least"
    page.answer(
        "How strongly are the torsional modes of the drivetrain damped?",
        f"The first mode, {value_text(float(modes[0]['damped [Hz]']), 'Hz')}, has "
        f"{value_text(100.0 * first[FINEST], '%')} of critical damping; "
        f"{'no mode has less' if least is modes[0] else other}.",
        [
            *(
                page.value(f"damping ratio of the first mode, {name} [%]", 100.0 * ratio)
                for name, ratio in first.items()
            ),
            page.value("least damping ratio [%]", 100.0 * float(least["damping ratio"])),
            page.value("frequency of the least damped mode [Hz]", float(least["damped [Hz]"])),
            page.value("largest difference of the first order [%]", 100.0 * apart),
        ],
        CURVES,
        [
            *([OF_EACH] if by_ratio else []),
            "Dampers are those of the file; bearings, oil and the generator's control add none.",
        ],
    )
