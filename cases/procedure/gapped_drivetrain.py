"""The drivetrain of which a case runs what load cases leave out: drivetrain C, or a user's."""

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.cases.references import published_drivetrains as published
from fe_drivetrain.drivetrain_file import Drivetrain
from fe_drivetrain.dynamics import gear_table
from fe_drivetrain.dynamics.torsion import GearTable
from fe_drivetrain.report.suite import Page, Run
from fe_drivetrain.report.suite.chosen import SETTING

NAME = "drivetrain_c"
SPEEDS = (9.0, 18.0)  # rpm
RATIO = 0.01  # of critical damping
RPM = np.pi / 30.0


@dataclass(frozen=True)
class Gapped:
    """A drivetrain whose gaps are run: its table, speeds of the rotor [rpm], damping ratio.

    ``title`` is empty of the case's own.
    """

    drivetrain: Drivetrain
    table: GearTable
    speeds: tuple[float, float]
    ratio: float
    title: str


def gapped(run: Run, page: Page) -> Gapped:
    """Drivetrain C, or the one that the user names.

    Raises
    ------
    InputError
        The user's file does not state the speeds of its rotor, or what torsion needs.
    """
    if SETTING not in run.settings:
        drivetrain = published.drivetrain(NAME)
        return Gapped(drivetrain, published.table(NAME), SPEEDS, RATIO, "")
    chosen = run.drivetrain("")
    chosen.state(page)
    table, own = gear_table(chosen.drivetrain), chosen.drivetrain.damping
    low, high = (speed / RPM for speed in chosen.rotor_speeds())
    ratio = own.shafts if own is not None and own.shafts else RATIO
    page.assume_all(table.assumptions())
    return Gapped(chosen.drivetrain, table, (low, high), ratio, chosen.title)
