"""A planetary stage that turns fast: Cooley and Parker 2012, at rest and with gyroscopic terms."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import published_planetary as published
from fe_drivetrain.dynamics import distinct, divergence_speeds, system_modes, turning_modes
from fe_drivetrain.report import crosses
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import Page, Run, Target

BY_SPEED = "Frequencies seen from the carrier, five planets, against its speed"
CENTRAL = ("carrier", "ring", "sun")
STAGE = published.COOLEY_PARKER_STAGE
UNIT = float(np.sqrt(STAGE.pin / STAGE.masses[3]))  # rad/s
DIFFERENCE = "largest relative difference from the print"
DIGITS = "four digits are printed, of the smallest 0.6992: 0.7 in ten thousand, and inputs of "
DIGITS += "three digits"
AT_REST = Target(DIFFERENCE, 0.0, 5e-4, DIGITS, published.COOLEY_PARKER, basis="second-hand")


def answer(page: Page, apart: dict[int, float], limit: float) -> None:
    """State how close frequencies at rest are to the print, and at what speed the first is 0."""
    worst = max(apart.values())
    agree = "agree with" if worst <= AT_REST.within else "differ from"
    shown = value_text(100 * worst, "%")
    page.answer(
        "How does the speed of the carrier change the natural frequencies of a planetary stage?",
        f"Frequencies at rest {agree} the published ones within {shown}; as the carrier turns "
        f"faster, the lowest falls to zero at {limit:.4f} times sqrt(k_p/m_p).",
        [
            page.value("speed at which the lowest frequency is zero, over sqrt(k_p/m_p)", limit),
            *(
                page.value(
                    f"largest difference at rest, {planets} planets [%]",
                    100 * one,
                    at_most=100 * AT_REST.within,
                    by="four digits printed",
                )
                for planets, one in apart.items()
            ),
            page.judged(
                "three planets: parting of the first pair by speed",
                "splitting of the first pair of frequencies by speed",
                "perturbation",
            ),
        ],
        BY_SPEED,
        [
            "k_p is the stiffness of a planet's bearing, m_p the mass of a planet.",
            "Speed splits each pair of equal frequencies of translational modes.",
        ],
    )
    page.say(
        "In the frame of the carrier Coriolis terms part every pair of translational modes in "
        "proportion to the speed, and leave the planet modes, in which the central bodies stand "
        "still, N - 3 fold.",
    )


@case(
    "A planetary stage that turns fast: frequencies at rest, and what the turning frame adds",
    source="Cooley and Parker 2012, J. Vib. Acoust. 134, 061014; Lin and Parker 1999, Eq 1",
)
def run(run: Run, page: Page) -> None:
    """Frequencies at rest against the print; pairs that part, and speeds of divergence."""
    apart = {}
    for planets in (3, 4, 5):
        with run.step(f"{planets} planets at rest"):
            found = 2 * np.pi * system_modes(published.plane_system(STAGE, planets)).frequencies
        printed = published.printed_values(published.COOLEY_PARKER_PRINTED[planets], planets)
        largest = float(np.abs(found / UNIT / printed - 1).max())
        page.meets(largest, AT_REST, of=f"{planets} planets at rest")
        apart[planets] = largest
    system = published.plane_system(STAGE, 5)
    with run.step("speeds"):
        limits = divergence_speeds(system) / UNIT
        speeds = np.linspace(0.0, 1.2 * limits[0], 13 if run.quick else 61)
        modes = [turning_modes(system, s * UNIT, damped=False) for s in speeds]
    check_turning(page, limits[0])
    answer(page, apart, float(limits[0]))
    page.section("Frequencies by speed")
    x = np.concatenate([np.full(len(m.frequencies), s) for s, m in zip(speeds, modes, strict=True)])
    y = np.concatenate([2 * np.pi * m.frequencies / UNIT for m in modes])
    axes = "speed of the carrier over sqrt(k_p / m_p)", "frequency over sqrt(k_p / m_p)"
    page.chart(BY_SPEED, [crosses("modes", x[y < 2.5], y[y < 2.5])], *axes)
    page.data("divergence_speeds", limits)
    page.text(
        "The paper's figures at speed were not found with numbers: what is checked there are "
        "consequences of its equations, M q'' + W G q' + (K - W^2 Z) q = 0."
    )


def check_turning(page: Page, first: float) -> None:
    """Perturbation, multiplicities, and the static speed, each by a way of its own."""
    three = published.plane_system(STAGE, 3)
    pair = system_modes(three).shapes[:, :2]
    expected = float(abs(pair[:, 0] @ three.gyroscopic @ pair[:, 1]))
    found = turning_modes(three, 1.0).eigenvalues.imag
    title = "three planets: parting of the first pair by speed"
    following = "the next order of perturbation is the speed over the frequency, 1 in 2000"
    perturbed = "first-order perturbation, phi_1^T G phi_2, of the modes at rest"
    target = Target(title, expected, 1e-4, following, perturbed)
    page.meets(float(found[1] - found[0]), target)
    five = published.plane_system(STAGE, 5)
    turning = turning_modes(five, 0.2 * UNIT)
    central = [k for k, name in enumerate(five.names) if name.rpartition(" ")[0] in CENTRAL]
    still = np.abs(turning.shapes[central]).max(axis=0) < 1e-6
    groups = distinct(turning.frequencies[still], 1e-6)
    page.holds(
        "five planets at speed: three planet modes, each twice, central bodies at rest",
        [count for _, count in groups] == [2, 2, 2],
        why="the Coriolis terms of equal planets have the same symmetry as their springs",
        source="Cooley and Parker 2012, on planet modes",
    )
    moving = turning.frequencies[~still]
    page.holds(
        "five planets at speed: no other frequency is there twice",
        len(distinct(moving, 1e-6)) == len(moving),
        why="forward and backward whirls are seen at different frequencies",
        source="Cooley and Parker 2012, on translational modes",
    )
    near = turning_modes(five, first * UNIT * (1 - 1e-3)).frequencies[0]
    title = "lowest frequency a thousandth below the divergence speed, over that at rest"
    whirl = "the backward whirl goes through zero there, in proportion to the distance"
    target = Target(title, 0.0, 5e-3, whirl, "det(K - W^2 Z) = 0, an eigenproblem of its own")
    page.meets(float(near / turning_modes(five, 0.0).frequencies[0]), target)
