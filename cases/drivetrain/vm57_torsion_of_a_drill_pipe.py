"""Torsion of a drill pipe with its collar: verification problem VM57 of Ansys."""

import numpy as np
from scipy.optimize import brentq

from fe_drivetrain.cases import case
from fe_drivetrain.comparison import as_printed
from fe_drivetrain.dynamics.torsion import Inertia, chain, natural_modes
from fe_drivetrain.report.suite import MeshSeries, Page, Record, Run, Target, order_of

# foot, pound-force and slug, as the manual has them; no other unit remains in a frequency
OUTER, WALL, LENGTH = 4.5 / 12.0, 0.335 / 12.0, 5000.0  # ft
SHEAR_MODULUS, DENSITY = 4.4928e9 / 2.0 / 1.3, 15.2174  # lbf/ft^2, slug/ft^3
COLLAR = 29.3  # lbf ft s^2
AREA_MOMENT = np.pi / 32.0 * (OUTER**4 - (OUTER - 2.0 * WALL) ** 4)  # ft^4
PIPE = DENSITY * AREA_MOMENT * LENGTH  # lbf ft s^2

PARTS = "inertias along the pipe"
PRINTED = {"mode 1 [Hz]": "0.3833", "mode 2 [Hz]": "1.260"}
MANUAL = "Ansys Mechanical APDL verification manual, VM57, as quoted; Thomson 1965, example 8.4-1"
EXACT = "b tan b = rho I_p L / J: a uniform shaft, held at one end, with an inertia at the other"


def solve(parts: int) -> Record:
    """Equal pieces of pipe, half of the last of them with the collar."""
    pieces = np.full(parts, PIPE / parts)
    pieces[0] = 0.5 * PIPE / parts + COLLAR
    stiffness = parts * SHEAR_MODULUS * AREA_MOMENT / LENGTH
    inertias = [Inertia(f"part {i}", float(J)) for i, J in enumerate(pieces)]
    between = [(f"pipe {i}", stiffness, 0.0) for i in range(parts - 1)]
    found = natural_modes(chain(inertias, between, ("top", stiffness, 0.0))).frequencies
    return {PARTS: parts} | {key: float(f) for key, f in zip(PRINTED, found, strict=False)}


def exact(mode: int) -> float:
    """Frequency of a mode, from 0 [Hz]."""
    low, high = mode * np.pi, (mode + 0.5) * np.pi
    root = brentq(lambda b: b * np.sin(b) - PIPE / COLLAR * np.cos(b), low, high, xtol=1e-14)
    return float(root * np.sqrt(SHEAR_MODULUS / DENSITY) / LENGTH / (2.0 * np.pi))


def answer(page: Page) -> None:
    """State both frequencies, beside the exact roots and the manual's."""
    figures = [
        *(
            page.judged(f"mode {n}", f"mode {n}, against the exact root", "exact root")
            for n in (1, 2)
        ),
        *(
            page.judged(
                f"80 inertias: {key.partition(' [')[0]}",
                f"{key.partition(' [')[0]}, against the manual",
                "Ansys manual",
                value,
            )
            for key, value in PRINTED.items()
        ),
    ]
    one, two = figures[:2]
    same = "agree" if all(figure.status == "good" for figure in figures) else "do not agree"
    hero = "Frequencies of 80 inertias: differences from exact roots and from the manual"
    page.answer(
        "What are the torsional frequencies of the drill pipe with its collar?",
        f"The torsional frequencies are {one.value:.4f} and {two.value:.4f}\u00a0Hz and {same} "
        f"with the manual's {' and '.join(PRINTED.values())}\u00a0Hz.",
        figures,
        hero,
    )
    page.errors(hero, figures)


@case(
    "Torsion of a drill pipe with its collar (VM57)",
    source="Ansys Mechanical APDL verification manual, VM57; Thomson, Vibration theory and "
    "applications, 1965",
)
def run(run: Run, page: Page) -> None:
    """Cut the pipe into ever more inertias on springs, against the printed and exact roots."""
    series = MeshSeries([run.timed("modes", solve, n) for n in (10, 20, 40, 80)], PARTS)
    second = "pieces of length h miss (b h / L)^2 / 24 of a frequency, b < pi / 2 and 3 pi / 2"
    steady = "the next term of the error is some (b / 20)^2 of the first, 0.03 on three meshes"
    targets = []
    for mode, key in enumerate(PRINTED):
        within = ((mode + 0.5) * np.pi / 80) ** 2 / 24.0
        targets.append(Target(key, exact(mode), within, second, EXACT, order=2.0))
    page.targets("By number of inertias", series, targets, "exact")
    for mode, (key, printed) in enumerate(PRINTED.items()):
        for name, value, band in (
            (f"80 inertias: {key}", series.last[key], series.band(key, 2.0)),
            (f"exact root: {key}", exact(mode), None),
        ):
            of = as_printed(printed)
            page.equals(name, value, **of, source=MANUAL, basis="second-hand", band=band)
        order = order_of(f"order of convergence: {key}", 2.0, 0.05, steady, "lumped inertias")
        page.meets(series.order(key), order)
    answer(page)
    page.text(
        "A pipe of 5,000 ft is held at its top and carries a collar of 29.3 lbf ft s^2 at its "
        "lower end. Its own inertia is 2.4 times that, so one spring and one inertia would not do."
    )
