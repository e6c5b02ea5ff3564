"""Hub loads of the thesis's study: the surrogate of the study, made beside everything else."""

from collections.abc import Sequence

from fe_drivetrain.report.suite import Jobs, Run, RunJob
from fe_drivetrain.studies.study_loads import (
    surrogate_conditions,
    surrogate_set,
    surrogate_statement,
)
from fe_drivetrain.turbine_loads.hub_loads import Condition, HubLoadSet, hub_load_set, not_kept

#: Seeds of each group under --quick: the least that has a standard deviation.
QUICK_SEEDS = 2


def grid(run: Run) -> list[Condition]:
    """Conditions of the histories."""
    return surrogate_conditions(QUICK_SEEDS if run.quick else None)


def start(run: Run, jobs: Jobs) -> list[RunJob[None]]:
    """Make those hub loads that were not made before, beside everything else."""
    groups: dict[float, list[Condition]] = {}
    for condition in not_kept(grid(run)):
        groups.setdefault(condition.wind_speed, []).append(condition)
    return [jobs.start(_make, wind_speed, group) for wind_speed, group in groups.items()]


def made(run: Run, making: Sequence[RunJob[None]]) -> HubLoadSet:
    """Hub loads that `start` has begun to make."""
    for job in making:
        job.result()
    return surrogate_set(run, grid(run))


def statement(hub: HubLoadSet) -> str:
    """What the loads are, and what they stand for here."""
    return (
        f"{surrogate_statement(len(hub))} It is three-bladed, with quasi-steady blade elements in "
        "Kaimal turbulence, at 20 Hz over the thesis's grid of wind speed, turbulence and shear, "
        "and stands in for the thesis's Bladed histories, which are not public. A scene of your "
        "own on your own histories: `fe-drivetrain study mine.yaml --loads FOLDER`."
    )


def _make(run: Run, wind_speed: float, conditions: Sequence[Condition]) -> None:
    """Make histories, which the cache keeps."""
    name = f"hub loads, {wind_speed:g} m/s"
    with run.step(name):
        hub_load_set(conditions, progress=lambda done, of: run.report(f"{name} ({done} of {of})"))
