"""Whether the files of a set seem to be of different turbines."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from fe_drivetrain.common.components import FORCES
from fe_drivetrain.turbine_loads.hub_loads.histories import LoadHistory

STEADY = 0.25
"""Standard deviation of Fz over its mean below which the mean is mostly the rotor's weight."""

APART = 1.2
"""Ratio of two such means from which rotors differ by more than wind and shear lift them."""


def vertical_forces(histories: Sequence[LoadHistory]) -> dict[str, tuple[float, float]]:
    """Mean and standard deviation of Fz of each history [N], by its name."""
    columns = {h.name: h.loads[:, FORCES.index("Fz")] for h in histories}
    return {name: (float(z.mean()), float(z.std())) for name, z in columns.items()}


def different_turbines(vertical: Mapping[str, tuple[float, float]]) -> str:
    """A sentence where files of one set have rotors of different weight; "" where they do not.

    Parameters
    ----------
    vertical : Mapping
        Mean and standard deviation of Fz of each file [N], by its name. Files whose Fz is not
        mostly a weight, as loads of the air alone, say nothing.
    """
    weights = {name: -mean for name, (mean, spread) in vertical.items() if spread < STEADY * -mean}
    if not weights:
        return ""
    light = min(weights, key=lambda name: weights[name])
    heavy = max(weights, key=lambda name: weights[name])
    if weights[heavy] <= APART * weights[light]:
        return ""
    return (
        f"The files seem to be of different turbines: mean Fz, which is mostly the rotor's weight, "
        f"is {-weights[light] / 1e3:,.4g} kN in {light} and {-weights[heavy] / 1e3:,.4g} kN in "
        f"{heavy}: give the files of each turbine apart, unless ice or another rotor explains it."
    )
