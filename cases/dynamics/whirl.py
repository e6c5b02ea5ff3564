"""Whirl of a drivetrain's shafts: each by itself between two bounds, and in the whole one."""

from dataclasses import replace

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.dynamics import machine_of
from fe_drivetrain.dynamics.whirl import stability_limit, whirl_modes
from fe_drivetrain.pages import show_whirl
from fe_drivetrain.report import marked
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Run
from fe_drivetrain.studies import ShaftRotor, ShaftWhirl, WhirlResult, shaft_rotors, whirl

RPM = np.pi / 30.0
DEFAULT = "grc_750kw"
LUMPED = 1e-3
"""Relative error of a main shaft of six elements of lumped mass, by 12 and 24 elements."""
DAMPED = "Stability of {}: speed from which whirl grows over its first forward critical speed"
SHARES = (0.0, 1e-3, 3e-3, 1e-2, 3e-2)
"""Damping of bearings over their stiffness times that of the shaft over its own."""


@case(
    "Whirl of a drivetrain's shafts",
    source="GRC 750 kW gearbox, NREL/TP-5000-51885; closed forms and the whole drivetrain",
    settings={"drivetrain": "FILE, or a name of the library (otherwise grc_750kw)"},
)
def run(run: Run, page: Page) -> None:
    """Critical speeds of each shaft, against the whole drivetrain and by two ways."""
    chosen = run.drivetrain(DEFAULT)
    chosen.state(page, topic="Whirl of its shafts")
    with run.step("whirl"):
        result = whirl(chosen.drivetrain)
        rotors = shaft_rotors(machine_of(chosen.drivetrain), chosen.drivetrain.whirl)
    page.about(chosen.drivetrain)
    main = result.shafts[0]
    check_ways(page, result)
    check_rest(page, rotors)
    if not chosen.own:
        check_bounds(page, main)
    answer(page, result)
    show_whirl(run, page, result)
    with run.step("damping"):
        show_damping(page, rotors[0], main, SHARES[1::2] if run.quick else SHARES)


def check_ways(page: Page, result: WhirlResult) -> None:
    """One eigenproblem against the Campbell diagram."""
    for shaft in result.shafts:
        pairs = [
            (one.speed, other.speed)
            for one, other in zip(shaft.criticals, shaft.crossings, strict=False)
        ]
        page.holds(
            f"{shaft.name}: as many critical speeds by one eigenproblem as in the Campbell diagram",
            len(shaft.criticals) == len(shaft.crossings),
            why="both have all of them",
            source="crossings by bisection",
        )
        page.vanishes(
            f"{shaft.name}: difference of critical speeds by both ways",
            max((abs(one / other - 1) for one, other in pairs), default=0.0),
            within=1e-6,
            why="round-off of eigenproblems on stiff supports",
            source="crossings by bisection",
            basis="self-consistency",
        )


def check_rest(page: Page, rotors: list[ShaftRotor]) -> None:
    """At rest, a shaft on bearings that are equal in both planes has pairs of frequencies."""
    for shaft in rotors:
        rotor = shaft.rotor()
        equal = tuple(
            replace(one, stiffness=_equal_planes(one.stiffness)) for one in rotor.bearings
        )
        modes = whirl_modes(replace(rotor, bearings=equal), 0.0)
        count = 2 * (min(len(modes.frequencies), 8) // 2)
        pairs = modes.frequencies[:count].reshape(-1, 2)
        page.vanishes(
            f"{shaft.name}, bearings equal in both planes: difference of the frequencies of each "
            "pair at rest",
            float(np.abs(pairs[:, 1] / pairs[:, 0] - 1).max()),
            within=1e-6,
            why="round-off of eigenproblems on stiff supports",
            source="symmetry",
            basis="self-consistency",
        )


def _equal_planes(stiffness: np.ndarray) -> np.ndarray:
    """Stiffness (k, 4, 4) with the mean of both planes in each."""
    one = (stiffness[:, :2, :2] + stiffness[:, 2:, 2:]) / 2
    found = np.zeros_like(stiffness)
    found[:, :2, :2] = found[:, 2:, 2:] = one
    return found


def check_bounds(page: Page, main: ShaftWhirl) -> None:
    """The main shaft in the whole drivetrain, between its bounds."""
    if main.first is None or main.without_meshes is None or main.in_drivetrain is None:
        return
    low, high = main.without_meshes / RPM, main.first.speed / RPM
    page.between(
        f"{main.name}: first critical speed that unbalance excites, in the whole drivetrain [rpm]",
        main.in_drivetrain / RPM,
        low * (1 - LUMPED),
        high * (1 + LUMPED),
        why="neighbours that move hold a shaft less than those that stand still, and more than "
        "none; the whole has masses at the nodes of six elements, by 0.1 % at most",
        source="the shaft by itself, its meshes open and against neighbours that stand still",
    )


def answer(page: Page, result: WhirlResult) -> None:
    """State how far critical speeds are from operation, and what neighbours change."""
    nearest, main = min(result.shafts, key=lambda one: one.margin), result.shafts[0]
    figures = []
    for shaft in dict.fromkeys((nearest, main)):
        if shaft.first is not None:
            name = f"first critical speed of {shaft.name} that unbalance excites [rpm]"
            figures.append(page.value(name, shaft.first.speed / RPM))
    if np.isfinite(nearest.margin):
        name = f"smallest margin of operation to a critical speed, {nearest.name} [%]"
        margin = 100.0 * nearest.margin
        figures.append(page.value(name, margin, at_least=10.0, by="margin asked for"))
    if main.in_drivetrain is not None and main.first is not None:
        apart = 100.0 * abs(main.in_drivetrain / main.first.speed - 1)
        name = f"change of the critical speed of {main.name} in the whole drivetrain [%]"
        figures.append(page.value(name, apart))
    figures.append(page.value("shafts computed", len(result.shafts)))
    page.answer(
        result.answer.question,
        result.answer.verdict,
        figures,
        hero=result.chart().caption,
        cautions=result.answer.cautions[:2],
    )


def show_damping(
    page: Page, shaft: ShaftRotor, main: ShaftWhirl, shares: tuple[float, ...]
) -> None:
    """How much damping of bearings raises the speed from which whirl of the main shaft grows."""
    first = next(one for one in main.criticals if one.sense > 0.5 or one == main.criticals[-1])
    inner = 1e-3 / first.speed
    rows: list[dict[str, float | None]] = []
    for share in shares:
        rotor = replace(shaft.rotor(), viscous=inner)
        bearings = tuple(
            replace(one, damping=share * inner * one.stiffness) for one in rotor.bearings
        )
        damped = replace(rotor, bearings=bearings)
        limit = stability_limit(damped, 4.0 * first.speed)
        rows.append(
            {
                "damping of bearings over that of the shaft": share,
                "whirl grows from [rpm]": None if limit is None else limit / RPM,
                "over the first forward critical speed": (
                    None if limit is None else limit / first.speed
                ),
            }
        )
    page.section("Stability")
    page.text(
        "Damping is not that of the file here: the shaft has a damping ratio of "
        f"{formatted(50.0 * inner * first.speed, 2)}\u00a0% at its first forward critical speed; "
        "its bearings have damping over stiffness that is a share of the shaft's."
    )
    page.table(DAMPED.format(main.name), rows)
    known = [
        (share, float(value))
        for share, row in zip(shares, rows, strict=True)
        if (value := row["over the first forward critical speed"]) is not None
    ]
    if len(known) > 1:
        page.chart(
            DAMPED.format(main.name),
            [marked(main.name, *zip(*known, strict=True))],
            "damping of bearings over stiffness, over the shaft's",
            "speed over the first forward critical speed",
        )
