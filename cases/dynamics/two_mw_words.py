"""What Al-Hamadani 2018, chapter 7.2 says of the 2 MW machine, beside what stands here."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np

from fe_drivetrain.cases.dynamics.two_mw_guesses import grown, sides, spread
from fe_drivetrain.cases.dynamics.two_mw_loads import moments, tangential
from fe_drivetrain.cases.dynamics.two_mw_rolling_words import of_bearing_stresses, of_damage
from fe_drivetrain.cases.dynamics.two_mw_statements import (
    FAST,
    MESHES,
    MIDDLE,
    MORE,
    RANGE,
    RING,
    STRESSES,
    SUN,
    UPWIND,
    Computed,
    Statement,
    of_guesses,
)
from fe_drivetrain.cases.references.printed_values import NEAR, against, holds
from fe_drivetrain.report.number_text import percent_text


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
        *of_depths([1e3 * of.depth[name] for name in order]),
    ]


def of_depths(depths: list[float]) -> list[Statement]:
    """Figure 7.26, of depths of the largest shear, the fast stage's last [mm]."""
    return [
        Statement(
            "7.26",
            "the largest shear is least deep in the fast stage, at about 0.4 mm",
            "0.4 mm",
            f"{min(depths):.2f} mm",
            holds(min(depths) == depths[-1] and abs(depths[-1] - 0.4) < 0.05),
            "0.786 of the half width of contact",
        ),
        Statement(
            "7.26",
            "in other gears the largest shear is about 1 mm deep",
            "1 mm",
            ", ".join(f"{one:.2f}" for one in depths[:-1]) + " mm",
            "not testable",
            "goes with modules and faces, which are chosen",
        ),
    ]
