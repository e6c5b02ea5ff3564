"""Compliances of seats side by side, checks of them, and a housing as it deforms."""

from collections.abc import Mapping

import numpy as np

from fe_drivetrain.common import Floats
from fe_drivetrain.report import NoPictureError, picture_of_deformation
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.shafts.response import Model, Response

MOTIONS = ("along x", "along y", "along z", "about x", "about y", "about z")


def compliance_rows(heading: str, found: Mapping[str, Floats]) -> list[Record]:
    """Rows of a table: compliances (6,) of each [mm/MN, mrad/MN m], by motion."""
    return [
        {heading: name} | dict(zip(MOTIONS, (c * 1e9).tolist(), strict=True))
        for name, c in found.items()
    ]


def check_compliance(
    page: Page, what: str, k: int, found: Floats, exact: Floats, *, within: float, **reasons: str
) -> None:
    """One of six compliances (6,) against a reference; `reasons` are why and source."""
    unit = "mm/MN" if k < 3 else "mrad/MN m"
    page.equals(
        f"{what}: compliance {MOTIONS[k]} [{unit}]",
        float(found[k]) * 1e9,
        float(exact[k]) * 1e9,
        within=within,
        why=reasons["why"],
        source=reasons["source"],
    )


def picture_under_hub_load(run: Run, page: Page, model: Model, response: Response) -> None:
    """The model under 1 N down at the hub, exaggerated; a note where nothing can be drawn."""
    down, file = -np.eye(len(model.loads))[model.loads.index("hub.Fz")], run.folder / "deformed.png"
    try:
        factor, drawn = picture_of_deformation(model, response, down, file, "1 N down")
        drawn.wait()
        page.image(f"1 N down at the hub, displacements times {factor:.3g}", "deformed.png")
    except NoPictureError as error:
        page.note(f"no picture: {error}")
