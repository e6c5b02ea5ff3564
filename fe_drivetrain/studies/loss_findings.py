"""What ``gears`` says of losses: figures, tables, checks, cautions and assumptions."""

from __future__ import annotations

import numpy as np

from fe_drivetrain.bearing_life.life.lubricants import VISCOSITY_INDEX
from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.components import RPM
from fe_drivetrain.dynamics.bodies.power_losses import Losses
from fe_drivetrain.report.answer import KeyFigure
from fe_drivetrain.report.charts import bars, chart, trace
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.results import Chart
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.studies.gear_losses import (
    ANSWER,
    CONSTANT,
    GREASE,
    RZ,
    DrivetrainLosses,
)

EFFICIENCY = "efficiency of the drivetrain at the reference torque [%]"
OVER_LIFE = "efficiency over the energy of all classes of the spectrum [%]"
GENERATOR = "torque at the generator at the reference torque [kN m]"
HEAT = "heat at the reference torque [kW]"
_MWH = 3.6e9
_ROUND_OFF = 1e-12


def state_losses(found: Findings, losses: DrivetrainLosses) -> None:
    """State the losses of a drivetrain.

    Parameters
    ----------
    found : Findings
        Takes them.
    losses : DrivetrainLosses
        What was found.
    """
    own, band = losses.answer.losses, losses.band
    whole, speed = float(own.heat[:, 0].sum()), float(abs(own.speed[0]))
    found.found(EFFICIENCY, 100.0 * float(own.efficiency[0]), 100.0 * _relative(losses))
    over_life = life_efficiency(losses)
    if over_life is not None:
        found.found(OVER_LIFE, 100.0 * over_life[0], 100.0 * over_life[1])
    found.found(HEAT, whole / 1e3, float(band[0]) * speed / 1e3)
    torque = float(own.generator_torque[0])
    found.found(GENERATOR, torque / 1e3, float(band[0]) / abs(own.ratio) / 1e3)
    bearings, meshes = (
        float(sum(own.heat[k, 0] for k, name in enumerate(own.names) if name in names))
        for names in (losses.bearings, losses.meshes)
    )
    found.say(
        f"At the reference torque {formatted(whole / 1e3, 3)}\u00a0kW of "
        f"{formatted(float(own.entering[0]) / 1e3, 4)}\u00a0kW become heat, "
        f"{formatted(bearings / 1e3, 3)}\u00a0kW in {len(losses.bearings)} bearings and "
        f"{formatted(meshes / 1e3, 3)}\u00a0kW in {len(losses.meshes)} kinds of "
        f"meshes; the generator has {formatted(torque / 1e3, 4)}\u00a0kN\u00a0m."
    )
    balance = own.entering - own.leaving - own.heat.sum(axis=0)
    found.vanishes(
        "power that enters less what leaves and all heat, over what enters, largest of all points",
        float(np.abs(balance / np.maximum(np.abs(own.entering), 1.0)).max()),
        within=_ROUND_OFF,
        why="round-off: heat is summed part by part, what leaves by the torque that is left",
        source="balance of power",
        basis="self-consistency",
    )
    found.data("losses", part_rows(losses))
    found.data("shaft_torques", shaft_rows(losses))
    found.data("loss_levels", level_rows(losses))
    found.data("losses_over_torque", torque_rows(losses))
    _cautions(found, losses)
    _assumptions(found, losses)


def loss_figures(found: Findings) -> list[KeyFigure]:
    """Key figures of losses: efficiencies, and torque at the generator.

    Parameters
    ----------
    found : Findings
        With the losses stated.
    """
    names = [name.partition(" [")[0] for name in (EFFICIENCY, OVER_LIFE, GENERATOR)]
    known = {one.quantity for one in found.figures}
    return [found.judged(name) for name in names if name in known]


def life_efficiency(losses: DrivetrainLosses) -> tuple[float, float] | None:
    """Efficiency by energy over all driven classes of the spectrum, and its band [-].

    Parameters
    ----------
    losses : DrivetrainLosses
        What was found.

    Returns
    -------
    tuple of float or None
        None of a single class, whose efficiency is its own.
    """
    own = losses.answer.losses
    share = _by_energy(own, losses.seconds)
    if share is None:
        return None
    at = _driven(own)
    lost = float((losses.band[at] * np.abs(own.speed[at])) @ losses.seconds[at - 1])
    return share, lost / float(own.entering[at] @ losses.seconds[at - 1])


def _driven(of: Losses) -> Ints:
    """Numbers of points of the spectrum at which the rotor gives power."""
    return np.flatnonzero(of.entering[1:] > 0.0) + 1


def _by_energy(of: Losses, seconds: Floats) -> float | None:
    """Energy that leaves over that which enters, over all classes that are driven."""
    at = _driven(of)
    if len(at) < 2:
        return None
    return float(of.leaving[at] @ seconds[at - 1]) / float(of.entering[at] @ seconds[at - 1])


def part_rows(losses: DrivetrainLosses) -> list[Record]:
    """Heat of each part at the reference torque, by all levels.

    Parameters
    ----------
    losses : DrivetrainLosses
        What was found.
    """
    own = losses.answer.losses
    whole = float(own.heat[:, 0].sum())
    rows: list[Record] = []
    for k, name in enumerate(own.names):
        kind = "bearing" if name in losses.bearings else "seal"
        row: Record = {"part": name, "kind": "mesh" if name in losses.meshes else kind}
        for level in losses.levels:
            row[f"heat by {level.name} [W]"] = float(level.losses.heat[k, 0])
        row["share of all [%]"] = 100.0 * float(own.heat[k, 0]) / whole
        row["heat over the life [MWh]"] = float(own.heat[k, 1:] @ losses.seconds) / _MWH
        rows.append(row)
    return rows


def shaft_rows(losses: DrivetrainLosses) -> list[Record]:
    """Torque of each shaft at the reference torque, with and without losses.

    Parameters
    ----------
    losses : DrivetrainLosses
        What was found.
    """
    own = losses.answer.losses
    left = own.along([float(number) for number in range(len(losses.shafts))])[:, 0]
    rows: list[Record] = []
    before = float(own.torque[0])
    for name, ratio, torque in zip(losses.shafts, losses.ratios, left.tolist(), strict=True):
        rows.append(
            {
                "shaft": name,
                "speed [rpm]": float(own.speed[0]) * abs(ratio) * RPM,
                "torque without losses [kN m]": float(own.torque[0]) / abs(ratio) / 1e3,
                "torque behind its bearings [kN m]": torque / abs(ratio) / 1e3,
                "power behind its bearings [kW]": torque * float(own.speed[0]) / 1e3,
                "lost since the shaft before [kW]": (before - torque) * float(own.speed[0]) / 1e3,
            }
        )
        before = torque
    return rows


def level_rows(losses: DrivetrainLosses) -> list[Record]:
    """Each level's efficiency, heat over the life and time.

    Parameters
    ----------
    losses : DrivetrainLosses
        What was found.
    """
    over_life = {one.name: _by_energy(one.losses, losses.seconds) for one in losses.levels}
    return [
        {
            "level": one.name,
            "efficiency at the reference torque [%]": 100.0 * float(one.losses.efficiency[0]),
            **(
                {}
                if (share := over_life[one.name]) is None
                else {"efficiency over the spectrum [%]": 100.0 * share}
            ),
            "heat at the reference torque [kW]": float(one.losses.heat[:, 0].sum()) / 1e3,
            "heat over the life [MWh]": one.energy / _MWH,
            f"difference from {ANSWER} [%]": 100.0 * one.difference,
            "processor time [s]": one.seconds,
        }
        for one in losses.levels
    ]


def torque_rows(losses: DrivetrainLosses) -> list[Record]:
    """Efficiency, heat and torque at the generator of each class of the spectrum.

    Parameters
    ----------
    losses : DrivetrainLosses
        What was found.
    """
    own = losses.answer.losses
    rows: list[Record] = []
    for k in range(1, len(own.torque)):
        efficiency = float(own.efficiency[k])
        rows.append(
            {
                "torque of the rotor [kN m]": float(own.torque[k]) / 1e3,
                "speed of the rotor [rpm]": float(own.speed[k]) * RPM,
                "time [h]": float(losses.seconds[k - 1]) / 3600.0,
                "efficiency [%]": None if np.isnan(efficiency) else 100.0 * efficiency,
                "heat [kW]": float(own.heat[:, k].sum()) / 1e3,
                "band [kW]": float(losses.band[k] * abs(own.speed[k])) / 1e3,
                "torque at the generator [kN m]": float(own.generator_torque[k]) / 1e3,
            }
        )
    return rows


def heat_chart(losses: DrivetrainLosses) -> Chart:
    """Heat of each part at the reference torque, by the levels beyond a constant efficiency.

    Parameters
    ----------
    losses : DrivetrainLosses
        What was found.
    """
    groups = {
        level.name: {
            name: float(level.losses.heat[k, 0]) / 1e3 for k, name in enumerate(level.losses.names)
        }
        for level in losses.levels
        if level.name != CONSTANT
    }
    return bars("Heat of each part at the reference torque", groups, "heat [kW]")


def efficiency_chart(losses: DrivetrainLosses) -> Chart | None:
    """Efficiency over the torque of the rotor by all levels; None of a single torque.

    Parameters
    ----------
    losses : DrivetrainLosses
        What was found.
    """
    driven = _driven(losses.answer.losses)
    if len(driven) < 2:
        return None
    order = driven[np.argsort(losses.answer.losses.torque[driven])]
    curves = [
        trace(
            level.name,
            level.losses.torque[order] / 1e3,
            100.0 * level.losses.efficiency[order],
            mode="lines+markers",
        )
        for level in losses.levels
    ]
    return chart(
        "Efficiency over the torque of the rotor, at the speeds of the spectrum",
        curves,
        "torque of the rotor [kN m]",
        "efficiency [%]",
    )


def _relative(losses: DrivetrainLosses) -> float:
    return float(losses.efficiency_band[0])


def _cautions(found: Findings, losses: DrivetrainLosses) -> None:
    """State what is not counted."""
    if losses.left_out:
        named = ", ".join(losses.left_out)
        found.note(
            f"Losses of {named} are not counted, for want of a catalogue entry or of teeth: all "
            "heat here is a lower bound.",
            first=True,
        )
    found.note(
        "Losses are too low, and the efficiency too high, by what is not in them: oil that gears "
        "churn, drag of bearings in an oil bath (SKF prints it as a diagram alone), pumps, the "
        "generator, and seals that the file does not state.",
        first=not losses.left_out,
    )
    found.note(
        "Factors of ISO/TR 14179 and most of SKF's constants are second-hand or from memory."
    )


def _assumptions(found: Findings, losses: DrivetrainLosses) -> None:
    """State what the losses take as given."""
    oil = losses.oil
    for name, value, unit in (
        ("temperature", oil.temperature, "degC"),
        ("lubricant", oil.viscosity_40, "mm2/s at 40 degC"),
    ):
        key = f"operation.{name}"
        said = "assumed, not stated" if name in losses.assumed else "as stated"
        found.assume(f"losses, gearbox oil: {name}", value, unit, f"{said}; {key}")
    if "viscosity index" in losses.assumed:
        found.assume(
            "losses, gearbox oil: viscosity index",
            VISCOSITY_INDEX,
            "-",
            f"assumed: {formatted(oil.viscosity_100, 3)} mm2/s at 100 degC by ASTM D2270, from "
            "memory",
        )
    found.assume(
        "losses, main bearings: grease",
        GREASE.viscosity_40,
        "mm2/s at 40 degC",
        f"assumed, base oil at {GREASE.temperature:g} degC",
    )
    found.assume(
        "losses, loads of bearings",
        "linear statics without losses, the mean over azimuths of the carriers",
        "",
        "forces alone: no moments, no clearance",
    )
    found.assume(
        "losses, roughness of flanks", 1e6 * RZ, "um", "assumed where no steel is stated; R_z"
    )
