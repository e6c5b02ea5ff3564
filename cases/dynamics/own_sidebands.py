"""Sidebands of a mesh line of a user's drivetrain after a step of torque."""

from functools import partial

import numpy as np

from fe_drivetrain.cases.dynamics.mesh_spectra import Spectrum, check_distances, spectrum_of
from fe_drivetrain.cases.dynamics.own_torque_step import (
    FEW,
    LEVELS,
    Stepped,
    first_mode,
    force_of,
    stepped,
)
from fe_drivetrain.comparison import InTime, converge_in_time, peak_between
from fe_drivetrain.dynamics import System, machine_system
from fe_drivetrain.report.suite import ChosenDrivetrain, Page, Record, Run, check_in_time

HARMONICS = 2
STEPS = 24
"""Steps in a period of the mesh."""
SWINGS = 24
"""Periods of the first mode that are simulated."""
NEAR, FAR = 0.4, 1.6
"""Distances from the line between which sidebands are looked for, over the first mode."""
BESIDE = "Spectra of the mesh force beside the line of stage {} after a torque step"
RINGING = "ringing of the main shaft [Hz]"


def own(run: Run, page: Page, chosen: ChosenDrivetrain) -> None:
    """Distance of sidebands from the line of one stage, whose meshes alone vary."""
    number = run.count("stage", 1)
    of = stepped(page, chosen).only(number)
    line = line_of(of)
    rows: list[Record] = []
    curves = []
    for name, level in LEVELS.items():
        system = machine_system(of.machine, level)
        with run.step(f"torque step, {name}"):
            row, spectrum = after_step(page, of, name, system, line)
        rows.append(row)
        curves.append(spectrum.beside(line, 3.0 * FAR * of.first, name))
    page.section("After a torque step")
    page.table(f"Mesh of stage {number}, line at {line:.4g} Hz", rows)
    page.chart(BESIDE.format(number), curves, "frequency [Hz]", "over the line", "y")
    page.skip("an eccentric gear", "its size is that of the paper")
    answer(page, chosen, number, line, rows, 1.0 / seconds_of(of))


def line_of(of: Stepped) -> float:
    """Mesh frequency of the one stage whose meshes vary [Hz]."""
    return of.meshing[of.meshes[0]].frequency


def seconds_of(of: Stepped) -> float:
    """Time that is simulated [s]."""
    return SWINGS / of.first


def after_step(
    page: Page, of: Stepped, name: str, system: System, line: float
) -> tuple[Record, Spectrum]:
    """Check the sidebands of the mesh line after a torque step; return them and the spectrum."""
    dt = 1.0 / (STEPS * line)
    motion = of.moved(system, seconds_of(of), dt, HARMONICS)
    shaft = motion.forces[:, system.spring_names.index(of.shaft)]
    spectrum = spectrum_of(force_of(system, motion.forces, of.meshes[0]), dt)
    near, far = NEAR * of.first, FAR * of.first
    ringing = spectrum_of(shaft, dt).peak(near, far)
    below, above = spectrum.sidebands(line, near, far)
    check_distances(
        page,
        f"{name}, torque step",
        line,
        (below, above),
        ringing,
        spectrum.resolution,
        source="force k(t) times an elongation that rings as the main shaft does",
    )
    series = converge_in_time(partial(ringing_of, of, system), dt / 2.0, 4)
    within = dict.fromkeys(series.finest.values, 0.03)
    check_in_time(
        page,
        f"torque step, {name}",
        series,
        within,
        energy=1e-2,
        why=FEW,
        open_for=within,
    )
    return {
        "model": name,
        "mesh line [Hz]": spectrum.peak(line - near, line + near),
        "sideband below [Hz]": below,
        "sideband above [Hz]": above,
        RINGING: ringing,
        "first mode with mean meshes [Hz]": first_mode(system),
    }, spectrum


def ringing_of(of: Stepped, system: System, dt: float, harmonics: int) -> InTime:
    """Frequency of the main shaft after the step, and largest force of the mesh, eight periods."""
    motion = of.moved(system, 8.0 / of.first, dt, harmonics)
    mesh = force_of(system, motion.forces, of.meshes[0])
    force = np.sign(mesh.mean()) * mesh
    shaft = motion.forces[:, system.spring_names.index(of.shaft)]
    values = {
        RINGING: spectrum_of(shaft, dt).peak(NEAR * of.first, FAR * of.first),
        "largest force over its mean": peak_between(force) / float(force.mean()),
    }
    return InTime(values, motion.relative_imbalance, motion.converged)


def answer(
    page: Page,
    chosen: ChosenDrivetrain,
    number: int,
    line: float,
    rows: list[Record],
    resolved: float,
) -> None:
    """State how far sidebands are from the mesh line [Hz] at both levels."""
    flat, space = (
        0.5 * float(row["sideband above [Hz]"] - row["sideband below [Hz]"]) for row in rows
    )
    near = 0.5 * resolved
    page.answer(
        "How far do sidebands stand from a mesh line, and what moves them?",
        f"Sidebands of the {line:.4g}\u00a0Hz line stand {flat:.2f}\u00a0Hz from it in the "
        f"torsional model, {space:.2f}\u00a0Hz in three dimensions, as the main shaft rings.",
        [
            page.value("sidebands from the mesh line, torsional [Hz]", flat, near),
            page.value("sidebands from the mesh line, three dimensions [Hz]", space, near),
            *(
                page.value(
                    f"ringing of the main shaft, {row['model']} [Hz]",
                    row[RINGING],
                    beside=row["first mode with mean meshes [Hz]"],
                    by="lowest mode",
                )
                for row in rows
            ),
            page.value(f"mesh line of stage {number} [Hz]", line),
        ],
        BESIDE.format(number),
        [
            f"{chosen.title}: of all meshes those of stage {number} vary, with square waves; "
            "damping is assumed."
        ],
    )
