"""Wind fields on grids, as TurbSim and HAWC2 write them: how fine a grid hub loads need."""

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats, scratch_folder
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.turbine_loads.histories import damage_equivalent_load, rainflow_cycles
from fe_drivetrain.turbine_loads.hub_loads import (
    LoadHistory,
    Rotor,
    WindBox,
    box_hub_loads,
    read_bts,
    read_hawc2,
    write_bts,
    write_hawc2,
)

SPEED, SIGMA, LENGTH = 12.0, 1.5, 340.2  # m/s, m/s, m
ROTOR = Rotor()
REACH = 1.1 * ROTOR.radius
RATE = 10.0  # Hz
ENOUGH = 0.05
DAMAGE = "My, error of DEL, m = 4 [%]"
ERROR_BY_GRID = "Error of the moment My against points of wind over the rotor's diameter"


@dataclass(frozen=True, eq=False)
class Waves:
    """Wind as a sum of plane waves, known everywhere."""

    amplitude: Floats
    frequency: Floats  # rad/s
    across: Floats  # rad/m
    upwards: Floats
    phase: Floats

    def at(self, time: Floats, y: Floats, z: Floats) -> Floats:
        """(n, p) [m/s] at times (n,) and points (p,)."""
        waves = np.outer(y, self.across) + np.outer(z, self.upwards) + self.phase
        found = np.zeros((len(time), len(y)))
        for k, turn in enumerate(self.frequency):
            found += self.amplitude[k] * np.cos(turn * time[:, None] + waves[:, k])
        return SPEED + found


def waves(count: int) -> Waves:
    """Energy over frequency as Kaimal's; eddies as long across the wind as along it."""
    generator = np.random.default_rng(5)
    hertz = np.geomspace(0.01, 1.0, count)
    passage = LENGTH / SPEED
    energy = np.gradient(hertz) * 4.0 * passage / (1.0 + 6.0 * hertz * passage) ** (5.0 / 3.0)
    amplitude = SIGMA * np.sqrt(2.0 * energy / energy.sum())
    number, angle = 2.0 * np.pi * hertz / SPEED, generator.uniform(0.0, 2.0 * np.pi, count)
    return Waves(
        amplitude,
        2.0 * np.pi * hertz,
        number * np.cos(angle),
        number * np.sin(angle),
        generator.uniform(0.0, 2.0 * np.pi, count),
    )


@case(
    "Wind fields of TurbSim and HAWC2 on a rotor: error of hub loads against the grid",
    source="a sum of plane waves with Kaimal's energy, known everywhere",
)
def run(run: Run, page: Page) -> None:
    """Loads of one wind on ever finer grids; the same through files of both programs."""
    seconds = 60.0 if run.quick else 300.0
    wind = waves(40 if run.quick else 120)
    time = np.arange(0.0, seconds, 1.0 / RATE)
    counts = (5, 9, 17, 33) if run.quick else (5, 7, 9, 13, 17, 25, 33, 49, 65)
    loads: dict[int, LoadHistory] = {}
    for count in counts:
        with run.step(f"{count} x {count} points"):
            loads[count] = box_hub_loads(box_of(wind, time, count))
    finest = loads[counts[-1]]
    rows: list[Record] = []
    for count in counts[:-1]:
        error = loads[count].loads[:, 4] - finest.loads[:, 4]
        rows.append(
            {
                "points over the diameter": (count - 1) * ROTOR.radius / REACH,
                "My, error of rms [%]": 100.0 * float(error.std() / finest.loads[:, 4].std()),
                DAMAGE: 100.0 * abs(equivalent(loads[count]) / equivalent(finest) - 1.0),
            }
        )
    page.section("Points of the grid")
    page.sweep(
        ERROR_BY_GRID,
        rows,
        "points over the diameter",
        {"My, error of rms [%]": "rms", DAMAGE: "equivalent load, m = 4"},
        log="xy",
        reference={"enough": 100.0 * ENOUGH},
        axis="error of My [%]",
    )
    enough = [r for r in rows if r[DAMAGE] <= 100.0 * ENOUGH]
    page.limit(
        "hub loads of a wind field on a grid",
        "points over the diameter",
        low=float(enough[0]["points over the diameter"]) if enough else None,
        high=None,
        criterion=f"damage-equivalent load of My within {ENOUGH:.0%}",
        beyond="gusts smaller than the spacing are cut, and with them 3P and its multiples",
        program="takes the grid as it is; refuses a rotor that reaches out of it",
        remedy="write the field on a finer grid",
    )
    coarse, fine = (r["My, error of rms [%]"] for r in (rows[0], rows[-1]))
    page.at_most(
        "error of My on the finest grid but one over that on the coarsest",
        fine / coarse,
        0.2,
        why="linear between points: second order of the spacing once gusts are resolved",
        source="interpolation",
        measure=None,
    )
    files(run, page, box_of(wind, time, 17))
    answer(page, rows, enough, counts[-1])


def answer(page: Page, rows: list[Record], enough: list[Record], finest: int) -> None:
    """State how many points over the rotor keep the moment's equivalent load."""
    points, spread, damage = "points over the diameter", "My, error of rms [%]", DAMAGE
    first, last = rows[0], rows[-1]
    found = (
        f"{float(enough[0][points]):.2g} wind points over the rotor's diameter give"
        if enough
        else f"Not even {float(last[points]):.2g} wind points over the rotor's diameter give"
    )
    page.answer(
        "How fine must a wind grid be for hub loads?",
        f"{found} the equivalent tilt moment My within {100 * ENOUGH:g}\u00a0%; "
        f"{float(first[points]):.2g} points give an error of {float(first[damage]):.2g}\u00a0%.",
        [
            page.value(
                f"error of the equivalent tilt moment My, {last[points]:.2g} points [%]",
                last[damage],
                at_most=100.0 * ENOUGH,
            ),
            *(
                page.value(f"{what}, {row[points]:.2g} points [%]", row[key])
                for what, key, row in (
                    ("error of the equivalent tilt moment My", damage, first),
                    ("rms error of My over time", spread, first),
                    ("rms error of My over time", spread, last),
                )
            ),
        ],
        hero=ERROR_BY_GRID,
        cautions=[
            f"Errors are those against {finest} × {finest} points, not against the true wind.",
            "Files of TurbSim and HAWC2 add less than a thousandth of the largest load's spread.",
        ],
    )


def box_of(wind: Waves, time: Floats, count: int) -> WindBox:
    """The wind on a square grid."""
    y = np.linspace(-REACH, REACH, count)
    places = np.meshgrid(y, y, indexing="ij")
    speed = wind.at(time, *(a.ravel() for a in places)).reshape(len(time), count, count)
    return WindBox("waves", 1.0 / RATE, y, ROTOR.hub_height + y, speed.astype(np.float32))


def equivalent(history: LoadHistory) -> float:
    """Damage-equivalent load of My, m = 4, 1 Hz."""
    return damage_equivalent_load([rainflow_cycles(history.loads[:, 4])], len(history) / RATE, 4.0)


def files(run: Run, page: Page, box: WindBox) -> None:
    """Loads of a field that was written and read."""
    hub = ROTOR.hub_height
    with run.step("files"), scratch_folder() as folder:
        write_bts(box, folder / "waves.bts", hub)
        write_hawc2(box, folder / "u.bin", SPEED, hub, 0.0)
        spacing = SPEED * box.step, float(np.diff(box.y)[0]), float(np.diff(box.z)[0])
        planes, points, heights = box.speed.shape
        found = {
            "TurbSim": read_bts(folder / "waves.bts"),
            "HAWC2": read_hawc2(folder / "u.bin", (planes, points, heights), spacing, SPEED, hub),
        }
    exact = box_hub_loads(box).loads
    spread = exact.std(axis=0).max()
    for name, read in found.items():
        page.at_most(
            f"{name}: hub loads of the field that was written and read, largest difference over "
            "the standard deviation of the largest load",
            float(np.abs(box_hub_loads(read).loads - exact).max() / spread),
            1e-3,
            why="16 bits over a range of ten standard deviations, or single precision",
            source="the field itself",
            measure="identity",
        )
