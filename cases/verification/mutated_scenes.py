"""Five hundred scenes that are wrong at random: refused in one sentence, or right by physics."""

from collections import Counter

from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification import scene_mutants
from fe_drivetrain.cases.verification.scene_mutants import Outcome
from fe_drivetrain.report import bars
from fe_drivetrain.report.suite import Page, Record, Run

SEED = 43
COUNT, QUICK_COUNT = 500, 60
#: One in so many of those that are taken is answered by level 2, too, or built in CAD.
MERIDIAN, QUICK_MERIDIAN = 15, 40
CAD, QUICK_CAD = 3, 6

BY_CHANGE = "Mutants by kind of change: refused in one sentence, or taken and right"
FACTS = {
    "equilibrium": "reactions balance the hub loads about the hub",
    "statics": "reactions that equilibrium alone decides are those of level 0",
    "symmetry": "motions are reciprocal (Maxwell)",
    "positive": "no load does negative work",
    "Hooke": "all that gives twice as stiff: motions are halved",
    "modulus": "a determinate scene's reactions do not depend on any stiffness",
    "mass": "supports carry the masses of frustums, rings and blocks",
}


@case(
    "Mutated scenes: each refused in one sentence, or answered as physics has it",
    source="equilibrium; Maxwell 1864 (reciprocity); Hooke's law; volumes of plain solids",
    settings={"count": "500 (quick 60; from 15)", "seed": "43 (from 0)"},
)
def run(run: Run, page: Page) -> None:
    """Change scenes of the library at random, read them, and hold what is taken against facts."""
    count = run.count("count", QUICK_COUNT if run.quick else COUNT, least=15)
    seed = run.count("seed", SEED, least=0)
    meridian = QUICK_MERIDIAN if run.quick else MERIDIAN
    cad = QUICK_CAD if run.quick else CAD
    found: list[Outcome] = []
    run.report(f"{count} mutants")
    with run.step("mutants"):
        for mutant in scene_mutants.mutants(count, seed):
            k = sum(not outcome.sentence for outcome in found)
            found.append(scene_mutants.judged(mutant, meridian=k % meridian == 0, cad=k % cad == 0))
    taken = [o for o in found if not o.sentence]
    worst = worst_errors(taken)
    check(page, found, worst)
    page.seed = seed
    answer(page, found, worst)
    show(page, found, worst)


def worst_errors(taken: list[Outcome]) -> dict[str, tuple[float, str]]:
    """The largest error over what round-off allows by fact, and the mutant that has it."""
    worst: dict[str, tuple[float, str]] = {}
    for outcome in taken:
        for fact, error in outcome.errors.items():
            if not error <= worst.get(fact, (-1.0, ""))[0]:
                worst[fact] = (error, f"{outcome.mutant.library}: {outcome.mutant.change}")
    return worst


def answer(page: Page, found: list[Outcome], worst: dict[str, tuple[float, str]]) -> None:
    """State what became of the mutants, and how far the facts were from being broken."""
    faults = sum(bool(o.faults) for o in found)
    refused = sum(bool(o.sentence) and not o.faults for o in found)
    taken, most = len(found) - refused - faults, max(error for error, _ in worst.values())
    page.answer(
        "What happens to a drivetrain file that is wrong in one place?",
        f"Of {len(found)} files with one change, {refused} are rejected with one sentence, {taken} "
        f"are read and {'obey' if most <= 1 else 'do not all obey'} mechanics, {faults} fail "
        "otherwise.",
        [
            page.value("files that fail otherwise", faults, at_most=0),
            page.value("files rejected with one sentence", refused),
            page.value("files that are read", taken),
            page.value("largest error in a law of mechanics, over round-off", most, at_most=1.0),
            page.value("laws of mechanics that are checked", len(worst)),
        ],
        hero=BY_CHANGE,
        cautions=[
            "Files that are read are checked by laws of mechanics: what their author meant is "
            "unknown."
        ],
    )


def check(page: Page, found: list[Outcome], worst: dict[str, tuple[float, str]]) -> None:
    """No faults, facts within round-off, and enough of both kinds."""
    refused = sum(bool(o.sentence) for o in found)
    page.vanishes(
        "mutants that are neither refused in one sentence nor taken by every later step",
        sum(bool(o.faults) for o in found),
        within=0.0,
        why="a user's mistake is one sentence, and the same one wherever the scene is used",
        source="counted over all mutants",
    )
    for fact, (error, _) in sorted(worst.items()):
        page.at_most(
            f"{fact}, {FACTS[fact.partition(': ')[2]]}: worst error over what round-off may change",
            error,
            1.0,
            why=f"{scene_mutants.ROUNDINGS} roundings times the condition of the motions, at most "
            f"{scene_mutants.MAXIMUM:g} of the largest",
            source="independent of the solver: statics, Maxwell, Hooke, volumes",
        )
    page.holds(
        "a quarter of the mutants or more is refused, and as many are taken",
        min(refused, len(found) - refused) >= len(found) / 4,
        why="a mutation that never hurts, or always does, would try one side alone",
        source="counted",
    )


def show(page: Page, found: list[Outcome], worst: dict[str, tuple[float, str]]) -> None:
    """Counts by kind of change, worst mutants, samples of refusals, faults."""
    by_kind: dict[str, Counter[str]] = {}
    for outcome in found:
        fate = "fault" if outcome.faults else "refused" if outcome.sentence else "taken"
        by_kind.setdefault(outcome.mutant.kind, Counter())[fate] += 1
    rows: list[Record] = [
        {"change": kind, **{fate: counts[fate] for fate in ("refused", "taken", "fault")}}
        for kind, counts in sorted(by_kind.items())
    ]
    page.section("What becomes of the mutants")
    page.add(
        bars(
            BY_CHANGE,
            {
                fate: {row["change"]: row[fate] for row in rows}
                for fate in ("refused", "taken", "fault")
            },
            "mutants",
            stacked=True,
        )
    )
    page.table("Mutants by kind of change", rows)
    page.table(
        "Facts, and the mutant that is farthest from each",
        [
            {"fact": fact, "error over round-off": error, "mutant": mutant}
            for fact, (error, mutant) in sorted(worst.items())
        ],
    )
    if faults := [o for o in found if o.faults]:
        page.table(
            "Faults",
            [
                {"scene": o.mutant.library, "change": o.mutant.change, "fault": "; ".join(o.faults)}
                for o in faults
            ],
        )
    page.section("Refusals")
    page.table(
        "Some of the sentences",
        [
            {"scene": o.mutant.library, "change": o.mutant.change, "sentence": o.sentence}
            for o in [o for o in found if o.sentence][:30]
        ],
    )
    page.data("mutants by kind of change", rows)
