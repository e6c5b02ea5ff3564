"""Rollers on a flexible housing as gap springs in CalculiX, beside the project's answer."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from fe_drivetrain.bearing import (
    Bearing,
    Races,
    RacesEquilibrium,
    equilibrium_on_races,
    roller_motions,
)
from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats
from fe_drivetrain.export import find_calculix, four_point_stiffness, read_dat, run_calculix
from fe_drivetrain.report import rolling_elements
from fe_drivetrain.rings import HousingSolid, contact_compliance, housing_solid
from fe_drivetrain.scene import Material
from fe_drivetrain.suite import Page, Run
from fe_drivetrain.validation.housed_bearing import (
    ASSUMED_HOUSING,
    NAME,
    Size,
    bearing_s,
    housed_scene,
)

#: Loads [N, N m].
LOADS = {"radial, up": (0.0, 0.0, 4e5, 0.0, 0.0), "combined": (2e5, 0.0, -4e5, 8e5, 0.0)}
PART = f"{NAME}.housing"
SIZE: Size = (1.0, None)
QUICK_SIZE: Size = (3.6, 8)

#: Points of a spring's curve, graded towards zero, where its power law is bent most. Of 400
#: ccx misreads some.
POINTS = 190
#: Displacements in the deck over those here, everything being so much stiffer: ccx iterates on
#: springs with large displacements only, which would change roller loads by some 1e-3.
SMALL = 1e-3
#: Residual force that ccx stops at, of the mean force.
RESIDUAL = 1e-6


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
    for k, name in enumerate(LOADS):
        with run.step(f"CalculiX, {name}"):
            deck = run.folder / f"{name.replace(', ', '_')}.inp"
            theirs = calculix_rollers(deck, solid, bearing, material, found.displacements[k])
        _check(page, name, found, k, theirs, theirs @ approach)
    page.answer(
        "CalculiX, with each roller as a nonlinear spring that does not pull between the housing "
        "and the inner ring, has the same roller loads."
    )
    page.section("Peak roller [kN]")
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


def calculix_rollers(
    deck: Path, solid: HousingSolid, bearing: Bearing, material: Material, u: Floats
) -> Floats:
    """(total,) loads of rollers by CalculiX where the inner ring moves by u (5,)."""
    lines = _lines(solid, bearing, material, u)
    deck.write_text("\n".join([*lines, ""]), "ascii")
    return _forces(run_calculix(deck), solid, bearing)


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


def _lines(solid: HousingSolid, bearing: Bearing, material: Material, u: Floats) -> Iterator[str]:
    """Two nodes on a line for each roller: the mean of its window, and the inner ring behind it."""
    mesh, law = solid.mesh, bearing.rows[0].law
    cells = mesh.cells[mesh.part_cells(PART)]
    total, n = sum(bearing.counts), len(mesh.points)
    outer, inner = n + 1 + np.arange(total), n + 1 + total + np.arange(total)
    approach = SMALL * roller_motions(bearing)[0] @ u
    used = np.unique(cells)
    yield "*NODE, NSET=NALL"
    for number, (x, y, z) in zip((used + 1).tolist(), mesh.points[used].tolist(), strict=True):
        yield f"{number},{x:.13e},{y:.13e},{z:.13e}"
    for numbers, x in ((outer, 0.0), (inner, -1.0)):
        yield f"*NODE, NSET={'OUTER' if x == 0.0 else 'INNER'}"
        for k, number in enumerate(numbers.tolist()):
            yield f"{number},{x:.1f},{k}.,10."
    yield "*ELEMENT, TYPE=C3D10, ELSET=HOUSING"
    for row in np.column_stack([np.arange(len(cells)), cells]) + 1:
        yield ",".join(map(str, row.tolist()))
    yield "*ELEMENT, TYPE=SPRINGA, ELSET=ROLLERS"
    for k in range(total):
        yield f"{len(cells) + 1 + k},{outer[k]},{inner[k]}"
    yield "*SPRING, ELSET=ROLLERS, NONLINEAR"
    largest = 1.1 * float(approach.max())
    for d in (largest * np.linspace(1.0, 0.0, POINTS) ** 3).tolist():
        yield f"{-law.stiffness * (d / SMALL) ** law.exponent:.13e},{-d:.13e}"
    yield f"0.,{largest:.13e}"
    yield "*MATERIAL, NAME=IRON"
    yield "*ELASTIC"
    yield f"{material.youngs_modulus / SMALL:.13e},{material.poisson_ratio:.13e}"
    yield "*SOLID SECTION, ELSET=HOUSING, MATERIAL=IRON"
    yield "*EQUATION"
    for k in range(total):
        where = np.flatnonzero(solid.contacts[:, k])
        terms = [f"{outer[k]},1,-1."]
        terms += [f"{d // 3 + 1},{d % 3 + 1},{solid.contacts[d, k]:.13e}" for d in where]
        yield str(len(terms))
        for start in range(0, len(terms), 4):
            yield ",".join(terms[start : start + 4])
    yield "*BOUNDARY"
    for node in np.unique(mesh.face_nodes(f"{PART}.base")) + 1:
        yield f"{node},1,3"
    yield "OUTER,2,3"
    yield "INNER,2,3"
    yield "*STEP, NLGEOM"
    yield "*STATIC, DIRECT"
    yield "1.,1."
    yield "*CONTROLS, PARAMETERS=FIELD"
    yield f"{RESIDUAL},{RESIDUAL},,,,,,"
    yield "*BOUNDARY"
    for k in range(total):
        yield f"{inner[k]},1,1,{approach[k]:.13e}"
    yield "*NODE PRINT, NSET=INNER"
    yield "RF"
    yield "*END STEP"


def _forces(dat: Path, solid: HousingSolid, bearing: Bearing) -> Floats:
    """(total,) loads of the rollers, from what holds the inner ring."""
    total, n = sum(bearing.counts), len(solid.mesh.points)
    (table,) = [t for t in read_dat(dat) if t.quantity == "forces"]
    found = np.full(total, np.nan)
    found[table.nodes - 1 - n - total] = table.values[:, 0]
    return found
