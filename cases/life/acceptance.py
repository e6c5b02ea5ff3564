"""Lives and their factors against MASTA, a catalogue, closed forms and printed numbers."""

from collections.abc import Sequence

import numpy as np

from fe_drivetrain.bearing import (
    Bearing,
    RollerRow,
    ball_row,
    catalogue_bearing,
    equilibrium,
    iso_line,
    lamina_loads,
    ratings,
)
from fe_drivetrain.bearing_life.life import (
    LifeRules,
    RowLoads,
    basic_life,
    combined_life,
    contamination_factor,
    damage_of_steps,
    equivalent_loads,
    lamina_life,
    life_factor,
    miner_load,
    needed_viscosity,
    rated_bearing,
    rigid_rings,
    row_loads,
    rows_of,
    steps_of,
    stress_riser,
    viscosity,
)
from fe_drivetrain.cases import case
from fe_drivetrain.comparison import as_printed
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.turbine_loads.histories import Site

MASTA = "MASTA, in the tests of a public implementation of ISO/TS 16281 (minzhun/ISO16281)"
STUDY = "MASTA, in a public study of a 26 MW drivetrain"
SKF = "SKF catalogue, example of bearing 6309, as quoted"
FORMS = "closed forms and numbers computed for this purpose from Stirling 2023"
ISO = "ISO 281, as public code has it: its own tables were not read"

#: Radial clearance [m], axial and radial force [N], L10r [million revolutions].
BALL = (
    (0.0, 0.0, 1e3, 13163.019),
    (0.0, 1e3, 0.0, 2222.7318),
    (1e-5, 0.0, 1e3, 10795.7948),
    (1e-5, 1e3, 0.0, 3115.8781),
    (1e-5, 1e3, 1e3, 1630.5367),
)

#: kappa, e_C C_u / P and a_ISO.
FACTORS = (
    (0.1, 0.05, 0.1),
    (0.4, 0.5, 0.2313),
    (1.0, 0.1, 0.3986),
    (1.0, 0.5, 1.7141),
    (2.0, 0.1, 0.5161),
    (2.0, 0.5, 3.0813),
    (4.0, 0.5, 5.5869),
)

#: Fx, Fz [N], My, Mz [N m] on bearing S, and its L10r [million revolutions] without a stress riser.
BEARING_S = (
    ((200e3, 0, -400e3, 800e3, 0), 15.5),
    ((200e3, 0, -400e3, -800e3, 0), 16.9),
    ((200e3, 0, -400e3, 0, 800e3), 18.3),
    ((100e3, 0, -400e3, -300e3, 0), 546.0),
)

C, FORCE, PITCH = 6.71e6, 400e3, 0.7874
ONES = np.ones(30)


@case(
    "Rating lives against MASTA, a catalogue, closed forms and printed numbers",
    source="MASTA in public tests and a public study; SKF; ISO 281 second-hand; Stirling 2023",
)
def run(run: Run, page: Page) -> None:
    """Numbers that lives have to meet, and which of them no source confirms."""
    with run.step("against MASTA"):
        ball, tapered = masta(page)
    with run.step("printed numbers"):
        printed(page)
        sites(page)
    with run.step("closed forms"):
        closed_forms(page)
        bearing_s(page)
    with run.step("edge stress"):
        edge_stress(page)
    not_confirmed(page)
    answer(page, 100.0 * ball, 100.0 * tapered)


HERO = "Lives and ratings: difference from MASTA, SKF and printed numbers"


def answer(page: Page, ball: float, tapered: float) -> None:
    """State how far lives and ratings [%] are from those of others."""
    two = "F_a 1, F_r 1 kN, clearance 10 um: L10r"
    single = [
        page.judged(
            two, "reference life, ball bearing, axial and radial load", "MASTA", "1630.5367"
        ),
        page.judged("tapered main bearing: C", "dynamic rating C, main bearing", "MASTA"),
        page.judged("tapered main bearing: C_u", "fatigue limit C_u, main bearing", "MASTA"),
    ]
    more = [
        page.judged("SKF 6309, C 55.3 and P 10 kN: L10", "basic life, SKF 6309", "SKF", "169"),
        page.judged(
            "cylindrical bearing N305, with edge stress: L10r",
            "life with edge stress, N305",
            "public code",
        ),
    ]
    independent = sum(check.basis != "self-consistency" for check in page.checks)
    agree = all(check.passed for check in page.checks)
    page.answer(
        "Do rating lives of bearings agree with other programs, catalogues and closed forms?",
        f"{'All' if agree else 'Not all of'} {independent} values agree: lives of a ball bearing "
        f"with MASTA within {ball:.2g}\u00a0%, ratings of a tapered main bearing within "
        f"{tapered:.2g}\u00a0%.",
        [
            page.value(
                f"largest difference of {len(BALL)} ball-bearing lives [%]", ball, at_most=0.1
            ),
            *single,
            *more,
        ],
        hero=HERO,
        cautions=[
            "Constants of ISO 281 are those of public code; some are from memory, and no source "
            "confirms them: see the table."
        ],
    )
    page.section("Beside others")
    page.errors(HERO, [*single, *more])
    page.say(
        "A viscosity that SKF reads from a diagram differs from the formula of ISO 281: see the "
        "table."
    )


def masta(page: Page) -> tuple[float, float]:
    """Ball bearing, ratings of a tapered one, contamination factors; largest errors of both."""
    lives: list[float] = []
    for clearance, axial, radial, life in BALL:
        row = ball_row(7, 0.0115, 0.0435, radial_clearance=clearance, youngs_modulus=210e9)
        rated = rated_bearing(Bearing("ball", (row,)), 23400.0)
        steps = next(steps_of(rigid_rings(rated.bearing), [axial, -radial, 0, 0, 0], 1000.0, 60.0))
        what = f"F_a {axial / 1e3:g}, F_r {radial / 1e3:g} kN, clearance {1e6 * clearance:g} um"
        own = damage_of_steps(steps, rated, LifeRules()).lives("Mrev")["L10r"]
        lives.append(abs(own / life - 1.0))
        page.equals(
            f"{what}: L10r [Mrev]",
            own,
            life,
            within=1e-3,
            why="Hertz's exact stiffness here, a rounded one there: life goes with its third power",
            source=MASTA,
        )
    found = ratings(catalogue_bearing("masta_single"))
    printed_by = (("C", found.dynamic, 22227978.9), ("C_u", found.fatigue, 3929016.7))
    for name, own, theirs in printed_by:
        page.equals(
            f"tapered main bearing: {name} [kN]",
            own / 1e3,
            theirs / 1e3,
            within=1e-3,
            why="f_c from the formula behind ISO 281's rounded table",
            source=STUDY,
            measure="reaction",
        )
    page.equals(
        "e_C: grease, slight to typical, D_pw 3329 mm",
        float(contamination_factor(1.0, 3.3286, "grease", "slight to typical")),
        0.888378,
        within=1e-3,
        why="the study does not name its class, and the next one is apart by more than that",
        source=STUDY,
        basis="second-hand",
    )
    page.equals(
        "e_C: oil bath, kappa 3.413, D_pw 51.56 mm",
        float(contamination_factor(3.413, 0.05156, "oil bath", "-/13/10")),
        **as_printed("0.8174"),
        source="MASTA, bearing HR30306J, quoted in public code, which names the class -/15/12",
        basis="second-hand",
    )
    return max(lives), max(abs(own / theirs - 1.0) for _, own, theirs in printed_by)


def printed(page: Page) -> None:
    """Tables and examples."""
    for kappa, ratio, a in FACTORS:
        page.equals(
            f"a_ISO of rollers at kappa {kappa:g}, e_C C_u / P {ratio:g}",
            float(life_factor(ratio, kappa)),
            a,
            within=5.1e-5,
            relative=False,
            why="half of the last of the four decimals that are stated",
            source=ISO,
            basis="second-hand",
        )
    L10 = float(basic_life(55.3, 10.0, 3.0))
    hours = float(basic_life(55.3, 4.0, 3.0)) * 1e6 / (60 * 1800)
    P = miner_load([10.0, 20.0], [0.9, 0.1])
    for name, own, value, source in (
        ("SKF 6309, C 55.3 and P 10 kN: L10 [Mrev]", L10, "169", SKF),
        ("SKF 6309 at 3000 1/min: L10h [h]", L10 * 1e6 / (60 * 3000), "940", SKF),
        ("SKF 6309, P 4 kN at 1800 1/min: L10h [h]", hours, "2.45e4", SKF),
        (
            "lives of 100 and 200, slope 9/8",
            float(combined_life([100.0, 200.0])),
            "71.4998",
            FORMS,
        ),
        (
            "lives of 100 and 200, slope 10/9",
            float(combined_life([100.0, 200.0], 10 / 9)),
            "71.0063",
            FORMS,
        ),
        ("Miner's mean of loads 10 and 20, 90 and 10 % of the turns", P, "12.13862", FORMS),
        ("its life, C 100 [Mrev]", float(basic_life(100.0, P)), "1129.196", FORMS),
        (
            "VG 460 at 60 degC [mm2/s]",
            float(viscosity(60.0, ((40.0, 460.0), (100.0, 30.5)))),
            "147.8",
            FORMS,
        ),
        (
            "nu_1 at 18 1/min, D_pw 787.4 mm [mm2/s]",
            float(needed_viscosity(18.0, PITCH)),
            "145.6",
            FORMS,
        ),
    ):
        page.equals(
            name,
            own,
            **as_printed(value),
            source=source,
            basis="second-hand",
        )


def sites(page: Page) -> None:
    """Weights of winds, and the stress riser."""
    edges = np.arange(3.0, 26.0, 2.0)
    for mean, scale, whole in (
        (8, "9.0270", "0.89497"),
        (10, "11.2838", "0.92437"),
        (12, "13.5406", "0.91902"),
    ):
        site = Site(mean)
        for name, own, value in (
            ("scale C [m/s]", site.scale, scale),
            ("sum of W over 3 to 25 m/s", float(site.shares(edges).sum()), whole),
        ):
            page.equals(
                f"Weibull, mean wind {mean:g} m/s: {name}",
                own,
                **as_printed(value),
                source="Stirling 2023, eqs 5.22 and 5.23 (C of 10 m/s printed as 11.28)",
                basis="second-hand",
            )
    shares = Site(8.0).shares(edges)
    for place, wind, value in ((0, 4, "0.15963"), (4, 12, "0.10084"), (10, 24, "0.00105")):
        page.equals(
            f"Weibull, mean wind 8 m/s: W of {wind} m/s",
            float(shares[place]),
            **as_printed(value),
            source="Stirling 2023, eq. 5.22",
            basis="second-hand",
        )
    for k, value in ((0, "2.3283"), (1, "1.1266"), (2, "1.0641"), (3, "1.0418"), (14, "1.0030")):
        page.equals(
            f"stress riser of lamina {k + 1} of 30",
            float(stress_riser(30)[k]),
            **as_printed(value),
            source="ISO/TS 16281 as Stirling 2023, eq. 5.5, prints it",
            basis="second-hand",
        )


def rows_under(
    loads: Sequence[float], name: str = "bearing_s", edge: float = 0.83
) -> list[RowLoads]:
    """Rows of bearing S under one load, without a stress riser."""
    bearing = catalogue_bearing(name)
    found = equilibrium(bearing, [*loads], tolerance=1e-12)
    return rows_of(bearing, found.displacements, C, edge=edge, riser=ONES)


def closed_forms(page: Page) -> None:
    """Pure radial load, homogeneity, equal rows, limits of the factor."""
    radial = (0, 0, -FORCE, 0, 0)
    for name in ("bearing_s", "bearing_s_o20"):
        for edge, value, digits in ((1.0, 0.989, 3e-4), (0.83, 2.084, 1e-3)):
            page.equals(
                f"{name}, radial load: L10r (P / C)^4 with lambda nu {edge:g}",
                float(lamina_life(rows_under(radial, name, edge))[0]) * (FORCE / C) ** 4,
                value,
                within=digits,
                why="0.9889 to 0.9893 for two geometries; three digits are stated",
                source=FORMS,
                basis="second-hand",
            )
        rows = rows_under(radial, name)
        P = float(equivalent_loads(rows[0])[0, 14])
        page.equals(
            f"{name}, radial load: P_ks over the row's load",
            P / (0.5 * FORCE),
            0.868,
            within=1.5e-3,
            why="0.8678 and 0.8689 for two geometries; three digits are stated",
            source=FORMS,
            basis="second-hand",
        )
        alone = float((lamina_life(rows) / lamina_life(rows[:1]))[0])
        _identity(page, f"{name}: life of two equal rows over that of one", alone, 2 ** (-8 / 9))
    loads = np.array(BEARING_S[0][0])
    lives = [float(lamina_life(rows_under((s * loads).tolist()))[0]) for s in (1.0, 2.0)]
    _identity(page, "all loads doubled: L10r falls to a sixteenth", lives[1] / lives[0], 1 / 16)
    _identity(page, "a_ISO with e_C = 0", float(life_factor(0.0, 2.0)), 0.1)
    _identity(page, "a_ISO of a vanishing load", float(life_factor(np.inf, 2.0)), 50.0)
    _identity(
        page, "a_ISO above kappa = 4", float(life_factor(0.5, 9.0) / life_factor(0.5, 4.0)), 1
    )


def bearing_s(page: Page) -> None:
    """Lives of bearing S under four loads."""
    for loads, life in BEARING_S:
        page.equals(
            f"bearing S, F {[round(v / 1e3) for v in loads]} kN, kN m: L10r [Mrev]",
            float(lamina_life(rows_under(loads))[0]),
            life,
            within=1e-2,
            why="three digits are stated, of laminae whose number is not",
            source="an independent computation of bearing S, 38 deg, face to face",
            basis="second-hand",
        )


def edge_stress(page: Page) -> None:
    """A cylindrical bearing whose edge stress counts: one roller carries all."""
    row = RollerRow(6, 0.0, 0.02175, 0.0, 0.009, 0.0136, iso_line(0.0136), 5e-6, 40)
    found = equilibrium(Bearing("N305", (row,)), [0.0, 1e3, 0.0, 0.0, 0.0], tolerance=1e-12)
    loads = lamina_loads(row, found.displacements)
    capacity = 31500.0
    life = float(lamina_life([row_loads(row, loads, capacity)])[0])
    for name, value, printed in (
        ("L10r [Mrev]", life, "160603"),
        ("P_ref [N]", capacity / life**0.3, "864.14"),
        ("largest load of a lamina [N]", float(loads.max()), "25.000"),
    ):
        page.equals(
            f"cylindrical bearing N305, with edge stress: {name}",
            value,
            **as_printed(printed),
            source="minzhun/ISO16281, its stress riser of the outer race put right: it takes that "
            "of the inner one in place of the lamina's number, and has 96547 Mrev",
            basis="second-hand",
        )


def not_confirmed(page: Page) -> None:
    """What is from memory, and what does not agree."""
    page.section("What no source confirms")
    nu_1 = float(needed_viscosity(3000.0, 0.0725))
    rows: list[Record] = [
        {"what": what, "state": state}
        for what, state in (
            (
                "nu_1 of SKF's example, 3000 1/min and d_m 72.5 mm: 8.15 mm2/s printed, kappa 2.45",
                f"ISO 281's formula gives {nu_1:.3g}, kappa {20 / nu_1:.3g}; SKF has a diagram",
            ),
            (
                "contamination in grease: c1 and c2 of five classes",
                "from memory; one e_C of MASTA fits 'slight to typical' above 500 mm",
            ),
            (
                "contamination in oil: c1 and c2 of nine classes",
                "from memory; one e_C of MASTA fits the first pair of the oil bath; public code "
                "has other constants for the others",
            ),
            (
                "a_ISO of balls",
                "public code, but for 0.19087, where it has 0.019087: that is not continuous",
            ),
            ("a_SKF 8 of the example, 7520 h", "second-hand, not computed: SKF's own factor"),
            ("b_m = 1.15 of spherical rollers", "from memory, and no rating to set beside it"),
            (
                "X, Y and e of angular contact, Y_0, C_0 / C_u = 22 of balls",
                "from memory; those of rollers and deep grooves agree with public code",
            ),
            (
                "viscosity at 100 degC of greases",
                "from memory of data sheets; those at 40 degC are Stirling's",
            ),
        )
    ]
    page.table("Numbers from memory, or that do not agree", rows)
    page.data("not confirmed", rows)


def _identity(page: Page, name: str, own: float, value: float) -> None:
    page.equals(
        name,
        own,
        value,
        within=1e-7,
        why="exact but for the tolerance of the equilibrium",
        source="the equations themselves",
        basis="self-consistency",
    )
