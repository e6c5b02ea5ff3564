"""Beam theory on a stepped shaft: what the corner of a step costs, sharp and with a fillet."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import end_flexibilities as shafts
from fe_drivetrain.cases.references.torsion_meridian import torsion_bounds
from fe_drivetrain.common import Floats
from fe_drivetrain.common.arrays import rounded
from fe_drivetrain.comparison import min_safe
from fe_drivetrain.elasticity.revolution import dofs, harmonic_response, meridian, surface_loads
from fe_drivetrain.geometry import LENGTH_TOLERANCE, Shaft
from fe_drivetrain.report import dashed, map_traces
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Run

#: Large over small diameter.
RATIOS = (1.05, 1.1, 1.2, 1.35, 1.5, 2.0, 2.5, 3.0)
QUICK_RATIOS = (1.1, 1.5, 3.0)

#: Step ratio of the fillets' curves, length over the small diameter, radius over the step's
#: height, and the ratios of their map.
FILLETED, AT = 1.5, 3.0
RADII = (0.1, 0.25, 0.5, 1.0)
FILLET_RATIOS = (1.2, 1.5, 2.0, 2.5)
QUICK_RADII = (1.0,)

#: Length over the small diameter where the step's own flexibility is measured.
MEASURED = 6.0

OF = {"torsion": shafts.TORSION, "bending": shafts.ROTATION, "tension": shafts.AXIAL}
WITH_EXTRA = (
    "{}: beam with the step's extra length, worst error of all steps where both halves are as long "
    "as they are wide"
)
BLUE = "#0072b2"
DASHES = {"torsion": "solid", "bending": "dash", "tension": "dot"}


@dataclass(frozen=True)
class Map:
    """Errors of the beam over step and length.

    Attributes
    ----------
    lengths, ratios : (n,) and (m,) array
        Over the small diameter.
    error, corrected : dict of (m, n) arrays
        Without and with the step's extra length [%].
    extra : dict of (m,) arrays
        That length, of the small section, over its diameter.
    """

    lengths: Floats
    ratios: Floats
    error: dict[str, Floats]
    corrected: dict[str, Floats]
    extra: dict[str, Floats]

    @property
    def shown(self) -> int:
        """The step that curves and limits are of."""
        return int(np.argmin(np.abs(self.ratios - FILLETED)))

    def least(self, percent: Floats, level: float) -> float | None:
        """Least length from which on errors are below a level [%]."""
        return min_safe(self.lengths, percent, level)


def stepped(length: float, ratio: float, fillet: float = 0.0) -> Shaft:
    """Half of the length before the step and half behind it."""
    return shafts.stepped((length / 2, length / 2), (ratio, 1.0), fillet)


def beam(length: float, ratio: float) -> Floats:
    """Flexibilities (6,) of the beam."""
    return np.asarray(shafts.by_beam(stepped(length, ratio)).diagonal())


def of_ends() -> Floats:
    """What two rigid ends take off the flexibilities (6,) of a solid shaft of 1 m diameter."""
    shaft = shafts.uniform(3.0)
    return np.asarray((shafts.by_elements(shaft, 0.3) - shafts.by_beam(shaft)).diagonal())


def without_ends(
    length: float, ratio: float, ends: Floats, fillet: float = 0.0, finer: bool = False
) -> Floats:
    """Flexibilities (6,) of the elements, less the ends'; of rotations and along x alone."""
    shaft = stepped(length, ratio, fillet)
    size = ratio / 3
    found = (
        shafts.by_elements(shaft, size * 0.7, 8, 5) if finer else shafts.by_elements(shaft, size)
    )
    # along x as 1 / D, of rotations as 1 / D^3
    power = np.array([1.0, 1.0, 1.0, 3.0, 3.0, 3.0])
    return np.asarray(found.diagonal() - 0.5 * ends * (1 + ratio**-power))


def bent_by_tractions(length: float, ratio: float) -> float:
    """Rotation by a moment [rad/(N m)]: twice the energy of unit moments by linear tractions."""
    mesh = meridian(stepped(length, ratio), ratio / 3)

    def traction(at: Floats, normal: Floats) -> Floats:
        outer = np.where(at[:, 0] < length / 2, ratio, 1.0)
        return np.column_stack([64 / np.pi / outer**4 * at[:, 1] * normal[:, 0], 0 * at])

    ends = mesh.sides(lambda x, r: (x < LENGTH_TOLERANCE) | (x > length - LENGTH_TOLERANCE))
    loads = surface_loads(mesh, 1, ends, traction)
    rim = mesh.where(lambda x, r: (x < LENGTH_TOLERANCE) & (r > ratio / 2 - LENGTH_TOLERANCE))
    held = (np.concatenate([dofs(rim, 0), dofs(rim, 1)]), np.zeros(2))
    return 2 * float(harmonic_response(mesh, shafts.STEEL, 1, loads, held).energy[0])


def mapped(run: Run, lengths: Floats, ratios: Floats, ends: Floats) -> Map:
    """Errors of the beam on sharp steps."""
    error, corrected = ({name: np.empty((len(ratios), len(lengths))) for name in OF} for _ in "ab")
    extra = {name: np.empty(len(ratios)) for name in OF}
    for i, ratio in enumerate(ratios):
        run.report(f"step {ratio:g}")
        with run.step("sharp steps"):
            measured = without_ends(MEASURED, ratio, ends)
            found = np.array([without_ends(length, ratio, ends) for length in lengths])
        of_beam = np.array([beam(length, ratio) for length in lengths])
        for name, k in OF.items():
            thin = shafts.by_beam(shafts.uniform(1.0))[k, k]
            extra[name][i] = (measured[k] - beam(MEASURED, ratio)[k]) / thin
            error[name][i] = 100 * (of_beam[:, k] / found[:, k] - 1)
            corrected[name][i] = 100 * ((of_beam[:, k] + extra[name][i] * thin) / found[:, k] - 1)
    return Map(lengths, ratios, error, corrected, extra)


@case(
    "Beam theory against elasticity: stepped shafts, by length, step and fillet",
    source="Michell 1899, Proc. London Math. Soc. 31, 130-146; Reissner and Sagoci 1944, J. Appl. "
    "Phys. 15, 652-654",
)
def run(run: Run, page: Page) -> None:
    """Map the errors of sharp steps, then of fillets; correct the beam; check both."""
    lengths = np.append(np.geomspace(0.5, 30.0, 4 if run.quick else 7), AT)
    lengths.sort()
    ends = of_ends()
    found = mapped(run, lengths, np.array(QUICK_RATIOS if run.quick else RATIOS), ends)
    with run.step("finer, and fillets"):
        sharp = without_ends(AT, FILLETED, ends)
        fine = without_ends(AT, FILLETED, ends, finer=True)
        band = float(np.abs(sharp / fine - 1)[list(OF.values())].max())
        radii = QUICK_RADII if run.quick else RADII
        filleted = {
            ratio: np.array(
                [without_ends(AT, ratio, ends, radius * (ratio - 1) / 2) for radius in radii]
            )
            for ratio in ((FILLETED,) if run.quick else FILLET_RATIOS)
        }
    check(run, page, found, sharp, band)
    with_radius = np.vstack([sharp, filleted[FILLETED]])
    error = 100 * (beam(AT, FILLETED) / with_radius - 1)
    show_steps(page, found)
    answer(page, found, error[:, OF["bending"]])
    page.say(
        f"A fillet reduces the error: at L = {AT:g} d the beam, which has none, is off by "
        f"{error[0, OF['bending']]:+.1f} % in bending where the step is sharp and by "
        f"{error[-1, OF['bending']]:+.1f} % where the radius is the step's height."
    )
    page.section("Fillets")
    page.chart(
        f"Error of the beam, which has no fillet, step {FILLETED:g}, L = {AT:g} d, against the "
        "fillet's radius: below zero it is too stiff",
        [
            dashed(name, np.array([0.0, *radii]), error[:, k], DASHES[name])
            for name, k in OF.items()
        ],
        "fillet radius over height of the step",
        "error [%]",
    )
    if not run.quick:
        show_fillets(page, radii, filleted)
    page.image("A shaft with a step that is filleted", run.sketch(stepped(AT, FILLETED, 0.1)))
    page.data("length_over_diameter", lengths)
    page.data("step_ratio", found.ratios)
    page.data("extra_length", found.extra)
    page.data("band", band)


def check(run: Run, page: Page, found: Map, sharp: Floats, band: float) -> None:
    """Bounds in torsion, ends as Saint-Venant has them, the corrected beam, the largest step."""
    for ratio in (1.5,) if run.quick else (1.2, 2.0):
        with run.step("bounds in torsion"):
            shaft = stepped(2.0, ratio)
            bounds = torsion_bounds(shaft, shafts.STEEL.shear_modulus, 0.12, 1 if run.quick else 4)
        k = 1 / shafts.by_elements(shaft, ratio / 3)[3, 3]
        page.equals(
            f"sharp step {ratio:g}, L = 2 d: torsional stiffness [N m/rad]",
            k,
            bounds.middle,
            within=bounds.half_width / bounds.middle + band,
            why=f"the truth lies between the bounds, and elements are too stiff by {band:.1g}",
            source="middle of two bounds by complementary energies (Michell 1899)",
            band=band * k,
        )
    with run.step("Saint-Venant's ends"):
        direct = bent_by_tractions(AT, FILLETED)
    page.equals(
        f"sharp step {FILLETED:g}, L = {AT:g} d: rotation by a moment, ends taken out by those of "
        "uniform shafts [rad/(N m)]",
        sharp[OF["bending"]],
        direct,
        within=2e-4,
        why="what an end and the step feel of each other across the shorter half, 1 diameter of "
        "it: e^-5 (cylinder's slowest mode of bending) of an end's 1 %",
        source="the same shaft with linear tractions on both ends, which disturb nothing",
        measure="rotation",
        band=band * direct,
    )
    usable = found.lengths >= 2 * found.ratios[:, None]
    for name, percent in found.corrected.items():
        page.at_most(
            f"{WITH_EXTRA.format(name)} [%]",
            np.abs(percent[usable]).max(),
            1.0,
            why="1 % is the first line of a map; Saint-Venant's principle keeps the step's field "
            "apart from the ends' a diameter away",
            source="Fourier harmonics in the meridian",
            measure="rotation" if name != "tension" else "deflection",
            band=100 * band,
        )
    page.at_least(
        "torsion: extra length of the largest step, against that of a rigid disc on a half-space "
        "[d]",
        found.extra["torsion"][-1],
        3 * np.pi / 64 * (1 - found.ratios[-1] ** -3),
        why="a rigid disc on a half-space is stiffer than a shaft of any softness grown on to it",
        source="Reissner and Sagoci 1944, J. Appl. Phys. 15, 652-654: M = 16/3 G a^3 phi, so G J / "
        "M phi is 3 pi / 64 d; less what the half-space has beyond the larger shaft, which goes as "
        "1 / r^3",
        band=band * found.extra["torsion"][-1],
    )


def answer(page: Page, found: Map, filleted: Floats) -> None:
    """State how long a stepped shaft has to be; filleted are errors by a fillet's radius [%]."""
    shown = found.shown
    step = found.ratios[shown]
    least = {name: found.least(found.error[name][shown], 5.0) for name in OF}
    more = found.extra["bending"][shown]
    with_more = found.least(found.corrected["bending"][shown], 5.0)

    def length(value: float | None) -> str:
        return f"over\u00a0{found.lengths[-1]:g}" if value is None else formatted(value, 2)

    page.answer(
        "How long must a shaft with a sharp step be for beam theory to apply?",
        f"A beam model of a shaft with a sharp {step:g}\u00a0:\u00a01 step bends within 5\u00a0% "
        f"from {length(least['bending'])} diameters of length, or {length(with_more)} if "
        f"lengthened by {formatted(more, 2)}.",
        [
            *(
                page.value(f"least length within 5 %, {name} [d]", rounded([value], 2)[0])
                for name, value in sorted(least.items())
                if value is not None
            ),
            page.value("length to add at the step, bending [d]", rounded([more], 2)[0]),
            page.judged(
                WITH_EXTRA.format("bending"),
                "worst error in bending with that length, halves at least as long as wide",
            ),
            page.value(
                f"error in bending with the largest fillet, {AT:g} d long [%]", filleted[-1]
            ),
        ],
        hero=caption_of_errors(step),
        cautions=[
            "Lengths are of both halves together, over the smaller diameter d; a beam model of a "
            "shorter shaft is too stiff."
        ],
    )


def caption_of_errors(step: float) -> str:
    """Caption of the chart of one step."""
    return (
        f"Error of the beam's flexibility over the length, sharp step {step:g}; shaded: bending "
        "within 5 %"
    )


def show_steps(page: Page, found: Map) -> None:
    """Charts, table and limits of sharp steps."""
    shown = found.shown
    step = found.ratios[shown]
    extra = {name: values[shown] for name, values in found.extra.items()}
    safe = found.least(found.error["bending"][shown], 5.0)
    page.say(
        f"A sharp step from {step:g} d to d adds what {extra['torsion']:.3f} d of the small "
        f"section would in torsion, {extra['bending']:.3f} d in bending and "
        f"{extra['tension']:.3f} d in tension."
    )
    for name in OF:
        corrected = found.least(found.corrected[name][shown], 5.0)
        page.limit(
            "beam of sections, sharp step in the middle",
            f"length over small diameter, step {step:g}, {name}",
            low=found.least(found.error[name][shown], 5.0),
            criterion="flexibility within 5 %",
            beyond=f"too stiff, up to {-found.error[name].min():.0f} % over all steps: the corner "
            "of the large section carries nothing",
            program="none; the harmonics of a whole shaft take tens of milliseconds (axisymmetric)",
            remedy=f"{extra[name]:.3f} d more of the small section: within 5 % from "
            f"{corrected or np.nan:.2g} d",
        )
    page.section("How ends are held")
    page.text(
        "Solid shafts, half of the length before the step and half behind it. The ends are rigid "
        "in the finite elements, and the length they remove (see the case of uniform shafts) is "
        "taken out again, so that the error is the step's alone; in one point that was checked "
        "against tractions that need no such correction. In torsion rigid ends disturb nothing."
    )
    show_errors(page, found, shown, safe)


def show_errors(page: Page, found: Map, shown: int, safe: float | None) -> None:
    """Show the errors at sharp steps; bending is safe from the length `safe` on."""
    step, lengths = found.ratios[shown], found.lengths
    page.section("Sharp steps")
    along = "length of both halves over small diameter"
    page.chart(
        caption_of_errors(step),
        [
            dashed(name + words, lengths, np.abs(percent[name][shown]), DASHES[name], colour)
            for name in OF
            for percent, words, colour in (
                (found.error, "", "black"),
                (found.corrected, " with extra length", BLUE),
            )
        ],
        along,
        "error without its sign [%]",
        "xy",
        (safe, None),
    )
    for name in OF:
        page.chart(
            f"{name.capitalize()} of a shaft with a sharp step: lines of 1, 5 and 10 % error of "
            "the beam (too stiff)",
            map_traces(lengths, found.ratios, found.error[name]),
            along,
            "large over small diameter",
            "x",
        )
    rows = []
    for i, ratio in enumerate(found.ratios):
        row: dict[str, float | None] = {"D over d": ratio}
        for name in OF:
            row[f"{name}: extra length over d"] = found.extra[name][i]
            row[f"{name}: 1 %"] = found.least(found.error[name][i], 1.0)
            row[f"{name}: 5 %"] = found.least(found.error[name][i], 5.0)
        worst = np.max([np.abs(percent[i]) for percent in found.corrected.values()], axis=0)
        rows.append(row | {"all three with their extra lengths: 1 %": found.least(worst, 1.0)})
    page.table(
        "Extra length of the small section that replaces the step, and least length over small "
        f"diameter without it for errors within 1 % and 5 %; at {lengths[0]:g} the sweep begins, "
        f"and an empty cell is beyond {lengths[-1]:g}",
        rows,
    )


def show_fillets(page: Page, radii: Sequence[float], filleted: dict[float, Floats]) -> None:
    """Map of the beam's error in bending over fillets of several steps."""
    k = OF["bending"]
    bent = [100 * (beam(AT, ratio)[k] / one[:, k] - 1) for ratio, one in filleted.items()]
    page.chart(
        f"Bending of a shaft of L = {AT:g} d with a fillet, which the beam has not: lines of 1, 5 "
        "and 10 % error",
        map_traces(np.array(radii), np.array(list(filleted)), np.array(bent), 0.0),
        "fillet radius over height of the step",
        "large over small diameter",
        "x",
    )
