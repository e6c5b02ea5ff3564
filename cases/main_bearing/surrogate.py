"""Hub loads of the thesis's study: a surrogate on its grid, made beside everything else."""

from collections.abc import Sequence

from fe_drivetrain.common import user_cache
from fe_drivetrain.report.suite import Jobs, Run, RunJob
from fe_drivetrain.turbine_loads.hub_loads import (
    Condition,
    HubLoadSet,
    hub_load_set,
    not_kept,
    surrogate_grid,
)

#: Seeds of each group under --quick: the least that has a standard deviation.
QUICK_SEEDS = 2


def grid(run: Run) -> list[Condition]:
    """Conditions of the histories."""
    return [c for c in surrogate_grid() if not run.quick or c.seed <= QUICK_SEEDS]


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
    with run.step("hub loads") as step:
        found = hub_load_set(
            grid(run), progress=lambda done, of: run.report(f"hub loads ({done} of {of})")
        )
        if not making and user_cache().folder is not None:
            step.name += ", from the cache"
    return found


def statement(hub: HubLoadSet) -> str:
    """What the loads are."""
    return (
        f"Hub loads are a surrogate: {len(hub)} ten-minute histories at 20 Hz of a 2 MW, 80 m, "
        "three-bladed rotor, quasi-steady blade elements in Kaimal turbulence, over the thesis's "
        "grid of wind speed, turbulence and shear. They stand in for the thesis's Bladed "
        "histories, which are not public. A scene of your own on your own histories: "
        "`fe-drivetrain study mine.yaml --loads FOLDER`."
    )


def _make(run: Run, wind_speed: float, conditions: Sequence[Condition]) -> None:
    """Make histories, which the cache keeps."""
    name = f"hub loads, {wind_speed:g} m/s"
    with run.step(name):
        hub_load_set(conditions, progress=lambda done, of: run.report(f"{name} ({done} of {of})"))
