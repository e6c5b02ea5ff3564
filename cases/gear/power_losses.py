"""Losses of a drivetrain over its load: printed loss factors, balance, error against time."""

from dataclasses import dataclass
from math import pi, radians

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.common.progress import silent
from fe_drivetrain.comparison import as_printed
from fe_drivetrain.gear import Gear, Pair
from fe_drivetrain.gear.losses import film_friction, mean_friction, tooth_loss_factor
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import formatted, value_text
from fe_drivetrain.report.suite import ChosenDrivetrain, Page, Record, Run
from fe_drivetrain.studies.gear_loads import GearLoading, loads_of
from fe_drivetrain.studies.gear_losses import (
    ANSWER,
    CONSTANT,
    DrivetrainLosses,
    drivetrain_losses,
)
from fe_drivetrain.studies.gear_options import GearOptions
from fe_drivetrain.studies.gear_ratings import prepared
from fe_drivetrain.studies.loss_findings import heat_chart, level_rows, part_rows, shaft_rows

HERO = "Efficiency over the torque of the rotor, at rated speed"
LADDER = "Difference of the heat over all torques against processor time, from SKF's model"
GEARPIE = "reports C14 and H501 of the public program GEARpie (Fernandes)"
SHARES = (0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0)


@dataclass(frozen=True)
class Printed:
    """Gears of the FZG test rig, with what a public program prints of them."""

    teeth: tuple[int, int]
    module: float
    helix: float
    shifts: tuple[float, float]
    tips: tuple[float, float]
    width: float
    loss_factor: str

    @property
    def pair(self) -> Pair:
        """Both gears at 91.5 mm."""
        first, second = (
            Gear(z, self.module, self.width, radians(beta), x, tip_diameter=2.0 * tip)
            for z, x, tip, beta in zip(
                self.teeth, self.shifts, self.tips, (self.helix, -self.helix), strict=True
            )
        )
        return Pair(first, second, 0.0915)


FZG = {
    "C14": Printed(
        (16, 24), 4.5e-3, 0.0, (0.1817, 0.1715), (41.228e-3, 59.182e-3), 14e-3, "0.1950"
    ),
    "H501": Printed(
        (20, 30), 3.5e-3, 15.0, (0.1809, 0.0891), (40.336e-3, 58.132e-3), 23e-3, "0.1639"
    ),
}


@case(
    "Losses of a drivetrain: heat of teeth and bearings, and the torque that arrives",
    source="ISO/TR 14179 and SKF's friction model, second-hand; printed numbers of GEARpie",
    settings={"drivetrain": "FILE, or a name of the library (otherwise grc_750kw)"},
    alone="full",
)
def run(run: Run, page: Page) -> None:
    """Losses at shares of the rated torque, by all levels; printed numbers of test gears."""
    chosen = run.drivetrain("grc_750kw", gears=True)
    chosen.state(page, topic="Losses of teeth and bearings over the load")
    if not chosen.own:
        with page.of(None):
            check_printed(page)
    with run.step("losses"):
        losses = losses_of(chosen)
    check_balance(page, losses)
    rows = level_rows(losses)
    page.section("Efficiency over the load")
    page.add(heat_chart(losses))
    efficiency_over_torque(page, losses)
    page.table("Torque along the shafts at rated torque", shaft_rows(losses))
    page.table("Heat of each part at rated torque", part_rows(losses))
    page.section("Error against time")
    ladder: list[Record] = [
        {
            "level": one.name,
            "processor time [s]": one.seconds,
            "difference [%]": 100.0 * abs(one.difference),
        }
        for one in losses.levels
        if one.name != ANSWER
    ]
    page.sweep(
        LADDER, ladder, "processor time [s]", "difference [%]", by="level", log="xy", points=True
    )
    page.table("Levels", rows)
    answer(page, chosen, losses)


def check_printed(page: Page) -> None:
    """Loss factors of two pairs, and friction coefficients of one, that a program prints."""
    for name, one in FZG.items():
        page.equals(
            f"{name}: tooth loss factor H_V",
            tooth_loss_factor(one.pair),
            **as_printed(one.loss_factor),
            source=GEARPIE,
        )
    pair, speed = FZG["C14"].pair, 1500.0 * pi / 30.0
    oil = (46.23e-3, 0.6e-6)
    for law, value, printed in (
        ("Schlenk", mean_friction(pair, 200.0, speed, *oil, 0.85), "0.0483"),
        ("Fernandes", film_friction(pair, 200.0, speed, *oil, 71.05e-9, 0.85), "0.0354"),
    ):
        page.equals(
            f"C14: friction coefficient of teeth by {law}",
            float(value),
            **as_printed(printed),
            source=GEARPIE,
        )


def losses_of(chosen: ChosenDrivetrain) -> DrivetrainLosses:
    """Losses at rated torque, and at shares of it, each for an hour at rated speed."""
    options, torque = GearOptions(losses=True, classes=40), None
    loading = GearLoading((), None, None, None, False)
    train, meshes, left_out = prepared(chosen.drivetrain, torque, options, loading)
    spectrum = [(share * train.torque, 1.0) for share in SHARES]
    asked = GearLoading((), None, None, spectrum, False)
    given = loads_of(train, options, asked, silent)
    return drivetrain_losses(chosen.drivetrain, train, meshes, left_out, given)


def check_balance(page: Page, losses: DrivetrainLosses) -> None:
    """What enters is what leaves and all heat, at every level and torque."""
    worst = max(
        float(np.abs((of.entering - of.leaving - of.heat.sum(axis=0)) / of.entering).max())
        for of in (one.losses for one in losses.levels)
    )
    page.vanishes(
        "power that enters less what leaves and all heat, over what enters, all levels",
        worst,
        within=1e-12,
        why="round-off: heat is summed part by part, what leaves by the torque that is left",
        source="balance of power",
        basis="self-consistency",
    )
    own = losses.answer.losses
    page.holds(
        "heat grows with the torque",
        bool((np.diff(own.heat[:, 1:].sum(axis=0)) > 0.0).all()),
        why="friction of bearings and teeth grows with their load at the same speed",
        source="friction of bearings and teeth",
        basis="self-consistency",
    )


def efficiency_over_torque(page: Page, losses: DrivetrainLosses) -> None:
    """Efficiency by all levels over the torque."""
    own = losses.answer.losses
    page.chart(
        HERO,
        [
            trace(
                level.name,
                own.torque[1:] / 1e3,
                100.0 * level.losses.efficiency[1:],
                mode="lines+markers",
            )
            for level in losses.levels
        ],
        "torque of the rotor [kN m]",
        "efficiency [%]",
    )


def answer(page: Page, chosen: ChosenDrivetrain, losses: DrivetrainLosses) -> None:
    """State the efficiency at rated and at a fifth of the rated torque."""
    own = losses.answer.losses
    band = 100.0 * losses.efficiency_band
    rated, low = 100.0 * own.efficiency[0], 100.0 * own.efficiency[1 + SHARES.index(0.2)]
    heat = float(own.heat[:, 0].sum())
    constant = next(one for one in losses.levels if one.name == CONSTANT)
    teeth = sum(float(own.heat[k, 0]) for k, n in enumerate(own.names) if n in losses.meshes)
    page.found("efficiency at rated torque [%]", float(rated), float(band[0]))
    lost = heat / 1e3
    spread = lost * float(band[0]) / (100.0 - float(rated))
    page.answer(
        "How much power does the drivetrain lose, and how efficient is it?",
        f"At rated torque the drivetrain loses {value_text(lost, 'kW', spread)} and has an "
        f"efficiency of {formatted(float(rated), 3)}\u00a0%; at a fifth of the torque it has "
        f"{formatted(float(low), 3)}\u00a0%.",
        [
            page.value("power lost at rated torque [kW]", lost, spread),
            page.judged("efficiency at rated torque"),
            page.value("efficiency at a fifth of the rated torque [%]", float(low)),
            page.value("share of gear teeth in this loss [%]", 100.0 * teeth / heat),
            page.value("torque at the generator [kN m]", float(own.generator_torque[0]) / 1e3),
            page.value(
                "error of the loss at all torques if efficiency is taken as constant [%]",
                100.0 * abs(constant.difference),
            ),
        ],
        HERO,
        [
            "No efficiency of the machine was measured: the uncertainty is the difference between "
            "models of losses.",
            "Oil churning, pumps and the generator are not included, nor parts without catalogue "
            "entry or teeth: "
            + (", ".join(losses.left_out) if losses.left_out else "none here")
            + ".",
        ],
    )
    if chosen.own:
        page.say("Loss factors and friction of printed test gears are judged without it.")
