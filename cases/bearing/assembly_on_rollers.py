"""A whole scene on rollers that lift off: shaft, inner ring and housing as solids."""

import numpy as np

from fe_drivetrain.bearing import SOFTEST_LEFT_OUT, catalogue_bearing
from fe_drivetrain.bearing_life.coupled import coupled_equilibrium, factors_of, scene_body
from fe_drivetrain.bearing_life.rings import (
    AssemblyEquilibrium,
    assembly_equilibrium,
    roller_assembly,
)
from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.housed_bearing import ASSUMED_HOUSING, NAME, housed_scene
from fe_drivetrain.common import Floats
from fe_drivetrain.common.typeset import MINUS
from fe_drivetrain.report import roller_chart, rolling_elements
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.shafts.fidelity import unit_stiffness

#: Loads at the hub [N, N m], with the gearbox's weight.
LOADS = {
    "weight of the rotor": (0.0, 0.0, -3e5, 0.0, 0.0, 0.0),
    "and thrust, overhang moment": (2e5, 0.0, -3e5, 0.0, 5e5, 0.0),
    "and overturning moment": (2e5, 0.0, -3e5, 0.0, -5e5, 5e5),
}
LOAD_NAMES = ("weight alone", "with thrust and overhang", "with overturning moment")
ALL = 144
CHANGE = "solids over housing in series [%]"


@case(
    "Whole scene on rollers that lift off: rings and shaft as solids, against rigid rings",
    source="solids of shaft, inner ring and housing; bearing S; Stirling 2023, ch. 3 and 4",
)
def run(run: Run, page: Page) -> None:
    """Solve the solids once, then loads; beside them a beam on the bearing with rigid rings."""
    scene = housed_scene((3.6, 8) if run.quick else (1.6, None))
    # fewer rollers are fewer solves
    bearing = catalogue_bearing("bearing_s_o20", laminae=0, elements=12 if run.quick else 36)
    factors = factors_of(list(LOADS.values()), scene.gearbox.weight)
    with run.step("solids at the rollers"):
        assembly = roller_assembly(scene, {NAME: bearing})
    with run.step("equilibrium"):
        whole = assembly_equilibrium(assembly, factors, shapes=ALL)
        few = assembly_equilibrium(assembly, factors)
    with run.step("beam on rigid rings"):
        housing = {NAME: np.asarray(unit_stiffness(scene, NAME, "rigid"))}
        rigid, series = (
            coupled_equilibrium(scene_body(scene, level=1, housings=h), {NAME: bearing}, factors)
            for h in ({}, housing)
        )
    check(page, whole, few, scene.gearbox.stiffness)
    solids = whole.rollers
    rows = [
        peaks_of(name, solids[k], rigid.rollers(NAME)[k], series.rollers(NAME)[k])
        for k, name in enumerate(LOADS)
    ]
    page.section("Peak roller")
    most = max(range(len(rows)), key=lambda k: abs(rows[k][CHANGE]))
    hero = f"Load of each roller between solids, {LOAD_NAMES[most]}"
    page.add(roller_chart(hero, bearing, solids[most]))
    answer(page, rows, hero)
    page.table("Peak roller under loads at the hub and the weight of the gearbox", rows)
    page.assume_all(ASSUMED_HOUSING)
    page.text(
        f"{few.assembly.shapes()[1].size} shapes of the solids are taken. They are solved once, "
        "for a load and a moment at each roller and the unit loads of the scene. Rollers lie "
        "between the outer face of the bearing, which is one body with the shaft, and the bore of "
        "the housing."
    )
    page.image("The rollers of bearing S", run.sketch(*rolling_elements(bearing)))


def answer(page: Page, rows: list[Record], hero: str) -> None:
    """State what solids change of the peak roller, load by load."""
    changes = [row[CHANGE] for row in rows]
    span = f"{min(changes):+.1f}\u00a0% to {max(changes):+.1f}\u00a0%".replace("-", MINUS)
    page.found("largest change of the peak roller [%]", max(changes, key=abs))
    peaks = [
        page.value(
            f"peak roller, {name} [kN]",
            row["solids [kN]"],
            beside=row["beam, housing in series [kN]"],
            by="beam, housing in series",
        )
        for name, row in zip(LOAD_NAMES, rows, strict=True)
    ]
    page.answer(
        "How much does the peak roller load change with shaft, ring and housing as solids?",
        f"Solid models of shaft, ring and housing change the peak roller load by {span} against a "
        "beam on rigid rings.",
        [
            page.judged(
                "largest change of the peak roller", "largest change of the peak roller load"
            ),
            *peaks,
        ],
        hero,
        ["The beam has the stiffness of the housing in series with that of the rollers."],
    )


def check(
    page: Page,
    whole: AssemblyEquilibrium,
    few: AssemblyEquilibrium,
    gearbox: tuple[float | str, ...],
) -> None:
    """All converge and balance, and the softest shapes are enough."""
    page.holds(
        "every load case has converged to 1e-8",
        bool(whole.converged.all() and few.converged.all()),
        why="any start leads to the minimum of a convex function",
        source="convex energy",
    )
    page.vanishes(
        "forces of rollers and gearbox less those on the hub, over the largest",
        float(np.abs(_left(whole, gearbox)).max() / np.abs(whole.factors[:, :3]).max()),
        within=1e-6,
        why="the tolerance of the equilibrium, and of the solid's solution",
        source="balance of the shaft",
    )
    page.vanishes(
        "peak rollers with the softest shapes less those with all, relative, the worst",
        float(np.abs(few.rollers.max(axis=1) / whole.rollers.max(axis=1) - 1.0).max()),
        within=SOFTEST_LEFT_OUT,
        why="shapes left out add at most that share of its own softness to a contact",
        source="all shapes",
        measure="reaction",
    )


def peaks_of(name: str, solids: Floats, rigid: Floats, series: Floats) -> Record:
    """Peak and loaded rollers [N] of solids, and of a beam without and with its housing."""
    return {
        "load": name,
        "beam, rigid rings [kN]": rigid.max() / 1e3,
        "beam, housing in series [kN]": series.max() / 1e3,
        "solids [kN]": solids.max() / 1e3,
        CHANGE: 100.0 * (solids.max() / series.max() - 1),
        "loaded rollers, housing in series": int((series > 0.0).sum()),
        "loaded rollers, solids": int((solids > 0.0).sum()),
    }


def _left(found: AssemblyEquilibrium, gearbox: tuple[float | str, ...]) -> Floats:
    """(n, 3) forces on the shaft that nothing balances [N]."""
    springs = np.array([float(k) for k in gearbox[:3]])
    carried = found.motions("gearbox")[:, :3] * springs + found.bearing_loads(NAME)[:, :3]
    down = found.factors[:, 9:] * [0.0, 0.0, 1.0]
    return np.asarray(found.factors[:, :3] - down - carried)
