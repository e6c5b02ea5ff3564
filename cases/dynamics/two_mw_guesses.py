"""What the thesis does not print of its 2 MW machine, and how far each guess moves the result."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from fe_drivetrain.cases.dynamics.two_mw_loads import (
    Extremes,
    bearing_changes,
    mesh_changes,
    rolling,
)
from fe_drivetrain.cases.dynamics.two_mw_machine import (
    CLEARANCE,
    PLANET,
    Chain,
    other_level,
    scaled_bearings,
)
from fe_drivetrain.cases.references.operated_machines import (
    Rig,
    driving,
    scaled_to,
    turbine_in_wind,
)
from fe_drivetrain.dynamics import Level
from fe_drivetrain.report.suite import Record
from fe_drivetrain.studies.part_bearings import counted_parts
from fe_drivetrain.studies.transient_runs import LevelRun

BASE = "as on this page"
COLUMN = "guess"
FEWEST = "fewest rollers loaded"

Both = tuple[Extremes, Extremes]
"""Extremes of normal operation and of the shutdown."""


def moved_by(one: Chain, quick: bool) -> list[Record]:
    """Results with each guess changed, one at a time; the first row has none changed.

    Parameters
    ----------
    one : Chain
        The machine.
    quick : bool
        Whether a few guesses are enough.
    """
    changes = guesses(one)
    names = [name for name in changes if not quick or name in QUICK]
    rows = [{COLUMN: BASE, **results(one, one.normal.extremes, one.stop.extremes)}]
    return rows + [{COLUMN: name, **results(one, *changes[name]())} for name in names]


def grown(name: str) -> str:
    """Key of the largest load of a part in the shutdown over that in normal operation."""
    return f"{name}: shutdown over normal"


def sides(planet: int) -> str:
    """Key of the largest upwind over the largest downwind load of a planet in the shutdown."""
    return f"planet {planet}: upwind over downwind in the shutdown"


def spread(moved: Sequence[Record], key: str, over: str = "") -> tuple[float, float]:
    """Least and largest result with any guess, or of one result over another.

    Parameters
    ----------
    moved : sequence of Record
        Rows of `moved_by`.
    key, over : str
        Result, and that which divides it.
    """
    found = [float(str(row[key])) / (float(str(row[over])) if over else 1.0) for row in moved]
    return min(found), max(found)


LATER, BEFORE, WIND = (
    "brake a quarter of a swing later",
    "brake 0.3 s before the generator is off",
    "another seed of the wind",
)
QUICK = (LATER, BEFORE, WIND)
FLEXIBLE = "flexible shafts"


def results(one: Chain, normal: Extremes, stop: Extremes) -> Record:
    """The results that guesses are judged by.

    Parameters
    ----------
    one : Chain
        The machine.
    normal, stop : Mapping[str, Extreme]
        Extremes of both states.
    """
    meshes = mesh_changes(one, normal, stop)
    bearings = bearing_changes(one, normal, stop)
    found: Record = {grown(name): of.ratio for name, of in meshes.items()}
    last = list(meshes.values())[-1]
    found[f"{last.name}: least over rated"] = last.least / last.rated
    rear = f"stage {len(one.rig.machine.stages)} "
    fast = [b.name for b in one.rig.machine.bearings if b.holds.startswith(rear)]
    if known := [name for name in fast if name in bearings][-2:]:
        found[grown(known[0])] = bearings[known[0]].ratio
    pins = planet_pins(one)
    if pins is not None:
        for number, (up, down) in enumerate(zip(*pins, strict=True), start=1):
            found[sides(number)] = bearings[up].stop / bearings[down].stop
    return found


def planet_pins(one: Chain) -> tuple[list[str], list[str]] | None:
    """Upwind and downwind bearings of the first stage's planets; None where it has no two."""
    stage = one.rig.machine.stages[0]
    pins = getattr(stage, "pins", ())
    if len(pins) != 2:
        return None
    ordered = sorted(pins, key=lambda pin: pin.offset)
    up, down = (
        [f"stage 1 pin {k + 1} {pin.name}".strip() for k in range(stage.planets)]  # type: ignore[union-attr]
        for pin in ordered
    )
    return up, down


def guesses(one: Chain) -> dict[str, Callable[[], Both]]:
    """Both states with each guess changed, by what is changed."""
    return {**of_stop(one), **of_machine(one), **of_wind(one)}


def of_stop(one: Chain) -> dict[str, Callable[[], Both]]:
    """Guesses of the sequence and of the brake."""
    later = one.stop.by_instant
    quarter = 0.25 * (0.4 if later is None else later.period)
    key = "brake_torque" if "brake_torque" in one.values else "brake"
    brake = float(one.values[key])
    changed: dict[str, Mapping[str, float | str]] = {
        LATER: {"braked": 3.0 + quarter},
        "brake together with the generator's loss": {"braked": 1.0},
        BEFORE: {"braked": 1.0, "off": 1.3, "pitched": 3.3},
        "blades pitched in 1 s in place of 2 s": {"pitched": 2.0},
        "blades pitched in 4 s": {"pitched": 5.0},
        "brake grows in 0.05 s in place of 0.2 s": {"rise": 0.05},
        "a brake larger by a quarter": {key: 1.25 * brake},
        "disc at the gearbox in place of the generator": {"shaft": one.rig.machine.shafts[-1].name},
    }

    def run(values: Mapping[str, float | str]) -> Both:
        return one.normal.extremes, one.rig.stop({**one.values, **values}).extremes

    return {name: lambda values=values: run(values) for name, values in changed.items()}  # type: ignore[misc]


def of_machine(one: Chain) -> dict[str, Callable[[], Both]]:
    """Guesses of damping, bearings, backlash, and the level of the model."""
    rig = one.rig
    damping = rig.rated.damping
    twice = damping.model_copy(
        update={"shafts": 2.0 * damping.shafts, "meshes": min(1.0, 2.0 * damping.meshes)}
    )
    rigs: dict[str, Callable[[], Rig]] = {
        FLEXIBLE: lambda: other_level(one, Level.FLEXIBLE),
        "twice the damping ratios": lambda: replace(rig, rated=replace(rig.rated, damping=twice)),
        "bearings half as stiff": lambda: with_bearings(rig, 0.5),
        "bearings twice as stiff": lambda: with_bearings(rig, 2.0),
        "backlash of 0.2 mm in all meshes": lambda: replace(
            rig, rated=replace(rig.rated, backlash=2e-4)
        ),
    }

    def run(made: Callable[[], Rig]) -> Both:
        of = made()
        normal: LevelRun = of.normal(one.history)
        return normal.extremes, of.stop(one.values).extremes

    return {name: lambda made=made: run(made) for name, made in rigs.items()}  # type: ignore[misc]


def with_bearings(rig: Rig, times: float) -> Rig:
    """A machine whose bearings and pins are so many times as stiff."""
    data = rig.machine.model_copy(deep=True)

    def stiffer(parts: tuple, /) -> tuple:  # type: ignore[type-arg]
        return tuple(
            one.model_copy(update={"stiffness": tuple(times * k for k in one.stiffness)})
            for one in parts
        )

    stages = tuple(
        stage.model_copy(update={"pins": stiffer(tuple(stage.pins))})
        if hasattr(stage, "pins")
        else stage
        for stage in data.stages
    )
    changes = {"bearings": stiffer(tuple(data.bearings)), "stages": stages}
    return replace(rig, machine=data.model_copy(update=changes))


def of_wind(one: Chain) -> dict[str, Callable[[], Both]]:
    """Guesses of what drives the machine in normal operation."""
    rated = one.rig.rated
    power, speed = rated.torque * rated.rotor_speed, rated.rotor_speed

    def run(wind: float, turbulence: str, seed: int, alone: bool) -> Both:
        made = scaled_to(turbine_in_wind(wind, turbulence, seed), power, speed)
        return one.rig.normal(driving(made, alone)).extremes, one.stop.extremes

    return {
        WIND: lambda: run(16.0, "medium", 2, False),
        "high turbulence": lambda: run(16.0, "high", 1, False),
        "wind of 24 m/s": lambda: run(24.0, "medium", 1, False),
        "the torque alone, without moments at the hub": lambda: run(16.0, "medium", 1, True),
    }


def of_rollers(one: Chain, folder: Path, every: float) -> list[Record]:
    """Pressure and rollers of the first upwind planet bearing by its size and clearance.

    Parameters
    ----------
    one : Chain
        The machine, with bearings of `scaled_bearings`.
    folder : Path
        Takes catalogues.
    every : float
        Time from one equilibrium of rollers to the next [s].
    """
    pins = planet_pins(one)
    assert pins is not None
    name, rows = pins[0][0], []
    sizes = ((1.0, CLEARANCE), (1.0, 0.0), (1.0, 2 * CLEARANCE), (0.8, CLEARANCE))
    for size, clearance in (*sizes, (1.25, CLEARANCE)):
        lives = scaled_bearings(folder, size, clearance)
        counted, _ = counted_parts(one.drivetrain, one.rig.machine, lives, False)
        of = next(b for b in counted.bearings if b.entry_name == PLANET)
        row: Record = {"size": size, "diametral clearance [mm]": 1e3 * clearance}
        for state, result in (("normal", one.normal), ("shutdown", one.stop)):
            rolls = rolling(of, result.samples, name, every)
            row[f"pressure, {state} [MPa]"] = float(rolls.pressure.max()) / 1e6
            row[f"{FEWEST}, {state}"] = int(rolls.loaded.min())
            row[f"most rollers loaded, {state}"] = int(rolls.loaded.max())
        rows.append(row)
    return rows
