"""Beam theory on a uniform shaft: how short it may be, for each bore."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import end_flexibilities as shafts
from fe_drivetrain.cases.references import rigid_ended_shafts
from fe_drivetrain.cases.references.shaft_theory import Tube, flexure_stress
from fe_drivetrain.cases.references.solid_shafts import straight
from fe_drivetrain.common import Bools, Floats
from fe_drivetrain.common.arrays import rounded
from fe_drivetrain.comparison import min_safe
from fe_drivetrain.elasticity.revolution import (
    along_sides,
    dofs,
    harmonic_response,
    meridian,
    surface_loads,
)
from fe_drivetrain.geometry import LENGTH_TOLERANCE
from fe_drivetrain.report import dashed, map_traces
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Run

#: Bore over outer diameter.
BORES = (0.0, 0.3, 0.5, 0.7, 0.8, 0.9)
QUICK_BORES = (0.0, 0.5)

#: Where the ends' corrections are measured: lengths over diameter.
MEASURED = (3.0, 6.0)

#: Shortest shaft, over its diameter, that the corrected beam is meant for.
SHORTEST = 1.0

BENT, TURNED, PULLED = "deflection by a force", "rotation by a moment", "tension"
OF = {BENT: shafts.DEFLECTION, TURNED: shafts.ROTATION, PULLED: shafts.AXIAL}
CORRECTED = f"beam corrected by its ends, worst error from L = {SHORTEST:g} D on"
CURVES = (
    "Error of the beam over its length, solid shaft; shaded: Timoshenko's deflection within 1 % "
    "between rigid ends (torsion has no error)"
)


@dataclass(frozen=True)
class RigidEnd:
    """The length by which a rigid end shortens a shaft, in units of its diameter of 1 m.

    Attributes
    ----------
    tube : Tube
        Its section.
    moment, mixed, force, tension : float
        Coefficients a, b, c, e of the table of the page.
    """

    tube: Tube
    moment: float
    mixed: float
    force: float
    tension: float

    def flexibility(self, length: float) -> Floats:
        """(6, 6) of both ends together, for a force or a moment at the rear."""
        found = np.zeros((6, 6))
        found[4, 4] = -2 * self.moment / self.tube.EI
        bent = -self.moment * length**2 + 2 * self.mixed * length + 2 * self.force
        found[2, 2] = bent / self.tube.EI
        found[0, 0] = -2 * self.tension / self.tube.EA
        return found


@dataclass(frozen=True)
class Map:
    """Errors over bore and length.

    Attributes
    ----------
    lengths, bores : (n,) and (m,) array
        Over the diameter.
    shear : (m, n) array
        Deflection that Euler and Bernoulli's beam leaves out [%].
    error, corrected : dict of (m, n) arrays
        Of Timoshenko's beam, without and with the length by which the ends shorten it [%].
    ends : list of RigidEnd
        By bore.
    """

    lengths: Floats
    bores: Floats
    shear: Floats
    error: dict[str, Floats]
    corrected: dict[str, Floats]
    ends: list[RigidEnd]

    def least(self, percent: Floats, level: float) -> float | None:
        """Least length from which on errors are below a level [%]."""
        return min_safe(self.lengths, percent, level)


def flexibility(length: float, bore: float, finer: bool = False) -> Floats:
    """Flexibility of a shaft of 1 m diameter between rigid ends, by harmonics in the meridian."""
    shaft = shafts.uniform(length, bore)
    size = 0.34 if length < 5 else 0.5
    return shafts.by_elements(shaft, size * 0.7, 8, 5) if finer else shafts.by_elements(shaft, size)


def rigid_end(measured: Sequence[Floats], bore: float) -> RigidEnd:
    """The length by which a rigid end shortens a shaft, from the flexibilities of two lengths."""
    tube = Tube(1.0, bore, 1.0, shafts.STEEL)
    excess = [
        found - shafts.by_beam(shafts.uniform(length, bore))
        for length, found in zip(MEASURED, measured, strict=True)
    ]
    a = -excess[0][4, 4] / 2 * tube.EI
    # deflection by a force: -a L^2 + 2 b L + 2 c
    rows = np.array([[2 * length, 2.0] for length in MEASURED])
    rest = [e[2, 2] * tube.EI + a * L**2 for e, L in zip(excess, MEASURED, strict=True)]
    b, c = np.linalg.solve(rows, rest)
    return RigidEnd(tube, float(a), float(b), float(c), float(-excess[0][0, 0] / 2 * tube.EA))


def mapped(run: Run, lengths: Floats, bores: Floats) -> Map:
    """Errors of the beam at all lengths and bores."""
    shear = np.empty((len(bores), len(lengths)))
    error = {name: np.empty_like(shear) for name in OF}
    corrected = {name: np.empty_like(shear) for name in OF}
    ends = []
    for i, bore in enumerate(bores):
        run.report(f"bore {bore:g} D")
        with run.step("meridians"):
            end = rigid_end([flexibility(length, bore) for length in MEASURED], bore)
            found = [flexibility(length, bore) for length in lengths]
        ends.append(end)
        for j, length in enumerate(lengths):
            exact, beam = found[j], shafts.by_beam(shafts.uniform(length, bore))
            thin = shafts.by_beam(shafts.uniform(length, bore), shear=False)
            better = beam + end.flexibility(length)
            # against Saint-Venant's own solution, which Timoshenko's beam with Cowper's k is
            shear[i, j] = 100 * (thin[2, 2] / beam[2, 2] - 1)
            for name, k in OF.items():
                error[name][i, j] = 100 * (beam[k, k] / exact[k, k] - 1)
                corrected[name][i, j] = 100 * (better[k, k] / exact[k, k] - 1)
    return Map(lengths, bores, shear, error, corrected, ends)


@case(
    "Beam theory against elasticity: uniform shafts, by length and bore",
    source="Cowper 1966, J. Appl. Mech. 33, 335-340; theory: Saint-Venant's flexure "
    "(tests/cases/test_shaft_theory.py)",
)
def run(run: Run, page: Page) -> None:
    """Map the errors, correct the beam by its ends, and check against solids."""
    lengths = np.append(np.geomspace(0.5, 30.0, 5 if run.quick else 8), SHORTEST)
    lengths.sort()
    found = mapped(run, lengths, np.array(QUICK_BORES if run.quick else BORES))
    with run.step("meridians, finer"):
        short, long, bores = lengths[0], lengths[-2], found.bores
        places = ((short, bores[0]), (short, bores[-1]), (long, bores[-1]))
        coarse, fine = (
            np.array([flexibility(*place, finer=finer).diagonal() for place in places])
            for finer in (False, True)
        )
    band = float(np.abs(coarse / fine - 1).max())
    check(run, page, found, band)
    check_solids(run, page)
    show(page, found)
    page.image(
        "The shortest shaft with the widest bore",
        run.sketch(straight((0.0, SHORTEST), 1.0, found.bores[-1])),
    )
    page.data("length_over_diameter", lengths)
    page.data("bore_over_diameter", bores)
    page.data("timoshenko_deflection_percent", found.error[BENT])
    page.data("band", band)


def check(run: Run, page: Page, found: Map, band: float) -> None:
    """The beam's own theory, the law by which ends disturb it, and the corrected beam."""
    for bore in (0.0, 0.5):
        with run.step("Saint-Venant's flexure"):
            tube = Tube(1.0, bore, 1.0, shafts.STEEL)
            tip, rough = flexure_tip(tube, 6), flexure_tip(tube, 4)
        page.equals(
            f"bore {bore:g} D, L = D, loads as Saint-Venant has them: mean deflection of the tip "
            "from the mean slope at the root [m/N]",
            tip,
            tube.length**3 / (3 * tube.EI) + tube.length / tube.kGA,
            within=1e-6,
            why="the field is a cubic, or with a bore smooth enough that sixth order has it to "
            "rounding",
            source="L^3 / 3EI + L / kGA, k of Cowper 1966, J. Appl. Mech. 33, 335-340",
            band=abs(tip - rough),
        )
    # longer than 3 D the fields of the two ends do not overlap
    apart = found.lengths >= 3.0
    at = found.lengths[apart]
    for bore, error in zip(found.bores, found.error[TURNED], strict=True):
        excess = 1 / (1 + error[apart] / 100) - 1
        page.equals(
            f"bore {bore:g} D: power of L with which the shortfall of the rotation goes",
            np.log(excess[-1] / excess[0]) / np.log(at[-1] / at[0]),
            -1.0,
            within=0.01,
            relative=False,
            why="what two ends at 3 D feel of each other is e^-8; elements leave "
            f"{band:.1g} of the rotation, a hundredth of an end's share and less",
            source="Saint-Venant's principle: an end keeps a fixed length from bending",
            measure="order",
            band=2 * band / np.abs(excess[-1]) / np.log(10.0),
        )
    usable = found.lengths >= SHORTEST
    for name, percent in found.corrected.items():
        page.at_most(
            f"{name}: {CORRECTED} [%]",
            np.abs(percent[:, usable]).max(),
            1.0,
            why="1 % is the first line of a map; the ends' fields overlap by e^-2.6 or so at "
            "L = D, of an end's share of ten percent",
            source="Fourier harmonics in the meridian",
            measure="rotation" if name.startswith("rot") else "deflection",
            band=100 * band,
        )


def check_solids(run: Run, page: Page) -> None:
    """Points of the map against curved tetrahedra."""
    for length, bore in () if run.quick else ((1.0, 0.0), (2.0, 0.5)):
        shaft = shafts.uniform(length, bore)
        with run.step("solids"):
            mesh = rigid_ended_shafts.meshed(shaft, 0.24, 12)
            solid = rigid_ended_shafts.solved(mesh, shaft, ("bending", "tension"))
        exact = flexibility(length, bore)
        for load, k, unit in (("bending", 4, "N m/rad"), ("tension", 0, "N/m")):
            estimate = solid.estimate[load].relative
            page.equals(
                f"L = {length:g} D, bore {bore:g} D: stiffness in {load}, {solid.unknowns:,} "
                "unknowns",
                solid.stiffness[load],
                float(1 / exact[k, k]),
                within=3 * estimate,
                unit=unit,
                why=f"three times the estimated error of the solid, {estimate:.1g}",
                source="Fourier harmonics in the meridian",
                measure="stiffness",
                band=3 * estimate * solid.stiffness[load],
            )


def answer(page: Page, found: Map, first: float | None, corrected: float | None) -> None:
    """State the shortest shafts, in diameters, of Timoshenko's beam and of the corrected one."""
    error, solid = found.error, 0
    least = {
        "Timoshenko between rigid ends, deflection within 1 %": first,
        "Timoshenko between rigid ends, deflection within 5 %": found.least(
            error[BENT][solid], 5.0
        ),
        "Timoshenko between rigid ends, tension within 1 %": found.least(error[PULLED][solid], 1.0),
        "Euler-Bernoulli, free ends, within 1 %": found.least(found.shear[solid], 1.0),
    }

    def reach(length: float | None) -> str:
        if length is None:
            return "at no length tried"
        return f"from {formatted(length, 2)} diameters of length"

    page.answer(
        "How short may a shaft be for beam theory to apply?",
        "Between rigid ends a Timoshenko beam's deflection is within 1\u00a0% "
        f"{reach(first)}; with the ends' flexibility added, {reach(corrected)}.",
        [
            *(
                page.value(f"least length, {name} [D]", rounded([value], 2)[0])
                for name, value in least.items()
                if value is not None
            ),
            page.judged(
                f"{BENT}: {CORRECTED}",
                f"worst error of the deflection, ends' flexibility added, from {SHORTEST:g} D",
            ),
        ],
        hero=CURVES,
        cautions=[
            "Ends are rigid here, as between stiff flanges; softer ends disturb the shaft less.",
            "D is the shaft's diameter; with the ends' flexibility added any bore is included.",
        ],
    )


def show(page: Page, found: Map) -> None:
    """Answer, charts, tables and limits."""
    shear, error, solid = found.shear, found.error, 0
    first = found.least(error[BENT][solid], 1.0)
    safe_corrected = [found.least(row, 1.0) for row in found.corrected[BENT]]
    end = found.ends[solid]
    answer(page, found, first, max(safe_corrected, key=lambda v: v or np.inf))
    page.say(
        "Under loads spread over its ends as Saint-Venant has them Timoshenko's beam is exact, and "
        f"Euler and Bernoulli's within 5 % from L = {found.least(shear[solid], 5.0):.2g} D.",
        f"A rigid end shortens the shaft by a fixed length: a solid one by {end.moment:.3f} D of "
        f"each end in bending and {end.tension:.3f} D in tension.",
    )
    state_limits(page, found, safe_corrected)
    page.section("How ends are held")
    page.text(
        "Two questions are kept apart. The error of the beam itself shows under loads that are "
        "spread over both end sections as Saint-Venant's solution has them: then Timoshenko's "
        "beam with Cowper's coefficient is exact for every length, and Euler and Bernoulli's has "
        "no shear. The effect of an end shows with rigid end faces, as of a shaft between stiff "
        "flanges: these keep sections flat and round, which no beam represents, so that the shaft "
        "is stiffer than its beam however long; only the share falls, as D / L. In torsion rigid "
        "ends disturb nothing: G J / L is exact at any length."
    )
    show_errors(page, found, first)
    show_lengths(page, found)
    show_ends(page, found)


def state_limits(page: Page, found: Map, safe_corrected: Sequence[float | None]) -> None:
    """State the shortest shafts of both beams."""
    lengths, bores, shear, error = found.lengths, found.bores, found.shear, found.error
    solid, half = 0, list(bores).index(0.5)
    for level in (1.0, 5.0):
        page.limit(
            "Euler and Bernoulli's beam, cantilever",
            "length over diameter, solid shaft",
            low=found.least(shear[solid], level),
            criterion=f"deflection by a force within {level:g} %",
            beyond=f"too stiff, by {-shear[solid, 0]:.0f} % of the deflection at "
            f"L = {lengths[0]:g} D: it has no shear",
            program="beams in scenes are Timoshenko's",
            remedy="Timoshenko's beam with Cowper's coefficient: exact for loads as Saint-Venant "
            "has them",
        )
    for i in (solid, half):
        page.limit(
            "Timoshenko's beam between rigid ends",
            f"length over diameter, bore {bores[i]:g} D",
            low=found.least(error[BENT][i], 1.0),
            criterion="deflection by a force within 1 %",
            beyond=f"too soft, by up to {error[BENT][i].max():.1f} %: rigid ends keep sections "
            "flat and round",
            program="none; the harmonics of a whole shaft take some 20 ms (axisymmetric)",
            remedy="ends' flexibility from the table added to the beam: within 1 % from "
            f"L = {safe_corrected[i] or np.nan:.2g} D",
        )


def show_errors(page: Page, found: Map, first: float | None) -> None:
    """Show errors over length and bore; Timoshenko's deflection is safe from `first` on."""
    lengths, bores, shear, error = found.lengths, found.bores, found.shear, found.error
    page.section("Solid shaft")
    curves = {
        "Euler-Bernoulli, loads as Saint-Venant has them": ("solid", shear),
        "Timoshenko, rigid ends: deflection": ("dash", error[BENT]),
        "Timoshenko, rigid ends: tension": ("dot", error[PULLED]),
        "Timoshenko with the ends' flexibility: deflection": ("dashdot", found.corrected[BENT]),
    }
    page.chart(
        CURVES,
        [dashed(name, lengths, np.abs(of[0]), dash) for name, (dash, of) in curves.items()],
        "length over diameter",
        "error without its sign [%]",
        "xy",
        (first, None),
    )
    page.section("Maps")
    axes = ("length over outer diameter", "bore over outer diameter", "x")
    between = "Timoshenko's beam between rigid ends"
    page.chart(
        f"{between}, deflection by a force at the tip: lines of 1, 5 and 10 % error (too soft)",
        map_traces(lengths, bores, error[BENT]),
        *axes,
    )
    page.chart(
        f"{between}, tension: lines of 1, 5 and 10 % error (too soft)",
        map_traces(lengths, bores, error[PULLED]),
        *axes,
    )
    page.chart(
        "Euler and Bernoulli's cantilever, deflection by a force at the tip, loads as Saint-Venant "
        "has them: lines of 1, 5 and 10 % error (too stiff)",
        map_traces(lengths, bores, shear, 2.0),
        *axes,
    )


def show_lengths(page: Page, found: Map) -> None:
    """Show the minimum length of each bore."""
    lengths = found.lengths
    beams = {"Euler-Bernoulli, deflection": found.shear}
    beams |= {f"Timoshenko, {name}": percent for name, percent in found.error.items()}
    page.table(
        "Least length over diameter for errors within 1 % and 5 %; at "
        f"{lengths[0]:g} the sweep begins, and an empty cell is beyond {lengths[-1]:g}",
        [
            {"bore over D": bore}
            | {
                f"{name}: {level:g} %": found.least(percent[i], level)
                for name, percent in beams.items()
                for level in (1.0, 5.0)
            }
            for i, bore in enumerate(found.bores)
        ],
    )


def show_ends(page: Page, found: Map) -> None:
    """Show the lengths that rigid ends take away, and the errors that are left with these."""
    page.section("The remedy: the length by which a rigid end shortens a shaft")
    usable = found.lengths >= SHORTEST
    page.table(
        "Each rigid end adds to the beam's flexibility, at its own face: rotation by a moment "
        "-a D / EI, motion by a force c D^3 / EI, motion by a moment (and rotation by a force) "
        "b D^2 / EI, motion by tension -e D / EA. Measured at "
        f"L = {MEASURED[0]:g} D and {MEASURED[1]:g} D",
        [
            {
                "bore over D": bore,
                "a": end.moment,
                "b": end.mixed,
                "c": end.force,
                "e": end.tension,
                f"worst error with them from L = {SHORTEST:g} D on [%]": max(
                    np.abs(percent[i, usable]).max() for percent in found.corrected.values()
                ),
            }
            for i, (bore, end) in enumerate(zip(found.bores, found.ends, strict=True))
        ],
    )


def flexure_tip(tube: Tube, order: int) -> float:
    """Mean deflection of the tip by 1 N [m], loads on both ends as Saint-Venant has them."""
    mesh = meridian(shafts.uniform(tube.length, tube.inner, tube.outer), order=order, layers=0)

    def traction(at: Floats, normal: Floats) -> Floats:
        x, r = at.T
        up = flexure_stress(np.column_stack([x, 0 * r, r]), 1.0, tube)
        aside = flexure_stress(np.column_stack([x, r, 0 * r]), 1.0, tube)
        # round the circumference is along -z a quarter turn on
        return np.asarray(normal[:, :1] * np.column_stack([up[:, 0], up[:, 5], -aside[:, 5]]))

    ends = [mesh.sides(partial(is_at, end)) for end in (0.0, tube.length)]
    loads = surface_loads(mesh, 1, np.vstack(ends), traction)
    rim = mesh.where(lambda x, r: (x < LENGTH_TOLERANCE) & (r > tube.outer / 2 - LENGTH_TOLERANCE))
    held = (np.concatenate([dofs(rim, 0), dofs(rim, 1)]), np.zeros(2))
    u = harmonic_response(mesh, shafts.STEEL, 1, loads, held).u[..., 0]
    means, slopes = [], []
    s, w = np.polynomial.legendre.leggauss(10)
    for end in ends:
        motion = slope = 0.0
        for cell, side in end:
            values, at, tangent = along_sides(mesh, side, np.array([cell]), (s + 1) / 2)
            ux, ur, ut = (values @ u[mesh.cells[cell]]).T
            r = at[0, :, 1]
            weight = w / 2 * np.hypot(*tangent[0].T) * np.pi * r
            motion += float(weight @ (ur - ut)) / tube.area
            slope -= float(weight @ (r * ux)) / tube.inertia
        means.append(motion)
        slopes.append(slope)
    return float(means[1] - means[0] - slopes[0] * tube.length)


def is_at(end: float, x: Floats, r: Floats) -> Bools:
    """Whether places are at an end."""
    return np.asarray(abs(x - end) < 1e-9)
