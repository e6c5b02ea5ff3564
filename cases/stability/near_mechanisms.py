"""Near-mechanisms: motions that soft springs hardly restrain are named, with the digits lost."""

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.soft_springs import Sprung, scene_of, sprung
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import FOUR_DIGITS, decades, safe_range
from fe_drivetrain.elasticity.interfaces import WEAK
from fe_drivetrain.elasticity.mesh import Mesh
from fe_drivetrain.report import crosses, marked, trace
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run, column
from fe_drivetrain.shafts.response import mesh_scene

#: Of the gearbox's axial spring, which hardly matters [N/m].
AXIAL = 1e8
HELD = [AXIAL, 0, 0, 0, 0, 0]

JOINTS = ("sliding", "averaged", "rigid")

#: Each motion: its row and column among the hub's motions and the loads.
MOTIONS = {"spin about x": (3, 0), "tilt about y": (4, 1)}
LOADS = ["hub.Mx", "hub.My"]

RATIO = "work of the springs over E times length of what moves"


def solve(loose: Sprung, held: Sprung, targets: list[float]) -> list[Record]:
    """Motions at the hub with springs of so many shares of the shaft's stiffness."""
    rigid = held.solve(HELD, LOADS, "superlu")
    # the remedy: held rigidly, by the other solver, and the springs' own motion added
    remedied = held.solve(HELD, LOADS, "multigrid")
    assert rigid is not None
    assert remedied is not None
    # both motions at one ratio: it is proportional to the spring
    unit = {
        motion.description.split(" through")[0].rsplit(" ", 1)[-1]: motion.ratio
        for motion in loose.weakest([AXIAL, 1.0, 1.0, 1.0, 0, 0])
    }
    arm = loose.model.scene.shaft.rear
    rows: list[Record] = []
    for ratio in targets:
        spin, radial = ratio / unit["x"], ratio / unit["y"]
        springs = [AXIAL, radial, radial, spin, 0, 0]
        warnings, refusal = loose.warnings_and_refusal(springs)
        answer = None if refusal else loose.solve(springs, LOADS, "superlu")
        added = {"spin about x": 1.0 / spin, "tilt about y": 1.0 / (radial * arm**2)}
        row: dict[str, object] = {"ratio": ratio}
        remedy = []
        for motion, at in MOTIONS.items():
            exact = rigid.hub[at] + added[motion]
            found = np.nan if answer is None else answer.hub[at]
            row[f"error of the {motion}"] = abs(found / exact - 1.0)
            remedy.append(abs((remedied.hub[at] + added[motion]) / exact - 1.0))
        row["2e-16 over the ratio"] = np.finfo(float).eps / ratio
        row["warnings"] = len(warnings)
        row["refused"] = refusal or ("" if answer else "singular")
        rows.append(row | {"warned": warnings, "remedy": max(remedy)})
    return rows


@dataclass(frozen=True)
class Softened:
    """Ever softer springs at one form of the joint.

    Attributes
    ----------
    rows : list of dict
        One for each restraint.
    at_zero : str
        Why it is refused without springs.
    """

    rows: list[Record]
    at_zero: str

    def of(self, key: str) -> Floats:
        """One quantity of all restraints."""
        return np.array(column(self.rows, key))

    @property
    def errors(self) -> dict[str, Floats]:
        """Relative errors of each motion, NaN where refused."""
        return {motion: self.of(f"error of the {motion}") for motion in MOTIONS}

    @property
    def worst(self) -> Floats:
        """The larger error of both motions."""
        return np.asarray(np.fmax(*self.errors.values()))

    @property
    def soft(self) -> tuple[float, tuple[str, ...]]:
        """The ratio nearest to 1e-12, and the warnings there."""
        row = min(self.rows, key=lambda row: abs(np.log10(row["ratio"]) + 12.0))
        return row["ratio"], row["warned"]


def sweep(run: Run, page: Page, joint: str, mesh: Mesh) -> list[Record]:
    """Soften the springs of one form of the joint: its checks, chart and limit; all points."""
    targets = decades(-17, -5, 0.5 if run.quick else 1.25)
    with run.step(f"{joint} joint"):
        loose = sprung(scene_of("spherical", joint, rigid=()), mesh)
        held = sprung(scene_of("spherical", joint, rigid=(1, 2, 3)), mesh)
        _, at_zero = loose.warnings_and_refusal(HELD)
        found = Softened(solve(loose, held, targets.tolist()), at_zero)
    check_errors(run, page, joint, found)
    check_words(page, joint, found)
    low, _ = safe_range(targets, found.worst, FOUR_DIGITS)
    assert low is not None
    page.limit(
        f"soft springs as the only restraint, {joint} joint",
        RATIO,
        low=low,
        criterion="error of the motion below 1e-4",
        beyond="the error of the motion grows tenfold a decade: about 2e-16 over the ratio",
        program=f"warns below {WEAK:.0e} with the name of the motion and the digits lost; "
        f"refuses below {targets[np.isfinite(found.worst)].min():.0e}, by name",
        remedy="the direction held rigidly, and moment over stiffness added: right to "
        f"{found.of('remedy').max():.0e}",
    )
    show(page, joint, found, low)
    shown_keys = [key for key in found.rows[0] if key not in ("warned", "remedy")]
    page.data(joint, [{key: row[key] for key in shown_keys[:3]} for row in found.rows])
    return [{"joint": joint, "least safe": low, **row} for row in found.rows]


def check_errors(run: Run, page: Page, joint: str, found: Softened) -> None:
    """Check that errors grow as the program states, and that the remedy has none."""
    targets, predicted = found.of("ratio"), found.of("2e-16 over the ratio")
    for motion, error in found.errors.items():
        usable = (error > 0.0) & (error < 0.1) & (targets < 1e-5)
        lost = np.log10(error[usable] / predicted[usable])
        page.exponent(
            f"{joint} joint, {motion}: error against the restraint, exponent",
            targets[usable],
            error[usable],
            -1.0,
            within=0.4 if run.quick else 0.2,
            why="round-off scatters by about a decade from point to point: by as much at one end "
            "of six decades it changes a slope by 0.2, and twice that is let pass of the four "
            "points of a quick run",
            source="round-off of the bodies' stiffness acts as springs to ground",
        )
        page.vanishes(
            f"{joint} joint, {motion}: digits lost, less those that the program names, mean "
            "[digits]",
            lost.mean(),
            within=2.0,
            why="an estimate of round-off without constants: the two digits that the threshold of "
            "the warning has to spare",
            source="2e-16 over the ratio that the warning gives",
            band=lost.std() / np.sqrt(len(lost)),
        )
    page.vanishes(
        f"{joint} joint: held rigidly, and moment over stiffness added: worst error at any spring",
        found.of("remedy").max(),
        within=1e-8,
        why="the iteration stops at 1e-9 in the energy norm",
        source="statics, and the held shaft by a direct solver",
    )


def check_words(page: Page, joint: str, found: Softened) -> None:
    """Check that warnings and refusals name the motion where digits are lost, and only there."""
    has_warning = found.of("warnings") > 0
    silent = np.isfinite(found.worst) & ~has_warning & ~(found.worst < FOUR_DIGITS)
    _, warned = found.soft
    page.holds(
        f"{joint} joint: springs of 1e-12 of the shaft: warned of by name, about each of three "
        "axes",
        all(any(f"nearly turn about {axis}" in w for w in warned) for axis in "xyz"),
        why="springs at the gearbox are too soft for all three rotations: a name left out would "
        "leave one unseen",
        source="a shaft on a sphere turns about three axes",
    )
    page.holds(
        f"{joint} joint: no springs: refused, and the free motions named",
        all(f"turn freely about {axis}" in found.at_zero for axis in "xyz"),
        why="without springs the stiffness is singular, and any answer would be round-off",
        source="a shaft on a sphere turns about three axes",
    )
    page.holds(
        f"{joint} joint: every answer without four digits was warned of or refused",
        not silent.any(),
        why="an answer without digits looks like any other",
        source="statics: moment over stiffness is added to the motion when held",
    )
    page.holds(
        f"{joint} joint: restraints of ten times the threshold and more: silent",
        not has_warning[found.of("ratio") > 10.0 * WEAK].any(),
        why="a warning that comes where all digits are there would soon be ignored",
        source="error of 2e-16 over the ratio: less than 1e-4 there",
    )


def show(page: Page, joint: str, found: Softened, low: float) -> None:
    """Show the errors and the program's warning; safe from the ratio `low` on."""
    targets, answered = found.of("ratio"), np.isfinite(found.worst)
    has_warning = found.of("warnings") > 0
    page.section(f"{joint.capitalize()} joint")
    page.chart(
        caption_of_errors(joint),
        [
            *(
                marked(motion, targets[answered], np.maximum(error[answered], 1e-16))
                for motion, error in found.errors.items()
            ),
            trace(
                "as the warning estimates it",
                targets[has_warning],
                np.minimum(found.of("2e-16 over the ratio")[has_warning], 1.0),
                line={"dash": "dash"},
            ),
            trace(
                "held, moment over stiffness added",
                targets,
                np.maximum(found.of("remedy"), 1e-16),
                line={"dash": "dot"},
            ),
            crosses("refused", targets[~answered]),
        ],
        RATIO,
        "relative error",
        "xy",
        (low, None),
    )
    at, warned = found.soft
    page.text(
        "The rotation under a moment at the hub, against that when held plus moment over stiffness."
    )
    page.text(f"At {at:.0e} the program warns: {warned[0] if warned else ''}")


def answer(page: Page, rows: list[Record]) -> None:
    """State how soft the only restraint of a motion may be, and what the program says below."""
    safe = max(column(rows, "least safe"))
    errors = (np.array(column(rows, f"error of the {motion}")) for motion in MOTIONS)
    worst, warned = np.fmax(*errors), np.array(column(rows, "warnings")) > 0
    silent = int(((worst >= FOUR_DIGITS) & ~warned).sum())
    solved = min(row["ratio"] for row in rows if not row["refused"])
    page.answer(
        "How soft may a spring be that alone restrains a motion of a shaft?",
        "A motion is correct to four digits if its spring has at least "
        f"{formatted(safe, 2, '')} of the shaft's stiffness; the program "
        + (
            f"warns below {formatted(WEAK, 2, '')}."
            if silent == 0
            else f"does not warn of {silent} wrong results."
        ),
        [
            page.value("least stiffness for four correct digits, over the shaft's", safe),
            page.value("stiffness below which the program warns, over the shaft's", WEAK),
            page.value("least stiffness that the program accepts, over the shaft's", solved),
            page.value(
                "results without four correct digits and without a warning", silent, at_most=0.0
            ),
            page.value(
                "worst error if held rigidly, and moment over stiffness added",
                max(column(rows, "remedy")),
            ),
        ],
        hero=caption_of_errors(max(rows, key=lambda row: float(row["least safe"]))["joint"]),
        cautions=[
            "The shaft's stiffness is Young's modulus times length here; of several joints, the "
            "one that loses digits first counts.",
            "Only the softly held motion loses digits: one for every factor of ten in stiffness.",
        ],
    )


def caption_of_errors(joint: str) -> str:
    """Caption of the chart of one form of the joint."""
    return (
        f"Error of the hub's rotation over the softness of what holds it, {joint} joint; shaded: "
        "four digits, crosses: refused"
    )


@case(
    "Near-mechanisms: named, with the digits that they cost",
    source="statics of a shaft on a sphere; Higham 2002, Accuracy and stability of numerical "
    "algorithms, ch. 7",
)
def run(run: Run, page: Page) -> None:
    """Soften the springs that hold a shaft on a spherical bearing against turning."""
    rows: list[Record] = []
    joints = JOINTS[:1] if run.quick else JOINTS
    with run.step("mesh"):
        mesh = mesh_scene(scene_of("spherical", joints[0], rigid=()))
    for joint in joints:
        rows += sweep(run, page, joint, mesh)
    page.section("All points")
    page.table(
        "Errors of two motions, both with the same restraint",
        [{**row, "refused": row["refused"][:120]} for row in rows],
        [
            "joint",
            *(key for key in rows[0] if key not in ("joint", "least safe", "warned", "remedy")),
        ],
    )
    answer(page, rows)
    page.say(
        "The stiffness of a body is its Young's modulus times its length; the error is 2e-16 over "
        "the ratio of the two stiffnesses, within two digits, for each form of the joint.",
    )
    page.image("The shaft and its bearing, as meshed here", run.sketch(mesh))
