"""Families of housings that give the K_R that was wanted: sampled, traced and verified."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from fe_drivetrain.cases.main_bearing import bands, bearing_scenes
from fe_drivetrain.cases.main_bearing import housing_dimensions as housings
from fe_drivetrain.cases.main_bearing.housing_dimensions import (
    CENTRE,
    DIMENSIONS,
    ONE_BODY,
    PEDESTAL,
    PUBLISHED,
    STEEL,
    WALL,
    WIDE_RING,
    WIDTH,
    Aim,
    Form,
    Member,
    Sampled,
)
from fe_drivetrain.common import Floats, InputError
from fe_drivetrain.drivetrain_file import Scene
from fe_drivetrain.report.suite import Run
from fe_drivetrain.studies.solved_assembly import timed_mesh

#: Order of the surface through the sampled housings.
ORDER, QUICK_ORDER = 2, 1
#: Walls of the three curves [m], and members on each.
WALLS, MEMBERS = (0.07, 0.11, 0.15), 6
QUICK_WALLS, QUICK_MEMBERS = (0.11,), 1
CLOUD, QUICK_CLOUD = 300, 40
#: Relative: half of the last digit of 145 MN m/rad is 0.34 %, and one mesh and the next differ by
#: some tenths of a percent where no dimension has changed.
TOLERANCE = 0.005

PAIR = (WIDTH, PEDESTAL)  # solved for along a curve, all else given


@dataclass(frozen=True)
class Family:
    """The housings of one form that give both published values.

    Attributes
    ----------
    form : Form
        How they are made and held.
    samples : Sampled
        Housings all over the bounds.
    cloud : array
        (m, d) dimensions that the surface takes to give both [m].
    centre : array
        (d,) medians of the cloud [m].
    middle : Member
        A housing near the centre, on the scene's own mesh.
    coarse_over_fine : array
        (2, 3) K_R of the middle on the samples' mesh over that on the scene's own.
    curves : dict
        By wall [m]: members from low to high, on the samples' mesh.
    verified : list of Member
        On the scene's own mesh, the middle first.
    """

    form: Form
    samples: Sampled
    cloud: Floats
    centre: Floats
    middle: Member
    coarse_over_fine: Floats
    curves: dict[float, list[Member]]
    verified: list[Member]

    @property
    def label(self) -> str:
        """Short, for charts."""
        return "fixed" if self.form is ONE_BODY else "washers"

    @property
    def exponents(self) -> Floats:
        """(2, d) of K_R by four nodes in the middle of the family."""
        return self.samples.surfaces[0].exponents(self.middle.x)

    def stresses(self, scene: Scene) -> Floats:
        """At the foot, over the whole cloud [MPa]."""
        found = [housings.stress_at_foot(housings.housed(scene, self.form, x)) for x in self.cloud]
        return np.array(found) / 1e6


def family_of(run: Run, scene: Scene, form: Form, count: int) -> Family:
    """Sample the housings of a form, trace those that give both values, and verify some."""
    with run.step(f"sample housings ({form.title})"):
        order = QUICK_ORDER if run.quick else ORDER
        samples = housings.sampled(scene, form, count, order, run.report)
    aim = Aim(scene, form, samples.surfaces[0], PUBLISHED, TOLERANCE)
    finer = replace(aim, mesh=scene.mesh)
    with run.step("surface"):
        cloud = housings.projected(aim, QUICK_CLOUD if run.quick else CLOUD)
        centre = np.median(cloud, axis=0)
    # On the samples' mesh and then on the scene's own; the error of the former there.
    with run.step(f"middle of the family ({form.title})"):
        rough = housings.member(aim, centre, PAIR)
        middle = housings.member(finer, rough.x, PAIR, rough.over(aim.surface, 0))
        coarse_over_fine = aim.solved(middle.x).K_R / middle.K_R
    on_samples = replace(aim, wanted=PUBLISHED * coarse_over_fine[:, 0])
    ratio = middle.over(aim.surface, 0) / coarse_over_fine[:, 0]
    walls = QUICK_WALLS if run.quick else WALLS if form is ONE_BODY else (float(centre[WALL]),)
    curves = {}
    for wall in walls:
        start = centre.copy()
        start[WALL] = wall
        curve = curve_of(run, on_samples, start, ratio)
        if curve:
            curves[wall] = curve
    verified = [middle]
    for rough in [] if run.quick else ends_of(curves):
        with run.step(f"verify on the finer mesh ({form.title})"):
            known = rough.over(aim.surface, 0) * coarse_over_fine[:, 0]
            verified.append(housings.member(finer, rough.x, (WIDTH, CENTRE, PEDESTAL), known))
    return Family(form, samples, cloud, centre, middle, coarse_over_fine, curves, verified)


def ends_of(curves: Mapping[float, Sequence[Member]]) -> list[Member]:
    """The members of all curves whose centres lie farthest apart."""
    drawn = sorted((m for c in curves.values() for m in c), key=lambda m: float(m.x[CENTRE]))
    return [drawn[0], drawn[-1]] if len(drawn) > 1 else drawn


def curve_of(run: Run, aim: Aim, start: Floats, ratio: Floats) -> list[Member]:
    """Members from low to high centres, on the samples' mesh; see `housing_dimensions.member`."""
    ends = housings.reach(aim, start, CENTRE, PAIR)
    if ends is None:
        return []
    start, curve = start.copy(), []
    with run.step(f"family ({aim.form.title})"):
        # off the ends, where a correction would leave the bounds
        count = QUICK_MEMBERS if run.quick else MEMBERS
        for height in ends[0] + np.ptp(ends) * np.linspace(0.04, 0.96, count):
            start[CENTRE] = height
            run.report(f"wall {start[WALL]:.3g} m, centre at {height:.3g} m")
            try:
                found = housings.member(aim, start, PAIR, ratio)
            except InputError:
                continue  # a correction may leave what can be built
            if found.miss <= TOLERANCE:
                curve.append(found)
                start, ratio = found.x.copy(), found.over(aim.surface, 0)
    return curve


def other_readings(scene: Scene, one: Family) -> list[tuple[str, Member]]:
    """What the values would mean by another estimator, or in another material."""
    readings: tuple[tuple[str, Form, int, Floats], ...] = (
        (
            "four nodes, the vertical pair turned about a midpoint that stays (290 and 392)",
            ONE_BODY,
            0,
            PUBLISHED * [2.0, 1.0],
        ),
        ("averaged seat", ONE_BODY, 1, PUBLISHED),
        ("energy", ONE_BODY, 2, PUBLISHED),
        ("four nodes, housing of steel", STEEL, 0, PUBLISHED),
    )
    found = []
    for title, form, estimator, target in readings:
        wanted = target * one.coarse_over_fine[:, estimator]
        aim = Aim(scene, form, one.samples.surfaces[estimator], wanted, TOLERANCE, estimator)
        found.append((title, housings.member(aim, one.middle.x, (WIDTH, CENTRE, PEDESTAL))))
    return found


def with_wide_ring(scene: Scene, one: Family) -> Member:
    """The nearest housing with a ring of 0.2 m on a fixed underside, all dimensions free."""
    wanted = PUBLISHED * one.coarse_over_fine[:, 0]
    aim = Aim(scene, WIDE_RING, one.samples.surfaces[0], wanted, TOLERANCE, most=2)
    return housings.member(
        aim, np.maximum(one.middle.x, WIDE_RING.low), tuple(range(len(DIMENSIONS)))
    )


def assembled(run: Run, scene: Scene, family: Family) -> bands.Series:
    """The middle of a family with the whole shaft, independent of the stub, on three meshes."""
    title = family.form.title
    assembly = housings.housed(scene, family.form, family.middle.x)
    with run.side_by_side(3) as jobs:
        coarser = bands.start(jobs, assembly, title, solved=False, tilted=True)
        tilt = bearing_scenes.solve_seat(run, assembly, title, timed_mesh(run, assembly, title))
        return coarser.below(bands.of_tilt(tilt))


def band_of(family: Family, series: bands.Series | None, plane: int) -> float:
    """Relative; without a series of meshes, three times the distance of the coarser one."""
    if series is not None and series.complete:
        percent = series.percent(lambda f: float(f["K_R"][plane, 0]))
        assert percent is not None
        return percent / 100.0
    return 3.0 * abs(float(family.coarse_over_fine[plane, 0]) - 1.0)
