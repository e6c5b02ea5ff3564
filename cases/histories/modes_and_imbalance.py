"""What imbalance, blade modes and the tower put into the spectra of hub loads."""

import math
from dataclasses import replace

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.rotor_imbalance import GRADE
from fe_drivetrain.common import Floats
from fe_drivetrain.common.typeset import MINUS
from fe_drivetrain.report import chart, mark_events, trace
from fe_drivetrain.report.number_text import certain_value, value_text
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.turbine_loads.histories import MULTIPLES, Spectrum, multiples, spectrum
from fe_drivetrain.turbine_loads.hub_loads import (
    RIGID,
    Condition,
    Controller,
    Physics,
    Rotor,
    Turbine,
    designed_controller,
    even_inflow,
    natural_frequencies,
    similar_turbine,
    simulate,
    turbine_histories,
)

WIND = 16.0
COMPONENTS = ("Fx", "Fy", "Fz", "Mx", "My", "Mz")


@case(
    "Imbalance, blade modes and tower shadow in the spectra of hub loads",
    source="Stirling 2023, appendix B; ISO 21940-11 (balance quality grade G16); Jonkman, "
    "Butterfield, Musial and Scott 2009, NREL/TP-500-38060",
)
def run(run: Run, page: Page) -> None:
    """One wind, with what may move added one by one."""
    turbine = similar_turbine(Rotor())
    controller = designed_controller(turbine)
    with run.step("a rotor that keeps its speed"):
        check_imbalance(page, turbine, controller)
    length = 120.0 if run.quick else 600.0
    grid = [Condition(WIND, "medium", 0.2, seed) for seed in range(1, 2 if run.quick else 7)]
    errors = (math.radians(0.3), 0.0, 0.0)
    variants: dict[str, tuple[Turbine, Physics]] = {
        "rigid": (turbine, RIGID),
        "and tower shadow": (turbine, replace(RIGID, shadow=True)),
        "and blade modes": (turbine, replace(RIGID, shadow=True, blades=True)),
        "and tower modes and shaft": (turbine, Physics()),
        "and mass imbalance": (replace(turbine, mass_imbalance=GRADE), Physics()),
        "and one blade 0.3 deg off": (
            replace(turbine, mass_imbalance=GRADE, pitch_errors=errors),
            Physics(),
        ),
    }
    spectra: dict[str, list[Spectrum]] = {}
    speed = 0.0
    for name, (own, physics) in variants.items():
        with run.step(name):
            made = list(turbine_histories(grid, own, controller, physics, length))
        speed = float(np.mean([m.rotor_speed.mean() for m in made]))
        parts = [[spectrum(c, m.history.step) for c in m.history.loads.T] for m in made]
        spectra[name] = [
            Spectrum(one[0].frequency, mean_of([s.density for s in one]), len(one))
            for one in zip(*parts, strict=True)
        ]
    rows = show(page, spectra, speed, natural_frequencies(turbine, speed))
    check_modes(page, spectra["and blade modes"][1], speed, turbine)
    answer(page, rows[0], rows[-1], len(grid))


def answer(page: Page, rigid: Record, spoilt: Record, seeds: int) -> None:
    """State what imbalance adds to 1P of the side force, and where the edge mode is seen."""
    before, after = (float(row["Fy, 1P [kN]"]) for row in (rigid, spoilt))
    below, above = (
        page.judged(
            f"peak of the side force one turn {side} the edge mode",
            f"edgewise mode in the side force, 1P {side} its own frequency",
            "closed form",
        )
        for side in ("below", "above")
    )
    page.answer(
        "At which frequencies do imbalance and blade modes appear in hub loads?",
        "Mass imbalance and one mispitched blade raise the side force at 1P from "
        f"{value_text(before)} to {value_text(after, 'kN')}; the edgewise blade mode appears at "
        f"{certain_value(below)} and {certain_value(above)}.",
        [
            page.value("side force at 1P [kN]", after, beside=before, by="balanced, rigid"),
            page.judged(
                f"1P of Fy from a mass imbalance of {GRADE:.0f} kg m",
                "side force at 1P by mass imbalance alone",
                "m r w²",
            ),
            page.judged(
                f"1P of Mx from a mass imbalance of {GRADE:.0f} kg m",
                "torque at 1P by mass imbalance alone",
                "closed form",
            ),
            below,
            above,
        ],
        hero=spectrum_of(1),
        cautions=[
            f"One wind speed, {WIND:g} m/s, and {seeds} {'seeds' if seeds > 1 else 'seed'}; in the "
            "fixed frame a mode of the blades appears 1P below and above its own frequency."
        ],
    )


def spectrum_of(component: int) -> str:
    """Caption of the spectrum of a component."""
    added = "as tower shadow, modes and imbalance are added one by one"
    return f"Spectrum of {COMPONENTS[component]} {added}"


def mean_of(values: list[Floats]) -> Floats:
    """Mean of arrays."""
    return np.asarray(np.mean(values, axis=0))


def show(
    page: Page, spectra: dict[str, list[Spectrum]], speed: float, modes: dict[str, float]
) -> list[Record]:
    """Spectra of three components, and amplitudes at multiples of the rotor's speed."""
    rows: list[Record] = []
    for name, own in spectra.items():
        row: Record = {"turbine": name}
        for k in (0, 1, 3, 4):
            unit = "kN" if k < 3 else "kN m"
            for found in multiples(own[k], speed, MULTIPLES[:3]):
                row[f"{COMPONENTS[k]}, {found.name} [{unit}]"] = (found.amplitude or 0.0) / 1e3
        rows.append(row)
    page.section("What each adds")
    page.table(f"Amplitudes at multiples of the rotor's speed, {WIND:g} m/s, mean of seeds", rows)
    page.data("amplitudes", rows)
    turn = speed / (2.0 * np.pi)
    lines = {"1P": turn, "3P": 3.0 * turn, "flap": modes["flap"]}
    lines |= {f"edge {MINUS} 1P": modes["edge"] - turn, "edge + 1P": modes["edge"] + turn}
    for k, unit in ((1, "kN^2/Hz"), (4, "(kN m)^2/Hz"), (0, "kN^2/Hz")):
        drawn = chart(
            spectrum_of(k),
            [
                trace(name, own[k].frequency[1:180], own[k].density[1:180] / 1e6)
                for name, own in spectra.items()
            ],
            "frequency [Hz]",
            f"density [{unit}]",
            logarithmic=("y",),
        )
        page.add(mark_events(drawn, lines))
    return rows


def check_imbalance(page: Page, turbine: Turbine, controller: Controller) -> None:
    """1P of a rotor so heavy that it keeps its speed, in an even wind."""
    heavy = replace(turbine, rotor_inertia=3e12, generator_inertia=1e12)
    spoilt = replace(heavy, mass_imbalance=GRADE)
    wind = even_inflow(turbine, WIND, np.zeros(1200), 20.0)
    physics = replace(RIGID, wake="frozen")
    runs = [simulate(t, controller, wind, physics, held=True) for t in (heavy, spoilt)]
    azimuth, speed = runs[0][1][:, 4], float(runs[0][1][0, 5])
    base = np.column_stack([np.ones_like(azimuth), np.cos(azimuth), np.sin(azimuth)])
    fit = np.linalg.lstsq(base, runs[1][0] - runs[0][0], rcond=None)[0]
    found = np.hypot(fit[1], fit[2])
    weight = GRADE * turbine.rotor.gravity
    tilt = turbine.rotor.shaft_tilt
    known = (
        ("Fy", 1, "kN", GRADE * speed**2, "centrifugal force m r w^2"),
        ("Fz", 2, "kN", GRADE * speed**2, "centrifugal force m r w^2"),
        ("Mx", 3, "kN m", 0.25 * weight * np.cos(tilt), "m g r; the generator has 1/4 of inertia"),
        ("My", 4, "kN m", weight * np.sin(tilt), "m g r times the sine of tilt"),
    )
    for name, k, unit, exact, source in known:
        page.equals(
            f"1P of {name} from a mass imbalance of {GRADE:.0f} kg m",
            float(found[k]) / 1e3,
            exact / 1e3,
            within=1e-6,
            why="round-off of forces of the rest of the rotor",
            source=source,
            unit=unit,
            measure="reaction",
        )


def check_modes(page: Page, found: Spectrum, speed: float, turbine: Turbine) -> None:
    """Peaks of the side force one turn below and above the edge mode."""
    edge, turn = natural_frequencies(turbine, speed)["edge"], speed / (2.0 * np.pi)
    for name, expected in (("below", edge - turn), ("above", edge + turn)):
        near = np.abs(found.frequency - expected) < 0.06
        peak = float(found.frequency[near][np.argmax(found.density[near])])
        page.equals(
            f"peak of the side force one turn {name} the edge mode",
            peak,
            expected,
            within=1.5 * found.spacing / expected,
            why="lines are 1/60 Hz apart, and air damps and loads the blade a little",
            source="frequency of a turning blade, closed form, less or plus that of rotation",
            unit="Hz",
            measure="frequency",
        )
