"""Tilt stiffness of a seat by rigid, averaged and sliding coupling: what bounds what, and where."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.cases import case
from fe_drivetrain.cases.stability import seat_couplings as seat
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import GridConvergence, grid_convergence, last_within
from fe_drivetrain.report import marked, trace
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Run

#: Widths of the loaded band [m]; the ring is as long as the last.
WIDTHS = (0.015, 0.03, 0.06, 0.09, 0.12, 0.18, 0.24, 0.3)
QUICK_WIDTHS = (0.015, 0.06, 0.18, 0.3)
#: Largest edges of the elements [m], of the sixth order and of the second.
SIZES = (0.06, 0.03, 0.015)
QUICK_SIZES = (0.12, 0.06, 0.03)
ROUGH_SIZES = (0.15, 0.075, 0.0375, 0.02, 0.01, 0.006)
QUICK_ROUGH_SIZES = (0.15, 0.075, 0.0375, 0.02)
#: Lengths of rings whose whole bore is loaded, over the bore's diameter.
LONG = (0.5, 0.6, 0.7, 0.8, 1.0, 2.0, 4.0)
QUICK_LONG = (0.5, 0.8, 2.0)
STRIP = 0.03  # m, of the band that is compared with a narrow strip
PLAIN_WIDTH = 0.06  # m, of the sweep over meshes
TURN, QUICK_TURN = 12, 8  # hexahedra round the axis

GAP = 0.10  # largest difference of two couplings that still represent one stiffness
MESH_ERROR = 0.01

TILT = "MN m/rad"
REMEDIED = "remedy: {} coupling, elements of sixth order, {:g} mm"
STRIP_TILT = f"failure: sliding band {1e3 * STRIP:g} mm wide, tilt stiffness, extrapolated"
WIDTHS_CHART = (
    "Tilt stiffness over that of the rigid coupling: averaged falls as the band grows, sliding as "
    f"it shrinks; shaded: rigid and averaged within {100 * GAP:g} %"
)
SAME_MESH = "the first harmonic on the same mesh of the meridian"

Tilts = dict[str, seat.Tilted]
"""The band's motions by coupling."""


@dataclass(frozen=True)
class Found:
    """All solutions.

    Attributes
    ----------
    widths, sizes, rough, long : tuple of float
        Parameters of the four sweeps.
    swept, coarser : list of Tilts
        Over the width, on the mesh that is reported and on a coarser one.
    fine, plain : list of Tilts
        Over the size of elements of the sixth and of the second order.
    strip : list of float
        Stiffness of the narrow sliding band over the size [N m/rad].
    whole : list of Tilts
        Over the length of a ring whose whole bore is loaded.
    solid, harmonic : Tilts
        By the couplings of the library in hexahedra, and the same mesh by harmonics.
    """

    widths: tuple[float, ...]
    sizes: tuple[float, ...]
    rough: tuple[float, ...]
    long: tuple[float, ...]
    swept: list[Tilts]
    coarser: list[Tilts]
    fine: list[Tilts]
    plain: list[Tilts]
    strip: list[float]
    whole: list[Tilts]
    solid: Tilts
    harmonic: Tilts

    @property
    def everywhere(self) -> list[Tilts]:
        """Values of all widths and meshes."""
        return [*self.swept, *self.coarser, *self.fine, *self.plain]

    @property
    def sliding_by_mean(self) -> list[float]:
        """Moment over mean rotation of whole sliding seats, over the rigid coupling's stiffness."""
        return [by_mean(f["sliding"]) / f["rigid"].stiffness for f in self.whole]


def solve(run: Run) -> Found:
    """Sweep the width of the band, the mesh and the length of the ring."""
    widths = QUICK_WIDTHS if run.quick else WIDTHS
    rough = QUICK_ROUGH_SIZES if run.quick else ROUGH_SIZES
    sizes = QUICK_SIZES if run.quick else SIZES
    long = QUICK_LONG if run.quick else LONG
    with run.step("widths"):
        swept = [seat.tilted(width, sizes[1]) for width in widths]
        coarser = [seat.tilted(width, sizes[0]) for width in widths]
    with run.step("meshes"):
        fine = [seat.tilted(PLAIN_WIDTH, size) for size in sizes]
        strip = [seat.tilted(STRIP, size)["sliding"].stiffness for size in sizes]
        plain = [seat.tilted(PLAIN_WIDTH, size, 2) for size in rough]
    with run.step("lengths"):
        lengths = [2.0 * seat.BORE * ratio for ratio in long]
        whole = [seat.tilted(length, 0.1, length=length) for length in lengths]
    with run.step("couplings of the library"):
        solid = seat.tilted_solid(PLAIN_WIDTH, 0.06, turn_of(run))
        harmonic = seat.tilted(PLAIN_WIDTH, 0.06, 2)
    return Found(
        widths, sizes, rough, long, swept, coarser, fine, plain, strip, whole, solid, harmonic
    )


def turn_of(run: Run) -> int:
    """Hexahedra round the axis."""
    return QUICK_TURN if run.quick else TURN


def by_mean(tilt: seat.Tilted) -> float:
    """Moment over mean rotation [N m/rad]."""
    return tilt.moment / tilt.mean


def stiffness(found: Sequence[Tilts], coupling: str) -> Floats:
    """Tilt stiffness of a sweep [N m/rad]."""
    return np.array([f[coupling].stiffness for f in found])


def over_rigid(found: Sequence[Tilts], coupling: str) -> Floats:
    """Tilt stiffness of a sweep, over that of the rigid coupling."""
    return stiffness(found, coupling) / stiffness(found, "rigid")


def extrapolated(sizes: Sequence[float], values: ArrayLike) -> GridConvergence:
    """Limit of ever finer meshes of a rigid band, whose edges are singular."""
    return grid_convergence(sizes, values, expected_order=1.0, min_order=0.5)


@case(
    "Rigid, averaged and sliding coupling of a seat: bounds of its tilt stiffness",
    source="least energy under ever fewer constraints; the smooth rigid strip on a half plane "
    "(Johnson 1985, Contact Mechanics, section 2.8)",
)
def run(run: Run, page: Page) -> None:
    """Sweep the width of the band, then the mesh."""
    found = solve(run)
    limits = {c: extrapolated(found.sizes, stiffness(found.fine, c)) for c in seat.COUPLINGS}
    check_bounds(page, found)
    check_strip(page, found)
    check_library(page, found, turn_of(run))
    for c in ("rigid", "averaged"):
        page.equals(
            REMEDIED.format(c, 1e3 * found.sizes[-1]),
            found.fine[-1][c].stiffness / 1e6,
            limits[c].extrapolated / 1e6,
            within=MESH_ERROR * (2.0 if run.quick else 1.0),
            unit=TILT,
            why="the criterion of the sweep over meshes"
            + ("; twice that on elements twice as large" if run.quick else ""),
            source=limits[c].sentence("N m/rad"),
            measure="stiffness",
            band=limits[c].uncertainty / 1e6,
        )
    show_widths(page, found)
    show_lengths(page, found)
    show_meshes(page, found, limits)
    page.image("The ring whose bore is held in a band", run.sketch(seat.ring_of(0.1)))


def check_bounds(page: Page, found: Found) -> None:
    """Inequalities of least energy, which each mesh fulfils."""
    for c, source in (
        (
            "averaged",
            "fields that fulfil the rigid coupling fulfil the averaged one: least energy of fewer "
            "fields is more",
        ),
        (
            "sliding",
            "fields that fulfil the rigid coupling fulfil the sliding one: it is held in fewer "
            "ways",
        ),
    ):
        # Stress is singular at the edges of a rigid band: errors fall with the size at worst by h.
        # Where the order is one, as much is left as two meshes differ by; it is doubled for safety.
        band = 2.0 * np.abs(stiffness(found.swept, c) - stiffness(found.coarser, c))
        page.between(
            f"{c} coupling over rigid one, largest of all widths and meshes",
            over_rigid(found.everywhere, c).max(),
            0.0,
            1.0,
            why="between 0 and 1 on every mesh, since the inequality holds for the discrete fields "
            "as well",
            source=source,
            measure="stiffness",
            band=(band / stiffness(found.swept, "rigid")).max(),
        )
    page.at_least(
        "energy of the sliding field over that of the averaged one of equal mean rotation: least "
        "of all widths",
        min(f["sliding"].of_mean / f["averaged"].stiffness for f in (*found.swept, *found.fine)),
        1.0,
        why="an inequality that each mesh fulfils",
        source="of all fields of one mean rotation the averaged coupling has the least energy",
        measure="identity",
    )


def check_strip(page: Page, found: Found) -> None:
    """A narrow sliding band against the theory of contact."""
    share = STRIP / (seat.OUTSIDE - seat.BORE)
    narrow = extrapolated(found.sizes, found.strip)
    page.equals(
        STRIP_TILT,
        narrow.extrapolated / 1e6,
        seat.smooth_strip(STRIP) / 1e6,
        within=share,
        unit=TILT,
        why="the ring is no half plane: of the order of the band's width over the wall's, "
        f"{share:.2g}",
        source="smooth rigid strip on a half plane, pi E w^2 / (16 (1 - nu^2)) a length; round the "
        "bore its cosine gives pi a times that",
        measure="stiffness",
        band=narrow.extrapolated_uncertainty / 1e6,
    )


def check_library(page: Page, found: Found, turn: int) -> None:
    """The library's couplings in hexahedra."""
    allowed = (np.pi / turn) ** 4
    for c in seat.COUPLINGS:
        page.equals(
            f"couplings of the library, {c}: tilt stiffness in hexahedra, {turn} round",
            found.solid[c].stiffness / 1e6,
            found.harmonic[c].stiffness / 1e6,
            within=allowed,
            unit=TILT,
            why="quadratic elements round the turn: the fourth power of half their angle, "
            f"{allowed:.1e}",
            source=SAME_MESH,
            measure="stiffness",
        )
    page.equals(
        f"failure: sliding band {1e3 * PLAIN_WIDTH:g} mm wide by its mean rotation, which points "
        f"against the moment, averaged point in hexahedra, {turn} round",
        by_mean(found.solid["sliding"]) / 1e6,
        by_mean(found.harmonic["sliding"]) / 1e6,
        within=allowed,
        unit=TILT,
        why="quadratic elements round the turn, as above; weights of nodes integrate a cubic "
        "exactly",
        source=f"{SAME_MESH}, its mean an integral",
        measure="stiffness",
    )


def show_widths(page: Page, found: Found) -> None:
    """The width of the band: answer, limits, chart, table."""
    widths = found.widths
    averaged, sliding = (over_rigid(found.swept, c) for c in ("averaged", "sliding"))
    gap = 1.0 - averaged
    narrow = last_within(widths, gap, GAP)
    wrong_sign = sum(by_mean(f["sliding"]) < 0 for f in found.swept)
    share = f"{100 * sliding[0]:.2g} to {100 * sliding[-1]:.2g} %"
    answer(page, found, narrow)
    page.say(
        f"The averaged one is no lower bound for a seat without friction: that has {share} of the "
        f"rigid stiffness, and at {wrong_sign} of {len(widths)} widths its mean rotation points "
        "against the moment.",
    )
    limit_widths(page, found, narrow, share)
    show_tilt(page, found, narrow)


def answer(page: Page, found: Found, narrow: float | None) -> None:
    """State up to which width both couplings give one stiffness, and what slides."""
    averaged, sliding = (over_rigid(found.swept, c) for c in ("averaged", "sliding"))
    apart, band = 100.0 * (1.0 - averaged[-1]), 1e3 * PLAIN_WIDTH
    page.answer(
        "Is the tilt stiffness of a bearing seat between those of rigid and averaged couplings?",
        "Yes, if it is bonded: both couplings are "
        + (
            f"less than {100 * GAP:g}\u00a0% apart on a band up to {formatted(1e3 * narrow)}"
            "\u00a0mm wide, "
            if narrow is not None
            else f"always over {100 * GAP:g}\u00a0% apart, "
        )
        + f"and {apart:.0f}\u00a0% on the whole bore.",
        [
            page.judged(
                REMEDIED.format("rigid", 1e3 * found.sizes[-1]), f"rigid coupling, {band:g} mm band"
            ),
            page.judged(
                REMEDIED.format("averaged", 1e3 * found.sizes[-1]),
                f"averaged coupling, {band:g} mm band",
            ),
            page.value("averaged below rigid coupling, whole bore [%]", round(apart)),
            page.judged(STRIP_TILT, f"frictionless seat, {1e3 * STRIP:g} mm band", "smooth strip"),
            page.value(
                "frictionless seat over rigid coupling, whole bore [%]", 100.0 * sliding[-1]
            ),
        ],
        hero=WIDTHS_CHART,
        cautions=[
            "A frictionless seat is "
            + ("softer" if (sliding < averaged).all() else "not always softer")
            + " than both: take its stiffness as moment squared over twice the energy, since its "
            "mean rotation may even point against the moment.",
            "The mesh must be converged: on coarse second-order elements even the averaged "
            "coupling is too stiff.",
        ],
    )


def limit_widths(page: Page, found: Found, narrow: float | None, share: str) -> None:
    """State the widths with one stiffness, and those that the averaged coupling bounds."""
    averaged, sliding = (over_rigid(found.swept, c) for c in ("averaged", "sliding"))
    bounding = min(np.array(found.widths)[sliding >= averaged], default=None)
    page.limit(
        "rigid and averaged coupling of a seat as one stiffness",
        "width of the loaded band [m], ring 0.3 m long, 0.6 m bore",
        high=narrow,
        criterion=f"rigid and averaged tilt stiffness within {100 * GAP:g} %",
        beyond=f"apart by up to {100 * (1.0 - averaged).max():.2g} % of the rigid one: the "
        "stiffness is a property of the coupling",
        program="couples hub and gearbox as the scene states, and takes K_R of the bonded bearing "
        "from the whole assembly",
        remedy="both, as a bracket; or the neighbouring part modelled and bonded",
    )
    page.limit(
        "averaged coupling as a lower bound of a frictionless seat",
        "width of the loaded band [m]",
        low=bounding,
        criterion="sliding coupling no softer than the averaged one",
        beyond=("at every width of the sweep: " if bounding is None else "")
        + f"the sliding seat has {share} of the rigid stiffness, and its mean rotation points "
        "against the moment",
        program="gives no K_R of a seat that slides: its spherical joint carries no moment",
        remedy="M^2 / 2U of the sliding coupling",
    )


def show_tilt(page: Page, found: Found, narrow: float | None) -> None:
    """Show the tilt stiffness over the width of the band."""
    widths, rigid = found.widths, stiffness(found.swept, "rigid")
    averaged, sliding = (over_rigid(found.swept, c) for c in ("averaged", "sliding"))
    percent = [100.0 * w / seat.LENGTH for w in widths]
    theory = [seat.smooth_strip(w) for w in widths] / rigid
    page.section("Width of the band")
    page.chart(
        WIDTHS_CHART,
        [
            marked("averaged", percent, np.abs(averaged)),
            marked("sliding", percent, np.abs(sliding)),
            trace("smooth strip (theory)", percent, theory, line={"dash": "dot"}),
        ],
        "width of the loaded band, of the ring's length [%]",
        "over rigid",
        "xy",
        None if narrow is None else (None, 100.0 * narrow / seat.LENGTH),
    )
    rows = [
        {"width [mm]": 1e3 * w}
        | {c: f[c].stiffness / 1e6 for c in seat.COUPLINGS}
        | {
            "rigid over averaged, less one [%]": 100.0 * (1.0 / averaged[k] - 1.0),
            "sliding, by its mean rotation": by_mean(f["sliding"]) / 1e6,
        }
        for k, (w, f) in enumerate(zip(widths, found.swept, strict=True))
    ]
    caption = "Tilt stiffness [MN m/rad]; the last column by the mean rotation"
    page.table(caption, rows)
    page.text(
        "Stiffness is M^2 / 2U, the moment over the rotation that it does work on. Any traction of "
        "that moment stores at least as much energy as the rigid coupling's, so this stiffness "
        "never exceeds the rigid one. The averaged coupling bounds 2U / theta^2 with the mean "
        "rotation theta from below, and not M^2 / 2U: a load that the mean hardly sees, such as "
        "normal pressure on a narrow band, can be far softer."
    )
    page.data("widths", widths)
    page.data("stiffness", {c: stiffness(found.swept, c) for c in seat.COUPLINGS})
    page.data(caption, rows)


def show_lengths(page: Page, found: Found) -> None:
    """The length of a seat without friction: limit and chart."""
    right = [ratio for ratio, k in zip(found.long, found.sliding_by_mean, strict=True) if k > 0]
    longest = found.whole[-1]["sliding"]
    page.limit(
        "mean rotation of a seat that slides, as its tilt",
        "length of the loaded bore over its diameter",
        low=min(right, default=None),
        criterion="the mean rotation points with the moment",
        beyond="it points against the moment: its axial displacement counts for more than its "
        f"tilt; even then too stiff, by {by_mean(longest) / longest.stiffness:.2g} times at the "
        "longest",
        program="takes K_R only of bonded seats",
        remedy="M^2 / 2U",
    )
    curves: dict[str, ArrayLike] = {
        "averaged": over_rigid(found.whole, "averaged"),
        "sliding, by energy (remedy)": over_rigid(found.whole, "sliding"),
        "sliding, by its mean rotation": found.sliding_by_mean,
    }
    page.section("Length of a seat without friction")
    page.chart(
        "Whole bore loaded, over the rigid coupling's tilt stiffness: by its mean rotation a short "
        "sliding seat is stiffer than a rigid one, and where it is shorter still the mean points "
        "against the moment. Shaded where it points with it",
        [marked(name, found.long, of) for name, of in curves.items()],
        "length of the ring over the diameter of its bore",
        "over rigid",
        "x",
        (min(right), None) if right else None,
    )


def show_meshes(page: Page, found: Found, limits: Mapping[str, GridConvergence]) -> None:
    """Elements of the second order: answer, limits, chart."""
    exact = {c: limits[c].extrapolated for c in seat.COUPLINGS}
    errors = {c: np.abs(stiffness(found.plain, c) / exact[c] - 1.0) for c in seat.COUPLINGS}
    coarsest = {
        c: max(np.array(found.rough)[e <= MESH_ERROR], default=None) for c, e in errors.items()
    }
    over = np.array(found.rough)[stiffness(found.plain, "averaged") > exact["rigid"]]
    if len(over):
        page.say(
            f"On elements of second order of {over[-1]:g} m and more even the averaged coupling is "
            "stiffer than the rigid one really is: a bracket holds only on a mesh that has "
            "converged."
        )
    for c in ("rigid", "averaged"):
        page.limit(
            f"{c} coupling of a band, elements of second order",
            f"edge of the elements [m], band of {PLAIN_WIDTH:g} m",
            high=coarsest[c],
            criterion=f"error of the stiffness below {100 * MESH_ERROR:g} %",
            beyond=f"too stiff by up to {100 * errors[c].max():.2g} %"
            + (
                f"; still {100 * errors[c].min():.2g} % at {found.rough[-1]:g} m"
                if coarsest[c] is None
                else ""
            ),
            program="nothing: one mesh does not show it; the cases of the main bearing state bands "
            "from three",
            remedy="elements of sixth order on the meridian, or extrapolation of meshes",
        )
    page.section("Mesh")
    page.chart(
        f"Error of the tilt stiffness, band of {1e3 * PLAIN_WIDTH:g} mm, elements of second order: "
        "all are too stiff; shaded where the averaged coupling is within "
        f"{100 * MESH_ERROR:g} %",
        [
            *(marked(c, found.rough, errors[c]) for c in seat.COUPLINGS),
            *(
                trace(
                    f"{c}, sixth order (remedy)",
                    found.sizes,
                    np.abs(stiffness(found.fine, c) / exact[c] - 1.0),
                    mode="lines+markers",
                    line={"dash": "dash"},
                )
                for c in ("rigid", "averaged")
            ),
        ],
        "largest edge of an element [m]",
        "relative error",
        "xy",
        (None, coarsest["averaged"]) if coarsest["averaged"] else None,
    )
    page.data("sizes", found.rough)
    page.data("errors", errors)
