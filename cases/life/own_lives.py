"""Lives of a user's main bearing under winds like the thesis's, with both stress risers."""

from collections.abc import Sequence

import numpy as np

from fe_drivetrain.bearing_life.coupled import LoadPath
from fe_drivetrain.bearing_life.life import LifeRules, step_lives
from fe_drivetrain.cases.references.main_bearings import OwnBearing
from fe_drivetrain.cases.references.studied_lives import SPEEDS, Winds
from fe_drivetrain.common import Floats
from fe_drivetrain.studies.rolling_bearings import OneBearing
from fe_drivetrain.turbine_loads.hub_loads import Condition, LoadHistory, Rotor, hub_load_set

EVENLY, RISEN = "straight, f = 1", "straight, f of ISO"
PROFILED, FAIR = "profile, f of ISO", "straight, f = 1, lambda nu = 1"

RATE = 4.0
"""Rate at which histories are made, where 3P is resolved [Hz]."""


def own_histories(winds: Winds, rotor: Rotor) -> list[list[LoadHistory]]:
    """Hub loads of a rotor, the seeds of each wind speed, as `Winds.hub_loads` thins them."""
    seeds = range(1, winds.seeds + 1)
    conditions = [Condition(v, winds.turbulence, winds.shear, s) for v in SPEEDS for s in seeds]
    made = hub_load_set(conditions, winds.duration, RATE, rotor)
    every = round(RATE / winds.rate)
    thinned = [
        LoadHistory(one.name, one.time[::every], one.loads[::every], about=one.about)
        for one in made
    ]
    return [thinned[i : i + winds.seeds] for i in range(0, len(thinned), winds.seeds)]


def own_variants(own: OwnBearing, histories: Sequence[Sequence[LoadHistory]]) -> dict[str, Floats]:
    """L10r (winds, steps) [million revolutions] of straight and of profiled rollers."""
    rules = {
        EVENLY: LifeRules(riser="none", edge=0.83),
        RISEN: LifeRules(riser="standard", edge=0.83),
        FAIR: LifeRules(riser="none", edge=1.0),
    }
    found = _lives(own.one, histories, rules)
    profiled = {PROFILED: LifeRules(riser="standard", edge=0.83)}
    return found | _lives(own.profiled(), histories, profiled)


def _lives(
    one: OneBearing, histories: Sequence[Sequence[LoadHistory]], rules: dict[str, LifeRules]
) -> dict[str, Floats]:
    """L10r of one bearing by each of some rules, from one equilibrium of each step."""
    assert isinstance(one.path, LoadPath)
    winds: dict[str, list[Floats]] = {name: [] for name in rules}
    for of_wind in histories:
        parts: dict[str, list[Floats]] = {name: [] for name in rules}
        for history in of_wind:
            for steps in one.path.steps(history, 1.0, 1.0):
                for name, own in rules.items():
                    parts[name].append(step_lives(one.rated, steps.laminae, own))
        for name, lives in parts.items():
            winds[name].append(np.concatenate(lives))
    return {name: np.array(lives) for name, lives in winds.items()}
