"""Mesh orders and all crossings with natural frequencies of Al-Hamadani's drivetrains A to D."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import published_drivetrains as published
from fe_drivetrain.common import InputError
from fe_drivetrain.dynamics import (
    Crossing,
    crossings,
    equal_angles,
    excited_motion,
    gear_table,
    machine_of,
)
from fe_drivetrain.dynamics.torsion import (
    Toothed,
    absolute_sun_orders,
    gear_masses,
    mesh_orders,
    natural_modes,
)
from fe_drivetrain.gear import check_assembly, equally_spaced, sequence, sun_phases
from fe_drivetrain.report import Chart, chart, crosses, mark_events, trace
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.report.suite.chosen import SETTING

TABLE_4_8 = {"A": ("146", "730"), "B": ("154", "707.259", "2419.575"), "C": ("174", "648", "2664")}
RPM = np.pi / 30.0
WRONG = 1.0  # %, more than rounding leaves of a mesh order
CAMPBELL = (
    "Campbell diagram of drivetrain {}: right mesh orders (lines), natural frequencies (dotted), "
    "crossings marked"
)

#: Least, rated and largest speed of the rotor [rpm], Table 4.1.
SPEEDS = {
    "A": (8.6, 14.8, 18.4),
    "B": (8.6, 16.1, 18.4),
    "C": (10.8, 16.0, 19.1),
    "D": (14.8, 18.6, 22.1),
}


class Train(NamedTuple):
    """A drivetrain: kinds and teeth of its stages, and frequencies as printed and of its inputs."""

    stages: list[Toothed]
    printed: tuple[float, ...]
    computed: tuple[float, ...]


def trains() -> dict[str, Train]:
    """Teeth of Table 4.7 (of D, of public drawings), frequencies of Tables 6.4 and 6.1 [Hz]."""
    found = {}
    for letter, printed in published.OTHERS.items():
        table = published.table(f"drivetrain_{letter.lower()}")
        stages = [Toothed(s.kind, s.teeth) for s in table.stages if s.teeth]
        modes = natural_modes(gear_masses(table, "free"))
        computed = modes.frequencies[published.observable(modes)]
        found[letter] = Train(
            stages,
            tuple(float(f) for f in printed[1:]),
            tuple(float(f) for f in computed[1:]),
        )
    kinds, teeth = ("planetary", "parallel", "parallel"), ((99, 21), (82, 23), (88, 22))
    modes = natural_modes(gear_masses(published.table("nrel_750kw"), "free"))
    computed = modes.frequencies[published.observable(modes)]
    own = tuple(float(f) for f in published.ELEVEN["free"][1:])
    return {
        **found,
        "D": Train([*map(Toothed, kinds, teeth)], own, tuple(float(f) for f in computed[1:])),
    }


@case(
    "Mesh orders of drivetrains A to D, as printed and right, and all their crossings",
    source="Al-Hamadani 2018, Tables 4.1, 4.7, 4.8, 6.1 and 6.4, section 6.2.2",
    settings={"drivetrain": "FILE, or a name of the library (otherwise A to D of the thesis)"},
)
def run(run: Run, page: Page) -> None:
    """What Table 4.8 is, what it should be, and which crossings change with it."""
    if SETTING in run.settings:
        own(run, page)
        return
    found = trains()
    rows: list[Record] = []
    for letter, train in found.items():
        right, printed = mesh_orders(train.stages), absolute_sun_orders(train.stages)
        check_orders(page, letter, train, right, printed)
        for number, name in enumerate(right):
            kind, (large, small) = train.stages[number].kind, train.stages[number].teeth
            rows.append(
                {
                    "drivetrain": letter,
                    "stage": name,
                    "kind": kind,
                    "teeth": f"{large}/{small}",
                    "Table 4.8": TABLE_4_8[letter][number] if letter in TABLE_4_8 else "",
                    "ring and sun together": round(printed[name], 3),
                    "right": round(right[name], 3),
                    "printed over right": round(printed[name] / right[name], 3),
                }
            )
    page.section("Orders of the rotor's speed")
    page.table("Mesh frequencies over the rotor's", rows)
    page.text(
        "The mesh frequency of a planetary stage with its ring standing is the ring's teeth times "
        "the carrier's speed, which equals the sun's teeth times its speed against the carrier. "
        "Table 4.8 has the sun's teeth times its absolute speed: it counts the carrier's turn, too."
    )
    over = [
        100.0 * (float(row["printed over right"]) - 1.0)
        for row in rows
        if row["kind"] == "planetary" and row["Table 4.8"]
    ]
    counts = show_crossings(page, found)
    refused = show_assembly(page, found)
    answer(page, rows, over, counts, refused)


def own(run: Run, page: Page) -> None:
    """Mesh orders of a user's drivetrain, and what they cross in its range of speeds."""
    chosen = run.drivetrain("", gears=True)
    chosen.state(page, topic="Mesh orders and all their crossings with modes")
    table, speeds = gear_table(chosen.drivetrain), chosen.rotor_speeds()
    stages = [Toothed(*meshing) for meshing in machine_of(chosen.drivetrain).meshing]
    modes = natural_modes(gear_masses(table, "free"))
    computed = tuple(float(f) for f in modes.frequencies[published.observable(modes)][1:])
    right = mesh_orders(stages)
    check_orders(page, chosen.title, Train(stages, computed, computed), right, {})
    met = crossings(computed, right, speeds)
    low, high = (speed / RPM for speed in speeds)
    rows: list[Record] = [
        {
            "stage": one.order,
            "harmonic": one.harmonic,
            "frequency [Hz]": one.frequency,
            "speed [rpm]": speed(one),
        }
        for one in met
    ]
    page.section("Crossings")
    if rows:
        page.table(f"Crossings between {low:.4g} and {high:.4g} rpm", rows)
    else:
        page.text("No crossing within the range of speeds.")
    page.data("crossings", rows)
    page.add(campbell(chosen.title, Train(stages, computed, computed), met, (low, high, high)))
    words = f"cross torsional modes {len(met)} times" if met else "cross no torsional mode"
    page.answer(
        "Where do the meshes cross torsional natural frequencies?",
        f"From {low:.3g} to {high:.3g}\u00a0rpm three harmonics of the meshes {words}; the first "
        f"mode is at {value_text(computed[0], 'Hz')}.",
        [
            page.value("crossings of three harmonics", len(met)),
            *(page.value(f"mesh order, {name}", order) for name, order in right.items()),
            page.value("first torsional frequency [Hz]", computed[0]),
        ],
        CAMPBELL.format(chosen.title),
        ["Natural frequencies are those of torsion, with the generator free."],
    )


def answer(
    page: Page, rows: list[Record], over: list[float], counts: dict[str, list[int]], refused: int
) -> None:
    """State whether the printed mesh orders hold, and what the right ones cross."""
    right, printed = (sum(counts[kind]) for kind in ("right", "printed"))
    holds = max(over) < WRONG
    planetary = [row for row in rows if row["kind"] == "planetary" and row["Table 4.8"]]
    most = "ABCD"[int(np.argmax(counts["right"]))]
    page.answer(
        "Are the thesis's mesh orders right, and how often do they cross natural frequencies?",
        f"Printed mesh orders of planetary stages {'hold' if holds else 'do not hold'}: they "
        f"are {min(over):.0f} to {max(over):.0f}\u00a0% too high; correct ones cross natural "
        f"frequencies {right} times, not {printed}.",
        [
            page.value("largest excess of a printed mesh order [%]", max(over)),
            *(
                page.value(
                    f"mesh order of drivetrain {row['drivetrain']}, {row['stage']}",
                    float(str(row["right"])),
                    beside=float(str(row["Table 4.8"])),
                    by="Table 4.8",
                    printed=str(row["Table 4.8"]),
                )
                for row in planetary[:5:2]
            ),
            page.value(
                "crossings with natural frequencies, three harmonics, drivetrains A to D",
                right,
                beside=printed,
                by="printed orders",
            ),
            page.value("planetary stages that cannot be assembled with equal angles", refused),
        ],
        CAMPBELL.format(most),
        [
            "Table 4.8 of the thesis adds the sun's teeth to the ring's; the mesh order is that of "
            "the ring's teeth alone.",
            f"{refused} planetary stages of A, B and C cannot be assembled with three planets at "
            "equal angles.",
        ],
        claim="holds" if holds else "does not hold",
    )


def check_orders(
    page: Page, letter: str, train: Train, right: dict[str, float], printed: dict[str, float]
) -> None:
    """The print is ring and sun together; ring and sun sides of the right order agree."""
    for number, name in enumerate(right):
        if letter in TABLE_4_8:
            digits = TABLE_4_8[letter][number]
            page.equals(
                f"{letter}, {name}: order as Table 4.8 counts it",
                printed[name],
                float(digits),
                within=5e-6,
                why="the print has ratios rounded to their third digit",
                source="Al-Hamadani 2018, Table 4.8",
            )
        kind, (large, small) = train.stages[number].kind, train.stages[number].teeth
        if kind == "planetary":
            before = right[name] / large
            ratio = 1 + large / small
            page.equals(
                f"{letter}, {name}: order from the sun's side",
                small * (ratio - 1) * before,
                right[name],
                within=1e-12,
                why="round-off; the sun's teeth times its speed against the carrier",
                source="kinematics",
                basis="self-consistency",
            )


def show_crossings(page: Page, found: dict[str, Train]) -> dict[str, list[int]]:
    """Tables and charts of each drivetrain; how many crossings each has either way."""
    counts: dict[str, list[int]] = {"right": [], "printed": []}
    for letter, train in found.items():
        page.section(f"Drivetrain {letter}")
        low, rated, high = SPEEDS[letter]
        within = (low * RPM, high * RPM)
        right = crossings(train.printed, mesh_orders(train.stages), within)
        other = crossings(train.printed, absolute_sun_orders(train.stages), within)
        own = crossings(train.computed, mesh_orders(train.stages), within)
        counts["right"].append(len(right))
        counts["printed"].append(len(other))
        keys = sorted({key(c) for c in (*right, *other, *own)})
        by_right, by_other, by_own = ({key(c): c for c in group} for group in (right, other, own))
        rows: list[Record] = []
        for order, harmonic, mode in keys:
            at = (order, harmonic, mode)
            rows.append(
                {
                    "stage": order,
                    "harmonic": harmonic,
                    "frequency as printed [Hz]": train.printed[mode],
                    "speed by the orders of Table 4.8 [rpm]": speed(by_other.get(at)),
                    "speed, right [rpm]": speed(by_right.get(at)),
                    "right, with the frequency of the inputs [rpm]": speed(by_own.get(at)),
                }
            )
        if rows:
            page.table(
                f"Crossings between {low} and {high} rpm (rated {rated}); empty: outside the range",
                rows,
            )
        else:
            page.text("No crossing within the range of speeds.")
        page.data(f"crossings_{letter}", rows)
        page.add(campbell(letter, train, right, SPEEDS[letter]))
    return counts


def campbell(
    letter: str, train: Train, right: Sequence[Crossing], speeds: tuple[float, float, float]
) -> Chart:
    """Right mesh orders and natural frequencies over the speed range, crossings marked."""
    low, rated, high = speeds
    met = [c.speed / RPM for c in right]
    traces = []
    for name, turns in mesh_orders(train.stages).items():
        for harmonic in (1, 2, 3):
            ends = [turns * harmonic * s / 60 for s in (low, high)]
            traces.append(trace(f"{name} x{harmonic}", [low, high], ends))
    for number, frequency in enumerate(train.printed):
        if frequency < 1.1 * max(t["y"][1] for t in traces):
            traces.append(
                trace(f"mode {number + 1}", [low, high], [frequency] * 2, line={"dash": "dot"})
            )
    traces.append(crosses("crossings", met, [c.frequency for c in right]))
    drawn = chart(CAMPBELL.format(letter), traces, "rotor [rpm]", "frequency [Hz]", ("y",))
    return mark_events(drawn, {"rated speed": rated})


def key(crossing: Crossing) -> tuple[str, int, int]:
    """What tells crossings apart."""
    return crossing.order, crossing.harmonic, crossing.mode


def speed(crossing: Crossing | None) -> float | None:
    """[rpm], where there is one."""
    return None if crossing is None else round(crossing.speed / RPM, 2)


def show_assembly(page: Page, found: dict[str, Train]) -> int:
    """Which planetary stages can be put together, and what their meshes excite.

    Returns how many cannot.
    """
    page.section("Assembly and phases")
    rows: list[Record] = []
    refused = []
    for letter, train in found.items():
        for number, stage in enumerate(train.stages, start=1):
            kind, (ring, sun) = stage.kind, stage.teeth
            if kind != "planetary":
                continue
            try:
                check_assembly(f"stage {number} of {letter}", sun, ring, 3)
                reason = "can be put together"
            except InputError as error:
                reason = str(error)
                refused.append((letter, number))
            fits = equally_spaced(sun, ring, 3)
            phases = sun_phases(sun, ring, np.array(equal_angles(3))) if fits else np.zeros(0)
            rows.append(
                {
                    "drivetrain": letter,
                    "stage": number,
                    "(z_s + z_r) / 3": round((sun + ring) / 3, 2),
                    "phases of the sun's meshes": ", ".join(f"{p:.2f}" for p in phases),
                    "sequence": sequence(sun, ring, 3) if fits else "",
                    "first harmonic gives the sun a": excited_motion(sun, 3) if fits else "",
                    "verdict": reason,
                }
            )
    page.holds(
        "stage 1 of A and stages 1 and 2 of B cannot be put together",
        refused == [("A", 1), ("B", 1), ("B", 2)],
        why="a model in three dimensions with equal planets would be of no machine",
        source="(z_s + z_r) / N is no integer: 48.67, 51.33 and 41.33",
    )
    page.table("Three planets at equal angles", rows)
    return len(refused)
