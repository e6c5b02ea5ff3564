"""Where a main bearing is used up: which row, which ring, where on it, where along the rollers."""

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.bearing import angles, turn
from fe_drivetrain.bearing_life.life import lamina_life, stress_riser
from fe_drivetrain.cases import case
from fe_drivetrain.cases.life.operating import state_assumptions, state_meaning
from fe_drivetrain.cases.references.studied_lives import (
    EDGES,
    SPEEDS,
    Setup,
    Winds,
    by_chunks,
    by_wind,
    on_rigid_rings,
    own_setup,
    roller_rows,
    rotor_speed,
    thesis_setup,
)
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import round_off
from fe_drivetrain.report import Chart, heat_map, trace
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.turbine_loads.histories import Site

MEAN_WIND = 8.0
ROWS = ("upwind", "downwind")

#: Weibull's slope of line contact, and life's exponent of load for each part of a ring.
SLOPE, FOURTH = 9.0 / 8.0, 4.0

HOURS = 60.0 * 8760.0


@dataclass(frozen=True)
class Used:
    """Damage a year at each wind speed of each part of the rings, and by Miner's sum over steps.

    Attributes
    ----------
    outer : Floats
        (winds, rows, places, laminae).
    inner : Floats
        (winds, rows, laminae): every place of the ring that turns meets all loads.
    steps : Floats
        (winds,) of the whole bearing, rated at each step as one.
    """

    outer: Floats
    inner: Floats
    steps: Floats

    def at(self, mean_wind: float) -> "Used":
        """At a site: of each part, with all its winds."""
        weights = Site(mean_wind).shares(EDGES)
        parts = (np.tensordot(weights, one, 1)[None] for one in (self.outer, self.inner))
        outer, inner = parts
        return Used(outer, inner, np.array([weights @ self.steps]))

    def risks(self) -> tuple[Floats, Floats]:
        """Risk of each place (winds, rows, places, laminae) and of the rings that turn."""
        return self.outer**SLOPE, self.inner**SLOPE

    def life(self) -> Floats:
        """(winds,) [years] in which a tenth fails, each part with its own sum of damage."""
        outer, inner = self.risks()
        return np.asarray((outer.sum(axis=(1, 2, 3)) + inner.sum(axis=(1, 2))) ** (-1.0 / SLOPE))


@case(
    "Where a main bearing's life is used up: row, ring, place, lamina",
    source="Stirling 2023, sections 5.2.2 and 5.3.3; Lundberg and Palmgren's weakest link",
)
def run(run: Run, page: Page) -> None:
    """Damage of each place of the outer rings, summed over all winds of a site."""
    state_assumptions(page)
    winds = Winds("medium", 0.2, 2, 20.0, 1.0) if run.quick else Winds("medium", 0.2, 6, 600.0, 0.5)
    with run.step("hub loads"):
        hub = winds.hub_loads()
    rows: list[Record] = []
    for words, setup in (("choices of the thesis", thesis_setup()), ("our choices", own_setup())):
        with run.step(words):
            u = setup.deflections(hub)
            used = damage(setup, u)
        if words == "our choices":
            turned(page, setup, u)
        check(page, words, used)
        show(page, words, used)
        rows.append(summary(setup, words, used))
    for name, top in (("upwind", -1.0), ("downwind", 1.0)):
        centre = rows[0][f"{name}, centre [deg]"]
        page.at_least(
            f"choices of the thesis: {name} row, height of the centre of damage over its distance "
            f"from the axis, {'upwards' if top > 0.0 else 'downwards'}",
            top * float(np.sin(np.radians(centre))),
            0.5,
            why="within 60 deg of the place where the mean load of rollers is largest",
            source="Stirling 2023, section 5.2.2: upwind row at the bottom, downwind row on top",
            measure="identity",
        )
    page.section("In numbers")
    page.table(
        f"At a site of {MEAN_WIND:g} m/s; 0 deg right, 90 deg on top, looking downwind", rows
    )
    page.data("where", rows)
    state_meaning(page)
    answer(page, *rows)
    more = [100.0 * (row["life by place over life by step"] - 1.0) for row in rows]
    page.say(
        f"The ring that turns does {min(row['inner rings [%]'] for row in rows):.0f} % of the "
        "damage or more. Because the load zone wanders, places of the standing ring share it: "
        f"damage that is summed place by place gives {more[0]:.1f} and {more[1]:.1f} % more life "
        "than Miner's sum over steps that are rated as one, which is on the safe side.",
    )


def caption(words: str) -> str:
    """Caption of the picture of the outer rings with some choices."""
    return f"Damage round the standing outer rings, {words}, site of {MEAN_WIND:g} m/s"


def is_where_stated(row: Record) -> bool:
    """Whether damage is where the thesis states it: upwind row more, below; downwind on top."""
    below, on_top = (np.sin(np.radians(row[f"{name}, centre [deg]"])) for name in ROWS)
    return bool(row["upwind row [%]"] > 50.0 and below < -0.5 and on_top > 0.5)


def answer(page: Page, thesis: Record, own: Record) -> None:
    """State which row and place are used up first, with the thesis's choices and with ours."""
    share, ours = (float(row["upwind row [%]"]) for row in (thesis, own))
    holds, also = is_where_stated(thesis), is_where_stated(own)
    upwind, downwind = (f"{name} row, centre of damage [deg]" for name in ROWS)
    places = [float(thesis[f"{name}, centre [deg]"]) for name in ROWS]
    stated = "near the bottom, as it says" if holds else f"at {places[0]:.0f}°, not where it says"
    downwind_own = float(own["downwind, centre [deg]"])
    off_top = (
        f"With our choices the centre of the downwind row's damage is at {downwind_own:.0f}°, not "
        "on top as the thesis says."
    )
    other = "in the same places" if also else "and not all holds"
    page.answer(
        "In which row of a main bearing, and where on it, is life used up?",
        f"With the thesis's choices the upwind row takes {share:.0f}\u00a0% of the damage, "
        f"{stated}; with ours {ours:.0f}\u00a0%, {other}.",
        [
            page.value("damage of the upwind row, thesis's choices [%]", share),
            page.value(upwind, places[0], beside=270.0, by="thesis, bottom"),
            page.value(downwind, places[1], beside=90.0, by="thesis, top"),
            page.value("damage of the upwind row, our choices [%]", ours),
            page.value(
                "downwind row, centre of damage, our choices [deg]",
                downwind_own,
            ),
            page.value(
                "damage of the rings that turn, thesis's choices [%]",
                float(thesis["inner rings [%]"]),
            ),
        ],
        hero=caption("choices of the thesis"),
        cautions=[
            *([off_top] if np.sin(np.radians(downwind_own)) <= 0.5 else []),
            "Angles are seen looking downwind: 0° right, 90° on top, 270° at the bottom.",
            "At each step one load stands for all places, on the safe side by a few percent.",
        ],
        claim="holds" if holds and also else "holds in part" if holds else "does not hold",
    )


def damage(setup: Setup, deflections: Floats) -> Used:
    """Damage of all parts at each wind speed."""
    riser = stress_riser(30) if setup.riser is None else setup.riser
    outer, inner, lives = [], [], []
    for u in deflections:

        def of_chunk(q: list[Floats]) -> dict[str, Floats]:
            rows = setup.rows(q)
            places = [
                np.sum((riser * one / row.outer_capacity) ** FOURTH, axis=0)
                / one.shape[1] ** (8 / 9)
                for one, row in zip(q, rows, strict=True)
            ]
            turning = [np.sum((row.inner / row.inner_capacity) ** FOURTH, axis=0) for row in rows]
            return {
                "outer": np.array(places)[None],
                "inner": np.array(turning)[None],
                "L": lamina_life(rows),
            }

        found = by_chunks(len(u), on_rigid_rings(setup.bearing, u), of_chunk)
        outer.append(found["outer"].sum(axis=0) / len(u))
        inner.append(found["inner"].sum(axis=0) / len(u))
        lives.append(found["L"])
    a_year = rotor_speed() * HOURS / 1e6
    return Used(
        np.array(outer) * a_year[:, None, None, None],
        np.array(inner) * a_year[:, None, None],
        1.0 / by_wind(np.array(lives)),
    )


def check(page: Page, words: str, used: Used) -> None:
    """Bounds of the two ways to sum damage."""
    ratio = used.life() * used.steps
    page.at_least(
        f"{words}: life by place over life by step, the least of all winds",
        float(ratio.min()),
        1.0,
        why="a norm of a sum is no larger than the sum of norms: wandering load zones only help",
        source="Minkowski's inequality with the exponent 9/8",
        measure="identity",
    )
    # all steps at their worst place: what places could share at most
    largest = (72.0 * 30.0 * 2.0) ** (1.0 - 8.0 / 9.0)
    page.at_most(
        f"{words}: life by place over life by step, the largest of all winds",
        float(ratio.max()),
        largest,
        why="as many equal parts, each damaged in steps of its own",
        source="norms of as many numbers differ by no more",
        measure="identity",
    )


def turned(page: Page, setup: Setup, deflections: Floats) -> None:
    """A turn of the inner ring's motion by one pitch moves the damage by one place."""
    few = deflections[:, :20]
    pitch = 2.0 * np.pi / roller_rows(setup.bearing)[0].rollers
    flat = few.reshape(-1, 5)
    moved = turn(flat, np.full(len(flat), pitch)).reshape(few.shape)
    one, other = (damage(setup, u).outer for u in (few, moved))
    page.vanishes(
        "damage of places, all motions turned by a pitch, less that of the next place, over the "
        "largest",
        float(np.abs(np.roll(one, 1, axis=2) - other).max() / one.max()),
        **round_off(
            1e4,
            "contact deflections are small differences of motions, and damage goes with their "
            "fourth power and more",
        ),
        source="rollers are equal",
    )


def summary(setup: Setup, words: str, used: Used) -> Record:
    """Summary of a site: rows, rings, centres of damage, and the life of both sums."""
    site = used.at(MEAN_WIND)
    outer, inner = (risk[0] for risk in site.risks())
    total = outer.sum() + inner.sum()
    psi = angles(roller_rows(setup.bearing)[0])
    centres = np.degrees(np.angle(outer.sum(axis=2) @ np.exp(1j * psi))) % 360.0
    of_rows = outer.sum(axis=(1, 2)) + inner.sum(axis=1)
    laminae = outer.sum(axis=(0, 1)) + inner.sum(axis=0)
    return {
        "choices": words,
        "upwind row [%]": 100.0 * float(of_rows[0] / total),
        "inner rings [%]": 100.0 * float(inner.sum() / total),
        "upwind, centre [deg]": float(centres[0]),
        "downwind, centre [deg]": float(centres[1]),
        "worst tenth of the places of both outer rings [%]": 100.0 * worst_tenth(outer),
        "end laminae, 4 of 30 [%]": 100.0 * float(laminae[[0, 1, -2, -1]].sum() / total),
        "life by place [years]": float(site.life()[0]),
        "life by step [years]": 1.0 / float(site.steps[0]),
        "life by place over life by step": float(site.life()[0] * site.steps[0]),
    }


def worst_tenth(outer: Floats) -> float:
    """Share of the outer rings' damage that a tenth of their places does."""
    places = np.sort(outer.sum(axis=2).ravel())[::-1]
    return float(places[: len(places) // 10].sum() / places.sum())


def show(page: Page, words: str, used: Used) -> None:
    """Polar picture of the outer rings, and damage over places and winds."""
    page.section(words.capitalize())
    site = used.at(MEAN_WIND)
    outer = site.risks()[0][0].sum(axis=2)
    share = 100.0 * outer / outer.sum()
    n = share.shape[1]
    psi = 2.0 * np.pi * np.arange(n + 1) / n
    traces = [
        trace(name, one[at] * np.cos(psi), one[at] * np.sin(psi), mode="lines+markers")
        for name, one in zip(ROWS, share, strict=True)
        for at in [np.arange(n + 1) % n]
    ]
    page.chart(
        caption(words),
        traces,
        "to the right, looking downwind [% of both outer rings]",
        "upwards [% of both outer rings]",
    )
    square = page.sections[-1].items[-1]
    assert isinstance(square, Chart)
    square.figure["layout"]["yaxis"]["scaleanchor"] = "x"
    weights = Site(MEAN_WIND).shares(EDGES)
    of_winds = weights[:, None, None] * used.outer.sum(axis=3)
    of_winds *= 100.0 / of_winds.sum()
    for k, name in enumerate(ROWS):
        page.add(
            heat_map(
                f"Where and when: {name} row, {words}; places of the outer ring against mean wind",
                np.degrees(psi[:-1]),
                SPEEDS,
                of_winds[:, k],
                ("place [deg]: 0 right, 90 top", "mean wind speed [m/s]", "% of damage"),
                limits=(0.0, float(of_winds.max())),
                xaxis={"dtick": 90},
            )
        )
    page.data(f"damage of places [%], {words}", share)
