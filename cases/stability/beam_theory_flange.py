"""Beam theory on a shaft that is held by the rim of its flange: how thick a flange it needs."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.optimize import brentq

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import end_flexibilities as shafts
from fe_drivetrain.cases.stability.clamped_plates import boss_rotation
from fe_drivetrain.common import Floats
from fe_drivetrain.common.arrays import rounded
from fe_drivetrain.comparison import min_safe
from fe_drivetrain.elasticity.interfaces import fixed, rigid_face, rigid_point
from fe_drivetrain.elasticity.mesh import generate
from fe_drivetrain.elasticity.revolution import seat_stiffness
from fe_drivetrain.elasticity.solve import recovery_estimate, solve_solid
from fe_drivetrain.geometry import Flange, MeshSizes, Section, Shaft
from fe_drivetrain.report import dashed, map_traces
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Run

#: Flange over shaft diameter.
RATIOS = (1.4, 1.7, 2.0, 2.5, 3.0)
QUICK_RATIOS = (1.4, 2.0, 3.0)

#: Length of the shaft over its diameter.
LENGTH = 3.0

#: Ratio that the curves, limits and solids are of.
SHOWN = 2.0

#: Thickness over shaft diameter where the root's yield is measured, on the ratio shown.
MEASURED = 0.1

#: Thickest flange, over the shaft's diameter, that a plate represents.
PLATE = 0.4

#: Error of the beam that the answer allows [%].
ALLOWED = 10.0

WITH_PLATE = (
    "rotation by a moment, beam and yielding plate in series: worst error of all flanges up to "
    f"{PLATE:g} d thick"
)
CURVES = (
    f"Error of the rotation by a moment over the flange's thickness, flange of {SHOWN:g} d, shaft "
    f"of L = {LENGTH:g} d; shaded: the beam alone within {ALLOWED:g} %"
)


@dataclass(frozen=True)
class Map:
    """Rotations by a moment over flange diameter and thickness.

    Attributes
    ----------
    thick, ratios : (n,) and (m,) array
        Over the shaft's diameter.
    exact, beam, plate : (m, n) array
        Of the elements, of the beam, and what a plate in series adds [rad/(N m)].
    """

    thick: Floats
    ratios: Floats
    exact: Floats
    beam: Floats
    plate: Floats

    @property
    def error(self) -> Floats:
        """Error of the beam [%]."""
        return np.asarray(100 * (self.beam / self.exact - 1))

    @property
    def with_plate(self) -> Floats:
        """Error of beam and plate [%]."""
        return np.asarray(100 * ((self.beam + self.plate) / self.exact - 1))

    @property
    def thin(self) -> Floats:
        """(m, k) errors of beam and plate, of flanges that are plates [%]."""
        return np.asarray(self.with_plate[:, self.thick <= PLATE])


def flanged(thickness: float, ratio: float) -> Shaft:
    """A shaft of 1 m diameter."""
    return Shaft(
        front=0.0,
        flange=Flange(outer_diameter=ratio, thickness=thickness),
        sections=(Section(length=LENGTH, outer_diameter=1.0),),
    )


def by_elements(thickness: float, ratio: float, finer: bool = False) -> float:
    """Rotation of the rear by a moment, the rim held."""
    shaft = flanged(thickness, ratio)
    # what is bent at the root is as small as the flange is thick
    size = 0.12 if thickness < 0.05 else 0.25
    settings: dict[str, Any] = (
        {"size": 0.7 * size, "order": 7, "layers": 4} if finer else {"size": size, "layers": 3}
    )
    K = seat_stiffness(
        shaft, shafts.STEEL, [(0.0, thickness), (shaft.rear, shaft.rear)], **settings
    )
    return float(np.linalg.inv(K[6:, 6:])[4, 4])


def by_beam(thickness: float, ratio: float) -> float:
    """The same of a beam that is clamped at the middle of the flange."""
    half = shafts.stepped((thickness / 2, LENGTH), (ratio, 1.0))
    return float(shafts.by_beam(half)[shafts.ROTATION, shafts.ROTATION])


def by_plate(thickness: float, ratio: float, inset: float) -> float:
    """Rotation of the plate that reaches some of its thickness into the shaft."""
    return boss_rotation(ratio / 2, 0.5 - inset * thickness, thickness, shafts.STEEL)


def inset_of(thickness: float, ratio: float, exact: float) -> float:
    """How far the plate reaches into the shaft, over its thickness, for the exact rotation."""
    more = exact - by_beam(thickness, ratio)
    return float(brentq(lambda k: by_plate(thickness, ratio, k) - more, 0.0, 2.0))


@case(
    "Beam theory against elasticity: a shaft held by the rim of its flange",
    source="Timoshenko and Woinowsky-Krieger 1959, Theory of Plates and Shells, article 63",
)
def run(run: Run, page: Page) -> None:
    """Map the error over thickness and diameter; add the flange as a plate; check both."""
    thick = np.geomspace(0.02, 1.0, 4 if run.quick else 9)
    ratios = np.array(QUICK_RATIOS if run.quick else RATIOS)
    with run.step("meridians"):
        inset = inset_of(MEASURED, SHOWN, by_elements(MEASURED, SHOWN))
    exact, beam, plate = np.empty((3, len(ratios), len(thick)))
    for i, ratio in enumerate(ratios):
        with run.step("meridians"):
            exact[i] = [by_elements(t, ratio) for t in thick]
        beam[i] = [by_beam(t, ratio) for t in thick]
        plate[i] = [by_plate(t, ratio, inset if t <= PLATE else 0.0) for t in thick]
    found = Map(thick, ratios, exact, beam, plate)
    shown = int(np.argmin(np.abs(ratios - SHOWN)))
    with run.step("meridians, finer"):
        places = ((shown, 0), (shown, len(thick) - 1), (-1, len(thick) // 2))
        worst = max(
            abs(exact[i, j] / by_elements(thick[j], ratios[i], finer=True) - 1)
            for i, j in places[: 1 if run.quick else 3]
        )
    check(page, found, worst)
    if not run.quick:
        check_solid(run, page)
    show(page, found, shown, inset)
    page.image(
        "The shaft with a flange of a tenth of its own diameter", run.sketch(flanged(0.1, SHOWN))
    )
    page.data("thickness_over_diameter", thick)
    page.data("flange_over_diameter", ratios)
    page.data("percent", found.error)
    page.data("with_plate_percent", found.with_plate)


def check(page: Page, found: Map, worst: float) -> None:
    """The law of thin flanges, and the plate in series; worst is the error of the elements."""
    thick, ratios, exact = found.thick, found.ratios, found.exact
    step = np.log(thick[1] / thick[0])
    for i, ratio in enumerate(ratios):
        # what the flange adds, over the thinnest two
        more = exact[i, :2] - found.beam[i, :2]
        yielding = [by_plate(t, ratio, 1.0) / by_plate(t, ratio, 0.0) for t in thick[:2]]
        page.equals(
            f"flange {ratio:g} d: power of the thickness with which its flexibility goes",
            np.log(more[1] / more[0]) / step,
            -3.0,
            within=float(np.log(yielding[1] / yielding[0]) / step),
            relative=False,
            why="the shaft's skin yields to the plate as if that reached on into the shaft, by a "
            "part of its thickness and at most by all: the share of that grows with the thickness "
            "by this power",
            source="Kirchhoff's plate: bending rigidity goes as the cube of the thickness",
            measure="order",
            band=2 * worst * exact[i, 0] / more[1] / step,
        )
    insets = [inset_of(thick[0], ratios[i], exact[i, 0]) for i in (0, -1)]
    width = (ratios[0] - 1) / 2
    reach = by_plate(thick[0], ratios[0], 1.0) - by_plate(thick[0], ratios[0], 0.0)
    page.equals(
        f"how far the plate reaches into the shaft, over its thickness of {thick[0]:g} d: "
        f"flange of {ratios[0]:g} d over one of {ratios[-1]:g} d",
        insets[0] / insets[1],
        1.0,
        within=float(2 * thick[0] / width),
        relative=False,
        why="the thickness is no longer small beside the width of the narrower flange: twice their "
        "ratio",
        source="the yield at the root of a thin plate depends on the plate's own thickness alone",
        measure="identity",
        band=exact[0, 0] * worst / reach / insets[1],
    )
    page.at_most(
        f"{WITH_PLATE} [%]",
        np.abs(found.thin).max(),
        5.0,
        why="5 % is the second line of a map; one constant, from one flange, serves for all",
        source="Fourier harmonics in the meridian",
        measure="rotation",
        band=100 * worst,
    )


def check_solid(run: Run, page: Page) -> None:
    """One point against curved tetrahedra."""
    t = 0.25
    shaft = flanged(t, SHOWN)
    with run.step("solid"):
        mesh = generate(shaft, sizes=MeshSizes(shaft=0.24, elements_per_turn=16))
        n = mesh.points.size
        radius = np.hypot(mesh.points[:, 1], mesh.points[:, 2])
        at_rim = (radius > SHOWN / 2 * (1 - 1e-3)) & (mesh.points[:, 0] < t + 1e-9)
        point = rigid_point("rear", np.array([shaft.rear, 0.0, 0.0]), n, n + 6)
        constraints = [
            fixed("rim", np.flatnonzero(at_rim), n + 6),
            rigid_face("rear", mesh.face_nodes("shaft.rear"), mesh.points, point),
        ]
        F = np.zeros((n + 6, 1))
        F[n + 4] = 1.0
        found = solve_solid(mesh.points, mesh.cells, shafts.STEEL.lame, constraints, F)
        bodies = [(mesh.cells, shafts.STEEL.lame)]
        estimate = recovery_estimate(mesh.points, bodies, found.u[:, 0]).relative
    exact = by_elements(t, SHOWN)
    page.equals(
        f"flange {SHOWN:g} d, t = {t:g} d: rotation by a moment, {n:,} unknowns [rad/(N m)]",
        found.u[n + 4, 0],
        exact,
        within=3 * estimate,
        why=f"three times the estimated error of the solid, {estimate:.1g}",
        source="Fourier harmonics in the meridian",
        measure="rotation",
        band=3 * estimate * exact,
    )


def answer(page: Page, found: Map, shown: int, low: float | None) -> None:
    """State the thinnest flange that a beam represents, `low`, and what it makes of thinner."""
    thick = found.thick
    at_thinnest = 100 + found.error[shown, 0]
    least = {
        f"flange {SHOWN:g} d wide, within {ALLOWED:g} %": low,
        f"flange {SHOWN:g} d wide, within 5 %": min_safe(thick, found.error[shown], 5.0),
        f"flange {found.ratios[-1]:g} d wide, within {ALLOWED:g} %": min_safe(
            thick, found.error[-1], ALLOWED
        ),
    }
    page.answer(
        "How thick must a flange that is held at its rim be for beam theory to apply?",
        (
            f"Beam theory is within {ALLOWED:g}\u00a0% for flanges at least {formatted(low, 2)} "
            if low is not None
            else f"Beam theory is within {ALLOWED:g}\u00a0% for no flange up to {thick[-1]:g} "
        )
        + f"shaft diameters thick; for one of {thick[0]:g} diameters it gives "
        f"{formatted(at_thinnest, 2)}\u00a0% of the true rotation.",
        [
            *(
                page.value(f"least thickness, {name} [d]", rounded([value], 2)[0])
                for name, value in least.items()
                if value is not None
            ),
            page.value(
                f"rotation by the beam over the true one, flange {thick[0]:g} d thick [%]",
                rounded([at_thinnest], 2)[0],
                beside=100.0,
                by="elements",
            ),
            page.judged(
                WITH_PLATE, f"worst error with a plate for the flange, up to {PLATE:g} d thick"
            ),
        ],
        hero=CURVES,
        cautions=[
            f"This is a flange {SHOWN:g} shaft diameters (d) wide; a wider one must be thicker.",
            "The rim is held all round, as by bolts close to it; flanges held elsewhere are not "
            "covered.",
        ],
    )


def show(page: Page, found: Map, shown: int, inset: float) -> None:
    """Answer, charts, table and limit."""
    thick, error = found.thick, found.error
    low = min_safe(thick, error[shown], ALLOWED)
    worst = np.abs(found.thin).max()
    answer(page, found, shown, low)
    page.say(
        f"For a beam the flange is a short thick shaft, whose sections stay flat. As a plate in "
        f"series that reaches {inset:.2f} of its thickness into the shaft it is within "
        f"{worst:.2g} % for all flanges up to {PLATE:g} d thick.",
    )
    page.limit(
        "beam of sections, flange held by its rim",
        f"flange thickness over shaft diameter, flange {SHOWN:g} d, shaft {LENGTH:g} d long",
        low=low,
        criterion=f"rotation by a moment within {ALLOWED:g} %",
        beyond=f"too stiff, by {-error[shown, 0]:.0f} % of the rotation at {thick[0]:g} d: a "
        "beam's section stays flat, a plate bends",
        program="none; axisymmetric.seat_stiffness has it in tens of milliseconds",
        remedy=f"a plate in series, reaching {inset:.2f} of its thickness into the shaft: within "
        f"{worst:.2g} % up to {PLATE:g} d",
    )
    page.section("How ends are held")
    page.text(
        "The flange's rim does not move, as with bolts close to it; its faces are free. The "
        "shaft's other end is rigid, whose share is below 1 %. The beam is clamped at the flange's "
        "middle. The remedy adds the rotation of a thin plate, clamped at the rim and to a rigid "
        "boss: the harmonic solution f = c1 r + c2 r^3 + c3 / r + M r ln r / (4 pi D) of "
        "Kirchhoff's plate. The boss is smaller than the shaft, whose skin yields: by "
        f"{inset:.3f} of the flange's thickness at each side, measured on a flange of {SHOWN:g} d, "
        f"{MEASURED:g} d thick."
    )
    show_errors(page, found, shown, low)


def show_errors(page: Page, found: Map, shown: int, low: float | None) -> None:
    """Show the beam's errors; the beam alone is safe from the thickness `low` on."""
    thick, error, thin = found.thick, found.error, found.thick <= PLATE
    page.section("Results")
    with_plate = np.abs(found.with_plate[shown, thin])
    curves = [
        dashed("beam", thick, np.abs(error[shown])),
        dashed("beam and yielding plate", thick[thin], with_plate, "dash"),
    ]
    x, y = "flange thickness over shaft diameter", "error without its sign [%]"
    page.chart(CURVES, curves, x, y, "xy", (low, None))
    page.chart(
        "Beam alone: lines of 1, 5 and 10 % error (too stiff)",
        map_traces(thick, found.ratios, error, 0.0),
        "flange thickness over shaft diameter",
        "flange over shaft diameter",
        "x",
    )
    page.table(
        "Least thickness over shaft diameter for errors of the beam within 5 % and 10 %, where an "
        f"empty cell is beyond {thick[-1]:g}; and the worst error with the plate, up to a "
        f"thickness of {PLATE:g} d",
        [
            {
                "flange over d": ratio,
                "beam: 5 %": min_safe(thick, error[i], 5.0),
                "beam: 10 %": min_safe(thick, error[i], 10.0),
                "beam and yielding plate [%]": np.abs(found.thin[i]).max(),
            }
            for i, ratio in enumerate(found.ratios)
        ],
    )
