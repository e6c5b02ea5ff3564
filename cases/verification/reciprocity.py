"""Maxwell-Betti reciprocity: the mutual work of any two unit loads is equal."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification import scenes
from fe_drivetrain.common import Floats
from fe_drivetrain.report import heat_map
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run, Target
from fe_drivetrain.shafts.response import LOADS

AXES = "displacements under", "work of", "power of ten"
ASYMMETRY = "Asymmetry of mutual works, {} bearing, power of ten: |W_ij - W_ji| / sqrt(W_ii W_jj)"
WITHIN = 1e-9
STOPS = "the energy error at which the solver stops"
BETTI = "Maxwell 1864, Betti 1872: W_ij = W_ji"
OF_WORK = "work of unit loads on each other's displacements, largest asymmetry"
MIN_SHARE_OF_WORK = "least eigenvalue of the work matrix, scaled to a diagonal of one"

#: Columns of the table, of which checks are made.
WORK, HUB = "largest asymmetry [-]", "of the hub's compliance [-]"
MINIMUM = "least eigenvalue [-]"


@case(
    "Maxwell-Betti reciprocity of the main bearing's unit loads",
    source="exact: Maxwell 1864, Betti 1872",
)
def run(run: Run, page: Page) -> None:
    """Work of each of ten unit loads on the displacements under each other one, both scenes."""
    page.section("Reciprocity")
    page.text(
        "Loads: six at the hub, uniform accelerations along three axes, and the gearbox's weight. "
        "The work is that of the nodal loads on the nodal displacements, so that the symmetry of "
        "the stiffness matrix does not enter by itself: joint, springs, averaged couplings and "
        "solver all have to be self-adjoint. Each pair is relative to the geometric mean of the "
        "works that the two loads do on their own displacements."
    )
    rows: list[Record] = []
    for kind in scenes.KINDS:
        model, response = scenes.solved(run, kind)
        work = scenes.work(model, response)
        asymmetry = relative_asymmetry(work)
        row: Record = {
            "scene": kind,
            "unknowns": response.diagnostics.n_unknowns,
            "solver": response.diagnostics.method,
            "energy error of the solver [-]": response.diagnostics.energy_error,
            WORK: float(asymmetry.max()),
            HUB: float(relative_asymmetry(response.motions["hub"][:, :6]).max()),
            # with loads scaled to the same work of their own
            MINIMUM: float(np.linalg.eigvalsh(0.5 * (work + work.T) / own_work(work))[0]),
        }
        for value, title, source in (
            (row[WORK], OF_WORK, BETTI),
            (row[HUB], "compliance of the hub, six by six, largest asymmetry", BETTI),
        ):
            target = Target(title, 0.0, WITHIN, STOPS, source)
            page.meets(value, target, response.diagnostics.energy_error, kind)
        page.at_least(
            f"{kind}: {MIN_SHARE_OF_WORK}",
            row[MINIMUM],
            -WITHIN,
            why=STOPS,
            source="strain energy is never negative",
            measure="identity",
            band=response.diagnostics.energy_error,
        )
        title = ASYMMETRY.format(kind)
        powers, down = np.log10(np.maximum(asymmetry, 1e-18)), {"autorange": "reversed"}
        page.add(heat_map(title, LOADS, LOADS, powers, AXES, (-18, -8), yaxis=down))
        rows.append(row)
    page.image(f"The {kind} scene, as meshed here", run.sketch(model.mesh))
    page.table("Both scenes", rows)
    answer(page, rows)


def answer(page: Page, rows: list[Record]) -> None:
    """State how symmetric the works of the unit loads are."""
    worst = {row["scene"]: row[WORK] for row in rows}
    good = max(worst.values()) <= WITHIN
    spherical, bonded = (formatted(worst[kind], 2, "") for kind in ("spherical", "bonded"))
    page.answer(
        "Is the model of the main bearing reciprocal, as Maxwell and Betti demand?",
        f"{'Yes' if good else 'No'}: mutual works of ten unit loads differ by at most {spherical} "
        f"of their size with a spherical bearing, by {bonded} with a bonded one.",
        [
            *(
                page.value(
                    f"largest asymmetry of the works, {row['scene']} bearing",
                    row[WORK],
                    at_most=WITHIN,
                    by="solver",
                )
                for row in rows
            ),
            *(
                page.value(
                    f"largest asymmetry of the hub's compliance, {row['scene']} bearing",
                    row[HUB],
                    at_most=WITHIN,
                    by="solver",
                )
                for row in rows
            ),
        ],
        hero=ASYMMETRY.format("spherical"),
    )


def own_work(work: Floats) -> Floats:
    """(n, n) geometric means of the works that two loads do on their own displacements."""
    own = np.sqrt(work.diagonal())
    return np.outer(own, own)


def relative_asymmetry(work: Floats) -> Floats:
    """(n, n) |W_ij - W_ji| over the geometric mean of W_ii and W_jj."""
    return np.asarray(np.abs(work - work.T) / own_work(work))
