"""A shaft as two rigid links and a spherical joint with springs, against beam and solid."""

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import solid_shafts
from fe_drivetrain.cases.references.shaft_theory import (
    Tube,
    evenly_loaded_shear,
    parabola_shortfall,
)
from fe_drivetrain.cases.verification.shaft_inputs import show_inputs
from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file import MATERIALS
from fe_drivetrain.report import trace
from fe_drivetrain.report.suite import Page, Record, Run

#: Bending and torsion [N m/rad] of the three shafts of Park et al. 2021, Table 2.
TABLE = {
    "low-speed": (1.34e8, 7.19e7),
    "intermediate": (2.48e7, 1.40e7),
    "high-speed": (2.83e6, 0.15e7),
}
SPLIT = 0.5
BY_SPLIT = "What two links with the spring of Eq 15 make of each load, against the solid, by the "
BY_SPLIT += "split d from the clamp"
STEEL = MATERIALS["steel"]

#: Deflection and rotation of a cantilever's tip under each load of `BEAM`.
Tip = dict[str, tuple[float, float]]


def implied(bending: float, torsion: float) -> tuple[float, float]:
    """Diameter and length [m] of the solid steel shaft that has both, split in the middle.

    With A_s the whole section, as the paper writes.
    """
    nu, G = STEEL.poisson_ratio, STEEL.shear_modulus
    square = 0.5 * 3 * (1 + nu) * torsion / bending - 1
    slenderness = np.sqrt(6 * (1 + nu) / 16 / square)
    diameter = (32 * slenderness * torsion / (np.pi * G)) ** (1 / 3)
    return float(diameter), float(slenderness * diameter)


DIAMETER, L = implied(*TABLE["low-speed"])
TUBE = Tube(DIAMETER, 0.0, L, STEEL)
# its end is loaded, and its root held, evenly
EI, KGA = TUBE.EI, evenly_loaded_shear(TUBE)
Q = 1.0  # N/m

#: Deflection and rotation (downward as positive slope) of a cantilever's tip.
BEAM = {
    "end force": (L**3 / (3 * EI) + L / KGA, L**2 / (2 * EI)),
    "end moment": (L**2 / (2 * EI), L / EI),
    "distributed weight": (Q * (L**4 / (8 * EI) + L**2 / (2 * KGA)), Q * L**3 / (6 * EI)),
}
#: Split of a beam without shear.
SLENDER = {"end force": 1 / 3, "end moment": 1 / 2, "distributed weight": 1 / 4}


def park(d: float | Floats, shear: float = KGA) -> Any:
    """Eq 15 of the paper, with a shear rigidity G A_s [N]."""
    return ((1 - d) ** 2 + d**2) / (L / (3 * EI) + 1 / (shear * L))


def link(load: str, d: float | Floats, k: ArrayLike) -> tuple[Any, Any]:
    """Deflection and rotation of two rigid links, the joint at d L from the clamp."""
    arm = (1 - d) * L
    bent = {"end force": arm, "end moment": 1.0 + 0 * arm, "distributed weight": arm**2 / 2}
    angle = bent[load] / np.asarray(k)
    return angle * arm, angle


def meshed_tip(C: solid_shafts.Compliance) -> Tip:
    """Deflection and rotation of the solid's tip under each load of `BEAM`."""
    tip = C.matrix[1, :, 1, :]
    per_length = STEEL.density * TUBE.area
    return {
        "end force": (float(tip[0, 0]), -float(tip[1, 0])),
        "end moment": (-float(tip[0, 1]), float(tip[1, 1])),
        "distributed weight": (
            float(C.weight[1, 0]) / per_length,
            -float(C.weight[1, 1]) / per_length,
        ),
    }


def check_splits(
    page: Page, refinements: tuple[int, ...], tips: list[Tip], slack: dict[str, float], why: str
) -> list[Record]:
    """The split that each load needs, by beam and solid; rows of a table."""
    rows = []
    for load, (w, phi) in BEAM.items():
        needed = 1 - w / (phi * L)
        by_mesh = [1 - tip[load][0] / (tip[load][1] * L) for tip in tips]
        band = solid_shafts.mesh_band(refinements, by_mesh)
        rows.append(
            {
                "load": load,
                "slender beam": SLENDER[load],
                "beam with shear": needed,
                "solid": by_mesh[-1],
                "band of the solid": band,
                "spring over EI / L": link(load, needed, 1.0)[1] / phi * L / EI,
            }
        )
        page.equals(
            f"{load}: split that meets both deflection and rotation of the tip, solid [-]",
            by_mesh[-1],
            needed,
            within=(slack[load]) * (1 - needed),
            relative=False,
            why=why,
            source="1 - w / (phi L) of Timoshenko's cantilever, evenly held (Hutchinson 2001)",
            measure="deflection",
            band=band,
        )
    return rows


def check_equation(
    page: Page, refinements: tuple[int, ...], tips: list[Tip], slack: float, why: str
) -> float:
    """Eq 15 for an end force, split nowhere and in the middle; the latter over the solid."""
    halves = [link("end force", SPLIT, park(SPLIT))[0] / tip["end force"][0] for tip in tips]
    page.equals(
        "Eq 15 at d = 0: deflection under an end force, over the beam's",
        float(link("end force", 0.0, park(0.0))[0] / BEAM["end force"][0]),
        1.0,
        within=1e-12,
        why="the equation is an equality of energies, and with one link fixed there is one "
        "rotation only: round-off",
        source="Timoshenko's cantilever",
        measure="identity",
        basis="self-consistency",
    )
    page.equals(
        "Eq 15 at d = 1/2: deflection under an end force, over the solid's",
        float(halves[-1]),
        0.5,
        within=slack,
        why=why,
        source="(1 - d)^2 / ((1 - d)^2 + d^2)",
        measure="deflection",
        band=solid_shafts.mesh_band(refinements, halves),
    )
    return float(halves[-1])


def check_implied(page: Page) -> None:
    """The shaft that the table implies has what the table states."""
    for what, value, printed in (
        ("torsion of the low-speed shaft implied by the table", TUBE.GJ / L, TABLE["low-speed"][1]),
        (
            "bending of the low-speed shaft implied by the table, Eq 15 at d = 1/2",
            float(park(SPLIT, STEEL.shear_modulus * TUBE.area)),
            TABLE["low-speed"][0],
        ),
    ):
        page.equals(
            what,
            value,
            printed,
            within=1e-12,
            why="diameter and length are solved for it: round-off",
            source="Park et al. 2021, Table 2",
            unit="N m/rad",
            measure="stiffness",
            basis="self-consistency",
        )


def answer(page: Page, half: float, slack: float) -> None:
    """State what Eq 15 gives at d = 1/2 of the solid's deflection, and which split each load needs.

    Parameters
    ----------
    half : float
        Deflection under an end force by Eq 15 at d = 1/2, over the solid's.
    slack : float
        Allowed difference of that from 1, by the mesh.
    """
    holds = abs(half - 1.0) <= slack
    page.answer(
        "Can two rigid links with the spring of the paper's Eq 15 stand for an elastic shaft?",
        f"The paper's Eq\u00a015 {'holds' if holds else 'does not hold'}: with the spring at mid "
        f"length, an end force gives {100 * half:.0f}\u00a0% of the elastic shaft's deflection.",
        [
            page.value(
                "tip deflection by Eq 15, spring at mid length, of the solid's [%]",
                100 * half,
                beside=100.0,
                by="solid",
            ),
            *(
                page.judged(
                    f"{load}: split that meets both deflection and rotation of the tip, solid",
                    f"spring position needed over length, {load}",
                    "beam with shear",
                )
                for load in BEAM
            ),
        ],
        hero=BY_SPLIT,
        cautions=[
            "No single position of the spring is right for all loads.",
            "The shaft is the solid one that the paper's table implies: it gives no size.",
        ],
        claim="holds" if holds else "does not hold",
    )


@case(
    "Shaft as two rigid links with a rotational spring: position of the joint",
    source="Park et al. 2021, Front. Energy Res. 8:604414, Eq 13-16 and Table 2",
)
def run(run: Run, page: Page) -> None:
    """The solid's compliance, and what one joint makes of each load, over the split d."""
    refinements = (1, 2) if run.quick else (1, 2, 3)
    tips = []
    for refinement in refinements:
        with run.step("mesh and solve"):
            mesh = solid_shafts.solid(solid_shafts.straight((0.0, L), DIAMETER), refinement)
            tips.append(meshed_tip(solid_shafts.sectional_compliance(mesh, STEEL, (0.0, L))))
    section = 2 * 4 * parabola_shortfall(mesh.per_turn)
    local = solid_shafts.local_compliance(TUBE)
    slack = {
        "end force": section + 2 * local / BEAM["end force"][0],
        "end moment": section,
        "distributed weight": section + L * local / BEAM["distributed weight"][0],
    }
    arcs = f"{mesh.per_turn} parabolic arcs round a turn; loads that enter evenly over a section, "
    arcs += f"{solid_shafts.LOCAL:.0%} of what one diameter shears"
    rows = check_splits(page, refinements, tips, slack, arcs)
    half = check_equation(page, refinements, tips, slack["end force"], arcs)
    check_implied(page)
    answer(page, half, slack["end force"])
    page.say(
        "Eq 15 counts the spring's energy once for each link, where one spring has one rotation. "
        "Slender beams need the joint at d = 1/2 for an end moment, 1/3 for an end force and 1/4 "
        "for their weight: no split serves all."
    )
    show_splits(page, rows, tips[-1])
    show_implied(page)
    page.image(
        "The low-speed shaft that the table implies",
        run.sketch(solid_shafts.straight((0.0, L), DIAMETER)),
    )
    page.data("split", {row["load"]: row["solid"] for row in rows})


def show_splits(page: Page, rows: list[Record], solid: Tip) -> None:
    """Errors of springs and splits for each load."""
    page.section("Where the split must sit")
    show_inputs(
        page,
        ("low-speed shaft: diameter", DIAMETER, "m", "implied, see below"),
        ("low-speed shaft: length", L, "m", "implied, see below"),
        ("bending, torsion", "1.34e8, 7.19e7", "N m/rad", "Table 2"),
        steel=STEEL,
    )
    d = np.linspace(0.0, 0.9, 91)
    add_errors(
        page,
        BY_SPLIT,
        d,
        park(d),
        solid,
    )
    add_errors(page, "The same with a spring of EI / L at every split", d, EI / L, solid)
    page.table(
        "Split that meets both deflection and rotation of the tip, and the spring that goes with "
        "it",
        rows,
    )
    page.table(
        "Error of one split for each load, against the solid [%]",
        [
            one_split(label, at, k, solid)
            for label, k, at in (
                ("Eq 15, d = 1/2", park(0.5), 0.5),
                ("Eq 15, d = 0", park(0.0), 0.0),
                ("EI / L, d = 1/2", EI / L, 0.5),
                ("4 EI / 3 L, d = 1/3", 4 * EI / (3 * L), 1 / 3),
                ("27 EI / 16 L, d = 1/4", 27 * EI / (16 * L), 1 / 4),
            )
        ],
    )
    page.text(
        "Eq 13 and 14 set equal the strain energy of a cantilever under an end force and that of "
        "the springs, the latter with a rotation (1 - d) F L / k and another d F L / k. Two links "
        "on one joint have a single relative rotation, (1 - d) F L / k with the joint at d L from "
        "the clamp; without the second term Eq 15 meets the deflection at any d. An end moment "
        "needs k = EI / L whatever the split."
    )


def show_implied(page: Page) -> None:
    """Shafts that have the stiffness of the table."""
    page.section("What the table implies")
    shafts = []
    for name, (bending, torsion) in TABLE.items():
        diameter, length = implied(bending, torsion)
        shafts.append(
            {
                "shaft": name,
                "bending [N m/rad]": bending,
                "torsion [N m/rad]": torsion,
                "diameter [m]": diameter,
                "length [m]": length,
                "length over diameter": length / diameter,
            }
        )
    page.table(
        "Solid steel shafts that have the bending (Eq 15, d = 1/2) and the torsion (G J / L) of "
        "Table 2. With d = 0 or 1 no shaft longer than wide has both",
        shafts,
    )


def add_errors(
    page: Page,
    caption: str,
    d: Floats,
    k: float | Floats,
    solid: Tip,
) -> None:
    """Errors of deflection and rotation of each load over the split."""
    lines = []
    for load in BEAM:
        values = link(load, d, k)
        for what, dash, value, reference in zip(
            ("deflection", "rotation"), ("solid", "dot"), values, solid[load], strict=True
        ):
            error = 100 * (np.asarray(value) * np.ones_like(d) / reference - 1)
            lines.append(trace(f"{load}: {what}", d, error, line={"dash": dash}))
    page.chart(caption, lines, "d", "error [%]")


def one_split(label: str, d: float, k: float, solid: Tip) -> dict[str, float | str]:
    """Errors [%] of one spring and split, for each load."""
    row: dict[str, float | str] = {"spring and split": label}
    for load, references in solid.items():
        for what, value, reference in zip(("w", "phi"), link(load, d, k), references, strict=True):
            row[f"{load}: {what}"] = 100 * (float(value) / reference - 1)
    return row
