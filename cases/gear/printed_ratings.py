"""Ratings beside what others print, digit by digit."""

from math import isinf
from typing import Literal

from fe_drivetrain.cases.references.rated_gears import RatedMesh, rated, tolerance
from fe_drivetrain.report.suite import Page, Record

JUDGED = (
    "n_E1 [1/min]",
    "K_v",
    "K_Halpha",
    "sigma_H0 [MPa]",
    "sigma_H [MPa]",
    "sigma_HG [MPa]",
    "S_H",
    "Y_F",
    "Y_S",
    "sigma_F0 [MPa]",
    "sigma_F [MPa]",
    "S_F",
    "life of the flanks at S_H = 1.25 [h]",
)
"""What has a check of its own; the rest is counted."""

WHY = (
    "half of the last digit printed, and what rounding of the inputs leaves: lengths of 1 um 1e-5, "
    "tooth heights as made 5e-5 of the root's stress, K factors with few digits; 2e-5 of stresses "
    "that are endured, of which the cause was not found"
)


def check_mesh(
    page: Page,
    mesh: RatedMesh,
    source: str,
    basis: Literal["independent", "second-hand"] = "independent",
) -> tuple[int, int]:
    """All that is printed of a mesh: checks, a table; how many prints, and how many were met."""
    found, rows, met = rated(mesh), [], 0
    for quantity, prints in mesh.printed.items():
        for number, printed in enumerate(prints):
            ours = found[quantity][number]
            gear = mesh.pair.first if number == 0 else mesh.pair.second
            of = f", {abs(gear.teeth)} teeth" if len(prints) == 2 else ""
            endless = printed == "inf"
            good = (
                isinf(ours)
                if endless
                else abs(ours - float(printed)) <= tolerance(mesh, quantity, printed)
            )
            met += good
            rows.append(_row(quantity + of, printed, ours, "yes" if good else "no"))
            if quantity in JUDGED and not endless:
                name, _, unit = quantity.partition(" [")
                page.equals(
                    f"{mesh.name}: {name}{of}" + (f" [{unit}" if unit else ""),
                    ours,
                    float(printed),
                    within=tolerance(mesh, quantity, printed),
                    relative=False,
                    why=WHY,
                    source=source,
                    basis=basis,
                )
    for quantity, prints in mesh.unmet.items():
        rows += [_row(quantity, p, found[quantity][n], "no") for n, p in enumerate(prints)]
    page.section(mesh.name)
    page.table("All that is printed: ours beside it, within rounding or not", rows)
    if mesh.unmet:
        page.text(f"Not met: {', '.join(mesh.unmet)}. {mesh.reason[0].upper()}{mesh.reason[1:]}.")
    return len(rows), met


def _row(quantity: str, printed: str, ours: float, within: str) -> Record:
    shown = f"{ours:.{len(printed.partition('.')[2]) + 1}f}"
    return {"quantity": quantity, "printed": printed, "ours": shown, "within rounding": within}
