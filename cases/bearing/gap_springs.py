"""Rollers of a solid housing as nonlinear gap springs in CalculiX."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from fe_drivetrain.bearing import Bearing, roller_motions
from fe_drivetrain.bearing_life.rings import HousingSolid
from fe_drivetrain.cases.references.housed_bearing import NAME
from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.export import read_dat, run_calculix

PART = f"{NAME}.housing"

#: Points of a spring's curve, graded towards zero, where its power law is bent most. Of 400
#: ccx misreads some.
POINTS = 190
#: Displacements in the deck over those here, everything being so much stiffer: ccx iterates on
#: springs with large displacements only, which would change roller loads by some 1e-3.
SMALL = 1e-3
#: Residual force that ccx stops at, of the mean force.
RESIDUAL = 1e-6


def calculix_rollers(
    deck: Path, solid: HousingSolid, bearing: Bearing, material: Material, u: Floats
) -> Floats:
    """(total,) loads of rollers by CalculiX where the inner ring moves by u (5,)."""
    lines = _lines(solid, bearing, material, u)
    deck.write_text("\n".join([*lines, ""]), "ascii")
    return _forces(run_calculix(deck), solid, bearing)


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
