"""A planetary stage whose ring gear bends: how thin a rim may be for a rigid ring to hold."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.dynamics.own_elastic_ring import own
from fe_drivetrain.cases.references.published_planetary import (
    LIN_PARKER_STAGE,
    plane_stage,
    plane_supports,
    plane_system,
)
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import round_off
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.dynamics import (
    Rim,
    assemble,
    bodies_of,
    springs_of,
    system_modes,
    with_rim,
)
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.report.suite.chosen import SETTING

STEEL = Material(youngs_modulus=210e9, poisson_ratio=0.3, density=7850.0)
WIDTH = 0.03  # m
PLANETS = 3
HERO = "Lowest frequency against that of a rigid ring"
NEAR = 5.0  # change that a rigid ring is taken to be right within [%]
THICKNESS, LOWEST = "thickness of the rim [mm]", "change of the lowest frequency [%]"


def rim(thickness: float, stiffer: float = 1.0) -> Rim:
    """Outside of the teeth, of steel or of what is stiffer."""
    stage = plane_stage(LIN_PARKER_STAGE, PLANETS)
    modulus = stiffer * STEEL.youngs_modulus
    material = STEEL.model_copy(update={"youngs_modulus": modulus})
    teeth = stage.centre_distance + stage.planet_ring_radius
    return Rim(teeth + thickness / 2, thickness, WIDTH, material)


def frequencies(thickness: float, highest: int, stiffer: float = 1.0) -> Floats:
    """Frequencies of the stage with harmonics up to the highest [Hz]."""
    stage = plane_stage(LIN_PARKER_STAGE, PLANETS)
    harmonics = range(2, highest + 1)
    coordinates, springs = with_rim(stage, springs_of(stage), rim(thickness, stiffer), harmonics)
    springs += plane_supports(LIN_PARKER_STAGE, stage)
    return system_modes(assemble([*bodies_of(stage), *coordinates], springs)).frequencies


@case(
    "A planetary stage with an elastic ring gear: frequencies by the thickness of the rim",
    source="Love 1927, art. 293, for the ring; Lin and Parker 1999 for the stage",
    settings={
        "drivetrain": "FILE, or a name of the library (otherwise the stage of Lin and Parker)"
    },
)
def run(run: Run, page: Page) -> None:
    """Thin-ring checks, convergence with harmonics, and the change against a rigid ring."""
    if SETTING in run.settings:
        own(run, page, run.drivetrain(""))
        return
    check_ring(page)
    rigid = system_modes(plane_system(LIN_PARKER_STAGE, PLANETS)).frequencies
    highest = 13 if run.quick else 25
    rows: list[Record] = []
    for thickness in np.geomspace(0.005, 0.04, 6 if run.quick else 15):
        f = run.timed(f"{1e3 * thickness:.1f} mm", frequencies, float(thickness), highest)
        row: Record = {THICKNESS: 1e3 * float(thickness)}
        row |= {f"f{k} [Hz]": float(f[k]) for k in (1, 3, 5, 7)}
        row["rim alone, 2 waves [Hz]"] = rim(float(thickness)).frequency(2)
        row[LOWEST] = 100 * float(f[1] / rigid[1] - 1)
        rows.append(row)
    check_limits(page, rigid)
    answer(page, rows)
    page.section("By the thickness of the rim")
    page.sweep(
        "Frequencies of the stage, three planets",
        rows,
        THICKNESS,
        {f"f{k} [Hz]": f"frequency {k}" for k in (1, 3, 5, 7)},
        log="xy",
        axis="frequency [Hz]",
    )
    page.sweep(HERO, rows, THICKNESS, LOWEST, table=False)
    page.say(
        "The rim adds modes of its own between those of the stage.",
        "Harmonics of the rim that are multiples of the number of planets join the rotational "
        "modes, those next to a multiple the translational ones.",
    )
    page.text(
        "The rim is a thin ring, without shear or stretching: 40 mm are a quarter of its radius. "
        "Its rigid motion is on the supports of the source's ring, its bending on nothing else."
    )


def answer(page: Page, rows: list[Record]) -> None:
    """State what a thin and a thick rim change of the lowest frequency."""
    thin, thick = rows[0], rows[-1]
    enough = min(row[THICKNESS] for row in rows if -row[LOWEST] <= NEAR)
    names = {id(row): f"rim of {row[THICKNESS]:.0f} mm" for row in (thin, thick)}
    page.answer(
        "How thin may the rim of a ring gear be, if the model has a rigid ring?",
        f"Modelling the ring gear as rigid gives the lowest frequency within {NEAR:g}\u00a0% for "
        f"rims of at least {enough:.0f}\u00a0mm; a {thin[THICKNESS]:.0f}\u00a0mm rim lowers it by "
        f"{-thin[LOWEST]:.0f}\u00a0%.",
        [
            page.value(
                f"thinnest rim of those computed with an error below {NEAR:g} % [mm]", enough
            ),
            *(
                page.value(f"change of the lowest frequency, {names[id(row)]} [%]", row[LOWEST])
                for row in (thin, thick)
            ),
            *(
                page.value(
                    f"lowest frequency, {names[id(row)]} [Hz]",
                    row["f1 [Hz]"],
                    beside=row["f1 [Hz]"] / (1 + row[LOWEST] / 100),
                    by="rigid ring",
                )
                for row in (thin, thick)
            ),
            page.judged(
                "rim of 10 mm squeezed by 1 kN: change of the diameter",
                "change of diameter, 10 mm rim squeezed by 1 kN",
                "Timoshenko",
            ),
        ],
        HERO,
        [
            "The rim is modelled as a thin ring without shear or stretching, although 40 mm are a "
            "quarter of its radius."
        ],
    )


def check_limits(page: Page, rigid: Floats) -> None:
    """Check convergence with harmonics, and a rim so stiff that the ring is rigid."""
    series = [frequencies(0.02, n)[1:11] for n in (4, 7, 13, 25)]
    changes = [float(np.abs(a / series[-1] - 1).max()) for a in series[:-1]]
    page.at_most(
        "20 mm rim: change of the first ten frequencies from 13 harmonics to 25",
        changes[-1],
        2e-3,
        why="a point load on a ring has harmonics that fall as the fourth power",
        source="the series with more terms",
        measure="frequency",
        basis="self-consistency",
    )
    hard = frequencies(0.02, 9, 1e6)[1:11]
    page.vanishes(
        "20 mm rim with a modulus a million times that of steel: change against the rigid ring",
        float(np.abs(hard / rigid[1:11] - 1).max()),
        within=1e-4,
        why="what is left goes as the inverse of the modulus",
        source="the rigid ring of Lin and Parker 1999",
    )


def check_ring(page: Page) -> None:
    """The rim alone, free and squeezed."""
    ring = rim(0.01)
    area, inertia = WIDTH * 0.01, WIDTH * 0.01**3 / 12
    rigidity = STEEL.youngs_modulus * inertia
    for n in (2, 3, 4):
        w2 = rigidity / (STEEL.density * area * ring.radius**4) * n**2 * (n**2 - 1) ** 2
        page.equals(
            f"free rim of 10 mm, {n} waves [Hz]",
            ring.frequency(n),
            float(np.sqrt(w2 / (n**2 + 1)) / (2 * np.pi)),
            **round_off(30, "a root of products and powers, in another order"),
            source="Love 1927, art. 293",
            basis="self-consistency",
        )
    load = 1e3
    found = 2 * sum(2 * load / ring.stiffness(n) for n in range(2, 400, 2))
    page.equals(
        "rim of 10 mm squeezed by 1 kN: change of the diameter [mm]",
        1e3 * found,
        1e3 * load * ring.radius**3 / rigidity * (np.pi / 4 - 2 / np.pi),
        within=1e-6,
        why="harmonics up to 400",
        source="thin ring: (pi/4 - 2/pi) P R^3 / (E I), Timoshenko, Strength of Materials, part II",
    )
