"""Gearbox springs from none to rigid: from a mechanism to a held shaft, and to no digit left."""

from dataclasses import dataclass, replace

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.soft_springs import Sprung, scene_of, sprung
from fe_drivetrain.common import Bools, Floats, InputError
from fe_drivetrain.comparison import FOUR_DIGITS, decades, in_words, safe_range
from fe_drivetrain.drivetrain_file import Scene
from fe_drivetrain.report import crosses, marked, trace
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Run
from fe_drivetrain.shafts.beam import Support, beam_of_scene, unit_load_response
from fe_drivetrain.shafts.response import mesh_scene

#: Of the other gearbox springs [N/m].
OTHER = 1e8
#: The stiffest spring that a scene may have [N/m].
STIFFEST = 1e16

ERRORS = (
    "Error of the hub's motion by a force there over the radial gearbox spring, spherical bearing; "
    "shaded: four digits, crosses: refused"
)
RADIAL = "radial gearbox stiffness [N/m]"
SCATTER = (
    "round-off scatters by about a decade from point to point: over the decades of the fit by 0.2 "
    "of the slope, over the few points of a quick run by twice that"
)
FIRST_ORDER = "first order in the spring or its compliance: the next order is below a twentieth"


@dataclass(frozen=True)
class Swept:
    """The motions of a scene over its radial gearbox spring.

    Attributes
    ----------
    stiffness : (n,) array
        Of the spring [N/m].
    hub : (n,) array
        Vertical motion of the hub under 1 N there [m]; NaN where the solver refuses.
    reaction : (n,) array
        Of the spring [N].
    warned : (n,) array of bool
        Whether the program warned of a motion that is hardly restrained.
    refusals : list of str
        Why it refused; empty where it did not.
    """

    stiffness: Floats
    hub: Floats
    reaction: Floats
    warned: Bools
    refusals: list[str]

    @property
    def answered(self) -> Bools:
        """Where there is an answer."""
        return np.isfinite(self.hub)


@dataclass(frozen=True)
class Errors:
    """Relative errors over the spring of a shaft on a spherical bearing.

    Attributes
    ----------
    of : Swept
        The motions.
    hub, reaction, beam : (n,) array
        Errors of the hub's motion, the gearbox's reaction and the beam; NaN where refused.
    """

    of: Swept
    hub: Floats
    reaction: Floats
    beam: Floats

    @property
    def worst(self) -> Floats:
        """The larger of both errors of the solid."""
        return np.asarray(np.fmax(self.hub, self.reaction))

    @property
    def safe(self) -> tuple[float | None, float | None]:
        """Range of springs with four digits [N/m]."""
        return safe_range(self.of.stiffness, self.worst, FOUR_DIGITS)


@dataclass(frozen=True)
class OneSpring:
    """A bonded bearing with one spring more, from a free end to a held one.

    Attributes
    ----------
    of : Swept
        The motions.
    free, held : float
        Motion of the hub without the spring, and with the end held [m].
    own : float
        Motion of the spring's end by its force [m/N].
    error, reaction_error : (n,) array
        Relative errors of the hub's motion and of the reaction.
    """

    of: Swept
    free: float
    held: float
    own: float
    error: Floats
    reaction_error: Floats

    @property
    def from_free(self) -> Floats:
        """Departure from the free shaft, relative."""
        return np.asarray(np.abs(self.of.hub / self.free - 1.0))

    @property
    def from_held(self) -> Floats:
        """Departure from the held shaft, relative."""
        return np.asarray(np.abs(self.of.hub / self.held - 1.0))


def swept(run: Run, name: str, model: Sprung, stiffness: Floats, other: float) -> Swept:
    """Solve a scene with each spring, as the program does it."""
    hub, reaction, warned, refusals = [], [], [], []
    for k in stiffness:
        run.report(f"{name}: gearbox {k:.0e} N/m")
        springs = [other, other, float(k), 0, 0, 0]
        warnings, refusal = model.warnings_and_refusal(springs)
        found = None if refusal else model.solve(springs, ["hub.Fz"], "superlu")
        warned.append(bool(warnings))
        refusals.append(refusal or ("" if found else "singular"))
        hub.append(np.nan if found is None else found.hub[2, 0])
        reaction.append(np.nan if found is None else k * found.gearbox[2, 0])
    return Swept(stiffness, np.array(hub), np.array(reaction), np.array(warned), refusals)


def beam_errors(scene: Scene, held: Scene, stiffness: Floats, lever: float) -> Floats:
    """Errors of the hub's motion by the force method against statics; NaN where it refuses."""
    beam = beam_of_scene(held, {"main_bearing": [np.inf] * 3 + [0.0] * 3})
    others = [s for s in beam.supports if s.name != "gearbox"]
    front, compliance = scene.shaft.front, []
    for k in [*stiffness, np.inf]:
        support = Support("gearbox", scene.shaft.rear, [OTHER, OTHER, k, np.inf, 0.0, 0.0])
        try:
            on_spring = replace(beam, supports=[*others, support])
            compliance.append(unit_load_response(on_spring, front, front).displacement[2, 2])
        except InputError:
            compliance.append(np.nan)
    exact = compliance[-1] + lever**2 / stiffness
    return np.asarray(np.abs(np.array(compliance[:-1]) / exact - 1.0))


@case(
    "Springs from nothing to rigid: where a shaft is held, and how many digits are left",
    source="statics of a lever; the formula of Sherman and Morrison 1950, Ann. Math. Stat. 21, 124",
)
def run(run: Run, page: Page) -> None:
    """Sweep the radial gearbox stiffness of a spherical and of a bonded main bearing."""
    found = spherical(run, page)
    answer(page, found, bonded(run, page))
    page.image(
        "The shaft and its bearing, coarsened", run.sketch(mesh_scene(scene_of("spherical")))
    )


def answer(page: Page, errors: Errors, bonded_high: float | None) -> None:
    """State the springs with four digits; `bonded_high` is the stiffest on a bonded bearing."""
    found = errors.of
    low, high = errors.safe
    stiff = high or found.stiffness[-1]
    silent = found.answered & ~found.warned & ~(errors.worst < FOUR_DIGITS)
    missed = int(silent[found.stiffness <= STIFFEST].sum())
    warned = found.stiffness[found.warned]
    softest = "softest spring with four correct digits, spherical bearing [N/m]"
    figures = [] if low is None else [page.value(softest, low)]
    figures += [
        page.value(
            f"stiffest spring with four correct digits, {name} bearing [N/m]",
            end,
            at_least=STIFFEST,
        )
        for name, end in (("spherical", high), ("bonded", bonded_high))
        if end is not None
    ]
    page.answer(
        "How soft or stiff may the springs of a gearbox be?",
        "Results are correct to four digits for gearbox springs from "
        f"{newtons(low or found.stiffness[0])} to {newtons(stiff)}, "
        + ("more" if stiff > STIFFEST else "not more")
        + f" than the {newtons(STIFFEST)} that drivetrain files may have.",
        [
            *figures,
            page.value(
                "softest spring that the program accepts [N/m]",
                found.stiffness[found.answered].min(),
            ),
            page.value(
                "results without four correct digits and without a warning", missed, at_most=0.0
            ),
        ],
        hero=ERRORS,
        cautions=[
            "Softer springs are "
            + ("rejected or warned of" if missed == 0 else f"not warned of in {missed} cases")
            + (f"; the warning begins at {newtons(warned.max())}." if warned.size else "."),
            "The soft limit is that of this shaft: a motion that nothing else restrains loses "
            "digits as its spring gets softer.",
        ],
    )


def newtons(stiffness: float) -> str:
    """A stiffness in a sentence."""
    return f"{formatted(stiffness, 2, '')}\u00a0N/m"


def spherical(run: Run, page: Page) -> Errors:
    """A shaft that turns about its bearing unless the gearbox holds it."""
    with run.step("spherical: mesh and assembly"):
        scene, held_scene = scene_of("spherical"), scene_of("spherical", rigid=(2, 3))
        mesh = mesh_scene(scene)
        model, held = sprung(scene, mesh), sprung(held_scene, mesh)
    lever = -scene.shaft.front / scene.shaft.rear  # hub to bearing over bearing to gearbox
    with run.step("spherical: springs"):
        stiffness = np.concatenate(
            [decades(-6, 4, 0.5 if run.quick else 1), decades(8, 28, 0.1 if run.quick else 0.25)]
        )
        rigid = held.solve([OTHER, OTHER, 0, 0, 0, 0], ["hub.Fz"], "superlu")
        assert rigid is not None
        found = swept(run, "spherical", model, stiffness, OTHER)
        _, at_zero = model.warnings_and_refusal([OTHER, OTHER, 0.0, 0, 0, 0])
    with run.step("beam"):
        beam_error = beam_errors(scene, held_scene, stiffness, lever)
    error = np.abs(found.hub / (rigid.hub[2, 0] + lever**2 / stiffness) - 1.0)
    # statics: the gearbox carries the load times the lever, whatever its spring
    reaction_error = np.abs(found.reaction / -lever - 1.0)
    errors = Errors(found, error, reaction_error, beam_error)
    low, high = errors.safe
    check_spherical(page, errors, at_zero, low, 0.4 if run.quick else 0.2)
    answered, warned = found.answered, found.warned
    first_warned = stiffness[warned].max() if warned.any() else None
    by_beam = np.isfinite(beam_error)
    page.limit(
        "soft gearbox springs on a spherical bearing",
        "radial stiffness [N/m]",
        low=low,
        criterion="error of the hub's motion below 1e-4",
        beyond="the error of the motion grows tenfold a decade; then the solver finds the matrix "
        "singular",
        program=f"names the motion and the digits lost up to {in_words(first_warned)} N/m, refuses "
        f"below {stiffness[answered].min():.1g} N/m; none at all is a mechanism by geometry",
        remedy=f"force method (beam): right to {np.nanmax(beam_error):.0e} from "
        f"{stiffness[by_beam].min():.1g} N/m on",
    )
    limit_stiff(page, "spherical", high)
    page.say(
        "On a spherical bearing no spring at all is refused as a mechanism; up to "
        f"{in_words(first_warned)} N/m the program names the motion that is hardly held."
    )
    show_spherical(page, errors, at_zero, (low, high))
    return errors


def check_spherical(
    page: Page, errors: Errors, at_zero: str, low: float | None, within: float
) -> None:
    """Check for warnings where digits are lost, answers elsewhere, and a beam that loses none."""
    found, stiffness, error = errors.of, errors.of.stiffness, errors.hub
    silent = found.answered & ~found.warned & ~(errors.worst < FOUR_DIGITS)
    allowed = stiffness <= STIFFEST
    page.holds(
        "spherical, no gearbox spring: refused, and the motion named",
        "turn freely about y" in at_zero,
        why="without a spring the stiffness is singular, and any answer would be round-off",
        source="a shaft on a sphere",
    )
    page.exponent(
        "spherical, soft spring: error of the hub's motion, exponent",
        stiffness[stiffness < 1e5],
        error[stiffness < 1e5],
        -1.0,
        within=within,
        between=(1e-12, 0.1),
        why=SCATTER,
        source="round-off of the shaft's stiffness acts as springs to ground",
    )
    page.holds(
        "spherical: every answer without four digits was warned of or refused, from a spring of "
        "nothing to the stiffest that a scene may have",
        not silent[allowed].any(),
        why="an answer without digits looks like any other",
        source="statics: the reaction of the gearbox is the lever times the load",
    )
    page.holds(
        "spherical: springs above those that leave four digits are all solved",
        bool(found.answered[allowed & (stiffness >= (low or 0.0))].all()),
        why="there is no mechanism to refuse: the spring holds the shaft",
        source="statics",
    )
    page.vanishes(
        "beam by the force method: worst error wherever the solid answers",
        errors.beam[found.answered].max(),
        within=1e-10,
        why="round-off of a flexibility that the spring's is added to",
        source="statics: the lever squared over the spring is added",
    )


def show_spherical(
    page: Page, errors: Errors, at_zero: str, safe: tuple[float | None, float | None]
) -> None:
    """Show the errors, and the message of the program for each spring."""
    found, error, beam_error = errors.of, errors.hub, errors.beam
    stiffness, answered, warned = found.stiffness, found.answered, found.warned
    by_beam = np.isfinite(beam_error)
    page.section("Spherical bearing: from a mechanism to a held shaft")
    page.text(
        "The reference is the motion with the gearbox held, plus the lever squared over stiffness."
    )
    quiet, loud = answered & ~warned, answered & warned
    page.chart(
        ERRORS,
        [
            marked("solid, no warning", stiffness[quiet], np.maximum(error[quiet], 1e-16)),
            marked("solid, warned of", stiffness[loud], error[loud]),
            trace(
                "reaction of the gearbox",
                stiffness[answered],
                np.maximum(errors.reaction[answered], 1e-16),
                line={"dash": "dot"},
            ),
            crosses("refused", stiffness[~answered]),
            trace(
                "beam by the force method",
                stiffness[by_beam],
                np.maximum(beam_error[by_beam], 1e-16),
                line={"dash": "dash"},
            ),
        ],
        RADIAL,
        "relative error",
        "xy",
        safe,
    )
    rows = [{"stiffness [N/m]": 0.0, "error": None, "warned": False, "refused": at_zero}]
    rows += [
        {"stiffness [N/m]": k, "error": e if np.isfinite(e) else None, "warned": w, "refused": r}
        for k, e, w, r in zip(stiffness, error, warned, found.refusals, strict=True)
    ]
    page.table("What the program reports", rows)
    page.data("spherical", rows)


def bonded(run: Run, page: Page) -> float | None:
    """A shaft that its bearing holds, with one spring more; the stiffest with four digits."""
    with run.step("bonded: springs"):
        found = one_spring(run, decades(0, 32, 0.25 if run.quick else 0.5))
    errors = np.fmax(found.error, found.reaction_error)
    _, high = safe_range(found.of.stiffness, errors, FOUR_DIGITS)
    check_first_order(page, found, 0.4 if run.quick else 0.2)
    check_ends(page, found)
    limit_stiff(page, "bonded", high)
    page.say(
        "On a bonded bearing the free and the held shaft are recovered, first order in the "
        "spring and in its compliance."
    )
    show_bonded(page, found, high)
    return high


def one_spring(run: Run, k: Floats) -> OneSpring:
    """Solve a bonded bearing with springs k [N/m], with none, and held rigidly."""
    scene = scene_of("bonded")
    mesh = mesh_scene(scene)
    model, held = sprung(scene, mesh), sprung(scene_of("bonded", rigid=(2, 3)), mesh)
    none, loads = [0.0] * 6, ["hub.Fz", "gearbox.weight"]
    free = model.solve(none, loads, "superlu")
    fast = held.solve(none, loads, "superlu")
    assert free is not None
    assert fast is not None
    found = swept(run, "bonded", model, k, 0.0)
    # one spring on a solved body: its force, and what that moves
    motion, own, across = free.gearbox[2, 0], -free.gearbox[2, 1], -free.hub[2, 1]
    force = motion * k / (1.0 + k * own)
    return OneSpring(
        of=found,
        free=free.hub[2, 0],
        held=fast.hub[2, 0],
        own=own,
        error=np.abs(found.hub / (free.hub[2, 0] - across * force) - 1.0),
        reaction_error=np.abs(found.reaction / force - 1.0),
    )


def check_first_order(page: Page, found: OneSpring, within: float) -> None:
    """Check how errors, and departures from both ends, go with the stiffness of the spring."""
    k, reaction_error = found.of.stiffness, found.reaction_error
    above = k > STIFFEST
    between = (k > 1.0 / found.own) & ~above
    page.exponent(
        "bonded, stiff spring: error of the gearbox's reaction, exponent",
        k[above],
        reaction_error[above],
        1.0,
        within=within,
        between=(1e-11, 0.1),
        why=SCATTER,
        source="the spring times a motion that round-off does not let vanish",
    )
    for quantity, at, departure, expected in (
        ("soft spring: departure from the free shaft", k > 0.0, found.from_free, 1.0),
        ("stiff spring: departure from the held shaft", between, found.from_held, -1.0),
    ):
        page.exponent(
            f"bonded, {quantity}, exponent",
            k[at],
            departure[at],
            expected,
            within=0.05,
            between=(1e-9, 1e-2),
            why=FIRST_ORDER,
            source="one spring on a body: k u / (1 + k c)",
        )


def check_ends(page: Page, found: OneSpring) -> None:
    """Check that the softest and the stiffest spring give the free and the held shaft."""
    page.equals(
        "bonded: hub motion at the softest spring, over that of the free shaft",
        found.of.hub[0] / found.free,
        1.0,
        within=1e-7,
        why="the spring of 1 N/m is 1e-8 of the shaft's own stiffness",
        source="the same scene without a spring",
        measure="deflection",
        band=found.error[0],
    )
    last = np.flatnonzero(found.of.stiffness <= 1.01 * STIFFEST)[-1]
    page.equals(
        "bonded: hub motion at the stiffest spring that a scene may have, over that of the held "
        "shaft",
        found.of.hub[last] / found.held,
        1.0,
        within=1e-6,
        why="1e16 N/m is 1e8 times the shaft's own stiffness; its round-off is as much",
        source="the same scene, held rigidly",
        measure="deflection",
        band=found.error[last],
    )


def show_bonded(page: Page, found: OneSpring, high: float | None) -> None:
    """Show errors and departures; the reaction is safe up to the stiffness `high`."""
    page.section("Bonded bearing: from a free end to a held one")
    page.text(
        "The bonded bearing holds the shaft by itself. One spring more moves the hub by what its "
        "force moves: from two unit loads on the free shaft its motion with any spring follows, "
        "and that is the reference for the solution with that spring."
    )
    k, answered = found.of.stiffness, found.of.answered
    page.chart(
        "Hub motion under a force there: error, and departure from the two limits. Shaded: four "
        "digits",
        [
            *(
                trace(name, k[answered], np.maximum(values[answered], 1e-16), mode=mode)
                for name, values, mode in (
                    ("error", found.error, "lines+markers"),
                    ("departure from the free shaft", found.from_free, "lines"),
                    ("departure from the held shaft", found.from_held, "lines"),
                    ("error of the gearbox's reaction", found.reaction_error, "lines"),
                )
            ),
            crosses("refused", k[~answered]),
        ],
        RADIAL,
        "relative",
        "xy",
        (None, high),
    )


def limit_stiff(page: Page, bearing: str, high: float | None) -> None:
    """How stiff a gearbox spring may be."""
    page.limit(
        f"stiff gearbox springs on a {bearing} bearing",
        "radial stiffness [N/m]",
        high=high,
        criterion="error of the gearbox's reaction below 1e-4",
        beyond="the motion of the spring is round-off, and the spring multiplies it: the "
        "reaction's error grows tenfold a decade",
        program="refuses springs above 1e16 N/m in a scene",
        remedy="stiffness 'rigid': eliminated",
    )
