"""IEA 10 MW turbine: the main shaft as a tube, and a stiffness that is another turbine's."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from fe_drivetrain.cases.references.shaft_theory import polar_moment
from fe_drivetrain.cases.verification.published_checks import (
    CLOSED_FORM,
    USUAL_G,
    MainShaft,
    check_digits,
    check_torsion,
    compare_stiffness,
)
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import certain_value, value_text
from fe_drivetrain.report.suite import Page, Record

BY_SHAFT = "Torsional stiffness by description of the shaft"


def judge(page: Page, given: Mapping[str, Any], sources: Record, shaft: MainShaft) -> None:
    """The tube, and what other descriptions of it would give."""
    found, placeholder = shaft.found, given["placeholder"]
    G, length = 1e9 * given["dtu_G"], given["dtu_length"]
    x, polar = np.array(given["hawc2_x"]), np.array(given["hawc2_polar"])
    # 1 / K is integrated exactly where K is linear
    steps, slope = np.diff(x), np.diff(polar) / np.diff(x)
    level = np.abs(slope) < 1e-12
    flexibility = np.where(
        level,
        steps / polar[:-1],
        np.log(polar[1:] / polar[:-1]) / np.where(level, 1.0, slope),
    )
    low, high = shaft.closed * USUAL_G / shaft.G
    check_torsion(page, "finite elements, tube over 3.0 m", found, shaft.closed, CLOSED_FORM)
    dtu = "what the placeholder is: K G / L of the DTU 10 MW turbine's shaft [N m/rad]"
    by_dtu = G * given["dtu_polar"] / length
    check_digits(page, dtu, by_dtu, placeholder, 500.0, sources["placeholder"])
    answer(page, placeholder, (low, high))
    page.say(
        "The published figure is K G / L of the DTU 10 MW turbine's shaft, carried over. Shear "
        f"moduli of usual steels give {low / 1e9:.2f} to {high / 1e9:.2f} GN m/rad."
    )
    later = shaft.G * polar_moment(2.5, 2.3) / 2.2
    by = {
        "finite elements, 3.0 m, wall 0.1 m, over 3.0 m": found.stiffness,
        "closed form of it": shaft.closed,
        "closed form, G = 79.3 GPa": low,
        "closed form, G = 80.8 GPa": high,
        "WISDEM's later shaft, 2.5 m, wall 0.1 m, over 1.0 + 1.2 m": later,
        "the turbine's HAWC2 shaft, by its sections over 5.4 m": G / flexibility.sum(),
        "placeholder in the OpenFAST model": placeholder,
    }
    compare_stiffness(page, BY_SHAFT, "shaft", by, "the placeholder", placeholder)
    fine = np.linspace(0.0, x[-1], 400)
    along = np.interp(fine, x, polar)
    twist = np.cumsum(np.diff(fine) / (G * 0.5 * (along[1:] + along[:-1])))
    load = 1e3 * 1e7  # 10 MN m, in mrad
    page.chart(
        "Twist along the shaft under 10 MN m, from the gearbox-less generator's end: the tube, "
        "and the sections of the turbine's HAWC2 model",
        [
            trace("HAWC2 sections", fine, load * np.concatenate([[0.0], twist])),
            trace("tube", [0.0, shaft.length], [0.0, load / shaft.closed]),
            trace("placeholder", [0.0, length], [0.0, load / placeholder]),
        ],
        "x [m]",
        "twist [mrad]",
    )
    page.text(
        "The descriptions differ by far more than any numerical band: what counts as the shaft, "
        "from where to where, decides. The HAWC2 sections include the thin tube between bearing "
        "and generator, and hold most twist there."
    )


def answer(page: Page, placeholder: float, usual: tuple[float, float]) -> None:
    """State the shaft's stiffness, and that the published one is another's.

    `usual` is the stiffness for the least and the largest modulus of usual steels; all in N m/rad.
    """
    found = page.judged(
        "finite elements, tube over 3.0 m",
        "main shaft, 3.0 m, wall 0.1 m, over 3.0 m",
        "closed form",
        unit="GN m/rad",
    )
    is_softer = placeholder < 0.9 * usual[0]
    published = value_text(placeholder / 1e9, "GN\u00a0m/rad")
    times = f"{1e9 * found.value / placeholder:.0f} times softer"
    page.answer(
        "Which torsional stiffness has the main shaft of the IEA 10 MW turbine?",
        f"The shaft's tube has {certain_value(found)}; the published {published} does not belong "
        f"to it but to the DTU 10\u00a0MW turbine, and is {times}."
        if is_softer
        else f"The shaft's tube has {certain_value(found)}, beside the published {published}.",
        [
            found,
            page.value(
                "published stiffness [GN m/rad]",
                placeholder / 1e9,
                beside=found.value,
                by="this shaft",
            ),
            page.value("the shaft with G = 79.3 GPa [GN m/rad]", usual[0] / 1e9),
            page.value("the shaft with G = 80.8 GPa [GN m/rad]", usual[1] / 1e9),
        ],
        hero=BY_SHAFT,
        cautions=["The stiffness depends on which length is counted as the shaft: see the chart."],
        claim="does not hold" if is_softer else "holds",
    )
