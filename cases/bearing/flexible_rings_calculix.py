"""Rollers on a flexible housing as gap springs in CalculiX, beside the project's answer."""

import numpy as np

from fe_drivetrain.bearing import Races, RacesEquilibrium, equilibrium_on_races, roller_motions
from fe_drivetrain.bearing_life.rings import contact_compliance, housing_solid
from fe_drivetrain.cases import case
from fe_drivetrain.cases.bearing.gap_springs import PART, POINTS, calculix_rollers
from fe_drivetrain.cases.references.housed_bearing import (
    ASSUMED_HOUSING,
    NAME,
    Size,
    bearing_s,
    housed_scene,
)
from fe_drivetrain.common import Floats
from fe_drivetrain.export import find_calculix, four_point_stiffness
from fe_drivetrain.report import roller_chart, rolling_elements
from fe_drivetrain.report.number_text import percent_text, value_text
from fe_drivetrain.report.suite import Page, Run

#: Loads [N, N m].
LOADS = {"radial, up": (0.0, 0.0, 4e5, 0.0, 0.0), "combined": (2e5, 0.0, -4e5, 8e5, 0.0)}
HERO = "Load of each roller on the flexible housing under the combined load"
SIZE: Size = (1.0, None)
QUICK_SIZE: Size = (3.6, 8)


@case(
    "Flexible housing: rollers as gap springs in CalculiX on the same mesh",
    source="CalculiX: solid of C3D10, equations, nonlinear springs",
)
def run(run: Run, page: Page) -> None:
    """Write mesh, rollers and the inner ring's motion as a deck; compare each roller's load."""
    find_calculix()
    scene = housed_scene(QUICK_SIZE if run.quick else SIZE)
    bearing = bearing_s().with_rows(laminae=1)
    material = scene.material_of(PART)
    with run.step("housing at the rollers"):
        solid = housing_solid(scene, NAME, bearing)
        C = contact_compliance(
            solid.mesh,
            PART,
            material,
            solid.contacts,
            f"{PART}.base",
            assembly=four_point_stiffness,
        )
        found = equilibrium_on_races(
            Races(bearing, C), list(LOADS.values()), shapes=len(C), tolerance=1e-12
        )
    approach, _ = roller_motions(bearing)
    peaks = []
    for k, name in enumerate(LOADS):
        with run.step(f"CalculiX, {name}"):
            deck = run.folder / f"{name.replace(', ', '_')}.inp"
            theirs = calculix_rollers(deck, solid, bearing, material, found.displacements[k])
        _check(page, name, found, k, theirs, theirs @ approach)
        peaks.append(float(theirs.max()) / 1e3)
    answer(page, found, peaks)
    page.section("Peak roller [kN]")
    page.add(roller_chart(HERO, bearing, found.rollers[1]))
    page.table(
        "Rollers without length on the flexible housing",
        [
            {"load": name, "here": found.rollers[k].max() / 1e3}
            | {"loaded rollers": int((found.rollers[k] > 0.0).sum())}
            for k, name in enumerate(LOADS)
        ],
    )
    page.assume_all(ASSUMED_HOUSING)
    page.text(
        "The motion of the inner ring is that of the project's equilibrium; CalculiX finds which "
        "rollers touch, what they carry and how the housing gives way, and its rollers must add up "
        "to the load. Springs follow the contact law in straight pieces; the mean over a roller's "
        "window on the bore is an equation. Elements are integrated at four points in both. The "
        "deck is 1000 times as stiff, and displacements 1000 times as small, since CalculiX "
        "iterates on springs with large displacements only."
    )
    page.image("The rollers of bearing S", run.sketch(*rolling_elements(bearing)))


def answer(page: Page, found: RacesEquilibrium, peaks: list[float]) -> None:
    """State how far roller loads are from CalculiX's, whose peaks [kN] are given."""
    ours = found.rollers.max(axis=1) / 1e3
    worst = max(
        check.computed for check in page.checks if check.quantity.endswith("over the largest")
    )
    same = "agree" if all(check.passed for check in page.checks) else "do not agree"
    page.answer(
        "Does CalculiX find the same roller loads on a flexible housing?",
        f"All roller loads {same} with CalculiX's gap springs on the same mesh: they differ by "
        f"{percent_text(worst)} of the peak of {value_text(ours[1], 'kN')} at most.",
        [
            *(
                page.value(f"peak roller, {name} [kN]", float(own), beside=peak, by="CalculiX")
                for name, own, peak in zip(LOADS, ours, peaks, strict=True)
            ),
            *(
                page.judged(
                    f"{name}: rollers less those of CalculiX, over the largest",
                    f"largest difference over the peak, {name}",
                    "CalculiX",
                    unit="%",
                )
                for name in LOADS
            ),
        ],
        HERO,
        [
            "CalculiX takes the motion of the inner ring from here: it finds the rollers that "
            "touch and their loads, whose sum must be the load."
        ],
    )


def _check(
    page: Page, name: str, found: RacesEquilibrium, k: int, theirs: Floats, resultant: Floats
) -> None:
    ours, load = found.rollers[k], found.loads[k]
    size = np.array([1.0, 1.0, 1.0, found.races.bearing.arm, found.races.bearing.arm])
    source = "CalculiX on the same mesh"
    page.vanishes(
        f"{name}: rollers less those of CalculiX, over the largest",
        float(np.abs(theirs - ours).max() / ours.max()),
        within=2e-5,
        why=f"its residual, and a law in {POINTS} straight pieces",
        source=source,
        measure="reaction",
    )
    page.vanishes(
        f"{name}: load less the sum of CalculiX's rollers, over the load",
        float(np.linalg.norm((resultant - load) / size) / np.linalg.norm(load / size)),
        within=2e-5,
        why=f"its residual, and a law in {POINTS} straight pieces",
        source=source,
        measure="reaction",
    )
