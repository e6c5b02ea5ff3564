"""The interface as a ladder of its own: bonded, 6x6 spring, ring of rollers, spherical joint."""

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.fidelity.joint_ladder import (
    BEARING,
    Solved,
    difference,
    housing_alone,
    on_springs,
    roller_imbalance,
    solved,
    tilting,
    with_joint,
)
from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file import (
    Scene,
    change_scene,
    joint_stiffness,
    library_scene,
    roller_lines,
)
from fe_drivetrain.elasticity.interfaces import roller_loads
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Run
from fe_drivetrain.shafts.fidelity import meridian_shaft

SCENE = "main_bearing_spherical"

#: Coarsening of the mesh, in full and under --quick: factor of the sizes, and elements a turn.
SIZES = ((1.6, None), (4.5, 6))

#: Tilt stiffness of main bearings [N m/rad], and whose.
KNOWN = {
    5.0e6: "toroidal roller bearing INP-A of a 5 MW drivetrain (Nejad et al. 2016)",
    1.272e9: "double-row tapered rollers, fitted to tables (Stirling 2023)",
}

NAMES = {5.0e6: "toroidal roller bearing", 1.272e9: "double-row tapered rollers"}

#: The ring of rollers: two rows, radial; all assumed.
COUNT, STIFFNESS, ROWS = 28, 5e8, (-0.05, 0.05)

#: Rollers that ring and housing do not feel [N/m].
SOFT = 5e3

#: What a choice of joint may change.
ENOUGH = 0.05


@dataclass(frozen=True)
class Limits:
    """Joints that have no stiffness to choose."""

    spherical: Solved
    none: Solved
    all: Solved
    sliding: Solved
    bonded: Solved


@dataclass(frozen=True)
class Sweep:
    """The joint's tilt stiffness varied: at powers of ten solids, and springs between them, too.

    Attributes
    ----------
    powers : ndarray
        Of ten, of the stiffness [N m/rad] of each assembly.
    solved : list of Solved
        The assemblies.
    condensed : ndarray
        The bearing's tilting moment for 1 N m at the hub at the same powers, at level 2.
    stiffness, moments : ndarray
        The same on many stiffnesses.
    """

    powers: Floats
    solved: list[Solved]
    condensed: Floats
    stiffness: Floats
    moments: Floats

    @property
    def solid_moments(self) -> Floats:
        """Moments of the assemblies."""
        return np.array([one.tilt_moment for one in self.solved])

    def order(self, limit: Solved, ends: slice) -> float:
        """Slope of the compliance's difference from a limit, over two points of the sweep."""
        errors = [difference(one.hub_motions, limit.hub_motions) for one in self.solved[ends]]
        return float(np.diff(np.log10(errors))[0] / np.diff(self.powers[ends])[0])

    def reached(self, share: float) -> float:
        """Stiffness at which so much of the largest moment is reached."""
        at = np.interp(share * self.moments[-1], self.moments, np.log10(self.stiffness))
        return float(10.0**at)

    def share(self, stiffness: float) -> float:
        """Moment at a stiffness, of the largest [%]."""
        at = np.interp(stiffness, self.stiffness, self.moments)
        return float(100 * at / self.moments[-1])


@dataclass(frozen=True)
class Rollers:
    """The ring of rollers, its loads, and soft rollers beside the spring they add up to."""

    solved: Solved
    loads: Floats
    imbalance: float
    soft: Solved
    as_spring: Solved


@case(
    "The bearing's joint: bonded, 6x6 spring, rollers, spherical",
    source="Stirling 2023 (scene; tilt stiffness); Nejad et al. 2016; rollers assumed",
    changes="scene",
)
def run(run: Run, page: Page) -> None:
    """Sweep the tilt stiffness of the joint from none to all, and set the other joints beside."""
    scene = change_scene(library_scene(SCENE), run.settings)
    scene = scene.model_copy(update={"mesh": scene.mesh.scaled(*SIZES[run.quick])})
    page.about(scene)
    with run.step("the two limits"):
        limits = Limits(
            spherical=solved(with_joint(scene, interface="averaged")),
            none=solved(tilting(scene, 0.0)),
            all=solved(tilting(scene, "rigid")),
            sliding=solved(scene),
            bonded=solved(with_joint(scene, interface="bonded")),
        )
    sweep = _swept(run, scene)
    with run.step("ring of rollers"):
        rollers = _rollers(scene)
    _check(page, limits, sweep, rollers)
    low, high = (sweep.reached(share) for share in (ENOUGH, 1.0 - ENOUGH))
    known = "; ".join(f"{whose}: {sweep.share(k):.0f} %" for k, whose in KNOWN.items())
    stiffer = limits.all.hub_motions[4, 4] / limits.bonded.hub_motions[4, 4] - 1
    answer(page, limits, sweep, (low, high))
    page.say(
        f"Of the largest share, a bearing as stiff as these takes: {known}.",
        f"Bonding stiffens the hub by another {100 * stiffer:.1f} % in tilt, for it keeps the bore "
        "round as well.",
    )
    _show_sweep(page, limits, sweep, rollers, low)
    _show_rollers(page, rollers)
    page.data("tilt_stiffness", 10.0**sweep.powers)
    page.data("moment", sweep.solid_moments)
    page.data("moment_level_2", sweep.condensed)
    page.data("spherical_below", low)
    page.data("rigid_above", high)
    page.data("bearing", BEARING)


HERO = "Tilting moment that the bearing takes for 1 N m at the hub, from spherical to rigid"


def answer(page: Page, limits: Limits, sweep: Sweep, ends: tuple[float, float]) -> None:
    """State between which stiffnesses [N m/rad] the joint's own has to be known."""
    low, high = ends
    page.answer(
        "Does it matter how a main bearing's joint is modelled?",
        f"A bearing's tilt stiffness matters only between {formatted(low / 1e6, 2)} and "
        f"{formatted(high / 1e6, 2)}\u00a0MN\u00a0m/rad: below, a spherical joint is accurate "
        "enough; above, a rigid one.",
        [
            page.value("a spherical joint is enough up to [MN m/rad]", low / 1e6),
            page.value("a rigid joint is enough from [MN m/rad]", high / 1e6),
            page.value(
                "largest share of a hub moment that the bearing takes", limits.all.tilt_moment
            ),
            *(
                page.value(
                    f"part of that share, {NAMES[k]} [%]", sweep.share(k), beside=100.0, by="all"
                )
                for k in KNOWN
            ),
            page.value("share that a bonded bearing takes", limits.bonded.tilt_moment),
        ],
        hero=HERO,
        cautions=[
            f"Enough means within {100 * ENOUGH:g} % of the largest moment that the bearing can "
            "take; stiffnesses of real bearings depend on load and clearance.",
            "A bonded joint also keeps the bore round, which no spring does.",
        ],
    )


def _swept(run: Run, scene: Scene) -> Sweep:
    powers = np.array([4.0, 6.0, 11.0, 13.0]) if run.quick else np.arange(4.0, 14.0)
    solids = []
    with run.step("sweep of the tilt stiffness"):
        for number, power in enumerate(powers.tolist(), 1):
            run.report(f"sweep of the tilt stiffness ({number} of {len(powers)})")
            solids.append(solved(tilting(scene, 10.0**power)))
    with run.step("condensed"):
        housing, shaft = housing_alone(scene), meridian_shaft(scene)
        fine = 10.0 ** np.linspace(powers[0], powers[-1], 61)
        condensed, curve = (
            np.array([on_springs(tilting(scene, float(k)), housing, shaft)[4, 4] for k in values])
            for values in (10.0**powers, fine)
        )
    return Sweep(powers, solids, condensed, fine, curve)


def _rollers(scene: Scene) -> Rollers:
    ring_of = {"count": COUNT, "stiffness": STIFFNESS, "rows": [{"x": x} for x in ROWS]}
    ring = with_joint(scene, **{"bearing.kind": "ring", "interface": "bonded"})
    rollers = with_joint(ring, interface="rollers", rollers=ring_of)
    rolling = solved(rollers)
    unit = rollers.bearing_units[0]
    loads = roller_loads(unit, rolling.response.motions)
    imbalance = roller_imbalance(rolling.response, roller_lines(unit), loads.reshape(-1, 10))
    # between bodies that hardly give to them, rollers are the 6x6 spring that they add up to
    soft = with_joint(rollers, **{"rollers.stiffness": SOFT})
    matrix = joint_stiffness(soft.bearing_units[0])
    free = np.abs(matrix).max() * 1e-12
    rows = np.where(np.abs(matrix) < free, 0.0, 0.5 * (matrix + matrix.T)).tolist()
    as_spring = with_joint(soft, interface="spring", rollers=None, stiffness=rows)
    return Rollers(rolling, loads, imbalance, solved(soft), solved(as_spring))


def _check(page: Page, limits: Limits, sweep: Sweep, rollers: Rollers) -> None:
    page.vanishes(
        "hub compliance, spring without tilt stiffness against the averaged spherical joint",
        difference(limits.none.hub_motions, limits.spherical.hub_motions),
        within=1e-8,
        why="the same equations, eliminated in another way; solvers stop at 1e-9",
        source="the same mesh with the joint's own constraint",
    )
    page.equals(
        "order of the way to the spherical limit",
        sweep.order(limits.none, slice(2)),
        1.0,
        within=0.02,
        why="the next term is a hundredth at a hundredth of the unit's own stiffness",
        source="a soft spring's effect is in proportion to it",
        relative=False,
        measure="order",
    )
    page.equals(
        "order of the way to the rigid limit",
        sweep.order(limits.all, slice(-2, None)),
        -1.0,
        within=0.02,
        why="the next term is a hundredth a hundred times above the unit's own stiffness",
        source="a stiff spring's give is in proportion to its inverse",
        relative=False,
        measure="order",
    )
    page.at_most(
        "tilting moment over the sweep, condensed shaft on joint and housing against the "
        "assembly, largest difference",
        float(np.abs(sweep.condensed - sweep.solid_moments).max()),
        0.02,
        why="the joint moves its faces by their means in both; what differs is how ring and "
        "shaft deform each other: a cylinder of the same volume stands for the ring",
        source="level 2, solved apart",
        measure="reaction",
    )
    page.vanishes(
        "loads of the rollers along their lines, sum against what the joint carries",
        rollers.imbalance,
        within=1e-7,
        why="solvers stop at 1e-9",
        source="equilibrium",
    )
    page.vanishes(
        f"hub compliance, rollers of {SOFT:g} N/m against the 6x6 spring that they add up to",
        difference(rollers.soft.hub_motions, rollers.as_spring.hub_motions),
        within=1e-4,
        why="next to such springs the bodies are rigid, to about their ratio of stiffness",
        source="K = sum k w w^T over the lines of contact",
    )
    page.holds(
        "the hub tilts no less with mean motions tied than bonded",
        limits.all.hub_motions[4, 4] >= limits.bonded.hub_motions[4, 4],
        why="least potential energy: a constraint can only stiffen",
        source="tying means is fewer constraints than tying all points",
    )


def _show_sweep(page: Page, limits: Limits, sweep: Sweep, rollers: Rollers, low: float) -> None:
    fine, curve = sweep.stiffness, sweep.moments
    ends = [fine[0], fine[-1]]
    page.section("From spherical to rigid")
    page.text(f"The shaded range has less than {100 * ENOUGH:g} % of the largest share.")
    page.chart(
        HERO,
        [
            trace("level 2: shaft, joint and housing as springs", fine, curve),
            trace("assembly of solids", 10.0**sweep.powers, sweep.solid_moments, points=True),
            trace("bonded", ends, [limits.bonded.tilt_moment] * 2, line={"dash": "dash"}),
            trace("rigid limit", ends, [limits.all.tilt_moment] * 2, line={"dash": "dot"}),
            *(
                trace(whose, [k], [np.interp(k, fine, curve)], points=True, marker={"size": 13})
                for k, whose in KNOWN.items()
            ),
        ],
        "tilt stiffness of the joint [N m/rad]",
        "moment [N m]",
        "x",
        safe=(None, low),
    )
    joints = {
        "bonded: one piece": limits.bonded,
        "spring, all six motions rigid: mean motions tied": limits.all,
        f"rollers: {len(ROWS)} rows of {COUNT}, {STIFFNESS:.1e} N/m each": rollers.solved,
        "spring without tilt stiffness": limits.none,
        "spherical, averaged": limits.spherical,
        "spherical, sliding": limits.sliding,
    }
    page.table(
        "The joints on the same drivetrain",
        [
            {
                "joint": name,
                "tilting moment at the bearing for 1 N m at the hub [N m]": one.tilt_moment,
                "hub tilt for 1 N m at the hub [rad]": one.hub_motions[4, 4],
                "set-up and solve [s]": one.seconds,
            }
            for name, one in joints.items()
        ],
    )


def _show_rollers(page: Page, rollers: Rollers) -> None:
    angles = np.degrees(2 * np.pi * np.arange(COUNT) / COUNT)
    shown = {
        "1 N down at the hub": -rollers.loads[..., 2],
        "1 N m about y at the hub": rollers.loads[..., 4],
    }
    page.section("A ring of rollers")
    page.text(
        "Each roller is a spring between the mean motions of both faces over its share of them. On "
        "bodies that do not give they add up to a 6x6 spring; on those that do, ring and housing "
        "share the load otherwise. Number, stiffness and rows are assumed."
    )
    page.chart(
        "Loads of the rollers round the ring, from +y towards z; each pushes and pulls",
        [
            trace(f"{what}, row at x = {x:g} m", angles, values[k])
            for what, values in shown.items()
            for k, x in enumerate(ROWS)
        ],
        "angle [deg]",
        "load of one roller [N]",
    )
