"""Slices of a gear mesh where few of them carry, where gears jam, and on soft supports."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.rated_gears import rated_meshes
from fe_drivetrain.common import Floats
from fe_drivetrain.common.arrays import rounded
from fe_drivetrain.comparison import decades, safe_range
from fe_drivetrain.gear import (
    SLICES,
    Loaded,
    Modifications,
    SlicedMesh,
    constant_law,
    face_factor,
    loaded,
    supported,
)
from fe_drivetrain.report import gear_pair
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run

PAIR = rated_meshes()["NREL 5 MW, stage 1, sun and planet"].pair
C = 14e9  # N/m^2
LINE = 1e6  # N/m
TORQUE = LINE * PAIR.face_width * PAIR.first.base_radius
PHASE = 0.5
FREE, PLAY = 2.0, 0.3e-3  # m: backlash that no misalignment here uses up, and a real one
TWO_PERCENT = 0.02
RATIO = "misalignment times stiffness over the mean line load"
ERRORS = (
    "Error of the face load factor over the misalignment, against the closed form; shaded: "
    f"{SLICES} slices within 2 %"
)
SOURCE = "ISO 6336-1: sqrt(2 F c / w) of a triangle over a part of the face"


def misaligned(ratio: float, slices: int, play: float) -> tuple[Loaded, float]:
    """Spur gears with a linear gap of a ratio: found, and K_Hbeta in closed form."""
    one = SlicedMesh(PAIR, constant_law(C), slices=slices, backlash=play)
    still = loaded(one, PHASE, TORQUE).contacts
    pairs = len(set(still.tooth[still.driving].tolist()))
    gap = ratio * LINE / (pairs * C)
    mesh = SlicedMesh(PAIR, one.stiffness, Modifications(slope=gap), slices, play)
    return loaded(mesh, PHASE, TORQUE), face_factor(gap, pairs * C, LINE)


@case(
    "Slices of a gear mesh: extreme misalignment, jamming, soft supports",
    source="ISO 6336-1, face load factor of a linear misalignment; springs that press alone",
)
def run(run: Run, page: Page) -> None:
    """Sweep the misalignment until one slice carries all, and the stiffness of the supports."""
    ratios = decades(-1, 4, 4 if run.quick else 8)
    with run.step("misalignment"):
        ends = few_slices(page, ratios)
    with run.step("jamming"):
        jam = jamming(page, ratios)
    with run.step("supports"):
        softest = soft_supports(page, 1 if run.quick else 2)
    answer(page, ends, jam, softest)
    page.say(
        "At that misalignment a slice and a half carry all; the limit grows with the square of "
        "the number of slices.",
    )
    page.image("Sun and planet of stage 1", run.sketch(*gear_pair(PAIR)))


def answer(page: Page, ends: dict[int, float], jam: float, softest: float) -> None:
    """State the misalignments up to which slices have the load, and what ends equilibrium."""
    page.answer(
        "How many slices over the face width does a misaligned gear mesh need?",
        f"{SLICES} slices give the face load factor within 2\u00a0% for misalignments up to "
        f"{formatted(rounded([ends[SLICES]], 2)[0])} mean tooth deflections; {min(ends)} slices "
        f"only up to {formatted(rounded([ends[min(ends)]], 2)[0])}.",
        [
            *(
                page.value(
                    f"largest misalignment over mean tooth deflection, {slices} slices",
                    rounded([end], 2)[0],
                )
                for slices, end in sorted(ends.items(), key=lambda one: one[0] != SLICES)
            ),
            page.value("misalignment over mean tooth deflection from which both flanks touch", jam),
            page.value("softest supports for which an equilibrium is found [N/m]", softest),
        ],
        hero=ERRORS,
        cautions=[
            f"With {1e3 * PLAY:g}\u00a0mm backlash both flanks touch from a misalignment of "
            f"{formatted(jam, 2)} mean tooth deflections on.",
            "On softer supports gears turn by more than a radian before the supports carry: the "
            "program says that it has not converged.",
        ],
    )


def few_slices(page: Page, ratios: Floats) -> dict[int, float]:
    """Error of K_Hbeta against the closed form; where it leaves 2 %, by number of slices."""
    rows: list[Record] = []
    ends: dict[int, float] = {}
    for slices in (5, 10, SLICES, 140):
        error = []
        for ratio in ratios:
            found, exact = misaligned(float(ratio), slices, FREE)
            error.append(abs(found.face_factor / exact - 1.0))
            rows.append(
                {
                    "slices": slices,
                    RATIO: float(ratio),
                    "K_Hbeta": found.face_factor,
                    "closed form": exact,
                    "error": max(error[-1], 1e-16),
                    "share of the face that carries": found.loaded_share,
                }
            )
        high = safe_range(ratios, np.array(error), TWO_PERCENT)[1]
        ends[slices] = float(ratios[-1]) if high is None else high
    low, high = safe_range(
        ratios, np.array([r["error"] for r in rows if r["slices"] == SLICES], float), TWO_PERCENT
    )
    page.between(
        "limit with 140 slices over that with 35",
        ends[140] / ends[SLICES],
        16.0 / 2.4,
        16.0 * 2.4,
        why="the number of slices squared, 16, to three steps of the sweep",
        source="a triangle as wide as one slice and a half: F c / w = 0.9 n^2",
    )
    page.limit(
        f"load over the face width by {SLICES} slices",
        RATIO,
        low=low,
        high=high,
        criterion="error of the face load factor below 2 %",
        beyond="less than two slices carry: the load is that of a slice, n times the mean at most",
        program="SlicedMesh takes any number of slices",
        remedy="more slices: the limit grows with their square",
    )
    page.section("Few slices carry")
    page.sweep(
        ERRORS,
        rows,
        RATIO,
        "error",
        by="slices",
        log="xy",
        safe=(low, high),
        table=False,
    )
    return ends


def jamming(page: Page, ratios: Floats) -> float:
    """Where a misalignment uses up the play, so that the other flank touches at the other end."""
    rows: list[Record] = []
    first = float(ratios[-1])
    for ratio in ratios:
        found, exact = misaligned(float(ratio), SLICES, PLAY)
        back = float(found.forces[~found.contacts.driving].sum())
        if back > 0.0:
            first = min(first, float(ratio))
        rows.append(
            {
                RATIO: float(ratio),
                "K_Hbeta": found.face_factor,
                "closed form, one flank": exact,
                "force of the other flank over the driving one": back
                / float(found.forces[found.contacts.driving].sum()),
            }
        )
    page.holds(
        "equilibrium is exact at every misalignment, jammed or not",
        all(misaligned(float(r), SLICES, PLAY)[0].converged for r in ratios),
        why="load over approach is made of straight lines, whose corners are known",
        source="springs that press alone",
    )
    page.section("Both flanks")
    page.sweep(
        f"Play of {1e3 * PLAY:.1f} mm",
        rows,
        RATIO,
        {"K_Hbeta": "slices, both flanks", "closed form, one flank": "closed form, one flank"},
        log="xy",
        axis="face load factor",
    )
    return first


def soft_supports(page: Page, a_decade: float) -> float:
    """Equilibrium on springs from soft to stiff: residual that is left, and what is flagged."""
    mesh = SlicedMesh(PAIR, constant_law(C), Modifications(slope=100e-6), SLICES, PLAY)
    load = np.zeros(12)
    load[3] = TORQUE
    shape = np.array([1.0] * 3 + [0.0, 0.01, 0.01] + [1.0] * 6)
    rows: list[Record] = []
    for stiffness in decades(0, 18, a_decade):
        found, q = supported(mesh, PHASE, load, np.diag(shape * stiffness))
        left = load + found.wrench - shape * stiffness * q
        rows.append(
            {
                "stiffness of the supports [N/m]": float(stiffness),
                "residual over the torque": max(float(np.abs(left).max()) / TORQUE, 1e-17),
                "converged": "yes" if found.converged else "no",
                "K_Hbeta": found.face_factor,
            }
        )
    good = [r for r in rows if r["converged"] == "yes"]
    fixed = loaded(mesh, PHASE, TORQUE).face_factor
    page.equals(
        "face load factor on stiff supports against fixed gears",
        float(rows[-1]["K_Hbeta"]),
        fixed,
        within=1e-6,
        why="supports of 1e18 N/m yield nothing; round-off of 1e18 over 1e10",
        source="the same gears, held",
    )
    page.holds(
        "what is called converged is in balance to 1e-8 of the torque",
        all(float(r["residual over the torque"]) < 1e-8 for r in good),
        why="a residual would be a torque from nowhere",
        source="equilibrium",
    )
    softest = float(good[0]["stiffness of the supports [N/m]"])
    page.limit(
        "equilibrium of gears on supports, Newton",
        "stiffness of the supports [N/m]",
        low=softest,
        high=None,
        criterion="residual below 1e-9 of the load",
        beyond="gears turn by more than a radian before the supports carry, and round-off of these "
        "motions is more than the flanks' deflection",
        program="says that it has not converged",
        remedy="hold gears by bearings of real stiffness",
    )
    page.section("Supports")
    page.sweep(
        "Residual of the equilibrium",
        rows,
        "stiffness of the supports [N/m]",
        "residual over the torque",
        log="xy",
    )
    return softest
