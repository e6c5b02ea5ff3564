"""Short and long numbers: how many digits of a stiffness survive over L/D and the mesh."""

from collections.abc import Mapping

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.solid_shafts import straight
from fe_drivetrain.cases.stability import other_precisions
from fe_drivetrain.cases.stability.other_precisions import BORE, DIAMETER
from fe_drivetrain.common import Floats
from fe_drivetrain.common.arrays import rounded
from fe_drivetrain.comparison import FOUR_DIGITS, in_words, safe_range
from fe_drivetrain.report import crosses, trace
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run, column

LOADS = ("bending", "torsion")

#: What round-off takes, as powers of L/D, where elements are as many at any length: the energy of
#: a rigid motion of the far end, E L u^2, over that of bending, 3 E I u^2 / L^3, and of torsion.
EXPONENTS = {"bending": 4.0, "torsion": 2.0}

#: Precisions, with their names in tables and in limits.
SHORT, DOUBLE, MIXED, LONG = "32", "64", "32 refined by 64", "64 refined by 80"
LIMITS = {SHORT: "32 bits", DOUBLE: "64 bits", MIXED: "32 bits, refined with residuals of 64"}
PROGRAM = "the program"
SLOPE = "{}, 64 bits: error against L/D, exponent"


def key(load: str, precision: str) -> str:
    """Key of a record: the relative error of a stiffness."""
    return f"{load}, {precision}"


def solve(L_over_D: float, turn: int, along: int) -> Record:
    """Relative errors of one tube by load and precision, and the program's own residual."""
    solid = other_precisions.tube(L_over_D, turn, along)
    short, double, long = (
        other_precisions.summed(solid, kind) for kind in (np.float32, np.float64, np.longdouble)
    )
    best = other_precisions.refined(long, double, solid.load, 14)
    exact = other_precisions.compliances(solid, best)
    program, residual = other_precisions.by_the_program(double, solid.load)
    solutions = {
        SHORT: other_precisions.solved(short, solid.load),
        DOUBLE: other_precisions.solved(double, solid.load),
        MIXED: other_precisions.refined(double, double.astype(np.float32), solid.load, 20),
        LONG: other_precisions.refined(long, double, solid.load, 10),
        PROGRAM: program,
    }
    row: dict[str, float] = {"L/D": L_over_D, "unknowns": len(solid.free)}
    errors = {
        name: np.abs((other_precisions.compliances(solid, u) / exact - 1.0).astype(float))
        for name, u in solutions.items()
    }
    for k, load in enumerate(LOADS):
        row |= {key(load, name): float(error[k]) for name, error in errors.items()}
    return row | {"the program's residual": residual}


@case(
    "Short and long numbers: digits of a stiffness over L/D and the mesh",
    source="Higham 2002, Accuracy and stability of numerical algorithms, ch. 12; Melosh 1969, "
    "Manipulation errors in finite element analysis; IEEE 754",
)
def run(run: Run, page: Page) -> None:
    """Assemble and solve tubes in 32, 64 and 80 bits."""
    turn, along = (4, 10) if run.quick else (8, 10)
    rows: list[Record] = []
    for value in 10.0 ** np.arange(0.0, 3.34, 1.0 / (1.5 if run.quick else 3.0)):
        with run.step("tubes of 32, 64 and 80 bits"):
            run.report(f"L/D = {value:.3g}")
            rows.append(solve(float(value), turn, min(along, max(2, round(4 * value)))))
    meshes = ((4, 5), (8, 10)) if run.quick else ((4, 5), (8, 10), (12, 15))
    with run.step("meshes"):
        refined = [solve(4.0, *mesh) for mesh in meshes]
    highest = {load: compare(run, page, rows, load) for load in LOADS}
    check_refusal_and_refinement(page, rows)
    page.section("All points")
    page.table(
        "Relative errors; the last rows are meshes of one length. 64 refined by 80: what the last "
        "four of fourteen steps of refinement changed",
        [
            {name: value if np.isfinite(value) else None for name, value in row.items()}
            for row in [*rows, *refined]
        ],
        [name for name in rows[0] if PROGRAM not in name or "residual" in name],
    )
    page.text(
        "The reference is the solution with residuals of 80 bits on the same mesh; an error above "
        "1 leaves no digit. Assembly, sums and factor are all in the precision named; the nodes "
        "have coordinates of 32 bits in each, so that all solve the same solid. The number of "
        "elements does not depend on the length from three diameters on: their own error is the "
        "same in each precision and not in the comparison."
    )
    page.data("slenderness and relative errors", rows)
    answer(page, rows, highest)
    digits = {
        precision: -np.log10(np.maximum(column(refined, key("bending", precision)), 1e-17))
        for precision in (SHORT, DOUBLE)
    }
    page.say(
        "Round-off takes the fourth power of L/D in bending and the second in torsion; the mesh "
        f"matters little: {digits[SHORT].min():.1f} to {digits[SHORT].max():.1f} digits of bending "
        f"in 32 bits and {digits[DOUBLE].min():.1f} to {digits[DOUBLE].max():.1f} in 64 on "
        f"{len(meshes)} meshes of L/D = 4.",
        "A factor in 32 bits with residuals in 64 gives all digits back up to L/D = "
        f"{in_words(highest['bending'][MIXED])}.",
    )
    page.image(
        "A tube of four diameters", run.sketch(straight((0.0, 4.0 * DIAMETER), DIAMETER, BORE))
    )


def answer(page: Page, rows: list[Record], highest: dict[str, dict[str, float | None]]) -> None:
    """State the longest tubes with four digits in 64 and in 32 bits."""
    longest = max(column(rows, "L/D"))

    def reach(load: str, precision: str) -> str:
        high = highest[load][precision]
        return formatted(longest if high is None else high, 3)

    answers = np.array(column(rows, key("bending", PROGRAM)))
    page.answer(
        "How slender may a solid body be before round-off spoils its stiffness?",
        "The program computes with 64 bits: a tube's bending stiffness is correct to four digits "
        f"up to L/D\u00a0=\u00a0{reach('bending', DOUBLE)}; with 32 bits, only up to "
        f"L/D\u00a0=\u00a0{reach('bending', SHORT)}.",
        [
            *(
                page.value(
                    f"largest L/D for four correct digits, {load}, {LIMITS[precision]}",
                    rounded([high], 3)[0],
                )
                for load, precision in (
                    ("bending", DOUBLE),
                    ("bending", SHORT),
                    ("bending", MIXED),
                    ("torsion", SHORT),
                )
                if (high := highest[load][precision]) is not None
            ),
            page.judged(SLOPE.format("bending"), "exponent of L/D in the error, bending", "theory"),
            page.value(
                "worst error of a result that the program gives, bending",
                float(answers[np.isfinite(answers)].max()),
                at_most=1e-2,
                by="program",
            ),
        ],
        hero=caption_of_errors("bending"),
        cautions=[
            "L/D is length over diameter. The error is that of round-off alone; finer meshes "
            "hardly change it."
        ],
    )


def caption_of_errors(load: str) -> str:
    """Caption of the chart of one load."""
    return (
        f"Error of a tube's stiffness in {load} over its slenderness, by precision; shaded: four "
        "digits in 64 bits, crosses: the program refuses"
    )


def compare(run: Run, page: Page, rows: list[Record], load: str) -> dict[str, float | None]:
    """Precisions under one load: checks, limits, chart; the longest tube safe in each."""
    slenderness = np.array(column(rows, "L/D"))
    of = {
        precision: np.array(column(rows, key(load, precision)))
        for precision in (SHORT, DOUBLE, MIXED, LONG, PROGRAM)
    }
    check(page, load, slenderness, of, 0.3 if run.quick else 0.15)
    highest = state_limits(page, load, slenderness, of)
    show(page, load, slenderness, of, highest[DOUBLE])
    return highest


def check(
    page: Page, load: str, slenderness: Floats, of: Mapping[str, Floats], within: float
) -> None:
    """Check how the error grows with slenderness, and falls with the number of bits."""
    usable = (of[LONG] < 0.1 * of[DOUBLE]) & (slenderness >= 2.0)
    page.exponent(
        SLOPE.format(load),
        slenderness[usable],
        of[DOUBLE][usable],
        EXPONENTS[load],
        within=within,
        between=(1e-15, 0.1),
        why="round-off scatters by about a decade from point to point, which leaves 0.1 of a slope "
        "through ten points over three decades: three times that of an exponent of 2, and twice as "
        "much through the five points of a quick run",
        source="energy of a rigid motion of the end over that of the deformation",
    )
    both = (of[SHORT] < 0.1) & (of[DOUBLE] > 0.0)
    decades_apart = np.log10(of[SHORT][both] / of[DOUBLE][both])
    page.equals(
        f"{load}: digits between 32 and 64 bits, mean [digits]",
        decades_apart.mean(),
        float(29 * np.log10(2.0)),
        within=1.0,
        relative=False,
        why="round-off scatters by about a decade",
        source="29 bits more of the mantissa",
        measure="identity",
        band=decades_apart.std() / np.sqrt(len(decades_apart)),
    )


def state_limits(
    page: Page, load: str, slenderness: Floats, of: Mapping[str, Floats]
) -> dict[str, float | None]:
    """State the maximum slenderness with four digits in each precision; return it."""
    highest: dict[str, float | None] = {}
    for precision, name in LIMITS.items():
        try:
            highest[precision] = safe_range(slenderness, of[precision], FOUR_DIGITS)[1]
        except ValueError:  # not even the shortest
            highest[precision] = 0.0
        in_double = precision == DOUBLE
        page.limit(
            f"direct solution in {name}: {load}",
            "L/D of a tube",
            high=highest[precision],
            criterion="error of the stiffness below 1e-4",
            beyond=f"the error grows as (L/D)^{EXPONENTS[load]:.0f}"
            if precision != MIXED
            else "refinement no longer converges, and answers are of any size",
            program="computes in 64 bits throughout; refuses a residual above 1e-2"
            if in_double
            else "never computes in 32 bits",
            remedy=f"residuals of 80 bits: right to {of[LONG].max():.0e} here; beam or meridian, "
            "which condense before they add"
            if in_double
            else "64 bits",
        )
    return highest


def show(
    page: Page, load: str, slenderness: Floats, of: Mapping[str, Floats], high: float | None
) -> None:
    """Show the errors of all precisions; 64 bits are safe up to the slenderness `high`."""
    answered = np.isfinite(of[PROGRAM])

    def clipped(precision: str) -> Floats:
        error = of[precision]
        return np.asarray(np.clip(np.where(np.isfinite(error), error, 10.0), 1e-17, 10.0))

    dashed = {"dash": "dash"}
    page.section(load.capitalize())
    page.chart(
        caption_of_errors(load),
        [
            trace("32 bits", slenderness, clipped(SHORT)),
            trace("64 bits", slenderness, clipped(DOUBLE)),
            trace("factor of 32 bits, residuals of 64", slenderness, clipped(MIXED), line=dashed),
            trace(
                "factor of 64 bits, residuals of 80, two counts of steps",
                slenderness,
                clipped(LONG),
                line=dashed,
            ),
            trace(PROGRAM, slenderness[answered], clipped(PROGRAM)[answered], True),
            crosses("the program refuses", slenderness[~answered]),
        ],
        "L/D",
        "relative error",
        "xy",
        (None, high),
    )


def check_refusal_and_refinement(page: Page, rows: list[Record]) -> None:
    """What the program lets pass, and what residuals in 64 bits make of a factor in 32."""
    short, mixed, long, program = (
        np.array(column(rows, key("bending", name))) for name in (SHORT, MIXED, LONG, PROGRAM)
    )
    answered = np.isfinite(program)
    page.at_most(
        "bending: the worst answer that the program gives without refusing",
        program[answered].max(),
        1e-2,
        why="a residual of 1e-2 is what it refuses; of a slender solid the error is no more",
        source="residuals of 80 bits",
        measure="identity",
        band=long[answered].max(),
    )
    usable = short < 0.1
    page.at_most(
        "bending: 32 bits refined with residuals of 64, worst error where 32 bits have a digit",
        mixed[usable].max(),
        FOUR_DIGITS,
        why="refinement converges where the factor has a digit; four digits of stiffness",
        source="residuals of 80 bits",
        measure="identity",
        band=long[usable].max(),
    )
