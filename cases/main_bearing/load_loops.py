"""Where loads on a main bearing point, and how often they run in loops."""

from collections.abc import Sequence
from itertools import product

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats
from fe_drivetrain.report import density_chart
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.shafts.beam import MainBearingBeam, pinned_model, torsional_spring_model
from fe_drivetrain.turbine_loads.hub_loads import (
    Condition,
    HubLoadSet,
    Loops,
    Rotor,
    find_loops,
    hub_load_set,
    loop_statistics,
    surrogate_grid,
)
from fe_drivetrain.turbine_loads.hub_loads.loops import SHARE

FORCE, MOMENT = slice(1, 3), slice(4, 6)

#: Of Fig 3.19: wind speed, turbulence, shear; seconds; what its text says of force and moment.
EXAMPLES = (
    (10.0, "medium", 0.2, 1.5, "500, 400, 500 kN", "100, 0, 500 kN m; turns by 360 deg"),
    (16.0, "low", 0.6, 1.0, "to less than half, and back; 30 deg", "the same"),
    (20.0, "high", 0.2, 1.5, "500, almost 0, 400 kN", "0, 1000, 100, 800 kN m; 90 deg"),
)

LEAST, WITHOUT = "smallest excursion over mean magnitude", "histories without a loop"
#: Excursions over the mean magnitude, in place of a tenth.
SHARES = (0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0)


@case(
    "Load loops of main bearings with and without tilting stiffness",
    source="Stirling 2023, section 3.5; Hart 2020, doi 10.1002/we.2549",
)
def run(run: Run, page: Page) -> None:
    """Direction of force and moment, and loops of both, over 144 histories."""
    grid = surrogate_grid()
    if run.quick:
        kept = product((10.0, 16.0, 20.0), ("low", "medium", "high"), (0.2, 0.6), (1,))
        grid = [Condition(*c) for c in kept]
    with run.step("hub loads"):
        hub = hub_load_set(grid, *((60.0, 10.0) if run.quick else ()))
    beam = MainBearingBeam()
    tapered = 1e-3 * torsional_spring_model(hub.loads, beam)
    paths = {
        "DSRB, force": 1e-3 * pinned_model(hub.loads, beam)[..., FORCE],
        "DTRB, force": tapered[..., FORCE],
        "DTRB, moment": tapered[..., MOMENT],
    }
    definition(page)
    directions(page, hub, paths)
    with run.step("loops"):
        loops = {name: loops_of(hub, path) for name, path in paths.items()}
    whole = statistics(page, hub, loops)
    examples(page, hub, loops)
    check(page, hub, paths["DTRB, moment"], loops["DTRB, moment"])
    with run.step("thresholds"):
        rows = sensitivity(page, hub, paths)
    answer(page, whole, rows, all(len(of) > 0 for of in loops["DTRB, moment"]))


HERO = "Time in loops against the smallest that counts, medium turbulence, first seed of each"
HART = 50.0
"""Share of time that force loops of half of the mean take, about, by Hart 2020 [%]."""


def answer(page: Page, whole: dict[str, Record], rows: list[Record], everywhere: bool) -> None:
    """State how often loads run in loops, by a tenth of the mean and by all of it.

    `rows` are of other excursions; `everywhere` is whether every history has loops of a tenth.
    The thesis defines no loop, so that its statement holds only if it does by each excursion.
    """
    moment, force = whole["DTRB, moment"], whole["DTRB, force"]
    share, rate = "share of time [%]", "rate over 3P"
    by_excursion = {(row["load"], row[LEAST]): float(row[share]) for row in rows}
    large = by_excursion["DTRB, moment", SHARES[-1]]
    by_each = not any(row[WITHOUT] for row in rows if row["load"] == "DTRB, moment")
    small = f"threshold {100 * SHARE:g}\u00a0%"
    page.answer(
        "How often do loads on a main bearing run in loops?",
        f"{'At every wind speed' if everywhere else 'Not in every history'} the double-row "
        f"bearing's moment runs in loops, {moment[share]:.0f}\u00a0% of the time at {small}, "
        f"{large:.0f}\u00a0% at {100 * SHARES[-1]:g}\u00a0%; the thesis defines none.",
        [
            page.value(
                f"time in moment loops, double-row bearing, {small} [%]", float(moment[share])
            ),
            page.value(f"the same, threshold {100 * SHARES[-1]:g} %, medium turbulence [%]", large),
            page.value(f"moment loops for each blade passing, {small}", float(moment[rate])),
            page.value(
                f"time in force loops, double-row bearing, {small} [%]", float(force[share])
            ),
            page.value(f"force loops for each blade passing, {small}", float(force[rate])),
            page.value(
                "time in force loops, spherical bearing, threshold 50 % [%]",
                by_excursion["DSRB, force", 0.5],
                beside=HART,
                by="Hart 2020, about",
            ),
        ],
        hero=HERO,
        cautions=[
            "The threshold is ours: a loop counts if it leads away from its start by that share of "
            "the mean load. "
            + (
                "Every history has moment loops by each threshold."
                if by_each
                else "By larger thresholds some histories have none."
            ),
            "The definition of Hart 2020 was not read. The simulated rotor is balanced, its blades "
            "are rigid.",
        ],
        claim="does not hold" if not everywhere else "holds" if by_each else "holds in part",
    )


def definition(page: Page) -> None:
    """What is counted, and of what."""
    page.text(
        "A loop is a part of the path of the load, in the plane across the shaft, that starts and "
        "ends where the path crosses itself, takes 2 s at most, leads away from the crossing by at "
        "least a tenth of the history's mean magnitude, and is no thinner than an ellipse of 1 to "
        "8. Of overlapping loops as many are kept as fit one after another; they are then cut out, "
        "and the rest is searched again. The thesis shows loops by eye and defines none; Hart 2020 "
        "has a definition, which was not read."
    )
    page.text(
        "DSRB is a spherical bearing (Eq 3.1), DTRB a double-row tapered one (Eq 3.18 and 3.19). "
        "Hub loads are a surrogate of a generic 2 MW turbine, the thesis's own are not public. Its "
        "blades are rigid and its rotor is balanced: in the fixed frame there is turbulence, 3P "
        "and its multiples, and no 1P."
    )


def loops_of(hub: HubLoadSet, path: Floats, excursion: float | None = None) -> list[Loops]:
    """Loops of each history."""
    return [find_loops(hub.time, *one.T, excursion=excursion) for one in path]


def blade_passing(condition: Condition) -> float:
    """3P [Hz]."""
    return 3.0 * Rotor().rotor_speed(condition.wind_speed) / (2.0 * np.pi)


def averaged(hub: HubLoadSet, loops: Sequence[Loops], chosen: Sequence[int]) -> Record:
    """Statistics of some histories, averaged."""
    duration = float(hub.time[-1] - hub.time[0])
    of = [loop_statistics(loops[i], duration, blade_passing(hub.conditions[i])) for i in chosen]
    mean = {key: float(np.nanmean([one[key] for one in of])) for key in of[0]}
    return {
        "share of time [%]": 100.0 * mean["share of time"],
        "rate over 3P": mean["rate over 3P"],
        "median duration [s]": mean["median duration [s]"],
        "median swept angle [deg]": mean["median swept angle [deg]"],
        "largest [deg]": max(one["largest swept angle [deg]"] for one in of),
        "median range [kN, kN m]": mean["median magnitude range"],
        "largest [kN, kN m]": max(one["largest magnitude range"] for one in of),
    }


def directions(page: Page, hub: HubLoadSet, paths: dict[str, Floats]) -> None:
    """Density of force and moment as the thesis's figures 3.17 and 3.18, and numbers of it."""
    page.section("Where the loads point")
    rows: list[Record] = []
    for i, c in enumerate(hub.conditions):
        if (c.turbulence, c.shear, c.seed) != ("medium", 0.2, 1):
            continue
        force, moment = paths["DTRB, force"][i], paths["DTRB, moment"][i]
        for name, path, unit in (("force", force, "kN"), ("moment", moment, "kN m")):
            caption = f"DTRB, radial {name} at {c.wind_speed:g} m/s, looking downwind"
            page.add(density_chart(caption, -path[:, 0], path[:, 1], unit))
        rows.append(
            {
                "wind [m/s]": c.wind_speed,
                "force, mean direction [deg]": direction(force)[0],
                "its spread [deg]": direction(force)[1],
                "force, least and largest [kN]": spread(force),
                "moment, mean [kN m]": float(np.hypot(*moment.T).mean()),
                "its largest [kN m]": float(np.hypot(*moment.T).max()),
                "height over width of its cloud": float(moment[:, 1].std() / moment[:, 0].std()),
                "moment, time in the quarters right, up, left, down [%]": quarters(moment),
            }
        )
    page.table(
        "Direction of the DTRB's loads, medium turbulence, shear 0.2: 0 deg right, 90 up, 180 "
        "left, 270 down, a moment by its axis",
        rows,
    )
    page.data("directions", rows)
    page.text(
        "As the thesis says, forces point down (270 deg) and spread with wind speed; moments grow "
        "with it and point everywhere, their clouds taller than wide (its section 4.5): K_R is "
        "larger in the horizontal plane. Right is the moment of the rotor's weight, left that of "
        "an overturning wind; with the wind the cloud moves left."
    )


def direction(path: Floats) -> tuple[float, float]:
    """Mean direction, looking downwind, and its circular standard deviation [deg]."""
    unit = (-path[:, 0] + 1j * path[:, 1]) / np.hypot(*path.T)
    mean = unit.mean()
    return float(np.degrees(np.angle(mean)) % 360.0), float(
        np.degrees(np.sqrt(-2.0 * np.log(np.abs(mean))))
    )


def spread(path: Floats) -> str:
    """Least and largest magnitude."""
    size = np.hypot(*path.T)
    return f"{size.min():.0f}, {size.max():.0f}"


def quarters(path: Floats) -> str:
    """Time in each quarter of the directions [%]."""
    angle = np.degrees(np.arctan2(path[:, 1], -path[:, 0]))
    of = np.floor(((angle + 45.0) % 360.0) / 90.0)
    return ", ".join(f"{100.0 * np.mean(of == k):.0f}" for k in range(4))


def statistics(page: Page, hub: HubLoadSet, loops: dict[str, list[Loops]]) -> dict[str, Record]:
    """Loops by wind speed, turbulence and shear; those of all histories, by load."""
    rows: list[Record] = []
    for name, of in loops.items():
        for key in ("wind_speed", "turbulence", "shear"):
            for value in dict.fromkeys(getattr(c, key) for c in hub.conditions):
                chosen = [i for i, c in enumerate(hub.conditions) if getattr(c, key) == value]
                word = f"{key.replace('_', ' ')} {value}" + (" m/s" if "wind" in key else "")
                rows.append({"load": name, "histories": word, **averaged(hub, of, chosen)})
    page.section("Loops")
    page.table("Loops of more than a tenth of the mean magnitude, means over histories", rows)
    page.data("loops", rows)
    return {name: averaged(hub, of, range(len(of))) for name, of in loops.items()}


def examples(page: Page, hub: HubLoadSet, loops: dict[str, list[Loops]]) -> None:
    """The loops that change most under the conditions of Fig 3.19."""
    rows: list[Record] = []
    for wind, turbulence, shear, seconds, force, moment in EXAMPLES:
        of = [
            i
            for i, c in enumerate(hub.conditions)
            if (c.wind_speed, c.turbulence, c.shear) == (wind, turbulence, shear)
        ]
        for load, thesis, unit in (
            ("DTRB, force", force, "kN"),
            ("DTRB, moment", moment, "kN m"),
        ):
            best = max(
                (
                    (high - low, low, high, swept, duration)
                    for i in of
                    for low, high, swept, duration in zip(
                        loops[load][i].lowest,
                        loops[load][i].highest,
                        loops[load][i].swept,
                        loops[load][i].duration,
                        strict=True,
                    )
                    if duration <= seconds
                ),
                default=None,
            )
            ours = "none"
            if best is not None:
                _, low, high, swept, duration = best
                ours = f"{low:.0f} to {high:.0f} {unit}; {np.degrees(swept):.0f} deg"
                ours += f" in {duration:.1f} s"
            rows.append(
                {
                    "history": f"{wind:g} m/s, {turbulence} turbulence, shear {shear:g}",
                    "load": load,
                    "within [s]": seconds,
                    "thesis": thesis,
                    "ours: range of the loop that changes most": ours,
                }
            )
    page.table("Examples of the thesis's figure 3.19, and loops of the same conditions", rows)
    page.data("examples", rows)
    page.text(
        "The thesis's examples were chosen to show variety, and so were ours: by the largest range "
        "of magnitude. Directions at magnitudes near zero turn by any angle."
    )


def check(page: Page, hub: HubLoadSet, path: Floats, loops: list[Loops]) -> None:
    """What must not change the number of loops."""
    c, s = np.cos(0.7), np.sin(0.7)
    turned = loops_of(hub, path @ np.array([[c, s], [-s, c]]))
    back = loops_of(hub, path[:, ::-1])
    for words, other in (("the plane turned by 40 deg", turned), ("time reversed", back)):
        page.vanishes(
            f"moment loops, {words}: difference of their number over all histories",
            float(sum(abs(len(a) - len(b)) for a, b in zip(loops, other, strict=True))),
            within=0.0,
            why="crossings, distances and areas stay",
            source="definition",
        )
    page.holds(
        "every history has loops of the moment",
        all(len(of) > 0 for of in loops),
        why="they are found over the whole operating range",
        source="Stirling 2023, section 3.5",
    )


def sensitivity(page: Page, hub: HubLoadSet, paths: dict[str, Floats]) -> list[Record]:
    """Loops by smallest excursion, sampling and noise; rows of the former."""
    chosen = [i for i, c in enumerate(hub.conditions) if c.turbulence == "medium" and c.seed == 1]
    rows = by_excursion(hub, paths, chosen)
    page.section("What a loop is decides how many there are")
    page.sweep(
        HERO,
        rows,
        LEAST,
        "share of time [%]",
        by="load",
        reference={f"Hart 2020, DSRB: about {HART:g} %": HART},
    )
    spoilt = by_sampling_and_noise(hub, paths["DTRB, moment"], chosen)
    page.table("Moment loops of half of the mean magnitude: sampling and noise", spoilt)
    page.data("sampling and noise", spoilt)
    return rows


def by_excursion(hub: HubLoadSet, paths: dict[str, Floats], chosen: list[int]) -> list[Record]:
    """Share of time and rate of the loops of each load, by the smallest excursion that counts."""
    rows: list[Record] = []
    for name, path in paths.items():
        for share in SHARES:
            numbers, without = [], 0
            for i in chosen:
                least = share * float(np.hypot(*path[i].T).mean())
                loops = find_loops(hub.time, *path[i].T, excursion=least)
                without += len(loops) == 0
                numbers.append(
                    loop_statistics(loops, float(hub.time[-1]), blade_passing(hub.conditions[i]))
                )
            rows.append(
                {
                    "load": name,
                    LEAST: share,
                    "share of time [%]": 100.0
                    * float(np.mean([one["share of time"] for one in numbers])),
                    "rate over 3P": float(np.mean([one["rate over 3P"] for one in numbers])),
                    WITHOUT: without,
                }
            )
    return rows


def by_sampling_and_noise(hub: HubLoadSet, path: Floats, chosen: list[int]) -> list[Record]:
    """Loops of half of the mean magnitude where samples are left out or noise is added."""
    rng = np.random.default_rng(0)
    rows: list[Record] = []
    for words, every, noise in (
        ("as it is", 1, 0.0),
        ("every second sample", 2, 0.0),
        ("noise, 1 % of the mean magnitude", 1, 0.01),
        ("noise, 3 % of the mean magnitude", 1, 0.03),
    ):
        found: list[dict[str, float]] = []
        for i in chosen:
            size = float(np.hypot(*path[i].T).mean())
            spoilt = (path[i] + noise * size * rng.normal(size=path[i].shape))[::every]
            # larger loops, which noise and sampling should leave
            one = find_loops(hub.time[::every], *spoilt.T, excursion=0.5 * size)
            found.append(
                loop_statistics(one, float(hub.time[-1]), blade_passing(hub.conditions[i]))
            )
        rows.append(
            {
                "series": words,
                "share of time [%]": 100.0
                * float(np.mean([one["share of time"] for one in found])),
                "rate over 3P": float(np.mean([one["rate over 3P"] for one in found])),
                "median duration [s]": float(
                    np.nanmean([one["median duration [s]"] for one in found])
                ),
            }
        )
    return rows
