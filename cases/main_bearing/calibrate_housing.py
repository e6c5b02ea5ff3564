"""Which housing dimensions would give the K_R that the thesis found: families, not one answer."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.main_bearing import bands, bearing_scenes, shown
from fe_drivetrain.cases.main_bearing import housing_dimensions as housings
from fe_drivetrain.cases.main_bearing.housing_dimensions import (
    BOLTED,
    CENTRE,
    DIMENSIONS,
    HIGH,
    ONE_BODY,
    PEDESTAL,
    PUBLISHED,
    WIDTH,
    Member,
)
from fe_drivetrain.cases.main_bearing.housing_families import (
    TOLERANCE,
    Family,
    assembled,
    band_of,
    family_of,
    other_readings,
    with_wide_ring,
)
from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file import Scene
from fe_drivetrain.report import trace
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.shafts.response import ESTIMATORS

#: Housings sampled by form.
SAMPLES, BOLTED_SAMPLES, QUICK_SAMPLES = 60, 36, 8
QUICK_MESH = (2.0, 8)
#: 0.2 % proof stress of EN-GJS-400-15 (EN 1563) [Pa].
PROOF = 250e6

NAMES = [d.name for d in DIMENSIONS]
PLANES = ("vertical", "horizontal")
CENTRE_HEIGHT = "height of the centre [m]"
HERO = "Width along the shaft of housings that have both values of K_R"


def check_family(page: Page, family: Family, series: bands.Series | None) -> None:
    """Both values of all verified members, and on the whole shaft."""
    for p, plane in enumerate(PLANES):
        own = family.verified
        worst = max((m.K_R[p, 0] for m in own), key=lambda k: abs(k / PUBLISHED[p] - 1.0))
        band = band_of(family, series, p)
        page.equals(
            f"{family.form.title}: K_R of the {plane} plane by four nodes, worst of {len(own)} "
            "members [MN m/rad]",
            worst / 1e6,
            PUBLISHED[p] / 1e6,
            within=TOLERANCE,
            why="the published value has three digits (0.3 %), and remeshing scatters by tenths of "
            "a percent",
            source="Stirling 2023, section 3.3.1; what was asked of the dimensions",
            basis="self-consistency",
            band=band * worst / 1e6,
        )
        if series is not None:
            page.equals(
                f"{family.form.title}: K_R of the {plane} plane with the whole shaft, over that on "
                "a stub of it",
                float(series.levels[-1]["K_R"][p, 0]) / float(own[0].K_R[p, 0]),
                1.0,
                within=0.01,
                why="Saint-Venant: a pure moment enters the ring from a shaft that is cut off half "
                "a diameter or more before it; and another mesh",
                source="the assembly, level 4 of the ladder",
                measure="stiffness",
                band=band,
            )


def check_moduli(page: Page, scene: Scene, one: Family) -> None:
    """No material changes the ratio of both planes."""
    base = housings.housed(scene, ONE_BODY, one.middle.x)
    once, twice = (housings.solved_coarsely(s) for s in (base, housings.with_moduli(base, 2.0)))
    page.equals(
        "all moduli doubled: horizontal over vertical K_R, over what it was",
        float((twice.K_R[1] / twice.K_R[0] / (once.K_R[1] / once.K_R[0])).max()),
        1.0,
        within=1e-8,
        why="accuracy of the solution; so no material changes the ratio 392 to 145",
        source="linear elasticity: stiffness is in proportion to the moduli",
        measure="identity",
    )


def dimensions_of(scene: Scene, member: Member) -> Record:
    """A member in the columns of a table."""
    housing = housings.housed(scene, member.form, member.x)
    return {f"{n} [m]": float(v) for n, v in zip(NAMES, member.x, strict=True)} | {
        "mass [kg]": housings.mass(housing),
        "stress at foot [MPa]": housings.stress_at_foot(housing) / 1e6,
    }


def listed(x: Floats) -> str:
    """Dimensions in words."""
    return ", ".join(f"{n} {v:.3g}" for n, v in zip(NAMES, x, strict=True))


def width_range(family: Family) -> str:
    """Widths of the whole family, in words."""
    low, high = family.cloud[:, WIDTH].min(), family.cloud[:, WIDTH].max()
    bound = " (the bound)" if high > 0.999 * HIGH[WIDTH] else ""
    return f"{low:.3f} to {high:.3f} m{bound}"


def stress_range(scene: Scene, family: Family) -> str:
    """Stresses of the whole family, in words."""
    found, proof = family.stresses(scene), PROOF / 1e6
    above = 100.0 * float((found > proof).mean())
    share = f"{above:.0f} % of the family above {proof:.0f} MPa"
    return f"{found.min():.0f} to {found.max():.0f} MPa ({share})"


def families_section(
    page: Page, scene: Scene, families: list[Family], percents: dict[str, list[float]]
) -> None:
    """The families in charts, and their members in tables."""
    page.section("The families")
    family_charts(page, scene, families)
    member_tables(page, scene, families, percents)
    page.table(
        "Which dimensions the two values determine: range over the whole family, beside the "
        "bounds, and exponents of K_R by four nodes in the middle of the family (K_R in proportion "
        "to the dimension to that power)",
        [
            {
                "form": f.form.title,
                "dimension": d.name,
                "least allowed [m]": float(f.form.low[k]),
                "largest allowed [m]": d.high,
                "least in family [m]": float(f.cloud[:, k].min()),
                "largest in family [m]": float(f.cloud[:, k].max()),
                "exponent, vertical": float(f.exponents[0, k]),
                "exponent, horizontal": float(f.exponents[1, k]),
                "bounds": d.reason,
            }
            for f in families
            for k, d in enumerate(DIMENSIONS)
        ],
    )


def family_charts(page: Page, scene: Scene, families: list[Family]) -> None:
    """Pedestal, width and mass of all that gives both values, against the centre's height."""

    def lines(what: Callable[[Member], float]) -> list[Any]:
        return [
            trace(
                f"{f.label}, wall {wall:.3g} m",
                [m.x[CENTRE] for m in curve],
                [what(m) for m in curve],
                mode="lines+markers",
            )
            for f in families
            for wall, curve in f.curves.items()
        ]

    def clouds(k: int) -> list[Any]:
        return [
            trace(
                f"{f.label}, all dimensions free",
                f.cloud[:, CENTRE],
                f.cloud[:, k],
                True,
                marker={"size": 4, "opacity": 0.35},
            )
            for f in families
        ]

    page.chart(
        HERO,
        [*clouds(WIDTH), *lines(lambda m: float(m.x[WIDTH]))],
        CENTRE_HEIGHT,
        "width [m]",
    )
    page.chart(
        "Pedestal of the same housings, against the height of their centre",
        [*clouds(PEDESTAL), *lines(lambda m: float(m.x[PEDESTAL]))],
        CENTRE_HEIGHT,
        "width of the pedestal [m]",
    )
    page.text(
        "Lines are solved on the samples' mesh with the bias of that mesh taken off; dots are from "
        "the surface, with all five dimensions free."
    )
    page.chart(
        "Mass of the same housings",
        lines(lambda m: housings.mass(housings.housed(scene, m.form, m.x))),
        CENTRE_HEIGHT,
        "mass [kg]",
    )


def member_tables(
    page: Page, scene: Scene, families: list[Family], percents: dict[str, list[float]]
) -> None:
    """Dimensions and K_R of the members that were verified."""
    verified = [m for f in families for m in f.verified]
    page.table(
        "Members on the scene's own mesh. Stress: nominal, where the pedestal meets the foot, "
        "under a tilting moment of 1 MN m, about the largest that the thesis shows (section 3.5); "
        f"ductile iron yields at about {PROOF / 1e6:.0f} MPa",
        [{"form": m.form.title, **dimensions_of(scene, m)} for m in verified],
    )
    estimators = [f"{p} {e} [MN m/rad]" for p in PLANES for e in ESTIMATORS]
    page.table(
        "K_R of the same members by every estimator, the first of which was calibrated, and its "
        "band",
        [
            {"form": m.form.title, CENTRE_HEIGHT: float(m.x[CENTRE])}
            | dict(zip(estimators, (m.K_R.ravel() / 1e6).tolist(), strict=True))
            | {"bands [%]": ", ".join(f"± {b:.2g}" for b in percents[m.form.title])}
            for m in verified
        ],
    )


def reach_section(page: Page, scene: Scene, families: list[Family]) -> None:
    """K_R of all samples."""

    def points(name: str, K_R: Floats, symbol: str | None = None, size: int = 11) -> Any:
        more = {"marker": {"symbol": symbol, "size": size}} if symbol else {}
        return trace(name, K_R[:, 0] / 1e6, K_R[:, 1] / 1e6, True, **more)

    one = families[0].samples
    broad = one.x[:, WIDTH] >= 0.2
    names = {ONE_BODY: "fixed underside", BOLTED: "four washers"}
    default = housings.solved_coarsely(scene).K_R[:, 0]
    page.section("What can be reached")
    page.chart(
        "K_R by four nodes of housings all over the bounds",
        [
            *(points(names[f.form], f.samples.K_R[:, :, 0]) for f in families),
            points("fixed underside, 0.2 m wide or more", one.K_R[broad, :, 0], "circle-open"),
            points("the library's", default[None], "square"),
            points("Stirling 2023", PUBLISHED[None], "star", 16),
        ],
        "vertical plane [MN m/rad]",
        "horizontal plane [MN m/rad]",
        ("x", "y"),
    )
    page.text(
        "The ratio of the two planes is a matter of form: the horizontal one rises faster with the "
        "pedestal's width, and falls faster with its height, than the vertical one. The size of "
        "both is a matter of the width along the shaft (exponents above). No material changes the "
        "ratio."
    )


def method_section(page: Page, families: list[Family], bands_of: dict[str, list[float]]) -> None:
    """How the families were found, and what that costs in accuracy."""

    def of_each(words: Callable[[Family], str]) -> str:
        return ", ".join(f"{words(f)} ({f.form.title})" for f in families)

    def width_band(family: Family) -> float:
        """What the wider of both bands would move the width by [%]."""
        found = bands_of[family.form.title]
        return max(found[p] / float(family.exponents[p, WIDTH]) for p in (0, 1))

    def scatter(family: Family) -> str:
        vertical, horizontal = 100 * family.samples.surfaces[0].scatter
        return f"{vertical:.1f} and {horizontal:.1f} %"

    page.section("How")
    page.text(
        "Samples: a Latin hypercube in logs, each housing on a stub of shaft solved on a coarse "
        "mesh. A polynomial of the logs through them gives derivatives: a difference of two "
        "solutions would hold the jump from one mesh to the next. scipy's least_squares solves it "
        "for both planes at once within the bounds, and the model corrects it until its own K_R is "
        f"within {100 * TOLERANCE:g} %. Error of the surface at samples left out (vertical and "
        f"horizontal): {of_each(scatter)}. What the samples' mesh is stiffer by is taken off "
        "before the curves are traced, and members are verified on the scene's own mesh. What the "
        "program refuses to build is left out. The bands of the middle's K_R stand for "
        f"{of_each(lambda f: f'{width_band(f):.2g} %')} of its width."
    )
    page.table(
        "Housings solved for the surfaces, and how much stiffer than the scene's own mesh their "
        "mesh is in the middle of the family",
        [
            {
                "form": f.form.title,
                "solved": len(f.samples.x),
                "refused": f.samples.refused,
                "vertical [%]": 100.0 * float(f.coarse_over_fine[0, 0] - 1.0),
                "horizontal [%]": 100.0 * float(f.coarse_over_fine[1, 0] - 1.0),
            }
            for f in families
        ],
    )


@dataclass(frozen=True, eq=False)
class Worked:
    """The families, and what is told beside them.

    Attributes
    ----------
    scene : Scene
        The scene whose housing is replaced.
    families : list[Family]
        By form, the one with a fixed underside first.
    readings : list[tuple[str, Member]]
        A housing for each reading of the two values; that of the thesis first.
    wide : Member
        The nearest housing with a wide ring.
    series : list[bands.Series or None]
        Meshes of the middle of each family; None in a quick run.
    """

    scene: Scene
    families: list[Family]
    readings: list[tuple[str, Member]]
    wide: Member
    series: list[bands.Series | None]

    @property
    def wide_K(self) -> Floats:
        """(2,) K_R of the housing with a wide ring, the bias of its mesh taken off [MN m/rad]."""
        return np.asarray(self.wide.K_R[:, 0] / self.families[0].coarse_over_fine[:, 0] / 1e6)

    @property
    def percents(self) -> dict[str, list[float]]:
        """Band of K_R in each plane by family [%]."""
        return {
            f.form.title: [100 * band_of(f, s, plane) for plane in (0, 1)]
            for f, s in zip(self.families, self.series, strict=True)
        }


def calibrated_families(run: Run, scene: Scene) -> Worked:
    """Sample housings, trace those that give both values, and read the values otherwise."""
    counts = {ONE_BODY: QUICK_SAMPLES if run.quick else SAMPLES}
    if not run.quick:
        counts[BOLTED] = BOLTED_SAMPLES
    families = [family_of(run, scene, form, count) for form, count in counts.items()]
    one = families[0]
    readings = [("four nodes, as in the thesis", one.middle)]
    with run.step("other readings"):
        readings += [] if run.quick else other_readings(scene, one)
        wide = with_wide_ring(scene, one)
    series = [None if run.quick else assembled(run, scene, family) for family in families]
    return Worked(scene, families, readings, wide, series)


def answer(page: Page, work: Worked) -> None:
    """Which housings give both values, and that they determine none."""
    scene, one, wide_K = work.scene, work.families[0], work.wide_K
    low, high = np.quantile(one.cloud[:, CENTRE], [0, 1])
    widths, stresses = one.cloud[:, WIDTH], one.stresses(scene)
    above = 100.0 * float((stresses > PROOF / 1e6).mean())
    page.answer(
        "Which housing would have the torsional stiffness K_R that the thesis gives?",
        f"The thesis's K_R needs a plate-like housing only {widths.min():.3f} to "
        f"{widths.max():.3f}\u00a0m wide along the shaft; {above:.0f}\u00a0% of such housings "
        "would yield under 1\u00a0MN\u00a0m.",
        [
            page.value("smallest width along the shaft [m]", float(widths.min())),
            page.value("largest width along the shaft [m]", float(widths.max())),
            *(
                page.value(
                    f"K_R of an example, {plane} [MN m/rad]",
                    float(one.middle.K_R[p, 0]) / 1e6,
                    beside=PUBLISHED[p] / 1e6,
                    by="thesis",
                )
                for p, plane in enumerate(PLANES)
            ),
            page.value(
                "largest nominal stress at the foot under 1 MN m [MPa]",
                float(stresses.max()),
                at_most=PROOF / 1e6,
                by="ductile iron yields",
            ),
        ],
        hero=HERO,
        cautions=[
            "Two values of K_R cannot determine five dimensions: the thesis's housing need not be "
            "one of these.",
            "K_R is read from four nodes, as in the thesis; other estimators give other housings.",
        ],
    )
    page.say(
        "The height of the centre of such a plate "
        f"({low:.2f} to {high:.2f} m) trades against the width of its pedestal; for example "
        f"{listed(one.middle.x)} m.",
        "A tilting moment of 1 MN m, about the largest that the thesis shows, makes a nominal "
        f"stress in its foot of {stress_range(scene, one)}, where ductile iron yields; notches not "
        "counted.",
        "With a ring and a body of at least 0.2 m and a fixed underside no housing within the "
        f"bounds gives both: the nearest found has {wide_K[0]:.0f} and {wide_K[1]:.0f} MN m/rad.",
    )
    for two in work.families[1:]:
        page.say(
            "Held at four washers instead, which the thesis does not do, a body of "
            f"{width_range(two)} gives both, at a nominal {stress_range(scene, two)}, for example "
            f"{listed(two.middle.x)} m."
        )
    for _, turned in work.readings[1:2]:
        page.say(
            "Read with the vertical pair turned about a midpoint that stays, so that the thesis's "
            "145 would be 290 by the slope of the line, a body of "
            f"{turned.x[WIDTH]:.2f} m on a fixed underside gives both."
        )


def readings_section(page: Page, work: Worked) -> None:
    """Housings for other readings of the two values, and with a wide ring."""
    page.section("Other readings of the two values")
    page.table(
        "One housing for each reading, near the middle of the family; on the samples' mesh, its "
        "bias taken off",
        [
            {"reading": title, **dimensions_of(work.scene, m), "remaining error [%]": 100 * m.miss}
            for title, m in work.readings
        ],
    )
    page.text(
        "The thesis takes the rotation of the vertical pair 'about the mid point': of the line "
        "between the displaced nodes, as here, or about a midpoint that stays, which doubles it. "
        "Ring and body of 0.2 m or more on a fixed underside: the nearest found is "
        f"{listed(work.wide.x)} m, with {work.wide_K[0]:.0f} and {work.wide_K[1]:.0f} MN m/rad."
    )


@case(
    "Which housing dimensions would give a K_R of 145 and 392 MN m/rad",
    source="Stirling 2023, PhD thesis, section 3.3.1",
    settings={
        "solver": "auto (or superlu, cholmod, pardiso, multigrid, schwarz, petsc, petsc-mumps)",
    },
    changes="scene",
)
def run(run: Run, page: Page) -> None:
    """Sample housings, trace those that give both values, and verify some on finer meshes."""
    scene = bearing_scenes.scene_of(run, page, "bonded", coarsen=False)
    if run.quick:
        scene = scene.model_copy(update={"mesh": scene.mesh.scaled(*QUICK_MESH)})
    work = calibrated_families(run, scene)
    families, percents = work.families, work.percents
    for family, of_meshes in zip(families, work.series, strict=True):
        check_family(page, family, of_meshes)
    with run.step("moduli"):
        check_moduli(page, scene, families[0])
    answer(page, work)
    families_section(page, scene, families, percents)
    reach_section(page, scene, families)
    readings_section(page, work)
    method_section(page, families, percents)
    shown.assume(page, scene)
    page.data(
        "members",
        [
            {"form": m.form.title, **dict(zip(NAMES, m.x, strict=True)), "K_R": m.K_R}
            for f in families
            for m in f.verified
        ],
    )
    page.data("bounds", {d.name: [d.low, d.high] for d in DIMENSIONS})
    page.data("family", {f.form.title: f.cloud for f in families})
    page.data("highest", HIGH)
