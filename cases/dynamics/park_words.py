"""What Park et al. 2021 say of their model in time, beside what is found."""

from typing import NamedTuple

from fe_drivetrain.report.number_text import percent_text, value_text
from fe_drivetrain.report.suite import Page, Record

PUSHED = "none: nacelle 6250 N"
MINIMUM, MAXIMUM = "least force of a mesh over the static one", "largest force over the static one"
PERIOD = "period of the mesh force [s]"
FORCES = "Mesh forces over the static ones after a torque step, meshes that vary"


class Range(NamedTuple):
    """A value with its band, and the range that phases which are not printed give it."""

    value: float
    band: float
    low: float
    high: float


def answer(
    page: Page, steps: list[Record], least: dict[str, Range], changes: dict[str, float]
) -> None:
    """State what the printed period is, and which of eccentricity and nacelle counts more [%]."""
    by = {name: change for name, change in changes.items() if name != PUSHED}
    largest, nacelle = max(by, key=lambda name: by[name]), changes[PUSHED]
    holds = nacelle > by[largest]
    flat, space = least["torsional"], least["three dimensions"]
    page.answer(
        "Do the statements of Park et al. 2021 on forces over time hold?",
        ("Yes: mesh forces" if holds else "In part: mesh forces")
        + f" swing in the first mode ({value_text(steps[0][PERIOD], 's')}), "
        f"{'and' if holds else 'but'} the nacelle's force ({percent_text(nacelle / 100)}) "
        f"{'changes' if holds else 'does not change'} them more than eccentricity "
        f"({percent_text(by[largest] / 100)}).",
        [
            page.judged(
                f"torque step, {steps[0]['meshes']}: {PERIOD.partition(' [')[0]}",
                "period of the mesh force, meshes as printed",
                "first mode",
            ),
            page.value(
                "the same, all meshes with stiffness along both axes [s]",
                steps[2][PERIOD],
                beside=0.4,
                by="Park et al.",
            ),
            page.value("lowest mesh force over static, torsional model", flat.value, flat.band),
            page.value("lowest mesh force over static, three dimensions", space.value, space.band),
            page.value(f"change of mesh forces by an eccentric {largest} [%]", by[largest]),
            page.value("change of mesh forces by the nacelle's force [%]", nacelle),
        ],
        FORCES,
        [
            "The paper's period of about 0.4\u00a0s is that of no mesh; the first mode comes to it "
            "where meshes are stiffer than printed.",
            "Whether mesh forces become negative after the torque step depends on time step, "
            "harmonics and phase of the meshes; the phase is not printed.",
        ],
        claim="holds" if holds else "holds in part",
    )


def answer_of_step(least: dict[str, Range]) -> str:
    """What the least forces show of bending and bearings, and what they leave open."""
    flat, space = least["torsional"], least["three dimensions"]
    words = (
        "With varying meshes the least force of a mesh after the step is "
        f"{space.value:.2f} ± {space.band:.2f} of the static one in three dimensions and "
        f"{flat.value:.2f} ± {flat.band:.2f} in the torsional model; by the phase of the meshes, "
        f"which is not printed, {space.low:.2f} to {space.high:.2f} and {flat.low:.2f} to "
        f"{flat.high:.2f}. "
    )
    if flat.high + flat.band < min(0.0, space.low - space.band):
        return words + (
            "Forces below zero come of varying meshes that are suddenly loaded, and not of "
            "bending and bearings, which make them smaller."
        )
    if max(flat.high + flat.band, space.high + space.band) < 0.0:
        return words + (
            "Forces are below zero in both, so that they need no bending; which model has the "
            "lower ones is not decided."
        )
    return words + "Which model has the lower forces, and whether they pull, is not decided."


def show_verdicts(
    page: Page,
    steps: list[Record],
    least: dict[str, Range],
    lines: dict[str, list[float]],
    changes: dict[str, float],
) -> None:
    """What the source says, what is found, and whether they agree."""
    by = {name: change for name, change in changes.items() if name != PUSHED}
    nacelle = changes[PUSHED]
    worst = max(by, key=lambda name: by[name])
    same = lines["torsional"] == lines["three dimensions"]
    near = min(steps, key=lambda row: abs(row[PERIOD] - 0.4))
    flat, space = least["torsional"], least["three dimensions"]
    page.section("Printed, ours, verdict")
    page.table(
        "Words of sections 4 and 5",
        [
            [
                "period of the contact force",
                "about 0.4 s",
                f"{steps[0][PERIOD]:.3f} s as printed, {near[PERIOD]:.3f} s: {near['meshes']}",
                "the first mode, not meshing",
            ],
            [
                "least force, torsional",
                "0",
                f"{steps[0][MINIMUM]:.3f} of static, constant meshes",
                "agrees: a torque step" if abs(steps[0][MINIMUM]) < 0.02 else "differs",
            ],
            [
                "least force in 3D",
                "at times negative, by bending and bearings",
                f"{space.value:.2f} ± {space.band:.2f} of static; torsional {flat.value:.2f} ± "
                f"{flat.band:.2f}",
                "not decided"
                if max(space.high + space.band, flat.high + flat.band) >= 0.0
                else "so it is, and without bending, too",
            ],
            [
                "lines 18.30, 63.06, 128.50 Hz",
                "in both models",
                "in both models" if same else "differ",
                "agrees, as these are the frequencies that were given" if same else "differs",
            ],
            [
                "eccentricity",
                "not significant; planets largest, rotor critical",
                f"{worst} largest, {by[worst]:.2g} %",
                "the source contradicts itself",
            ],
            [
                "nacelle's force against eccentricity",
                "larger",
                f"{nacelle:.2g} % against {min(by.values()):.2g} to {by[worst]:.2g} %",
                "agrees" if nacelle > by[worst] else "differs",
            ],
        ],
        ["statement", "printed", "ours", "verdict"],
    )
