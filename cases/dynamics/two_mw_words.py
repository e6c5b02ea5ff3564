"""What Al-Hamadani 2018, chapter 7.2 says of the 2 MW machine, beside what stands here."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

import numpy as np

from fe_drivetrain.cases.dynamics.two_mw_damage import Share, Shares
from fe_drivetrain.cases.dynamics.two_mw_guesses import FEWEST, grown, planet_pins, sides, spread
from fe_drivetrain.cases.dynamics.two_mw_loads import Change, Rolling, moments, tangential
from fe_drivetrain.cases.dynamics.two_mw_machine import Chain
from fe_drivetrain.report.number_text import percent_text
from fe_drivetrain.report.suite import Record

Stands = Literal["holds", "does not hold", "not testable"]

RING, SUN, MIDDLE, FAST = (
    "stage 1 ring-planet",
    "stage 1 sun-planet",
    "stage 2 mesh",
    "stage 3 mesh",
)
MESHES = {RING: "ring and planet", SUN: "sun and planet", MIDDLE: "intermediate", FAST: "fast"}
MORE = {RING: 1.27, SUN: 1.12, MIDDLE: 1.31, FAST: 1.37}
"""Largest force of a mesh in the shutdown over that in normal operation, Figure 7.15."""

STRESSES = {RING: 2.32, SUN: 1.32, MIDDLE: 1.22}
"""Contact stress of the fast stage over that of others in normal operation, Figure 7.19."""

UPWIND = (1.20, 1.13, 1.05)
"""Upwind over downwind bearing of planets A, B, C in the shutdown, Figure 7.17."""

RANGE = (202.0, 302.0)
"""Circumferential force of ring and planet in normal operation [kN], Figure 7.14."""

NEAR = 0.05
"""A printed ratio holds where ours is within so much of it."""


@dataclass(frozen=True, eq=False)
class Computed:
    """All that statements are held against.

    Attributes
    ----------
    chain : Chain
        The machine in both states.
    meshes, bearings : Mapping[str, Change]
        Largest loads.
    stress : Mapping[str, tuple of float]
        Contact stress of meshes, normal and in the shutdown [Pa].
    depth : Mapping[str, float]
        Depth of the largest shear of meshes in normal operation [m].
    rollers : Mapping[str, tuple of Rolling]
        Rollers of bearings.
    bearing_depths : tuple of float
        Least and largest depth below races [m].
    moved : sequence of Record
        Results with each guess changed, see `moved_by`.
    rolls : sequence of Record
        Rollers of a planet bearing by size and clearance, see `of_rollers`.
    shares : Shares or None
        Damage; None where it was not counted.
    """

    chain: Chain
    meshes: Mapping[str, Change]
    bearings: Mapping[str, Change]
    stress: Mapping[str, tuple[float, float]]
    depth: Mapping[str, float]
    rollers: Mapping[str, tuple[Rolling, Rolling]]
    bearing_depths: tuple[float, float]
    moved: Sequence[Record]
    rolls: Sequence[Record]
    shares: Shares | None

    @property
    def pins(self) -> tuple[list[str], list[str]]:
        """Upwind and downwind planet bearings."""
        found = planet_pins(self.chain)
        assert found is not None
        return found


@dataclass(frozen=True)
class Statement:
    """A statement of the thesis and what stands here.

    Attributes
    ----------
    figure, words, printed : str
        Where, what, and its numbers.
    ours, stands, reason : str
        What stands here, whether it holds, and why.
    """

    figure: str
    words: str
    printed: str
    ours: str
    stands: Stands
    reason: str

    @property
    def row(self) -> Record:
        """A row of a table."""
        return {
            "figure": self.figure,
            "statement": self.words,
            "printed": self.printed,
            "ours": self.ours,
            "verdict": self.stands,
            "reason": self.reason,
        }


def holds(ok: bool) -> Stands:
    """Verdict of a statement that can be tested."""
    return "holds" if ok else "does not hold"


def against(ours: float, printed: float, span: tuple[float, float]) -> Stands:
    """Verdict of a number that inputs which are not printed move, within a span of ours."""
    if abs(ours / printed - 1.0) <= NEAR:
        return "holds"
    return "not testable" if span[0] <= printed <= span[1] else "does not hold"


def of_guesses(span: tuple[float, float]) -> str:
    """What guesses do to a number, in words."""
    return f"{span[0]:.2f} to {span[1]:.2f} by what is not printed"


def statements(of: Computed) -> list[Statement]:
    """All statements of section 7.2 that have a number or an order."""
    parts: tuple[Callable[[Computed], list[Statement]], ...] = (
        in_normal_operation,
        in_shutdown,
        of_planet_bearings,
        of_gear_stresses,
        of_bearing_stresses,
        of_damage,
    )
    return [one for part in parts for one in part(of)]


def in_normal_operation(of: Computed) -> list[Statement]:
    """Figures 7.11 to 7.13."""
    normal = of.chain.normal
    share = tangential(of.chain)[RING] / 1e3
    names = of.meshes[RING].channels
    low = share * min(normal.extremes[name].least for name in names)
    high = share * max(normal.extremes[name].most for name in names)
    torque = "torque of " + of.chain.rig.machine.shafts[0].name
    lean = moments(normal, torque)[2]
    force = moments(normal, names[0])[2]
    up, down = of.pins
    means, spreads = (
        [np.mean([moments(normal, f"force of {n}")[k] for n in side]) for side in (up, down)]
        for k in (0, 1)
    )
    inside = RANGE[0] <= low and high <= RANGE[1]
    return [
        Statement(
            "7.11",
            "mesh forces of all stages are distributed normally",
            "histograms",
            f"skewness of ring and planet {force:.2f}, of the torque {lean:.2f}",
            "not testable",
            "forces follow the torque, whose record is private",
        ),
        Statement(
            "7.11, 7.14",
            "circumferential force of ring and planet in normal operation",
            "202 to 302 kN",
            f"{low:.0f} to {high:.0f} kN",
            holds(inside),
            "module chosen, so that the mean is met; the range is that of the simulated wind",
        ),
        Statement(
            "7.13",
            "upwind planet bearings have the larger mean and the larger scatter",
            "histograms",
            f"mean {means[0] / means[1]:.3f}, scatter {spreads[0] / spreads[1]:.2f} times downwind",
            holds(bool(means[0] > means[1] and spreads[0] > spreads[1])),
            "rigid carrier and equal pins; planets stand at one azimuth each",
        ),
    ]


def in_shutdown(of: Computed) -> list[Statement]:
    """Figures 7.14 and 7.15."""
    spans = {name: spread(of.moved, grown(name)) for name in MORE}
    found = [
        Statement(
            "7.15",
            f"largest force, {MESHES[name]}: shutdown over normal",
            f"{printed:.2f}",
            f"{of.meshes[name].ratio:.3f} \u00b1 {of.meshes[name].band:.1g}",
            against(of.meshes[name].ratio, printed, spans[name]),
            of_guesses(spans[name]),
        )
        for name, printed in MORE.items()
    ]
    braked = of.chain.stop.marks.get("brake on", 0.0)
    latest = max(one.at for one in of.meshes.values()) - braked
    turned = [one for one in of.meshes.values() if one.least < 0.0]
    deepest = min(one.least / one.stop for one in of.meshes.values())
    return [
        *found,
        order_of(of, RING, SUN, "a planet's two meshes differ by what turns the planet alone"),
        order_of(of, FAST, RING, "gears of the last stages take a part of what brakes the rotor"),
        Statement(
            "7.14",
            "forces are largest right after the brake engages",
            "region X2",
            f"at most {latest:.2f} s after it",
            holds(0.0 <= latest < 1.0),
            "the first swing after the brake has grown",
        ),
        Statement(
            "7.14",
            "mesh forces turn negative in the shutdown, never in normal operation",
            "region X4",
            f"{len(turned)} of {len(of.meshes)} meshes, up to "
            f"{max(one.reversals for one in turned) if turned else 0} times",
            holds(len(turned) == len(of.meshes) and never_back(of)),
            "the shaft unwinds when the generator lets go, before the brake and after",
        ),
        Statement(
            "7.14",
            "negative forces stay below the largest positive ones",
            "X4 below X2",
            f"at most {percent_text(-deepest)} of them",
            holds(-1.0 < deepest < 0.0),
            "damping, and a brake that loads the positive flank",
        ),
    ]


def order_of(of: Computed, more: str, less: str, reason: str) -> Statement:
    """Which of two meshes a shutdown loads more; it stands or falls with any guess."""
    printed = MORE[more] / MORE[less]
    span = spread(of.moved, grown(more), grown(less))
    ours = of.meshes[more].ratio / of.meshes[less].ratio
    return Statement(
        "7.15",
        f"a shutdown adds more at {MESHES[more]} than at {MESHES[less]}",
        f"{MORE[more]:.2f} over {MORE[less]:.2f}, {printed:.2f}",
        f"{ours:.3f}",
        against(ours, printed, span),
        f"{reason}; {of_guesses(span)}",
    )


def never_back(of: Computed) -> bool:
    """Whether no mesh force turns negative in normal operation."""
    normal = of.chain.normal.extremes
    return all(normal[c].least > 0.0 for one in of.meshes.values() for c in one.channels)


def of_planet_bearings(of: Computed) -> list[Statement]:
    """Figures 7.16 to 7.18."""
    up, down = of.pins
    ratios = [of.bearings[a].stop / of.bearings[b].stop for a, b in zip(up, down, strict=True)]
    planets = {name for side in of.pins for name in side}
    others = {n: one for n, one in of.bearings.items() if n not in planets and is_inside(of, n)}
    most = max(others.values(), key=lambda one: one.stop)
    least = min(of.bearings[name].stop for name in planets)
    fast = [one for name, one in others.items() if name.startswith("HS")]
    more = [one.ratio for one in fast]
    span = spread(of.moved, grown("HS-A"))
    spans = [spread(of.moved, sides(number)) for number in range(1, len(ratios) + 1)]
    found = [
        Statement(
            "7.17",
            f"planet {letter}: largest upwind over largest downwind load in the shutdown",
            f"{printed:.2f}",
            f"{ratio:.3f}",
            against(ratio, printed, span),
            f"rigid carrier; planets stand at one azimuth each; {of_guesses(span)}",
        )
        for letter, printed, ratio, span in zip("ABC", UPWIND, ratios, spans, strict=True)
    ]
    return [
        *found,
        Statement(
            "7.17",
            "no negative bearing load",
            "none",
            "none: a radial load has no sign, it turns round with the torque",
            "holds",
            "true of any bearing across its axis",
        ),
        Statement(
            "7.18",
            "planet bearings carry more than those of other stages",
            "bars",
            f"{least / 1e3:.0f} kN or more; {most.name} {most.stop / 1e3:.0f} kN",
            holds(least > most.stop),
            "places of the bearings along shafts were chosen",
        ),
        Statement(
            "7.18",
            "bearings of the fast shaft carry twice as much in the shutdown",
            "2",
            f"{min(more):.2f} to {max(more):.2f} times",
            against(min(more), 2.0, span),
            f"his own pressures grow by 1.17, so loads by 1.37; {of_guesses(span)}",
        ),
    ]


def is_inside(of: Computed, name: str) -> bool:
    """Whether a bearing is of the gearbox's shafts behind the first stage."""
    found = [one for one in of.chain.rig.machine.bearings if one.name == name]
    return bool(found) and "carrier" not in found[0].holds and "LSS" not in found[0].holds


def of_gear_stresses(of: Computed) -> list[Statement]:
    """Figures 7.19 to 7.21, 7.26 and 7.30."""
    normal = {name: pair[0] for name, pair in of.stress.items()}
    stop = {name: pair[1] for name, pair in of.stress.items()}
    order = [RING, SUN, MIDDLE, FAST]
    depths = [1e3 * of.depth[name] for name in order]
    faces = "modules and faces chosen; equal forces on both meshes of a planet make 2.24"
    found = [
        Statement(
            "7.19",
            f"contact stress of the fast stage over {MESHES[name]}, normal operation",
            f"{printed:.2f}",
            f"{normal[FAST] / normal[name]:.2f}",
            holds(abs(normal[FAST] / normal[name] / printed - 1.0) <= NEAR),
            faces if name == RING else "modules and faces chosen, so that these are near",
        )
        for name, printed in STRESSES.items()
    ]
    return [
        *found,
        Statement(
            "7.19",
            "contact stress grows from the slow to the fast stage",
            "2.32, 1.32, 1.22 below",
            ", ".join(f"{normal[name] / 1e6:.0f}" for name in order) + " MPa",
            holds(all(normal[a] < normal[b] for a, b in pairwise(order))),
            "follows from modules and faces",
        ),
        Statement(
            "7.21",
            "contact stress of all gears is higher in the shutdown",
            "bars",
            ", ".join(f"{100 * (stop[n] / normal[n] - 1):.0f}" for n in order) + " % more",
            holds(all(stop[name] > normal[name] for name in order)),
            "the root of the force",
        ),
        Statement(
            "7.30",
            "the fast stage exceeds 1450 MPa in the shutdown alone",
            "> 1450 MPa",
            f"{normal[FAST] / 1e6:.0f} and {stop[FAST] / 1e6:.0f} MPa",
            "not testable",
            "goes with modules and faces, which are chosen; nominal, without load factors",
        ),
        Statement(
            "7.26",
            "the largest shear is least deep in the fast stage; elsewhere about 1 mm",
            "0.4 and 1 mm",
            ", ".join(f"{one:.2f}" for one in depths) + " mm",
            holds(min(depths) == depths[-1] and abs(depths[-1] - 0.4) < 0.05),
            "0.4 mm holds; 1 mm is the middle of 0.6 and 1.3 mm",
        ),
    ]


def of_bearing_stresses(of: Computed) -> list[Statement]:
    """Figures 7.22 to 7.25, 7.27 and 7.28."""
    up, down = of.pins
    peaks = {n: [float(one.pressure.max()) for one in pair] for n, pair in of.rollers.items()}
    shafts = {name: pair for name, pair in peaks.items() if name not in {*up, *down}}
    higher = all(peaks[a][k] > peaks[b][k] for a, b in zip(up, down, strict=True) for k in (0, 1))
    first = of.rollers[up[0]]
    fewest = [int(str(row[f"{FEWEST}, shutdown"])) for row in of.rolls]
    counts = [(int(one.loaded.min()), int(one.loaded.max())) for one in first]
    more = peaks["HS-A"][1] / peaks["HS-A"][0]
    loads = spread(of.moved, grown("HS-A"))
    span = (loads[0] ** 0.5, loads[1] ** 0.5)
    deep = [1e3 * one for one in of.bearing_depths]
    sizes = "bearings are those of the 750 kW gearbox, scaled"
    normal = [pair[0] for pair in peaks.values()]
    fast = max(shafts, key=lambda name: shafts[name][1]) if shafts else ""
    return [
        Statement(
            "7.24",
            "pressures of bearings in normal operation",
            "1.51 to 2.05 GPa",
            f"{min(normal) / 1e9:.2f} to {max(normal) / 1e9:.2f} GPa",
            "not testable",
            sizes,
        ),
        Statement(
            "7.24",
            "pressure of HSS-A: shutdown over normal",
            "2.405 over 2.05, 1.17",
            f"{more:.3f}",
            against(more, 2.405 / 2.05, span),
            f"the size of the bearing leaves it; {of_guesses(span)}",
        ),
        Statement(
            "7.24",
            "HSS-A has the highest pressure of the bearings of shafts in the shutdown",
            "2.4 GPa",
            f"{fast}, {shafts[fast][1] / 1e9:.2f} GPa",
            "not testable",
            sizes,
        ),
        Statement(
            "7.23",
            "upwind planet bearings have the higher pressure in both states",
            "all three",
            ", ".join(f"{peaks[a][1] / peaks[b][1]:.3f}" for a, b in zip(up, down, strict=True)),
            holds(higher),
            "as their loads",
        ),
        Statement(
            "7.25",
            "rollers of upwind bearing A that carry load in normal operation",
            "6 to 7",
            f"{counts[0][0]} to {counts[0][1]}",
            holds(counts[0][0] in (5, 6, 7) and counts[0][1] in (6, 7, 8)),
            "of 0.1 mm of clearance; one more or less with the place of the rollers",
        ),
        Statement(
            "7.25",
            "at instants of the shutdown one roller alone carries load",
            "1",
            f"{counts[1][0]} at the least load",
            "holds" if counts[1][0] == 1 else "not testable" if 1 in fewest else "does not hold",
            "the load does not go to nothing, for weights are left; by size and clearance "
            f"{min(fewest)} to {max(fewest)}",
        ),
        Statement(
            "7.25",
            "few rollers overload the bearing",
            "stress higher at such instants",
            f"{least_pressure(first[1]) / 1e6:.0f} MPa at the fewest, "
            f"{first[1].pressure.max() / 1e6:.0f} MPa at most",
            holds(least_pressure(first[1]) > 0.9 * first[1].pressure.max()),
            "few rollers carry where there is little to carry",
        ),
        Statement(
            "7.27",
            "depth of the largest shear below races",
            "0.35 to 0.65 mm",
            f"{deep[0]:.2f} to {deep[1]:.2f} mm",
            "not testable",
            sizes,
        ),
    ]


def least_pressure(rolls: Rolling) -> float:
    """Largest pressure at the instants at which fewest rollers carry load [Pa]."""
    return float(rolls.pressure[rolls.loaded == rolls.loaded.min()].max())


def whole_share(parts: Mapping[str, Share]) -> float:
    """Share of shutdowns in the damage of all parts together."""
    return Share(sum(p.normal for p in parts.values()), sum(p.stop for p in parts.values())).share


def of_damage(of: Computed) -> list[Statement]:
    """Figures 7.31 and 7.32; nothing where damage was not counted."""
    if of.shares is None:
        return []
    gears, bearings = of.shares.gears, of.shares.bearings
    worst = max(gears, key=lambda name: gears[name].stop)
    each = [whole_share(kind) for kind in (gears, bearings)]
    his = [one.share for name, one in of.shares.his.items() if name.startswith("stage")]
    ranked = sorted(bearings, key=lambda name: -bearings[name].stop)
    return [
        Statement(
            "7.31, 7.32",
            "shutdowns do most of the damage of gears and bearings",
            "bars",
            f"{percent_text(each[0])} of gears by ISO 6336, {percent_text(each[1])} of bearings "
            f"by ISO 281; as he counts, {percent_text(min(his))} or more of meshes and planets",
            holds(min(each) > 0.5),
            "a count of cycles of the pressure leaves out its mean, which every tooth and roller "
            "feels at each pass",
        ),
        Statement(
            "7.31",
            "gears of the fast stage are damaged most by shutdowns",
            "fast gear and pinion",
            worst,
            holds(worst.startswith("stage 3")),
            "steels and load factors were chosen",
        ),
        Statement(
            "7.32",
            "planet bearings, HSS-A and HSS-C are damaged most by shutdowns",
            "these eight",
            ", ".join(ranked[:3]),
            "not testable",
            "bearings are those of the 750 kW gearbox, scaled",
        ),
    ]
