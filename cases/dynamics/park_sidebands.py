"""Sidebands of a mesh line: a torque step that rings, and an eccentric gear."""

from functools import partial

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.dynamics.mesh_spectra import Spectrum, check_distances, spectrum_of
from fe_drivetrain.cases.dynamics.own_sidebands import own
from fe_drivetrain.cases.dynamics.park_models import (
    CONTACT_RATIO,
    DAMPING,
    MESHES,
    eccentric_bodies,
    offset_mass,
    torque,
    varying_model,
)
from fe_drivetrain.cases.references import park_2021 as park
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import InTime, converge_in_time, peak_between
from fe_drivetrain.dynamics import (
    Level,
    Loads,
    State,
    System,
    equations_of,
    integrate,
    library_machine,
    machine_system,
    steady,
    summed,
    system_modes,
    wind_up,
)
from fe_drivetrain.report import trace
from fe_drivetrain.report.suite import Page, Record, Run, check_in_time

MESH, LINE = MESHES[3], park.MESH_LINES[2]
TURNING = abs(eccentric_bodies()["gear 3"].speed) / 10.0
"""Of gear 3 at 6 rpm of the rotor [Hz]."""
HARMONICS = 2
BESIDE = "Spectra of the mesh force beside the mesh line after a torque step"
RINGING = "ringing of the low-speed shaft [Hz]"
UNSURE = "uncertain by step and harmonics [Hz]"


@case(
    "Park et al. 2021: sidebands of a mesh line, torsional and in three dimensions",
    source="Park et al. 2021, Front. Energy Res. 8:604414, section 4, Figure 9",
    settings={
        "drivetrain": "FILE, or a name of the library (otherwise park_2021)",
        "stage": "1 (from 1 on, of your own drivetrain, whose line is looked at)",
    },
)
def run(run: Run, page: Page) -> None:
    """Distance of sidebands from the mesh line after a torque step, and with an eccentric gear."""
    chosen = run.drivetrain("park_2021", gears=True)
    if chosen.own:
        own(run, page, chosen)
        return
    dt, duration = (5e-4, 8.0) if run.quick else (1.25e-4, 16.0)
    machine = library_machine("park_2021")
    page.about(machine)
    rows: list[Record] = []
    traces = []
    for name, level in (("torsional", Level.TORSIONAL), ("three dimensions", Level.RIGID)):
        system = machine_system(machine, level)
        row, spectrum = after_step(run, page, name, system, dt, duration)
        rows.append(row)
        traces.append(spectrum.beside(LINE, 6.0, name))
    page.section("After a torque step (Figure 9)")
    page.table("Mesh of gears 2 and 3", rows)
    page.chart(BESIDE, traces, "frequency [Hz]", "over the line", "y")
    with run.step("eccentric gear 3"):
        eccentric(page, machine_system(machine, Level.RIGID), dt, duration)
    flat, space = ((row["sideband above [Hz]"] - row["sideband below [Hz]"]) / 2.0 for row in rows)
    lines = [row["mesh line [Hz]"] for row in rows]
    show_words(page, lines, flat, space, 1.0 / duration)
    # what leaves the resonance unsure leaves sidebands so, which stand off by it
    near = [max(0.5 / duration, float(row[UNSURE])) for row in rows]
    answer(page, lines, (flat, space), near, 0.5 / duration)
    for name, value, unit in (
        ("contact ratio of all meshes", CONTACT_RATIO, "-"),
        ("damping over stiffness", DAMPING, "s"),
        ("harmonics of the meshes", HARMONICS, "-"),
    ):
        page.assume(name, value, unit, "not printed")


def answer(
    page: Page, lines: list[float], off: tuple[float, float], near: list[float], read: float
) -> None:
    """State how far sidebands are from the mesh line [Hz] in both models, beside the source.

    Each distance is known to `near`, the lines to half the resolution of the spectrum, `read`.
    """
    flat, space = off
    farther = space > flat
    page.answer(
        "How far do sidebands stand from a mesh line, and what moves them?",
        f"Sidebands stand {flat:.2f}\u00a0Hz from the mesh line in the torsional model, "
        f"{space:.2f}\u00a0Hz in three dimensions: the paper's larger distance in three dimensions "
        + ("holds." if farther else "does not hold."),
        [
            page.value("distance of sidebands from the mesh line, torsional [Hz]", flat, near[0]),
            page.value(
                "distance of sidebands from the mesh line, three dimensions [Hz]", space, near[1]
            ),
            page.value("mesh line, torsional [Hz]", lines[0], read, beside=LINE, by="Park et al."),
            page.value(
                "mesh line, three dimensions [Hz]", lines[1], read, beside=LINE, by="Park et al."
            ),
            page.value("distance of sidebands of an eccentric gear 3: its speed [Hz]", TURNING),
        ],
        BESIDE,
        [
            "The distance is the frequency at which the low-speed shaft rings: bearings and "
            "bending lower it here. Bearings are assumed, as the source does not print them."
        ],
        claim="holds" if farther else "does not hold",
    )
    page.say(
        "An eccentric gear 3 adds sidebands at its own speed from the line: defects of gears stand "
        "at the speed of their shafts, and what rings at its own frequency.",
    )


def after_step(
    run: Run, page: Page, name: str, system: System, dt: float, duration: float
) -> tuple[Record, Spectrum]:
    """Check the sidebands of the mesh line after a torque step; return them and the spectrum."""
    with run.step(f"torque step, {name}"):
        force, shaft = stepped(system, dt, duration)
    spectrum = spectrum_of(force, dt)
    ringing = spectrum_of(shaft, dt).peak(0.75, 4.0)
    below, above = spectrum.sidebands(LINE, 0.75, 4.0)
    check_distances(
        page,
        f"{name}, torque step",
        LINE,
        (below, above),
        ringing,
        spectrum.resolution,
        source="force k(t) times an elongation that rings as the low-speed shaft does",
    )
    series = converge_in_time(partial(ringing_of, system, 3.0), dt / 4.0, 4)
    # a line of the padded spectrum of three seconds is more than a hundredth of it
    within = dict.fromkeys(series.finest.values, 0.03)
    check_in_time(
        page,
        f"torque step, {name}",
        series,
        within,
        energy=1e-2,
        why="a hundredth of the energy is half a hundredth of the forces",
        open_for=within,
    )
    row = {
        "model": name,
        "mesh line [Hz]": spectrum.peak(LINE - 0.5, LINE + 0.5),
        "sideband below [Hz]": below,
        "sideband above [Hz]": above,
        "ringing of the low-speed shaft [Hz]": ringing,
        UNSURE: series.band(RINGING),
        "first mode with mean meshes [Hz]": first_mode(system),
    }
    return row, spectrum


def show_words(page: Page, lines: list[float], flat: float, space: float, resolved: float) -> None:
    """Show the printed statements beside lines and sidebands of either model."""
    page.section("Printed, ours, verdict")
    page.table(
        "Words of section 4",
        [
            [
                "place of the mesh line",
                "the same in both models",
                f"{lines[0]:.2f} and {lines[1]:.2f} Hz",
                "agrees" if abs(lines[0] - lines[1]) < resolved else "differs",
            ],
            [
                "place of the sidebands",
                "shifted",
                f"by {abs(space - flat):.3f} Hz",
                "agrees" if abs(space - flat) > resolved else "differs",
            ],
            [
                "distance of the sidebands",
                "longer in three dimensions",
                f"{flat:.3f} Hz torsional, {space:.3f} Hz in three dimensions",
                "agrees" if space > flat else "differs: what is let go lowers the first mode",
            ],
        ],
        ["statement", "printed", "ours", "verdict"],
    )


def first_mode(system: System) -> float:
    """Above zero [Hz]."""
    return float(system_modes(system).frequencies[1])


def stepped(system: System, dt: float, duration: float) -> tuple[Floats, Floats]:
    """Force of the mesh [N] and torque of the low-speed shaft [N m] after a balanced step."""
    load = torque(system, 1.0 / park.ratio())
    motion = integrate(varying_model(system, HARMONICS), steady(load), duration, dt)
    mesh, shaft = (system.spring_names.index(name) for name in (MESH, "LSS rx"))
    return motion.forces[:, mesh], motion.forces[:, shaft]


def ringing_of(system: System, duration: float, dt: float, harmonics: int) -> InTime:
    """Frequency of the low-speed shaft after the step, and largest force of the mesh."""
    load = torque(system, 1.0 / park.ratio())
    motion = integrate(varying_model(system, harmonics), steady(load), duration, dt)
    mesh, shaft = (motion.forces[:, system.spring_names.index(name)] for name in (MESH, "LSS rx"))
    force = np.sign(mesh.mean()) * mesh
    values = {
        RINGING: spectrum_of(shaft, dt).peak(0.75, 4.0),
        "largest force over its mean": peak_between(force) / float(force.mean()),
    }
    return InTime(values, motion.relative_imbalance, motion.converged)


def eccentric(page: Page, system: System, dt: float, duration: float) -> None:
    """Lines that an eccentric gear 3 adds to a steady state."""
    load = torque(system, 1.0 / park.ratio())
    equations = varying_model(system, HARMONICS)
    begin = wind_up(equations_of(system), load)
    start = State(begin.q, np.zeros(len(load)), np.zeros(len(load)))
    times = np.arange(0.0, duration + 2e-3, 2e-3)
    mesh = system.spring_names.index(MESH)

    def force(acting: Loads) -> Floats:
        return integrate(equations, acting, duration, dt, start=start).forces[:, mesh]

    off = offset_mass(system, eccentric_bodies()["gear 3"], times)
    added = force(summed(steady(load), off)) - force(steady(load))
    spectrum = spectrum_of(added, dt)
    check_distances(
        page,
        "eccentric gear 3",
        LINE,
        spectrum.sidebands(LINE, 2.5, 5.0),
        TURNING,
        spectrum.resolution,
        source="speed of gear 3 at 6 rpm of the rotor, of the radii of Table 2",
    )
    near = np.abs(spectrum.frequencies - LINE) < 6.0
    page.section("With an eccentric gear 3")
    page.chart(
        "What it adds to the spectrum of the mesh force",
        [
            trace(
                "gears 2-3",
                spectrum.frequencies[near],
                spectrum.size[near] / spectrum.size[near].max(),
            )
        ],
        "frequency [Hz]",
        "over the largest",
        "y",
    )
